"""Loads, contact, rolling and part loads over one cam turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.part_loads import PartLoads, part_loads
from camwright.pipeline.cycle.rolling_history import RollingHistory, rolling_history
from camwright.pipeline.cycle.turn import Turn
from camwright.pipeline.follower.follower_forces import Loads
from camwright.pipeline.follower.guide_reactions import GuideReactions


@dataclass(frozen=True, eq=False)
class Cycle:
    """A turn with its contact, and what follows from both.

    bodies are the meshed bodies of the contact; None in a preview, where the contact is that of
    half-planes, and under a contour that is no body, where it is unknown. Rolling and part loads
    are computed when first read. None inside them means that the machine has no such part.
    """

    turn: Turn
    contour: Contour
    pair: ContactPair
    bodies: CycleBodies | None
    contact: ContactHistory

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

    @property
    def guides(self) -> GuideReactions:
        """Reactions of the guides."""
        return self.turn.guides

    @property
    def cam_speed(self) -> float:
        """Mean cam speed, rad/s."""
        return self.turn.machine.cam_speed

    @cached_property
    def rolling(self) -> RollingHistory:
        """Traction, creep, film, fatigue and bore stress over the turn; NaN for no body."""
        if self.contact.tier is None:
            return RollingHistory.unknown(self.theta.size)
        return rolling_history(self.machine, self.pair, self.bodies, self.loads, self.contact)

    @cached_property
    def parts(self) -> PartLoads:
        """Loads of guides, stem, spring, pin, key and shaft over the turn.

        Where an elastic follower leaves the cam, a preview does not follow its flights.
        """
        flights = self.contact.tier is not Tier.PREVIEW
        return part_loads(self.turn, self.contour, self.pair.width, flights=flights)

    def columns(self) -> Mapping[str, Array]:
        """SI values by the names of the columns of ``5_cycle.csv``."""
        turn, loads, contact, guides = self.turn, self.loads, self.contact, self.guides
        found = {
            "load_case": np.full(self.theta.size, self.load_case),
            "cam_angle": self.theta,
            "crank_angle": self.machine.gear_ratio * self.theta,
            "lift": loads.lift,
            "pressure_angle": loads.pressure_angle,
            "pitch_radius": self.contour.pitch.radius_of_curvature(self.theta),
            "contour_radius_of_curvature": self.contour.radius_of_curvature(self.theta),
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
            "cam_speed": turn.cam_speed,
            "velocity": loads.velocity,
            "cam_torque": loads.cam_torque,
            "residual_equilibrium": contact.residual_equilibrium,
            "residual_complementarity": contact.residual_complementarity,
            "residual_guide_force": guides.force_residual,
            "residual_guide_moment": guides.moment_residual,
            "residual_friction": turn.friction_residual,
            "stem_slope_A": guides.slope_a,
            "stem_slope_B": guides.slope_b,
            "roller_deflection": guides.roller_deflection,
        }
        if turn.torque_before is not None and turn.torque_after is not None:
            found |= {"torque_before": turn.torque_before, "torque_after": turn.torque_after}
        # Another plane bears more shear only where the Poisson ratio is small: then it is told.
        # The peaks of the two fields are fitted apart and agree within 0.3 % where they are one.
        if (contact.tau_any_plane > 1.01 * contact.tau_max).any():
            found["tau_any_plane"] = contact.tau_any_plane
        if contact.tier is not None:
            found |= self.rolling.columns()
        return found | dict(self.parts.columns())
