"""The contact solved again by CalculiX from the deck that is written: an independent code."""

from __future__ import annotations

import re
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from calculix_results import measured, read_frd, solved_by_calculix, von_mises
from cam_parts import Keyway

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError, MeshError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import roller_mesh
from camwright.meshes.calculix_deck import DeckBody, write_deck
from camwright.meshes.element_size import ElementSize
from camwright.pipeline.base.tables import Table
from camwright.pipeline.contact.certificate import SolvedPair, solve_pair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, StressRecovery
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.ring_body import BallRing, RingBody
from camwright.pipeline.results.contact_deck import (
    force_at,
    nodal_forces,
    write_contact_deck,
    write_pair_deck,
)

FORCE, THETA = 900.0, 1.1
WITHIN = 0.01  # of the greatest: the two codes carry stresses to the nodes by different rules


FOLLOWERS = {
    "solid roller": RollerBody(0.008, 0.0025, Elastic(208e9, 0.3)),
    "ring on balls": RingBody(
        0.008, BallRing(0.00136, (-0.5, 0.5), 1.5e7, 1.4e-4), 0.0044, Elastic(208e9, 0.3)
    ),
}


@pytest.fixture(scope="module", params=FOLLOWERS)
def solved(request: pytest.FixtureRequest) -> tuple[ContactPair, SolvedPair]:
    theta = uniform_turn(360)
    lift = Lift(theta, 0.008 * (1 - np.cos(theta)))
    contour = RollerContour(PitchCurve(lift, 0.045), 0.008)
    pair = ContactPair(
        contour, 0.0044, 0.010, Keyway(0.004, 0.002, 3.0),
        Elastic(206e9, 0.3), FOLLOWERS[request.param],
    )  # fmt: skip
    return pair, solve_pair(pair, THETA, FORCE, 4.0)


@pytest.fixture(scope="module")
def calculix(solved, tmp_path_factory: pytest.TempPathFactory):
    """Displacement and stress of both bodies by CalculiX, (c, nodes) in the order of the deck."""
    program = shutil.which("ccx")
    if program is None:
        pytest.skip("no CalculiX: Debian has it in the package calculix-ccx")
    folder = tmp_path_factory.mktemp("ccx")
    write_contact_deck(folder / "contact.inp", *solved)
    solved_by_calculix(program, folder / "contact.inp")
    found = read_frd(folder / "contact.frd")
    count = sum(side.body.mesh.points.shape[1] for side in solved[1].sides)
    return {
        name: np.array([found[name][k + 1] for k in range(count)]).T for name in ("DISP", "STRESS")
    }


def sides(solved: SolvedPair):
    """Body, displacement and slice of its nodes in the deck."""
    start = 0
    for side, moved in zip(solved.sides, solved.solution.displacements, strict=True):
        count = side.body.mesh.points.shape[1]
        yield side.body, moved, slice(start, start + count)
        start += count


def test_displacement_is_that_of_calculix(solved, calculix) -> None:
    for _, moved, nodes in sides(solved[1]):
        other = calculix["DISP"][:2, nodes] * 1e-3
        assert np.abs(moved).max() > 1e-6  # there is something to compare
        assert np.abs(other - moved).max() <= 1e-3 * np.abs(moved).max()


def test_von_mises_is_that_of_calculix_away_from_the_contact_edge(solved, calculix) -> None:
    _, contact = solved
    for body, moved, nodes in sides(contact):
        recovery = StressRecovery(body, np.arange(body.mesh.triangles.shape[1]))
        nodal = np.zeros((3, body.mesh.points.shape[1]))
        nodal[:, recovery.nodes] = recovery(moved[:, :, None])[:, :, 0]
        ours = plane_stress_measures.von_mises(nodal, body.poisson) / 1e6
        theirs = von_mises(calculix["STRESS"][:, nodes])
        points, half = body.mesh.points, contact.solution.half_width
        xi, depth = contact.frame.along(points), np.abs(contact.frame.above(points))
        inside = (np.hypot(xi, depth) < 4 * half) & (depth > 0.3 * half)  # beneath, off the edge
        assert inside.sum() > 50
        apart = np.abs(ours - theirs)
        assert apart[inside].max() <= WITHIN * ours[inside].max()
        # the body beyond, against what is to be seen there
        beyond = np.hypot(xi, depth) > 4 * half
        assert np.median(apart[beyond]) <= WITHIN * np.median(ours[beyond])


def test_forces_of_the_deck_balance_the_load(solved) -> None:
    pair, contact = solved
    on_cam, on_roller = nodal_forces(pair, contact)
    np.testing.assert_allclose(on_roller.sum(axis=1), FORCE * contact.frame.normal, atol=1e-6)
    np.testing.assert_allclose(on_cam.sum(axis=1), -FORCE * contact.frame.normal, atol=1e-6)


def test_deck_says_units_sets_and_supports(solved, tmp_path: Path) -> None:
    path = tmp_path / "contact.inp"
    write_contact_deck(path, *solved)
    text = path.read_text(encoding="ascii")
    for part in ("mm, N, MPa", "TYPE=CPE6, ELSET=cam", "NSET=cam_bore", "cam_bore, 1, 2",
                 "NSET=cam_keyway", "206000.0, 0.3", "*CLOAD"):  # fmt: skip
        assert part in text
    held = solved[0].follower.held
    assert ("roller_hub, 1, 2" in text) == bool(held)
    assert ("balls push" in text) == (not held)
    count = sum(side.body.mesh.triangles.shape[1] for side in solved[1].sides)
    assert len(re.findall(r"(?m)^\d+(, \d+){6}$", text)) == count


@pytest.mark.slow
def test_calculix_finds_the_pressure_by_itself(solved, tmp_path: Path) -> None:
    """With its own contact: the deck holds bodies, supports and the force on the axle alone.

    0.3 % for the penalty, 0.1 % of the pressure, and for nodal stresses on eight elements per
    half-width. The pressure on the thin ring is no ellipse: `python benchmarks/calculix.py` has a
    ring, at three angles and in the limit of the penalty.
    """
    if not solved[0].follower.held:
        pytest.skip("the pressure on a thin ring is no ellipse")
    program = shutil.which("ccx")
    if program is None:
        pytest.skip("no CalculiX: Debian has it in the package calculix-ccx")
    pair = solved[0]
    contact = solve_pair(pair, THETA, FORCE, 8.0)
    write_pair_deck(tmp_path / "contact.inp", pair, contact, 400.0)
    solved_by_calculix(program, tmp_path / "contact.inp")
    theirs, ours = measured(tmp_path / "contact.inp", contact, pair.width), contact.solution
    assert theirs.reaction == pytest.approx(FORCE, rel=1e-4)
    assert theirs.p0 == pytest.approx(ours.p0, rel=3e-3)
    assert theirs.half_width == pytest.approx(ours.half_width, rel=3e-3)
    assert theirs.von_mises == pytest.approx(ours.von_mises, rel=3e-3)


def test_deck_of_the_contact_pair_holds_no_result(solved, tmp_path: Path) -> None:
    path = tmp_path / "contact.inp"
    write_pair_deck(path, *solved)
    text = path.read_text(encoding="ascii")
    comments = [line for line in text.splitlines() if line.startswith("**")]
    assert any(f"peak pressure {solved[1].solution.p0 / 1e6:.6g} MPa" in line for line in comments)
    assert any(line.startswith("** penalty: ") for line in comments)
    assert "TYPE=SURFACE TO SURFACE\nroller_touching, cam_touching" in text
    loads = text.split("*CLOAD\n")[1].split("\n*")[0].split(",")
    normal = solved[1].frame.normal
    moved = int(loads[1]) - 1  # the one component of the axle that is free
    assert float(loads[2]) * normal[moved] == pytest.approx(-FORCE, rel=1e-9)
    springs = solved[0].follower.held == ""
    assert text.count("TYPE=SPRING1") == (4 if springs else 0)
    # the equations move no body by themselves: rigid displacement of follower and axle is free
    weights = equation_sums(text)
    np.testing.assert_allclose([sum(each.values()) for each in weights[:-1]], 0.0, atol=1e-9)


def equation_sums(text: str) -> list[dict[int, float]]:
    """Sum of the factors of each equation by component, without the ends of springs."""
    sums = []
    for block in text.split("*EQUATION\n")[1:]:
        count, *rows = block.split("\n*")[0].split("\n")
        cells = ", ".join(rows).split(",")
        terms = [cells[k : k + 3] for k in range(0, 3 * int(count), 3)]
        own = len(terms) > 2 and float(terms[0][2]) == -1.0
        made: dict[int, float] = {}
        for _, component, factor in terms[1:] if own else terms:
            made[int(component)] = made.get(int(component), 0.0) + float(factor)
        sums.append(made)
    return sums


def test_what_no_deck_can_hold_is_refused(tmp_path: Path) -> None:
    mesh = roller_mesh(0.008, 0.0025, 0.0, ElementSize(far_size=0.002))
    nothing = np.zeros((2, mesh.points.shape[1]))
    with pytest.raises(MeshError, match="letters"):
        write_deck(tmp_path / "a.inp", {"a\n*STEP": DeckBody(mesh, 1e11, 0.3, "hub", nothing)}, 1)
    with pytest.raises(MeshError, match="forces"):
        DeckBody(mesh, 1e11, 0.3, "hub", nothing[:, 1:])


def test_force_between_positions_and_where_there_is_none() -> None:
    table = Table(
        {
            "cam_angle_deg": np.array([0.0, 90.0, 180.0, 270.0]),
            "normal_force_N": np.array([100.0, 200.0, 0.0, 300.0]),
        },
        np.array(["idle"] * 4),
    )
    assert force_at(table, "idle", np.radians(45.0)) == pytest.approx(150.0)
    assert force_at(table, "idle", np.radians(315.0)) == pytest.approx(200.0)
    with pytest.raises(InputError, match="loaded"):
        force_at(table, "idle", np.pi)
    with pytest.raises(InputError, match="idle"):
        force_at(table, "other", 0.0)
