"""Pictures of the pressure in the guides and over the contact."""

import numpy as np
import pytest

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.tables import Table
from camwright.reports import guide_pressure_figure
from camwright.reports.field_raster import over_the_contact

ROWS, KNOTS = 8, 5


@pytest.fixture
def path(tmp_path):
    angle = np.linspace(-180.0, 180.0, 73)
    along = np.linspace(-10.0, 10.0, KNOTS)
    line = np.outer(np.linspace(0.0, 1.0, ROWS), [40.0, 10.0, 0.0, 0.0, -5.0])
    slices = np.outer([40.0, 10.0, 0.0, 0.0, 0.0], np.maximum(np.cos(np.radians(3 * angle)), 0.0))
    near, far = (
        np.where(np.abs(angle) < 30, slices, 0.0),
        np.where(np.abs(angle) > 150, slices, 0.0),
    )
    values = {"load_case": np.array(["idle"] * ROWS), "cam_angle_deg": 45.0 * np.arange(ROWS)}
    for side, pressure in (("A", near), ("B", np.abs(far))):
        values |= {
            f"guide_{side}_position_mm": along, f"guide_{side}_line_load_N_per_mm": line,
            f"guide_{side}_worst_row": np.array(7), f"guide_{side}_slice_position_mm": along,
            f"guide_{side}_bore_angle_deg": angle, f"guide_{side}_bore_pressure_MPa": pressure,
        }  # fmt: skip
    np.savez(tmp_path / guide_pressure_figure.FILE, **values)
    return tmp_path / guide_pressure_figure.FILE


def test_reads_both_guides_and_their_worst_place(path):
    a, b = guide_pressure_figure.read_guides(path, "idle")
    assert (a.name, a.peak, a.slice, a.worst_angle) == ("A", 40.0, 0, 315.0)
    assert b.line.shape == (ROWS, KNOTS)


def test_draws_a_picture_of_either_side_of_the_bore(path):
    png = guide_pressure_figure.drawn(guide_pressure_figure.read_guides(path, "idle"))
    assert png.startswith(b"\x89PNG") and len(png) > 10_000


def test_what_is_pressed_is_shown_with_a_margin():
    places = np.linspace(0.0, 10.0, 101)
    low, high = guide_pressure_figure._pressed(
        places, np.where(np.abs(places - 5) < 1.01, 1.0, 0.0)
    )
    assert (low, high) == pytest.approx((3.8, 6.2))
    assert guide_pressure_figure._pressed(places, np.zeros(101)) == (0.0, 10.0)


def test_a_file_without_the_load_case_is_told(path):
    with pytest.raises(ResultError, match="rated"):
        guide_pressure_figure.read_guides(path, "rated")
    with pytest.raises(ResultError):
        guide_pressure_figure.read_guides(path.with_name("none.npz"), "idle")


def test_pressure_over_the_contact_is_that_of_the_angle_and_of_the_harder_case(tmp_path):
    xi = np.linspace(-0.2, 0.2, 9)
    np.savez(
        tmp_path / "p.npz", cam_angle_deg=np.array([0.0, 90.0, 0.0, 90.0]),
        distance_from_contact_mm=np.tile(xi, (4, 1)),
        contact_pressure_MPa=np.outer([1.0, 5.0, 2.0, 7.0], np.ones(9)),
    )  # fmt: skip
    cycle = Table({"p0_hertz_MPa": np.array([1.0, 5.1, 2.1, 7.1]),
                   "half_width_hertz_mm": np.full(4, 0.1)})  # fmt: skip
    above = over_the_contact(tmp_path / "p.npz", cycle, 90.0, 0.1)
    (_, places, pressure), (_, _, hertz) = above.curves
    assert pressure.tolist() == [7.0] * 9 and hertz.max() == pytest.approx(7.1)
    np.testing.assert_allclose(places, xi / 0.1)
    assert over_the_contact(tmp_path / "p.npz", cycle, 45.0, 0.1) is None
    assert over_the_contact(tmp_path / "none.npz", cycle, 90.0, 0.1) is None
