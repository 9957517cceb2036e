"""Formula texts of checks: read, evaluated on numbers, and written as text, MathML or Typst.

A text has the form ``demand <= limit; symbols with their meaning``. A space is a product; ``max``
and ``min`` before an argument are those over the turn.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass
from html import escape
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Value
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
    "sign": np.sign,
    "ln": np.log,
    "mean": np.mean,
    "std": np.std,
    "max": lambda *values: np.max(values),
    "min": lambda *values: np.min(values),
}
OVER_THE_TURN = ("mean", "std")
"""Functions of the values at all angles of a load case; any other is made at one place."""
_UNITS = ("deg", "MPa")
"""Units that follow a number of a formula text."""
_SUM, _PRODUCT, _POWER, _ATOM = range(4)  # how strongly a node binds
_TOKEN = re.compile(
    r"\s*(?:(?P<number>\d+(?:\.\d+)?(?:e-?\d+)?)"
    r"|(?P<name>[A-Za-z](?:\w|\.(?=[A-Za-z*])|(?<=\.)\*|,(?=max))*'*)|(?P<sign>[-+*/^(),|]))"
)
_HEAD = re.compile(
    r"(?P<demand>.+?)\s*(?P<sense><=|>=|=)\s*(?P<limit>[^=<>]+?)"
    r"(?: over | on the | at (?=[a-z])|, |; |\.?$)"
)
_WORST = re.compile(r"^(?:max|min) over the load cases of ")
_DEFINED = re.compile(
    r"(?:(?<=^)|(?<=[;,:] )|(?<=with )|(?<=and ))(?P<name>[A-Za-z]\w*'*) = (?P<text>.+?)"
    r"(?=: |;|, (?:with )?[A-Za-z][\w']*(?:, [A-Za-z][\w']*)*(?: =|:)|\. |\.?$)"
)


class Node(NamedTuple):
    """Node of a formula: number, name, unary or binary sign, or function of its arguments."""

    kind: str
    text: str
    parts: tuple[Node, ...] = ()
    value: float = math.nan


class Statement(NamedTuple):
    """Demand against limit as a formula text states them, and the symbols that it defines.

    Parameters
    ----------
    demand, limit : str
    sense : str            ``<=``, ``>=`` or ``=``
    defined : mapping      text by name, such as ``y``: ``0.154 - 0.912/z``
    """

    demand: str
    sense: str
    limit: str
    defined: Mapping[str, str]


def stated(text: str) -> Statement:
    """Demand, limit and definitions of a formula text.

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
    return Statement(demand, match["sense"], match["limit"], defined)


def parsed(text: str, known: Collection[str] = ()) -> Node:
    """Tree of an expression; known: symbols that look like a function, such as ``R(T)``.

    Raises
    ------
    InputError
        If the text is no expression.
    """
    return _Reader(text, known).whole()


def names(node: Node) -> Iterator[str]:
    """Names of a tree, in their order, each once."""
    yield from dict.fromkeys(_names(node))


def _names(node: Node) -> Iterator[str]:
    if node.kind == "name":
        yield node.text
    for part in node.parts:
        yield from _names(part)


def value(node: Node, at_place: Resolver, over_turn: Resolver | None = None) -> Value:
    """Value of a tree, SI.

    Parameters
    ----------
    at_place : callable    symbol -> value at the place of the demand
    over_turn : callable   symbol -> values over the turn, for a mean; None: as at the place
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
    "/": lambda one, other: one / other,
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
        node = self._sum()
        if self._next()[0] != "end":
            raise InputError("formula", self.text, "one expression")
        return node

    def _sum(self) -> Node:
        node = self._product()
        while True:
            sign = self._next()[1]
            if self._next()[0] != "sign" or sign not in ("+", "-"):
                return node
            self.place += 1
            node = Node(sign, sign, (node, self._product()))

    def _product(self) -> Node:
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
        if self._take("-"):
            return Node("minus", "-", (self._signed(),))
        base = self._atom()
        return Node("^", "^", (base, self._signed())) if self._take("^") else base

    def _atom(self) -> Node:
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
        unit = self._next()[1]
        if self._next()[0] == "name" and unit in _UNITS:
            self.place += 1
            return Node("number", f"{text} {unit}", (), float(text) * factor(unit))
        return Node("number", text, (), float(text))

    def _call(self, text: str) -> Node:
        if not self._take("("):  # of the product that follows
            return Node("call", text, (self._product(),))
        parts = [self._sum()]
        while self._take(","):
            parts.append(self._sum())
        self._require(")")
        return Node("call", text, tuple(parts))


class Style(NamedTuple):
    """How a formula is written: its parts as text of a notation.

    name, number : callable      text -> text
    fraction, power, product : callable   two parts -> text
    """

    name: Callable[[str], str]
    number: Callable[[str], str]
    fraction: Callable[[str, str], str]
    power: Callable[[str, str], str]
    product: Callable[[str, str], str]
    sign: Callable[[str], str]
    root: Callable[[str], str]
    absolute: Callable[[str], str]
    group: Callable[[str], str]
    call: Callable[[str, str], str]
    comma: str
    divides: bool  # whether a fraction needs no parentheses about its parts


def written(node: Node, style: Style, known: Mapping[str, str] | None = None) -> str:
    """A tree in a notation; known: text in place of a name, such as its value with unit."""

    def of(each: Node, least: int) -> str:
        """Text of a part that has to bind at least so strongly."""
        text = written(each, style, known)
        return style.group(text) if _binds(each, style) < least else text

    if node.kind == "number":
        return style.number(node.text)
    if node.kind == "name":
        shown = None if known is None else known.get(node.text)
        return style.name(node.text) if shown is None else style.number(shown)
    if node.kind == "abs":
        return style.absolute(of(node.parts[0], _SUM))
    if node.kind == "minus":
        return style.sign("-") + of(node.parts[0], _PRODUCT)
    if node.kind == "call":
        inner = style.comma.join(of(part, _SUM) for part in node.parts)
        return style.root(inner) if node.text == "sqrt" else style.call(node.text, inner)
    one, other = node.parts
    if node.kind == "/":
        least = _SUM if style.divides else _PRODUCT
        return style.fraction(of(one, least), of(other, _SUM if style.divides else _POWER))
    if node.kind == "^":
        return style.power(of(one, _ATOM), of(other, _ATOM))
    if node.kind == "*":
        return style.product(
            of(one, _PRODUCT), of(other, _POWER if not style.divides else _PRODUCT)
        )
    return of(one, _SUM) + style.sign(node.kind) + of(other, _PRODUCT)


def _binds(node: Node, style: Style) -> int:
    if node.kind in ("+", "-", "minus"):
        return _SUM
    if node.kind == "*" or (node.kind == "/" and not style.divides):
        return _PRODUCT
    return _POWER if node.kind in ("^", "/") else _ATOM


TEXT = Style(
    name=str,
    number=str,
    fraction=lambda one, other: f"{one} / {other}",
    power=lambda one, other: f"{one}^{other}",
    product=lambda one, other: f"{one} · {other}",
    sign=lambda sign: f" {sign} " if sign != "-" else " - ",
    root=lambda inner: f"sqrt({inner})",
    absolute=lambda inner: f"|{inner}|",
    group=lambda inner: f"({inner})",
    call=lambda name, inner: f"{name}({inner})",
    comma=", ",
    divides=False,
)
"""Plain text of one line."""
_GREEK = {
    "alpha": "α", "kappa": "κ", "lambda": "λ", "mu": "μ", "nu": "ν", "phi": "φ", "pi": "π",
    "rho": "ρ", "sigma": "σ", "tau": "τ", "theta": "θ", "zeta": "ζ",
}  # fmt: skip


def symbol(name: str) -> tuple[str, str]:
    """Letter and subscript of a name in print: ``rho_p`` is ρ with p, ``limits.jump`` itself."""
    if "." in name:
        return name, ""
    base, _, below = name.partition("_")
    primes = len(name) - len(name.rstrip("'"))
    return _GREEK.get(base.rstrip("'"), base.rstrip("'")) + "′" * primes, below.rstrip("'")


def _mathml_name(name: str) -> str:
    letter, below = symbol(name)
    word = f"<mi>{escape(letter)}</mi>"
    return f"<msub>{word}<mi>{escape(below)}</mi></msub>" if below else word


def _row(*parts: str) -> str:
    return f"<mrow>{''.join(parts)}</mrow>"


MATHML = Style(
    name=_mathml_name,
    number=lambda text: f"<mtext>{escape(text)}</mtext>",
    fraction=lambda one, other: f"<mfrac>{_row(one)}{_row(other)}</mfrac>",
    power=lambda one, other: f"<msup>{_row(one)}{_row(other)}</msup>",
    product=lambda one, other: f"{one}<mo>·</mo>{other}",
    sign=lambda sign: f"<mo>{sign.replace('-', '−')}</mo>",
    root=lambda inner: f"<msqrt>{inner}</msqrt>",
    absolute=lambda inner: _row("<mo>|</mo>", inner, "<mo>|</mo>"),
    group=lambda inner: _row("<mo>(</mo>", inner, "<mo>)</mo>"),
    call=lambda name, inner: f"<mi>{name}</mi>{_row('<mo>(</mo>', inner, '<mo>)</mo>')}",
    comma="<mo>,</mo>",
    divides=True,
)
"""Elements of MathML, to stand in a ``math`` element."""


def _typst_name(name: str) -> str:
    letter, below = symbol(name)
    return f'"{letter}"_"{below}"' if below else f'"{letter}"'


TYPST = Style(
    name=_typst_name,
    number=lambda text: f'"{text}"',
    fraction=lambda one, other: f"frac({one}, {other})",
    power=lambda one, other: f"({one})^({other})" if " " in one else f"{one}^({other})",
    product=lambda one, other: f"{one} dot {other}",
    sign=lambda sign: f" {sign} ",
    root=lambda inner: f"sqrt({inner})",
    absolute=lambda inner: f"abs({inner})",
    group=lambda inner: f"lr(({inner}))",
    call=lambda name, inner: f'op("{name}")({inner})',
    comma=", ",
    divides=True,
)
"""Math mode of Typst."""
