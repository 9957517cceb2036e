"""Fresh processes: as many as are of use, one BLAS thread each, gone when work is dropped."""

import os
import pickle
import subprocess
import sys
import time
from pathlib import Path

import pytest

from camwright.pipeline.base.worker_processes import crew, pool, workers_for
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.iteration import forecasts
from camwright.pipeline.smoothing.smoothers import Smoother

CASES = Path(__file__).resolve().parents[2] / "cases"


@pytest.mark.parametrize(
    ("jobs", "tasks", "expected"), [(3, 8, 3), (8, 3, 3), (None, 1, 1), (2, 0, 1)]
)
def test_as_many_as_are_of_use(jobs, tasks, expected):
    assert workers_for(jobs, tasks) == expected


def test_workers_have_one_thread_and_the_parent_keeps_its_own(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    with pytest.raises(ValueError, match="stop"), pool(1) as fresh:
        assert fresh.submit(os.getenv, "OMP_NUM_THREADS").result() == "1"
        waiting = [fresh.submit(os.getpid) for _ in range(50)]
        raise ValueError("stop")
    assert os.environ["OMP_NUM_THREADS"] == "7"
    assert "MKL_NUM_THREADS" not in os.environ
    assert all(future.done() for future in waiting)  # worked out or cancelled, none left behind


def test_a_script_needs_no_guard(tmp_path):
    """A script without ``if __name__ == "__main__"`` runs once, and its module is as before."""
    script = tmp_path / "script.py"
    script.write_text(
        "import os\n"
        "from camwright.pipeline.base.worker_processes import pool\n"
        "print('begun')\n"
        "with pool(2) as fresh:\n"
        "    print(fresh.submit(os.path.basename, __file__).result())\n"
    )
    done = subprocess.run(
        [sys.executable, str(script)], capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout.split()) == (0, ["begun", "script.py"]), done.stderr


def test_a_crew_of_one_works_here_when_the_result_is_read():
    calls = []
    with crew(1) as workers:
        task = workers.submit(lambda value: calls.append(value) or len(calls), 3)
        assert calls == []
        assert (task.result(), task.result(), calls) == (1, 1, [3])


def test_a_crew_shares_its_processes_and_ends_them():
    with crew(2) as workers:
        first, second = workers.submit(os.getpid), workers.submit(os.getpid)
        assert os.getpid() not in (first.result(), second.result())
        assert workers.workers == 2


def test_a_dismissed_crew_finishes_its_tasks():
    with crew(2) as workers:
        task = workers.submit(time.sleep, 0.3)
        workers.dismiss()
        assert task.result() is None


def test_a_case_and_its_checks_are_the_same_in_a_worker():
    """The quick checks of two smoothers, one of which has no cam, from a worker and from here."""
    case = with_values(read_case(CASES / "gx120.toml"), {"roller.radius": 0.03})
    torques, first = engine_torques(case), Smoother.from_case(case.smoothing, case.period)
    smoothers = [first, first.stretched(3.0)]
    copy = pickle.loads(pickle.dumps(case))
    assert (copy, copy.sha256, copy.included) == (case, case.sha256, case.included)
    with crew(2) as workers:
        there = workers.submit(forecasts, case, torques, smoothers).result()
    here = forecasts(case, torques, smoothers)
    assert [list(map(str, each)) for each in there] == [list(map(str, each)) for each in here]
    assert [bool(checks) for checks in there] == [False, True]


def test_an_interrupt_does_not_wait_for_what_runs():
    """A task of five minutes would be waited for."""
    with pytest.raises(KeyboardInterrupt), pool(1) as fresh:
        assert fresh.submit(os.getpid).result() != os.getpid()
        waiting = fresh.submit(time.sleep, 300)
        raise KeyboardInterrupt
    assert waiting.done()


@pytest.mark.parametrize(
    ("first", "end"),
    [("pass", "raise KeyboardInterrupt"), ("dead = fresh.submit(os._exit, 1)", "dead.result()")],
    ids=["interrupt", "dead process"],
)
def test_a_pool_ends_while_it_sends_a_task_that_no_process_reads(first, end):
    """The tasks are longer than the buffer of a pipe; a pool that waits would never end."""
    script = (
        "import os\n"
        "from camwright.pipeline.base.worker_processes import pool\n"
        "with pool(1) as fresh:\n"
        f"    {first}\n"
        "    long = [fresh.submit(len, bytes(10_000_000)) for _ in range(4)]\n"
        f"    {end}\n"
    )
    ended = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=False, timeout=60
    )
    assert ended.stderr.splitlines()[-1].split(":")[0].endswith(("Interrupt", "BrokenProcessPool"))
