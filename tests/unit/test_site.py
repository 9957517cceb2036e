"""The documentation site before its generator runs: pages, links, references, turning cams."""

from __future__ import annotations

import re
import sys
import xml.etree.ElementTree as ET
from html import escape
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))
import build_site
import site_reference
from site_figures import Figures
from site_gallery import GROUPS, NO_CASE, about, case_files
from site_pictures import STEPS, TurningCam, chart, over_cam, swinging_cam, turning_cam

import camwright
from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.figures import LimitLine
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.commands.command_tree import TREE

ROOT = Path(__file__).parents[2]
LINK = re.compile(r"\]\((?!https?:)([^)\s]*?)(?:#([^)\s]+))?\)")
NAVIGATION = re.compile(r"^```\{toctree\}\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^(`{3,}|:{3,}).*?^\1$", re.MULTILINE | re.DOTALL)


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    """Pages of the site but for the gallery, which needs the shipped cases solved."""
    return build_site.texts()


@pytest.fixture(scope="module")
def lift() -> Lift:
    theta = uniform_turn(180)
    return Lift(theta, 5e-3 * (1.0 - np.cos(theta)))


def anchors(text: str) -> set[str]:
    titles = re.findall(r"^#+ (.+)$", CODE.sub("", text), re.MULTILINE)
    return {site_reference.slug(title) for title in titles}


def test_every_page_is_in_the_navigation(pages: dict[str, str]) -> None:
    listed = {"index"}
    for name, text in pages.items():
        for tree in NAVIGATION.findall(text):
            words = [line for line in tree.splitlines() if line and not line.startswith(":")]
            folder = Path(name).parent
            listed |= {(folder / word).as_posix() for word in words}
    assert listed - {"gallery"} == {name.removesuffix(".md") for name in pages}


def test_every_link_leads_to_a_heading(pages: dict[str, str]) -> None:
    known = {name: anchors(text) for name, text in pages.items()} | {"gallery.md": set()}
    files = {"notebook.ipynb", "images/contact.png"}
    wrong = []
    for name, text in pages.items():
        for target, anchor in LINK.findall(CODE.sub("", text)):
            there = (ROOT / name).parent.joinpath(target).resolve() if target else ROOT / name
            page = there.relative_to(ROOT).as_posix()
            if page in files:
                continue
            if page not in known or (anchor and anchor not in known[page]):
                wrong.append((name, target, anchor))
    assert wrong == []


def test_no_page_has_the_name_of_one_of_the_generator(pages: dict[str, str]) -> None:
    assert not {"search.md", "genindex.md"} & set(pages)


def test_no_mark_of_a_table_is_left(pages: dict[str, str]) -> None:
    assert [name for name, text in pages.items() if "<!-- table" in text] == []


def test_every_check_key_and_command_has_its_place(pages: dict[str, str]) -> None:
    split = site_reference.split_checks((ROOT / "docs" / "checks.md").read_text(encoding="utf-8"))
    places = site_reference.check_links(split.places)
    assert list(places) == [each.id for each in CHECKS]
    for name, place in places.items():
        page, _, anchor = place.partition("#")
        assert anchor in anchors(pages[page]), name
    tables = re.findall(
        r"^### (.+)$",
        (ROOT / "docs" / "case-file.md").read_text(encoding="utf-8").split("## Every key")[1],
        re.MULTILINE,
    )
    shown = [title for name, text in pages.items() if name.startswith("keys/")
             for title in re.findall(r"^## (.+)$", text, re.MULTILINE)]  # fmt: skip
    assert sorted(shown) == sorted(tables)
    headings = re.findall(r"^## `camwright (.+)`$", pages["commands.md"], re.MULTILINE)
    assert headings == list(TREE)


def test_every_public_name_is_in_the_python_reference(pages: dict[str, str]) -> None:
    text = pages["api/functions.md"] + pages["api/classes.md"]
    assert sorted(re.findall(r"^## `(\w+)`$", text, re.MULTILINE)) == sorted(camwright.__all__)


def test_a_docstring_is_read_by_its_columns() -> None:
    text = site_reference.Docstring("""Width of a contact.

    Parameters
    ----------
    load : array (...)     P', N/m, > 0;
                           a line load
    options   see `Case`

    Raises
    ------
    InputError
        If a value is `NaN`.
    """)
    assert text.prose == "Width of a contact."
    assert text.entries("Parameters") == [
        ("load", "array (...)", "P', N/m, > 0; a line load"), ("options", "", "see `Case`"),
    ]  # fmt: skip
    assert text.entries("Raises") == [("InputError", "", "If a value is `NaN`.")]


def test_every_figure_of_a_page_is_drawn() -> None:
    used = set(re.findall(r"<!-- figure: (\w+) -->", (ROOT / "docs" / "steps.md").read_text()))
    assert used == {
        name for name in vars(Figures) if not name.startswith("_") and name not in ("drawn", "html")
    }


def test_the_gallery_has_every_shipped_case() -> None:
    files = case_files(ROOT)
    shipped = {path for path in (ROOT / "cases").rglob("*.toml") if path.stem not in NO_CASE}
    assert set(files) == shipped and len(files) == len({file.stem for file in files})
    assert {file.parent.name for file in files} == {"cases", *GROUPS} - {""}
    for file in files:
        assert len(about(file.read_text(encoding="utf-8")).split()) >= 5, file


@pytest.mark.parametrize("kind", ["roller", "face"])
def test_a_turning_cam_touches_its_follower(kind: str, lift: Lift) -> None:
    contour: Contour
    if kind == "roller":
        contour = RollerContour(PitchCurve(lift, 0.03, 0.004), 0.01)
    else:
        contour = FlatFaceContour(FacePath(lift, 0.03))
    cam = TurningCam.of(contour, points=3600)
    for step in range(0, STEPS, 7):
        turn = 0.5 * np.pi - uniform_turn(STEPS)[step]
        x, y = cam.outline
        across, up = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
        if kind == "roller":
            gap = np.hypot(across - cam.axis, up - cam.height[step]).min() - cam.roller
        else:
            gap = cam.height[step] - up.max()
        assert gap == pytest.approx(0.0, abs=1e-4)  # mm, of the polygon


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_an_arm_swings_on_its_pivot_onto_the_turning_cam(sense: float, lift: Lift) -> None:
    """Places and turns of the picture, y downward, read back from it."""
    contour = ArmContour(ArmPath(lift, Arm(0.06, 0.05, sense), 0.6), 0.01)
    text = swinging_cam(contour, 0.005, "one", "a < b")
    ET.fromstring(text)
    turns = [float(each) for each in re.findall(r"rotate\(([-\d.e]+)deg\)", text)][:-1]
    assert len(turns) == STEPS
    x, y = 1e3 * contour.polygon(3600)
    for step in range(0, STEPS, 7):
        turn, swung = 0.5 * np.pi - uniform_turn(STEPS)[step], np.radians(turns[step])
        across, up = x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)
        centre = -50.0 * np.sin(swung), 60.0 - 50.0 * np.cos(swung)
        gap = np.hypot(across - centre[0], up - centre[1]).min() - 10.0
        assert gap == pytest.approx(0.0, abs=5e-3)  # mm, of four digits of an angle


def test_a_turning_cam_is_an_svg_that_keeps_still_where_motion_is_reduced(lift: Lift) -> None:
    contour = RollerContour(PitchCurve(lift, 0.03), 0.01)
    text = turning_cam(TurningCam.of(contour, 0.005), "one", "a < b")
    root = ET.fromstring(text)
    assert root.get("aria-label") == "a < b" and root.get("id") == "one"
    assert "@keyframes lift-one" in text and text == turning_cam(
        TurningCam.of(contour, 0.005), "one", "a < b"
    )
    style = (ROOT / "docs" / "site" / "static" / "site.css").read_text(encoding="utf-8")
    reduced = r"prefers-reduced-motion: reduce\) \{ \.turning-cam [^{]+\{ animation: none"
    assert re.search(reduced, style)


def test_a_chart_over_the_cam_angle_has_its_ticks_curves_and_words() -> None:
    theta = uniform_turn(36)
    curves = [("one", np.sin(theta)), ("two", theta)]
    figure = over_cam("lift", "Lift < 400", "lift", "mm", curves, (LimitLine(5.0, "limit"),))
    svg, _, words = chart(figure).partition("<span")
    picture = ET.fromstring(svg)
    texts = {each.text for each in picture.iter("{http://www.w3.org/2000/svg}text")}
    assert {"0", "90", "180", "270", "360", "limit 5 mm", "one", "two", "lift, mm"} <= texts
    assert picture.get("aria-labelledby") == "lift-alt"
    assert words == f' id="lift-alt" hidden>{escape(figure.alt)}</span>'
    assert "Lift < 400" in figure.alt


def test_a_missing_generator_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = build_site.importlib.util.find_spec
    monkeypatch.setattr(
        build_site.importlib.util, "find_spec",
        lambda name: None if name in build_site.GENERATOR else found(name),
    )  # fmt: skip
    assert build_site.main([]) == 2
    line = capsys.readouterr().err
    assert line.count("\n") == 1 and "pip install -e '.[docs]'" in line
