"""A recipe to be completed, with what a recording itself tells."""

from __future__ import annotations

from pathlib import Path

from skinbayes.files.recipe_schema import FileBlock
from skinbayes.files.recording_text import Layout, layout_of, name_and_unit
from skinbayes.synonyms import plain_name
from skinbayes.units import converts

COLUMNS = (
    ("time", "s", "", "t zeit elapsed"),
    (
        "tangential_force",
        "N",
        "force along the surface, with its sign",
        "fx ft f_x f_t lateral tangential friction shear",
    ),
    (
        "normal_force",
        "N",
        "force onto the surface, positive under load",
        "fz fn f_z f_n load normal vertical",
    ),
    ("position", "m", "of the slide, with its sign", "x pos position stroke displacement"),
    ("relative_humidity", "1", "", "rh humidity feuchte"),
)
"""Key, SI unit, meaning and words by which a column may be known."""

HEAD = """\
# How recordings of a tribometer become friction: complete what stands between “ ”, then
#     skinbayes reduce FILES... --recipe {name} -o glass
format = 1
title = "“what was measured”"
authors = ["“who measured”"]
licence = "not stated"
caveats = []                                  # what a user of the data has to know

"""

BODY = """\
[labels]                                      # text that tells rows apart
# file_name = "{person}-{session}"            # parts of the file's name, without its ending
# counterface = "glass ball"                  # the same in all recordings
# state = { name = "State" }                  # a column of the recording

[strokes]
# from = "position"                           # or "sliding_speed", "tangential_force" (its sign), "whole"
# minimum_length = "2 mm"                     # of a stroke; else a fifth of the range of positions
directions = "both"                           # or "forward", "backward"
skip_first = 0                                # strokes in which friction runs in

[steady]
rule = "central share"                        # or "change points": the longest piece between changes
share = 0.6                                   # of each stroke, by distance where that is known

[zero]
tangential_force = "%s"          # half way between both directions; or "rest", "as recorded"
normal_force = "as recorded"                  # or "rest"
# rest = ["0 s", "1 s"]                       # a part of each recording in which nothing touches

[friction]
coefficient = "ratio of means"                # or "mean of ratios"

# [ramp]                                      # a row for each bin of load in place of each stroke
# edges = ["0.1 N", "0.2 N", "0.5 N", "1 N"]

[rows]
each = "stroke"                               # or "pair" (of directions), "recording", or labels: ["person", "session"]
# time_zero = "30 s"                          # of the recording; rows before it are left out
"""


def recipe_template(name: str, recording: str | Path | None = None) -> str:
    """Text of a recipe; with a recording its columns are filled in as far as their names tell.

    Parameters
    ----------
    name : of the recipe's file, for the first comment
    recording : a file, or None

    Raises
    ------
    InputError
        if the recording cannot be read
    """
    layout = None if recording is None else layout_of(Path(recording), FileBlock())
    found = {} if layout is None else _guessed(layout)
    lines = [
        "[file]",
        *_file_lines(layout),
        "",
        "[columns]                                     # (number in the file − offset) · factor · sign, in unit",
    ]
    if layout is not None and layout.names_line:
        lines.append("# the file has: " + ", ".join(header for header in layout.names if header))
    for key, unit, meaning, _ in COLUMNS:
        entry = found.get(key)
        text = f'{key} = {{ name = "{entry[0] if entry else "“name”"}", unit = "{entry[1] if entry else unit}" }}'
        needed = key in ("time", "tangential_force", "normal_force") or entry is not None
        lines.append(f"{'' if needed else '# '}{text:<44}{f'  # {meaning}' if meaning else ''}".rstrip())
    lines += [
        '# sphere_radius = { value = "8 mm" }         # the same in all rows, as a model needs it',
        '# tangential_force = { name = "Fx", unit = "mN", offset = 12.5, factor = 1.02, sign = -1, range = ["-2 N", "2 N"] }',
        "",
    ]
    both = "both directions" if layout is None or "position" in found else "as recorded"
    return HEAD.replace("{name}", name) + "\n".join(lines) + "\n" + BODY % both


def _file_lines(layout: Layout | None) -> list[str]:
    if layout is None:
        return [
            '# separator = "tab"                          # or "semicolon", "comma", "blanks"; seen in the file if not stated',
            '# decimal = "comma"                          # or "point"',
            "# header_lines = 5                           # lines above the numbers",
            '# sampling_rate = "100 1/s"                  # in place of a column of time',
        ]
    decimal = "comma" if layout.decimal == "," else "point"
    return [
        f'separator = "{layout.separator}"',
        f'decimal = "{decimal}"',
        f"header_lines = {layout.header_lines}",
        '# sampling_rate = "100 1/s"                  # in place of a column of time',
    ]


def _guessed(layout: Layout) -> dict[str, tuple[str, str]]:
    """Columns whose names and units tell what they are: key to name and unit."""
    found: dict[str, tuple[str, str]] = {}
    for header, unit in zip(layout.names, layout.units, strict=True):
        name = name_and_unit(header)[0]
        words = set(plain_name(name).split("_")) | {plain_name(name)}
        for key, si, _, known in COLUMNS:
            if key not in found and unit and converts(unit, si) and words & {key, *known.split()}:
                found[key] = header, unit
                break
    return found
