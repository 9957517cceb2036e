"""Pressure along the line of contact over the turn, with ends, crown and tilt."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from camwright.geometry.arrays import Array, Value, freeze
from camwright.geometry.extrema import TIE
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    AXIS_PARALLELISM,
    CAM_RUN_OUT,
    END_MEAN_LENGTH,
    ROLLER_CLEARANCE,
)
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.finite_length.axial_drop import (
    Crown,
    FiniteBody,
    FinitePair,
)
from camwright.pipeline.contact.finite_length.factor_table import (
    GREATEST_MOMENT,
    FactorTable,
    factor_table,
    fill_together,
)
from camwright.pipeline.contact.finite_length.length_certificate import EndCorrection
from camwright.pipeline.contact.finite_length.length_contact import (
    SignedPressure,
    signed_pressure,
)
from camwright.pipeline.cycle.line_tilt import (
    LineTilt,
    follower_moment,
    line_tilt,
    rigid_moment,
)
from camwright.pipeline.follower.follower_tilt import (
    FollowerTilt,
    TiltingLoads,
    couple_of_second,
)
from camwright.pipeline.follower.guide_reactions import GuideReactions
from camwright.pipeline.follower.spring import NO_FORCE

_ANY_CURVATURE = 1.0  # 1/m: a table has every curvature
_MOMENT_LIMIT_ROUND_OFF = 1e-9  # of the moment at which the contact tips over
_CONTACTS_AT_ONCE = 1000
"""Contacts evaluated together; the interpolation of more takes a sparse matrix."""
_NEXT_TO_NONE = 1.0  # N: a line of some millimetres of steel has 10 MPa
_LIGHTEST_SHARE = 1e-3  # of the greatest force: a thirtieth of its pressure

CORNER_ERROR, BOUNDED_ERROR = 0.05, 0.02
"""Stated difference of the half-spaces from finite elements, where these are not solved: of a mean
at a corner, of a bounded peak."""


def lines_pressed(machine: Machine, force: Array, radius: Array) -> NDArray[np.bool_]:
    """Where a line of contact is solved (...): where it is pressed; of a cam that pulls not by a
    force that is next to none, which it has at every crossover and at a slow speed all over the
    turn.

    Parameters
    ----------
    force : array (...)    normal force, N
    radius : array (...)   relative radius, m
    """
    least = _NEXT_TO_NONE if machine.cam.pulls else NO_FORCE
    return np.asarray(np.isfinite(radius) & (force > least))


@dataclass(frozen=True, eq=False)
class LengthHistory:
    """Pressure along the line of contact over plane-strain peak pressure, arrays (n,).

    centre: in the middle, untilted; level, tilted: signed, without a moment and at the greatest
    one, `moment` (N m); at_corner: whether the greater of both is the mean over `mean_length` (m)
    at a corner. 1 and no moment without contact. tilt: its parts; held, aside (n,): couple that
    friction of the guides holds, and that of the axial offset, N m. correction: of the half-spaces
    by finite elements, included in the pressures; None: half-spaces alone.
    """

    centre: Array
    level: Array
    tilted: Array
    moment: Array
    at_corner: NDArray[np.bool_]
    mean_length: float
    tilt: LineTilt
    held: Array
    aside: Array
    is_crowned: bool
    correction: EndCorrection | None = None

    def __post_init__(self) -> None:
        freeze(self, centre=self.centre, level=self.level, tilted=self.tilted, moment=self.moment)

    def with_rows(self, rows: NDArray[np.intp], solved: FactorRange) -> LengthHistory:
        """The history with the factors `solved` (k,) at the positions numbered `rows` (k,)."""
        changed = {}
        for name, values in solved._asdict().items():
            column = getattr(self, name).copy()
            column[rows] = values
            changed[name] = column
        return replace(self, **changed)

    @property
    def couple(self) -> Array:
        """Greatest couple (n,) that friction of the guides and axial offset hold, N m."""
        return self.held + self.aside

    @property
    def follower_moment(self) -> Array:
        """Greatest moment (n,) about the middle of the follower, N m."""
        return follower_moment(self.moment, self.tilt.forced, self.held, self.aside)

    @property
    def factor(self) -> Array:
        """Signed factor: the worse end of the range of the moment."""
        return np.maximum(self.level, self.tilted)

    @property
    def error(self) -> Array:
        """Relative error bar (n,) of the factor."""
        if self.correction is not None:
            return np.broadcast_to(self.correction.signed_error, self.at_corner.shape)
        return np.where(self.at_corner, CORNER_ERROR, BOUNDED_ERROR)

    @property
    def corrected_by(self) -> Array:
        """Ratio (n,) of finite elements to half-spaces in the greatest signed pressure; 1 without
        finite elements.
        """
        by = 1.0 if self.correction is None else self.correction.signed
        return np.broadcast_to(by, self.at_corner.shape)

    @property
    def centre_error(self) -> float:
        """Relative error bar of the pressure in the middle of a crowned line over plane strain."""
        if not self.is_crowned:
            return 0.0
        bar = BOUNDED_ERROR if self.correction is None else self.correction.centre_error
        return float(np.max(bar))

    def corrected(self, correction: EndCorrection) -> LengthHistory:
        """The history of the half-spaces, corrected by finite elements."""
        signed = correction.signed
        return replace(
            self,
            centre=self.centre * correction.centre,
            level=self.level * signed,
            tilted=self.tilted * signed,
            correction=correction,
        )

    def sentence(self, place: int) -> str:
        """Sentence on the kind of pressure along the line, its moment and tilt, at one position of
        the turn; `place`: its number.
        """
        mean = shown(self.mean_length, "mm")
        what = "greatest pressure along the line, which is bounded"
        if self.at_corner[place]:
            what = (
                f"mean pressure over the last {mean} of contact: at its corner the peak grows"
                " with the mesh, the mean does not"
            )
        most, held = float(self.moment[place]), float(self.couple[place])
        by = f"that {self.tilt.words.held} and axial offset hold"
        if most > held * (1.0 + TIE):
            by = "that the tilt forces"
        return (
            f"{what}; {self.factor[place]:.4g} times plane strain, {self.level[place]:.4g} without"
            f" tilt, at a moment of up to {shown(most, 'N mm')} {by};"
            f" {self.tilt.sentence(place)};"
            f" {self.tier(place)}"
        )

    def tier(self, place: int) -> str:
        """Model of the factor and its error bar at one position of the turn, in words; `place`: its
        number.
        """
        bar = f"error bar {100.0 * self.error[place]:.2g} %"
        if self.correction is None:
            return f"by half-spaces with mirrored ends, {bar} as stated, finite elements not solved"
        return (
            f"by half-spaces times {self.corrected_by[place]:.4g}, the greatest ratio of finite"
            f" elements to half-spaces at the certified angles, {bar} by refinement"
        )

    def in_the_middle(self, plane: ContactHistory) -> ContactHistory:
        """Contact scaled to the line load in the middle; unchanged for a straight line.

        Pressures, widths and depths of a line contact grow with the root of its line load.
        """
        if not self.is_crowned:
            return plane
        names = (
            *("p0", "half_width", "tau_max", "tau_any_plane", "tau_depth"),
            *("von_mises", "von_mises_depth"),
        )
        return replace(plane, **{name: getattr(plane, name) * self.centre for name in names})


class TurnOfLine(NamedTuple):
    """Inputs of the pressure along the line over one turn.

    force (n,): normal force, N; shaft (n,): slope of the camshaft at the cam, rad, as of
    `Cycle.shaft_tilt`; pivot (n,): load of an arm on its pivot, N, 0 without one;
    shaft_compliance: slope of the camshaft at the disc that carries per moment there, rad/(N m);
    base_radius (n,): of the base circle of that disc, m;
    pin (n,): slope of the pin per couple, rad/(N m), by finite elements; None: on a foundation;
    beyond (n,): distance of the roller that carries from the first along their pin, m.
    """

    machine: Machine
    contact: ContactHistory
    force: Array
    guides: GuideReactions
    shaft: Array
    pivot: Array
    shaft_compliance: Value
    base_radius: Value
    pin: Array | None = None
    beyond: Value = 0.0

    @property
    def tilting(self) -> FollowerTilt:
        """Compliance and clearance by which the follower tilts; see `Machine.tilting`."""
        tilting = self.machine.tilting
        return tilting if self.pin is None else tilting.on_pin(self.pin)

    @property
    def rows(self) -> NDArray[np.intp]:
        """Angles with contact, see `lines_pressed`."""
        radius = self.contact.relative_radius
        return np.flatnonzero((radius > 0) & lines_pressed(self.machine, self.force, radius))

    @property
    def tilt(self) -> LineTilt:
        """Tilt of the line of contact."""
        machine, follower = self.machine, self.machine.follower
        return line_tilt(
            self.shaft,
            parallelism=machine.limits[AXIS_PARALLELISM],
            run_out=machine.limits[CAM_RUN_OUT],
            base_radius=self.base_radius,
            clearance=machine.limits[ROLLER_CLEARANCE],
            bearing_length=None if follower.slides else follower.line_width,
            guides=self.tilting.within(machine.guides.spacing),
            twist=self._twist,
            words=self.tilting.words,
        )

    @property
    def _twist(self) -> Array:
        """Turning (n,) of an arm by a contact beside its middle, or of a stem by the couple of a
        second roller, rad.
        """
        machine = self.machine
        if machine.arm is not None:
            return self.tilting.turned(self.pressed, machine.stem_offset + self.beyond)
        turned = self.tilting.turned(self.pressed, machine.stem_offset)
        return np.asarray(turned + self.beside * self.tilt_compliance)

    @property
    def beside(self) -> Array:
        """Couple (n,), N m, of a second roller on the pin about the middle of the first."""
        return couple_of_second(self.force, self.beyond)

    @property
    def loads(self) -> ContactLoads:
        """Curvature, force, tilts and couples of the contacts at the angles with contact."""
        rows, tilt = self.rows, self.tilt
        force = self.force[rows]
        radius = self.contact.relative_radius[rows]
        return ContactLoads(
            1.0 / radius, force, tilt.greatest[rows], tilt.forced[rows],
            np.broadcast_to(self.tilt_compliance, self.force.shape)[rows], self.couple[rows],
            raised_load(force),
        )  # fmt: skip

    @property
    def held(self) -> Array:
        """Couple (n,), N m, that friction of the guides or the load of a pivot holds."""
        return self.tilting.held(self.pressed)

    @property
    def pressed(self) -> TiltingLoads:
        """Loads against which the follower tilts."""
        machine, guides = self.machine, self.guides
        return TiltingLoads(
            self.force,
            (guides.rubbing_load_a, guides.rubbing_load_b),
            machine.guide_friction.greatest,
            self.pivot,
            machine.guides.spacing,
        )

    @property
    def aside(self) -> Array:
        """Couple (n,), N m, of the force at the middle of the line about the stem."""
        return np.asarray(self.force * self.machine.stem_offset)

    @property
    def couple(self) -> Array:
        """Greatest couple (n,), N m, of guide friction, axial offset and place of the roller."""
        return self.held + self.aside + self.beside

    @property
    def rigid_moment(self) -> Array:
        """Upper bound of the moment of the contact about the middle of the follower (n,), N m, for
        bodies whose ends are not known.
        """
        forced, held = self.tilt.forced, self.held
        most = GREATEST_MOMENT * self.force * self.machine.contact_width
        line = rigid_moment(forced, self.tilt_compliance, held, most)
        return follower_moment(line, forced, held, self.aside)

    @property
    def tilt_compliance(self) -> Value:
        """Slope of stem or arm and camshaft together under the moment of the contact, rad/(N m); of
        a pin by finite elements, and of two discs, at each angle (n,).
        """
        machine = self.machine
        follower = self.tilting.compliance(machine.overhang_at_max_lift, machine.guides.spacing)
        return follower + self.shaft_compliance

    def history(self, solved: FactorRange | None) -> LengthHistory:
        """Pressure along the line over the turn from the factors at the angles with contact; None:
        no contact at any angle.
        """
        radius, count = self.contact.relative_radius, self.force.size
        blank = np.where(np.isnan(radius), np.nan, 1.0)
        history = LengthHistory(
            *(blank, blank, blank, np.zeros(count), np.zeros(count, dtype=bool)),
            self.machine.limits[END_MEAN_LENGTH],
            self.tilt,
            self.held,
            self.aside,
            self.machine.is_crowned,
        )
        return history if solved is None else history.with_rows(self.rows, solved)


def length_histories(turns: Sequence[TurnOfLine]) -> tuple[LengthHistory | None, ...]:
    """Pressure along the line of contact of each turn; None where body ends are missing.

    The moment lies between zero and `greatest_moment`. Contacts of the same bodies are evaluated at
    once.
    """
    histories: list[LengthHistory | None] = [None] * len(turns)
    alike: dict[tuple[object, float], list[int]] = {}
    for index, each in enumerate(turns):
        pairs = each.machine.finite_pairs
        if not pairs:
            continue
        if each.rows.size:
            bodies = tuple((pair.bodies, pair.crown) for pair in pairs)
            key = bodies, each.machine.limits[END_MEAN_LENGTH]
            alike.setdefault(key, []).append(index)
        else:
            histories[index] = each.history(None)
    for members in (part for same in alike.values() for part in _parts(turns, same)):
        loads = [turns[index].loads for index in members]
        solved = _together(turns[members[0]].machine, loads)
        starts = np.cumsum([one.force.size for one in loads])[:-1]
        parts = zip(*(np.split(values, starts) for values in solved), strict=True)
        for index, part in zip(members, parts, strict=True):
            histories[index] = turns[index].history(FactorRange(*part))
    return tuple(histories)


def _parts(turns: Sequence[TurnOfLine], members: Sequence[int]) -> Iterator[list[int]]:
    """Groups of turns to be evaluated together, by number: up to `_CONTACTS_AT_ONCE` positions in
    all, one turn at least.

    Parameters
    ----------
    members : sequence of int   numbers of turns of the same bodies
    """
    part: list[int] = []
    contacts = 0
    for index in members:
        count = turns[index].force.size
        if part and contacts + count > _CONTACTS_AT_ONCE:
            yield part
            part, contacts = [], 0
        part.append(index)
        contacts += count
    if part:
        yield part


def _together(machine: Machine, loads: Sequence[ContactLoads]) -> FactorRange:
    """Factors of the contacts of several turns, (all contacts,), joined for one evaluation; at an
    axial offset the worse of both ends.
    """
    joined = ContactLoads(*(np.concatenate(parts) for parts in zip(*loads, strict=True)))
    pairs, mean_length = machine.finite_pairs, machine.limits[END_MEAN_LENGTH]
    fill_together([length_table(pair, mean_length) for pair in pairs])
    return worst_of([factor_range(pair, mean_length, joined) for pair in pairs])


class ContactLoads(NamedTuple):
    """Curvature, force and moment of contacts, all (count,).

    curvature, 1/m, > 0; force, N, > 0; tilt, forced: greatest and forced, rad, see `LineTilt`;
    compliance: of follower and shaft, see `TurnOfLine`; couple: greatest that friction and axial
    offset can hold, N m; raised: factor that raises vanishing loads, see `raised_load`.
    """

    curvature: Array
    force: Array
    tilt: Array
    forced: Array
    compliance: Array
    couple: Array
    raised: Array


class FactorRange(NamedTuple):
    """Axial factors of contacts (count,) over the range of their moment; see `LengthHistory`."""

    centre: Array
    level: Array
    tilted: Array
    moment: Array
    at_corner: NDArray[np.bool_]


def factor_range(pair: FinitePair, mean_length: float, loads: ContactLoads) -> FactorRange:
    """Axial factors of contacts at zero and greatest moment of either direction.

    Parameters
    ----------
    mean_length : float   of the mean at a corner, m
    """
    table = length_table(pair, mean_length)
    curvature, raised = loads.curvature, loads.raised
    force = raised * loads.force
    moment = greatest_moment(table, loads)
    directions = (1.0,) if pair.is_symmetric else (-1.0, 1.0)
    count = 1 + len(directions)
    moments = np.concatenate([np.zeros(force.size), *(each * moment for each in directions)])
    solved = signed_factor(table, np.tile(curvature, count), np.tile(force, count), moments)
    parts = zip(*(np.split(values, count) for values in solved), strict=True)
    level, *tilts = (SignedPressure(*part) for part in parts)
    worse = tilts[0].value > tilts[-1].value * (1.0 + TIE)
    tilted = np.where(worse, tilts[0].value, tilts[-1].value)
    corner = np.where(worse, tilts[0].at_corner, tilts[-1].at_corner)
    at_corner = np.where(level.value > tilted, level.at_corner, corner)
    return FactorRange(level.centre, level.value, tilted, moment / raised, at_corner)


class TiltedPair(Protocol):
    """Pair of bodies with the moment of the contact as a function of the tilt."""

    @property
    def pair(self) -> FinitePair: ...
    def moment_at_tilt(
        self, curvature: Array, force: Array, tilt: Array, most: Array, compliance: Array
    ) -> Array:
        """Moment (count,), N m, of contacts between supports tilted by `tilt` (count,), rad.

        At most about `most`, N m. compliance, rad/(N m): by which one support yields.
        """
        ...


def greatest_moment(lines: TiltedPair, loads: ContactLoads) -> Array:
    """Greatest moment about the middle of contacts (count,), N m, >= 0, at raised loads.

    Within the clearances of the guides the stem aligns itself with the cam but for the couple that
    friction and axial offset hold: the moment is the lesser of it and of that of the greatest tilt.
    Beyond them the tilt is forced on the contact, less what stem and camshaft bend: the moment is
    that one if it is greater. Of both directions the greater.
    """
    force, couple = loads.raised * loads.force, loads.raised * loads.couple
    limit = (1.0 - _MOMENT_LIMIT_ROUND_OFF) * GREATEST_MOMENT * force * lines.pair.contact_length
    held, rigid = np.minimum(couple, limit), np.zeros_like(force)
    rows = np.flatnonzero(loads.forced > 0)
    moments = np.zeros_like(force)
    for sign in (1.0,) if lines.pair.is_symmetric else (-1.0, 1.0):
        turned = lines.moment_at_tilt(loads.curvature, force, sign * loads.tilt, held, rigid)
        moments = np.maximum(moments, np.minimum(np.abs(turned), held))
        if rows.size:
            bent = lines.moment_at_tilt(
                loads.curvature[rows], force[rows], sign * loads.forced[rows],
                limit[rows], loads.compliance[rows],
            )  # fmt: skip
            moments[rows] = np.maximum(moments[rows], np.minimum(np.abs(bent), limit[rows]))
    return moments


def raised_load(force: Array) -> Array:
    """Factors (count,) >= 1 that raise vanishing loads to the lightest solved load.

    A vanishing load, of no pressure that counts, has the factor of pressure of that one.
    """
    return np.maximum(_LIGHTEST_SHARE * force.max() / force, 1.0)


def worst_of(ranges: Sequence[FactorRange]) -> FactorRange:
    """Factors of the end with the greater pressure at each position, with the greater pressure of
    both in the middle.
    """
    worst = ranges[0]
    for other in ranges[1:]:
        least = np.maximum(worst.level, worst.tilted) * (1.0 + TIE)
        worse = np.maximum(other.level, other.tilted) > least
        chosen = (np.where(worse, new, old) for new, old in zip(other, worst, strict=True))
        worst = FactorRange(*chosen)._replace(centre=np.maximum(worst.centre, other.centre))
    return worst


def factor_at_pressure(pair: FinitePair, pressure: float, mean_length: float) -> float:
    """Stated pressure of an untilted line of contact over its plane-strain peak pressure.

    Parameters
    ----------
    pressure : float      of plane strain, Pa: sets the force
    mean_length : float   over which the pressure at a corner is averaged, m
    """
    half_width = 2.0 * pressure / (pair.contact_modulus * pair.curvature)
    force = 0.5 * np.pi * half_width * pressure * pair.contact_length
    edges, line = length_table(pair, mean_length).of_one(pair.curvature, force)
    corner = pair.has_singular_end
    flat = pair.contact_length
    return float(signed_pressure(edges, line, flat, mean_length, has_corner=corner).value[0])


class AxialPressures(Protocol):
    """Axial pressure of a pair, tabulated or solved; mean_length (m) of a corner mean."""

    @property
    def pair(self) -> FinitePair: ...
    @property
    def mean_length(self) -> float: ...

    def axial_pressure(
        self, curvature: ArrayLike, force: ArrayLike, moment: ArrayLike = 0.0
    ) -> tuple[Array, Array]:
        """Edges (count, m + 1), m, along y and pressures (count, m) over plane-strain p0, x = 0."""
        ...


def signed_factor(
    table: AxialPressures, curvature: Array, force: Array, moment: Array
) -> SignedPressure:
    """Stated pressure of contacts over plane strain; see `signed_pressure`."""
    edges, line = table.axial_pressure(curvature, force, moment)
    flat, corner = table.pair.contact_length, table.pair.has_singular_end
    return signed_pressure(edges, line, flat, table.mean_length, has_corner=corner)


def length_table(pair: FinitePair, mean_length: float) -> FactorTable:
    """Cached table of the axial pressure of a pair of bodies, of any curvature.

    mean_length : float   of the mean at a corner, m
    """
    return _table(pair.bodies, pair.crown, mean_length)


@lru_cache(maxsize=64)
def _table(bodies: tuple[FiniteBody, FiniteBody], crown: Crown, mean_length: float) -> FactorTable:
    return factor_table(FinitePair(bodies, _ANY_CURVATURE, crown), mean_length)
