"""Figs. 7 to 10, 16 and 17: water between skin and glass."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from skinbayes.plot.paper_axes import (
    DRY,
    OTHER,
    PRINTED,
    WET,
    PaperFigure,
    key_in,
    panels,
    printed_line,
    printed_place,
)
from skinbayes.plot.style import key_below
from skinbayes.plot.symbols import figure_text
from skinbayes.reproduce.choices import FILMS, HUMIDITIES, MOIST_AIR, TIMES
from skinbayes.reproduce.curves import layer_moduli
from skinbayes.reproduce.drying import curve
from skinbayes.reproduce.humid import SOFT, STIFF, humid_skin
from skinbayes.reproduce.printed import read_printed
from skinbayes.reproduce.statements import printed_value, statements

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.reproduce import Paper

MICRO = 1e6
GLASS = (("angle-glass", "0° on glass", WET, "-"), ("angle-glass-red", "20° on glass", DRY, "--"))


def fig_7(paper: Paper, width: str | None = None) -> Figure:
    """Friction while a droplet dries."""
    with panels(width, height=3.2) as (figure, (ax,)):
        for closure, colour, line in (("gaussian", WET, "-"), ("sharp", OTHER, "--")):
            friction = curve(paper, closure=closure).friction_coefficient
            name = "Gaussian gaps" if closure == "gaussian" else "sharp gaps"
            ax.plot(TIMES, friction, color=colour, linestyle=line, label=name)
        start, dry = paper["droplet-time"], paper["droplet-time"] + printed_value("time-until-dry")
        printed_line(ax, paper["friction-measured-wet"], "wet, printed ≈ 1.4", 0.1)
        printed_line(ax, paper["friction-measured-dry"], "dry, printed ≈ 0.3", 0.1)
        printed_place(ax, start, "droplet")
        printed_place(ax, dry, "dry again,\nprinted:\nabout 500 s")
        ax.set(xlabel="time [s]", ylabel="friction coefficient", xlim=(0, 750), ylim=(0, 2.7))
        key_in(ax, loc="center", bbox_to_anchor=(0.35, 0.78))
    return figure


def fig_8(paper: Paper, width: str | None = None) -> Figure:
    """Contact area against the mean film."""
    with panels(width, key=2) as (figure, (ax,)):
        for angle, name, colour, line in GLASS:
            for closure, weight in (("gaussian", 1.6), ("sharp", 0.8)):
                area = _area(paper, angle, closure)
                label = name if closure == "gaussian" else f"{name}, sharp gaps"
                ax.plot(
                    _films() * MICRO, 1e3 * area, color=colour, linestyle=line, linewidth=weight, label=label
                )
        printed_place(ax, printed_value("flooding-film") * MICRO, "flooded above\n14 µm, printed")
        ax.set(xlabel="mean water film [µm]", xlim=(0, 20))
        ax.set_ylabel(figure_text("1000 A/A0"))
        ax.set_ylim(0.6, 1.3)
        key_below(figure, ax, 2)
    return figure


def _films() -> np.ndarray:
    return np.concatenate([FILMS[FILMS < 2.5e-7], np.linspace(2.5e-7, 2e-5, 140)])


def _area(paper: Paper, angle: str, closure: str = "gaussian") -> np.ndarray:
    return paper.bridges(_films(), angle=angle, closure=closure).relative_contact_area


def fig_9(paper: Paper, width: str | None = None) -> Figure:
    """Contact area and wet area."""
    states = paper.bridges(_films())
    with panels(width) as (figure, (ax,)):
        x = _films() * MICRO
        ax.plot(x, 1e3 * states.relative_contact_area, color=WET, label=figure_text("1000 A/A0"))
        ax.plot(x, states.wet_area, color=PRINTED, linestyle="--", label="wet area")
        ax.set(
            xlabel="mean water film [µm]", ylabel="fraction of the nominal area", xlim=(0, 20), ylim=(0, 1.2)
        )
        key_in(ax, loc="lower right")
    return figure


def fig_10(paper: Paper, width: str | None = None) -> Figure:
    """Mean separation of all and of the wet area."""
    states = paper.bridges(_films())
    with panels(width) as (figure, (ax,)):
        x = _films() * MICRO
        ax.plot(x, MICRO * states.mean_separation, color=WET, label="mean separation ū")
        ax.plot(x, MICRO * states.mean_separation_wet, color=PRINTED, linestyle="--", label="in the wet area")
        printed_line(ax, MICRO * printed_value("separation-without"), "≈ 13 µm without, printed")
        printed_line(ax, MICRO * printed_value("separation-with"), "≈ 10 µm, printed")
        film = statements()["film-at-strongest"].printed
        assert film is not None
        ax.axvspan(MICRO * film.low, MICRO * film.high, color="#000000", alpha=0.07, linewidth=0.0)
        ax.set(xlabel="mean water film [µm]", ylabel="separation [µm]", xlim=(0, 20), ylim=(0, 15.5))
        key_in(ax, loc="lower right")
    return figure


def fig_16(paper: Paper, width: str | None = None) -> Figure:
    """Contact area in humid air."""
    with panels(width, key=2) as (figure, (ax,)):
        for modulus, name, colour, line in (
            (SOFT, "E0 = 7 MPa", WET, "-"), (STIFF, "E0 = 70 MPa", DRY, "--"),
        ):  # fmt: skip
            for closure, weight in (("gaussian", 1.6), ("sharp", 0.8)):
                area = humid_skin(paper, modulus, HUMIDITIES, closure).relative_contact_area
                label = figure_text(name if closure == "gaussian" else f"{name}, sharp gaps")
                ax.plot(
                    100 * HUMIDITIES,
                    np.log10(area),
                    color=colour,
                    linestyle=line,
                    linewidth=weight,
                    label=label,
                )
        printed_place(ax, 100 * MOIST_AIR, "90 %")
        ax.set(xlabel="relative humidity [%]", xlim=(0, 100), ylim=(-4.6, 0.3))
        ax.set_ylabel(figure_text("log10 A/A0"))
        key_below(figure, ax, 2)
    return figure


def fig_17(paper: Paper, width: str | None = None) -> Figure:
    """Modulus of the layer against humidity."""
    humidity, modulus = layer_moduli(paper)
    with panels(width) as (figure, (ax,)):
        ax.plot(100 * humidity, np.log10(modulus), color=WET, label="shape assumed in skinbayes")
        for place, state in ((0.0, "dry"), (100.0, "wet")):
            words = statements()[f"{state}-modulus-range"].words
            printed = read_printed(words, "Pa", where=state)
            ax.plot([place, place], np.log10([printed.low, printed.high]), color=PRINTED, linewidth=5,
                    solid_capstyle="butt", clip_on=False, label=f"printed, {state}: {words}")  # fmt: skip
        ax.set(xlabel="relative humidity [%]", xlim=(0, 100), ylim=(6.4, 9.8))
        ax.set_ylabel(figure_text("log10 of the modulus E0 in Pa"))
        key_in(ax, loc="lower left")
    return figure


WATER = (
    PaperFigure(
        "fig07", fig_7, "Friction while a droplet dries",
        "Friction jumps from 0.3 to 1.4, stays, rises to a peak above 2 near 500 s and falls back to 0.3.",
        "Ours: friction of the model while 90 µm of water evaporate at the rate of Eq. 8, with Gaussian and with "
        "sharp gaps. Dotted: what the text says of the measurement. Not here: the measured series of Fig. 7, whose "
        "data are not available; the height of its peak is not printed.",
    ),
    PaperFigure(
        "fig08", fig_8, "Contact area against the water film",
        "Two curves that rise from zero film to a broad maximum and fall back at 14 µm.",
        "Ours: 0° (blue) and 20° (red) on glass, 80° on skin; thick with Gaussian gaps, thin with sharp ones, which "
        "the paper most likely used. Above its mean separation the gap is flooded and nothing pulls.",
    ),
    PaperFigure(
        "fig09", fig_9, "Contact area and wet area",
        "The wet area rises to 1 where the gap is flooded; the contact area has its maximum on the way.",
        "Ours, 0° on glass, Gaussian gaps. Nothing of this figure is printed as a number.",
    ),
    PaperFigure(
        "fig10", fig_10, "Mean separation with bridges",
        "The mean separation dips below its value without bridges; that of the wet area rises from zero to meet it.",
        "Ours, 0° on glass, Gaussian gaps. Dotted lines and grey band: separations and films that the text prints. "
        "The dip is less deep than printed, whichever way the gaps are described.",
    ),
    PaperFigure(
        "fig16", fig_16, "Contact area in humid air",
        "A soft layer is nearly in full contact in dry air and loses contact in humid air; a stiff one is flat near −4.1.",
        "Ours: a layer of 7 MPa and one of 70 MPa at all humidities; thick with Gaussian gaps, thin with sharp ones. "
        "Where the soft curve comes down depends on how the gaps are described, that the stiff one is flat does not.",
    ),
    PaperFigure(
        "fig17", fig_17, "Modulus of the layer against humidity",
        "A curve that is flat in dry air and falls by two decades in humid air.",
        "Ours: the curve of the shipped models, whose shape is an assumption. Thick bars: moduli that the text prints "
        "for both ends. Not here: the measured points and their spline, whose data are not available.",
    ),
)  # fmt: skip
"""Figures of Sect. 5 and Appendix A."""
