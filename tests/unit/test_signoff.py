"""The sign-off record: what it holds, and that no file can change unseen."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import pytest
from small_run import check, small_case, summary, write_run, write_trial

from camwright.geometry.errors import ResultError
from camwright.pipeline.base.files import write_atomic
from camwright.pipeline.checks.registry import CHECKS
from camwright.pipeline.results import signoff
from camwright.pipeline.results.folder_exchange import amended
from camwright.pipeline.results.model_limits import MODEL_LIMITS
from camwright.pipeline.results.run_folder import RunFolder


@pytest.fixture
def run(tmp_path: Path) -> Path:
    out = write_run(tmp_path / "run")
    with amended(out) as place:
        for name in ("8_report.html", "figures/a.png", "exports/cam.dxf"):
            write_atomic(place / name, "drawn")
    return out


def test_the_record_is_whole(tmp_path: Path) -> None:
    out = tmp_path / "run"
    waived = check("waived", id="x", waiver="A. Engineer, 2025-01-02: proven", error=0.01)
    with RunFolder(out, small_case()) as folder:
        (folder.fields / "a.vtu").write_text("field")
        (folder.path / "8_report.html").write_text("drawn")
        write_trial(folder, [check("fail"), waived])
        folder.finish(summary("fail"))
    record = json.loads((out / "signoff.json").read_text())
    assert record["case_sha256"] == small_case().sha256
    assert record["verdict"] == "fail"
    assert record["binding"] == ["pressure_angle"]
    assert record["waivers"] == [{
        "check": "x", "waiver": "A. Engineer, 2025-01-02: proven", "up_to": 3.5, "unit": "deg",
        "status": "waived",
    }]  # fmt: skip
    assert record["verdict_line"] == "FAIL: 1 check beyond its limit, 1 waived"
    assert record["scope"] == {"not_covered": [], "reason": "", "statement": ""}
    assert record["not_proven"] == record["to_be_confirmed"] == []
    assert [f["error"] for f in record["figures"] if f["id"] == "x"] == [0.01]
    assert record["environment"]["versions"]["numpy"]
    assert record["limitations"] and record["singularities"]
    said = record["limitations"] + record["singularities"]
    assert said == [limit.statement for limit in sorted(MODEL_LIMITS, key=lambda one: one.singular)]
    checked = [limit for limit in MODEL_LIMITS if limit.check]
    assert {limit.check for limit in checked} <= {each.id for each in CHECKS}
    assert [one["statement"] for one in record["evidence"]["statements"]] == [
        limit.statement for limit in checked
    ]
    assert all(one["check"] for one in record["evidence"]["statements"])
    assert {"case.toml", "run.json", "fields/a.vtu", "trial_1/5_cycle.csv"} <= set(record["files"])
    assert "8_report.html" in record["files"]
    assert "signoff.json" not in record["files"]
    lines = (f"{digest}  {name}\n" for name, digest in sorted(run_files(out).items()))
    expected = hashlib.sha256("".join(lines).encode()).hexdigest()
    assert record["results_sha256"] == expected
    assert all(len(digest) == 64 for digest in record["files"].values())


def run_files(out: Path) -> dict[str, str]:
    files: dict[str, str] = json.loads((out / "run.json").read_text())["files"]
    return files


def said(run: Path) -> list[str]:
    return [str(each) for each in signoff.changes(run)]


def test_untouched_nothing_differs(run: Path) -> None:
    assert signoff.changes(run) == []


@pytest.mark.parametrize(
    "name",
    ["trial_1/5_cycle.csv", "case.toml", "run.json", "trial_1/6_checks.json", "1_torque.csv"],
)
def test_one_byte_is_seen_and_named(run: Path, name: str) -> None:
    content = bytearray((run / name).read_bytes())
    content[len(content) // 2] ^= 1
    (run / name).write_bytes(bytes(content))
    assert said(run) == [f"{name}: was changed since the sign-off"]


def test_missing_and_added_files_are_named(run: Path) -> None:
    (run / "trial_1" / "3_contour.csv").unlink()
    (run / "fields").mkdir()
    (run / "fields" / "b.vtu").write_text("new")
    assert said(run) == [
        "fields/b.vtu: was added since the sign-off",
        "trial_1/3_contour.csv: is missing since the sign-off",
    ]


def test_presentation_is_recorded_when_it_is_drawn_again(run: Path) -> None:
    (run / "8_report.html").write_text("edited")
    assert said(run) == ["8_report.html: was changed since the sign-off"]
    with amended(run) as place:  # an edited folder is not recorded by drawing more
        write_atomic(place / "figures" / "b.png", "one more")
    assert said(run) == [
        "8_report.html: was changed since the sign-off",
        "figures/b.png: was added since the sign-off",
    ]
    with amended(run) as place:  # what is written anew may have been edited
        write_atomic(place / "8_report.html", "drawn again")
    assert said(run) == ["figures/b.png: was added since the sign-off"]


def test_a_file_of_the_user_keeps_no_page_out_of_the_record(run: Path) -> None:
    (run / "notes.txt").write_text("by hand")
    with amended(run) as place:
        write_atomic(place / "8_report.html", "drawn again")
    assert said(run) == ["notes.txt: was added since the sign-off"]


def test_an_amended_record_is_that_of_the_files(run: Path) -> None:
    amended_record = (run / "signoff.json").read_bytes()
    signoff.write(run)
    assert (run / "signoff.json").read_bytes() == amended_record


def test_a_hostile_name_is_written_out(run: Path) -> None:
    (run / "\x1b[2J").write_text("")
    assert said(run) == ["'\\x1b[2J': was added since the sign-off"]


def test_a_folder_that_is_no_run_is_not_recorded(tmp_path: Path) -> None:
    with amended(tmp_path) as place:
        (place / "a").write_text("")
    assert [path.name for path in tmp_path.iterdir()] == ["a"]


def test_a_hidden_file_is_named(run: Path) -> None:
    (run / "trial_1" / ".x").write_text("")
    assert said(run) == ["trial_1/.x: was added since the sign-off"]


def test_a_forged_verdict_is_seen(run: Path) -> None:
    file = run / "signoff.json"
    record = json.loads(file.read_text())
    file.write_text(json.dumps(record | {"verdict": "fail"}))
    forged = "signoff.json: verdict is not what the files of the run say"
    assert said(run) == [forged]
    (run / "notes.txt").write_text("added")  # hides nothing
    assert said(run) == ["notes.txt: was added since the sign-off", forged]


def test_without_a_record_nothing_is_verified(run: Path) -> None:
    (run / "signoff.json").unlink()
    assert said(run) == ["signoff.json: No such file or directory"]
    (run / "signoff.json").write_text("[]")
    assert said(run) == ["signoff.json: holds no hashes"]
    (run / "run.json").unlink()
    with pytest.raises(ResultError, match=r"run\.json is missing"):
        signoff.changes(run)
