"""Checks of a face sliding on the cam: width, PV value, temperature, self-locking of an arm."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.extrema import first_greatest
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import celsius, shown
from camwright.pipeline.case.limits import JAM_INDEX, SURFACE_TEMPERATURE
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import NONE, STATED, Demand, Kept, check, of_key
from camwright.pipeline.checks.contact_strength import line_pressure
from camwright.pipeline.checks.extremes import cycle_of, worst_case
from camwright.pipeline.checks.missing_keys import lacking, lacking_of_card, no_friction
from camwright.pipeline.contact.flash_temperature import bulk_rise
from camwright.pipeline.contact.oil_film import Lubricant, scuffing_limit
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.loaded_cam import LoadedCam, face_of
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.flat_face_motion import MEAN_SHARE
from camwright.pipeline.follower.pivot_forces import Pressed

_HEAT_PATH = ("conductivity", "specific_heat")
OF_OIL = ("temperature", "scuffing_temperature", "boundary_temperature")
"""Temperatures of the oil that `contact_temperature` needs."""
_FLASH = {
    "T_oil": "lubricant.temperature - 273.15 [degC]",
    "T_m": f"{STATED} [K]",
    "T_f": f"{STATED} [K]",
}
"""Temperature of the oil and rises of the face in the symbols of a formula."""


@check(
    title="Required face width",
    tier=Tier.SCREENING,
    unit="mm",
    source=Source("contact inside the face, Norton (2009) ch. 7", confirmed=True),
    method="twice the sum of the distance of the contact from the middle of the face and contact"
    " half-width, greatest over the turn",
    lift_can_help=True,
    needs="face",
    kept_as="width of the face",
    formula="2 (|x| + a) <= w; x: place of the contact from the middle of the face, s' - e on a"
    " stem, a: half-width of the contact, w: follower.face.width",
    symbols={"x": "face_contact_offset", "a": "half_width_fe"},
    reason="beyond the face the contact runs on its edge",
    levers=(levers.one("follower.face.width"), *levers.GENTLER),
    page="Flat face",
).measured("angles", allowed=of_key("follower.face.width"), deviation=0.001, kept=Kept(unit="mm"))
def face_width(cam: LoadedCam) -> Array:
    """Required face width, contact half-width included, m."""
    return 2.0 * (magnitude(face_of(cam.motion).on_face) + cam.half_width)


def _stated(demand: Demand, _: Solution) -> Demand:
    return demand if demand.value is None else replace(demand, stated={"x": demand.value})


@check(
    JAM_INDEX,
    id="self_locking",
    title="Self-locking of the face on its arm",
    method="greatest moment of the friction of face and pivot about the pivot over that of the"
    " normal force, both under the contact force alone, refined between samples",
    tier=Tier.SCREENING,
    lift_can_help=True,
    moved_by_tolerance=False,
    needs="swung_face",
    formula="x <= j; x: greatest (M_f + M_p)/M_n, M_f: moment of the friction of the face about the"
    " pivot, M_p: of the friction in a pivot that is described, under the contact force alone, M_n:"
    " of the normal force, j: limits.jam_index; flat face: (mu f + rho sqrt(1 + mu^2))/q, mu:"
    " friction of the face, f: its offset, rho: half of the pin's diameter times the friction of"
    " the pivot, q: distance of the contact from the pivot along it; curved one: mu (tan alpha"
    " + r/(l cos alpha)) + rho sqrt(1 + mu^2)/(l cos alpha), alpha: pressure angle, r: its radius,"
    " l: length of the arm; f and r negative where the arm swings outwards against the cam",
    symbols={"x": STATED},
    reason="At 1 the friction holds what the cam lifts, and cam or arm breaks.",
    values=(
        "follower.face.friction",
        "follower.pivot.bush.friction",
        "follower.pivot.needle_bearing.friction",
    ),
    load_cases=NONE,
    levers=levers.GENTLER,
    page="Flat face",
).measured(
    "contour",
    needed=("follower.face.friction",),
    remark=_stated,
    deviation=1e-4,
    kept=Kept(),
)
def self_locking(cam: LoadedCam) -> Array:
    """Moment of the friction of face and pivot about the pivot over that of the normal force."""
    lock, pivot = np.asarray(cam.motion.lock), cam.pivot
    return lock if pivot is None else lock + pivot.locking(Pressed.of(cam.motion))


def _of_its_source(demand: Demand, solution: Solution) -> Demand:
    return replace(demand, source=solution.machine.face.source)


def _sliding(cam: LoadedCam) -> Array:
    """Mean over peak pressure of Hertz times the sliding speed, m/s."""
    return np.asarray(MEAN_SHARE * cam.speed * face_of(cam.motion).slip)


@check(
    title="PV value of the face",
    tier=Tier.SCREENING,
    unit="MPa m/s",
    source=Source("PV limit of the face", confirmed=True),
    method="greatest pi/4 p0 v over the turn",
    lift_can_help=True,
    needs="face",
    kept_as="PV of the face",
    formula="pi/4 p0 v <= PV; p0: contact pressure, v: sliding speed, omega (r + s) on a stem, PV:"
    " follower.face.pv_limit",
    symbols={"p0": "p0_fe", "v": "sliding_speed"},
    reason="a face slides at all angles, and beyond its PV limit it seizes or melts",
    values=(*given.CONTACT, "follower.face.pv_limit"),
    levers=(levers.one("follower.face.depth"), *levers.GENTLER),
    page="Flat face",
).measured(
    "angles",
    allowed=of_key("follower.face.pv_limit"),
    remark=_of_its_source,
    deviation=0.001,
    kept=Kept(lambda cam, limit: line_pressure(cam, limit / _sliding(cam)), unit="MPa m/s"),
)
def face_pv(cam: LoadedCam) -> Array:
    """Mean contact pressure times sliding speed, Pa m/s."""
    return _sliding(cam) * cam.p0


@check(
    title="Temperature of the sliding contact vs. scuffing temperature of the oil",
    unit="degC",
    source=Source(
        "criterion of Blok (1937) for scuffing, ISO/TS 6336-20, regimes of AGMA 925-A03",
        confirmed=False,
    ),
    method="oil, bulk by the mean flash temperature of the turn, and flash temperature of a band"
    " source, at the mean friction coefficient, where they are nearest to the limit by the film"
    " there; a film of unknown roughness counts as none",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="face",
    formula="T_oil + 0.47 1.2 T_m + T_f <= T_b + c (T_s - T_b); c: (lambda - 0.4)/(1 - 0.4) within"
    " 0 and 1, T_m: mean of T_f over the turn, T_f: 1.11 mu w |u1 - u2| / ((B1 sqrt|u1| +"
    " B2 sqrt|u2|) sqrt(2 a)), u1, u2: speeds of the contact along cam and face, on a stem omega (r"
    " + s + s'') and omega s'', mu: friction of the face,"
    " w: line load, B: root of conductivity times density times specific heat, a: half-width of"
    " the contact, T_oil: lubricant.temperature, T_s, T_b:"
    " lubricant.scuffing_temperature, .boundary_temperature, lambda: film over roughness, as of"
    " film_ratio, at the same angle",
    symbols=_FLASH,
    reason="above it film or adsorbed layer breaks down and the surfaces weld, within seconds",
    values=(
        *given.CONTACT,
        "follower.face.friction",
        "lubricant.temperature",
        "lubricant.scuffing_temperature",
        "lubricant.boundary_temperature",
        "lubricant.*viscosity",
        "cam.roughness",
        "follower.face.roughness",
        *(f"{part}.material.{key}" for part in ("cam", "follower.face") for key in _HEAT_PATH),
    ),
    levers=(levers.one("follower.face.depth"), *levers.GENTLER),
    page="Flat face",
)
def contact_temperature(solution: Solution) -> Demand:
    """Contact temperature, degC, at the cam angle where it is greatest over its limit; at
    standstill that of the oil.
    """
    oil, missing = solution.machine.lubricant, heat_missing(solution.machine, *OF_OIL)
    cold, top, bare = (
        (None,) * 3
        if oil is None
        else (oil.temperature, oil.scuffing_temperature, oil.boundary_temperature)
    )
    if missing or oil is None or cold is None or top is None or bare is None:
        return Demand(None, None if top is None else celsius(top), missing=missing)

    def flash(cycle: Cycle) -> Array:
        rise = cycle.rolling.flash
        # the contour may bound no body
        return np.full(cycle.theta.size, np.nan) if rise is None else rise

    # by the solved angles: a parabola would overshoot the cusp of a reversal
    places: dict[str, tuple[int, float, float]] = {}
    for cycle in solution.cycles:
        rise = flash(cycle)
        limits = contact_allowed(_film(cycle), bare, top)
        k = first_greatest(celsius(cold + bulk_rise(rise) + rise) / limits)
        places[cycle.load_case] = k, float(rise[k]), float(limits[k])

    def use(cycle: Cycle) -> float:
        """Contact temperature at the worst angle of a load case, in degC, over its limit."""
        _, hot, limit = places[cycle.load_case]
        return float(celsius(cold + bulk_rise(flash(cycle)) + hot)) / limit

    worst = worst_case(solution.cycles, use)
    k, hot, limit = places[worst.load_case]
    cycle = next(each for each in solution.cycles if each.load_case == worst.load_case)
    worst = worst._replace(value=worst.value * limit, cam_angle=float(cycle.theta[k]))
    note = f"flash temperature of {shown(hot, 'K', 3)} on {_film(cycle)[k]:.2g} of the roughness"
    if np.isnan(hot):
        note = "no flash temperature on a contour that bounds no body"
    stated = {"T_m": float(np.mean(flash(cycle))), "T_f": hot}
    return Demand(worst.value, limit, worst, note=note, figures=(oil.source,), stated=stated)


def contact_allowed(film: Array, bare: float, top: float) -> Array:
    """Scuffing temperature (...), degC, on a film over roughness; limits of layer and oil, K.

    That of the oil without contact, where there is neither film nor heat.
    """
    limits = celsius(scuffing_limit(film, min(bare, top), top))
    return np.where(np.isnan(limits), celsius(top), limits)


def _film(cycle: Cycle) -> Array:
    """Film over roughness (n,); 0 where the roughness is not known, NaN without contact."""
    film = cycle.rolling.film
    return np.zeros(cycle.theta.size) if film is None or film.ratio is None else film.ratio


@check(
    SURFACE_TEMPERATURE,
    id="bulk_temperature",
    title="Temperature of cam and face between the contacts",
    unit="degC",
    method="oil, and bulk by the mean flash temperature of the turn, at the mean friction"
    " coefficient",
    lift_can_help=True,
    tier=Tier.SCREENING,
    needs="face",
    formula="T_oil + 0.47 1.2 T_m <= limits.surface_temperature, and that of the cards of cam and"
    " face where they state one; T_oil: lubricant.temperature, T_m: mean flash temperature, as of"
    " contact_temperature",
    symbols={name: _FLASH[name] for name in ("T_oil", "T_m")},
    reason="above it hardened surfaces are tempered, and a contact without a full film loses the"
    " layer that keeps the steels apart",
    values=(
        *given.CONTACT,
        "follower.face.friction",
        "lubricant.temperature",
        *(f"{part}.material.{key}" for part in ("cam", "follower.face") for key in _HEAT_PATH),
    ),
    levers=(levers.one("follower.face.depth"), *levers.GENTLER),
    page="Flat face",
)
def bulk_temperature(solution: Solution) -> Demand:
    """Greatest bulk temperature of the surface over the load cases, degC: that of the oil and of
    the mean flash.
    """
    machine = solution.machine
    oil, limit = machine.lubricant, machine.limits[SURFACE_TEMPERATURE]
    allowed = float(bulk_allowed(machine, limit))
    missing = heat_missing(machine, "temperature")
    if missing or oil is None or oil.temperature is None:
        return Demand(None, allowed, missing=missing)
    cold = oil.temperature

    def bulk(cycle: Cycle) -> float:
        flash = cycle.rolling.flash
        return np.nan if flash is None else float(celsius(cold + bulk_rise(flash)))

    worst = worst_case(solution.cycles, bulk)
    rise = cycle_of(solution.cycles, worst).rolling.flash
    of_turn = {} if rise is None else {"T_m": float(np.mean(rise))}
    return Demand(worst.value, allowed, worst, figures=(oil.source,), stated=of_turn)


def bulk_allowed(machine: Machine, limit: Value) -> Value:
    """Limit of the bulk temperature, degC: the least of a limit, K, and those of the cards."""
    cards = [card.temperature_limit for card in machine.bodies.values()]
    return celsius(np.minimum(limit, min((t for t in cards if t is not None), default=np.inf)))


def heat_missing(machine: Machine, *of_oil: str) -> tuple[str, ...]:
    """Keys that the case lacks for the temperature of a sliding face, or of a roller that slips.

    of_oil : keys of the lubricant that are needed; without a lubricant its table is named.
    """
    missing = [*no_friction(machine)]
    oil = machine.lubricant
    missing += lacking(Lubricant.table, oil, *of_oil) if oil else [Lubricant.table]
    for each in machine.bodies.values():
        missing += (key for key in lacking_of_card(each, *_HEAT_PATH) if key not in missing)
    return tuple(missing)
