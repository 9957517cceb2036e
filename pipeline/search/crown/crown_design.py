"""Crown of cam or follower for a case: loads and tilts of its cycle, cost, sensitivity."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.figures import (
    SERIES,
    Curve,
    DrawnAxes,
    Figure,
    LimitLine,
    Look,
    Panel,
    over,
    plotted,
)
from camwright.pipeline.base import units
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.tables import Column, table
from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import enter
from camwright.pipeline.case.case_writer import added_text, tables_text
from camwright.pipeline.case.limits import END_MEAN_LENGTH
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.case.toml_text import Tables
from camwright.pipeline.contact.axial_shape import AxialCrown
from camwright.pipeline.contact.finite_length.axial_drop import (
    CircularCrown,
    Crown,
    FinitePair,
    Straight,
    SummedCrown,
    TabulatedCrown,
)
from camwright.pipeline.cycle.cycle import Cycle, turn_of_line
from camwright.pipeline.cycle.length_history import ContactLoads
from camwright.pipeline.preview import preview_case
from camwright.pipeline.records.crown_document import CrownKind, CrownLife
from camwright.pipeline.search.crown.least_crown import (
    KINDS,
    AxialFactor,
    ContactStates,
    CrownProblem,
    LeastCrown,
    families,
    least_crown,
    middle_crown,
)
from camwright.pipeline.search.crown.solved_lines import SignedRange, SolvedLines, signed_range

if TYPE_CHECKING:
    import pandas as pd

RATIO, TOLERANCE = 1.1, 2e-6
"""Greatest signed pressure over plane strain; deviation of the drop at the ends, m."""
DROP_TABLE, CASE_TEXT = "crown_drop.csv", "crown.toml"
_MIDDLE = "Crown within the ratio"
# Factors of the greatest moment; rows of the drop table.
_TILTS, _ROWS = (0.0, 0.5, 1.0, 1.5, 2.0), 21


@dataclass(frozen=True, eq=False)
class AxialLine:
    """Axial pressure over plane strain along the centre line at y (m,), m."""

    y: Array
    factor: Array

    def __post_init__(self) -> None:
        freeze(self, y=self.y, factor=self.factor)

    @property
    def centre(self) -> float:
        """Factor at y = 0."""
        return float(np.interp(0.0, self.y, self.factor))


@dataclass(frozen=True, eq=False, repr=False)
class CrownDesign(Displayed):
    """Crown of one body, in the middle of those within the pressure ratio.

    Parameters
    ----------
    case : Case
    on : str               table of the crowned body: cam, roller or follower.face
    kind : str
    limit : float          ratio to be kept
    tolerance : float      of the drop at the ends, m
    machine : Machine      of the first load case
    load_cases : tuple     names by the number in the states
    theta : array (n,)     cam angles of the states, rad
    chosen : LeastCrown    in the middle of those within the ratio
    tilts : tuple          factor of the moments, greatest ratio
    deviations : tuple     deviation of the drop at the ends, m, greatest ratio
    """

    case: Case
    on: str
    kind: CrownKind
    limit: float
    tolerance: float
    machine: Machine
    load_cases: tuple[str, ...]
    theta: Array
    chosen: LeastCrown
    tilts: tuple[tuple[float, float], ...]
    deviations: tuple[tuple[float, float], ...]

    @property
    def facts(self) -> Mapping[str, object]:
        """Case, crown and ratios."""
        return {
            "case": self.case.name,
            "on": self.on,
            "kind": self.kind,
            "drop": shown(self.chosen.drop, "um"),
            "ratio": self.chosen.ratio,
            "straight": float(self.chosen.straight.max()),
        }

    @property
    def governing(self) -> int:
        """Row of the greatest ratio with the crown."""
        return int(self.chosen.ratios.argmax())

    @property
    def moment(self) -> float:
        """Greatest moment at the governing row with the crown, N m."""
        solved = self._solved(self.chosen.crown, self.governing)
        return max(float(each.moment[0]) for each in solved)

    def line(self, crown: Crown, row: int, *, tilted: bool) -> AxialLine:
        """Axial pressure over that of plane strain along the line of contact in one load state, by
        half-spaces; of a contact with two ends solved apart, that of the end with the greater
        pressure.

        Parameters
        ----------
        crown : Crown   of the crowned body
        row : int       index of the state in `problem.states`
        tilted : bool   under the greatest moment of the state; else aligned
        """
        states, lines = self.chosen.problem.states, []
        loads = states.curvature[[row]], states.force[[row]]
        for pair, solved in zip(
            self.chosen.problem.pairs(crown), self._solved(crown, row), strict=True
        ):
            moment = solved.moment if tilted else 0.0
            edges, line = SolvedLines(pair, self._mean_length).axial_pressure(*loads, moment)
            lines.append(AxialLine(0.5 * (edges[0, 1:] + edges[0, :-1]), line[0]))
        return max(lines, key=lambda each: float(each.factor.max()))

    @property
    def _mean_length(self) -> float:
        return self.machine.limits[END_MEAN_LENGTH]

    def _solved(self, crown: Crown, row: int) -> list[SignedRange]:
        problem = self.chosen.problem
        loads = problem.states.loads(np.array([row]), problem.compliance)
        return [
            signed_range(SolvedLines(pair, self._mean_length), loads)
            for pair in problem.pairs(crown)
        ]

    @cached_property
    def centres(self) -> tuple[float, float]:
        """Pressure at mid-length over that of plane strain, without and with the crown, both bodies
        aligned, at the load of the greatest p0.
        """
        worst = self.chosen.problem.states.worst
        straight, crowned = (
            self.line(crown, worst, tilted=False).centre
            for crown in (Straight(), self.chosen.crown)
        )
        return straight, crowned

    @property
    def lives(self) -> list[CrownLife]:
        """Life of each body, without and with the crown, as a share of its life under plane-strain
        pressure: the greatest pressure ratio to the power -2 k, k being the slope of the endurance
        line of the material. Bodies without a line are left out.
        """
        straight, crowned = float(self.chosen.straight.max()), self.chosen.ratio
        costs: list[CrownLife] = []
        for body, card in self.machine.bodies.items():
            slope = card.endurance(sliding=self.machine.follower.slides).slope
            if slope is not None:
                power = 2.0 * slope
                costs.append(
                    {
                        "body": body,
                        "material": card.name,
                        "pressure_exponent": power,
                        "straight": straight**-power,
                        "crowned": crowned**-power,
                    }
                )
        return costs

    @property
    def shape(self) -> AxialCrown | None:
        """Crown as stated in the case; None: straight."""
        crown = self.chosen.crown
        if isinstance(crown, Straight):
            return None
        if isinstance(crown, CircularCrown):
            return AxialCrown(kind="circular", radius=crown.radius)
        if isinstance(crown, TabulatedCrown):
            return AxialCrown(kind="table", file=DROP_TABLE)
        return AxialCrown(kind=self.kind, line_load=self.chosen.load)

    @property
    def text(self) -> str:
        """Crown as TOML text for the case file: a table `[[added]]` to be pasted, or the table that
        replaces the crown stated; a comment where no crown is needed.
        """
        shape = self.shape
        if shape is None:
            return f"# No crown is needed: the straight contact keeps the ratio {self.limit:g}.\n"
        key = f"{self.on}.crown"
        entries: dict[str, str] = {"kind": shape.kind}
        for name, unit in (("radius", "mm"), ("line_load", "N/mm")):
            if getattr(shape, name) is not None:
                entries[name] = units.format(getattr(shape, name), unit)
        if shape.file is not None:
            entries["file"] = shape.file
        entries["source"] = f"sized: pressure at most {self.limit:g} times that of plane strain"
        tables: Tables = {}
        enter(tables, key, dict(entries))
        if self._stated is None:
            head = f"# {_MIDDLE}. Paste the block at the end of the case file.\n"
            return head + added_text(tables)
        return f"# {_MIDDLE}. It replaces [{key}] of the case file.\n" + tables_text(tables)

    @property
    def _stated(self) -> AxialCrown | None:
        part = self.machine.cam if self.on == "cam" else self.machine.follower
        return part.crown

    @property
    def heaviest(self) -> Crown | None:
        """Crown of greatest drop in the family within the ratio; None beyond those tried."""
        load = self.chosen.heaviest
        return self.chosen.family.crown(load) if np.isfinite(load) else None

    def columns(self) -> dict[Column, Array]:
        """Columns of the drop table of the workshop, SI: y from the middle, m; drop of the crown,
        m, of the least crown within the ratio and, if known, of the greatest one.
        """
        crown = self.chosen.crown
        family = self.chosen.family
        y = np.append(0.5 * family.length * np.linspace(0.0, 1.0, _ROWS)[:-1], family.gauge)
        if isinstance(crown, TabulatedCrown):
            y = crown.y
        lightest = family.crown(self.chosen.lightest)
        columns = {
            Column("y", "mm"): y,
            Column("drop", "um"): crown.drop(y),
            Column("drop_min", "um"): lightest.drop(y),
        }
        if self.heaviest is not None:
            columns[Column("drop_max", "um")] = self.heaviest.drop(y)
        return columns

    @property
    def drop_table(self) -> str:
        """Drop table of the workshop as CSV."""
        columns = table(self.columns()).numbers
        rows = zip(*columns.values(), strict=True)
        lines = [",".join(f"{value:.6f}" for value in row) for row in rows]
        return "\n".join([",".join(columns), *lines]) + "\n"

    def to_pandas(self) -> pd.DataFrame:
        """The drop table; see `Table.to_pandas`."""
        return table(self.columns()).to_pandas()

    @cached_property
    def lines(self) -> tuple[tuple[Literal["straight", "crowned"], bool, AxialLine], ...]:
        """Pressure at the governing state without and with the crown, each aligned and tilted."""
        shapes: dict[Literal["straight", "crowned"], Crown] = {
            "straight": Straight(),
            "crowned": self.chosen.crown,
        }
        return tuple(
            (name, tilted, self.line(shape, self.governing, tilted=tilted))
            for name, shape in shapes.items()
            for tilted in (False, True)
        )

    @property
    def figure(self) -> Figure:
        """Axial pressure at the governing angle, and drop over y."""
        lines = tuple(
            Curve(
                1e3 * line.y, line.factor, f"{name}, {'tilted' if tilted else 'aligned'}",
                SERIES[name == "straight"], "line" if tilted else "dashed",
            )
            for name, tilted, line in self.lines
        )  # fmt: skip
        greatest = max(self.limit, self.chosen.ratio, float(self.chosen.straight.max()))
        case = self.load_cases[int(self.chosen.problem.states.load_case[self.governing])]
        angle = in_unit(float(self.theta[self.governing]), "deg")
        rows, drops = table(self.columns()), list[Curve]()
        looks: dict[str, tuple[str, Look]] = {
            "drop_um": ("middle", "line"), "drop_min_um": ("least", "dotted"),
            "drop_max_um": ("heaviest", "dashed"),
        }  # fmt: skip
        y = np.concatenate([-rows["y_mm"][::-1], rows["y_mm"]])
        for header, (label, look) in looks.items():
            if header in rows:
                drop = np.concatenate([rows[header][::-1], rows[header]])
                drops.append(Curve(y, drop, label, look=look))
        deepest = max(float(curve.y.max()) for curve in drops)
        panels = (
            Panel(
                "pressure over plane strain", "", lines, (LimitLine(self.limit, "limit"),),
                span=(0.0, 1.1 * greatest), height=1.3,
                title=f"{case}, cam angle {angle:.4g} deg",
            ),
            Panel("drop", "um", tuple(drops), span=(1.05 * deepest, -0.05 * deepest)),
        )  # fmt: skip
        return over("crown", "Crown", "", "y", "mm", panels, dots=False)

    def plot(self) -> DrawnAxes:
        """Axial pressure at the governing angle, and drop over y."""
        return plotted(self.figure)


def crown(
    case: Case,
    ratio: float = RATIO,
    *,
    on: str | None = None,
    kind: str = "johns_gohar",
    tolerance: float = TOLERANCE,
    progress: Progress = SILENT,
) -> CrownDesign:
    """Crown of one body with which the axial pressure stays within a ratio, in the middle of the
    range of such crowns.

    The ratio is the signed axial pressure over the greatest of plane strain in the same load case,
    at every angle, load case and both ends of the range of tilt of its preview. A crown that the
    body has is replaced, that of the other body stays.

    Parameters
    ----------
    case : Case           with the ends of both bodies
    ratio : float         greatest ratio, > 0
    on : str              body that is crowned: cam, roller or face; None: the follower
    kind : str            johns_gohar, lundberg, circular or table, a relief of the ends
    tolerance : float     of the drop at the ends, m, >= 0, for the sensitivity
    progress : Progress   told each stage

    Raises
    ------
    InputError
        If the case lacks an end, or no crown keeps the ratio, naming the least that one reaches.
    """
    chosen = _kind(kind)
    _require(case, ratio, on, tolerance)
    progress.stage("preview")
    cycles = preview_case(case, corners=False, progress=progress).cycles
    machine = cycles[0].machine
    straight = _crowned(machine, on, Straight())
    progress.stage("crown")
    states, theta = _states(cycles)
    length, pair = machine.contact_width, straight[0]
    reach = 0.5 * max(body.length for each in straight for body in each.bodies)
    problem = CrownProblem(
        pairs=lambda shape: _crowned(machine, on, shape),
        states=states,
        families=families(chosen, length, pair.curvature, pair.contact_modulus, reach),
        factor=_factor_of(machine.limits[END_MEAN_LENGTH]),
        compliance=float(np.min(turn_of_line(cycles[0]).tilt_compliance)),
    )
    middle = middle_crown(least_crown(problem, ratio), ratio)
    return CrownDesign(
        case=case,
        on="cam" if on == "cam" else machine.follower.table,
        kind=chosen,
        limit=ratio,
        tolerance=tolerance,
        machine=machine,
        load_cases=tuple(each.load_case for each in cycles),
        theta=theta,
        chosen=middle,
        tilts=tuple((factor, middle.at_tilt(factor)) for factor in _TILTS),
        deviations=tuple(
            (step, middle.at_deviation(step)) for step in (-tolerance, 0.0, tolerance)
        ),
    )


def _kind(text: str) -> CrownKind:
    """The text as a kind of crown; InputError if it is not one."""
    for kind in KINDS:
        if kind == text:
            return kind
    raise InputError("kind", text, f"one of: {', '.join(KINDS)}")


def _require(case: Case, ratio: float, on: str | None, tolerance: float) -> None:
    """InputError unless ratio, crowned body and tolerance, m, are in bounds and the case describes
    the ends of both bodies.
    """
    if not 0 < ratio < np.inf:
        raise InputError("ratio", ratio, "> 0")
    if on not in (None, "cam", case.facing.word):
        raise InputError("on", on, f"cam or {case.facing.word}")
    if not 0 <= tolerance < np.inf:
        raise InputError("tolerance", shown(tolerance, "um"), ">= 0 um")
    for name, part in (("cam", case.cam), (case.facing.table, case.facing)):
        if part.end is None:
            limit = "specified: the crown joins the ends of both bodies"
            raise InputError(f"{name}.end", "missing", limit)


def _crowned(machine: Machine, on: str | None, shape: Crown) -> tuple[FinitePair, ...]:
    """Contacts of cam and follower, one or one for each end, with a crown on one body in place of
    what it has.

    Parameters
    ----------
    machine : Machine   with both bodies
    on : str or None    "cam": the cam is crowned; else the follower
    shape : Crown       centred on the crowned body
    """
    offset = machine.follower.axial_offset or 0.0
    middle = np.copysign(machine.stem_offset, offset)
    if on == "cam":
        bare = replace(machine, cam=replace(machine.cam, crown=None))
        middle -= offset
    else:
        bare = replace(machine, follower=replace(machine.follower, crown=None))
    pairs = bare.finite_pairs
    sides = (-1, 1) if len(pairs) > 1 else (1,)
    if isinstance(shape, Straight):
        return pairs
    return tuple(
        replace(pair, crown=SummedCrown(((pair.crown, 0.0), (shape, float(middle))), side))
        for pair, side in zip(pairs, sides, strict=True)
    )


def _states(cycles: Sequence[Cycle]) -> tuple[ContactStates, Array]:
    """Load states of the contact that may have the greatest pressure, of all load cases and on each
    track that is pressed, and their cam angles, rad.

    Parameters
    ----------
    cycles : sequence   solved turn of each load case, whose index is the number of the load case
    """
    columns: list[Array] = []
    both = [(k, each) for k, one in enumerate(cycles) for each in (one, one.on_other_track)]
    for number, cycle in both:
        if cycle is None:
            continue
        turn = turn_of_line(cycle)
        contact, rows = turn.contact, turn.rows
        values = (
            *(1.0 / contact.relative_radius, turn.force, turn.couple),
            *(turn.tilt.greatest, turn.tilt.forced, contact.p0, cycle.theta),
        )
        number_of = np.full(rows.size, number)
        columns.append(np.stack([*(each[rows] for each in values), number_of]))
    curvature, force, couple, tilt, forced, p0, theta, number_of = np.concatenate(columns, axis=1)
    numbers = number_of.astype(np.intp)
    states = ContactStates(curvature, force, couple, tilt, forced, p0, numbers)
    kept = states.governing
    return states.at(kept), theta[kept]


def _factor_of(mean_length: float) -> AxialFactor:
    """Signed factor by contacts solved one by one; mean_length, m, at a corner."""

    def factor(pair: FinitePair, loads: ContactLoads) -> Array:
        return signed_range(SolvedLines(pair, mean_length), loads).factor

    return factor
