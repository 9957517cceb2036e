"""Summary of a verdict in a few lines: failures with remedies, missing data, headline."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from camwright.pipeline.base.units import used
from camwright.pipeline.base.verdict import OPEN, governing, governing_id, in_order, within_depth
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.results.check_records import RecordedCheck, of_records, records_of
from camwright.pipeline.results.check_report import (
    corner,
    ids_by_reason,
    not_proven,
    number,
    place,
    unit_text,
)
from camwright.pipeline.results.run_reader import Run, load_end_words

if TYPE_CHECKING:
    from camwright.pipeline.torque.torque import Torque

WIDTH = 100
"""Columns of a line."""
LINES = 15
"""Most lines of `summary_lines`."""
WORST = 3
"""Failed checks that it names."""
PREVIEW = "preview"
"""Depth of the check of a case."""
_MEAN_ROUND_OFF = 1e-9  # of a mean torque, over peak to peak
_CUT = "…"
_TRIAL = "{:<5}  {:<26} {:<11}  {}"
_LEAST_TITLE = 24  # columns of a title


class Places(NamedTuple):
    """Origin of a verdict: target of `check`, case file, page; run time, s.

    A page of "" was not written; a time of None is not stated.
    """

    target: str
    case: str
    page: str = ""
    seconds: float | None = None


def summary_lines(document: Mapping[str, Any], places: Places) -> list[str]:
    """Summary of the verdict of a run in at most `LINES` lines of `WIDTH` columns.

    Verdict or screen; where the follower leaves the cam or locks; the worst `WORST` failures with
    demand, limit and remedy; number of missing keys; headline; record of a measured speed;
    governing check, unless it is the first failure; scope; page, trials and time. Only a path makes
    a line longer.

    Parameters
    ----------
    document : mapping   as of `camwright check --json`
    places : Places      names of case, run and page, and time taken, for the text
    """
    checks: Sequence[CheckRecord] = records_of(within_depth(of_records(document["checks"])))
    failed = failures(checks)
    lines = folded(verdict_words(document))
    lines += [shortened(line) for line in load_end_line(document)]
    for count, record in enumerate(failed[:WORST], 1):
        lines.append(shortened(f"  {count}. {failure_words(record, WIDTH - 5)}"))
        if record.get("remedy"):
            lines.append(shortened(f"     remedy: {record['remedy']}"))
    if len(failed) > WORST:
        lines.append(f"  {len(failed) - WORST} more: camwright check {places.target}")
    lines += missing_count(checks, places.case)
    for line in headline_line(document):
        lines += folded(line)
    for line in measured_line(document):
        lines += folded(line)
    if not governs_first(checks):
        lines += [shortened(line) for line in governing_line(checks)]
    if document["scope"]["statement"]:
        lines.append(shortened(document["scope"]["statement"]))
    return lines + place_line(document, places)


def trial_lines(run: Run) -> list[str]:
    """Lines on the trials: smoothing, ripple left, failed required checks.

    The worst `WORST` are named by their ids. None of a single trial.
    """
    if len(run.trials) < 2:
        return []
    lines = [_TRIAL.format("trial", "smoothing", "ripple left", "failed required checks")]
    for trial, ripple in zip(run.trials, run.ripples, strict=True):
        width = trial.record["smoothing_width_deg"]
        smoothing = str(trial.record["smoothing_kind"])
        smoothing += "" if width is None else f", {width:.4g} deg"
        left = "-" if ripple is None else f"{ripple:.3g} N m"
        failed = of_records(failures(records_of(within_depth(of_records(trial.checks)))))
        named = [f"{each.id} {used(each.utilisation)}" for each in failed[:WORST]]
        words = f"{len(failed)}: {', '.join(named)}" if failed else "none"
        line = _TRIAL.format(f"{trial.number:>5}", smoothing, left, words)
        cut = len(line) > WIDTH or len(failed) > WORST
        lines.append(f"{line[: WIDTH - 2].rstrip(' ,')} {_CUT}" if cut else line)
    return lines


def verdict_words(document: Mapping[str, Any]) -> str:
    """Verdict with its reasons in words; below the certified depth the screen. `document`: as of
    `camwright check --json`.
    """
    line = document["verdict_line"]
    if document["verdict"] is None:
        return f"screen: {line}; no verdict below the certified depth"
    return f"verdict: {line}"


def load_end_line(document: Mapping[str, Any]) -> list[str]:
    """Line on the angles of take-off or locking of the follower; none without any."""
    words = load_end_words(document.get("load_ends") or ())
    return [f"the follower {words}: loads there are not evaluated"] if words else []


def failures(checks: Iterable[CheckRecord]) -> list[CheckRecord]:
    """Failed required checks, those of the design before evidence, worst first."""
    return _failed(checks, must_have=True)


def governs_first(checks: Iterable[CheckRecord]) -> bool:
    """Whether the first of `failures` is the governing check, where described."""
    checks = tuple(checks)
    return [governing_id(of_records(checks))] == [check["id"] for check in failures(checks)[:1]]


def _failed(checks: Iterable[CheckRecord], *, must_have: bool) -> list[CheckRecord]:
    """Failed required checks, else the optional ones: those of the design, then evidence."""
    failed = in_order(
        each for each in of_records(checks) if each.must_have is must_have and each.status == "fail"
    )
    return list(records_of(sorted(failed, key=lambda each: each.evidence)))


def failure_words(check: CheckRecord, room: int | None = None) -> str:
    """Failed check in words: title, demand, limit, utilisation, load case and cam angle.

    Parameters
    ----------
    check : mapping   its record
    room : int        columns to which the title is shortened; None: not shortened
    """
    judged, unit = RecordedCheck(check), unit_text(check["unit"])
    demand = number(judged.worst)
    sense = ">=" if check["sense"] == "at_least" else "<="
    where = place(check)
    words = f": {demand}{unit}, limit {sense} {number(check['limit'])}{unit}"
    words += f" ({used(judged.utilisation)})" + (f", {where}" if where else "")
    title = check["title"]
    if room is not None:
        title = shortened(title, max(room - len(words), _LEAST_TITLE))
    return f"{title}{words}"


def missing_keys(checks: Iterable[CheckRecord], *, must_have: bool = True) -> dict[str, list[str]]:
    """Missing keys of a case, each with the ids of the checks that need it.

    Parameters
    ----------
    checks : iterable   records
    must_have : bool    of the required checks; False: of the optional ones
    """
    keys: dict[str, list[str]] = {}
    for check in checks:
        if check["must_have"] is must_have and check["status"] == "not_evaluated":
            for key in check.get("missing") or ():
                keys.setdefault(key, []).append(check["id"])
    return keys


def missing_count(checks: Iterable[CheckRecord], case: str) -> list[str]:
    """List with a line on the number of keys that the required checks lack, and the command that
    lists them; empty where none is missing.

    Parameters
    ----------
    checks : iterable   records
    case : str          name of the case file
    """
    count = len(missing_keys(checks))
    if not count:
        return []
    keys = "1 key" if count == 1 else f"{count} keys"
    return [f"missing: {keys} of the case, listed by camwright check {case} --missing"]


def failure_lines(checks: Iterable[CheckRecord]) -> list[str]:
    """Lines on all failed required checks, with id and remedy."""
    return _failed_lines("fails", failures(checks))


def advisory_lines(checks: Iterable[CheckRecord]) -> list[str]:
    """Lines on all failed optional checks, with id and remedy."""
    failed = _failed(checks, must_have=False)
    return _failed_lines("beyond its limit, decides nothing", failed)


def _failed_lines(word: str, failed: Iterable[CheckRecord]) -> list[str]:
    """Lines on failed checks, each begun by `word`: demand and limit, id with remarks, remedy."""
    lines = []
    for check in failed:
        lines.append(f"{word}: {failure_words(check)}")
        remarks = (not_proven(check), corner(check), check["note"])
        lines.append(f"    {check['id']}: {'; '.join(filter(None, remarks))}".rstrip(": "))
        if check.get("remedy"):
            lines.append(f"    remedy: {check['remedy']}")
    return lines


def missing_lines(checks: Sequence[CheckRecord], case: str) -> list[str]:
    """Lines on missing keys with the required checks that need them, on required checks that lack
    other data, and on the number of keys.

    Parameters
    ----------
    checks : sequence   records
    case : str          name of the case file
    """
    keys = missing_keys(checks)
    by_ids: dict[str, list[str]] = {}
    for key, ids in keys.items():
        by_ids.setdefault(", ".join(ids), []).append(key)
    lines = [f"missing: {', '.join(keys)}, for {ids}" for ids, keys in by_ids.items()]
    without = (
        check
        for check in checks
        if check["must_have"] and check["status"] == "not_evaluated" and not check.get("missing")
    )
    lines += [
        f"not evaluated: {', '.join(ids)}: {reason}"
        for reason, ids in ids_by_reason(without).items()
    ]
    return lines + missing_count(checks, case)


def torque_lines(torques: Mapping[str, Torque]) -> list[str]:
    """Lines on the torque to balance, one for each load case; none for a stated lift."""
    lines = []
    for name, torque in torques.items():
        swing = torque.peak_to_peak
        mean = torque.mean if abs(torque.mean) > _MEAN_ROUND_OFF * swing else 0.0
        lines.append(
            f"torque to balance, {name}: mean {mean:.4g} N m, ripple {torque.std:.4g} N m, "
            f"peak to peak {swing:.4g} N m"
        )
    return lines


def figure_lines(known: Mapping[str, Any]) -> list[str]:
    """Lines on the figures of the cam and of each load case; see `run_records.figures`."""
    lines = [f"figures: {_listed(known, _OF_THE_CAM)}"]
    for row in known["load_cases"]:
        words = _listed(row, _OF_A_LOAD_CASE)
        speed, cam = (f"{row[key]:.5g} rpm" for key in ("speed_rpm", "cam_speed_rpm"))
        speeds = speed if speed == cam else f"{speed}, cam {cam}"
        lines.append(f"figures of {row['load_case']} at {speeds}: {words}")
    return lines


_OF_THE_CAM = (
    ("lift", ("lift_max_mm",), "mm"),
    ("pressure angle", ("pressure_angle_max_deg",), "deg"),
    ("least convex radius of the contour", ("convex_radius_min_mm",), "mm"),
    ("cam radius", ("cam_radius_max_mm",), "mm"),
)
_OF_A_LOAD_CASE = (
    ("contact force", ("normal_force_min_N", "normal_force_max_N"), "N"),
    ("torque on the cam", ("drive_torque_min_Nm", "drive_torque_max_Nm"), "N m"),
    ("Hertz pressure", ("p0_hertz_max_MPa",), "MPa"),
    ("half-width", ("half_width_max_mm",), "mm"),
)


def _listed(row: Mapping[str, Any], titles: Iterable[tuple[str, tuple[str, ...], str]]) -> str:
    """Figures in words, to five digits, unknown ones left out.

    Parameters
    ----------
    row : mapping       figures by key; None: unknown
    titles : iterable   title, keys of its figures (two: a range), unit
    """
    parts = []
    for title, keys, unit in titles:
        known = [f"{row[key] + 0.0:.5g}" for key in keys if row[key] is not None]  # no -0
        parts += [f"{title} {' to '.join(known)} {unit}"] if known else []
    return ", ".join(parts)


def next_lines(document: Mapping[str, Any], places: Places) -> list[str]:
    """Lines on the next step: command for the remedies of failures, for the missing data, or for
    the deeper solution; empty where there is none.

    Parameters
    ----------
    document : mapping   as of `camwright check --json`
    places : Places      name of the case file, for the command
    """
    checks = records_of(within_depth(of_records(document["checks"])))
    failed = failures(checks)
    if failed and not any(check.get("remedy") for check in failed):
        return [f"next: camwright design remedies {places.case}"]
    if document["screen"] != OPEN:
        return []
    if document["binding"]:
        lines = ["so far no check fails; the missing data above decide what is left"]
        if missing_keys(checks):
            lines.append(f"next: camwright check {places.case} --missing")
        return lines
    so_far = "all is well so far: every check that a preview can judge passes"
    if document["depth"] != PREVIEW:
        so_far = f"all is well so far: every check at the depth {document['depth']} passes"
    name = Path(places.case).stem
    return [
        f"{so_far}. OPEN, as deeper ones need finite elements;",
        f"next: camwright run {places.case} --out runs/{name}",
    ]


def headline_line(document: Mapping[str, Any]) -> list[str]:
    """A list of one line for the terminal, empty where no figure is known: standard deviation of
    the crankshaft's torque without and with the cam, N m, maximum contact pressure, and von Mises
    stresses of cam and roller, MPa.

    document : mapping   as of `camwright check --json`
    """
    figures = document.get("headline") or {}
    before, after = (figures.get(f"torque_std_{when}_Nm") for when in ("before", "after"))
    parts = []
    if before and after is not None:
        change = f"{after / before - 1.0:+.0%}".replace("%", " %")
        parts.append(f"torque ripple {before:.3g} to {after:.3g} N m ({change})")
    if (pressure := figures.get("p0_max_MPa")) is not None:
        parts.append(f"p0 {pressure:.4g} MPa")
    if stresses := body_stresses(figures):
        parts.append(f"von Mises {'; '.join(stresses)}")
    return [f"headline: {', '.join(parts)}"] if parts else []


def body_stresses(figures: Mapping[str, Any]) -> list[str]:
    """Greatest stress of cam, follower and roller ring in words, with place, such as ``606 MPa in
    the cam, ...``; unknown ones left out.

    Parameters
    ----------
    figures : mapping   headline of a run
    """
    stress, depth = (figures.get(f"von_mises_{of}") for of in ("max_MPa", "depth_mm"))
    place = f", {depth:.2g} mm below the surface" if depth is not None else ""
    parts = (
        (stress, f"in the cam{place}"),
        (figures.get("follower_von_mises_max_MPa"), "in the follower"),
        (figures.get("ring_stress_max_MPa"), "in the roller ring by bending"),
    )
    return [f"{value:.4g} MPa {words}" for value, words in parts if value is not None]


def governing_line(checks: Iterable[CheckRecord]) -> list[str]:
    """List with a line on the governing check: title, utilisation and place; empty without one."""
    first = governing(of_records(checks))
    if first is None:
        return []
    where = place(first.record)
    words = f"{first.record['title']}, {used(first.utilisation)} used"
    return [f"governing: {words}" + (f", {where}" if where else "")]


def measured_line(document: Mapping[str, Any]) -> list[str]:
    """List with a line on a measured crank speed: runs, cycles, wheel, sampling rate, error bar of
    its torque; empty without one. `document`: as of `camwright check --json`.
    """
    record: Mapping[str, Any] = document.get("measurement") or {}
    if "torque_error_bar_max_Nm" not in record:
        return []
    counts = {noun: record[f"{noun}s"] for noun in ("run", "cycle") if f"{noun}s" in record}
    parts = [f"{n} {noun}{'' if n == 1 else 's'}" for noun, n in counts.items()]
    if "wheel" in record:
        parts.append(f"trigger wheel {record['wheel']}")
    if "sampling_rate_Hz" in record:
        parts.append(f"sampled at {number(1e-3 * record['sampling_rate_Hz'])} kHz")
    bar, share = record["torque_error_bar_max_Nm"], record["torque_error_bar_percent"]
    error = f"95 % error bar of the torque {number(bar)} N m, {share:.2g} % of peak to peak"
    return [f"measured: {', '.join(parts)}; {error}"]


def place_line(document: Mapping[str, Any], places: Places) -> list[str]:
    """List with a line on page, analysis sheet, number of trials and time; empty for a case.

    Parameters
    ----------
    document : mapping   as of `camwright check --json`
    places : Places      path of the page, and time taken
    """
    parts = [f"page: {places.page}, analysis sheet: #sheet in it"] if places.page else []
    if count := document.get("trials"):
        parts.append("1 trial" if count == 1 else f"{count} trials")
    if places.seconds is not None:
        parts.append(f"{places.seconds:.1f} s")
    return ["; ".join(parts)] if parts else []


def folded(text: str, most: int = 2) -> list[str]:
    """Text wrapped to `WIDTH` columns, cut after `most` lines."""
    return textwrap.wrap(
        text, WIDTH, subsequent_indent="  ", max_lines=most, placeholder=_CUT,
        break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip


def shortened(text: str, width: int = WIDTH) -> str:
    """Text in one line, cut to a number of columns."""
    indent = " " * (len(text) - len(text.lstrip(" ")))
    line = indent + " ".join(text.split())
    return line if len(line) <= width else line[: width - 1].rstrip() + _CUT
