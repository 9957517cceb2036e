"""A yoke by other formulations: breadth, forces, contact, sliding, landings, energy.

The case is tests/data/yoke_pump.toml: a cam of constant breadth, three strokes a turn.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from held_cams import (
    assert_as_closed_by_a_strong_spring,
    assert_refused,
    ids_where_all_pass,
    landing_of,
    running_in,
)

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.flat_face_contour import FacePath
from camwright.geometry.lift import Lift
from camwright.geometry.second_track import OppositeFace
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.cycle.speed_sweep import speed_sweep
from camwright.pipeline.follower.follower_forces import follower_loads, turn_integral
from camwright.pipeline.preview import preview_case

FILE = Path(__file__).parents[1] / "data" / "yoke_pump.toml"


def moved():
    """The pump with its stem beside the cam axis."""
    text = FILE.read_text(encoding="utf-8")
    return text.replace('prime_radius = "35 mm"', 'prime_radius = "35 mm"\noffset = "3 mm"')


@cache
def trial(shifted=False):
    case = parse_case(moved()) if shifted else read_case(FILE)
    return preview_case(case, corners=False)


def running(shifted=False):
    """Cycle and machine of the load case of the file."""
    return running_in(trial(shifted))


def test_an_eccentric_between_faces_two_radii_apart():
    """s = e sin t: the second face touches the disc of radius R at its own side, 2 R away."""
    theta, radius, e = uniform_turn(720), 0.030, 0.005
    path = FacePath(Lift(theta, e * (1.0 + np.sin(theta))), radius - e)
    track = OppositeFace().of(path)
    assert track.reach == pytest.approx(2.0 * radius, abs=1e-12)
    breadth = path.height(theta) + track.contour.pitch.height(theta + track.turn)
    assert breadth == pytest.approx(2.0 * radius, abs=1e-12)
    centre = e * np.array([[0.0], [1.0]])
    away = np.hypot(*(track.contour.points(theta + track.turn) - centre))
    assert away == pytest.approx(radius, rel=1e-9)
    assert track.relative_radius(theta) == pytest.approx(radius, rel=1e-6)


@pytest.mark.parametrize("shifted", [False, True])
@pytest.mark.parametrize("speed", [10.0, 40.0])
def test_forces_by_the_equilibrium_of_the_stem(shifted, speed):
    """Forces on the stem in fixed axes: contact and friction at the points of the cam, the guides.

    F_a = F + sign(v) (mu_A |A| + mu_B |B|) by iteration; A and B balance side force and moment.
    """
    cycle, machine = running(shifted)
    theta, path, system = uniform_turn(180), cycle.contour.pitch, machine.system
    loads = follower_loads(path, system, speed, theta)
    s, s1, s2 = path.lift.derivatives(theta, 2)
    force = system.mass * speed**2 * s2 + system.spring.force(s)
    pulls, mu = force < 0.0, system.face_friction
    own = path.lift.derivatives(theta + np.pi, 1)
    # along u and v; the cam turns clockwise under the stem: its surface drags the face with it
    face = np.where(pulls, -(path.base_radius + own[0]), path.base_radius + s)
    beside = np.where(pulls, -own[1], s1)
    dragged = np.where(pulls, 1.0, -1.0)  # along v, of a surface at `face` that turns clockwise
    guide_a = path.base_radius + path.lift.highest.value + system.overhang_at_max_lift
    guide_b = guide_a + system.guide_spacing
    moving = np.where(np.abs(s1) > 1e-9 * path.lift.stroke, np.sign(s1), 0.0)
    axial = force.copy()
    for _ in range(300):
        side = mu * np.abs(axial) * dragged
        # moment about the cam axis, less that of the axial force of the guides along the stem
        moment = face * side - (beside - path.offset) * axial
        on_b = -(moment - guide_a * side) / (guide_b - guide_a)
        on_a = -side - on_b
        axial = force + moving * (
            system.friction_a * np.abs(on_a) + system.friction_b * np.abs(on_b)
        )
    assert loads.axial_force == pytest.approx(axial, rel=1e-9, abs=1e-9)
    assert loads.normal_force == pytest.approx(np.abs(axial), rel=1e-9, abs=1e-9)
    torque = axial * s1 + mu * np.abs(axial) * np.abs(face)
    assert loads.cam_torque == pytest.approx(torque, rel=1e-9, abs=1e-9)
    assert np.abs(loads.reaction_a) == pytest.approx(np.abs(on_a), rel=1e-8, abs=1e-8)
    assert np.abs(loads.reaction_b) == pytest.approx(np.abs(on_b), rel=1e-8, abs=1e-8)
    assert (axial > 1.0).any() and (axial < -1.0).any()


def test_a_strong_spring_makes_the_yoke_a_spring_closed_cam():
    assert_as_closed_by_a_strong_spring(*running())


@pytest.mark.parametrize("shifted", [False, True])
def test_the_cam_pays_for_friction_alone(shifted):
    """Work of the cam over a turn is the loss in guides and faces: 1e-6 of that on rises."""
    loads = running(shifted)[0].loads
    rubbed = loads.friction_force * np.abs(loads.lift_slope) + loads.rubbed
    work, lost = (turn_integral(loads.theta, each) for each in (loads.cam_torque, rubbed))
    scale = turn_integral(loads.theta, np.abs(loads.cam_torque))
    assert lost > 1e-3 * scale
    assert work == pytest.approx(lost, abs=1e-6 * scale)


def test_contact_and_sliding_of_both_faces():
    """Hertz (1882) on the radius of the cam under either face, which slides at w times its
    height.
    """
    cycle, machine = running()
    loads, path = cycle.loads, cycle.contour.pitch
    theta = np.where(loads.axial_force < 0.0, loads.theta + np.pi, loads.theta)
    s, _, s2 = path.lift.derivatives(theta, 2)
    load = loads.normal_force / machine.contact_width
    pressure = np.sqrt(load * machine.contact_modulus / np.pi / (path.base_radius + s + s2))
    assert cycle.contact.p0 == pytest.approx(pressure, rel=1e-6, abs=1.0)
    sliding = cycle.rolling.sliding
    assert sliding.speed == pytest.approx(machine.cam_speed * (path.base_radius + s), rel=1e-9)


def test_landings_by_an_adaptive_integrator():
    """landing_speed and landing_pressure of the fastest load case; the faces are square."""
    cycle = max(trial().cycles, key=lambda each: each.cam_speed)
    machine, path, speed = cycle.machine, cycle.contour.pitch, cycle.cam_speed
    checks = {each.id: each for each in trial().checks}
    worst = max(cycle.impacts, key=lambda each: each.flight.speed)
    inner = worst.flight.wall > 0.0
    theta, moving = landing_of(
        worst.flight, lambda theta: speed**2 * path.lift(theta, 2), lambda _: 0.05e-3, speed
    )
    assert checks["landing_speed"].demand == pytest.approx(moving, rel=1e-3)
    pressed = max(worst.flight.wall * machine.mass * speed**2 * float(path.lift(theta, 2)), 0.0)
    struck = machine.axial_stiffness * machine.mass * moving**2
    force = pressed + np.sqrt(pressed**2 + struck)
    assert worst.force == pytest.approx(force, rel=2e-3)
    s, _, s2 = path.lift.derivatives(theta if inner else theta + np.pi, 2)
    radius = path.base_radius + s + s2
    pressure = np.sqrt(force * machine.contact_modulus / np.pi / radius / machine.contact_width)
    assert worst.pressure == pytest.approx(float(pressure), rel=2e-3)


def test_the_sweep_has_the_forces_of_both_faces():
    cycle, machine = running()
    sweep = speed_sweep(machine, cycle.contour, cycle.loads.rubbing, [machine.crank_speed])
    assert sweep.contact_force_max[-1] == pytest.approx(cycle.loads.normal_force.max(), rel=3e-3)
    for swept, own in ((sweep.torque_min, min), (sweep.torque_max, max)):
        assert swept[-1] == pytest.approx(own(cycle.loads.cam_torque), rel=3e-3)


def test_the_breadth_by_the_points_of_the_cam():
    """yoke_breadth: extent of the contour across every direction; 8 um of profile over 50 um."""
    contour = trial().contour
    points = contour.points(uniform_turn(7200))
    angles = np.linspace(0.0, np.pi, 91)
    across = np.stack([np.cos(angles), np.sin(angles)]).T @ points
    breadth = np.ptp(across, axis=1)
    assert np.ptp(breadth) < 1e-7
    (check,) = (each for each in trial().checks if each.id == "yoke_breadth")
    assert check.demand == pytest.approx((np.ptp(breadth) + 8e-6) / 50e-6, abs=2e-3)
    text = FILE.read_text(encoding="utf-8").replace('stroke = "3 mm"', 'stroke = "2.9 mm"', 1)
    text = text.replace('stroke = "-3 mm"', 'stroke = "-2.9 mm"', 1)
    checks = preview_case(parse_case(text), corners=False).checks
    (check,) = (each for each in checks if each.id == "yoke_breadth")
    assert check.status == "fail" and check.demand == pytest.approx((100.0 + 8.0) / 50.0, rel=0.02)


def test_the_case_passes_by_check():
    made = ids_where_all_pass(trial())
    assert not made & {"jump", "contact_force_margin", "groove_wall", "second_disc_gap"}
    assert {"landing_speed", "landing_pressure", "yoke_breadth", "cam_radius"} <= made


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('[cam.yoke]\nclearance = "0.05 mm"\n', "", "cam.yoke = missing, must be given"),
        ('closure = "yoke"\n', 'closure = "gravity"\n', "cam.yoke = a table, must be left out"),
        ('clearance = "0.05 mm"', 'clearance = "0 mm"', "cam.yoke.clearance = 0 mm, must be > 0"),
    ],
)  # fmt: skip
def test_refusals_of_the_case(old, new, message):
    assert_refused(FILE, old, new, message)


def test_the_verdict_names_the_frame_as_not_covered():
    words = "Not covered by this sign-off: frame of the yoke: not in the case"
    assert trial().case.scope_record["statement"] == words
    with_key = trial().case.scope.model_copy(update={"not_covered": ("key",), "reason": "bought"})
    said = with_key.as_record("frame of the yoke")["statement"]
    assert said == "Not covered by this sign-off: key: bought; frame of the yoke: not in the case"
    plain = with_key.as_record()["statement"]
    assert plain == "Not covered by this sign-off: key: bought"
