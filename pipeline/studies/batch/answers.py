"""Answers of a study from its dataset: yield, failures, factor effects, front, extremes."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.arrays import Array
from camwright.geometry.errors import InputError
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.search.front import front
from camwright.pipeline.studies.batch import answers_sensitivity as sensitivity
from camwright.pipeline.studies.batch.answers_yield import (
    CONFIDENCE,
    FAILS,
    PASSES,
    UNKNOWN,
    Yield,
    states_of,
)
from camwright.pipeline.studies.batch.dataset import FACTOR, HEADLINE, STATUS, Dataset
from camwright.pipeline.studies.batch.study_file import INDEPENDENT, Study

Answer: TypeAlias = dict[str, Any]
"""Part of the record, for JSON."""
SCHEMA = 1
SALTELLI = "sobol_indices"
SAMPLES = (*INDEPENDENT, SALTELLI)
"""Methods of sampling whose designs represent the distributions of the factors."""
UTILISATION, PASS = "utilisation", "pass"
"""Outputs of every study: utilisation of the governing check; 1 where a design passes, else 0."""
_MESSAGES, OUTPUTS_MAX = 12, 40
_OUTPUT_FIGURES = (".demand", ".utilisation")


def states(data: Dataset) -> tuple[NDArray[np.uint8], str]:
    """State (n,) of each design with its deciding column; see `states_of`."""
    return states_of(data["verdict"], data["screen"])


def answered(data: Dataset, study: Study) -> Answer:
    """Answers of a study as a record: yield, failing checks, effects of the factors on the outputs,
    front, worst design.

    Parameters
    ----------
    data : Dataset   rows of the designs, from which alone the answers follow
    study : Study    sampling, outputs and objectives

    Raises
    ------
    InputError
        If an objective is not a column of numbers, or the dataset has no row.
    """
    if not len(data):
        raise InputError("designs", 0, ">= 1")
    state, by = states(data)
    sample = Sample.of(study, len(data))
    utilisation = governing_utilisation(data)
    outputs, left_out = _outputs(data, study, state, utilisation)
    factors = {key: data[FACTOR + key] for key in data.factors}
    return {
        "schema": SCHEMA,
        "sampling": study.sampling.method if study.sampling else None,
        "designs": _counts(data, state, by),
        "yield": _yield(state[sample.rows], by, sample),
        "failures": _failures(data, state),
        "factors": [_factor(data, key, values) for key, values in factors.items()],
        "outputs": [
            _output(data, name, values, sample, factors) for name, values in outputs.items()
        ],
        "outputs_left_out": left_out,
        "front": _front(data, study, state),
        "worst": _worst(data, utilisation, state),
    }


@dataclass(frozen=True, eq=False)
class Sample:
    """Rows of a dataset that are independent samples of one distribution.

    rows (k,) of them; probabilistic: whether their share that passes is a yield; blocks: number of
    rows at the beginning that are whole blocks of Saltelli, 0 for another sample; factors: of a
    block; dependent: rows of the blocks that are left out.
    """

    rows: NDArray[np.int64]
    probabilistic: bool
    blocks: int = 0
    factors: int = 0
    dependent: int = 0

    @classmethod
    def of(cls, study: Study, count: int) -> Sample:
        """Which of the first `count` designs of a study are independent samples of one
        distribution; with Saltelli's sampling those of matrices A and B of each whole block.
        """
        method = study.sampling.method if study.sampling else ""
        single = method in SAMPLES and len(study.cases) == 1
        if not single or method != SALTELLI:
            return cls(np.arange(count), single)
        factors = len(study.factors)
        whole = count - count % (factors + 2)
        rows = sensitivity.independent(whole, factors)
        return cls(rows, True, whole, factors, whole - rows.size)


def number_column(data: Dataset, name: str) -> Array:
    """Numeric column of a dataset; InputError for a text column."""
    if not np.issubdtype(data[name].dtype, np.number):
        raise InputError("objective.column", name, "a column of numbers")
    return np.asarray(data[name], dtype=float)


def governing_utilisation(data: Dataset) -> Array:
    """Utilisation (n,) of the governing check; NaN where it is infinite or unknown."""
    governing = data["governing"]
    values = np.full(len(data), np.nan)
    for check in np.unique(governing):
        column = f"{check}.utilisation"
        if column in data.columns:
            rows = governing == check
            values[rows] = data[column][rows]
    return values


def _outputs(
    data: Dataset, study: Study, state: NDArray[np.uint8], utilisation: Array
) -> tuple[dict[str, Array], int]:
    """Outputs (n,) of the n designs by name, and the number of those left out beyond `OUTPUTS_MAX`.

    They are: whether a design passes (1, 0; NaN: no result), governing utilisation, the headline
    figures, and the columns that the study names as outputs.

    Parameters
    ----------
    data : Dataset             with the columns
    study : Study              with patterns of the names wanted
    state : array (n,)         `PASSES`, `FAILS` or `UNKNOWN`
    utilisation : array (n,)   of the governing check
    """
    passes = np.where(state == UNKNOWN, np.nan, (state == PASSES).astype(float))
    names = [name for name in data.columns if name.startswith(HEADLINE)]
    names += [
        name for name in data.columns
        if name.endswith(_OUTPUT_FIGURES) and any(fnmatchcase(name, o) for o in study.outputs)
    ]  # fmt: skip
    known = {name: number_column(data, name) for name in names[:OUTPUTS_MAX]}
    return {PASS: passes, UTILISATION: utilisation, **known}, max(len(names) - OUTPUTS_MAX, 0)


def _counts(data: Dataset, state: NDArray[np.uint8], by: str) -> Answer:
    """Record of the numbers of designs that pass, fail or have no result, and by depth, screen,
    verdict and message.

    Parameters
    ----------
    data : Dataset       of n designs
    state : array (n,)   `PASSES`, `FAILS` or `UNKNOWN`
    by : str             column that decides the state
    """

    def counted(name: str) -> Answer:
        return {str(value): n for value, n in sorted(Counter(data[name].tolist()).items()) if value}

    message = data["message"]
    messages = Counter(message.tolist())
    messages.pop("", None)
    ranked = sorted(messages.items(), key=lambda item: (-item[1], item[0]))
    return {
        "count": len(data),
        "by": by,
        "pass": int((state == PASSES).sum()),
        "fail": int((state == FAILS).sum()),
        "without_result": int((state == UNKNOWN).sum()),
        "depth": counted("depth"),
        "screen": counted("screen"),
        "verdict": counted("verdict"),
        "messages": [
            {"message": text, "count": n, "design": _design(data, message == text)}
            for text, n in ranked[:_MESSAGES]
        ],
        "messages_left_out": max(len(ranked) - _MESSAGES, 0),
    }  # fmt: skip


def _design(data: Dataset, wanted: NDArray[np.bool_]) -> int:
    return int(data["design"][np.flatnonzero(wanted)[0]])


def _yield(state: NDArray[np.uint8], by: str, sample: Sample) -> Answer:
    """Record of the yield: share of the designs with a result that pass, with a confidence interval
    if they are a random sample.

    Parameters
    ----------
    state : array (k,)   of the independent designs: `PASSES`, `FAILS` or `UNKNOWN`
    by : str             column that decides the state
    sample : Sample      how the designs were drawn
    """
    passed, failed = (int((state == each).sum()) for each in (PASSES, FAILS))
    share = Yield(passed, passed + failed)
    interval = share.interval() if sample.probabilistic and share.count else None
    return {
        "by": by,
        "passed": share.passed,
        "count": share.count,
        "without_result": int((state == UNKNOWN).sum()),
        "dependent": sample.dependent,
        "value": share.value,
        "interval": None if interval is None else list(interval),
        "confidence": CONFIDENCE,
        "method": "Clopper-Pearson",
    }  # fmt: skip


def _failures(data: Dataset, state: NDArray[np.uint8]) -> list[Answer]:
    """Record of each check that fails or lacks data in any design, the most frequent failure first;
    `alone` counts designs in which it is the only required check that fails.
    """
    known = [check for check in data.checks if check in DECLARED]
    failing = {check: data[check + STATUS] == "fail" for check in known}
    required = [check for check in known if DECLARED[check].must_have]
    together = np.zeros(len(data), dtype=np.int64)
    for check in required:
        together += failing[check]
    rows: list[dict[str, Any]] = []
    for check, fails in failing.items():
        absent = data[check + STATUS] == "not_evaluated"
        if not fails.any() and not absent.any():
            continue
        rows.append({
            "check": check,
            "title": DECLARED[check].title.format(follower="follower"),
            "must_have": check in required,
            "fail": int(fails.sum()),
            "alone": int((fails & (together == 1)).sum()) if check in required else None,
            "not_evaluated": int(absent.sum()),
            "of": int((state != UNKNOWN).sum()),
            **_greatest(data, check, fails),
        })  # fmt: skip
    return sorted(rows, key=lambda row: (-row["fail"], -row["not_evaluated"], row["check"]))


def _greatest(data: Dataset, check: str, fails: NDArray[np.bool_]) -> Answer:
    """Greatest utilisation of a check over the designs, and the number of that design; the
    utilisation is null where it is infinite, both where no design has one.

    Parameters
    ----------
    data : Dataset       of n designs
    check : str          id of the check
    fails : array (n,)   whether it fails in a design: without a number its utilisation is then
                         infinite
    """
    name = f"{check}.utilisation"
    values = data[name] if name in data.columns else np.full(len(data), np.nan)
    size = np.where(np.isnan(values), np.where(fails, np.inf, -np.inf), values)
    worst = int(np.argmax(size))
    if size[worst] == -np.inf:
        return {"utilisation_max": None, "design": None}
    return {"utilisation_max": _number(size[worst]), "design": int(data["design"][worst])}


def _number(value: float) -> float | None:
    """A number for JSON; None for NaN and infinity."""
    return float(value) if np.isfinite(value) else None


def _factor(data: Dataset, key: str, values: NDArray[Any]) -> Answer:
    """Record of a factor: key, unit, and its range or, for texts, its values."""
    record: Answer = {"key": key, "unit": data.units.get(FACTOR + key, "")}
    if np.issubdtype(values.dtype, np.number):
        known = values[np.isfinite(values)]
        ends = (float(known.min()), float(known.max())) if known.size else (None, None)
        return record | {"least": ends[0], "greatest": ends[1]}
    return record | {"values": sorted({str(value) for value in values if value})}


def _output(
    data: Dataset,
    name: str,
    values: Array,
    sample: Sample,
    factors: Mapping[str, NDArray[Any]],
) -> Answer:
    """Record of an output: mean, spread and extremes, and the effects of the factors on it.

    Parameters
    ----------
    data : Dataset        units, and numbers of the designs
    name : str            of the output
    values : array (n,)   of the n designs; NaN: none
    sample : Sample       which designs are independent
    factors : mapping     values (n,) by key
    """
    known = np.flatnonzero(np.isfinite(values))
    record: Answer = {
        "name": name, "unit": data.units.get(name, ""), "count": int(known.size),
    }  # fmt: skip
    if not known.size:
        return record | {"effects": [], "sobol": None}
    own = values[known]
    low, high = known[int(own.argmin())], known[int(own.argmax())]
    numbers = data["design"]
    record |= {
        "mean": float(own.mean()), "std": float(own.std()),
        "least": {"value": float(values[low]), "design": int(numbers[low])},
        "median": float(np.median(own)),
        "greatest": {"value": float(values[high]), "design": int(numbers[high])},
    }  # fmt: skip
    effects = {
        key: sensitivity.main_effect(column[sample.rows], values[sample.rows])
        for key, column in factors.items()
    }  # fmt: skip
    sobol = None
    if sample.blocks:
        sobol = sensitivity.sobol_indices(values[: sample.blocks], sample.factors)
    return record | {
        "effects": [_effect(key, effect) for key, effect in effects.items() if effect is not None],
        "sobol": None if sobol is None else [
            {"factor": key, "first": index.first, "first_interval": list(index.first_interval),
             "total": index.total, "total_interval": list(index.total_interval)}
            for key, index in zip(factors, sobol, strict=True)
        ],
    }  # fmt: skip


def _effect(key: str, effect: sensitivity.MainEffect) -> Answer:
    return {
        "factor": key,
        "levels": [each if isinstance(each, str) else list(each) for each in effect.levels],
        "designs": list(effect.counts),
        "means": list(effect.means),
        "standard_errors": list(effect.errors),
        "swing": effect.swing,
        "share": effect.share,
        "share_interval": list(effect.share_interval),
    }


def _front(data: Dataset, study: Study, state: NDArray[np.uint8]) -> Answer | None:
    """Record of the Pareto front of the first two objectives of a study over the designs that pass;
    None with fewer than two objectives.

    Parameters
    ----------
    state : array (n,)   `PASSES`, `FAILS` or `UNKNOWN`
    """
    objectives = study.objectives[:2]
    if len(objectives) < 2:
        return None
    known = all(each.column in data.columns for each in objectives)
    nothing = np.full(len(data), np.nan)  # a column without any value is left out of the dataset
    values = [number_column(data, o.column) if known else nothing for o in objectives]
    signed = [-v if o.goal == "max" else v for v, o in zip(values, objectives, strict=True)]
    rows = np.flatnonzero((state == PASSES) & np.isfinite(signed[0]) & np.isfinite(signed[1]))
    chosen = rows[front(list(zip(*(v[rows].tolist() for v in signed), strict=True)))]
    return {
        "objectives": [
            {"column": o.column, "unit": data.units.get(o.column, ""),
             "goal": o.goal} for o in objectives
        ],
        "designs": [
            point | {"values": [float(v[row]) for v in values]}
            for row, point in zip(chosen, _points(data, chosen), strict=True)
        ],
    }  # fmt: skip


def _points(data: Dataset, rows: NDArray[np.intp]) -> list[Answer]:
    """Record of each of the designs in these rows (k,) of the dataset: number, id, depth, factors,
    judgement.
    """
    names = ("design", "id", "depth", "screen", "verdict", "governing")
    columns = {name: data[name][rows].tolist() for name in names}
    columns["verdict"] = [word or None for word in columns["verdict"]]
    factors = {key: data[FACTOR + key][rows].tolist() for key in data.factors}
    return [
        {name: values[k] for name, values in columns.items()}
        | {"factors": {key: values[k] for key, values in factors.items()}}
        for k in range(len(rows))
    ]


def _worst(data: Dataset, utilisation: Array, state: NDArray[np.uint8]) -> Answer | None:
    """Record of the design of the greatest governing utilisation, which is null where it is
    infinite; None where no design has one.

    Parameters
    ----------
    utilisation : array (n,)   of the governing check of each design; NaN: infinite if it fails,
                               else unknown
    state : array (n,)         `PASSES`, `FAILS` or `UNKNOWN`
    """
    size = np.where(np.isnan(utilisation) & (state == FAILS), np.inf, utilisation)
    if np.isnan(size).all():
        return None
    row = int(np.nanargmax(size))
    (point,) = _points(data, np.array([row]))
    return point | {UTILISATION: _number(size[row])}
