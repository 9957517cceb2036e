"""Command line of the validation: ``python -m validation``, in the checkout.

Exit codes: 0 written, 2 error in one line, 130 interrupted.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from camwright.geometry.errors import CamError
from camwright.pipeline.base.printed_text import with_escapes
from camwright.pipeline.base.progress import Lines

# One thread fixes the order of sums. Set before numpy is imported.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

WRITTEN, ERROR, INTERRUPTED = 0, 2, 130


def say(text: str) -> None:
    """Print text on the output stream at once."""
    sys.stdout.write(f"{with_escapes(text)}\n")
    sys.stdout.flush()


def tell(text: str) -> None:
    """Print text on the error stream at once."""
    sys.stderr.write(f"{with_escapes(text)}\n")
    sys.stderr.flush()


def values(arguments: argparse.Namespace) -> None:
    """Write ``values.html`` and ``values.json``; print the counts by basis."""
    from validation import paper_studies
    from validation.pages.values_page import page
    from validation.published_figures import count_lines

    document = paper_studies.values(Lines(tell))
    say(f"{len(document['rows'])} published values by basis:")
    for line in count_lines(document["counts"]):
        say(f"  {line}")
    _write(arguments.out / "values", document, page(document), indent=2)


def figures(arguments: argparse.Namespace) -> None:
    """Write ``figures.html`` and ``figures.json``."""
    from validation import paper_studies
    from validation.pages.figures_page import page

    document = paper_studies.figures(arguments.name, Lines(tell))
    say(f"figures: {', '.join(one['name'] for one in document['figures'])}")
    _write(arguments.out / "figures", document, page(document))


def mechanisms(arguments: argparse.Namespace) -> None:
    """Print the comparison of a case, as JSON or in lines, and write its pictures."""
    from validation.mechanism_comparison import compared, lines
    from validation.pages import mechanism_figures

    document = compared(arguments.case)
    folder = arguments.out or Path(f"{document['case']}_figures")
    drawn = mechanism_figures.draw(document, folder)
    if arguments.json:
        say(json.dumps(document, indent=2))
        return
    for line in lines(document):
        say(line)
    say(f"figures: {', '.join(path.name for path in drawn)} in {folder}")


def gallery(arguments: argparse.Namespace) -> None:
    """Write ``gallery.html`` and ``gallery.json``; print the torque ripple of each machine."""
    from validation.machine_gallery import gallery as shown
    from validation.pages.gallery_page import page

    document = shown(arguments.cases, Lines(tell))
    for one in document["machines"]:
        before, after = (one["values"][f"torque_std_{name}_cam_Nm"] for name in ("without", "with"))
        say(f"{one['name']}: torque ripple {before:.3g} to {after:.3g} N m")
    _write(arguments.out / "gallery", document, page(document))


def _write(path: Path, document: Mapping[str, Any], page: str, indent: int | None = None) -> None:
    """Write a record and its page beside one another, and print the place of the page."""
    from camwright.pipeline.base.files import json_text, write_atomic

    write_atomic(path.with_suffix(".json"), json_text(document, indent) + "\n")
    write_atomic(path.with_suffix(".html"), page)
    say(f"page: {path.with_suffix('.html')}")


def parser() -> argparse.ArgumentParser:
    """The four commands and their options."""
    root = argparse.ArgumentParser(
        prog="python -m validation",
        description="Published values and figures, recomputed; machines and mechanisms compared.",
        allow_abbrev=False,
    )
    commands = root.add_subparsers(required=True, metavar="COMMAND")
    each = commands.add_parser(
        "values", help="recompute the published values of the papers, counted by basis"
    )
    each.set_defaults(run=values)
    _add_out(each)
    each = commands.add_parser(
        "figures", help="draw the figures of the papers beside their published values"
    )
    each.add_argument(
        "name", metavar="NAME", nargs="?", default="",
        help="a paper (C25, C24, P15, E24) or a figure (c25-cam); default: all",
    )  # fmt: skip
    each.set_defaults(run=figures)
    _add_out(each)
    each = commands.add_parser(
        "mechanisms",
        help="compare a slider-crank with eccentric cams: friction, slip, inertia, workspaces",
    )
    each.add_argument(
        "case", metavar="CASE", type=Path, help="such as cases/papers/mechanisms.toml"
    )
    each.add_argument("--json", action="store_true", help="print the results as JSON")
    each.add_argument("--out", metavar="DIR", type=Path, help="folder for the pictures")
    each.set_defaults(run=mechanisms)
    each = commands.add_parser(
        "gallery", help="preview machines on one page: torque with and without the cam, speed"
    )
    each.add_argument(
        "cases", metavar="CASE", type=Path, nargs="+", help="such as cases/machines/*.toml"
    )
    each.set_defaults(run=gallery)
    _add_out(each)
    return root


def _add_out(command: argparse.ArgumentParser) -> None:
    command.add_argument(
        "--out", metavar="DIR", type=Path, default=Path(),
        help="folder for page and record; default: here",
    )  # fmt: skip


def main(words: Sequence[str] | None = None) -> int:
    """Run a command; an error of its input or files becomes one line."""
    arguments = parser().parse_args(words)
    try:
        arguments.run(arguments)
    except CamError as error:
        for line in error.lines:
            tell(f"validation: {' '.join(line.split())}")
        return ERROR
    except OSError as error:
        tell(f"validation: {error.filename or 'output'}: {error.strerror or error}")
        return ERROR
    except KeyboardInterrupt:
        tell("validation: interrupted")
        return INTERRUPTED
    return WRITTEN


if __name__ == "__main__":
    sys.exit(main())
