"""Design from a torque: task, springs, frame and case text."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NoReturn

import numpy as np
import pytest
from record_validation import part_errors
from torque_tables import MACHINES, write_table

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base.progress import SILENT
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.worker_processes import ALONE
from camwright.pipeline.case.cards.catalogue import catalogue_of
from camwright.pipeline.case.cards.shaft_seats import seats
from camwright.pipeline.case.cards.spring_catalogue import SpringDemand
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.cycle.machine_envelope import sizes_of
from camwright.pipeline.records.design_document import DesignOptions
from camwright.pipeline.records.judgement_record import DraftJudgement
from camwright.pipeline.search.change import Change
from camwright.pipeline.search.judge import Judge, judgements
from camwright.pipeline.search.machine import (
    design_study,
    part_exchange,
    synthesised_points,
)
from camwright.pipeline.search.machine.candidate_search import (
    Candidate,
    candidates,
    reference_spring,
)
from camwright.pipeline.search.machine.design_case import Machinery, case_text, oils_of
from camwright.pipeline.search.machine.design_study import _copied, designed
from camwright.pipeline.search.machine.machine_frame import frame_of
from camwright.pipeline.search.machine.relaxation_search import WIDTH, relaxations
from camwright.pipeline.search.machine.synthesised_points import (
    PointStudy,
    Solved,
    draft,
    drafts,
    likeliest,
    passing_draft,
    settled,
    solved_front,
)
from camwright.pipeline.search.machine.torque_task import DesignTask, task_of
from camwright.pipeline.search.machine.wound_springs import wound

RPM = np.pi / 30.0


def table(folder: Path, span: float = 360.0, header: str = "shaft_angle_deg,torque_Nm") -> Path:
    """Torque 10 sin(t) of one cycle: energy swing 20 J at 360 deg."""
    angle = np.arange(0.0, span, 5.0)
    torque = 3.0 + 10.0 * np.sin(2.0 * np.pi * angle / span)
    rows = [f"{a:g},{t:.9g}" for a, t in zip(angle, torque, strict=True)]
    path = folder / "torque.csv"
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path


def task_in(folder: Path) -> DesignTask:
    return task_of(table(folder), speed="300 rpm")


def test_demand_of_a_sine(tmp_path: Path) -> None:
    """Mean 3 N m, ripple 10/sqrt 2, energy swing 2 x 10 J; its sum over 720 angles."""
    demand = task_in(tmp_path).demand
    assert demand.mean == pytest.approx(3.0, abs=1e-6)
    assert demand.ripple == pytest.approx(10.0 / np.sqrt(2.0), rel=1e-4)
    assert demand.energy_swing == pytest.approx(20.0, rel=1e-4)


def test_what_is_not_given_is_assumed(tmp_path: Path) -> None:
    task = task_of(table(tmp_path), speed="300 rpm", life="500 h")
    assert task.overspeed == pytest.approx(1.2 * 300.0 * RPM)
    assert task.ratio == 1.0
    assert "overspeed" in task.assumed
    assert "life" not in task.assumed
    assert str(task.source("life")) == "given"
    assert not task.source("overspeed", "x").confirmed


@pytest.mark.parametrize(("span", "ratio"), [(720.0, 2.0), (360.0, 1.0), (180.0, 1.0)])
def test_a_cam_turn_is_one_cycle_of_one_turn_or_more(
    tmp_path: Path, span: float, ratio: float
) -> None:
    task = task_of(table(tmp_path, span), speed="300 rpm", cycle=f"{span:g} deg")
    assert task.ratio == ratio


def test_speeds_and_shares(tmp_path: Path) -> None:
    task = task_of(table(tmp_path), speed="1500 rpm", speeds="800..3600 rpm", remove="60%")
    assert task.speeds == pytest.approx((800.0 * RPM, 3600.0 * RPM))
    assert task.overspeed == pytest.approx(1.2 * 3600.0 * RPM)
    assert task.remove == pytest.approx(0.6)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"speed": "0 rpm"}, "speed = 0 rpm"),
        ({"speed": "300 mm"}, "speed"),
        ({"speed": "300 rpm", "speeds": "400..500 rpm"}, "speeds"),
        ({"speed": "300 rpm", "speeds": "400 rpm"}, "speeds"),
        ({"speed": "300 rpm", "overspeed": "200 rpm"}, "overspeed = 200 rpm"),
        ({"speed": "300 rpm", "ratio": "3:0"}, "ratio"),
        ({"speed": "300 rpm", "ratio": "1.3"}, "1 or 2"),
        ({"speed": "300 rpm", "remove": "120%"}, "remove = 120%"),
        ({"speed": "300 rpm", "cycle": "500 deg"}, "span"),
    ],
)
def test_an_option_is_refused_in_one_line(
    tmp_path: Path, options: dict[str, str], words: str
) -> None:
    with pytest.raises(InputError) as refused:
        task_of(table(tmp_path), **options)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_table_of_no_whole_turns_names_the_option(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cycle"):
        task_of(table(tmp_path, 500.0), speed="300 rpm")


def test_a_table_of_falling_angles_names_the_line(tmp_path: Path) -> None:
    path = table(tmp_path)
    header, *rows = path.read_text(encoding="utf-8").split()
    path.write_text("\n".join([header, *rows[::-1]]), encoding="utf-8")
    with pytest.raises(InputError, match="line 3, shaft_angle_deg = 350"):
        task_of(path, speed="300 rpm")


def test_a_table_without_units_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="unit"):
        task_of(table(tmp_path, header="shaft_angle_deg,torque"), speed="300 rpm")


def test_wound_springs_meet_their_demand(tmp_path: Path) -> None:
    """Each spring keeps its limits in the usual tolerances, rounded as it is wound."""
    task = task_in(tmp_path)
    wire = reference_spring(task, None)
    travel = np.geomspace(4e-3, 20e-3, 5)
    greatest = 2.0 * 20.0 / travel / 1.3
    points = wound(wire, 0.7 * greatest / travel, 0.3 * greatest, travel, task.cam_speed)
    assert len(points) == travel.size
    for point in points:
        spring = point.spring
        demand = SpringDemand(spring.rate, point.preload, point.travel)
        assert demand.shortfalls(spring) == ()
        assert spring.surge_frequency >= 13.0 * task.cam_speed / (2.0 * np.pi)
        stored = (point.preload + 0.5 * spring.rate * point.travel) * point.travel
        assert stored == pytest.approx(20.0, rel=0.02)  # coils in steps of 0.05


def test_the_seat_grows_with_the_torque() -> None:
    card = catalogue_of(None).rollers["track_roller_47x18"]
    small = frame_of("r", card, 5.0, 1e3, 2.0, seats())
    large = frame_of("r", card, 80.0, 1e3, 2.0, seats())
    assert small is not None
    assert large is not None
    assert small.seat.bore < large.seat.bore
    assert large.teeth == (40, 20)
    assert frame_of("r", card, 1e5, 1e3, 2.0, seats()) is None


def test_the_case_states_given_and_assumed(tmp_path: Path) -> None:
    """The text is a case with all parts; the verdict counts what is assumed."""
    task = replace(task_in(tmp_path), space=0.15)
    card = catalogue_of(None).rollers["track_roller_35x16"]
    frame = frame_of("track_roller_35x16", card, 12.0, 3e3, task.ratio, seats())
    assert frame is not None
    point = wound(
        reference_spring(task, None), np.array([150e3]), np.array([900.0]), np.array([9e-3]), 30.0
    )[0]
    design = Machinery(task, frame, point, 0.046, 9e-3, 0.035, oils=oils_of(None))
    case = parse_case(case_text(design, "sine", "torque.csv"), tmp_path)
    seat = case.spring.seat_thickness
    assert seat == 0.004  # a quarter of 14 mm, rounded up
    # the spring stands on the end of the stem, 3 to 4 mm over guide B
    above = case.follower.stem_length - 9e-3 - seat - case.guides.spacing
    assert 3e-3 <= above - frame.overhang - 0.5 * frame.bush_length + 1e-12 < 4e-3
    box = sizes_of(case, 0.06, 9e-3).envelope
    assert box.along[1] > box.along[0] + 0.06 + case.follower.stem_length
    assert case.period.angle == pytest.approx(2.0 * np.pi)
    assert case.limits.sources["target_life"] == Source("assumed", confirmed=False)
    assert case.limits.sources["overspeed"].text.startswith("assumed")
    assert case.cam.prime_radius == pytest.approx(0.046)
    room = 0.15 - 0.046 - 9e-3 - frame.radius
    assert case.limits.cam_radius == pytest.approx(room, abs=1e-8)


def test_a_relaxed_task_is_that_of_its_command_line(tmp_path: Path) -> None:
    """The command line read again gives the same task; numbers in SI get their units."""
    task = task_of(
        table(tmp_path), speed="300 rpm", speeds=(30.0, 40.0), space=0.15, life="500 h", remove=0.6
    )
    relaxed = task.relaxed({"life": "240 h"})
    assert relaxed.life == pytest.approx(240.0 * 3600.0)
    assert relaxed.space == task.space
    words = shlex.split(relaxed.command(tmp_path / "a case.toml"))
    assert words[:3] == ["camwright", "design", "machine"]
    options = dict(zip(words[4::2], words[5::2], strict=True))
    assert options.pop("--out") == str(tmp_path / "a case.toml")
    again = task_of(words[3], **{name[2:]: value for name, value in options.items()})
    assert (again.life, again.remove, again.assumed) == (240.0 * 3600.0, 0.6, task.assumed)
    assert again.space == pytest.approx(0.15, rel=1e-12)
    assert again.speeds == pytest.approx((30.0, 40.0), rel=1e-12)


@pytest.mark.parametrize("name", MACHINES)
def test_tables_of_machines_are_read_with_their_energy_swing(tmp_path: Path, name: str) -> None:
    machine = MACHINES[name]
    demand = task_of(write_table(tmp_path, name), speed=machine.speed).demand
    assert demand.cycle == pytest.approx(np.radians(machine.cycle))
    assert demand.energy_swing == pytest.approx(machine.swing, rel=2e-3)


def drafted(task: DesignTask, share: float) -> Solved:
    """A design that leaves a share of the ripple allowed."""
    design: Any = SimpleNamespace(task=task)
    left = share * task.ripple_allowed / task.demand.ripple
    return Solved(design, {"ripple_left_share": left})  # type: ignore[typeddict-item]


@dataclass(frozen=True)
class Searched(PointStudy):
    """A study in which a task passes by its values alone; `tasks`: those tried."""

    passes: Callable[[DesignTask], bool]
    tasks: list[DesignTask] = field(default_factory=list)

    @classmethod
    def of(cls, task: DesignTask, passes: Callable[[DesignTask], bool]) -> Searched:
        return cls(task, task.file.parent, task.file.name, "", passes)

    def passing(self, changes: DesignOptions, *_: object) -> Solved | None:
        task = self.task.relaxed(changes)
        self.tasks.append(task)
        return drafted(task, 0.97) if self.passes(task) else None


def up_to(speed: float, life: float, remove: float) -> Callable[[DesignTask], bool]:
    """Whether a task passes: up to a speed, for a life, or for a share removed."""
    return lambda task: (
        task.speed <= speed * RPM or task.life <= life * 3600.0 or task.remove <= remove
    )


def relaxed_by(command: str) -> DesignTask:
    words = shlex.split(command)
    options = {name[2:]: text for name, text in zip(words[4::2], words[5::2], strict=True)}
    return task_of(words[3], **{name: text for name, text in options.items() if name != "out"})


@pytest.mark.parametrize("nearest", [None, 1.02, 1.2, 1.9])  # ripple over that allowed
@pytest.mark.parametrize(
    ("speed", "life", "remove"),
    [
        (290.0, 1000.0, 0.2),
        (130.0, 1990.0, 0.2),
        (200.0, 1000.0, 0.45),
        (245.0, 1600.0, 0.404),  # 20.3, 22.3 and 21.3 % in logarithms
        (130.0, 200.0, 0.2),  # 84, 230 and 92 %
    ],
)
def test_the_first_relaxation_is_the_smallest_of_all_options(
    tmp_path: Path,
    speed: float,
    life: float,
    remove: float,
    nearest: float | None,
) -> None:
    """Least changes stated: the first passes, fails 2 % nearer, and no option has a smaller one."""
    study = Searched.of(task_in(tmp_path), up_to(speed, life, remove))
    near = None if nearest is None else drafted(study.task, nearest)
    first, *others = relaxations(study, near, tmp_path / "c.toml", ALONE, SILENT)
    for each in (first, *others):
        written = json.loads(json.dumps(each))
        assert part_errors("design", "RelaxationRecord", written) == []
        del written["from"]
        assert part_errors("design", "RelaxationRecord", written)
    sizes = {"--speed": np.log(300.0 / speed), "--life": np.log(2000.0 / life),
             "--remove": np.log(0.5 / remove)}  # fmt: skip
    least = min(sizes.values())
    assert sizes[first["option"]] <= least + WIDTH
    task, fails = relaxed_by(first["command"]), {first["option"][2:]: first["fails_at"]}
    assert study.passes(task)
    assert not study.passes(study.task.relaxed(fails))
    stated = {"--speed": 300.0 * RPM, "--life": 2000.0 * 3600.0, "--remove": 0.5}[first["option"]]
    passing = getattr(task, first["option"][2:])
    failing = getattr(study.task.relaxed(fails), first["option"][2:])
    assert np.log(stated / passing) - np.log(stated / failing) <= 1.1 * WIDTH  # of printed digits
    for each in others:
        name = each["option"][2:]
        task = relaxed_by(each["command"])
        fails = study.task.relaxed({name: each["fails_at"]})
        assert study.passes(task) and not study.passes(fails)
        stated, passing, failing = (getattr(one, name) for one in (study.task, task, fails))
        # half of the change fails, as printed, and none is stricter than the task
        assert np.log(stated / passing) <= 2.02 * np.log(stated / failing) + WIDTH
        assert passing < stated
    assert len(study.tasks) <= 36


def test_without_a_relaxation_none_is_listed(tmp_path: Path) -> None:
    study = Searched.of(task_in(tmp_path), up_to(0.0, 0.0, 0.0))
    assert relaxations(study, None, tmp_path / "c.toml", ALONE, SILENT) == []
    loosest = {"remove": 0.125, "speed": 120.0 * RPM, "overspeed": 300.0 * RPM, "life": 3.6e5,
               "ambient": 293.15}  # fmt: skip
    for name, value in loosest.items():
        assert any(getattr(task, name) == pytest.approx(value) for task in study.tasks)
    assert len(study.tasks) == 9  # but for the over-speed a smaller change before


def test_a_slower_cam_is_offered_by_the_next_ratio_alone(tmp_path: Path) -> None:
    task = task_in(tmp_path)
    study = Searched.of(task, lambda each: each.remove <= 0.45 or each.ratio >= 2.0)
    offered = {each["option"]: each for each in relaxations(
        study, None, tmp_path / "c.toml", ALONE, SILENT
    )}  # fmt: skip
    assert set(offered) == {"--remove", "--ratio"}
    assert (offered["--ratio"]["from"], offered["--ratio"]["to"]) == ("1", "2")
    assert relaxed_by(offered["--ratio"]["command"]).ratio == 2.0


def test_the_space_is_that_of_a_design_with_exchanged_parts(tmp_path: Path) -> None:
    """The search finds none in any space; exchanges of parts reach one in 120 mm."""
    task = task_of(table(tmp_path), speed="300 rpm", space=0.1)
    study = Searched.of(task, lambda each: each.remove <= 0.2)
    first, *_ = relaxations(study, None, tmp_path / "c.toml", ALONE, SILENT, room=0.12)
    assert first["option"] == "--space"
    wide, narrow = (task.relaxed({"space": first[key]}).space for key in ("to", "fails_at"))
    assert wide is not None and narrow is not None
    assert 0.1 < narrow < 0.12 <= wide <= np.exp(WIDTH) * narrow * 1.001


def exchange_of(size: float, *failing: str) -> Any:
    """Stand-in for a solved design of a size that fails by some checks."""
    return SimpleNamespace(
        size=size, design=size, has_cam=True, passes=not failing, failing=list(failing),
        record={"open": []},
    )  # fmt: skip


def test_parts_are_exchanged_until_none_passes(monkeypatch: pytest.MonkeyPatch) -> None:
    """A shaft that passes down to 6, a stem that passes once the shaft is the least, no roller."""
    tried: list[Any] = []

    def way(part: str, shelf: dict[Any, Any]) -> Any:
        def smaller(design: Any, _: Any, stride: int) -> Any:
            lesser = shelf.get(design, [])  # by decreasing size
            for each in lesser[: min(stride, len(lesser))][-1:]:
                yield part_exchange.Exchange(part, str(design), str(each), each)

        return smaller

    shafts = [12, 11, 10, 9, 8, 7, 6, 3, 2]
    ways = (
        way("shaft", {each: shafts[k + 1 :] for k, each in enumerate(shafts)}),
        way("roller", {6: [60], 5: [50]}),
        way("stem", {12: [90], 6: [5], 5: [4]}),
    )
    monkeypatch.setattr(part_exchange, "_EXCHANGES", ways)
    monkeypatch.setattr(part_exchange.SortedParts, "of", lambda _: None)

    def solved(design: Any) -> Any:
        tried.append(design)
        return exchange_of(design, *(["Fatigue"] if design in (60, 50, 90, 4, 3, 2) else []))

    study: Any = SimpleNamespace(at_nominal=solved, solved=exchange_of, text=str)
    result = part_exchange.exchanged(study, exchange_of(12), ALONE, SILENT)
    assert result.point.size == 5
    assert [each.becomes for each in result.kept] == ["11", "9", "7", "6", "5"]
    assert tried[:5] == [11, 9, 3, 7, 6]  # strides of 1, 2, 4, 2, 1
    record = result.as_record()
    assert part_errors("design", "ExchangesRecord", record) == []
    assert {each["part"]: each["why"] for each in record["failing"]} == {
        "roller": "Fatigue", "stem": "Fatigue",
    }  # fmt: skip
    assert result.complete and "no part can be exchanged" in record["claim"]
    monkeypatch.setattr(part_exchange, "_EXCHANGES_MAX", 2)
    stopped = part_exchange.exchanged(study, exchange_of(12), ALONE, SILENT)
    assert not stopped.complete and "may pass" in stopped.sentence


def test_exchanges_are_judged_at_the_corners_where_the_last_one_fails_there(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Shafts that pass nominally down to 7, at the tolerance corners down to 9 or to 7."""

    def smaller(design: Any, _: Any, stride: int) -> Any:
        if design - stride >= 5:
            yield part_exchange.Exchange("shaft", str(design), "", design - stride)

    monkeypatch.setattr(part_exchange, "_EXCHANGES", (smaller,))
    monkeypatch.setattr(part_exchange.SortedParts, "of", lambda _: None)
    for least in (9, 7):
        whole: list[Any] = []

        def to(passing: int, design: Any) -> Any:
            return exchange_of(design, *(["Fatigue"] if design < passing else []))

        def at_corners(design: Any, whole: list[Any] = whole, least: int = least) -> Any:
            whole.append(design)
            return to(least, design)

        study: Any = SimpleNamespace(at_nominal=partial(to, 7), solved=at_corners, text=str)
        result = part_exchange.exchanged(study, exchange_of(12), ALONE, SILENT)
        assert result.point.size == least and result.complete
        assert (whole == [7]) == (least == 7)  # the last one alone, where it passes


def test_the_next_smaller_parts_follow_the_catalogues(tmp_path: Path) -> None:
    """The hub takes the base circle with it; a smaller roller keeps it."""
    design = machinery_in(tmp_path)
    task, frame, prime, card = design.task, design.frame, design.prime_radius, design.frame.card
    catalogues = part_exchange.SortedParts.of(PointStudy(task, tmp_path, "torque.csv", ""))
    smaller = [each for way in part_exchange._EXCHANGES for each in way(design, catalogues, 1)]
    by_part: dict[str, list[Any]] = {}
    for each in smaller:
        by_part.setdefault(each.part, []).append(each.design)
    shafts = by_part["shaft with key and bearings"]
    bores = [seat.bore for seat in seats()]
    assert {each.frame.seat.bore for each in shafts} == {bores[bores.index(frame.seat.bore) - 1]}
    hub = frame.least_radius - shafts[0].frame.least_radius
    assert shafts[0].prime_radius == pytest.approx(prime - hub, abs=1e-4)
    assert shafts[1].prime_radius == prime
    (roller,) = by_part["roller"]
    base = roller.prime_radius - roller.frame.radius
    assert base == pytest.approx(prime - frame.radius, abs=1e-3)
    assert roller.frame.card.outer_diameter <= card.outer_diameter
    assert by_part["stem with bushes"][0].frame.stem < frame.stem
    assert "spring" not in by_part  # wound for its forces
    for each in smaller:  # a case of each
        parse_case(case_text(each.design, "sine", "torque.csv"), tmp_path)


def test_the_better_of_two_designs_passes_with_less_ripple_in_the_same_size() -> None:
    design: Any = SimpleNamespace(
        task=SimpleNamespace(ripple_allowed=5.0), frame=SimpleNamespace(radius=0.01)
    )

    def solved(ripple: float, verdict: str = "pass", prime: float = 40.0) -> Solved:
        shortfalls = [] if verdict == "pass" else [{"title": "", "utilisation": ripple / 2.0}]
        record = {"feasible": True, "verdict": verdict, "ripple_left_Nm": ripple,
                  "lift_max_mm": 5.0, "cam_radius_mm": 35.0, "prime_radius_mm": prime,
                  "shortfalls": shortfalls}  # fmt: skip
        return Solved(design, record)

    assert solved(4.0).better_than(solved(4.1))
    assert not solved(4.1).better_than(solved(4.0))
    assert solved(4.8).better_than(solved(4.0, "fail"))
    assert not solved(4.0, "fail").better_than(solved(4.8))
    assert solved(3.0, "fail").better_than(solved(4.0, "fail"))  # beyond its limit by less
    assert not solved(4.0, "fail").better_than(solved(3.0, "fail"))
    assert not solved(3.0, prime=43.0).better_than(solved(4.0))  # 3 % larger
    assert solved(4.8).better_than(Solved(design, {"why": "undercut"}))


def candidate_of(use: float, gain: float = 1.0) -> Any:
    """Stand-in for a screened design: utilisation of its draft, and the gain of an offset."""
    design = SimpleNamespace(task=SimpleNamespace(ripple_allowed=1.0))
    shifted = SimpleNamespace(use=use / gain, offset=True)
    return SimpleNamespace(use=use, offset=False, with_offset=shifted, ripple=use, excess=0.0,
                           size=use, design=design)  # fmt: skip


class Drafted:
    """Stand-in for a draft and its solution in full."""

    has_cam = True

    def __init__(self, candidate: Any) -> None:
        self.use, self.offset = candidate.use, candidate.offset
        self.passes = candidate.use <= 1.0
        self.size = self.ripple = candidate.use

    def better_than(self, other: Drafted) -> bool:
        return self.use < other.use


@pytest.fixture
def chosen(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Candidates that are promising, drafted by `Drafted`; solved in full they are the same."""
    every: list[Any] = []
    monkeypatch.setattr(synthesised_points, "promising", lambda *_: every)
    monkeypatch.setattr(synthesised_points, "draft", lambda _study, each: Drafted(each))
    monkeypatch.setattr(synthesised_points, "synthesised", lambda _study, each: each)
    return every


STUDY: Any = SimpleNamespace(task=None)


def test_an_offset_is_drafted_where_its_gain_may_bring_a_design_within_the_limits(
    chosen: list[Any],
) -> None:
    chosen += [candidate_of(use, 1.1) for use in (0.9, 1.0, 1.11, 1.13, 1.3)]
    points, replaced = drafts(STUDY, [], ALONE)
    assert sorted(each.use for each in replaced) == [0.9, 1.0, 1.11]
    assert sorted(each.use for each in points if not each.offset) == [1.13, 1.3]
    assert len([each for each in points if each.offset]) == 3


def test_a_draft_that_passes_without_an_offset_is_enough(chosen: list[Any]) -> None:
    chosen += [candidate_of(use, 1.1) for use in (1.05, 0.95)]
    first = passing_draft(STUDY, [], ALONE)
    assert first is not None
    assert (first.use, first.offset) == (0.95, False)  # type: ignore[attr-defined]
    chosen[1] = candidate_of(1.06, 1.1)
    first = passing_draft(STUDY, [], ALONE)
    assert first is not None
    assert (first.use, first.offset) == (1.05 / 1.1, True)  # type: ignore[attr-defined]
    chosen[:] = [candidate_of(1.15, 1.1)]
    assert passing_draft(STUDY, [], ALONE) is None


def test_drafts_in_whose_place_an_offset_fails_are_solved_at_last(
    chosen: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """So that `design` passes where the search for relaxations found a draft without an offset."""
    chosen.append(candidate_of(0.95, 1.1))
    failed: Any = SimpleNamespace(has_cam=True, passes=False, use=1.01)
    monkeypatch.setattr(
        synthesised_points, "synthesised", lambda _study, each: failed if each.offset else each
    )
    passing, failing = solved_front(STUDY, drafts(STUDY, [], ALONE), ALONE, SILENT)
    assert [each.use for each in passing] == [0.95]
    assert failing == [failed]


def machinery_in(folder: Path) -> Machinery:
    """A design of the table of a folder, its lift and preload as a drawing states them."""
    task = task_in(folder)
    card = catalogue_of(None).rollers["track_roller_40x16"]
    frame = frame_of("track_roller_40x16", card, 40.0, 3e3, task.ratio, seats())
    assert frame is not None
    spring = wound(
        reference_spring(task, None), np.array([150e3]), np.array([900.0]), np.array([9e-3]), 30.0
    )[0]
    prime = 1e-4 * np.ceil(1e4 * frame.least_radius)
    return Machinery(task, frame, spring, prime, 9e-3, 0.04, oils=oils_of(None))


@pytest.mark.parametrize(("share", "grown"), [(0.998, False), (1.0, True)])
def test_a_drafted_cam_grows_where_its_prime_radius_is_the_greatest(
    tmp_path: Path, share: float, grown: bool
) -> None:
    """By a judge whose store is filled by hand."""
    design = machinery_in(tmp_path)
    study = PointStudy(design.task, tmp_path, "torque.csv", "")
    for growth, used in ((1.0, 1.1), (1.1, 1.05)):
        record: DraftJudgement = {
            "feasible": False, "ripple_left_share": 0.1, "cam_radius_mm": 40.0, "mass_g": 1e3,
            "limit": "pressure_angle", "utilisation": used, "binding": [], "lift_max_mm": 9.0,
            "prime_radius_mm": 1e3 * share * design.prime_radius, "preload_N": 900.0,
        }  # fmt: skip
        drawn = synthesised_points._rounded(design)
        text = study.text(drawn, synthesised_points.freed(drawn, growth))
        case = parse_case(text, tmp_path)
        judge = Judge(case, engine_torques(case), store=judgements(tmp_path))
        assert judge.stored(Change(), "draft", lambda _, each=record: each) == record
    point = draft(study, Candidate(design, 0.1, 0.04, 0.0, "pressure_angle"))
    assert point.use == (1.05 if grown else 1.1)


@pytest.mark.slow
def test_a_pump_is_synthesised_with_free_radius_and_preload(tmp_path: Path) -> None:
    """One roller: free radius and preload leave no more ripple than those of the screening."""
    table_of_pump = write_table(tmp_path, "pump")
    task = task_of(table_of_pump, speed=MACHINES["pump"].speed)
    screened = candidates(task, tmp_path, table_of_pump.name, SILENT, {"track_roller_28x8"})
    candidate = likeliest(screened)
    assert candidate is not None
    # the offset in the middle of the greatest and least slope of the lift, torque over force
    spring, torque = candidate.design.spring, task.demand.torque
    share = min(spring.energy / task.demand.energy_swing, 1.0)
    force = 0.5 * (spring.preload + spring.greatest)
    slopes = share * task.ratio * np.array([torque.min(), torque.max()]) / force
    offset = candidate.with_offset.design.offset
    assert offset == pytest.approx(slopes.mean(), abs=5.1e-5)
    assert 0.0 < offset < 0.2 * candidate.design.prime_radius
    study = PointStudy(task, tmp_path, table_of_pump.name, "")
    point = draft(study, candidate)
    assert point.passes
    assert point.record["prime_radius_mm"] <= 1e3 * 1.1 * point.design.prime_radius * 1.0001
    assert point.record["preload_N"] != pytest.approx(point.design.spring.preload)
    drawn, screened_values = settled(study, point), study.solved(point.design)
    assert drawn.passes
    assert drawn.ripple <= screened_values.ripple * 1.001
    assert drawn.ripple <= point.ripple * 1.001  # few splines leave more


def test_cards_beside_the_case_are_copies_or_refused(tmp_path: Path) -> None:
    """A file of such a name beside the case that is not a copy is kept."""
    source, beside = tmp_path / "source", tmp_path / "case"
    source.mkdir()
    beside.mkdir()
    task = task_in(source)
    (source / "cards.toml").write_text("# mine\n", encoding="utf-8")
    file, copied = _copied(task, beside / "x_design", beside / "x.toml")
    assert (file, copied) == ("torque.csv", ["torque.csv", "cards.toml"])
    assert (beside / "cards.toml").read_text(encoding="utf-8") == "# mine\n"
    (beside / "cards.toml").write_text("# another\n", encoding="utf-8")
    with pytest.raises(ResultError, match=r"cards\.toml: differs"):
        _copied(task, beside / "x_design", beside / "x.toml")
    assert (beside / "cards.toml").read_text(encoding="utf-8") == "# another\n"
    assert _copied(task, source / "x_design", source / "x.toml") == ("torque.csv", [])


def test_a_folder_of_something_else_is_refused(tmp_path: Path) -> None:
    task = task_in(tmp_path)
    with pytest.raises(InputError, match="--out"):
        designed(task, tmp_path / "x.txt")
    (tmp_path / "x_design").mkdir()
    (tmp_path / "x_design" / "letter.txt").write_text("mine", encoding="utf-8")
    with pytest.raises(ResultError, match=r"holds letter\.txt, which is not of a design"):
        designed(task, tmp_path / "x.toml")
    (tmp_path / "x_design" / "letter.txt").unlink()
    (tmp_path / "x_design" / "solved").symlink_to(tmp_path)
    with pytest.raises(ResultError, match="solved: is a link"):
        designed(task, tmp_path / "x.toml")


def test_the_points_of_a_design_are_written_by_one_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    task = task_in(tmp_path)

    def stopped(*_: object) -> NoReturn:
        with pytest.raises(ResultError, match="another design is writing to it"):
            designed(task, tmp_path / "x.toml")
        raise KeyboardInterrupt

    monkeypatch.setattr(design_study, "candidates", stopped)
    (tmp_path / "cards.toml").write_text("", encoding="utf-8")
    (tmp_path / "beside").mkdir()
    (tmp_path / "beside" / "cards.toml").write_text("# another\n", encoding="utf-8")
    with pytest.raises(ResultError, match="differs"):
        designed(task, tmp_path / "beside" / "x.toml")
    assert [each.name for each in (tmp_path / "beside").iterdir()] == ["cards.toml"]
    with pytest.raises(KeyboardInterrupt):
        designed(task, tmp_path / "x.toml")
    points = [each.name for each in (tmp_path / "x_design").iterdir()]
    assert sorted(points) == ["cards.toml", "torque.csv"]
