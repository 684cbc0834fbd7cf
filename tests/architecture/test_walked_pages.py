"""Whoever follows a page of the site from top to bottom sees what it shows."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import pytest
import walked_pages as walked

PAGES = walked.pages()


def test_there_are_pages() -> None:
    assert {"quick-start", "load-series", "sites-and-people"} <= {path.stem for path in PAGES}


@pytest.mark.site
@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.stem)
def test_the_page_can_be_followed(path: Path, tmp_path: Path) -> None:
    matplotlib.use("Agg")
    page = path.read_text(encoding="utf-8")
    for step, printed in walked.walk(page, tmp_path):
        if step.kind == "file":
            assert f"`{step.name}`" in page, f"the text does not say that the file is {step.name}"
        elif step.shown is not None:
            wrong = walked.missing(step.shown, printed)
            assert not wrong, (
                f"{step.text}{wrong}\nif the change is meant: python tests/architecture/walked_pages.py"
            )


def test_a_line_that_is_not_printed_is_noticed() -> None:
    printed = "The modulus is 7 MPa.\n sigma    15   3\nDone.\n"
    assert walked.missing("The modulus is 8 MPa.\n…\nDone.\n", printed) == []
    assert walked.missing("The thickness is 7 MPa.\n", printed) == ["The thickness is MPa"]
    assert walked.missing("Done.\nThe modulus is 7 MPa.\n", printed) == ["The modulus is MPa"]
    assert len(walked.missing(" sigma    15   4\n", printed)) == 1
