"""Figures of measured surfaces: the map with its heights, the spectrum with its band, and the spectrum by direction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.arrays import FloatArray
from skinbayes.plot.numbers import prefix_of, quantity
from skinbayes.plot.style import BLUE, GREY, SERIES, SMALL, VERMILLION, inches, look, new_figure, shortened
from skinbayes.topography import HeightMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from skinbayes.topography import MeasuredSurface, SurfaceCollection

MOST_SHOWN = 500
"""Pixels along a side of a map that is drawn; of more the means of squares are."""


def plot_surface(one: MeasuredSurface, width: str | None = None) -> Figure:
    """Draw the prepared heights of a surface, colour coded, beside their distribution.

    Parameters
    ----------
    one : a surface with its analysis
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        The map (or line) and the density of its heights, with that of a normal distribution of the same rms height.
    """
    assert one.analysis is not None
    size = inches(width)
    surface = one.analysis.surface
    with look(size):
        if isinstance(surface, HeightMap):
            return _map_figure(surface, one.analysis.own.rms_height, size)
        figure = new_figure(size, 2.5 if size >= SMALL else 3.6, left=0.7, bottom=0.55, top=0.15)
        columns = (1, 2) if size >= SMALL else (2, 1)
        grid = figure.add_gridspec(
            *columns, **({"width_ratios": (2.2, 1), "wspace": 0.3} if size >= SMALL else {"hspace": 0.55})
        )
        ax, beside = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
        factor, unit = prefix_of(surface.size, "m")
        height, height_unit = prefix_of(one.analysis.own.rms_height, "m")
        ax.plot(
            np.arange(surface.height.size) * surface.pixel_size / factor,
            surface.height / height,
            color=BLUE,
            linewidth=0.8,
        )
        ax.set_xlabel(f"x [{unit}]")
        ax.set_ylabel(f"height [{height_unit}]")
        _histogram(beside, surface.height / height, one.analysis.own.rms_height / height, height_unit)
        return figure


def _map_figure(surface: HeightMap, rms: float, size: float) -> Figure:
    """A map as wide as half of the figure, or as the figure if that is narrow, and the distribution of its heights."""
    ratio = surface.size_y / surface.size_x
    wide = size >= SMALL
    across = 0.46 * size if wide else size - 1.35
    tall = float(np.clip(across * ratio, 0.8, 1.6 * across))
    across = tall / ratio if across * ratio > tall else across
    height = tall + 0.75 if wide else tall + 2.5
    figure = new_figure(size, height)
    bottom = height - tall - 0.15
    ax = figure.add_axes((0.55 / size, bottom / height, across / size, tall / height))
    factor, unit = prefix_of(max(surface.size_x, surface.size_y), "m")
    scale, height_unit = prefix_of(rms, "m")
    shown = _reduced(surface.height) / scale
    low, high = np.quantile(shown, (0.002, 0.998))
    picture = ax.imshow(
        shown, cmap="viridis", vmin=low, vmax=high, aspect="auto", interpolation="nearest", origin="upper",
        extent=(0.0, surface.size_x / factor, surface.size_y / factor, 0.0),
    )  # fmt: skip
    ax.set_xlabel(f"x [{unit}]")
    ax.set_ylabel(f"y [{unit}]")
    for side in ("top", "right"):
        ax.spines[side].set_visible(True)
    bar = figure.add_axes(((0.63 + across) / size, bottom / height, 0.1 / size, tall / height))
    figure.colorbar(picture, cax=bar, extend="both")
    bar.set_title(height_unit, fontsize="small", loc="left", pad=6.0)
    left = 0.55 + across + 0.75
    place = (
        (left / size, bottom / height, (size - left - 0.1) / size, tall / height)
        if wide
        else (0.55 / size, 0.5 / height, across / size, 1.3 / height)
    )
    _histogram(figure.add_axes(place), surface.height / scale, rms / scale, height_unit)
    return figure


def _reduced(height: FloatArray) -> FloatArray:
    block = -(-max(height.shape) // MOST_SHOWN)
    rows, columns = (side // block * block for side in height.shape)
    blocks = height[:rows, :columns].reshape(rows // block, block, columns // block, block)
    return np.asarray(blocks.mean(axis=(1, 3)))


def _histogram(ax: Axes, height: FloatArray, rms: float, unit: str) -> None:
    """Density of heights, and the normal one of the same rms height."""
    low, high = np.quantile(height, (0.0005, 0.9995))
    bins = int(np.clip(height.size ** (1 / 3), 16, 60))
    edges = np.linspace(min(low, -3.2 * rms), max(high, 3.2 * rms), bins + 1)
    counts, _ = np.histogram(height, edges)
    density = counts / (height.size * np.diff(edges))
    ax.stairs(density * rms, edges, fill=True, color=BLUE, alpha=0.45)
    x = np.linspace(edges[0], edges[-1], 200)
    ax.plot(
        x, np.exp(-0.5 * np.square(x / rms)) / np.sqrt(2 * np.pi), color=GREY, linestyle="--", linewidth=1.2
    )
    ax.set_xlabel(f"height [{unit}]")
    ax.set_ylim(bottom=0.0)
    ax.set_yticks(())
    ax.spines["left"].set_visible(False)


def plot_measured_spectrum(collection: SurfaceCollection, width: str | None = None) -> Figure:
    """Draw the isotropic spectrum C(q) of each surface, and that of all together.

    Parameters
    ----------
    collection : of surfaces
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        Dots in the reliable band of each with bars of one standard error, faint circles outside; the merged spectrum is a
        line with a band of one standard error.
    """
    size = inches(width)
    several = len(collection.surfaces) > 1
    with look(size):
        figure = new_figure(size, 0.78 * size, left=0.75 if size >= SMALL else 0.62, bottom=0.55, top=0.6)
        ax = figure.subplots()
        ax.set_xscale("log")
        ax.set_yscale("log")
        band = collection.spectrum
        ax.axvspan(band.wavevector_min, band.wavevector_max, color="#F0F4F8", zorder=0, linewidth=0)
        for i, one in enumerate(collection.surfaces):
            _dots(ax, one, SERIES[i % len(SERIES)], several, size)
        if several:
            merged = collection.merged.spectrum
            error = np.minimum(merged.relative_standard_error, 0.95)
            ax.fill_between(
                merged.wavevector, merged.power_spectral_density * (1 - error), merged.power_spectral_density * (1 + error),
                color="#000000", alpha=0.15, linewidth=0, zorder=2,
            )  # fmt: skip
            ax.plot(
                merged.wavevector,
                merged.power_spectral_density,
                color="#000000",
                linewidth=1.2,
                label="all together",
                zorder=4,
            )
        ax.set_xlabel("wavevector q [1/m]")
        ax.set_ylabel("C(q) [m⁴]")
        ax.grid(True)
        top = ax.secondary_xaxis("top", functions=(_wavelength, _wavelength))
        top.set_xlabel("wavelength")
        _label_decades(ax, top)
        top.spines["top"].set_visible(True)
        if several:
            ax.legend(loc="lower left", handlelength=1.2)
        return figure


def _label_decades(ax: Axes, top: Any) -> None:
    """Labels at decades, of bands shorter than two also at 2 and 5 times them; never one on another."""
    from matplotlib.ticker import FuncFormatter, LogFormatterSciNotation, LogLocator, NullFormatter

    decades = float(np.log10(np.divide(*ax.get_xlim()[::-1])))
    between = (1.0, 2.0, 5.0)
    top.xaxis.set_major_locator(LogLocator(subs=between if decades < 2 else (1.0,)))
    top.xaxis.set_major_formatter(FuncFormatter(lambda value, _: quantity(value, "m", 1)))
    if decades < 1:
        ax.xaxis.set_major_locator(LogLocator(subs=between))
        ax.xaxis.set_major_formatter(
            LogFormatterSciNotation(labelOnlyBase=False, minor_thresholds=(np.inf, np.inf))
        )
    for axis in (ax.xaxis, top.xaxis):
        axis.set_minor_formatter(NullFormatter())


def _wavelength(q: Any) -> Any:
    with np.errstate(divide="ignore"):
        return 2 * np.pi / np.asarray(q, dtype=np.float64)


def _dots(ax: Axes, one: MeasuredSurface, color: str, named: bool, size: float) -> None:
    spectrum, used = one.spectrum, one.spectrum.reliable
    q, c = spectrum.wavevector, spectrum.power_spectral_density
    marker = 3.0 if size >= SMALL else 2.2
    ax.plot(
        q[~used],
        c[~used],
        "o",
        markersize=marker,
        markerfacecolor="none",
        markeredgecolor=color,
        alpha=0.45,
        markeredgewidth=0.7,
    )
    error = np.minimum(spectrum.relative_standard_error, 0.95) * c
    ax.errorbar(
        q[used], c[used], yerr=error[used], fmt="o", color=color, markersize=marker, elinewidth=0.8, zorder=3,
        label=shortened(one.name, 30) if named else None,
    )  # fmt: skip


def plot_directions(one: MeasuredSurface, width: str | None = None) -> Figure:
    """Draw the spectrum of a map by direction.

    Parameters
    ----------
    one : a map with its analysis
    width : as text with its unit, such as ``"84 mm"`` for a column of a journal; that of a screen if omitted

    Returns
    -------
    matplotlib.figure.Figure
        C(q, φ) over its mean over directions, and below it the degree of anisotropy, with what an isotropic surface
        exceeds in 5 % of maps.
    """
    assert one.analysis is not None
    assert one.analysis.anisotropy is not None
    found, size = one.analysis.anisotropy, inches(width)
    q, used = (
        found.wavevector,
        (found.wavevector >= one.spectrum.wavevector_min) & (found.wavevector <= one.spectrum.wavevector_max),
    )
    with look(size):
        figure = new_figure(size, 3.6 if size >= SMALL else 3.9, left=0.7, right=0.75, bottom=0.55, top=0.2)
        ax, below = figure.subplots(
            2, 1, sharex=True, gridspec_kw={"height_ratios": (1.5, 1), "hspace": 0.15}
        )
        power = found.power_spectral_density[used]
        with np.errstate(invalid="ignore", divide="ignore"):
            ratio = np.log2(power / np.nanmean(power, axis=1, keepdims=True))
        edges = np.sqrt(q[used][1:] * q[used][:-1])
        edges = np.concatenate(([q[used][0] ** 2 / edges[0]], edges, [q[used][-1] ** 2 / edges[-1]]))
        half = np.degrees(found.angle[1]) / 2
        # the first sector is half at 0° and half at 180°
        angles = np.append(np.degrees(found.angle) - half, [180 - half, 180 + half])
        values = np.concatenate((ratio, ratio[:, :1]), axis=1)
        picture = ax.pcolormesh(edges, angles, values.T, cmap="RdBu_r", vmin=-2, vmax=2, rasterized=True)
        ax.set_xscale("log")
        ax.set_ylim(0, 180)
        ax.set_yticks((0, 45, 90, 135, 180))
        ax.set_ylabel("φ of the wave [°]")
        place = ax.get_position()
        bar = figure.add_axes((place.x1 + 0.12 / size, place.y0, 0.1 / size, place.height))
        key = figure.colorbar(picture, cax=bar, ticks=(-2, -1, 0, 1, 2), extend="both")
        key.ax.set_yticklabels(("¼", "½", "1", "2", "4"))
        below.plot(q[used], found.degree[used], "o-", color=BLUE, markersize=3, linewidth=1.0)
        below.plot(q[used], found.degree_by_chance[used], color=VERMILLION, linestyle="--", linewidth=1.0)
        below.set_ylim(0, 1)
        below.set_ylabel("degree")
        below.set_xlabel("wavevector q [1/m]")
        below.grid(True)
        return figure
