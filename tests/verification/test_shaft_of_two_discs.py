"""The camshaft under both discs of a pair, against a direct stiffness matrix of beam elements."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh
from test_conjugate_cam import uneven

from camwright.geometry.arrays import uniform_turn
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.checks.camshaft_strength import _rotor
from camwright.pipeline.cycle.cam_balance import camshaft_loads, rotor_unbalance, undrilled
from camwright.pipeline.cycle.cycle import turn_of_line
from camwright.pipeline.follower.follower_stiffness import shaft_between, shaft_compliance
from camwright.pipeline.follower.shaft_strength import slopes_of
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_arrays import Designs, LiftOrigin
from camwright.pipeline.screening.design_screening import step_of

DATA = Path(__file__).parents[1] / "data"


@cache
def solved(name):
    return preview_case(read_case(DATA / f"{name}.toml"), corners=False).solution


def flexibility(shaft, places):
    """Deflections, m, and slopes, rad, at places by unit forces and couples there (2k, 2k).

    Bernoulli's beam elements between all places and the bearings, which are held: exact.
    """
    nodes = sorted({0.0, shaft.bearing_spacing, *places})
    stiff = shaft.material.E * np.pi * shaft.diameter**4 / 64.0
    whole = np.zeros((2 * len(nodes), 2 * len(nodes)))
    for k, length in enumerate(np.diff(nodes)):
        element = np.array([
            [12.0, 6.0 * length, -12.0, 6.0 * length],
            [6.0 * length, 4.0 * length**2, -6.0 * length, 2.0 * length**2],
            [-12.0, -6.0 * length, 12.0, -6.0 * length],
            [6.0 * length, 2.0 * length**2, -6.0 * length, 4.0 * length**2],
        ])  # fmt: skip
        whole[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += stiff / length**3 * element
    held = [2 * nodes.index(at) for at in (0.0, shaft.bearing_spacing)]
    free = [k for k in range(2 * len(nodes)) if k not in held]
    inverse = np.zeros_like(whole)
    inverse[np.ix_(free, free)] = np.linalg.inv(whole[np.ix_(free, free)])
    at = [2 * nodes.index(place) + turned for turned in (0, 1) for place in places]
    return inverse[np.ix_(at, at)]


@pytest.mark.parametrize("spacing", [0.02, 0.04, 0.09])
def test_slope_and_couple_of_each_disc(spacing):
    """Between the bearings and overhung; the load of the gear at its place."""
    shaft = replace(solved("preloaded_arm").machine.camshaft, cam_position=0.035)
    places = (0.035, 0.035 + spacing, shaft.gear_position)
    beam, slopes = flexibility(shaft, places), slopes_of(shaft, spacing)
    assert len(slopes) == 2
    for k, slope in enumerate(slopes):
        turned = beam[3 + k]
        assert slope.cam == pytest.approx(turned[k], rel=1e-9, abs=1e-12)
        assert slope.beside == pytest.approx(turned[1 - k], rel=1e-9, abs=1e-12)
        assert slope.gear == pytest.approx(turned[2], rel=1e-9)
        assert slope.couple == pytest.approx(turned[3 + k], rel=1e-9)


def test_the_line_of_contact_yields_with_the_shaft_at_its_own_disc():
    """An overhung second disc turns by 2.4 times as much per moment as the first."""
    cycle = solved("preloaded_arm").cycles[0]
    shaft = replace(cycle.machine.camshaft, bearing_spacing=0.06)
    machine = replace(cycle.machine, camshaft=shaft)
    overhung = replace(cycle, turn=replace(cycle.turn, machine=machine))
    pulls, line = cycle.loads.wall < 0.0, turn_of_line(overhung)
    beam = flexibility(shaft, (0.035, 0.075))
    wanted = np.where(pulls, beam[3, 3], beam[2, 2])
    np.testing.assert_allclose(line.shaft_compliance, wanted, rtol=1e-9)
    assert 0.0 < pulls.mean() < 1.0
    assert beam[3, 3] / beam[2, 2] > 2.0


@pytest.mark.parametrize("name", ["conjugate_arm", "preloaded_arm", "conjugate_feeder"])
def test_a_screening_bends_the_shaft_under_both_discs(name):
    """Slope of the shaft in the screening against that of the preview, at the same angles.

    Guides of a stem by tables differ by 2e-5, arms by round-off; both discs are out of balance.
    """
    solution = solved(name)
    share = 5e-5 if name == "conjugate_feeder" else 1e-9
    lift = given_lift(solution.case).values
    designs = Designs(
        case=solution.case, columns={}, source=LiftOrigin(lift=lift), torques={}, count=1,
        step=step_of(lift.size, 720), throughputs={},
    )  # fmt: skip
    for cycle, cam in zip(solution.cycles, designs.cams, strict=True):
        wanted = cycle.shaft_tilt
        slope = np.broadcast_to(cam.shaft_tilt, (1, wanted.size))[0]
        np.testing.assert_allclose(slope, wanted, atol=share * np.abs(wanted).max())


@pytest.mark.parametrize(
    ("gear", "most"), [(-0.025, 1.02), (0.2, 1.01), (0.0, 1.05), (0.055, 1.25)]
)
def test_both_discs_twist_against_the_gear(gear, most):
    """Natural frequency of the free shaft as two inertias against that of gear and both discs.

    Never below it, by Rayleigh; 1.6 % above it where the gear is beside both discs as in the case.
    Of a gear between the discs, which then swing against one another, 21 %.
    """
    solution = solved("conjugate_arm")
    machine = solution.machine
    shaft = replace(machine.camshaft, gear_position=gear)
    rotor = _rotor(replace(machine, camshaft=shaft), solution.contour)
    places = (shaft.gear_position, shaft.cam_position, shaft.cam_position + 0.04)
    discs = [
        7.85e3 * machine.cam.width * (each.contour.polar_moment() - 0.5 * np.pi * 0.015**4)
        for each in solution.discs
    ]
    assert rotor.cam == pytest.approx(sum(discs), rel=1e-6)
    inertias = dict(zip(places, (rotor.gear, *discs), strict=True))
    along, whole = sorted(places), np.zeros((3, 3))
    card = shaft.material
    rigid = card.E / (2.0 * (1.0 + card.nu)) * np.pi * shaft.diameter**4 / 32.0
    for k, length in enumerate(np.diff(along)):
        whole[k : k + 2, k : k + 2] += rigid / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    squares = eigh(whole, np.diag([inertias[each] for each in along]), eigvals_only=True)
    two = rotor.shaft * rotor.inertia / (rotor.gear * rotor.cam)
    assert 1.0 - 1e-9 <= np.sqrt(two / squares[1]) < most


def test_each_roller_stands_on_its_own_arm_and_disc(measured):
    """Arm of 85 mm for 90 and a camshaft overhung by 15 mm, whose bending is that of the elements
    and whose shear is by the work of a unit load; along the travel of the roller of each.
    """
    machine = solved("preloaded_arm").machine
    shaft, card = machine.camshaft, machine.camshaft.material
    shaft = replace(shaft, bearing_spacing=0.06)
    machine = replace(machine, camshaft=shaft)
    over, area = 0.015, 0.25 * np.pi * shaft.diameter**2
    kappa = 6.0 * (1.0 + card.nu) / (7.0 + 6.0 * card.nu)
    shear = (over + 0.06 * (over / 0.06) ** 2) / (kappa * area * card.E / (2.0 * (1.0 + card.nu)))
    yielding = flexibility(shaft, (0.035, 0.075))[1, 1] + shear
    members = machine.compliances
    alone = replace(machine.arm_bar, length=0.085, held=0.0).compliance
    wanted = sum(members.values()) - members["camshaft"] - members["arm"] + yielding + alone
    own = machine.roller_compliances
    first, second = own.first + own.at_first, own.second + own.at_second
    assert first == pytest.approx(sum(members.values()), rel=1e-12)
    measured("compliance of a second roller", second, wanted, rtol=1e-9)
    assert yielding > 1.3 * members["camshaft"]
    assert machine.track_stiffnesses == pytest.approx(
        (1.0 / first, (0.085 / 0.09) ** 2 / second), rel=1e-12
    )
    assert machine.axial_stiffness == min(machine.track_stiffnesses)


@pytest.mark.parametrize("spacing", [0.02, 0.04, 0.09])
def test_deflection_at_one_disc_under_the_other(spacing):
    """Elements in bending, and the shear of a unit load; beyond a bearing that is none."""
    shaft = replace(solved("preloaded_arm").machine.camshaft, cam_position=0.035)
    first, last, span, card = 0.035, 0.035 + spacing, shaft.bearing_spacing, shaft.material
    kappa, area = 6.0 * (1.0 + card.nu) / (7.0 + 6.0 * card.nu), 0.25 * np.pi * shaft.diameter**2
    shear = first * max(span - last, 0.0) / span * 2.0 * (1.0 + card.nu) / (kappa * area * card.E)
    wanted = flexibility(shaft, (first, last))[0, 1] + shear
    assert shaft_between(shaft, spacing) == pytest.approx(wanted, rel=1e-9)
    moved = replace(shaft, cam_position=last)
    assert shaft_between(moved, 0.0) == pytest.approx(shaft_compliance(moved), rel=1e-12)


def test_the_preload_bends_the_shaft_under_both_discs(measured):
    """Place of the arm and of both discs at once, by the normals of the contours, springs of the
    rollers and the shaft by elements with the shear of a unit load: to round-off.
    """
    solution = solved("preloaded_arm")
    machine, contour = solution.machine, solution.cycles[0].contour
    shaft, card, theta = machine.camshaft, machine.camshaft.material, uniform_turn(24)
    kappa, area = 6.0 * (1.0 + card.nu) / (7.0 + 6.0 * card.nu), 0.25 * np.pi * shaft.diameter**2
    first, last, span = 0.035, 0.075, shaft.bearing_spacing
    sheared = np.array([[first * (span - first), first * (span - last)],
                        [first * (span - last), last * (span - last)]])  # fmt: skip
    sheared *= 2.0 * (1.0 + card.nu) / (span * kappa * area * card.E)
    bent = np.kron(flexibility(shaft, (first, last))[:2, :2] + sheared, np.eye(2))
    track, ratio = machine.cam.second.track(contour.pitch), 0.085 / 0.09
    normals = [each.local_frame(theta).normal for each in (contour, track.contour)]
    cosines = [np.cos(each.pressure_angle(theta)) for each in (contour.pitch, track.contour.pitch)]
    squeeze, own = machine.disc_preload.at(track, theta), machine.roller_compliances
    forces = np.array(squeeze.forces(np.full(24, 40.0)))
    wanted = np.zeros((2, 24))
    for k, (one, other) in enumerate(zip(*cosines, strict=True)):
        # of each roller into its disc, by the arm outwards and the discs along the normals
        ways = np.zeros((2, 5))
        ways[0, 0], ways[1, 0] = -one, ratio * other
        ways[0, 1:3], ways[1, 3:] = normals[0][:, k], normals[1][:, k]
        springs = np.diag([1.0 / (own.first * one**2), 1.0 / (own.second * other**2)])
        held = np.zeros((5, 5))
        held[1:, 1:] = np.linalg.inv(bent)
        closed = np.array([0.0, machine.cam.conjugate.interference])
        load = np.array([-40.0, 0.0, 0.0, 0.0, 0.0])
        system = held + ways.T @ springs @ ways
        moved = np.linalg.solve(system, load - ways.T @ springs @ closed)
        pressed = springs @ (closed + ways @ moved)
        wanted[:, k] = pressed[0] * one, ratio * pressed[1] * other
    assert (wanted > 0.0).all()
    assert forces == pytest.approx(wanted, rel=1e-8)
    measured("force of a preloaded roller", forces[0, 0], wanted[0, 0], rtol=1e-8, unit="N")
    rigid = machine.disc_preload.compliances._replace(at_first=0.0, between=0.0, at_second=0.0)
    stiff = replace(machine.disc_preload, compliances=rigid).at(track, theta)
    assert np.abs(stiff.preload / squeeze.preload - 1.0).max() > 0.01


def test_the_unbalance_of_two_discs_is_that_at_both_bearings():
    """Of two discs of one uneven stroke, the second overhung, from the forces of the bearings that
    grow by the square of the speed.
    """
    solution = preview_case(parse_case(uneven()), corners=False).solution
    cycle, machine = solution.cycles[0], solution.machine
    shaft = replace(machine.camshaft, bearing_spacing=0.05)
    args = cycle.loads, shaft, machine.cam, cycle.contour
    fast, slow = (camshaft_loads(*args, speed) for speed in (100.0, 0.0))
    ends = [np.hypot(*(getattr(fast, name) - getattr(slow, name))) / 100.0**2
            for name in ("bearing_1", "bearing_2")]  # fmt: skip
    assert np.ptp(ends[0]) < 1e-9 * ends[0].max()
    unbalance = rotor_unbalance(machine.cam, cycle.contour, shaft)
    assert unbalance == pytest.approx(ends[0].max() + ends[1].max(), rel=1e-9)
    static = undrilled(machine.cam, cycle.contour).product
    assert unbalance > 1.05 * static


def test_rings_of_both_preloaded_rollers_are_judged_by_the_slope_of_their_disc():
    """Slopes of beam elements in the normal of each contact; that of the second disc is greater.

    The roller that carries has a slope less by a fifth.
    """
    text = (DATA / "preloaded_feeder.toml").read_text(encoding="utf-8")
    for old, new in (
        ('cam_position = "35 mm"', 'cam_position = "52 mm"'),
        ('spacing = "34 mm"', 'spacing = "41 mm"'),
        ('roller_radius = "23.5 mm"', 'roller_radius = "19 mm"'),
        ('distance = "154 mm"', 'distance = "168 mm"'),
        ('mass = "2.5 kg"', 'mass = "4.1 kg"'),
        ('overspeed = "220 rpm"', 'overspeed = "380 rpm"'),
    ):
        assert old in text
        text = text.replace(old, new)
    trial = preview_case(parse_case(text), corners=False)
    (check,) = (each for each in trial.checks if each.id == "roller_misalignment")
    carrying, tilted = [], []
    for cycle in trial.cycles:
        shaft, loads = cycle.machine.camshaft, cycle.shaft
        beam = flexibility(shaft, (0.052, 0.093, shaft.gear_position))
        acting = np.stack([loads.cam, loads.second.force, loads.gear])
        track = cycle.machine.cam.second.track(cycle.contour.pitch)
        first = cycle.contour.pitch.pressure_angle(cycle.theta)
        second = track.contour.pitch.pressure_angle(cycle.theta + np.pi) - np.pi
        slopes = np.einsum("kj,jin->kin", beam[3:5, :3], acting)
        at_discs = [
            np.abs(slope[0] * np.cos(angle) + slope[1] * np.sin(angle))
            for slope, angle in zip(slopes, (first, second), strict=True)
        ]
        tilted.append(np.max(at_discs))
        carrying.append(np.abs(cycle.shaft_tilt).max())
    assert check.stated["phi"] == pytest.approx(max(tilted), rel=1e-6)
    assert max(carrying) < 0.9 * max(tilted)


def test_the_wall_over_the_keyway_is_that_of_the_smaller_disc():
    """Of the second one 150 - 68 - 18 - 23.5 - 15 - 3.3 = 22.2 mm, of the first 26.2 mm."""
    text = (DATA / "preloaded_feeder.toml").read_text(encoding="utf-8")
    text = text.replace('distance = "154 mm"', 'distance = "150 mm"')
    lines = [each for each in text.splitlines() if not each.startswith("fit = ")]
    trial = preview_case(parse_case("\n".join(lines)), corners=False)
    (root,) = (each for each in trial.checks if each.id == "keyway_root")
    assert "wall 22.2 mm" in root.note
