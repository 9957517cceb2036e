"""Text of a run's values: digits, units, rows of tables."""

from __future__ import annotations

import datetime as dt
import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isclose, isfinite, isnan, pi
from typing import Any, TypeAlias

from camwright.pipeline.base.files import Json
from camwright.pipeline.base.source import source_in
from camwright.pipeline.base.units import used
from camwright.pipeline.base.verdict import in_order
from camwright.pipeline.results.check_records import of_records
from camwright.pipeline.results.check_report import not_proven
from camwright.pipeline.results.verdict_summary import body_stresses
from camwright.reports.check_parts import part_of

Scalar: TypeAlias = str | float | None
Record: TypeAlias = Mapping[str, Any]
"""A JSON object or TOML table of a run's files."""

MINUS = "\N{MINUS SIGN}"
DASH = "\N{EN DASH}"
UNPRINTABLE = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
TURNING = {"R", "AL", "RLE", "RLO", "LRE", "LRO", "RLI", "LRI", "FSI", "PDF", "PDI"}
_TYPED_MINUS = re.compile(r"(?<![^\s(])-(?=\d)")  # before a number
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
SHOWN_AS = {
    "Pa": ("MPa", 1e-6),
    "m": ("mm", 1e3),
    "rad": ("deg", 180.0 / pi),
    "N/m": ("N/mm", 1e-3),
    "Pa m/s": ("MPa m/s", 1e-6),
    "Pa*m/s": ("MPa m/s", 1e-6),
    "Pa·m/s": ("MPa m/s", 1e-6),
    "MPa*m/s": ("MPa m/s", 1.0),
    "MPa·m/s": ("MPa m/s", 1.0),
    "Nm": ("N m", 1.0),
    "1": ("", 1.0),
    "-": ("", 1.0),
}
HEADLINES = {
    "torque_std_before_Nm": ("Torque ripple before, standard deviation", "N m"),
    "torque_std_after_Nm": ("Torque ripple after, standard deviation", "N m"),
    "torque_p2p_before_Nm": ("Torque before, peak to peak", "N m"),
    "torque_p2p_after_Nm": ("Torque after, peak to peak", "N m"),
    "torque_mean_Nm": ("Mean torque", "N m"),
    "lift_max_mm": ("Maximum lift", "mm"),
    "pressure_angle_max_deg": ("Maximum pressure angle", "deg"),
    "pitch_radius_of_curvature_min_mm": ("Minimum convex radius of the pitch curve", "mm"),
    "normal_force_min_N": ("Minimum normal force", "N"),
    "normal_force_max_N": ("Maximum normal force", "N"),
    "p0_max_MPa": ("Peak contact pressure p0, finite elements", "MPa"),
    "p0_hertz_max_MPa": ("Peak contact pressure p0, Hertz", "MPa"),
    "half_width_max_mm": ("Maximum contact half-width", "mm"),
    "von_mises_max_MPa": ("Maximum von Mises stress in the cam", "MPa"),
    "von_mises_depth_mm": ("Its depth below the surface of the cam", "mm"),
    "follower_von_mises_max_MPa": ("Maximum von Mises stress in the follower", "MPa"),
    "follower_von_mises_depth_mm": ("Its depth below the surface of the follower", "mm"),
    "ring_stress_max_MPa": ("Maximum bending stress in the ring of the roller", "MPa"),
    "guide_reaction_A_max_N": ("Maximum reaction, guide A", "N"),
    "guide_reaction_B_max_N": ("Maximum reaction, guide B", "N"),
    "friction_loss_J_per_cam_turn": ("Friction loss per cam turn", "J"),
    "p0_difference_max_percent": ("Maximum difference of p0, finite elements to Hertz", "%"),
    "residual_equilibrium_max": ("Maximum relative equilibrium residual", ""),
}
BAR_TOP = 1.5
"""Utilisation at the right end of a bar."""
LEAST_ERROR = 1e-4
"""Share of the demand below which an error bar is smaller than the last digit shown."""
STATUS = {
    "pass": "pass",
    "fail": "fail",
    "waived": "waived",
    "not_evaluated": "not evaluated",
}


ROUND_OFF_DEG = 1e-9
"""Angle below which it is shown as 0, deg."""


def number(value: Scalar, digits: int = 4) -> str:
    """Number with `digits` significant digits; a dash if missing.

    Integers keep all digits. Trailing zeros are omitted where the value is exact (30, not 30.00).
    Magnitudes outside 1e-4 to 1e6 are written with a power of ten. The minus is U+2212.
    """
    if isinstance(value, bool) or value is None:
        return DASH if value is None else ("yes" if value else "no")
    if isinstance(value, int):
        return str(value).replace("-", MINUS)
    if not isinstance(value, float):
        return str(value)
    if isnan(value):
        return DASH
    if not isfinite(value):
        return "∞" if value > 0 else MINUS + "∞"
    if value == 0:
        return "0"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    power = int(exponent)
    exact = isclose(float(f"{mantissa}e{exponent}"), value, rel_tol=1e-12)
    if not -4 <= power < 6:
        shown = mantissa.rstrip("0").rstrip(".") if exact and "." in mantissa else mantissa
        return f"{shown}×10{str(power).translate(SUPERSCRIPT)}".replace("-", MINUS)
    shown = f"{value:.{max(digits - 1 - power, 0)}f}"
    if exact and "." in shown:
        shown = shown.rstrip("0").rstrip(".")
    return shown.replace("-", MINUS)


def listed(value: Scalar | Sequence[Scalar]) -> str:
    """Number or list as text; "none" for an empty list."""
    if value is None or isinstance(value, (str, int, float)):
        return number(value)
    return ", ".join(words(str(one)) for one in value) or "none"


def quantity(value: Scalar, unit: str = "", digits: int = 4) -> str:
    """Number with unit, SI units converted to drawing units (MPa, mm, deg); an angle that is
    round-off as 0.
    """
    if isinstance(value, (int, float)) and not isinstance(value, bool) and unit in SHOWN_AS:
        unit, scale = SHOWN_AS[unit]
        value = value * scale if scale != 1.0 else value
    if unit == "deg" and isinstance(value, float) and abs(value) < ROUND_OFF_DEG:
        value = 0.0
    text = number(value, digits)
    unit = re.sub(r"\^([23])", lambda power: power[1].translate(SUPERSCRIPT), unit)
    unit = unit.replace(" ", "\N{NO-BREAK SPACE}")
    return f"{text}\N{NO-BREAK SPACE}{unit}" if unit and text != DASH else text


def in_unit(value: float, unit: str, wanted: str) -> float | None:
    """Value given in `unit`, converted to the unit of a figure; None for another dimension."""
    shown, scale = SHOWN_AS.get(unit, (unit, 1.0))
    if shown == wanted:
        return value * scale
    return value if unit == wanted else None


def plain(text: str) -> str:
    """Text with control characters and surrogates replaced by U+FFFD."""
    return UNPRINTABLE.sub("\ufffd", text)


def shortened(text: str, length: int) -> str:
    """Text in one line, cut to `length` characters."""
    line = " ".join(plain(text).split())
    return line if len(line) <= length else line[: length - 1] + "…"


def printed(text: str) -> str:
    """Terminal text with typographic minus, arrows and comparison signs."""
    for typed, sign in (("->", "→"), (">=", "≥"), ("<=", "≤")):
        text = text.replace(f" {typed} ", f" {sign} ")
    return _TYPED_MINUS.sub(MINUS, text)


def isolated(text: str) -> str:
    """Text whose right-to-left parts are isolated by Unicode controls."""
    turns = any(unicodedata.bidirectional(character) in TURNING for character in text)
    return f"\u2068{text}\u2069" if turns else text


def words(name: str) -> str:
    """Snake_case name with spaces in place of underscores."""
    return name.replace("_", " ").strip()


@dataclass(frozen=True)
class Status:
    """Status of a check or verdict: id, which selects the colour, and words."""

    id: str
    words: str


Cell = str | Status


@dataclass(frozen=True)
class ReportTable:
    """Table of a report.

    The first `text` columns hold words, the next `numbers` columns numbers (None: all others). On
    a narrow screen a `wide` table scrolls sideways; the cells of any other one are stacked.
    """

    label: str
    head: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    text: int = 1
    numbers: int | None = None
    wide: bool = False

    @property
    def numeric(self) -> range:
        """Indices of the columns that hold numbers."""
        end = len(self.head) if self.numbers is None else self.text + self.numbers
        return range(self.text, end)


@dataclass(frozen=True)
class CheckRow:
    """Row of a check as text; `bar`: utilisation clipped to `BAR_TOP`, None if unknown."""

    id: str
    title: str
    status: Status
    demand: str
    limit: str
    utilisation: str
    bar: float | None
    where: str
    load_case: str
    source: str
    method: str
    note: str
    waiver: str
    must_have: bool
    error: str = ""
    corner: str = ""
    unproven: str = ""
    judged_at: str = ""
    evidence: bool = False
    remedy: str = ""
    part: str = ""

    @property
    def place(self) -> str:
        """Load case and cam angle of the demand; a dash without either."""
        return ", ".join(filter(None, (isolated(self.load_case), self.where))) or DASH

    @property
    def category(self) -> str:
        """Part of the mechanism, and whether the check is optional."""
        return self.part if self.must_have else f"{self.part}, optional"

    @property
    def remarks(self) -> list[tuple[str, bool]]:
        """(text, emphasised) below the title: method, note, proof, corner, waiver, remedy."""
        limit = f"Limit: {self.source}" if self.source else ""
        corner = f"Worst tolerance corner: {self.corner}" if self.corner else ""
        lines = [
            (" · ".join(filter(None, (self.method, limit))), False), (self.note, True),
            (self.unproven, True), (corner, False),
            (f"Judged at the depth {self.judged_at}" if self.judged_at else "", True),
            (f"Waiver: {self.waiver}" if self.waiver else "", True),
            (f"Remedy: {self.remedy}" if self.remedy else "", True),
        ]  # fmt: skip
        return [line for line in lines if line[0]]


def check_rows(checks: Sequence[Record]) -> list[CheckRow]:
    """Rows of checks as text, in the order of `verdict.in_order`."""
    rows = []
    for one in in_order(of_records(checks)):
        check, value = one.record, one.utilisation
        status = str(check["status"])
        status_words = STATUS.get(status, words(status))
        status_words += ", not proven" if check["not_proven"] else ""
        unit = str(check["unit"])
        sense = "≥" if check["sense"] == "at_least" else "≤"
        limit = quantity(check["limit"], unit)
        angle = check["cam_angle_deg"]
        rows.append(CheckRow(
            id=str(check["id"]), title=str(check["title"]),
            status=Status(status, status_words),
            demand=quantity(check["demand"], unit),
            limit=limit if limit == DASH else f"{sense}\N{NO-BREAK SPACE}{limit}",
            utilisation=DASH if value is None else used(value), bar=_bar(value),
            where=quantity(angle, "deg") if isinstance(angle, (int, float)) else "",
            load_case=str(check["load_case"] or ""),
            source=str(check["source"]), method=str(check["method"]),
            note=str(check["note"]), waiver=_waiver(check, unit),
            must_have=bool(check["must_have"]),
            error=_error(check, unit), corner=": ".join(worst_corner(check) or ()),
            unproven=not_proven(check), judged_at=str(check["judged_at"]),
            evidence=bool(check["evidence"]),
            remedy=printed(str(check.get("remedy") or "")), part=part_of(check),
        ))  # fmt: skip
    return rows


def _error(check: Record, unit: str) -> str:
    """Error bar of a demand as text, in its unit as shown; "" below the last digit shown."""
    error, demand = (_finite(check[name]) for name in ("error", "demand"))
    if error is None or demand is None or not error or error < LEAST_ERROR * abs(demand):
        return ""
    scale = SHOWN_AS[unit][1] if unit in SHOWN_AS else 1.0
    return f"±\N{NO-BREAK SPACE}{number(scale * error, 2)}"


def _finite(value: Json) -> float | None:
    return float(value) if isinstance(value, (int, float)) and isfinite(value) else None


def worst_corner(check: Record) -> tuple[str, str] | None:
    """Name of the governing tolerance corner of a check, and its demand as text with unit.

    None if the check has none, or if its demand equals the nominal one in all digits shown.
    """
    unit, demand = str(check["unit"]), check["corner_demand"]
    if not check["corner"] or demand is None:
        return None
    there = quantity(demand, unit)
    return None if there == quantity(check["demand"], unit) else (str(check["corner"]), there)


def _bar(value: float | None) -> float | None:
    return None if value is None or isnan(value) else min(max(value, 0.0), BAR_TOP)


def _waiver(check: Record, unit: str) -> str:
    """Value up to which a waiver accepts the demand, and its name, date and reason."""
    waiver = check["waiver"]
    return f"up to {quantity(check['waived_up_to'], unit)}, {waiver}" if waiver else ""


@dataclass(frozen=True)
class Tile:
    """Key figure in large type with a second line."""

    title: str
    value: str
    below: str


def tiles(headline: Record) -> list[Tile]:
    """Key figures of a run as tiles; missing ones are omitted."""
    made = []
    before, after = (headline.get(f"torque_std_{when}_Nm") for when in ("before", "after"))
    if before and after is not None:
        made.append(Tile(
            "Torque ripple reduction", quantity(100.0 * (1.0 - after / before), "%", 3),
            f"standard deviation {number(before, 3)} to {quantity(after, 'N m', 3)}",
        ))  # fmt: skip
    rows = (
        ("Peak contact pressure", "p0_max_MPa", "MPa", "Hertz {} MPa", "p0_hertz_max_MPa"),
        ("Maximum normal force", "normal_force_max_N", "N", "minimum {} N", "normal_force_min_N"),
        ("Lift", "lift_max_mm", "mm",
         "minimum convex pitch radius {} mm", "pitch_radius_of_curvature_min_mm"),
        ("Maximum pressure angle", "pressure_angle_max_deg", "deg", "", ""),
        ("Maximum reaction, guide A", "guide_reaction_A_max_N", "N",
         "guide B {} N", "guide_reaction_B_max_N"),
    )  # fmt: skip
    if headline.get("von_mises_max_MPa") is not None:
        value, *others = body_stresses(headline)
        made.append(Tile(
            "Maximum von Mises stress", quantity(headline["von_mises_max_MPa"], "MPa"),
            "; ".join((value.partition(" MPa ")[2], *others)),
        ))  # fmt: skip
    for title, key, unit, below, other in rows:
        if headline.get(key) is not None:
            second = headline.get(other)
            made.append(Tile(
                title, quantity(headline[key], unit),
                below.format(number(second)) if second is not None else "",
            ))  # fmt: skip
    return made


def named_rows(record: Record) -> list[tuple[str, str]]:
    """(name, value) of a record; a unit suffix of the name is written with the value."""
    rows = []
    for key, value in record.items():
        if isinstance(value, Mapping):
            rows += [(f"{words(str(key))}, {words(str(k))}", number(v)) for k, v in value.items()]
            continue
        name, _, unit = str(key).rpartition("_")
        known = unit in ("deg", "mm", "MPa", "N")
        rows.append((words(name if known else str(key)), quantity(value, unit if known else "")))
    return rows


def headline_rows(headline: Record) -> list[tuple[str, str]]:
    """(name, value with unit) of a run's key figures; missing ones are omitted."""
    rows = []
    for key, value in headline.items():
        if value is None:
            continue
        title, unit = HEADLINES.get(key, (words(key), ""))
        rows.append((title, quantity(value, unit)))
    return rows


@dataclass(frozen=True)
class InputTable:
    """Section of the case file; rows are (name, value, source)."""

    title: str
    rows: tuple[tuple[str, str, str], ...]
    source: str = ""


def input_tables(case: Record) -> list[InputTable]:
    """Resolved case as tables, with the source of each value if stated."""
    general = {key: v for key, v in case.items() if not isinstance(v, (Mapping, list))}
    tables = [_input_table("general", general)] if general else []
    for title, section in _sections(case):
        table = _input_table(title, section)
        if table.rows or table.source:
            tables.append(table)
    return tables


def _sections(case: Record, path: str = "") -> Iterator[tuple[str, Record]]:
    """Pairs (title, section) of the tables of a case, each before the tables inside it; titles hold
    the path, items of a list a number.

    Parameters
    ----------
    path : str   title of the section `case`; "" of the whole case
    """
    for key, value in case.items():
        title = f"{path} › {words(key)}" if path else words(key)
        if isinstance(value, Mapping) and key not in ("source", "sources"):
            yield title, value
            yield from _sections(value, title)
        elif isinstance(value, list) and value and isinstance(value[0], Mapping):
            for number_, item in enumerate(value, 1):
                yield f"{title} {number_}", item
                yield from _sections(item, f"{title} {number_}")


def _input_table(title: str, section: Record) -> InputTable:
    by_key = section.get("sources", {})
    rows = tuple(
        (words(key), _value(value), str(source_in(by_key.get(key))))
        for key, value in section.items()
        if key not in ("source", "sources") and not _is_section(value)
    )
    return InputTable(title, rows, str(source_in(section.get("source"))))


def _is_section(value: Json) -> bool:
    return isinstance(value, Mapping) or (
        isinstance(value, list) and bool(value) and isinstance(value[0], Mapping)
    )


def _value(value: Json | dt.date) -> str:
    """Value of a case as text; computed numbers with units are cut to twelve digits."""
    if isinstance(value, dt.date):
        return value.isoformat()
    if isinstance(value, str):
        return re.sub(r"^-?\d+\.\d{12,}(?=\s)", lambda n: f"{float(n.group()):.12g}", value)
    if value is None or isinstance(value, (int, float)):
        return number(value, 12)
    return ", ".join(_value(item) for item in value) or DASH
