"""Cylinder pressure: files of one and many cycles, pegging, dead centre, statistics, refusals."""

import numpy as np
import pytest
from cycle_pressures import net_imep

from camwright.geometry.errors import InputError
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.engine_torque import torque_from_cycle
from camwright.pipeline.engine.indicated_cycle_solver import working_cycle
from camwright.pipeline.engine.pressure_trace import (
    PressureTable,
    PressureTrace,
    cycle_statistics,
    dead_centre_offset,
    pressure_from_csv,
    torque_from_pressure,
)

DRIVE = {
    "bore": 0.060,
    "crank_radius": 0.021,
    "rod_length": 0.073,
    "compression_ratio": 8.5,
    "piston_mass": 0.144,
    "rod_mass": 0.123,
}
ENGINE = CylinderEngine(**DRIVE)
RIG = PressureTable(file="rig.csv", **DRIVE)
DEGREES = np.arange(720.0)


@pytest.fixture(scope="module")
def modelled():
    return working_cycle(ENGINE, 157.08)


def trace_of(*cycles):
    return PressureTrace("rig", np.array(cycles), np.zeros(len(cycles)))


def write(folder, columns, header, delimiter=",", decimal="."):
    rows = (delimiter.join(f"{float(v)!r}".replace(".", decimal) for v in row)
            for row in np.column_stack(columns))  # fmt: skip
    path = folder / "pressure.csv"
    path.write_text("\n".join(([header] if header else []) + list(rows)) + "\n", encoding="utf-8")
    return path


def test_torque_of_a_modelled_cycle_is_that_of_the_model(modelled):
    """Gas and inertia are the same; the pressure trace knows no valve train: 1e-9 N m."""
    torque = torque_from_pressure(trace_of(modelled.pressure), RIG, 157.08)
    whole = torque_from_cycle(modelled)
    for name in ("gas", "inertia"):
        np.testing.assert_allclose(torque.components[name], whole.components[name], atol=1e-9)
    assert abs(torque.mean) < 1e-12


def test_two_cylinders_are_two_cycles_apart(modelled):
    from dataclasses import replace

    twin = replace(RIG, firing_offsets=(0.0, 2.0 * np.pi))
    one = torque_from_pressure(trace_of(modelled.pressure), RIG, 157.08).total
    two = torque_from_pressure(trace_of(modelled.pressure), twin, 157.08).total
    np.testing.assert_allclose(two, one + np.roll(one, 360), atol=1e-9)


def test_a_column_a_cycle_and_cycles_in_a_row_are_the_same(tmp_path, modelled):
    one, two = modelled.pressure, 1.02 * modelled.pressure
    header = "crank_angle_deg,p1_bar,p2_bar"
    side = pressure_from_csv(write(tmp_path, [DEGREES, one / 1e5, two / 1e5], header))
    np.testing.assert_allclose(side.cycles, [one, two], rtol=1e-12)
    long = [np.arange(1440.0), np.append(one, two) / 1e5]
    np.testing.assert_allclose(
        pressure_from_csv(write(tmp_path, long, "angle [deg],p [bar]")).cycles,
        [one, two],
        rtol=1e-9,
    )
    saw = [np.tile(DEGREES, 2), np.append(one, two) / 1e5]
    np.testing.assert_allclose(
        pressure_from_csv(write(tmp_path, saw, "angle [deg];p [bar]", ";", ",")).cycles,
        [one, two],
        rtol=1e-9,
    )


def test_a_file_without_a_header_takes_the_units_given(tmp_path, modelled):
    columns = [DEGREES - 360.0, np.roll(modelled.pressure, 0) / 1e6]
    path = write(tmp_path, columns, "", "\t")
    found = pressure_from_csv(path, units=("deg", "MPa"), firing_angle=0.0)
    np.testing.assert_allclose(found.mean, modelled.pressure, rtol=1e-6, atol=20.0)
    for units in (("deg", "furlong"), ("fathom", "bar")):
        with pytest.raises(InputError, match="one of"):
            pressure_from_csv(path, units=units)


def test_mean_scatter_and_cycle_statistics(modelled):
    share = np.array([0.9, 1.0, 1.1])
    trace = trace_of(*(share[:, None] * modelled.pressure))
    np.testing.assert_allclose(trace.mean, modelled.pressure, rtol=1e-12)
    np.testing.assert_allclose(trace.scatter, 0.1 * modelled.pressure, rtol=1e-9)
    found = cycle_statistics(trace, RIG)
    imep = found.imep / share
    np.testing.assert_allclose(imep, imep[0], rtol=1e-12)
    assert found.imep_variation == pytest.approx(0.1, rel=1e-9)
    assert found.peak[1] == pytest.approx(modelled.pressure.max())
    net = net_imep(modelled)  # the same work, the crankcase's left out of it
    assert found.imep[1] == pytest.approx(net, rel=1e-9)


def test_pegging_brings_every_cycle_to_intake_pressure(modelled):
    drifted = trace_of(modelled.pressure - 7e4, modelled.pressure + 3e4)
    pegged = drifted.pegged(40e3)
    near = slice(170, 191)
    np.testing.assert_allclose(pegged.cycles[:, near].mean(axis=1), 40e3, rtol=1e-12)
    assert pegged.pegging[0] - pegged.pegging[1] == pytest.approx(1e5)


def motored(heat_loss_factor):
    from dataclasses import replace

    cold = replace(
        ENGINE, combustion_efficiency=0.0, heat_loss_factor=heat_loss_factor,
        friction_pressure=0.0, intake_pressure=95e3,
    )  # fmt: skip
    return working_cycle(cold, 157.08).pressure


def test_dead_centre_by_symmetry_and_by_loss_angle():
    """Without heat to the walls a motored trace is symmetric: 0.02 deg. With it the peak leads
    by some tenths of a degree, which the loss angle allows for: 0.4 deg."""
    adiabatic, real = trace_of(motored(0.0)), trace_of(motored(1.0))
    turned = adiabatic.turned(np.radians(-3.3))
    assert dead_centre_offset(turned, "symmetry") == pytest.approx(np.radians(3.3), abs=4e-4)
    found = dead_centre_offset(real.turned(np.radians(2.0)), "loss_angle", np.radians(0.6))
    assert np.degrees(found) == pytest.approx(-2.0, abs=0.4)
    lead = -dead_centre_offset(real, "loss_angle", 0.0)
    assert lead < 0.0  # the peak comes before the dead centre
    with pytest.raises(InputError, match="symmetry or loss_angle"):
        dead_centre_offset(real, "given")


def test_turning_there_and_back_changes_nothing(modelled):
    trace = trace_of(modelled.pressure)
    back = trace.turned(0.3).turned(-0.3)
    np.testing.assert_allclose(back.mean, trace.mean, rtol=1e-9, atol=1.0)
    whole = trace.turned(np.radians(10.0))
    np.testing.assert_allclose(whole.mean, np.roll(trace.mean, 10), atol=1e-3)


@pytest.mark.parametrize(
    ("factor", "words"),
    [(1e-5, "look like bar"), (1e5, "look like Pa"), (1e-6, "look like MPa|bar")],
)
def test_a_wrong_unit_is_out_of_range(modelled, factor, words):
    with pytest.raises(InputError, match=words):
        trace_of(factor * modelled.pressure).guarded()


@pytest.mark.parametrize(("factor", "words"), [(10.0, "bar, not MPa"), (0.1, "MPa, not bar")])
def test_bar_for_mpa_shows_in_the_compression(modelled, factor, words):
    """Both lie in the range of some engine; the rise in compression tells."""
    trace_of(modelled.pressure).pegged(30.5e3).guard_scale(RIG, 30.5e3)
    with pytest.raises(InputError, match=words):
        trace_of(factor * modelled.pressure).pegged(30.5e3).guard_scale(RIG, 30.5e3)


def test_negative_absolute_pressure_is_refused(modelled):
    with pytest.raises(InputError, match="> 0 Pa, absolute"):
        trace_of(modelled.pressure - 1e5).guarded()


def test_a_peak_far_from_firing_is_refused(modelled):
    with pytest.raises(InputError, match="firing_angle"):
        trace_of(np.roll(modelled.pressure, 360)).guarded()


PRESSURE = 1.0 + 6.0 * np.exp(-(((DEGREES - 375.0) / 30.0) ** 2))
BAD = {
    "one cycle short": (
        [np.arange(1400.0), np.resize(PRESSURE, 1400)], "angle_deg,p_bar", r"cycle 2 of 2 = 680 deg"
    ),
    "a short column": ([DEGREES[:700], PRESSURE[:700]], "angle_deg,p_bar", r"span = 699 deg"),
    "359": ([DEGREES[:360], PRESSURE[:360]], "angle_deg,p_bar", "half a cycle"),
    "721": ([np.arange(722.0), np.resize(PRESSURE, 722)], "angle_deg,p_bar", "span = 721 deg"),
    "radians": ([np.radians(DEGREES), PRESSURE], "angle_deg,p_bar", "look like radians"),
    "no unit": ([DEGREES, PRESSURE], "angle_deg,p", "a column of pressure with its unit"),
    "falls": ([DEGREES[::-1], PRESSURE], "angle_deg,p_bar", "falls"),
}  # fmt: skip


@pytest.mark.parametrize("name", BAD)
def test_bad_files_are_refused_in_one_line(tmp_path, name):
    columns, header, pattern = BAD[name]
    with pytest.raises(InputError, match=pattern) as caught:
        pressure_from_csv(write(tmp_path, columns, header))
    assert "\n" not in str(caught.value)


def test_an_empty_cell_of_a_shorter_cycle_is_named(tmp_path):
    path = write(tmp_path, [DEGREES, PRESSURE, PRESSURE], "angle_deg,p1_bar,p2_bar")
    lines = path.read_text().splitlines()
    lines[-1] = lines[-1].rpartition(",")[0] + ","
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(InputError, match=r"line 721, p2_bar = nothing, must be a finite number"):
        pressure_from_csv(path)


def test_two_gigabytes_are_refused_unread(tmp_path):
    path = tmp_path / "pressure.csv"
    with path.open("wb") as file:
        file.truncate(2 * 2**30)  # a sparse file: no disk is filled
    with pytest.raises(InputError, match=r"2048.0 MiB, must be 64 MiB or less"):
        pressure_from_csv(path)


def test_decimal_commas_and_mixed_encodings(tmp_path):
    rows = "".join(
        f"{a:g};{p:.6f}\n".replace(".", ",") for a, p in zip(DEGREES, PRESSURE, strict=True)
    )
    head = "# gemäß\n".encode("latin-1") + "Winkel [°];p [bar]\n".encode()
    path = tmp_path / "pressure.csv"
    path.write_bytes(head + rows.encode())
    np.testing.assert_allclose(pressure_from_csv(path).mean, 1e5 * PRESSURE, rtol=1e-5)
