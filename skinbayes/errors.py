"""Errors that are meant to be read by the person who typed the input."""

from __future__ import annotations

import errno
import warnings
from pathlib import Path

NO_SPACE = frozenset(getattr(errno, name) for name in ("ENOSPC", "EDQUOT", "EFBIG") if hasattr(errno, name))
"""Numbers of the system's errors which say that there is no room to write: disk full, quota, limit of a file."""

NEXT_PROBLEM = "\n  - "
"""Stands between the problems of one file in a message; the only line break in messages."""


class InputError(ValueError):
    """Something the user gave cannot be used.

    The message is one or two plain sentences, or a list of them for a file with several faults: where (file, line, row,
    column or parameter), what was found, and what was expected, in its unit. The command line prints it as it is and
    exits with status 2.

    Examples
    --------
    >>> import skinbayes as sb
    >>> try:
    ...     sb.load_problem("forearm-glas")
    ... except sb.InputError as error:
    ...     print(str(error)[:60])
    no model 'forearm-glas'. Did you mean 'forearm-glass'? Shipp
    """


class FingerprintMismatch(InputError):
    """A stored run belongs to another model, data set, prior or sampler setting than the one given."""


class RepairWarning(UserWarning):
    """Something in a stored run was damaged or missing, and what was done about it.

    The run goes on; the command line prints the message as it is on standard error.
    """


def warn_of_repair(message: str) -> None:
    """Say what was damaged in a run and what was done about it."""
    warnings.warn(message, RepairWarning, stacklevel=3)


class MachineError(RuntimeError):
    """The machine stopped the work, not the input: disk full, a folder gone, a process killed, no memory.

    What was on disk is kept. The message is one or two plain sentences; the command line prints it as it is and exits
    with status 4.
    """


class FolderGone(MachineError):
    """A folder was renamed, removed or replaced while something was written into it.

    Attributes
    ----------
    path : where it was
    now : where it is, None if it was removed or that cannot be told
    """

    def __init__(self, path: Path, now: Path | None) -> None:
        what = f"is now {now}" if now else "was renamed, removed or replaced"
        super().__init__(f"{path}: the folder {what}, while the fit was writing into it.")
        self.path = path
        self.now = now


def cannot_write(path: Path, error: OSError, begun: bool = True) -> InputError | MachineError:
    """What to raise when a file cannot be written: the place is a wrong one, or (``begun``) it was a right one before."""
    full = error.errno in NO_SPACE
    reason = "no space left on the disk" if full else error.strerror or str(error)
    kind = MachineError if begun or full else InputError
    return kind(f"{path}: cannot be written ({reason}).")
