"""Products of powers and changes of parameters as people write them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from skinbayes.arrays import FloatArray
from skinbayes.phrases import and_list, percent


def power(name: str, low: float, value: float, high: float, exact: float | None) -> str:
    """A name with a positive exponent: ``"a"``, ``"a^2"``, ``"a^(1/2)"``, ``"a^0.14"``, ``"a^(0.1 to 0.8)"``."""
    if exact is not None:
        if exact == 1.0:
            return name
        if exact == round(exact):
            return f"{name}^{exact:.0f}"
        denominator = 2 if 2.0 * exact == round(2.0 * exact) else 3
        return f"{name}^({exact * denominator:.0f}/{denominator})"
    if high - low < 0.05 * max(1.0, abs(value)):
        return f"{name}^{value:.2g}"
    # ends to two decimals; adding 0 turns -0 into 0
    return f"{name}^({round(low, 2) + 0.0:.2g} to {round(high, 2) + 0.0:.2g})"


def product(
    exponents: Mapping[str, tuple[float, float, float, float | None]], others: Sequence[str] = ()
) -> str:
    """A product of powers.

    Parameters
    ----------
    exponents : name to low, typical and high exponent, and the exact fraction if there is one
    others : names that enter in another way than by a power

    Examples
    --------
    >>> product({"a": (1, 1, 1, 1.0), "b": (-1, -1, -1, -1.0), "c": (-2, -2, -2, -2.0)})
    'a / (b · c^2)'
    """
    above, below = [], []
    for name, (low, value, high, exact) in exponents.items():
        if high <= 0.0 or (exact is not None and exact < 0.0):
            below.append(power(name, -high, -value, -low, None if exact is None else -exact))
        else:
            above.append(power(name, low, value, high, exact))
    text = " · ".join(above) if above or not below else "1"
    if below:
        text += f" / {below[0]}" if len(below) == 1 else f" / ({' · '.join(below)})"
    if others:
        text = f"{text} with {and_list(others)}" if exponents else and_list(others)
    return text


def change(names: Sequence[str], amounts: FloatArray, relative: Sequence[bool], constant: bool = True) -> str:
    """A simultaneous change of parameters: ``"Raising a and b by 10 % each"``.

    ``amounts`` are relative changes where ``relative`` is True, else absolute ones; they are said if ``constant``.
    """
    parts = []
    sizes = [f"{percent(abs(a))}" if r else f"{abs(a):.2g}" for a, r in zip(amounts, relative, strict=True)]
    verbs = ["raising" if amount > 0.0 else "lowering" for amount in amounts]
    if not constant:
        up = [name for name, verb in zip(names, verbs, strict=True) if verb == "raising"]
        down = [name for name, verb in zip(names, verbs, strict=True) if verb == "lowering"]
        moves = ([f"raising {and_list(up)}"] if up else []) + ([f"lowering {and_list(down)}"] if down else [])
        text = f"{' and '.join(moves)} together, in a proportion that varies over the prior,"
    elif len(set(sizes)) == 1 and len(set(verbs)) == 1 and len(names) > 1:
        text = f"{verbs[0]} {and_list(list(names))} by {sizes[0]} each"
    else:
        for name, verb, size in zip(names, verbs, sizes, strict=True):
            parts.append(f"{verb} {name} by {size}")
        text = and_list(parts)
    return text[0].upper() + text[1:]
