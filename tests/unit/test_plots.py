"""Figures: closed curves, limits in view or in words, SVG that a page can take in."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from dataclasses import fields, replace
from typing import get_args

import matplotlib.pyplot as plt
import numpy as np
import pytest

from camwright.geometry.figures import (
    AxisMark,
    Curve,
    Figure,
    HorizontalAxis,
    LimitLine,
    Look,
    Panel,
    outline_panel,
    over,
    over_turn,
    plotted,
)
from camwright.reports import figure_svg
from camwright.reports.analysis_sheet import broken
from camwright.reports.figure_layout import WORDS_HEIGHT, placed_limits, vertical_span
from camwright.reports.interactive import specification
from camwright.reports.machine_words import words_of
from camwright.reports.outline_figures import OutlineFigure

CRANK = np.arange(0.0, 720.0, 10.0)
WAVE = np.sin(np.radians(CRANK))


def figure(*panels, **more):
    panels = panels or (Panel("torque", "N m", (Curve(CRANK, WAVE, "engine"),)),)
    return over_turn("wave", "A wave", "", panels, **more)


def drawn(made):
    with figure_svg.style("test"):
        return figure_svg.draw(made)


def words(canvas):
    return [text.get_text() for ax in canvas.axes for text in ax.texts]


def test_a_curve_closes_at_the_end_of_the_turn():
    line = drawn(figure()).axes[0].get_lines()[0]
    assert line.get_xdata()[-1] == 720.0
    assert line.get_ydata()[-1] == line.get_ydata()[0]
    assert line.get_xdata().size == CRANK.size + 1


def test_both_axes_are_named_and_agree():
    ax = drawn(figure()).axes[0]
    cam = next(c for c in ax.child_axes)
    assert ax.get_xlabel() == "crank angle, deg"
    assert cam.get_xlabel() == "cam angle, deg"
    assert cam.get_xticks()[-1] == 360.0
    assert ax.get_xlim() == (0.0, 720.0)


def test_a_drive_of_another_ratio_gets_its_own_crank_axis():
    ax = drawn(figure(ratio=1.0)).axes[0]
    assert ax.get_xlim() == (0.0, 360.0)
    assert words_of({}, 1.0).marks == ()


def test_a_machine_has_its_own_words() -> None:
    """No crank and no stroke in the picture of a press; its marks stand in every lobe."""
    forming = {"angle": "150 deg", "name": "forming"}
    press = {"torque": {"kind": "press", "marks": [{"angle": "0 deg", "name": "down"}, forming]}}
    machine = words_of(press, 2.0)
    made = figure(marks=machine.marks, shaft=machine.shaft)
    canvas = drawn(made)
    assert words(canvas)[:4] == ["down", "forming", "down", "forming"]
    assert canvas.axes[0].get_xlabel() == "shaft angle, deg"
    assert [(mark.start, mark.end) for mark in machine.marks] == [
        (0.0, 150.0), (150.0, 360.0), (360.0, 510.0), (510.0, 720.0),
    ]  # fmt: skip
    assert "crank" not in made.alt + str(specification(made)) + machine.alone
    assert words_of({"torque": {"kind": "pump"}}, 1.0).marks == ()
    assert words_of({"torque": {"marks": [{"angle": "1 mm", "name": "x"}]}}, 1.0).marks == ()


def test_strokes_are_named_in_order():
    assert words(drawn(figure(marks=words_of({}, 2.0).marks)))[:4] == [
        "intake",
        "compression",
        "expansion",
        "exhaust",
    ]


def test_a_near_limit_is_in_view_and_a_far_one_in_words():
    near = Panel("p0", "MPa", (Curve(CRANK, WAVE),), (LimitLine(1.5, "limit"),))
    far = Panel("p0", "MPa", (Curve(CRANK, WAVE),), (LimitLine(50.0, "limit"),))
    below = Panel("p0", "MPa", (Curve(CRANK, WAVE),), (LimitLine(-50.0, "limit"),))
    assert drawn(figure(near)).axes[0].get_ylim()[1] > 1.5
    assert "limit 1.5 MPa" in words(drawn(figure(near)))
    assert drawn(figure(far)).axes[0].get_ylim()[1] < 2.0
    assert "limit 50 MPa (above this axis)" in words(drawn(figure(far)))
    assert "limit −50 MPa (below this axis)" in words(drawn(figure(below)))


@pytest.mark.parametrize("far", [False, True])
def test_a_label_is_clear_of_the_words_at_the_lower_edge(far):
    near = LimitLine(-18.5, "limit")
    limits = (near, LimitLine(-50.0, "far")) if far else (near,)
    placed = placed_limits(Panel("x", "mm", (Curve(CRANK, WAVE),), limits), -20.0, -10.0)
    assert placed.inside == ((near, far),)


@pytest.mark.parametrize(
    "values", [np.zeros(72), np.full(72, 7.0), np.full(72, np.nan), -(WAVE**2)]
)
def test_flat_and_empty_curves_are_drawn_too(values):
    low, high = drawn(figure(Panel("x", "mm", (Curve(CRANK, values),)))).axes[0].get_ylim()
    assert np.isfinite([low, high]).all()
    assert low < high


def test_a_pole_draws_no_line():
    values = broken(np.array([10.0, 200.0, -400.0, -20.0]), 150.0)
    np.testing.assert_array_equal(np.isnan(values), [False, True, True, False])


def test_the_alternative_text_tells_range_place_and_limit():
    made = figure(
        Panel("angle", "deg", (Curve(CRANK, WAVE * 40, "flank"),), (LimitLine(30.0, "limit"),))
    )
    assert "angle, flank: -40 to 40 deg" in made.alt
    assert "largest magnitude at 90 deg crank angle" in made.alt
    assert "limit limit 30 deg" in made.alt


def test_the_svg_is_well_formed_themed_and_free_of_clashing_ids():
    svg, other = (
        figure_svg.themed(figure_svg.svg_of(made), made.id)
        for made in (figure(), replace(figure(), id="second", title=""))
    )
    ET.fromstring(svg)
    assert 'role="img"' in svg
    assert "var(--blue)" in svg
    assert not set(figure_svg.COLOURS.values()) & set(re.findall(r"#[0-9a-f]{6}\b", svg))
    assert "crank angle, deg" in svg
    ids = [re.findall(r'\bid="([^"]+)"', text) for text in (svg, other)]
    assert not set(ids[0]) & set(ids[1])
    assert len(ids[0]) == len(set(ids[0]))
    used = set(re.findall(r'(?:url\(#|href="#)([^")]+)', svg))
    assert used <= set(ids[0])


def test_the_axis_holds_the_ribbon_of_all_load_cases():
    curve = Curve(CRANK, WAVE, "a", lower=WAVE - 2.0, upper=WAVE + 3.0)
    low, high = vertical_span(Panel("p", "N", (curve,)), named=True)
    assert low < WAVE.min() - 2.0 and high > WAVE.max() + 3.0


def test_words_of_near_limits_stand_clear_of_each_other():
    lines = tuple(LimitLine(value, "limit") for value in (30.0, -30.0, 45.0, -45.0))
    placed = placed_limits(Panel("angle", "deg", (), lines), -50.0, 60.0)
    bottoms = sorted(
        (line.value + 50.0) / 110.0 - (0.0 if above else WORDS_HEIGHT)
        for line, above in placed.inside
    )
    assert len(bottoms) == 4 and placed.beyond == ()
    assert min(np.diff(bottoms)) >= WORDS_HEIGHT - 1e-9
    far = placed_limits(Panel("angle", "deg", (), lines), -40.0, 40.0)
    assert far.beyond == (
        ("limit 45 deg (above this axis)", True),
        ("limit \N{MINUS SIGN}45 deg (below this axis)", False),
    )


def test_trimming_coordinates_leaves_numbers_to_read_alone():
    small = Panel(
        "depth", "mm", (Curve(CRANK, 0.004 + 0.004 * WAVE),), (LimitLine(0.0075, "limit"),)
    )
    svg = figure_svg.themed(figure_svg.svg_of(figure(small)), "small")
    assert re.search(r">0\.00\d+<", svg)
    assert "limit 0.0075 mm" in svg
    assert not re.search(r'"[^"<>]*\d\.\d{3}', svg)


def test_the_same_figure_gives_the_same_bytes():
    png = figure_svg.png_of(figure())
    assert figure_svg.svg_of(figure()) == figure_svg.svg_of(figure())
    assert png == figure_svg.png_of(figure())
    assert png.startswith(b"\x89PNG")


def test_hostile_labels_stay_text():
    panel = Panel("x", "", (Curve(CRANK, WAVE, "<script>$x_2$"), Curve(CRANK, WAVE, "b")))
    svg = figure_svg.svg_of(figure(panel))
    assert "<script" not in svg
    assert "&lt;script&gt;$x_2$" in svg


def test_the_outline_has_equal_axes_and_holds_the_follower():
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.array([np.cos(angle), np.sin(angle)])
    roller = np.array([[0.0], [50.0]]) + 8 * ring
    made = OutlineFigure(
        "outline", "Cam", "", 42 * ring, 50 * ring, roller, "roller", 10.0, (4.0, 2.0, 0.3), 15,
        "at 90 deg",
    )  # fmt: skip
    ax = drawn(made).axes[0]
    assert ax.get_aspect() == 1.0
    assert ax.get_xlim()[1] > 58.0
    assert "between 42 and 42 mm" in made.alt
    assert "pitch curve, bore and the roller at 90 deg" in made.alt
    face = OutlineFigure(
        "o", "", "", 42 * ring, None, np.array([[-9.0, 9.0], [42.0, 42.0]]), "face", None, None, 15,
        "at 90 deg",
    )  # fmt: skip
    labels = [text.get_text() for text in drawn(face).axes[0].get_legend().get_texts()]
    assert labels == ["cam contour", "face at 90 deg"]
    for drilled, line in ((True, "-"), (False, "--")):  # a hole as its own circle
        holed = drawn(replace(made, counter_hole=(20.0, 5.0, 3.0, drilled))).axes[0]
        (circle,) = [c for c in holed.lines if len(c.get_xdata()) == 121 and c not in ax.lines
                     and abs(np.mean(c.get_xdata()[:-1]) - 20.0) < 1e-9]  # fmt: skip
        assert circle.get_linestyle() == line
        assert np.ptp(circle.get_ydata()) == pytest.approx(6.0, rel=1e-3)
    assert figure_svg.svg_of(
        OutlineFigure("o", "", "", 42 * ring, 50 * ring, None, "roller", None, None, 0, "")
    )


def live_curves(made):
    """Points and label of what Plotly draws of a figure, but for the trace of the upper axis."""
    spec = specification(made)
    return [(t.get("x", spec.get("x")), t["y"], t["name"]) for t in spec["data"] if "name" in t]


def test_both_renderers_draw_the_same_curves():
    panels = (
        Panel(
            "force", "N", (Curve(CRANK, WAVE, "a"), Curve(CRANK, 2 * WAVE, "b", "green", "dashed"))
        ),
        Panel("share", "", (Curve(CRANK, WAVE**2),), (LimitLine(0.5, "limit"),)),
    )
    made = figure(*panels, worst=1000.0)
    axes = drawn(made).axes
    still = [line for ax in axes for line in ax.lines if len(line.get_xdata()) > 2]
    live = live_curves(made)
    assert len(still) == len(live) == 3
    for line, (x, y, name) in zip(still, live, strict=True):
        np.testing.assert_allclose(line.get_xdata(), x, rtol=1e-5)
        np.testing.assert_allclose(line.get_ydata(), y, rtol=1e-5, atol=1e-9)
        assert line.get_label() == name or line.get_label().startswith("_")
    layout = specification(made)["layout"]
    assert [layout["yaxis"]["title"]["text"], layout["yaxis2"]["title"]["text"]] == [
        ax.get_ylabel() for ax in axes
    ]
    assert layout["yaxis2"]["range"] == pytest.approx(axes[1].get_ylim())
    assert {note["text"] for note in layout["annotations"]} == {*words(drawn(made))}
    dotted = [shape["x0"] for shape in layout["shapes"] if shape["line"].get("dash") == "dot"]
    assert dotted == [280.0]  # 1000 deg of crank, within the turn of 720


PANEL = Panel(
    "force", "N", (Curve(np.arange(3.0), np.array([1.0, 3.0, 2.0]), "a"),), (LimitLine(2.5, "x"),)
)
OTHER = {
    "quantity": "torque",
    "unit": "kN",
    "curves": (Curve(np.arange(3.0), np.array([1.0, 3.0, 2.5]), "a"),),
    "limits": (LimitLine(2.6, "x"),),
    "height": 2.0,
    "span": (-1.0, 9.0),
    "from_zero": True,
    "kind": "outline",
    "title": "rise",
    "note": "of a harmonic law",
    "axis": HorizontalAxis("lift", "mm", (0.0, 4.0)),
}


@pytest.mark.parametrize("field", [each.name for each in fields(Panel)])
def test_both_renderers_draw_every_field_of_a_panel(field):
    """A figure with another value is another drawing, in the page and in its data."""
    steep = replace(PANEL, curves=(replace(PANEL.curves[0], y=np.array([2.0, 3.0, 2.5])),))
    panel = steep if field == "from_zero" else PANEL  # a curve whose axis leaves out zero
    drawings = []
    for each in (panel, replace(panel, **{field: OTHER[field]})):
        made = Figure("one", "", "", (each, PANEL), HorizontalAxis("time", "s", (0.0, 2.0)))
        drawings.append((figure_svg.svg_of(made), specification(made)))
    (svg, spec), (other_svg, other_spec) = drawings
    assert svg != other_svg
    assert spec != other_spec


@pytest.mark.parametrize("look", get_args(Look))
def test_every_look_is_drawn_by_all(look):
    """And tells a line from another: no two looks give the same drawing."""
    ends = {"lower": np.array([0.0, 1.0, 1.0]), "upper": np.array([2.0, 4.0, 3.0])}
    curve = replace(PANEL.curves[0], look=look, **(ends if look in ("bar", "band") else {}))
    made = over("one", "One", "", "time", "s", [replace(PANEL, curves=(curve,))], dots=False)
    plain = over("one", "One", "", "time", "s", [PANEL], dots=False)
    assert (figure_svg.svg_of(made) == figure_svg.svg_of(plain)) == (look == "line")
    assert (specification(made) == specification(plain)) == (look == "line")
    assert plotted(made)[0].has_data()
    plt.close("all")


def test_horizontal_bars_have_names_ends_and_limits_in_all_drawings():
    rows = ("first", "second")
    curves = (
        Curve(np.array([1.0, 2.0]), np.array([0.0, 1.0]), "base", look="bar", notes=rows),
        Curve(np.array([3.0]), np.array([1.0]), "top", "green", "bar", lower=np.array([2.0])),
    )  # fmt: skip
    panel = Panel("", "", curves, (LimitLine(1.5, "most"),), kind="bars")
    made = Figure("bars", "Bars", "", (panel,), HorizontalAxis("energy", "J", (0.0, 4.0)))
    for ax in (drawn(made).axes[0], plotted(made)[0]):
        assert [text.get_text() for text in ax.get_yticklabels()] == list(rows)
        assert ax.get_ylim()[0] > ax.get_ylim()[1]  # the first at the top
        assert {"1", "3"} <= {text.get_text().strip() for text in ax.texts}
        assert [(bar.get_x(), bar.get_width()) for bar in ax.patches] == [
            (0.0, 1.0), (0.0, 2.0), (2.0, 1.0),
        ]  # fmt: skip
    plt.close("all")
    spec = specification(made)
    assert spec["layout"]["yaxis"]["ticktext"] == list(rows)
    assert [trace["base"] for trace in spec["data"]] == [[0.0, 0.0], [2.0]]
    assert "most 1.5 J" in {note["text"] for note in spec["layout"]["annotations"]}
    assert made.alt == (
        "Bars by energy. energy, base: 1 to 2 J. energy, top: 3 to 3 J. limit most 1.5 J."
    )


def test_panels_stand_in_columns_with_axes_of_their_own():
    ring = np.linspace(0.0, 2.0 * np.pi, 61)
    disc = outline_panel((Curve(30.0 * np.cos(ring), 20.0 * np.sin(ring), "disc", look="fill"),))
    lines = replace(
        PANEL,
        title="Rise",
        axis=HorizontalAxis("time", "s", (0.0, 2.0), marks=(AxisMark(1.0, "t"),)),
    )
    made = Figure(
        "pair", "Pair", "", (lines, disc, PANEL), HorizontalAxis("lift", "mm", (0.0, 2.0)), 2
    )
    canvas = drawn(made)
    left, right, below = (ax.get_position() for ax in canvas.axes)
    assert left.x1 < right.x0
    assert right.y0 + right.y1 == pytest.approx(left.y0 + left.y1)
    assert below.y1 < left.y0
    assert [ax.get_xlabel() for ax in canvas.axes] == ["time, s", "x, mm", "lift, mm"]
    assert canvas.axes[1].get_aspect() == 1.0
    assert {"Rise", "t"} <= {text.get_text() for text in canvas.axes[0].texts}
    assert "y, disc: -20 to 20 mm" in made.alt


def test_a_ribbon_ends_in_the_range_of_its_text_alternative():
    curve = replace(PANEL.curves[0], look="band", upper=np.array([5.0, 6.0, 7.0]))
    made = over("band", "Band", "", "time", "s", [replace(PANEL, curves=(curve,), limits=())])
    assert made.alt == "Band by time. force, a: 1 to 7 N."


def test_both_renderers_draw_the_same_outline():
    angle = np.linspace(0, 2 * np.pi, 60, endpoint=False)
    ring = np.array([np.cos(angle), np.sin(angle)])
    made = OutlineFigure(
        "outline", "Cam", "", 42 * ring, 50 * ring, np.array([[0.0], [50.0]]) + 8 * ring, "roller",
        10.0, (4.0, 2.0, 0.3), 15, "at 90 deg", (20.0, 5.0, 3.0, False),
    )  # fmt: skip
    ax = drawn(made).axes[0]
    live = live_curves(made)
    assert len(ax.lines) == len(live)
    for line, (x, y, name) in zip(ax.lines, live, strict=True):
        np.testing.assert_allclose(line.get_xdata(), x, rtol=1e-5, atol=1e-9)
        np.testing.assert_allclose(line.get_ydata(), y, rtol=1e-5, atol=1e-9)
        assert line.get_label() == name or name == ""
    layout = specification(made)["layout"]
    assert layout["xaxis"]["title"]["text"] == ax.get_xlabel()
    assert layout["xaxis"]["range"] == pytest.approx(ax.get_xlim())
    notes = [(note["text"], note["x"], note["y"]) for note in layout["annotations"]]
    assert notes == [(text.get_text(), *text.xy) for text in ax.texts]


PLACES = np.array([1.0, 2.0])


def sweep(**more):
    panels = (
        Panel("ripple", "N m", (Curve(PLACES, np.array([1.0, 2.0]), "low"),
                                Curve(PLACES, np.array([3.0, 5.0]), "high", "green"))),
        Panel("use", "", (Curve(PLACES, np.array([1.2, 0.9]), notes=("jump", "travel")),),
              (LimitLine(1.0, "limit"),)),
    )  # fmt: skip
    return over("sweep", "Sweep", "", "speed", "rpm", panels, **more)


def test_points_of_a_sweep_are_named_on_axes_of_its_quantity():
    """In the drawing, its data for the page, and its text alternative."""
    top, bottom = drawn(sweep(counted=True)).axes
    assert bottom.get_xlabel() == "speed, rpm"
    assert bottom.get_xlim() == (0.5, 2.5)
    assert [text.get_text() for text in top.get_legend().get_texts()] == ["low", "high"]
    assert bottom.get_legend() is None
    assert {"jump", "travel", "limit 1"} <= {text.get_text() for text in bottom.texts}
    made = specification(sweep(counted=True))
    assert [trace["y"] for trace in made["data"]] == [[1.0, 2.0], [3.0, 5.0], [1.2, 0.9]]
    assert made["at"] == {"name": "speed", "unit": "rpm"}
    notes = [note["text"] for note in made["layout"]["annotations"]]
    assert notes == ["limit 1", "jump", "travel"]
    assert "use: 1.2 at 1 (jump), 0.9 at 2 (travel)" in sweep(counted=True).alt
    assert "ripple, high: 3 to 5 N m" in sweep().alt
    assert sweep().axis.span == pytest.approx((0.97, 2.03))


def test_a_point_without_a_value_has_no_name():
    use = Curve(PLACES, np.array([np.nan, 0.9]), notes=("jump", "travel"))
    made = over("x", "X", "", "trial", "", (Panel("use", "", (use,)),), counted=True)
    assert "jump" not in words(drawn(made))
    assert "jump" not in made.alt
    assert "travel" in words(drawn(made))
    (note,) = specification(made)["layout"]["annotations"]
    assert note["text"] == "travel"
