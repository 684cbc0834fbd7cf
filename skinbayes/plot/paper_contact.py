"""Figs. 3 to 6: surface, skin and contact area."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from skinbayes.phrases import number
from skinbayes.plot.paper_axes import DRY, OTHER, PRINTED, WET, PaperFigure, key_in, panels
from skinbayes.plot.style import key_below
from skinbayes.plot.symbols import figure_text
from skinbayes.reproduce.curves import areas, moduli
from skinbayes.reproduce.statements import printed_value
from skinbayes.roughness import rms_slope

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.reproduce import Paper
    from skinbayes.roughness import SelfAffineSpectrum

WINDOW = (1e3, 1e6)
"""Wavevectors of Fig. 3, 1/m; those of the measurement are not printed."""


def fig_3(paper: Paper, width: str | None = None) -> Figure:
    """Spectra over the wavevectors of the measurement."""
    with panels(width) as (figure, (ax,)):
        q = np.geomspace(*WINDOW, 200)
        _spectrum(ax, paper.surface, q, "computed with", color=OTHER)
        _spectrum(ax, paper.printed_surface, q, "four printed parameters", color=PRINTED, linestyle=":")
        _axes(ax)
    return figure


def fig_4(paper: Paper, width: str | None = None) -> Figure:
    """Spectra over all wavevectors."""
    with panels(width) as (figure, (ax,)):
        q = np.geomspace(paper["wavevector-min"] * 1.0001, paper["wavevector-max"] * 0.9999, 300)
        upper = replace(paper.surface, rms_height=float(paper.surface.rms_height) * paper["upper-line"])
        _spectrum(ax, upper, q, "upper line", color=OTHER, linestyle="--")
        _spectrum(ax, paper.surface, q, "lower line, computed with", color=OTHER)
        _spectrum(ax, paper.printed_surface, q, "four printed parameters", color=PRINTED, linestyle=":")
        _axes(ax)
    return figure


def _spectrum(
    ax: Axes, surface: SelfAffineSpectrum, q: np.ndarray, name: str, *, color: str, linestyle: str = "-"
) -> None:
    label = f"{name} (slope {number(float(rms_slope(surface)), 2)})"
    ax.loglog(q, surface.power(q), color=color, linestyle=linestyle, label=label)


def _axes(ax: Axes) -> None:
    ax.set_xlabel("wavevector q [1/m]")
    ax.set_ylabel(figure_text("power spectrum C [m⁴]"))
    key_in(ax, loc="lower left")


def fig_5(paper: Paper, width: str | None = None) -> Figure:
    """The model of the skin, and what it means for roughness of one wavevector."""
    with panels(width, 2) as (figure, (drawing, ax)):
        _layers(drawing, paper)
        q, found = moduli(paper)
        for state, colour, line in (("wet", WET, "-"), ("dry", DRY, "--")):
            ax.loglog(q, found[state], color=colour, linestyle=line, label=state)
        ax.axvline(1 / paper["layer-thickness"], color=PRINTED, linewidth=0.8, linestyle=(0, (1, 2)))
        ax.text(1 / paper["layer-thickness"] * 1.3, 3e4, "1/d", fontsize="small")
        ax.set_xlabel("wavevector q [1/m]")
        ax.set_ylabel(figure_text("effective modulus [Pa]"))
        key_in(ax, loc="upper left")
    return figure


def _layers(ax: Axes, paper: Paper) -> None:
    x = np.linspace(0.0, 1.0, 400)
    waves = sum(
        a * np.sin(2 * np.pi * k * x + p) for k, a, p in ((2, 0.02, 0.3), (5, 0.012, 1.9), (11, 0.006, 4.0))
    )
    ax.fill_between(x, 0.0, 0.6, color="#F3D9C4", linewidth=0.0)
    ax.fill_between(x, 0.6, 0.78 + waves, color="#DDA77B", linewidth=0.0)
    ax.fill_between(x, 0.83, 1.0, color="#C9CED6", linewidth=0.0)
    wet, dry = (number(paper[f"young-modulus-layer-{state}"] / 1e6) for state in ("wet", "dry"))
    ax.text(0.5, 0.915, "rigid, smooth", ha="center", va="center")
    ax.text(
        0.57,
        0.69,
        figure_text(f"E0 = {wet} (wet), {dry} MPa (dry)"),
        ha="center",
        va="center",
        fontsize="small",
    )
    ax.text(0.5, 0.3, figure_text(f"E1 = {number(paper['young-modulus-bulk'] / 1e3)} kPa, ν0 = ν1 = 0.5"), ha="center",
            va="center", fontsize="small")  # fmt: skip
    ax.annotate("", (0.06, 0.6), (0.06, 0.765), arrowprops={"arrowstyle": "<->", "linewidth": 0.8})
    ax.text(
        0.04,
        0.52,
        f"d = {number(1e6 * paper['layer-thickness'])} µm",
        ha="left",
        va="center",
        fontsize="small",
    )
    ax.set(xlim=(0, 1), ylim=(0, 1), xticks=[], yticks=[])
    ax.grid(visible=False)
    for spine in ax.spines.values():
        spine.set_visible(False)


def fig_6(paper: Paper, width: str | None = None) -> Figure:
    """Contact area against magnification."""
    found = areas(paper)
    with panels(width, height=3.3, top=0.6, key=3) as (figure, (ax,)):
        q0 = paper["wavevector-min"]
        zoom = found.wavevector / q0
        ax.loglog(zoom, found.wet, color=WET, label="wet")
        ax.loglog(zoom, found.dry, color=DRY, linestyle="--", label="dry")
        ax.loglog(
            zoom,
            found.wet_plain,
            color=WET,
            linewidth=0.9,
            alpha=0.7,
            linestyle=":",
            label="wet, Eqs. 2 and 3 alone",
        )
        ax.loglog(
            zoom,
            found.dry_elastic,
            color=DRY,
            linewidth=0.9,
            alpha=0.7,
            linestyle=":",
            label="dry, without yielding",
        )
        for name, colour, marker in (("wet-area", WET, "o"), ("dry-area", DRY, "s")):
            ax.plot(zoom[-1], printed_value(name), marker, color=colour, markerfacecolor="white", markersize=6,
                    clip_on=False, zorder=5, linestyle="none", label=f"printed, {name[:3]}")  # fmt: skip
        onset = printed_value("plastic-onset") / q0
        ax.annotate("yielding begins (printed)", (onset, 0.02), (onset * 1.6, 0.12), fontsize="small",
                    arrowprops={"arrowstyle": "->", "linewidth": 0.8})  # fmt: skip
        ax.set_xlabel("magnification ζ")
        ax.set_ylabel(figure_text("contact area A/A0"))
        ax.set_ylim(1e-6, 2.0)
        above = ax.secondary_xaxis("top", functions=(partial(np.multiply, q0), partial(np.multiply, 1 / q0)))
        above.set_xlabel("wavevector q [1/m]")
        key_below(figure, ax, 2)
    return figure


CONTACT = (
    PaperFigure(
        "fig03", fig_3, "Power spectra at large wavelengths",
        "Logarithmic axes; two straight lines that bend into plateaus at small wavevectors.",
        "Ours: the spectrum of the calculations, and that of the four parameters as printed. Not here: the measured "
        "spectra of dry and wet skin, red, green and blue in the paper, whose data are not available.",
    ),
    PaperFigure(
        "fig04", fig_4, "Power spectra over six decades",
        "Three parallel straight lines on logarithmic axes.",
        "Ours: the two green lines of the paper – the one of the calculations and one with twice the rms roughness – "
        "and what the four printed parameters give, ten times lower. Not here: the measured spectra.",
    ),
    PaperFigure(
        "fig05", fig_5, "The model of the skin",
        "A drawing of a stiff rough layer on a soft bulk; beside it a modulus that rises from that of the bulk to "
        "that of the layer.",
        "Left the skin of the calculations, all numbers as printed. Right, not in the paper: what it means, the "
        "modulus that roughness of a wavevector feels, E0*/S(q) with S of Eq. 4. It is that of the layer where "
        "wavelengths are shorter than the layer is thick.",
    ),
    PaperFigure(
        "fig06", fig_6, "Contact area against magnification",
        "Four falling curves on logarithmic axes, wet above dry at the right; dry levels off where it yields.",
        "Ours: wet and dry skin, the correction γ = 0.42 included. Thin: Eqs. 2 and 3 alone, and dry skin that cannot "
        "yield. Open symbols: the two areas printed at the highest magnification; the arrow is where the paper sees "
        "yielding begin.",
    ),
)  # fmt: skip
"""Figures of Sects. 3 and 4."""
