"""What a run directory is told by, and the copies of model, data and curves that it holds."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from skinbayes.atomic import PARTIAL, write_atomically
from skinbayes.errors import InputError, warn_of_repair
from skinbayes.files.joint_model import EXPERIMENTS
from skinbayes.files.locate import shipped_names
from skinbayes.files.spectrum import spectrum_text
from skinbayes.fit.manifest import (
    BASELINE_MODELS,
    RUN,
    STEPS,
    DataNote,
    Manifest,
    read_manifest,
    write_manifest,
)
from skinbayes.fit.run_lock import LOCK
from skinbayes.problem.joint import JointProblem
from skinbayes.problem.rheology import flow_curves_text
from skinbayes.sampling.store import stored_fingerprint
from skinbayes.sealed import DamagedFile, put_aside

if TYPE_CHECKING:
    from skinbayes.problem import Problem

SHOWN = 4
"""Names listed of what else is in a folder."""


@dataclass(frozen=True)
class Held:
    """The run that a directory holds.

    Attributes
    ----------
    manifest : what ``run.json`` says; None if it is missing or damaged and the steps alone tell whose run it is
    fingerprint : of its problem
    engine : that samples it
    damage : what is wrong with ``run.json``, empty if nothing is
    """

    manifest: Manifest | None
    fingerprint: str
    engine: str
    damage: str = ""

    @property
    def name(self) -> str:
        """Whose run it is, for messages."""
        return f"a run of '{self.manifest.model}'" if self.manifest else "a run"


def read_run(directory: Path) -> Held | None:
    """What run a directory holds; None if it is empty or not there.

    Raises
    ------
    InputError
        It holds something else than a run.
    """
    try:
        names = sorted(item.name for item in directory.iterdir())
    except FileNotFoundError:
        return None
    except NotADirectoryError:
        raise InputError(f"{directory}: cannot be used for a run (a file found, a folder expected)") from None
    except ValueError as error:  # a null byte in the name
        raise InputError(
            f"{directory}: cannot be used for a run ({error}); expected the name of a folder"
        ) from None
    # traces of a process that was killed before it had claimed the folder
    names = [name for name in names if name != LOCK and not _is_leftover(name)]
    if not names:
        return None
    try:
        manifest = read_manifest(directory)
        damage = "missing"
    except DamagedFile as error:
        manifest, damage = None, f"damaged ({error})"
    if manifest is not None:
        return Held(manifest, manifest.fingerprint, manifest.engine)
    fingerprint = stored_fingerprint(directory / STEPS)
    if fingerprint is not None:
        return Held(None, fingerprint, "emcee", damage)  # the engine that stores its steps
    more = len(names) - SHOWN
    found = ", ".join(names[:SHOWN]) + (f" and {more} more" if more > 0 else "")
    hint = f" ({RUN}: {damage})" if RUN in names else ""
    raise InputError(
        f"{directory}: holds {found}, and is no run of skinbayes{hint}; expected a new or empty folder, or a run. "
        "Nothing was written"
    )


def _is_leftover(name: str) -> bool:
    return name.startswith(".") and name.endswith(PARTIAL)


def remove_leftovers(directory: Path) -> None:
    """Remove files that a killed process was writing."""
    for item in directory.iterdir():
        if _is_leftover(item.name):
            item.unlink(missing_ok=True)


def own_baseline_models(problem: Problem | JointProblem) -> list[Path]:
    """Baseline models that are no shipped models."""
    return [Path(name) for name in problem.spec.baseline_models if Path(name).suffix == ".toml"]


def write_inputs(directory: Path, problem: Problem | JointProblem, engine: str) -> Manifest:
    """Put note, model file, data, curves and baseline models of a problem into its run directory.

    What stands there already and differs is put aside and named in a :class:`RepairWarning`.
    """
    manifest, contents = inputs_of(problem, engine)
    # the note first: what a kill leaves behind is known as a run; until there are steps, all is written again
    write_manifest(directory, manifest)
    for name, content in contents.items():
        _write_copy(directory / name, content)
    return manifest


def inputs_of(problem: Problem | JointProblem, engine: str) -> tuple[Manifest, dict[str, bytes]]:
    """Note of a run, and the content of its model file, data, curves and baseline models by their path inside it."""
    copies: dict[str, Path] = {}
    texts = {"model.toml": problem.spec.text}
    note: dict[str, Any] = {}
    experiments: dict[str, DataNote] = {}
    if isinstance(problem, JointProblem):
        experiments = {
            name: _data(one, f"{EXPERIMENTS}/{name}/", texts, copies)
            for name, one in problem.experiments.items()
        }
        parts = list(problem.experiments.values())
    else:
        note |= vars(_data(problem, "", texts, copies))
        parts = [problem]
    spectra = [
        (one.tables.spectrum, one.spec.surface_file) for one in parts if one.tables.spectrum is not None
    ]
    spectrum, file = spectra[0] if spectra else (None, None)
    settings = {name: text for name, text in problem.settings.items() if name != "surface"}
    if "surface" in problem.settings and file is None:
        settings["surface"] = problem.settings["surface"]
    if spectrum is not None:
        note["surface"] = "spectrum.csv"
        if file is not None:
            copies["spectrum.csv"] = file
        else:
            texts["spectrum.csv"] = spectrum_text(spectrum)
    prior = next((one.surface_prior for one in parts if one.surface_prior is not None), None)
    if prior is not None:
        note["surface"] = "surface.csv"
        texts["surface.csv"] = prior.draws.text()
        settings.pop("surface", None)
    copies |= {f"{BASELINE_MODELS}/{path.name}": path for path in own_baseline_models(problem)}
    # read first: the user may point at the copies of an earlier run in this very directory
    contents = {name: source.read_bytes() for name, source in copies.items()}
    contents |= {name: text.encode() for name, text in texts.items()}
    files = {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}
    manifest = Manifest(
        problem.name,
        problem.fingerprint,
        engine,
        **note,
        settings=settings,
        files=files,
        experiments=experiments,
    )
    return manifest, contents


def _data(problem: Problem, folder: str, texts: dict[str, str], copies: dict[str, Path]) -> DataNote:
    """Add data and flow curves of one experiment to the texts and copies of a run; where they will stand."""
    data = rheology = rows = None
    if problem.dataset is not None:
        source = Path(problem.dataset.path)
        data = f"{folder}data/{'columns.csv' if problem.dataset.in_memory else source.name}"
        if problem.dataset.in_memory:
            texts[data] = problem.dataset.to_csv()
        else:
            copies[data] = source
        rows = {column: list(labels) for column, labels in problem.dataset.selection.items()}
        provenance = source.with_name("provenance.toml")
        if not problem.dataset.in_memory and source.name == "data.csv" and provenance.exists():
            copies[f"{folder}data/{provenance.name}"] = provenance
            data = f"{folder}data"
    named, by = problem.spec.rheology, problem.spec.rheology_by
    if named is not None and by is not None and named not in shipped_names("datasets"):
        rheology = f"{folder}rheology.csv"
        if Path(named).is_file():
            copies[rheology] = Path(named)
        else:
            texts[rheology] = flow_curves_text(problem.flow_curves, by)
    return DataNote(data, rheology, rows)


def _write_copy(copy: Path, content: bytes) -> None:
    copy.parent.mkdir(parents=True, exist_ok=True)
    if copy.is_symlink() or (copy.exists() and not (copy.is_file() and copy.read_bytes() == content)):
        aside = put_aside(copy)
        warn_of_repair(
            f"{copy}: damaged, or changed since the run was made; renamed to {aside.name}, and written again "
            "from the model and data that were given"
        )
    write_atomically(copy, content)
