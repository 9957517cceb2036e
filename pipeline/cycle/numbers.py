"""Numbers of a machine by dotted key: nominal, at corners, by load case, or of many designs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import partial
from typing import TypeVar

import numpy as np

from camwright.geometry.arrays import Value
from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Part
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import value_of
from camwright.pipeline.case.limits import AnyLimit
from camwright.pipeline.contact.cam_body import SECOND_BEARING, WAVES
from camwright.pipeline.contact.rolling_bearing import Bearing
from camwright.pipeline.contact.shrink_fit import FittedRing, slip_torque
from camwright.pipeline.contact.traction import ring_inertia
from camwright.pipeline.follower.bearing_life import contamination_factor
from camwright.pipeline.follower.guide_friction import friction_limits
from camwright.pipeline.follower.pivot_forces import FRICTION
from camwright.pipeline.follower.spring_kinds import SpringShape

P = TypeVar("P", bound=Part)
_OF_SHAPE = (
    "follower.arm.length",
    *(f"spring.link.{name}" for name in ("arm_radius", "arm_angle", "fixed_radius", "fixed_angle")),
    *(f"spring.link.{name}" for name in ("rate", "preload")),
)
"""Keys by which springs on arms differ."""


@dataclass(frozen=True, eq=False)
class Numbers:
    """Numbers by dotted key, SI: floats, or arrays (..., 1), real or complex.

    Parameters
    ----------
    changed : mapping   those that differ from the case or do not follow as in `DERIVED`, or that no
                        single key of a case states, such as ``cam.speed``
    case : Case         None: no others are known
    """

    changed: Mapping[str, Value | None]
    case: Case | None = None
    _read: dict[str, Value | None] = field(default_factory=dict, repr=False)
    _figures: dict[object, tuple[tuple[Value | None, ...], tuple[Value, ...]]] = field(
        default_factory=dict, repr=False
    )
    _shapes: list[tuple[tuple[Value | None, ...], SpringShape]] = field(
        default_factory=list, repr=False
    )

    def get(self, key: str) -> Value | None:
        """Value at a dotted key, SI: as changed, else as it follows from others in `DERIVED`, else
        of the case; None where none of them has it.
        """
        if key in self.changed:
            return self.changed[key]
        if key in DERIVED:
            return DERIVED[key](self)
        if key not in self._read:
            self._read[key] = None if self.case is None else value_of(self.case, key)
        return self._read[key]

    def __getitem__(self, key: str) -> Value:
        """Value at a key.

        Raises
        ------
        InputError
            If there is none.
        """
        value = self.get(key)
        if value is None:
            raise InputError(key, "missing", "given")
        return value

    def limit(self, row: AnyLimit) -> Value:
        """Value of a row of the table of limits.

        Raises
        ------
        InputError
            If there is none.
        """
        return self[f"limits.{row.id}"]

    @property
    def known_case(self) -> Case:
        """Case of the numbers.

        Raises
        ------
        InputError
            If there is none.
        """
        if self.case is None:
            raise InputError("case", "missing", "known, to read what is no number")
        return self.case

    def each(
        self, figures: Callable[[Numbers], Sequence[Value]], keys: Sequence[str], most: int = 0
    ) -> tuple[Value, ...]:
        """Figures of a part from the numbers of its machine; of many designs arrays (m, 1), m
        designs, made once for each different set of the numbers at `keys`.

        They are kept and serve all checks and load cases of these numbers.

        Parameters
        ----------
        figures : function       figures of one machine, which depend on its case and the numbers at
            `keys` alone
        keys : sequence of str   dotted keys of the numbers that vary
        most : int               different sets up to which they are made, NaN for all beyond; 0:
            any number
        """
        values = tuple(self.get(key) for key in keys)
        cached = self._figures.get(figures)
        if cached is None or any(a is not b for a, b in zip(cached[0], values, strict=True)):
            cached = values, self._each(figures, dict(zip(keys, values, strict=True)), most)
            self._figures[figures] = cached
        return cached[1]

    def _each(
        self,
        figures: Callable[[Numbers], Sequence[Value]],
        values: Mapping[str, Value | None],
        most: int,
    ) -> tuple[Value, ...]:
        """Figures of `each` made for each different row of the values, (m, 1) each; as floats where
        no value is an array.

        Parameters
        ----------
        values : mapping   numbers by key; arrays (m, 1) of m designs
        most : int         different rows up to which they are made, NaN for all beyond; 0: any
            number
        """
        arrays = {key: each for key, each in values.items() if isinstance(each, np.ndarray)}
        if not arrays:
            return tuple(figures(self))
        rows = np.concatenate(np.broadcast_arrays(*arrays.values()), axis=-1)
        distinct, member = np.unique(rows, axis=0, return_inverse=True)
        few = len(distinct) <= most or not most
        solved = distinct[: None if few else 1].tolist()
        evaluated = np.array(
            [figures(self | dict(zip(arrays, row, strict=True))) for row in solved]
        )
        of_each = (
            evaluated[member.ravel()] if few else np.full((len(rows), evaluated.shape[-1]), np.nan)
        )
        return tuple(of_each.T[..., None])

    def of_part(self, part: P, table: str = "") -> P:
        """Part of a case with those of its numbers that differ from it; of many designs arrays.

        table: dotted key of the part; "": its own.
        """
        named = {f"{table or part.table}.{each.name}": each.name for each in fields(part)}  # type: ignore[arg-type]
        changed = {name: self.changed[key] for key, name in named.items() if key in self.changed}
        return part.of_many(changed) if changed else part

    @property
    def spring_shape(self) -> SpringShape | None:
        """Force rise of a nonlinear spring, of many designs by their links and arms; None for a
        linear one.
        """
        shape = None if self.case is None else self.case.spring.shape
        if shape is None or not any(key in self.changed for key in _OF_SHAPE):
            return shape
        values = tuple(self.get(key) for key in _OF_SHAPE)
        cached = self._shapes
        if not cached or any(a is not b for a, b in zip(cached[0][0], values, strict=True)):
            table = self.of_part(shape.stated)
            if "length" in table.labels:
                table = table.of_many({"length": self["follower.arm.length"]})
            cached[:] = [(values, shape.with_stated(table))]
        return cached[0][1]

    def __or__(self, changed: Mapping[str, Value | None]) -> Numbers:
        """With other numbers; what is read from the case is read once."""
        stored = self._read, self._figures, self._shapes
        return Numbers({**self.changed, **changed}, self.case, *stored)


def _greatest_friction(guide: str, numbers: Numbers) -> Value:
    """Maximum friction coefficient of a guide."""
    return _friction_max(
        numbers[f"{guide}.friction"], numbers.get(f"{guide}.friction_max"), numbers
    )


def _friction_max(nominal: Value, stated: Value | None, numbers: Numbers) -> Value:
    """Maximum friction coefficient: as stated, else the nominal one with the tolerance."""
    return friction_limits(nominal, None, stated, numbers["tolerances.friction"])[1]


def _of_pivot(name: str, numbers: Numbers) -> Value | None:
    """Number of the bearing of a pivot, bush or needle bearing; None without one."""
    bush = numbers.get(f"follower.pivot.bush.{name}")
    return numbers.get(f"follower.pivot.needle_bearing.{name}") if bush is None else bush


def _pivot_friction(numbers: Numbers) -> Value | None:
    """Maximum friction coefficient of a pivot: as stated, else the nominal one with the tolerance;
    None without a nominal one.
    """
    nominal = numbers.get(FRICTION)
    if nominal is None:
        return None
    return _friction_max(nominal, _of_pivot("friction_max", numbers), numbers)


def _area(guide: str, numbers: Numbers) -> Value:
    """Projected area of a guide, m^2."""
    return numbers[f"{guide}.length"] * numbers[f"{guide}.diameter"]


def _mouth(numbers: Numbers) -> Value:
    """End of guide A over the reference point of the follower at maximum lift, m."""
    return numbers["follower.overhang_at_max_lift"] - 0.5 * numbers["guides.a.length"]


def _extent(numbers: Numbers) -> Value:
    """Extent of the follower, with its fork, from its reference point towards guide A, m."""
    thickness = numbers.get("follower.face.thickness")
    if thickness is not None:
        return thickness
    radius = numbers["roller.radius"]
    cheek, bridge = (numbers.get(f"roller.fork.{name}_length") for name in ("cheek", "bridge"))
    return radius if cheek is None or bridge is None else np.maximum(radius, cheek + bridge)


def _half_depth(numbers: Numbers) -> Value:
    """Half of the width of the follower along the cam axis, m, with pin and fork where they are
    described.
    """
    depth = numbers.get("follower.face.depth")
    if depth is not None:
        return 0.5 * depth
    half, roller = 0.5 * numbers["roller.width"], numbers.known_case.roller
    if roller.pin is None or roller.fork is None:
        return half
    return np.maximum(half, roller.fork.faces(roller.pin)[1])


def _half_flat(numbers: Numbers) -> Value:
    """Half of the width of a face, m; 0 of a roller."""
    width = numbers.get("follower.face.width")
    return 0.0 if width is None else 0.5 * width


def _round(numbers: Numbers) -> Value:
    """Radius of roller or cheeks about the pin, the greater, or of a face, m; 0 of a flat one."""
    height = numbers.get("roller.fork.cheek_height")
    return np.maximum(numbers["follower.surface"], 0.5 * (height or 0.0))


def _surface(numbers: Numbers) -> Value:
    """Radius of the surface of roller or curved face, m; 0 of a flat face."""
    radius = numbers.get("follower.face.radius")
    if radius is None and numbers.get("follower.face.width") is None:
        return numbers["roller.radius"]
    return 0.0 if radius is None else radius


def _size(numbers: Numbers) -> Value:
    """Roller radius, or half of the width of a face, m: scale of a gap."""
    width = numbers.get("follower.face.width")
    return numbers["roller.radius"] if width is None else 0.5 * width


def _ball_circle(numbers: Numbers) -> Value | None:
    """Pitch diameter of the balls, m: of the bearing, else of its ring; None where neither is
    stated.
    """
    stated: Value | None = None
    if numbers.case is not None:
        stated = value_of(numbers.case, "roller.bearing.pitch_diameter")
    return numbers.get("roller.bearing.ring.pitch_diameter") if stated is None else stated


def _bearing(table: str, numbers: Numbers) -> Bearing | None:
    """Bearing of a roller by its table; None where the case has none there."""
    return None if numbers.case is None else numbers.case.bearings.get(table)


def _of_second(name: str, field: str, numbers: Numbers) -> Value | None:
    """Number of the bearing of a second roller on the pin of the first, by its key; field: of its
    own bearing.
    """
    bearing = _bearing(SECOND_BEARING, numbers)
    if bearing is None:
        return numbers.get(f"{Bearing.table}.{name}")
    stated: Value | None = getattr(bearing, field)
    return stated


def _cleanliness_load(table: str, numbers: Numbers) -> Value | None:
    """Contamination factor times fatigue load limit of the bearing of a roller, e_C P_u, N; None
    unless cleanliness, fatigue load limit and pitch diameter are known.
    """
    bearing = _bearing(table, numbers) or _bearing(Bearing.table, numbers)
    limit, circle = (
        numbers.get(f"{table}.{name}") for name in ("fatigue_load_limit", "pitch_diameter")
    )
    if bearing is None or bearing.contamination is None or limit is None or circle is None:
        return None
    return limit * contamination_factor(bearing.contamination, float(circle))


def _waviness(numbers: Numbers) -> Value | None:
    """Height of the waves of the track, m: stated, else usual for the process, at most the profile
    tolerance; None where neither height nor tolerance is stated.
    """
    stated, band = numbers.get("cam.waviness_height"), numbers.get("cam.profile_tolerance")
    if stated is not None or band is None:
        return stated
    process = numbers.known_case.cam.process
    return np.minimum(WAVES[process] * numbers["cam.waviness_length"], band)


def _rotor_inertia(numbers: Numbers) -> Value | None:
    """Moment of inertia of the roller, kg m2; see `Roller.rotor_inertia`."""
    stated, radius = numbers.get("roller.inertia"), numbers.get("roller.radius")
    if stated is not None or radius is None or numbers.case is None:
        return stated
    roller = numbers.case.roller
    width, density = numbers["roller.width"], roller.material.density
    return ring_inertia(radius, roller.hub_radius, width, density)


def _outer_radius(numbers: Numbers) -> Value | None:
    """Radius of the roller on the outer wall of a groove, m: of the second, else of the first."""
    stated = None if numbers.case is None else value_of(numbers.case, "cam.groove.second.radius")
    return numbers.get("roller.radius") if stated is None else stated


def base_radii(numbers: Numbers) -> tuple[Value, Value]:
    """Radii of the base circles of the first disc and of a second, else of the first again, m."""
    first: Value = numbers["cam.prime_radius"] - numbers["follower.surface"]
    second = numbers.get("cam.second_base_radius")
    return first, first if second is None else second


def fitted_ring(numbers: Numbers, *, thick: bool = False) -> FittedRing | None:
    """Cam on its shaft as a ring of its least radius, of two discs the lesser, or, if `thick`, of
    that and the travel of the spring, a bound of its greatest; None without a fit.

    None without the material of the camshaft, too. The least radius has the lower pressure and,
    of one interference, the greater hoop stress.
    """
    case = numbers.case
    if case is None or case.cam.fit is None or case.camshaft is None:
        return None
    shaft, outer = case.camshaft.material, np.minimum(*base_radii(numbers))
    if shaft is None:
        return None
    if thick:
        disc = disc_radius(numbers)
        outer = outer + numbers["spring.travel_max"] if disc is None else disc
    return FittedRing(numbers["cam.bore_radius"], outer, case.cam.material, shaft)


def disc_radius(numbers: Numbers) -> Value | None:
    """Radius of the disc around a groove, or greatest of the contours of a cam that no coil spring
    closes, m; None of another cam, whose contour has it.
    """
    stated, of_discs = (
        numbers.get(key) for key in ("cam.groove.outer_radius", "cam.greatest_radius")
    )
    return of_discs if stated is None else stated


def least_interference(numbers: Numbers) -> Value | None:
    """Least radial interference at rest, m, cold or in operation; None without a fit."""
    return _interference(numbers, "least")


def greatest_interference(numbers: Numbers) -> Value | None:
    """Greatest radial interference at rest, m, cold or in operation; None without a fit."""
    return _interference(numbers, "greatest")


def presses(numbers: Numbers) -> bool:
    """Whether the fit can have an interference."""
    greatest = greatest_interference(numbers)
    return greatest is not None and bool(np.any(np.asarray(greatest) > 0.0))


def _interference(numbers: Numbers, end: str) -> Value | None:
    """Interference of the fit at its `end`, "least" or "greatest", of the radius, m, with the
    growth by temperatures; None without a fit.
    """
    ring, case = fitted_ring(numbers), numbers.case
    if ring is None or case is None or case.cam.fit is None:
        return None
    grown = case.cam.fit.growth(ring.radius, ring.cam, ring.shaft)
    worse = np.minimum(grown, 0.0) if end == "least" else np.maximum(grown, 0.0)
    return 0.5 * numbers[f"cam.fit.{end}_interference"] + worse


def _least_fit_pressure(numbers: Numbers) -> Value | None:
    """Least pressure of the fit, Pa: at the least interference and the greatest cam speed; None
    without a fit.
    """
    ring, wide = fitted_ring(numbers), fitted_ring(numbers, thick=True)
    least = least_interference(numbers)
    if ring is None or wide is None or least is None:
        return None
    fastest = numbers.get("cam.fastest")
    return ring.pressure(least, 0.0 if fastest is None else fastest, wide.outer)


def _greatest_fit_pressure(numbers: Numbers) -> Value | None:
    """Greatest pressure of the fit, Pa: at standstill."""
    wide, greatest = fitted_ring(numbers, thick=True), greatest_interference(numbers)
    return None if wide is None or greatest is None else wide.pressure(greatest)


def _slip_torque(numbers: Numbers) -> Value | None:
    """Torque at which the cam slips on its seat, N m: stated, or by the least pressure of the fit;
    None where neither is known.
    """
    case = numbers.case
    stated = None if case is None else value_of(case, "camshaft.slip_torque")
    if stated is not None or case is None or case.cam.fit is None:
        return stated
    pressure = numbers.get("cam.fit.least_pressure")
    if pressure is None:
        return None
    radius, width = numbers["cam.bore_radius"], numbers["cam.width"]
    return slip_torque(pressure, radius, width, float(numbers["cam.fit.friction"]))


def _link_body(numbers: Numbers) -> Value | None:
    """Outer diameter of a spring between arm and fixed point, m, as stated, else of its coils; None
    where it is not known, and without such a spring.
    """
    stated = numbers.get("spring.link.diameter")
    if stated is not None or numbers.get("spring.link.arm_radius") is None:
        return stated
    for table in ("spring.design", "spring.extension"):
        mean, wire = (numbers.get(f"{table}.{key}_diameter") for key in ("mean", "wire"))
        if mean is not None and wire is not None:
            return mean + wire
    return None


DERIVED: Mapping[str, Callable[[Numbers], Value | None]] = {
    "guides.a.friction_greatest": partial(_greatest_friction, "guides.a"),
    "guides.b.friction_greatest": partial(_greatest_friction, "guides.b"),
    FRICTION: partial(_of_pivot, "friction"),
    f"{FRICTION}_greatest": _pivot_friction,
    "follower.pivot.diameter": partial(_of_pivot, "diameter"),
    "follower.pivot.bush.area": partial(_area, "follower.pivot.bush"),
    "guides.a.area": partial(_area, "guides.a"),
    "guides.b.area": partial(_area, "guides.b"),
    "cam.fit.least_pressure": _least_fit_pressure,
    "cam.fit.greatest_pressure": _greatest_fit_pressure,
    "camshaft.slip_torque": _slip_torque,
    "guides.a.mouth": _mouth,
    "follower.extent": _extent,
    "follower.half_depth": _half_depth,
    "follower.half_flat": _half_flat,
    "follower.round": _round,
    "follower.surface": _surface,
    "follower.size": _size,
    "cam.waviness": _waviness,
    "roller.rotor_inertia": _rotor_inertia,
    "cam.groove.second.radius": _outer_radius,
    **{
        f"{SECOND_BEARING}.{each}": partial(_of_second, each, each)
        for each in (
            *("C", "C0", "radial_limit", "static_radial_limit", "fatigue_load_limit"),
            *("speed_limit", "viscosity", "contamination", "temperature"),
        )
    },
    f"{SECOND_BEARING}.pitch_diameter": partial(_of_second, "pitch_diameter", "ball_circle"),
    "spring.link.body": _link_body,
    "roller.bearing.pitch_diameter": _ball_circle,
    **{
        f"{table}.cleanliness_load": partial(_cleanliness_load, table)
        for table in (Bearing.table, SECOND_BEARING)
    },
}
"""Numbers that follow from others, unless they are stated themselves."""
