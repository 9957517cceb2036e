"""`make verify`: parts of the slow tests, and the page of their results."""

import json
import subprocess
from datetime import UTC, datetime
from pathlib import Path

import pytest
import slow_parts

AT = datetime(2026, 1, 2, 3, 4, tzinfo=UTC)


def test_every_part_names_files_with_slow_tests() -> None:
    parts = slow_parts.slow_files()
    for name, stems in slow_parts.PARTS.items():
        assert {path.stem.removeprefix("test_") for path in parts[name]} == set(stems), name
    files = [path for each in parts.values() for path in each]
    assert len(files) == len(set(files)) > 50


def test_results_replace_those_of_the_same_part() -> None:
    page = f"# Head\n{slow_parts.START}\n{slow_parts.END}\ntail\n"
    first = slow_parts.Result(10, 1, 2, 60.4)
    page = slow_parts.written(page, {"sizes": slow_parts.row("sizes", first, "abc", AT)})
    page = slow_parts.written(page, {"ends": slow_parts.row("ends", first, "abc", AT)})
    assert "| `sizes` | FAILED | 10 | 1 | 2 | 60 s | abc | 2026-01-02 03:04 UTC |" in page
    second = slow_parts.Result(11, 0, 2, 50.0)
    page = slow_parts.written(page, {"sizes": slow_parts.row("sizes", second, "def+", AT)})
    assert page.index("`ends`") < page.index("| `sizes` | passed | 11 | 0 | 2 | 50 s | def+ |")
    assert "60 s | abc | 2026-01-02 03:04 UTC |\n| `sizes`" in page
    assert page.startswith("# Head\n") and page.endswith("\ntail\n") and page.count("sizes") == 1


def test_tests_are_counted(tmp_path: Path) -> None:
    report = tmp_path / "results.xml"
    report.write_text(
        '<testsuites><testsuite tests="9" failures="1" errors="2" skipped="3"/></testsuites>'
    )
    assert slow_parts.counts(report) == (3, 3, 3)


def test_the_worst_figure_of_a_name_is_written(tmp_path: Path) -> None:
    report = tmp_path / "results.xml"
    listed = (["b", 101.0, 100.0, 0.02, "mm"], ["a", -2.0, -2.0, 0.01, ""],
              ["b", 98.5, 100.0, 0.02, "mm"])  # fmt: skip
    cases = "".join(
        f"<testcase><properties><property name='measured' value='{json.dumps(each)}'/>"
        "<property name='other' value='1'/></properties></testcase>"
        for each in listed
    )
    report.write_text(f"<testsuites><testsuite>{cases}</testsuite></testsuites>")
    page = f"head\n{slow_parts.FIGURES}\nold\n{slow_parts.FIGURES_END}\ntail\n"
    written = slow_parts.with_figures(page, slow_parts.figures(report))
    assert "| a | -2 | -2 | 0 % | 1 % |\n| b | 98.5 mm | 100 mm | 1.5 % | 2 % |\n" in written
    assert "old" not in written and written.startswith("head\n") and written.endswith("\ntail\n")


def test_a_run_that_breaks_off_has_failed(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without a report, as where a worker process dies."""
    dead = subprocess.CompletedProcess([], 3)
    monkeypatch.setattr(slow_parts.subprocess, "run", lambda *_, **__: dead)
    assert slow_parts.run([Path("test_none.py")]).failed == 1


def test_an_unknown_part_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert slow_parts.main(["nothing"]) == 2
    assert "part = nothing, must be one of: contact, " in capsys.readouterr().err
