"""Run the slow tests in named parts, and write their results into docs/verification.md.

python tests/slow_parts.py              all parts
python tests/slow_parts.py sizes ends   these parts
python tests/slow_parts.py whole        what all parts try a sample of, as `make bench` does
python tests/slow_parts.py --list       names and files of the parts
"""

from __future__ import annotations

import json
import platform
import re
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "verification.md"
START, END = "<!-- results of make verify -->", "<!-- end of results -->"
FIGURES, FIGURES_END = "<!-- figures of the tests -->", "<!-- end of figures -->"
MEASURED = "figures"
"""Name of the part of the tests that state figures, quick ones all of them."""
WHOLE = "whole"
"""Name of the part, and marker, of slow tests of which the other parts have a sample."""

PARTS: Mapping[str, tuple[str, ...]] = {
    "contact": ("any_contour_meshes", "envelope_verification", "stress_fields", "deck",
                "measured_trials", "numerics_audit", "step_solid"),
    "ends": ("brick_body", "certified_ends", "factor_table", "length_anchors", "least_crown",
             "crown_command"),
    "follower": ("bush_elements", "camshaft_audit", "guides_audit", "spring_audit", "gas_spring",
                 "spring_link", "every_check", "part_data", "confirmation", "verdict_monotone",
                 "verdict_summary"),
    "synthesis": ("constrained_verification", "face_synthesis", "infeasible_verification",
                  "kept_synthesis", "objective_verification", "part_constraints_agree",
                  "prices_verification", "synthesis_properties"),
    "oracle": ("synthesis_oracle", "synthesis_of_arms"),
    "measured": ("measured_traces", "period_of_a_case", "pitch_errors", "papers",
                 "paper_figures"),
    "cases": ("bad_parts", "compare", "feedback_case", "first_case", "first_case_run",
              "flat_face_road", "flat_face_run", "hand_sheet", "loaded_follower_run",
              "redesigned_case", "shipped_machines"),
    "remedies": ("remedies_hold", "redesign_command"),
    "sizes": ("size_command",),
    "designs": ("design_command",),
    "site": ("site_in_browser", "tutorials"),
    "studies": ("live_preview", "screening", "screening_designs", "study"),
}  # fmt: skip
"""Files of tests/ by part, without `test_`; all others are of the part `records`."""
RECORDS = "records"


class Result(NamedTuple):
    """Outcome of a part: counts, and wall time in s."""

    passed: int
    failed: int
    skipped: int
    seconds: float


def slow_files() -> dict[str, list[Path]]:
    """Test files with slow tests, by part."""
    parts: dict[str, list[Path]] = {name: [] for name in (*PARTS, RECORDS)}
    of = {stem: name for name, stems in PARTS.items() for stem in stems}
    for path in sorted((ROOT / "tests").rglob("test_*.py")):
        if "mark.slow" in path.read_text(encoding="utf-8"):
            parts[of.get(path.stem.removeprefix("test_"), RECORDS)].append(path)
    return parts


def run(
    files: Sequence[Path],
    marker: str = f"slow and not {WHOLE}",
    then: Callable[[Path], None] | None = None,
) -> Result:
    """Run the tests of a marker in some files in two processes.

    then : function   of the JUnit report, where all have passed
    """
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "results.xml"
        command = [
            *(sys.executable, "-m", "pytest", "-q", "-m", marker, "-n", "2", "--dist", "worksteal"),
            *("--max-worker-restart=0", "--durations=10", f"--junitxml={report}", *files),
        ]
        code = subprocess.run(command, cwd=ROOT, check=False).returncode
        counted = counts(report) if report.is_file() else (0, 0, 0)
        if code == 0 and then is not None:
            then(report)
    passed, failed, skipped = counted
    if code != 0 and failed == 0:
        failed = 1  # the run itself broke off
    return Result(passed, failed, skipped, time.monotonic() - begin)


def counts(report: Path) -> tuple[int, int, int]:
    """Passed, failed and skipped tests of a JUnit report that this script let pytest write."""
    suites = ET.parse(report).getroot().iter("testsuite")
    passed = failed = skipped = 0
    for suite in suites:
        wrong = int(suite.get("failures", "0")) + int(suite.get("errors", "0"))
        left = int(suite.get("skipped", "0"))
        passed += int(suite.get("tests", "0")) - wrong - left
        failed, skipped = failed + wrong, skipped + left
    return passed, failed, skipped


class Figure(NamedTuple):
    """A figure of a test beside its reference; rtol: the share by which they may differ."""

    name: str
    value: float
    reference: float
    rtol: float
    unit: str

    @property
    def deviation(self) -> float:
        """Difference over the reference."""
        return abs(self.value - self.reference) / abs(self.reference)

    def shown(self, value: float) -> str:
        """A value with the unit."""
        return f"{value:.6g} {self.unit}".rstrip()


def figures(report: Path) -> list[Figure]:
    """The worst figure of each name in a JUnit report, by its share of what is permitted."""
    worst: dict[str, Figure] = {}
    for each in ET.parse(report).getroot().iter("property"):
        if each.get("name") == "measured":
            one = Figure(*json.loads(each.get("value", "")))
            known = worst.setdefault(one.name, one)
            if one.deviation / one.rtol > known.deviation / known.rtol:
                worst[one.name] = one
    return list(worst.values())


def figure_table(listed: Sequence[Figure]) -> str:
    """Figures as a table."""
    head = ["| figure | found | reference | deviation | permitted |",
            "| --- | --- | --- | --- | --- |"]  # fmt: skip
    rows = [
        f"| {one.name} | {one.shown(one.value)} | {one.shown(one.reference)} | "
        f"{100.0 * one.deviation:.2g} % | {100.0 * one.rtol:.2g} % |"
        for one in sorted(listed)
    ]
    return "\n".join([*head, *rows])


def measure() -> Result:
    """Run the quick tests that state figures, and write these into the page."""
    files = [path for path in sorted((ROOT / "tests").rglob("test_*.py"))
             if "measured(" in path.read_text(encoding="utf-8")]  # fmt: skip
    return run(files, "measured and not slow", _write_figures)


def _write_figures(report: Path) -> None:
    page = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(with_figures(page, figures(report)), encoding="utf-8")


def with_figures(page: str, listed: Sequence[Figure]) -> str:
    """The page with these figures in place of those that it has."""
    before, found, rest = page.partition(FIGURES)
    _, ended, after = rest.partition(FIGURES_END)
    if not found or not ended:
        raise SystemExit(f"{PAGE}: the marks of the table of figures are missing")
    return f"{before}{FIGURES}\n{figure_table(listed)}\n{FIGURES_END}{after}"


def commit() -> str:
    """Commit of the checkout, with a + where files of it are changed."""

    def git(*words: str) -> str:
        command = ["git", *words]
        return subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True).stdout

    changed = git("status", "--porcelain", "--", ".", f":!{PAGE.relative_to(ROOT)}").strip()
    return (git("rev-parse", "--short=8", "HEAD").strip() or "unknown") + ("+" if changed else "")


def row(name: str, result: Result, of: str, at: datetime) -> str:
    """Row of the table of results."""
    verdict = "passed" if result.failed == 0 else "FAILED"
    numbers = f"{result.passed} | {result.failed} | {result.skipped} | {result.seconds:.0f} s"
    return f"| `{name}` | {verdict} | {numbers} | {of} | {at:%Y-%m-%d %H:%M} UTC |"


def written(page: str, rows: Mapping[str, str]) -> str:
    """The page with new rows in place of those of the same parts."""
    before, found, rest = page.partition(START)
    table, ended, after = rest.partition(END)
    if not found or not ended:
        raise SystemExit(f"{PAGE}: the marks of the table of results are missing")
    kept = {match[1]: match[0] for match in re.finditer(r"^\| `(\w+)` \|.*$", table, re.MULTILINE)}
    kept |= rows
    head = ["| part | result | passed | failed | skipped | wall time | commit | date |",
            "| --- | --- | --- | --- | --- | --- | --- | --- |"]  # fmt: skip
    body = [kept[name] for name in (*PARTS, RECORDS, MEASURED, WHOLE) if name in kept]
    return before + "\n".join([START, *head, *body, END]) + after


def main(names: Sequence[str]) -> int:
    """Run parts and write their results; 0 if no test fails, 2 if a name is unknown."""
    parts = slow_files()
    if "--list" in names:
        for name, files in parts.items():
            print(f"{name}: {' '.join(str(path.relative_to(ROOT)) for path in files)}")
        return 0
    if unknown := [name for name in names if name not in (*parts, MEASURED, WHOLE)]:
        known = ", ".join([*parts, MEASURED, WHOLE])
        print(f"part = {unknown[0]}, must be one of: {known}", file=sys.stderr)
        return 2
    begin, failed, of = time.monotonic(), 0, commit()
    for name in names or (*parts, MEASURED):
        print(f"== {name}", flush=True)
        if name == WHOLE:
            result = run([file for files in parts.values() for file in files], WHOLE)
        else:
            result = measure() if name == MEASURED else run(parts[name])
        failed += result.failed
        rows = {name: row(name, result, of, datetime.now(UTC))}
        PAGE.write_text(written(PAGE.read_text(encoding="utf-8"), rows), encoding="utf-8")
    minutes = (time.monotonic() - begin) / 60.0
    machine = f"Python {platform.python_version()}, {platform.machine()}"
    print(f"verify: {failed} failed, {minutes:.1f} min, {machine}; results in {PAGE}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
