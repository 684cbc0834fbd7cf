"""``run.json``: what a run is, and the checksums of the files of its directory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path, PurePosixPath
from typing import Annotated, TypeAlias

from pydantic import AfterValidator, TypeAdapter, ValidationError

from skinbayes.atomic import write_atomically
from skinbayes.errors import InputError
from skinbayes.sealed import DamagedFile, file_digest, read_note, sealed_note

RUN = "run.json"
RESULT = "result.nc"
SUMMARY = "summary.csv"
STEPS = "steps"
"""Folder of the sampler's step store inside a run directory."""

BASELINE_MODELS = "baseline-models"
"""Folder of the user's own baseline models inside a run directory."""

MARK = "skinbayes run "
FORMAT = f"{MARK}2"
"""Under the key ``format`` of ``run.json``: the mark of a run directory. Nobody else writes it by chance."""


def _inside(path: str) -> str:
    """Refuse a path that leads out of the run directory."""
    parts = PurePosixPath(path)
    if "\0" in path or parts.is_absolute() or ".." in parts.parts:
        raise ValueError("it leads out of the run directory")
    return path


Inside: TypeAlias = Annotated[str, AfterValidator(_inside)]


@dataclass(frozen=True)
class DataNote:
    """Where the copies of data stand, as a :class:`Manifest` says it."""

    data: Inside | None = None
    rheology: Inside | None = None
    rows: Mapping[str, list[str]] | None = None


@dataclass(frozen=True)
class Manifest:
    """What ``run.json`` says.

    Attributes
    ----------
    model : name of the model
    fingerprint : digest of everything the posterior depends on
    engine : name of what samples it
    data, surface, rheology : paths of the copies inside the run directory, None if there is none
    settings : values that were given beside the model file, by name, as text
    rows : labels that were selected, by column; None if the data have no rows to select
    files : sha256 by path inside the run directory, with ``/``
    experiments : ``data``, ``rheology`` and ``rows`` of each of several experiments by its name
    """

    model: str
    fingerprint: str
    engine: str
    data: Inside | None = None
    surface: Inside | None = None
    rheology: Inside | None = None
    settings: Mapping[str, str] = field(default_factory=dict)
    rows: Mapping[str, list[str]] | None = None
    files: Mapping[Inside, str] = field(default_factory=dict)
    experiments: Mapping[str, DataNote] = field(default_factory=dict)

    def inputs(self) -> list[str]:
        """The files that the run was made from."""
        return [name for name in self.files if name not in (RESULT, SUMMARY)]


def read_manifest(directory: Path) -> Manifest | None:
    """What ``run.json`` says, None if there is none.

    Raises
    ------
    DamagedFile
        It is not what was written.
    InputError
        It is of another version.
    """
    try:
        note = read_note(directory / RUN)
    except FileNotFoundError:
        return None
    if note.get("format") != FORMAT and str(note.get("format")).startswith(MARK):
        raise other_version(directory / RUN, note["format"], FORMAT)
    if note.get("format") != FORMAT:
        raise DamagedFile(f"'format' is not {FORMAT!r}")
    try:
        return TypeAdapter(Manifest).validate_python({key: note[key] for key in note if key != "format"})
    except ValidationError as error:
        raise DamagedFile(f"'{error.errors()[0]['loc'][0]}' is not as this version writes it") from None


def other_version(file: Path, found: object, expected: object) -> InputError:
    """What to raise about a whole file of another version of skinbayes."""
    return InputError(
        f"{file}: written by another version of skinbayes (format {found!r:.40} found, {expected!r} expected); read it with that "
        "version, or fit again into a new folder"
    )


def write_manifest(directory: Path, manifest: Manifest) -> None:
    """Write ``run.json``."""
    write_atomically(directory / RUN, manifest_note(manifest))


def manifest_note(manifest: Manifest) -> bytes:
    """The content of ``run.json``."""
    return sealed_note({"format": FORMAT, **asdict(manifest)})


def trouble(directory: Path, manifest: Manifest) -> dict[str, str]:
    """The inputs that are not those which the run was made with, each with what is wrong."""
    found = {}
    for name in manifest.inputs():
        path = directory / name
        if not path.is_file():
            found[name] = "missing"
        elif file_digest(path) != manifest.files[name]:
            found[name] = "damaged, or changed since the run was made (its sha256 is another)"
    return found
