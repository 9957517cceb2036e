"""The animated drawing: well formed, without a display, at rest where that is preferred."""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture

from camwright.pipeline.base.tables import Table
from camwright.reports import motion_svg
from camwright.reports.report_data import ReportMaterial, read_material

SVG = "{http://www.w3.org/2000/svg}"
BYTES_MAX = 600_000
HOSTILE = "<script>alert(1)</script>\"'&"


@pytest.fixture(scope="module")
def material(tmp_path_factory: pytest.TempPathFactory) -> ReportMaterial:
    folder = tmp_path_factory.mktemp("motion") / "run"
    report_fixture.write_run(folder, title=HOSTILE, field=False)
    return read_material(folder)


@pytest.fixture(scope="module")
def drawn(material: ReportMaterial) -> ET.Element:
    return ET.fromstring(motion_svg.text(material))


def parts(drawn: ET.Element, name: str) -> ET.Element:
    return next(each for each in drawn.iter(f"{SVG}g") if each.get("class") == name)


def test_it_is_small_well_formed_and_the_same_again(material: ReportMaterial) -> None:
    text = motion_svg.text(material)
    assert len(text) <= BYTES_MAX
    assert text == motion_svg.text(material)
    assert not re.search(r"(?:href|src)=", text)
    assert text.count("<script>") == 1 and "alert" in text  # the title, escaped


def test_every_motion_lasts_a_turn_and_ends_where_it_began(drawn: ET.Element) -> None:
    motions = [each for each in drawn.iter() if each.tag.startswith(f"{SVG}animate")]
    assert len(motions) >= 20
    for each in motions:
        assert each.get("dur") == f"{motion_svg.TURN_S:g}s"
        assert each.get("repeatCount") == "indefinite"
        values = str(each.get("values")).split(";")
        if each.get("type") == "rotate":
            turned = float(values[-1]) - float(values[0])
            assert abs(turned) == pytest.approx(360.0)
        elif len(values) > 2:
            assert values[0] == values[-1]
            assert len(values) == motion_svg.FRAMES + 1


def test_the_follower_moves_by_the_lift(drawn: ET.Element, material: ReportMaterial) -> None:
    moving = parts(drawn, "moving")
    group = next(each for each in moving.iter() if each.get("data-part") == "follower")
    values = str(group.find(f"{SVG}animateTransform").get("values")).split(";")  # type: ignore[union-attr]
    heights = np.array([-float(each.split()[1]) for each in values])
    lift = material.turn.columns["lift_mm"]
    assert np.ptp(heights) == pytest.approx(np.ptp(lift), rel=0.01)


def test_what_prefers_reduced_motion_rests(drawn: ET.Element) -> None:
    style = str(drawn.find(f"{SVG}style").text)  # type: ignore[union-attr]
    assert "prefers-reduced-motion:reduce" in style and ".moving{display:none}" in style
    still = parts(drawn, "still")
    assert not [each for each in still.iter() if each.tag.startswith(f"{SVG}animate")]
    button = next(each for each in drawn.iter() if each.get("role") == "button")
    assert button.get("tabindex") == "0" and button.get("aria-label")


def test_it_has_a_name_and_a_text_alternative(drawn: ET.Element) -> None:
    ids = str(drawn.get("aria-labelledby")).split()
    texts = {each.get("id"): each.text for each in drawn.iter()}
    assert all(texts[each] for each in ids)
    assert HOSTILE in str(texts[ids[0]])
    named = [each.get("id") for each in drawn.iter() if each.get("id")]
    assert len(named) == len(set(named))


def test_both_panels_have_their_curves(drawn: ET.Element) -> None:
    words = "\n".join(str(each.text) for each in drawn.iter(f"{SVG}text"))
    assert "Force, N" in words and "Contact pressure, MPa" in words
    assert "contact, at most" in words and "spring, at most" in words


def test_the_curves_have_a_value_an_angle_of_the_turn(material: ReportMaterial) -> None:
    """The same cursor runs over all of them."""
    turn = material.turn
    sizes = {curve.values.size for panel in motion_svg._panels(turn) for curve in panel.curves}
    assert sizes == {turn.crank.size}


def test_what_is_not_known_at_every_angle_is_left_out(material: ReportMaterial) -> None:
    """Of a follower that may leave the cam: a path of NaN is drawn up to the first of them."""
    turn = material.turn
    lost = np.array(turn.columns["normal_force_N"])
    lost[3] = np.nan
    names = ("normal_force_N", "p0_hertz_MPa", "p0_fe_MPa")
    columns = Table({**turn.columns.numbers, **dict.fromkeys(names, lost)}, turn.columns.rows_of)
    leaving = replace(turn, columns=columns)
    panels = motion_svg._panels(leaving)
    assert [[curve.label for curve in panel.curves] for panel in panels] == [["spring"]]


def test_a_panel_of_zeros_has_a_span() -> None:
    zeros = motion_svg._MotionCurve("force", np.zeros(8), "blue")
    panel = motion_svg._MotionPanel("Force", "N", [zeros], np.nan)
    assert panel.span == (0.0, 1.0)
    assert panel.ticks == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
