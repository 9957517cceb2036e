"""Dataset of a study: schema, nulls, damaged shards, order of the rows, selection."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camwright.geometry.errors import ResultError
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.studies.batch import study_run
from camwright.pipeline.studies.batch.answers_yield import FAILS, PASSES, UNKNOWN
from camwright.pipeline.studies.batch.dataset import (
    DATASET,
    column_of,
    joined,
    parquet_bytes,
    read_dataset,
    table_from,
    table_of,
    values_of,
)
from camwright.pipeline.studies.batch.row_selection import RowFigures, states_in
from camwright.pipeline.studies.batch.study_file import Objective
from camwright.pipeline.studies.batch.study_folder import Shard, StudyFolder

UNITS = {"spring.rate": "kN/m", "cam.material": None}


def rows(ids: str, **columns: Any) -> dict[str, Any]:
    """Rows of designs of one letter each."""
    count = len(ids)
    fixed = {"depth": ["preview"] * count, "screen": ["open"] * count}
    empty = {name: [None] * count for name in ("verdict", "governing", "message")}
    return {"id": list(ids), **empty, **fixed, **columns}


def test_columns_have_unit_meaning_and_order() -> None:
    made = rows(
        "ab",
        **{
            "contact_pressure.status": ["pass", "fail"],
            "contact_pressure.demand": [1.0, np.inf],
            "headline.p0_max_MPa": [None, np.nan],
            "factor.cam.material": ["c45", "s355"],
            "factor.spring.rate": np.array([24.2, 25.0]),
        },
    )
    table = table_of(made, UNITS)
    assert table.column_names == [
        "id", "depth", "screen", "verdict", "governing", "message",
        "factor.cam.material", "factor.spring.rate",
        "contact_pressure.demand", "contact_pressure.status",
    ]  # fmt: skip
    field = table.schema.field("factor.spring.rate")
    assert field.metadata[b"unit"] == b"kN/m"
    assert table["contact_pressure.demand"].to_pylist() == [1.0, None]
    assert parquet_bytes(table) == parquet_bytes(table_of(made, UNITS))
    with pytest.raises(ResultError, match="unknown"):
        column_of("no_check.demand", {})


def test_shards_below_one_another_are_one_shard() -> None:
    both = rows("ab", **{"headline.lift_max_mm": [1.0, 2.0], "mesh.nodes": [None, 3.0]})
    first = rows("a", **{"headline.lift_max_mm": [1.0], "mesh.nodes": [None]})
    second = rows("b", **{"headline.lift_max_mm": [2.0], "mesh.nodes": [3.0]})
    parts = [table_from(parquet_bytes(table_of(each, UNITS))) for each in (first, second)]
    assert parquet_bytes(joined(parts)) == parquet_bytes(table_of(both, UNITS))


def _folder(path: Path) -> tuple[StudyFolder, list[Shard]]:
    home = StudyFolder(path, resume=True)
    shards = [Shard("one", ("a", "b")), Shard("two", ("c",))]
    for shard, lift in zip(shards, ([1.0, 2.0], [3.0]), strict=True):
        table = table_of(rows("".join(shard.ids), **{"headline.lift_max_mm": lift}), UNITS)
        home.write_shard(shard.name, parquet_bytes(table), b"")
    return home, shards


def test_the_dataset_has_the_rows_of_all_designs_in_their_order(tmp_path: Path) -> None:
    home, shards = _folder(tmp_path)
    deeper = [Shard("three", ("b",))]
    made = rows("b", depth=["cycle"], **{"mesh.nodes": [7.0]})
    home.write_shard("three", parquet_bytes(table_of(made, UNITS)), b"")
    home.write_dataset(np.array([2, 0, 1, 1, 0]), shards, deeper, ("a", "b", "c"))
    data = read_dataset(tmp_path)
    assert "".join(data["id"]) == "cabba"
    assert data["design"].tolist() == [0, 1, 2, 3, 4]
    assert data["depth"].tolist() == ["preview", "preview", "cycle", "cycle", "preview"]
    np.testing.assert_array_equal(data["headline.lift_max_mm"], [3.0, 1.0, np.nan, np.nan, 1.0])
    np.testing.assert_array_equal(data["mesh.nodes"], [np.nan, np.nan, 7.0, 7.0, np.nan])
    with pytest.raises(ResultError, match=r"column cake is missing"):
        data["cake"]


def test_blocks_of_rows_are_as_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from camwright.pipeline.studies.batch import study_folder

    home, shards = _folder(tmp_path)
    monkeypatch.setattr(study_folder, "_BLOCK", 2)
    home.write_dataset(np.array([2, 0, 1, 1, 0]), shards, [], ("a", "b", "c"))
    assert "".join(read_dataset(tmp_path)["id"]) == "cabba"
    home.write_dataset(np.array([0, 1]), shards[:1], [], ("a", "b", "c"))
    assert "".join(read_dataset(tmp_path)["id"]) == "ab"  # of a study that stopped


@pytest.mark.parametrize("damage", ["bit", "cut", "other", "text", "column", "type", "screen"])
def test_a_damaged_shard_is_not_taken(tmp_path: Path, damage: str) -> None:
    home, shards = _folder(tmp_path)
    assert home.read_whole(shards[0]) is not None
    path = tmp_path / "shards" / "one.parquet"
    content = bytearray(path.read_bytes())
    if damage == "bit":
        content[len(content) // 8] ^= 1
    elif damage == "cut":
        del content[len(content) // 2 :]
    elif damage == "text":
        content[:] = b"no Parquet"
    elif damage in ("column", "type", "screen"):  # whole, and of no study
        table = table_from(bytes(content))
        place = table.column_names.index("screen")
        number = pa.array([1.0, 2.0])
        if damage == "column":
            table = table.append_column("no_check.demand", number)
        elif damage == "type":
            table = table.set_column(place, "screen", number)
        else:
            table = table.remove_column(place)
        content[:] = parquet_bytes(table)
    else:
        content[:] = (tmp_path / "shards" / "two.parquet").read_bytes()
    path.write_bytes(content)
    assert home.read_whole(shards[0]) is None
    assert not path.exists()


@settings(max_examples=60, deadline=None)
@given(st.data())
def test_a_shard_that_is_cut_or_altered_is_never_another(data: st.DataObject) -> None:
    with tempfile.TemporaryDirectory() as place:
        home, shards = _folder(Path(place))
        path, true = Path(place) / "shards" / "one.parquet", home.read_whole(shards[0])
        content = bytearray(path.read_bytes())
        at = data.draw(st.integers(0, len(content) - 1))
        if data.draw(st.booleans()):
            del content[at:]
        else:
            content[at] ^= data.draw(st.integers(1, 255))
        path.write_bytes(content)
        rows = home.read_whole(shards[0])
        assert path.exists() is (rows is not None)
        assert rows is None or rows["id"] == true["id"]
        home.write_shard("one", parquet_bytes(true), b"")
        assert home.read_whole(shards[0]).equals(true)


def test_a_folder_is_written_by_one_study_at_a_time(tmp_path: Path) -> None:
    with StudyFolder(tmp_path / "s", resume=False) as home:
        home.write_inputs("x = 1\n", ())
        with (
            pytest.raises(ResultError, match="another study"),
            StudyFolder(tmp_path / "s", resume=True),
        ):
            pass
    with pytest.raises(ResultError, match="--resume"), StudyFolder(tmp_path / "s", resume=False):
        pass


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("thesis.doc", r"holds thesis\.doc, which is not of a study"),
        ("cases/gx120.toml", "holds cases and no shards: not a study"),
        ("study.toml", r"holds study\.toml and no shards: not a study"),
    ],
)
def test_a_folder_of_the_user_stays_as_it_is(tmp_path: Path, name: str, words: str) -> None:
    own = tmp_path / "own" / name
    own.parent.mkdir(parents=True)
    own.write_text("mine")
    with pytest.raises(ResultError, match=words), StudyFolder(tmp_path / "own", resume=True):
        pass
    assert [each for each in tmp_path.rglob("*") if each.is_file()] == [own]


@pytest.mark.parametrize("name", ["shards", "cases", "runs", ".lock", "study.toml"])
def test_nothing_is_written_through_a_link(tmp_path: Path, name: str) -> None:
    """A link in a study folder to a place outside of it."""
    outside = tmp_path / "outside"
    outside.mkdir()
    (outside / "mine").write_text("mine")
    with StudyFolder(tmp_path / "s", resume=False) as home:
        home.write_inputs("x = 1\n", ())
    target = outside / "mine" if name in (".lock", "study.toml") else outside
    place = tmp_path / "s" / name
    if place.is_dir():
        place.rmdir()
    place.unlink(missing_ok=True)
    place.symlink_to(target)
    with (
        pytest.raises(ResultError, match=rf"{name}: is a link"),
        StudyFolder(home.path, resume=True),
    ):
        pass
    assert [each.read_text() for each in outside.iterdir()] == ["mine"]


@pytest.mark.parametrize(
    "text",
    ["", "[]", "{}", '{"versions": 3}', '{"versions": {"camwright": []}}', "\xff", "[" * 9999],
)
def test_a_damaged_run_is_not_taken(tmp_path: Path, text: str) -> None:
    home = StudyFolder(tmp_path, resume=True)
    run = tmp_path / "runs" / "a" / "run.json"
    run.parent.mkdir(parents=True)
    whole = {"versions": {"camwright": "1"}, "depth": "preview"}
    run.write_text(json.dumps(whole))
    assert home.holds_run("a", "preview", {"camwright": "1", "numpy": "2"})
    assert not home.holds_run("a", "cycle", {"camwright": "1"})
    assert not home.holds_run("a", "preview", {"camwright": "2"})
    run.write_bytes(text.encode("latin-1"))
    assert not home.holds_run("a", "preview", {"camwright": "1"})


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"screen": None}, "column screen is missing"),
        ({"design": ["1", "2"]}, "column design holds string"),
        ({"governing": [1.0, 2.0]}, "column governing holds double"),
        ({"pressure_angle.utilisation": ["a", "b"]}, "holds string"),
        ({"headline.lift_max_mm": [[1.0], [2.0]]}, "holds list"),
        ({"<b>": [1.0, 2.0]}, "column <b> is unknown"),
    ],
)
def test_a_table_that_is_no_dataset_is_refused(
    tmp_path: Path, change: dict[str, Any], words: str
) -> None:
    columns: dict[str, Any] = {"design": [0, 1], **rows("ab")} | change
    known = {name: values for name, values in columns.items() if values is not None}
    texts = {name: pa.array(values, pa.string()) for name, values in known.items()
             if values == [None, None]}  # fmt: skip
    pq.write_table(pa.table(known | texts), tmp_path / DATASET)
    with pytest.raises(ResultError, match=words):
        read_dataset(tmp_path)


def test_a_full_disk_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    home, shards = _folder(tmp_path)

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(ResultError, match="No space left"):
        home.write_dataset(np.array([0]), shards, [], ("a", "b", "c"))
    with pytest.raises(ResultError, match="No space left"):
        home.write_shard("four", b"rows", b"clock")
    assert not (tmp_path / DATASET).exists() and not list(tmp_path.rglob("*.tmp"))


def test_the_progress_line_counts_the_failures_of_its_stage(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One of three designs fails in the first stage, another one in the second."""
    monkeypatch.setattr(study_run, "_NOTE_EVERY_S", 0.0)
    home, notes = StudyFolder(tmp_path, resume=True), []
    progress = SimpleNamespace(advance=lambda *_: None, note=notes.append)
    plan = SimpleNamespace(ids="abc")
    run = SimpleNamespace(home=home, figures=RowFigures(()), progress=progress, plan=plan)
    for name, screens in (("abc", ["fail", "error", "open"]), ("c", ["fail"])):
        table = table_of(rows(name, screen=screens), UNITS)
        home.write_shard(name, parquet_bytes(table), b"")
        watch = study_run._Watch(run, len(name), None)  # type: ignore[arg-type]
        watch.expect(Shard(name, tuple(name)))
        watch.take(Shard(name, tuple(name)), table)
    words = [each.rpartition(",")[0] for each in notes]
    assert words == ["1 of 3 fail, 1 without result", "1 of 1 fail, 0 without result"]


def test_selection() -> None:
    goals = (Objective(column="headline.lift_max_mm"), Objective(column="mesh.nodes", goal="max"))
    figures = RowFigures(goals)
    table = table_of(
        rows(
            "abcde",
            screen=["open", "open", "fail", "open", "error"],
            governing=["pressure_angle"] * 3 + [None, None],
            **{
                "headline.lift_max_mm": [3.0, 1.0, 0.0, 2.0, None],
                "mesh.nodes": [9.0, 1.0, 9.0, 0.5, None],
                "pressure_angle.utilisation": [0.5, 0.9, 1.05, None, None],
            },
        ),
        UNITS,
    )
    figures.add(table)
    assert figures.best(2) == ["b", "d"]
    assert figures.borderline(2) == ["c", "b"]
    assert figures.front() == ["b", "a"]
    assert figures.failed() == ["c"] == figures.kept("failed", 0)  # "e" has no run
    assert figures.record()["screen"] == {"error": 1, "fail": 1, "open": 3}
    assert states_in(table).tolist() == [PASSES, PASSES, FAILS, PASSES, UNKNOWN]
    figures.keep({"a"})
    assert figures.best(2) == ["a"]


def _solved(values: Mapping[str, tuple[float, float]], depth: str = "cycle") -> RowFigures:
    goals = (Objective(column="headline.lift_max_mm"), Objective(column="mesh.nodes", goal="max"))
    figures = RowFigures(goals)
    lifts, nodes = zip(*values.values(), strict=True)
    count = len(values)
    columns = {"headline.lift_max_mm": list(lifts), "mesh.nodes": list(nodes)}
    made = rows("".join(values), screen=["open"] * count, depth=[depth] * count, **columns)
    figures.add(table_of(made, UNITS))
    return figures


@pytest.mark.parametrize(
    ("kind", "count", "screen", "cells", "takes"),
    [
        ("failed", 0, "fail", {}, True),
        ("failed", 0, "open", {}, False),
        ("best", 3, "open", {"headline.lift_max_mm": 9.0}, True),  # there are two so far
        ("best", 2, "open", {"headline.lift_max_mm": 1.9}, True),
        ("best", 2, "open", {"headline.lift_max_mm": 2.0}, True),  # as good as the last
        ("best", 2, "open", {"headline.lift_max_mm": 2.1}, False),
        ("best", 2, "fail", {"headline.lift_max_mm": 1.0}, False),
        ("best", 2, "open", {"headline.lift_max_mm": None}, False),
        ("best", 2, "open", {}, True),  # a factor, which is no cell
        ("pareto", 0, "open", {"headline.lift_max_mm": 1.5, "mesh.nodes": 6.0}, True),
        ("pareto", 0, "open", {"headline.lift_max_mm": 1.5, "mesh.nodes": 4.0}, False),
        ("pareto", 0, "open", {"headline.lift_max_mm": 2.0, "mesh.nodes": 9.0}, True),  # equal
    ],
)
def test_runs_are_made_of_designs_that_none_before_excludes(
    kind: str, count: int, screen: str, cells: dict[str, Any], takes: bool
) -> None:
    figures = _solved({"a": (1.0, 5.0), "b": (2.0, 9.0)})
    assert figures.of(Tier.CYCLE).wanted(kind, count).takes(screen, cells) is takes
    earlier = figures.of(Tier.PREVIEW).wanted(kind, count)  # rows of another depth exclude none
    assert earlier.bars == ()


def test_every_design_kept_in_the_end_was_wanted_when_it_was_solved() -> None:
    draw = np.random.default_rng(7)
    for kind, count in (("best", 3), ("pareto", 0)):
        values = {chr(97 + k): tuple(draw.integers(0, 8, 2).astype(float)) for k in range(26)}
        made, seen = set(), {}
        for name, (lift, nodes) in values.items():
            wanted = _solved(seen).wanted(kind, count) if seen else RowFigures(()).wanted("best", 1)
            if wanted.takes("open", {"headline.lift_max_mm": lift, "mesh.nodes": nodes}):
                made.add(name)
            seen[name] = (lift, nodes)
        whole = _solved(values)
        kept = set(whole.kept(kind, count))
        assert kept <= made < set(values)
        assert kept <= whole.taken(made, whole.wanted(kind, count)) < made
        first = {name for name in values if name < "n"}  # a stop rule may leave these alone
        bounds = whole.of(Tier.CYCLE, first).wanted(kind, count)
        whole.keep(first)
        assert set(whole.kept(kind, count)) <= whole.taken(first, bounds)


@pytest.mark.parametrize("start", [0, 3, 9])
def test_numbers_of_a_column_are_those_of_arrow_whatever_its_chunks(start: int) -> None:
    numbers = np.where(np.arange(21) % 4 == 1, np.nan, np.arange(21) / 7.0)
    table = table_of(rows("abcdefghijklmnopqrstu", **{"jump.demand": numbers}), {})
    column = pa.concat_tables([table.slice(start, 11), table, table.slice(2, 1)])["jump.demand"]
    np.testing.assert_array_equal(values_of(column), column.to_numpy())
    whole = pa.chunked_array([], type=pa.float64())
    assert values_of(whole).size == 0
