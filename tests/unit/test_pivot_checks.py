"""Checks of an arm's pivot on a solved cam, by a balance of forces in axes at rest.

The balance takes nothing from the formulas of a pivot: the contact force is at the normal of the
contour, accelerations are differences of positions.
"""

from dataclasses import replace
from functools import cache, partial

import made_trial as made
import numpy as np
import pytest

from camwright.geometry.lift import Jet
from camwright.pipeline.checks import guide_strength, guide_wear, pivot_bearing
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.guide_pressure import pivot_arrays
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.pivot_history import PivotHistory
from camwright.pipeline.cycle.solution import solution as solve

LENGTH, PIN = 0.060, 0.010  # of the made-up arm and diameter of its pin, m
EIGHTH = (-1 / 560, 8 / 315, -1 / 5, 8 / 5, -205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560)
"""Weights of a second difference of eighth order."""


@cache
def solved(bearing):
    """Preview of the made-up arm of `made_trial`."""
    case = made.arm_case(bearing)
    return solve(case, made.arm_contour(), Tier.PREVIEW, torques={}, positions=144)


def end(contour, theta):
    """End of the arm in axes at rest: x to the pivot, y against the rotation of the cam."""
    arm = contour.pitch.arm
    angle = contour.pitch.start + 0.5 * made.STROKE * (1.0 - np.cos(theta)) / arm.length
    return np.array([arm.centre_distance - arm.length * np.cos(angle), arm.length * np.sin(angle)])


def second(of, theta, step=0.02):
    """Second derivative by the cam angle."""
    return sum(w * of(theta + (k - 4) * step) for k, w in enumerate(EIGHTH)) / step**2


def carried(cycle, force):
    """Load of the pivot (n,), N, of a contact force (n,), and the lever of the contact, m."""
    reaction, normal, arm = balanced(cycle, force)
    return np.hypot(*reaction), arm[1] * normal[0] - arm[0] * normal[1]


def balanced(cycle, force):
    """Load of the pivot (2, n), N, of a contact force (n,), its direction, and the arm, m.

    The spring pulls against the travel of the roller, and the whole mass is there.
    """
    contour, theta, machine = cycle.contour, cycle.theta, cycle.machine
    cos, sin = np.cos(theta), np.sin(theta)
    nx, ny = contour.local_frame(theta).normal
    normal = np.stack([cos * nx + sin * ny, cos * ny - sin * nx])
    arm = end(contour, theta) - np.array([[0.070], [0.0]])
    outwards = np.stack([arm[1], -arm[0]]) / LENGTH
    spring = machine.spring.preload + machine.spring.rate * 0.005 * (1.0 - cos)
    thrown = machine.mass * machine.cam_speed**2 * second(partial(end, contour), theta)
    return thrown - force * normal + spring * outwards, normal, arm


def pushes_of(cycle, slices=1000):
    """Pushes of a rigid pin on both sides of its bush (n,), N, and its mean line load on the more
    loaded one times the length of the bush.

    Shift and tilt of the pin by Newton's method for the balance of slices; the couple is that of
    the contact.
    """
    bush, (reaction, normal, _) = (
        cycle.machine.pivot.bush,
        balanced(cycle, cycle.loads.normal_force),
    )
    force = np.abs(np.sum(reaction * normal, axis=0))
    aside = normal[0] * reaction[1] - normal[1] * reaction[0]
    length, gap, modulus = bush.length, 0.5 * bush.clearance, bush.foundation_modulus
    step = length / slices
    z = (np.arange(slices) + 0.5) * step - 0.5 * length
    wanted = np.stack([force, cycle.follower_moment])
    moved = np.stack([gap + force / (modulus * length), 4.0 * gap / length + 0.0 * force])
    for _ in range(60):
        sunk = moved[0] + moved[1] * z[:, None]
        line = modulus * np.sign(sunk) * np.maximum(np.abs(sunk) - gap, 0.0)
        pressed = modulus * (np.abs(sunk) > gap) + 1e-9 * modulus
        left = wanted - step * np.stack([line.sum(axis=0), z @ line])
        on, turn, both = (step * (z**k @ pressed) for k in (0, 2, 1))
        size = on * turn - both**2
        moved = (
            moved
            + np.stack([turn * left[0] - both * left[1], on * left[1] - both * left[0]]) / size
        )
    assert (np.abs(left[0]) < 1e-6 * force.max()).all()
    reach = np.minimum(length, 0.5 * length - (gap - moved[0]) / moved[1])
    push = step * np.maximum(line, 0.0).sum(axis=0)
    bearing = np.hypot(push / reach * length, aside)
    return step * np.hypot(line, aside / length).sum(axis=0), bearing


def loads_of(cycle):
    return carried(cycle, cycle.loads.normal_force)[0]


def swing(cycle):
    """Angular speed of the arm (n,), rad/s."""
    return cycle.machine.cam_speed * np.abs(0.005 * np.sin(cycle.theta)) / LENGTH


def demand(declared, bearing="bush"):
    return declared(solved(bearing)).demand


def test_bush_of_a_solved_arm_by_the_balance_of_its_forces():
    """pivot_pressure, pv, speed, wear, temperature, expansion; the lift's spline holds 1e-4."""
    cycles, area = solved("bush").cycles, PIN * 0.020
    pushes = [pushes_of(each) for each in cycles]
    pressure = max(bearing.max() / area for _, bearing in pushes)
    assert demand(guide_strength.pivot_pressure) == pytest.approx(pressure, rel=2e-3)
    rubbing = [rubbed for rubbed, _ in pushes]
    assert (rubbing[0] > 1.2 * loads_of(cycles[0])).any()
    pv = max((load * swing(each) * 0.5 * PIN).mean() / area
             for load, each in zip(rubbing, cycles, strict=True))  # fmt: skip
    assert demand(guide_strength.pivot_pv) == pytest.approx(pv, rel=5e-4)
    speed = max((swing(each) * 0.5 * PIN).max() for each in cycles)
    assert demand(guide_strength.pivot_speed) == pytest.approx(speed, rel=5e-4)
    assert demand(guide_wear.pivot_wear) == pytest.approx(1e-17 * pv * 3.6e6, rel=5e-4)
    heat = 0.0
    for each, load in zip(cycles, rubbing, strict=True):
        force = each.parts.friction.greatest.normal_force
        moment = 0.2 * 0.5 * PIN * carried(each, force)[0] * load / loads_of(each)
        heat = max(heat, (moment * swing(each)).mean())
    wall = np.log(1.5) / (2.0 * np.pi * 0.25 * 0.020)
    warm = 40.0 + heat * (wall + 2.0)
    assert warm > 40.5
    hot = demand(guide_strength.pivot_temperature)
    assert hot - 40.0 == pytest.approx(warm - 40.0, rel=5e-4)
    free, square = 8e-5 * (warm - 20.0) + 0.002, 1.5**2
    closed = PIN * free * (square - 1.0) * 1.4 / (1.0 + 0.2 * square)
    grown = closed + PIN * 1.2e-5 * (warm - 20.0)
    assert demand(guide_wear.pivot_expansion) == pytest.approx(grown, rel=1e-4)


def test_jam_indices_of_a_solved_arm_by_moments():
    """pivot_jam_index, nominal and at friction_max: moment of the friction over the contact's,
    at the nominal share of the pushes on both sides of the bush in its load.
    """
    for declared, friction, worst in (
        (pivot_bearing.pivot_jam_index, 0.1, False),
        (pivot_bearing.pivot_jam_index_friction_max, 0.2, True),
    ):
        greatest = 0.0
        for each in solved("bush").cycles:
            loads = each.parts.friction.greatest if worst else each.loads
            load, lever = carried(each, loads.normal_force)
            share = friction * 0.5 * PIN * load / (loads.normal_force * lever)
            share = share * pushes_of(each)[0] / loads_of(each)
            greatest = max(greatest, share[np.sin(each.theta) > 1e-6].max())
        assert demand(declared) == pytest.approx(greatest, rel=5e-4)


def test_needles_of_a_solved_arm_by_the_path_that_it_swings():
    """pivot_static and pivot_life: the damage of each step of the path to the power 10/3."""
    cycles = solved("needle_bearing").cycles
    safety = min(12e3 / loads_of(each).max() for each in cycles)
    assert demand(pivot_bearing.pivot_static, "needle_bearing") == pytest.approx(safety, rel=5e-4)
    lives = []
    for each in cycles:
        turn = 2.0 * np.pi / each.machine.cam_speed
        swung = swing(each) * turn / each.theta.size / (2.0 * np.pi)  # turns at each angle
        used = ((loads_of(each) / 10e3) ** (10.0 / 3.0) * swung).sum() / 1e6
        lives.append(turn / used)
    life = demand(pivot_bearing.pivot_life, "needle_bearing")
    assert life == pytest.approx(min(lives), rel=2e-3)


MEASURED = (
    *("pivot_pressure", "pivot_pv", "pivot_wear", "pivot_jam_index"),
    *("pivot_jam_index_friction_max", "pivot_temperature", "pivot_speed"),
    *("pivot_static", "pivot_life"),
)


@pytest.mark.parametrize("name", MEASURED)
def test_measures_are_differentiated_by_a_complex_step(name):
    """By the lift, its derivatives and the prime radius, against differences of fourth order."""
    whole = solved("needle_bearing" if name in ("pivot_static", "pivot_life") else "bush")
    theta = np.radians(np.array([40.0, 130.0, 220.0, 320.0]))
    numbers, jet = whole.numbers, made.arm_contour().lift.jet(theta, 2)

    def measured(x):
        moved = Jet(*(each * (1.0 + (0.3 + k) * x) for k, each in enumerate(jet[:3])))
        at = numbers | {"cam.prime_radius": numbers["cam.prime_radius"] * (1.0 + 0.1 * x)}
        return DECLARED[name].measure(LoadedCam(moved, at, made.STROKE))

    step, h = 1e-30, 1e-3
    exact = np.imag(measured(1j * step)) / step
    near, far = (measured(k * h) - measured(-k * h) for k in (1.0, 2.0))
    difference = (8.0 * near - far) / (12.0 * h)
    np.testing.assert_allclose(exact, difference, rtol=0, atol=1e-8 * np.abs(difference).max())


def by_elements(**values):
    """The made-up solution with a pin in its bush by made-up finite elements."""
    base = made.cycle(made.arm_contour())
    wave = 1.0 + made.WAVE
    pressure = np.zeros((8, 3))
    pressure[0, 2] = 1.0
    figures = {
        "edge_pressure": 10e6 * wave, "foundation": 14e6 * wave, "tilt": 1e-3 * wave,
        "line": 1e3 * wave[:, None] * np.array([-1.0, 0.0, 2.0]), "places": np.linspace(-1, 1, 3),
        "angles": 0.25 * np.pi * np.arange(8), "pressure": 20e6 * pressure,
        "worst": int(np.argmax(wave)), "coarse": 19e6, "solved": 30, "difference": 0.004,
        "equilibrium": 1e-12, "complementarity": 1e-13,
    }  # fmt: skip
    pivot = PivotHistory(**(figures | values))
    parts = replace(base.parts, pivot_edge_pressure=pivot.edge_pressure)
    cycle = made.changed_cycle(base, pivot=pivot, parts=parts)
    return made.arm_solution(cycles=(cycle,))


def test_edge_pressure_by_elements_has_the_foundation_and_two_meshes_beside_it():
    """19 MPa on the coarse mesh and 20 on the fine one: 3/20 of error."""
    solution = by_elements()
    demand = guide_strength.pivot_edge_pressure(solution).demand
    check = DECLARED["pivot_edge_pressure"](solution)
    assert check.demand == demand == pytest.approx(20e6)
    assert "28 MPa by a rigid pin in slices" in check.note
    assert "tilts by 2 mrad" in check.note and "15 % of two meshes" in check.note
    assert "finite elements along their axis" in check.method
    (barred,) = with_error_bars(solution, [check])
    assert barred.error_share == pytest.approx(0.15, abs=2e-3)


def test_a_contact_that_no_elements_resolve_is_told_to_be_by_slices():
    """At the depth of a run; a preview has slices by its method."""
    solution = made.arm_solution()
    assert solution.cycles[0].contact.tier is Tier.CYCLE
    check = DECLARED["pivot_edge_pressure"]
    assert "by slices: the contact is narrower than the grid" in check(solution).note
    contact = replace(solution.cycles[0].contact, tier=Tier.PREVIEW)
    preview = made.arm_solution(cycles=(made.changed_cycle(solution.cycles[0], contact=contact),))
    assert "finite elements" not in check(preview).note


@pytest.mark.parametrize("name", ["equilibrium", "complementarity"])
def test_residuals_of_the_contact_are_those_of_the_pin_too(name):
    plain = DECLARED[f"contact_{name}"](by_elements())
    assert plain.demand < 1e-8
    assert DECLARED[f"contact_{name}"](by_elements(**{name: 1e-3})).demand == 1e-3


def test_file_of_the_pivot_by_elements():
    """Hat functions around the bore and along it, the row of the greatest pressure, signs."""
    (cycle,) = by_elements().cycles
    arrays = pivot_arrays([cycle])
    angle, pressure = arrays["bore_angle_deg"], arrays["bore_pressure_MPa"]
    assert pressure.shape == (81, 721) and arrays["position_mm"].shape == (81,)
    assert pressure[-1, 360] == pytest.approx(20.0)
    assert pressure[60, angle == 22.5] == pytest.approx(5.0)
    assert pressure[-1, angle == -22.5] == pytest.approx(10.0)
    line = arrays["line_load_N_per_mm"][int(arrays["worst_row"])]
    assert line[[0, 20, 40, 80]].tolist() == pytest.approx([-2.0, -1.0, 0.0, 4.0])
    columns = {each.name: values for each, values in cycle.columns().items()}
    assert columns["pivot_edge_pressure_foundation"].max() == pytest.approx(28e6)
    assert columns["pivot_tilt"].max() == pytest.approx(2e-3)
