"""Case files of version 0.1: their keys are read under the names of today."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any, get_args

import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError
from camwright.pipeline.base.quantities import Part
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.limits import GUIDE_GAP, LIMITS, TRACTION_SHARE
from camwright.pipeline.case.renamed_keys import renamed_names, with_new_keys
from camwright.pipeline.case.requirements_section import FreeName
from camwright.pipeline.case.section import section_of
from camwright.pipeline.checks.registry import (
    CHECKS,
    TOLERANCE_CORNERS,
    WAIVERS_WITHOUT_EFFECT,
)
from camwright.pipeline.follower.spring import HelicalSpring
from camwright.pipeline.results.workshop_files import WORKSHOP
from camwright.reports import pressure_figures

NAMES = renamed_names()
CHECK_IDS = {each.id for each in (*CHECKS, TOLERANCE_CORNERS, WAIVERS_WITHOUT_EFFECT)}

ROWS = {
    "[limits]": '{share} = 0.25\n{gap} = "2 mm"',
    "[limits.sources]": '{share} = "dry"\n{gap} = "room for a finger"',
    "[smoothing]": 'free = ["initial_energy", "{radius}"]\n{radius}_range = ["55 mm", "65 mm"]',
}
WAIVERS = """
[[waivers]]
check = "{pv}"
up_to = "9 MPa m/s"
name = "A. Engineer"
reason = "oiled by hand"
date = 2025-01-31

[[waivers]]
check = "shakedown"
up_to = "900 MPa"
name = "A. Engineer"
reason = "tried"
date = 2025-01-31
"""
OLD = {
    "share": "skid",
    "gap": "clearance",
    "radius": "pitch_base_radius",
    "workshop": "shop",
    "pv": "bush_pv_A",
}
TODAY = {
    "share": "traction_share",
    "gap": "guide_gap",
    "radius": "prime_radius",
    "workshop": "workshop",
    "pv": "guide_pv_A",
}


def replaced(text: str, old: str, new: str) -> str:
    assert text.count(old) == 1, old
    return text.replace(old, new)


def case_text(names: Mapping[str, str]) -> str:
    """One case, in the words of version 0.1 or in those of today."""
    text = replaced(small_machine("old"), "prime_radius =", f"{names['radius']} =")
    text = replaced(text, "[workshop]\n", f"[{names['workshop']}]\n")
    for table, rows in ROWS.items():
        text = replaced(text, f"{table}\n", f"{table}\n{rows.format(**names)}\n")
    return text + WAIVERS.format(**names)


def test_a_case_file_of_version_0_1_is_the_case_of_today() -> None:
    case = parse_case(case_text(OLD))
    assert case.cam.prime_radius == 0.060
    assert case.workshop.table_step == parse_case(small_machine("new")).workshop.table_step
    assert (case.limits[TRACTION_SHARE], case.limits[GUIDE_GAP]) == (0.25, 0.002)
    assert case.limits.source(TRACTION_SHARE).text == "dry"
    assert case.limits.source(GUIDE_GAP).text == "room for a finger"
    assert case.smoothing.free == ("initial_energy", "prime_radius")
    assert case.smoothing.prime_radius_range == (0.055, 0.065)
    assert [waiver.check for waiver in case.waivers] == ["guide_pv_A", "shakedown"]
    today = parse_case(case_text(TODAY))
    assert case == today


def test_a_resolved_case_has_the_names_of_today_alone() -> None:
    tables = parse_case(case_text(OLD)).tables()
    for old in NAMES["case"]:
        assert _entry(tables, old) is None, old
    assert tables == parse_case(case_text(TODAY)).tables()


@pytest.mark.parametrize(
    ("table", "rows", "message"),
    [
        ("[cam]", 'pitch_base_radius = "60 mm"',
         "cam.pitch_base_radius = a second name, must be left out beside cam.prime_radius"),
        ("[limits]", "traction_share = 0.4\nskid = 0.4",
         "limits.skid = a second name, must be left out beside limits.traction_share"),
        ("[limits]", 'guide_gap = "1 mm"\nclearance = "1 mm"',
         "limits.clearance = a second name, must be left out beside limits.guide_gap"),
        ("[limits.sources]", 'traction_share = "a"\nskid = "a"',
         "limits.sources.skid = a second name, must be left out beside"
         " limits.sources.traction_share"),
        ("[limits.sources]", 'guide_gap = "a"\nclearance = "b"',
         "limits.sources.clearance = a second name, must be left out beside"
         " limits.sources.guide_gap"),
        ("[smoothing]", 'prime_radius_range = ["50 mm", "60 mm"]\n'
         'pitch_base_radius_range = ["50 mm", "60 mm"]',
         "smoothing.pitch_base_radius_range = a second name, must be left out beside"
         " smoothing.prime_radius_range"),
        ("[workshop]", 'tool_radius = "6 mm"\n[shop]\ntool_radius = "6 mm"',
         "shop = a second name, must be left out beside workshop"),
    ],
)  # fmt: skip
def test_an_old_and_a_new_name_of_one_value_are_refused(
    table: str, rows: str, message: str
) -> None:
    with pytest.raises(InputError) as refusal:
        parse_case(replaced(small_machine("both"), f"{table}\n", f"{table}\n{rows}\n"))
    assert str(refusal.value) == message


def test_a_bad_value_under_an_old_name_is_told_by_the_new_one() -> None:
    bad = replaced(small_machine("bad"), 'prime_radius = "60', 'pitch_base_radius = "-60')
    with pytest.raises(InputError) as refusal:
        parse_case(bad)
    assert refusal.value.field == "cam.prime_radius"


@pytest.mark.parametrize(
    "rows",
    [
        "cam = 3",
        "limits = []",
        "limits = {sources = 3}",
        "shop = 3",
        "smoothing = {free = 3}",
        "smoothing = {free = [3, {}]}",
        'smoothing = {free = "pitch_base_radius"}',
        "waivers = 3",
        "waivers = [3]",
        "waivers = [{check = 3}]",
        "waivers = {check = 'bush_pv_A'}",
    ],
)
def test_hostile_tables_are_refused_in_one_line(rows: str) -> None:
    with pytest.raises(InputError) as refusal:
        parse_case(f"schema_version = 1\n{rows}\n")
    assert "\n" not in str(refusal.value)


def test_the_tables_given_stay_as_they_are() -> None:
    tables = {
        "cam": {"pitch_base_radius": "60 mm"},
        "shop": {"tool_radius": "6 mm"},
        "smoothing": {"free": ["pitch_base_radius"]},
        "waivers": [{"check": "bush_pv_A"}],
    }
    before = copy.deepcopy(tables)
    found = with_new_keys(tables)
    assert tables == before
    assert found == {
        "cam": {"prime_radius": "60 mm"},
        "workshop": {"tool_radius": "6 mm"},
        "smoothing": {"free": ["prime_radius"]},
        "waivers": [{"check": "guide_pv_A"}],
    }


# --- the list of renamed names itself


def _known_keys(section: str) -> set[str]:
    """Keys of a section of today's case file."""
    kind = Case.model_fields[section].annotation
    assert isinstance(kind, type)
    model = section_of(kind) if issubclass(kind, Part) else kind
    return {field.alias or name for name, field in model.model_fields.items()}


def _in_schema(dotted: str) -> bool:
    """Whether today's case file has a dotted field."""
    section, *rest = dotted.split(".")
    if section not in Case.model_fields or not rest:
        return section in Case.model_fields
    if rest[0] == "sources" and section == "limits" and len(rest) == 2:
        return rest[1] in LIMITS
    return len(rest) == 1 and rest[0] in _known_keys(section)


def _entry(tables: Mapping[str, Any], dotted: str) -> Any:
    """The value of a dotted field; None where there is none."""
    value: Any = tables
    for key in dotted.split("."):
        value = value.get(key) if isinstance(value, Mapping) else None
    return value


@pytest.mark.parametrize(("old", "new"), NAMES["case"].items())
def test_a_renamed_key_is_one_of_today_s_schema_and_its_old_name_none(old: str, new: str) -> None:
    assert _in_schema(new)
    assert not _in_schema(old)


@pytest.mark.parametrize(("old", "new"), NAMES["case"].items())
def test_every_renamed_key_is_read(old: str, new: str) -> None:
    tables: Any = "the value"
    for key in reversed(old.split(".")):
        tables = {key: tables}
    found = with_new_keys(tables)
    assert _entry(found, new) == "the value"
    assert _entry(found, old) is None


@pytest.mark.parametrize(("old", "new"), NAMES["checks"].items())
def test_a_renamed_check_is_one_of_the_registry_and_its_old_id_none(old: str, new: str) -> None:
    assert new in CHECK_IDS
    assert old not in CHECK_IDS
    (waiver,) = with_new_keys({"waivers": [{"check": old}]})["waivers"]
    assert waiver == {"check": new}


def test_renamed_values_keys_of_wires_and_files_are_those_of_today() -> None:
    free = NAMES["values"]["smoothing.free"]
    assert set(free.values()) <= set(get_args(FreeName))
    assert not set(free) & set(get_args(FreeName))
    fields = section_of(HelicalSpring).model_fields
    assert set(NAMES["wires"].values()) <= set(fields)
    assert not set(NAMES["wires"]) & set(fields)
    assert NAMES["files"] == {"shop/": f"{WORKSHOP}/", "5_bushes.npz": pressure_figures.FILE}
