"""Loads, contact and guide reactions at every angle of one cam turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from geometry.arrays import Array, freeze, uniform_turn
from geometry.contour import Contour
from pipeline.balance import drilled_hole
from pipeline.case import Case
from pipeline.contact.elastic_body import Elastic
from pipeline.contact.follower_body import FaceBody, FollowerBody, RollerBody
from pipeline.contact.history import ContactHistory
from pipeline.contact.pair import ContactPair, closed_form_history
from pipeline.engine.torque import Torque
from pipeline.follower.forces import FollowerSystem, Loads
from pipeline.follower.guides import KNOTS, GuidePair, GuideReactions
from pipeline.follower.rubbing import guided_loads
from pipeline.follower.stem import Stem
from pipeline.outer_ring import outer_ring
from pipeline.parts import PartsHistory, parts_history
from pipeline.rolling import RollingHistory
from pipeline.speed import cam_speed

_FEW_KNOTS = 5  # of a guide, for a look ahead
# A load case at rest is a turn so slow (rad/s) that inertia, film and heat are as good as none.
CREEP = 1e-3


@dataclass(frozen=True, eq=False)
class Turn:
    """What acts on the cam over one turn of one load case, before the contact is solved.

    Arrays (n,) at the cam angles theta (rad). The loads are in balance with the guides, friction
    included, but for friction_residual, relative. cam_speed, rad/s, is that of a crank that the
    engine and the cam drive, where the case tells its inertia, else constant; the loads are those
    of the constant one. torque_before and residual_torque are crank
    torques (N m) without and with the cam, their means taken off; None without an engine.
    """

    load_case: str
    crank_speed: float
    theta: Array
    loads: Loads
    guides: GuideReactions
    friction_residual: Array
    cam_speed: Array
    torque_before: Array | None
    residual_torque: Array | None

    def __post_init__(self) -> None:
        names = ("theta", "friction_residual", "cam_speed")
        freeze(self, **{name: getattr(self, name) for name in names})
        if self.torque_before is not None and self.residual_torque is not None:
            freeze(self, torque_before=self.torque_before, residual_torque=self.residual_torque)


@dataclass(frozen=True, eq=False)
class Cycle(Turn):
    """A turn with its contact; radii (n,) of curvature in m, signed."""

    pressure_angle: Array
    pitch_radius: Array
    contour_radius: Array
    contact: ContactHistory
    rolling: RollingHistory | None = None
    parts: PartsHistory | None = None

    def columns(self, gear_ratio: float) -> Mapping[str, Array]:
        """SI values by the names of the columns of ``5_cycle.csv``."""
        loads, contact, guides = self.loads, self.contact, self.guides
        found = {
            "load_case": np.full(self.theta.size, self.load_case),
            "cam_angle": self.theta,
            "crank_angle": gear_ratio * self.theta,
            "lift": loads.lift,
            "pressure_angle": self.pressure_angle,
            "pitch_radius": self.pitch_radius,
            "contour_radius_of_curvature": self.contour_radius,
            "normal_force": loads.normal_force,
            "line_load": contact.line_load,
            "p0_hertz": contact.p0_hertz,
            "p0_fe": contact.p0,
            "p0_difference": contact.p0_difference,
            "half_width_hertz": contact.half_width_hertz,
            "half_width_fe": contact.half_width,
            "tau_max": contact.tau_max,
            "tau_depth": contact.tau_depth,
            "von_mises": contact.von_mises,
            "von_mises_depth": contact.von_mises_depth,
            "reaction_A": guides.reaction_a,
            "reaction_B": guides.reaction_b,
            "reaction_A_statics": guides.statics_a,
            "reaction_B_statics": guides.statics_b,
            "spring_force": loads.spring_force,
            "inertia_force": loads.inertia_force,
            "axial_force": loads.axial_force,
            "tangential_force": loads.tangential_force,
            "friction_A": loads.friction_force_a,
            "friction_B": loads.friction_force_b,
            "jam_index": loads.jam_index,
            "jam_index_statics": loads.jam_index_statics,
            "cam_speed": self.cam_speed,
            "velocity": loads.velocity,
            "cam_torque": loads.cam_torque,
            "residual_equilibrium": contact.residual_equilibrium,
            "residual_complementarity": contact.residual_complementarity,
            "residual_guide_force": guides.force_residual,
            "residual_guide_moment": guides.moment_residual,
            "residual_friction": self.friction_residual,
            "stem_slope_A": guides.slope_a,
            "stem_slope_B": guides.slope_b,
            "roller_deflection": guides.roller_deflection,
        }
        if self.torque_before is not None and self.residual_torque is not None:
            found |= {"torque_before": self.torque_before, "torque_after": self.residual_torque}
        # Another plane bears more shear only where the Poisson ratio is small: then it is told.
        # The peaks of the two fields are fitted apart and agree within 0.3 % where they are one.
        if (contact.tau_any_plane > 1.01 * contact.tau_max).any():
            found["tau_any_plane"] = contact.tau_any_plane
        found |= {} if self.rolling is None else self.rolling.columns()
        return found | ({} if self.parts is None else dict(self.parts.columns()))


def contact_width(case: Case) -> float:
    """Width of the line contact, m: what both cam and follower carry, chamfers left out."""
    return float(min(case.cam.width, case.facing.line_width))


def follower_body(case: Case) -> FollowerBody:
    """Roller, outer ring on its balls or block of the face, as the contact meshes it."""
    card, face = case.material(case.facing.material), case.follower.face
    elastic = Elastic(card.E, card.nu)
    if face is None:
        roller, ring = case.roller, outer_ring(case, contact_width(case))
        solid = RollerBody(roller.radius, roller.hub_radius, elastic)
        return solid if ring is None else ring.body
    return FaceBody(face.width, face.thickness, case.follower.stem_diameter, elastic)


def contact_pair(case: Case, contour: Contour) -> ContactPair:
    """Cam and follower of a case."""
    cam = case.material(case.cam.material)
    return ContactPair(
        contour=contour,
        width=contact_width(case),
        bore_radius=case.cam.bore_radius,
        keyway=case.cam.keyway,
        cam=Elastic(cam.E, cam.nu),
        follower=follower_body(case),
        counter_hole=drilled_hole(case, contour),
    )


def turn(
    case: Case,
    contour: Contour,
    torque: Torque | None,
    load_case: str,
    positions: int,
    ahead: bool = False,
) -> Turn:
    """Loads and guide reactions of one load case at `positions` equally spaced cam angles.

    A look ahead takes few knots in the guides and a constant speed.
    """
    theta = uniform_turn(positions)
    ratio = case.mechanism.gear_ratio
    given = next(state.speed for state in case.load_cases if state.name == load_case)
    speed, state = max(given, CREEP), case.at(load_case)
    stem, guides = Stem.from_case(state), GuidePair.from_case(state)
    system = FollowerSystem.from_case(state)
    knots = _FEW_KNOTS if ahead else KNOTS
    found = guided_loads(contour.pitch, system, stem, guides, speed / ratio, theta, knots)
    loads, driven = found.loads, None if ahead else torque
    before = None if torque is None else torque.without_mean().resampled(positions).total
    return Turn(
        load_case=load_case,
        crank_speed=speed,
        theta=theta,
        loads=loads,
        guides=found.reactions,
        friction_residual=found.residual,
        cam_speed=cam_speed(state, driven, speed, contour.pitch, loads.rubbing),
        torque_before=before,
        residual_torque=None if before is None else before - loads.cam_torque / ratio,
    )


def finished(
    case: Case,
    contour: Contour,
    given: Turn,
    contact: ContactHistory,
    ahead: bool = False,
    flights: bool = True,
) -> Cycle:
    """The cycle of a turn whose contact is solved; a look ahead asks nothing of the parts.

    Nor does one that wants the parts without following the follower where it flies.
    """
    parts = None
    if not ahead:
        ring = outer_ring(case, contact_width(case))
        parts = parts_history(case.at(given.load_case), contour, given, ring, flights)
    return Cycle(
        **{item.name: getattr(given, item.name) for item in fields(Turn)},
        pressure_angle=given.loads.pressure_angle,
        pitch_radius=contour.pitch.radius_of_curvature(given.theta),
        contour_radius=contour.radius_of_curvature(given.theta),
        contact=contact,
        parts=parts,
    )


def closed_form_cycle(case: Case, contour: Contour, given: Turn) -> Cycle:
    """The cycle by closed forms in the contact and without parts, for a look ahead."""
    pair = contact_pair(case, contour)
    history = closed_form_history(pair, given.theta, given.loads.normal_force)
    return finished(case, contour, given, history, ahead=True)
