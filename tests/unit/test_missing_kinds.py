"""Kinds that are not done: refused by a sentence that says so and where they are listed; those that
a case states by other words are refused by these."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError
from camwright.pipeline.base.missing_kinds import LISTED, MISSING_KINDS, missing_kind
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.template import first_case

ROOT = Path(__file__).parents[2]
STRANGERS = ROOT / "tests" / "data" / "strangers" / "14-missing-kinds"
SENTENCE = {kind.name: kind.sentence for kind in MISSING_KINDS}
WRITTEN = {
    "follower": ("[follower]", 'kind = "{}"'),
    "cam": ("[cam]", 'kind = "{}"'),
    "spring": ("[spring]", 'kind = "{}"'),
    "guides": ("[guides.a]", 'card = "{}"'),
    "drive": ("[engine]", 'kind = "{}"'),
}
"""A line of a case file that names a kind, below the table of its part."""
LIFT = """[lift]
kind = "segments"
segment = [{{ law = "{}", angle = "180 deg", stroke = "9 mm" }},
           {{ law = "cycloidal", angle = "180 deg", stroke = "-9 mm" }}]
"""


def refused(text: str) -> str:
    with pytest.raises(InputError) as error:
        parse_case(text)
    return str(error.value)


@pytest.mark.parametrize(
    ("name", "start", "kind"),
    [
        ("uni", "lift.segment[0].law = uniform, must be", "constant velocity"),
        ("cv", "lift.segment[0].law = constant_velocity, must be", "constant velocity"),
        ("groove", "cam.kind = unknown key, must be", "a groove (track, face) cam"),
    ],
)
def test_kinds_of_strangers_are_refused_by_name(name: str, start: str, kind: str) -> None:
    with pytest.raises(InputError) as error:
        read_case(STRANGERS / f"{name}.toml")
    message = str(error.value)
    assert message.startswith(start)
    (sentence,) = (words for each, words in SENTENCE.items() if each.startswith(kind))
    assert sentence in message
    if kind.startswith("a groove"):
        assert 'is stated by cam.closure = "groove" and [cam.groove]' in sentence
    else:
        assert "is not done" in sentence and LISTED in sentence


def test_an_arm_in_guides_is_told_what_it_has_in_their_place() -> None:
    with pytest.raises(InputError) as error:
        read_case(STRANGERS / "osc.toml")
    limit = 'must be left out with follower.kind = "oscillating", which has [follower.arm]'
    assert str(error.value) == f"guides = a table, {limit}"


@pytest.mark.parametrize("name", ["cam.dxf", "CAM.DXF", "cam.v2.igs", "cam.stp"])
def test_a_drawing_is_no_lift(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("0\nSECTION\n", encoding="utf-8")
    text = small_machine("part")
    start, end = text.index("[engine]"), text.index("[mechanism]")
    text = f'{text[:start]}[lift]\nfile = "{name}"\n\n{text[end:]}'
    with pytest.raises(InputError) as error:
        parse_case(text, tmp_path)
    assert str(error.value).startswith(f"lift.file = {name}, must be a table; a contour (DXF")
    assert LISTED in str(error.value)


def written(area: str, word: str) -> str:
    """The small machine with a word as the kind of a part."""
    text = small_machine("part")
    if area == "lift":
        start, end = text.index("[engine]"), text.index("[mechanism]")
        return text[:start] + LIFT.format(word) + text[end:]
    table, line = WRITTEN[area]
    head, rest = re.split(rf"{re.escape(table)}[^\n]*\n", text, maxsplit=1)
    stated = f"{line.partition(' = ')[0]} = "
    own, bracket, others = rest.partition("\n[")
    kept = "\n".join(each for each in own.split("\n") if not each.startswith(stated))
    return f"{head}{table}\n{line.format(word)}\n{kept}{bracket}{others}"


@pytest.mark.parametrize("kind", MISSING_KINDS, ids=lambda kind: kind.words[0])
def test_every_word_of_every_kind_is_refused_by_its_sentence(kind) -> None:
    for word in kind.words:
        spelt = word.replace("_", "-").title()
        message = refused(written(kind.area, spelt))
        assert kind.sentence in message, word
        assert spelt in message or "unknown key" in message


@pytest.mark.parametrize("kind", [each for each in MISSING_KINDS if each.keys],
                         ids=lambda kind: kind.words[0])  # fmt: skip
def test_keys_and_tables_of_a_kind_are_refused_by_its_sentence(kind) -> None:
    tables = {"follower": "[follower]", "cam": "[cam]", "spring": "[spring]", "guides": "[guides]"}
    for key in kind.keys:
        if kind.area == "lift":
            text = written("lift", "cycloidal").replace("[lift]\n", f'[lift]\n{key} = "5 mm"\n', 1)
        else:
            table = tables[kind.area]
            text = small_machine("part").replace(f"{table}\n", f'{table}\n{key} = "5 mm"\n', 1)
        assert kind.sentence in refused(text), key
        assert missing_kind(key, "") is not None


def test_what_is_done_and_what_is_misspelt_is_not_called_missing() -> None:
    for key, word in (
        ("follower.kind", "roler"), ("lift.segment[0].law", "cycloid"), ("cam.face_width", ""),
        ("spring.constant", ""), ("follower.weight", ""), ("cam.diameter", ""),
        ("lift.step", ""), ("engine.kind", "cylinders"), ("sprung", ""),
    ):  # fmt: skip
        assert missing_kind(key, word) is None, (key, word)


def test_the_first_case_and_explain_know_them(command: Callable[..., tuple[int, str, str]]) -> None:
    with pytest.raises(InputError, match=r"a desmodromic .* is stated by cam\.closure = "):
        first_case("demo", "desmodromic")
    code, out, _ = command("explain", "desmodromic")
    assert code == 0
    assert 'is stated by cam.closure = "groove", "conjugate" or "yoke"' in " ".join(out.split())
    assert "not done" not in out
    code, out, _ = command("explain", "barrel")
    assert code == 0
    for words in ("curved face", "a barrel (cylindrical, drum) cam", "barrel-shaped spring"):
        assert words in " ".join(out.split())


def test_the_list_in_the_documents_is_this_one() -> None:
    page = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    section = page[page.index("## Kinds that are not done") :]
    for done, table in enumerate(section.split("<!-- end -->")[:2]):
        rows = [line for line in table.splitlines() if line.startswith("| ")][2:]
        kinds = [kind for kind in MISSING_KINDS if kind.done == bool(done)]
        assert len(rows) == len(kinds) > 0
        for row, kind in zip(rows, kinds, strict=True):
            start = f"| {kind.name.rstrip(',')} | {kind.area} | {', '.join(kind.words)}"
            assert row.startswith(start)
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "(docs/theory.md#kinds-that-are-not-done)" in readme
