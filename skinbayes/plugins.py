"""What installed packages add to skinbayes."""

from __future__ import annotations

from functools import cache
from importlib.metadata import entry_points
from typing import Any

from skinbayes.vocabulary import add_quantity

FORWARD_MODELS = "skinbayes.forward_models"
"""Entry point group of forward models: their names, and where the objects are."""


@cache
def installed_forward_models() -> tuple[dict[str, Any], dict[str, str]]:
    """The forward models that installed packages offer.

    Their quantities become known, so this comes before any file is read.

    Returns
    -------
    models : name of the entry point to the object
    broken : name to what is wrong, of those that cannot be loaded; they matter to nobody who does not ask for them
    """
    models, broken = {}, {}
    for point in entry_points(group=FORWARD_MODELS):
        try:
            model = point.load()
            if getattr(model, "name", None) != point.name:
                raise ValueError(f"expected a ForwardModel of the name '{point.name}', found {model!r:.60}")
            for quantity in model.quantities:
                add_quantity(quantity)
            models[point.name] = model
        except Exception as error:
            package = point.dist.name if point.dist is not None else point.value
            broken[point.name] = (
                f"offered by the installed package '{package}', but cannot be used ({type(error).__name__}: {error!s:.200})"
            )
    return models, broken
