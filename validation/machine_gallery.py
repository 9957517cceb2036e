"""Gallery: previews of machines, torque, lift, outline and speed of each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import governing, screen, within_depth
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.cycle.crank_speed import study_of
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.trial import Trial
from validation.paper_figure import (
    PaperCurve,
    PaperFigure,
    PaperPanel,
    closed,
    closed_angle,
    outline,
)

ANGLE = "cam angle, deg"
MACHINES_MAX = 24


def gallery(paths: Sequence[Path], progress: Progress = SILENT) -> dict[str, Any]:
    """Contents of ``gallery.json``: a figure and key values of each case, by preview.

    Raises
    ------
    InputError
        If there are more than 24 cases, two of one name, or a case without a torque.
    CamError
        If a case has no cam.
    """
    if len(paths) > MACHINES_MAX:
        raise InputError("CASE", f"{len(paths)} cases", f"at most {MACHINES_MAX} on one page")
    machines: list[dict[str, Any]] = []
    progress.stage("previews")
    for count, path in enumerate(paths, start=1):
        case = read_case(path)
        if case.name in [one["name"] for one in machines]:
            raise InputError("CASE", path.name, f"of another name than {case.name}")
        machines.append({"case": path.as_posix(), **_machine(preview_case(case, corners=False))})
        progress.advance(count, len(paths))
    return {"machines": machines}


def _machine(trial: Trial) -> dict[str, Any]:
    """Figure and key values of one machine, of its first load case."""
    case, turn = trial.case, trial.cycles[0].turn
    if turn.torque_before is None or turn.torque_after is None:
        raise InputError("CASE", case.name, "with a torque, not a lift alone")
    before, after, lift = turn.torque_before, turn.torque_after, trial.contour.pitch.lift
    count = before.size
    angle = closed_angle(count, 360.0)
    speeds = _speeds(trial)
    panels = (
        PaperPanel(ANGLE, "torque about its mean, N m", (
            PaperCurve("without the cam", angle, closed(before)),
            PaperCurve("with the cam", angle, closed(after), 1),
        )),
        _outline(trial),
        PaperPanel(ANGLE, "lift, mm", (PaperCurve("", angle, 1e3 * closed(lift(turn.theta))),)),
        *speeds,
    )  # fmt: skip
    judged = within_depth(trial.checks)
    worst = governing(judged)
    figure = PaperFigure(case.name, "", "", case.title, case.notes.strip(), panels, columns=2)
    ripple = float(before.std()), float(after.std())
    return {
        "name": case.name,
        "figure": figure.record(),
        "screen": screen(judged),
        "governing": None if worst is None else worst.title,
        "cycles_per_cam_turn": case.period.cycles,
        "values": {
            "speed_rpm": in_unit(turn.machine.speed, "rpm"),
            "torque_std_without_cam_Nm": ripple[0],
            "torque_std_with_cam_Nm": ripple[1],
            "lift_mm": 1e3 * lift.stroke,
            "pressure_max_MPa": 1e-6 * float(np.nanmax(trial.cycles[0].contact.p0_hertz)),
        },
    }


def _outline(trial: Trial) -> PaperPanel:
    """Contour about the axis of the cam, at the scale of its own."""
    x, y = outline(trial.contour.points(uniform_turn(720)))
    reach = 1.1 * float(np.hypot(x, y).max())
    curve = PaperCurve("", x, y, look="fill")
    return PaperPanel(
        "x, mm", "y, mm", (curve,), kind="outline", window=(-reach, reach, -reach, reach)
    )


def _speeds(trial: Trial) -> tuple[PaperPanel, ...]:
    """Shaft speed without and with the cam; nothing without inertia or where the shaft stalls."""
    machine = trial.cycles[0].machine
    try:
        study = study_of(machine, trial.contour.pitch)
    except CamError:
        return ()
    if study is None:
        return ()

    def curve(label: str, speed: Array, series: int) -> PaperCurve:
        rpm = closed(speed) * (60.0 / (2.0 * np.pi))
        return PaperCurve(label, closed_angle(speed.size, 360.0), rpm, series)

    both = (
        curve("without the cam", study.before.speed, 0),
        curve("with the cam", study.after.speed, 1),
    )
    return (PaperPanel(ANGLE, "shaft speed, rpm", both),)
