"""Command `design machine`: from a torque table to a case file with all parts."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    EXIT_CODE,
    FAILED,
    PASSED,
    JsonOption,
    progress_shown,
    show_json,
    stdout,
)
from camwright.pipeline.records.design_document import (
    ChosenDesign,
    DesignDocument,
    DesignOptions,
    ExchangesRecord,
)


def machine(
    torque: Annotated[Path, Words("CSV: shaft angle and torque of one cycle.", "TORQUE")],
    *,
    options: DesignOptions,
    out: Annotated[Path, Words("Case file to write.", "CASE")],
    and_run: Annotated[bool, Words("Run the chosen case.", typed="--run")] = False,
    as_json: JsonOption = False,
) -> int:
    """Design a cam with all its parts for the torque of a machine.

    Spring, preload, base circle, roller, guides, shaft and key from the catalogues, the lift by
    the constrained synthesis. Writes the smallest of the solved cases that pass by closed forms,
    its parts exchanged for the next smaller of their catalogues until none passes, the front of
    ripple against size in CASE_design, and a picture of the choice. Where none passes, prints the
    limits in conflict and relaxations that pass. What is not given is assumed, and marked so.

    With --run the exit code is that of the verdict. Solved points are cached in CASE_design/solved;
    run the same command again to resume. The table, and cards.toml and springs.toml beside it, are
    copied beside the case.

    Example: camwright design machine pump.csv --speed "1500 rpm" --out pump.toml
    """
    from camwright.pipeline.search.machine.design_study import PICTURE, designed, points_folder
    from camwright.pipeline.search.machine.torque_task import task_of
    from camwright.reports.study import design_picture

    task = task_of(torque, **options)
    with progress_shown() as progress:
        document = designed(task, out, progress)
    picture = design_picture.write(points_folder(out) / PICTURE, document)
    if as_json:
        show_json(document)
    else:
        _show(document, out)
        stdout.print(f"picture: {picture}", markup=False)
    if document["chosen"] is None:
        return FAILED
    return _run(out) if and_run else PASSED


def _whole(point: ChosenDesign) -> str:
    return " x ".join(f"{length:.4g}" for length in point["envelope_mm"])


def _show(document: DesignDocument, out: Path) -> None:
    """Print the result of a machine design: torque, front, chosen design with what was assumed, or
    the limits in conflict with relaxations.

    Parameters
    ----------
    document : dict   contents of ``design.json``
    out : Path        case file of the chosen design
    """
    demand = document["torque"]
    stdout.print(
        f"torque: {demand['ripple_Nm']:.4g} N m of ripple (std), {demand['energy_swing_J']:.4g} J "
        f"of energy swing over {demand['cycle_deg']:g} deg",
        markup=False,
    )
    for row in document["points"]:
        stdout.print(
            f"  {row['file']}: {row['size_mm']:.4g} mm, {row['ripple_left_Nm']:.4g} N m left "
            f"({100 * row['removed']:.0f} % removed), {row['roller']}, spring {row['spring']}",
            markup=False,
        )
    if document["copied"]:
        stdout.print(f"copied beside the case: {', '.join(document['copied'])}", markup=False)
    chosen, assumed = document["chosen"], ", ".join(document["assumed"]) or "nothing"
    if chosen is not None:
        stdout.print(
            f"chosen: {out}: {chosen['size_mm']:.4g} mm, {100 * chosen['removed']:.0f} % removed; "
            f"passes by closed forms, the smallest of those solved that do\n"
            f"{_exchanges(chosen['exchanges'])}\n"
            f"whole mechanism, across and along the stem, along the camshaft: {_whole(chosen)} mm\n"
            f"options not given, so assumed: {assumed}; values to be confirmed in all: "
            f"{len(chosen['to_be_confirmed'])}, listed by camwright check after the run\n"
            f"next: camwright run {out} --out runs/{out.stem}",
            markup=False,
        )
        return
    conflict = document["conflict"]
    if conflict is None:
        return
    stdout.print(
        f"the search keeps no design within: {'; '.join(conflict['limits'])}", markup=False
    )
    for each in conflict["relaxations"]:
        stdout.print(
            f"  passes with {each['option']} {each['to']}, not {each['from']}; none "
            f"found with {each['fails_at']}:",
            markup=False,
        )
        stdout.print(f"    {each['command']}", markup=False, soft_wrap=True)
    if conflict["relaxations"]:
        stdout.print(
            "  each: one option alone; with half of its change, by the ratio of its values, the "
            "search finds none, nor of the first with 2 % less. Exchanges of parts, which follow a "
            "design that passes, may find more",
            markup=False,
        )
    else:
        stdout.print(
            "  the search finds none with a relaxation of one option within its range", markup=False
        )


def _exchanges(record: ExchangesRecord) -> str:
    """Lines on which parts were exchanged for smaller ones and why no further one passes."""
    lines = [
        f"  exchanged: {each['part']} {each['from']} for {each['to']}" for each in record["kept"]
    ]
    lines.append(f"{record['claim']}{':' if record['failing'] else ''}")
    lines += [f"  {each['part']} {each['to']}: {each['why']}" for each in record["failing"]]
    return "\n".join(lines)


def _run(case: Path) -> int:
    """Run the case into runs/NAME beside it; gives the exit code of its verdict."""
    from camwright.pipeline.commands.run_command import run
    from camwright.pipeline.results.run_reader import read_verdict

    folder = case.absolute().parent / "runs" / case.stem
    run(case, out=folder, replace=folder.exists())
    return EXIT_CODE[read_verdict(folder)["verdict"]]
