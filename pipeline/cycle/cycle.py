"""Loads, contact and guide reactions at every angle of one cam turn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.contour import Contour
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.outer_ring import outer_ring
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import closed_form_history
from camwright.pipeline.cycle.contact_setup import contact_pair, contact_width
from camwright.pipeline.cycle.part_loads import PartsHistory, parts_history
from camwright.pipeline.cycle.rolling_history import RollingHistory
from camwright.pipeline.cycle.turn import Turn


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
