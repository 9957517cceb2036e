"""Checks that each part is described whole, or left out of the scope of the sign-off."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Literal

from camwright.pipeline.base.quantities import Part
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.parts_section import Follower
from camwright.pipeline.case.scope_section import PartName
from camwright.pipeline.checks.check import Declaration, Demand, check
from camwright.pipeline.cycle.solution import Solution


def _data(
    name: str,
    words: str,
    parts: Callable[[Case], Iterator[tuple[str, Part | Follower | None]]],
    *,
    part: PartName | Literal[""] = "",
    needs: Literal["", "roller", "face"] = "",
) -> Declaration:
    """Check that a part is described and lacks no datum; None if the scope leaves it out."""

    @check(
        id=f"data_{name}",
        title=f"Missing data of the {words}",
        unit="data",
        source="a machine is judged whole, but for what [scope] leaves out",
        method="keys of the case without value and without default",
        formula=f"n = 0; n: data of the {words} that the case lacks",
        reason="without them the part is not judged whole",
        moved_by_tolerance=False,
        needs=needs,
    )
    def data(solution: Solution) -> Demand | None:
        machine = solution.machine
        if part and not machine.scope.covers(part):
            return None
        if part and not machine.describes(part):
            note = f"no {words} is described; describe it or leave it out in [scope]"
            return Demand(None, 0.0, note=note)
        missing = [
            f"{path}.{key}"
            for path, each in parts(solution.case)
            if each is not None
            for key in each.lacking
        ]
        if missing:
            return Demand(None, 0.0, note=f"missing: {', '.join(missing)}")
        return Demand(0.0, 0.0)

    return data


def _roller_bearing(case: Case) -> Iterator[tuple[str, Part | None]]:
    yield "roller.bearing", case.roller.bearing
    yield "roller.bearing.ring", case.roller.bearing.ring


def _spring(case: Case) -> Iterator[tuple[str, Part | None]]:
    yield "spring", case.spring
    yield "spring.design", case.spring.design


def _guides(case: Case) -> Iterator[tuple[str, Part | None]]:
    yield "guides", case.guides
    yield "guides.a", case.guides.a
    yield "guides.b", case.guides.b


def _alone(
    path: str, part: Callable[[Case], Part | Follower | None]
) -> Callable[[Case], Iterator[tuple[str, Part | Follower | None]]]:
    def parts(case: Case) -> Iterator[tuple[str, Part | Follower | None]]:
        yield path, part(case)

    return parts


data_cam = _data("cam", "cam", _alone("cam", lambda case: case.cam))
data_follower = _data("follower", "follower", _alone("follower", lambda case: case.follower))
data_roller = _data("roller", "roller", _alone("roller", lambda case: case.roller), needs="roller")
data_face = _data(
    "face", "flat face", _alone("follower.face", lambda case: case.follower.face), needs="face"
)
data_roller_bearing = _data(
    "roller_bearing", "bearing of the roller", _roller_bearing, part="roller_bearing",
    needs="roller",
)  # fmt: skip
data_pin = _data(
    "pin", "pin of the roller", _alone("roller.pin", lambda case: case.roller.pin), part="pin",
    needs="roller",
)  # fmt: skip
data_spring = _data("spring", "spring", _spring, part="spring")
data_guides = _data("guides", "guides", _guides, part="guides")
data_camshaft = _data(
    "camshaft", "camshaft", _alone("camshaft", lambda case: case.camshaft), part="camshaft"
)
data_key = _data("key", "key", _alone("cam.keyway", lambda case: case.cam.keyway), part="key")
data_gear = _data(
    "gear", "driving gear",
    _alone("camshaft.gear", lambda case: None if case.camshaft is None else case.camshaft.gear),
    part="gear",
)  # fmt: skip
