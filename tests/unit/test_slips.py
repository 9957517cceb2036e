"""Slips in a case file that hide one another: all are told, and the one that explains the rest."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.added_tables import line_of
from camwright.pipeline.case.case_file import parse_case, tables_in
from camwright.pipeline.case.keys import REQUIRED, keys_in
from camwright.pipeline.case.unknown_keys import with_unknown_keys
from camwright.pipeline.follower.spring_kinds import SHAPES

ROOT = Path(__file__).resolve().parents[2]
MOTIONS = ROOT / "cases" / "motions"
DATA = ROOT / "tests" / "data"


def text_of(path: Path, *changes: tuple[str, str]) -> str:
    """A case file with changes by pattern, each of which is there."""
    text = path.read_text(encoding="utf-8")
    for old, new in changes:
        text, count = re.subn(old, new, text, flags=re.MULTILINE)
        assert count, old
    return text


def told(text: str) -> tuple[str, ...]:
    with pytest.raises(InputError) as caught:
        parse_case(text, MOTIONS)
    return caught.value.lines


@pytest.mark.parametrize(
    ("name", "old", "new", "refused"),
    [
        ("feeder-groove", 'card = "ptfe_lined"', 'card = "ptfe"', "guides.a.card = ptfe"),
        ("pump-yoke", '^kind = "flat"', 'kind = "roller"', "follower.face = a table"),
        ("pump-yoke", '^kind = "flat"', 'kind = "oscillating"', "guides = a table"),
        ("tucker-groove", "^length = .90 mm.", 'start_angle = "9 deg"', "follower.arm.start_angle"),
        ("packaging-arm", "^preload = .*", "", "spring.preload = missing"),
        ("feeder-groove", "^bore_radius = .*", 'bore_radius = "60 mm"', None),
    ],
)
def test_an_unknown_key_is_told_beside_what_else_is_refused(name, old, new, refused):
    """Whatever refuses the case: a card, a rule between keys of one table or of several."""
    slip = ('^roughness = "0.3 um"', 'roughnes = "0.3 um"')
    lines = told(text_of(MOTIONS / f"{name}.toml", slip, (old, new)))
    assert lines[0] == "cam.roughnes = unknown key, must be a known key; did you mean roughness?"
    assert len(set(lines)) == len(lines)
    if refused is not None:
        assert any(line.startswith(refused) for line in lines)


@pytest.mark.parametrize(
    "path", [*sorted(MOTIONS.glob("*.toml")), *sorted(DATA.glob("*.toml"))], ids=lambda p: p.stem
)
def test_no_key_of_a_case_that_is_read_is_unknown(path):
    """The walk knows every table: names of materials, rows of lists, cards, former names."""
    if path.stem in ("impossible", "soft_spring"):  # not read either
        return
    none = InputError("none", "", "")
    assert with_unknown_keys(none, tables_in(path.read_bytes())) is none


@pytest.mark.parametrize("kind", SHAPES)
@pytest.mark.parametrize("stated", ["", 'kind = "torsionpivot"\n'], ids=["none", "misspelt"])
def test_the_table_of_a_spring_without_its_kind_asks_for_the_kind(kind, stated):
    """Not for rate and preload, which the table sets."""
    table = SHAPES[kind].table
    needed = [line_of(key) for key in keys_in(table) if key.default == REQUIRED]
    own = f"[spring]\n{stated}[{table}]\n" + "\n".join(needed)
    old = r"^\[spring\]\n(.*\n)*?(?=\[cam\])"
    (line,) = told(text_of(MOTIONS / "packaging-arm.toml", (old, f"{own}\n")))
    assert line.startswith("spring.kind = torsionpivot" if stated else f"{table} = a table")
    assert f'spring.kind = "{kind}"' in line or stated


@pytest.mark.parametrize(
    ("name", "left_out", "line"),
    [
        ("feeder-groove", "closure", 'must be left out, or cam.closure = "groove"'),
        ("transfer-conjugate", "closure", 'must be left out, or cam.closure = "conjugate"'),
        ("pump-yoke", "closure", 'must be left out, or cam.closure = "yoke"'),
        ("tucker-groove", "lift kind", 'lift = a table, must be a table with kind = '),
        ("pump-yoke", "follower kind", 'must be left out, or follower.kind = "flat"'),
        ("tucker-groove", "follower kind", 'must be left out, or follower.kind = "oscillating"'),
    ],
)  # fmt: skip
def test_a_table_without_its_kind_is_what_is_refused(name, left_out, line):
    """Not what the default kind would need: a spring, a stem with its guides, a file."""
    table, _, key = left_out.rpartition(" ")
    start = rf"(?<=^\[{table}\]\n)" if table else "^"
    told_lines = told(text_of(MOTIONS / f"{name}.toml", (rf"{start}{key} = .*", "")))
    assert len(told_lines) == 1 and line in told_lines[0]


def test_a_misspelt_closure_is_refused_alone():
    """Not the spring, which a groove does without."""
    (line,) = told(
        text_of(MOTIONS / "feeder-groove.toml", ('^closure = "groove"', 'closure = "grove"'))
    )
    assert line.startswith("cam.closure = grove, must be 'spring'")
