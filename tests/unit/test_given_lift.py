"""Lifts as a case file gives them."""

import numpy as np
import pytest
from small_machine import small_machine

from camwright.geometry.errors import InputError
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift, lift_origin

SEGMENTS = """
[lift]
kind = "segments"
repeat = {repeat}

[[lift.segment]]
law = "harmonic"
angle = "{rise} deg"
stroke = "{stroke} mm"

[[lift.segment]]
law = "modified_sine"
angle = "60 deg"
stroke = "-8 mm"
"""


def with_lift(text: str) -> str:
    """The template case, its engine replaced by a lift."""
    head, rest = small_machine("given").split("[engine]")
    after = rest[rest.index("\n[") :]
    return head + text + after


def case(text: str) -> Case:
    return parse_case(with_lift(text))


def segments(repeat: int = 3, rise: float = 60, stroke: float = 8) -> str:
    return SEGMENTS.format(repeat=repeat, rise=rise, stroke=stroke)


def test_segments_make_the_lift():
    lift = given_lift(case(segments()))
    # the spline rounds the jump of acceleration where harmonic meets sine, by 2e-8 m
    assert lift.stroke == pytest.approx(0.008, abs=1e-7)
    assert lift(np.radians([60, 180, 300])) == pytest.approx(0.008, abs=1e-7)
    assert lift_origin(case(segments())).endswith("harmonic, modified_sine, 3 times a turn")


@pytest.mark.parametrize(
    ("given", "refusal"),
    [
        (segments(rise=61), "lift.segment.angle = 121 deg in all, must be 120 deg in all"),
        (segments(repeat=1), "must be 360 deg in all"),
        (segments(repeat=0), "lift.repeat"),
        (segments(stroke=7.9), "the lift must close"),
        (segments().replace("harmonic", "cosine"), "lift.segment[0].law = cosine"),
        (segments().replace('"segments"', '"laws"'), "lift.kind = laws"),
        (segments().replace("[[lift.segment]]", "[[lift.part]]", 2), "lift.part = unknown key"),
        ('[lift]\nkind = "eccentric"\neccentricity = "0 mm"\n', "lift.eccentricity"),
        ('[lift]\nkind = "segments"\nsegment = []\n', "lift.segment"),
    ],
)
def test_bad_lift_is_refused_in_one_line(given, refusal):
    with pytest.raises(InputError) as caught:
        case(given)
    assert refusal in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", ["3", "[]", '"cosine"', "true"])
def test_a_lift_that_is_no_table_is_refused(value):
    limit = 'must be a table with kind = "table" or "segments" or "points" or "eccentric"'
    with pytest.raises(InputError, match=limit):
        case(f"lift = {value}\n")


def test_resolved_case_reads_back_bit_for_bit():
    first = case(segments())
    again = parse_case(first.to_toml())
    assert again.lift == first.lift
    assert again.to_toml() == first.to_toml()


def test_points_make_a_spline():
    rows = [(0, 0.5), (60, 2.0), (120, 6.0), (180, 8.0), (240, 6.0), (300, 2.0)]
    text = '[lift]\nkind = "points"\n' + "".join(
        f'[[lift.point]]\nangle = "{angle} deg"\nlift = "{value} mm"\n' for angle, value in rows
    )
    lift = given_lift(case(text))
    for angle, value in rows:
        assert lift(np.radians(angle)) == pytest.approx(1e-3 * value, abs=1e-10)


def test_eccentric_circle_is_the_pitch_curve():
    given = case('[lift]\nkind = "eccentric"\neccentricity = "4 mm"\n')
    assert given_lift(given).stroke == pytest.approx(0.008, rel=1e-9)


def table(folder, noise=""):
    angle = np.arange(0, 360, 1.0)
    clean = 4 * (1 - np.cos(np.radians(angle)))
    lift = np.abs(clean + np.random.default_rng(1).normal(0, 0.004, angle.size))
    rows = "".join(f"{a},{s!r}\n" for a, s in zip(angle, lift.tolist(), strict=True))
    (folder / "lift.csv").write_text("cam_angle_deg,lift_mm\n" + rows)
    path = folder / "given.toml"
    path.write_text(with_lift(f'[lift]\nfile = "lift.csv"\n{noise}'))
    return read_case(path)


def test_table_without_a_kind_is_followed_row_by_row(tmp_path):
    found = table(tmp_path)
    assert found.lift.kind == "table"
    assert lift_origin(found) == "the lift is given"
    assert given_lift(found)(0.0, 0) == pytest.approx(given_lift(found).values[0])


def test_noisy_table_is_fitted_and_its_residual_stated(tmp_path):
    found = table(tmp_path, 'noise = "5 um"\n')
    assert "residual 3." in lift_origin(found) or "residual 4." in lift_origin(found)
    lift = given_lift(found)
    theta = np.linspace(0, 2 * np.pi, 50)
    np.testing.assert_allclose(lift(theta), 0.004 * (1 - np.cos(theta)), atol=4e-6)


def test_understated_noise_is_refused(tmp_path):
    found = table(tmp_path, 'noise = "0.1 um"\n')
    with pytest.raises(InputError, match=r"lift\.noise"):
        given_lift(found)


ECCENTRIC = '[lift]\nkind = "eccentric"\neccentricity = "8 mm"\n'


def flat(text, width="18 mm"):
    """A case of `text` with a flat face in place of its roller."""
    start, end = text.index("[roller]"), text.index("[follower]")
    face = f"""
[follower.face]
width = "{width}"
depth = "10 mm"
thickness = "5 mm"
friction = 0.08
material = "hardened_steel"
"""
    rest = text[end:].replace("[follower]", '[follower]\nkind = "flat"')
    cut = rest.index("\n[", 1)
    return text[:start] + rest[:cut] + "\n" + face + rest[cut:]


def test_flat_face_takes_the_place_of_the_roller():
    found = parse_case(flat(with_lift(ECCENTRIC)))
    assert found.facing is found.follower.face
    assert found.facing.side_friction == 0.08
    with pytest.raises(
        InputError, match=r"follower\.face = a table, must be left out for a value of the roller"
    ):
        _ = found.roller
    assert parse_case(found.to_toml()) == found
    lift = given_lift(found)
    theta = np.linspace(0, 2 * np.pi, 50)
    np.testing.assert_allclose(lift(theta), 0.008 * (1 - np.cos(theta)), atol=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: flat(t, "15.9 mm"), r"follower\.face\.width = 15\.9 mm, must be > 16 mm"),
        (lambda t: flat(t, "-1 mm"), r"follower\.face\.width = -1 mm, must be > 0"),
        (
            lambda t: flat(t).replace('kind = "flat"', 'kind = "roller"'),
            r"follower\.face = a table",
        ),
        (lambda t: flat(t).replace("thickness", "thikness"), r"follower\.face\.thikness = unknown"),
        (
            lambda t: flat(t).replace("friction = 0.08", 'pv_limit = "-1 MPa m/s"'),
            "pv_limit = -1 MPa",
        ),
        (
            lambda t: flat(t).replace("friction = 0.08", 'roughness = "0 um"'),
            "roughness = 0 um, must",
        ),
        (lambda t: flat(t).replace('"5 mm"', "5"), r"follower\.face\.thickness = 5, must be"),
        (lambda t: flat(t).replace("= 0.08", "= 2.0"), r"follower\.face\.friction = 2\.0, must be"),
        (lambda t: flat(t) + t[t.index("[roller]") : t.index("[follower]")], "roller = a table"),
        (lambda t: t.replace("[follower]", '[follower]\nkind = "flat"'), "follower.face = missing"),
        (lambda t: t[: t.index("[roller]")] + t[t.index("[follower]") :], "roller = missing"),
    ],
)
def test_bad_face_is_refused(change, message):
    with pytest.raises(InputError, match=message):
        parse_case(change(with_lift(ECCENTRIC)))


def test_synthesis_within_limits_takes_a_face():
    text = flat(small_machine("flat")).replace('kind = "moving_average"', 'kind = "constrained"')
    case = parse_case(text)
    assert case.smoothing.kind == "constrained"
    assert case.follower.face is not None
