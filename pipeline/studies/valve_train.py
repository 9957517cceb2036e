"""The machine motion of a valve cam as Petrescu and Petrescu (2015) study it, beside its run.

Their systems 1 to 15 are lost in the text at hand but for 11 and 15. What stands in for the others
is standard mechanics in the paper's words, and every row of it says *reconstructed*.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.lift_section import LiftSegments, motion_of
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.elastic_response import elastic_follower
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.studies.valve_cam import (
    ElasticValve,
    ValveCam,
    follower_acceleration,
    rise_efficiency,
)

_ANGLES = 20_000
RECONSTRUCTED = "reconstructed"
_NO_YIELD = "the paper's momentary yield, eq. 6.18; no efficiency: the projection counts twice"


@dataclass(frozen=True)
class Row:
    """One figure of a load case ("" where it holds for all), with what there is to say of it."""

    load_case: str
    name: str
    value: float
    unit: str
    note: str = ""


def valve_cam(case: Case) -> ValveCam | None:
    """The cam in the paper's terms; None where the case does not ask for it.

    A case asks by `valve_train`, which a lift by segments has to go with.
    """
    train, lift = case.valve_train, case.lift
    if train is None or not isinstance(lift, LiftSegments):
        return None
    roller = case.roller_given
    return ValveCam(
        motion_of(lift),
        case.base_circle,
        0.0 if roller is None else roller.radius,
        case.cam.offset,
        "C" if roller is None else "B",
        train.cam_mass,
        case.follower.mass,
    )


def valve_record(trial: Trial) -> Mapping[str, Any]:
    """Entry ``valve_train`` of ``run.json``: module and rows; null for a case without one."""
    cam, turns = valve_cam(trial.case), [cycle.turn for cycle in trial.cycles]
    return {"valve_train": None if cam is None else machine_motion(cam, turns)}


def machine_motion(cam: ValveCam, turns: Sequence[Turn]) -> Mapping[str, Any]:
    """Module of the cam, and rows of its machine motion in every load case."""
    rows = [*_shape(cam), *(row for turn in turns for row in _motion(cam, turn))]
    return {"module": cam.module, "rows": [asdict(row) for row in rows]}


def _shape(cam: ValveCam) -> list[Row]:
    phi = (np.arange(_ANGLES) + 0.5) * (FULL_TURN / _ANGLES)
    index = cam.shape_index(phi[cam.motion(phi, 1) > 0.0])
    return [
        Row("", "Shape index, mean over the rise", float(index.mean()), "-", _NO_YIELD),
        Row("", "Shape index, greatest", float(index.max()), "-", _NO_YIELD),
        Row(
            "",
            "Mean reduced inertia",
            1e6 * cam.mean_reduced_inertia(),
            "kg mm^2",
            f"eqs 1 and 8 to 10, {RECONSTRUCTED}",
        ),
    ]


def _motion(cam: ValveCam, turn: Turn) -> list[Row]:
    mean, name = turn.machine.cam_speed, turn.machine.load_case
    phi, motion = turn.theta, cam.motion
    speed, turning = cam.speed(phi, mean), cam.angular_acceleration(phi, mean)
    uneven = follower_acceleration(motion(phi, 1), motion(phi, 2), speed, turning)
    uses = "share of the cam's work on the rise that reaches spring and mass, all friction counted"
    return [
        Row(name, "True efficiency of the rise", rise_efficiency(turn.loads), "-", uses),
        Row(name, "Shaft speed, least", float(speed.min()), "rad/s", _eq("2 and 3")),
        Row(name, "Shaft speed, greatest", float(speed.max()), "rad/s", _eq("2 and 3")),
        Row(name, "Angular acceleration", float(np.abs(turning).max()), "rad/s^2", _eq("5")),
        Row(
            name,
            "Acceleration of the follower",
            float(np.abs(uneven).max()),
            "m/s^2",
            "eq. 15, on the uneven speed",
        ),
        *_elastic(turn.machine, cam, phi, speed),
    ]


def _elastic(machine: Machine, cam: ValveCam, phi: Array, speed: Array) -> list[Row]:
    """What the train gives way at full lift, in micrometres."""
    follower, spring, name = elastic_follower(machine), machine.spring, machine.load_case
    train = ElasticValve(
        follower.mass, follower.stiffness, spring.rate, spring.preload / spring.rate
    )
    top = int(np.argmax(cam.motion(phi)))
    s, slope = (float(cam.motion(phi[top], order)) for order in range(2))
    there = float(speed[top])
    stiff = f"K = {1e-6 * follower.stiffness:.3g} kN/mm of the case, not printed"
    forms = {
        "as printed, its square dropped": s - train.dynamic_lift(s, slope, there, exact=False),
        "by the quadratic": s - train.dynamic_lift(s, slope, there),
    }
    rows = [
        Row(name, f"Deflection at full lift, {how}", 1e6 * float(value), "um",
            f"{_eq('13 and 14')}; {stiff}")
        for how, value in forms.items()
    ]  # fmt: skip
    still = 1e6 * (s - float(train.quasi_static(s)))
    return [
        *rows,
        Row(name, "Deflection at full lift, at rest", still, "um", f"{_eq('12')}; {stiff}"),
    ]


def _eq(numbers: str) -> str:
    return f"eq. {numbers}, {RECONSTRUCTED}"
