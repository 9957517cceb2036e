"""Design variables, ratings, scenarios and finite-element corrections of a synthesis."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, Value, readonly, uniform_turn
from camwright.pipeline.case.case import Case
from camwright.pipeline.checks.flat_face_sliding import face_width
from camwright.pipeline.checks.key_strength import KeywayRoot
from camwright.pipeline.checks.roller_bearing import Grease
from camwright.pipeline.contact.traction import Drag
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.follower.disc_preload import Compliances
from camwright.pipeline.follower.spring_kinds import SpringShape


@dataclass(frozen=True)
class DesignVariables:
    """Design variables: spring rate, N/m; preload, N; prime radius, m; phase, rad.

    The phase is the angle by which the cam leads the spline of its energy on the shaft. dead_load:
    weight and mean external force, N, towards the cam, which store work with the spring; shape: of
    the force of the spring over the lift, None: linear; both given. of_lift: whether the splines
    are those of the lift, m, in place of the energy: of a yoke, whose breadth is constant.
    """

    rate: float
    preload: float
    prime_radius: float
    phase: float = 0.0
    dead_load: float = 0.0
    shape: SpringShape | None = None
    of_lift: bool = False

    def with_value(self, name: str, value: float) -> DesignVariables:
        """With another value of a variable."""
        return replace(self, **{name: value})  # type: ignore[arg-type]

    @property
    def closing(self) -> float:
        """Force towards the cam at zero lift and rest, N."""
        return self.preload + self.dead_load


def redrawn(case: Case, variables: DesignVariables) -> Case:
    """Case with the spring and prime radius of a design."""
    spring = replace(case.spring, rate=float(variables.rate), preload=float(variables.preload))
    cam = replace(case.cam, prime_radius=float(variables.prime_radius))
    return case.model_copy(update={"spring": spring, "cam": cam})


@dataclass(frozen=True, eq=False)
class Ratings:
    """Limits of a synthesis and nominal numbers of its machine, SI.

    Parameters
    ----------
    numbers : Numbers      of the machine in no load case
    bounds : mapping       limit by the key of its constraints, see `Declaration.kept_at`: a row of
                           the table of limits, or the bound of a measure; one left out is not kept
    by : mapping           check that sets the least limit of a group, by its key
    drag : Drag            of the roller
    keyway : KeywayRoot
    grease : Grease        of the roller bearing
    compliances : Compliances   of both rollers of preloaded discs
    """

    numbers: Numbers
    bounds: Mapping[str, float] = field(default_factory=dict)
    by: Mapping[str, str] = field(default_factory=dict)
    drag: Drag | None = None
    keyway: KeywayRoot | None = None
    grease: Grease | None = None
    compliances: Compliances | None = None

    def times(self, key: str, factor: float) -> Ratings:
        """With a limit times a factor."""
        return replace(self, bounds={**self.bounds, key: self.bounds[key] * factor})

    def least(self, limits: Mapping[str, Mapping[str, float]]) -> Ratings:
        """Ratings with the lowest limit of each constraint, and the check that sets it; a
        constraint in `limits` that no check limits is dropped.

        Parameters
        ----------
        limits : mapping   limit, SI, by constraint and, within it, by check
        """
        by = {key: min(each, key=lambda name: each[name]) for key, each in limits.items() if each}
        least = {key: float(limits[key][name]) for key, name in by.items()}
        others = {key: value for key, value in self.bounds.items() if key not in limits}
        return replace(self, bounds=others | least, by={**self.by, **by})

    @property
    def kinds(self) -> frozenset[str]:
        """Words for the kind of follower by which checks and constraints are selected: of a roller
        "roller", "round"; of a face "face", and on an arm "swung_face", of a curved one "round" as
        well; of either "stem" or "arm". See `FollowerKind`; of a roller those of the closure of its
        cam, too, see `CamBody.closed_by`.
        """
        body = "stem" if self.numbers.get("follower.arm.length") is None else "arm"
        if self.numbers.get("follower.face.width") is None:
            closed = () if self.numbers.case is None else self.numbers.case.cam.closed_by
            return frozenset({"roller", "round", body, *closed})
        shapes = {"radius": {"round", "swung_face"}, "offset": {"swung_face"}}
        stated = (words for name, words in shapes.items()
                  if self.numbers.get(f"follower.face.{name}") is not None)  # fmt: skip
        return frozenset({"face", body}.union(*stated))

    @property
    def tilting(self) -> float:
        """Tangent of the normal over lift slope: 1 for a round surface, 0 for a flat face."""
        return float("round" in self.kinds)

    @property
    def offset(self) -> float:
        """Offset of the follower, m."""
        return float(self.numbers["cam.offset"])

    @property
    def slope_max(self) -> float | None:
        """Greatest ds/dtheta at which the contact stays on the flat face of a stem, m: half the
        allowed width less the offset; None for any other follower.
        """
        width = self.bounds.get(face_width.id)
        if width is None or self.numbers.get("follower.arm.length") is not None:
            return None
        return 0.5 * width - abs(self.offset)


_FACTORS = (
    "contact", "pressure_weight", "force_weight", "guide_a", "guide_b", "rubbing_a", "rubbing_b",
    "jam", "edge_a", "edge_b", "hot_a", "hot_b", "worn_a", "worn_b", "jam_tilted",
    "bush_rubbing", "bush_bearing",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Correction:
    """Ratios of finite elements to closed forms at n equal cam angles, each (n,).

    Of the contact pressure, the bearing loads and the normal loads of guides A and B, and the jam
    index at maximum friction. Point supports have neither length nor opposite pushes: without the
    correction the synthesis sees a lower bound of the guide pressure.

    Parameters
    ----------
    pressure_weight, force_weight : array   greatest utilisation of the checks that grow with the
                                contact pressure or normal force, where each has it along the turn,
                                over that of pressure or force alone; at least 1
    lever : array               distance of the contact force from the middle of the follower along
                                the cam axis, m
    guide_a, guide_b : array    of the bearing loads, over the share of the pressure limit left at
                                the temperature of the guide
    edge_a, edge_b : array      greatest over mean line load of the guides, over the share of the
                                greatest line load left at the temperature
    hot_a, hot_b : array        normal loads of the guides at maximum friction
    worn_a, worn_b : array      `rubbing_*` with the pushes across the cam's plane
    jam_tilted, bush_rubbing, bush_bearing : array   as of `LoadedCam`
    surge : array               force of the surge at the speed of the load case, N
    swept_surge, elastic : array   change of the spring force, N, by the surge, and with an elastic
                                stem, at the speeds with the least contact force
    swept_speed, elastic_speed : array   those speeds of the cam, rad/s, one value; 0: not known
    rolling : array             mean spin of the roller over cam speed, one value; 0: not known
    least_lift : array          minimum lift, m, of the base of the contact force margin; one value
    """

    contact: Array
    pressure_weight: Array
    force_weight: Array
    lever: Array
    guide_a: Array
    guide_b: Array
    rubbing_a: Array
    rubbing_b: Array
    jam: Array
    edge_a: Array
    edge_b: Array
    hot_a: Array
    hot_b: Array
    worn_a: Array
    worn_b: Array
    jam_tilted: Array
    bush_rubbing: Array
    bush_bearing: Array
    surge: Array
    swept_surge: Array
    elastic: Array
    swept_speed: Array
    elastic_speed: Array
    rolling: Array
    least_lift: Array

    @classmethod
    def none(cls, count: int) -> Correction:
        """Correction without effect at n cam angles."""
        one, zero = readonly(np.ones(count)), readonly(np.zeros(count))
        return cls(
            contact=one, pressure_weight=one, force_weight=one, guide_a=one, guide_b=one,
            rubbing_a=one, rubbing_b=one, jam=one, edge_a=one, edge_b=one, hot_a=one, hot_b=one,
            worn_a=one, worn_b=one, jam_tilted=one, bush_rubbing=one, bush_bearing=one,
            lever=zero, surge=zero, swept_surge=zero, elastic=zero, swept_speed=zero,
            elastic_speed=zero, rolling=zero, least_lift=zero,
        )  # fmt: skip

    def enlarged(self, margin: float) -> Correction:
        """Correction with load factors raised by a margin; surge and speeds are unchanged."""
        return replace(self, **{name: getattr(self, name) * (1.0 + margin) for name in _FACTORS})

    def each(self, of: Callable[[Sequence[Array]], Array], *others: Correction) -> Correction:
        """Correction by a function of each field of this and other corrections."""
        every, names = (self, *others), [each.name for each in fields(self)]
        return Correction(*(of([getattr(one, name) for one in every]) for name in names))

    def towards(self, other: Correction, share: float) -> Correction:
        """Correction between this one, at `share` 0, and another, at 1: linear interpolation, at
        the cam angles of the other.
        """
        if share == 1.0:
            return other
        resampled = self.at(uniform_turn(other.contact.size))
        return resampled.each(lambda both: (1.0 - share) * both[0] + share * both[1], other)

    def at(self, theta: Array) -> Correction:
        """Corrections at cam angles theta (m,), rad, interpolated linearly."""
        angles = np.arange(self.contact.size) * (FULL_TURN / self.contact.size)
        return self.each(lambda one: np.interp(theta, angles, one[0], period=FULL_TURN))


@dataclass(frozen=True, eq=False)
class Scenario:
    """Load case at nominal or a tolerance corner; or several stacked, see `stacked`.

    Parameters
    ----------
    torque : array (n,)      engine torque at n equal cam angles, of zero mean, crank N m
    weight : float           of its ripple in the objective; 0: limits only
    torque_reduction : float   required of its torque ripple; None: none is required
    duty : float             share of the operating time; None: not known
    corner : int             number of its tolerance corner; 0: none. Lives and wear add over the
                             load cases at a corner
    numbers : Numbers        of the machine in its load case, see `numbers_in`
    spring_mass : float      of the spring in the moving mass, kg
    rate_factor, preload_factor : float   spring of the scenario over the nominal spring
    gravity : float          component of g along the axis towards the cam, m/s2
    external : array (n,)    external force at n equal cam angles, N, towards the cam; one value:
                             constant
    nominal : bool           False: a tolerance corner or an end of a range of operation
    swept : bool             limits over the speed range hold in it: those of the first load case
                             of each preload
    correction : Correction
    wall : array             track that carries, held while derivatives are taken; None: that of
                             the force
    cell : float or array    cam angle, rad, for which each cam angle stands: the friction of the
                             guides is the mean over it; 0: the angle alone
    """

    name: str
    torque: Array
    numbers: Numbers
    rate_factor: Value = 1.0
    preload_factor: Value = 1.0
    gravity: float = 0.0
    external: Array = field(default_factory=lambda: readonly(np.zeros(1)))
    weight: float = 1.0
    torque_reduction: float | None = None
    duty: Value | None = None
    corner: Value = 0
    spring_mass: Value = 0.0
    nominal: Value = True
    swept: Value = True
    correction: Correction = field(default_factory=lambda: Correction.none(8))
    cell: Value = 0.0
    wall: Array | None = None

    def at(self, numbers: Mapping[str, Value]) -> Scenario:
        """Scenario with other machine numbers."""
        return replace(self, numbers=self.numbers | numbers)

    def torque_at(self, phase: float) -> tuple[Array, Array]:
        """Engine torque (n,), N m, with the cam advanced by a cam angle `phase`, rad, and its
        derivative by the phase, N m/rad; by Fourier series.
        """
        spectrum = np.fft.rfft(self.torque)
        order = 1j * np.arange(spectrum.size)
        if self.torque.size % 2 == 0:
            order[-1] = 0.0  # the last harmonic of an even count has no phase of its own
        turned, count = spectrum * np.exp(order * phase), self.torque.size
        return np.fft.irfft(turned, n=count), np.fft.irfft(order * turned, n=count)


_NUMBERS = ("rate_factor", "preload_factor", "spring_mass", "nominal", "swept", "corner")
"""Fields of a scenario that differ between stacked ones, besides its numbers."""


def stacked(scenarios: Sequence[Scenario], theta: Array, cell: Value = 0.0) -> Scenario:
    """Several scenarios as one, for evaluation at once: numbers (s, 1), corrections (s, n).

    All have the external force of the first. Numbers of the machine that are not known in all of
    them, such as a maximum friction, are left out.

    Parameters
    ----------
    scenarios : sequence    the s scenarios
    theta : array (n,)      cam angles, rad
    cell : float or array   range of cam angle, rad, for which each angle stands, one or (n,)
    """
    # The corners of a load case share its correction.
    around = np.arange(scenarios[0].external.size) * (FULL_TURN / scenarios[0].external.size)
    external = np.interp(theta, around, scenarios[0].external, period=FULL_TURN)
    different = {id(each.correction): each.correction for each in scenarios}
    different = {key: each.at(theta) for key, each in different.items()}
    first, *others = (different[id(each.correction)] for each in scenarios)
    changed = {
        key: _column([each.numbers.get(key) for each in scenarios])
        for key in scenarios[0].numbers.changed
    }
    return replace(
        scenarios[0],
        **{name: _column([getattr(each, name) for each in scenarios]) for name in _NUMBERS},  # type: ignore[arg-type]
        numbers=Numbers(changed),
        external=np.broadcast_to(external, (len(scenarios), external.size)),
        cell=np.broadcast_to(cell, (len(scenarios), external.size)),
        duty=_column([each.duty for each in scenarios]),
        correction=first.each(np.stack, *others),
    )


def joined(one: Scenario, other: Scenario) -> Scenario:
    """Stacked scenarios at the union of the cam angles of two stacks."""

    def of(both: Sequence[Value]) -> Array:
        return np.concatenate([np.asarray(each) for each in both], axis=1)

    return replace(
        one,
        external=of([one.external, other.external]),
        cell=of([one.cell, other.cell]),
        correction=one.correction.each(of, other.correction),
    )


def taken(stack: Scenario, take: Callable[[Array], Array]) -> Scenario:
    """Selection of stacked scenarios or angles, by applying `take` to each array."""

    def of(value: Value | None) -> Array | None:
        return None if value is None else take(np.asarray(value))

    names = *_NUMBERS, "external", "cell", "duty", "wall"
    return replace(
        stack,
        **{name: of(getattr(stack, name)) for name in names},  # type: ignore[arg-type]
        numbers=Numbers({key: of(value) for key, value in stack.numbers.changed.items()}),
        correction=stack.correction.each(lambda one: take(one[0])),
    )


def _column(values: Sequence[Value | None]) -> Array | None:
    """Values (s, 1); None where one is not known."""
    stated = [float(each) for each in values if each is not None]
    return np.array(stated)[:, None] if len(stated) == len(values) else None
