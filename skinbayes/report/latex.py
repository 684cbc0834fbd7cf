"""Text as LaTeX and Markdown take it: characters with a meaning escaped, Greek letters and powers as mathematics."""

from __future__ import annotations

import re
import unicodedata

from skinbayes.plot.symbols import SUBSCRIPT

_PLAIN = {c: f"\\{c}" for c in "&%$#_{}"} | {
    "\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "<": "$<$", ">": "$>$", "|": "$|$",
    "–": "--", "—": "---", "…": r"\ldots{}", "“": "``", "”": "''", "‘": "`", "’": "'", "\u00a0": "~", '"': "''",
    "·": r"$\cdot$", "×": r"$\times$", "±": r"$\pm$", "−": "$-$", "≤": r"$\leq$", "≥": r"$\geq$", "≈": r"$\approx$",
    "°": r"$^{\circ}$", "∞": r"$\infty$", "→": r"$\to$", "∂": r"$\partial$", "√": r"$\surd$", "§": r"\S{}", "¬": r"$\neg$",
    "µ": r"$\mu$", "¹": "$^{1}$", "²": "$^{2}$", "³": "$^{3}$",
}  # fmt: skip

_GREEK = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "varepsilon", "ζ": "zeta", "η": "eta", "θ": "theta", "ι":
    "iota", "κ": "kappa", "λ": "lambda", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "ς": "varsigma", "σ":
    "sigma", "τ": "tau", "υ": "upsilon", "φ": "varphi", "χ": "chi", "ψ": "psi", "ω": "omega", "Γ": "Gamma", "Δ": "Delta",
    "Θ": "Theta", "Λ": "Lambda", "Ξ": "Xi", "Π": "Pi", "Σ": "Sigma", "Υ": "Upsilon", "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
    "ϕ": "phi", "ϑ": "vartheta",
}  # fmt: skip

_RAISED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺", "0123456789-+")
_POWER = re.compile("([⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺]+)|([^\\W\\d_][\u0302\u0303\u0304\u0307])")
"""Raised numbers, or a letter with an accent of mathematics."""

_ACCENTS = {"\u0307": "dot", "\u0304": "bar", "\u0302": "hat", "\u0303": "tilde"}
_KNOWN_TO_LATEX = 0x17F
"""Last of the letters that every LaTeX since 2018 takes as they are: Latin with accents."""


def latex_text(text: str) -> str:
    """Any text as LaTeX of the standard packages; letters of other scripts become their number.

    Examples
    --------
    >>> latex_text("50 % of σ_f, 3 × 10⁻⁴ m² & more")
    '50 \\\\% of $\\\\sigma_{\\\\mathrm{f}}$, 3 $\\\\times$ 10$^{-4}$ m$^{2}$ \\\\& more'
    >>> latex_text("ab_c\\\\input{x}"), latex_text("皮")
    ('ab\\\\_c\\\\textbackslash{}input\\\\{x\\\\}', '[U+76AE]')
    """
    text = " ".join(text.split())
    pieces, end = [], 0
    for match in SUBSCRIPT.finditer(text):
        letter, below = match.group(1), match.group(2) or match.group(3)
        symbol = _symbol(letter)
        before = text[match.start() - 1 : match.start()]
        if symbol is None or "_" in below or not below.isascii() or before == "_":
            continue
        inside = below if below.isdigit() else rf"\mathrm{{{below}}}"
        pieces += [_escaped(text[end : match.start()]), f"${symbol}_{{{inside}}}$"]
        end = match.end()
    return "".join([*pieces, _escaped(text[end:])])


def latex_symbol(symbol: str) -> str:
    """A symbol as LaTeX; a single letter is set as mathematics.

    Examples
    --------
    >>> latex_symbol("E"), latex_symbol("h_rms"), latex_symbol("noise_scale")
    ('$E$', '$h_{\\\\mathrm{rms}}$', 'noise\\\\_scale')
    """
    return f"${symbol}$" if len(symbol) == 1 and symbol.isascii() and symbol.isalpha() else latex_text(symbol)


def markdown_text(text: str) -> str:
    """Any text as Markdown shows it: nothing in it makes a link, a heading, markup or a cell of a table.

    Examples
    --------
    >>> markdown_text("a_b | <i>*c*</i>")
    'a\\\\_b \\\\| \\\\<i\\\\>\\\\*c\\\\*\\\\</i\\\\>'
    """
    return re.sub(r"([\\`*_\[\]<>|#$~@^])", r"\\\1", " ".join(text.split()))


def _symbol(letter: str) -> str | None:
    """A letter with its accent, ``Δ`` before it, or ``RH``, as mathematics; None for what is none of these."""
    if letter == "RH":
        return r"\mathrm{RH}"
    if letter.startswith("Δ") and len(letter) > 1:
        rest = _symbol(letter[1:])
        return None if rest is None else rf"\Delta {rest}"
    base, *accents = list(unicodedata.normalize("NFD", letter))
    known = rf"\{_GREEK[base]}" if base in _GREEK else base if base.isascii() else None
    if known is None or any(accent not in _ACCENTS for accent in accents):
        return None
    for accent in accents:
        known = rf"\{_ACCENTS[accent]}{{{known}}}"
    return known


def _escaped(text: str) -> str:
    pieces, end = [], 0
    for match in _POWER.finditer(text):
        raised = match.group(1)
        symbol = None if raised else _symbol(match.group(2))
        if raised or symbol:
            shown = f"$^{{{raised.translate(_RAISED)}}}$" if raised else f"${symbol}$"
            pieces += [*map(_character, text[end : match.start()]), shown]
            end = match.end()
    return "".join([*pieces, *map(_character, text[end:])])


def _character(c: str) -> str:
    if c in _PLAIN:
        return _PLAIN[c]
    if c in _GREEK:
        return rf"$\{_GREEK[c]}$"
    if (c.isascii() and c.isprintable()) or (0xC0 <= ord(c) <= _KNOWN_TO_LATEX):
        return c
    plain = unicodedata.normalize("NFKD", c)
    if plain.isascii() and plain.isprintable() and plain != c:
        return "".join(map(_character, plain))
    return f"[U+{ord(c):04X}]"
