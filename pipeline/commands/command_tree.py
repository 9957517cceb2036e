"""Commands of the program: words, purpose and home of each; the tree on one screen."""

from __future__ import annotations

import difflib
import shlex
import textwrap
from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import NamedTuple

from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.commands.arguments import WIDTH, Command
from camwright.pipeline.commands.terminal import EXIT_CODES

_AGAIN = "run the command again to resume"
_RESUME = "run the command again with --resume to resume"


class Entry(NamedTuple):
    """A command: usage and purpose in the tree, module and function, how it is resumed."""

    usage: str
    purpose: str
    home: str
    resumed: str = ""

    @property
    def command(self) -> Command:
        """The function, of which the module is imported here."""
        module, _, name = self.home.partition(":")
        command: Command = getattr(import_module(f"camwright.pipeline.commands.{module}"), name)
        return command


TREE: Mapping[str, Entry] = {
    "new": Entry("NAME", "write a first case that passes", "new_command:new"),
    "check": Entry("RUN|CASE...", "verdict of runs, preview of cases", "check_command:check"),
    "run": Entry("CASE --out DIR", "solve a case by finite elements", "run_command:run", _RESUME),
    "report": Entry("RUN", "page, PDF, hand-check sheets of a run", "report_command:report"),
    "explain": Entry("WORD...", "a key, check or record in words", "explain_command:explain"),
    "inspect": Entry("RUN CSV", "judge a measured cam against its run", "inspect_command:inspect"),
    "design machine": Entry(
        "CSV --speed N --out CASE",
        "a case with all parts for a torque",
        "machine_command:machine",
        _AGAIN,
    ),
    "design parts": Entry(
        "CASE", "search the catalogues: ripple, size", "parts_command:parts", _AGAIN
    ),
    "design sizes": Entry("CASE", "find sizes that a case leaves open", "sizes_command:sizes"),
    "design crown": Entry("CASE", "crown that keeps the axial pressure", "crown_command:crown"),
    "design smoother": Entry("CASE", "rank the smoothers of the lift", "smoother_command:smoother"),
    "design remedies": Entry(
        "RUN|CASE", "changes that cure failed checks", "check_command:remedies"
    ),
    "contact cylinders": Entry(
        "--r1 R ...", "line contact of two cylinders", "contact_command:cylinders"
    ),
    "contact deck": Entry("RUN --angle A", "CalculiX deck of a cam angle", "contact_command:deck"),
    "study run": Entry(
        "FILE --out DIR", "solve many designs into a dataset", "study_command:run", _RESUME
    ),
    "study report": Entry("DIR", "answers and page of a study", "study_command:report"),
    "sign key": Entry("FILE", "make a key to sign runs with", "signature_commands:key"),
    "sign run": Entry("RUN --key FILE", "sign the record of a run", "signature_commands:sign"),
}
"""Commands by their words, in the order of the tree."""
ROOT_OPTIONS = ("--help", "--version", "--debug", "--show-completion", "--install-completion")
GROUPS = tuple(dict.fromkeys(path.split()[0] for path in TREE if " " in path))
"""First words that need a second one."""
_WIDTH = 39  # of the usage of a command


def tree_text(group: str = "") -> str:
    """Text of the tree of all commands on a screen of 24 lines, or of the commands of one group, a
    first word.
    """
    lines = [
        f"  {f'{path} {entry.usage}':<{_WIDTH}} {entry.purpose}"
        for path, entry in TREE.items()
        if not group or path.split()[0] == group
    ]
    if group:
        return "\n".join([f"usage: camwright {group} COMMAND", "", *lines])
    codes = textwrap.wrap(
        "exit codes: " + "; ".join(f"{code} {words}" for code, words in EXIT_CODES.items()), WIDTH
    )
    return "\n".join((
        "camwright: from the torque of a machine to a balancing cam with a verdict", "", *lines, "",
        "COMMAND --help: options and an example; --version, --debug, --install-completion", *codes,
    ))  # fmt: skip


def split_path(words: Sequence[str]) -> tuple[str, Sequence[str]]:
    """Words of a command, joined, and the words of the command line that follow.

    Parameters
    ----------
    words : sequence   of the command line, at least one; two after the name of a group

    Raises
    ------
    InputError
        If there is no such command, with the line to type where it has another name now.
    """
    for count in (1, 2):
        if (path := " ".join(words[:count])) in TREE:
            return path, words[count:]
    before, word, position = "camwright", words[0], 0
    if words[0] in GROUPS:
        before, word, position = f"camwright {words[0]}", words[1], 1
    followers = list(dict.fromkeys(
        path.split()[position] for path in TREE if not position or path.startswith(f"{words[0]} ")
    ))  # fmt: skip
    alike = difflib.get_close_matches(word, followers, n=1)
    if not (position and alike):  # `design partz` is a slip, `design torque.csv` a former line
        refuse_former(words)
    meant = f"; did you mean {before} {alike[0]}?" if alike else ""
    raise InputError(before, word, f"followed by one of: {', '.join(followers)}{meant}")


class RenamedError(CamError):
    """A command under its former name: the message ends with the line to type."""


def refuse_former(words: Sequence[str]) -> None:
    """Refuse a former name of a command, by the table ``[commands]`` of ``renamed.toml``; nothing
    happens for any other name.

    Parameters
    ----------
    words : sequence   of the command line

    Raises
    ------
    RenamedError
        With the line to type.
    """
    from camwright.pipeline.case.renamed_keys import renamed_names

    for former, name in renamed_names()["commands"].items():
        first, *others = former.split()
        if words[0] == first and set(others) <= set(words):
            left = shlex.join(word for word in words[1:] if word not in others)
            program = "" if str(name).startswith("python") else "camwright "
            raise RenamedError(f"{former} is now {name}: {program}{name} {left}".rstrip())
