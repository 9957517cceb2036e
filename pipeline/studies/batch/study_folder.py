"""Study folder: shards, dataset and records, each written in one step."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import (
    files_in,
    json_text,
    read_json,
    shown_name,
    write_atomic,
)
from camwright.pipeline.base.owned_folder import OwnedFolder
from camwright.pipeline.base.store import Store
from camwright.pipeline.records.study_document import StudyDocument
from camwright.pipeline.results.folder_exchange import of_the_user
from camwright.pipeline.studies.batch.case_template import Template
from camwright.pipeline.studies.batch.dataset import (
    ANSWERS,
    CASES,
    DATASET,
    DESIGN,
    FIXED,
    ID,
    PAGE,
    RUNS,
    SHARDS,
    STUDY,
    SUMMARY,
    TABLE,
    TIMINGS,
    WRITING,
    in_order,
    require_columns,
    whole_numbers,
)
from camwright.pipeline.studies.batch.design_rows import CLOCK, Files

if TYPE_CHECKING:
    import pyarrow as pa

_OURS = re.compile(
    "|".join(
        re.escape(name)
        for name in (ANSWERS, PAGE, STUDY, SUMMARY, DATASET, SHARDS, TIMINGS, RUNS, CASES)
    )
)
_WRITTEN = (".parquet", ".json", ".tmp")
_BLOCK = 2000
"""Rows of a row group of the dataset; bounds the memory of its writing."""


@dataclass(frozen=True)
class Shard:
    """Shard of the folder: name, and ids of its rows."""

    name: str
    ids: tuple[str, ...]

    def fits(self, rows: pa.Table) -> bool:
        """Whether a table has the columns of a study and exactly the rows of this shard, by id, in
        its order.
        """
        try:
            require_columns(rows, [each for each in FIXED if each is not DESIGN], Path(self.name))
        except ResultError:
            return False
        return bool(rows[ID.name].to_pylist() == list(self.ids))


class StudyFolder:
    """Study folder being written; a context manager.

    Parameters
    ----------
    out : Path
    resume : bool   complete an earlier study in it

    Raises
    ------
    ResultError
        If the folder holds anything but a study, holds one without `resume`, or another process
        writes to it.
    """

    def __init__(self, out: Path, *, resume: bool) -> None:
        self.path, self._resume = out, resume
        self._home = OwnedFolder(out, _OURS, "study")

    def require_free(self) -> None:
        """ResultError if the folder has other content, or a study while none is to be resumed."""
        if self.path.is_symlink():
            raise ResultError(f"{self.path}: is a link; choose a folder")
        entries = self._home.entries()
        if not entries:
            return
        if SHARDS not in entries:  # a folder of the user with cases/, runs/, study.toml
            raise ResultError(f"{self.path}: holds {entries[0]} and no {SHARDS}: not a study")
        if not self._resume:
            raise ResultError(f"{self.path}: holds a study; --resume completes it")
        for name in self._of_the_user()[:1]:
            told = f"holds {shown_name(name)}, which no study wrote; move it elsewhere"
            raise ResultError(f"{self.path}: {told}")

    def _of_the_user(self) -> list[str]:
        """Files among shards and runs that no study wrote and that resuming would delete."""
        odd = [
            f"{folder}/{each.name}"
            for folder in (SHARDS, TIMINGS)
            for each in (self.path / folder).glob("*")
            if not each.name.endswith(_WRITTEN)
        ]
        for run in (self.path / RUNS).glob("*"):
            if not run.is_dir():
                odd.append(f"{RUNS}/{run.name}")
            elif not run.name.endswith(".tmp"):
                odd += (f"{RUNS}/{run.name}/{name}" for name in of_the_user(run))
        return sorted(odd)

    def __enter__(self) -> StudyFolder:
        """Take the folder for this process alone, and make that of the shards; ResultError where it
        is not free.
        """
        self.require_free()
        self._home.take()
        try:
            (self.path / SHARDS).mkdir(exist_ok=True)  # first: by it a study is known
        except OSError as error:
            self._home.release()
            raise ResultError(f"{self.path}: {error.strerror or error}") from None
        return self

    def __exit__(self, *_: object) -> None:
        self._home.release()

    def write_inputs(self, text: str, templates: Sequence[Template]) -> None:
        """Write study file and cases, in place of those of an earlier study."""
        earlier = self.path / STUDY
        if earlier.is_file() and earlier.read_bytes() != text.encode():
            shutil.rmtree(self.path / RUNS, ignore_errors=True)
        write_atomic(earlier, text)
        shutil.rmtree(self.path / CASES, ignore_errors=True)
        for each in templates:
            for name, content in each.files.items():
                write_atomic(self.path / CASES / each.name / name, content)

    def read_whole(self, shard: Shard) -> pa.Table | None:
        """Rows of a shard; None if its file is missing or does not fit the shard, in which case it
        is deleted.
        """
        shards = self._store(SHARDS)
        table = shards.get(shard.name, shard.fits)
        if table is None:
            shards.delete(shard.name)
        return table

    def write_shard(self, name: str, rows: bytes, clock: bytes) -> None:
        """Write the rows of a task and their clock figures."""
        self._store(TIMINGS).put_written(name, clock)
        self._store(SHARDS).put_written(name, rows)

    def read_shard(self, name: str) -> pa.Table:
        """Rows of a shard."""
        return TABLE.read(self._shard(name))

    def _store(self, folder: str) -> Store[pa.Table]:
        return Store(self.path / folder, TABLE)

    def forget_others(self, shards: Sequence[Shard], runs: Sequence[str]) -> None:
        """Delete the shards and run folders of an earlier study.

        Parameters
        ----------
        shards : sequence   to be kept
        runs : sequence     ids of the designs whose run folders are to be kept
        """
        kept = {f"{shard.name}.parquet" for shard in shards} | {f"{each}.json" for each in runs}
        for folder in (SHARDS, TIMINGS):
            for each in sorted((self.path / folder).glob("*")):
                if each.name not in kept:
                    each.unlink()
        for each in sorted((self.path / RUNS).glob("*")):
            if each.name not in runs:
                shutil.rmtree(each)

    def holds_run(self, name: str, depth: str, versions: Mapping[str, str]) -> bool:
        """Whether the run folder of a design exists, made at this depth and by these versions.

        Parameters
        ----------
        name : str           id of the design
        depth : str          word of the depth
        versions : mapping   of the program and libraries, by name
        """
        try:
            summary = read_json(self.path / RUNS / name / "run.json")
        except ResultError:
            return False
        made = summary.get("versions") if isinstance(summary, dict) else None
        if not isinstance(made, dict) or summary.get("depth") != depth:
            return False
        return all(versions.get(each) == version for each, version in made.items())

    def write_run(self, name: str, files: Files) -> None:
        """Write the run folder of a design in one step.

        Parameters
        ----------
        name : str        id of the design
        files : mapping   contents by relative name; empty: a design without a result
        """
        final = self.path / RUNS / name
        aside = final.with_name(f".{name}.tmp")
        shutil.rmtree(aside, ignore_errors=True)
        try:
            aside.mkdir(parents=True)
            for each, content in files.items():
                if each != CLOCK:
                    write_atomic(aside / each, content)
            if CLOCK in files:
                write_atomic(self.path / TIMINGS / f"{name}.json", files[CLOCK])
            shutil.rmtree(final, ignore_errors=True)
            aside.replace(final)
        except OSError as error:
            raise ResultError(f"{final}: {error.strerror or error}") from None

    def lacks_page(self, name: str) -> bool:
        """Whether the run folder of a design has results and no page."""
        from camwright.reports import page

        run = self.path / RUNS / name
        return (run / "run.json").is_file() and not (run / page.PAGE).is_file()

    def files_of_run(self, name: str) -> Files:
        """Files of the run folder of a design, by relative name."""
        return {each: path.read_bytes() for each, path in files_in(self.path / RUNS / name)}

    def delete_run(self, name: str) -> None:
        """Delete the run folder of a design and its clock figures."""
        shutil.rmtree(self.path / RUNS / name, ignore_errors=True)
        (self.path / TIMINGS / f"{name}.json").unlink(missing_ok=True)

    def write_summary(self, record: StudyDocument) -> None:
        """Write the record of the study, last, as it marks a finished one."""
        write_atomic(self.path / SUMMARY, json_text(record) + "\n")

    def _shard(self, name: str) -> Path:
        return self.path / SHARDS / f"{name}.parquet"

    def write_dataset(
        self,
        place: NDArray[np.intp],
        shards: Sequence[Shard],
        deeper: Sequence[Shard],
        ids: Sequence[str],
    ) -> None:
        """Write the rows of all designs in their order, a design drawn several times as often;
        block by block.

        Parameters
        ----------
        place : array (n,)   unique design of each number, of these shards
        shards : sequence    of the first stage: together the unique designs, in order
        deeper : sequence    of the second stage; their rows replace those of the first
        ids : sequence       of the unique designs
        """
        import pyarrow.parquet as pq

        starts = np.cumsum([0, *(len(shard.ids) for shard in shards)])
        order = {name: k for k, name in enumerate(ids)}
        second = [self.read_shard(shard.name) for shard in deeper]
        replaced = {order[name]: k for k, name in enumerate(n for s in deeper for n in s.ids)}
        schema = self._schema([*shards, *deeper])
        final = self.path / DATASET
        aside = final.with_name(f".{DATASET}.tmp")
        recent: dict[int, pa.Table] = {}
        try:
            with aside.open("wb") as file, pq.ParquetWriter(file, schema, **WRITING) as writer:
                for start in range(0, max(len(place), 1), _BLOCK):
                    unique = place[start : start + _BLOCK]
                    owners = np.searchsorted(starts, unique, side="right") - 1
                    wanted = sorted(set(owners.tolist()))
                    recent = {
                        k: recent[k] if k in recent else self.read_shard(shards[k].name)
                        for k in wanted
                    }
                    parts = [*(recent[k] for k in wanted), *second]
                    heads = np.cumsum([0, *(len(part) for part in parts)])
                    rows = heads[np.searchsorted(wanted, owners)] + unique - starts[owners]
                    for k, each in enumerate(unique.tolist()):
                        if each in replaced:
                            rows[k] = heads[len(wanted)] + replaced[each]
                    writer.write_table(_block(schema, parts, rows, start))
                file.flush()
                os.fsync(file.fileno())
            aside.replace(final)
        except OSError as error:
            raise ResultError(f"{final}: {error.strerror or error}") from None
        finally:
            with contextlib.suppress(OSError):
                aside.unlink(missing_ok=True)

    def _schema(self, shards: Sequence[Shard]) -> pa.Schema:
        """Arrow schema of the dataset: the columns of all shards, in dataset order."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        meaning = {"unit": DESIGN.unit, "meaning": DESIGN.meaning}
        fields = {DESIGN.name: pa.field(DESIGN.name, pa.int64(), metadata=meaning)}
        for shard in shards:
            for field in pq.read_schema(self._shard(shard.name)):
                fields.setdefault(field.name, field)
        return pa.schema([fields[name] for name in in_order(list(fields))])


def _block(
    schema: pa.Schema, parts: Sequence[pa.Table], rows: NDArray[np.intp], start: int
) -> pa.Table:
    """Part of the dataset with the given columns; columns without values are filled with nulls.

    Parameters
    ----------
    schema : Schema    columns of the dataset
    parts : sequence   tables of unique designs, to be concatenated
    rows : array       indices of the rows of the concatenation, in the order of the designs
    start : int        number of the first design
    """
    import pyarrow as pa

    if not parts:
        return schema.empty_table()
    below = pa.concat_tables(parts, promote_options="default").take(whole_numbers(rows))
    count = len(rows)
    columns = []
    for field in schema:
        if field.name == DESIGN.name:
            columns.append(whole_numbers(np.arange(start, start + count)))
        elif field.name in below.column_names:
            columns.append(below[field.name].combine_chunks())
        else:
            columns.append(pa.nulls(count, field.type))
    return pa.Table.from_arrays(columns, schema=schema)
