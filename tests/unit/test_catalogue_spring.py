"""``spring.catalogue`` in a case: what it finds, what it refuses."""

import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError
from camwright.pipeline.base.source import old_words
from camwright.pipeline.case.cards.spring_catalogue import CATALOGUE, SpringDemand, read_catalogue
from camwright.pipeline.case.case_file import parse_case, read_case

WIRE = """
[wires.steel]
shear_modulus = "80 GPa"
density = "7850 kg/m^3"
strength_at_1mm = "2500 MPa"
strength_exponent = 0.1
treatment = "peened"
source = "a test"
"""
OLD_WIRE = WIRE.replace("strength_exponent", "exponent").replace(
    'treatment = "peened"', "peened = true"
)
WIRELESS = "[wires]\nsteel = 1\n"
SPRING = """
[[spring]]
name = "{name}"
wire = "steel"
wire_diameter = "{wire} mm"
mean_diameter = "{mean} mm"
coils = {coils}
free_length = "120 mm"
"""


def case_text(*lines, preload="400 N"):
    asked = "\n".join(["[spring]", *lines])
    return (
        small_machine("spring")
        .replace("[spring]", asked, 1)
        .replace('# travel_max = "40 mm"', "", 1)
        .replace('preload = "400 N"', f'preload = "{preload}"', 1)
    )


def shipped(travel="23 mm", **changes):
    return parse_case(case_text('catalogue = "shipped"', f'travel_max = "{travel}"', **changes))


def test_the_lightest_of_the_shipped_springs_becomes_the_design():
    """By brute force over the catalogue; the resolved case holds it and asks for no file."""
    case = shipped()
    spring = case.spring.design
    demand = SpringDemand(case.spring.rate, case.spring.preload, 0.023)
    will_do = [each for each in read_catalogue() if not demand.shortfalls(each)]
    assert spring.mass == pytest.approx(min(each.mass for each in will_do), rel=1e-12)
    assert len(will_do) > 1
    assert "lightest of" in case.spring.design.source.text
    assert not case.spring.design.source.confirmed
    assert parse_case(case.to_toml()) == case


def test_tolerances_and_preloads_of_states_ask_for_more():
    """The hardest spring that may come, at the greatest preload, decides; both rule springs out."""
    base = shipped().spring.design.mass
    spread = parse_case(
        case_text(
            'catalogue = "shipped"', 'travel_max = "23 mm"', "preload_tolerance = 0.575",
        )
    )  # fmt: skip
    stiffer = parse_case(
        case_text('catalogue = "shipped"', 'travel_max = "23 mm"')
        + '\n[[load_case]]\nname = "hard"\nspeed = "1500 rpm"\npreload = "600 N"\n'
    )
    assert spread.spring.design == stiffer.spring.design
    assert spread.spring.design.mass > base


def test_the_usual_tolerances_count_where_the_case_states_none():
    """The checks judge the hardest spring in tolerance: 5 % where the case states nothing."""
    stated = ("rate_tolerance = 0.05", "preload_tolerance = 0.05")
    lines = ('catalogue = "shipped"', 'travel_max = "25 mm"')
    usual = parse_case(case_text(*lines)).spring
    assert usual.design == parse_case(case_text(*lines, *stated)).spring.design
    assert SpringDemand(usual.rate, usual.preload, 0.025).shortfalls(usual.design) == ()


def test_a_catalogue_beside_the_case(tmp_path):
    rows = [SPRING.format(name=n, wire=w, mean=m, coils=c) for n, w, m, c in (
        ("heavy", 6, 40, 8.4), ("light", 5, 32, 7.9), ("soft", 4, 40, 10)
    )]  # fmt: skip
    (tmp_path / "own.toml").write_text(WIRE + "".join(rows))
    path = tmp_path / "case.toml"
    path.write_text(case_text('catalogue = "own.toml"', 'travel_max = "25 mm"'))
    case = read_case(path)
    assert case.spring.design.wire_diameter == pytest.approx(5e-3)
    assert "light" in case.spring.design.source.text
    assert case.spring.design.source.confirmed and not old_words(case.written.tables)
    (tmp_path / "own.toml").write_text(WIRE.replace("a test", "mill: verify") + "".join(rows))
    case = read_case(path)
    assert not case.spring.design.source.confirmed
    (warning,) = old_words(case.written.tables)
    assert "mill: verify" in warning
    path.write_text(case_text('catalogue = "own.toml"', 'travel_max = "60 mm"'))
    with pytest.raises(InputError, match=r"spring\.catalogue = own\.toml.*light: goes solid"):
        read_case(path)


@pytest.mark.parametrize(
    ("lines", "match"),
    [
        (('catalogue = "shipped"',), r"spring\.travel_max = missing"),
        (('catalogue = "shipped"', 'travel_max = "0 mm"'), r"travel_max = 0 mm, must be > 0"),
        (('catalogue = "shipped"', "travel_max = 25"), "a number with a unit"),
        (("catalogue = 3", 'travel_max = "25 mm"'), r'a file name, or "shipped"'),
        (('catalogue = ""', 'travel_max = "25 mm"'), r"spring\.catalogue"),
        (('catalogue = "../own.toml"', 'travel_max = "25 mm"'), "where a case has no folder"),
        (('catalogue = "shipped"', 'travel_max = "300 mm"'), "nearest are"),
        (
            ('catalogue = "shipped"', 'travel_max = "25 mm"', "design = {coils = 5}"),
            r"spring\.design = a table, must be left out",
        ),
        (('catalogue = "shipped"', 'travel_max = "9 mm"', "rate_tolerance = true"), "rate_tol"),
    ],
)  # fmt: skip
def test_refuses(lines, match):
    with pytest.raises(InputError, match=match):
        parse_case(case_text(*lines))


@pytest.mark.parametrize("name", ["../own.toml", "/etc/hostname", "a\\b.toml", "absent.toml"])
def test_stays_in_the_folder_of_the_case(tmp_path, name):
    path = tmp_path / "case.toml"
    path.write_text(case_text(f"catalogue = '{name}'", 'travel_max = "25 mm"'))
    with pytest.raises(InputError, match="catalogue"):
        read_case(path)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("wires = 3\nspring = []", r"catalogue\.wires = 3, must be tables"),
        ("spring = 3\n[wires]", r"catalogue\.spring = 3, must be tables"),
        ("spring = [1]\n[wires]", r"catalogue\.spring\[0\] = 1, must be a table"),
        ("wires = {a = 1}\nspring = []", r"catalogue\.wires\.a = 1, must be a table"),
        (
            WIRELESS + SPRING.format(name="a", wire=5, mean=32, coils=8),
            r"catalogue\.wires\.steel = 1, must be a table",
        ),
        ("colour = 1", r"catalogue\.colour = unknown key"),
        (WIRE + 2 * SPRING.format(name="a", wire=5, mean=32, coils=8), "unlike every other"),
        (WIRE + SPRING.format(name="a", wire=5, mean=32, coils='"8"'), "a number without a unit"),
        (WIRE + SPRING.format(name="a", wire=5, mean=32, coils="nan"), "must be finite"),
        (WIRE + SPRING.format(name="", wire=5, mean=32, coils=8), "printable text"),
        (WIRE + "spring = " + 5000 * "[" + 5000 * "]", "catalogue"),
    ],
)
def test_refuses_a_hostile_catalogue(tmp_path, text, match):
    path = tmp_path / "own.toml"
    path.write_text(text)
    with pytest.raises(InputError, match=match):
        read_catalogue(path)


def catalogue(folder, wire, **changes):
    """Springs of a catalogue of one spring, of a wire."""
    path = folder / "own.toml"
    one = {"name": "one", "wire": 5, "mean": 32, "coils": 8} | changes
    path.write_text(wire + SPRING.format(**one))
    return read_catalogue(path)


@pytest.mark.parametrize(("peened", "treatment"), [("true", "peened"), ("false", "plain")])
def test_a_catalogue_with_the_keys_of_version_0_1_is_read(tmp_path, peened, treatment):
    old = OLD_WIRE.replace("peened = true", f"peened = {peened}")
    new = WIRE.replace('"peened"', f'"{treatment}"')
    (spring,) = catalogue(tmp_path, old)
    assert (spring.strength_exponent, spring.treatment) == (0.1, treatment)
    assert (spring,) == catalogue(tmp_path, new)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("strength_exponent = 0.1", "strength_exponent = 1.0",
         "catalogue.wires.steel.strength_exponent = 1.0, must be >= 0 and < 1"),
        ("strength_exponent = 0.1", 'strength_exponent = "0.1"',
         "catalogue.wires.steel.strength_exponent = \"0.1\", must be a number without"),
        ("strength_exponent = 0.1", "exponent = nan",
         "catalogue.wires.steel.strength_exponent = nan, must be finite"),
        ('"80 GPa"', '"0 GPa"',
         "catalogue.wires.steel.shear_modulus = 0 GPa, must be > 0 and <= 100000 GPa"),
        ('"80 GPa"', '"80 mm"',
         "catalogue.wires.steel.shear_modulus = 80 mm, must be in a unit of the dimension of GPa"),
        ('"7850 kg/m^3"', "7850",
         "catalogue.wires.steel.density = 7850, must be a number with a unit"),
        ('"2500 MPa"', '"-1 MPa"',
         "catalogue.wires.steel.strength_at_1mm = -1 MPa, must be > 0"),
        ('treatment = "peened"', 'treatment = "shot"',
         "catalogue.wires.steel.treatment = shot, must be 'plain' or 'peened'"),
        ('treatment = "peened"', "peened = 1",
         "catalogue.wires.steel.treatment = 1, must be 'plain' or 'peened'"),
        ('source = "a test"', "source = 3",
         "catalogue.wires.steel.source = 3, must be text in quotes"),
        ('source = "a test"', 'source = "a test"\ncolour = "red"',
         "catalogue.wires.steel.colour = unknown key"),
    ],
)  # fmt: skip
def test_a_bad_value_of_a_wire_is_told_by_the_wire_s_own_name(tmp_path, old, new, message):
    assert WIRE.count(old) == 1
    with pytest.raises(InputError) as refusal:
        catalogue(tmp_path, WIRE.replace(old, new))
    assert message in str(refusal.value)


@pytest.mark.parametrize("second", ["exponent = 0.2", "peened = false"])
def test_a_wire_with_an_old_and_a_new_name_of_a_key_is_refused(tmp_path, second):
    with pytest.raises(InputError, match=r"catalogue\.wires\.steel"):
        catalogue(tmp_path, f"{WIRE}{second}\n")


def test_a_bad_value_of_a_spring_is_told_by_its_place(tmp_path):
    with pytest.raises(InputError) as refusal:
        catalogue(tmp_path, WIRE, coils=1)
    assert refusal.value.field == "catalogue.spring[0].coils"
    with pytest.raises(InputError) as refusal:
        catalogue(tmp_path, WIRE, mean=10)  # two wire diameters
    assert refusal.value.field == "catalogue.spring[0].mean_diameter"
    assert "3 to 20 times wire_diameter = 5 mm" in str(refusal.value)


def test_an_empty_catalogue_has_no_spring(tmp_path):
    (tmp_path / "own.toml").write_text("[wires]")
    path = tmp_path / "case.toml"
    path.write_text(case_text('catalogue = "own.toml"', 'travel_max = "25 mm"'))
    with pytest.raises(InputError, match="must be not empty"):
        read_case(path)


def test_refuses_a_huge_catalogue(tmp_path):
    path = tmp_path / "own.toml"
    path.write_text(CATALOGUE.read_text() + 300 * 1024 * "#")
    with pytest.raises(InputError, match="at most 256 KiB"):
        read_catalogue(path)
