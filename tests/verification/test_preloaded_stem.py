"""Preloaded rollers of a stem: both contacts load the guides, whose friction depends on both.

The case is tests/data/preloaded_feeder.toml; uneven() has one stroke a turn, an offset and a
smaller second roller. The equilibrium is that of the stem in fixed axes under the forces of both
contacts, by the points of the contours.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from test_conjugate_cam import uneven as uneven_pair

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.speed_sweep import speed_sweep
from camwright.pipeline.follower import bearing_life
from camwright.pipeline.follower.disc_preload import Compliances, DiscPreload
from camwright.pipeline.follower.follower_forces import (
    axial_of_surge,
    follower_loads,
    torque_on_cam,
    turn_integral,
)
from camwright.pipeline.follower.friction_coupling import guided_loads
from camwright.pipeline.follower.guide_reactions import guide_reactions
from camwright.pipeline.hand_check.hand_sheet import SheetRun
from camwright.pipeline.preview import preview_case
from camwright.pipeline.run import run_case

FILE = Path(__file__).parents[1] / "data" / "preloaded_feeder.toml"


def uneven():
    return parse_case(uneven_pair().replace('clearance = "0.02 mm"', 'interference = "0.02 mm"'))


@cache
def pressed(name):
    """Machine of the first load case, contour, and second track."""
    case = read_case(FILE) if name == "feeder" else uneven()
    contour = case.contour(given_lift(case))
    machine = machines(case)[0]
    return machine, contour, machine.cam.second.track(contour.pitch)


def unit(contour, theta, turn):
    """Centre of the roller and outward normal in fixed axes: across the stem, along it."""
    angle = theta + turn
    cos, sin = np.cos(angle), np.sin(angle)
    # the stem of the first roller points along the turned axis; across it, 90 deg ahead
    axes = np.array([[-sin, cos], [cos, sin]])
    centre = np.einsum("ijn,jn->in", axes, contour.pitch.points(angle))
    contact = np.einsum("ijn,jn->in", axes, contour.points(angle))
    normal = (centre - contact) / contour.roller_radius
    flip = np.cos(turn)  # half a turn ahead both axes point the other way
    return flip * centre, flip * normal


def normals(loads):
    """Normal forces of the first and of the second disc, N."""
    pulled = loads.axial_force < 0.0
    both = loads.normal_force, loads.idle_force
    return np.where(pulled, *both[::-1]), np.where(pulled, *both)


def contacts(name, loads):
    """Force of both contacts on the stem, and its moments about the middle of guide A, on the stem
    axis, and about the cam axis.
    """
    machine, contour, track = pressed(name)
    force, guide, cam = 0.0, 0.0, 0.0
    height = contour.pitch.height_base + contour.lift.highest.value + machine.overhang_at_max_lift
    discs = (contour, 0.0), (track.contour, track.turn)
    axis = unit(contour, loads.theta, 0.0)[0][0]
    assert np.ptp(axis) < 1e-12
    for size, (disc, turn) in zip(normals(loads), discs, strict=True):
        (across, along), normal = unit(disc, loads.theta, turn)
        push = size * normal
        force = force + push
        guide = guide + (across - axis) * push[1] - (along - height) * push[0]
        cam = cam + across * push[1] - along * push[0]
    return force, guide, cam


@pytest.mark.parametrize("name", ["feeder", "uneven"])
@pytest.mark.parametrize("speed", [2.0, 31.4, 90.0])
def test_equilibrium_of_the_stem_on_two_bushes(name, speed):
    """Both bushes from forces and moments, their Coulomb friction, the force along the stem."""
    machine, contour, _ = pressed(name)
    theta, system = uniform_turn(240), machine.system
    loads = follower_loads(contour.pitch, system, speed, theta)
    force, guide, cam = contacts(name, loads)
    on_b = guide / system.guide_spacing
    on_a = -force[0] - on_b
    rubbed = system.friction_a * np.abs(on_a) + system.friction_b * np.abs(on_b)
    lift, slope, bend = contour.lift.derivatives(theta, 2)
    moving = np.where(np.abs(slope) > 1e-9 * contour.lift.stroke, np.sign(slope), 0.0)
    closing = system.spring.force(lift) + system.mass * bend * speed**2
    scale = np.sum(normals(loads), axis=0).max()
    assert np.abs(force[1] - moving * rubbed - closing).max() < 1e-8 * scale
    for reaction, wanted in ((loads.reaction_a, on_a), (loads.reaction_b, on_b)):
        assert np.abs(reaction) == pytest.approx(np.abs(wanted), abs=1e-8 * scale)
    friction = loads.friction_force_a + loads.friction_force_b
    assert friction == pytest.approx(rubbed, abs=1e-8 * scale)
    assert np.abs(loads.cam_torque) == pytest.approx(np.abs(cam), abs=1e-8 * scale * lift.max())
    assert (loads.axial_force < 0.0).any() and (loads.axial_force > 0.0).any()


@pytest.mark.parametrize("name", ["feeder", "uneven"])
def test_guides_of_finite_length_bear_both_contacts(name):
    """The stem under both side loads, each by its own roller, and the friction of its bores."""
    machine, contour, _ = pressed(name)
    theta, system, stem = uniform_turn(90), machine.system, machine.stem
    turn = guided_loads(contour.pitch, system, stem, machine.guides, machine.cam_speed, theta)
    loads = turn.loads
    force, guide, _ = contacts(name, loads)
    overhang = system.overhang_at_max_lift + contour.lift.highest.value - contour.lift(theta)
    couple = force[0] * overhang - guide  # of the second contact beside the first
    bores = guide_reactions(force[0], overhang, stem, machine.guides, couple)
    for side in "ab":
        solved, own = (getattr(each, f"rubbing_load_{side}") for each in (turn.reactions, bores))
        assert solved == pytest.approx(own, rel=1e-7, abs=1e-6)
    rubbed = system.friction_a * bores.rubbing_load_a + system.friction_b * bores.rubbing_load_b
    moving = np.sign(loads.lift_slope)
    closing = system.spring.force(loads.lift) + loads.inertia_force
    miss = force[1] - moving * rubbed - closing
    assert np.abs(miss).max() < 1e-8 * np.sum(normals(loads), axis=0).max()
    assert turn.residual.max() < 1e-10


@pytest.mark.parametrize("name", ["feeder", "uneven"])
def test_the_work_of_the_cam_is_the_friction_of_the_guides(name):
    """Over a turn, on point supports and in guides of finite length."""
    machine, contour, _ = pressed(name)
    theta = uniform_turn(720)
    for solved in (follower_loads, _guided):
        loads = solved(contour.pitch, machine.system, machine.cam_speed, theta)
        work = turn_integral(theta, loads.cam_torque)
        assert work == pytest.approx(loads.friction_loss, rel=1e-6)
        assert work > 1.0


def _guided(path, system, speed, theta):
    machine = pressed("feeder")[0]
    return guided_loads(path, system, machine.stem, machine.guides, speed, theta).loads


# --- preload ----------------------------------------------------------------------------------
def test_the_preload_of_stated_compliances():
    """P = i/(cos alpha_2 (C_1 + C_2)), at rest over a dwell without an axial force."""
    machine, contour, track = pressed("uneven")
    theta = uniform_turn(60)
    preload = DiscPreload(15e-6, Compliances(20e-9, 32e-9))  # of a rigid camshaft
    squeeze = replace(machine.system, preload=preload).squeezed(contour.pitch, theta)
    angle = track.contour.pitch.pressure_angle(theta + np.pi)
    assert squeeze.preload == pytest.approx(15e-6 / np.cos(angle) / 52e-9, rel=1e-6)
    assert squeeze.share == pytest.approx(32.0 / 52.0, rel=1e-12)


def test_compliances_of_the_rollers_by_their_parts():
    """Roller, pin and fork of each, and the stem between: F L/(E A) of a bar of 20 mm."""
    machine, _, _ = pressed("feeder")
    parts = machine.compliances
    own = parts["bearing"] + parts["pin"] + parts["fork"]
    between = 0.154 / (machine.stem.elastic_modulus * 0.25 * np.pi * 0.020**2)
    assert machine.roller_compliances[:2] == pytest.approx((own, own + between), rel=1e-12)
    stated = replace(machine, stiffness=40e6).roller_compliances
    assert stated == pytest.approx((25e-9, 25e-9, 0.0, 0.0, 0.0), rel=1e-12)


@pytest.mark.parametrize("interference", [40e-9, 4e-6, 20e-6])
def test_both_rollers_are_springs_that_only_push(interference):
    """The place of the stem between them by bisection; under little preload one is without load."""
    machine, contour, _ = pressed("uneven")
    near, far = machine.roller_compliances[:2]
    preload = replace(
        machine.system.preload, interference=interference, compliances=Compliances(near, far)
    )
    system, theta = replace(machine.system, preload=preload), uniform_turn(120)
    loads = follower_loads(contour.pitch, system, 90.0, theta)
    angle = pressed("uneven")[2].contour.pitch.pressure_angle(theta + np.pi)
    low, high = np.full(120, -1e-3), np.full(120, 1e-3)
    for _ in range(90):
        y = 0.5 * (low + high)
        pushed, pulled = np.maximum(-y, 0.0) / near, interference / np.cos(angle) + y
        pulled = np.maximum(pulled, 0.0) / far
        over = pushed - pulled > loads.axial_force
        low, high = np.where(over, y, low), np.where(over, high, y)
    first, second = normals(loads)
    assert first * np.cos(contour.pitch.pressure_angle(theta)) == pytest.approx(pushed, rel=1e-6)
    assert second * np.cos(angle) == pytest.approx(pulled, rel=1e-6, abs=1e-6)
    assert (pulled.min() > 0.0) == (pushed.min() > 0.0) == (interference > 10e-6)


@pytest.mark.parametrize("name", ["feeder", "uneven"])
def test_a_vanishing_interference_is_a_pair_without_clearance(name):
    """An interference of a picometre has the forces of either disc alone, of 5e-5 N about."""
    machine, contour, _ = pressed(name)
    theta = uniform_turn(180)
    light = replace(machine.system.preload, interference=1e-12)
    systems = replace(machine.system, preload=light), replace(machine.system, preload=None)
    names = "axial_force", "normal_force", "cam_torque", "friction_force", "reaction_a"
    for solved in (follower_loads, _guided):
        pressed_, loose = (solved(contour.pitch, each, 60.0, theta) for each in systems)
        carries = np.abs(loose.axial_force) > 1.0
        for each in (*names, "jam_index", "overhang"):
            of_pressed, of_loose = (getattr(loads, each)[carries] for loads in (pressed_, loose))
            assert of_pressed == pytest.approx(of_loose, abs=1e-3), each


def test_a_follower_that_locks_has_bounded_forces():
    """Guides with a friction of 1.5 close together: equilibrium fails, the loads say where."""
    machine, contour, _ = pressed("uneven")
    rough = replace(machine.system, friction_a=1.5, friction_b=1.5)
    turn = guided_loads(
        contour.pitch, rough, machine.stem, machine.guides, machine.cam_speed, uniform_turn(180)
    )
    loads = turn.loads
    assert loads.jammed.any() and not loads.jammed.all()
    assert loads.end[1] == "locks"
    assert np.isfinite(loads.normal_force).all() and turn.residual.max() < 1e-10
    most = (np.abs(loads.required_force) + 4.0 * loads.idle_force.max()) / 0.01
    assert (np.abs(loads.axial_force) < most).all()


# --- turns at other speeds --------------------------------------------------------------------
def test_torque_and_sweep_have_the_forces_of_both_discs():
    """At the speed of a load case those of the loads, the friction of the guides as solved."""
    machine, contour, _ = pressed("uneven")
    theta, speed = uniform_turn(720), machine.cam_speed
    turn = guided_loads(contour.pitch, machine.system, machine.stem, machine.guides, speed, theta)
    loads = turn.loads
    system = replace(machine.system, rubbing=loads.rubbing)
    on_cam = torque_on_cam(contour.pitch, system, theta)(np.full(720, speed), np.zeros(720))
    wanted = loads.inertia_force * loads.lift_slope - loads.cam_torque
    assert on_cam == pytest.approx(wanted, abs=1e-9 * np.abs(wanted).max())
    sweep = speed_sweep(machine, contour, loads.rubbing, [machine.crank_speed])
    for swept, solved in (
        (sweep.contact_force_max, loads.normal_force.max()),
        (sweep.contact_force_min, loads.normal_force.min()),
        (sweep.torque_max, loads.cam_torque.max()),
        (sweep.torque_min, loads.cam_torque.min()),
    ):
        assert swept[-1] == pytest.approx(solved, rel=1e-9)


def test_a_surge_is_a_change_of_the_spring():
    """With the rubbing loads of the turn, as of other followers."""
    machine, contour, _ = pressed("uneven")
    theta, surge, path = uniform_turn(90), 40.0, contour.pitch
    rubbing = follower_loads(path, machine.system, 20.0, theta).rubbing
    system = replace(machine.system, rubbing=rubbing)
    harder = replace(system, spring=replace(system.spring, preload=system.spring.preload + surge))
    loads, more = (follower_loads(path, each, 20.0, theta) for each in (system, harder))
    change = axial_of_surge(path, machine.system, loads, np.full(90, surge))
    assert change == pytest.approx(more.axial_force - loads.axial_force, abs=1e-8)
    assert np.ptp(change) > 0.5  # friction on the rise and on the return


def test_the_stem_reaches_its_guide_from_the_second_roller():
    text = FILE.read_text(encoding="utf-8").replace(
        'stem_length = "400 mm"', 'stem_length = "350 mm"'
    )
    with pytest.raises(InputError, match=r"follower\.stem_length = 350 mm, must be >= 369 mm"):
        preview_case(parse_case(text), corners=False)


def test_bearings_of_both_rollers_by_the_forces_and_speed_of_each():
    """L10 = 10^6 (C/P_m)^3 turns of each roller, from the path of its middle by differences.

    The worse of both angle by angle is shorter, here by less than 1 %.
    """
    trial = preview_case(uneven(), corners=False)
    checks = {each.id: each for each in trial.checks}
    cycle = max(trial.cycles, key=lambda each: each.cam_speed)
    machine, loads, theta, step = cycle.machine, cycle.loads, cycle.theta, 1e-5
    track = machine.cam.second.track(cycle.contour.pitch)
    discs = (cycle.contour, theta), (track.contour, theta + track.turn)
    lives, fastest, slowest = [], [], []
    for (disc, angle), force in zip(discs, normals(loads), strict=True):
        ends = disc.pitch.points(angle + step) - disc.pitch.points(angle - step)
        spin = cycle.cam_speed * (np.hypot(*ends) / (2.0 * step) / disc.roller_radius - 1.0)
        mean = np.mean(force**3 * spin) / (2.0 * np.pi)
        lives.append(machine.roller.bearing.C**3 * 1e6 / mean)
        fastest.append(spin.max())
        slowest.append(spin.mean())
    assert fastest[1] > 1.3 * fastest[0]
    assert checks["roller_speed"].demand == pytest.approx(max(fastest), rel=1e-6)
    assert checks["roller_speed"].error_share < 1e-3
    assert 0.99 * min(lives) < checks["roller_life"].demand <= min(lives)
    bearing, (running, *_) = machine.roller.bearing, trial.cycles
    rpm = np.min(slowest) * running.cam_speed / cycle.cam_speed * 30.0 / np.pi
    rated = bearing_life.rated_viscosity(rpm, bearing.ring.pitch_diameter)
    assert checks["bearing_lubrication"].demand == pytest.approx(
        bearing.viscosity / rated, rel=1e-6
    )


def test_the_pin_of_each_roller_bends_under_the_force_of_its_own_contact():
    """Goodman's line of the fibres of either pin by the forces of the contacts in fixed axes.

    Both side loads and the axial force of both on one pin have 1.9 times the amplitude.
    """
    trial = preview_case(uneven(), corners=False)
    (check,) = (each for each in trial.checks if each.id == "roller_pin_fatigue")
    (cycle,) = (each for each in trial.cycles if each.load_case == check.load_case)
    card, pin = cycle.machine.roller.pin.material, cycle.machine.roller.pin
    track = cycle.machine.cam.second.track(cycle.contour.pitch)
    discs, used = ((cycle.contour, 0.0), (track.contour, track.turn)), []
    per_newton = cycle.parts.pin_stress / cycle.loads.normal_force
    for size, (disc, turn) in zip(normals(cycle.loads), discs, strict=True):
        _, (across, along) = unit(disc, cycle.theta, turn)
        for fibre in np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False):
            stress = per_newton * size * (along * np.cos(fibre) + across * np.sin(fibre))
            high, low = stress.max(), stress.min()
            mean = max(0.5 * (high + low), 0.0)
            used.append(0.5 * (high - low) / (1.0 - mean / card.tensile_strength))
    assert pin.mounting == "overhung"
    assert check.demand == pytest.approx(card.fatigue_bending / max(used), rel=3e-4)


@pytest.mark.slow
def test_every_sheet_of_a_run_agrees(tmp_path):
    """The jam index over the sum of both forces, life and fit without a spring."""
    run_case(read_case(FILE), tmp_path / "run", positions=48, depth=Tier.PREVIEW, jobs=1)
    run = SheetRun(tmp_path / "run")
    sheets = {name: run.sheet(name) for name in run.records}
    assert {"jam_index", "preload_least", "roller_life", "cam_slip"} <= set(sheets)
    assert [name for name, sheet in sheets.items() if not sheet.agrees] == []


def test_the_pressure_of_an_undercut_disc_is_not_known():
    text = uneven_pair().replace('clearance = "0.02 mm"', 'interference = "0.02 mm"')
    text = text.replace('roller_radius = "20 mm"', 'roller_radius = "70 mm"')
    checks = {each.id: each for each in preview_case(parse_case(text), corners=False).checks}
    assert checks["undercut"].status == "fail"
    assert checks["preload_pressure"].status == "not_evaluated"


@pytest.mark.parametrize(("diameter", "refused"), [(30, False), (20, True)])
def test_discs_on_a_soft_end_of_the_camshaft_are_refused(diameter, refused):
    """30 mm beyond the bearing a shaft of 20 mm bends at the first disc by a force at the second
    more than disc and roller yield under their own: both forces would grow with an axial one.
    """
    text = FILE.read_text(encoding="utf-8")
    text = text.replace('cam_position = "35 mm"', 'cam_position = "134 mm"')
    before, shaft = text.split("[camshaft]\n")
    shaft = shaft.replace('diameter = "30 mm"', f'diameter = "{diameter} mm"', 1)
    case = parse_case(f"{before}[camshaft]\n{shaft}")
    machine, contour = machines(case)[0], case.contour(given_lift(case))
    theta, track = uniform_turn(72), machine.cam.second.track(contour.pitch)
    if refused:
        with pytest.raises(InputError, match="camshaft"):
            machine.disc_preload.at(track, theta)
    else:
        squeeze = machine.disc_preload.at(track, theta)
        assert ((squeeze.share > 0.8) & (squeeze.share < 1.0)).all()
