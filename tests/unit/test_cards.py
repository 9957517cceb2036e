"""Cards: shipped and the user's own, filled in, with their sources, refused when unknown."""

import re

import made_trial as made
import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.cards.card_filling import known_cards, viscosity
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.case.template import first_case
from camwright.pipeline.checks.contact_strength import contact_pressure, pressure_at_life
from camwright.pipeline.contact.hertz import contact_modulus
from camwright.pipeline.contact.oil_film import Lubricant
from camwright.pipeline.preview import preview_case


def with_card(table, *lines):
    return parse_case(small_machine("cards") + f"\n[{table}]\n" + "\n".join(lines) + "\n")


def extra(*lines):
    """The material of a card that the template does not name."""
    return with_card("materials.extra", *lines).materials["extra"]


def test_every_shipped_material_is_a_card_of_a_case():
    for name in known_cards(None)["materials"]:
        card = extra(f'card = "{name}"')
        assert isinstance(card, Material)
        assert card.source.text.startswith(f"card {name}: ")


def test_the_usual_materials_bushes_and_oils_are_shipped():
    cards = known_cards(None)
    hardened = {"case_hardened", "induction_hardened", "through_hardened"}
    assert hardened | {"structural", "nodular_iron"} <= set(cards["materials"])
    assert {"pa6", "pa66", "pom", "ptfe_lined", "bronze"} <= set(cards["bushes"])
    assert {"iso_vg_32", "iso_vg_68", "iso_vg_220"} <= set(cards["oils"])


def test_endurance_lines_give_the_endurance_pressure_at_1e8():
    """A and B against the pressures beside them: 2 % as K is rounded, 5 % for the softer iron."""
    for name, card in known_cards(None)["materials"].items():
        if "endurance_slope" in card:
            modulus = contact_modulus(float(card["E"].split()[0]) * 1e9, card["nu"], 210e9, 0.3)
            pressure = pressure_at_life(
                1e8, card["endurance_slope"], card["endurance_intercept"], modulus
            )
            printed = 1e6 * float(card["endurance_pressure"].split()[0])
            width = 0.05 if name == "nodular_iron" else 0.02
            assert pressure == pytest.approx(printed, rel=width), name


def test_what_the_case_gives_stands():
    card = extra('card = "structural"', 'yield_strength = "400 MPa"')
    assert card.yield_strength == 400e6
    assert card.E == 210e9


def test_a_resolved_case_holds_the_numbers_and_no_card():
    case = with_card("lubricant", 'card = "iso_vg_68"', 'temperature = "333.15 K"')
    text = case.to_toml()
    assert "card =" not in text
    assert parse_case(text) == case
    assert isinstance(case.lubricant, Lubricant)


def test_a_bush_brings_its_material():
    text = small_machine("cards")
    head, _, tail = text.partition("[guides.a]")
    body, _, rest = tail.partition("\n[")
    kept = [line for line in body.splitlines() if line.startswith(("length", "diameter"))]
    lined = f"{head}[guides.a]\n" + "\n".join([*kept, 'card = "ptfe_lined"']) + f"\n\n[{rest}"
    guide = parse_case(lined).guides.a
    assert guide.material.name == "ptfe_lined"
    assert guide.pv_limit == pytest.approx(1.8e6)
    assert not guide.source.confirmed
    assert guide.material.source.text.startswith("card ptfe_lined: ")


def test_viscosity_by_hand():
    """The ends come back; between them Walther's line: log log 28.66 + 0.7 = 0.16665."""
    assert viscosity(68.0, 8.7, 313.15) == pytest.approx(68.0, rel=1e-12)
    assert viscosity(68.0, 8.7, 373.15) == pytest.approx(8.7, rel=1e-12)
    assert viscosity(68.0, 8.7, 333.15) == pytest.approx(28.66, rel=1e-3)


def test_a_users_card_beside_the_case_goes_first(tmp_path):
    (tmp_path / "cards.toml").write_text(
        '[materials.structural]\nE = "200 GPa"\nnu = 0.29\nyield_strength = "300 MPa"\n'
        'density = "7800 kg/m^3"\nsource = "certificate 4711"\n'
    )
    text = small_machine("cards") + '\n[materials.extra]\ncard = "structural"\n'
    card = parse_case(text, tmp_path).materials["extra"]
    assert (card.E, str(card.source)) == (200e9, "card structural: certificate 4711")


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("[materials.x]\nE = 1\n", "materials.x.source = missing"),
        ("[pets.x]\nsource = 'y'\n", "must be one of: materials"),
        ("[materials\n", "closing bracket"),
    ],
)
def test_a_users_card_that_is_none(tmp_path, written, message):
    (tmp_path / "cards.toml").write_text(written)
    text = small_machine("cards") + '\n[materials.extra]\ncard = "structural"\n'
    with pytest.raises(InputError, match=message.replace(".", r"\.")):
        parse_case(text, tmp_path)


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ('density = "880 kg/m^3"', "cards.oils.own.viscosity_40 = missing, must be given"),
        ("viscosity_40 = 68.0\nviscosity_100 = 8.7", "cards.oils.own.density = missing"),
        (
            'density = "880 kg/m^3"\nviscosity_40 = 0\nviscosity_100 = 8.7',
            "viscosity_40 = 0, must be > 0",
        ),
        (
            'density = "880 kg/m^3"\nviscosity_40 = 68.0\nviscosity_100 = 8.7',
            "pressure_viscosity = missing",
        ),
    ],
)
def test_a_users_oil_that_is_incomplete_is_refused(tmp_path, entries, message):
    (tmp_path / "cards.toml").write_text(f'[oils.own]\n{entries}\nsource = "label"\n')
    text = small_machine("cards") + '\n[lubricant]\ncard = "own"\n'
    with pytest.raises(InputError, match=message.replace(".", r"\.")):
        parse_case(text, tmp_path)


def test_an_unknown_card_is_refused_with_the_known_ones():
    with pytest.raises(InputError, match=r"materials\.extra\.card = kryptonite, must be one of"):
        extra('card = "kryptonite"')


def test_a_recalled_number_makes_the_check_say_so():
    card = extra('card = "case_hardened"')
    cam, roller = made.case().cam, made.case().roller
    cam, roller = made.changed(cam, material=card), made.changed(roller, material=card)
    check = contact_pressure(made.solution(case=made.case(cam=cam, roller=roller)))
    assert "(to be confirmed)" in check.source


def carded() -> str:
    """The template with every card it can have, and a clause of the case's own for each limit."""
    text = small_machine("cards").replace('material = "hardened_steel"', 'material = "hard"')
    text = text.replace('stem_material = "hardened_steel"', 'stem_material = "hard"')
    for side in "ab":
        head, _, tail = text.partition(f"[guides.{side}]")
        body, _, rest = tail.partition("\n[")
        kept = [line for line in body.splitlines() if line.startswith(("length", "diameter"))]
        text = f"{head}[guides.{side}]\n" + "\n".join([*kept, 'card = "pom"']) + f"\n\n[{rest}"
    clauses = "".join(f'{name} = "house rule"\n' for name in LIMITS)
    head, _, tail = text.partition("[limits.sources]\n")
    text = f"{head}[limits.sources]\n{clauses}\n" + tail.partition("\n\n")[2]
    return text + (
        '\n[lubricant]\ncard = "iso_vg_68"\n'
        '\n[materials.hard]\ncard = "case_hardened"\nfatigue_torsion = "400 MPa"\n'
        'fatigue_bending = "600 MPa"\n'
        '\n[spring.design]\ncard = "chrome_silicon"\nwire_diameter = "6 mm"\n'
        'mean_diameter = "40 mm"\ncoils = 8.2\nfree_length = "130 mm"\n'
        '\n[roller.pin]\ndiameter = "8 mm"\nspan = "16 mm"\nmaterial = "hard"\n'
    )


def test_every_check_that_leans_on_a_card_says_verify_whatever_the_case_says():
    """Its own clause stands first; the source of the figures follows."""
    text = carded()
    for section in ("cam", "roller"):
        text = text.replace(f"\n[{section}]\n", f'\n[{section}]\nroughness = "0.3 um"\n')
    checks = {c.id: c for c in preview_case(parse_case(text), corners=False).checks}
    leaning = (
        *("contact_pressure", "contact_pressure_at_life", "edge_pressure", "first_yield"),
        *("shakedown", "shakedown_traction", "surface_fatigue", "dang_van", "hardened_case"),
        *("case_depth", "pressure_by_gear_limits", "film_ratio", "roller_pin"),
        *("guide_pressure_A", "guide_pv_A", "guide_pressure_B", "guide_pv_B"),
        *("guide_edge_pressure_A", "guide_temperature_A"),
        *("spring_stress", "spring_fatigue", "spring_solid"),
    )
    for name in leaning:
        assert "(to be confirmed)" in checks[name].source, name
    assert checks["contact_pressure"].source.startswith("house rule; hard: card case_hardened: ")


@pytest.mark.parametrize(
    ("line", "field"),
    [
        ('treatment = "polished"', "treatment"),
        ("treatment = 1", "treatment"),
    ],
)
def test_a_treatment_that_is_none_is_refused(line, field):
    with pytest.raises(InputError, match=rf"materials\.extra\.{field}"):
        extra('card = "case_hardened"', line)


# Table 10-4 of Shigley, mm.
WIRES = {
    "music_wire": (0.1, 6.5), "hard_drawn": (0.7, 12.7), "oil_tempered": (0.5, 12.7),
    "chrome_vanadium": (0.8, 11.1), "chrome_silicon": (1.6, 9.5),
}  # fmt: skip


def wound(card, diameter, *lines):
    """A case with a spring of a wire, mm, eight times as wide."""
    text = first_case("wound", "lift").text
    wire = "\n".join([f'wire_diameter = "{diameter} mm"', *lines])
    for old, new in (
        ('card = "chrome_silicon"', f'card = "{card}"'),
        ('wire_diameter = "8 mm"', wire),
        ('mean_diameter = "44 mm"', f'mean_diameter = "{8 * diameter} mm"'),
        ('free_length = "86 mm"', f'free_length = "{10 * diameter + 40} mm"'),
    ):
        assert old in text
        text = text.replace(old, new)
    return parse_case(text)


@pytest.mark.parametrize("name", WIRES)
def test_a_wire_beyond_the_diameters_of_its_card_is_refused(name):
    least, most = WIRES[name]
    assert set(WIRES) == set(known_cards(None)["wires"])
    for inside in (least, most):
        assert wound(name, inside).spring.design.wire_diameter == pytest.approx(1e-3 * inside)
    for beyond in (0.99 * least, 1.01 * most):
        with pytest.raises(InputError, match=f"for which card {name} has the strength") as found:
            wound(name, beyond)
        assert found.value.field == "spring.design.wire_diameter"


HOTTEST = {
    "music_wire": 120, "hard_drawn": 120, "oil_tempered": 120, "chrome_vanadium": 210,
    "chrome_silicon": 245,
}  # fmt: skip


@pytest.mark.parametrize("name", HOTTEST)
def test_a_wire_hotter_than_its_card_holds_is_refused(name):
    assert set(HOTTEST) == set(WIRES)
    stated = re.search(r'(?m)^temperature = "60 degC".*$', first_case("wound", "lift").text)
    assert stated is not None

    def at(temperature):
        return (
            first_case("wound", "lift")
            .text.replace(stated[0], f'temperature = "{temperature} degC"')
            .replace('card = "chrome_silicon"', f'card = "{name}"')
            .replace('wire_diameter = "8 mm"', 'wire_diameter = "6 mm"')
            .replace('free_length = "86 mm"', 'free_length = "100 mm"')
        )

    assert parse_case(at(HOTTEST[name])).spring.design.temperature
    words = f"<= {HOTTEST[name]} degC, up to which card {name} has the strength"
    with pytest.raises(InputError, match=words) as found:
        parse_case(at(HOTTEST[name] + 1))
    assert found.value.field == "spring.design.temperature"


def test_a_thick_wire_with_a_strength_of_its_own_is_read():
    own = ('strength_at_1mm = "2100 MPa"', "strength_exponent = 0.145", 'source = "certificate 7"')
    assert wound("music_wire", 12, *own).spring.design.wire_diameter == pytest.approx(0.012)
