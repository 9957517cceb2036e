"""Meshes of the bodies: boundaries, numbering, limits and repeatability."""

import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from cam_parts import Keyway, mesh_area
from skfem import Basis, ElementTriP1, ElementTriP2, ElementVector

from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import GeometryError, InputError, MeshError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import BodyMesh, block_mesh, cam_mesh, half_disc_mesh, roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.meshes.gmsh_mesher import signals_kept
from camwright.meshes.mesh_quality import quality

HALF_WIDTH = 1e-4
BORE = 0.01
THETA = np.arange(720) * (2 * np.pi / 720)


def cam_contour(stroke=0.033, roller_radius=0.008):
    return RollerContour(
        PitchCurve(Lift(THETA, 0.5 * stroke * (1 - np.cos(THETA))), 0.05), roller_radius
    )


CONTOUR = cam_contour()


def fine(contact_point=None, **changes):
    return ElementSize.from_half_width(HALF_WIDTH, 4e-3, contact_point=contact_point, **changes)


def contact(theta):
    return CONTOUR.points(np.array([theta]))[:, 0]


@pytest.fixture(scope="module")
def cam():
    return cam_mesh(CONTOUR, BORE, Keyway(6e-3, 3e-3, 0.3, 5e-4), fine(contact(1.0)))


@pytest.fixture(scope="module")
def roller():
    return roller_mesh(0.008, 0.003, 0.7, fine())


def facet_lengths(mesh, name):
    start, end, _ = mesh.points[:, mesh.facet_triples(name)].transpose(1, 0, 2)
    return np.hypot(*(end - start))


def test_boundaries_carry_their_names(cam, roller):
    assert set(cam.boundaries) == {"contour", "bore", "keyway"}
    assert set(roller.boundaries) == {"rim", "hub"}
    assert set(roller_mesh(0.008, 0.0, 0.0, fine()).boundaries) == {"rim"}
    assert set(block_mesh(0.2, 0.1, fine((0, 0))).boundaries) == {"top", "bottom", "left", "right"}
    assert set(half_disc_mesh(0.1, fine()).boundaries) == {"top", "arc"}


def test_boundaries_are_the_whole_edge_of_the_body(cam):
    mesh = cam.to_skfem()
    named = np.concatenate([mesh.boundaries[name] for name in cam.boundaries])
    assert np.array_equal(np.sort(named), np.sort(mesh.boundary_facets()))


def test_every_node_of_a_boundary_lies_on_it(cam, roller):
    x, y = roller.points[:, roller.boundary_nodes("rim")]
    np.testing.assert_allclose(np.hypot(x, y), 0.008, rtol=1e-14)
    x, y = cam.points[:, cam.boundary_nodes("bore")]
    np.testing.assert_allclose(np.hypot(x, y), BORE, rtol=1e-14)
    turn = np.exp(-0.3j)
    slot = cam.points[:, cam.boundary_nodes("keyway")]
    slot = (slot[0] + 1j * slot[1]) * turn
    assert slot.real.max() == pytest.approx(BORE + 3e-3, rel=1e-12)
    assert abs(slot.imag).max() == pytest.approx(3e-3, rel=1e-12)


def test_contour_nodes_lie_on_the_contour(cam):
    """Squared distance to the contour, by a search of its own, is round-off of 1e-12 m."""
    theta = np.linspace(0, 2 * np.pi, 40001)
    curve, normal = CONTOUR.points(theta), CONTOUR.normal(theta)
    for node in cam.boundary_nodes("contour")[::17]:
        apart = cam.points[:, node, None] - curve
        nearest = int(np.argmin((apart**2).sum(axis=0)))
        # Samples are 10 um apart on a radius of 50 mm: the sagitta is below 2.5e-10 m.
        assert abs(apart[:, nearest] @ normal[:, nearest]) < 5e-10


def test_facets_follow_one_another_with_the_body_on_the_left(cam, roller):
    for mesh in (cam, roller):
        for name in mesh.boundaries:
            start, end, _ = mesh.facet_triples(name)
            assert np.array_equal(end[:-1], start[1:])
            x, y = mesh.points[:, start]
            dx, dy = mesh.points[:, end] - mesh.points[:, start]
            outer = name in {"contour", "rim"}
            swept = float(np.sum(x * dy - y * dx))
            assert (swept > 0) == outer


@pytest.mark.parametrize("phase", [0.0, 0.25, 0.5])
def test_contact_facets_are_equal_and_shift_with_the_phase(phase):
    point = contact(1.0)
    mesh = cam_mesh(CONTOUR, BORE, None, fine(point, phase=phase))
    size = HALF_WIDTH / 8
    start = mesh.points[:, mesh.facet_triples("contour")[0]]
    distance = np.hypot(*(start - point[:, None]))
    assert distance.min() == pytest.approx(min(phase, 1 - phase) * size, abs=1e-6 * size)
    lengths = facet_lengths(mesh, "contour")[distance < 1.8 * HALF_WIDTH]
    assert lengths.size >= 28
    np.testing.assert_allclose(lengths, size, rtol=1e-5)  # chord against arc, spline of the angle


def test_neighbouring_facets_grow_by_no_more_than_the_growth():
    lengths = facet_lengths(cam_mesh(CONTOUR, BORE, None, fine(contact(2.0))), "contour")
    ratio = np.roll(lengths, -1) / lengths
    # Size at 0.15 per distance: e^0.15 = 1.16, and rounding to whole facets.
    assert max(ratio.max(), 1 / ratio.min()) < 1.25


def test_contact_may_lie_at_the_seam_of_the_angle():
    for theta in (0.0, 1e-9, 2 * np.pi - 1e-9):
        mesh = cam_mesh(CONTOUR, BORE, None, fine(contact(theta)))
        corners = mesh.facet_triples("contour")[0]
        near = np.hypot(*(mesh.points[:, corners] - contact(theta)[:, None])).min()
        assert near < 1e-10


def test_roller_is_fine_at_the_contact_angle(roller):
    start = roller.points[:, roller.facet_triples("rim")[0]]
    lengths = facet_lengths(roller, "rim")
    angle = np.angle((start[0] + 1j * start[1]) * np.exp(-0.7j))
    assert lengths[np.argmin(abs(angle))] == pytest.approx(HALF_WIDTH / 8, rel=1e-6)
    assert lengths[abs(angle) > 1.5].min() > 2e-4


def test_block_is_fine_where_its_contact_is():
    mesh = block_mesh(0.2, 0.1, fine((0.03, 0.0)))
    start = mesh.points[:, mesh.facet_triples("top")[0]]
    finest = start[:, facet_lengths(mesh, "top").argmin()]
    assert np.hypot(*(finest - [0.03, 0.0])) < 2.5 * HALF_WIDTH
    assert np.hypot(*(start - [[0.03], [0.0]])).min() < 1e-15  # a facet ends at the contact
    assert mesh_area(mesh) == pytest.approx(0.02, rel=1e-13)


def test_half_disc_is_its_own_mirror_image():
    mesh = half_disc_mesh(0.1, fine())
    nodes = {tuple(node) for node in mesh.points.T}
    assert nodes == {(-x + 0.0, y) for x, y in mesh.points.T}
    assert len(nodes) == mesh.points.shape[1]
    for name in ("top", "arc"):
        start, end, _ = mesh.facet_triples(name)
        assert np.array_equal(end[:-1], start[1:])
    assert (mesh.points[1, mesh.boundary_nodes("top")] == 0).all()
    named = np.concatenate(list(mesh.to_skfem().boundaries.values()))
    assert np.array_equal(np.sort(named), np.sort(mesh.to_skfem().boundary_facets()))


def test_curved_nose_gets_smaller_facets():
    """A nose of 3 mm radius asks for facets of 0.47 mm where the far size is 4 mm."""
    lift = Lift(THETA, 0.012 * np.exp(-(((THETA - np.pi) / 0.5) ** 2)))
    nose = RollerContour(PitchCurve(lift, 0.03), 0.008)
    kappa = float(nose.curvature(np.array([np.pi]))[0])
    mesh = cam_mesh(nose, BORE, None, ElementSize(far_size=4e-3))
    start = mesh.points[:, mesh.facet_triples("contour")[0]]
    tip = np.argmin(np.hypot(*(start - nose.points(np.array([np.pi])))))
    assert facet_lengths(mesh, "contour")[tip] < 1.3 * 2 * np.pi / 40 / kappa
    assert facet_lengths(mesh, "contour").max() > 2e-3


class Circle:
    """A circular contour about a centre on the x axis."""

    def __init__(self, radius, centre):
        self.radius, self.centre = radius, centre

    def points(self, theta):
        return self.radius * self.normal(theta) + [[self.centre], [0.0]]

    def normal(self, theta):
        return np.array([np.cos(theta), np.sin(theta)])

    def curvature(self, theta):
        return np.full(np.shape(theta), 1 / self.radius)


class Limacon(Circle):
    """A curve with an inner loop, which crosses itself at the origin without turning back."""

    def points(self, theta):
        return (0.03 + 0.06 * np.cos(theta)) * super().normal(theta) + [[-0.045], [0.0]]

    def normal(self, theta):
        step = 1e-6
        tangent = self.points(theta + step) - self.points(theta - step)
        return np.array([tangent[1], -tangent[0]]) / np.hypot(*tangent)


def test_contour_that_does_not_go_round_the_bore_is_refused():
    with pytest.raises(GeometryError, match="minimum wall"):
        cam_mesh(Circle(0.03, 0.05), BORE, None, ElementSize(far_size=3e-3))


def test_contour_that_crosses_itself_is_refused_with_the_place():
    """gmsh would search for ever."""
    with pytest.raises(GeometryError, match=r"crosses itself at \(-4\d\.\d+, -?\d\.\d+\) mm"):
        cam_mesh(Limacon(0.03, 0.0), 2e-3, None, ElementSize(far_size=3e-3))


def test_thin_wall_gets_two_elements_across():
    mesh = cam_mesh(Circle(0.02, 9e-3), BORE, None, ElementSize(far_size=4e-3))
    wall = 0.02 - 9e-3 - BORE
    for name, x in (("contour", 9e-3 - 0.02), ("bore", -BORE)):
        start = mesh.points[:, mesh.facet_triples(name)[0]]
        nearest = np.argmin(np.hypot(start[0] - x, start[1]))
        assert facet_lengths(mesh, name)[nearest] < 0.5 * wall * 1.3
    assert quality(mesh).min_angle_deg > 25


def test_keyway_and_fillets_are_resolved():
    sharp = cam_mesh(CONTOUR, BORE, Keyway(6e-3, 3e-3), ElementSize(far_size=4e-3))
    assert facet_lengths(sharp, "keyway").max() < 1e-3 * 1.05
    rounded = cam_mesh(CONTOUR, BORE, Keyway(6e-3, 3e-3, 0.0, 5e-4), ElementSize(far_size=4e-3))
    x, y = rounded.points[:, rounded.facet_triples("keyway")[0]]
    on_fillet = (x > 0.013 - 5e-4 - 1e-9) & (y > 3e-3 - 5e-4 - 1e-9)
    assert on_fillet.sum() >= 5  # four facets on the quarter circle


def test_transformed_turns_then_shifts(cam):
    moved = cam.transformed(np.pi / 2, (1.0, 2.0))
    x, y = cam.points
    np.testing.assert_allclose(moved.points, [1.0 - y, 2.0 + x], atol=1e-15)
    assert moved.sha256 != cam.sha256
    assert np.array_equal(moved.triangles, cam.triangles)


def test_skfem_mesh_keeps_nodes_and_elements(cam):
    basis = Basis(cam.to_skfem(), ElementVector(ElementTriP2()), intorder=4)
    dofs = cam.dof_map(basis)
    assert np.array_equal(np.sort(dofs.ravel()), np.arange(basis.N))
    for component in (0, 1):
        np.testing.assert_array_equal(basis.doflocs[:, dofs[component]], cam.points)
    u = basis.project(lambda x: np.array([3 * x[0] - x[1], x[0] + 2 * x[1]]))
    expected = np.array([[3, -1], [1, 2]]) @ cam.points
    np.testing.assert_allclose(u[dofs], expected, atol=1e-12)


def test_skfem_facets_are_those_of_the_body(cam):
    mesh = cam.to_skfem()
    for name, (start, end, _) in cam.boundaries.items():
        ends = np.sort(mesh.facets[:, mesh.boundaries[name]], axis=0)
        assert np.array_equal(ends, np.sort([start, end], axis=0))


def test_dof_map_refuses_another_basis(cam):
    with pytest.raises(MeshError, match="vector P2"):
        cam.dof_map(Basis(cam.to_skfem(), ElementTriP1()))


def test_arrays_cannot_be_written_to(cam):
    for array in (cam.points, cam.triangles, cam.boundaries["contour"]):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 0
    with pytest.raises(TypeError):
        cam.boundaries["contour"] = cam.boundaries["bore"]


def test_same_input_gives_the_same_mesh_bit_for_bit(roller):
    assert roller_mesh(0.008, 0.003, 0.7, fine()).sha256 == roller.sha256
    assert roller_mesh(0.008, 0.003, 0.7, fine(phase=0.5)).sha256 != roller.sha256


def test_fingerprint_covers_points_and_triangles():
    names = {"edge": [[0], [1], [3]]}
    first = BodyMesh(TRIANGLE, np.arange(6)[:, None], names)
    turned = BodyMesh(TRIANGLE, [[1], [2], [0], [4], [5], [3]], names)
    scaled = BodyMesh(2 * TRIANGLE, np.arange(6)[:, None], names)
    assert len({first.sha256, turned.sha256, scaled.sha256}) == 3


def test_another_process_gives_the_same_mesh(roller):
    script = (
        "from camwright.meshes.body_mesh import roller_mesh;"
        "from camwright.meshes.element_size import ElementSize;"
        f"size = ElementSize.from_half_width({HALF_WIDTH}, 4e-3);"
        "print(roller_mesh(0.008, 0.003, 0.7, size).sha256)"
    )
    process = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, timeout=120
    )
    assert process.stdout.strip() == roller.sha256


def test_a_running_gmsh_is_left_as_it_was(roller):
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # as Python does; gmsh resets it
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("Mesh.Algorithm", 5)
        gmsh.option.setNumber("Mesh.MeshSizeFactor", 2.5)
        gmsh.model.add("mine")
        gmsh.model.geo.addPoint(1, 2, 3, tag=7)
        gmsh.model.geo.synchronize()
        gmsh.model.add("mine too")
        gmsh.model.setCurrent("mine")
        assert roller_mesh(0.008, 0.003, 0.7, fine()).sha256 == roller.sha256
        assert gmsh.isInitialized()
        assert gmsh.model.getCurrent() == "mine"
        assert gmsh.model.list() == ["", "mine", "mine too"]
        assert gmsh.model.getEntities(0) == [(0, 7)]
        assert gmsh.option.getNumber("Mesh.Algorithm") == 5
        assert gmsh.option.getNumber("Mesh.MeshSizeFactor") == 2.5
    finally:
        gmsh.finalize()


def test_a_worker_thread_can_mesh(roller):
    """gmsh's signal handler would only allow the main thread."""
    with ThreadPoolExecutor(1) as pool:
        mesh = pool.submit(roller_mesh, 0.008, 0.003, 0.7, fine()).result()
    assert mesh.sha256 == roller.sha256


def dispositions() -> dict[str, int]:
    """Signals that this process ignores and catches, as bits, but those of the C library."""
    status = Path("/proc/self/status").read_text().splitlines()
    words = dict(line.split(":", 1) for line in status if line.startswith("Sig"))
    ours = ~(0b11 << 31)
    return {name: int(words[name], 16) & ours for name in ("SigIgn", "SigCgt", "SigBlk")}


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="states no signals")
def test_meshing_keeps_what_each_signal_does():
    """gmsh sets eight back to the default, by which the process would end without a word."""
    caught = (signal.SIGHUP, signal.SIGINT, signal.SIGQUIT, signal.SIGTERM, signal.SIGUSR1)
    before = {number: signal.getsignal(number) for number in caught}
    received = []
    try:
        for number in caught:
            signal.signal(number, lambda number, _: received.append(number))
        there = dispositions()
        roller_mesh(0.008, 0.003, 0.0, ElementSize(far_size=2e-3))
        assert dispositions() == there
        with signals_kept():
            signal.pthread_kill(threading.get_ident(), signal.SIGTERM)
            assert received == []
        assert received == [signal.SIGTERM]
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def test_gmsh_ends_with_the_mesh():
    import gmsh

    roller_mesh(0.008, 0.003, 0.0, ElementSize(far_size=2e-3))
    assert not gmsh.isInitialized()


def test_bore_reaching_the_contour_names_the_wall():
    # The contour's least radius is 50 - 8 = 42 mm; the wall must be over 1 % of the bore radius.
    with pytest.raises(GeometryError, match=r"wall .* = 0\.4 mm"):
        cam_mesh(CONTOUR, 0.0416, None, ElementSize(far_size=3e-3))
    with pytest.raises(GeometryError, match=r"wall .* = -1 mm"):
        cam_mesh(CONTOUR, 0.043, None, ElementSize(far_size=3e-3))


def test_keyway_reaching_the_contour_names_the_wall():
    towards_base = Keyway(6e-3, 0.034, 0.0)
    with pytest.raises(GeometryError, match="minimum wall"):
        cam_mesh(CONTOUR, BORE, towards_base, ElementSize(far_size=3e-3))
    away = Keyway(6e-3, 0.034, np.pi)
    assert "keyway" in cam_mesh(CONTOUR, BORE, away, ElementSize(far_size=3e-3)).boundaries


def test_widest_fillet_still_makes_a_good_mesh():
    rounded = Keyway(6e-3, 3e-3, 1.0, 0.8 * 3e-3)
    shape = quality(cam_mesh(CONTOUR, BORE, rounded, ElementSize(far_size=3e-3)))
    assert shape.min_angle_deg > 20
    assert shape.min_scaled_jacobian > 0.4


def test_undercut_contour_is_refused_with_its_angle():
    sharp = Lift(THETA, 0.02 * np.exp(-(((THETA - np.pi) / 0.25) ** 2)))
    contour = RollerContour(PitchCurve(sharp, 0.03), 0.012)
    assert contour.undercut().present
    with pytest.raises(GeometryError, match=r"undercut at cam angle 1\d\d\.\d\d deg"):
        cam_mesh(contour, BORE, None, ElementSize(far_size=3e-3))


@pytest.mark.parametrize(
    ("build", "field"),
    [
        (lambda: roller_mesh(0.0, 0.0, 0.0, fine()), "roller.radius"),
        (lambda: roller_mesh(0.008, 0.008, 0.0, fine()), "roller.hub_radius"),
        (lambda: roller_mesh(0.008, np.nan, 0.0, fine()), "roller.hub_radius"),
        (lambda: block_mesh(-1.0, 1.0, fine()), "block.width"),
        (lambda: block_mesh(1.0, np.nan, fine()), "block.depth"),
        (lambda: block_mesh(1.0, 1.0, fine((0.0, -0.1))), "sizing.contact_point"),
        (lambda: half_disc_mesh(-1.0, fine()), "patch.radius"),
        (lambda: half_disc_mesh(0.1, fine(phase=0.5)), "sizing.phase"),
        (lambda: cam_mesh(CONTOUR, 0.0, None, fine()), "cam.bore_radius"),
        (lambda: cam_mesh(CONTOUR, BORE, Keyway(0.02, 3e-3), fine()), "cam.keyway.width"),
        (lambda: cam_mesh(CONTOUR, BORE, Keyway(6e-3, 3e-3, 0, 2.42e-3), fine()), "fillet"),
        (lambda: cam_mesh(CONTOUR, BORE, None, fine((0.0, 0.0))), "sizing.contact_point"),
    ],
)
def test_bad_dimensions_name_their_field(build, field):
    with pytest.raises(InputError, match=field):
        build()


def test_contact_zone_longer_than_the_rim_is_refused():
    with pytest.raises(MeshError, match="contact zone on 'rim'"):
        roller_mesh(0.008, 0.0, 0.0, ElementSize.from_half_width(0.02, 4e-3))


def test_unknown_boundary_is_refused_with_the_known_ones(cam):
    with pytest.raises(MeshError, match="'rim', must be one of contour, bore, keyway"):
        cam.facet_triples("rim")


TRIANGLE = np.array([[0.0, 1, 0, 0.5, 0.5, 0], [0, 0, 1, 0, 0.5, 0.5]])


@pytest.mark.parametrize(
    ("points", "triangles", "text"),
    [
        (TRIANGLE, [[0], [2], [1], [5], [4], [3]], "inverted triangles = 1"),
        (TRIANGLE, [[0], [1], [5], [3], [4], [2]], "corners"),
        (TRIANGLE, [[0], [1], [2], [3], [4], [6]], "node number"),
        (TRIANGLE, [[0], [1], [2]], "must be \\(6, k\\)"),
        (TRIANGLE.T, [[0], [1], [2], [3], [4], [5]], "must be \\(2, n\\)"),
    ],
)
def test_inconsistent_arrays_are_refused(points, triangles, text):
    with pytest.raises(MeshError, match=text):
        BodyMesh(points, triangles, {"edge": [[0], [1], [3]]})
