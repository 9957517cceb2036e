"""Tolerance corners: what is tried, which way each moves the demands, which one governs."""

from pathlib import Path

import numpy as np
import pytest
from made_check import made_check
from record_validation import schema_errors
from small_machine import small_machine

from camwright.geometry.errors import ContactError, InputError
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.machine import Corner, machines
from camwright.pipeline.checks import tolerance_corners
from camwright.pipeline.checks.tolerance_corners import (
    Outcome,
    corners_of,
    corners_record,
    governed,
    outcomes,
    unsolved,
)
from camwright.pipeline.cycle.turn import turns
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.torque.torque import Torque, uniform_cycle

CASES = Path(__file__).parents[2] / "cases"
TOLERANCES = """
[crankshaft]
inertia = "0.0139 kg m^2"

[tolerances]
friction = 0.5
mass = 0.1
inertia = 0.2
phase = "2 deg"
samples = 3
seed = 7
"""


# fast enough that inertia and the elastic stem unload the contact
OVERSPEED = '[limits]\noverspeed = "12000 rpm"'


def case():
    """The template's machine with a smaller cam and roller."""
    text = small_machine("corners")
    for wide, narrow in (
        ('prime_radius = "60 mm"', 'prime_radius = "50 mm"'),
        ('radius = "16 mm"', 'radius = "8 mm"'),
        ('hub_radius = "8 mm"', 'hub_radius = "4 mm"'),
    ):
        assert text.count(wide) == 1
        text = text.replace(wide, narrow)
    return parse_case(text.replace("[limits]", OVERSPEED, 1) + TOLERANCES)


def cam():
    theta = np.linspace(0.0, 2.0 * np.pi, 72, endpoint=False)
    return case().contour(Lift(theta, 0.005 * (1.0 - np.cos(theta))))


@pytest.fixture(scope="module")
def torque():
    """One wave a cycle, not in step with the one of the cam."""
    at = uniform_cycle(720)
    return {"idle": Torque(at, {"gas": 10.0 * np.sin(0.5 * at + 0.6)})}


@pytest.fixture(scope="module")
def tried():
    return outcomes(case(), machines(case()), cam())


@pytest.fixture(scope="module")
def demands(tried):
    return {one.corner.name: one.demands for one in tried}


def test_one_at_a_time_then_a_seeded_sample():
    names = [corner.name for corner in corners_of(case())]
    assert names[:2] == ["friction low", "friction high"]
    assert names[-3:] == ["sample 1", "sample 2", "sample 3"]
    assert corners_of(case()) == corners_of(case())
    other = case().model_copy(
        update={"tolerances": case().tolerances.model_copy(update={"seed": 8})}
    )
    assert corners_of(other)[-1] != corners_of(case())[-1]


@pytest.mark.parametrize(
    ("table", "line"),
    [("tolerances", "mass = 0.0"), ("tolerances", "mass = 0.02"),
     ("spring", "rate_tolerance = 0.01"), ("tolerances", 'phase = "0 deg"'),
     ("cam", 'profile_tolerance = "16 um"')],
)  # fmt: skip
def test_a_tolerance_is_tightened_with_a_source_and_never_dropped(table, line):
    text = small_machine("corners")
    header = f"[{table}]\n"
    text = text.replace(header, header + line + "\n") if header in text else text + header + line
    with pytest.raises(InputError, match=line.split(" = ")[0]):
        parse_case(text)
    zero = line.endswith(("= 0.0", '"0 deg"'))
    source = '\nsource = "measured on ten parts"\n'
    text = text + f"[tolerances]{source}" if table != "tolerances" else text + source
    if zero:
        with pytest.raises(InputError, match="> 0"):
            parse_case(text)
    else:
        assert parse_case(text).tolerances.source.text == "measured on ten parts"


def test_every_case_has_corners():
    """Spring, mass, friction, phase and profile have default tolerances."""
    names = {corner.name for corner in corners_of(parse_case(small_machine("corners")))}
    assert {
        f"{each} {end}"
        for each in ("friction", "spring rate", "preload", "mass", "phase", "line profile")
        for end in ("low", "high")
    } <= names


@pytest.mark.parametrize("own", [None, 350.0])
def test_a_proud_contour_presses_the_spring(own):
    """From the preload of the spring, or from that of the load case."""
    state = case().load_cases[0].model_copy(update={"preload": own})
    machine = machines(case().model_copy(update={"load_cases": (state,)}))[0]
    at, spring = machine.at_corner(Corner("x", profile=1e-4, rate=1.1)), case().spring
    preload = spring.preload if own is None else own
    assert at.spring.preload == pytest.approx(preload + 1.1 * spring.rate * 1e-4)


def test_tendencies_at_a_fixed_lift(demands):
    """Worse friction and a heavier follower: nearer to jamming, to more pressure, to the jump."""
    assert demands["friction high"]["jam_index"] > demands["nominal"]["jam_index"]
    assert demands["friction high"]["guide_pv_A"] > demands["nominal"]["guide_pv_A"]
    assert demands["mass high"]["jump_speed"] < demands["nominal"]["jump_speed"]
    # w_jump goes with one over the root of the mass
    ratio = demands["mass high"]["jump_speed"] / demands["nominal"]["jump_speed"]
    assert ratio == pytest.approx(1.1**-0.5, rel=1e-9)


@pytest.mark.parametrize("line", ["inertia = 1.0", 'inertia = "10 %"', "inertia = -0.1"])
def test_a_tolerance_of_inertia_that_is_none_is_refused(line):
    with pytest.raises(InputError, match=r"tolerances\.inertia"):
        parse_case(small_machine("corners") + TOLERANCES.replace("inertia = 0.2", line))


def test_phase_and_inertia_move_the_speed_ripple_alone(torque):
    """Of the ripple's share little; of no other demand anything, as far as the crank goes."""
    tried = outcomes(case(), machines(case(), torque), cam())
    seen = {one.corner.name: one.demands for one in tried}
    name = "speed_reduction"
    assert seen["crank inertia high"][name] != pytest.approx(seen["nominal"][name], abs=1e-5)
    assert seen["phase low"][name] != pytest.approx(seen["phase high"][name], abs=1e-4)
    still = set(seen["nominal"]) - {name}
    for other in still:
        assert seen["crank inertia high"][other] == pytest.approx(seen["nominal"][other])


@pytest.mark.parametrize("name", ["gx120", "gx120-loads"])
def test_corners_of_the_same_loads_are_those_solved_alone(name):
    """Corners of inertia and phase take over what another one has computed of the loads."""
    shipped = read_case(CASES / f"{name}.toml")
    known = engine_torques(shipped)
    contour = shipped.contour(cam_lift(shipped, known))
    tried = [
        Corner("nominal"),
        Corner("crank inertia low", inertia=0.8),
        Corner("phase high", phase=0.03),
        Corner("mass", mass=1.1),
        Corner("mass and inertia", mass=1.1, inertia=1.2, phase=-0.02),
    ]
    states = machines(shipped, known)
    together = outcomes(shipped, states, contour, tried)
    for corner, outcome in zip(tried, together, strict=True):
        (alone,) = outcomes(shipped, states, contour, [corner])
        assert len(alone.demands) > 20
        assert outcome.demands == pytest.approx(alone.demands, rel=1e-14)  # order of a sum
        assert (outcome.bounds, outcome.lost) == (alone.bounds, alone.lost)


def test_every_demand_that_a_tolerance_moves_has_a_corner(demands):
    """Of parts, springs and films too: nothing that moves is left out, nothing stands still."""
    moved = {
        name
        for name, here in demands["nominal"].items()
        if any(
            one.get(name, here) != pytest.approx(here, rel=1e-12, abs=0.0)
            for one in demands.values()
        )
    }
    assert {
        *("guide_edge_pressure_A", "guide_pressure_B", "guide_pv_A", "contact_at_overspeed"),
        *("shakedown", "contact_force_margin", "edge_pressure", "elastic_contact", "jam_index"),
        *("jump", "jump_speed", "traction_demand", "roller_life", "roller_radial", "roller_static"),
    } <= moved
    # The shape of the cam moves only with the line profile.
    shape = {"pressure_angle", "curvature_ratio", "undercut"}
    for name, values in demands.items():
        same = {each for each in shape if values[each] == demands["nominal"][each]}
        assert same == (set() if "profile" in name or "sample" in name else shape)


def test_a_check_without_a_solution_at_a_corner_is_lost():
    check = made_check("jump", 0.1, 0.2)
    seen = (
        Outcome(Corner("nominal"), {"jump": 0.1}),
        Outcome(Corner("apart"), {"jump": np.inf}),
        Outcome(Corner("jammed"), {}, "follower.friction = 9, must be less"),
    )
    (named,) = governed([check], seen)
    assert (named.corner, named.corner_demand, named.status) == ("apart", np.inf, "fail")
    lost = unsolved(machines(case())[0], seen)
    assert (lost.demand, lost.status) == (1.0, "fail")
    assert "jammed: follower.friction" in lost.note
    record = corners_record(case(), seen)
    assert schema_errors("corners", record) == []
    written = record["corners"]
    assert [corner["demands"].get("jump") for corner in written] == [0.1, None, None]


def test_the_governing_corner_is_named_scales_the_nominal_demand_and_is_judged():
    check = made_check("p", 100.0, 105.0)
    seen = (
        Outcome(Corner("nominal"), {"p": 50.0}),
        Outcome(Corner("a"), {"p": 55.0}),
        Outcome(Corner("b"), {"p": 45.0}),
    )
    (named,) = governed([check], seen)
    assert (named.corner, named.corner_demand) == ("a", pytest.approx(110.0))
    assert (check.status, named.status) == ("pass", "fail")
    check = made_check("p", 100.0, 80.0, sense="at_least")
    (lower,) = governed([check], seen)
    assert (lower.corner, lower.corner_demand) == ("b", pytest.approx(90.0))
    assert lower.status == "pass"
    assert unsolved(machines(case())[0], seen).status == "pass"


def test_a_corner_without_a_solution_is_refused_alone(monkeypatch, demands):
    """The others have the demands that they have where every corner is solved."""
    heaviest = 1.05 * machines(case())[0].mass

    def refusing(inputs, positions, *, coarse, bounds):
        if any(each.machine.mass > heaviest for each in inputs):
            raise ContactError("guides: too heavy")
        return turns(inputs, positions, coarse=coarse, bounds=bounds)

    monkeypatch.setattr(tolerance_corners, "turns", refusing)
    seen = {one.corner.name: one for one in outcomes(case(), machines(case()), cam())}
    assert seen["mass high"].refused == "guides: too heavy"
    assert seen["mass high"].demands == {}
    for name in ("nominal", "mass low", "friction high"):
        assert not seen[name].refused
        assert seen[name].demands == pytest.approx(demands[name], rel=1e-9)


def test_a_demand_unknown_at_a_corner_is_missing():
    seen = (Outcome(Corner("nominal"), {"p": 50.0}), Outcome(Corner("c"), {}))
    (named,) = governed([made_check("p", 100.0, 105.0)], seen)
    assert (named.corner, named.status) == ("c", "not_evaluated")


def test_record_holds_every_corner(tried):
    written = corners_record(case(), tried)
    assert schema_errors("corners", written) == []
    assert written["tried"] == len(tried) - 1 == len(corners_of(case()))
    nominal = written["corners"][0]
    assert nominal["name"] == "nominal"
    # In the units of the checks: MPa and rpm.
    demands, record = tried[0].demands, nominal["demands"]
    assert record["contact_pressure"] == pytest.approx(1e-6 * demands["contact_pressure"])
    assert record["jump_speed"] == pytest.approx(30.0 / np.pi * demands["jump_speed"])


def test_a_corner_without_a_load_case_is_no_milder_than_the_run():
    """The demand of the run has a load case that the closed forms without error bars lost."""
    lost = {"bounds": frozenset({"p"}), "lost": "the cam"}
    check = made_check("p", 100.0, 105.0)
    for there, corner, demand in ((55.0, "nominal", 100.0), (120.0, "a", 120.0)):
        seen = (
            Outcome(Corner("nominal"), {"p": 50.0}, **lost),
            Outcome(Corner("a"), {"p": there}, **lost),
        )
        (named,) = governed([check], seen)
        assert (named.corner, named.corner_demand) == (corner, demand)
