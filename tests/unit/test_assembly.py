"""A machine that cannot be assembled is refused or fails, each fault by its name.

`tests/data/impossible.toml` is a case that somebody wrote to see what passes: `FAULTS` are its six
contradictions, each with the number that mends it.
"""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.shaft_seats import seats
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, with_values
from camwright.pipeline.follower.bearing_life import rating_bound, static_rating_bound

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
    found = tomllib.loads(text)
    for key, value in FAULTS.items():
        if key not in faults:
            put(found, key, value)
    return found


@cache
def sound() -> Case:
    """The case of the file with every fault mended."""
    return case_of(tables())


REFUSED = {
    "camshaft.gear.teeth": "camshaft.gear.teeth = 60, must be 40, mechanism.gear_ratio = 2.0 times"
    " camshaft.gear.pinion_teeth = 20",
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


def test_the_file_is_refused() -> None:
    with pytest.raises(InputError) as refused:
        case_of(tables(*FAULTS))
    assert refused.value.field == "roller.friction"  # bounds of a field before the rules


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"camshaft.gear.pinion_teeth": 21}, "camshaft.gear.teeth = 40, must be 42"),
        ({"mechanism.gear_ratio": 1.0}, "camshaft.gear.teeth = 40, must be 20"),
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
        assert with_values(sound(), values).camshaft is not None


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
