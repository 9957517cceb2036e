"""Answers and page of a study folder: rebuilt from its dataset, hostile text, in a browser."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from browser_fixture import Tab, chromium

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base import extras
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.commands.study_command import write_study_report
from camwright.pipeline.studies.batch.dataset import (
    ANSWERS,
    DATASET,
    PAGE,
    STUDY,
    parquet_bytes,
    table_of,
)

HOSTILE = "<script>window.broken=1</script>\"'&../\u202eעברית </script><!--"
PRINTABLE = HOSTILE.replace("\u202e", "")  # a study file refuses the other
BYTES_MAX = 8 << 20
CHECKS = ("spring_travel", "pressure_angle", "contact_force_margin")
STUDY_FILE = """
name = "springs"
title = {title}
case = "base.toml"
[[factor]]
key = "spring.rate"
range = {{ low = "15 kN/m", high = "40 kN/m" }}
[[factor]]
key = "roller.material"
list = ["steel", {title}]
[sampling]
method = "{method}"
count = {count}
[[objective]]
column = "headline.lift_max_mm"
[[objective]]
column = "headline.p0_hertz_max_MPa"
goal = "max"
"""


def study_folder(folder: Path, count: int, method: str = "random") -> Path:
    """A study of made rows: two factors, three checks, a tenth of the designs refused."""
    rng = np.random.default_rng(1)
    rate, kind = rng.uniform(15.0, 40.0, count), rng.choice(["steel", HOSTILE], count)
    refused = rng.random(count) < 0.1
    use = rng.lognormal(-0.3, 0.3, (len(CHECKS), count)) * (rate / 30.0)
    rows: dict[str, object] = {
        "design": np.arange(count), "id": [f"{k:024x}" for k in range(count)],
        "depth": ["screening"] * count,
        "screen": np.where(refused, "error", np.where((use > 1.0).any(axis=0), "fail", "open")),
        "verdict": [None] * count,
        "governing": np.where(refused, "", np.array(CHECKS)[use.argmax(axis=0)]),
        "message": np.where(refused, HOSTILE, ""),
        "factor.spring.rate": rate, "factor.roller.material": kind,
        "headline.lift_max_mm": np.where(refused, np.nan, 30.0 + rng.random(count)),
        "headline.p0_hertz_max_MPa": np.where(refused, np.nan, 50.0 * rate + rng.random(count)),
    }  # fmt: skip
    for check, values in zip(CHECKS, use, strict=True):
        rows[f"{check}.utilisation"] = np.where(refused, np.nan, values)
        status = np.where(values > 1.0, "fail", "pass")
        rows[f"{check}.status"] = np.where(refused, "", status)
    units = {"spring.rate": "kN/m", "roller.material": None}
    write_atomic(folder / DATASET, parquet_bytes(table_of(rows, units)))
    title = json.dumps(PRINTABLE, ensure_ascii=False)
    text = STUDY_FILE.format(title=title, method=method, count=count)
    write_atomic(folder / STUDY, text)
    page = folder / "runs" / f"{3:024x}" / "8_report.html"
    write_atomic(page, "kept")
    return folder


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = study_folder(tmp_path_factory.mktemp("study"), 10_000)
    write_study_report(folder)
    return folder


def test_the_answers_are_those_of_the_rows(made: Path) -> None:
    answers = json.loads((made / ANSWERS).read_text(encoding="utf-8"))
    share = answers["yield"]
    assert answers["designs"]["count"] == 10_000 == share["count"] + share["without_result"]
    assert share["by"] == "screen"
    assert share["interval"][0] < share["value"] < share["interval"][1]
    assert {row["check"] for row in answers["failures"]} == set(CHECKS)
    assert all(0 < row["alone"] < row["fail"] for row in answers["failures"])
    by_name = {row["name"]: row for row in answers["outputs"]}
    (rate, *rest) = sorted(
        by_name["headline.p0_hertz_max_MPa"]["effects"], key=lambda r: -r["share"]
    )
    assert rate["factor"] == "spring.rate" and rate["share"] > 0.99
    assert rest[0]["share_interval"][0] == 0.0
    assert answers["front"]["designs"] and answers["worst"]["utilisation"] > 1.0


def test_the_report_is_rebuilt_byte_for_byte(made: Path) -> None:
    before = [(made / name).read_bytes() for name in (ANSWERS, PAGE)]
    for name in (ANSWERS, PAGE):
        (made / name).unlink()
    write_study_report(made)
    assert [(made / name).read_bytes() for name in (ANSWERS, PAGE)] == before


def test_the_page_is_small_closed_and_escaped(made: Path) -> None:
    text = (made / PAGE).read_text(encoding="utf-8")
    assert (made / PAGE).stat().st_size <= BYTES_MAX
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy and "default-src 'none'" in policy[1] and "unsafe-eval" not in policy[1]
    assert "<script>window" not in text
    assert not re.search(r"<(script|link|img|iframe)[^>]+(src|href)=.?https?:", text)


@pytest.mark.parametrize("method", ["sobol_indices", "list", "grid"])
def test_a_method_decides_what_is_a_yield_and_what_an_index(tmp_path: Path, method: str) -> None:
    """Four rows a block: two are independent. A grid has a share and no yield."""
    study_folder(tmp_path, 402, method)
    if method != "sobol_indices":
        file = tmp_path / STUDY
        write_atomic(file, file.read_text(encoding="utf-8").replace("count = 402", ""))
    write_study_report(tmp_path)
    answers = json.loads((tmp_path / ANSWERS).read_text(encoding="utf-8"))
    share, sobol = answers["yield"], [row["sobol"] for row in answers["outputs"]]
    if method == "sobol_indices":
        assert (share["dependent"], share["count"] + share["without_result"]) == (200, 200)
        assert sobol[2][0]["factor"] == "spring.rate"
        assert share["interval"]
    else:
        assert not any(sobol) and share["interval"] is None


def test_a_folder_that_is_no_study_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError):
        write_study_report(tmp_path)
    study_folder(tmp_path, 20)
    (tmp_path / DATASET).write_bytes(b"PAR1 and nothing")
    with pytest.raises(ResultError):
        write_study_report(tmp_path)
    assert not (tmp_path / ANSWERS).exists()


def test_a_missing_library_is_named(made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "find_spec", lambda _: None)
    with pytest.raises(ResultError, match=r"pip install .camwright\[study\]"):
        write_study_report(made)


@pytest.fixture(scope="module")
def tab() -> Iterator[Tab]:
    with chromium() as opened:
        yield opened


@pytest.mark.parametrize("width", [390, 1440])
def test_every_view_shows_the_same_selection(made: Path, tab: Tab, width: int) -> None:
    tab.open(made / PAGE, width, 900)
    page = tab.page
    page.locator("#rows tbody tr").first.wait_for()
    assert page.locator("#selected").text_content().startswith("10,000 of 10,000")
    page.locator("#range-from").fill("30")
    page.locator("#range-form button").click()
    page.locator(".range").first.wait_for()
    kept = int(page.locator("#selected").text_content().split()[0].replace(",", ""))
    assert 3500 < kept < 4500  # 10 of 25 kN/m
    counted = [page.locator(f"#count-{k}").text_content() for k in range(3)]
    assert sum(int(text.replace(",", "")) for text in counted) == kept
    rates = page.locator("#rows tbody tr td:nth-child(4)").all_text_contents()
    assert len(rates) == 15 and all(float(text) >= 30.0 for text in rates)
    page.locator("#clear").click()
    page.locator(".range").wait_for(state="detached")
    assert tab.errors == [] and tab.outside == []
    assert tab.evaluate("window.broken") is None
    assert tab.evaluate("document.documentElement.scrollWidth") <= width


def test_a_drag_along_an_axis_selects_and_a_click_releases(made: Path, tab: Tab) -> None:
    tab.open(made / PAGE, 1440, 900)
    page = tab.page
    page.locator("#rows tbody tr").first.wait_for()
    canvas = page.locator("#axes canvas")
    canvas.scroll_into_view_if_needed()
    box = canvas.bounding_box()
    x, y = box["x"] + 64, box["y"]
    page.mouse.move(x, y + 100)
    page.mouse.down()
    page.mouse.move(x, y + 150, steps=3)
    page.mouse.up()
    page.locator(".range").first.wait_for()
    assert not page.locator("#selected").text_content().startswith("10,000")
    page.mouse.click(x, y + 300)
    page.locator(".range").wait_for(state="detached")
    assert page.locator("#selected").text_content().startswith("10,000")


def test_a_kept_design_is_linked_to_its_report(made: Path, tab: Tab) -> None:
    tab.open(made / PAGE, 1440, 900)
    page = tab.page
    page.locator("#rows tbody tr").first.wait_for()
    links = json.loads(page.locator("#study-data").text_content())["links"]
    assert links == {"3": f"runs/{3:024x}/8_report.html"}
