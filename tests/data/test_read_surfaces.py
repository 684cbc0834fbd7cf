"""Height maps and lines from files: what each kind gives, and one clear message for what cannot be used."""

import logging
import struct
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.files.height_map import read_surface
from skinbayes.files.measured_spectrum import is_spectrum, measured_text, read_measured_spectrum
from skinbayes.files.spectrum import read_spectrum
from skinbayes.topography import HeightMap, LineProfile, MeasuredSpectrum

HEIGHT = np.random.default_rng(1).standard_normal((9, 12))
GIVEN = {"unit": "um", "pixel_size": "2 um, 3 um"}


def text_of(rows: np.ndarray, separator: str = ",") -> str:
    return "".join(separator.join(f"{value!r}" for value in row) + "\n" for row in rows.tolist())


def points(height: np.ndarray, x: float = 2.0, y: float = 3.0) -> np.ndarray:
    rows, columns = np.indices(height.shape)
    return np.stack([columns.ravel() * x, rows.ravel() * y, height.ravel()], axis=1)


def write(folder: Path, name: str, content: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def check_map(found: HeightMap | LineProfile, expected: np.ndarray = HEIGHT) -> None:
    assert isinstance(found, HeightMap)
    assert found.height == pytest.approx(expected * 1e-6, nan_ok=True)
    assert (found.pixel_size_x, found.pixel_size_y) == pytest.approx((2e-6, 3e-6))


def test_arrays(tmp_path: Path) -> None:
    np.save(tmp_path / "map.npy", HEIGHT)
    check_map(read_surface(tmp_path / "map.npy", **GIVEN).surface)
    np.save(tmp_path / "counts.npy", (HEIGHT * 100).astype(np.int16))
    counts = read_surface(tmp_path / "counts.npy", unit="10 nm", pixel_size="2 um, 3 um").surface
    check_map(counts, np.trunc(HEIGHT * 100) / 100)
    np.save(tmp_path / "line.npy", HEIGHT[0])
    line = read_surface(tmp_path / "line.npy", unit="nm", pixel_size="0.5 um", periodic=True)
    assert isinstance(line.surface, LineProfile) and line.kind == "NumPy array"
    assert line.surface.pixel_size == 5e-7 and line.surface.periodic


@pytest.mark.parametrize("mode", ["F", "I", "I;16", "L"])
def test_images(mode: str, tmp_path: Path) -> None:
    from PIL import Image

    values = np.round(100 + 20 * HEIGHT).clip(0, 255)
    kind = {"F": np.float32, "I": np.int32, "I;16": np.uint16, "L": np.uint8}[mode]
    Image.fromarray(values.astype(kind)).save(tmp_path / "map.tif")
    found = read_surface(tmp_path / "map.tif", **GIVEN)
    check_map(found.surface, values)
    assert found.kind == "TIFF image"


def test_text_of_all_kinds(tmp_path: Path) -> None:
    for name, separator in (("a.csv", ","), ("b.txt", " "), ("c.csv", ";"), ("d.dat", "\t")):
        check_map(
            read_surface(write(tmp_path, name, "# made up\n" + text_of(HEIGHT, separator)), **GIVEN).surface
        )
    german = text_of(HEIGHT, ";").replace(".", ",")
    check_map(read_surface(write(tmp_path, "e.csv", german), **GIVEN).surface)
    shuffled = np.random.default_rng(2).permutation(points(HEIGHT))
    check_map(read_surface(write(tmp_path, "f.xyz", text_of(shuffled, " ")), unit="um").surface)
    header = "x [um],y [um],z [nm]\n" + text_of(points(1000 * HEIGHT))
    check_map(read_surface(write(tmp_path, "g.csv", header)).surface)
    # points that lack, and cells without a number, are undefined
    expected = HEIGHT.copy()
    expected[2, 3] = expected[5, 6] = np.nan
    few = points(expected)
    few = few[~((few[:, 0] == 6.0) & (few[:, 1] == 6.0))]
    check_map(read_surface(write(tmp_path, "h.xyz", text_of(few, " ")), unit="um").surface, expected)
    rows = text_of(expected).replace("nan", "")
    check_map(read_surface(write(tmp_path, "i.csv", rows), **GIVEN).surface, expected)


def test_lines(tmp_path: Path) -> None:
    x, height = np.arange(20) * 0.5, np.sin(np.arange(20.0))
    pairs = np.stack([x, height], axis=1)
    for name, content, given in (
        ("a.csv", "x [um],z [nm]\n" + text_of(np.stack([x, 1e3 * height], 1)), {}),
        ("b.txt", text_of(pairs, "\t"), {"unit": "um"}),
        ("c.txt", text_of(pairs[::-1], " "), {"unit": "um"}),
        ("d.txt", text_of(height[:, None]), {"unit": "um", "pixel_size": "0.5 um"}),
    ):
        found = read_surface(write(tmp_path, name, content), **given).surface
        assert isinstance(found, LineProfile)
        assert found.height == pytest.approx(1e-6 * height) and found.pixel_size == pytest.approx(5e-7)
        assert found.steps == ()
    for header in ("X [um],Z [um]", "x (um),z (um)", "# x [um],z [um]"):
        found = read_surface(write(tmp_path, "f.csv", f"{header}\n{text_of(pairs)}")).surface
        assert found.height == pytest.approx(1e-6 * height) and found.pixel_size == pytest.approx(5e-7)
    # what lies in a gap was not measured
    found = read_surface(
        write(tmp_path, "g.csv", "x [um],z [um]\n" + text_of(np.r_[pairs[:8], pairs[14:]]))
    ).surface
    assert np.flatnonzero(np.isnan(found.height)).tolist() == list(range(8, 14))
    uneven = pairs[[0, 1, 2, 4, 5, 6, 7, 8, 9, 12, 13, 14, 15]]
    found = read_surface(write(tmp_path, "e.txt", text_of(uneven)), unit="um").surface
    assert found.steps == ("13 uneven places interpolated to 16 even ones",)
    assert found.height[3] == pytest.approx(0.5e-6 * (height[2] + height[4]))


BAD = {
    "empty.npy": (b"", {}, "the file is empty"),
    "no unit.csv": (text_of(HEIGHT), {"pixel_size": "1 um"}, "the heights have no unit; expected --unit"),
    "no pixels.csv": (text_of(HEIGHT), {"unit": "um"}, "the pixels have no size; expected --pixel-size"),
    "points without unit.xyz": (text_of(points(HEIGHT)), {}, r"3 columns have no unit; .* x \[um\],y \[um\],z \[um\]"),
    "both units.csv": ("x [um],z [um]\n" + text_of(points(HEIGHT)[:, :2]), {"unit": "um"}, "the header has units; drop --unit"),
    "area.csv": ("x [um],z [um^2]\n1,2\n", {}, "column 'z': .*wrong dimension"),
    "mass.csv": (text_of(HEIGHT), GIVEN | {"unit": "kg"}, "--unit: .*wrong dimension.*a length"),
    "size.csv": (text_of(HEIGHT), GIVEN | {"pixel_size": "2"}, "--pixel-size"),
    "few columns.csv": (text_of(HEIGHT[:, :5]), GIVEN, "9 rows of 5 numbers; expected 1 .*heights of a line"),
    "ragged.csv": (text_of(HEIGHT) + "1," * 20 + "1\n", GIVEN, "line 10 of the numbers has 21 columns, those before it 12"),
    "word.csv": (text_of(HEIGHT).replace(",", ",oops,", 20), GIVEN, "cannot read|no known kind|oops"),
    "cut off.csv": (text_of(HEIGHT)[:-120], GIVEN, "row 9 of the numbers has [0-9]+ columns, the first one 12"),
    "zeros.txt": (
        (text_of(np.tile(HEIGHT, (30, 1))) + "\0" * 20).encode(), GIVEN, "line 271: byte 1 of the line is a zero byte"
    ),
    "a word below.csv": (
        text_of(HEIGHT) + ",".join(["1"] * 11 + ["oops"]) + "\n", GIVEN, "row 10 .*column 12: found 'oops'; expected a number"
    ),
    "back.csv": (
        "x [um],z [um]\n" + "".join(f"{x},0\n" for x in [*range(9), 7, 20]), {}, "goes back from x = 8e-06 m .* reentrant"
    ),
    "twice.xyz": (text_of(np.vstack([points(HEIGHT), points(HEIGHT)[:1]])), {"unit": "um"}, "two points have the same place"),
    "scattered.xyz": (
        text_of(np.random.default_rng(1).random((200, 3))), {"unit": "um"}, "regular grid"
    ),
    "all undefined.csv": (text_of(np.full((9, 12), np.nan)), GIVEN, "no known kind|none of the 108 pixels"),
    "comments.csv": ("# nothing\n", GIVEN, "no line of numbers"),
    "cut off.npy": (b"\x93NUMPY\x01\x00v\x00{'descr': '<f8'", GIVEN, "cannot be read as a NumPy array"),
    "noise.opd": (np.random.default_rng(1).bytes(5001), {}, "or one that is cut off or damaged; expected a file of"),
    "picture.tif": (b"II*\x00" + bytes(40), GIVEN, "cannot be read as a TIFF image"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_one_message_says_what_is_wrong(name: str, tmp_path: Path) -> None:
    content, given, said = BAD[name]
    if name == "noise.opd":
        pytest.importorskip("SurfaceTopography", reason="its readers are what is tried here")
    path = write(tmp_path, name, content)
    with pytest.raises(InputError, match=said) as caught:
        read_surface(path, **given)
    assert "\n" not in str(caught.value)
    assert name in str(caught.value) or str(caught.value).startswith("--")


def test_arrays_of_other_things_are_refused(tmp_path: Path) -> None:
    odd = (
        (np.zeros((3, 9, 9)), "3 axes"),
        (np.array(["a", "b"]), "array of <U1"),
        (np.zeros(9) * 1j, "complex"),
    )
    for values, said in odd:
        np.save(tmp_path / "odd.npy", values)
        with pytest.raises(InputError, match=said):
            read_surface(tmp_path / "odd.npy", **GIVEN)
    np.save(tmp_path / "object.npy", np.array([{}], dtype=object), allow_pickle=True)
    with pytest.raises(InputError, match="cannot be read as a NumPy array"):
        read_surface(tmp_path / "object.npy", **GIVEN)


def test_huge_files_are_refused_before_they_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    says = b"{'descr': '<f8', 'fortran_order': False, 'shape': (200000, 100000), }"
    header = b"\x93NUMPY\x01\x00v\x00" + says.ljust(117) + b"\n"
    with (tmp_path / "sparse.npy").open("wb") as file:  # of 160 GB, of which nothing is on the disk
        file.write(header)
        file.truncate(len(header) + 8 * 200000 * 100000)
    with pytest.raises(
        InputError, match="expected a height map or line profile of at most 2,000,000,000 bytes"
    ):
        read_surface(tmp_path / "sparse.npy", **GIVEN)
    with (tmp_path / "wide.npy").open("wb") as file:
        file.write(header.replace(b"'<f8'", b"'|i1'").replace(b"200000, 100000", b"20000, 10000  "))
        file.truncate(len(header) + 20000 * 10000)
    with pytest.raises(InputError, match="20,000 × 10,000 pixels; expected at most 100,000,000"):
        read_surface(tmp_path / "wide.npy", **GIVEN)
    with (
        zipfile.ZipFile(tmp_path / "bomb.x3p", "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("data.bin", "w") as member,
    ):
        for _ in range(3):
            member.write(bytes(10_000_000))
    monkeypatch.setattr("skinbayes.files.height_map.LARGEST_FILE", 20_000_000)
    with pytest.raises(InputError, match="30,000,000 bytes when unpacked"):
        read_surface(tmp_path / "bomb.x3p")


def test_without_surfacetopography_the_message_says_how_to_get_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "SurfaceTopography", None)
    with pytest.raises(InputError, match=r"pip install 'skinbayes\[topography\]'"):
        read_surface(write(tmp_path, "map.opd", b"\x01\x02"))


def test_a_file_of_an_instrument_is_what_the_other_program_says(tmp_path: Path) -> None:
    """A map written by SurfaceTopography as X3P and NetCDF and read through the command's reader."""
    program = pytest.importorskip("SurfaceTopography", reason="writes and reads the files of this test")
    # there the first axis is x
    topography = program.Topography(1e-3 * HEIGHT.T, (24.0, 27.0), unit="µm", info={
        "instrument": {"name": "made up", "parameters": {"tip_radius": {"value": 20.0, "unit": "nm"}}}
    })  # fmt: skip
    topography.to_netcdf(str(tmp_path / "map.nc"))
    found = read_surface(tmp_path / "map.nc")
    assert found.kind == "instrument file (nc)"
    assert isinstance(found.surface, HeightMap)
    assert found.surface.height == pytest.approx(1e-9 * HEIGHT)
    assert (found.surface.pixel_size_x, found.surface.pixel_size_y) == pytest.approx((2e-6, 3e-6))
    assert found.tip_radius == pytest.approx(2e-8)
    with pytest.raises(InputError, match="the file has the unit µm; drop --unit nm"):
        read_surface(tmp_path / "map.nc", unit="nm")
    with pytest.raises(InputError, match="the file has the size of its pixels; drop --pixel-size"):
        read_surface(tmp_path / "map.nc", pixel_size="1 um")
    with pytest.raises(InputError, match="no channel 'phase'; expected one of"):
        read_surface(tmp_path / "map.nc", channel="phase")
    data = (tmp_path / "map.nc").read_bytes()
    for share in (0.1, 0.5, 0.9):
        with pytest.raises(InputError, match=r"cut\.nc: .*expected a file of an instrument"):
            read_surface(write(tmp_path, "cut.nc", data[: int(share * len(data))]))


def test_readers_that_try_a_file_say_nothing_themselves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    program = pytest.importorskip("SurfaceTopography", reason="its readers are what is tried here")
    reader = program.open_topography

    def noisy(path: str):
        logging.getLogger("a reader").error("could not reshape data")
        return reader(path)

    monkeypatch.setattr(program, "open_topography", noisy)
    with pytest.raises(InputError, match="cut off or damaged"):
        read_surface(write(tmp_path, "noise.nms", bytes(range(1, 200))))
    assert caplog.records == []
    logging.getLogger("afterwards").error("is heard again")
    assert len(caplog.records) == 1


def test_a_file_whose_header_lies_about_its_size(tmp_path: Path) -> None:
    """A surface file of Digital Surf whose header announces 100,000 × 100,000 points."""
    pytest.importorskip("SurfaceTopography", reason="its reader is what is tried here")
    topography = struct.pack("<II", 100_000, 100_000)
    with pytest.raises(InputError):
        read_surface(write(tmp_path, "lie.sur", b"DIGITAL SURF" + topography + bytes(1000)))


def test_spectra_are_known_by_their_header_and_keep_their_modes(tmp_path: Path) -> None:
    q = np.geomspace(1e4, 1e6, 30)
    spectrum = MeasuredSpectrum(q, power_spectral_density=1e-10 * q**-2.6, independent_modes=np.arange(1.0, 31.0),
                                wavevector_min=2e4, wavevector_max=8e5)  # fmt: skip
    path = write(tmp_path, "spectrum.csv", measured_text(spectrum, "made up"))
    assert is_spectrum(path) and not is_spectrum(write(tmp_path, "map.csv", text_of(HEIGHT)))
    used = spectrum.reliable
    again = read_measured_spectrum(path)
    assert again.power_spectral_density == pytest.approx(spectrum.power_spectral_density[used], rel=1e-8)
    assert again.independent_modes == pytest.approx(spectrum.independent_modes[used], rel=1e-4)
    assert read_spectrum(path).node_power == pytest.approx(again.power_spectral_density)


def test_the_scatter_of_a_spectrum_without_modes_is_seen(tmp_path: Path) -> None:
    """Averages of 25 modes: the relative variance 1/25 comes back within 5 standard errors, 35 % each of 35 of 98 rows."""
    q = np.geomspace(1e4, 1e6, 100)
    power = 1e-10 * q**-2.6 * np.random.default_rng(3).gamma(25, 1 / 25, 100)
    rows = "".join(f"{a!r},{b!r}\n" for a, b in zip(q.tolist(), power.tolist(), strict=True))
    path = write(
        tmp_path, "other.csv", "# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n" + rows
    )
    assert read_measured_spectrum(path).independent_modes[0] == pytest.approx(25, rel=0.6)
    with pytest.raises(InputError, match="3 rows without a column 'independent_modes"):
        read_measured_spectrum(
            write(tmp_path, "short.csv", "\n".join(path.read_text().splitlines()[:5]) + "\n")
        )
