"""`camwright explain`: keys and checks in words; a misspelt one is refused with the closest."""

from __future__ import annotations

import pytest
from check_tools import BY_ID

from camwright.geometry.errors import InputError
from camwright.pipeline.case.keys import case_keys, keys_at
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.commands.explain_command import WIDTH, explain
from camwright.pipeline.results.check_report import sentence
from camwright.pipeline.results.check_text import check_text, checks_with, program_sources


def explained(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert explain(list(words)) == 0
    return capsys.readouterr().out


def test_a_key_has_meaning_range_default_example_place_and_use(capsys):
    text = explained(capsys, "guides.a.wall")
    *lines, checks = text.splitlines()
    assert lines == [
        "guides.a.wall: wall thickness of the bush",
        "  table       [guides.a]",
        "  accepted    > 0, <= 10000 mm",
        "  default     none",
        '  example     wall = "2 mm"',
        "  source      bush catalogue",
        "  used by     cycle, checks of the guides",
    ]
    assert checks.split()[0] == "checks"
    named = {f"guide_{name}_{side}" for name in ("temperature", "expansion") for side in "AB"}
    assert set(checks.replace(",", "").split()[1:]) == named


def test_a_limit_has_its_source_and_its_checks(capsys):
    text = explained(capsys, "limits.contact_safety")
    assert "default     1\n" in text
    assert "surface endurance of cam and follower" in text
    assert "contact_pressure" in text


def test_a_key_of_a_material_is_explained_by_any_name(capsys):
    text = explained(capsys, "materials.nylon.expansion")
    assert text.startswith("materials.nylon.expansion: coefficient of thermal expansion")
    assert "guide_expansion_A" in text and ">= 0, <= 0.01 1/K" in text


def test_a_check_has_formula_limit_source_load_cases_and_what_it_rests_on(capsys):
    text = " ".join(explained(capsys, "jam_index").split())
    one = BY_ID["jam_index"]
    for words in (one.formula, one.method, one.load_cases, "limits.jam_index, default 0.5"):
        assert words.rstrip(".") in text
    assert "rests on spring.rate, spring.preload" in text
    for each in DECLARED.values():
        names = check_text(each).rests_on
        assert len(names) == len(set(names)), each.id


def test_a_table_lists_its_keys_and_tables(capsys):
    text = explained(capsys, "cam")
    assert (
        "  tables      groove, conjugate, yoke, keyway, key, fit, end, crown, counter_hole" in text
    )
    assert "  bore_radius        half of the bore diameter" in text


def test_pivot_and_arm_are_explained_as_guides_are(capsys):
    """Tables with the keys of both bearings; a check of the bush by its own keys, not by a guide's;
    that of the arm's section with what it rests on.
    """
    table = explained(capsys, "follower.pivot")
    assert "  tables      bush, needle_bearing" in table and "  gravity_angle " in table
    bush = explained(capsys, "follower.pivot.bush.wear_rate")
    assert "  table       [follower.pivot.bush]" in bush and "pivot_wear" in bush.split()
    pressure = " ".join(explained(capsys, "pivot_pressure").split())
    assert "follower.pivot.bush.pressure_limit" in pressure and "part pivot" in pressure
    assert "guides.a.length" not in pressure
    arm = " ".join(explained(capsys, "arm_fatigue_roller").split())
    for words in ("limits.arm_safety, default 1.5", "part arm", "follower.arm.*_notch"):
        assert words in arm


def test_a_word_of_a_check_or_a_kind_shows_the_keys_of_its_name(capsys):
    """A check may be called as a key of another meaning, a kind as its table."""
    for word, heads in {
        "closure": ("closure: Lift closure", "cam.closure: what keeps", "limits.closure: "),
        "groove": ("groove: a groove (track, face) cam is stated by", "cam.groove: "),
        "conjugate": ("conjugate: a pair of discs is stated by", "cam.conjugate: "),
    }.items():
        texts = explained(capsys, word).rstrip("\n").split("\n\n")
        assert [text.startswith(head) for text, head in zip(texts, heads, strict=True)] == [
            True for _ in heads
        ]
        assert texts == [text.strip("\n") for text in texts]


@pytest.mark.parametrize(
    ("word", "closest"),
    [("guides.a.wal", "guides.a.wall"), ("wall", "guides.b.wall"), ("jam_indx", "jam_index"),
     ("limits.overspeeed", "limits.overspeed")],
)  # fmt: skip
def test_a_misspelt_word_is_refused_with_the_closest(word, closest):
    with pytest.raises(InputError, match=f"WORD = {word}, must be .*did you mean .*{closest}"):
        explain([word])


def test_every_key_and_check_is_explained_within_the_width(capsys):
    words = [*dict.fromkeys(key.path for key in case_keys()), *BY_ID]
    text = explained(capsys, *words)
    assert max(len(line) for line in text.splitlines()) <= WIDTH
    for word in words:
        assert f"{word}:" in text


def test_every_limit_names_the_checks_that_have_it():
    for one in BY_ID.values():
        if one.limit is not None:
            (key,) = keys_at(f"limits.{one.limit.id}")
            assert one.id in checks_with(key)


def test_the_values_to_be_confirmed_are_listed_by_their_sources(capsys):
    """Each once, under the text of its source; a value that was read is not."""
    assert explain(sources=True) == 0
    text = capsys.readouterr().out
    first, *lines = text.splitlines()
    assert max(map(len, lines)) <= WIDTH
    listed = [name for line in lines if line.startswith(" ") for name in line.split()]
    names = [name.rstrip(",") for name in listed]
    open_ = [name for name, source in program_sources() if not source.confirmed]
    assert sorted(names) == sorted(open_)
    assert len(set(names)) == len(names)
    assert first == f"{len(names)} values of the program are to be confirmed"
    for name in (
        "limits.jump_speed",
        "checks.spring_stress",
        "oils.iso_vg_100.density",
        "wires.music_wire.strength_at_1mm",
        "shaft_seats",
        "usual_ranges.torque",
    ):
        assert name in names  # fmt: skip
    assert "limits.closure" not in names


def test_keys_and_sources_are_explained_together(capsys):
    assert explain(["cam.width"], sources=True) == 0
    text = capsys.readouterr().out
    assert text.startswith("cam.width: ")
    assert "values of the program are to be confirmed\n" in text


def test_nothing_to_explain_is_refused():
    with pytest.raises(InputError, match="a key, a table, a check, --sources or --schema"):
        explain()


@pytest.mark.parametrize(
    ("text", "starts"),
    [("strength, wear", "Strength, wear."), ("at 1 it locks.", "At 1 it locks."),
     ("tau <= R", "tau <= R."), ("max(a) <= b", "max(a) <= b."), ("F/A <= p", "F/A <= p.")],
)  # fmt: skip
def test_a_sentence_starts_with_a_capital_letter_but_for_symbols(text, starts):
    assert sentence(text) == starts
