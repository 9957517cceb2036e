"""Checks of the key of the cam: pressure on hub and shaft, shear, keyway root, slip of the seat."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, Value, Values
from camwright.geometry.pitch_curve import magnitude
from camwright.pipeline.base import levers
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.limits import (
    CAM_SLIP,
    KEY_REVERSAL,
    KEY_SHARE,
    KEYWAY_SAFETY,
    SHAFT_RELIABILITY,
)
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import (
    NONE,
    STATED,
    Allowed,
    Declaration,
    Demand,
    Kept,
    check,
)
from camwright.pipeline.checks.demands import CAM_TORQUE, PerLoad, rating_over, seat_torque
from camwright.pipeline.checks.extremes import (
    NOWHERE,
    Extreme,
    on_both_tracks,
    row_of,
    worst_measure,
)
from camwright.pipeline.checks.missing_keys import lacking, lacking_of_card
from camwright.pipeline.contact.cam_body import CamBody, ParallelKey
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.notch_fatigue import fitted_root, notch_strength
from camwright.pipeline.cycle.numbers import Numbers, fitted_ring, greatest_interference, presses
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.camshaft_loads import KeyStress, key_stress
from camwright.pipeline.follower.shaft_strength import (
    keyway_root_stress,
    reliability_factor,
    surface_factor,
)

FIT = "cam.fit.least_interference", "cam.fit.greatest_interference"
METHOD = "DIN 6892 method C at the greatest cam torque, bearing length without round ends"
LOOSE = "must-have: a key that yields under reversed torque works loose and the cam loses its phase"
ALLOWED = (
    "R_e: lower yield strength of the two parts, S: limits.key_share, f: limits.key_reversal where"
    " the torque reverses, else 1"
)
BY_ELEMENTS = (
    "plane-stress elements of the cam on a solid shaft, frictionless unilateral contact with the"
    " interference, key and contact force over the turns at least and greatest interference; the"
    " lower of modified Goodman (Marin factors) and FKM local stress (to be confirmed)"
)
STEADY = 0.03
"""Relative error of the safety at the root by elements: their change with a finer mesh."""
WALLS = 0.75, 4.0
"""Least and greatest wall over the radius of the keyway floor for which the stress is known."""
_OF_FORCES = 2  # highest derivative of the lift
TINY = 1e-12
"""Utilisation of an unloaded root: its safety is finite."""


_BORE = "cam.bore_radius", "cam.width"
_RING = "cam.prime_radius", "roller.radius", "cam.second_base_radius"
_REVERSES = "cam.torque_reverses"
PRESSED = "T_p: with which preloaded discs turn against one another then, else 0, "


def _cam_of(numbers: Numbers) -> CamBody:
    """The cam with its bore and width."""
    bore, width = (float(numbers[key]) for key in _BORE)
    return replace(numbers.known_case.cam, bore_radius=bore, width=width)


def _reversal(cams: Iterable[LoadedCam]) -> dict[str, Value]:
    """1 where the torque through the key reverses in a load case, else 0."""
    return {_REVERSES: np.any([cam.reverses for cam in cams], axis=0).astype(float)[()]}


def _reverses(numbers: Numbers) -> NDArray[np.bool_]:
    """Whether the torque through the key reverses, or is not known."""
    stated = numbers.get(_REVERSES)
    return np.array(True) if stated is None else np.asarray(stated != 0.0)


class _Mate(NamedTuple):
    """Material of the part beside the key; missing: its key in the case. None: not judged."""

    card: Material | None
    missing: tuple[str, ...] = ()


def _key_check(
    name: str,
    title: str,
    formula: str,
    of: Callable[[KeyStress], Array],
    mate_of: Callable[[Case], _Mate | None],
    *,
    kept_as: str,
    symbols: Mapping[str, str],
    factor: float = 1.0,
) -> Declaration:
    """Check of a stress of the key against the yield strength of the weaker of the key and its
    mate, hub or shaft.

    Parameters
    ----------
    name : str           id of the check
    of : callable        stresses of the key -> the one that is judged, Pa
    mate_of : callable   case -> part beside the key whose strength counts, too; None: not judged
    factor : float       allowed stress over the allowed normal stress
    """

    def stress(numbers: Numbers) -> tuple[float]:
        """Stress of the key per torque, Pa/(N m), NaN without dimensions."""
        cam = _cam_of(numbers)
        key, flanks = cam.key or ParallelKey(), cam.key_flanks
        if flanks is None:
            return (np.nan,)
        return (float(of(key_stress(key.application_factor, 2.0 * cam.bore_radius, flanks))),)

    def per_torque(numbers: Numbers) -> Value:
        return numbers.each(stress, _BORE)[0]

    def allowed_in(numbers: Numbers) -> Allowed:
        """Allowed stress, Pa: share of the lower yield strength of key and mate, less under a
        torque that reverses; its missing keys.
        """
        case = numbers.known_case
        mate, key = mate_of(case), case.cam.key or ParallelKey()
        if mate is None:
            return Allowed(None)
        missing = (*mate.missing, *_no_key_data(case.cam), *lacking(key.table, key, "material"))
        reversal = np.where(_reverses(numbers), numbers.limit(KEY_REVERSAL), 1.0)[()]
        share = numbers.limit(KEY_SHARE) * reversal
        yields = [card.core_yield for card in _cards(key, mate)]
        return Allowed(None, missing) if missing else Allowed(factor * (share * min(yields)))

    def in_words(demand: Demand, solution: Solution) -> Demand:
        """Demand with the sources of the materials and, under a torque that reverses, of its
        factor.
        """
        case, mate = solution.case, mate_of(solution.case) or _Mate(None)
        figures = tuple(card.source.of(card.name) for card in _cards(case.cam.key, mate))
        reverses = any(cam.reverses for cam in solution.cams.values())
        if reverses:
            figures = (solution.machine.limits.source(KEY_REVERSAL), *figures)
        reversal = solution.machine.limits[KEY_REVERSAL] if reverses else 1.0
        yields = [card.core_yield for card in _cards(case.cam.key, mate)]
        stated = {"f": reversal, "R_e": min(yields, default=np.nan)} | _pressed_at(demand, solution)
        judged = replace(demand, figures=figures, stated=stated)
        return judged if case.cam.key_flanks else replace(judged, value=None, at=None)

    return check(
        KEY_SHARE,
        id=name,
        title=title,
        unit="MPa",
        method=METHOD,
        lift_can_help=True,
        tier=Tier.SCREENING,
        part="key",
        kept_as=kept_as,
        formula=formula,
        symbols={
            "K_A": "cam.key.application_factor",
            "T": "|cam_torque| [N m]",
            "T_p": f"{STATED} [N m]",
            "d": "2 cam.bore_radius [mm]",
            "l_tr": "cam.key.bearing_length [mm]",
            "f": STATED,
            "S": f"limits.{KEY_SHARE.id}",
            "R_e": f"{STATED} [MPa]",
            **symbols,
        },
        reason=LOOSE,
        values=given.KEY,
        levers=(levers.Scaled(("cam.key.length", "cam.width"), 1), *levers.GENTLER),
        page="Camshaft",
    ).measured(
        "angles",
        value=PerLoad(per_torque).value,
        bound=PerLoad(per_torque).bound,
        allowed=allowed_in,
        applies=lambda _, numbers: np.array(mate_of(numbers.known_case) is not None),
        known=_reversal,
        remark=in_words,
        deviation=0.003,
        kept=Kept(group=CAM_TORQUE, unit="N m"),
    )(seat_torque)


def _pressed_at(demand: Demand, solution: Solution) -> dict[str, float]:
    """Torque of the preload on the seat of a disc by its symbol, N m, at the worst cam angle."""
    if demand.at is None:
        return {}
    cycle, k = row_of(solution.cycles, demand.at)
    seat, cam = (
        float(magnitude(each[k])) for each in (cycle.loads.seat_torque, cycle.loads.cam_torque)
    )
    return {"T_p": seat - cam}


def _cards(key: ParallelKey | None, mate: _Mate) -> list[Material]:
    """Known materials of the key and its mate."""
    both = None if key is None else key.material, mate.card
    return [card for card in both if card is not None]


def _shaft_beside(case: Case) -> _Mate | None:
    """Shaft as mate of the key; None where the case does not cover the camshaft."""
    if not case.scope.covers("camshaft"):
        return None
    card = None if case.camshaft is None else case.camshaft.material
    return _Mate(card, () if card is not None else ("camshaft.material",))


_DEPTH = {"t1": "cam.key_data.shaft_depth [mm]", "s": "cam.key_data.chamfer [mm]"}
key_pressure = _key_check(
    CAM_TORQUE,
    "Key flank pressure on the cam",
    "p = 2 K_A (T + T_p)/(d l_tr (h - t1 - s)) <= f S R_e; T: greatest cam torque, "
    + PRESSED
    + "d: bore"
    " diameter, l_tr: bearing length, h, t1, s: height, shaft depth and chamfer of the key, "
    + ALLOWED,
    lambda stress: stress.hub,
    lambda case: _Mate(case.cam.material),
    kept_as="cam torque at the maximum pressure of the key on the cam",
    symbols={"h": "cam.key_data.height [mm]", **_DEPTH},
)
key_pressure_shaft = _key_check(
    "key_pressure_shaft",
    "Key flank pressure on the camshaft",
    "p = 2 K_A (T + T_p)/(d l_tr (t1 - s)) <= f S R_e; as key_pressure, with the depth t1 of the"
    " keyway in the shaft",
    lambda stress: stress.shaft,
    _shaft_beside,
    kept_as="cam torque at the maximum pressure of the key on the camshaft",
    symbols=_DEPTH,
)
key_shear = _key_check(
    "key_shear",
    "Key shear stress",
    "tau = 2 K_A (T + T_p)/(d b l_tr) <= f S R_e/sqrt(3); b: width of the key, R_e: yield strength"
    " of the key, else as key_pressure",
    lambda stress: stress.shear,
    lambda _: _Mate(None),
    kept_as="cam torque at the maximum shear stress of the key",
    symbols={"b": "cam.keyway.width"},
    factor=1.0 / np.sqrt(3.0),
)


def _corner_allowed(numbers: Numbers) -> Allowed:
    """Chamfer of the key; the key that it lacks."""
    chamfer = numbers.known_case.cam.key_corner
    return Allowed(chamfer, () if chamfer is not None else ("cam.key.chamfer",))


def _corner_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with the stated root radius of the keyway, or its missing key; it belongs to no cam
    angle.
    """
    cam, root = solution.machine.cam, "cam.keyway.root_radius"
    missing = () if cam.keyway_root_radius is not None else (root,)
    stated = {} if demand.allowed is None else {"s": demand.allowed}
    return replace(demand, at=None, missing=(*demand.missing, *missing), stated=stated)


@check(
    title="Root radius of the keyway vs. chamfer of its key",
    unit="mm",
    source=Source(
        "DIN 6885-1: the least chamfer of a key is the greatest root radius of its keyways",
        confirmed=False,
    ),
    method="fillet of the keyway in the cam, and chamfer of the key, the least of its standard"
    " where none is stated",
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="key",
    formula="r <= s; r: cam.keyway.root_radius, s: cam.key.chamfer, else the least of DIN 6885-1",
    symbols={"r": "cam.keyway.root_radius", "s": f"{STATED} [mm]"},
    reason="a key whose corners ride on the fillets wedges the keyway open instead of bearing on"
    " its flanks",
    load_cases=NONE,
    levers=(levers.one("cam.key.chamfer"), levers.one("cam.keyway.root_radius", -1)),
    page="Camshaft",
).measured("case", allowed=_corner_allowed, remark=_corner_in_words, deviation=1e-9)
def key_corner(cam: LoadedCam) -> Array:
    """Root radius of the keyway in the cam, m; NaN where it is not known."""
    radius = cam.numbers.known_case.cam.keyway_root_radius
    return np.array([np.nan if radius is None else radius])


_SLIP = "camshaft.slip_torque"


def _application(numbers: Numbers) -> float:
    """Application factor of the key, 1 without one."""
    key = numbers.known_case.cam.key
    return 1.0 if key is None else key.application_factor


def _slip_at(limit: float, numbers: Numbers) -> float | None:
    """Cam torque at a slip safety, N m; none of a sliding fit, which no lift can pass."""
    slip = float(numbers[_SLIP])
    return slip / (limit * _application(numbers)) if slip else None


def _must_not_slip(numbers: Numbers) -> NDArray[np.bool_]:
    """Whether the torque of each design or load case reverses through the fit, and so must not
    slip; a sliding fit leaves it to the key.
    """
    slip = numbers.get(_SLIP)
    keyed = numbers.known_case.cam.key is not None
    slides = np.asarray(keyed and slip is not None and np.asarray(slip) == 0.0)
    return np.asarray(_reverses(numbers) & ~slides)


def _slip_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with a note where the fit is a sliding one."""
    sliding = demand.value is not None and solution.numbers[_SLIP] == 0.0
    stated = {**demand.stated, **_pressed_at(demand, solution)}
    return replace(demand, note="sliding fit" if sliding else "", stated=stated)


cam_slip = check(
    CAM_SLIP,
    id="cam_slip",
    title="Slip torque of the cam seat over the greatest cam torque",
    method="slip torque of the seat over K_A T; evaluated where the torque reverses, of a sliding"
    " fit without a key alone: the key of another has its reversals in key_pressure",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="camshaft",
    kept_as="cam torque at the slip of the cam's seat",
    formula="T_slip/(K_A (T + T_p)) >= limits.cam_slip; T_slip: 2 pi mu p a^2 b of cam.fit, p:"
    " pressure at its least interference, least radius and greatest speed, mu, a, b: friction,"
    " radius and width of the seat, or the stated camshaft.slip_torque, 0 for a sliding fit, T:"
    f" greatest cam torque, {PRESSED}K_A: application factor of the key, or 1 without one",
    symbols={
        "T_slip": "camshaft.slip_torque",
        "K_A": "cam.key.application_factor",
        "T": "|cam_torque| [N m]",
        "T_p": f"{STATED} [N m]",
    },
    reason="where the torque reverses, a seat that slips within the clearance of its key"
    " frets, and fretting starts fatigue cracks",
    values=(*given.KEY, "camshaft.slip_torque", "cam.fit.*"),
    levers=(levers.one("camshaft.slip_torque"), levers.one(FIT[0]), *levers.GENTLER),
    page="Camshaft",
).measured(
    "angles",
    value=lambda worst, numbers: rating_over(numbers[_SLIP], _application(numbers) * worst, np.inf),
    bound=_slip_at,
    needed=(_SLIP,),
    applies=lambda _, numbers: _must_not_slip(numbers),
    known=_reversal,
    remark=_slip_in_words,
    deviation=0.003,
    kept=Kept(group=CAM_TORQUE),
)(seat_torque)


def _wall_allowed(numbers: Numbers) -> Allowed:
    card = numbers.known_case.cam.material
    return Allowed(card.core_yield)


def _wall_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand with the pressure of the fit, yield strength and source of the cam material."""
    card, pressure = solution.case.cam.material, solution.numbers.get("cam.fit.greatest_pressure")
    note = "" if pressure is None else f"pressure of the fit {shown(float(pressure), 'MPa')}"
    ring = fitted_ring(solution.numbers)
    stated = {"R_e": card.core_yield} | ({} if ring is None else {"b": float(ring.outer)})
    return replace(demand, note=note, figures=(f"{card.name}: {card.source}",), stated=stated)


@check(
    id="fit_yield",
    title="Von Mises stress of the cam's wall by its fit",
    unit="MPa",
    source=Source("yield strength of the core; elastic press fit, DIN 7190-1", confirmed=True),
    method="thick ring of the least radius at the greatest interference, at its bore",
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="camshaft",
    load_cases=NONE,
    formula="sqrt(t^2 + t p + p^2) <= R_e; p: pressure of cam.fit at its greatest interference on"
    " the ring of the least radius, t = p (b^2 + a^2)/(b^2 - a^2), a, b: radius of the bore and"
    " least radius of the contour, of two discs the lesser, R_e: core yield strength of the cam",
    symbols={
        "p": "cam.fit.ring_pressure [MPa]",
        "t": "[MPa]",
        "a": "cam.bore_radius",
        "b": f"{STATED} [mm]",
        "R_e": f"{STATED} [MPa]",
    },
    reason="a wall that yields loses its fit",
    values=("cam.material.E", "cam.material.nu", "cam.material.*yield_strength", "cam.fit.*"),
    levers=(levers.one(FIT[1], -1),),
    page="Cam",
).measured(
    "case",
    allowed=_wall_allowed,
    applies=lambda _, numbers: np.array(numbers.known_case.cam.fit is not None),
    needed=("cam.fit.greatest_pressure",),
    remark=_wall_in_words,
    deviation=1e-4,
)
def fit_yield(cam: LoadedCam) -> Array:
    """Von Mises stress at the bore of the cam by the greatest interference of the fit, Pa, the cam
    taken as a ring of its least radius; NaN without a fit.
    """
    ring, greatest = fitted_ring(cam.numbers), greatest_interference(cam.numbers)
    if ring is None or greatest is None:
        return np.asarray(np.nan)
    return np.asarray(ring.von_mises(ring.pressure(greatest)))


def _fit_lacks(numbers: Numbers) -> tuple[str, ...]:
    """Keys of the fit that a case lacks that states a slip torque of its own."""
    case = numbers.known_case
    shaft = case.camshaft
    if case.cam.fit is not None or shaft is None:
        return ()
    return FIT if shaft.slip_torque else ()


def _root_in_words(demand: Demand, solution: Solution) -> Demand:
    """Demand of the fatigue of the keyway root with its note and sources; its value is None without
    data, and for a wall so thin that the stress is not known.

    With a fit and finite elements it is their demand; the bound below them judges what it passes.
    """
    numbers = solution.numbers
    cam, limit, root = solution.machine.cam, demand.allowed, keyway_root_of(numbers)
    card = cam.material
    if np.isnan(root.per_stress):
        missing = *_no_key_data(cam), *lacking_of_card(card, "fatigue_bending", "tensile_strength")
        missing += () if cam.keyway_root_radius is not None else ("cam.keyway.root_radius",)
        missing += _fit_lacks(numbers)
        if cam.fit is not None and fitted_ring(numbers) is None:
            missing += ("camshaft.material",)
        return Demand(None, limit, missing=missing)
    wall = solution.least_radius - float(root.held_radius)
    thin, fillet = float(root.thin), float(root.root_radius)
    if not wall >= thin:
        note = f"wall of {shown(wall, 'mm')}, the stress is known from {shown(thin, 'mm')}"
        return Demand(None, limit, note=note)
    note = f"root radius {shown(fillet, 'mm')}, wall {shown(wall, 'mm')}"
    reliability = solution.machine.limits.source(SHAFT_RELIABILITY)
    judged = replace(demand, note=note, figures=(reliability, f"{card.name}: {card.source}"))
    if cam.fit is None:
        return replace(judged, stated=_loose_root(solution, root, demand.at or NOWHERE, wall))
    return _with_fit(replace(judged, figures=(*judged.figures, cam.fit.source)), solution)


def _loose_root(
    solution: Solution, root: KeywayRoot, worst: Extreme, wall: float
) -> dict[str, float]:
    """Stated numbers of the keyway root without a fit, at the worst cam angle: half of its
    pulsating stress, Pa, as amplitude "a" and mean "m", and factors of its strength; wall, m.
    """
    cycle, k = row_of(solution.cycles, worst)
    force = on_both_tracks(cycle, lambda each: np.abs(each.loads.normal_force))[k]
    torque = abs(cycle.loads.seat_torque[k])
    counted = min(wall, float(root.thick))
    stress = root.by_torque * torque + root.by_force * force * (root.thick / counted)
    half = float(0.5 * np.ravel(stress)[0])
    return _strengths(solution) | {"a": half, "m": half, "u": 0.0}


def _bound_says(demand: Value, numbers: Numbers) -> NDArray[np.bool_]:
    """Whether the closed form judges the root: under a press fit it is a bound of the safety."""
    below = np.asarray(demand) < np.asarray(numbers.limit(KEYWAY_SAFETY))
    return np.asarray(~below if presses(numbers) else np.ones_like(below))


def _root_solved(solution: Solution) -> Demand:
    """Demand by the closed form, or by the finite elements where there are some."""
    worst = worst_measure(solution, _root_safety, "angles", float, at_least=True, order=_OF_FORCES)
    limit = solution.machine.limits[KEYWAY_SAFETY]
    return _root_in_words(Demand(worst.value, limit, worst), solution)


def _root_safety(cam: LoadedCam) -> Array:
    measure = keyway_root.measure
    return np.asarray(np.nan) if measure is None else measure(cam)


def _with_fit(demand: Demand, solution: Solution) -> Demand:
    """Demand of the keyway root under a fit: the safety by finite elements where these are solved,
    otherwise that of the closed form, a lower bound, which decides only if it passes.
    """
    solved = solution.hub_fatigue
    if solved is None:
        bound, limit = demand.value, demand.allowed
        if bound is None or limit is None or not presses(solution.numbers):
            return demand
        if solution.coarse or not solution.cycles[0].error_bars:  # for ratios of demands
            return demand
        note = f"{demand.note}; at least {bound:.3g} by the closed form, a bound"
        if not bound < limit:
            return replace(demand, note=note)
        return replace(demand, value=None, at=None, note=note, judged_at=Tier.CYCLE.word)
    worst = solved.governing
    ends = ", ".join(
        f"{shown(2.0 * one.interference, 'um')} of interference: Goodman {one.goodman:.3g},"
        f" FKM {one.fkm:.3g}, {shown(one.pressure, 'MPa')} of pressure"
        for one in (solved.loose, solved.tight)
    )
    opens = max(solved.loose.opened, solved.tight.opened)
    note = f"{demand.note}; {ends}"
    note += f"; a part of the seat opens at {opens:.0%} of the angles" if opens else ""
    at = Extreme(worst.safety, worst.load_case, worst.cam_angle, STEADY)
    amplitude, mean = 0.5 * (worst.greatest - worst.least), 0.5 * (worst.greatest + worst.least)
    stated = _strengths(solution) | {"a": amplitude, "m": mean, "u": 1.0 / worst.fkm}
    return replace(demand, value=worst.safety, at=at, note=note, method=BY_ELEMENTS, stated=stated)


def _strengths(solution: Solution) -> dict[str, float]:
    """Stated factors of the endurance of the cam's material: surface "k_a" and reliability "k_e";
    empty without tensile strength.
    """
    tensile = solution.machine.cam.material.tensile_strength
    if tensile is None:
        return {}
    rest = reliability_factor(solution.machine.limits[SHAFT_RELIABILITY])
    return {"k_a": surface_factor("machined", tensile), "k_e": rest}


@check(
    KEYWAY_SAFETY,
    id="keyway_root",
    title="Fatigue safety factor of the keyway root in the cam",
    method="elements of rings with DIN 6885-1 keyways: greatest principal stress at the fillet by"
    " key pressure and contact force, pulsating from zero, with cam.fit by its greatest"
    " interference, too; Goodman line, machined surface",
    lift_can_help=True,
    tier=Tier.SCREENING,
    part="key",
    formula="1/max(a/S_e + max(m, 0)/R_m, u) >= limits.keyway_safety; a, m: amplitude and mean of"
    " the stress at the root, S_e = k_a k_e S_e': endurance of the cam's material with factors of"
    " surface and limits.shaft_reliability, R_m: its tensile strength, u: 0. Without cam.fit a and"
    " m are half of (0.70 p + 4.1 F_n/(b h)) (t2/r)^0.4555, greatest over the turn, p:"
    " key_pressure, F_n: normal force, b: cam width, h: least wall beyond the keyway, from 0.75 and"
    " counted up to 4 times the radius of its floor, t2, r: depth and root radius of the keyway."
    " With cam.fit a and m are by the finite elements, u: use by the FKM guideline, the worse at"
    " least and greatest interference; in a preview a bound, (1.775 F_n/(2 t2 b) + 0.635 p) q and"
    " (3 s_f + 0.515 p) q, q: (t2/r)^0.3, s_f: hoop stress of the fit at the floor of the keyway,"
    " S_e and R_m: the lower strength by both",
    symbols={
        **dict.fromkeys(("a", "m"), f"{STATED} [MPa]"),
        **dict.fromkeys(("k_a", "k_e", "u"), STATED),
        "S_e'": "cam.material.fatigue_bending",
        "R_m": "cam.material.tensile_strength",
        "S_e": "[MPa]",
    },
    reason="a crack from the root of the keyway splits the cam",
    values=(
        *given.KEY,
        *given.CONTACT,
        "cam.material.fatigue_bending",
        "cam.material.tensile_strength",
        "limits.shaft_reliability",
        "cam.fit.*",
    ),
    levers=(levers.one("cam.keyway.root_radius"), levers.one("cam.width"), *levers.GENTLER),
    page="Cam",
).measured(
    "angles",
    worst="least",
    applies=_bound_says,
    remark=_root_in_words,
    solved=_root_solved,
    deviation=0.003,
)
def keyway_root(cam: LoadedCam) -> Array:
    """Fatigue safety factor of the keyway root in the cam; NaN for a wall below `WALLS`."""
    root = keyway_root_of(cam.numbers)
    wall = np.asarray(cam.least_radius - root.held_radius)
    counted = np.where(np.real(wall) < root.thick, wall, root.thick)
    force = on_both_tracks(cam, lambda each: magnitude(each.normal))
    used: Array = root.used_by(magnitude(cam.seat_torque), force, counted)
    applicable = (np.real(wall) >= root.thin) & np.isfinite(used)
    return np.where(applicable, 1.0 / np.where(np.real(used) > TINY, used, TINY), np.nan)


def _no_key_data(cam: CamBody) -> tuple[str, ...]:
    """Keys of the key's dimensions that are not in the case and of no standard."""
    return tuple(
        f"{ParallelKey.table}.{name}" for name, value in cam.key_data.items() if value is None
    )


class KeywayRoot(NamedTuple):
    """Stress at the keyway root per torque, Pa/(N m), and for a thick wall per force, Pa/N.

    held_radius: of the floor of the keyway, root_radius: of its corner, thick: greatest wall that
    counts, m; per_stress: use of the fatigue strength, 1/Pa; by_fit: use by the fit alone. Of
    designs arrays (m, 1).
    """

    by_torque: Value
    by_force: Value
    held_radius: Value
    root_radius: Value
    thick: Value
    per_stress: Value
    by_fit: Value = 0.0

    @property
    def thin(self) -> Value:
        """Least wall for which the stress is known, m."""
        return WALLS[0] * self.held_radius

    def used_by(self, torque: Values, force: Values, wall: float | Values) -> Values:
        """Stress over strength (...) by torque, N m, and force, N, at a wall of at most `thick`."""
        stress: Values = self.by_torque * torque + self.by_force * force * (self.thick / wall)
        return stress * self.per_stress + self.by_fit


def keyway_root_of(numbers: Numbers) -> KeywayRoot:
    """Stress coefficients of the keyway root; NaN without its data, or outside the scope."""
    keys: tuple[str, ...] = (*_BORE, f"limits.{SHAFT_RELIABILITY.id}")
    if numbers.known_case.cam.fit is not None:
        keys = (*keys, *FIT, *_RING)
    return KeywayRoot(*numbers.each(_root_of, keys))


def _root_of(numbers: Numbers) -> KeywayRoot:
    """Stress coefficients of the keyway root of one machine; NaN without its data."""
    cam, card = _cam_of(numbers), numbers.known_case.cam.material
    keyway, key, flanks, radius = cam.keyway, cam.key, cam.key_flanks, cam.keyway_root_radius
    endurance, tensile = card.fatigue_bending, card.tensile_strength
    unknown = KeywayRoot(*(7 * [np.nan]))
    if keyway is None or key is None or flanks is None or radius is None:
        return unknown
    if endurance is None or tensile is None or not numbers.known_case.scope.covers("key"):
        return unknown
    if _fit_lacks(numbers):
        return unknown
    pressure = key_stress(key.application_factor, 2.0 * cam.bore_radius, flanks).hub
    if presses(numbers):
        return _fitted_root(numbers, cam, float(pressure), radius) or unknown
    strength = surface_factor("machined", tensile) * endurance
    strength *= reliability_factor(float(numbers.limit(SHAFT_RELIABILITY)))
    thick = WALLS[1] * cam.held_radius
    shape = cam.width, thick, keyway.depth, radius
    return KeywayRoot(
        by_torque=float(keyway_root_stress(pressure, 0.0, *shape)),
        by_force=float(keyway_root_stress(0.0, 1.0, *shape)),
        held_radius=cam.held_radius,
        root_radius=radius,
        thick=thick,
        per_stress=0.5 * (1.0 / strength + 1.0 / tensile),
    )


def _fitted_root(
    numbers: Numbers, cam: CamBody, pressure: float, radius: float
) -> KeywayRoot | None:
    """Stress coefficients of a keyway root under a fit; None without its data.

    pressure : on the key per torque, Pa/(N m)
    radius : of the root, m
    """
    ring, greatest = fitted_ring(numbers), greatest_interference(numbers)
    strength = notch_strength(cam.material, radius, float(numbers.limit(SHAFT_RELIABILITY)))
    if ring is None or greatest is None or strength is None or cam.keyway is None:
        return None
    depth = cam.keyway.depth
    root = fitted_root(ring.hoop(ring.pressure(greatest), cam.held_radius), depth, radius)
    amplitude, mean = strength.bound

    def use(tension: float, compression: float) -> float:
        change, middle = 0.5 * (tension + compression), 0.5 * max(tension - compression, 0.0)
        return change * amplitude + middle * mean

    # the wall does not count: that of the contact is bounded by the depth of the keyway
    thin = WALLS[0] * cam.held_radius
    return KeywayRoot(
        by_torque=use(*root.key) * pressure / amplitude,
        by_force=use(*root.contact) / (2.0 * depth * cam.width) / amplitude,
        held_radius=cam.held_radius,
        root_radius=radius,
        thick=thin,
        per_stress=amplitude,
        by_fit=float(root.fit) * mean,
    )
