"""Study file: refusals by field, value and limit; axes, sampling, ids of designs."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

from camwright.geometry.errors import InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.studies.batch.case_template import read_templates
from camwright.pipeline.studies.batch.design_plan import SHARD_OF, Plan
from camwright.pipeline.studies.batch.design_solver import DesignSolver
from camwright.pipeline.studies.batch.design_task import Settings
from camwright.pipeline.studies.batch.factor_axes import Axis, axis_of
from camwright.pipeline.studies.batch.sampling import SampledDesigns, designs_of, unit_cube
from camwright.pipeline.studies.batch.study_file import (
    Correlation,
    Factor,
    Sampling,
    chosen_study,
    read_study,
    study_of,
)
from camwright.pipeline.studies.batch.study_run import planned

ROOT = Path(__file__).resolve().parents[2]
CASE = read_case(ROOT / "cases" / "gx120.toml")
RATE = {"key": "spring.rate", "range": {"low": "20 kN/m", "high": "30 kN/m"}}
PRELOAD = {"key": "spring.preload", "normal": {"tolerance": "30 N"}}
BASE: dict[str, Any] = {
    "name": "trial",
    "case": ["case.toml"],
    "factor": [RATE],
    "sampling": {"method": "sobol", "count": 8},
}


@pytest.mark.parametrize("path", sorted((ROOT / "studies").glob("*.toml")), ids=lambda p: p.stem)
def test_a_shipped_study_has_designs(path: Path) -> None:
    study = read_study(path)
    assert study.sampling is not None
    case = read_case(path.parent / study.cases[0])
    axes = [axis_of(factor, case) for factor in study.factors]
    designs = designs_of(axes, study.sampling, study.correlations)
    assert designs.count == (study.sampling.count or designs.count) >= 5


@pytest.mark.parametrize(
    ("change", "field", "limit"),
    [
        ({"depht": "preview"}, "depht", "did you mean depth"),
        ({"depth": "deep"}, "depth", "screening"),
        ({"factor": [RATE, RATE]}, "factor.key", "once"),
        ({"factor": [{"key": "spring.rate"}]}, "spring.rate", "exactly one of"),
        ({"factor": [RATE | {"list": ["1 N"]}]}, "spring.rate", "exactly one of"),
        ({"sampling": {"method": "sobol"}}, "sampling.count", "given with"),
        ({"sampling": {"method": "grid", "count": 3}}, "sampling.count", "left out"),
        ({"sampling": {"method": "sobol", "count": 0}}, "sampling.count", ">= 1"),
        ({"sampling": None}, "sampling", "given with factors"),
        ({"cam": "base"}, "depth", "preview or deeper"),
        ({"keep": "best"}, "keep", "best:N"),
        ({"keep": "best:3"}, "objective", "given with keep"),
        ({"deeper": {"depth": "screening", "count": 3}}, "deeper.depth", "deeper than"),
        ({"deeper": {"depth": "cycle", "count": 3}}, "objective", "given with deeper"),
        ({"stop": {"interval": 2.0}}, "stop.interval", "< 1"),
        ({"design": {"time": "10 mm"}}, "design.time", "must be"),
        ({"stop": {"interval": math.nan}}, "stop.interval", "finite"),
        (
            {"stop": {"interval": 0.1}, "sampling": {"method": "sobol_indices", "count": 8}},
            "stop.interval", "left out unless sampling.method",
        ),
        ({"stop": {"interval": 0.1}, "case": ["a.toml", "b.toml"]}, "stop.interval", "several"),
        ({"keep": "failed:3"}, "keep", "best:N"),
        ({"keep": "best:\u0663"}, "keep", "best:N"),
        ({"keep": "failed", "cam": "base", "depth": "preview"}, "keep", 'cam = "base"'),
        ({"sampling": {"method": "sobol", "count": 10**12}}, "sampling.count", "<= 10000000"),
        ({"sampling": {"method": "sobol", "count": 8, "seed": -1}}, "sampling.seed", ">= 0"),
        (
            {"factor": [{"key": "cam.width", "grid": {"low": 1, "high": 2, "count": 10**9}}]},
            "factor[0].grid.count", "<= 100000",
        ),
        ({"factor": [{"key": "cam.width", "list": []}]}, "factor[0].list", "at least 1"),
        ({"factor": [{"key": "cam.width", "list": [[1]]}]}, "factor[0].list[0]", "text, a number"),
        ({"factor": [{"key": "cam.width", "list": [math.nan]}]}, "factor[0].list[0]", "finite"),
        ({"factor": [{"key": "cam.width", "list": [10**400]}]}, "factor[0].list[0]", "finite"),
        (
            {"factor": [{"key": "cam.width", "range": {"low": 0, "high": math.inf}}]},
            "factor[0].range.high", "finite",
        ),
        ({"case": []}, "case", "at least"),
        (
            {"factor": [RATE, PRELOAD], "correlation": [
                {"between": ["spring.rate", "spring.preload"], "value": 0.5},
                {"between": ["spring.preload", "spring.rate"], "value": 0.1},
            ]},
            "correlation.between", "once",
        ),
        (
            {"correlation": [{"between": ["spring.rate", "cam.width"], "value": 0.5}]},
            "correlation.between", "two different factors",
        ),
        (
            {"correlation": [{"between": ["spring.rate", "spring.rate"], "value": 1.0}]},
            "correlation[0].value", "< 1",
        ),
    ],
)  # fmt: skip
def test_a_refusal_names_field_and_limit(change: dict[str, Any], field: str, limit: str) -> None:
    tables = {key: value for key, value in (BASE | change).items() if value is not None}
    with pytest.raises(InputError) as refused:
        study_of(tables)
    assert field in str(refused.value)
    assert limit in str(refused.value)


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        ({"key": "spring.rat", "list": ["1 N"]}, "did you mean rate"),
        ({"key": "spring.rate", "list": ["24 mm"]}, "dimension of kN/m"),
        ({"key": "spring.rate", "list": [24.0]}, "a number with a unit"),
        ({"key": "spring.rate", "range": {"low": "3 N/m", "high": "2 N/m"}}, "> 3 N/m"),
        ({"key": "spring.rate", "normal": {"std": "0 N/m"}}, "> 0"),
        ({"key": "spring.travel_max", "normal": {"std": "1 mm"}}, "no such number"),
        ({"key": "cam.material", "range": {"low": 0, "high": 1}}, "a list of values"),
        ({"key": "spring.design.card", "list": ["a"]}, "a key of the case file"),
        ({"key": "<b>rate</b>", "list": [1]}, "a dotted key"),
        ({"key": "name", "list": ["<script>", "../../x"]}, "none of schema_version, name"),
        ({"key": "solver.positions", "list": [10**9]}, "none of"),
        ({"key": "spring", "list": [1]}, "a value, not a table"),
        ({"key": "load_case[0]", "list": [1]}, "a value, not a table"),
        ({"key": "load_case[9].speed", "list": ["1 rpm"]}, "a table that the case has"),
        ({"key": "load_case[00].speed", "list": ["1 rpm"]}, "a dotted key"),
        ({"key": "spring.rate", "normal": {"tolerance": "1.2.3 %"}}, "spring.rate = 1.2.3 %"),
        ({"key": "spring.rate", "normal": {"tolerance": "1e999 %"}}, "> 0"),
        ({"key": "spring.rate", "list": ["nan N/m"]}, "finite"),
    ],
)
def test_a_factor_that_does_not_fit_the_case_is_refused(factor: Any, words: str) -> None:
    with pytest.raises(InputError, match="factor") as refused:
        axis_of(Factor.model_validate(factor), CASE)
    assert words in str(refused.value)


@pytest.mark.parametrize("name", ["/etc/passwd", "C:case.toml", "missing.toml", "a\\b", "\0"])
def test_a_case_outside_or_missing_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="case = "):
        read_templates(tmp_path, [name])


@pytest.mark.parametrize("text", ["\xff\xfe", "name = [", "[[" * 5000, "name = 3"])
def test_a_file_that_is_no_study_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(InputError):
        read_study(path)


def test_case_files_are_a_study(tmp_path: Path) -> None:
    cases = [ROOT / "cases" / "gx120.toml", ROOT / "cases" / "papers" / "eccentric.toml"]
    study, text, folder = chosen_study(cases, None)
    assert (study.cases, folder) == (("gx120.toml", "papers/eccentric.toml"), ROOT / "cases")
    assert study.tier is Tier.PREVIEW and "papers/eccentric.toml" in text
    with pytest.raises(InputError, match="one study file"):
        chosen_study([*cases, ROOT / "studies" / "preload.toml"], None)


def _axis(**entries: Any) -> Any:
    return axis_of(Factor.model_validate(entries), CASE)


def test_levels_are_read_as_in_a_case_file() -> None:
    axis = _axis(key="cam.prime_radius", list=["48.1 mm", "0.05 m"])
    assert axis.unit == "mm"
    np.testing.assert_allclose(axis.levels, [48.1, 50.0], rtol=1e-15)
    np.testing.assert_array_equal(axis.si(np.array([48.1])), [0.0481])
    grid = _axis(key="cam.prime_radius", grid={"low": "48 mm", "high": "49 mm", "count": 11})
    assert grid.levels[1] == 48.1  # not 48.099999999999994
    assert _axis(key="smoothing.points", list=[6, 12]).levels == (6, 12)
    assert _axis(key="cam.material", list=["c45", "s355"]).unit is None


def test_distributions_are_those_of_scipy() -> None:
    """Quantiles against scipy.stats; 1e-12 is round-off."""
    share = np.linspace(0.01, 0.99, 25)
    normal = _axis(key="spring.preload", normal={"tolerance": "30 N"})
    np.testing.assert_allclose(normal.at(share), stats.norm(242, 10).ppf(share), rtol=1e-12)
    share_of = _axis(key="spring.preload", normal={"mean": "200 N", "std": "5 %"})
    np.testing.assert_allclose(share_of.at(share), stats.norm(200, 10).ppf(share), rtol=1e-12)
    uniform = _axis(key="spring.preload", uniform={"mean": "200 N", "tolerance": "8 N"})
    np.testing.assert_allclose(uniform.at(share), stats.uniform(192, 16).ppf(share), rtol=1e-12)
    triangular = _axis(key="spring.preload", triangular={"mean": "200 N", "tolerance": "8 N"})
    expected = stats.triang(0.5, 192, 16).ppf(share)
    np.testing.assert_allclose(triangular.at(share), expected, rtol=1e-12)


@pytest.mark.parametrize("method", ["latin_hypercube", "sobol", "random", "sobol_indices"])
def test_the_same_seed_gives_the_same_designs(method: str) -> None:
    axes = [_axis(**RATE), _axis(**PRELOAD), _axis(key="cam.width", list=["5 mm", "6 mm"])]

    def drawn(seed: int) -> SampledDesigns:
        table = {"method": method, "count": 16, "seed": seed}
        return designs_of(axes, Sampling.model_validate(table))

    one, other = drawn(3), drawn(4)
    rows = 16 * 5 if method == "sobol_indices" else 16
    assert one.count == rows
    for key, values in one.columns.items():
        np.testing.assert_array_equal(values, drawn(3).columns[key])
        assert np.isfinite(np.asarray(values)).all()
    assert np.any(one.columns["spring.rate"] != other.columns["spring.rate"])
    assert set(np.asarray(one.columns["cam.width"]).tolist()) == {5.0, 6.0}


@pytest.mark.parametrize("method", ["latin_hypercube", "sobol"])
def test_a_sample_kept_on_disk_is_that_of_scipy(
    method: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(disk_cache.FOLDER, str(tmp_path))
    draw = {"sobol": stats.qmc.Sobol, "latin_hypercube": stats.qmc.LatinHypercube}[method]
    wanted = draw(3, rng=np.random.default_rng(5)).random(16)
    sampling = Sampling.model_validate({"method": method, "count": 16, "seed": 5})
    for _ in ("drawn", "read"):
        np.testing.assert_array_equal(unit_cube(3, sampling), wanted)
    assert len(list(tmp_path.glob("cube-*.npz"))) == 1


def test_correlated_factors_have_the_stated_correlation() -> None:
    """Of 4000 samples within 0.03: two standard errors of 0.8 are 0.011."""
    axes = [_axis(**PRELOAD), _axis(key="spring.rate", normal={"tolerance": "1 kN/m"})]
    stated = Correlation(between=("spring.preload", "spring.rate"), value=0.8)
    table = {"method": "latin_hypercube", "count": 4000}
    made = designs_of(axes, Sampling.model_validate(table), [stated]).columns
    matrix = np.corrcoef(np.asarray(made["spring.preload"]), np.asarray(made["spring.rate"]))
    assert abs(matrix[0, 1] - 0.8) < 0.03
    assert abs(np.std(made["spring.preload"]) - 10.0) < 0.5


def test_impossible_correlations_are_refused() -> None:
    keys = ("spring.preload", "spring.rate", "cam.prime_radius")
    axes = [_axis(key=key, normal={"tolerance": "1 %"}) for key in keys]
    pairs = [(0, 1, 0.9), (1, 2, 0.9), (0, 2, -0.9)]
    stated = [Correlation(between=(keys[i], keys[j]), value=v) for i, j, v in pairs]
    with pytest.raises(InputError, match="positive definite"):
        designs_of(axes, Sampling(method="random", count=4), stated)


def test_grid_and_list() -> None:
    axes = [
        _axis(key="cam.width", list=["5 mm", "6 mm"]),
        _axis(key="cam.material", list=["c45", "s355", "nylon"]),
    ]
    grid = designs_of(axes, Sampling(method="grid"))
    assert grid.columns["cam.material"] == ("c45", "s355", "nylon") * 2
    np.testing.assert_array_equal(grid.columns["cam.width"], [5, 5, 5, 6, 6, 6])
    three = [*axes, _axis(key="cam.prime_radius", list=["50 mm", "51 mm"])]
    product = itertools.product(*(each.levels for each in three))
    made = designs_of(three, Sampling(method="grid")).columns
    assert list(zip(*(list(made[each.key]) for each in three), strict=True)) == list(product)
    with pytest.raises(InputError, match="lists of one length"):
        designs_of(axes, Sampling(method="list"))
    with pytest.raises(InputError, match="list or grid"):
        designs_of([_axis(**RATE)], Sampling(method="grid"))


@pytest.mark.parametrize(
    ("count", "sampling", "words"),
    [
        (20, {"method": "sobol_indices", "count": 2**20}, "23068672 designs of 20 factors"),
        (20, {"method": "random", "count": 10**7}, "10000000 designs of 20 factors"),
        (3, {"method": "grid"}, "grid of 1000 x 1000 x 1000 designs"),
        (400, {"method": "grid"}, "grid of 1000 x 1000 x"),
    ],
)
def test_a_sample_beyond_the_memory_is_refused(
    count: int, sampling: dict[str, Any], words: str
) -> None:
    levels = tuple(range(1000)) if sampling["method"] == "grid" else ()
    axes = [Axis(f"key{k}", "", levels, "uniform", 0.0, 1.0) for k in range(count)]
    with pytest.raises(InputError, match=r"sampling = .* <= 10000000 designs") as refused:
        designs_of(axes, Sampling.model_validate(sampling))
    assert words in str(refused.value)


@pytest.mark.parametrize(
    "column", ["headline.nothing", "message", "design", "factor.cam.width", "pressure_angle.status"]
)
def test_an_objective_is_a_column_of_numbers(column: str) -> None:
    study = study_of(BASE | {"objective": [{"column": column}]})
    with pytest.raises(InputError, match=f"objective.column = {column}"):
        planned(study, read_templates(ROOT / "cases", ["gx120.toml"]))


def test_an_objective_stays_among_the_outputs() -> None:
    column = "headline.lift_max_mm"
    study = study_of(BASE | {"outputs": ["mesh.*"], "objective": [{"column": column}]})
    plan = planned(study, read_templates(ROOT / "cases", ["gx120.toml"]))
    assert plan.settings.outputs == ("mesh.*", column)


def test_designs_of_a_study_that_stops_are_the_first_ones() -> None:
    """Numbers 0 to 5 are of the unique designs 0, 1, 0, 2, 1, 3."""
    levels = ["5 mm", "6 mm", "5 mm", "7 mm", "6 mm", "8 mm"]
    plan = Plan.of(
        ["a"], designs_of([_axis(key="cam.width", list=levels)], Sampling(method="list")),
        _settings(),
    )  # fmt: skip
    assert plan.place.tolist() == [0, 1, 0, 2, 1, 3]
    assert [plan.whole(unique) for unique in range(5)] == [0, 1, 3, 5, 6]


def test_a_design_of_a_changed_case_has_another_id() -> None:
    """A run folder is named by it: that of the earlier case is not taken."""
    designs = designs_of([_axis(**RATE)], Sampling(method="sobol", count=4))
    ids = [Plan.of(["a"], designs, _settings(templates={"a": name})).ids for name in "12"]
    assert not set(ids[0]) & set(ids[1])


def test_the_message_of_a_row_has_no_path_of_the_machine() -> None:
    """Cases are unpacked into a folder of another name each time."""
    factor = {"key": "load_case[0].torque", "list": ["none.csv"]}
    study = study_of(BASE | {"factor": [factor], "sampling": {"method": "list"}})
    templates = read_templates(ROOT / "cases", ["gx120.toml"])
    plan = planned(study, templates)
    (task,) = plan.tasks(Tier.PREVIEW)
    row = DesignSolver(templates, plan.settings).solved(task, 0)
    assert row["message"] == "load_case[0].torque = none.csv, must be an existing file"


def _settings(**change: Any) -> Settings:
    values: dict[str, Any] = {
        "templates": {"a": "1", "b": "2"}, "versions": {}, "cam": "own", "positions": 36,
        "corners": False, "outputs": (), "seconds": 1.0, "bytes": 1,
    }  # fmt: skip
    return Settings(**(values | change))


def test_equal_designs_are_solved_once() -> None:
    axis = _axis(key="cam.width", list=["5 mm", "6 mm", "0.5 cm"])
    plan = Plan.of(["a"], designs_of([axis], Sampling(method="list")), _settings())
    assert plan.place.tolist() == [0, 1, 0]
    first, second = plan.tasks(Tier.PREVIEW)
    assert (*first.ids, *second.ids) == plan.ids and len(plan.ids) == 2
    assert second.value_of(0) == {"cam.width": 0.006}


def test_a_shard_is_named_by_all_that_its_rows_depend_on() -> None:
    designs = designs_of([_axis(**RATE)], Sampling(method="sobol", count=25))
    plan = Plan.of(["a", "b"], designs, _settings())
    tasks = list(plan.tasks(Tier.PREVIEW))
    sizes = [len(task.ids) for task in tasks]
    assert sizes[:5] == [5] * 5 and sizes[-6:] == [1] * 6 and SHARD_OF[Tier.PREVIEW] == 5
    assert sizes == sorted(sizes, reverse=True) and sum(sizes) == 50
    assert [name for task in tasks for name in task.ids] == list(plan.ids)
    names = {task.name for task in tasks}
    assert len(names) == len(tasks)
    for change in ({"positions": 72}, {"seconds": 2.0}, {"templates": {"a": "3", "b": "4"}}):
        other = Plan.of(["a", "b"], designs, _settings(**change))
        assert not names & {task.name for task in other.tasks(Tier.PREVIEW)}
    assert not names & {task.name for task in plan.tasks(Tier.CYCLE)}
