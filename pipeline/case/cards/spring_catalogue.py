"""A catalogue of springs in TOML, and the lightest in it that will do."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.follower.spring import HelicalSpring, Wire

CATALOGUE = Path(__file__).parent / "springs.toml"
_BYTES = 256 * 1024

_SPRING = {
    "wire_diameter": "mm",
    "mean_diameter": "mm",
    "free_length": "mm",
}
_WIRE = {"shear_modulus": "GPa", "density": "kg/m^3", "strength_at_1mm": "MPa"}


@dataclass(frozen=True)
class SpringDemand:
    """What a spring has to meet.

    Parameters
    ----------
    rate : float               N/m
    rate_tolerance : float     share by which the rate may miss
    preload : float            N, at zero lift
    travel : float             m, to the largest lift
    fatigue_safety : float     Goodman and Zimmerli
    solid_clearance : float    share of the largest deflection
    mean_diameter_max : float  m
    rate_spread, preload_spread : float   shares by which a spring as made may exceed both; the
                                          hardest that may come has to do
    """

    rate: float
    preload: float
    travel: float
    rate_tolerance: float = 0.05
    fatigue_safety: float = 1.2
    solid_clearance: float = 0.1
    mean_diameter_max: float = float("inf")
    rate_spread: float = 0.0
    preload_spread: float = 0.0

    def shortfalls(self, spring: HelicalSpring) -> tuple[str, ...]:
        """What keeps a spring from meeting the demand, in words; empty when it does."""
        preload = self.preload * (1.0 + self.preload_spread)
        greatest = preload + spring.rate * (1.0 + self.rate_spread) * self.travel
        found = []
        if abs(spring.rate / self.rate - 1.0) > self.rate_tolerance:
            found.append("rate")
        if spring.solid_clearance(preload, self.travel) < self.solid_clearance:
            found.append("goes solid")
        if spring.static_use(greatest) > 1.0:
            found.append("shear stress")
        if spring.fatigue_safety(preload, greatest) < self.fatigue_safety:
            found.append("fatigue")
        if spring.buckling_use > 1.0:
            found.append("buckling")
        if spring.mean_diameter > self.mean_diameter_max:
            found.append("too wide")
        return tuple(found)


def read_catalogue(path: str | Path = CATALOGUE) -> tuple[HelicalSpring, ...]:
    """Springs of a catalogue file: ``[wires.NAME]`` and ``[[spring]]`` tables.

    Raises
    ------
    InputError
        For a file that is not TOML, an unknown or missing key, or a spring that cannot be.
    """
    given = read_toml(Path(path), "catalogue", _BYTES)
    _known("catalogue", given, {"wires", "spring"}, set())
    wires, springs = given.get("wires", {}), given.get("spring", [])
    if not isinstance(wires, dict):
        raise InputError("catalogue.wires", wires, "tables [wires.NAME]")
    if not isinstance(springs, list):
        raise InputError("catalogue.spring", springs, "tables [[spring]]")
    known = {name: _wire(name, entry) for name, entry in wires.items()}
    found = tuple(_spring(k, entry, known) for k, entry in enumerate(springs))
    names = [spring.name for spring in found]
    for k, name in enumerate(names):
        if name in names[:k]:
            raise InputError(f"catalogue.spring[{k}].name", name, "unlike every other")
    return found


def lightest(
    catalogue: tuple[HelicalSpring, ...], demand: SpringDemand
) -> tuple[HelicalSpring | None, dict[str, tuple[str, ...]]]:
    """The lightest spring that meets the demand (None: there is none), and why others do not."""
    reasons = {spring.name: demand.shortfalls(spring) for spring in catalogue}
    fit = [spring for spring in catalogue if not reasons[spring.name]]
    best = min(fit, key=lambda spring: spring.mass, default=None)
    return best, {name: reason for name, reason in reasons.items() if reason}


def _wire(name: str, entry: dict[str, Any]) -> Wire:
    field = f"catalogue.wires.{name}"
    keys = {*_WIRE, "exponent", "peened", "source"}
    _known(field, entry, keys, {*_WIRE, "exponent", "source"})
    values = {key: units.parse(entry[key], unit, f"{field}.{key}") for key, unit in _WIRE.items()}
    peened = entry.get("peened", False)
    if not isinstance(peened, bool):
        raise InputError(f"{field}.peened", peened, "true or false")
    return Wire(
        **values,
        exponent=_number(f"{field}.exponent", entry["exponent"]),
        peened=peened,
        source=_text(f"{field}.source", entry["source"]),
    )


def _spring(index: int, entry: dict[str, Any], wires: dict[str, Wire]) -> HelicalSpring:
    field = f"catalogue.spring[{index}]"
    keys = {*_SPRING, "name", "coils", "wire", "end_factor"}
    _known(field, entry, keys, keys - {"end_factor"})
    if not isinstance(entry["wire"], str) or entry["wire"] not in wires:
        raise InputError(f"{field}.wire", entry["wire"], f"one of: {', '.join(sorted(wires))}")
    values = {k: units.parse(entry[k], unit, f"{field}.{k}") for k, unit in _SPRING.items()}
    return HelicalSpring(
        **values,
        coils=_number(f"{field}.coils", entry["coils"]),
        wire=wires[entry["wire"]],
        end_factor=_number(f"{field}.end_factor", entry.get("end_factor", 0.5)),
        name=_text(f"{field}.name", entry["name"]),
    )


def _number(field: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) < 1e9:
        raise InputError(field, value, "a number without a unit")
    return float(value)


def _text(field: str, value: Any) -> str:
    if not isinstance(value, str) or not value.strip() or not value.isprintable():
        raise InputError(field, value, "printable text in quotes")
    return value


def _known(field: str, entry: Any, known: set[str], required: set[str]) -> None:
    if not isinstance(entry, dict):
        raise InputError(field, entry, "a table")
    for key in sorted(set(entry) - known):
        raise InputError(f"{field}.{key}", "unknown key", f"one of: {', '.join(sorted(known))}")
    for key in sorted(required - set(entry)):
        raise InputError(f"{field}.{key}", "missing", "given")
