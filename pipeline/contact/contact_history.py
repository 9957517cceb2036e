"""Contact quantities over a cam turn, and the certificate at one cam angle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.display import Displayed
from camwright.geometry.extrema import first_greatest
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.elasticity.mesh_convergence import Convergence
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.records.trial_contents import ContactFigure

TWO_SCALE = "two-scale finite elements: contact patch and bodies"
GAP_ROUND_OFF_MAX = 1e-3
"""Relative round-off of the gap beyond which the contact is that of Hertz: p0 has four digits."""

_HALF_PLANE = 1e-6
"""Relative difference of the greatest shear up to which it is that of half-planes."""


QUANTITIES = {
    "p0": "peak pressure",
    "half_width": "half-width",
    "tau_max": "maximum shear stress",
    "von_mises": "von Mises stress",
}
"""Certified quantities in words."""


@dataclass(frozen=True, eq=False, repr=False)
class ContactHistory(Displayed):
    """Contact quantities at n cam angles, SI; zero where the surfaces carry no load.

    line_load N/m; relative_radius m; p0_hertz, p0 Pa; half_width_hertz, half_width m; tau_max
    (maximum in-plane shear) and von_mises in the cam, Pa, with their depths, m; tau_any_plane, the
    maximum shear on any plane, larger than tau_max for nu below about 0.25; residual_equilibrium,
    residual_complementarity, relative; bending_cam, bending_follower, relative change of p0 by the
    bending of either body; gap_round_off, round-off of the coordinates over the gap at the Hertz
    half-width; pressure (n, k) Pa at pressure_xi (n, k) m along the tangent, piecewise linear.
    tier is None, and every quantity NaN, where the contour does not
    bound a body.
    """

    line_load: Array
    relative_radius: Array
    p0_hertz: Array
    half_width_hertz: Array
    p0: Array
    half_width: Array
    tau_max: Array
    tau_any_plane: Array
    tau_depth: Array
    von_mises: Array
    von_mises_depth: Array
    residual_equilibrium: Array
    residual_complementarity: Array
    bending_cam: Array
    bending_follower: Array
    gap_round_off: Array
    pressure: Array
    pressure_xi: Array
    tier: Tier | None

    def __post_init__(self) -> None:
        freeze(self, **self.arrays)

    @property
    def arrays(self) -> dict[str, Array]:
        """The quantities by name."""
        return {f.name: getattr(self, f.name) for f in fields(self) if f.name != "tier"}

    def where(self, at: NDArray[np.bool_], other: ContactHistory) -> ContactHistory:
        """This history, with another by the same tier at some angles `at` (n,)."""
        mixed = {
            name: np.where(at if values.ndim == 1 else at[:, None], getattr(other, name), values)
            for name, values in self.arrays.items()
        }
        return ContactHistory(**mixed, tier=self.tier)

    @property
    def unsolved(self) -> NDArray[np.bool_]:
        """Where the contact is wider than a tenth of the relative radius (n,), bool: not solved."""
        return np.asarray(np.isnan(self.p0))

    @property
    def below_round_off(self) -> NDArray[np.bool_]:
        """Where a vanishing load leaves a gap within round-off (n,), bool: contact of Hertz."""
        return np.asarray(self.gap_round_off > GAP_ROUND_OFF_MAX)

    @property
    def conforming(self) -> NDArray[np.bool_]:
        """Where a concave contact of a preview is solved in full, as conforming (n,), bool: its
        stresses are not those of half-planes.
        """
        if self.tier is not Tier.PREVIEW:
            return np.zeros(self.p0.size, dtype=bool)
        flat = hertz.SHEAR_MAX * self.p0
        return np.asarray(~(np.abs(self.tau_max - flat) <= _HALF_PLANE * flat))

    @property
    def method(self) -> str:
        """Method of the solution, in words."""
        if self.tier is None:
            return "none: the contour does not bound a body"
        if self.tier is Tier.PREVIEW:
            words = "closed form: Hertz line contact"
            if count := int(self.conforming.sum()):
                words += f"; conforming contact where the cam is concave at {count} angles"
            return words
        words = TWO_SCALE
        if count := int(self.unsolved.sum()):
            words += (
                f"; not solved at {count} angles, where the half-width exceeds a tenth of the "
                "relative radius and the surfaces are not locally flat"
            )
        if count := int(self.below_round_off.sum()):
            words += (
                f"; Hertz at {count} angles of vanishing load, where the gap is within "
                f"{1 / GAP_ROUND_OFF_MAX:.0f} times the round-off of the coordinates"
            )
        return words

    @classmethod
    def unknown(cls, count: int) -> ContactHistory:
        """History of NaN at `count` angles, of a contour that does not bound a body."""
        values = np.full(count, np.nan)
        names = [f.name for f in fields(cls) if f.name != "tier"]
        known = dict.fromkeys(names, values) | dict.fromkeys(
            ("pressure", "pressure_xi"), values[:, None]
        )
        return cls(**known, tier=None)

    @property
    def p0_difference(self) -> Array:
        """Relative difference of p0, finite elements to Hertz; zero without load."""
        idle = self.p0_hertz == 0
        return np.where(idle, 0.0, self.p0 / np.where(idle, 1.0, self.p0_hertz) - 1)


@dataclass(frozen=True, repr=False)
class CertificatePoint(Displayed):
    """Certified contact of both bodies at one cam angle, with the values of the cycle.

    On three meshes; or on the two coarser ones by the orders observed at the cam angles
    `order_from` (rad). theta rad; convergence of p0 (Pa), half_width (m), tau_max and von_mises
    (Pa); edges per half-width and degrees of freedom of each mesh; residuals, the largest of the
    meshes; bears_less: whether it is that of preloaded discs that bears less there.
    """

    theta: float
    p0: Convergence
    half_width: Convergence
    tau_max: Convergence
    von_mises: Convergence
    edges: tuple[float, ...]
    dofs: tuple[int, ...]
    p0_hertz: float
    p0_cycle: float
    half_width_cycle: float
    tau_max_cycle: float
    von_mises_cycle: float
    residual_equilibrium: float
    residual_complementarity: float
    order_from: tuple[float, ...] = ()
    bears_less: bool = False

    @property
    def figures(self) -> Mapping[ContactFigure, tuple[Convergence, float]]:
        """Certified quantities by name: convergence over the meshes, value of the cycle."""
        return {
            "p0": (self.p0, self.p0_cycle),
            "half_width": (self.half_width, self.half_width_cycle),
            "tau_max": (self.tau_max, self.tau_max_cycle),
            "von_mises": (self.von_mises, self.von_mises_cycle),
        }

    @property
    def spread(self) -> float:
        """Largest relative difference of cycle and certificate over all figures; NaN if one is."""
        return self.difference(self.spread_of)

    @property
    def spread_of(self) -> ContactFigure:
        """Name of the figure with the largest difference, or without a number."""
        names = list(self.figures)
        return names[first_greatest([self.difference(name) for name in names])]

    def difference(self, name: ContactFigure) -> float:
        """Relative difference of cycle and certificate for one figure."""
        one, value = self.figures[name]
        return abs(value / one.extrapolated - 1)

    @property
    def gci(self) -> float:
        """Largest grid convergence index over all figures, relative; NaN if one is."""
        return self.figures[self.gci_of][0].gci

    @property
    def gci_of(self) -> ContactFigure:
        """Name of the figure with the largest index, or without a number."""
        names = list(self.figures)
        return names[first_greatest([self.figures[name][0].gci for name in names])]
