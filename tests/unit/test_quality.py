"""Quality figures of single triangles, and the gate."""

from dataclasses import replace

import numpy as np
import pytest

from camwright.geometry.errors import InputError, MeshError
from camwright.meshes.body_mesh import BodyMesh, block_mesh
from camwright.meshes.element_size import ElementSize
from camwright.meshes.mesh_quality import Quality, corner_angles, gate, quality, scaled_jacobians

GOOD = Quality(30.0, 0.6, 8.0, 100, 250)


def triangle(a, b, c, bulge=0.0):
    """One triangle whose first edge is bent inwards by `bulge`."""
    a, b, c = (np.array(p, dtype=float) for p in (a, b, c))
    inward = np.array([a[1] - b[1], b[0] - a[0]]) / np.hypot(*(b - a))
    middles = [(a + b) / 2 + bulge * inward, (b + c) / 2, (c + a) / 2]
    edges = [[0, 1, 2], [1, 2, 0], [3, 4, 5]]
    return BodyMesh(np.array([a, b, c, *middles]).T, np.arange(6)[:, None], {"edge": edges})


EQUILATERAL = ((0, 0), (1, 0), (0.5, np.sqrt(0.75)))


def test_equilateral_triangle_is_perfect():
    mesh = triangle(*EQUILATERAL)
    np.testing.assert_allclose(np.degrees(corner_angles(mesh)), 60.0, rtol=1e-12)
    np.testing.assert_allclose(scaled_jacobians(mesh), 1.0, rtol=1e-12)


def test_angles_of_a_right_triangle():
    mesh = triangle((0, 0), (np.sqrt(3), 0), (0, 1))
    np.testing.assert_allclose(np.degrees(corner_angles(mesh)[:, 0]), [90, 30, 60], rtol=1e-12)
    assert quality(mesh).min_angle_deg == pytest.approx(30, rel=1e-12)
    # 2 area / (product of the longer edges) * 2/sqrt(3) = sin(30 deg) * 2/sqrt(3)
    assert quality(mesh).min_scaled_jacobian == pytest.approx(1 / np.sqrt(3), rel=1e-12)


def test_a_bent_edge_narrows_the_angles_at_its_ends():
    # The edge y = 4 h x (1 - x) leaves the corner at slope 4 h.
    mesh = triangle(*EQUILATERAL, bulge=0.05)
    expected = 60 - np.degrees(np.arctan(0.2))
    np.testing.assert_allclose(np.degrees(corner_angles(mesh)[:2, 0]), expected, rtol=1e-12)


def test_a_folded_triangle_has_a_negative_jacobian():
    assert quality(triangle(*EQUILATERAL, bulge=0.4)).min_scaled_jacobian > 0
    assert quality(triangle(*EQUILATERAL, bulge=0.45)).min_scaled_jacobian < 0


def test_quality_does_not_depend_on_position():
    mesh = triangle((0, 0), (2, 0.3), (0.4, 1), bulge=0.1)
    moved = quality(mesh.transformed(1.0, (3.0, -4.0)))
    assert moved.min_angle_deg == pytest.approx(quality(mesh).min_angle_deg, rel=1e-12)
    assert moved.min_scaled_jacobian == pytest.approx(quality(mesh).min_scaled_jacobian, rel=1e-12)


@pytest.mark.parametrize("edges", [4, 8, 16])
def test_edges_across_the_half_width_are_those_asked_for(edges):
    sizing = ElementSize.from_half_width(1e-3, 0.02, contact_point=(0, 0), edges=edges)
    found = quality(block_mesh(0.2, 0.2, sizing), (0, 0), 1e-3)
    assert found.edges_across_half_width == pytest.approx(edges, rel=1e-9)


def test_edges_count_the_longest_facet_in_the_contact():
    sizing = ElementSize.from_half_width(1e-3, 0.02, contact_point=(0, 0))
    mesh = block_mesh(0.2, 0.2, sizing)
    # Four half-widths out the facets have grown beyond a/8.
    assert quality(mesh, (0, 0), 4e-3).edges_across_half_width < 4 * 8 * 0.7


def test_edges_of_a_contact_smaller_than_a_facet_are_below_one():
    mesh = block_mesh(0.2, 0.2, ElementSize(far_size=0.02))
    found = quality(mesh, (0.001, 0), 1e-4).edges_across_half_width
    assert found == pytest.approx(1e-4 / 0.02, rel=1e-9)  # ten equal facets along the top


def test_half_width_must_be_positive():
    with pytest.raises(InputError, match="half_width"):
        quality(triangle(*EQUILATERAL), (0, 0), np.nan)


def test_gate_gives_a_good_mesh_back():
    assert gate(GOOD, angle_min_deg=30.0, scaled_jacobian_min=0.6, edges_min=8.0) is GOOD


@pytest.mark.parametrize(
    ("field", "bad", "text"),
    [
        ("min_angle_deg", 19.8, r"mesh\.min_angle_deg = 19\.8, must be >= 20"),
        ("min_angle_deg", np.nan, r"mesh\.min_angle_deg = nan"),
        ("min_scaled_jacobian", 0.297, r"mesh\.min_scaled_jacobian = 0\.297, must be >= 0\.3"),
        ("edges_across_half_width", 7.9, r"mesh\.edges_across_half_width = 7\.9"),
    ],
)
def test_gate_names_figure_and_limit(field, bad, text):
    with pytest.raises(MeshError, match=text):
        gate(replace(GOOD, **{field: bad}), edges_min=8.0)
