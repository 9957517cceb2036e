"""Checks of shape, manufacture, balance and solution recomputed from finished solutions.

Shape from points of the contour and the pitch curve alone, by differences; balances by sums of the
recorded forces; residuals from the fields of the solution.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.contact.contact_patch import contact_patch
from camwright.pipeline.contact.elasticity.plane_stress_measures import von_mises
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import stress_on_patch
from camwright.pipeline.cycle.solution import solution as solve
from camwright.pipeline.smoothing.required_lift import cam_lift

ROOT = Path(__file__).parents[2]
COUNT = 14400
BY_ID = {declared.id: declared for declared in CHECKS}


@cache
def published():
    """The published case at 72 angles, and its engine torques by load case."""
    case = read_case(ROOT / "cases" / "gx120.toml").with_positions(72)
    return case, engine_torques(case)


@cache
def previewed():
    """The published cam, with its engine, by closed forms at 72 angles."""
    case, torques = published()
    contour = case.contour(cam_lift(case, torques))
    return solve(case, contour, Tier.PREVIEW, torques=torques, positions=72)


@cache
def solved():
    """The case of every part by finite elements at 24 angles."""
    case = parse_case((ROOT / "tests" / "data" / "every_part.toml").read_text())
    contour = case.contour(given_lift(case))
    return solve(case, contour, Tier.CYCLE, positions=24, torques={})


def demand(name, solution):
    check = BY_ID[name](solution)
    assert check is not None
    assert check.demand is not None
    return check.demand


@cache
def curves():
    """Contour and roller centre (2, n), m, their lengths of step and curvatures, by differences."""
    shape = previewed().contour
    theta = np.arange(COUNT) * 2.0 * np.pi / COUNT
    return {"contour": shape.polygon(COUNT), "pitch": shape.pitch.points(theta)}


def circle_curvature(points):
    """Curvature of the circle through each point and its neighbours, positive where convex."""
    before, after = np.roll(points, 1, axis=1), np.roll(points, -1, axis=1)
    one, two, three = points - before, after - points, after - before
    cross = one[0] * two[1] - one[1] * two[0]
    return 2.0 * cross / (np.hypot(*one) * np.hypot(*two) * np.hypot(*three))


def radius_of(points):
    return np.hypot(*points)


def shape_demands():
    solution = previewed()
    contour, pitch = curves()["contour"], curves()["pitch"]
    case, machine = solution.case, solution.machine
    roller = machine.roller.radius
    bend = circle_curvature(pitch)
    kappa = circle_curvature(contour)
    step = np.hypot(*(np.roll(contour, -1, axis=1) - contour))
    theta = np.arange(COUNT) * 2.0 * np.pi / COUNT
    # the follower's axis turns with the cam angle; the force is normal to the pitch curve
    along = np.roll(pitch, -1, axis=1) - np.roll(pitch, 1, axis=1)
    normal = np.array([along[1], -along[0]]) / np.hypot(*along)
    axis = np.array([np.cos(theta), np.sin(theta)])
    highest = np.max(np.sum(pitch * axis, axis=0)) - np.sqrt(
        machine.cam.prime_radius**2 - machine.cam.offset**2
    )
    table = case.workshop_order.theta.size
    corners = solution.contour.polygon(table)
    chord = np.roll(corners, -1, axis=1) - corners
    inside = [solution.contour.polygon(8 * table)[:, k::8] - corners for k in range(1, 8)]
    sag = [np.abs(chord[0] * p[1] - chord[1] * p[0]) / np.hypot(*chord) for p in inside]
    mouth = machine.overhang_at_max_lift - 0.5 * machine.guides.a.length
    top = np.max(np.sum(pitch * axis, axis=0)) + mouth
    return {
        "pressure_angle": np.max(np.arccos(np.clip(np.sum(normal * axis, axis=0), -1.0, 1.0))),
        "curvature_ratio": 1.0 / bend.max() / roller,
        "undercut": 1.0 - roller * bend.max(),
        "concave_radius": -1.0 / kappa.min(),
        "curvature_rate": np.max(np.abs(np.roll(kappa, -1) - kappa) / step),
        "minimum_wall": radius_of(contour).min() / machine.cam.held_radius,
        "spring_travel": highest,
        "cam_radius": radius_of(contour).max(),
        "guide_gap": min(top - radius_of(contour).max(), mouth - roller),
        "chord_error": np.max(sag),
    }


@pytest.mark.parametrize(
    ("name", "accuracy"),
    [
        ("pressure_angle", 1e-5), ("curvature_ratio", 1e-4), ("undercut", 1e-4),
        ("concave_radius", 1e-4), ("curvature_rate", 5e-3), ("minimum_wall", 1e-6),
        ("spring_travel", 1e-6), ("cam_radius", 1e-6), ("guide_gap", 1e-6), ("chord_error", 2e-3),
    ],
)  # fmt: skip
def test_shape_by_points_of_the_curves(name, accuracy):
    assert demand(name, previewed()) == pytest.approx(shape_demands()[name], rel=accuracy)


def test_crossings_and_second_contact_by_distances():
    """No chord crosses another; no point of the contour lies within the roller."""
    contour = curves()["contour"][:, ::20]
    pitch = curves()["pitch"][:, ::20]
    roller = previewed().machine.roller.radius
    apart = np.hypot(*(contour[:, None, :] - pitch[:, :, None]))
    assert demand("second_contact", previewed()) == pytest.approx(
        max(0.0, float(np.max(roller - apart))), abs=2e-7
    )
    angle = np.unwrap(np.arctan2(contour[1], contour[0]))
    assert (np.diff(angle) > 0).all(), "star-shaped about the axis: it crosses itself nowhere"
    assert demand("self_intersection", previewed()) == 0.0


@pytest.mark.parametrize("share", [0.7, 1.5, 4.0])
def test_gouge_by_distances_of_the_wheel_s_centres(share):
    """A wheel larger than the least concave radius cuts the published cam; nearest points."""
    contour = curves()["contour"]
    tool = share * float(-1.0 / circle_curvature(contour).min())
    along = np.roll(contour, -1, axis=1) - np.roll(contour, 1, axis=1)
    centre = contour + tool * np.array([along[1], -along[0]]) / np.hypot(*along)
    nearest, _ = cKDTree(contour.T).query(centre.T)
    shop = previewed().case.workshop.model_copy(update={"tool_radius": tool})
    there = replace(previewed(), case=previewed().case.model_copy(update={"workshop": shop}))
    # points 25 um apart on the contour
    assert demand("tool_gouge", there) == pytest.approx(np.max(tool - nearest), rel=0.01, abs=2e-7)
    assert (demand("tool_gouge", there) > 1e-5) == (share > 1.0)


def test_waviness_by_a_follower_on_a_sine():
    """m times the acceleration of a point that runs over a sine, of a ground track 1 : 1250."""
    solution = previewed()
    cam, worst = solution.machine.cam, 0.0
    for cycle in solution.cycles:
        beside = cycle.contour.points(cycle.theta + 1e-6) - cycle.contour.points(cycle.theta)
        speed = np.hypot(*beside) / 1e-6 * cycle.cam_speed
        time = 1e-3 * cam.waviness_length / speed
        height = min(cam.waviness_length / 1250.0, cam.profile_tolerance)
        wave = [0.5 * height * np.sin(2.0 * np.pi * (0.25 + speed * t
                / cam.waviness_length)) for t in (-time, 0.0, time)]  # fmt: skip
        force = cycle.machine.mass * np.abs(wave[0] - 2.0 * wave[1] + wave[2]) / time**2
        held = cycle.loads.normal_force
        share = np.divide(force, held, out=np.full_like(force, np.inf), where=held > 0.0)
        worst = max(worst, float(np.max(share)))
    assert demand("profile_waviness", solution) == pytest.approx(worst, rel=1e-4)


def crank_torques(cycle, shift=0.0):
    """Crank torque of the engine, and with the cam, at the positions of a cycle, N m."""
    torque = published()[1][cycle.load_case]
    angles = cycle.theta * cycle.machine.gear_ratio + shift
    order = np.fft.rfft(torque.total - torque.total.mean())
    span = 2.0 * np.pi * cycle.machine.gear_ratio
    waves = np.arange(order.size)[:, None] * 2.0 * np.pi / span * angles
    parts = (order[:, None] * np.exp(1j * waves)).real * 2.0 / torque.total.size
    engine = parts[1:].sum(axis=0)
    drive = cycle.loads.axial_force * cycle.loads.lift_slope + cycle.loads.sliding_torque
    return engine, engine - drive / cycle.machine.gear_ratio


def test_ripple_reduction_by_a_fourier_series_of_the_engine_s_torque():
    reductions = []
    for cycle in previewed().cycles:
        if cycle.machine.ripple_weight > 0:
            before, after = crank_torques(cycle)
            reductions.append(1.0 - np.std(after) / np.std(before))
    assert demand("torque_reduction", previewed()) == pytest.approx(min(reductions), rel=5e-3)


def test_ripple_reduction_at_the_phase_tolerance_by_a_shifted_series():
    solution = previewed()
    phase = solution.case.tolerances.phase
    reductions = []
    for cycle in solution.cycles:
        if cycle.machine.ripple_weight > 0:
            plain = crank_torques(cycle)
            for shift in (phase, -phase):
                before, _ = crank_torques(cycle, shift)
                after = before + plain[1] - plain[0]
                reductions.append(1.0 - np.std(after) / np.std(before))
    assert demand("phase_tolerance", solution) == pytest.approx(min(reductions), rel=5e-3)


def test_drive_torque_by_the_moment_of_the_contact_force():
    """Force at the contact, towards the cam along the line to the roller centre, about the axis."""
    solution = solved()
    moments = []
    for cycle in solution.cycles:
        touched, centre = cycle.contour.points(cycle.theta), cycle.contour.pitch.points(cycle.theta)
        x, y = touched
        way_x, way_y = (touched - centre) / np.hypot(*(touched - centre))
        moments.append(np.max(np.abs(cycle.loads.normal_force * (x * way_y - y * way_x))))
    assert demand("drive_torque", solution) == pytest.approx(max(moments), rel=5e-3)


def test_friction_balance_by_reactions_and_travel():
    """Work of the cam less that of spring and inertia, against mu |R| ds of the bores."""
    cycle = solved().cycles[0]
    loads, guides = cycle.loads, cycle.machine.guides
    travel = loads.lift_slope * 2.0 * np.pi / cycle.theta.size
    spent = np.sum(loads.axial_force * travel) - np.sum(
        (loads.spring_force + cycle.machine.mass * loads.acceleration) * travel
    )
    rubbed = np.sum(
        (guides.a.friction * cycle.guides.rubbing_load_a
         + guides.b.friction * cycle.guides.rubbing_load_b) * np.abs(travel)
    )  # fmt: skip
    assert spent == pytest.approx(rubbed, rel=1e-6)
    assert demand("friction_balance", solved()) <= 1e-6


def test_friction_power_by_the_way_of_stem_and_roller():
    """mu |R| ds in the bores, and the drag of the bearing over the length of the contour / R."""
    solution = solved()
    cycle = solution.cycles[0]
    machine, loads = cycle.machine, cycle.loads
    guides, roller = machine.guides, machine.roller
    step = 2.0 * np.pi / cycle.theta.size
    rubbed = step * np.sum(
        (guides.a.friction * cycle.guides.rubbing_load_a
         + guides.b.friction * cycle.guides.rubbing_load_b
         + machine.viscous_damping * np.abs(loads.velocity)) * np.abs(loads.lift_slope)
    )  # fmt: skip
    dense = np.linspace(0.0, 2.0 * np.pi, 20001)
    x, y = cycle.contour.points(dense)
    turned = np.hypot(np.diff(x), np.diff(y)).sum() / roller.radius
    assert roller.drag is not None and roller.drag.bearing_friction == 0.0
    spent = rubbed + roller.drag.torque * turned
    power = spent * cycle.cam_speed / (2.0 * np.pi)
    # creep in the contact adds a ten-thousandth
    assert demand("friction_power", solution) == pytest.approx(power / 600.0, rel=1e-3)
    warm = 25.0 + (power + 5.0) / 2.0  # degC: every_part.toml
    assert demand("mechanism_temperature", solution) == pytest.approx(warm, rel=1e-3)


def test_force_and_moment_of_the_guides_by_their_reactions():
    """A, B and the side force on the stem; moments about guide A."""
    cycle = solved().cycles[0]
    loads, guides, spacing = cycle.loads, cycle.guides, cycle.machine.guides.spacing
    side, arm = loads.tangential_force, loads.overhang
    scale = np.abs(side).max()
    # both signed like the side force, although A acts against it
    force = side - guides.reaction_a + guides.reaction_b
    assert np.abs(force).max() <= 1e-9 * scale
    assert demand("guide_equilibrium_force", solved()) <= 1e-9
    assert demand("guide_equilibrium_moment", solved()) <= 1e-9
    assert np.abs(guides.statics_b * spacing - side * arm).max() <= 1e-9 * scale * arm.max()


def test_contact_equilibrium_and_difference_from_hertz_by_the_pressures():
    cycle = solved().cycles[0]
    contact, pair = cycle.contact, cycle.pair
    carried = np.trapezoid(contact.pressure, contact.pressure_xi, axis=1)
    wanted = cycle.loads.normal_force / pair.width
    assert np.max(np.abs(carried / wanted - 1.0)) < 1e-6
    assert demand("contact_equilibrium", solved()) < 1e-6
    assert contact.pressure.min() >= -1e-9 * contact.pressure.max()
    assert demand("contact_complementarity", solved()) < 1e-9
    cam, roller = cycle.machine.cam.material, cycle.machine.roller.material
    modulus = 1.0 / ((1.0 - cam.nu**2) / cam.E + (1.0 - roller.nu**2) / roller.E)
    theta = cycle.theta
    points = [cycle.contour.points(theta + shift) for shift in (-1e-3, 0.0, 1e-3)]
    one, two = points[1] - points[0], points[2] - points[1]
    cross = one[0] * two[1] - one[1] * two[0]
    bend = 2.0 * cross / (np.hypot(*one) * np.hypot(*two) * np.hypot(*(points[2] - points[0])))
    hertz = np.sqrt(wanted * modulus * (bend + 1.0 / cycle.machine.roller.radius) / np.pi)
    difference = np.max(np.abs(contact.pressure.max(axis=1) / hertz - 1.0))
    assert demand("hertz_difference", solved()) == pytest.approx(difference, abs=2e-3)


def test_subsurface_depth_by_the_stress_field():
    """Depth of the greatest von Mises stress at the points of the patch."""
    cycle = solved().cycles[0]
    pair, contact, theta = cycle.pair, cycle.contact, cycle.theta
    cam = cycle.bodies.cam.correction(pair.contour.points(theta), pair.contour.normal(theta))
    patch = contact_patch(pair.cam.poisson)
    field = stress_on_patch(
        pair, cam, theta, contact.line_load, contact.half_width_hertz, contact.p0_hertz,
        contact.pressure,
    )  # fmt: skip
    deepest = patch.points[1][von_mises(field, pair.cam.poisson).argmax(axis=0)]
    ratio = deepest * contact.half_width_hertz / contact.half_width
    assert demand("subsurface_depth", solved()) == pytest.approx(ratio.min(), abs=0.08)


def test_mesh_quality_by_triangles():
    """Least corner of all triangles by their straight sides, 2 deg."""
    least = 180.0
    for body in (solved().mesh.cam, solved().mesh.follower):
        corners = body.points[:, body.triangles[:3]]
        for k in range(3):
            one = corners[:, (k + 1) % 3] - corners[:, k]
            two = corners[:, (k + 2) % 3] - corners[:, k]
            cos = np.sum(one * two, axis=0) / (np.hypot(*one) * np.hypot(*two))
            least = min(least, float(np.degrees(np.arccos(cos)).min()))
    assert np.degrees(demand("mesh_angle", solved())) == pytest.approx(least, abs=2.0)


def test_closure_of_a_table():
    theta = np.radians(np.arange(0.0, 361.0, 5.0))
    values = 0.005 * (1.0 - np.cos(theta))
    values[-1] += 3e-7
    lift = Lift.from_samples(theta, values)
    plain = solved()
    path = replace(plain.contour.pitch, lift=lift)
    there = replace(plain, contour=replace(plain.contour, pitch=path))
    assert demand("closure", there) == pytest.approx(3e-7)
