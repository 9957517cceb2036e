"""Compliance of a round body to pressures on its surface: harmonics around, elements along.

A pressure p(z) cos(n phi) on the surface displaces a body of revolution by u_r, u_z cos(n phi) and
u_phi sin(n phi): finite elements of the meridian solve each harmonic n apart. Lengths are over the
radius of the loaded surface, pressures over Young's modulus.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np
import scipy

from camwright.geometry.arrays import Array
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact.elasticity import elastic_body, sparse_factor
from camwright.pipeline.contact.elasticity.elastic_body import lame_parameters
from camwright.pipeline.contact.elasticity.sparse_factor import factorised

if TYPE_CHECKING:
    from skfem import Basis
    from skfem.assembly.form.form import FormExtraParams
    from skfem.element import DiscreteField

    Energy: TypeAlias = Callable[[DiscreteField, DiscreteField, FormExtraParams], Array]

_SOLVED_HARMONICS = (
    0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768, 1024,
)  # fmt: skip
"""Harmonics that are solved; n times the compliance is a spline over log n between them."""


class Meridian(NamedTuple):
    """Rectangle of quadratic elements in the plane of the axis.

    radii: edges of the elements, the first on the loaded surface, at 1, the last on the surface
    that is held; places: edges along the axis; stations: those on which the pressure acts.
    """

    radii: tuple[float, ...]
    places: tuple[float, ...]
    stations: tuple[float, ...]


def harmonic_compliance(meridian: Meridian, poisson: float, most: int) -> Array:
    """Displacement of the surface along its pressure, by harmonics 0 to `most`.

    Parameters
    ----------
    meridian : Meridian   k stations
    poisson : float       Poisson's ratio
    most : int            greatest harmonic, >= 8

    Returns
    -------
    array (most + 1, k, k)   under the pressure of a hat function at one station, integrated along
        the axis with that at another; for radius and Young's modulus 1

    References
    ----------
    Zienkiewicz and Taylor, The Finite Element Method, vol. 2: axisymmetric solids under
    nonsymmetric loads. Solved for few harmonics and cached on disk.
    """
    solved = (*(each for each in _SOLVED_HARMONICS if each < most), most)
    inputs = meridian, float(poisson), solved, sparse_factor.back_end()
    modules = sys.modules[__name__], elastic_body, sparse_factor
    arrays = disk_cache.kept("round", inputs, lambda: {"compliance": _solved(*inputs[:3])}, modules)
    exact = arrays["compliance"]
    sizes, every = np.array(solved[1:], dtype=float), np.arange(1.0, most + 1.0)
    scaled = scipy.interpolate.CubicSpline(np.log(sizes), sizes[:, None, None] * exact[1:])
    return np.concatenate([exact[:1], scaled(np.log(every)) / every[:, None, None]])


def _solved(meridian: Meridian, poisson: float, harmonics: tuple[int, ...]) -> Array:
    """Compliance (h, k, k) of the harmonics named, as in `harmonic_compliance`."""
    from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, MeshQuad

    mesh = MeshQuad.init_tensor(np.sort(meridian.radii), np.array(meridian.places))
    basis = Basis(mesh, ElementVector(ElementQuad2(), 3), intorder=4)
    card = lame_parameters(1.0, poisson)
    still, plus, minus = (
        BilinearForm(_energy(each, *card)).assemble(basis) for each in (0.0, 1.0, -1.0)
    )
    # quadratic in the harmonic
    parts = still, 0.5 * (plus - minus), 0.5 * (plus + minus) - still
    held = basis.get_dofs(lambda x: np.isclose(x[0], meridian.radii[-1]))
    free = np.setdiff1d(np.arange(basis.N), held.all())
    loads = _loads(basis, np.array(meridian.stations))[free]
    first, linear, square = (each[free][:, free].tocsc() for each in parts)
    solved = (factorised(first + n * linear + n * n * square)(loads) for n in harmonics)
    return np.stack([loads.T @ each for each in solved])


def _energy(n: float, lame: float, shear: float) -> Energy:
    """Integrand of the elastic energy of two displacements (u_r, u_phi, u_z) of the harmonic n,
    over the meridian.
    """

    def strains(u: DiscreteField, radius: Array) -> tuple[Array, ...]:
        along, around, axial = u
        slope = u.grad
        return (
            *(slope[0][0], (along + n * around) / radius, slope[2][1]),
            slope[0][1] + slope[2][0],
            slope[1][0] - (around + n * along) / radius,
            slope[1][1] - n * axial / radius,
        )

    def energy(u: DiscreteField, v: DiscreteField, w: FormExtraParams) -> Array:
        one, other = strains(u, w.x[0]), strains(v, w.x[0])
        weights = (2.0 * shear,) * 3 + (shear,) * 3
        product = sum(k * a * b for k, a, b in zip(weights, one, other, strict=True))
        return np.asarray(w.x[0] * (product + lame * sum(one[:3]) * sum(other[:3])))

    return energy


def _loads(basis: Basis, stations: Array) -> Array:
    """Work (dofs, k) of a pressure of the hat function at each of k stations on the surface at 1,
    along which the elements are quadratic.
    """
    x = basis.doflocs
    surface = basis.get_dofs(lambda at: np.isclose(at[0], 1.0)).all(["u^1"])
    low, high = stations[[0, -1]] + [-1e-9, 1e-9]
    surface = surface[(x[1, surface] > low) & (x[1, surface] < high)]
    surface = surface[np.argsort(x[1, surface])]
    length, at = np.diff(stations), np.arange(stations.size - 1)
    loads = np.zeros((basis.N, stations.size))
    for nodes, station, share in (
        (surface[:-1:2], at, 1.0 / 6.0),
        (surface[1::2], at, 1.0 / 3.0),
        (surface[1::2], at + 1, 1.0 / 3.0),
        (surface[2::2], at + 1, 1.0 / 6.0),
    ):
        loads[nodes, station] += share * length
    return loads
