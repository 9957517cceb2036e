"""Docstrings below the fields of a class, read from its source."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Iterator, Mapping
from functools import cache
from itertools import pairwise
from types import MappingProxyType


def texts_below(kind: type) -> Mapping[str, str]:
    """First paragraphs of the docstrings below the fields of a class and its bases, by field.

    A `TypedDict` has no bases at run time: of its own keys.

    Raises
    ------
    OSError
        If the source of a class is not there.
    """
    texts: dict[str, str] = {}
    for each in reversed(kind.__mro__):
        texts |= _texts_in(each.__module__).get(each.__qualname__, {})
    return MappingProxyType(texts)


@cache
def _texts_in(module: str) -> Mapping[str, Mapping[str, str]]:
    """First paragraphs of the docstrings below the fields of the classes of a module, by class and
    field; empty for a module of another package.
    """
    if not module.startswith("camwright."):
        return {}
    tree = ast.parse(inspect.getsource(sys.modules[module]))
    return {
        node.name: dict(_texts_of(node)) for node in tree.body if isinstance(node, ast.ClassDef)
    }


def _texts_of(node: ast.ClassDef) -> Iterator[tuple[str, str]]:
    """Names of the fields of a class, each with the first paragraph of the docstring below it."""
    for field, below in pairwise(node.body):
        if not isinstance(field, ast.AnnAssign) or not isinstance(field.target, ast.Name):
            continue
        if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
            paragraph, *_ = inspect.cleandoc(str(below.value.value)).split("\n\n")
            yield field.target.id, " ".join(paragraph.split())
