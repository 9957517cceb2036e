"""Checks that each part is fully described, or outside the scope of the sign-off."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Literal

from camwright.pipeline.base.quantities import Part
from camwright.pipeline.base.source import Source
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.parts_section import Follower
from camwright.pipeline.case.scope_section import PART_WORDS, PartName
from camwright.pipeline.checks.check import NONE, STATED, Declaration, Demand, Kind, Page, check
from camwright.pipeline.cycle.numbers import Numbers
from camwright.pipeline.cycle.solution import Solution
from camwright.pipeline.follower.spring_kinds import TABLES_OF_PARTS

Tables = Mapping[str, Part | Follower | None]
"""Tables of a case that describe a part, by their keys; None: not in the case."""


def _data(
    name: PartName | Literal["cam", "follower", "roller", "face"],
    tables: Callable[[Case], Tables],
    needs: Kind = "",
    described_by: tuple[str, ...] = (),
    springs: tuple[str, ...] = (),
    *,
    page: Page,
) -> Declaration:
    """Check that the case has all data of a part.

    described_by: tables or keys by which the case describes the part; springs: kinds of
    spring with which a case can have it; (): any.
    """
    words: str = name
    coverable: PartName | None = None
    for part, text in PART_WORDS.items():
        if part == name:
            coverable, words = part, text

    @check(
        id=f"data_{name}",
        title=f"Missing data of the {words}",
        unit="data",
        source=Source("a machine is judged whole, but for what [scope] leaves out", confirmed=True),
        method="keys of the case without value and without default",
        formula=f"n = 0; n: data of the {words} that the case lacks",
        symbols={"n": STATED},
        reason="without them the part is not judged whole",
        moved_by_tolerance=False,
        load_cases=NONE,
        needs=needs,
        page=page,
    )
    def data(solution: Solution) -> Demand | None:
        """Number of data that the case lacks of the part; None where the scope leaves it out."""
        machine = solution.machine
        if springs and (solution.case.spring.kind or "coil") not in springs:
            return None
        if springs and solution.case.spring.absent:
            return None
        if coverable is not None:
            if coverable in machine.absent or not machine.scope.covers(coverable):
                return None
            if not machine.describes(coverable):
                note = f"no {words} is described; describe it or leave it out in [scope]"
                return Demand(None, 0.0, missing=described_by, note=note)
        described = {path: part for path, part in tables(solution.case).items() if part is not None}
        missing = tuple(f"{path}.{key}" for path, part in described.items() for key in part.lacking)
        spared = machine.follower.spared
        missing = tuple(
            key for key in missing if not (machine.scope.leaves_out(key) or key in spared)
        )
        lacking = {"n": float(len(missing))}
        return Demand(None if missing else 0.0, 0.0, missing=missing, stated=lacking)

    return data


def _spring(case: Case) -> Tables:
    return {"spring": case.spring, "spring.design": case.spring.design}


def _shaped_spring(case: Case) -> Tables:
    shape = None if case.spring.shape is None else case.spring.shape.own
    described = {"spring": case.spring, **({} if shape is None else {shape.table: shape})}
    has_body = Numbers({}, case).get("spring.link.body") is not None
    return described | ({} if has_body else {"spring.link": case.spring.link})


def _guides(case: Case) -> Tables:
    pair = case.guides
    return {"guides": pair, "guides.a": pair.a, "guides.b": pair.b}


def _roller_bearing(case: Case) -> Tables:
    described = dict[str, Part | None]()
    for table, bearing in case.bearings.items():
        described |= {table: bearing, f"{table}.ring": bearing.ring}
    return described


def _pivot(case: Case) -> Tables:
    """Tables of the pivot and of its bearings by name; empty without a pivot."""
    pivot = case.follower.pivot
    if pivot is None:
        return {}
    table = pivot.table
    return {
        table: pivot,
        f"{table}.bush": pivot.bush,
        f"{table}.needle_bearing": pivot.needle_bearing,
    }


def _gear(case: Case) -> Tables:
    return {"camshaft.gear": None if case.camshaft is None else case.camshaft.gear}


data_cam = _data("cam", lambda case: {"cam": case.cam}, page="Cam")
data_follower = _data("follower", lambda case: {"follower": case.follower}, page="Follower")
data_roller = _data("roller", lambda case: {"roller": case.roller}, "roller", page="Roller")
data_face = _data(
    "face", lambda case: {"follower.face": case.follower.face}, "face", page="Flat face"
)
data_roller_bearing = _data("roller_bearing", _roller_bearing, "roller", page="Roller")
data_pin = _data(
    "pin",
    lambda case: {"roller.pin": case.roller.pin},
    "roller",
    described_by=("roller.pin",),
    page="Roller",
)
data_fork = _data(
    "fork",
    lambda case: {"roller.fork": case.roller.fork},
    "roller",
    described_by=("roller.fork",),
    page="Roller",
)
data_arm = _data(
    "arm",
    lambda case: {"follower.arm": case.follower.arm},
    "arm",
    described_by=tuple(
        f"follower.arm.{key}" for key in ("width", "depth", "material", "pivot_notch")
    ),
    page="Follower",
)
data_rocker = _data(
    "rocker",
    lambda case: {"rocker": case.rocker},
    "arm",
    described_by=("rocker.width", "rocker.depth", "rocker.notch"),
    page="Follower",
)
data_spring = _data(
    "spring",
    _spring,
    described_by=("spring.design",),
    springs=("coil",),
    page="Spring",
)
data_shaped_springs = tuple(
    _data(
        part,
        _shaped_spring,
        described_by=tables,
        springs=tuple(each.removeprefix("spring.") for each in tables),
        page="Spring",
    )
    for part, tables in TABLES_OF_PARTS.items()
)
"""Of the springs that are not linear, by their kinds."""
data_guides = _data("guides", _guides, page="Guides")
data_pivot = _data(
    "pivot",
    _pivot,
    "arm",
    described_by=("follower.pivot", "follower.pivot.bush"),
    page="Pivot",
)
data_camshaft = _data(
    "camshaft",
    lambda case: {"camshaft": case.camshaft},
    described_by=("camshaft",),
    page="Camshaft",
)
data_camshaft_bearings = _data(
    "camshaft_bearings",
    lambda _: {},
    described_by=("camshaft.bearing_rating", "camshaft.bearing_static_rating"),
    page="Camshaft",
)
data_key = _data(
    "key",
    lambda case: {"cam.keyway": case.cam.keyway},
    described_by=("cam.keyway", "cam.key"),
    page="Camshaft",
)
data_gear = _data("gear", _gear, described_by=("camshaft.gear",), page="Camshaft")
