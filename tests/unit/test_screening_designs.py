"""Screening of many designs: rows, refusals, groups, utilisations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import made_trial as made
import numpy as np
import pytest

from camwright.geometry.arrays import Array
from camwright.geometry.errors import GeometryError, InputError
from camwright.pipeline.base.verdict import governing_id
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, read_case, tables_of, with_values
from camwright.pipeline.case.case_values import quantity_of, replaced, value_of
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.toml_text import TomlValue
from camwright.pipeline.checks import roller_bearing
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.loaded_cam import TurningRoller
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening import design_screening
from camwright.pipeline.screening.design_arrays import Designs, TorqueOfSpeed
from camwright.pipeline.screening.design_factors import ARRAYS, groups, is_array
from camwright.pipeline.screening.design_screening import screen_designs, utilisations
from camwright.pipeline.screening.screened_checks import SCREENED
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.solver import solve

CASES = Path(__file__).parents[2] / "cases"


@cache
def case() -> Case:
    return read_case(CASES / "gx120.toml")


def test_a_face_that_the_contact_leaves_is_a_row_as_in_the_preview() -> None:
    flat = read_case(CASES / "papers" / "petrescu_c.toml")
    widths = ["8 mm", "30 mm"]
    columns = screen_designs(flat, {"follower.face.width": widths})
    assert list(columns["screen"]) == ["error", "open"]
    assert np.isnan(columns["face_width.demand"]).tolist() == [True, False]
    with pytest.raises(InputError) as refused:
        preview_case(with_values(flat, {"follower.face.width": widths[0]}), corners=False)
    assert columns["message"][0] == str(refused.value)
    assert columns["message"][0].startswith("follower.face.width = 8 mm, must be > ")


def test_a_value_that_the_follower_does_not_have_is_a_row() -> None:
    flat = read_case(CASES / "papers" / "petrescu_c.toml")
    columns = screen_designs(flat, {"roller.radius": ["5 mm"], "spring.preload": [20.0]})
    assert columns["screen"][0] == "error"
    assert columns["message"][0].startswith("roller")


def test_refused_designs_are_rows_that_name_field_value_and_limit() -> None:
    factors = {
        "spring.rate": ["24.2 kN/m", "-1 kN/m", *["24.2 kN/m"] * 3, "5 mm", "24.2 kN/m"],
        "roller.radius": [0.008, 0.008, 0.06, 0.008, 0.008, 0.008, np.nan],
        "cam.bore_radius": [0.0085, 0.0085, 0.0085, 0.05, 0.0085, 0.0085, 0.0085],
        "guides.spacing": [0.08, 0.08, 0.08, 0.08, 0.019, 0.08, 0.08],
    }
    columns = screen_designs(case(), factors)
    assert list(columns["screen"]) == ["fail", *["error"] * 6]
    words = (
        "", "spring.rate = -1 kN/m, must be > 0", "roller.radius", "cam.", "guides.spacing",
        "spring.rate = 5 mm, must be in a unit of", "roller.radius = nan, must be > 0",
    )  # fmt: skip
    for message, start in zip(columns["message"], words, strict=True):
        assert message.startswith(start)
        assert bool(message) == bool(start)
    demand = columns["pressure_angle.demand"]
    assert np.isnan(demand[1:]).all()
    assert columns["pressure_angle.status"][1] == ""
    alone = screen_designs(case(), {key: values[:1] for key, values in factors.items()})
    assert demand[0] == pytest.approx(alone["pressure_angle.demand"][0], rel=1e-12)


def test_an_undercut_cam_fails_with_its_factor() -> None:
    columns = screen_designs(case(), {"roller.radius": [0.008, 0.03]})
    assert list(columns["message"][:1]) == [""]
    assert columns["message"][1].startswith("undercut factor of the contour = -")
    assert columns["screen"][1] == columns["undercut.status"][1] == "fail"
    assert columns["contact_pressure.status"][1] == "not_evaluated"


def test_of_equal_utilisations_the_check_of_the_preview_governs() -> None:
    """A follower that leaves the cam fails two checks without bound."""
    design = {"spring.preload": 20.0, "follower.mass": 2.0}
    columns = screen_designs(case(), {key: [value] for key, value in design.items()})
    unbounded = ("contact_at_overspeed.utilisation", "contact_force_margin.utilisation")
    assert all(np.isposinf(columns[name][0]) for name in unbounded)
    checks = preview_case(replaced(case(), design), corners=False).checks
    governing = governing_id(checks)
    assert columns["governing"][0] == governing == "contact_at_overspeed"


def test_designs_of_other_structure_are_grouped() -> None:
    factors = {
        "roller.material": ["bearing_steel", "c45", "bearing_steel", "none"],
        "spring.rate": [20e3, 20e3, 30e3, 20e3],
    }
    columns = screen_designs(case(), factors)
    assert columns["screen"][3] == "error"
    assert columns["message"][3].startswith("roller.material = none")
    for row in range(3):
        values = {key: column[row] for key, column in factors.items()}
        own = with_values(case(), values)
        alone = screen_designs(own, {"spring.rate": [own.spring.rate]})
        for name in ("contact_pressure.demand", "contact_pressure.limit", "shakedown.limit"):
            np.testing.assert_allclose(columns[name][row], alone[name][0], rtol=1e-12)


WINDING = {
    "spring.design.wire_diameter": "3.6 mm", "spring.design.mean_diameter": "24 mm",
    "spring.design.coils": 5.0, "spring.design.free_length": "60 mm",
    "spring.design.shear_modulus": 77.2e9, "spring.design.density": 7850.0,
    "spring.design.strength_at_1mm": 1.97e9, "spring.design.strength_exponent": 0.108,
}  # fmt: skip


def test_wound_springs_are_solved_at_once_and_refused_by_name() -> None:
    wound = with_values(case(), WINDING)
    factors = {
        "spring.design.wire_diameter": ["3.6 mm", "4 mm", "9 mm", "3.6 mm", 0.0066],
        "spring.design.mean_diameter": [0.024, 0.026, 0.024, 0.024, 0.1],
        "spring.design.free_length": [0.06, 0.07, 0.08, 0.02, 0.08],
    }
    assert len(list(groups(wound, factors))) == 1
    columns = screen_designs(wound, factors)
    assert list(columns["screen"]) == ["fail", "fail", "error", "error", "error"]
    assert [message.partition(" = ")[0] for message in columns["message"]] == [
        "", "", "spring.design.mean_diameter", "spring.design.free_length", "follower.mass",
    ]  # fmt: skip
    for row in range(2):
        own = with_values(wound, {key: values[row] for key, values in factors.items()})
        alone = screen_designs(own, {"spring.rate": [own.spring.rate]})
        design = own.spring.design
        assert design is not None
        for name in ("spring_stress", "spring_buckling", "spring_solid_stress", "spring_surge"):
            for figure in ("demand", "limit"):
                key = f"{name}.{figure}"
                np.testing.assert_allclose(columns[key][row], alone[key][0], rtol=1e-12)
        off = abs(design.rate / own.spring.rate - 1.0)
        assert columns["spring_rate.demand"][row] == pytest.approx(off, rel=1e-12)


def test_a_limit_of_each_design_is_its_own() -> None:
    columns = screen_designs(case(), {"limits.pressure_angle": ["30 deg", "60 deg"]})
    assert list(columns["pressure_angle.status"]) == ["fail", "pass"]
    np.testing.assert_allclose(columns["pressure_angle.limit"], [30.0, 60.0], rtol=1e-12)


@pytest.mark.parametrize("offset", ["0 mm", "8 mm"])
def test_the_stroke_that_governs_the_pressure_angle(offset: str) -> None:
    """Of designs with and without a limit of the return, as the check judges them."""
    backs = ["30 deg", "40 deg", "80 deg"]
    factors = {"limits.return_pressure_angle": backs, "cam.offset": [offset] * len(backs)}
    columns = screen_designs(case(), factors)
    for k, back in enumerate(backs):
        own = with_values(case(), {"limits.return_pressure_angle": back, "cam.offset": offset})
        contour = own.contour(cam_lift(own, engine_torques(own)))
        checks = solve(own, contour, tier=Tier.SCREENING).checks
        (check,) = (each for each in checks if each.id == "pressure_angle")
        record = check.as_record()
        assert columns["pressure_angle.demand"][k] == pytest.approx(record["demand"], rel=1e-4)
        assert columns["pressure_angle.limit"][k] == pytest.approx(record["limit"], rel=1e-12)


def test_load_cases_with_own_torque_reductions_are_screened_as_the_preview_judges_them() -> None:
    """Demand by the greatest requirement; of a limit that differs by design, that of each."""
    base = case()
    idle = base.load_cases[0]
    states = (
        idle,
        idle.model_copy(update={"name": "less", "torque_reduction": 0.2, "ripple_weight": 0.0}),
    )
    own = base.model_copy(update={"load_cases": states})
    columns = screen_designs(own, {"limits.torque_reduction": [0.1, 0.3, 0.4]})
    alone = screen_designs(base, {"spring.rate": [base.spring.rate]})["torque_reduction.demand"][0]
    np.testing.assert_allclose(columns["torque_reduction.limit"], [0.2, 0.3, 0.4], rtol=1e-12)
    # the same reduction in both load cases: the greatest requirement is the closest
    np.testing.assert_allclose(columns["torque_reduction.demand"], alone, rtol=1e-9)


def test_the_width_of_a_smoother_is_that_of_the_case() -> None:
    columns = screen_designs(case(), {"smoothing.spacing": ["5 deg", "7 deg"]})
    own = with_values(case(), {"smoothing.spacing": "7 deg"})
    alone = screen_designs(own, {"spring.rate": [own.spring.rate]})
    np.testing.assert_allclose(
        columns["torque_reduction.demand"][1], alone["torque_reduction.demand"][0], rtol=1e-12
    )


@pytest.mark.parametrize(
    ("factors", "words"),
    [
        ({"spring.rat": [1.0]}, "factor = spring.rat, must be a key .*did you mean rate"),
        ({"spring.rate": [1.0], "cam.width": [1.0, 2.0]}, "factors = .* of one length"),
        ({}, "factors"),
    ],
)
def test_factors_that_no_case_has_are_refused(factors: dict[str, list[float]], words: str) -> None:
    with pytest.raises(InputError, match=words):
        screen_designs(case(), factors)


def test_every_array_key_is_a_number_of_the_case_file() -> None:
    for key in ARRAYS:
        assert quantity_of(key) is not None, key


def test_replaced_values_are_those_read() -> None:
    numbers = {"spring.rate": 3e4, "load_case[0].speed": 120.0, "limits.pressure_angle": 0.5}
    fast, read = replaced(case(), numbers), with_values(case(), dict(numbers))
    for key, number in numbers.items():
        assert value_of(fast, key) == number
        assert value_of(read, key) == pytest.approx(number, rel=1e-15)
    with pytest.raises(InputError, match=r"spring\.rate = -1 kN/m, must be > 0"):
        replaced(case(), {"spring.rate": -1000.0})


@pytest.mark.parametrize("sense", ["at_most", "at_least"])
def test_utilisations_are_those_of_the_checks(sense: str) -> None:
    declared = replace(CHECKS[0], sense=sense)  # type: ignore[arg-type]
    pairs = [(1.0, 2.0), (2.0, 1.0), (0.0, 0.0), (-1.0, 0.5), (0.5, 0.0), (np.inf, 1.0)]
    demand, limit = np.array(pairs).T
    mine = utilisations(demand, limit, at_most=sense == "at_most")
    for used, (value, allowed) in zip(mine, pairs, strict=True):
        assert used == Check(declared, value, allowed, "", "", "").utilisation


def test_a_design_that_cannot_be_solved_is_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    solved = design_screening.judged_columns

    def judged(designs: Designs) -> dict[str, design_screening.Column]:
        if (designs.value("spring.rate") > 50e3).any():
            raise GeometryError("no cam")
        return solved(designs)

    monkeypatch.setattr(design_screening, "judged_columns", judged)
    columns = screen_designs(case(), {"spring.rate": [20e3, 60e3, 30e3, 40e3, 70e3]})
    assert list(columns["message"]) == ["", "no cam", "", "", "no cam"]
    assert list(columns["screen"]) == ["fail", "error", "fail", "fail", "error"]
    assert np.isnan(columns["pressure_angle.demand"]).tolist() == [False, True, False, False, True]


@pytest.mark.slow
def test_the_torque_between_speeds_is_that_of_the_engine() -> None:
    """Nine Chebyshev nodes from 1100 to 3900 rpm: 5e-4 of the range of the torque."""
    speeds = np.linspace(120.0, 410.0, 40)
    between = TorqueOfSpeed.of(case(), 0, speeds)
    assert between.interpolated
    for k in (0, 22):
        known = TorqueOfSpeed.of(case(), 0, speeds[k : k + 1]).torques[0]
        np.testing.assert_allclose(
            between.at(speeds)[k], known, rtol=0.0, atol=5e-4 * np.ptp(known)
        )


def test_the_roller_lives_by_the_duty_as_in_the_preview() -> None:
    base = case()
    idle = base.load_cases[0]
    states = (
        idle.model_copy(update={"duty": 0.7}),
        idle.model_copy(update={"name": "slow", "speed": 0.6 * idle.speed, "duty": 0.3}),
    )
    own = base.model_copy(update={"load_cases": states})
    columns = screen_designs(own, {"spring.rate": [own.spring.rate]})
    checks = {each.id: each for each in preview_case(own, corners=False).checks}
    hours = checks["roller_life"].as_record()["demand"]
    deviation = next(each.deviation for each in SCREENED if each.check == "roller_life")
    assert columns["roller_life.demand"][0] == pytest.approx(hours, rel=deviation)
    limits = base.limits.model_copy(update={"overspeed": None})
    slower = base.model_copy(update={"limits": limits})  # as the follower leaves the cam above
    worst = screen_designs(slower, {"spring.rate": [own.spring.rate]})["roller_life.demand"][0]
    assert columns["roller_life.demand"][0] > 1.1 * worst


@pytest.mark.parametrize(("spring", "long_enough"), [({}, "pass"), (WINDING, "not_evaluated")])
def test_a_life_without_the_surge_of_the_spring_can_only_fail(
    spring: dict[str, TomlValue], long_enough: str
) -> None:
    """The surge of a wound spring, which screening leaves out, shortens the life."""
    base = with_values(case(), spring)
    slower = base.limits.model_copy(update={"overspeed": None})  # the follower leaves the cam there
    base = base.model_copy(update={"limits": slower})
    columns = screen_designs(base, {"limits.roller_life": ["1 h", "1e6 h"]})
    assert list(columns["roller_life.status"]) == [long_enough, "fail"]


def parts_without_ends() -> Case:
    """Machine with every part but ends of the line of contact and a wound spring."""
    case = made.case()
    return case.model_copy(update={
        "cam": replace(case.cam, end=None), "roller": replace(case.roller, end=None),
        "spring": replace(case.spring, design=None),
    })  # fmt: skip


SECTION = {
    "width": "20 mm", "depth": "22 mm", "bore": "14 mm", "hub": "26 mm", "roller_hub": "14 mm",
    "plane_offset": "0.5 mm", "spring_distance": "40 mm", "material": "steel", "pivot_notch": 2.0,
    "roller_notch": 2.5,
}  # fmt: skip
SWUNG = {
    "swinging_mass": "300 g", "mass_distance": "30 mm", "mass_angle": "5 deg",
    "gravity_angle": "60 deg", "load_distance": "40 mm", "load_angle": "10 deg",
    "load_moment": "0.2 N m",
}  # fmt: skip
LINK = {
    "arm_radius": "50 mm", "arm_angle": "4 deg", "fixed_radius": "70 mm", "fixed_angle": "80 deg",
    "rate": "20 kN/m", "preload": "400 N",
}  # fmt: skip


def arm_without_ends(bearing: str) -> Case:
    """Machine with every part of an arm and a spring on it, but ends of the line of contact."""
    tables: Any = tables_of(made.arm_case(bearing))
    tables["spring"] = {"link": LINK, "travel_max": "20 mm"}
    tables["follower"]["arm"] |= SECTION
    tables["follower"]["pivot"] |= SWUNG
    del tables["cam"]["end"], tables["roller"]["end"], tables["scope"]
    return case_of(tables)


ONE_BY_ONE: dict[str, Callable[[], Case]] = {
    "roller": parts_without_ends,
    "face": made.face_case,
    "arm in a bush": partial(arm_without_ends, "bush"),
    "arm in needles": partial(arm_without_ends, "needle_bearing"),
}
SLOW = ("guides.spacing", "guides.a.friction_max", "guides.b.friction_max")
"""Keys of which each value has tables of the guides of its own, or that bound another key."""
FIXED = (*SLOW, "mechanism.compensation", "roller.radius")
"""And those that the drawn lift and the ring of the bearing fix."""


@pytest.mark.parametrize("follower", ONE_BY_ONE)
def test_designs_at_once_are_those_one_by_one(follower: str) -> None:
    """Of every key of an array at once: a check that reads it of the case alone differs."""
    base, count = ONE_BY_ONE[follower](), 4
    draw = np.random.default_rng(3)
    keys = [key for key in ARRAYS if is_array(base, key, [1.0]) and value_of(base, key)
            and key not in FIXED and not key.startswith("smoothing.")]  # fmt: skip
    factors = {key: value_of(base, key) * draw.uniform(1.0, 1.02, count) for key in keys}
    for name in ("roller_reliability", "shaft_reliability"):
        if f"limits.{name}" in factors:
            factors[f"limits.{name}"] = draw.uniform(0.9, 0.95, count)
    assert {"cam.width", "cam.bore_radius", "limits.shaft_reliability"} <= set(keys)
    assert follower == "face" or {"roller.width", "roller.bearing.C0"} <= set(keys)
    if follower.startswith("arm"):
        tables = {"follower.arm": SECTION, "follower.pivot": SWUNG, "spring.link": LINK}
        of_arm = {f"{table}.{key}" for table, each in tables.items() for key in each}
        assert of_arm - {"follower.arm.material"} <= set(keys)
    columns = screen_designs(base, factors)
    assert set(columns["message"]) == {""}
    for k in range(count):
        own = replaced(base, {key: float(values[k]) for key, values in factors.items()})
        alone = screen_designs(own, {"follower.mass": [own.follower.mass]})
        assert columns.keys() == alone.keys()
        for name, values in columns.items():
            if values.dtype == object:
                assert values[k] == alone[name][0], name
            else:
                np.testing.assert_allclose(values[k], alone[name][0], rtol=1e-12, err_msg=name)
    judged = {each.check for each in SCREENED
              if set(columns.get(f"{each.check}.status", [])) & {"pass", "fail"}}  # fmt: skip
    concerned = {each.check for each in SCREENED if f"{each.check}.status" in columns}
    kind = follower.split()[0]
    assert concerned - judged <= NOT_JUDGED[kind], concerned - judged
    assert OF_PARTS[kind] <= judged


NOT_JUDGED = {
    "roller": {"concave_radius", "edge_pressure", "guide_pressure_A", "guide_pressure_B",
               "machine_shaft_gap"},
    "face": {"edge_pressure", "guide_pressure_A", "guide_pressure_B", "cam_slip",
             "spring_stress", "spring_fatigue", "machine_shaft_gap"},
    "arm": {"concave_radius", "edge_pressure", "pivot_pressure"},
}  # fmt: skip
"""Checks that do not apply, lack the ends, or are a bound within the limit."""
OF_EVERY = {
    "key_pressure", "key_pressure_shaft", "key_shear", "keyway_root", "gear_bending",
    "pinion_bending", "gear_contact", "bore_pressure", "guide_wear_A", "guide_wear_B",
}  # fmt: skip
OF_PARTS = {
    "roller": OF_EVERY | {
        "cam_slip", "roller_pin", "roller_pin_shear", "roller_pin_pressure", "cheek_pressure",
        "roller_ring_fatigue", "traction_demand", "traction_reserve", "roller_life",
        "roller_modified_life", "bearing_lubrication", "grease_life",
    },
    "face": OF_EVERY,
    "arm": (OF_EVERY - {"guide_wear_A", "guide_wear_B"}) | {
        "arm_yield", "arm_gap", "link_reach", "pivot_jam_index", "pivot_jam_index_friction_max",
    },
}  # fmt: skip


NAN_KEYS = ("follower.arm.length", "follower.pivot.swinging_mass", "spring.link.fixed_angle")


@pytest.mark.parametrize(("key", "value", "words"), [
    *((key, np.nan, key) for key in NAN_KEYS),
    ("follower.arm.length", 0.001, "cam.prime_radius = "),
    ("follower.arm.centre_distance", -0.07, "follower.arm.centre_distance = -70 mm"),
    ("follower.arm.bore", 0.03, "follower.arm.bore = 30 mm, must be < 26 mm"),
    ("follower.pivot.bush.friction", 0.5, "follower.pivot.bush.friction_max"),
    ("spring.link.fixed_angle", -1.0, "spring.link.fixed_angle = -57.3"),
    ("spring.link.fixed_angle", 0.3, "spring.link.rate = 20 kN/m, must be > "),
])  # fmt: skip
def test_an_arm_that_cannot_be_is_a_row(key: str, value: float, words: str) -> None:
    """NaN, a value out of its bounds, and parts that contradict one another; the next is judged."""
    base = arm_without_ends("bush")
    columns = screen_designs(base, {key: np.array([value, value_of(base, key)])})
    assert list(columns["screen"] == "error") == [True, False]
    assert words in columns["message"][0]
    statuses = {columns[name][0] for name in columns if name.endswith(".status")}
    assert statuses == {""}


def test_an_arm_past_its_line_of_centres_is_refused_as_in_the_preview() -> None:
    base = arm_without_ends("bush")
    design = {"cam.prime_radius": 0.1299}
    columns = screen_designs(base, {key: np.array([value]) for key, value in design.items()})
    with pytest.raises(InputError) as refused:
        preview_case(replaced(base, design), corners=False)
    assert columns["message"][0] == str(refused.value)
    assert columns["message"][0].startswith("follower.arm angle = ")


def test_more_rings_than_are_solved_are_not_judged() -> None:
    base = parts_without_ends()
    count = 17
    factors = {"roller.width": np.linspace(1.0, 1.02, count) * base.roller.width}
    many = screen_designs(base, factors)["roller_ring_fatigue.status"]
    assert set(many) == {"not_evaluated"}
    few = screen_designs(base, {"roller.width": factors["roller.width"][:2]})
    assert "not_evaluated" not in few["roller_ring_fatigue.status"]


def test_a_figure_of_a_part_is_made_once_for_equal_designs() -> None:
    numbers = Numbers({"width": np.array([[1.0], [2.0], [1.0]]), "span": 5.0})
    made_of: list[float] = []

    def figures(one: Numbers) -> tuple[float, float]:
        made_of.append(float(one["width"]))
        return 2.0 * float(one["width"]), float(one["span"])

    for of_load_case in (numbers, numbers | {"speed": 3.0}):
        double, span = of_load_case.each(figures, ("width", "span"))
        np.testing.assert_array_equal(double, [[2.0], [4.0], [2.0]])
        np.testing.assert_array_equal(span, 3 * [[5.0]])
    assert made_of == [1.0, 2.0]
    wider = numbers | {"width": np.array([[3.0]])}
    assert [np.ravel(each).tolist() for each in wider.each(figures, ("width", "span"))] == [
        [6.0],
        [5.0],
    ]


def test_a_design_of_unknown_force_leaves_the_others_their_grease_life() -> None:
    """Judged together: one whose forces are not known has no life, the others keep theirs."""
    base = parts_without_ends()
    bearing = replace(base.roller.bearing, grease_life=None, temperature=333.0)
    case = base.model_copy(update={"roller_given": replace(base.roller, bearing=bearing)})
    spin, normal = np.full((2, 8), 100.0), np.full((2, 8), 40.0)
    normal[1, 0] = np.nan

    def greased(rows: slice) -> Array:
        roller = TurningRoller(normal[rows], spin[rows], spin[rows], spin[rows, :1])
        cam: Any = SimpleNamespace(
            numbers=Numbers({}, case), normal=normal[rows], rollers=(roller,)
        )
        return roller_bearing.greased(cam, roller_bearing.FIRST_ROLLER)

    (alone,) = greased(slice(1))
    assert np.isfinite(alone).all()
    np.testing.assert_array_equal(greased(slice(2)), [alone, [np.nan]])
