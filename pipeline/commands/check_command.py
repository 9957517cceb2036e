"""Commands `check`, verdict of a run or preview of a case, and `design remedies`."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from camwright.geometry.errors import CamError, InputError, ResultError
from camwright.pipeline.base.verdict import FAIL_ON
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import (
    ALTERED,
    ERROR,
    EXIT_CODE,
    FAILED,
    INCOMPLETE,
    PASSED,
    JsonOption,
    page_of,
    progress_shown,
    say,
    show_all,
    show_failures,
    show_json,
    show_lines,
    show_text,
    stdout,
)

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from camwright.pipeline.recomputation import Recomputation
    from camwright.pipeline.records.check_record import CheckRecord
    from camwright.pipeline.results.junit_report import Clock
    from camwright.pipeline.results.signatures import Signature
    from camwright.pipeline.results.signing_keys import TrustedKey

OnlyChecks = Annotated[list[str] | None, Words('Check id or pattern such as "guide_*".', "CHECK")]
WholeOption = Annotated[bool, Words("Print every check, also those that pass.", typed="--all")]
SEVERITY = (PASSED, INCOMPLETE, FAILED, ALTERED, ERROR)
"""Exit codes, from the best to the worst."""


def check(
    targets: Annotated[list[Path], Words("Run folders or case files.", "RUN|CASE")],
    *,
    as_json: JsonOption = False,
    junit: Annotated[Path | None, Words("Write the checks as JUnit XML.")] = None,
    baseline: Annotated[
        Path | None, Words("Compare with the checks of an earlier run.", "RUN")
    ] = None,
    only: OnlyChecks = None,
    fail_on: Annotated[
        str,
        Words(
            "Checks that decide the exit code: must (required), open (also optional ones without "
            "data), any (also optional ones that fail), never; default: must.",
            "LEVEL",
            choices=FAIL_ON,
        ),
    ] = "must",
    whole: WholeOption = False,
    missing: Annotated[bool, Words("Print only the missing data, as TOML to be pasted.")] = False,
    verify_record: Annotated[
        bool, Words("Verify the signatures of the run; every file must be signed.")
    ] = False,
    trusted: Annotated[
        Path | None,
        Words("Public keys whose signatures are valid; default: those of this user."),
    ] = None,
    recompute: Annotated[
        bool,
        Words("Compute a run again from its case and lift, and compare every number and file."),
    ] = False,
    angles: Annotated[
        int | None,
        Words(
            "Cam angles, drawn at random, at which --recompute solves both bodies in full; "
            "default: 8."
        ),
    ] = None,
    seed: Annotated[int | None, Words("Seed of the random angles; default: a new one.")] = None,
) -> int:
    """Print failures, missing data and verdict of a run, or of a preview of a case.

    Of several runs and cases a table. A preview has a screen, no verdict: it never passes, but is
    open (exit code 3), as is a run below the certified depth. Exit code 4: the run is not as
    recorded in signoff.json, with --verify-record also unsigned or signed by an untrusted key, with
    --recompute not what its case gives. Of several the worst: error, 4, FAIL, INCOMPLETE.

    Example: camwright check pump.toml
    """
    from camwright.pipeline.base.verdict import failing

    failing((), fail_on)  # refuses an unknown level
    _require_option("--verify-record", verify_record, {"--trusted": trusted})
    _require_option("--recompute", recompute, {"--angles": angles, "--seed": seed})
    patterns, keys = only or [], _trusted_keys(trusted) if verify_record else None
    signatures: Sequence[Signature] = ()
    if len(targets) == 1:
        if missing and (text := _unreadable_without(targets[0])):
            show_text(text)
            return INCOMPLETE
        record = _recorded(targets[0], keys)
        if record.faults or (recompute and not _recomputed(targets[0], angles, seed)):
            return ALTERED
        early = show_lines if not (as_json or missing) else _unshown
        one = _judged(targets[0], patterns, fail_on, baseline, early=early)
        one.document.update(record.entries)
        judged, signatures = [one], record.signatures or ()
    else:
        _refuse_for_several(len(targets), baseline, missing, recompute)
        judged = [_of_several(each, patterns, fail_on, keys) for each in targets]
    if junit is not None:
        _write_junit(junit, judged)
    if missing:
        _show_missing(targets[0], judged[0].document["checks"])
    elif as_json:
        _show_documents(judged)
    elif len(targets) == 1:
        _show_one(targets[0], judged[0].document, signatures, whole)
    else:
        _show_overview(judged)
    return max((each.code for each in judged), key=SEVERITY.index)


def _unshown(_: Iterable[str]) -> None:
    """Show no lines."""


def _require_option(option: str, stated: bool, details: Mapping[str, Path | int | None]) -> None:
    """Refuse the details of an option that is not stated."""
    for name, value in details.items():
        if value is not None and not stated:
            raise InputError(name, str(value), f"stated with {option}")


def remedies(
    target: Annotated[Path, Words("Run folder or case file.", "RUN|CASE")],
    *,
    only: OnlyChecks = None,
    whole: WholeOption = False,
    as_json: JsonOption = False,
) -> int:
    """Seek a small change of a case that cures each failed check.

    The smallest change of one key, or of two that belong together, with its side effects, proven
    in the preview. Of a run those that it has recorded. The exit code is that of check.

    Example: camwright design remedies pump.toml
    """
    record = _recorded(target, None)
    if record.faults:
        return ALTERED
    early = _unshown if as_json else show_lines
    judged = _judged(target, only or [], "must", None, remedies=True, early=early)
    if as_json:
        show_json(judged.document)
    else:
        _show_one(target, judged.document, (), whole)
    return judged.code


def _refuse_for_several(count: int, baseline: Path | None, missing: bool, recompute: bool) -> None:
    """Refuse, by InputError, options of `check` that serve one run or case alone, as there are
    `count` of them.
    """
    options = {"--baseline": baseline, "--missing": missing, "--recompute": recompute}
    for option, value in options.items():
        if value:
            raise InputError(option, f"{count} targets", "stated with one run or case alone")


def _trusted_keys(trusted: Path | None) -> Mapping[str, TrustedKey]:
    """Keys of a file, or of this user, by fingerprint."""
    from camwright.pipeline.results.signing_keys import read_trusted

    return read_trusted(trusted)


def _write_junit(file: Path, judged: Sequence[_Judged]) -> None:
    """Write the checks of runs and cases as JUnit XML."""
    from camwright.pipeline.base.files import write_atomic
    from camwright.pipeline.results.junit_report import junit

    write_atomic(file, junit([each.suite for each in judged]))


def _show_documents(judged: Sequence[_Judged]) -> None:
    """Print the checks as JSON; those of several runs and cases in a list."""
    documents = [each.document for each in judged]
    show_json(documents[0] if len(documents) == 1 else {"runs": documents})


def _show_one(
    target: Path, document: dict[str, Any], signatures: Sequence[Signature], whole: bool
) -> None:
    """Print verdict and checks of one run or case, and who signed it.

    Parameters
    ----------
    target : Path           run folder or case file
    document : dict         as of `camwright check --json`
    signatures : sequence   that are valid
    whole : bool            all checks; else the failures alone
    """
    from camwright.pipeline.results.verdict_summary import Places

    places = Places(str(target), str(_case_of(target)), page_of(target))
    (show_all if whole else show_failures)(document, places)
    for each in signatures:
        stdout.print(f"signed: {each.words}", markup=False)


def _show_overview(judged: Sequence[_Judged]) -> None:
    """Print a table of several runs and cases."""
    from camwright.pipeline.results.check_report import overview

    stdout.print(overview(each.row for each in judged))


def _case_of(target: Path) -> Path:
    """The case file of a target of `check`."""
    return target if target.is_file() else target / "case.toml"


def _unreadable_without(target: Path) -> str:
    """TOML text of the keys without which a case file cannot be read, to be pasted; "" where it can
    be read.
    """
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.case.error_text import MissingKeysError

    try:
        if target.is_file():
            read_case(target)
    except MissingKeysError as error:
        return error.toml.removesuffix("\n")
    return ""


def _show_missing(target: Path, checks: Sequence[CheckRecord]) -> None:
    """Print the keys that the case of a target lacks, with examples, as TOML."""
    from camwright.pipeline.case.added_tables import added_text
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.results.verdict_summary import missing_keys

    needed, optional = (missing_keys(checks, must_have=each) for each in (True, False))
    text = added_text(needed, optional, read_case(_case_of(target)).materials)
    show_text(text.removesuffix("\n"))


class _Judged(NamedTuple):
    """Checks of a run or case: JSON document, row of the overview, JUnit suite, exit code."""

    document: dict[str, Any]
    row: Sequence[str]
    suite: Element
    code: int


def _judged(
    target: Path,
    only: Sequence[str],
    fail_on: str,
    baseline: Path | None,
    suite: str = "",
    *,
    remedies: bool = False,
    early: Callable[[Iterable[str]], None] = _unshown,
) -> _Judged:
    """Checks of a run folder, or of the preview of a case file, with exit code and JUnit suite.

    Parameters
    ----------
    target : Path      run folder or case file
    only : sequence    patterns of the ids of checks; empty: all
    fail_on : str      checks that decide the exit code, of `FAIL_ON`
    baseline : Path    run folder to compare with; None: none
    suite : str        name of the JUnit suite; "": that of the case
    remedies : bool    seek the remedies of a case
    early : callable   takes lines on what is known of a case before its checks

    Raises
    ------
    CamError
        If the run cannot be read, the case solved, or no check fits a pattern.
    """
    from camwright.pipeline.base.verdict import VERDICTS, exit_word, outcome
    from camwright.pipeline.results.check_records import of_records
    from camwright.pipeline.results.check_report import overview_row, selected
    from camwright.pipeline.results.junit_report import junit_suite

    if not target.exists():
        raise ResultError(f"{target}: no such case file or run folder")
    made = _checked_case(target, remedies, early) if target.is_file() else _checked_run(target)
    document, clock = made
    document["checks"] = list(selected(document["checks"], only))
    decided = outcome(of_records(document["checks"]), fail_on)
    if not only and fail_on != "never":
        decided = max(
            decided, exit_word(document["verdict"], document["screen"]), key=VERDICTS.index
        )
    if baseline is not None:
        from camwright.pipeline.results.baseline_comparison import changes

        document["changes"] = changes(_comparable(baseline, only), document["checks"])
    words = {
        "verdict": document["verdict_line"],
        "exit_code": str(EXIT_CODE[decided]),
        "fail_on": fail_on,
        "depth": document["depth"],
        "input_sha256": document["input_sha256"],
        "scope": document["scope"]["statement"],
    }
    name = suite or document["case"]
    return _Judged(
        document,
        overview_row(str(target), document),
        junit_suite(document["checks"], name, fail_on, decided, words, clock),
        EXIT_CODE[decided],
    )


def _of_several(
    target: Path, only: Sequence[str], fail_on: str, keys: Mapping[str, TrustedKey] | None
) -> _Judged:
    """Checks of one of several runs and cases; an error becomes its row, so that the others are
    still judged.

    Parameters
    ----------
    target : Path     run folder or case file
    only : sequence   patterns of the ids of checks; empty: all
    fail_on : str     checks that decide the exit code, of `FAIL_ON`
    keys : mapping    trusted keys by which signatures are verified; None: not verified
    """
    from camwright.pipeline.results.junit_report import unread_suite

    name = str(target)
    try:
        record = _recorded(target, keys)
        if record.faults:
            message, code, word = "; ".join(record.faults), ALTERED, "ALTERED"
        else:
            judged = _judged(target, only, fail_on, None, name)
            return judged._replace(document={"target": name, **judged.document, **record.entries})
    except CamError as error:
        message, code, word = str(error), ERROR, "ERROR"
        say(message)
    document = {"target": name, "error": message}
    return _Judged(document, (name, "", "", word), unread_suite(name, message), code)


def _comparable(folder: Path, only: Iterable[str]) -> list[CheckRecord]:
    """Checks of the baseline run in a folder whose ids fit a pattern of `only`; AlteredError if the
    run is not as recorded.
    """
    from camwright.pipeline.results.check_report import fits
    from camwright.pipeline.results.run_reader import read_verdict
    from camwright.pipeline.results.signoff import require_recorded

    require_recorded(folder)
    checks: list[CheckRecord] = read_verdict(folder)["checks"]
    return [record for record in checks if fits(record, only)]


class _Record(NamedTuple):
    """Faults of the record of a run, one line each; valid signatures, None: not verified."""

    faults: Sequence[str]
    signatures: Sequence[Signature] | None

    @property
    def entries(self) -> dict[str, Any]:
        """Entries of the JSON document."""
        signed = self.signatures
        return {} if signed is None else {"signatures": [each.as_record() for each in signed]}


def _recorded(target: Path, keys: Mapping[str, TrustedKey] | None) -> _Record:
    """Faults of a run folder by its sign-off record, and valid signatures; each difference is
    printed. Empty for a case file.

    Parameters
    ----------
    target : Path    run folder or case file
    keys : mapping   trusted keys, by which its signatures are verified as well; None: not verified
    """
    if not target.is_dir():
        if keys is not None and target.exists():
            raise InputError("--verify-record", str(target), "stated with run folders")
        return _Record((), None)
    from camwright.pipeline.base.files import unplain
    from camwright.pipeline.results import signoff

    differences = signoff.changes(target)
    lines, signed = [str(each) for each in differences], None
    # A file that was added is in no result; only a signature is on the whole folder.
    faults = [str(each) for each in differences if not each.added]
    if keys is not None and not unplain(target):  # the signatures may be a link themselves
        from camwright.pipeline.results.signatures import verified

        signed, refused = verified(target, keys)
        faults = lines = lines + refused
        if not keys:
            say("no key is trusted: state --trusted FILE")
    for line in lines:
        say(f"{target / line}")
    for one in signed or () if faults else ():
        say(f"{target}: signed: {one.words}")
    return _Record(faults, signed)


def _recomputed(target: Path, angles: int | None, seed: int | None) -> bool:
    """Solve a run anew and compare it with its folder; True where nothing that was compared
    differs beyond round-off.

    At cam angles drawn at random both bodies are also solved in full. Seed, angles, differences and
    what is not compared are printed; a folder that cannot be recomputed is named, and gives False.

    Parameters
    ----------
    target : Path   run folder
    angles : int    number of cam angles to draw; None: that of `recomputation`
    seed : int      of the random numbers; None: a new one

    Raises
    ------
    InputError
        If `target` is no folder.
    """
    import secrets

    from camwright.pipeline.recomputation import ANGLES

    if not target.is_dir():
        raise InputError("--recompute", str(target), "stated with a run folder")
    drawn = secrets.randbelow(2**32) if seed is None else seed
    say(f"recomputation with --seed {drawn}")
    with progress_shown() as progress:
        try:
            made = recomputed(
                target,
                angles=ANGLES if angles is None else angles,
                seed=drawn,
                progress=progress,
            )
        except ResultError as error:
            say(str(error))
            return False
    for angle in made.angles:
        say(f"drawn angle: {angle.words}")
    say(f"recomputed: {made.judged['verdict_line']}")
    for line in made.differences:
        say(f"{target / line}")
    if made.differences and made.versions:
        say(f"the run was solved by {', '.join(made.versions)}")
    if made.unseen:
        say(f"not compared: {', '.join(made.unseen)}")
    return not made.differences


def recomputed(folder: Path, **options: Any) -> Recomputation:
    """Recomputation of a run from its case and lift, compared with its folder; its pages are drawn
    again and compared, too.

    Parameters
    ----------
    folder : Path   of the run
    options         keyword arguments of `recompute`
    """
    from dataclasses import replace
    from tempfile import TemporaryDirectory

    from camwright.pipeline.base import disk_cache
    from camwright.pipeline.recomputation import copy_without, page_differences, recompute
    from camwright.pipeline.results.run_reader import LIVE
    from camwright.reports.page import PAGE
    from camwright.reports.sections import redraw

    made = recompute(folder, **options)
    differences = tuple(made.differences)
    if (folder / LIVE).is_file():
        from camwright.pipeline.screening.live_preview import live_differences

        differences += tuple(f"{LIVE}: {each}" for each in live_differences(folder))
    if not made.pages:
        return replace(made, differences=differences)
    with disk_cache.left_out(), TemporaryDirectory(prefix="camwright-") as home:
        copy = Path(home) / "drawn"
        copy_without(folder, copy, made.pages)
        redraw(copy, made.pages)
        differing = page_differences(folder, copy, made.pages)
        if PAGE in differing:  # it names the pictures that are in the folder when it is drawn
            redraw(copy, (PAGE,))
            del differing[PAGE]
            differing |= page_differences(folder, copy, {PAGE: made.pages[PAGE]})
    words = (f"{name}: {each}" for name, each in differing.items())
    return replace(made, differences=(*differences, *words), pages={})


def _checked_run(folder: Path) -> tuple[dict[str, Any], Clock]:
    """Document with the checks of a run folder, compared with its hashes, and the clock of
    ``run.json``.
    """
    from camwright.pipeline.results.junit_report import Clock
    from camwright.pipeline.results.model_limits import limitations
    from camwright.pipeline.results.run_reader import read_summary, read_verdict, verify_run

    verify_run(folder)
    return read_verdict(folder) | limitations(), Clock.of(read_summary(folder))


def _checked_case(
    path: Path, remedies: bool, early: Callable[[Iterable[str]], None]
) -> tuple[dict[str, Any], Clock]:
    """Document with the checks of the preview of a case, and the clock of the preview; warnings are
    printed.

    Parameters
    ----------
    path : Path        case file
    remedies : bool    whether remedies of failed checks are sought
    early : callable   takes lines on torque and figures before the checks are known
    """
    from camwright.pipeline.base.progress import utc
    from camwright.pipeline.base.source import old_words
    from camwright.pipeline.base.verdict import governing_id
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.case.load_case_torque import (
        engine_torques,
        measurement_record,
        measurement_words,
    )
    from camwright.pipeline.case.plausibility import implausible
    from camwright.pipeline.preview import preview_case
    from camwright.pipeline.results.check_records import judgement, to_be_confirmed
    from camwright.pipeline.results.junit_report import Clock
    from camwright.pipeline.results.run_records import figures
    from camwright.pipeline.results.verdict_summary import figure_lines, torque_lines

    began = time.perf_counter()
    case = read_case(path)
    torques = engine_torques(case)
    early(torque_lines(torques))
    for words in (
        *old_words(case.written.tables),
        *(one.how for one in implausible(case, torques)),
    ):
        say(f"warning: {words}")
    for line in measurement_words(case):
        say(line)
    with progress_shown() as progress:
        progress.stage(f"preview of {case.name}")
        trial = preview_case(
            case,
            kept=True,
            progress=progress,
            torques=torques,
            nominal=lambda first: early(figure_lines(figures(first))),
        )
    made = trial.checks
    if remedies:
        from camwright.pipeline.search.remedies.remedy_search import remedies_of, with_remedies

        texts = {name: remedy.text for name, remedy in remedies_of(trial).items()}
        made = with_remedies(made, texts)
    seconds = time.perf_counter() - began
    checks: list[Any] = [one.as_record() for one in made]
    document = {
        "case": case.name,
        "input_sha256": case.sha256,
        **judgement(checks, trial.depth.word),
        "to_be_confirmed": to_be_confirmed(checks),
        "binding": list(trial.binding),
        "governing": governing_id(made),
        "load_ends": trial.load_ends,
        "figures": figures(trial),
        "scope": case.scope_record,
        "measurement": measurement_record(case),
        "checks": checks,
    }
    return document, Clock(utc(seconds), seconds)
