"""Cam and roller as a contact pair: what an unloaded or a too wide contact gives."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.store import PACKED, Store
from camwright.pipeline.base.worker_processes import crew
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle import certificate_angles

STEEL = Elastic(210e9, 0.3)


def round_cam(cam: Elastic = STEEL) -> ContactPair:
    """A circle of 42 mm under a roller of 8 mm."""
    theta = uniform_turn(36)
    contour = RollerContour(PitchCurve(Lift(theta, np.zeros(36)), 50e-3), 8e-3)
    return ContactPair(
        contour, 5e-3, 10e-3, None, cam, RollerBody(contour.roller_radius, 4e-3, STEEL)
    )


@pytest.fixture(scope="module")
def bodies() -> CycleBodies:
    return CycleBodies.meshed(round_cam())


def test_apart_is_an_answer(bodies: CycleBodies) -> None:
    pair, theta = round_cam(), np.array([0.0, 1.0, 2.0])
    found = two_scale_history(pair, bodies, theta, np.array([0.0, 800.0, -5.0]))
    for name in ("line_load", "p0", "half_width", "tau_max", "von_mises"):
        values = getattr(found, name)
        assert values[0] == values[2] == 0.0 < values[1], name
    np.testing.assert_array_equal(found.pressure[[0, 2]], 0.0)
    np.testing.assert_array_equal(found.p0_difference[[0, 2]], 0.0)


def test_round_cam_is_alike_at_every_angle(bodies: CycleBodies) -> None:
    theta = np.linspace(0.0, 6.0, 23)
    found = two_scale_history(round_cam(), bodies, theta, np.full(theta.size, 800.0))
    # The contact falls anywhere between the nodes of the body's mesh; 1e-4 is what that moves.
    for name, rtol in (("p0", 1e-6), ("half_width", 1e-6), ("tau_max", 1e-4), ("von_mises", 1e-4)):
        values = getattr(found, name)
        np.testing.assert_allclose(values, values.mean(), rtol=rtol)
    np.testing.assert_allclose(found.p0, found.p0_hertz, rtol=5e-4)


def test_too_wide_a_contact_is_not_a_number() -> None:
    """A rubber cam under far too great a load."""
    soft = round_cam(Elastic(0.5e9, 0.45))
    bodies = CycleBodies.meshed(soft)
    theta, force = np.array([0.0, 1.0]), np.array([10.0, 1e5])
    found = two_scale_history(soft, bodies, theta, force)
    assert np.isfinite(found.p0[0])
    assert found.half_width_hertz[1] > 0.1 * found.relative_radius[1]
    for name in ("p0", "half_width", "tau_max", "von_mises", "residual_equilibrium"):
        assert np.isnan(getattr(found, name)[1]), name
    assert np.isnan(found.p0_difference[1])
    assert np.isfinite(found.p0_hertz[1])


@pytest.mark.parametrize("nu", [0.1, 0.3])
def test_shear_on_any_plane_is_told_where_it_is_larger(nu: float) -> None:
    """Below nu of about 0.25 the largest shear turns out of the plane (Johnson 1985, sec. 4.2)."""
    pair = round_cam(Elastic(210e9, nu))
    bodies = CycleBodies.meshed(pair)
    found = two_scale_history(pair, bodies, np.array([0.5]), np.array([800.0]))
    by_hertz = hertz.shear_any_plane_peak(nu) * found.p0_hertz
    np.testing.assert_allclose(found.tau_any_plane, by_hertz, rtol=1e-2)  # the disc adds 0.7 %
    assert (found.tau_any_plane > 1.01 * found.tau_max).all() == (nu < 0.25)


def test_figures_of_a_mesh_are_kept_to_the_bit(tmp_path, monkeypatch):
    """Only a mesh of another load is solved again."""
    store, pair = Store(tmp_path, PACKED), round_cam()
    solved = certificate_angles._figures(store, 0, pair, 0.5, 800.0, 4.0)
    monkeypatch.setattr(certificate_angles, "mesh_figures", lambda *_: pytest.fail("solved again"))
    assert certificate_angles._figures(store, 0, pair, 0.5, 800.0, 4.0) == solved
    assert solved.edges == 4.0 and isinstance(solved.dofs, int)
    with pytest.raises(pytest.fail.Exception):
        certificate_angles._figures(store, 0, pair, 0.5, 801.0, 4.0)


def test_an_angle_whose_coarse_mesh_is_off_has_the_finest_one_as_well(monkeypatch):
    theta, load = np.array([0.0, 1.0, 2.0, 3.0]), np.array([4e4, 3e4, 2e4, 1e4])
    stress = 1e4 * load
    off = {(2.0, 4.0): 1.03}

    def figures(_, angle, force, edges):
        exact = 1e4 * force / round_cam().width
        coarse = off.get((float(angle), edges), 1.0 - 2e-2 / edges)
        return certificate_angles.MeshFigures(edges, 100, exact, 1e-4, exact, coarse * exact, 0, 0)

    contact = SimpleNamespace(
        line_load=load, p0=stress, p0_hertz=stress, half_width=np.full(4, 1e-4), tau_max=stress,
        von_mises=stress,
    )  # fmt: skip
    monkeypatch.setattr(certificate_angles, "mesh_figures", figures)
    cycles = [SimpleNamespace(theta=theta, contact=contact, pair=round_cam())]
    chosen = [certificate_angles.Position(0, k) for k in (0, 3, 1, 2)]
    with crew(1) as workers:
        begun = certificate_angles.begun(cycles, chosen, workers)
        points = begun.points(lambda done, count: None)
    assert [len(each.edges) for each in points] == [3, 2, 3, 3]
    assert points[3].theta == 2.0 and points[3].order_from == ()
