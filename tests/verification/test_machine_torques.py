"""Torque of machines against work, virtual work and closed forms that it is not computed from."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy

from camwright.geometry.arrays import Array
from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.engine.crankshaft import Crankshaft, Inertia, crank_motion, energy_swing
from camwright.pipeline.torque.harmonic_torque import Harmonic, HarmonicTorque
from camwright.pipeline.torque.motor_line import MotorLine, MotorPoint
from camwright.pipeline.torque.press_torque import Press, PressTorque, press_torque
from camwright.pipeline.torque.pressure_torque import (
    PressureCylinder,
    PressureTorqueFile,
    pressure_torque,
)
from camwright.pipeline.torque.tabled_torque import TabledTorqueFile, tabled_torque
from camwright.pipeline.torque.valved_cylinder import (
    CompressorCylinder,
    CompressorTorque,
    PumpCylinder,
    PumpTorque,
)

TURN = 2.0 * np.pi
DRIVE = {"bore": 0.08, "crank_radius": 0.035, "rod_length": 0.14}


def grid(count: int, cycle: float = TURN) -> Array:
    return np.arange(count) * (cycle / count)


def work(torque: Array, cycle: float = TURN) -> float:
    return float(torque.mean()) * cycle


# Khurmi, Theory of Machines (14th ed.), examples 16.11 to 16.13; the numbers are exact, of the
# printed data. 7200 angles: the extreme of a speed lies within 1e-7 of a sample.
@pytest.mark.parametrize(
    ("machine", "load", "inertia", "rpm", "energy", "swing"),
    [
        ({2.0: (-5700.0, 9500.0)}, {}, 3121.0, 180.0, 11078.81, 0.00999066),
        ({2.0: (0.0, 600.0)}, {1.0: (0.0, 500.0)}, 80.0, 150.0, 1204.167, 0.0616123),
        ({3.0: (0.0, 1500.0)}, {}, 1000.0, 300.0, 1000.0, 0.00101321),
        ({3.0: (0.0, 1500.0)}, {1.0: (0.0, 600.0)}, 1000.0, 300.0, 1656.502, 0.00167839),
    ],
)
def test_flywheels_of_a_textbook(
    machine: dict[float, tuple[float, float]],
    load: dict[float, tuple[float, float]],
    inertia: float,
    rpm: float,
    energy: float,
    swing: float,
) -> None:
    theta = grid(7200)
    drive = _harmonics(5000.0, machine).torque(theta)
    net = drive - (_harmonics(5000.0, load).torque(theta) if load else 5000.0)
    assert np.ptp(energy_swing(net, TURN)) == pytest.approx(energy, rel=1e-6)
    still = Inertia.constant_only(inertia, theta.size)
    motion = crank_motion(net, still, rpm * np.pi / 30.0, span=TURN)
    assert motion.statistics.fluctuation == pytest.approx(swing, rel=1e-5)
    if inertia == 80.0:  # example 16.12: the acceleration at 127.5 deg is T / J at any speed
        assert motion.acceleration[2550] == pytest.approx(-12.2029, abs=1e-4)


def _harmonics(mean: float, parts: dict[float, tuple[float, float]]) -> HarmonicTorque:
    waves = tuple(Harmonic(order=k, cosine=a, sine=b) for k, (a, b) in parts.items())
    return HarmonicTorque(mean=mean, harmonics=waves)


@pytest.mark.parametrize("exponent", [1.0, 1.2, 1.4])
@pytest.mark.parametrize("offset", [0.0, 0.006])
def test_indicated_work_of_a_compressor(exponent: float, offset: float) -> None:
    """W = n/(n - 1) p1 (V1 - V4) (r^((n-1)/n) - 1), for n = 1 p1 (V1 - V4) ln r."""
    cylinder = CompressorCylinder(
        **DRIVE, pin_offset=offset, suction_pressure=1e5, discharge_pressure=6e5, clearance=0.05,
        exponent=exponent,
    )  # fmt: skip
    ratio = 6.0
    drawn = cylinder.displacement * (1.05 - 0.05 * ratio ** (1.0 / exponent))
    share = (exponent - 1.0) / exponent
    rise = np.log(ratio) if exponent == 1.0 else (ratio**share - 1.0) / share
    machine = CompressorTorque(cylinders=(cylinder,))
    # corners of the torque where a valve opens: the sum over 720 angles is off by their squares
    assert -work(machine.torque(grid(720))) == pytest.approx(1e5 * drawn * rise, rel=2e-5)


def test_both_sides_of_a_compressor_add_up() -> None:
    """The crank side draws in its ring area's share; its work follows from the same closed form."""
    pressures = {"suction_pressure": 1e5, "discharge_pressure": 5e5, "clearance": 0.08}
    one = CompressorCylinder(**DRIVE, **pressures)
    both = CompressorCylinder(**DRIVE, **pressures, double_acting=True, piston_rod_diameter=0.03)
    theta = grid(1440)
    single, double = one.torque(theta), both.torque(theta)
    ring = 1.0 - (0.03 / 0.08) ** 2
    assert double.mean() / single.mean() == pytest.approx(1.0 + ring, rel=1e-5)


@pytest.mark.parametrize("theta", [0.3, 1.0, 1.6, 2.9])
def test_virtual_work_of_both_sides(theta: float) -> None:
    """On the outward stroke the head side opens and the crank side is compressed."""
    low, high, clearance, n = 1e5, 5e5, 0.08, 1.3
    both = CompressorCylinder(
        **DRIVE, suction_pressure=low, discharge_pressure=high, clearance=clearance, exponent=n,
        double_acting=True, piston_rod_diameter=0.03, back_pressure=1.2e5,
    )  # fmt: skip
    r, rod, step = 0.035, 0.14, 1e-6

    def travel(angle: float) -> float:
        return r + rod - r * np.cos(angle) - np.sqrt(rod**2 - (r * np.sin(angle)) ** 2)

    open_share = travel(theta) / (2 * r)
    head = max(high * (clearance / (clearance + open_share)) ** n, low)
    crank_side = min(low * ((1 + clearance) / (clearance + 1 - open_share)) ** n, high)
    whole, small = np.pi / 4 * 0.08**2, np.pi / 4 * 0.03**2
    force = head * whole - crank_side * (whole - small) - 1.2e5 * small
    rate = (travel(theta + step) - travel(theta - step)) / (2 * step)
    np.testing.assert_allclose(both.torque(np.array([theta])), force * rate, rtol=1e-8)


def test_work_of_a_pump_is_pressure_rise_times_displacement() -> None:
    cylinders = tuple(
        PumpCylinder(**DRIVE, phase=k * TURN / 3.0, suction_pressure=1.2e5, discharge_pressure=9e6)
        for k in range(3)
    )
    torque = PumpTorque(cylinders=cylinders).torque(grid(720))
    swept = 3.0 * cylinders[0].displacement
    assert -work(torque) == pytest.approx((9e6 - 1.2e5) * swept, rel=2e-5)
    # a triplex pump repeats with a third of a turn
    np.testing.assert_allclose(torque, np.roll(torque, 240), rtol=0.0, atol=1e-9 * np.ptp(torque))


def test_a_stiff_liquid_is_nearly_incompressible() -> None:
    """Work with a bulk modulus against the integral of p dV of the indicator diagram."""
    modulus, low, high, clearance = 1.5e9, 1e5, 40e6, 0.4
    cylinder = PumpCylinder(
        **DRIVE, suction_pressure=low, discharge_pressure=high, clearance=clearance,
        bulk_modulus=modulus,
    )  # fmt: skip
    rise = np.exp((high - low) / modulus)
    whole, left = 1.0 + clearance, clearance

    def area(start: float, end: float, pressure: float) -> float:
        def shut(volume: float) -> float:
            return pressure + modulus * float(np.log(start / volume))

        return float(scipy.integrate.quad(shut, start, end, epsrel=1e-12)[0])

    share = area(whole, whole / rise, low) + high * (left - whole / rise)
    share += area(left, left * rise, high) + low * (whole - left * rise)
    torque = PumpTorque(cylinders=(cylinder,)).torque(grid(3600))
    assert work(torque) == pytest.approx(share * cylinder.displacement, rel=1e-5)
    rigid = PumpCylinder(**DRIVE, suction_pressure=low, discharge_pressure=high)
    assert abs(share) * cylinder.displacement < (high - low) * rigid.displacement


def test_a_press_does_the_work_of_its_force() -> None:
    press = Press(
        eccentric_radius=0.04, rod_length=0.3, pin_offset=0.02, force=4e5, working_travel=0.006,
        ram_mass=120.0, phase=0.7,
    )  # fmt: skip
    torque = press_torque(press).torque(grid(720))
    assert -work(torque) == pytest.approx(4e5 * 0.006, rel=1e-12)
    # at rest within the working travel: virtual work, T = F dx/dtheta less the weight's share
    theta = press.phase + press.linkage.bottom_angle - 0.2
    finer = grid(36000)
    at = int(np.argmin(np.abs(finer - theta)))
    reach = float(np.diff(press.linkage.travel(finer[at] - 0.7 + np.array([-1e-5, 1e-5])))[0])
    force = 120.0 * 9.80665 - 4e5
    expected = force * reach / 2e-5
    assert press_torque(press).torque(finer)[at] == pytest.approx(expected, rel=1e-6)


def test_a_table_of_force_over_travel(tmp_path: Path) -> None:
    path = tmp_path / "force.csv"
    path.write_text("travel_mm,force_kN\n0,50\n2,120\n5,120\n5.5,0\n")
    press = Press(eccentric_radius=0.02, rod_length=0.15, file="force.csv")
    area = 1e3 * 1e-3 * (0.5 * (50 + 120) * 2 + 120 * 3 + 0.5 * 120 * 0.5)
    machine = press_torque(press, path)
    assert machine.work == pytest.approx(area, rel=1e-12)
    assert -work(machine.torque(grid(90))) == pytest.approx(area, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("travel_mm,force\n0,1\n1,2\n", "one column of force with its unit"),
        ("travel_mm,force_kN\n0,1\n", "1 rows, must be 2 rows or more"),
        ("travel_mm,force_kN\n0,1\n2,1\n1,1\n3,1\n", "travel_mm = 1 mm out of order"),
        ("travel_mm,force_kN\n0,1\n60,1\n", "from 0 mm to 40 mm"),
        ("travel_mm,force_kN\n0,0\n6,0\n", "0 N at every height"),
    ],
)
def test_a_bad_table_of_force_is_refused(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "force.csv"
    path.write_text(text)
    press = Press(eccentric_radius=0.02, rod_length=0.15, file="force.csv")
    with pytest.raises(InputError) as error:
        press_torque(press, path)
    assert words in str(error.value)


def test_pressure_over_720_deg_with_cylinders_that_differ(tmp_path: Path) -> None:
    """A polytropic cylinder's pressure through a file gives its torque back, at any phase."""
    cylinder = CompressorCylinder(
        **DRIVE, suction_pressure=1e5, discharge_pressure=4e5, clearance=0.1, phase=np.radians(90)
    )
    theta = grid(1440, 2.0 * TURN)
    head, _ = CompressorCylinder(
        **DRIVE, suction_pressure=1e5, discharge_pressure=4e5, clearance=0.1
    ).pressures(theta)
    path = tmp_path / "pressure.csv"
    rows = zip(np.degrees(theta), head, head**0 * 1.5e5, strict=True)
    lines = [f"{a:.6f};{b / 1e5:.12g};{c / 1e5:.12g}" for a, b, c in rows]
    path.write_text("\n".join(["angle_deg;p1_bar;p2_bar", *lines]))
    source = PressureTorqueFile(
        cycle=2.0 * TURN,
        file="pressure.csv",
        cylinders=(
            PressureCylinder(**DRIVE, column="p1", phase=np.radians(90)),
            PressureCylinder(bore=0.06, crank_radius=0.02, rod_length=0.1, column="p2"),
        ),
    )
    torque = pressure_torque(source, path).torque(theta)
    small = source.cylinders[1]
    steady = (1.5e5 - small.back_pressure) * small.head_area * small.linkage.travel_rate(theta)
    expected = cylinder.torque(theta) + steady
    np.testing.assert_allclose(torque, expected, rtol=0.0, atol=1e-7 * np.ptp(expected))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "an empty file"),
        ("angle_deg,torque_Nm\n", "0 rows"),
        ("angle_deg,torque\n" + "\n".join(f"{10 * k},{k % 5}" for k in range(36)), "its unit"),
        ("angle_deg,T_Nm\n" + "\n".join(f"{10 * k},7" for k in range(36)), "constant"),
        (
            "angle_deg,T_Nm\n" + "\n".join(f"{10 * k},{k}" for k in range(37)),
            "not closed, 36 N m",
        ),
        (
            "angle_deg,T_Nm\n" + "\n".join(f"{10 * k},{k}" for k in range(36)),
            "not closed, 35 N m",
        ),
        (
            "angle_deg,T_Nm\n" + "\n".join(f"{10 * k},{(-1) ** k}" for k in range(36)),
            "36 rows; the work changes by",
        ),
        (
            "angle_deg,T_Nm\n" + "\n".join(f"{20 * k},{np.sin(k):.6f}" for k in range(36)),
            "(this is 2 cycles), must be one cycle of 360 deg",
        ),
        (
            "angle_deg,T_Nm,M_Nm\n" + "\n".join(f"{10 * k},{k % 5},1" for k in range(36)),
            "one column of torque, or column = the beginning of its header",
        ),
    ],
    ids=["empty", "no rows", "unit", "constant", "open", "ramp", "aliased", "cycle", "columns"],
)
def test_a_bad_table_gets_one_clear_line(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "torque.csv"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        tabled_torque(TabledTorqueFile(file="torque.csv"), path)
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_a_ramp_whose_end_is_stated_is_a_sawtooth(tmp_path: Path) -> None:
    """Energy swing of a sawtooth of amplitude a about its mean over 2 pi: pi a / 4."""
    path = tmp_path / "torque.csv"
    rows = [f"{k},{0.1 * k:g}" for k in range(360)]
    path.write_text("\n".join(["angle_deg,T_Nm", *rows, "360,0"]))
    torque = tabled_torque(TabledTorqueFile(file="torque.csv"), path).torque(grid(720))
    swing = np.ptp(np.cumsum(torque - torque.mean())) * TURN / 720
    assert swing == pytest.approx(36.0 * np.pi / 4.0, rel=5e-3)


def test_a_good_table_is_its_own_torque(tmp_path: Path) -> None:
    path, theta = tmp_path / "torque.csv", grid(360)
    values = 20.0 + 9.5 * np.sin(2 * theta) - 5.7 * np.cos(5 * theta)
    rows = zip(np.degrees(theta), values, strict=True)
    path.write_text("\n".join(["angle_deg,torque_Nm", *(f"{a:.6f},{v:.12g}" for a, v in rows)]))
    machine = tabled_torque(TabledTorqueFile(file="torque.csv"), path)
    np.testing.assert_allclose(machine.torque(theta), values, rtol=0.0, atol=1e-9)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: HarmonicTorque(harmonics=()), "from 1 to"),
        (lambda: _harmonics(1.0, {1.0: (0.0, 0.0)}), "varies"),
        (lambda: _harmonics(1.0, {0.5: (0.0, 1.0)}), "a whole number of waves"),
        (lambda: _harmonics(1.0, {300.0: (0.0, 1.0)}).torque(grid(360)), "601 or more"),
        (
            lambda: CompressorCylinder(
                **DRIVE, suction_pressure=1e5, discharge_pressure=40e5, clearance=0.2
            ),
            "which the clearance of 0.2 allows",
        ),
        (
            lambda: PumpCylinder(**DRIVE, suction_pressure=1e5, discharge_pressure=1e5),
            "> suction_pressure",
        ),
        (lambda: Press(eccentric_radius=0.04, rod_length=0.3), "unless a file"),
        (
            lambda: Press(eccentric_radius=0.04, rod_length=0.3, force=1e5, working_travel=0.09),
            "the stroke",
        ),
        (
            lambda: PressTorque(
                Press(eccentric_radius=0.04, rod_length=0.3, file="f"),
                np.array([0.0, 0.01, 0.01]),
                np.ones(3),
            ),
            "strictly increasing",
        ),
    ],
)
def test_a_machine_out_of_bounds_is_refused(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()


def motor(*points: tuple[float, float]) -> MotorLine:
    return MotorLine(tuple(MotorPoint(speed=w, torque=t) for w, t in points))


INDUCTION = motor((0.0, 120.0), (140.0, 160.0), (157.0, 0.0))  # rising to its pull-out torque


LIGHT_PUMP = motor((4.0, 5.0), (4.25, 0.0))  # rad/s, on a crank of 0.05 kg m2


@pytest.mark.parametrize(
    ("line", "size", "share", "load", "start"),
    [
        (INDUCTION, 0.3, 0.05, (50.0, 40.0, 30.0), 150.0),
        (LIGHT_PUMP, 0.05, 0.0, (4.0, 5.0, 3.0), 4),
    ],
    ids=["induction", "steep line on a light crank"],
)
def test_the_speed_on_a_motor_line_is_that_of_the_equation_of_motion(
    line: MotorLine, size: float, share: float, load: tuple[float, float, float], start: float
) -> None:
    """Against a Runge-Kutta integration of up to 20 turns, until one ends where it began; 1e-9 is
    that of its steps.
    """
    theta, count = grid(720), 720

    def loaded(angle: Array) -> Array:
        return -load[0] - load[1] * np.sin(angle) - load[2] * np.cos(3.0 * angle)

    def inertia(angle: Array) -> Array:
        return size + share * np.sin(angle) ** 2

    def slope(angle: float, energy: Array) -> Array:
        return loaded(angle) + line.torque(np.sqrt(2.0 * energy / inertia(angle)))

    energy = np.array([0.5 * size * start**2])
    for _ in range(20):
        last = scipy.integrate.solve_ivp(
            slope,
            (0.0, TURN),
            energy,
            method="DOP853",
            rtol=1e-12,
            atol=1e-12 * energy[0],
            t_eval=[*theta, TURN],
        )
        energy = last.y[:, -1]
        if abs(energy[0] / last.y[0, 0] - 1.0) < 1e-12:
            break
    expected = np.sqrt(2.0 * last.y[0, :count] / inertia(theta))
    at = Inertia(size, share * np.sin(theta) ** 2)
    motion = crank_motion(loaded(theta), at, start, load=line, span=TURN)
    np.testing.assert_allclose(motion.speed, expected, rtol=1e-9)
    assert motion.closure < 1e-12
    assert -motion.load_torque.mean() == pytest.approx(load[0], rel=1e-12)


def test_a_steep_line_holds_the_speed_and_a_flat_one_gives_the_torque() -> None:
    """A flat line is a constant torque: the motion of today at the same mean speed."""
    theta = grid(720)
    load, inertia = -50.0 - 40.0 * np.sin(theta), Inertia.constant_only(0.3)
    flat = crank_motion(load, inertia, 150.0, load=motor((0, 51.5), (5150, 0)), span=TURN)
    mean = flat.statistics.mean
    constant = crank_motion(load, inertia, mean, span=TURN)
    np.testing.assert_allclose(flat.speed, constant.speed, rtol=2e-5)
    steep = crank_motion(load, inertia, 150.0, load=motor((0, 1.5e6), (150, 0)), span=TURN)
    assert steep.statistics.fluctuation < 1e-4 < flat.statistics.fluctuation


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (((0.0, 1.0),), "from 2 to 200"),
        (((1.0, 1.0), (1.0, 0.0)), "the point before"),
        (((0.0, 1.0), (1.0, 1.0)), "= 1 N m, must be < 1 N m, the point before"),
    ],
)
def test_a_bad_motor_line_is_refused(points: tuple[tuple[float, float], ...], words: str) -> None:
    with pytest.raises(InputError, match=words):
        Crankshaft(inertia=1.0, motor_line=tuple(MotorPoint(speed=w, torque=t) for w, t in points))


def test_a_motor_too_weak_is_named() -> None:
    theta = grid(720)
    with pytest.raises(CamError, match="cannot carry its load: 170 N m against 160 N m"):
        crank_motion(
            -170.0 + np.sin(theta), Inertia.constant_only(1.0), 150.0, load=INDUCTION, span=TURN
        )
    with pytest.raises(CamError, match="cannot carry its load"):  # swings past the pull-out speed
        crank_motion(
            -150.0 + 400.0 * np.sin(theta), Inertia.constant_only(0.1), 150.0, load=INDUCTION,
            span=TURN,
        )  # fmt: skip
