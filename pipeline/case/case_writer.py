"""Text of case files: commented texts with their values, resolved cases, tables to be added.

A commented text is TOML with marks such as ``@speed@``. A mark before a comment becomes its value
in TOML, one within a comment its words.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import TypeAlias

import tomli_w

from camwright.pipeline.base.source import Source, entry_of
from camwright.pipeline.case.section import Section
from camwright.pipeline.case.toml_text import Tables, TomlValue, tables_of

Filling: TypeAlias = "TomlValue | Source | None"
"""Value of a mark; None: the line is left out."""
ADDED = "added"
"""Name of the tables at the end of a case file that add keys to those above."""
COMMENT_COLUMN = 37
"""Characters before the comment of a line."""
_HEADING = "# Camwright case, resolved: every default is written out.\n"
_MARK = re.compile(r"@(\w+)@")
_LINE = re.compile(r'((?:[^"#]|"(?:[^"\\]|\\.)*")*?)(\s*)(#.*)?')


def filled(text: str, **values: Filling) -> str:
    """A commented text with the values of its marks, its comments one below the other."""
    return "".join(f"{line}\n" for each in text.splitlines()
                   if (line := _filled(each, values)) is not None)  # fmt: skip


def _filled(line: str, values: Mapping[str, Filling]) -> str | None:
    """Line of a commented text with its marks replaced by values; None, for a line to be left out,
    where a value before the comment is None.

    Parameters
    ----------
    line : str         TOML with marks such as ``@speed@``
    values : mapping   by name of the mark
    """
    match = _LINE.fullmatch(line)
    if match is None:
        return line
    body, gap, comment = match.groups(default="")
    if any(values[name] is None for name in _MARK.findall(body)):
        return None
    body = _MARK.sub(lambda mark: value_text(values[mark[1]]), body)
    if not comment:
        return body
    if body:
        gap = " " * max(COMMENT_COLUMN - len(body), 2)
    return body + gap + _MARK.sub(lambda mark: str(values[mark[1]]), comment)


def value_text(value: Filling) -> str:
    """A value in TOML on one line; a source in its form of a case file."""
    if isinstance(value, Source):
        value = entry_of(value)
    if isinstance(value, dict):
        return f"{{ {', '.join(line_text(key, each) for key, each in value.items())} }}"
    if isinstance(value, list):
        return f"[{', '.join(map(value_text, value))}]"
    return tomli_w.dumps({"x": value}).removeprefix("x = ").rstrip("\n")


def line_text(key: str, value: Filling) -> str:
    """A key with its value in TOML on one line."""
    return tomli_w.dumps({key: 0}).removesuffix("0\n") + value_text(value)


def to_toml(case: Section, renamed: Mapping[str, str]) -> str:
    """TOML text of a case; `renamed` gives included files the names they are kept under."""
    return _HEADING + tables_text(tables_of(case, renamed))


def tables_text(tables: Tables) -> str:
    """TOML text of tables."""
    return tomli_w.dumps(tables)


def added_text(tables: Tables) -> str:
    """Tables as a block to be added at the end of a case file."""
    return tables_text({ADDED: [tables]})
