"""Fatigue of the keyway root over the turns, cam on shaft by finite elements.

At the least and at the greatest interference, over all load cases: a place of the root passes from
its least to its greatest stress.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.contour import Contour
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.case.limits import SHAFT_RELIABILITY
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.hub_elements import HubLoads, RotatingBody, SeatedCam, Slot
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.notch_fatigue import notch_strength
from camwright.pipeline.cycle.numbers import Numbers, greatest_interference, least_interference
from camwright.pipeline.cycle.pressed_discs import PressedDisc, pressed_discs

ANGLES = 180
"""Cam angles of a turn at which the state of the seat is solved."""


@dataclass(frozen=True)
class RootFatigue:
    """Fatigue of the keyway root at one interference.

    goodman, fkm: safety factors by two methods; greatest, least: stress of the place that governs,
    Pa, with load case and cam angle, rad, of the greatest; opened: share of the angles at which a
    part of the seat has no contact; pressure: mean of the fit without load, Pa.
    """

    interference: float
    goodman: float
    fkm: float
    greatest: float
    least: float
    load_case: str
    cam_angle: float
    opened: float
    pressure: float

    @property
    def safety(self) -> float:
        """The lower safety factor."""
        return min(self.goodman, self.fkm)


@dataclass(frozen=True)
class HubFatigue:
    """Fatigue of the keyway root at least and greatest interference."""

    loose: RootFatigue
    tight: RootFatigue

    @property
    def governing(self) -> RootFatigue:
        """Result of the lower safety factor."""
        return min(self.tight, self.loose, key=lambda one: one.safety)


def seated_cam(contour: Contour, numbers: Numbers, refinement: float = 1.0) -> SeatedCam | None:
    """Cam on its shaft as finite-element model; None without fit, key, root radius or shaft
    material. refinement : of the mesh, element sizes are divided by it.
    """
    case = numbers.known_case
    cam, shaft = case.cam, None if case.camshaft is None else case.camshaft.material
    keyway, flanks, radius = cam.keyway, cam.key_flanks, cam.keyway_root_radius
    if cam.fit is None or shaft is None or keyway is None or flanks is None or radius is None:
        return None
    of_cam, of_shaft = (
        RotatingBody(Elastic(card.E, card.nu), card.density) for card in (cam.material, shaft)
    )
    slot = Slot(keyway.width, keyway.depth, keyway.angle, radius)
    # the key presses on the flat part of the flank
    high = min(flanks.hub_height, keyway.depth - radius)
    return SeatedCam(contour, cam.bore_radius, slot, high, of_cam, of_shaft, refinement)


def hub_fatigue(
    contour: Contour, cycles: Sequence[Cycle], numbers: Numbers, refinement: float = 1.0
) -> HubFatigue | None:
    """Fatigue of the keyway root by finite elements; None without data, or with unknown loads.

    Of a conjugate pair that of the disc with the lower safety factor, each on a seat of its own.

    Raises
    ------
    CamError
        If the cam cannot be meshed, or the contact of its seat is not found.
    """
    if any(np.isnan(cycle.loads.normal_force).any() for cycle in cycles):
        return None
    turns = [pressed_discs(contour, cycle.loads) for cycle in cycles]
    least, greatest = least_interference(numbers), greatest_interference(numbers)
    if least is None or greatest is None:
        return None
    worst: list[HubFatigue] = []
    for discs in zip(*turns, strict=True):
        seated = seated_cam(discs[0].contour, numbers, refinement)
        if seated is None:
            return None
        loose = _fatigue(seated, cycles, discs, numbers, float(least))
        tight = _fatigue(seated, cycles, discs, numbers, float(greatest))
        if loose is None or tight is None:
            return None
        worst.append(HubFatigue(loose, tight))
    return min(worst, key=lambda one: one.governing.safety)


def _fatigue(
    seated: SeatedCam,
    cycles: Sequence[Cycle],
    discs: Sequence[PressedDisc],
    numbers: Numbers,
    interference: float,
) -> RootFatigue | None:
    """Fatigue of the keyway root over all load cases at one interference, m; None without the data
    of its strength.

    discs : the seated disc under the loads of each cycle
    """
    cam = numbers.known_case.cam
    key, flanks, radius = cam.key, cam.key_flanks, cam.keyway_root_radius
    if key is None or flanks is None or radius is None:
        return None
    reliability = float(numbers.limit(SHAFT_RELIABILITY))
    strength = notch_strength(cam.material, radius, reliability)
    if strength is None:
        return None
    stresses, opened = [], []
    steps = [slice(None, None, max(1, cycle.theta.size // ANGLES)) for cycle in cycles]
    for cycle, disc, step in zip(cycles, discs, steps, strict=True):
        loads = HubLoads(
            disc.theta[step],
            disc.force[step] / cam.width,
            # the drive of the cam turns it against the way of the contact along the contour
            -key.application_factor * disc.torque[step] / flanks.length,
            cycle.machine.cam_speed,
            interference,
        )
        state = seated.units.state(loads)
        stresses.append(state.stress)
        opened.append(state.opened)
    unloaded = seated.units.unloaded(interference)
    high = np.max([each.max(axis=0) for each in stresses], axis=0)
    low = np.min([each.min(axis=0) for each in stresses], axis=0)
    amplitude, mean = 0.5 * (high - low), 0.5 * (high + low)
    by_goodman, by_fkm = strength.goodman(amplitude, mean), strength.fkm(amplitude, mean)
    worst = first_greatest(np.maximum(by_goodman, by_fkm))
    number = first_greatest([each[:, worst].max() for each in stresses])
    at = first_greatest(stresses[number][:, worst])
    return RootFatigue(
        interference=interference,
        goodman=1.0 / float(by_goodman.max()),
        fkm=1.0 / float(by_fkm.max()),
        greatest=float(high[worst]),
        least=float(low[worst]),
        load_case=cycles[number].load_case,
        cam_angle=float(cycles[number].theta[steps[number]][at]),
        opened=float(np.mean(np.concatenate(opened))),
        pressure=float(unloaded),
    )
