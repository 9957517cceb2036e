"""Guides and stem: values, refusals, small properties."""

from dataclasses import replace

import made_trial as made
import numpy as np
import pytest

from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.machine import machines
from camwright.pipeline.follower import guide_contact
from camwright.pipeline.follower import guide_reactions as guides_module
from camwright.pipeline.follower.guide_reactions import (
    WALL_SHARE,
    Guide,
    GuidePair,
    bush_foundation_modulus,
    guide_reactions,
    lobatto,
)
from camwright.pipeline.follower.stem_beam import Stem, stem_compliance

STEM = Stem(0.01, 210e9)
BUSH = Material(E=2.8e9, nu=0.4, yield_strength=60e6, density=1150.0, source="made up")


def guide(length, clearance, foundation_modulus, friction):
    """A bore of 10 mm whose bush has that foundation modulus, N/m2, whatever it is made of."""
    return Guide(
        length=length,
        diameter=0.01,
        clearance=clearance,
        stiffness=foundation_modulus * length,
        friction=friction,
        material=BUSH,
    )


NYLON = guide(0.02, 50e-6, 2e10, 0.04)
STEEL = guide(0.016, 30e-6, 9e11, 0.2)
PAIR = GuidePair(spacing=0.08, a=NYLON, b=STEEL)
FORCE = np.array([-120.0, -1.0, 0.0, 2.0, 300.0, 800.0])
OVERHANG = np.linspace(0.03, 0.06, 6)


def test_side_force_too_small_to_have_digits_is_none():
    """In the middle of a dwell a spline leaves slopes of 1e-315: a residual has no digits there."""
    solved = guide_reactions([1e-315, -3.4e-315, 100.0], 0.04, STEM, PAIR)
    assert (solved.moment_residual[:2] == 0.0).all()
    assert (solved.force_residual[:2] == 0.0).all()


def test_side_force_too_small_to_have_digits_is_solved_in_stiff_bores():
    """Scaled up to dent a stiff bore, a force of 1e-315 N would overflow."""
    stiff = GuidePair(
        spacing=0.08, a=guide(0.02, 3e-5, 9e12, 0.05), b=guide(0.02, 3e-5, 9e12, 0.05)
    )
    solved = guide_reactions([-2.8e-315, 1e-300, 100.0], 0.04, STEM, stiff)
    assert (solved.reaction_a[:2] == 0.0).all() and solved.reaction_a[2] > 100.0


def test_reactions_are_signed_like_the_statics():
    solved = guide_reactions(FORCE, OVERHANG, STEM, PAIR)
    np.testing.assert_allclose(solved.statics_a, FORCE * (OVERHANG + 0.08) / 0.08)
    np.testing.assert_allclose(solved.statics_b, FORCE * OVERHANG / 0.08)
    loaded = FORCE != 0.0
    for name in "ab":
        ratio = (
            getattr(solved, f"reaction_{name}")[loaded] / getattr(solved, f"statics_{name}")[loaded]
        )
        assert ((ratio > 0.3) & (ratio < 1.3)).all()


def test_equilibrium_from_the_pressures_themselves():
    """Integrated anew over the knots, force and moment about the roller close to 1e-9."""
    solved = guide_reactions(FORCE, OVERHANG, STEM, PAIR)
    _, weight = lobatto(guides_module.KNOTS)
    push_a = solved.line_pressure_a * (0.01 * weight)[:, None]
    push_b = solved.line_pressure_b * (0.008 * weight)[:, None]
    total = push_a.sum(axis=0) + push_b.sum(axis=0)
    np.testing.assert_allclose(total, FORCE, rtol=1e-9, atol=1e-12)
    turning = (push_a * (solved.knots_a[:, None] + OVERHANG)).sum(axis=0)
    turning += (push_b * (solved.knots_b[:, None] + 0.08 + OVERHANG)).sum(axis=0)
    np.testing.assert_allclose(turning, 0.0, atol=1e-9 * 800.0 * 0.14)
    for name in ("force_residual", "moment_residual", "complementarity_residual"):
        assert getattr(solved, name).max() <= 1e-9


def test_no_load_gives_zeros():
    solved = guide_reactions(np.zeros(3), 0.04, STEM, PAIR)
    for name in ("reaction_a", "reaction_b", "line_pressure_max_a", "slope_a", "roller_deflection"):
        np.testing.assert_array_equal(getattr(solved, name), 0.0)
    np.testing.assert_array_equal(solved.moment_residual, 0.0)


def test_the_greatest_line_pressure_is_above_its_mean():
    solved = guide_reactions(FORCE, OVERHANG, STEM, PAIR)
    peak = np.abs(solved.line_pressure_b).max(axis=0)
    np.testing.assert_allclose(solved.line_pressure_max_b, peak)
    assert (solved.line_pressure_max_a >= np.abs(solved.reaction_a) / 0.02 - 1e-11).all()


def test_a_bore_pushes_from_one_side_only_at_a_knot_and_not_within_its_play():
    solved = guide_reactions(FORCE, OVERHANG, STEM, PAIR)
    assert (solved.rubbing_load_a >= np.abs(solved.reaction_a) - 1e-9).all()
    assert (solved.line_pressure_b[:, -1] == 0.0).any()


def test_reversing_the_load_mirrors_the_answer():
    one, two = (guide_reactions(sign * FORCE, OVERHANG, STEM, PAIR) for sign in (1, -1))
    np.testing.assert_allclose(two.reaction_a, -one.reaction_a, rtol=1e-9)
    np.testing.assert_allclose(two.roller_deflection, -one.roller_deflection, rtol=1e-9)
    np.testing.assert_allclose(two.line_pressure_max_b, one.line_pressure_max_b, rtol=1e-7)


@pytest.mark.parametrize("size", [1e-15, 1e-6, 1e4])
def test_load_and_play_scaled_together_scale_everything(size):
    def at(factor):
        """Reactions at a tenth of load and play times a factor: a clearance is 100 mm at most."""
        share = 0.1 * factor
        a, b = (replace(each, clearance=share * each.clearance) for each in (NYLON, STEEL))
        guides = GuidePair(spacing=0.08, a=a, b=b)
        return guide_reactions(share * FORCE, OVERHANG, STEM, guides)

    one, many = at(1.0), at(size)
    np.testing.assert_allclose(many.reaction_b, size * one.reaction_b, rtol=1e-8)
    np.testing.assert_allclose(many.slope_b, size * one.slope_b, rtol=1e-8, atol=1e-16 * size)


@pytest.mark.parametrize("force", [1e-30, 1e-12, 1e-3])
def test_a_load_that_hardly_dents_the_bore_is_still_in_equilibrium(force):
    solved = guide_reactions([force], 0.04, STEM, PAIR)
    assert solved.reaction_a - solved.reaction_b == pytest.approx(force, rel=1e-9)
    # the stem leans on the outer mouth of A and the far end of B
    assert solved.reaction_b == pytest.approx(force * (0.04 - 0.01) / (0.08 + 0.018), rel=2e-2)


@pytest.mark.parametrize("force", [1e-30, 1e-12, 1e-6, 1.0])
def test_a_guide_without_clearance_holds_a_light_load_alone(force):
    """A tight guide leaves the stem no slack; the other, with clearance, is out of reach."""
    tight, loose = replace(NYLON, clearance=0.0), replace(STEEL, clearance=1e-3)
    solved = guide_reactions([force], 0.04, STEM, replace(PAIR, a=tight, b=loose))
    assert solved.reaction_b[0] == 0.0
    assert solved.reaction_a[0] == pytest.approx(force, rel=1e-9, abs=0.0)
    assert solved.moment_a[0] == pytest.approx(-force * 0.04, rel=1e-9, abs=0.0)


@pytest.mark.parametrize("loose", [1e-9, 30e-6])
def test_less_and_less_clearance_ends_at_none(loose):
    """Reactions of a guide without clearance are the limit of those with less and less."""
    force, arm = np.array([-1e-12, 1e-9, 3.0, 300.0]), 0.04

    def solved(clearance):
        a, b = replace(NYLON, clearance=clearance), replace(STEEL, clearance=loose)
        return guide_reactions(force, arm, STEM, replace(PAIR, a=a, b=b))

    none, little = solved(0.0), solved(1e-15)
    np.testing.assert_allclose(none.reaction_a, little.reaction_a, rtol=1e-6)
    np.testing.assert_allclose(none.reaction_b[2:], little.reaction_b[2:], rtol=1e-6)


def test_answers_do_not_depend_on_the_company():
    together = guide_reactions(FORCE, OVERHANG, STEM, PAIR)
    alone = [
        guide_reactions([f], a, STEM, PAIR).reaction_a[0]
        for f, a in zip(FORCE, OVERHANG, strict=True)
    ]
    np.testing.assert_allclose(together.reaction_a, alone, rtol=1e-9)


def test_lobatto_rule_is_exact_to_degree_2n_minus_3():
    for count in (3, 7, 25):
        knots, weights = lobatto(count)
        assert (knots[0], knots[-1]) == (-1.0, 1.0)
        for degree in (0, 2, 2 * count - 4):
            assert weights @ knots**degree == pytest.approx(2 / (degree + 1), rel=1e-12)
    knots, weights = lobatto(5)
    assert weights @ knots**8 != pytest.approx(2 / 9, rel=1e-3)


def test_bush_foundation_is_the_sum_of_the_radial_pressures():
    modulus, nu, bore, wall = 2.8e9, 0.4, 0.01, 0.002
    angle = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 20001)
    confined = modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    pressure = confined * np.cos(angle) / wall
    summed = np.trapezoid(pressure * np.cos(angle) * 0.5 * bore, angle)
    assert bush_foundation_modulus(bore, wall, modulus, nu) == pytest.approx(summed, rel=1e-8)


@pytest.mark.parametrize(
    ("values", "field"),
    [
        ((0.0, 0.002, 1e9, 0.3), "diameter"),
        ((0.01, np.nan, 1e9, 0.3), "wall"),
        ((0.01, 0.002, -1.0, 0.3), "elastic_modulus"),
        ((0.01, 0.002, 1e9, 0.5), "poisson_ratio"),
    ],
)
def test_bad_bush_is_refused(values, field):
    with pytest.raises(InputError, match=field):
        bush_foundation_modulus(*values)


@pytest.mark.parametrize(
    ("field", "value", "says"),
    [
        ("length", 0.0, "length"),
        ("diameter", np.inf, "diameter"),
        ("clearance", -1e-6, "press fit"),
        ("clearance", np.nan, "clearance"),
        ("stiffness", 0.0, "stiffness"),
        ("friction", -0.1, "friction"),
    ],
)
def test_bad_guide_is_refused(field, value, says):
    with pytest.raises(InputError, match=says):
        replace(NYLON, **{field: value})


@pytest.mark.parametrize(
    ("field", "value"),
    [("diameter", 0.0), ("elastic_modulus", np.nan), ("poisson_ratio", 0.6), ("bore", 0.01)],
)
def test_bad_stem_is_refused(field, value):
    with pytest.raises(InputError, match=field):
        replace(STEM, **{field: value})


@pytest.mark.parametrize(("share", "fits"), [(1.01, True), (0.99, False)])
def test_guides_may_not_overlap(share, fits):
    spacing = share * 0.018
    if fits:
        assert GuidePair(spacing=spacing, a=NYLON, b=STEEL).spacing == spacing
    else:
        with pytest.raises(InputError, match=r"guides\.spacing"):
            GuidePair(spacing=spacing, a=NYLON, b=STEEL)


@pytest.mark.parametrize(("share", "fits"), [(1.01, True), (0.99, False)])
def test_the_roller_stays_outside_guide_a(share, fits):
    if fits:
        assert guide_reactions([1.0], share * 0.01, STEM, PAIR).reaction_a > 0.0
    else:
        with pytest.raises(InputError, match="overhang"):
            guide_reactions([1.0], share * 0.01, STEM, PAIR)


def test_a_stem_that_would_leave_guide_b_is_refused():
    """At the largest overhang, 60 mm, B ends 60 + 80 + 8 mm from the roller."""
    guide_reactions(FORCE, OVERHANG, replace(STEM, length=0.148), PAIR)
    with pytest.raises(InputError, match="stem_length"):
        guide_reactions(FORCE, OVERHANG, replace(STEM, length=0.147), PAIR)
    with pytest.raises(InputError, match="length"):
        replace(STEM, length=np.nan)


def test_a_stem_thicker_than_the_bore_is_refused():
    with pytest.raises(InputError, match="stem_diameter"):
        guide_reactions([1.0], 0.04, replace(STEM, diameter=0.011), PAIR)


@pytest.mark.parametrize("knots", [1, 2, 24])
def test_knots_must_be_odd(knots):
    with pytest.raises(InputError, match="knots"):
        guide_reactions([1.0], 0.04, STEM, PAIR, knots=knots)


def test_nan_load_is_refused():
    with pytest.raises(InputError, match="tangential_force"):
        guide_reactions([np.nan], 0.04, STEM, PAIR)


def test_nodes_must_rise():
    with pytest.raises(InputError, match="nodes"):
        stem_compliance(np.array([0.0, 0.01, 0.01]), STEM)


def test_an_unsettled_position_raises(monkeypatch):
    monkeypatch.setattr(guide_contact, "MAX_STEPS", 1)
    with pytest.raises(ContactError, match="no equilibrium of the stem at"):
        guide_reactions(FORCE, OVERHANG, STEM, PAIR)


@pytest.mark.parametrize("size", [1.0, 1e-22])
@pytest.mark.parametrize(("spoilt", "name"), [(0, "force_residual"), (1, "complementarity")])
def test_a_residual_that_is_not_met_raises(monkeypatch, spoilt, name, size):
    def careless(line, force, moment, start=None):
        push, rigid = guide_contact.settle(line, force, moment, start)
        return (push * (1 + 1e-7), rigid) if spoilt == 0 else (push, rigid * (1 + 1e-6))

    monkeypatch.setattr(guides_module, "settle", careless)
    with pytest.raises(ContactError, match=name):
        guide_reactions(size * FORCE, OVERHANG, STEM, PAIR)


def test_guides_of_a_case_take_the_bush_unless_a_stiffness_is_given():
    stiff = made.changed(made.case().guides.b, stiffness=6e8)
    guides = made.changed(made.case().guides, b=stiff)
    machine = machines(made.case(guides=guides))[0]
    a, b = machine.guides.a, machine.guides.b
    assert a.foundation_modulus == bush_foundation_modulus(0.01, WALL_SHARE * 0.01, 2.8e9, 0.4)
    assert b.foundation_modulus == pytest.approx(3e10, rel=1e-15)
    assert machine.guides.spacing == 0.08
    assert machine.stem.elastic_modulus == 210e9
