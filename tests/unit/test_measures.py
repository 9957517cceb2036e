"""Rules of every check that is declared by a measure of the loaded cam.

A measure is evaluated for one cam, for thousands of designs and at pairs of load case and angle,
and differentiated by a complex step: it never reduces over the angles, never drops an imaginary
part and never turns a NaN into a pass.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.arrays import FULL_TURN, Array
from camwright.geometry.lift import Jet
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.machine import machines
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.cycle.loaded_cam import LoadedCam
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solved_cam import numbers_of

CASES = Path(__file__).parents[2] / "cases"
POINTS = 180


def numbers(name: str) -> Numbers:
    """Numbers of a case in its design load case."""
    case = read_case(CASES / f"{name}.toml")
    return numbers_of(case, machines(case))


NUMBERS = {"roller": numbers("gx120-redesign"), "face": numbers("gx120-flat-face")}
MEASURED = [
    pytest.param(one, follower, id=f"{one.id}, {follower}")
    for one in CHECKS
    if one.measured is not None
    for follower in NUMBERS
    if one.needs in ("", follower)
]


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


@pytest.mark.parametrize(("one", "follower"), MEASURED)
def test_a_measure_is_that_of_each_angle(one: Declaration, follower: str) -> None:
    whole = measured(one, LoadedCam(jet(), NUMBERS[follower], 0.012))
    points = np.array([5, 5, 100, 171, 2])
    some = measured(one, LoadedCam(jet().at(lambda each: each[points]), NUMBERS[follower], 0.012))
    np.testing.assert_array_equal(some, whole[points])
    rows = jet().at(lambda each: np.stack([each, each[::-1]]))
    np.testing.assert_array_equal(
        measured(one, LoadedCam(rows, NUMBERS[follower], 0.012))[0], whole
    )


@pytest.mark.parametrize(("one", "follower"), MEASURED)
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
        assert np.all(how.applies(value))


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
