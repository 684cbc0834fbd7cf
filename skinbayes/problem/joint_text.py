"""Several experiments on one skin as text: their model file, and a summary."""

from __future__ import annotations

from pathlib import Path
from textwrap import shorten
from typing import TYPE_CHECKING, Any

from skinbayes.files.joint_model import EXPERIMENT, EXPERIMENTS
from skinbayes.files.modelschema import ExperimentBlock
from skinbayes.files.toml_text import toml_text
from skinbayes.phrases import row_count
from skinbayes.problem.model_text import model_content, write_files
from skinbayes.problem.summary import LONGEST, listed

if TYPE_CHECKING:
    from skinbayes.problem.joint_densities import JointModel


def joint_files(problem: JointModel, path: Path) -> dict[Path, str]:
    """Model file of the experiments, and the files beside it that it needs: path to text; see `model_files`."""
    spec = problem.spec
    files: dict[Path, str] = {}
    content: dict[str, Any] = {"format": 1, "title": spec.title, "description": spec.description}
    surface: dict[str, Any] = {}
    parameters: dict[str, Any] = {}
    experiments: dict[str, Any] = {}
    for name, one in problem.experiments.items():
        tables = model_content(one, path, files, f"{path.stem}-{name}")
        surface = surface or tables.get("surface", {})
        for key, entry in tables["parameters"].items():
            if key in spec.shared:
                parameters.setdefault(key, entry)
            else:
                parameters.setdefault(key, {"by": EXPERIMENT})[name] = entry
        experiments[name] = {
            key: tables[key] for key in ExperimentBlock.model_fields if tables.get(key) not in (None, {}, [])
        }
    content |= {EXPERIMENTS: experiments, "surface": surface, "parameters": parameters}
    return {path: toml_text(content), **files}


def write_joint(problem: JointModel, path: Path | None) -> str:
    """Text of the model file; with a path it is written, and what it needs beside it."""
    place = Path(f"{problem.name}.toml") if path is None else path
    files = joint_files(problem, place)
    return files[place] if path is None else write_files(files, place)


def joint_summary(problem: JointModel) -> str:
    """Title, the data of each experiment, and the names of the parameters with their priors or values."""
    said = [f"Problem '{problem.name}': {shorten(problem.spec.title, LONGEST, placeholder=' …')}"]
    for name, one in problem.experiments.items():
        explained = ", ".join(f"{o.name} (noise {o.noise.name})" for o in one.observations)
        shown = "" if one.dataset is None else f" of {one.dataset.shown}"
        said.append(
            f"{name}: {row_count(one.conditions.n_rows)}{shown}: {explained}; forward model {one.forward.name}"
        )
    for kind in ("free", "fixed", "tied"):
        if kind != "tied" or problem.tied:
            said += listed(kind, (f"{p.label}: {p.prior_text}" for p in getattr(problem, kind)))
    return "\n".join(said)
