"""Command line of `camwright`: parses arguments, runs a command, returns its exit code.

Each command imports its heavy modules itself, so that ``--version`` is fast.
"""

from __future__ import annotations

import gc
import os
import signal
import sys
import time
import traceback
from typing import Annotated, Any, NoReturn

import typer
from typer.core import TyperGroup

from camwright.geometry.errors import AlteredError, CamError, ResultError
from camwright.pipeline.commands import (
    check_command,
    contact_command,
    crown_command,
    design_command,
    explain_command,
    inspect_command,
    redesign_command,
    run_command,
    signature_commands,
    size_command,
    smoother_command,
    study_command,
)
from camwright.pipeline.commands.output_streams import open_streams
from camwright.pipeline.commands.terminal import (
    ALTERED,
    ERROR,
    INTERRUPTED,
    PASSED,
    say,
    stdout,
    tell,
)

# Parallel by processes; one thread also fixes the order of sums. Set before numpy is imported.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")
# Pydantic would search all installed packages for plugins, and uses none here.
os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")


class _Commands(TyperGroup):
    """The commands; the parser would end with code 1, that of FAIL, after a broken pipe."""

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except BrokenPipeError as error:  # not of the output: see `output_streams`
            raise ResultError("a process or pipe that was written to has ended") from error


app = typer.Typer(
    name="camwright",
    cls=_Commands,
    help="Design a torque-balancing cam from the engine torque and check it.",
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)
for _command in (
    run_command.run,
    check_command.check,
    check_command.schema,
    signature_commands.keygen,
    signature_commands.sign,
    explain_command.explain,
    run_command.report,
    run_command.init,
    smoother_command.compare,
    size_command.size,
    crown_command.crown,
    design_command.design,
    redesign_command.redesign,
    study_command.study,
    contact_command.contact,
    inspect_command.inspect,
    contact_command.deck,
):
    app.command()(_command)

_SIGNAL = 128  # plus the number of a signal: the exit code after it
_END = (signal.SIGTERM, signal.SIGHUP)  # beside the keyboard interrupt
_ONCE_S = (
    2.0  # a terminal that closes sends its signal twice: the second does not stop the clean-up
)
_COLLECT_AFTER = 50_000  # new objects
_RESUMED_BY = {
    "run": "; run the command again with --resume to resume",
    "study": "; run the command again with --resume to resume",
    "redesign": "; run the command again to resume",
    "design": "; run the command again to resume",
}


def main() -> NoReturn:
    """Entry point: runs a command; an error prints a line per fault, exit code 2, altered run 4.

    A signal becomes one line and 128 + its number; one that is ignored at the start, as by
    ``nohup``, stays ignored.
    """
    open_streams()
    arguments = [argument for argument in sys.argv[1:] if argument != "--debug"]
    received: dict[int, float] = {}

    def interrupt(number: int, _: object) -> None:
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
        code = app(args=arguments, standalone_mode=False)
    except typer.Exit as leaving:
        code = leaving.exit_code
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except Exception as error:  # noqa: BLE001 - every error ends in a message and its exit code
        if "--debug" in sys.argv:
            tell(traceback.format_exc())
        *before, last = _described(error)
        for line in before:
            say(line)
        say("; ".join((last, *getattr(error, "__notes__", ()))))
        code = ALTERED if isinstance(error, AlteredError) else ERROR
    if code == INTERRUPTED:  # returned or raised by the parser
        say("interrupted" + _RESUMED_BY.get(arguments[0] if arguments else "", ""))
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
    sys.exit(code if isinstance(code, int) else PASSED)


def _described(error: Exception) -> tuple[str, ...]:
    """An error in words, a line each fault."""
    return (
        tuple(map(_one_line, error.lines)) if isinstance(error, CamError) else (_describe(error),)
    )


def _describe(error: Exception) -> str:
    usage = getattr(
        error, "format_message", None
    )  # of the parser, whose class has no stable module
    if usage is not None:
        return _one_line(f"{usage()} (--help shows the usage)")
    if isinstance(error, OSError):
        place = f"{error.filename}: " if error.filename else ""
        return _one_line(f"{place}{error.strerror or error}")
    kind = type(error).__name__
    return f"unexpected {kind}: {_one_line(str(error))} (--debug shows the traceback)"


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _version(wanted: bool) -> None:
    if wanted:
        import importlib.metadata

        stdout.print(f"camwright {importlib.metadata.version('camwright')}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _root(
    context: typer.Context,
    version: Annotated[  # noqa: ARG001 - evaluated by its callback
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version.")
    ] = False,
    debug: Annotated[  # noqa: ARG001 - evaluated by `main`
        bool, typer.Option("--debug", help="Show the traceback of an unexpected error.")
    ] = False,
) -> None:
    """Design a torque-balancing cam from the engine torque and check it."""
    if context.invoked_subcommand is None:
        stdout.print(context.get_help(), markup=False)


if __name__ == "__main__":
    main()
