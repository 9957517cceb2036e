"""Checks of the parts at the cam: pin, fork, outer ring, follower mass, bore, unbalance."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value, uniform_turn
from camwright.geometry.errors import InputError
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base import levers
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    BORE_SHARE,
    FOLLOWER_MASS_RATIO,
    PIN_FATIGUE_SAFETY,
    PIN_PRESSURE_SHARE,
    PIN_SHARE,
    UNBALANCE,
    Limit,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    NONE,
    STATED,
    Allowed,
    Declaration,
    Demand,
    Kept,
    check,
    of_key,
)
from camwright.pipeline.checks.contact_strength import with_its_track
from camwright.pipeline.checks.demands import NORMAL_FORCE, PerLoad, force_over, normal_force
from camwright.pipeline.checks.extremes import (
    Measure,
    cam_of,
    cycle_of,
    on_both_tracks,
    worst_case,
)
from camwright.pipeline.checks.missing_keys import lacking_of_card
from camwright.pipeline.checks.roller_bearing import FIRST_ROLLER, SECOND_ROLLER, JudgedRoller
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cam_balance import Balance, balance, rotor_unbalance
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam, not_negative
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower import pin_strength
from camwright.pipeline.follower.bearing_ring import goodman
from camwright.pipeline.follower.camshaft_loads import Camshaft
from camwright.pipeline.follower.roller import Roller, on_second_track
from camwright.pipeline.follower.roller_parts import Fork, Pin


def _pin_of(roller: Roller) -> tuple[Roller, Pin]:
    """Roller and its pin.

    Raises
    ------
    InputError
        If the case describes none.
    """
    if roller.pin is None:
        raise InputError("roller.pin", "missing", "given for its checks")
    return roller, roller.pin


def _described(numbers: Numbers) -> tuple[Roller, Pin]:
    return _pin_of(numbers.known_case.roller)


Stress = Callable[[Value, Value, Numbers], Array]
"""Stress of a part at the pin, Pa, by force, N, and moment, N m, on the roller: of degree 1."""


def _of_force(stress: Stress) -> PerLoad:
    """Stress per newton in the middle of the roller."""
    return PerLoad(lambda numbers: stress(1.0, 0.0, numbers))


def _level_force(stress: Stress, moment: Measure = lambda cam: cam.follower_moment) -> Measure:
    """Measure of the force in the middle of the roller that gives the same stress of a part as the
    contact with its moment, of two rollers on a pin about the first one; of preloaded discs on that
    track which the cam is seen from.
    """

    def level_force(cam: LoadedCam) -> Array:
        """Force in the middle of the roller that stresses the part as the contact does, N."""
        numbers, force = cam.numbers, not_negative(cam.normal)
        return stress(force, moment(cam), numbers) / stress(1.0, 0.0, numbers)

    return level_force


def _of_either(force: Measure) -> Measure:
    """Measure of a force on one track, of preloaded discs the greater of both."""
    return lambda cam: on_both_tracks(cam, force)


def _with_its_disc(
    force: Measure, remark: Callable[[Demand, Solution], Demand], *names: str
) -> Callable[[Demand, Solution], Demand]:
    """Remark with the force of the disc that is pressed harder by `force`, and with two names the
    moment of its contact, by their names in the formula.
    """
    columns = (lambda cycle: cycle.loads.normal_force), (lambda cycle: cycle.follower_moment)

    def with_its_disc(demand: Demand, solution: Solution) -> Demand:
        return with_its_track(
            remark(demand, solution), solution, lambda cycle: force(cam_of(solution, cycle)),
            dict(zip(names, columns, strict=False)),
        )  # fmt: skip

    return with_its_disc


def _on_pin(cam: LoadedCam) -> Array:
    """Moment of the contact on the pin, N m."""
    return cam.pin_couple


def _bending(force: Value, moment: Value, numbers: Numbers) -> Array:
    """Bending stress of the roller pin (...), Pa, by a force in the middle, N, and a moment of the
    contact, N m.
    """
    pin = _described(numbers)[1]
    bent = pin_strength.pin_moment(force, moment, numbers["roller.width"], pin.span, pin.overhung)
    return bent * pin_strength.bending_per_moment(pin.diameter)


def _bending_allowed(numbers: Numbers) -> Allowed:
    yields = _described(numbers)[1].material.yield_strength
    return Allowed(numbers.limit(PIN_SHARE) * yields)


def _pin_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with mounting and material of the pin."""
    pin = _pin_of(solution.machine.roller)[1]
    method = f"32 M/(pi d^3), {pin.mounting}, load linear along the bearing"
    return replace(demand, figures=_sources(pin.material), method=method)


_of_bending = _of_force(_bending)
_BENDING = _level_force(_bending, _on_pin)
_ON_ROLLER = {"N": "normal_force", "C": "follower_moment"}
_ROLLER_LOAD = (
    "N, C: force and moment of the contact on the middle of the roller, by its ends, tilt and axial"
    " offset, of all load cases and angles where they stress it most"
)
roller_pin = check(
    PIN_SHARE,
    id="roller_pin",
    title="Bending stress of the roller pin",
    unit="MPa",
    method="32 M/(pi d^3), load linear along the bearing",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    part="pin",
    kept_as="normal force at the maximum stress of the roller pin",
    formula="32 M/(pi d^3) <= x Y; M = N (l/4 - b/8 - b u^2/2) + C u (k/2 - 2 u^2): of a pin held"
    " at both ends, N l + C of an overhung one, u = k e/(1 + sqrt(1 + 12 k e^2)): place of M over b"
    " from the middle, e = C/(N b): of the contact, k = 3 - 2 b/l: of the pin, "
    + _ROLLER_LOAD
    + ","
    " l: span, b: roller width, d: pin diameter, Y: yield strength, x: limits.pin_share. Fatigue:"
    " roller_pin_fatigue.",
    symbols={
        "?": "roller.pin.mounting straddled",
        **_ON_ROLLER,
        **dict.fromkeys(("u", "e", "k"), "[-]"),
        "M": "[N m]",
        "l": "roller.pin.span",
        "b": "roller.width",
        "d": "roller.pin.diameter",
        "Y": "roller.pin.material.yield_strength",
    },
    reason="a bent pin drops the roller",
    values=(*given.LENGTH, "roller.pin.material.yield_strength"),
    levers=(levers.one("roller.pin.diameter", most=2.0), *levers.LOAD),
    page="Roller",
    scales_with=(NORMAL_FORCE, 1.0),
).measured(
    "angles",
    value=_of_bending.value,
    bound=_of_bending.bound,
    allowed=_bending_allowed,
    remark=_with_its_disc(_BENDING, _pin_in_words, "N", "C"),
    deviation=0.005,
    bounded="line",
    kept=Kept(group=NORMAL_FORCE),
)(_of_either(_BENDING))


_PIN_FIBRES = 180  # around the pin; between two of them the stress differs by 1e-4 at most


def _sources(*cards: Material) -> tuple[str, ...]:
    return tuple(f"{card.name}: {card.source}" for card in cards)


def _with_card_of_pin(demand: Demand, solution: Solution) -> Demand:
    return replace(demand, figures=_sources(_pin_of(solution.machine.roller)[1].material))


@check(
    PIN_FATIGUE_SAFETY,
    id="roller_pin_fatigue",
    title="Fatigue safety factor of the roller pin in bending",
    method="Goodman line, bending stress of each fibre of the pin at rest over the turn, as force,"
    " moment and pressure angle change",
    lift_can_help=True,
    needs="roller",
    part="pin",
    kept_as="normal force at the bending fatigue of the roller pin",
    formula="s_W (1 - max(s_m, 0)/R_m)/s_a >= S; s_a, s_m: amplitude and mean of the bending stress"
    " of a fibre over a turn, of two discs of either pin, s_W: fatigue strength in bending, R_m:"
    " tensile strength, S: limits.pin_fatigue_safety; worst fibre and load case.",
    symbols={
        **dict.fromkeys(("s_a", "s_m"), f"{STATED} [MPa]"),
        "s_W": "roller.pin.material.fatigue_bending",
        "R_m": "roller.pin.material.tensile_strength",
    },
    reason="force and direction change with each turn of the cam, and bend the pin to and fro",
    values=(
        *given.LENGTH,
        "roller.pin.material.tensile_strength",
        "roller.pin.material.fatigue_bending",
    ),
    levers=(levers.one("roller.pin.diameter", most=2.0), *levers.LOAD),
    page="Roller",
    scales_with=(NORMAL_FORCE, 1.0),
)
def roller_pin_fatigue(solution: Solution) -> Demand:
    """Fatigue safety factor of the roller pin."""
    roller, pin = _pin_of(solution.machine.roller)
    card = pin.material
    tensile, endured = card.tensile_strength, card.fatigue_bending
    missing = lacking_of_card(card, "fatigue_bending", "tensile_strength")
    along, across = np.cos(uniform_turn(_PIN_FIBRES)), np.sin(uniform_turn(_PIN_FIBRES))

    def of_fibres(cycle: Cycle) -> tuple[Array, Array]:
        """Amplitude and mean of the stress, Pa, of the fibres of each pin."""
        loads = cycle.loads
        greatest = roller.pin_stress(loads.normal_force, cycle.pin_couple)
        per_newton = np.divide(
            np.full_like(loads.normal_force, np.nan) if greatest is None else greatest,
            loads.normal_force,
            out=np.zeros_like(loads.normal_force),
            where=loads.normal_force > 0.0,
        )
        forces = [(loads.axial_force, loads.tangential_force)]
        if loads.second is not None and loads.second.own_disc:  # each roller on a pin of its own
            bodies = cam_of(solution, cycle).on_bodies
            turned = [(each.normal, each.motion.pressure_angle) for each in bodies]
            forces = [(force * np.cos(at), force * np.sin(at)) for force, at in turned]
        force = np.hstack([np.outer(x, along) + np.outer(y, across) for x, y in forces])
        stress = per_newton[:, None] * force
        high, low = stress.max(axis=0), stress.min(axis=0)
        return 0.5 * (high - low), 0.5 * (high + low)

    def safety(cycle: Cycle) -> float:
        """Fatigue safety factor over the fibres of the pin in a load case; NaN without strengths,
        infinite without load.
        """
        if tensile is None or endured is None:
            return np.nan
        worst = float(np.max(goodman(*of_fibres(cycle), tensile)))
        return np.inf if worst == 0.0 else endured / worst

    worst = worst_case(solution.cycles, safety, at_least=True)
    limit, stated = solution.machine.limits[PIN_FATIGUE_SAFETY], dict[str, float]()
    if tensile is not None and np.isfinite(worst.value):
        fibres = of_fibres(cycle_of(solution.cycles, worst))
        k = first_greatest(goodman(*fibres, tensile))
        stated = {"s_a": float(fibres[0][k]), "s_m": float(fibres[1][k])}
    return Demand(worst.value, limit, worst, missing, figures=_sources(card), stated=stated)


def _shear(force: Value, moment: Value, numbers: Numbers) -> Array:
    """Shear stress of the roller pin (...), Pa, by a force, N, and a moment of the contact, N m."""
    pin = _described(numbers)[1]
    across = pin_strength.support_force(force, moment, pin.span, pin.overhung)
    return pin_strength.pin_shear_stress(across, pin.diameter)


def _shear_allowed(numbers: Numbers) -> Allowed:
    """By von Mises the share of the yield strength in bending."""
    bending = _bending_allowed(numbers).value
    return Allowed(None if bending is None else bending / 3.0**0.5)


_of_shear = _of_force(_shear)
_SHEAR = _level_force(_shear, _on_pin)
roller_pin_shear = check(
    PIN_SHARE,
    id="roller_pin_shear",
    title="Shear stress of the roller pin",
    unit="MPa",
    method="4/3 of the mean shear stress over the section beside the bearing",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    part="pin",
    kept_as="normal force at the maximum shear stress of the roller pin",
    formula="4 Q/(3 A) <= x Y/sqrt(3); Q = N/2 + C/l: of a pin held at both ends, N of an overhung"
    " one, l: span, " + _ROLLER_LOAD + ", A: section, Y: yield strength, x: limits.pin_share.",
    symbols={
        "?": "roller.pin.mounting straddled",
        **_ON_ROLLER,
        "Q": "[N]",
        "l": "roller.pin.span",
        "A": "pi roller.pin.diameter^2/4 [mm^2]",
        "Y": "roller.pin.material.yield_strength",
    },
    reason="a short pin shears before it bends",
    values=(*given.LENGTH, "roller.pin.material.yield_strength"),
    levers=(levers.one("roller.pin.diameter", most=2.0), *levers.LOAD),
    page="Roller",
    scales_with=(NORMAL_FORCE, 1.0),
).measured(
    "angles",
    value=_of_shear.value,
    bound=_of_shear.bound,
    allowed=_shear_allowed,
    remark=_with_its_disc(_SHEAR, _with_card_of_pin, "N", "C"),
    deviation=0.005,
    bounded="line",
    kept=Kept(group=NORMAL_FORCE),
)(_of_either(_SHEAR))


def _seat(force: Value, moment: Value, numbers: Numbers) -> Array:
    """Pressure of the pin in its bearing (...), Pa, by a force, N, and a moment of the contact, N
    m.
    """
    diameter = _described(numbers)[1].diameter
    return pin_strength.seat_pressure(force, moment, diameter, numbers["roller.width"])


def _share_of_tensile(row: Limit, cards: Sequence[Material], numbers: Numbers) -> Allowed:
    """Share of the lower tensile strength of the materials of a seat."""
    missing = tuple(key for card in cards for key in lacking_of_card(card, "tensile_strength"))
    strengths = [card.tensile_strength for card in cards if card.tensile_strength is not None]
    return Allowed(None, missing) if missing else Allowed(numbers.limit(row) * min(strengths))


_of_seat = _of_force(_seat)
_SEAT = _level_force(_seat)
roller_pin_pressure = check(
    PIN_PRESSURE_SHARE,
    id="roller_pin_pressure",
    title="Pressure of the roller pin in the bore of its bearing",
    unit="MPa",
    method="force and moment of the contact over the projected area of the seat, linear along it",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    part="pin",
    kept_as="normal force at the maximum pressure in the bearing's bore",
    formula="N/(d b) + 6 C/(d b^2) <= x R_m; "
    + _ROLLER_LOAD
    + ", d: pin diameter, b: roller width,"
    " R_m: tensile strength of the pin, softer than the ring, x: limits.pin_pressure_share.",
    symbols={
        **_ON_ROLLER,
        "d": "roller.pin.diameter",
        "b": "roller.width",
        "R_m": "roller.pin.material.tensile_strength",
    },
    reason="a seat that yields comes loose and frets",
    values=(
        *given.LENGTH,
        "roller.pin.material.tensile_strength",
        "roller.fork.material.*_strength",
    ),
    levers=(levers.one("roller.pin.diameter", most=2.0), *levers.LOAD),
    page="Roller",
    scales_with=(NORMAL_FORCE, 1.0),
).measured(
    "angles",
    value=_of_seat.value,
    bound=_of_seat.bound,
    allowed=lambda numbers: _share_of_tensile(
        PIN_PRESSURE_SHARE, (_described(numbers)[1].material,), numbers
    ),
    remark=_with_its_disc(_SEAT, _with_card_of_pin, "N", "C"),
    deviation=0.005,
    bounded="line",
    kept=Kept(group=NORMAL_FORCE),
)(_of_either(_SEAT))


def _fork_and_pin(roller: Roller) -> tuple[Fork, Pin] | None:
    """Fork and the pin in it; None where one is not described."""
    if roller.fork is None or roller.pin is None:
        return None
    return roller.fork, roller.pin


def _cheek(force: Value, moment: Value, numbers: Numbers) -> Array:
    """Pressure of the pin in the more loaded cheek of its fork (...), Pa, by a force, N, and a
    moment, N m; NaN without a fork.
    """
    both = _fork_and_pin(numbers.known_case.roller)
    if both is None:
        return np.full_like(force, np.nan)
    fork, pin = both
    seat = pin.diameter, fork.cheek_width, pin.span, pin.overhung
    return pin_strength.cheek_pressure(force, moment, *seat)


def _cheek_allowed(numbers: Numbers) -> Allowed:
    """Allowed pressure in the cheeks, Pa: stated, or a share of the lower tensile strength of fork
    and pin.
    """
    both = _fork_and_pin(numbers.known_case.roller)
    if both is None:
        return Allowed(None)
    fork, pin = both
    if fork.pressure_limit is not None:
        return Allowed(fork.pressure_limit)
    return _share_of_tensile(PIN_PRESSURE_SHARE, (fork.material, pin.material), numbers)


def _cheek_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with the source of the allowed pressure."""
    both = _fork_and_pin(solution.machine.roller)
    if both is None:
        return demand
    fork, pin = both
    if fork.pressure_limit is not None:
        return replace(demand, source=fork.source or Source(fork.table, confirmed=True))
    return replace(demand, figures=_sources(fork.material, pin.material))


_of_cheek = _of_force(_cheek)
_CHEEK = _level_force(_cheek, _on_pin)
cheek_pressure = check(
    PIN_PRESSURE_SHARE,
    id="cheek_pressure",
    title="Pressure of the roller pin in its fork",
    unit="MPa",
    method="force and moment of the pin over the projected area of a cheek",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="roller",
    part="fork",
    kept_as="normal force at the maximum pressure of the pin in its fork",
    formula="p <= roller.fork.pressure_limit, else x R_m; p = (N/2 + C/l)/(d t): under a pin held"
    " at both ends, (N (6 l + 4 t) + 6 C)/(d t^2) beside an overhung one, " + _ROLLER_LOAD + ", d:"
    " pin diameter, t: cheek width, l: span, or cheek to bearing centre, R_m: lower tensile"
    " strength of fork and pin, x: limits.pin_pressure_share.",
    symbols={
        "?": "roller.pin.mounting straddled",
        **_ON_ROLLER,
        "p": "[MPa]",
        "l": "roller.pin.span",
        "d": "roller.pin.diameter",
        "t": "roller.fork.cheek_width",
    },
    reason="a seat that yields lets the pin tilt and the roller run on its edge",
    values=(
        *given.LENGTH,
        "roller.pin.material.tensile_strength",
        "roller.fork.material.*_strength",
        "roller.fork.pressure_limit",
    ),
    levers=(levers.one("roller.fork.cheek_width"), *levers.LOAD),
    page="Roller",
    scales_with=(NORMAL_FORCE, 1.0),
).measured(
    "angles",
    value=_of_cheek.value,
    bound=_of_cheek.bound,
    allowed=_cheek_allowed,
    needed=(Pin.table,),
    remark=_with_its_disc(_CHEEK, _cheek_in_words, "N", "C"),
    deviation=0.005,
    bounded="line",
    kept=Kept(group=NORMAL_FORCE),
)(_of_either(_CHEEK))


@check(
    FOLLOWER_MASS_RATIO,
    id="follower_mass",
    title="Mass of the parts that move with the follower, as described, vs. its stated mass",
    unit="g",
    method="volumes times densities, and a share of the spring",
    moved_by_tolerance=False,
    formula="m_r + m_p + m_f + m_s + m_c <= x m; m_r: mass of roller with bearing, or face, m_p:"
    " pin, m_f: fork, m_s: stem, or arm at the roller, m_c: follower.spring_share of the spring, of"
    " the parts that the scope covers, m: follower.mass, x: limits.follower_mass_ratio.",
    symbols=dict.fromkeys(("m_r", "m_p", "m_f", "m_s", "m_c"), f"{STATED} [g]"),
    reason="every force of inertia and the jump speed rest on a mass that the parts exceed",
    load_cases=NONE,
    values=(
        "follower.mass",
        "follower.stem_material.density",
        "follower.arm.material.density",
        "roller.material.density",
        "roller.pin.material.density",
        "roller.fork.material.density",
        "spring.design.density",
    ),
    levers=(levers.one("follower.mass", most=2.0),),
    page="Follower",
)
def follower_mass(solution: Solution) -> Demand:
    """Mass of the parts that move with the follower, kg, against the stated mass."""
    masses, missing = moving_masses(solution)
    allowed = solution.machine.limits[FOLLOWER_MASS_RATIO] * solution.case.follower.mass
    total = sum(masses.values())
    parts = ", ".join(f"{name} {shown(mass, 'g')}" for name, mass in masses.items())
    note = f"at least {shown(total, 'g')}: {parts}" if missing else parts
    named = {"pin": "m_p", "fork": "m_f", "stem": "m_s", "arm": "m_s", "spring": "m_c"}
    stated = dict.fromkeys(named.values(), 0.0)
    stated["m_r"] = 0.0
    for name, mass in masses.items():
        stated[named.get(name.removeprefix("second "), "m_r")] += mass
    value = None if missing else total
    return Demand(value, allowed, missing=missing, note=note, stated=stated)


def moving_masses(solution: Solution) -> tuple[dict[str, float], tuple[str, ...]]:
    """Masses of the parts that move with the follower by name, kg, and the dotted keys that the
    case lacks for them.

    A stem without a length counts up to its far guide. A part outside the scope is left out.
    """
    machine = solution.machine
    parts, design = machine.follower.moving, machine.spring.design
    masses = {name: mass for name, mass in parts.masses.items() if mass is not None}
    missing = [
        key for part, keys in parts.missing.items() if machine.scope.covers(part) for key in keys
    ]
    masses |= _of_second(machine, masses)
    bar = machine.arm_bar
    if machine.arm is None:
        masses["stem"], lacks = _stem_mass(solution, parts.inset)
        missing += lacks
    elif bar is not None:
        masses["arm"] = bar.mass_at_end(parts.inset)
    if machine.spring.absent:
        masses["spring"] = 0.0
    elif design is not None:
        masses["spring"] = machine.spring_mass
    elif machine.spring.shape is None and machine.scope.covers("spring"):
        missing.append("spring.design")
    return masses, tuple(missing)


def _of_second(machine: Machine, masses: Mapping[str, float]) -> dict[str, float]:
    """Masses of a second roller on the pin of the first, and of the pin up to it, kg, or of its
    own pin, fork and arm, on that reduced to the first roller; {} without one.
    """
    second, pair = machine.cam.on_pin, machine.cam.conjugate
    if pair is not None:
        moving = on_second_track(machine.roller, machine.cam).moving
        of_parts = dict(moving.masses)
        for bar in machine.arm_bars[1:]:
            of_parts["arm"] = bar.mass_at_end(moving.inset)
        arm, length = machine.arm, pair.arm_length
        ratio = 1.0 if arm is None or length is None else length / arm.length
        return {
            f"second {name}": ratio**2 * mass for name, mass in of_parts.items() if mass is not None
        }
    if second is None:
        return {}
    roller = machine.roller
    added = {"second roller": on_second_track(roller, machine.cam).drawn_mass}
    if roller.pin is None or "pin" not in masses:
        return added
    longer = max(float(second.beyond(roller.radius)), 0.0)
    return added | {"pin": masses["pin"] + roller.pin.mass_per_length * longer}


def _stem_mass(solution: Solution, inset: float) -> tuple[float, tuple[str, ...]]:
    """Mass of the stem, shorter by `inset`, m, at its end, kg; its missing keys. Without a length
    it counts to its far guide.
    """
    follower = solution.case.follower
    length = follower.stem_length
    lacks: tuple[str, ...] = ()
    if length is None:
        length = follower.overhang_at_max_lift + solution.machine.guides.spacing
        lacks = ("follower.stem_length",)
    section = 0.25 * np.pi * follower.stem_diameter**2
    return float(follower.stem_material.density * section * max(length - inset, 0.0)), lacks


_RINGS = 16
"""Different rings up to which the bending of each is solved for many designs."""


class _Ring(NamedTuple):
    """Outer ring of the bearing of a roller."""

    at: JudgedRoller

    @property
    def keys(self) -> tuple[str, str, str]:
        """Keys of radius and width of the roller and of the static rating."""
        return self.at.radius, "roller.width", self.at.key("C0")

    @property
    def tensile(self) -> str:
        """Key of the tensile strength."""
        return self.at.key("ring.tensile_strength")

    def per_newton(self, numbers: Numbers) -> tuple[Value, Value]:
        """Amplitude and mean of the stress at the groove, Pa/N; NaN of a solid roller."""
        load = () if numbers.get(self.keys[-1]) is not None else ("spring.preload",)
        amplitude, mean = numbers.each(self._bending, (*self.keys, *load), _RINGS)
        return amplitude, mean

    def _bending(self, numbers: Numbers) -> tuple[float, float]:
        """As `per_newton`, of one machine."""
        roller = self.at.roller_in(numbers.known_case)
        names = zip(("radius", "width", "bearing.C0"), self.keys, strict=True)
        stated = {f"roller.{name}": numbers.get(key) for name, key in names}
        roller = roller.with_values({key: float(each) for key, each in stated.items() if each})
        # the bending does not depend on the width of the contact, nor with a rating on the preload
        solved = roller.ring(roller.line_width, float(np.ravel(numbers["spring.preload"])[0]))
        if solved is None:
            return np.nan, np.nan
        return solved.bending.stress_amplitude, solved.bending.stress_mean

    def amplitude(self, worst: Value, numbers: Numbers) -> Value:
        """Amplitude at zero mean stress by the Goodman line, Pa, under a normal force, N."""
        (amplitude, mean), force = self.per_newton(numbers), np.asarray(worst)
        return goodman(amplitude * force, mean * force, float(numbers[self.tensile]))

    def force(self, limit: float, numbers: Numbers) -> float | None:
        """Normal force, N, at which the Goodman amplitude of the ring is `limit`, Pa: a N/(1 - m
        N/R_m) = s_W; None where the ring is not described.
        """
        amplitude, mean = (float(each) for each in self.per_newton(numbers))
        if np.isnan(amplitude):
            return None
        return limit / (amplitude + limit * mean / float(numbers[self.tensile]))

    def in_words(self, demand: Demand, solution: Solution) -> Demand:
        """Demand with the source of the ring, or without a value for a roller that is modelled as
        solid.
        """
        roller = self.at.roller_in(solution.case)
        ring = roller.bearing.ring
        if ring is None or roller.solid_reason:
            note = f"{roller.solid_reason}: the roller is modelled as solid on its hub"
            undescribed = (self.at.key("ring"),) if ring is None else ()
            return Demand(None, None, missing=undescribed, note=note, must_have=ring is None)
        return replace(demand, figures=(ring.source,))


def _ring_fatigue(at: JudgedRoller) -> Declaration:
    """Bending fatigue of the outer ring of a roller."""
    ring, fatigue = _Ring(at), at.key("ring.fatigue_bending")
    return check(
        id=f"{at.name}_ring_fatigue",
        title=f"Bending fatigue of the {at.roller}'s outer ring",
        unit="MPa",
        source=Source("fatigue strength in bending", confirmed=True),
        method="stress at the groove of the turning ring, finite elements on balls without tension,"
        " all ball positions; amplitude reduced to zero mean stress by the Goodman line",
        lift_can_help=True,
        tier=Tier.SCREENING,
        needs="roller",
        closed_by=at.closed_by,
        part="roller_bearing",
        kept_as=f"normal force at the bending fatigue of the {at.roller}'s outer ring",
        formula="s_a/(1 - s_m/R_m) <= s_W; s_a, s_m: amplitude and mean of the stress at the groove"
        f" per newton, times the {at.greatest}, R_m, s_W: tensile and"
        " fatigue strength of the ring. A ring in a roller of its own is held by it: not judged.",
        symbols={
            "s_a": "ring_stress_amplitude",
            "s_m": "ring_stress_mean",
            "R_m": ring.tensile,
            "s_W": fatigue,
        },
        reason="the ring without a housing bends at every ball",
        values=(
            *given.LOADS,
            "roller.material.E",
            "roller.material.nu",
            at.key("C0"),
            at.key("ring.*"),
        ),
        levers=(at.lever("C0"), *levers.LOAD),
        page="Roller",
    ).measured(
        "angles",
        value=ring.amplitude,
        bound=ring.force,
        allowed=of_key(fatigue),
        needed=(ring.tensile,),
        remark=ring.in_words,
        pointwise=True,
        deviation=0.005,
        kept=at.kept_force(),
    )(at.force_on)


roller_ring_fatigue = _ring_fatigue(FIRST_ROLLER)
second_roller_ring_fatigue = _ring_fatigue(SECOND_ROLLER)


def _bore(numbers: Numbers) -> Value:
    return 1.0 / (2.0 * numbers["cam.bore_radius"] * numbers["cam.width"])


def _bore_cards(case: Case) -> tuple[list[Material], tuple[str, ...]]:
    """Materials of cam and camshaft at the bore, and the key of the missing one."""
    shaft, cards = case.camshaft, [case.cam.material]
    if not case.scope.covers("camshaft"):
        return cards, ()
    card = None if shaft is None else shaft.material
    return ([*cards, card], ()) if card is not None else (cards, ("camshaft.material",))


def _bore_allowed(numbers: Numbers) -> Allowed:
    """Allowed pressure at the bore, Pa: a share of the lower tensile strength less the pressure of
    the fit.
    """
    cards, missing = _bore_cards(numbers.known_case)
    allowed = _share_of_tensile(BORE_SHARE, cards, numbers)
    if missing or allowed.value is None:
        return Allowed(None, (*missing, *allowed.missing))
    return allowed._replace(value=allowed.value - _fit_pressure(numbers))


def _with_cards_of_bore(demand: Demand, solution: Solution) -> Demand:
    """Demand with the materials at the bore, their lower tensile strength and the pressure of the
    fit.
    """
    cards = _bore_cards(solution.case)[0]
    strengths = [card.tensile_strength for card in cards if card.tensile_strength is not None]
    pressure = float(np.ravel(_fit_pressure(solution.numbers))[0])
    stated = {"R_m": min(strengths, default=np.nan), "p": pressure}
    return replace(demand, figures=tuple(dict.fromkeys(_sources(*cards))), stated=stated)


_of_bore = PerLoad(_bore)


def _fit_pressure(numbers: Numbers) -> Value:
    """Greatest pressure of the fit, Pa; 0 without one."""
    pressure = numbers.get("cam.fit.greatest_pressure")
    return 0.0 if pressure is None else pressure


bore_pressure = check(
    BORE_SHARE,
    id="bore_pressure",
    title="Mean bore pressure on the camshaft",
    unit="MPa",
    method="greatest normal force over bore diameter and cam width",
    lift_can_help=True,
    tier=Tier.SCREENING,
    kept_as="normal force at the maximum pressure of the cam's bore",
    within=("bore",),
    formula="F_n/(d b) <= limits.bore_share R_m - p; F_n: greatest normal force over all load cases"
    " and angles, d: bore diameter, b: cam width, R_m: lower tensile strength of cam and camshaft,"
    " p: pressure of cam.fit at its greatest interference, 0 without one",
    symbols={
        "F_n": "normal_force",
        "d": "2 cam.bore_radius [mm]",
        "b": "cam.width",
        **dict.fromkeys(("R_m", "p"), f"{STATED} [MPa]"),
    },
    reason="a widened bore loosens the cam on its shaft",
    values=(
        *given.LOADS,
        "cam.material.tensile_strength",
        "camshaft.material.tensile_strength",
        "cam.fit.*",
    ),
    levers=(levers.one("cam.width"), levers.one("cam.bore_radius", most=2.0), *levers.LOAD),
    page="Cam",
).measured(
    "angles",
    value=_of_bore.value,
    bound=_of_bore.bound,
    allowed=_bore_allowed,
    remark=_with_its_disc(lambda cam: cam.normal, _with_cards_of_bore, "F_n"),
    deviation=0.005,
    kept=Kept(force_over, group=NORMAL_FORCE, unit="N", needs="face"),
)(normal_force)


@check(
    title="Torque reversals per turn at gear and key",
    unit="-",
    source=Source("crossover shock, Rothbart, Cam Design Handbook (2004)", confirmed=True),
    method="sign changes of cam torque plus drag, without torques below 1e-6 N m",
    must_have=False,
    within=("key", "gear"),
    formula="n <= 0; n: sign changes of T + drag beyond 1e-6 N m over the turn, greatest over the"
    " load cases",
    symbols={
        "n": "changes((cam_torque + camshaft.drag) step(|cam_torque + camshaft.drag| - 1e-6))"
    },
    reason="not a must-have: the torque of a balancing cam reverses by its purpose; the effects"
    " decide: gear_impact, key_pressure, key_shear, cam_slip, gear_bending, pinion_bending",
    values=given.LOADS,
    page="Torque",
)
def torque_reversals(solution: Solution) -> Demand:
    """Greatest number of torque reversals per turn at gear and key over the load cases."""
    worst = worst_case(solution.cycles, lambda cycle: float(len(cycle.parts.reversals)))
    slopes = [abs(one.slope) for cycle in solution.cycles for one in cycle.parts.reversals]
    steepest = max(slopes, default=0.0)
    slope = f"{steepest:.1f}" if steepest >= 0.1 else f"{steepest:.2g}"
    note = f"backlash is crossed; steepest {slope} N m/rad" if worst.value > 0 else ""
    return Demand(worst.value, 0.0, worst, note=note)


@check(
    UNBALANCE,
    id="cam_unbalance",
    title="Unbalance of the camshaft with its cam",
    method="exact first moment of the area of the contour less bore, keyway and counter-hole",
    moved_by_tolerance=False,
    formula="e w <= limits.unbalance; e = U/m, U: unbalance of cam and counterweight, or"
    " camshaft.counterweight.residual, of two discs the sum at both bearings, m:"
    " camshaft.rotor_mass, or the mass of the cam alone, w: greatest cam speed of all load cases",
    symbols={
        "U": f"{STATED} [g mm]",
        "e": "[um]",
        "m": f"{STATED} [g]",
        "w": "cam.fastest [rad/s]",
    },
    reason="the force m e w^2 loads shaft, bearings and frame at every speed",
    rests_on="",
    within=("camshaft",),
    values=(
        "cam.material.density",
        "camshaft.rotor_mass",
        "limits.overspeed",
        *given.BENCH,
    ),
    levers=(levers.Drilled(),),
    page="Camshaft",
)
def cam_unbalance(solution: Solution) -> Demand:
    """Balance grade e w of the rotor, m/s: unbalance over mass times the greatest cam speed; with a
    note on the counter-hole.
    """
    balanced, shaft = balance(solution.machine.cam, solution.contour), solution.machine.camshaft
    manufactured, speed = balanced.as_made, max(machine.cam_speed for machine in solution.machines)
    rotor = manufactured.mass if shaft is None else max(manufactured.mass, shaft.rotor_mass or 0.0)
    angle = f"{np.degrees(manufactured.angle) % 360:.1f} deg"
    rotor_parts = "cam alone" if rotor == manufactured.mass else "cam, shaft and gear"
    unbalance = rotor_unbalance(solution.machine.cam, solution.contour, shaft)
    # a cam that pulls has no counter-hole
    hole = "" if solution.machine.cam.pulls else _hole(balanced)
    return Demand(
        unbalance / rotor * speed,
        solution.machine.limits[UNBALANCE],
        note=f"{shown(manufactured.product, 'g mm')} of the cam at {angle}{_set(shaft)};"
        f" mass of {rotor_parts}, {shown(rotor, 'g')}{hole}",
        stated={"U": unbalance, "m": rotor},
    )


def _set(shaft: Camshaft | None) -> str:
    """End of a note on the counterweight that is set on the bench; empty without one."""
    weight = None if shaft is None else shaft.counterweight
    if weight is None or weight.residual is None:
        return ""
    return f", which the counterweight opposes on the bench up to {shown(weight.residual, 'g mm')}"


def _hole(balanced: Balance) -> str:
    """End of a note on the counter-hole; empty without one."""
    hole, missed = balanced.hole, f"; {balanced.missed}" if balanced.missed else ""
    if hole is None:
        return missed
    x, y = (shown(round(float(each), 9), "mm", 4) for each in hole.centre)
    share = 1.0 - balanced.left.product / balanced.unbalance.product
    removes = "removes" if balanced.drilled else "would remove"
    diameter = shown(2.0 * hole.radius, "mm", 4)
    return f"{missed}; a hole of {diameter} at ({x}, {y}) {removes} {share:.0%} of it"
