"""What rolling or sliding does beside pressing: traction, creep, film, fatigue, bore."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from camwright.geometry.arrays import FULL_TURN, Array, freeze, uniform_turn
from camwright.pipeline.case.case import Case
from camwright.pipeline.contact.bore_stress import BoreStress, bore_stress
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair, CycleBodies
from camwright.pipeline.contact.oil_film import entrainment_speed
from camwright.pipeline.contact.rolling_envelope import (
    STATIONS,
    Envelope,
    FatigueLimits,
    rolling_pass,
    swept,
)
from camwright.pipeline.contact.tangential_patch import rolling_increase
from camwright.pipeline.contact.traction import Drag, RollingContact, ring_inertia, rolling_contact
from camwright.pipeline.cycle.oil_film_history import FilmHistory, film_history
from camwright.pipeline.follower.flat_face_motion import FaceSliding, face_motion
from camwright.pipeline.follower.follower_forces import FollowerSystem, Loads, follower_loads
from camwright.pipeline.follower.roller_motion import RollerMotion, roller_motion

# Of the contact angles, every so many tell what the real body adds.
_THINNED = 4
_MM, _MPA = 1e3, 1e-6
MAPS = ("von_mises", "tau_max", "shear_range", "crossland", "dang_van")


@dataclass(frozen=True, eq=False)
class RollingHistory:
    """One turn, arrays (n,) SI; None where the case does not say what it takes.

    traction_demand, tangential over normal force that rolling without slip asks for, NaN where
    the contact is open, None under a face; sliding, that of a face; shear_range of the shear
    along the surface, in the cam; bore, None in a look ahead; envelope, the map of greatest
    stresses; contact, with creep and skid; tau_max and von_mises in the cam with the traction of
    rolling or sliding added, Pa; film.
    """

    shear_range: Array
    bore: BoreStress | None
    envelope: Envelope
    traction_demand: Array | None = None
    sliding: FaceSliding | None = None
    contact: RollingContact | None = None
    tau_max: Array | None = None
    von_mises: Array | None = None
    film: FilmHistory | None = None

    def __post_init__(self) -> None:
        freeze(self, shear_range=self.shear_range)
        if self.traction_demand is not None:
            freeze(self, traction_demand=self.traction_demand)

    def columns(self) -> Mapping[str, Array]:
        """SI values by the names of the columns of ``5_cycle.csv``."""
        found = {"shear_range": self.shear_range}
        if self.traction_demand is not None:
            found["traction_demand"] = self.traction_demand
        if self.sliding is not None:
            found |= self.sliding.columns()
        if self.bore is not None:
            found |= {
                "bore_stress": self.bore.von_mises,
                "bore_stress_at_edge": self.bore.at_edge,
                "bore_stress_off_edges": self.bore.away_from_edges,
            }
        if self.contact is not None:
            skid = self.contact.utilisation
            found |= {
                "creepage": self.contact.creepage,
                "slip": self.contact.slip,
                "skid": np.where(np.isfinite(skid), skid, np.nan),
            }
        if self.tau_max is not None and self.von_mises is not None:
            found |= {"tau_max_rolling": self.tau_max, "von_mises_rolling": self.von_mises}
        if self.film is not None:
            found |= self.film.columns()
        return found


def rolling_history(
    case: Case,
    pair: ContactPair,
    bodies: CycleBodies | None,
    loads: Loads,
    contact: ContactHistory,
    cam_speed: float,
) -> RollingHistory:
    """The turn at the angles of its loads, cam speed rad/s.

    Without the meshed bodies it is a look ahead, on half-planes and with nothing of the bore.
    """
    contour, theta, normal_force = pair.contour, loads.theta, np.asarray(loads.normal_force)
    ride = _slid if case.follower.face is not None else _rolled
    found = ride(case, pair, theta, normal_force, contact, cam_speed)
    shear = mises = None
    if found.carried is not None and case.facing.friction is not None:
        more = rolling_increase(pair.cam.poisson, case.facing.friction, found.carried)
        shear, mises = contact.tau_max * more[0], contact.von_mises * more[1]
    reach = rolling_pass(pair.cam.poisson).shear_range.max()
    return RollingHistory(
        shear_range=reach * contact.p0,
        bore=None
        if bodies is None
        else bore_stress(
            bodies.cam, contour.points(theta), contour.normal(theta), contact.line_load
        ),
        envelope=_envelope(case, pair, bodies, loads, contact, cam_speed),
        traction_demand=found.demand,
        sliding=found.sliding,
        contact=found.contact,
        tau_max=shear,
        von_mises=mises,
        film=film_history(case, contact, pair.contact_modulus, found.entrainment),
    )


@dataclass(frozen=True, eq=False)
class _Ride:
    """How the surfaces pass, (n,): entrainment m/s; carried, traction over friction times load."""

    entrainment: Array
    carried: Array | None = None
    demand: Array | None = None
    contact: RollingContact | None = None
    sliding: FaceSliding | None = None


def _rolled(
    case: Case,
    pair: ContactPair,
    theta: Array,
    normal_force: Array,
    contact: ContactHistory,
    cam_speed: float,
) -> _Ride:
    contour, given = pair.contour.require_roller(), case.roller.friction
    motion = roller_motion(contour.pitch, contour.roller_radius, cam_speed, theta)
    # Without friction given the roller holds: a limit that nothing reaches.
    driven = _driven(case, motion, normal_force, contact, cam_speed, given or np.inf)
    loaded = normal_force > 0
    demand = np.abs(driven.demand) / np.where(loaded, normal_force, np.nan)
    if given is None:
        return _Ride(entrainment_speed(motion.rolling_speed), demand=demand)
    carried = driven.force / np.where(loaded, given * normal_force, 1.0)
    return _Ride(
        entrainment_speed(motion.rolling_speed, driven.slip),
        carried=np.clip(np.abs(carried), 0.0, 1.0),
        demand=demand,
        contact=driven,
    )


def _slid(
    case: Case,
    pair: ContactPair,
    theta: Array,
    normal_force: Array,
    contact: ContactHistory,
    cam_speed: float,
) -> _Ride:
    motion = face_motion(pair.contour.pitch, cam_speed, theta)
    friction = case.follower.face_friction
    return _Ride(
        motion.entrainment,
        carried=(normal_force > 0).astype(float),
        sliding=FaceSliding.of(motion, contact.p0, normal_force, friction, cam_speed),
    )


def _driven(
    case: Case,
    motion: RollerMotion,
    normal_force: Array,
    contact: ContactHistory,
    cam_speed: float,
    friction: float,
) -> RollingContact:
    roller = case.roller
    inertia = roller.inertia
    if inertia is None:
        density = case.material(roller.material).density
        inertia = ring_inertia(roller.radius, roller.hub_radius, roller.width, density)
    return rolling_contact(
        normal_force,
        motion.spin,
        motion.rolling_speed,
        contact.half_width,
        contact.relative_radius,
        drag=Drag(
            inertia=inertia,
            friction=min(friction, 1e6),
            torque=roller.bearing.drag_torque or 0.0,
            bearing_friction=roller.bearing.friction or 0.0,
            pin_radius=roller.hub_radius,
        ),
        radius=roller.radius,
        period=FULL_TURN / cam_speed,
    )


def _envelope(
    case: Case,
    pair: ContactPair,
    bodies: CycleBodies | None,
    loads: Loads,
    contact: ContactHistory,
    cam_speed: float,
) -> Envelope:
    """The map at stations of its own, under the loads there."""
    stations, theta = uniform_turn(STATIONS), loads.theta
    system = replace(FollowerSystem.from_case(case), rubbing=loads.rubbing)
    there = follower_loads(pair.contour.pitch, system, cam_speed, stations)
    card = case.material(case.cam.material)
    limits = None
    if card.fatigue_torsion is not None and card.fatigue_bending is not None:
        limits = FatigueLimits(card.fatigue_torsion, card.fatigue_bending)
    load = np.maximum(there.normal_force, 0.0) / pair.width
    added = None if bodies is None else added_stress(pair, bodies, theta, contact.line_load)
    return swept(pair, theta, contact, stations, load, limits=limits, body_stress=added)


def added_stress(pair: ContactPair, bodies: CycleBodies, theta: Array, line_load: Array) -> Array:
    """Stress (3, n) along the contour, Pa, that the real cam adds under loads (n,) N/m.

    Known at every few angles and drawn out between them: what a wall adds is smooth.
    """
    few = theta[::_THINNED]
    unit = bodies.cam.correction(pair.contour.points(few), pair.contour.normal(few)).along
    along = line_load * np.interp(theta, few, unit, period=FULL_TURN)
    return np.stack([along, np.zeros_like(along), np.zeros_like(along)])


def envelope_arrays(turns: Mapping[str, RollingHistory | None]) -> dict[str, Array]:
    """Arrays of ``5_envelope.npz`` by load case: a row per station, a column per depth."""
    found = {}
    for load_case, turn in turns.items():
        if turn is None:
            continue
        map_ = turn.envelope
        found[f"{load_case}.cam_angle_deg"] = np.degrees(map_.theta)
        found[f"{load_case}.arc_mm"] = _MM * map_.arc
        found[f"{load_case}.depth_mm"] = _MM * map_.depth
        for name in MAPS:
            values = getattr(map_, name)
            if values is not None:
                found[f"{load_case}.{name}_MPa"] = _MPA * values
    return found


def rolling_record(turns: Mapping[str, RollingHistory | None]) -> dict[str, Any]:
    """The turn's worst places by load case, mm and MPa, for ``trial.json``."""
    return {name: None if turn is None else _worst(turn) for name, turn in turns.items()}


def _worst(turn: RollingHistory) -> dict[str, Any]:
    record: dict[str, Any] = {}
    for name in MAPS:
        if getattr(turn.envelope, name) is not None:
            value, theta, depth = turn.envelope.worst(name)
            if not np.isfinite(value):  # somewhere the contact is not known
                record[name] = None
                continue
            record[name] = {
                "value_MPa": _MPA * value,
                "cam_angle_deg": float(np.degrees(theta)),
                "depth_mm": _MM * depth,
            }
    if turn.bore is not None:
        record["bore"] = _worst_of_bore(turn.bore)
    if turn.contact is not None:
        loss = turn.contact.loss
        record["sliding_loss_J_per_cam_turn"] = loss if np.isfinite(loss) else None
        record["skidding_share"] = float(turn.contact.skidding.mean())
    if turn.sliding is not None:
        record["sliding_loss_J_per_cam_turn"] = turn.sliding.loss
    if turn.film is not None and turn.film.mixed is not None:
        record["mixed_film"] = turn.film.record()
    return record


def _worst_of_bore(bore: BoreStress) -> dict[str, Any]:
    k = int(bore.von_mises.argmax())
    return {
        "von_mises_MPa": _MPA * float(bore.von_mises[k]),
        "x_mm": _MM * float(bore.x[k]),
        "y_mm": _MM * float(bore.y[k]),
        "away_from_edges_MPa": _MPA * float(bore.away_from_edges.max()),
        "note": "at an edge of the keyway, where the value grows with refinement"
        if bore.at_edge[k]
        else "",
    }
