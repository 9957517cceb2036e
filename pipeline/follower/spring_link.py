"""Coil or gas spring between a point of an arm and a fixed point, or on a rocker: its lever."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import Annotated, ClassVar, Literal, Self

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.geometry.rocker_lift import RockerLinkage
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Length,
    Part,
    Rate,
    SignedForce,
    TableSource,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.follower.rocker import UNIFORM, Rocker
from camwright.pipeline.follower.spring_kinds import Rise, SpringShape, rise

_PLACES, _ROUNDS = 513, 5
"""Angles at which the slope of the force is tried, and rounds between two of them."""

_OF_GAS = MappingProxyType({"rate": "of `spring.gas`", "preload": "of `spring.gas`"})
EndAngle = Annotated[float, In("deg", at_least=-180, at_most=180)]


@dataclass(frozen=True, kw_only=True)
class SpringLink(Part):
    """Ends of a spring on the arm of an oscillating follower, and the rate of a coil spring.

    Both ends are stated in polar coordinates about the pivot. Angles are from the arm, the line
    from the pivot to the reference point, at zero lift, positive in the sense of the outward swing.
    So the spring is as far compressed at zero lift on a cam of any size.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the spring has no lever at zero lift that brings the
        follower to the cam.
    """

    table: ClassVar[str] = "spring.link"
    labels: ClassVar[tuple[str, ...]] = ("length",)
    defaults: ClassVar[Mapping[str, str]] = _OF_GAS

    arm_radius: Annotated[Length, Known("drawing", "60 mm")]
    """distance of the end on the arm from the pivot"""
    fixed_radius: Annotated[Length, Known("drawing", "90 mm")]
    """distance of the fixed end from the pivot"""
    fixed_angle: Annotated[EndAngle, Known("drawing", "70 deg")]
    """angle at the pivot from the arm at zero lift to the fixed end, positive outwards: ahead of
    the outward swing for a spring that pushes, behind it for one that pulls"""
    arm_angle: Annotated[EndAngle, Known("drawing", "0 deg")] = 0.0
    """angle at the pivot from the arm to the end on it, positive outwards"""
    action: Annotated[Literal["push", "pull"], Known("drawing", "push")] = "push"
    """whether the spring pushes its ends apart, or pulls them together"""
    rate: Annotated[Rate | None, Known("spring catalogue or drawing", "24.2 kN/m")] = None
    """force of a coil spring per travel of its ends"""
    preload: Annotated[SignedForce | None, Known("spring drawing", "242 N")] = None
    """force of a coil spring at zero lift; negative against its `action`, which a cam that pulls
    permits"""
    diameter: Annotated[Length | None, Known("spring drawing, or data sheet", "28 mm")] = None
    """greatest diameter of the spring's body; of coils that are described theirs"""
    plane_offset: Annotated[float, In("mm", at_least=0, at_most=1000), Known("drawing", "0 mm")] = (
        0.0
    )
    """distance of the spring's axis from the middle of the cam along the cam axis, for the gaps
    alone: the arm is not judged under its moment"""
    source: TableSource = NO_SOURCE
    length: float = np.nan

    def __post_init__(self) -> None:
        """Refuse ends between which the spring does not bring the follower to the cam at zero
        lift.
        """
        super().__post_init__()
        if not self.sense * np.sin(self.between) < 0.0:
            ends = (0.0, np.pi) if self.action == "push" else (-np.pi, 0.0)
            low, high = (shown(self.arm_angle + each, "deg") for each in ends)
            limit = f"> {low} and < {high}: the spring brings the follower to the cam"
            raise InputError(f"{self.table}.fixed_angle", shown(self.fixed_angle, "deg"), limit)

    @property
    def notes(self) -> tuple[str, ...]:
        """Note on the drawing of the cam, of the ends of the spring."""
        arm, fixed = (
            f"{shown(radius, 'mm')} from the pivot at {shown(angle, 'deg', 4)}"
            for radius, angle in (
                (self.arm_radius, self.arm_angle), (self.fixed_radius, self.fixed_angle)
            )
        )  # fmt: skip
        acts = "pulls" if self.action == "pull" else "pushes"
        return (
            f"spring that {acts} between the arm, {arm}, and a fixed end, {fixed} from the"
            " arm at zero lift, both angles positive outwards",
        )

    @property
    def sense(self) -> float:
        """Change of the distance of the ends per travel: -1 where the spring pushes."""
        return 1.0 if self.action == "pull" else -1.0

    @property
    def between(self) -> float:
        """Angle at the pivot from the end on the arm to the fixed one at zero lift, rad."""
        return self.fixed_angle - self.arm_angle

    @property
    def dead_centre(self) -> Value:
        """Swing to the dead centre, with the pivot in line with the ends, rad."""
        return self.between % np.pi

    def distance(self, swing: Value) -> Value:
        """Distance (...) between the ends of the spring, m.

        Parameters
        ----------
        swing : array (...)   of the arm from zero lift, rad
        """
        a, f = self.arm_radius, self.fixed_radius
        sine = np.sin(0.5 * (self.between - swing))
        distance: Value = np.sqrt((a - f) ** 2 + 4.0 * a * f * sine**2)
        return distance

    def travel(self, swing: Value) -> tuple[Value, Value, Value, Value]:
        """Travel (...) of the ends from zero lift, m, > 0 as the spring is tightened, and its first
        three derivatives by the swing, m/rad^k.

        Parameters
        ----------
        swing : array (...)   of the arm from zero lift, rad
        """
        a_f, angle, long = self.arm_radius * self.fixed_radius, self.between, self.distance(swing)
        # the difference of both cosines keeps the digits of a small swing
        wide = 4.0 * a_f * np.sin(angle - 0.5 * swing) * np.sin(0.5 * swing)
        first = -a_f * np.sin(angle - swing) / long
        second = (a_f * np.cos(angle - swing) - first**2) / long
        third = (a_f * np.sin(angle - swing) - 3.0 * first * second) / long
        travel = -wide / (long + self.distance(0.0))
        w = self.sense
        return w * travel, w * first, w * second, w * third

    def by_lift(self, lift: Value) -> tuple[Value, Value, Value, Value]:
        """Travel (...) from zero lift, m, and three derivatives by the lift of the follower."""
        travel, first, second, third = self.travel(lift / self.length)
        return travel, first / self.length, second / self.length**2, third / self.length**3

    @property
    def most_lift(self) -> Value:
        """Lift of the follower to the dead centre, m."""
        return self.dead_centre * self.length

    def on_arm(self, length: float | None, rocker: Rocker | None) -> Self:  # noqa: ARG002
        """On an arm of a length, m."""
        return self if length is None else replace(self, length=length)

    def pull(self, force: Array, lift: Array) -> Array:
        """Force of the spring on the arm (2, ...), N, see `SpringShape.pull_on_arm`."""
        on_arm, fixed = self.ends(lift / self.length)
        apart = on_arm - fixed
        towards = -self.sense * apart / np.sqrt((apart**2).sum(axis=0))
        return np.stack([force * each for each in towards])

    def ends(self, swing: Array) -> tuple[Array, Array]:
        """End of the spring on the arm and fixed end, (2, ...) each, m: along the arm from the
        pivot, and square to it, outwards.

        Parameters
        ----------
        swing : array (...)   of the arm from zero lift, rad
        """
        out = (self.arm_angle + 0.0 * swing, self.fixed_angle - swing)
        radii = (self.arm_radius, self.fixed_radius)
        on_arm, fixed = (
            r * np.stack([np.cos(each), np.sin(each)]) for r, each in zip(radii, out, strict=True)
        )
        return on_arm, fixed


@dataclass(frozen=True, kw_only=True)
class RockerSpring(Part):
    """Spring on the output of a rocker without lash, such as that of a valve.

    Raises
    ------
    InputError
        If a value is out of its bounds, or the rocker has a lash: before it is taken up the spring
        would not bring the follower to the cam.
    """

    table: ClassVar[str] = "spring.rocker"
    labels: ClassVar[tuple[str, ...]] = ("rocker", "length")
    defaults: ClassVar[Mapping[str, str]] = _OF_GAS
    action: ClassVar[Literal["push", "pull"]] = "push"

    rate: Annotated[Rate | None, Known("spring catalogue or drawing", "24.2 kN/m")] = None
    """force of a coil spring per lift of the output"""
    preload: Annotated[SignedForce | None, Known("spring drawing", "242 N")] = None
    """force of a coil spring on the output at zero lift"""
    source: TableSource = NO_SOURCE
    rocker: Rocker = UNIFORM
    length: float | None = None

    @property
    def linkage(self) -> RockerLinkage:
        """Arms of the rocker."""
        return self.rocker.linkage(self.length)

    def on_arm(self, length: float | None, rocker: Rocker | None) -> Self:
        """The spring on the output of a rocker.

        Parameters
        ----------
        length : float or None   of the arm of the follower, m; None: a stem moves the rocker

        Raises
        ------
        InputError
            If there is no rocker, or it has a lash.
        """
        if rocker is None:
            raise InputError("rocker", "missing", "given with [spring.rocker]")
        if rocker.lash > 0.0:
            limit = "0 mm with [spring.rocker], or the spring does not reach the cam"
            raise InputError("rocker.lash", shown(rocker.lash, "mm"), limit)
        return replace(self, rocker=rocker, length=length)

    def by_lift(self, lift: Value) -> tuple[Value, Value, Value, Value]:
        """Travel (...) from zero lift, m, and three derivatives by the lift of the follower."""
        return self.linkage.travel(lift)

    @property
    def most_lift(self) -> float:
        """Lift of the follower to the dead centre, m."""
        return self.linkage.most_lift

    def pull(self, force: Array, lift: Array) -> Array:
        """Force of the output on the arm (2, ...), N, see `SpringShape.pull_on_arm`."""
        return self.rocker.push_on_arm(force, lift, self.length or 1.0)


@dataclass(frozen=True, kw_only=True)
class LinkedSpring(SpringShape):
    """Spring between a point of an arm and a fixed point, or behind a rocker, on the follower.

    F(s) = F_s(u) du/ds with the force F_s at the travel u of its ends at a lift s; so its energy is
    that of the spring, and on an arm of a length l its moment about the pivot F l.

    Raises
    ------
    InputError
        If the spring is described twice or not at all, does not push or pull as it can, or the
        force on the arc falls at zero lift.
    """

    table: ClassVar[str] = "spring.link"
    carried: ClassVar[Literal["", "stem", "arm"]] = "arm"

    link: SpringLink | RockerSpring
    spring: SpringShape | None = None

    def __post_init__(self) -> None:
        """Refuse a spring that is described twice or not at all, and a force on the arc that falls
        at zero lift.
        """
        link, spring = self.link, self.spring
        if spring is not None and spring.pulls != (link.action == "pull"):
            action = "pull" if spring.pulls else "push"
            stated = f"{link.table}.action"
            raise InputError(stated, link.action, f'"{action}" with [{spring.table}]')
        for name in ("rate", "preload"):
            stated = getattr(link, name)
            if stated is None and spring is None:
                raise InputError(f"{self.table}.{name}", "missing", "given for a coil spring")
            if stated is not None and spring is not None:
                unit = "kN/m" if name == "rate" else "N"
                limit = f"left out: it follows from {spring.table}"
                raise InputError(f"{self.table}.{name}", shown(stated, unit), limit)
        # without the length of the arm NaN: a table not yet on its arm
        if self._slope(np.zeros(1))[0] <= 0.0:
            _, lever, change, _ = link.by_lift(0.0)
            least = shown(float(-self._own[0] * change / lever**2), "kN/m")
            limit = f"> {least}: the force on the cam must rise with the lift"
            table = self.table if spring is None else spring.table
            raise InputError(f"{table}.rate", shown(float(self._own[1]), "kN/m"), limit)

    @property
    def preload_key(self) -> str:
        return f"{self.table}.preload" if self.spring is None else self.spring.preload_key

    @property
    def stated(self) -> Part:
        return self.link

    def with_stated(self, stated: Part) -> LinkedSpring:
        return self.of_many({"link": stated})

    @property
    def own(self) -> SpringShape | None:
        return self.spring

    @cached_property
    def _own(self) -> tuple[Value, Value]:
        """Force, N, and rate, N/m, of the spring along itself at zero lift."""
        if self.spring is not None:
            return self.spring.preload, self.spring.rate
        preload, rate = self.link.preload, self.link.rate
        return 0.0 if preload is None else preload, 0.0 if rate is None else rate

    @property
    def own_share(self) -> Value:
        return self._own[1] / self.rate

    def on_arm(self, length: float | None, rocker: Rocker | None = None) -> Self:
        return replace(self, link=self.link.on_arm(length, rocker))

    def end_travel(self, lift: Value) -> Value:
        return self.link.by_lift(lift)[0]

    def lever(self, lift: Value) -> Value:
        return self.link.by_lift(lift)[1]

    @cached_property
    def preload(self) -> Value:
        """Force on the arc at zero lift, N."""
        return _plain(self._own[0] * self.lever(0.0))

    @cached_property
    def rate(self) -> Value:
        """Slope of the force on the arc at zero lift, N/m."""
        return _plain(self._slope(np.zeros(1)))

    @cached_property
    def reach(self) -> Value:
        """Lift up to which the force on the arc rises and the law of the spring holds, m, at most
        that of the dead centre.
        """
        high = np.atleast_1d(np.broadcast_arrays(self.link.most_lift, *self._own)[0])
        low = np.zeros_like(high)
        for _ in range(_ROUNDS):
            lift = np.linspace(low[..., 0], high[..., 0], _PLACES, axis=-1)
            falls = ~(self._slope(lift[..., 1:-1]) > 0.0)
            first = np.argmax(falls, axis=-1, keepdims=True)
            k = np.where(falls.any(axis=-1, keepdims=True), first, falls.shape[-1])
            low, high = (np.take_along_axis(lift, k + side, axis=-1) for side in (0, 1))
        return _plain(low)

    def _slope(self, lift: Array) -> Array:
        """Slope of the force on the arc by the lift (...), N/m; NaN where the travel of the ends is
        beyond the law of the spring.
        """
        travel, lever, change, _ = map(np.asarray, self.link.by_lift(lift))
        force, rate = self._own
        law = self._risen(travel)
        slope = rate * law.slope * lever**2 + (force + rate * law.travel) * change
        return np.asarray(np.where(np.real(travel) <= self._longest, slope, np.nan))

    @property
    def _longest(self) -> float:
        """Travel of its ends up to which the law of the spring holds, m."""
        return np.inf if self.spring is None else float(self.spring.reach)

    def _risen(self, travel: Array) -> Rise:
        if self.spring is not None:
            return rise(self.spring, travel)
        return Rise.linear(travel)

    def within(self, lift: Array) -> Rise:
        """Rise of the force on the arc over its slope at zero lift, with integral and derivatives.

        Parameters
        ----------
        lift : array (...)   of the follower, m
        """
        preload, rate = self._own
        travel, first, second, third = map(np.asarray, self.link.by_lift(lift))
        law = self._risen(travel)
        force, slope = preload + rate * law.travel, rate * law.slope
        change = rate * law.travel_d2 * first**3 + 3.0 * slope * first * second + force * third
        return Rise(
            (preload * travel + rate * law.work - self.preload * lift) / self.rate,
            (force * first - self.preload) / self.rate,
            (slope * first**2 + force * second) / self.rate,
            change / self.rate,
        )

    def pull_on_arm(self, force: Array, lift: Array) -> Array:
        """Along the line of its ends, or that of the output; see `SpringShape`."""
        return self.link.pull(np.asarray(force / self.lever(lift)), lift)


@dataclass(frozen=True, kw_only=True)
class SpringBehindRocker(LinkedSpring):
    """Spring on the output of a rocker, as its force on the follower."""

    table: ClassVar[str] = "spring.rocker"
    carried: ClassVar[Literal["", "stem", "arm"]] = ""


def _plain(value: Value) -> Value:
    """A float of one spring; arrays (m, 1) of many as they are."""
    return float(np.ravel(value)[0]) if np.ndim(value) < 2 else value


def linked(link: SpringLink | RockerSpring, spring: SpringShape | None) -> LinkedSpring:
    """Spring of a link or rocker as it acts on the follower; spring: None of a coil."""
    kind = SpringBehindRocker if link.table == SpringBehindRocker.table else LinkedSpring
    return kind(link=link, spring=spring)
