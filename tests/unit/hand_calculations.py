"""Demands of the solution of `made_trial`, worked out by hand: closed forms with their sources."""

import made_trial as made
import numpy as np

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
SWING, MIDDLE = (0.5 * SHEAR * (HARDEST + sign * made.PRELOAD * 1.05) for sign in (-1, 1))
SOLID = FREE - WIRE * (COILS + 2.0)
DEFLECTION = made.PRELOAD * 1.05 / RATE + made.STROKE
COIL_MASS = 7850.0 * 0.25 * np.pi * WIRE**2 * np.pi * COIL * COILS
SURGE = 0.5 * np.sqrt(RATE / COIL_MASS) * 2.0 * np.pi / made.CAM_SPEED
DENSE = np.linspace(0.0, np.pi, 20001)
RADIUS = made.BASE + 0.5 * made.STROKE * (1.0 - np.cos(DENSE))
SLOPE, CURVE = 0.5 * made.STROKE * np.sin(DENSE), 0.5 * made.STROKE * np.cos(DENSE)
PITCH_RADIUS = (RADIUS**2 + SLOPE**2) ** 1.5 / (RADIUS**2 + 2.0 * SLOPE**2 - RADIUS * CURVE)
TORQUE = np.abs(made.cycle().loads.cam_torque)


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
    for force, speed in zip(made.cycle().loads.normal_force, roller_spin(), strict=True):
        clean = (0.5 * 60.0 / force) ** (1.0 / 3.0)
        left = 1.0 - (2.5671 - 1.9987 * kappa**-0.071739) ** 0.83 * clean
        turns = 1e6 * min(0.1 / left**9.3, 50.0) * (1140.0 / force) ** 3
        damage += speed / (2.0 * np.pi) / turns / made.POSITIONS
    return 1.0 / damage / 3600.0


def pin_fatigue() -> float:
    """Each fibre of the pin by itself under 300 + 100 sin along and 100 sin across: Goodman."""
    bend = 32.0 * (16.0 / 4.0 - 10.0 / 8.0) / (np.pi * 5.0**3)  # MPa/N
    least = np.inf
    for fibre in np.arange(0.0, 360.0, 0.5):
        along, across = np.cos(np.radians(fibre)), np.sin(np.radians(fibre))
        stress = bend * ((300.0 + 100.0 * made.WAVE) * along + 100.0 * made.WAVE * across)
        amplitude, mean = 0.5 * np.ptp(stress), 0.5 * (stress.max() + stress.min())
        least = min(least, 700.0 * (1.0 - max(mean, 0.0) / 2000.0) / amplitude)
    return float(least)


def moving_mass() -> float:
    """Roller about its pin, pin, cheeks and bridge, stem, a fifth of the spring, g."""
    steel, stem = 7.85e-3, 140.0 - 12.0 - 5.0  # g/mm3; mm beyond the fork
    roller = 10.0 * np.pi * (8.0**2 - 2.5**2)
    pin = (16.0 + 4.0) * np.pi * 2.5**2
    fork = 2.0 * 4.0 * 10.0 * 12.0 + 20.0 * 10.0 * 5.0
    wire = np.pi * 3.0**2 * np.pi * 40.0 * (8.2 + 2.0)
    return float(steel * (roller + pin + fork + stem * np.pi * 5.0**2 + 0.2 * wire))


def mean_life() -> float:
    """(C/P)^3 1e6 turns at the speed of a roller that rolls on the pitch curve, hours."""
    force = made.cycle().loads.normal_force
    slope = 0.5 * made.STROKE * np.sin(made.THETA)
    pitch = made.BASE + S
    speed = np.hypot(pitch, slope)
    bend = (pitch**2 + 2.0 * slope**2 - pitch * BEND) / speed**3
    # The contact runs along the pitch curve less the roller's turning with it.
    spin = made.CAM_SPEED * (speed / made.ROLLER - 1.0)
    assert bend.min() > 0.0
    load = np.cbrt(np.sum(force**3 * spin) / np.sum(spin))
    return 1e6 * (1140.0 / load) ** 3 / (spin.mean() / (2.0 * np.pi)) / 3600.0


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


def shaft_safety() -> float:
    """Greatest moment arms by statics, fibre by fibre, Shigley sec. 7-4, in plain loops."""
    loads, d = made.cycle().loads, 0.017
    torque = loads.cam_torque
    tooth = torque / 0.02
    # Meshing opposite the follower: the tooth pushes along -y, the wheels part along +x.
    gear = np.stack([np.abs(tooth) * np.tan(np.radians(20.0)), -tooth])
    cam = np.stack([-loads.axial_force, -loads.tangential_force]) + thrown()
    second = -(cam * 0.02 + gear * -0.015) / 0.06
    first = -cam - gear - second
    moment = first * 0.02 + gear * 0.035
    worst = np.inf
    for fibre in np.radians(np.arange(0.0, 360.0, 5.0)):
        pull = 32.0 / (np.pi * d**3) * (
            moment[0] * np.cos(fibre + made.THETA) + moment[1] * np.sin(fibre + made.THETA)
        )  # fmt: skip
        twist = 16.0 * torque / (np.pi * d**3)
        amplitude, mean = (
            np.hypot(
                2.14 * 0.5 * (pull.max() + sign * pull.min()),
                np.sqrt(3.0) * 3.0 * 0.5 * (twist.max() + sign * twist.min()),
            )
            for sign in (-1.0, 1.0)
        )
        worst = min(worst, 1.0 / (amplitude / 400e6 + mean / 900e6))
    return float(worst)


def bearing_hours() -> float:
    """ISO 281 of the harder loaded bearing at a steady speed."""
    loads = made.cycle().loads
    tooth = loads.cam_torque / 0.02
    gear = np.stack([np.abs(tooth) * np.tan(np.radians(20.0)), -tooth])
    cam = np.stack([-loads.axial_force, -loads.tangential_force]) + thrown()
    second = -(cam * 0.02 + gear * -0.015) / 0.06
    first = -cam - gear - second
    worst = max(np.cbrt(np.mean(np.hypot(*load) ** 3)) for load in (first, second))
    return 1e6 * (9950.0 / worst) ** 3 / (made.CAM_SPEED / (2.0 * np.pi)) / 3600.0


TOOTH = 1.5 * float(np.max(np.abs(made.cycle().loads.cam_torque + 0.5))) / 0.02
