"""Conventions of power spectra: what each means, that one must be named, and what another program makes of a known surface."""

from pathlib import Path

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.errors import InputError
from skinbayes.files.spectrum import read_spectrum, spectrum_text
from skinbayes.files.stated_surface import StatedSurface
from skinbayes.problem.surface_numbers import surface_numbers
from skinbayes.roughness import CONVENTIONS, SelfAffineSpectrum, TabulatedSpectrum, rms_height, rms_slope

SURFACE = SelfAffineSpectrum(
    rms_height=2e-6, hurst_exponent=0.7, wavevector_min=1e4, wavevector_rolloff=1e5, wavevector_max=1e6
)
NODES = np.geomspace(1e4, 1e6, 200)
COLUMNS = {1: "power_spectrum_1d [m^3]", 2: "power_spectrum_2d [m^4]"}


def profile_power(q: float) -> float:
    """C1D of the surface, 2 ∫ k C(k)/sqrt(k² − q²) dk with k = q cosh s, by the trapezoidal rule."""
    s = np.linspace(0.0, np.arccosh(1e6 / q), 4001)
    return float(2 * q * np.trapezoid(np.cosh(s) * SURFACE.power(q * np.cosh(s)), s))


def written(folder: Path, name: str, *comments: str) -> Path:
    """The surface as a file in a convention; the factors here are those that the integrals of the table say."""
    mean_square = {
        "paper": lambda q, c: 2 * np.pi * np.trapezoid(q * c, q),
        "contact.engineering": lambda q, c: np.trapezoid(q * c, q) / (2 * np.pi),
        "two-sided 1-D": lambda q, c: 2 * np.trapezoid(c, q),
        "one-sided 1-D": lambda q, c: np.trapezoid(c, q),
        "contact.engineering 1-D": lambda q, c: np.trapezoid(c, q) / np.pi,
        "spatial frequency 1-D": lambda q, c: np.trapezoid(c, q) / (2 * np.pi),
    }[name]
    two = CONVENTIONS[name].dimensions == 2
    q = NODES if two else np.geomspace(1e4, 0.97e6, 300)
    power = SURFACE.power(q) if two else np.array([profile_power(float(x)) for x in q])
    # lines have wavelengths of their own below the band, where their spectrum is flat
    whole = (q, power) if two else (np.append(0.0, q), np.append(power[0], power))
    power = power * (4e-12 / mean_square(*whole))  # the surface has 2 µm
    rows = "".join(f"{a!r},{b!r}\n" for a, b in zip(q.tolist(), power.tolist(), strict=True))
    path = folder / "surface.csv"
    path.write_text("".join(f"# {c}\n" for c in comments) + f"wavevector [1/m],{COLUMNS[1 + two]}\n{rows}")
    return path


@pytest.mark.parametrize("name", CONVENTIONS)
def test_the_surface_is_the_same_in_all_of_them(name: str, tmp_path: Path) -> None:
    path = written(tmp_path, name, f"convention: {name}", "rms_height_measured: 2 um")
    found = read_spectrum(path)
    assert float(rms_height(found)) == pytest.approx(2e-6, rel=0.01)
    assert float(rms_slope(found)) == pytest.approx(float(rms_slope(SURFACE)), rel=0.05)


@pytest.mark.parametrize("above", ["\n", "sep=,\n\n"])
def test_comments_may_have_empty_lines_and_the_separator_above_them(above: str, tmp_path: Path) -> None:
    path = written(tmp_path, "contact.engineering", "convention: contact.engineering")
    plain = read_spectrum(path)
    path.write_text(above + path.read_text())
    assert np.array_equal(read_spectrum(path).node_power, plain.node_power)
    path.write_text(path.read_text().replace("convention: contact", "convention: mine"))
    with pytest.raises(InputError, match=f"line {1 + above.count(chr(10))}: convention"):
        read_spectrum(path)


def test_a_convention_must_be_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does not say in which convention") as caught:
        read_spectrum(written(tmp_path, "contact.engineering"))
    # what each would mean, of a surface of 2 µm
    assert "'paper' (⟨h²⟩ = 2π ∫ q C dq: rms height 12.6 µm" in str(caught.value)
    assert "'contact.engineering' (⟨h²⟩ = (1/2π) ∫ q C dq: rms height 2 µm" in str(caught.value)
    with pytest.raises(InputError, match=r"line 1: convention: found 'mine'; expected one of 'paper'"):
        read_spectrum(written(tmp_path, "paper", "convention: mine"))
    with pytest.raises(InputError, match="'one-sided 1-D' is not one of power_spectrum_2d"):
        read_spectrum(written(tmp_path, "paper", "convention = one-sided 1-D"))


@pytest.mark.parametrize(
    ("comment", "said"),
    [
        ("rms_height_measured: 2.5 um", "rms_height_measured is 2.5 µm, but the spectrum .* has 2 µm"),
        ("rms_slope_measured: 0.9", "rms_slope_measured is 0.9, but the spectrum"),
        ("total_area_ratio_measured: 1.9", "total_area_ratio_measured is 1.9, but the spectrum"),
        ("total_area_ratio_measured: 0.9", "expected a number larger than 1"),
        ("rms_height_measured: 2", "rms_height_measured"),
    ],
)
def test_what_was_measured_must_come_out(comment: str, said: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=said):
        read_spectrum(written(tmp_path, "paper", "convention: paper", comment))


MODEL = """
title = "Mine"
forward = "friction"
[surface]
file = "surface.csv"
convention = "contact.engineering"
rms_height_measured = "2 um"
[parameters]
frictional_shear_stress = "10 MPa"
young_modulus = "1 MPa"
nominal_pressure = "10 kPa"
[conditions]
yield_stress = { values = ["1 GPa"] }
"""


def test_a_model_file_can_name_it(tmp_path: Path) -> None:
    written(tmp_path, "contact.engineering")
    (tmp_path / "mine.toml").write_text(MODEL)
    problem = sb.load_problem(tmp_path / "mine.toml")
    assert problem.tables.spectrum is not None
    assert float(rms_height(problem.tables.spectrum)) == pytest.approx(2e-6, rel=1e-3)
    again = problem.to_toml()
    assert 'convention = "contact.engineering"' in again and 'rms_height_measured = "2 µm"' in again
    with pytest.raises(
        InputError, match=r"mine.toml, line 6: surface.convention: no file is given that this is about"
    ):
        (tmp_path / "mine.toml").write_text(MODEL.replace('file = "surface.csv"', 'name = "paper_reference"'))
        sb.load_problem(tmp_path / "mine.toml")


def test_what_is_written_is_read_again(tmp_path: Path) -> None:
    spectrum = TabulatedSpectrum(NODES, SURFACE.power(NODES))
    (tmp_path / "again.csv").write_text(spectrum_text(spectrum))
    assert np.array_equal(read_spectrum(tmp_path / "again.csv").node_power, spectrum.node_power)
    stated = StatedSurface(convention="contact.engineering")
    with pytest.raises(
        InputError, match=r"the file states the convention 'paper', but 'contact.engineering' is asked for"
    ):
        read_spectrum(tmp_path / "again.csv", stated)
    silent = (tmp_path / "again.csv").read_text().replace("# convention: paper\n", "")
    (tmp_path / "silent.csv").write_text(silent)
    assert float(rms_height(read_spectrum(tmp_path / "silent.csv", stated))) < float(rms_height(spectrum)) / 6


def test_the_other_program_means_what_is_written_here() -> None:
    """A periodic surface of 512 × 512 points with a known spectrum, through SurfaceTopography."""
    program = pytest.importorskip("SurfaceTopography")
    points, length = 512, 2e-3
    rng = np.random.default_rng(3)
    q = 2 * np.pi * np.fft.fftfreq(points, length / points)
    radius = np.hypot(*np.meshgrid(q, q, indexing="ij"))
    power = np.where((radius > 1e4) & (radius < 5e5), SURFACE.power(np.clip(radius, 1e4, 1e6)), 0.0)
    # white noise through the root of the spectrum: ⟨|h(q)|²⟩ = (2π)² C N⁴/L², of unit variance N²
    noise = np.fft.fft2(rng.normal(size=(points, points)))
    heights = np.fft.ifft2(noise * np.sqrt((2 * np.pi) ** 2 * power) * points / length).real
    surface = program.Topography(heights, (length, length), periodic=True)
    band = (2e4, 2e5)
    wavevector, area = surface.power_spectrum_from_area()[:2]
    inside = (wavevector > band[0]) & (wavevector < band[1]) & np.isfinite(area)
    ratio = np.mean(area[inside] / SURFACE.power(wavevector[inside]))
    assert ratio == pytest.approx(CONVENTIONS["contact.engineering"].times, rel=0.05)
    wavevector, lines = surface.power_spectrum_from_profile()[:2]
    inside = (wavevector > band[0]) & (wavevector < band[1]) & np.isfinite(lines)
    expected = np.array([profile_power(float(x)) for x in wavevector[inside]])
    assert np.mean(lines[inside] / expected) == pytest.approx(
        CONVENTIONS["contact.engineering 1-D"].times, rel=0.1
    )


def test_the_numbers_of_a_surface_are_told(tmp_path: Path) -> None:
    written(tmp_path, "paper", "convention: paper")
    (tmp_path / "mine.toml").write_text(MODEL.replace('convention = "contact.engineering"\n', ""))
    problem = sb.load_problem(tmp_path / "mine.toml")
    told = surface_numbers(problem, problem.prior_medians())
    assert told["rms_height"] == pytest.approx(2e-6, rel=1e-3)
    assert told["total_area_ratio"] == pytest.approx(
        1 + told["rms_slope"] ** 2 / 2, rel=0.02
    )  # of small slopes
    assert [told["wavevector_min"], told["wavevector_max"]] == pytest.approx([1e4, 1e6])
    assert problem.check().setup[-1].startswith("Surface: rms height 2 µm, rms slope ")
