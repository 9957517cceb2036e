"""Both walls of a groove by finite elements, the outer one on the rim around it.

Against Hertz where the contact is small, the outer wall by its points, the rim on other supports.
"""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.form_closure import groove_wall
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.certificate import mesh_figures
from camwright.pipeline.contact.elasticity.elastic_body import ElasticBody, Springs
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair, under_load
from camwright.pipeline.preview import preview_case

FILE = Path(__file__).parents[2] / "cases" / "motions" / "feeder-groove.toml"
SECTORS = 48


@cache
def loaded():
    """Cycle of the load case of the file with its contact pair under load."""
    trial = preview_case(read_case(FILE), corners=False)
    (cycle,) = (each for each in trial.cycles if each.load_case == "running")
    return cycle, under_load(contact_pair(cycle.machine, cycle.contour), cycle.loads)


@cache
def bodies():
    return CycleBodies.meshed(loaded()[1])


def wall():
    contour = loaded()[0].contour
    return groove_wall(contour, "outer", contour.roller_radius)


# --- the outer wall ---------------------------------------------------------------------------
def test_the_outer_wall_by_its_points():
    """Tangent, curvature and its slope by differences; normals point to the roller centre."""
    outer, theta, step = wall(), uniform_turn(90) + 0.01, 1e-4
    before, here, after = (outer.points(theta + k * step) for k in (-1, 0, 1))
    velocity, bend = (after - before) / (2 * step), (after - 2 * here + before) / step**2
    assert outer.velocity(theta) == pytest.approx(velocity, abs=1e-6)
    speed = np.hypot(*velocity)
    assert outer.tangent(theta) == pytest.approx(-velocity / speed, abs=1e-6)
    turning = (velocity[0] * bend[1] - velocity[1] * bend[0]) / speed**3
    assert outer.curvature(theta) == pytest.approx(-turning, abs=2e-3)  # of up to 14 1/m
    slope = (outer.curvature(theta + step) - outer.curvature(theta - step)) / (2 * step)
    assert outer.curvature_slope(theta) == pytest.approx(slope, abs=5e-3)  # of up to 90
    centre = here + outer.roller_radius * outer.normal(theta)
    assert centre == pytest.approx(outer.pitch.points(theta), abs=1e-15)


def test_a_roller_pulled_against_the_outer_wall_runs_on_its_path():
    outer, theta = wall(), uniform_turn(60) + 0.02
    heights = outer.standing(outer.polygon(5760), theta)
    assert heights == pytest.approx(outer.pitch.height(theta), abs=1e-10)


def test_the_gap_beside_the_contact_by_distances():
    """Roller and wall in the frame of the contact, by points of the wall and a circle."""
    _, pair = loaded()
    pulling, theta = pair.pulling, np.array([0.3, 1.0, 2.2])
    points, normal = pulling.contour.points(theta), pulling.contour.normal(theta)
    for k, angle in enumerate(theta):
        near = pulling.contour.points(angle + np.linspace(-0.004, 0.004, 9))
        along = np.array([normal[1, k], -normal[0, k]])
        arm = near - points[:, k, None]
        xi, height = along @ arm, normal[:, k] @ arm
        radius = pulling.contour.roller_radius
        roller = radius - np.sqrt(radius**2 - xi**2)
        gap = pulling.gap(theta[[k]], xi[None])[0]
        assert gap == pytest.approx(roller - height, abs=1e-13)


# --- contact ----------------------------------------------------------------------------------
def test_finite_elements_agree_with_hertz_on_both_walls():
    """Half-widths of 0.2 % of the relative radius: the closed form holds to 1e-3."""
    cycle, pair = loaded()
    theta, force = cycle.theta[::40], cycle.loads.normal_force[::40]
    history = two_scale_history(pair, bodies(), theta, force)
    pushes = pair.wall(theta) > 0
    assert 3 < pushes.sum() < theta.size - 3
    for at in (pushes, ~pushes):
        assert history.p0[at] == pytest.approx(history.p0_hertz[at], rel=1e-3)
    assert history.p0_hertz == pytest.approx(cycle.contact.p0_hertz[::40], rel=1e-9)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_both_bodies_in_full_agree_with_the_cycle(side):
    """Meshes of eight elements per half-width at the worst angle of each wall: 1 %."""
    cycle, pair = loaded()
    here = np.where(cycle.loads.wall == side, cycle.contact.p0_hertz, 0.0)
    k = int(np.argmax(here))
    theta, force = cycle.theta[[k]], cycle.loads.normal_force[[k]]
    carrying = pair.carrying(float(theta[0]))
    assert (carrying.rim_radius is None) == (side > 0)
    full = mesh_figures(carrying, float(theta[0]), float(force[0]), 8.0)
    history = two_scale_history(pair, bodies(), theta, force)
    for name in ("p0", "half_width", "tau_max", "von_mises"):
        assert getattr(full, name) == pytest.approx(float(getattr(history, name)[0]), rel=1e-2)


def test_the_web_under_the_rim_may_be_replaced_by_its_outer_circle():
    """The rim on a bedding of the stiffness of the web, and held at the circle: p0 to 2e-5.

    The bedding: 48 sectors on springs of shear stiffness G/h per area, h: depth of the groove, with
    the outer circle free.
    """
    cycle, pair = loaded()
    rim, body = bodies().pulling.cam, bodies().pulling.cam.body
    mesh, depth = body.mesh, cycle.machine.cam.groove.depth
    angle = np.arctan2(mesh.points[1], mesh.points[0]) % FULL_TURN
    sector = np.minimum((angle / FULL_TURN * SECTORS).astype(int), SECTORS - 1)
    ways = np.zeros((2 * SECTORS, 2, mesh.points.shape[1]))
    for k in range(SECTORS):
        share = (sector == k) / np.sum(sector == k)
        ways[2 * k, 0], ways[2 * k + 1, 1] = share, share
    area = np.pi * pair.pulling.rim_radius**2 - pair.pulling.contour.area()
    shear = body.modulus / (2.0 * (1.0 + body.poisson))
    stiffness = np.full(2 * SECTORS, shear / depth**2 * area / SECTORS)
    bedded = replace(
        rim,
        body=ElasticBody(mesh, body.modulus, body.poisson, {}, Springs(ways, stiffness)),
        also_free=("outer",),
    )
    pulled = cycle.loads.wall < 0
    theta, load = cycle.theta[pulled][::20], cycle.contact.line_load[pulled][::20]
    radius = cycle.contact.relative_radius[pulled][::20]
    where = pair.pulling.contour.points(theta), pair.pulling.contour.normal(theta)
    bends = [each.correction(*where).bend for each in (rim, bedded)]
    # to first order p0 changes by half as much as the relative curvature
    changes = [np.abs(0.5 * load * bend * radius).max() for bend in bends]
    assert 0.0 < max(changes) < 2e-5
