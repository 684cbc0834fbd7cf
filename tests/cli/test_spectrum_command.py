"""``skinbayes spectrum``: from files of synthetic surfaces to table, page, CSV and model file."""

import json
from pathlib import Path

import numpy as np
import pytest

import skinbayes as sb
from skinbayes.cli import main
from skinbayes.files.spectrum import read_spectrum

MODEL = """
title = "A made-up surface"
forward = "contact-area"
{fragment}
[parameters]
young_modulus_layer = {{ fixed = "7 MPa", source = "the paper" }}
young_modulus_bulk = {{ fixed = "20 kPa", source = "the paper" }}
layer_thickness = {{ fixed = "20 um", source = "the paper" }}
nominal_pressure = {{ fixed = "6.83 kPa", source = "the paper" }}
"""


def power(q: np.ndarray) -> np.ndarray:
    """C(q) = 1e-20 m^4 up to 1e5 1/m, then ∝ q^−3.6."""
    return 1e-20 * np.maximum(q / 1e5, 1.0) ** -3.6


def heights(seed: int, n: int = 256, pixel: float = 1e-6) -> np.ndarray:
    """A corner of a periodic surface of that spectrum, µm."""
    q = 2 * np.pi * np.hypot(np.fft.fftfreq(2 * n, pixel)[:, None], np.fft.rfftfreq(2 * n, pixel))
    noise = np.fft.rfft2(np.random.default_rng(seed).standard_normal((2 * n, 2 * n)))
    return 1e6 * np.fft.irfft2(noise * np.sqrt(power(q)) * 2 * np.pi / pixel)[:n, :n]


def run(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as end:
        main(["spectrum", *map(str, arguments)])
    captured = capsys.readouterr()
    return int(end.value.code or 0), captured.out, captured.err


def test_from_a_map_to_a_model(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    height = heights(1)
    height[40:44, 50:60] = np.nan
    np.save(tmp_path / "map.npy", height)
    folder = tmp_path / "out"
    given = tmp_path / "map.npy", "--unit", "um", "--pixel-size", "1 um", "-o", folder
    status, out, _ = run(capsys, *given)
    assert status == 0
    for said in ("256 × 256", "40 undefined pixels", "tilt and curvature removed", "3 waves on the field"):
        assert said in " ".join(out.split())
    found = read_spectrum(folder / "spectrum.csv")  # states its convention
    assert "# convention: paper\n" in (folder / "spectrum.csv").read_text()
    assert found.node_power == pytest.approx(power(found.wavevector), rel=1.5)
    assert np.mean(np.log(found.node_power[8:] / power(found.wavevector[8:]))) == pytest.approx(0, abs=0.1)
    page = (folder / "spectrum.html").read_text()
    assert page.count("<figure") == 3 and "<script" not in page and "http-equiv" in page
    # the fragment is read by the model file beside it
    (folder / "mine.toml").write_text(MODEL.format(fragment=(folder / "surface.toml").read_text()))
    problem = sb.load_problem(folder / "mine.toml")
    assert problem.check().setup[-1].startswith("Surface: rms height ")
    # nothing is replaced unasked
    status, out, err = run(capsys, *given)
    assert (status, out) == (2, "") and "spectrum.csv: exists already" in err
    assert run(capsys, *given, "--overwrite")[0] == 0


def test_json_says_everything(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    np.savetxt(tmp_path / "a.txt", heights(2))
    np.savetxt(tmp_path / "b.txt", 1.3 * heights(3))
    x = np.arange(2000)
    np.savetxt(
        tmp_path / "line.csv",
        np.stack([x, heights(4, 2000)[5]], axis=1),
        delimiter=",",
        header="x, z made up",
    )
    maps = tmp_path / "a.txt", tmp_path / "b.txt", "--unit", "um", "--pixel-size", "1 um"
    status, out, err = run(
        capsys, *maps, "--json", "--negative-replica", "--detrend", "tilt", "--band", "5e4 1/m", "1e6 1/m"
    )
    assert status == 0 and err == ""
    document = json.loads(out)
    assert document["convention"] == "paper"
    assert document["surface"]["wavevector_max"] <= 1e6
    assert 0.05 < document["scatter"] < 1.5  # 1.3² in C(q) between two maps
    first, second = document["files"]
    assert first["level"] < 0 < second["level"]
    assert first["steps"][0] == "negative replica inverted" and "tilt removed" in first["steps"][1]
    assert first["band"]["lower"] == "as asked for"
    assert first["surface"]["rms_height"] == pytest.approx(1e-6 * np.std(heights(2)), rel=0.2)
    assert second["anisotropy"]["slope_degree"] < 0.1
    assert document["written"] == []
    status, out, _ = run(capsys, tmp_path / "line.csv", "--unit", "um", "--json")
    line = json.loads(out)
    assert line["anisotropy"] is None and line["files"][0]["pixels"] == [2000]
    assert line["files"][0]["surface"]["total_area_ratio"] is None
    assert line["scatter"] is None


def test_spectra_of_other_programs_are_converted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    q = np.geomspace(1e4, 1e6, 60)
    rows = "".join(
        f"{a!r},{b!r}\n" for a, b in zip(q.tolist(), ((2 * np.pi) ** 2 * power(q)).tolist(), strict=True)
    )
    file = tmp_path / "other.csv"
    file.write_text("wavevector [1/m],power_spectrum_2d [m^4]\n" + rows)
    status, _, err = run(capsys, file)
    assert status == 2 and "does not say in which convention" in err
    status, out, _ = run(capsys, file, "--convention", "contact.engineering", "--json")
    spectrum = json.loads(out)["spectrum"]
    assert spectrum["power_spectral_density"] == pytest.approx(
        power(np.array(spectrum["wavevector"])), rel=0.01
    )


@pytest.mark.parametrize(
    ("content", "options", "said"),
    [
        ("1,2\n" * 20, (), "no unit"),
        ("1,2\n" * 20, ("--unit", "um"), "goes back"),
        ("0,1\n1,1\n2,1\n3,1\n4,1\n5,1\n6,1\n7,1\n8,1\n", ("--unit", "um"), "all heights are the same"),
        ("1,2\n" * 20, ("--unit", "um", "--tip-radius", "5"), "--tip-radius"),
        ("1,2\n" * 20, ("--unit", "um", "--band", "1e6 1/m", "1e4 1/mm"), "--band|goes back"),
        ("1,2\n" * 20, ("--window", "flat"), "flat"),
        ("1,2\n" * 20, ("--convention", "mine"), "no unit|convention"),
    ],
)
def test_what_cannot_be_used_is_one_message(
    content: str, options: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "line.csv").write_text(content)
    status, out, err = run(capsys, tmp_path / "line.csv", *options, "-o", tmp_path / "out")
    assert (status, out) == (2, "")
    assert any(word in err for word in said.split("|"))
    assert not (tmp_path / "out").exists()
    assert "Traceback" not in err


def test_a_file_counts_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "given twice" in run(capsys, "a.csv", "a.csv")[2]
    assert "nowhere.npy" in run(capsys, tmp_path / "nowhere.npy")[2]


def test_a_fit_reaches_the_model_that_names_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    np.save(tmp_path / "map.npy", heights(1))
    folder = tmp_path / "out"
    given = tmp_path / "map.npy", "--unit", "um", "--pixel-size", "1 um", "--fit", "-o", folder, "--json"
    status, out, _ = run(capsys, *given)
    found = json.loads(out)
    assert status == 0 and found["converged"]
    # true: roll-off 1e5 1/m and C ~ q^-3.6, H = 0.8; five standard deviations allowed
    for name, true in (("hurst_exponent", 0.8), ("wavevector_rolloff", 1e5)):
        one = found["parameters"][name]
        assert abs(one["median"] - true) < 5 * (one["q95"] - one["q05"]) / 3.3, name
    assert "The surface that has this spectrum" in (folder / "spectrum.html").read_text()
    (folder / "model.toml").write_text(MODEL.format(fragment=(folder / "surface.toml").read_text()))
    problem = sb.load_problem(folder / "model.toml")
    assert any(name.startswith("surface_deviate") for name in problem.names)
    heights_drawn = problem.derived(problem.draw_prior(np.random.default_rng(1), 400))["rms_height"]
    assert np.median(heights_drawn) == pytest.approx(found["parameters"]["rms_height"]["median"], rel=0.1)


def test_spectra_that_do_not_belong_together_are_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def spectrum(name: str, q: np.ndarray, factor: float) -> Path:
        rows = "".join(
            f"{a!r},{b!r}\n" for a, b in zip(q.tolist(), (factor * power(q)).tolist(), strict=True)
        )
        (tmp_path / name).write_text(f"# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n{rows}")
        return tmp_path / name

    one = spectrum("one.csv", np.geomspace(1e4, 1e6, 30), 1.0)
    other = spectrum("other.csv", np.geomspace(1e4, 1e6, 30), 500.0)
    away = spectrum("away.csv", np.geomspace(1e7, 1e8, 30), 1.0)
    said = " ".join(run(capsys, one, other)[1].split())
    assert "differ by a factor of" in said and "Together they stand for none of them" in said
    said = " ".join(run(capsys, one, away)[1].split())
    assert "Nothing was measured between 10⁶ 1/m and 10⁷ 1/m" in said
    # nothing that is asked for is passed over, and nothing is converted twice
    for given, words in (
        ((one, "--convention", "contact.engineering"), "the file states the convention 'paper'"),
        ((one, "--unit", "um"), "--unit: spectra that were computed elsewhere are taken as they are"),
        ((one, "--band", "1e7 1/m", "1e8 1/m"), "one.csv: 0 bins between 1e+07 and 1e+08 1/m"),
    ):
        status, out, err = run(capsys, *given)
        assert (status, out) == (2, "") and words in err
    np.save(tmp_path / "map.npy", heights(1))
    status, _, err = run(
        capsys, tmp_path / "map.npy", "--unit", "um", "--pixel-size", "1 um", "--convention", "paper"
    )
    assert status == 2 and "none of the files is a spectrum" in err
    (tmp_path / "named.csv").write_text("q [1/m],C [m^4]\n1e4,1e-20\n")
    assert "expected the columns 'wavevector [1/m]'" in run(capsys, tmp_path / "named.csv")[2]
