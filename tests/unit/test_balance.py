"""A cam's balance: a hole left out or drilled, in check, record and workshop."""

import json
from dataclasses import replace
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest
from cam_parts import mesh_area
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import GeometryError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import cam_mesh
from camwright.meshes.element_size import ElementSize
from camwright.meshes.gmsh_mesher import session
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.part_strength import cam_unbalance
from camwright.pipeline.contact.certificate import solve_pair
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies, two_scale_history
from camwright.pipeline.cycle.cam_balance import WALL, balance, drilled_hole
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.camshaft_loads import CounterHole, greatest_hole, unbalance
from camwright.pipeline.results.workshop_files import outline_of, write_workshop
from camwright.reports.sheet_turn import SheetTurn

KEY = '\n[cam.keyway]\nwidth = "6 mm"\ndepth = "2.8 mm"\nangle = "50 deg"\n'
ORDERED = "\n[cam.counter_hole]\n"


def a_cam(height):
    """A lopsided cam on the template's roller of 16 mm and pitch radius of 60 mm."""
    theta = uniform_turn(720)
    bump = 0.5 * height * (1 - np.cos(theta)) + 1e-3 * (1 - np.cos(2 * theta + 0.3))
    return RollerContour(PitchCurve(Lift(theta, bump - bump.min()), 0.06), 0.016)


SLIGHT, HEAVY = a_cam(2e-3), a_cam(16e-3)


def case_of(extra=""):
    return parse_case(small_machine("balance") + KEY + extra)


def moments_by_sectors(contour, cam, hole):
    """Area and first moment of what is left, summed in polar sectors: no formula of the code's.

    The trapezoidal rule of a smooth periodic integrand; bore, keyway and hole by Gauss.
    """
    theta = uniform_turn(20_000)
    x, y = contour.points(theta)
    dx, dy = contour.velocity(theta)
    r2, turn = x**2 + y**2, (x * dy - y * dx) / (x**2 + y**2)
    step = 2 * np.pi / theta.size
    area = np.sum(0.5 * r2 * turn) * step
    moment = np.array([np.sum(r2 * part * turn) / 3 * step for part in (x, y)])
    u, weight = np.polynomial.legendre.leggauss(60)
    across, half = 0.5 * cam.keyway.width * u, 0.5 * cam.keyway.width
    inner, floor = np.sqrt(cam.bore_radius**2 - across**2), cam.bore_radius + cam.keyway.depth
    cut, arm = half * weight @ (floor - inner), half * weight @ (floor**2 - inner**2) / 2
    direction = np.array([np.cos(cam.keyway.angle), np.sin(cam.keyway.angle)])
    around = uniform_turn(64)
    depth = 0.5 * hole.radius * (u + 1)
    px = hole.centre[0] + np.outer(depth, np.cos(around))
    py = hole.centre[1] + np.outer(depth, np.sin(around))
    patch = np.outer(0.5 * hole.radius * weight * depth, np.full(64, 2 * np.pi / 64))
    area -= np.pi * cam.bore_radius**2 + cut + patch.sum()
    return area, moment - arm * direction - [np.sum(patch * px), np.sum(patch * py)]


def test_nothing_is_left_of_the_unbalance_by_numerical_area_moments():
    """To 1e-9 of the moment there was, and of the area."""
    cam = case_of(ORDERED).cam
    drilled = balance(cam, SLIGHT)
    assert drilled.missed == ""
    area, moment = moments_by_sectors(SLIGHT, cam, drilled.hole)
    assert area == pytest.approx(drilled.left.area, rel=1e-9)
    before = np.hypot(*drilled.unbalance.moment)
    assert before > 1e-3 * drilled.unbalance.area * 1e-3
    assert np.hypot(*moment) < 1e-9 * drilled.unbalance.area * 0.06
    assert drilled.left.product < 1e-9 * drilled.unbalance.product
    assert drilled.left.mass < drilled.unbalance.mass


def test_a_heavy_cam_gets_the_hole_that_helps_most():
    """None takes it all; the greatest keeps its walls, and no other hole of a grid beats it."""
    cam = case_of(ORDERED).cam
    drilled = balance(cam, HEAVY)
    assert "no counter-hole that balances the cam fits" in drilled.missed
    hole, ring = drilled.hole, HEAVY.polygon(7200)
    assert 0.0 < drilled.left.product < drilled.unbalance.product
    away = np.hypot(*(ring - hole.centre[:, None])).min() - hole.radius
    inwards = np.hypot(*hole.centre) - hole.radius - cam.bore_radius - cam.keyway.depth
    assert min(away, inwards) == pytest.approx(WALL, abs=1e-5)
    direction = hole.centre / np.hypot(*hole.centre)
    reach = cam.bore_radius + cam.keyway.depth + WALL
    for place in np.linspace(0.012, 0.07, 200):
        room = np.hypot(*(ring - (place * direction)[:, None])).min() - WALL
        radius = max(min(room, place - reach), 0.0)
        assert radius**2 * place <= hole.radius**2 * np.hypot(*hole.centre) * (1 + 1e-4)


def test_no_room_for_any_hole():
    thick = case_of('\n[cam.counter_hole]\nwall = "30 mm"\n').cam
    whole = balance(thick, HEAVY)
    assert whole.hole is None
    assert "no hole fits" in whole.missed
    assert drilled_hole(thick, HEAVY) is None
    assert whole.record()["hole_drilled"] is False
    uneven = unbalance(HEAVY, 0.01, None, 0.01, 7850.0)
    with pytest.raises(GeometryError, match="no hole fits"):
        greatest_hole(HEAVY, uneven, 0.01, 0.03)


def solved(case, contour):
    """A solution without cycles at 157 rad/s of the crank: the check reads the cam alone."""
    state = case.load_cases[0].model_copy(update={"speed": 157.0})
    case = case.model_copy(update={"load_cases": (state,)})
    return Solution(case, contour, machines(case), Tier.PREVIEW, mesh=None, cycles=())


def test_the_check_judges_the_cam_as_it_is_made():
    plain = small_machine("balance").replace("[limits]", '[limits]\nunbalance = "16 mm/s"', 1) + KEY
    left_out, drilled = (
        cam_unbalance(solved(parse_case(plain + extra), SLIGHT)) for extra in ("", ORDERED)
    )
    whole = balance(parse_case(plain).cam, SLIGHT)
    assert left_out.demand == pytest.approx(whole.unbalance.eccentricity * 78.5)
    assert "would remove 100% of it" in left_out.note
    assert drilled.demand < 1e-6 * left_out.demand
    assert (left_out.status, drilled.status) == ("fail", "pass")
    heavy = cam_unbalance(solved(parse_case(plain + ORDERED), HEAVY))
    assert heavy.status == "fail"
    assert "no counter-hole that balances the cam fits" in heavy.note


def test_the_record_is_plain_numbers():
    record = balance(case_of().cam, SLIGHT).record()
    assert json.loads(json.dumps(record)) == record
    assert record["hole_drilled"] is False
    assert record["residual_unbalance_g_mm"] < 1e-6 < record["unbalance_g_mm"]


def test_the_workshop_drills_it(tmp_path):
    """In the drawing as a circle of its own layer, in the solid as steel left out."""
    case = case_of(ORDERED)
    write_workshop(tmp_path, case, SLIGHT)
    hole = drilled_hole(case.cam, SLIGHT)
    circles = ezdxf.readfile(tmp_path / "contour.dxf").query('CIRCLE[layer=="counter_hole"]')
    assert len(circles) == 1
    assert circles[0].dxf.radius == pytest.approx(1e3 * hole.radius, rel=1e-12)
    np.testing.assert_allclose(tuple(circles[0].dxf.center)[:2], 1e3 * hole.centre, rtol=1e-12)
    assert outline_of(case_of(), SLIGHT).counter_hole is None
    with session() as gmsh:
        gmsh.merge(str(tmp_path / "cam.step"))
        volume = gmsh.model.occ.getMass(3, gmsh.model.getEntities(3)[0][1])
        centre = gmsh.model.occ.getCenterOfMass(3, gmsh.model.getEntities(3)[0][1])
    drilled = balance(case.cam, SLIGHT)
    assert volume == pytest.approx(1e9 * drilled.left.area * case.cam.width, rel=1e-6)
    assert np.hypot(*centre[:2]) < 1e-4  # mm; before the hole it was a hundred times that
    assert drilled.unbalance.eccentricity > 1e-5


def test_the_contact_feels_the_hole():
    """Over its thin wall the cam bends and bears more shear; cycle and certificate say the same.

    Elsewhere it changes nothing. One mesh of the certificate: pressure to 0.1 %, shear to 2 %.
    """
    pair = contact_pair(machines(case_of(ORDERED))[0], HEAVY)
    theta = uniform_turn(3600)
    hole = pair.counter_hole
    thinnest = theta[np.argmin(np.hypot(*(HEAVY.points(theta) - hole.centre[:, None])))]
    at, force = np.array([thinnest, thinnest + 2.0]), np.full(2, 3000.0)
    without = replace(pair, counter_hole=None)
    drilled, whole = (
        two_scale_history(each, CycleBodies.meshed(each), at, force) for each in (pair, without)
    )
    change = drilled.tau_max / whole.tau_max - 1.0
    assert change[0] > 0.1
    assert abs(change[1]) < 5e-3
    full = solve_pair(pair, float(at[0]), 3000.0).solution
    assert full.p0 == pytest.approx(drilled.p0[0], rel=1e-3)
    assert full.tau_max == pytest.approx(drilled.tau_max[0], rel=0.02)


def test_the_mesh_leaves_the_hole_out():
    hole, sizing = balance(case_of().cam, HEAVY).hole, ElementSize(far_size=3e-3)
    holed, whole = (cam_mesh(HEAVY, 0.01, None, sizing, each) for each in (hole, None))
    assert mesh_area(whole) - mesh_area(holed) == pytest.approx(np.pi * hole.radius**2, rel=1e-4)
    assert "counter_hole" in holed.boundaries
    out = CounterHole(np.array([0.05, 0.0]), 0.05)
    with pytest.raises(GeometryError, match="wall of the counter-hole"):
        cam_mesh(HEAVY, 0.01, None, sizing, out)


@pytest.mark.parametrize(
    ("note", "drilled", "drawn"),
    [
        ("", False, True),
        ("no counter-hole fits", False, False),
        ("no counter-hole fits", True, True),
    ],
)
def test_a_hole_that_does_not_balance_the_cam_is_not_proposed(note, drilled, drawn):
    sizes = {"hole_x_mm": 20.0, "hole_y_mm": -37.0, "hole_diameter_mm": 56.0}
    balance = sizes | {"hole_note": note, "hole_drilled": drilled}
    turn = SimpleNamespace(balance=balance, walls=None)
    hole = SheetTurn.counter_hole.fget(turn)
    assert hole == ((20.0, -37.0, 28.0, drilled) if drawn else None)
