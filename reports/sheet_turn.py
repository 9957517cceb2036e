"""Load case over a cam turn, as the figures of the analysis sheet use it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError, ResultError
from camwright.geometry.figures import SERIES, Curve, Figure, LimitLine, Panel, over_turn
from camwright.pipeline.base import units
from camwright.pipeline.base.tables import Table
from camwright.pipeline.results.run_reader import TrialRecord
from camwright.reports.machine_words import MachineWords, words_of
from camwright.reports.report_tables import Record, in_unit

_FLAT = 0.02
"""Share of the greatest curve of a panel below which another one looks like zero."""
_UNDERFLOW = 1e-12  # in the unit of the panel
_NO_FORCE = 1e-6  # N, of what stands for the spring that a cam does without
_LOW_HEIGHT = 0.6  # of a panel for small curves


@dataclass(frozen=True, eq=False)
class SheetTurn:
    """Load case of the final trial over a cam turn.

    Parameters
    ----------
    columns : Table       5_cycle.csv, rows of this load case
    others : tuple        the same of every load case, this one included
    lift, contour : Table      2_lift.csv and 3_contour.csv
    torque : Table or None     1_torque.csv
    checks : sequence     records of 6_checks.json
    case : mapping        case.toml as read
    balance : mapping     balance of trial.json
    speed : Table or None      1_speed.csv
    limits : Table or None     2_limits.csv
    points : sequence          trial_points of run.json
    ripple_map : mapping       ripple_map of run.json; None without one
    sweep : Table or None      5_speed_sweep.csv
    fatigue : mapping          fatigue of trial.json, by part
    trials : sequence          trials to be compared, the final one last
    """

    columns: Table
    others: tuple[Table, ...]
    lift: Table
    contour: Table
    torque: Table | None
    checks: Sequence[Record]
    case: Record
    balance: Record
    load_case: str = ""
    speed: Table | None = None
    limits: Table | None = None
    points: Sequence[Record] = ()
    ripple_map: Record | None = None
    sweep: Table | None = None
    fatigue: Record = field(default_factory=dict)
    trials: Sequence[TrialRecord] = ()

    @property
    def counter_hole(self) -> tuple[float, float, float, bool] | None:
        """Centre x, y and radius of the counter-hole, mm, and whether it is drilled; None without a
        hole, or if one that is not drilled does not balance the cam, or cannot be drilled.
        """
        names = ("hole_x_mm", "hole_y_mm", "hole_diameter_mm")
        values = [self.balance[name] for name in names]
        drilled = bool(self.balance["hole_drilled"])
        proposed = not self.balance["hole_note"] and self.walls is None
        if not (drilled or proposed) or not all(isinstance(v, (int, float)) for v in values):
            return None
        x, y, diameter = (float(value) for value in values if value is not None)
        return x, y, 0.5 * diameter, drilled

    @property
    def crank(self) -> Array:
        return self.columns["crank_angle_deg"]

    @property
    def gear_ratio(self) -> float:
        ratio = self.case.get("mechanism", {}).get("gear_ratio", 2.0)
        return float(ratio) if isinstance(ratio, (int, float)) and ratio > 0 else 2.0

    @property
    def words(self) -> MachineWords:
        """Words of the machine."""
        return words_of(self.case, self.gear_ratio, balances=self.torque is not None)

    @property
    def balanced(self) -> SheetTurn:
        """This turn with the first load case that has a machine torque as the drawn one; unchanged
        if there is none.
        """
        for table in (self.columns, *self.others):
            torque = table.get("torque_before_Nm")
            if torque is not None and np.isfinite(torque).all():
                names = table.load_cases
                return replace(self, columns=table, load_case=names[0] if names else self.load_case)
        return self

    @property
    def worst(self) -> int:
        """Row of the maximum contact pressure in `columns`: by finite elements, by Hertz where
        these are missing.
        """
        for name in ("p0_fe_MPa", "p0_hertz_MPa"):
            if np.isfinite(self.columns[name]).any():
                return int(np.nanargmax(self.columns[name]))
        return 0

    @property
    def keyway(self) -> tuple[float, float, float] | None:
        """Width and depth, mm, and angle, rad; None without a keyway."""
        width, depth = (self.length("cam", "keyway", key) for key in ("width", "depth"))
        if width is None or depth is None:
            return None
        return width, depth, self.length("cam", "keyway", "angle", unit="rad") or 0.0

    @property
    def outer_wall(self) -> Array | None:
        """Outer wall of a groove (2, n), mm; None of a cam whose contour is its edge."""
        if "outer_x_mm" not in self.contour:
            return None
        return np.array([self.contour["outer_x_mm"], self.contour["outer_y_mm"]])

    @property
    def second_disc(self) -> Array | None:
        """Contour of the second disc (2, n), mm; None of a cam with one disc."""
        if not isinstance(self.case.get("cam", {}).get("conjugate"), Mapping):
            return None
        return np.array([self.contour[f"second_contour_{axis}_mm"] for axis in "xy"])

    @property
    def sprung(self) -> bool:
        """Whether a spring acts on the follower: a second track or its weight may hold it."""
        return bool(np.abs(self.columns["spring_force_N"]).max() > _NO_FORCE)

    @property
    def walls(self) -> Array | None:
        """Track that carries at each row: 1 the first or inner, -1 the second or outer; None of a
        cam with one track.
        """
        return self.columns.get("wall")

    def track_at(self, row: int) -> str:
        """Prefix of the columns of `contour` on the track that carries at a row of the cycle:
        "second_", or "" of the first one and in a groove.
        """
        pulls = self.walls is not None and self.walls[row] < 0.0
        return "second_" if pulls and "second_normal_x" in self.contour else ""

    @property
    def rolls(self) -> bool:
        """Whether the follower is a roller; otherwise a flat or curved face."""
        return "face_contact_offset_mm" not in self.columns

    @property
    def on_arm(self) -> bool:
        """Whether an arm carries the follower; otherwise a stem in guides."""
        return isinstance(self.case.get("follower", {}).get("arm"), Mapping)

    @property
    def follower_name(self) -> str:
        """Name of the contact body of the follower."""
        return "roller" if self.rolls else "face"

    @property
    def half_width(self) -> float:
        """Half-width of the contact at the maximum contact pressure, mm, by finite elements, else
        of Hertz; ResultError without either.
        """
        for name in ("half_width_fe_mm", "half_width_hertz_mm"):
            if self.columns[name][self.worst] > 0:
                return float(self.columns[name][self.worst])
        raise ResultError("5_cycle.csv: no half-width at the maximum contact pressure")

    def length(self, *path: str, unit: str = "mm") -> float | None:
        """Value of the case at a path of keys, as a number in `unit`; None if absent or of another
        dimension.
        """
        value: object = self.case
        for key in path:
            value = value.get(key) if isinstance(value, Mapping) else None
        try:
            return units.parse(value, unit, ".".join(path)) / units.factor(unit)
        except InputError:
            return None

    def bound(self, check_id: str) -> float | None:
        """Recorded limit of a check in the unit of its record; None without one."""
        for check in self.checks:
            if check["id"] == check_id and isinstance(check["limit"], (int, float)):
                return float(check["limit"])
        return None

    def limit(self, label: str, unit: str, check_id: str) -> tuple[LimitLine, ...]:
        """Limit of a check as a line, in the unit of a panel; () without a finite limit or where
        its dimension differs.

        Parameters
        ----------
        label : str      of the line
        unit : str       of the panel
        check_id : str   id of the check
        """
        bound = self.bound(check_id)
        unit_of = {str(check["id"]): str(check["unit"]) for check in self.checks}
        value = None if bound is None else in_unit(bound, unit_of[check_id], unit)
        return () if value is None or not np.isfinite(value) else (LimitLine(value, label),)

    def static_rating(self, label: str, check_id: str, *path: str) -> tuple[LimitLine, ...]:
        """Static rating of the case, N, over its required safety factor."""
        rating, safety = self.length(*path, unit="N"), self.bound(check_id)
        return (LimitLine(rating / safety, label),) if rating and safety else ()


def beside_path(contour: Table, distance: float) -> Array:
    """Wall (2, n), mm, parallel to the path of the roller; distance, mm, positive outwards."""
    return np.array(
        [contour[f"pitch_{axis}_mm"] + distance * contour[f"normal_{axis}"] for axis in "xy"]
    )


def both_ways(limits: Sequence[LimitLine]) -> tuple[LimitLine, ...]:
    """Limits of a magnitude above and below zero."""
    return (*limits, *(LimitLine(-line.value, line.label) for line in limits))


def lowest(*limits: LimitLine) -> tuple[LimitLine, ...]:
    """Lowest limit; empty without any."""
    return tuple(sorted(limits, key=lambda line: line.value)[:1])


def curves_of(
    turn: SheetTurn, *wanted: tuple[str, str], dashed: Sequence[int] = ()
) -> tuple[Curve, ...]:
    """Curves over the shaft angle of the turn, each with the range of all load cases as a ribbon;
    columns that are missing or nowhere finite are omitted.

    Parameters
    ----------
    wanted : tuples     column, label
    dashed : sequence   indices in `wanted` of curves that are dashed, without a ribbon
    """
    made = []
    for number, (column, label) in enumerate(wanted):
        values = turn.columns.get(column)
        if values is None or not np.isfinite(values).any():
            continue
        curve = Curve(turn.crank, values, label, SERIES[number % len(SERIES)])
        if number in dashed:
            curve = replace(curve, look="dashed")
        elif len(turn.others) > 1:
            stack = [other[column] for other in turn.others if other[column].size == values.size]
            curve = replace(curve, lower=np.min(stack, axis=0), upper=np.max(stack, axis=0))
        made.append(curve)
    return tuple(made)


def angle_figure(
    turn: SheetTurn, figure_id: str, title: str, caption: str, *panels: Panel, mark: bool = True
) -> Figure | None:
    """Figure over the turn of the panels that have curves; None without any.

    Curves that are zero at all angles are named in the caption instead, if others remain.

    Parameters
    ----------
    mark : bool   draw a line at the angle of the maximum contact pressure
    """
    drawn = tuple(panel for panel in panels if panel.curves)
    if not drawn:
        return None
    full = tuple(part for panel in drawn for part in _apart(panel))
    zero = [curve.label or panel.quantity
            for panel in drawn for curve in panel.curves if _is_zero(curve)]  # fmt: skip
    named = ", ".join(zero) if full else ""
    full = full or drawn
    return over_turn(
        figure_id, title, f"{caption} Zero at all angles: {named}." if named else caption, full,
        ratio=turn.gear_ratio, shaft=turn.words.shaft, marks=turn.words.marks,
        worst=float(turn.crank[turn.worst]) if mark else None,
    )  # fmt: skip


def _is_zero(curve: Curve) -> bool:
    """Whether a curve is zero at all angles, up to underflow, in its ribbon too."""
    return _size(curve) < _UNDERFLOW


def _size(curve: Curve) -> float:
    """Greatest magnitude of a curve and its ribbon."""
    return float(np.max(np.abs(np.nan_to_num(curve.reached)), initial=0.0))


def _apart(panel: Panel) -> tuple[Panel, ...]:
    """Panels of the curves of a panel: without those that are zero at all angles, and with those
    smaller than `_FLAT` of the greatest one in a second panel; () where all are zero.
    """
    curves = tuple(curve for curve in panel.curves if not _is_zero(curve))
    if not curves:
        return ()
    sizes = list(map(_size, curves))
    flat = [size < _FLAT * max(sizes) for size in sizes]
    large = tuple(curve for curve, small in zip(curves, flat, strict=True) if not small)
    little = tuple(curve for curve, small in zip(curves, flat, strict=True) if small)
    if not little:
        return (replace(panel, curves=curves),)
    name = little[0].label if len(little) == 1 else panel.quantity
    below = Panel(name, panel.unit, little, height=_LOW_HEIGHT)
    return replace(panel, curves=large), below
