"""Any synthesized contour meshes or is refused by name; its contact agrees with Hertz."""

import re
from collections import Counter

import pytest
from seeded_contours import FAMILIES, contact

from camwright.geometry.errors import CamError
from camwright.meshes.mesh_quality import gate, quality
from camwright.pipeline.contact.certificate import EDGES, contact_meshes, solve_pair
from camwright.pipeline.cycle.solution import is_body

EACH = 63  # of each family: 504 contours
HERTZ = 1e-3
"""Mesh of 8 edges per half-width, 1.3e-4 too low, and bodies of finite size: up to 7e-4."""


def tried(family, seed):
    """What became of a contact: as Hertz, slender, meshed, or the reason of its refusal."""
    try:
        one = contact(family, seed)
        if not is_body(one.pair.contour):
            return "undercut"
        if one.half_width > 0.1 * float(one.pair.relative_radius(one.theta)):
            return "wide"  # half-planes no more: Hertz does not hold
        half_width, point = one.half_width, one.pair.contour.points(one.theta)
        for body in contact_meshes(one.pair, one.theta, half_width, EDGES[1]):
            gate(quality(body, point, half_width), edges_min=EDGES[1])
        if seed % 2:
            return "meshed"  # solved at every second seed, for the time it takes
        solution = solve_pair(one.pair, one.theta, one.force, EDGES[1]).solution
    except CamError as error:
        assert re.search(r"[a-z_.]+ ?=|fit|undercut", str(error)), f"{seed}: no name in '{error}'"
        return type(error).__name__
    assert solution.residual_equilibrium < 1e-8
    if one.slender:
        return "slender"
    allowed = HERTZ + one.varying
    assert abs(solution.p0 / one.pressure - 1.0) <= allowed, (
        family,
        seed,
        solution.p0 / one.pressure,
    )
    return "as Hertz"


@pytest.mark.parametrize("family", FAMILIES)
def test_a_contour_meshes_and_its_contact_is_that_of_hertz(family):
    assert tried(family, 16) == "as Hertz"


@pytest.mark.slow
@pytest.mark.parametrize("family", FAMILIES)
def test_five_hundred_contours_mesh_or_are_refused_by_name(family):
    results = Counter(tried(family, seed) for seed in range(EACH))
    assert results["as Hertz"] + results["meshed"] >= 0.6 * EACH, results
    assert results["MeshError"] == 0, results
