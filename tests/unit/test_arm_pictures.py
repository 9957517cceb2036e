"""Pictures of what an arm carries: second arm with its output, linked spring, their notes."""

from __future__ import annotations

import numpy as np
import pytest
from test_oscillating_case import text
from test_spring_link import linked_text

from camwright.geometry.rocker_lift import RockerArm, RockerLinkage
from camwright.pipeline import run
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.results.workshop_files import notes_of
from camwright.reports import scene_arm
from camwright.reports.arrangement_data import mechanism_of, motion_of
from camwright.reports.drawing import arrangement
from camwright.reports.drawing.arm_parts import ArmSpring, LinkCoil, LinkGas, SecondArm
from camwright.reports.drawing.arrangement import DrawnArm
from camwright.reports.report_data import read_material
from camwright.reports.scene_solids import helix

LIFTS = (0.0, 0.1, 4.0, 10.0)
ROCKER = """[rocker]
length = "60 mm"
angle = "-5 deg"
side = "opposite"
lash = "0.15 mm"

[lubricant]"""


def arm(sense, **parts):
    return DrawnArm(110.0, 100.0, sense, 0.6, 8.0, **parts)


def about_pivot(sense, radius, angle):
    """Point x + i y, mm: the arm hangs down from the pivot, turned by its start and outwards."""
    return 110.0j - 1j * radius * np.exp(-1j * sense * (0.6 + angle))


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_spring_is_drawn_between_its_ends(sense):
    """The end on the arm swings with it, the other stands; coils and pins reach from end to end."""
    spring = ArmSpring(LinkCoil(3.0, 20.0, 6.0, "eyes"), (70.0, 0.2), (120.0, -0.8))
    drawn = arm(sense, spring=spring)
    for lift in LIFTS:
        moving, fixed = drawn.spring_ends(lift)
        wanted = (about_pivot(sense, 70.0, 0.2 + lift / 100.0), about_pivot(sense, 120.0, -0.8))
        np.testing.assert_allclose([complex(*moving), complex(*fixed)], wanted, rtol=1e-12)
        groups = {each.name: each.pose for each in spring.shape.groups(moving, fixed)}
        coil = groups["link-before"].of(np.array([[0.0, 0.0], [0.0, 1.0]]))
        away = abs(wanted[1] - wanted[0])
        reached = 12.0 / away * (fixed - moving)  # an eye of 0.6 diameters
        np.testing.assert_allclose(coil[:, 0], moving + reached, atol=1e-9)
        np.testing.assert_allclose(coil[:, 1], fixed - reached, atol=1e-9)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_pad_of_the_second_arm_lies_on_the_output(sense, side):
    """The gap is the lash at zero lift and closes with it; the output moves square to its end."""
    linkage = RockerLinkage(RockerArm(100.0), RockerArm(60.0, -0.2), 0.15)
    second = SecondArm(60.0, side, -0.2, 5.0, 40.0, linkage)
    drawn = arm(sense, second=second)
    line = drawn.placed(second.end + second.line) - drawn.placed(second.end)
    at_zero = drawn.placed(second.end)
    for lift in LIFTS:
        pad = drawn.placed(second.end, lift)
        end = about_pivot(sense, side * 60.0, lift / 100.0)
        np.testing.assert_allclose(complex(*pad), end, rtol=1e-12)
        travel = 60.0 * (np.sin(lift / 100.0 - 0.2) - np.sin(-0.2))
        assert (pad - at_zero) @ line == pytest.approx(travel, abs=1e-9)
        gap = (drawn.placed(second.flat(lift)) - pad) @ line - 5.0
        assert gap == pytest.approx(max(0.15 - travel, 0.0), abs=1e-9)


def test_the_piston_of_a_linked_gas_spring_stays_in_its_cylinder():
    shape = LinkGas(16.0, 60.0, 46.0)
    for length in (100.0, 85.0):
        body, rod = shape.groups(np.zeros(2), np.array([length, 0.0]))
        piston = rod.pose.of(rod.shapes[1].lines[0])
        cylinder = body.pose.of(body.shapes[1].lines[0])
        assert cylinder[0].min() - 1e-9 <= piston[0].min()
        assert piston[0].max() <= cylinder[0].max()


def test_a_wound_wire_has_its_length_and_diameter():
    wound = helix(20.0, 3.0, 5.0, 70.0)
    corners = wound.points[:, wound.triangles]
    sides = np.cross(*(corners[:, k].T - corners[:, 0].T for k in (1, 2)))
    area = 0.5 * np.hypot(np.hypot(*sides.T[:2]), sides.T[2]).sum()
    exact = np.pi * 3.0 * np.hypot(5.0 * np.pi * 20.0, 70.0)
    assert area == pytest.approx(exact, rel=0.05)  # eight sides, upright sections
    assert np.hypot(*wound.points[[0, 2]]).max() == pytest.approx(11.5)
    assert wound.points[1].min() == pytest.approx(-1.5) and wound.points[1].max() < 71.6


@pytest.fixture(scope="module")
def turn(tmp_path_factory):
    """Screened cam on an arm with a linked spring and a rocker."""
    folder = tmp_path_factory.mktemp("arm") / "run"
    case = parse_case(linked_text().replace("[lubricant]", ROCKER, 1))
    run.run_case(case, folder, positions=36, jobs=1, depth=Tier.SCREENING)
    return read_material(folder).turn


def test_drawing_and_scene_show_rocker_and_spring_of_a_run(turn):
    mechanism, motion = mechanism_of(turn), motion_of(turn)
    (left, right), (low, high) = mechanism.envelope[:2]
    names = {"output", "second-arm", "link-ground", "link-before", "link-end", "link-anchor"}
    lifts = motion.lift[::9]
    solids = scene_arm.moving(mechanism, lifts, 15.0, 9)
    assert len(solids) == 5
    for place, row in enumerate(range(0, motion.lift.size, 9)):
        whole = arrangement.drawing(mechanism, motion, row)
        assert "second arm with its output, spring in the plane" in whole.alt
        groups = {group.name: group for group in whole.groups}
        assert names <= set(groups)
        for name in names - {"link-ground"}:
            lines = [line for each in groups[name].shapes for line in each.lines]
            x, y = groups[name].pose.of(np.concatenate(lines, axis=1))
            room = 0.02 * mechanism.height
            assert left - room <= x.min() and x.max() <= right + room
            assert low - room <= y.min() and y.max() <= high + room
        pose = groups["second-arm"].pose
        assert solids[0]["turn"][place] == pytest.approx(pose.turn, abs=1e-8)
    moving, fixed = mechanism.arm.spring_ends(0.0)
    ends = 85.0 * np.exp(1j * np.radians(5.0)) - 120.0 * np.exp(1j * np.radians(60.0))
    assert np.hypot(*(moving - fixed)) == pytest.approx(abs(ends), rel=1e-12)


def test_the_drawing_of_the_cam_notes_rocker_and_spring():
    notes = "\n".join(notes_of(parse_case(linked_text().replace("[lubricant]", ROCKER, 1))))
    assert "rocker of second arm 60 mm, at zero lift -5 deg from square" in notes
    assert "beyond the pivot, lash 0.15 mm" in notes
    assert "spring that pushes between the arm, 85 mm from the pivot at 5 deg, and" in notes
    assert "120 mm from the pivot at 60 deg from the arm" in notes
    plain = parse_case(text().replace("[lubricant]", "[rocker]\nratio = 0.7\n\n[lubricant]", 1))
    assert any("rocker of constant ratio 0.7" in each for each in notes_of(plain))
