"""Catalogue of springs in TOML, and the lightest spring that meets a demand."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import ClassVar, Generic, NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.base.quantities import Part, Pressure
from camwright.pipeline.base.source import Source, entry_of
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.cards.provenance import (
    numbers_of,
    source_in_card,
    without_provenance,
)
from camwright.pipeline.case.limits import SPRING_FATIGUE, SPRING_SOLID, SPRING_SURGE
from camwright.pipeline.case.renamed_keys import with_new_wire_keys
from camwright.pipeline.case.toml_text import Tables, TomlValue, tables_of
from camwright.pipeline.follower.spring import (
    BUCKLING,
    COIL_GAP,
    FATIGUE,
    RELAXATION,
    SOLID,
    SOLID_STRESS,
    STRESS,
    HelicalSpring,
    Spring,
    WireDensity,
    WireExponent,
    WireModulus,
)
from camwright.pipeline.follower.wound_wire import Number, SpringWork, Treatment, WoundWire

CATALOGUE = Path(__file__).parent / "springs.toml"
_BYTES = 256 * 1024


class SpringRoom(NamedTuple):
    """Margins to the limits of a wound spring in a search that does not solve its surge.

    Parameters
    ----------
    greatest, least : float   greatest and least force with the surge over those without
    strength : float          share of the static and of the fatigue strength in use
    surge : float             surge frequency over its limit
    """

    greatest: float = 1.0
    least: float = 1.0
    strength: float = 1.0
    surge: float = 1.0


NO_ROOM = SpringRoom()


@dataclass(frozen=True)
class SpringDemand(Generic[Number]):
    """Demand on springs: forces, travel and limits, of one design or many at once.

    Parameters
    ----------
    rate : Number              N/m
    preload : Number           N, at zero lift
    travel : Number            m, to the largest lift
    rate_tolerance : float     permitted relative deviation of the rate
    fatigue_safety : float     least safety by Goodman and Zimmerli
    solid_clearance : float    least clearance to solid over the maximum deflection
    rate_spread, preload_spread : float   tolerances of rate and preload, shares; the demand must
                                          be met at their upper bounds
    cam_speed : float          greatest of the cam, rad/s; None: no surge is judged
    surge : float              least surge frequency over that of the cam
    room : SpringRoom
    """

    rate: Number
    preload: Number
    travel: Number
    rate_tolerance: float = Spring.rate_tolerance
    fatigue_safety: float = SPRING_FATIGUE.default
    solid_clearance: float = SPRING_SOLID.default
    rate_spread: float = Spring.rate_tolerance
    preload_spread: float = Spring.preload_tolerance
    cam_speed: float | None = None
    surge: float = SPRING_SURGE.default
    room: SpringRoom = NO_ROOM

    def work(self, wire: WoundWire[Number]) -> SpringWork[Number]:
        """Forces and travel of the hardest spring in tolerance, with the margin for surge."""
        room = self.room
        rest = wire.at_work(self.preload, self.travel, self.preload_spread, self.rate_spread)
        return rest._replace(greatest=room.greatest * rest.greatest)

    def kept(self, wire: WoundWire[Number]) -> Mapping[str, NDArray[np.bool_]]:
        """Whether springs (...) keep each limit of the demand, by the name of the limit in
        messages.

        Relaxation is judged where the wire states it, surge where the demand has a speed.

        Parameters
        ----------
        wire : WoundWire   winding and strength of the springs (...)
        """
        work, room = self.work(wire), self.room
        fatigued = work._replace(preload=room.least * work.preload)
        kept = {
            "rate": np.asarray(wire.rate_error(self.rate) <= self.rate_tolerance),
            SOLID.words: SOLID.holds(wire, work, self.solid_clearance),
            STRESS.words: STRESS.holds(wire, work, room=room.strength),
            FATIGUE.words: FATIGUE.holds(wire, fatigued, 1.0 / self.fatigue_safety, room.strength),
            COIL_GAP.words: COIL_GAP.holds(wire, work),
            SOLID_STRESS.words: SOLID_STRESS.holds(wire, work),
            BUCKLING.words: BUCKLING.holds(wire, work),
        }
        if wire.relaxation is not None and wire.temperature is not None:
            kept[RELAXATION.words] = RELAXATION.holds(wire, work, self.preload_spread)
        if self.cam_speed is not None:
            kept["surge"] = np.asarray(wire.surge_ratio(self.cam_speed) >= room.surge * self.surge)
        return kept

    def shortfalls(self, spring: WoundWire[Number]) -> tuple[str, ...]:
        """Reasons why a spring does not meet the demand; empty if it does."""
        return tuple(words for words, kept in self.kept(spring).items() if not kept)


def read_catalogue(path: str | Path = CATALOGUE) -> tuple[HelicalSpring, ...]:
    """Springs of a catalogue file: ``[wires.NAME]`` and ``[[spring]]`` tables.

    Raises
    ------
    InputError
        For a file that is not TOML, an unknown or missing key, or an impossible spring.
    """
    catalogue = read_toml(Path(path), "catalogue", _BYTES)
    for key in catalogue:
        if key not in ("wires", "spring"):
            raise InputError(f"catalogue.{key}", "unknown key", "one of: spring, wires")
    wires, entries = catalogue.get("wires", {}), catalogue.get("spring", [])
    if not isinstance(wires, dict):
        raise InputError("catalogue.wires", wires, "tables [wires.NAME]")
    if not isinstance(entries, list):
        raise InputError("catalogue.spring", entries, "tables [[spring]]")
    known = {name: _wire(f"catalogue.wires.{name}", entry) for name, entry in wires.items()}
    springs: list[HelicalSpring] = []
    for k, entry in enumerate(entries):
        spring = _spring(f"catalogue.spring[{k}]", entry, known)
        if spring.name in (other.name for other in springs):
            raise InputError(f"catalogue.spring[{k}].name", spring.name, "unlike every other")
        springs.append(spring)
    return tuple(springs)


def wire_sources() -> Iterator[tuple[str, Source]]:
    """Dotted name and source of each number of the wires of the shipped catalogue."""
    wires = read_toml(CATALOGUE, CATALOGUE.name, _BYTES).get("wires")
    for name, wire in wires.items() if isinstance(wires, dict) else ():
        card = with_new_wire_keys(wire, f"catalogue.wires.{name}")
        for key in numbers_of(card):
            yield f"springs.{name}.{key}", source_in_card(card, key, f"catalogue.wires.{name}")


def sources_in(path: Path, name: str) -> tuple[TomlValue, Tables]:
    """Sources of a spring of a catalogue: that of its wire, "" without one, and those of the
    numbers of wire and spring by key.

    The numbers of its wire have those of their provenance.

    Parameters
    ----------
    path : Path   of the catalogue
    name : str    of the spring
    """
    catalogue = read_toml(path, "catalogue", _BYTES)
    entries, wires = catalogue.get("spring"), catalogue.get("wires")
    stated: TomlValue = ""
    words: Tables = {}
    for entry in entries if isinstance(entries, list) else ():
        if not isinstance(entry, dict) or entry.get("name") != name:
            continue
        wire = wires.get(str(entry.get("wire"))) if isinstance(wires, dict) else None
        field = f"catalogue.wires.{entry.get('wire')}"
        card = with_new_wire_keys(wire or {}, field)
        stated = card.get("source", "")
        words = {key: entry_of(source_in_card(card, key, field)) for key in numbers_of(card)}
        chosen = Source(f"chosen: spring {name} of the catalogue", confirmed=True)
        words |= dict.fromkeys(numbers_of(entry), entry_of(chosen))
    return stated, words


def lightest(
    catalogue: tuple[HelicalSpring, ...], demand: SpringDemand[float]
) -> tuple[HelicalSpring | None, dict[str, tuple[str, ...]]]:
    """Lightest spring that meets the demand, None where none does, and by name the limits that each
    refused spring breaks.
    """
    reasons = {spring.name: demand.shortfalls(spring) for spring in catalogue}
    fit = [spring for spring in catalogue if not reasons[spring.name]]
    best = min(fit, key=lambda spring: spring.mass, default=None)
    return best, {name: reason for name, reason in reasons.items() if reason}


@dataclass(frozen=True, kw_only=True)
class _Wire(Part):
    """Wire of several springs: the fields of `HelicalSpring` that depend on the wire alone."""

    table: ClassVar[str] = "wire"

    shear_modulus: WireModulus
    density: WireDensity
    strength_at_1mm: Pressure
    strength_exponent: WireExponent
    treatment: Treatment = "plain"
    source: Source


def _wire(field: str, entry: TomlValue) -> _Wire:
    """Wire of a table, old names of keys accepted."""
    own = without_provenance(entry) if isinstance(entry, dict) else entry
    return read_part(_Wire, with_new_wire_keys(own, field), field)


def _spring(field: str, entry: TomlValue, wires: Mapping[str, _Wire]) -> HelicalSpring:
    """Spring of an entry of a catalogue: its own keys and those of the wire that it names.

    Parameters
    ----------
    field : str       dotted name of the entry, for messages
    entry : table     the entry
    wires : mapping   wires of the catalogue by name

    Raises
    ------
    InputError
        If a key is unknown, the wire is none of the catalogue, or the spring has no name or is
        impossible.
    """
    if not isinstance(entry, dict):
        raise InputError(field, str(entry), "a table")
    own = dict(entry)
    wire, name = own.pop("wire", None), own.pop("name", None)
    _require_own_keys(field, entry)
    if not isinstance(wire, str) or wire not in wires:
        shown = "missing" if wire is None else str(wire)
        raise InputError(f"{field}.wire", shown, f"one of: {', '.join(sorted(wires))}")
    if not isinstance(name, str) or not name.strip() or not name.isprintable():
        shown = "missing" if name is None else str(name)
        raise InputError(f"{field}.name", shown, "printable text in quotes")
    return replace(read_part(HelicalSpring, tables_of(wires[wire]) | own, field), name=name)


def _require_own_keys(field: str, entry: Tables) -> None:
    """Refuse, by InputError, keys of an entry of a catalogue that a spring does not have, or that
    are those of its wire.
    """
    of_wire = {each.name for each in fields(_Wire)}
    known = {each.name for each in fields(HelicalSpring)} - of_wire | {"wire"}
    for key in entry:
        if key not in known:
            raise InputError(f"{field}.{key}", "unknown key", f"one of: {', '.join(sorted(known))}")
