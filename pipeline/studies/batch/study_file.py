"""Study file: base cases, factors with distributions, sampling, depth, runs to keep."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import Annotated, Literal, Self

import tomli_w
from pydantic import Field, PlainValidator, ValidationError, model_validator

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.base.quantities import Characters, In
from camwright.pipeline.case.error_text import refusal_of
from camwright.pipeline.case.section import Name, Section, Text, refusal
from camwright.pipeline.contact.tiers import Tier

STUDY_BYTES = 16 * 1024 * 1024
DESIGNS_MAX = 10_000_000
SCHEMA_VERSION = 1
INDEPENDENT = ("random", "latin_hypercube", "sobol")
"""Methods of sampling whose first designs are a sample of the distributions."""
_NUMBER_MAX = 1e300
_KEPT = re.compile(r"(|failed|pareto|best:([1-9][0-9]{0,6}))")


def _plain_value(value: object) -> str | bool | int | float:
    """The value, if it is a text of bounded length, a finite number, true or false;
    else a refusal.
    """
    if isinstance(value, str):
        try:
            Characters(1, 200).require("", value)
        except InputError as error:
            raise refusal(error.limit) from None
        return value
    if not isinstance(value, (bool, int, float)):
        raise refusal("text, a number, true or false")
    if not abs(value) <= _NUMBER_MAX:  # NaN too
        raise refusal("finite")
    return value


Value = Annotated[str | bool | int | float, PlainValidator(_plain_value)]
"""A value as in a case file: text with a unit, a finite number, a name, true or false."""
Key = Annotated[str, Characters(1, 120)]
DepthWord = Literal["screening", "preview", "cycle", "certified"]


class GridSampling(Section):
    """Equally spaced levels, both ends included."""

    low: Value
    high: Value
    count: Annotated[int, Field(ge=2, le=100_000)]


class Range(Section):
    """Uniform between two ends."""

    low: Value
    high: Value


class Normal(Section):
    """Normal distribution; a tolerance is three standard deviations."""

    mean: Value | None = None
    std: Value | None = None
    tolerance: Value | None = None

    @model_validator(mode="after")
    def _has_one_width(self) -> Self:
        """The distribution itself; InputError unless exactly one of standard deviation and
        tolerance is stated.
        """
        if (self.std is None) == (self.tolerance is None):
            count = "neither" if self.std is None else "both"
            raise InputError("std, tolerance", count, "exactly one of the two")
        return self


class Uniform(Section):
    """Uniform within mean - tolerance to mean + tolerance."""

    mean: Value | None = None
    tolerance: Value


class Triangular(Section):
    """Symmetric triangular within mean - tolerance to mean + tolerance."""

    mean: Value | None = None
    tolerance: Value


class Factor(Section):
    """A value of the case that differs between designs, by its dotted key.

    Exactly one of levels, grid, range, normal, uniform, triangular. A mean that is left out is the
    value of the base case; a tolerance or std may be a share of the mean, such as ``"5 %"``.
    """

    key: Key
    levels: Annotated[
        tuple[Value, ...] | None,
        Field(alias="list", strict=False, min_length=1, max_length=100_000),
    ] = None
    grid: GridSampling | None = None
    range: Range | None = None
    normal: Normal | None = None
    uniform: Uniform | None = None
    triangular: Triangular | None = None

    @property
    def spread(self) -> tuple[Value, ...] | GridSampling | Range | Normal | Uniform | Triangular:
        """The one entry that is given."""
        return self._given[0]

    @property
    def _given(
        self,
    ) -> list[tuple[Value, ...] | GridSampling | Range | Normal | Uniform | Triangular]:
        entries = (
            self.levels, self.grid, self.range, self.normal, self.uniform, self.triangular
        )  # fmt: skip
        return [each for each in entries if each is not None]

    @model_validator(mode="after")
    def _has_one_entry(self) -> Self:
        """The factor itself; InputError unless exactly one kind of values or distribution is
        stated.
        """
        if len(self._given) != 1:
            kinds = "list, grid, range, normal, uniform, triangular"
            raise InputError(self.key, f"{len(self._given)} entries", f"exactly one of: {kinds}")
        return self


class Correlation(Section):
    """Correlation of two factors, as the parameter of a Gaussian copula."""

    between: Annotated[tuple[Key, Key], Field(strict=False)]
    value: Annotated[float, In(above=-1, below=1)]


class Sampling(Section):
    """Method of the sampling; `count` designs, but for grid and list.

    For ``sobol_indices`` there are count * (factors + 2) designs.
    """

    method: Literal["grid", "list", "latin_hypercube", "sobol", "random", "sobol_indices"]
    seed: Annotated[int, Field(ge=0, le=2**31)] = 1
    count: Annotated[int, Field(ge=1, le=DESIGNS_MAX)] | None = None

    @model_validator(mode="after")
    def _has_a_count(self) -> Self:
        """The sampling itself; InputError for a count with a grid or list, and for none with
        another method.
        """
        discrete = self.method in ("grid", "list")
        if discrete != (self.count is None):
            word = "missing" if self.count is None else self.count
            limit = f"{'left out' if discrete else 'given'} with sampling.method = {self.method}"
            raise InputError("sampling.count", word, limit)
        return self


class Objective(Section):
    """A column to minimise or maximise; the first one ranks the designs."""

    column: Annotated[str, Characters(1, 120)]
    goal: Literal["min", "max"] = "min"


class Deeper(Section):
    """Second stage: the best, or those nearest to a limit, at a deeper depth."""

    depth: DepthWord
    take: Literal["best", "borderline"] = "best"
    count: Annotated[int, Field(ge=1, le=1_000_000)]


class StageEnd(Section):
    """Ends the first stage: after a time, or at a width of the 95 % interval of the yield.

    The yield is that of the answers: designs without a result are left out. The designs before the
    first one that is not solved stay.
    """

    time: Annotated[float, In("s", above=0, at_most=1e9)] | None = None
    interval: Annotated[float, In(above=0, below=1)] | None = None


class DesignLimits(Section):
    """Bounds of time and memory for the solution of one design."""

    time: Annotated[float, In("s", at_least=0.1, at_most=1e6)] = 600.0
    memory: Annotated[float, In("MB", at_least=10, at_most=1e6)] = 1e9

    @property
    def bytes(self) -> int:
        """Memory in bytes."""
        return int(self.memory)


class Study(Section):
    """A study: base cases, factors, sampling, depth; see docs/studies.md."""

    schema_version: Literal[1] = 1
    name: Name
    title: Text = ""
    cases: Annotated[
        tuple[Annotated[str, Characters(1, 1000)], ...],
        Field(alias="case", strict=False, min_length=1, max_length=1_000_000),
    ]
    cam: Literal["own", "base"] = "own"
    depth: DepthWord = "screening"
    positions: Annotated[int, Field(ge=36, le=7200)] | None = 180
    corners: bool = True
    factors: Annotated[
        tuple[Factor, ...], Field(alias="factor", strict=False, max_length=1000)
    ] = ()
    correlations: Annotated[
        tuple[Correlation, ...], Field(alias="correlation", strict=False, max_length=10_000)
    ] = ()
    sampling: Sampling | None = None
    outputs: Annotated[
        tuple[Annotated[str, Characters(1, 120)], ...], Field(strict=False, max_length=1000)
    ] = ()
    objectives: Annotated[
        tuple[Objective, ...], Field(alias="objective", strict=False, max_length=8)
    ] = ()
    deeper: Deeper | None = None
    stop: StageEnd | None = None
    keep: Annotated[str, Characters(0, 40)] = ""
    limits: Annotated[DesignLimits, Field(alias="design")] = DesignLimits()

    @model_validator(mode="after")
    def _agrees(self) -> Self:
        """The study itself; InputError where factors, sampling, correlations, objectives or stages
        contradict one another.
        """
        keys = [each.key for each in self.factors]
        for key in keys:
            if keys.count(key) > 1:
                raise InputError("factor.key", key, "once")
        if bool(keys) != (self.sampling is not None):
            word = "a table" if self.sampling else "missing"
            raise InputError("sampling", word, "given with factors, left out without")
        pairs = [frozenset(each.between) for each in self.correlations]
        for each in self.correlations:
            if pairs.count(frozenset(each.between)) > 1:
                raise InputError("correlation.between", ", ".join(each.between), "once")
            for key in each.between:
                if key not in keys or each.between[0] == each.between[1]:
                    raise InputError("correlation.between", key, "two different factors")
        if self.correlations and self.sampling is not None:
            method = self.sampling.method
            if method in ("grid", "list", "sobol_indices"):
                limit = 'with sampling.method = "latin_hypercube", "sobol" or "random"'
                raise InputError("correlation", method, limit)
        if self.cam == "base" and self.tier is Tier.SCREENING:
            raise InputError("depth", self.depth, 'preview or deeper with cam = "base"')
        if self.deeper is not None:
            if Tier.of(self.deeper.depth, "deeper.depth") <= self.tier:
                raise InputError("deeper.depth", self.deeper.depth, f"deeper than {self.depth}")
            if self.deeper.take == "best" and not self.objectives:
                raise InputError("objective", "missing", 'given with deeper.take = "best"')
        self._check_stop()
        self._check_keep()
        return self

    def _check_stop(self) -> None:
        """InputError for a stop by the width of the interval without independent samples of one
        case.
        """
        if self.stop is None or self.stop.interval is None:
            return
        method = self.sampling.method if self.sampling else "missing"
        if method not in INDEPENDENT:
            limit = f"left out unless sampling.method is one of {', '.join(INDEPENDENT)}"
            raise InputError("stop.interval", self.stop.interval, limit)
        if len(self.cases) > 1:
            raise InputError("stop.interval", self.stop.interval, "left out with several cases")

    def _check_keep(self) -> None:
        """InputError for an unknown word in `keep`, or one without the objectives or cams that it
        needs.
        """
        if not _KEPT.fullmatch(self.keep):
            raise InputError("keep", self.keep, 'failed, pareto, or best:N such as "best:10"')
        if self.keep and self.cam == "base":
            limit = 'left out with cam = "base": a run folder has the cam of its own values'
            raise InputError("keep", self.keep, limit)
        if self.kept[0] in ("best", "pareto") and not self.objectives:
            raise InputError("objective", "missing", f'given with keep = "{self.keep}"')

    @property
    def kept(self) -> tuple[str, int]:
        """Kind of the designs with a run folder, and their number for ``best``."""
        kind, _, count = self.keep.partition(":")
        return kind, int(count or 0)

    @property
    def tier(self) -> Tier:
        """Depth of the first stage."""
        return Tier.of(self.depth, "depth")


def read_study(path: Path) -> Study:
    """Study read from its file and checked; the cases are not read.

    Raises
    ------
    InputError
        For the first error, by its dotted name.
    """
    tables = read_study_tables(path)
    version = tables.get("schema_version", SCHEMA_VERSION)
    if version != SCHEMA_VERSION:
        limit = f"{SCHEMA_VERSION}, the version of this program"
        raise InputError("schema_version", str(version)[:40], limit)
    if isinstance(tables.get("case"), str):
        tables["case"] = [tables["case"]]
    return study_of(tables)


def study_of(tables: dict[str, object]) -> Study:
    """A study from its tables.

    Raises
    ------
    InputError
        For the first error, by its dotted name.
    """
    try:
        return Study.model_validate(tables)
    except ValidationError as error:
        raise refusal_of(error) from None


def read_study_tables(path: Path) -> dict[str, object]:
    """Tables of a study or case file.

    Raises
    ------
    InputError
        If it cannot be read.
    """
    return read_toml(path, f"study {path}", STUDY_BYTES)


def case_path(folder: Path, name: str) -> Path:
    """Path of a case, relative to the folder of the study file.

    Raises
    ------
    InputError
        If the name is absolute, or is no file.
    """
    if PurePosixPath(name).is_absolute() or "\\" in name or ":" in name or "\0" in name:
        raise InputError("case", name, "a path relative to the study file")
    try:
        path = (folder / name).resolve()
        readable = path.is_file()
    except (OSError, RuntimeError):
        readable = False
    if not readable:
        raise InputError("case", name, "an existing file")
    return path


def chosen_study(files: Sequence[Path], depth: str | None) -> tuple[Study, str, Path]:
    """Study of a command's arguments: a study file, or one made from case files.

    Parameters
    ----------
    files : sequence   one study file, or case files
    depth : str        of case files; None: preview

    Returns
    -------
    study : Study
    text : str      of the study file
    folder : Path   from which its cases are read

    Raises
    ------
    InputError
        If there are several files and one is a study, or the study is refused.
    """
    studies = [path for path in files if "case" in read_study_tables(path)]
    if not studies:
        return _of_cases(files, depth or "preview")
    if len(files) > 1:
        raise InputError("FILE", str(studies[0]), "one study file, or case files")
    if depth is not None:
        raise InputError("--depth", depth, "left out, as the study file states it")
    path = studies[0]
    study = read_study(path)
    return study, path.read_text(encoding="utf-8-sig"), path.resolve().parent


def _of_cases(files: Sequence[Path], depth: str) -> tuple[Study, str, Path]:
    """Study of case files without factors: the study, its text, and the folder common
    to the cases.
    """
    paths = [path.resolve() for path in files]
    folder = Path(os.path.commonpath([path.parent for path in paths]))
    names = [path.relative_to(folder).as_posix() for path in paths]
    tables: dict[str, object] = {"name": "cases", "case": names, "depth": depth}
    return study_of(tables), tomli_w.dumps(tables), folder
