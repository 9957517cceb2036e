"""The cycle tier against the full contact: what real bodies add, and where it stops."""

import numpy as np
import pytest
from cam_parts import Keyway

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact.body_compliance import LoadedBody
from camwright.pipeline.contact.certificate import solve_pair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import sparse_factor
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, ElasticBody
from camwright.pipeline.contact.elasticity.pressure_distribution import PressureShapes
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame, normal_loads
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history

THETA = uniform_turn(720)
STEEL = Elastic(210e9, 0.3)
WIDTH = 5e-3
SLOT = Keyway(4e-3, 2e-3, np.pi)


def pair(cam=STEEL, roller=STEEL, *, lift=0.0, pitch=0.03, bore=6e-3, hub=4e-3, keyway=None):
    """A roller of 10 mm on a cam with two lobes, round without lift."""
    law = Lift(THETA, lift / 2 * (1 - np.cos(2 * THETA)))
    contour = RollerContour(PitchCurve(law, pitch), 0.01)
    return ContactPair(
        contour, WIDTH, bore, keyway, cam, RollerBody(contour.roller_radius, hub, roller)
    )


def history(of, theta, force):
    angles = np.atleast_1d(np.asarray(theta, dtype=float))
    forces = np.broadcast_to(np.asarray(force, dtype=float), angles.shape)
    return two_scale_history(of, CycleBodies.meshed(of), angles, forces)


@pytest.mark.parametrize(
    ("of", "theta", "force"),
    [
        pytest.param(pair(lift=4e-3, keyway=SLOT), 0.7, 20.0, id="light"),
        pytest.param(pair(lift=4e-3, keyway=SLOT), 0.5 * np.pi, 2e4, id="heavy"),
        pytest.param(pair(keyway=SLOT), np.pi, 2e3, id="over the keyway"),
        pytest.param(pair(hub=9e-3), 0.0, 2e3, id="thin roller"),
        pytest.param(pair(bore=18.5e-3), 0.0, 2e3, id="thin cam"),
        pytest.param(pair(pitch=10.4e-3, bore=2e-4), 0.0, 200.0, id="cam of 0.4 mm"),
        pytest.param(pair(roller=Elastic(2.1e9, 0.49)), 0.0, 200.0, id="soft roller"),
        pytest.param(
            pair(Elastic(2.1e9, 0.49), Elastic(2.1e12, 0.0)), 0.0, 200.0, id="soft cam"
        ),
    ],
)  # fmt: skip
def test_cycle_agrees_with_the_certificate(of, theta, force):
    # Gate 0.5 % of every signed figure against the full contact at h = a/8.
    cycle, full = history(of, theta, force), solve_pair(of, theta, force).solution
    for name, gate in (("p0", 5e-4), ("half_width", 1e-3), ("tau_max", 4e-3), ("von_mises", 4e-3)):
        found = float(getattr(cycle, name)[0])
        np.testing.assert_allclose(found, getattr(full, name), rtol=gate, err_msg=name)
    np.testing.assert_allclose(cycle.tau_depth[0], full.tau_depth, rtol=0.02)


def test_thin_ring_presses_harder_than_hertz_says():
    # The bend has a sign: a layer on a rigid hub is stiffer beside the contact than below it.
    found = history(pair(hub=9e-3), 0.0, 2e3)
    assert 4e-3 < found.p0_difference[0] < 6e-3


def test_stress_moves_smoothly_over_the_turn():
    of = pair(lift=4e-3, keyway=SLOT)
    ratio = history(of, THETA, 2e3)
    share = ratio.tau_max / ratio.p0
    assert np.abs(np.diff(share)).max() < 1e-3 * share.mean()
    # No steps where the contact passes a node: the second difference is that of the lobes.
    assert np.abs(np.diff(share, 2)).max() < 5e-5 * share.mean()


def test_many_positions_are_answered_as_few_are():
    # Many go through a condensed body, few through the whole one.
    of = pair(lift=4e-3, keyway=SLOT)
    angles = THETA[::48]
    many, few = history(of, angles, 2e3), history(of, angles[:3], 2e3)
    for name in ("p0", "half_width", "tau_max", "von_mises"):
        np.testing.assert_allclose(getattr(few, name), getattr(many, name)[:3], rtol=1e-9)


def test_no_load_gives_zeros_without_a_warning():
    of = pair()
    found = history(of, [0.0, 1.0, 2.0], [0.0, 500.0, -3.0])
    for name in ("p0", "half_width", "tau_max", "von_mises", "tau_depth", "p0_difference"):
        values = getattr(found, name)
        assert values[0] == values[2] == 0, name
    assert found.p0[1] > 0


def test_pressure_grows_as_the_root_of_the_load_over_six_decades():
    force = np.geomspace(1e-3, 1e3, 7)
    found = history(pair(), np.zeros(7), force)
    np.testing.assert_allclose(found.p0, found.p0[0] * np.sqrt(force / force[0]), rtol=1e-3)
    assert found.residual_equilibrium.max() < 1e-10
    assert found.residual_complementarity.max() < 1e-9


@pytest.mark.parametrize(
    ("of", "mostly"),
    [(pair(hub=9e-3), "bending_follower"), (pair(bore=18.5e-3), "bending_cam")],
)
def test_difference_from_hertz_is_the_bending_of_the_thin_body(of, mostly):
    # Of a round cam: both bodies on the mesh of the certificate against Hertz, 1e-4 of p0 by mesh.
    cycle, full = history(of, 0.0, 2e3), solve_pair(of, 0.0, 2e3).solution
    off = full.p0 / cycle.p0_hertz[0] - 1
    assert off > 2e-3
    np.testing.assert_allclose(cycle.bending_cam + cycle.bending_follower, off, atol=1.5e-4)
    assert getattr(cycle, mostly)[0] > 0.9 * off


def test_vanishing_load_is_told_by_the_round_off_of_its_gap():
    # The scatter of p0 over the contour at one load, against the round-off that is stated.
    of = pair(lift=4e-3)
    bodies, angles = CycleBodies.meshed(of), np.linspace(0.1, 6.0, 24)
    shape = two_scale_history(of, bodies, angles, np.full(24, 0.1)).p0_difference
    for force in (1e-3, 1e-4, 1e-5):
        found = two_scale_history(of, bodies, angles, np.full(24, force))
        scatter = np.abs(found.p0_difference - shape).max()
        assert 0.05 < scatter / found.gap_round_off.max() < 1.0
        assert not found.below_round_off.any()
    force = np.geomspace(1e-320, 1e-6, 24)
    found = two_scale_history(of, bodies, angles, force)
    assert found.below_round_off.all()
    np.testing.assert_array_equal(found.p0, found.p0_hertz)
    assert "Hertz at 24 angles of vanishing load" in found.method
    # The stored pressure carries the load; the least forces have no normal numbers.
    carried = np.trapezoid(found.pressure, found.pressure_xi, axis=1)
    normal = force > 1e-200
    np.testing.assert_allclose(carried[normal], force[normal] / WIDTH, rtol=1e-9)
    rest = two_scale_history(of, bodies, angles, np.zeros(24))
    assert not rest.below_round_off.any()
    assert "vanishing" not in rest.method


def test_superposed_field_is_that_of_the_load_itself():
    # Half-plane plus correction against the same mesh under the nodal loads of the pressure.
    radius, half_width, load = 0.01, 2e-4, 1e6
    sizing = ElementSize.from_half_width(half_width, radius / 6, edges=6)
    mesh = roller_mesh(radius, 0.4 * radius, 0.5 * np.pi, sizing)
    body = ElasticBody(mesh, STEEL.modulus, STEEL.poisson, "hub")
    at, normal = np.array([[0.0], [radius]]), np.array([[0.0], [1.0]])
    loaded = LoadedBody(body, "rim")
    correction = loaded.correction_fields(at, normal)
    under = np.array([load]), np.array([half_width])
    displacement, _ = loaded.superposed(mesh.points, correction, at, normal, *under)
    frame = ContactFrame(at[:, 0], normal[:, 0])
    shapes = PressureShapes(np.linspace(-half_width, half_width, 41))
    ellipse = np.sqrt(1 - (shapes.centres / half_width) ** 2)
    pressure = load * ellipse / (shapes.integrals @ ellipse)
    direct = body.displacement(-(normal_loads(mesh, "rim", frame, shapes) @ pressure)[:, :, None])
    away = np.hypot(*(mesh.points - at)) > 10 * half_width
    size = np.abs(direct[:, away]).max()
    np.testing.assert_allclose(displacement[:, away], direct[:, away], atol=1e-2 * size)


@pytest.mark.parametrize(("module", "name"), [("cvxopt", "cholmod"), ("pypardiso", "pardiso")])
def test_a_faster_solver_gives_the_same_answers(module, name, monkeypatch):
    pytest.importorskip(module, reason="optional back end", exc_type=ImportError)
    monkeypatch.setattr(sparse_factor, "back_end", lambda: name)
    mesh = roller_mesh(1.0, 0.3, 0.0, ElementSize(far_size=0.3))
    body = ElasticBody(mesh, 1.0, 0.3, "hub")
    matrix = body.stiffness[body.free_dofs][:, body.free_dofs]
    right = np.random.default_rng(0).normal(size=(matrix.shape[0], 4))
    fast = sparse_factor.factorised(matrix)(right)
    monkeypatch.undo()
    monkeypatch.setenv("CAMWRIGHT_SOLVER", "scipy")
    assert sparse_factor.back_end() == "scipy"
    np.testing.assert_allclose(fast, sparse_factor.factorised(matrix)(right), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("force", [1e5, 5e6])
def test_a_contact_that_is_not_locally_flat_is_not_answered(force):
    # The full contact stands in there; the cycle must not make a number up.
    found = history(pair(), 0.0, force)
    assert np.isnan(found.p0[0]) and np.isnan(found.tau_max[0])
    assert found.p0_hertz[0] > 0


@pytest.mark.parametrize("change", ["nothing", "load", "lift", "bore", "material", "grid"])
def test_a_body_already_known_is_not_solved_again(change, tmp_path, monkeypatch):
    # The correction depends on the body and the grid alone, and is the same to the bit.
    monkeypatch.delenv(disk_cache.OFF, raising=False)
    monkeypatch.setenv(disk_cache.FOLDER, str(tmp_path))
    theta, force = np.linspace(0.0, 1.0, 12), 1000.0
    first = history(pair(lift=2e-3), theta, force)
    of = {
        "lift": pair(lift=2.001e-3),
        "bore": pair(lift=2e-3, bore=6.01e-3),
        "material": pair(Elastic(211e9, 0.3), lift=2e-3),
    }.get(change, pair(lift=2e-3))
    again = theta + 1e-9 if change == "grid" else theta
    load = 1100.0 if change == "load" else force
    solved = []
    original = LoadedBody._displacement_slopes
    monkeypatch.setattr(
        LoadedBody,
        "_displacement_slopes",
        lambda body, *at: (solved.append(body.surface), original(body, *at))[1],
    )
    second = history(of, again, load)
    assert solved == ([] if change in ("nothing", "load") else ["contour"])
    monkeypatch.setenv(disk_cache.OFF, "1")
    without = history(of, again, load)
    for name in ("p0", "half_width", "tau_max", "von_mises", "pressure"):
        assert np.array_equal(getattr(second, name), getattr(without, name)), name
        assert change != "nothing" or np.array_equal(getattr(second, name), getattr(first, name))
