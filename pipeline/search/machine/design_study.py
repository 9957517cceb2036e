"""Command `design machine`: from a torque to a case file with all parts, and its front."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
from typing_extensions import Unpack

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base import units
from camwright.pipeline.base.files import json_text, write_atomic
from camwright.pipeline.base.owned_folder import OwnedFolder
from camwright.pipeline.base.progress import SILENT, Progress
from camwright.pipeline.base.worker_processes import Crew, crew
from camwright.pipeline.case.cards.card_filling import USER_FILE
from camwright.pipeline.case.cards.catalogue import SPRINGS_FILE
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.limits import SPRING_SURGE
from camwright.pipeline.case.section import SAFE_NAME
from camwright.pipeline.checks.registry import DECLARED
from camwright.pipeline.cycle.machine_envelope import sizes_of
from camwright.pipeline.preview import preview_case
from camwright.pipeline.records.design_document import (
    DesignDocument,
    DesignDrawing,
    DesignOptions,
    DesignPointRecord,
    RelaxationRecord,
    TorqueRecord,
)
from camwright.pipeline.results.check_records import to_be_confirmed
from camwright.pipeline.results.run_folder import versions
from camwright.pipeline.search.judge import STORED
from camwright.pipeline.search.machine.candidate_search import Candidate, candidates
from camwright.pipeline.search.machine.design_case import WRITTEN, case_text
from camwright.pipeline.search.machine.part_exchange import Exchanged, exchanged
from camwright.pipeline.search.machine.relaxation_search import relaxations
from camwright.pipeline.search.machine.synthesised_points import (
    PointStudy,
    Solved,
    drafts,
    solved_front,
)
from camwright.pipeline.search.machine.torque_task import DesignTask, task_of

RECORD = "design.json"
PICTURE = "design.png"
# Of the size of a design, for its tolerances: of the space that is offered, and as printed.
_ROOM_SPARE, _SPARE_PRINTED = 1.001, 1.0005
_BINDING_NAMED = 3  # limits that the nearest design uses fully, named with those that it fails
_OURS = re.compile(
    rf"design\.(json|png)|point_\d+\.toml|{STORED}|.*\.csv|cards\.toml|springs\.toml"
)


def design_from_torque(
    torque: str | Path,
    out: str | Path,
    *,
    progress: Progress = SILENT,
    **options: Unpack[DesignOptions],
) -> DesignDocument:
    """Case file of a torque table, as `camwright design machine`.

    Parameters
    ----------
    torque : path   CSV: shaft angle and torque of one cycle
    out : path      case file to write; the points are in the folder ``NAME_design``
    options         see `DesignOptions`; ``speed`` is required

    Returns
    -------
    dict   contents of ``design.json``: ``chosen`` is None where no design passes

    Raises
    ------
    CamError
        If an option or the torque is refused.
    """
    return designed(task_of(torque, **options), Path(out), progress)


def points_folder(out: Path) -> Path:
    """Folder of the points, the record and the picture of a case file."""
    return out.with_name(f"{out.stem}_design")


def designed(task: DesignTask, out: Path, progress: Progress = SILENT) -> DesignDocument:
    """Design a cam mechanism for a torque: write the case file of the smallest design that passes,
    and its front of ripple and size; conflicting limits and relaxations where none passes.

    Parameters
    ----------
    task : DesignTask     torque, speeds and requirements
    out : Path            case file; the points are in the folder of its name, ``CASE_design``
    progress : Progress   told each stage

    Returns
    -------
    dict   contents of ``design.json``

    Raises
    ------
    CamError
        If the torque cannot be read, or the folder has other content.
    """
    if out.suffix != ".toml" or not SAFE_NAME.fullmatch(out.stem):
        raise InputError("--out", out.name, "a file NAME.toml of letters, digits, '_', '-' or '.'")
    folder = points_folder(out).absolute()
    with OwnedFolder(folder, _OURS, "design"):
        return _designed(task, folder, out, progress)


def _designed(task: DesignTask, folder: Path, out: Path, progress: Progress) -> DesignDocument:
    """As `designed`, with `folder` for the points, which this process alone writes."""
    file, copied = _copied(task, folder, out)
    study = PointStudy(task, folder, file, versions()["source"])
    progress.stage("search rollers, springs and base circles")
    screened = candidates(task, folder, file, progress)
    with crew(None) as workers:
        progress.stage("solve the front")
        points, failing = solved_front(study, drafts(study, screened, workers), workers, progress)
        changes: list[RelaxationRecord] = []
        smaller: Exchanged | None = None
        roomy = None if points or task.space is None else _without_limit(study, workers, progress)
        if roomy is not None:
            points = _within_space(study, roomy.point)
        if points:
            head = _summary(study, points, None)
            write_atomic(out, _written(points[0], out.stem, file, head))  # a first answer
            progress.stage("exchange parts")
            smaller = exchanged(study, points[0], workers, progress)
            points = [smaller.point, *points[1:]]
        else:
            progress.stage("relaxations")
            nearest = failing[0] if failing else None
            room = inf if roomy is None else _ROOM_SPARE * roomy.point.size
            changes = relaxations(study, nearest, out, workers, progress, room)
    document: DesignDocument = {
        "schema": 2,
        "torque": _demand_record(task),
        "assumed": sorted(task.assumed),
        "copied": copied,
        "remove": task.remove,
        "space_mm": None if task.space is None else 1e3 * task.space,
        "screened": len(screened),
        "within_limits": sum(each.excess == 0.0 for each in screened),
        "cloud": [
            {
                "size_mm": round(1e3 * each.size, 2),
                "ripple_left_Nm": round(each.ripple, 5),
                "within_limits": each.excess == 0.0,
            }
            for each in _sampled(screened)
        ],
        "points": [],
        "chosen": None,
        "conflict": None,
    }
    if smaller is not None:
        document["points"] = _write_points(study, points)
        document["chosen"] = {
            **document["points"][0],
            **_drawing(study, points[0]),
            "file": out.name,
            "exchanges": smaller.as_record(),
        }
        head = _summary(study, points, smaller)
        write_atomic(out, _written(points[0], out.stem, file, head))
    else:
        limits = _limits(task, screened, failing)
        document["conflict"] = {"limits": limits, "relaxations": changes}
    write_atomic(folder / RECORD, json_text(document) + "\n")
    return document


def _without_limit(study: PointStudy, workers: Crew, progress: Progress) -> Exchanged | None:
    """Smallest design that the search reaches by exchange of parts when the space is not limited,
    with its exchanges; None where none passes.
    """
    task = study.task
    roomy = replace(study, task=replace(task, space=None))
    progress.stage("solve the front without the limit of the space")
    screened = candidates(roomy.task, study.folder, study.file, SILENT)
    points, _ = solved_front(roomy, drafts(roomy, screened, workers), workers, progress)
    if not points:
        return None
    progress.stage("exchange parts")
    return exchanged(roomy, points[0], workers, progress)


def _within_space(study: PointStudy, point: Solved) -> list[Solved]:
    """Design found without a limit of the space, solved again with the limit; in a list, which is
    empty if the design is too large or fails.
    """
    space = study.task.space
    if space is None or _SPARE_PRINTED * point.size > space:
        return []
    limited = study.solved(replace(point.design, task=study.task))
    return [limited] if limited.has_cam and limited.passes else []


def _copied(task: DesignTask, folder: Path, out: Path) -> tuple[str, list[str]]:
    """Copy the torque table and the user's cards to the folder of the points and beside the case
    file.

    Gives the name of the table, and the names of the files beside the case that are copies.

    Parameters
    ----------
    task : DesignTask   with the file of the torque
    folder : Path       of the points
    out : Path          case file

    Raises
    ------
    ResultError
        If a file of such a name beside the case differs.
    """
    name = task.file.name if task.file.suffix == ".csv" else f"{out.stem}_torque.csv"
    source, beside = task.file.resolve().parent, out.resolve().parent
    sources = {name: task.file}
    sources |= {each: source / each for each in (USER_FILE, SPRINGS_FILE)}
    contents = {kept: path.read_bytes() for kept, path in sources.items() if path.is_file()}
    for kept, content in contents.items():
        target = beside / kept
        if target.is_file() and target.read_bytes() != content:
            raise ResultError(f"{target}: differs from {sources[kept]}, its source; remove either")
    copied = [kept for kept in contents if (beside / kept) != sources[kept].resolve()]
    for kept, content in contents.items():
        write_atomic(folder / kept, content)
        if kept in copied:
            write_atomic(beside / kept, content)
    return name, copied


def _sampled(screened: Sequence[Candidate], most: int = 400) -> list[Candidate]:
    """Evenly spaced candidates, for the picture."""
    step = max(1, len(screened) // most)
    return list(screened[::step])


def _demand_record(task: DesignTask) -> TorqueRecord:
    demand = task.demand
    return {
        "file": task.file.name,
        "cycle_deg": float(np.degrees(demand.cycle)),
        "ratio": task.ratio,
        "speed_rpm": units.in_unit(task.speed, "rpm"),
        "overspeed_rpm": units.in_unit(task.overspeed, "rpm"),
        "ripple_Nm": demand.ripple,
        "energy_swing_J": demand.energy_swing,
        "peak_Nm": demand.peak,
        "values_Nm": [round(float(value), 6) for value in demand.torque[::4]],
    }


def _record(study: PointStudy, point: Solved, file: str = "") -> DesignPointRecord:
    """Record of a solved design for ``design.json``: parts, size, ripple removed and figures of its
    preview.

    Parameters
    ----------
    study : PointStudy   which makes the text of its case
    point : Solved       the design
    file : str           name of its case file; "": it is not written
    """
    design, figures = point.design, point.whole
    spring = design.spring.spring
    name = spring.name or (
        f"wound {1e3 * spring.wire_diameter:g} x {1e3 * spring.mean_diameter:.4g} mm, "
        f"{spring.coils:g} coils"
    )
    case = parse_case(study.text(design), study.folder)
    radius, lift = 1e-3 * figures["cam_radius_mm"], 1e-3 * figures["lift_max_mm"]
    lengths = sizes_of(case, radius, lift).envelope.size
    return {
        "file": file,
        "envelope_mm": [round(1e3 * length, 2) for length in lengths],
        "size_mm": 1e3 * point.size,
        "removed": 1.0 - point.ripple / design.task.demand.ripple,
        "roller": design.frame.roller,
        "spring": name,
        "offset_mm": 1e3 * design.offset,
        "stem_mm": 1e3 * design.frame.stem,
        "bore_mm": 1e3 * design.frame.seat.bore,
        **figures,
    }


def _drawing(study: PointStudy, point: Solved) -> DesignDrawing:
    """What the picture of a design shows: contour and roller at the least lift, mm, torque left
    about its mean, N m, and values to be confirmed.
    """
    case = parse_case(study.text(point.design), study.folder)
    trial = preview_case(case, corners=False, kept=True)
    after, contour = trial.cycles[0].turn.torque_after, trial.contour
    rest = np.zeros(0) if after is None else np.asarray(after)
    theta = uniform_turn(360)
    lowest = theta[int(np.argmin(contour.lift.values[:: contour.lift.values.size // 360]))]
    normal, surface = contour.normal(lowest), contour.points(lowest)
    centre = surface + normal * trial.case.roller.radius
    return {
        "contour_mm": [[round(1e3 * float(v), 4) for v in row] for row in contour.points(theta)],
        "roller_radius_mm": 1e3 * trial.case.roller.radius,
        "roller_centre_mm": [round(1e3 * float(v), 4) for v in centre],
        "torque_after_Nm": [round(float(v), 6) for v in rest - rest.mean()],
        "to_be_confirmed": to_be_confirmed([check.as_record() for check in trial.checks]),
    }


def _write_points(study: PointStudy, points: Sequence[Solved]) -> list[DesignPointRecord]:
    """Write a case file for each design of the front, ``point_NN.toml``, in place of earlier ones;
    returns their records.
    """
    for old in study.folder.glob("point_*.toml"):
        old.unlink()
    rows: list[DesignPointRecord] = []
    for number, point in enumerate(points, start=1):
        name = f"point_{number:02d}"
        head = f"# Point {number} of {len(points)} of the front of ripple against size.\n"
        write_atomic(study.folder / f"{name}.toml", _written(point, name, study.file, head))
        rows.append(_record(study, point, f"{name}.toml"))
    return rows


def _written(point: Solved, name: str, file: str, head: str) -> str:
    """Case file of a point for a run, whose finite elements need more cam angles than the search.

    The error bars of their residuals are of the values between the angles.
    """
    return case_text(point.design, name, file, head, positions=WRITTEN)


def _summary(study: PointStudy, points: Sequence[Solved], smaller: Exchanged | None) -> str:
    """Comment at the head of the case file: ripple removed, size, exchanges of parts, and the
    front.

    Parameters
    ----------
    study : PointStudy    the task
    points : sequence     designs of the front, the chosen one first
    smaller : Exchanged   exchanges of the chosen one; None: its parts are yet to be exchanged
    """
    best, task = points[0], study.task
    row = _record(study, best)
    shown = "its parts are yet to be exchanged" if smaller is None else smaller.sentence
    whole = " x ".join(f"{length:.4g}" for length in row["envelope_mm"])
    lines = [
        f"# Designed from {study.file}: {100 * row['removed']:.0f} % of the torque ripple removed"
        f" by closed forms,",
        f"# {best.ripple:.4g} of {task.demand.ripple:.4g} N m (std) left; "
        f"{row['size_mm']:.4g} mm from the cam's far side to the top of the roller.",
        f"# The whole mechanism over its turn: {whole} mm across and along the stem, and along the"
        f" camshaft.",
        "# The smallest of the designs that were solved and pass;",
        f"# {shown}.",
        "# The front of those solved, size against ripple left:",
    ]
    lines += [f"#   {1e3 * each.size:7.1f} mm  {each.ripple:8.4g} N m" for each in points]
    return "\n".join(lines) + "\n"


def _limits(task: DesignTask, screened: Sequence[Candidate], points: Sequence[Solved]) -> list[str]:
    """Titles of the limits that no design keeps together.

    Those of the nearest design that fails; without one, those that govern most screened designs;
    without these, what excludes every spring and roller.

    Parameters
    ----------
    task : DesignTask     the task
    screened : sequence   all screened designs
    points : sequence     solved designs that fail, the nearest first
    """
    if points:
        near = points[0]
        failing = near.failing or ["the limits of the synthesis at the ends of the tolerances"]
        return failing + [title for title in near.used_up if title not in failing][:_BINDING_NAMED]
    if screened:
        counts = Counter(each.governing for each in screened if each.excess > 0.0)
        return [DECLARED[name].title for name, _ in counts.most_common(3)]
    speed = units.shown(task.cam_speed, "rpm")
    return [
        f"energy of {units.shown((task.remove) * task.demand.energy_swing, 'J')} in one spring",
        f"surge frequency of {SPRING_SURGE.default:g} times the cam's at {speed}",
        "ratings of the rollers of the catalogue",
    ]
