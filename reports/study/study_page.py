"""HTML page of a study, with a selection of designs shared by all views."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from markupsafe import Markup
from numpy.typing import ArrayLike, NDArray

from camwright.pipeline.base.files import Json, write_atomic
from camwright.reports import page
from camwright.reports.interactive import script_safe_json, scripts
from camwright.reports.report_tables import DASH, Record, shortened, words
from camwright.reports.study.study_contents import (
    FACTOR,
    PASS,
    STATES,
    UTILISATION,
    page_of,
    titled,
)

MOST_ROWS = 20_000
"""Maximum number of designs in the page; more are thinned evenly."""
_SCRIPTS = (Path(page.__file__).parent / "templates" / "answers.js",)
_AXES, _MATRIX, _LABEL = 9, 5, 60


@dataclass(frozen=True, eq=False)
class DesignRows:
    """Designs of a study for its page, one row each.

    design (n,) numbers; state (n,) 0 to 2: passes, fails, no result; columns by name of the
    dataset, numbers or text (n,), with the unit of each; governing (n,) ids; links: page of a kept
    run by design, relative to the study folder.
    """

    design: NDArray[np.int64]
    state: NDArray[np.uint8]
    governing: NDArray[Any]
    columns: Mapping[str, NDArray[Any]]
    units: Mapping[str, str]
    links: Mapping[int, str]

    def thinned(self, needed: Sequence[int], most: int = MOST_ROWS) -> DesignRows:
        """These designs, or, if there are more than `most`, `most` of them evenly spaced together
        with those in `needed` and those with a page of their run.

        Parameters
        ----------
        needed : sequence   numbers of designs
        """
        count = self.design.size
        if count <= most:
            return self
        rows = np.unique(np.linspace(0, count - 1, most).astype(np.int64))
        also = np.flatnonzero(np.isin(self.design, [*needed, *self.links]))
        rows = np.union1d(rows, also)
        return DesignRows(
            self.design[rows], self.state[rows], self.governing[rows],
            {name: values[rows] for name, values in self.columns.items()}, self.units, self.links,
        )  # fmt: skip


def write(
    path: Path, title: str, facts: Sequence[tuple[str, str]], answers: Record, designs: DesignRows
) -> Path:
    """Write the HTML page of a study.

    Parameters
    ----------
    facts : sequence of (str, str)   name and value below the title
    answers : mapping                contents of ``answers.json``
    """
    return write_atomic(path, text(title, facts, answers, designs))


def text(
    title: str, facts: Sequence[tuple[str, str]], answers: Record, designs: DesignRows
) -> bytes:
    """HTML of a study's page, UTF-8.

    Parameters
    ----------
    facts : sequence       pairs (name, text) that identify the study
    answers : mapping      ``answers.json`` of the study
    designs : DesignRows   all designs of the study
    """
    front = [row["design"] for row in (answers["front"] or {"designs": ()})["designs"]]
    worst = [answers["worst"]["design"]] if answers["worst"] else []
    drawn = designs.thinned([*front, *worst])
    safe, hashes = scripts(_SCRIPTS)
    text_of: str = page.environment().get_template("answers.html").render(
        page=page_of(title, facts, answers, designs.links, drawn.design.size),
        hashes=hashes, scripts=safe,
        data=Markup(script_safe_json(_data(answers, drawn))),  # noqa: S704 - no "<" is left in it
    )  # fmt: skip
    return text_of.encode("utf-8", "replace")


def _data(answers: Record, designs: DesignRows) -> Record:
    """Data of the drawings: columns as base64 of little-endian numbers, with labels and units."""
    names = _drawn(answers, designs)
    axes, matrix = _first_choice(answers, names)
    columns = []
    for name in names:
        label, unit = titled(name, designs.units.get(name, ""))
        values = designs.columns[name]
        labels: list[str] | None = None
        if not np.issubdtype(values.dtype, np.number):
            names_of, values = np.unique(values, return_inverse=True)
            labels = [shortened(str(each), 24) or DASH for each in names_of]
        columns.append({
            "name": name, "label": shortened(label, _LABEL), "unit": unit, "labels": labels,
            "limit": 1.0 if name == UTILISATION else None, "axes": name in axes,
            "matrix": name in matrix, "values": _packed(values, "<f4"),
        })  # fmt: skip
    checks, governing = np.unique(designs.governing, return_inverse=True)
    front = answers["front"]
    return {
        "columns": columns, "state": _packed(designs.state, "u1"),
        "design": _packed(designs.design, "<u4"), "governing": _packed(governing, "<u2"),
        "checks": [words(str(check)) for check in checks],
        "states": list(STATES[answers["designs"]["by"]]),
        "links": {str(k): link for k, link in designs.links.items()},
        "sort": names.index(UTILISATION) if UTILISATION in names else 0,
        "front": _front_data(front, names, designs.design),
    }  # fmt: skip


def _drawn(answers: Record, designs: DesignRows) -> list[str]:
    """Columns of the drawings: factors, outputs with values and objectives, as far as the designs
    have them.
    """
    objectives = [o["column"] for o in (answers["front"] or {"objectives": ()})["objectives"]]
    outputs = [o["name"] for o in answers["outputs"] if o["name"] != PASS and o["count"]]
    names = [*(FACTOR + f["key"] for f in answers["factors"]), *outputs, *objectives]
    return [name for name in dict.fromkeys(names) if name in designs.columns]


def _first_choice(answers: Record, names: Sequence[str]) -> tuple[list[str], list[str]]:
    """Columns shown at first: those of the parallel axes, and those of the matrix of scatter plots.

    Factors come first, by their effect on the pass rate, else on the utilisation; then the
    objectives, the utilisation and the outputs that vary.

    Parameters
    ----------
    names : sequence   columns of the drawings, see `_drawn`
    """
    by_name = {output["name"]: output for output in answers["outputs"]}
    judged = by_name.get(PASS, {"effects": ()})["effects"] or \
        by_name.get(UTILISATION, {"effects": ()})["effects"]  # fmt: skip
    rank = {row["factor"]: row["share"] for row in judged}
    factors = [name for name in names if name.startswith(FACTOR)]
    ranked = sorted(factors, key=lambda name: -rank.get(name.removeprefix(FACTOR), 0.0))
    objectives = [o["column"] for o in (answers["front"] or {"objectives": ()})["objectives"]]
    varying = [
        name for name in names
        if name in by_name and by_name[name]["least"]["value"] < by_name[name]["greatest"]["value"]
    ]  # fmt: skip
    outputs = list(dict.fromkeys([*objectives, UTILISATION, *varying]))
    outputs = [name for name in outputs if name in names]
    axes = [*ranked[: _AXES - 3], *outputs]
    return axes[:_AXES], [*ranked[: _MATRIX - 2], *outputs][:_MATRIX]


def _front_data(
    front: Record | None, names: Sequence[str], design: NDArray[np.int64]
) -> Record | None:
    """Pareto front for the drawings: columns of both objectives as indices of `names`, and rows of
    its designs in `design`; None without one.
    """
    if front is None or not front["designs"]:
        return None
    x, y = (names.index(o["column"]) for o in front["objectives"])
    place = {int(number_): row for row, number_ in enumerate(design)}
    return {"x": x, "y": y, "rows": [place[point["design"]] for point in front["designs"]]}


def _packed(values: ArrayLike, kind: str) -> Json:
    return base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode()
