"""The full two-body contact: patch test, Hertz at every mesh position, invariances."""

from functools import lru_cache

import numpy as np
import pytest
from skfem.models.elasticity import linear_elasticity

from camwright.geometry.errors import ContactError, InputError, MeshError
from camwright.meshes.body_mesh import BodyMesh, block_mesh, roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, ElasticBody, lame_parameters
from camwright.pipeline.contact.elasticity.mesh_convergence import converged
from camwright.pipeline.contact.elasticity.pressure_distribution import PressureShapes
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame
from camwright.pipeline.contact.full_contact import ContactSide, solve_contact
from camwright.pipeline.studies.two_cylinders import TwoCylinders, finite_elements

E, NU = 210e9, 0.3
UP = ContactFrame(np.zeros(2), np.array([0.0, 1.0]))
RADIUS = 0.01
A_OVER_R = 0.01


def held_opposite(mesh: BodyMesh, facing: float) -> BodyMesh:
    """A full disc with a boundary "far" of four facets about the point facing away."""
    rim = mesh.boundaries["rim"]
    radius = np.hypot(*mesh.points[:, rim[0, 0]])
    away = -radius * np.array([[np.cos(facing)], [np.sin(facing)]])
    near = np.argsort(np.hypot(*(mesh.points[:, rim[2]] - away)))[:4]
    return BodyMesh(mesh.points, mesh.triangles, {**mesh.boundaries, "far": rim[:, near]})


def disc(radius, facing, half_width, edges, phase):
    sizing = ElementSize.from_half_width(half_width, radius / 3, edges=edges, phase=phase)
    mesh = held_opposite(roller_mesh(radius, 0.0, facing, sizing), facing)
    return mesh.transformed(0.0, (0.0, -radius * np.sin(facing)))


def twice_the_circle(xi):
    return 2 * xi**2 / (RADIUS + np.sqrt(RADIUS**2 - xi**2))


def hertz_of_the_discs():
    """Half-width, p0 and line load of two equal steel discs at a/R = 0.01, R the relative one."""
    modulus = hertz.contact_modulus(E, NU, E, NU)
    half_width = A_OVER_R * RADIUS / 2
    load = np.pi * modulus * half_width**2 / (4 * RADIUS / 2)
    a, p0 = hertz.line_contact(load, RADIUS / 2, modulus)
    return float(a), float(p0), float(load)


def two_discs(edges=8, phase=0.0, other_phase=0.0, angle=0.0, swapped=False):
    return solved_discs(edges, phase, other_phase, angle, swapped)


@lru_cache(maxsize=24)  # one entry for a set-up, however its arguments are stated
def solved_discs(edges, phase, other_phase, angle, swapped):
    a, _, load = hertz_of_the_discs()
    meshes = [
        disc(RADIUS, 0.5 * np.pi, a, edges, phase),
        disc(RADIUS, -0.5 * np.pi, a, edges, other_phase),
    ]
    sides = tuple(
        ContactSide(ElasticBody(m.transformed(angle, (0.0, 0.0)), E, NU, "far"), "rim")
        for m in meshes
    )
    frame = ContactFrame(np.zeros(2), np.array([-np.sin(angle), np.cos(angle)]))
    return solve_contact(sides, frame, twice_the_circle, load, a, pressure_on=int(swapped))


@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_non_matching_patch_test(angle):
    # Two blocks whose facets do not match, on rollers: uniform pressure passes exactly.
    width, p = 2.0, 3e6
    sizing = [
        ElementSize(far_size=0.5, contact_size=size, contact_extent=0.4, contact_point=np.zeros(2),
               phase=phase)
        for size, phase in ((0.11, 0.0), (0.07, 0.4))
    ]  # fmt: skip
    blocks = [
        block_mesh(width, 1.0, sizing[0]).transformed(angle, (0.0, 0.0)),
        block_mesh(width, 1.0, sizing[1]).transformed(angle + np.pi, (0.0, 0.0)),
    ]
    # On rollers only where the axes of the mesh are those of the blocks.
    held = {"bottom": "y", "left": "x"} if angle == 0 else {"bottom": "xy"}
    bodies = [ElasticBody(mesh, E, NU if angle == 0 else 0.0, held) for mesh in blocks]
    frame = ContactFrame(np.zeros(2), np.array([-np.sin(angle), np.cos(angle)]))
    found = solve_contact(
        (ContactSide(bodies[0], "top"), ContactSide(bodies[1], "top")),
        frame,
        np.zeros_like,
        p * width,
        width / 2,
        shapes=PressureShapes(np.linspace(-1.0, 1.0, 24), open_ends=True),
    )
    np.testing.assert_allclose(found.pressure, p, rtol=1e-10)
    assert found.residual_equilibrium < 1e-10 and found.residual_complementarity < 1e-10
    # The state is uniform: each block is pushed in by p / E' per length, at the top the most.
    lam = p * (1 - bodies[0].poisson ** 2) / E
    moved = frame.normal @ found.displacements[0]
    height = frame.above(blocks[0].points) + 1.0
    np.testing.assert_allclose(moved, -lam * height, atol=1e-10 * lam)


@pytest.mark.parametrize("k", range(8))
def test_two_steel_cylinders_at_every_mesh_position(k, measured):
    # Gate 0.5 % at h = a/8, the contact pushed through one facet.
    a, p0, load = hertz_of_the_discs()
    found = two_discs(phase=k / 8, other_phase=0.37)
    name, mega = "Two steel cylinders, Hertz", 1e-6
    measured(f"{name}: peak pressure", mega * found.p0, mega * p0, rtol=5e-4, unit="MPa")
    measured(f"{name}: half-width", 1e3 * found.half_width, 1e3 * a, rtol=1e-3, unit="mm")
    shear = hertz.SHEAR_MAX * p0 + hertz.disc_correction(load, RADIUS)
    measured(f"{name}: shear", mega * found.tau_max, mega * shear, rtol=2e-3, unit="MPa")
    np.testing.assert_allclose(found.tau_depth, hertz.SHEAR_MAX_DEPTH * a, atol=0.05 * a)
    mises = hertz.von_mises_peak(NU)[0] * p0
    measured(f"{name}: von Mises", mega * found.von_mises, mega * mises, rtol=5e-3, unit="MPa")
    assert found.residual_equilibrium < 1e-10 and found.residual_complementarity < 1e-10


def test_deformed_surfaces_neither_overlap_nor_gape():
    # Circles plus displacements of the nodes, which coincide along the surface by symmetry; no
    # integrals. A quadratic edge of a/8 follows the contact to 2e-4 of the gap at 1.9 half-widths.
    a, _, _ = hertz_of_the_discs()
    found, shifts = two_discs(8), []
    for facing, field in zip((0.5, -0.5), found.displacements, strict=True):
        mesh = disc(RADIUS, facing * np.pi, a, 8, 0.0)
        nodes = np.unique(mesh.boundaries["rim"])
        at = mesh.points[:, nodes]
        near = np.flatnonzero((np.abs(at[0]) < 1.9 * a) & (np.abs(at[1]) < a))
        near = near[np.argsort(at[0, near])]
        shifts.append((at[0, near], field[1, nodes[near]]))
    (xi, below), (other, above) = shifts
    np.testing.assert_allclose(xi, other, atol=1e-9 * a)
    apart = twice_the_circle(xi) + above - below - found.approach
    size, off = apart.max(), np.abs(xi / a)
    assert np.abs(apart[off < 0.97]).max() < 3e-4 * size
    assert apart[off > 1.03].min() > 1e-3 * size
    assert found.residual_complementarity < 1e-10


def test_three_meshes_settle():
    a, p0, load = hertz_of_the_discs()
    solved = [two_discs(edges) for edges in (4, 8, 16)]
    for name in ("p0", "half_width", "tau_max", "von_mises"):
        found = converged([getattr(s, name) for s in solved], 2.0)
        # p0 and half-width are within the scatter of mesh positions and may have no order. Fitted
        # stresses follow the pressure within 5e-4 on the coarsest mesh, see the next test: their
        # order is that of its scatter, and their bar alone is bounded.
        if name in ("p0", "half_width"):
            assert found.order is None or 1.4 <= found.order <= 3.0, (name, found.order)
            assert found.order is not None or found.gci < 1e-3
        assert found.gci < 1.5e-3, (name, found.gci)
    for name, exact in (("p0", p0), ("half_width", a)):
        found = converged([getattr(s, name) for s in solved], 2.0)
        np.testing.assert_allclose(found.extrapolated, exact, rtol=1.5e-4)
    # At sixteen edges the disc's first-order term is seen whole: half of it would be off 0.17 %.
    shear = hertz.SHEAR_MAX * p0 + hertz.disc_correction(load, RADIUS)
    np.testing.assert_allclose(solved[2].tau_max, shear, rtol=4e-4)


@pytest.mark.parametrize("phase", [0.0, 0.3])
def test_a_coarse_mesh_adds_nothing_to_the_error_of_the_pressure(phase):
    coarse, fine = two_discs(4, phase), two_discs(8)
    for name in ("tau_max", "von_mises"):
        ratios = [getattr(each, name) / each.p0 for each in (coarse, fine)]
        np.testing.assert_allclose(ratios[0], ratios[1], rtol=5e-4)


@pytest.mark.parametrize("edges", [8, 16])
@pytest.mark.parametrize("k", range(8))
def test_pressure_follows_the_ellipse_at_every_mesh_position(k, edges):
    # Gate at h = a/8: 0.5 % within 0.8 a and 4 % at the last two nodes of either end, counted
    # from where the contact lies: what holds the discs is not quite opposite.
    if edges == 16 and k % 4:
        pytest.skip("the finer mesh at two positions is enough")
    a, p0, _ = hertz_of_the_discs()
    found = two_discs(edges, phase=k / 8, other_phase=0.37)
    assert found.linear_because == ""
    x = (found.xi - found.centre) / a
    error = np.abs(found.pressure / p0 - np.sqrt(np.maximum(1 - x**2, 0)))
    assert error[np.abs(x) < 0.8].max() < {8: 5e-3, 16: 1e-3}[edges]
    inside = np.flatnonzero(np.abs(x) < 1)
    assert error[inside[[0, 1, -2, -1]]].max() < 0.04
    assert error.max() < 0.04
    assert (found.pressure >= 0).all()


def test_edges_are_elliptic_where_the_contact_is_one_ellipse_only():
    # Two bumps: the pressure has a gap at the middle, and stays piecewise linear.
    a, _, load = hertz_of_the_discs()
    sides = tuple(
        ContactSide(ElasticBody(disc(RADIUS, s * 0.5 * np.pi, a, 8, 0.0), E, NU, "far"), "rim")
        for s in (1, -1)
    )
    depth = 2 * a**2 / RADIUS
    found = solve_contact(
        sides, UP, lambda xi: 4 * depth * ((xi / a) ** 2 - 0.49) ** 2, 0.2 * load, a
    )
    assert found.pressure[np.abs(found.xi).argmin()] == 0
    assert found.linear_because == "the contact is not a single ellipse"


def test_turning_the_whole_set_up_changes_nothing():
    straight, turned = two_discs(phase=0.25, other_phase=0.37), two_discs(8, 0.25, 0.37, 1.234)
    for name in ("p0", "half_width", "tau_max", "von_mises", "tau_depth", "approach"):
        np.testing.assert_allclose(getattr(turned, name), getattr(straight, name), rtol=1e-8)
    np.testing.assert_allclose(turned.pressure, straight.pressure, atol=1e-8 * straight.p0)


def test_swapping_the_side_that_carries_the_knots_changes_little():
    one, other = (two_discs(8, 0.25, 0.37, swapped=s) for s in (False, True))
    for name in ("p0", "half_width", "tau_max", "von_mises"):
        np.testing.assert_allclose(getattr(other, name), getattr(one, name), rtol=1e-4)


def test_more_load_makes_a_wider_contact_and_a_higher_pressure_as_the_root():
    a, _, load = hertz_of_the_discs()
    one = two_discs()
    sides = tuple(
        ContactSide(ElasticBody(disc(RADIUS, s * 0.5 * np.pi, 2 * a, 8, 0.0), E, NU, "far"), "rim")
        for s in (1, -1)
    )
    four = solve_contact(sides, UP, twice_the_circle, 4 * load, 2 * a)
    np.testing.assert_allclose([four.p0 / one.p0, four.half_width / one.half_width], 2, rtol=1e-3)


@pytest.mark.parametrize("edges", [8, 16])
def test_subsurface_stress_of_half_planes(edges):
    # Flat blocks of 1500 half-widths, the circles in the gap alone: 0.5 % at a/8, 0.2 % at a/16.
    a, load = 1.0, 1.0
    modulus = hertz.contact_modulus(1.0, NU, 1.0, NU)
    radius = np.pi * modulus * a**2 / (4 * load)
    p0 = 2 * load / (np.pi * a)
    sizing = ElementSize.from_half_width(a, 400.0, contact_point=np.zeros(2), edges=edges)
    block = block_mesh(3000.0, 1500.0, sizing)
    other = block.transformed(np.pi, (0.0, 0.0))
    sides = tuple(ContactSide(ElasticBody(m, 1.0, NU, "bottom"), "top") for m in (block, other))
    found = solve_contact(sides, UP, lambda xi: xi**2 / (2 * radius), load, a)
    gate = {8: 5e-3, 16: 2e-3}[edges]
    np.testing.assert_allclose([found.p0 / p0, found.half_width / a], 1, rtol=gate)
    np.testing.assert_allclose(found.tau_max / p0, hertz.SHEAR_MAX, rtol=gate)
    np.testing.assert_allclose(found.von_mises / p0, 0.557516, rtol=gate)
    np.testing.assert_allclose(found.tau_depth, hertz.SHEAR_MAX_DEPTH, atol=0.05)


@pytest.mark.parametrize(
    ("ratio", "poisson"), [(1.0, (0.0, 0.49)), (30.0, (0.3, 0.49)), (1000.0, (0.49, 0.3))]
)
def test_unlike_materials_do_not_lock(ratio, poisson):
    # Gate 1 % of p0 for E ratios of 1 to 1000 and Poisson ratios up to 0.49.
    a, _, _ = hertz_of_the_discs()
    moduli = (E, E / ratio)
    modulus = hertz.contact_modulus(moduli[0], poisson[0], moduli[1], poisson[1])
    load = np.pi * modulus * a**2 / (4 * RADIUS / 2)
    _, p0 = hertz.line_contact(load, RADIUS / 2, modulus)
    sides = tuple(
        ContactSide(ElasticBody(disc(RADIUS, s * 0.5 * np.pi, a, 8, 0.0), e, nu, "far"), "rim")
        for s, e, nu in zip((1, -1), moduli, poisson, strict=True)
    )
    found = solve_contact(sides, UP, twice_the_circle, load, a)
    np.testing.assert_allclose([found.p0 / p0, found.half_width / a], 1, rtol=5e-3)


@pytest.mark.parametrize("a_over_r", [0.05, 0.2, 0.25])
def test_error_bar_of_flat_bodies_covers_what_discs_do(a_over_r):
    # Up to the half contact angle of 15 deg beyond which the flat bodies are refused.
    a = a_over_r * RADIUS
    modulus = hertz.contact_modulus(E, NU, E, NU)
    load = np.pi * modulus * a**2 / (4 * RADIUS / 2)
    sides = tuple(
        ContactSide(ElasticBody(disc(RADIUS, s * 0.5 * np.pi, a, 8, 0.0), E, NU, "far"), "rim")
        for s in (1, -1)
    )
    full = solve_contact(sides, UP, twice_the_circle, load, a)
    steel = Elastic(E, NU)
    flat = finite_elements(TwoCylinders(RADIUS, RADIUS, steel, steel, load))
    shear = flat.figures.tau_max + hertz.disc_correction(load, RADIUS)
    for found, exact in (
        (flat.figures.p0, full.p0),
        (flat.figures.half_width, full.half_width),
        (shear, full.tau_max),
    ):
        assert abs(found / exact - 1) < flat.error_bar
    assert flat.error_bar < 5e-3 + 0.5 * a_over_r**2


def test_stiffness_is_that_of_the_library_form():
    mesh = roller_mesh(1.0, 0.3, 0.0, ElementSize(far_size=0.3))
    body = ElasticBody(mesh, E, NU, "hub")
    expected = linear_elasticity(*lame_parameters(E, NU)).assemble(body.basis)
    assert abs(body.stiffness - expected).max() < 1e-14 * abs(expected).max()


def test_condensed_body_moves_as_the_whole_one():
    mesh = roller_mesh(1.0, 0.3, 0.0, ElementSize(far_size=0.3))
    body = ElasticBody(mesh, E, NU, "hub")
    nodes = mesh.boundary_nodes("rim")[::3]
    rng = np.random.default_rng(5)
    loads = np.zeros((2, mesh.points.shape[1], 3))
    loads[:, nodes] = rng.normal(size=(2, nodes.size, 3))
    held = np.zeros_like(loads)
    held[:, body.held_nodes] = rng.normal(size=(2, body.held_nodes.size, 3)) / E
    condensed = body.condensed(nodes)
    whole = body.displacement(loads)
    size = np.abs(whole).max()
    np.testing.assert_allclose(
        condensed.displacement(loads[:, nodes]), whole[:, nodes], atol=1e-10 * size
    )
    np.testing.assert_allclose(condensed.everywhere(loads[:, nodes]), whole, atol=1e-10 * size)
    # With what holds it moved as well, the nodes beside it must be looked at.
    more = np.union1d(nodes, body.beside_held)
    np.testing.assert_allclose(
        body.condensed(more).displacement(loads[:, more], held),
        body.displacement(loads, held)[:, more],
        atol=1e-10 * size,
    )


def test_what_is_held_must_exist_and_have_components():
    mesh = roller_mesh(1.0, 0.3, 0.0, ElementSize(far_size=0.3))
    with pytest.raises(MeshError, match="bore"):
        _ = ElasticBody(mesh, E, NU, "bore").held_dofs
    with pytest.raises(InputError, match=r"held\.hub"):
        _ = ElasticBody(mesh, E, NU, {"hub": "z"}).held_dofs


def test_reaction_balances_the_load_whatever_is_held():
    mesh = roller_mesh(1.0, 0.3, 0.0, ElementSize(far_size=0.3))
    loads = np.zeros((2, mesh.points.shape[1], 1))
    loads[:, mesh.boundary_nodes("rim")[4], 0] = (2.0, -1.0)
    body = ElasticBody(mesh, E, NU, "hub")
    np.testing.assert_allclose(
        body.reaction(body.displacement(loads)[:, :, 0]), [-2.0, 1.0], rtol=1e-9
    )


@pytest.mark.parametrize(("load", "width"), [(0.0, 1e-4), (-1.0, 1e-4), (np.nan, 1e-4), (1.0, 0.0)])
def test_bad_loads_are_refused(load, width):
    mesh = block_mesh(1.0, 1.0, ElementSize(far_size=0.5))
    side = ContactSide(ElasticBody(mesh, E, NU, "bottom"), "top")
    with pytest.raises(InputError):
        solve_contact((side, side), UP, np.zeros_like, load, width)


def test_a_contact_wider_than_its_window_is_refused():
    a, _, load = hertz_of_the_discs()
    sides = tuple(
        ContactSide(ElasticBody(disc(RADIUS, s * 0.5 * np.pi, a, 8, 0.0), E, NU, "far"), "rim")
        for s in (1, -1)
    )
    with pytest.raises(ContactError, match="wider than the window"):
        solve_contact(sides, UP, twice_the_circle, 4 * load, a)
