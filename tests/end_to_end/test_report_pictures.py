"""Pictures of the stress field off screen, and the page in a real browser."""

from __future__ import annotations

import io
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread

sys.path.insert(0, str(Path(__file__).parents[1]))
import report_fixture
from browser_fixture import chromium

from camwright.geometry.errors import ResultError
from camwright.pipeline.results.field_file import MeshBlock, field_file
from camwright.reports import field_picture, picture_list, sections
from camwright.reports.painting import field_painter


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return report_fixture.write_run(tmp_path_factory.mktemp("run"), positions=180)


@pytest.fixture(scope="module")
def built(folder):
    return report_fixture.page_of(folder)


@pytest.fixture(scope="module")
def contact(folder):
    """Field, contact point, normal (from the contour) and half-width at the worst angle."""
    t = report_fixture.turn(180)
    g = report_fixture.shape(t)
    cycle = report_fixture.cycle_columns(t, g)
    worst = int(np.argmax(cycle["p0_fe_MPa"]))
    field = field_picture.read_field(folder / picture_list.FIELD)
    point, normal = g["contour"][:, worst] * 1e3, g["normal"][:, worst]
    return field, point, normal, float(cycle["half_width_hertz_mm"][worst])


@pytest.fixture(scope="module")
def rendered(contact):
    """Contact and whole bodies, rendered."""
    field, point, normal, half_width = contact
    view = field_picture.contact_view(field, half_width, point, normal)
    return field_picture.render(field, [view, field_picture.body_view(field)])


def test_contact_is_that_stated_in_the_file(contact):
    field, point, normal, half_width = contact
    found, direction = field_picture.find_contact(field)
    np.testing.assert_allclose(found, point, rtol=1e-12)
    np.testing.assert_allclose(direction, normal, rtol=1e-12)
    assert field.notes["half_width_mm"] == pytest.approx(half_width, rel=1e-12)
    with pytest.raises(ResultError, match="contact_x_mm"):
        field_picture.find_contact(replace(field, notes={}))


def test_outline_is_that_of_both_bodies(contact):
    field, *_ = contact
    ends = field.points[:, field.outline]
    length = np.hypot(*(ends[:, 0] - ends[:, 1]))
    roller = field.body[field.outline[0]] == 1
    rims = 2 * np.pi * 1e3 * (report_fixture.ROLLER + report_fixture.HUB)
    assert length[roller].sum() == pytest.approx(rims, rel=0.02)  # chords of the hub


def test_the_contact_view_puts_the_roller_above(contact):
    field, point, normal, half_width = contact
    view = field_picture.contact_view(field, half_width, point, normal)
    placed = view.placed(field.points)
    assert placed[1, field.body == 1].mean() > 0
    assert placed[1, field.body == 0].mean() < 0
    assert view.window[1] == pytest.approx(4 * half_width)
    np.testing.assert_allclose(view.placed(point[:, None]), 0.0, atol=1e-9)
    # von Mises peaks at 0.558 p0 below the surface of a line contact
    assert view.clim[1] == pytest.approx(0.5575 * 1088.9, rel=0.01)


def test_the_rendered_and_the_flat_picture_agree(contact, rendered):
    field, *_ = contact
    if rendered[0].note:
        pytest.skip("no OpenGL device, the flat picture is all there is")
    for raster in rendered:
        assert raster.pixels.shape == (raster.view.size[1], raster.view.size[0], 3)
    flat = field_picture.flat(field, rendered[0].view).pixels.astype(float)
    pixels = rendered[0].pixels.astype(float)
    shares = [0.1, 0.3, 0.42, 0.6, 0.85]

    def patch(image, down, across):
        row, column = int(down * image.shape[0]), int(across * image.shape[1])
        return image[row - 3 : row + 4, column - 3 : column + 4].mean(axis=(0, 1))

    def sampled(image):
        return np.array([patch(image, down, across) for down in shares for across in shares])

    # same colours at the same places: lines of the rendering darken a few samples slightly
    assert np.median(np.abs(sampled(flat) - sampled(pixels))) < 6.0


def test_without_opengl_the_page_says_so_and_still_shows_the_field(contact, monkeypatch):
    monkeypatch.setattr(field_picture, "WINDOWS", ("vtkNoSuchRenderWindow",))
    real = subprocess.run
    monkeypatch.setattr(
        field_painter.subprocess, "run",
        lambda command, **more: real([sys.executable, "-c", "raise SystemExit(139)"], **more),
    )  # fmt: skip
    field, point, normal, half_width = contact
    view = field_picture.contact_view(field, half_width, point, normal)
    raster = field_picture.render(field, [view])[0]
    assert "No OpenGL device" in raster.note
    middle = raster.pixels[raster.pixels.shape[0] // 2 + 80, raster.pixels.shape[1] // 2]
    assert np.ptp(middle.astype(float)) > 60  # a colour, not paper


def test_pictures_are_whole_png_files(contact, rendered):
    *_, half_width = contact
    png = field_picture.frame_contact(rendered[0], half_width)
    assert png.startswith(b"\x89PNG")
    image = imread(io.BytesIO(png), format="png")
    assert min(image.shape[:2]) > 500
    assert image[..., :3].std() > 0.1


def test_a_file_without_field_is_refused(tmp_path):
    with pytest.raises(ResultError, match="no such file"):
        field_picture.read_field(tmp_path / "none.vtkhdf")
    (tmp_path / "text.vtkhdf").write_text("no HDF5")
    with pytest.raises(ResultError, match=r"text.vtkhdf: not a field file"):
        field_picture.read_field(tmp_path / "text.vtkhdf")
    blocks = {"cam": MeshBlock(np.array([[0], [1], [2]]), 3, np.zeros((2, 3)))}
    with field_file(tmp_path / "bare.vtkhdf", [0.0], blocks, {}, {}):
        pass
    with pytest.raises(ResultError, match=r"bare.vtkhdf: no stress field .*p0_hertz_MPa"):
        field_picture.read_field(tmp_path / "bare.vtkhdf")


def test_the_page_carries_both_pictures_within_its_size(built):
    html = built.read_text(encoding="utf-8")
    # The two fields, and whatever rasters the plotting library carries for itself.
    own = re.sub(r"(?s)<script.*?</script>", "", html)
    assert own.count("data:image/png;base64,") == 2
    assert "Contact pressure and von Mises stress below the roller" in html
    assert built.stat().st_size < 8e6
    assert not (built.parent / "figures").exists()
    made = sections.report(built.parent, sections.chosen(["fields"]))["fields"]
    assert [path.name for path in made] == ["field-contact.png", "field-body.png"]
    assert all(path.is_file() for path in made)


@pytest.fixture(scope="module")
def tab():
    with chromium() as opened:
        yield opened


@pytest.mark.parametrize("width", [390, 1440])
def test_no_width_makes_the_page_scroll_sideways(built, tmp_path, tab, width):
    """Without its scripts, so that the still drawings are what is laid out."""
    text = re.sub(r"(?s)<script.*?</script>", "", built.read_text(encoding="utf-8"))
    (tmp_path / "page.html").write_text(text, encoding="utf-8")
    tab.open(tmp_path / "page.html", width, 900)
    assert tab.evaluate("document.documentElement.scrollWidth") <= width
    heights = (
        "[...document.querySelectorAll('figure svg')].map(s => s.getBoundingClientRect().height)"
    )
    drawn = tab.evaluate(heights)
    assert len(drawn) >= 14
    assert min(drawn) > 80
