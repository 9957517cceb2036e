"""Records of contacts of finite length: factors by tier, pressure over y, subsurface stress."""

from __future__ import annotations

from collections.abc import Sequence

from camwright.pipeline.base.files import Json
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair
from camwright.pipeline.contact.finite_length.length_certificate import (
    LengthCertificate,
    LengthPoint,
)
from camwright.pipeline.contact.finite_length.length_tiers import (
    FACTORS,
    TierResult,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.subsurface_stress import subsurface_stress

_DIGITS = 7


def length_record(
    certificate: LengthCertificate | None, bodies: Sequence[str]
) -> list[dict[str, Json]]:
    """Contact of bodies with ends by both tiers at each angle, over plane-strain p0.

    bodies : sequence   names of both bodies
    """
    return [] if certificate is None else [_point(point, bodies) for point in certificate.points]


def _point(point: LengthPoint, bodies: Sequence[str]) -> dict[str, Json]:
    load = point.load
    _, p0 = plane_strain(load.pair, load.force)
    return {
        "load_case": load.load_case,
        "cam_angle_deg": in_unit(load.theta, "deg"),
        "force_N": load.force,
        "moment_Nmm": in_unit(load.moment, "N mm"),
        "plane_strain_p0_MPa": in_unit(p0, "MPa"),
        "cycle_factor": load.factor,
        "signed_factor": point.finite_elements.signed.values[-1],
        "signed_gci_percent": in_unit(point.finite_elements.signed.gci, "%"),
        "is_mean_at_corner": point.finite_elements.at_corner,
        "ratio": point.ratio,
        "half_space": _tier(point.half_space),
        "finite_elements": _tier(point.finite_elements) | _stresses(point, bodies),
        "difference": dict(zip(FACTORS, point.difference.tolist(), strict=True)),
    }


def _tier(tier: TierResult) -> dict[str, Json]:
    bars = {
        f"{name}_gci_percent": in_unit(each.gci, "%")
        for name, each in zip(FACTORS, tier.convergence, strict=True)
    }
    return {
        **factors(tier),
        **bars,
        "mean_length_mm": in_unit(tier.factors.mean_length, "mm"),
        "unknowns": tier.unknowns,
    }


def factors(tier: TierResult) -> dict[str, float]:
    """Factors of a tier over plane-strain p0 by name."""
    return dict(zip(FACTORS, tier.factors.all[0].tolist(), strict=True))


def _stresses(point: LengthPoint, bodies: Sequence[str]) -> dict[str, Json]:
    """Pressure at the middle of each cell along the contact, and stress below it."""
    pair, contact = point.load.pair, point.finite_elements.contact
    _, p0 = plane_strain(pair, point.load.force)
    axial = {
        "y_mm": [in_unit(float(y), "mm") for y in contact.cells.centres_along],
        "factor": (contact.centre_line[0] / p0).tolist(),
    }
    rounded: dict[str, Json] = {
        name: [float(f"{value:.{_DIGITS}g}") for value in values] for name, values in axial.items()
    }
    peaks = stress_peaks(pair, point.finite_elements)
    return {"axial": rounded, "stress": dict(zip(bodies, peaks, strict=True))}


def stress_peaks(pair: FinitePair, tier: TierResult) -> list[dict[str, Json]]:
    """Greatest stresses below middle and ends over plane-strain p0, and their depths, by body."""
    force, stretch = float(tier.contact.force[0]), tier.factors.mean_length
    half_width, p0 = plane_strain(pair, force)
    records: list[dict[str, Json]] = []
    for body in pair.bodies:
        stress = subsurface_stress(
            tier.contact,
            half_width,
            body.material.poisson,
            stretch,
            has_corner=pair.has_singular_end,
        )
        places = {"centre": stress.centre, "end1": stress.end1, "end2": stress.end2}
        records.append(
            {
                place: {
                    "von_mises": peak.von_mises / p0,
                    "von_mises_depth_mm": in_unit(peak.von_mises_depth, "mm"),
                    "shear": peak.shear / p0,
                    "shear_depth_mm": in_unit(peak.shear_depth, "mm"),
                }
                for place, peak in places.items()
            }
        )
    return records
