"""What the public names return, as an interpreter, a notebook, pandas and matplotlib take it."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
import pytest
import small_run
from small_machine import small_machine

import camwright as cw
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.display import Displayed, html_table, in_brief
from camwright.geometry.errors import InputError, ResultError
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.pipeline.base import extras
from camwright.pipeline.base.tables import CAM_ANGLE, LOAD_CASE, Column, table
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.results.check_records import CheckList

CASES = Path(__file__).parents[2] / "cases"
LINE, SHOWN = 500, 50_000  # characters: of a line, and of anything in a notebook


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> SimpleNamespace:
    """One of everything that the public names return."""
    case = parse_case(small_machine("display"))
    synthesis = cw.synthesize(case)
    trial = cw.solve(
        synthesis.case, synthesis.contour, tier=cw.Tier.PREVIEW, positions=36, corners=False
    )
    run = cw.read_run(small_run.write_run(tmp_path_factory.mktemp("run") / "of", case, "fail"))
    screened = cw.screen_designs(case, {"spring.preload": np.array([300.0, 310.0, 900.0])})
    return SimpleNamespace(
        case=case, synthesis=synthesis, contour=synthesis.contour, lift=trial.lift, trial=trial,
        checks=trial.checks, check=trial.checks[-1], cycle=trial.cycles[0], run=run,
        solution=trial.solution, turn=trial.cycles[0].turn, machine=trial.cycles[0].machine,
        loads=trial.cycles[0].loads, guides=trial.cycles[0].guides, parts=trial.cycles[0].parts,
        contact=trial.cycles[0].contact, rolling=trial.cycles[0].rolling,
        record=run.final, records=run.checks, table=run.final.cycle, screened=screened,
    )  # fmt: skip


@pytest.fixture(autouse=True)
def closed() -> Iterator[None]:
    """No figure is left open."""
    yield
    plt.close("all")


NAMES = (
    "case", "synthesis", "contour", "lift", "trial", "checks", "check", "cycle", "run", "solution",
    "turn", "machine", "loads", "guides", "parts", "contact", "rolling", "record", "records",
    "table", "screened",
)  # fmt: skip
TABLES = (
    "case", "synthesis", "trial", "checks", "cycle", "run", "record", "records", "table",
    "screened",
)  # fmt: skip


class Cells(HTMLParser):
    """Texts of a document, and whether its tags are closed."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.texts: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


@pytest.mark.parametrize("name", NAMES)
def test_one_line_and_a_small_table(made: SimpleNamespace, name: str) -> None:
    shown = getattr(made, name)
    assert isinstance(shown, Displayed)
    line = repr(shown)
    assert "\n" not in line
    assert len(line) <= LINE
    assert " at 0x" not in line  # an address would change from one run to the next
    assert line.startswith(f"{type(shown).__name__}(")
    cells = Cells(shown._repr_html_())
    assert cells.open == []
    assert len(shown._repr_html_()) <= SHOWN
    assert len(str(shown)) <= LINE


def test_what_the_line_says(made: SimpleNamespace) -> None:
    assert repr(made.case).startswith("Case(name=display, ")
    assert "prime_radius=" in repr(made.synthesis)
    assert f"screen={made.trial.screen}" in repr(made.trial)
    assert f"verdict={made.run.verdict}, checks=1, fail=1)" in repr(made.run)
    assert repr(made.cycle).startswith(f"Cycle(load_case={made.cycle.load_case}, positions=36")
    assert f"lift_max={1e3 * made.lift.highest.value:.4g} mm" in repr(made.lift)
    assert f"{str(made.check)[:40]}" in repr(made.check)
    assert repr(made.loads).startswith("Loads(theta=array(36,), ")


@pytest.mark.parametrize("name", TABLES)
def test_data_frame_and_figure(made: SimpleNamespace, name: str) -> None:
    shown = getattr(made, name)
    frame = shown.to_pandas()
    assert isinstance(frame, pd.DataFrame)
    assert len(frame) > 0
    panels = shown.plot()
    assert panels[0].figure.number in plt.get_fignums()  # a notebook draws it by itself
    assert all(axes.has_data() for axes in panels)


def test_a_cycle_is_the_table_of_its_csv_file(made: SimpleNamespace) -> None:
    """Units in the names, values in these units, the load case of each row."""
    cycle = made.cycle
    frame = cycle.to_pandas()
    assert tuple(frame.columns) == cycle.keys()
    assert frame["load_case"].unique().tolist() == [cycle.load_case]
    np.testing.assert_allclose(frame["cam_angle_deg"], np.degrees(cycle.theta), atol=1e-9)
    np.testing.assert_allclose(frame["lift_mm"], 1e3 * cycle.loads.lift)
    np.testing.assert_allclose(cycle["p0_hertz_MPa"], 1e-6 * cycle.contact.p0_hertz)
    assert dict(cycle).keys() == set(cycle.keys())


def of_two_load_cases():
    angle = np.radians([0.0, 120.0, 240.0] * 2)
    force = Column("force", "N", unknown=True)
    names = ["idle"] * 3 + ["<b>full</b>"] * 3
    return table({LOAD_CASE: names, CAM_ANGLE: angle, force: [1.0, 2.0, np.nan, 4.0, 5.0, 6.0]})


def test_columns_of_a_table_are_a_data_frame_with_the_load_case_of_each_row() -> None:
    made = of_two_load_cases()
    for frame in (pd.DataFrame(made.columns), made.to_pandas(), pd.DataFrame(dict(made))):
        assert frame.columns.tolist() == ["load_case", "cam_angle_deg", "force_N"]
        assert frame["load_case"].tolist() == ["idle"] * 3 + ["<b>full</b>"] * 3
        assert frame["force_N"].isna().tolist() == [False, False, True, False, False, False]
    with pytest.raises(ValueError, match="constructor"):  # refused, not wrong
        pd.DataFrame(made)
    with pytest.raises(ValueError, match="read-only"):
        made["force_N"][0] = 0.0
    again = pickle.loads(pickle.dumps(made))
    assert again.keys() == made.keys()
    assert "load_case" in made
    assert "load_case" not in table({CAM_ANGLE: [0.0]})


def test_a_table_has_no_negative_zero() -> None:
    text = table({CAM_ANGLE: [-0.0, -1e-300], Column("force", "N"): [-0.0, -5e-324]}).to_csv()
    assert text == "cam_angle_deg,force_N\n0.0,0.0\n0.0,-5e-324\n"


def test_a_figure_has_a_panel_a_column_and_a_curve_a_load_case() -> None:
    made = of_two_load_cases()
    panels = made.plot("force_N", "cam_angle_deg")
    assert [len(axes.lines) for axes in panels] == [2, 2]
    assert [axes.get_ylabel() for axes in panels] == ["force_N", "cam_angle_deg"]
    assert panels[-1].get_xlabel() == "cam_angle_deg"
    first = panels[0].lines[1]
    np.testing.assert_allclose(first.get_xdata(), [0.0, 120.0, 240.0])
    np.testing.assert_allclose(first.get_ydata(), [4.0, 5.0, 6.0])
    for wrong in ("force", "load_case"):
        with pytest.raises(InputError, match=r"one of cam_angle_deg, force_N"):
            made.plot(wrong)
    with pytest.raises(InputError, match="of numbers"):
        table({LOAD_CASE: ["a"]}).plot()


def test_text_of_a_case_is_escaped() -> None:
    text = of_two_load_cases()._repr_html_()
    assert "<b>" not in text
    assert "&lt;b&gt;full&lt;/b&gt;" in text
    assert "<script>" not in html_table("<script>", ["<script>"], [["<script>"]])
    assert "load_cases" in repr(of_two_load_cases())


def test_a_case_is_drawn_by_the_torque_of_its_load_cases(made: SimpleNamespace) -> None:
    (axes,) = made.case.plot()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("shaft angle, deg", "torque, N m")
    torques = engine_torques(made.case)
    assert [line.get_label() for line in axes.lines] == list(torques)
    for line, torque in zip(axes.lines, torques.values(), strict=True):
        angle, value = line.get_xydata().T
        assert angle[-1] == pytest.approx(360.0 * made.case.mechanism.gear_ratio)
        assert value[-1] == value[0]
        area = np.trapezoid(value, angle) / angle[-1]
        assert area == pytest.approx(torque.mean, abs=1e-9 * torque.peak)


def test_a_case_that_states_its_lift_is_drawn_by_it() -> None:
    case = cw.read_case(CASES / "papers" / "eccentric.toml")
    top = case.plot()[0]
    assert top.get_ylabel() == "s, mm"
    height = top.lines[0].get_ydata()
    assert np.ptp(height) == pytest.approx(2e3 * case.lift.eccentricity, rel=1e-4)


def test_a_lift_is_drawn_with_its_derivatives(made: SimpleNamespace) -> None:
    """Against the columns of the synthesis, and each panel the slope of that above it."""
    panels = made.lift.plot()
    assert [axes.get_ylabel() for axes in panels] == ["s, mm", "s′, mm/rad", "s″, mm/rad²"]
    assert panels[-1].get_xlabel() == "cam angle, deg"
    curves = [axes.lines[0].get_xydata().T for axes in panels]
    angle = curves[0][0]
    assert (angle[0], angle[-1]) == (0.0, 360.0)
    columns = made.synthesis
    listed = np.append(columns["cam_angle_deg"], 360.0)
    for k, header in enumerate(("lift_mm", "lift_d1_mm_per_rad", "lift_d2_mm_per_rad2")):
        values = np.append(columns[header], columns[header][0])
        drawn = np.interp(listed, *curves[k])
        np.testing.assert_allclose(drawn, values, atol=1e-3 * np.ptp(values))
    for upper, lower in pairwise(curves):
        slope = np.gradient(upper[1], np.radians(angle), edge_order=2)
        np.testing.assert_allclose(slope, lower[1], atol=1e-2 * np.ptp(lower[1]))


def test_a_contour_is_drawn_with_its_circle_to_one_scale(made: SimpleNamespace) -> None:
    (axes,) = made.contour.plot()
    assert axes.get_aspect() == 1.0
    assert (axes.get_xlabel(), axes.get_ylabel()) == (
        "x (along cam angle zero), mm", "y, mm",
    )  # fmt: skip
    drawn = {line.get_label(): np.hypot(*line.get_xydata().T) for line in axes.lines}
    assert list(drawn) == ["contour", "pitch curve", "prime circle"]
    prime, roller = 1e3 * made.case.cam.prime_radius, 1e3 * made.case.roller.radius
    np.testing.assert_allclose(drawn["prime circle"], prime)
    assert drawn["pitch curve"].min() >= prime - 1e-9
    assert drawn["contour"].min() == pytest.approx(drawn["pitch curve"].min() - roller, abs=1e-2)
    (axes,) = made.synthesis.plot()
    assert axes.lines[-1].get_label() == "bore"
    bore = np.hypot(*axes.lines[-1].get_xydata().T)
    np.testing.assert_allclose(bore, 1e3 * made.case.cam.bore_radius)


def test_under_a_flat_face_the_circle_is_the_base_circle() -> None:
    lift = Lift.from_samples(uniform_turn(36), 0.002 * (1 - np.cos(uniform_turn(36))))
    (axes,) = FlatFaceContour(FacePath(lift, 0.02)).plot()
    assert [line.get_label() for line in axes.lines] == ["contour", "base circle"]
    np.testing.assert_allclose(np.hypot(*axes.lines[1].get_xydata().T), 20.0)


def test_checks_as_a_table_and_as_bars(made: SimpleNamespace) -> None:
    checks = made.checks
    frame = checks.to_pandas()
    assert frame["id"].tolist() == [each.id for each in checks]
    assert frame["status"].tolist() == [each.status for each in checks]
    evaluated = [each.utilisation for each in checks if each.utilisation is not None]
    (axes,) = checks.plot(5)
    bars = sorted((bar.get_width() for bar in axes.patches), reverse=True)
    greatest = sorted(evaluated, reverse=True)[:5]
    np.testing.assert_allclose(bars, np.minimum(greatest, 2.0))
    assert axes.get_xlim() == (0.0, 2.0)
    assert all(text.get_position()[0] <= 2.0 for text in axes.texts)
    assert [text.get_text() for text in axes.texts] == [f" {v:.4g}" for v in greatest]
    assert isinstance(checks, tuple)
    assert pickle.loads(pickle.dumps(made.records)) == made.records
    assert copy.copy(made.records) == made.records
    empty = CheckList(())
    assert repr(empty) == "CheckList(checks=0)"
    assert empty.to_pandas().empty
    assert len(empty.plot()) == 1


def test_keys_of_a_case_in_a_data_frame(made: SimpleNamespace) -> None:
    frame = made.case.to_pandas().set_index("key")["value"]
    assert frame["name"] == "display"
    assert frame["cam.width"].endswith(" mm")
    assert frame["load_case[0].name"] == made.case.load_cases[0].name


@pytest.mark.slow
def test_a_sizing(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "camwright", "new", "feed", "--kind", "lift"]
    subprocess.run(command, cwd=tmp_path, check=True)
    sizing = cw.size(tmp_path / "feed.toml", ["cam.prime_radius", "cam.offset"])
    assert f"verdict={sizing.verdict}, cam.prime_radius=" in repr(sizing)
    frame = sizing.to_pandas()
    assert frame["key"].tolist() == ["cam.prime_radius", "cam.offset"]
    assert frame["unit"].tolist() == ["mm", "mm"]
    assert frame["value"][0] == pytest.approx(1e3 * sizing.values["cam.prime_radius"])
    assert len(sizing.plot()) == len(sizing.figure.panels) == 2
    assert Cells(sizing._repr_html_()).open == []


def test_without_pandas_the_message_names_the_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda _: None)
    with pytest.raises(ResultError, match=r'pip install "camwright\[notebook\]"'):
        of_two_load_cases().to_pandas()


def test_values_in_brief() -> None:
    assert in_brief(np.zeros((2, 3))) == "array(2, 3)"
    assert in_brief(1 / 3) == "0.333333"
    assert in_brief(np.float64(2.0)) == "2"
    assert in_brief([1]) == "1 entry"
    assert in_brief({}) == "0 entries"
    assert in_brief(None) == "None"
    assert in_brief(True) == "True"
    assert in_brief("a\n b" + 200 * "c").startswith("a b")
    assert len(in_brief("c" * 1000)) <= 120
    assert in_brief(object()) == "object"


def test_neither_pandas_nor_matplotlib_is_imported_before_it_is_used(tmp_path: Path) -> None:
    lines = f"""
import sys
import camwright as cw
for name in cw.__all__:
    getattr(cw, name)
run = cw.read_run({str(small_run.write_run(tmp_path / "run"))!r})
repr(run), run._repr_html_(), run.final.cycle.columns
print([name for name in ("pandas", "matplotlib.pyplot", "IPython") if name in sys.modules])
"""
    out = subprocess.run([sys.executable, "-c", lines], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"
