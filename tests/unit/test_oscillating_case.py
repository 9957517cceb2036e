"""Cases with an oscillating follower: their keys, what they refuse, and their preview."""

import re
import tomllib
from functools import cache

import numpy as np
import pytest
from swung_face import face_text

from camwright.geometry.arm_path import ArmPath
from camwright.geometry.arrays import rotation
from camwright.geometry.errors import InputError
from camwright.pipeline.base.envelope import MechanismSizes
from camwright.pipeline.base.units import in_unit
from camwright.pipeline.case.added_tables import NOTHING, added_text
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.case_values import replaced
from camwright.pipeline.case.load_case_torque import engine_torques
from camwright.pipeline.case.template import first_case
from camwright.pipeline.case.value_sources import values_in
from camwright.pipeline.checks.check import FACTOR_MAX
from camwright.pipeline.preview import preview_case
from camwright.pipeline.results.run_records import drawn_angles, lift_columns
from camwright.pipeline.results.verdict_summary import missing_keys
from camwright.pipeline.results.workshop_files import dimensions_record, notes_of
from camwright.pipeline.screening.design_factors import groups
from camwright.pipeline.screening.design_screening import screen_designs
from camwright.pipeline.screening.screened_checks import SCREENED
from camwright.pipeline.smoothing.infeasibility import _candidates
from camwright.pipeline.smoothing.problem_setup import problem_of
from camwright.pipeline.studies.batch.factor_axes import axis_of
from camwright.pipeline.studies.batch.study_file import Factor
from camwright.reports.drawing.arrangement import (
    DrawnArm,
    DrawnMechanism,
    DrawnMotion,
    arrows,
    cam_turn,
    contact_point,
    drawing,
)

ARM = """\
[follower]
kind = "oscillating"
mass = "1.1 kg"

[follower.arm]
centre_distance = "110 mm"
length = "100 mm"
swing = "with"

[scope]
not_covered = ["arm"]
reason = "its pivot is judged by its maker"

"""
STEM = """\
[follower]
mass = "1.1 kg"

[scope]
not_covered = ["guides", "stem"]
reason = "judged by their maker"

"""


@cache
def text(kind="lift", follower=ARM):
    """First case with another follower in place of its stem and guides."""
    whole = first_case("swing", kind).text
    return whole[: whole.index("[follower]")] + follower + whole[whole.index("[lubricant]") :]


def changed(old, new, kind="lift"):
    whole = text(kind)
    assert old in whole
    return whole.replace(old, new)


def test_start_angle_and_prime_radius_follow_from_each_other():
    stated = parse_case(text())
    path = stated.contour(lift_of(stated)).pitch
    assert isinstance(path, ArmPath)
    # the cosine rule between the cam axis, the pivot and the roller centre
    cosine = (0.110**2 + 0.100**2 - 0.060**2) / (2.0 * 0.110 * 0.100)
    assert path.start == pytest.approx(np.arccos(cosine), rel=1e-12)
    start = f'"{np.degrees(path.start):.12g} deg"'
    whole = re.sub(r"prime_radius = .*\n", "", text())
    whole = whole.replace('swing = "with"', f'swing = "with"\nstart_angle = {start}')
    assert parse_case(whole).cam.prime_radius == pytest.approx(0.060, rel=1e-12)


def test_the_mass_follows_from_the_moment_of_inertia():
    whole = text().replace('mass = "1.1 kg"\n', "", 1)
    whole = whole.replace('swing = "with"', 'swing = "with"\ninertia = "0.011 kg m^2"')
    assert parse_case(whole).follower.mass == pytest.approx(1.1, rel=1e-12)
    for wrong in ("0 kg m^2", "1 kg"):
        with pytest.raises(InputError, match=r"follower\.arm\.inertia"):
            parse_case(whole.replace("0.011 kg m^2", wrong))


def test_start_angle_and_inertia_are_factors():
    """With the distances of which prime radius and mass follow: the cosine rule, J/l^2."""
    case = parse_case(text())
    start, inertia = np.radians([33.0, 35.0]), np.array([0.012, 0.013])
    distance, length = np.array([0.115, 0.112]), np.array([0.095, 0.102])
    factors = {
        "follower.arm.start_angle": start, "follower.arm.inertia": inertia,
        "follower.arm.centre_distance": distance, "follower.arm.length": length,
    }  # fmt: skip
    prime = np.sqrt(distance**2 + length**2 - 2.0 * distance * length * np.cos(start))
    for group in groups(case, factors):
        (row,) = group.rows
        assert not group.values
        assert group.case.cam.prime_radius == pytest.approx(prime[row], rel=1e-12)
        assert group.case.follower.mass == pytest.approx((inertia / length**2)[row], rel=1e-12)
    (both,) = groups(case, {"follower.arm.start_angle": start[:1], "cam.prime_radius": prime[:1]})
    assert "left out with cam.prime_radius" in both.refused
    swept = Factor(key="follower.arm.start_angle", list=["33 deg", "0.6 rad"])
    np.testing.assert_allclose(axis_of(swept, case).levels, [33.0, np.degrees(0.6)])


def test_angles_of_swing_are_arcs():
    stated = parse_case(changed('stroke = "10 mm"', 'stroke = "6 deg"').replace("-10 mm", "-6 deg"))
    highest = lift_of(stated).highest.value
    assert highest == pytest.approx(0.100 * np.radians(6.0), rel=1e-8)
    with pytest.raises(InputError, match=r"lift\.segment\[0\]\.stroke"):
        parse_case(changed('stroke = "10 mm"', 'stroke = "6 kg"'))


def test_workshop_and_lift_state_the_arm():
    case = parse_case(text())
    lift = lift_of(case)
    angle = next(v for k, v in lift_columns(case, lift).items() if k.name == "arm_angle")
    start = case.contour(lift).pitch.start
    np.testing.assert_allclose(angle, start + lift(drawn_angles(case)) / 0.100, rtol=1e-12)
    (note,) = (each for each in notes_of(case) if "pivot" in each)
    assert note.startswith("pivot 110 mm from the cam axis, 100 mm to the roller centre; arm at 3")
    assert note.endswith("swings outwards with the rotation of the cam")


def test_the_drawing_states_the_swing_by_cam_angle():
    """The roller centre by the law of cosines from the arm angle, which the lift turns."""
    case = parse_case(text())
    arm = dimensions_record(case, case.contour(lift_of(case)))["arm"]
    assert (arm["centre_distance_mm"], arm["length_mm"], arm["swing"]) == (110.0, 100.0, "with")
    assert len(arm["by_cam_angle"]) == 36
    start = arm["by_cam_angle"]["0"][1]
    for degrees, (radius, angle) in arm["by_cam_angle"].items():
        lift = 1e3 * float(lift_of(case)(np.radians(float(degrees))))
        assert angle - start == pytest.approx(np.degrees(lift / 100.0), abs=1e-9)
        square = 110.0**2 + 100.0**2 - 2.0 * 110.0 * 100.0 * np.cos(np.radians(angle))
        assert radius**2 == pytest.approx(square, rel=1e-12)
    stem = parse_case(text("lift", STEM))
    assert dimensions_record(stem, stem.contour(lift_of(stem)))["arm"] is None


@pytest.mark.parametrize("swing", ["with", "against"])
def test_the_drawn_roller_touches_the_drawn_cam(swing):
    """The contact of the drawing, turned back by the cam, is that of the contour."""
    case = parse_case(changed('swing = "with"', f'swing = "{swing}"'))
    contour, theta = case.contour(lift_of(case)), np.linspace(0.0, 6.0, 25)
    arm, mm = contour.pitch.arm, 1e3
    drawn = DrawnArm(
        mm * arm.centre_distance, mm * arm.length, arm.sense, contour.pitch.start, 10.0
    )
    roller = mm * contour.follower_radius
    mechanism = DrawnMechanism(
        mm * contour.polygon(360), 15.0, None, None, 0.0, 0.0, 10.0, roller, 8.0, None, 10.0, 50.0,
        (), None, 2.0, MechanismSizes(46.4, 15.0, 0.0, 50.0, 10.0, (23.5, 9.0), 10.0, 50.0, (), ()),
        None, drawn,
    )  # fmt: skip
    lift = mm * contour.lift(theta)
    alpha = contour.pitch.pressure_angle(theta)
    motion = DrawnMotion("", theta, theta, "", lift, alpha, None, {"contact": np.ones(25)})
    touched = contact_point(mechanism, motion)
    for k, angle in enumerate(theta):
        turned = rotation(cam_turn(angle)) @ (mm * contour.points(angle))
        np.testing.assert_allclose(touched[:, k], turned, rtol=0, atol=1e-9)
    whole = drawing(mechanism, motion, 7)
    assert "roller and arm on its pivot" in whole.alt
    assert {"follower", "pivot", "cam"} <= {group.name for group in whole.groups}
    across, along = mechanism.envelope.across, mechanism.envelope.along
    ends = drawn.end(lift)
    assert across[0] <= ends[0].min() - roller + 1e-9 and along[1] >= drawn.pivot
    (push,) = arrows(mechanism, motion, 7)
    inwards = np.subtract(push.tip, push.tail)
    assert np.dot(inwards, drawn.end(lift[7]) - touched[:, 7]) > 0.0


def lift_of(case):
    from camwright.pipeline.case.given_lift import given_lift

    return given_lift(case)


def test_a_resolved_case_reads_back():
    case = parse_case(text())
    again = parse_case(case.to_toml())
    assert again.to_toml() == case.to_toml()
    assert again.follower.arm == case.follower.arm


def test_the_sign_off_leaves_out_arm_and_pivot_alone():
    scope = parse_case(text()).scope
    parts = "arm of the follower, pivot of the arm"
    line = f"Not covered by this sign-off: {parts}: its pivot is judged"
    assert scope.statement.startswith(line)
    everything = parse_case(changed('["arm"]', '"all"')).scope
    assert "arm of the follower" in everything.statement
    assert "pivot of the arm" in everything.statement
    assert "guides" not in everything.statement


@pytest.mark.parametrize(("old", "new", "message"), [
    ('swing = "with"', 'swing = "with"\nstart_angle = "30 deg"',
     "follower.arm.start_angle = 30 deg, must be left out with cam.prime_radius"),
    ('swing = "with"', 'swing = "with"\ninertia = "0.011 kg m^2"',
     "follower.arm.inertia = 0.011 kg m^2, must be left out with follower.mass"),
    ('swing = "with"', 'swing = "left"', "follower.arm.swing = left"),
    ('swing = "with"\n', "", "follower.arm.swing = missing"),
    ('length = "100 mm"', 'length = "40 mm"', "cam.prime_radius = 60 mm, must be > 70 mm"),
    ('length = "100 mm"', 'length = "0 mm"', "follower.arm.length = 0 mm"),
    ('centre_distance = "110 mm"', 'centre_distance = "170 mm"',
     "cam.prime_radius = 60 mm, must be > 70 mm"),
    ('mass = "1.1 kg"', 'mass = "1.1 kg"\ngravity_angle = "0 deg"',
     "follower.gravity_angle = 0 deg, must be left out with an arm"),
    ('[solver]', '[valve_train]\ncam_mass = "300 g"\n\n[solver]',
     "valve_train = a table, must be left out with an arm"),
    ('width = "15.5 mm"', 'offset = "2 mm"\nwidth = "15.5 mm"',
     "cam.offset = 2 mm, must be 0 mm with an arm"),
])  # fmt: skip
def test_contradictions_are_refused(old, new, message):
    with pytest.raises(InputError) as refused:
        parse_case(changed(old, new))
    assert message in str(refused.value)


def test_a_stem_leaves_out_no_arm():
    """Its statement would not name guides and stem."""
    whole = text("lift", STEM.replace('["guides", "stem"]', '["arm", "guides", "stem"]'))
    with pytest.raises(
        InputError, match=r"scope\.not_covered = arm, guides, stem, must be without"
    ):
        parse_case(whole)


def test_a_stem_with_an_arm_is_refused():
    whole = text(
        "lift",
        STEM.replace(
            "[scope]", ARM[ARM.index("[follower.arm]") : ARM.index("[scope]")] + "[scope]"
        ),
    )
    with pytest.raises(InputError) as refused:
        parse_case(whole)
    message = 'follower.arm = a table, must be left out, or follower.kind = "oscillating"'
    assert str(refused.value) == message


def test_an_arm_without_its_table_is_refused():
    whole = text()
    start = whole.index("[follower.arm]")
    with pytest.raises(InputError, match=r"follower\.arm = missing, must be given"):
        parse_case(whole[:start] + whole[whole.index("[scope]") :])


def test_a_start_angle_out_of_range_is_refused():
    whole = re.sub(r"prime_radius = .*\n", "", text())
    for angle in ("0 deg", "180 deg", "nan deg", "1 mm"):
        wrong = whole.replace('swing = "with"', f'swing = "with"\nstart_angle = "{angle}"')
        with pytest.raises(InputError, match=r"follower\.arm\.start_angle"):
            parse_case(wrong)


def test_a_swing_past_the_line_of_centres_is_refused():
    """The roller of a short arm on a far pivot would pass behind it."""
    whole = changed('centre_distance = "110 mm"', 'centre_distance = "60 mm"')
    whole = whole.replace('length = "100 mm"', 'length = "5 mm"')
    with pytest.raises(InputError, match=r"follower\.arm angle = .* must be > 0 and < 180 deg"):
        preview_case(parse_case(whole), corners=False)


@pytest.mark.parametrize("swing", ["with", "against"])
def test_a_first_case_on_an_arm_passes_its_preview(swing):
    case = parse_case(changed('swing = "with"', f'swing = "{swing}"'))
    trial = preview_case(case)
    judged = [each for each in trial.checks if each.must_have and not each.judged_at]
    assert {each.id for each in judged if each.status == "fail"} == set()
    made = {each.id for each in trial.checks}
    assert not {name for name in made if name.startswith(("guide_", "jam_", "mesh_reaction"))}


def without_table(whole, first, last):
    """Text of a case without the lines from `first` up to `last`."""
    return whole[: whole.index(first)] + whole[whole.index(last) :]


@pytest.mark.parametrize(("first", "last", "named"), [
    ("[follower.pivot]", "[lubricant]", {
        "follower.pivot.pin_material", "follower.pivot.bush.card", "follower.pivot.bush.length",
        "follower.pivot.bush.wear_rate", "materials.case_hardened.expansion"}),
    ('width = "28 mm"', "[follower.pivot]", {
        "follower.arm.width", "follower.arm.depth", "follower.arm.material",
        "follower.arm.pivot_notch", "follower.arm.roller_notch"}),
])  # fmt: skip
def test_missing_data_of_pivot_and_arm_are_completed_by_their_examples(first, last, named):
    """As `check --missing` prints them, pasted until nothing is missing."""
    whole, stated = without_table(first_case("swing", "arm").text, first, last), set()
    for _ in range(3):
        case = parse_case(whole).with_positions(36)
        records = [each.as_record() for each in preview_case(case, corners=False).checks]
        text = added_text(missing_keys(records, must_have=True), (), case.materials)
        if text == NOTHING:
            break
        stated |= set(values_in(tomllib.loads(text)["added"][0]))
        whole += "\n" + text
    else:
        pytest.fail(f"still missing: {text}")
    assert named <= stated


def test_no_value_of_a_guide_is_to_be_confirmed_of_an_arm():
    """Its guides stand in for none."""
    checks = preview_case(parse_case(text()).with_positions(36), corners=False).checks
    values = {value for each in checks for value in each.unconfirmed}
    assert "follower.mass" in values
    assert not {value for value in values if value.startswith("guides.")}


def test_a_long_arm_has_the_demands_of_a_stem():
    """Ten metres long, so that the line of travel turns by 1e-3 rad over the lift.

    The gear meshes on the same side of it: angles on the camshaft go from the line to the pivot.
    """
    centres = f'"{1e3 * np.hypot(9.99, 0.06):.12g} mm"'  # so that the first travel is radial
    far = ARM.replace('"110 mm"', centres).replace('"100 mm"', '"9990 mm"')
    start = np.degrees(np.arctan2(0.06, 9.99))
    meshing = f'gear_radius = "40 mm"\nmesh_angle = "{90.0 + start:.9g} deg"'
    of_arm, of_stem = (
        {each.id: each for each in preview_case(parse_case(whole), corners=False).checks}
        for whole in (
            text("lift", far).replace('gear_radius = "40 mm"', meshing),
            text("lift", STEM),
        )
    )
    compared = 0
    for name, one in of_stem.items():
        other = of_arm.get(name)
        if other is None or one.demand is None or other.demand is None or one.demand == 0.0:
            continue
        assert other.demand == pytest.approx(one.demand, rel=5e-3), name
        compared += 1
    assert compared > 60


def test_the_screening_judges_arms_as_their_previews():
    """Prime radius, rate, preload, section and pivot of the first case of an arm as arrays, within
    the stated deviations: of the pivot every check that is judged with them.
    """
    case = parse_case(first_case("swing", "arm").text).with_positions(180)
    factors = {
        "cam.prime_radius": np.array([0.058, 0.060, 0.064]),
        "roller.radius": np.array([0.0235, 0.0235, 0.0235]),
        "spring.rate": np.array([100e3, 102e3, 98e3]),
        "spring.preload": np.array([900.0, 1000.0, 1100.0]),
        "follower.arm.depth": np.array([0.024, 0.026, 0.025]),
        "follower.pivot.bush.length": np.array([0.025, 0.022, 0.028]),
        "follower.pivot.bush.friction": np.array([0.10, 0.08, 0.12]),
        "follower.pivot.swinging_mass": np.array([0.9, 1.0, 0.8]),
    }
    columns = screen_designs(case, factors)
    compared = set()
    for k in range(3):
        own = replaced(case, {key: float(each[k]) for key, each in factors.items()})
        known = {each.id: each for each in preview_case(own, corners=False).checks}
        assert columns["message"][k] == ""
        for screened in SCREENED:
            one, column = known.get(screened.check), columns.get(f"{screened.check}.demand")
            if one is None or one.demand is None or column is None or np.isnan(column[k]):
                continue
            limit = 0.0 if one.limit is None else in_unit(one.limit, one.unit)
            demand = in_unit(one.demand, one.unit)
            away = abs(float(column[k]) - demand) / max(abs(demand), abs(limit), 1e-12)
            assert not away > screened.deviation, one.id
            compared.add(one.id)
    assert {"contact_pressure", "pressure_angle", "undercut", "roller_speed"} <= compared
    of_pivot = {each.check for each in SCREENED if each.check.startswith("pivot_")}
    assert of_pivot - compared == {"pivot_static", "pivot_life"}  # of needles
    assert {"arm_yield", "arm_gap"} <= compared


def test_a_torque_is_balanced_by_an_arm():
    """The synthesis keeps all limits on the cam that the preview solves."""
    case = parse_case(text("cylinder"))
    trial = preview_case(case, corners=False)
    assert trial.synthesis is not None
    judged = [each for each in trial.checks if each.must_have and not each.judged_at]
    assert {each.id for each in judged if each.status == "fail"} == set()
    (ripple,) = (each for each in trial.checks if each.id == "torque_reduction")
    assert ripple.demand > 0.4
    used = [each.utilisation for each in judged if each.lift_can_help and each.utilisation]
    assert max(used) > 0.9


@pytest.mark.parametrize("kind", ["roller", "flat"])
def test_a_relaxed_prime_radius_is_within_the_reach_of_the_arm(kind):
    """The greatest that a conflict tries leaves the arm a swing; that of a stem is not bounded."""
    whole = text("cylinder") if kind == "roller" else face_text("flat", "cylinder")
    case = parse_case(whole.replace('prime_radius = "60 mm"', 'prime_radius = "70 mm"'))
    arm, offset = case.follower.arm, case.facing.offset
    factors = []
    for each in (case, parse_case(text("cylinder", STEM))):
        problem = problem_of(each, engine_torques(each))
        factors += [one.factor_max for one in _candidates(problem, []) if one.what[:5] == "prime"]
    assert factors[1] == FACTOR_MAX
    greatest = factors[0] * case.cam.prime_radius
    line = np.pi if offset is None else 0.5 * np.pi
    assert np.radians(15.0) < line - arm.start(greatest, offset) < np.radians(40.0)
    assert greatest == pytest.approx(arm.reach(offset)[1])
