"""From simulation to tooth times and back; open measured traces go through."""

import numpy as np
import pytest
from crank_traces import CYCLE, noisy_times, tooth_angles
from pickup_records import error_and_bar, pickup_record, speed_of

from camwright.geometry.errors import InputError
from camwright.pipeline.engine.brake_balance import brake_balance
from camwright.pipeline.engine.crankshaft import Inertia, crank_motion
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.engine_torque import torque_from_cylinder
from camwright.pipeline.engine.pressure_trace import (
    PressureTable,
    cycle_statistics,
    pressure_from_csv,
    torque_from_pressure,
)
from camwright.pipeline.engine.speed_file import speed_from_csv
from camwright.pipeline.engine.speed_trace import Filter, speed_from_edges
from camwright.pipeline.engine.torque_consistency import implied_inertia
from camwright.pipeline.engine.trigger_wheel import TriggerWheel, counted

GX120 = CylinderEngine(
    bore=0.060,
    crank_radius=0.021,
    rod_length=0.073,
    compression_ratio=8.5,
    piston_mass=0.144,
    rod_mass=0.123,
)
INERTIA = 0.0139
NOISE = 0.22  # rad/s, the sensor's by Cardoso et al., Energies 2025, sec. 2.1.2


def phase(values, order=1):
    return np.angle(np.fft.rfft(values)[order])


@pytest.mark.parametrize("edges", [1, 2])
def test_ten_noisy_runs_give_the_torque_back(edges):
    """Standard deviation 5 %, amplitude 10 %, phase 2 deg asked for; 1 %, 4 %, 0.2 deg kept."""
    torque = torque_from_cylinder(GX120, 157.08).without_mean()
    speed = crank_motion(torque.total, Inertia.constant_only(INERTIA), 151.0).speed
    wheel, angles = TriggerWheel(36, 0), tooth_angles(36, 0, edges, 1)
    runs = [counted("run", noisy_times(speed, angles, NOISE, seed, wheel.pitch), wheel, edges == 2)
            for seed in range(10)]  # fmt: skip
    found = speed_from_edges("runs", runs, wheel, Filter()).with_firing()
    back = found.torque(INERTIA)
    assert found.count == 10
    # two standard errors: at least 9 * 72 degrees of freedom, neighbours sharing a time
    assert found.noise == pytest.approx(NOISE, rel=0.07)
    assert back.std == pytest.approx(torque.std, rel=0.01)
    assert back.peak_to_peak == pytest.approx(torque.peak_to_peak, rel=0.04)
    for order in (1, 2, 3):  # of the cycle: in crank degrees 2/order times the phase
        off = np.degrees(
            np.angle(np.exp(1j * (phase(back.total, order) - phase(torque.total, order))))
        )
        assert abs(off) * 2.0 / order < 2.0
    error = float(np.std(back.total - torque.total))
    assert error < 2.0 * found.noise_floor(INERTIA)
    assert found.noise_floor(INERTIA) < 0.1 * torque.std


def test_the_reconstructed_gx120_trace(shared_data):
    """Ten noisy runs built from the published statistics: speed std 3.74 rad/s, torque std
    6.25 N m with 0.0133 kg m2. Over sixteen harmonics the torque's std is 2 % and its amplitude
    4 % above the published ones; over ten 1 % above and 3 % below."""
    path = shared_data / "dossier" / "reference-speed-trace.csv"
    if not path.is_file():
        pytest.skip(f"{path.name} is not there")
    found = speed_from_csv(path, TriggerWheel(), Filter(16), column="test", unit="rad/s")
    assert found.count == 10
    assert found.noise == pytest.approx(0.22, rel=0.02)
    assert found.statistics.std == pytest.approx(3.74, rel=5e-3)
    torque = found.torque(0.0133)
    assert torque.std == pytest.approx(6.25, rel=0.03)
    assert torque.peak_to_peak == pytest.approx(29.79, rel=0.06)
    implied = implied_inertia(torque.total, found.statistics.mean, found.statistics.std)
    assert implied == pytest.approx(0.0133, rel=0.01)


YANMAR = PressureTable(
    file="yanmar-l100v-firing-18Nm.txt",
    bore=0.086,
    crank_radius=0.0375,
    rod_length=0.118,
    compression_ratio=21.2,
    piston_mass=0.5,
    rod_mass=0.5,
)


YANMAR_BRAKE = 18.0  # N m, of the dynamometer, in the name of the file


@pytest.fixture(scope="module")
def yanmar(shared_data):
    path = shared_data / "data" / YANMAR.file
    if not path.is_file():
        pytest.skip(f"{path.name} is not there")
    return pressure_from_csv(path, units=("deg", "bar"), firing_angle=0.0).pegged(98e3)


def test_the_yanmar_diesel_is_refused_at_the_dead_centre_of_its_file(yanmar):
    """Brake: 4 pi 18 N m / 435.66 cm3 = 519 kPa. The file as it stands has an indicated 477 kPa,
    which would be 43 kPa of negative friction; 59 kPa per deg, so 0.73 deg of dead centre or a gain
    of 1.09 close the difference."""
    balance = brake_balance(yanmar, YANMAR, YANMAR_BRAKE)
    pressure = CYCLE / YANMAR.displacement  # mean effective pressure per N m
    assert pressure * YANMAR_BRAKE == pytest.approx(519.2e3, rel=1e-3)
    assert pressure * balance.indicated == pytest.approx(476.5e3, rel=1e-3)
    assert cycle_statistics(yanmar, YANMAR).imep.mean() == pytest.approx(476.5e3, rel=1e-3)
    assert np.degrees(balance.shift) == pytest.approx(0.73, abs=0.01)
    with pytest.raises(InputError, match=r"dead centre 0\.73 deg earlier .* times 1\.090"):
        balance.guarded()


def test_the_yanmar_diesel_goes_through_at_its_dead_centre(yanmar):
    """The compression ends before ignition, at 359.5 deg of the file: its own peak is at 357.7 deg.
    A peak without combustion leads the dead centre by 0.3 to 1.2 deg, so the dead centre of the
    file is 1.1 to 2.0 deg late, 1.7 deg at the usual lead of 0.6 deg. A motored cycle of the same
    rig peaks 2.5 deg before its zero as well. The indicated pressure then is 541 to 594 kPa, above
    the brake's; its friction of 22 to 75 kPa is low for a diesel, so a gain some per cent low is
    likely besides. Masses of the running gear are assumed."""
    theta = np.degrees(yanmar.theta)
    before = (theta >= 352.0) & (theta <= 358.8)
    cubic = np.polynomial.Polynomial.fit(theta[before], yanmar.mean[before], 3)
    lead = 360.0 - next(root for root in cubic.deriv().roots() if 355.0 < root < 359.0)
    assert lead == pytest.approx(2.3, abs=0.1)  # cubics over other ranges differ by 0.1 deg
    for loss, expected in ((0.3, 594e3), (0.6, 576e3), (1.2, 541e3)):
        trace = yanmar.turned(np.radians(lead - loss)).guarded()
        trace.guard_scale(YANMAR, 98e3)
        statistics = cycle_statistics(trace, YANMAR)
        # 0.1 deg of the peak's angle are 6 kPa
        assert statistics.imep.mean() == pytest.approx(expected, abs=6e3)
        balance = brake_balance(trace, YANMAR, YANMAR_BRAKE).guarded()
        assert 0.85 < YANMAR_BRAKE / balance.indicated < 0.98
    assert statistics.peak.mean() == pytest.approx(66e5, rel=0.01)
    assert np.degrees(statistics.peak_angle.mean()) == pytest.approx(369.3 + lead - 1.2, abs=1.0)
    assert 0.01 < statistics.imep_variation < 0.03
    torque = torque_from_pressure(trace, YANMAR, 188.5, YANMAR_BRAKE)
    assert torque.mean == pytest.approx(YANMAR_BRAKE, abs=1e-9)
    assert 90.0 < torque.std < 130.0


def test_the_uneven_digitised_trace_goes_through(shared_data):
    """72 points up to 33.5 deg apart, ends that differ: refused unless such gaps are allowed."""
    path = shared_data / "data" / "opentorsion-cylinder-pressure.csv"
    if not path.is_file():
        pytest.skip(f"{path.name} is not there")
    units = ("deg", "MPa")
    with pytest.raises(InputError, match="gap after"):
        pressure_from_csv(path, units=units)
    trace = pressure_from_csv(path, units=units, gap_max=np.radians(35.0)).guarded()
    assert trace.mean.max() == pytest.approx(15.2e6, rel=0.01)
    # the interpolant is periodic: no step where the ends met
    steps = np.abs(np.diff(np.append(trace.mean, trace.mean[0])))
    assert steps[-1] < 2e4
    assert trace.theta[-1] < CYCLE


@pytest.mark.slow
def test_the_error_bar_holds_the_torque_of_200_pick_up_records():
    """Wheels 36-1, 60-2 and 4+1; clean, clipped on both sides or one, squared, either half wave;
    each with noise 20 dB below the signal, an offset and a drift.

    95 % of 200 are 190 +- 3; the parts of the bar that are bounds rather than deviations hold more.
    A bar holds all angles at once, some 3.7 standard errors: against the greatest error of the
    cycle it is 2 to 3 in the median.
    """
    held, bars, errors = 0, [], []
    for seed in range(200):
        record = pickup_record(seed)
        error, bar = error_and_bar(record, speed_of(record))
        held += bool((error <= bar).all())
        bars.append(bar.max() / np.ptp(record.torque))
        errors.append(error.max() / np.ptp(record.torque))
    assert held >= 182
    assert np.median(bars) < 5.0 * np.median(errors)
