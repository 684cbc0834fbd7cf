"""Where a data set comes from: the validated ``provenance.toml`` beside its ``data.csv``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from skinbayes.errors import InputError
from skinbayes.files.toml_text import explain, read_toml

Text = Annotated[str, Field(min_length=1)]
Doi = Annotated[str, Field(pattern=r"^10\.[0-9]{4,9}/[^\s\"<>]+$")]

TEXTS = ("licence", "attribution", "where", "how_read", "digitised_by", "transformation", "spread")
"""Texts of a `Provenance` that are shown with the data, in their order."""


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


class Provenance(BaseModel):
    """Origin of a data set.

    Attributes
    ----------
    title, authors : of the work the numbers come from
    doi : digital object identifiers, without a resolver address
    licence : licence of the data, or what is known about it
    attribution : the credit that the licence asks for, if any
    kind : ``"measurements"`` can be fitted; ``"reference"`` collects published values for priors and checks
    where : table, figure, file or section that was read
    how_read : copied from text, from deposited files, digitised
    digitised_by : who read a figure, if one was read
    transformation : what was done to the numbers between the source and ``data.csv``
    spread : what the spread columns mean, or that there are none
    caveats : what a user has to know before trusting a fit
    columns : meaning of columns that the vocabulary does not know (reference tables)
    grades : meaning of the grades of reliability (reference tables)
    sha256 : of the bytes of ``data.csv``
    recipe : by which recordings were reduced, if they were
    versions : of the programs that did so
    recordings : name of each recording to the sha256 of its file
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    title: Text
    authors: Annotated[list[Text], BeforeValidator(_as_list), Field(min_length=1)]
    doi: Annotated[list[Doi], BeforeValidator(_as_list)] = []
    licence: Text
    attribution: Text | None = None
    kind: Literal["measurements", "reference"]
    where: Text
    how_read: Text
    digitised_by: Text | None = None
    transformation: Text
    spread: Text
    caveats: list[Text] = []
    columns: dict[str, Text] = {}
    grades: dict[str, Text] = {}
    sha256: Annotated[str, Field(pattern=r"^[0-9a-f]{64}$")]
    recipe: Text | None = None
    versions: dict[str, Text] = {}
    recordings: dict[str, Text] = {}


def load_provenance(path: Path) -> Provenance:
    """Read and validate a ``provenance.toml``.

    Parameters
    ----------
    path : the file

    Raises
    ------
    InputError
        if the file is unreadable, is not TOML, or a key is missing, unknown or of the wrong type
    """
    content, text = read_toml(path)
    try:
        return Provenance.model_validate(content)
    except ValidationError as error:
        raise InputError(explain(error, path, text, Provenance.model_fields)) from None


def check_sha256(provenance: Provenance, data: Path, sha256: str, described_in: Path) -> None:
    """Refuse data that are not those the provenance describes.

    Parameters
    ----------
    provenance : what is claimed
    data : file of the data
    sha256 : of its bytes
    described_in : file of the provenance

    Raises
    ------
    InputError
        if the checksums differ
    """
    if provenance.sha256 != sha256:
        raise InputError(
            f"{data}: sha256 is {sha256}; expected {provenance.sha256} as {described_in} says. "
            "The data were changed after their origin was written down"
        )
