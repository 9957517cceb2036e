"""Arm of an oscillating follower as a beam, against free bodies, finite elements and tables.

The references take nothing from the formulas of the arm: forces on a free body of the arm in fixed
axes, beam elements assembled here, a Poisson problem by collocation, and Shigley's formulas.
"""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import chebyshev
from pin_in_hole_elements import pin_in_hole_by_elements
from stated_loads import pivot_reaction

from camwright.geometry.arrays import rotation
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.template import first_case
from camwright.pipeline.checks.arm_strength import arm_forces, arm_yield, bar_of
from camwright.pipeline.checks.part_strength import moving_masses
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.contact.elasticity.radial_compliance import Bush, SolidBar
from camwright.pipeline.contact.pin_in_hole import pin_in_hole
from camwright.pipeline.cycle.cycle import turn_of_line
from camwright.pipeline.cycle.guide_pressure import pivot_arrays
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.part_loads import PivotPush
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.arm_beam import ArmBar, torsion_of_rectangle
from camwright.pipeline.follower.follower_tilt import StemTilt
from camwright.pipeline.follower.guide_contact import BearingLine, settle
from camwright.pipeline.follower.guide_reactions import Guide, lobatto
from camwright.pipeline.follower.pivot_bush import bush_lines, pressed_bush
from camwright.pipeline.follower.roller_parts import Fork, Pin
from camwright.pipeline.follower.shaft_strength import slope_of
from camwright.pipeline.follower.spring_link import SpringLink
from camwright.pipeline.preview import preview_case

STEEL = Material(
    name="steel", E=210e9, nu=0.3, yield_strength=600e6, density=7850.0, source="made up"
)
ARM = """\
[follower]
kind = "oscillating"
mass = "1.1 kg"

[follower.arm]
centre_distance = "110 mm"
length = "100 mm"
swing = "@swing@"
width = "28 mm"
depth = "24 mm"
bore = "20 mm"
hub = "36 mm"
spring_distance = "@spring@"
material = "case_hardened"
pivot_notch = 2.0
roller_notch = 2.5
source = "made up"

"""
SCOPE = """\
[scope]
not_covered = ["pivot"]
reason = "its pivot is judged by its maker"

"""
PIVOT = """\
plane_offset = "4 mm"

[follower.pivot]
pin_material = "case_hardened"
ambient_temperature = "30 degC"

[follower.pivot.bush]
card = "ptfe_lined"
length = "25 mm"
diameter = "16 mm"
wall = "1.5 mm"
clearance = "0.03 mm"
housing_resistance = "2 K/W"
wear_rate = "3e-8 mm^3/N/m"

"""


@cache
def trial(swing="with", spring="0 mm", pivot=SCOPE):
    whole = first_case("swing", "lift").text
    follower = ARM.replace("@swing@", swing).replace("@spring@", spring) + pivot
    text = whole[: whole.index("[follower]")] + follower + whole[whole.index("[lubricant]") :]
    return preview_case(parse_case(text).with_positions(90), corners=False)


# --- Torsion of the rectangle -------------------------------------------------------------------
@pytest.mark.parametrize(("ratio", "modulus", "constant"), [
    (1.0, 0.208, 0.1406), (1.2, 0.219, 0.1661), (1.5, 0.231, 0.1958), (2.0, 0.246, 0.229),
    (2.5, 0.258, 0.249), (3.0, 0.267, 0.263), (5.0, 0.291, 0.291), (10.0, 0.312, 0.312),
])  # fmt: skip
def test_torsion_has_the_factors_of_the_table(ratio, modulus, constant):
    """Timoshenko and Goodier, sec. 109, to the digits printed."""
    twist, stress = torsion_of_rectangle(ratio, 1.0)
    assert twist / ratio == pytest.approx(constant, abs=6e-4)
    assert stress / ratio == pytest.approx(modulus, abs=6e-4)
    assert torsion_of_rectangle(1.0, ratio) == (twist, stress)


@pytest.mark.parametrize("ratio", [1.0, 1.7, 3.0])
def test_torsion_solves_the_equation_of_prandtl(ratio, measured):
    """Laplace(phi) = -2 on a rectangle, by collocation: J = 2 int phi, W_t = J/|dphi/dn|."""
    count = 30
    nodes = np.cos(np.pi * np.arange(count + 1) / count)
    weights = np.r_[2.0, np.ones(count - 1), 2.0] * (-1.0) ** np.arange(count + 1)
    apart = nodes[:, None] - nodes + np.eye(count + 1)
    slope = np.outer(weights, 1.0 / weights) / apart
    slope -= np.diag(slope.sum(axis=1))
    bend, inner, unit = (slope @ slope)[1:-1, 1:-1], count - 1, np.eye(count - 1)
    laplace = 4.0 * np.kron(bend, unit) + 4.0 / ratio**2 * np.kron(unit, bend)
    solved = np.zeros((count + 1, count + 1))
    solved[1:-1, 1:-1] = np.linalg.solve(laplace, -2.0 * np.ones(inner**2)).reshape(inner, inner)
    # x over the short side of 1, y over the long one
    integral = chebyshev.chebint(np.eye(count + 1))
    whole = chebyshev.chebval(1.0, integral) - chebyshev.chebval(-1.0, integral)
    quadrature = whole @ np.linalg.inv(chebyshev.chebvander(nodes, count))
    constant = 2.0 * 0.25 * ratio * quadrature @ solved @ quadrature
    steepest = np.abs(2.0 * slope @ solved)[0].max()
    twist, modulus = torsion_of_rectangle(ratio, 1.0)
    # the corners hold the collocation of 30 to 1e-7
    measured("torsion constant of a rectangle", twist, constant, rtol=1e-6)
    measured("torsion modulus of a rectangle", modulus, constant / steepest, rtol=1e-6)


# --- Compliance ---------------------------------------------------------------------------------
def elements(bar, root, eye, pivot=np.inf, count=12):
    """Deflection at the end per force there, of beam elements on the pivot and at the spring.

    pivot : float   stiffness of its bush, N/m

    Elements of Timoshenko with cubic shape functions, exact between their nodes; the arm is held
    in rotation too where the spring acts at the pivot.
    """
    card, corners = bar.material, sorted({0.0, bar.held, root, bar.length})
    places = np.unique(np.concatenate([
        np.linspace(low, high, count + 1)
        for low, high in pairwise(corners)
    ]))  # fmt: skip
    stiff = np.zeros((2 * places.size, 2 * places.size))
    for k in range(places.size - 1):
        step, middle = places[k + 1] - places[k], 0.5 * (places[k] + places[k + 1])
        b, h = (bar.width, bar.depth) if middle < root else eye
        bent = card.E * b * h**3 / 12.0
        kappa = 10.0 * (1.0 + card.nu) / (12.0 + 11.0 * card.nu)
        shear = kappa * card.E / (2.0 * (1.0 + card.nu)) * b * h
        phi = 12.0 * bent / (shear * step**2)
        one = np.array([
            [12.0, 6.0 * step, -12.0, 6.0 * step],
            [6.0 * step, (4.0 + phi) * step**2, -6.0 * step, (2.0 - phi) * step**2],
            [-12.0, -6.0 * step, 12.0, -6.0 * step],
            [6.0 * step, (2.0 - phi) * step**2, -6.0 * step, (4.0 + phi) * step**2],
        ])  # fmt: skip
        stiff[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += bent / step**3 / (1.0 + phi) * one
    held = 2 * int(np.argmin(np.abs(places - bar.held)))
    fixed = [1] if bar.held == 0.0 else [held]
    if np.isfinite(pivot):
        stiff[0, 0] += pivot
    else:
        fixed.append(0)
    free = [k for k in range(stiff.shape[0]) if k not in fixed]
    load = np.zeros(stiff.shape[0])
    load[-2] = 1.0
    moved = np.zeros(stiff.shape[0])
    moved[free] = np.linalg.solve(stiff[np.ix_(free, free)], load[free])
    return moved[-2]


@pytest.mark.parametrize("held", [0.0, 0.03, 0.075, 0.09])
@pytest.mark.parametrize("forked", [False, True])
def test_an_arm_bends_as_its_beam_elements(held, forked, measured):
    arm = FollowerArm(
        centre_distance=0.11, length=0.1, swing="with", width=0.028, depth=0.024,
        material=STEEL, spring_distance=held,
    )  # fmt: skip
    pin = Pin(diameter=0.017, span=0.023, material=STEEL)
    fork = Fork(cheek_width=0.005, cheek_height=0.022, cheek_length=0.026, material=STEEL)
    bar = ArmBar(
        0.1,
        0.028,
        0.024,
        STEEL,
        arm,
        arm.held(None),
        0.5,
        0.5,
        pin if forked else None,
        fork if forked else None,
    )
    root = 0.1 - 0.026 if forked else 0.1
    # round-off of the short elements
    measured("compliance of an arm", bar.compliance, elements(bar, root, (0.01, 0.022)), rtol=1e-6)


@pytest.mark.parametrize("held", [0.0, 0.03, 0.075])
def test_an_arm_stands_on_the_bush_of_its_pivot(held, measured):
    machine = trial("with", "0 mm", PIVOT).solution.machine
    arm = replace(machine.arm, spring_distance=held)
    members = replace(machine, arm=arm).compliances
    bar, fork = replace(machine.arm_bar, held=held), machine.roller.fork
    root, eye = 0.1 - fork.cheek_length, (2.0 * fork.cheek_width, fork.cheek_height)
    bush = machine.pivot.bush
    stiff = elements(bar, root, eye, bush.foundation_modulus * 0.025)
    both = members["arm"] + members["pivot"]
    measured("compliance of an arm", both, stiff, rtol=1e-6)


def test_the_elastic_follower_stands_on_its_arm():
    """The cantilever of 100 mm beside bearing, pin and camshaft; the fork is part of the arm."""
    machine = trial().solution.machine
    members = machine.compliances
    assert members["arm"] == pytest.approx(machine.arm_bar.compliance)
    assert "fork" not in members and "stem" not in members
    assert machine.axial_stiffness == pytest.approx(1.0 / sum(members.values()), rel=1e-12)
    plain = 0.1**3 / (3.0 * 210e9 * 0.028 * 0.024**3 / 12.0)
    assert plain < members["arm"] < 2.5 * plain  # the cheeks are softer, and shear is added
    stiffer = replace(machine, arm=replace(machine.arm, depth=0.048))
    assert stiffer.follower_frequency > 1.2 * machine.follower_frequency


@pytest.mark.parametrize("forked", [False, True])
def test_a_couple_twists_the_arm_and_bends_its_cheeks_apart(forked):
    """Saint-Venant's bar, and two cantilevers that the couple bends to either side."""
    bar = replace(bar_of(trial().solution.numbers), fork=None)
    card = bar.material
    shear, twist = card.E / 2.6, torsion_of_rectangle(0.028, 0.024)[0]
    slope = 0.1 / (shear * twist)
    if forked:
        fork = Fork(cheek_width=0.005, cheek_height=0.022, cheek_length=0.026, material=STEEL)
        bar = replace(bar, fork=fork, pin=Pin(diameter=0.017, span=0.023, material=STEEL))
        apart = (1.0 / 0.023) * 0.026**3 / (3.0 * card.E * 0.005 * 0.022**3 / 12.0)
        slope = 0.074 / (shear * twist) + 2.0 * apart / 0.023
    assert bar.couple_compliance == pytest.approx(slope, rel=1e-9)


def test_the_drawn_mass_has_the_moment_of_inertia_of_the_bar():
    """In place of the stem, whose stand-in an arm does not have."""
    result = trial()
    bar = bar_of(result.solution.numbers)
    pieces = (np.arange(4000) + 0.5) / 4000 * (0.1 - 0.030)  # up to the bridge of the fork
    mass = bar.material.density * 0.028 * 0.024 * np.sum(pieces**2) * pieces[0] * 2.0 / 0.1**2
    masses = dict(moving_masses(result.solution)[0])
    assert masses["arm"] == pytest.approx(mass, rel=1e-6)
    assert "stem" not in masses


# --- The bush of the pivot ----------------------------------------------------------------------
FORCES = np.array([100.0, 100.0, 100.0, 2e3, 2e3, 2e3, 2e3, 2e3, 2e3, 0.0, 5e3])
COUPLES = np.array([0.1, 0.5, 50.0, 0.0, 5.0, 8.0, 20.0, 30.0, 200.0, 10.0, 62.0])


def bush(clearance):
    bronze = Material(
        name="bronze", E=110e9, nu=0.34, yield_strength=150e6, density=8800.0, source="made up"
    )
    return Guide(
        length=0.025, diameter=0.02, wall=1.5e-3, friction=0.1, clearance=clearance,
        material=bronze, stiffness=2e8,
    )  # fmt: skip


@pytest.mark.parametrize("clearance", [0.0, 30e-6, 60e-6])
def test_a_pin_in_its_bush_as_a_rigid_beam_on_knots(clearance):
    """By the active set of the guides, at 401 knots; linear, triangular and on both edges."""
    seat = bush(clearance)
    load, tilt = on_knots(seat, FORCES, COUPLES, 401)
    pressed = pressed_bush(seat, FORCES, COUPLES)
    # the edge of a contact lies between two knots
    np.testing.assert_allclose(pressed.tilt, tilt, rtol=2e-5, atol=1e-12)
    np.testing.assert_allclose(pressed.line_load, np.abs(load).max(axis=0), rtol=2e-5)


def test_a_pin_in_its_bush_is_continuous_where_its_contact_changes():
    made = bush(60e-6)
    couples = np.linspace(0.0, 40.0, 4001)
    pressed = pressed_bush(made, np.full(4001, 2e3), couples)
    assert (np.diff(pressed.tilt) > 0.0).all() and (np.diff(pressed.line_load) > 0.0).all()
    assert np.diff(pressed.tilt).max() < 20.0 * 60e-6 / 0.025 / 4001 * 40.0
    still = pressed_bush(made, np.zeros(1), np.zeros(1))
    assert still.tilt[0] == still.line_load[0] == 0.0


# --- Loads of the sections ----------------------------------------------------------------------
def forces_in_fixed_axes(solution):
    """Contact force and its place, and the arm, in axes that are at rest; (2, n) each."""
    cycle, contour = solution.cycles[0], solution.contour
    arm, theta = contour.pitch.arm, cycle.theta
    turned = [rotation(-angle) for angle in theta]
    touched = np.stack([r @ contour.points(a) for r, a in zip(turned, theta, strict=True)], axis=1)
    centre = np.stack(
        [r @ contour.pitch.points(a) for r, a in zip(turned, theta, strict=True)], axis=1
    )
    pivot = np.array([arm.centre_distance, 0.0])[:, None]
    normal = (centre - touched) / contour.follower_radius
    return cycle.loads.normal_force * normal, centre - pivot


@pytest.mark.parametrize("swing", ["with", "against"])
@pytest.mark.parametrize("spring", ["0 mm", "60 mm"])
def test_sections_carry_what_a_free_body_of_the_arm_needs(swing, spring):
    """Moment and force in a section, of all that acts between it and the end, with sums of r x F.

    The bar of 1.1 kg less its end in 4000 pieces that are accelerated along their arcs.
    """
    solution = trial(swing, spring).solution
    cam, bar = next(iter(solution.cams.values())), bar_of(solution.numbers)
    force, along = forces_in_fixed_axes(solution)
    unit, cycle = along / np.hypot(*along), solution.cycles[0]
    outwards = solution.contour.pitch.arm.sense * np.array([unit[1], -unit[0]])
    swung = cycle.cam_speed**2 * cam.jet.lift_d2 / bar.length  # rad/s2
    assert np.sum(outwards * force, axis=0) == pytest.approx(cycle.loads.axial_force, rel=1e-9)
    end = bar.end_share * cam.numbers["follower.mass"]
    pieces = (np.arange(4000) + 0.5) / 4000 * bar.length
    bars = 3.0 * (cam.numbers["follower.mass"] - end) / 4000
    closed = cam.spring_force * bar.length / (bar.held or np.inf)
    for section in bar.sections:
        if section.eye:
            continue
        beyond = pieces > section.distance
        lever = bar.length - section.distance
        moment = np.sum(outwards * force, axis=0) * lever - end * swung * bar.length * lever
        arms = pieces[beyond, None] - section.distance
        moment -= np.sum(bars * pieces[beyond, None] * swung * arms, axis=0)
        moment -= closed * max(bar.held - section.distance, 0.0)
        pulled = np.sum(unit * force, axis=0)
        loads = bar.loads(section, arm_forces(cam))
        uneven = 1.0
        if section.cheeks == 2:
            couple = cam.follower_moment / np.hypot(*force)
            uneven = 1.0 + 2.0 * couple / bar.pin.span
        # the pieces of the bar
        scale = bar.length * np.hypot(*force).max()
        np.testing.assert_allclose(loads.bending, moment * uneven, rtol=0, atol=1e-6 * scale)
        np.testing.assert_allclose(loads.along, pulled * uneven, rtol=1e-8)
        if not section.cheeks:
            twisted = cam.follower_moment * np.sum(outwards * force, axis=0) / np.hypot(*force)
            np.testing.assert_allclose(loads.twisting, twisted, rtol=1e-9)


def test_a_linked_spring_presses_the_arm_at_its_end():
    """Along the arm, unless the case states the place; a spring without a link at the pivot."""
    link = SpringLink(arm_radius=0.06, fixed_radius=0.09, fixed_angle=1.0, arm_angle=0.5)
    arm = bar_of(trial().solution.numbers).arm
    assert replace(arm, spring_distance=None).held(link) == pytest.approx(0.06 * np.cos(0.5))
    assert replace(arm, spring_distance=0.03).held(link) == 0.03
    behind = replace(link, arm_angle=2.5, fixed_angle=3.0)
    assert replace(arm, spring_distance=None).held(behind) == 0.0
    assert replace(arm, spring_distance=None).held(None) == 0.0


def test_an_arm_beside_its_roller_is_twisted():
    """10 mm between their middles: the normal force twists the arm and bends it aside."""
    solution = trial().solution
    cam, bar = next(iter(solution.cams.values())), bar_of(solution.numbers)
    beside = replace(bar, arm=replace(bar.arm, plane_offset=0.01))
    forces = arm_forces(cam)
    plain, off = (each.loads(each.pivot[0], forces) for each in (bar, beside))
    np.testing.assert_allclose(off.twisting - plain.twisting, 0.01 * cam.axial, rtol=1e-9)
    np.testing.assert_allclose(
        off.sideways - plain.sideways, 0.01 * forces.along, rtol=1e-7, atol=1e-9
    )


@pytest.mark.parametrize("beside", [0.0, 0.008])
def test_the_line_of_contact_is_tilted_by_the_twist_of_its_arm(beside):
    """In place of a stem in guides: twist by the force beside the middle, and no clearance."""
    solution = trial().solution
    machine, cycle = solution.machine, solution.cycles[0]
    arm = replace(machine.arm, plane_offset=beside)
    turn = turn_of_line(cycle)._replace(machine=replace(machine, arm=arm))
    bar = bar_of(solution.numbers)
    beside += machine.stem_offset
    twisted = bar.couple_compliance * beside * cycle.loads.normal_force
    np.testing.assert_allclose(turn.tilt.twist, twisted, rtol=1e-12)
    np.testing.assert_allclose(
        turn.tilt.forced - np.abs(turn.shaft) - turn.tilt.parallelism - turn.tilt.run_out, twisted,
        rtol=0, atol=1e-12,
    )  # fmt: skip
    yields = bar.couple_compliance + slope_of(machine.camshaft).couple
    assert turn.tilt_compliance == pytest.approx(yields, rel=1e-12)
    if twisted.any():
        words = turn.tilt.sentence(int(np.argmax(twisted)))
        assert "twist of the arm" in words and "pivot clearance" in words and "guide" not in words


def on_knots(bush, force, couple, knots=201):
    """Line loads (knots, n), N/m, and tilt (n,) of a rigid pin, by the active set of the guides."""
    (unit, weight), half = lobatto(knots), 0.5 * bush.length
    line = BearingLine(
        positions=half * (1.0 + unit), weights=half * weight,
        foundation=np.full(knots, bush.foundation_modulus),
        play=np.full(knots, 0.5 * bush.clearance),
        compliance=np.zeros((knots, knots)), edges=np.array([0, knots - 1]),
    )  # fmt: skip
    push, rigid = settle(line, force, half * force + couple)
    return push / (half * weight)[:, None], rigid[1]


def test_an_arm_tilts_in_the_bush_of_its_pivot():
    """4 mm beside the roller: clearance over length, load at the bush's end, its foundation."""
    solution = trial("with", "0 mm", PIVOT).solution
    machine, cycle = solution.machine, solution.cycles[0]
    turn, bar, bush = turn_of_line(cycle), bar_of(solution.numbers), solution.machine.pivot.bush
    force, load = cycle.loads.normal_force, np.hypot(*cycle.loads.pivot_load)
    turned = on_knots(bush, np.array([1e6]), np.array([1.0]))[1][0]  # flat on the pin
    beside = force * (0.004 + machine.stem_offset)
    np.testing.assert_allclose(
        turn.tilt.twist, (bar.couple_compliance + turned) * beside, rtol=1e-6
    )
    assert turn.tilt.guides == pytest.approx(0.03e-3 / 0.025, rel=1e-12)
    np.testing.assert_allclose(turn.held, 0.0125 * load + 0.004 * force, rtol=1e-12)
    yields = bar.couple_compliance + turned + slope_of(machine.camshaft).couple
    assert turn.tilt_compliance == pytest.approx(yields, rel=1e-6)
    stiff = trial().solution.cycles[0]
    assert (turn.tilt.greatest > turn_of_line(stiff).tilt.greatest).all()


def test_a_pin_by_finite_elements_tilts_the_line_in_place_of_its_foundation():
    """Its slope per couple at each angle, in the twist and in what yields to a forced tilt."""
    solution = trial("with", "0 mm", PIVOT).solution
    cycle, bar = solution.cycles[0], bar_of(solution.numbers)
    pin = 1e-5 * (2.0 + np.cos(cycle.theta))
    turn = turn_of_line(cycle)._replace(pin=pin)
    beside = cycle.loads.normal_force * (0.004 + solution.machine.stem_offset)
    np.testing.assert_allclose(turn.tilt.twist, (bar.couple_compliance + pin) * beside, rtol=1e-12)
    yields = bar.couple_compliance + pin + slope_of(solution.machine.camshaft).couple
    np.testing.assert_allclose(turn.tilt_compliance, yields, rtol=1e-12)
    np.testing.assert_allclose(turn.loads.compliance, yields[turn.rows], rtol=1e-12)
    stem = StemTilt(solution.machine.stem, solution.machine.guides)
    assert stem.on_pin(pin) is stem


@pytest.mark.parametrize("swing", ["with", "against"])
def test_edge_pressure_of_the_pivot_over_the_turn(swing, measured):
    """Reaction and contact in axes at rest, line load on knots, and the pin in its hole.

    The couple of the contact is about the tangent of the cam, in the plane of its normal.
    """
    solution = trial(swing, "0 mm", PIVOT).solution
    cycle, bush = solution.cycles[0], solution.machine.pivot.bush
    force, _ = forces_in_fixed_axes(solution)
    size = np.hypot(*force)
    on_arm = pivot_reaction(cycle.loads) * np.array([[1.0], [-1.0]])  # y against the rotation
    on_arm = -on_arm  # of the pin on the arm, of the arm on its pin
    normal = force / size
    pressed = np.sum(normal * on_arm, axis=0)
    beside = normal[0] * on_arm[1] - normal[1] * on_arm[0]
    couple = cycle.follower_moment + 0.004 * size
    lines, _ = on_knots(bush, np.abs(pressed), couple)
    load = np.hypot(np.abs(lines).max(axis=0), beside / bush.length)
    k = int(np.argmax(load))
    pin, bore = SolidBar(206e9, 0.3), Bush(bush.material.E, bush.material.nu, 2.0 * 1.5 / 16.0)
    edge = cycle.parts.pivot_edge_pressure
    assert int(np.argmax(edge)) == k
    one = pin_in_hole(float(load[k]), 0.008, 0.015e-3, pin, bore)
    measured("edge pressure of a pivot", edge[k], one.peak_pressure, rtol=5e-3)
    check = DECLARED["pivot_edge_pressure"](solution)
    assert check.demand == max(c.parts.pivot_edge_pressure.max() for c in solution.cycles)
    window = 1.4 * one.contact_angle
    _, solved = pin_in_hole_by_elements(load[k] / 0.008, 0.015 / 8.0, pin, bore, window)
    peak = float(solved.pressure[0].max())
    measured("edge pressure of a pivot by elements", edge[k], peak, rtol=0.02)


def test_line_loads_of_the_bush_over_the_turn_add_up_to_the_reaction():
    """Along the bush in equilibrium with force and couple; around it with each slice."""
    solution = trial("with", "0 mm", PIVOT).solution
    cycle, bush = solution.cycles[0], solution.machine.pivot.bush
    places = np.linspace(-0.5, 0.5, 20_001) * bush.length
    force, couple = FORCES[:-1], COUPLES[:-1]
    lines = bush_lines(bush, force, couple, places)
    np.testing.assert_allclose(np.trapezoid(lines, places, axis=0), force, rtol=1e-6, atol=1e-6)
    turned = np.trapezoid(lines * places[:, None], places, axis=0)
    np.testing.assert_allclose(turned, couple, rtol=1e-6, atol=1e-6)
    arrays = pivot_arrays(solution.cycles)
    first, k = arrays["line_load_N_per_mm"][: cycle.theta.size], int(arrays["worst_row"])
    along = arrays["position_mm"]
    push = PivotPush.of(solution.machine, cycle.loads, cycle.follower_moment)
    load = np.hypot(push.force, push.beside * bush.length)
    np.testing.assert_allclose(load, np.hypot(*cycle.loads.pivot_load), rtol=1e-9)
    inplane = np.sign(first) * np.sqrt(np.maximum(first**2 - (1e-3 * push.beside[:, None]) ** 2, 0))
    # 81 places on the ends of a contact
    pressed = np.trapezoid(inplane, along, axis=1)
    both = np.trapezoid(np.abs(inplane), along, axis=1)
    assert (np.abs(pressed - push.force) <= 2e-2 * both).all()
    around, angle = arrays["bore_pressure_MPa"], np.radians(arrays["bore_angle_deg"])
    slices = np.trapezoid(around * np.cos(angle), angle, axis=1) * 0.5e3 * bush.diameter
    line = arrays["line_load_N_per_mm"][k]
    np.testing.assert_allclose(slices, line, rtol=5e-3, atol=5e-3 * np.abs(line).max())
    peak = max(c.parts.pivot_edge_pressure.max() for c in solution.cycles)
    assert around.max() == pytest.approx(1e-6 * peak, rel=5e-3)


# --- Demands ------------------------------------------------------------------------------------
def stresses(section, loads):
    """Stress tensors (3, 3, n) at the corners of a section, Pa, without notch."""
    b, h, d = section.width, section.depth, section.hole
    inertia = b * (h**3 - d**3) / 12.0
    bars = [b] if d == 0.0 else [b, b]
    twisted = sum(torsion_of_rectangle(each, (h - d) / len(bars))[1] for each in bars)
    for one in (1.0, -1.0):
        for other in (1.0, -1.0):
            pull = loads.along / (b * (h - d)) + one * loads.bending * 0.5 * h / inertia
            pull = pull + other * loads.sideways * 0.5 * b / ((h - d) * b**3 / 12.0)
            tensor = np.zeros((3, 3, pull.size))
            tensor[0, 0] = pull
            tensor[0, 1] = tensor[1, 0] = loads.twisting / twisted
            yield tensor


def mises(tensor):
    """By the invariants of the deviator."""
    mean = np.trace(tensor)[None, None] / 3.0 * np.eye(3)[:, :, None]
    return np.sqrt(1.5 * np.sum((tensor - mean) ** 2, axis=(0, 1)))


@pytest.mark.parametrize("spring", ["0 mm", "60 mm"])
def test_fatigue_and_yield_of_the_arm_by_stress_tensors(spring):
    """`arm_fatigue_pivot`, `arm_fatigue_roller` and `arm_yield` of a preview."""
    result = trial("with", spring)
    solution = result.solution
    checks = {each.id: each for each in result.checks}
    bar = bar_of(solution.numbers)
    card, arm = bar.material, bar.arm
    assert arm.surface == "machined"
    tensile = card.tensile_strength / 1e6
    common = 4.51 * tensile**-0.265 * (1.0 - 0.08 * 2.3263479) * card.fatigue_bending
    greatest = 0.0
    for end, sections, notch in (("pivot", bar.pivot, 2.0), ("roller", bar.roller, 2.5)):
        safety = np.inf
        for section in sections:
            across = 0.808 * np.sqrt(section.width * (section.depth - section.hole)) * 1e3
            endured = common * min(1.0, (across / 7.62) ** -0.107)
            for cam in solution.cams.values():
                loads = bar.loads(section, arm_forces(cam))
                for tensor in stresses(section, loads):
                    notched = notch * tensor
                    high, low = notched.max(axis=2), notched.min(axis=2)
                    swing, mean = (mises(0.5 * (high + s * low)[..., None]) for s in (-1.0, 1.0))
                    used = float(swing[0] / endured + mean[0] / card.tensile_strength)
                    safety = min(safety, 1.0 / used)
                    greatest = max(greatest, float(mises(notched).max()))
        demand = checks[f"arm_fatigue_{end}"].demand
        assert demand == pytest.approx(safety, rel=1e-8)
    # the corner of equal signs is an upper bound of the four
    assert checks["arm_yield"].demand == pytest.approx(greatest, rel=1e-8)


@pytest.mark.parametrize("number", range(3))
def test_yield_of_the_arm_has_complex_derivatives(number):
    """Against five-point differences, whose error and round-off are below 1e-8 of the greatest."""
    solution = trial("with", "60 mm").solution
    cam = next(iter(solution.cams_between.values()))
    rows = slice(5 + 40 * number, 25 + 40 * number)
    jet = cam.contour.lift.jet(cam.loads.theta[rows], 2)

    def stress(lift, slope):
        moved = jet._replace(lift=jet.lift + lift, slope=jet.slope + slope)
        return DECLARED["arm_yield"].measure(LoadedCam(moved, cam.numbers, cam.highest))

    assert arm_yield.measure is DECLARED["arm_yield"].measure
    for along in ((1.0, 0.0), (0.0, 1.0)):
        step = 1e-30j
        exact = stress(*(each * step for each in along)).imag / 1e-30
        h = 1e-5
        steps = ((1.0, -2.0), (-8.0, -1.0), (8.0, 1.0), (-1.0, 2.0))
        differences = sum(
            weight * stress(*(count * h * each for each in along)) for weight, count in steps
        ) / (12.0 * h)
        scale = np.abs(exact).max()
        np.testing.assert_allclose(differences, exact, rtol=0, atol=1e-8 * scale)
