"""``[groups.COLUMN]`` and ``[covariates.NAME]`` of a model file: what rows of data have in common beside the physics."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from skinbayes.errors import InputError
from skinbayes.files.modelschema import CovariateBlock, GroupBlock
from skinbayes.files.parameter_block import ParameterSpec, label_column, parse_parameter, parse_value
from skinbayes.statistics.noise_families import NOISE_FAMILIES
from skinbayes.vocabulary import QUANTITIES, suggestions

GROUP, COVARIATE = "group", "covariate"
"""What ``group_scale`` and ``covariate_exponent`` differ by."""

LARGEST_SCALE = 3.0
"""Largest scale of an effect on a logarithm that a prior may give more than one in a thousand to."""


@dataclass(frozen=True)
class CovariateSpec:
    """A column that multiplies an input, or the observable, by ``(column/reference)^exponent``.

    Attributes
    ----------
    name : as in the model file
    column : numeric column of the data
    acts_on : an input of the forward model, or the observable
    reference : value of the column at which the factor is 1, SI
    """

    name: str
    column: str
    acts_on: str
    reference: float


def read_groups(
    blocks: Mapping[str, GroupBlock], noise: Mapping[str, str], where: Callable[..., str]
) -> tuple[ParameterSpec, ...]:
    """Read the scales of group effects, ``group_scale[person]`` and so on.

    Effects are integrated out in closed form, which takes noise that is normal, of the data or of their ln; the effects are
    added to what scatters.

    Raises
    ------
    InputError
        A column that cannot group, noise of another kind, several observables, or a prior that lets the effect swallow
        everything.
    """
    found = []
    for column, block in blocks.items():
        place = where("groups", column)
        label_column(column, place)
        family, unit = closed_form_noise(noise, place, "group effects")
        spec = parse_parameter(
            QUANTITIES["group_scale"], block.scale, where("groups", column, "scale"), unit, GROUP, column
        )
        if NOISE_FAMILIES[family].logarithmic:
            scale_that_swallows(spec, where("groups", column, "scale"), "between groups")
        found.append(spec)
    return tuple(found)


def closed_form_noise(noise: Mapping[str, str], place: str, what: str) -> tuple[str, str]:
    """Family of the noise and unit in which it scatters, where normal effects can be integrated out.

    Raises :class:`InputError` for a model without data, of several observables, or with noise of another kind.
    """
    verb = "needs" if what.startswith(("a ", "corr")) else "need"
    if not noise:
        raise InputError(f"{place}: {what} {verb} data; leave it out, or add [data] and [noise]")
    if len(noise) > 1:
        raise InputError(f"{place}: {what} {verb} a model of one observable; this one has {', '.join(noise)}")
    ((observable, family),) = noise.items()
    if not NOISE_FAMILIES[family].closed_form_groups:
        usable = [name for name, kind in NOISE_FAMILIES.items() if kind.closed_form_groups]
        raise InputError(
            f"{place}: {what} {'is' if verb == 'needs' else 'are'} integrated out in closed form, which noise '{family}' does "
            f"not allow; expected {' or '.join(usable)}"
        )
    return family, "1" if NOISE_FAMILIES[family].logarithmic else QUANTITIES[observable].unit


def scale_that_swallows(spec: ParameterSpec, place: str, between: str) -> None:
    """Refuse a prior of the scale of an effect on a logarithm that admits effects which explain anything."""
    far = 0.0 if spec.prior is None else float(spec.prior.quantile(0.999))
    if not far <= LARGEST_SCALE:
        raise InputError(
            f"{place}: the prior reaches to {far:.3g} (99.9 %), a factor of "
            f"{'many' if far > 20 else f'{2.718281828**far:.0f}'} {between}; such an effect can swallow any misfit. "
            f"Expected at most {LARGEST_SCALE:g}, such as {{ half_normal = 0.5 }} or {{ uniform = [0, 1] }}"
        )


def read_covariates(
    blocks: Mapping[str, CovariateBlock], where: Callable[..., str]
) -> tuple[tuple[CovariateSpec, ...], tuple[ParameterSpec, ...]]:
    """Read covariates and their exponents, ``covariate_exponent[NAME]``.

    Raises
    ------
    InputError
        A column or target that is no known quantity, or a reference that is not positive.
    """
    covariates, exponents = [], []
    for name, block in blocks.items():
        for key, quantity in (("column", block.column), ("acts_on", block.acts_on)):
            if quantity not in QUANTITIES:
                raise InputError(
                    f"{where('covariates', name, key)}: unknown quantity '{quantity}'.{suggestions(quantity, list(QUANTITIES))}"
                )
        place = where("covariates", name, "reference")
        reference = parse_value(QUANTITIES[block.column], block.reference, place)
        if not reference > 0:
            raise InputError(
                f"{place}: found {block.reference}; expected a value > 0, as the column enters as a power"
            )
        covariates.append(CovariateSpec(name, block.column, block.acts_on, reference))
        exponents.append(
            parse_parameter(
                QUANTITIES["covariate_exponent"],
                block.exponent,
                where("covariates", name, "exponent"),
                None,
                COVARIATE,
                name,
            )
        )
    return tuple(covariates), tuple(exponents)
