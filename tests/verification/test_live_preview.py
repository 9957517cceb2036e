"""The live preview of a run against previews of the changed designs, at random settings."""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from copy import deepcopy
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
import live_settings
from record_validation import schema_errors

from camwright.geometry.errors import CamError, ContactError
from camwright.geometry.extrema import sampled_greatest
from camwright.geometry.lift import Lift
from camwright.pipeline.base.units import from_unit, in_unit
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import headline
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.screening import design_lengths, live_preview
from camwright.pipeline.screening.response_surface import Surface, SurfaceFit, settings
from camwright.pipeline.solver import solve

NO_CASE = "papers/mechanisms"
WITHOUT = "papers/petrescu_b3", "papers/petrescu_b4"
"""Cases of which the screening refuses the design itself: its contour bounds no body."""
PULLED = (
    *("motions/feeder-groove", "motions/tucker-groove", "motions/pump-yoke"),
    *("motions/transfer-conjugate", "motions/placer-preloaded"),
)
"""Cases whose cam pulls: their landings are flown design by design."""
FOLLOWED = [
    name
    for file in sorted(live_settings.CASES.rglob("*.toml"))
    if (name := file.relative_to(live_settings.CASES).with_suffix("").as_posix())
    not in (NO_CASE, *WITHOUT, *PULLED)
]
SAMPLE = sorted(np.random.default_rng(1).choice(FOLLOWED, 2, replace=False).tolist())
FEW, SOME, MANY = 5, 12, 200
"""Settings of a case in `make test`; of each case, and of the sample, in `make verify`."""
QUICK = "gx120", "papers/c25_preload"
"""Cases of which other tests of this file fit the surfaces, too."""
HELD = 60
WITHIN, TINY = 0.95, 1e-12
KEY_FIGURES = {
    "torque_ripple": "torque_std_after_Nm", "contact_force": "normal_force_max_N",
    "pressure_angle_max": "pressure_angle_max_deg", "hertz_pressure": "p0_hertz_max_MPa",
    "pitch_curvature": "pitch_radius_of_curvature_min_mm",
}  # fmt: skip


def solved(case: Case, lift: Lift, record: dict[str, Any], multiples: np.ndarray) -> Trial:
    """The design at factors on the values of the run, solved on its own by closed forms."""
    values, stroke = {}, 1.0
    for factor, multiple in zip(record["factors"], multiples, strict=True):
        for key, value in factor["keys"].items():
            if key.startswith("lift."):
                stroke = multiple
            else:
                values[key] = float(from_unit(value * multiple, factor["unit"]))
    own = replaced(case, values)
    contour = own.contour(Lift(lift.theta, stroke * lift.values))
    torques = engine_torques(own) if own.balances else {}
    return solve(own, contour, tier=Tier.PREVIEW, torques=torques, corners=False)


class Shares(NamedTuple):
    """Of every quantity, deviations over stated error at the settings where it holds.

    refused: settings whose design the preview refuses
    """

    of: Mapping[str, Sequence[float]]
    refused: int

    @property
    def within(self) -> float:
        """Least share of settings within the stated error, of the quantities."""
        return min(float(np.mean(np.array(each) <= 1.0)) for each in self.of.values())

    @property
    def words(self) -> str:
        every = np.concatenate([np.array(each) for each in self.of.values()])
        return (
            f"{len(self.of)} quantities, least share within the error {self.within:.3f}, of all "
            f"{np.mean(every <= 1.0):.4f}, greatest deviation {every.max():.2f} of the error, "
            f"{self.refused} settings refused"
        )


def shares(name: str, count: int) -> Shares:
    """Live preview against previews at random settings; a value that is none is infinitely off."""
    case, lift, record = live_settings.fitted(name)
    draw = np.random.default_rng(43)
    low, high = (np.array([f[end] for f in record["factors"]]) for end in ("low", "high"))
    deviations: dict[str, list[float]] = defaultdict(list)
    refused = 0
    for _ in range(count):
        multiples = np.exp(draw.uniform(np.log(low), np.log(high)))
        try:
            trial = solved(case, lift, record, multiples)
        except CamError:
            refused += 1
            continue
        figures, checks = headline(trial.solution), {each.id: each for each in trial.checks}
        for name_of, live in live_settings.values(record, multiples).items():
            if name_of in KEY_FIGURES:
                exact = figures[KEY_FIGURES[name_of]]
            else:
                check = checks.get(name_of)
                demand = None if check is None else check.demand
                exact = None if demand is None else in_unit(demand, check.unit)
            if live.holds:
                away = np.inf if exact is None else abs(live.value - exact)
                deviations[name_of].append(away / max(live.error, TINY))
    assert not refused or record["refused"] > 0  # the page says that the case refuses some
    return Shares(deviations, refused)


def assert_within(made: Shares) -> None:
    """At least 95 % of the settings are within the stated error, of each quantity."""
    outside = {
        name: (float(np.mean(np.array(each) > 1.0)), max(each)) for name, each in made.of.items()
    }
    assert {n: each for n, each in outside.items() if each[0] > 1.0 - WITHIN} == {}
    assert len(made.of) >= 10


def test_the_same_run_has_the_same_surfaces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Fitted again they are the same; a change of a surface, an error or a range is named."""
    case, lift, record = live_settings.fitted("gx120")
    names = [each["id"] for each in record["quantities"] if each["limit"] is not None]
    again = live_preview.live_record(case, lift.values, [*names, *record["left_out"]])
    contour = case.contour(lift)
    monkeypatch.setattr(live_preview, "drawn_cam", lambda _: (case, contour))
    monkeypatch.setattr(live_preview, "live_record", lambda *_: again)
    live_preview.write_live(tmp_path, record)
    assert list(live_preview.live_differences(tmp_path)) == []
    force = next(each for each in record["quantities"] if each["id"] == "contact_force")
    first, third = (record["powers"].index([k, 0, 0, 0, 0]) for k in (1, 3))

    def exchanged(one: dict[str, Any]) -> None:
        """Exchange two terms that are alike at both ends of the range and in the middle."""
        terms = one["parts"][0]["surface"]["coefficients"]
        terms[first], terms[third] = terms[third], terms[first]

    for change, words in (
        (exchanged, "a surface differs"),
        (lambda one: one["parts"][0]["surface"]["coefficients"].__setitem__(0, 1.0), "surface"),
        (lambda one: one["parts"][0]["surface"].update(error=0.0), "error"),
    ):
        forged = deepcopy(record)
        change(forged["quantities"][record["quantities"].index(force)])
        live_preview.write_live(tmp_path, forged)
        assert any(words in each for each in live_preview.live_differences(tmp_path))
    forged["left_out"] = [1]
    live_preview.write_live(tmp_path, forged)
    assert list(live_preview.live_differences(tmp_path)) == ["cannot be read (TypeError)"]
    forged = deepcopy(record)
    forged["factors"][0]["high"] = 9.0
    live_preview.write_live(tmp_path, forged)
    assert any("factors[0].high" in each for each in live_preview.live_differences(tmp_path))


def test_without_surfaces_a_run_has_no_live_preview(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A check that cannot be measured ends no run."""
    case, lift, record = live_settings.fitted("gx120")

    def refused(*_: object) -> None:
        raise ContactError("no equilibrium")

    monkeypatch.setattr(live_preview._Sample, "of", refused)
    made = live_preview.live_record(case, lift.values, list(record["left_out"]))
    assert made is None
    live_preview.write_live(tmp_path, made)
    assert list(tmp_path.iterdir()) == []


def test_a_check_over_several_load_cases_rests_on_each() -> None:
    """It has no value where the follower leaves the cam in one of them."""
    case, _, record = live_settings.fitted("papers/c25_preload")
    by_id = {each["id"]: each for each in record["quantities"]}
    (part,) = by_id["torque_reduction"]["parts"]
    assert (part["state"], part["loads"]) == (-1, list(range(len(case.load_cases))))
    run = [1.0] * len(record["factors"])
    assert live_settings.values(record, run)["torque_reduction"].holds
    lost = deepcopy(record)
    lost["contact"][part["loads"][-1]]["surface"] = {
        "scale": "linear", "coefficients": [-1.0], "error": 0.0, "share": False,
    }  # fmt: skip
    values = live_settings.values(lost, run)
    assert not values["torque_reduction"].holds
    assert values["contact_force"].holds and values["torque_ripple"].holds


def test_designs_that_leave_the_cam_have_no_value_and_no_error() -> None:
    sample = live_preview._Sample(3, {"life": {-1: np.array([1.0, 2.0, np.nan])}})
    sample.lost = {k: np.array([k == 1, False, False]) for k in (0, 1)}
    sample.loads = {"life": {-1: {0, 1}}}
    sample.held = {0: np.ones(3)}
    assert sample.valued("life", -1).tolist() == [False, True, False]
    away = live_preview._Away(1.0, 0.1, np.array([9.0, 2.0, np.nan]))
    surface = Surface("linear", np.array([1.0]), 0.1, share=False)
    valued = sample.valued("life", -1)
    error = away.record(surface, sample.parts["life"][-1], valued)["error"]
    assert error == pytest.approx(0.1 + 0.1 * 2.0)  # the limit of 9 is of a design without a value


def test_a_check_without_a_value_in_a_part_of_the_ranges_is_not_followed() -> None:
    """The size of the counterweight of the hand pump is not stated: near bearing 1 none fits."""
    _, _, record = live_settings.fitted("machines/hand-pump", ("counterweight_gap",))
    assert "part of the ranges" in record["left_out"]["counterweight_gap"]


def test_a_check_whose_limit_bends_too_much_is_not_followed() -> None:
    places = settings(HELD + 200, 1, HELD, 3)
    fit = SurfaceFit(places, HELD)
    demand, kink = 1.0 + 0.1 * places[:, 0], 1.0 + 4.0 * np.abs(places[:, 0] - 0.2)
    sample = live_preview._Sample(len(places), {"edge_pressure": {0: demand}})
    sample.lost = {0: np.zeros(len(places), dtype=bool)}
    sample.loads = {"edge_pressure": {0: {0}}}
    sample.held = {0: np.ones(len(places))}
    sample.limits = {"edge_pressure": np.full(len(places), 2.0)}
    run = live_preview._RunDesign(sample, {"edge_pressure": float(demand[0]) + 0.02})
    followed = live_preview._check("edge_pressure", sample, fit, run)
    (part,) = followed["parts"]
    assert part["loads"] == [0]
    # 0.02 of demands below a limit of 2 is a hundredth of it, twice that away from the run.
    assert part["surface"]["error"] * 1e6 == pytest.approx(2.0 * 0.02, rel=0.05)
    sample.limits = {"edge_pressure": kink}
    unknown = live_preview._RunDesign(sample, {})
    assert "limit bends" in live_preview._check("edge_pressure", sample, fit, unknown)


def test_load_cases_have_the_names_of_the_case() -> None:
    """Standstill and over-speed follow, by the load case whose preload they have."""
    case, _, record = live_settings.fitted("papers/c25_preload")
    stated = [each.name for each in case.load_cases]
    assert record["states"][: len(stated)] == stated
    others = record["states"][len(stated) :]
    assert others[0] == "standstill" and len(set(record["states"])) == len(record["states"])
    assert {each.split(", preload of ")[1] for each in others if "of" in each} <= set(stated)


def test_a_record_has_its_form() -> None:
    _, _, record = live_settings.fitted("gx120")
    assert schema_errors("live", record) == []
    assert not [each["title"] for each in record["quantities"] if "{" in each["title"]]


def test_ranges_end_where_the_case_refuses() -> None:
    """The roller of the GX120 is its bearing: no smaller one, so that the range begins there."""
    _, _, record = live_settings.fitted("gx120")
    roller = next(each for each in record["factors"] if each["name"] == "Roller radius")
    assert (roller["low"], roller["high"]) == (1.0, pytest.approx(1.2))
    assert record["refused"] == 0


def test_the_greatest_edge_pressure_is_that_of_every_angle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Factors along the line are solved near the greatest pressure alone; it is the same."""
    case, lift, record = live_settings.fitted("gx120")
    near = live_preview._in_range(case, lift.values)
    ends = np.array([(each["low"], each["high"]) for each in record["factors"]])
    multiples = np.random.default_rng(4).uniform(ends[:, 0], ends[:, 1], (20, len(ends)))

    def greatest() -> np.ndarray:
        ((rows, designs),) = near.solved(multiples)
        assert len(rows) == len(multiples)
        return np.array([sampled_greatest(cam.p0_signed) for cam in designs.cams])

    chosen = greatest()
    monkeypatch.setattr(design_lengths, "_FIRST_ANGLES", live_preview.POSITIONS)
    assert chosen == pytest.approx(greatest(), rel=1e-12)


@pytest.mark.parametrize("name", QUICK)
def test_a_few_settings_are_within_the_stated_error(
    name: str, measured: Callable[..., None]
) -> None:
    made = shares(name, FEW)
    assert_within(made)
    figure = "least share of settings within the stated error of a live preview"
    measured(figure, made.within, 1.0, rtol=1.0 - WITHIN)


@pytest.mark.slow
@pytest.mark.parametrize("name", [*FOLLOWED, *PULLED])
def test_many_settings_are_within_the_stated_error(name: str) -> None:
    count = MANY if name in SAMPLE else SOME
    made = shares(name, count)
    print(f"{name}: {count} settings, {made.words}")
    assert_within(made)


@pytest.mark.slow
@pytest.mark.parametrize("name", PULLED)
def test_a_follower_that_the_cam_pulls_is_lost_in_no_load_case(name: str) -> None:
    """Its figures hold where its force changes sign; landings are among them but of a preload."""
    case, _, record = live_settings.fitted(name)
    assert schema_errors("live", record) == []
    assert record["contact"] == []
    assert {tuple(part["loads"]) for each in record["quantities"] for part in each["parts"]} == {()}
    followed = {each["id"] for each in record["quantities"]}
    landings = {"landing_speed"} if case.cam.clearance > 0.0 else set()
    assert {"contact_force", "hertz_pressure", "undercut"} | landings <= followed
    run = live_settings.values(record, [1.0] * len(record["factors"]))
    assert all(each.holds for each in run.values())


@pytest.mark.parametrize(
    ("name", "without", "keys"),
    [
        ("motions/lifter-gravity", {"preload", "rate"}, {"cam.prime_radius"}),
        ("motions/feeder-groove", {"preload", "rate"}, {"cam.groove.clearance"}),
        ("motions/transfer-conjugate", {"preload", "rate"},
         {"roller.radius", "cam.conjugate.roller_radius", "cam.conjugate.clearance"}),
        ("motions/pump-yoke", {"preload", "rate", "roller"}, {"cam.yoke.clearance"}),
    ],
)  # fmt: skip
def test_the_numbers_of_a_cam_without_spring(name: str, without: set[str], keys: set[str]) -> None:
    """Neither those of the spring that stands for none, but those of both tracks."""
    case = read_case(live_settings.CASES / f"{name}.toml")
    factors = {each.kind: each.values for each in live_preview._factors(case)}
    assert not without & set(factors)
    assert keys <= {key for values in factors.values() for key in values}


@pytest.mark.parametrize("name", WITHOUT)
def test_a_case_whose_neighbours_are_refused_has_no_live_preview(name: str) -> None:
    trial = preview_case(read_case(live_settings.CASES / f"{name}.toml"), corners=False)
    assert live_preview.live_record(trial.case, trial.contour.pitch.lift.values, []) is None
