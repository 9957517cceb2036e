"""How the checks of spring, face, numbers and plane model are tried."""

from dataclasses import replace

import fake_trial as fake
import full_trial as full
import hand_calculations as by_hand
import numpy as np
from check_tools import by_limit, limited, loaded, tried
from trial_variants import (
    NAN,
    benchmark,
    faced,
    meshed,
    on_contour,
    with_case,
    with_certificate,
    with_contact,
    with_design,
    with_guides,
    with_limits,
    with_material,
    with_part,
    with_rolling,
)

# spring
tried(
    "spring_stress",
    loaded(
        "spring_stress",
        lambda u: with_design(
            strength_at_1mm=1974e6
            * float(by_hand.SHEAR * by_hand.HARDEST / (0.56 * by_hand.TENSILE))
            / u
        ),
    ),
    lambda: with_part("spring", design=None),
    lambda: with_design(strength_at_1mm=np.nan),
    float(by_hand.SHEAR * by_hand.HARDEST / (0.56 * by_hand.TENSILE)),
    "Wahl; 0.56 R_m, EN 13906-1",
)
by_limit(
    "spring_fatigue",
    "spring_fatigue",
    1.0,
    lambda: with_design(strength_at_1mm=np.nan),
    1.0 / float(by_hand.SWING / by_hand.ZIMMERLI + by_hand.MIDDLE / (0.67 * by_hand.TENSILE)),
    "Goodman through Zimmerli, Shigley ch. 10",
)
by_limit(
    "spring_solid",
    "spring_solid",
    1.0,
    on_contour,
    (by_hand.SOLID - by_hand.DEFLECTION) / by_hand.DEFLECTION,
    "L0 - d (n + 2) - x, over x",
)
tried(
    "spring_buckling",
    loaded("spring_buckling", lambda u: with_design(free_length=u * 2.63 * full.COIL / 0.5)),
    lambda: with_part("spring", design=None),
    lambda: with_design(free_length=np.nan),
    full.FREE * 0.5 / (2.63 * full.COIL),
    "L0 < 2.63 D/alpha, Shigley ch. 10",
)
tried(
    "spring_rate",
    limited("spring_rate", lambda t: with_part("spring", rate_tolerance=t)),
    lambda: with_part("spring", design=None),
    lambda: with_design(shear_modulus=np.nan),
    abs(by_hand.RATE / fake.RATE - 1.0),
    "G d^4/(8 D^3 n)",
)
by_limit(
    "spring_surge",
    "spring_surge",
    1.0,
    lambda: with_design(density=np.nan),
    float(by_hand.SURGE),
    "sqrt(k/m)/2 over w/(2 pi)",
)
# a flat face
tried(
    "face_width",
    limited("face_width", lambda mm: faced(width=1e-3 * mm), faced),
    None,
    lambda: replace(faced(), cycles=with_contact(half_width=NAN).cycles),
    2.0 * (3.0 + 0.1),
    "twice 3 mm and a half-width of 0.1",
    base=faced,
)
tried(
    "face_sliding",
    limited("face_sliding", lambda pv: faced(pv_limit=1e6 * pv), faced),
    lambda: faced(pv_limit=None),
    lambda: replace(faced(), cycles=(full.cycle(),)),
    150.0,
    "100 + 50 sin",
    base=faced,
)
# evidence
for _name, _field, _part, _value in (
    ("guide_equilibrium_force", "equilibrium", "force_residual", 1e-13),
    ("guide_equilibrium_moment", "equilibrium", "moment_residual", 1e-12),
):
    by_limit(_name, _field, 1.0, lambda p=_part: with_guides(**{p: NAN}), _value, "as found")
for _name, _field, _part, _value in (
    ("contact_equilibrium", "contact_equilibrium", "residual_equilibrium", 1e-9),
    ("contact_complementarity", "complementarity", "residual_complementarity", 1e-11),
    ("hertz_difference", "hertz_difference", "p0", 1.0),
):
    by_limit(_name, _field, 1.0, lambda p=_part: with_contact(**{p: NAN}), _value, "as found")
for _name, _field, _si, _part, _value in (
    ("certificate_spread", "certificate_spread", 1.0, "spread_percent", 0.4),
    ("certificate_gci", "mesh_uncertainty", 0.01, "gci_percent", 0.5),
):
    by_limit(
        _name,
        _field,
        _si,
        lambda p=_part: with_certificate(**{p: np.nan}),
        _value,
        "the worse of two angles",
    )
for _name, _part, _value in (
    ("mesh_angle", "min_angle_deg", 28.0),
    ("mesh_jacobian", "min_scaled_jacobian", 0.5),
    ("mesh_edges", "edges_across_half_width", 10.0),
):
    by_limit(
        _name,
        _name,
        1.0,
        lambda p=_part: full.evidence(mesh_quality=fake.changed(fake.MESH, **{p: np.nan})),
        _value,
        "as the mesh says",
    )
for _part in ("p0", "half_width", "von_mises", "tau_max"):
    tried(
        f"mesh_{_part}",
        loaded(f"mesh_{_part}", lambda gci, p=_part: with_certificate(**{p: meshed(0.01 * gci)})),
        lambda: full.evidence(certificate=()),
        lambda p=_part: with_certificate(**{p: meshed(np.nan)}),
        1.0,
        "GCI as found, its formula in test_proof_checks",
    )
for _part in ("nafems", "hertz"):
    tried(
        f"benchmark_{_part}",
        loaded(f"benchmark_{_part}", lambda off, p=_part: benchmark(p)(0.01 * off)),
        lambda: full.evidence(benchmarks=None),
        lambda p=_part: benchmark(p)(np.nan),
        1.0,
        "one per cent off",
    )
# what a plane model cannot see
tried(
    "edge_derating",
    lambda share: with_case(
        limits=fake.changed(full.case().limits, edge_factor=1.3 / share),
        roller=fake.changed(full.case().roller, crowned=False),
    ),
    lambda: with_case(
        limits=fake.changed(full.case().limits, edge_factor=None),
        roller=fake.changed(full.case().roller, crowned=False),
    ),
    lambda: with_case(
        limits=fake.changed(full.case().limits, edge_factor=np.nan),
        roller=fake.changed(full.case().roller, crowned=False),
    ),
    1.0,
    "a crowned roller has no edge",
)
tried(
    "clear_of_holds",
    loaded("clear_of_holds", lambda n: with_contact(half_width=np.full(fake.POSITIONS, 4e-3 / n))),
    lambda: with_contact(half_width=np.zeros(fake.POSITIONS)),
    lambda: with_contact(half_width=NAN),
    40.0,
    "8 - 4 mm of roller over 0.1 mm",
)
tried(
    "stress_inside",
    loaded(
        "stress_inside",
        lambda depth: with_contact(von_mises_depth=np.full(fake.POSITIONS, 1e-4 * depth)),
    ),
    lambda: full.evidence(cycles=()),
    lambda: with_contact(von_mises_depth=NAN),
    0.7,
    "0.70 b, Johnson sec. 4.2(c)",
)
tried(
    "excluded_zone",
    loaded(
        "excluded_zone",
        lambda mm: with_rolling(bore=fake.changed(full.cycle().rolling.bore, excluded=1e-3 * mm)),
    ),
    lambda: with_rolling(bore=fake.changed(full.cycle().rolling.bore, excluded=0.0)),
    lambda: with_rolling(bore=fake.changed(full.cycle().rolling.bore, excluded=np.nan)),
    0.5,
    "1.5 elements at the keyway",
)
tried(
    "bore_stress",
    limited("bore_stress", lambda p: with_material("steel", core_yield_strength=1e6 * p)),
    lambda: with_limits(bore_safety=None),
    lambda: with_rolling(bore=fake.changed(full.cycle().rolling.bore, away_from_edges=NAN)),
    200.0,
    "away from the edges",
)
