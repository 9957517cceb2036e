"""A machine that cannot be assembled is refused or fails, each fault by its name.

`tests/data/impossible.toml` is a case that somebody wrote to see what passes: `FAULTS` are its six
contradictions, each with the number that mends it.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.base.counterweight_body import (
    CounterweightBody,
    width_beside,
    width_for,
)
from camwright.pipeline.base.verdict import verdict
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.shaft_seats import seats
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, read_case, with_values
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.template import first_case
from camwright.pipeline.checks.assembly import from_follower
from camwright.pipeline.checks.registry import CHECKS, checks_of
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cam_balance import balance
from camwright.pipeline.cycle.machine_envelope import counterweight_body
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution, solution
from camwright.pipeline.follower.bearing_life import rating_bound, static_rating_bound
from camwright.pipeline.preview import preview_case
from camwright.pipeline.smoothing.allowables import limits_of

DATA = Path(__file__).parents[1] / "data"
FAULTS = {
    "camshaft.gear.teeth": 40,
    "roller.friction": 0.1,
    "roller.bearing.C": "12 kN",
    "roller.bearing.C0": "8.3 kN",
    "roller.bearing.radial_limit": "7 kN",
    "roller.bearing.static_radial_limit": "8.3 kN",
    "camshaft.bearing_spacing": "70 mm",
    "camshaft.cam_position": "35 mm",
    "roller.fork.cheek_height": "22 mm",
}
"""Numbers of the file that contradict one another or no machine, and what mends them."""


@cache
def stated() -> dict[str, object]:
    return tomllib.loads((DATA / "impossible.toml").read_text(encoding="utf-8"))


def put(tables: object, key: str, value: object) -> None:
    """Set a value at a dotted key of the tables."""
    *path, last = key.split(".")
    for step in path:
        assert isinstance(tables, dict)
        tables = tables[step]
    assert isinstance(tables, dict)
    tables[last] = value


def tables(*faults: str) -> dict[str, object]:
    """The case of the file with all but some of its faults mended."""
    text = (DATA / "impossible.toml").read_text(encoding="utf-8")
    case = tomllib.loads(text)
    for key, value in FAULTS.items():
        if key not in faults:
            put(case, key, value)
    return case


@cache
def sound() -> Case:
    """The case of the file with every fault mended."""
    return case_of(tables())


REFUSED = {
    "roller.friction": "roller.friction = 1.9, must be > 0 and <= 1",
    "roller.bearing.C": "roller.bearing.C = 900 kN, must be <= 1.087e+05 N, the greatest of rolling"
    " bearings within roller.radius = 23.5 mm and roller.width = 17.5 mm",
    "roller.bearing.C0": "roller.bearing.C0 = 900 kN, must be <= 1.705e+05 N",
    "roller.bearing.radial_limit": "roller.bearing.radial_limit = 900 kN, must be <= 1.705e+05 N",
    "roller.bearing.static_radial_limit": "roller.bearing.static_radial_limit = 900 kN, must be"
    " <= 1.705e+05 N",
}


@pytest.mark.parametrize(("key", "words"), list(REFUSED.items()))
def test_a_contradiction_of_the_case_is_refused_by_name(key: str, words: str) -> None:
    with pytest.raises(InputError) as refused:
        case_of(tables(key))
    assert str(refused.value).startswith(words)


def test_the_file_is_refused_until_its_last_contradiction_is_mended(
    command: Callable[..., tuple[int, str, str]],
) -> None:
    """By the command with exit code 2; each contradiction in its turn, and then each failed gap."""
    code, _, errors = command("check", DATA / "impossible.toml")
    assert code == 2
    assert "roller.friction = 1.9, must be > 0 and <= 1" in errors
    left, named = list(FAULTS), []
    while True:
        try:
            case = case_of(tables(*left))
        except InputError as error:
            named.append(error.field)
            left.remove(error.field)
        else:
            break
    assert set(named) == set(REFUSED)
    every = checks_of(solved(case))
    assert {one.id for one in every if one.must_have and one.status == "fail"} == {
        "bearing_gap", "fork_shaft_gap", "tooth_ratio",
    }  # fmt: skip
    told = next(one.note for one in every if one.id == "tooth_ratio")
    assert told == (
        "camshaft.gear.teeth = 60, 40 at mechanism.gear_ratio = 2 and camshaft.gear.pinion_teeth"
        " = 20"
    )


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"guides.a.friction": 1.01}, "guides.a.friction = 1.01, must be >= 0 and <= 1"),
        ({"guides.b.friction_max": 1.01}, "guides.b.friction_max = 1.01"),
        ({"camshaft.bearing_rating": "900 kN"}, "camshaft.bearing_rating = 900 kN, must be <= "),
        ({"camshaft.bearing_static_rating": "2000 kN"},
         "camshaft.bearing_static_rating = 2000 kN, must be <= "),
        ({"roller.width": "1 mm", "cam.width": "0.9 mm"},
         "roller.bearing.C = 12000 N, must be <= "),
    ],
)  # fmt: skip
def test_its_siblings_are_refused_too(values: dict[str, float | str], words: str) -> None:
    plain = {key: value for key, value in values.items() if key != "roller.width"}
    made = values if plain == values else values | {"roller.end.size": "0.05 mm"}
    with pytest.raises(InputError) as refused:
        with_values(sound(), made)
    assert words in str(refused.value)


def test_teeth_of_a_ratio_written_as_a_decimal_or_a_quotient_are_accepted() -> None:
    for ratio, teeth, pinion in ((2.0, 44, 22), (1.5, 36, 24), ("4:3", 40, 30), (0.333333, 20, 60)):
        values = {"mechanism.gear_ratio": ratio, "camshaft.gear.teeth": teeth,
                  "camshaft.gear.pinion_teeth": pinion}  # fmt: skip
        case = with_values(sound(), STATED | values)
        (made,) = checks_of(solved(case), [BY_ID["tooth_ratio"]])
        assert made.status == "pass", ratio


@pytest.mark.parametrize(
    ("values", "deviation"),
    [({"camshaft.gear.pinion_teeth": 21}, 1.0 / 21.0), ({"mechanism.gear_ratio": 1.0}, 1.0)],
)
def test_teeth_of_another_ratio_fail(values: dict[str, float], deviation: float) -> None:
    """By the turns of the gear: a pinion of 21 turns 40 teeth by 21 a turn, 40/21 turns for 2."""
    (made,) = checks_of(solved(with_values(sound(), STATED | values)), [BY_ID["tooth_ratio"]])
    assert made.status == "fail" and made.must_have
    assert made.demand == pytest.approx(deviation, rel=1e-12)


def test_no_bearing_of_the_catalogue_comes_near_the_bound_of_its_size() -> None:
    """Ratings of the cards over the greatest of their size; and of the seats, without one."""
    shares = []
    for card in catalogue_of(None).rollers.values():
        size = card.outer_diameter, card.width
        shares += [card.C / rating_bound(*size), card.C0 / static_rating_bound(*size)]
        for limit in (card.radial_limit, card.static_radial_limit):
            shares.append(0.0 if limit is None else limit / static_rating_bound(*size))
    assert len(shares) > 40
    assert max(shares) < 0.15
    for seat in seats():
        size = 4.0 * seat.bore, 2.0 * seat.bore
        assert 0.15 * rating_bound(*size) > seat.C
        assert 0.15 * static_rating_bound(*size) > seat.C0


def test_no_full_complement_exceeds_the_bound_of_a_size() -> None:
    """Whole numbers of rollers and balls of every diameter that fit, by ISO 281 and ISO 76.

    Factors at their greatest: rollers b_m 1.15 and f_c 89, C0 44; balls b_m 1.3 and f_c 60, C0 16.
    """
    for outside, width in ((16.0, 5.0), (47.0, 17.5), (90.0, 23.0), (200.0, 80.0)):
        most, still = 0.0, 0.0
        for size in np.linspace(0.02, 0.49, 95) * outside:
            circle = outside - size
            count = int(np.pi / np.arcsin(size / circle)) if size < circle else 0
            rows = int(width / size)
            rollers = 1.15 * 89.0 * width ** (7 / 9) * count**0.75 * size ** (29 / 27)
            balls = 1.3 * 60.0 * rows**0.7 * count ** (2 / 3) * size**1.8
            most = max(most, rollers, balls)
            still = max(still, 44.0 * (1.0 - size / circle) * count * width * size,
                        16.0 * rows * count * size**2)  # fmt: skip
        bound = float(rating_bound(1e-3 * outside, 1e-3 * width))
        assert 0.5 * bound < most < bound / 1.4
        assert 0.4 * static_rating_bound(1e-3 * outside, 1e-3 * width) < still
        assert still < static_rating_bound(1e-3 * outside, 1e-3 * width) / 1.4


# --- the checks ------------------------------------------------------------------------------

BY_ID = {declared.id: declared for declared in CHECKS}
FAILING = {
    ("camshaft.bearing_spacing", "camshaft.cam_position"): ("bearing_gap", "of no width"),
    ("camshaft.cam_position",): ("bearing_gap", "fork to bearing 1"),
    ("roller.fork.cheek_height",): ("fork_shaft_gap", "shaft taken as 30 mm thick"),
}
"""Faults of the file that no number contradicts: the check that fails, and its remark."""
STATED = {"camshaft.bearing_width": "16 mm", "camshaft.gear.machine_shaft_diameter": "16 mm"}


def solved(case: Case) -> Solution:
    return solution(case, case.contour(given_lift(case)), Tier.PREVIEW, torques={}, positions=36)


@cache
def assembled() -> Solution:
    """The mended case, with the two lengths that it leaves out."""
    return solved(with_values(sound(), STATED))


def gap(name: str, of: Solution) -> float:
    made = BY_ID[name](of)
    assert made is not None
    assert made.demand is not None
    return made.demand


def test_the_mended_case_passes_every_check_of_its_assembly() -> None:
    for name in ("bearing_gap", "gear_gap", "machine_shaft_gap", "fork_shaft_gap", "fork_gap",
                 "guide_gap"):  # fmt: skip
        made = BY_ID[name](assembled())
        assert made is not None
        assert made.status == "pass", made


@pytest.mark.parametrize(("keys", "expected"), list(FAILING.items()))
def test_each_other_fault_fails_the_check_of_its_name(
    keys: tuple[str, ...], expected: tuple[str, str]
) -> None:
    """Alone in an otherwise sound case; no other check of the assembly fails."""
    name, words = expected
    every = checks_of(solved(case_of(tables(*keys))))
    failing = {one.id: one for one in every if one.must_have and one.status == "fail"}
    assert name in failing
    assert failing.keys() & {"gear_gap", "machine_shaft_gap", "fork_gap", "guide_gap"} == set()
    assert words in failing[name].note
    assert verdict(every) == "fail"


@pytest.mark.parametrize(
    ("values", "name", "words"),
    [
        ({"camshaft.gear_position": "-15 mm"}, "bearing_gap", "gear to bearing 1"),
        ({"camshaft.gear_position": "58 mm"}, "gear_gap", "fork to gear"),
        ({"camshaft.gear_position": "30 mm"}, "gear_gap", " to gear"),
        ({"camshaft.gear_radius": "30 mm"}, "machine_shaft_gap", "cam to machine shaft"),
        ({"camshaft.mesh_angle": "0 deg"}, "machine_shaft_gap", "roller to machine shaft"),
        ({"roller.pin.span": "22 mm"}, "fork_gap", "cheek to roller"),
        ({"roller.fork.cheek_length": "23 mm"}, "fork_gap", "bridge to roller"),
        ({"roller.fork.cheek_length": "32 mm"}, "guide_gap", ""),
        ({"camshaft.diameter": "100 mm"}, "fork_shaft_gap", "100 mm"),
        ({"cam.width": "18.5 mm", "roller.fork.cheek_height": "50 mm"}, "fork_gap", "cheek to cam"),
    ],
)  # fmt: skip
def test_siblings_of_the_faults_fail_too(values: dict[str, str], name: str, words: str) -> None:
    made = BY_ID[name](solved(with_values(sound(), STATED | values)))
    assert made is not None
    assert made.status == "fail", made
    assert words in made.note


def test_what_a_case_leaves_out_is_bounded_or_missing() -> None:
    """A bearing at most as wide as its bore, a machine shaft at most as thick as its pinion."""
    cases = [
        ({}, "bearing_gap", "not_evaluated", "camshaft.bearing_width"),  # 25 - 10 - 30/2 mm
        ({"camshaft.gear_position": "-30 mm"}, "bearing_gap", "pass", "an upper bound"),
        ({"camshaft.gear_position": "-9 mm"}, "bearing_gap", "fail", "of no width"),
        ({}, "machine_shaft_gap", "not_evaluated", "camshaft.gear.machine_shaft_diameter"),
        ({"camshaft.gear_radius": "48 mm"}, "machine_shaft_gap", "pass", "wide as its pinion"),
        ({"camshaft.gear_radius": "30 mm"}, "machine_shaft_gap", "fail", "of no diameter"),
    ]
    for values, name, status, words in cases:
        made = BY_ID[name](solved(with_values(sound(), values)))
        assert made is not None
        assert (made.status, words in made.note) == (status, True), made
    at_pinion = with_values(sound(), {"camshaft.gear.machine_shaft_diameter": "0 mm"})
    assert BY_ID["machine_shaft_gap"](solved(at_pinion)) is None


def circle(radius: float, count: int = 1440) -> Array:
    turn = np.arange(count) * (2.0 * np.pi / count)
    return radius * np.array([np.cos(turn), np.sin(turn)])


def turned(points: Array, angle: float) -> Array:
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]]) @ points


def apart(one: Array, other: Array) -> float:
    """Distance of two polygons (2, n) that do not cross, m: corners of each from edges of both."""

    def corners(points: Array, ring: Array) -> float:
        near = cKDTree(ring.T).query(points.T)[0]
        few = points[:, np.argsort(near)[:8]]
        along = np.roll(ring, -1, axis=1) - ring
        edges = np.any(along != 0.0, axis=0)
        along, off = along[:, None, edges], few[:, :, None] - ring[:, None, edges]
        share = np.clip((off * along).sum(axis=0) / (along**2).sum(axis=0), 0.0, 1.0)
        return float(np.hypot(*(off - share * along)).min())

    return min(corners(one, other), corners(other, one))


@pytest.mark.parametrize(
    ("mesh_angle", "offset", "cheeks"), [(180.0, 0.0, 22.0), (90.0, 3.0, 22.0), (25.0, 3.0, 60.0)]
)
def test_gaps_in_the_plane_of_the_cam_by_polygons_over_the_turn(
    mesh_angle: float, offset: float, cheeks: float
) -> None:
    """machine_shaft_gap and fork_shaft_gap within 1 um: outlines, turned through the cam's turn.

    The cam turns clockwise under a follower that rises along x; cheeks with round ends, the bridge
    and 200 mm of stem as wide as them.
    """
    values = STATED | {
        "camshaft.mesh_angle": f"{mesh_angle} deg", "cam.offset": f"{offset} mm",
        "roller.fork.cheek_height": f"{cheeks} mm", "camshaft.gear_radius": "70 mm",
    }  # fmt: skip
    of = solved(with_values(sound(), values))
    machine, pitch = of.machine, of.contour.pitch
    contour, shaft = of.contour.polygon(3600), circle(0.015)
    mesh = np.radians(mesh_angle)
    cranks = [  # on either side of the follower: the check takes the worse side of an offset
        circle(0.008) + 0.07 * 1.5 * np.array([[np.cos(mesh)], [side * np.sin(mesh)]])
        for side in (1.0, -1.0)
    ]
    half, radius = 0.5e-3 * cheeks, machine.roller.radius
    end = circle(half)
    length = np.tile(np.linspace(0.0, 0.2, 201), 2)
    sides = np.array([length, np.repeat([half, -half], 201)])
    cheek = np.concatenate([end[:, end[0] < 0.0], sides], axis=1)
    order = np.argsort(np.arctan2(cheek[1], cheek[0] - 0.05))
    cheek, roller = cheek[:, order], circle(radius)
    to_shaft, to_crank = [], []
    for theta in np.arange(0.0, 2.0 * np.pi, np.pi / 15.0):
        # the pitch curve is that of the cam's frame: turned back, the roller centre is on the axis
        place = turned(pitch.points(np.array([theta])), -theta)
        assert abs(abs(place[1, 0]) - machine.cam.offset) < 1e-9
        to_shaft.append(apart(cheek + place, shaft))
        parts = [turned(contour, -theta), roller + place, cheek + place]
        to_crank += [apart(each, crank) for each in parts for crank in cranks]
    assert gap("fork_shaft_gap", of) == pytest.approx(min(to_shaft), abs=1e-6)
    assert gap("machine_shaft_gap", of) == pytest.approx(min(to_crank), abs=1e-6)


def box(radii: tuple[float, float], ends: tuple[float, float], steps: int = 40) -> Array:
    """Outline of a body round the stem in the half plane of its axis: along it, and from it."""
    along, across = np.linspace(*ends, steps), np.linspace(*radii, steps)
    return np.concatenate(
        [[along, np.full(steps, radii[0])], [np.full(steps, ends[1]), across],
         [along[::-1], np.full(steps, radii[1])], [np.full(steps, ends[0]), across[::-1]]], axis=1,
    )  # fmt: skip


SEATS = [
    ({}, "between"),
    ({"spring.design.mean_diameter": "25 mm"}, "stem"),  # coils of 8.5 mm touch a stem of 16 mm
    ({"guides.spacing": "95 mm", "spring.design.mean_diameter": "42 mm"}, "above"),
    ({"spring.seat_height": "85 mm"}, "between"),
    ({"spring.seat_height": "40 mm", "follower.overhang_at_max_lift": "125 mm"}, "below"),
    ({"spring.seat_height": "40 mm", "follower.overhang_at_max_lift": "62 mm"}, "around"),
    (
        {
            "spring.seat_height": "40 mm",
            "follower.overhang_at_max_lift": "62 mm",
            "guides.a.wall": "5 mm",
        },
        "around",
    ),
]


@pytest.mark.parametrize(("values", "where"), SEATS)
def test_spring_seats_and_guides_by_outlines_over_the_turn(
    values: dict[str, str], where: str
) -> None:
    """spring_gap within 1 um: outlines in the plane of the stem's axis, at each lift of the turn.

    Where the spring is fixed it rests on guide B or on the housing: those two are not compared.
    """
    known = {"spring.seat_thickness": "6 mm", "follower.stem_length": "330 mm"}
    of = solved(with_values(sound(), STATED | known | values))
    lift, machine, spring = of.contour.lift, of.machine, of.machine.spring
    top, design, stem = lift.highest.value, spring.design, 0.5 * machine.stem.diameter
    assert design is not None
    guides = machine.guides
    middle = machine.overhang_at_max_lift
    bushes = [
        box(
            (stem, stem + (bush.wall if where == "around" else 0.02)),
            (at - 0.5 * bush.length, at + 0.5 * bush.length),
        )
        for at, bush in ((middle, guides.a), (middle + guides.spacing, guides.b))
    ]
    inner, outer = (0.5 * (design.mean_diameter + s * design.wire_diameter) for s in (-1.0, 1.0))
    long = design.free_length - spring.preload / spring.rate
    seat = {
        "between": bushes[1][0].min() - long + top, "stem": 0.33, "above": 0.33,
    }.get(where, 0.0)  # fmt: skip
    if "spring.seat_height" in values:
        seat = 1e-3 * float(values["spring.seat_height"].split()[0])
    least = []
    for raised in np.append(lift(np.linspace(0.0, 2.0 * np.pi, 181)), [0.0, top]):
        face = seat - top + raised
        fixed = seat - top + long
        collar = box((stem, outer), (face - 0.006, face))
        least += [apart(collar, bush) for bush in bushes]
        if seat < 0.33:
            rod = box((0.0, stem), (raised - top + 0.001, raised - top + 0.33))
            coils = box((inner, outer), (face, fixed))
            least.append(apart(coils, rod))
            least += [apart(coils, bush) for bush in bushes if where == "around"]
            assert where in ("below", "around") or fixed <= bushes[1][0].min() + 1e-9
    assert gap("spring_gap", of) == pytest.approx(min(least), abs=1e-6)


WEIGHTS = [
    ({"position": "35 mm", "radius": "31.5 mm", "width": "29 mm"}, "fork"),
    ({"position": "35 mm", "radius": "20 mm", "width": "39.6 mm"}, "bearing"),
    ({"position": "51 mm", "radius": "40 mm", "width": "3.2 mm"}, "corner"),
    ({"position": "-8.5 mm", "radius": "45 mm", "width": "0.6 mm"}, "gear or bearing"),
    ({"position": "35 mm"}, "half ring"),
]


@pytest.mark.parametrize(("values", "where"), WEIGHTS)
def test_counterweight_by_outlines_in_the_plane_of_the_shaft(
    values: dict[str, str], where: str
) -> None:
    """counterweight_gap within 1 um: outlines in the half plane of the shaft, along it and from it.

    The follower passes with its whole depth from its lowest place on; the bearings of 62 mm; the
    machine shaft lies 60 mm from the camshaft.
    """
    key = "camshaft.counterweight"
    known = {f"{key}.{name}": value for name, value in values.items()}
    known[f"{key}.residual"] = "20 g mm"
    of = solved(with_values(sound(), STATED | known))
    body = counterweight_body(
        weight := of.case.camshaft.counterweight,
        weight.set_against(balance(of.machine.cam, of.contour).as_made)[0],
        of.numbers,
    )
    middle, half = 0.035 + float(body.position), 0.5 * float(body.width)
    ring = box((0.015, float(body.radius)), (middle - half, middle + half), 400)
    lowest = of.machine.cam.prime_radius - of.machine.roller.radius
    deep = 0.014 + 0.0003  # of pin and cheeks, at the axial offset of the roller
    parts = [box((lowest, 0.2), (0.035 - deep, 0.035 + deep), 2000)]
    parts += [box((0.015, 0.031), (at - 0.008, at + 0.008)) for at in (0.0, 0.07)]
    parts.append(box((0.015, 0.06), (-0.035, -0.015)))
    parts.append(box((0.052, 0.068), (-0.1, 0.2)))
    least = min(apart(ring, each) for each in parts)
    if where == "half ring":
        assert least == pytest.approx(0.0004, abs=1e-6)
    assert gap("counterweight_gap", of) == pytest.approx(least, abs=1e-6)


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ({"radius": "45 mm", "width": "29 mm"}, "counterweight_gap"),  # under the roller
        ({"radius": "31.5 mm", "width": "55 mm"}, "counterweight_gap"),  # into the bearings
        ({"radius": "31.5 mm", "width": "16 mm"}, "counterweight_unbalance"),  # next to none
        ({"radius": "16 mm", "width": "29 mm"}, "counterweight_unbalance"),  # no thicker than 1 mm
        ({"position": "-25 mm", "radius": "40 mm", "width": "9 mm"}, "counterweight_gap"),  # gear
    ],
)
def test_a_counterweight_without_room_fails(values: dict[str, str], name: str) -> None:
    known = {f"camshaft.counterweight.{key}": value for key, value in values.items()}
    known |= {"camshaft.counterweight.residual": "20 g mm"}
    made = BY_ID[name](solved(with_values(sound(), STATED | known)))
    assert made is not None
    assert made.status == "fail", made


def test_a_sector_of_the_counterweight_has_its_unbalance() -> None:
    """First moment of a drawn sector beside the cam, summed over its area; width and its inverse.

    counterweight_unbalance fails where no sector has it.
    """
    place, cam = np.array([0.0, 3.0, 7.0, 12.0, 40.0]), 15.5
    for width in np.linspace(0.1, 90.0, 77):
        cells = np.linspace(-0.5, 0.5, 200_001) * width + place[:, None]
        counted = (np.abs(cells) > 0.5 * cam).mean(axis=1) * width
        beside = width_beside(width, place, cam)
        assert beside == pytest.approx(counted, abs=2e-3)
        some = beside > 0.0
        again = width_beside(width_for(beside, place, cam), place, cam)
        assert again[some] == pytest.approx(beside[some], rel=1e-12)
    body = CounterweightBody.of(0.0, cam, (31.5, None), 15.0, 7.85e-3, 2094.0)
    half = body.half_angle(1500.0)
    r, phi = np.meshgrid(np.linspace(15.0, 31.5, 1501), np.linspace(-half, half, 1501))
    area = np.trapezoid(np.trapezoid(r**2 * np.cos(phi), r[0], axis=1), phi[:, 0])
    assert 7.85e-3 * area * float(body.width - cam) == pytest.approx(1500.0, rel=1e-6)
    assert float(body.capacity) == pytest.approx(2094.0, rel=1e-12)


def test_gaps_along_the_camshaft_by_counting_free_micrometres() -> None:
    """bearing_gap, gear_gap and fork_gap: cells of 1 um that neither of two parts fills."""
    cells = 1e-6 * (np.arange(-200_000, 200_000) + 0.5)

    def filled(*ends: tuple[float, float]) -> Array:
        return np.any([(low < cells) & (cells < high) for low, high in ends], axis=0)

    def free(one: Array, other: Array) -> float:
        places = np.flatnonzero(one), np.flatnonzero(other)
        gaps = [abs(places[0][:, None] - places[1][[0, -1]][None, :]).min() - 1,
                abs(places[1][:, None] - places[0][[0, -1]][None, :]).min() - 1]  # fmt: skip
        return 1e-6 * min(gaps)

    cam = filled((0.035 - 0.00775, 0.035 + 0.00775))
    middle = 0.035 + 0.0003  # of the roller at its axial offset, on either side
    fork = filled(*((m + s * 0.0115 - 0.0025, m + s * 0.0115 + 0.0025)
                    for m in (middle, 0.035 - 0.0003) for s in (-1, 1)))  # fmt: skip
    gear = filled((-0.035, -0.015))
    bearings = [filled((-0.008, 0.008)), filled((0.062, 0.078))]
    parts = (cam, fork, gear)
    assert gap("bearing_gap", assembled()) == pytest.approx(
        min(free(part, each) for part in parts for each in bearings), abs=1e-6
    )
    assert gap("gear_gap", assembled()) == pytest.approx(
        min(free(gear, cam), free(gear, fork)), abs=1e-6
    )
    cheek = filled((middle + 0.0115 - 0.0025, middle + 0.0115 + 0.0025))
    roller = filled((middle - 0.00875, middle + 0.00875))
    assert gap("fork_gap", assembled()) == pytest.approx(free(cheek, roller), abs=1e-6)


@pytest.mark.parametrize("pressure_angle", [15.0, 20.0, 25.0])
def test_a_rack_cuts_no_tooth_of_the_involute_within_the_limit(pressure_angle: float) -> None:
    """tooth_count: the involute that a rack of a depth of one module leaves, by rolling it.

    The tip of the rack goes on below the foot of the involute, the base circle along the line of
    action, where (z/2) sin^2(alpha) < 1 module: at 17.1 teeth of 20 deg. The limit is 14/17.1 of
    that number, the practical one.
    """
    angle, counts = np.radians(pressure_angle), np.arange(8, 60)
    reach = []
    for count in counts:
        pitch = 0.5 * count  # of a module of 1; the rack's flank touches along the line of action
        along = np.linspace(0.0, 2.0, 200_001) / np.sin(angle)  # from the pitch point
        foot = pitch * np.sin(angle)  # where the line of action touches the base circle
        reach.append(float((along * np.sin(angle))[along <= foot].max()))
    undercut = counts[np.array(reach) < 1.0 - 1e-4]
    case = with_values(sound(), STATED | {"camshaft.pressure_angle": f"{pressure_angle} deg"})
    made = BY_ID["tooth_count"](solved(case))
    assert made is not None
    assert made.limit is not None
    assert made.demand == 20.0
    theory = 2.0 / np.sin(angle) ** 2
    assert undercut.max() < theory <= undercut.max() + 1
    assert made.limit == pytest.approx(theory * 14.0 / 17.0973, rel=1e-4)


def test_few_teeth_of_a_ratio_fail() -> None:
    few = {"camshaft.gear.teeth": 26, "camshaft.gear.pinion_teeth": 13}
    made = BY_ID["tooth_count"](solved(with_values(sound(), STATED | few)))
    assert made is not None
    assert made.status == "fail"
    fourteen = {"camshaft.gear.teeth": 28, "camshaft.gear.pinion_teeth": 14}
    made = BY_ID["tooth_count"](solved(with_values(sound(), STATED | fourteen)))
    assert made is not None
    assert made.status == "pass"
    assert "module 2.857 mm" in made.note


@pytest.mark.parametrize("room", ["90 mm", None])
def test_a_synthesis_keeps_off_the_machine_shaft(tmp_path: Path, room: str | None) -> None:
    """With and without a limit of the cam radius: 54 mm of centre distance leave 45.8 mm."""
    first = tmp_path / "first.toml"
    text = first_case("first").text.replace('gear_radius = "40 mm"', 'gear_radius = "36 mm"')
    line = next(line for line in text.splitlines() if line.startswith("cam_radius = "))
    first.write_text(text if room else text.replace(line, ""), encoding="utf-8")
    case = read_case(first)
    limits = limits_of(case)["cam_radius"]
    assert limits["machine_shaft_gap"] == pytest.approx(0.054 - 0.008 - 0.0002, abs=1e-12)
    trial = preview_case(case, corners=False)
    judged = {one.id: one for one in trial.checks}
    assert judged["machine_shaft_gap"].status == "pass"
    assert judged["machine_shaft_gap"].utilisation == pytest.approx(1.0, abs=0.2)
    assert judged["torque_reduction"].status == "pass"


def test_an_overhung_pin_is_counted_from_the_face_of_its_cheek() -> None:
    """Span of 12 mm to the middle of the roller of 17.5 mm, a cheek of 5 mm beyond it."""
    text = tables()
    put(text, "roller.pin.mounting", "overhung")
    put(text, "roller.pin.span", "12 mm")
    of = solved(with_values(case_of(text), STATED | {"camshaft.gear_position": "-40 mm"}))
    assert gap("fork_gap", of) == pytest.approx(0.0025, abs=1e-12)  # to the bridge
    assert gap("bearing_gap", of) == pytest.approx(0.035 - 0.0173 - 0.008, abs=1e-12)
    deeper = {"roller.fork.cheek_length": "30 mm", "follower.overhang_at_max_lift": "52 mm"}
    of = solved(with_values(of.case, deeper))
    assert gap("fork_gap", of) == pytest.approx(0.012 - 0.00875, abs=1e-12)


def test_a_flat_face_passes_the_machine_shaft_by_its_width_and_depth() -> None:
    """Distances of points beside, below and obliquely below the face of the shipped case."""
    case = read_case(DATA.parents[1] / "cases" / "gx120-flat-face.toml")
    numbers = Numbers({}, case)
    half = 0.5 * case.follower.face.width
    assert from_follower(numbers, 0.0, half + 0.003) == pytest.approx(0.003, abs=1e-15)
    assert from_follower(numbers, 0.004, half + 0.003) == pytest.approx(0.005, abs=1e-15)
    assert from_follower(numbers, 0.004, 0.0) == pytest.approx(0.004, abs=1e-15)
    assert numbers["follower.half_depth"] == 0.5 * case.follower.face.depth
