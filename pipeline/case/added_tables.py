"""Tables `[[added]]` that complete a case; example text for missing keys.

TOML forbids to open a table twice: lines below a second ``[guides.a]`` cannot be read. What stands
below ``[added.guides.a]`` is added to the table of that name, wherever in the file it stands.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import replace
from itertools import groupby
from pathlib import Path
from typing import Any

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import Material
from camwright.pipeline.case.cards.card_filling import fill_cards, known_cards
from camwright.pipeline.case.case_values import steps_of
from camwright.pipeline.case.case_writer import ADDED, line_text
from camwright.pipeline.case.error_text import MissingKeysError, Written, grouped
from camwright.pipeline.case.keys import (
    MATERIAL,
    NAME,
    REQUIRED,
    Key,
    case_keys,
    case_tables,
    keys_at,
    keys_in,
)
from camwright.pipeline.case.scope_section import is_stand_in
from camwright.pipeline.case.toml_text import Tables, TomlValue

NOTHING = "# No data are missing.\n"
_HEAD = (
    "# Data that the case lacks. Replace each example by the value of your machine, and paste the\n"
    "# block at the end of the case file.\n"
)
_OPTIONAL = (
    "# Optional: the verdict does not need these. Without the leading # they can be pasted, too.\n"
)


def with_added(case: Tables) -> Tables:
    """Tables of a case file with those below ``[[added]]`` merged into the tables of their names,
    in a copy.

    Raises
    ------
    InputError
        If the case states a key already, with another value.
    """
    if ADDED not in case:
        return case
    whole = deepcopy(case)
    blocks = whole.pop(ADDED)
    for block in blocks if isinstance(blocks, list) else [blocks]:
        if not isinstance(block, dict) or not isinstance(blocks, list):
            raise InputError(ADDED, str(block), "tables below [[added]]")
        _add(whole, block, "")
    return whole


def _add(table: Tables, more: Tables, path: str) -> None:
    """Write the keys of one table into another, in place, tables within tables.

    Parameters
    ----------
    table : Tables   changed
    more : Tables    keys to be added
    path : str       dotted name of the table, for messages

    Raises
    ------
    InputError
        For a key that `table` has with another value.
    """
    for key, value in more.items():
        stated, name = table.get(key), f"{path}.{key}".lstrip(".")
        if isinstance(stated, dict) and isinstance(value, dict):
            _add(stated, value, name)
        elif key in table and stated != value:
            raise InputError(f"{ADDED}.{name}", str(value), f"left out: the case states {stated}")
        else:
            table[key] = value


def added_text(
    needed: Iterable[str], optional: Iterable[str], materials: Mapping[str, Material]
) -> str:
    """TOML of tables ``[[added]]`` with an example for each missing key.

    Parameters
    ----------
    needed, optional : iterable   dotted keys, or tables of parts that are not described; the
                                  optional ones are commented out
    materials : mapping           materials of the case by name
    """
    first = _rows(needed)
    stated = {path for path, _ in first}
    second = [row for row in _rows(optional) if row[0] not in stated]
    parts = [_HEAD + _block(first, materials)] if first else []
    if second:
        lines = _block(second, materials).splitlines()
        parts.append(_OPTIONAL + "".join(f"# {line}".rstrip() + "\n" for line in lines))
    return "\n".join(parts) or NOTHING


def _completing(rows: Sequence[tuple[str, Key]]) -> str:
    """Tables ``[[added]]`` with an example for each key that a case cannot be read without.

    Keys of a row of a list, which no added table reaches, stand in comments.

    Parameters
    ----------
    rows : sequence   dotted path and key of each, in the order of a case file
    """
    reached = [row for row in rows if "[" not in row[0]]
    text = _HEAD + (_block(reached, {}) if reached else "")
    return text + "".join(
        f"# {path.rpartition('.')[0]}: {line_of(key)}\n" for path, key in rows if "[" in path
    )


def _rows(paths: Iterable[str]) -> list[tuple[str, Key]]:
    """Dotted paths of missing values with their keys, in the order of a case file; a table is
    replaced by the keys that it requires, or by its card and those that the card leaves.
    """
    rows: dict[str, Key] = {}
    for path in paths:
        for key in keys_at(path)[:1]:
            listed = [each for each in keys_in(key.path) if each.needed]
            if key.is_table and not key.example:
                rows |= dict(_with_card(path, listed))
            else:
                rows[path] = key
    order = {key.path: place for place, key in enumerate(case_keys())}
    return sorted(rows.items(), key=lambda row: (order[row[1].path], row[0]))


def _block(rows: Sequence[tuple[str, Key]], materials: Mapping[str, Material]) -> str:
    """Text of one `[[added]]` table with the examples of missing keys as values and a comment on
    each; the card of a table that has one comes first.

    Parameters
    ----------
    rows : sequence       dotted path and key of each value
    materials : mapping   of the case by name, whose cards are repeated
    """
    by_table = sorted(rows, key=lambda row: _place(row[0], rows))
    text = f"[[{ADDED}]]\n"
    for table, listed in groupby(by_table, key=lambda row: row[0].rpartition(".")[0]):
        pairs = [(line_of(key), _remark(key)) for _, key in listed]
        card = _card_of(table, materials)
        if card:
            pairs.insert(0, (line_text("card", card), "unchanged"))
        width = max(len(line) for line, _ in pairs)
        body = "".join(f"{line:{width}}  # {remark}\n" for line, remark in pairs)
        text += f"\n[{ADDED}.{table}]\n{body}" if table else body
    return text


def _place(path: str, rows: Sequence[tuple[str, Key]]) -> int:
    """Place of the first key of the same table."""
    table = path.rpartition(".")[0]
    return next(k for k, (each, _) in enumerate(rows) if each.rpartition(".")[0] == table)


def line_of(key: Key) -> str:
    """Line of TOML: a key with its example."""
    return line_text(key.name, key.example)


def _remark(key: Key) -> str:
    """Comment on an example: meaning of the key, values that it accepts where they are words,
    source.
    """
    words = key.accepted.replace("`", '"') if key.accepted.startswith("`") else ""
    return "; ".join(filter(None, ("example", key.meaning, words, f"source: {key.source}")))


def _card_of(table: str, materials: Mapping[str, Material]) -> str:
    """Card of a material that a bush brings; a table of added keys has to name it. "": none."""
    *parents, name = table.split(".")
    card = materials.get(name) if parents == ["materials"] else None
    return name if card is not None and card.source.text.startswith(f"card {name}: ") else ""


_KEYS_SPARED = 2  # least number of required keys that a card spares
_SAME = {f"guides.{side}.diameter": "follower.stem_diameter" for side in "ab"}
"""Keys whose example is the value of another."""

Rows = dict[str, Key]
"""Keys by their dotted paths."""


def with_examples(error: MissingKeysError, tables: Tables, folder: Path | None) -> MissingKeysError:
    """Refusal of a case that lists all missing required keys, with an example of each.

    Parameters
    ----------
    error : MissingKeysError   which names the missing keys
    tables : dict              resolved tables of the case, as far as they are there
    folder : Path              of the case, for its cards; None: shipped cards alone
    """
    written = Written(tables)
    missing = [key for key in error.keys if not is_stand_in(tables, key)]
    has_face = written.value(("follower", "face")) is not None
    if "roller" not in tables and written.value(("follower", "kind")) != "flat" and not has_face:
        missing.append("roller")
    rows = {path: key for each in missing for path, key in _within(each)}
    for path, other in _SAME.items():
        if path in rows:
            like = rows[other].example if other in rows else written.value(steps_of(other))
            rows[path] = rows[path] if like is None else replace(rows[path], instead=like)
    rows |= _materials(rows, written, folder)
    order = {key.path: place for place, key in enumerate(case_keys())}
    rows = dict(sorted(rows.items(), key=lambda row: (order[row[1].path], row[0])))
    listed = grouped({path: line_of(key) for path, key in rows.items()})
    return MissingKeysError(tuple(rows), listed, _completing(list(rows.items())))


def _within(path: str) -> Iterator[tuple[str, Key]]:
    """Missing key at a dotted path, with its path; in place of a table the keys that it requires,
    those of its tables too. A card stands for the keys that it fills, if it spares enough of them.
    """
    keys = keys_at(path)
    if not keys or not keys[0].is_table:
        yield from ((path, key) for key in keys[:1])
        return
    required = [key for key in keys_in(path) if key.default == REQUIRED]
    if keys[0].header.startswith("[["):
        row: TomlValue = [{key.name: key.example for key in required}]
        yield path, replace(keys[0], instead=row)
        return
    yield from _with_card(path, required)
    for name, field in _section(path).model_fields.items():
        if field.is_required():
            for key in keys_at(f"{path}.{field.alias or name}")[:1]:
                if key.is_table:
                    yield from _within(key.path)


def _with_card(path: str, listed: Sequence[Key]) -> Iterator[tuple[str, Key]]:
    """Keys of a table by their paths; its card in place of those that the card fills, if these are
    `_KEYS_SPARED` or more.

    Parameters
    ----------
    path : str          dotted name of the table
    listed : sequence   keys of the table that are missing
    """
    spared: Tables = {}
    for card in keys_at(f"{path}.card")[:1]:
        filled = _filled(path, card)
        if sum(key.name in filled for key in listed) >= _KEYS_SPARED:
            yield f"{path}.card", card
            spared = filled
    yield from ((f"{path}.{key.name}", key) for key in listed if key.name not in spared)


def _filled(path: str, card: Key) -> Tables:
    """Table of the values that the example of a card key fills in.

    Parameters
    ----------
    path : str   dotted name of the table
    card : Key   its key `card`, with the example
    """
    tables: Any = {card.name: card.example}
    table = tables
    for step in reversed(path.split(".")):
        tables = {step: tables}
    fill_cards(tables, None)
    return dict(table)


def _section(path: str) -> type[Any]:
    return next(each.section for each in case_tables() if each.path == path)


def _materials(rows: Rows, written: Written, folder: Path | None) -> Rows:
    """Card keys, by path, of the materials that the examples or the case name and the case does not
    have; without an example where no card has the name.

    Parameters
    ----------
    rows : mapping      missing keys by path, with examples
    written : Written   tables of the case
    folder : Path       of the cards of the user; None: shipped cards alone
    """
    stated = written.value(("materials",))
    known, shipped = stated if isinstance(stated, dict) else {}, known_cards(folder)["materials"]
    names: Iterable[object] = (
        *(key.example for key in rows.values() if key.accepted == MATERIAL),
        *(written.value(key.path.split(".")) for key in case_keys() if key.accepted == MATERIAL),
    )
    (card,) = keys_at(f"materials.{NAME}.card")
    return {
        f"materials.{name}.card": replace(card, instead=name) if name in shipped else card
        for name in names
        if isinstance(name, str) and name not in known
    }
