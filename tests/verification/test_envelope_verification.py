"""The rolling pass and the map of a turn against closed forms."""

from functools import cache

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.bore_stress import bore_stress
from camwright.pipeline.contact.closed_form import closed_form_history
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.contact_patch import contact_patch
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.elasticity.plane_stress_measures import (
    shear_in_plane,
    von_mises,
)
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.rolling_envelope import (
    STATIONS,
    FatigueLimits,
    governing_stations,
    greatest_line,
    rolling_pass,
    smallest_sphere,
    swept,
)
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.rolling_history import added_stress

STEEL = Elastic(210e9, 0.3)
WIDTH = 0.005
LIMITS = FatigueLimits(300e6, 450e6)


def pair_of(stroke, keyway=None):
    theta = uniform_turn(360)
    lift = Lift(theta, stroke * (1 - np.cos(theta)) / 2)
    contour = RollerContour(PitchCurve(lift, 0.05), 0.008)
    return ContactPair(
        contour, WIDTH, 0.0085, keyway, STEEL, RollerBody(contour.roller_radius, 0.0042, STEEL)
    )


@cache
def circular():
    pair = pair_of(0.0)
    return pair, CycleBodies.meshed(pair)


def test_stresses_with_those_of_the_body_are_of_their_sum():
    """Pass and body stress added at each point, within two half-widths; to round-off."""
    pair, theta = pair_of(0.0), uniform_turn(90)
    contact = closed_form_history(pair, theta, force(theta))
    load = force(theta) / WIDTH
    body = 4e7 * np.sin(3 * theta)
    envelope = swept(pair, theta, contact, theta, load, body_stress=body)
    field = rolling_pass(0.3).stress
    middle = field.shape[2] // 2
    near = field[:, :, middle - 160 : middle + 161]
    for k in (0, 20, 55):
        total = contact.p0[k] * near + body[k] * np.eye(3)[0][:, None, None]
        for values, measured in (
            (envelope.von_mises, von_mises(total, 0.3)),
            (envelope.tau_max, shear_in_plane(total)),
        ):
            np.testing.assert_allclose(values[k], measured.max(axis=1), rtol=1e-9)


def force(theta):
    """Of a lift of 20 mm, with two humps."""
    return 600 + 300 * np.cos(2 * theta) + 100 * np.sin(theta)


def test_the_pass_has_the_figures_of_theory():
    """Johnson (1985), secs. 4.2 and 9.2: at depths of 0.05 half-widths."""
    found = rolling_pass(0.3)
    for name, value, depth, slack in (
        ("shear_range", 0.5, 0.5, 1e-4),
        ("tau_max", hertz.SHEAR_MAX, hertz.SHEAR_MAX_DEPTH, 5e-4),
        ("von_mises", 0.557516, 0.704292, 1e-4),
        ("shear_amplitude", 0.25, 0.5, 2e-3),
    ):
        values = getattr(found, name)
        assert values.max() == pytest.approx(value, rel=slack), name
        assert found.depth[values.argmax()] == pytest.approx(depth, abs=0.026), name
    assert not found.hydrostatic_max.any(), "without friction nothing is pulled"


def test_sliding_pulls_at_the_trailing_edge():
    """2 mu p0 along the surface at the edge of the contact, all of it in plane strain."""
    found = rolling_pass(0.3, 0.2)
    assert found.hydrostatic_max[0] == pytest.approx(1.3 / 3 * 0.4, rel=1e-2)
    assert found.shear_range[0] == pytest.approx(0.2, rel=1e-3)


def test_finite_elements_go_through_the_same_pass():
    patch = contact_patch(0.3)
    field = patch.stress @ np.sqrt(np.maximum(1 - patch.shapes.centres**2, 0))
    level = np.abs(patch.points[1] - 0.5) < 0.03
    assert np.ptp(field[2][level]) == pytest.approx(0.5, rel=1e-2)


@pytest.mark.parametrize("length", [1.0, 3.0])
def testsmallest_sphere_of_a_straight_path(length):
    path = np.zeros((3, 1, 50))
    path[1, 0] = np.linspace(-length, 0, 50)
    centre, radius = smallest_sphere(path)
    assert radius == pytest.approx(length / 2, rel=1e-3)
    assert centre[:, 0] == pytest.approx([0, -length / 2, 0], abs=1e-3 * length)


def testsmallest_sphere_of_a_circle_and_a_point_inside():
    angle = np.linspace(0, 2 * np.pi, 100)
    path = np.stack([np.cos(angle), np.sin(angle), 0 * angle])[:, None]
    path = np.concatenate([path, np.full((3, 1, 1), 0.2)], axis=2)
    assert smallest_sphere(path)[1] == pytest.approx(1.0, rel=2e-3)


def test_fatigue_weights_give_back_both_limits():
    """Reversed bending f: root J2 f/sqrt(3), shear f/2, hydrostatic f/3; torsion is its own."""
    limits = FatigueLimits(300e6, 450e6)
    f = limits.bending
    assert f / np.sqrt(3) + limits.crossland * f / 3 == pytest.approx(300e6)
    assert f / 2 + limits.dang_van * f / 3 == pytest.approx(300e6)


@pytest.mark.parametrize(("torsion", "bending"), [(0, 1e8), (1e8, 0.8e8), (1e8, 2.1e8)])
def test_fatigue_limits_refuse(torsion, bending):
    with pytest.raises(InputError):
        FatigueLimits(torsion, bending)


def test_compression_gets_no_credit():
    limits = FatigueLimits(300e6, 450e6)
    found = rolling_pass(0.3)
    assert found.dang_van(limits) == pytest.approx(found.shear.max(axis=1))
    assert found.crossland(limits) == pytest.approx(found.shear_amplitude)


def test_constant_load_on_a_circular_cam():
    """Finite elements at 60 angles; shear range 0.5 p0 at 0.5 a within 1 % everywhere."""
    pair, bodies = circular()
    theta, stations = uniform_turn(60), uniform_turn(STATIONS)
    contact = two_scale_history(pair, bodies, theta, np.full(60, 500.0))
    map_ = swept(pair, theta, contact, stations, np.full(STATIONS, 500.0 / WIDTH))
    half_width, p0 = hertz.line_contact(
        500 / WIDTH, pair.relative_radius(0.0), pair.contact_modulus
    )
    assert map_.shear_range.max(axis=1) == pytest.approx(np.full(STATIONS, 0.5 * p0), rel=1e-2)
    level = map_.shear_range.argmax(axis=1)
    depth = map_.depth[np.arange(STATIONS), level]
    assert depth == pytest.approx(np.full(STATIONS, 0.5 * half_width), rel=1e-2)
    assert map_.tau_max.max() == pytest.approx(hertz.SHEAR_MAX * p0, rel=1e-2)
    assert map_.arc[-1] == pytest.approx(2 * np.pi * 0.042 * (1 - 1 / STATIONS), rel=1e-6)


def swept_at(count, solve):
    pair = pair_of(0.02)
    theta, stations = uniform_turn(count), uniform_turn(STATIONS)
    contact = solve(pair, theta, force(theta))
    return swept(pair, theta, contact, stations, force(stations) / WIDTH, limits=LIMITS)


def test_governing_stations_hold_the_greatest_stresses_and_uses_of_a_strength():
    pair, theta, stations = pair_of(0.02), uniform_turn(180), uniform_turn(STATIONS)
    contact, load = closed_form_history(pair, theta, force(theta)), force(stations) / WIDTH
    every, few = (
        swept(pair, theta, contact, stations, load, limits=LIMITS, governing=governing)
        for governing in (False, True)
    )
    assert few.theta.size < 0.1 * every.theta.size
    for name in ("von_mises", "tau_max", "shear_range", "crossland", "dang_van"):
        assert getattr(few, name).max() == getattr(every, name).max(), name
    for case_depth in (0.05e-3, 0.2e-3, 1e-3):
        use, of_all = (
            (at.von_mises / (900e6 - 500e6 * np.minimum(at.depth / case_depth, 1.0))).max()
            for at in (few, every)
        )
        assert use == of_all


def test_governing_stations_are_those_that_no_other_exceeds_in_both():
    p0, half_width = np.array([3.0, 2.0, 2.0, 3.0, 1.0]), np.array([1.0, 2.0, 3.0, 1.0, 2.0])
    np.testing.assert_array_equal(governing_stations(p0, half_width), [0, 2])
    p0[1] = np.nan
    np.testing.assert_array_equal(governing_stations(p0, half_width), np.arange(5))


def assert_alike(one, two):
    for name in ("von_mises", "tau_max", "shear_range", "crossland", "dang_van"):
        a, b = getattr(one, name).max(axis=1), getattr(two, name).max(axis=1)
        assert a == pytest.approx(b, rel=1e-2), name


@pytest.fixture(scope="module")
def bodies():
    return CycleBodies.meshed(pair_of(0.02))


def test_positions_do_not_matter(bodies):
    """180 against 720 positions, every station of the contour within 1 %."""

    def solve(pair, theta, load):
        return two_scale_history(pair, bodies, theta, load)

    assert_alike(swept_at(180, solve), swept_at(720, solve))


@pytest.mark.slow
def test_many_positions_do_not_matter_either(bodies):
    def solve(pair, theta, load):
        return two_scale_history(pair, bodies, theta, load)

    assert_alike(swept_at(720, solve), swept_at(2880, solve))


def test_where_the_roller_has_left_there_is_no_stress():
    pair = pair_of(0.02)
    theta, stations = uniform_turn(180), uniform_turn(360)
    load = np.maximum(force(theta) - 400, 0)
    contact = closed_form_history(pair, theta, load)
    there = np.maximum(force(stations) - 400, 0) / WIDTH
    map_ = swept(pair, theta, contact, stations, there)
    assert (there == 0).any()
    assert not map_.von_mises[there == 0].any()
    assert (map_.von_mises[there > 0].max(axis=1) > 0).all()


def test_upper_envelope_of_lines_is_their_greatest_value():
    rng = np.random.default_rng(5)
    height, slope = rng.normal(size=(2, 7, 40))
    height[0], slope[1] = slope[1].max(), slope[1, 0]  # lines through a point; parallel ones
    at = np.sort(rng.normal(size=30))
    everywhere = (height + at[:, None, None] * slope).max(axis=2)
    np.testing.assert_allclose(greatest_line(height, slope, at), everywhere, rtol=1e-12)


def test_stress_of_the_body_comes_on_top():
    pair = pair_of(0.02)
    theta = uniform_turn(180)
    contact = closed_form_history(pair, theta, force(theta))
    extra = np.full(180, 50e6)
    plain, more = (
        swept(pair, theta, contact, theta, force(theta) / WIDTH, body_stress=stress)
        for stress in (None, extra)
    )
    # Tension along the surface adds half of itself to the shear where the load presses down.
    gained = more.tau_max.max(axis=1) - plain.tau_max.max(axis=1)
    assert gained == pytest.approx(np.full(180, 25e6), rel=0.02)


def test_pull_of_the_body_counts_in_the_fatigue_values_and_push_does_not():
    pair = pair_of(0.02)
    theta = uniform_turn(180)
    contact = closed_form_history(pair, theta, force(theta))
    limits = FatigueLimits(300e6, 450e6)

    def values(along):
        extra = np.full(180, along)
        load = force(theta) / WIDTH
        found = swept(pair, theta, contact, theta, load, limits=limits, body_stress=extra)
        return np.stack([found.crossland, found.dang_van])

    plain = values(0.0)
    np.testing.assert_allclose(values(-30e6), plain, rtol=1e-12)
    # Where no half-plane stress is left, far before the load, the body's is all there is.
    gained = (values(30e6) - plain)[0].max()
    assert gained == pytest.approx(limits.crossland * 1.3 / 3 * 30e6, rel=0.02)
    assert (values(30e6)[1] >= plain[1]).all()


def test_stress_added_by_a_real_cam_is_that_of_its_correction():
    pair, bodies = pair_of(0.02), CycleBodies.meshed(pair_of(0.02))
    theta = uniform_turn(180)
    load = force(theta) / WIDTH
    along = added_stress(pair, bodies, theta, load)
    exact = bodies.cam.correction(pair.contour.points(theta), pair.contour.normal(theta)).along
    np.testing.assert_allclose(along, load * exact, atol=0.01 * np.abs(load * exact).max())


def test_bore_of_a_round_cam_feels_the_same_at_every_angle():
    pair, bodies = circular()
    theta = uniform_turn(24)
    found = bore_stress(
        bodies.cam, pair.contour.points(theta), pair.contour.normal(theta), np.full(24, 1e5)
    )
    assert found.von_mises == pytest.approx(np.full(24, found.von_mises[0]), rel=1e-2)
    # It is felt most on the side of the roller, where a rigid shaft resists shear: at 45 deg.
    side = found.x * np.cos(theta) + found.y * np.sin(theta)
    assert side / 0.0085 == pytest.approx(np.full(24, np.cos(np.pi / 4)), abs=0.05)
    assert not found.at_edge.any()


def test_bore_agrees_with_the_whole_field():
    """A line force in place of the ellipse: 0.5 % four hundred half-widths away."""
    pair, bodies = circular()
    theta = np.linspace(0.3, 6.0, 12)
    at, up = pair.contour.points(theta), pair.contour.normal(theta)
    load, half_width = np.linspace(1e5, 2e5, 12), np.full(12, 1e-4)
    correction = bodies.cam.correction_fields(at, up)
    points = bodies.cam.body.mesh.points
    field = bodies.cam.superposed(points, correction, at, up, load, half_width)[1]
    on_bore = von_mises(field[:, bodies.cam.body.mesh.boundary_nodes("bore")], 0.3).max(axis=0)
    assert bore_stress(bodies.cam, at, up, load).von_mises == pytest.approx(on_bore, rel=5e-3)
    # Few contacts are solved on the whole body, many on the condensed one.
    few = bore_stress(bodies.cam, at[:, :1], up[:, :1], load[:1])
    assert few.von_mises == pytest.approx(on_bore[:1], rel=5e-3)


def test_displacements_do_not_depend_on_what_was_solved_before():
    """To the bit; 185 contacts leave a last part of five, which alone are solved otherwise."""
    theta = uniform_turn(185)
    pair = circular()[0]
    at, up = pair.contour.points(theta), pair.contour.normal(theta)
    first, second = (CycleBodies.meshed(pair).cam for _ in range(2))
    many, few = [list(first.displacements(at[:, s:], up[:, s:])) for s in (0, 180)]
    few_first = list(second.displacements(at[:, 180:], up[:, 180:]))
    again = list(second.displacements(at, up))
    for one, other in zip([*many, *few], [*again, *few_first], strict=True):
        np.testing.assert_array_equal(one[1], other[1])
    np.testing.assert_allclose(many[-1][1], few[0][1], atol=1e-9 * np.abs(few[0][1]).max())


def test_bore_grows_with_the_load_and_names_the_edges_of_the_keyway():
    from cam_parts import Keyway

    pair = pair_of(0.0, Keyway(0.005, 0.0023, 0.0))
    bodies = CycleBodies.meshed(pair)
    theta = np.array([0.0, 0.0])
    found = bore_stress(
        bodies.cam, pair.contour.points(theta), pair.contour.normal(theta), np.array([1e5, 3e5])
    )
    assert found.von_mises[1] == pytest.approx(3 * found.von_mises[0], rel=1e-12)
    assert found.away_from_edges[0] <= found.von_mises[0]
    if found.at_edge[0]:
        assert abs(abs(found.y[0]) - 0.0025) < 1e-3
