"""The page from a synthetic run folder: order, words, and text that means harm."""

from __future__ import annotations

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture

from camwright.geometry.errors import ResultError
from camwright.pipeline.base import files
from camwright.pipeline.results import signoff
from camwright.reports import (
    analysis_sheet,
    figure_svg,
    interactive,
    page,
    report_content,
    report_tables,
)

HOSTILE = "<script>alert(1)</script>\"'&lt;../../x " + "אבג \u202e \U0001f527 "


@pytest.fixture(scope="module", autouse=True)
def still():
    """The page without its library, whose text holds all these words; a browser tries the rest."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(interactive, "bundle", lambda _figures: interactive.Bundle((), (), "{}"))
        yield


class Outline(HTMLParser):
    """Tags, headings and ids of a page; fails on anything left open."""

    VOID = ("meta", "img", "br", "use", "path", "rect", "circle", "input")

    def __init__(self, html: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.ids: list[str] = []
        self.stack: list[str] = []
        self.attributes: list[tuple[str, str, str]] = []
        self.feed(html)

    def handle_startendtag(self, tag, attrs):
        self.note(tag, attrs)

    def handle_starttag(self, tag, attrs):
        self.note(tag, attrs)
        if tag not in self.VOID:
            self.stack.append(tag)

    def note(self, tag, attrs):
        self.tags.append(tag)
        for name, value in attrs:
            self.attributes.append((tag, name, value or ""))
            if name == "id":
                self.ids.append(value)

    def handle_endtag(self, tag):
        if tag not in self.VOID:
            assert self.stack.pop() == tag


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    folder = report_fixture.write_run(tmp_path_factory.mktemp("run"), positions=72, field=False)
    return report_fixture.page_of(folder)


@pytest.fixture
def undrawn(monkeypatch):
    """Figures left blank, for tests of words."""
    monkeypatch.setattr(figure_svg, "svg_of", lambda figure: f"<svg>{figure.id}</svg>")


@pytest.fixture(scope="module")
def html(built):
    return built.read_text(encoding="utf-8")


def test_the_page_is_one_file_that_reaches_for_nothing(built, html):
    assert built.name == "8_report.html"
    assert built.stat().st_size < 5e6
    assert not re.search(r'src="(?!data:)', html)
    linked = re.findall(r'href="([^#"][^"]*)"', html)
    assert set(linked) <= {name for _, name in page.LINKS}
    assert linked and all((built.parent / name).is_file() for name in linked)
    assert "@import" not in html
    assert "url(http" not in html
    assert "default-src 'none'" in html


def test_the_page_is_well_formed_with_ids_used_once(html):
    outline = Outline(html)
    assert outline.stack == []
    assert len(outline.ids) == len(set(outline.ids))
    named = {value for _, name, value in outline.attributes if name == "aria-labelledby"}
    assert named <= set(outline.ids)
    anchors = {v[1:] for t, n, v in outline.attributes
               if t == "a" and n == "href" and v.startswith("#")}  # fmt: skip
    assert anchors <= set(outline.ids)
    assert all(any(n == "alt" for t2, n, _ in outline.attributes if t2 == "img")
               for t in outline.tags if t == "img")  # fmt: skip


def test_the_verdict_comes_first_and_names_what_binds(html):
    order = [html.index(f'id="{name}"') for name in (
        "verdict", "arrangement", "uses-h", "figures-h", "remedies-h", "failed", "sheet", "fields",
        "trials", "evidence", "inputs", "assumptions", "versions", "checks")]  # fmt: skip
    assert order == sorted(order)
    top = html[: html.index('id="sheet"')]
    assert ">FAIL</h2>" in top
    assert "4 of 8 required checks pass, 3 fail, 1 is waived." in top
    worst = re.search(r"Remedies</h3>\s*<ol>\s*<li>(.*?)</li>", top)
    assert worst and "<bdi>Static safety of the roller bearing: " in worst[1]
    assert "idle 192" in worst[1]
    assert "<b>Governing:</b>" not in top  # it is the worst failure
    assert "no smoothing that keeps the torque reduction" in top


def test_the_outline_tells_of_the_counter_hole(html):
    said = html.replace("\u00a0", " ")
    assert "Its unbalance is 900 g mm at 40 deg; with a hole of 14 mm diameter" in said
    assert "diameter at (26, 21.8) mm, drilled, 0 g mm" in said


def test_every_figure_of_the_sheet_is_there_with_words_for_it(html):
    # the run has a roller on a stem, one load case, no sweep, and no synthesis within limits
    without = {"face", "limits", "load-cases", "speed-sweep", "goodman-spring", "goodman-camshaft",
               "pivot"}  # fmt: skip
    wanted = [name for _, names in analysis_sheet.GROUPS for name in names if name not in without]
    assert not any(f'<figure id="{name}">' in html for name in without)
    for name in wanted:
        assert f'<figure id="{name}">' in html
        assert f'id="{name}-alt"' in html
    assert html.count("<svg ") == len(wanted) + 1  # with the arrangement


def test_trials_and_certificate_are_printed(html):
    trials = html[html.index('id="trials"') : html.index('id="evidence"')]
    table = trials[: trials.index("</table>")].replace("\u00a0", " ")
    assert "Ripple left" in table and table.index("3.4 N m") < table.index("3.1 N m")
    assert '<figure id="trial-contours">' in trials and '<figure id="trial-torque">' in trials
    assert "moving average of 24 values 5 deg apart" in html
    assert "\u201cPressure angle\u201d fails" in html
    evidence = html[html.index('id="evidence"') :]
    assert evidence.count("18233, 43120, 120411") == 8
    assert evidence.count("half-width a, mm") == 8
    assert "finite elements joined to the half-plane" in evidence


def test_a_missing_field_is_told_in_words(html):
    assert "The stress field is not available: stress.vtkhdf: no such file." in html


def test_rebuilding_needs_only_the_folder_and_gives_the_same_page(tmp_path, undrawn):
    folder = report_fixture.write_run(tmp_path / "run", positions=36, field=False)
    first = report_fixture.page_of(folder).read_bytes()
    (folder / page.PAGE).unlink()
    assert report_fixture.page_of(folder.rename(tmp_path / "moved")).read_bytes() == first


def test_hostile_text_comes_out_harmless_and_whole(tmp_path, undrawn):
    text = HOSTILE + "x" * 10_000
    records = report_fixture.checks()
    for record in records:
        record.update(title=text, note=text, source=text, method=text)
    folder = report_fixture.write_run(
        tmp_path / "run", positions=36, title=text, notes=text, records=records, field=False
    )
    html = report_fixture.page_of(folder).read_text(encoding="utf-8")
    own = [f'<script type="application/json" id="{name}">' for name in ("figure-data", "turn-data")]
    assert [html.count(each) for each in own] == [1, 1]
    assert html.count("<script") == len(own)
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in html
    assert "x" * 10_000 in html
    assert "אבג" in html
    assert "\U0001f527" in html
    outline = Outline(html)
    assert outline.stack == []
    title = re.search(r"<title>(.*?)</title>", html, re.DOTALL)
    assert title is not None
    assert len(title.group(1)) < 300


def test_control_characters_are_replaced():
    assert report_tables.plain("a\x00b\x1bc\ud800d\n\te") == "a\ufffdb\ufffdc\ufffdd\n\te"
    assert report_tables.shortened("one\n two", 20) == "one two"
    assert report_tables.shortened("a" * 50, 10) == "a" * 9 + "…"


def test_a_run_without_engine_or_optional_columns_is_reported(tmp_path, undrawn):
    folder = report_fixture.write_run(tmp_path / "run", positions=36, field=False)
    (folder / "1_torque.csv").unlink()
    cycle = folder / "trial_2" / "5_cycle.csv"
    lines = [line.split(",") for line in cycle.read_text().splitlines()]
    drop = [k for k, name in enumerate(lines[0]) if name.startswith("torque_")]
    kept = [",".join(cell for k, cell in enumerate(row) if k not in drop) for row in lines]
    cycle.write_text("\n".join(kept) + "\n")
    signoff.write(folder)
    html = report_fixture.page_of(folder).read_text(encoding="utf-8")
    assert '<figure id="torque">' not in html
    assert '<figure id="torque-components">' not in html
    assert '<figure id="pressure">' in html
    assert ">intake<" not in html


def test_several_load_cases_show_the_governing_one_and_a_ribbon(tmp_path, monkeypatch):
    folder = report_fixture.write_run(tmp_path / "run", positions=36, field=False)
    trial = folder / "trial_2"
    lines = (trial / "5_cycle.csv").read_text().splitlines()
    more = ["rated" + line.removeprefix("idle") for line in lines[1:]]
    (trial / "5_cycle.csv").write_text("\n".join([*lines, *more]) + "\n")
    records = json.loads((trial / "6_checks.json").read_text())
    next(r for r in records if r["id"] == "roller_static")["load_case"] = "rated"
    margin = next(r for r in records if r["id"] == "contact_force_margin")
    margin.update(status="not_evaluated", demand=None)
    (trial / "6_checks.json").write_text(json.dumps(records))
    signoff.write(folder)
    seen = []
    monkeypatch.setattr(figure_svg, "svg_of", lambda figure: seen.append(figure) or "<svg/>")
    html = report_fixture.page_of(folder).read_text(encoding="utf-8")
    pressure = next(figure for figure in seen if figure.id == "pressure")
    assert pressure.panels[0].curves[0].upper is not None
    assert pressure.panels[0].curves[1].upper is None
    assert "Load case rated, the governing one" in html
    assert "range of all 2 load cases" in html

    summary = json.loads((folder / "run.json").read_text())
    summary["load_ends"] = [
        {"load_case": "rated", "cam_angle_deg": 150.5, "statement": "leaves the cam at 150.5 deg"}
    ]
    (folder / "run.json").write_text(json.dumps(summary))
    signoff.write(folder)
    html = report_fixture.page_of(folder).read_text(encoding="utf-8")
    assert "Load case idle, in which the follower stays on the cam" in html.replace(
        "\u2068", ""
    ).replace("\u2069", "")
    assert ">rated<" in html[: html.index('id="verdict"')]  # the governing load case


def test_a_passing_run_says_pass(tmp_path, undrawn):
    records = [r for r in report_fixture.checks() if r["status"] == "pass"]
    folder = report_fixture.write_run(
        tmp_path / "run", positions=36, records=records, field=False
    )  # fmt: skip
    html = report_fixture.page_of(folder).read_text(encoding="utf-8")
    assert ">PASS</h2>" in html
    assert "FAIL" not in html


def test_an_incomplete_run_says_first_what_to_confirm_and_what_is_missing(tmp_path, undrawn):
    records = [r for r in report_fixture.checks() if r["status"] in ("pass", "waived")]
    records[0]["to_be_confirmed"] = [HOSTILE]
    missing = {"title": "Shaft stress", "note": HOSTILE, "demand": None, "limit": None}
    for name, required in (("shaft", True), ("film", False)):
        record = records[0] | missing | {"id": name, "must_have": required, "utilisation": None}
        records.append(record | {"status": "not_evaluated", "to_be_confirmed": []})
    scope = {"not_covered": ["key"], "reason": HOSTILE.replace("\u202e", "")}
    folder = report_fixture.write_run(
        tmp_path / "run", positions=36, records=records, field=False, scope=scope
    )  # fmt: skip
    html = report_fixture.page_of(folder).read_text(encoding="utf-8")
    assert "<script>alert" not in html
    assert "<title>INCOMPLETE: " in html
    assert ">INCOMPLETE</h2>" in html
    top = html[html.index('id="verdict"') : html.index('id="sheet"')]
    said = [
        "<b>1 check without data, 1 waived, 1 value to be confirmed",
        "Not covered by this sign-off: key: &lt;script&gt;", "State the missing data.",
        "Shaft stress: \u2068&lt;script&gt;", "required checks pass, 1 lacks data",
        "Missing data:</b> 1", "Waived:", "accepted up to 2",
        "Values to be confirmed:</b> 1",
    ]  # fmt: skip
    places = [top.index(text) for text in said]
    assert places == sorted(places)
    groups = html[html.index('id="checks"') :]
    rows = re.findall(r'<tr role="row" class="\w+" data-status="(\w+)" data-part="\w+', groups)
    assert rows[:2] == ["not_evaluated"] * 2
    assert set(rows[2:]) == {"waived", "pass"}
    assert Outline(html).stack == []


def test_what_is_not_a_run_is_refused_and_left_alone(tmp_path):
    with pytest.raises(ResultError, match=r"run\.json is missing"):
        report_fixture.page_of(tmp_path)
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(ResultError, match="no such folder"):
        report_fixture.page_of(tmp_path / "nowhere")


def test_a_failed_write_leaves_the_old_page(built, html, undrawn, monkeypatch):
    def full(*_args, **_kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files.os, "fdopen", full)
    with pytest.raises(ResultError, match="No space left on device"):
        report_fixture.page_of(built.parent)
    assert built.read_text(encoding="utf-8") == html
    assert not [p for p in built.parent.iterdir() if p.name.endswith(".tmp")]


def test_a_statement_names_checks_by_their_titles():
    checks = [{"id": "roller_static", "title": "Static safety"}, {"id": "jump", "title": "Jump"}]
    text = report_content.titled(
        "roller_static at 2.6 of its limit; roller_statics and jump_speed stay", checks
    )
    assert (
        text == "\u201cStatic safety\u201d at 2.6 of its limit; roller_statics and jump_speed stay"
    )
