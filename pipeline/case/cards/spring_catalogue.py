"""Catalogue of springs in TOML, and the lightest that meets a demand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import ClassVar

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.base.quantities import Part, Pressure
from camwright.pipeline.case.cards.part_table import read_part
from camwright.pipeline.case.cards.provenance import (
    numbers_of,
    source_words,
    without_provenance,
)
from camwright.pipeline.case.renamed_keys import with_new_wire_keys
from camwright.pipeline.case.toml_text import Tables, TomlValue, tables_of
from camwright.pipeline.follower.spring import (
    HelicalSpring,
    Treatment,
    WireDensity,
    WireExponent,
    WireModulus,
)

CATALOGUE = Path(__file__).parent / "springs.toml"
_BYTES = 256 * 1024


@dataclass(frozen=True)
class SpringDemand:
    """Demand on a spring.

    Parameters
    ----------
    rate : float               N/m
    rate_tolerance : float     permitted relative deviation of the rate
    preload : float            N, at zero lift
    travel : float             m, to the largest lift
    fatigue_safety : float     least safety by Goodman and Zimmerli
    solid_clearance : float    least clearance to solid over the maximum deflection
    rate_spread, preload_spread : float   tolerances of rate and preload, shares; the demand must
                                          be met at their upper bounds
    """

    rate: float
    preload: float
    travel: float
    rate_tolerance: float = 0.05
    fatigue_safety: float = 1.2
    solid_clearance: float = 0.1
    rate_spread: float = 0.0
    preload_spread: float = 0.0

    def shortfalls(self, spring: HelicalSpring) -> tuple[str, ...]:
        """Reasons why a spring does not meet the demand; empty if it does."""
        preload = self.preload * (1.0 + self.preload_spread)
        greatest = preload + spring.rate * (1.0 + self.rate_spread) * self.travel
        reasons = []
        if abs(spring.rate / self.rate - 1.0) > self.rate_tolerance:
            reasons.append("rate")
        if spring.solid_clearance(preload, self.travel) < self.solid_clearance:
            reasons.append("goes solid")
        if spring.static_use(greatest) > 1.0:
            reasons.append("shear stress")
        if spring.fatigue_safety(preload, greatest) < self.fatigue_safety:
            reasons.append("fatigue")
        if spring.gap_left(preload, self.travel) < spring.minimum_gaps:
            reasons.append("gap between coils")
        if spring.solid_stress((1.0 + self.rate_spread) * spring.rate) > spring.static_strength:
            reasons.append("stress at solid length")
        if spring.deflection(preload) + self.travel > spring.buckling_deflection:
            reasons.append("buckling")
        return tuple(reasons)


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


def sources_in(path: Path, name: str) -> dict[str, str]:
    """Sources of the numbers of a spring of a catalogue, those of its wire by their provenance."""
    catalogue = read_toml(path, "catalogue", _BYTES)
    entries, wires = catalogue.get("spring"), catalogue.get("wires")
    words: dict[str, str] = {}
    for entry in entries if isinstance(entries, list) else ():
        if not isinstance(entry, dict) or entry.get("name") != name:
            continue
        wire = wires.get(str(entry.get("wire"))) if isinstance(wires, dict) else None
        field = f"catalogue.wires.{entry.get('wire')}"
        card = with_new_wire_keys(wire or {}, field)
        words = {key: source_words(card, key, field) for key in numbers_of(card)}
        words |= dict.fromkeys(numbers_of(entry), f"chosen: spring {name} of the catalogue")
    return words


def lightest(
    catalogue: tuple[HelicalSpring, ...], demand: SpringDemand
) -> tuple[HelicalSpring | None, dict[str, tuple[str, ...]]]:
    """The lightest spring that meets the demand, or None, and the reasons of those that do not."""
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
    source: str


def _wire(field: str, entry: TomlValue) -> _Wire:
    own = without_provenance(entry) if isinstance(entry, dict) else entry
    return read_part(_Wire, with_new_wire_keys(own, field), field)


def _spring(field: str, entry: TomlValue, wires: Mapping[str, _Wire]) -> HelicalSpring:
    """Spring of an entry: its own keys and those of its wire."""
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
    of_wire = {each.name for each in fields(_Wire)}
    known = {each.name for each in fields(HelicalSpring)} - of_wire | {"wire"}
    for key in entry:
        if key not in known:
            raise InputError(f"{field}.{key}", "unknown key", f"one of: {', '.join(sorted(known))}")
