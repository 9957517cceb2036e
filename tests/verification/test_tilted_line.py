"""Tilt of the line of contact: moment, end pressure, screening, crown, finite elements."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.checks.contact_strength import edge_pressure
from camwright.pipeline.contact.finite_length import length_contact
from camwright.pipeline.contact.finite_length.half_space import shared_compliance
from camwright.pipeline.contact.finite_length.length_tiers import both_tiers, cycle_sizes
from camwright.pipeline.contact.finite_length.pressure_cells import pressure_cells
from camwright.pipeline.cycle.certificate_angles import length_loads
from camwright.pipeline.cycle.cycle import turn_of_line
from camwright.pipeline.cycle.length_history import length_table, signed_factor
from camwright.pipeline.follower.camshaft_loads import unbalance
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_arrays import Designs, LiftOrigin
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.search.crown.solved_lines import SolvedLines, signed_range

LIFT = 3e-3 * (1.0 - np.cos(uniform_turn(720))) + 1e-3 * (1.0 - np.cos(3.0 * uniform_turn(720)))
CASE = Path(__file__).parents[1] / "data" / "refused" / "overhung_cam.toml"
EXACT = {"limits.axis_parallelism": "0 mrad", "limits.cam_run_out": "0 um"}
ENDLESS = {"cam.end": None, "roller.end": None}
BETWEEN = {"camshaft.bearing_spacing": "300 mm", "camshaft.gear_position": "350 mm"}


@cache
def previewed(*changes):
    """Preview of the overhung cam with other values, by pairs of key and value."""
    case = with_values(read_case(CASE), dict(changes))
    return preview_case(case, corners=False)


def of(values):
    return previewed(*values.items())


def greatest(trial):
    """Greatest signed pressure, MPa, of all load cases."""
    return 1e-6 * max(float(np.nanmax(each.signed_pressure)) for each in trial.cycles)


def edge(trial):
    return next(each for each in trial.checks if each.id == edge_pressure.id)


def test_an_overhung_cam_loads_its_ends_by_the_slope_of_its_shaft():
    """1.2 mrad of slope, which guides and stem take up in part: 1030 MPa, not the 633 without."""
    trial = of({})
    slope = max(float(np.abs(each.shaft_tilt).max()) for each in trial.cycles)
    assert slope == pytest.approx(1.2e-3, rel=0.01)
    assert greatest(trial) == pytest.approx(1030.0, rel=0.05)
    assert greatest(of(EXACT)) == pytest.approx(1010.0, rel=0.05)  # by the shaft alone
    stiff = greatest(of({"camshaft.diameter": "120 mm", "cam.bore_radius": "15 mm"} | EXACT))
    assert stiff == pytest.approx(633.0, rel=0.01)
    assert edge(trial).status == "pass"
    strict = edge(of({"limits.contact_safety": 1.5}))
    assert strict.limit == pytest.approx(1000e6)
    assert strict.status == "fail"
    assert "camshaft 1.2," in edge(trial).note


def test_an_overhung_cam_turns_the_rings_of_its_roller():
    """Beam on two supports, 1200 N 60 mm beyond one: F a (2 l + 3 a)/(6 E I), and the guides.

    With a shaft of 60 mm the angle is within the limit.
    """
    trial = of(EXACT)
    judged = next(each for each in trial.checks if each.id == "roller_misalignment")
    inertia = np.pi * 0.03**4 / 64.0
    slope = 1200.0 * 0.06 * (2.0 * 0.33 + 3.0 * 0.06) / (6.0 * 210e9 * inertia)
    guides = trial.case.guides
    stem = 0.5 * (guides.a.clearance + guides.b.clearance)
    stem /= guides.spacing + 0.5 * (guides.a.length + guides.b.length)
    assert judged.demand == pytest.approx(slope + stem, rel=0.05)  # the gear bends it, too
    assert judged.status == "fail"
    stiff = of({"camshaft.diameter": "60 mm", "cam.bore_radius": "15 mm"} | EXACT)
    assert next(e for e in stiff.checks if e.id == "roller_misalignment").status == "pass"


@pytest.mark.parametrize(
    ("values", "at_least"),
    [
        ({"camshaft.bearing_spacing": "150 mm", "camshaft.gear_position": "190 mm"}, 800.0),
        ({"camshaft.diameter": "26 mm"}, 1150.0),
        ({"camshaft.cam_position": "-90 mm"}, 1150.0),
        ({"camshaft.cam_position": "60 mm"} | BETWEEN, 700.0),
        ({"camshaft.cam_position": "60 mm", "camshaft.diameter": "20 mm"} | BETWEEN, 1000.0),
    ],
)
def test_slender_shafts_and_cams_off_the_middle_load_their_ends(values, at_least):
    assert greatest(of(values)) > at_least


def test_a_cam_in_the_middle_of_its_bearings_is_level():
    values = {
        "camshaft.bearing_spacing": "120 mm",
        "camshaft.cam_position": "60 mm",
        "camshaft.gear_position": "150 mm",
    }
    assert greatest(of(values)) == pytest.approx(633.0, rel=0.02)


def test_end_pressure_grows_with_each_part_of_the_tilt():
    base = greatest(of({}))
    for part, values in (
        ("parallelism", {"limits.axis_parallelism": "0.3 mrad"}),
        ("run-out", {"limits.cam_run_out": "30 um"}),
        ("shaft", {"camshaft.diameter": "29 mm"}),
        ("stem", {"follower.stem_material": "c45", "follower.overhang_at_max_lift": "46 mm"}),
    ):
        assert greatest(of(values)) > base, part


def test_the_moment_is_in_equilibrium_with_stem_and_shaft():
    """The half-spaces under the moment tilt by what is forced less what stem and shaft yield."""
    made, k = worst_turn()
    turn, moment = turn_of_line(made), made.length.moment[k]
    assert moment > 2 * made.length.couple[k]
    contact = solved_line(made, k)(moment)
    stem = made.machine.stem.bending_stiffness
    outer = made.machine.guides.spacing + 0.03
    bend = 0.035 / stem + outer / (3 * stem)
    shaft = (0.33 + 3 * 0.06) / (3 * 206e9 * np.pi * 0.03**4 / 64)
    assert turn.tilt_compliance == pytest.approx(bend + shaft, rel=0.03)  # E of the card
    left = made.length.tilt.forced[k] - turn.tilt_compliance * moment
    assert contact.tilt[0] == pytest.approx(left, rel=0.02)


def test_the_moment_of_the_pressure_reaches_pin_cheeks_and_guides():
    """Of the half-spaces at the angle that shaft and stem leave, 2 %; pin and guides by hand.

    The pin is a beam of 23 mm, its load linear over the 17.5 mm of the bearing; the stem
    bears on the outer ends of its guides, 162 mm apart; the roller is offset axially by 0.3 mm.
    """
    made, k = worst_turn()
    turn, line = turn_of_line(made), solved_line(made, k)
    force, angle = made.loads.normal_force[k], made.loads.pressure_angle[k]
    low, high = 0.0, 0.44 * force * made.pair.width
    for _ in range(12):
        middle = 0.5 * (low + high)
        left = made.length.tilt.forced[k] - turn.tilt_compliance * middle
        low, high = (middle, high) if line(middle).tilt[0] < left else (low, middle)
    moment = 0.5 * (low + high) + 0.3e-3 * force
    assert made.follower_moment[k] == pytest.approx(moment, rel=0.02)
    x = (np.arange(20_000) + 0.5) / 20_000 * 23e-3 - 11.5e-3
    load = np.where(np.abs(x) < 8.75e-3, force / 17.5e-3 + 12.0 * moment * x / 17.5e-3**3, 0.0)
    step = 23e-3 / 20_000
    bent = np.max(np.cumsum(0.5 * force - moment / 23e-3 - np.cumsum(load) * step)) * step
    support, edge = 0.5 * force + moment / 23e-3, load.max() / 17e-3
    level = 0.5 * force / 17e-3
    stresses = {
        "roller_pin": (32.0 * bent / (np.pi * 17e-3**3), 1.1, 8.87e6),
        "roller_pin_shear": (4.0 * support / (3.0 * 0.25 * np.pi * 17e-3**2), 1.45, 3.53e6),
        "roller_pin_pressure": (edge, 2.75, level / 8.75e-3),
        "cheek_pressure": (support / (17e-3 * 5e-3), 1.45, level / 5e-3),
    }
    for name, (stress, times, of_force) in stresses.items():
        assert judged(of({}), name).demand == pytest.approx(stress, rel=0.02), name
        assert stress > 0.98 * times * of_force, name
    across = moment * np.cos(angle) / 162e-3
    assert abs(made.sideways.reaction_a[k]) == pytest.approx(across, rel=0.02)
    assert abs(made.sideways.reaction_b[k]) == pytest.approx(across, rel=0.02)
    for push, alone, one in zip(
        made.guide_pushes,
        (made.guides.bearing_load_a, made.guides.bearing_load_b),
        (made.sideways.bearing_load_a, made.sideways.bearing_load_b),
        strict=True,
    ):
        assert one[k] > across  # on the edges alone
        assert push[k] == pytest.approx(np.sqrt(alone[k] ** 2 + one[k] ** 2))
    stiff = of({"camshaft.diameter": "120 mm", "cam.bore_radius": "15 mm"} | EXACT)
    assert stiff.cycles[0].sideways is None


def judged(trial, name):
    return next(each for each in trial.checks if each.id == name)


def worst_turn():
    """Cycle of the greatest end pressure of the overhung cam, and its angle."""
    made = max(of({}).cycles, key=lambda each: float(np.nanmax(each.signed_pressure)))
    return made, int(np.nanargmax(made.signed_pressure))


def solved_line(made, k):
    """Contact of half-spaces at an angle of a cycle, as a function of its moment, N m."""
    moment, force = made.length.moment[k], made.loads.normal_force[k]
    curvature = 1 / made.contact.relative_radius[k]
    (pair, *_) = [
        each
        for each in made.machine.finite_pairs
        if signed_at(each, curvature, force, moment, made) == pytest.approx(made.length.factor[k])
    ]
    here = replace(pair, curvature=float(curvature))
    cells = pressure_cells(here, made.contact.half_width[k], cycle_sizes(pair))
    shared, gap = shared_compliance(cells, pair.bodies), [cells.integrated_gap(here)]
    return lambda at: length_contact.solve(cells, shared, gap, [force], moment=[at])


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"camshaft.cam_position": "60 mm", "camshaft.diameter": "20 mm"} | BETWEEN,
        ENDLESS,
    ],
    ids=["overhung", "slender", "without ends"],
)
def test_the_screening_has_the_moment_of_the_cycle(values):
    """Within the deviations of the checks; without the ends the bound of a rigid line."""
    case = with_values(read_case(CASE), values)
    screened = screen_designs(case, {"spring.preload": np.array([1000.0, 1100.0])})
    for row, preload in enumerate(("1000 N", "1100 N")):
        known = of(values | {"spring.preload": preload})
        for name in ("roller_pin", "roller_pin_shear", "roller_pin_pressure", "cheek_pressure"):
            demand = float(screened[f"{name}.demand"][row])
            shown = judged(known, name).as_record()["demand"]
            assert demand == pytest.approx(shown, rel=0.02), name
        for name in ("guide_pressure_A", "guide_pressure_B"):
            demand = float(screened[f"{name}.demand"][row])
            assert demand == pytest.approx(judged(known, name).as_record()["demand"], rel=0.1)


def test_without_the_ends_the_moment_is_bounded():
    """A line that does not yield has the greater moment; what stem and shaft bend limits it."""
    bounded, known = (
        max(float(each.follower_moment.max()) for each in of(values).cycles)
        for values in (ENDLESS, {})
    )
    assert known < bounded < 1.5 * known


def signed_at(pair, curvature, force, moment, made):
    table = length_table(pair, made.length.mean_length)
    at = np.array([curvature]), np.array([force]), np.array([moment])
    return float(signed_factor(table, *at).value[0])


def test_the_crown_has_the_tilt_of_the_cycle():
    """The lines that `crown` solves one by one have the pressures of the table of the cycle."""
    made = max(of({}).cycles, key=lambda each: float(np.nanmax(each.signed_pressure)))
    turn, rows = turn_of_line(made), np.array([int(np.nanargmax(made.signed_pressure))])
    place = np.flatnonzero(np.isin(turn.rows, rows))
    loads = type(turn.loads)(*(each[place] for each in turn.loads))
    solved = [
        signed_range(SolvedLines(pair, made.length.mean_length), loads)
        for pair in made.machine.finite_pairs
    ]
    assert max(each.factor[0] for each in solved) == pytest.approx(
        made.length.factor[rows[0]], rel=0.01
    )
    moments = max(each.moment[0] for each in solved)
    assert moments == pytest.approx(made.length.moment[rows[0]], rel=0.01)


@pytest.mark.parametrize(
    "values",
    [
        {},
        {"camshaft.bearing_spacing": "200 mm", "camshaft.gear_position": "240 mm"},
        {"camshaft.cam_position": "60 mm", "camshaft.diameter": "20 mm"} | BETWEEN,
        {"load_case[0].speed": "2800 rpm", "limits.overspeed": "3000 rpm"},
        {"camshaft.counterweight": None, "limits.overspeed": "3000 rpm"},
    ],
)
def test_the_screening_has_the_tilt_of_the_cycle(values):
    """Within the deviation that `edge_pressure` declares."""
    case = with_values(read_case(CASE), values)
    factors = {"spring.preload": np.array([1000.0, 1100.0]), "cam.prime_radius": np.full(2, 0.06)}
    screened = screen_designs(case, factors)
    for row, preload in enumerate(("1000 N", "1100 N")):
        known = of(values | {"spring.preload": preload})
        demand = float(screened[f"{edge_pressure.id}.demand"][row])
        assert demand == pytest.approx(greatest(known), rel=0.01)


@pytest.mark.parametrize("name", ["gx120-redesign.toml", "gx120-flat-face.toml"])
def test_the_screening_has_the_unbalance_of_the_contour(name):
    """Area integrals of the polygon through the contacts against those of the contour."""
    case = read_case(Path(__file__).parents[2] / "cases" / name)
    made = Designs(case, {}, LiftOrigin(lift=LIFT), {}, 1, 1)
    cam = replace(case.cam, counter_hole=None)
    known = unbalance(
        case.contour(Lift(uniform_turn(LIFT.size), LIFT)), cam.bore_radius, cam.keyway,
        cam.width, cam.material.density,
    )  # fmt: skip
    made.results["machine"] = replace(made.machine, cam=cam)
    product, angle = made.unbalance
    assert product[0, 0] == pytest.approx(known.product, rel=1e-3)
    assert np.exp(1j * angle[0, 0]) == pytest.approx(np.exp(1j * known.angle), abs=1e-3)


@pytest.mark.slow
def test_finite_elements_agree_on_the_tilted_line():
    """Blocks of cam and roller under the force and moment of the worst angle, 2 %."""
    load = length_loads(of({}).cycles, [])[0]
    assert abs(load.moment) > 0.25 * load.force * load.pair.contact_length
    half, blocks = both_tiers(load.pair, load.force, moment=load.moment)
    assert half.signed.values[-1] == pytest.approx(blocks.signed.values[-1], rel=0.02)
    assert load.factor == pytest.approx(blocks.signed.values[-1], rel=0.02)
