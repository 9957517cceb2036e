"""Contact over the cam turn in closed form: Hertz; in full where a cam that pulls is concave."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.conforming_line import ConformingLine, concave_line
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.tiers import Tier

CONFORMING = (
    *("p0", "half_width", "tau_max", "tau_any_plane", "tau_depth"),
    *("von_mises", "von_mises_depth"),
)
"""Figures of `ContactHistory` that a conforming contact has of its own."""

_SHAPE = "pressure", "pressure_xi"


def closed_form_history(pair: ContactPair, theta: Array, normal_force: Array) -> ContactHistory:
    """Hertz line contact at cam angles theta (n,), rad, under normal forces (n,), N; a negative
    force counts as none.

    Where a cam that pulls is concave and the half-width is not small against the radii, the contact
    of a roller is solved in full, see `concave_line`.
    """
    load = np.maximum(normal_force, 0.0) / pair.width
    radius = pair.relative_radius(theta)
    half_width, p0 = hertz.line_contact(load, radius, pair.contact_modulus)
    mises, depth = hertz.von_mises_peak(pair.cam.poisson)
    nothing = np.zeros(theta.size)
    history = ContactHistory(
        line_load=load,
        relative_radius=radius,
        p0_hertz=p0,
        half_width_hertz=half_width,
        p0=p0,
        half_width=half_width,
        tau_max=hertz.SHEAR_MAX * p0,
        tau_any_plane=hertz.shear_any_plane_peak(pair.cam.poisson) * p0,
        tau_depth=hertz.SHEAR_MAX_DEPTH * half_width,
        von_mises=mises * p0,
        von_mises_depth=depth * half_width,
        residual_equilibrium=nothing,
        residual_complementarity=nothing,
        bending_cam=nothing,
        bending_follower=nothing,
        gap_round_off=nothing,
        pressure=p0[:, None] * hertz.ELLIPSE,
        pressure_xi=half_width[:, None] * hertz.ELLIPSE_XI,
        tier=Tier.PREVIEW,
    )
    return history if pair.wall is None else _with_conforming(pair, theta, history)


def in_full(
    pair: ContactPair, theta: Array, line_load: Array, relative_radius: Array
) -> tuple[NDArray[np.bool_], ConformingLine | None]:
    """Where the contact of a roller with a cam that pulls is to be solved in full, and it; see
    `concave_line`.

    Parameters
    ----------
    theta : array (n,)             cam angles, rad
    line_load : array (n,)         N/m
    relative_radius : array (n,)   m
    """
    if not pair.contour.rolls:  # a face touches convex parts alone
        return np.zeros(theta.shape, dtype=bool), None
    radius = np.empty(theta.shape)
    for each, at in pair.on_walls(theta):
        radius[at] = each.contour.require_roller().follower_radius
    return concave_line(line_load, relative_radius, radius, pair.follower.material, pair.cam)


def _with_conforming(pair: ContactPair, theta: Array, history: ContactHistory) -> ContactHistory:
    """The history of Hertz contacts, with those of a concave wall that are to be solved in full
    replaced by that solution, see `concave_line`.
    """
    full, line = in_full(pair, theta, history.line_load, history.relative_radius)
    if line is None:
        return history
    changed = {name: getattr(history, name).copy() for name in (*CONFORMING, *_SHAPE)}
    for name in CONFORMING:
        changed[name][full] = getattr(line, name)
    xi = line.half_width[:, None] * hertz.ELLIPSE_XI
    changed["pressure_xi"][full], changed["pressure"][full] = xi, line.pressure(xi)
    return replace(history, **changed)
