"""Stem of the follower as a chain of beam elements."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError


@dataclass(frozen=True)
class Stem:
    """Round stem of the follower.

    Parameters
    ----------
    diameter : float          m, > 0
    elastic_modulus : float   E, Pa, > 0
    poisson_ratio : float     of the shear flexibility, 0 to 0.5
    shear : bool              Timoshenko beam; else Euler-Bernoulli beam
    bore : float              diameter of a hole along the bar, m; 0 for a solid one
    length : float            from the roller centre to the far end, m; infinite: not checked
    """

    diameter: float
    elastic_modulus: float
    poisson_ratio: float = 0.3
    shear: bool = False
    bore: float = 0.0
    length: float = np.inf

    def __post_init__(self) -> None:
        """Refuse sizes out of bounds, and a bore as wide as the stem."""
        for name, unit in (("diameter", "m"), ("elastic_modulus", "Pa")):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(f"stem.{name}", getattr(self, name), f"> 0 {unit}")
        if not self.length > 0.0:
            raise InputError("stem.length", self.length, "> 0 m")
        if not 0.0 <= self.poisson_ratio <= 0.5:
            raise InputError("stem.poisson_ratio", self.poisson_ratio, "from 0 to 0.5")
        if not 0.0 <= self.bore < self.diameter:
            raise InputError("stem.bore", self.bore, f">= 0 and < {self.diameter:g} m")

    @property
    def bending_stiffness(self) -> float:
        """E I, N m2."""
        return self.elastic_modulus * np.pi / 64.0 * (self.diameter**4 - self.bore**4)

    @property
    def shear_flexibility(self) -> float:
        """Shear deflection per force and length, 1/(kappa G A), 1/N; 0 for an Euler-Bernoulli beam.

        References
        ----------
        Cowper, J. Appl. Mech. 33 (1966) 335: kappa of solid and hollow round sections.
        """
        if not self.shear:
            return 0.0
        nu, hollow = self.poisson_ratio, (self.bore / self.diameter) ** 2
        square = (1.0 + hollow) ** 2
        kappa = (
            6.0 * (1.0 + nu) * square / ((7.0 + 6.0 * nu) * square + (20.0 + 12.0 * nu) * hollow)
        )
        modulus = self.elastic_modulus / (2.0 * (1.0 + nu))
        area = np.pi / 4.0 * (self.diameter**2 - self.bore**2)
        return float(1.0 / (kappa * modulus * area))


# Deflection and slope of a cantilever of unit length and stiffness under unit end force and moment.
_UNIT_FLEXIBILITY = np.array([[1.0 / 3.0, 0.5], [0.5, 1.0]])


def end_flexibility(length: ArrayLike, stem: Stem) -> Array:
    """Deflection, m, and slope, rad, at the free end of a cantilever under unit end force and unit
    end moment.

    By the closed form of the beam, with the shear of a Timoshenko beam.

    Parameters
    ----------
    length : array (...)   of the cantilever, m, >= 0
    stem : Stem            section and material

    Returns
    -------
    array (..., 2, 2)   rows deflection and slope, columns force and moment
    """
    length = np.asarray(length, dtype=float)[..., None, None]
    powers = np.array([[3.0, 2.0], [2.0, 1.0]])
    flexibility = _UNIT_FLEXIBILITY * length**powers / stem.bending_stiffness
    shear = np.array([[1.0, 0.0], [0.0, 0.0]]) * stem.shear_flexibility
    return np.asarray(flexibility + shear * length)


def stem_compliance(nodes: Array, stem: Stem) -> tuple[Array, Array]:
    """Compliance matrices: deflection and slope at each node per node force; first node clamped.

    The elements form a chain clamped at one end: each element bends under the loads beyond it, and
    the part beyond follows its end as a rigid body. Exact to round-off, where a factorisation would
    lose (span/element)^4 on the short elements at the edge of a guide.

    Parameters
    ----------
    nodes : array (n,)   increasing positions along the stem, m
    stem : Stem

    Returns
    -------
    deflection, slope : array (n, n)   m/N, symmetric; rad/N

    Raises
    ------
    InputError
        If the nodes do not increase.
    """
    length = np.diff(nodes)
    if not (length > 0.0).all():
        raise InputError("stem.nodes", float(length.min()), "increasing steps, > 0 m")
    flexibility = end_flexibility(length, stem)
    arm = nodes - nodes[1:, None]
    beyond = (np.arange(len(nodes)) > np.arange(len(length))[:, None]).astype(float)
    lever = np.stack([beyond, np.where(beyond > 0.0, arm, 0.0)], axis=1)
    bent = np.einsum("eij,ejn->ein", flexibility, lever)
    deflection = np.einsum("eim,ein->mn", lever, bent)
    slope = np.einsum("em,en->mn", beyond, bent[:, 1])
    return deflection, slope
