"""The picture of the map of a turn."""

import numpy as np
import pytest

from camwright.geometry.errors import ResultError
from camwright.reports import stress_map


@pytest.fixture
def path(tmp_path):
    depth = np.outer([1.0, 2.0], [0.0, 0.5, 1.0])
    values = np.array([[1.0, 3.0, 2.0], [2.0, 6.0, 4.0]])
    names = ("von_mises_MPa", "shear_range_MPa")
    np.savez(
        tmp_path / stress_map.FILE,
        **{"rated.cam_angle_deg": np.array([0.0, 180.0]), "rated.depth_mm": depth},
        **{f"rated.{name}": values for name in names},
    )
    return tmp_path / stress_map.FILE


def test_reads_one_load_case_and_its_worst_place(path):
    found = stress_map.read_envelope(path, "rated")
    assert stress_map.worst(found, "von_mises_MPa") == (6.0, 180.0, 1.0)


def test_lays_stations_on_common_depths_and_knows_where_they_end(path):
    found = stress_map.read_envelope(path, "rated")
    flat = stress_map.unrolled(found["von_mises_MPa"], found["depth_mm"], np.array([0.0, 0.5, 1.5]))
    np.testing.assert_allclose(flat, [[1.0, 2.0], [3.0, 4.0], [np.nan, 5.0]])


def test_draws_a_picture(path):
    png = stress_map.drawn(stress_map.read_envelope(path, "rated"))
    assert png.startswith(b"\x89PNG") and len(png) > 5000


def test_a_load_case_or_file_that_is_not_there_is_told(path):
    with pytest.raises(ResultError, match="idle"):
        stress_map.read_envelope(path, "idle")
    with pytest.raises(ResultError):
        stress_map.read_envelope(path.parent / "none.npz", "rated")


def test_draws_the_map_in_its_place_along_the_contour(path):
    found = stress_map.read_envelope(path, "rated")
    angle = np.arange(0.0, 360.0, 10.0)
    normal = np.stack([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    png = stress_map.around(found, angle, 40.0 * normal, normal)
    assert png.startswith(b"\x89PNG") and len(png) > 5000


@pytest.mark.parametrize(("wanted", "drawn"), [(1.0, 1.0), (1.99, 1.0), (26.0, 20.0), (0.6, 0.5)])
def test_depths_are_enlarged_by_a_round_number(wanted, drawn):
    assert stress_map._enlarged(wanted) == pytest.approx(drawn)


def test_stations_without_a_known_stress_are_left_out(path):
    """Of a follower that leaves the cam; without any station there is a reason for no map."""
    entry = dict(np.load(path))
    for name in ("depth_mm", "von_mises_MPa", "shear_range_MPa"):
        entry[f"rated.{name}"][0] = np.nan
    np.savez(path, **entry)
    found = stress_map.read_envelope(path, "rated")
    angle = np.arange(0.0, 360.0, 10.0)
    normal = np.stack([np.cos(np.radians(angle)), np.sin(np.radians(angle))])
    assert stress_map.around(found, angle, 40.0 * normal, normal).startswith(b"\x89PNG")
    entry["rated.von_mises_MPa"][1] = np.nan
    np.savez(path, **entry)
    with pytest.raises(ResultError, match="rated is not known at any angle"):
        stress_map.read_envelope(path, "rated")
