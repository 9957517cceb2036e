"""The page in a real browser: every plot drawn, hover, keyboard, no scroll sideways, PDF."""

from __future__ import annotations

import itertools
import re
import shutil
import subprocess
import sys
import time
import tomllib
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import live_settings
import report_fixture
from browser_fixture import Tab, chromium

from camwright.pipeline.base.files import read_json
from camwright.pipeline.case.case_values import quantity_of
from camwright.pipeline.results import signoff
from camwright.pipeline.results.run_reader import LIVE
from camwright.pipeline.studies.batch.dataset import read_dataset
from camwright.reports import interactive

UNDRAWN = ".live:not([data-drawn='done'])"
BYTES_MAX = 5_000_000
HOSTILE = "<script>window.broken=1</script>\"'&../\u202eעברית\U0001f600 </script><!--"


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("browser") / "run"
    report_fixture.write_run(folder, title=HOSTILE)
    live_settings.write_in(folder, (each["id"] for each in report_fixture.checks()))
    signoff.write(folder)
    return report_fixture.page_of(folder)


@pytest.fixture(scope="module")
def tab() -> Iterator[Tab]:
    with chromium() as opened:
        yield opened


@pytest.fixture(scope="module")
def desktop(report: Path, tab: Tab) -> Tab:
    """The page drawn in a window of 1300 by 900, in a tab of its own; tests leave its size."""
    return drawn_in_new_tab(tab, report, 1300)


@pytest.fixture(scope="module")
def telephone(report: Path, tab: Tab) -> Tab:
    """The page drawn in a window of 390 by 900."""
    return drawn_in_new_tab(tab, report, 390)


def drawn_in_new_tab(tab: Tab, file: Path, width: int) -> Tab:
    another = Tab(tab.page.context.browser.new_page())
    open_and_draw(another, file, width, 900)
    return another


def open_and_draw(tab: Tab, file: Path, width: int, height: int) -> None:
    """Open the page and wait for its plots."""
    tab.open(file, width, height)
    tab.page.locator(UNDRAWN).first.wait_for(state="detached")


MISFIT = """Math.max(...[...document.querySelectorAll('.live')].map(place =>
    Math.abs(place.querySelector('.main-svg').getBoundingClientRect().width - place.clientWidth)))
"""


def resize(tab: Tab, width: int) -> None:
    """Change the width of the window and wait until every plot has that of its place."""
    tab.page.set_viewport_size({"width": width, "height": 900})
    for _ in range(100):  # the page forbids what Playwright's own waiting evaluates
        if tab.evaluate(MISFIT) <= 1.0:
            return
        tab.page.wait_for_timeout(50.0)
    pytest.fail(f"{width} px wide: a plot is {tab.evaluate(MISFIT)} px off its place")


def test_page_is_small_and_asks_nothing_of_the_network(report: Path) -> None:
    text = report.read_text(encoding="utf-8")
    assert report.stat().st_size <= BYTES_MAX
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', text)
    assert policy and "default-src 'none'" in policy[1] and "unsafe-eval" not in policy[1]
    assert not re.search(r"<(script|link|img|iframe)[^>]+(src|href)=.?https?:", text)


@pytest.mark.parametrize(("shown", "width"), [("telephone", 390), ("desktop", 1300)])
def test_every_plot_is_drawn_and_answers(
    request: pytest.FixtureRequest, shown: str, width: int
) -> None:
    tab = request.getfixturevalue(shown)
    page = tab.page
    assert page.locator(".live").count() >= 10
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    names = page.locator("#pressure .live .annotation").all_text_contents()
    assert {"intake", "compression", "expansion", "exhaust"} <= set(names)
    plot = page.locator("#pressure .live .nsewdrag").first
    plot.scroll_into_view_if_needed()
    place = plot.bounding_box()
    for share in (0.3, 0.4):
        page.mouse.move(place["x"] + share * place["width"], place["y"] + 0.5 * place["height"])
        time.sleep(0.2)
    page.locator("#pressure .hoverlayer", has_text="MPa").first.wait_for(state="attached")
    page.locator("#pressure .live").focus()
    page.keyboard.press("ArrowRight")
    assert page.get_by_text("Point at a curve").is_visible()
    readout = page.locator("#pressure .readout").text_content()
    assert readout.startswith("cam angle") and "MPa" in readout
    assert tab.errors == []
    assert tab.outside == []
    assert tab.evaluate("window.broken") is None
    assert "עברית" in page.locator("h1").text_content()


def test_a_screen_reader_finds_its_way(telephone: Tab) -> None:
    """Headings in order, a name for every picture, and tables that stay tables on a telephone."""
    tab = telephone
    tree = tab.page.context.new_cdp_session(tab.page).send("Accessibility.getFullAXTree")
    nodes = [node for node in tree["nodes"] if not node.get("ignored")]
    by_role: dict[str, list[dict]] = {}
    for node in nodes:
        by_role.setdefault(node["role"]["value"], []).append(node)
    levels = tab.evaluate(
        "[...document.querySelectorAll('h1, h2, h3, h4, h5')].map(e => Number(e.tagName[1]))"
    )
    assert len(levels) == len(by_role["heading"])
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


def test_the_first_screen_has_verdict_drawing_chart_and_remedy(desktop: Tab) -> None:
    tab = desktop
    tab.evaluate("window.scrollTo(0, 0)")
    floor = tab.page.locator("#turning").bounding_box()["y"]
    for part in ("#verdict", ".mechanism svg", ".uses-chart", ".remedies li >> nth=0"):
        box = tab.page.locator(part).bounding_box()
        assert box["y"] >= 0 and box["y"] + box["height"] <= floor, part


@pytest.mark.parametrize(
    "widths", [(400, 835, 1440), pytest.param((721, 950, 961, 1300), marks=pytest.mark.slow)]
)
def test_nothing_overflows_and_titles_of_checks_stay_readable(
    telephone: Tab, widths: tuple[int, ...]
) -> None:
    """On a page opened at 390 px and widened."""
    tab = telephone
    narrowest = (
        "Math.min(...[...document.querySelectorAll('#checks tbody th')].map(e => e.offsetWidth))"
    )
    for width in widths:
        resize(tab, width)
        assert tab.evaluate("document.documentElement.scrollWidth") <= width
        assert tab.evaluate(narrowest) >= 240, width
    resize(tab, 390)


def test_the_slider_turns_the_cam_by_keyboard(desktop: Tab) -> None:
    """The drawing moves, and a cursor marks the angle in every figure over the turn."""
    tab = desktop
    page = tab.page
    cam, follower = (page.locator(f"[data-part='{name}']") for name in ("cam", "follower"))
    before = [part.get_attribute("transform") for part in (cam, follower)]
    page.locator("#angle").focus()
    page.keyboard.press("Home")
    page.keyboard.press("ArrowRight")
    words = page.locator("#angle-words").text_content()
    assert words == page.locator("#angle").get_attribute("aria-valuetext")
    angle = float(re.search(r"cam ([\d.]+)°", words)[1])
    shaft = float(re.search(r"crank ([\d.]+)°", words)[1])
    turned = float(re.search(r"rotate\(([-\d.]+)\)", cam.get_attribute("transform"))[1])
    assert turned == pytest.approx(angle - 90.0, abs=0.06)
    assert [part.get_attribute("transform") for part in (cam, follower)] != before
    assert page.locator("[data-value='angle']").text_content() in words
    places = tab.evaluate(
        """[...document.querySelectorAll('.cursor')].map(line => {
             const full = line.parentNode._fullLayout, size = full._size;
             return [(parseFloat(line.style.left) - size.l) / size.w, full.xaxis.range[1]]; })"""
    )
    assert len(places) >= 8
    for share, period in places:
        assert share == pytest.approx(shaft / period, abs=1e-3)
    figures = "[...document.querySelectorAll('.live')].filter(p => p._fullLayout.xaxis2).length"
    assert len(places) == tab.evaluate(figures)


LIVE_MS = 50.0
STATUS = "#live-status"


def test_the_live_preview_follows_by_keyboard(desktop: Tab, report: Path) -> None:
    """Its figures are those of the record, read by another program; each change is soon done."""
    page, record = desktop.page, read_json(report.parent / LIVE)
    settings = np.random.default_rng(5).uniform(size=(20, len(record["factors"])))
    ends = np.array([(each["low"], each["high"]) for each in record["factors"]])
    for multiples in np.exp(np.log(ends[:, 0]) + settings * np.log(ends[:, 1] / ends[:, 0])):
        values = [m * next(iter(f["keys"].values()))
                  for m, f in zip(multiples, record["factors"], strict=True)]  # fmt: skip
        shown = page.evaluate(
            "values => { const { all, names } = window.livePreview, made = all(values).figures;"
            " return names.map((name, k) => [name, made[k].value ?? null, made[k].error ?? null,"
            " made[k].doubt]); }",
            values,
        )
        expected = live_settings.values(record, multiples)
        assert len(shown) >= 10
        for name, value, error, doubt in shown:
            assert bool(doubt or value is None) == (not expected[name].holds), name
            if expected[name].holds:
                assert value == pytest.approx(expected[name].value, rel=1e-9, abs=1e-12), name
                assert error == pytest.approx(expected[name].error, rel=1e-9, abs=1e-12), name
    force = page.locator("[data-quantity='contact_force'] [data-cell='value']")
    before = force.text_content()
    page.locator("#live-0").focus()
    for _ in range(20):
        page.keyboard.press("ArrowRight")
    assert float(force.text_content()) > float(before)
    assert page.locator("#live-0-value").input_value() in page.locator("#live-0").get_attribute(
        "aria-valuetext"
    )
    took = page.evaluate(
        "() => { const slider = document.getElementById('live-0'), began = performance.now();"
        " for (let k = 0; k < 20; k++) { slider.value = 5 * k;"
        " slider.dispatchEvent(new Event('input')); document.body.offsetHeight; }"
        " return (performance.now() - began) / 20; }"
    )
    assert took <= LIVE_MS
    page.locator("#live-reset").focus()
    page.keyboard.press("Enter")
    assert force.text_content() == before
    assert "no verdict" in page.locator(STATUS).text_content()


def test_the_live_preview_says_where_it_does_not_hold(desktop: Tab) -> None:
    """Outside the fitted range there is no figure, and load cases without contact are named."""
    page = desktop.page
    entry = page.locator("#live-0-value")
    run = entry.input_value()
    assert "leaves the cam: over-speed" in page.locator(STATUS).text_content()
    checks = page.locator("#live [data-quantity]:has([data-cell='safety'])")
    values = checks.locator("[data-cell='value']").all_text_contents()
    valued = len(values) - values.count("–")
    words = re.search(r"of (\d+) followed checks[^.]*", page.locator(STATUS).text_content())
    assert int(words[1]) == valued > 0
    assert ("without a value" in words[0]) == (valued < len(values))
    entry.fill(str(3.0 * float(run)))
    assert "Outside the fitted range" in page.locator(STATUS).text_content()
    assert set(page.locator("#live [data-cell='value']").all_text_contents()) == {"–"}
    entry.fill(run)
    assert "–" not in page.locator("#live [data-cell='value']").all_text_contents()


def test_the_changes_of_the_live_preview_are_a_study(desktop: Tab, tmp_path: Path) -> None:
    """The study of the page solves the changed design, whose ripple is that of the page."""
    page = desktop.page
    page.locator("#live-0-value").fill("280")
    ripple = page.locator("[data-quantity='torque_ripple']")
    value, error = (ripple.locator(f"[data-cell='{name}']").text_content()
                    for name in ("value", "error"))  # fmt: skip
    page.locator("#live-show").focus()
    page.keyboard.press("Enter")
    toml, command = page.locator("#live-toml pre").all_text_contents()
    page.locator("#live-reset").click()
    assert command == "camwright study run changes.toml --out changes"
    study = tomllib.loads(toml)
    assert study["case"] == "run/case.toml"
    assert [each["key"] for each in study["factor"]] == ["spring.preload"]
    assert all(quantity_of(each["key"]) is not None for each in study["factor"])
    (tmp_path / "run").mkdir()
    shutil.copy(live_settings.CASES / "gx120.toml", tmp_path / study["case"])
    (tmp_path / "changes.toml").write_text(toml)
    pytest.importorskip("dask")
    command = [sys.executable, "-m", "camwright", *command.split()[1:]]
    made = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert made.returncode in (0, 1), made.stderr
    solved = list(read_dataset(tmp_path / "changes")["headline.torque_std_after_Nm"])
    assert solved == [pytest.approx(float(value), abs=2.0 * float(error.removeprefix("± ")))]


def test_the_filters_of_the_checks_work_by_keyboard(desktop: Tab) -> None:
    page = desktop.page
    shown = page.locator("#all-checks tbody tr:visible")
    every = shown.count()
    page.locator("[name=status]").focus()
    page.keyboard.type("pass")
    assert {row.get_attribute("data-status") for row in shown.all()} == {"pass"}
    passed = shown.count()
    assert 0 < passed < every
    assert page.locator(".filters output").text_content() == f"{passed} checks"
    page.keyboard.press("Tab")
    page.keyboard.type("Guides")
    assert {row.get_attribute("data-part") for row in shown.all()} <= {"Guides"}
    page.keyboard.press("Home")
    assert shown.count() == passed


@pytest.mark.parametrize(
    ("width", "scheme"),
    [
        (400, "light"),
        *(
            pytest.param(*each, marks=pytest.mark.slow)
            for each in ((400, "dark"), (1300, "light"), (1300, "dark"))
        ),
    ],
)
def test_axe_finds_nothing(report: Path, tab: Tab, width: int, scheme: str) -> None:
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    context = tab.page.context.browser.new_context(
        viewport={"width": width, "height": 900}, color_scheme=scheme, bypass_csp=True
    )  # the policy of the page refuses every script but its own
    page = context.new_page()
    page.goto(report.resolve().as_uri())
    page.locator(UNDRAWN).first.wait_for(state="detached")
    violations = axe.run(page).response["violations"]
    context.close()
    assert [(each["id"], each["nodes"][0]["html"]) for each in violations] == []


def test_figures_survive_a_change_of_colour_scheme_and_size_together(
    report: Path, tab: Tab
) -> None:
    open_and_draw(tab, report, 1300, 900)
    page = tab.page
    page.emulate_media(color_scheme="dark")
    page.set_viewport_size({"width": 420, "height": 900})
    page.wait_for_timeout(4000)
    state = tab.evaluate(
        """[...document.querySelectorAll('.live')].map(place => {
             const svg = place.querySelector('.main-svg').getBoundingClientRect();
             const legend = place.querySelector('.infolayer > .legend');
             const plot = place.querySelector('.nsewdrag').getBoundingClientRect();
             const low = legend ? legend.getBoundingClientRect().bottom : 0;
             const tick = place.querySelector('.xtick text, .x2tick text');
             return { id: place.dataset.figure, over: svg.width - place.clientWidth,
                      curves: place.querySelectorAll('.trace').length,
                      clear: plot.top - low, fill: getComputedStyle(tick).fill }; })"""
    )
    page.emulate_media(color_scheme="light")
    assert len(state) >= 10
    for each in state:
        assert abs(each["over"]) <= 1, each
        assert each["curves"] >= 1, each
        assert each["clear"] >= 0, each
        assert each["fill"] == "rgb(230, 233, 237)", each  # --ink of the dark theme
    assert tab.errors == []


def test_print_shows_the_still_drawings(desktop: Tab) -> None:
    tab = desktop
    tab.page.emulate_media(media="print")
    shown = "[...document.querySelectorAll('{}')].filter(e => e.offsetParent !== null).length"
    stills = tab.evaluate(shown.format(".still"))
    assert tab.evaluate(shown.format(".live")) == 0
    assert stills == tab.page.locator(".live").count()
    tab.page.emulate_media(media="screen")


def test_json_in_the_page_cannot_end_its_script() -> None:
    text = interactive.script_safe_json({"a": "</script><!--&"})
    assert not set("<>&") & set(text)


def test_page_is_whole_without_scripts(report: Path, tab: Tab) -> None:
    silent = tab.page.context.browser.new_context(java_script_enabled=False)
    page = silent.new_page()
    page.goto(report.as_uri())
    stills = page.locator(".still svg")
    assert stills.count() >= 10
    assert all(still.is_visible() for still in stills.all())
    assert not page.get_by_text("Point at a curve").is_visible()
    silent.close()
