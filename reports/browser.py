"""A headless Chromium, spoken to over a pipe: prints the page as PDF, and lets tests look at it.

The protocol is the browser's own (Chrome DevTools Protocol); no driver and no port are needed.
"""

from __future__ import annotations

import base64
import contextlib
import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from camwright.geometry.errors import ResultError

_NAMES = ("chromium", "chromium-browser", "google-chrome-stable", "google-chrome")
_FLAGS = (
    "--headless=new", "--remote-debugging-pipe", "--disable-gpu", "--no-first-run",
    "--disable-dev-shm-usage", "--disable-extensions", "--hide-scrollbars", "--mute-audio",
    "--disable-background-networking", "--disable-component-update", "--no-default-browser-check",
)  # fmt: skip
_LAUNCHER = (
    "import os, sys; os.dup2(int(sys.argv[1]), 3); os.dup2(int(sys.argv[2]), 4); "
    "os.execv(sys.argv[3], sys.argv[3:])"
)
_FIRST_FREE = 10  # the browser reads 3 and writes 4; ours must not be among them
PATIENCE = 120.0


def executable() -> str | None:
    """Path of a Chromium; that in ``CAMWRIGHT_CHROMIUM`` goes first."""
    given = os.environ.get("CAMWRIGHT_CHROMIUM")
    return given or next(filter(None, map(shutil.which, _NAMES)), None)


class Tab:
    """One page of a running browser; `events` holds what it reported, oldest first."""

    def __init__(self, reading: int, writing: int) -> None:
        self._reading, self._writing = reading, writing
        self._kept, self._count = b"", 0
        self._session: str | None = None
        self.events: list[dict[str, Any]] = []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        found = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = found["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The browser's answer to a command.

        Raises
        ------
        ResultError
            If it refuses, ends or does not answer.
        """
        self._count += 1
        message: dict[str, Any] = {"id": self._count, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        self._send(json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._count:
                if "error" in answer:
                    raise ResultError(f"browser: {method}: {answer['error'].get('message')}")
                result: dict[str, Any] = answer["result"]
                return result
            self.events.append(answer)

    def evaluate(self, script: str) -> Any:
        """Value of a JavaScript expression; a promise is waited for."""
        found = self.call(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in found:
            raise ResultError(f"browser: {found['exceptionDetails'].get('text')}: {script[:80]}")
        return found["result"].get("value")

    def open(self, page: Path) -> None:
        """Go to a file and wait until it is loaded."""
        self.call("Page.navigate", url=page.resolve().as_uri())
        self.wait("document.readyState === 'complete' && location.protocol === 'file:'")

    def wait(self, condition: str, patience: float = PATIENCE) -> None:
        """Until a JavaScript condition holds."""
        end = time.monotonic() + patience
        while not self.evaluate(condition):
            if time.monotonic() > end:
                raise ResultError(f"browser: waited in vain for {condition}")
            time.sleep(0.05)

    def size(self, width: int, height: int) -> None:
        """Set the window, in CSS pixels."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=1, mobile=width < 600,
        )  # fmt: skip

    def complaints(self) -> list[str]:
        """Console errors and uncaught exceptions so far."""
        found = []
        for event in self.events:
            told = event.get("params", {})
            if event.get("method") == "Runtime.exceptionThrown":
                found.append(json.dumps(told["exceptionDetails"])[:400])
            if event.get("method") == "Runtime.consoleAPICalled" and told["type"] == "error":
                found.append(json.dumps(told["args"])[:400])
            if event.get("method") == "Log.entryAdded" and told["entry"]["level"] == "error":
                found.append(told["entry"]["text"])
        return found

    def _send(self, data: bytes) -> None:
        while data:
            data = data[os.write(self._writing, data) :]

    def _next(self) -> dict[str, Any]:
        end = time.monotonic() + PATIENCE
        while b"\0" not in self._kept:
            ready, _, _ = select.select([self._reading], [], [], max(end - time.monotonic(), 0))
            more = os.read(self._reading, 1 << 20) if ready else b""
            if not more:
                raise ResultError("browser: ended" if ready else "browser: does not answer")
            self._kept += more
        line, _, self._kept = self._kept.partition(b"\0")
        answer: dict[str, Any] = json.loads(line)
        return answer


@contextmanager
def tab() -> Iterator[Tab]:
    """A page of a fresh browser, which ends with the block.

    Raises
    ------
    ResultError
        If no Chromium is found or it does not start.
    """
    program = executable()
    if program is None:
        raise ResultError("no Chromium found: install it (Debian: chromium) or set "
                          "CAMWRIGHT_CHROMIUM to its path")  # fmt: skip
    flags = [*_FLAGS, *(["--no-sandbox"] if os.geteuid() == 0 else [])]
    theirs_in, ours_out = _pipe()
    ours_in, theirs_out = _pipe()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as home:
        process = subprocess.Popen(  # noqa: S603 - our own launcher, names as arguments
            [sys.executable, "-c", _LAUNCHER, str(theirs_in), str(theirs_out),
             program, *flags, f"--user-data-dir={home}"],
            pass_fds=(theirs_in, theirs_out), stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL,
        )  # fmt: skip
        os.close(theirs_in)
        os.close(theirs_out)
        try:
            yield Tab(ours_in, ours_out)
        finally:
            os.close(ours_in)
            os.close(ours_out)
            with contextlib.suppress(subprocess.TimeoutExpired):
                process.wait(5)  # it ends when its pipe does
            process.kill()
            process.wait()


def print_pdf(page: Path, pdf: Path, footer: str) -> None:
    """Print a page to A4 with page numbers, fonts embedded.

    Parameters
    ----------
    footer : str    HTML for the left of every foot; the page number stands at its right
    """
    with tab() as opened:
        opened.open(page)
        printed = opened.call(
            "Page.printToPDF", printBackground=True, preferCSSPageSize=True,
            paperWidth=8.27, paperHeight=11.69, marginTop=0.5, marginBottom=0.7, marginLeft=0.5,
            marginRight=0.5, displayHeaderFooter=True, headerTemplate="<span></span>",
            footerTemplate=(
                '<div style="font:8px sans-serif;width:100%;padding:0 0.5in;display:flex;'
                f'justify-content:space-between"><span>{footer}</span><span>page '
                '<span class="pageNumber"></span> of <span class="totalPages"></span></span></div>'
            ),
        )  # fmt: skip
    data = base64.b64decode(printed["data"])
    if not data.startswith(b"%PDF"):
        raise ResultError("browser: what it printed is no PDF")
    try:
        pdf.write_bytes(data)
    except OSError as error:
        raise ResultError(f"{pdf}: {error.strerror or error}") from None


def _pipe() -> tuple[int, int]:
    """Both ends of a pipe, numbered out of the browser's way."""
    ends = os.pipe()
    moved = tuple(fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, _FIRST_FREE) for end in ends)
    for end in ends:
        os.close(end)
    return moved[0], moved[1]
