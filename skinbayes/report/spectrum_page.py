"""The page about measured surfaces: their maps, their spectrum, what was done to them and what it means."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from skinbayes.plot import plot_data
from skinbayes.plot.numbers import interval, quantity
from skinbayes.plot.surface import plot_directions, plot_measured_spectrum, plot_surface
from skinbayes.plot.symbols import spoken_name
from skinbayes.report.drawings import Drawing
from skinbayes.report.figures import drawn
from skinbayes.report.rendering import rendered, write_whole
from skinbayes.roughness import rms_height, rms_slope
from skinbayes.topography import HeightMap, MeasuredSurface, SurfaceCollection
from skinbayes.topography.findings import surface_findings

if TYPE_CHECKING:
    from skinbayes.fit import Fit

REFERENCES = (
    "B. N. J. Persson, A. Kovalev, S. N. Gorb, Tribology Letters 50 (2013) 17, 10.1007/s11249-012-0053-2, for the convention "
    "of C(q) and what friction does with it",
    "T. D. B. Jacobs, T. Junge, L. Pastewka, Surface Topography: Metrology and Properties 5 (2017) 013001, "
    "10.1088/2051-672X/aa51f8, for how spectra are computed from maps and lines",
)

HEADERS = (
    "", "pixels", "field", "undefined", "rms height", "in the band", "rms slope", "in the band", "area ratio", "reliable band",
)  # fmt: skip
"""Of the table of surfaces."""

SHOWN = (0, 2, 4, 5, 6, 7, 8, 9)
"""Those that the page shows in its table; the others stand with each surface."""


MOST_APART = float(np.log(10))
"""Standard deviation of ln C between surfaces, here a factor of 10, beyond which they are not of one kind."""

FIT_EXPLAINED = (
    "A surface whose spectrum is constant up to the roll-off and falls as a power of the wavevector beyond it, from the smallest "
    "wavevector measured to the largest there is. Nobody measured the largest: its prior goes from 1e7 to 1e10 1/m, and slope "
    "and area ratio hang on it."
)


def write_spectrum_page(
    collection: SurfaceCollection, path: Path, fragment: str, fit: Fit | None = None
) -> Path:
    """Write one self-contained HTML page about measured surfaces.

    Parameters
    ----------
    collection : the surfaces
    path : the file to write
    fragment : the lines of a model file that use the spectrum
    fit : of a self-affine surface to it, if there is one

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    InputError
        The folder does not exist or cannot be written.
    MachineError
        The disk is full.
    """
    return write_whole(Path(path), rendered("spectrum.html", _context(collection, fragment, fit)))


def fit_rows(fit: Fit) -> list[tuple[str, str, str]]:
    """Median and 90 % interval of each parameter of a fitted surface, and of what follows from them, for people."""
    rows = []
    for name, row in fit.summary(derived=True).iterrows():
        low, middle, high = (float(row[key]) for key in ("q05", "median", "q95"))
        unit = str(row["unit"])
        rows.append(
            (
                spoken_name(str(name)),
                quantity(middle, unit),
                interval(low, high, unit, typical=middle, joint=" to "),
            )
        )
    return rows


def surface_row(one: MeasuredSurface) -> tuple[str, ...]:
    """What a table says of a surface, under `HEADERS`; a spectrum computed elsewhere has no map."""
    spectrum, analysis = one.spectrum, one.analysis
    low, high = (quantity(end, "1/m", 2) for end in (spectrum.wavevector_min, spectrum.wavevector_max))
    band = f"{low.removesuffix(' 1/m')} to {high}"
    if analysis is None:
        table = spectrum.tabulated()
        height, slope = quantity(float(rms_height(table)), "m"), f"{float(rms_slope(table)):.3g}"
        return (one.name, "", "", "", "", height, "", slope, "", band)
    surface, own, inside = analysis.surface, analysis.own, analysis.in_band
    if isinstance(surface, HeightMap):
        rows, columns = surface.height.shape
        pixels, field = (
            f"{columns} × {rows}",
            f"{quantity(surface.size_x, 'm')} × {quantity(surface.size_y, 'm')}",
        )
    else:
        pixels, field = str(surface.height.size), quantity(surface.size, "m")
    return (
        one.name,
        pixels,
        field,
        f"{100 * analysis.undefined:.2g} %",
        quantity(own.rms_height, "m"),
        quantity(inside.rms_height, "m"),
        f"{own.rms_slope:.3g}",
        f"{inside.rms_slope:.3g}",
        "" if np.isnan(own.total_area_ratio) else f"{own.total_area_ratio:.4g}",
        band,
    )


def collection_sentences(collection: SurfaceCollection) -> list[str]:
    """What the spectrum of all surfaces says, and how well they agree."""
    found = collection.numbers()
    low, high = quantity(found["wavevector_min"], "1/m", 2), quantity(found["wavevector_max"], "1/m", 2)
    said = [
        f"Between {low} and {high} (wavelengths of {quantity(2 * np.pi / found['wavevector_min'], 'm', 2)} to "
        f"{quantity(2 * np.pi / found['wavevector_max'], 'm', 2)}) the surface has an rms height of "
        f"{quantity(found['rms_height'], 'm')}, an rms slope of {found['rms_slope']:.3g}, and {found['area_ratio']:.4g} times "
        "the nominal area."
    ]
    if len(collection.surfaces) > 1:
        merged = collection.merged
        if np.isnan(merged.scatter):
            said.append(
                "No wavevector is covered by two surfaces, so that nothing tells how much places differ: the errors are those of "
                "single surfaces and too small."
            )
        elif merged.scatter < 0.005:
            said.append("Where surfaces overlap they agree within what their finite size explains.")
        else:
            apart = (
                f"{100 * merged.scatter:.2g} %"
                if merged.scatter < 0.5
                else f"a factor of {np.exp(merged.scatter):.2g}"
            )
            said.append(
                f"Where surfaces overlap they differ by {apart} in C(q), beyond what their finite size "
                f"explains; the errors of the spectrum of all {len(collection.surfaces)} contain that."
            )
            if merged.scatter > MOST_APART:
                said.append(
                    "So different surfaces are not one: check their units, and what was measured. "
                    "Together they stand for none of them."
                )
        said += _gaps(collection)
        said += [
            f"{one.name} lies {'above' if level > 0 else 'below'} it, by a factor of {np.exp(abs(level)):.3g} in C(q)."
            for one, level in zip(collection.surfaces, merged.level, strict=True)
            if abs(level) > 0.2
        ]
    said.append(
        "Friction depends on shorter waves too, which nobody measured here: a model says what it assumes of them."
    )
    return said


def _gaps(collection: SurfaceCollection) -> list[str]:
    """Wavevectors between the bands of surfaces that no surface covers."""
    ends = sorted((one.spectrum.wavevector_min, one.spectrum.wavevector_max) for one in collection.surfaces)
    said, reached = [], ends[0][1]
    for low, high in ends[1:]:
        if low > 1.5 * reached:
            said.append(
                f"Nothing was measured between {quantity(reached, '1/m', 2)} and {quantity(low, '1/m', 2)}: a power law joins "
                "what lies on both sides."
            )
        reached = max(reached, high)
    return said


def _context(collection: SurfaceCollection, fragment: str, fit: Fit | None) -> dict[str, Any]:
    names = [one.name for one in collection.surfaces]
    several = len(names) > 1
    reading = (
        "Dots are means over bins of wavevectors in the reliable band of each surface, bars one standard error; faint circles "
        "lie outside of the band, where edges, trend, pixels or the instrument spoil them."
    )
    merged = " The black line is the spectrum of all, the grey band its standard error with what surfaces differ by."
    spectrum = Drawing(
        "spectrum", plot_measured_spectrum, "Power spectrum", "C(q) against wavevector on logarithmic axes, with its band.",
        f"{reading}{merged if several else ''} Both axes are logarithmic; ⟨h²⟩ = 2π ∫ q C dq.",
    )  # fmt: skip
    return {
        "title": f"Roughness of {names[0]}" if not several else f"Roughness of {len(names)} surfaces",
        "converged": True,
        "said": collection_sentences(collection),
        "spectrum": drawn(collection, spectrum),
        "headers": [HEADERS[i] for i in SHOWN],
        "rows": [[surface_row(one)[i] for i in SHOWN] for one in collection.surfaces],
        "surfaces": [_surface(one, i) for i, one in enumerate(collection.surfaces)],
        "fit": None if fit is None else _fitted(fit),
        "fragment": fragment,
        "references": REFERENCES,
    }


def _fitted(fit: Fit) -> dict[str, Any]:
    picture = Drawing(
        "fit", plot_data, "Spectrum and fitted surface", "Measured C(q) with the band of the fitted surface.",
        "Dots are the measured means of bins, the line is the median of the fitted self-affine surface, bands hold 90 % of it "
        "and of what repeated measurements would give.",
    )  # fmt: skip
    return {
        "rows": fit_rows(fit),
        "said": [FIT_EXPLAINED, str(fit.provenance["sampling"]["verdict"])],
        "picture": drawn(fit, picture, "" if fit.converged else "NOT CONVERGED. "),
    }


def _surface(one: MeasuredSurface, number: int) -> dict[str, Any]:
    analysis = one.analysis
    if analysis is None:
        return {
            "name": one.name, "kind": _read_as(one), "steps": [], "numbers": [], "pictures": [], "findings": [
                "The spectrum was computed elsewhere and is taken as it is, converted to the convention of the paper."
            ],
        }  # fmt: skip
    is_map = isinstance(analysis.surface, HeightMap)
    pictures = [
        Drawing(
            f"surface-{number}", plot_surface, "Heights as prepared",
            "Heights in colour and their distribution." if is_map else "Heights along the line and their distribution.",
            "Heights after the steps named above. The dashed curve is a normal distribution of the same rms height: furrows make "
            "a tail on the left, peaks one on the right.",
        )
    ]  # fmt: skip
    if analysis.anisotropy is not None:
        pictures.append(
            Drawing(
                f"directions-{number}", plot_directions, "The spectrum by direction",
                "C(q, φ) over its mean over directions in colour, and the degree of anisotropy against wavevector.",
                "Above: red directions have more power than the mean over directions, blue ones less; φ is counted from the x "
                "axis towards y, as the map is drawn, and ridges or furrows run at right angles to their wave. Below: 0 is "
                "isotropic, 1 a grating; an isotropic surface exceeds the dashed line in 5 % of maps.",
            )
        )  # fmt: skip
    return {
        "name": one.name,
        "kind": _read_as(one),
        "steps": [*analysis.surface.steps, _window(analysis.window)],
        "band": f"from {analysis.band.lower} to {analysis.band.upper}",
        "numbers": _numbers(one),
        "findings": surface_findings(analysis),
        "pictures": [drawn(one, drawing) for drawing in pictures],
    }


def _read_as(one: MeasuredSurface) -> str:
    if one.analysis is None:
        return f"Read as {one.kind}, {one.spectrum.wavevector.size} rows."
    row = surface_row(one)
    return f"Read as {one.kind}: {row[1]} pixels, {row[3]} of them undefined."


def _window(name: str) -> str:
    return "no window" if name == "none" else f"window of {name.capitalize()}, scaled to keep the variance"


def _numbers(one: MeasuredSurface) -> list[str]:
    analysis = one.analysis
    assert analysis is not None
    own, whole = analysis.own, analysis.whole
    said = [
        f"skewness {own.skewness:.2g} and kurtosis {own.kurtosis:.2g} of the heights (0 and 3 of a normal distribution)"
    ]
    if not np.isnan(whole.rms_height):
        said.append(
            f"rms height {quantity(own.rms_height, 'm')} counted pixel by pixel, {quantity(whole.rms_height, 'm')} from the "
            f"whole spectrum; rms slope {own.rms_slope:.3g} from neighbouring pixels, {whole.rms_slope:.3g} from the whole "
            "spectrum"
        )
    return said
