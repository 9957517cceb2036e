"""Formula texts of checks: read, evaluated and written."""

import math

import numpy as np
import pytest

from camwright.geometry.errors import InputError
from camwright.pipeline.base import formula
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.hand_check.hand_sheet import ONLY

NUMBERS = {"a": 3.0, "b": 2.0, "s'": 4.0, "F_r,max": 5.0, "cam.speed": 7.0, "R(T)": 11.0, "d": -1.0}


def value(text):
    return formula.value(formula.parsed(text, NUMBERS), NUMBERS.__getitem__)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("a b/b a", 9.0),  # from left to right
        ("a/(b a)", 0.5),
        ("a - b - d", 2.0),
        ("-a^2", -9.0),
        ("2 a^2 b", 36.0),
        ("a^-b", 1.0 / 9.0),
        ("|d - a| b", 8.0),
        ("|a| |d|", 3.0),
        ("max |s' - a|", 1.0),
        ("min(a - b, s', F_r,max)", 1.0),
        ("sqrt(s') + sqrt(b b)", 4.0),
        ("sin 30 deg", 0.5),
        ("2 sin(30 deg)^2", 0.5),
        ("cam.speed times b".replace(" times", ""), 14.0),
        ("R(T) / 2", 5.5),
        ("1.5e-3 a", 4.5e-3),
        ("70 MPa", 70e6),
        ("pi/4", 0.25 * math.pi),
        ("(a/b)^3 10^2", 337.5),
        ("ln(a)/ln(b)", math.log(3.0, 2.0)),
        ("step(a - b) b + step(b - a) a + step(0)", 3.0),
    ],
)
def test_products_bind_from_left_to_right(text, expected):
    assert value(text) == pytest.approx(expected, rel=1e-15)


def test_a_mean_is_taken_over_the_turn_and_the_rest_at_the_place():
    turn = {"v": np.array([1.0, -3.0]), "d": np.array([2.0, 2.0])}
    at = {"v": -3.0, "d": 2.0}
    tree = formula.parsed("mean(|v| d)/d")
    assert formula.value(tree, at.__getitem__, turn.__getitem__) == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("values", "count"),
    [([1.0, -1.0], 2), ([1.0, 0.0, 2.0], 0), ([1.0, 0.0, -2.0, -1.0], 2), ([0.0, 0.0], 0)],
)
def test_changes_of_sign_are_counted_over_the_turn(values, count):
    tree = formula.parsed("changes(T)")
    assert formula.value(tree, {}.__getitem__, {"T": np.array(values)}.__getitem__) == count


def test_a_number_with_its_unit_is_raised_as_a_whole():
    shown = formula.written(formula.parsed("pi d^3/a^2"), formula.TEXT, {"d": "8 mm", "a": "3"})
    assert shown == "pi · (8 mm)^3 / 3^2"


def test_a_prime_in_print_is_that_of_the_letter():
    assert formula.PRINT.name("S_e'") == (formula.Printed("name", "S′", "e"),)
    assert formula.PRINT.name("s''") == (formula.Printed("name", "s′′"),)


def test_the_text_says_where_the_symbols_of_the_limit_stand():
    said = formula.stated(
        "a <= c t; c: limits.chord_share, t: cam.profile_tolerance, S: limits.a, else x, r: a.*.b"
    )
    assert said.keys == {"c": "limits.chord_share", "t": "cam.profile_tolerance"}


@pytest.mark.parametrize("text", ["a +", "(a", "|a", "a b)", "", "a = b", "a ? b"])
def test_what_is_no_expression_is_refused(text):
    with pytest.raises(InputError, match="expression"):
        formula.parsed(text)


def test_a_statement_has_demand_limit_and_definitions():
    said = formula.stated(
        "F K/(b y) <= 0.7 s / S; F = |T + drag|/r, y = 0.154 - 0.912/z: Lewis, s: strength"
    )
    assert (said.demand, said.limit) == ("F K/(b y)", "0.7 s / S")
    assert said.defined == {"F": "|T + drag|/r", "y": "0.154 - 0.912/z"}
    named = formula.stated("lambda = h / r >= limits.film_ratio; h: film")
    assert (named.demand, named.limit) == ("h / r", "limits.film_ratio")
    over = formula.stated("max over the load cases of P/Q <= c on the rise; c: limit")
    assert (over.demand, over.limit) == ("P/Q", "c")
    with pytest.raises(InputError, match="demand <= limit"):
        formula.stated("as the other one")


def test_written_formulas_mean_what_was_read():
    for text in ("a b/(b a)", "a - (b - d)", "(a + b)^2/s'", "-a^2", "|a - b|/sqrt(s')", "a/b/b"):
        shown = formula.written(formula.parsed(text, NUMBERS), formula.TEXT)
        assert value(shown.replace("·", "*")) == pytest.approx(value(text))
    tree = formula.parsed("rho_p/(r - s') <= "[:-4])
    assert formula.written(tree, formula.TEXT, {"r": "2 mm"}) == "rho_p / (2 mm - s')"
    (fraction,) = formula.written(tree, formula.PRINT, {"r": "-2 mm"})
    assert fraction == formula.Printed("fraction", parts=(
        (formula.Printed("name", "ρ", "p"),),
        (formula.Printed("number", "−2 mm"), formula.Printed("sign", "−"),
         formula.Printed("name", "s′")),
    ))  # fmt: skip
    product = formula.parsed("-a b - a")
    assert formula.written(product, formula.TEXT, {"a": "-2 mm"}) == "(-(-2 mm)) · b - (-2 mm)"
    (power,) = formula.written(formula.parsed("(a - b)^2"), formula.PRINT)
    base, exponent = power.parts
    assert power.form == "power" and base[0].form == "group" and exponent[0].text == "2"


@pytest.mark.parametrize("name", [each.id for each in DECLARED.values() if each.symbols])
def test_every_symbol_of_a_formula_that_is_evaluated_has_a_place(name):
    """And no symbol is bound that the formula lacks."""
    declared = DECLARED[name]
    said = formula.stated(declared.formula)
    texts = {"": said.demand, **said.defined}
    used, left = set(), {""}
    while left:
        part = left.pop()
        for each in formula.names(formula.parsed(texts[part], declared.symbols)):
            used.add(each)
            bound = declared.symbols.get(each, "[")
            assert not bound.startswith("[") or each in texts or each in formula.CONSTANTS, each
            if bound.startswith("[") and each in texts and each != part:
                left.add(each)
    limit = said.limit + "".join(f" {said.defined[each]}" for each in said.defined)
    used |= {each for each in declared.symbols if each in limit}  # a limit may be words
    assert set(declared.symbols) - {ONLY} <= used
