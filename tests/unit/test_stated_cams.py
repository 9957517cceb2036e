"""Demand of every check with a measure on a loaded cam of stated fields, by hand, and three cases.

The fields are those of `made_trial` in closed form, the demands those of the registries: a measure
and its value are tried without a cycle. On three small solved cases every check is at 0.99 and 1.01
of its limit what it is to be.
"""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import hand_calculations as by_hand
import made_trial as made
import numpy as np
import pytest
from check_registry import BY_ID, TRIED
from given_cam import STILL, GivenCam
from test_gas_spring import LIMITS, TABLE, gas_case

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.lift import Jet
from camwright.geometry.pitch_curve import RollerMotion
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import ROUNDING
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import AnyLimit
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import OfGuides
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.cycle.solution import solution as solve
from camwright.pipeline.cycle.solved_cam import in_load_case
from camwright.pipeline.follower.guide_friction import thermal_resistance
from camwright.pipeline.follower.wound_wire import SpringWork

MEASURED = [each.id for each in CHECKS if each.measured is not None]
FORCE, PRESSURE = 300.0 + 100.0 * made.WAVE, 1e6 * (800.0 + 100.0 * made.WAVE)
PUSHES = OfGuides(np.abs(500.0 * made.WAVE), np.abs(200.0 * made.WAVE))


def harmonic(theta: Array, stroke: float = made.STROKE, lobes: int = 1) -> Jet:
    """s = h/2 (1 - cos k theta) and its derivatives."""
    half, at = 0.5 * stroke, lobes * theta
    waves = -np.cos(at), np.sin(at), np.cos(at), -np.sin(at)
    lift, *rest = (half * lobes**order * wave for order, wave in enumerate(waves))
    return Jet(half + lift, *rest)


DENSE = np.linspace(0.0, FULL_TURN, 72_001)
TURN = {"jet": harmonic(made.THETA), "highest": made.STROKE}
TOP = {"jet": Jet(np.array([made.STROKE]), *(np.zeros(1) for _ in range(3)))}
STATED: dict[str, dict[str, Any]] = {
    "contour": {"jet": harmonic(DENSE), "highest": made.STROKE},
    "top": TOP,
    "case": {"jet": STILL},
}
"""By the word of the reduction; any other has the forces of a load case."""
LOADED = {
    **TURN,
    "normal": FORCE,
    "surged": by_hand.surged_force(),
    "torque": by_hand.DRIVE,
    "jam": 0.2 + 0.1 * made.WAVE,
    "jam_tilted": 1.0,
    "bush_rubbing": 1.2,
    "jam_worst": 0.3 + 0.1 * made.WAVE,
    "p0": PRESSURE,
    "p0_signed": 1.25 * PRESSURE,
    "half_width": np.full(made.POSITIONS, 1e-4),
    "follower_moment": np.ones(made.POSITIONS),
    "spin_mean": [by_hand.roller_spin().mean()],
    "rubbing": PUSHES,
    "bearing": PUSHES,
    "least_spring": [made.PRELOAD],
}


def hollow(numbers: Numbers) -> dict[str, Any]:
    """Three lobes on a small base."""
    jet = harmonic(DENSE, lobes=3)
    return {"jet": jet, "motion": RollerMotion(jet, 0.03, 0.0, numbers["roller.radius"])}


def warm(numbers: Numbers) -> dict[str, Any]:
    """Power that heats both bushes to 330 K."""
    guides = numbers.known_case.guides
    watts = (
        np.full(made.POSITIONS, (330.0 - guides.ambient_temperature) / thermal_resistance(each))
        for _, each in guides.both
    )
    return {**TURN, "heat": OfGuides(*watts)}


def surging(numbers: Numbers) -> dict[str, Any]:
    """Work of the spring between its least and its greatest force with surge."""
    work = SpringWork(by_hand.LEAST, by_hand.TOP, made.STROKE, by_hand.RATE)
    return {**TOP, "stressed": work, "fatigued": work}


def on_arm(numbers: Numbers) -> dict[str, Any]:
    """Forces on the arm of the made-up solution, on the contour of a stem."""
    path = RollerMotion(TURN["jet"], made.BASE, 0.0, numbers["roller.radius"])
    return {**LOADED, "axial": FORCE, "motion": path}


def pivoted(numbers: Numbers) -> dict[str, Any]:
    """Load of a pivot, and power that heats its bush to 330 K."""
    pivot = numbers.known_case.follower.pivot
    assert pivot is not None
    watts = np.ones(made.POSITIONS)
    if pivot.bush is not None:
        watts *= (330.0 - pivot.ambient_temperature) / thermal_resistance(pivot.bush)
    load = 500.0 * np.abs(made.WAVE)
    return {**LOADED, "bush_bearing": 1.5, "pivot_load": load, "pivot_heat": watts}


def in_groove(numbers: Numbers) -> dict[str, Any]:
    """Solved forces on the walls of the groove, the outer one at the negative roller radius."""
    loads = made.in_groove().cycles[0].loads
    jet = made.contour().lift.jet(loads.theta, 2)
    path = RollerMotion(jet, made.BASE, 0.0, loads.wall * numbers["roller.radius"])
    return {"normal": loads.normal_force, "wall": loads.wall, "motion": path}


def in_steps(numbers: Numbers) -> dict[str, Any]:
    """Solved forces on both rollers of a groove of two steps, the second of 7 mm on the outer
    wall.
    """
    (cycle,) = made.in_steps().cycles
    loads, jet = cycle.loads, made.contour().lift.jet(cycle.theta, 2)
    radius = np.where(loads.wall < 0.0, -0.007, numbers["roller.radius"])
    path = RollerMotion(jet, made.BASE, 0.0, radius)
    return {
        "jet": jet, "normal": loads.normal_force, "surged": loads.normal_force,
        "wall": loads.wall, "motion": path, "speed": cycle.cam_speed,
    }  # fmt: skip


def pressed(numbers: Numbers) -> dict[str, Any]:
    """Solved forces and preload of both discs of a pair."""
    solution = made.preloaded()
    cam = solution.cams[solution.cycles[0]]
    return {
        name: getattr(cam, name)
        for name in ("jet", "normal", "axial", "motion", "squeeze", "on_bodies", "speed")
    }


OTHER: dict[str, Callable[[Numbers], dict[str, Any]]] = {
    "arm_yield": on_arm,
    "rocker_yield": on_arm,
    **dict.fromkeys(
        (
            "pivot_pressure",
            "pivot_pv",
            "pivot_temperature",
            "pivot_speed",
            "pivot_wear",
            "pivot_static",
            "pivot_life",
        ),
        pivoted,
    ),
    "concave_radius": hollow,
    "groove_wall": in_groove,
    "preload_waviness": pressed,
    **dict.fromkeys(
        (
            f"second_roller_{each}"
            for each in (
                *("life", "static", "load_share", "radial", "static_radial", "modified_life"),
                *("speed", "lubrication", "ring_fatigue"),
            )
        ),
        in_steps,
    ),
    "guide_temperature_A": warm,
    "guide_temperature_B": warm,
    "spring_stress": surging,
    "spring_fatigue": surging,
}


def stated(one: Declaration, numbers: Numbers) -> GivenCam:
    how = one.measured
    assert how is not None
    if one.id in OTHER:
        return GivenCam(numbers, **OTHER[one.id](numbers))
    return GivenCam(numbers, **STATED.get(how.reduce, LOADED))


@pytest.mark.parametrize("name", MEASURED)
def test_the_demand_on_a_stated_cam_is_that_by_hand(name: str) -> None:
    one, tried = BY_ID[name], TRIED[name]
    how, solved = one.measured, tried.base()
    assert how is not None
    assert one.measure is not None
    numbers = in_load_case(solved.numbers, solved.machines[0])
    cam = stated(one, numbers)
    if how.known is not None:
        numbers = numbers | how.known([cam])
    of_angles = np.asarray(one.measure(cam))
    reduced = np.max if how.worst == "greatest" else np.min
    worst = np.mean(of_angles) if how.reduce in ("mean", "wear", "life") else reduced(of_angles)
    demand = float(np.ravel(how.value(worst, numbers))[0])
    assert in_unit(demand, one.unit) == pytest.approx(tried.hand, rel=5e-4, abs=1e-15)


def test_a_stated_field_is_one_of_a_loaded_cam() -> None:
    with pytest.raises(AssertionError, match="no \\['norml'\\]"):
        GivenCam(made.solution().numbers, norml=[1.0])
    cam = GivenCam(made.solution().numbers, normal=[300.0, 250.0], speed=2.0)
    np.testing.assert_array_equal(cam.normal, [300.0, 250.0])
    np.testing.assert_array_equal(cam.inertia_at(cam.speed), [0.0])


SMALL: dict[str, Callable[[], Case]] = {
    "roller": made.case,
    "face": made.face_case,
    "arm": made.arm_case,
    "needles": lambda: made.arm_case("needle_bearing"),
    "gas spring": lambda: gas_case(table=f"{TABLE}{LIMITS}"),
}


@cache
def small(name: str) -> Solution:
    """A preview at 24 angles."""
    case = SMALL[name]()
    shapes = {"face": made.face_contour, "arm": made.arm_contour, "needles": made.arm_contour}
    shape = shapes.get(name, made.contour)()
    return solve(case, shape, Tier.PREVIEW, torques=engine_torques(case), positions=24)


def evaluated(name: str) -> list[str]:
    """Checks of the design with a finite use on a small case."""
    solved = small(name)
    made_there = {each.id: each(solved) for each in CHECKS if not each.evidence}
    return [
        key
        for key, check in made_there.items()
        if check is not None and check.utilisation is not None and 0.0 < check.utilisation < np.inf
    ]


def with_row(solved: Solution, row: AnyLimit, value: float) -> Solution:
    """The solution with another limit in its case."""
    case = made.changed(solved.case, limits=made.changed(solved.case.limits, **{row.id: value}))
    states = tuple(replace(each, limits=case.limits) for each in solved.machines)
    return replace(solved, case=case, machines=states)


@pytest.mark.parametrize("name", SMALL)
def test_checks_of_a_small_case_at_their_limits(name: str) -> None:
    """By the row of the table of limits where it is the limit itself, else by that of the demand.

    A demand within its limit whose error bar reaches it is not proven, and fails.
    """
    solved, by_rows = small(name), 0
    for key in evaluated(name):
        one = BY_ID[key]
        check, row = one(solved), one.limit
        assert check is not None
        assert check.utilisation is not None
        for share, status in ((0.99, "pass"), (1.01, "fail")):
            factor = check.utilisation / share
            factor = factor if one.sense == "at_most" else 1.0 / factor
            value = None if row is None else solved.case.limits[row]
            tried = None if row is None or not value else one(with_row(solved, row, value * factor))
            if tried is not None and tried.demand == check.demand and tried.limit == value * factor:
                by_rows += 1
            else:
                demand = one.demand(solved)
                assert demand is not None
                assert demand.allowed is not None
                tried = one.judged(solved.machine, replace(demand, allowed=demand.allowed * factor))
            assert tried.utilisation == pytest.approx(share, rel=ROUNDING), key
            assert tried.status == ("fail" if tried.not_proven else status), key
    assert by_rows > 20
    assert len(evaluated(name)) > 40
