"""Screening of many designs: demand, limit, utilisation, status and headline as columns."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.display import Displayed
from camwright.geometry.errors import CamError, InputError
from camwright.geometry.extrema import sampled_greatest, sampled_least
from camwright.geometry.figures import DrawnAxes
from camwright.pipeline.base.columns import curves, data_frame
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.external_load import closing_preload
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.load_case_torque import has_torque
from camwright.pipeline.checks.check import Declaration
from camwright.pipeline.checks.extremes import on_both_tracks
from camwright.pipeline.checks.registry import DECLARED, accepted
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.follower.spring import spring_energy
from camwright.pipeline.preview import preview_case
from camwright.pipeline.screening.design_arrays import Designs, LiftOrigin, Screened, TorqueOfSpeed
from camwright.pipeline.screening.design_factors import Factor, Group, count_of, groups, refusals
from camwright.pipeline.screening.screened_cam import ScreenedCam
from camwright.pipeline.screening.screened_checks import SCREENED, torque_after
from camwright.pipeline.smoothing.smoothers import Smoother, smoothed

if TYPE_CHECKING:
    import pandas as pd

BLOCK = 500
"""Designs solved at once: arrays of some megabytes."""
Column = NDArray[np.float64] | NDArray[np.object_]


class ScreenedDesigns(Displayed, dict[str, Column]):
    """Columns (n,) of n screened designs by name."""

    @property
    def facts(self) -> Mapping[str, object]:
        """Number of designs by screen, and of columns."""
        screens = Counter(self["screen"].tolist())
        return (
            {"designs": len(self["screen"])}
            | dict(sorted(screens.items()))
            | {"columns": len(self)}
        )

    def to_pandas(self) -> pd.DataFrame:
        """A row per design; see `Table.to_pandas`."""
        return data_frame(self)

    def plot(self, *names: str) -> DrawnAxes:
        """Columns over the design number, one panel each; see `Table.plot`.

        Without a name the first utilisation.
        """
        shown = names or tuple(name for name in self if name.endswith(".utilisation"))[:1]
        count = np.arange(len(self["screen"]), dtype=float)
        return curves({"design": count, **self}, shown)


def screen_designs(
    case: Case, factors: Mapping[str, Factor], *, positions: int = 180
) -> ScreenedDesigns:
    """Closed-form checks of many designs together, from lift to spring and bearing.

    Designs that differ in the keys of `ARRAYS` alone, and in preload and speed of load cases, are
    solved as arrays: rate, preload, travel and winding of the spring, prime and roller radius,
    offset, widths, bore, bearing ratings, sizes, friction and PV limit of a flat face, follower
    mass, overhang and damping, spacing and friction of the guides, dimensions of an arm, of its
    pivot and the link of its spring, of a groove, of a second roller with its place, clearance and
    interference, inertia, share of compensation, width of a smoother and every limit. Others
    are grouped by their values, with one case each. The rate is `spring.rate`, not that of the
    winding: a check compares them. The lift of a constrained synthesis is that of the case: every
    design keeps its stored energy.

    Parameters
    ----------
    case : Case
    factors : mapping   dotted key of the case file -> n values: SI numbers, or text as in the file
    positions : int     cam angles of the loads, at least; the lift is that of the case

    Returns
    -------
    ScreenedDesigns
           dict, column -> (n,), in the units of the records: of each check that screening can judge
           ``{id}.demand``, ``.limit``, ``.utilisation``, ``.error`` (NaN: missing or infinite) and
           ``.status``, "" where the check does not apply; ``headline.{key}`` as in ``run.json``;
           ``screen``: "fail", "open", or "error" for a refused design; ``governing``: must-have
           check of the greatest utilisation; ``message``: of a refusal or a contour that bounds no
           body, else ""

    Raises
    ------
    InputError
        If a key is unknown, or the factors differ in length.
    """
    if not 36 <= positions <= 7200:
        raise InputError("positions", positions, "36 to 7200")
    count = count_of(factors)
    columns = ScreenedDesigns(
        {name: np.full(count, "", dtype=object) for name in ("screen", "governing", "message")}
    )
    for group in groups(case, factors):
        if group.case is None:
            _put(columns, group.rows, {"screen": "error", "message": group.refused})
            continue
        try:
            blocks = _Blocks.of(group.case, group, positions)
        except CamError as error:
            _put(columns, group.rows, {"screen": "error", "message": str(error)})
            continue
        for rows, own in blocks.screened():
            _put(columns, rows, own)
    return columns


def _put(
    columns: dict[str, Column], rows: NDArray[np.intp], own: Mapping[str, Column | str]
) -> None:
    """Write columns of some designs into those of all; a new one is "" or NaN in the other rows."""
    count = len(columns["message"])
    for name, values in own.items():
        if name not in columns:
            is_text = isinstance(values, str) or values.dtype == object
            empty = np.full(count, "", dtype=object) if is_text else np.full(count, np.nan)
            columns[name] = empty
        columns[name][rows] = values


@dataclass(frozen=True, eq=False)
class _Blocks:
    """A group with the source of its lifts and its engine torques."""

    case: Case
    group: Group
    synthesised: Array | None
    torques: Mapping[int, TorqueOfSpeed]
    positions: int

    @classmethod
    def of(cls, case: Case, group: Group, positions: int) -> _Blocks:
        """The group with its lifts and torques solved: stored energy of the synthesis of a
        constrained case, engine torque of each load case at the speeds of the designs.
        """
        energy = None
        if case.lift is None and case.smoothing.kind == "constrained":
            case, energy = synthesis(case)
        torques = {
            k: TorqueOfSpeed.of(case, k, group.values.get(f"load_case[{k}].speed"))
            for k, state in enumerate(case.load_cases)
            if case.balances and has_torque(case, state)
        }
        return cls(case, group, energy, torques, positions)

    def screened(self) -> Iterator[tuple[NDArray[np.intp], Mapping[str, Column | str]]]:
        """Rows and columns of each block of designs."""
        for start in range(0, self.group.rows.size, BLOCK):
            rows = self.group.rows[start : start + BLOCK]
            values = {key: each[start : start + BLOCK] for key, each in self.group.values.items()}
            words = np.array(refusals(self.case, values, np.full(rows.size, np.nan)), dtype=object)
            good = words == ""
            if not good.all():
                yield rows[~good], {"screen": "error", "message": words[~good]}
            if good.any():
                kept = {key: each[good] for key, each in values.items()}
                yield from self._solved(rows[good], kept)

    def _solved(
        self, rows: NDArray[np.intp], values: Mapping[str, Array]
    ) -> Iterator[tuple[NDArray[np.intp], Mapping[str, Column | str]]]:
        """Rows and columns of designs; where they cannot be solved, of their halves, down to the
        single designs that are refused, with the reason.

        Parameters
        ----------
        rows : array (m,)   numbers of the designs
        values : mapping    by key of an array path, SI, each (m,)
        """
        try:
            yield rows, self._columns(values)
        except CamError as error:
            if rows.size == 1:
                yield rows, {"screen": "error", "message": str(error)}
                return
            for half in (slice(None, rows.size // 2), slice(rows.size // 2, None)):
                own = {key: each[half] for key, each in values.items()}
                yield from self._solved(rows[half], own)

    def _columns(self, values: Mapping[str, Array]) -> dict[str, Column]:
        """Columns by name (m,) of designs with these values (m,) by key, SI; status "" and NaN, and
        the reason as message, where the lift refuses a design.
        """
        designs = self._designs(values)
        columns = judged_columns(designs) | headline_columns(designs)
        refused = np.array(refusals_of(designs, values), dtype=object)
        away = refused != ""
        if away.any():
            for column in columns.values():
                column[away] = "" if column.dtype == object else np.nan
            columns["screen"][away] = "error"
            columns["message"][away] = refused[away]
        return columns

    def _designs(self, values: Mapping[str, Array]) -> Designs:
        """Designs of the group with these values (m,) by key, SI; their lift is stated, smoothed or
        by the energy of the synthesis.
        """
        case, count = self.case, 1 if not values else len(next(iter(values.values())))
        torques = {
            k: each.at(values.get(f"load_case[{k}].speed")) for k, each in self.torques.items()
        }
        source = LiftOrigin(energy=self.synthesised)
        if case.lift is not None:
            source = LiftOrigin(lift=given_lift(case).values)
        elif self.synthesised is None:
            source = LiftOrigin(torque=_smoothed(case, values, torques[0], count))
        samples = next(
            each.shape[-1]
            for each in (source.torque, source.energy, source.lift)
            if each is not None
        )
        return Designs(
            case=case,
            columns={key: each[:, None] for key, each in values.items()},
            source=source,
            torques={k: resampled(each, samples) for k, each in torques.items()},
            count=count,
            step=step_of(samples, self.positions),
            throughputs={
                k: each.throughput_at(values.get(f"load_case[{k}].speed"))
                for k, each in self.torques.items()
            },
        )


def refusals_of(designs: Designs, values: Mapping[str, Array]) -> list[str]:
    """Refusal of each design by its values and its lift in words, "" where it is accepted."""
    travel = None if designs.case.follower.face is None else designs.contact_travel
    return refusals(designs.case, values, designs.highest, travel, designs.lift)


def step_of(samples: int, positions: int) -> int:
    """Greatest divisor of a number of samples that leaves at least some positions."""
    return max(
        step
        for step in range(1, samples + 1)
        if samples % step == 0 and (step == 1 or samples // step >= positions)
    )


def resampled(torque: Array, count: int) -> Array:
    """Torque (..., n) at another number of equal angles, by its harmonics."""
    n = torque.shape[-1]
    return torque if n == count else np.fft.irfft(np.fft.rfft(torque), n=count) * (count / n)


def _smoothed(case: Case, values: Mapping[str, Array], torque: Array, count: int) -> Array:
    """Torque (1 or m, N) behind the smoother of each design, crank N m; one row where
    all share it.
    """
    keys = [key for key in values if key.startswith("smoothing.")]
    if not keys:
        return smoothed(torque, Smoother.from_case(case.smoothing, case.period))
    rows = np.broadcast_to(torque, (count, torque.shape[-1]))
    smoothers = np.stack([values[key] for key in keys], axis=1)
    kinds, which = np.unique(smoothers, axis=0, return_inverse=True)
    result = np.empty_like(rows)
    for k, kind in enumerate(kinds):
        own = replaced(case, dict(zip(keys, map(float, kind), strict=True)))
        at = np.flatnonzero(which.ravel() == k)
        result[at] = smoothed(rows[at], Smoother.from_case(own.smoothing, own.period))
    return result


_SYNTHESES: dict[str, tuple[Case, Array]] = {}  # by the hash of the case, made once a process


def synthesis(case: Case) -> tuple[Case, Array]:
    """Case with the results of its synthesis, and energy stored over the turn (N,), J; that of the
    last case is kept.
    """
    key = case.sha256
    if key not in _SYNTHESES:
        trial = preview_case(case, corners=False)
        spring, closing = trial.case.spring, closing_preload(trial.case)
        energy = spring_energy(closing, spring.rate, trial.lift.values, spring.shape)
        _SYNTHESES.clear()
        _SYNTHESES[key] = trial.case, energy
    return _SYNTHESES[key]


def judged_columns(designs: Designs) -> dict[str, Column]:
    """Columns (m,) of each check's demand, limit and status, of screen and governing check."""
    columns: dict[str, Column] = {}
    count, machine = designs.count, designs.machine
    fails = np.zeros(count, dtype=bool)
    most = np.full(count, -np.inf)
    governing = np.full(count, "", dtype=object)
    lost = _lost_loads(designs)
    for each in sorted(SCREENED, key=lambda one: one.check):  # the first governs among equal ones
        declared = DECLARED[each.check]
        if not declared.concerns(machine):
            continue
        judged = _without_lost_loads(designs, each, lost.get(declared.rests_on))
        if judged is None:
            continue
        figures = _figures(designs, each, declared, *judged)
        columns |= {f"{each.check}.{name}": column for name, column in figures.items()}
        if declared.must_have:
            if not declared.evidence:
                used = np.asarray(figures["utilisation"], dtype=float)
                greater = (used > most) & (figures["status"] != "waived")  # NaN is not
                governing[greater], most[greater] = each.check, used[greater]
            fails |= figures["status"] == "fail"
    cut = designs.least_factor
    return columns | {
        "screen": _SCREEN[fails.astype(int)],
        "governing": governing,
        "message": np.array(
            [
                "" if f > 0.0 else f"undercut factor of the contour = {f:.4g}, must be > 0"
                for f in cut
            ],
            dtype=object,
        ),
    }


def _lost_loads(designs: Designs) -> dict[str, NDArray[np.bool_]]:
    """Whether a load case has no loads (k, m), by what a check rests on; see `lost_loads`."""
    ends = [cam.ends for cam in designs.cams]
    lost = np.array([end.lost for end in ends])
    return {"loads": lost, "contact": lost & np.array([end.leaves for end in ends])}


def _without_lost_loads(
    designs: Designs, screened: Screened, lost: NDArray[np.bool_] | None
) -> tuple[Array, Array | float | None, NDArray[np.bool_]] | None:
    """Demand (m,), limit, and whether the demand is only a bound (m,); None where the check does
    not apply.

    A load case without loads (`lost` (k, m), of designs that lock or leave the cam) is left out of
    the demand of its design. That is NaN where such a load case has a figure of its own and no
    other is left.
    """
    judged = screened.judged(designs)
    if judged is None:
        return None
    demand, limit = judged
    bound = np.full(designs.count, screened.is_bound(designs))
    if lost is None or not lost.any():
        return demand, limit, bound
    demand = np.array(np.broadcast_to(demand, bound.shape))
    patterns, which = np.unique(lost, axis=1, return_inverse=True)
    for number, pattern in enumerate(patterns.T):
        there = screened.judged(designs.in_load_cases(pattern)) if pattern.any() else None
        if there is None:
            continue
        at = (which.ravel() == number) & ~np.isnan(there[0])
        rest = None if pattern.all() else screened.judged(designs.in_load_cases(~pattern))
        demand[at] = np.nan if rest is None else np.broadcast_to(rest[0], at.shape)[at]
        bound |= at
    return demand, limit, bound


_STATUS = np.array(["not_evaluated", "pass", "fail"], dtype=object)
_SCREEN = np.array(["open", "fail"], dtype=object)


def _figures(
    designs: Designs,
    screened: Screened,
    declared: Declaration,
    demand: Array,
    limit: Array | float | None,
    bound: NDArray[np.bool_],
) -> dict[str, Column]:
    """Columns (m,) of a check in the unit of the record: demand, limit, utilisation, error and
    status.

    A demand that is only a bound (`bound` (m,)) is open while it is within its limit; status ""
    where the check does not apply to a design.
    """
    allowed = np.broadcast_to(
        np.asarray(np.nan if limit is None else limit, dtype=float), demand.shape
    )
    at_most = declared.sense == "at_most"
    applies = np.broadcast_to(screened.applies(demand, designs), demand.shape)
    demand = np.where(applies, demand, np.nan)
    known = ~np.isnan(demand) & np.isfinite(allowed)
    with np.errstate(invalid="ignore", divide="ignore"):
        holds = demand <= allowed if at_most else demand >= allowed
        used = utilisations(demand, allowed, at_most=at_most)
    if declared.is_bound(Tier.SCREENING):
        known &= ~holds  # a lower bound within the limit says nothing
    known &= ~(bound & holds)
    demand = np.where(bound & ~known, np.nan, demand)
    status = _STATUS[np.where(known, np.where(holds, 1, 2), 0)]
    status[~applies] = ""
    for waiver in designs.case.waivers:
        if waiver.check == declared.id and not declared.evidence:
            up_to = accepted(waiver, declared.unit).up_to
            covered = demand <= up_to if at_most else demand >= up_to
            status[(status == "fail") & covered] = "waived"
    scale = in_unit(1.0, declared.unit)
    return {
        "demand": demand * scale,
        "limit": allowed * scale,
        "utilisation": np.where(known, used, np.nan),
        "error": screened.deviation * np.fmax(np.abs(demand), np.abs(allowed)) * scale,
        "status": status,
    }


def utilisations(demand: Array, limit: Array, *, at_most: bool) -> Array:
    """Demand over limit (m,), or its inverse for a least value; 0 or infinite at a zero limit."""
    part, whole = (demand, limit) if at_most else (limit, demand)
    without = np.where(part <= whole, 0.0, np.inf)
    return np.divide(part, whole, out=without, where=whole > 0.0)


def _least_force(cam: ScreenedCam) -> Array:
    """Least contact force over the turn (m,), N: 0 between two tracks with clearance."""
    passes = cam.pulls and cam.block.squeeze is None
    return np.where(passes & (np.ptp(cam.wall, axis=-1) > 0.0), 0.0, sampled_least(cam.normal))


def headline_columns(designs: Designs) -> dict[str, Column]:
    """Columns ``headline.{key}`` (m,) of the key figures, as in ``run.json``."""
    first, cams = designs.cams[0], designs.cams
    before, lost = first.state.torque, first.ends.lost

    def over(measure: Callable[[ScreenedCam], Array]) -> Array:
        loaded = [
            np.where(each.ends.lost, -np.inf, sampled_greatest(measure(each))) for each in cams
        ]
        worst = np.max(loaded, axis=0)
        return np.where(np.isneginf(worst), np.nan, worst)

    p0 = over(lambda each: on_both_tracks(each, lambda one: one.p0_line))
    least = np.min([_least_force(each) for each in cams], axis=0)
    steepest = sampled_greatest(np.abs(designs.whole.motion.pressure_angle))
    figures = {
        "lift_max_mm": 1e3 * designs.highest,
        "pressure_angle_max_deg": np.degrees(steepest),
        "pitch_radius_of_curvature_min_mm": 1e3 * designs.least_convex_radius,
        "normal_force_min_N": np.maximum(least, 0.0),
        "normal_force_max_N": over(lambda each: each.normal),
        "p0_hertz_max_MPa": 1e-6 * p0,
        "guide_reaction_A_max_N": over(lambda each: each.guides.net_a),
        "guide_reaction_B_max_N": over(lambda each: each.guides.net_b),
        "friction_loss_J_per_cam_turn": np.where(lost, np.nan, first.friction_loss),
    }
    if before is not None:
        after = torque_after(designs, first)
        whole = (designs.count,)
        figures |= {
            "torque_std_before_Nm": np.broadcast_to(before.std(axis=-1), whole),
            "torque_std_after_Nm": np.where(lost, np.nan, after.std(axis=-1)),
            "torque_p2p_before_Nm": np.broadcast_to(np.ptp(before, axis=-1), whole),
            "torque_p2p_after_Nm": np.where(lost, np.nan, np.ptp(after, axis=-1)),
        }
    return {f"headline.{name}": np.array(each, dtype=float) for name, each in figures.items()}
