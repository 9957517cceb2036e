"""Gallery of the documentation site: every shipped case with its cam turning and its curves."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np
from site_pictures import TurningCam, chart, over_cam, swinging_cam, turning_cam

from camwright.geometry.arm_path import ArmContour
from camwright.geometry.figures import Figure
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.base.verdict import within_depth
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.trial import Trial

GROUPS = {
    "": (
        "The balancing cam of a Honda GX120",
        "One engine in five designs, the published one first.",
    ),
    "machines": (
        "Other machines",
        "The same design for the torque of a compressor, two pumps, a press, an indexing drive and "
        "a moped.",
    ),
    "motions": (
        "Cams of a given motion",
        "A swing with two dwells on an arm, and strokes in a groove, between two discs, in a yoke "
        "and under a weight, without a torque to balance.",
    ),
    "papers": (
        "Cams of papers",
        "Published cams with the values as they are printed; several fail, as the papers "
        "state or their own numbers show.",
    ),
}
"""Folders below cases/ with title and lead."""
NO_CASE = ("mechanisms",)
"""Files below cases/ that are not case files but those of a comparison."""
_CHART_WIDTH = 4.0
"""Width of a chart in two columns, inches."""
_SHOWN = 10
"""Failed checks of a page."""


@dataclass(frozen=True)
class Shown:
    """A case of the gallery: file, folder below cases/, first sentences of its comment, preview."""

    file: Path
    group: str
    about: str
    trial: Trial

    @property
    def name(self) -> str:
        """Name of the case, of its page, too."""
        return self.file.stem

    @property
    def title(self) -> str:
        """Title as the case has it."""
        return self.trial.case.title or self.trial.case.name


def shown(root: Path, file: Path) -> Shown:
    """A case solved by closed forms, at its nominal sizes."""
    trial = preview_case(read_case(file), corners=False, kept=True)
    return Shown(file, _folder(root, file), about(file.read_text(encoding="utf-8")), trial)


def about(text: str) -> str:
    """First paragraph of the comment at the top of a case."""
    head = re.match(r"(?:#.*\n)+", text)
    lines = [line.removeprefix("#").strip() for line in head[0].splitlines()] if head else []
    first = next((k for k, line in enumerate(lines) if not line or line.startswith("Source")), None)
    return " ".join(lines[:first])


def case_files(root: Path) -> list[Path]:
    """Shipped cases, the published GX120 first."""
    files = [file for file in (root / "cases").rglob("*.toml") if file.stem not in NO_CASE]
    order = [*GROUPS]
    return sorted(
        files, key=lambda file: (order.index(_folder(root, file)), file.stem != "gx120", file.stem)
    )


def _folder(root: Path, file: Path) -> str:
    name = file.parent.relative_to(root / "cases").as_posix()
    return "" if name == "." else name


def index(cases: list[Shown]) -> str:
    """Page of all cases."""
    parts = [
        "# Gallery\n\nEvery case that Camwright ships, each solved when this site was built: "
        "closed forms, nominal sizes, first load case. Choose one for its curves, its checks and "
        "its case file.\n\n"
        "```{toctree}\n:hidden:\n\n" + "\n".join(f"gallery/{one.name}" for one in cases) + "\n```"
    ]
    for group, (title, lead) in GROUPS.items():
        cards = "\n".join(_card(one) for one in cases if one.group == group)
        parts.append(
            f'## {title}\n\n{lead}\n\n```{{raw}} html\n<ul class="cams">\n{cards}\n</ul>\n```'
        )
    return "\n\n".join(parts) + "\n"


def _card(one: Shown) -> str:
    return (
        f'<li><a href="gallery/{one.name}.html">{cam_of(one, f"cam-{one.name}")}'
        f"<strong>{escape(one.title)}</strong></a><span>{escape(_state(one.trial))}</span></li>"
    )


def cam_of(one: Shown, name: str) -> str:
    """The turning cam of a case."""
    bore = one.trial.case.cam.bore_radius or 0.0
    words = f"Turning cam with follower and spring: {one.title}"
    contour, groove = one.trial.contour, one.trial.case.cam.groove
    if isinstance(contour, ArmContour):
        return swinging_cam(contour, bore, name, words)
    cam = TurningCam.of(contour, bore)
    if groove is not None:
        words = f"Turning disc with the follower in its groove: {one.title}"
        cam = cam.in_groove(contour, groove.outer_radius)
    return turning_cam(cam, name, words)


def _state(trial: Trial) -> str:
    failed = sum(each.must_have and each.status == "fail" for each in within_depth(trial.checks))
    if not failed:
        return "no required check fails"
    words = "one required check fails" if failed == 1 else f"{failed} required checks fail"
    case, balanced = trial.case, trial.cycles[0].turn.torque_before is not None
    more = case.solver.max_trials > 1 and case.smoothing.kind != "constrained"
    return f"{words} in the first trial" if balanced and more else words


def page(one: Shown, links: Mapping[str, str]) -> str:
    """Page of a case.

    Parameters
    ----------
    links : mapping    page and anchor of each check, relative to the top of the site
    """
    trial, path = one.trial, one.file.as_posix().rpartition("/cases/")[2]
    command = f"camwright check cases/{path}\ncamwright run cases/{path} --out runs/{one.name}"
    facts = "".join(
        f'<tr><th scope="row">{escape(a)}</th><td>{escape(b)}</td></tr>' for a, b in _facts(trial)
    )
    charts = "".join(f"<figure>{chart(each, _CHART_WIDTH)}</figure>" for each in _charts(trial))
    parts = [
        f"# {one.title}",
        _sentence(one.about),
        '```{raw} html\n<div class="beside">\n'
        f'<figure class="large">{cam_of(one, "cam")}</figure>\n<table>{facts}</table>\n</div>\n```',
        "## Over one turn",
        f"First load case, {trial.cycles[0].load_case}, by closed forms.",
        f'```{{raw}} html\n<div class="charts">{charts}</div>\n```',
        "## Checks",
        _checks(trial, links),
        "## Run it",
        f"```bash\n{command}\n```",
    ]
    if trial.case.notes:
        parts += ["## Notes of the case", trial.case.notes.strip()]
    parts += [
        "## Case file",
        f"`cases/{path}`:",
        f"````toml\n{one.file.read_text(encoding='utf-8').rstrip()}\n````",
    ]
    return "\n\n".join(parts) + "\n"


def _sentence(text: str) -> str:
    return text if text.endswith(".") else f"{text}."


def _checks(trial: Trial, links: Mapping[str, str]) -> str:
    """Failed checks of a trial as a table, the required ones first."""
    failed = [
        each for each in within_depth(trial.checks) if each.status == "fail" and each.must_have
    ]
    lead = f"In the preview at nominal sizes {_state(trial)}."
    if not failed:
        return (
            f"{lead} A run judges each check at its worst tolerance corner, by finite elements "
            "where it needs them."
        )
    rows = [
        f"| [{each.title}](../{links[each.id]}) | {_number(in_unit(each.demand, each.unit))} | "
        f"{_number(in_unit(each.limit, each.unit))} | {each.unit or '-'} |"
        for each in failed[:_SHOWN]
        if each.demand is not None and each.limit is not None
    ]
    more = f"\n\n{len(failed) - _SHOWN} more fail." if len(failed) > _SHOWN else ""
    return (
        f"{lead}\n\n| check | demand | limit | unit |\n| --- | --- | --- | --- |\n"
        + "\n".join(rows)
        + more
    )


def _number(value: float) -> str:
    return f"{value:.4g}"


def _facts(trial: Trial) -> Iterator[tuple[str, str]]:
    """Key figures of the first load case."""
    cycle = trial.cycles[0]
    turn, table = cycle.turn, cycle.table
    yield "Follower", "roller" if trial.contour.rolls else "flat face"
    yield "Load cases", ", ".join(each.load_case for each in trial.cycles)
    yield "Machine speed", f"{in_unit(turn.machine.speed, 'rpm'):.4g} rpm"
    yield "Maximum lift", f"{1e3 * trial.lift.stroke:.4g} mm"
    if trial.contour.rolls:
        yield "Maximum pressure angle", f"{np.abs(table['pressure_angle_deg']).max():.3g}°"
    force = table["normal_force_N"]
    yield "Contact force", f"{np.nanmin(force):.4g} to {np.nanmax(force):.4g} N"
    known = table["p0_hertz_MPa"][np.isfinite(table["p0_hertz_MPa"])]
    yield "Maximum contact pressure", f"{known.max():.4g} MPa" if known.size else "not known"
    if turn.torque_before is not None and turn.torque_after is not None:
        before, after = turn.torque_before.std(), turn.torque_after.std()
        yield "Torque ripple without the cam", f"{before:.3g} N m (standard deviation)"
        yield "Torque ripple with the cam", f"{after:.3g} N m"


def _charts(trial: Trial) -> Iterator[Figure]:
    """Curves of the first load case over a turn of the cam."""
    cycle = trial.cycles[0]
    turn, table = cycle.turn, cycle.table
    if turn.torque_before is not None and turn.torque_after is not None:
        yield over_cam(
            "torque", "Torque", "torque about its mean", "N m",
            [("without the cam", turn.torque_before), ("with the cam", turn.torque_after)],
        )  # fmt: skip
    yield over_cam("lift", "Lift", "lift", "mm", [("", table["lift_mm"])])
    if trial.contour.rolls:
        yield over_cam(
            "angle", "Pressure angle", "pressure angle", "deg", [("", table["pressure_angle_deg"])]
        )
    for name, quantity, column, unit in (
        ("force", "contact force", "normal_force_N", "N"),
        ("pressure", "contact pressure", "p0_hertz_MPa", "MPa"),
    ):
        if np.isfinite(table[column]).all():
            yield over_cam(name, quantity.capitalize(), quantity, unit, [("", table[column])])


def solved(root: Path, say: Callable[[str], None]) -> list[Shown]:
    """The shipped cases with their previews."""
    cases = []
    for file in case_files(root):
        say(f"  {file.relative_to(root).as_posix()}")
        cases.append(shown(root, file))
    return cases


def gallery(cases: list[Shown], links: Mapping[str, str]) -> dict[str, str]:
    """Pages of the gallery by their path in the source of the site; links as of `page`."""
    pages = {f"gallery/{one.name}.md": page(one, links) for one in cases}
    return {"gallery.md": index(cases), **pages}
