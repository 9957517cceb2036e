"""Fatigue of a notch by its local elastic stress: Goodman with Marin, and FKM."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value, Values
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.follower.shaft_strength import reliability_factor, surface_factor

ROUGHNESS = 16.0  # um, Rz of a broached or milled keyway: verify
_HARDENED, _OTHER = 0.40, 0.45  # of R_m, endurance of case-hardening and other steels: verify
_GRADIENT = 2.0  # over the root radius, of the stress at a notch in tension: verify
_LEAST_STRENGTH = 400.0  # MPa, of the roughness factor of steel: verify


class NotchStrength(NamedTuple):
    """Fatigue strength of a notch at zero mean stress, and mean-stress sensitivities.

    endurance: S_e of the modified Goodman line, k_a k_e S_e', tensile: R_m; local: amplitude at
    R = -1 of the local stress, sensitivity: M of a mean stress, by the FKM guideline; Pa.
    """

    endurance: float
    tensile: float
    local: float
    sensitivity: float

    def goodman(self, amplitude: Values, mean: Values) -> Values:
        """Use (...) of the strength by the modified Goodman line; compression counts as no mean.

        References
        ----------
        Shigley's Mechanical Engineering Design, 10th ed., eq. 6-46, without notch sensitivity.
        """
        return amplitude / self.endurance + np.maximum(mean, 0.0) / self.tensile

    def fkm(self, amplitude: Values, mean: Values) -> Array:
        """Use (...) of the fatigue strength by local stress amplitude and mean stress (...), Pa, at
        a constant stress ratio.

        The amplitude line falls by M up to R = 0, by M/3 up to R = 0.5, and not beyond.

        References
        ----------
        FKM guideline, Analytical Strength Assessment, local stresses, chapter 4 (recalled:
        verify).
        """
        m, pull = self.sensitivity, np.maximum(mean, 0.0)
        alternating = amplitude + m * pull
        pulsating = (amplitude + m / 3.0 * pull) * (1.0 + m) / (1.0 + m / 3.0)
        static = amplitude * 3.0 * (1.0 + m) ** 2 / (3.0 + m)
        return np.asarray(np.minimum(np.minimum(alternating, pulsating), static) / self.local)

    @property
    def bound(self) -> tuple[float, float]:
        """Utilisation per amplitude and per mean, 1/Pa, bounding both methods from above."""
        per_mean = max(1.0 / self.tensile, self.sensitivity / self.local)
        return 1.0 / min(self.endurance, self.local), per_mean


def notch_strength(card: Material, root_radius: float, reliability: float) -> NotchStrength | None:
    """Fatigue strength of a machined notch; None without tensile or fatigue strength.

    Parameters
    ----------
    card : Material
    root_radius : float    m, > 0
    reliability : float    of the Goodman line; that of the guideline is 97.5 %

    References
    ----------
    Shigley's Mechanical Engineering Design, 10th ed., sec. 6-9. FKM guideline: endurance of the
    material, support factor, roughness factor and mean stress sensitivity (recalled: verify).
    """
    if card.fatigue_bending is None or card.tensile_strength is None:
        return None
    tensile = in_unit(card.tensile_strength, "MPa")
    share = _HARDENED if card.treatment == "case_hardened" else _OTHER
    rough = 1.0 - 0.22 * np.log10(ROUGHNESS) * max(np.log10(2.0 * tensile / _LEAST_STRENGTH), 0.0)
    return NotchStrength(
        endurance=surface_factor("machined", card.tensile_strength)
        * reliability_factor(reliability)
        * card.fatigue_bending,
        tensile=card.tensile_strength,
        local=float(share * card.tensile_strength * rough * _support(root_radius, tensile)),
        sensitivity=max(0.35e-3 * tensile - 0.1, 0.0),
    )


def _support(root_radius: float, tensile: float) -> float:
    """Support factor n_sigma of steel, by the relative stress gradient of a root with a radius, m,
    and the tensile strength R_m, MPa.
    """
    gradient = _GRADIENT / in_unit(root_radius, "mm")
    if gradient <= 0.1:
        return float(1.0 + gradient * 10.0 ** (-tensile / 2700.0))
    power = 0.5 if gradient <= 1.0 else 0.25
    return float(1.0 + gradient**power * 10.0 ** (-0.5 - tensile / 2700.0))


FIT_ROOT = 3.0
CONTACT_TENSION, CONTACT_COMPRESSION = 1.40, 2.15
KEY_TENSION, KEY_COMPRESSION = 1.15, 0.12
_ROOT_EXPONENT = 0.3  # of the keyway depth over the root radius


class FittedRoot(NamedTuple):
    """Bound of the keyway-root stress in a ring on its shaft, Pa.

    Tension and compression are per contact force over width and depth of the keyway, 2 t b, and per
    pressure of the key; all with the factor (t/r)^0.3 of the root.

    Attributes
    ----------
    fit : value         by the greatest interference, at every load
    tension, compression : value    Pa per Pa of the contact, of the key
    """

    fit: Value
    contact: tuple[float, float]
    key: tuple[float, float]


def fitted_root(hoop: Value, keyway_depth: float, root_radius: float) -> FittedRoot:
    """Bound of the keyway-root stress in a cam on its shaft.

    The factors are not below those of finite elements of rings on solid shafts (bores of 12 to
    50 mm with keyways of DIN 6885-1, outer radius 1.75 to 4 times that of the keyway's floor, root
    radii of 1 to 3 times the least), from no interference up to a seat that nowhere opens.

    Parameters
    ----------
    hoop : value                        of the fit at the radius of the keyway's floor, Pa
    keyway_depth, root_radius : float   t and r, m, > 0

    References
    ----------
    `pipeline.contact.hub_elements`; tests/verification/test_hub_elements.py.
    """
    sharp = (keyway_depth / root_radius) ** _ROOT_EXPONENT
    return FittedRoot(
        fit=FIT_ROOT * sharp * hoop,
        contact=(CONTACT_TENSION * sharp, CONTACT_COMPRESSION * sharp),
        key=(KEY_TENSION * sharp, KEY_COMPRESSION * sharp),
    )
