"""Where the shipped models and data sets lie, in a wheel and in a checkout alike."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from skinbayes.errors import InputError

Kind = Literal["models", "datasets"]

_PACKAGE = Path(__file__).resolve().parent.parent


def shipped_folder(kind: Kind) -> Path:
    """The folder of what is shipped.

    A wheel carries the folders inside the package (``skinbayes/_shipped``), so that neither becomes an
    importable package of its own; a checkout (editable install) has them at its top.

    Parameters
    ----------
    kind : ``"models"`` or ``"datasets"``

    Raises
    ------
    InputError
        if the installation is incomplete
    """
    for folder in (_PACKAGE / "_shipped" / kind, _PACKAGE.parent / kind):
        if folder.is_dir():
            return folder
    raise InputError(f"the shipped {kind} are missing beside {_PACKAGE}; expected a complete installation")


def shipped_names(kind: Kind) -> tuple[str, ...]:
    """Names of what is shipped, sorted: model files without their ending, folders of data sets."""
    folder = shipped_folder(kind)
    if kind == "models":
        return tuple(sorted(path.stem for path in folder.glob("*.toml")))
    return tuple(sorted(path.parent.name for path in folder.glob("*/data.csv")))
