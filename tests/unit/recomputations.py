"""Where the demand of each check is recomputed by an independent formulation, by its id.

A function of a file of the tests; `test_every_check` holds that every check has one and that it
names the check. Rows of missing data have no demand; `test_part_data` tries them.
"""

_ASSEMBLY = "unit/test_assembly.py"
_CONTACT = "verification/test_contact_audit.py"
_GROOVE = "verification/test_groove_cam.py"
_STEPS = "verification/test_stepped_groove.py"
_WORN = "verification/test_held_tolerances.py"
_YOKE = "verification/test_yoke_cam.py"
_PAIR = "verification/test_conjugate_cam.py"
_GUIDES = "verification/test_guides_audit.py"
_ARM = "verification/test_arm_strength.py"
_PIVOT = "unit/test_pivot_checks.py"
_HUB = "verification/test_hub_elements.py"
_ROLLER = "verification/test_roller_audit.py"
_IMPACT = "verification/test_gear_impact.py"
_SHAFT = "verification/test_camshaft_audit.py"
_SPRING = "verification/test_spring_audit.py"
_SWUNG = "unit/test_swung_face_case.py"
_SYNTHESIS = "unit/test_solution_verification.py"
_RUN = "end_to_end/test_run.py"
_SHAPE = "unit/test_numerics_recomputed.py"
_NUMERICS = "unit/test_numerics_audit.py"

_BY_TEST: dict[tuple[str, str], tuple[str, ...]] = {
    # shape and torque
    (_SHAPE, "test_shape_by_points_of_the_curves"): (
        "pressure_angle", "curvature_ratio", "undercut", "concave_radius", "curvature_rate",
        "minimum_wall", "spring_travel", "cam_radius", "guide_gap", "chord_error",
    ),
    (_GROOVE, "test_walls_by_points_and_distances"): (
        "outer_undercut", "outer_second_contact", "groove_radius", "groove_clearance",
    ),
    (_GROOVE, "test_the_disc_clears_the_machine_shaft"): ("groove_shaft_gap",),
    (_GROOVE, "test_landings_by_an_adaptive_integrator"): (
        "landing_speed", "landing_pressure",
    ),
    (_WORN, "test_worn_clearance_is_judged_where_it_is_greatest"): ("worn_clearance",),
    (_GROOVE, "test_energy_of_a_turn_with_landings"): ("landing_balance",),
    (_GROOVE, "test_the_slip_of_the_roller_by_its_own_equation"): (
        "crossover_slip", "slip_temperature",
    ),
    (_YOKE, "test_the_breadth_by_the_points_of_the_cam"): ("yoke_breadth",),
    (_PAIR, "test_both_discs_are_judged"): ("second_disc_gap",),
    ("verification/test_pair_gaps.py", "test_the_check_names_what_is_within_the_bearing"): (
        "second_track_gap",
    ),
    (_PAIR, "test_the_preload_is_judged_on_both_discs"): ("preload_least", "preload_pressure"),
    (_PAIR, "test_waves_of_preloaded_discs_by_an_integrator"): ("preload_waviness",),
    (_GROOVE, "test_the_rim_is_a_cantilever_plate"): ("groove_wall",),
    (_STEPS, "test_the_bearing_of_each_roller_by_its_own_forces"): (
        "second_roller_static", "second_roller_life", "second_roller_load_share",
        "second_roller_radial", "second_roller_static_radial",
    ),
    (_STEPS, "test_the_second_roller_by_the_data_of_its_own_bearing"): (
        "second_roller_modified_life", "second_roller_speed", "second_roller_lubrication",
        "second_roller_grease", "second_roller_ring_fatigue",
    ),
    (_SHAPE, "test_crossings_and_second_contact_by_distances"): (
        "self_intersection", "second_contact",
    ),
    (_PIVOT, "test_bush_of_a_solved_arm_by_the_balance_of_its_forces"): (
        "pivot_pressure", "pivot_pv", "pivot_temperature", "pivot_speed", "pivot_wear",
        "pivot_expansion",
    ),
    (_PIVOT, "test_jam_indices_of_a_solved_arm_by_moments"): (
        "pivot_jam_index", "pivot_jam_index_friction_max",
    ),
    (_PIVOT, "test_needles_of_a_solved_arm_by_the_path_that_it_swings"): (
        "pivot_static", "pivot_life",
    ),
    (_ASSEMBLY, "test_gaps_in_the_plane_of_the_cam_by_polygons_over_the_turn"): (
        "machine_shaft_gap", "fork_shaft_gap",
    ),
    ("unit/test_arm_assembly.py", "test_gaps_of_an_arm_by_polygons_over_the_turn"): (
        "arm_gap", "arm_cam_gap",
    ),
    (_ASSEMBLY, "test_gaps_along_the_camshaft_by_counting_free_micrometres"): (
        "bearing_gap", "gear_gap", "fork_gap",
    ),
    (_ASSEMBLY, "test_spring_seats_and_guides_by_outlines_over_the_turn"): ("spring_gap",),
    (_ASSEMBLY, "test_counterweight_by_outlines_in_the_plane_of_the_shaft"): ("counterweight_gap",),
    ("unit/test_torsion_spring.py", "test_the_coil_clears_stem_and_guides_over_the_turn"): (
        "torsion_gap",
    ),
    ("verification/test_tilted_line.py", "test_an_overhung_cam_turns_the_rings_of_its_roller"): (
        "roller_misalignment",
    ),
    (_ASSEMBLY, "test_a_sector_of_the_counterweight_has_its_unbalance"): (
        "counterweight_unbalance",
    ),
    (_ASSEMBLY, "test_teeth_of_another_ratio_fail"): ("tooth_ratio",),
    (_ASSEMBLY, "test_a_rack_cuts_no_tooth_of_the_involute_within_the_limit"): ("tooth_count",),
    (_SHAPE, "test_waviness_by_a_follower_on_a_sine"): ("profile_waviness",),
    (_SHAPE, "test_ripple_reduction_by_a_fourier_series_of_the_engine_s_torque"): (
        "torque_reduction",
    ),
    (_SHAPE, "test_ripple_reduction_at_the_phase_tolerance_by_a_shifted_series"): (
        "phase_tolerance",
    ),
    (_SHAPE, "test_drive_torque_by_the_moment_of_the_contact_force"): ("drive_torque",),
    (_SHAPE, "test_friction_balance_by_reactions_and_travel"): ("friction_balance",),
    (_SHAPE, "test_friction_power_by_the_way_of_stem_and_roller"): (
        "friction_power", "mechanism_temperature",
    ),
    (_SYNTHESIS, "test_another_method_gains_what_the_check_tells"): ("synthesis_converged",),
    (_NUMERICS, "test_the_torque_of_the_pressures_by_summing_r_x_f"): (
        "contact_torque", "contact_work",
    ),
    (_ARM, "test_fatigue_and_yield_of_the_arm_by_stress_tensors"): (
        "arm_fatigue_pivot", "arm_fatigue_roller", "arm_yield",
    ),
    ("verification/test_second_arm.py", "test_fatigue_and_yield_of_the_second_arm_by_lumps"): (
        "rocker_fatigue", "rocker_yield",
    ),
    (_ARM, "test_edge_pressure_of_the_pivot_over_the_turn"): ("pivot_edge_pressure",),
    # spring and motion
    (_SPRING, "test_margin_and_jump_from_motion_in_time"): (
        "contact_force_margin", "jump", "jump_speed", "contact_at_overspeed",
    ),
    (_SPRING, "test_the_contact_is_lost_between_the_load_cases"): (
        "contact_over_speed",
    ),
    (_SPRING, "test_first_frequency_is_that_of_the_chain"): ("spring_surge",),
    (_SPRING, "test_elastic_contact_is_that_of_coils_mass_and_stem_in_time"): ("elastic_contact",),
    (_SPRING, "test_the_follower_swings_on_its_stem_as_the_chain_with_its_mass"): (
        "rigid_follower",
    ),
    (_SPRING, "test_strength_and_fatigue_take_the_force_at_the_ends_of_the_coils"): (
        "spring_stress", "spring_fatigue",
    ),
    (_SPRING, "test_gaps_and_solid_length_from_the_wire"): (
        "spring_solid", "spring_coil_gap", "spring_solid_stress",
    ),
    (_SPRING, "test_a_stout_spring_does_not_buckle"): ("spring_buckling",),
    ("unit/test_gas_spring.py", "test_limits_of_the_maker"): (
        "gas_pressure", "gas_stroke", "gas_speed", "gas_temperature", "gas_stroke_rate",
        "gas_force_lost", "gas_heating", "gas_gap",
    ),
    ("unit/test_extension_spring.py",
     "test_a_case_pulls_its_arm_by_the_own_force_of_the_spring"): (
        "extension_stress", "extension_hook_bending", "extension_hook_torsion",
        "extension_fatigue", "extension_initial_tension",
    ),
    ("unit/test_torsion_spring.py", "test_stress_of_the_wire"): (
        "torsion_stress", "torsion_fatigue",
    ),
    ("unit/test_spring_link.py", "test_a_linked_case_has_force_and_limits_of_the_wire_at_its_own"
     "_travel"): ("link_reach",),
    (_SPRING, "test_rate_and_relaxation_from_the_wire"): ("spring_rate", "spring_relaxation"),
    # contact
    (_CONTACT, "test_pressure_is_that_of_roark"): (
        "contact_pressure", "shakedown", "pressure_by_gear_limits",
    ),
    (_CONTACT, "test_the_estimate_by_hardness_ends_at_400"): ("pressure_by_hardness",),
    (_CONTACT, "test_yield_is_that_of_carters_traction_by_line_forces"): ("first_yield",),
    (_CONTACT, "test_edge_pressure_is_that_of_the_half_spaces_and_says_so"): ("edge_pressure",),
    (_CONTACT, "test_life_counts_the_turns_of_the_roller"): ("contact_pressure_at_life",),
    (_CONTACT, "test_traction_is_that_of_the_fourier_series_of_the_spin"): (
        "traction_demand", "traction_reserve",
    ),
    (_CONTACT, "test_shakedown_with_traction_is_that_of_the_line_forces"): (
        "shakedown_traction", "edge_shakedown",
    ),
    (_CONTACT, "test_film_ratio_is_that_of_the_dimensional_formula"): ("film_ratio",),
    (_CONTACT, "test_fatigue_by_line_forces_and_a_simplex_search"): (
        "surface_fatigue", "dang_van",
    ),
    (_CONTACT, "test_case_and_core_by_the_stress_on_the_axis"): ("hardened_case",),
    (_CONTACT, "test_shear_by_depth_of_case_and_core"): ("case_shear",),
    (_CONTACT, "test_case_depth_by_the_axis"): ("case_depth",),
    (_CONTACT, "test_two_rules_for_one_card_that_differ_are_flagged"): ("endurance_rules",),
    (_CONTACT, "test_axial_offset_beyond_the_difference_of_widths_fails"): ("roller_overlap",),
    (_CONTACT, "test_width_and_pv_of_the_face"): ("face_width", "face_pv"),
    (_SWUNG, "test_self_locking_by_moments_about_the_pivot"): ("self_locking",),
    (_CONTACT, "test_temperature_of_the_sliding_face"): (
        "contact_temperature", "bulk_temperature",
    ),
    # roller
    (_ROLLER, "test_force_over_its_ratings"): (
        "roller_static", "roller_load_share", "roller_radial", "roller_static_radial",
    ),
    (_ROLLER, "test_speed_from_lengths_of_the_pitch_curve"): ("roller_speed",),
    (_ROLLER, "test_basic_life_by_adding_damage"): ("roller_life",),
    (_ROLLER, "test_modified_life_by_adding_damage"): ("roller_modified_life",),
    (_ROLLER, "test_viscosity_ratio_from_lengths_of_the_pitch_curve"): ("bearing_lubrication",),
    (_ROLLER, "test_grease_life_of_the_maker_and_by_estimate"): ("grease_life",),
    (_ROLLER, "test_pin_by_summation_along_it"): ("roller_pin", "roller_pin_shear"),
    (_ROLLER, "test_pin_fatigue_on_the_goodman_line"): ("roller_pin_fatigue",),
    (_ROLLER, "test_pressure_of_the_pin_in_its_seats"): ("roller_pin_pressure", "cheek_pressure"),
    (_ROLLER, "test_ring_fatigue_by_beams"): ("roller_ring_fatigue",),
    (_ROLLER, "test_moving_mass_by_revolving_and_counting"): ("follower_mass",),
    # guides
    (_GUIDES, "test_pressure_is_that_of_the_push_on_one_side"): (
        "guide_pressure_A", "guide_pressure_B",
    ),
    (_GUIDES, "test_edge_pressure_is_that_of_finite_elements"): (
        "guide_edge_pressure_A", "guide_edge_pressure_B",
    ),
    (_GUIDES, "test_pv_and_wear_by_work_over_the_stroke"): (
        "guide_pv_A", "guide_pv_B", "guide_wear_A", "guide_wear_B",
    ),
    (_GUIDES, "test_speed_by_differences_of_the_lift"): ("guide_speed_A", "guide_speed_B"),
    (_GUIDES, "test_jam_indices_by_collocation"): ("jam_index", "jam_index_friction_max"),
    (_GUIDES, "test_guided_length_by_hand"): ("guide_length",),
    (_GUIDES, "test_temperature_is_that_of_the_heat_at_the_greatest_friction"): (
        "guide_temperature_A", "guide_temperature_B",
    ),
    (_GUIDES, "test_growth_of_bush_and_stem"): ("guide_expansion_A", "guide_expansion_B"),
    (_GUIDES, "test_a_roller_needs_a_means_against_rotation"): ("anti_rotation",),
    (_GUIDES, "test_uncertainty_of_the_reaction_covers_its_error_by_collocation"): (
        "mesh_reaction",
    ),
    # camshaft
    (_SHAFT, "test_slip_and_bore"): ("cam_slip", "bore_pressure"),
    (_HUB, "test_wall_of_a_fit_by_elements"): ("fit_yield",),
    (_SHAFT, "test_reversals_by_the_sign_of_the_torque"): ("torque_reversals",),
    (_SHAFT, "test_unbalance_by_point_masses"): ("cam_unbalance",),
    (_SHAFT, "test_key_by_the_flank_that_bears"): (
        "key_pressure", "key_pressure_shaft", "key_shear",
    ),
    (_SHAFT, "test_a_chamfered_key_bears_on_the_flanks_of_a_filleted_keyway"): ("key_corner",),
    (_SHAFT, "test_keyway_root_of_the_solved_case"): ("keyway_root",),
    (_SHAFT, "test_fatigue_of_the_governing_section"): ("shaft_fatigue",),
    (_SHAFT, "test_yield_by_principal_stresses"): ("shaft_yield",),
    (_SHAFT, "test_deflection_and_slope_by_beam_elements"): ("shaft_deflection", "shaft_slope"),
    (_SHAFT, "test_bearings_by_reactions_of_the_elements_and_damage_sums"): (
        "shaft_bearing_static", "shaft_bearing_life",
    ),
    (_SHAFT, "test_tooth_root_by_the_tabulated_form_factor"): ("gear_bending", "pinion_bending"),
    (_IMPACT, "test_gear_impact_of_a_made_turn"): ("gear_impact",),
    (_SHAFT, "test_tooth_flank_by_hertz_at_the_pitch_point"): ("gear_contact",),
    # solution
    (_NUMERICS, "test_the_distance_to_holds_is_that_of_the_nodes_that_are_held_or_supported"): (
        "held_distance",
    ),
    (_SHAPE, "test_subsurface_depth_by_the_stress_field"): ("subsurface_depth",),
    (_SHAPE, "test_force_and_moment_of_the_guides_by_their_reactions"): (
        "guide_equilibrium_force", "guide_equilibrium_moment",
    ),
    (_SHAPE, "test_contact_equilibrium_and_difference_from_hertz_by_the_pressures"): (
        "contact_equilibrium", "contact_complementarity", "hertz_difference",
    ),
    (_RUN, "test_demands_by_the_files_of_the_run"): (
        "closure", "acceleration_step", "tool_gouge",
        "speed_reduction", "bore_stress", "excluded_zone",
        "mesh_angle", "mesh_jacobian", "mesh_edges", "mesh_p0", "mesh_half_width", "mesh_tau_max",
        "mesh_von_mises", "certificate_gci", "certificate_spread",
    ),
    (_RUN, "test_benchmarks_by_quadrature"): ("benchmark_nafems", "benchmark_hertz"),
}  # fmt: skip

RECOMPUTED_IN = {name: place for place, names in _BY_TEST.items() for name in names}
"""File below the tests and function by the id of the check."""
CLAIMS = sum(map(len, _BY_TEST.values()))
