"""A power spectrum of the user's own: units, the two conventions, and clear errors."""

from pathlib import Path

import numpy as np
import pytest

from skinbayes.errors import InputError
from skinbayes.files.spectrum import MAX_ROWS, read_spectrum
from skinbayes.roughness import rms_height

TWO = "# convention: paper\nwavevector [1/m],power_spectrum_2d [m^4]\n"
ONE = "# convention: two-sided 1-D\nwavevector [1/m],power_spectrum_1d [m^3]\n"


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "surface.csv"
    path.write_text(text)
    return path


def test_units_and_column_order(tmp_path: Path) -> None:
    metre = read_spectrum(write(tmp_path, "# optical\n" + TWO + "1e3,1e-18\n1e4,1e-20\n1e6,1e-27\n"))
    micro = read_spectrum(
        write(
            tmp_path,
            "# convention = paper\npower_spectrum_2d [um^4],wavevector [1/um]\n1e6,1e-3\n1e4,1e-2\n1e-3,1\n",
        )
    )
    np.testing.assert_allclose(metre.wavevector, [1e3, 1e4, 1e6])
    np.testing.assert_allclose(micro.wavevector, metre.wavevector, rtol=1e-14)
    np.testing.assert_allclose(micro.node_power, metre.node_power, rtol=1e-14)


def test_rms_height_closes(tmp_path: Path) -> None:
    """Between two nodes with C ∝ q^-4, ⟨h²⟩ = 2π ∫ q C dq = π C0 q0² (1 − (q0/q1)²)."""
    spectrum = read_spectrum(write(tmp_path, TWO + "1e3,1e-18\n1e5,1e-26\n"))
    expected = np.sqrt(np.pi * 1e-18 * 1e6 * (1 - 1e-4))
    assert rms_height(spectrum) == pytest.approx(expected, rel=1e-12)


def test_profile_is_converted_not_relabelled(tmp_path: Path) -> None:
    """C1D = 1e-6/q² belongs to C = 1e-6/(2 q³), from the pair C1D(q) = 2 ∫ k C(k)/sqrt(k² − q²) dk."""
    nodes = np.geomspace(1e3, 1e6, 13)
    rows = "".join(f"{q:.17g},{1e-6 / q**2:.17g}\n" for q in nodes)
    spectrum = read_spectrum(write(tmp_path, ONE + rows))
    np.testing.assert_allclose(spectrum.power(nodes), 1e-6 / (2 * nodes**3), rtol=1e-6)


BAD = {
    "no unit": ("wavevector,power_spectrum_2d [m^4]\n1,1\n", ("line 1", "'wavevector' has no unit", "1/m")),
    "wrong unit": (
        "wavevector [1/m],power_spectrum_2d [m^3]\n1e3,1e-18\n1e4,1e-20\n",
        ("line 1", "'power_spectrum_2d [m^3]'", "unit 'm^3'", "two-dimensional power spectrum in m^4"),
    ),
    "unknown column": (
        "wavevector [1/m],power_spectrum [m^4]\n1,1\n",
        ("line 1", "'power_spectrum [m^4]'", "power_spectrum_2d [m^4]", "Did you mean"),
    ),
    "both conventions": (
        "wavevector [1/m],power_spectrum_2d [m^4],power_spectrum_1d [m^3]\n1,1,1\n",
        ("line 1", "found the columns", "or 'power_spectrum_1d"),
    ),
    "no wavevector": ("power_spectrum_2d [m^4]\n1e-18\n", ("line 1", "expected the columns 'wavevector")),
    "twice": ("wavevector [1/m],wavevector [1/um]\n1,1\n", ("line 1", "appears twice")),
    "one row": (TWO + "1e3,1e-18\n", ("line 3", "single row", "at least two rows")),
    "not increasing": (
        TWO + "1e3,1e-18\n1e5,1e-20\n1e4,1e-21\n",
        ("line 5", "found 1e4 1/m after 1e5 1/m", "increase"),
    ),
    "equal": (TWO + "1e3,1e-18\n1e3,1e-20\n", ("line 4", "increase")),
    "zero wavevector": (TWO + "0,1e-18\n1e3,1e-20\n", ("line 3", "'wavevector'", "found 0 1/m")),
    "negative power": (
        TWO + "1e3,1e-18\n1e4,-1e-20\n",
        ("line 4", "'power_spectrum_2d'", "found -1e-20 m^4", "expected"),
    ),
    "nan": (TWO + "1e3,nan\n1e4,1e-20\n", ("line 3", "'power_spectrum_2d'", "missing value")),
    "not a surface": (ONE + "1e3,1e-18\n1e4,1e-17\n", ("'power_spectrum_1d'", "rises")),
    "empty": ("", ("the file is empty",)),
    "rows of a profile": (
        ONE + "".join(f"{q},1e-18\n" for q in range(1000, 1001 + MAX_ROWS["power_spectrum_1d"])),
        ("501 rows of power_spectrum_1d", "at most 500", "bands"),
    ),
    "too many rows": (
        TWO + "".join(f"{q},1e-18\n" for q in range(1000, 1001 + MAX_ROWS["power_spectrum_2d"])),
        ("line 10003", "more than 10000 rows"),
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_spectrum(case: str, tmp_path: Path) -> None:
    content, fragments = BAD[case]
    path = write(tmp_path, content)
    with pytest.raises(InputError) as caught:
        read_spectrum(path)
    message = str(caught.value)
    assert message.startswith(str(path)) and "\n" not in message
    for fragment in fragments:
        assert fragment in message


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        read_spectrum(tmp_path / "nowhere.csv")
