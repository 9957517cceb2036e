"""Catalogue of rollers, springs and bushes: shipped cards and those of the user."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import marks_of
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.cards.provenance import without_provenance
from camwright.pipeline.case.cards.spring_catalogue import read_catalogue
from camwright.pipeline.case.toml_text import Tables
from camwright.pipeline.follower.guide_reactions import Guide
from camwright.pipeline.follower.spring import HelicalSpring

SPRINGS_FILE = "springs.toml"
SAME_RATE = 0.05  # relative difference below which rates count as equal

Candidate = TypeVar("Candidate")


@dataclass(frozen=True)
class CatalogueBush:
    """Bush of a catalogue: friction and its upper bound, limits of pressure, Pa, and PV, Pa m/s."""

    name: str
    friction: float
    friction_max: float
    pressure: float
    pv: float


@dataclass(frozen=True)
class Catalogue:
    """Parts by card name in the order of their files, the user's first."""

    rollers: Mapping[str, BearingCard]
    springs: Mapping[str, HelicalSpring]
    bushes: Mapping[str, CatalogueBush]


def catalogue_of(folder: Path | None) -> Catalogue:
    """Catalogue of the shipped parts and of ``cards.toml`` and ``springs.toml`` in a folder.

    Parameters
    ----------
    folder : Path   folder of the case; None: shipped parts only

    Raises
    ------
    InputError
        For a file or a card that cannot be read, by its name.
    """
    cards = known_cards(folder)
    springs = {spring.name: spring for spring in read_catalogue()}
    own = None if folder is None else folder / SPRINGS_FILE
    if own is not None and own.is_file():
        springs |= {spring.name: spring for spring in read_catalogue(own)}
    return Catalogue(
        {
            name: read_part(BearingCard, without_provenance(entry), f"cards.{name}")
            for name, entry in cards["bearings"].items()
        },
        springs,
        {name: _bush(name, entry) for name, entry in cards["bushes"].items()},
    )


def _bush(name: str, entry: Tables) -> CatalogueBush:
    """Bush of a card by its name, values in SI; its greatest friction is the stated friction where
    the card has no bound.

    Raises
    ------
    InputError
        If the card lacks friction, pressure limit, pv limit or material.
    """
    field, marks = f"cards.bushes.{name}", marks_of(Guide)
    for key in ("friction", "pressure_limit", "pv_limit", "material"):
        if key not in entry:
            raise InputError(f"{field}.{key}", "missing", "given")

    def read(key: str, default: str = "") -> float:
        try:
            return float(marks[key].read(entry.get(key, entry.get(default))))
        except InputError as error:
            raise InputError(f"{field}.{key}", error.value, error.limit) from None

    return CatalogueBush(
        name,
        friction=read("friction"),
        friction_max=read("friction_max", "friction"),
        pressure=read("pressure_limit"),
        pv=read("pv_limit"),
    )


def undominated(
    parts: Mapping[str, Candidate], better: Callable[[Candidate, Candidate], bool]
) -> dict[str, Candidate]:
    """Non-dominated parts; the first of equal ones.

    Parameters
    ----------
    better : callable   (one, other): whether `one` is at least as good in every respect
    """
    kept: dict[str, Candidate] = {}
    for name, part in parts.items():
        if any(better(other, part) for other in kept.values()):
            continue
        kept = {key: other for key, other in kept.items() if not better(part, other)}
        kept[name] = part
    return kept


def better_roller(one: BearingCard, other: BearingCard) -> bool:
    """Whether `one` is as good as `other` or better in every rating and load limit, at equal outer
    diameter and width.
    """
    same = (one.outer_diameter, one.width) == (other.outer_diameter, other.width)
    limits = ("radial_limit", "static_radial_limit", "fatigue_load_limit")
    ring = all((getattr(one, name) or 0.0) >= (getattr(other, name) or 0.0) for name in limits)
    rated = one.C >= other.C and one.C0 >= other.C0 and one.speed_limit >= other.speed_limit
    return same and ring and rated


def better_bush(one: CatalogueBush, other: CatalogueBush) -> bool:
    """Whether a bush dominates another in friction and limits."""
    low_friction = one.friction <= other.friction and one.friction_max <= other.friction_max
    return low_friction and one.pressure >= other.pressure and one.pv >= other.pv


def better_spring(
    one: tuple[HelicalSpring, float], other: tuple[HelicalSpring, float], *, by_mass: bool
) -> bool:
    """Whether a spring of equal rate dominates another in travel and, `by_mass`, in mass.

    Each spring comes with its travel, m.
    """
    rate = abs(one[0].rate / other[0].rate - 1.0) <= SAME_RATE
    light = not by_mass or one[0].mass <= other[0].mass
    return rate and one[1] >= other[1] and light


def nearest_spring(springs: Sequence[HelicalSpring], rate: float) -> HelicalSpring:
    """Lightest spring of a rate (N/m), within `SAME_RATE`, or else the spring of the nearest
    rate.
    """
    alike = [spring for spring in springs if abs(spring.rate / rate - 1.0) <= SAME_RATE]
    if alike:
        return min(alike, key=lambda spring: spring.mass)
    return min(springs, key=lambda spring: abs(spring.rate - rate))
