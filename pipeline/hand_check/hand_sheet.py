"""Hand-check sheet: a check of a finished run evaluated again from its formula text.

The symbols of the formula are those of the declaration: keys of the case, columns of the cycle,
figures of the drawn cam, all from the run folder. What a solver or a reduction over the turn gave
enters as a number that the check states beside its demand.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from camwright.geometry.arrays import Array, Value
from camwright.geometry.errors import InputError, ResultError
from camwright.geometry.follower_path import Motion
from camwright.geometry.second_track import CamDisc, discs_of
from camwright.pipeline.base import formula, units
from camwright.pipeline.base.quantities import Count, In
from camwright.pipeline.case.case_values import quantity_of, text_of, value_of
from camwright.pipeline.case.machine import Machine, machines
from camwright.pipeline.checks.check import BOUNDLESS, STATED, Declaration
from camwright.pipeline.checks.extremes import BY_DUTY
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.cycle.loaded_cam import round_of
from camwright.pipeline.cycle.numbers import Numbers, fitted_ring, greatest_interference
from camwright.pipeline.cycle.solved_cam import ContourCam, in_load_case, numbers_of_discs
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.results.check_records import RecordedCheck
from camwright.pipeline.results.check_report import place
from camwright.pipeline.results.drawn_cam import drawn_cam
from camwright.pipeline.results.run_reader import Run, read_run

DIGITS = (6, 9, 12)
"""Digits of the numbers of a sheet, the fewest with which they give its result, see `AS_SHOWN`."""
AS_SHOWN = 1e-3
"""Relative difference up to which the numbers as shown give a demand: differences cancel digits."""
ROUNDING, BETWEEN = 1e-7, 1e-3
"""Relative difference up to which two evaluations agree, and that of a demand, or of its limit,
which the check interpolates between the solved angles and the sheet evaluates there."""
_LEAST_SHARE = 1e-6
"""Share of the limit, without one of 0.001 in the unit of the record, that is no difference."""
SAME_ANGLE = 1e-6  # deg, of a demand and a row of the cycle
_UNITS = (
    "MPa m/s", "rad/s", "rad/s^2", "m/s", "N/mm", "N m", "mm/rad^2", "mm/rad", "MPa", "mm", "um",
    "deg", "N", "N mm", "W", "rpm", "percent",
)  # fmt: skip
"""Units of the columns of a cycle and of the figures of a cam."""

_Figure = Callable[[ContourCam], Value]
FIGURES: Mapping[str, tuple[str, _Figure]] = {
    "lift": ("mm", lambda cam: cam.jet.lift),
    "lift_slope": ("mm/rad", lambda cam: cam.jet.slope),
    "lift_d2": ("mm/rad^2", lambda cam: cam.jet.lift_d2),
    "lift_highest": ("mm", lambda cam: cam.highest),
    "pitch_height": ("mm", lambda cam: cam.contour.require_roller().pitch.height_base),
    "surface_radius": ("mm", lambda cam: round_of(cam.motion).size),
    "pitch_curvature": ("1/mm", lambda cam: round_of(cam.motion).path_curvature),
    "pitch_curvature_slope": ("1/mm", lambda cam: round_of(cam.motion).path_curvature_slope),
    "pitch_speed": ("mm/rad", lambda cam: round_of(cam.motion).path_speed),
    "contour_speed": ("mm/rad", lambda cam: cam.motion.contour_speed),
    "contour_radius": ("mm", lambda cam: cam.motion.contour_radius),
    "contour_radius_greatest": ("mm", lambda cam: cam.contour.radius_max().value),
    "closing_force": ("N", lambda cam: cam.closing),
    "least_spring_force": ("N", lambda cam: cam.least_spring),
    "spring_preload": ("N", lambda cam: cam.spring_preload),
    "spring_stiffness": ("N/mm", lambda cam: cam.spring_rate),
    "spring_lever": ("", lambda cam: cam.spring_lever),
    "spring_travel_highest": ("mm", lambda cam: cam.travel_of_spring(cam.highest)),
}
"""Figures of the cam drawn and its spring at the cam angle of a demand, with their unit."""
_CYCLE, _CHECKS = "5_cycle.csv", "6_checks.json"
_DEFINED = "["
"""Begins the unit of a symbol that the formula itself defines."""
_CLOSED_FORM = {
    "p0_fe": ("p0_conforming", "p0_hertz"),
    "half_width_fe": ("half_width_conforming", "half_width_hertz"),
}
"""Columns in place of one that a run without finite elements leaves empty: the first it has."""
_FOR_OTHERS = {"stem_force": "axial_force"}
"""Column in place of one that a run has of some closures alone."""
_ABSENT = ("spring_surge_force",)
"""Columns of a part that a run lacks: their values are zero."""
ONLY = "?"
"""Symbol of the keys and words for which a formula holds, such as ``follower.kind roller``."""


@dataclass(frozen=True)
class Quantity:
    """Symbol of a formula with its value and unit.

    Parameters
    ----------
    symbol : str
    value : float   SI
    shown : str     value in the unit of the case or of the column
    source : str    key, table with load case and cam angle, or the cam as drawn; expression
    recorded : bool   one column of the cycle, as solved
    """

    symbol: str
    value: float
    shown: str
    source: str
    recorded: bool


class SheetStep(NamedTuple):
    """Step of a sheet: symbol, or "" for the demand, with its expression and value in words."""

    name: str
    expression: formula.Node
    shown: str


class SheetBound(NamedTuple):
    """Limit evaluated from its formula: expression, and value in the unit of the record."""

    expression: formula.Node
    value: float


@dataclass(frozen=True)
class Sheet:
    """Hand calculation of a check: formula, symbols, steps, result.

    Parameters
    ----------
    record : mapping       of `6_checks.json`
    text : str             formula of the declaration
    limit : str            limit as the formula has it; "": it is not evaluated
    quantities : tuple     symbols with their values, of the formula and of its definitions
    steps : tuple          definitions, and last the demand; empty: not evaluated
    result : float         demand by the formula, in the unit of the record; None: the demand is a
                           result of a solver, or its formula is none of numbers: it is stated
    bound : SheetBound     limit by the formula; None: its symbols are not all keys of the case
    reason : str           why there are no steps, in words
    """

    record: CheckRecord
    text: str
    limit: str = ""
    quantities: tuple[Quantity, ...] = ()
    steps: tuple[SheetStep, ...] = ()
    result: float | None = None
    bound: SheetBound | None = None
    reason: str = ""

    @property
    def is_stated(self) -> bool:
        """Whether the demand is a number of a solver, or not evaluated."""
        recorded = {each.symbol for each in self.quantities if each.recorded}
        return not self.steps or self.steps[-1].expression.text in recorded

    @property
    def use(self) -> tuple[float, float] | None:
        """Numerator and denominator of the utilisation of the check, in the unit of the record:
        demand over limit, or limit over demand where it must be at least the limit.

        Of the worse of the demand and that at its tolerance corner. None where the record has no
        utilisation, or the denominator is not positive.
        """
        demand, limit, corner = (self.record[key] for key in ("demand", "limit", "corner_demand"))
        if demand is None or limit is None or self.record["utilisation"] is None:
            return None
        at_most = self.record["sense"] == "at_most"
        both = (demand, demand if corner is None else corner)
        parts = (max(both), limit) if at_most else (limit, min(both))
        return parts if parts[1] > 0.0 else None

    @property
    def agrees(self) -> bool:
        """Whether demand, limit and utilisation of formula and record are equal to rounding."""
        return not self.differs_in

    @property
    def differs_in(self) -> str:
        """Which of "demand", "limit" and "use", the utilisation, evaluated on the sheet differs
        first from the record; "" where all agree.
        """
        limit, stated, use = self.record["limit"], self.record["utilisation"], self.use
        if not self._gives_the_demand:
            return "demand"
        if self.bound is not None and limit is not None and not _same(self.bound.value, limit):
            return "limit"
        differs = use is not None and stated is not None and not _same(use[0] / use[1], stated)
        return "use" if differs else ""

    @property
    def _gives_the_demand(self) -> bool:
        """Whether the formula gives the demand of the record: to rounding, or less closely where
        the demand is of the forces between two solved angles. True where the demand is not
        evaluated.
        """
        demand = self.record["demand"]
        if self.result is None or demand is None:
            return self.result is None
        measured = DECLARED[self.record["id"]].measured
        between = measured is not None and measured.reduce == "forces"
        if between:
            return self.gives(demand, BETWEEN, BETWEEN)
        return self.gives(demand, ROUNDING)

    def gives(self, demand: float, share: float, of_limit: float = _LEAST_SHARE) -> bool:
        """Whether the formula reproduces a demand within a share of it, or of the limit."""
        least = of_limit * abs(self.record["limit"] or 1e-3)
        return self.result is not None and _same(self.result, demand, share, least)

    @property
    def known(self) -> Mapping[str, str]:
        """Value of each symbol as printed in a formula."""
        defined = {step.name: step.shown for step in self.steps[:-1]}
        return {each.symbol: each.shown for each in self.quantities} | defined


def _same(one: float, other: float, share: float = ROUNDING, least: float = 0.0) -> bool:
    return math.isclose(one, other, rel_tol=share, abs_tol=least)


class SheetRun:
    """Finished run whose checks are evaluated again.

    Raises
    ------
    ResultError
        If the run is unreadable.
    """

    def __init__(self, folder: Path, run: Run | None = None) -> None:
        self.run = read_run(folder) if run is None else run
        self.case, self.contour = drawn_cam(folder)

    @cached_property
    def machines(self) -> Mapping[str, Machine]:
        """Machine by load case, the design load case first."""
        return {each.load_case: each for each in machines(self.case)}

    @cached_property
    def records(self) -> Mapping[str, CheckRecord]:
        """Records of the final trial by the id of their check."""
        return {each["id"]: each for each in self.run.final.checks}

    def sheet(self, name: str) -> Sheet:
        """Hand-check sheet of a check of the final trial, by its id; without evaluation where the
        formula does not apply or a number is missing in the case.

        Raises
        ------
        InputError
            If the run has no such check.
        ResultError
            If the run lacks a number of its formula.
        """
        if name not in self.records:
            known = ", ".join(sorted(self.records))
            raise InputError("--check", name, f"a check of the run: {known}")
        record, declared = self.records[name], DECLARED.get(name)
        if declared is None:
            return Sheet(record, "", reason="a check of another version")
        evaluation = _Evaluation(self, record, declared)
        if reason := self._without(record, declared) or evaluation.lacks:
            return Sheet(record, declared.formula, reason=reason)
        return evaluation.sheet()

    def governing(self, most: int = 12) -> tuple[str, ...]:
        """Ids of the required checks of the design with the greatest utilisations."""
        required = [
            each
            for each in self.records.values()
            if each["must_have"] and not each["evidence"] and each["demand"] is not None
        ]
        ranked = sorted(required, key=lambda each: -(RecordedCheck(each).utilisation or 0.0))
        return tuple(each["id"] for each in ranked[:most])

    def _without(self, record: CheckRecord, declared: Declaration) -> str:
        """Why the formula of a check does not apply to the case as it stands, in words; "" where it
        does: load cases have duties that the formula would have to sum, or a part is of another
        kind than it is stated for.
        """
        if record["demand"] is None:
            return "the demand is not known"
        if not declared.symbols:
            return "a rule in words"
        by_duty = declared.measured is not None and declared.measured.reduce in BY_DUTY
        if by_duty and any(each.duty is not None for each in self.machines.values()):
            return "the load cases are summed by their duty"
        for each in filter(None, declared.symbols.get(ONLY, "").split("; ")):
            key, word = each.split(" ")
            if str(value := value_of(self.case, key)) != word:
                here = value if isinstance(value, str) else "none" if value is None else "stated"
                only = "none" if word == "None" else word
                return f"the formula holds for {key} = {only}, which is {here} here"
        return ""


@dataclass(frozen=True, eq=False, kw_only=True)
class _OnTrack(ContourCam):
    """Cam with the motion of the roller or face that carries."""

    track: Motion

    @property
    def motion(self) -> Motion:
        return self.track


@dataclass(frozen=True)
class _Evaluation:
    """Evaluation of the formula of a check at the load case and cam angle of its demand."""

    run: SheetRun
    record: CheckRecord
    declared: Declaration
    quantities: dict[str, Quantity] = field(default_factory=dict)
    steps: dict[str, SheetStep] = field(default_factory=dict)
    values: dict[str, Value] = field(default_factory=dict)
    digits: int = DIGITS[0]

    @property
    def lacks(self) -> str:
        """Which keys of the symbols the case leaves out, and which stated numbers the record, in
        words; "" where none.
        """
        used = {name for tree in self.trees.values() for name in formula.names(tree)}
        places = {name: each.partition(" [")[0] for name, each in self.declared.symbols.items()
                  if name in used and not each.startswith(_DEFINED)}  # fmt: skip
        missing = [name for name, text in places.items() if self._lacks(text, name)]
        return f"this run has no number of {', '.join(missing)}" if missing else ""

    def _lacks(self, text: str, name: str) -> bool:
        """Whether the value of a symbol of the formula is missing: a key of the case without a
        value, or a number that the check did not state.

        Parameters
        ----------
        text : str   where the symbol has its value, as declared
        name : str   the symbol
        """
        if text == STATED or name in self._stated:
            return name not in self._stated
        keys = {each for each in formula.names(formula.parsed(text)) if "." in each}
        return any(self._numbers.get(key) is None for key in keys)

    def sheet(self) -> Sheet:
        """Sheet of the check with as many digits of the numbers as a calculation by hand needs to
        give the demand.
        """
        for digits in DIGITS:
            evaluation = _Evaluation(self.run, self.record, self.declared, digits=digits)
            made, shown = evaluation._with_digits(), evaluation._as_shown("")
            by_hand = units.in_unit(float(np.asarray(shown).item()), self.record["unit"])
            if made.gives(by_hand, AS_SHOWN):
                break
        return made

    def _as_shown(self, name: str) -> Value:
        """Value, SI, of a definition of the formula, or with the name "" of the demand, calculated
        from the numbers rounded as the sheet shows them.
        """

        def rounded(symbol: str) -> Value:
            if symbol in self.trees:
                return self._as_shown(symbol)
            return float(f"{self.quantities[symbol].value:.{self.digits}g}")

        return formula.value(self.trees[name], rounded)

    def _with_digits(self) -> Sheet:
        """Sheet of the check, evaluated with its numbers rounded to `digits`."""
        unit = self.record["unit"]
        demand = float(np.asarray(self._defined("")).item())
        last = self.steps.pop("")._replace(shown=units.shown(demand, unit, DIGITS[0]))
        bound = self._bound()
        return Sheet(
            self.record, self.declared.formula, self.said.limit, tuple(self.quantities.values()),
            (*self.steps.values(), last), units.in_unit(demand, unit), bound,
        )  # fmt: skip

    def _bound(self) -> SheetBound | None:
        """Limit of the check evaluated from its formula; None where it is in words, in degC, or a
        symbol has no number in the case.
        """
        try:
            tree = formula.parsed(self.said.limit, {**self.declared.symbols, **self.said.keys})
        except InputError:  # words
            return None
        if self.record["unit"] == "degC" or not all(map(self._is_known, formula.names(tree))):
            return None
        value = float(np.asarray(formula.value(tree, self._of_limit)).item())
        return SheetBound(tree, units.in_unit(value, self.record["unit"]))

    def _key(self, name: str) -> str:
        """Key of a symbol of the limit by the text of the formula; "": none."""
        return name if "." in name else self.said.keys.get(name, "")

    def _is_known(self, name: str) -> bool:
        """Whether a symbol of the limit, `name`, has a number in the case."""
        if name in formula.CONSTANTS:
            return True
        if name in self.trees:
            return all(map(self._is_known, formula.names(self.trees[name])))
        if name in self.declared.symbols:
            return not self._lacks(self.declared.symbols[name].partition(" [")[0], name)
        return bool(key := self._key(name)) and self._numbers.get(key) is not None

    def _of_limit(self, name: str) -> Value:
        """Value, SI, of the symbol `name` of the limit; it is added to the symbols of the sheet,
        unless it is the limit itself.
        """
        if name in self.trees or name in self.declared.symbols:
            return self._symbol(name)
        key = self._key(name)
        value = float(self._number(key))
        if key == self.said.limit:  # the limit says all
            return value
        self.quantities[name] = Quantity(name, value, self._shown(key, value), key, False)
        return value

    @cached_property
    def said(self) -> formula.Statement:
        """The formula text, read."""
        return formula.stated(self.declared.formula)

    @cached_property
    def trees(self) -> Mapping[str, formula.Node]:
        """Expressions of the definitions by their name, and of the demand by ""."""
        said, symbols = self.said, self.declared.symbols
        own = {
            name: text
            for name, text in said.defined.items()
            if symbols.get(name, _DEFINED).startswith(_DEFINED)
        }
        return {
            name: formula.parsed(text, symbols) for name, text in ({"": said.demand} | own).items()
        }

    def _defined(self, name: str) -> Value:
        """Value, SI, of a definition of the formula by its name, calculated once and added to the
        steps of the sheet.
        """
        if name not in self.values:
            tree = self.trees[name]
            value = formula.value(tree, self._symbol)
            self.values[name] = value
            unit = self.declared.symbols.get(name, "").strip("[]")
            self.steps[name] = SheetStep(name, tree, units.shown(float(value), unit, self.digits))
        return self.values[name]

    def _symbol(self, name: str) -> Value:
        """Value, SI, of a symbol of the formula by its name; it is added to the symbols of the
        sheet with its source.
        """
        if name in self.trees:
            return self._defined(name)
        text, _, unit = self.declared.symbols.get(name, name).partition(" [")
        if text == STATED or name in self._stated:  # in place of a column of the other track
            return self._as_stated(name, unit.rstrip("]"))
        tree = formula.parsed(text)
        value = float(formula.value(tree, self._number, partial(self._number, turn=True)))
        sources = [each for each in formula.names(tree) if each not in formula.CONSTANTS]
        plain = tree.kind == "name"
        where = "; ".join(dict.fromkeys(map(self._where, sources)))
        shown = (
            self._shown(text, value)
            if plain and not unit
            else units.shown(value, unit.rstrip("]"), self.digits)
        )
        bare = plain and "." in text  # the key says all
        source = where if bare else f"{where}: {text}" if where else "constant"
        recorded = plain and "." not in text and text not in FIGURES
        self.quantities[name] = Quantity(name, value, shown, source, recorded)
        return value

    def _as_stated(self, name: str, unit: str) -> Value:
        """Value, SI, of a number that the check states itself, such as a result of a solver; it is
        added to the symbols of the sheet.

        Parameters
        ----------
        name : str   the symbol
        unit : str   of the number in the record
        """
        value = units.from_unit(self._stated[name], unit)
        at = place(self.record)
        source = f"{_CHECKS}, {at}" if at else _CHECKS
        source = f"stated, {source}"
        shown = "infinite" if value >= BOUNDLESS else units.shown(value, unit, self.digits)
        self.quantities[name] = Quantity(name, value, shown, source, True)
        return value

    @property
    def _stated(self) -> Mapping[str, float]:
        """Numbers that the check states, in the units of its symbols."""
        return self.record.get("stated", {})

    def _number(self, name: str, *, turn: bool = False) -> Value:
        """Value, SI, of a key of the case, a figure of the cam or a column of the cycle.

        Parameters
        ----------
        name : str    dotted key, name of the figure, or of the column without its unit
        turn : bool   of a column: at all cam angles (n,), not at that of the demand alone

        Raises
        ------
        ResultError
            If the case or the cycle lacks it.
        """
        if "." in name:
            value = self._numbers.get(name)
            if value is None:
                raise ResultError(f"{name}: missing in case.toml")
            return value
        if name in FIGURES:
            return float(np.ravel(FIGURES[name][1](self._cam))[0])
        unit, column = self._column(name)
        scale = units.factor(unit) if unit else 1.0
        return scale * (column if turn else float(column[self._row]))

    def _shown(self, name: str, value: float) -> str:
        """Value as text: as the case states it, else with the unit of its key, column or figure.

        Parameters
        ----------
        name : str      dotted key, figure or column
        value : float   SI
        """
        if "." not in name:
            unit = FIGURES[name][0] if name in FIGURES else self._column(name)[0]
            return units.shown(value, unit, self.digits)
        quantity = _quantity_of(name)
        if quantity is not None and value_of(self.run.case, name) == value:
            return text_of(self.run.case, name, self.digits)
        return units.shown(value, quantity.unit if isinstance(quantity, In) else "", self.digits)

    def _where(self, name: str) -> str:
        """Source of a value, in words: the key itself, the table with load case and angle, or the
        cam as drawn.
        """
        if "." in name:
            return f"{name}, of the second disc" if name in self._of_disc else name
        file = "cam as drawn" if name in FIGURES else _CYCLE
        at = place(self.record)
        return f"{file}, {at}" if at else file

    @cached_property
    def _machine(self) -> Machine:
        every = self.run.machines
        return every.get(self.record["load_case"], next(iter(every.values())))

    @cached_property
    def _numbers(self) -> Numbers:
        """Numbers of the case by key, SI, in the load case of the demand, with four that only
        formulas of checks need.
        """
        shared = self._shared
        ring, interference = fitted_ring(shared), greatest_interference(shared)
        fitted = None if ring is None or interference is None else ring.pressure(interference)
        flanks = self.run.case.cam.key_flanks
        required = [each.torque_reduction for each in self.run.machines.values()]
        own = {
            "torque.required_reduction": self._machine.torque_reduction,
            "torque.greatest_reduction": max(filter(None, required), default=None),
            "cam.fit.ring_pressure": fitted,
            "cam.key.bearing_length": None if flanks is None else flanks.length,
        }
        return in_load_case(shared, self._machine) | own | self._of_disc

    @cached_property
    def _shared(self) -> Numbers:
        states = tuple(self.run.machines.values())
        return numbers_of_discs(self.run.case, states, self.run.contour)

    @property
    def _of_disc(self) -> dict[str, float]:
        """Numbers of the second disc under the keys of the first, where the demand is of it."""
        second = self._machine.cam.second
        if second is None or self._disc.contour is self.run.contour:
            return {}
        offset = -float(self._shared["cam.offset"])  # across a stem; 0 of an arm
        return {"roller.radius": second.radius, "cam.offset": offset}

    @cached_property
    def _cam(self) -> ContourCam:
        """Cam at the angle of the demand, at maximum lift without one; of a contour the disc of the
        demand, else with the motion of the roller or face that carries.
        """
        angle = self.record["cam_angle_deg"]
        if angle is None:
            return self._on(CamDisc(self.run.contour, 0.0), self.run.contour.lift.highest.theta)
        disc, theta = self._disc, math.radians(angle)
        cam = self._on(disc, theta + disc.turn)
        if self._is_of_contour or not self._has("wall"):
            return cam
        at, wall = np.array([theta]), self._rows["wall"][[self._row]]
        track = cam.on_track(self._machine.cam.second, at, wall)
        return _OnTrack(**{each.name: getattr(cam, each.name) for each in fields(cam)}, track=track)

    @property
    def _is_of_contour(self) -> bool:
        measured = self.declared.measured
        return measured is not None and measured.reduce == "contour"

    @cached_property
    def _disc(self) -> CamDisc:
        """Disc of the demand of a contour: that on which its measure is nearest to it; the first
        one of other demands.
        """
        first, *others = discs_of(self.run.contour, self._machine.cam.second)
        measured, measure = self.declared.measured, self.declared.measure
        angle, demand = self.record["cam_angle_deg"], self.record["demand"]
        if not others or not self._is_of_contour or angle is None or demand is None:
            return first
        if measured is None or measure is None:
            return first
        wanted = units.from_unit(demand, self.record["unit"])

        def miss(disc: CamDisc) -> float:
            cam = self._on(disc, math.radians(angle) + disc.turn)
            value = measured.value(measure(cam), cam.numbers)
            return abs(float(np.ravel(value)[0]) - wanted)

        return min((first, *others), key=miss)

    def _on(self, disc: CamDisc, theta: float) -> ContourCam:
        """Cam of a disc at its own cam angle, rad."""
        at, lift = np.array([theta]), disc.contour.lift
        cam = ContourCam.at(disc.contour, in_load_case(self._shared, self._machine), at, 3)
        system = self._machine.system
        external, gravity = system.external.at(at), system.gravity_along_axis
        return replace(cam, external=external, gravity=gravity, least_lift=lift.lowest.value)

    @cached_property
    def _rows(self) -> Mapping[str, Array]:
        """Columns of the cycle in the load case of the demand."""
        cycle, name = self.run.run.final.cycle, self.record["load_case"]
        return (cycle.of_load_case(name) if name else cycle).numbers

    @property
    def _row(self) -> int:
        """Index of the row of the cycle at the cam angle of the demand; ResultError where the
        demand has no cam angle, or the cycle no row at it.
        """
        angle, solved = self.record["cam_angle_deg"], self._rows["cam_angle_deg"]
        row = 0 if angle is None else int(np.argmin(np.abs(solved - angle)))
        if angle is None or abs(solved[row] - angle) > SAME_ANGLE:
            raise ResultError(f"5_cycle.csv: no row at the cam angle of {self.record['id']}")
        return row

    def _has(self, name: str) -> bool:
        """Whether the cycle has a column of a name without its unit."""
        return any(units.column(name, unit) in self._rows for unit in ("", *_UNITS))

    def _column(self, name: str) -> tuple[str, Array]:
        """Unit and values (n,), in this unit, of a column of the cycle, by its name without the
        unit; the closed form in place of a column of finite elements that is not solved, and the
        column of other closures in place of one that the closure lacks.

        Raises
        ------
        ResultError
            If the cycle has no such column.
        """
        for unit in ("", *_UNITS):
            header = units.column(name, unit)
            if header not in self._rows:
                continue
            if name in _CLOSED_FORM and np.isnan(self._rows[header]).all():
                return self._column(next(each for each in _CLOSED_FORM[name] if self._has(each)))
            return unit, self._rows[header]
        if name in _FOR_OTHERS:
            return self._column(_FOR_OTHERS[name])
        if name in _ABSENT:
            return "", np.zeros(next(iter(self._rows.values())).size)
        raise ResultError(f"5_cycle.csv: no column {name}")


def _quantity_of(key: str) -> In | Count | None:
    """Unit of a key; None: a number that follows from those of the case."""
    try:
        return quantity_of(key)
    except (InputError, AttributeError):  # the latter within a part, such as its flanks
        return None
