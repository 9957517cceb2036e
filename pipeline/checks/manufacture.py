"""Checks of space and manufacture: clearances, waviness, chord error, phase."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value, greatest_of
from camwright.geometry.contour import Contour
from camwright.geometry.extrema import first_greatest
from camwright.geometry.follower_path import Motion
from camwright.pipeline.base import levers
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    CAM_RADIUS,
    CHORD_SHARE,
    GUIDE_GAP,
    TORQUE_REDUCTION,
    WAVINESS,
)
from camwright.pipeline.checks import demands
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.cam_shape import contour_radius
from camwright.pipeline.checks.check import FACTOR_MAX, NONE, RIPPLE, STATED, Demand, Kept, check
from camwright.pipeline.checks.extremes import Extreme, cycle_of, row_of
from camwright.pipeline.checks.form_closure import INTERFERENCE
from camwright.pipeline.checks.missing_keys import lacking
from camwright.pipeline.checks.torque_balance import least_reduction
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.solution import Solution


def _gap_left(cam: LoadedCam, limit: float) -> Array:
    """Over the size of the follower; of the cam alone, as the gap of the follower is fixed."""
    mouth, motion = cam.numbers["guides.a.mouth"], cam.motion
    space = motion.height - cam.jet.lift + cam.highest + mouth - motion.contour_radius
    return 1.0 + (limit - space) / cam.numbers["follower.size"]


@check(
    GUIDE_GAP,
    title="Gap between guide A and cam or {follower}",
    tier=Tier.SCREENING,
    formula="min(h - max|P|, l - x) >= g; h: end of guide A over the cam axis, P: contour, l: end"
    " of guide A over the roller centre at maximum lift, x: extent of the follower or its fork,"
    " g: limits.guide_gap",
    symbols={
        "?": "follower.kind roller",
        "h": "pitch_height + lift_highest + guides.a.mouth [mm]",
        "P": "contour_radius_greatest",
        "l": "guides.a.mouth [mm]",
        "x": "follower.extent [mm]",
    },
    reason="Cam, roller or fork would strike the guide.",
    method="end of guide A less maximum contour radius, and less the follower, at maximum lift",
    lift_can_help=True,
    part="guides",
    load_cases=NONE,
    levers=(levers.one("follower.overhang_at_max_lift", most=2.0),),
    closed_by="force",
    page="Guides",
).measured(
    "contour",
    value=lambda worst, numbers: (
        numbers["guides.a.mouth"] - np.maximum(worst, numbers["follower.extent"])
    ),
    remark=lambda demand, _: replace(demand, at=None, note="the frame is not in the case"),
    deviation=1e-4,
    kept=Kept(_gap_left, once=True, unit="mm"),
)
def guide_gap(cam: LoadedCam) -> Array:
    """Measure: height of the contour over the follower's reference point at maximum lift, m.

    Of the demand, the gap between guide A and the nearest part of cam and follower.
    """
    return cam.motion.contour_radius - (cam.motion.height - cam.jet.lift + cam.highest)


cam_radius = check(
    CAM_RADIUS,
    id="cam_radius",
    title="Maximum cam radius",
    tier=Tier.SCREENING,
    formula="max |P| <= R; P: contour, R: limits.cam_radius",
    symbols={
        "P": "contour_radius",
    },
    reason="The cam must fit into its space.",
    method="greatest radius of the contour, refined between samples",
    lift_can_help=True,
    load_cases=NONE,
    levers=(levers.one("cam.prime_radius", -1, 2.0), *levers.SPRING, *levers.GENTLER),
    closed_by="plate",
    page="Cam",
).measured("contour", deviation=1e-4, kept=Kept(factor_max=FACTOR_MAX))(contour_radius)


_HEIGHT, _LENGTH = "cam.waviness", "cam.waviness_length"


def _wave_force(cam: LoadedCam, motion: Motion) -> Array:
    """Amplitude of the inertia force of the follower on the waves of a track (..., n), N, at the
    speed of its contour.
    """
    numbers, speed = cam.numbers, cam.speed * motion.contour_speed
    amplitude = 0.5 * numbers[_HEIGHT]
    square: Array = (FULL_TURN * speed / numbers[_LENGTH]) ** 2
    return numbers["follower.mass"] * amplitude * square


def _force_of_waves(cam: LoadedCam, limit: float) -> Array | None:
    """No constraint without a height of the waves."""
    if cam.numbers.get(_HEIGHT) is None:
        return None
    return demands.over_normal_force(cam, _wave_force(cam, cam.motion) / limit)


def _waves_in_words(demand: Demand, solution: Solution) -> Demand:
    high, long = (float(solution.numbers[key]) for key in (_HEIGHT, _LENGTH))
    return replace(demand, note=f"waves of {shown(high, 'um', 3)} over {shown(long, 'mm')}")


@check(
    WAVINESS,
    id="profile_waviness",
    title="Waviness inertia force / contact force",
    tier=Tier.SCREENING,
    formula="max m a (2 pi v/lambda)^2 / N <= c; m: moving mass, a: half of cam.waviness_height,"
    " else of that of cam.process at lambda and at most of cam.profile_tolerance, v: speed of the"
    " contact along the contour, lambda: cam.waviness_length, N: contact force, at least 1 % of the"
    " least spring force, c: limits.waviness",
    symbols={
        "m": "follower.mass",
        "a": "cam.waviness/2 [um]",
        "v": "cam.speed contour_speed [m/s]",
        "lambda": "cam.waviness_length",
        "N": "normal_force",
    },
    reason="Waves of the surface unload the contact and mark it.",
    method="m a (2 pi v/lambda)^2 of sine waves",
    values=(*given.LOADS, "cam.process", "cam.waviness_*", "cam.profile_tolerance"),
    levers=(levers.one("cam.profile_tolerance", -1, 10.0), levers.MASS, *levers.SPRING),
    closed_by="force",
    page="Cam",
).measured(
    "angles",
    needed=(_HEIGHT,),
    remark=_waves_in_words,
    deviation=0.05,
    smooth=False,
    kept=Kept(_force_of_waves),
)
def profile_waviness(cam: LoadedCam) -> Array:
    """Inertia force of the follower by contour waviness over the contact force."""
    waves = _wave_force(cam, cam.motion)
    return demands.over_contact_force(waves, cam.normal, cam.least_spring)


class _PressedWaves(NamedTuple):
    """Waves on both of preloaded discs (..., n), N: inertia force of the follower on them along the
    travel of the first roller, shares of it that each disc bears, and force left on each.
    """

    inertia: Array
    shares: tuple[Value, Value]
    left: tuple[Array, Array]
    preload: Array

    @classmethod
    def of(cls, cam: LoadedCam) -> _PressedWaves | None:
        """Of a cam; None without an interference.

        The mass on both tracks as springs follows the waves of a track by its share of their
        stiffness; their phases are the worst.
        """
        squeeze, numbers = cam.squeeze, cam.numbers
        if squeeze is None:
            return None
        shares, forces = (squeeze.share, 1.0 - squeeze.share), squeeze.forces(cam.axial)
        damping, amplitude = numbers["follower.damping_ratio"], 0.5 * numbers[_HEIGHT]
        inertia: Array = np.zeros(squeeze.preload.shape)
        for body, force, share in zip(cam.on_bodies, forces, shares, strict=True):
            pressed = np.real(force) > 0.0
            along = np.where(pressed, body.normal, 1.0) / np.where(pressed, force, 1.0)
            rigid = _wave_force(cam, body.motion)
            square = rigid / (amplitude * squeeze.stiffness)
            grown = np.sqrt((1.0 - square) ** 2 + (2.0 * damping) ** 2 * square)
            inertia = inertia + share * along * rigid / grown
        lost = squeeze.preload * numbers["cam.profile_tolerance"] / squeeze.interference
        return cls(inertia, shares, (forces[0] - lost, forces[1] - lost), squeeze.preload)

    @property
    def used(self) -> tuple[Array, Array]:
        """Change of the force on each disc over the force left, the latter at least a share of the
        preload.
        """
        first, second = (
            demands.over_contact_force(share * self.inertia, left, self.preload)
            for share, left in zip(self.shares, self.left, strict=True)
        )
        return first, second


def _pressed_waves_in_words(demand: Demand, solution: Solution) -> Demand:
    worded = _waves_in_words(demand, solution)
    if demand.at is None:
        return worded
    cycle, k = row_of(solution.cycles, demand.at)
    waves = _PressedWaves.of(solution.cams[cycle])
    if waves is None:
        return worded
    disc = first_greatest([float(each[k]) for each in waves.used])
    share = float(np.broadcast_to(waves.shares[disc], waves.inertia.shape)[k])
    stated = {"b": share, "I": float(waves.inertia[k]), "F": float(waves.left[disc][k])}
    return replace(worded, stated=stated)


@check(
    WAVINESS,
    id="preload_waviness",
    title="Waviness inertia force / force left on either preloaded disc",
    tier=Tier.SCREENING,
    formula="max b I/F <= c; b: share of an axial force that a disc bears, k/K, k: stiffness of its"
    " roller with what holds it along the travel of the first roller, K: sum of both, I: sum of b m"
    " w W^2/sqrt((1 - r^2)^2 + (2 zeta r)^2) over both discs, m: follower.mass, w: a along that"
    " travel, a: half of cam.waviness_height as of profile_waviness, W: 2 pi v/lambda, v: speed of"
    " the contact along the contour, lambda: cam.waviness_length, r: W/sqrt(K/m), zeta:"
    " follower.damping_ratio, F: force on the disc along the travel, with an interference less by"
    " cam.profile_tolerance, c: limits.waviness",
    symbols={"b": STATED, "I": f"{STATED} [N]", "F": f"{STATED} [N]"},
    reason="Waves of the surface unload the contact and mark it; how far they narrow the"
    " interference by themselves is within the profile tolerance, see preload_least.",
    method="mass on the springs of both rollers over sine waves of both discs in the worst phase",
    values=(
        *given.LOADS,
        *("cam.process", "cam.waviness_*", "cam.profile_tolerance", "follower.damping_ratio"),
        INTERFERENCE,
    ),
    levers=(
        levers.one(INTERFERENCE),
        levers.one("cam.profile_tolerance", -1, 10.0),
        levers.MASS,
        *levers.GENTLER,
    ),
    needs="roller",
    closed_by="preload",
    page="Cam",
).measured("angles", needed=(_HEIGHT,), remark=_pressed_waves_in_words, deviation=0.05)
def preload_waviness(cam: LoadedCam) -> Array:
    """Change of the force on either preloaded disc by contour waviness over the force left."""
    waves = _PressedWaves.of(cam)
    if waves is None:
        return np.full(np.shape(cam.normal), np.nan)
    return greatest_of(*waves.used)


@check(
    CHORD_SHARE,
    id="chord_error",
    title="Chord error of the contour table",
    formula="max l^2/(8 rho) <= c t; l: distance of neighbouring points, rho: radius of"
    " curvature, c: limits.chord_share, t: cam.profile_tolerance",
    symbols=dict.fromkeys(("l", "rho"), f"{STATED} [mm]"),
    reason="A machine that joins the points by lines makes the error.",
    unit="um",
    method="greatest step^2/(8 rho) between the points of workshop/contour.csv",
    moved_by_tolerance=False,
    load_cases=NONE,
    levers=(levers.one("workshop.table_step", -1),),
    page="Cam",
)
def chord_error(solution: Solution) -> Demand:
    """Greatest distance of the chords between the points of the workshop table from the contour,
    m.
    """
    limits, tolerance = solution.machine.limits, solution.machine.cam.profile_tolerance
    theta = solution.case.workshop_order.theta
    every = [_chords(each.contour, theta) for each in solution.discs]
    number = first_greatest([float(sag.max()) for sag, _, _ in every])
    (sag, step, curvature), disc = every[number], solution.discs[number]
    worst = first_greatest(sag)
    return Demand(
        float(sag[worst]),
        None if tolerance is None else limits[CHORD_SHARE] * tolerance,
        Extreme(float(sag[worst]), "", disc.angle(float(theta[worst]))),
        lacking(solution.machine.cam.table, solution.machine.cam, "profile_tolerance"),
        note=f"{theta.size} points",
        stated={"l": float(step[worst]), "rho": 1.0 / float(curvature[worst])}
        if curvature[worst]
        else {},
    )


def _chords(contour: Contour, theta: Array) -> tuple[Array, Array, Array]:
    """Sag of the chord from each point of a contour (n,), its length, m, and the greater curvature
    at its ends, 1/m.
    """
    points = contour.points(theta)
    step = np.hypot(*(np.roll(points, -1, axis=1) - points))
    curvature = np.abs(1.0 / contour.radius_of_curvature(theta))
    curvature = np.maximum(curvature, np.roll(curvature, -1))
    return step**2 * curvature / 8.0, step, curvature


@check(
    TORQUE_REDUCTION,
    id="phase_tolerance",
    title="Torque ripple reduction at phase tolerance",
    formula="min over the load cases of 1 - (1 - c)/(1 - c_i) std(T_e' - T_c)/std(T_e) >= c; T_e,"
    " T_c: torque of machine and cam, T_e': that of the machine at phi + d or phi - d, whichever is"
    " worse, d: tolerances.phase, c, c_i: as of torque_reduction",
    symbols={
        "std(T_e)": "std(torque_before) [N m]",
        "std(T_e' - T_c)": f"{STATED} [N m]",
        "c": "torque.greatest_reduction",
        "c_i": "torque.required_reduction",
    },
    reason="Does not decide: the tolerance corners judge torque_reduction at the phase tolerance"
    " too.",
    method="torque shifted by plus and minus the phase tolerance; the lesser",
    must_have=False,
    moved_by_tolerance=False,
    load_cases=RIPPLE,
    values=given.LOADS,
    page="Cam",
)
def phase_tolerance(solution: Solution) -> Demand | None:
    """Ripple reduction at the worse end of the phase tolerance of key and gear; None without an
    engine.
    """
    phase = solution.case.tolerances.phase
    least = least_reduction(solution, lambda cycle: _reduction(cycle, phase))
    if least is None:
        return None
    worst, required = least
    shifted = _shifted(cycle_of(solution.cycles, worst), phase)
    return Demand(
        worst.value if phase > 0 else None,
        required,
        worst,
        () if phase > 0 else ("tolerances.phase",),
        note=f"{shown(phase, 'deg')} of the shaft" if phase > 0 else "",
        stated={"std(T_e' - T_c)": float(max(map(np.std, shifted)))},
    )


def _reduction(cycle: Cycle, phase: float) -> float:
    """Lesser ripple reduction with the engine torque advanced and delayed by a crank angle, rad;
    NaN without an engine.
    """
    before = cycle.turn.torque_before
    if before is None:
        return np.nan
    shifted = _shifted(cycle, phase)
    return float(np.min([demands.ripple_reduction(before, each) for each in shifted]))


def _shifted(cycle: Cycle, phase: float) -> list[Array]:
    """Crank torques with the cam (n,), N m, of an engine torque advanced and of one delayed by a
    crank angle, rad; a single one of NaN without an engine.
    """
    before, after = cycle.turn.torque_before, cycle.turn.torque_after
    if before is None or after is None:
        return [np.full(cycle.theta.size, np.nan)]
    # A shift of the harmonics is exact.
    waves = np.fft.rfft(before)
    order, cam_torque = np.arange(waves.size), before - after
    advance = phase / cycle.machine.gear_ratio
    return [
        np.fft.irfft(waves * np.exp(1j * order * angle), before.size) - cam_torque
        for angle in (-advance, advance)
    ]
