"""The documentation site, built and looked at: links, search, accessibility, width, motion."""

from __future__ import annotations

import hashlib
import re
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))
import build_site
from browser_fixture import Tab, chromium

pytestmark = pytest.mark.slow
ONE_OF_A_KIND = (
    *("index", "tutorial", "tutorials/contact", "gallery", "gallery/gx120", "steps", "checks"),
    *("checks/cam_shape", "keys/engine", "commands", "api/functions", "run-folder", "search"),
)
"""Pages of every form."""
BYTES_MAX = 20_000_000


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("sphinx", reason="the extra `docs` is not installed")
    folder = tmp_path_factory.mktemp("site")
    assert build_site.main([str(folder)]) == 0
    return folder / "site"


@pytest.fixture(scope="module")
def files(site: Path) -> list[Path]:
    return sorted(site.rglob("*.html"))


@pytest.fixture(scope="module")
def tab() -> Iterator[Tab]:
    with chromium() as opened:
        yield opened


class Page(HTMLParser):
    """Anchors, links and files of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        known = {name: value or "" for name, value in attrs}
        if "id" in known:
            self.anchors.add(known["id"])
        self.links += [known[name] for name in ("href", "src") if name in known]


def test_no_link_is_broken_and_none_loads_from_outside(files: list[Path]) -> None:
    pages = {file.resolve(): Page(file.read_text(encoding="utf-8")) for file in files}
    wrong = []
    for file, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme in ("http", "https", "mailto", "data"):
                continue
            there = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            anchor = unquote(parts.fragment)
            if not there.is_file() or (anchor and there in pages
                                       and anchor not in pages[there].anchors):  # fmt: skip
                wrong.append((file.name, link))
    assert wrong == []


def test_the_site_is_small_and_the_same_each_time(site: Path, tmp_path: Path) -> None:
    assert sum(file.stat().st_size for file in site.rglob("*") if file.is_file()) <= BYTES_MAX
    assert build_site.main([str(tmp_path)]) == 0
    assert hashes(tmp_path / "site") == hashes(site)


def hashes(folder: Path) -> dict[str, str]:
    return {
        file.relative_to(folder).as_posix(): hashlib.sha256(file.read_bytes()).hexdigest()
        for file in sorted(folder.rglob("*"))
        if file.is_file()
    }


@pytest.mark.parametrize("width", [400, 1400])
def test_every_page_fits_and_logs_no_error(width: int, files: list[Path], tab: Tab) -> None:
    wrong = []
    for file in files:
        tab.open(file, width, 900)
        if tab.evaluate("document.documentElement.scrollWidth") > width:
            wrong.append((file.name, "wider than the window"))
        wrong += [(file.name, each) for each in (*tab.errors, *tab.outside)]
    assert wrong == []


@pytest.mark.parametrize(
    ("width", "scheme"), [(400, "light"), (400, "dark"), (1400, "light"), (1400, "dark")]
)
def test_axe_finds_nothing(width: int, scheme: str, site: Path, tab: Tab) -> None:
    axe = pytest.importorskip("axe_playwright_python.sync_playwright").Axe()
    context = tab.page.context.browser.new_context(
        viewport={"width": width, "height": 900}, color_scheme=scheme, reduced_motion="reduce"
    )
    page = context.new_page()
    found = []
    for name in ONE_OF_A_KIND:
        page.goto((site / f"{name}.html").as_uri())
        violations = axe.run(page).response["violations"]
        found += [(name, each["id"], each["nodes"][0]["html"]) for each in violations]
    context.close()
    assert found == []


@pytest.mark.parametrize(
    ("words", "page"), [("jam_index", "checks/jump_and_jamming"), ("crown", "tutorials/crown")]
)
def test_the_search_works_without_a_network(words: str, page: str, site: Path, tab: Tab) -> None:
    tab.page.set_viewport_size({"width": 1400, "height": 900})
    tab.page.goto(f"{(site / 'search.html').as_uri()}?q={words}")
    tab.page.locator("#search-results li a").first.wait_for()
    tab.page.get_by_text("Search finished").first.wait_for()
    links = [each.get_attribute("href") for each in tab.page.locator("#search-results li a").all()]
    assert any(page in (link or "") for link in links)
    assert tab.outside == []


def test_the_cams_turn_and_can_be_stopped(site: Path, tab: Tab) -> None:
    tab.open(site / "gallery.html", 1400, 900)
    page = tab.page
    assert page.locator("ul.cams li").count() >= 20
    cam = page.locator(".turning-cam .turned").first
    angles = []
    for _ in range(2):
        angles.append(cam.evaluate("e => getComputedStyle(e).transform"))
        page.wait_for_timeout(400)
    assert angles[0] != angles[1]
    button = page.get_by_role("button", name="Stop the cams")
    button.focus()
    page.keyboard.press("Enter")
    state = "e => getComputedStyle(e).animationPlayState"
    assert cam.evaluate(state) == "paused"
    page.get_by_role("button", name="Turn the cams").click()
    assert cam.evaluate(state) == "running"
    assert page.locator(".turning-cam .turned").last.evaluate(state) == "paused"  # out of sight


def test_the_cams_stand_still_where_motion_is_reduced(site: Path, tab: Tab) -> None:
    context = tab.page.context.browser.new_context(reduced_motion="reduce")
    page = context.new_page()
    page.goto((site / "gallery.html").as_uri())
    names = "[...document.querySelectorAll('.turned')].map(e => getComputedStyle(e).animationName)"
    assert set(page.evaluate(names)) == {"none"}
    assert page.locator("button.pause").count() == 0
    context.close()


def test_it_is_whole_without_scripts(site: Path, tab: Tab) -> None:
    context = tab.page.context.browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.goto((site / "gallery" / "gx120.html").as_uri())
    assert page.locator(".turning-cam").first.is_visible()
    assert page.locator(".charts svg").count() >= 4
    assert re.search(r"\d", page.locator(".beside table").inner_text())
    context.close()
