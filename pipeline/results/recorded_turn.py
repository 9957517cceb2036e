"""Outlines and positions of cam and follower over the turn, for the scene page."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.cutouts import KeywayLike
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.two_scale import CycleBodies
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.results.stress_fields import follower_places

FRAMES = 360
"""Maximum number of recorded positions."""

_MM = 1e3


def turn_view(pair: ContactPair, bodies: CycleBodies, cycle: Cycle) -> Mapping[str, ArrayLike]:
    """Arrays of ``fields/turn.npz``.

    Returns
    -------
    mapping   load_case; position (f,) rows of the cycle and cam_angle_deg (f,); cam_mm
              (2, stations, 2) contour, then bore with keyway, in the cam frame; follower_mm
              (2, n) nodes of the follower mesh in its own frame; origin of that frame
              follower_origin_mm (f, 2) and its rotation follower_turn_deg (f,) in the cam frame
    """
    count = cycle.theta.size
    shown = np.arange(0, count, -(-count // FRAMES))
    places = follower_places(pair, cycle.theta[shown])
    return {
        "load_case": np.array(cycle.load_case),
        "position": shown,
        "cam_angle_deg": np.degrees(cycle.theta[shown]),
        "cam_mm": _MM * cam_outlines(pair, 2 * shown.size),
        "follower_mm": _MM * bodies.follower.body.mesh.points,
        "follower_origin_mm": _MM * places.origin,
        "follower_turn_deg": np.degrees(places.angle),
    }


def cam_outlines(pair: ContactPair, stations: int) -> Array:
    """Contour and bore (2, stations, 2), m, at the same polar angles."""
    outer = pair.contour.points(uniform_turn(stations))
    radius, angle = np.hypot(*outer), np.arctan2(outer[1], outer[0])
    inner = outer * (bore_reach(pair.bore_radius, pair.keyway, angle) / radius)
    return np.stack([outer, inner], axis=-1)


def bore_reach(bore_radius: float, keyway: KeywayLike | None, angle: Array) -> Array:
    """Distance (...) from the axis to the edge of bore and keyway, m, in directions (...), rad."""
    reach = np.full(angle.shape, bore_radius)
    if keyway is None:
        return reach
    off = np.abs((angle - keyway.angle + np.pi) % (2 * np.pi) - np.pi)
    half, floor = 0.5 * keyway.width, bore_radius + keyway.depth
    with np.errstate(divide="ignore"):
        slot = np.minimum(floor / np.maximum(np.cos(off), 1e-9), half / np.sin(off))
    return np.where(off < np.arcsin(half / bore_radius), slot, reach)
