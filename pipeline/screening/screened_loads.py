"""Demand and limit of the checks of the torque, of many designs at once."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.checks import demands
from camwright.pipeline.screening.design_arrays import Designs, Judged
from camwright.pipeline.screening.screened_cam import ScreenedCam


def torque_after(designs: Designs, cam: ScreenedCam) -> Array:
    """Crank torque of engine and cam (m, n), N m."""
    before = np.zeros(1) if cam.state.torque is None else cam.state.torque
    return np.asarray(before - cam.torque / designs.case.mechanism.gear_ratio)


def torque_reduction(designs: Designs) -> Judged | None:
    shares = [
        (demands.ripple_reduction(cam.state.torque, torque_after(designs, cam)), required)
        for cam in designs.cams
        if cam.state.torque is not None and (required := cam.state.required) is not None
    ]
    if not shares:
        return None
    common = np.max(np.broadcast_arrays(*(required for _, required in shares)), axis=0)
    least = [demands.common_reduction(share, required, common) for share, required in shares]
    return np.min(least, axis=0), np.broadcast_to(common, designs.count)
