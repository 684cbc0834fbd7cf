"""``spectrum``: height maps, line profiles and spectra of other programs become one power spectrum."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from skinbayes.cli.new_file import refuse_existing, write_text
from skinbayes.cli.options import json_option, number_option, overwrite_option
from skinbayes.cli.output import (
    EXIT_DONE,
    EXIT_NOT_CONVERGED,
    print_json,
    print_sentences,
    print_table,
    say,
)
from skinbayes.defaults import SEED
from skinbayes.errors import InputError

if TYPE_CHECKING:
    from skinbayes.fit import Fit
    from skinbayes.topography import MeasuredSurface, SurfaceAnalysis, SurfaceCollection

FRAGMENT = '[surface]\nfile = "spectrum.csv"\n'
"""The lines of a model file beside the CSV."""

FIT_FRAGMENT = (
    '[surface]\nposterior = "surface-fit.nc"  # or the spectrum as it was measured: file = "spectrum.csv"\n'
)
"""The same beside a fit, whose uncertainty goes with it."""


@click.command()
@click.argument("files", nargs=-1, required=True)
@click.option("--unit", metavar="UNIT", help="Unit of heights that have none: um, or '12.5 nm' of one count.")
@click.option(
    "--pixel-size",
    metavar="SIZE",
    help="Of a pixel where the file has none: '0.8 um', or '0.8 um, 1.2 um' (x, y).",
)
@click.option("--channel", metavar="NAME", help="Channel of an instrument's file, by name or number.")
@click.option(
    "--negative-replica", is_flag=True, help="Heights are those of a negative cast: turn them over."
)
@click.option(
    "--periodic", is_flag=True, help="The surface is one period of a periodic one, as simulated ones are."
)
@click.option(
    "--detrend",
    type=click.Choice(["none", "tilt", "curvature"]),
    help="What to take away by least squares.  [default: curvature; none of a periodic surface]",
)
@click.option(
    "--undefined",
    type=click.Choice(["fill", "rectangle"]),
    default="fill",
    show_default=True,
    help="Fill up to 10 % undefined pixels, or keep the largest rectangle (of lines the longest part) without them.",
)
@click.option(
    "--undefined-height", metavar="HEIGHT", help="Height that marks undefined pixels in the file: '-9999 um'."
)
@click.option(
    "--remove-spikes", is_flag=True, help="Take pixels that stand far out of their neighbours for undefined."
)
@click.option(
    "--window",
    type=click.Choice(["hann", "blackman", "none"]),
    help="Against the edges of the field.  [default: hann; none of a periodic surface]",
)
@click.option(
    "--bins-per-decade",
    type=click.IntRange(2, 100),
    metavar="N",
    help="Of wavevectors.  [default: 16, of lines 10]",
)
@click.option("--tip-radius", metavar="LENGTH", help="Of a stylus or probe: limits the band.")
@click.option(
    "--resolution", metavar="LENGTH", help="Shortest wavelength that the instrument passes: limits the band."
)
@click.option(
    "--band",
    nargs=2,
    metavar="MIN MAX",
    help="Use these wavevectors, whatever the rules say: '1e4 1/m' '1e6 1/m'.",
)
@click.option("--convention", metavar="NAME", help="Of spectra that do not state theirs.")
@click.option(
    "--fit", "fitted", is_flag=True, help="Fit a self-affine surface, waves that nobody measured included."
)
@number_option("--seed", SEED, 0, "Of --fit: the same seed gives the same draws.")
@click.option(
    "-o",
    "--output",
    metavar="DIR",
    help="Folder for spectrum.html, spectrum.csv, surface.toml, and with --fit surface-fit.nc.",
)
@overwrite_option
@json_option
def spectrum(
    files: tuple[str, ...],
    fitted: bool,
    seed: int,
    output: str | None,
    overwrite: bool,
    as_json: bool,
    **options: Any,
) -> int:
    """Compute the power spectrum of measured surfaces.

    FILES are height maps or line profiles (of an instrument, .npy, .tif, or text), or spectra that another program computed, of
    one kind of surface at several places or magnifications: they become one spectrum.
    """
    from skinbayes.report.spectrum_page import write_spectrum_page
    from skinbayes.topography import SurfaceCollection

    targets = (
        []
        if output is None
        else [
            Path(output) / name
            for name in (
                "spectrum.csv",
                "surface.toml",
                "spectrum.html",
                *(["surface-fit.nc"] if fitted else []),
            )
        ]
    )
    refuse_existing(targets, overwrite)
    names = _names(files)
    settings = _settings(options)
    _refuse_idle(names, options)
    collection = SurfaceCollection([_measured(path, names[path], settings, options) for path in names])
    collection.numbers()  # what cannot be used is refused before anything is written
    found = _fit(collection, seed) if fitted else None
    if targets:
        lines = FRAGMENT if found is None else FIT_FRAGMENT
        write_text(targets[0], spectrum_csv(collection))
        write_text(targets[1], lines)
        write_spectrum_page(collection, targets[2], lines, found)
        if found is not None:
            found.save(targets[3])
    if as_json:
        told = {} if found is None else {"converged": found.converged, "parameters": fit_parameters(found)}
        print_json(document(collection) | told | {"written": [str(path) for path in targets]})
    else:
        _show(collection)
        if found is not None:
            _show_fit(found)
        for label, path in zip(("spectrum", "model file", "page", "fit"), targets, strict=False):
            say(f"{label + ':':12}{path}")
    return EXIT_DONE if found is None or found.converged else EXIT_NOT_CONVERGED


def _fit(collection: SurfaceCollection, seed: int) -> Fit:
    """The self-affine surface that has these spectra, those of each surface apart."""
    from skinbayes.cli.progress import sampling_progress
    from skinbayes.fit.spectrum_fit import fit_spectrum

    with sampling_progress("surface") as progress:
        return fit_spectrum([one.spectrum for one in collection.surfaces], seed=seed, progress=progress)


def fit_parameters(fit: Fit) -> dict[str, Any]:
    """Unit, median and 90 % interval of each parameter and of what follows from them."""
    table = fit.summary(derived=True)
    return {
        str(name): {key: row[key] for key in ("unit", "median", "q05", "q95")}
        for name, row in table.iterrows()
    }


def _show_fit(fit: Fit) -> None:
    from skinbayes.report.spectrum_page import FIT_EXPLAINED, fit_rows

    print_table(("self-affine surface", "median", "90 % interval"), fit_rows(fit), right=(1, 2))
    print_sentences([FIT_EXPLAINED, str(fit.provenance["sampling"]["verdict"])])


def _names(files: tuple[str, ...]) -> dict[str, str]:
    """Each file with a name for people: its own, with its folder where two have one name."""
    if len(set(files)) < len(files):
        raise InputError("a file is given twice; expected each once, as it would count twice")
    short = [Path(path).name for path in files]
    return {path: name if short.count(name) == 1 else path for path, name in zip(files, short, strict=True)}


FOR_SURFACES = (
    "unit", "pixel_size", "channel", "negative_replica", "periodic", "detrend", "undefined_height", "remove_spikes", "window",
    "bins_per_decade", "tip_radius", "resolution",
)  # fmt: skip
"""Options that say nothing about spectra that were computed elsewhere."""


def _refuse_idle(names: dict[str, str], options: dict[str, Any]) -> None:
    """Refuse options that none of the files takes: their user believes that they do something."""
    from skinbayes.files.measured_spectrum import is_spectrum

    spectra = [is_spectrum(path) for path in names]
    given = {name for name, value in options.items() if value not in (None, False)}
    if "convention" in given and not any(spectra):
        raise InputError("--convention: none of the files is a spectrum; drop it")
    if all(spectra) and (idle := [name for name in FOR_SURFACES if name in given]):
        raise InputError(
            f"--{idle[0].replace('_', '-')}: spectra that were computed elsewhere are taken as they are; drop it, or "
            "give heights"
        )


def _settings(options: dict[str, Any]) -> dict[str, Any]:
    """Options as arguments of `analyse_surface`, lengths and wavevectors in SI."""
    from skinbayes.units import parse_quantity

    lengths = {
        name: parse_quantity(options[name], "m", where=f"--{name.replace('_', '-')}")
        for name in ("tip_radius", "resolution")
        if options[name] is not None
    }
    for name, value in lengths.items():
        if not value > 0:
            raise InputError(
                f"--{name.replace('_', '-')}: found {options[name][:40]}; expected a length > 0 m"
            )
    mark = options["undefined_height"]
    band = options["band"]
    return lengths | {
        "negative_replica": options["negative_replica"],
        "trend": options["detrend"],
        "undefined": options["undefined"],
        "undefined_height": None if mark is None else parse_quantity(mark, "m", where="--undefined-height"),
        "without_spikes": options["remove_spikes"],
        "window": options["window"],
        "bins_per_decade": options["bins_per_decade"],
        "band": None if band is None else tuple(parse_quantity(end, "1/m", where="--band") for end in band),
    }


def _measured(path: str, name: str, settings: dict[str, Any], options: dict[str, Any]) -> MeasuredSurface:
    from dataclasses import replace

    from skinbayes.files.height_map import read_surface
    from skinbayes.files.measured_spectrum import is_spectrum, read_measured_spectrum
    from skinbayes.files.stated_surface import StatedSurface, stated_surface
    from skinbayes.topography import MeasuredSurface, analyse_surface

    if is_spectrum(path):
        given = options["convention"]
        stated = (
            StatedSurface()
            if given is None
            else stated_surface({"convention": given}, lambda key: f"--{key}")
        )
        found = replace(read_measured_spectrum(path, stated), source=name)
        if settings["band"] is not None:
            found = replace(found, wavevector_min=settings["band"][0], wavevector_max=settings["band"][1])
        return MeasuredSurface(name=name, kind="spectrum computed elsewhere", spectrum=found)
    read = read_surface(
        path,
        unit=options["unit"],
        pixel_size=options["pixel_size"],
        channel=options["channel"],
        periodic=options["periodic"],
    )
    instrument = {"tip_radius": read.tip_radius, "resolution": read.resolution}
    try:
        analysis = analyse_surface(read.surface, **(instrument | settings), source=name)
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    return MeasuredSurface(name=name, kind=read.kind, spectrum=analysis.spectrum, analysis=analysis)


def spectrum_csv(collection: SurfaceCollection) -> str:
    """The spectrum as a CSV that a model file names; the rms height of a single map is stated, to be compared when it is read."""
    from skinbayes.files.measured_spectrum import measured_text

    only = collection.surfaces[0].analysis if len(collection.surfaces) == 1 else None
    measured = None
    if only is not None and only.anisotropy is not None:
        inside = only.in_band.rms_height
        # few modes in the first bins may leave the power law between bins some per cent beside the sum over modes
        measured = inside if abs(collection.numbers()["rms_height"] / inside - 1) < 0.08 else None
    names = ", ".join(one.name for one in collection.surfaces)
    return measured_text(
        collection.spectrum,
        f"isotropic power spectrum of {' '.join(names.split())}, C(q) with ⟨h²⟩ = 2π ∫ q C dq",
        "independent_modes: the relative standard error of a value is 1/sqrt(independent_modes)",
        rms_height=measured,
    )


def document(collection: SurfaceCollection) -> dict[str, Any]:
    """What ``--json`` prints."""
    spectrum, merged = collection.spectrum, collection.merged
    maps = [
        one.analysis.anisotropy for one in collection.surfaces if one.analysis and one.analysis.anisotropy
    ]
    return {
        "convention": "paper",
        "surface": collection.numbers(),
        "spectrum": {
            "wavevector": spectrum.wavevector,
            "power_spectral_density": spectrum.power_spectral_density,
            "independent_modes": spectrum.independent_modes,
            "wavevector_min": spectrum.wavevector_min,
            "wavevector_max": spectrum.wavevector_max,
        },
        "scatter": merged.scatter,
        "anisotropy": max((one.slope_degree for one in maps), default=None),
        "files": [
            {"file": one.name, "kind": one.kind, "level": level}
            | ({} if one.analysis is None else _file_document(one.analysis))
            for one, level in zip(collection.surfaces, merged.level, strict=True)
        ],
    }


def _file_document(one: SurfaceAnalysis) -> dict[str, Any]:
    from skinbayes.topography import HeightMap
    from skinbayes.topography.findings import surface_findings

    surface, found = one.surface, one.anisotropy
    pixel = (
        [surface.pixel_size_x, surface.pixel_size_y]
        if isinstance(surface, HeightMap)
        else [surface.pixel_size]
    )
    return {
        "pixels": list(surface.height.shape[::-1]),
        "pixel_size": pixel,
        "undefined": one.undefined,
        "spikes": one.spikes,
        "plateaus": [plateau._asdict() for plateau in one.plateaus],
        "steps": list(surface.steps),
        "window": one.window,
        "findings": surface_findings(one),
        "surface": one.own._asdict(),
        "whole_spectrum": one.whole._asdict(),
        "in_band": one.in_band._asdict() | {"total_area_ratio": one.area_ratio_in_band},
        "band": one.band._asdict(),
        "anisotropy": None
        if found is None
        else {
            "slope_degree": found.slope_degree,
            "slope_direction": found.slope_direction,
            "slope_degree_by_chance": found.slope_degree_by_chance,
            "wavevector": found.wavevector,
            "degree": found.degree,
            "direction": found.direction,
            "degree_by_chance": found.degree_by_chance,
        },
    }


def _show(collection: SurfaceCollection) -> None:
    from skinbayes.report.spectrum_page import HEADERS, collection_sentences, surface_row
    from skinbayes.topography.findings import surface_findings

    print_table(("file", *HEADERS[1:]), [surface_row(one) for one in collection.surfaces], right=range(1, 9))
    for one in collection.surfaces:
        if one.analysis is not None:
            band = one.analysis.band
            said = [
                f"{', '.join(one.analysis.surface.steps)}; {one.kind}; band from {band.lower} to {band.upper}."
            ]
            print_sentences([*said, *surface_findings(one.analysis)], one.name)
    print_sentences(collection_sentences(collection), "The spectrum")
