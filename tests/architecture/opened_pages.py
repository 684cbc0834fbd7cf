"""Pages opened in a real browser, and what is wrong with them."""

from __future__ import annotations

import contextlib
import shutil
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

PHONE, DESKTOP = (390, 844), (1280, 900)
NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")

PICTURES = """() => [...document.images].filter(one => one.getClientRects().length)
    .filter(one => !(one.complete && one.naturalWidth > 0)).map(one => one.currentSrc.slice(0, 80))"""
HEADINGS = "() => [...document.querySelectorAll('h1, h2, h3, h4, h5, h6')].map(one => Number(one.tagName[1]))"
SPEECHLESS = """() => [...document.images].filter(one => !one.hasAttribute('alt') || !one.alt.trim())
    .map(one => one.src.slice(0, 80))"""
TOO_WIDE = """() => { const width = document.documentElement.clientWidth;
    return document.documentElement.scrollWidth <= width ? [] : [...document.querySelectorAll('body *')]
        .filter(one => one.getBoundingClientRect().right > width + 1).map(one => one.tagName + '.' + one.className).slice(0, 5)
        .concat(document.documentElement.scrollWidth + ' of ' + width) }"""


@contextlib.contextmanager
def opened_browser() -> Iterator[Any]:
    """A headless browser; the test is skipped where there is none."""
    playwright = pytest.importorskip("playwright.sync_api", reason="opening pages needs skinbayes[browser]")
    path = next((found for name in NAMES if (found := shutil.which(name))), None)
    if path is None:
        pytest.skip(f"no browser on this machine: none of {', '.join(NAMES)}")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()


class Quiet(SimpleHTTPRequestHandler):
    """A server that says nothing."""

    def log_message(self, *_: object) -> None:
        """Nothing."""


@contextlib.contextmanager
def served(folder: Path) -> Iterator[str]:
    """The address under which a folder is served on this machine."""
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder)))
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    yield f"http://127.0.0.1:{server.server_address[1]}"
    server.shutdown()
    server.server_close()
    thread.join()


def unordered(levels: list[int]) -> list[str]:
    """What is wrong with the order of the headings."""
    first = levels.count(1) == 1 and levels[0] == 1
    wrong = [] if first else [f"headings of the first level: {levels.count(1)}, first {levels[:1]}"]
    return wrong + [f"h{b} below h{a}" for a, b in pairwise(levels) if b > a + 1]


def problems(browser: Any, address: str, colours: str = "light") -> list[str]:
    """Everything that is wrong with a page: on a desktop, on a phone, printed, for a screen reader."""
    axe = pytest.importorskip(
        "axe_playwright_python.sync_playwright", reason="opening pages needs skinbayes[browser]"
    )
    wrong: list[str] = []

    def own(url: str) -> bool:
        return url.startswith((address[: address.index("/", 8)], "data:"))

    context = browser.new_context(
        viewport=dict(zip(("width", "height"), DESKTOP, strict=True)), color_scheme=colours
    )
    page = context.new_page()
    page.on("console", lambda one: one.type in ("error", "warning") and wrong.append(f"console: {one.text}"))
    page.on("pageerror", lambda one: wrong.append(f"script: {one}"))
    page.on("requestfailed", lambda one: wrong.append(f"not loaded: {one.url[:100]}"))
    page.on("request", lambda one: own(one.url) or wrong.append(f"from outside: {one.url[:100]}"))
    page.on("dialog", lambda one: (wrong.append(f"dialog: {one.message}"), one.dismiss()))
    page.goto(address, wait_until="load")
    page.evaluate("() => document.querySelectorAll('details').forEach(one => { one.open = true })")
    wrong += unordered(page.evaluate(HEADINGS))
    wrong += [f"no alternative text: {one}" for one in page.evaluate(SPEECHLESS)]
    for name, (width, height) in {"desktop": DESKTOP, "phone": PHONE}.items():
        page.set_viewport_size({"width": width, "height": height})
        page.wait_for_timeout(100)
        wrong += [f"{name}, picture not there: {one}" for one in page.evaluate(PICTURES)]
        wrong += [f"{name}, too wide: {one}" for one in page.evaluate(TOO_WIDE)]
        found = axe.Axe().run(page, options={"runOnly": ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"]})
        for rule in found.response["violations"]:
            nodes = [
                (one["target"][0], one["any"][0]["message"] if one["any"] else "") for one in rule["nodes"]
            ]
            places = "; ".join(f"{place}: {why}" for place, why in nodes[:3])
            wrong.append(f"{name}, {rule['id']} at {len(rule['nodes'])} places: {places}")
    page.keyboard.press("Tab")
    if page.evaluate(
        "() => document.activeElement === document.body && !!document.querySelector('a, summary, button')"
    ):
        wrong.append("the keyboard reaches nothing")
    page.emulate_media(media="print")
    if not page.pdf().startswith(b"%PDF"):
        wrong.append("it cannot be printed")
    context.close()
    return list(dict.fromkeys(wrong))
