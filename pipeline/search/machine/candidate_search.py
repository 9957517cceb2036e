"""Screening of rollers, springs and base circles for a torque, all as arrays."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import ceil
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import CamError
from camwright.pipeline.base.progress import Progress
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.card_filling import known_cards, wire_values
from camwright.pipeline.case.cards.catalogue import better_roller, catalogue_of, undominated
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.cards.provenance import without_provenance
from camwright.pipeline.case.cards.shaft_seats import seats
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.toml_text import Tables
from camwright.pipeline.checks.manufacture import cam_radius
from camwright.pipeline.follower.spring import HelicalSpring
from camwright.pipeline.screening.design_screening import Column, screen_designs
from camwright.pipeline.search.machine.design_case import (
    OIL_WARMER,
    Machinery,
    case_text,
    oils_of,
)
from camwright.pipeline.search.machine.machine_frame import MachineFrame, frame_of
from camwright.pipeline.search.machine.torque_task import DesignTask
from camwright.pipeline.search.machine.wound_springs import SpringPoint, of_catalogue, wound

WIRE = "chrome_silicon"
RELAXATION = 0.005  # share of the force that a preset spring loses
_TRAVELS = 12
_TRIED_TRAVEL_LEAST = 2e-3  # m
_TRIED_TRAVEL_MOST = 0.12  # m
_PRELOADS = (0.15, 0.3, 0.45, 0.6)  # of the greatest force
_LEAST_SHARES = 3  # of the torque, for which springs are sought
_SHARED_SHAFT = 0.2  # share of the torque that one camshaft is drawn for
_RADII = 7
_STEEP, _FLAT = np.radians((28.0, 6.0))  # pressure angles of the least and greatest base circle
_RADIUS_MOST = 0.4  # m
OPTIMISTIC = 1.1  # ripple of a screened design over that allowed
FAR = 1.8  # of the size of the smallest design
_OFFSET_MOST = 0.2  # of the prime radius
_REMOVED_MORE = 0.05  # of the ripple, above the requirement
_PEAK = 1.25  # cam torque over that of the balanced ripple
_FREE_ROOM = 5.0  # m, of a cam whose space is not limited
_SMOOTHER = 'kind = "harmonic"\nharmonics = 12.0\n'
POSITIONS = 60


@dataclass(frozen=True)
class Candidate:
    """Screened design with the estimates of its ripple, size and checks.

    excess: sum of what the utilisations of its checks are above 1.
    """

    design: Machinery
    ripple: float
    cam_radius: float
    excess: float
    governing: str

    @property
    def size(self) -> float:
        """From the far side of the cam to the top of the roller at maximum lift, m."""
        return self.cam_radius + self.design.height

    def within(self, excess: float) -> bool:
        """Whether the excess of its checks and its ripple are near enough to the limits."""
        enough = self.ripple <= OPTIMISTIC * self.design.task.ripple_allowed
        return enough and self.excess <= excess

    @property
    def with_offset(self) -> Candidate:
        """Design with the offset of the follower at which rise and return have equal pressure
        angles: torque at the cam, mean of its greatest and least value, over the mean spring force,
        rounded to 0.1 mm; at most `_OFFSET_MOST` of the prime radius.
        """
        design = self.design
        task, spring = design.task, design.spring
        middle = 0.5 * (task.demand.torque.max() + task.demand.torque.min())
        slope = _share(task, spring) * task.ratio * middle / (spring.energy / spring.travel)
        most = _OFFSET_MOST * design.prime_radius
        offset = 1e-4 * round(1e4 * float(np.clip(slope, -most, most)))
        return replace(self, design=replace(design, offset=offset))


def reference_spring(task: DesignTask, folder: Path | None) -> HelicalSpring:
    """Spring of arbitrary size that has wire, treatment, relaxation and working temperature of all
    springs of the search, whose sizes are arrays.

    Parameters
    ----------
    task : DesignTask   with the temperature of the surroundings, K
    folder : Path       of the user's wire cards; None: shipped cards only
    """
    card = wire_values(without_provenance(known_cards(folder)["wires"][WIRE]))
    size: Tables = {"wire_diameter": "5 mm", "mean_diameter": "30 mm", "coils": 5.0,
                    "free_length": "80 mm"}  # fmt: skip
    drawn: Tables = {"treatment": "peened", "relaxation": RELAXATION}
    spring = read_part(HelicalSpring, {**card, **size, **drawn}, f"cards.wires.{WIRE}")
    return replace(spring, temperature=task.ambient + OIL_WARMER)


def candidates(
    task: DesignTask,
    folder: Path,
    file: str,
    progress: Progress,
    names: Collection[str] | None = None,
) -> list[Candidate]:
    """Screened designs of all catalogue rollers that can bear the force, over springs and base
    circles, by closed forms.

    Left out are designs larger than `FAR` times the smallest one that is within all limits.

    Parameters
    ----------
    task : DesignTask     torque, speeds and requirements
    folder : Path         of the torque table, the user's cards and springs
    file : str            torque table in it
    progress : Progress   told the rollers
    names : collection    of the rollers; None: all

    Raises
    ------
    CamError
        The first refusal, if the cases of all rollers are refused.
    """
    parts = catalogue_of(folder)
    wire, oils, sizes = reference_spring(task, folder), oils_of(folder), seats()
    rollers = undominated(parts.rollers, better_roller)
    order = sorted(
        (name for name in rollers if names is None or name in names),
        key=lambda name: (rollers[name].outer_diameter, rollers[name].C),
    )
    screened: list[Candidate] = []
    refused: list[CamError] = []
    largest = np.inf
    for k, name in enumerate(order, start=1):
        card = rollers[name]
        springs = _springs(task, card, wire, list(parts.springs.values()))
        for own in _by_energy(task, springs) if card.balls is not None else ():
            force = max(point.greatest for point in own)
            torque = _PEAK * task.ratio * task.demand.peak * max(_share(task, each) for each in own)
            frame = frame_of(name, card, torque, force, task.ratio, sizes)
            if frame is None:
                continue
            try:
                judged = _screened(task, frame, own, oils, folder, file, largest)
            except CamError as error:
                refused.append(error)
                continue
            sizes_within = (FAR * each.size for each in judged if each.within(0.0))
            largest = min(largest, *sizes_within, np.inf)
            screened += judged
        progress.advance(k, len(order))
    if refused and not screened:
        raise refused[0]
    return screened


def _springs(
    task: DesignTask, card: BearingCard, wire: HelicalSpring, catalogue: list[HelicalSpring]
) -> list[SpringPoint]:
    """Springs, wound or of the catalogue, that store a share of the energy to be balanced, with a
    greatest force within the ratings of a roller; over a grid of that share, travel and preload.

    Parameters
    ----------
    task : DesignTask      energy swing of the torque, share of the ripple to be removed, speed
    card : BearingCard     of the roller
    wire : HelicalSpring   whose material the wound springs have
    catalogue : list       springs of the catalogue
    """
    swing = task.demand.energy_swing
    least = min(task.remove + _REMOVED_MORE, 1.0)
    shares = np.linspace(least, 1.0, max(_LEAST_SHARES, ceil((1.0 - least) / _SHARED_SHAFT) + 1))
    travels = np.geomspace(_TRIED_TRAVEL_LEAST, _TRIED_TRAVEL_MOST, _TRAVELS)
    most = 0.95 * min(
        card.C0 / 1.5, 0.5 * card.C, card.radial_limit or np.inf, card.static_radial_limit or np.inf
    )
    share, travel, preload = (
        each.ravel() for each in np.meshgrid(shares, travels, _PRELOADS, indexing="ij")
    )
    mean = share * swing / travel
    greatest = 2.0 * mean / (1.0 + preload)
    kept = greatest <= most
    greatest, travel, preload = greatest[kept], travel[kept], preload[kept]
    rate = (1.0 - preload) * greatest / travel
    points = wound(wire, rate, preload * greatest, travel, task.cam_speed)
    points += [
        replace(point, spring=replace(
            point.spring, temperature=wire.temperature, relaxation=RELAXATION
        ))
        for point in of_catalogue(
            catalogue, list(shares * swing), list(travels), task.cam_speed
        )
        if point.greatest <= most
    ]  # fmt: skip
    return points


def _share(task: DesignTask, point: SpringPoint) -> float:
    """Share of the torque that the energy of a spring balances."""
    return min(point.energy / task.demand.energy_swing, 1.0)


def _by_energy(task: DesignTask, springs: Sequence[SpringPoint]) -> Iterator[list[SpringPoint]]:
    """Springs in groups of nearly equal stored energy, as a share of the energy swing of the task:
    the camshafts of a group carry the same torque.
    """
    groups: dict[int, list[SpringPoint]] = {}
    for point in springs:
        groups.setdefault(round(_share(task, point) / _SHARED_SHAFT), []).append(point)
    yield from groups.values()


def _screened(
    task: DesignTask,
    frame: MachineFrame,
    springs: list[SpringPoint],
    oils: Mapping[str, tuple[float, float]],
    folder: Path,
    file: str,
    largest: float,
) -> list[Candidate]:
    """Designs of a frame with each spring on several base circles, judged by the closed forms of
    the screening.

    Parameters
    ----------
    task : DesignTask      the task
    frame : MachineFrame   parts around the cam
    springs : list         to be combined with it
    oils : mapping         kinematic viscosities at 40 and 100 degC by name, mm2/s
    folder : Path          of the torque table
    file : str             torque table in it
    largest : float        greatest size of a design, m
    """
    designs = [
        Machinery(task, frame, spring, float(radius), spring.travel, 0.0, oils=oils)
        for spring in springs
        for radius in _radii(task, frame, spring)
    ]
    designs = [each for each in designs if each.least_size <= largest]
    if not designs:
        return []
    longest = max(designs, key=lambda each: each.lift)
    roomy = replace(longest, cam_radius=longest.prime_radius, task=replace(task, space=None))
    case = parse_case(case_text(roomy, "screening", file, smoothing=_SMOOTHER), folder)
    return _judged(designs, screen_designs(case, _factors(task, designs), positions=POSITIONS))


def _radii(task: DesignTask, frame: MachineFrame, spring: SpringPoint) -> Array:
    """Prime radii to be tried for a frame and a spring, m, in geometric steps from a steep to a
    flat pressure angle, rounded up to 0.5 mm, not below the hub and within the space; empty where
    none fits.
    """
    mean = 0.5 * (spring.preload + spring.greatest)
    slope = _share(task, spring) * task.ratio * task.demand.peak / mean
    low = max(frame.least_radius, slope / np.tan(_STEEP) - 0.5 * spring.travel)
    high = min(max(1.15 * low, slope / np.tan(_FLAT)), _RADIUS_MOST)
    if task.space is not None:
        # the cam reaches at least the base circle on its far side
        high = min(high, 0.5 * task.space - 0.5 * spring.travel)
    if not low <= high:
        return np.zeros(0)
    return 5e-4 * np.ceil(np.geomspace(low, high, _RADII) / 5e-4)


def _factors(task: DesignTask, designs: list[Machinery]) -> dict[str, Array]:
    """Values of m designs (m,), by key of the case file, SI, which the screening varies."""
    springs = [each.spring for each in designs]
    windings = ("wire_diameter", "mean_diameter", "coils", "free_length", "end_factor",
                "shear_modulus", "density", "strength_at_1mm", "strength_exponent")  # fmt: skip
    factors = {
        f"spring.design.{name}": np.array([getattr(each.spring, name) for each in springs])
        for name in windings
    }
    share = np.array([_share(task, each.spring) for each in designs])
    return factors | {
        "spring.rate": np.array([each.spring.rate for each in springs]),
        "spring.preload": np.array([each.preload for each in springs]),
        "spring.travel_max": np.array([1.02 * each.lift for each in designs]),
        "cam.prime_radius": np.array([each.prime_radius for each in designs]),
        "follower.mass": np.array([float(each.mass) for each in designs]),
        "guides.spacing": np.array([each.frame.spacing(each.lift) for each in designs]),
        "mechanism.compensation": share,
        "limits.cam_radius": np.array([min(each.room, _FREE_ROOM) for each in designs]),
    }


def _judged(designs: list[Machinery], columns: Mapping[str, Column]) -> list[Candidate]:
    """Designs with the figures of their screening: cam radius, ripple, excess of the utilisations
    above 1, and governing check. Those that the screening refuses are left out.

    Parameters
    ----------
    designs : list      m designs
    columns : mapping   result of the screening (m,) by name of column
    """
    used = np.array([
        np.nan_to_num(np.asarray(columns[name], dtype=float), nan=0.0, posinf=99.0)
        for name in columns
        if name.endswith(".utilisation")
    ])  # fmt: skip
    names = [name.split(".")[0] for name in columns if name.endswith(".utilisation")]
    excess = np.maximum(used - 1.0, 0.0).sum(axis=0)
    worst = used.argmax(axis=0)
    ripple = np.asarray(columns["headline.torque_std_after_Nm"], dtype=float)
    radius = np.asarray(columns[f"{cam_radius.id}.demand"], dtype=float)
    good: NDArray[np.bool_] = np.isfinite(ripple) & np.isfinite(radius)
    good &= np.asarray(columns["screen"] != "error")
    return [
        Candidate(
            replace(designs[row], cam_radius=1e-3 * float(radius[row])),
            float(ripple[row]),
            1e-3 * float(radius[row]),
            float(excess[row]),
            names[worst[row]],
        )
        for row in np.flatnonzero(good)
    ]
