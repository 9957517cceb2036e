"""Write the tables of docs/ from the program, between `<!-- table: NAME -->` and `<!-- end -->`."""

from __future__ import annotations

import ast
import inspect
import re
import tomllib
from collections.abc import Callable, Iterable, Mapping
from itertools import groupby
from pathlib import Path

from camwright.pipeline.base.missing_kinds import MISSING_KINDS, MissingKind
from camwright.pipeline.base.tables import Column
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.keys import (
    accepted,
    case_keys,
    default,
    nested,
    of_field,
    sections,
)
from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.case.requirements_section import Smoothing
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.registry import DECLARED, MODULES, declared_in
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.axial_pressure import AXIAL_ARRAYS
from camwright.pipeline.cycle.guide_pressure import GUIDE_ARRAYS, PIVOT_ARRAYS
from camwright.pipeline.cycle.rolling_history import ENVELOPE_ARRAYS
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.check_text import check_text, default_of, open_sources, sentence
from camwright.pipeline.results.field_output import TURN_ARRAYS
from camwright.pipeline.results.model_limits import MODEL_LIMITS
from camwright.pipeline.results.run_records import PRESSURE_ARRAYS, column_table
from camwright.pipeline.screening.screened_checks import SCREENED
from camwright.pipeline.smoothing.objective import COSTS, SPEED, TORQUE, harmonics
from camwright.pipeline.studies.batch.dataset import (
    FACTOR,
    FIGURES,
    FILES,
    FIXED,
    HEADLINE,
    MESH,
    is_text,
)
from camwright.pipeline.studies.batch.study_file import Study

ROOT = Path(__file__).resolve().parents[1]
BLOCK = re.compile(r"<!-- table: (\w+) -->\n.*?<!-- end -->", re.DOTALL)
SHOWN_CASES = ("gx120-redesign.toml", "papers/petrescu_c.toml")
"""A roller and a flat face; together they have every column."""


def markdown(head: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    head = list(head)
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in lines
    )


def limits() -> str:
    rows = (
        (
            f"`{row.id}`", row.title, row.quantity.limit.replace(" and ", ", "),
            default_of(row),
            "maximum" if row.sense == "at_most" else "minimum", str(row.source),
        )
        for row in LIMITS.values()
    )  # fmt: skip
    return markdown(("key", "limit", "accepted", "default", "bound", "source"), rows)


def checks() -> str:
    """Each check with formula, limit, source, load cases, and why it decides, by module."""
    parts = []
    for module in MODULES:
        words = (ast.get_docstring(ast.parse(inspect.getsource(module))) or "").splitlines()[0]
        title = re.sub("^Checks (of the |of |that )", "", words.rstrip("."))
        parts.append(f"### {title[:1].upper()}{title[1:]}")
        parts += [_check(each) for each in declared_in(module)]
    return "\n\n".join(parts)


def to_be_confirmed() -> str:
    """Values of the program whose source is not confirmed, by their sources."""
    rows = [
        (text, ", ".join(f"`{name}`" for name in names)) for text, names in open_sources().items()
    ]
    count = sum(map(len, open_sources().values()))
    return f"{count} values:\n\n" + markdown(("source", "values"), rows)


def _check(one: Declaration) -> str:
    words = check_text(one)
    load_end = f"- {words.load_end}\n" if words.load_end else ""
    lines = (
        f"#### `{one.id}`: {words.title}",
        words.formula,
        f"- Calculation: {words.calculation}\n- Limit: {words.limit}\n"
        f"- Load cases: {words.load_cases}\n- {words.decision}\n{load_end}- {words.depth}",
    )
    return "\n\n".join(lines)


def objective() -> str:
    """Terms of the objective of a synthesis with their references and default weights."""
    fields = Smoothing.model_fields
    rows = (
        (f"`{term.key}_weight`", term.words, term.reference,
         default(fields[f"{term.key}_weight"]))
        for term in (TORQUE, SPEED, harmonics(()), *COSTS)
    )  # fmt: skip
    return markdown(("key", "term", "1 at", "default weight"), rows)


def columns() -> str:
    known: dict[tuple[str, str], str] = {}
    for name in SHOWN_CASES:
        case = read_case(ROOT / "cases" / name).with_positions(36)
        # the quickest smoother: no column of these files depends on it
        plain = case.smoothing.model_copy(update={"kind": "moving_average"})
        trial = preview_case(case.model_copy(update={"smoothing": plain}), corners=False)
        for file, listed in column_table(trial).items():
            if file != "2_limits.csv":  # a column for each limit of the case
                known |= {(file, column.header): column.meaning for column in listed}
    files = sorted({file for file, _ in known})
    rows = (
        (f"`{header}`", f"`{file}`", meaning)
        for file in files
        for (other, header), meaning in known.items()
        if other == file
    )
    return markdown(("column", "file", "content"), rows)


def arrays() -> str:
    files = {
        "5_pressure.npz": PRESSURE_ARRAYS,
        "5_guides.npz": GUIDE_ARRAYS,
        "5_pivot.npz": PIVOT_ARRAYS,
        "5_length.npz": AXIAL_ARRAYS,
        "5_envelope.npz": ENVELOPE_ARRAYS,
        "fields/turn.npz": TURN_ARRAYS,
    }
    rows = (
        (f"`{'LOAD_CASE.' * (listed is ENVELOPE_ARRAYS)}{column.header}`", f"`{file}`",
         column.meaning)
        for file, listed in files.items()
        for column in listed
    )  # fmt: skip
    return markdown(("array", "file", "shape and content"), rows)


def model_limits() -> str:
    return "\n".join(f"- {each.statement}" for each in MODEL_LIMITS)


def missing_kinds() -> str:
    """Kinds that are not done, the words of a case file that name them, and what comes nearest."""
    rows = (_kind_row(each) for each in MISSING_KINDS if not each.done)
    return markdown(("not done", "part", "called in a case file", "nearest to it"), rows)


def renamed_kinds() -> str:
    """Kinds that are done, the words that name them elsewhere, and what states them."""
    rows = (_kind_row(each) for each in MISSING_KINDS if each.done)
    return markdown(("done", "part", "called elsewhere", "stated by"), rows)


def _kind_row(kind: MissingKind) -> tuple[str, ...]:
    return kind.name.rstrip(","), kind.area, ", ".join(kind.words), kind.instead


def screening() -> str:
    """Checks that screening judges, with the deviation of each from the preview."""
    rows = []
    for each in SCREENED:
        declared = DECLARED[each.check]
        judged = "fails only" if declared.is_bound(Tier.SCREENING) else "passes and fails"
        deviation = f"{100.0 * each.deviation:g} %"
        rows.append(
            (f"`{each.check}`", declared.title.format(follower="roller"), deviation, judged)
        )
    return markdown(("check", "title", "deviation", "screening"), rows)


def dataset() -> str:
    """Columns of a dataset, the groups by an example of their name."""
    rows = [(f"`{each.name}`", _type(each), "", each.meaning) for each in FIXED]
    rows.append((f"`{FACTOR}KEY`", "double or string", "of the study file", "value of a factor"))
    rows.append((f"`{HEADLINE}KEY`", "double", "by the suffix of KEY", "headline of `run.json`"))
    rows.append((f"`{MESH}KEY`", "double", "by the suffix of KEY", "mesh of a row by elements"))
    for figure, words in FIGURES.items():
        number = figure not in ("utilisation", "status")
        kind, unit = "string" if figure == "status" else "double", "of the check" if number else ""
        rows.append((f"`CHECK.{figure}`", kind, unit, words[0].lower() + words[1:]))
    return markdown(("column", "type", "unit", "meaning"), rows)


def _type(column: Column) -> str:
    return "string" if is_text(column.name, {}) else "int64"


def study_files() -> str:
    rows = ((f"`{name}`", words) for name, words in FILES.items())
    return markdown(("file", "contents"), rows)


def packages() -> str:
    """Packages in the order of the imports, with the first line of each docstring."""
    house = (ROOT / "tests" / "unit" / "test_house.py").read_text(encoding="utf-8")
    listed = re.search(r"^ORDER = (\(.*?^\))", house, re.DOTALL | re.MULTILINE)
    order: tuple[str, ...] = ast.literal_eval(listed[1]) if listed else ()
    rows = []
    for name in order:
        folder = ROOT.joinpath(*name.split("."))
        file = folder / "__init__.py" if folder.is_dir() else folder.with_suffix(".py")
        words = ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) or ""
        rows.append((f"`{name}`", words.splitlines()[0].rstrip(".")))
    return markdown(("package", "responsibility"), rows)


def renamed(*tables: str) -> str:
    """Earlier and present names of some tables of ``renamed.toml``."""
    text = (ROOT / "pipeline" / "case" / "renamed.toml").read_text(encoding="utf-8")
    known = tomllib.loads(text)
    rows = (
        (f"`{old}`", f"`{new}`")
        for table in tables
        for old, new in known.get(table, {}).items()
        if isinstance(new, str)
    )
    return markdown(("earlier", "now"), rows)


def keys() -> str:
    """Every key of a case file with its meaning, a table for each table of the file."""
    parts = []
    for header, listed in groupby(case_keys(), key=lambda key: key.header):
        whole = list(listed)
        about = "".join(f"\n\n{sentence(key.meaning)}" for key in whole if key.is_table)
        rows = (
            (f"`{key.name}`", key.meaning, key.accepted, key.default)
            for key in whole
            if not key.is_table
        )
        table = markdown(("key", "meaning", "accepted", "default"), rows)
        parts.append(f"### `{header}`{about}\n\n{table}")
    return "\n\n".join(dict.fromkeys(parts))  # a table of two kinds once


def study_keys() -> str:
    """A table of keys for each section of a study file."""
    parts = []
    for _, header, section, *_ in sections(Study):
        rows = [
            (f"`{field.alias or name}`", accepted(field), of_field(section, name))
            for name, field in section.model_fields.items()
            if not any(nested(field))
        ]
        if rows:
            parts.append(f"### `{header}`\n\n{markdown(('key', 'accepted', 'default'), rows)}")
    return "\n\n".join(parts)


TABLES: Mapping[str, Callable[[], str]] = {
    "limits": limits,
    "open_sources": to_be_confirmed,
    "missing_kinds": missing_kinds,
    "renamed_kinds": renamed_kinds,
    "checks": checks,
    "columns": columns,
    "arrays": arrays,
    "objective": objective,
    "model_limits": model_limits,
    "dataset": dataset,
    "study_files": study_files,
    "packages": packages,
    "screening": screening,
    "keys": keys,
    "study_keys": study_keys,
    "renamed_case": lambda: renamed("case"),
    "renamed_results": lambda: renamed("columns", "headline", "files"),
    "renamed_checks": lambda: renamed("checks"),
}


def filled(text: str) -> str:
    """A page with its tables as they are now."""
    return BLOCK.sub(lambda m: f"<!-- table: {m[1]} -->\n{TABLES[m[1]]()}\n<!-- end -->", text)


if __name__ == "__main__":
    for page in sorted((ROOT / "docs").glob("*.md")):
        page.write_text(filled(page.read_text(encoding="utf-8")), encoding="utf-8")
