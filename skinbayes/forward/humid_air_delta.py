"""Forward model ``humid-air-delta``: as ``humid-air`` with sharp gaps, most likely what the paper computed."""

from __future__ import annotations

from skinbayes.forward.humid_air import humid_air_model

MODEL = humid_air_model(
    "humid-air-delta",
    "as humid-air, with one sharp gap at each magnification instead of a distribution about it",
    "delta",
)
