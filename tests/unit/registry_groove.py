"""How the checks of a groove are tried: a harmonic lift in it, without a spring."""

from dataclasses import replace
from functools import cache

import hand_calculations as by_hand
import made_trial as made
import numpy as np
from check_tools import by_limit, check, limited, tried
from held_cams import turned_by_friction
from trial_variants import NAN
from trial_variants import unknown as unknown_cam

from camwright.geometry.arrays import FULL_TURN, uniform_turn
from camwright.geometry.form_closure import Groove
from camwright.pipeline.cycle.solution import Solution

CLEARANCE, OUTER = 20e-6, 0.090
HALF = 0.5 * made.STROKE
WIDTHS = 0.010, 0.010  # of disc and roller, m


def changed(**values) -> Solution:
    """The groove with other values of its table."""
    base = made.in_groove()
    cam = replace(base.case.cam, groove=replace(base.case.cam.groove, **values))
    return made.changed_solution(base, case=made.changed(base.case, cam=cam))


def beside(diameter: float | None, outer: float = 0.060) -> Solution:
    """A disc of an outer radius, m, with a machine shaft 75 mm from the camshaft."""
    base = changed(outer_radius=outer)
    gear = made.changed(made.case().camshaft.gear, machine_shaft_diameter=diameter)
    shaft = made.changed(made.case().camshaft, gear=gear, gear_radius=0.05)
    return made.changed_solution(base, case=made.changed(base.case, camshaft=shaft))


def spaced(spacing: float) -> Solution:
    """The pair of discs at another distance along the shaft, m."""
    base = made.on_two_discs()
    second = replace(base.case.cam.conjugate, spacing=spacing)
    cam = replace(base.case.cam, conjugate=second)
    return made.changed_solution(base, case=made.changed(base.case, cam=cam))


def with_limits(**values) -> Solution:
    base = made.in_groove()
    limits = made.changed(base.case.limits, **values)
    return made.changed_solution(base, case=made.changed(base.case, limits=limits))


def worn(depth: float) -> Solution:
    """The groove with walls worn by a depth, m, and a limit of their clearance."""
    base = changed(wear_depth=depth)
    limits = made.changed(base.case.limits, worn_clearance=1.0)
    return made.changed_solution(base, case=made.changed(base.case, limits=limits))


def flown() -> Solution:
    """With limits of what a case leaves open."""
    return with_limits(landing_speed=1.0, crossover_slip=100.0)


def with_loads(**values) -> Solution:
    base = made.in_groove()
    (cycle,) = base.cycles
    loads = replace(cycle.loads, **values)
    return replace(base, cycles=(made.changed_cycle(cycle, loads=loads),))


def without_flight() -> Solution:
    """Landings of which nothing is known."""
    base = flown()
    (cycle,) = base.cycles
    lost = tuple(
        one._replace(flight=one.flight._replace(speed=np.nan), force=np.nan, pressure=np.nan)
        for one in cycle.impacts
    )
    bare = made.changed_cycle(cycle)
    bare.results["impacts"] = lost
    assert cycle.flights is not None
    unknown_flights = tuple(one._replace(landing=np.nan) for one in cycle.flights.landings)
    bare.results["flights"] = cycle.flights._replace(landings=unknown_flights)
    return replace(base, cycles=(bare,))


def struck(share: float = 1e-3, limit: float | None = None) -> Solution:
    """The groove with the landing on its inner wall faster by a share than the flight before it."""
    base = made.in_groove() if limit is None else with_limits(friction_balance=limit)
    (cycle,) = base.cycles
    assert cycle.flights is not None
    wrong = tuple(
        one._replace(speed=(1.0 + share) * one.speed) if one.wall > 0.0 else one
        for one in cycle.flights.landings
    )
    bare = made.changed_cycle(cycle)
    bare.results["flights"] = cycle.flights._replace(landings=wrong)
    return replace(base, cycles=(bare,))


def weak(**values) -> Solution:
    """The groove in steel of other strengths, Pa; None: not stated."""
    base = made.in_groove()
    card = replace(base.case.materials["steel"], **values)
    return made.changed_solution(base, case=made.with_card(base.case, card))


def yoked(**values) -> Solution:
    """The yoke with other values of its table."""
    base = made.in_yoke()
    cam = replace(base.case.cam, yoke=replace(base.case.cam.yoke, **values))
    return made.changed_solution(base, case=made.changed(base.case, cam=cam))


def weak_pair(**values) -> Solution:
    base = made.preloaded()
    card = replace(base.case.materials["steel"], **values)
    return made.changed_solution(base, case=made.with_card(base.case, card))


def unpressed() -> Solution:
    """Axial forces that are not known."""
    base = made.preloaded()
    (cycle,) = base.cycles
    loads = replace(cycle.loads, axial_force=NAN)
    return replace(base, cycles=(made.changed_cycle(cycle, loads=loads),))


def pressed(more: float) -> tuple[float, float]:
    """Least share of the preload and greatest pressure, MPa, with `more` interference, m."""
    least, pressures = on_both(more)
    return least, float(pressures.max())


def on_both(more: float) -> tuple[float, np.ndarray]:
    """Least share of the preload, and pressure, MPa, of both discs (2, n), with `more`
    interference, m.

    Both rollers on springs of 20 kN/mm, arms of 60 mm under the inertia of 175 g.
    """
    base = made.preloaded()
    machine, first = base.machine, base.contour
    theta, path = made.THETA, first.pitch
    disc = machine.cam.conjugate.roller.of(path).contour
    axial = 0.175 * machine.cam_speed**2 * HALF * np.cos(theta)
    tilt = [np.cos(each.pressure_angle(theta)) for each in (path, disc.pitch)]
    preload = (20e-6 + more) / tilt[1] * 20e6 / 2.0
    forces = preload + 0.5 * axial, preload - 0.5 * axial
    least = (np.minimum(*forces) / preload).min() - 4.0 / 20.0
    flat = [1.0 / made.ROLLER + 1.0 / each.radius_of_curvature(theta) for each in (first, disc)]
    squares = [
        force / cosine / machine.contact_width * curved * machine.contact_modulus / np.pi
        for force, cosine, curved in zip(forces, tilt, flat, strict=True)
    ]
    return float(least), 1e-6 * np.sqrt(squares)


def waves() -> float:
    """Greatest change of the force on a preloaded disc by waves over the force left: a mass on two
    equal springs over sines of 2 um by 5 mm, 4 um of the 20 um of interference lost.
    """
    base = made.preloaded()
    machine, first, theta, step = base.machine, base.contour, made.THETA, 1e-5
    disc = machine.cam.conjugate.roller.of(first.pitch).contour
    axial = 0.175 * machine.cam_speed**2 * HALF * np.cos(theta)
    tilt = [np.cos(each.pressure_angle(theta)) for each in (first.pitch, disc.pitch)]
    inertia = 0.0
    for contour, cosine in zip((first, disc), tilt, strict=True):
        along = contour.points(theta + step) - contour.points(theta - step)
        rate = FULL_TURN * machine.cam_speed * np.hypot(*along) / (2.0 * step) / 5e-3
        tuned = rate / np.sqrt(2.0 * 20e6 / 0.175)
        swing = np.abs(1.0 - tuned**2 + 2j * machine.damping_ratio * tuned)
        inertia = inertia + 0.5 * 0.175 * 2e-6 / cosine * rate**2 / swing
    preload = 20e-6 / tilt[1] * 20e6 / 2.0
    left = np.minimum(preload + 0.5 * axial, preload - 0.5 * axial) - preload * 4.0 / 20.0
    return float((0.5 * inertia / left).max())


# --- by hand: s = h/2 (1 - cos theta), inertia alone ------------------------------------------
def gap(theta: float) -> float:
    """Clearance along the travel, m."""
    slope, height = HALF * np.sin(theta), made.BASE + HALF * (1.0 - np.cos(theta))
    return CLEARANCE * float(np.hypot(slope, height)) / height


@cache
def landing(*, outer: bool) -> tuple[float, float, float]:
    """Angle, rad, of the landing on a wall, its speed, m/s, and the path there, m/rad.

    The acceleration is zero at 90 and 270 deg. From the inner wall the roller flies straight on,
    u = h/2 (t - sin t), up to the clearance; from the outer one with the speed of that wall.
    """
    start, flown = (0.25 if outer else 0.75) * FULL_TURN, 0.3
    rate = 0.0 if outer else (gap(start + 1e-6) - gap(start - 1e-6)) / 2e-6
    for _ in range(100):
        wide = gap(start + flown) if outer else gap(start)
        flown -= (HALF * (flown - np.sin(flown)) - wide - rate * flown) / (
            HALF * (1.0 - np.cos(flown))
        )
    theta, speed = start + flown, made.in_groove().machine.cam_speed
    opening = (gap(theta + 1e-6) - gap(theta - 1e-6)) / 2e-6 if outer else rate
    slope, height = HALF * np.sin(theta), made.BASE + HALF * (1.0 - np.cos(theta))
    against = speed * (HALF * (1.0 - np.cos(flown)) - opening)
    return theta, float(against), float(np.hypot(slope, height))


def landing_pressure() -> float:
    """Pressure of Hertz on the inner wall, MPa, of the mass stopped on the follower's stiffness."""
    machine, (theta, speed, path) = made.in_groove().machine, landing(outer=False)
    height = made.BASE + HALF * (1.0 - np.cos(theta))
    pressed = machine.mass * machine.cam_speed**2 * HALF * np.cos(theta)
    struck = machine.axial_stiffness * machine.mass * speed**2
    force = (pressed + np.sqrt(pressed**2 + struck)) * path / height
    along, bend = HALF * np.sin(theta), HALF * np.cos(theta)
    curvature = (2.0 * along**2 + height**2 - height * bend) / path**3
    radius = made.ROLLER * (1.0 - made.ROLLER * curvature)
    modulus, width = machine.contact_modulus, machine.contact_width
    return 1e-6 * float(np.sqrt(force * modulus / (np.pi * width * radius)))


def slip_temperature() -> float:
    """Oil, bulk and flash, degC, of the friction and slip as solved.

    The contact runs along the walls by their points.
    """
    solution = made.in_groove()
    (cycle,) = solution.cycles
    machine, driven, theta = cycle.machine, cycle.rolling.contact, cycle.theta
    walls, step = Groove(solution.contour.pitch, made.ROLLER), 1e-5
    paces = {
        side: np.hypot(*(walls.points(theta + step, side) - walls.points(theta - step, side)))
        for side in ("inner", "outer")
    }
    pulled = cycle.loads.wall < 0.0
    along = machine.cam_speed * np.where(pulled, paces["outer"], paces["inner"]) / (2.0 * step)
    # on the outer wall rolling is spinning the other way; the slip counts in the inner sense
    backwards = along - np.where(pulled, -driven.slip, driven.slip)
    kept = [
        np.sqrt(card.conductivity * card.density * card.specific_heat)
        for card in (machine.cam.material, machine.roller.material)
    ]
    heat = np.abs(driven.force * driven.slip) / machine.contact_width
    carried = kept[0] * np.sqrt(along) + kept[1] * np.sqrt(np.abs(backwards))
    flash = 1.11 * heat / (carried * np.sqrt(2.0 * cycle.contact.half_width))
    cold = machine.lubricant.temperature - 273.15
    return float(cold + 0.47 * 1.2 * flash.mean() + flash.max())


def without_slip() -> Solution:
    """A roller of which the spin is not known."""
    base = flown()
    (cycle,) = base.cycles
    bare = made.changed_cycle(cycle)
    contact = replace(cycle.rolling.contact, slip=NAN)
    bare.results["rolling"] = replace(cycle.rolling, contact=contact)
    return replace(base, cycles=(bare,))


def crossover_slip() -> float:
    """Greatest slip, m/s, of a roller that the friction of both walls turns, angle by angle."""
    solution = made.in_groove()
    (cycle,) = solution.cycles
    machine, theta = cycle.machine, made.THETA
    pace = machine.cam_speed * np.hypot(
        HALF * np.sin(theta), made.BASE + HALF * (1.0 - np.cos(theta))
    )
    target = np.where(cycle.loads.axial_force < 0.0, -pace, pace)
    limit = machine.roller.friction * cycle.loads.normal_force
    mass = machine.roller.rotor_inertia / made.ROLLER**2
    step = FULL_TURN / theta.size / machine.cam_speed
    return float(np.abs(target - turned_by_friction(target, limit, mass, step)).max())


def oiled(**values) -> Solution:
    base = made.in_groove()
    oil = replace(base.case.lubricant, **values)
    return made.changed_solution(base, case=made.changed(base.case, lubricant=oil))


def struck_share(share: float = 1e-3) -> float:
    """Impulse beyond that of the flight at the velocity of the wall, less the energy beyond it,
    over the greatest kinetic energy of the follower twice.
    """
    theta, speed, _ = landing(outer=False)
    swing = made.in_groove().machine.cam_speed * HALF
    left = share * speed * (swing * np.sin(theta) - (1.0 + 0.5 * share) * speed)
    return float(abs(left)) / swing**2


def wall_stress() -> float:
    """Six times 0.509 of the normal force over the square of the rim, MPa, at the worst angle.

    Force and friction of the guides as solved, the rim by points of the outer wall.
    """
    solution = made.in_groove()
    loads = solution.cycles[0].loads
    pulled = loads.axial_force < 0.0
    walls = Groove(solution.contour.pitch, made.ROLLER)
    thick = OUTER - np.hypot(*walls.points(loads.theta, "outer"))
    return 1e-6 * float(np.max(np.where(pulled, 6.0 * 0.509 * loads.normal_force / thick**2, 0.0)))


def pinched() -> Solution:
    """Five lobes whose hollows are sharper than the roller: the outer wall closes in on it."""
    return replace(made.in_groove(), contour=made.undercut())


def pinched_depth() -> float:
    """Depth, mm, of the roller in the outer wall by the distances of 3600 points."""
    contour = made.undercut().require_roller()
    theta, half = uniform_turn(3600), contour.roller_radius + 0.5 * CLEARANCE
    wall = contour.pitch.points(theta) + half * contour.pitch.normal(theta)
    centres = contour.pitch.points(theta[:720])  # of one lobe
    away = np.hypot(*(wall[:, :, None] - centres[:, None, :]))
    return 1e3 * (half - float(away.min()))


def unknown() -> Solution:
    return replace(made.in_groove(), contour=unknown_cam().contour)


def stepped(**values) -> Solution:
    """The groove of two steps with other loads."""
    base = made.in_steps()
    (cycle,) = base.cycles
    loads = replace(cycle.loads, **values)
    return replace(base, cycles=(made.changed_cycle(cycle, loads=loads),))


def own_bearing(**values) -> Solution:
    """The groove of two steps with another bearing of its second roller."""
    base = made.in_steps()
    groove = base.case.cam.groove
    bearing = replace(groove.second.bearing, **values)
    second = replace(groove.second, bearing=bearing)
    cam = replace(base.case.cam, groove=replace(groove, second=second))
    return made.changed_solution(base, case=made.changed(base.case, cam=cam))


def in_use(**values) -> Solution:
    """The groove of two steps with another use of the first bearing, which the second shares."""
    base = made.in_steps()
    roller = base.case.roller
    other = replace(roller, bearing=replace(roller.bearing, **values))
    return made.changed_solution(base, case=made.changed(base.case, roller_given=other))


def own_ring(**values) -> Solution:
    """The groove of two steps with another outer ring of its second roller."""
    ring = made.in_steps().case.cam.groove.second.bearing.ring
    return own_bearing(ring=replace(ring, **values))


def ring_of_second(force: float) -> float:
    """Goodman, MPa, 2000 MPa: the stress of a ring of 14 mm per newton is solved."""
    case = made.stepped_case()
    own = case.cam.groove.second.bearing
    solved = replace(case.roller, radius=0.007, bearing=own).ring(0.01, made.PRELOAD)
    amplitude, mean = solved.bending.stress_amplitude, solved.bending.stress_mean
    return float(1e-6 * amplitude * force / (1.0 - mean * force / 2000e6))


def film_of_second() -> float:
    """22 mm2/s over v1 of ISO 281, 9.2 mm, at the mean speed on the outer wall all the turn."""
    rpm = turned_on_outer_wall().mean() * 30.0 / np.pi
    factor, power = (45000.0, -0.83) if rpm < 1000.0 else (4500.0, -0.5)
    return 22.0 * np.sqrt(9.2) / (factor * rpm**power)


def turned_on_outer_wall() -> np.ndarray:
    """Speed of the second roller on its wall at each angle, rad/s."""
    (cycle,) = made.in_steps().cycles
    pace = np.hypot(*cycle.contour.pitch.velocity(cycle.theta))
    return cycle.cam_speed * (pace / 0.007 + 1.0)


def modified_life_of_second() -> float:
    """Damage of each position on the outer wall by its own a_ISO, e_C = 0.5, P_u = 70 N; h."""
    (cycle,) = made.in_steps().cycles
    kappa, damage = film_of_second(), 0.0
    factors = (2.5671, 2.2649, 0.054381) if kappa < 0.4 else (2.5671, 1.9987, 0.19087)
    if kappa >= 1.0:
        factors = 2.5671, 1.9987, 0.071739
    for force, speed, wall in zip(cycle.loads.normal_force, turned_on_outer_wall(),
                                  cycle.loads.wall, strict=True):  # fmt: skip
        if wall > 0.0:
            continue
        clean = (0.5 * 70.0 / max(force, 1.0)) ** (1.0 / 3.0)
        left = 1.0 - (factors[0] - factors[1] / kappa ** factors[2]) ** 0.83 * clean
        most = 0.1 / left**9.3 if left > 0.0 else 50.0
        turns = 1e6 * min(most, 50.0) * (3e3 / max(force, 1.0)) ** 3
        damage += speed / FULL_TURN / turns / cycle.theta.size
    return 1.0 / damage / 3600.0


def in_steps_with_limits(**values) -> Solution:
    base = made.in_steps()
    limits = made.changed(base.case.limits, **values)
    return made.changed_solution(base, case=made.changed(base.case, limits=limits))


def with_speed_in_steps(speed: float) -> Solution:
    """The groove of two steps at another speed of the crank, rad/s; its figures stay."""
    base = made.in_steps()
    idle = made.load_case("idle", speed=speed)
    return made.changed_solution(base, case=made.changed(base.case, load_cases=(idle,)))


def on_outer_wall() -> tuple[float, float]:
    """Greatest force on the second roller, N, and life, h, of its 3 kN by Miner's rule over the
    equal steps of a turn in which the outer wall carries.
    """
    solution = made.in_steps()
    (cycle,) = solution.cycles
    pulled = cycle.loads.axial_force < 0.0
    force = cycle.loads.normal_force[pulled]
    pace = np.hypot(*solution.contour.pitch.velocity(cycle.theta[pulled]))
    turned = solution.machine.cam_speed * (pace / 0.007 + 1.0)
    rate = np.sum((force / 3e3) ** 3 * turned) / cycle.theta.size / (FULL_TURN * 1e6)
    return float(force.max()), 1.0 / float(rate) / 3600.0


# --- the checks -------------------------------------------------------------------------------
by_limit(
    "outer_undercut",
    "undercut_factor",
    unknown,
    1.0 + made.ROLLER / float(by_hand.PITCH_RADIUS.max()),
    "1 + r kappa at the least curvature of the path",
    base=made.in_groove,
)
SECOND_FORCE, SECOND_LIFE = on_outer_wall()
FASTEST_OUTSIDE = float(
    turned_on_outer_wall()[made.in_steps().cycles[0].loads.wall < 0.0].max() * 30.0 / np.pi
)
by_limit(
    "second_roller_static",
    "roller_static_safety",
    lambda: stepped(normal_force=NAN),
    1.5e3 / SECOND_FORCE,
    "C0 over the greatest force on the outer wall",
    base=made.in_steps,
    missing=lambda: own_bearing(C0=None),
)
by_limit(
    "second_roller_load_share",
    "roller_load_share",
    lambda: stepped(normal_force=NAN),
    SECOND_FORCE / 3e3,
    "greatest force on the outer wall over C",
    base=made.in_steps,
    missing=lambda: own_bearing(C=None),
)
for words in ("radial", "static_radial"):
    tried(
        f"second_roller_{words}",
        limited(
            f"second_roller_{words}",
            lambda limit, key=f"{words}_limit": own_bearing(**{key: limit}),
            made.in_steps,
        ),
        lambda key=f"{words}_limit": own_bearing(**{key: None}),
        lambda: stepped(normal_force=NAN),
        SECOND_FORCE,
        "greatest force on the outer wall",
        made.in_steps,
    )
by_limit(
    "second_roller_life",
    "roller_life",
    lambda: stepped(normal_force=NAN),
    SECOND_LIFE,
    "damage of the positions at which the outer wall carries, ISO 281",
    base=made.in_steps,
    missing=lambda: own_bearing(C=None),
)
by_limit(
    "second_roller_modified_life",
    "roller_life",
    lambda: stepped(normal_force=NAN),
    modified_life_of_second(),
    "ISO 281, 9.3: damage of each position at which the outer wall carries",
    base=made.in_steps,
    missing=lambda: in_use(contamination=None),
)
tried(
    "second_roller_speed",
    limited("second_roller_speed", lambda n: own_bearing(speed_limit=n / 0.7), made.in_steps),
    lambda: own_bearing(speed_limit=None),
    lambda: with_speed_in_steps(np.nan),
    FASTEST_OUTSIDE,
    "w (|P'| + r)/r where the outer wall carries, rpm",
    made.in_steps,
)
by_limit(
    "second_roller_lubrication",
    "viscosity_ratio",
    lambda: with_speed_in_steps(np.nan),
    film_of_second(),
    "kappa of ISO 281 at the mean speed on the outer wall",
    base=made.in_steps,
    missing=lambda: in_use(viscosity=None),
)
tried(
    "second_roller_grease",
    limited(
        "second_roller_grease", lambda life: in_steps_with_limits(target_life=life), made.in_steps
    ),
    lambda: in_use(lubrication=None),
    None,  # the manufacturer's, a constant
    1500.0,
    "as stated",
    made.in_steps,
)
tried(
    "second_roller_ring_fatigue",
    limited("second_roller_ring_fatigue", lambda p: own_ring(fatigue_bending=p), made.in_steps),
    lambda: own_ring(fatigue_bending=None),
    lambda: stepped(normal_force=NAN),
    ring_of_second(SECOND_FORCE),
    "Goodman, the solved stress per newton, Shigley ch. 6",
    made.in_steps,
)
by_limit(
    "outer_second_contact",
    "second_contact_depth",
    None,
    pinched_depth(),
    "least distance of points of the wall from the roller centre",
    base=pinched,
)
tried(
    "groove_wall",
    lambda share: with_limits(
        fatigue_safety=made.in_groove().case.limits.fatigue_safety
        * share
        / check("groove_wall", made.in_groove()).utilisation
    ),
    lambda: weak(tensile_strength=None),
    lambda: with_loads(normal_force=NAN),
    wall_stress(),
    "6 x 0.509 F over the square of the rim, Jaramillo (1950)",
    made.in_groove,
)
tried(
    "groove_clearance",
    lambda share: changed(clearance=4e-6 / share),
    None,
    lambda: changed(clearance=np.nan),
    4.0 / 20.0,
    "tolerance of 4 um in a clearance of 20 um",
    made.in_groove,
)
by_limit(
    "groove_radius",
    "cam_radius",
    lambda: changed(outer_radius=np.nan),
    90.0,
    "as stated",
    base=made.in_groove,
)
by_limit(
    "groove_shaft_gap",
    "assembly_gap",
    lambda: beside(0.02, np.nan),
    5.0,
    "75 mm of centre distance less 60 of the disc and 10 of the shaft",
    base=lambda: beside(0.02),
    missing=lambda: beside(None),
)
by_limit(
    "second_disc_gap",
    "assembly_gap",
    lambda: spaced(np.nan),
    1e3 * (0.030 - 0.5 * (WIDTHS[0] + WIDTHS[1])),
    "discs 30 mm apart, less half of a disc and half of a roller",
    base=made.on_two_discs,
)
by_limit(
    "second_track_gap",
    "assembly_gap",
    lambda: spaced(np.nan),
    15.0,
    "discs 30 mm apart, less half of a disc of 10 mm and of a roller in its fork, 20 mm",
    base=made.on_two_discs,
)
by_limit(
    "preload_least",
    "contact_force_margin",
    unpressed,
    pressed(0.0)[0],
    "share of the axial force of two equal springs, less 4 um of 20 um",
    base=made.preloaded,
)
by_limit(
    "preload_waviness",
    "waviness",
    unpressed,
    waves(),
    "half of the inertia force of a mass on two equal springs over sines, over the force left",
    base=made.preloaded,
)
tried(
    "yoke_breadth",
    lambda share: yoked(clearance=4e-6 / share),
    None,
    lambda: yoked(clearance=np.nan),
    4.0 / 50.0,
    "an eccentric has one breadth: 4 um of profile tolerance over 50 um",
    made.in_yoke,
)
tried(
    "preload_pressure",
    limited("preload_pressure", lambda p: weak_pair(endurance_pressure=p), made.preloaded),
    lambda: weak_pair(endurance_pressure=None, sliding_endurance_pressure=None),
    unpressed,
    pressed(4e-6)[1],
    "Hertz (1882) of both discs, the springs pressed by 24 um",
    made.preloaded,
)
by_limit(
    "worn_clearance",
    "worn_clearance",
    lambda: worn(np.nan),
    1e3 * (CLEARANCE + 2.0 * 10e-6),
    "20 um, and 10 um off either wall",
    base=lambda: worn(10e-6),
)
by_limit(
    "landing_speed",
    "landing_speed",
    without_flight,
    1e3 * landing(outer=False)[1],
    "w h/2 (1 - cos(w t)) after the zero of the acceleration",
    base=flown,
)
tried(
    "landing_pressure",
    limited("landing_pressure", lambda p: weak(endurance_pressure=p), made.in_groove),
    lambda: weak(endurance_pressure=None, sliding_endurance_pressure=None),
    without_flight,
    landing_pressure(),
    "Hertz (1882) of F + sqrt(F^2 + k m v^2)",
    made.in_groove,
)
by_limit(
    "crossover_slip",
    "crossover_slip",
    without_slip,
    crossover_slip(),
    "speed of the roller centre less that of the surface, which friction over its mass turns",
    base=flown,
)
tried(
    "landing_balance",
    limited("landing_balance", lambda limit: struck(limit=limit), struck),
    None,
    without_flight,
    struck_share(),
    "a landing a thousandth too fast: work of its impulse less its energy",
    struck,
)
by_limit(
    "slip_temperature",
    "surface_temperature",
    lambda: oiled(temperature=np.nan),
    slip_temperature(),
    "Blok (1937) with the speeds of the points of the walls",
    base=made.in_groove,
    zero=273.15,
    missing=lambda: oiled(temperature=None),
)
