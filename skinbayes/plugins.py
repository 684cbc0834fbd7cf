"""What installed packages add to skinbayes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from importlib.metadata import entry_points
from typing import Any

from skinbayes.vocabulary import add_quantity

FORWARD_MODELS = "skinbayes.forward_models"
NOISE_FAMILIES = "skinbayes.noise_families"
ENGINES = "skinbayes.engines"
"""Entry point groups: names, and where the objects are."""

_entry_points = cache(entry_points)


@cache
def installed(group: str, accept: Callable[[str, Any], object]) -> tuple[dict[str, Any], dict[str, str]]:
    """What installed packages offer under an entry point group.

    Parameters
    ----------
    group : the entry point group
    accept : called with name and object of each; what it raises is what is wrong with the object

    Returns
    -------
    usable : name to object
    broken : name to what is wrong, of those that cannot be used; they matter to nobody who does not ask for them
    """
    usable, broken = {}, {}
    for point in _entry_points().select(group=group):
        try:
            found = point.load()
            accept(point.name, found)
            usable[point.name] = found
        except Exception as error:
            package = point.dist.name if point.dist is not None else point.value
            broken[point.name] = (
                f"offered by the installed package '{package}', but cannot be used ({type(error).__name__}: {error!s:.200})"
            )
    return usable, broken


def check_name(name: str, found: Any, kind: str) -> None:
    """ValueError unless an object has the name of its entry point."""
    if getattr(found, "name", None) != name:
        raise ValueError(f"expected a {kind} of the name '{name}', found {found!r:.60}")


def _accept_model(name: str, model: Any) -> None:
    check_name(name, model, "ForwardModel")
    for quantity in model.quantities:
        add_quantity(quantity)


def installed_forward_models() -> tuple[dict[str, Any], dict[str, str]]:
    """The forward models of installed packages, and what is wrong with others.

    Their quantities become known, so this comes before any file is read.
    """
    return installed(FORWARD_MODELS, _accept_model)
