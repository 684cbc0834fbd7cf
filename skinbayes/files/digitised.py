"""Points read off a figure with WebPlotDigitizer: its CSV exports, project files and project archives."""

from __future__ import annotations

import hashlib
import tarfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from skinbayes.errors import InputError
from skinbayes.files.digitised_csv import read_pairs
from skinbayes.files.digitised_project import read_project
from skinbayes.files.digitised_set import DigitisedSet
from skinbayes.files.reading import open_file
from skinbayes.files.table import quoted
from skinbayes.vocabulary import suggestions

LARGEST_EXPORT = 100_000_000
"""Bytes of an export; an archive holds the picture, too."""


@dataclass(frozen=True, eq=False)
class DigitisedFile:
    """What an export holds.

    Attributes
    ----------
    path : the file
    kind : what sort of file it is, in words
    sha256 : of its bytes
    sets : the data sets that can be used
    left_out : name of each other data set to the reason why it cannot be used
    """

    path: Path
    kind: str
    sha256: str
    sets: tuple[DigitisedSet, ...]
    left_out: Mapping[str, str] = field(default_factory=dict)

    def select(self, names: Sequence[str]) -> tuple[DigitisedSet, ...]:
        """The data sets of these names, in the order of the names; all usable ones if there are no names.

        Raises
        ------
        InputError
            for a name that is missing, stands for several data sets or for one that cannot be used, or if no data set
            can be used
        """
        if not names:
            if not self.sets:
                reasons = "; ".join(f"{quoted(name)}: {why}" for name, why in self.left_out.items())
                raise InputError(
                    f"{self.path}: no data set that can be used{f' ({reasons})' if reasons else ''}; expected points on "
                    "the two axes of an XY plot"
                )
            return self.sets
        chosen: list[DigitisedSet] = []
        for name in names:
            found = [one for one in self.sets if one.name == name]
            if name in self.left_out and not found:
                raise InputError(
                    f"{self.path}: data set {quoted(name)} cannot be used: {self.left_out[name]}"
                )
            if len(found) != 1:
                what = f"{len(found)} data sets are" if found else "no data set is"
                known = [one.name for one in self.sets]
                raise InputError(
                    f"{self.path}: {what} called {quoted(name)}; the data sets are "
                    f"{', '.join(quoted(one) for one in known)}.{suggestions(name[:80], known)}"
                )
            if found[0] in chosen:
                raise InputError(f"{self.path}: data set {quoted(name)} is chosen twice")
            chosen.append(found[0])
        return tuple(chosen)


def read_digitised(path: str | Path) -> DigitisedFile:
    """Read an export of WebPlotDigitizer.

    The content decides what the file is: the CSV of one data set (two columns, with or without a header), the CSV of
    all data sets (pairs of columns under their names), a project file (JSON of formats 3 and 4, as versions 3 to 5 of the
    program write them) or a project archive (tar) with such a file in it. In CSV files cells are separated by commas,
    semicolons or tabs; with the latter two, numbers may have decimal commas. Project files hold the pixels and the
    calibration, from which the values are computed again and compared with those stored.

    Parameters
    ----------
    path : the file

    Raises
    ------
    InputError
        naming the line and column, or the key and the point, of what cannot be read

    Examples
    --------
    ``read_digitised("wpd.json").select(["wet"])[0].values``
    """
    path = Path(path)
    try:
        with open_file(path, LARGEST_EXPORT, "a CSV, JSON or tar file of WebPlotDigitizer") as stream:
            start = stream.read(1024)
            stream.seek(0)
            digest = hashlib.file_digest(stream, "sha256").hexdigest()
        archive = start[257:262] == b"ustar" or (b"\0" in start and tarfile.is_tarfile(path))
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({error.strerror or error}); expected a CSV, JSON or tar file of WebPlotDigitizer"
        ) from None
    if not start.strip():
        raise InputError(f"{path}: the file is empty; expected an export of WebPlotDigitizer")
    if archive or start.removeprefix(b"\xef\xbb\xbf").lstrip()[:1] in (b"{", b"["):
        kind, sets, left_out = read_project(path, archive=archive)
        return DigitisedFile(path, kind, digest, sets, left_out)
    return DigitisedFile(path, "CSV of WebPlotDigitizer", digest, read_pairs(path))
