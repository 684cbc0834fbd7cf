"""Forward models: named inputs (parameters and conditions alike) in, named observables out.

Every module of this package that defines ``MODEL`` is a forward model and is found by itself; so is every object that an
installed package offers under the entry point group ``skinbayes.forward_models``. Others are made known by
:func:`register_forward_model`.
"""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from skinbayes.errors import InputError
from skinbayes.forward.base import ROUGHNESS_INPUTS, ForwardModel, Inputs, Profile, Tables
from skinbayes.forward.emulated_model import emulated
from skinbayes.lubrication import FlowCurve
from skinbayes.plugins import installed_forward_models
from skinbayes.vocabulary import QUANTITIES, add_quantity, suggestions

__all__ = [
    "ROUGHNESS_INPUTS",
    "FlowCurve",
    "ForwardModel",
    "Inputs",
    "Profile",
    "Tables",
    "emulated",
    "forward_model",
    "forward_models",
    "register_forward_model",
]

_REGISTERED: dict[str, ForwardModel] = {}


def forward_models() -> dict[str, ForwardModel]:
    """Return all forward models by name.

    >>> {"contact-area", "friction"} <= set(forward_models())
    True
    """
    modules = (import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__))
    own = {module.MODEL.name: module.MODEL for module in modules if hasattr(module, "MODEL")}
    return installed_forward_models()[0] | _REGISTERED | own


def forward_model(name: str, where: str = "forward") -> ForwardModel:
    """Return the forward model called ``name``; :class:`InputError` naming all of them if there is none."""
    models = forward_models()
    if broken := installed_forward_models()[1].get(name):
        raise InputError(f"{where}: the forward model '{name}' is {broken}")
    if name not in models:
        raise InputError(
            f"{where}: no forward model '{name:.60}'.{suggestions(name, list(models))} Expected one of "
            f"{', '.join(sorted(models))}"
        )
    return models[name]


def register_forward_model(model: ForwardModel) -> ForwardModel:
    """Make a forward model of one's own known by its name, so that model files can name it.

    Parameters
    ----------
    model : its ``quantities`` become known as well. A package can offer it under the entry point group
        ``skinbayes.forward_models`` instead

    Returns
    -------
    ForwardModel
        the model

    Raises
    ------
    InputError
        the name of a model of skinbayes, or inputs and observables that are no known quantities

    Examples
    --------
    >>> def evaluate(inputs, tables):
    ...     return {"friction_coefficient": inputs["frictional_shear_stress"] / inputs["nominal_pressure"]}
    >>> needed = ("frictional_shear_stress", "nominal_pressure")
    >>> model = ForwardModel("full-contact", "all touches", ("friction_coefficient",), needed, evaluate, uses_surface=False)
    >>> register_forward_model(model) is forward_model("full-contact")
    True
    >>> del _REGISTERED["full-contact"]
    """
    if model.name in set(forward_models()) - set(_REGISTERED):
        raise InputError(f"there is a forward model '{model.name}' already; give yours another name")
    for quantity in model.quantities:
        add_quantity(quantity)
    unknown = sorted({*model.input_names(), *model.observables, *model.derived_names} - set(QUANTITIES))
    if unknown:
        raise InputError(
            f"forward model '{model.name}': {', '.join(unknown)}: no known quantity; declare it in 'quantities', a "
            "skinbayes.Quantity each"
        )
    _REGISTERED[model.name] = model
    return model
