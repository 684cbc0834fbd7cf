"""Forward model ``drying-delta``: as ``drying`` with sharp gaps, most likely what the paper computed."""

from __future__ import annotations

from skinbayes.forward.drying import drying_model

MODEL = drying_model(
    "drying-delta",
    "as drying, with one sharp gap at each magnification instead of a distribution about it",
    "delta",
)
