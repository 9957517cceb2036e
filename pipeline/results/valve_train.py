"""Record of a valve cam's machine motion in ``run.json``.

Equations of Petrescu and Petrescu (2015), see `valve_cam`; rows by equations that are not available
are marked *reconstructed*.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.lift_section import LiftSegments, motion_of
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.cycle.elastic_response import elastic_follower
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.cycle.valve_cam import (
    ElasticValve,
    ValveCam,
    follower_acceleration,
    rise_efficiency,
)
from camwright.pipeline.records.run_summary import ValveTrainRecord, ValveTrainRow
from camwright.pipeline.results.trial import Trial

_ANGLES = 20_000
RECONSTRUCTED = "reconstructed"
_NO_YIELD = "momentary yield of eq. 6.18; no efficiency: force and velocity are both projected"


def _row(load_case: str, name: str, value: float, unit: str, note: str) -> ValveTrainRow:
    """Value of a load case ("": of all), with a note on its source."""
    return {"load_case": load_case, "name": name, "value": value, "unit": unit, "note": note}


def valve_cam(case: Case) -> ValveCam | None:
    """Valve cam of a case with ``[valve_train]`` and a lift by segments; else None."""
    train, lift = case.valve_train, case.lift
    if train is None or not isinstance(lift, LiftSegments):
        return None
    radius = case.facing.contact_radius
    return ValveCam(
        motion_of(lift),
        case.base_circle,
        radius or 0.0,
        case.cam.offset,
        "B" if radius else "C",
        train.cam_mass,
        case.follower.mass,
    )


def valve_record(trial: Trial) -> ValveTrainRecord | None:
    """Entry ``valve_train`` of ``run.json``: module and rows; null without a valve cam."""
    cam, turns = valve_cam(trial.case), [cycle.turn for cycle in trial.cycles]
    return None if cam is None else machine_motion(cam, turns)


def machine_motion(cam: ValveCam, turns: Sequence[Turn]) -> ValveTrainRecord:
    """Module of the cam, and rows of its machine motion in all load cases."""
    rows = [*_shape(cam), *(row for turn in turns for row in _motion(cam, turn))]
    return {"module": cam.module, "rows": rows}


def _shape(cam: ValveCam) -> list[ValveTrainRow]:
    phi = (np.arange(_ANGLES) + 0.5) * (FULL_TURN / _ANGLES)
    index = cam.shape_index(phi[cam.motion(phi, 1) > 0.0])
    return [
        _row("", "Shape index, mean over the rise", float(index.mean()), "-", _NO_YIELD),
        _row("", "Shape index, greatest", float(index.max()), "-", _NO_YIELD),
        _row(
            "",
            "Mean reduced inertia",
            in_unit(cam.mean_reduced_inertia(), "kg mm^2"),
            "kg mm^2",
            f"eqs 1 and 8 to 10, {RECONSTRUCTED}",
        ),
    ]


def _motion(cam: ValveCam, turn: Turn) -> list[ValveTrainRow]:
    """Rows of the record on the uneven shaft speed of a valve cam: efficiency of the rise, shaft
    speed, its acceleration, acceleration of the follower, deflection of the train; in the load case
    of a turn.
    """
    mean, name = turn.machine.cam_speed, turn.machine.load_case
    phi, motion = turn.theta, cam.motion
    speed, turning = cam.speed(phi, mean), cam.angular_acceleration(phi, mean)
    uneven = follower_acceleration(motion(phi, 1), motion(phi, 2), speed, turning)
    uses = "work on spring and mass over work of the cam on the rise, with all friction"
    return [
        _row(name, "True efficiency of the rise", rise_efficiency(turn.loads), "-", uses),
        _row(name, "Shaft speed, least", float(speed.min()), "rad/s", _eq("2 and 3")),
        _row(name, "Shaft speed, greatest", float(speed.max()), "rad/s", _eq("2 and 3")),
        _row(name, "Angular acceleration", float(np.abs(turning).max()), "rad/s^2", _eq("5")),
        _row(
            name,
            "Acceleration of the follower",
            float(np.abs(uneven).max()),
            "m/s^2",
            "eq. 15, at the uneven speed",
        ),
        *_elastic(turn.machine, cam, phi, speed),
    ]


def _elastic(machine: Machine, cam: ValveCam, phi: Array, speed: Array) -> list[ValveTrainRow]:
    """Rows of the record on the deflection of the valve train at full lift, um, by three forms of
    the equations.

    Parameters
    ----------
    machine : Machine    stiffness, mass and spring
    cam : ValveCam       with its motion
    phi : array (n,)     cam angles, rad
    speed : array (n,)   of the cam at them, rad/s
    """
    follower, spring, name = elastic_follower(machine), machine.spring, machine.load_case
    train = ElasticValve(
        follower.mass, follower.stiffness, spring.rate, spring.preload / spring.rate
    )
    top = int(np.argmax(cam.motion(phi)))
    s, slope = (float(cam.motion(phi[top], order)) for order in range(2))
    there = float(speed[top])
    stiff = f"K = {shown(follower.stiffness, 'kN/mm', 3)} of the case"
    forms = {
        "as printed, its square dropped": s - train.dynamic_lift(s, slope, there, exact=False),
        "by the quadratic": s - train.dynamic_lift(s, slope, there),
    }
    rows = [
        _row(name, f"Deflection at full lift, {how}", in_unit(float(value), "um"), "um",
            f"{_eq('13 and 14')}; {stiff}")
        for how, value in forms.items()
    ]  # fmt: skip
    still = in_unit(s - float(train.quasi_static(s)), "um")
    return [
        *rows,
        _row(name, "Deflection at full lift, at rest", still, "um", f"{_eq('12')}; {stiff}"),
    ]


def _eq(numbers: str) -> str:
    return f"eq. {numbers}, {RECONSTRUCTED}"
