"""What all tests share."""

from __future__ import annotations

import os
import signal

import pytest

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    # begun in the background of a shell, which leaves interrupts ignored
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def _tables_of_this_session(tmp_path_factory: pytest.TempPathFactory):
    """Tables are built anew in each session and shared within it; the user's own cache is left alone."""
    before = os.environ.get("SKINBAYES_CACHE")
    os.environ["SKINBAYES_CACHE"] = str(tmp_path_factory.mktemp("tables"))
    yield
    if before is None:
        os.environ.pop("SKINBAYES_CACHE", None)
    else:
        os.environ["SKINBAYES_CACHE"] = before
