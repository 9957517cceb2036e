"""Exchange of roller, spring and bushes in a case, with all dependent values."""

from __future__ import annotations

import cmath
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path

from camwright.pipeline.base import units
from camwright.pipeline.base.crossing import first_passing
from camwright.pipeline.base.quantities import Part
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.cards.catalogue import Catalogue, catalogue_of, nearest_spring
from camwright.pipeline.case.cards.spring_catalogue import SpringDemand
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, completed
from camwright.pipeline.case.limits import (
    CAM_RADIUS,
    MINIMUM_WALL,
    SPRING_FATIGUE,
    SPRING_SOLID,
)
from camwright.pipeline.case.toml_text import Tables, TomlValue, table_in, tables_of
from camwright.pipeline.case.value_sources import forget_sources
from camwright.pipeline.follower.spring import HelicalSpring

AS_GIVEN = "as given"
WIDEST_PRIME = 1.5  # upper end of a search over the prime radius of the case
_WALL_MARGIN = 1.002  # on the least prime radius, for the wall at the contour
_END_MOST = 0.05  # of the roller's width
_HALVINGS = 40  # of a travel
_FORK = 2e-3  # m between roller and fork if the case has no pin
OWN_OF_BUSH = frozenset(
    {
        *("card", "material", "friction", "friction_min", "friction_max", "lubrication"),
        *("pressure_limit", "pressure_limit_temperature", "speed_limit", "pv_limit", "source"),
    }
)
"""Keys of a bush that another one brings; the others are of its place and use."""
OF_LINING = frozenset({"wear_rate", "stiffness", "thermal_resistance"})
"""Keys of a bush, measured with its material, that one of another material leaves open."""
OWN_OF_BEARING = frozenset(
    {
        *("card", "name", "C", "C0", "fatigue_load_limit", "radial_limit", "static_radial_limit"),
        *("speed_limit", "pitch_diameter", "ring", "source"),
        *("drag_torque", "friction", "grease_life"),  # measured, or of its maker
    }
)
"""Keys of the bearing of a roller that another one brings, or leaves open; likewise."""
OWN_OF_ROLLER = frozenset({"radius", "width", "hub_radius", "inertia", "mass"})
"""Keys of a roller that another one brings, or leaves open; likewise."""
OF_USE_OF_SPRING = frozenset({"temperature", "relaxation", "damping_ratio"})
"""Keys of a wound spring that stay where another one is put in; all others are its own."""


@dataclass(frozen=True)
class Choice:
    """Change of parts by name, `AS_GIVEN` for those of the case, and the limit of the cam radius,
    m; None: that of the case.
    """

    roller: str
    spring: str
    bush: str
    cam_radius: float | None = None

    @property
    def words(self) -> str:
        roller = f"follower {AS_GIVEN}" if self.roller == AS_GIVEN else self.roller
        return f"{roller}, spring {self.spring}, bushes {self.bush}"

    def applied(self, case: Case, folder: Path | None) -> Case:
        """A case with the parts, and with the files that it includes; see `variant`.

        Parameters
        ----------
        folder : Path   of the user's cards; None: shipped cards only

        Raises
        ------
        InputError
            If the parts do not fit into the case.
        """
        return completed(variant(case, catalogue_of(folder), self, folder), case.folder)


def travel_of(spring: HelicalSpring, case: Case) -> float:
    """Maximum lift, m, that a spring allows within its limits in a case; 0 if there is none.

    All limits of `SpringDemand` without surge, as in the checks: at the upper bounds of rate and
    preload, with the greatest preload where this is a variable.
    """
    spring_now, limits = case.spring, case.limits
    free = case.smoothing.preload_range if "preload" in case.smoothing.free else None
    still = SpringDemand(
        spring.rate,
        spring_now.preload if free is None else free[1],
        travel=0.0,
        fatigue_safety=limits[SPRING_FATIGUE],
        solid_clearance=limits[SPRING_SOLID],
        rate_spread=spring_now.rate_tolerance,
        preload_spread=spring_now.preload_tolerance,
    )

    def works(travel: float) -> float | None:
        return None if replace(still, travel=travel).shortfalls(spring) else travel

    stroke = spring.free_length - spring.solid_length
    return first_passing(works, stroke, (0.0,), _HALVINGS) or 0.0


def least_prime_radius(case: Case, roller_radius: float) -> float:
    """Least prime radius (m) with the minimum wall about bore and keyway."""
    key = case.cam.keyway
    inside = case.cam.bore_radius + (0.0 if key is None else key.depth)
    return _WALL_MARGIN * (roller_radius + case.limits[MINIMUM_WALL] * inside)


def variant(case: Case, parts: Catalogue, choice: Choice, folder: Path | None) -> Case:
    """Case with the parts of a choice and all dependent values.

    The roller sets its radius, width, bore and ratings, and with them the cam width, the pin, the
    fork, the width of an arm, the overhang and the mass of the follower; the spring sets rate,
    travel and mass; the bush friction and limits of both guides, or of the pivot of an arm. All
    else in their tables stays. The prime radius is a variable between the minimum wall and the
    limit of the cam radius. Waivers and confirmations of the replaced parts
    are left out, as they are not signed for this design.

    Parameters
    ----------
    folder : Path   folder of the case, with the user's cards

    Raises
    ------
    InputError
        If the parts do not fit into the case.
    """
    data = tables_of(case)
    data.pop("waivers", None)
    data["name"] = f"{case.name[:31]}-redesign"
    data["title"] = f"{case.title or case.name}: {choice.words}"
    radius, roller_mass, spring_mass = case.facing.contact_radius or 0.0, 0.0, 0.0
    arm_mass = 0.0
    if choice.roller != AS_GIVEN:
        card = parts.rollers[choice.roller]
        _put_roller(data, case, card, choice.roller)
        radius, roller_mass = 0.5 * card.outer_diameter, _heavier(case, card)
        arm_mass = _heavier_arm(case, card)
    if choice.spring != AS_GIVEN:
        spring = parts.springs[choice.spring]
        _put_spring(data, case, spring)
        old = case.spring.design or nearest_spring([*parts.springs.values()], case.spring.rate)
        spring_mass = 0.5 * (spring.mass - old.mass)
    _put_mass(data, case, roller_mass, spring_mass, arm_mass)
    if choice.bush != AS_GIVEN:
        for table in case.bushes:
            _put_bush(data, case, table, choice.bush, folder)
    _put_search(data, case, choice, radius)
    return case_of(data, folder)


def with_roller(case: Case, name: str, card: BearingCard, folder: Path | None) -> Case:
    """Case with another roller on the same base circle; pin, fork, cam width and moving mass change
    with it.

    Parameters
    ----------
    case : Case          with a roller
    name : str           of the card of the other roller
    card : BearingCard   the card
    folder : Path        of the cards of the user; None: shipped cards alone

    Raises
    ------
    InputError
        If the roller does not fit into the case.
    """
    data = tables_of(case)
    _put_roller(data, case, card, name)
    _put_mass(data, case, _heavier(case, card), 0.0, _heavier_arm(case, card))
    base = case.cam.prime_radius + 0.5 * card.outer_diameter - case.roller.radius
    table_in(data, "cam")["prime_radius"] = _mm(base)
    return completed(case_of(data, folder), case.folder)


def with_bush(case: Case, table: str, name: str, folder: Path | None) -> Case:
    """Case with another bush of the same size, by the name of its table: one of `Case.bushes`.

    Raises
    ------
    InputError
        If the bush does not fit into the case.
    """
    data = tables_of(case)
    _put_bush(data, case, table, name, folder)
    return completed(case_of(data, folder), case.folder)


def with_cam_material(case: Case, name: str, folder: Path | None) -> Case:
    """Case whose cam is of another material, by the name of its card.

    Raises
    ------
    InputError
        If the material does not fit into the case.
    """
    data = tables_of(case)
    table_in(data, "materials").setdefault(name, {"card": name})
    table_in(data, "cam")["material"] = name
    return completed(case_of(data, folder), case.folder)


def _put_roller(data: Tables, case: Case, card: BearingCard, name: str) -> None:
    """Write another roller into the tables of a case, in place: bearing, radius, pin, fork and end,
    scaled from those of the old one; width of cam and arm, and overhang, with it.

    Parameters
    ----------
    data : Tables        changed
    case : Case          with the old roller
    card : BearingCard   of the new one
    name : str           of the card
    """
    old, radius = case.roller, 0.5 * card.outer_diameter
    roller = table_in(data, "roller")
    bearing = _emptied(data, "roller.bearing", OWN_OF_BEARING)
    _emptied(data, "roller", OWN_OF_ROLLER)
    inside = card.bore if card.pitch_diameter is None else card.pitch_diameter
    roller |= {
        "radius": _mm(radius),
        "width": _mm(card.width),
        "hub_radius": _mm(0.25 * (card.bore + inside)),
        "bearing": bearing | {"card": name},
    }
    if old.end is not None and old.end.size:
        size = min(old.end.size, _END_MOST * card.width)
        roller["end"] = {"kind": old.end.kind, "size": _mm(size)}
    pin: Tables = {
        "material": case.follower.stem_material.name,
        "source": "as wide as the roller's bore",
    }
    span = card.width + 2.0 * _FORK
    if old.pin is not None:
        pin = table_in(roller, "pin")
        span = card.width + max(old.pin.span - old.width, 0.0)
    roller["pin"] = pin | {"diameter": _mm(card.bore), "span": _mm(span)}
    fork, arm = old.fork, case.follower.arm
    thicker = 0.0 if old.pin is None else card.bore - old.pin.diameter
    if fork is not None:
        grown = {"cheek_length": radius - old.radius, "cheek_height": thicker}
        table_in(roller, "fork").update(_grown(fork, grown))
    table_in(data, "cam")["width"] = _mm(card.width - old.width + case.cam.width)
    if arm is not None:
        grown = {"width": _wider(case, card), "roller_hub": thicker}
        table_in(table_in(data, "follower"), "arm").update(_grown(arm, grown))
    else:
        overhang = case.follower.overhang_at_max_lift + radius - old.radius
        table_in(data, "follower")["overhang_at_max_lift"] = _mm(overhang)


def _grown(part: Part, changes: Mapping[str, float]) -> Tables:
    """Entries of a part whose lengths change by as much, m; those that it does not state are left
    out.
    """
    stated = {name: getattr(part, name) for name in changes}
    return {name: _mm(value + changes[name]) for name, value in stated.items() if value is not None}


def _wider(case: Case, card: BearingCard) -> float:
    """Width that a wider roller adds to the arm which holds it, m."""
    return max(card.width - case.roller.width, 0.0)


def _emptied(data: Tables, table: str, own: Collection[str]) -> Tables:
    """Table of a part that is replaced, in the tables of a case, without its own keys and their
    sources, changed in place; an empty one where there is none.

    Parameters
    ----------
    table : str        dotted name
    own : collection   keys that belong to the part
    """
    node: TomlValue | None = data
    for step in table.split("."):
        node = node.get(step) if isinstance(node, dict) else None
    emptied = node if isinstance(node, dict) else {}
    if "source" in own and "source" in emptied:  # which holds for what stays, too
        data.setdefault("sources", {})
        sources = table_in(data, "sources")
        for key in sorted(emptied.keys() - own):
            sources.setdefault(f"{table}.{key}", emptied["source"])
    for key in own:
        emptied.pop(key, None)
        forget_sources(data, f"{table}.{key}")
    return emptied


def _put_spring(data: Tables, case: Case, spring: HelicalSpring) -> None:
    """Write a catalogue spring into the tables of a case, in place, with the preload as it was."""
    stated = {each.name for each in fields(HelicalSpring)} | {"card", "name"}
    design = _emptied(data, "spring.design", stated - OF_USE_OF_SPRING)
    table_in(data, "spring").update(
        {
            "rate": units.format(spring.rate, "kN/m"),
            "travel_max": _mm(travel_of(spring, case)),
            "source": f"catalogue: {spring.name}; preload as it was",
            "design": tables_of(spring) | design,
        }
    )


def _put_mass(data: Tables, case: Case, roller: float, spring: float, arm_mass: float) -> None:
    """Set the mass of the follower in `data` to that of `case` plus what the new roller and spring
    add; of an arm with a stated mass about the pivot this one, too.

    Parameters
    ----------
    roller : float     mass of the new roller less that of the old one, kg; on an arm at its end
    spring : float     half of the mass of the new spring less that of the old one, kg
    arm_mass : float   that a wider roller adds to the arm, kg, evenly along it
    """
    follower, table = case.follower, table_in(data, "follower")
    table["mass"] = units.format(follower.mass + roller + spring + arm_mass / 3.0, "g")
    arm, pivot = follower.arm, follower.pivot
    if arm is None or pivot is None or pivot.swinging_mass is None:
        return
    distance = arm.length if pivot.mass_distance is None else pivot.mass_distance
    mass = pivot.swinging_mass + roller + arm_mass
    moment = pivot.swinging_mass * cmath.rect(distance, pivot.mass_angle)
    moment += (roller + 0.5 * arm_mass) * arm.length
    table_in(table, "pivot").update(
        {
            "swinging_mass": units.format(mass, "g"),
            "mass_distance": _mm(abs(moment / mass)),
            "mass_angle": units.format(cmath.phase(moment / mass), "deg"),
        }
    )


def _heavier(case: Case, card: BearingCard) -> float:
    """Mass of a roller above that of the case, kg; both as solid discs."""
    roller = case.roller
    disc = 0.25 * card.outer_diameter**2 * card.width - roller.radius**2 * roller.width
    return math.pi * roller.material.density * disc


def _heavier_arm(case: Case, card: BearingCard) -> float:
    """Mass that a wider roller adds to its arm, kg; 0 of a stem, and of an arm without section and
    material.
    """
    arm = case.follower.arm
    if arm is None or arm.width is None or arm.depth is None or arm.material is None:
        return 0.0
    return arm.material.density * _wider(case, card) * arm.depth * arm.length


def _put_bush(data: Tables, case: Case, table: str, name: str, folder: Path | None) -> None:
    """Write the card of a bush into its table of a case, by its dotted name, in place; what is of
    its place and use is kept, and what was measured with the material if that stays.
    """
    card = known_cards(folder)["bushes"].get(name, {})
    same = card.get("material") == case.bushes[table].material.name
    _emptied(data, table, OWN_OF_BUSH if same else OWN_OF_BUSH | OF_LINING)["card"] = name


def _put_search(data: Tables, case: Case, choice: Choice, radius: float) -> None:
    """Write into the tables of a case, in place, that its lift is synthesised with a free prime
    radius, from the least that bore and offset allow to `WIDEST_PRIME` times that of the case.

    Parameters
    ----------
    data : Tables     changed
    case : Case       with its smoothing
    choice : Choice   with the limit of the cam radius, if any
    radius : float    of the new roller, m
    """
    smoothing = case.smoothing
    kept = [n for n in smoothing.free if n not in ("spring_rate", "prime_radius")]
    low = least_prime_radius(case, radius)
    high = max(WIDEST_PRIME * case.cam.prime_radius, 1.2 * low)
    if (arm := case.follower.arm) is not None:
        least, most = arm.reach(case.facing.offset)
        low, high = max(low, least), min(high, most)
    if "prime_radius" in smoothing.free and smoothing.prime_radius_range is not None:
        least, most = smoothing.prime_radius_range
        low = max(low, least)
        high = max(most, _WALL_MARGIN * low)
    start = min(max(case.cam.prime_radius, low), high)
    table_in(data, "cam")["prime_radius"] = _mm(start)
    table_in(data, "smoothing").update(
        {
            "kind": "constrained",
            "free": list(dict.fromkeys([*kept, "initial_energy", "prime_radius"])),
            "prime_radius_range": [_mm(low), _mm(high)],
            "corners": True,
            "source": "redesign: the least ripple that these parts allow",
        }
    )
    table_in(data, "mechanism")["compensation"] = 1.0
    if choice.cam_radius is not None:
        limits = table_in(data, "limits")
        limits[CAM_RADIUS.id] = _mm(choice.cam_radius)
        limits.setdefault("sources", {})
        table_in(limits, "sources")[CAM_RADIUS.id] = "cam radius of this redesign"


def _mm(length: float) -> str:
    return units.format(length, "mm")
