"""A column of a data file is used if its header or the case identifies it, in every reader."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest
from mutated_inputs import ROUND

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.load_case_torque import measurement_words
from camwright.pipeline.engine.pickup_voltage import VoltageTable, speed_from_voltage
from camwright.pipeline.engine.pressure_trace import pressure_from_csv
from camwright.pipeline.engine.speed_file import speed_from_csv
from camwright.pipeline.engine.speed_trace import Filter
from camwright.pipeline.engine.trigger_wheel import TriggerWheel
from camwright.pipeline.search.machine.torque_task import _cycle
from camwright.pipeline.studies.cam_inspection import read_measured
from camwright.pipeline.torque.angle_trace import read_trace
from camwright.pipeline.torque.press_torque import Press, press_torque
from validation.friction_identification import read_decay

FDAQ = Path(__file__).parents[1] / "data" / "strangers" / "09-pressure-fdaq"
DEGREES = np.arange(720.0)
PRESSURE = 1.0 + 40.0 * np.exp(-(((DEGREES - 375.0) / 30.0) ** 2))
PRESS = Press(eccentric_radius=0.05, rod_length=0.3, file="f.csv", force=None, working_travel=None)
BAND = Filter(6)


def write(folder, header, *columns, name="f.csv"):
    rows = "\n".join(",".join(f"{v:.9g}" for v in row) for row in np.column_stack(columns))
    (folder / name).write_text(f"{header}\n{rows}\n" if header else f"{rows}\n", encoding="utf-8")
    return folder / name


def indicated(folder, case, data, head="", engine=""):
    """First line on the measurement of a case of the data acquisition's file."""
    (folder / data).write_text(head + (FDAQ / "fdaq.txt").read_text(encoding="utf-8"))
    text = (FDAQ / case).read_text(encoding="utf-8")
    (folder / case).write_text(text.replace("[engine]\n", f"[engine]\n{engine}"))
    return next(iter(measurement_words(read_case(folder / case))))


def test_the_mean_torque_of_a_pressure_beside_an_injector_current(tmp_path):
    """The work of the pressure that made the file, without noise and drift, over 4 pi: 46.81 N m.
    With the current averaged as a pressure it was 23.35 N m."""
    head = "CA_deg\tp_bar\tI_A\n"
    for case, data, first, engine in (
        ("with_header.toml", "fdaq_header.txt", head, ""),
        ("no_header.toml", "fdaq.txt", "", 'column = "2"\n'),
        ("no_header.toml", "fdaq.txt", "", 'column = "column 2"\n'),
        ("with_header.toml", "fdaq_header.txt", "CA\tp\tI\ndeg\tbar\tA\n", ""),
        ("with_header.toml", "fdaq_header.txt", "# " + head, ""),
    ):
        words = indicated(tmp_path, case, data, first, engine)
        assert words.startswith(f"indicated torque of {data}: 46.81 N m"), (case, first)
    with pytest.raises(InputError, match=r"line 1 = .*, must be a header, such as angle_deg,press"):
        indicated(tmp_path, "no_units.toml", "fdaq.txt")


@pytest.mark.parametrize("column", ["", "1", "4", "2 to 4", "3-2", "p"])
def test_columns_without_a_header_are_named_by_number(tmp_path, column):
    engine = f'column = "{column}"\n' if column else ""
    shown = column or "missing"
    with pytest.raises(InputError, match=rf"engine\.column = {shown}, must be the number of a col"):
        indicated(tmp_path, "no_header.toml", "fdaq.txt", "", engine)


def test_columns_without_a_header_that_are_cycles_are_read_without_their_numbers(tmp_path):
    """Cycles of one cylinder differ by some per cent, a current beside them by all of them."""
    cycles = np.array([1.0, 1.15, 0.9])[:, None] * PRESSURE
    path = write(tmp_path, "", DEGREES, *cycles)
    read = pressure_from_csv(path, units=("deg", "bar")).cycles
    np.testing.assert_allclose(read, 1e5 * cycles, rtol=1e-6)
    path = write(tmp_path, "", DEGREES, *cycles, np.where(abs(DEGREES - 355.0) < 2.0, 8.0, 0.0))
    with pytest.raises(InputError, match=r"from 2 to 5, .*: column 3 is unlike column 5"):
        pressure_from_csv(path, units=("deg", "bar"))


def test_every_cycle_of_a_file_without_a_header_can_be_named(tmp_path):
    path = write(tmp_path, "", DEGREES, PRESSURE, 1.1 * PRESSURE, DEGREES)
    cycles = pressure_from_csv(path, units=("deg", "bar"), column="2 to 3").cycles
    np.testing.assert_allclose(cycles, 1e5 * np.array([PRESSURE, 1.1 * PRESSURE]), rtol=1e-6)


READERS = {
    "pressure": (pressure_from_csv, "angle_deg,pressure_bar, or engine.angle_unit and"),
    "torque": (read_trace, "angle_deg,torque_Nm"),
    "lift": (lambda path: read_trace(path, "lift"), "angle_deg,lift_mm"),
    "force": (lambda path: read_trace(path, "force", part="cam"), "angle_deg,force_N"),
    "press": (lambda path: press_torque(PRESS, path), "travel_mm,force_kN"),
    "speed": (lambda path: speed_from_csv(path, TriggerWheel(), BAND), "time_s"),
    "voltage": (
        lambda path: speed_from_voltage(path, VoltageTable(file="f.csv")), "time_s,voltage_V"
    ),
    "contour": (partial(read_measured, contour=ROUND), "measured_x_mm,measured_y_mm"),
    "torque of a task": (lambda path: _cycle(path, None), "angle_deg,torque_Nm"),
    "decay": (read_decay, "time_s,speed_rad/s"),
}  # fmt: skip


@pytest.mark.parametrize("name", READERS)
@pytest.mark.parametrize("text", ["0,1.5,2\n1,1.6,2\n", "0;1,5\n1;1,6\n", "0 1.5\n1 1.6\n"])
def test_no_reader_takes_the_first_row_for_a_header(tmp_path, name, text):
    read, example = READERS[name]
    path = tmp_path / "f.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read(path)
    assert f"f.csv line 1 = {text.splitlines()[0]}, must be a header, such as {example}" in str(
        caught.value
    )


def test_times_alone_without_a_header_are_refused(tmp_path):
    (tmp_path / "f.csv").write_text("0.001\n0.002\n")
    with pytest.raises(InputError, match=r"line 1 = 0\.001, must be a header, such as time_s$"):
        speed_from_csv(tmp_path / "f.csv", TriggerWheel(), BAND)


def test_units_in_a_second_line_and_names_in_a_comment(tmp_path):
    wave = np.cos(np.radians(DEGREES))
    plain = read_trace(write(tmp_path, "angle_deg,torque_Nm", DEGREES, wave)).values
    for header in (
        "angle,torque\ndeg,Nm", "angle,torque\n[deg],[N m]", '"angle","torque"\n"(deg)","(Nm)"',
        "# made\n# angle_deg,torque_Nm",
    ):  # fmt: skip
        np.testing.assert_array_equal(
            read_trace(write(tmp_path, header, DEGREES, wave)).values, plain
        )
    with pytest.raises(InputError, match=r"line 2, torque_Nm = Nm?, must be a finite number"):
        read_trace(write(tmp_path, "angle_deg,torque_Nm\n0,N", DEGREES, wave))


def test_pressures_that_are_no_cycles_of_one_cylinder_are_not_averaged(tmp_path):
    intake = 0.9 + 0.1 * np.sin(np.radians(2.0 * DEGREES))
    other = np.roll(PRESSURE, 180)
    for beside, name in ((intake, "p_intake_bar"), (other, "second [bar]")):
        path = write(tmp_path, f"angle_deg,p_cyl_bar,{name}", DEGREES, PRESSURE, beside)
        with pytest.raises(InputError, match=r"engine\.column = missing, must be the beginning"):
            pressure_from_csv(path)
        alone = pressure_from_csv(path, column="p_cyl")
        np.testing.assert_allclose(alone.cycles, 1e5 * PRESSURE[None], rtol=1e-6)
    misfire = write(tmp_path, "angle_deg,p1_bar,p2_bar", DEGREES, PRESSURE, 0.3 * PRESSURE)
    assert pressure_from_csv(misfire).cycles.shape[0] == 2


def test_speeds_of_other_shafts_and_columns_without_a_unit_are_not_averaged(tmp_path):
    speed = 1500.0 + 30.0 * np.cos(np.radians(DEGREES))
    path = write(tmp_path, "crank_deg,n_rpm,turbo_rpm", DEGREES, speed, 40.0 * speed)
    with pytest.raises(InputError, match="turbo_rpm is unlike n_rpm"):
        speed_from_csv(path, TriggerWheel(), BAND)
    assert speed_from_csv(path, TriggerWheel(), BAND, column="n").count == 1
    path = write(tmp_path, "crank_deg,n,load,oil_bar", DEGREES, speed, DEGREES, DEGREES)
    with pytest.raises(InputError, match=r"engine\.column = missing.* of n, load$"):
        speed_from_csv(path, TriggerWheel(), BAND, unit="rpm")
    assert speed_from_csv(path, TriggerWheel(), BAND, unit="rpm", column="n").count == 1
    path = write(tmp_path, "crank_deg,n,oil_bar", DEGREES, speed, DEGREES)
    assert speed_from_csv(path, TriggerWheel(), BAND, unit="rpm").count == 1
    path = write(tmp_path, "crank_deg,n [rpm],load", DEGREES, speed, DEGREES)
    assert speed_from_csv(path, TriggerWheel(), BAND, unit="rpm").count == 1


def test_a_decay_is_read_in_the_units_of_its_header(tmp_path):
    time, signal = np.arange(30.0), np.linspace(60.0, 30.0, 30)
    at, speed = read_decay(write(tmp_path, "time_ms,n [rpm]", time, signal))
    np.testing.assert_allclose(at, 1e-3 * time)
    np.testing.assert_allclose(speed, signal * np.pi / 30.0)
    with pytest.raises(InputError, match="3 columns, must be two"):
        read_decay(write(tmp_path, "time_s,w,x", time, signal, signal))


def test_a_name_is_taken_before_a_beginning(tmp_path):
    header = "angle_deg,gas [Nm],gas 2 [Nm]"
    path = write(tmp_path, header, DEGREES, DEGREES % 7.0, DEGREES % 5.0)
    np.testing.assert_array_equal(read_trace(path, column="gas").values, DEGREES % 7.0)
    with pytest.raises(InputError, match="one column of"):
        read_trace(path, column="ga")
