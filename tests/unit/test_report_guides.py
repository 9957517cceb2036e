"""Pictures of the pressure in the guides, along the line of contact and over the contact."""

import numpy as np
import pytest

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.tables import Table
from camwright.reports import pressure_figures
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
    np.savez(tmp_path / pressure_figures.FILE, **values)
    return tmp_path / pressure_figures.FILE


def test_reads_both_guides_and_their_worst_place(path):
    a, b = pressure_figures.read_guides(path, "idle")
    assert (a.name, a.peak, a.slice, a.worst_angle) == ("guide A", 40.0, 0, 315.0)
    assert b.line.shape == (ROWS, KNOTS)


def test_draws_a_picture_of_either_side_of_the_bore(path):
    png = pressure_figures.drawn(pressure_figures.read_guides(path, "idle"))
    assert png.startswith(b"\x89PNG") and len(png) > 10_000


def test_the_bush_of_a_pivot_is_read_and_drawn_as_one_guide(path, tmp_path):
    one = {k.removeprefix("guide_A_"): v for k, v in np.load(path).items() if "guide_B" not in k}
    del one["slice_position_mm"]
    np.savez(tmp_path / pressure_figures.PIVOT, **one)
    bush = pressure_figures.read_pivot(tmp_path / pressure_figures.PIVOT, "idle")
    assert (bush.name, bush.peak, bush.worst_angle, bush.worst_case) == (
        "pivot bush", 40.0, 315.0, "idle",
    )  # fmt: skip
    np.testing.assert_array_equal(bush.slices, bush.along)
    assert pressure_figures.drawn([bush]).startswith(b"\x89PNG")
    with pytest.raises(ResultError, match="rated"):
        pressure_figures.read_pivot(tmp_path / pressure_figures.PIVOT, "rated")


def test_what_is_pressed_is_shown_with_a_margin():
    places = np.linspace(0.0, 10.0, 101)
    low, high = pressure_figures._pressed(places, np.where(np.abs(places - 5) < 1.01, 1.0, 0.0))
    assert (low, high) == pytest.approx((3.8, 6.2))
    assert pressure_figures._pressed(places, np.zeros(101)) == (0.0, 10.0)


def test_a_file_without_the_load_case_is_told(path):
    with pytest.raises(ResultError, match="rated"):
        pressure_figures.read_guides(path, "rated")
    with pytest.raises(ResultError):
        pressure_figures.read_guides(path.with_name("none.npz"), "idle")


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


@pytest.fixture
def axial(tmp_path):
    angle = np.tile(45.0 * np.arange(ROWS), 2)
    edges = np.array([-2.0, -1.9, -1.0, 0.0, 1.0, 1.9, 2.0])
    level = np.outer(np.linspace(0.0, 1.0, 2 * ROWS), [300.0, 200.0, 150.0, 150.0, 200.0, 300.0])
    np.savez(
        tmp_path / pressure_figures.AXIAL, cam_angle_deg=angle, axial_edge_mm=edges,
        load_case=np.repeat(["idle", "fast"], ROWS), level_pressure_MPa=level,
        tilted_pressure_MPa=level * np.linspace(0.8, 1.2, 6), mean_length_mm=np.array(0.1),
    )  # fmt: skip
    return tmp_path / pressure_figures.AXIAL


def test_reads_the_pressure_along_the_line_at_its_worst_angle(axial):
    worst = pressure_figures.read_axial(axial, "idle", None)
    assert (worst.worst_case, worst.worst_angle, worst.whole.shape) == ("idle", 315.0, (ROWS, 6))
    assert worst.peak == pytest.approx(300.0 * 1.2 * 7 / 15)
    assert worst.has_means
    at = pressure_figures.read_axial(axial, "idle", ("fast", 359.0))
    assert (at.worst_case, at.worst_angle, at.whole.shape) == ("fast", 0.0, (ROWS, 6))
    assert at.level.max() == pytest.approx(300.0 * 8 / 15)
    with pytest.raises(ResultError, match="load case nowhere is missing"):
        pressure_figures.read_axial(axial, "nowhere", None)
    axial.write_bytes(b"no archive")
    with pytest.raises(ResultError, match=r"5_length\.npz"):
        pressure_figures.read_axial(axial, "idle", None)


def test_pressure_along_the_line_of_a_follower_that_leaves_the_cam(axial):
    """Angles without a known force are left out; without any there is no picture, but a reason."""
    entry = dict(np.load(axial))
    entry["tilted_pressure_MPa"][[3, 7]] = np.nan
    np.savez(axial, **entry)
    one = pressure_figures.read_axial(axial, "idle", None)
    assert (one.worst_angle, one.peak) == (270.0, pytest.approx(300.0 * 1.2 * 6 / 15))
    assert pressure_figures.drawn_axial(one, None, None).startswith(b"\x89PNG")
    entry["tilted_pressure_MPa"][:ROWS] = np.nan
    np.savez(axial, **entry)
    with pytest.raises(ResultError, match="load case idle is not known at any angle"):
        pressure_figures.read_axial(axial, "idle", None)


@pytest.mark.parametrize(("limit", "centre"), [(None, None), (250.0, 180.0)])
def test_draws_the_pressure_along_the_line(axial, limit, centre):
    one = pressure_figures.read_axial(axial, "idle", None)
    png = pressure_figures.drawn_axial(one, limit, centre)
    assert png.startswith(b"\x89PNG") and len(png) > 10_000
    assert png != pressure_figures.drawn_axial(one, 275.0, centre)


def test_finite_elements_stand_beside_the_half_spaces_at_the_certified_angle(axial):
    one = pressure_figures.read_axial(axial, "idle", ("fast", 45.0))
    factors = {"centre": 1.1, "end1_mean": 1.6, "end2_mean": 1.4}
    bars = {f"{name}_gci_percent": share for name, share in zip(factors, (1, 2, 3), strict=True)}
    line = {"y_mm": [-1.95, -1.0, 0.0, 1.0, 1.95], "factor": [1.7, 1.3, 1.1, 1.2, 1.5]}
    blocks = factors | bars | {"axial": line}
    record = {"load_case": "fast", "cam_angle_deg": 45.0, "finite_elements": blocks}
    made = pressure_figures.certified_pressure([record], one, 100.0)
    places, values, errors = made.over(one)
    np.testing.assert_allclose(places, [-1.95, 0.0, 1.95])
    # The half-spaces carry more at y > 0, the record at y < 0: the same contact, mirrored.
    np.testing.assert_allclose(values, [140.0, 110.0, 160.0])
    np.testing.assert_allclose(errors, [4.2, 1.1, 3.2])
    along, line = made.curve(one)
    np.testing.assert_allclose(along, [-1.0, 0.0, 1.0])  # the means stand for the rest
    np.testing.assert_allclose(line, [120.0, 110.0, 130.0])
    assert pressure_figures.drawn_axial(one, None, 100.0, made) != pressure_figures.drawn_axial(
        one, None, 100.0
    )
    for other in ({"cam_angle_deg": 44.0}, {"load_case": "idle"}):
        assert pressure_figures.certified_pressure([record | other], one, 100.0) is None
    assert pressure_figures.certified_pressure([record], one, None) is None


def test_the_worst_certified_angle_of_the_load_case_of_the_check_is_shown():
    def record(load_case, angle, factor, p0):
        place = {"load_case": load_case, "cam_angle_deg": angle}
        return place | {"signed_factor": factor, "plane_strain_p0_MPa": p0}

    records = [record("idle", 40.0, 1.9, 900.0), record("idle", 50.0, 1.5, 1200.0)]
    records += [record("fast", 210.0, 1.3, 1000.0)]
    check = {"load_case": "fast", "cam_angle_deg": 212.5}
    shown = pressure_figures.shown_place
    assert shown(check, records) == ("fast", 210.0)
    assert shown(check, records[:2]) == ("idle", 50.0)
    assert shown(None, records) == ("idle", 50.0)
    assert shown(check, []) == ("fast", 212.5)
    assert shown(check | {"cam_angle_deg": None}, []) is None
    assert shown(None, []) is None
