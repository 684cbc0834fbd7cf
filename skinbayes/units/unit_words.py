"""Which words may stand in a unit, in which spellings, and what Pint calls them.

A registry of all units there are reads ``px`` as the pixel of a screen, ``Mm`` as a thousand kilometres and ``hand`` as ten
centimetres. The words of this list are the ones that friction, roughness and weather are measured in; anything else is unknown.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from difflib import get_close_matches

PREFIXES = {
    "T": "tera", "G": "giga", "M": "mega", "k": "kilo", "h": "hecto", "da": "deca", "d": "deci", "c": "centi", "m": "milli",
    "µ": "micro", "u": "micro", "n": "nano", "p": "pico",
}  # fmt: skip
"""SI prefixes in use; ``u`` stands for ``µ``."""


@dataclass(frozen=True)
class UnitWord:
    """A unit that may be written.

    Attributes
    ----------
    pint : what Pint calls it
    symbols : symbols, the usual one first; capital and small letters differ
    prefixes : SI prefixes that may stand before a symbol
    names : words for it in full, in capital or small letters, also with prefix and plural s
    """

    pint: str
    symbols: tuple[str, ...]
    prefixes: tuple[str, ...] = ()
    names: tuple[str, ...] = ()


def _unit(pint: str, symbols: str, prefixes: str = "", names: str = "") -> UnitWord:
    return UnitWord(pint, tuple(symbols.split()), tuple(prefixes.split()), tuple(names.split()))


UNIT_WORDS = (
    _unit("meter", "m", "k d c m µ n p", "metre meter"),
    _unit("micrometer", "", "", "micron"),
    _unit("angstrom", "Å", "", "angstrom"),
    _unit("inch", "in", "", "inch inches"),
    _unit("foot", "ft", "", "foot feet"),
    _unit("liter", "L l", "d c m µ n", "litre liter"),
    _unit("second", "s sec", "m µ n p", "second"),
    _unit("minute", "min", "", "minute"),
    _unit("hour", "h hr", "", "hour"),
    _unit("day", "d", "", "day"),
    _unit("gram", "g", "k m µ n", "gram gramme"),
    _unit("newton", "N", "k da c m µ n p", "newton"),
    _unit("force_gram", "gf", "m"),
    _unit("force_kilogram", "kgf kp"),
    _unit("dyne", "dyn", "", "dyne"),
    _unit("pound_force", "lbf"),
    _unit("pascal", "Pa", "T G M k h d m µ n p", "pascal"),
    _unit("bar", "bar", "k m", "bar"),
    _unit("atmosphere", "atm"),
    _unit("mmHg", "mmHg"),
    _unit("torr", "Torr", "", "torr"),
    _unit("psi", "psi"),
    _unit("pascal*second", "Pas", "m µ"),
    _unit("newton*second", "Ns", "m"),
    _unit("poise", "P", "c m", "poise"),
    _unit("centipoise", "cps"),
    _unit("stokes", "St", "c"),
    _unit("joule", "J", "M k m µ n p", "joule"),
    _unit("erg", "erg"),
    _unit("kelvin", "K", "m", "kelvin"),
    _unit("degree_Celsius", "°C degC C", "", "celsius"),
    _unit("degree_Fahrenheit", "°F degF F", "", "fahrenheit"),
    _unit("delta_degree_Celsius", "delta_degC"),
    _unit("delta_degree_Fahrenheit", "delta_degF"),
    _unit("radian", "rad", "m", "radian"),
    _unit("degree", "° deg", "", "degree"),
    _unit("percent", "%", "", "percent"),
    _unit("permille", "‰", "", "permille"),
)
"""Every unit that is understood."""

NO_UNITS = {
    "px": "a pixel has no size of its own: convert with the resolution of the picture",
    "dot": "a dot has no size of its own: convert with the resolution of the picture",
    "rpm": "a rotation is no speed: the speed is 2π times the radius times the rotations per time",
    "rh": "relative humidity is a fraction: write 50 % or 0.5",
    "hz": "a frequency is written 1/s, and a shear rate or a speed is something else",
}
"""Words that are often meant to be units, and why they are none."""
_SAME = {"%rh": "rh", "pixel": "px", "pixels": "px", "dots": "dot", "pt": "dot", "point": "dot"}

WITHOUT_DIMENSION = frozenset(("", "1", "-", "–", "—"))
"""What stands in the brackets of a number without dimension."""


def _spellings() -> tuple[dict[str, str], dict[str, str]]:
    """Symbols, and names in small letters, to what Pint is given."""
    symbols: dict[str, str] = {}
    names: dict[str, str] = {}
    for unit in UNIT_WORDS:
        written = {*unit.prefixes, *(["u"] if "µ" in unit.prefixes else [])}
        for prefix, said in (("", ""), *((prefix, PREFIXES[prefix]) for prefix in sorted(written))):
            for symbol in unit.symbols:
                symbols[prefix + symbol] = f"({said}{unit.pint})"
            for name in unit.names:
                names[said + name] = names[f"{said}{name}s"] = f"({said}{unit.pint})"
    return symbols, names


_SYMBOLS, _NAMES = _spellings()
_LONGEST = 40
_SAME_CHARACTER = str.maketrans({
    "º": "°", "˚": "°", "μ": "µ", "−": "-", "‐": "-", "‑": "-", "–": "-", "⁄": "/", "∕": "/", "÷": "/",
    "·": "*", "⋅": "*", "∙": "*", "•": "*", "×": "*", "‧": "*",
})  # fmt: skip
_DEGREES = re.compile(
    r"(?:°|\bdeg(?:rees?)?\.?)\s*(?:([Cc])(?:elsius)?|([Ff])(?:ahrenheit)?|(?:[Kk]elvins?|K))(?![A-Za-z])"
)
_POWER = r"(?:\s*(?:\^|\*\*)\s*(?:\(\s*[+-]?[1-9]\s*\)|[+-]?[1-9])|[+-]?[1-9])(?![0-9]|\s*(?:\^|\*\*))"
_WORD = re.compile(rf"(?P<word>[A-Za-zµÅ°%‰_]+)(?P<power>{_POWER})?")
_BETWEEN = re.compile(r"\s*/\s*|\s+per\s+|\s*\*\s*|\.(?=[A-Za-zµ])|-(?=[A-Za-zµ])|\s+")


class UnknownUnit(LookupError):
    """A text that is no unit; ``word`` is the part that is not understood, ``text`` all of it as it was taken apart."""

    def __init__(self, text: str, word: str = "") -> None:
        super().__init__(text)
        self.text, self.word = text, word


def plain_unit(text: str) -> str:
    """One spelling for what looks alike: ``µ``, ``°``, powers, signs of multiplication and division.

    Examples
    --------
    >>> plain_unit("N⋅m⁻¹"), plain_unit("ºC"), plain_unit("deg C")
    ('N*m-1', 'degC', 'degC')
    """
    text = unicodedata.normalize("NFKC", text.translate(_SAME_CHARACTER)).translate(_SAME_CHARACTER).strip()
    return _DEGREES.sub(lambda found: "degC" if found[1] else "degF" if found[2] else "K", text)


def canonical_unit(text: str) -> str:
    """Translate a unit as people write it into one that Pint reads in one way.

    Parameters
    ----------
    text : such as ``"mPa.s"``, ``"N m-1"``, ``"kg/(m s)"``, ``"1/um"``

    Returns
    -------
    str
        words of Pint with ``*``, ``/``, ``**`` and brackets; empty without dimension

    Raises
    ------
    UnknownUnit
        if a word or the way they are put together is not understood

    Examples
    --------
    >>> canonical_unit("mPa.s"), canonical_unit("N m-1"), canonical_unit("1/um")
    ('(millipascal)*(second)', '(newton)*(meter)**-1', '1/(micrometer)')
    """
    if text.strip() in WITHOUT_DIMENSION:
        return ""
    if len(text) > 4 * _LONGEST:  # before anything is made of it: characters may stand for many
        raise UnknownUnit(text[: 4 * _LONGEST])
    plain = plain_unit(text)
    if len(plain) > _LONGEST:
        raise UnknownUnit(plain)
    found, position, depth, operand = "", 0, 0, True
    while position < len(plain):
        rest = plain[position:]
        if operand and rest[0] == "(":
            found, position, depth = found + "(", position + 1, depth + 1
        elif operand and (one := re.match(r"1(?=\s*/)", rest)):
            found, position, operand = found + "1", position + one.end(), False
        elif operand and (word := _WORD.match(rest)):
            found += _pint_word(word["word"], plain) + _pint_power(word["power"])
            position, operand = position + word.end(), False
        elif not operand and depth and (closed := re.match(rf"\s*\)({_POWER})?", rest)):
            found += ")" + _pint_power(closed[1])
            position, depth = position + closed.end(), depth - 1
        elif not operand and (between := _BETWEEN.match(rest)):
            found += "/" if between[0].strip() in ("/", "per") else "*"
            position, operand = position + between.end(), True
        else:
            raise UnknownUnit(plain)
    fractions = _FRACTIONS.findall(found)
    if (
        operand or depth or len(fractions) > 1 or not {"", "**1", "**-1"}.issuperset(fractions)
    ):  # "% %" is a slip
        raise UnknownUnit(plain)
    return found


_FRACTIONS = re.compile(r"(?:percent|permille)\)(\*\*-?[0-9])?")


def is_unit(text: str) -> bool:
    """Whether a text is a unit, of whatever it may be."""
    try:
        return bool(canonical_unit(text))
    except UnknownUnit:
        return False


def _pint_word(word: str, text: str) -> str:
    if word in _SYMBOLS:
        return _SYMBOLS[word]
    if word.lower() in _NAMES:
        return _NAMES[word.lower()]
    raise UnknownUnit(text, word)


def _pint_power(power: str | None) -> str:
    return f"**{int(re.sub('[^0-9-]', '', power))}" if power else ""


def nearest_units(unknown: UnknownUnit) -> list[str]:
    """The text with the word that is not understood replaced by those most like it, the likeliest first.

    Examples
    --------
    >>> nearest_units(UnknownUnit("mpa", "mpa"))[:2]
    ['MPa', 'mPa']
    """
    word = unknown.word
    if not word:
        return []
    plurals = {f"{name}s" for name in _NAMES}
    known = [*_SYMBOLS, *(name for name in _NAMES if name not in plurals)]
    same = sorted((symbol for symbol in _SYMBOLS if symbol.lower() == word.lower()), key=str)
    close = get_close_matches(word, known, n=6, cutoff=0.6)
    return [
        re.sub(rf"(?<![A-Za-zµ]){re.escape(word)}(?![A-Za-zµ])", other, unknown.text)
        for other in dict.fromkeys([*same, *close])
    ]


def why_no_unit(word: str) -> str:
    """Why a word that is often taken for a unit is none, or an empty string."""
    small = word.lower()
    return NO_UNITS.get(_SAME.get(small, small), "")
