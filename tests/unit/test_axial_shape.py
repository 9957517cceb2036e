"""Ends and crowns of a case, and the contacts of finite length that its machine has by them."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.tables import read_table
from camwright.pipeline.case.case_file import parse_case, read_case, with_values
from camwright.pipeline.case.machine import machine
from camwright.pipeline.contact import hertz
from camwright.pipeline.contact.axial_shape import AxialCrown, BodyEnd
from camwright.pipeline.contact.finite_length.axial_drop import (
    CircularCrown,
    SummedCrown,
    TabulatedCrown,
)

CASES = Path(__file__).parents[2] / "cases"
DATA = Path(__file__).parents[1] / "data"


def case_with(**values):
    """The GX120 with other values by key; dots of a key as double underscores."""
    stated = {key.replace("__", "."): value for key, value in values.items()}
    return with_values(read_case(CASES / "gx120.toml"), stated)


def machine_with(**values):
    case = case_with(**values)
    return machine(case, case.load_cases[0])


def lengths(pair):
    return [(round(1e3 * body.flat_length, 9), round(1e3 * body.length, 9)) for body in pair.bodies]


def test_one_pair_has_the_flats_and_ends_of_the_case():
    (pair,) = machine_with().finite_pairs
    assert lengths(pair) == [(5.0, 5.0), (4.4, 5.0)]
    assert [body.end.kind for body in pair.bodies] == ["sharp", "chamfer"]
    assert pair.contact_length == pytest.approx(4.4e-3)
    assert pair.curvature == pytest.approx(1 / 42e-3 + 1 / 8e-3)


def test_depth_is_the_wall_up_to_two_lengths():
    pair = machine_with().finite_pairs[0]
    # The wall from the bore of 8.5 mm with 2.3 mm of keyway to the base circle of 42 mm is thicker.
    assert pair.bodies[0].depth == pytest.approx(8.8e-3)
    ring = machine_with().roller.held_depth
    assert pair.bodies[1].depth == pytest.approx(ring) == pytest.approx(min(ring, 8.8e-3))


@pytest.mark.parametrize("part", ["cam", "roller"])
def test_there_is_no_pair_without_an_end(part):
    case = case_with()
    name = {"cam": "cam", "roller": "roller_given"}[part]
    without = case.model_copy(update={name: replace(getattr(case, part), end=None)})
    assert machine(without, without.load_cases[0]).finite_pairs == ()


def test_an_axial_offset_makes_a_pair_at_each_end():
    before, after = machine_with(roller__axial_offset="0.2 mm").finite_pairs
    # Overhang of the cam: 0.3 mm at both ends, less or more by the offset.
    assert lengths(before)[0] == (5.4, 5.4)
    assert lengths(after)[0] == (4.6, 4.6)
    assert {pair.contact_length for pair in (before, after)} == {before.contact_length}


def test_the_contact_of_a_roller_beyond_the_cam_is_the_overlap():
    made = machine_with(roller__axial_offset="1 mm")
    assert made.contact_width == pytest.approx(5e-3 / 2 + 4.4e-3 / 2 - 1e-3)
    before, after = made.finite_pairs
    assert lengths(after)[0][0] == pytest.approx(3.7)
    assert lengths(after)[1][0] == pytest.approx(3.7 + 2 * 0.7)
    assert lengths(before)[0][0] == pytest.approx(3.7 + 2 * 1.3)
    assert lengths(before)[1][0] == pytest.approx(3.7)


def test_a_roller_beside_the_cam_is_refused():
    with pytest.raises(InputError, match="beside the cam") as refused:
        case_with(roller__axial_offset="5 mm")
    assert refused.value.field == "roller.axial_offset"


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ({"roller__end__size": "2.5 mm"}, "roller.end.size"),
        ({"cam__end__size": "1 mm"}, "cam.end.size"),  # of a sharp end
        ({"roller__end__kind": "round"}, "roller.end.kind"),
        ({"roller__crown__kind": "circular"}, "roller.crown.radius"),
        ({"roller__crown__kind": "iso16281", "roller__crown__radius": "1 mm"},
         "roller.crown.radius"),
        ({"cam__crown__kind": "lundberg", "cam__crown__length": "1 mm"}, "cam.crown.line_load"),
        ({"cam__crown__kind": "table"}, "cam.crown.file"),
    ],
)  # fmt: skip
def test_a_contradiction_is_refused_by_its_key(values, field):
    with pytest.raises(InputError) as refused:
        case_with(**values)
    assert refused.value.field == field


@pytest.mark.parametrize("key", ["chamfer", "crown_radius"])
def test_a_replaced_key_says_what_takes_its_place(key):
    text = (
        (DATA / "small_machine.toml")
        .read_text()
        .replace("hub_radius", f'{key} = "0.5 mm"\nhub_radius', 1)
    )
    with pytest.raises(InputError, match=r"written as roller\.(end|crown) = ") as refused:
        parse_case(text)
    assert refused.value.field == f"roller.{key}"


def drop_of(**crown):
    stated = {f"roller__crown__{key}": value for key, value in crown.items()}
    (pair,) = machine_with(**stated).finite_pairs
    return pair.crown.drop(np.array([0.0, 1e-3, -2e-3])), pair


def test_crowns_of_a_case_have_their_formulas():
    drops, _ = drop_of(kind="circular", radius="500 mm")
    np.testing.assert_allclose(drops, [0.0, 1e-6, 4e-6], rtol=1e-5)
    drops, pair = drop_of(kind="lundberg", line_load="200 N/mm")
    shares = np.array([0.0, 2e-3, -4e-3]) / 4.4e-3
    scale = 2e5 / (np.pi * pair.contact_modulus)
    np.testing.assert_allclose(drops, -scale * np.log(1.0 - shares**2), rtol=1e-9)
    drops, pair = drop_of(kind="johns_gohar", line_load="200 N/mm")
    half_width = hertz.line_contact(2e5, 1.0 / pair.curvature, pair.contact_modulus)[0]
    bounded = 1.0 - 0.3033 * 2.0 * half_width / 4.4e-3
    np.testing.assert_allclose(drops, -scale * np.log(1.0 - bounded * shares**2), rtol=1e-9)
    drops, _ = drop_of(kind="iso16281")
    np.testing.assert_allclose(drops, -0.00035 * 16e-3 * np.log(1.0 - shares**2), rtol=1e-9)


def test_a_crown_has_the_length_that_it_states():
    drops, pair = drop_of(kind="lundberg", line_load="200 N/mm", length="10 mm")
    scale = 2e5 / (np.pi * pair.contact_modulus)
    assert drops[2] == pytest.approx(-scale * np.log(1.0 - 0.4**2))


def test_crowns_of_both_bodies_add():
    radii = {"cam__crown__radius": "300 mm", "roller__crown__radius": "500 mm"}
    kinds = {"cam__crown__kind": "circular", "roller__crown__kind": "circular"}
    made = machine_with(**radii, **kinds)
    drop = made.finite_pairs[0].crown.drop(np.array([2e-3]))[0]
    assert drop == pytest.approx(0.5 * 4e-6 * (1 / 0.3 + 1 / 0.5), rel=1e-4)
    assert made.is_crowned


def test_a_crown_beside_the_middle_counts_without_its_slope():
    """An arc about another middle is the same arc, tilted, but for its fourth power."""
    y = np.array([-2e-3, -0.5e-3, 0.0, 2e-3])
    shifted = SummedCrown(((CircularCrown(0.5), 0.3e-3),), -1).drop(y)
    np.testing.assert_allclose(shifted, CircularCrown(0.5).drop(y), rtol=1e-5)


def test_a_crown_comes_from_its_table(tmp_path):
    (tmp_path / "crown.csv").write_text("y_mm,drop_um\n0,0\n1,1\n4,10\n")
    text = (CASES / "gx120.toml").read_text()
    text += '\n[roller.crown]\nkind = "table"\nfile = "crown.csv"\n'
    (tmp_path / "case.toml").write_text(text)
    case = read_case(tmp_path / "case.toml")
    (pair,) = machine(case, case.load_cases[0]).finite_pairs
    np.testing.assert_allclose(pair.crown.drop(np.array([-1e-3, 2e-3])), [1e-6, 4e-6])
    assert case.included["inputs/crown.csv"].startswith(b"y_mm")


@pytest.mark.parametrize(("left", "is_refused"), [(10, False), (0, True)])
def test_a_one_sided_table_is_refused_at_an_axial_offset(tmp_path, left, is_refused):
    (tmp_path / "crown.csv").write_text(f"y_mm,drop_um\n-4,{left}\n0,0\n4,10\n")
    text = (CASES / "gx120.toml").read_text()
    text += '\n[roller.crown]\nkind = "table"\nfile = "crown.csv"\n'
    (tmp_path / "case.toml").write_text(text)
    case = read_case(tmp_path / "case.toml")
    assert len(machine(case, case.load_cases[0]).finite_pairs) == 1
    beside = with_values(case, {"roller.axial_offset": "0.1 mm"})
    made = machine(beside, beside.load_cases[0])
    if is_refused:
        with pytest.raises(InputError, match=r"roller.crown.file = .*both sides at an axial"):
            made.finite_pairs  # noqa: B018
    else:
        assert len(made.finite_pairs) == 2


@pytest.mark.parametrize("length", ["0.019 mm", "10.1 mm"])
def test_a_mean_of_less_than_a_cell_or_more_than_an_end_is_refused(length):
    with pytest.raises(InputError, match=r"limits\.end_mean_length"):
        case_with(limits__end_mean_length=length)


def test_a_table_without_its_columns_is_refused(tmp_path):
    (tmp_path / "crown.csv").write_text("y_mm,drop\n0,0\n1,1\n")
    assert "drop_um" not in read_table(tmp_path / "crown.csv")
    with pytest.raises(ResultError, match="column drop_um is missing"):
        TabulatedCrown.read(tmp_path / "crown.csv")


def test_greatest_tilt_is_that_of_both_clearances():
    made = machine_with(guides__a__clearance="0.04 mm", guides__b__clearance="0.02 mm")
    guides = made.guides
    length = guides.spacing + 0.5 * (guides.a.length + guides.b.length)
    assert guides.tilt_at(guides.spacing) == pytest.approx(0.03e-3 / length)


def test_a_part_refuses_keys_of_another_kind():
    with pytest.raises(InputError, match="line_load"):
        AxialCrown(kind="circular", radius=0.5, line_load=1e5)
    with pytest.raises(InputError, match="0 m at a sharp end"):
        BodyEnd("sharp", 1e-3)
