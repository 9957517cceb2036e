"""What a run writes about itself: columns of its tables, its headline, a trial's record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.contour import Contour
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.outer_ring import roller_in_words
from camwright.pipeline.contact.contact_history import CertificatePoint
from camwright.pipeline.contact.elasticity.mesh_convergence import Convergence
from camwright.pipeline.cycle.cam_balance import balance
from camwright.pipeline.cycle.contact_setup import contact_width
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.engine.torque import Torque
from camwright.pipeline.results.trial import Trial

_MM, _MPA = 1e3, 1e-6


def lift_columns(case: Case, lift: Lift) -> dict[str, Array]:
    """SI values of ``2_lift.csv``."""
    theta = uniform_turn(case.solver.positions)
    return {
        "cam_angle": theta,
        "crank_angle": case.mechanism.gear_ratio * theta,
        "lift": lift(theta),
        "lift_d1": lift(theta, 1),
        "lift_d2": lift(theta, 2),
        "lift_d3": lift(theta, 3),
    }


def contour_columns(case: Case, contour: Contour) -> dict[str, Array]:
    """SI values of ``3_contour.csv``."""
    theta = uniform_turn(case.solver.positions)
    pitch, normal = contour.pitch.points(theta), contour.normal(theta)
    surface = contour.points(theta)
    return {
        "cam_angle": theta,
        "pitch_x": pitch[0],
        "pitch_y": pitch[1],
        "contour_x": surface[0],
        "contour_y": surface[1],
        "normal_x": normal[0],
        "normal_y": normal[1],
        "pressure_angle": contour.pitch.pressure_angle(theta),
        "pitch_radius": contour.pitch.radius_of_curvature(theta),
        "contour_radius_of_curvature": contour.radius_of_curvature(theta),
    }


def pressure_arrays(cycles: tuple[Cycle, ...]) -> dict[str, Array]:
    """Arrays of ``5_pressure.npz``: rows as in ``5_cycle.csv``, a column per knot."""
    return {
        "load_case": np.concatenate([np.full(c.theta.size, c.load_case) for c in cycles]),
        "cam_angle_deg": np.degrees(np.concatenate([c.theta for c in cycles])),
        "xi_mm": _MM * np.concatenate([c.contact.pressure_xi for c in cycles]),
        "pressure_MPa": _MPA * np.concatenate([c.contact.pressure for c in cycles]),
    }


def headline(case: Case, torques: Mapping[str, Torque], trial: Trial) -> dict[str, float | None]:
    """Figures of the final trial in millimetres, newtons and megapascals; null: not applicable."""
    first, contour = trial.cycles[0], trial.contour
    sound = trial.mesh is not None
    design = torques.get(case.load_cases[0].name)

    def over(measure: Any) -> float:
        return float(np.max([np.max(measure(cycle)) for cycle in trial.cycles]))

    def contact(measure: Any, scale: float) -> float | None:
        worst = over(lambda c: measure(c.contact)) if sound else np.nan
        return scale * worst if np.isfinite(worst) else None

    after = first.residual_torque
    return {
        "torque_std_before_Nm": None if design is None else design.std,
        "torque_std_after_Nm": None if after is None else float(np.std(after)),
        "torque_p2p_before_Nm": None if design is None else design.peak_to_peak,
        "torque_p2p_after_Nm": None if after is None else float(np.ptp(after)),
        "torque_mean_removed_Nm": None if design is None else design.mean,
        "lift_max_mm": _MM * trial.lift.highest.value,
        "pressure_angle_max_deg": float(np.degrees(contour.pressure_angle_max().value)),
        "pitch_radius_min_mm": _MM * contour.least_convex_pitch_radius().value,
        "normal_force_min_N": float(min(c.loads.normal_force.min() for c in trial.cycles)),
        "normal_force_max_N": over(lambda c: c.loads.normal_force),
        "p0_max_MPa": contact(lambda h: h.p0, _MPA),
        "p0_hertz_max_MPa": contact(lambda h: h.p0_hertz, _MPA),
        "half_width_max_mm": contact(lambda h: h.half_width, _MM),
        "von_mises_max_MPa": contact(lambda h: h.von_mises, _MPA),
        "reaction_A_max_N": over(lambda c: np.abs(c.guides.reaction_a)),
        "reaction_B_max_N": over(lambda c: np.abs(c.guides.reaction_b)),
        "friction_loss_J_per_cam_turn": float(first.loads.friction_loss),
        "fe_vs_hertz_p0_max_percent": contact(lambda h: np.abs(h.p0_difference), 100.0),
        "residual_equilibrium_max": _residual_max(trial),
    }


def _residual_max(trial: Trial) -> float | None:
    """Worst equilibrium residual of contact and guides; None where the contact is unknown."""

    def worst(cycle: Cycle) -> float:
        parts = (
            cycle.contact.residual_equilibrium,
            cycle.guides.force_residual,
            cycle.guides.moment_residual,
            cycle.friction_residual,
        )
        return float(np.max([np.abs(part).max() for part in parts]))

    found = float(np.max([worst(cycle) for cycle in trial.cycles]))
    return found if np.isfinite(found) else None


def trial_record(case: Case, trial: Trial) -> dict[str, Any]:
    """Contents of ``trial.json``: what was changed and why, mesh, certificate."""
    smoother, mesh = trial.smoother, trial.mesh
    window = None if smoother is None else float(np.degrees(smoother.angular_width))
    return {
        "number": trial.number,
        "why": trial.why,
        "smoother": _smoother_kind(trial),
        "strength": None if smoother is None else smoother.strength,
        "angular_width_deg": window,
        "smoothing": _smoothing_in_words(trial),
        "synthesis": trial.synthesis,
        "prices": None if trial.synthesis is None else trial.synthesis["prices"],
        "closure_mm": _MM * trial.lift.closure,
        "contact_method": "; ".join(
            filter(None, (trial.cycles[0].contact.method, roller_in_words(case)))
        ),
        "line_contact_width_mm": _MM * contact_width(case),
        "balance": balance(case, trial.contour).record(),
        "mesh": None
        if mesh is None
        else {
            "cam_angle_deg": float(np.degrees(mesh.theta)),
            "half_width_mm": _MM * mesh.half_width,
            "sha256": {"cam": mesh.cam.sha256, mesh.name: mesh.follower.sha256},
            **asdict(mesh.quality),
        },
        "certificate": [certificate_record(point) for point in trial.certificate],
    }


def _smoother_kind(trial: Trial) -> str | None:
    if trial.synthesis is not None:
        return "constrained"
    return None if trial.smoother is None else trial.smoother.kind


def _smoothing_in_words(trial: Trial) -> str:
    if trial.synthesis is not None:
        return "constrained: the least ripple within all limits"
    return "a given lift" if trial.smoother is None else trial.smoother.width_in_words


def certificate_record(point: CertificatePoint) -> dict[str, Any]:
    """One certified angle in millimetres and megapascals."""
    return {
        "cam_angle_deg": float(np.degrees(point.theta)),
        "p0_MPa": _figure(point.p0, point.p0_cycle, _MPA),
        "half_width_mm": _figure(point.half_width, point.half_width_cycle, _MM),
        "tau_max_MPa": _figure(point.tau_max, point.tau_max_cycle, _MPA),
        "von_mises_MPa": _figure(point.von_mises, point.von_mises_cycle, _MPA),
        "p0_hertz_MPa": _MPA * point.p0_hertz,
        "edges_across_half_width": list(point.edges),
        "dofs": list(point.dofs),
        "spread_percent": point.spread_percent,
        "gci_percent": point.gci_percent,
        "residual_equilibrium": point.residual_equilibrium,
        "residual_complementarity": point.residual_complementarity,
    }


def _figure(figure: Convergence, cycle: float, scale: float) -> dict[str, Any]:
    return {
        "cycle": scale * cycle,
        "meshes": [scale * value for value in figure.values],
        "extrapolated": scale * figure.extrapolated,
        "order": figure.order,
        "gci_percent": 100 * figure.gci,
    }
