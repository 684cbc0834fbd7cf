"""Forward models: named inputs (parameters and conditions alike) in, named observables out.

Every module of this package that defines ``MODEL`` is a forward model and is found by itself.
"""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from skinbayes.errors import InputError
from skinbayes.forward.base import ROUGHNESS_INPUTS, ForwardModel, Inputs, Profile, Tables
from skinbayes.lubrication import FlowCurve

__all__ = [
    "ROUGHNESS_INPUTS",
    "FlowCurve",
    "ForwardModel",
    "Inputs",
    "Profile",
    "Tables",
    "forward_model",
    "forward_models",
]


def forward_models() -> dict[str, ForwardModel]:
    """Return all forward models by name.

    >>> {"contact-area", "friction"} <= set(forward_models())
    True
    """
    modules = (import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__))
    found = [module.MODEL for module in modules if hasattr(module, "MODEL")]
    return {model.name: model for model in found}


def forward_model(name: str, where: str = "forward") -> ForwardModel:
    """Return the forward model called ``name``; :class:`InputError` naming all of them if there is none."""
    models = forward_models()
    if name not in models:
        raise InputError(
            f"{where}: no forward model '{name:.60}'; expected one of {', '.join(sorted(models))}"
        )
    return models[name]
