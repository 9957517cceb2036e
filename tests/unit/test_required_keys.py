"""Required keys that a case lacks: all of them at once, with an example each."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_machine import small_machine

from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.error_text import MissingKeysError
from camwright.pipeline.checks.check import Check
from camwright.pipeline.preview import preview_case

STRANGERS = Path(__file__).parents[1] / "data" / "strangers" / "04-norton-double-dwell"
FIRST = (STRANGERS / "first_try.toml").read_text(encoding="utf-8")
WHOLE = (STRANGERS / "case.toml").read_text(encoding="utf-8")
SCOPE = WHOLE[WHOLE.index("[scope]") : WHOLE.index("[[load_case]]")]
LACKING = (
    "cam.width", "cam.bore_radius", "cam.material", "roller.width", "roller.hub_radius",
    "roller.material", "roller.bearing.name", "follower.stem_diameter", "follower.stem_material",
    "follower.overhang_at_max_lift", "guides.spacing", "guides.a.length", "guides.a.diameter",
    "guides.a.card", "guides.b.length", "guides.b.diameter", "guides.b.card",
    "materials.bearing_steel.card", "materials.c45.card", "materials.case_hardened.card",
)  # fmt: skip


def lacking(text: str) -> MissingKeysError:
    with pytest.raises(MissingKeysError) as error:
        parse_case(text)
    return error.value


def checks(case: Case) -> dict[str, Check]:
    return {check.id: check for check in preview_case(case, corners=False).checks}


def test_all_missing_keys_are_named_with_examples_by_their_tables() -> None:
    error = lacking(FIRST)
    assert sorted(error.keys) == sorted(LACKING)
    message = str(error)
    assert message.startswith("cam.width = missing, must be given, as all 20 missing keys; ")
    assert (
        '[cam] width = "10 mm", bore_radius = "8.5 mm", material = "case_hardened"; [r' in message
    )
    assert '[guides.a] length = "20 mm", diameter = "16 mm", card = "ptfe_lined"; [gu' in message
    assert " more)" not in message
    assert "camwright check CASE --missing" in message


def test_the_examples_complete_the_case() -> None:
    error = lacking(FIRST)
    case = parse_case(f"{FIRST}\n{error.toml}")
    assert case.cam.width == 0.010
    assert {key.rpartition(".")[2] for key in error.keys} <= set(re.findall(r"\w+", error.toml))


def test_check_prints_them_as_toml(
    tmp_path: Path, command: Callable[..., tuple[int, str, str]]
) -> None:
    file = tmp_path / "first.toml"
    file.write_text(FIRST, encoding="utf-8")
    code, out, _ = command("check", file, "--missing")
    assert code == 3
    assert out.strip() == lacking(FIRST).toml.strip()
    assert set(tomllib.loads(out)["added"][0]) == {
        "cam",
        "roller",
        "follower",
        "guides",
        "materials",
    }
    code, _, err = command("check", file)
    assert code == 2
    assert all(key.rpartition(".")[2] in err for key in LACKING)


def test_parts_out_of_scope_are_not_asked_for() -> None:
    error = lacking(FIRST.replace("[[load_case]]", f"{SCOPE}[[load_case]]"))
    out = ("guides", "roller.bearing", "roller.hub_radius")
    left = [key for key in LACKING if not key.startswith(out)]
    assert sorted(error.keys) == sorted(left)
    own = f"{SCOPE}[mechanism]\ngear_ratio = 1\n\n[[load_case]]"
    case = parse_case(f"{FIRST.replace('[[load_case]]', own)}\n{error.toml}")
    assert case.guides.a.friction == case.guides.b.friction == 0.0
    assert "assumed" in case.guides.a.source.text
    assert "16.471 N keeps it on the cam" in checks(case)["contact_force_margin"].note


def test_the_textbook_question_has_its_answer() -> None:
    """By the closed form of the law: leaves at 56.7 deg, least force -6.471 N at 71.0 deg."""
    case = read_case(STRANGERS / "case.toml").with_positions(3600)
    trial = preview_case(case, corners=False)
    known = {check.id: check for check in trial.checks}
    note = known["contact_force_margin"].note
    assert "axial force without friction -6.471 N at 71.01 deg; a preload above 16.471 N" in note
    loads = trial.cycles[0].loads
    assert np.degrees(loads.theta[loads.ends.first]) == pytest.approx(56.7, abs=0.05)
    least = loads.required_force.argmin()
    assert loads.required_force[least] == pytest.approx(-6.471, abs=5e-4)
    assert np.degrees(loads.theta[least]) == pytest.approx(71.0, abs=0.05)


@pytest.mark.parametrize(
    ("old", "new", "start", "keys"),
    [
        ("[spring]", "[[waivers]]", "spring.", ("spring.rate", "spring.preload")),
        ("speed = ", "# ", "load_case[0].speed = missing", ("load_case[0].speed",)),
    ],
)
def test_missing_tables_and_rows_of_lists_are_named(
    old: str, new: str, start: str, keys: tuple[str, ...]
) -> None:
    text = small_machine("part")
    if old == "[spring]":
        table = re.search(r"\[spring\]\n(?:[^\[\n][^\n]*\n|\n)*", text)
        assert table is not None
        text = text.replace(table[0], "")
        text = re.sub(r"\[spring\.\w+\]\n(?:[^\[\n][^\n]*\n|\n)*", "", text)
    else:
        head, tail = text.split("[[load_case]]", 1)
        text = f"{head}[[load_case]]{tail.replace(old, new, 1)}"
    error = lacking(text)
    assert str(error).startswith(start)
    assert error.keys == keys


def test_wrong_and_missing_keys_are_all_named() -> None:
    text = FIRST.replace('"100 N/m"', '"-1 N/m"')
    with pytest.raises(Exception, match=r"spring\.rate = -1 N/m, must be > 0") as error:
        parse_case(text)
    listed = str(error.value).partition("; ")[2]
    for name in ("[cam]", "width", "[follower]", "stem_material", "guides"):
        assert name in listed, name


def test_json_of_a_case_that_cannot_be_read_is_no_document(
    tmp_path: Path, command: Callable[..., tuple[int, str, str]]
) -> None:
    file = tmp_path / "first.toml"
    file.write_text(FIRST, encoding="utf-8")
    code, out, _ = command("check", file, "--json")
    assert (code, out) == (2, "")
    whole: Any = json.loads(command("check", STRANGERS / "case.toml", "--json")[1])
    assert whole["checks"]
