"""Provenance of the shipped cards; source and confirmation of the values of a case."""

import ast
import json
import re
import tomllib
from datetime import date
from pathlib import Path

import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError
from camwright.pipeline.base.source import Source, entry_of, old_words, source_in
from camwright.pipeline.case.cards.card_filling import FOLDER, KINDS, known_cards
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.provenance import (
    PROVENANCE,
    numbers_of,
    provenance_of,
    source_in_card,
    titles,
)
from camwright.pipeline.case.cards.substitution import with_roller
from camwright.pipeline.case.case_file import case_of, parse_case, read_case
from camwright.pipeline.case.case_writer import value_text
from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.case.requirements_section import Confirmation
from camwright.pipeline.case.value_sources import source_of, values_at, values_in
from camwright.pipeline.checks.registry import CHECKS

ROOT = Path(__file__).parents[2]
STORED = json.loads((ROOT / "tests/data/unconfirmed.json").read_text(encoding="utf-8"))
CARDS = known_cards(None)
SPRINGS = tomllib.loads((FOLDER / "springs.toml").read_text(encoding="utf-8"))
WITH_NUMBERS = [
    *((f"{kind}.{name}", card) for kind in KINDS for name, card in CARDS[kind].items()),
    *((f"wires.{name}", card) for name, card in SPRINGS["wires"].items()),
]


@pytest.mark.parametrize(("name", "card"), WITH_NUMBERS, ids=[name for name, _ in WITH_NUMBERS])
def test_every_number_of_every_card_has_its_provenance(name, card):
    """A title with its edition or address, and whether the number was read or recalled."""
    numbers = list(numbers_of(card))
    assert numbers
    for key in numbers:
        entry = provenance_of(card, key, name)
        assert entry is not None, f"{name}.{key}"
        assert entry.source in titles(), f"{name}.{key}: {entry.source} is not in sources.toml"
        assert entry.known in ("read", "recalled"), f"{name}.{key}"
        assert entry.stated.confirmed == (entry.known == "read"), f"{name}.{key}"


def test_a_number_read_has_an_address_an_edition_or_a_copy():
    for name, card in WITH_NUMBERS:
        for key in numbers_of(card):
            entry = provenance_of(card, key, name)
            assert entry is not None
            title = titles()[entry.source]
            placed = re.search(
                r"\.(com|se|in|dk|de|ch|html)\b|\b(19|20)\d\d\b|read in a copy", title
            )
            assert entry.known == "recalled" or placed, f"{name}.{key}: {title}"


def test_every_title_is_cited():
    cited = {entry["source"] for _, card in WITH_NUMBERS for entry in card[PROVENANCE].values()}
    assert cited <= set(titles())
    assert set(titles()) - cited == set()


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ('"*" = {source = "book", known = "guessed"}', "known = guessed, must be 'read'"),
        ('"*" = {source = "book"}', "known = missing"),
        ('"*" = "book"', r"provenance\.\* = book, must be a table"),
        ('nu = {source = "book", known = "read"}', r"provenance\.E = missing"),
    ],
)
def test_a_users_provenance_that_is_incomplete(tmp_path, entry, message):
    (tmp_path / "cards.toml").write_text(
        '[materials.own]\nE = "200 GPa"\nnu = 0.29\nyield_strength = "300 MPa"\n'
        f'density = "7800 kg/m^3"\nsource = "mill"\n[materials.own.provenance]\n{entry}\n'
    )
    with pytest.raises(InputError, match=message):
        parse_case(small_machine("cards") + '\n[materials.extra]\ncard = "own"\n', tmp_path)


def extra(*lines):
    """The template with a material more."""
    return parse_case("\n".join([small_machine("cards"), "[materials.extra]", *lines]))


def test_the_resolved_case_has_the_source_of_every_number_of_a_card():
    case = extra('card = "pa66"')
    read, recalled = (
        case.sources[f"materials.extra.{key}"] for key in ("yield_strength", "swelling")
    )
    assert "Ultramid A3K" in read.text
    assert "conditioned at 50 % RH" in read.text
    assert read.confirmed
    assert not recalled.confirmed
    again = parse_case(case.to_toml())
    assert again.sources == case.sources
    assert again.to_toml() == case.to_toml()


def test_a_number_of_the_case_has_the_source_of_the_case():
    """With a source of its own it is confirmed; without one it is not, beside a card."""
    own = extra('card = "pa66"', 'yield_strength = "48 MPa"', 'source = "certificate 4711"')
    bare = extra('card = "pa66"', 'yield_strength = "48 MPa"')
    value = "materials.extra.yield_strength"
    assert source_of(own.tables(), value) == Source("certificate 4711", confirmed=True)
    assert not source_of(own.tables(), "materials.extra.swelling").confirmed
    assert not source_of(bare.tables(), value).confirmed


def test_the_case_may_state_the_source_of_a_single_number():
    text = (
        small_machine("cards") + '\n[sources]\n"materials.extra.swelling" = "measured, report 12"\n'
    )
    case = parse_case(text + '[materials.extra]\ncard = "pa66"\n')
    assert case.sources["materials.extra.swelling"] == Source("measured, report 12", confirmed=True)
    assert "Ultramid" in case.sources["materials.extra.E"].text


@pytest.mark.parametrize(
    "text", ["", "  ", "recalled", "makers: verify", "assumed", "an Estimate", "Assumption of C25"]
)
def test_plain_texts_that_are_read_as_unconfirmed(text):
    """Empty, or with a word by which a file of version 0.1 left its value open."""
    assert not source_in(text).confirmed


@pytest.mark.parametrize("text", ["EN 10025-2", "certificate 4711", "verified by test 12"])
def test_texts_that_confirm(text):
    assert source_in(text).confirmed


@pytest.mark.parametrize("confirmed", [True, False])
@pytest.mark.parametrize("text", ["EN 10025-2", "verify the seal, data sheet 12", 'a "b" \\ c'])
def test_a_stated_confirmation_decides_whatever_the_words(text, confirmed):
    entry = {"text": text, "confirmed": confirmed}
    source = Source(text, confirmed=confirmed)
    assert source_in(entry) == source
    assert source_in(entry_of(source)) == source
    assert source_in(tomllib.loads(f"source = {value_text(source)}")["source"]) == source
    assert str(source).endswith(" (to be confirmed)") is not confirmed
    case = extra('card = "pa66"', f"source = {value_text(source)}", 'yield_strength = "48 MPa"')
    assert source_of(case.tables(), "materials.extra.yield_strength") == source
    assert parse_case(case.to_toml()).to_toml() == case.to_toml()


@pytest.mark.parametrize(
    "entry",
    [
        '{ text = "a" }',
        '{ text = "a", confirmed = "no" }',
        '{ text = "a", confirmed = true, b = 1 }',
    ],
)
def test_a_source_of_another_form_is_refused(entry):
    with pytest.raises(InputError, match=r"source = a table, must be a text, or \{ text ="):
        extra('card = "pa66"', f"source = {entry}")


def test_a_plain_text_with_a_word_of_version_0_1_is_unconfirmed_with_a_warning():
    case = extra('card = "pa66"', 'source = "mill: verify"', 'yield_strength = "48 MPa"')
    assert not source_of(case.tables(), "materials.extra.yield_strength").confirmed
    (warning,) = old_words(case.written.tables)
    assert 'source "mill: verify"' in warning
    assert "{ text = ..., confirmed = false }" in warning
    assert not old_words(case.tables())  # the resolved case states it


CARD = (
    '[materials.own]\nE = "200 GPa"\nnu = 0.29\nyield_strength = "300 MPa"\n'
    'density = "7800 kg/m^3"\nsource = {}\n'
)


@pytest.mark.parametrize("own", ["", 'nu = 0.28\nsource = "certificate 4711"\n'])
@pytest.mark.parametrize(
    ("source", "warns"),
    [
        ('"mill: verify"', True),
        ('{ text = "mill: verify", confirmed = false }', False),
        ('"mill"', False),
    ],
)
def test_a_users_card_warns_as_a_case_does(tmp_path, source, warns, own):
    """Whether the table that takes the card states a source of its own values, or none."""
    (tmp_path / "cards.toml").write_text(CARD.format(source), encoding="utf-8")
    text = small_machine("cards") + f'\n[materials.extra]\ncard = "own"\n{own}'
    case = parse_case(text, tmp_path)
    warnings = old_words(case.written.tables)
    assert ["mill: verify" in each for each in warnings] == [True] * warns
    confirmed = source == '"mill"'
    assert source_of(case.tables(), "materials.extra.E").confirmed is confirmed
    assert not old_words(case.tables())
    assert parse_case(case.to_toml()).to_toml() == case.to_toml()


def test_no_function_reads_a_confirmation_from_words():
    """But the reader of the plain texts of version 0.1."""
    words = re.compile("recalled|verify|assum|estimat")
    readers = {
        path.name
        for part in ("pipeline", "reports", "geometry", "meshes")
        for path in (ROOT / part).rglob("*.py")
        if words.search(text := path.read_text(encoding="utf-8"))
        for node in ast.walk(ast.parse(text))
        if isinstance(node, (ast.Call, ast.Compare))
        and any(_is_text(each, words) for each in _operands(node))
    }
    assert readers == {"source.py"}


def _operands(node):
    """Texts that a comparison or a function of texts looks for."""
    if isinstance(node, ast.Compare):
        return [node.left, *node.comparators]
    searches = ("compile", "search", "match", "find", "startswith", "endswith", "count")
    named = isinstance(node.func, ast.Attribute) and node.func.attr in searches
    return node.args if named else []


def _is_text(node, words):
    text = isinstance(node, ast.Constant) and isinstance(node.value, str)
    return text and words.search(node.value) is not None


@pytest.mark.parametrize("name", STORED)
def test_the_values_to_be_confirmed_are_those_stored(name):
    """A change of `data/unconfirmed.json` needs a source that was read, or a value more."""
    if name == "limits":
        open_ = [key for key, row in LIMITS.items() if not row.source.confirmed]
    elif name == "checks":
        own = [one for one in CHECKS if one.limit is None and one.source]
        open_ = [one.id for one in own if not one.source.confirmed]
    else:
        tables = read_case(ROOT / "cases" / name).tables()
        open_ = [v for v in values_in(tables) if not source_of(tables, v).confirmed]
    assert sorted(open_) == STORED[name]


def test_every_shipped_case_is_stored():
    cases = ROOT / "cases"
    shipped = {str(path.relative_to(cases)) for path in cases.rglob("*.toml")}
    assert shipped - {"papers/mechanisms.toml"} == set(STORED) - {"limits", "checks"}


@pytest.mark.parametrize("path", [*ROOT.glob("cases/**/*.toml"), *FOLDER.glob("*.toml")])
def test_no_shipped_source_rests_on_words(path):
    if path.name != "mechanisms.toml":
        tables = tomllib.loads(path.read_text(encoding="utf-8"))
        assert not old_words({k: _bare(v) for k, v in tables.items()})


def _bare(entry):
    return (
        {k: _bare(v) for k, v in entry.items() if k != PROVENANCE}
        if isinstance(entry, dict)
        else entry
    )


def test_the_source_of_a_bearing_reaches_its_ring():
    tables = parse_case(small_machine("cards")).tables()
    ring = {"outer_diameter": "16 mm", "balls": 6, "source": "ring"}
    tables["roller"] = {"bearing": {"C": "1 kN", "ring": ring, "source": "maker"}}
    assert source_of(tables, "roller.bearing.C").text == "maker"
    assert source_of(tables, "roller.bearing.ring.balls").text == "ring"


def test_values_of_a_role_are_those_of_its_material():
    tables = {
        "cam": {"material": "steel", "width": "5 mm"},
        "materials": {"steel": {"E": "210 GPa", "endurance_slope": 7.0, "endurance_pressure": "1"}},
    }
    assert values_at(tables, "cam.material.E") == ("materials.steel.E",)
    assert values_at(tables, "cam.material.endurance_*") == (
        "materials.steel.endurance_slope", "materials.steel.endurance_pressure",
    )  # fmt: skip
    assert values_at(tables, "cam.material.hardness") == ()
    assert values_at(tables, "cam.width") == ("cam.width",)
    assert values_at(tables, "spring.design.coils") == ()
    assert "materials.steel.E" in set(values_in(tables))


@pytest.mark.parametrize(
    ("section", "message"),
    [
        (
            '[sources]\n"materials.structurel.E" = "x"\n',
            "a value of the case; did you mean materials.structural.E?",
        ),
        (
            '[[confirmed]]\nvalue = "materials.structural.e"\nsource = "x"\n',
            "confirmed.value = materials.structural.e, must be a value of the case; did you mean",
        ),
        (
            '[[confirmed]]\nvalue = "zzz"\nsource = "x"\n',
            "confirmed.value = zzz, must be a value of the case, by its dotted name",
        ),
        (
            '[[confirmed]]\nvalue = "materials.structural.E"\nsource = "recalled"\n',
            "confirmed.materials.structural.E.source = recalled (to be confirmed), must",
        ),
        (
            '[[confirmed]]\nvalue = "materials.structural.E"\nname = "A. Engineer"\n',
            "confirmed.materials.structural.E.source = missing",
        ),
    ],
)
def test_sources_and_confirmations_that_are_refused(section, message):
    text = small_machine("cards") + '\n[materials.structural]\ncard = "structural"\n'
    with pytest.raises(InputError, match=re.escape(message)):
        parse_case(text.replace("\n[[load_case]]", f"\n{section}\n[[load_case]]", 1))


def test_a_confirmation_is_a_source_or_a_name_with_a_date():
    signed = {"name": "A. Engineer", "date": date(2025, 1, 2)}
    assert Confirmation.model_validate({"value": "materials.a.E", "source": "sheet"}).date is None
    assert Confirmation.model_validate({"value": "materials.a.E", **signed}).name == "A. Engineer"


def test_source_in_card_of_a_card_without_provenance_are_its_source():
    assert source_in_card({"E": "200 GPa", "source": "mill"}, "E", "x").text == "mill"


def test_a_replaced_part_brings_its_own_sources_and_no_confirmation_of_the_old_one():
    name = "maker_1_625_2Z"
    confirmed = [
        {"value": "roller.bearing.speed_limit", "source": "test bench"},
        {"value": "roller.inertia", "source": "weighed"},
        {"value": "cam.width", "source": "drawing"},
    ]
    tables = tomllib.loads(small_machine("cards"))
    tables["roller"] |= {"bearing": {"card": "maker_1_625_2RS"}, "inertia": "1 g cm^2"}
    case = case_of(tables | {"confirmed": confirmed})
    assert not case.sources["roller.bearing.speed_limit"].confirmed
    card = catalogue_of(None).rollers[name]
    other = with_roller(case, name, card, None)
    assert other.sources["roller.bearing.speed_limit"].confirmed
    assert "E2.625-2Z" in other.sources["roller.bearing.C"].text
    assert [each.value for each in other.confirmed] == ["cam.width"]


def test_the_lightest_spring_of_a_catalogue_has_the_sources_of_its_wire():
    tables = tomllib.loads(small_machine("cards"))
    tables["spring"] |= {"catalogue": "shipped", "travel_max": "30 mm"}
    tables["spring"].pop("design", None)
    case = case_of(tables)
    assert "table 10-4" in case.sources["spring.design.strength_at_1mm"].text
    assert case.sources["spring.design.coils"].confirmed
