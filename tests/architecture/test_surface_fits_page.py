"""The examples of docs/surface-fits.md run, one after the other, and say what the page says."""

from __future__ import annotations

import re
import tomllib
from typing import Any

import pytest
from source_tree import ROOT

import skinbayes as sb

PAGE = (ROOT / "docs" / "surface-fits.md").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_examples_run_and_say_what_the_page_says() -> None:
    names: dict[str, Any] = {}
    for block in re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL):
        exec(block, names)
    low, _, high = names["spectrum"].quantiles("hurst_exponent")
    assert low - (high - low) < 0.7 < high + (high - low)
    prior = names["friction"].surface_prior
    assert prior.names == ("rms_height", "hurst_exponent", "wavevector_rolloff", "wavevector_max")
    assert prior.departure() < 0.06
    found = names["fit"].surface_variance()
    assert (
        found.surface + found.moduli + found.data == 1.0
        or abs(found.surface + found.moduli + found.data - 1) < 1e-12
    )
    assert found.surface > 0.3


def test_the_counterface_of_the_page_is_one() -> None:
    (block,) = re.findall(r"^```toml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    skin = {
        "frictional_shear_stress": "15 MPa", "young_modulus_layer": "7 MPa", "young_modulus_bulk": "20 kPa",
        "layer_thickness": "20 um", "nominal_pressure": "7 kPa",
    }  # fmt: skip
    made = {"surface": "paper_reference", "conditions": {}}
    parameters = skin | tomllib.loads(block)["parameters"]
    rough = sb.build_problem("friction", parameters=parameters, **made)
    smooth = sb.build_problem("friction", parameters=skin, **made)
    ratio = [
        float(one.predict(one.prior_medians())["friction_coefficient"].squeeze()) for one in (rough, smooth)
    ]
    assert 1 < ratio[0] / ratio[1] < 10
