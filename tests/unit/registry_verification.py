"""How the checks of spring, face, solution and plane model are tried."""

import hand_calculations as by_hand
import made_trial as made
import numpy as np
from check_tools import by_limit, limited, loaded, tried
from trial_variants import (
    NAN,
    UnknownLift,
    cycle_with,
    faced,
    oiled,
    swung,
    unknown,
    with_benchmark,
    with_bore,
    with_certificate,
    with_contact,
    with_design,
    with_extension_spring,
    with_gas_spring,
    with_guides,
    with_linked_spring,
    with_material,
    with_mesh,
    with_part,
    with_torsion_spring,
)

HERTZ = made.cycle().contact.p0_hertz

# spring
tried(
    "spring_stress",
    loaded(
        "spring_stress",
        lambda u: with_design(
            strength_at_1mm=1974e6
            * float(by_hand.SHEAR * by_hand.TOP / (0.56 * by_hand.TENSILE))
            / u
        ),
    ),
    lambda: with_part("spring", design=None),
    lambda: with_design(strength_at_1mm=np.nan),
    float(by_hand.SHEAR * by_hand.TOP / (0.56 * by_hand.TENSILE)),
    "Wahl; 0.56 R_m, EN 13906-1; k (phi/sin(phi) - 1) at the fixed end",
)
by_limit(
    "spring_fatigue",
    "spring_fatigue",
    lambda: with_design(strength_at_1mm=np.nan),
    1.0 / float(by_hand.SWING / by_hand.ZIMMERLI + by_hand.MIDDLE / (0.67 * by_hand.TENSILE)),
    "Goodman through Zimmerli, Shigley ch. 10",
    missing=lambda: with_part("spring", design=None),
)
by_limit(
    "spring_solid",
    "spring_solid",
    unknown,
    (by_hand.SOLID - by_hand.DEFLECTION) / by_hand.DEFLECTION,
    "L0 - d (n + 2) - x, over x",
    missing=lambda: with_part("spring", design=None),
)
tried(
    "spring_coil_gap",
    loaded(
        "spring_coil_gap",
        lambda gap: with_design(
            free_length=by_hand.WIRE * (by_hand.COILS + 2.0) + by_hand.DEFLECTION + gap
        ),
    ),
    lambda: with_part("spring", design=None),
    unknown,
    1e3 * (by_hand.SOLID - by_hand.DEFLECTION),
    "L0 - d (n + 2) - x; S_a of EN 13906-1 in test_spring",
)
tried(
    "spring_solid_stress",
    loaded(
        "spring_solid_stress",
        lambda stress: with_design(
            free_length=by_hand.WIRE * (by_hand.COILS + 2.0)
            + stress * by_hand.WAHL / (by_hand.SHEAR * 1.05 * by_hand.RATE)
        ),
    ),
    lambda: with_part("spring", design=None),
    lambda: with_design(strength_at_1mm=np.nan),
    1e-6 * by_hand.SHEAR / by_hand.WAHL * 1.05 * by_hand.RATE * by_hand.SOLID,
    "8 D k (L0 - Lc)/(pi d^3)",
)
tried(
    "spring_buckling",
    lambda share: with_design(
        end_factor=float(
            np.sqrt(
                by_hand.SLENDER
                / (
                    1.0
                    - (
                        1.0
                        - 2.0
                        * (1.0 - by_hand.ISOTROPIC)
                        * by_hand.DEFLECTION
                        / (share * by_hand.FREE)
                    )
                    ** 2
                )
            )
        )
    ),
    lambda: with_part("spring", design=None),
    lambda: with_design(end_factor=np.nan),
    by_hand.DEFLECTION / by_hand.BUCKLES,
    "Haringx's s_K with pivoted ends",
    base=lambda: with_design(end_factor=1.0),
)
tried(
    "spring_relaxation",
    loaded(
        "spring_relaxation",
        lambda loss: with_design(relaxation=loss * 1.05 * made.PRELOAD / by_hand.HARDEST),
    ),
    lambda: with_design(relaxation=None),
    lambda: with_design(relaxation=np.nan),
    0.02 * by_hand.HARDEST / (1.05 * made.PRELOAD),
    "2 % of the greatest force over the preload",
)
for name, field, zero, hand, how in (
    (
        "gas_pressure",
        "pressure_limit",
        0.0,
        # the gas is warm: p (320 / 293.15), and preload and rise 5 % high
        1.05e-6 * ((3e6 + 101325.0) * 320.0 / 293.15 * (1.0 / 0.8) ** 1.3 - 101325.0),
        "p V^n constant over a fifth of the column",
    ),
    ("gas_stroke", "stroke", 0.0, 10.0, "the stroke"),
    (
        "gas_speed",
        "speed_limit",
        0.0,
        0.5 * made.STROKE * made.CAM_SPEED,
        "w h / 2 of a harmonic lift",
    ),
    ("gas_temperature", "temperature_limit", 273.15, 46.85, "stated"),
    (
        "gas_stroke_rate",
        "stroke_rate_limit",
        0.0,
        60.0 * made.CAM_SPEED / (2.0 * np.pi),
        "one rise in a turn",
    ),
):
    tried(
        name,
        limited(
            name,
            lambda value, field=field, zero=zero: with_gas_spring(**{field: value + zero}),
            with_gas_spring,
        ),
        lambda field=field: with_gas_spring(**{field: None}),
        lambda field=field: with_gas_spring(**{field: np.nan}),
        hand,
        how,
        with_gas_spring,
    )
tried(
    "gas_force_lost",
    limited(
        "gas_force_lost", lambda lost: with_gas_spring(preload_tolerance=lost), with_gas_spring
    ),
    lambda: with_gas_spring(loss=None),
    lambda: with_gas_spring(cold_temperature=np.nan),
    ((3e6 + 101325.0) / 293.15 * (320.0 - 0.98 * 300.0))
    / ((3e6 + 101325.0) * 320.0 / 293.15 - 101325.0),
    "98 % of the gas at 300 K against all of it at 320 K",
    with_gas_spring,
)
tried(
    "gas_heating",
    lambda share: with_gas_spring(conductance=by_hand.gas_friction() / (46.85 * share - 25.0)),
    None,
    lambda: with_gas_spring(conductance=np.nan),
    25.0 + by_hand.gas_friction() / 0.5,
    "friction of the seals over 0.5 W/K",
    lambda: with_gas_spring(conductance=0.5),
)
# the arm has turned by asin(1/4) over the stroke, moment and rise of the force 5 % high
BENT = (12.0 + 20.0 * np.arcsin(0.25)) * 1.05
CURVED = (8.0 + 0.07) / (8.0 - 0.75) * 32.0 / (np.pi * 0.006**3) / 1e6
tried(
    "torsion_stress",
    limited(
        "torsion_stress",
        lambda s: with_torsion_spring(tensile_strength=s / 0.54),
        with_torsion_spring,
    ),
    lambda: with_torsion_spring(tensile_strength=None),
    lambda: with_torsion_spring(tensile_strength=np.nan),
    CURVED * BENT,
    "q 32 M/(pi d^3)",
    with_torsion_spring,
)
tried(
    "torsion_fatigue",
    limited("torsion_fatigue", lambda s: with_torsion_spring(stress_range=s), with_torsion_spring),
    lambda: with_torsion_spring(wire_diameter=None),
    lambda: with_torsion_spring(stress_range=np.nan),
    CURVED * (BENT - 1.05 * 12.0),
    "q 32 (M_h - M_0)/(pi d^3)",
    with_torsion_spring,
)
# 6 mm by 42 mm, 8 coils of 79.5 GPa, 400 N; with both tolerances high at 10 mm
PULLED = (400.0 + 79.5e9 * 0.006**4 / (8.0 * 0.042**3 * 8.0) * 0.010) * 1.05
TWIST = 8.0 * 0.042 * PULLED / (np.pi * 0.006**3) / 1e6
TWISTED_COIL = 27.0 / 24.0 + 0.615 / 7.0
BENT_HOOK = 2.0 * TWIST * (4.0 * (20 / 3) ** 2 - 20 / 3 - 1.0) / (4.0 * 20 / 3 * 17 / 3)
BENT_HOOK += 4.0 * PULLED / (np.pi * 0.006**2) / 1e6
for each, share, stress, words in (
    ("extension_stress", 0.45, TWIST * TWISTED_COIL, "K_w 8 D F/(pi d^3)"),
    ("extension_hook_bending", 0.75, BENT_HOOK, "F (K_A 16 D/(pi d^3) + 4/(pi d^2))"),
    ("extension_hook_torsion", 0.40, TWIST * 15.0 / 12.0, "K_B 8 D F/(pi d^3)"),
):
    tried(
        each,
        limited(
            each,
            lambda s, share=share: with_extension_spring(tensile_strength=s / share),
            with_extension_spring,
        ),
        lambda: with_extension_spring(tensile_strength=None),
        lambda: with_extension_spring(tensile_strength=np.nan),
        stress,
        words,
        with_extension_spring,
    )
LOW = 400.0 * 1.05
ENDURANCE = 241.0 / (1.0 - 379.0 / (0.67 * 1600.0))
COILED = TWIST / PULLED * 15.0 / 12.0
by_limit(
    "extension_fatigue",
    "spring_fatigue",
    lambda: with_extension_spring(tensile_strength=np.nan),
    1.0
    / max(
        COILED * (0.5 * (PULLED - LOW) / ENDURANCE + 0.5 * (PULLED + LOW) / (0.67 * 1600.0)),
        BENT_HOOK / PULLED * (0.5 * (PULLED - LOW) * 0.775 / 0.225 + 0.5 * (PULLED + LOW)) / 1600.0,
    ),
    "Goodman of coils, bend and hook",
    base=with_extension_spring,
    missing=lambda: with_extension_spring(side_radius=None),
)
tried(
    "extension_initial_tension",
    limited(
        "extension_initial_tension",
        lambda f: with_extension_spring(force=f / 0.95),
        with_extension_spring,
    ),
    None,  # without an extension spring there is no check
    lambda: with_extension_spring(initial_tension=np.nan),
    60.0,
    "stated",
    with_extension_spring,
)
by_limit(
    "torsion_gap",
    "assembly_gap",
    lambda: with_torsion_spring(seat_height=0.07, mean_diameter=np.nan),
    8.0,
    "40 mm of arm less half of 48 + 6 of the coil and of 10 of the stem",
    base=lambda: with_torsion_spring(seat_height=0.07),
    missing=lambda: with_torsion_spring(wire_diameter=None),
)
# 50 mm and 60 mm to the ends at 70 deg, 50 kN/m and 400 N: the moment rises up to RISEN
RISEN = by_hand.greatest_moment_swing(0.05, 0.06, 70.0, 50e3, 400.0)
tried(
    "link_reach",
    limited("link_reach", lambda h: with_linked_spring(h / RISEN), with_linked_spring),
    None,  # without a link there is no check
    lambda: made.changed_solution(unknown(), case=with_linked_spring().case),
    10.0,
    "maximum lift",
    with_linked_spring,
)
tried(
    "spring_rate",
    limited("spring_rate", lambda t: with_part("spring", rate_tolerance=t)),
    lambda: with_part("spring", design=None),
    lambda: with_design(shear_modulus=np.nan),
    abs(by_hand.RATE / made.RATE - 1.0),
    "G d^4/(8 D^3 n)",
)
by_limit(
    "spring_surge",
    "spring_surge",
    lambda: with_design(density=np.nan),
    float(by_hand.SURGE),
    "sqrt(k/m)/2 over w/(2 pi)",
    missing=lambda: with_part("spring", design=None),
)
# a flat face
tried(
    "face_width",
    limited("face_width", lambda width: faced(width=width), faced),
    None,
    lambda: faced(cycle_with("contact", made.cycle(made.face_contour()), half_width=NAN)),
    2.0 * (5.0 + 0.1),
    "twice half the stroke and a half-width of 0.1",
    base=faced,
)
by_limit(
    "self_locking",
    "jam_index",
    lambda: swung(lift=UnknownLift(made.THETA, NAN, np.nan)),
    by_hand.self_locking(),
    "mu f/q at the crossing of two lines of the face",
    base=swung,
    missing=lambda: swung(friction=None),
)
tried(
    "face_pv",
    limited("face_pv", lambda pv: faced(pv_limit=pv), faced),
    lambda: faced(pv_limit=None),
    lambda: faced(cycle_with("contact", made.cycle(made.face_contour()), p0=NAN)),
    by_hand.sliding(),
    "pi/4 p0 w (r + s)",
    base=faced,
)
tried(
    "contact_temperature",
    limited("contact_temperature", lambda top: oiled(scuffing_temperature=top + 273.15), faced),
    lambda: oiled(boundary_temperature=None),
    lambda: faced(cycle_with("rolling", made.cycle(made.face_contour()), flash=NAN)),
    by_hand.contact_temperature(),
    "80 degC, mean and greatest flash temperature of Blok",
    base=faced,
)
by_limit(
    "bulk_temperature",
    "surface_temperature",
    lambda: faced(cycle_with("rolling", made.cycle(made.face_contour()), flash=NAN)),
    by_hand.bulk_temperature(),
    "80 degC and a share of the mean flash temperature",
    base=faced,
    missing=lambda: oiled(temperature=None),
    zero=273.15,
)
# verification of the solution
for _name, _field, _part, _value in (
    ("guide_equilibrium_force", "equilibrium", "force_residual", 1e-13),
    ("guide_equilibrium_moment", "equilibrium", "moment_residual", 1e-12),
):
    by_limit(_name, _field, lambda p=_part: with_guides(**{p: NAN}), _value, "as solved")
by_limit(
    "contact_complementarity",
    "complementarity",
    lambda: with_contact(residual_complementarity=NAN),
    1e-11,
    "as solved",
)
tried(
    "contact_equilibrium",
    loaded(
        "contact_equilibrium",
        lambda r: with_contact(residual_equilibrium=np.full(made.POSITIONS, r)),
    ),
    None,
    lambda: with_contact(residual_equilibrium=NAN),
    1e-9,
    "as solved",
)
tried(
    "hertz_difference",
    loaded("hertz_difference", lambda off: with_contact(p0=(1.0 + off) * HERTZ)),
    None,
    lambda: with_contact(p0=NAN),
    1.0,
    "one per cent above Hertz",
)
tried(
    "certificate_spread",
    loaded("certificate_spread", lambda off: with_certificate(p0_cycle=1.0 + off)),
    lambda: made.solution(certificate=()),
    lambda: with_certificate(p0_cycle=np.nan),
    0.4,
    "the worse of two angles",
)
by_limit(
    "certificate_gci",
    "mesh_uncertainty",
    lambda: with_certificate(p0=made.converged(np.nan)),
    0.5,
    "the worse of two angles",
    missing=lambda: made.solution(certificate=()),
)
for _name, _part, _value, _si in (
    ("mesh_angle", "min_angle_deg", 28.0, np.radians(1.0)),
    ("mesh_jacobian", "min_scaled_jacobian", 0.5, 1.0),
    ("mesh_edges", "edges_across_half_width", 20.0, 2.0),
):
    tried(
        _name,
        loaded(_name, lambda value, p=_part, si=_si: with_mesh(**{p: value / si})),
        lambda: made.solution(mesh=None),
        lambda p=_part: with_mesh(**{p: np.nan}),
        _value,
        "as the mesh says",
    )
for _part, _value in (("p0", 0.5), ("half_width", 0.4), ("von_mises", 0.3), ("tau_max", 0.2)):
    tried(
        f"mesh_{_part}",
        loaded(
            f"mesh_{_part}",
            lambda gci, p=_part: with_certificate(**{p: made.converged(gci)}),
        ),
        lambda: made.solution(certificate=()),
        lambda p=_part: with_certificate(**{p: made.converged(np.nan)}),
        _value,
        "the worse of two angles; the GCI's formula in test_solution_verification",
    )
for _part in ("nafems", "hertz"):
    tried(
        f"benchmark_{_part}",
        loaded(f"benchmark_{_part}", lambda off, p=_part: with_benchmark(p, off)),
        lambda: made.solution(benchmarks=None),
        lambda p=_part: with_benchmark(p, np.nan),
        1.0,
        "one per cent off",
    )
tried(
    "synthesis_converged",
    lambda gain: made.solution(synthesis_gain=1e-5 * gain),
    None,
    lambda: made.solution(synthesis_gain=np.nan),
    0.2e-5,
    "a fifth of it: the gain at which a search ends",
    base=lambda: made.solution(synthesis_gain=2e-6),
)
# what a plane model cannot see
tried(
    "held_distance",
    loaded(
        "held_distance", lambda n: with_contact(half_width=np.full(made.POSITIONS, 1.36e-3 / n))
    ),
    lambda: with_contact(half_width=np.zeros(made.POSITIONS)),
    lambda: with_contact(half_width=NAN),
    13.6,
    "1.36 mm of outer ring over 0.1 mm",
)
tried(
    "subsurface_depth",
    loaded(
        "subsurface_depth",
        lambda depth: with_contact(von_mises_depth=np.full(made.POSITIONS, 1e-4 * depth)),
    ),
    None,
    lambda: with_contact(von_mises_depth=NAN),
    0.7,
    "0.70 b, Johnson sec. 4.2(c)",
)
tried(
    "excluded_zone",
    loaded("excluded_zone", lambda radius: with_bore(excluded=radius)),
    lambda: with_bore(excluded=0.0),
    lambda: with_bore(excluded=np.nan),
    0.5,
    "1.5 elements at the keyway",
)
tried(
    "bore_stress",
    limited("bore_stress", lambda p: with_material("steel", core_yield_strength=p)),
    None,
    lambda: with_bore(away_from_edges=NAN),
    200.0,
    "away from the edges",
)
