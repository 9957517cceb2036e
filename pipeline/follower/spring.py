"""Helical compression spring: force, stress, fatigue, solid length, buckling, surge."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, Value, finite
from camwright.geometry.energy import spring_deflection
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Length,
    Part,
    Pressure,
    Rate,
    Resolved,
    Share,
    SignedForce,
    TableSource,
    Temperature,
    Used,
    card_of,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.follower.spring_kinds import (
    SHAPES,
    TABLES_OF_PARTS,
    ActiveCoils,
    CoilDiameter,
    ExtensionSpring,
    GasSpring,
    PivotSpring,
    ShearModulus,
    SpringKind,
    SpringShape,
    TorsionSpring,
    WireDiameter,
    rise,
    shaped_deflection,
)
from camwright.pipeline.follower.spring_link import RockerSpring, SpringLink, linked
from camwright.pipeline.follower.wound_wire import (
    INDEX_MAX,
    INDEX_MIN,
    Number,
    SpringWork,
    Treatment,
    WoundWire,
)

NO_FORCE, _RATE_OF_NONE = 1e-6, 1e-2  # N, N/m, of a spring that stands in for none
DAMPING, LEAST_DAMPING = 0.01, 0.002  # ratio of the surge that a case does not state

WireModulus = Annotated[float, In("GPa", above=0, at_most=1e5)]
WireDensity = Annotated[float, In("kg/m^3", above=0, at_most=1e5)]
WireExponent = Annotated[float, In(at_least=0, below=1)]


class OfWork(Protocol):
    """Function of a wound spring and its operating range."""

    def __call__(self, wire: WoundWire[Number], work: SpringWork[Number], /) -> Value: ...


class OfWire(Protocol):
    """Function of a wound spring."""

    def __call__(self, wire: WoundWire[Number], /) -> Value: ...


@dataclass(frozen=True)
class WireLimit:
    """Limit of a wound spring in operation, shared by checks, catalogue and design.

    Parameters
    ----------
    words : str         of a spring beyond it
    demand : callable   wire, work -> demand, SI; NaN where the wire lacks a value
    allowed : callable  wire -> limit that the wire sets; None: set by its user
    at_least : bool     the demand must be at least the limit
    """

    words: str
    demand: OfWork
    allowed: OfWire | None = None
    at_least: bool = False

    def holds(
        self,
        wire: WoundWire[Number],
        work: SpringWork[Number],
        limit: Value | None = None,
        room: float = 1.0,
    ) -> NDArray[np.bool_]:
        """Whether springs (...) keep the limit; a demand of NaN does not.

        Parameters
        ----------
        wire : WoundWire        winding and strength
        work : SpringWork       operating range
        limit : (...) or None   where the wire sets none, SI
        room : float            factor on the limit

        Raises
        ------
        InputError
            If neither wire nor user sets the limit.
        """
        demand = self.demand(wire, work)
        allowed = limit if self.allowed is None else self.allowed(wire)
        if allowed is None:
            raise InputError(self.words, "no limit", "given")
        bound = room * allowed
        return np.asarray(demand >= bound if self.at_least else demand <= bound)


STRESS = WireLimit("shear stress", lambda wire, work: wire.static_use(work.greatest), lambda _: 1.0)
FATIGUE = WireLimit("fatigue", lambda wire, work: wire.fatigue_use(work.preload, work.greatest))
"""Utilisation of the Goodman line, against one over the safety factor."""
SOLID = WireLimit(
    "goes solid",
    lambda wire, work: wire.solid_clearance(work.preload, work.travel),
    at_least=True,
)
COIL_GAP = WireLimit(
    "gap between coils",
    lambda wire, work: wire.gap_left(work.preload, work.travel),
    lambda wire: wire.minimum_gaps,
    at_least=True,
)
SOLID_STRESS = WireLimit(
    "stress at solid length",
    lambda wire, work: wire.solid_stress(work.rate),
    lambda wire: wire.static_strength,
)
BUCKLING = WireLimit(
    "buckling",
    lambda wire, work: (wire.deflection(work.preload) + work.travel) / wire.buckling_deflection,
    lambda _: 1.0,
)
RELAXATION = WireLimit(
    "relaxation", lambda wire, work: wire.relaxed_preload(work.preload, work.greatest)
)
"""Against the tolerance of the preload."""


@dataclass(frozen=True, kw_only=True)
class HelicalSpring(WoundWire[float], Part):
    """Cylindrical compression spring of round wire with squared and ground ends.

    D/d, mean over wire diameter, is from 3 to 20. The seating coefficient of a pivoted and a fixed
    end is 0.7. The damping ratio is that of each mode of the surge. `name` is that of a catalogue.

    Raises
    ------
    InputError
        If a value is out of its bounds. The solid length under load is a check, see
        `solid_clearance`.
    """

    table: ClassVar[str] = "spring.design"
    labels: ClassVar[tuple[str, ...]] = ("name",)
    resolved: ClassVar[Mapping[str, Resolved]] = card_of(
        "card of the wire, which fills the keys left out", "wires.toml", "chrome_silicon"
    )
    defaults: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "elastic_modulus": "2.6 times the shear modulus: isotropic, Poisson ratio 0.3",
            "damping_ratio": "0.01 with an error bar down to 0.002: 0.002 to 0.02 without damper"
            " coil or friction insert, practice of valve springs (to be confirmed)",
        }
    )

    wire_diameter: Annotated[WireDiameter, Known("spring catalogue or drawing", "4 mm")]
    mean_diameter: Annotated[CoilDiameter, Known("spring catalogue or drawing", "30 mm")]
    coils: Annotated[ActiveCoils, Known("spring catalogue or drawing", 6.0)]
    free_length: Annotated[Length, Known("spring catalogue or drawing", "80 mm")]
    """length without load"""
    end_factor: Annotated[float, In(above=0, at_most=2), Known("EN 13906-1")] = 0.5
    """seating coefficient of buckling: 0.5 flat ends, 1 pivoted"""
    shear_modulus: Annotated[ShearModulus, Known("EN 10270; card of the wire", "79.5 GPa")]
    elastic_modulus: Annotated[
        WireModulus | None, Known("EN 10270; card of the wire", "206 GPa")
    ] = None
    """Young's modulus of the wire"""
    density: Annotated[WireDensity, Known("card of the wire", "7850 kg/m^3")]
    """density of the wire"""
    strength_at_1mm: Annotated[Pressure, Known("EN 10270; Shigley table 10-4", "1974 MPa")]
    """tensile strength of a wire of 1 mm: A of R_m = A (d / 1 mm)^-m"""
    strength_exponent: Annotated[WireExponent, Known("EN 10270; Shigley table 10-4", 0.108)]
    """m of R_m = A (d / 1 mm)^-m"""
    treatment: Annotated[Treatment, Known("spring drawing")] = "plain"
    """whether the wire is shot-peened"""
    damping_ratio: Annotated[
        float | None, In(at_least=1e-4, at_most=0.5), Known("measured; 0.002 to 0.02", 0.01)
    ] = None
    """damping of the surge of the coils"""
    temperature: Annotated[Temperature | None, Known("measured at the machine", "60 degC")] = None
    """temperature of the spring in operation"""
    relaxation: Annotated[Share | None, Known("maker's data, or EN 13906-1 annex A", 0.02)] = None
    """share of the greatest force lost in 48 h at the temperature of the spring"""
    source: TableSource = NO_SOURCE
    name: str = ""

    def __post_init__(self) -> None:
        """Refuse a spring that cannot be coiled, or is no longer than its solid length."""
        super().__post_init__()
        if not self.can_be_coiled:
            limit = (
                f"{INDEX_MIN:g} to {INDEX_MAX:g} times wire_diameter = "
                f"{shown(self.wire_diameter, 'mm')}: the range of coiling"
            )
            raise InputError("spring.design.mean_diameter", shown(self.mean_diameter, "mm"), limit)
        if not self.is_open:
            limit = f"> {shown(self.solid_length, 'mm')}, the solid length"
            raise InputError("spring.design.free_length", shown(self.free_length, "mm"), limit)

    @property
    def damping(self) -> float:
        """Damping ratio of each mode of the surge."""
        return DAMPING if self.damping_ratio is None else self.damping_ratio


@dataclass(frozen=True, kw_only=True)
class Spring(Part):
    """Spring of the follower, preloaded at zero lift; linear, or of another kind.

    The rate is that at zero lift, its tolerance that of the rise of the force. A gas or torsion
    spring, and one with a link, set rate and preload, which their case leaves out. All are those on
    the follower, of an arm on the arc of its reference point.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the tables are not those of the kind.
    """

    table: ClassVar[str] = "spring"
    resolved: ClassVar[Mapping[str, Resolved]] = {
        "catalogue": Resolved(
            "`shipped`, or a file name",
            "puts in the lightest spring of a catalogue that carries the load: `shipped`, or a"
            " file",
            Known("shipped, or catalogue of the maker", "shipped"),
        )
    }
    defaults: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "kind": "coil",
            "seat_height": "under guide B where the spring fits between the guides, else on the end"
            " of the stem above them",
            "seat_thickness": "at most half of the stem diameter",
        }
    )

    kind: Annotated[Literal["coil", SpringKind] | None, Known("own choice", "coil")] = None
    """coil; or gas, torsion, torsion_pivot or extension with the table of its name, from which rate
    and preload follow"""
    rate: Annotated[Rate, Known("spring catalogue or drawing", "24.2 kN/m")]
    """force per deflection"""
    preload: Annotated[SignedForce, Known("spring drawing", "242 N")]
    """force at zero lift; negative of a spring that pulls there, which a cam that pulls permits"""
    travel_max: Annotated[Length | None, Known("spring catalogue or drawing", "34 mm")] = None
    """greatest lift that the spring permits"""
    seat_height: Annotated[Length | None, Known("assembly drawing", "120 mm")] = None
    """height of the moving seat of a coil spring, where the coils rest, or of the pin of a torsion
    spring, over roller centre or face"""
    seat_thickness: Annotated[Length | None, Known("drawing of the seat", "4 mm")] = None
    """thickness of the moving seat of a coil spring"""
    rate_tolerance: Annotated[float, In(above=0, below=1), Known("EN 15800, or drawing")] = 0.05
    """relative tolerance of the rate"""
    preload_tolerance: Annotated[float, In(above=0, below=1), Known("EN 15800, or drawing")] = 0.05
    """relative tolerance of the preload"""
    design: Annotated[HelicalSpring | None, Used("checks of the spring, speed sweep")] = None
    """geometry and wire of the spring"""
    gas: Annotated[GasSpring | None, Used("lift, cycle, checks of the spring")] = None
    """gas spring, of `kind` gas"""
    torsion: Annotated[TorsionSpring | None, Used("lift, cycle, checks of the spring")] = None
    """torsion spring whose arm presses on the follower, of `kind` torsion"""
    torsion_pivot: Annotated[PivotSpring | None, Used("lift, cycle, checks of the spring")] = None
    """torsion spring about the pivot of an arm, of `kind` torsion_pivot"""
    extension: Annotated[ExtensionSpring | None, Used("lift, cycle, checks of the spring")] = None
    """extension spring with hooks that pulls an arm, of `kind` extension with `link`"""
    link: Annotated[SpringLink | None, Used("lift, cycle, checks of the spring")] = None
    """ends of a coil or gas spring on the arm of an oscillating follower; rate and preload
    follow"""
    rocker: Annotated[RockerSpring | None, Used("lift, cycle, checks of the spring")] = None
    """coil or gas spring on the output of `[rocker]`; rate and preload follow"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse tables that are not those of the kind of spring, and a link that this kind cannot
        have.
        """
        super().__post_init__()
        kind = self.kind or "coil"
        for name, owner in (*zip(SHAPES, SHAPES, strict=True), ("design", "coil")):
            stated = getattr(self, name) is not None
            if stated and kind != owner:
                limit = f'left out with spring.kind = "{kind}"'
                if self.kind is None:
                    limit = f'left out, or spring.kind = "{owner}"'
                raise InputError(f"spring.{name}", "a table", limit)
            if kind == owner and not stated and name != "design":
                raise InputError(f"spring.{name}", "missing", f'given with spring.kind = "{kind}"')
        if self.linked is None:
            return
        if kind in SHAPES and not SHAPES[kind].linkable:
            limit = f'left out with spring.kind = "{kind}"'
            raise InputError(self.linked.table, "a table", limit)
        if self.link is not None and self.rocker is not None:
            raise InputError("spring.rocker", "a table", "left out with spring.link")
        if self.linked.action == "pull" and self.design is not None:
            limit = "left out with spring.link.action = pull: describe [spring.extension]"
            raise InputError("spring.design", "a table", limit)

    @cached_property
    def shape(self) -> SpringShape | None:
        """Rise of the force over the lift; None: linear."""
        return self._shape if self.linked is None else linked(self.linked, self._shape)

    @property
    def linked(self) -> SpringLink | RockerSpring | None:
        """Table of what is between spring and follower; None: nothing."""
        return self.link or self.rocker

    @property
    def _shape(self) -> SpringShape | None:
        """The table of its kind; None of a coil."""
        kind = self.kind or "coil"
        shape: SpringShape | None = getattr(self, kind) if kind in SHAPES else None
        return shape

    @property
    def lever_at_rest(self) -> float:
        """Travel of its ends per lift, at zero lift."""
        return float(lever(self.shape, 0.0))

    @property
    def own(self) -> Spring:
        """The spring at its own ends, with rate and preload over their travel; itself without a
        link.
        """
        shape = self.shape
        if self.linked is None or shape is None:
            return self
        preload = self.preload / self.lever_at_rest
        rate = float(self.rate * shape.own_share)
        return replace(self, link=None, rocker=None, rate=rate, preload=preload)

    def on_arm(self, length: float | None, rocker: Rocker | None = None) -> Spring:
        """Spring as it acts on the follower, on the arc at the length of an arm or along a stem.

        Parameters
        ----------
        length : float    of the arm, m; None: on a stem
        rocker : Rocker   behind which the spring may stand; None: none

        Raises
        ------
        InputError
            If it is that of a stem on an arm, that of an arm on a stem, or that of a rocker without
            one or with lash.
        """
        shape = self.shape
        if shape is None:
            return self
        if shape.carried not in ("", "stem" if length is None else "arm"):
            limit = f"left out {'unless' if length is None else 'with'}"
            limit += ' follower.kind = "oscillating"'
            raise InputError(shape.table, "a table", limit)
        fitted = shape.on_arm(length, rocker)
        if fitted is shape:
            return self
        stated = {fitted.stated.table.removeprefix("spring."): fitted.stated}
        return replace(self, **stated).with_derived()  # type: ignore[arg-type]

    @property
    def absent(self) -> bool:
        """Whether it stands in for no spring, which form closure does without."""
        return bool(of_no_force(self.preload, self.rate))

    @property
    def parts(self) -> dict[str, Part | None]:
        """Table of each part of the spring that `[scope]` names; None where the case does not have
        it.
        """
        parts: dict[str, Part | None] = {"spring": self.design}
        stated = {kind: getattr(self, kind) for kind in SHAPES}
        parts |= dict.fromkeys(TABLES_OF_PARTS)
        return parts | {each.part: each for each in stated.values() if each is not None}

    @property
    def preload_key(self) -> str:
        """Dotted key that states the force at zero lift with its sign, see `SpringShape`."""
        return "spring.preload" if self.shape is None else self.shape.preload_key

    @property
    def derived(self) -> tuple[str, ...]:
        """Fields derived from others, which a case omits."""
        return () if self.shape is None else ("rate", "preload")

    def with_derived(self) -> Spring:
        """Spring with rate and preload of its gas or torsion spring, or by its link."""
        shape = self.shape
        return (
            self
            if shape is None
            else replace(self, rate=float(shape.rate), preload=float(shape.preload))
        )

    def force(self, lift: Array) -> Array:
        """Force at a lift (...), m, in N."""
        return spring_force(self.preload, self.rate, lift, self.shape)

    def stiffness(self, lift: Array) -> Array:
        """Slope of the force over the lift (...), N/m."""
        if self.shape is None:
            return self.rate + 0.0 * lift
        return np.asarray(self.rate * rise(self.shape, lift).slope)

    def energy(self, lift: float) -> float:
        """Energy stored from zero lift to a lift, m, J."""
        return float(spring_energy(self.preload, self.rate, np.asarray(lift), self.shape))


def of_no_force(preload: ArrayLike, rate: ArrayLike) -> NDArray[np.bool_]:
    """Whether springs (...) stand in for none; preload, N, and rate, N/m, at zero lift."""
    none = np.abs(np.real(preload)) <= NO_FORCE
    return np.asarray(none & (np.real(rate) <= _RATE_OF_NONE))


def spring_force(
    preload: float | Array, rate: float | Array, lift: Array, shape: SpringShape | None = None
) -> Array:
    """Spring force P + k s (...), N, at a lift (...), m; for a shape P + k rho(s)."""
    return np.asarray(preload + rate * (lift if shape is None else rise(shape, lift).travel))


def spring_energy(
    preload: Value, rate: Value, lift: ArrayLike, shape: SpringShape | None = None
) -> Array:
    """Energy of the spring above that at zero lift (...), J: P s + k s^2 / 2, or P s + k R(s) for a
    shape.

    Parameters
    ----------
    preload : (...)       P, N
    rate : (...)          k, N/m, at zero lift
    lift : array (...)    s, m
    shape : SpringShape   law of the force; None: linear
    """
    at = np.asarray(lift, dtype=float)
    if shape is None:
        return np.asarray(preload * at + 0.5 * rate * at**2)
    return np.asarray(preload * at + rate * rise(shape, at).work)


def end_travel(shape: SpringShape | None, lift: Value) -> Value:
    """Travel (...) of the ends of a spring at a lift, m; of a linear one the lift."""
    return lift if shape is None else shape.end_travel(lift)


def lever(shape: SpringShape | None, lift: Value) -> Value:
    """Force on the follower over that of the spring (...) at a lift, m."""
    return 1.0 if shape is None else shape.lever(lift)


def stored_lift(
    energy: ArrayLike, rate: ArrayLike, preload: ArrayLike, shape: SpringShape | None = None
) -> Array:
    """Lift (...), m, at which the spring has stored an energy above zero lift, J, >= 0."""
    if shape is None:
        return spring_deflection(energy, rate, preload)
    return shaped_deflection(energy, rate, preload, shape)


def surge_harmonics(lift_values: Array, ratio: float, share: float = 0.01) -> tuple[int, float]:
    """Highest significant harmonic of the lift acceleration, and its margin to surge.

    Parameters
    ----------
    lift_values : array (n,)   at equal angles, m
    ratio : float              natural frequency over rotational frequency of the cam
    share : float              share of the largest harmonic above which one is significant

    Returns
    -------
    highest : int         order of the highest significant harmonic
    margin : float        natural frequency over that of the highest significant harmonic
    """
    harmonics = np.abs(np.fft.rfft(finite("lift", lift_values)))
    order = np.arange(harmonics.size)
    acceleration = harmonics * order**2
    strong = np.flatnonzero(acceleration >= share * max(acceleration.max(), 1e-300))
    highest = int(strong[-1]) if acceleration.max() > 0.0 else 0
    return highest, ratio / highest if highest else np.inf


def greatest_active_mass(rate: float, frequency: float) -> float:
    """Mass of the active coils, kg, by rate, N/m, and natural frequency, Hz."""
    return rate / (2.0 * frequency) ** 2


@dataclass(frozen=True, eq=False)
class DynamicStiffness:
    """Dynamic stiffness of the coils less the rate, at moving and at fixed end, N/m.

    phase (...): phi of the waves along the coils; 0 at rest.
    """

    rate: float
    phase: NDArray[np.complex128]

    @cached_property
    def _decay(self) -> NDArray[np.complex128]:
        return np.exp(-1.0j * self._moved)  # at most 1 in size

    @cached_property
    def _moved(self) -> NDArray[np.complex128]:
        return np.where(self.phase == 0.0, 1.0, self.phase)

    @property
    def moving(self) -> NDArray[np.complex128]:
        """Complex dynamic stiffness at the moving end (...), force there per its motion, less the
        rate, N/m.
        """
        if not self.phase.any():
            return np.zeros_like(self.phase)
        square, over_rate = self._decay**2, 1.0j * self._moved
        over_rate *= 1.0 + square
        over_rate /= 1.0 - square
        return self._known(over_rate)

    @property
    def fixed(self) -> NDArray[np.complex128]:
        """Complex dynamic transfer stiffness (...), force at the fixed end per motion of the moving
        one, less the rate, N/m.
        """
        if not self.phase.any():
            return np.zeros_like(self.phase)
        over_rate = 2.0j * self._moved
        over_rate *= self._decay
        over_rate /= 1.0 - self._decay**2
        return self._known(over_rate)

    def _known(self, over_rate: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """Dynamic stiffness less the rate (...), N/m, zero at rest; the argument is changed in
        place.

        Parameters
        ----------
        over_rate : complex array (...)   dynamic stiffness over the rate
        """
        over_rate -= 1.0
        over_rate *= self.rate
        over_rate[self.phase == 0.0] = 0.0
        return over_rate


def dynamic_stiffness(
    drive: ArrayLike, rate: float, frequency: float, damping: float
) -> DynamicStiffness:
    """Dynamic stiffness (...) of the waves in the coils, less the rate.

    One end moves harmonically, the other is fixed. The coils obey the wave equation with structural
    damping, which gives each mode the same damping ratio; the forces less the static one are
    k (phi cot phi - 1) and k (phi / sin phi - 1) per displacement, with
    phi = pi w / w_1 sqrt(1 - 2 i zeta).

    Parameters
    ----------
    drive : array (...)   w, rad/s, >= 0
    rate : float          k, N/m
    frequency : float     of the first mode between fixed ends, Hz
    damping : float       damping ratio zeta of each mode, > 0

    References
    ----------
    Norton, Cam Design and Manufacturing Handbook (2009), ch. 15: spring surge; waves in a bar,
    one end fixed, Timoshenko, Vibration Problems in Engineering.
    """
    w = finite("drive", drive)
    phi = 0.5 * w / frequency * np.sqrt(1.0 - 2.0j * damping)
    return DynamicStiffness(rate, phi)


def surge_force(
    lift_values: Array, cam_speed: float, rate: float, frequency: float, damping: float
) -> Array:
    """Dynamic force of surge at the moving end of the spring, (n,), N.

    Parameters
    ----------
    lift_values : array (n,)   at equal angles of one turn, m
    cam_speed : float          rad/s
    rate : float               of the spring, N/m
    frequency : float          of the first mode between fixed ends, Hz
    damping : float            damping ratio of each mode, > 0
    """
    spectrum = np.fft.rfft(finite("lift", lift_values))
    drive = np.arange(spectrum.size) * cam_speed
    moving = dynamic_stiffness(drive, rate, frequency, damping).moving
    return np.fft.irfft(moving * spectrum, len(lift_values))
