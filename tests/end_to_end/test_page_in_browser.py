"""The page in a real browser: every plot drawn, hover, keyboard, no scroll sideways, PDF."""

from __future__ import annotations

import itertools
import re
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture

from camwright.reports import browser, interactive, page
from camwright.reports.report_data import read_material

ALL_DRAWN = "[...document.querySelectorAll('.live')].every(e => e.dataset.drawn === 'done')"
PLACE = """(() => { const r = document.querySelector('#pressure .live .nsewdrag')
    .getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; })()"""
BYTES_MAX = 8 << 20
HOSTILE = "<script>window.broken=1</script>\"'&../\u202eעברית\U0001f600 </script><!--"


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("browser") / "run"
    report_fixture.write_run(folder, title=HOSTILE)
    return report_fixture.page_of(folder)


@pytest.fixture(scope="module")
def tab():
    if browser.executable() is None:
        pytest.skip("no Chromium here: Debian has it in the package chromium")
    with browser.tab() as opened:
        yield opened


def test_page_is_small_and_asks_nothing_of_the_network(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    assert report.stat().st_size <= BYTES_MAX
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy and "default-src 'none'" in policy[1] and "unsafe-eval" not in policy[1]
    assert not re.search(r"<(script|link|img|iframe)[^>]+(src|href)=.?https?:", text)


@pytest.mark.parametrize("width", [390, 1440])
def test_every_plot_is_drawn_and_answers(report: Path, tab: browser.Tab, width: int) -> None:
    tab.events.clear()
    tab.size(width, 900)
    tab.open(report)
    tab.wait(ALL_DRAWN)
    assert tab.evaluate("document.querySelectorAll('.live').length") >= 10
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    names = "[...document.querySelectorAll('#pressure .live .annotation')].map(e => e.textContent)"
    assert {"intake", "compression", "expansion", "exhaust"} <= set(tab.evaluate(names))
    tab.evaluate("document.getElementById('pressure').scrollIntoView({behavior: 'instant'})")
    x, y, wide, high = tab.evaluate(PLACE)
    for share in (0.3, 0.4):
        tab.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + share * wide, y=y + high / 2)
        time.sleep(0.2)
    tab.wait("document.querySelector('#pressure .hoverlayer').textContent.includes('MPa')", 10)
    tab.evaluate("document.querySelector('#pressure .live').focus()")
    tab.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowRight", code="ArrowRight",
             windowsVirtualKeyCode=39)  # fmt: skip
    said = tab.evaluate("document.querySelector('#pressure .told-values').textContent")
    assert said.startswith("cam angle") and "MPa" in said
    assert tab.complaints() == []
    assert tab.evaluate("window.broken") is None
    assert "עברית" in tab.evaluate("document.querySelector('h1').textContent")


def test_a_screen_reader_finds_its_way(report: Path, tab: browser.Tab) -> None:
    """Headings in order, a name for every picture, and tables that stay tables on a telephone."""
    tab.size(390, 900)
    tab.open(report)
    tab.wait(ALL_DRAWN)
    nodes = [node for node in tab.call("Accessibility.getFullAXTree")["nodes"]
             if not node.get("ignored")]  # fmt: skip
    by_role: dict[str, list[dict]] = {}
    for node in nodes:
        by_role.setdefault(node["role"]["value"], []).append(node)
    levels = [
        next(p["value"]["value"] for p in node["properties"] if p["name"] == "level")
        for node in by_role["heading"]
    ]
    assert levels[0] == 1 and levels.count(1) == 1
    assert all(after <= before + 1 for before, after in itertools.pairwise(levels))
    for role in ("heading", "image", "link", "region", "table"):
        assert all(node["name"]["value"].strip() for node in by_role.get(role, [])), role
    assert "SvgRoot" not in by_role  # or every tick of every plot would be read out
    checks = len(report_fixture.checks())
    assert len(by_role["row"]) > checks
    assert len(by_role["rowheader"]) >= checks
    reached = [name for name in ("main", "navigation") if name in by_role]
    assert reached == ["main", "navigation"]
    lacking = "[...document.querySelectorAll('.live')].filter(e => e.tabIndex !== 0).length"
    assert tab.evaluate(lacking) == 0


def test_print_shows_the_still_drawings(report: Path, tab: browser.Tab) -> None:
    tab.size(800, 1100)
    tab.open(report)
    tab.wait(ALL_DRAWN)
    tab.call("Emulation.setEmulatedMedia", media="print")
    shown = "[...document.querySelectorAll('{}')].filter(e => e.offsetParent !== null).length"
    stills = tab.evaluate(shown.format(".still"))
    assert tab.evaluate(shown.format(".live")) == 0
    assert stills == tab.evaluate("document.querySelectorAll('.live').length")
    tab.call("Emulation.setEmulatedMedia", media="")


def test_json_in_the_page_cannot_end_its_script() -> None:
    text = interactive.script_safe_json({"a": "</script><!--&"})
    assert not set("<>&") & set(text)


def test_page_for_print_is_whole_without_scripts(report: Path) -> None:
    text = page.text(read_material(report.parent), live=False).decode()
    assert "<script" not in text and "Point at a curve" not in text
    assert text.count("<svg") >= 10
