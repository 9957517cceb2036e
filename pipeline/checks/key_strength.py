"""Checks of the key of the cam: pressure on hub and shaft, shear, slip of the seat."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.limits import CAM_SLIP, KEY_REVERSAL, KEY_SHARE
from camwright.pipeline.checks.check import Demand, check
from camwright.pipeline.checks.extremes import greatest
from camwright.pipeline.contact.cam_body import Key
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.camshaft_loads import KeyStress, key_stress

METHOD = "DIN 6892 method C at the greatest cam torque, bearing length without round ends"
LOOSE = "must-have: a key that yields under reversed torque works loose and the cam loses its phase"
ALLOWED = (
    "R_e: lower yield strength of the two parts, S: limits.key_share, f: limits.key_reversal where"
    " the torque reverses, else 1"
)
_DATA = {
    "length": "length of the key",
    "height": "height of the key",
    "shaft_depth": "depth of the keyway in the shaft",
    "chamfer": "chamfer of the key",
}


@check(
    KEY_SHARE,
    id="key_pressure",
    title="Key flank pressure on the cam",
    unit="MPa",
    method=METHOD,
    lift_can_help=True,
    part="key",
    formula="p = 2 K_A T/(d l_tr (h - t1 - s)) <= f S R_e; T: greatest cam torque, d: bore"
    " diameter, l_tr: bearing length, h, t1, s: height, shaft depth and chamfer of the key, "
    + ALLOWED,
    reason=LOOSE,
)
def key_pressure(solution: Solution) -> Demand:
    """Pressure of the key on its keyway in the cam, Pa."""
    return _judged(solution, lambda stress: stress.hub, solution.machine.cam.material)


@check(
    KEY_SHARE,
    id="key_pressure_shaft",
    title="Key flank pressure on the camshaft",
    unit="MPa",
    method=METHOD,
    lift_can_help=True,
    part="key",
    formula="p = 2 K_A T/(d l_tr (t1 - s)) <= f S R_e; as key_pressure, with the depth t1 of the"
    " keyway in the shaft",
    reason=LOOSE,
)
def key_pressure_shaft(solution: Solution) -> Demand | None:
    """Pressure of the key on its keyway in the shaft, Pa; None if the shaft is not covered."""
    machine = solution.machine
    if not machine.scope.covers("camshaft"):
        return None
    card = None if machine.camshaft is None else machine.camshaft.material
    missing = () if card is not None else ("no material of the camshaft is given",)
    return _judged(solution, lambda stress: stress.shaft, card, missing)


@check(
    KEY_SHARE,
    id="key_shear",
    title="Key shear stress",
    unit="MPa",
    method=METHOD,
    lift_can_help=True,
    part="key",
    formula="tau = 2 K_A T/(d b l_tr) <= f S R_e/sqrt(3); b: width of the key, R_e: yield strength"
    " of the key, else as key_pressure",
    reason=LOOSE,
)
def key_shear(solution: Solution) -> Demand:
    """Shear stress in the section of the cam's key, Pa."""
    return _judged(solution, lambda stress: stress.shear, None, factor=1.0 / np.sqrt(3.0))


@check(
    CAM_SLIP,
    title="Slip torque of the cam seat over the greatest cam torque",
    method="slip torque of the seat over K_A T; evaluated where the torque reverses",
    lift_can_help=True,
    part="camshaft",
    formula="T_slip/(K_A T) >= limits.cam_slip; T_slip: camshaft.slip_torque of the press or"
    " clamped seat without its key, 0 for a sliding fit, T: greatest cam torque, K_A: application"
    " factor of the key, or 1 without one",
    reason="must-have: where the torque reverses, a seat that slips within the clearance of its key"
    " frets, and fretting starts fatigue cracks",
)
def cam_slip(solution: Solution) -> Demand | None:
    """Slip torque of the cam's seat over its torque; None if the torque does not reverse."""
    if not _reverses(solution):
        return None
    shaft, key = solution.machine.camshaft, solution.machine.cam.key
    slip = None if shaft is None else shaft.slip_torque
    factor = 1.0 if key is None else key.application_factor
    worst = greatest(solution.cycles, lambda cycle: factor * np.abs(cycle.loads.cam_torque))
    note = {None: "no slip torque of the cam's seat is given", 0.0: "sliding fit"}.get(slip, "")
    return Demand(
        None if slip is None else slip / worst.value,
        solution.machine.limits[CAM_SLIP],
        worst,
        note=note,
    )


def _judged(
    solution: Solution,
    of: Callable[[KeyStress], Array],
    mate: Material | None,
    missing: tuple[str, ...] = (),
    *,
    factor: float = 1.0,
) -> Demand:
    """A stress of the key against the yield strength of the weaker of the key and its mate."""
    machine = solution.machine
    cam, flanks = machine.cam, machine.cam.key_flanks
    key = cam.key or Key()
    missing += tuple(f"no {_DATA[name]} is given" for name, v in cam.key_data.items() if v is None)
    missing += () if key.material is not None else ("no material of the key is given",)
    cards = [card for card in (key.material, mate) if card is not None]
    figures = tuple(f"{card.name}: {card.source}" for card in cards)
    share = machine.limits[KEY_SHARE]
    share *= machine.limits[KEY_REVERSAL] if _reverses(solution) else 1.0
    weakest = min((card.core_yield_strength or card.yield_strength for card in cards), default=None)
    allowed = None if weakest is None or missing else factor * share * weakest
    if flanks is None:
        return Demand(None, allowed, note="; ".join(missing), figures=figures)
    diameter = 2.0 * cam.bore_radius

    def stress(cycle: Cycle) -> Array:
        torque = key.application_factor * cycle.loads.cam_torque
        if not np.isfinite(torque).all():
            return np.full(cycle.theta.size, np.nan)
        return np.abs(of(key_stress(torque, diameter, flanks)))

    worst = greatest(solution.cycles, stress)
    return Demand(worst.value, allowed, worst, note="; ".join(missing), figures=figures)


def _reverses(solution: Solution) -> bool:
    """Whether the torque through the key changes sign in a load case, or is unknown."""
    torques = [cycle.loads.cam_torque for cycle in solution.cycles]
    return any(not (torque >= 0.0).all() and not (torque <= 0.0).all() for torque in torques)
