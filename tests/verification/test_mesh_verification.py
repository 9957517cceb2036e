"""Meshes against exact figures: areas, curves, constant strain and element counts."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from cam_parts import Keyway, mesh_area
from skfem import Basis, BilinearForm, ElementTriP2, ElementVector, FacetBasis, Functional
from skfem.helpers import ddot, dot, sym_grad

from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import MeshError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import (
    block_mesh,
    cam_mesh,
    face_mesh,
    half_disc_mesh,
    roller_mesh,
)
from camwright.meshes.element_size import ElementSize
from camwright.meshes.gmsh_mesher import session
from camwright.meshes.mesh_quality import gate, quality

HALF_WIDTH = 1e-4
THETA = np.arange(720) * (2 * np.pi / 720)
CONTOUR = RollerContour(PitchCurve(Lift(THETA, 0.0165 * (1 - np.cos(THETA))), 0.05), 0.008)


def contact(theta):
    return CONTOUR.points(np.array([theta]))[:, 0]


@pytest.fixture(scope="module")
def cam():
    sizing = ElementSize.from_half_width(HALF_WIDTH, 3e-3, contact_point=contact(2.0))
    return cam_mesh(CONTOUR, 0.01, Keyway(6e-3, 3e-3, 0.3), sizing)


def test_disc_area_converges_with_the_fourth_order():
    """Middles on the circle leave a radial error of fourth order in the facet length."""
    sizes = np.array([1.2e-3, 6e-4, 3e-4, 1.5e-4])
    errors = [
        abs(
            mesh_area(roller_mesh(0.008, 0.0, 0.0, ElementSize(far_size=h))) / (np.pi * 0.008**2)
            - 1
        )
        for h in sizes
    ]
    order = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert order == pytest.approx(4.0, abs=0.15)
    assert errors[-1] < 1e-8


def test_skfem_integrates_the_same_area(cam):
    basis = Basis(cam.to_skfem(), ElementTriP2(), intorder=4)
    assert float(basis.dx.sum()) == pytest.approx(mesh_area(cam), rel=1e-13)


def test_cam_area_is_that_of_contour_less_bore_and_keyway(cam):
    theta = np.linspace(0, 2 * np.pi, 20001)
    x, y = CONTOUR.points(theta)
    outer = 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))
    bore, half = 0.01, 3e-3
    mouth = np.arcsin(half / bore)
    slot = 2 * half * (bore + 3e-3) - bore**2 * mouth - half * bore * np.cos(mouth)
    # 40 quadratic facets round the bore: 3e-7 of its area; chords of the contour: 2e-8.
    assert mesh_area(cam) == pytest.approx(outer - np.pi * bore**2 - slot, rel=1e-6)


def risen(theta):
    """Lift of 15 mm between dwells, m; on the dwells curvature and wall are constant."""
    share = np.clip((theta - 1.0) / 1.5, 0.0, 1.0) - np.clip((theta - 3.5) / 1.5, 0.0, 1.0)
    return 0.015 * share**3 * (10.0 - 15.0 * share + 6.0 * share**2)


@pytest.mark.parametrize("lift", [risen, lambda theta: 0.0165 * (1 - np.cos(theta))])
@pytest.mark.parametrize("half_width", [None, HALF_WIDTH])
def test_round_off_of_the_lift_does_not_change_the_triangles_of_a_cam(lift, half_width):
    """A change by 1e-13 of the lift moves the nodes by its own size, and gmsh decides the same."""
    draw, meshes = np.random.default_rng(1), []
    for change in (0.0, 1e-13, 1e-13, 1e-13):
        values = lift(THETA) * (1.0 + change * draw.uniform(-1.0, 1.0, THETA.size))
        contour = RollerContour(PitchCurve(Lift(THETA, values), 0.05, 0.004), 0.008)
        sizing = ElementSize(far_size=3e-3)
        if half_width is not None:
            point = contour.points(np.array([2.0]))[:, 0]
            sizing = ElementSize.from_half_width(half_width, 3e-3, contact_point=point)
        meshes.append(cam_mesh(contour, 0.01, Keyway(6e-3, 3e-3, 0.3), sizing))
    for mesh in meshes[1:]:
        assert np.array_equal(mesh.triangles, meshes[0].triangles)
        # 1e-13 of the lift is 3e-15 m; arc length and foot of the contact add to it
        np.testing.assert_allclose(mesh.points, meshes[0].points, rtol=0.0, atol=1e-12)


@pytest.mark.parametrize(
    "made",
    [
        lambda size: roller_mesh(0.008, 0.0025, 0.7, size),
        lambda size: face_mesh(0.024, 0.006, 0.01, replace(size, contact_point=np.zeros(2))),
        lambda size: half_disc_mesh(0.004, size),
    ],
)
def test_round_off_of_the_contact_does_not_change_the_triangles_of_a_follower(made):
    """A half-width known to 1e-13, the last digits of another processor, gives the same mesh."""
    draw = np.random.default_rng(2)
    sizes = HALF_WIDTH * (1.0 + np.append(0.0, 1e-13 * draw.uniform(-1.0, 1.0, 5)))
    meshes = [made(ElementSize.from_half_width(float(each), 1e-3)) for each in sizes]
    for mesh in meshes[1:]:
        assert np.array_equal(mesh.triangles, meshes[0].triangles)
        np.testing.assert_allclose(mesh.points, meshes[0].points, rtol=0.0, atol=1e-12)


def boundary_integral(mesh, integrand):
    """Exact integral of `integrand` (x, y, dx, dy) over the curved facets, by their triples."""
    total = 0.0
    for name in mesh.boundaries:
        start, end, middle = mesh.points[:, mesh.facet_triples(name)].transpose(1, 0, 2)
        for t, weight in zip(*np.polynomial.legendre.leggauss(3), strict=True):
            here = 0.5 * t * (t - 1) * start + 0.5 * t * (t + 1) * end + (1 - t * t) * middle
            slope = (t - 0.5) * start + (t + 0.5) * end - 2 * t * middle
            total += weight * float(np.sum(integrand(*here, *slope)))
    return total


def test_facet_triples_close_the_body_and_point_outwards(cam):
    """Divergence theorem with the outward normal (dy, -dx)."""
    around = 2 * mesh_area(cam)
    assert boundary_integral(cam, lambda x, y, dx, dy: dy) == pytest.approx(0, abs=1e-15)
    assert boundary_integral(cam, lambda x, y, dx, dy: -dx) == pytest.approx(0, abs=1e-15)
    flux = boundary_integral(cam, lambda x, y, dx, dy: x * dy - y * dx)
    assert flux == pytest.approx(around, rel=1e-12)


def test_outward_normals_of_skfem_agree_with_the_triples(cam):
    moved = cam.transformed(0.0, -contact(2.0))  # see BodyMesh.to_skfem
    mesh = moved.to_skfem()
    flux = Functional(lambda w: dot(w.x, w.n))
    total = sum(
        flux.assemble(FacetBasis(mesh, ElementTriP2(), facets=name, intorder=4))
        for name in cam.boundaries
    )
    assert total == pytest.approx(2 * mesh_area(cam), rel=1e-12)


def test_constant_strain_is_in_equilibrium_on_curved_triangles(cam):
    """Patch test: a linear displacement leaves no force at any node off the boundary."""

    @BilinearForm
    def stiffness(u, v, w):
        return ddot(sym_grad(u), sym_grad(v)) * 2.0 + 1.5 * (
            sym_grad(u)[0, 0] + sym_grad(u)[1, 1]
        ) * (sym_grad(v)[0, 0] + sym_grad(v)[1, 1])

    basis = Basis(cam.to_skfem(), ElementVector(ElementTriP2()), intorder=6)
    dofs = cam.dof_map(basis)
    u = np.zeros(basis.N)
    u[dofs] = np.array([[1.0, 0.4], [-0.2, 0.7]]) @ cam.points
    force = (stiffness.assemble(basis) @ u)[dofs]
    edge = np.unique(np.hstack([cam.boundary_nodes(name) for name in cam.boundaries]))
    inside = np.setdiff1d(np.arange(cam.points.shape[1]), edge)
    assert abs(force[:, inside]).max() < 1e-11 * abs(force[:, edge]).max()


def test_contour_nodes_lie_on_an_independent_interpolating_spline(cam):
    """OpenCASCADE's spline through 1440 contour points passes within 1e-9 m of every node."""
    nodes = cam.points[:, cam.boundary_nodes("contour")][:, ::5] * 1e3
    with session() as gmsh:
        x, y = CONTOUR.points(np.arange(1440) * (2 * np.pi / 1440)) * 1e3
        tags = [gmsh.model.occ.addPoint(a, b, 0) for a, b in zip(x, y, strict=True)]
        curve = gmsh.model.occ.addSpline([*tags, tags[0]])
        gmsh.model.occ.synchronize()
        flat = np.vstack([nodes, np.zeros(nodes.shape[1])]).T.ravel()
        closest, _ = gmsh.model.getClosestPoint(1, curve, flat)
    apart = np.reshape(closest, (-1, 3))[:, :2].T - nodes
    assert np.hypot(*apart).max() < 1e-6  # mm


@pytest.mark.parametrize("theta", np.linspace(0.1, 2 * np.pi, 6, endpoint=False))
def test_cam_meshes_pass_the_gate_at_any_contact(theta):
    sizing = ElementSize.from_half_width(HALF_WIDTH, 3e-3, contact_point=contact(theta))
    found = quality(cam_mesh(CONTOUR, 0.01, None, sizing), contact(theta), HALF_WIDTH)
    gate(found, angle_min_deg=27.0, scaled_jacobian_min=0.5, edges_min=8.0)
    assert found.nodes < 15_000


@pytest.mark.parametrize(
    "mesh",
    [
        lambda s: roller_mesh(0.008, 0.003, -np.pi / 2, s),
        lambda s: roller_mesh(0.008, 0.0, -np.pi / 2, s),
        lambda s: half_disc_mesh(0.2, s),
        lambda s: block_mesh(0.4, 0.2, s),
    ],
    ids=["roller", "disc", "half disc", "block"],
)
def test_other_bodies_pass_the_gate(mesh):
    sizing = ElementSize.from_half_width(HALF_WIDTH, 0.05, contact_point=(0.0, 0.0))
    body = mesh(sizing)
    place = (0.0, -0.008) if "rim" in body.boundaries else (0.0, 0.0)
    measured = quality(body, place, HALF_WIDTH)
    limits = {"angle_min_deg": 27.0, "scaled_jacobian_min": 0.5, "edges_min": 8.0}
    assert gate(measured, **limits) is measured
    assert measured.min_angle_deg >= 27.0 and measured.min_scaled_jacobian >= 0.5
    with pytest.raises(MeshError, match="min_angle_deg"):
        gate(measured, angle_min_deg=61.0)


def test_a_block_two_thousand_half_widths_deep_stays_small():
    """Grading makes a half-plane nearly free: depth 2000 a at a/8 in about 16 000 unknowns."""
    sizing = ElementSize.from_half_width(1.0, 2000.0, contact_point=(0.0, 0.0), reach=1.8)
    mesh = block_mesh(4000.0, 2000.0, sizing)
    assert 2 * mesh.points.shape[1] < 32_000
    assert quality(mesh, (0, 0), 1.0).min_angle_deg > 27


def test_elements_scale_with_the_sizing():
    """Half the element size everywhere, four times the elements."""
    counts = [
        half_disc_mesh(
            0.05,
            ElementSize(
                far_size=h * 20, contact_size=h, contact_extent=2e-3, growth=0.15 * h / 1e-4
            ),
        ).triangles.shape[1]
        for h in (1e-4, 5e-5)
    ]
    assert counts[1] / counts[0] == pytest.approx(4.0, rel=0.04)


def test_a_refined_cam_is_finer_by_that_factor_at_each_boundary():
    """An error bar by a finer mesh says nothing of a place that the mesh leaves as it was."""
    hole = SimpleNamespace(centre=np.array([-0.022, 0.0]), radius=0.006)
    meshes = [
        cam_mesh(CONTOUR, 0.01, Keyway(6e-3, 3e-3, 0.3), ElementSize(far_size=6e-3), hole, by)
        for by in (1.0, 2.0)
    ]
    for name, facets in meshes[0].boundaries.items():
        finer = meshes[1].boundaries[name].shape[1]
        assert finer / facets.shape[1] == pytest.approx(2.0, abs=0.15), name
    triangles = [mesh.triangles.shape[1] for mesh in meshes]
    assert triangles[1] / triangles[0] == pytest.approx(4.0, rel=0.1)
