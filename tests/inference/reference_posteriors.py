"""Reference posteriors of shipped models: quantiles and moments with their Monte Carlo errors, and the quality they meet.

As posteriordb does it, at least 10,000 effective draws and R-hat of at most 1.01: four runs of different seeds, each sampled to
2,500 effective draws or more, are the chains.

``python tests/inference/reference_posteriors.py MODEL ...`` makes those of models anew and writes them into the file.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np

import skinbayes as sb
from skinbayes.fit import Fit
from skinbayes.fit.arviz_adapter import effective_sizes_and_r_hat

FILE = Path(__file__).with_name("reference_posteriors.json")
PROBABILITIES = (0.05, 0.25, 0.5, 0.75, 0.95)
SEEDS = (101, 102, 103, 104)
EACH = 2500.0


def reference_posteriors() -> dict[str, Any]:
    return dict(json.loads(FILE.read_text(encoding="utf-8"))) if FILE.exists() else {}


def effective(fit: Fit) -> np.ndarray:
    """Effective sample size of each parameter, of the middle and of the tails the smaller one."""
    sampling = fit.provenance["sampling"]
    return np.minimum(sampling["ess_bulk"], sampling.get("ess_tail", sampling["ess_bulk"]))


def reference(name: str) -> dict[str, Any]:
    problem = sb.load_problem(name)
    fits = [sb.sample(problem, seed=seed, ess=EACH) for seed in SEEDS]
    assert all(fit.converged for fit in fits)
    count = min(len(fit.theta()) for fit in fits)
    chains = np.stack([fit.theta()[:count] for fit in fits])  # (chain, draw, D)
    line = problem.target().transform.forward(chains.reshape(-1, problem.dimension)).reshape(chains.shape)
    sizes = sum(effective(fit) for fit in fits)
    r_hat = np.asarray(effective_sizes_and_r_hat(line)["r_hat"])
    parameters = {}
    for place, label in enumerate(problem.names):
        draws, size = chains[..., place].ravel(), float(sizes[place])
        scores = line[..., place].ravel()
        quantiles = {}
        for p in PROBABILITIES:
            error = np.sqrt(p * (1 - p) / size)
            low, middle, high = np.quantile(draws, [p - error, p, p + error])
            quantiles[f"{p:g}"] = {"value": rounded(middle), "error": rounded((high - low) / 2, 2)}
        parameters[label] = {
            "unit": fits[0].unit(label),
            "effective_draws": round(size),
            "r_hat": round(float(r_hat[place]), 4),
            "quantiles": quantiles,
            "unbounded_mean": {
                "value": rounded(scores.mean()),
                "error": rounded(scores.std() / np.sqrt(size), 2),
            },
            "unbounded_sd": {
                "value": rounded(scores.std()),
                "error": rounded(scores.std() / np.sqrt(2 * size), 2),
            },
        }
    evidences = [fit.provenance["sampling"]["log_evidence"] for fit in fits]
    known = all(evidence is not None for evidence in evidences)
    return {
        "version": sb.__version__,
        "fingerprint": problem.fingerprint,
        "data_fingerprint": problem.data_fingerprint,
        "engine": fits[0].provenance["sampling"]["engine"],
        "seeds": list(SEEDS),
        "log_evidence": {
            "value": rounded(np.mean([value for value, _ in evidences])),
            "error": rounded(np.sqrt(np.sum([error**2 for _, error in evidences])) / len(evidences), 2),
        }
        if known
        else None,
        "parameters": parameters,
    }


def rounded(value: float, digits: int = 6) -> float:
    return float(f"{value:.{digits}g}")


if __name__ == "__main__":
    for model in sys.argv[1:]:
        found = reference_posteriors() | {model: reference(model)}
        FILE.write_text(json.dumps(dict(sorted(found.items())), indent=1) + "\n", encoding="utf-8")
