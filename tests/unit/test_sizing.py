"""Element size as a function of position."""

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.meshes.element_size import EDGES_PER_TURN, ElementSize, SizeField

CONTACT = (0.03, -0.01)


def sizing(**changes):
    values = {
        "far_size": 3e-3,
        "contact_size": 1e-5,
        "contact_extent": 2e-4,
        "contact_point": CONTACT,
    }
    return ElementSize(**(values | changes))


def at_distance(distance):
    return np.array([[CONTACT[0]], [CONTACT[1] - distance]])


@pytest.mark.parametrize(
    ("distance", "expected"),
    [(0.0, 1e-5), (2e-4, 1e-5), (1.2e-3, 1e-5 + 0.15 * 1e-3), (1.0, 3e-3)],
    ids=["contact", "edge of the zone", "growing", "far"],
)
def test_size_is_constant_then_grows_then_stops(distance, expected):
    assert sizing().field()(at_distance(distance))[0] == pytest.approx(expected, rel=1e-12)


def test_size_without_a_contact_is_uniform():
    field = ElementSize(far_size=2e-3).field()
    assert (field(np.array([[0.0, 1.0], [0.0, 5.0]])) == 2e-3).all()


def test_from_half_width_puts_edges_across_it():
    found = ElementSize.from_half_width(1e-4, 3e-3, contact_point=CONTACT, edges=8, reach=2)
    assert found.contact_size == pytest.approx(1.25e-5, rel=1e-15)
    assert found.contact_extent == pytest.approx(2e-4, rel=1e-15)
    assert found.steps == 16


def test_from_half_width_is_never_coarser_than_far():
    assert ElementSize.from_half_width(1.0, 3e-3).contact_size == 3e-3


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("far_size", 0.0),
        ("far_size", np.nan),
        ("contact_size", -1e-6),
        ("contact_size", 4e-3),
        ("contact_extent", -1e-9),
        ("contact_extent", np.nan),
        ("growth", 0.0),
        ("phase", 1.01),
        ("phase", np.nan),
        ("contact_point", (np.nan, 0.0)),
        ("contact_point", (1.0, 2.0, 3.0)),
    ],
)
def test_bad_values_name_their_field(field, value):
    with pytest.raises(InputError, match=rf"sizing\.{field}"):
        sizing(**{field: value})


def test_a_spot_only_makes_the_field_finer():
    coarse = SizeField(3e-3, 0.2)
    fine = coarse.with_spot((0.01, 0.0), 1e-4, 1e-3)
    points = np.random.default_rng(1).uniform(-0.05, 0.05, (2, 200))
    assert (fine(points) <= coarse(points)).all()
    assert fine(np.array([[0.0105], [0.0]]))[0] == 1e-4


def test_below_keeps_the_field_under_local_limits():
    theta = np.linspace(0, 2 * np.pi, 400)
    points = 0.05 * np.array([np.cos(theta), np.sin(theta)])
    limits = 2e-4 + 4e-3 * np.sin(0.5 * theta) ** 2
    field = SizeField(3e-3, 0.15).below(points, limits)
    assert (field(points) <= 1.25 * limits * (1 + 1e-12)).all()
    assert field.far_size == 3e-3


def test_below_caps_the_whole_field_when_everywhere_is_tight():
    theta = np.linspace(0, 2 * np.pi, 4000)
    points = 5.0 * np.array([np.cos(theta), np.sin(theta)])
    field = SizeField(3e-3, 0.15).below(points, np.full(4000, 1e-3))
    assert field.far_size == 1e-3


def test_formula_means_the_same_as_the_field():
    field = sizing().field().with_spot((-0.02, 0.004), 2e-4, 1e-3)
    names = {"Sqrt": np.sqrt, "Fabs": abs}
    x, y = 12.5, -3.25
    values = [eval(text.replace("^", "**"), names, {"x": x, "y": y}) for text in field.formulas()]
    here = np.array([[x], [y]]) * 1e-3
    assert min(*values, field.far_size * 1e3) == pytest.approx(1e3 * field(here)[0], rel=1e-12)


def test_forty_edges_go_round_a_circle():
    assert EDGES_PER_TURN == 40
