"""The command line: one line for every error, the promised exit codes."""

from __future__ import annotations

import errno
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any, Self

import numpy as np
import pytest
from small_machine import small_machine
from small_run import check, small_case, summary, write_run, write_trial

from camwright.geometry.errors import ContactError, ResultError
from camwright.meshes.body_mesh import roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base.worker_processes import ALONE
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.contact_store import kept_piece
from camwright.pipeline.results.run_folder import RunFolder
from camwright.reports import sections

Command = Callable[..., tuple[int, str, str]]

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def runner(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[..., Any]], None]:
    """Puts a stand-in in the place of the run itself and its pages."""

    def install(run: Callable[..., Any]) -> None:
        module = ModuleType("camwright.pipeline.run")
        module.CaseRun = run  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, "camwright.pipeline.run", module)

    monkeypatch.setattr(sections.Ahead, "begin", lambda *_: None)
    monkeypatch.setattr(sections.Ahead, "write", _page)
    return install


def _page(_: Any, folder: Path) -> None:
    (folder / "8_report.html").write_text("")


@pytest.fixture
def case_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "small.toml"
    file.write_text(small_machine("small"), encoding="utf-8")
    return file


class ShortRun:
    """A run whose cam fails a check, without a solution."""

    workers = ALONE

    def __init__(
        self,
        case: Any,
        out: Path,
        *,
        jobs: int | None,
        resume: bool,
        replace: bool,
        fields: str,
        progress: Any,
        began: float,
        depth: Tier,
    ) -> None:
        self.case, self.out, self._progress = case, out, progress
        self._folder = RunFolder(out, case, depth=depth, resume=resume, replace=replace)
        self.steps: list[str] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: Any) -> None:
        self._folder.__exit__(*raised)

    def solve(self) -> None:
        self.steps.append("solve")
        self._progress.stage("cycle")
        self._progress.advance(1, 2)

    def write(self) -> None:
        self.steps.append("write")
        checks = [check("fail"), check("not_evaluated", id="x", must_have=False)]
        write_trial(self._folder, checks)

    def certify(self) -> None:
        self.steps.append("certify")

    def draft(self) -> Path:
        self.steps.append("draft")
        return self._folder.path

    def finish(self) -> None:
        self.steps.append("finish")
        self._folder.finish(summary("fail"))


def solving(work: Callable[[RunFolder], object]) -> type[ShortRun]:
    """A run that does something else where it solves."""

    class Run(ShortRun):
        def solve(self) -> None:
            work(self._folder)
            super().solve()

    return Run


def is_one_line(text: str) -> bool:
    return text.startswith("camwright: ") and text.count("\n") == 1


def test_run_completes_with_0_whatever_the_verdict(
    case_file: Path, command: Command, runner: Any
) -> None:
    runner(ShortRun)
    code, out, err = command("run", case_file, "--out", "runs/small", "--jobs", 2)
    assert code == 0
    assert out.startswith("verdict: FAIL: 1 check beyond its limit\n  1. Pressure angle: 3 deg, ")
    assert "limit <= 2 deg (150 %), idle 12.5 deg\n" in out
    page = "page: runs/small/8_report.html, analysis sheet: #sheet in it; 1 trial; "
    assert re.search(re.escape(page) + r"\d+\.\d s\n$", out)
    assert err == "cycle\n"


def test_positions_reach_the_case(case_file: Path, command: Command, runner: Any) -> None:
    seen: list[int] = []
    runner(solving(lambda folder: seen.append(folder.case.solver.positions)))
    assert command("run", case_file, "--out", "run", "--positions", 48)[0] == 0
    assert seen == [48]


@pytest.mark.parametrize(
    ("options", "steps"),
    [
        ((), "solve write draft certify draft finish"),
        (("--no-report",), "solve write certify finish"),
        (("--depth", "cycle"), "solve write certify draft finish"),
    ],
)
def test_drawings_begin_before_the_certificate(
    case_file: Path, command: Command, runner: Any, options: tuple[str, ...], steps: str
) -> None:
    made: list[ShortRun] = []

    def kept(*arguments: Any, **stated: Any) -> ShortRun:
        made.append(ShortRun(*arguments, **stated))
        return made[-1]

    runner(kept)
    assert command("run", case_file, "--out", "run", *options)[0] == 0
    assert " ".join(made[0].steps) == steps


def test_resume_of_a_finished_run_solves_nothing(
    case_file: Path, command: Command, runner: Any
) -> None:
    runner(ShortRun)
    first = command("run", case_file, "--out", "run")
    runner(lambda *_, **__: pytest.fail("solved again"))
    again = command("run", case_file, "--out", "run", "--resume")
    texts = [re.sub(r"; [0-9.]+ s$", "", text, flags=re.M) for _, text, *_ in (first, again)]
    assert (again[0], texts[1]) == (first[0], texts[0])
    assert texts[0] != first[1]  # the wall time, which alone differs


def test_replace_takes_an_earlier_version_of_the_case_only(
    case_file: Path, command: Command, runner: Any
) -> None:
    runner(ShortRun)
    assert command("run", case_file, "--out", "run")[0] == 0
    case_file.write_text(case_file.read_text().replace('"400 N"', '"401 N"'))
    code, _, err = command("run", case_file, "--out", "run")
    assert code == 2
    assert "holds the run of another input" in err.splitlines()[-1]
    assert command("run", case_file, "--out", "run", "--replace")[0] == 0
    case_file.write_text(case_file.read_text().replace('name = "small"', 'name = "big"'))
    assert command("run", case_file, "--out", "run", "--replace")[0] == 2


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "--out = missing"),
        (("--out", "run", "--positions", "3"), "solver.positions = 3, must be >= 36"),
        (("--out", "run", "--positions", "x"), "--positions"),
        (("--out", "run", "--jobs", "0"), "--jobs = 0, must be >= 1 and <= 256"),
        (("--out", "run", "--fields", "some"), "one of none, worst, default, all"),
        (("--out", "run", "--speed", "1"), "--speed"),
    ],
)
def test_bad_arguments(
    case_file: Path, command: Command, arguments: tuple[str, ...], message: str
) -> None:
    code, out, err = command("run", case_file, *arguments)
    assert (code, out) == (2, "")
    assert message in err
    assert is_one_line(err)
    assert not Path("run").exists()


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (ContactError("no convergence at\n12 deg"), "no convergence at 12 deg"),
        (OSError(errno.ENOSPC, "No space left on device", "a.vtu"), "a.vtu: No space left"),
        (ZeroDivisionError("x"), "unexpected ZeroDivisionError: x (--debug shows the traceback)"),
        (MemoryError(), "unexpected MemoryError"),
        (BrokenPipeError(errno.EPIPE, "Broken pipe"), "a process or pipe that was written to"),
    ],
)
def test_errors_of_the_run(
    case_file: Path, command: Command, runner: Any, error: Exception, message: str
) -> None:
    def fails(_: RunFolder) -> None:
        raise error

    runner(solving(fails))
    code, out, err = command("run", case_file, "--out", "runs/small")
    assert (code, out) == (2, "")
    assert message in err
    assert is_one_line(err)
    assert sorted(entry.name for entry in case_file.parent.iterdir()) == ["small.toml"]


def test_a_full_disk_says_that_the_run_can_be_resumed(
    case_file: Path, command: Command, runner: Any
) -> None:
    def fails(folder: RunFolder) -> None:
        kept_piece(folder.contact_store(1), "idle", 0, "a", lambda: {"p0": np.array([1.0])})
        raise ResultError(f"{folder.out.name}: No space left on device")

    runner(solving(fails))
    code, _, err = command("run", case_file, "--out", "run")
    assert code == 2
    assert is_one_line(err)
    assert "run: No space left on device; solved points are kept; run the command again" in err
    assert Path(".run.partial").is_dir()


def test_debug_shows_where(case_file: Path, command: Command, runner: Any) -> None:
    def fails(_: RunFolder) -> None:
        raise ZeroDivisionError

    runner(solving(fails))
    code, _, err = command("run", case_file, "--out", "run", "--debug")
    assert code == 2
    assert "Traceback" in err and "in fails" in err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_says_how_to_go_on(
    case_file: Path, command: Command, runner: Any, number: signal.Signals
) -> None:
    """After a mesh, too: gmsh would leave the process to end at once, without a word."""

    def stopped(folder: RunFolder) -> None:
        roller_mesh(0.008, 0.003, 0.0, ElementSize(far_size=2e-3))
        kept_piece(folder.contact_store(1), "idle", 0, "a", lambda: {"p0": np.array([1.0])})
        os.kill(os.getpid(), number)

    runner(solving(stopped))
    code, _, err = command("run", case_file, "--out", "run")
    assert code == 128 + number
    assert is_one_line(err)
    assert "--resume" in err
    assert Path(".run.partial").is_dir()
    assert not Path("run").exists()


def test_a_signal_while_a_dataclass_is_made_has_the_same_code(tmp_path: Path) -> None:
    """Python runs text by `exec` then, and would end `python -m` by SIGINT."""
    (tmp_path / "stopped.py").write_text(
        "import sys\n"
        "from camwright.pipeline import cli\n"
        "def invoke(*_):\n"
        "    exec('import os, signal; os.kill(os.getpid(), signal.SIGTERM)')\n"
        "cli.run_line = invoke\n"
        "sys.argv = ['camwright', 'explain', 'spring']\n"
        "cli.main()\n"
    )
    ended = subprocess.run(
        [sys.executable, "-m", "stopped"], cwd=tmp_path, stderr=subprocess.DEVNULL, check=False
    )
    assert ended.returncode == 128 + signal.SIGTERM


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_that_is_ignored_at_the_start_stays_ignored(
    case_file: Path, command: Command, runner: Any, number: signal.Signals
) -> None:
    """As SIGHUP is by `nohup`."""

    runner(solving(lambda _: os.kill(os.getpid(), number)))
    before = signal.signal(number, signal.SIG_IGN)
    try:
        assert command("run", case_file, "--out", "run")[0] == 0
    finally:
        signal.signal(number, before)


def test_a_signal_that_comes_twice_does_not_stop_the_clean_up(
    case_file: Path, command: Command, runner: Any
) -> None:
    """A terminal that closes signals its processes, and its shell does once more."""

    def stopped(_: RunFolder) -> None:
        try:
            os.kill(os.getpid(), signal.SIGHUP)
        finally:
            os.kill(os.getpid(), signal.SIGHUP)
            Path("cleaned").touch()

    runner(solving(stopped))
    assert command("run", case_file, "--out", "run")[0] == 128 + signal.SIGHUP
    assert Path("cleaned").exists()


@pytest.mark.parametrize(
    ("status", "code"), [("pass", 0), ("waived", 0), ("fail", 1), ("not_evaluated", 3)]
)
def test_check_judges_from_the_folder_alone(
    tmp_path: Path, command: Command, status: str, code: int
) -> None:
    out = write_run(tmp_path / "run", status=status)
    assert command("check", out)[0] == code
    found, text, err = command("check", out, "--json")
    document = json.loads(text)
    assert (found, err) == (code, "")
    assert document["verdict"] == {0: "pass", 1: "fail", 3: "incomplete"}[code]
    assert document["verdict_line"].startswith(document["verdict"].upper())
    assert document["checks"][0]["status"] == status
    assert document["input_sha256"] == small_case().sha256


def test_check_of_what_is_no_run(tmp_path: Path, command: Command) -> None:
    out = write_run(tmp_path / "run")
    (out / "trial_1" / "5_cycle.csv").write_text("load_case\n")
    for folder, expected in ((tmp_path / "none", 2), (tmp_path, 2), (out, 4)):
        code, text, err = command("check", folder, "--json")
        assert (code, text) == (expected, "")
        assert is_one_line(err)


def test_init_writes_case_and_data_and_names_the_next_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command
) -> None:
    monkeypatch.chdir(tmp_path)
    for kind, files in (
        ("cylinder", ["first.toml"]),
        ("lift", ["first.toml"]),
        ("speed", ["first.toml", "first_tooth_times.csv"]),
    ):
        for file in tmp_path.iterdir():
            file.unlink()
        code, text, _ = command("new", "first.toml", "--kind", kind)
        assert code == 0
        assert sorted(file.name for file in tmp_path.iterdir()) == files
        wrote, after = text.splitlines()
        assert all(file in wrote for file in files)
        assert after == "next: camwright run first.toml --out runs/first"
        assert read_case(tmp_path / "first.toml").name == "first"


@pytest.mark.parametrize("file", ["first.toml", "first_torque.csv"])
def test_init_does_not_overwrite(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / file).write_text("as it was")
    code, _, err = command("new", "first", "--kind", "table")
    assert code == 2
    assert is_one_line(err) and file in err
    assert [each.name for each in tmp_path.iterdir()] == [file]
    assert (tmp_path / file).read_text() == "as it was"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("../other",), "name = ../other, must be 1 to 40 letters"),
        (("first", "--kind", "guess"), "--kind = guess, must be one of: cylinder, table"),
    ],
)
def test_new_refuses(
    arguments: tuple[str, ...], message: str,
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: Command,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    code, _, err = command("new", *arguments)
    assert code == 2
    assert is_one_line(err) and message in err
    assert not [*tmp_path.iterdir(), *tmp_path.parent.glob("other*")]


def test_bad_case_file_is_one_line(case_file: Path, command: Command) -> None:
    case_file.write_text(case_file.read_text().replace('"24.2 kN/m"', '"-24.2 kN/m"'))
    code, _, err = command("run", case_file, "--out", "run")
    assert code == 2
    assert err == "camwright: spring.rate = -24.2 kN/m, must be > 0 and <= 1e+06 kN/m\n"


def test_help_and_version(command: Command) -> None:
    code, out, _ = command()
    assert code == 0
    assert "run" in out
    assert command("--version")[1].startswith("camwright ")
    assert command("nonsense")[0] == 2


def last_line_of(script: str) -> str:
    """Last line that a script prints in a process of its own."""
    ended = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, env=os.environ
    )
    return ended.stdout.splitlines()[-1]


def test_version_answers_without_the_heavy_libraries() -> None:
    script = (
        "import sys; sys.argv = ['camwright', '--version']\n"
        "from camwright.pipeline import cli\n"
        "try: cli.main()\n"
        "except SystemExit: pass\n"
        "print(sorted({'numpy', 'pydantic', 'gmsh', 'pyvista'} & set(sys.modules)))"
    )
    assert last_line_of(script) == "[]"


def test_a_case_is_read_without_the_heavy_libraries() -> None:
    """Modules of the command line and of the preview, and the units of a case file."""
    script = (
        "import sys\n"
        "from camwright.pipeline import cli, preview\n"
        "from camwright.pipeline.case.case_file import read_case\n"
        f"read_case({str(ROOT / 'cases' / 'gx120.toml')!r})\n"
        "heavy = {'dask', 'gmsh', 'h5py', 'matplotlib', 'meshio', 'pandas', 'pyvista'}\n"
        "heavy |= {'scipy.' + name for name in ('interpolate', 'linalg', 'optimize', 'sparse')}\n"
        "heavy.add('skfem')\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    assert last_line_of(script) == "[]"


def test_rows_and_study_page_are_written_without_pandas_and_matplotlib() -> None:
    """Each worker of a study and its main process would import them for half a second."""
    script = (
        "import sys\n"
        "from camwright.reports.study import study_page\n"
        "from camwright.pipeline.studies.batch import dataset\n"
        "rows = {'id': ['a', 'b'], 'depth': ['preview'] * 2, 'message': [None, 'm'],\n"
        "        'jump.demand': [1.0, None]}\n"
        "table = dataset.table_from(dataset.parquet_bytes(dataset.table_of(rows, {})))\n"
        "clock = dataset.parquet_bytes(dataset.timings_of(rows, [0.5, 0.1]))\n"
        "assert dataset.values_of(dataset.table_from(clock)['wall_s']).tolist() == [0.5, 0.1]\n"
        "assert dataset.values_of(table['jump.demand'])[0] == 1.0\n"
        "print(sorted({'matplotlib', 'pandas', 'scipy.stats'} & set(sys.modules)))"
    )
    assert last_line_of(script) == "[]"


@pytest.mark.parametrize(
    ("open_checks", "code"), [([[], []], 0), ([["shaft"], []], 3), ([["shaft"], ["shaft"]], 3)]
)
def test_redesign_exits_by_its_points(
    case_file: Path,
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
    open_checks: list[list[str]],
    code: int,
) -> None:
    from camwright.pipeline.search.parts import redesign_study
    from camwright.reports.comparisons import redesign_page

    points = [{"file": "point.toml", "verdict": "pass", "open": one} for one in open_checks]
    document: dict[str, Any] = {"points": points, "tried": [], "pruned": []}
    document |= {"without_result": None, "as_given": ["x as given"]}
    monkeypatch.setattr(redesign_study, "redesign", lambda *_: document)
    monkeypatch.setattr(redesign_page, "write", lambda *_: Path("page.html"))
    found, out, _ = command("design", "parts", case_file)
    assert found == code
    assert ("missing data of these points: shaft" in out) == (code == 3)
    assert "x as given" in out
    document |= {"points": [], "without_result": {"lines": ["excluded most by cam_radius"]}}
    code, out, _ = command("design", "parts", case_file)
    assert code == 1
    assert "excluded most by cam_radius" in out


def test_command_names_every_choice_of_cam_angles() -> None:
    from camwright.pipeline.commands.run_command import FIELDS
    from camwright.pipeline.results.field_output import Shown

    assert tuple(Shown) == FIELDS
