"""Command `run`: a case from its torque to a run folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from camwright.geometry.errors import InputError
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    PASSED,
    CaseArgument,
    JobsOption,
    NoCacheOption,
    PngOption,
    ResumeOption,
    page_of,
    progress_shown,
    show,
    stdout,
    use_cache,
)
from camwright.pipeline.records.forms import DEPTHS

FIELDS = ("none", "worst", "default", "all")
"""Values of `field_output.Shown`, which is imported with the solver alone."""


def run(
    case: CaseArgument,
    *,
    out: Annotated[Path, Words("Run folder to write.", "DIR")],
    positions: Annotated[int | None, Words("Positions per cam turn; default: of the case.")] = None,
    jobs: JobsOption = None,
    depth: Annotated[
        str,
        Words(
            "Closed forms, finite elements, or both with a certificate, which alone has a verdict; "
            "default: certified.",
            "DEPTH",
            choices=DEPTHS,
        ),
    ] = "certified",
    no_report: Annotated[bool, Words("Write no page and no figures.")] = False,
    png: PngOption = False,
    resume: ResumeOption = False,
    replace: Annotated[
        bool,
        Words(
            "Replace an earlier run of a case of this name, with its inspections, decks and "
            "changed files; files of the user are never deleted."
        ),
    ] = False,
    fields: Annotated[
        str,
        Words(
            "Cam angles of the stress field; default: the worst, the certified, every 15 deg.",
            "ANGLES",
            choices=FIELDS,
        ),
    ] = "default",
    no_cache: NoCacheOption = False,
) -> int:
    """Run a case from its torque to a verdict and write its run folder.

    The cam is solved by finite elements at every position, judged at its tolerance corners, and
    smoothed until every check passes or a limit binds. An interrupted run is completed by
    --resume.

    Example: camwright run pump.toml --out runs/pump --positions 72
    """
    from camwright.pipeline.base.progress import process_began
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.contact.tiers import Tier

    use_cache(not no_cache)
    tier = Tier.of(depth, "--depth")
    if fields not in FIELDS:
        raise InputError("--fields", fields, f"one of {', '.join(FIELDS)}")
    design = read_case(case)
    if positions is not None:
        design = design.with_positions(positions)
    if not (resume and _finished(out, design.sha256, depth)):
        from camwright.pipeline.results.field_output import Shown
        from camwright.pipeline.run import CaseRun
        from camwright.reports import sections

        drawings = None if no_report else sections.Ahead(sections.chosen(png=png))
        with (
            progress_shown() as progress,
            CaseRun(
                design,
                out,
                depth=tier,
                jobs=jobs,
                resume=resume,
                replace=replace,
                fields=Shown(fields),
                progress=progress,
                began=process_began(),
            ) as made,
        ):
            made.solve()
            made.write()
            if drawings is not None and tier is Tier.CERTIFIED:
                drawings.begin(made.draft(), made.workers)
            made.certify()
            if drawings is not None:
                drawings.write(made.draft())
            made.finish()
    from camwright.pipeline.results.run_reader import read_run, read_summary, read_verdict
    from camwright.pipeline.results.verdict_summary import Places, trial_lines

    seconds = read_summary(out)["timings_s"]["total"]
    for line in trial_lines(read_run(out)):
        stdout.print(line, markup=False)
    show(read_verdict(out), Places(str(out), str(case), page_of(out), seconds))
    return PASSED


def _finished(out: Path, sha256: str, depth: str) -> bool:
    """Whether a folder holds a finished run of a case, at a depth, by the versions of this program.

    Parameters
    ----------
    out : Path     run folder
    sha256 : str   hash of the input of the case
    depth : str    word of the depth

    Raises
    ------
    AlteredError
        If the run is not as recorded.
    """
    from camwright.pipeline.results.folder_exchange import complete_exchange
    from camwright.pipeline.results.run_folder import versions
    from camwright.pipeline.results.run_reader import read_summary
    from camwright.pipeline.results.signoff import require_recorded

    complete_exchange(out)
    if not (out / "run.json").is_file():
        return False
    require_recorded(out)
    summary = read_summary(out)
    same = summary["input_sha256"] == sha256 and summary["depth"] == depth
    return bool(same and summary["versions"] == versions())
