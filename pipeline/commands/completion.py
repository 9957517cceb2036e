"""Completion of the command line by bash: commands, options and words of options."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.commands.arguments import Argument, arguments_of
from camwright.pipeline.commands.command_tree import GROUPS, ROOT_OPTIONS, TREE

_SCRIPT = """\
# Completion of camwright by bash; made by camwright --show-completion.
_camwright() {
    local current="${COMP_WORDS[COMP_CWORD]}" before="${COMP_WORDS[COMP_CWORD - 1]}" words=""
    case "${COMP_WORDS[*]:1:COMP_CWORD - 1} " in
        " ") words="@FIRST@" ;;
@CASES@
    esac
    COMPREPLY=()
    [[ -n "$words" ]] && COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -F _camwright camwright
"""
"""Without words the shell offers files."""


def bash_script() -> str:
    """The script that bash reads."""
    first = dict.fromkeys(path.split()[0] for path in TREE)
    cases = []
    for path, entry in TREE.items():
        options = [each for each in arguments_of(entry.command) if each.is_option]
        cases.append(f'        "{path} "*) {_words_of(options)} ;;')
    for group in GROUPS:
        seconds = [path.split()[1] for path in TREE if path.startswith(f"{group} ")]
        cases.append(f'        "{group} ") words="{" ".join(seconds)}" ;;')
    text = _SCRIPT.replace("@FIRST@", " ".join((*first, *ROOT_OPTIONS)))
    return text.replace("@CASES@", "\n".join(cases)).rstrip("\n")


def _words_of(options: Sequence[Argument]) -> str:
    """Shell text that sets the words after a command: the choices of the option before, else the
    options once a - is typed.
    """
    cases = [
        f'{each.typed}) words="{" ".join(each.words.choices)}" ;;'
        for each in options
        if each.words.choices
    ]
    names = " ".join((*(each.typed for each in options), "--help"))
    cases.append(f'*) [[ "$current" == -* ]] && words="{names}" ;;')
    return f'case "$before" in {" ".join(cases)} esac'


def install() -> Path:
    """Write the script where bash looks for it, and return its path.

    Raises
    ------
    ResultError
        If something else is there already: it is not replaced.
    """
    home = os.environ.get("XDG_DATA_HOME") or Path.home() / ".local" / "share"
    path = Path(home) / "bash-completion" / "completions" / "camwright"
    if path.is_symlink() or (path.exists() and not _is_ours(path)):
        raise ResultError(f"{path}: exists already and is not of camwright, not overwritten")
    return write_atomic(path, bash_script() + "\n")


def _is_ours(path: Path) -> bool:
    """Whether a file was written by `install`, of this version or another."""
    mark = _SCRIPT.splitlines()[0].encode()
    with path.open("rb") as file:
        return file.read(len(mark)) == mark
