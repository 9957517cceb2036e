"""The smoothers against closed forms, other implementations and the printed case."""

import csv
import os
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline
from scipy.signal import savgol_filter

from camwright.pipeline.smoothing.smoothers import KINDS, Smoother, smoothed
from camwright.pipeline.torque.period import FOUR_STROKE

COUNT = 720
CYCLE = FOUR_STROKE.angle
ROOT = Path(__file__).resolve().parents[2]
SHARED = Path(os.environ.get("CAMWRIGHT_SHARED", ROOT.parent / "shared"))


def torque(count: int = COUNT, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=count)


def test_moving_average_tends_to_the_box_at_second_order():
    # H_M - sinc = O(h^2) at a fixed window: the error falls fourfold with twice the points.
    width, order = np.deg2rad(60.0), np.arange(1.0, 13.0)
    box = np.sinc(order * 2.0 * np.pi / CYCLE * width / (2.0 * np.pi))
    errors = [
        np.abs(Smoother("moving_average", points=m, spacing=width / m).transfer(order) - box).max()
        for m in (24, 48, 96)
    ]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(rates, 2.0, atol=0.05)


def test_moving_average_is_the_one_in_closed_form():
    # Centred, half weights at the ends: sin(M x) cot(x) / M with x = w h / 2.
    points, spacing = 12, np.deg2rad(5.0)
    x = 0.5 * np.arange(1, 72) * spacing * 2.0 * np.pi / CYCLE
    found = Smoother("moving_average", points=points, spacing=spacing).transfer(np.arange(1, 72))
    np.testing.assert_allclose(found, np.sin(points * x) / np.tan(x) / points, atol=1e-14)


def test_savitzky_golay_is_the_limit_of_the_filter_on_samples():
    # The fit to samples differs from that to the window by the end effect, first order in h.
    # Two harmonics, so that no sampling error adds.
    width = np.deg2rad(60.0)
    errors = []
    for count in (1440, 2880, 5760):
        crank = np.arange(count) * CYCLE / count
        before = np.sin(1.5 * crank) + np.cos(4.0 * crank)
        window = round(width / (CYCLE / count)) + 1
        expected = savgol_filter(before, window, 2, mode="wrap")
        found = smoothed(before, Smoother("savitzky_golay", points=12, spacing=width / 12))
        errors.append(np.abs(found - expected).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(rates, 1.0, atol=0.1)
    assert errors[-1] < 1e-3


def test_gaussians_compose_by_their_variances():
    once = smoothed(torque(), Smoother("gaussian", width=0.5))
    twice = smoothed(once, Smoother("gaussian", width=1.2))
    np.testing.assert_allclose(
        twice, smoothed(torque(), Smoother("gaussian", width=1.3)), atol=1e-13
    )


@pytest.mark.parametrize("kind", KINDS)
def test_smoothing_the_torque_smooths_the_energy(kind):
    # Integration and a filter on the harmonics commute: the cam's energy is filtered alike.
    def energy(values: np.ndarray) -> np.ndarray:
        spectrum = np.fft.rfft(values)[1:-1]
        order = np.arange(1, len(spectrum) + 1)
        return np.fft.irfft(np.r_[0.0, spectrum / (1j * order), 0.0], n=len(values))

    smoother = Smoother(kind, strength=1.3)
    apart = energy(smoothed(torque(), smoother))
    np.testing.assert_allclose(apart, smoothed(energy(torque()), smoother), atol=1e-13)


@pytest.mark.parametrize("kind", KINDS)
def test_ripple_left_follows_from_the_harmonics(kind):
    # Parseval: the variance left is the sum of the harmonics' variances times H^2.
    smoother = Smoother(kind, strength=0.8)
    spectrum = np.fft.rfft(torque()) / COUNT
    share = np.abs(spectrum[1:]) ** 2 * smoother.transfer(np.arange(1, len(spectrum))) ** 2
    share[:-1] *= 2.0  # each but the last stands for a pair
    assert np.var(smoothed(torque(), smoother)) == pytest.approx(share.sum(), rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("finer", [2, 3])
def test_the_result_does_not_depend_on_the_sampling(kind, finer):
    # A torque of 60 harmonics, seen on two grids.
    spectrum = np.zeros(COUNT // 2 + 1, dtype=complex)
    spectrum[1:61] = np.exp(1j * np.arange(60.0)) / np.arange(1, 61)
    dense = np.zeros(finer * COUNT // 2 + 1, dtype=complex)
    dense[: len(spectrum)] = finer * spectrum
    coarse = smoothed(np.fft.irfft(spectrum, COUNT), Smoother(kind))
    fine = smoothed(np.fft.irfft(dense, finer * COUNT), Smoother(kind))
    np.testing.assert_allclose(fine[::finer], coarse, atol=1e-15)


def reference_torque() -> np.ndarray:
    path = SHARED / "dossier" / "reference-speed-trace.csv"
    if not path.exists():
        pytest.skip(f"the reconstructed trace is not at {path}")
    rows = list(csv.reader(line for line in path.open() if not line.startswith("#")))
    column = next(i for i, name in enumerate(rows[0]) if "torque" in name.lower())
    values = np.array([float(row[column]) for row in rows[1:]])
    return values[:COUNT] - values[:COUNT].mean()


@pytest.mark.parametrize(
    ("spacing", "peak", "left"), [(1.0, 24.9, 0.07), (5.0, 18.8, 1.43), (10.0, 10.9, 3.49)]
)
def test_twelve_values_on_the_reconstructed_trace(spacing, peak, left):
    """Peak and ideal residual of the three readings of "12 values", N m.

    They were found from the same trace by averaging its samples, printed to the last digit here
    (half of it is the tolerance, and 1 % for the interpolation between samples).
    """
    before = reference_torque()
    after = smoothed(before, Smoother("moving_average", spacing=np.deg2rad(spacing)))
    assert after.max() == pytest.approx(peak, abs=0.05 + 0.01 * peak)
    assert np.std(before - after) == pytest.approx(left, abs=0.005 + 0.01 * left)


def test_smoothing_spline_is_that_of_another_implementation():
    # Three cycles of samples, of which the ends do not reach the middle one. What is left is
    # that the sum over the samples stands for an integral: fourth order, 1e-7 at 0.5 deg.
    count, smoother = 1440, Smoother("smoothing_spline", cutoff=np.deg2rad(150.0))
    crank = np.arange(3 * count) * CYCLE / count
    before = np.sin(1.5 * crank) + np.cos(4.0 * crank) + 0.5 * np.sin(9.0 * crank + 1.0)
    weight = smoother.curvature_weight / (CYCLE / count)
    theirs = make_smoothing_spline(crank, before, lam=weight)(crank)[count : 2 * count]
    np.testing.assert_allclose(smoothed(before[:count], smoother), theirs, atol=1e-6)
