"""The run directory that ``fit`` writes: claimed by one process, watched while it runs."""

from __future__ import annotations

import shlex
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from skinbayes.atomic import write_atomically
from skinbayes.errors import (
    NO_SPACE,
    FingerprintMismatch,
    FolderGone,
    InputError,
    MachineError,
    cannot_write,
    warn_of_repair,
)
from skinbayes.files.joint_model import EXPERIMENTS
from skinbayes.fit.manifest import (
    BASELINE_MODELS,
    RESULT,
    RUN,
    STEPS,
    Manifest,
    trouble,
    write_manifest,
)
from skinbayes.fit.run_contents import result_contents, with_files
from skinbayes.fit.run_inputs import (
    Held,
    own_baseline_models,
    read_run,
    remove_leftovers,
    write_inputs,
)
from skinbayes.fit.run_lock import RunLock
from skinbayes.sampling.store import HEADER, SampleStore
from skinbayes.sampling.watched import WatchedDirectory
from skinbayes.sealed import put_aside

if TYPE_CHECKING:
    from skinbayes.fit.result import PosteriorResult
    from skinbayes.problem import JointProblem, Problem

FOLDERS = ("data", EXPERIMENTS, STEPS, BASELINE_MODELS)
"""Folders inside a run directory."""


class RunDirectory:
    """A directory that holds a problem, the steps of its sampler and its result, and can be read on its own.

    Used as a context: from its beginning to its end no other process writes there. Nothing is written into a directory
    that holds anything else than a run of this problem, and nothing through links inside it.

    Parameters
    ----------
    path : the directory; made if it is not there
    problem : what is to be sampled
    resume : the directory may hold a run of this problem, finished or not
    engine : name of what samples it

    Attributes
    ----------
    store : the steps of the sampler
    """

    def __init__(
        self, path: Path, problem: Problem | JointProblem, resume: bool, engine: str = "emcee"
    ) -> None:
        self.path = path
        self.store = SampleStore(path / STEPS, resume=resume)
        self._problem = problem
        self._resume = resume
        self._engine = engine

    def __enter__(self) -> RunDirectory:
        """Claim the directory.

        Raises
        ------
        InputError
            It holds something else, or a run that is not to be continued or cannot be, or another process writes
            there, or it cannot be written.
        MachineError
            The disk is full.
        """
        try:
            self._examine()  # before anything is written
            for path in own_baseline_models(self._problem):
                if not path.is_file():
                    raise InputError(
                        f"{self._problem.spec.path}: baseline_models: no file {path}; expected a model file to compare with"
                    )
            self.path.mkdir(parents=True, exist_ok=True)
            self._lock = RunLock(self.path)
            try:
                self._claim()
            except BaseException:
                self._lock.release()
                raise
        except InputError:
            raise
        except ValueError as error:  # a name that no file can have
            raise InputError(f"{self.path}: cannot be used for a run ({error})") from None
        except OSError as error:
            if error.errno in NO_SPACE:
                raise MachineError(
                    f"{cannot_write(self.path, error)} Make room, and repeat the command."
                ) from None
            raise InputError(
                f"{self.path}: cannot be used for a run ({error.strerror or error}); expected a folder that can be written"
            ) from None
        return self

    def _examine(self) -> Held | None:
        """Refuse what is not to be written into; returns the run of this problem that is there, if there is one."""
        held = read_run(self.path)
        if held is None:
            return None
        holds_result, holds_steps = (self.path / RESULT).exists(), (self.path / STEPS).is_dir()
        if not self._resume and (holds_result or holds_steps):
            raise InputError(
                f"{self.path}: holds {'a result' if holds_result else 'an unfinished run'} already; "
                "give another folder, or continue it with --resume"
            )
        if held.fingerprint != self._problem.fingerprint:
            raise FingerprintMismatch(
                f"{self.path}: holds {held.name} with another model, data, prior or version than "
                f"'{self._problem.name}' here; give another folder"
            )
        if held.engine != self._engine:
            raise FingerprintMismatch(
                f"{self.path}: holds {held.name} with the engine '{held.engine}', not '{self._engine}'; give another folder"
            )
        for folder in FOLDERS:
            if (self.path / folder).is_symlink():
                raise InputError(
                    f"{self.path / folder}: a link found, a folder of the run itself expected; nothing is written through links"
                )
        return held

    def _claim(self) -> None:
        held = self._examine()  # once more, now that nobody else writes here
        self._watched = WatchedDirectory(self.path.absolute())
        remove_leftovers(self.path)
        self._manifest = self._kept(held) or write_inputs(self.path, self._problem, self._engine)

    def _kept(self, held: Held | None) -> Manifest | None:
        """What ``run.json`` says if it and the copies are as they were written; what is not is told."""
        if held is None or not (self.path / STEPS).is_dir():
            return None
        if held.manifest is None:
            if (self.path / RUN).exists():
                put_aside(self.path / RUN)
            warn_of_repair(f"{self.path / RUN}: {held.damage}; written again")
            return None
        wrong = trouble(self.path, held.manifest)
        for name in wrong:
            if not (self.path / name).exists():
                warn_of_repair(
                    f"{self.path / name}: missing; written again from the model and data that were given"
                )
        return None if wrong else held.manifest

    def check(self) -> None:
        """Raise :class:`FolderGone` if the directory is no longer where it was."""
        self._watched.check()

    def keep(self, fit: PosteriorResult) -> None:
        """Write the result, and see that everything is there."""
        self.check()
        try:
            contents = result_contents(fit)
            for name, content in contents.items():
                write_atomically(self.path / name, content)
            # last: a result that is listed is one that was finished
            write_manifest(self.path, with_files(self._manifest, contents))
        except OSError as error:
            self.check()
            raise cannot_write(self.path, error) from error
        self.store.complete()
        self.check()

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Give the directory back; if the machine stopped the run, say where the steps are."""
        try:
            if isinstance(error, (KeyboardInterrupt, MachineError, MemoryError)):
                gone = error if isinstance(error, FolderGone) else self._gone()
                if gone is not None:
                    raise MachineError(f"{gone} {self._rescued()}") from error
            if isinstance(error, MemoryError):
                raise MachineError(f"There is not enough memory. {self._kept_steps()}") from error
            if isinstance(error, MachineError):
                raise MachineError(f"{error} {self._kept_steps()}") from error
        finally:
            self._lock.release()

    def _kept_steps(self) -> str:
        return _continued(self.path) if (self.path / STEPS).is_dir() else "No steps were kept."

    def _gone(self) -> FolderGone | None:
        try:
            self.check()
        except FolderGone as gone:
            return gone
        return None

    def _rescued(self) -> str:
        """Find the run that was carried off, or write what is in memory beside the place where it was; say where it is."""
        gone = self._gone()
        if gone is not None and gone.now is not None and (gone.now / STEPS / HEADER).is_file():
            return _continued(gone.now, moved=True)
        if not self.store.has_steps:
            return "Nothing was sampled yet."
        home = self._watched.path
        names = (home.with_name(f"{home.name}-kept{number or ''}") for number in range(100))
        place = next((path for path in names if not (path.exists() or path.is_symlink())), None)
        try:
            if place is None:
                raise InputError("no free name")
            with RunDirectory(place, self._problem, False, self._engine):
                self.store.copy_to(place / STEPS)
        except (InputError, MachineError):
            return "The steps could not be saved elsewhere and are lost."
        return _continued(place, moved=True)


def _continued(place: Path, moved: bool = False) -> str:
    option = f"-o {shlex.quote(str(place))} --resume" if moved else "--resume"
    return f"The steps so far are in {place}. Repeat the command with {option} to continue."
