"""Helical compression spring: force, stress, fatigue, solid length, buckling, surge."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, finite
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import In, Length, Part, Preload, Pressure, Rate

DEAD_COILS = 2.0  # of squared and ground ends
SHEAR_STRENGTH_SHARE = 0.67  # shear over tensile strength, S_su / R_m
ZIMMERLI = {"plain": (241e6, 379e6), "peened": (398e6, 534e6)}  # S_sa, S_sm by treatment, Pa
_STRENGTH_DIAMETER = 0.001  # m, of strength_at_1mm
BUCKLING = 2.63  # stability limit of free length times end factor over mean diameter, steel

WireModulus = Annotated[float, In("GPa", above=0, at_most=1e5)]
WireDensity = Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
WireExponent = Annotated[float, In(at_least=0, below=1)]
Treatment = Literal["plain", "peened"]


@dataclass(frozen=True, kw_only=True)
class HelicalSpring(Part):
    """Cylindrical compression spring of round wire with squared and ground ends.

    mean_diameter D over wire_diameter d from 3 to 20; coils: active; end_factor: 1 pivoted at both
    ends, 0.707 pivoted and fixed, 0.5 flat; tensile strength of the wire
    R_m = strength_at_1mm (d / 1 mm)^-strength_exponent; name: of a catalogue.

    Raises
    ------
    InputError
        If a value is out of its bounds. The solid length under load is a check, see
        `solid_clearance`.
    """

    table: ClassVar[str] = "spring.design"
    labels: ClassVar[tuple[str, ...]] = ("name",)

    wire_diameter: Length
    mean_diameter: Length
    coils: Annotated[float, In(at_least=1.5, at_most=1000)]
    free_length: Length
    end_factor: Annotated[float, In(above=0, at_most=2)] = 0.5
    shear_modulus: WireModulus
    density: WireDensity
    strength_at_1mm: Pressure
    strength_exponent: WireExponent
    treatment: Treatment = "plain"
    source: str = ""
    name: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 3.0 <= self.mean_diameter / self.wire_diameter <= 20.0:
            limit = "3 to 20 wire diameters: the range of coiling"
            raise InputError("spring.design.mean_diameter", self.mean_diameter, limit)
        if not self.solid_length < self.free_length:
            limit = f"> {self.solid_length:g} m, the solid length"
            raise InputError("spring.design.free_length", self.free_length, limit)

    @property
    def tensile_strength(self) -> float:
        """Tensile strength R_m of the wire, Pa."""
        return float(
            self.strength_at_1mm
            * (self.wire_diameter / _STRENGTH_DIAMETER) ** -self.strength_exponent
        )

    @property
    def index(self) -> float:
        """Spring index C = D/d."""
        return self.mean_diameter / self.wire_diameter

    @property
    def rate(self) -> float:
        """Rate k = G d^4 / (8 D^3 n), N/m."""
        bend = self.shear_modulus * self.wire_diameter**4
        return bend / (8.0 * self.mean_diameter**3 * self.coils)

    @property
    def active_mass(self) -> float:
        """Mass of the active coils, kg."""
        return self._mass(self.coils)

    @property
    def mass(self) -> float:
        """Mass with the end coils, kg."""
        return self._mass(self.coils + DEAD_COILS)

    def _mass(self, coils: float) -> float:
        section = 0.25 * np.pi * self.wire_diameter**2
        return float(self.density * section * np.pi * self.mean_diameter * coils)

    @property
    def solid_length(self) -> float:
        """Length with all coils closed, m."""
        return self.wire_diameter * (self.coils + DEAD_COILS)

    @property
    def wahl_factor(self) -> float:
        """Wahl factor (4C - 1)/(4C - 4) + 0.615/C for curvature and direct shear."""
        C = self.index
        return (4.0 * C - 1.0) / (4.0 * C - 4.0) + 0.615 / C

    @property
    def surge_frequency(self) -> float:
        """First natural frequency between fixed ends, sqrt(k/m)/2, Hz."""
        return 0.5 * float(np.sqrt(self.rate / self.active_mass))

    def stress(self, force: ArrayLike) -> Array:
        """Maximum shear stress (...) of the wire with Wahl factor, Pa."""
        plain = 8.0 * self.mean_diameter / (np.pi * self.wire_diameter**3)
        return self.wahl_factor * plain * finite("spring.force", force)

    def deflection(self, force: float) -> float:
        """Deflection from the free length, m."""
        return force / self.rate

    def solid_clearance(self, preload: float, travel: float) -> float:
        """Clearance to the solid length at full lift over the maximum deflection.

        Negative: the spring is solid.
        """
        deflection = self.deflection(preload) + travel
        return (self.free_length - self.solid_length - deflection) / deflection

    def static_use(self, force: float) -> float:
        """Static utilisation: shear stress over 0.56 R_m.

        References
        ----------
        EN 13906-1 (recalled, verify); Shigley's Mechanical Engineering Design, ch. 10.
        """
        strength = 0.56 * self.tensile_strength
        return float(self.stress(force)) / strength

    def fatigue_safety(self, force_min: float, force_max: float) -> float:
        """Fatigue safety factor by the Goodman line through the point of Zimmerli.

        The line passes the shear strength 0.67 R_m on the axis of mean stress and the amplitude and
        mean of Zimmerli for infinite life. Infinite without load, 0 for a shear strength below the
        mean stress of Zimmerli.

        References
        ----------
        Shigley's Mechanical Engineering Design, ch. 10: Zimmerli's data, torsional Goodman.
        """
        if not 0.0 <= force_min <= force_max:
            raise InputError("spring.force", force_min, "0 <= minimum <= maximum, N")
        low, high = float(self.stress(force_min)), float(self.stress(force_max))
        amplitude, mean = 0.5 * (high - low), 0.5 * (high + low)
        shear_strength = SHEAR_STRENGTH_SHARE * self.tensile_strength
        zimmerli_amplitude, zimmerli_mean = ZIMMERLI[self.treatment]
        endurance = zimmerli_amplitude / (1.0 - zimmerli_mean / shear_strength)
        if not endurance > 0.0:
            return 0.0
        use = amplitude / endurance + mean / shear_strength
        return 1.0 / use if use > 0.0 else np.inf

    @property
    def buckling_use(self) -> float:
        """Free length over the limit of stability against buckling at any deflection.

        References
        ----------
        Shigley's Mechanical Engineering Design, ch. 10: L0 < 2.63 D/alpha for steel.
        """
        return self.free_length * self.end_factor / (BUCKLING * self.mean_diameter)


@dataclass(frozen=True, kw_only=True)
class Spring(Part):
    """Linear spring of the follower, preloaded at zero lift.

    Tolerances are relative; travel_max: maximum lift; design: geometry of the wound spring.
    """

    table: ClassVar[str] = "spring"

    rate: Rate
    preload: Preload
    travel_max: Length | None = None
    rate_tolerance: Annotated[float, In(above=0, below=1)] = 0.05
    preload_tolerance: Annotated[float, In(above=0, below=1)] = 0.05
    design: HelicalSpring | None = None
    source: str = ""

    def force(self, lift: Array) -> Array:
        """Force P + k s at a lift (...), m, in N."""
        return self.preload + self.rate * lift

    def stiffness(self, lift: Array) -> Array:
        """Slope k of the force over the lift (...), N/m."""
        return self.rate + 0.0 * lift

    def energy(self, lift: float) -> float:
        """Energy P s + k s^2 / 2 at a lift, m, beyond that at zero lift, J."""
        return self.preload * lift + 0.5 * self.rate * lift**2


def surge_harmonics(
    lift_values: Array, cam_speed: float, frequency: float, share: float = 0.01
) -> tuple[int, float, float]:
    """Highest significant harmonic of the lift acceleration, and its margin against surge.

    Parameters
    ----------
    lift_values : array (n,)   at equal angles, m
    cam_speed : float          rad/s, > 0
    frequency : float          first natural frequency of the spring, Hz
    share : float              share of the largest harmonic above which one is significant

    Returns
    -------
    highest : int         order of the highest significant harmonic
    ratio : float         natural frequency over rotational frequency of the cam
    margin : float        natural frequency over that of the highest significant harmonic
    """
    harmonics = np.abs(np.fft.rfft(finite("lift", lift_values)))
    order = np.arange(harmonics.size)
    acceleration = harmonics * order**2
    strong = np.flatnonzero(acceleration >= share * max(acceleration.max(), 1e-300))
    highest = int(strong[-1]) if acceleration.max() > 0.0 else 0
    ratio = frequency * 2.0 * np.pi / cam_speed
    return highest, ratio, ratio / highest if highest else np.inf


def surge_force(
    lift_values: Array,
    cam_speed: float,
    rate: float,
    frequency: float,
    damping: float = 0.01,
    modes: int = 8,
) -> Array:
    """Dynamic force of the surge of the spring at its fixed end, (n,), N.

    One end follows the lift, the other is fixed; the coils move as
    s (1 - x) + sum q_j sin(j pi x), each mode driven by -2/(j pi) of the acceleration. Higher modes
    respond quasi-statically, with a sum in closed form. Without damping the response to a harmonic
    w is k (phi / sin(phi) - 1), phi = pi w / w_1.

    Parameters
    ----------
    lift_values : array (n,)   at equal angles of one turn, m
    cam_speed : float          rad/s
    rate : float               k, N/m
    frequency : float          of the first mode, Hz
    damping : float            damping ratio of each mode
    modes : int

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 15: spring surge.
    """
    spectrum = np.fft.rfft(finite("lift", lift_values))
    drive = np.arange(spectrum.size) * cam_speed
    order = np.arange(1, modes + 1)
    beyond = 1.0 / 6.0 + np.sum(2.0 * (-1.0) ** order / (order * np.pi) ** 2)
    force = rate * beyond * (drive / (2.0 * frequency)) ** 2 * spectrum
    for j in range(1, modes + 1):
        own = 2.0 * np.pi * frequency * j
        response = own**2 - drive**2 + 2.0j * damping * own * drive
        q = 2.0 / (j * np.pi) * drive**2 * spectrum / response
        force -= rate * j * np.pi * (-1.0) ** j * q
    return np.fft.irfft(force, len(lift_values))
