"""Rules of every check that is declared by a measure of the loaded cam.

A measure is evaluated for one cam, for thousands of designs and at pairs of load case and angle,
and differentiated by a complex step: it never reduces over the angles, never drops an imaginary
part and never turns a NaN into a pass.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from swung_face import face_text
from test_extension_spring import whole as extension_text
from test_gas_spring import LIMITS as GAS_LIMITS
from test_gas_spring import TABLE as GAS_TABLE
from test_gas_spring import gas_case
from test_torsion_spring import case as torsion_case

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.lift import Jet
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.registry import CHECKS, DECLARED
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.solved_cam import numbers_of
from camwright.pipeline.smoothing.allowables import travel_limits
from camwright.pipeline.smoothing.constraints import CONSTRAINTS

CASES = Path(__file__).parents[2] / "cases"
POINTS = 180


CASE = {
    **{kind: read_case(CASES / f"{name}.toml")
       for kind, name in (("roller", "gx120-redesign"), ("face", "gx120-flat-face"))},
    "gas spring": gas_case(table=f"{GAS_TABLE}{GAS_LIMITS}"),
    "torsion spring": torsion_case(),
    "extension spring": parse_case(extension_text()),
    **{f"{kind} face of an arm": parse_case(face_text(kind)) for kind in ("flat", "curved")},
}  # fmt: skip
"""Machines; with a spring or a face of its own its checks alone."""
SLENDER = {"spring.design.end_factor": 2.0}  # a stable spring does not buckle at any lift
SHAFT = {"camshaft.gear.machine_shaft_diameter": 0.016}  # none ends at its pinion, without a check
NUMBERS = {name: numbers_of(case, machines(case)) | SLENDER | SHAFT for name, case in CASE.items()}
OF_SPRINGS = {"gas spring": "gas_spring", "torsion spring": "torsion_spring",
              "extension spring": "extension_spring"}  # fmt: skip
OF_FACES = {f"{kind} face of an arm": "swung_face" for kind in ("flat", "curved")}
MEASURED = [
    pytest.param(one, name, id=f"{one.id}, {name}")
    for one in CHECKS
    if one.measured is not None
    for name, case in CASE.items()
    if OF_SPRINGS.get(name, one.part) == one.part and one.concerns(machines(case)[0])
    if OF_FACES.get(name, one.needs) == one.needs
]
BY_ANGLE = [each for each in MEASURED if each.values[0].measured.reduce != "case"]


def jet() -> Jet:
    """Lift of three harmonics and its derivatives, m/rad^k."""
    theta = np.arange(POINTS) * (FULL_TURN / POINTS)
    waves = ((4e-3, 1.0, 0.3), (1e-3, 2.0, 1.1), (3e-4, 3.0, 2.0))
    parts = [
        sum(size * order**k * np.cos(order * theta + shift + 0.5 * np.pi * k)
            for size, order, shift in waves)
        for k in range(4)
    ]  # fmt: skip
    return Jet(0.006 + parts[0], *parts[1:])


def measured(one: Declaration, cam: LoadedCam) -> Array:
    assert one.measure is not None
    return one.measure(cam)


@pytest.mark.parametrize(("one", "follower"), BY_ANGLE)
def test_a_measure_is_that_of_each_angle(one: Declaration, follower: str) -> None:
    whole = measured(one, LoadedCam(jet(), NUMBERS[follower], 0.012))
    points = np.array([5, 5, 100, 171, 2])
    some = measured(one, LoadedCam(jet().at(lambda each: each[points]), NUMBERS[follower], 0.012))
    np.testing.assert_array_equal(some, whole[points])
    rows = jet().at(lambda each: np.stack([each, each[::-1]]))
    np.testing.assert_array_equal(
        measured(one, LoadedCam(rows, NUMBERS[follower], 0.012))[0], whole
    )


@pytest.mark.parametrize(("one", "follower"), BY_ANGLE)
def test_the_complex_step_is_the_difference_quotient(one: Declaration, follower: str) -> None:
    draw = np.random.default_rng(1)
    way = [draw.normal(size=POINTS) * np.abs(each).max() for each in jet()]

    def at(step: complex) -> Array:
        moved = Jet(*(a + step * b for a, b in zip(jet(), way, strict=True)))
        return measured(one, LoadedCam(moved, NUMBERS[follower], 0.012))

    exact = np.imag(at(1e-30j)) / 1e-30
    quotient = (at(1e-6) - at(-1e-6)) / 2e-6
    near = np.abs(exact - quotient) <= 1e-5 * np.abs(exact).max()
    assert np.mean(near) > 0.97  # but where a magnitude has its kink
    assert np.any(exact != 0.0)


@pytest.mark.parametrize(("one", "follower"), MEASURED)
def test_an_unknown_measure_gives_no_verdict(one: Declaration, follower: str) -> None:
    """NaN stays NaN on the way to the demand, and the check still applies."""
    how = one.measured
    assert how is not None
    for unknown in (np.float64(np.nan), np.full((3, 1), np.nan)):
        value = how.value(unknown, NUMBERS[follower])
        assert np.isnan(value).all()
        assert np.all(how.applies(value, NUMBERS[follower]))


@pytest.mark.parametrize(("one", "follower"), MEASURED)
def test_the_bound_of_a_measure_is_at_the_limit_of_the_demand(
    one: Declaration, follower: str
) -> None:
    """Of a check that the synthesis keeps by its measure: a utilisation of 1 is at the limit."""
    how = one.measured
    assert how is not None
    if how.kept is None or how.kept.use is not None:
        pytest.skip("another form of the inequality, which the agreement of constraints holds")
    for limit in (0.3, 0.6):
        bound = how.bound(limit, NUMBERS[follower])
        assert bound is not None
        demand = how.value(np.float64(bound), NUMBERS[follower])
        assert demand == pytest.approx(limit, rel=1e-14)


def slender(case: Case) -> Case:
    """The case with a spring that buckles, where it is wound."""
    design = case.spring.design
    if design is None:
        return case
    spring = replace(case.spring, design=replace(design, end_factor=2.0))
    return case.model_copy(update={"spring": spring})


@pytest.mark.parametrize("name", [name for name in CASE if name not in OF_FACES])
def test_a_check_at_maximum_lift_is_at_its_limit_at_the_greatest_lift_allowed(name: str) -> None:
    """What the synthesis keeps of a spring, by bisection on the measure of its check."""
    case = slender(CASE[name])
    numbers, allowed = numbers_of(case, machines(case)), travel_limits(case)
    kept = [each.values[0] for each in MEASURED
            if each.values[1] == name and each.values[0].measured.reduce == "top"
            and each.values[0].measured.kept is not None]  # fmt: skip
    assert {each.id for each in kept} - {"spring_travel"} <= set(allowed)
    for one in kept:
        if one.id in allowed:  # the machines of the gas and torsion springs state no travel
            top = np.array([allowed[one.id]])
            worst = measured(one, LoadedCam(Jet(top, 0.0 * top, 0.0 * top), numbers))
            demand, limit = one.measured.value(worst, numbers), one.measured.allowed(numbers)
            assert float(demand[0]) == pytest.approx(float(limit.value), rel=1e-9), one.id
    count = {"roller": 7, "face": 7, "gas spring": 2, "torsion spring": 2, "extension spring": 6}
    assert len(allowed) == count[name]


def test_what_the_synthesis_bounds_has_words() -> None:
    """Of a rating the check that sets it says what is bounded; of a row the row does."""
    rated = {each.check for each in CONSTRAINTS if each.row is None}
    grouped = {one.id for one in CHECKS
               if one.scales_with or (one.measured and one.measured.kept
                                      and one.measured.kept.group)}  # fmt: skip
    unnamed = {name for name in rated | grouped if not DECLARED[name].kept_as}
    assert unnamed == {"guide_gap", "concave_radius"}  # in the words of their rows
    words = [one.kept_as for one in CHECKS if one.kept_as]
    assert len(set(words)) == len(words)
    idle = {one.id for one in CHECKS if one.kept_as} - rated - grouped
    assert idle == {
        *("shakedown_traction", "guide_expansion_A", "guide_expansion_B", "pivot_expansion")
    }  # estimated


def test_a_check_that_is_declared_as_kept_is_a_constraint() -> None:
    """By its row or the limit of a part; of a group one, at maximum lift that of the travel."""
    groups = {one.measured.kept.group for one in CHECKS
              if one.measured and one.measured.kept}  # fmt: skip
    listed = {each.check for each in CONSTRAINTS}
    assert groups - {""} <= listed
    for one in CHECKS:
        how = one.measured
        if how is not None and how.kept is not None:
            assert how.kept.group or how.reduce == "top" or one.id in listed, one.id
            assert not how.kept.unit or how.kept.unit == "-" or in_unit(1.0, how.kept.unit), one.id


def test_constraints_of_one_limit_show_it_alike() -> None:
    """By one key in the ratings, at a row or in one unit; with each follower once a group."""
    of_key: dict[str, list[Any]] = {}
    for each in CONSTRAINTS:
        of_key.setdefault(each.key, []).append(each)
    for key, own in of_key.items():
        assert len({each.row and each.row.id for each in own}) == 1, key
        if own[0].row is None:
            assert len({(each.kept.unit, each.kept.falls) for each in own}) == 1, key
            assert len({each.needs for each in own}) == len(own), key
    assert len({each.name for each in CONSTRAINTS}) == len(CONSTRAINTS)
