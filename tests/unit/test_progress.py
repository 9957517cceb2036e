"""What a run says: lines where nobody watches, bars on a terminal."""

from __future__ import annotations

import io
import time

import pytest
from rich.console import Console
from rich.progress import Progress as RichProgress

from camwright.pipeline.base.progress import Bars, Lines, Silent, process_began, share
from camwright.pipeline.run import START, Stopwatch


def test_a_file_has_one_line_a_stage() -> None:
    said: list[str] = []
    lines = Lines(said.append)
    lines.stage("cycle")
    for k in range(1, 101):
        lines.advance(k, 100)
    lines.note("trial 1 fails")
    lines.stage("checks")
    assert said == ["cycle", "trial 1 fails", "checks"]


def test_bars_show_stage_percent_and_remaining_time() -> None:
    screen = io.StringIO()
    with Bars(Console(file=screen, force_terminal=True, width=100)) as bars:
        bars.advance(1, 2)  # before a stage: nothing to show
        bars.stage("torque")
        bars.stage("cycle")
        bars.advance(3, 10)
        bars.note("[not markup]")
    text = screen.getvalue()
    assert "torque done" in text
    assert " 30 %" in text
    assert "remaining" in text
    assert "[not markup]" in text


def test_a_stage_without_steps_is_estimated_by_its_usual_duration() -> None:
    now = [100.0]
    bars = RichProgress(get_time=lambda: now[0])
    bars.add_task("cycle", total=10, completed=4, usual=None)
    bars.add_task("checks", total=None, usual=4.0)
    bars.add_task("torque", total=None, usual=None)
    steps, timed, unknown = bars.tasks
    now[0] += 1.0
    assert [share(task) for task in (steps, timed, unknown)] == [0.4, 0.25, None]
    now[0] += 100.0
    assert share(timed) == 0.99


def test_silent_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    silent = Silent()
    silent.stage("torque")
    silent.advance(1, 2)
    silent.note("text")
    assert capsys.readouterr() == ("", "")


def test_the_stages_of_all_trials_sum_to_the_total(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [10.0]
    monkeypatch.setattr(time, "perf_counter", lambda: now[0])
    watch = Stopwatch(Silent(), 7.0)
    for name, seconds in (("trial 1: cycle", 2.0), ("checks", 1.0), ("trial 2: cycle", 4.0)):
        watch.stage(name)
        now[0] += seconds
    assert watch.read() == {START: 3.0, "cycle": 6.0, "checks": 1.0, "total": 10.0}
    now[0] += 0.5  # of the stage that still runs
    times = watch.read()
    assert times["cycle"] == 6.5
    assert times.pop("total") == pytest.approx(sum(times.values()))


def test_a_process_began_before_now() -> None:
    began = process_began()
    assert began <= time.perf_counter()
    assert time.perf_counter() - began < 86400.0
