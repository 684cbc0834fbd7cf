"""Forward model ``capillary-film-delta``: as ``capillary-film`` with sharp gaps, most likely what the paper computed."""

from __future__ import annotations

from skinbayes.forward.capillary_film import capillary_film_model

MODEL = capillary_film_model(
    "capillary-film-delta",
    "as capillary-film, with one sharp gap at each magnification instead of a distribution about it",
    "delta",
)
