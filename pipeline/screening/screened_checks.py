"""Checks of the screening: demand and limit of many designs together.

The formulas are those of the checks, on arrays. Where a check adds what screening leaves out, the
surge of the spring or the temperature of a guide, the utilisation is a lower bound: a design that
fails by it fails the check; any other is not evaluated (`Declaration.is_bound`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import FULL_TURN, Array, Value
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.pipeline.base.counterweight_body import CounterweightBody
from camwright.pipeline.base.units import celsius
from camwright.pipeline.case.limits import (
    ARM_SAFETY,
    ASSEMBLY_GAP,
    CONTACT_FORCE_MARGIN,
    CROSSOVER_SLIP,
    FRICTION_POWER,
    LANDING_SPEED,
    SURFACE_TEMPERATURE,
    TORQUE_REDUCTION,
    AnyLimit,
)
from camwright.pipeline.checks import (
    arm_strength,
    assembly,
    contact_strength,
    demands,
    flat_face_sliding,
    form_closure,
    gas_spring,
    guide_strength,
    roller_bearing,
    torque_balance,
)
from camwright.pipeline.checks.arm_strength import ArmPlace
from camwright.pipeline.checks.check import Bounded, Declaration, Measured
from camwright.pipeline.checks.demands import rating_over
from camwright.pipeline.checks.extremes import BY_DUTY, Measure
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.checks.roller_bearing import FIRST_ROLLER, SECOND_ROLLER, JudgedRoller
from camwright.pipeline.contact.flash_temperature import bulk_rise
from camwright.pipeline.contact.hertz import peak_pressure_square
from camwright.pipeline.cycle.arm_bodies import with_swing
from camwright.pipeline.cycle.crossover_history import WallImpact
from camwright.pipeline.cycle.machine_envelope import counterweight_body
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.follower.camshaft_loads import Counterweight
from camwright.pipeline.follower.spring import spring_energy
from camwright.pipeline.screening import screened_pivot
from camwright.pipeline.screening.design_arrays import Designs, Judged, Screened, never
from camwright.pipeline.screening.design_lengths import has_many_shapes
from camwright.pipeline.screening.screened_cam import ScreenedCam


def _by_measure(declared: Declaration, measure: Measure, how: Measured) -> Screened | None:
    """Screening of a check declared by a measure (`how`: its reduction and limit); None where it
    states no deviation from the preview.
    """
    if how.deviation is None:
        return None

    def numbers_of(designs: Designs) -> Numbers:
        own = designs.numbers
        return own if how.known is None else own | how.known(designs.cams)

    def applies(demand: Array, designs: Designs) -> NDArray[np.bool_]:
        return np.ravel(how.applies(demand[:, None], numbers_of(designs)))

    def judged(designs: Designs) -> Judged | None:
        """Demand and limit (m,); None where they need a key of a part outside the scope of the
        case.
        """
        numbers, shape = numbers_of(designs), (designs.count, 1)
        if not np.any(how.applies(np.full(shape, np.nan), numbers)):
            return None
        if declared.lacks_left_out(designs.machine, numbers):
            return None
        demand = np.broadcast_to(_demand(measure, how, designs, numbers), shape)
        limit = how.allowed(numbers).against_each(demand)
        if own := how.limits_of_strokes(numbers):
            demands = [_demand(each.measure, how, designs, numbers) for each in how.strokes]
            demand, limit = _of_strokes(demand, limit, demands, own)
        return demand[:, 0], limit[:, 0]

    return Screened(declared.id, judged, how.deviation, applies, _BOUNDED[how.bounded])


_BOUNDED: Mapping[Bounded, Callable[[Designs], bool]] = {
    "": never,
    "crown": lambda designs: designs.machine.is_crowned and has_many_shapes(designs),
    "line": has_many_shapes,
    "surge": lambda designs: designs.case.spring.design is not None,
}


def _of_strokes(
    either: Array, limit: Array, demands: Sequence[Array], limits: Sequence[Value]
) -> tuple[Array, Array]:
    """Demand and limit (m, 1) of the stroke, such as opening and closing, of the greatest
    utilisation; those of the whole turn where a stroke has no limit of its own.

    Parameters
    ----------
    either, limit : array (m, 1)   demand and limit of the whole turn
    demands, limits : sequence     of each stroke, (m, 1)
    """
    known = np.all([~np.isnan(each) & np.ones(limit.shape, dtype=bool) for each in limits], axis=0)
    demand, own = np.broadcast_arrays(demands[0], limits[0], either)[:2]
    for other, allowed in zip(demands[1:], limits[1:], strict=True):
        steeper = other / allowed > demand / own
        demand, own = np.where(steeper, other, demand), np.where(steeper, allowed, own)
    return np.where(known, demand, either), np.where(known, own, limit)


def _demand(measure: Measure, how: Measured, designs: Designs, numbers: Numbers) -> Array:
    """Demand (m, 1) by the worst value of a measure, as `worst_measure`; NaN: not known."""
    lacking = np.zeros((designs.count, 1), dtype=bool)
    for key in how.needed:
        stated: object = numbers.get(key)  # of some keys a word or a part
        if isinstance(stated, float | np.ndarray):
            lacking = lacking | np.isnan(stated)
        elif stated is None:
            lacking[:] = True
    if lacking.all():
        return np.full(lacking.shape, np.nan)
    return np.where(lacking, np.nan, _known(measure, how, designs, numbers))


def _known(measure: Measure, how: Measured, designs: Designs, numbers: Numbers) -> Array:
    """Demand (m, 1) by the worst value of a measure, all needed values being stated;
    see `_demand`.
    """
    if how.reduce in ("case", "top"):
        return np.asarray(how.value(measure(designs.top), numbers))
    if how.reduce == "contour":
        extreme, worst = (
            (sampled_least, np.min) if how.worst == "least" else (sampled_greatest, np.max)
        )
        each = [extreme(measure(disc)) for disc in designs.discs_to(how.order)]
        return np.asarray(how.value(worst(each, axis=0)[:, None], numbers))
    if how.reduce in BY_DUTY:
        return _by_duty(measure, how, designs, numbers)
    each = [_of_turn(measure, how, cam) for cam in designs.cams]
    if how.reduce == "mean":
        each = [np.asarray(how.value(mean, numbers)) for mean in each]
    worst = np.min(each, axis=0) if how.worst == "least" else np.max(each, axis=0)
    return np.asarray(worst if how.reduce == "mean" else how.value(worst, numbers))


def _of_turn(measure: Measure, how: Measured, cam: ScreenedCam) -> Array:
    """Mean or worst value of a measure over the turn (m, 1), stored for other checks
    that share it.
    """
    key = measure, "mean" if how.reduce in ("mean", *BY_DUTY) else how.worst, how.smooth
    if key not in cam.figures:
        values = measure(cam)
        if key[1] == "mean":
            figure = np.mean(values, axis=-1)
        elif how.smooth:
            figure = (sampled_least if how.worst == "least" else sampled_greatest)(values)
        else:
            figure = np.max(values, axis=-1)
        cam.figures[key] = np.asarray(figure)[:, None]
    return cam.figures[key]


def _by_duty(measure: Measure, how: Measured, designs: Designs, numbers: Numbers) -> Array:
    """Wear, or life by the mean damage, of the load cases by their duty."""

    def of_turn(cam: ScreenedCam) -> Array:
        return np.asarray(how.value(_of_turn(measure, how, cam), numbers))

    return _over_duty(designs, of_turn, life=how.reduce == "life")


def _over_duty(
    designs: Designs,
    of_turn: Callable[[ScreenedCam], Array],
    *,
    life: bool,
    steady: bool = False,
) -> Array:
    """Wear, the sum of duty times wear, or with `life` the life, 1 / sum of duty over life, of the
    load cases together (m, 1); see `over_duty`.

    The worst of them where a duty is not stated; NaN where none runs. steady : load cases of the
    case file alone, without standstill and over-speed. of_turn : figure (m, 1) of a load case.
    """
    cams = [cam for cam in designs.cams if cam.state.steady or not steady]
    running = [cam for cam in cams if cam.state.duty != 0.0]
    if not running:
        return np.full((designs.count, 1), np.nan)
    values = [of_turn(cam) for cam in running]
    duties = [cam.state.duty for cam in running]
    if any(duty is None for duty in duties):
        return np.asarray(np.min(values, axis=0) if life else np.max(values, axis=0))
    shares = [
        (duty or 0.0) * (1.0 / each if life else each)
        for duty, each in zip(duties, values, strict=True)
    ]
    whole = np.sum(shares, axis=0)
    return np.asarray(1.0 / whole if life else whole)


def torque_after(designs: Designs, cam: ScreenedCam) -> Array:
    """Measure: crank torque of engine and cam together (m, k), N m, at the cam angles of the engine
    torque.

    The cam torque is interpolated by cubics between the cam angles of its loads; the peaks of the
    engine torque are narrower.
    """
    before = np.zeros(1) if cam.state.torque is None else cam.state.torque
    torque = cam.torque
    if designs.torque_step is not None:
        torque = _between(torque, designs.step // designs.torque_step)
    return np.asarray(before - torque / designs.case.mechanism.gear_ratio)


def _between(values: Array, step: int) -> Array:
    """Periodic values (m, n) interpolated to (m, n step) equal angles, cubic through
    four of them.
    """
    at = np.arange(step) / step
    weights = (
        -at * (at - 1.0) * (at - 2.0) / 6.0,
        (at + 1.0) * (at - 1.0) * (at - 2.0) / 2.0,
        -(at + 1.0) * at * (at - 2.0) / 2.0,
        (at + 1.0) * at * (at - 1.0) / 6.0,
    )
    shifted = zip((1, 0, -1, -2), weights, strict=True)
    between = sum(np.roll(values, by, axis=-1)[..., None] * weight for by, weight in shifted)
    return np.asarray(between).reshape(*values.shape[:-1], -1)


def _torque_reduction(designs: Designs) -> Judged | None:
    """Least reduction of the torque ripple (m,), as a share, over the load cases that require one,
    and its limit; None where none requires one.
    """
    shares = [
        (demands.ripple_reduction(cam.state.torque, torque_after(designs, cam)), required)
        for cam in designs.cams
        if cam.state.torque is not None and (required := cam.state.required) is not None
    ]
    if not shares:
        return None
    common = np.max(np.broadcast_arrays(*(required for _, required in shares)), axis=0)
    least = [demands.common_reduction(share, required, common) for share, required in shares]
    return np.min(least, axis=0), np.broadcast_to(common, designs.count)


def _grease_life(designs: Designs, at: JudgedRoller) -> Judged | None:
    """Grease life of the bearing of a roller over the load cases and its target (m,), s; NaN where
    lubrication or target is not stated. None with oil.
    """
    numbers, shape = designs.numbers, (designs.count, 1)
    if (lubrication := at.bearing_in(designs.case).lubrication) == "oil":
        return None
    target = None if lubrication is None else roller_bearing.grease_target(numbers, at)
    life = (
        np.nan
        if lubrication is None
        else _over_duty(designs, partial(roller_bearing.greased, at=at), life=True)
    )
    limit = np.broadcast_to(np.nan if target is None else target, shape)
    return np.broadcast_to(life, shape)[:, 0], np.asarray(limit, dtype=float)[:, 0]


def _counterweights(designs: Designs) -> tuple[Counterweight, Array, CounterweightBody] | None:
    """Counterweight, the unbalance it has to balance (m, 1), kg m, and its body in each design;
    None without one, or with a drilled cam, whose hole is sought one cam at a time.
    """
    shaft = designs.machine.camshaft
    weight = None if shaft is None else shaft.counterweight
    if weight is None or designs.machine.cam.counter_hole is not None:
        return None
    product = np.asarray(weight.against(*designs.unbalance)[0])
    body = counterweight_body(weight, product, designs.numbers | with_swing(designs.cams))
    return weight, product, body


def _of_each(value: Value, designs: Designs) -> Array:
    """Values (m,) of a figure (m, 1), or of one that all designs share."""
    return np.asarray(np.broadcast_to(value, (designs.count, 1)), dtype=float)[:, 0]


def _counterweight_gap(designs: Designs) -> Judged | None:
    """Gap between counterweight and its neighbours and its limit (m,), m; None without one."""
    counterweights = _counterweights(designs)
    if counterweights is None:
        return None
    weight, _, body = counterweights
    numbers = designs.numbers | with_swing(designs.cams)
    gap = assembly.counterweight_room(body, weight, numbers)
    limit = designs.numbers.limit(ASSEMBLY_GAP)
    return _of_each(gap, designs), _of_each(limit, designs)


def _counterweight_unbalance(designs: Designs) -> Judged | None:
    """Unbalance to balance and the greatest that fits the counterweight (m,), kg m; None without
    one.
    """
    counterweights = _counterweights(designs)
    if counterweights is None or counterweights[0].width is None:
        return None
    _, product, body = counterweights
    most = np.nan_to_num(body.capacity)
    return _of_each(product, designs), _of_each(most, designs)


def _arm_fatigue(at: ArmPlace) -> Callable[[Designs], Judged | None]:
    """Screening of the fatigue of an arm at a place."""

    def judged(designs: Designs) -> Judged | None:
        """Least fatigue safety factor over the load cases and its limit (m,)."""
        used = np.max([arm_strength.fatigue_use(cam, at) for cam in designs.cams], axis=0)
        limit = designs.numbers.limit(ARM_SAFETY)
        return _of_each(rating_over(1.0, used, np.inf), designs), _of_each(limit, designs)

    return judged


def _friction_power(designs: Designs) -> Judged | None:
    """Greatest friction power over the mean power of the machine, and its limit (m,), -; None where
    no load case has a power.
    """
    shares = [cam.friction_power / cam.state.power for cam in designs.cams
              if cam.state.power is not None]  # fmt: skip
    if not shares:
        return None
    limit = designs.numbers.limit(FRICTION_POWER)
    return _of_each(np.max(np.broadcast_arrays(*shares), axis=0), designs), _of_each(limit, designs)


def _mechanism_temperature(designs: Designs) -> Judged | None:
    """Temperature of the mechanism by its friction power and the least that a part allows (m,),
    degC.

    None where no part states one. NaN where the housing in still air exceeds it and the case states
    no cooling.
    """
    stated, cooling = torque_balance.stated_temperatures(designs.numbers), designs.machine.cooling
    if not stated:
        return None
    across = 2.0 * sampled_greatest(designs.whole.motion.contour_radius)[:, None]
    area = torque_balance.box_area(across, designs.numbers)

    def warm(cam: ScreenedCam) -> Array:
        return np.asarray(celsius(cooling.temperature(cam.friction_power, area)))

    limit = celsius(min(stated.values()))
    demand = _of_each(_over_duty(designs, warm, life=False, steady=True), designs)
    if cooling.conductance is None:
        demand = np.where(demand > limit, np.nan, demand)
    return demand, limit


def _bulk_temperature(designs: Designs) -> Judged | None:
    """Bulk temperature of the flat face, by oil and mean flash temperature, and its limit (m,),
    degC; NaN where thermal data or friction lack.
    """
    machine, limit = designs.machine, designs.numbers.limit(SURFACE_TEMPERATURE)
    allowed = _of_each(flat_face_sliding.bulk_allowed(machine, limit), designs)
    cold = designs.numbers.get("lubricant.temperature")
    if flat_face_sliding.heat_missing(machine, "temperature") or cold is None:
        return np.full(designs.count, np.nan), allowed
    rises = [bulk_rise(cam.flash) for cam in designs.cams if cam.flash is not None]
    return np.asarray(celsius(cold + np.max(rises, axis=0))), allowed


def _contact_temperature(designs: Designs) -> Judged | None:
    """Contact temperature of the flat face and its limit (m,), degC, at the load case and angle of
    the greatest utilisation, as in the check; NaN where data lack.
    """
    oil, machine = designs.machine.lubricant, designs.machine
    if flat_face_sliding.heat_missing(machine, *flat_face_sliding.OF_OIL) or oil is None:
        top = designs.numbers.get("lubricant.scuffing_temperature")
        return np.full(designs.count, np.nan), None if top is None else celsius(float(top))
    cold, top, bare = (
        float(designs.numbers[f"lubricant.{key}"]) for key in flat_face_sliding.OF_OIL
    )
    hottest, allowed = np.full((2, designs.count), np.nan)
    for cam in designs.cams:
        if (flash := cam.flash) is None:
            return np.full(designs.count, np.nan), celsius(top)
        warm = celsius(cold + bulk_rise(flash)[:, None] + flash)
        limits = flat_face_sliding.contact_allowed(cam.film_ratio, bare, top)
        at = np.argmax(np.nan_to_num(warm / limits), axis=-1)[:, None]
        here, there = (np.take_along_axis(each, at, axis=-1)[:, 0] for each in (warm, limits))
        worse = ~(here / there <= hottest / allowed)
        hottest, allowed = np.where(worse, here, hottest), np.where(worse, there, allowed)
    return hottest, allowed


def _of_landings(designs: Designs, row: AnyLimit, measure: Callable[[WallImpact], float]) -> Judged:
    """Greatest figure of the landings of all load cases (m,), 0 without one, and its limit."""
    return _worst_landing(designs, measure), designs.limit(row)


def _worst_landing(designs: Designs, measure: Callable[[WallImpact], float]) -> Array:
    every = [[measure(one) for one in flown] or [0.0] for flown in designs.flights]
    return np.array([np.max(values) for values in every])


def _crossover_slip(designs: Designs) -> Judged:
    """Greatest slip of the roller that carries over the load cases and its limit (m,), m/s."""
    slips = np.max([cam.roller_slip for cam in designs.cams], axis=0)
    return slips, designs.limit(CROSSOVER_SLIP)


def _landing_pressure(designs: Designs) -> Judged | None:
    """Greatest contact pressure at a landing and the least endurance pressure over its safety (m,),
    Pa; None where no design lands.
    """
    if not any(designs.flights):
        return None
    return _within_endurance(_worst_landing(designs, lambda one: one.pressure), designs)


def _within_endurance(pressure: Array, designs: Designs) -> Judged:
    """Contact pressure (m,), Pa, and its limit, that of the check `contact_pressure`."""
    limit = contact_strength.endurance_allowed(designs.numbers)
    return pressure, limit.against_each(pressure[:, None])[:, 0]


def _preload_least(designs: Designs) -> Judged | None:
    """Least force on either disc over the preload, with the narrowest interference, and its limit
    (m,); None without an interference.
    """
    squeeze = designs.squeeze
    if squeeze is None:
        return None
    interference = designs.value("cam.conjugate.interference")
    narrower = designs.value("cam.profile_tolerance") / interference
    left = [np.minimum(*squeeze.forces(cam.axial)) / squeeze.preload for cam in designs.cams]
    least = np.min(left, axis=(0, 2)) - narrower[:, 0]
    return least, designs.limit(CONTACT_FORCE_MARGIN)


def _preload_pressure(designs: Designs) -> Judged | None:
    """Greatest pressure of Hertz on either disc at the greatest preload, and its limit (m,), Pa;
    None without an interference.
    """
    squeeze = designs.squeezed(designs.value("cam.profile_tolerance"))
    if squeeze is None:
        return None
    tracks = designs.both_tracks(designs.motion)
    numbers, every = designs.numbers, []
    for cam in designs.cams:
        for force, track in zip(squeeze.forces(cam.axial), tracks, strict=True):
            load = force * track.gain / numbers["contact.width"]
            curved = 1.0 / designs.relative_radius_of(track)
            every.append(peak_pressure_square(load, curved, numbers["contact.modulus"]))
    return _within_endurance(np.sqrt(np.max(every, axis=(0, 2))), designs)


def _yoke_breadth(designs: Designs) -> Judged | None:
    """Change of the breadth with the profile tolerance over the clearance of a yoke (m,), and its
    limit; None without one.
    """
    if designs.case.cam.yoke is None:
        return None
    height = designs.whole.motion.height
    breadth = height + np.roll(height, height.shape[-1] // 2, axis=-1)
    change = np.ptp(breadth, axis=-1)[:, None] + designs.value("cam.profile_tolerance")
    return _of_each(change / designs.value("cam.yoke.clearance"), designs), 1.0


def _gas_stroke_rate(designs: Designs) -> Judged | None:
    rate = _strokes(designs) * designs.numbers["cam.fastest"] / FULL_TURN
    limit = gas_spring.gas_of(designs.case).stroke_rate_limit
    return _of_each(rate, designs), limit


def _gas_heating(designs: Designs) -> Judged | None:
    """Gas temperature of a gas spring (m,), degC, over the load cases by their duty, and its limit,
    degC.
    """
    case, strokes, lift = designs.case, _strokes(designs), designs.highest[:, None]
    preload, rate = (designs.value(f"spring.{key}") for key in ("preload", "rate"))
    work = spring_energy(preload, rate, lift, designs.numbers.spring_shape)

    def warm(cam: ScreenedCam) -> Array:
        rate = strokes * cam.speed / FULL_TURN
        return np.asarray(gas_spring.gas_warmth(case, work, rate))

    demand = _over_duty(designs, warm, life=False, steady=True)
    return _of_each(demand, designs), float(celsius(gas_spring.gas_of(case).warm))


def _strokes(designs: Designs) -> Array:
    """Rises of the lift in a turn (m, 1)."""
    return np.array([[gas_spring.strokes_of(slope)] for slope in designs.jets[1]])


_ARRAYS: Mapping[str, tuple[Callable[[Designs], Judged | None], float]] = {
    TORQUE_REDUCTION.id: (_torque_reduction, 0.001),
    torque_balance.friction_power.id: (_friction_power, 0.005),
    torque_balance.mechanism_temperature.id: (_mechanism_temperature, 0.005),
    roller_bearing.grease_life.id: (partial(_grease_life, at=FIRST_ROLLER), 0.001),
    roller_bearing.second_roller_grease.id: (partial(_grease_life, at=SECOND_ROLLER), 0.001),
    assembly.counterweight_gap.id: (_counterweight_gap, 0.001),
    assembly.counterweight_unbalance.id: (_counterweight_unbalance, 0.001),
    flat_face_sliding.bulk_temperature.id: (_bulk_temperature, 0.005),
    flat_face_sliding.contact_temperature.id: (_contact_temperature, 0.02),
    gas_spring.gas_stroke_rate.id: (_gas_stroke_rate, 1e-9),
    gas_spring.gas_heating.id: (_gas_heating, 1e-4),
    LANDING_SPEED.id: (
        lambda designs: _of_landings(designs, LANDING_SPEED, lambda one: one.flight.speed),
        1e-4,
    ),
    CROSSOVER_SLIP.id: (_crossover_slip, 1e-4),
    form_closure.landing_pressure.id: (_landing_pressure, 1e-4),
    guide_strength.pivot_edge_pressure.id: (screened_pivot.edge_pressure, 0.1),
    form_closure.preload_least.id: (_preload_least, 1e-3),
    form_closure.preload_pressure.id: (_preload_pressure, 1e-3),
    form_closure.yoke_breadth.id: (_yoke_breadth, 1e-3),
}
"""Screening of checks without a measure, by id, with its deviation; see `Screened`."""


_WITHOUT_REVERSALS = (
    torque_balance.friction_power.id,
    torque_balance.mechanism_temperature.id,
)
"""Checks whose demand lacks the slip of rollers that a cam that pulls turns the other way."""


def _pulled(designs: Designs) -> bool:
    return designs.case.cam.pulls


def _screened(declared: Declaration) -> Screened | None:
    """Screening of a check; None where there is none."""
    if declared.id in _ARRAYS:
        is_bound = _pulled if declared.id in _WITHOUT_REVERSALS else never
        if declared.id == guide_strength.pivot_edge_pressure.id:
            is_bound = has_many_shapes
        return Screened(declared.id, *_ARRAYS[declared.id], is_bound=is_bound)
    if declared.id in arm_strength.JUDGED:
        judged = _arm_fatigue(arm_strength.JUDGED[declared.id])
        return Screened(declared.id, judged, 0.005, is_bound=has_many_shapes)
    how, measure = declared.measured, declared.measure
    return None if how is None or measure is None else _by_measure(declared, measure, how)


SCREENED = tuple(made for each in CHECKS if (made := _screened(each)) is not None)
"""Checks that screening judges, in the order of the calculation."""
