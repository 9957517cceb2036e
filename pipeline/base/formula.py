"""Formulas of checks as text: parsed, evaluated, and typeset.

A text has the form ``demand <= limit; symbols with their meaning``. A space is a product; ``max``
and ``min`` before an argument are those over the turn.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from typing import Generic, NamedTuple, TypeVar

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError
from camwright.pipeline.base.units import factor

Resolver = Callable[[str], Value]
"""Name of a symbol -> its value in SI: a number, or an array over the turn."""
CONSTANTS: Mapping[str, float] = {"pi": math.pi}
FUNCTIONS: Mapping[str, Callable[..., Value]] = {
    "sqrt": np.sqrt,
    "sin": np.sin,
    "cos": np.cos,
    "atan": np.arctan,
    "ln": np.log,
    "sign": np.sign,
    "step": lambda value: np.where(np.asarray(value) < 0.0, 0.0, 1.0)[()],
    "changes": lambda values: _changes(np.asarray(values)),
    "mean": np.mean,
    "std": np.std,
    "max": lambda *values: np.max(values),
    "min": lambda *values: np.min(values),
}
OVER_THE_TURN = ("mean", "std", "changes")
"""Functions of the values at all angles of a load case; any other is made at one place.

``changes``: of sign, ``step``: 0 below zero, else 1.
"""
_UNITS = ("deg", "MPa")
"""Units that follow a number of a formula text."""
_SUM, _PRODUCT, _POWER, _ATOM = range(4)  # how strongly a node binds
_TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+(?:\.\d+)?(?:e-?\d+)?)"
    r"|(?P<name>[A-Za-z](?:\w|\.(?=[A-Za-z*])|(?<=\.)\*|,(?=max))*'*)|(?P<sign>[-+*/^(),|]))"
)
_HEAD = re.compile(
    r"(?P<demand>.+?)\s*(?:<=|>=|=)\s*(?P<limit>[^=<>]+?)"
    r"(?: over | on the | at (?=[a-z])|, |; |\.?$)"
)
_WORST = re.compile(r"^(?:max|min) over the load cases of ")
_PLACES = re.compile(
    r"(?P<name>\b[A-Za-z][\w']*): (?P<key>[a-z]\w*(?:\.[a-z]\w*)+)"
    r"(?=$|;|\.(?: |$)|,(?! else| on | or))"
)
_DEFINED = re.compile(
    r"(?:(?<=^)|(?<=[;,:] )|(?<=with )|(?<=and ))(?P<name>[A-Za-z]\w*'*) = (?P<text>.+?)"
    r"(?=: |;|, (?:with )?[A-Za-z][\w']*(?:, [A-Za-z][\w']*)*(?: =|:)|\. |\.?$)"
)


def _over(one: Value, other: Value) -> Value:
    """Quotient, without a warning where it has no bound."""
    with np.errstate(divide="ignore", invalid="ignore"):
        quotient: Value = np.divide(one, other)
    return quotient


def _changes(values: Array) -> int:
    """Changes of the sign of values over a whole turn; a zero has none of its own."""
    signs = np.sign(values[values != 0.0])
    return int(np.sum(signs != np.roll(signs, 1)))


class Node(NamedTuple):
    """Node of an expression tree: number, name, sign or function, with its arguments."""

    kind: str
    text: str
    parts: tuple[Node, ...] = ()
    value: float = math.nan


class Statement(NamedTuple):
    """Demand against limit as a formula text states them, with definitions of its symbols.

    Parameters
    ----------
    demand, limit : str
    defined : mapping      text by name, such as ``y``: ``0.154 - 0.912/z``
    keys : mapping         dotted key by name, such as ``S``: ``limits.gear_bending_safety``
    """

    demand: str
    limit: str
    defined: Mapping[str, str]
    keys: Mapping[str, str]


def stated(text: str) -> Statement:
    """Demand, limit and definitions read from a formula text.

    Raises
    ------
    InputError
        If the text compares no two expressions.
    """
    before, _, after = text.partition(";")
    match = _HEAD.match(_WORST.sub("", before.strip()))
    if match is None:
        raise InputError("formula", text, "demand <= limit; symbols")
    demand = match["demand"]
    defined = {each["name"]: each["text"] for each in _DEFINED.finditer(after.strip())}
    named = re.fullmatch(r"([A-Za-z]\w*) = (.+)", demand)
    if named is not None:
        demand = named[2]
    keys = {each["name"]: each["key"] for each in _PLACES.finditer(after)}
    return Statement(demand, match["limit"], defined, keys)


def parsed(text: str, known: Collection[str] = ()) -> Node:
    """Expression tree of a text; `known`: symbols with parentheses, such as ``R(T)``.

    Raises
    ------
    InputError
        If the text is no expression.
    """
    return _Reader(text, known).whole()


def names(node: Node) -> Iterator[str]:
    """Names in an expression tree, in their order, each once."""
    yield from dict.fromkeys(_names(node))


def _names(node: Node) -> Iterator[str]:
    """Names in an expression tree in their order, repeated as often as they occur."""
    if node.kind == "name":
        yield node.text
    for part in node.parts:
        yield from _names(part)


def value(node: Node, at_place: Resolver, over_turn: Resolver | None = None) -> Value:
    """Value of an expression tree, SI.

    Parameters
    ----------
    node : Node            root of the tree
    at_place : callable    symbol -> value at the place of the demand
    over_turn : callable   symbol -> values over the turn, for functions over the turn such as a
                           mean; None: as at the place
    """
    if node.kind == "number":
        return node.value
    if node.kind == "name":
        return CONSTANTS[node.text] if node.text in CONSTANTS else at_place(node.text)
    whole = node.text in OVER_THE_TURN and over_turn is not None
    resolve = over_turn if whole and over_turn is not None else at_place
    parts = [value(part, resolve, over_turn) for part in node.parts]
    if node.kind == "call":
        return FUNCTIONS[node.text](*parts)
    return _SIGNS[node.kind](*parts)


_SIGNS: Mapping[str, Callable[..., Value]] = {
    "abs": np.abs,
    "minus": lambda one: -one,
    "+": lambda one, other: one + other,
    "-": lambda one, other: one - other,
    "*": lambda one, other: one * other,
    "/": _over,
    "^": lambda one, other: one**other,
}


@dataclass
class _Reader:
    """Recursive descent over the tokens of an expression."""

    text: str
    known: Collection[str]

    def __post_init__(self) -> None:
        self.tokens = list(self._split())
        self.place = 0
        self.bars = 0  # open |

    def _split(self) -> Iterator[tuple[str, str]]:
        """Tokens of the text: kind ("number", "name", "sign" or "end") and text."""
        at = 0
        while at < len(self.text.rstrip()):
            rest = self.text[at:].lstrip()
            word = next(
                (each for each in self.known if "(" in each and rest.startswith(each)), None
            )
            match = _TOKEN.match(self.text, at)
            if word is not None:
                at = self.text.index(word, at) + len(word)
                yield "name", word
            elif match is None or match.end() == at:
                raise InputError(
                    "formula", self.text, f"an expression: {self.text[at : at + 20]!r}"
                )
            else:
                at = match.end()
                yield str(match.lastgroup), match[str(match.lastgroup)]

    def _next(self) -> tuple[str, str]:
        return self.tokens[self.place] if self.place < len(self.tokens) else ("end", "")

    def _take(self, sign: str) -> bool:
        taken = self._next() == ("sign", sign)
        self.place += taken
        return taken

    def _require(self, sign: str) -> None:
        if not self._take(sign):
            raise InputError(
                "formula", self.text, f"an expression with {sign!r} after {self.place}"
            )

    def whole(self) -> Node:
        """Tree of the whole text; InputError if anything follows the expression."""
        node = self._sum()
        if self._next()[0] != "end":
            raise InputError("formula", self.text, "one expression")
        return node

    def _sum(self) -> Node:
        """Tree of a sum from here on: products joined by + and -."""
        node = self._product()
        while True:
            sign = self._next()[1]
            if self._next()[0] != "sign" or sign not in ("+", "-"):
                return node
            self.place += 1
            node = Node(sign, sign, (node, self._product()))

    def _product(self) -> Node:
        """Tree of a product from here on: factors joined by *, / or a blank."""
        node = self._signed()
        while True:
            if self._take("/"):
                node = Node("/", "/", (node, self._signed()))
            elif self._take("*") or self._begins():
                node = Node("*", "", (node, self._signed()))
            else:
                return node

    def _begins(self) -> bool:
        """Whether a factor begins here: a product without a sign."""
        kind, text = self._next()
        return kind in ("number", "name") or text == "(" or (text == "|" and not self.bars)

    def _signed(self) -> Node:
        """Tree of a factor from here on, with its sign and power."""
        if self._take("-"):
            return Node("minus", "-", (self._signed(),))
        base = self._atom()
        return Node("^", "^", (base, self._signed())) if self._take("^") else base

    def _atom(self) -> Node:
        """Tree of a number, name, function, or expression in parentheses or bars from here on."""
        kind, text = self._next()
        self.place += 1
        if kind == "number":
            return self._number(text)
        if kind == "name" and text in FUNCTIONS and text not in self.known:
            return self._call(text)
        if kind == "name":
            return Node("name", text)
        if text == "(":
            node = self._sum()
            self._require(")")
            return node
        if text == "|":
            self.bars += 1
            node = self._sum()
            self.bars -= 1
            self._require("|")
            return Node("abs", "|", (node,))
        raise InputError("formula", self.text, f"an expression, not {text!r}")

    def _number(self, text: str) -> Node:
        """Node of a number, converted to SI where a unit follows it.

        Parameters
        ----------
        text : str   digits of the number, already read
        """
        unit = self._next()[1]
        if self._next()[0] == "name" and unit in _UNITS:
            self.place += 1
            return Node("number", f"{text} {unit}", (), float(text) * factor(unit))
        return Node("number", text, (), float(text))

    def _call(self, text: str) -> Node:
        """Node of a function with its arguments, in parentheses or, without these, the product that
        follows.

        Parameters
        ----------
        text : str   name of the function, already read
        """
        if not self._take("("):  # of the product that follows
            return Node("call", text, (self._product(),))
        parts = [self._sum()]
        while self._take(","):
            parts.append(self._sum())
        self._require(")")
        return Node("call", text, tuple(parts))


@dataclass(frozen=True)
class Printed:
    """Typeset element of a formula: symbol with subscript, number, sign, or a nested form.

    form: name, number, sign, fraction, power, root, bars, group or call; parts: rows of them
    """

    form: str
    text: str = ""
    below: str = ""
    parts: tuple[tuple[Printed, ...], ...] = ()


Text = TypeVar("Text", str, tuple[Printed, ...])


@dataclass(frozen=True)
class Style(Generic[Text]):
    """Typesetting of a formula: one function for each kind of node.

    divides : bool   a fraction needs no parentheses about its parts
    """

    name: Callable[[str], Text]
    number: Callable[[str], Text]
    sign: Callable[[str], Text]
    fraction: Callable[[Text, Text], Text]
    power: Callable[[Text, Text], Text]
    root: Callable[[Text], Text]
    bars: Callable[[Text], Text]
    group: Callable[[Text], Text]
    call: Callable[[str, Text], Text]
    divides: bool


def written(node: Node, style: Style[Text], known: Mapping[str, str] | None = None) -> Text:
    """Expression tree as text in a style, with as few parentheses as it needs.

    Parameters
    ----------
    node : Node       root of the tree
    style : Style     how numbers, names and operations are written
    known : mapping   text in place of a name, such as its value with unit; None: names as they are
    """

    def bracketed(each: Node, least: int) -> Text:
        """Text of a part, in parentheses where it binds less than `least`; see `_binds`."""
        text = written(each, style, known)
        value = "" if known is None or each.kind != "name" else known.get(each.text, "")
        binds = _SUM if value.startswith("-") else _binds(each, style.divides)
        if " " in value and least == _ATOM:  # a number with its unit
            binds = _PRODUCT
        return style.group(text) if binds < least else text

    if node.kind == "number":
        return style.number(node.text)
    if node.kind == "name":
        shown = None if known is None else known.get(node.text)
        return style.name(node.text) if shown is None else style.number(shown)
    one = node.parts[0]
    if node.kind == "abs":
        return style.bars(bracketed(one, _SUM))
    if node.kind == "minus":
        return style.sign("minus") + bracketed(one, _PRODUCT)
    if node.kind == "call":
        inner = bracketed(one, _SUM)
        for part in node.parts[1:]:
            inner = inner + style.sign(",") + bracketed(part, _SUM)
        return style.root(inner) if node.text == "sqrt" else style.call(node.text, inner)
    other = node.parts[1]
    if node.kind == "/":
        least = (_SUM, _SUM) if style.divides else (_PRODUCT, _POWER)
        return style.fraction(bracketed(one, least[0]), bracketed(other, least[1]))
    if node.kind == "^":
        return style.power(
            bracketed(one, _ATOM), bracketed(other, _SUM if style.divides else _ATOM)
        )
    if node.kind == "*":
        return bracketed(one, _PRODUCT) + style.sign("*") + bracketed(other, _POWER)
    return bracketed(one, _SUM) + style.sign(node.kind) + bracketed(other, _PRODUCT)


def _binds(node: Node, divides: bool) -> int:
    """How strongly a node binds, as a rank from `_SUM` to `_ATOM`: the greater, the fewer
    parentheses it needs.

    Parameters
    ----------
    node : Node      of an expression tree
    divides : bool   whether quotients are written as fractions, see `Style`
    """
    if node.kind in ("+", "-", "minus"):
        return _SUM
    if node.kind == "*" or (node.kind == "/" and not divides):
        return _PRODUCT
    return _POWER if node.kind in ("^", "/") else _ATOM


_GREEK = {
    "alpha": "α", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "phi": "φ", "pi": "π",
    "rho": "ρ", "sigma": "σ", "tau": "τ", "theta": "θ", "zeta": "ζ",
}  # fmt: skip
_SIGN = {"*": "·", "-": "\N{MINUS SIGN}", "minus": "\N{MINUS SIGN}"}


def _letter(name: str) -> tuple[Printed, ...]:
    """Name of a formula as it is printed: ``rho_p'`` is ρ′ with p as index; a key or ``R(T)`` as it
    is.
    """
    if "." in name or "(" in name:
        return (Printed("name", name),)
    letter, _, below = name.rstrip("'").partition("_")
    primes = "′" * (len(name) - len(name.rstrip("'")))
    return (Printed("name", _GREEK.get(letter, letter) + primes, below),)


TEXT: Style[str] = Style(
    name=str,
    number=str,
    sign=lambda sign: {"*": " · ", ",": ", ", "minus": "-"}.get(sign, f" {sign} "),
    fraction=lambda one, other: f"{one} / {other}",
    power=lambda one, other: f"{one}^{other}",
    root=lambda inner: f"sqrt({inner})",
    bars=lambda inner: f"|{inner}|",
    group=lambda inner: f"({inner})",
    call=lambda name, inner: f"{name}({inner})",
    divides=False,
)
"""Plain text of one line."""
PRINT: Style[tuple[Printed, ...]] = Style(
    name=_letter,
    number=lambda text: (Printed("number", text.replace("-", _SIGN["-"])),),
    sign=lambda sign: (Printed("sign", _SIGN.get(sign, sign)),),
    fraction=lambda one, other: (Printed("fraction", parts=(one, other)),),
    power=lambda one, other: (Printed("power", parts=(one, other)),),
    root=lambda inner: (Printed("root", parts=(inner,)),),
    bars=lambda inner: (Printed("bars", parts=(inner,)),),
    group=lambda inner: (Printed("group", parts=(inner,)),),
    call=lambda name, inner: (Printed("call", name, parts=(inner,)),),
    divides=True,
)
"""Parts that a page sets as MathML and a PDF as mathematics."""
