"""Hertz contact over the cam turn in closed form."""

from __future__ import annotations

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.tiers import Tier


def closed_form_history(pair: ContactPair, theta: Array, normal_force: Array) -> ContactHistory:
    """Hertz line contact at cam angles theta (n,), rad, under normal forces (n,), N; a negative
    force counts as none.
    """
    load = np.maximum(normal_force, 0.0) / pair.width
    radius = pair.relative_radius(theta)
    half_width, p0 = hertz.line_contact(load, radius, pair.contact_modulus)
    mises, depth = hertz.von_mises_peak(pair.cam.poisson)
    nothing = np.zeros(theta.size)
    return ContactHistory(
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
