"""Output streams whose reader may close them early.

A command does its work and returns its exit code whether or not its output is read.
"""

from __future__ import annotations

import io
import os
import sys
from typing import Any, TextIO

_STANDARD = ("stdin", "stdout", "stderr")  # by number


class _Unread(io.FileIO):
    """File that drops what is written after its reader has left."""

    all_errors = False
    """Any other error of writing, such as a full disk, drops the rest as well."""

    def write(self, data: Any, /) -> int:
        """Write data and give the number of bytes taken; after an error, such as a full disk, which
        is raised once as OSError, all is dropped.
        """
        try:
            return super().write(data)
        except OSError as error:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self.fileno())
            os.close(nowhere)
            if self.all_errors or isinstance(error, ConnectionError):
                return super().write(data)
            raise OSError(error.errno, error.strerror, "standard output") from None


def open_streams() -> None:
    """Wrap standard output and errors so that an early close is no error.

    A stream that is closed when Python starts is one that drops everything: otherwise the next file
    that is opened has its number, and what a library prints goes into that file.
    """
    for name in _STANDARD:
        if getattr(sys, name) is None:
            mode = "r" if name == "stdin" else "w"
            stream = open(os.devnull, mode, encoding="utf-8")  # noqa: SIM115, PTH123
            os.set_inheritable(stream.fileno(), True)
            setattr(sys, name, stream)
        elif name != "stdin" and getattr(sys, name) is getattr(sys, f"__{name}__"):
            setattr(sys, name, _kept_open(getattr(sys, name), all_errors=name == "stderr"))


def _kept_open(stream: TextIO, *, all_errors: bool) -> TextIO:
    raw = _Unread(stream.fileno(), "wb", closefd=False)
    raw.all_errors = all_errors
    return io.TextIOWrapper(
        io.BufferedWriter(raw),
        encoding=stream.encoding,
        errors=stream.errors,
        line_buffering=getattr(stream, "line_buffering", False),
    )
