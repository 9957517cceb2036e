"""Figures of the sheet: spectrum, energy flow, load cases, speed sweep, limits beside means."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture

from camwright.geometry.figures import Curve, Figure, LimitLine, Panel, over
from camwright.pipeline.base.tables import Table
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import fatigue_record
from camwright.reports import figure_svg, interactive
from camwright.reports.analysis_sheet import groups
from camwright.reports.report_data import governing_turn, read_material
from camwright.reports.sheet_turn import angle_figure

ROWS = 72


@pytest.fixture(scope="module")
def turn(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sheet") / "run"
    report_fixture.write_run(folder, positions=ROWS, field=False)
    return read_material(folder).turn


def with_columns(turn, **more):
    """The turn with other columns in its load case."""
    table = Table(
        MappingProxyType({**turn.columns.columns, **more}), turn.columns.rows_of
    )  # fmt: skip
    return replace(turn, columns=table, others=(table,))


def figure_of(turn, name):
    (made,) = [each for _, figures in groups(turn) for each in figures if each.id == name]
    return made


def test_a_pure_harmonic_is_one_bar_of_its_amplitude(turn):
    wave = 5.0 * np.cos(3.0 * turn.columns["cam_angle_deg"] * np.pi / 180.0 + 0.4)
    made = figure_of(with_columns(turn, torque_before_Nm=wave + 2.0), "torque-spectrum")
    amplitude = made.panels[0].curves[0].y
    order = np.argmax(amplitude)
    assert amplitude[order] == pytest.approx(5.0)
    assert made.panels[0].curves[0].x[order] == pytest.approx(3.0 / turn.gear_ratio)
    assert np.delete(amplitude, order) == pytest.approx(0.0, abs=1e-12)


def test_the_pivot_of_an_arm_has_load_pressure_and_friction(turn):
    """Mean pressure by hand: 600 N over 20 mm by 25 mm is 1.2 MPa; no figure without a pivot."""
    assert not [each for _, made in groups(turn) for each in made if each.id == "pivot"]
    load = 600.0 + 0.0 * turn.columns["cam_angle_deg"]
    bush = {"bush": {"diameter": "20 mm", "length": "25 mm"}}
    follower = turn.case["follower"] | {"arm": {}, "pivot": bush}
    turned = replace(turn, case=turn.case | {"follower": follower})
    columns = {"pivot_load_N": load, "pivot_edge_pressure_MPa": 0.05 * load,
               "pivot_friction_N": 0.01 * load}  # fmt: skip
    made = figure_of(with_columns(turned, **columns), "pivot")
    assert [panel.quantity for panel in made.panels] == ["load", "pressure", "friction"]
    edge, mean = made.panels[1].curves
    assert edge.y == pytest.approx(30.0) and mean.y == pytest.approx(1.2)


def test_the_energy_of_a_linear_spring_is_that_of_its_formula(turn):
    """The integral of the force over the lift against P s + k s^2/2."""
    lift = 4.0 - 3.0 * np.cos(np.radians(turn.columns["cam_angle_deg"]))  # mm
    force = 200.0 + 30.0 * lift
    made = figure_of(with_columns(turn, lift_mm=lift, spring_force_N=force), "energy")
    spring = next(c.y[:-1] for p in made.panels for c in p.curves if c.label.startswith("spring"))
    low = lift.min()
    expected = 1e-3 * (200.0 * (lift - low) + 15.0 * (lift**2 - low**2))
    assert spring == pytest.approx(expected, abs=1e-12)


def test_load_cases_stand_side_by_side(turn):
    first = turn.columns
    other = Table(
        MappingProxyType({**first.columns, "normal_force_N": 2.0 * first["normal_force_N"]}),
        np.full(len(first), "over-speed"),
    )
    made = figure_of(replace(turn, others=(first, other)), "load-cases")
    force = made.panels[0].curves[0]
    assert force.y[1] == pytest.approx(2.0 * force.y[0])
    assert force.notes[1] == "over-speed"
    assert not any(each.id == "load-cases" for _, figures in groups(turn) for each in figures)


def test_the_sweep_marks_the_peaks_of_the_surge(turn):
    speed = np.linspace(0.0, 4000.0, 201)
    surge = 20.0 / (1.0 + ((speed - 3000.0) / 50.0) ** 2) + 4.0 * speed / 4000.0
    surge += 0.2 * np.sin(speed / 40.0)  # does not stand out
    forces = ("contact_force_max_N", "contact_force_min_N", "elastic_force_min_N")
    columns = dict.fromkeys(forces, speed + 100.0)
    sweep = Table(MappingProxyType(
        columns | {"preload_N": 0.0 * speed, "crank_speed_rpm": speed, "surge_force_N": surge}
    ))  # fmt: skip
    made = figure_of(replace(turn, sweep=sweep), "speed-sweep")
    assert [mark.start for mark in made.axis.marks] == [pytest.approx(3000.0, abs=20.0)]
    spec = interactive.specification(made)
    assert [s["x0"] for s in spec["layout"]["shapes"] if s["xref"] == "x"] == [
        made.axis.marks[0].start
    ]
    assert made.axis.marks[0].name in figure_svg.svg_of(made)


def test_bars_are_those_of_both_renderers(turn):
    wave = np.cos(np.radians(turn.columns["cam_angle_deg"]))
    made = figure_of(with_columns(turn, torque_before_Nm=wave, torque_after_Nm=0.5 * wave),
                     "torque-spectrum")  # fmt: skip
    with figure_svg.style("bars"):
        axes = figure_svg.draw(made).axes[0]
    spec = interactive.specification(made)
    for still, live, curve in zip(
        axes.containers, spec["data"], made.panels[0].curves, strict=True
    ):
        assert [bar.get_height() for bar in still] == pytest.approx(list(curve.y))
        assert live["type"] == "bar"
        assert live["y"] == pytest.approx(list(curve.y), rel=1e-5, abs=1e-12)
    assert axes.get_ylim()[0] == 0.0


def test_a_limit_of_a_mean_stands_beside_the_mean(turn):
    made = figure_of(turn, "speed")
    for panel in made.panels:
        assert panel.quantity != "PV" or not panel.limits
        if panel.quantity == "mean PV":
            instant = next(p for p in made.panels if p.quantity == "PV")
            for mean, curve in zip(panel.curves, instant.curves, strict=True):
                assert mean.y == pytest.approx(curve.y[:-1].mean())


def test_flat_and_zero_curves_leave_the_axis_of_large_ones(turn):
    wave = np.cos(np.radians(turn.crank))
    curves = tuple(
        Curve(turn.crank, size * wave, name)
        for name, size in (("large", 100.0), ("small", 1.0), ("none", 0.0))
    )
    limit = (LimitLine(120.0, "limit"),)
    made = angle_figure(turn, "x", "X", "Some forces.", Panel("force", "N", curves, limit))
    assert isinstance(made, Figure)
    assert [[c.label for c in panel.curves] for panel in made.panels] == [["large"], ["small"]]
    assert made.panels[0].limits == limit
    assert made.panels[1].quantity == "small"
    assert made.caption == "Some forces. Zero at all angles: none."


def test_the_goodman_diagram_has_each_part_over_its_strengths(turn):
    point = {"name": "wire", "amplitude_MPa": 200.0, "mean_MPa": 450.0, "endurance_MPa": 800.0,
             "strength_MPa": 1000.0}  # fmt: skip
    fatigue = {"spring": {"required_safety": 1.25, "points": [point]}}
    (panel,) = figure_of(replace(turn, fatigue=fatigue), "goodman-spring").panels
    line, safe, wire = panel.curves
    assert line.y == pytest.approx(1.0 - line.x)
    assert safe.y[safe.x == 0.8] == pytest.approx(0.0)
    (at,) = np.flatnonzero(np.isfinite(wire.y))
    assert (wire.x[at], wire.y[at]) == pytest.approx((0.45, 0.25))


def test_the_points_of_the_goodman_diagrams_give_the_safeties_of_the_checks():
    """Spring and camshaft of a case that describes every part."""
    trial = preview_case(read_case(Path(__file__).parents[1] / "data" / "every_part.toml"))
    record = fatigue_record(trial.solution)
    checks = {check.id: check for check in trial.checks}
    for part, name in (("spring", "spring_fatigue"), ("camshaft", "shaft_fatigue")):
        worst = max(
            p["amplitude_MPa"] / p["endurance_MPa"] + p["mean_MPa"] / p["strength_MPa"]
            for p in record[part]["points"]
        )
        assert 1.0 / worst == pytest.approx(checks[name].demand, rel=1e-9)
        assert record[part]["required_safety"] == checks[name].limit


def test_trials_are_drawn_over_each_other_the_result_last_and_solid(turn):
    """Contour and torque of each trial, from its own files."""
    first, final = turn.trials
    contours, torque = (figure_of(turn, f"trial-{name}") for name in ("contours", "torque"))
    labels = ["trial 1, 60\u00a0deg", "trial 2, 120\u00a0deg"]
    assert [label for label, _ in contours.contours] == labels
    for trial, (_, points) in zip((first, final), contours.contours, strict=True):
        assert points[1] == pytest.approx(trial.contour["contour_y_mm"])
    named = [curve for curve in contours.curves if curve.label]
    assert [curve.dash for curve in named] == ["dashed", "solid"]
    assert named[0].colour != named[1].colour
    radius = np.hypot(*contours.contours[1][1])
    assert f"trial 2, 120\u00a0deg: {radius.min():.4g} to {radius.max():.4g} mm" in contours.alt
    (panel,) = torque.panels
    assert [(curve.label, curve.look) for curve in panel.curves] == [
        (labels[0], "dashed"), (labels[1], "line"),
    ]  # fmt: skip
    assert panel.curves[0].y[:-1] == pytest.approx(first.cycle["torque_after_Nm"])
    for made in (contours, torque):
        assert "trial 1" in figure_svg.svg_of(made)
        assert [
            t["name"] for t in interactive.specification(made)["data"] if t.get("name")
        ] == labels


def test_a_single_trial_is_compared_with_none(turn):
    alone = replace(turn, trials=turn.trials[-1:])
    shown = {each.id for _, figures in groups(alone) for each in figures}
    assert not {"trial-contours", "trial-torque"} & shown


def test_of_many_trials_the_first_the_latest_and_the_final_one_are_compared(tmp_path):
    report_fixture.write_run(tmp_path / "run", positions=ROWS, field=False)
    run = read_material(tmp_path / "run").run
    nine = [replace(run.trials[0], number=k) for k in range(1, 10)]
    many = replace(run, trials=tuple(nine), summary={**run.summary, "final_trial": 3})
    compared = governing_turn(many, {}).trials
    assert [trial.number for trial in compared] == [1, 6, 7, 8, 9, 3]


@pytest.mark.parametrize("count", range(2, 10))
def test_a_legend_stays_within_its_figure(count):
    labels = ("Goodman line", "safety 1.5", "cam", "gear seat", "bearing seat 1", "bearing seat 2",
              "counterweight", "a long name of a section", "seat")[:count]  # fmt: skip
    x = np.array([0.0, 1.0])
    panel = Panel("use", "", tuple(Curve(x, x, label) for label in labels))
    with figure_svg.style("legend"):
        canvas = figure_svg.draw(over("legend", "", "", "stress", "", [panel]))
        canvas.draw_without_rendering()
        assert canvas.axes[0].get_legend().get_window_extent().x1 <= canvas.bbox.x1
