"""Pages that are made from the code are as the code is."""

from __future__ import annotations

import pytest
import reference_pages
from source_tree import ROOT


@pytest.mark.parametrize("name", reference_pages.PAGES)
def test_the_page_is_what_the_code_says(name: str) -> None:
    written = (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    assert written == reference_pages.PAGES[name](), "python tests/architecture/reference_pages.py"
