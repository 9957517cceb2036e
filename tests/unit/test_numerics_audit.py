"""Audit of the numerical checks: each demand by a second formulation, each known defect."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import made_trial as made
import numpy as np
import pytest
from made_check import made_check
from small_machine import small_machine
from trial_variants import with_certificate, with_cycle

from camwright.geometry.acceleration_jump import acceleration_jump
from camwright.geometry.contour import RollerContour
from camwright.geometry.cutter_path import tool_interference
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.lift_fit import fitted_lift
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case import case_file
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks import torque_balance
from camwright.pipeline.checks.cam_shape import acceleration_step, closure, tool_gouge
from camwright.pipeline.checks.error_bars import with_error_bars
from camwright.pipeline.checks.extremes import greatest, least, worst_case
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.checks.roller_bearing import roller_life
from camwright.pipeline.checks.solution_verification import bore_stress as bore_check
from camwright.pipeline.checks.solution_verification import held_distance, mesh_edges
from camwright.pipeline.checks.torque_balance import (
    contact_torque,
    contact_work,
    pressure_torque,
)
from camwright.pipeline.contact.bore_stress import bore_stress
from camwright.pipeline.contact.elasticity.mesh_convergence import converged
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import loaded_cam
from camwright.pipeline.cycle.solution import bore_error
from camwright.pipeline.cycle.solution import solution as solve

# --- grid convergence index ------------------------------------------------------------------


@pytest.mark.parametrize("order", [0.2, 0.3, 0.5, 0.7, 0.99, 1.0, 1.5, 2.0, 3.0])
def test_the_bar_covers_the_error_of_a_manufactured_sequence(order):
    """f = 1 + C h^p: the exact error of the finest mesh is C h^p, whatever p is."""
    sizes = np.array([4.0, 2.0, 1.0])
    values = 1.0 + 0.01 * sizes**order
    error = (values[2] - 1.0) / values[2]
    assert converged(values, 2.0).gci >= error


@pytest.mark.parametrize("order", [0.3, 0.5, 0.8, 0.99])
def test_an_order_below_one_widens_the_bar(order):
    """Roache's formula with F_s = 3 at p = max(1/2, p); at least twice that of the order 1."""
    sizes = np.array([4.0, 2.0, 1.0])
    values = 5.0 - 0.004 * sizes**order
    step = abs(values[2] - values[1]) / values[2]
    expected = {0.3: 3.0 * step / 0.41421356, 0.5: 3.0 * step / 0.41421356}
    gci = converged(values, 2.0).gci
    assert gci == pytest.approx(expected.get(order, 3.0 * step / (2.0**order - 1.0)))
    assert gci > 2.0 * 1.25 * step


def test_a_printed_bar_of_0_066_per_cent_is_really_0_38():
    """Steps of 0.06824 and 0.0528 %: order 0.37. At the order 1 the bar is 0.066 %."""
    fine = 1000.0
    middle, coarse = fine * (1.0 - 5.28e-4), fine * (1.0 - 5.28e-4 - 6.824e-4)
    assert converged([coarse, middle, fine], 2.0).gci == pytest.approx(3.8244e-3, rel=1e-3)


def test_diverging_meshes_have_no_narrower_bar_than_the_least_order():
    """At |f3 - f2| = |f2 - f1| the order is 0: the bar does not fall across it."""
    slow = converged([1.0, 1.0100001, 1.02], 2.0)
    none = converged([1.0, 1.0099999, 1.02], 2.0)
    assert slow.order is not None
    assert none.order is None
    assert none.gci == pytest.approx(slow.gci, rel=1e-4)


def test_each_error_bar_has_the_index_of_its_own_quantity():
    """1 % on p0, 2 % on the half-width, 3 % on von Mises, 4 % on the maximum shear."""
    shares = {"p0": 0.01, "half_width": 0.02, "von_mises": 0.03, "tau_max": 0.04}
    solution = with_certificate(
        p0_cycle=1.0, **{name: made.converged(gci) for name, gci in shares.items()}
    )
    points = tuple(replace(solution.certificate[-1], theta=each) for each in (0.5, 1.5))
    solution = replace(solution, certificate=points)
    expected = {
        "contact_pressure": 0.01, "edge_pressure": 0.01, "shakedown": 0.01,
        "held_distance": 0.02, "first_yield": 0.03, "hardened_case": 0.03, "dang_van": 0.04,
    }  # fmt: skip
    for name, share in expected.items():
        one = made_check(name, 1.0, 2.0)
        by = DECLARED[name].certified_by
        declared = replace(one.declaration, error="contact", certified_by=by)
        one = replace(one, declaration=declared)
        (barred,) = with_error_bars(solution, [one])
        assert barred.error == pytest.approx(share, rel=1e-6), name


# --- steps of the acceleration ---------------------------------------------------------------


def law(name: str, rise: float, step: float, shift: float = 0.0) -> np.ndarray:
    """Rise of 10 mm over an angle, dwell of 40 deg, return, dwell; values every `step`, deg."""
    angle, dwell = np.radians(rise), np.radians(40.0)
    rest = 2.0 * np.pi - 2.0 * angle - dwell
    parts = ((name, angle, 0.01), ("dwell", dwell, 0.0), (name, angle, -0.01), ("dwell", rest, 0.0))
    theta = np.radians(np.arange(0.0, 360.0, step) + shift * step)
    return SegmentMotion(tuple(Segment(*part) for part in parts))(theta)


def share(values: np.ndarray) -> float:
    jump = acceleration_jump(values)
    return jump.size / jump.span


@pytest.mark.parametrize("step", [1.0, 2.0, 5.0])
@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_smooth_laws_have_no_step(step, shift):
    """The dwell ends of all but 4567 have a kink of s'', which is no step."""
    for name in ("polynomial_345", "polynomial_4567", "cycloidal", "modified_sine"):
        for rise in (60.0, 90.0, 140.0):
            assert share(law(name, rise, step, shift)) < 0.02, (name, rise)


@pytest.mark.parametrize(("step", "error"), [(1.0, 0.01), (2.0, 0.03), (5.0, 0.2)])
@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_steps_of_the_laws_are_measured(step, error, shift):
    """Harmonic: from rest to half of the range; parabolic: from one end of the range to the other.

    The range is that of means over two steps: at steps of 5 deg, 8 % short of a sine's in 60 deg.
    """
    for rise in (60.0, 90.0, 140.0):
        assert share(law("harmonic", rise, step, shift)) == pytest.approx(0.5, rel=error)
        assert share(law("parabolic", rise, step, shift)) == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("step", [0.5, 1.0, 2.0])
def test_values_rounded_to_a_micrometre_are_judged_by_their_law(step):
    for name, low, high in (
        ("polynomial_345", 0.0, 0.19), ("cycloidal", 0.0, 0.19), ("modified_sine", 0.0, 0.19),
        ("harmonic", 0.45, 0.6), ("parabolic", 0.85, 1.1),
    ):  # fmt: skip
        for rise in (60.0, 90.0, 140.0):
            values = np.round(law(name, rise, step), 6)
            assert low <= share(values) <= high, (name, rise)


@pytest.mark.parametrize("count", [72, 180, 360, 720])
def test_a_step_of_31_per_cent_fails(count):
    """A sine over the turn with a jump of 0.31 of its range at 100 deg, made up for at 260 deg."""
    theta = np.arange(count) * 2.0 * np.pi / count
    beyond = np.clip(theta - np.radians(100.0), 0.0, np.radians(160.0))
    after = np.maximum(theta - np.radians(260.0), 0.0)
    step = 0.31 * 0.01
    square = 0.5 * step * (beyond**2 + 2.0 * np.radians(160.0) * after)
    values = 0.005 * (1.0 - np.cos(theta)) + square
    # the whole turn closes by a parabola, whose second derivative is constant
    slope, rise = step * np.radians(160.0), square[-1] + step * np.radians(160.0) * theta[1]
    values = values - 0.5 * slope / (2.0 * np.pi) * theta**2
    values = values - (rise - 0.5 * slope * 2.0 * np.pi) / (2.0 * np.pi) * theta
    contour = RollerContour(PitchCurve(Lift(theta, values - values.min()), 0.05), 0.008)
    check = acceleration_step(made.solution(contour=contour))
    second = -0.005 * np.cos(np.linspace(0.0, 2.0 * np.pi, 7201)) * -1.0
    angle = np.degrees(np.linspace(0.0, 2.0 * np.pi, 7201))
    second = second + np.where((angle > 100.0) & (angle < 260.0), step, 0.0)
    assert check.demand == pytest.approx(step / np.ptp(second), rel=0.03)
    assert check.status == "fail"
    assert np.degrees(check.cam_angle) == pytest.approx(100.0, abs=6.0) or np.degrees(
        check.cam_angle
    ) == pytest.approx(260.0, abs=6.0)


def test_a_smooth_table_at_5_deg_passes():
    values = law("polynomial_345", 90.0, 5.0)
    contour = RollerContour(
        PitchCurve(Lift(np.radians(np.arange(0, 360, 5.0)), values), 0.05), 8e-3
    )
    assert acceleration_step(made.solution(contour=contour)).status == "pass"


def test_a_table_at_unequal_angles_is_judged_at_its_own_spacing():
    """The spline through a parabolic table at 4 and 6 deg in turn is smooth at 0.5 deg."""
    theta = np.radians(np.cumsum(np.tile([4.0, 6.0], 36)) - 4.0)
    motion = SegmentMotion(
        (Segment("parabolic", np.pi, 0.01), Segment("parabolic", np.pi, -0.01)),
    )
    lift = Lift.from_samples(theta, motion(theta))
    assert lift.acceleration_jump.size / lift.acceleration_jump.span > 0.8


@pytest.mark.parametrize("rise", [40.0, 100.0, 157.3])
def test_a_lift_by_segments_is_judged_by_its_laws(rise):
    """The knots of a law with jumps are smoothed over a quarter of a degree."""
    angle, dwell = np.radians(rise), np.radians(40.0)
    for name, low, high in (
        ("harmonic", 0.49, 0.52), ("parabolic", 0.98, 1.02), ("polynomial_345", 0.0, 0.02),
        ("modified_trapezoid", 0.0, 0.02), ("cycloidal", 0.0, 0.02),
    ):  # fmt: skip
        parts = ((name, angle, 0.01), ("dwell", dwell, 0.0), (name, angle, -0.01),
                 ("dwell", 2.0 * np.pi - 2.0 * angle - dwell, 0.0))  # fmt: skip
        jump = SegmentMotion(tuple(Segment(*part) for part in parts)).lift().acceleration_jump
        assert low <= jump.size / jump.span <= high, name


def test_a_fitted_lift_of_few_parts_has_no_step():
    """A spline of 12 parts through 720 noisy values; its knots alone resolve no law."""
    theta = np.arange(720) * 2.0 * np.pi / 720
    noise = 2e-6 * np.random.default_rng(1).standard_normal(720)
    table = 0.005 * (1.0 - np.cos(theta)) + 1e-5 + noise
    fit = fitted_lift(theta, table, 3e-6)
    assert fit.parts < 40
    assert fit.lift.acceleration_jump.size < 0.02 * fit.lift.acceleration_jump.span


def test_a_table_that_resolves_no_law_does_not_pass():
    """Six values a rise: the parabolic law has a jump every three of them."""
    jump = acceleration_jump(law("parabolic", 30.0, 5.0))
    assert not jump.resolved
    assert jump.size > 0.5 * jump.span


def test_the_closure_limit_is_that_of_the_reader_of_tables():
    """Half a micrometre is the rounding of a table in mm with three decimals."""
    theta = np.linspace(0.0, 2.0 * np.pi, 73)
    values = 0.005 * (1.0 - np.cos(theta))
    for open_by, status in ((0.99e-6, "pass"), (1.01e-6, None)):
        ends = values + open_by * (theta == theta[-1])
        if status is None:
            with pytest.raises(InputError, match="closure"):
                Lift.from_samples(theta, ends)
            continue
        lift = Lift.from_samples(theta, ends)
        contour = RollerContour(PitchCurve(lift, 0.05), 8e-3)
        plain = case_file.parse_case(small_machine("minimal"))
        solution = replace(made.solution(contour=contour), case=plain, machines=machines(plain))
        assert closure(solution).status == status


# --- cam torque from the contact pressures ---------------------------------------------------


@cache
def solved():
    """The case of every part by finite elements at 24 angles."""
    text = (Path(__file__).parents[1] / "data" / "every_part.toml").read_text()
    case = case_file.parse_case(text)
    return solve(case, case.contour(given_lift(case)), Tier.CYCLE, positions=24, torques={})


def with_solved_contact(**values):
    plain = solved()
    cycle = plain.cycles[0]
    contact = replace(cycle.contact, **values)
    return replace(plain, cycles=(replace(cycle, contact=contact), *plain.cycles[1:]))


def test_the_torque_of_the_pressures_by_summing_r_x_f():
    """On the polygon of 1.4 million chords: each strip of pressure times its moment arm."""
    cycle = solved().cycles[0]
    contact, contour, lift = cycle.contact, cycle.contour, cycle.contour.pitch.lift
    summed = []
    for k, theta in enumerate(cycle.theta):
        fine = theta + np.linspace(-2e-5, 2e-5, 5)
        points = contour.points(fine)
        normal = np.array([points[1, 4] - points[1, 0], points[0, 0] - points[0, 4]])
        normal /= np.hypot(*normal)
        along = np.array([-normal[1], normal[0]])
        xi = np.linspace(contact.pressure_xi[k, 0], contact.pressure_xi[k, -1], 4001)
        pressure = np.interp(xi, contact.pressure_xi[k], contact.pressure[k])
        place = points[:, 2, None] - along[:, None] * xi
        force = -normal[:, None] * pressure * cycle.pair.width
        moment = place[0] * force[1] - place[1] * force[0]
        summed.append(np.trapezoid(moment, xi))
    np.testing.assert_allclose(pressure_torque(cycle), summed, atol=1e-6 * np.max(np.abs(summed)))
    slope = lift(cycle.theta, 1)
    by_forces = cycle.loads.axial_force * slope
    np.testing.assert_allclose(summed, by_forces, atol=1e-6 * np.max(np.abs(by_forces)))
    assert contact_torque(solved()).status == "pass"
    assert contact_work(solved()).status == "pass"


def test_wrong_pressures_fail_the_torque_balance():
    """One per thousand of the force at every angle, a tenth of it at one, a shifted patch."""
    contact = solved().cycles[0].contact
    once = contact.pressure.copy()
    once[5] *= 1.1
    assert contact_torque(with_solved_contact(pressure=1.001 * contact.pressure)).status == "fail"
    assert contact_torque(with_solved_contact(pressure=once)).status == "fail"
    shifted = contact.pressure_xi + 0.5 * contact.half_width[:, None]
    assert contact_torque(with_solved_contact(pressure_xi=shifted)).status == "fail"
    assert contact_work(with_solved_contact(pressure=once)).status == "fail"


def test_the_torque_of_a_sliding_face_includes_its_friction():
    """mu N times the height of the face over the cam axis, beside N s'."""
    shape = made.face_contour()
    case, lift = made.face_case(), shape.pitch.lift
    plain = solve(case, shape, Tier.CYCLE, positions=24, torques={})
    cycle = plain.cycles[0]
    force = cycle.loads.normal_force
    height = made.BASE + lift(cycle.theta)
    wanted = force * (lift(cycle.theta, 1) + plain.machine.follower.side_friction * height)
    assert plain.machine.follower.side_friction > 0.0
    np.testing.assert_allclose(pressure_torque(cycle), wanted, rtol=0, atol=1e-6 * wanted.max())
    assert contact_torque(plain).status == contact_work(plain).status == "pass"


def test_a_contour_other_than_that_of_the_loads_fails_the_torque_balance():
    """The same pressures on a cam turned by 0.1 deg, or of 1 % more lift."""
    plain = solved()
    lift = plain.contour.pitch.lift
    for values in (lift(lift.theta + np.radians(0.1)), 1.01 * lift.values):
        path = replace(plain.contour.pitch, lift=Lift(lift.theta, values))
        cam, cycle = replace(plain.contour, pitch=path), plain.cycles[0]
        other = replace(cycle, contour=cam, pair=replace(cycle.pair, contour=cam))
        assert contact_torque(replace(plain, cycles=(other,))).status == "fail"


# --- error of integrals and of derivatives ---------------------------------------------------


@cache
def previewed(positions: int):
    text = (Path(__file__).parents[1] / "data" / "every_part.toml").read_text()
    case = case_file.parse_case(text)
    contour = case.contour(given_lift(case))
    return solve(case, contour, Tier.PREVIEW, positions=positions, torques={})


@pytest.mark.parametrize("positions", [36, 72, 360])
def test_the_traction_demand_is_that_of_the_roller_s_own_acceleration(positions):
    """J dw/dt over r N, the rate of the speed of 4096 angles by its Fourier series."""
    cycle = previewed(positions).cycles[0]
    path, speed, roller = cycle.contour.pitch, cycle.cam_speed, cycle.machine.roller
    dense = np.arange(4096) * 2.0 * np.pi / 4096
    x, y = path.points(dense)
    order = np.fft.rfftfreq(4096, 1.0 / 4096)
    rate_x, rate_y = (np.fft.irfft(1j * order * np.fft.rfft(part), 4096) for part in (x, y))
    spin = speed * (np.hypot(rate_x, rate_y) / roller.radius - 1.0)
    spin_rate = speed * np.fft.irfft(1j * order * np.fft.rfft(spin), 4096)
    there = np.interp(cycle.theta, dense, spin_rate)
    inertia = 0.5 * np.pi * 7850.0 * roller.width * (roller.radius**4 - roller.hub_radius**4)
    drag = roller.bearing.drag_torque or 0.0
    drag = drag + (roller.bearing.friction or 0.0) * roller.hub_radius * cycle.loads.normal_force
    wanted = np.abs(inertia * there + drag) / (roller.radius * cycle.loads.normal_force)
    found = cycle.rolling.traction_demand
    np.testing.assert_allclose(found, wanted, atol=2e-4 * wanted.max())


KNOWN = {
    # mean over the turn and its exact value
    "|sin|": (lambda t: np.abs(np.sin(t + 0.3)), 2.0 / np.pi),
    "a tent": (lambda t: np.abs(np.mod(t + 0.4, 2.0 * np.pi) - np.pi), 0.5 * np.pi),
    "half a sine": (lambda t: np.maximum(np.sin(t - 0.7), 0.0), 1.0 / np.pi),
    "half a sine squared": (lambda t: np.maximum(np.sin(t - 0.7), 0.0) ** 2, 0.25),
    "a cubed cosine on a mean": (lambda t: (2.0 + np.cos(t)) ** 3, 11.0),
    "a narrow peak": (lambda t: np.exp(6.0 * (np.cos(t) - 1.0)), float(np.exp(-6.0) * np.i0(6.0))),
}


@pytest.mark.parametrize("positions", [36, 48, 90])
@pytest.mark.parametrize("name", KNOWN)
def test_the_bar_of_an_integral_covers_its_error(name, positions):
    function, exact = KNOWN[name]
    cycles = previewed(positions).cycles
    mean = worst_case(cycles, lambda cycle: float(np.mean(function(cycle.theta))))
    assert abs(mean.value - exact) <= mean.error_share * abs(mean.value) + 1e-12
    assert mean.error_share < 0.1


def test_the_bar_of_a_bearing_life_covers_its_error():
    """Of 36 positions against 360; the error of the finer is a hundredth of that."""
    coarse, fine = roller_life(previewed(36)), roller_life(previewed(360))
    assert abs(coarse.demand / fine.demand - 1.0) <= (coarse.error_share or 0.0) + 1e-9
    assert (coarse.error_share or 0.0) > (fine.error_share or 0.0)


PEAKS = {
    "a sine": lambda t: 2.0 + np.sin(t),
    "a narrow peak": lambda t: np.exp(6.0 * (np.cos(t) - 1.0)),
    "two peaks of one height": lambda t: 2.0 + np.sin(2.0 * t) ** 3,
    "a tent": lambda t: 4.0 - np.abs(np.mod(t, 2.0 * np.pi) - np.pi),
    "a cubed cosine": lambda t: (2.0 + np.cos(t)) ** 3,
    "a jump at its top": lambda t: 1.0 + np.where(
        np.mod(t, 2.0 * np.pi) < 2.0, np.mod(t, 2.0 * np.pi), 0.0),
}  # fmt: skip


@pytest.mark.parametrize("positions", [36, 72, 360])
@pytest.mark.parametrize("name", PEAKS)
def test_the_bar_of_an_extreme_covers_the_value_between_samples(name, positions):
    function = PEAKS[name]
    cycles = previewed(positions).cycles
    dense = np.linspace(0.0, 2.0 * np.pi, 20001)
    for shift in np.linspace(0.0, 2.0 * np.pi / positions, 5):
        for sign, search in ((1.0, greatest), (-1.0, least)):
            extreme = search(cycles, lambda c, s=sign, h=shift: s * function(c.theta + h))
            error = function(dense).max() - sign * extreme.value
            # the parabola leaves the fourth order of a peak beside a sample
            assert error <= abs(extreme.value) * (extreme.error_share + 3e-6)


def test_the_bar_of_an_extreme_beside_infinite_values():
    """A ratio that is infinite without load keeps the bar of its least value elsewhere."""
    cycles = previewed(72).cycles

    def ratio(cycle):
        theta = cycle.theta + 0.07
        return np.where(theta < 1.0, np.inf, 2.0 - np.sin(theta - 1.0))

    assert least(cycles, ratio).error_share > 1e-5


def test_a_residual_has_no_error_of_an_integral():
    assert not torque_balance.friction_balance(previewed(72)).error_share


@pytest.mark.parametrize("step", [2, 3])
def test_every_few_positions_of_every_result(step):
    """Arrays of the turn are thinned, those of machine and contour are not."""
    cycle = solved().cycles[0]
    half = cycle.thinned[step]
    assert half.theta.tolist() == cycle.theta[::step].tolist()
    assert half.contour is cycle.contour
    assert half.machine is cycle.machine
    assert half.contact.pressure.tolist() == cycle.contact.pressure[::step].tolist()
    assert half.loads.cam_torque.tolist() == cycle.loads.cam_torque[::step].tolist()
    quick = previewed(36).cycles[0]
    part, rolling = quick.thinned[step].parts, quick.thinned[step].rolling
    assert part.heat_a.tolist() == quick.parts.heat_a[::step].tolist()
    assert rolling.traction_demand.tolist() == quick.rolling.traction_demand[::step].tolist()


# --- mesh and model --------------------------------------------------------------------------


def test_the_distance_to_holds_is_that_of_the_nodes_that_are_held_or_supported():
    """From the contact to the nearest node of the ring's bore and of the cam's, in the meshes."""
    plain = solved()
    bodies, contour = plain.cycles[0].bodies, plain.contour
    ring = bodies.follower.body.mesh
    top = np.array([[0.0], [plain.machine.roller.radius]])
    nearest = np.hypot(*(ring.points[:, ring.boundary_nodes("hub")] - top)).min()
    cam = bodies.cam.body.mesh
    nodes = [cam.points[:, cam.boundary_nodes(name)] for name in ("bore", "keyway")]
    held = max(float(np.hypot(*each).max()) for each in nodes)
    wall = np.hypot(*contour.polygon(3600)).min() - held
    half_width = max(float(c.contact.half_width.max()) for c in plain.cycles)
    demand = held_distance(plain).demand
    # the nearest node lies beside the contact by up to an element
    assert demand == pytest.approx(min(nearest, wall) / half_width, rel=5e-3)
    assert demand < 0.5 * (8e-3 - 4e-3) / half_width


def test_the_node_spacings_of_the_contact_are_those_of_the_mesh():
    """Nodes of the contour within a half-width of the contact, middle nodes included."""
    mesh, contour = solved().mesh, solved().contour
    contact = contour.points(mesh.theta)
    apart = np.hypot(*(mesh.cam.points - contact[:, None]))
    surface = np.isin(np.arange(apart.size), mesh.cam.boundary_nodes("contour"))
    near = np.sort(((mesh.cam.points - contact[:, None]) * contour.tangent(mesh.theta)[:, None])
                   .sum(axis=0)[surface & (apart <= mesh.half_width)])  # fmt: skip
    check = mesh_edges(solved())
    assert check.demand == pytest.approx(mesh.half_width / np.diff(near).max(), rel=0.03)
    assert check.status == "pass"
    assert check.limit == 10.0


# --- tool --------------------------------------------------------------------------------------


@pytest.mark.parametrize("radius", [0.02, 0.06, 0.075, 0.1, 0.3])
def test_the_gouge_of_a_wheel_by_distances_to_all_points(radius):
    """The least concave radius is 68 mm: a smaller wheel fits, a greater one cuts."""
    shape = made.hollow()
    x, y = shape.polygon(10800)
    across = np.stack([np.roll(y, -1) - np.roll(y, 1), np.roll(x, 1) - np.roll(x, -1)])
    centre = np.stack([x, y]) + radius * across / np.hypot(*across)
    apart = np.hypot(x - centre[0, ::45, None], y - centre[1, ::45, None])
    wanted = float(np.max(radius - apart))
    gouge = max(0.0, -tool_interference(shape, radius).clearance)
    assert gouge == pytest.approx(wanted if radius > 0.068 else 0.0, rel=0.03, abs=2e-7)
    assert (gouge > 1e-6) == (radius > 0.07)


def test_a_tool_is_needed_for_a_concave_cam_alone():
    bare = made.case(limits=made.limits(tool_radius=None).limits)
    concave = tool_gouge(made.changed_solution(made.solution(contour=made.hollow()), case=bare))
    assert (concave.status, concave.must_have) == ("not_evaluated", True)
    assert tool_gouge(made.solution(case=bare)).status == "pass"


# --- ripple ------------------------------------------------------------------------------------


def test_the_bar_of_a_speed_reduction_is_its_change_with_half_of_the_angles():
    halved = made.solution(crank_speed_halved={"idle": (2.0, 1.002)})
    check = torque_balance.speed_reduction(halved)
    assert (check.demand, check.error) == (pytest.approx(0.5), pytest.approx(0.001))
    at_limit = replace(halved, case=made.limits(speed_reduction=0.4995))
    assert torque_balance.speed_reduction(made.changed_solution(at_limit)).status == "fail"


def test_the_bars_of_the_torque_reductions_cover_a_rough_trace():
    """A cam torque with one harmonic above the half sampling of 18 positions."""
    theta = made.THETA
    before, after = 10.0 * np.sin(theta), 2.0 * np.sin(theta) + 4.0 * np.cos(19.0 * theta)
    solution = with_cycle(torque_before=before, torque_after=after)
    check = torque_balance.torque_reduction(solution)
    assert check.demand == pytest.approx(1.0 - np.std(after) / np.std(before))
    assert check.error is not None
    halved = 1.0 - np.std(after[::2]) / np.std(before[::2])
    assert check.error >= abs(halved - check.demand) - 1e-12


# --- bore --------------------------------------------------------------------------------------


@pytest.mark.slow
def test_the_bar_of_the_bore_stress_covers_a_four_times_finer_mesh():
    plain = solved()
    pair, cycle = plain.cycles[0].pair, plain.cycles[0]
    error = bore_error(pair, plain.cycles)
    bore = cycle.rolling.bore
    k = int(np.argmax(bore.away_from_edges))
    at = cycle.theta[[k]]
    fine = bore_stress(
        loaded_cam(pair, refinement=4.0), pair.contour.points(at), pair.contour.normal(at),
        cycle.contact.line_load[[k]], excluded=bore.excluded,
    )  # fmt: skip
    assert error is not None
    assert abs(fine.away_from_edges[0] / bore.away_from_edges[k] - 1.0) <= error
    assert error < 0.5
    (barred,) = with_error_bars(replace(plain, bore_error=error), [bore_check(plain)])
    sampled = bore_check(plain).error_share
    assert barred.error == pytest.approx((error + sampled) * barred.demand)
    (bare,) = with_error_bars(plain, [bore_check(plain)])
    assert bare.error is None
