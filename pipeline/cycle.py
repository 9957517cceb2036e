"""Loads, contact and guide reactions at every angle of one cam turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geometry.arrays import Array, freeze, uniform_turn
from geometry.contour import Contour
from pipeline.case import Case
from pipeline.contact.elastic_body import Elastic
from pipeline.contact.follower_body import RollerBody
from pipeline.contact.history import ContactHistory
from pipeline.contact.pair import ContactPair, closed_form_history
from pipeline.engine.torque import Torque
from pipeline.follower.forces import FollowerSystem, Loads, follower_loads
from pipeline.follower.guides import KNOTS, GuidePair, GuideReactions, guide_reactions
from pipeline.follower.stem import Stem
from pipeline.parts import PartsHistory, parts_history
from pipeline.rolling import RollingHistory

_FEW_KNOTS = 5
# A load case at rest is a turn so slow (rad/s) that inertia, film and heat are as good as none.
CREEP = 1e-3


@dataclass(frozen=True, eq=False)
class Turn:
    """What acts on the cam over one turn of one load case, before the contact is solved.

    Arrays (n,) at the cam angles theta (rad). torque_before and residual_torque are crank
    torques (N m) without and with the cam, their means taken off; None without an engine.
    """

    load_case: str
    crank_speed: float
    theta: Array
    loads: Loads
    torque_before: Array | None
    residual_torque: Array | None

    def __post_init__(self) -> None:
        freeze(self, theta=self.theta)
        if self.torque_before is not None and self.residual_torque is not None:
            freeze(self, torque_before=self.torque_before, residual_torque=self.residual_torque)


@dataclass(frozen=True, eq=False)
class Cycle(Turn):
    """A turn with its contact and guide reactions; radii (n,) of curvature in m, signed."""

    pressure_angle: Array
    pitch_radius: Array
    contour_radius: Array
    contact: ContactHistory
    guides: GuideReactions
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
            "velocity": loads.velocity,
            "cam_torque": loads.cam_torque,
            "residual_equilibrium": contact.residual_equilibrium,
            "residual_complementarity": contact.residual_complementarity,
            "residual_guide_force": guides.force_residual,
            "residual_guide_moment": guides.moment_residual,
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
    """Width of the line contact, m: what both cam and roller carry, chamfers left out."""
    return float(min(case.cam.width, case.roller.width - 2 * case.roller.chamfer))


def contact_pair(case: Case, contour: Contour) -> ContactPair:
    """Cam and follower of a case."""
    cam, roller = case.material(case.cam.material), case.material(case.roller.material)
    return ContactPair(
        contour=contour,
        width=contact_width(case),
        bore_radius=case.cam.bore_radius,
        keyway=case.cam.keyway,
        cam=Elastic(cam.E, cam.nu),
        follower=RollerBody(
            case.roller.radius, case.roller.hub_radius, Elastic(roller.E, roller.nu)
        ),
    )


def turn(
    case: Case, contour: Contour, torque: Torque | None, load_case: str, positions: int
) -> Turn:
    """Loads of one load case at `positions` equally spaced cam angles."""
    theta = uniform_turn(positions)
    ratio = case.mechanism.gear_ratio
    given = next(state.speed for state in case.load_cases if state.name == load_case)
    speed = max(given, CREEP)
    system = FollowerSystem.from_case(case.at(load_case))
    loads = follower_loads(contour.pitch, system, speed / ratio, theta)
    before = None if torque is None else torque.without_mean().resampled(positions).total
    return Turn(
        load_case=load_case,
        crank_speed=speed,
        theta=theta,
        loads=loads,
        torque_before=before,
        residual_torque=None if before is None else before - loads.cam_torque / ratio,
    )


def finished(
    case: Case, contour: Contour, given: Turn, contact: ContactHistory, knots: int = KNOTS
) -> Cycle:
    """The cycle of a turn whose contact is solved; the guides are solved here."""
    loads = given.loads
    guides = guide_reactions(
        loads.tangential_force,
        loads.overhang,
        Stem.from_case(case),
        GuidePair.from_case(case),
        knots=knots,
    )
    # A look ahead asks nothing of the parts, and its few knots would not serve them.
    speed = given.crank_speed / case.mechanism.gear_ratio
    state = case.at(given.load_case)
    parts = parts_history(state, contour, loads, guides, speed) if knots == KNOTS else None
    return Cycle(
        load_case=given.load_case,
        crank_speed=given.crank_speed,
        theta=given.theta,
        loads=loads,
        torque_before=given.torque_before,
        residual_torque=given.residual_torque,
        pressure_angle=loads.pressure_angle,
        pitch_radius=contour.pitch.radius_of_curvature(given.theta),
        contour_radius=contour.radius_of_curvature(given.theta),
        contact=contact,
        guides=guides,
        parts=parts,
    )


def closed_form_cycle(case: Case, contour: Contour, given: Turn) -> Cycle:
    """The cycle by closed forms in the contact and few knots in the guides, for a look ahead."""
    pair = contact_pair(case, contour)
    history = closed_form_history(pair, given.theta, given.loads.normal_force)
    return finished(case, contour, given, history, _FEW_KNOTS)
