"""Reactions of two guides of finite length on the bending stem."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, cached_property, lru_cache
from typing import Annotated, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.polynomial.legendre import Legendre
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, Value, finite, freeze, readonly
from camwright.geometry.display import Displayed
from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.base.material import ROOM, MadeOf
from camwright.pipeline.base.quantities import (
    In,
    Known,
    Length,
    Part,
    Pressure,
    Resolved,
    TableSource,
    Temperature,
    Used,
    card_of,
)
from camwright.pipeline.base.source import NO_SOURCE
from camwright.pipeline.base.units import shown
from camwright.pipeline.follower.guide_contact import BearingLine, settle
from camwright.pipeline.follower.stem_beam import Stem, end_flexibility, stem_compliance

KNOTS = 25  # per guide; odd: the middle of the guide is a knot
RESIDUAL_LIMIT = 1e-9
_NO_LOAD = 1e-290  # N, of a dwell: smaller ones are denormal
WALL_SHARE = 0.25  # of the bore: wall of a bush in its elasticity where the case has none


def _no_press_fit(field: str, clearance: float) -> None:
    if clearance < 0.0:
        raise InputError(field, shown(clearance, "mm"), ">= 0 mm: a press fit cannot slide")


def require_about(table: str, nominal: float, low: float | None, high: float | None) -> None:
    """Refuse a least or greatest friction, of a table, on the wrong side of the nominal one.

    Raises
    ------
    InputError
    """
    if low is not None and not low <= nominal:
        raise InputError(f"{table}.friction_min", low, f"<= friction = {nominal:.4g}")
    if high is not None and not nominal <= high:
        raise InputError(f"{table}.friction_max", high, f">= friction = {nominal:.4g}")


@dataclass(frozen=True, kw_only=True)
class Guide(Part):
    """Guide of the stem; its limits hold for dry running unless the source states otherwise.

    Above the temperature of its limit the permissible pressure falls with the yield strength of the
    material.

    Raises
    ------
    InputError
        If a value is out of its bounds; a negative clearance is a press fit, which cannot slide.
    """

    table: ClassVar[str] = "guide"
    resolved: ClassVar[Mapping[str, Resolved]] = card_of(
        "card of the bush, which fills the keys left out", "bushes.toml", "ptfe_lined"
    )
    defaults: ClassVar[Mapping[str, str]] = {
        "friction_min": "friction less the tolerance of friction",
        "friction_max": "friction plus the tolerance of friction",
        "lubrication": "none assumed: the limits are those stated",
        "stiffness": "from the elasticity of the wall; of a quarter of the bore without a wall",
        "thermal_resistance": "wall and housing in series",
        "pressure_limit_temperature": "20 degC",
    }

    length: Annotated[Length, Known("bush catalogue", "20 mm")]
    """length of the bush"""
    diameter: Annotated[Length, Known("bush catalogue", "10 mm")]
    """bore of the bush: diameter of stem or pin"""
    wall: Annotated[Length | None, Known("bush catalogue", "2 mm")] = None
    """wall thickness of the bush"""
    friction: Annotated[float, In(at_least=0, at_most=1), Known("data sheet of the bush", 0.1)]
    """coefficient of friction of bush and stem or pin"""
    friction_min: Annotated[
        float | None, In(at_least=0, at_most=1), Known("data sheet of the bush", 0.05)
    ] = None
    """least coefficient of friction"""
    friction_max: Annotated[
        float | None, In(at_least=0, at_most=1), Known("data sheet of the bush", 0.15)
    ] = None
    """greatest coefficient of friction"""
    lubrication: Annotated[
        Literal["dry", "greased_once", "regularly_greased", "flooded"] | None,
        Known("own choice", "greased_once"),
    ] = None
    """lubrication of a nylon bush, which sets its PV limit"""
    clearance: Annotated[
        float, In("mm", at_least=-100, at_most=100), Known("tolerances of bush and stem")
    ] = 0.0
    """diametral clearance as mounted"""
    material: Annotated[MadeOf, Known("data sheet of the bush", "nylon")]
    pressure_limit: Annotated[Pressure | None, Known("data sheet of the bush", "20 MPa")] = None
    """permissible mean bearing pressure"""
    pressure_limit_temperature: Annotated[
        Temperature | None, Known("data sheet of the bush", "80 degC")
    ] = None
    """temperature up to which the pressure limit holds"""
    speed_limit: Annotated[
        float | None, In("m/s", above=0, at_most=1000), Known("data sheet of the bush", "2.5 m/s")
    ] = None
    """greatest sliding speed"""
    pv_limit: Annotated[
        float | None,
        In("MPa m/s", above=0, at_most=1e6),
        Known("data sheet of the bush", "1.8 MPa m/s"),
    ] = None
    """permissible pressure times sliding speed"""
    stiffness: Annotated[
        float | None,
        In("N/mm", above=0, at_most=1e9),
        Known("measured, or finite elements", "50000 N/mm"),
    ] = None
    """stiffness of the whole bush in its seat"""
    housing_resistance: Annotated[
        float | None,
        In("K/W", above=0, at_most=1e6),
        Known("measured or estimated: about 1 K/W in aluminium", "1 K/W"),
    ] = None
    """thermal resistance from the outside of the bush to the ambient"""
    thermal_resistance: Annotated[
        float | None, In("K/W", above=0, at_most=1e6), Known("measured", "3 K/W")
    ] = None
    """total thermal resistance from the rubbing surface to the ambient, in place of wall and
    housing"""
    wear_rate: Annotated[
        float | None,
        In("mm^3/N/m", above=0, at_most=1e3),
        Known("data sheet of the bush", "1e-7 mm^3/N/m"),
    ] = None
    """wear volume per load and sliding distance, Archard"""
    source: TableSource = NO_SOURCE

    def __post_init__(self) -> None:
        """Refuse a press fit, and a least or greatest friction on the wrong side of the nominal
        one.
        """
        super().__post_init__()
        _no_press_fit("guide.clearance", self.clearance)
        require_about("guide", self.friction, self.friction_min, self.friction_max)

    @cached_property
    def foundation_modulus(self) -> float:
        """Force of the bore per length and deflection, N/m2: by the stated stiffness or the
        elasticity of the bush, see `bush_foundation_modulus`.
        """
        if self.stiffness is not None:
            return self.stiffness / self.length
        bore, card = self.diameter, self.material
        return bush_foundation_modulus(bore, self.wall_share * bore, card.E, card.nu)

    @property
    def wall_share(self) -> float:
        """Wall over bore; `WALL_SHARE` without a wall."""
        return WALL_SHARE if self.wall is None else self.wall / self.diameter

    @property
    def projected_area(self) -> float:
        """Diameter times length, m2."""
        return self.diameter * self.length

    def pressure_limit_at(self, temperature: float) -> float | None:
        """Permissible pressure of the guide at a temperature, K, Pa: as stated up to the
        temperature of the limit, above it less in proportion to the yield strength.

        None without a limit, NaN where the strength at the temperature is not known.
        """
        stated = self.pressure_limit_temperature or ROOM
        if self.pressure_limit is None or temperature <= stated:
            return self.pressure_limit
        strength = self.material.yield_strength_at
        return self.pressure_limit * float(
            np.minimum(1.0, strength(temperature) / strength(stated))
        )


@dataclass(frozen=True, kw_only=True)
class GuidePair(Part):
    """Guides A and B of the stem."""

    table: ClassVar[str] = "guides"

    spacing: Annotated[Length, Known("drawing", "80 mm")]
    """distance of the guides from middle to middle"""
    ambient_temperature: Annotated[
        Temperature | None, Known("measured at the machine", "60 degC")
    ] = None
    """temperature around the guides in operation, at least that of the mechanism"""
    a: Annotated[Guide, Used("cycle, checks of the guides")]
    """guide A next to the cam"""
    b: Annotated[Guide, Used("cycle, checks of the guides")]
    """guide B beyond guide A"""

    def __post_init__(self) -> None:
        """Refuse guides that overlap."""
        super().__post_init__()
        least = 0.5 * (self.a.length + self.b.length)
        if not least < self.spacing:
            limit = (
                f"> {shown(least, 'mm')}, half of guides.a.length = {shown(self.a.length, 'mm')} "
                f"plus half of guides.b.length = {shown(self.b.length, 'mm')}"
            )
            raise InputError("guides.spacing", shown(self.spacing, "mm"), limit)

    def tilt_at(self, spacing: Value) -> Value:
        """Greatest tilt of the stem in the clearances at a spacing (...), m, rad.

        Both diametral clearances over twice the length from the outer end of one guide to that of
        the other.
        """
        return 0.5 * (self.a.clearance + self.b.clearance) / (spacing + self._half_lengths)

    def tilt_compliance(self, stem: Stem, overhang: Value, spacing: Value) -> Value:
        """Upper bound of the stem end's slope per moment there (...), rad/(N m).

        As a bar on the outer ends of both guides, between which it tilts.

        Parameters
        ----------
        overhang : float or array   from the middle of guide A, m
        spacing : float or array    of the guides, m

        References
        ----------
        Roark: a bar over two supports under a couple at its overhanging end.
        """
        reach = overhang - 0.5 * self.a.length
        return (reach + (spacing + self._half_lengths) / 3.0) / stem.bending_stiffness

    @property
    def _half_lengths(self) -> float:
        return 0.5 * (self.a.length + self.b.length)

    @property
    def both(self) -> tuple[tuple[Literal["A", "B"], Guide], ...]:
        """The guides by name."""
        return ("A", self.a), ("B", self.b)


@dataclass(frozen=True, eq=False, repr=False)
class GuideReactions(Displayed):
    """Reactions and pressures of both guides at each position; arrays (n,), SI.

    Guide A acts against the side force F_t and guide B with it; both reactions are signed like
    A = F_t (a+b)/b, B = F_t a/b of point supports, `statics_*`. `moment_*`: couples of the guides
    on the stem about their middles, an effect of finite length. `slope_*`: slope of the stem at the
    middle of a guide; `roller_deflection`: displacement of the roller along F_t; both from the
    common axis of the guides. `line_pressure_*` (knots, n), N/m: line pressure on the stem,
    positive against F_t, at `knots_*` (m from the middle of the guide, away from the roller).
    `rubbing_load_*`: sum of the normal forces on both sides of the bore, where the reaction is
    their difference; friction is proportional to it. Residuals of force and of moment about the
    roller, over the sum of their magnitudes, and maximum residual of the contact law over the terms
    of the deflection.
    """

    tangential_force: Array
    overhang: Array
    reaction_a: Array
    reaction_b: Array
    statics_a: Array
    statics_b: Array
    moment_a: Array
    moment_b: Array
    slope_a: Array
    slope_b: Array
    roller_deflection: Array
    line_pressure_a: Array
    line_pressure_b: Array
    knots_a: Array
    knots_b: Array
    rubbing_load_a: Array
    rubbing_load_b: Array
    force_residual: Array
    moment_residual: Array
    complementarity_residual: Array

    def __post_init__(self) -> None:
        freeze(self, **{name: getattr(self, name) for name in self.__dataclass_fields__})

    def part(self, first: int, end: int) -> GuideReactions:
        """Reactions at the positions from `first` to before `end`."""
        names = set(self.__dataclass_fields__) - {"knots_a", "knots_b"}
        return replace(self, **{name: getattr(self, name)[..., first:end] for name in names})

    @cached_property
    def line_pressure_max_a(self) -> Array:
        """Maximum line pressure in guide A (n,), N/m, >= 0."""
        return np.asarray(np.abs(self.line_pressure_a).max(axis=0))

    @cached_property
    def line_pressure_max_b(self) -> Array:
        """Maximum line pressure in guide B (n,), N/m, >= 0."""
        return np.asarray(np.abs(self.line_pressure_b).max(axis=0))

    @cached_property
    def bearing_load_a(self) -> Array:
        """Load on the loaded side of guide A over the loaded share of its length, (n,), N.

        Of the side with the greater quotient; the reaction where one side is loaded over the whole
        length.
        """
        return np.asarray(np.ptp(self.knots_a) * mean_line_load(self.line_pressure_a, self.knots_a))

    @cached_property
    def bearing_load_b(self) -> Array:
        """Load on the loaded side of guide B over the loaded share of its length, (n,), N."""
        return np.asarray(np.ptp(self.knots_b) * mean_line_load(self.line_pressure_b, self.knots_b))

    def loaded_side(self, guide: int, position: int) -> tuple[float, float]:
        """Load, N, and loaded length, m, of the side of a guide (0: A, 1: B) that has the greater
        mean line load at the position of this number.

        The loaded length is that of `mean_line_load`.
        """
        lines = (self.line_pressure_a, self.knots_a), (self.line_pressure_b, self.knots_b)
        load, knots = lines[guide]
        push, length = _pushes(load[:, [position]], np.asarray(knots))
        side = int(_mean(push, length)[:, 0].argmax())
        return float(push[side, 0]), float(length[side, 0])


def mean_line_load(line_load: ArrayLike, knots: ArrayLike) -> Array:
    """Greater mean line load of both sides of a bore, over the loaded length, N/m.

    The push on a side is the integral of its line load. The loaded length ends where the line
    load, extrapolated from the last two loaded knots, falls to zero, at most at the next knot.

    Parameters
    ----------
    line_load : array (k, n)   N/m, of either sign
    knots : array (k,)         Lobatto knots from the middle of the guide, m; see `lobatto`

    Returns
    -------
    array (n,)   N/m; 0 without load, NaN where a line load is NaN
    """
    push, length = _pushes(np.asarray(line_load, dtype=float), np.asarray(knots, dtype=float))
    return np.asarray(_mean(push, length).max(axis=0))


def _pushes(load: Array, at: Array) -> tuple[Array, Array]:
    """Force on both sides of the bore of a guide (2, n), N, and loaded length of each side (2, n),
    m.

    Parameters
    ----------
    load : array (k, n)   line load on the stem at the knots, N/m, its sign that of the side
    at : array (k,)       places of the knots from the middle of the guide, m
    """
    weights = at[-1] * lobatto(at.size)[1]
    sides = np.stack([load, -load])
    push: Array = weights @ np.maximum(sides, 0.0)
    return push, _loaded_length(sides, at, weights)


def _mean(push: Array, length: Array) -> Array:
    """Mean line load (2, n), N/m, of pushes over their lengths; NaN where a push is."""
    mean = np.divide(push, length, out=np.zeros_like(push), where=length > 0.0)
    return np.where(np.isnan(push), np.nan, mean)


def _loaded_length(sides: Array, knots: Array, weights: Array) -> Array:
    """Length of a guide with a positive line load (..., n), m; beyond the last loaded knot the line
    load is extrapolated to zero.

    Parameters
    ----------
    sides : array (..., k, n)   line loads at the knots, N/m
    knots : array (k,)          places of the knots, m
    weights : array (k,)        quadrature length of each knot, m
    """
    on, gaps = sides > 0.0, np.diff(knots)[:, None]
    length = (gaps * (on[..., :-1, :] & on[..., 1:, :])).sum(axis=-2)
    for load, spaces, near in (
        (sides, gaps, weights),
        (sides[..., ::-1, :], gaps[::-1], weights[::-1]),
    ):
        length += _beyond(load, spaces, near[:, None]).sum(axis=-2)
    return np.asarray(length)


def _beyond(load: Array, gaps: Array, weights: Array) -> Array:
    """Length under load beyond each loaded knot that an unloaded one follows (..., k - 1, n), m,
    otherwise 0; the line load is extrapolated to zero.

    Parameters
    ----------
    load : array (..., k, n)   line loads at the knots, N/m
    gaps : array (k - 1, 1)    between the knots, m
    weights : array (k, 1)     quadrature length of each knot, m
    """
    here, after = np.maximum(load[..., :-1, :], 0.0), load[..., 1:, :]
    before = np.zeros_like(here)
    before[..., 1:, :] = here[..., :-1, :]
    back = np.vstack([gaps[:1], gaps[:-1]])
    # A single loaded knot p of weight w: a triangle of area p w, half of it at the end of a guide.
    alone = weights[:-1] * np.r_[2.0, np.ones(len(gaps) - 1)][:, None]
    falls = before > here
    reach = np.where(falls, back * here / np.where(falls, before - here, 1.0), alone)
    # The line load passes through zero where the next knot is loaded on the other side.
    crosses = gaps * here / np.where(after < 0.0, here - after, 1.0)
    beyond = np.where(after < 0.0, crosses, np.minimum(reach, gaps))
    return np.where((here > 0.0) & (after <= 0.0), beyond, 0.0)


def bush_foundation_modulus(
    bore: float, wall: float, elastic_modulus: float, poisson_ratio: float
) -> float:
    """Foundation modulus of a bush in a rigid housing: force per length and deflection, N/m2.

    The wall is a thin bonded layer: a radial approach d cos(phi) gives the pressure
    E_c d cos(phi)/t with E_c = E (1-nu)/((1+nu)(1-2nu)). Its resultant over the loaded half of the
    bore is (pi/4) E_c D/t per unit of d.

    Parameters
    ----------
    bore, wall : float       D and t, m, > 0
    elastic_modulus : float  E, Pa, > 0
    poisson_ratio : float    nu, 0 <= nu <= 0.49; an incompressible wall would be rigid

    Raises
    ------
    InputError
        If a value is out of these bounds.

    References
    ----------
    Johnson, Contact Mechanics (1985), sec. 4.3 and 5.8: elastic foundation, thin bonded layer.
    """
    for name, value, unit in (
        ("diameter", bore, "m"),
        ("wall", wall, "m"),
        ("elastic_modulus", elastic_modulus, "Pa"),
    ):
        if not np.all((np.asarray(value) > 0.0) & np.isfinite(value)):
            raise InputError(f"guide.{name}", float(np.min(value)), f"> 0 {unit}")
    nu = poisson_ratio
    if not 0.0 <= nu <= 0.49:
        raise InputError("guide.poisson_ratio", nu, "from 0 to 0.49")
    confined = elastic_modulus * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu))
    return 0.25 * np.pi * confined * bore / wall


class _Carried(NamedTuple):
    """Reactions, couples and rubbing loads of both guides on the stem, (n,), signed as in
    `GuideReactions`.
    """

    reaction_a: Array
    reaction_b: Array
    couple_a: Array
    couple_b: Array
    rubbing_a: Array
    rubbing_b: Array

    def force_residual(self, force: Array) -> Array:
        """Residual of the forces over the sum of their magnitudes (n,)."""
        miss = self.reaction_a - self.reaction_b - force
        return _relative(miss, self.rubbing_a + self.rubbing_b + np.abs(force))

    def moment_residual(self, moment: Array, reach: Array, spacing: float) -> Array:
        """Residual (n,) of the moments on the stem about the roller, over the sum of their
        magnitudes.

        Parameters
        ----------
        moment : array (n,)   of the axial force beside the stem axis, N m
        reach : array (n,)    from the roller to the middle of guide A, m
        spacing : float       of the guides, m
        """
        far = reach + spacing
        turned = self.couple_a + self.couple_b + self.reaction_a * reach - self.reaction_b * far
        scale = self.rubbing_a * reach + self.rubbing_b * far + np.abs(moment)
        return _relative(turned - moment, scale)


def guide_reactions(
    tangential_force: ArrayLike,
    overhang: ArrayLike,
    stem: Stem,
    guides: GuidePair,
    end_moment: ArrayLike = 0.0,
    knots: int = KNOTS,
    start: tuple[Array, Array] | None = None,
) -> GuideReactions:
    """Reactions, pressures and slopes of the guides on the elastic stem at each position.

    The guides are fixed and the stem slides: the stem between the outer edge of A and the far edge
    of B is one beam for all positions; the overhang transfers force and moment to the edge of A and
    adds to the deflection. Each guide is a unilateral elastic foundation on both sides of the bore
    beyond half the clearance, integrated at Lobatto knots, which are nodes of the beam. The stem
    beyond B is unloaded.

    Parameters
    ----------
    tangential_force : array (n,)    F_t on the roller, N
    overhang : array (n,)            a, roller centre to the middle of A, m
    stem : Stem
    guides : GuidePair
    end_moment : array (n,)          on the roller end, N m, positive from the stem axis
                                     (roller to B) towards F_t
    knots : int                      per guide, odd, >= 3
    start : push, rigid              initial guess of `settle`, of similar loads

    Returns
    -------
    GuideReactions

    Raises
    ------
    InputError
        If the roller enters guide A, the stem leaves guide B or is thicker than a bore, or a value
        is not finite.
    ContactError
        If equilibrium or the contact law is not met to 1e-9.
    """
    force = finite("tangential_force", tangential_force)
    force = np.where(np.abs(force) < _NO_LOAD, 0.0, force)
    reach = np.broadcast_to(finite("overhang", overhang), force.shape)
    moment = np.broadcast_to(finite("end_moment", end_moment), force.shape)
    require_fit(stem, guides, reach, knots)
    line, slopes, half_a = bearing_line(stem, guides, knots)
    arm = reach - half_a
    push, rigid = settle(line, force, moment - force * arm, start)

    weights_a, weights_b = np.split(line.weights, 2)
    from_a = line.positions[:knots] - half_a
    from_b = line.positions[knots:] - half_a - guides.spacing
    in_a, in_b = push[:knots], push[knots:]
    carried = _Carried(
        reaction_a=in_a.sum(axis=0),
        reaction_b=-in_b.sum(axis=0),
        couple_a=from_a @ in_a,
        couple_b=from_b @ in_b,
        rubbing_a=np.abs(in_a).sum(axis=0),
        rubbing_b=np.abs(in_b).sum(axis=0),
    )
    tilt = rigid[1] - slopes @ push
    over = end_flexibility(arm, stem)
    result = GuideReactions(
        tangential_force=force,
        overhang=reach,
        reaction_a=carried.reaction_a,
        reaction_b=carried.reaction_b,
        statics_a=force + (force * reach - moment) / guides.spacing,
        statics_b=(force * reach - moment) / guides.spacing,
        moment_a=carried.couple_a,
        moment_b=carried.couple_b,
        slope_a=tilt[knots // 2],
        slope_b=tilt[knots + knots // 2],
        roller_deflection=rigid[0]
        - rigid[1] * arm
        + over[:, 0, 0] * force
        - over[:, 0, 1] * moment,
        line_pressure_a=in_a / weights_a[:, None],
        line_pressure_b=in_b / weights_b[:, None],
        knots_a=from_a,
        knots_b=from_b,
        rubbing_load_a=carried.rubbing_a,
        rubbing_load_b=carried.rubbing_b,
        force_residual=carried.force_residual(force),
        moment_residual=carried.moment_residual(moment, reach, guides.spacing),
        complementarity_residual=line.law_residual(push, rigid),
    )
    _certify(result)
    return result


def require_fit(stem: Stem, guides: GuidePair, overhang: Array, knots: int) -> None:
    """Check that the stem fits in its guides at overhangs (n,), m, and that `knots`, per guide, are
    odd and at least 3.

    Raises
    ------
    InputError
        If the roller enters guide A, the stem leaves guide B or is thicker than a bore.
    """
    if knots < 3 or knots % 2 == 0:
        raise InputError("knots", knots, "odd and >= 3")
    for name, guide in (("a", guides.a), ("b", guides.b)):
        widest = guide.diameter + guide.clearance
        if stem.diameter > widest * (1.0 + 1e-9):
            limit = f"<= {shown(widest, 'mm')}, diameter and clearance of guide {name.upper()}"
            raise InputError("follower.stem_diameter", shown(stem.diameter, "mm"), limit)
    if not (overhang >= 0.5 * guides.a.length).all():
        limit = f">= {shown(0.5 * guides.a.length, 'mm')}, or the roller enters guide A"
        least = shown(float(overhang.min()), "mm")
        raise InputError("follower.overhang_at_max_lift", least, limit)
    needed = float(overhang.max()) + guides.spacing + 0.5 * guides.b.length
    if not stem.length >= needed * (1.0 - 1e-12):
        limit = f">= {shown(needed, 'mm')}, or the stem leaves guide B at the largest overhang"
        raise InputError("follower.stem_length", shown(stem.length, "mm"), limit)


@lru_cache(maxsize=8)
def bearing_line(stem: Stem, guides: GuidePair, knots: int) -> tuple[BearingLine, Array, float]:
    """Stem as a beam in both guides, from the edge of guide A nearer to the roller; slope of the
    stem at each knot per unit force at each (2 k, 2 k), rad/N, clamped at that edge; half the
    length of guide A, m.

    Parameters
    ----------
    stem : Stem          that bends
    guides : GuidePair   with stiffness and clearance of their bores
    knots : int          k, per guide
    """
    unit, weight = lobatto(knots)
    half_a, half_b = 0.5 * guides.a.length, 0.5 * guides.b.length
    positions = np.r_[half_a * (1.0 + unit), half_a + guides.spacing + half_b * unit]
    deflection, slopes = stem_compliance(positions, stem)
    line = BearingLine(
        positions=positions,
        weights=np.r_[half_a * weight, half_b * weight],
        foundation=np.repeat([guides.a.foundation_modulus, guides.b.foundation_modulus], knots),
        play=np.repeat([0.5 * guides.a.clearance, 0.5 * guides.b.clearance], knots),
        compliance=deflection,
        edges=np.array([0, knots - 1, knots, 2 * knots - 1]),
    )
    return line, readonly(slopes), half_a


@cache
def lobatto(count: int) -> tuple[Array, Array]:
    """Nodes and weights, (count,) each, of Gauss-Lobatto quadrature on [-1, 1].

    References
    ----------
    Abramowitz and Stegun (1964), 25.4.32.
    """
    highest = Legendre.basis(count - 1)
    inner = np.sort(highest.deriv().roots().real)
    knots = np.r_[-1.0, inner, 1.0]
    return readonly(knots), readonly(2.0 / (count * (count - 1) * highest(knots) ** 2))


def _relative(error: Array, scale: Array) -> Array:
    """|error| / scale, 0 without load."""
    return np.divide(np.abs(error), scale, out=np.zeros_like(scale), where=scale > _NO_LOAD)


def _certify(result: GuideReactions) -> None:
    """Check that the residuals of equilibrium and of the contact law are within `RESIDUAL_LIMIT`.

    Raises
    ------
    ContactError
        If a residual exceeds 1e-9.
    """
    for name in ("force_residual", "moment_residual", "complementarity_residual"):
        worst = float(np.max(getattr(result, name), initial=0.0))
        if not worst <= RESIDUAL_LIMIT:
            raise ContactError(f"guides: {name} = {worst:.3g}, must be <= {RESIDUAL_LIMIT:g}")
