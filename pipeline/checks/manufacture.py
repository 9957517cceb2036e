"""Limits of what the shop makes: table, waves and form of the contour, timing of the gears."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence, Worst, greatest, worst_case
from camwright.pipeline.checks.torque_balance import TORQUE_REDUCTION, cycles_of_ripple

if TYPE_CHECKING:
    from camwright.pipeline.cycle.cycle import Cycle


def profile_waviness(evidence: TrialEvidence) -> Check:
    """Force of the follower riding over the contour's waves beside the contact force."""
    case = evidence.case
    band, length = case.cam.profile_tolerance, case.cam.waviness_length
    mass = case.follower.mass

    def force(cycle: Cycle) -> Array:
        along = evidence.cam_speed(cycle) * _path(evidence, cycle.theta)
        # A wave that fills the band of the tolerance has half of it as amplitude.
        added = mass * 0.5 * (band or 0.0) * (FULL_TURN * along / length) ** 2
        nominal = cycle.loads.normal_force
        held = nominal > 0
        share = np.where(held, added / np.where(held, nominal, 1.0), np.inf)
        return np.where(np.isnan(nominal), np.nan, share)

    worst = greatest(evidence, force) if band is not None else Worst(np.nan, "", None)
    return Check(
        id="profile_waviness",
        title="Force of the contour's waves over the contact force",
        demand=worst.value,
        limit=case.limits.waviness,
        unit="-",
        source=evidence.source("waviness", "10 to 20 % of the force, Rothbart (2004) sec. 10.4"),
        method=f"m delta (2 pi v/lambda)^2, waves that fill the profile tolerance,"
        f" {1e3 * length:g} mm long",
        note="" if band is not None else "no profile tolerance is given",
        **worst.place,
    )


def chord_error(evidence: TrialEvidence) -> Check:
    """What straight lines between the points of the shop's contour table miss of it."""
    tolerance, share = evidence.case.cam.profile_tolerance, evidence.case.limits.chord_share
    theta = evidence.case.workshop.theta
    contour = evidence.contour
    points = contour.points(theta)
    step = np.hypot(*(np.roll(points, -1, axis=1) - points))
    bend = np.abs(1.0 / contour.radius_of_curvature(theta))
    sag = step**2 * np.maximum(bend, np.roll(bend, -1)) / 8.0
    worst = int(np.argmax(sag))
    return Check(
        id="chord_error",
        title="Chord error of the contour's table",
        demand=1e6 * float(sag[worst]),
        limit=None if tolerance is None else 1e6 * share * tolerance,
        unit="um",
        cam_angle_deg=float(np.rad2deg(theta[worst])),
        source=evidence.source("chord_share", "a quarter of the profile tolerance, geometry"),
        method=f"greatest step^2/(8 rho) between the {theta.size} points of shop/contour.csv",
        note="" if tolerance is not None else "no profile tolerance is given",
    )


def phase_tolerance(evidence: TrialEvidence) -> Check | None:
    """Ripple still taken away when key and gear stand as far off as they may."""
    running = cycles_of_ripple(evidence)
    if not running:
        return None
    phase, ratio = evidence.case.tolerances.phase, evidence.case.mechanism.gear_ratio
    worst = worst_case(
        replace(evidence, cycles=running),
        lambda cycle: _reduction(cycle, phase, ratio),
        at_least=True,
    )
    return Check(
        id="phase_tolerance",
        title="Torque ripple taken away at the end of the phase tolerance",
        demand=worst.value if phase > 0 else None,
        limit=evidence.case.limits.torque_reduction,
        unit="-",
        sense="at_least",
        source=evidence.source(TORQUE_REDUCTION, "least value asked for by the case"),
        method=f"the engine's torque {np.rad2deg(phase):g} deg of crank early and late, the worse",
        must_have=False,
        note="" if phase > 0 else "no phase tolerance is given",
        **worst.place,
    )


def _reduction(cycle: Cycle, phase: float, ratio: float) -> float:
    before = np.asarray(cycle.torque_before, dtype=float)
    taken = before - np.asarray(cycle.residual_torque, dtype=float)
    ripple = float(np.std(before))
    if not ripple > 0:
        return float(np.nan)
    # As many periods as the cycle holds: a shift is exact in its harmonics.
    waves = np.fft.rfft(before)
    order = np.arange(waves.size)
    left = [
        np.std(np.fft.irfft(waves * np.exp(-1j * order * late / ratio), before.size) - taken)
        for late in (-phase, phase)
    ]
    return float(1.0 - np.max(left) / ripple)


def _path(evidence: TrialEvidence, theta: Array) -> Array:
    """Way of the contact along the contour per radian (n,), m."""
    return np.abs(evidence.contour.speed(theta))


CHECKS = (profile_waviness, chord_error, phase_tolerance)
