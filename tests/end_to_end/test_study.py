"""`camwright study run`: the same bytes by any processes, after kills, on a running cluster."""

from __future__ import annotations

import contextlib
import json
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Self

import numpy as np
import psutil
import pytest
from record_validation import schema_errors

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.files import file_hashes
from camwright.pipeline.cli import run_line
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results.run_reader import read_run, read_verdict
from camwright.pipeline.studies.batch import study_run
from camwright.pipeline.studies.batch.answers import answered
from camwright.pipeline.studies.batch.answers_yield import Yield
from camwright.pipeline.studies.batch.case_template import read_templates
from camwright.pipeline.studies.batch.dataset import read_dataset, table_from
from camwright.pipeline.studies.batch.design_plan import SHARD_OF, study_versions
from camwright.pipeline.studies.batch.design_rows import CLOCK, encoded
from camwright.pipeline.studies.batch.design_solver import DesignSolver
from camwright.pipeline.studies.batch.design_task import Settings, Task, Wanted
from camwright.pipeline.studies.batch.study_file import read_study
from camwright.pipeline.studies.batch.task_scheduler import TaskScheduler

ROOT = Path(__file__).resolve().parents[2]
SECONDS = 300.0
STUDY = """
name = "eccentric"
case = "eccentric.toml"
depth = "preview"
positions = 36
corners = false
{more}
[[factor]]
key = "spring.preload"
range = {{ low = "40 N", high = "60 N" }}
[sampling]
method = "random"
count = {count}
"""


def command(*arguments: str) -> list[str]:
    return [sys.executable, "-m", "camwright", "study", "run", *arguments]


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        command(*arguments), cwd=folder, capture_output=True, text=True, check=False,
        timeout=SECONDS,
    )  # fmt: skip


def contents(folder: Path) -> dict[str, str]:
    """Hashes of all files but the clock figures."""
    return file_hashes(folder, lambda name: not name.startswith("timings/"))


def written(folder: Path, count: int, more: str = "", name: str = "study.toml") -> Path:
    text = (ROOT / "cases" / "papers" / "eccentric.toml").read_text()
    limits = "[limits]\ncurvature_ratio = 1.5\n"  # the published cam has 1.68
    (folder / "eccentric.toml").write_text(f"{text}\n{limits}")
    (folder / name).write_text(STUDY.format(count=count, more=more))
    return folder / name


def processes_of(parent: psutil.Process) -> list[psutil.Process]:
    """Processes that solve the designs of a study."""
    try:
        return [
            each
            for each in parent.children(recursive=True)
            if "solver_process" in " ".join(each.cmdline())
        ]
    except psutil.Error:
        return []


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of eleven shards, solved in one process into ``one``."""
    folder = tmp_path_factory.mktemp("study")
    written(folder, 21)
    made = run(folder, "study.toml", "--out", "one", "--jobs", "1")
    assert made.returncode == 0, made.stderr
    assert "21 designs" in made.stdout and "screen: fail 6, open 15" in made.stdout
    return folder


def test_the_dataset_has_a_row_for_each_design(folder: Path) -> None:
    data = read_dataset(folder / "one")
    assert len(data) == 21 == len(set(data["id"]))
    assert data.units["factor.spring.preload"] == "N"
    assert data["factor.spring.preload"].min() >= 40.0
    assert data["message"].tolist() == [""] * 21
    assert len(list((folder / "one" / "shards").iterdir())) == 11
    assert len(list((folder / "one" / "timings").iterdir())) == 11
    record = json.loads((folder / "one" / "study.json").read_text(encoding="utf-8"))
    assert schema_errors("study", record) == []


def test_killed_damaged_and_resumed_it_is_the_same(folder: Path) -> None:
    """SIGKILL of a process that solves, then of the main process; then a damaged shard."""
    main = subprocess.Popen(
        command("study.toml", "--out", "two", "--jobs", "2"),
        cwd=folder, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
    )  # fmt: skip
    shards = folder / "two" / "shards"
    killed = False
    deadline = time.monotonic() + SECONDS
    while main.poll() is None and time.monotonic() < deadline:
        solving = [
            p for p in processes_of(psutil.Process(main.pid)) if "solver" in str(p.cmdline())
        ]
        if solving and not killed:
            solving[0].kill()
            killed = True
        if shards.is_dir() and any(shards.glob("*.parquet")):
            main.kill()
        time.sleep(0.02)
    main.wait()
    assert killed
    for damaged in list(shards.glob("*.parquet"))[:1]:
        damaged.write_bytes(damaged.read_bytes()[:-100])
    refused = run(folder, "study.toml", "--out", "two")
    assert refused.returncode == 2 and "--resume" in refused.stderr
    again = run(folder, "study.toml", "--out", "two", "--jobs", "1", "--resume")
    assert again.returncode == 0, again.stderr
    assert contents(folder / "two") == contents(folder / "one")


def test_a_finished_study_is_resumed_without_a_cluster(folder: Path) -> None:
    before = contents(folder / "one")
    again = run(
        folder, "study.toml", "--out", "one", "--scheduler", "tcp://127.0.0.1:1", "--resume"
    )
    assert again.returncode == 0, again.stderr
    assert contents(folder / "one") == before


@pytest.mark.filterwarnings("error:Port:UserWarning")
def test_local_processes_listen_on_loopback_alone() -> None:
    settings = Settings({}, study_versions(), "own", 36, True, (), 60.0, 10**9)
    before = set(psutil.Process().net_connections())
    with TaskScheduler(1, None, (), settings) as scheduler, socket.socket() as other:
        with contextlib.suppress(OSError):  # the port of Dask, in use
            other.bind(("127.0.0.1", 8787))
            other.listen()
            before |= set(psutil.Process().net_connections())
        scheduler.begin()
        opened = set(psutil.Process().net_connections()) - before
        listening = {each.laddr.ip for each in opened if each.status == psutil.CONN_LISTEN}
        assert listening == {"127.0.0.1"}


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_in_one_line(folder: Path, number: signal.Signals) -> None:
    out = f"signal{number}"
    main = subprocess.Popen(
        command("study.toml", "--out", out, "--jobs", "2"),
        cwd=folder, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    children: list[psutil.Process] = []
    # The processes that solve start before the first shard is complete.
    while main.poll() is None and len(children) < 2:
        time.sleep(0.02)
        children = processes_of(psutil.Process(main.pid))
    main.send_signal(number)
    _, errors = main.communicate(timeout=60)
    assert main.returncode == 128 + number
    assert "interrupted; run the command again with --resume" in errors
    assert "Traceback" not in errors
    psutil.wait_procs(children, timeout=10)
    assert not [each for each in children if each.is_running()]
    assert run(folder, "study.toml", "--out", out, "--resume").returncode == 0
    assert contents(folder / out) == contents(folder / "one")


@pytest.mark.slow
def test_second_stage_and_kept_runs_are_the_same_with_two_processes(tmp_path: Path) -> None:
    more = 'keep = "failed"\ndeeper = { depth = "cycle", take = "borderline", count = 1 }'
    study = written(tmp_path, 2, more)
    study.write_text(study.read_text().replace("40 N", "900 N").replace("60 N", "990 N"))
    (tmp_path / "eccentric.toml").write_text((ROOT / "cases" / "gx120.toml").read_text())
    for jobs in ("1", "2"):
        made = run(tmp_path, "study.toml", "--out", f"jobs{jobs}", "--jobs", jobs)
        assert made.returncode == 0, made.stderr
    assert contents(tmp_path / "jobs1") == contents(tmp_path / "jobs2")
    data = read_dataset(tmp_path / "jobs1")
    assert sorted(data["depth"].tolist()) == ["cycle", "preview"]
    runs = tmp_path / "jobs2" / "runs"
    (deeper,) = data["id"][data["depth"] == "cycle"]
    shutil.rmtree(runs / deeper)  # made with its row, and here on its own
    assert run(tmp_path, "study.toml", "--out", "jobs2", "--resume").returncode == 0
    assert contents(tmp_path / "jobs1") == contents(tmp_path / "jobs2")
    for name, depth in zip(data["id"], data["depth"], strict=True):
        kept = read_run(runs / name)
        rows = {each["id"]: each for each in read_verdict(runs / name)["checks"]}
        (row,) = np.flatnonzero(data["id"] == name)
        assert kept.summary["depth"] == depth and kept.summary["timings_s"] == {}
        for check in ("pressure_angle", "contact_force_margin"):
            limit = data[f"{check}.limit"][row]
            assert rows[check]["limit"] == pytest.approx(limit, rel=1e-12)
        stated = data["pressure_angle.utilisation"][row]
        assert rows["pressure_angle"]["utilisation"] == pytest.approx(stated, rel=1e-9)
        assert (runs / name / "8_report.html").is_file()


@pytest.mark.slow
def test_a_kept_certified_design_with_new_ends_stays_within_the_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The best of the shipped screening, whose ends no cache holds, with page and scene: 1 GB."""
    monkeypatch.setenv("CAMWRIGHT_CACHE", str(tmp_path / "cache"))
    (tmp_path / "redesign.toml").write_text((ROOT / "cases" / "gx120-redesign.toml").read_text())
    (tmp_path / "study.toml").write_text(
        'name = "best"\ncase = "redesign.toml"\ndepth = "certified"\nkeep = "best:1"\n'
        '[[objective]]\ncolumn = "headline.torque_std_after_Nm"\n'
        '[[factor]]\nkey = "roller.radius"\nlist = ["24.13 mm"]\n'
        '[[factor]]\nkey = "cam.prime_radius"\nlist = ["56.2 mm"]\n[sampling]\nmethod = "list"\n'
    )
    made = run(tmp_path, "study.toml", "--out", "out", "--jobs", "1")
    assert made.returncode == 0, made.stderr
    data = read_dataset(tmp_path / "out")
    assert data["message"].tolist() == [""] and data["verdict"].tolist() == ["pass"]
    kept = tmp_path / "out" / "runs" / str(data["id"][0])
    assert {"8_report.html", "scene.html"} <= {each.name for each in kept.iterdir()}


@pytest.mark.slow
def test_twenty_seeded_kills_lose_and_double_no_row(tmp_path: Path) -> None:
    """SIGKILL of workers, of their solving processes and of the main process."""
    written(tmp_path, 120)
    assert run(tmp_path, "study.toml", "--out", "whole", "--jobs", "1").returncode == 0
    draw = random.Random(16)
    kills = 0
    arguments = ("study.toml", "--out", "killed", "--jobs", "2", "--resume")
    while kills < 20:
        main = subprocess.Popen(
            command(*arguments), cwd=tmp_path, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL
        )
        while main.poll() is None and kills < 20:
            time.sleep(draw.uniform(0.5, 3.0))
            if main.poll() is not None:
                break
            others = sorted(processes_of(psutil.Process(main.pid)), key=lambda each: each.pid)
            target = draw.choice([psutil.Process(main.pid), *others, *others])
            with_target = target.is_running()
            if with_target:
                target.kill()
                kills += 1
        if main.poll() is not None and main.returncode == 0 and kills < 20:
            # finished before the twentieth kill: one shard is taken away
            shard = draw.choice(sorted((tmp_path / "killed" / "shards").iterdir()))
            shard.unlink()
        main.wait(timeout=SECONDS)
    assert run(tmp_path, *arguments).returncode == 0
    assert contents(tmp_path / "killed") == contents(tmp_path / "whole")


@pytest.fixture
def address(tmp_path: Path) -> Iterator[str]:
    """A scheduler and two workers as processes of their own, on loopback."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    place = f"tcp://127.0.0.1:{port}"
    dask = [sys.executable, "-m", "dask"]
    loopback = ["--host", "127.0.0.1", "--no-dashboard"]
    lines = [
        [*dask, "scheduler", "--port", str(port), *loopback],
        *[[*dask, "worker", place, "--nthreads", "1", *loopback] for _ in range(2)],
    ]
    running = [
        subprocess.Popen(
            line, cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        for line in lines
    ]  # fmt: skip
    try:
        yield place
    finally:
        for each in reversed(running):
            each.terminate()
        for each in running:
            each.wait(timeout=30)


@pytest.mark.slow
def test_a_running_scheduler_gives_the_same_bytes(folder: Path, address: str) -> None:
    made = run(folder, "study.toml", "--out", "remote", "--scheduler", address)
    assert made.returncode == 0, made.stderr
    assert contents(folder / "remote") == contents(folder / "one")


@pytest.mark.slow
def test_a_lost_scheduler_is_one_line_and_resumed(folder: Path, address: str) -> None:
    main = subprocess.Popen(
        command("study.toml", "--out", "lost", "--scheduler", address),
        cwd=folder, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    shards = folder / "lost" / "shards"
    while main.poll() is None and not (shards.is_dir() and any(shards.glob("*.parquet"))):
        time.sleep(0.02)
    (scheduler,) = (
        each
        for each in psutil.Process().children()
        if "scheduler" in each.cmdline() and "dask" in each.cmdline()
    )
    scheduler.kill()
    _, errors = main.communicate(timeout=120)
    assert main.returncode == 2 and "Traceback" not in errors, errors
    assert run(folder, "study.toml", "--out", "lost", "--resume").returncode == 0
    assert contents(folder / "lost") == contents(folder / "one")


@pytest.mark.parametrize(
    "address",
    ["", "garbage", "tcp://", "http://x:1", "inproc://x", "ucx://1:1", "tcp://h:99999", "h:1/../x",
     "tcp://h:0", "tcp://<b>:1", "tcp://h:1\n", "x" * 5000],
)  # fmt: skip
def test_text_that_is_no_address_is_refused(tmp_path: Path, address: str) -> None:
    with pytest.raises(InputError, match=r"--scheduler = .*must be tcp://HOST:PORT") as refused:
        run_line(
            ["study", "run", "none.toml", "--out", str(tmp_path / "out"), "--scheduler", address]
        )
    assert len(str(refused.value)) < 200 and "\n" not in str(refused.value)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("case", ["../../../etc/passwd", "link.toml", "/etc/passwd", ".", "<b>"])
@pytest.mark.parametrize("out", ["out", "file"])
def test_a_refused_study_writes_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, case: str, out: str
) -> None:
    path = written(tmp_path, 2)
    path.write_text(path.read_text().replace("eccentric.toml", case))
    (tmp_path / "link.toml").symlink_to("/etc/passwd")
    (tmp_path / "file").write_text("mine")
    before = sorted(tmp_path.rglob("*"))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InputError, match="case") as refused:
        run_line(["study", "run", "study.toml", "--out", out])
    assert "root" not in str(refused.value)
    assert sorted(tmp_path.rglob("*")) == before


class EveryThirdRefused:
    """Stands for the cluster: of three designs one passes, one fails, one has no result."""

    def __init__(self, *_: object) -> None:
        self.solved = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None: ...

    def begin(self) -> None: ...

    def release(self) -> None: ...

    def shards(
        self, tasks: Iterable[Task], _: str | None
    ) -> Iterator[tuple[Task, tuple[bytes, bytes, dict[str, dict[str, bytes]]]]]:
        for task in tasks:
            count = len(task.ids)
            screens = [("open", "fail", "error")[(self.solved + k) % 3] for k in range(count)]
            self.solved += count
            yield task, (*encoded(task, {"screen": screens}, [0.0] * count, ()), {})


def test_the_stop_rule_counts_as_the_answers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Interval of the yield of the rows written: at most that of the rule, wider a shard before."""
    path = written(tmp_path, 500)
    path.write_text(path.read_text() + "[stop]\ninterval = 0.25\n")
    monkeypatch.setattr(study_run, "TaskScheduler", EveryThirdRefused)
    record = study_run.run_study(read_study(path), path.read_text(), tmp_path, tmp_path / "out")
    data = read_dataset(tmp_path / "out")
    share = answered(data, read_study(path))["yield"]
    assert schema_errors("study", record) == []
    assert record["stopped"] == "interval" and record["designs"] == len(data) < 500
    assert share["count"] + share["without_result"] == len(data)
    assert share["without_result"] == len(data) // 3
    low, high = share["interval"]
    assert high - low == pytest.approx(Yield(share["passed"], share["count"]).width, abs=1e-12)
    screens = data["screen"][: -SHARD_OF[Tier.PREVIEW]]
    before = Yield(int((screens == "open").sum()), int((screens != "error").sum()))
    assert high - low <= 0.25 < before.width


def test_a_file_in_the_way_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    written(tmp_path, 2)
    (tmp_path / "file").write_text("mine")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ResultError, match="file: is not a folder"):
        run_line(["study", "run", "study.toml", "--out", "file"])
    assert (tmp_path / "file").read_text() == "mine"


def test_an_address_without_scheduler_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from camwright.pipeline.studies.batch import task_scheduler

    path = written(tmp_path, 2)
    monkeypatch.setattr(task_scheduler, "_CONNECT_S", 1)
    address = "tcp://127.0.0.1:1"
    with pytest.raises(InputError, match=r"--scheduler = tcp://127\.0\.0\.1:1 "):
        study_run.run_study(
            read_study(path), path.read_text(), tmp_path, tmp_path / "out", scheduler=address
        )
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (None, r"\(no answer within 1 s\)"),
        (b"", ""),
        (b"SSH-2.0-OpenSSH_9.2\r\n", ""),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", ""),
    ],
    ids=["silent", "closes", "ssh", "http"],
)
def test_an_address_of_something_else_is_refused(
    monkeypatch: pytest.MonkeyPatch, words: bytes | None, reason: str
) -> None:
    """What accepts the connection and is no scheduler, within the time."""
    from camwright.pipeline.studies.batch import task_scheduler

    monkeypatch.setattr(task_scheduler, "_CONNECT_S", 1)
    accepted = []

    def serve(listening: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while True:
                connection, _ = listening.accept()
                accepted.append(connection)
                if words is not None:
                    connection.sendall(words)
                    connection.shutdown(socket.SHUT_WR)

    with socket.create_server(("127.0.0.1", 0)) as listening:
        threading.Thread(target=serve, args=(listening,), daemon=True).start()
        address = f"tcp://127.0.0.1:{listening.getsockname()[1]}"
        start = time.monotonic()
        with (
            pytest.raises(
                InputError, match=rf"--scheduler = {address} {reason}.*running scheduler"
            ),
            TaskScheduler(1, address, (), Settings({}, {}, "own", 36, False, (), 1.0, 1)) as there,
        ):
            there.begin()
        assert time.monotonic() - start < 10.0
        assert accepted
        listening.shutdown(socket.SHUT_RDWR)
    for connection in accepted:
        connection.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("more", "message"),
    [
        ('design = { time = "0.1 s" }', "not solved within 0.1 s"),
        ('design = { memory = "20 MB" }', "not solved within 20 MB of memory"),
    ],
)
def test_a_design_out_of_time_or_memory_is_a_row(tmp_path: Path, more: str, message: str) -> None:
    written(tmp_path, 2, more)
    made = run(tmp_path, "study.toml", "--out", "out", "--jobs", "1")
    assert made.returncode == 0, made.stderr
    data = read_dataset(tmp_path / "out")
    assert data["message"].tolist() == [message] * 2
    assert data["screen"].tolist() == ["error"] * 2


def test_a_refused_design_has_a_row_and_no_run(folder: Path) -> None:
    """Values that the case refuses, of a design whose run would be made with its row."""
    study = read_study(folder / "study.toml")
    templates = read_templates(folder, study.cases)
    plan = study_run.planned(study, templates)
    task = next(plan.tasks(Tier.CYCLE)).alone(0)
    task = replace(task, values={"spring.preload": np.array([-1.0])})
    sent: list[object] = []
    DesignSolver(templates, plan.settings).solved_and_run(task, 0, Wanted("open"), sent.append)
    row, files = sent
    assert isinstance(row, dict) and "spring.preload = -1" in str(row["message"])
    assert row["screen"] == "error" and files == {}


def test_a_kept_preview_is_solved_once(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Row, run and page of a design come from one solution."""
    from camwright.pipeline import iteration, preview, run, solver

    solved: list[str] = []
    for module in (iteration, preview, solver):
        original = module.solve

        def counted(*arguments: Any, _original: Any = original, **options: Any) -> Any:
            solved.append("solve")
            return _original(*arguments, **options)

        monkeypatch.setattr(module, "solve", counted)
    monkeypatch.setattr(run, "trials", None)
    study = read_study(folder / "study.toml")
    templates = read_templates(folder, study.cases)
    plan = study_run.planned(study, templates)
    task = next(plan.tasks(study.tier)).alone(0)
    designs, sent = DesignSolver(templates, plan.settings), list[Any]()
    designs.solved_and_run(task, 0, Wanted("open"), sent.append)
    row, files = sent
    assert row == designs.solved(task, 0) and solved == ["solve"] * 2
    assert "run.json" in files and "8_report.html" not in files
    page = designs.presented(files)
    assert set(files) < set(page) and "8_report.html" in page and solved == ["solve"] * 2
    assert page == designs.run_folder(task, 0) | {CLOCK: page[CLOCK]}


@pytest.mark.parametrize("kept", [True, False])
def test_files_that_cannot_be_written_lose_no_row(
    folder: Path, monkeypatch: pytest.MonkeyPatch, kept: bool
) -> None:
    """The row is sent before the files of its run; of a design that is not kept none is written."""
    from camwright.pipeline import run

    written: list[Any] = []

    def full(_: Any, trial: Any) -> None:
        written.append(trial)
        raise ResultError("No space left on device")

    monkeypatch.setattr(run, "write_trial_files", full)
    study = read_study(folder / "study.toml")
    templates = read_templates(folder, study.cases)
    plan = study_run.planned(study, templates)
    task = next(plan.tasks(study.tier)).alone(0)
    designs, sent = DesignSolver(templates, plan.settings), list[Any]()
    monkeypatch.setattr(Wanted, "takes", lambda *_: kept)
    designs.solved_and_run(task, 0, Wanted("open"), sent.append)
    row, files = sent
    assert row == designs.solved(task, 0) and row["screen"] != "error"
    assert files == {} and len(written) == kept


def test_a_design_that_kills_its_process_is_a_row(folder: Path) -> None:
    """The process that solves is killed each time it starts."""
    from camwright.pipeline.studies.batch.solver_process import SolverProcess

    study = read_study(folder / "study.toml")
    templates = read_templates(folder, study.cases)
    plan = study_run.planned(study, templates)
    task = next(plan.tasks(study.tier)).alone(0)
    solver = SolverProcess(templates, plan.settings)
    finished = threading.Event()

    def killer() -> None:
        while not finished.wait(0.05):
            for each in psutil.Process().children():
                if "solver_process" in " ".join(each.cmdline()):
                    each.kill()

    thread = threading.Thread(target=killer)
    thread.start()
    rows, clock, _ = solver.rows(task)
    finished.set()
    thread.join()
    table = table_from(rows)
    assert table["message"].to_pylist() == ["the process of the solution died 3 times"]
    assert table["screen"].to_pylist() == ["error"] and len(table_from(clock)) == 1
    solver.close()
