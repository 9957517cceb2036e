"""Run folders: whole or not at all, never over somebody else's files, resumable."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from small_machine import small_machine
from small_run import TORQUE, check, small_case, summary, values, write_run, write_trial

from camwright.geometry.errors import ResultError
from camwright.pipeline import results
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.base.store import Arrays
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.cycle.contact_store import kept_piece
from camwright.pipeline.results import run_folder, run_reader
from camwright.pipeline.results.folder_exchange import amended
from camwright.pipeline.results.run_folder import RunFolder


def entries(folder: Path) -> list[str]:
    return sorted(entry.name for entry in folder.iterdir())


def keep_piece(folder: RunFolder) -> None:
    """A first piece of the contact of a first trial."""
    kept_piece(folder.contact_store(1), "idle", 0, "a", lambda: {"p0": np.arange(3) / 7.0})


def is_kept(folder: RunFolder, key: str = "a", trial: int = 1, load_case: str = "idle") -> bool:
    """Whether the first piece of a trial is kept, as `keep_piece` keeps it."""

    def computed() -> Arrays:
        raise LookupError

    try:
        piece = kept_piece(folder.contact_store(trial), load_case, 0, key, computed)
    except LookupError:
        return False
    assert piece["p0"].tolist() == (np.arange(3) / 7.0).tolist()
    return True


def other_case() -> Any:
    return parse_case(small_machine("small").replace('"400 N"', '"401 N"'))


def test_a_finished_run_leaves_nothing_else_behind(tmp_path: Path) -> None:
    out = write_run(tmp_path / "new" / "run")
    assert entries(tmp_path / "new") == ["run"]
    assert entries(out) == ["1_torque.csv", "case.toml", "run.json", "signoff.json", "trial_1"]
    summary = run_reader.read_summary(out)
    assert summary["input_sha256"] == small_case().sha256 == run_reader.input_sha256(out)
    assert summary["versions"]["numpy"] == np.__version__


def test_rerun_of_the_same_case_takes_the_place_of_the_first(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    (out / "figures").mkdir()
    write_run(out, status="fail")
    assert run_reader.read_run(out).verdict == "fail"
    assert not (out / "figures").exists()
    assert entries(tmp_path) == ["run"]


def test_failed_rerun_keeps_the_first(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    with pytest.raises(ZeroDivisionError), RunFolder(out, small_case()):
        raise ZeroDivisionError
    assert entries(tmp_path) == ["run"]
    assert run_reader.read_run(out).verdict == "pass"


def test_what_nobody_expected_leaves_solved_trials_to_resume(tmp_path: Path) -> None:
    """A failure of the drawing after an hour of contact must not take the contact with it."""
    case = small_case()
    with pytest.raises(ZeroDivisionError), RunFolder(tmp_path / "run", case) as folder:
        keep_piece(folder)
        write_trial(folder, [check()])
        raise ZeroDivisionError
    with RunFolder(tmp_path / "run", case, resume=True) as folder:
        assert folder.resumed
        assert not (folder.path / "trial_1").exists(), "written again, with the options of this run"
        assert is_kept(folder)


def test_what_nobody_expected_before_any_contact_leaves_nothing(tmp_path: Path) -> None:
    with pytest.raises(ZeroDivisionError), RunFolder(tmp_path / "run", small_case()) as folder:
        folder.write("1_torque.csv", values(TORQUE))
        raise ZeroDivisionError
    assert entries(tmp_path) == []


def test_an_empty_folder_will_do(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    write_run(tmp_path / "run")
    assert run_reader.read_run(tmp_path / "run").verdict == "pass"


def test_refuses_the_run_of_another_case(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    with pytest.raises(ResultError, match="holds the run of another case, small"):
        RunFolder(out, small_case("large"))
    with pytest.raises(ResultError, match="holds the run of another input"):
        RunFolder(out, other_case())
    assert entries(tmp_path) == ["run"]


def test_refuses_foreign_files(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").write_text("years")
    with pytest.raises(ResultError, match=r"holds thesis\.tex, which is not of a run"):
        RunFolder(tmp_path, small_case())
    out = write_run(tmp_path / "run")
    (out / "notes.txt").write_text("mine")
    with pytest.raises(ResultError, match=r"holds notes\.txt"):
        RunFolder(out, small_case())
    with pytest.raises(ResultError, match="is not a folder"):
        RunFolder(tmp_path / "thesis.tex", small_case())
    with pytest.raises(ResultError):
        RunFolder(tmp_path / "thesis.tex" / "run", small_case())
    assert entries(tmp_path) == ["run", "thesis.tex"]


def test_a_run_with_its_workshop_files_is_no_stranger(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    with amended(out) as place:
        write_atomic(place / "workshop" / "contour.csv", "")
    write_run(out, status="fail")
    assert run_reader.read_run(out).verdict == "fail"


def test_refuses_what_stands_where_the_work_folder_goes(tmp_path: Path) -> None:
    (tmp_path / ".run.partial").mkdir()
    (tmp_path / ".run.partial" / "precious").write_text("x")
    with pytest.raises(ResultError, match="in the way"):
        RunFolder(tmp_path / "run", small_case())
    assert (tmp_path / ".run.partial" / "precious").read_text() == "x"


def test_two_runs_at_once(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "run", small_case()) as first:
        with pytest.raises(ResultError, match="another run is writing"):
            RunFolder(tmp_path / "run", small_case())
        write_trial(first, [check()])
        first.finish(summary())
    assert run_reader.read_run(tmp_path / "run").verdict == "pass"


def interrupted(out: Path) -> None:
    with pytest.raises(KeyboardInterrupt), RunFolder(out, small_case()) as folder:
        keep_piece(folder)
        kept_piece(folder.contact_store(1), "idle", 1, "b", lambda: {"p0": np.arange(3) / 9.0})
        raise KeyboardInterrupt


def test_interrupted_run_resumes(tmp_path: Path) -> None:
    out = tmp_path / "run"
    interrupted(out)
    assert not out.exists()
    with RunFolder(out, small_case(), resume=True) as folder:
        assert folder.resumed
        assert is_kept(folder)
        assert not is_kept(folder, trial=2) and not is_kept(folder, load_case="rated")
        assert not is_kept(folder, "b"), "a piece of other inputs"
        write_trial(folder, [check()])
        folder.finish(summary())
    assert entries(tmp_path) == ["run"]
    assert not any(name.startswith(".") for name in entries(out))


def test_without_resume_an_interrupted_run_starts_afresh(tmp_path: Path) -> None:
    interrupted(tmp_path / "run")
    with RunFolder(tmp_path / "run", small_case()) as folder:
        assert not folder.resumed
        assert not is_kept(folder)


def test_resume_without_a_start_begins(tmp_path: Path) -> None:
    with RunFolder(tmp_path / "run", small_case(), resume=True) as folder:
        assert not folder.resumed


def test_resume_refuses_another_input_or_other_versions(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "run"
    interrupted(out)
    with pytest.raises(ResultError, match="cannot be resumed: its input differ"):
        RunFolder(out, other_case(), resume=True)
    with monkeypatch.context() as patch:
        now = run_folder.versions()
        patch.setattr(run_folder, "versions", lambda: now | {"numpy": "0", "source": "changed"})
        with pytest.raises(ResultError, match=r"its versions \(source, numpy\) differ"):
            RunFolder(out, small_case(), resume=True)
    assert RunFolder(out, small_case(), resume=True).resumed


@pytest.mark.parametrize("package", run_folder._PACKAGES)
def test_the_source_of_a_version_changes_with_one_byte(
    package: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And is that of the files that are imported, wherever they are."""
    source = run_folder.versions()["source"]
    assert source != hashlib.sha256().hexdigest()[: len(source)]
    copy = tmp_path / "copy"
    module = sys.modules[f"camwright.{package}"]
    shutil.copytree(module.__path__[0], copy)
    monkeypatch.setattr(module, "__path__", [str(copy)])
    assert run_folder.versions()["source"] == source
    file = max(copy.rglob("*.py"), key=str)
    file.write_bytes(file.read_bytes() + b"\n")
    assert run_folder.versions()["source"] != source


def test_torn_piece_is_computed_anew(tmp_path: Path) -> None:
    out = tmp_path / "run"
    interrupted(out)
    (piece,) = tmp_path.rglob("000000.npz")
    piece.write_bytes(piece.read_bytes()[:100])
    with RunFolder(out, small_case(), resume=True) as folder:
        assert not is_kept(folder)


def full_disk(*_: object) -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


def test_the_package_lists_the_files_that_are_written() -> None:
    listed = re.findall(r"^\| ``(?:trial_N/)?([\w.]+)``", str(results.__doc__), re.MULTILINE)
    by_others = {"run.json", "signoff.json", "signoff.intoto.jsonl", "4_mesh.msh"}
    assert set(listed) - by_others == set(run_folder.FILES)


def test_full_disk_leaves_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    out = tmp_path / "runs" / "run"
    with (
        pytest.raises(ResultError, match="No space left on device"),
        RunFolder(out, small_case()) as folder,
    ):
        monkeypatch.setattr(os, "fsync", full_disk)
        write_trial(folder, [check()])
    assert entries(tmp_path) == []


def test_full_disk_at_the_start_leaves_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(ResultError, match="No space left on device"):
        RunFolder(tmp_path / "runs" / "run", small_case())
    assert entries(tmp_path) == []


def test_write_atomic_keeps_the_old_file_on_failure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "file"
    write_atomic(path, "old")
    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(ResultError):
        write_atomic(path, "new")
    assert path.read_text() == "old"
    assert entries(tmp_path) == ["file"]


def test_headline_is_whole(tmp_path: Path) -> None:
    given = summary()
    del given["headline"]["p0_max_MPa"]
    with (
        RunFolder(tmp_path / "run", small_case()) as folder,
        pytest.raises(ResultError, match="headline lacks p0_max_MPa"),
    ):
        folder.write_summary(given)


def test_replace_puts_an_earlier_version_aside_when_the_new_one_is_complete(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    with pytest.raises(ZeroDivisionError), RunFolder(out, other_case(), replace=True):
        raise ZeroDivisionError
    with RunFolder(out, other_case(), replace=True) as folder:
        write_trial(folder, [check("fail")])
        assert run_reader.read_run(out).verdict == "pass"
        folder.finish(summary("fail"))
    assert run_reader.read_run(out).verdict == "fail"
    with pytest.raises(ResultError, match="holds the run of another case"):
        RunFolder(out, small_case("large"), replace=True)
    assert entries(tmp_path) == ["run"]


def test_replace_takes_a_run_of_an_earlier_schema(tmp_path: Path) -> None:
    out = write_run(tmp_path / "run")
    record = json.loads((out / "run.json").read_text())
    (out / "run.json").write_text(json.dumps(record | {"schema": 1}))
    with pytest.raises(ResultError, match="schema = 1"):
        RunFolder(out, small_case())
    with RunFolder(out, small_case(), replace=True) as folder:
        write_trial(folder, [check()])
        folder.finish(summary())
    run_reader.verify_run(out)


def test_included_files_are_kept(tmp_path: Path) -> None:
    text = small_machine("small")
    engine = text[text.index("[engine]") : text.index("[mechanism]")]
    (tmp_path / "torque.csv").write_text("crank_angle_deg,torque_Nm\n0,1\n")
    text = text.replace(engine, '[engine]\nkind = "table"\nfile = "torque.csv"\n')
    case = parse_case(text, tmp_path)
    out = write_run(tmp_path / "runs" / "run", case)
    assert (out / "inputs" / "torque.csv").read_text() == "crank_angle_deg,torque_Nm\n0,1\n"
    run_reader.verify_run(out)
    assert run_reader.input_sha256(out) == case.sha256
