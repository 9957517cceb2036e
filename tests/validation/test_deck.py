"""The contact solved again by CalculiX from the deck that is written: an independent code."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from cam_parts import Keyway

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import InputError, MeshError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.body_mesh import roller_mesh
from camwright.meshes.calculix_deck import DeckBody, write_deck
from camwright.meshes.element_size import Sizing
from camwright.pipeline.base.tables import Table
from camwright.pipeline.contact.certificate import SolvedPair, solve_pair
from camwright.pipeline.contact.contact_pair import ContactPair
from camwright.pipeline.contact.elasticity import plane_stress_measures
from camwright.pipeline.contact.elasticity.elastic_body import Elastic, StressRecovery
from camwright.pipeline.contact.follower_body import RollerBody
from camwright.pipeline.contact.ring_body import BallRing, RingBody
from camwright.pipeline.results.contact_deck import force_at, nodal_forces, write_contact_deck

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


def read_frd(path: Path) -> dict[str, dict[int, list[float]]]:
    """Nodal results of CalculiX by name: columns of twelve characters after the node number."""
    found: dict[str, dict[int, list[float]]] = {}
    block: dict[int, list[float]] | None = None
    for line in path.read_text(encoding="ascii", errors="replace").splitlines():
        if line.startswith(" -4"):
            block = found.setdefault(line.split()[1], {})
        elif line.startswith(" -3"):
            block = None
        elif line.startswith(" -1") and block is not None:
            values = re.findall(r".{12}", line[13:])
            block[int(line[3:13])] = [float(value) for value in values]
    return found


@pytest.fixture(scope="module")
def calculix(solved, tmp_path_factory: pytest.TempPathFactory):
    """Displacement and stress of both bodies by CalculiX, (c, nodes) in the order of the deck."""
    program = shutil.which("ccx")
    if program is None:
        pytest.skip("no CalculiX: Debian has it in the package calculix-ccx")
    folder = tmp_path_factory.mktemp("ccx")
    write_contact_deck(folder / "contact.inp", *solved)
    done = subprocess.run(
        [program, "contact"], cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )
    assert "Job finished" in done.stdout, done.stdout[-2000:]
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
        xx, yy, zz, xy = calculix["STRESS"][:4, nodes]
        theirs = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy**2)
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


def test_what_no_deck_can_hold_is_refused(tmp_path: Path) -> None:
    mesh = roller_mesh(0.008, 0.0025, 0.0, Sizing(far_size=0.002))
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
