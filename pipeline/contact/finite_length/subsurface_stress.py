"""Stress below a contact of finite length, by its pressures on a half-space.

Every cell is a rectangular patch of constant pressure. The half-space has no end: below the end of
contact its stress holds for a body that reaches beyond it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.contact.finite_length.length_contact import LengthContact
from camwright.pipeline.contact.finite_length.pressure_cells import PressureCells

# Depths in half-widths: down to the second, by steps of the first.
_DEPTH_STEP, _DEEPEST_POINT = 0.02, 2.5
# Least distance of a point from an edge, over its depth: the potentials are singular on the edge.
_ON_EDGE = 1e-9


@dataclass(frozen=True)
class StressPeak:
    """Greatest von Mises and shear stress below a point of the centre line, Pa; depths, m."""

    von_mises: float
    von_mises_depth: float
    shear: float
    shear_depth: float


@dataclass(frozen=True)
class SubsurfaceStress:
    """Stress peaks below the middle of the contact and below both of its ends.

    At a corner, where the stress near the surface grows with the mesh as the pressure does, of the
    mean over the stretch; else of the greatest stress below it.
    """

    centre: StressPeak
    end1: StressPeak
    end2: StressPeak


def subsurface_stress(
    contact: LengthContact,
    half_width: float,
    poisson: float,
    stretch: float,
    *,
    has_corner: bool,
) -> SubsurfaceStress:
    """Stress peaks below the middle and the ends of the first contact.

    Parameters
    ----------
    half_width : float   of plane strain, m: scale of the depths
    poisson : float      nu of the body
    stretch : float      length of contact at its ends, m, below which their peaks are taken
    has_corner : bool    whether a corner ends the contact
    """
    cells, pressure = contact.cells, contact.pressure[0]
    middles = cells.centres_along
    touching = np.flatnonzero(contact.centre_line[0] > 0)
    first, last = cells.y[touching[0]], cells.y[touching[-1] + 1]
    numbers = np.arange(middles.size)
    depths = half_width * np.arange(_DEPTH_STEP, _DEEPEST_POINT + 0.5 * _DEPTH_STEP, _DEPTH_STEP)
    # A tilt may lift an end: where the cells are wider than the stretch, the last one that touches.
    ends = (
        (first, (middles > first) & (middles < first + stretch) | (numbers == touching[0])),
        (last, (middles < last) & (middles > last - stretch) | (numbers == touching[-1])),
    )
    peaks = [_peak(stress_below(cells, pressure, poisson, np.zeros(1), depths), depths)]
    for edge, inside in ends:
        places = middles[inside] if has_corner else np.append(middles[inside], edge)
        stress = stress_below(cells, pressure, poisson, places, depths)
        if has_corner:
            stress = np.average(stress, axis=0, weights=np.diff(cells.y)[inside])[None]
        peaks.append(_peak(stress, depths))
    return SubsurfaceStress(*peaks)


def stress_below(
    cells: PressureCells, pressure: Array, poisson: float, y: Array, depth: Array
) -> Array:
    """Stress (n, d, 3, 3), Pa, of a half-space at x = 0, places y (n,) along the line, m, and
    depths (d,), m, > 0; tension positive.

    Parameters
    ----------
    cells : PressureCells     of the contact
    pressure : array (m, k)   Pa, on the cells of x > 0; that of x < 0 is the same
    poisson : float           nu of the body

    References
    ----------
    Love, Phil. Trans. R. Soc. A 228 (1929) 377; Johnson (1985), sec. 3.2: potentials of Boussinesq,
    integrated over a rectangle.
    """
    across = np.concatenate([-cells.x[:0:-1], cells.x])
    whole = np.concatenate([pressure[:, ::-1], pressure], axis=1)
    # Differences of the pressure at the corners: a sum over corners instead of patches.
    corners = np.diff(np.diff(np.pad(whole, 1), axis=0), axis=1)
    z = depth[:, None, None]
    stress = np.zeros((y.size, depth.size, 3, 3))
    for row, place in enumerate(y):
        along = (place - cells.y)[:, None] + _ON_EDGE * z
        aside = -across[None, :] + _ON_EDGE * z
        for (a, b), values in _corner_stress(aside, along, z, poisson).items():
            summed = (corners * values).sum(axis=(1, 2)) / (2.0 * np.pi)
            stress[row, :, a, b] = stress[row, :, b, a] = summed
    return stress


def _corner_stress(x: Array, y: Array, z: Array, poisson: float) -> dict[tuple[int, int], Array]:
    """Stress components, by pairs of axes, times 2 pi, of a half-space under a unit pressure on the
    quarter plane from a corner, up to constants that cancel over the corners of a patch.

    By the potentials f of 1/r and g of ln(r + z).

    Parameters
    ----------
    x, y, z : array   point from the corner, m; z is the depth
    """
    r = np.sqrt(x**2 + y**2 + z**2)
    soft = 1.0 - 2.0 * poisson
    f_xx, f_yy = x / (r * (r + y)), y / (r * (r + x))
    f_z = -np.arctan(x * y / (z * r))
    g_xx = np.arctan(y / x) - np.arctan(z * y / (x * r))
    g_yy = np.arctan(x / y) - np.arctan(z * x / (y * r))
    return {
        (0, 0): 2.0 * poisson * f_z - z * f_xx - soft * g_xx,
        (1, 1): 2.0 * poisson * f_z - z * f_yy - soft * g_yy,
        (2, 2): f_z + z * (f_xx + f_yy),
        (0, 1): -soft * np.log(r + z) - z / r,
        (0, 2): -(z**2) / (r * (r + y)),
        (1, 2): -(z**2) / (r * (r + x)),
    }


def _peak(stress: Array, depths: Array) -> StressPeak:
    """Greatest von Mises and maximum shear stress of stresses (n, d, 3, 3), Pa, at n places and
    depths (d,), m, with their depths.
    """
    principal = np.linalg.eigvalsh(stress)
    low, middle, high = np.moveaxis(principal, -1, 0)
    mises = np.sqrt(0.5 * ((high - middle) ** 2 + (middle - low) ** 2 + (high - low) ** 2))
    return StressPeak(*_greatest(mises, depths), *_greatest(0.5 * (high - low), depths))


def _greatest(values: Array, depths: Array) -> tuple[float, float]:
    """Greatest of values (n, d) and its depth: vertex of the parabola through three depths."""
    row, k = np.unravel_index(int(np.argmax(values)), values.shape)
    if k in (0, depths.size - 1):
        return float(values[row, k]), float(depths[k])
    before, here, after = values[row, k - 1 : k + 2]
    curved = before - 2.0 * here + after
    shift = 0.5 * (before - after) / curved if curved < 0 else 0.0
    step = float(depths[1] - depths[0])
    return float(here - 0.25 * (before - after) * shift), float(depths[k] + shift * step)
