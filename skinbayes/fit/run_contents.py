"""The files of a finished run, in memory: for whoever writes them elsewhere, or on another machine."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from typing import TYPE_CHECKING

from skinbayes.fit.manifest import RESULT, RUN, SUMMARY, Manifest, manifest_note
from skinbayes.fit.netcdf import result_image
from skinbayes.fit.run_inputs import inputs_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from skinbayes.fit.result import PosteriorResult
    from skinbayes.problem import JointProblem, Problem


def result_contents(fit: PosteriorResult) -> dict[str, bytes]:
    """Result and summary table, by the name of their file."""
    table = fit.summary(derived=True).to_csv(index_label="parameter", lineterminator="\n")
    return {RESULT: result_image(fit.groups, fit.provenance), SUMMARY: table.encode()}


def with_files(manifest: Manifest, contents: Mapping[str, bytes]) -> Manifest:
    """The manifest that lists further files."""
    written = {name: hashlib.sha256(content).hexdigest() for name, content in contents.items()}
    return replace(manifest, files={**manifest.files, **written})


def run_contents(fit: PosteriorResult, problem: Problem | JointProblem) -> dict[str, bytes]:
    """Path inside the run directory to content; ``run.json`` comes last, as a run that it lists is one that was finished."""
    manifest, contents = inputs_of(problem, str(fit.provenance["sampling"]["engine"]))
    results = result_contents(fit)
    return {**contents, **results, RUN: manifest_note(with_files(manifest, results))}
