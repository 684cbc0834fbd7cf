"""Where a table of friction comes from: recordings, recipe, versions, rules in words."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from importlib.metadata import version
from typing import Any, Protocol

from skinbayes.files.recipe import Recipe
from skinbayes.files.toml_text import toml_text
from skinbayes.recordings import ReducedRecording
from skinbayes.recordings.words import overall_sentences
from skinbayes.version import __version__


class Reduced(Protocol):
    """What is told of a reduction."""

    @property
    def recordings(self) -> tuple[ReducedRecording, ...]:
        """One for each file."""

    @property
    def recipe(self) -> Recipe:
        """By which they were reduced."""

    @property
    def sources(self) -> Mapping[str, str]:
        """Name to sha256 of each file."""

    @property
    def before_zero(self) -> int:
        """Rows left out because time counts from later."""


def rule_sentences(reduced: Reduced) -> list[str]:
    """What was done, in words."""
    recipe = reduced.recipe
    rules, columns = recipe.rules, recipe.columns
    source = rules.strokes_from or next(
        (key for key in ("position", "sliding_speed") if key in columns and columns[key].value is None),
        "tangential_force",
    )
    by_way = {"position", "sliding_speed"} & {key for key in columns if columns[key].value is None}
    steady = (
        "the longest piece between change points, of at most three with a straight line each"
        if rules.steady == "change points"
        else f"the central {100 * rules.share:g} % of each, by {'distance' if by_way else 'time'}"
    )
    zeros = Counter(one.tangential_zero.how.split(",")[0] for one in reduced.recordings)
    said = [
        "each recording is one stroke"
        if source == "whole"
        else f"strokes from the {str(source).replace('_', ' ')}",
        f"steady part: {steady}",
        f"zero of the tangential force: {', '.join(zeros)}; of the normal force: {reduced.recordings[0].normal_zero.how}",
        f"friction coefficient: {rules.friction}",
    ]
    if rules.directions != "both":
        said.append(f"{rules.directions} strokes only")
    if rules.skip_first:
        said.append(f"without the first {rules.skip_first} strokes of each recording")
    if rules.ramp_edges:
        said.append(f"load in bins between {', '.join(f'{edge:g}' for edge in rules.ramp_edges)} N")
    if recipe.each != ("stroke",):
        said.append(f"a row for each {' and '.join(recipe.each)}")
    if recipe.time_zero:
        said.append(
            f"time counts from {recipe.time_zero:g} s, and {reduced.before_zero} rows before are left out"
        )
    return said


def provenance_text(reduced: Reduced, sha256: str) -> str:
    """Text of a ``provenance.toml``."""
    block = reduced.recipe.block
    names = list(reduced.sources)
    shown = ", ".join(names[:5]) + (f" and {len(names) - 5} more" if len(names) > 5 else "")
    content: dict[str, Any] = {
        "title": block.title,
        "authors": list(block.authors),
        "doi": list(block.doi),
        "licence": block.licence,
        "kind": "measurements",
        "where": f"Recordings {shown}",
        "how_read": f"Reduced by skinbayes {__version__} by the recipe below",
        "transformation": "; ".join(rule_sentences(reduced)),
        "spread": "Standard error of the mean over the steady part, from the number of independent samples (an autoregression "
        "fitted to all strokes of a recording), widened so that 1.645 of it hold 90 %; it contains the error of the zeros of the "
        "forces, which all strokes of a recording share. It does not contain how strokes, places and people differ.",
        "caveats": [*block.caveats, *overall_sentences(reduced.recordings)],
        "sha256": sha256,
        "recipe": reduced.recipe.text,
        "versions": {"skinbayes": __version__, **{name: version(name) for name in ("numpy", "scipy", "pandas")}},
        "recordings": {name: digest or "a data frame" for name, digest in reduced.sources.items()},
    }  # fmt: skip
    return toml_text(content)
