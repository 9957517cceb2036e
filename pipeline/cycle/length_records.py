"""Records of finite-length contacts: factors by tier, pressure over y, subsurface stress."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from camwright.geometry.arrays import Array
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.contact.finite_length.axial_drop import FinitePair
from camwright.pipeline.contact.finite_length.length_certificate import (
    LengthCertificate,
    LengthPoint,
)
from camwright.pipeline.contact.finite_length.length_tiers import (
    TierResult,
    plane_strain,
)
from camwright.pipeline.contact.finite_length.subsurface_stress import subsurface_stress
from camwright.pipeline.records.trial_contents import (
    LengthElements,
    LengthFactors,
    LengthPointRecord,
    LengthTier,
    StressPeakRecord,
)

_FACTOR_DIGITS = 7  # of a factor in a record


def length_record(
    certificate: LengthCertificate | None, bodies: Sequence[str]
) -> list[LengthPointRecord]:
    """Record of finite-length contact by both tiers at each angle, over plane-strain p0.

    bodies : sequence   names of both bodies
    """
    return [] if certificate is None else [_point(point, bodies) for point in certificate.points]


def _point(point: LengthPoint, bodies: Sequence[str]) -> LengthPointRecord:
    """Record of a certified contact of finite length: load, factors of half-space and finite
    elements, their difference.
    """
    load = point.load
    _, p0 = plane_strain(load.pair, load.force)
    record: LengthPointRecord = {
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
        "finite_elements": _elements(point, bodies),
        "difference": _by_name(point.difference),
    }
    if load.bears_less:
        record["bears_less"] = True
    return record


def _tier(tier: TierResult) -> LengthTier:
    """Record of a solution of the contact: factors with their uncertainties."""
    centre, greatest, end1, end2 = (in_unit(each.gci, "%") for each in tier.convergence)
    return {
        **factors(tier),
        "centre_gci_percent": centre,
        "greatest_gci_percent": greatest,
        "end1_mean_gci_percent": end1,
        "end2_mean_gci_percent": end2,
        "mean_length_mm": in_unit(tier.factors.mean_length, "mm"),
        "unknowns": tier.unknowns,
    }


def factors(tier: TierResult) -> LengthFactors:
    """Axial factors of a tier by name, over plane-strain p0."""
    return _by_name(tier.factors.all[0])


def _by_name(values: Array) -> LengthFactors:
    """Values in the order of `FACTORS`."""
    centre, greatest, end1, end2 = map(float, values)
    return {"centre": centre, "greatest": greatest, "end1_mean": end1, "end2_mean": end2}


def _elements(point: LengthPoint, bodies: Sequence[str]) -> LengthElements:
    """Record of the finite-element solution: factors, pressure over p0 at the middle of each cell
    along the line, and the stress below, by name of the body.
    """
    pair, contact = point.load.pair, point.finite_elements.contact
    _, p0 = plane_strain(pair, point.load.force)
    places = [in_unit(float(y), "mm") for y in contact.cells.centres_along]
    return {
        **_tier(point.finite_elements),
        "axial": {
            "y_mm": _rounded(places),
            "factor": _rounded((contact.centre_line[0] / p0).tolist()),
        },
        "stress": dict(zip(bodies, stress_peaks(pair, point.finite_elements), strict=True)),
    }


def _rounded(values: Iterable[float]) -> list[float]:
    return [float(f"{value:.{_FACTOR_DIGITS}g}") for value in values]


def stress_peaks(pair: FinitePair, tier: TierResult) -> list[dict[str, StressPeakRecord]]:
    """Greatest von Mises and shear stress below middle and ends over plane-strain p0, and their
    depths, mm, by place; one mapping per body.
    """
    force, stretch = float(tier.contact.force[0]), tier.factors.mean_length
    half_width, p0 = plane_strain(pair, force)
    records: list[dict[str, StressPeakRecord]] = []
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
                position: {
                    "von_mises": peak.von_mises / p0,
                    "von_mises_depth_mm": in_unit(peak.von_mises_depth, "mm"),
                    "shear": peak.shear / p0,
                    "shear_depth_mm": in_unit(peak.shear_depth, "mm"),
                }
                for position, peak in places.items()
            }
        )
    return records
