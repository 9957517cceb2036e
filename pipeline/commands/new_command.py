"""Command `new`: a commented first case that passes."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated

from camwright.geometry.errors import ResultError
from camwright.pipeline.case.template import KINDS, first_case
from camwright.pipeline.commands.arguments import Words
from camwright.pipeline.commands.terminal import PASSED, stdout

TEMPLATE_SUFFIX = ".toml"


def new(
    name: Annotated[str, Words("Name of the case.", "NAME")],
    *,
    kind: Annotated[
        str,
        Words(
            "Source of the cam: an engine as a cylinder model, or measured as torque, cylinder "
            "pressure, tooth times or pick-up voltage; another machine by its torque; a lift; an "
            "eccentric; a lift on an arm, or in a groove.",
            "KIND",
            choices=KINDS,
        ),
    ] = "cylinder",
) -> int:
    """Write NAME.toml, a commented case that passes, and the data file that it reads.

    Every part has its data; replace them by yours, line by line.

    Example: camwright new pump --kind pump
    """
    name = name.removesuffix(TEMPLATE_SUFFIX)
    first = first_case(name, kind)
    texts = {Path(f"{name}{TEMPLATE_SUFFIX}"): first.text}
    if first.data_name:  # written first: a case is never without its data
        texts = {Path(first.data_name): first.data} | texts
    for path in texts:
        if os.path.lexists(path):
            raise ResultError(f"{path}: exists already, not overwritten")
    for path, text in texts.items():
        with path.open("x", encoding="utf-8", newline="") as file:
            file.write(text)
    *_, case = texts
    stdout.print(f"wrote {', '.join(str(path) for path in texts)}", markup=False)
    stdout.print(f"next: camwright run {case} --out runs/{name}", markup=False)
    return PASSED
