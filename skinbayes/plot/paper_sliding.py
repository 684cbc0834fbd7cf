"""Figs. 11 to 15 and 19 to 21: ball, cylinder and lubricated skin."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.phrases import number, power_of_ten
from skinbayes.plot.paper_axes import (
    DASHES,
    DRY,
    OTHER,
    PRINTED,
    WET,
    PaperFigure,
    friction_axes,
    key_in,
    letters,
    panels,
    printed_line,
)
from skinbayes.plot.style import key_below
from skinbayes.reproduce.ball import smooth_cylinder, smooth_sphere
from skinbayes.reproduce.curves import STEEP, ratios, shape
from skinbayes.reproduce.liquid import flow_factor_curves, thinning_curves
from skinbayes.reproduce.statements import printed_value
from skinbayes.reproduce.stribeck import ball_curve, plain_curve, profiles

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from skinbayes.reproduce import Paper

MILLI, MICRO, KILO = 1e3, 1e6, 1e-3
FIG_11 = np.geomspace(1e-4, 1.0, 17)
"""Speed times viscosity of Fig. 11, N/m."""


def fig_11(paper: Paper, width: str | None = None) -> Figure:
    """Smooth sphere and its cylinder."""
    with panels(width) as (figure, (ax,)):
        for name, friction, slope, colour, line in (
            ("sphere", smooth_sphere, "slope-sphere", DRY, "-"),
            ("cylinder", smooth_cylinder, "slope-cylinder", WET, "--"),
        ):
            found = friction(paper, FIG_11)
            ax.plot(FIG_11, found, color=colour, linestyle=line, label=name)
            window = np.array([1e-3, 1e-1])
            middle = float(np.exp(np.interp(np.log(1e-2), np.log(FIG_11), np.log(found))))
            up = 1.6 if name == "sphere" else 1 / 1.6
            exponent = printed_value(slope)
            ax.plot(window, up * middle * (window / 1e-2) ** exponent, color=PRINTED, linewidth=0.8, linestyle=line,
                    label=f"printed exponent {exponent:.2f}")  # fmt: skip
        friction_axes(ax, 8e-4)
        key_in(ax, loc="upper left")
    return figure


def fig_12(paper: Paper, width: str | None = None) -> Figure:
    """What there is of the measured curve: the range of its abscissa, beside the computed one."""
    low = paper["oil-speed-least"] * paper["oil-viscosity-least"]
    high = paper["oil-speed-most"] * paper["oil-viscosity-most"]
    with panels(width, key=2) as (figure, (ax,)):
        found = ball_curve(paper).friction_coefficient
        ax.plot(paper.products, found, color=WET, label="computed, ball")
        for factor, line, name in ((20.0, "--", "text"), (10.0, ":", "abstract")):
            ax.plot(paper.products / factor, found, color=OTHER, linestyle=line, linewidth=1.1,
                    label=f"shifted by {factor:.0f} ({name})")  # fmt: skip
        ax.axvspan(low, high, color="#000000", alpha=0.07, linewidth=0.0, label="range of the experiment")
        friction_axes(ax)
        ax.set_xlim(3e-7, 5.0)
        key_below(figure, ax, 2)
    return figure


PARTS: tuple[tuple[str, Any, str], ...] = (
    ("boundary", ":", "contacts"),
    ("couette", "-.", "shear flow"),
    ("pressure_flow", (0, (5, 1, 1, 1, 1, 1)), "pressure flow"),
)
"""Parts of friction, their lines and names."""


def fig_13(paper: Paper, width: str | None = None) -> Figure:
    """Stribeck curve of skin."""
    with panels(width, key=3) as (figure, (ax,)):
        line, ball = plain_curve(paper), ball_curve(paper)
        ax.plot(
            paper.products, line.friction_coefficient, color=WET, label="cylinder of Eq. 9, as in the paper"
        )
        ax.plot(
            paper.products,
            ball.friction_coefficient,
            color=DRY,
            linestyle="--",
            label="ball, in two dimensions",
        )
        for part, dash, name in PARTS:
            ax.plot(
                paper.products,
                getattr(line, part),
                color="#6A6A6A",
                linewidth=0.9,
                linestyle=dash,
                label=name,
            )
        printed_line(ax, paper["friction-measured-wet"], "wet skin, printed ≈ 1.4", 0.6)
        friction_axes(ax, 5e-3)
        key_below(figure, ax, 2)
    return figure


def fig_14(paper: Paper, width: str | None = None) -> Figure:
    """Elastic and lossy tissue under a cylinder, dry and lubricated."""
    cases: tuple[tuple[float, str, str, Any], ...] = (
        (0.0, "elastic", WET, "-"), (paper.loss_tangent, "loss 25 %", OTHER, "--"), (STEEP, "loss 60 %", DRY, "-."),
    )  # fmt: skip
    with panels(width, 2, key=1) as (figure, axes):
        for ax, product in zip(axes, (1e-5, 0.1), strict=True):
            for tangent, name, colour, line in cases:
                found = shape(paper, tangent, product)
                ax.plot(
                    found.position * MILLI, found.tissue * MICRO, color=colour, linestyle=line, label=name
                )
            x = np.linspace(-6e-3, 6e-3, 200)
            height = x**2 / (2 * float(paper.cylinder.cylinder_radius))
            ax.plot(x * MILLI, height * MICRO, color=PRINTED, linewidth=0.9, label="cylinder")
            ax.set(xlabel="x [mm]", xlim=(-5.5, 5.5), ylim=(-300, 1700))
        axes[0].set_ylabel("height [µm]")
        letters(axes)
        handles, names = axes[0].get_legend_handles_labels()
        figure.legend(handles, names, loc="lower center", ncols=4, bbox_to_anchor=(0.5, 0.0))
    return figure


def fig_15(paper: Paper, width: str | None = None) -> Figure:
    """Mean separation and asperity pressure across the contact."""
    from matplotlib import colormaps

    products, found = profiles(paper)
    shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(products)))
    x = np.broadcast_to(found.position, found.separation.shape) * MILLI
    with panels(width, 2, key=3) as (figure, (films, pressures)):
        for row, product in enumerate(products):
            name = power_of_ten(round(float(np.log10(product))))
            films.semilogy(x[row], found.separation[row] * MICRO, color=shades[row], label=f"{name}")
            pressures.plot(x[row], found.asperity_pressure[row] * KILO, color=shades[row])
        films.set(xlabel="x [mm]", ylabel="separation ū [µm]", xlim=(-4.5, 4.5), ylim=(8, 2e4))
        pressures.set(xlabel="x [mm]", ylabel="asperity pressure [kPa]", xlim=(-4.5, 4.5), ylim=(0, None))
        letters((films, pressures))
        handles, names = films.get_legend_handles_labels()
        figure.legend(
            handles, names, loc="lower center", ncols=5, bbox_to_anchor=(0.5, 0.0), title="ηv [N/m]"
        )
    return figure


def fig_19(paper: Paper, width: str | None = None) -> Figure:
    """The factors of the ellipse."""
    ratio, radius, load = ratios()
    with panels(width) as (figure, (ax,)):
        ax.plot(ratio, radius, color=WET, label=r"radius, $\mathregular{C_e/C}$")
        ax.plot(ratio, load, color=DRY, linestyle="--", label=r"load, $\mathregular{C′_e/C′}$")
        ax.set(xlabel="a/b", ylabel="over that of the circle", xlim=(1, 10), ylim=(0, 1.05))
        key_in(ax, loc="upper right")
    return figure


def fig_20(paper: Paper, width: str | None = None) -> Figure:
    """Trivial flow factors and those of the gaps."""
    trivial, full = flow_factor_curves(paper)
    with panels(width, 2, key=1) as (figure, (ax, ratio)):
        ax.plot(paper.products, full, color=DRY, label="flow and friction factors")
        ax.plot(paper.products, trivial, color=WET, linestyle="--", label="trivial factors")
        friction_axes(ax)
        ratio.semilogx(paper.products, full / trivial, color=PRINTED)
        ratio.set(xlabel="speed × viscosity ηv [N/m]", ylabel="ratio of friction")
        letters((ax, ratio))
        key_below(figure, ax, 2)
    return figure


def fig_21(paper: Paper, width: str | None = None) -> Figure:
    """Shear thinning oils."""
    oils, rows = thinning_curves(paper)
    plain = plain_curve(paper).friction_coefficient
    with panels(width, 2, key=1 if width is None else 3) as (figure, (ax, change)):
        colours = (WET, OTHER, DRY, "#CC79A7", PRINTED)
        for row, (oil, friction) in enumerate(zip(oils, rows, strict=True)):
            style: dict[str, Any] = {
                "color": colours[row % 5],
                "linestyle": DASHES[row % 4],
                "label": f"{number(float(oil))} Pa s",
            }
            ax.plot(paper.products, friction, **style)
            change.semilogx(paper.products, 100 * (friction / plain - 1), **style)
        friction_axes(ax)
        change.set(xlabel="speed × viscosity ηv [N/m]", ylabel="change by thinning [%]")
        letters((ax, change))
        key_below(figure, ax, 5)
    return figure


SLIDING = (
    PaperFigure(
        "fig11", fig_11, "Sphere and cylinder",
        "Two rising lines on logarithmic axes, the sphere slightly steeper and above the cylinder.",
        "Ours: the smooth sphere in two dimensions and the cylinder of Eq. 9 that stands for it. Thin: lines of the "
        "printed exponents 0.50 and 0.47, beside the curves. The paper has rough surfaces; what they are is not "
        "printed, so that the falling part is not here.",
    ),
    PaperFigure(
        "fig12", fig_12, "The measured Stribeck curve: what is available",
        "A computed curve and two copies of it at lower speeds; grey is the range of the experiment.",
        "Ours: the ball on skin, and the same curve at a 20th and a tenth of its speed, where the paper says the "
        "measurement lies. Grey: speeds and viscosities of the experiment, as printed. Not here: the measured points, "
        "whose data are not available.",
    ),
    PaperFigure(
        "fig13", fig_13, "Stribeck curve of skin",
        "Friction falls from a plateau of 1.4 to a minimum near 0.02 N/m and rises again.",
        "Ours: the cylinder of Eq. 9 with trivial flow factors, its three parts (grey), and the ball itself. The "
        "friction of the minimum is not printed; the plateau is the friction of wet skin.",
    ),
    PaperFigure(
        "fig14", fig_14, "Tissue that comes back late",
        "The tissue touches the cylinder further in front than behind it; the more it loses, the more so.",
        "Ours, in place of the drawing of the paper: heights of cylinder and tissue, (a) nearly dry, ηv = 10⁻⁵ N/m, "
        "(b) lubricated, 0.1 N/m, smooth, for elastic tissue, for the printed loss of 25 % and for 60 %. Skin enters "
        "at the left. The tissue is lower at the exit, as the paper says.",
    ),
    PaperFigure(
        "fig15", fig_15, "Separation and asperity pressure across the contact",
        "Separations rise with speed and have a constriction at the exit; asperity pressures fall, the last at the exit.",
        "Ours: (a) mean separation, (b) pressure on the asperities under the cylinder, skin enters at the left; from "
        "slow (dark) to fast. The last curves, from 1 N/m, lie beyond the parabola of the ball.",
    ),
    PaperFigure(
        "fig19", fig_19, "Cylinder for an ellipse",
        "Two curves that fall from 1 as the ellipse gets longer.",
        "Ours, Eq. B1. Nothing of this figure is printed as a number but that both are 1 for the circle.",
    ),
    PaperFigure(
        "fig20", fig_20, "Flow factors",
        "Two Stribeck curves that differ on the falling flank; beside them their ratio, between 0.7 and 1.3.",
        "Ours: (a) friction at 1 Pa s with trivial factors and with those of the gap statistics, (b) their ratio, "
        "which the paper does not show. It calls the difference negligible; that holds on the plateau and on the "
        "rising branch.",
    ),
    PaperFigure(
        "fig21", fig_21, "Shear thinning",
        "Five Stribeck curves that cannot be told apart; beside them changes of less than two percent.",
        "Ours: (a) friction in oils that thin after Appendix C, (b) the change against an oil that does not. The "
        "paper calls it negligible, and it is.",
    ),
)  # fmt: skip
"""Figures of Sect. 6 and Appendices B and C."""
