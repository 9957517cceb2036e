"""A case that lacks a datum is cured by the printed block, pasted at the end of its file."""

from __future__ import annotations

import re
import tomllib
from copy import deepcopy
from typing import Any

import made_trial as made
import pytest
import tomli_w

from camwright.geometry.errors import InputError
from camwright.pipeline.base.verdict import verdict, within_depth
from camwright.pipeline.case.added_tables import NOTHING, added_text
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.checks.check import Check
from camwright.pipeline.commands import check_command
from camwright.pipeline.commands.terminal import INCOMPLETE
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.verdict_summary import missing_keys

COMPLETE: dict[str, Any] = tomllib.loads(made.CASE_FILE.read_text(encoding="utf-8")) | {
    "solver": {"positions": 36}
}


def judged(case: Case) -> tuple[Check, ...]:
    """Checks of a preview, as if it were certified."""
    return within_depth(preview_case(case, corners=False).checks)


def printed(case: Case) -> str:
    records: list[Any] = [one.as_record() for one in judged(case)]
    needed, optional = (missing_keys(records, must_have=each) for each in (True, False))
    return added_text(needed, optional, case.materials)


def without(*keys: str) -> dict[str, Any]:
    tables = deepcopy(COMPLETE)
    table = tables
    for key in keys[:-1]:
        table = table[key]
    del table[keys[-1]]
    return tables


def with_real_numbers(block: str) -> str:
    """The block with the values of the complete case in place of the examples."""
    table: Any = COMPLETE
    lines = []
    for line in block.splitlines():
        if line.startswith("[added."):
            table = COMPLETE
            for name in line[len("[added.") : -1].split("."):
                table = table[name]
        name = line.split(" = ")[0]
        example = " # example" in line and not line.startswith("#") and name in table
        lines.append(tomli_w.dumps({name: table[name]}).strip() if example else line)
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize(
    "path",
    ["guides.a.wall", "limits.target_life", "spring.design", "materials.steel.expansion"],
)  # fmt: skip
def test_a_removed_datum_is_cured_by_the_printed_block(path):
    text = tomli_w.dumps(without(*path.split(".")))
    bare = parse_case(text)
    assert verdict(judged(bare)) == "incomplete"
    block = printed(bare)
    must = block.partition("# Optional")[0]
    assert path.rpartition(".")[2] in must and "example" in must
    cured = parse_case(text + with_real_numbers(block))
    assert verdict(judged(cured)) == "pass"
    if path != "spring.design":  # keys with a default are not printed
        assert cured.sha256 == parse_case(tomli_w.dumps(COMPLETE)).sha256


def test_every_line_is_an_example_with_meaning_and_source():
    block = printed(parse_case(tomli_w.dumps(without("guides", "a", "wall"))))
    assert (
        block.partition("# Optional")[0]
        .rstrip()
        .endswith(
            "[[added]]\n\n[added.guides.a]\n"
            'wall = "2 mm"  # example; wall thickness of the bush; source: bush catalogue'
        )
    )


def test_optional_data_are_commented_out_and_can_be_uncommented():
    tables = without("guides", "a", "wall")
    del tables["cam"]["roughness"]
    text = tomli_w.dumps(tables)
    block = printed(parse_case(text))
    _, optional = block.split("# Optional")
    assert all(line.startswith("#") for line in optional.splitlines()[1:])
    assert "# [added.cam]" in optional
    whole = re.sub(r"^# (?=\[|\w+ = )", "", block, flags=re.MULTILINE)
    assert parse_case(text + whole).cam.roughness == pytest.approx(0.3e-6)


def test_a_complete_case_prints_that_no_data_are_missing():
    assert added_text((), (), {}) == NOTHING
    assert tomllib.loads(NOTHING) == {}


def test_a_strength_by_temperature_is_a_list_of_tables():
    block = added_text(["materials.nylon.strength_at"], (), {})
    (added,) = tomllib.loads(block)["added"]
    assert added["materials"]["nylon"]["strength_at"] == [
        {"temperature": "120 degC", "yield_strength": "30 MPa"}
    ]


@pytest.mark.parametrize(
    ("block", "message"),
    [
        ('[[added]]\n[added.cam]\nwidth = "99 mm"\n', "added.cam.width = 99 mm, must be left out"),
        ('[[added]]\n[added.cam]\nwidht = "9 mm"\n', "cam.widht = unknown key"),
        ('[added.cam]\nwidth = "99 mm"\n', "must be tables below [[added]]"),
        ('[[added]]\nname = "other"\n', "added.name = other, must be left out"),
    ],
)
def test_an_added_key_is_refused_where_it_contradicts_the_case(block, message):
    with pytest.raises(InputError, match=re.escape(message)):
        parse_case(tomli_w.dumps(COMPLETE) + block)


def test_the_command_prints_the_block_alone(tmp_path, capsys):
    case = tmp_path / "case.toml"
    case.write_text(tomli_w.dumps(without("guides", "a", "wall")), encoding="utf-8")
    assert check_command.check([case], missing=True) == INCOMPLETE
    block = capsys.readouterr().out
    (added,) = tomllib.loads(block)["added"]
    assert added == {"guides": {"a": {"wall": "2 mm"}}}
    case.write_text(case.read_text(encoding="utf-8") + block, encoding="utf-8")
    check_command.check([case], missing=True)
    assert "[[added]]" not in capsys.readouterr().out.partition("# Optional")[0]


def test_missing_data_are_those_of_one_case(tmp_path):
    with pytest.raises(InputError, match="--missing = 2 targets"):
        check_command.check([tmp_path, tmp_path], missing=True)


def test_what_is_added_twice_alike_is_read():
    text = tomli_w.dumps(without("guides", "a", "wall"))
    block = '[[added]]\n[added.guides.a]\nwall = "2 mm"\n'
    assert parse_case(text + block + block).guides.a.wall == pytest.approx(0.002)
