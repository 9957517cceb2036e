"""Camwright: from the torque of a machine to a balancing cam with a sign-off verdict.

The public names, in the order of the calculation:

| name           | responsibility                                          | result           |
| -------------- | ------------------------------------------------------- | ---------------- |
| `read_case`    | read and check a case file                              | `Case`           |
| `Case`         | a design and its load cases, resolved, SI               |                  |
| `synthesize`   | torque, lift, cam contour                               | case and contour |
| `Tier`         | depth: `SCREENING`, `PREVIEW`, `CYCLE`, `CERTIFIED`      |                  |
| `solve`        | contact, guides, parts and checks of a cam              | `Trial`          |
| `preview_case` | `synthesize` and `solve` by closed forms                | `Trial`          |
| `Trial`        | a cam with its solution, checks and verdict             |                  |
| `Check`        | a demand beside its limit, with status and source       |                  |
| `run_case`     | trials until the checks pass or a limit binds; run folder | `Run`          |
| `read_run`     | read a run folder that is as recorded                   | `Run`            |
| `report`       | page and figures of a run folder                        | files by part    |
| `design_from_torque` | case file with all parts for a torque table        | record           |
| `screen_designs` | closed-form checks of thousands of designs at once    | columns          |
| `size`         | sizes that a case leaves open, and their checks         | `Sizing`         |
| `crown`        | crown in the middle of those within a ratio of pressure | `CrownDesign`    |
| `CamError`     | every error that the user can correct, in one line      |                  |

All values are in SI units: m, N, Pa, rad, s, kg. A name is imported when it is first used.
"""

import sys

if sys.argv[:1] == ["-m"] and not sys.flags.safe_path:
    # Python has put the working folder first on the path, before its own library. It is taken out
    # where Python runs a module of this package, `python -m camwright`, and not one of a user.
    _word = sys.orig_argv[-len(sys.argv)]
    if (_word.partition("m")[2] if _word[0] == "-" else _word).split(".")[0] == __name__:
        del sys.path[0]

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

_HERE = Path(__path__[0]).resolve()
if not (_HERE / "geometry").is_dir():  # in a checkout the packages lie at its top
    __path__.append(str(_HERE.parents[1]))

if TYPE_CHECKING:
    from camwright.geometry.errors import CamError
    from camwright.pipeline.case.case import Case
    from camwright.pipeline.case.case_file import read_case
    from camwright.pipeline.checks.check import Check
    from camwright.pipeline.contact.tiers import Tier
    from camwright.pipeline.iteration import synthesize
    from camwright.pipeline.preview import preview_case
    from camwright.pipeline.results.signoff import read_run
    from camwright.pipeline.results.trial import Trial
    from camwright.pipeline.run import run_case
    from camwright.pipeline.screening.design_screening import screen_designs
    from camwright.pipeline.search.crown.crown_design import crown
    from camwright.pipeline.search.machine.design_study import design_from_torque
    from camwright.pipeline.search.sizes.sizing import size
    from camwright.pipeline.solver import solve
    from camwright.reports.sections import report

_HOMES = {
    "CamError": "geometry.errors",
    "Case": "pipeline.case.case",
    "Check": "pipeline.checks.check",
    "Tier": "pipeline.contact.tiers",
    "Trial": "pipeline.results.trial",
    "crown": "pipeline.search.crown.crown_design",
    "design_from_torque": "pipeline.search.machine.design_study",
    "preview_case": "pipeline.preview",
    "read_case": "pipeline.case.case_file",
    "read_run": "pipeline.results.signoff",
    "report": "reports.sections",
    "run_case": "pipeline.run",
    "screen_designs": "pipeline.screening.design_screening",
    "size": "pipeline.search.sizes.sizing",
    "solve": "pipeline.solver",
    "synthesize": "pipeline.iteration",
}

__all__ = [
    "CamError",
    "Case",
    "Check",
    "Tier",
    "Trial",
    "crown",
    "design_from_torque",
    "preview_case",
    "read_case",
    "read_run",
    "report",
    "run_case",
    "screen_designs",
    "size",
    "solve",
    "synthesize",
]


def __getattr__(name: str) -> object:
    """A public name, imported on first use, so that the package itself imports at once."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value: object = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
