"""Traction, creep, oil film, rolling fatigue and bore stress over a turn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, freeze, uniform_turn
from camwright.geometry.display import Displayed
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.base.tables import Column
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.bore_stress import BoreStress, bore_stress
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.flash_temperature import bulk_rise
from camwright.pipeline.contact.rolling_envelope import (
    STATIONS,
    Envelope,
    FatigueLimits,
    rolling_pass,
    swept,
)
from camwright.pipeline.contact.traction import RollingContact, rolling_increase
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.contact_heat import flash_history, slip_flash
from camwright.pipeline.cycle.contact_setup import CarryingWall, under_load
from camwright.pipeline.cycle.oil_film_history import FilmHistory, film_history
from camwright.pipeline.follower.flat_face_motion import FaceSliding
from camwright.pipeline.follower.follower_forces import Loads, follower_loads
from camwright.pipeline.records.trial_contents import BoreMaximum, RollingRecord, StressMap

# The stress that the real body adds is taken at every so many contact angles.
_THINNED = 4
_MM, _MPA = 1e3, 1e-6
MAPS: Mapping[StressMap, str] = {
    "von_mises": "von Mises stress",
    "tau_max": "in-plane shear stress",
    "shear_range": "range of the orthogonal shear stress",
    "crossland": "equivalent shear stress of Crossland",
    "dang_van": "equivalent shear stress of Dang Van",
}
"""Maps of the maximum stresses of a turn; the last two with the fatigue limits of the material."""
ENVELOPE_ARRAYS = (
    Column("cam_angle", "deg", "(n,) cam angle of a station on the contour"),
    Column("arc_length", "mm", "(n,) along the contour from the first station"),
    Column("depth", "mm", "(n, k) below the contour"),
    *(Column(name, "MPa", f"(n, k) maximum over the turn: {what}") for name, what in MAPS.items()),
)
"""Arrays of ``5_envelope.npz``, each by load case: ``LOAD_CASE.HEADER``."""


class SweptStress:
    """Envelope of the subsurface stresses of a turn, computed on first use.

    Parameters
    ----------
    compute : function   () -> map
    worst : function     () -> its stations with the greatest stresses; None: all
    """

    def __init__(
        self, compute: Callable[[], Envelope], worst: Callable[[], Envelope] | None = None
    ) -> None:
        self._compute, self._worst = compute, worst

    @cached_property
    def envelope(self) -> Envelope:
        """The map."""
        return self._compute()

    @cached_property
    def governing(self) -> Envelope:
        """The map at the stations with the greatest stresses; see `governing_stations`."""
        return self.envelope if self._worst is None else self._worst()


@dataclass(frozen=True, eq=False, repr=False)
class RollingHistory(Displayed):
    """Rolling over one turn; arrays (n,), SI, None where the case lacks data.

    shear_range, Pa, of the orthogonal shear stress in the cam; bore, None in a preview; swept, map
    of the maximum stresses; traction_demand, tangential over normal force of rolling without slip,
    NaN where the contact is open, None under a flat face; sliding of a flat face; flash, rise of
    the temperature in its contact or, of a cam that pulls, in that of a roller that slips, K;
    contact, creep and slip of a roller; tau_max and von_mises, Pa, in the cam with traction; film.
    """

    shear_range: Array
    bore: BoreStress | None
    swept: SweptStress
    traction_demand: Array | None = None
    sliding: FaceSliding | None = None
    flash: Array | None = None
    contact: RollingContact | None = None
    tau_max: Array | None = None
    von_mises: Array | None = None
    film: FilmHistory | None = None

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        freeze(self, shear_range=self.shear_range)
        if self.traction_demand is not None:
            freeze(self, traction_demand=self.traction_demand)
        if self.flash is not None:
            freeze(self, flash=self.flash)

    @property
    def envelope(self) -> Envelope:
        """Map of the maximum stresses below the contour."""
        return self.swept.envelope

    @classmethod
    def unknown(cls, count: int) -> RollingHistory:
        """NaN at every angle: the contour encloses no body."""
        return cls(np.full(count, np.nan), None, SweptStress(Envelope.unknown))

    def columns(self) -> dict[Column, Array]:
        """Columns (n,) of ``5_cycle.csv`` as far as they are known; NaN for a contour that encloses
        no body.
        """

        def column(name: str, unit: str, meaning: str) -> Column:
            return Column(name, unit, meaning, unknown=True)

        columns = {
            column(
                "shear_range", "MPa", "Maximum range of the orthogonal shear stress in the cam"
            ): self.shear_range
        }
        if self.traction_demand is not None:
            demand = column(
                "traction_demand", "", "Traction coefficient that rolling without slip requires"
            )
            columns[demand] = self.traction_demand
        if self.sliding is not None:
            columns |= self.sliding.columns()
        if self.flash is not None:
            part = "of the face" if self.sliding is not None else "of the roller that slips"
            words = f"Rise of the temperature in the contact {part}"
            columns[column("flash_temperature", "K", words)] = self.flash
        if (bore := self.bore) is not None:
            columns |= {
                column(
                    "bore_stress", "MPa", "Maximum von Mises stress at the bore"
                ): bore.von_mises,
                column(
                    "bore_stress_at_edge", "", "1 where that maximum is at an edge of the keyway"
                ): bore.at_edge.astype(float),
                column(
                    "bore_stress_off_edges",
                    "MPa",
                    "Maximum von Mises stress at the bore away from the keyway edges",
                ): bore.away_from_edges,
            }
        if (contact := self.contact) is not None:
            share = contact.utilisation
            columns |= {
                column("creepage", "", "Creep speed over rolling speed"): contact.creepage,
                column("slip_speed", "m/s", "Slip speed of the roller surface"): contact.slip,
                column(
                    "traction_utilisation",
                    "",
                    "Traction that rolling requires over the friction limit",
                ): np.where(np.isfinite(share), share, np.nan),
            }
        if self.tau_max is not None and self.von_mises is not None:
            columns |= {
                column(
                    "tau_max_with_traction", "MPa", "Maximum in-plane shear stress with traction"
                ): self.tau_max,
                column(
                    "von_mises_with_traction", "MPa", "Maximum von Mises stress with traction"
                ): self.von_mises,
            }
        if self.film is not None:
            columns |= self.film.columns()
        return columns


def rolling_history(
    machine: Machine,
    pair: ContactPair,
    bodies: CycleBodies | None,
    loads: Loads,
    contact: ContactHistory,
    idle: ContactHistory | None = None,
) -> RollingHistory:
    """Rolling or sliding over a turn at the angles of its loads: traction, heat, film, fatigue and
    bore stress.

    idle : contact on the track that bears less, of preloaded discs

    Without the meshed bodies the stresses are those of half-planes, and there is no bore stress.
    """
    contour, theta, follower = pair.contour, loads.theta, machine.follower
    motion = follower.motion(contour, contact, loads, machine.cam_speed, idle)
    shear = mises = None
    if motion.traction_share is not None and follower.friction is not None:
        more = rolling_increase(pair.cam.poisson, follower.friction, motion.traction_share)
        shear, mises = contact.tau_max * more[0], contact.von_mises * more[1]
    map_ = partial(_envelope, machine, pair, bodies, loads, contact, idle)
    worst = partial(map_, governing=True) if bodies is None else None
    flash = None
    if motion.sliding is not None:
        flash = flash_history(machine, pair, theta, contact, motion.sliding)
    elif motion.rolling is not None and machine.cam.pulls:
        free = machine.roller.rolling(contour, loads, machine.cam_speed)
        flash = slip_flash(machine, pair.width, free, motion.rolling, contact)
    reach = rolling_pass(pair.cam.poisson).shear_range.max()
    bore = None
    if bodies is not None:
        bore = _bore(pair, bodies, theta, contact.line_load)
    return RollingHistory(
        shear_range=reach * contact.p0,
        bore=bore,
        swept=SweptStress(map_, worst),
        traction_demand=motion.traction_demand,
        sliding=motion.sliding,
        flash=flash,
        contact=motion.rolling,
        tau_max=shear,
        von_mises=mises,
        film=film_history(
            machine, contact, motion.entrainment, 0.0 if flash is None else float(bulk_rise(flash))
        ),
    )


def _envelope(
    machine: Machine,
    pair: ContactPair,
    bodies: CycleBodies | None,
    loads: Loads,
    contact: ContactHistory,
    idle: ContactHistory | None,
    *,
    governing: bool = False,
) -> Envelope:
    """Map of the maximum stresses below the surface over the turn, at its own stations; governing :
    only at those with the greatest stresses. Of preloaded discs it is that of the disc with the
    greater pressure at each station.
    """
    stations, theta = uniform_turn(STATIONS), loads.theta
    system = replace(machine.system, rubbing=loads.rubbing)
    there = follower_loads(pair.contour.pitch, system, machine.cam_speed, stations)
    card, limits = machine.cam.material, None
    if card.fatigue_torsion is not None and card.fatigue_bending is not None:
        limits = FatigueLimits(card.fatigue_torsion, card.fatigue_bending)
    load = np.maximum(there.normal_force, 0.0) / pair.width
    if idle is not None:
        pair = under_load(pair, there)
        less = there.idle_force / pair.width
        pressures = [force / each.relative_radius(stations)
                     for force, each in ((load, pair), (less, pair.other_track))]  # fmt: skip
        harder = CarryingWall(stations, there.wall * (pressures[0] - pressures[1]))
        load = np.where(pressures[1] > pressures[0], less, load)
        contact = contact.where(harder(theta) != loads.wall, idle)
        pair = replace(pair, wall=harder)
    added = None if bodies is None else added_stress(pair, bodies, theta, contact.line_load)
    return swept(
        pair, theta, contact, stations, load, limits=limits, body_stress=added, governing=governing
    )


def _bore(pair: ContactPair, bodies: CycleBodies, theta: Array, line_load: Array) -> BoreStress:
    """Stress of the bores at cam angles (n,), rad: that of the disc which is pressed.

    The force of the outer wall of a groove is taken as one of the same size on the inner one: its
    rim has no bore.
    """
    bore = bore_stress(bodies.cam, *pair.touched(theta), line_load)
    if pair.pulling is None or pair.pulling.rim_radius is not None:
        return bore
    for each, at in pair.on_walls(theta):
        if each is pair.pulling:
            pressed = bodies.of(each).cam, *each.touched(theta[at]), line_load[at]
            bore = bore.where(at, bore_stress(*pressed, excluded=bore.excluded or None))
    return bore


def added_stress(pair: ContactPair, bodies: CycleBodies, theta: Array, line_load: Array) -> Array:
    """Stress along the contour (n,), Pa, of the real cam beyond the half-plane, by line loads.

    Interpolated between every few angles: the effect of a wall is smooth.
    """
    unit = np.empty(theta.size)
    for each, at in pair.on_walls(theta):
        unit[at] = _unit_stress(each, bodies.of(each), theta)[at]
    return line_load * unit


def _unit_stress(pair: ContactPair, bodies: CycleBodies, theta: Array) -> Array:
    """Stress (n,), Pa per N/m, that the body of one surface adds along it."""
    along = bodies.cam.correction(*pair.touched(theta)).along
    return np.interp(theta, theta[::_THINNED], along[::_THINNED], period=FULL_TURN)


def envelope_arrays(turns: Mapping[str, RollingHistory]) -> dict[str, Array]:
    """Arrays of ``5_envelope.npz`` by load case and name: a row per station along the contour, a
    column per depth.
    """
    arrays = {}
    for load_case, turn in turns.items():
        map_ = turn.envelope
        arrays[f"{load_case}.cam_angle_deg"] = np.degrees(map_.theta)
        arrays[f"{load_case}.arc_length_mm"] = _MM * map_.arc
        arrays[f"{load_case}.depth_mm"] = _MM * map_.depth
        for name in MAPS:
            values = getattr(map_, name)
            if values is not None:
                arrays[f"{load_case}.{name}_MPa"] = _MPA * values
    return arrays


def rolling_record(turn: RollingHistory) -> RollingRecord:
    """Record of the greatest stresses below the surface with their places, of the bore, and of the
    losses of a turn.
    """
    record: RollingRecord = {}
    for name in MAPS:
        if getattr(turn.envelope, name) is not None:
            value, theta, depth = turn.envelope.worst(name)
            if not np.isfinite(value):  # the contact is unknown at some angle
                record[name] = None
                continue
            record[name] = {
                "value_MPa": _MPA * value,
                "cam_angle_deg": float(np.degrees(theta)),
                "depth_mm": _MM * depth,
            }
    if turn.bore is not None:
        record["bore"] = _worst_bore_record(turn.bore)
    if turn.contact is not None:
        loss = turn.contact.loss
        record["sliding_loss_J_per_cam_turn"] = loss if np.isfinite(loss) else None
        record["gross_slip_share"] = float(turn.contact.skidding.mean())
    if turn.sliding is not None:
        record["sliding_loss_J_per_cam_turn"] = turn.sliding.loss
    film = None if turn.film is None else turn.film.record()
    if film is not None:
        record["film_thickness_mixed"] = film
    return record


def _worst_bore_record(bore: BoreStress) -> BoreMaximum:
    """Record of the greatest von Mises stress at the bore with its place."""
    k = first_greatest(bore.von_mises)
    return {
        "von_mises_MPa": _MPA * float(bore.von_mises[k]),
        "x_mm": _MM * float(bore.x[k]),
        "y_mm": _MM * float(bore.y[k]),
        "away_from_edges_MPa": _MPA * float(bore.away_from_edges.max()),
        "note": "at an edge of the keyway, where the value grows with refinement"
        if bore.at_edge[k]
        else "",
    }
