"""Live preview read in Python: values and errors of a record at settings of its factors."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebval

from camwright.geometry.lift import Lift
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_reader import LIVE
from camwright.pipeline.screening.live_preview import CANDIDATES, live_record, write_live

CASES = Path(__file__).parents[1] / "cases"


class LiveValue(NamedTuple):
    """Value with its error, and limit; holds: whether the preview says that it holds there."""

    value: float
    error: float
    limit: float | None
    holds: bool


@cache
def fitted(name: str, checks: tuple[str, ...] = ()) -> tuple[Case, Lift, dict[str, Any]]:
    """A shipped case as its preview draws it, its lift, and the surfaces about it.

    Of the checks of these ids; without any of those of the greatest utilisation.
    """
    trial = preview_case(read_case(CASES / f"{name}.toml"), corners=False)
    used = [c for c in trial.checks if c.must_have and not c.evidence and c.utilisation is not None]
    names = [c.id for c in sorted(used, key=lambda c: -(c.utilisation or 0.0))][:CANDIDATES]
    lift = trial.contour.pitch.lift
    record = live_record(trial.case, lift.values, checks or names)
    assert record is not None
    return trial.case, lift, dict(record)


def write_in(folder: Path, checks: Iterable[str]) -> dict[str, Any]:
    """Write the surfaces of the GX120 into the folder of a run, as its live preview."""
    _, _, record = fitted("gx120", tuple(checks))
    write_live(folder, record)
    assert (folder / LIVE).is_file()
    return record


def place(factor: Mapping[str, Any], multiple: float) -> float:
    """Place in [-1, 1] of a factor on the values of the run."""
    low, high = np.log(factor["low"]), np.log(factor["high"])
    return float((2.0 * np.log(multiple) - low - high) / (high - low))


def at(surface: Mapping[str, Any], powers: Sequence[Sequence[int]], places: Sequence[float]) -> Any:
    """Value and error of a surface."""
    made = surface["coefficients"]
    total = made[0]
    if len(made) > 1:
        bases = [[chebval(z, np.eye(9)[k]) for k in range(9)] for z in places]
        total = sum(
            c * np.prod([bases[axis][k] for axis, k in enumerate(degrees)])
            for c, degrees in zip(made, powers, strict=True)
        )
        scale = surface["scale"]
        total = np.exp(total) if scale == "log" else total
        total = np.sqrt(max(total, 0.0)) if scale == "square" else total
    error = surface["error"] * (abs(total) if surface["share"] else 1.0)
    return float(total), float(error)


def values(record: Mapping[str, Any], multiples: Sequence[float]) -> dict[str, LiveValue]:
    """Values of every quantity by its id at factors on the values of the run."""
    places = [place(f, m) for f, m in zip(record["factors"], multiples, strict=True)]
    powers = record["powers"]
    held = {part["state"]: at(part["surface"], powers, places) for part in record["contact"]}
    made = {}
    for each in record["quantities"]:
        best, holds, margin = None, True, 0.0
        sign = 1.0 if each["worst"] == "greatest" else -1.0
        for part in each["parts"]:
            contacts = [held[state] for state in part["loads"]]
            holds &= all(abs(least) > error for least, error in contacts)
            if any(least <= 0.0 for least, _ in contacts):
                continue
            if part["surface"] is None:
                holds = False
                continue
            value, own = at(part["surface"], powers, places)
            margin = max(margin, own)
            if best is None or sign * value > sign * best:
                best = value
        limit = None if each["limit"] is None else at(each["limit"], powers, places)[0]
        value = np.nan if best is None else best
        made[each["id"]] = LiveValue(value, margin, limit, holds and best is not None)
    return made
