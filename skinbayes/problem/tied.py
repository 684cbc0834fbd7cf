"""Parameters that are the same as others, or a multiple of them."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import replace

from skinbayes.errors import InputError
from skinbayes.files.parameter_block import ParameterSpec
from skinbayes.vocabulary import QUANTITIES, suggestions


def resolve_ties(
    parameters: Sequence[ParameterSpec], where: str, columns: Collection[str] = ()
) -> list[ParameterSpec]:
    """The parameters with each tied one tied to a free or fixed one, and to each of its levels where it has several.

    Parameters
    ----------
    parameters : all inputs of the forward model that are parameters
    where : the model file, for messages
    columns : inputs that are columns of the data, for messages

    Raises
    ------
    InputError
        A tie to an unknown name, to a quantity of another unit or in a circle, or values outside the physical range.
    """

    roots = {spec.label: spec for spec in parameters if spec.same_as is None}

    def resolved(spec: ParameterSpec, above: tuple[str, ...] = ()) -> list[ParameterSpec]:
        if spec.same_as is None:
            return [spec]
        place = f"{where}: parameters.{spec.label}"
        if spec.label in above:
            circle = " = ".join((*above[above.index(spec.label) :], spec.label))
            raise InputError(f"{place}: tied in a circle: {circle}; give one of them a value or a prior")
        name, _, level = spec.same_as.removesuffix("]").partition("[")
        named = [other for other in parameters if other.name == name]
        exact = [other for other in named if other.label == spec.same_as]
        # what is tied as a whole to something with levels has these levels
        whole = exact or [other for other in named if not level or other.level is None]
        found = [root for other in whole for root in resolved(other, (*above, spec.label))]
        if level and not exact:
            found = [root for root in found if root.level == level]
        if not found:
            known = [other.label for other in parameters if other.same_as is None]
            column = " It is a column of the data, not a parameter." if name in columns else ""
            raise InputError(
                f"{place}.same_as: no parameter '{spec.same_as:.60}'.{column or suggestions(spec.same_as, known)} "
                f"Expected one of {', '.join(known)}"
            )
        if len(found) > 1 and spec.level is not None:
            levels = ", ".join(root.label for root in found)
            raise InputError(
                f"{place}.same_as: '{spec.same_as}' has several levels; expected one of {levels}"
            )
        inherits = not level and spec.level is None
        return [_tied(spec, other, roots[other.same_as or other.label], place, inherits) for other in found]

    return [tied for spec in parameters for tied in resolved(spec)]


def whole_ties(tied: Collection[ParameterSpec]) -> dict[str, tuple[str, float]]:
    """Inputs that are one multiple of one other input, whatever their levels, to that one and the multiple."""
    found: dict[str, set[tuple[str, float]]] = {}
    for spec in tied:
        found.setdefault(spec.name, set()).add((str(spec.same_as).partition("[")[0], spec.times))
    return {name: next(iter(ties)) for name, ties in found.items() if len(ties) == 1}


def _tied(
    spec: ParameterSpec, other: ParameterSpec, root: ParameterSpec, place: str, inherits: bool
) -> ParameterSpec:
    """``spec`` tied to what ``other`` is, or is tied to, with the level of ``other`` if it ``inherits`` that."""
    if spec.unit != other.unit:
        raise InputError(
            f"{place}.same_as: {other.name} has the unit {other.unit}; expected a parameter in {spec.unit}, as {spec.name} is"
        )
    times = spec.times * other.times
    quantity = QUANTITIES[spec.name]
    tied = replace(spec, same_as=other.same_as or other.label, times=times)
    if inherits:
        tied = replace(tied, by=other.by, level=other.level, by_column=other.by_column)
    value = root.value
    ends = root.prior.support if root.prior is not None else (value, value)
    low, high = (float(end or 0.0) * times for end in ends)
    inside = quantity.admits(low) if low == high else quantity.lower <= low and high <= quantity.upper
    if not inside:
        reach = f"is {low:g}" if low == high else f"reaches from {low:g} to {high:g}"
        unit = "" if spec.unit == "1" else f" {spec.unit}"
        raise InputError(
            f"{place}: {tied.prior_text.removeprefix('= ')} {reach}{unit}; expected a {spec.name} {quantity.range_text()}"
        )
    return tied
