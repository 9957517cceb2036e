"""Cards: shipped and the user's own, filled in, with their sources, refused when unknown."""

import made_trial as made
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.case.cards.card_filling import known_cards, viscosity
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.parts_section import Material, Oil
from camwright.pipeline.case.requirements_section import Limits
from camwright.pipeline.case.template import template
from camwright.pipeline.checks.contact_strength import contact_pressure
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.preview import closed_form_checks


def with_card(table, *lines):
    return parse_case(template("cards") + f"\n[{table}]\n" + "\n".join(lines) + "\n")


def test_every_shipped_material_is_a_card_of_a_case():
    for name in known_cards(None)["materials"]:
        card = with_card("materials.extra", f'card = "{name}"').material("extra")
        assert isinstance(card, Material)
        assert card.source.startswith(f"card {name}: ")


def test_what_the_issue_asks_for_is_shipped():
    cards = known_cards(None)
    hardened = {"case_hardened", "induction_hardened", "through_hardened"}
    assert hardened | {"structural", "nodular_iron"} <= set(cards["materials"])
    assert {"pa6", "pa66", "pom", "ptfe_lined", "bronze"} <= set(cards["bushes"])
    assert {"iso_vg_32", "iso_vg_68", "iso_vg_220"} <= set(cards["oils"])


def test_endurance_lines_give_the_endurance_pressure_at_1e8():
    """A and B against the pressures beside them: 2 % as K is rounded, 5 % for the softer iron."""
    from camwright.pipeline.checks.contact_strength import pressure_at_life
    from camwright.pipeline.contact.hertz import contact_modulus

    for name, card in known_cards(None)["materials"].items():
        if "endurance_slope" in card:
            modulus = contact_modulus(float(card["E"].split()[0]) * 1e9, card["nu"], 210e9, 0.3)
            found = pressure_at_life(
                1e8, card["endurance_slope"], card["endurance_intercept"], modulus
            )
            printed = 1e6 * float(card["endurance_pressure"].split()[0])
            width = 0.05 if name == "nodular_iron" else 0.02
            assert found == pytest.approx(printed, rel=width), name


def test_what_the_case_gives_stands():
    card = with_card("materials.extra", 'card = "structural"', 'yield_strength = "400 MPa"')
    assert card.material("extra").yield_strength == 400e6
    assert card.material("extra").E == 210e9


def test_a_resolved_case_holds_the_numbers_and_no_card():
    case = with_card("lubricant", 'card = "iso_vg_68"', 'temperature = "333.15 K"')
    text = case.to_toml()
    assert "card =" not in text
    assert parse_case(text) == case
    assert isinstance(case.lubricant, Oil)


def test_a_bush_brings_its_material():
    text = template("cards")
    head, _, tail = text.partition("[guides.a]")
    body, _, rest = tail.partition("\n[")
    kept = [line for line in body.splitlines() if line.startswith(("length", "diameter"))]
    given = f"{head}[guides.a]\n" + "\n".join([*kept, 'card = "ptfe_lined"']) + f"\n\n[{rest}"
    case = parse_case(given)
    assert case.guides.a.material == "ptfe_lined"
    assert case.guides.a.pv_limit == pytest.approx(1.8e6)
    assert "verify" in case.guides.a.source
    assert case.material("ptfe_lined").source.startswith("card ptfe_lined: ")


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
    text = template("cards") + '\n[materials.extra]\ncard = "structural"\n'
    card = parse_case(text, tmp_path).material("extra")
    assert (card.E, card.source) == (200e9, "card structural: certificate 4711")


@pytest.mark.parametrize(
    ("written", "message"),
    [
        ("[materials.x]\nE = 1\n", "materials.x.source = missing"),
        ("[pets.x]\nsource = 'y'\n", "must be one of: materials"),
        ("[materials\n", "a readable TOML file"),
    ],
)
def test_a_users_card_that_is_none(tmp_path, written, message):
    (tmp_path / "cards.toml").write_text(written)
    text = template("cards") + '\n[materials.extra]\ncard = "structural"\n'
    with pytest.raises(InputError, match=message.replace(".", r"\.")):
        parse_case(text, tmp_path)


def test_an_unknown_card_is_refused_with_the_known_ones():
    with pytest.raises(InputError, match=r"materials\.extra\.card = kryptonite, must be one of"):
        with_card("materials.extra", 'card = "kryptonite"')


def test_a_recalled_number_makes_the_check_say_so():
    case = with_card("materials.extra", 'card = "case_hardened"')
    hard = case.model_copy(
        update={
            "cam": case.cam.model_copy(update={"material": "extra"}),
            "roller_given": case.roller.model_copy(update={"material": "extra"}),
        }
    )
    found = contact_pressure(TrialEvidence(hard, made.contour(), (made.cycle(),)))
    assert "verify" in found.source


def carded() -> str:
    """The template with every card it can have, and a clause of the case's own for each limit."""
    text = template("cards").replace('material = "hardened_steel"', 'material = "hard"')
    text = text.replace('stem_material = "hardened_steel"', 'stem_material = "hard"')
    for side in "ab":
        head, _, tail = text.partition(f"[guides.{side}]")
        body, _, rest = tail.partition("\n[")
        kept = [line for line in body.splitlines() if line.startswith(("length", "diameter"))]
        text = f"{head}[guides.{side}]\n" + "\n".join([*kept, 'card = "pom"']) + f"\n\n[{rest}"
    own = [name for name in Limits.model_fields if name != "sources"]
    clauses = "".join(f'{name} = "house rule"\n' for name in own)
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
    """Its own clause stands first; where the figures come from is told besides."""
    text = carded()
    for section in ("cam", "roller"):
        text = text.replace(f"\n[{section}]\n", f'\n[{section}]\nroughness = "0.3 um"\n')
    found = {c.id: c for c in closed_form_checks(parse_case(text))}
    leaning = (
        *("contact_pressure", "contact_pressure_at_life", "edge_pressure", "first_yield"),
        *("shakedown", "shakedown_traction", "surface_fatigue", "dang_van", "hardened_case"),
        *("case_depth", "pressure_by_gear_limits", "film_ratio", "roller_pin"),
        *("bush_pressure_A", "bush_pv_A", "bush_pressure_B", "bush_pv_B", "bush_peak_A"),
        *("bush_temperature_A", "spring_stress", "spring_fatigue", "spring_solid"),
    )
    for name in leaning:
        assert "verify" in found[name].source, name
    assert found["contact_pressure"].source.startswith("house rule; card case_hardened: ")


@pytest.mark.parametrize(
    ("line", "field"),
    [
        ('treatment = "polished"', "treatment"),
        ("treatment = 1", "treatment"),
    ],
)
def test_a_treatment_that_is_none_is_refused(line, field):
    with pytest.raises(InputError, match=rf"materials\.extra\.{field}"):
        with_card("materials.extra", 'card = "case_hardened"', line)
