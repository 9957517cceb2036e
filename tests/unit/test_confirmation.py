"""Values on which a verdict rests and which nothing confirms."""

import tomllib
from dataclasses import replace
from datetime import date
from functools import cache
from typing import Any

import made_trial as made
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of, enter, read_case
from camwright.pipeline.case.limits import LIMITS, is_weaker
from camwright.pipeline.case.value_sources import values_at
from camwright.pipeline.checks.check import Check, Demand
from camwright.pipeline.checks.confirmation import with_values_to_confirm
from camwright.pipeline.checks.registry import CHECKS, DECLARED, OF_THE_DESIGN
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.check_records import relaxed_limits, screen_line

ENDURANCE = "materials.steel.endurance_pressure"


def tables() -> dict[str, Any]:
    """The case that describes every part, at the fewest positions and the usual tolerances."""
    read = tomllib.loads(made.CASE_FILE.read_text(encoding="utf-8"))
    read["cam"]["profile_tolerance"] = "0.1 mm"
    read["solver"]["positions"] = 36
    return read


def stated(**sections: Any) -> Case:
    """That case with further tables, none of its own sources recalled."""
    changed = tables()
    for name, table in sections.items():
        changed[name] = table
    return case_of(changed)


def contact(case: Case) -> Check:
    solved = made.solution(case=case)
    (declared,) = (each for each in CHECKS if each.id == "contact_pressure")
    check = declared(solved)
    assert check is not None
    (checked,) = with_values_to_confirm([check], case, OF_THE_DESIGN)
    return checked


def sourced(text: str) -> dict[str, str]:
    """Source of each value on which the contact pressure rests."""
    own = case_of(tables()).tables()
    rests = (
        value for path in DECLARED["contact_pressure"].values for value in values_at(own, path)
    )
    return dict.fromkeys(rests, text)


GREATER_IS_WEAKER = {
    "acceleration_step", "bore_share", "chord_share", "closure", "complementarity",
    "contact_torque", "end_mean_length", "equilibrium", "follower_mass_ratio", "friction_balance",
    "friction_power", "jam_index", "jump", "key_reversal", "key_share", "mesh_uncertainty",
    "pin_pressure_share", "pin_share", "pressure_angle", "roller_load_share",
    "roller_misalignment", "roller_speed_share",
    "second_contact_depth", "shaft_deflection", "shaft_slope", "surface_temperature",
    "traction_share", "unbalance", "waviness", "wear_depth",
}  # fmt: skip
"""Limits that a greater value weakens, by hand; all others with a default, a smaller one."""


@pytest.mark.parametrize("name", [name for name, row in LIMITS.items() if row.default is not None])
def test_a_limit_weaker_than_its_default_is_relaxed(name):
    row = LIMITS[name]
    if name == "torque_reduction":  # what the case wants of its cam
        assert not is_weaker(row, 0.5 * row.default)
        return
    if row.default == 0.0:  # a clearance that none may be less than
        assert not is_weaker(row, 0.0) and not is_weaker(row, 1e-6)
        return
    weaker, stronger = (1.01, 0.99) if name in GREATER_IS_WEAKER else (0.99, 1.01)
    assert is_weaker(row, weaker * row.default)
    assert not is_weaker(row, stronger * row.default) and not is_weaker(row, row.default)


def test_weakening_a_limit_further_never_removes_the_words():
    """Whatever the check then says: passed, failed or without data."""
    (declared,) = (each for each in CHECKS if each.id == "contact_pressure")
    for safety in (0.99, 0.3, 1e-6):
        case = stated(limits={**tables()["limits"], "contact_safety": safety})
        check = declared(made.solution(case=case))
        for each in (check, replace(check, demand=None)):
            (made_,) = with_values_to_confirm([each], case, OF_THE_DESIGN)
            assert made_.relaxed == (f"limits.contact_safety = {safety:g}, default 1",)
    assert contact(stated()).relaxed == ()


def test_relaxed_limits_stand_on_the_record_of_a_preview():
    """Of the published forged case: three limits that its author weakened."""
    case = read_case(made.CASE_FILE.parent / "refused" / "relaxed_limits.toml")
    judged = with_values_to_confirm(preview_case(case, corners=False).checks, case, OF_THE_DESIGN)
    records = [each.as_record() for each in judged]
    assert {words.split(" ")[0] for words in relaxed_limits(records)} == {
        "limits.contact_safety", "limits.keyway_safety", "limits.unbalance",
    }  # fmt: skip
    assert "3 limits relaxed" in screen_line(records, "preview")


DRAWN = {
    "acceleration_step", "anti_rotation", "arm_cam_gap", "arm_gap", "cam_radius",
    "chord_error", "concave_radius",
    "bearing_gap", "curvature_rate", "curvature_ratio", "face_width", "fork_gap",
    "fork_shaft_gap", "gas_gap", "gear_gap", "machine_shaft_gap", "guide_gap", "guide_length",
    "key_corner", "minimum_wall",
    "pressure_angle", "second_contact", "self_intersection", "spring_buckling", "tool_gouge",
    "tooth_count", "tooth_ratio", "torsion_gap", "undercut",
    "groove_radius", "groove_shaft_gap", "second_disc_gap", "second_track_gap",
    "outer_second_contact", "outer_undercut",
}  # fmt: skip
"""Checks of lengths alone, which the drawing fixes."""


def test_every_check_of_the_design_states_the_values_it_rests_on():
    without = {each.id for each in CHECKS if not each.evidence and not each.values}
    assert {name for name in without if not name.startswith("data_")} == DRAWN


def test_values_with_a_source_leave_nothing_to_confirm():
    assert contact(stated(sources=sourced("certificate 4711"))).unconfirmed == ()


def test_a_recalled_value_is_to_be_confirmed():
    sources = sourced("certificate 4711") | {ENDURANCE: "table 9.3, recalled: verify"}
    check = contact(stated(sources=sources))
    assert check.unconfirmed == (ENDURANCE,)
    assert check.as_record()["to_be_confirmed"] == [ENDURANCE]


@pytest.mark.parametrize(
    "by", [{"source": "certificate 4711"}, {"name": "A. Engineer", "date": "2025-01-02"}]
)
def test_a_source_or_a_name_and_a_date_confirm_it(by):
    sources = sourced("certificate 4711") | {ENDURANCE: "recalled"}
    entry = tomllib.loads(
        "\n".join(
            f"{key} = {value}" if key == "date" else f'{key} = "{value}"'
            for key, value in {"value": ENDURANCE, **by}.items()
        )
    )
    assert contact(stated(sources=sources, confirmed=[entry])).unconfirmed == ()


def test_a_limit_of_the_table_with_a_recalled_source_counts_until_the_case_states_its_own():
    (declared,) = (each for each in CHECKS if each.id == "guide_gap")

    def open_values(case):
        check = declared(made.solution(case=case))
        assert check is not None
        return with_values_to_confirm([check], case, OF_THE_DESIGN)[0].unconfirmed

    assert open_values(stated()) == ("limits.guide_gap",)
    own = tables()["limits"] | {"sources": {"guide_gap": "drawing 12"}}
    assert open_values(stated(limits=own)) == ()


def test_the_recalled_source_that_a_check_declares_counts():
    """The static strength of the spring is a share of R_m in the program."""
    (declared,) = (each for each in CHECKS if each.id == "pressure_by_gear_limits")
    case = stated()
    check = declared(made.solution(case=case))
    assert check is not None
    assert (
        "checks.pressure_by_gear_limits"
        in with_values_to_confirm([check], case, OF_THE_DESIGN)[0].unconfirmed
    )
    entry = {"value": "checks.pressure_by_gear_limits", "source": "ISO 6336-5:2016, figure 9"}
    confirmed = with_values_to_confirm([check], stated(confirmed=[entry]), OF_THE_DESIGN)[
        0
    ].unconfirmed
    assert "checks.pressure_by_gear_limits" not in confirmed
    entry["value"] = "checks.pressure_by_gear_limit"
    with pytest.raises(InputError, match=r"did you mean checks\.pressure_by_gear_limits"):
        with_values_to_confirm([check], stated(confirmed=[entry]), OF_THE_DESIGN)


def test_the_residual_of_a_counterweight_counts_until_it_is_confirmed():
    value = "camshaft.counterweight.residual"
    (declared,) = (each for each in CHECKS if each.id == "cam_unbalance")

    def unconfirmed(source: str, **more: Any) -> bool:
        weight = {"residual": "20 g mm", "position": "10 mm", "source": source}
        case = stated(camshaft=tables()["camshaft"] | {"counterweight": weight}, **more)
        check = declared(made.solution(case=case))
        assert check is not None
        return value in with_values_to_confirm([check], case, OF_THE_DESIGN)[0].unconfirmed

    assert unconfirmed("assumed: G 2.5")
    assert not unconfirmed("balancing sheet 12")
    assert not unconfirmed("assumed", confirmed=[{"value": value, "source": "sheet 12"}])


def test_a_check_without_data_rests_on_nothing():
    case = stated(sources=sourced("recalled"))
    check = contact(case)
    assert check.unconfirmed
    missing = with_values_to_confirm([replace(check, demand=None)], case, OF_THE_DESIGN)
    assert missing[0].unconfirmed == ()


TIGHT = {
    "tolerances.friction": (0.4, 0.5), "tolerances.mass": (0.02, 0.03),
    "tolerances.inertia": (0.01, 0.05), "tolerances.phase": ("0.5 deg", "1 deg"),
    "spring.rate_tolerance": (0.03, 0.05), "spring.preload_tolerance": (0.03, 0.05),
    "cam.profile_tolerance": ("0.05 mm", "0.1 mm"), "guides.a.friction_max": (0.13, 0.15),
    "guides.b.friction_min": (0.07, 0.05),
}  # fmt: skip
DRAWING = {"source": "drawing 4711, rev. B"}


def toleranced(value: str, stated: str | float, **more: Any) -> Case:
    """Every tolerance at its default or wider, but one; a source for all of them."""
    changed = tables() | more
    for name, (_, usual) in TIGHT.items():
        *parents, key = name.split(".")
        table = changed
        for part in parents:
            table = table.setdefault(part, {})
        table[key] = stated if name == value else usual
    for side in "ab":
        changed["guides"][side]["friction"] = 0.1
    changed["tolerances"] |= DRAWING
    return case_of(changed)


@pytest.mark.parametrize("value", TIGHT)
def test_a_tighter_tolerance_counts_until_the_case_confirms_it(value):
    """Whatever its source, and only below its default."""
    tight, usual = TIGHT[value]
    assert value not in contact(toleranced(value, usual)).unconfirmed
    assert value in contact(toleranced(value, tight)).unconfirmed
    for by in (DRAWING, {"name": "A. Engineer", "date": date(2025, 1, 2)}):
        confirmed = toleranced(value, tight, confirmed=[{"value": value} | by])
        assert value not in contact(confirmed).unconfirmed


def test_a_tolerance_is_not_confirmed_by_an_open_source():
    with pytest.raises(InputError, match=r"confirmed\.tolerances\.mass\.source = assumed"):
        toleranced(
            "tolerances.mass", 0.02, confirmed=[{"value": "tolerances.mass", "source": "assumed"}]
        )


@pytest.mark.parametrize("value", TIGHT)
def test_a_tighter_tolerance_without_a_source_is_refused(value):
    tight, _ = TIGHT[value]
    own = toleranced(value, tight).tables()
    own["tolerances"].pop("source")
    for side in "ab":
        own["guides"][side].pop("source", None)
    with pytest.raises(InputError, match=f"{value} = .*without tolerances.source"):
        case_of(own)


@cache
def demands(value: str = "", share: float = 0.0) -> dict[str, tuple[float | None, float | None]]:
    """Demand and limit of each check of the design, one value changed by a share."""
    changed = tables()
    if value:
        *parents, key = value.split(".")
        table: Any = changed
        written: Any = case_of(tables()).tables()
        for part in parents:
            table, written = table.setdefault(part, {}), written[part]
        number, _, unit = str(written[key]).partition(" ")
        new = float(number) * (1.0 + share)
        table[key] = f"{new!r} {unit}" if unit else new
    checks = preview_case(case_of(changed), corners=False).checks
    return {one.id: (one.demand, one.limit) for one in checks if not one.evidence}


def moved(value: str) -> set[str]:
    """Checks whose demand or limit changes with a value."""
    before, after = demands(), demands(value, 0.01)
    return {
        name
        for name in before.keys() & after.keys()
        for old, new in zip(before[name], after[name], strict=True)
        if old is not None and new is not None and abs(new - old) > 1e-7 * abs(old)
    }


def resting_on(value: str) -> set[str]:
    """Checks that state that they rest on a value."""
    own = case_of(tables()).tables()
    return {
        name for name, one in DECLARED.items() for p in one.values if value in values_at(own, p)
    }


DATA = (
    "materials.steel.endurance_pressure", "materials.steel.yield_strength",
    "materials.steel.fatigue_torsion", "materials.steel.tensile_strength",
    "materials.nylon.E", "materials.nylon.conductivity", "materials.nylon.yield_strength",
    "roller.bearing.C", "roller.bearing.C0", "roller.bearing.ring.thickness",
    "spring.design.density", "spring.design.strength_at_1mm", "camshaft.bearing_rating",
    "guides.a.friction", "follower.mass",
)  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("value", DATA)
def test_every_check_that_moves_with_a_value_states_so(value):
    """By one per cent more of it; a check that moves rests on it, whatever its formula."""
    assert moved(value)
    assert moved(value) <= resting_on(value)


BY = {"name": "A. Engineer", "date": date(2025, 1, 2), "source": "test bench"}


@pytest.mark.parametrize(
    ("key", "usual", "beyond", "check"),
    [
        ("spring.rate", "24.2 kN/m", "0.02 kN/m", "contact_force_margin"),
        ("follower.mass", "0.2 kg", "60 kg", "contact_force_margin"),
        ("camshaft.counterweight.residual", "20 g mm", "0.2 g mm", "cam_unbalance"),
    ],
)
def test_a_value_beyond_its_usual_range_is_to_be_confirmed(
    key: str, usual: str, beyond: str, check: str
) -> None:
    """Whatever its source; by name and date alone."""

    def is_open(value: str, **more: Any) -> bool:
        changed = tables() | more
        for name in ("cam", "camshaft", "spring", "follower"):
            changed[name]["source"] = "drawing 4711"
        changed["camshaft"]["counterweight"] = {
            "position": "35 mm",
            "residual": "20 g mm",
            "source": "bench",
        }
        enter(changed, key, value)
        case = case_of(changed)
        judged = DECLARED[check].judged(made.solution(case=case).machine, Demand(1.0, 2.0))
        (one,) = with_values_to_confirm([judged], case, OF_THE_DESIGN)
        return key in one.unconfirmed

    assert not is_open(usual)
    assert is_open(beyond)
    assert not is_open(beyond, confirmed=[{"value": key} | BY])
