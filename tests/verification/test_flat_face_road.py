"""A flat face from case to contact: an eccentric circle has every answer in closed form.

Under a face the circle of radius R lifts by e (1 - cos theta), its curvature and so Hertz's radius
are constant, and the contact wanders by e sin theta.
"""

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.follower_height import face_height
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.certificate import EDGES, certificate_point, mesh_figures
from camwright.pipeline.contact.closed_form import closed_form_history
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.follower_body import FaceBody
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.solution import turns_of
from camwright.pipeline.follower.follower_forces import turn_integral
from camwright.pipeline.smoothing.required_lift import cam_lift

PAPERS = Path(__file__).resolve().parents[2] / "cases" / "papers"
E, RADIUS, SPEED = 0.005, 0.018, 2.0 * np.pi * 2500.0 / 60.0
THETA = uniform_turn(72)


def text(friction="0.08", guides="0.05"):
    """The published flat valve cam with an eccentric circle for a lift."""
    given = (PAPERS / "petrescu_c.toml").read_text()
    start, end = given.index("[lift]"), given.index("[mechanism]")
    lift = f'[lift]\nkind = "eccentric"\neccentricity = "{1e3 * E} mm"\n\n'
    changed = given[:start] + lift + given[end:]
    train = changed.index("[valve_train]")  # of a motion law, not of a circle
    changed = changed[:train] + changed[changed.index("[follower]") :]
    changed = changed.replace('"13 mm"', f'"{1e3 * (RADIUS - E)} mm"', 1)
    if friction == "":
        changed = changed.replace("friction = 0.08", "#", 1)
    return changed.replace("friction = 0.05", f"friction = {guides}")


def turned(case_text):
    """Contour and turn of a case."""
    case = parse_case(case_text)
    contour = case.contour(cam_lift(case, {}))
    return contour, turns_of(machines(case), contour, THETA.size)[0]


@pytest.fixture(scope="module")
def eccentric():
    return turned(text())


def test_motion_and_curvature_are_those_of_the_circle(eccentric):
    contour, turn = eccentric
    np.testing.assert_allclose(turn.loads.lift, E * (1 - np.cos(THETA)), atol=1e-12)
    np.testing.assert_allclose(turn.loads.velocity, SPEED * E * np.sin(THETA), atol=1e-9)
    np.testing.assert_allclose(contour.radius_of_curvature(THETA), RADIUS, rtol=1e-8)
    x, y = contour.points(THETA)
    np.testing.assert_allclose(np.hypot(x + E, y), RADIUS, rtol=1e-12)


def test_force_is_that_of_spring_mass_and_friction(eccentric):
    """The free body of the follower, guides of finite length: along the stem and about its end."""
    _, turn = eccentric
    loads, guides = turn.loads, turn.guides
    free = 4500.0 + 150e3 * E * (1 - np.cos(THETA)) + 0.1 * SPEED**2 * E * np.cos(THETA)
    rubs = 0.05 * (guides.rubbing_load_a + guides.rubbing_load_b) * np.sign(loads.velocity)
    np.testing.assert_allclose(loads.normal_force, free + rubs, rtol=1e-9)
    across = guides.reaction_a - guides.reaction_b - 0.08 * loads.normal_force
    assert np.abs(across).max() < 1e-9 * loads.normal_force.max()
    spacing = turn.machine.guides.spacing
    about = (
        guides.moment_a + guides.moment_b + guides.reaction_a * loads.overhang
        - guides.reaction_b * (loads.overhang + spacing) - loads.normal_force * E * np.sin(THETA)
    )  # fmt: skip
    assert np.abs(about).max() < 1e-9 * loads.normal_force.max() * spacing


@pytest.mark.parametrize(("friction", "guides"), [("", "0.0"), ("0.08", "0.0"), ("0.08", "0.05")])
def test_work_over_the_turn_is_the_heat(friction, guides):
    """Torque N s' without friction; with it what guides and face turn into heat, to 1e-10."""
    contour, turn = turned(text(friction, guides))
    loads = turn.loads
    slope, height = E * np.sin(THETA), RADIUS - E * np.cos(THETA)
    mu = float(friction or 0.0)
    torque = loads.normal_force * (slope + mu * height)
    np.testing.assert_allclose(loads.cam_torque, torque, atol=1e-9 * np.abs(torque).max())
    rubs = float(guides) * (turn.guides.rubbing_load_a + turn.guides.rubbing_load_b)
    heat = turn_integral(THETA, rubs * np.abs(slope) + mu * loads.normal_force * height)
    swing = turn_integral(THETA, np.abs(loads.cam_torque))
    assert abs(turn_integral(loads.theta, loads.cam_torque) - heat) < 1e-10 * swing
    assert contour.pitch.lift.stroke == pytest.approx(2 * E, rel=1e-9)


def test_hertz_radius_is_constant_and_finite_elements_agree(eccentric):
    """Hertz's cylinder on a flat within 0.5 %: what remains is the finite size of both bodies."""
    contour, turn = eccentric
    pair, few = contact_pair(turn.machine, contour), slice(None, None, 9)
    history = closed_form_history(pair, THETA, turn.loads.normal_force)
    np.testing.assert_allclose(history.relative_radius, RADIUS, rtol=1e-8)
    modulus = 210e9 / (1 - 0.3**2) / 2
    peak = np.sqrt(turn.loads.normal_force / 0.020 * modulus / (np.pi * RADIUS))
    np.testing.assert_allclose(history.p0, peak, rtol=1e-8)
    force = turn.loads.normal_force[few]
    solved = two_scale_history(pair, CycleBodies.meshed(pair), THETA[few], force)
    np.testing.assert_allclose(solved.p0, history.p0[few], rtol=5e-3)
    np.testing.assert_allclose(solved.half_width, history.half_width[few], rtol=5e-3)
    assert solved.residual_equilibrium.max() < 1e-9


def test_a_large_cylinder_on_a_thick_block_is_hertz():
    """Away from the finite size: half-widths of a hundredth of the bodies, p0 within 0.05 %."""
    steel = Elastic(210e9, 0.3)
    contour, _ = turned(text())
    pair = ContactPair(contour, 0.02, 0.003, None, steel, FaceBody(0.03, 0.02, 0.03, steel))
    solved = two_scale_history(pair, CycleBodies.meshed(pair), THETA[:1], np.array([1000.0]))
    np.testing.assert_allclose(solved.p0, solved.p0_hertz, rtol=5e-4)


@pytest.mark.parametrize("at", [pytest.param(0, marks=pytest.mark.slow), 18])
def test_certificate_and_cycle_agree(eccentric, at):
    """Both bodies in full, at mid-face and near its edge: spread within 1 %, here 0.2 %."""
    contour, turn = eccentric
    pair, only = contact_pair(turn.machine, contour), slice(at, at + 1)
    force = turn.loads.normal_force[only]
    history = two_scale_history(pair, CycleBodies.meshed(pair), THETA[only], force)
    theta = float(THETA[at])
    meshes = [mesh_figures(pair, theta, float(force[0]), edges) for edges in EDGES]
    point = certificate_point(history, 0, theta, meshes)
    assert point.spread < 0.002
    assert point.gci < 0.005
    assert point.tau_max.extrapolated == pytest.approx(point.tau_max_cycle, rel=0.01)


def test_published_cam_gives_its_lift_back():
    """On the contour of the case: a face let down on it moves by the lift, to 1e-6."""
    case = read_case(PAPERS / "petrescu_c.toml")
    contour = case.contour(cam_lift(case, {}))
    theta = np.linspace(0, 2 * np.pi, 97)[:-1] + 0.0123
    height = face_height(contour.polygon(20_000), theta) - contour.pitch.base_radius
    lift = contour.pitch.lift
    np.testing.assert_allclose(height, lift(theta), rtol=0, atol=1e-6 * lift.stroke)
