"""Slider-crank and eccentric cam (2024): energies, forces, inertia, trends.

The tables of dimensions of the paper are not available. Five dimensions are inferred from its three
energies and some coarser values: crank 20 mm, rod 80 mm, rollers 47.5 and 17.5 mm, 37.219 rad/s.
Masses and spring are assumed. Values used for the fit are marked.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.eccentric import Eccentric
from validation import validation_figures
from validation.mechanism_sizes import Workspace, workspace
from validation.paper_figure import PaperFigure, records
from validation.published_figures import (
    FigureOutcome,
    PaperResult,
    Target,
    judged,
)
from validation.slider_crank_drive import (
    EccentricDrive,
    HoldingSpring,
    Losses,
    Masses,
    PairFriction,
    SliderCrankDrive,
)

SPEED = 37.219  # rad/s, inferred
LINKAGE = Eccentric(0.020, 0.080)  # inferred
FRICTION = PairFriction(shaft=0.17, pin_a=0.026, pin_b=0.026, guide=24.4)  # printed
SPRING = HoldingSpring(59.0, 1700.0)  # assumed; preload + 18.75 mm x rate = 91 N is inferred
RADII = {"big": 0.0475, "small": 0.0175}  # inferred
DISC_WIDTH, STEEL = 0.020, 7850.0
TRACTION = {"big": 0.046, "small": 0.014}
CREEP = 0.05
PRINTED_LOAD = {"big": 94.0, "small": 93.0}
SLIP_FRICTION = (0.05, 0.2)


def cylinder_mass(radius: float) -> float:
    """Mass of a solid steel cylinder 20 mm wide, kg."""
    return float(STEEL * np.pi * radius**2 * DISC_WIDTH)


def drives() -> tuple[SliderCrankDrive, dict[str, EccentricDrive]]:
    """Slider-crank, and eccentric cams by roller."""
    rod = Masses(slider=1.0, rod=0.6, rod_inertia=3e-4, common=0.075)
    cams = {}
    for name, radius in RADII.items():
        disc, roller = cylinder_mass(LINKAGE.rod - radius), cylinder_mass(radius)
        masses = Masses(
            slider=1.0,
            roller=roller,
            roller_inertia=0.5 * roller * radius**2,
            disc=disc,
            disc_inertia=0.5 * disc * (LINKAGE.rod - radius) ** 2,
            common=0.075,
        )
        cams[name] = EccentricDrive(LINKAGE, radius, FRICTION, masses, SPRING)
    return SliderCrankDrive(LINKAGE, FRICTION, rod, SPRING), cams


def study(targets: Mapping[str, Target]) -> PaperResult:
    """Outcome of each value of the paper that can be computed, and the studies."""
    rod, cams = drives()
    space = workspace(FRICTION, SPEED)
    outcomes = {
        **_energies(targets, rod, cams),
        **_contact(targets, rod, cams),
        **_inertia(targets, rod, cams),
        **_trends(targets, space),
        "E24-10": FigureOutcome(
            None, "not decidable", "the regression has no verified public statement"
        ),
        "E24-12": FigureOutcome(None, "not decidable", "the motor's characteristic is not printed"),
        "E24-19": FigureOutcome(None, "not decidable", "bench results, inputs here"),
    }
    drawn = (
        _energy_figure(targets, rod, cams),
        _force_figure(targets, rod, cams),
        validation_figures.sizes(targets, space),
    )
    return PaperResult(outcomes, _studies(rod, cams, space), records(drawn))


def _energies(
    targets: Mapping[str, Target], rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive]
) -> dict[str, FigureOutcome]:
    crank = rod.losses(SPEED).total
    big, small = (cams[name].losses(SPEED).total for name in RADII)

    return {
        "E24-01": judged(targets["E24-01"], crank, "by the pairs of the study below"),
        "E24-02": judged(targets["E24-02"], big, "by the pairs of the study below"),
        "E24-03": judged(targets["E24-03"], small,
                         "rolling without slip, beyond the available traction"),
        "E24-04": judged(targets["E24-04"], 100 * (crank / big - 1), "ratio of the energies"),
        "E24-05": judged(targets["E24-05"], 100 * (small / big - 1),
                         "ratio of the energies; the printed ones give 176.5 %"),
    }  # fmt: skip


def _contact(
    targets: Mapping[str, Target], rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive]
) -> dict[str, FigureOutcome]:
    phi = uniform_turn(720)
    outcomes: dict[str, FigureOutcome] = {}
    for name, slide, load in (("big", "E24-06", "E24-08"), ("small", "E24-07", "E24-09")):
        lost = cams[name].sliding_loss(SPEED, TRACTION[name], CREEP, PRINTED_LOAD[name])
        outcomes[slide] = judged(
            targets[slide], lost, "with the printed traction, creep and mean load"
        )
        mean = float(cams[name].reactions(phi, SPEED).normal.mean())
        outcomes[load] = judged(targets[load], mean, "with assumed masses and spring")
    pins = {
        name: float(np.hypot(*cam.reactions(phi, SPEED).b).mean()) for name, cam in cams.items()
    }
    pins["slider-crank"] = float(np.hypot(*rod.reactions(phi, SPEED).b).mean())
    highest = max(pins, key=lambda name: pins[name])
    forces = ", ".join(f"{name} {force:.0f} N" for name, force in pins.items())
    outcomes["E24-18"] = judged(
        targets["E24-18"],
        "trend" if highest == "small" else highest,
        f"mean reaction of the slider's pin: {forces}; by a traction beyond the available one",
    )
    return outcomes


def _inertia(
    targets: Mapping[str, Target], rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive]
) -> dict[str, FigureOutcome]:
    inertias = [cams[name].masses.disc_inertia for name in ("small", "big")]
    phi = uniform_turn(720)
    rises = [
        round(100 * float(drive.reduced_inertia(phi).mean() / drive.masses.common - 1), 2)
        for drive in (rod, cams["big"], cams["small"])
    ]
    return {
        "E24-11": judged(
            targets["E24-11"], inertias, "solid steel discs, 20 mm wide, of the inferred radii"
        ),
        "E24-13": FigureOutcome(
            rises,
            "not decidable",
            "masses are not printed; with assumed ones and 0.075 kg m2 in common",
        ),
    }


def _energy_figure(
    targets: Mapping[str, Target], rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive]
) -> PaperFigure:
    losses = {"slider-crank": rod.losses(SPEED)}
    losses |= {f"{name} roller": cam.losses(SPEED) for name, cam in cams.items()}
    return validation_figures.energies(targets, losses)


def _force_figure(
    targets: Mapping[str, Target], rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive]
) -> PaperFigure:
    phi = uniform_turn(720)
    drives: dict[str, SliderCrankDrive | EccentricDrive] = {
        "slider-crank": rod,
        "big roller": cams["big"],
        "small roller": cams["small"],
    }
    return validation_figures.forces_and_inertia(
        targets,
        {name: cam.reactions(phi, SPEED).normal for name, cam in cams.items()},
        {
            name: 100.0 * (drive.reduced_inertia(phi) / drive.masses.common - 1.0)
            for name, drive in drives.items()
        },
    )


def _trends(targets: Mapping[str, Target], space: Workspace) -> dict[str, FigureOutcome]:
    total = space.combinations
    rod, small = 100 * space.above_best("slider_crank"), 100 * space.above_best("small")
    worse = all(
        np.all(with_offset[np.isfinite(with_offset)] >= without[np.isfinite(with_offset)])
        for without, with_offset in (
            (space.slider_crank, space.slider_crank_offset),
            (space.big, space.big_offset),
            (space.small, space.small_offset),
        )
    )

    def trend(row: str, holds: bool, reason: str) -> FigureOutcome:
        return judged(targets[row], targets[row].value if holds else "no", reason)

    corner = bool(small.max() == small[0, 0])
    return {
        "E24-14": trend("E24-14", space.big_is_best == total,
                       f"in {space.big_is_best} of {total} combinations"),
        "E24-15": trend("E24-15", worse, "no exception where the offset is allowed"),
        "E24-16": trend("E24-16", bool(rod.min() > 0), f"by {rod.min():.1f} to {rod.max():.1f} %"),
        "E24-17": trend("E24-17", corner, f"small roller {small[0, 0]:+.0f} % at 10 mm and ratio "
                       f"2, at most {small[-1].max():+.0f} % at 400 mm"),
    }  # fmt: skip


def _studies(
    rod: SliderCrankDrive, cams: Mapping[str, EccentricDrive], space: Workspace
) -> dict[str, Any]:
    """Studies of energy by pair, with and without slip, of traction and of trends."""
    phi = uniform_turn(720)
    rows: list[dict[str, str | float]] = [
        {"mechanism": "slider-crank", **_by_pair(rod.losses(SPEED))}
    ]
    for name, cam in cams.items():
        rows.append({"mechanism": f"{name} roller, no slip", **_by_pair(cam.losses(SPEED))})
        rows += [
            {"mechanism": f"{name} roller, slipping at mu {mu:g}",
             **_by_pair(cam.slipping_losses(SPEED, mu))}
            for mu in SLIP_FRICTION
        ]  # fmt: skip
    traction = [
        {
            "roller": name,
            "traction_needed_mean": float(cam.traction_needed(phi, SPEED).mean()),
            "traction_needed_max": float(cam.traction_needed(phi, SPEED).max()),
            "traction_printed": TRACTION[name],
        }
        for name, cam in cams.items()
    ]
    trends = [
        {
            "crank_mm": 1e3 * float(space.cranks[i]),
            "slider_crank_above_best_percent": float(100 * space.above_best("slider_crank")[i, 0]),
            "small_roller_above_best_percent": float(100 * space.above_best("small")[i, 0]),
        }
        for i in (0, 8, 16)
    ]
    return {
        "energy of a turn by pair, J": rows,
        "traction that rolling without slip requires": traction,
        "at a rod of two cranks": trends,
    }


def _by_pair(losses: Losses) -> dict[str, float]:
    """Energies of the pairs, J."""
    names = ("shaft", "guide", "pin_a", "pin_b", "sliding", "total")
    return {f"{name}_J": round(float(getattr(losses, name)), 3) for name in names}
