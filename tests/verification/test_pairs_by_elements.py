"""Both tracks of conjugate discs and of a yoke by finite elements.

Places of the second track by the geometry of stem, arm and yoke; contact against Hertz, and both
bodies in full on fine meshes of their own.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from camwright.geometry.arrays import rotation
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.checks.torque_balance import pressure_torque
from camwright.pipeline.contact.bore_stress import bore_stress
from camwright.pipeline.contact.certificate import mesh_figures
from camwright.pipeline.contact.closed_form import closed_form_history
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.certificate_angles import BegunCertificate, positions_to_certify
from camwright.pipeline.cycle.contact_setup import contact_pair, under_load
from camwright.pipeline.cycle.pressed_discs import pressed_discs
from camwright.pipeline.preview import preview_case
from camwright.pipeline.recomputation import recompute
from camwright.pipeline.results.field_output import Shown
from camwright.pipeline.results.run_reader import read_run
from camwright.pipeline.results.run_records import certificate_record
from camwright.pipeline.run import run_case
from camwright.pipeline.solver import solve
from camwright.reports.verification_tables import certificate

DATA = Path(__file__).parents[1] / "data"
STEM, ARM, YOKE = "conjugate_feeder", "conjugate_arm", "yoke_pump"
PRESSED, PRESSED_STEM = "preloaded_arm", "preloaded_feeder"
ALL = [STEM, ARM, YOKE]


@cache
def loaded(name):
    """First cycle of a case with its contact pair under load."""
    trial = preview_case(read_case(DATA / f"{name}.toml"), corners=False)
    cycle = trial.cycles[0]
    return cycle, under_load(contact_pair(cycle.machine, cycle.contour), cycle.loads)


@cache
def bodies(name):
    return CycleBodies.meshed(loaded(name)[1])


@cache
def solved(name):
    case = read_case(DATA / f"{name}.toml").with_positions(72)
    contour = loaded(name)[0].contour
    return solve(case, contour, tier=Tier.CYCLE, torques={}, corners=False)


# --- places -----------------------------------------------------------------------------------
def across(cycle, theta):
    """Centre of the second roller, or a point of the second face, in the cam frame (2, n), m."""
    first, conjugate = cycle.contour.pitch.points(theta), cycle.machine.cam.conjugate
    outwards = np.stack([np.cos(theta), np.sin(theta)])
    if conjugate is None:
        lift = cycle.contour.lift
        return first - (2.0 * cycle.contour.pitch.base_radius + lift.highest.value) * outwards
    if conjugate.distance is not None:
        return first - conjugate.distance * outwards
    arm = cycle.contour.pitch.arm
    pivot = arm.centre_distance * outwards
    swung, at = first - pivot, []
    for k in range(theta.size):
        turned = [rotation(s * conjugate.arm_angle) @ swung[:, k] for s in (1.0, -1.0)]
        # across the line of centres: the arms are on either side of it
        side = pivot[0, k] * swung[1, k] - pivot[1, k] * swung[0, k]
        other = [pivot[0, k] * t[1] - pivot[1, k] * t[0] for t in turned]
        chosen = turned[int(np.argmin(np.sign(side) * np.array(other)))]
        at.append(pivot[:, k] + conjugate.arm_length / arm.length * chosen)
    return np.array(at).T


@pytest.mark.parametrize("name", ALL)
def test_the_second_contact_is_under_the_second_roller_or_face(name):
    """By the parts of the follower in the cam frame, to round-off."""
    cycle, pair = loaded(name)
    theta = np.array([0.3, 1.1, 2.2, 3.9, 5.5])
    points, normals = pair.pulling.touched(theta)
    there = across(cycle, theta)
    if name == YOKE:  # anywhere along the face, whose normal points to the cam
        outwards = np.stack([np.cos(theta), np.sin(theta)])
        assert normals == pytest.approx(-outwards, abs=1e-12)
        assert ((points - there) * outwards).sum(axis=0) == pytest.approx(0.0, abs=1e-9)
        return
    radius = cycle.machine.cam.conjugate.roller_radius
    assert points + radius * normals == pytest.approx(there, abs=1e-9)
    assert pair.pulling.follower.radius == radius


@pytest.mark.parametrize("name", ALL)
def test_the_gap_beside_the_second_contact_by_points(name):
    """Height of the roller over its tangent less that of the contour, in the contact frame."""
    _, pair = loaded(name)
    pulling, theta = pair.pulling, np.array([0.3, 1.0, 2.2])
    points, normal = pulling.touched(theta)
    for k, angle in enumerate(theta):
        near, _ = pulling.touched(angle + np.linspace(-0.004, 0.004, 9))
        along = np.array([normal[1, k], -normal[0, k]])
        arm = near - points[:, k, None]
        xi, height = along @ arm, normal[:, k] @ arm
        radius = np.inf if name == YOKE else pulling.follower.radius
        follower = 0.0 if name == YOKE else radius - np.sqrt(radius**2 - xi**2)
        gap = pulling.gap(theta[[k]], xi[None])[0]
        assert gap == pytest.approx(follower - height, abs=1e-13)


# --- contact ----------------------------------------------------------------------------------
@pytest.mark.parametrize("name", ALL)
def test_finite_elements_agree_with_hertz_on_both_tracks(name):
    """Half-widths below 1 % of the relative radius: the closed form holds to 1e-4."""
    cycle, pair = loaded(name)
    theta, force = cycle.theta[::24], cycle.loads.normal_force[::24]
    history = two_scale_history(pair, bodies(name), theta, force)
    pushes = pair.wall(theta) > 0
    assert 3 < pushes.sum() < theta.size - 3
    for at in (pushes, ~pushes):
        assert history.p0[at] == pytest.approx(history.p0_hertz[at], rel=1e-4)
    assert history.p0_hertz == pytest.approx(cycle.contact.p0_hertz[::24], rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_pressures_turn_the_cam_as_the_forces_do(name):
    """Torque of the pressures at contact points and normals, against force times slope.

    To 1e-5: the couple of a pressure on a surface whose curvature changes.
    """
    for cycle in solved(name).cycles:
        torque, by_pressure = cycle.loads.cam_torque, pressure_torque(cycle)
        assert by_pressure == pytest.approx(torque, abs=1e-5 * np.abs(torque).max())


@pytest.mark.parametrize("name", ALL)
def test_every_disc_has_the_force_and_torque_of_its_tracks(name):
    """Forces of all discs together, and torques, are those of the turn."""
    cycle, _ = loaded(name)
    discs = pressed_discs(cycle.contour, cycle.loads)
    assert len(discs) == (1 if name == YOKE else 2)
    assert sum(d.force for d in discs) == pytest.approx(cycle.loads.normal_force, rel=1e-12)
    torque = cycle.loads.cam_torque
    assert sum(d.torque for d in discs) == pytest.approx(torque, abs=1e-9 * np.abs(torque).max())


def test_a_yoke_presses_both_faces_on_one_body():
    of_yoke = bodies(YOKE)
    assert of_yoke.pulling.cam is of_yoke.cam
    assert of_yoke.pulling.follower is of_yoke.follower
    of_pair = bodies(ARM)
    assert of_pair.pulling.cam is not of_pair.cam
    assert of_pair.pulling.follower is not of_pair.follower


@pytest.mark.slow
@pytest.mark.parametrize("name", ALL)
def test_either_track_is_certified_where_it_is_pressed_most(name):
    cycles = solved(name).cycles
    chosen = positions_to_certify(cycles, 4)
    for wall in (1.0, -1.0):
        most = max(np.where(c.loads.wall == wall, c.contact.p0, 0.0).max() for c in cycles)
        there = [cycles[at.case].contact.p0[at.index] for at in chosen
                 if cycles[at.case].loads.wall[at.index] == wall]  # fmt: skip
        assert max(there) == most


def test_a_preloaded_disc_that_never_bears_more_is_certified():
    """Under a force that pushes all over the turn the second disc has its worst angle, too: its own
    bodies under its own force, 1 % from the pressure of Hertz on a mesh of four elements.
    """
    cycle, pair = loaded(PRESSED)
    pushed = np.abs(cycle.loads.axial_force) + 10.0
    loads = cycle.loads
    track = loads.second.track(cycle.contour.pitch)
    first, second = cycle.machine.disc_preload.at(track, loads.theta).forces(pushed)
    first = first / np.cos(cycle.contour.pitch.pressure_angle(loads.theta))
    second = second * 90.0 / 85.0 / np.cos(track.contour.pitch.pressure_angle(loads.theta))
    loads = replace(loads, axial_force=pushed, normal_force=first, idle_force=second)
    pair = under_load(contact_pair(cycle.machine, cycle.contour), loads)
    theta = loads.theta
    turned = SimpleNamespace(
        theta=theta, loads=loads, pair=pair,
        contact=closed_form_history(pair, theta, first),
        idle=closed_form_history(pair.other_track, theta, second),
    )  # fmt: skip
    chosen = positions_to_certify([turned], 4)
    assert [at.idle for at in chosen[:2]] == [False, True]
    worst = chosen[1]
    assert turned.idle.p0[worst.index] == pytest.approx(turned.idle.p0.max(), rel=1e-8)
    at = worst.theta([turned])
    body = worst.pair([turned])
    assert body.follower.radius == pytest.approx(0.022)
    force = float(worst.contact([turned]).line_load[worst.index]) * body.width
    assert force == pytest.approx(second[worst.index], rel=1e-12)
    full = mesh_figures(body, at, force, 4.0)
    meshes = {
        (each, edges): SimpleNamespace(result=lambda edges=edges: replace(full, edges=edges))
        for each in chosen[:2] for edges in (4.0, 8.0, 16.0)
    }  # fmt: skip
    points = BegunCertificate([turned], chosen[:2], chosen[:2], meshes, None).points(
        lambda *_: None
    )
    more, less = (certificate_record(point) for point in points)
    assert less["p0_MPa"]["cycle"] == pytest.approx(1e-6 * turned.idle.p0[worst.index])
    assert less["bears_less"] and "bears_less" not in more
    rows = certificate([more, less]).rows
    assert [row[0].endswith(", disc that bears less") for row in rows] == [False, True]
    assert full.p0 == pytest.approx(turned.idle.p0[worst.index], rel=1e-2)


@pytest.mark.slow
def test_the_bore_of_the_disc_that_is_pressed():
    """At angles at which the second carries the stress is that of its own body alone."""
    cycle = solved(ARM).cycles[0]
    pulled, bore = cycle.loads.wall < 0, cycle.rolling.bore
    theta, load = cycle.theta[pulled], cycle.contact.line_load[pulled]
    places = cycle.pair.pulling.touched(theta)
    own = bore_stress(cycle.bodies.pulling.cam, *places, load, excluded=bore.excluded)
    assert bore.von_mises[pulled] == pytest.approx(own.von_mises, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("name", ALL)
def test_both_bodies_in_full_agree_with_the_cycle(name, side):
    """Meshes of eight elements per half-width at the worst angle of each track: 1 %."""
    cycle, pair = loaded(name)
    k = int(np.argmax(np.where(cycle.loads.wall == side, cycle.contact.p0_hertz, 0.0)))
    theta, force = cycle.theta[[k]], cycle.loads.normal_force[[k]]
    full = mesh_figures(pair.carrying(float(theta[0])), float(theta[0]), float(force[0]), 8.0)
    history = two_scale_history(pair, bodies(name), theta, force)
    for figure in ("p0", "half_width", "tau_max", "von_mises"):
        assert getattr(full, figure) == pytest.approx(float(getattr(history, figure)[0]), rel=1e-2)


# --- preload ----------------------------------------------------------------------------------
@pytest.mark.slow
@pytest.mark.parametrize(("name", "beside_hertz"), [(PRESSED, 1e-4), (PRESSED_STEM, 3e-4)])
def test_preloaded_discs_have_a_contact_each(name, beside_hertz):
    """Forces that squeeze both rollers, and pressures of Hertz by the radii of both discs.

    Finite elements differ on either disc by the square of half-width over radius, in proportion to
    the load: 1e-4 at 600 N, which the stem exceeds. The map of the turn has at each angle the
    greater pressure of both.
    """
    solution = solved(name)
    cycle = solution.cycles[0]
    loads, machine = cycle.loads, cycle.machine
    track = loads.second.track(cycle.contour.pitch)
    first, second = machine.disc_preload.at(track, loads.theta).forces(loads.axial_force)
    arm, other = machine.arm, machine.cam.conjugate
    alpha = cycle.contour.pitch.pressure_angle(loads.theta)
    beta = track.contour.pitch.pressure_angle(loads.theta + track.turn)
    leverage = 1.0 if arm is None else arm.length / other.arm_length
    forces = first / np.cos(alpha), second * leverage / np.cos(beta)
    assert (forces[0] > 0).all() and (forces[1] > 0).all()
    most = []
    discs = (cycle.contour, 0.0), (track.contour, track.turn)
    for wall, force, (contour, turn) in zip((1, -1), forces, discs, strict=True):
        history = cycle.contact.where(loads.wall != wall, cycle.idle)
        curvature = 1.0 / contour.roller_radius + contour.curvature(loads.theta + turn)
        modulus = machine.contact_modulus / np.pi / machine.contact_width
        pressure = np.sqrt(force * modulus * curvature)
        assert history.p0_hertz == pytest.approx(pressure, rel=1e-9)
        assert history.p0 == pytest.approx(pressure, rel=beside_hertz)
        most.append(pressure)
    # the torque of both contacts is that of the axial force alone: to 1e-4 of its greatest
    assert pressure_torque(cycle) == pytest.approx(
        loads.cam_torque, abs=1e-4 * np.abs(loads.cam_torque).max()
    )
    reached = cycle.rolling.envelope.von_mises.max(axis=1)[:: 1440 // loads.theta.size]
    # 0.5577 of the pressure below a line contact of steel; within 0.5 %: depths and body stress
    assert reached == pytest.approx(0.5577 * np.maximum(*most), rel=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("name", [ARM, PRESSED, PRESSED_STEM, YOKE])
def test_a_run_is_recomputed_without_difference(name, tmp_path):
    """Both tracks in the tables of contour and cycle, and every file as its case gives it."""
    case = read_case(DATA / f"{name}.toml").with_positions(72)
    run_case(case, tmp_path / "run", depth=Tier.CYCLE, fields=Shown.WORST)
    cycle, _ = loaded(name)
    final = read_run(tmp_path / "run").final
    second = np.array([final.contour[f"second_contour_{axis}_mm"] for axis in "xy"])
    theta = np.radians(final.contour["cam_angle_deg"])
    points, _ = loaded(name)[1].pulling.touched(theta)
    assert second == pytest.approx(1e3 * points, abs=1e-9)
    assert ("idle_p0_fe_MPa" in final.cycle) == (cycle.machine.disc_preload is not None)
    assert recompute(tmp_path / "run").differences == ()
