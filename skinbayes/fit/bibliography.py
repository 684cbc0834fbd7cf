"""Works that a fit may rest on, as text and as BibTeX."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

_SPECIAL = str.maketrans(
    {c: f"\\{c}" for c in "&%$#_{}"} | {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
)  # fmt: skip


@dataclass(frozen=True)
class Reference:
    """One work.

    Attributes
    ----------
    key : of the BibTeX entry
    authors : initials and family name each, or the name of a group
    title : of the work
    use : what it was used for, a few words
    year, journal, volume, pages : where it was printed; empty for data and software
    doi : digital object identifiers, without a resolver address
    version : of software
    """

    key: str
    authors: Sequence[str]
    title: str
    use: str
    year: str = ""
    journal: str = ""
    volume: str = ""
    pages: str = ""
    doi: Sequence[str] = ()
    version: str = ""

    def text(self) -> str:
        """One line, as in a list of references.

        Examples
        --------
        >>> works()["persson2001theory"].text().partition(", The Journal")[2]
        ' of Chemical Physics 115 (2001) 3840, doi 10.1063/1.1388626 (area of real contact)'
        """
        printed = f"{self.journal} {self.volume} ({self.year}) {self.pages.partition('-')[0]}"
        parts = [
            ", ".join(self.authors),
            self.title,
            printed if self.journal else self.year,
            f"version {self.version}" if self.version else "",
            f"doi {', '.join(self.doi)}" if self.doi else "",
        ]
        return f"{', '.join(part for part in parts if part)} ({self.use})"

    def bibtex(self) -> str:
        """The BibTeX entry; characters with a meaning in TeX are escaped, letters outside ASCII are left (for biber).

        Examples
        --------
        >>> print(Reference("data", ("A. & B. Lab",), "50 % wet", "data", doi=("10.1234/a_b",)).bibtex())
        @misc{data,
          author = {{A. \\& B. Lab}},
          title = {{50 \\% wet}},
          doi = {10.1234/a_b},
          note = {data},
        }
        """
        authors = [_author(name) for name in self.authors]
        fields = {
            "author": " and ".join(authors),
            "title": f"{{{_escaped(self.title)}}}",
            "journal": _escaped(self.journal),
            "year": _escaped(self.year),
            "volume": _escaped(self.volume),
            "pages": _escaped(self.pages.replace("-", "--")),
            "version": _escaped(self.version),
            "doi": ", ".join(re.sub(r"[{}\\\s]", "", doi) for doi in self.doi),
            "note": _escaped(self.use),
        }
        kind = "article" if self.journal else "software" if self.version else "misc"
        lines = [f"  {name} = {{{value}}}," for name, value in fields.items() if value]
        return "\n".join([f"@{kind}{{{self.key},", *lines, "}"])


def works() -> dict[str, Reference]:
    """The works of ``bibliography.toml`` by key."""
    entries = tomllib.loads(Path(__file__).with_suffix(".toml").read_text(encoding="utf-8"))
    return {key: Reference(key, **entry) for key, entry in entries.items()}


def key_of(text: str) -> str:
    """A BibTeX key: letters, digits and hyphens of a text.

    Examples
    --------
    >>> key_of("my déjà data, 2.csv")
    'my-deja-data-2-csv'
    """
    plain = unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()
    return re.sub(r"[^A-Za-z0-9]+", "-", plain).strip("-") or "data"


def _escaped(text: str) -> str:
    return " ".join(text.split()).translate(_SPECIAL)


def _author(name: str) -> str:
    """A person as ``Family, I. N.``; what is not initials and one family name stays as it is, in braces."""
    match = re.fullmatch(r"((?:[^\W\d_]\.[ -]?)+)([^\s&,{}\\]+(?: [^\s&,{}\\]+)?)", name)
    return f"{_escaped(match[2])}, {_escaped(match[1])}" if match else f"{{{_escaped(name)}}}"
