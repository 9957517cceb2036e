"""Figures of the slider-crank and the eccentric cam (2024): motion, forces, energy, workspaces."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn
from validation.friction_identification import (
    Identified,
    Pendulum,
    from_pendulum,
    from_run_down,
)
from validation.mechanism_sizes import OFFSET_SHARE, Workspace, workspace
from validation.paper_figure import (
    PUBLISHED,
    Beside,
    Look,
    PaperCurve,
    PaperFigure,
    PaperPanel,
    beside,
    closed,
    closed_angle,
)
from validation.published_figures import Target
from validation.slider_crank_2024 import (
    CREEP,
    FRICTION,
    PRINTED_LOAD,
    SLIP_FRICTION,
    SPEED,
    TRACTION,
    drives,
)
from validation.slider_crank_drive import (
    EccentricDrive,
    Losses,
    SliderCrankDrive,
    holding_force,
)

PHI = "crank angle φ₁, deg"
COUNT = 720
ANGLE = closed_angle(COUNT, 360.0)
SIZES = "Dimensions are inferred from the printed energies, masses and spring assumed."
PAIRS = ("shaft", "guide", "pin_a", "pin_b", "sliding")
SPEEDS = np.linspace(2.0, SPEED, 60)
EXPERIMENTS = 5
# Appendix A.2
PENDULUM = Pendulum(mass=0.603, length=0.492, inertia=2.62e-2)
SWING, SWING_TIME, SWING_STEP, SWING_NOISE = 0.1, 20.0, 0.05, 5e-4  # rad, s, s, rad; assumed
SHAFT_INERTIA = 0.075  # kg m2, of the shared parts; assumed
DOWN_TIME, DOWN_STEP, DOWN_NOISE = 1.2, 0.01, 0.1  # s, s, rad/s; assumed
_SEED = 2024

Drive = SliderCrankDrive | EccentricDrive


def figures(targets: Mapping[str, Target]) -> tuple[PaperFigure, ...]:
    """Figures 5 to 10, 13 to 15 and of the appendix of the paper."""
    rod, cams = drives()
    named: dict[str, Drive] = {
        "slider-crank": rod, "big roller": cams["big"], "small roller": cams["small"]
    }  # fmt: skip
    space = workspace(FRICTION, SPEED)
    return (
        _motion(rod, cams),
        _forces(targets, named),
        _energy(targets, rod, cams),
        _workspaces(space),
        _differences(targets, space),
        _run_down(named),
        _inertia(targets, named),
        _friction(targets),
    )


def _over_turn(label: str, values: Array, series: int, look: Look = "line") -> PaperCurve:
    return PaperCurve(label, ANGLE, closed(values), series, look)


def _each(named: Mapping[str, Drive], of: Callable[[Drive], Array]) -> tuple[PaperCurve, ...]:
    looks: tuple[Look, ...] = ("dashed", "line", "line")
    return tuple(
        _over_turn(name, of(drive), k, look)
        for k, ((name, drive), look) in enumerate(zip(named.items(), looks, strict=True))
    )


def _motion(rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive]) -> PaperFigure:
    phi, linkage = uniform_turn(COUNT), rod.linkage
    spins = {"slider-crank, rod": (linkage.rod_rate(phi), linkage.rod_rate_slope(phi))} | {
        f"{name} roller": (
            -cam.rolling_way(phi) / cam.roller_radius,
            -cam.rolling_way_slope(phi) / cam.roller_radius,
        )
        for name, cam in cams.items()
    }  # fmt: skip
    return PaperFigure(
        "e24-motion", "E24", "5 and 6", "Motion of the slider, of the rod and of the rollers",
        f"From above: slider speed over shaft speed; slider acceleration at {SPEED:.4g} rad/s; "
        "angular speed and acceleration of the rod and of the rollers, which turn against the "
        f"shaft and roll without slip. {SIZES}",
        (
            PaperPanel(PHI, "speed ratio, mm/rad",
                  (_over_turn("all three", 1e3 * linkage.height_rate(phi), 0),)),
            PaperPanel(PHI, "acceleration, m/s²",
                  (_over_turn("all three", SPEED**2 * linkage.height_rate_slope(phi), 0),)),
            PaperPanel(PHI, "angular speed, rad/s", tuple(
                _over_turn(name, SPEED * spin, k) for k, (name, (spin, _)) in
                enumerate(spins.items()))),
            PaperPanel(PHI, "ang. acceleration, rad/s²", tuple(
                _over_turn(name, SPEED**2 * rate_slope, k) for k, (name, (_, rate_slope)) in
                enumerate(spins.items()))),
        ),
    )  # fmt: skip


def _forces(targets: Mapping[str, Target], named: Mapping[str, Drive]) -> PaperFigure:
    phi = uniform_turn(COUNT)

    def efficiency(drive: Drive) -> Array:
        motor = drive.reactions(phi, SPEED).motor
        return np.asarray(holding_force(drive.spring, drive.linkage, phi) / motor)

    def size(name: str) -> Callable[[Drive], Array]:
        return lambda drive: np.hypot(*getattr(drive.reactions(phi, SPEED), name))

    means = {
        name: float(drive.reactions(phi, SPEED).normal.mean()) for name, drive in named.items()
    }
    pins = {name: float(size("b")(drive).mean()) for name, drive in named.items()}
    highest = max(pins, key=lambda name: pins[name])
    return PaperFigure(
        "e24-forces", "E24", "7", "Reactions of the pairs and efficiency of the force",
        "From above: shaft O; pin A, of the cams the contact force; pin B; guide; spring force "
        f"over motor torque. {SIZES} The forces of the small roller come from a traction that "
        "rolling without slip needs and its contact cannot transmit.",
        (
            PaperPanel(PHI, "shaft O, N", _each(named, size("o"))),
            PaperPanel(PHI, "pair A, N", _each(named, size("a"))),
            PaperPanel(PHI, "pin B, N", _each(named, size("b"))),
            PaperPanel(
                PHI, "guide, N", _each(named, lambda d: np.abs(d.reactions(phi, SPEED).side))
            ),
            PaperPanel(PHI, "force over torque, 1/m", _each(named, efficiency)),
        ),
        (
            beside(targets, "E24-08", means["big roller"]),
            beside(targets, "E24-09", means["small roller"]),
            Beside("highest reactions in all pairs", "small roller", highest, "",
                   targets["E24-18"].basis, "E24-18"),
        ),
    )  # fmt: skip


def _energy(
    targets: Mapping[str, Target], rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive]
) -> PaperFigure:
    rows: dict[str, Losses] = {"slider-crank": rod.losses(SPEED)}
    for name, cam in cams.items():
        rows[f"{name} roller"] = cam.losses(SPEED)
    for name, cam in cams.items():
        for mu in SLIP_FRICTION:
            rows[f"{name}, slip at {mu:g}"] = cam.slipping_losses(SPEED, mu)
    places, left, curves = np.arange(len(rows), dtype=float), np.zeros(len(rows)), []
    for k, pair in enumerate(PAIRS):
        end = left + [getattr(losses, pair) for losses in rows.values()]
        label = pair.replace("_a", " A").replace("_b", " B")
        curves.append(PaperCurve(label, left, places, k, "bar", end))
        left = end
    printed = [targets[f"E24-{k:02d}"].value for k in (1, 2, 3)]
    curves.append(PaperCurve("printed in the paper", printed, places[:3], PUBLISHED, "points"))
    crank, big, small = (
        rows[name].total for name in ("slider-crank", "big roller", "small roller")
    )
    need = float(cams["small"].traction_needed(uniform_turn(COUNT), SPEED).mean())
    creep = {
        name: cams[name].sliding_loss(SPEED, TRACTION[name], CREEP, PRINTED_LOAD[name])
        for name in cams
    }
    return PaperFigure(
        "e24-energy", "E24", "8", "Friction energy of a turn by pair",
        f"Viscous friction as printed at {SPEED:.4g} rad/s. {SIZES} The energy of the small roller "
        "rests on rolling without slip, which needs a traction coefficient of "
        f"{need:.1f} on average. Below, the rollers slip at the traction stated: at 0.2 the order "
        "is the measured one, with a small difference.",
        (
            PaperPanel("friction energy of a turn, J", "", tuple(curves), kind="bars",
                  rows=tuple(rows)),
        ),
        (
            beside(targets, "E24-01", crank),
            beside(targets, "E24-02", big),
            beside(targets, "E24-03", small),
            beside(targets, "E24-04", 100 * (crank / big - 1), ratio_scale=False),
            beside(targets, "E24-05", 100 * (small / big - 1), ratio_scale=False),
            beside(targets, "E24-06", creep["big"]),
            beside(targets, "E24-07", creep["small"]),
        ),
    )  # fmt: skip


MECHANISMS = {"slider_crank": "slider-crank", "big": "big roller", "small": "small roller"}


def _range(space: Workspace, values: Array, label: str, series: int) -> list[PaperCurve]:
    """Band of values (cranks, ratios) between their extremes over the ratios."""
    known = values[:, np.isfinite(values).all(axis=0)]
    cranks, low, high = 1e3 * space.cranks, known.min(axis=1), known.max(axis=1)
    return [
        PaperCurve(label, cranks, low, series, "band", high),
        PaperCurve("", cranks, low, series, "thin"),
        PaperCurve("", cranks, high, series, "thin"),
    ]


def _workspaces(space: Workspace) -> PaperFigure:
    def panel(suffix: str, title: str) -> PaperPanel:
        curves = [
            curve
            for k, (name, label) in enumerate(MECHANISMS.items())
            for curve in _range(space, getattr(space, name + suffix), label, k)
        ]
        return PaperPanel("crank l₁, mm", "energy of a turn, J", tuple(curves), title=title)

    return PaperFigure(
        "e24-workspaces", "E24", "9", "Friction energy over the sizes of the mechanisms",
        f"Friction energy of a turn at {SPEED:.4g} rad/s over the crank length; each band covers "
        "the ratios of rod and crank from 2 to 10 (with offset from 4, where the sizes allow it). "
        "Rollers of two thirds and one third of the rod length, the limits of equation 46. Viscous "
        "friction, no masses.",
        (panel("", "Without offset"), panel("_offset", f"Offset of {OFFSET_SHARE:g} cranks")),
    )  # fmt: skip


def _differences(targets: Mapping[str, Target], space: Workspace) -> PaperFigure:
    rivals = {
        "slider_crank": "slider-crank", "small": "small roller",
        "slider_crank_offset": "slider-crank, offset", "big_offset": "big roller, offset",
        "small_offset": "small roller, offset",
    }  # fmt: skip
    series = {"slider_crank": 0, "big_offset": 1, "small": 2}

    def panel(names: tuple[str, ...], title: str) -> PaperPanel:
        curves = [
            curve
            for name in names
            for curve in _range(
                space, 100.0 * space.above_best(name), rivals[name],
                series.get(name, series.get(name.removesuffix("_offset"), 3)),
            )
        ]  # fmt: skip
        return PaperPanel("crank l₁, mm", "above the best, %", tuple(curves), title=title)

    rod, small = (100 * space.above_best(name) for name in ("slider_crank", "small"))
    best = f"{space.big_is_best} of {space.combinations}"
    return PaperFigure(
        "e24-differences", "E24", "10", "Friction energy above that of the best mechanism",
        "Best is in all cases the eccentric cam with the big roller and no offset. Bands as in "
        f"Figure 9. The slider-crank lies {rod.min():.1f} to {rod.max():.1f} % above it, the small "
        f"roller {small.min():.1f} to {small.max():.1f} %, most at the smallest crank and ratio.",
        (
            panel(("slider_crank", "small"), "Without offset"),
            panel(("slider_crank_offset", "big_offset", "small_offset"),
                  f"Offset of {OFFSET_SHARE:g} cranks"),
        ),
        (
            Beside("combinations with the big roller without offset best", "all", best, "",
                   targets["E24-14"].basis, "E24-14"),
        ),
    )  # fmt: skip


def _run_down(named: Mapping[str, Drive]) -> PaperFigure:
    """Run-down with the common inertia alone: viscous losses are linear in the speed."""
    time, down, fall = np.linspace(0.0, 2.5, 200), [], []
    for k, (name, drive) in enumerate(named.items()):
        rate = drive.losses(SPEED).total / (FULL_TURN * SPEED * SHAFT_INERTIA)  # 1/s
        down.append(PaperCurve(name, time, SPEED * np.exp(-rate * time), k))
        energy = np.array([drive.losses(float(speed)).total for speed in SPEEDS])
        fall.append(PaperCurve(name, SPEEDS, -2.0 * energy / SHAFT_INERTIA, k))
    return PaperFigure(
        "e24-run-down", "E24", "13 and 15", "Run-down, and energy lost in each turn",
        f"Run-down from {SPEED:.4g} rad/s by viscous friction with {SHAFT_INERTIA:g} kg m² in "
        "common (assumed), rollers without slip. Below: change of the square of the speed over a "
        "turn, as the paper evaluates its tests. They have the same order; the motor ran at 36 "
        "rad/s with the small roller and at 37.5 with the others. Its characteristic is not "
        "printed.",
        (
            PaperPanel("time, s", "shaft speed, rad/s", tuple(down)),
            PaperPanel("shaft speed, rad/s", "change of ω², rad²/s²", tuple(fall)),
        ),
    )  # fmt: skip


def _inertia(targets: Mapping[str, Target], named: Mapping[str, Drive]) -> PaperFigure:
    phi = uniform_turn(COUNT)
    discs = {name: d.masses.disc_inertia for name, d in named.items()}
    rises = {
        name: 100 * float(d.reduced_inertia(phi).max() / d.masses.common - 1)
        for name, d in named.items()
    }
    rows = zip(("small roller", "big roller"), (0, 1), strict=True)
    return PaperFigure(
        "e24-inertia", "E24", "14", "Inertia reduced to the shaft",
        f"Equations 49 and 50 with {SHAFT_INERTIA:g} kg m² in common. The masses are not printed: "
        "1 kg of slider, 0.6 kg of rod, and rollers and discs of solid steel 20 mm wide.",
        (
            PaperPanel(
                PHI, "reduced inertia, kg m²", _each(named, lambda d: d.reduced_inertia(phi))
            ),
        ),
        (
            *(beside(targets, "E24-11", discs[name], place=k, note=name) for name, k in rows),
            *(
                beside(targets, "E24-13", rises[name], place=k, note=f"{name}, maximum",
                       ratio_scale=False)
                for k, name in enumerate(named)
            ),
        ),
    )  # fmt: skip


def _friction(targets: Mapping[str, Target]) -> PaperFigure:
    random = np.random.default_rng(_SEED)
    swings, downs = [], []
    time = np.arange(0.0, SWING_TIME, SWING_STEP)
    clean = PENDULUM.swing(time, SWING, 0.0, FRICTION.pin_b, 0.0)
    seconds = np.arange(0.0, DOWN_TIME, DOWN_STEP)
    falling = SPEED * np.exp(-FRICTION.shaft / SHAFT_INERTIA * seconds)
    for _ in range(EXPERIMENTS):
        angle = clean + SWING_NOISE * random.normal(size=time.size)
        swings.append((angle, from_pendulum(time, angle, PENDULUM, small=True)))
        speed = falling + DOWN_NOISE * random.normal(size=seconds.size)
        downs.append((speed, from_run_down(seconds, speed, SHAFT_INERTIA)))

    def fitted(record: tuple[Array, Identified]) -> Array:
        return record[0] - record[1].residual

    def mean(records: list[tuple[Array, Identified]]) -> float:
        return float(np.mean([identified.viscous for _, identified in records]))

    names = [f"experiment {k}" for k in range(1, EXPERIMENTS + 1)]
    half = [50.0 * float(np.ptp(i.viscous_interval)) / i.viscous for _, i in (swings[0], downs[0])]
    return PaperFigure(
        "e24-friction", "E24", "A1 and A2 (appendix A)", "Identification of the viscous friction",
        "The paper prints no records: decays with the printed coefficients and seeded noise, "
        "identified by least squares. Above: the pendulum of the paper (0.603 kg, 492 mm) on its "
        "bushing. Below: run-down of the shaft in place of the force gauge of the paper, with the "
        f"inertia assumed. The 95 % interval of one record is ± {half[0]:.1f} % of the pin and "
        f"± {half[1]:.1f} % of the shaft. The guide on the shaker (24.4 N s/m) is not identified.",
        (
            PaperPanel("time, s", "angle, rad", (
                PaperCurve("record", time, swings[0][0], 0, "points"),
                PaperCurve("fit", time, fitted(swings[0]), 1),
            )),
            PaperPanel("time, s", "residual, mrad", tuple(
                PaperCurve(name, time, 1e3 * identified.residual, k, "thin")
                for k, (name, (_, identified)) in enumerate(zip(names, swings, strict=True))
            )),
            PaperPanel("time, s", "shaft speed, rad/s", (
                PaperCurve("record", seconds, downs[0][0], 0, "points"),
                PaperCurve("fit", seconds, fitted(downs[0]), 1),
            )),
        ),
        (
            beside(targets, "E24-19", mean(downs), place=0, note="shaft", basis="imposed"),
            beside(targets, "E24-19", mean(swings), place=1, note="pins, mean of five records",
                   basis="imposed"),
        ),
    )  # fmt: skip
