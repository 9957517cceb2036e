"""Each check of the guides, recomputed from a solved cam by an independent formulation."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from pin_in_hole_elements import half_annulus, pin_in_hole_by_elements
from run_recomputed import convergence_index
from scipy.integrate import quad, solve_bvp
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, LinearForm
from skfem.helpers import ddot, eye, sym_grad, trace
from skfem.utils import condense, solve
from stated_loads import stated_loads

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.material import Material, StrengthAt
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.case.toml_text import tables_of
from camwright.pipeline.checks import guide_strength, guide_wear, jump_and_jamming
from camwright.pipeline.checks.check import Check, Declaration
from camwright.pipeline.checks.error_bars import GUIDE_EDGE_ERROR, with_error_bars
from camwright.pipeline.checks.registry import CHECKS, checks_of
from camwright.pipeline.checks.solution_verification import mesh_reaction
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.part_loads import guide_bodies
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.guide_friction import (
    bore_closure,
    bush_temperature,
    thermal_resistance,
)
from camwright.pipeline.follower.guide_reactions import (
    Guide,
    guide_reactions,
    lobatto,
    mean_line_load,
)

EVERY_PART = Path(__file__).parents[1] / "data" / "every_part.toml"
JAM = ("jam_index", "jam_index_friction_max")
SIDES = ("a", "b")


def tight() -> Case:
    """Stiff springs; A a bronze bush with little clearance, B one of nylon."""
    case = read_case(EVERY_PART)
    bronze = replace(
        case.materials["bronze"],
        expansion=1.8e-5, conductivity=60.0, temperature_limit=423.15,
    )  # fmt: skip
    guides = case.guides
    a = replace(
        guides.a,
        material=bronze, clearance=2e-5, length=0.03, wall=0.0015,
        pressure_limit=60e6, housing_resistance=20.0,
    )  # fmt: skip
    parts = {
        "guides": replace(guides, a=a, b=replace(guides.b, clearance=1e-4)),
        "spring": replace(case.spring, rate=6e4, preload=900.0),
    }
    return case.model_copy(update=parts)


def solved_of(case: Case) -> Solution:
    """A harmonic lift of 10 mm, solved by closed forms."""
    theta = uniform_turn(72)
    lift = Lift(theta, 0.005 * (1.0 - np.cos(theta)))
    contour = RollerContour(PitchCurve(lift, case.cam.prime_radius), case.roller.radius)
    return stated_loads(case, contour, 72)


@pytest.fixture(scope="module")
def solved() -> Solution:
    return solved_of(tight())


@pytest.fixture(scope="module")
def checks(solved: Solution) -> Mapping[str, Check]:
    return {each.id: each for each in checks_of(solved)}


def place(solved: Solution, check: Check) -> tuple[Cycle, int]:
    """Cycle and position of a demand."""
    cycle = next(each for each in solved.cycles if each.load_case == check.load_case)
    return cycle, int(np.argmin(np.abs(cycle.theta - (check.cam_angle or 0.0))))


def line_loads(cycle: Cycle, side: str) -> np.ndarray:
    return np.asarray(getattr(cycle.guides, f"line_pressure_{side}"))


def both_pushes(cycle: Cycle, side: str) -> np.ndarray:
    """Sum of the pushes on both sides, N, (n,): trapezoids between 97 knots of the guide."""
    machine, loads = cycle.machine, cycle.loads
    fine = guide_reactions(
        loads.tangential_force, loads.overhang, machine.stem, machine.guides,
        loads.end_moment, knots=97,
    )  # fmt: skip
    line, along = getattr(fine, f"line_pressure_{side}"), getattr(fine, f"knots_{side}")
    return np.asarray(np.trapezoid(np.abs(line), along, axis=0))


def friction_power(cycle: Cycle, side: str) -> float:
    """Mean over a turn per coefficient of friction: pushes over the path, times turns per second.

    W.
    """
    load = both_pushes(cycle, side)
    path = np.abs(np.roll(cycle.loads.lift, -1) - cycle.loads.lift)
    work = 0.5 * (load + np.roll(load, -1)) @ path
    return float(work * cycle.machine.cam_speed / (2.0 * np.pi))


# --- pressure --------------------------------------------------------------------------------


def beam_in_bores(cycle: Cycle, k: int) -> dict[str, list[tuple[float, float]]]:
    """Push, N, and loaded length, m, of both sides of each guide, by collocation.

    EI w'''' = -q(w) in guide A, between the guides and in guide B, with the bores as springs
    beyond half the clearance. Force and moment of the overhang act on the outer edge of A; the far
    edge of B is free.
    """
    machine, loads = cycle.machine, cycle.loads
    a, b, stem = machine.guides.a, machine.guides.b, machine.stem
    stiffness = stem.elastic_modulus * np.pi / 64.0 * stem.diameter**4
    gap = machine.guides.spacing - 0.5 * (a.length + b.length)
    force = loads.tangential_force[k]
    moment = loads.end_moment[k] - force * (loads.overhang[k] - 0.5 * a.length)

    def bore(guide: Guide, w: np.ndarray) -> np.ndarray:
        depth = np.maximum(np.abs(w) - 0.5 * guide.clearance, 0.0)
        return np.asarray(guide.foundation_modulus * np.sign(w) * depth)

    def slopes(_: np.ndarray, y: np.ndarray) -> np.ndarray:
        pressed = (bore(a, y[0]), np.zeros_like(y[0]), bore(b, y[8]))
        parts = [
            length * np.vstack([y[i + 1], y[i + 2] / stiffness, y[i + 3], -q])
            for i, length, q in zip((0, 4, 8), (a.length, gap, b.length), pressed, strict=True)
        ]
        return np.vstack(parts)

    def ends(near: np.ndarray, far: np.ndarray) -> np.ndarray:
        outer = [near[2] + moment, near[3] - force, far[10], far[11]]
        return np.r_[outer, far[:8] - near[4:]]

    t = np.linspace(0.0, 1.0, 60)
    y = np.zeros((12, t.size))
    y[0], y[8] = 1e-5 * np.sign(force), -5e-5 * np.sign(force)
    y[4] = np.sign(force) * np.interp(t, [0.0, 1.0], [1e-5, -5e-5])
    result = solve_bvp(slopes, ends, t, y, tol=1e-3, max_nodes=4000)
    assert result.success, result.message
    pushes = {}
    for side, guide, row in (("a", a, 0), ("b", b, 8)):
        at = np.linspace(0.0, 1.0, 20001)
        q, step = bore(guide, result.sol(at)[row]), guide.length * (at[1] - at[0])
        pushes[side] = []
        for pushed in (np.maximum(q, 0.0), np.maximum(-q, 0.0)):
            length = float(np.count_nonzero(pushed)) * step
            pushes[side].append((float(np.trapezoid(pushed, dx=step)), length))
    net = sum(sides[0][0] - sides[1][0] for sides in pushes.values())
    assert net == pytest.approx(force, rel=1e-3)
    return pushes


@pytest.mark.parametrize("side", SIDES)
def test_pressure_is_that_of_the_push_on_one_side(solved, checks, side) -> None:
    check = checks[f"guide_pressure_{side.upper()}"]
    cycle, k = place(solved, check)
    guide = getattr(solved.machine.guides, side)
    sides = [each for each in beam_in_bores(cycle, k)[side] if each[1] > 0.0]
    pressures = [push / (length * guide.diameter) for push, length in sides]
    # 25 knots in a guide hold the loaded length to 3 %.
    assert check.demand == pytest.approx(max(pressures), rel=0.03)
    net = abs(getattr(cycle.guides, f"reaction_{side}")[k]) / guide.projected_area
    assert check.demand > 5.0 * net


def test_opposite_pushes_of_a_guide_do_not_cancel(solved) -> None:
    """Bronze with little clearance: 182 N and 68 N at its ends, 114 N of reaction."""
    cycle = solved.cycles[0]
    k = int(np.argmax(cycle.guides.bearing_load_a))
    (low, _), (high, _) = sorted(beam_in_bores(cycle, k)["a"])
    reaction = abs(cycle.guides.reaction_a[k])
    assert high - low == pytest.approx(reaction, rel=1e-3)
    assert min(low, high) > 0.5 * reaction
    assert cycle.guides.bearing_load_a[k] > 1.5 * reaction
    push, length = cycle.guides.loaded_side(0, k)  # of the greater mean line load
    whole = np.ptp(cycle.guides.knots_a)
    assert push == pytest.approx(high, rel=1e-3) and 0.0 < length < whole
    assert push / length * whole == pytest.approx(cycle.guides.bearing_load_a[k])


def test_mean_line_load_of_straight_lines() -> None:
    """Uniform, on one half, and 1728 N against 783 N at the two ends of a guide of 40 mm."""
    unit, _ = lobatto(25)
    knots = 0.02 * unit
    uniform, half = np.full((25, 1), -3e3), np.maximum(2e5 * knots, 0.0)[:, None]
    assert mean_line_load(uniform, knots) == pytest.approx(3e3)
    assert mean_line_load(half, knots) == pytest.approx(2e3, rel=0.01)
    # Zero at 23.9 mm from one end: areas in the ratio of the squares of the lengths.
    zero = 0.04 * np.sqrt(1728.0) / (np.sqrt(1728.0) + np.sqrt(783.0))
    slope = 2.0 * 1728.0 / zero**2
    crossed = (slope * (zero - (knots + 0.02)))[:, None]
    assert mean_line_load(crossed, knots) == pytest.approx(1728.0 / zero, rel=0.01)
    assert mean_line_load(np.zeros((25, 1)), knots) == 0.0
    assert np.isnan(mean_line_load(np.full((25, 1), np.nan), knots))


@pytest.mark.parametrize("side", ["b", pytest.param("a", marks=pytest.mark.slow)])
def test_edge_pressure_is_that_of_finite_elements(solved, checks, side) -> None:
    check = checks[f"guide_edge_pressure_{side.upper()}"]
    cycle, k = place(solved, check)
    guide, radius = getattr(solved.machine.guides, side), 0.5 * solved.machine.stem.diameter
    load = np.abs(line_loads(cycle, side)[:, k]).max()
    pin, bush = guide_bodies(solved.machine, guide)
    clearance = 0.5 * guide.clearance / radius
    _, pressures = pin_in_hole_by_elements(
        load / radius, clearance, pin, bush, np.radians(60.0), knots=16
    )
    assert check.demand == pytest.approx(float(pressures.pressure[0].max()), rel=0.03)


def test_a_softer_bush_has_lower_pressures() -> None:
    """The modulus at 20 degC is an upper bound of those of a warm bush."""
    case = read_case(EVERY_PART)

    def pressures(modulus: float) -> tuple[float, float]:
        nylon = replace(case.guides.a.material, E=modulus)
        pair = replace(
            case.guides,
            a=replace(case.guides.a, material=nylon),
            b=replace(case.guides.b, material=nylon),
        )
        cycle = solved_of(case.model_copy(update={"guides": pair})).cycles[0]
        return float(cycle.guides.bearing_load_a.max()), float(
            cycle.parts.guide_edge_pressure_a.max()
        )

    stiff, soft = pressures(2.8e9), pressures(1.4e9)
    assert soft[0] < stiff[0]
    assert soft[1] < stiff[1]


# --- sliding ---------------------------------------------------------------------------------


@pytest.mark.parametrize("side", SIDES)
def test_pv_and_wear_by_work_over_the_stroke(solved, checks, side) -> None:
    """Mean of |R v| is the integral of R over the path of a turn, times the turns per second."""
    guide, worst = getattr(solved.machine.guides, side), 0.0
    for cycle in solved.cycles:
        worst = max(worst, friction_power(cycle, side))
    pv = worst / (guide.diameter * guide.length)
    assert checks[f"guide_pv_{side.upper()}"].demand == pytest.approx(pv, rel=0.02)
    life = solved.case.limits.target_life
    volume = guide.wear_rate * worst * life
    depth = volume / (guide.diameter * guide.length)
    assert checks[f"guide_wear_{side.upper()}"].demand == pytest.approx(depth, rel=0.02)


@pytest.mark.parametrize("side", ["A", "B"])
def test_speed_by_differences_of_the_lift(solved, checks, side) -> None:
    fastest = max(
        float(np.abs(np.diff(cycle.loads.lift) / np.diff(cycle.theta)).max())
        * cycle.machine.cam_speed
        for cycle in solved.cycles
    )
    assert checks[f"guide_speed_{side}"].demand == pytest.approx(fastest, rel=2e-3)


def test_jam_indices_by_collocation(solved, checks) -> None:
    """Pushes of the beam in its bores, times friction, over the axial force."""
    friction, guides = solved.machine.friction, solved.case.guides
    for name, (mu_a, mu_b) in zip(JAM, (friction.nominal, friction.greatest), strict=True):
        check = checks[name]
        pair = replace(
            guides,
            a=replace(guides.a, friction=mu_a, friction_max=mu_a),
            b=replace(guides.b, friction=mu_b, friction_max=mu_b),
        )
        cycle, k = place(solved_of(solved.case.model_copy(update={"guides": pair})), check)
        pushes = {
            side: sum(push for push, _ in both) for side, both in beam_in_bores(cycle, k).items()
        }
        drag, loads = mu_a * pushes["a"] + mu_b * pushes["b"], cycle.loads
        free = loads.spring_force[k] + loads.inertia_force[k]
        assert check.demand == pytest.approx(drag / (free + drag), rel=2e-3), name


def test_uncertainty_of_the_reaction_covers_its_error_by_collocation(solved) -> None:
    """Index of three numbers of knots by Roache; the error against the beam by collocation."""
    demand = mesh_reaction.demand(solved)
    assert demand is not None
    check = mesh_reaction.judged(solved.machine, demand)
    assert check.demand is not None
    cycle, k = place(solved, check)
    machine, loads = cycle.machine, cycle.loads
    assert np.abs(cycle.guides.reaction_a[k]) == max(
        np.abs(each.guides.reaction_a).max() for each in solved.cycles
    )
    values = [
        guide_reactions(
            loads.tangential_force[[k]], loads.overhang[[k]], machine.stem, machine.guides, knots=n
        ).reaction_a[0]
        for n in (7, 13, 25)
    ]
    assert check.demand == pytest.approx(0.01 * convergence_index(*values)[0], rel=1e-6)
    pushed, other = beam_in_bores(cycle, k)["a"]
    exact = abs(pushed[0] - other[0])
    # the collocation has an error of 1e-3 of its own
    assert abs(abs(values[2]) / exact - 1.0) <= check.demand + 1e-3


def test_guided_length_by_hand(checks) -> None:
    """Middles 80 mm apart, 30 and 20 mm long; 30 mm of overhang at full lift and 40 at none."""
    assert checks["guide_length"].demand == pytest.approx((80.0 + 15.0 + 10.0) / 40.0)


# --- temperature -----------------------------------------------------------------------------


def resistance(guide: Guide) -> float:
    """Radial conduction by quadrature, and the housing, K/W."""
    lamda, bore = guide.material.conductivity, 0.5 * guide.diameter

    def shell(radius: float) -> float:
        return 1.0 / (lamda * 2.0 * np.pi * radius * guide.length)

    return float(quad(shell, bore, bore + guide.wall)[0]) + guide.housing_resistance


@pytest.mark.parametrize("side", SIDES)
def test_temperature_is_that_of_the_heat_at_the_greatest_friction(solved, checks, side) -> None:
    """The case solved with its greatest friction as the nominal one."""
    guides = solved.case.guides
    a, b = (replace(guide, friction=guide.friction_max) for _, guide in guides.both)
    rough = solved_of(solved.case.model_copy(update={"guides": replace(guides, a=a, b=b)}))
    guide, hottest = getattr(guides, side), 0.0
    for cycle in rough.cycles:
        heat = guide.friction_max * friction_power(cycle, side)
        hottest = max(hottest, heat * resistance(guide))
    demand = checks[f"guide_temperature_{side.upper()}"].demand
    around = solved.case.guides.ambient_temperature - 273.15
    assert demand - around == pytest.approx(hottest, rel=0.02)


def test_heat_of_a_bush_raises_its_housing() -> None:
    """43.2 W through 5 K/W of housing at 20 degC ambient: 236 degC, and the drop in the wall."""
    case = tight()
    guide = replace(case.guides.a, housing_resistance=5.0)
    hot = bush_temperature(43.2, thermal_resistance(guide), 293.15)
    wall = 43.2 * np.log(13.0 / 10.0) / (2.0 * np.pi * 60.0 * 0.03)
    assert hot - 273.15 == pytest.approx(236.0 + wall, abs=1e-6)


@pytest.mark.parametrize("field", ["wall", "housing_resistance"])
def test_a_total_resistance_replaces_wall_and_housing(field) -> None:
    bare = replace(tight().guides.a, **{field: None})
    assert thermal_resistance(bare) is None
    assert thermal_resistance(replace(bare, thermal_resistance=7.0)) == 7.0


# --- growth ----------------------------------------------------------------------------------


def closure_by_elements(wall_share: float, nu: float, *, held: bool) -> float:
    """Closure of a bore over bore and free strain, of a quarter of a ring by quadratic quads.

    Outer circle clamped along the radius by clamping it whole: it turns nowhere by symmetry.
    """
    modulus, outer = 1.0, 1.0 + 2.0 * wall_share
    mesh = half_annulus(np.linspace(0.0, 0.5 * np.pi, 13), 1.0, outer, 8)
    basis = Basis(mesh, ElementVector(ElementQuad2()), intorder=4)
    shear = modulus / (2.0 * (1.0 + nu))
    first = modulus * nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    if not held:
        first = 2.0 * first * shear / (first + 2.0 * shear)
    # Stress of a suppressed unit strain: 3 K held along the axis, E/(1 - nu) in plane stress.
    blocked = modulus / (1.0 - 2.0 * nu) if held else modulus / (1.0 - nu)

    @BilinearForm
    def stiffness(u, v, _):
        strain = sym_grad(u)
        return ddot(2.0 * shear * strain + first * eye(trace(strain), 2), sym_grad(v))

    @LinearForm
    def swelling(v, _):
        return blocked * trace(sym_grad(v))

    ends = mesh.facets_satisfying(lambda x: np.abs(x[1]) < 1e-9)
    radii = np.hypot(*mesh.p)[mesh.facets]
    outside = np.flatnonzero((np.abs(radii - outer) < 1e-9).all(axis=0))
    fixed = np.union1d(basis.get_dofs(outside).all(), basis.get_dofs(ends).all(["u^2"]))
    shift = solve(*condense(stiffness.assemble(basis), swelling.assemble(basis), D=fixed))
    bore = np.flatnonzero(np.abs(np.hypot(*basis.doflocs) - 1.0) < 1e-9)
    along = bore[np.isin(bore, basis.get_dofs(ends).all(["u^1"]))]
    inward = [-shift[dof] * np.sign(basis.doflocs[0, dof]) for dof in along]
    return float(np.mean(inward))


@pytest.mark.parametrize(("wall_share", "nu"), [(0.25, 0.4), (0.1, 0.34)])
def test_closure_of_a_held_bush_is_that_of_finite_elements(wall_share, nu) -> None:
    free, held = bore_closure(wall_share, nu)
    assert free == pytest.approx(closure_by_elements(wall_share, nu, held=False), rel=2e-3)
    assert held == pytest.approx(closure_by_elements(wall_share, nu, held=True), rel=2e-3)


def test_closure_of_nylon_is_from_064_to_121() -> None:
    assert bore_closure(0.25, 0.4) == pytest.approx((0.64, 1.21), abs=0.005)
    for wall_share, nu in ((0.0, 0.3), (0.2, 0.5), (np.nan, 0.3), (0.2, np.nan)):
        with pytest.raises(InputError):
            bore_closure(wall_share, nu)


@pytest.mark.parametrize("side", SIDES)
def test_growth_of_bush_and_stem(solved, checks, side) -> None:
    """Closure by finite elements, at the temperature of the guide."""
    guide = getattr(solved.machine.guides, side)
    bush, stem = guide.material, solved.case.follower.stem_material
    warmer = checks[f"guide_temperature_{side.upper()}"].demand - 20.0
    strain = bush.expansion * warmer + (bush.swelling or 0.0)
    closure = closure_by_elements(guide.wall / guide.diameter, bush.nu, held=True)
    growth = guide.diameter * (closure * strain + stem.expansion * warmer)
    assert checks[f"guide_expansion_{side.upper()}"].demand == pytest.approx(growth, rel=2e-3)


# --- strength at temperature -----------------------------------------------------------------


def card(**values) -> Material:
    plain = replace(tight().guides.b.material, strength_at=())
    return replace(plain, **values)


def test_strength_by_temperature() -> None:
    warm = (StrengthAt(temperature=333.15, yield_strength=40e6),
            StrengthAt(temperature=373.15, yield_strength=10e6))  # fmt: skip
    graded = card(strength_at=warm)
    for celsius, strength in ((-20, 60), (20, 60), (30, 55), (60, 40), (80, 25), (100, 10)):
        assert graded.yield_strength_at(celsius + 273.15) == pytest.approx(1e6 * strength)
    assert np.isnan(graded.yield_strength_at(373.16))
    assert np.isnan(graded.yield_strength_at(np.nan))
    with pytest.raises(InputError, match="strength_at"):
        card(strength_at=warm[::-1])


def test_strength_holds_to_30_degrees_of_a_plastic_and_to_100_of_a_metal() -> None:
    plastic, metal = card(), card(E=60e9)
    assert plastic.yield_strength_at(303.15) == metal.yield_strength_at(373.15) == 60e6
    assert np.isnan(plastic.yield_strength_at(303.2))
    assert np.isnan(metal.yield_strength_at(373.2))
    assert metal.holds_to == 353.15  # its limit
    plastic, metal = (replace(each, temperature_limit=None) for each in (plastic, metal))
    assert (plastic.holds_to, metal.holds_to) == (303.15, 373.15)
    warm = [StrengthAt(temperature=each, yield_strength=60e6) for each in (373.15, 473.15)]
    less = StrengthAt(temperature=573.15, yield_strength=50e6)
    assert replace(metal, strength_at=(*warm, less)).holds_to == 473.15
    assert replace(metal, strength_at=(less,)).holds_to == 293.15
    assert (card(swelling=None).moisture_growth, card(E=60e9, swelling=None).moisture_growth) == (
        None,
        0.0,
    )


def test_pressure_limit_falls_with_the_strength() -> None:
    warm = card(strength_at=(StrengthAt(temperature=373.15, yield_strength=20e6),))
    guide = replace(tight().guides.b, material=warm, pressure_limit=5.5e6)
    assert guide.pressure_limit_at(333.15) == pytest.approx(5.5e6 * 40.0 / 60.0)
    assert guide.pressure_limit_at(280.0) == 5.5e6
    stated = replace(guide, pressure_limit_temperature=333.15)
    assert stated.pressure_limit_at(333.15) == 5.5e6
    assert stated.pressure_limit_at(353.15) == pytest.approx(5.5e6 * 30.0 / 40.0)
    assert np.isnan(guide.pressure_limit_at(400.0))
    assert np.isnan(guide.pressure_limit_at(np.nan))
    assert replace(guide, pressure_limit=None).pressure_limit_at(300.0) is None


def heated(**values) -> Solution:
    """Nylon in guide B at about 70 degC."""
    case = tight()
    nylon = replace(case.guides.b.material, **values)
    b = replace(case.guides.b, material=nylon, housing_resistance=300.0)
    return solved_of(case.model_copy(update={"guides": replace(case.guides, b=b)}))


def test_limits_are_those_at_the_temperature() -> None:
    solved = heated()
    celsius = guide_strength.guide_temperature_b(solved).demand
    assert 40.0 < celsius < 100.0
    share = (celsius - 20.0) / 80.0
    strength = 60e6 * (1.0 - share) + 40e6 * share
    edge, mean = (
        check(solved)
        for check in (guide_strength.guide_edge_pressure_b, guide_strength.guide_pressure_b)
    )
    assert edge.limit == pytest.approx(strength, rel=1e-9)
    assert mean.limit == pytest.approx(5e6 * strength / 60e6, rel=1e-9)


def test_a_strength_that_ends_below_the_temperature_is_missing() -> None:
    bare = heated(strength_at=())
    for declared in (guide_strength.guide_edge_pressure_b, guide_strength.guide_pressure_b):
        check = declared(bare)
        assert check.status == "not_evaluated"
        assert check.missing == ("materials.nylon.strength_at",)
        assert "the strength of nylon ends below" in check.note
    weak = heated(strength_at=(), yield_strength=0.5e6)
    assert guide_strength.guide_edge_pressure_b(weak).status == "fail"


def test_without_a_temperature_the_limit_is_that_at_20_degrees_and_the_temperature_blocks() -> None:
    case = tight()
    b = replace(case.guides.b, housing_resistance=None)
    solved = solved_of(case.model_copy(update={"guides": replace(case.guides, b=b)}))
    mean = guide_strength.guide_pressure_b(solved)
    assert (mean.limit, mean.status) == (b.pressure_limit, "pass")
    assert "the temperature of the guide is not known" in mean.note
    assert guide_strength.guide_temperature_b(solved).blocks


# --- data ------------------------------------------------------------------------------------


def of_guides() -> list[Declaration]:
    return [each for each in CHECKS if each.part == "guides"]


def test_both_guides_have_every_check() -> None:
    names = {each.id for each in of_guides()}
    expected = {"guide_length", "anti_rotation", *JAM}
    for name in ("pressure", "pv", "edge_pressure", "temperature", "speed", "expansion", "wear"):
        expected |= {f"guide_{name}_A", f"guide_{name}_B"}
    assert expected <= names


DATA = {
    ("guides", "ambient_temperature"): ("guide_temperature_A", "guide_expansion_A"),
    ("guides.a", "wall"): ("guide_temperature_A", "guide_expansion_A"),
    ("guides.a", "housing_resistance"): ("guide_temperature_A", "guide_expansion_A"),
    ("guides.a", "pressure_limit"): ("guide_pressure_A",),
    ("guides.a", "pv_limit"): ("guide_pv_A",),
    ("guides.a", "speed_limit"): ("guide_speed_A",),
    ("guides.b", "wear_rate"): ("guide_wear_B",),
    ("follower", "anti_rotation"): ("anti_rotation",),
    ("materials.bronze", "expansion"): ("guide_expansion_A",),
    ("materials.bronze", "conductivity"): ("guide_temperature_A", "guide_expansion_A"),
    ("materials.bronze", "temperature_limit"): ("guide_temperature_A",),
    ("materials.nylon", "swelling"): ("guide_expansion_B",),
    ("materials.steel", "expansion"): ("guide_expansion_A", "guide_expansion_B"),
}  # fmt: skip
DECLARED = {
    each.id: each
    for module in (guide_strength, jump_and_jamming, guide_wear)
    for each in vars(module).values()
    if isinstance(each, Declaration)
}


@pytest.fixture(scope="module")
def tables() -> dict:
    case = tight()
    bronze = case.guides.a.material
    return tables_of(case.model_copy(update={"materials": case.materials | {"bronze": bronze}}))


@pytest.mark.parametrize(("table", "key"), DATA)
def test_a_missing_datum_is_a_row_that_blocks(tables, table, key) -> None:
    whole = {name: dict(value) if isinstance(value, dict) else value
             for name, value in tables.items()}  # fmt: skip
    within = whole
    for name in table.split("."):
        within[name] = dict(within[name])
        within = within[name]
    del within[key]
    bare = solved_of(case_of(whole))
    for name in DATA[table, key]:
        check = DECLARED[name](bare)
        assert check is not None
        assert check.status == "not_evaluated", name
        assert check.blocks
        assert check.missing == (f"{table}.{key}",)


def test_a_roller_needs_a_means_against_rotation() -> None:
    case = tight()
    for means, status in (("flat", "pass"), ("not_needed", "fail"), (None, "not_evaluated")):
        follower = case.follower.model_copy(update={"anti_rotation": means})
        solved = solved_of(case.model_copy(update={"follower": follower}))
        assert guide_strength.anti_rotation(solved).status == status


def test_error_of_loaded_length_and_line_load_is_within_its_bar() -> None:
    """25 knots against 97, at the greatest of some loads on nylon and on bronze."""
    case, random = tight(), np.random.default_rng(3)
    stem, guides = replace(machines(case)[0].stem, length=np.inf), case.guides
    for number in range(6):
        material = (guides.b if number % 2 else guides.a).material
        gap, length = random.choice([2e-5, 1e-4]), 0.01 * random.uniform(1.5, 4.0)
        a, b = (
            replace(guide, material=material, length=length, wall=None, clearance=gap)
            for _, guide in guides.both
        )
        force, reach = random.uniform(100.0, 1000.0, 4), random.uniform(0.03, 0.05, 4)
        pair = replace(guides, a=a, b=b)
        plain, fine = (guide_reactions(force, reach, stem, pair, knots=n) for n in (25, 97))
        for name in ("bearing_load_a", "line_pressure_max_a", "bearing_load_b"):
            exact = getattr(fine, name).max()
            assert getattr(plain, name).max() > (1.0 - GUIDE_EDGE_ERROR) * exact, name


def test_error_bar_of_an_edge_includes_that_of_its_mesh(solved) -> None:
    made = [declared(solved) for declared in (guide_strength.guide_pressure_a,
                                              guide_strength.guide_pv_a)]  # fmt: skip
    mesh = replace(made[1], demand=0.01, declaration=mesh_reaction)
    pressure, pv, _ = with_error_bars(solved, [*made, mesh])
    assert pv.error_share == pytest.approx(0.01 + made[1].error_share, rel=1e-6)
    sampled = made[0].error_share
    assert pressure.error_share == pytest.approx(0.01 + GUIDE_EDGE_ERROR + sampled, rel=1e-6)
