"""Cycle: loads, contact, rolling and part loads over one cam turn."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass, replace
from functools import cached_property
from types import MappingProxyType
from typing import TypeVar

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.errors import ContactError
from camwright.pipeline.base.kept_results import KeptResult
from camwright.pipeline.base.tables import (
    CAM_ANGLE,
    CRANK_ANGLE,
    LOAD_CASE,
    Cells,
    Column,
    Table,
    Tabled,
    table,
)
from camwright.pipeline.case.limits import END_MEAN_LENGTH
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.finite_length.length_certificate import EndCorrection
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.contact_setup import CarryingWall
from camwright.pipeline.cycle.crossover_history import Flights, WallImpact, flights, landed
from camwright.pipeline.cycle.elastic_response import ElasticHistory, elastic_history
from camwright.pipeline.cycle.length_history import LengthHistory, TurnOfLine, length_histories
from camwright.pipeline.cycle.part_loads import (
    PartLoads,
    PivotPush,
    beside_first,
    beyond_first,
    part_loads,
    shaft_of,
    spring_surge,
)
from camwright.pipeline.cycle.pivot_history import PivotHistory, pin_slopes, pivot_history
from camwright.pipeline.cycle.rolling_history import RollingHistory, rolling_history
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.follower.camshaft_loads import ShaftLoads
from camwright.pipeline.follower.follower_forces import (
    Carried,
    Loads,
    axial_of_surge,
    follower_loads,
)
from camwright.pipeline.follower.guide_effects import GuideShares, guide_shares
from camwright.pipeline.follower.guide_reactions import GuideReactions, guide_reactions
from camwright.pipeline.follower.shaft_strength import (
    couple_compliance,
    in_the_normal,
    slope_under,
    slopes_of,
)
from camwright.pipeline.follower.spring import Spring

LIFT = Column("lift", "mm", "Lift")
PRESSURE_ANGLE = Column("pressure_angle", "deg", "Pressure angle")
PITCH_RADIUS = Column("pitch_radius_of_curvature", "mm", "Radius of curvature of the pitch curve")
CONTOUR_RADIUS = Column("contour_radius_of_curvature", "mm", "Radius of curvature of the contour")

BETWEEN = 8  # angles of the closed forms of the forces, over those at which guides are solved
_ALONG = (
    *("spring_force", "applied_force", "inertia_force", "viscous_force"),
    *("normal_force", "lift_slope", "jam_index", "driving_jam", "stem_force"),
)
_OF_CLEARANCE = ("flights", "impacts")
"""Results that change with the clearance between two tracks."""
_OF_GUIDES = (
    *("guide_", "jam_index_", "stem_slope", "stem_end", "residual_guide", "residual_friction"),
    *("normal_force_statics", "normal_force_by_", "normal_force_friction"),
)
"""Beginnings of the columns of stem and guides, which an arm does not have."""


def least_spring_force(spring: Spring, contour: Contour) -> float:
    """Force of the spring at the minimum lift of a contour, N."""
    return float(spring.force(np.asarray(contour.pitch.lift.lowest.value)))


@dataclass(frozen=True, eq=False, repr=False)
class Cycle(Tabled):
    """Turn of a load case with its contact; rolling, part loads, elastic response on demand.

    bodies are the meshed bodies of the contact; None in a preview, where the contact is that of
    half-planes, and for a contour that encloses no body, where it is unknown. None inside rolling
    and part loads means that the machine has no such part. error_bars: demands have those of their
    sampling; without where ratios of demands alone count. ends: finite elements over half-spaces
    of the pressure along the line of contact, of preloaded discs of each; (): half-spaces alone.
    idle: contact on the track that bears less, of preloaded discs; None of others. results: by
    name, computed from loads and contact.
    """

    turn: Turn
    contour: Contour
    pair: ContactPair
    bodies: CycleBodies | None
    contact: ContactHistory
    error_bars: bool = field(default=True, kw_only=True)
    ends: tuple[EndCorrection, ...] = field(default=(), kw_only=True)
    idle: ContactHistory | None = field(default=None, kw_only=True)
    results: dict[str, object] = field(default_factory=dict, init=False)

    def with_ends(self, corrections: tuple[EndCorrection, ...]) -> Cycle:
        """The cycle with the pressure along the line of contact corrected by finite elements, by
        one correction or that of each of preloaded discs.

        (): by half-spaces. What is computed already and does not depend on it is kept.
        """
        if corrections == self.ends:
            return self
        cycle = replace(self, ends=corrections)
        unchanged = (
            "parts",
            "pin_slope",
            "pivot",
            "shaft",
            "sideways",
            "elastic",
            *(() if self.machine.is_crowned else ("rolling",)),
        )
        cycle.results.update({k: value for k, value in self.results.items() if k in unchanged})
        return cycle

    def adopt(self, other: Cycle) -> None:
        """Take over results computed by another cycle of the same loads and contact; its landings
        where the clearance is the same.
        """
        same = self.machine.deviation == other.machine.deviation
        results = other.results.items()
        self.results.update({k: each for k, each in results if same or k not in _OF_CLEARANCE})

    @property
    def facts(self) -> Mapping[str, object]:
        """Load case, positions and depth of the contact."""
        tier = self.contact.tier
        contact = "unknown" if tier is None else tier.word
        return {"load_case": self.load_case, "positions": self.theta.size, "contact": contact}

    @cached_property
    def table(self) -> Table:
        """The columns of ``5_cycle.csv``, in the units of their headers."""
        return table(self.columns())

    @property
    def machine(self) -> Machine:
        """The machine in this load case."""
        return self.turn.machine

    @property
    def load_case(self) -> str:
        """Name of the load case."""
        return self.turn.machine.load_case

    @property
    def theta(self) -> Array:
        """Cam angles (n,), rad."""
        return self.turn.theta

    @property
    def loads(self) -> Loads:
        """Forces on the follower."""
        return self.turn.loads

    @cached_property
    def loads_between(self) -> Loads:
        """Forces on a grid `BETWEEN` times finer, for extremes between the solved angles.

        The closed forms with the rubbing load of the guides linear between the angles, and linear
        between them too what the solved forces of `_ALONG` differ by.
        """
        machine, solved = self.machine, self.loads
        theta = uniform_turn(BETWEEN * self.theta.size)
        system = replace(machine.system, rubbing=solved.rubbing)
        closed = follower_loads(self.contour.pitch, system, machine.cam_speed, theta)

        def corrected(name: str) -> Array:
            form = getattr(closed, name)
            off = getattr(solved, name) - form[::BETWEEN]
            return np.asarray(form + np.interp(theta, self.theta, off, period=FULL_TURN))

        held, second = closed.held, closed.second
        arrays = {name: corrected(name) for name in _ALONG}
        return replace(closed, held=held, second=second, **arrays)

    @cached_property
    def end(self) -> tuple[float, str] | None:
        """Cam angle, rad, at which the loads of the turn end, and why, between solved angles too.

        None: nowhere; see `Loads.end`.
        """
        return self.loads_between.end

    @property
    def guides(self) -> GuideReactions:
        """Reactions of the guides."""
        return self.turn.guides

    @property
    def least_spring_force(self) -> float:
        """Spring force at minimum lift, N: the preload where the minimum lift is zero."""
        return least_spring_force(self.machine.spring, self.contour)

    @property
    def surged_force(self) -> Array:
        """Normal force (n,), N, >= 0, with the surge of the spring; without a wound spring as
        solved.
        """
        loads = self.loads
        surge = spring_surge(self.machine, loads.lift)
        if surge is None:
            return loads.normal_force
        axial = axial_of_surge(self.contour.pitch, self.machine.system, loads, surge)
        added = loads.wall * axial / (loads.lever * np.cos(loads.pressure_angle))
        surged = loads.normal_force + added
        return np.abs(surged) if loads.held else np.asarray(np.maximum(surged, 0.0))

    @property
    def cam_speed(self) -> float:
        """Mean cam speed, rad/s."""
        return self.turn.machine.cam_speed

    @KeptResult
    def length(self) -> LengthHistory | None:
        """Pressure along the line of contact; None where the case lacks an end, or without body."""
        return None if self.contact.tier is None else _lengths([self])[0]

    @property
    def follower_moment(self) -> Array:
        """Greatest moment (n,) of the contact about the middle of the follower, N m.

        In the plane of its normal and the cam axis. An upper bound without the ends, and where the
        loads end: the line of contact is not solved there.
        """
        length = None if self.end is not None else self.length
        return turn_of_line(self).rigid_moment if length is None else length.follower_moment

    @property
    def pin_couple(self) -> Array:
        """Greatest moment of the contact on the pin (n,) about the middle of the first roller, N m:
        `follower_moment`, and the force of a second one beside it.
        """
        return self.follower_moment + beside_first(self.machine, self.loads)

    @KeptResult
    def sideways(self) -> GuideReactions | None:
        """Reactions of the guides across the plane of the cam, under the couple that a forced tilt
        of the contact bends the stem with.

        The part of `follower_moment` in that plane, at the angles with a forced tilt, and that of a
        second roller beside the first; None where there is none.
        """
        turn = turn_of_line(self)
        couple = np.where(turn.tilt.forced > 0.0, self.follower_moment, 0.0) + turn.beside
        couple = couple * np.cos(self.loads.pressure_angle)
        if not couple.any():
            return None
        machine, knots = self.machine, self.guides.knots_a.size
        still, reach = np.zeros(couple.size), self.loads.overhang
        return guide_reactions(still, reach, machine.stem, machine.guides, couple, knots)

    @property
    def guide_pushes(self) -> tuple[Array, Array]:
        """`bearing_load_a` and `_b` of the guides (n,), N, with those across the cam's plane."""
        guides, across = self.guides, self.sideways
        loads = guides.bearing_load_a, guides.bearing_load_b
        if across is None:
            return loads
        others = across.bearing_load_a, across.bearing_load_b
        return np.hypot(loads[0], others[0]), np.hypot(loads[1], others[1])

    @property
    def guide_rubbing(self) -> tuple[Array, Array]:
        """`rubbing_load_a` and `_b` of the guides (n,), N, with those across the cam's plane."""
        guides, across = self.guides, self.sideways
        loads = guides.rubbing_load_a, guides.rubbing_load_b
        if across is None:
            return loads
        others = across.rubbing_load_a, across.rubbing_load_b
        return np.hypot(loads[0], others[0]), np.hypot(loads[1], others[1])

    @property
    def hot_friction(self) -> tuple[Array, Array]:
        """Friction forces of guides A and B at maximum friction (n,), N, with those of the pushes
        across the cam's plane.
        """
        worst, across = self.turn.friction.greatest, self.sideways
        forces = worst.friction_force_a, worst.friction_force_b
        if across is None:
            return forces
        mu_a, mu_b = self.machine.guide_friction.greatest
        others = mu_a * across.rubbing_load_a, mu_b * across.rubbing_load_b
        return np.hypot(forces[0], others[0]), np.hypot(forces[1], others[1])

    @property
    def guide_lines(self) -> tuple[Array, Array]:
        """Greatest line loads in guides A and B (n,), N/m, with those across the cam's plane."""
        guides, across = self.guides, self.sideways
        if across is None:
            return guides.line_pressure_max_a, guides.line_pressure_max_b
        both = (
            np.hypot(guides.line_pressure_a, across.line_pressure_a),
            np.hypot(guides.line_pressure_b, across.line_pressure_b),
        )
        return both[0].max(axis=0), both[1].max(axis=0)

    @property
    def signed_pressure(self) -> Array:
        """Signed contact pressure (n,), Pa, ends and tilt included; NaN without the ends."""
        factor = np.full(self.theta.size, np.nan) if self.length is None else self.length.factor
        return factor * self.contact.p0

    @KeptResult
    def on_other_track(self) -> Cycle | None:
        """The cycle seen from the track that bears less, of preloaded discs; None of others.

        Its contact and normal force are those of that track, the rest is of both.
        """
        if self.idle is None:
            return None
        loads, machine = self.loads, self.machine
        there = Carried.at(self.contour.pitch, machine.system, self.theta, -loads.wall)
        seen = replace(
            loads, axial_force=-loads.axial_force, normal_force=loads.idle_force,
            idle_force=loads.normal_force, pressure_angle=there.pressure_angle, turned=there.turned,
        )  # fmt: skip
        other = replace(self, turn=replace(self.turn, loads=seen), contact=self.idle,
                        pair=self.pair.other_track, idle=self.contact)  # fmt: skip
        of_both = {"shaft": self.shaft, "pin_slope": self.pin_slope}
        other.results.update({**of_both, "on_other_track": self})
        return other

    @property
    def pressed_harder(self) -> Cycle:
        """The cycle with contact and bodies of the preloaded disc with the greater Hertz pressure
        at each angle; of other cams itself.
        """
        if self.idle is None:
            return self
        other = self.idle.p0_hertz > self.contact.p0_hertz
        wall = CarryingWall(self.theta, np.where(other, -1.0, 1.0) * self.loads.wall)
        contact, pair = self.contact.where(other, self.idle), replace(self.pair, wall=wall)
        return replace(self, contact=contact, pair=pair, idle=None)

    def on_each_disc(self, measure: Callable[[Cycle], Array]) -> tuple[Array, ...]:
        """Measure (n,) of the cycle on each of preloaded discs over the turn; of others as it
        is.
        """
        here, other = measure(self), self.on_other_track
        if other is None:
            return (here,)
        less, first = measure(other), self.loads.wall > 0.0
        return np.where(first, here, less), np.where(first, less, here)

    @KeptResult
    def surface(self) -> ContactHistory:
        """Contact in the middle of the line of contact; the plane contact of straight bodies."""
        if self.length is None or not self.machine.is_crowned:
            return self.contact
        return self.length.in_the_middle(self.contact)

    @KeptResult
    def rolling(self) -> RollingHistory:
        """Traction, creep, film, fatigue and bore stress; NaN if the contour is no body."""
        if self.contact.tier is None:
            return RollingHistory.unknown(self.theta.size)
        other = self.on_other_track
        return rolling_history(
            *(self.machine, self.pair, self.bodies, self.loads, self.surface),
            None if other is None else other.surface,
        )

    @KeptResult
    def pin_slope(self) -> Array | None:
        """Slope of the pin of a pivot in its bush per couple (n,), rad/(N m), by finite elements.

        None in a preview, without a bush or load there, and where the loads end.
        """
        push = self._push(np.zeros(self.theta.size))
        return None if push is None else pin_slopes(push, self._end_mean)

    @KeptResult
    def pivot(self) -> PivotHistory | None:
        """Pin in the bush of a pivot by finite elements; None as for `pin_slope`, and where its
        contact is not found.
        """
        push = self._push(self.follower_moment)
        try:
            return None if push is None else pivot_history(push, self._end_mean, self.theta)
        except ContactError:
            return None

    def _push(self, moment: Array) -> PivotPush | None:
        """Load of the pin of a pivot to be solved by finite elements, None where it is not; moment
        (n,) of the contact about the middle of the follower, N m.
        """
        if self.contact.tier is not Tier.CYCLE or self.end is not None:
            return None
        return PivotPush.of(self.machine, self.loads, moment)

    @property
    def _end_mean(self) -> float:
        """Length of a mean pressure at an end with a corner, m."""
        return self.machine.limits[END_MEAN_LENGTH]

    @KeptResult
    def parts(self) -> PartLoads:
        """Loads of guides, stem, spring, pin, key and shaft over the turn."""
        parts = part_loads(
            self.turn,
            self.contour,
            self.pair.width,
            self.shaft,
            self.guide_lines,
            self.hot_friction,
            self.follower_moment,
        )
        if self.pivot is None:
            return parts
        return replace(parts, pivot_edge_pressure=self.pivot.edge_pressure)

    @KeptResult
    def shaft(self) -> ShaftLoads | None:
        """Loads of the camshaft; None where the case does not describe one."""
        return shaft_of(self.turn, self.contour)

    @property
    def shaft_tilt(self) -> Array:
        """Slope of the camshaft at the cam in the plane of the contact normal (n,), rad, signed; of
        a pair at the disc that carries.

        Zero where the case does not state the diameter and material of a camshaft.
        """
        machine, loads = self.machine, self.shaft
        slopes = slopes_of(machine.camshaft, machine.cam.spacing)
        if not slopes or loads is None:
            return np.zeros(self.theta.size)
        pushes = (loads.cam,) if loads.second is None else (loads.cam, loads.second.force)
        pulls = self.loads.wall < 0.0
        bent = slope_under(slopes, pushes, loads.gear, loads.counterweight, pulls)
        return in_the_normal(bent, self.loads.normal_direction)

    @KeptResult
    def elastic(self) -> ElasticHistory:
        """Motion of the follower as elastic train over the turn: deflection, contact force, losses
        of contact.

        A preview does not integrate the flights of a follower that leaves the cam.
        """
        flights = self.contact.tier is not Tier.PREVIEW
        turn, lift = self.turn, self.contour.pitch.lift
        return elastic_history(
            turn.machine, lift, turn.loads.lift, turn.driven.speed, flights=flights
        )

    @KeptResult
    def flights(self) -> Flights | None:
        """Flights of the rigid follower between its tracks; None of a cam that does not pull."""
        return flights(self.machine, self.contour)

    @KeptResult
    def impacts(self) -> tuple[WallImpact, ...]:
        """Landings of the follower between its tracks; none of a cam that does not pull."""
        return landed(self.machine, self.contour, self.flights)

    @property
    def landing_loss(self) -> float:
        """Energy lost at the landings between two tracks in a turn, J; NaN: not known."""
        return sum(each.loss for each in self.impacts)

    @property
    def landing_power(self) -> float:
        """Mean power of `landing_loss`, W."""
        return self.landing_loss * self.cam_speed / FULL_TURN

    @property
    def shares(self) -> GuideShares:
        """Changes of reaction and contact force by length and clearance of the guides."""
        turn, machine = self.turn, self.machine
        return guide_shares(
            self.contour.pitch,
            machine.system,
            machine.stem,
            machine.guides,
            machine.cam_speed,
            turn.loads,
            turn.guides,
        )

    @cached_property
    def thinned(self) -> Mapping[int, Cycle]:
        """The cycle at every second and every third position, for the error of an integral.

        By the step; every second where neither divides the number of positions: one step of the
        turn is then a short one, which makes the error seem greater.
        """
        steps = [step for step in (2, 3) if self.theta.size % step == 0] or [2]
        return MappingProxyType({step: self._at_every(step) for step in steps})

    def _at_every(self, step: int) -> Cycle:
        """The cycle at every `step`-th position."""
        count = self.theta.size
        turn, contact = _at_every(self.turn, count, step), _at_every(self.contact, count, step)
        return _ThinnedCycle(turn, self.contour, self.pair, self.bodies, contact, self, step)

    @property
    def _wall_column(self) -> dict[Column, Cells]:
        """Track that carries at each angle, the force on a stem, and of preloaded discs that on the
        other one; nothing of a cam that only pushes.
        """
        loads, machine = self.loads, self.machine
        if not loads.held:
            return {}
        words = "Track that carries: 1 the inner wall or first track, -1 the outer or second"
        columns: dict[Column, Cells] = {Column("wall", "", words): loads.wall}
        if machine.arm is None:
            words = "Axial force towards the track that carries; of preloaded discs that of both"
            columns[Column("stem_force", "N", words)] = loads.stem_force * loads.wall
        if machine.disc_preload is not None:
            words = "Normal force on the preloaded disc that bears less"
            columns[Column("idle_force", "N", words)] = loads.idle_force
        if self.idle is not None:
            words = "Maximum contact pressure on the preloaded disc that bears less"
            hertz, elements = self.idle.p0_hertz, self.idle.p0
            if self.idle.tier is Tier.PREVIEW:
                elements = np.full(hertz.size, np.nan)
            columns |= {
                Column("idle_p0_hertz", "MPa", f"{words}, Hertz", unknown=True): hertz,
                Column("idle_p0_fe", "MPa", f"{words}, finite elements", unknown=True): elements,
            }
        return columns

    @property
    def _conforming_columns(self) -> dict[Column, Cells]:
        """Pressure and half-width of a cam that pulls by a preview, in which contacts may conform;
        nothing of other cams and depths.
        """
        contact, pair = self.contact, self.pair
        if contact.tier is not Tier.PREVIEW or pair.wall is None:
            return {}
        words = "of the contact, conforming where the cam is concave, else Hertz"
        return {
            Column("p0_conforming", "MPa", f"Maximum pressure {words}", unknown=True): contact.p0,
            Column(
                "half_width_conforming", "mm", f"Half-width {words}", unknown=True
            ): contact.half_width,
        }

    def columns(self) -> dict[Column, Cells]:
        """Columns of ``5_cycle.csv``, SI; `table` has them in their units.

        The contact of a contour that encloses no body is unknown.
        """

        def contact_column(name: str, unit: str, meaning: str) -> Column:
            return Column(name, unit, meaning, unknown=True)

        turn, loads, contact, guides = self.turn, self.loads, self.contact, self.guides
        unsolved = np.full(self.theta.size, np.nan)

        def by_elements(values: Array) -> Array:
            """Values of a contact by finite elements; NaN where it is a closed form."""
            return unsolved if contact.tier is Tier.PREVIEW else values

        columns: dict[Column, Cells] = {
            LOAD_CASE: np.full(self.theta.size, self.load_case),
            CAM_ANGLE: self.theta,
            CRANK_ANGLE: self.machine.gear_ratio * self.theta,
            LIFT: loads.lift,
            PRESSURE_ANGLE: loads.pressure_angle,
            PITCH_RADIUS: self.contour.pitch.radius_of_curvature(self.theta),
            CONTOUR_RADIUS: self.contour.radius_of_curvature(self.theta),
            Column("normal_force", "N", "Normal force on the cam"): loads.normal_force,
            **self._wall_column,
            contact_column(
                "line_load", "N/mm", "Normal force over width of the line contact"
            ): contact.line_load,
            contact_column("p0_hertz", "MPa", "Maximum contact pressure, Hertz"): contact.p0_hertz,
            contact_column(
                "p0_fe", "MPa", "Maximum contact pressure, finite elements"
            ): by_elements(contact.p0),
            contact_column(
                "p0_difference", "percent", "Maximum contact pressure, finite elements over Hertz"
            ): by_elements(contact.p0_difference),
            contact_column(
                "half_width_hertz", "mm", "Half-width of the contact, Hertz"
            ): contact.half_width_hertz,
            contact_column(
                "half_width_fe", "mm", "Half-width of the contact, finite elements"
            ): by_elements(contact.half_width),
            **self._conforming_columns,
            contact_column(
                "tau_max", "MPa", "Maximum in-plane shear stress below the contact"
            ): contact.tau_max,
            contact_column("tau_depth", "mm", "Depth of that shear stress"): contact.tau_depth,
            contact_column(
                "von_mises", "MPa", "Maximum von Mises stress below the contact"
            ): contact.von_mises,
            contact_column(
                "von_mises_depth", "mm", "Depth of that von Mises stress"
            ): contact.von_mises_depth,
            Column("guide_reaction_A", "N", "Reaction of guide A"): guides.reaction_a,
            Column("guide_reaction_B", "N", "Reaction of guide B"): guides.reaction_b,
            Column(
                "guide_reaction_A_statics", "N", "Reaction of guide A as a point support"
            ): guides.statics_a,
            Column(
                "guide_reaction_B_statics", "N", "Reaction of guide B as a point support"
            ): guides.statics_b,
            Column(
                "guide_normal_load_A", "N", "Sum of the normal forces on both sides of guide A"
            ): self.guide_rubbing[0],
            Column(
                "guide_normal_load_B", "N", "Sum of the normal forces on both sides of guide B"
            ): self.guide_rubbing[1],
            Column("spring_force", "N", "Spring force"): loads.spring_force,
            Column("inertia_force", "N", "Inertia force of the follower"): loads.inertia_force,
            Column(
                "axial_force", "N", "Contact force in the direction of the stem"
            ): loads.axial_force,
            Column("side_force", "N", "Contact force across the stem"): loads.tangential_force,
            Column("guide_friction_A", "N", "Friction force of guide A"): loads.friction_force_a,
            Column("guide_friction_B", "N", "Friction force of guide B"): loads.friction_force_b,
            Column(
                "jam_index", "", "Guide friction over axial force, of preloaded discs that of both"
            ): loads.jam_index,
            Column(
                "jam_index_statics", "", "Jam index with point supports as guides"
            ): loads.jam_index_statics,
            Column("cam_speed", "rad/s", "Angular speed of the cam"): turn.driven.speed,
            Column("follower_velocity", "m/s", "Velocity of the follower"): loads.velocity,
            Column("cam_torque", "N m", "Torque that drives the cam"): loads.cam_torque,
            contact_column(
                "residual_equilibrium", "", "Contact pressure against line load, relative"
            ): by_elements(contact.residual_equilibrium),
            contact_column(
                "residual_complementarity", "", "Contact pressure times gap, relative"
            ): by_elements(contact.residual_complementarity),
            contact_column(
                "gap_round_off", "", "Round-off of the gap, relative; above 1e-3 Hertz holds"
            ): by_elements(contact.gap_round_off),
            Column(
                "residual_guide_force", "", "Transverse forces on the follower, relative"
            ): guides.force_residual,
            Column(
                "residual_guide_moment", "", "Moments on the follower, relative"
            ): guides.moment_residual,
            Column(
                "residual_friction", "", "Forces along the stem with guide friction, relative"
            ): turn.friction_residual,
            Column("stem_slope_A", "deg", "Slope of the stem in guide A"): guides.slope_a,
            Column("stem_slope_B", "deg", "Slope of the stem in guide B"): guides.slope_b,
            Column(
                "stem_end_deflection",
                "um",
                "Transverse deflection of the stem at the contact, of preloaded discs at the sum of"
                " both side loads",
            ): guides.roller_deflection,
        }
        if loads.applied_force.any():
            applied = Column("applied_force", "N", "Weight and external force on the follower")
            columns[applied] = loads.applied_force
        if (length := self.length) is not None:
            columns |= {
                contact_column(
                    "p0_signed",
                    "MPa",
                    "Signed contact pressure by half-spaces, ends and tilt included",
                ): self.signed_pressure,
                contact_column(
                    "length_factor", "", "The same over the contact pressure of plane strain"
                ): length.factor,
                contact_column("length_factor_level", "", "The same without tilt"): length.level,
                contact_column(
                    "centre_factor", "", "Contact pressure in the middle over plane strain"
                ): length.centre,
                Column(
                    "shaft_tilt", "mrad", "Slope of the camshaft at the cam, in the contact normal"
                ): length.tilt.shaft,
                Column(
                    "forced_tilt", "mrad", "Tilt of the contact beyond the clearance of the guides"
                ): length.tilt.forced,
                contact_column(
                    "tilt_moment", "N mm", "Greatest moment of the contact force about its middle"
                ): length.moment,
            }
        moment = Column(
            "follower_moment", "N mm", "Greatest moment of the contact about the follower's middle"
        )
        columns[moment] = self.follower_moment
        # An engine at rest has no torque in its load case.
        if turn.torque_before is not None and turn.torque_after is not None:
            before, after = (
                Column(
                    f"torque_{when}", "N m", f"Crank torque {words}, less its mean", unknown=True
                )
                for when, words in (("before", "of the engine alone"), ("after", "with the cam"))
            )
            columns |= {before: turn.torque_before, after: turn.torque_after}
        # The maximum lies in another plane only where the Poisson ratio is small. The peaks of the
        # two fields are fitted separately and agree within 0.3 % where they are one.
        if (contact.tau_any_plane > 1.01 * contact.tau_max).any():
            shear = contact_column(
                "tau_max_all_planes", "MPa", "Maximum shear stress over all planes"
            )
            columns[shear] = contact.tau_any_plane
        if contact.tier is not None:
            columns |= self.rolling.columns()
        columns |= self.parts.columns(self.elastic) | self.shares.columns()
        if self.machine.pivot is not None:
            load = Column("pivot_load", "N", "Load of the arm on its pivot")
            rubs = Column("pivot_friction", "N", "Friction of the pivot, at the reference point")
            columns |= {load: np.hypot(*loads.pivot_load), rubs: loads.pivot_friction}
        if self.pivot is not None:
            columns |= self.pivot.columns()
        if self.machine.arm is None:
            return columns
        return {each: v for each, v in columns.items() if not each.name.startswith(_OF_GUIDES)}


def turn_of_line(cycle: Cycle) -> TurnOfLine:
    """Inputs of the pressure along the line of contact of a cycle."""
    force = cycle.loads.normal_force
    turn = cycle.machine, cycle.contact, force, cycle.guides, cycle.shaft_tilt
    slopes = slopes_of(cycle.machine.camshaft, cycle.machine.cam.spacing)
    pulls, other = cycle.loads.wall < 0.0, cycle.machine.with_second_in_place(cycle.contour)
    base = np.where(pulls, other.base_radius, cycle.machine.base_radius)
    compliance = couple_compliance(slopes, pulls)
    pivot, beyond = np.hypot(*cycle.loads.pivot_load), beyond_first(cycle.machine, cycle.loads)
    return TurnOfLine(*turn, pivot, compliance, base, cycle.pin_slope, np.abs(beyond))


def _lengths(cycles: Sequence[Cycle]) -> list[LengthHistory | None]:
    """Pressure along the line of contact of cycles whose contour encloses a body."""
    turns, corrected = [turn_of_line(each) for each in cycles], list[LengthHistory | None]()
    for cycle, solved in zip(cycles, length_histories(turns), strict=True):
        if solved is None or not cycle.ends:
            corrected.append(solved)
            continue
        first, *others = cycle.ends
        by = first.where(cycle.loads.wall > 0.0, others[0]) if others else first
        corrected.append(solved.corrected(by))
    return corrected


def solve_lengths(cycles: Iterable[Cycle]) -> None:
    """Solve the pressure along the line of contact of several cycles together.

    Raises
    ------
    CamError
        If that of one cannot be solved.
    """
    left = [
        each for each in cycles if each.contact.tier is not None and "length" not in each.results
    ]
    for cycle, length in zip(left, _lengths(left), strict=True):
        cycle.results["length"] = length


@dataclass(frozen=True, eq=False, repr=False)
class _ThinnedCycle(Cycle):
    """A cycle at every few positions of `whole`, with what is computed from it."""

    whole: Cycle
    step: int

    @KeptResult
    def on_other_track(self) -> Cycle | None:
        other = self.whole.on_other_track
        return None if other is None else other._at_every(self.step)

    @KeptResult
    def length(self) -> LengthHistory | None:
        return _at_every(self.whole.length, self.whole.theta.size, self.step)

    @property
    def follower_moment(self) -> Array:
        return self.whole.follower_moment[:: self.step]

    @KeptResult
    def sideways(self) -> GuideReactions | None:
        return _at_every(self.whole.sideways, self.whole.theta.size, self.step)

    @KeptResult
    def pin_slope(self) -> Array | None:
        slope = self.whole.pin_slope
        return None if slope is None else slope[:: self.step]

    @KeptResult
    def rolling(self) -> RollingHistory:
        return _at_every(self.whole.rolling, self.whole.theta.size, self.step)

    @KeptResult
    def parts(self) -> PartLoads:
        return _at_every(self.whole.parts, self.whole.theta.size, self.step)

    @KeptResult
    def shaft(self) -> ShaftLoads | None:
        return _at_every(self.whole.shaft, self.whole.theta.size, self.step)

    @KeptResult
    def elastic(self) -> ElasticHistory:
        return _at_every(self.whole.elastic, self.whole.theta.size, self.step)


Result = TypeVar("Result")


def _at_every(result: Result, count: int, step: int) -> Result:
    """The result with every `step`-th entry of its arrays (count, ...) or (..., count).

    Those of its parts included.
    """
    if isinstance(result, Machine) or not is_dataclass(result) or isinstance(result, type):
        return result
    changed: dict[str, object] = {}
    for each in fields(result):
        value: object = getattr(result, each.name)
        if isinstance(value, np.ndarray):
            if value.shape[:1] == (count,):
                changed[each.name] = value[::step]
            elif value.shape[-1:] == (count,):
                changed[each.name] = value[..., ::step]
        elif (part := _at_every(value, count, step)) is not value:
            changed[each.name] = part
    return replace(result, **changed) if changed else result
