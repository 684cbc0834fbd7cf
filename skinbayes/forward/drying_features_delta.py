"""Forward model ``drying-features-delta``: as ``drying-features`` with sharp gaps, most likely what the paper computed."""

from __future__ import annotations

from skinbayes.forward.drying_features import features_model

MODEL = features_model(
    "drying-features-delta",
    "as drying-features, with one sharp gap at each magnification instead of a distribution about it",
    "delta",
)
