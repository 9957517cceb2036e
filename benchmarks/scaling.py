"""Constants behind docs/scaling.md: python benchmarks/scaling.py [STUDY FOLDER]

Bytes of a row, CPU of a shard in a worker, in the scheduler and in the main process, memory of a
design there, CPU and memory of the answers. CPU times, as other work on the machine does not enter
them. Without a folder 2,000 designs are screened here.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
import tomllib
import tracemalloc
from itertools import islice
from pathlib import Path

import numpy as np

from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.studies.batch.case_template import read_templates
from camwright.pipeline.studies.batch.dataset import DATASET, SHARDS, parquet_bytes, read_parquet
from camwright.pipeline.studies.batch.design_plan import Plan
from camwright.pipeline.studies.batch.design_solver import DesignSolver
from camwright.pipeline.studies.batch.design_task import Settings
from camwright.pipeline.studies.batch.row_selection import RowFigures
from camwright.pipeline.studies.batch.sampling import SampledDesigns
from camwright.pipeline.studies.batch.study_file import study_of
from camwright.pipeline.studies.batch.study_run import planned, run_study

ROOT = Path(__file__).resolve().parent.parent
SHARD, TASKS, BYTES = 500, 1000, 400_000
MADE = """name = "scaling"
case = "cases/gx120-redesign.toml"
[[factor]]
key = "spring.preload"
range = {low = "800 N", high = "1500 N"}
[[factor]]
key = "roller.radius"
range = {low = "20 mm", high = "26 mm"}
[sampling]
method = "random"
count = 2000
"""


def main() -> None:
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(sys.argv[1]) if len(sys.argv) > 1 else made(Path(scratch) / "study")
        rows(folder)
        answers(folder)
    shard()
    depths()
    plan()
    scheduler()


def made(folder: Path) -> Path:
    """A study folder of 2,000 screened designs."""
    tables = tomllib.loads(MADE)
    tables["case"] = [tables["case"]]
    run_study(study_of(tables), MADE, ROOT, folder, jobs=2, progress=Silent())
    return folder


def rows(folder: Path) -> None:
    """Bytes of a row in the files, and what the main process keeps of it."""
    table = read_parquet(folder / DATASET)
    count, columns = table.num_rows, table.num_columns
    shards = sorted((folder / SHARDS).glob("*.parquet"))
    stored = sum(path.stat().st_size for path in shards) / count
    whole = (folder / DATASET).stat().st_size / count
    print(f"{count} rows, {columns} columns")
    print(
        f"bytes of a row: shard {stored:.0f}, dataset {whole:.0f}, "
        f"in memory {table.nbytes / count:.0f}"
    )
    tables = [read_parquet(path) for path in shards]
    tracemalloc.start()
    figures = RowFigures(())
    for each in tables:
        figures.add(each)
    size, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    print(f"selection in the main process: {size / count:.0f} bytes a design")
    for size in (SHARD, 10):
        contents = [parquet_bytes(table.slice(k * size, size)) for k in range(20)]
        with tempfile.TemporaryDirectory() as scratch:
            path = Path(scratch) / "shard.parquet"
            began, clock = time.process_time(), time.perf_counter()
            for content in contents:
                write_atomic(path, content)
            wrote = time.perf_counter() - clock
            for _ in contents:
                RowFigures(()).add(read_parquet(path))
            spent = (time.process_time() - began) / len(contents)
        print(
            f"main process: {1e3 * spent:.1f} ms CPU a shard of {size} rows, written, read back "
            f"and taken in; {1e3 * wrote / len(contents):.1f} ms of this disk by the clock"
        )


def answers(folder: Path) -> None:
    """CPU and memory of `study report`, less those of a bare start."""
    bare = child([])
    report = child([str(folder)])
    print(f"study report: {report[0]:.2f} s CPU, {report[1]:.0f} MB; "
          f"{bare[0]:.2f} s and {bare[1]:.0f} MB of it imports")  # fmt: skip


def child(arguments: list[str]) -> tuple[float, float]:
    """CPU, s, and greatest memory, MB, of a process that writes the report of a folder."""
    code = (
        "import sys; from pathlib import Path; import resource as r\n"
        "from camwright.pipeline.commands.study_command import write_study_report as write\n"
        "from camwright.pipeline.studies.batch import answers, dataset, study_file\n"
        "from camwright.reports.study import study_page\n"
        "import pyarrow.parquet\n"
        "[write(Path(each)) for each in sys.argv[1:]]\n"
        "u = r.getrusage(r.RUSAGE_SELF); print(u.ru_utime + u.ru_stime, u.ru_maxrss / 1e3)"
    )
    words = subprocess.check_output([sys.executable, "-c", code, *arguments], text=True).split()
    return float(words[-2]), float(words[-1])


def shard() -> None:
    """CPU of a shard of screened designs in a worker."""
    case = read_case(ROOT / "cases" / "gx120-redesign.toml")
    rng = np.random.default_rng(1)
    for attempt in range(2):
        factors = {
            "spring.preload": rng.uniform(800.0, 1500.0, SHARD),
            "roller.radius": rng.uniform(0.020, 0.026, SHARD),
        }
        began = time.process_time()
        screen_designs(case, factors, positions=180)
        spent = time.process_time() - began
        print(f"worker: {spent:.2f} s CPU a shard of {SHARD} designs"
              f"{', first one of a process' if attempt == 0 else ''}")  # fmt: skip
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(f"worker: {peak:.0f} MB")


def depths() -> None:
    """CPU of a row at each depth in a worker; the first row of the process is left out."""
    tables = tomllib.loads(MADE)
    tables |= {"case": ["cases/gx120.toml"], "depth": "preview", "corners": False}
    tables["factor"] = [
        {"key": "spring.rate", "range": {"low": "20 kN/m", "high": "30 kN/m"}},
        {"key": "cam.prime_radius", "range": {"low": "45 mm", "high": "55 mm"}},
    ]
    study = study_of(tables)
    templates = read_templates(ROOT, study.cases)
    designs = planned(study, templates)
    solver = DesignSolver(templates, designs.settings)
    for tier, count in ((Tier.PREVIEW, 9), (Tier.CYCLE, 3), (Tier.CERTIFIED, 1)):
        rows_of = ((task, row) for task in designs.tasks(tier) for row in range(len(task.ids)))
        spent = []
        for task, row in islice(rows_of, count + 1):
            began = used()
            solver.solved(task, row)
            spent.append(used() - began)
        print(f"worker: {np.mean(spent[1:]):.2f} s CPU a row at the depth {tier.word}")


def used() -> float:
    """CPU time of this process and those below it, s."""
    spent = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(each.ru_utime + each.ru_stime for each in spent)


def plan() -> None:
    """CPU and memory of the identity of each design in the main process."""
    count = 20_000
    values = np.random.default_rng(1).random(count)

    class Axis:
        key, unit, levels = "spring.preload", "N", ()
        si = staticmethod(lambda column: column)

    settings = Settings({"made": "0"}, {}, "own", 180, True, (), 1.0, 1)
    designs = SampledDesigns((Axis(),), {"spring.preload": values}, count)
    tracemalloc.start()
    made_plan = Plan.of(["made"], designs, settings)
    size, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    began = time.process_time()
    Plan.of(["made"], designs, settings)
    spent = (time.process_time() - began) / count
    print(f"plan: {1e6 * spent:.1f} us and {size / len(made_plan.ids):.0f} bytes a design")


def scheduler() -> None:
    """CPU of the scheduler for a task, with results of a few bytes and of a shard."""
    import psutil
    from distributed import Client

    with tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "scheduler.json"
        quiet = {"stderr": subprocess.DEVNULL, "env": {**os.environ, "OMP_NUM_THREADS": "1"}}
        there = ["--scheduler-file", str(file), "--no-dashboard"]
        head = subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1",
             "--port", "0", *there], **quiet)  # fmt: skip
        while not file.exists():
            time.sleep(0.1)
        hands = [
            subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_worker", "--nthreads",
                              "1", "--no-nanny", *there], **quiet)
            for _ in range(2)
        ]  # fmt: skip
        process = psutil.Process(head.pid)

        def spent() -> float:
            times = process.cpu_times()
            return float(times.user + times.system)

        with Client(scheduler_file=str(file)) as client:
            client.wait_for_workers(2)
            client.gather(client.map(bytes, range(100), pure=False))
            for count, size in ((TASKS, 100), (TASKS // 5, BYTES)):
                before = spent()
                client.gather(client.map(bytes, [size] * count, pure=False))
                print(f"scheduler: {1e3 * (spent() - before) / count:.2f} ms CPU a task with a "
                      f"result of {size} bytes")  # fmt: skip
        for each in (*hands, head):
            each.terminate()
            each.wait()


if __name__ == "__main__":
    main()
