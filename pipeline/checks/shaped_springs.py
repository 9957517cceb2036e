"""Checks of torsion and extension springs, and of springs between an arm and a fixed point."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.pipeline.base import levers
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import SPRING_FATIGUE
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.cam_shape import lift
from camwright.pipeline.checks.check import (
    NONE,
    Allowed,
    Declaration,
    Demand,
    Kept,
    check,
)
from camwright.pipeline.checks.extremes import Measure
from camwright.pipeline.checks.spring_strength import HARDEST
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.spring_kinds import (
    HOOKED_SHARES,
    ExtensionSpring,
    SpringPart,
    TorsionWire,
)

BENDING_STRENGTH = 0.54  # permissible bending stress over R_m, above 1e6 strokes


def _torsion(cam: LoadedCam) -> TorsionWire:
    """Torsion spring of the cam; InputError where it has none."""
    torsion = cam.spring_shape
    if not isinstance(torsion, TorsionWire):
        raise InputError("spring.torsion", "missing", "given for the checks of the spring")
    return torsion


def _bending_stresses(cam: LoadedCam) -> tuple[Array, Array]:
    """Bending stress of the hardest spring in tolerance at maximum and at zero lift, Pa, below zero
    where it is unwound; NaN without the wire.
    """
    torsion, work = _torsion(cam), cam.hardest
    rest = torsion.moment_at(work.preload, 0.0 * work.travel)
    at_top = torsion.bending_stress(torsion.moment_at(work.greatest, work.travel))
    return at_top, torsion.bending_stress(rest)


def _bending_stress(cam: LoadedCam) -> Array:
    """Greatest bending stress of the spring in tolerance, Pa; that of one which is unwound at zero
    lift may be there, with its preload far low.
    """
    at_top, rest = _bending_stresses(cam)
    spread = cam.numbers["spring.preload_tolerance"]
    unwound = -rest * (1.0 + spread) / (1.0 - spread)
    return np.asarray(np.where(np.real(unwound) > np.real(at_top), unwound, at_top))


def _stress_range(cam: LoadedCam) -> Array:
    """Bending stress less that at zero lift, Pa."""
    at_top, rest = _bending_stresses(cam)
    return at_top - rest


def _of_torsion(demand: Demand, solution: Solution) -> Demand:
    spring = solution.machine.spring
    torsion = spring.torsion or spring.torsion_pivot
    return replace(demand, figures=() if torsion is None else (torsion.source,), corner=HARDEST)


_WOUND = ("torsion", "torsion_pivot")


def _shaped_check(
    name: str, measure: Measure, allowed: Callable[[Numbers], Allowed],
    remark: Callable[[Demand, Solution], Demand], *, part: SpringPart, title: str, source: Source,
    method: str, formula: str, reason: str, tables: Sequence[str],
) -> Declaration:  # fmt: skip
    """Check of a stress, at maximum lift, of a spring that is no compression spring; tables: those
    of a case with its `wire_diameter`, the first lever.
    """
    return check(
        id=name,
        title=title,
        unit="MPa",
        source=source,
        method=method,
        lift_can_help=True,
        tier=Tier.SCREENING,
        moved_by_tolerance=False,
        part=part,
        formula=formula,
        reason=reason,
        load_cases=NONE,
        values=given.SPRING,
        levers=(
            *(levers.one(f"{table}.wire_diameter", most=2.0) for table in tables),
            *levers.GENTLER,
        ),
        page="Spring",
    ).measured("top", allowed=allowed, remark=remark, deviation=1e-4, kept=Kept())(measure)


def _torsion_check(
    name: str, measure: Measure, key: str, share: float, *, title: str, source: Source, method: str,
    formula: str, reason: str,
) -> Declaration:  # fmt: skip
    """Check of a bending stress of a torsion spring against a `share` of the value at a `key` of
    its table.
    """

    def allowed(numbers: Numbers) -> Allowed:
        """Allowed bending stress, Pa: the share of the value at the key; its missing keys."""
        table = f"spring.{numbers.known_case.spring.kind}"
        value = numbers.get(f"{table}.{key}")
        needed = (f"{table}.{each}" for each in ("wire_diameter", "mean_diameter", key))
        missing = tuple(each for each in needed if numbers.get(each) is None)
        return Allowed(None if value is None else share * value, missing)

    return _shaped_check(
        name, measure, allowed, _of_torsion, part="torsion_spring", title=title, source=source,
        method=method, formula=formula, reason=reason,
        tables=[f"spring.{each}" for each in _WOUND],
    )  # fmt: skip


torsion_stress = _torsion_check(
    "torsion_stress",
    _bending_stress,
    "tensile_strength",
    BENDING_STRENGTH,
    title="Maximum bending stress of the torsion spring",
    source=Source(
        "0.54 R_m of high-carbon wire above 1e6 strokes, 0.55 of oil-tempered wire, the safer:"
        " Analysis and Design of Machine Elements, p. 408, table 14.3; DIN EN 13906-3, recalled,"
        " has 0.7 R_m",
        confirmed=False,
    ),
    method="q 32 M/(pi d^3) at maximum lift, preload and rise of the force high; at zero lift where"
    " the spring is unwound there and its moment greater",
    formula="q 32 M / (pi d^3) <= 0.54 R_m; M: greatest moment with the tolerances, at maximum or"
    " zero lift, q = (w + 0.07)/(w - 0.75), w = D/d, R_m: tensile strength of the wire",
    reason="A spring beyond its yield strength sets and loses the force that keeps the follower on"
    " the cam.",
)
torsion_fatigue = _torsion_check(
    "torsion_fatigue",
    _stress_range,
    "stress_range",
    1.0,
    title="Range of the bending stress of the torsion spring",
    source=Source(
        "stress_range of the spring: fatigue diagram of DIN EN 13906-3, or of the maker",
        confirmed=True,
    ),
    method="difference of q 32 M/(pi d^3) at maximum and zero lift, preload and rise high",
    formula="q 32 (M_h - M_0) / (pi d^3) <= S; S: stress_range of the table of the spring, M_h,"
    " M_0: moments at maximum and zero lift with the tolerances high, q: as of `torsion_stress`",
    reason="A broken spring releases the follower.",
)


def _extension(cam: LoadedCam) -> ExtensionSpring:
    """Extension spring of the cam; InputError where it has none."""
    hooked = None if cam.spring_shape is None else cam.spring_shape.own
    if not isinstance(hooked, ExtensionSpring):
        raise InputError("spring.extension", "missing", "given for the checks of the spring")
    return hooked


def _of_extension(demand: Demand, solution: Solution) -> Demand:
    spring = solution.machine.spring.extension
    return replace(demand, figures=() if spring is None else (spring.source,), corner=HARDEST)


_HOOKED = "spring.extension"
_HOOKED_TABLE = Source(
    "shares of R_m, body 45 to 50 %, ends 40 % in torsion and 75 % in bending, of austenitic wire"
    " 35, 30 and 55 %: amesweb.info, Maximum allowable stresses for coil extension springs, as"
    " Shigley, table 10-7, p. 529; hooks 40 to 45 and 75 %: a maker, tinmy.cn, Custom extension"
    " springs",
    confirmed=True,
)
_LOOSE = "A hook or coil that breaks or sets releases the follower."
_F = "F: force of the spring at maximum lift, preload and rate high"


def _extension_check(
    name: str, measure: Measure, share: str, *needed: str, title: str, source: Source,
    formula: str,
) -> Declaration:  # fmt: skip
    """Check of a stress of an extension spring against a `share` of the tensile strength of its
    wire, by its name in `HookedShares`; needed: other keys without which it is not known.
    """

    def allowed(numbers: Numbers) -> Allowed:
        """Allowed stress, Pa; its missing keys."""
        strength = numbers.get(f"{_HOOKED}.tensile_strength")
        keys = (f"{_HOOKED}.{each}" for each in ("tensile_strength", *needed))
        missing = tuple(each for each in keys if numbers.get(each) is None)
        hooked = numbers.known_case.spring.extension
        if strength is None or hooked is None:
            return Allowed(None, missing)
        return Allowed(getattr(HOOKED_SHARES[hooked.wire_kind], share) * strength, missing)

    return _shaped_check(
        name, measure, allowed, _of_extension, part="extension_spring", title=title, source=source,
        method="at maximum lift, preload and rate high; without surge", formula=formula,
        reason=_LOOSE, tables=[_HOOKED],
    )  # fmt: skip


extension_stress = _extension_check(
    "extension_stress",
    lambda cam: _extension(cam).body_stress(cam.hardest.greatest),
    "body",
    title="Maximum shear stress of the coils of the extension spring",
    source=_HOOKED_TABLE,
    formula="K_w 8 D F / (pi d^3) <= c R_m; K_w = (4 C - 1)/(4 C - 4) + 0.615/C, C = D/d, c = 0.45,"
    f" 0.35 of austenitic wire, R_m: tensile strength of the wire, {_F}",
)
extension_hook_bending = _extension_check(
    "extension_hook_bending",
    lambda cam: _extension(cam).hook_bending(cam.hardest.greatest),
    "bending",
    title="Maximum normal stress of the hook of the extension spring",
    source=_HOOKED_TABLE,
    formula="F (K_A 16 D/(pi d^3) + 4/(pi d^2)) <= c R_m; K_A = (4 C^2 - C - 1)/(4 C (C - 1)), C ="
    f" 2 r_1/d, r_1: mean radius of the hook, c = 0.75, 0.55 of austenitic wire, {_F}",
)
extension_hook_torsion = _extension_check(
    "extension_hook_torsion",
    lambda cam: _extension(cam).hook_torsion(cam.hardest.greatest),
    "torsion",
    "side_radius",
    title="Maximum shear stress of the bend from the coils to the hook",
    source=_HOOKED_TABLE,
    formula="K_B 8 D F/(pi d^3) <= c R_m; K_B = (4 C - 1)/(4 C - 4), C = 2 r_2/d, r_2: mean radius"
    f" of the bend, c = 0.40, 0.30 of austenitic wire, {_F}",
)
extension_fatigue = check(
    SPRING_FATIGUE,
    id="extension_fatigue",
    title="Fatigue safety factor of the extension spring",
    method="least of coils, bend and hook at maximum and zero lift, preload and rate high; without"
    " surge",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="extension_spring",
    formula="1 / max(tau_a/S_e + tau_m/(0.67 R_m), 0.577 s_a/S_e + s_m/R_m) >="
    " limits.spring_fatigue; tau: shear stress with the greater of K_w and K_B, s: normal stress of"
    " the hook, _a and _m amplitude and mean, S_e: endurance by Zimmerli's point of a wire that is"
    " not peened, of the hook at most 0.577 of that of 0.45 R_m from zero at 1e7 strokes; as of"
    " `spring_fatigue`, `extension_hook_bending`, `extension_hook_torsion`",
    reason=_LOOSE,
    load_cases=NONE,
    values=given.SPRING,
    levers=(levers.one(f"{_HOOKED}.wire_diameter", most=2.0), *levers.GENTLER),
    page="Spring",
).measured(
    "top",
    value=lambda worst, _: 1.0 / worst,
    bound=lambda limit, _: 1.0 / limit,
    needed=(f"{_HOOKED}.tensile_strength", f"{_HOOKED}.side_radius"),
    remark=_of_extension,
    deviation=1e-4,
    kept=Kept(),
)(lambda cam: _extension(cam).fatigue_use(cam.hardest.preload, cam.hardest.greatest))


def _wound_tension(worst: Value, numbers: Numbers) -> Value:
    """Initial tension of an extension spring, N."""
    tension: Value = numbers[f"{_HOOKED}.initial_tension"]
    return tension + 0.0 * worst


def _tension_limit(numbers: Numbers) -> Allowed:
    """Least of the preload with its tolerance low and what coiling gives, N."""
    spring = numbers.known_case.spring
    if spring.extension is None:
        return Allowed(None)
    least = spring.extension.preload * (1.0 - numbers["spring.preload_tolerance"])
    return Allowed(min(least, spring.extension.most_initial_tension))


extension_initial_tension = check(
    id="extension_initial_tension",
    title="Initial tension of the extension spring",
    unit="N",
    source=Source(
        "upper end of the range that a maker winds in routinely: Shigley, eq. 10-41 and fig. 10-7c,"
        " 33500 psi/exp(0.105 C) + 1000 psi (4 - (C - 3)/6.5), by two transcriptions that agree",
        confirmed=False,
    ),
    method="stated value against the preload with its tolerance low, and what coiling gives",
    lift_can_help=False,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    part="extension_spring",
    formula="F_0 <= min(F_1, pi d^3 tau_0/(8 D)); F_0: spring.extension.initial_tension, F_1:"
    " preload low, tau_0 = 231/e^(0.105 C) + 6.9 (4 - (C - 3)/6.5) MPa, C = D/d",
    reason="Below its initial tension the coils close and the rate is no longer that of the spring;"
    " more than coiling gives cannot be made.",
    load_cases=NONE,
    values=given.SPRING,
    levers=(levers.one(f"{_HOOKED}.force", most=2.0),),
    page="Spring",
).measured(
    "top",
    value=_wound_tension,
    allowed=_tension_limit,
    remark=_of_extension,
    deviation=1e-4,
)(lift)


def _rising(numbers: Numbers) -> Allowed:
    """Lift up to which the force of a linked spring rises; None without a link."""
    shape = numbers.spring_shape
    return Allowed(
        None if numbers.known_case.spring.linked is None or shape is None else shape.reach
    )


def _of_link(demand: Demand, solution: Solution) -> Demand:
    """Demand with the source of the link and the swing to the dead centre of the spring."""
    link = solution.machine.spring.linked
    if link is None:
        return demand
    note = f"dead centre of the spring at a lift of {shown(float(link.most_lift), 'mm', 4)}"
    return replace(demand, figures=(link.source,), note=note)


link_reach = check(
    id="link_reach",
    title="Lift up to which the spring on the arm closes with a rising force",
    unit="mm",
    source=Source("lift from energy has one solution", confirmed=True),
    method="lift at which the lever of the spring falls as fast as its force rises, or the law of"
    " a gas spring ends; before its dead centre",
    lift_can_help=True,
    tier=Tier.SCREENING,
    moved_by_tolerance=False,
    needs="arm",
    formula="h <= s_r; h: maximum lift, s_r: lift at which F_s du/ds is greatest, F_s: force of the"
    " spring, u: travel of its ends",
    symbols={"h": "lift_highest"},
    reason="Towards the dead centre the lever of the spring vanishes, and with it the force that"
    " keeps the follower on the cam.",
    load_cases=NONE,
    values=given.SPRING,
    levers=(levers.one("spring.link.arm_radius", most=2.0), *levers.GENTLER),
    page="Spring",
).measured(
    "top",
    allowed=_rising,
    applies=lambda _, numbers: np.array(numbers.known_case.spring.linked is not None),
    remark=_of_link,
    deviation=1e-4,
    kept=Kept(),
)(lift)
