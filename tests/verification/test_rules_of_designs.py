"""The relations of a case's numbers refuse the same in a case file and in arrays of designs."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import CamError
from camwright.pipeline.base.quantities import In
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.case.case_values import quantity_of, value_of
from camwright.pipeline.case.consistency import Rule, rules
from camwright.pipeline.screening.design_factors import ARRAYS, is_array, refusals
from camwright.pipeline.screening.design_screening import screen_designs

ROOT = Path(__file__).parents[2]
FAR, NEAR = (0.02, 50.0), (0.98, 1.02)
"""Factors of the value at a key, and of the bound of a rule."""
STRUCTURE = {
    "cam.key.length", "cam.key.shaft_depth", "cam.key.height",
    "camshaft.gear.machine_shaft_diameter",
    "camshaft.bearing_rating", "camshaft.bearing_static_rating", "guides.a.diameter",
    "guides.b.diameter", "solver.positions", "spring.rate_tolerance", "spring.preload_tolerance",
    "tolerances.friction",
}  # fmt: skip
"""Keys of the rules in which no key of an array stands: designs that differ there are read anew."""
KEYWAY = {"cam.keyway.width": "4 mm", "cam.keyway.depth": "1.8 mm"}
CASES = {
    "gx120": ("cases/gx120.toml", {
        **KEYWAY, "limits.return_pressure_angle": "35 deg", "limits.overspeed": "4000 rpm",
        "workshop.tool_radius": "20 mm", "limits.tool_radius": "25 mm", "tolerances.source": "",
    }),
    "average": ("cases/gx120.toml", {"smoothing.kind": "moving_average"}),
    "redesign": ("cases/gx120-redesign.toml", {}),
    "flat": ("cases/gx120-flat-face.toml", {}),
    "lift": ("cases/papers/petrescu_c.toml", {}),
}  # fmt: skip


@cache
def case(name: str) -> Case:
    file, values = CASES[name]
    return with_values(read_case(ROOT / file), values)


def array_keys(of: Case) -> tuple[str, ...]:
    loads = (f"load_case[{k}].{name}" for k in range(len(of.load_cases))
             for name in ("speed", "preload"))  # fmt: skip
    return tuple(key for key in (*ARRAYS, *loads) if is_array(of, key, [1.0]))


def read_by(rule: Rule, of: Case) -> set[str]:
    """Keys that a rule reads."""
    read: set[str] = set()

    def at(key: str) -> float:
        read.add(key)
        value = value_of(of, key)
        return np.nan if value is None else float(value)

    rule.breaks(at)
    return read


def tried(of: Case, key: str, rule: Rule | None = None) -> list[float]:
    """Values on both sides of the present one, and of the bound of a rule."""
    stated, quantity = value_of(of, key), quantity_of(key)
    values = [] if stated is None else [float(stated) * factor for factor in FAR]
    if rule is not None and rule.bound is not None and rule.key == key:
        bound = float(rule.bound(lambda each: float(value_of(of, each) or np.nan)))
        values += [bound * factor for factor in NEAR if bound > 0.0]
    within = isinstance(quantity, In)
    return [value for value in values if not within or quantity.holds(value)]


def of_the_reader(of: Case, key: str, value: float) -> str:
    try:
        with_values(of, {key: value})
    except CamError as error:
        return str(error)
    return ""


def in_arrays(of: Case, key: str, values: list[float]) -> list[str]:
    return refusals(of, {key: np.array(values)}, np.full(len(values), np.nan))


def broken() -> Iterator[tuple[str, str, str]]:
    for name in CASES:
        for number, rule in enumerate(rules(case(name))):
            for key in sorted(read_by(rule, case(name)) & set(array_keys(case(name)))):
                yield name, f"{number} {rule.key}", key


@pytest.mark.parametrize(("name", "which", "key"), list(broken()))
def test_a_rule_refuses_the_same_numbers_of_one_case_and_of_many(
    name: str, which: str, key: str
) -> None:
    of, number = case(name), int(which.split()[0])
    rule = list(rules(of))[number]
    values = tried(of, key, rule)
    words = in_arrays(of, key, values) if values else []
    for value, array in zip(values, words, strict=True):
        one = of_the_reader(of, key, value)
        assert bool(one) == bool(array), (value, one, array)
        assert one.partition(" = ")[0] == array.partition(" = ")[0]


@pytest.mark.parametrize("name", CASES)
def test_every_rule_has_an_array_or_none_of_its_keys_has(name: str) -> None:
    of = case(name)
    known = set(array_keys(of))
    without = {rule.key for rule in rules(of) if not read_by(rule, of) & known}
    if of.smoothing.kind == "constrained":  # a smoother of another kind has arrays
        without = {key for key in without if not key.startswith("smoothing.")}
    assert without <= STRUCTURE


@pytest.mark.parametrize(
    "name",
    ["gx120", pytest.param("flat", marks=pytest.mark.slow),
     pytest.param("lift", marks=pytest.mark.slow)],
)  # fmt: skip
def test_every_key_of_an_array_is_refused_as_in_the_file(name: str) -> None:
    of = case(name)
    for key in array_keys(of):
        if value_of(of, key) is None:
            continue
        values = tried(of, key)
        for value, array in zip(values, in_arrays(of, key, values), strict=True):
            one = of_the_reader(of, key, value)
            if "twice the greatest |s' - cam.offset|" in one:
                continue  # known with the lift alone: see test_screening_designs
            assert bool(one) == bool(array), (key, value, one, array)


@pytest.mark.parametrize(
    ("key", "text", "words"),
    [
        ("limits.return_pressure_angle", "20 deg",
         "limits.return_pressure_angle = 20 deg, must be >= limits.pressure_angle = 30 deg"),
        ("limits.pressure_angle", "40 deg",
         "limits.return_pressure_angle = 35 deg, must be >= limits.pressure_angle = 40 deg"),
        ("smoothing.spacing", "70 deg",
         "smoothing.points = 12, must be <= 10.29, a cycle of 720 deg over smoothing.spacing = 70"),
        ("mechanism.compensation", 0.5, ""),
    ],
)  # fmt: skip
def test_screening_says_what_the_reader_says(key: str, text: str | float, words: str) -> None:
    of = case("gx120")
    (row,) = screen_designs(of, {key: [text]})["message"]
    one = ""
    try:
        with_values(of, {key: text})
    except CamError as error:
        one = str(error)
    assert row == one
    assert row.startswith(words) if words else row == ""


def test_the_first_broken_rule_speaks() -> None:
    """Of two broken relations the one that stands first: the order is a part of the messages."""
    of = case("gx120")
    offset, back = of.cam.prime_radius * 1.1, np.radians(20.0)
    numbers = {"cam.offset": np.array([offset]), "limits.return_pressure_angle": np.array([back])}
    (words,) = refusals(of, numbers, np.array([np.nan]))
    assert words.startswith("cam.offset = ")
    assert [rule.key for rule in rules(of)].index("cam.offset") < [
        rule.key for rule in rules(of)
    ].index("limits.return_pressure_angle")
