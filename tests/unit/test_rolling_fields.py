"""Optional case fields of the rolling surface: read in their units, written back bit for bit."""

import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case_file import parse_case


def with_fields():
    text = small_machine("rolled")
    for section, lines in (
        ("[cam]", 'roughness = "0.8 um"'),
        ("[roller]", 'roughness = "100 nm"\nfriction = 0.1'),
        ("[roller.bearing]", 'drag_torque = "5 N mm"\nfriction = 0.0015'),
    ):
        head, found, tail = text.partition(f"\n{section}")
        assert found
        comment, _, rest = tail.partition("\n")
        text = f"{head}{found}{comment}\n{lines}\n{rest}"
    return text + '\n[lubricant]\nviscosity = "30 mPa s"\npressure_viscosity = "20 1/GPa"\n'


def test_values_in_si():
    case = parse_case(with_fields())
    assert case.lubricant is not None
    assert case.lubricant.viscosity == pytest.approx(0.03)
    assert case.lubricant.pressure_viscosity == pytest.approx(2e-8)
    assert (case.cam.roughness, case.roller.roughness) == pytest.approx((8e-7, 1e-7))
    assert case.roller.bearing.drag_torque == pytest.approx(0.005)


def test_written_out_they_read_back():
    case = parse_case(with_fields())
    again = parse_case(case.to_toml())
    assert again == case
    assert again.sha256 == case.sha256


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ('"30 mPa s"', '"0 mPa s"', "lubricant.viscosity"),
        ('"20 1/GPa"', '"20 GPa"', "lubricant.pressure_viscosity"),
        ('"0.8 um"', '"-1 um"', "cam.roughness"),
        ('"5 N mm"', '"5 N"', "roller.bearing.drag_torque"),
    ],
)
def test_bad_values_are_named(old, new, field):
    with pytest.raises(InputError) as found:
        parse_case(with_fields().replace(old, new))
    assert found.value.field == field


def mixed():
    text = with_fields().replace("density = ", "hardness_vickers = 600\ndensity = ")
    return text + 'film = "mixed"\n'


def test_the_mixed_film_is_asked_for_in_the_case():
    case = parse_case(mixed())
    assert case.lubricant is not None
    assert case.lubricant.film == "mixed"


@pytest.mark.parametrize(
    ("old", "new", "field"),
    [
        ('"mixed"', '"thick"', "lubricant.film"),
        ('roughness = "0.8 um"', "", "cam.roughness"),
        ('roughness = "100 nm"', "", "roller.roughness"),
        ("hardness_vickers = 600\n", "", "materials"),
    ],
)
def test_the_mixed_film_needs_roughness_and_hardness(old, new, field):
    with pytest.raises(InputError) as found:
        parse_case(mixed().replace(old, new))
    assert found.value.field.startswith(field)
