"""Names of quantities as figures and pages show them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from skinbayes.vocabulary import LABELS, QUANTITIES

if TYPE_CHECKING:
    from skinbayes.fit.result import FitResult

SUBSCRIPT = re.compile(r"(?<![^\W_])(RH(?=_)|Δ?[^\W\d_][\u0300-\u036f]?)(?:_(\w+)|(\d))(?!\w)")
"""A letter (with an accent, or a difference of it) and its subscript: ``σ_f``, ``E0``, ``A_pl``, ``Δt_peak``; and ``RH_t``."""

_SPOKEN = (
    (re.compile(r"^young_modulus_layer_(dry|wet)$"), r"Young's modulus of the \1 layer"),
    (re.compile(r"^young_modulus_"), "Young's modulus of the "),
    (re.compile(r"^poisson_ratio_"), "Poisson ratio of the "),
    (re.compile(r"^contact_angle_"), "contact angle on "),
    (re.compile(r"^wavevector_(min|max|rolloff)$"), r"\1 wavevector"),
    (re.compile(r"^min wavevector"), "smallest wavevector"),
    (re.compile(r"^max wavevector"), "largest wavevector"),
    (re.compile(r"^rolloff wavevector"), "roll-off wavevector"),
    (re.compile(r"^relative_contact_area_(elastic|plastic)$"), r"\1 relative contact area"),
    (re.compile(r"^mean_separation_wet$"), "mean separation in the wet area"),
    (re.compile(r"^rms_"), "root-mean-square "),
    (re.compile(r"^speed_viscosity_product$"), "speed times viscosity"),
    (re.compile(r"_"), " "),
)


def figure_text(text: str) -> str:
    """Text for a figure, with subscripts set as such; a dollar sign stays one.

    Examples
    --------
    >>> figure_text("σ_f/(E0 s)"), figure_text("Δt_peak"), figure_text("costs $5")
    ('$\\\\mathregular{σ_{f}}$/($\\\\mathregular{E_{0}}$ s)', '$\\\\mathregular{Δt_{peak}}$', 'costs \\\\$5')
    """
    pieces, end = [], 0
    for match in SUBSCRIPT.finditer(text):
        pieces.append(text[end : match.start()].replace("$", r"\$"))
        letter, below = match.group(1), match.group(2) or match.group(3)
        plain = (
            letter.isalpha() and (letter == "RH" or len(letter.removeprefix("Δ")) == 1) and "_" not in below
        )
        pieces.append(
            rf"$\mathregular{{{letter}_{{{below}}}}}$" if plain and "$" not in text else match.group(0)
        )
        end = match.end()
    return "".join([*pieces, text[end:].replace("$", r"\$")])


def spoken_name(label: str) -> str:
    """A parameter label as people say it.

    Examples
    --------
    >>> spoken_name("young_modulus_layer[wet]"), spoken_name("frictional_shear_stress")
    ("Young's modulus of the layer (wet)", 'frictional shear stress')
    """
    name, _, level = label.partition("[")
    if name in QUANTITIES or name in LABELS:
        for pattern, replacement in _SPOKEN:
            name = pattern.sub(replacement, name)
    else:
        name = name.replace("_", " ")
    of, comma, rest = level.removesuffix("]").partition(", ")
    if of in QUANTITIES:  # of a population: the parameter that has it
        of = spoken_name(of)
    return f"{name} ({of}{comma}{rest})" if level else name


def figure_symbol(fit: FitResult, label: str) -> str:
    """Symbol of a parameter for a figure."""
    return figure_text(fit.symbol(label))


def axis_name(name: str) -> tuple[str, str]:
    """SI unit of a quantity, and its name and symbol for an axis; names without entry in the vocabulary have none.

    Examples
    --------
    >>> axis_name("normal_force")
    ('N', 'normal force $\\\\mathregular{F_{N}}$')
    """
    known = QUANTITIES.get(name)
    if known is None:
        return "1", figure_text(spoken_name(name))
    return known.unit, f"{spoken_name(name)} {figure_text(known.symbol)}"
