"""From simulation to tooth times and back; open measured traces go through."""

import numpy as np
import pytest
from crank_traces import CYCLE, noisy_times, tooth_angles

from camwright.geometry.errors import InputError
from camwright.pipeline.engine.crankshaft import Inertia, crank_motion
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.pressure_trace import (
    PressureTable,
    cycle_statistics,
    pressure_from_csv,
    torque_from_pressure,
)
from camwright.pipeline.engine.speed_trace import Filter, speed_from_csv, speed_from_edges
from camwright.pipeline.engine.torque import torque_from_cylinder
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


def test_the_yanmar_diesel_goes_through(shared_data):
    """Sixty cycles of a diesel at 1800 rpm: 66 bar some 10 deg after dead centre, an IMEP of
    4.8 bar that scatters by 1 to 3 %. Masses of the running gear are assumed."""
    path = shared_data / "data" / YANMAR.file
    if not path.is_file():
        pytest.skip(f"{path.name} is not there")
    raw = pressure_from_csv(path, units=("deg", "bar"), firing_angle=0.0)
    assert raw.cycles.shape == (60, 3600)
    trace = raw.pegged(98e3).guarded()
    trace.guard_scale(YANMAR, 98e3)
    found = cycle_statistics(trace, YANMAR)
    assert found.peak.mean() == pytest.approx(66e5, rel=0.01)
    assert np.degrees(found.peak_angle.mean()) == pytest.approx(369.3, abs=1.0)
    assert found.imep.mean() == pytest.approx(4.77e5, rel=0.02)
    assert 0.01 < found.imep_variation < 0.03
    torque = torque_from_pressure(trace, YANMAR, 188.5)
    assert abs(torque.mean) < 1e-9
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
