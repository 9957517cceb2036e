"""Command line of `camwright`: parses arguments, runs a command, returns its exit code.

A command is imported when it is run, so that ``--version`` and ``--help`` are fast.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import time
import traceback
from collections.abc import Sequence
from typing import NoReturn

from camwright.geometry.errors import AlteredError, CamError, InputError
from camwright.pipeline.commands.arguments import (
    HELP,
    asks_for_help,
    help_of,
    option_named,
    read_arguments,
)
from camwright.pipeline.commands.command_tree import (
    GROUPS,
    TREE,
    refuse_former,
    split_path,
    tree_text,
)
from camwright.pipeline.commands.output_streams import open_streams
from camwright.pipeline.commands.terminal import (
    ALTERED,
    ERROR,
    INTERRUPTED,
    PASSED,
    say,
    show_text,
    tell,
)

# Parallel by processes; one thread also fixes the order of sums. Set before numpy is imported.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
# Pydantic would search all installed packages for plugins, and uses none here.
os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")

_SIGNAL = 128  # plus the number of a signal: the exit code after it
_END = (signal.SIGTERM, signal.SIGHUP)  # beside the keyboard interrupt
_ONCE_S = (
    2.0  # a terminal that closes sends its signal twice: the second does not stop the clean-up
)
_COLLECT_AFTER = 50_000  # new objects


def main() -> NoReturn:
    """Entry point: runs a command; an error prints a line per fault, exit code 2, altered run 4.

    A signal becomes one line and 128 + its number; one that is ignored at the start, as by
    ``nohup``, stays ignored.
    """
    open_streams()
    words = [word for word in sys.argv[1:] if word != "--debug"]
    received: dict[int, float] = {}

    def interrupt(number: int, _: object) -> None:
        """Raise KeyboardInterrupt at a signal; the same signal shortly after is ignored."""
        now = time.monotonic()
        if now - received.get(number, -_ONCE_S) < _ONCE_S:
            return
        received[number] = now
        raise KeyboardInterrupt

    for number in _END:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, interrupt)
    # Arrays go by their counts of references; the search for cycles costs 6 % of a short command.
    gc.set_threshold(_COLLECT_AFTER)
    try:
        code = run_line(words)
    except KeyboardInterrupt:
        code = INTERRUPTED
    except Exception as error:  # noqa: BLE001 - every error ends in a message and its exit code
        if "--debug" in sys.argv:
            tell(traceback.format_exc())
        *before, last = _described(error)
        for line in before:
            say(line)
        say("; ".join((last, *getattr(error, "__notes__", ()))))
        code = ALTERED if isinstance(error, AlteredError) else ERROR
    if code == INTERRUPTED:
        say("; ".join(filter(None, ("interrupted", _resumed(words)))))
        code = _SIGNAL + next(iter(received)) if received else INTERRUPTED
        # Python remembers an interrupt that has passed an `exec` of text, as where a dataclass is
        # made, and would end `python -m` by SIGINT whatever the code; the next one forgets it.
        exec("")  # noqa: S102
    try:
        sys.stdout.flush()
    except OSError as error:
        say(_describe(error))
        code = ERROR
    gc.freeze()  # the interpreter would search all objects for cycles once more as it ends
    sys.exit(code)


def run_line(words: Sequence[str]) -> int:
    """Run the command of a line, or print help, version or completion; its exit code.

    Raises
    ------
    CamError
        If a word is refused, or by the command.
    """
    if not words or words[0] in HELP:
        show_text(tree_text())
        return PASSED
    if words[0] in _ROOT:
        if any(word in HELP for word in words):
            show_text(tree_text())
            return PASSED
        if len(words) > 1:
            raise InputError(words[1], "one argument too many", "left out")
        _ROOT[words[0]]()
        return PASSED
    if words[0] in GROUPS and (len(words) == 1 or words[1] in HELP):
        show_text(tree_text(words[0]))
        return PASSED
    path, texts = split_path(words)
    command = TREE[path].command
    if asks_for_help(command, texts):
        show_text(help_of(path, command))
        return PASSED
    try:
        values = read_arguments(command, texts)
    except InputError:
        if path == words[0]:  # an option that is a command of its own now
            refuse_former(words)
        raise
    try:
        return command(**values)
    except InputError as error:
        if (named := option_named(error, command, texts)) is error:
            raise
        raise named from error


def _resumed(words: Sequence[str]) -> str:
    """How the command of a line is resumed; "" where it starts anew."""
    paths = (" ".join(words[:count]) for count in (1, 2))
    return next((TREE[path].resumed for path in paths if path in TREE), "")


def _described(error: Exception) -> tuple[str, ...]:
    """An error in words, a line each fault."""
    return (
        tuple(map(_one_line, error.lines)) if isinstance(error, CamError) else (_describe(error),)
    )


def _describe(error: Exception) -> str:
    """Error in one line of text: file and reason of the system, or its kind and the hint at
    --debug.
    """
    if isinstance(error, BrokenPipeError):  # not of the output: see `output_streams`
        return "a process or pipe that was written to has ended"
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return _one_line(f"{place}{error.strerror or error}")
    kind = type(error).__name__
    return f"unexpected {kind}: {_one_line(str(error))} (--debug shows the traceback)"


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _version() -> None:
    import importlib.metadata

    show_text(f"camwright {importlib.metadata.version('camwright')}")


def _show_completion() -> None:
    from camwright.pipeline.commands.completion import bash_script

    show_text(bash_script())


def _install_completion() -> None:
    from camwright.pipeline.commands.completion import install

    show_text(
        f"completion of bash: {install()}, read by the next shell if bash-completion is installed"
    )


_ROOT = {
    "--version": _version,
    "--show-completion": _show_completion,
    "--install-completion": _install_completion,
}

if __name__ == "__main__":
    main()
