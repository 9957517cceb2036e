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
TORQUE = np.abs(made.cycle().loads.cam_torque)


def fast_contact(cam_speed: float) -> float:
    """Least contact force over the preload on 5 mm (1 - cos) without friction.

    A + |B| cos: B = a (m w^2 - k phi cot phi), phi = pi w/w_1 sqrt(1 - 0.02 i).
    """
    own = np.pi * np.sqrt(made.RATE / COIL_MASS)
    phi = np.pi * cam_speed / own * np.sqrt(1.0 - 0.02j)
    swing = 0.5 * made.STROKE * (made.MASS * cam_speed**2 - made.RATE * phi / np.tan(phi))
    return float((made.PRELOAD + 0.5 * made.RATE * made.STROKE - np.abs(swing)) / made.PRELOAD)


def roller_spin() -> np.ndarray:
    """Of a roller that rolls on the contour, rad/s: the pitch curve's length less its turning."""
    slope = 0.5 * made.STROKE * np.sin(made.THETA)
    return made.CAM_SPEED * (np.hypot(made.BASE + S, slope) / made.ROLLER - 1.0)


def viscosity_ratio() -> float:
    """20 mm2/s over 4500/sqrt(n D), D = 10.5 mm, above 1000 rpm: ISO 281."""
    speed = RPM * float(roller_spin().mean())
    assert speed > 1000.0
    return 20.0 * np.sqrt(speed * 10.5) / 4500.0


def mean_life() -> float:
    """(C/P)^3 1e6 turns at the speed of a roller that rolls on the pitch curve, hours."""
    loads = made.cycle().loads
    slope = 0.5 * made.STROKE * np.sin(made.THETA)
    pitch = made.BASE + S
    # Surge of a harmonic lift at the moving end, raised by friction on the rise.
    phi = np.pi / SURGE * np.sqrt(RATE / made.RATE)
    surge = -0.5 * made.STROKE * made.RATE * (phi / np.tan(phi) - 1.0) * np.cos(made.THETA)
    rise = np.where(np.abs(slope) > 1e-12, np.sign(slope), 0.0)
    share = 1.0 - rise * (0.2 + 0.1 * made.WAVE)
    force = loads.normal_force + surge / share * np.hypot(pitch, slope) / pitch
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
