"""A tab of the system's Chromium, driven by Playwright; skips where either is missing."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

ARGUMENTS = (
    "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
)  # fmt: skip
PATIENCE = 60_000.0  # ms


class Tab:
    """One tab: what its page requested over the network, and what it logged as an error."""

    def __init__(self, page) -> None:
        self.page = page
        self.errors: list[str] = []
        self.requests: list[str] = []
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", lambda m: m.type == "error" and self.errors.append(m.text))
        page.on("request", lambda request: self.requests.append(request.url))

    def open(self, file: Path, width: int, height: int) -> None:
        """Show a file in a window of this size, CSS pixels."""
        self.errors.clear()
        self.requests.clear()
        self.page.set_viewport_size({"width": width, "height": height})
        self.page.goto(file.resolve().as_uri())

    def evaluate(self, script: str):
        return self.page.evaluate(script)

    @property
    def outside(self) -> list[str]:
        """Requests beyond the page's own file and the data in it."""
        return [url for url in self.requests if not url.startswith(("file:", "data:", "blob:"))]


@contextmanager
def chromium() -> Iterator[Tab]:
    """A tab of a fresh browser, which ends with the block."""
    playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed")
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("Chromium is not installed (Debian: chromium)")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=list(ARGUMENTS))
        page = browser.new_page()
        page.set_default_timeout(PATIENCE)
        try:
            yield Tab(page)
        finally:
            browser.close()
