"""README and docs/: every command and snippet is executed, every table is that of the program."""

from __future__ import annotations

import importlib.util
import os
import re
import shutil
import subprocess
import sys
import tomllib
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest
from small_machine import small_machine
from trap_folder import Traps

from camwright.pipeline.case.case_file import case_of, read_case
from camwright.pipeline.case.renamed_keys import with_new_keys
from camwright.pipeline.commands.command_tree import TREE
from camwright.pipeline.studies.batch.factor_axes import axis_of
from camwright.pipeline.studies.batch.sampling import designs_of
from camwright.pipeline.studies.batch.study_file import study_of

ROOT = Path(__file__).resolve().parents[2]
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("**/*.md")))
    if path.parent != ROOT / "docs" / "site"
}
SECONDS = 540.0
STUDIES = "docs/studies.md"
QUESTIONS = "docs/questions.md"
"""Whole cases with their commands: run by `test_questions`."""
GUIDE = "README.md", "docs/tutorial.md", "docs/tutorials/sign.md"
"""Pages whose commands run one after the other in one folder, small."""
ALONE = tuple(page for page in PAGES if page.startswith("docs/tutorials/"))
"""Pages that `test_tutorials` runs, each in a folder of its own."""
WITH_THEIR_COMMANDS = "docs/tutorials/size.md", "docs/tutorials/study.md"
"""Of these, pages whose snippets read what their commands write."""


def blocks(page: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", PAGES[page], re.MULTILINE | re.DOTALL)


def commands(page: str, word: str) -> list[str]:
    lines = [line for block in blocks(page, "bash") for line in block.splitlines()]
    assert all(line.split()[0] in ("make", "camwright", "export") for line in lines)
    return [line for line in lines if line.startswith(word)]


def shell(command: str, folder: Path) -> subprocess.CompletedProcess[str]:
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env={**os.environ, "PATH": path, "XDG_CONFIG_HOME": str(folder / "config")},
        capture_output=True,
        text=True,
        check=False,
        timeout=SECONDS,
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder in which the commands of `GUIDE` have run in their order, once each.

    Beside them lies a file with the name of each library, and beside the cases, too: none is
    imported. The snippets of Python come later, since a script imports from its own folder.
    """
    folder = tmp_path_factory.mktemp("docs")
    for name in ("cases", "studies"):
        shutil.copytree(ROOT / name, folder / name)
    made_small(folder)
    marks = tmp_path_factory.mktemp("marks")
    traps = [Traps.set_in(place, marks) for place in (folder, folder / "cases")]
    lines = [line for page in GUIDE for line in commands(page, "camwright")]
    for line in dict.fromkeys(lines):
        result = shell(line, folder)
        allowed = (0, 1, 3) if line.startswith("camwright check") else (0,)
        assert traps[0].sprung() == [], line
        assert result.returncode in allowed, f"{line}: {result.stderr}"
        if line.startswith("camwright new"):
            made_small(folder)
    for each in traps:
        each.remove()
    return folder


def made_small(folder: Path) -> None:
    """Cases of 36 positions, one trial, one starting point of the synthesis, no random tolerances.

    They are certified at one angle, their ends by half-spaces. All this has tests of its own.
    """
    solver = {"positions": 36, "max_trials": 1, "certificate_positions": 1, "end_elements": 0}
    small = {
        "[solver]": solver,
        "[tolerances]": {"samples": 0},
        'kind = "constrained"': {"starts": 1},
    }
    for path in (*folder.glob("*.toml"), folder / "cases" / "gx120.toml"):
        text = path.read_text(encoding="utf-8")
        for above, keys in small.items():
            for key in keys:
                text = re.sub(rf"(?m)^{key} = .*\n", "", text)
            added = "".join(f"{key} = {value}\n" for key, value in keys.items())
            text, count = re.subn(rf"(?m)^{re.escape(above)}.*\n", rf"\g<0>{added}", text)
            assert count == 1 or (above.startswith("kind") and not count), (path, above)
        path.write_text(text, encoding="utf-8")


def test_commands_of_other_pages_are_run_elsewhere() -> None:
    for page in PAGES:
        if page not in (*GUIDE, *ALONE, QUESTIONS):
            assert commands(page, "camwright") == [], page


def test_the_run_folder_holds_what_is_listed(folder: Path) -> None:
    listed = re.findall(r"^\| `([^`]+)` \|", PAGES["docs/run-folder.md"].split("\n## ")[0], re.M)
    assert len(listed) >= 24
    some_cases_only = {
        "trial_2/",
        "1_speed.csv",
        "corners.json",
        "trial_1/2_limits.csv",
        "trial_1/5_pivot.npz",
        "workshop/crown_cam.csv",
        "figures/",
        "fields/ends.vtu",
    }
    for name in listed:
        assert (folder / "runs" / "demo" / name).exists() or name in some_cases_only, name


@pytest.mark.parametrize(
    "page", [page for page in PAGES if blocks(page, "python") and page not in WITH_THEIR_COMMANDS]
)
def test_python_snippets_run_in_their_order(page: str, folder: Path) -> None:
    snippet = "\n".join(blocks(page, "python"))
    result = subprocess.run(
        [sys.executable, "-c", snippet], cwd=folder, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.strip()


def test_make_targets_exist() -> None:
    targets = {line.split()[1] for page in PAGES for line in commands(page, "make")}
    assert {"run", "test"} <= targets
    for target in sorted(targets | {"lint", "verify", "bench"}):
        result = shell(f"make --dry-run {target}", ROOT)
        assert result.returncode == 0, f"{target}: {result.stderr}"


def test_readme_lists_every_command() -> None:
    listed = re.findall(r"^\| `camwright ([a-z ]+)", PAGES["README.md"], re.M)
    assert [each.strip() for each in listed] == list(TREE)


@pytest.mark.parametrize(
    ("page", "block"),
    [
        (page, block)
        for page in PAGES
        if page not in (STUDIES, QUESTIONS, "docs/tutorials/lift.md", "docs/tutorials/study.md")
        for block in blocks(page, "toml")
    ],
)
def test_toml_snippets_fit_into_a_case(page: str, block: str) -> None:
    given = tomllib.loads(block)
    case = tomllib.loads(small_machine("demo")) | given
    if "lift" in given:
        del case["engine"]
    if given.get("follower", {}).get("kind") == "flat":
        del case["roller"]
    assert with_new_keys(case) == case  # present names: case_of reads those of version 0.1 too
    assert case_of(case)


def test_the_study_of_the_page_is_a_study() -> None:
    (block,) = blocks(STUDIES, "toml")
    study = study_of(tomllib.loads(block) | {"case": ["gx120.toml"]})
    case = read_case(ROOT / "cases" / "gx120.toml")
    axes = [axis_of(factor, case) for factor in study.factors]
    assert study.sampling is not None
    assert designs_of(axes, study.sampling, study.correlations).count == 500


def test_error_lines_are_the_real_ones(tmp_path: Path) -> None:
    (example,) = blocks("docs/case-file.md", "text")
    changes = (('rate = "24.2 kN/m"', 'rate = "-24.2 kN/m"'), ('radius = "16 mm"', 'radus = "1"'))
    for (old, new), line in zip(changes, example.splitlines(), strict=True):
        text = small_machine("demo").replace(old, new)
        (tmp_path / "bad.toml").write_text(text, encoding="utf-8")
        result = shell("camwright run bad.toml --out run", tmp_path)
        assert (result.returncode, result.stderr.rstrip()) == (2, line)
        assert not (tmp_path / "run").exists()


@cache
def tables() -> ModuleType:
    spec = importlib.util.spec_from_file_location(
        "tables", ROOT / "scripts" / "reference_tables.py"
    )
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("page", [page for page in PAGES if "<!-- table: " in PAGES[page]])
def test_tables_are_those_of_the_program(page: str) -> None:
    assert tables().filled(PAGES[page]) == PAGES[page], (
        "run: .venv/bin/python scripts/reference_tables.py"
    )


def anchors(text: str) -> set[str]:
    titles = re.findall(r"^#+ (.+)$", text, re.M)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page: str) -> None:
    for target in re.findall(r"\]\(([^)\s]+)\)", PAGES[page]):
        if target.startswith("http"):
            continue
        name, _, anchor = target.partition("#")
        file = (ROOT / page).parent / name if name else ROOT / page
        assert file.exists(), target
        assert not anchor or anchor in anchors(file.read_text(encoding="utf-8")), target


def test_readme_and_changelog_are_short() -> None:
    assert PAGES["README.md"].count("\n") <= 120
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    newest = re.split(r"^## ", changes, flags=re.M)[1]
    assert newest.count("\n") <= 40


def test_public_names_are_sixteen_and_documented() -> None:
    import camwright

    assert len(camwright.__all__) == 16
    for name in camwright.__all__:
        assert f"`{name}`" in (camwright.__doc__ or "")
        assert len((getattr(camwright, name).__doc__ or "").split()) >= 8, name
    with pytest.raises(AttributeError):
        camwright.run  # noqa: B018
