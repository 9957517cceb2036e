"""Conjugate discs by other formulations: forces, contact, spin, landings, energy and their limits.

The cases are tests/data/conjugate_feeder.toml, opposite rollers on a stem, here with another second
roller and a lift whose rise and return differ, and conjugate_arm.toml, two arms on one pivot;
beside them groove_arm.toml, the roller of an arm in a groove.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from held_cams import (
    assert_as_closed_by_a_strong_spring,
    assert_refused,
    ids_where_all_pass,
    landing_of,
    running_in,
    turned_by_friction,
)
from scipy.integrate import cumulative_trapezoid, solve_ivp

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.form_closure import groove_wall
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.checks import contact_strength
from camwright.pipeline.checks.arm_strength import arm_forces, bars_of
from camwright.pipeline.checks.contact_strength import conforming_sentence
from camwright.pipeline.checks.demands import PRESSURE
from camwright.pipeline.checks.extremes import cam_of
from camwright.pipeline.checks.part_strength import moving_masses
from camwright.pipeline.contact.closed_form import in_full
from camwright.pipeline.contact.hertz import line_contact
from camwright.pipeline.contact.pin_in_hole import persson_contact_angle, persson_pressure
from camwright.pipeline.cycle.cam_balance import camshaft_loads
from camwright.pipeline.cycle.crank_speed import mechanism_torque
from camwright.pipeline.cycle.crossover_history import flights
from camwright.pipeline.cycle.length_history import signed_factor
from camwright.pipeline.cycle.part_loads import PivotPush
from camwright.pipeline.cycle.pressed_discs import pressed_discs
from camwright.pipeline.cycle.speed_sweep import speed_sweep
from camwright.pipeline.follower.follower_forces import follower_loads, turn_integral
from camwright.pipeline.follower.shaft_strength import (
    bending_moment,
    judged_sections,
    shaft_bending,
    slopes_of,
    torque_at,
)
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import figures, headline
from camwright.pipeline.search.crown.solved_lines import SolvedLines
from camwright.pipeline.smoothing.allowables import weights_of

DATA = Path(__file__).parents[1] / "data"
STEM, ARM = DATA / "conjugate_feeder.toml", DATA / "conjugate_arm.toml"
PRESSED = DATA / "preloaded_arm.toml"
FILES = {"arm": ARM, "pressed": PRESSED, "groove": DATA / "groove_arm.toml"}
BOTH = pytest.mark.parametrize("name", ["stem", "arm"])


def uneven():
    """The feeder with one uneven stroke a turn and a smaller second roller farther out."""
    text = STEM.read_text(encoding="utf-8")
    begin, end = text.index("[[lift.segment]]"), text.index("[mechanism]")
    rows = ("modified_sine", 100, 18), ("dwell", 50, 0), ("cycloidal", 130, -18), ("dwell", 80, 0)
    lift = "".join(
        f'[[lift.segment]]\nlaw = "{law}"\nangle = "{angle} deg"\n'
        + (f'stroke = "{stroke} mm"\n\n' if stroke else "\n")
        for law, angle, stroke in rows
    )
    text = text[:begin] + lift + text[end:]
    text = text.replace('roller_radius = "23.5 mm"', 'roller_radius = "20 mm"')
    return text.replace('distance = "154 mm"', 'distance = "160 mm"').replace(
        'prime_radius = "68 mm"', 'prime_radius = "68 mm"\noffset = "4 mm"'
    )


@cache
def trial(name):
    case = parse_case(uneven()) if name == "stem" else read_case(FILES[name])
    return preview_case(case, corners=False)


def running(name):
    """Cycle, machine and second track or outer wall of the load case of the file."""
    cycle, machine = running_in(trial(name))
    if name == "groove":
        wall = groove_wall(cycle.contour, "outer", machine.roller.radius)
        return cycle, machine, SimpleNamespace(contour=wall)
    return cycle, machine, machine.cam.second.track(cycle.contour.pitch)


# --- forces -----------------------------------------------------------------------------------
def test_a_strong_spring_makes_the_pair_a_spring_closed_cam():
    assert_as_closed_by_a_strong_spring(*running("stem")[:2])


@pytest.mark.parametrize("name", ["arm", "groove"])
def test_a_strong_spring_makes_the_arm_spring_closed(name):
    cycle, machine, _ = running(name)
    sprung = replace(machine.spring, preload=900.0, rate=20e3)
    closed = replace(machine.system, spring=sprung, held=False, second=None)
    pair = replace(closed, held=True, second=machine.cam.second)
    plain, held = (
        follower_loads(cycle.contour.pitch, each, machine.cam_speed, uniform_turn(180))
        for each in (closed, pair)
    )
    assert not plain.separated.any()
    for name in ("axial_force", "normal_force", "cam_torque", "pivot_friction", "pivot_load"):
        assert getattr(held, name) == pytest.approx(getattr(plain, name), rel=1e-9, abs=1e-9), name


@pytest.mark.parametrize("speed", [10.0, 40.0])
def test_forces_by_the_equilibrium_of_the_stem(speed):
    """F_a = F + sign(v) (mu_A |A| + mu_B |B|) by iteration; the second roller is farther off."""
    cycle, machine, track = running("stem")
    theta, path, system = uniform_turn(180), cycle.contour.pitch, machine.system
    loads = follower_loads(path, system, speed, theta)
    s, s1, s2 = path.lift.derivatives(theta, 2)
    force = system.mass * speed**2 * s2 + system.spring.force(s)
    pulls = force < 0.0
    other = theta + np.pi
    own = track.contour.lift.derivatives(other, 1)
    second = track.contour.pitch
    tangent = np.where(
        pulls,
        (own[1] - second.offset) / (second.height_base + own[0]),
        (s1 - path.offset) / (path.height_base + s),
    )
    reach = system.overhang_at_max_lift + path.lift.highest.value - s + 0.160 * pulls
    moving = np.where(np.abs(s1) > 1e-9 * path.lift.stroke, np.sign(s1), 0.0)
    axial = force.copy()
    for _ in range(300):
        side = np.abs(axial * tangent)
        on_b = side * reach / system.guide_spacing
        axial = force + moving * (system.friction_a * (side + on_b) + system.friction_b * on_b)
    assert loads.axial_force == pytest.approx(axial, rel=1e-9, abs=1e-9)
    assert loads.normal_force == pytest.approx(np.abs(axial) * np.hypot(1.0, tangent), rel=1e-9)
    assert loads.cam_torque == pytest.approx(axial * s1, rel=1e-9, abs=1e-9)
    assert (axial > 1.0).any() and (axial < -1.0).any()


@pytest.mark.parametrize("name", ["arm", "pressed", "groove"])
def test_forces_by_the_equilibrium_of_the_arm(name):
    """Moments about the pivot in fixed axes, of inertia, weight, contact and friction.

    Of both contacts, where the rollers are preloaded.
    """
    cycle, machine, track = running(name)
    theta, path, speed = uniform_turn(240), cycle.contour.pitch, machine.cam_speed
    loads, arm = follower_loads(path, machine.system, speed, theta), path.arm
    pulls = loads.axial_force < 0.0
    assert pulls.any() and not pulls.all()
    cos, sin = np.cos(theta), np.sin(theta)
    turned = np.array([[cos, sin], [-sin, cos]])  # from cam axes to the line of centres

    def touching(contour, pitch):
        centre = np.einsum("ijn,jn->in", turned, pitch.points(theta))
        contact = np.einsum("ijn,jn->in", turned, contour.points(theta))
        normal = centre - contact
        return centre, normal / np.hypot(*normal)

    first, second = touching(cycle.contour, path), touching(track.contour, track.contour.pitch)
    idle = loads.idle_force
    sizes = (np.where(pulls, idle, loads.normal_force), np.where(pulls, loads.normal_force, idle))
    assert (idle > 0.0).all() if name == "pressed" else not idle.any()
    moment, force = 0.0, 0.0
    for size, (centre, normal) in zip(sizes, (first, second), strict=True):
        pushed, reach = size * normal, centre - np.array([[arm.centre_distance], [0.0]])
        moment, force = moment + reach[0] * pushed[1] - reach[1] * pushed[0], force + pushed
    outwards = -arm.sense  # of the moment of a push outwards, counter-clockwise
    _, s1, s2 = path.lift.derivatives(theta, 2)
    turning = machine.mass * arm.length * speed**2 * s2
    pivot = machine.pivot
    # the cam turns clockwise: up is 90 deg before the line to the pivot
    place = first[0] - np.array([[arm.centre_distance], [0.0]])
    place = pivot.mass_distance * place / arm.length
    up = np.array([[np.cos(pivot.gravity_angle)], [np.sin(pivot.gravity_angle)]])
    weight = -pivot.swinging_mass * 9.80665 * up
    fallen = place[0] * weight[1] - place[1] * weight[0]
    rubbing = np.where(np.abs(s1) > 1e-9 * path.lift.stroke, np.sign(s1), 0.0)
    rubbed = rubbing * loads.pivot_friction * arm.length
    balance = outwards * (moment + fallen) - turning - rubbed
    scale = np.abs(moment).max()
    assert np.abs(balance).max() < (1e-8 if name == "groove" else 1e-6) * scale
    # load of the pivot: all other forces with that of inertia
    along = np.hypot(*loads.pivot_load)
    friction = machine.friction.nominal[0] * 0.5 * 0.020 / arm.length * along
    loaded = (np.abs(loads.axial_force) > 1.0) & (rubbing != 0.0)
    assert loads.pivot_friction[loaded] == pytest.approx(friction[loaded], rel=1e-9)
    aside = place / pivot.mass_distance
    tangent = outwards * np.stack([-aside[1], aside[0]])
    away = pivot.swinging_mass * pivot.mass_distance
    turned, spun = speed**2 * s2 / arm.length, (speed * s1 / arm.length) ** 2
    inertia = -away * (turned * tangent - spun * aside)
    whole = force + weight + inertia
    assert np.hypot(*whole)[loaded] == pytest.approx(along[loaded], rel=1e-6)
    on_shaft = np.stack([force[0], -force[1]])  # across: clockwise
    assert loads.on_shaft == pytest.approx(on_shaft, abs=1e-6 * np.abs(force).max())


@pytest.mark.parametrize("name", ["stem", "arm", "pressed", "groove"])
def test_the_cam_pays_for_friction_alone(name):
    """Work of the cam over a turn is the loss in guides or pivot: 1e-6 of that on the rises."""
    cycle, machine, _ = running(name)
    loads = cycle.loads
    if name != "stem":  # the force steps where friction alone holds the arm: sampled more finely
        theta = uniform_turn(28800)
        loads = follower_loads(cycle.contour.pitch, machine.system, machine.cam_speed, theta)
    rubbed = loads.friction_force * np.abs(loads.lift_slope)
    work, lost = (turn_integral(loads.theta, each) for each in (loads.cam_torque, rubbed))
    scale = turn_integral(loads.theta, np.abs(loads.cam_torque))
    assert lost > 1e-3 * scale
    assert work == pytest.approx(lost, abs=1e-6 * scale)


@pytest.mark.parametrize("name", ["stem", "arm", "pressed", "groove"])
def test_the_torque_of_the_crank_is_that_of_the_loads(name):
    """At a cam speed without acceleration, and at the rate that a case with a crankshaft has."""
    cycle, machine, _ = running(name)
    path, theta = cycle.contour.pitch, uniform_turn(360)
    loads = follower_loads(path, machine.system, machine.cam_speed, theta)
    torque = mechanism_torque(path, machine.system, 1.0, 360)
    on_cam = torque(np.full(360, machine.cam_speed), np.zeros(360))
    expected = loads.inertia_force * loads.lift_slope - loads.cam_torque
    assert on_cam == pytest.approx(expected, rel=1e-9, abs=1e-9)


@BOTH
def test_without_clearance_and_compliance_the_track_is_the_sign_of_the_force(name):
    """A clearance of a nanometre: the track changes where the rigid force changes its sign."""
    cycle, machine, _ = running(name)
    narrow = replace(machine.cam.conjugate, clearance=1e-9)
    cam = replace(machine.cam, conjugate=narrow)
    landed = flights(replace(machine, cam=cam, restitution=0.0), cycle.contour).landings
    theta, rigid = uniform_turn(14400), machine.system.with_friction(0.0, 0.0)
    force = follower_loads(cycle.contour.pitch, rigid, machine.cam_speed, theta).axial_force
    assert len(landed) >= 2
    for flight in landed:
        assert flight.landing == pytest.approx(flight.take_off, abs=np.radians(0.5))
        beyond = np.interp(flight.landing + np.radians(0.5), theta, force, period=2.0 * np.pi)
        assert np.sign(beyond) == flight.wall


def test_landings_of_an_arm_in_its_groove_by_an_integrator():
    """Speed within 1e-3, energy of a turn to 1e-6."""
    cycle, machine, _ = running("groove")
    path, speed, arm = cycle.contour.pitch, machine.cam_speed, cycle.contour.pitch.arm
    pivot = machine.pivot

    def gap(theta):  # along the arc, by points of the path
        step = 1e-5
        tangent = path.points(theta + step) - path.points(theta - step)
        normal = np.array([tangent[1], -tangent[0]]) / np.hypot(*tangent)
        place = path.points(theta) - arm.centre_distance * np.array([np.cos(theta), np.sin(theta)])
        square = np.array([-place[1], place[0]]) / np.hypot(*place)
        return machine.cam.groove.clearance / abs(normal @ square)

    def required(theta):  # inertia and weight, at the roller
        s, s2 = float(path.lift(theta)), float(path.lift(theta, 2))
        angle = path.start + s / arm.length
        place = np.array([-np.cos(angle), arm.sense * np.sin(angle)])
        up = np.array([np.cos(pivot.gravity_angle), np.sin(pivot.gravity_angle)])
        weight = -pivot.swinging_mass * 9.80665 * up
        fallen = -arm.sense * (place[0] * weight[1] - place[1] * weight[0])
        moment = fallen * pivot.mass_distance / arm.length
        return machine.mass * speed**2 * s2 - moment

    history = flights(machine, cycle.contour)
    assert history.energy.left < 1e-6
    first = [one for one in history.landings if one.wall != one.start and not one.leaving]
    assert {one.wall for one in first} == {1.0, -1.0}
    for one in first:
        _, against = landing_of(one, lambda theta: required(theta) / machine.mass, gap, speed)
        assert one.speed == pytest.approx(against, rel=1e-3)


def test_an_arm_is_pulled_to_its_path_by_the_outer_wall():
    """Place of the roller in a polygon of the wall: that of the lift, within 0.1 um."""
    cycle, _, track = running("groove")
    path, theta = cycle.contour.pitch, uniform_turn(90) + 0.01
    arc = track.contour.standing(track.contour.points(uniform_turn(1440)), theta)
    assert arc == pytest.approx(path.arm.length * path.start + path.lift(theta), abs=1e-7)


def test_preloaded_discs_are_two_springs_on_the_arm():
    """The place of the arm between two springs that only push, by bisection, at every angle."""
    cycle, machine, track = running("pressed")
    theta, path = uniform_turn(120), cycle.contour.pitch
    (near, far), interference = machine.roller_compliances[:2], machine.cam.conjugate.interference
    stiff = machine.system.preload.compliances._replace(at_first=0.0, between=0.0, at_second=0.0)
    rigid = replace(machine.system.preload, compliances=stiff)  # camshaft
    system = replace(machine.system, preload=rigid)
    loads = follower_loads(path, system, machine.cam_speed, theta)
    ratio, second = 85.0 / 90.0, track.contour.pitch.pressure_angle(theta)
    low, high = np.full(120, -1e-3), np.full(120, 1e-3)  # of the arm's end outwards, m
    for _ in range(80):
        y = 0.5 * (low + high)
        pushed = np.maximum(-y, 0.0) / near
        pressed = interference / np.cos(second) + ratio * y  # of the second roller on its arm
        pulled = ratio * np.maximum(pressed, 0.0) / far
        over = pushed - pulled > loads.axial_force
        low, high = np.where(over, y, low), np.where(over, high, y)
    normal = pushed / np.cos(path.pressure_angle(theta)), pulled / ratio / np.cos(second)
    carried = np.where(loads.axial_force < 0.0, *normal[::-1])
    idle = np.where(loads.axial_force < 0.0, *normal)
    assert loads.normal_force == pytest.approx(carried, rel=1e-6)
    assert loads.idle_force == pytest.approx(idle, rel=1e-6)
    assert idle.min() > 0.0


@pytest.mark.parametrize("name", ["arm", "pressed"])
@pytest.mark.parametrize("distance", [0.0, 0.03])
def test_each_arm_is_bent_by_its_own_contact_and_mass(name, distance):
    """Moment of a section by the place of the contact on its own roller and by lumps: the masses
    of the ends, and 2000 of each arm, which with them have the whole moment of inertia.
    """
    cycle, machine, track = running(name)
    solution, loads, path = trial(name).solution, cycle.loads, cycle.contour.pitch
    lengths, at, bent = (path.arm.length, track.contour.pitch.arm.length), loads.theta, []
    roller, radius = machine.roller, track.contour.require_roller().roller_radius
    ring = np.pi * roller.width * roller.material.density  # per square of the radius
    first = sum(mass for mass in roller.moving.masses.values())
    ends = first, first + ring * (radius**2 - roller.radius**2)
    places = [length * (np.arange(2000) + 0.5) / 2000 for length in lengths]
    left = machine.mass * lengths[0] ** 2 - np.dot(ends, np.square(lengths))
    lump = left / sum(
        length * np.sum(place**2) for length, place in zip(lengths, places, strict=True)
    )
    turned = loads.acceleration / lengths[0]
    for number, contour in enumerate((cycle.contour, track.contour)):
        carries = loads.wall > 0.0 if number == 0 else loads.wall < 0.0
        normal = np.where(carries, loads.normal_force, loads.idle_force)
        own, arm, length = contour.pitch, contour.pitch.arm, lengths[number]
        centre, contact = own.points(at), contour.points(at)
        pivot = arm.centre_distance * np.stack([np.cos(at), np.sin(at)])
        reach = (centre - pivot) * (1.0 - distance / length)
        pushed = normal * (centre - contact) / contour.require_roller().roller_radius
        moment = -arm.sense * (reach[0] * pushed[1] - reach[1] * pushed[0])
        beyond = np.maximum(places[number] - distance, 0.0) * places[number]
        swung = ends[number] * (length - distance) * length + lump * length * np.sum(beyond)
        wanted = moment - (turned if number == 0 else -turned) * swung
        bar, forces = bars_of(solution.numbers)[number], arm_forces(cam_of(solution, cycle), number)
        bent.append(bar.bending(distance, forces))
        assert bar.length == length
        assert bent[-1] == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())
        assert np.abs(bent[-1]).max() > (9.0 if name == "pressed" else 0.5)
        assert (forces.across > 0.0).all() == (name == "pressed")
    if distance == 0.0:  # what both do not give to one another, the pivot and the weight have
        held = lengths[0] * (loads.axial_force - loads.inertia_force)
        assert bent[0] - bent[1] == pytest.approx(held, abs=1e-9 * np.abs(bent).max())


@pytest.mark.parametrize("name", ["arm", "pressed"])
@pytest.mark.parametrize("offset", [0.0, 0.015])
def test_the_second_disc_bends_the_pin_of_the_pivot(name, offset):
    """Couple of the contacts about the middle of the bush, by their places along the shaft; of both
    at once the sum of sizes a + b, which with an angle f between them is |a + b|/cos(f/2) at most.
    """
    cycle, machine, track = running(name)
    loads, spacing = cycle.loads, machine.cam.conjugate.spacing
    shifted = replace(machine, arm=replace(machine.arm, plane_offset=offset))
    couple = PivotPush.of(shifted, loads, np.zeros(loads.theta.size)).couple
    sizes = [np.where(way * loads.wall > 0.0, loads.normal_force, loads.idle_force)
             for way in (1.0, -1.0)]  # fmt: skip
    ways = []
    for contour in (cycle.contour, track.contour):
        outward = contour.pitch.points(loads.theta) - contour.points(loads.theta)
        ways.append(outward / np.hypot(*outward))
    wanted = np.hypot(*((spacing - offset) * sizes[1] * ways[1] - offset * sizes[0] * ways[0]))
    half = 0.5 * np.arccos(-np.sum(ways[0] * ways[1], axis=0))
    both = name == "pressed" and offset > 0.0
    assert (couple >= (1.0 - 1e-9) * wanted).all()
    assert (couple <= (1.0 + 1e-9) * wanted / (np.cos(half) if both else 1.0)).all()
    assert couple.max() > 0.5


def test_a_vanishing_interference_is_a_pair_without_clearance():
    """An interference of a picometre has the forces of either disc alone."""
    cycle, machine, _ = running("pressed")
    theta, path = uniform_turn(120), cycle.contour.pitch
    light = replace(machine.system.preload, interference=1e-12)
    systems = replace(machine.system, preload=light), replace(machine.system, preload=None)
    pressed, loose = (follower_loads(path, each, machine.cam_speed, theta) for each in systems)
    for name in ("axial_force", "normal_force", "cam_torque", "pivot_load"):
        assert getattr(pressed, name) == pytest.approx(getattr(loose, name), abs=1e-3), name


def test_the_ends_of_the_disc_that_bears_less_by_half_spaces():
    """Checks of the signed pressure by half-spaces of the governing contact solved directly, 1 %:
    the table that they interpolate has 0.2 % of the greatest pressure.
    """
    checks = {each.id: each for each in trial("pressed").checks}
    cycle = max(trial("pressed").cycles, key=lambda each: each.on_other_track.signed_pressure.max())
    other, loads = cycle.on_other_track, cycle.loads
    k, disc = int(np.argmax(other.signed_pressure)), running("pressed")[2].contour
    first = loads.axial_force[k] < 0.0
    contour, roller = (cycle.contour, 23.5e-3) if first else (disc, 22e-3)
    curvature = 1.0 / roller + 1.0 / float(contour.radius_of_curvature(loads.theta[[k]])[0])
    force, moment = loads.idle_force[[k]], other.length.moment[[k]]
    solved = []
    for pair in cycle.machine.finite_pairs:
        lines, at = SolvedLines(pair, cycle.length.mean_length), (np.array([curvature]), force)
        for side in (-1.0, 0.0, 1.0):
            factor = signed_factor(lines, *at, side * moment).value
            _, p0 = line_contact(force / pair.contact_length, 1.0 / curvature, pair.contact_modulus)
            solved.append(float(factor[0] * p0[0]))
    assert max(solved) > 1.02 * max(each.signed_pressure.max() for each in trial("pressed").cycles)
    # the traction of the roller is less than 1e-4 of the normal force
    for name in ("edge_pressure", "contact_pressure_at_life", "edge_shakedown"):
        assert checks[name].demand == pytest.approx(max(solved), rel=0.01), name
        assert checks[name].note.startswith("on the preloaded disc that bears less")


def test_the_harder_pressed_disc_is_judged():
    """Checks of the contact by Hertz (1882) on the smaller roller of the second disc, which less
    force presses harder; 1e-4 for the traction that they count, 1e-3 for the table of its stress.
    """
    checks = {each.id: each for each in trial("pressed").checks}
    _, machine, track = running("pressed")
    pressures, carried = [], []
    for cycle in trial("pressed").cycles:
        loads, pulled = cycle.loads, cycle.loads.axial_force < 0.0
        curved = 1.0 / 0.022 + 1.0 / track.contour.radius_of_curvature(loads.theta)
        load = np.where(pulled, loads.normal_force, loads.idle_force) / machine.contact_width
        _, p0 = line_contact(load, 1.0 / curved, machine.contact_modulus)
        pressures.append(p0.max())
        carried.append(cycle.contact.p0.max())
    greatest = max(pressures)
    assert greatest > 1.03 * max(carried)
    for name in ("contact_pressure", "shakedown", "pressure_by_gear_limits"):
        assert checks[name].demand == pytest.approx(greatest, rel=1e-9), name
        assert "on the preloaded disc that bears less" in checks[name].note
    assert checks["shakedown_traction"].demand == pytest.approx(greatest, rel=1e-4)
    # von Mises stress below a line contact, nu = 0.3: Johnson, Contact Mechanics, sec. 4.2(c)
    assert checks["first_yield"].demand == pytest.approx(0.558 * greatest, rel=1e-3)
    assert headline(trial("pressed").solution)["p0_hertz_max_MPa"] == pytest.approx(
        1e-6 * greatest, rel=1e-9
    )


def test_the_conforming_contact_of_either_disc_is_named(monkeypatch):
    """At the greatest pressure of the disc whose contacts conform, that which bears less too."""
    cycle = trial("pressed").cycles[0]
    idle, seen = cycle.idle, []
    conforming = replace(idle, tau_max=0.9 * idle.tau_max)
    assert conforming.conforming.all() and not cycle.contact.conforming.any()
    solution = replace(trial("pressed").solution, cycles=(replace(cycle, idle=conforming),))

    def solved(pair, theta, *loaded):
        seen.append((float(theta[0]), float(pair.carrying(float(theta[0])).follower.radius)))
        return None, SimpleNamespace(p0=[1e9], error=[0.01], half_angle=[0.1], p0_hertz=[2e9])

    monkeypatch.setattr(contact_strength, "in_full", solved)
    assert "up to 1000 MPa" in conforming_sentence(solution)
    k = int(np.argmax(idle.p0))
    assert seen == [(cycle.theta[k], 23.5e-3 if cycle.loads.wall[k] < 0.0 else 22e-3)]


def test_the_weights_of_a_synthesis_are_over_the_greater_pressure_of_both_discs():
    """Weight times pressure is the limit times the greatest utilisation at its own angle."""
    solution, limit = trial("pressed").solution, 1.5e9
    weights = weights_of(solution, SimpleNamespace(bounds={PRESSURE: limit})).values[PRESSURE]
    weighted = [
        weights[each.load_case] * np.maximum(each.contact.p0, each.idle.p0)
        for each in solution.cycles
    ]
    used = max(
        each.utilisation
        for each in trial("pressed").checks
        if each.declaration.scales_with == (PRESSURE, 1.0) and each.declaration.along
    )
    assert max(each.max() for each in weighted) == pytest.approx(limit * used, rel=1e-9)


def test_the_film_of_each_preloaded_disc_goes_on_where_the_other_bears_more():
    """Without a jump beyond its other changes from angle to angle; film_ratio is the least."""
    thinnest = []
    for cycle in trial("pressed").cycles:
        if cycle.machine.speed == 0.0:
            continue
        first, second = cycle.rolling.film.ratio, cycle.on_other_track.rolling.film.ratio
        pulled = cycle.loads.wall < 0.0
        changes = pulled != np.roll(pulled, 1)
        assert changes.any()
        for film in (np.where(pulled, second, first), np.where(pulled, first, second)):
            steps = np.abs(film - np.roll(film, 1))
            assert steps[changes].max() <= steps[~changes].max()
            thinnest.append(film.min())
        assert np.abs(first - second)[changes].min() > 0.0
    checks = {each.id: each for each in trial("pressed").checks}
    assert checks["film_ratio"].demand == pytest.approx(min(thinnest), rel=1e-12)


def test_waves_of_preloaded_discs_by_an_integrator():
    """The mass between both rollers over the sine of each disc, on the camshaft that both bend,
    integrated until it recurs: what it adds to the forces of a slow motion over the same sines, in
    the worst phase; 1e-3.
    """
    checks = {each.id: each for each in trial("pressed").checks}
    judged = checks["preload_waviness"]
    cycle = next(c for c in trial("pressed").cycles if c.load_case == judged.load_case)
    machine, track = cycle.machine, cycle.machine.cam.second.track(cycle.contour.pitch)
    theta, scales, step = np.array([judged.cam_angle]), (1.0, 90.0 / 85.0), 1e-5
    near, far, *bent = machine.roller_compliances
    pushes, waves, speeds = [], [], []
    for contour, scale in zip((cycle.contour, track.contour), scales, strict=True):
        outward = (contour.pitch.points(theta) - contour.points(theta))[:, 0]
        along = contour.points(theta + step) - contour.points(theta - step)
        speeds.append(machine.cam_speed * np.hypot(*along)[0] / (2.0 * step))
        waves.append(scale / np.cos(contour.pitch.pressure_angle(theta))[0])
        pushes.append(waves[-1] * outward / np.hypot(*outward))
    at_first, between, at_second = bent
    beside = between * pushes[0] @ pushes[1]
    own = near + at_first * pushes[0] @ pushes[0]
    other = far * scales[1] ** 2 + at_second * pushes[1] @ pushes[1]
    springs, ways = np.linalg.inv([[own, beside], [beside, other]]), np.array([1.0, -1.0])
    whole, added = ways @ springs @ ways, 0.0
    damper = 2.0 * machine.damping_ratio * np.sqrt(whole * machine.mass)
    for disc, (wave, speed) in enumerate(zip(waves, speeds, strict=True)):
        rate, sine = 2.0 * np.pi * speed / 5e-3, 2e-6 * wave * np.eye(2)[disc]

        def rates(time, state, rate=rate, sine=sine):
            forces = springs @ (np.sin(rate * time) * sine - state[0] * ways)
            return state[1], (ways @ forces - damper * state[1]) / machine.mass

        turns = 2.0 * np.pi / rate * np.linspace(60.0, 61.0, 400)
        swung = solve_ivp(
            rates, (0.0, turns[-1]), (0.0, 0.0), "DOP853", turns, rtol=1e-8, atol=1e-14
        )
        added += machine.mass * rate**2 * np.abs(swung.y[0]).max()
    squeeze = machine.disc_preload.at(track, theta)
    axial = np.interp(theta, cycle.theta, cycle.loads.axial_force)
    left = np.array(squeeze.forces(axial))[:, 0] - squeeze.preload[0] * 8.0 / 20.0
    used = np.abs(springs @ ways) / whole * added / left
    assert judged.demand == pytest.approx(used.max(), rel=1e-3)
    assert 0.02 < judged.demand < judged.limit == 0.2


def test_the_preload_is_judged_on_both_discs():
    """preload_least and preload_pressure from the normal forces of the load cases."""
    checks = {each.id: each for each in trial("pressed").checks}
    machine, (tolerance, interference) = running("pressed")[1], (8e-6, 20e-6)
    least, pressures = np.inf, []
    for cycle in trial("pressed").cycles:
        path, loads = cycle.contour.pitch, cycle.loads
        track = running("pressed")[2]
        disc = track.contour
        pulled, ratio = loads.axial_force < 0.0, 85.0 / 90.0
        cosines = [np.cos(each.pressure_angle(loads.theta)) for each in (path, disc.pitch)]
        normal = (np.where(pulled, loads.idle_force, loads.normal_force),
                  np.where(pulled, loads.normal_force, loads.idle_force))  # fmt: skip
        forces = normal[0] * cosines[0], ratio * normal[1] * cosines[1]
        preload = cycle.machine.disc_preload.at(track, loads.theta).preload
        least = min(least, (np.minimum(*forces) / preload).min() - tolerance / interference)
        grown = [each + preload * tolerance / interference for each in forces]
        grown = grown[0] / cosines[0], grown[1] / ratio / cosines[1]
        for force, contour, radius in zip(
            grown, (cycle.contour, disc), (machine.roller.radius, 0.022), strict=True
        ):
            flat = 1.0 / radius + 1.0 / contour.radius_of_curvature(loads.theta)
            load = force / machine.contact_width
            pressures.append(np.sqrt(load * machine.contact_modulus * flat / np.pi).max())
    assert checks["preload_least"].demand == pytest.approx(least, rel=1e-9)
    assert checks["preload_pressure"].demand == pytest.approx(max(pressures), rel=1e-9)
    assert "preload_least" not in {each.id for each in trial("arm").checks}


# --- contact ----------------------------------------------------------------------------------
@BOTH
def test_contact_on_both_discs_by_their_radii(name):
    """Hertz (1882) with the radius of either disc, by differences of its points, and its roller."""
    cycle, machine, track = running(name)
    loads, pulled = cycle.loads, cycle.loads.axial_force < 0.0

    def curvature(contour, theta):
        step = 1e-3
        before, here, after = (contour.points(theta + k * step) for k in (-1, 0, 1))
        a, b = after - before, after - 2.0 * here + before
        return 8.0 * (a[0] * b[1] - a[1] * b[0]) / 2.0 / np.hypot(*a) ** 3

    one = 1.0 / machine.roller.radius + curvature(cycle.contour, loads.theta)
    other = 1.0 / track.contour.roller_radius + curvature(track.contour, loads.theta + track.turn)
    load = loads.normal_force / machine.contact_width
    pressure = np.sqrt(load * machine.contact_modulus * np.where(pulled, other, one) / np.pi)
    # differences over 0.06 deg miss the jerk: 1e-3 beside the steps of it
    assert cycle.contact.p0 == pytest.approx(pressure, rel=2e-3, abs=1e3)
    assert pulled.any() and not pulled.all()


def test_a_concave_disc_conforms_to_the_roller_that_it_carries():
    """Persson's closed form with the radius of that roller, in hollows of 0.1 m relative radius."""
    cycle, machine, _ = running("stem")
    shape, relative = cycle.theta.shape, 0.1
    load = np.full(shape, 2e6)
    full, line = in_full(cycle.pair, cycle.theta, load, np.full(shape, relative))
    roller = np.where(
        cycle.loads.axial_force < 0.0, machine.cam.second.radius, machine.roller.radius
    )
    assert full.all() and np.unique(roller).size == 2
    for k in range(0, roller.size, 60):
        wall = 1.0 / (1.0 / roller[k] - 1.0 / relative)
        number = 2.0 * cycle.pair.contact_modulus * (wall - roller[k]) / load[k]
        angle = persson_contact_angle(number)
        exact = float(persson_pressure(angle)) * load[k] / np.sqrt(roller[k] * wall)
        assert line.p0[k] == pytest.approx(exact, rel=1e-6)


@BOTH
def test_each_roller_turns_one_way(name):
    """Its surface stands on its disc: by the centre's path and the contact's, in the plane."""
    cycle, machine, track = running(name)
    spin, speed, step = cycle.parts.roller_spin, machine.cam_speed, 1e-6
    pulled = cycle.loads.axial_force < 0.0
    discs = (cycle.contour, 0.0, ~pulled), (track.contour, track.turn, pulled)
    for contour, turn, carries in discs:
        theta, path = cycle.theta[carries] + turn, contour.pitch
        arm = contour.points(theta) - path.points(theta)
        across = np.stack([-arm[1], arm[0]])
        moving = (path.points(theta + step) - path.points(theta - step)) / (2.0 * step)
        rate = -np.sum(moving * across, axis=0) / np.sum(across**2, axis=0)
        held = 1.0
        if name == "arm":  # the arm turns in the cam frame by the cam and by its swing
            angle = path.lift.derivatives(theta, 1)[1] / path.arm.length
            held = 1.0 - path.arm.sense * angle
        assert spin[carries] == pytest.approx(speed * (rate - held), rel=1e-5, abs=1e-3)
        assert (spin[carries] > 0.0).all()


# --- landings ---------------------------------------------------------------------------------
def test_landings_by_an_adaptive_integrator():
    """Speed at the landing on either disc; the clearance by the points of the second disc."""
    cycle, machine, track = running("stem")
    path, speed = cycle.contour.pitch, cycle.cam_speed
    clearance, disc = machine.cam.conjugate.clearance, track.contour

    def gap(theta):
        own, slope = disc.lift.derivatives(theta + np.pi, 1)
        height = disc.pitch.height_base + own
        return clearance * np.hypot(slope - disc.pitch.offset, height) / height

    theta = 1.0  # lowered by that gap the second roller is a clearance nearer to its disc
    toward = np.array([np.cos(theta), np.sin(theta)])
    centre = disc.pitch.points(theta + np.pi) + gap(theta) * toward
    near = disc.points(theta + np.pi + np.linspace(-0.05, 0.05, 20001))
    least = np.hypot(*(near - centre[:, None])).min()
    assert disc.roller_radius - least == pytest.approx(clearance, rel=1e-3)
    assert {one.flight.wall for one in cycle.impacts} == {1.0, -1.0}
    for landed in cycle.impacts:
        flight = landed.flight
        _, against = landing_of(flight, lambda theta: speed**2 * path.lift(theta, 2), gap, speed)
        assert flight.speed == pytest.approx(against, rel=1e-3)


def test_rollers_slip_where_their_friction_is_too_small():
    """crossover_slip: both spins by steps a twentieth as long, each under its own friction; within
    3 %, as the force goes through zero in half a degree.

    By the spin with which a roller left its disc alone it were 0.078 of 0.186 m/s: the friction
    before the crossover no longer turns it as the disc does.
    """
    made = trial("stem")
    cycle = max(made.cycles, key=lambda each: each.cam_speed)
    machine, path = cycle.machine, cycle.contour.pitch
    track, roller = machine.cam.second.track(path), machine.roller
    theta, fine = cycle.theta, uniform_turn(20 * cycle.theta.size)
    signed = cycle.loads.wall * cycle.loads.normal_force
    signed = np.interp(fine, theta, signed, period=2.0 * np.pi)
    step, greatest = 2.0 * np.pi / fine.size / cycle.cam_speed, []
    for pitch, turn, radius, force in (
        (path, 0.0, roller.radius, signed),
        (track.contour.pitch, np.pi, track.contour.roller_radius, -signed),
    ):
        chord = pitch.points(fine + turn + 1e-5) - pitch.points(fine + turn - 1e-5)
        pace = cycle.cam_speed * np.hypot(*chord) / 2e-5
        limit = roller.friction * np.maximum(force, 0.0)
        surface = turned_by_friction(pace, limit, roller.rotor_inertia / radius**2, step)
        greatest.append(np.abs(pace - surface)[limit > 0.0].max())
    check = next(each for each in made.checks if each.id == "crossover_slip")
    assert check.demand == pytest.approx(max(greatest), rel=0.03)


# --- sweeps, discs and the case ---------------------------------------------------------------
@pytest.mark.parametrize("name", ["stem", "arm", "pressed"])
def test_the_sweep_over_the_speeds_has_the_forces_of_both_discs(name):
    """At the speed of a load case it is the cycle, of preloaded discs with their preload."""
    cycle, machine, _ = running(name)
    rubbing = cycle.loads.rubbing
    sweep = speed_sweep(machine, cycle.contour, rubbing, [machine.crank_speed])
    assert sweep.contact_force_min.min() >= 0.0
    force = cycle.loads.normal_force
    assert sweep.contact_force_max[-1] == pytest.approx(force.max(), rel=3e-3)
    assert sweep.contact_force_min[-1] == pytest.approx(force.min(), rel=3e-3, abs=0.5)
    for swept, own in ((sweep.torque_min, min), (sweep.torque_max, max)):
        assert swept[-1] == pytest.approx(own(cycle.loads.cam_torque), rel=3e-3)


def test_both_discs_are_judged():
    """Whole-contour checks take the worse disc; mass and radius are those of both."""
    checks = {each.id: each for each in trial("stem").checks}
    cycle, machine, track = running("stem")
    discs, theta = (cycle.contour, track.contour), uniform_turn(14400)
    radii = [np.hypot(*each.points(theta)) for each in discs]
    assert checks["cam_radius"].demand == pytest.approx(max(r.max() for r in radii), rel=1e-6)
    held = machine.cam.held_radius
    assert checks["minimum_wall"].demand == pytest.approx(
        min(r.min() for r in radii) / held, rel=1e-6
    )
    angles = [np.abs(each.pitch.pressure_angle(theta)).max() for each in discs]
    assert checks["pressure_angle"].demand == pytest.approx(max(angles), rel=1e-6)
    least = min(1.0 / each.pitch.curvature(theta).max() / each.roller_radius for each in discs)
    assert checks["curvature_ratio"].demand == pytest.approx(least, rel=1e-5)
    assert checks["second_disc_gap"].demand == pytest.approx(0.034 - 0.5 * 0.0455 - 0.0003)


@pytest.mark.parametrize("file", [STEM, ARM, PRESSED])
def test_the_cases_pass_by_check(file):
    """No check of the designs fails or lacks data; none of a closing force is made."""
    made = ids_where_all_pass(preview_case(read_case(file), corners=False))
    assert not made & {"jump", "contact_force_margin", "groove_wall", "traction_demand"}
    assert {"landing_speed", "second_disc_gap", "cam_radius", "tool_gouge"} <= made


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        (STEM, 'closure = "conjugate"', 'closure = "groove"', "cam.conjugate = a table, must be"),
        (STEM, 'distance = "154 mm"\n', "", "cam.conjugate.distance = missing, must be given"),
        (STEM, 'distance = "154 mm"', 'distance = "154 mm"\narm_length = "80 mm"',
         "cam.conjugate.arm_length = 80 mm, must be left out with a stem, which has distance"),
        (STEM, 'distance = "154 mm"', 'distance = "80 mm"', "cam.conjugate.distance = 80 mm, must"),
        (STEM, 'spacing = "34 mm"', 'spacing = "27 mm"', "cam.conjugate.spacing = 27 mm, must be"),
        (STEM, 'clearance = "0.02 mm"', 'clearance = "0 mm"', "cam.conjugate.clearance = 0 mm"),
        (STEM, 'clearance = "0.02 mm"', 'clearance = "0.02 mm"\ninterference = "0.02 mm"',
         "cam.conjugate.clearance = stated beside an interference, must be left out, or"),
        (ARM, 'clearance = "0.02 mm"', 'clearance = "0.02 mm"\ninterference = "0.02 mm"',
         "cam.conjugate.clearance = stated beside an interference, must be left out, or"),
        (ARM, 'clearance = "0.02 mm"\nspacing', "spacing",
         "cam.conjugate.clearance = missing, must be given, or cam.conjugate.interference"),
        (ARM, 'arm_length = "85 mm"', 'distance = "154 mm"',
         "cam.conjugate.distance = 154 mm, must be left out with follower.kind = "),
        (ARM, 'arm_length = "85 mm"\n', "", "cam.conjugate.arm_length = missing, must be given"),
        (ARM, 'arm_angle = "79 deg"', 'arm_angle = "40 deg"', "cam.conjugate.arm_angle = 40 deg"),
    ],
)  # fmt: skip
def test_refusals_of_the_case(file, old, new, message):
    assert_refused(file, old, new, message)


# --- words ------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("name", "landings"),
    [
        ("stem", "from the first disc at|from the second disc at"),
        ("pressed", "the preloaded discs leave no clearance"),
        ("groove", "from the inner wall at|from the outer wall at"),
    ],
)
def test_notes_name_the_tracks_and_no_energy_of_a_spring_that_is_not_there(name, landings):
    notes = {one.id: one.note for one in trial(name).checks}
    assert any(words in notes["landing_speed"] for words in landings.split("|"))
    assert " W" in notes["friction_balance"]
    assert "stored energy" not in notes["friction_balance"]
    assert "hole" not in notes["cam_unbalance"]  # refused in a cam that pulls


# --- camshaft ---------------------------------------------------------------------------------
@pytest.mark.parametrize("name", ["stem", "arm", "pressed"])
def test_each_disc_loads_the_camshaft_at_its_own_place(name):
    """Statics of the shaft, and its bending integrated twice.

    What is left of the force on the shaft for the first disc has the size of its normal force; the
    moment ends with the last force. The forces hold to round-off, deflection and slope to the
    1e-4 of 3401 places.
    """
    cycle, machine, _ = running(name)
    shaft, cam = machine.camshaft, machine.cam
    diameter, modulus = shaft.diameter, shaft.material.E
    loads = camshaft_loads(cycle.loads, shaft, cam, cycle.contour, 0.0)
    first, second = pressed_discs(cycle.contour, cycle.loads)
    there, size = shaft.cam_position + cam.conjugate.spacing, first.force.max()
    np.testing.assert_allclose(np.hypot(*loads.cam), first.force, atol=1e-9 * size)
    np.testing.assert_allclose(np.hypot(*loads.second.force), second.force, atol=1e-9 * size)
    np.testing.assert_allclose(
        loads.cam + loads.second.force, -cycle.loads.on_shaft, atol=1e-9 * size
    )
    span = shaft.bearing_spacing
    beyond = bending_moment(loads, shaft, max(span, there) + 0.1)
    np.testing.assert_allclose(beyond, 0.0, atol=1e-9 * size * span)
    x = np.linspace(min(0.0, shaft.gear_position), max(span, there), 3401)
    bend = np.stack([bending_moment(loads, shaft, at) for at in x], axis=-1)
    stiff = modulus * np.pi * diameter**4 / 64.0
    slope = cumulative_trapezoid(bend / stiff, x, initial=0.0)
    sag = cumulative_trapezoid(slope, x, initial=0.0)

    def at(place):
        near = np.argmin(np.abs(x - place))
        return sag[..., near] + slope[..., near] * (place - x[near])

    tilt = (at(span) - at(0.0)) / span
    places = shaft.cam_position, there
    sagged = [np.hypot(*(at(place) - at(0.0) - tilt * place)) for place in places]
    bent = np.hypot(*shaft_bending(loads, shaft, diameter, modulus).deflection)
    np.testing.assert_allclose(bent, np.max(sagged, axis=0), atol=1e-4 * bent.max())
    discs = slopes_of(shaft, cam.conjugate.spacing)
    forces = (loads.cam, loads.second.force), (loads.second.force, loads.cam)
    for place, disc, (here, other) in zip(places, discs, forces, strict=True):
        near = np.argmin(np.abs(x - place))
        turned = slope[..., near] + bend[..., near] / stiff * (place - x[near])
        tilted = disc.under(here, loads.gear, beside=other)
        np.testing.assert_allclose(tilted, turned - tilt, atol=1e-4 * np.abs(tilted).max())
    turning = cycle.loads.cam_torque
    between = torque_at(turning, shaft, 0.5 * sum(places), loads.second)
    np.testing.assert_allclose(between, second.torque, atol=1e-12)
    both = torque_at(turning, shaft, 0.0, loads.second) - shaft.drag
    np.testing.assert_allclose(both, first.torque + second.torque, atol=1e-9 * size)
    judged = judged_sections(shaft, diameter, 0.0, 0.0, cam.conjugate.spacing)
    worst = max(np.hypot(*bending_moment(loads, shaft, one.position)).max() for one in judged)
    assert worst == pytest.approx(np.hypot(bend[0], bend[1]).max(), rel=1e-3)


@pytest.mark.parametrize("name", ["stem", "arm", "pressed"])
def test_each_key_feels_the_torque_of_its_own_disc(name):
    """Torques by the points of the contours; a preload turns each disc to and fro under a torque on
    the cam that has one sign.
    """
    cycle, _, track = running(name)
    cam, loads = cam_of(trial(name).solution, cycle), cycle.loads
    torques = []
    for disc, turn, wall in ((cycle.contour, 0.0, 1.0), (track.contour, track.turn, -1.0)):
        force = np.where(wall * loads.wall > 0.0, loads.normal_force, loads.idle_force)
        centre, contact = disc.pitch.points(loads.theta + turn), disc.points(loads.theta + turn)
        pushed = (centre - contact) / disc.require_roller().roller_radius
        torques.append(force * (contact[0] * pushed[1] - contact[1] * pushed[0]))
    greatest = np.abs(torques).max()
    np.testing.assert_allclose(np.abs(cam.disc_torques), np.abs(torques), atol=1e-7 * greatest)
    np.testing.assert_allclose(sum(cam.disc_torques), loads.cam_torque, atol=1e-7 * greatest)
    wanted = any(each.min() < -1e-6 < 1e-6 < each.max() for each in torques)
    assert bool(cam.reverses) == wanted
    steady = replace(cam, loads=replace(loads, cam_torque=np.abs(loads.cam_torque) + 1.0))
    assert bool(steady.reverses) == wanted


@pytest.mark.parametrize("name", ["stem", "arm", "pressed"])
def test_the_seat_of_a_disc_bears_the_torque_of_its_own_contact(name):
    """Seven times that of the cam with a preload; that of the cam without one.

    Of the disc by the slope of its own lift, to 1e-9; the pressure of the key in its textbook form.
    """
    cycle, machine, _ = running(name)
    seat = cycle.loads.seat_torque
    discs = [each.torque for each in pressed_discs(cycle.contour, cycle.loads)]
    most = np.where(cycle.loads.wall > 0.0, *discs)
    np.testing.assert_allclose(seat, most, atol=1e-9 * np.abs(seat).max())
    apart = np.abs(seat).max() / np.abs(cycle.loads.cam_torque).max()
    assert apart == pytest.approx(7.61 if name == "pressed" else 1.0, rel=0.01)
    key, (judged,) = (
        machine.cam.key,
        (one for one in trial(name).checks if one.id == "key_pressure"),
    )
    flanks = machine.cam.key_flanks
    torque = max(np.abs(each.loads.seat_torque).max() for each in trial(name).cycles)
    across = 2.0 * machine.cam.bore_radius * flanks.length * flanks.hub_height
    pressure = 2.0 * key.application_factor * torque / across
    assert judged.demand == pytest.approx(pressure, rel=1e-9)
    turned = {each.load_case: each for each in trial(name).cycles}[judged.load_case].loads
    at = np.argmin(np.abs(turned.theta - judged.cam_angle))
    beyond = torque - np.abs(turned.cam_torque[at])
    assert judged.stated["T_p"] == pytest.approx(beyond, abs=1e-9 * torque)


@BOTH
def test_the_figures_of_a_pair_are_the_worst_of_both_discs(name):
    """Radii and curvature by differences of the points of each contour, no formula of either."""
    shown = figures(trial(name))
    least, reach = [], []
    for disc in trial(name).solution.discs:
        points = disc.contour.points(uniform_turn(14400))
        step = 0.5 * (np.roll(points, -1, axis=1) - np.roll(points, 1, axis=1))
        bend = np.roll(points, -1, axis=1) - 2.0 * points + np.roll(points, 1, axis=1)
        curvature = (step[0] * bend[1] - step[1] * bend[0]) / np.hypot(*step) ** 3
        least.append(1.0 / np.max(curvature * np.sign(np.median(curvature))))
        reach.append(np.max(np.hypot(*points)))
    assert 1e-3 * shown["convex_radius_min_mm"] == pytest.approx(min(least), rel=2e-3)
    assert 1e-3 * shown["cam_radius_max_mm"] == pytest.approx(max(reach), rel=1e-6)
    assert least[1] < least[0] or reach[1] > reach[0]  # the second disc is one of the worst


def test_the_mass_of_a_pair_is_that_of_both_rollers_with_their_parts():
    """On a stem twice those of one, on arms the second ones reduced to the first roller by the
    square of the lengths: a ring of steel about its pin among them.
    """
    for name, ratio in (("conjugate_feeder", 1.0), ("conjugate_arm", 85.0 / 90.0)):
        case = read_case(DATA / f"{name}.toml")
        solution = preview_case(case, corners=False).solution
        masses, missing = moving_masses(solution)
        assert not missing
        radius, pin = case.cam.conjugate.roller_radius, case.roller.pin.diameter
        ring = np.pi * (radius**2 - 0.25 * pin**2) * case.roller.width
        ring *= ratio**2 * case.roller.material.density
        assert masses["second roller"] == pytest.approx(ring)
        assert masses["second pin"] == pytest.approx(ratio**2 * masses["pin"])
        assert masses["second fork"] == pytest.approx(ratio**2 * masses["fork"])
        demand = next(one for one in preview_case(case, corners=False).checks
                      if one.id == "follower_mass").demand  # fmt: skip
        assert demand == pytest.approx(sum(masses.values()))
