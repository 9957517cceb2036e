"""Signed pressure along the line of contact over a turn."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from half_spaces import half_space_factors

import camwright as cw
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.machine import machine
from camwright.pipeline.contact.finite_length.factor_table import GREATEST_MOMENT
from camwright.pipeline.contact.finite_length.length_contact import rebinned
from camwright.pipeline.cycle.axial_pressure import AXIAL_ARRAYS, axial_arrays, with_end_cells
from camwright.pipeline.cycle.cycle import solve_lengths, turn_of_line
from camwright.pipeline.cycle.length_history import (
    ContactLoads,
    FactorRange,
    factor_range,
    length_histories,
    raised_load,
    worst_of,
)

CASES = Path(__file__).parents[2] / "cases"


@cache
def cycle(**values):
    """Preview of a harmonic lift of 8 mm at the first load case, 90 angles.

    The roller of 17.5 mm has chamfers of 0.6 mm and lies 0.3 mm off the middle of a cam of 15.5 mm.
    """
    stated = {key.replace("__", "."): value for key, value in values.items()}
    case = with_values(read_case(CASES / "gx120-redesign.toml"), stated)
    theta = uniform_turn(360)
    lift = Lift(theta, 4e-3 * (1.0 - np.cos(theta)))
    contour = case.contour(lift)
    trial = cw.solve(case, contour, tier=cw.Tier.PREVIEW, positions=90, corners=False)
    return trial.solution.cycles[0]


def kernel(made, place, moment):
    """Factors of the half-spaces at an angle, the worse of the two ends."""
    curvature, force = 1.0 / made.contact.relative_radius[place], made.loads.normal_force[place]
    return [
        half_space_factors(pair, [curvature], [force], [moment])
        for pair in made.machine.finite_pairs
    ]


def test_factor_at_a_corner_is_the_mean_of_the_half_spaces():
    """Within the interpolation of the table, 0.2 %."""
    made = cycle()
    place = int(np.argmax(made.signed_pressure))
    assert made.length.at_corner[place]
    for moment, factor in (
        (0.0, made.length.level),
        (made.length.moment[place], made.length.tilted),
    ):
        means = max(float(each.end_means.max()) for each in kernel(made, place, moment))
        assert factor[place] == pytest.approx(means, rel=4e-3)
    assert made.length.factor[place] == max(made.length.level[place], made.length.tilted[place])
    assert "over the last 0.1 mm" in made.length.sentence(place)


def test_moment_is_the_lesser_of_tilt_and_friction():
    made = cycle()
    guides, force = made.machine.guides, made.loads.normal_force
    loads = made.guides.rubbing_load_a, made.guides.rubbing_load_b
    held = np.minimum(
        *(mu * load for mu, load in zip(made.machine.friction.greatest, loads, strict=True))
    )
    couple = held * guides.spacing + 0.3e-3 * force
    np.testing.assert_allclose(turn_of_line(made).held, held * guides.spacing)
    assert (made.length.moment <= couple * (1.0 + 1e-9)).all()
    # At a dwell of the side load the offset alone holds the tilt.
    light = int(np.argmin(held / force))
    assert made.length.moment[light] == pytest.approx(couple[light], rel=1e-6)


def test_without_clearance_and_offset_there_is_no_tilt():
    made = cycle(
        guides__a__clearance="0 mm", guides__b__clearance="0 mm", roller__axial_offset="0 mm",
        limits__axis_parallelism="0 mrad", limits__cam_run_out="0 um",
        limits__roller_clearance="0 um", camshaft=None,
    )  # fmt: skip
    assert np.abs(made.length.moment).max() < 1e-12  # N m
    np.testing.assert_allclose(made.length.tilted, made.length.level)


def test_the_tilt_has_its_parts():
    made = cycle(camshaft__cam_position="-20 mm", limits__roller_clearance="10 um")
    tilt, machine = made.length.tilt, made.machine
    place = int(np.argmax(np.abs(tilt.shaft)))
    np.testing.assert_array_equal(tilt.shaft, made.shaft_tilt)
    radius = machine.cam.prime_radius - machine.roller.radius
    by_hand = {
        "camshaft": abs(made.shaft_tilt[place]),
        "parallelism": 0.1e-3,
        "run-out": 5e-6 / (2 * radius),
        "guide clearance": 0.03e-3 / (machine.guides.spacing + machine.guides.a.length),
        "roller bearing": 10e-6 / 16.3e-3,
    }
    assert dict(tilt.parts(place)) == pytest.approx(by_hand)
    assert tilt.greatest[place] == pytest.approx(sum(by_hand.values()))
    out_of_parallel = sum(by_hand[name] for name in ("camshaft", "parallelism", "run-out"))
    forced = out_of_parallel - by_hand["guide clearance"]
    assert tilt.forced[place] == pytest.approx(max(forced, 0.0))
    sentence = made.length.sentence(place)
    for name in by_hand:
        assert name in sentence


def test_a_crown_lowers_the_ends_and_raises_the_middle():
    plain = cycle(guides__a__clearance="0 mm", guides__b__clearance="0 mm")
    crowned = cycle(
        guides__a__clearance="0 mm", guides__b__clearance="0 mm",
        roller__crown__kind="johns_gohar", roller__crown__line_load="120 N/mm",
    )  # fmt: skip
    place = int(np.argmax(crowned.signed_pressure))
    assert not crowned.length.at_corner[place]
    assert "bounded" in crowned.length.sentence(place)
    assert crowned.length.factor[place] < plain.length.factor[place]
    assert (crowned.surface.p0 >= crowned.contact.p0).all()
    assert plain.surface is plain.contact
    np.testing.assert_allclose(
        crowned.surface.half_width, crowned.contact.half_width * crowned.length.centre
    )


def test_worse_end_governs():
    one, still = np.ones(2), np.zeros(2)
    corner = np.array([True, True])
    left = FactorRange(one, np.array([1.1, 1.1]), np.array([1.2, 1.5]), still, corner)
    right = FactorRange(1.2 * one, np.array([1.3, 1.0]), np.array([1.0, 1.0]), one, ~corner)
    worst = worst_of([left, right])
    np.testing.assert_array_equal(worst.level, [1.3, 1.1])
    np.testing.assert_array_equal(worst.tilted, [1.0, 1.5])
    np.testing.assert_array_equal(worst.moment, [1.0, 0.0])
    np.testing.assert_array_equal(worst.at_corner, [False, True])
    np.testing.assert_array_equal(worst.centre, [1.2, 1.2])


def test_a_chamfered_end_is_solved_down_to_vanishing_loads_under_the_heaviest_tilt():
    case = with_values(read_case(CASES / "gx120-redesign.toml"), {"cam.width": "17.5 mm"})
    pair = machine(case, case.load_cases[0]).finite_pairs[0]
    force = np.array([1e-6, 1.0, 3e3])
    couple = force * pair.contact_length
    curvature = np.full(3, pair.curvature)
    tilt, none = np.full(3, 0.05), np.zeros(3)
    loads = ContactLoads(curvature, force, tilt, none, none, couple, raised_load(force))
    solved = factor_range(pair, 1e-4, loads)
    assert (solved.moment <= GREATEST_MOMENT * couple).all()
    assert (solved.tilted > solved.level).all()
    # The lightest load has the factor of a thousandth of the greatest.
    light = ContactLoads(
        curvature[:1], 3.0 * force[1:2], tilt[:1], none[:1], none[:1],
        3.0 * couple[1:2], np.ones(1),
    )  # fmt: skip
    least = factor_range(pair, 1e-4, light)
    assert solved.tilted[0] == pytest.approx(least.tilted[0], rel=1e-9)


def test_without_an_end_nothing_is_signed():
    made = cycle()
    bare = replace(made.machine, cam=replace(made.machine.cam, end=None))
    turn = turn_of_line(made)._replace(machine=bare)
    assert length_histories([turn]) == (None,)


def test_turns_solved_together_are_those_solved_alone():
    """Of two pairs of bodies, with a light and a heavy load."""
    made, other = cycle(), cycle(roller__width="17 mm")
    force = made.loads.normal_force
    loads = [replace(made.loads, normal_force=factor * force) for factor in (1e-3, 1.0, 2.0)]
    turns = [replace(made, turn=replace(made.turn, loads=each)) for each in loads]
    turns.append(replace(other))
    alone = [replace(each) for each in turns]
    solve_lengths(turns)
    assert all("length" in each.results for each in turns)
    for together, single in zip(turns, alone, strict=True):
        for name in ("centre", "level", "tilted", "moment"):
            values = getattr(together.length, name), getattr(single.length, name)
            np.testing.assert_allclose(*values, rtol=1e-12)
    assert np.abs(turns[0].length.factor - turns[1].length.factor).max() > 1e-3


def test_pressure_along_the_line_is_the_signed_one():
    """Its greatest value with and without tilt at every angle whose peak is at a corner."""
    made = cycle()
    arrays = axial_arrays([made])
    assert list(arrays) and set(arrays) == {column.header for column in AXIAL_ARRAYS}
    edges = arrays["axial_edge_mm"]
    assert edges[-1] - edges[0] == pytest.approx(1e3 * made.machine.contact_width)
    level, tilted = (arrays[f"{name}_pressure_MPa"] for name in ("level", "tilted"))
    worst = int(np.argmax(np.where(made.length.at_corner, made.signed_pressure, 0.0)))
    signed = 1e-6 * made.signed_pressure[worst]
    assert np.maximum(level, tilted)[worst].max() == pytest.approx(signed, rel=1e-9)
    # The moment loads one side: that beyond the middle by as much as the other is relieved.
    half = tilted.shape[1] // 2
    widths = np.diff(edges)
    change = (tilted - level)[worst] * widths
    assert change[:half].sum() * change[half:].sum() < 0
    assert abs(change.sum()) < 0.02 * (level[worst] * widths).sum()


def test_pressure_along_the_line_needs_the_ends_and_contact():
    made = cycle()
    assert axial_arrays([cycle(roller__end=None)]) is None
    radius = made.contact.relative_radius

    def touching(where):
        contact = replace(made.contact, relative_radius=np.where(where, radius, np.nan))
        return axial_arrays([replace(made, contact=contact)])

    assert touching(False) is None
    half = touching(np.arange(radius.size) % 2 > 0)["level_pressure_MPa"]
    assert not half[::2].any() and half[1::2].all()


def test_means_at_the_ends_keep_the_force():
    edges = np.array([-2.0, -1.97, -1.85, -1.0, 0.0, 1.0, 1.85, 1.97, 2.0])
    line = np.array([[9.0, 4.0, 2.0, 1.0, 1.0, 2.0, 4.0, 9.0], [0.0, 0, 0, 1, 2, 3, 5, 12]])
    joined = with_end_cells(edges, 0.1)
    means = rebinned(np.stack([edges, edges]), line, joined)
    np.testing.assert_allclose(means @ np.diff(joined), line @ np.diff(edges), rtol=1e-12)
    assert means[0, 0] == pytest.approx((9.0 * 0.03 + 4.0 * 0.07) / 0.1)
    assert means[1, -1] == pytest.approx((12.0 * 0.03 + 5.0 * 0.07) / 0.1)
    np.testing.assert_allclose(joined[[0, 1, -2, -1]], [-2.0, -1.9, 1.9, 2.0])
