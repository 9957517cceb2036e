"""Every check at 0.99 and 1.01 of its limit, with a NaN, without its data, by hand, and elsewhere.

`check_registry.TRIED` holds one entry a check; one that is added without fails the last tests.
"""

import ast
import re
from dataclasses import replace
from functools import cache
from pathlib import Path

import made_trial as made
import numpy as np
import pytest
from check_registry import BY_ID, BY_ITSELF, DATA, MADE_LATER, TRIED, check
from recomputations import CLAIMS, RECOMPUTED_IN

from camwright.geometry.errors import CamError
from camwright.pipeline.base.verdict import verdict
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks import solution_verification as verification
from camwright.pipeline.checks.registry import (
    CHECKS,
    TOLERANCE_CORNERS,
    WAIVERS_WITHOUT_EFFECT,
)
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import solution as solve
from camwright.pipeline.follower.guide_reactions import guide_reactions
from camwright.pipeline.preview import preview_case

MUST_HAVE = {
    # shape, space and function
    *("closure", "acceleration_step", "pressure_angle", "curvature_ratio", "undercut"),
    *(
        "self_intersection",
        "second_contact",
        "tool_gouge",
        "concave_radius",
        "minimum_wall",
        "spring_travel",
    ),
    *("bearing_gap", "gear_gap", "machine_shaft_gap", "fork_shaft_gap", "fork_gap"),
    *("arm_gap", "arm_cam_gap"),
    "tooth_count",
    "tooth_ratio",
    *("arm_fatigue_pivot", "arm_fatigue_roller", "arm_yield", "rocker_fatigue", "rocker_yield"),
    *("guide_gap", "cam_radius", "torque_reduction", "contact_torque"),
    # forces and contact
    *("contact_force_margin", "jump", "jump_speed", "contact_at_overspeed", "friction_balance"),
    *("jam_index", "jam_index_friction_max", "contact_pressure", "contact_pressure_at_life"),
    *("shakedown", "shakedown_traction", "edge_pressure", "edge_shakedown", "roller_overlap"),
    *("traction_demand", "hardened_case", "case_shear", "case_depth"),
    # parts
    *("roller_static", "roller_life", "roller_radial", "roller_speed", "roller_pin"),
    *("roller_static_radial", "roller_load_share", "roller_modified_life", "grease_life"),
    *("bearing_lubrication", "roller_ring_fatigue", "roller_pin_fatigue", "roller_pin_shear"),
    *("roller_pin_pressure", "cheek_pressure", "follower_mass"),
    *("guide_pressure_A", "guide_pressure_B", "guide_pv_A", "guide_pv_B", "anti_rotation"),
    *("guide_edge_pressure_A", "guide_edge_pressure_B", "guide_temperature_A"),
    *("guide_temperature_B", "guide_speed_A", "guide_speed_B", "guide_expansion_A"),
    *("guide_expansion_B", "guide_wear_A", "guide_wear_B"),
    "pivot_edge_pressure",
    *("pivot_pressure", "pivot_pv", "pivot_temperature", "pivot_speed", "pivot_expansion"),
    *("pivot_wear", "pivot_jam_index", "pivot_jam_index_friction_max", "pivot_static"),
    "pivot_life",
    *("spring_stress", "spring_fatigue", "spring_solid", "spring_buckling", "gas_stroke_rate"),
    *("spring_coil_gap", "spring_solid_stress", "spring_relaxation", "spring_rate", "link_reach"),
    *("contact_over_speed", "elastic_contact", "friction_power", "contact_temperature"),
    # camshaft
    *("key_pressure", "key_pressure_shaft", "key_shear", "cam_slip"),
    *("keyway_root", "fit_yield", "bore_pressure"),
    *("shaft_fatigue", "shaft_yield", "shaft_deflection", "shaft_slope"),
    *("shaft_bearing_static", "shaft_bearing_life", "gear_bending", "pinion_bending"),
    *("gear_contact", "gear_impact", "cam_unbalance"),
    # manufacture
    *("profile_waviness", "preload_waviness", "chord_error"),
    # verification
    *("guide_equilibrium_force", "guide_equilibrium_moment", "contact_equilibrium"),
    *("contact_complementarity", "certificate_spread", "certificate_gci", "mesh_angle"),
    *("mesh_jacobian", "mesh_edges", "mesh_p0", "mesh_half_width", "mesh_von_mises"),
    *("benchmark_nafems", "benchmark_hertz", "held_distance", "excluded_zone"),
}
REDESIGN = Path(__file__).parents[2] / "cases" / "gx120-redesign.toml"


@pytest.mark.parametrize("name", TRIED)
@pytest.mark.parametrize(("share", "status"), [(0.99, "pass"), (1.01, "fail")])
def test_on_both_sides_of_the_limit(name, share, status):
    plain = check(name, TRIED[name].base())
    tried = check(name, TRIED[name].at(share))
    assert tried.status == status
    if tried.limit:  # a count has the limit zero
        assert tried.utilisation == pytest.approx(share, rel=1e-6)
    assert tried.limit == plain.limit or tried.demand == pytest.approx(plain.demand)
    assert tried.source and tried.method and tried.title and tried.unit


@pytest.mark.parametrize("name", [name for name, tried in TRIED.items() if tried.missing])
def test_without_its_data_nothing_is_evaluated(name):
    bare = check(name, TRIED[name].missing())
    assert bare.status == "not_evaluated"
    assert bare.utilisation is None
    assert not (bare.must_have and not bare.blocks)


@pytest.mark.parametrize("name", [name for name, tried in TRIED.items() if tried.nan])
def test_a_nan_never_passes(name):
    try:
        unknown = check(name, TRIED[name].nan())
    except CamError:
        return  # refused
    assert unknown.status == "not_evaluated"
    assert unknown.utilisation is None


@pytest.mark.parametrize("name", TRIED)
def test_by_hand(name):
    tried = TRIED[name]
    assert tried.how
    # Splines of 72 samples hold their second derivative to 1e-4; all else is closed.
    demand = check(name, tried.base()).as_record()["demand"]
    assert demand == pytest.approx(tried.hand, rel=5e-4, abs=1e-15)


def solved(reaction: float):
    """In place of the guides' solver: one position with this reaction in guide A."""
    machine = machines(made.case())[0]
    answer = guide_reactions([100.0], [0.03], machine.stem, machine.guides)
    return replace(answer, reaction_a=np.array([reaction]))


@pytest.mark.parametrize(
    ("gci", "status"), [(0.0297, "pass"), (0.0303, "fail"), (np.nan, "not_evaluated")]
)
def test_mesh_uncertainty_of_the_reaction(monkeypatch, gci, status):
    """Of the guides' solutions alone: 3 per cent of the finest at an observed order of one."""
    monkeypatch.setattr(verification, "converged", lambda values, ratio: made.converged(gci))
    assert verification.mesh_reaction(made.solution()).status == status


def test_mesh_uncertainty_of_the_reaction_by_hand(monkeypatch):
    """1.04, 1.01 and 1.0025 of a limit of one: order 2, GCI 1.25 (0.0075/1.0025)/3, Roache."""
    answers = iter([solved(1.04), solved(1.01), solved(1.0025)])
    monkeypatch.setattr(verification, "guide_reactions", lambda *args, **more: next(answers))
    result = verification.mesh_reaction(made.solution())
    demand = result.as_record()["demand"]
    assert demand == pytest.approx(100.0 * 1.25 * 0.0075 / 1.0025 / 3.0, rel=1e-9)
    assert "observed order 2.00" in result.method


def test_mesh_uncertainty_of_the_reaction_includes_the_couple_of_a_face(monkeypatch):
    """The finest is the reaction of the turn, to which a face adds the couple of its contact."""
    finest = []

    def kept(values, ratio):
        finest.append(values[-1])
        return made.converged(0.01)

    monkeypatch.setattr(verification, "converged", kept)
    solution = solve(made.face_case(), made.face_contour(), Tier.PREVIEW, torques={}, positions=24)
    assert verification.mesh_reaction.demand(solution) is not None
    greatest = max((c.guides.reaction_a for c in solution.cycles), key=lambda r: np.abs(r).max())
    assert abs(finest[0]) == pytest.approx(np.abs(greatest).max(), rel=1e-6)


@pytest.mark.parametrize("name", sorted(MUST_HAVE))
def test_a_must_have_is_one_with_and_without_its_data(name):
    """What a sign-off must have leaves the verdict incomplete when its input is missing."""
    tried = TRIED[name]
    assert check(name, tried.base()).must_have
    if tried.missing:
        bare = check(name, tried.missing())
        assert bare.must_have
        assert bare.blocks
        assert verdict([bare]) == "incomplete"


@pytest.mark.parametrize("name", BY_ID)
def test_every_check_states_its_formula_and_why_it_decides(name):
    declared = BY_ID[name]
    assert declared.formula and declared.reason and declared.method and declared.load_cases
    assert declared.source or declared.limit is not None


def test_every_check_is_tried():
    """A check cannot be added without its limits, NaN, missing data and hand calculation."""
    assert set(BY_ID) == set(TRIED) | BY_ITSELF | DATA
    assert len(CHECKS) == len(BY_ID)
    assert {declared.id for declared in (TOLERANCE_CORNERS, WAIVERS_WITHOUT_EFFECT)} == MADE_LATER


@cache
def parsed(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


@cache
def words_of_test(path: str, name: str) -> frozenset[str]:
    """Names and parts of texts in a test, and in the functions and tables of its file it uses."""
    file = Path(__file__).parents[1] / path
    tree = parsed(file)
    known = {each.name: each for each in tree.body if isinstance(each, ast.FunctionDef)}
    known |= {
        target.id: each
        for each in tree.body
        if isinstance(each, ast.Assign)
        for target in each.targets
        if isinstance(target, ast.Name)
    }
    beside = {
        alias.name: file.parents[1] / f"{each.module}.py"
        for each in tree.body
        if isinstance(each, ast.ImportFrom) and (file.parents[1] / f"{each.module}.py").exists()
        for alias in each.names
    }
    assert name in known, f"{path} has no {name}"
    words, left = set(), [name]
    while left:
        for node in ast.walk(known.pop(left.pop())):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                words |= set(re.findall(r"\w+", node.value))
            elif isinstance(node, ast.Name | ast.Attribute | ast.arg):
                word = getattr(node, "id", None) or getattr(node, "attr", None) or node.arg
                words.add(word)
                left += [word] if word in known and word not in left else []
    for own in {beside[name] for name in words & set(beside)}:
        words |= set(re.findall(r"\w+", own.read_text(encoding="utf-8")))
    return frozenset(words)


def test_every_check_is_recomputed():
    """A check cannot be added without a test that recomputes its demand from a solution."""
    assert set(RECOMPUTED_IN) == set(BY_ID) - DATA
    assert len(RECOMPUTED_IN) == CLAIMS, "a check is claimed twice"


@pytest.mark.parametrize("name", RECOMPUTED_IN)
def test_the_recomputation_of_a_check_names_it(name):
    words = words_of_test(*RECOMPUTED_IN[name])
    group, _, own = name.partition("_")
    assert {name, name.rstrip("AB")} & words or {f"{group}_", own} <= words


@pytest.mark.parametrize(
    "kind", ["moving_average", pytest.param("constrained", marks=pytest.mark.slow)]
)
def test_the_redesigned_case_raises_no_check_that_is_not_tried(kind):
    """The redesigned machine of a case file in a preview, synthesised or smoothed."""
    redesign = read_case(REDESIGN).with_positions(72)
    smoothing = redesign.smoothing.model_copy(update={"kind": kind})
    redesign = redesign.model_copy(update={"smoothing": smoothing})
    names = {check.id for check in preview_case(redesign, corners=False).checks}
    assert names <= set(TRIED) | MADE_LATER | DATA | BY_ITSELF
    assert len(names) > 50
