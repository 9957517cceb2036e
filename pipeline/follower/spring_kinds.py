"""Springs that are no coils on a stem, gas and torsion; lift from stored energy.

The force over the lift is F(s) = P + k rho(s), with the preload P, the rate k at zero lift and a
rise rho that is s near zero: rate and preload mean the same as those of a coil spring, and so do
their tolerances. The stored energy beyond that at zero lift is P s + k R(s), with R the integral of
rho. All functions take complex numbers: a complex step gives their derivative to round-off.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Length,
    Meaning,
    Part,
    Pressure,
    Resolved,
    TableSource,
    Temperature,
    card_of,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.follower.wound_wire import INDEX_MAX, INDEX_MIN, WoundWire

ATMOSPHERE = 101_325.0
"""Pressure of the surroundings, Pa."""
CHARGED_AT = 293.15
"""Temperature at which a charging pressure is stated, K: 20 degC."""
STROKE_SHARE = 0.995
"""Share of the lift to the singularity of a force up to which the law holds; tangent beyond."""
DISTORTION_ENERGY = 0.577
"""Shear strength over tensile strength by the distortion energy."""
_PULSATING_HOOK = 0.45
"""Greatest bending stress of a hook over the tensile strength for 1e7 strokes from zero, of music
and stainless wire, not peened."""
_ANY_TRAVEL = 100.0  # m, beyond that of the end of any arm
_NEWTON_ROUNDS = 100  # of the lift from its energy, at most
_LIFT_CONVERGED = 1e-13
"""Last step over the lift, plus a hundredth of it over the reach: round-off of the energy."""


class Rise(NamedTuple):
    """Rise rho of a spring's force over the rate: integral R, m2; rho, m; rho'; rho'', 1/m."""

    work: Array
    travel: Array
    slope: Array
    travel_d2: Array

    @classmethod
    def linear(cls, lift: Array) -> Rise:
        """Of a force that is linear in the lift (...), m."""
        return cls(0.5 * lift**2, lift, 1.0 + 0.0 * lift, 0.0 * lift)


SpringKind = Literal["gas", "torsion", "torsion_pivot", "extension"]
"""Kinds of spring that are no coils, by `spring.kind` and the table of their name."""
SpringPart = Literal["gas_spring", "torsion_spring", "extension_spring"]
"""What `[scope]` calls them."""


@dataclass(frozen=True, kw_only=True)
class SpringShape(Part, ABC):
    """Interface of a spring: its table in a case, the rise of its force over the lift.

    Force and lift are those of the follower. What a linkage between both reduces to the follower
    has another travel and force at its own ends.

    part: its name in `[scope]`; carried: what it acts on, "": either; linkable: whether it can
    stand between a point of an arm and a fixed one; pulls: its ends together; linear: in the lift
    """

    part: ClassVar[SpringPart]
    carried: ClassVar[Literal["", "stem", "arm"]] = ""
    linkable: ClassVar[bool] = False
    pulls: ClassVar[bool] = False
    linear: ClassVar[bool] = False

    @property
    def preload_key(self) -> str:
        """Key that states the force at zero lift with its sign; "": it cannot change its sign, as
        that of a piston, whose rod is pushed alone, or of hooks, which are pulled alone.
        """
        return ""

    @property
    @abstractmethod
    def preload(self) -> Value:
        """Force at zero lift, N."""

    @property
    @abstractmethod
    def rate(self) -> Value:
        """Slope of the force at zero lift, N/m."""

    @property
    @abstractmethod
    def reach(self) -> Value:
        """Lift up to which the law holds, m."""

    @abstractmethod
    def within(self, lift: Array) -> Rise:
        """Rise at a lift (...) up to the reach, m."""

    @property
    def own(self) -> SpringShape | None:
        """Rise of its own force over its own travel; None: linear."""
        return self

    @property
    def stated(self) -> Part:
        """Table from which it depends on the arm."""
        return self

    def with_stated(self, stated: Part) -> SpringShape:
        """With another table in place of `stated`."""
        return stated if isinstance(stated, SpringShape) else self

    @property
    def own_share(self) -> Value:
        """Rate at its own ends over that on the follower, both at zero lift."""
        return 1.0

    def end_travel(self, lift: Value) -> Value:
        """Travel (...) of its own ends from zero lift, m."""
        return lift

    def lever(self, lift: Value) -> Value:  # noqa: ARG002
        """Travel of its own ends per lift (...): force on the follower over its own."""
        return 1.0

    def pull_on_arm(self, force: Array, lift: Array) -> Array:
        """Resultant of the spring on an arm (2, ...), N, along it from the pivot and outwards.

        Parameters
        ----------
        force : array (...)   at the reference point, N, positive towards the cam
        lift : array (...)    m
        """
        held = np.asarray(force + 0.0 * lift)
        return np.stack([0.0 * held, -held])

    def on_arm(self, length: float | None, rocker: Rocker | None = None) -> Self:  # noqa: ARG002
        """As it acts on the arc of an arm of a length, m, and by a rocker; None: on a stem."""
        return self


def rise(shape: SpringShape, lift: Array) -> Rise:
    """Rise of the force of a spring over its rate at zero lift, with its integral and derivatives;
    linear below zero lift and beyond the reach.

    Parameters
    ----------
    shape : SpringShape   law of the spring
    lift : array (...)    m
    """
    real = np.real(lift)
    beyond = (real > shape.reach) | (real < 0.0)
    end = np.where(real < 0.0, 0.0, shape.reach)
    law = shape.within(np.where(beyond, end, lift))
    over = np.where(beyond, lift - end, 0.0)
    return Rise(
        law.work + (law.travel + 0.5 * law.slope * over) * over,
        law.travel + law.slope * over,
        law.slope,
        np.where(beyond, 0.0 * law.travel_d2, law.travel_d2),
    )


def shaped_deflection(
    energy: ArrayLike, rate: ArrayLike, preload: ArrayLike, shape: SpringShape
) -> Array:
    """Lift (...), m, at which a nonlinear spring has stored a given energy above that at zero lift.

    Newton's method within a bracket on P s + k R(s) = E, which increases with s; one more step in
    complex numbers has the exact derivative.

    Parameters
    ----------
    energy : array (...)          E, J; may be complex, as rate and preload
    rate, preload : array (...)   k at zero lift, N/m, > 0; P, N, > 0
    shape : SpringShape           law R of the force

    Raises
    ------
    ContactError
        If 100 rounds do not converge.
    """
    k, start = np.asarray(rate).real, np.asarray(preload).real
    wanted = np.asarray(energy).real
    # below zero the spring is linear; above, its force is at least the preload
    lift = 2.0 * wanted / (np.sqrt(start**2 + 2.0 * k * wanted) + start)
    low = np.minimum(lift, 0.0)
    high = np.where(wanted < 0.0, lift, wanted / start)
    for _ in range(_NEWTON_ROUNDS):
        law = rise(shape, lift)
        miss = start * lift + k * law.work - wanted
        low, high = np.where(miss < 0.0, lift, low), np.where(miss > 0.0, lift, high)
        step = lift - miss / (start + k * law.travel)
        inside = (step >= low) & (step <= high)
        nearer = np.where(inside, step, 0.5 * (low + high))
        close = np.abs(nearer - lift) <= _LIFT_CONVERGED * (np.abs(nearer) + 0.01 * shape.reach)
        lift = nearer
        if close.all():
            break
    else:
        raise ContactError(
            f"spring: {np.sum(~close)} lifts not converged in {_NEWTON_ROUNDS} rounds"
        )
    law = rise(shape, lift)
    if not any(np.iscomplexobj(each) for each in (energy, rate, preload)):
        return np.asarray(lift)
    miss = np.asarray(energy) - (np.asarray(preload) * lift + np.asarray(rate) * law.work)
    return np.asarray(lift + 1j * np.imag(miss) / (start + k * law.travel))


class Limited(NamedTuple):
    """State of a spring at a lift (...) under its maker's limits, SI."""

    pressure: Array
    temperature: Array


WireDiameter = Annotated[Length, Meaning("diameter of the wire")]
CoilDiameter = Annotated[Length, Meaning("mean diameter of the coils")]
ActiveCoils = Annotated[float, In(at_least=1.5, at_most=1000), Meaning("number of active coils")]
ShearModulus = Annotated[
    float, In("GPa", above=0, at_most=1e5), Meaning("shear modulus of the wire")
]
WireStrength = Annotated[Pressure, Meaning("tensile strength R_m of the wire")]


@dataclass(frozen=True, kw_only=True)
class GasSpring(SpringShape):
    """Gas spring: a piston of an area on a gas volume.

    At the temperature in operation the pressure is higher. Limits are those of the maker, each of a
    check.

    Raises
    ------
    InputError
        If a value is out of its bounds.
    """

    table: ClassVar[str] = "spring.gas"
    part: ClassVar[SpringPart] = "gas_spring"
    linkable: ClassVar[bool] = True
    resolved: ClassVar[Mapping[str, Resolved]] = card_of(
        "card of the gas spring, which fills the keys left out; it states no pressure",
        "gas_springs.toml",
        "nitrogen_20x25",
    )
    defaults: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "temperature": "20 degC, at which the pressure is stated",
            "conductance": "of its cylinder in still air",
        }
    )

    pressure: Annotated[
        float, In("bar", above=0, at_most=10_000), Known("data sheet of the maker", "100 bar")
    ]
    """pressure above that of the surroundings at zero lift and 20 degC"""
    area: Annotated[
        float, In("mm^2", above=0, at_most=1e7), Known("data sheet of the maker", "113 mm^2")
    ]
    """area of the piston or rod on which the gas acts"""
    volume: Annotated[
        float, In("cm^3", above=0, at_most=1e6), Known("data sheet of the maker", "12 cm^3")
    ]
    """volume of the gas at zero lift"""
    exponent: Annotated[
        float, In(at_least=1, at_most=1.7), Known("measured, or data sheet of the maker")
    ] = 1.3
    """exponent of the polytropic compression: 1 slow, 1.4 fast nitrogen"""
    temperature: Annotated[Temperature | None, Known("measured at the machine", "50 degC")] = None
    """mean temperature of the gas in operation"""
    cold_temperature: Annotated[Temperature | None, Known("place of the machine", "5 degC")] = None
    """temperature of the gas at the coldest start"""
    loss: Annotated[
        float | None,
        In(at_least=0, below=1),
        Known("data sheet of the maker, and the service interval", 0.03),
    ] = None
    """share of the gas that is lost until it is filled again"""
    friction: Annotated[
        float, In(at_least=0, below=1), Known("data sheet of the maker; 5 to 10 % is usual")
    ] = 0.05
    """friction of the seals over the force, which heats the gas"""
    conductance: Annotated[
        float | None,
        In("W/K", above=0, at_most=1e6),
        Known("measured: its friction power over its rise", "0.2 W/K"),
    ] = None
    """heat that the spring gives off per kelvin above the surroundings"""
    pressure_limit: Annotated[
        float | None,
        In("bar", above=0, at_most=10_000),
        Known("data sheet of the maker", "250 bar"),
    ] = None
    """greatest pressure at full compression, above that of the surroundings"""
    temperature_limit: Annotated[
        Temperature | None, Known("data sheet of the maker", "80 degC")
    ] = None
    """greatest temperature in operation"""
    speed_limit: Annotated[
        float | None, In("m/s", above=0, at_most=1000), Known("data sheet of the maker", "0.8 m/s")
    ] = None
    """greatest piston speed"""
    stroke_rate_limit: Annotated[
        float | None,
        In("1/min", above=0, at_most=1e5),
        Known("data sheet of the gas spring", "100 1/min"),
    ] = None
    """greatest number of strokes per time, cooled as the data sheet says"""
    stroke: Annotated[Length | None, Known("data sheet of the maker", "25 mm")] = None
    """greatest stroke from zero lift"""
    source: TableSource = NO_SOURCE

    @property
    def column(self) -> float:
        """Height V/A of the gas at zero lift, m."""
        return self.volume / self.area

    @property
    def warm(self) -> float:
        """Temperature of the gas, K."""
        return CHARGED_AT if self.temperature is None else self.temperature

    @property
    def absolute(self) -> float:
        """Absolute pressure at zero lift and the temperature of the gas, Pa."""
        return (self.pressure + ATMOSPHERE) * self.warm / CHARGED_AT

    @property
    def preload(self) -> float:
        """Force at zero lift, N."""
        return (self.absolute - ATMOSPHERE) * self.area

    @property
    def rate(self) -> float:
        """Slope of the force at zero lift, n p A^2 / V, N/m."""
        return self.exponent * self.absolute * self.area / self.column

    @property
    def surface(self) -> float:
        """Area of a cylinder of the gas, m^2."""
        return float(2.0 * np.sqrt(np.pi * self.area) * self.column + 2.0 * self.area)

    @property
    def reach(self) -> float:
        """Lift up to which the law holds, m."""
        return STROKE_SHARE * self.column

    def within(self, lift: Array) -> Rise:
        """Rise of p A (1 - s/L)^-n, L = V/A, over its slope at zero lift."""
        column, n = self.column, self.exponent
        left = 1.0 - lift / column
        once = -np.log(left) if n - 1.0 < _ISOTHERMAL else (left ** (1.0 - n) - 1.0) / (n - 1.0)
        return Rise(
            column / n * (column * once - lift),
            column / n * (left**-n - 1.0),
            left ** -(n + 1.0),
            (n + 1.0) / column * left ** -(n + 2.0),
        )

    def at(self, lift: ArrayLike) -> Limited:
        """Pressure above the surroundings, Pa, and temperature of the gas, K, at a lift (...), m.

        p V^n and T V^(n - 1) are constant.
        """
        left = 1.0 - np.minimum(np.asarray(lift, dtype=float), self.reach) / self.column
        pressure = self.absolute * left**-self.exponent - ATMOSPHERE
        return Limited(pressure, self.warm * left ** (1.0 - self.exponent))


_STEEPEST = 0.98  # sine of the greatest angle of an arm
_ISOTHERMAL = 1e-9  # exponent less 1, below which the compression is isothermal


@dataclass(frozen=True, kw_only=True)
class TorsionWire(SpringShape):
    """Torsion spring: moment, rate, wire and the strength of the wire.

    Raises
    ------
    InputError
        If a value is out of its bounds.
    """

    moment: Annotated[
        float, In("N m", at_least=-1e6, at_most=1e6), Known("spring drawing", "12 N m")
    ]
    """moment at zero lift; negative of a spring with its ends held both ways that is unwound there,
    which a cam that pulls permits"""
    angular_rate: Annotated[
        float,
        In("N m/rad", above=0, at_most=1e6),
        Known("spring drawing, or DIN EN 13906-3", "20 N m/rad"),
    ]
    """moment per angle"""
    wire_diameter: Annotated[WireDiameter | None, Known("spring drawing", "6 mm")] = None
    mean_diameter: Annotated[CoilDiameter | None, Known("spring drawing", "48 mm")] = None
    tensile_strength: Annotated[
        WireStrength | None, Known("EN 10270-1 for the wire diameter", "1700 MPa")
    ] = None
    stress_range: Annotated[
        Pressure | None, Known("fatigue diagram of DIN EN 13906-3, or the maker", "500 MPa")
    ] = None
    """permissible range of the bending stress for the target life"""

    @property
    def preload_key(self) -> str:
        return f"{self.table}.moment"

    @abstractmethod
    def moment_at(self, force: ArrayLike, lift: ArrayLike) -> Array:
        """Moment (...), N m, of a force on the follower, N, at a lift, m."""

    def bending_stress(self, moment: ArrayLike) -> Array:
        """Greatest bending stress (...) at the inside of the coils, Pa; NaN where the wire is not
        described.

        sigma = q 32 M / (pi d^3), q = (w + 0.07)/(w - 0.75), w = D/d; D, d: diameters of coils and
        wire.

        Parameters
        ----------
        moment : array (...)   M, N m

        References
        ----------
        DIN EN 13906-3; q read second-hand.
        """
        if self.wire_diameter is None or self.mean_diameter is None:
            return np.full_like(moment, np.nan)
        index = self.mean_diameter / self.wire_diameter
        curved = (index + 0.07) / (index - 0.75)
        return np.asarray(curved * 32.0 * np.asarray(moment) / (np.pi * self.wire_diameter**3))


@dataclass(frozen=True, kw_only=True)
class TorsionSpring(TorsionWire):
    """Torsion spring whose arm presses on the follower through a pin that slides across its axis.

    Wire, mean diameter, strength and range of the bending stress are for the checks.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the force falls with the lift.

    References
    ----------
    Work M d(beta) = F ds with s = l (sin(beta) - sin(beta_0)).
    """

    table: ClassVar[str] = "spring.torsion"
    part: ClassVar[SpringPart] = "torsion_spring"
    carried: ClassVar[Literal["", "stem", "arm"]] = "stem"

    arm: Annotated[Length, Known("drawing", "40 mm")]
    """length of the arm from the coil axis to the pin on the follower"""
    arm_angle: Annotated[float, In("deg", at_least=-75, at_most=75), Known("drawing")] = 0.0
    """angle of the arm at zero lift from square to the follower axis, positive towards the outward
    stroke"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse an arm angle at which the force falls with the lift."""
        super().__post_init__()
        if not self.rate > 0.0:
            stated = shown(self.arm_angle, "deg")
            raise InputError("spring.torsion.arm_angle", stated, "greater: the force must rise")

    @property
    def preload(self) -> float:
        """Force at zero lift, N."""
        return float(self.moment / (self.arm * np.cos(self.arm_angle)))

    @property
    def rate(self) -> float:
        """Slope of the force at zero lift, N/m."""
        bent = self.angular_rate + self.preload * self.arm * np.sin(self.arm_angle)
        return float(bent / (self.arm * np.cos(self.arm_angle)) ** 2)

    @property
    def reach(self) -> float:
        """Lift up to which the law holds, m: the arm nearly along the follower axis."""
        return float(self.arm * (_STEEPEST - np.sin(self.arm_angle)))

    def angle(self, lift: Array) -> Array:
        """Rotation (...) of the arm from zero lift, rad."""
        turned: Array = np.arcsin(np.sin(self.arm_angle) + lift / self.arm) - self.arm_angle
        return turned

    def within(self, lift: Array) -> Rise:
        """Rise of F = (M_0 + c (beta - beta_0)) / (l cos(beta)), over its slope at zero lift."""
        turned, c = self.angle(lift), self.angular_rate
        sine = np.sin(self.arm_angle) + lift / self.arm
        across = self.arm * np.sqrt(1.0 - sine**2)
        force = (self.moment + c * turned) / across
        steep = c + force * self.arm * sine  # F' (l cos(beta))^2
        slope = steep / across**2
        tangent = sine * self.arm / across
        # by the angle: dF = steep / across, and that of steep
        change = steep * tangent + force * across
        travel_d2 = (change + 2.0 * steep * tangent) / across**3
        work = (self.moment + 0.5 * c * turned) * turned
        return Rise(
            (work - self.preload * lift) / self.rate,
            (force - self.preload) / self.rate,
            slope / self.rate,
            travel_d2 / self.rate,
        )

    def moment_at(self, force: ArrayLike, lift: ArrayLike) -> Array:
        """Moment (...), N m, of a force on the follower, N, at a lift, m."""
        at = np.asarray(lift)
        turned = self.angle(np.where(np.real(at) < self.reach, at, self.reach))
        return np.asarray(np.asarray(force) * self.arm * np.cos(self.arm_angle + turned))


@dataclass(frozen=True, kw_only=True)
class PivotSpring(TorsionWire):
    """Torsion spring about the pivot of an oscillating follower.

    Its moment M_0 + c phi over the swing phi = s/l is the force M/l on the arc at the length l of
    the arm, with the rate c/l^2.

    Raises
    ------
    InputError
        If a value is out of its bounds.
    """

    table: ClassVar[str] = "spring.torsion_pivot"
    part: ClassVar[SpringPart] = "torsion_spring"
    carried: ClassVar[Literal["", "stem", "arm"]] = "arm"
    linear: ClassVar[bool] = True
    labels: ClassVar[tuple[str, ...]] = ("length",)

    source: TableSource = NO_SOURCE
    length: float = np.nan

    def on_arm(self, length: float | None, rocker: Rocker | None = None) -> Self:  # noqa: ARG002
        return self if length is None else replace(self, length=length)

    @property
    def preload(self) -> Value:
        """Force at zero lift, N."""
        return self.moment / self.length

    @property
    def rate(self) -> Value:
        """Slope of the force at zero lift, N/m."""
        return self.angular_rate / self.length**2

    @property
    def reach(self) -> Value:
        """Lift up to which the law holds, m: half a turn of the arm."""
        return np.pi * self.length

    def pull_on_arm(self, force: Array, lift: Array) -> Array:
        """Zero: a moment alone."""
        return 0.0 * super().pull_on_arm(force, lift)

    def within(self, lift: Array) -> Rise:
        """Rise of a force that is linear in the lift."""
        return Rise.linear(lift)

    def moment_at(self, force: ArrayLike, lift: ArrayLike) -> Array:  # noqa: ARG002
        return np.asarray(force) * self.length


class HookedShares(NamedTuple):
    """Permissible stresses of an extension spring over the tensile strength of its wire: torsion of
    the coils and of the bend to the hook, bending of the hook.
    """

    body: float
    torsion: float
    bending: float


HOOKED_SHARES: Mapping[str, HookedShares] = MappingProxyType(
    {"steel": HookedShares(0.45, 0.40, 0.75), "austenitic": HookedShares(0.35, 0.30, 0.55)}
)
"""By the kind of wire."""


@dataclass(frozen=True, kw_only=True)
class ExtensionSpring(SpringShape):
    """Extension spring of round wire with hooks, wound with an initial tension.

    Its force at zero lift grows by the rate k = G d^4/(8 D^3 n) of its coils.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the coils cannot be wound.

    References
    ----------
    EN 13906-2 (rate, body), recalled; Shigley's Mechanical Engineering Design, eqs 10-34 to 10-37
    (hooks) and 10-41 (initial tension), by transcriptions. Fatigue of the hook: amesweb.info,
    Maximum allowable stresses for coil extension springs, after Standard Handbook of Machine
    Design, p. 24.34.
    """

    table: ClassVar[str] = "spring.extension"
    part: ClassVar[SpringPart] = "extension_spring"
    carried: ClassVar[Literal["", "stem", "arm"]] = "arm"
    linkable: ClassVar[bool] = True
    pulls: ClassVar[bool] = True
    defaults: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"hook_radius": "half of `mean_diameter`, a full loop"}
    )

    force: Annotated[float, In("N", above=0, at_most=1e7), Known("spring drawing", "300 N")]
    """force of the spring at zero lift"""
    initial_tension: Annotated[
        float, In("N", at_least=0, at_most=1e7), Known("spring drawing", "60 N")
    ]
    """force up to which the coils stay closed"""
    wire_diameter: Annotated[WireDiameter, Known("spring drawing", "4 mm")]
    mean_diameter: Annotated[CoilDiameter, Known("spring drawing", "28 mm")]
    coils: Annotated[ActiveCoils, Known("spring drawing", 20.0)]
    shear_modulus: Annotated[ShearModulus, Known("EN 10270", "79.5 GPa")]
    hook_radius: Annotated[Length | None, Known("spring drawing", "14 mm")] = None
    """mean radius of the hook's bend, where it is bent most"""
    side_radius: Annotated[Length | None, Known("spring drawing", "8 mm")] = None
    """mean radius of the bend from the coils to the hook, where it is twisted most"""
    tensile_strength: Annotated[
        WireStrength | None, Known("EN 10270-1 for the wire diameter", "1700 MPa")
    ] = None
    wire_kind: Annotated[Literal["steel", "austenitic"], Known("spring drawing", "steel")] = "steel"
    """carbon or low-alloy steel; or austenitic stainless steel or a nonferrous alloy, which bears
    less of its tensile strength"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse coils that cannot be wound, and bends sharper than the wire."""
        super().__post_init__()
        if not self.wire.can_be_coiled:
            wire = shown(self.wire_diameter, "mm")
            limit = f"{INDEX_MIN:g} to {INDEX_MAX:g} times wire_diameter = {wire}"
            stated = shown(self.mean_diameter, "mm")
            raise InputError(f"{self.table}.mean_diameter", stated, limit)
        for name in ("hook_radius", "side_radius"):
            radius = getattr(self, name)
            if radius is not None and not radius > 0.5 * self.wire_diameter:
                limit = f"> {shown(0.5 * self.wire_diameter, 'mm')}, half of the wire"
                raise InputError(f"{self.table}.{name}", shown(radius, "mm"), limit)

    @property
    def wire(self) -> WoundWire[float]:
        """Its wire as wound, with the strength as drawn; hooks cannot be peened."""
        return WoundWire(
            wire_diameter=self.wire_diameter,
            mean_diameter=self.mean_diameter,
            coils=self.coils,
            shear_modulus=self.shear_modulus,
            strength_at_1mm=np.nan if self.tensile_strength is None else self.tensile_strength,
            strength_exponent=0.0,
            treatment="plain",
            **dict.fromkeys(("free_length", "end_factor", "density"), np.nan),
            **dict.fromkeys(("elastic_modulus", "temperature", "relaxation")),
        )

    @property
    def preload(self) -> float:
        """Force at zero lift, N."""
        return self.force

    @property
    def rate(self) -> float:
        """Force per extension, N/m."""
        return self.wire.rate

    @property
    def reach(self) -> float:
        """Travel up to which the law holds, m: beyond that of any arm."""
        return _ANY_TRAVEL

    def within(self, lift: Array) -> Rise:
        """Rise of a force that is linear in the lift."""
        return Rise.linear(lift)

    @property
    def bent(self) -> float:
        """Curvature factor K_A of the hook's bending: (4 C^2 - C - 1)/(4 C (C - 1)), C = 2 r/d."""
        radius = 0.5 * self.mean_diameter if self.hook_radius is None else self.hook_radius
        C = 2.0 * radius / self.wire_diameter
        return (4.0 * C**2 - C - 1.0) / (4.0 * C * (C - 1.0))

    @property
    def twisted(self) -> float:
        """Curvature factor K_B of the torsion in the bend from the coils to the hook: (4 C - 1)/(4
        C - 4), C = 2 r/d; NaN without the radius r of the bend.
        """
        if self.side_radius is None:
            return np.nan
        C = 2.0 * self.side_radius / self.wire_diameter
        return (4.0 * C - 1.0) / (4.0 * C - 4.0)

    def body_stress(self, force: ArrayLike) -> Array:
        """Shear stress (...) of the coils with the Wahl factor at a force, N, Pa."""
        return self.wire.stress(force)

    def hook_bending(self, force: ArrayLike) -> Array:
        """Normal stress (...) of the hook, F (K_A 16 D/(pi d^3) + 4/(pi d^2)), Pa."""
        d = self.wire_diameter
        per_newton = self.bent * 16.0 * self.mean_diameter / (np.pi * d**3) + 4.0 / (np.pi * d**2)
        return np.asarray(per_newton * np.asarray(force))

    def hook_torsion(self, force: ArrayLike) -> Array:
        """Shear stress (...) of the bend to the hook, K_B 8 D F/(pi d^3), Pa."""
        return np.asarray(self.twisted / self.wire.wahl_factor * self.wire.stress(force))

    def fatigue_use(self, least: Value, greatest: Value) -> Array:
        """Greatest utilisation (...) of the Goodman lines of coils, bend and hook; NaN without the
        radius of the bend.

        The torsion of coils and bend has the line of the wire; the bending of the hook has the
        tensile strength and the endurance of torsion over 0.577, or that of hooks, the lower.

        Parameters
        ----------
        least, greatest : array (...)   force of the spring over a cycle, N
        """
        wire, twist = self.wire, self.twisted / self.wire.wahl_factor
        if self.side_radius is None:
            return np.full_like(greatest, np.nan)
        twist = max(twist, 1.0)
        torsion = wire.fatigue_use(twist * least, twist * greatest)
        low, high = self.hook_bending(least), self.hook_bending(greatest)
        pulsating = 0.5 * _PULSATING_HOOK
        endurance = np.minimum(
            wire.fatigue_strengths[0] / DISTORTION_ENERGY,
            wire.tensile_strength * pulsating / (1.0 - pulsating),
        )
        bending = 0.5 * (high - low) / endurance + 0.5 * (high + low) / wire.tensile_strength
        worse = np.real(bending) > np.real(torsion)
        return np.asarray(np.where(worse, bending, torsion))

    @property
    def most_initial_tension(self) -> float:
        """Greatest initial tension that coiling gives, N: stress 231/e^(0.105 C) + 6.9 (4 -
        (C - 3)/6.5) MPa without correction factor.
        """
        C = self.wire.index
        stress = 231e6 / np.exp(0.105 * C) + 6.9e6 * (4.0 - (C - 3.0) / 6.5)
        return float(stress * np.pi * self.wire_diameter**3 / (8.0 * self.mean_diameter))


SHAPES: Mapping[str, type[SpringShape]] = MappingProxyType(
    {
        "gas": GasSpring,
        "torsion": TorsionSpring,
        "torsion_pivot": PivotSpring,
        "extension": ExtensionSpring,
    }
)
"""Tables of the kinds of spring that are no coils, by `spring.kind`."""
TABLES_OF_PARTS: Mapping[SpringPart, tuple[str, ...]] = MappingProxyType(
    {
        part: tuple(each.table for each in SHAPES.values() if each.part == part)
        for part in {each.part: None for each in SHAPES.values()}
    }
)
"""Tables that describe each of their parts, one in a case."""
