"""What an engine, or somebody else's sampler, did not say about its draws, from the draws themselves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from skinbayes.fit.arviz_adapter import effective_sizes_and_r_hat
from skinbayes.sampling.draws import Draws

R_HAT = 1.01
"""Largest acceptable R-hat, Vehtari et al. (2021), doi 10.1214/20-BA1221."""


def complete(draws: Draws, names: Sequence[str], wanted: float) -> dict[str, Any]:
    """The diagnostics with effective sample size, R-hat and verdict, unless the engine gave them itself.

    Draws of equal weight get the effective sample sizes and the rank-normalised split R-hat of ArviZ. Of draws with weights
    no order in time is known: they get (Σw)²/Σw² and no R-hat.

    Parameters
    ----------
    draws : the draws
    names : of the coordinates
    wanted : effective sample size that is enough
    """
    found = dict(draws.diagnostics)
    if "ess_bulk" not in found and draws.log_weights is not None:
        found["ess_bulk"] = np.full(draws.dimension, draws.effective_number)
    elif "ess_bulk" not in found:
        found |= effective_sizes_and_r_hat(draws.samples)
    if "converged" in found and "verdict" in found:
        return found
    sizes = np.nan_to_num(np.asarray(found["ess_bulk"], dtype=float), nan=0.0)
    missing = []
    if not sizes.min() >= wanted:
        name = names[int(sizes.argmin())]
        missing.append(f"the effective sample size of {name} is {sizes.min():.0f}, {wanted:.0f} is asked for")
    if "r_hat" in found:
        r_hat = np.nan_to_num(np.asarray(found["r_hat"], dtype=float), nan=np.inf)
        if not r_hat.max() <= R_HAT:
            name = names[int(r_hat.argmax())]
            missing.append(
                f"the chains disagree about {name}: R-hat {r_hat.max():.3f}, at most {R_HAT:g} is accepted"
            )
    found.setdefault("converged", not missing)
    size = f"effective sample size at least {sizes.min():.0f}"
    said = "Not converged: " + "; ".join(missing) if missing else f"Converged: {size}"
    return {"missing": missing, "verdict": f"{said}."} | found
