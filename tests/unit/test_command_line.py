"""The command line as one tree: words, options, help, former names, completion, exit codes."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated, Any, NotRequired, TypedDict

import pytest
from command_lines import ran

from camwright import reports
from camwright.geometry.errors import InputError
from camwright.pipeline.case.renamed_keys import renamed_names
from camwright.pipeline.cli import run_line
from camwright.pipeline.commands import arguments, completion, terminal
from camwright.pipeline.commands.arguments import Words, arguments_of, read_arguments
from camwright.pipeline.commands.command_tree import GROUPS, TREE, split_path, tree_text

Run = Callable[..., tuple[int, str, str]]
ROOT = Path(__file__).parents[2]

DIFFER = {
    "--out": "what each command writes: a folder, a case, a deck",
    "--depth": "of a run; of the case files of a study, of which the file states its own",
    "--only": "checks of a verdict; parts of a report",
    "--kind": "source of a first case; profile of a crown",
    "--ratio": "axial pressure over that of plane strain; shaft turns per cam turn",
    "--tolerance": "zone of a measured cam; drop of a crown",
}
"""Options of one name that are not the same everywhere, and why."""


def test_the_whole_tree_is_one_screen(command: Run) -> None:
    code, out, _ = command("--help")
    assert code == 0 and out == command()[1]
    lines = out.rstrip("\n").split("\n")
    assert len(lines) <= 24 and max(map(len, lines)) <= 80
    for path in TREE:
        assert any(line.startswith(f"  {path} ") for line in lines), path
    words = " ".join(out.split())
    for number, meaning in terminal.EXIT_CODES.items():
        assert f"{number} {meaning}" in words


def test_the_first_words_are_ten() -> None:
    first = list(dict.fromkeys(path.split()[0] for path in TREE))
    assert first == [
        "new", "check", "run", "report", "explain", "inspect",
        "design", "contact", "study", "sign",
    ]  # fmt: skip
    assert GROUPS == ("design", "contact", "study", "sign")
    for group in GROUPS:
        assert ran([group]).stdout.rstrip("\n") == tree_text(group)


@pytest.mark.parametrize("path", TREE)
def test_every_help_has_purpose_options_and_an_example_that_is_read(path: str) -> None:
    text = ran([*path.split(), "--help"]).stdout.rstrip("\n")
    assert text.startswith(f"usage: camwright {path}")
    *parts, example = text.split("\n\n")
    assert len(parts) >= 3
    known = arguments_of(TREE[path].command)
    for each in known:
        assert re.search(rf"^  {re.escape(each.usage)}(  |$)", parts[-1], re.MULTILINE), each
        assert each.words.help.endswith("."), each.typed
    assert example.startswith(f"Example: camwright {path} ")
    words = shlex.split(example.removeprefix(f"Example: camwright {path} "))
    read_arguments(TREE[path].command, words)


def test_the_pages_print_commands_that_the_program_knows() -> None:
    """In sentences the words of a command; in quotes a whole line, which is read as typed."""
    folder = Path(reports.__file__).parent
    files = [file for kind in ("py", "js", "html") for file in folder.rglob(f"*.{kind}")]
    printed = "\n".join(file.read_text(encoding="utf-8") for file in files)
    named = re.findall(r"\bcamwright ([a-z]+(?: [a-z]+)?)", printed)
    assert named
    for words in named:
        split_path(words.split())
    lines = re.findall(r"\"camwright ([^\"]+)\"", printed)
    assert lines
    for line in lines:
        path, texts = split_path(line.split())
        read_arguments(TREE[path].command, texts)


def test_an_option_is_the_same_everywhere() -> None:
    found = defaultdict(set)
    for entry in TREE.values():
        for each in arguments_of(entry.command):
            if each.is_option:
                found[each.typed].add((each.words, each.kind, each.many, each.required))
    differing = {name for name, forms in found.items() if len(forms) > 1}
    assert differing == set(DIFFER)


@pytest.mark.parametrize(("former", "name"), renamed_names()["commands"].items())
def test_a_former_command_is_refused_with_the_line_to_type(
    former: str, name: str, command: Run
) -> None:
    first, *others = former.split()
    code, out, err = command(first, "a case.toml", *others, "--more", "3 mm")
    program = name if name.startswith("python") else f"camwright {name}"
    line = f"{program} 'a case.toml' --more '3 mm'"
    assert (code, out) == (2, "")
    assert err == f"camwright: {former} is now {name}: {line}\n"
    new = tuple(name.split())
    assert new[0] == "python" or new[0] in TREE or " ".join(new[:2]) in TREE


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["desing"], "camwright = desing, must be followed by one of: new, check, run"),
        (["desing"], "did you mean camwright design?"),
        (["design", "partz", "a.toml"], "did you mean camwright design parts?"),
        (["study", "a.toml"], "study is now study run: camwright study run a.toml"),
        (["run", "a.toml"], "--out = missing, must be stated: run folder to write"),
        (["run", "--out", "x"], "CASE = missing, must be stated: case file (TOML)"),
        (["run", "a.toml", "--outt", "x"], "--outt = unknown, must be an option"),
        (["run", "a.toml", "--outt", "x"], "did you mean --out?"),
        (["run", "a.toml", "--out"], "--out = missing, must be stated as --out DIR"),
        (["run", "a.toml", "--out", "--resume"], "--out = missing, must be stated as --out DIR"),
        (["run", "a.toml", "--out", "--"], "--out = missing, must be stated as --out DIR"),
        (["run", "a.toml", "--out=x", "-j", "4"], "-j = unknown, must be an option"),
        (["--version", "a"], "a = one argument too many, must be left out"),
        (["run", "a.toml", "--png=3"], "--png = 3, must be stated without a value"),
        (["run", "a.toml", "b.toml"], "b.toml = one argument too many, must be left out"),
        (["run", "a.toml", "--out", "x", "--jobs", "0"], "--jobs = 0, must be >= 1 and <= 256"),
        (["run", "a.toml", "--out", "x", "--jobs", "two"], "--jobs = two, must be a whole"),
        (["sign", "run", "a", "--key", "k"], "--role = missing, must be one of: prepared, "),
        (
            ["design", "machine", "a.csv", "--speed", "3 rpm", "--overspeed", "1rpm", "--out", "a"],
            "--overspeed = 1rpm, must be >= 3 rpm",
        ),
        (["design", "machine", "a.csv", "--out", "a"], "--speed = missing, must be stated: speed"),
    ],
)
def test_a_wrong_line_is_refused_by_its_own_words(words: Sequence[str], message: str) -> None:
    assert message in str(ran(words).exception)


@pytest.mark.parametrize(
    ("words", "asks"),
    [
        ("a.toml --out --help", True),
        ("-h", True),
        ("a.toml --out -h", False),
        ("a.toml --png -h", True),
        ("-- --help", False),
        ("a.toml --out=--help", False),
    ],
)
def test_help_is_asked_for_by_a_word_of_its_own(words: str, asks: bool) -> None:
    assert arguments.asks_for_help(TREE["run"].command, words.split()) is asks


class Loads(TypedDict):
    force: NotRequired[float | str]
    """Force."""


def pressed(
    files: Annotated[list[Path], Words("Files.", "FILE")],
    *,
    loads: Loads,
    count: Annotated[int | None, Words("Count.")] = None,
    keys: Annotated[list[str] | None, Words("Keys.", typed="--key")] = None,
    as_json: Annotated[bool, Words("JSON.", typed="--json")] = False,
) -> int:
    """A command of this test."""
    raise AssertionError


@pytest.mark.parametrize(
    ("line", "values"),
    [
        ("a b", {"files": [Path("a"), Path("b")], "loads": {}}),
        ("a --json b", {"files": [Path("a"), Path("b")], "loads": {}, "as_json": True}),
        ("a --force -3N", {"files": [Path("a")], "loads": {"force": "-3N"}}),
        ("a --force=--x=y", {"files": [Path("a")], "loads": {"force": "--x=y"}}),
        ("--key x --key y -- --a", {"files": [Path("--a")], "loads": {}, "keys": ["x", "y"]}),
        ("a --count 2 --count 3", {"files": [Path("a")], "loads": {}, "count": 3}),
    ],
)
def test_a_line_is_read(line: str, values: dict[str, Any]) -> None:
    assert read_arguments(pressed, line.split()) == values


def test_an_error_of_a_group_names_the_option_and_the_text() -> None:
    error = InputError("force", -3.0, "> 0 N")
    named = arguments.option_named(error, pressed, ["a", "--force", "-3 N"])
    assert str(named) == "--force = -3 N, must be > 0 N"
    other = InputError("spring.force", -3.0, "> 0 N")
    assert arguments.option_named(other, pressed, ["a"]) is other


def completed(*words: str) -> list[str]:
    """Words that bash offers for the last word of a line."""
    script = (
        f"{completion.bash_script()}\n"
        'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _camwright; echo "${COMPREPLY[@]}"'
    )
    done = subprocess.run(
        ["bash", "-c", script, "bash", "camwright", *words],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.stderr == ""
    return done.stdout.split()


def test_bash_completes_commands_options_and_their_words() -> None:
    assert completed("de") == ["design"]
    assert completed("")[:3] == ["new", "check", "run"]
    assert completed("design", "") == [path.split()[1] for path in TREE if "design" in path]
    assert completed("design", "parts", "a.toml", "--a") == ["--against"]
    assert completed("design", "parts", "a.toml", "--against", "") == ["size", "mass"]
    assert completed("run", "a.toml", "--depth", "c") == ["cycle", "certified"]
    assert completed("check", "a") == []  # bash offers files
    for path, entry in TREE.items():
        options = [each.typed for each in arguments_of(entry.command) if each.is_option]
        assert completed(*path.split(), "--") == [*options, "--help"]


def test_the_completion_is_installed_where_bash_looks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Run
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    script = tmp_path / "bash-completion" / "completions" / "camwright"
    assert command("--install-completion")[1].startswith(f"completion of bash: {script}")
    assert script.read_text(encoding="utf-8") == command("--show-completion")[1]


def test_help_imports_no_command() -> None:
    program = (
        "import sys; sys.argv = ['camwright', '--help']\n"
        "from camwright.pipeline import cli\n"
        "try: cli.main()\n"
        "except SystemExit: pass\n"
        "print([name for name in sys.modules if name.endswith('_command') or name == 'numpy'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, env=os.environ
    )
    assert done.stdout.splitlines()[-1] == "[]"


def test_an_interrupted_command_says_how_it_is_resumed(
    monkeypatch: pytest.MonkeyPatch, command: Run
) -> None:
    def interrupted(*_: object, **__: object) -> int:
        raise KeyboardInterrupt

    for path, resumed in (
        ("design parts", "; run the command again to resume"),
        ("design sizes", ""),
        ("study run", "; run the command again with --resume to resume"),
        ("study report", ""),
    ):
        entry = TREE[path]
        monkeypatch.setattr(sys.modules[entry.command.__module__], entry.home.split(":")[1],
                            interrupted)  # fmt: skip
        code, _, err = command(*path.split(), "a")
        assert (code, err) == (130, f"camwright: interrupted{resumed}\n"), path


def test_an_impossible_crown_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    from camwright.pipeline.search.crown import crown_design
    from camwright.pipeline.search.crown.least_crown import NoCrownError

    def impossible(*_: object, **__: object) -> None:
        raise NoCrownError("ratio", 1.01, ">= 1.2, the least of kind table: by no crown")

    monkeypatch.setattr(crown_design, "crown", impossible)
    case = str(ROOT / "cases" / "gx120.toml")
    assert run_line(["design", "crown", case, "--ratio", "1.01"]) == terminal.FAILED


def test_help_installs_nothing_and_what_is_not_ours_stays(
    command: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    script = tmp_path / "bash-completion" / "completions" / "camwright"
    assert command("--install-completion", "--help")[0] == 0
    assert not script.exists()
    script.parent.mkdir(parents=True)
    script.write_text("complete -W mine camwright\n")
    code, _, err = command("--install-completion")
    assert code == 2 and "exists already and is not of camwright" in err
    script.unlink()
    script.symlink_to(tmp_path / "elsewhere")
    assert command("--install-completion")[0] == 2
    assert not (tmp_path / "elsewhere").exists()
    script.unlink()
    for _ in range(2):  # its own file is written again
        assert command("--install-completion")[0] == 0
