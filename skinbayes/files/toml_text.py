"""TOML: reading it with errors that name the file and the line, and writing it."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar
from unicodedata import normalize

from skinbayes.errors import InputError
from skinbayes.files.reading import read_file
from skinbayes.vocabulary import suggestions

if TYPE_CHECKING:
    from pydantic import BaseModel, ValidationError

Block = TypeVar("Block", bound="BaseModel")
Read = TypeVar("Read")

LARGEST_FILE = 1_000_000
"""Bytes; a model file or a provenance file is a page or two of text."""


_DEEPEST = 20
"""Parts of a dotted key; a model file has four."""

_LARGEST_INTEGER = 2**63
"""TOML promises no larger ones, and powers of larger ones are no numbers."""

_DEEP_KEY = re.compile(rf"(?<![\w\"'-])[\w\"'-]++(?:\s?\.\s?[\w\"'-]++){{{_DEEPEST}}}")


def read_text(path: Path) -> str:
    """Return the text of ``path``; :class:`InputError` if it is missing, empty, too large, binary or not UTF-8."""
    data = read_file(path, LARGEST_FILE, "a TOML file")
    if not data.strip():
        raise InputError(
            f"{path}: the file is empty; a TOML file with a title and a forward model was expected"
        )
    if b"\0" in data:
        raise InputError(f"{path}: binary data at byte {data.index(0)}; a UTF-8 text file was expected")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputError(f"{path}, line {line}: byte 0x{data[error.start]:02x} is not UTF-8 text") from None


def read_toml(path: Path) -> tuple[dict[str, Any], str]:
    """Return the parsed content of a TOML file and its text.

    Raises
    ------
    InputError
        The file cannot be read, or is not valid TOML (a key given twice, a missing quote), is nested deeper than any model is,
        or has integers of more than 64 bits; names the line.
    """
    text = read_text(path)
    if deep := _DEEP_KEY.search(text):  # the parser takes time that grows with the square of the depth
        line = text.count("\n", 0, deep.start()) + 1
        raise InputError(f"{path}, line {line}: nested too deeply to be a model file")
    try:
        content = tomllib.loads(text.replace("\r\n", "\n"))
    except tomllib.TOMLDecodeError as error:
        message = str(error)
        found = re.search(r"\(at line (\d+), column (\d+)\)", message)
        reason = re.sub(r"\s*\(at .*\)", "", message)
        if "overwrite" in reason or "declare" in reason:
            reason += " – a key or table stands here a second time"
        at = f", line {found[1]}, column {found[2]}" if found else ""
        raise InputError(f"{path}{at}: not valid TOML: {reason:.200}") from None
    except RecursionError:
        raise InputError(f"{path}: nested too deeply to be a model file") from None
    except ValueError as error:  # an integer of thousands of digits, a date that no calendar has
        raise InputError(f"{path}: not valid TOML: {str(error).partition(';')[0]:.200}") from None
    _refuse_large_integers(content, Places(path, text))
    return (content if text.isascii() else _composed(content)), text


def _refuse_large_integers(item: Any, places: Places, keys: tuple[str, ...] = ()) -> None:
    if isinstance(item, dict):
        for key, value in item.items():
            _refuse_large_integers(value, places, (*keys, key))
    elif isinstance(item, list):
        for value in item:
            _refuse_large_integers(value, places, keys)
    elif isinstance(item, int) and not -_LARGEST_INTEGER <= item < _LARGEST_INTEGER:
        place = places.located(places(*keys))
        raise InputError(f"{place}: an integer of {item.bit_length()} bits; expected a number such as 1e20")


class Places:
    """Where things stand in a file, for messages: ``FILE: table.key``, and with the line once a message is made of it.

    Finding a line takes a search of the whole file, so it is done for the one message that is shown.
    """

    def __init__(self, path: Path, text: str) -> None:
        self.path, self.text = path, text
        self._known: dict[str, tuple[str, ...]] = {}

    def __call__(self, *keys: str) -> str:
        """The place of a key."""
        place = f"{self.path}: {'.'.join(shortened(key) for key in keys)}"
        self._known[place] = keys
        return place

    def located(self, message: str) -> str:
        """The message with the line of the place that it begins with, if that is known and the line is found."""
        start = f"{self.path}: "
        if not message.startswith(start):
            return message
        best = max((place for place in self._known if message.startswith(place)), key=len, default=None)
        line = best and line_of(self.text, self._known[best])
        return f"{self.path}, line {line}: {message.removeprefix(start)}" if line else message


def shortened(text: str) -> str:
    """Text of a file inside a message: not longer than a line."""
    return text if len(text) <= 60 else text[:57] + "..."


def _composed(item: Any, key: str = "") -> Any:
    """Keys and text in Unicode normal form C, as labels of data have; paths as they are, since files are called so."""
    if isinstance(item, dict):
        return {normalize("NFC", name): _composed(value, name) for name, value in item.items()}
    if isinstance(item, list):
        return [_composed(value, key) for value in item]
    return (
        normalize("NFC", item) if isinstance(item, str) and key not in ("file", "baseline_models") else item
    )


def line_of(text: str, keys: Sequence[str]) -> int | None:
    """Line (from 1) on which the key path ``keys`` is set, or the deepest part of it that can be found.

    A plain search, good enough for messages: table headers first, then ``key =`` inside the table.

    >>> line_of("title = 'x'\\n[parameters]\\nyield_stress = 3\\n", ["parameters", "yield_stress"])
    3
    """
    lines = normalize("NFC", text).splitlines()
    best: int | None = None
    start = 0
    depth = 0
    for count in range(len(keys), 0, -1):
        header = re.compile(r"^\s*\[+\s*" + r"\s*\.\s*".join(_quoted(key) for key in keys[:count]) + r"\s*\]")
        position = next((i for i, line in enumerate(lines) if header.match(line)), None)
        if position is not None:
            best, start, depth = position + 1, position + 1, count
            break
    for key in keys[depth:]:
        pattern = re.compile(r"(^|[{,.\s])" + _quoted(key) + r"\s*[=.]")
        for i in range(max(start - 1, 0), len(lines)):
            if i >= start and re.match(r"^\s*\[", lines[i]) and depth:
                break
            if pattern.search(lines[i]) and not lines[i].lstrip().startswith("#"):
                best, start = i + 1, i + 1
                break
        else:
            break
    return best


_COUNTERFACE = (
    "a measured spectrum of the counterface is not taken as a table, which would end where the instrument did; expected "
    "counterface_rms_height, counterface_hurst_exponent, counterface_wavevector_min, counterface_wavevector_rolloff and "
    "counterface_wavevector_max under [parameters], which 'skinbayes spectrum FILE --fit' finds"
)


def explain(error: ValidationError, path: Path, text: str, known: Collection[str] = ()) -> str:
    """One sentence for the first thing a file got wrong, with how many more there are.

    Parameters
    ----------
    error : what pydantic found
    path, text : the file and its content
    known : keys of the top level, for suggestions
    """
    problems = error.errors()
    first = problems[0]
    keys = [str(part) for part in first["loc"] if not isinstance(part, int)]
    line = line_of(text, keys) if keys and first["type"] != "missing" else None
    place = f"{path}{f', line {line}' if line else ''}: {'.'.join(map(shortened, keys))}".rstrip(": ")
    if first["type"] == "extra_forbidden":
        said = (
            _COUNTERFACE
            if keys[-1].startswith("counterface")
            else f"unknown key.{suggestions(keys[-1], list(known) if len(keys) == 1 else [])}"
        )
    elif first["type"] == "missing":
        said = "is missing"
    elif first["type"] == "value_error":
        said = str(first["msg"]).removeprefix("Value error, ")
    else:
        said = f"found {first['input']!r:.60}; {str(first['msg'])[0].lower()}{str(first['msg'])[1:]}"
    others = len(problems) - 1
    return f"{place}: {said}" + (f" (and {others} more problem{'s' if others > 1 else ''})" if others else "")


def read_tables(
    schema: type[Block],
    content: Mapping[str, Any],
    path: Path,
    text: str,
    read: Callable[[Block, Path, str, Places], Read],
) -> Read:
    """What the tables of a file say, by the schema that they have to fit and a function of the tables that fit it.

    Parameters
    ----------
    schema : of the tables
    content : tables and values, as TOML has them
    path : the file, or a name that stands for it in messages
    text : the file as it stands, in which messages count lines
    read : makes the result of the tables, the path, the text and the places of keys

    Raises
    ------
    InputError
        Tables do not fit the schema, hold control characters, or ``read`` refuses them; names the line.
    """
    from pydantic import ValidationError

    try:
        block = schema.model_validate(content)
    except ValidationError as error:
        raise InputError(explain(error, path, text, schema.model_fields)) from None
    places = Places(path, text)
    try:
        check_printable(content, places)
        return read(block, path, text, places)
    except InputError as error:
        raise InputError(places.located(str(error))) from None


def check_printable(item: Any, where: Any, keys: tuple[str, ...] = ()) -> None:
    """Refuse control characters: what a model file says is written to terminals, pages and other files."""
    if isinstance(item, dict):
        for key, value in item.items():
            check_printable(key, where, keys)
            check_printable(value, where, (*keys, key))
    elif isinstance(item, list):
        for value in item:
            check_printable(value, where, keys)
    elif isinstance(item, str) and not "".join(item.split()).isprintable():
        raise InputError(f"{where(*keys)}: found {item[:60]!r}; expected printable characters only")


def _quoted(key: str) -> str:
    return "[\"']?" + re.escape(key) + "[\"']?"


def toml_text(content: Mapping[str, Any]) -> str:
    """Tables and values as the text of a model file; what is empty is left out, but for the parameters, which none may lack.

    >>> print(toml_text({"title": "A ball", "parameters": {"yield_stress": {"fixed": "inf Pa"}}}), end="")
    title = "A ball"
    <BLANKLINE>
    [parameters.yield_stress]
    fixed = "inf Pa"
    """
    import tomlkit

    content = {key: value for key, value in content.items() if value not in ({}, []) or key == "parameters"}
    for key in ("description", "recipe"):
        if "\n" in content.get(key, ""):
            content[key] = tomlkit.string(f"\n{content[key].rstrip()}\n", multiline=True)
    return tomlkit.dumps(content)
