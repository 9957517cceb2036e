"""The arrangement of cam and follower: geometry, statics and labels of the drawing."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from camwright.geometry.arrays import rotation
from camwright.pipeline import run
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.machine_envelope import sizes_of
from camwright.reports import scene_solids
from camwright.reports.arrangement_data import arrangement_at, mechanism_of, motion_of
from camwright.reports.drawing import arrangement
from camwright.reports.drawing.drawing_shapes import Arrow, Text, bore_outline, hatching
from camwright.reports.drawing.drawing_svg import svg_of
from camwright.reports.drawing.spring_shapes import DrawnGasSpring, Torsion
from camwright.reports.figure_svg import COLOURS
from camwright.reports.report_data import read_material

ROOT = Path(__file__).parents[2]
CASES = {
    "roller": ROOT / "tests" / "data" / "every_part.toml",
    "face": ROOT / "cases" / "papers" / "petrescu_c.toml",
}
POSITIONS = 72


@pytest.fixture(scope="module", params=CASES)
def turn(request, tmp_path_factory):
    """The load case that a report draws, of a screened cam under a roller and under a face."""
    folder = tmp_path_factory.mktemp(request.param) / "run"
    run.run_case(
        read_case(CASES[request.param]), folder, positions=POSITIONS, jobs=1, depth=Tier.SCREENING
    )
    return read_material(folder).turn


def test_the_contact_lies_on_the_turned_contour(turn):
    mechanism, motion = mechanism_of(turn), motion_of(turn)
    touch = arrangement.contact_point(mechanism, motion)
    spacing = np.hypot(*np.diff(mechanism.contour, axis=1)).max()
    for theta, point in zip(motion.theta, touch.T, strict=True):
        surface = rotation(arrangement.cam_turn(theta)) @ mechanism.contour
        assert np.hypot(*(surface - point[:, None])).min() < 0.6 * spacing


def test_nothing_of_the_cam_reaches_into_the_follower(turn):
    mechanism, motion = mechanism_of(turn), motion_of(turn)
    for theta, lift in zip(motion.theta, motion.lift, strict=True):
        surface = rotation(arrangement.cam_turn(theta)) @ mechanism.contour
        height = mechanism.lowest + lift
        if mechanism.roller is None:
            assert surface[1].max() <= height + 1e-3
        else:
            centre = np.array([[mechanism.axis], [height]])
            assert np.hypot(*(surface - centre)).min() >= mechanism.roller - 1e-3


def test_the_drawn_forces_balance_on_point_supports(turn):
    """Side forces and their moment about guide A, from the arrows alone."""
    mechanism, columns = mechanism_of(turn), turn.columns
    by_name = {"guide-a": "guide_reaction_A_statics_N", "guide-b": "guide_reaction_B_statics_N"}
    forces = motion_of(turn).forces | {k: columns[v] for k, v in by_name.items()}
    motion = replace(motion_of(turn), forces=forces)
    scale = mechanism.arrow_length / motion.greatest_force
    a, b = (guide.middle for guide in mechanism.guides)
    for row in range(POSITIONS):
        drawn = {
            arrow.name: (np.subtract(arrow.tip, arrow.tail) / scale, np.array(arrow.tip))
            for arrow in arrangement.arrows(mechanism, motion, row)
        }
        push, at = drawn["contact"]
        side = push[0] if mechanism.roller else columns["side_force_N"][row]
        across = side + drawn["guide-a"][0][0] + drawn["guide-b"][0][0]
        along = push[1] if mechanism.roller else columns["axial_force_N"][row]
        couple = (at[0] - mechanism.axis) * along + (a - at[1]) * side
        couple -= (b - a) * drawn["guide-b"][0][0]
        if mechanism.roller:  # moments about the roller centre: its force acts there
            couple += mechanism.roller * (np.sin(motion.pressure_angle[row]) * along
                                          - np.cos(motion.pressure_angle[row]) * side)  # fmt: skip
        size = motion.greatest_force
        assert across == pytest.approx(0.0, abs=1e-9 * size)
        assert couple == pytest.approx(0.0, abs=1e-9 * size * (b - a))


@pytest.mark.parametrize("turn", ["roller"], indirect=True)
def test_the_spring_is_as_long_as_its_force_says(turn):
    mechanism, motion = mechanism_of(turn), motion_of(turn)
    free, wire = (turn.length("spring", "design", key) for key in ("free_length", "wire_diameter"))
    rate = turn.length("spring", "rate", unit="N/mm")
    for row in range(POSITIONS):
        pose = mechanism.spring.pose(mechanism.axis, motion.lift[row])
        length = pose.stretch + wire
        assert length == pytest.approx(free - motion.forces["spring"][row] / rate, rel=1e-9)
        assert pose.shift[1] + pose.stretch + 0.5 * wire == pytest.approx(mechanism.spring.top)


def test_no_label_overlaps_another_or_an_arrow(turn):
    mechanism, motion = mechanism_of(turn), motion_of(turn)
    for row in range(0, POSITIONS, 7):
        drawn = arrangement.drawing(mechanism, motion, row)
        boxes = [text.box for text in drawn.texts()]
        left, bottom, right, top = drawn.box
        for box in boxes:
            assert left <= box[0] and bottom <= box[1] and box[2] <= right and box[3] <= top
        for one, other in combinations(boxes, 2):
            assert not _overlap(one, other)
        for arrow in arrangement.arrows(mechanism, motion, row):
            ends = np.array([arrow.tail, arrow.tip])
            for box in boxes:
                assert not _overlap(box, (*ends.min(axis=0), *ends.max(axis=0)))


def _overlap(one, other):
    return all(one[k] < other[k + 2] and other[k] < one[k + 2] for k in (0, 1))


def test_the_record_of_a_page_is_the_drawing_at_every_row(turn):
    mechanism, motion = mechanism_of(turn), motion_of(turn)
    rows = range(0, POSITIONS, 9)
    record = arrangement.moving_record(mechanism, motion, rows)
    for place, row in enumerate(rows):
        drawn = arrangement.drawing(mechanism, motion, row)
        for group in drawn.groups:
            stored = record["poses"].get(group.name)
            if stored is not None:
                pose = group.pose
                expected = (np.degrees(pose.turn), *pose.shift, pose.stretch)
                assert stored[place] == pytest.approx(expected, abs=1e-3)
        texts = {text.name: text.words for text in drawn.texts() if text.name}
        assert texts == {name: words[place] for name, words in record["words"].items()}
    assert {"cam", "follower"} <= set(record["poses"])


def test_the_svg_is_well_formed_and_stands_at_the_worst_angle(turn):
    text = svg_of(arrangement_at(turn), COLOURS, 'DejaVu Sans, "x"')
    assert text == svg_of(arrangement_at(turn), COLOURS, 'DejaVu Sans, "x"')
    root = ET.fromstring(text)
    parts = {group.get("data-part") for group in root.iter() if group.get("data-part")}
    assert {"cam", "follower", "guides", "forces", "values"} <= parts
    worst = turn.columns["cam_angle_deg"][turn.worst]
    (turned,) = re.findall(
        r'data-part="cam"(?: transform="translate\(0 0\) rotate\(([-\d.]+)\)")?>', text
    )
    assert float(turned or 0.0) == pytest.approx(worst - 90.0, abs=1e-3)
    assert f"cam {worst:.1f}°" in text


def test_the_bore_with_its_keyway_encloses_both_areas():
    radius, width, depth = 8.5, 5.0, 2.3
    x, y = bore_outline(radius, (width, depth, 1.0))
    area = 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))
    cap = radius**2 * np.arcsin(0.5 * width / radius)
    cap -= 0.5 * width * np.sqrt(radius**2 - 0.25 * width**2)  # of the circle, below its chord
    slot = width * (radius + depth - np.sqrt(radius**2 - 0.25 * width**2)) - cap
    assert area == pytest.approx(np.pi * radius**2 + slot, rel=1e-3)


def test_hatching_stays_inside():
    box = (-3.0, 1.0, 2.0, 9.0)
    for line in hatching(box, 0.7):
        assert box[0] <= line[0].min() and line[0].max() <= box[2] + 1e-12
        assert box[1] <= line[1].min() and line[1].max() <= box[3] + 1e-12


def test_the_arm_of_a_torsion_spring_follows_its_pin():
    spring = Torsion(arm=40.0, arm_angle=-0.3, diameter=15.0, wire=2.0, seat=100.0)
    for lift in (0.0, 5.0, 11.0):
        tip = spring.pose(7.0, lift).of(np.array([[-40.0], [0.0]]))
        assert tip[1, 0] == pytest.approx(100.0 + lift)
    assert spring.pose(7.0, 0.0).of(np.array([[-40.0], [0.0]]))[0, 0] == pytest.approx(7.0)


def test_the_piston_of_a_gas_spring_stays_in_its_cylinder():
    spring = DrawnGasSpring.of(area=300.0, volume=6000.0, seat=50.0, stroke=10.0)
    for lift in (0.0, 10.0):
        body, rod = spring.groups(0.0, lift)[1]
        piston = rod.pose.of(rod.shapes[1].lines[0])[1]
        cylinder = body.shapes[1].lines[0][1]
        assert cylinder.min() <= piston.min() and piston.max() <= cylinder.max()


def test_an_arrow_shorter_than_its_head_is_hidden(turn):
    drawn = arrangement_at(turn)
    tiny = Arrow("contact", (0.0, 0.0), (0.0, 0.1), "blue", 1.0)
    group = replace(drawn.groups[0], shapes=(tiny, Text("<&>", (0.0, 0.0), 1.0)))
    text = svg_of(replace(drawn, groups=(group,)), COLOURS, "x")
    assert 'visibility="hidden"' in text and "&lt;&amp;&gt;" in text


def test_the_drawing_has_the_envelope_of_the_case(turn, request):
    """The sizes that a report reads from its run are those of the case that `design` states."""
    mechanism = mechanism_of(turn)
    case = read_case(CASES[request.node.callspec.params["turn"]])
    if case.spring.design is None:
        pytest.skip("a spring that is not described is drawn by its room")
    own = sizes_of(case, 1e-3 * mechanism.sizes.cam_radius, 1e-3 * mechanism.stroke).envelope
    np.testing.assert_allclose(np.array(own) * 1e3, np.array(mechanism.envelope), atol=1e-6)


def test_the_envelope_holds_all_that_is_drawn_at_every_angle(turn):
    """Outlines of cam, follower, guides and spring, turned and shifted; within 1 % by the wires."""
    mechanism, motion = mechanism_of(turn), motion_of(turn)
    (left, right), (low, high) = mechanism.envelope[:2]
    names = {"cam", "follower", "spring-behind", "spring-before"}
    room = 0.01 * mechanism.height
    for row in range(0, POSITIONS, 9):
        for group in arrangement.drawing(mechanism, motion, row).groups:
            if group.name not in names:
                continue
            points = [line for shape in group.shapes for line in getattr(shape, "lines", ())]
            assert points
            x, y = group.pose.of(np.concatenate(points, axis=1))
            assert left - room <= x.min() and x.max() <= right + room
            assert low - room <= y.min() and y.max() <= high + room


def test_the_spring_is_drawn_where_it_is_judged(turn):
    """Its seats clear the guides of the drawing as the check says."""
    mechanism = mechanism_of(turn)
    judged = {each["id"]: each for each in turn.checks}.get("spring_gap")
    if judged is None:
        pytest.skip("the case describes no spring")
    top = [guide.middle + 0.5 * guide.length for guide in mechanism.guides]
    below = [edge for edge in top if edge <= mechanism.spring.seat]
    gap = mechanism.spring.seat - mechanism.seat - max(below)
    assert gap == pytest.approx(judged["demand"], abs=1e-6)


def test_the_counterweight_is_drawn_by_the_body_that_is_judged(turn, request):
    """Opposite to the unbalance of the cam, which with its residual it has; its solid, too."""
    weight = {"residual": "20 g mm", "position": "20 mm"}
    shaft = turn.case.get("camshaft")
    if shaft is None:
        pytest.skip("the case describes no camshaft")
    case = dict(turn.case) | {"camshaft": dict(shaft) | {"counterweight": weight}}
    sector = mechanism_of(replace(turn, case=case)).counterweight
    made = turn.balance
    assert np.exp(1j * sector.angle) == pytest.approx(
        -np.exp(1j * np.radians(made["unbalance_angle_deg"])), abs=1e-9
    )
    own = read_case(CASES[request.node.callspec.params["turn"]])
    moment = (sector.outer**3 - sector.inner**3) / 3.0 * 2.0 * np.sin(sector.half)
    beside = sector.width - 1e3 * own.cam.width
    density = 1e-6 * own.camshaft.material.density
    assert density * moment * beside == pytest.approx(made["unbalance_g_mm"] + 20.0, rel=1e-6)
    angles = sector.angle + sector.half * np.linspace(-1.0, 1.0, 400)
    solid = scene_solids.sector(angles, (sector.inner, sector.outer), sector.width)
    corners = solid.points[:, solid.triangles]
    flat = np.ptp(corners[2], axis=0) == 0.0
    first, second = (corners[:2, k] - corners[:2, 0] for k in (1, 2))
    area = 0.5 * np.abs(first[0] * second[1] - first[1] * second[0])[flat].sum()
    exact = 2.0 * sector.half * (sector.outer**2 - sector.inner**2)  # of both ends
    assert area == pytest.approx(exact, rel=1e-4)
    assert np.ptp(solid.points[2]) == pytest.approx(sector.width)
