"""Screening against the preview: the same designs, one solved at a time with guides of length."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
import pytest
from test_seeded_arms import drawn as drawn_arm

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.lift import Lift
from camwright.geometry.periodic_spline import knot_derivatives, knot_integrals, periodic_quintic
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, read_case, with_values
from camwright.pipeline.case.case_values import replaced, value_of
from camwright.pipeline.case.external_load import closing_preload
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import machine
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.registry import CHECKS, DECLARED
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.follower.follower_forces import Push
from camwright.pipeline.follower.guide_reactions import guide_reactions
from camwright.pipeline.follower.guide_table import OverhangTable, SupportOfMany
from camwright.pipeline.follower.spring import stored_lift
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.screening.design_factors import ARRAYS, is_array
from camwright.pipeline.screening.design_screening import screen_designs, synthesis
from camwright.pipeline.screening.screened_checks import SCREENED
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.solver import solve

CASES = Path(__file__).parents[2] / "cases"
FAR = 10.0  # utilisation beyond which the deviation of a demand is of no interest
# Low and high of each factor, SI.
RANGES: Mapping[str, Mapping[str, tuple[float, float]]] = {
    "gx120": {
        "spring.rate": (15e3, 60e3), "spring.preload": (200.0, 900.0),
        "cam.prime_radius": (0.045, 0.07), "cam.offset": (-0.005, 0.005),
        "cam.width": (0.004, 0.006), "roller.radius": (0.008, 0.02), "roller.width": (0.004, 0.006),
        "follower.mass": (0.1, 0.3), "follower.overhang_at_max_lift": (0.02, 0.04),
        "guides.spacing": (0.06, 0.12), "guides.a.friction": (0.02, 0.07),
        "guides.b.friction": (0.1, 0.16), "mechanism.compensation": (0.5, 1.0),
        "limits.pressure_angle": (0.3, 0.8), "limits.overspeed": (200.0, 420.0),
        "roller.crown.radius": (0.05, 3.0),
    },
    "gx120-redesign": {
        "spring.rate": (160e3, 200e3), "spring.preload": (800.0, 1400.0),
        "cam.prime_radius": (0.05, 0.065), "cam.offset": (-0.003, 0.003),
        "cam.width": (0.012, 0.0175), "roller.radius": (0.0235, 0.0285),
        "follower.mass": (0.55, 0.8), "spring.design.wire_diameter": (8.2e-3, 8.8e-3),
        "spring.design.mean_diameter": (0.040, 0.044), "spring.design.coils": (3.5, 4.2),
        "spring.design.free_length": (0.066, 0.078), "spring.design.shear_modulus": (75e9, 82e9),
        "spring.design.elastic_modulus": (190e9, 215e9), "spring.design.end_factor": (0.5, 1.0),
        "spring.design.strength_at_1mm": (1.8e9, 2.1e9), "spring.design.relaxation": (0.003, 0.03),
        "limits.roller_static_safety": (1.5, 4.0),
    },
    "gx120-flat-face": {
        "spring.rate": (160e3, 200e3), "spring.preload": (800.0, 1400.0),
        "cam.prime_radius": (0.04, 0.055), "cam.offset": (-0.003, 0.003),
        "cam.width": (0.012, 0.02), "follower.mass": (0.5, 0.8),
        "follower.overhang_at_max_lift": (0.024, 0.036), "follower.face.width": (0.03, 0.05),
        "follower.face.depth": (0.012, 0.02),
        "follower.face.thickness": (0.006, 0.012), "follower.face.friction": (0.02, 0.12),
        "follower.face.pv_limit": (3e9, 9e9), "guides.spacing": (0.12, 0.135),
        "guides.a.friction": (0.04, 0.12), "guides.b.friction": (0.04, 0.12),
        "spring.design.wire_diameter": (8.2e-3, 8.8e-3),
        "spring.design.free_length": (0.066, 0.078),
    },
    "machines/two-stroke": {
        "spring.rate": (90e3, 120e3), "spring.preload": (800.0, 1300.0),
        "cam.prime_radius": (0.055, 0.07), "cam.offset": (-0.003, 0.003),
        "cam.width": (0.013, 0.0155), "cam.bore_radius": (0.014, 0.016),
        "roller.width": (0.017, 0.0185), "roller.bearing.C": (7e3, 12e3),
        "follower.mass": (0.9, 1.3), "follower.overhang_at_max_lift": (0.047, 0.055),
        "guides.a.friction": (0.04, 0.08), "guides.b.friction": (0.04, 0.08),
        "limits.overspeed": (170.0, 250.0), "limits.key_share": (0.2, 0.9),
        "limits.key_reversal": (0.3, 1.0), "limits.cam_slip": (1.0, 6.0),
        "limits.shaft_reliability": (0.9, 0.999), "limits.keyway_safety": (1.0, 4.0),
        "limits.gear_bending_safety": (1.0, 8.0), "limits.gear_contact_safety": (1.0, 3.0),
        "limits.bore_share": (0.005, 0.1), "limits.pin_share": (0.02, 0.1),
        "limits.target_life": (1e6, 1e8), "limits.viscosity_ratio": (0.5, 2.0),
    },
    "gx120-arm": {
        "spring.rate": (160e3, 200e3), "spring.preload": (1000.0, 1300.0),
        "cam.prime_radius": (0.053, 0.06), "roller.radius": (0.0235, 0.025),
        "follower.mass": (0.55, 0.7), "follower.arm.centre_distance": (0.097, 0.104),
        "follower.arm.length": (0.085, 0.092), "follower.arm.width": (0.028, 0.034),
        "follower.arm.depth": (0.022, 0.03), "follower.arm.bore": (0.021, 0.024),
        "follower.arm.hub": (0.034, 0.04), "follower.arm.plane_offset": (0.0, 1e-3),
        "follower.arm.pivot_notch": (1.5, 2.5), "follower.arm.roller_notch": (1.5, 3.0),
        "follower.pivot.swinging_mass": (0.8, 1.0), "follower.pivot.mass_distance": (0.05, 0.07),
        "follower.pivot.mass_angle": (-0.2, 0.2), "follower.pivot.gravity_angle": (1.0, 2.0),
        "follower.pivot.load_moment": (-3.0, 3.0), "follower.pivot.bush.length": (0.02, 0.03),
        "follower.pivot.bush.diameter": (0.018, 0.022),
        "follower.pivot.bush.clearance": (2e-5, 6e-5), "follower.pivot.bush.wall": (1e-3, 2e-3),
        "follower.pivot.bush.friction": (0.04, 0.08),
        "follower.pivot.bush.wear_rate": (1e-17, 1e-16),
        "follower.pivot.bush.pressure_limit": (1e7, 1e8),
        "follower.pivot.bush.pv_limit": (1e5, 1e7),
    },
    "papers/petrescu_c": {
        "spring.rate": (2e3, 20e3), "spring.preload": (20.0, 90.0),
        "cam.prime_radius": (0.02, 0.04), "cam.offset": (-0.002, 0.002),
        "follower.mass": (0.05, 0.2), "follower.face.friction": (0.0, 0.1),
    },
}  # fmt: skip
# The acceleration of the harmonic law has steps: both at the same angles.
POSITIONS = {"papers/petrescu_c": 720}


# Keys of the shape of contact; with more than 16 shapes the pressure along the line is a bound.
SHAPES = 8
STRAIGHT = ("cam.width", "roller.width", "follower.face.depth")
CROWNED = (*STRAIGHT, "cam.prime_radius", "roller.radius", "roller.crown.radius")
CROWN = {"roller.crown.kind": "circular", "roller.crown.radius": "200 mm"}
GREASED = {
    "roller.friction": 0.1, "roller.bearing.viscosity": "27 mm^2/s",
    "roller.bearing.contamination": "normal_cleanliness", "roller.bearing.temperature": "60 degC",
    "roller.bearing.fatigue_load_limit": "17 N", "roller.bearing.lubrication": "grease_for_life",
    "limits.target_life": "500 h", "guides.a.wear_rate": "3e-7 mm^3/N/m",
    "guides.b.wear_rate": "3e-8 mm^3/N/m", "limits.roller_life": "100 h",
}  # fmt: skip
"""What the case with a crown lacks for the lives of bearing, grease and guides."""


def stated(name: str) -> Case:
    """A shipped case, with a crown and its grease where the radius of the crown is a factor."""
    case = read_case(CASES / f"{name}.toml")
    crowned = "roller.crown.radius" in RANGES[name]
    return with_values(case, CROWN | GREASED) if crowned else case


def drawn(name: str, count: int, without: tuple[str, ...] = ()) -> dict[str, Array]:
    """Factors of random designs about a shipped case, of `SHAPES` shapes of contact."""
    draw = np.random.default_rng(20)
    factors = {key: draw.uniform(*ends, count) for key, ends in RANGES[name].items()}
    shape = draw.integers(min(SHAPES, count), size=count)
    shaped = CROWNED if "roller.crown.radius" in factors else STRAIGHT
    factors |= {key: factors[key][shape] for key in shaped if key in factors}
    return {key: values for key, values in factors.items() if key not in without}


def previewed(
    case: Case, factors: Mapping[str, Array], positions: int | None = None
) -> Iterator[Trial]:
    """Each design solved on its own by closed forms; positions: None: those of a preview."""
    energy = None
    if case.smoothing.kind == "constrained":
        case, energy = synthesis(case)
    torques = engine_torques(case)
    for k in range(len(next(iter(factors.values())))):
        own = replaced(case, {key: float(values[k]) for key, values in factors.items()})
        contour = own.contour(_lift(own, energy) if energy is not None else cam_lift(own, torques))
        yield solve(
            own, contour, tier=Tier.PREVIEW, torques=torques, positions=positions, corners=False
        )


def _lift(case: Case, energy: Array) -> Lift:
    spring = case.spring
    values = stored_lift(energy, spring.rate, closing_preload(case), spring.shape)
    return Lift(uniform_turn(energy.size), values)


def deviations(name: str, count: int, without: tuple[str, ...] = ()) -> dict[str, float]:
    """Greatest deviation of each check over the greater of demand and limit; `screen` agrees."""
    return compared(stated(name), drawn(name, count, without), POSITIONS.get(name, 180))


def compared(
    case: Case, factors: Mapping[str, Array], positions: int = 180, solved: int | None = None
) -> dict[str, float]:
    """As `deviations`, of designs of a case; solved: cam angles of the previews, None: theirs."""
    columns = screen_designs(case, factors, positions=positions)
    worst: dict[str, float] = defaultdict(float)
    for k, trial in enumerate(previewed(case, factors, solved)):
        assert columns["message"][k] == ""
        known = {check.id: check for check in trial.checks}
        fails = set()
        close = False
        for screened in SCREENED:
            check = known.get(screened.check)
            if check is None or check.demand is None or f"{check.id}.demand" not in columns:
                continue
            used = check.utilisation
            if used is None or used <= FAR:
                away = _deviation(check, float(columns[f"{check.id}.demand"][k]))
                worst[check.id] = max(worst[check.id], away)
            status = columns[f"{check.id}.status"][k]
            near = used is not None and abs(1.0 - used) <= screened.deviation
            if status == "not_evaluated":
                how = DECLARED[check.id].measured
                bounded = DECLARED[check.id].is_bound(Tier.SCREENING) or (how and how.bounded)
                assert bounded or check.status in ("not_evaluated", "pass"), check.id
                continue
            close |= check.must_have and near
            assert status == check.status or near, (check.id, k, str(check))
            if check.must_have and check.status == "fail":
                fails.add(check.id)
        if not close:
            assert (columns["screen"][k] == "fail") == bool(fails), (k, fails)
        figures = headline(trial.solution)
        for what, key in (("force", "normal_force_max_N"), ("p0", "p0_hertz_max_MPa")):
            mine, solved = float(columns[f"headline.{key}"][k]), figures[key]
            assert np.isnan(mine) == (solved is None), (what, k)
            if solved is not None:
                worst[what] = max(worst[what], abs(mine / solved - 1.0))
    return worst


def _deviation(check: Check, mine: float) -> float:
    demand = in_unit(float(check.demand or 0.0), check.unit)
    limit = check.limit
    allowed = 0.0 if limit is None or np.isnan(limit) else in_unit(limit, check.unit)
    if not (np.isfinite(demand) and np.isfinite(mine)):
        return 0.0 if demand == mine or np.isnan(mine) else np.inf
    scale = max(abs(demand), abs(allowed))
    return abs(mine - demand) / scale if scale else abs(mine)


def exceeded(worst: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """Deviations beyond those stated: of the checks, of p0 1e-3 and of the normal force 2 %."""
    most = {each.check: each.deviation for each in SCREENED} | {"p0": 1e-3, "force": 0.02}
    return {key: (value, most[key]) for key, value in worst.items() if not value <= most[key]}


HOT = {"friction_power", "mechanism_temperature"}
SLIDING = {"bulk_temperature", "contact_temperature"}


@pytest.mark.parametrize(
    ("name", "count", "judged"),
    [
        ("gx120", 2, HOT),
        ("machines/two-stroke", 2, {*HOT, "roller_pin", "cheek_pressure"}),
        ("papers/petrescu_c", 8, set()),
        ("gx120-flat-face", 2, SLIDING),  # its friction is ten times the limit
    ],
)
def test_a_few_designs_agree_with_their_previews(name: str, count: int, judged: set[str]) -> None:
    worst = deviations(name, count, without=("guides.spacing",))
    assert {"p0", "force", "contact_pressure"} | judged <= set(worst)
    assert exceeded(worst) == {}


def test_a_follower_near_the_lock_has_a_jam_index() -> None:
    """Its friction and axial force raise each other, so that plain rounds on both never settle."""
    near = {
        "spring.rate": 16.8e3, "spring.preload": 244.0, "cam.prime_radius": 51.1e-3,
        "cam.offset": -4.49e-3, "follower.mass": 0.136, "guides.spacing": 0.1146,
        "guides.a.friction": 0.0388, "guides.b.friction": 0.1117,
        "follower.overhang_at_max_lift": 26.8e-3,
    }  # fmt: skip
    factors = {key: np.array([value]) for key, value in near.items()}
    case, key = read_case(CASES / "gx120.toml"), "jam_index_friction_max"
    row = screen_designs(case, factors, positions=180)
    (preview,) = previewed(case, factors)
    index = next(check.demand for check in preview.checks if check.id == key)
    assert index is not None and 1.0 < index == pytest.approx(row[f"{key}.demand"][0], rel=0.01)
    assert row[f"{key}.status"][0] == "fail"


def test_many_shapes_of_contact_fail_by_plane_strain_alone() -> None:
    """Beyond 16 shapes the pressure along the line is bounded by plane strain, from below."""
    case = read_case(CASES / "gx120.toml")
    factors = {
        "cam.width": np.linspace(4e-3, 6e-3, 17),
        "limits.contact_safety": np.linspace(0.15, 0.9, 17),
    }
    many = screen_designs(case, factors, positions=90)
    few = [
        screen_designs(case, {key: each[part] for key, each in factors.items()}, positions=90)
        for part in (slice(0, 9), slice(9, 17))
    ]
    status = many["edge_pressure.status"]
    judged = np.concatenate([each["edge_pressure.status"] for each in few])
    assert set(status) == {"fail", "not_evaluated"}
    assert set(judged[status == "fail"]) == {"fail"} and "fail" in judged[status != "fail"]
    bound = np.asarray(many["edge_pressure.demand"], dtype=float)
    demand = np.concatenate([each["edge_pressure.demand"] for each in few]).astype(float)
    assert (demand > bound)[status == "fail"].all()
    assert np.isnan(bound[status == "not_evaluated"]).all()


def test_screening_declares_its_checks() -> None:
    declared = [each.id for each in CHECKS if each.fails_from is Tier.SCREENING]
    assert sorted(declared) == sorted(each.check for each in SCREENED)


@pytest.mark.parametrize(
    "name",
    [
        "gx120",
        "papers/petrescu_c",
        pytest.param("gx120-redesign", marks=pytest.mark.slow),
        pytest.param("gx120-flat-face", marks=pytest.mark.slow),
    ],
)
def test_a_single_case_has_the_statuses_of_its_row(name: str) -> None:
    case, drawn = read_case(CASES / f"{name}.toml"), None
    if case.smoothing.kind == "constrained":
        drawn, energy = synthesis(case)
        contour = drawn.contour(_lift(drawn, energy))
    else:
        drawn, contour = case, case.contour(cam_lift(case, engine_torques(case)))
    trial = solve(drawn, contour, tier=Tier.SCREENING, positions=90)
    row = screen_designs(case, {"spring.preload": [drawn.spring.preload]}, positions=90)
    statuses = {key[: -len(".status")]: row[key][0] for key in row if key.endswith(".status")}
    known = {check.id: check for check in trial.checks}
    assert {check.id for check in within_depth(trial.checks)} <= set(statuses)
    for each in SCREENED:
        status, check = statuses.get(each.check, ""), known.get(each.check)
        used = None if check is None else check.utilisation
        near = used is not None and abs(1.0 - used) <= each.deviation
        how = DECLARED[each.check].measured
        if how and how.bounded == "surge" and status == "not_evaluated":
            continue  # the row leaves out the surge, which the case has
        assert near or status == ("" if check is None else check.status), each.check
    assert row["screen"][0] == trial.screen


@pytest.mark.slow
@pytest.mark.parametrize("name", RANGES)
def test_hundreds_of_designs_agree_with_their_previews(name: str) -> None:
    worst = deviations(name, 100)
    assert {"p0", "force", "contact_pressure"} <= set(worst)
    assert exceeded(worst) == {}


SMOOTH = "cycloidal"


def seeded_arm(seed: int) -> tuple[Case, dict[str, Array]]:
    """A seeded arm with a smooth swing, and two designs about it by all its keys of arrays."""
    tables = drawn_arm(seed)
    for segment in tables["lift"]["segment"]:
        segment["law"] = segment["law"] if segment["law"] == "dwell" else SMOOTH
    case, draw = case_of(tables), np.random.default_rng(seed)
    of_arm = ("follower.arm.", "follower.pivot.", "spring.link.", "cam.prime_radius")
    keys = [key for key in ARRAYS if key.startswith(of_arm) and is_array(case, key, [1.0])
            and value_of(case, key)]  # fmt: skip
    return case, {key: value_of(case, key) * draw.uniform(0.98, 1.02, 2) for key in keys}


ARMS = (0, 2, 3, 4, 5, 8, 10, 11, 14, 16, 17, 18, 19, 20, 23)
"""Seeded arms that bound a body: roller, flat and curved face, bush, needles and neither, coil,
torsion and linked spring."""


@pytest.mark.parametrize(
    "seed", [pytest.param(k, marks=() if k in (3, 17, 23) else pytest.mark.slow) for k in ARMS]
)
def test_seeded_arms_agree_with_their_previews(seed: int) -> None:
    case, factors = seeded_arm(seed)
    assert {"follower.arm.length", "follower.arm.centre_distance"} <= set(factors)
    worst = compared(case, factors, 360, 360)
    assert {"p0", "force", "contact_pressure", "jump"} <= set(worst)
    if case.follower.pivot is not None and case.scope.covers("pivot"):
        assert {"pivot_jam_index", "pivot_jam_index_friction_max"} <= set(worst)
    assert exceeded(worst) == {}


def test_splines_at_their_samples_are_the_periodic_quintic() -> None:
    """Against the coefficients of the spline by collocation; round-off of the fourth derivative."""
    theta = uniform_turn(72)
    values = np.cos(3.0 * theta) + 0.3 * np.sin(7.0 * theta) + 0.05 * np.cos(20.0 * theta)
    spline = periodic_quintic(values)
    known = spline.derivatives(theta, 4)
    for many in (knot_derivatives(values, 4), knot_derivatives([values, values], 4)[:, 1]):
        for mine, other in zip(many, known, strict=True):
            np.testing.assert_allclose(mine, other, rtol=0.0, atol=1e-11 * np.abs(other).max())
    whole, _ = spline.antiderivative()
    np.testing.assert_allclose(knot_integrals(values), whole(theta), rtol=0.0, atol=1e-14)


def test_the_tables_of_the_guides_agree_with_their_solution() -> None:
    """Linear between nodes: 2 % of the rubbing load under a roller, the same at a node.

    4 % under a face, whose force also bends the stem by its couple beside the stem axis.
    """
    case = read_case(CASES / "gx120.toml")
    state = machine(case, case.load_cases[0])
    draw = np.random.default_rng(3)
    force, overhang = 10.0 ** draw.uniform(0.0, 3.5, 60), draw.uniform(0.03, 0.06, 60)
    for side, arm, share in (
        (np.ones(60), np.zeros(60), 0.02),
        (np.full(60, 0.05), draw.uniform(-0.02, 0.02, 60), 0.04),
        (np.zeros(60), draw.uniform(-0.02, 0.02, 60), 0.04),
    ):
        solved = guide_reactions(side * force, overhang, state.stem, state.guides, arm * force)
        push = Push(side, arm, np.full(60, state.guides.spacing))
        support = SupportOfMany.of(state.stem, state.guides, push, overhang)
        loads = support.loads(force)
        size = force * push.side_factor
        rubbing = [size * each for each in support.rubbing(force)]
        for mine, other in (
            (loads.rubbing_a, solved.rubbing_load_a),
            (loads.rubbing_b, solved.rubbing_load_b),
            (rubbing[0], solved.rubbing_load_a),
            (rubbing[1], solved.rubbing_load_b),
            (loads.net_a, np.abs(solved.reaction_a)),
        ):
            scale = np.maximum(size, other)
            assert np.abs(mine - other).max() <= share * scale.max()
            np.testing.assert_allclose(mine, other, rtol=share, atol=share * np.median(scale))


def test_guide_loads_do_not_depend_on_the_places_solved_before() -> None:
    """A node is solved in the same group, whichever place needs it first."""
    case = read_case(CASES / "gx120.toml")
    state = machine(case, case.load_cases[0])
    steps, spacing, load = (9.1, 11.7, 12.4), 0.9 * state.guides.spacing, np.geomspace(1.0, 3e3, 7)
    rising, falling = (OverhangTable(state.stem, state.guides) for _ in range(2))
    for each in steps[::-1]:
        falling.between(np.full(7, each), spacing)
    for each in steps:
        first, last = (
            table.ratios(load, table.between(np.full(7, each), spacing))
            for table in (rising, falling)
        )
        np.testing.assert_array_equal(first, last)
