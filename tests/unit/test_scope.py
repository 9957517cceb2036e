"""What the scope leaves out is not required, judged or governing; what is stated is judged."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.base.verdict import governing_id, within_depth
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import case_of
from camwright.pipeline.case.scope_section import OF_ARM, PART_WORDS, SCOPE_WORDS, SUBJECT_WORDS
from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import figures
from camwright.pipeline.results.trial import Trial

OF_STEM = tuple(name for name in SCOPE_WORDS if name not in OF_ARM)
"""What a sign-off may leave out of a follower on a stem."""
BARE = """
schema_version = 1
name = "bare"
lift = { kind = "eccentric", eccentricity = "5 mm" }
cam = { prime_radius = "40 mm", width = "10 mm", material = "case_hardened" }
roller = { radius = "10 mm", material = "case_hardened" }
follower = { mass = "1 kg" }
spring = { rate = "10 kN/m", preload = "100 N" }
materials = { case_hardened = { card = "case_hardened" } }
scope = { not_covered = "all", reason = "textbook question" }
solver = { positions = 36 }

[[load_case]]
name = "slow"
speed = "300 rpm"

[[load_case]]
name = "fast"
speed = "10 Hz"
"""


def tables(**changes: Any) -> dict[str, Any]:
    made = tomllib.loads(BARE)
    for name, keys in changes.items():
        made[name] = made.get(name, {}) | keys
    return made


def judged(case: Case) -> dict[str, Check]:
    """Checks of the preview that are judged at its depth, by id."""
    return {one.id: one for one in within_depth(preview_case(case, corners=False).checks)}


def test_cam_lift_follower_and_spring_alone_are_judged_whole() -> None:
    made = judged(case_of(tables()))
    assert {"pressure_angle", "curvature_ratio", "undercut", "jump", "jump_speed",
            "contact_force_margin", "contact_pressure", "shakedown"} <= set(made)  # fmt: skip
    assert {one.id for one in made.values() if one.status == "not_evaluated"} == set()
    torque = judged(case_of(tables(limits={"drive_torque": "10 N m"})))["drive_torque"]
    assert torque.status == "pass"
    assert "drive_torque" not in made


def test_no_check_of_what_is_left_out_is_made_or_governs() -> None:
    made = judged(case_of(tables()))
    outside = {one.id for one in DECLARED.values() if one.part or one.within}
    assert not outside & set(made)
    assert len(outside) > 60
    assert governing_id(made.values()) in made


def test_all_is_every_name_and_is_stated() -> None:
    case = case_of(tables())
    assert case.scope.not_covered == OF_STEM
    assert all(SCOPE_WORDS[name] in case.scope.statement for name in OF_STEM)
    assert case_of(tables(scope={"not_covered": ["all"]})).scope == case.scope
    assert case_of(case.tables()).sha256 == case.sha256
    with pytest.raises(InputError, match=r"scope\.not_covered"):
        case_of(tables(scope={"not_covered": "some"}))
    with pytest.raises(InputError, match=r"scope\.reason"):
        case_of(tables(scope={"reason": ""}))


@pytest.mark.parametrize(
    ("left_out", "missing"),
    [("stem", "follower.stem_diameter"), ("bore", "cam.bore_radius"),
     ("line_ends", "roller.width"), ("roller_bearing", "roller.hub_radius")],
)  # fmt: skip
def test_a_required_key_is_asked_for_unless_it_is_left_out(left_out: str, missing: str) -> None:
    others = [name for name in OF_STEM if name != left_out]
    with pytest.raises(InputError) as refusal:
        case_of(tables(scope={"not_covered": others}))
    assert missing.rpartition(".")[2] in str(refusal.value)


@pytest.mark.parametrize(
    ("left_out", "asked"),
    [("friction", "roller.friction"), ("line_ends", "cam.end"),
     ("requirements", "limits.overspeed"), ("spring", "spring.travel_max"),
     ("requirements", "limits.cam_radius")],
)  # fmt: skip
def test_a_datum_is_missing_unless_it_is_left_out(left_out: str, asked: str) -> None:
    others = [name for name in OF_STEM if name != left_out]
    stated = {"roller": {"width": "10 mm"}} if left_out == "line_ends" else {}
    made = judged(case_of(tables(scope={"not_covered": others}, **stated)))
    assert any(asked in one.missing for one in made.values())
    assert not any(asked in one.missing for one in judged(case_of(tables())).values())


def test_what_is_stated_is_judged_though_it_could_be_left_out() -> None:
    made = judged(case_of(tables(spring={"travel_max": "9 mm"}, limits={"cam_radius": "50 mm"})))
    assert (made["spring_travel"].status, made["cam_radius"].status) == ("fail", "pass")
    case = case_of(tables(limits={"overspeed": "1500 rpm"}))
    assert judged(case)["jump_speed"].limit == pytest.approx(1.3 * 157.0796, rel=1e-6)


def test_a_stand_in_repeats_no_refused_value() -> None:
    wrong = {"width": "-10 mm", "material": "steal", "prime_radius": "40"}
    with pytest.raises(InputError) as refusal:
        case_of(tables(cam=wrong))
    fields = [line.partition(" = ")[0] for line in refusal.value.lines]
    assert sorted(fields) == ["cam.material", "cam.prime_radius", "cam.width"]


def test_stand_ins_are_stated_as_assumed() -> None:
    case = case_of(tables())
    assert case.cam.bore_radius == pytest.approx(15e-3)
    assert case.roller.width == case.cam.width
    assert case.mechanism.gear_ratio == 1.0
    assert case.follower.stem_material == case.cam.material
    assert case.limits.overspeed == pytest.approx(20 * 3.14159265, rel=1e-6)  # of the faster
    for key in ("cam.bore_radius", "roller.width", "follower.stem_diameter", "guides.spacing"):
        assert case.sources[key].text.startswith("assumed, as the scope leaves out"), key
    assert "assumed" in case.limits.sources["overspeed"].text


def test_words_of_parts_and_subjects_differ() -> None:
    assert not set(PART_WORDS) & set(SUBJECT_WORDS)
    assert len(set(SCOPE_WORDS.values())) == len(SCOPE_WORDS)


def test_figures_are_known_before_the_corners() -> None:
    early: list[Trial] = []
    trial = preview_case(case_of(tables()), nominal=early.append)
    (first,) = early
    assert not first.corners and trial.corners
    assert figures(first) == figures(trial)


def test_check_prints_them_first(tmp_path: Path, command: Callable[..., Any]) -> None:
    (tmp_path / "bare.toml").write_text(BARE, encoding="utf-8")
    code, out, _ = command("check", tmp_path / "bare.toml")
    assert code == 3
    assert out.startswith("figures: lift 10 mm, pressure angle ")
    assert out.index("figures of fast at 600 rpm") < out.index("screen: OPEN")
    assert out.count("figures:") == 1
    code, out, _ = command("check", tmp_path / "bare.toml", "--json")
    assert json.loads(out)["figures"]["lift_max_mm"] == pytest.approx(10.0, rel=1e-6)
