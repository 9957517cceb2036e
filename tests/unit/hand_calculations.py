"""Demands of the solution of `made_trial`, worked out by hand: closed forms with their sources."""

from functools import cache

import made_trial as made
import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.optimize import minimize_scalar
from scipy.spatial import cKDTree
from scipy.special import gamma

WIRE, COIL, COILS, FREE = 6e-3, 40e-3, 8.2, 0.13
S = 0.5 * made.STROKE * (1.0 - np.cos(made.THETA))
BEND = 0.5 * made.STROKE * np.cos(made.THETA)
SPRING = made.PRELOAD + made.RATE * S
INERTIA = made.MASS * made.CAM_SPEED**2 * BEND
RPM = 30.0 / np.pi
MODULUS = 210e9 / (2.0 * (1.0 - 0.3**2))
TURNS = 3.6e6 * made.CAM_SPEED / (2.0 * np.pi)

RATE = 77.2e9 * WIRE**4 / (8.0 * COIL**3 * COILS)
HARDEST = made.PRELOAD * 1.05 + RATE * 1.05 * made.STROKE
C = COIL / WIRE
WAHL = (4.0 * C - 1.0) / (4.0 * C - 4.0) + 0.615 / C
SHEAR = WAHL * 8.0 * COIL / (np.pi * WIRE**3)  # Pa per N, Wahl
TENSILE = 1974e6 * 6.0**-0.108
ZIMMERLI = 398e6 / (1.0 - 534e6 / (0.67 * TENSILE))
SOLID = FREE - WIRE * (COILS + 2.0)
DEFLECTION = made.PRELOAD * 1.05 / RATE + made.STROKE
COIL_MASS = 7850.0 * 0.25 * np.pi * WIRE**2 * np.pi * COIL * COILS
SURGE = 0.5 * np.sqrt(RATE / COIL_MASS) * 2.0 * np.pi / made.CAM_SPEED
PHI = np.pi / (SURGE * np.sqrt(0.95))  # of the softest spring at the fastest speed
AT_REST = 0.5 * made.STROKE * 1.05 * RATE * (PHI / np.sin(PHI) - 1.0)  # surge at the fixed end
TOP, LEAST = HARDEST + AT_REST, made.PRELOAD * 1.05 - AT_REST
SWING, MIDDLE = (0.5 * SHEAR * (TOP + sign * LEAST) for sign in (-1, 1))
ISOTROPIC = 1.0 / 2.6  # G/E
SLENDER = (1.0 - ISOTROPIC) / (0.5 + ISOTROPIC) * (np.pi * COIL / FREE) ** 2
BUCKLES = FREE * 0.5 / (1.0 - ISOTROPIC) * (1.0 - np.sqrt(1.0 - SLENDER))  # pivoted ends
GAPS = 1.5 * COILS * (0.0015 * COIL**2 / WIRE + 0.1 * WIRE)
DENSE = np.linspace(0.0, np.pi, 20001)
RADIUS = made.BASE + 0.5 * made.STROKE * (1.0 - np.cos(DENSE))
SLOPE, CURVE = 0.5 * made.STROKE * np.sin(DENSE), 0.5 * made.STROKE * np.cos(DENSE)
PITCH_RADIUS = (RADIUS**2 + SLOPE**2) ** 1.5 / (RADIUS**2 + 2.0 * SLOPE**2 - RADIUS * CURVE)
SLOPE_HERE = 0.5 * made.STROKE * np.sin(made.THETA)
DRIVE = (SPRING + INERTIA) * SLOPE_HERE + 20.0 * np.abs(SLOPE_HERE)
FRICTION_SHARE = 2.0 * float(np.sum(DRIVE) / np.sum(np.abs(DRIVE)))
"""Friction work over half of the energy that goes in and out of the cam."""
TORQUE = np.abs(made.cycle().loads.cam_torque)


def fast_contact(cam_speed: float) -> float:
    """Least contact force over the preload on 5 mm (1 - cos) without friction.

    A + |B| cos: B = a (m w^2 - k phi cot phi), phi = pi w/w_1 sqrt(1 - 0.02 i); m without the fifth
    of the spring and its two end coils.
    """
    mass = made.MASS - 0.2 * COIL_MASS * (COILS + 2.0) / COILS
    own = np.pi * np.sqrt(made.RATE / COIL_MASS)
    phi = np.pi * cam_speed / own * np.sqrt(1.0 - 0.02j)
    swing = 0.5 * made.STROKE * (mass * cam_speed**2 - made.RATE * phi / np.tan(phi))
    return float((made.PRELOAD + 0.5 * made.RATE * made.STROKE - np.abs(swing)) / made.PRELOAD)


def roller_spin() -> np.ndarray:
    """Of a roller that rolls on the contour, rad/s: the pitch curve's length less its turning."""
    slope = 0.5 * made.STROKE * np.sin(made.THETA)
    return made.CAM_SPEED * (np.hypot(made.BASE + S, slope) / made.ROLLER - 1.0)


def viscosity_ratio() -> float:
    """22 mm2/s over 4500/sqrt(n D), D = 10.5 mm, above 1000 rpm: ISO 281."""
    speed = RPM * float(roller_spin().mean())
    assert speed > 1000.0
    return 22.0 * np.sqrt(speed * 10.5) / 4500.0


def modified_life() -> float:
    """Damage of each position by its own a_ISO, e_C = 0.5 and P_u = 60 N; kappa above 1; hours."""
    kappa = viscosity_ratio()
    assert 1.0 <= kappa <= 4.0
    damage = 0.0
    for force, speed in zip(surged_force(), roller_spin(), strict=True):
        clean = (0.5 * 60.0 / force) ** (1.0 / 3.0)
        left = 1.0 - (2.5671 - 1.9987 * kappa**-0.071739) ** 0.83 * clean
        turns = 1e6 * min(0.1 / left**9.3, 50.0) * (1140.0 / force) ** 3
        damage += speed / (2.0 * np.pi) / turns / made.POSITIONS
    return 1.0 / damage / 3600.0


def pin_bending(force: float, moment: float) -> float:
    """Pin of 5 mm held 16 mm apart, N and N mm linear over 10 mm of bearing, by summation, MPa."""
    count = 40_000
    x = (np.arange(count) + 0.5) / count * 16.0 - 8.0
    load = np.where(np.abs(x) < 5.0, force / 10.0 + 12.0 * moment * x / 1000.0, 0.0) * 16.0 / count
    shear = 0.5 * force - moment / 16.0 - np.cumsum(load)
    return float(32.0 / (np.pi * 125.0) * np.max(np.cumsum(shear)) * 16.0 / count)


def pin_fatigue() -> float:
    """Each fibre of the pin by itself under 300 + 100 sin along and 100 sin across: Goodman.

    The stress is that of the greatest force and a moment of 1 N m, per newton of the force.
    """
    force = 300.0 + 100.0 * made.WAVE
    bend = np.array([pin_bending(each, 1000.0) for each in force]) / force  # MPa/N
    least = np.inf
    for fibre in np.arange(0.0, 360.0, 0.5):
        along, across = np.cos(np.radians(fibre)), np.sin(np.radians(fibre))
        stress = bend * ((300.0 + 100.0 * made.WAVE) * along + 100.0 * made.WAVE * across)
        amplitude, mean = 0.5 * np.ptp(stress), 0.5 * (stress.max() + stress.min())
        least = min(least, 700.0 * (1.0 - max(mean, 0.0) / 2000.0) / amplitude)
    return float(least)


def traction() -> float:
    """Inertia of the solid ring 8/4 mm over 300 + 100 sin N: its centre runs at |P'| w."""
    slope, high = 0.5 * made.STROKE * np.sin(made.THETA), made.BASE + S
    length = np.hypot(slope, high)
    rate = made.CAM_SPEED**2 * (slope * BEND + high * slope) / length / made.ROLLER
    inertia = 0.5 * 7850.0 * np.pi * (0.008**4 - 0.004**4) * 0.01
    return float(np.max(np.abs(inertia * rate / made.ROLLER) / (300.0 + 100.0 * made.WAVE)))


def sliding() -> float:
    """Mean pressure, pi/4 of 800 + 100 sin MPa, times w (r + s) of a face, MPa m/s."""
    speed = made.CAM_SPEED * (made.BASE + S)
    return float(np.max(0.25 * np.pi * (800.0 + 100.0 * made.WAVE) * speed))


def self_locking() -> float:
    """Friction 0.1 times 8 mm over the distance of the contact from the pivot.

    The contact is where two lines of the face cross, 2e-4 rad of the cam apart.
    """
    theta, step = np.linspace(0.0, 2.0 * np.pi, 3601), 1e-4
    lines = []
    for at in (theta - step, theta + step):
        lift = 0.5 * made.STROKE * (1.0 - np.cos(at))
        arm = np.arcsin((made.BASE + 0.008) / 0.09) + lift / 0.08
        normal = at + 0.5 * np.pi - arm
        lines.append((np.cos(normal), np.sin(normal), 0.09 * np.sin(arm) - 0.008))
    (a, b, e), (c, d, f) = lines
    x, y = (e * d - b * f) / (a * d - b * c), (a * f - e * c) / (a * d - b * c)
    away = np.hypot(x - 0.09 * np.cos(theta), y - 0.09 * np.sin(theta))
    return float(np.max(0.1 * 0.008 / np.sqrt(away**2 - 0.008**2)))


def bulk_temperature() -> float:
    """Oil at 80 degC and 0.47 1.2 of the mean flash temperature, degC."""
    return float(80.0 + 0.47 * 1.2 * flash_temperature().mean())


def contact_temperature() -> float:
    """Bulk and greatest flash temperature, degC."""
    return bulk_temperature() + float(flash_temperature().max())


def flash_temperature() -> np.ndarray:
    """Blok's band source on steel, K."""
    heat = 0.1 * (300.0 + 100.0 * made.WAVE) / 0.01 * made.CAM_SPEED * (made.BASE + S)
    cam, face = made.CAM_SPEED * (made.BASE + S + BEND), made.CAM_SPEED * np.abs(BEND)
    taken = np.sqrt(45.0 * 7850.0 * 460.0 * cam) + np.sqrt(42.0 * 7850.0 * 470.0 * face)
    return 1.11 * heat / taken / np.sqrt(2.0 * 1e-4)


def gas_friction() -> float:
    """W: 5 % of the force on a column of 50 mm over 10 mm to and fro, p V^1.3 constant."""
    absolute = (3e6 + 101325.0) * 320.0 / 293.15
    work = 5e-6 * absolute * (0.8**-0.3 - 1.0) / 0.3 - 101325.0 * 1e-6
    return float(2.0 * 0.05 * work * made.CAM_SPEED / (2.0 * np.pi))


def ring_amplitude(force: float) -> float:
    """Goodman, MPa: the stress of the outer ring per newton is solved; its strength is 2000 MPa."""
    roller = made.case().roller
    assert roller is not None
    solved = roller.ring(0.01, made.PRELOAD)
    assert solved is not None
    amplitude = solved.bending.stress_amplitude * force
    return float(1e-6 * amplitude / (1.0 - solved.bending.stress_mean * force / 2000e6))


def moving_mass() -> float:
    """Roller about its pin, pin, cheeks and bridge, stem, a fifth of the spring, g."""
    steel, stem = 7.85e-3, 140.0 - 12.0 - 5.0  # g/mm3; mm beyond the fork
    roller = 10.0 * np.pi * (8.0**2 - 2.5**2)
    pin = (16.0 + 4.0) * np.pi * 2.5**2
    fork = 2.0 * 4.0 * 10.0 * 12.0 + 20.0 * 10.0 * 5.0
    wire = np.pi * 3.0**2 * np.pi * 40.0 * (8.2 + 2.0)
    return float(steel * (roller + pin + fork + stem * np.pi * 5.0**2 + 0.2 * wire))


def arm_stresses(section: str) -> tuple[np.ndarray, np.ndarray]:
    """Normal (4, n) and shear (n,) stress of an arm of 80 mm under 300 + 100 sin N and 1 N m, MPa.

    A section as a free body up to its end: roller, pin and fork there, the rest a uniform bar in
    20 000 pieces, the spring 40 mm from the pivot. Torsion by the table of Timoshenko.
    """
    length, count = 80.0, 20_000
    at = {"bore": 0.0, "hub": 15.0, "cheeks": 68.0, "eye": 80.0}[section]  # mm
    steel = 7.85e-6  # kg/mm3
    end = steel * 10.0 * np.pi * (8.0**2 - 2.5**2) + steel * 20.0 * np.pi * 2.5**2
    end += steel * (2.0 * 4.0 * 10.0 * 12.0 + 20.0 * 10.0 * 5.0)
    pieces = (np.arange(count) + 0.5) / count * length
    bar = 3.0 * (made.MASS - end) / count  # kg, each: a third of it counts at the end
    outside = np.maximum(pieces - at, 0.0)
    swung = end * (length - at) + np.sum(bar * pieces / length * outside)  # kg mm
    force, lifted = 300.0 + 100.0 * made.WAVE, made.CAM_SPEED**2 * BEND
    moment = force * (length - at) - lifted * swung
    moment = moment - SPRING * length / 40.0 * max(40.0 - at, 0.0)
    tangent = 0.5 * made.STROKE * np.sin(made.THETA) / (made.BASE + S)
    along, twist, aside = -force * tangent, 1000.0 + 0.0 * force, -1000.0 * tangent
    if section in ("cheeks", "eye"):  # the greater part of two, which carry the couple over 16 mm
        loaded = 2.0 * (0.5 * force + 1000.0 / 16.0) / force
        moment, along, twist, aside = moment * loaded, along * loaded, 0.0 * twist, 0.0 * aside
    if section == "eye":
        moment, along = 0.0 * moment, force * 2.0 * (0.5 + 1000.0 / 16.0 / force)
    bending, area, sideways, torsion, notch = {
        "bore": (20.0 * (30.0**3 - 10.0**3) / 180.0, 400.0, 400.0 * 20.0 / 6.0,
                 2.0 * 0.245894 * 20.0 * 10.0**2, 2.0),
        "hub": (20.0**3 / 6.0, 400.0, 20.0**3 / 6.0, 0.208174 * 20.0**3, 2.0),
        "cheeks": (8.0 * 100.0 / 6.0, 80.0, 1.0, 1.0, 3.0),
        "eye": (1.0, 8.0 * 5.0, 1.0, 1.0, 3.0),
    }[section]  # fmt: skip
    normal = np.array([
        notch * (along / area + one * moment / bending + other * aside / sideways)
        for one in (1.0, -1.0) for other in (1.0, -1.0)
    ])  # fmt: skip
    return normal, notch * twist / torsion


def arm_safety(*sections: str) -> float:
    """Least Goodman safety of steel of 2000 and 700 MPa, machined, at 99 %, Shigley sec. 6-9."""
    least = np.inf
    for section in sections:
        area = {"bore": 400.0, "hub": 400.0, "cheeks": 80.0, "eye": 40.0}[section]
        endurance = 700.0 * 4.51 * 2000.0**-0.265 * (1.0 - 0.08 * 2.326348)
        endurance *= min((0.808 * np.sqrt(area) / 7.62) ** -0.107, 1.0)
        normal, shear = arm_stresses(section)
        for corner in normal:
            swing = np.hypot(0.5 * np.ptp(corner), 3.0**0.5 * 0.5 * np.ptp(shear))
            mean = np.hypot(
                0.5 * (corner.max() + corner.min()), 3.0**0.5 * 0.5 * (shear.max() + shear.min())
            )
            least = min(least, 1.0 / (swing / endurance + mean / 2000.0))
    return float(least)


def arm_stress() -> float:
    """Greatest von Mises stress of the arm, MPa."""
    each = (arm_stresses(section) for section in ("bore", "hub", "cheeks", "eye"))
    return float(max(np.max(np.sqrt(normal**2 + 3.0 * shear**2)) for normal, shear in each))


def second_arm_stresses() -> np.ndarray:
    """Stress of a second arm of 40 mm that moves 20 kg, twice that at 15 mm, MPa; its own mass in
    20 000 pieces.
    """
    lifted = made.CAM_SPEED**2 * BEND  # m/s2
    pieces = 15.0 + 25.0 * (np.arange(20_000) + 0.5) / 20_000
    own = 7.85e-6 * 60.0 * 25.0 / 20_000 * np.sum(pieces * (pieces - 15.0)) / 80.0
    moment = (20.0 * 0.5 * 25.0 + own) * lifted  # N mm
    return 2.0 * moment / (6.0 * 10.0**2 / 6.0)


def second_arm_safety() -> float:
    """Its Goodman safety, of steel of 2000 and 700 MPa, machined, at 99 %, Shigley sec. 6-9."""
    fibre = second_arm_stresses()
    endurance = 700.0 * 4.51 * 2000.0**-0.265 * (1.0 - 0.08 * 2.326348)
    endurance *= min((0.808 * np.sqrt(60.0) / 7.62) ** -0.107, 1.0)
    mean = 0.5 * abs(fibre.max() + fibre.min())
    return float(1.0 / (0.5 * np.ptp(fibre) / endurance + mean / 2000.0))


def surged_force() -> np.ndarray:
    """300 + 100 sin and the surge at the moving end, raised by friction on the rise, N."""
    slope = 0.5 * made.STROKE * np.sin(made.THETA)
    pitch = made.BASE + S
    phi = np.pi / SURGE * np.sqrt(RATE / made.RATE)
    surge = -0.5 * made.STROKE * made.RATE * (phi / np.tan(phi) - 1.0) * np.cos(made.THETA)
    rise = np.where(np.abs(slope) > 1e-12, np.sign(slope), 0.0)
    share = 1.0 - rise * (0.2 + 0.1 * made.WAVE)
    force: np.ndarray = 300.0 + 100.0 * made.WAVE
    return force + surge / share * np.hypot(pitch, slope) / pitch


def mean_life() -> float:
    """(C/P)^3 1e6 turns at the speed of a roller that rolls on the pitch curve, hours."""
    slope = 0.5 * made.STROKE * np.sin(made.THETA)
    pitch, force = made.BASE + S, surged_force()
    speed = np.hypot(pitch, slope)
    bend = (pitch**2 + 2.0 * slope**2 - pitch * BEND) / speed**3
    # The contact runs along the pitch curve less the roller's turning with it.
    spin = made.CAM_SPEED * (speed / made.ROLLER - 1.0)
    assert bend.min() > 0.0
    load = np.cbrt(np.sum(force**3 * spin) / np.sum(spin))
    return 1e6 * (1140.0 / load) ** 3 / (spin.mean() / (2.0 * np.pi)) / 3600.0


def curvature_rate() -> float:
    """Greatest change of the curvature of the contour per length, 1/m2, from points alone."""
    x, y = made.contour().polygon(1440)
    chord = np.hypot(np.roll(x, -1) - x, np.roll(y, -1) - y)
    angle = np.unwrap(np.arctan2(np.roll(y, -1) - y, np.roll(x, -1) - x))
    turning = np.mod(np.roll(angle, -1) - angle + np.pi, 2.0 * np.pi) - np.pi
    bend = turning / (0.5 * (chord + np.roll(chord, -1)))
    return float(np.max(np.abs(np.roll(bend, -1) - bend) / np.roll(chord, -1)))


def gouge() -> float:
    """Depth of a wheel of 200 mm in the hollow cam, mm, by distances to all points."""
    shape = made.hollow()
    x, y = shape.polygon(14400)
    centre = shape.polygon(720) + 0.2 * np.stack(
        [(np.roll(y, -1) - np.roll(y, 1))[::20], (np.roll(x, 1) - np.roll(x, -1))[::20]]
    ) / np.hypot(np.roll(x, -1) - np.roll(x, 1), np.roll(y, -1) - np.roll(y, 1))[::20]  # fmt: skip
    nearest, _ = cKDTree(np.stack([x, y], axis=1)).query(centre.T)
    return 1e3 * float(np.max(0.2 - nearest))


@cache
def thrown() -> np.ndarray:
    """m e w^2 of a polygon of the contour less the keyway in strips, turning with the shaft."""
    x, y = made.contour().polygon(7200)
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    moment = np.array([np.sum((v + np.roll(v, -1)) * cross) / 6.0 for v in (x, y)])
    cam = made.case().cam
    key = cam.keyway
    across = ((np.arange(2000) + 0.5) / 2000 - 0.5) * key.width
    bore, floor = np.sqrt(cam.bore_radius**2 - across**2), cam.bore_radius + key.depth
    arm = np.mean(floor**2 - bore**2) / 2.0 * key.width
    moment -= arm * np.array([np.cos(key.angle), np.sin(key.angle)])
    size = 7850.0 * cam.width * np.hypot(*moment) * made.CAM_SPEED**2
    turned = made.THETA - np.arctan2(moment[1], moment[0])
    return size * np.stack([np.cos(turned), np.sin(turned)])


@cache
def shaft_forces() -> dict[float, np.ndarray]:
    """Forces on the shaft, N, by their place, m: three moments about the first bearing vanish."""
    loads = made.cycle().loads
    tooth = (loads.cam_torque + 0.5) / 0.02
    # Meshing opposite the follower: the tooth pushes along -y, the wheels part along +x.
    gear = np.stack([np.abs(tooth) * np.tan(np.radians(20.0)), -tooth])
    cam = np.stack([-loads.axial_force, -loads.tangential_force]) + thrown()
    second = -(cam * 0.02 + gear * -0.015) / 0.06
    return {0.0: -cam - gear - second, 0.06: second, 0.02: cam, -0.015: gear}


def moment_at(place: float) -> np.ndarray:
    """Of the forces beyond the place, N m."""
    zero = np.zeros((2, made.POSITIONS))
    return zero + sum(force * max(at - place, 0.0) for at, force in shaft_forces().items())


# Fatigue notch factors and whether the torque passes, at the places of the seats.
SEATS = {
    **dict.fromkeys((0.02, 0.015, 0.025), (2.14, 3.0)),
    **dict.fromkeys((-0.015, -0.020, -0.010), (2.14, 3.0)),
    **dict.fromkeys((0.0, 0.06), (2.7, 2.2)),
}


def twist_at(place: float) -> np.ndarray:
    """Torque between gear and cam, N m."""
    return (made.cycle().loads.cam_torque + 0.5) * float(-0.015 <= place <= 0.02)


def shaft_safety() -> float:
    """Least of all seats, fibre by fibre, Shigley sec. 7-4, in plain loops."""
    d, used = 0.017, 0.0
    # Shigley: machined, 900 MPa; 17 mm; z of 99 % is 2.326.
    endurance = 400e6 * 4.51 * 900**-0.265 * (17 / 7.62) ** -0.107 * (1 - 0.08 * 2.32635)
    for place, (bending, torsion) in SEATS.items():
        moment, torque = moment_at(place), twist_at(place)
        for fibre in np.radians(np.arange(0.0, 360.0, 5.0)):
            pull = 32.0 / (np.pi * d**3) * (
                moment[0] * np.cos(fibre + made.THETA) + moment[1] * np.sin(fibre + made.THETA)
            )  # fmt: skip
            twist = 16.0 * torque / (np.pi * d**3)
            amplitude, mean = (
                np.hypot(
                    bending * 0.5 * (pull.max() + sign * pull.min()),
                    np.sqrt(3.0) * torsion * 0.5 * (twist.max() + sign * twist.min()),
                )
                for sign in (-1.0, 1.0)
            )
            used = max(used, amplitude / endurance + mean / 900e6)
    return float(1.0 / used)


def shaft_stress() -> float:
    """Greatest principal stresses of the notch of all seats, as von Mises stress, Pa."""
    worst, d = 0.0, 0.017
    for place, (bending, torsion) in SEATS.items():
        pull = bending * np.hypot(*moment_at(place)) * 32.0 / (np.pi * d**3)
        twist = torsion * twist_at(place) * 16.0 / (np.pi * d**3)
        centre, radius = 0.5 * pull, np.hypot(0.5 * pull, twist)  # Mohr's circle
        one, two = centre + radius, centre - radius
        worst = max(worst, float(np.sqrt(one**2 - one * two + two**2).max()))
    return worst


@cache
def shaft_curve() -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Places, m, deflection (2, n, x), m, slope, rad, by integrating M/(E I) twice."""
    x = np.linspace(-0.015, 0.06, 7501)
    bend = np.stack([moment_at(place) for place in x], axis=-1) / (210e9 * np.pi * 0.017**4 / 64)
    slope = cumulative_trapezoid(bend, x, initial=0.0)
    sag = cumulative_trapezoid(slope, x, initial=0.0)
    first, second = np.searchsorted(x, 1e-9 + 0.0) - 1, x.size - 1
    turn = (sag[..., second] - sag[..., first]) / (x[second] - x[first])
    sag = sag - sag[..., first, None] - turn[..., None] * (x - x[first])
    return x, sag, slope - turn[..., None], np.array([first, second])


def shaft_sag() -> float:
    """Greatest deflection at the cam over the spacing."""
    x, sag, _, _ = shaft_curve()
    return float(np.hypot(*sag[..., np.argmin(np.abs(x - 0.02))]).max() / 0.06)


def shaft_slope() -> float:
    """Greatest slope at a bearing, mrad."""
    _, _, slope, ends = shaft_curve()
    return 1e3 * float(np.hypot(*slope[..., ends]).max())


def bearing_loads() -> tuple[np.ndarray, np.ndarray]:
    forces = shaft_forces()
    return np.hypot(*forces[0.0]), np.hypot(*forces[0.06])


def bearing_hours() -> float:
    """ISO 281 of the harder loaded bearing at a steady speed."""
    worst = max(np.cbrt(np.mean(load**3)) for load in bearing_loads())
    return 1e6 * (9950.0 / worst) ** 3 / (made.CAM_SPEED / (2.0 * np.pi)) / 3600.0


# Key 5 x 5 x 14 of form A in a bore of 17 mm: 9 mm bear, t1 3 mm, chamfer 0.4 mm.
KEY_PUSH = 1.5 * float(TORQUE.max()) / 8.5e-3
TOOTH = 1.5 * float(np.max(np.abs(made.cycle().loads.cam_torque + 0.5))) / 0.02


def struck() -> float:
    """Force, N, on teeth that cross 0.1 mm under 4.5 N m: greatest of a damped swing from F/c.

    x = F/c + e^(-z w t) (A sin(w' t) - F/c cos(w' t)) at x' = 0; v^2 = 2 F j/m, any m.
    """
    push, stiffness, damping = 4.5 / 0.02, 20e9 * 210.0 / 206.0 * 0.01, 0.03
    rest, rate = push / stiffness, np.sqrt(stiffness)  # of a mass of 1 kg
    slowed = rate * np.sqrt(1.0 - damping**2)
    speed = float(np.sqrt(2.0 * push * 1e-4))
    time = np.linspace(0.0, np.pi / rate, 200_001)
    sine = (speed - damping * rate * rest) / slowed * np.sin(slowed * time)
    swing = np.exp(-damping * rate * time) * (sine - rest * np.cos(slowed * time))
    return float(stiffness * (rest + swing).max())


def wall_stress(interference: float) -> float:
    """Von Mises stress at the bore of a steel ring shrunk on a shaft of its own steel, Pa.

    By the stresses A -+ B/r^2 with no pressure outside; interference: of the diameters, m.
    """
    inner, outer = 8.5e-3, made.BASE - made.ROLLER
    pressure = 210e9 * interference / (4.0 * inner) * (1.0 - (inner / outer) ** 2)
    b = pressure / (inner**-2 - outer**-2)
    along, across = b * (outer**-2 + inner**-2), b * (outer**-2 - inner**-2)
    return float(np.sqrt(along**2 - along * across + across**2))


def root_safety() -> float:
    """Pulsating from zero; 0.16 mm of fillet at 2.3 mm, wall from 10.8 to 42 mm, cam 10 mm wide."""
    loads = made.cycle().loads
    pressure = 1.5 * np.abs(loads.cam_torque) / 8.5e-3 / (9e-3 * 1.6e-3)
    stress = 0.70 * pressure + 4.1 * loads.normal_force / (0.01 * 0.0312)
    greatest = float(stress.max()) * np.exp(0.4555 * np.log(2.3 / 0.16))
    endurance = 400e6 * 4.51 * 900**-0.265 * (1 - 0.08 * 2.32635)
    return 2.0 / (greatest / endurance + greatest / 900e6)


def greatest_moment_swing(a, f, degrees, rate, preload):
    """Swing at which a spring between radii a and f about a pivot has its greatest moment, rad."""

    def moment(swing):
        turned = np.radians(degrees) - swing
        long = np.sqrt(a**2 + f**2 - 2.0 * a * f * np.cos(turned))
        start = np.sqrt(a**2 + f**2 - 2.0 * a * f * np.cos(np.radians(degrees)))
        return (preload + rate * (start - long)) * a * f * np.sin(turned) / long

    most = minimize_scalar(
        lambda swing: -moment(swing), bounds=(0.0, np.radians(degrees)), method="bounded",
        options={"xatol": 1e-12},
    )  # fmt: skip
    return float(most.x)


WARM_NYLON = 1.0 - (56.85 - 20.0) / 80.0 / 3.0
"""Strength of nylon at 56.85 degC over that at 20 degC, of 60 MPa there and 40 MPa at 100 degC."""


def pivot_life(rating: float, load: float, swing: float) -> float:
    """L10, h, of a load R |sin| at an angular speed of swing |sin|, rad/s.

    The mean of |sin|^p is Gamma((p + 1)/2)/(sqrt(pi) Gamma(p/2 + 1)).
    """
    power = 13.0 / 3.0
    mean = gamma(0.5 * (power + 1.0)) / (np.sqrt(np.pi) * gamma(0.5 * power + 1.0))
    turns_a_second = swing * mean / (2.0 * np.pi)
    return float((rating / load) ** (10.0 / 3.0) * 1e6 / turns_a_second / 3600.0)
