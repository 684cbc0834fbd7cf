"""The words of the field: one name, symbol, unit and physical range for each quantity.

The same names are used in code, model files, data headers, results and documentation. Everything that has to know
the unit of a name asks here; nothing else in skinbayes states one.
"""

from __future__ import annotations

from collections.abc import Collection
from math import inf
from unicodedata import normalize

from skinbayes.errors import InputError
from skinbayes.quantities import ALL
from skinbayes.quantity import Quantity as Quantity
from skinbayes.synonyms import likely_meant

QUANTITIES: dict[str, Quantity] = {quantity.name: quantity for quantity in ALL}
"""Every known quantity by name."""


def register_quantity(
    name: str,
    *,
    symbol: str,
    unit: str,
    meaning: str = "",
    minimum: float = 0.0,
    maximum: float = inf,
) -> Quantity:
    """Make a quantity of one's own known, so that model files, data headers and results can name it.

    Parameters
    ----------
    name : letters, digits and underscores; the name used everywhere
    symbol : for equations and plots, plain text
    unit : SI unit as written in headers, ``"1"`` for dimensionless numbers
    meaning : a short description
    minimum, maximum : its physical range in ``unit``, ends included

    Returns
    -------
    Quantity

    Raises
    ------
    InputError
        Not a name, or the name of another quantity.

    Examples
    --------
    >>> register_quantity("sebum_level", symbol="s", unit="kg/m^2", meaning="sebum on the skin").range_text()
    '>= 0 kg/m^2'
    >>> del QUANTITIES["sebum_level"]
    """
    meaning = meaning or name.replace("_", " ")
    return add_quantity(Quantity(name, symbol, unit, meaning, minimum, maximum, lower_open=False))


def add_quantity(quantity: Quantity) -> Quantity:
    """Make a quantity known, as :func:`register_quantity` does."""
    name = quantity.name
    if not (name.isidentifier() and name.isascii()):
        raise InputError(f"{name!r} cannot name a quantity; expected letters, digits and underscores")
    if name in LABELS or QUANTITIES.get(name, quantity) != quantity:
        raise InputError(f"'{name}' means something else already; give your quantity another name")
    QUANTITIES[name] = quantity
    return quantity


LABELS: dict[str, str] = {
    "person": "who was measured",
    "liquid": "the lubricant",
    "state": "state of the skin, such as dry or wet",
    "treatment": "what was done to the skin, such as before and after",
    "session": "strokes that were measured in one go: one person, one site, one state",
    "body_site": "where on the body",
    "counterface": "what slid against the skin",
    "elastomer": "which elastomer stood for skin",
    "instrument": "what it was measured with",
    "source": "key of the source the row was read in",
    "row_label": "a name for the row",
}
"""Usual names of label columns and their meaning; any other name without a unit is a label too."""

_SYMBOLS = {normalize("NFKC", quantity.symbol): quantity.name for quantity in reversed(ALL)}

STANDARD_DEVIATION_SUFFIX = "_standard_deviation"
"""A column ``<quantity>_standard_deviation`` holds the spread of that quantity, in its unit."""

STANDARD_ERROR_SUFFIX = "_standard_error"
"""A column ``<quantity>_standard_error`` holds that of a mean of several measurements, in its unit."""

_SPREADS = {STANDARD_DEVIATION_SUFFIX: "sd", STANDARD_ERROR_SUFFIX: "se"}


def spread_of(name: str) -> str | None:
    """The name whose spread a column of this name holds, None if it holds none.

    Examples
    --------
    >>> spread_of("normal_force_standard_error"), spread_of("normal_force")
    ('normal_force', None)
    """
    return next((name.removesuffix(suffix) for suffix in _SPREADS if name.endswith(suffix)), None)


def lookup(name: str) -> Quantity | None:
    """The quantity called ``name``; spread columns are recognised by their suffix; None if unknown."""
    if name in QUANTITIES:
        return QUANTITIES[name]
    base = QUANTITIES.get(spread_of(name) or "")
    if base is None:
        return None
    word = _SPREADS[name.removeprefix(base.name)]
    return Quantity(name, f"{word}({base.symbol})", base.unit, f"spread of {base.name}")


_LONGEST_NAME = 100


def suggestions(name: str, known: Collection[str]) -> str:
    """A sentence naming what is likely meant by ``name``, or an empty string.

    Examples
    --------
    >>> suggestions("rms_heigth", ["rms_height", "rms_slope"]), suggestions("replicate", list(QUANTITIES))
    (" Did you mean 'rms_height'?", '')
    """
    found = meant(name, known)
    said = [f"'{match}'" + (f" ({remark})" if remark else "") for match, remark in found]
    return f" Did you mean {' or '.join(said)}?" if said else ""


def meant(name: str, known: Collection[str], near: bool = True) -> list[tuple[str, str]]:
    """Which of the known names are likely meant by ``name``, each with a remark on how they differ (or ``""``).

    Synonyms, symbols and words for spreads (``mu``, ``COF``, ``σ_f``, ``load_sd``) count, and if ``near`` slips of the pen.

    Examples
    --------
    >>> meant("μ", list(QUANTITIES)), meant("load_sd", list(QUANTITIES))
    ([('friction_coefficient', '')], [('normal_force_standard_deviation', '')])
    """
    if len(name) > _LONGEST_NAME:  # the comparison takes time with the square of the length
        return []
    return likely_meant(name, known, _SYMBOLS, (STANDARD_DEVIATION_SUFFIX, STANDARD_ERROR_SUFFIX), near)
