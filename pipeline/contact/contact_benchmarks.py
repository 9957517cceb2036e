"""Benchmarks: two contacts with known solutions, solved by the code of the run.

Cached on disk by the versions of the libraries and the source of the modules.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping

import numpy as np

from camwright.geometry.arrays import Array
from camwright.meshes import body_mesh, element_size
from camwright.meshes.body_mesh import BodyMesh, block_mesh, roller_mesh
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact import full_contact, hertz
from camwright.pipeline.contact.elasticity import (
    active_set,
    elastic_body,
    pressure_distribution,
    surface_integrals,
)
from camwright.pipeline.contact.elasticity.elastic_body import ElasticBody
from camwright.pipeline.contact.elasticity.surface_integrals import ContactFrame
from camwright.pipeline.contact.full_contact import ContactSide, solve_contact

RADIUS, BLOCK = 0.05, 0.2
ALUMINIUM, STEEL, NU = 70e9, 210e9, 0.3
LOAD = 35e6
HALF_WIDTH, P0 = 6.21e-3, 3585e6
"""NAFEMS R0094 (Konter 2006), case 1: cylinder on block, 35 kN/mm; as published, m and Pa."""
EDGES = 8

_OWN_LOAD = 1.0e5  # N/m, of the order of a balancing cam
_RECIPE = (
    *(sys.modules[__name__], body_mesh, element_size, hertz, full_contact),
    *(elastic_body, surface_integrals, pressure_distribution, active_set),
)


def benchmarks(roller_radius: float) -> dict[str, float]:
    """Relative deviations of the benchmark contacts from their known solutions.

    Parameters
    ----------
    roller_radius : float    of the case, m: steel roller on a steel block by Hertz

    Returns
    -------
    dict    ``nafems_p0, nafems_half_width, hertz_p0, hertz_half_width``, and the residuals
            ``nafems_residual, hertz_residual``
    """
    differences = disk_cache.kept(
        "benchmarks", float(roller_radius), lambda: _solved(roller_radius), _RECIPE
    )
    return {name: float(value) for name, value in differences.items()}


def _solved(roller_radius: float) -> Mapping[str, Array]:
    """Relative deviations from the known pressure and half-width, and residuals, of the benchmark
    of NAFEMS and of a disc of this radius, m, by name.
    """
    nafems = disc_on_block(RADIUS, BLOCK, (ALUMINIUM, STEEL), LOAD)
    modulus = hertz.contact_modulus(STEEL, NU, STEEL, NU)
    half_width, p0 = (
        float(value) for value in hertz.line_contact(_OWN_LOAD, roller_radius, modulus)
    )
    # A block large against the contact approximates the half-plane of Hertz.
    own = disc_on_block(roller_radius, 4.0 * roller_radius, (STEEL, STEEL), _OWN_LOAD)
    return {
        "nafems_p0": np.asarray(nafems[0] / P0 - 1.0),
        "nafems_half_width": np.asarray(nafems[1] / HALF_WIDTH - 1.0),
        "nafems_residual": np.asarray(nafems[2]),
        "hertz_p0": np.asarray(own[0] / p0 - 1.0),
        "hertz_half_width": np.asarray(own[1] / half_width - 1.0),
        "hertz_residual": np.asarray(own[2]),
    }


def disc_on_block(
    radius: float, side: float, moduli: tuple[float, float], line_load: float
) -> tuple[float, float, float]:
    """p0 (Pa), half-width (m) and largest relative residual of a disc on a square block in plane
    strain.

    Parameters
    ----------
    radius : float        of the disc, m
    side : float          of the block, m
    moduli : two floats   Young's modulus of block and disc, Pa; nu = 0.3
    line_load : float     N/m
    """
    modulus = hertz.contact_modulus(moduli[0], NU, moduli[1], NU)
    half_width = float(hertz.line_contact(line_load, radius, modulus)[0])

    def sizing(point: tuple[float, float]) -> ElementSize:
        return ElementSize.from_half_width(
            half_width, 0.2 * radius, contact_point=point, edges=EDGES
        )

    block = block_mesh(side, side, sizing((0.0, 0.0)))
    disc = roller_mesh(radius, 0.0, -0.5 * np.pi, sizing((0.0, -radius)))
    rim = disc.boundaries["rim"]
    top = np.argsort(np.hypot(disc.points[0, rim[2]], disc.points[1, rim[2]] - radius))[:4]
    held = BodyMesh(disc.points, disc.triangles, {"rim": rim, "top": rim[:, top]})
    lifted = held.transformed(0.0, (0.0, radius))
    contact = solve_contact(
        (
            ContactSide(ElasticBody(block, moduli[0], NU, "bottom"), "top"),
            ContactSide(ElasticBody(lifted, moduli[1], NU, "top"), "rim"),
        ),
        ContactFrame(np.zeros(2), np.array([0.0, 1.0])),
        lambda xi: xi**2 / (radius + np.sqrt(radius**2 - xi**2)),
        line_load,
        half_width,
    )
    residual = max(contact.residual_equilibrium, contact.residual_complementarity)
    return contact.p0, contact.half_width, float(residual)
