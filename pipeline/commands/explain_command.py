"""Command `explain`: a key of the case file or a check in words, or the schema of a record."""

from __future__ import annotations

import difflib
from textwrap import fill
from typing import TYPE_CHECKING, Annotated

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import PASSED, WIDTH, show_json, stdout
from camwright.pipeline.results.record_schemas import NAMES, record_schema

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from camwright.pipeline.case.keys import Key

LABEL = 14
CLOSEST = 6
"""Names in the message on an unknown one."""


def explain(
    words: Annotated[
        list[str] | None, Words("Keys or tables of a case file, or checks.", "WORD")
    ] = None,
    *,
    sources: Annotated[
        bool, Words("List the values of the program that are to be confirmed.")
    ] = False,
    schema: Annotated[
        str | None,
        Words("Print the JSON Schema of a record alone.", "RECORD", choices=tuple(NAMES)),
    ] = None,
) -> int:
    """Explain keys of the case file, such as guides.a.wall, tables such as spring, and checks.

    Of a key meaning, unit, range, default, example, source of the value and what uses it; of a
    check formula, limit, source, load cases and the values on which it rests.

    Example: camwright explain guides.a.wall jam_index
    """
    if schema is not None:
        show_json(record_schema(schema))
        return PASSED
    if not words and not sources:
        raise InputError("WORD", "missing", "a key, a table, a check, --sources or --schema")
    texts = [_explained(word) for word in words or ()]
    texts += [_open_sources()] if sources else []
    stdout.print("\n\n".join(texts), markup=False)
    return PASSED


def _open_sources() -> str:
    """Text that lists the values of the program that are to be confirmed, by their sources."""
    from camwright.pipeline.results.check_text import open_sources

    by_text = open_sources()
    count = sum(map(len, by_text.values()))
    listed = "\n".join(_text(text, [("", ", ".join(names))]) for text, names in by_text.items())
    return f"{count} values of the program are to be confirmed\n{listed}"


def _explained(word: str) -> str:
    """Text that explains a word: keys or table of the case file, check, or a kind that is not
    supported or has another name, with the keys and tables of its name in other tables; InputError
    with the closest ones if it is none of these.
    """
    from camwright.pipeline.base.missing_kinds import missing_kinds
    from camwright.pipeline.case.keys import case_keys, keys_at
    from camwright.pipeline.checks.registry import DECLARED

    parts = _of_keys(word, keys_at(word))
    if word in DECLARED:
        parts.append(_of_check(word))
    if not parts:
        parts = [_text(f"{word}: {kind.sentence}", ()) for kind in missing_kinds("", word)]
    if not parts:
        raise InputError("WORD", word, f"a key or table of a case file, or a check{_closest(word)}")
    alike = {key.path: None for key in case_keys() if key.path.endswith(f".{word}")}
    parts += [text for path in alike for text in _of_keys(path, keys_at(path))]
    return "\n\n".join(parts)


def _of_keys(word: str, keys: Sequence[Key]) -> list[str]:
    """Texts on the keys at a path of the case file: one for keys of several tables that accept the
    same, with the same default.

    Parameters
    ----------
    word : str        the path as typed
    keys : sequence   at this path, one per table that may stand there
    """
    kinds: dict[tuple[str, str], list[Key]] = {}
    for key in keys:
        kinds.setdefault((key.accepted, key.default), []).append(key)
    return [
        _of_table(word, same) if same[0].is_table else _of_key(word, same)
        for same in kinds.values()
    ]


def _of_key(word: str, keys: Sequence[Key]) -> str:
    """Text on a key: meaning, unit, default, example, source, use."""
    from camwright.pipeline.case.added_tables import line_of
    from camwright.pipeline.case.keys import REQUIRED
    from camwright.pipeline.results.check_text import checks_with

    key = keys[0]
    absent = "none" if key.default != REQUIRED else "none: the key is required"
    return _text(
        f"{word}: {key.meaning}",
        (
            ("table", ", ".join(dict.fromkeys(each.header for each in keys))),
            ("accepted", key.accepted.replace("`", '"')),
            ("default", absent if key.default in ("", REQUIRED) else key.default.replace("`", "")),
            ("example", line_of(key)),
            ("source", key.source),
            ("used by", key.used),
            ("checks", ", ".join(checks_with(key))),
        ),
    )


def _of_table(word: str, keys: Sequence[Key]) -> str:
    """Text on a table of the case file with its keys and tables."""
    from camwright.pipeline.case.keys import case_keys, keys_in

    table = keys[0].path
    within = [
        each.path.removeprefix(f"{table}.")
        for each in case_keys()
        if each.is_table and each.table == table
    ]
    rows = [
        ("table", ", ".join(dict.fromkeys(each.header for each in keys))),
        ("used by", keys[0].used),
        ("tables", ", ".join(dict.fromkeys(within))),
    ]
    listed = [(each.name, each.meaning) for each in keys_in(table)]
    width = max((len(name) for name, _ in listed), default=0) + 4
    return _text(f"{word}: {keys[0].meaning}", rows) + "\n" + _listed(listed, width)


def _of_check(name: str) -> str:
    """Text on a check: formula, limit, load cases, values on which it rests."""
    from camwright.pipeline.checks.registry import DECLARED
    from camwright.pipeline.results.check_text import check_text

    words = check_text(DECLARED[name])
    return _text(
        f"{name}: {words.title}",
        (
            ("formula", words.formula.replace("`", "")),
            ("limit", words.limit.replace("`", "")),
            ("calculation", words.calculation),
            ("load cases", words.load_cases),
            ("verdict", words.decision),
            ("loads", words.load_end),
            ("depth", words.depth),
            ("rests on", ", ".join(words.rests_on)),
        ),
    )


def _text(heading: str, rows: Iterable[tuple[str, str]]) -> str:
    listed = _listed([row for row in rows if row[1]], LABEL)
    return fill(heading, WIDTH) + (f"\n{listed}" if listed else "")


def _listed(rows: Iterable[tuple[str, str]], width: int) -> str:
    """Rows of a name and a text, which is wrapped beside the name."""
    return "\n".join(
        fill(
            text,
            WIDTH,
            initial_indent=f"  {name:<{width - 2}}",
            subsequent_indent=" " * width,
            break_long_words=False,
            break_on_hyphens=False,
        )
        for name, text in rows
    )


def _closest(word: str) -> str:
    """End of a message that suggests the closest keys and checks; "" without any."""
    from camwright.pipeline.case.keys import case_keys
    from camwright.pipeline.checks.registry import DECLARED

    known = list(dict.fromkeys([*(key.path for key in case_keys()), *DECLARED]))
    last = word.rpartition(".")[2]
    alike = [each for each in known if each.rpartition(".")[2] == last]
    alike += difflib.get_close_matches(word, known, n=3)
    names: dict[str, list[str]] = {}
    for each in known:
        names.setdefault(each.rpartition(".")[2], []).append(each)
    for name in difflib.get_close_matches(last, names, n=1):
        alike += names[name]
    listed = list(dict.fromkeys(alike))[:CLOSEST]
    return f"; did you mean {', '.join(listed)}?" if listed else ""
