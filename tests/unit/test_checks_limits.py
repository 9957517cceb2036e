"""Every check at the limit -1 % and +1 %, with a NaN, and without its limit."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import fake_trial as fake
import numpy as np
import pytest

from geometry.contour import Contour
from geometry.lift import Lift
from geometry.pitch_curve import PitchCurve
from pipeline.checks.check import Check
from pipeline.checks.everything import ALL
from pipeline.checks.trial import TrialEvidence

NAN = np.full(fake.POSITIONS, np.nan)


def found(evidence: TrialEvidence, name: str) -> Check:
    return FUNCTIONS[name](evidence)


def by_limit(name: str, si: float = 1.0) -> Callable[[float | None], dict[str, Any]]:
    """The case with one limit, given in the unit of the check."""
    return lambda limit: {"case": fake.limits(**{name: None if limit is None else limit * si})}


def by_guide(side: str, name: str) -> Callable[[float | None], dict[str, Any]]:
    def changes(limit: float | None) -> dict[str, Any]:
        base = fake.case()
        value = None if limit is None else limit * 1e6
        bush = fake.changed(base.guides.a, **{name: value})
        return {"case": fake.changed(base, guides=fake.changed(base.guides, **{side: bush}))}

    return changes


def by_steel(name: str, per_unit: float) -> Callable[[float | None], dict[str, Any]]:
    def changes(limit: float | None) -> dict[str, Any]:
        base = fake.case()
        value = None if limit is None else limit * per_unit
        steel = fake.changed(base.materials["steel"], **{name: value})
        return {"case": fake.changed(base, materials=base.materials | {"steel": steel})}

    return changes


def by_travel(limit: float | None) -> dict[str, Any]:
    travel = None if limit is None else 1e-3 * limit
    base = fake.case()
    return {"case": fake.changed(base, spring=fake.changed(base.spring, travel_max=travel))}


def by_case_safety(limit: float | None) -> dict[str, Any]:
    return {"case": fake.limits(case_safety=None if limit is None else 1.0 / limit)}


def hollow() -> Contour:
    """Three lobes on a small base: convex tips and hollow flanks."""
    lift = Lift(fake.THETA, 0.005 * (1.0 - np.cos(3.0 * fake.THETA)))
    return Contour(PitchCurve(lift, 0.03), fake.ROLLER)


def open_ended() -> Contour:
    shape = fake.contour()
    return replace(shape, pitch=replace(shape.pitch, lift=replace(shape.pitch.lift, closure=5e-10)))


def lossy_cycle():
    """A cam whose torque pays one part in ten million more than the guides' heat."""
    plain = fake.cycle()
    loads = plain.loads
    spent = loads.cam_torque - (loads.spring_force + loads.inertia_force) * loads.lift_slope
    return fake.changed(
        plain, loads=fake.changed(loads, cam_torque=loads.cam_torque + 1e-7 * spent)
    )


# Limits of a face have tests of their own: with a roller they are none.
FUNCTIONS = {
    check.id: function
    for function in ALL
    if (check := function(fake.evidence(contour=hollow()))) is not None
}

# id: how to set the limit, and what else the evidence needs for a demand that is not zero
CASES: dict[str, tuple[Callable[[float | None], dict[str, Any]], dict[str, Any]]] = {
    "closure": (by_limit("closure"), {"contour": open_ended()}),
    "acceleration_step": (by_limit("acceleration_step"), {}),
    "pressure_angle": (by_limit("pressure_angle", np.deg2rad(1.0)), {}),
    "curvature_ratio": (by_limit("curvature_ratio"), {}),
    "undercut": (by_limit("undercut_factor"), {}),
    "concave_radius": (by_limit("tool_radius", 1e-3 / 1.1), {"contour": hollow()}),
    "curvature_rate": (by_limit("curvature_rate"), {}),
    "minimum_wall": (by_limit("minimum_wall"), {}),
    "spring_travel": (by_travel, {}),
    "contact_force_margin": (by_limit("contact_force_margin"), {}),
    "jump": (by_limit("jump"), {}),
    "jam_index": (by_limit("jam_index"), {}),
    "contact_pressure": (by_steel("endurance_pressure", 1e6), {}),
    "first_yield": (by_steel("yield_strength", 1e6), {}),
    "shakedown": (by_steel("yield_strength", 1e6 * np.sqrt(3.0) / 4.0), {}),
    "roller_static": (by_limit("roller_static_safety"), {}),
    "roller_life": (by_limit("roller_life", 3600.0), {}),
    "roller_speed": (by_limit("roller_speed_share", np.pi / 30.0 / 1500.0), {}),
    "roller_grip": (by_limit("skid", 10.0), {}),
    "film_ratio": (by_limit("film_ratio"), {}),
    "surface_fatigue": (by_steel("fatigue_torsion", 1e6), {}),
    "hardened_case": (by_case_safety, {}),
    "bush_pressure_A": (by_guide("a", "pressure_limit"), {}),
    "bush_pressure_B": (by_guide("b", "pressure_limit"), {}),
    "bush_pv_A": (by_guide("a", "pv_limit"), {}),
    "bush_pv_B": (by_guide("b", "pv_limit"), {}),
    "torque_reduction": (by_limit("torque_reduction"), {}),
    "speed_reduction": (by_limit("speed_reduction"), {}),
    "energy_closure": (by_limit("energy_closure"), {}),
    "friction_balance": (by_limit("friction_balance"), {"cycles": (lossy_cycle(),)}),
    "guide_equilibrium_force": (by_limit("equilibrium"), {}),
    "guide_equilibrium_moment": (by_limit("equilibrium"), {}),
    "contact_equilibrium": (by_limit("contact_equilibrium"), {}),
    "contact_complementarity": (by_limit("complementarity"), {}),
    "hertz_difference": (by_limit("hertz_difference"), {}),
    "certificate_spread": (by_limit("certificate_spread"), {}),
    "certificate_gci": (by_limit("mesh_uncertainty", 0.01), {}),
    "mesh_angle": (by_limit("mesh_angle"), {}),
    "mesh_jacobian": (by_limit("mesh_jacobian"), {}),
    "mesh_edges": (by_limit("mesh_edges"), {}),
}
COUNTED = {"self_intersection", "second_contact"}  # of a demand that is zero or a flaw
WITHOUT_A_LIMIT = {
    "contact_pressure": "contact_safety",
    "first_yield": "yield_safety",
    "shakedown": "shakedown_safety",
}


def test_every_check_is_tried_here():
    assert set(FUNCTIONS) == set(CASES) | COUNTED


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize(("utilisation", "status"), [(0.99, "pass"), (1.01, "fail")])
def test_on_both_sides_of_the_limit(name, utilisation, status):
    set_limit, needs = CASES[name]
    plain = found(fake.evidence(**needs), name)
    at_most = plain.sense == "at_most"
    limit = plain.demand / utilisation if at_most else plain.demand * utilisation
    check = found(fake.evidence(**needs, **set_limit(limit)), name)
    assert check.demand == pytest.approx(plain.demand)
    assert check.limit == pytest.approx(limit)
    assert check.utilisation == pytest.approx(utilisation, rel=1e-6)
    assert check.status == status
    assert check.source
    assert check.method
    assert check.title


@pytest.mark.parametrize(
    "name", [name for name in CASES if name not in (*WITHOUT_A_LIMIT, "curvature_rate")]
)
def test_without_a_limit_nothing_is_evaluated(name):
    set_limit, needs = CASES[name]
    check = found(fake.evidence(**needs, **set_limit(None)), name)
    assert check.status == "not_evaluated"
    assert check.utilisation is None


@pytest.mark.parametrize(("name", "safety"), WITHOUT_A_LIMIT.items())
def test_without_a_safety_nothing_is_evaluated(name, safety):
    assert found(fake.evidence(case=fake.limits(**{safety: None})), name).status == "not_evaluated"


@pytest.mark.parametrize(("name", "safety"), WITHOUT_A_LIMIT.items())
def test_a_safety_divides_the_limit(name, safety):
    plain = found(fake.evidence(), name)
    safer = found(fake.evidence(case=fake.limits(**{safety: 1.25})), name)
    assert safer.limit == pytest.approx(plain.limit / 1.25)


def poisoned(part: str, field: str) -> TrialEvidence:
    plain = fake.cycle()
    bad = fake.changed(getattr(plain, part), **{field: NAN})
    return fake.evidence(cycles=(plain, fake.changed(plain, **{part: bad, "load_case": "bad"})))


@pytest.mark.parametrize(
    ("name", "part", "field"),
    [
        ("contact_force_margin", "loads", "normal_force"),
        ("roller_static", "loads", "normal_force"),
        ("jump", "loads", "inertia_force"),
        ("jam_index", "loads", "jam_index"),
        ("friction_balance", "loads", "cam_torque"),
        ("contact_pressure", "contact", "p0"),
        ("shakedown", "contact", "p0"),
        ("hertz_difference", "contact", "p0"),
        ("first_yield", "contact", "von_mises"),
        ("contact_equilibrium", "contact", "residual_equilibrium"),
        ("contact_complementarity", "contact", "residual_complementarity"),
        ("bush_pressure_A", "guides", "reaction_a"),
        ("bush_pv_A", "guides", "rubbing_load_a"),
        ("bush_pressure_B", "guides", "reaction_b"),
        ("bush_pv_B", "guides", "rubbing_load_b"),
        ("guide_equilibrium_force", "guides", "force_residual"),
        ("guide_equilibrium_moment", "guides", "moment_residual"),
    ],
)
def test_a_nan_in_one_load_case_is_a_missing_number(name, part, field):
    check = found(poisoned(part, field), name)
    assert check.status == "not_evaluated"
    assert check.load_case == "bad"


def test_a_nan_force_leaves_the_life_unknown():
    check = found(poisoned("loads", "normal_force"), "roller_life")
    assert check.demand is None or np.isnan(check.demand)


@pytest.mark.parametrize("field", ["torque_before", "residual_torque"])
def test_a_nan_torque_leaves_the_reduction_unknown(field):
    check = found(fake.evidence(cycles=(fake.cycle(**{field: NAN}),)), "torque_reduction")
    assert check.status == "not_evaluated"


@pytest.mark.parametrize("field", ["spread_percent", "gci_percent"])
def test_a_nan_certificate_is_a_missing_number(field):
    name = {"spread_percent": "certificate_spread", "gci_percent": "certificate_gci"}[field]
    points = (fake.CERTIFICATE[0], fake.changed(fake.CERTIFICATE[1], **{field: np.nan}))
    check = found(fake.evidence(certificate=points), name)
    assert check.status == "not_evaluated"
    assert check.must_have


def test_a_nan_mesh_is_a_missing_number():
    check = found(
        fake.evidence(mesh_quality=fake.changed(fake.MESH, min_angle_deg=np.nan)), "mesh_angle"
    )
    assert check.status == "not_evaluated"
