"""Traces in every usual dress are read; what is not one clean cycle is refused in one line."""

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.torque import trace_file
from camwright.pipeline.torque.angle_trace import Trace, read_trace

CYCLE = 4.0 * np.pi


def torque(angle_deg):
    """A smooth torque with one firing pulse, N m."""
    angle = np.radians(np.asarray(angle_deg))
    return 3.0 * np.sin(angle) + 20.0 * np.exp(-(((angle - 7.0) / 0.5) ** 2)) - 2.0


def rows(angle_deg, values=None, delimiter=","):
    values = torque(angle_deg) if values is None else values
    return "".join(
        f"{a!r}{delimiter}{v!r}\n" for a, v in zip(angle_deg, values.tolist(), strict=True)
    )


def write(folder, text, encoding="utf-8"):
    path = folder / "trace.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
    return path


def degrees(step=1.0, end=720.0):
    return np.arange(0.0, end, step).tolist()


@pytest.mark.parametrize(
    ("header", "angle_factor", "value_factor"),
    [
        ("crank_angle_deg,torque_Nm", 1.0, 1.0),
        ("crank angle [deg], torque [N m]", 1.0, 1.0),
        ("angle (rad),torque (kNm)", np.pi / 180.0, 1e-3),
        ("theta [°],M [N·m]", 1.0, 1.0),
        ("CAD,torque Nm", 1.0, 1.0),
        ("Kurbelwinkel [°KW],Moment in N·cm", 1.0, 100.0),
        ("angle/rev,torque/Nmm", 1.0 / 360.0, 1e3),
        ("angle_degrees,torque_lbf-ft", 1.0, 1.0 / 1.3558179483314),
        ("phi deg,torque NM", 1.0, 1.0),
        ("phi_rad,M_Nm", np.pi / 180.0, 1.0),
    ],
)
def test_units_in_the_header_are_read(tmp_path, header, angle_factor, value_factor):
    angle = degrees()
    written = [a * angle_factor for a in angle]
    path = write(tmp_path, header + "\n" + rows(written, torque(angle) * value_factor))
    trace = read_trace(path)
    np.testing.assert_allclose(trace.angle, np.radians(angle), atol=1e-12)
    np.testing.assert_allclose(trace.values, torque(angle), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("unit", ["mN m", "MN m"])
def test_prefixes_that_differ_by_case_are_kept_apart(tmp_path, unit):
    path = write(tmp_path, f"angle_deg,torque [{unit}]\n" + rows(degrees()))
    factor = {"mN m": 1e-3, "MN m": 1e6}[unit]
    np.testing.assert_allclose(read_trace(path).values, factor * torque(degrees()), rtol=1e-12)


@pytest.mark.parametrize(
    ("delimiter", "decimal"), [(",", "."), (";", ","), ("\t", ","), (";", ".")]
)
def test_separators_and_decimal_signs(tmp_path, delimiter, decimal):
    table = rows(degrees(), delimiter="|").replace(".", decimal).replace("|", f" {delimiter} ")
    head = f"angle [deg]{delimiter}torque [N m]\n"
    trace = read_trace(write(tmp_path, "# measured today\n\n" + head + table))
    np.testing.assert_allclose(trace.values, torque(degrees()), rtol=1e-12)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16"])
def test_encodings(tmp_path, encoding):
    text = "# gemäß Prüfstand\r\nangle [°];torque [N·m]\r\n" + rows(degrees(), delimiter=";")
    assert read_trace(write(tmp_path, text, encoding)).angle.size == 720


def test_encodings_mixed_within_one_file(tmp_path):
    head = "# gemäß\n".encode("latin-1") + "angle [°],torque [N·m]\n".encode()
    assert read_trace(write(tmp_path, head + rows(degrees()).encode())).angle.size == 720


def test_column_is_chosen_by_name_or_taken_as_the_total(tmp_path):
    angle = degrees()
    text = "cam_angle_deg,crank_angle_deg,total_Nm,gas_Nm,speed_rpm\n"
    text += "".join(f"{a / 2!r},{a!r},{i}.0,{-i}.5,1500\n" for i, a in enumerate(angle))
    path = write(tmp_path, text)
    assert read_trace(path).values[3] == 3.0
    assert read_trace(path, column="gas").values[3] == -3.5
    with pytest.raises(InputError, match="one column of friction"):
        read_trace(path, column="friction")


def test_other_quantities_are_read_by_the_same_reader(tmp_path):
    path = write(
        tmp_path, "angle_deg,p [bar],n [rpm]\n" + "".join(f"{a},1,60\n" for a in degrees())
    )
    assert read_trace(path, "pressure").values[0] == 1e5
    assert read_trace(path, "speed").values[0] == pytest.approx(2.0 * np.pi, rel=1e-15)


def test_both_ends_are_one_sample_of_their_mean(tmp_path):
    angle = degrees(end=720.5)
    values = torque(angle)
    values[0], values[-1] = 1.0, 1.5
    trace = read_trace(write(tmp_path, "angle_deg,torque_Nm\n" + rows(angle, values)))
    assert trace.angle.size == 720
    assert trace.values[0] == 1.25


def test_half_degree_file_without_its_end_keeps_its_last_row(tmp_path):
    trace = read_trace(write(tmp_path, "angle_deg,torque_Nm\n" + rows(degrees(0.5))))
    assert trace.angle.size == 1440


def test_angles_about_firing_top_dead_centre_wrap(tmp_path):
    angle = np.arange(-360.0, 360.0)
    values = torque(np.mod(angle, 720.0))
    trace = read_trace(write(tmp_path, "angle_deg,torque_Nm\n" + rows(angle.tolist(), values)))
    np.testing.assert_allclose(trace.uniform(720), torque(degrees()), atol=1e-9)


GOOD = rows(degrees())
BAD = {
    "gap": (rows([a for a in degrees() if not 100 < a < 106]), r"gap after 100 deg = 6 deg"),
    "wide gap": (rows(degrees(24.0, 721.0)), r"= 24 deg, must be at most 20 deg"),
    "duplicate": (rows([0.0, 1.0, 1.0, *degrees()[2:]]), r"line 4.*repeats"),
    "shuffled": (rows([0.0, 2.0, 1.0, *degrees()[3:]]), r"line 4.*falls after 2"),
    "reversed": (rows(degrees()[::-1]), r"line 3.*falls"),
    "word": (GOOD.replace("5.0,", "five,", 1), r"line 7, angle_deg = five, must be a finite"),
    "underscore": (GOOD.replace("11.0,", "1_1.0,", 1), r"line 13.*1_1.0"),
    "empty cell": (GOOD.replace("5.0,", ",", 1), r"line 7, angle_deg = nothing"),
    "nan": (GOOD + "720.0,nan\n", r"line 722, torque_Nm = nan, must be a finite number"),
    "inf": (GOOD + "720.0,inf\n", r"= inf, must be a finite"),
    "overflow": (GOOD + "720.0,1e999\n", r"= 1e999, must be a finite"),
    "absurd": (GOOD.replace("3.0,", "3.0,1e300 #", 1), r"line 5"),
    "359": (rows(degrees(end=360.0)), r"span = 359 deg .*half a cycle.*one cycle of 720"),
    "721": (rows(degrees(end=722.0)), r"span = 721 deg"),
    "one row over": (rows(degrees(end=721.6)), r"span = 721 deg"),
    "radians": (rows(np.radians(degrees()).tolist()), r"look like radians"),
    "few": (rows(degrees(72.0)), r"10 rows, must be 12 rows or more"),
    "short row": (GOOD + "720.0\n", r"line 722 = 1 cells, must be 2"),
    "decimal comma": (GOOD.replace("5.0,", "5,0,", 1), r"line 7 = 3 cells, must be 2"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_tables_are_refused_in_one_line(tmp_path, name):
    table, pattern = BAD[name]
    with pytest.raises(InputError, match=pattern) as caught:
        read_trace(write(tmp_path, "angle_deg,torque_Nm\n" + table))
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("trace.csv")


def test_degrees_called_radians_are_hinted_at(tmp_path):
    with pytest.raises(InputError, match="look like degrees"):
        read_trace(write(tmp_path, "angle_rad,torque_Nm\n" + GOOD))


@pytest.mark.parametrize(
    "header",
    [
        "angle,torque_Nm",
        "angle_deg,torque",
        "angle_deg,torque [furlong]",
        "angle_miles,torque_Nm",
        "angle_deg,torque_1_Nm,torque_2_Nm",
        "torque_Nm",
        "1.0,2.0",
    ],
)
def test_headers_without_one_angle_and_one_torque_are_refused(tmp_path, header):
    with pytest.raises(InputError, match="must be"):
        read_trace(write(tmp_path, header + "\n" + GOOD))


@pytest.mark.parametrize("header", ["angle_deg,torque_Nm\n", "angle_deg,torque_kNm\n"])
@pytest.mark.parametrize("place", [0, 7])
@pytest.mark.parametrize("value", [1e200, -1.7e308])
def test_huge_values_are_refused_before_they_overflow(tmp_path, header, place, value):
    """In every unit; at the end of the period, which is averaged with the start, too."""
    values = torque(degrees())
    values[place] = value
    table = rows(degrees(), values) + f"720.0,{values[0]}\n"
    with pytest.raises(InputError, match=r"within 1e|must be finite"):
        read_trace(write(tmp_path, header + table))


@pytest.mark.parametrize(
    ("content", "pattern"),
    [
        (b"", "an empty file"),
        (b"\n  \n# only a comment\n", "an empty file"),
        (b"\x89PNG\r\n\x1a\n\0\0\0", "a binary file"),
        (b"angle_deg,torque_Nm\n", "0 rows"),
    ],
)
def test_files_without_a_table_are_refused(tmp_path, content, pattern):
    with pytest.raises(InputError, match=pattern):
        read_trace(write(tmp_path, content))


def test_missing_file_and_folder_are_refused(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_trace(tmp_path / "absent.csv")
    with pytest.raises(InputError, match="a folder"):
        read_trace(tmp_path)


def test_a_file_too_large_is_refused_unread(tmp_path, monkeypatch):
    path = tmp_path / "trace.csv"
    with path.open("wb") as stream:  # sparse: 2 GB of nothing on disk
        stream.truncate(2 * 2**30)
    monkeypatch.setattr(type(path), "open", lambda *_: pytest.fail("the file was opened"))
    with pytest.raises(InputError, match=r"trace.csv = 2048.0 MiB, must be 64 MiB or less"):
        read_trace(path)


def test_too_many_lines_are_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(trace_file, "ROWS_MAX", 700)
    with pytest.raises(InputError, match="721 lines, must be 700 lines or fewer"):
        read_trace(write(tmp_path, "angle_deg,torque_Nm\n" + GOOD))


def trace_of(angle_deg, values):
    return Trace("trace.csv", "torque", "torque_Nm", np.radians(angle_deg), values)


def test_interpolation_passes_through_every_sample():
    angle = np.sort(np.random.default_rng(1).uniform(0.0, 720.0, 150))
    trace = trace_of(angle, torque(angle))
    np.testing.assert_allclose(trace(trace.angle + CYCLE), trace.values, atol=1e-9)


def test_interpolation_converges_on_a_smooth_trace():
    errors = []
    for step in (8.0, 4.0, 2.0):
        angle = np.arange(0.0, 720.0, step)
        fine = np.arange(0.0, 720.0, 0.5)
        periodic = 5.0 * np.sin(np.radians(angle)) + np.cos(np.radians(1.5 * angle))
        exact = 5.0 * np.sin(np.radians(fine)) + np.cos(np.radians(1.5 * fine))
        errors.append(np.sqrt(np.mean((trace_of(angle, periodic)(np.radians(fine)) - exact) ** 2)))
    assert errors[2] < 1e-3
    # second order at extrema, higher between them: at least a factor 4 for half the step
    assert errors[0] / errors[1] > 4.0
    assert errors[1] / errors[2] > 4.0


def test_a_step_does_not_ring_along_the_cycle():
    angle = np.arange(0.0, 720.0, 5.0)
    values = np.where(angle < 360.0, 0.0, 10.0)
    curve = trace_of(angle, values)(np.radians(np.arange(0.0, 720.0, 0.5)))
    assert curve.min() >= -1e-9
    assert curve.max() <= 10.0 + 1e-9


def test_a_dense_file_keeps_its_mean_and_loses_its_noise():
    angle = np.arange(0.0, 720.0, 0.1)
    noise = np.random.default_rng(2).normal(0.0, 2.0, angle.size)
    trace = trace_of(angle, torque(angle) + noise)
    uniform = trace.uniform(720)
    assert uniform.mean() == pytest.approx(trace.values.mean(), abs=1e-9)
    # ten samples to a cell: noise falls by sqrt(10) to 0.63
    assert 0.5 < np.std(uniform - torque(degrees())) < 0.75


def test_a_coarse_trace_on_a_grid_of_its_own_is_unchanged():
    angle = np.arange(0.0, 720.0, 1.0)
    np.testing.assert_allclose(
        trace_of(angle, torque(angle)).uniform(720), torque(angle), atol=1e-9
    )
