"""What a run says: lines where nobody watches, bars on a terminal."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from camwright.pipeline.base.progress import Bars, Lines, Silent


def test_lines_speak_every_ten_seconds_and_tell_the_rest() -> None:
    said: list[str] = []
    now = [0.0]
    lines = Lines(said.append, lambda: now[0])
    lines.stage("cycle")
    for k in range(1, 101):
        now[0] = k * 0.5
        lines.advance(k, 100)
    lines.note("done")
    assert said == [
        "cycle",
        "cycle: 20 of 100, 40 s remain",
        "cycle: 40 of 100, 30 s remain",
        "cycle: 60 of 100, 20 s remain",
        "cycle: 80 of 100, 10 s remain",
        "cycle: 100 of 100, 0 s remain",
        "done",
    ]


def test_bars_show_stage_and_remaining_time() -> None:
    screen = io.StringIO()
    with Bars(Console(file=screen, force_terminal=True, width=100)) as bars:
        bars.advance(1, 2)  # before a stage: nothing to show
        bars.stage("torque")
        bars.stage("cycle")
        bars.advance(3, 10)
        bars.note("[not markup]")
    text = screen.getvalue()
    assert "torque done" in text
    assert "3/10" in text
    assert "remaining" in text
    assert "[not markup]" in text


def test_silent_says_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    silent = Silent()
    silent.stage("torque")
    silent.advance(1, 2)
    silent.note("text")
    assert capsys.readouterr() == ("", "")
