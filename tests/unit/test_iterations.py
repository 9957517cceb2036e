"""No iteration ends in silence: one that does not settle raises, or is told in another way."""

import ast
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from camwright.pipeline.contact.traction import Drag, rolling_contact

ROOT = Path(__file__).parents[2]
FOLDERS = ("geometry", "meshes", "pipeline", "reports", "validation")
TOLD = {
    "geometry/cam_size.py: _by_angle": "bisection, ended where its bracket cannot shrink",
    "geometry/interference.py: _polished": "crossings that do not settle are left out",
    "pipeline/base/crossing.py: first_passing": "bisection by the halvings of its caller",
    "pipeline/contact/elasticity/active_set.py: _together": "the rest is solved one by one",
    "pipeline/contact/elasticity/fitted_stress.py: greatest_fitted": "None: the caller says so",
    "pipeline/contact/finite_length/factor_table.py: _solved": "the last attempt raises",
    "pipeline/contact/hub_elements.py: _settled": "None: the caller takes the least energy",
    "pipeline/follower/crossover.py: lands": "the end of its bracket, beyond the wall",
    "pipeline/screening/live_preview.py: _in_range": "a preview without factors",
    "pipeline/screening/live_preview.py: with_torques": "without a range of speeds",
    "pipeline/screening/screened_cam.py: _pressed_at": "NaN of what has not settled",
    "pipeline/search/crown/least_crown.py: within": "its lowest ratio, which is judged",
    "pipeline/search/machine/synthesised_points.py: promising": "a count of designs",
    "pipeline/search/parts/part_search.py: searched": "a count of limits",
    "pipeline/search/parts/redesign_study.py: _fronts_judged": "a count of fronts",
    "pipeline/search/remedies/remedy_search.py: _confirmed": "the best attempt, judged anew",
    "pipeline/search/sizes/sizing.py: _stiffened": "the first attempt, whose checks are shown",
    "pipeline/search/sizes/sizing.py: sized": "the last attempt, whose checks are shown",
    "pipeline/smoothing/constrained_synthesis.py: synthesise": "synthesis_converged judges it",
    "pipeline/studies/batch/solver_process.py: _row": "a row that says so",
}
"""Functions whose loop may end without a raise, and how they tell it."""


COUNTED = {
    "geometry/arm_size.py: _sampled_least": "bisection",
    "geometry/arm_size.py: least_base_radius": "bisection",
    "geometry/arm_size.py: least_prime_radius": "bisection",
    "geometry/extrema.py: least_argument": "golden section",
    "geometry/extrema.py: refined": "zooms of its caller",
    "geometry/interference.py: second_contact": "zooms",
    "pipeline/base/files.py: _is_deeper": "a count of levels",
    "pipeline/base/worker_processes.py: prepare": "a count of workers",
    "pipeline/contact/elasticity/plane_stress_measures.py: _summit": "one is where it has settled",
    "pipeline/contact/finite_length/contact_span.py: _span": "a first extent, which cells widen",
    "pipeline/contact/finite_length/pressure_cells.py: _steps": "bisection, then scaled",
    "pipeline/contact/full_contact.py: _with_elliptic_edges": "the overlap beside judges it",
    "pipeline/engine/indicated_cycle_solver.py: _one_cycle": "a count of steps",
    "pipeline/engine/speed_trace.py: with_firing": "votes of the cycles",
    "pipeline/follower/camshaft_loads.py: counter_hole": "section of a bracket",
    "pipeline/follower/pivot_bush.py: _between_edges": "bisection",
    "pipeline/follower/spring_link.py: reach": "section of a bracket",
    "pipeline/smoothing/energy_spline.py: lowest": "value of a minimum, of second order",
    "pipeline/smoothing/energy_spline.py: reversals": "quadratic, within a step of the samples",
    "pipeline/smoothing/infeasibility.py: _smallest": "bisection",
    "pipeline/smoothing/sampled_problem.py: _peaks": "value of a maximum, of second order",
    "pipeline/studies/batch/task_scheduler.py: _completed": "a count of tasks",
    "validation/figures_2024_mechanisms.py: _friction": "a count of experiments",
    "validation/speed_reconstruction.py: _differences": "order of the differences",
}
"""Functions with a loop of a count that runs to its end, and why that is enough."""


def counted(text: str) -> Iterator[str]:
    """Names of functions with a loop of a count that nothing ends before."""
    for function in ast.walk(ast.parse(text)):
        if isinstance(function, ast.FunctionDef):
            for node in ast.walk(function):
                early = (ast.Break, ast.Return, ast.Raise)
                if isinstance(node, ast.For) and is_count(node) and not has([node], early):
                    yield function.name


def blocks(tree: ast.AST) -> Iterator[list[ast.stmt]]:
    for node in ast.walk(tree):
        for name in ("body", "orelse", "finalbody"):
            block = getattr(node, name, None)
            if isinstance(block, list):
                yield block


def has(nodes: list[ast.stmt], kinds: type[ast.stmt] | tuple[type[ast.stmt], ...]) -> bool:
    return any(isinstance(each, kinds) for node in nodes for each in ast.walk(node))


def is_count(node: ast.stmt) -> bool:
    """Whether a statement is ``for _ in range(...)``."""
    return (
        isinstance(node, ast.For)
        and isinstance(node.target, ast.Name)
        and node.target.id == "_"
        and isinstance(node.iter, ast.Call)
        and isinstance(node.iter.func, ast.Name)
        and node.iter.func.id == "range"
    )


def silent(text: str) -> Iterator[str]:
    """Names of functions with a loop of a count that may end early, and ends in silence else."""
    for function in ast.walk(ast.parse(text)):
        if not isinstance(function, ast.FunctionDef):
            continue
        for block in blocks(function):
            for k, node in enumerate(block):
                if not is_count(node) or not has([node], (ast.Break, ast.Return)):
                    continue
                assert isinstance(node, ast.For)
                if not has([*node.orelse, *block[k + 1 :]], ast.Raise):
                    yield function.name


@pytest.mark.parametrize(("names", "told"), [(silent, TOLD), (counted, COUNTED)])
def test_an_iteration_that_does_not_settle_says_so(
    names: Callable[[str], Iterator[str]], told: dict[str, str]
) -> None:
    """A new loop raises after its last step, or has its reason above; a mended one leaves it."""
    loops = {
        f"{path.relative_to(ROOT).as_posix()}: {name}"
        for folder in FOLDERS
        for path in sorted((ROOT / folder).rglob("*.py"))
        if "for _ in range(" in (text := path.read_text(encoding="utf-8"))
        for name in names(text)
    }
    assert loops == set(told)


def test_the_syntax_tree_sees_a_silent_end() -> None:
    loop = "def solved(x):\n    for _ in range(9):\n        x = x / 2\n        if x < 1:\n"
    assert [*silent(f"{loop}            break\n    return x\n")] == ["solved"]
    assert [*silent(f"{loop}            return x\n    raise ValueError\n")] == []
    assert [*silent(f"{loop}            break\n    else:\n        raise ValueError\n")] == []


def heavy(inertia: float, count: int = 360) -> tuple[np.ndarray, ...]:
    """Force, spin and its rate of a roller that leaves its cam for half of the turn."""
    theta = 2.0 * np.pi * np.arange(count) / count
    force = np.maximum(200.0 * np.sin(theta), 0.0)
    spin = 300.0 + 120.0 * np.cos(theta)
    return theta, force, spin, -120.0 * 10.0 * np.sin(theta) * np.ones_like(theta)


@pytest.mark.parametrize("inertia", [1e-3, 0.1, 10.0, 1000.0])
def test_the_spin_of_a_heavy_roller_recurs(inertia: float) -> None:
    """The spin after a turn is that before it, however little friction turns the roller: by the
    balance of the impulses over the turn, friction less bearing drag, within 1e-6 of the drag.
    """
    _, force, spin, rate = heavy(inertia)
    drag = Drag(inertia=inertia, friction=0.05, torque=0.02)
    period, radius = 2.0 * np.pi / 10.0, 0.02
    rolling = rolling_contact(
        force, spin, rate, np.full(force.size, 3.0), np.full(force.size, 1e-4),
        np.full(force.size, 0.02), drag=drag, radius=radius, period=period,
    )  # fmt: skip
    turning = spin - rolling.slip / radius
    step = period / force.size
    gained = (radius * rolling.force - np.sign(spin) * 0.02) * step / inertia
    np.testing.assert_allclose(np.diff(turning), gained[1:], rtol=0, atol=1e-6 * 300.0)
    assert abs(turning[0] - turning[-1] - gained[0]) < 1e-6 * 300.0


@pytest.mark.parametrize("seed", range(40))
def test_a_roller_between_two_walls_is_turned_back_by_friction_alone(seed: int) -> None:
    """Its spin recurs after a turn, and changes by no more than friction and drag can turn it.

    Within 2 %: while it rolls its torque is that of the acceleration at the end of a step of 1 deg.
    """
    draw = np.random.default_rng(seed)
    theta = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)
    pull = np.sin(draw.integers(1, 4) * theta + draw.uniform(0.0, 6.0))
    wall = np.where(pull >= 0.0, 1.0, -1.0)
    spin = wall * draw.uniform(50.0, 200.0) * (1.0 + 0.2 * np.cos(theta))
    force, period = draw.uniform(5.0, 2000.0) * np.abs(pull), 0.2
    inertia, radius = draw.uniform(1e-6, 1e-3), 0.02
    drag = Drag(inertia, 0.1, torque=draw.uniform(0.0, 0.05))
    rate = -0.2 * wall * np.abs(spin).mean() * np.sin(theta) * 2.0 * np.pi / period
    rolling = rolling_contact(
        force, spin, rate, np.full(360, 3.0), np.full(360, 1e-4), np.full(360, 0.01),
        drag=drag, radius=radius, period=period,
    )  # fmt: skip
    turning = spin - rolling.slip / radius
    change = np.abs(turning - np.roll(turning, 1)) * inertia * 360 / period
    assert (change <= 1.02 * (drag.friction * force * radius + drag.torque)).all()
    assert (np.abs(rolling.force) <= drag.friction * force * (1.0 + 1e-12)).all()
