"""Sizes of a cam under an arm: least prime radius and best centre distance, by contours."""

from __future__ import annotations

import numpy as np
import pytest
from swung_face import face_text

from camwright.geometry.arm_face import ArmFaceContour, ArmFacePath
from camwright.geometry.arm_path import Arm, ArmContour, ArmPath
from camwright.geometry.arm_size import ArmCam, ArmFaceCam
from camwright.geometry.arrays import uniform_turn
from camwright.geometry.cam_size import PitchLimits
from camwright.geometry.errors import InputError
from camwright.geometry.lift_parts import LiftParts
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.template import first_case
from camwright.pipeline.search.sizes.open_case import (
    DISTANCE,
    FACE,
    PRIME,
    ROLLER,
    parse_open_case,
)
from camwright.pipeline.search.sizes.sizing import sized

LENGTH = 0.1
MOTION = SegmentMotion((
    Segment("cycloidal", np.radians(90.0), 0.02), Segment("dwell", np.radians(60.0)),
    Segment("modified_sine", np.radians(130.0), -0.02), Segment("dwell", np.radians(80.0)),
))  # fmt: skip
THETA = uniform_turn(3600)


def path(prime: float, distance: float, sense: float) -> ArmPath:
    arm = Arm(distance, LENGTH, sense)
    return ArmPath(MOTION.lift(), arm, float(arm.angle(prime)))


def greatest(prime: float, distance: float, sense: float) -> tuple[float, float, float]:
    """Greatest pressure angles of rise and return, rad, least convex radius, m, by the path."""
    of = path(prime, distance, sense)
    slope = MOTION.lift().derivatives(THETA, 1)[1]
    angle = np.abs(of.pressure_angle(THETA))
    rising, falling = angle[slope >= -1e-9].max(), angle[slope <= 1e-9].max()
    return float(rising), float(falling), float(1.0 / of.curvature(THETA).max())


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("limits", [
    PitchLimits(np.radians(30.0), np.radians(30.0), 0.03),
    PitchLimits(np.radians(29.0), np.radians(35.0)),
])  # fmt: skip
def test_the_least_prime_radius_is_at_a_limit_of_its_path(
    sense: float, limits: PitchLimits
) -> None:
    """Sampled at a tenth of a degree: angles within 1e-4, radii within 1e-4 of their value."""
    cam = ArmCam(LiftParts.of_motion(MOTION), LENGTH, sense)
    for distance in (0.11, 0.12):
        prime = cam.least_prime_radius(limits, distance)
        rise, back, convex = greatest(prime, distance, sense)
        uses = (rise / limits.rise, back / limits.back, limits.convex_radius / convex)
        assert max(uses) == pytest.approx(1.0, abs=2e-4)
        smaller = greatest(0.99 * prime, distance, sense)
        beyond = (smaller[0] / limits.rise, smaller[1] / limits.back,
                  limits.convex_radius / smaller[2])  # fmt: skip
        assert max(beyond) > 1.0


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_no_centre_distance_gives_a_smaller_cam(sense: float) -> None:
    limits = PitchLimits(np.radians(30.0), np.radians(30.0), 0.03)
    cam = ArmCam(LiftParts.of_motion(MOTION), LENGTH, sense)
    prime, best = cam.smallest(limits)
    for share in (0.9, 0.97, 0.99, 1.01, 1.03, 1.1):
        try:
            other = cam.least_prime_radius(limits, share * best)
        except InputError:
            continue
        assert other >= prime * (1.0 - 1e-6), share
    assert cam.least_prime_radius(limits, best) == pytest.approx(prime, rel=1e-9)


def test_the_best_centre_distance_balances_rise_and_return() -> None:
    limits = PitchLimits(np.radians(30.0), np.radians(30.0))
    cam = ArmCam(LiftParts.of_motion(MOTION), LENGTH, 1.0)
    distance = cam.best_offset(0.06, limits)
    rise, back, _ = greatest(0.06, distance, 1.0)
    assert rise == pytest.approx(back, abs=1e-4)
    for other in (0.98 * distance, 1.02 * distance):
        assert max(greatest(0.06, other, 1.0)[:2]) > max(rise, back)


def test_a_swing_beyond_every_size_is_refused() -> None:
    cam = ArmCam(LiftParts.of_motion(MOTION), LENGTH, 1.0)
    with pytest.raises(InputError, match=r"follower\.arm\.centre_distance = 0\.3"):
        cam.least_prime_radius(PitchLimits(np.radians(5.0), np.radians(5.0)), 0.3)


def test_an_open_case_on_an_arm_is_completed() -> None:
    """Prime radius, centre distance and preload of the first case; its sizes pass the preview."""
    text = first_case("swing", "arm").text
    opened = parse_open_case(text, None, [PRIME, DISTANCE, "spring.preload"])
    assert opened.gaps == (PRIME, "spring.preload", DISTANCE)
    sizing = sized(opened)
    assert sizing.verdict == "pass"
    assert {"arm_gap", "arm_cam_gap"} <= {each.id for each in sizing.checks}
    assert not sizing.others  # pivot and arm are judged, too
    case = sizing.case
    contour = case.contour(MOTION.lift())
    assert isinstance(contour, ArmContour)
    assert contour.pitch.arm.centre_distance == sizing.values[DISTANCE]
    rises = sizing.shapes.record(sizing.shape)
    assert rises["pressure_angle_rise_deg"] == pytest.approx(
        rises["pressure_angle_return_deg"], abs=0.1
    )
    assert parse_open_case(text, None, [ROLLER]).gaps == (ROLLER,)


def faced(base: float, distance: float, sense: float, plane: float) -> ArmFaceContour:
    """Contour under a flat face, by its path."""
    arm = Arm(distance, LENGTH, sense)
    start = float(arm.face_angle(base, plane))
    return ArmFaceContour(ArmFacePath(MOTION.lift(), arm, start, plane))


@pytest.mark.parametrize(("sense", "plane"), [(1.0, 0.0), (1.0, 0.005), (-1.0, -0.01)])
def test_the_least_base_radius_under_a_face_is_at_a_limit_of_its_contour(
    sense: float, plane: float
) -> None:
    """Curvature and undercut factor of the contour at a tenth of a degree, to 1e-4 of their value;
    a smaller cam passes neither, with the centre distance of the narrowest face or with another.
    """
    cam = ArmFaceCam(LiftParts.of_motion(MOTION), LENGTH, sense, plane)
    for stated in (None, 0.115):
        base = cam.least_base_radius(0.005, 0.2, stated)
        distance = cam.best_offset(base) if stated is None else stated
        contour = faced(base, distance, sense, plane)
        radius = contour.pitch.radius_of_curvature(THETA)
        factor = contour.factor(THETA)
        assert cam.least_radius(base, distance).value == pytest.approx(radius.min(), rel=1e-4)
        assert cam.undercut_factor(base, distance) == pytest.approx(factor.min(), rel=1e-4)
        uses = 0.005 / radius.min(), 0.2 / factor.min()
        assert max(uses) == pytest.approx(1.0, abs=2e-4)
        smaller = 0.99 * base
        shorter = cam.best_offset(smaller) if stated is None else stated
        other = faced(smaller, shorter, sense, plane)
        least = other.pitch.radius_of_curvature(THETA).min()
        assert least < 0.005 or other.factor(THETA).min() < 0.2


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_best_centre_distance_has_the_narrowest_face(sense: float) -> None:
    """Its contact travels as far beyond the end of the arm as before it, by the samples of the
    lift: within 1e-3 of the width by the contour, over which no other distance gains.
    """
    cam = ArmFaceCam(LiftParts.of_motion(MOTION), LENGTH, sense, 0.005)
    best = cam.best_offset(0.075)
    width = faced(0.075, best, sense, 0.005).face_width_min()
    assert cam.face_width(best, 0.075) == pytest.approx(width, rel=1e-6)
    on_face = faced(0.075, best, sense, 0.005).pitch.slide(THETA).on_face
    assert on_face.max() == pytest.approx(-on_face.min(), rel=2e-3)
    for share in (0.9, 0.99, 1.01, 1.1):
        assert faced(0.075, share * best, sense, 0.005).face_width_min() > width


def test_a_face_that_turns_with_the_cam_is_refused() -> None:
    """An arm as short as its greatest slope; and a swing that no base radius draws."""
    lift = LiftParts.of_motion(MOTION)
    with pytest.raises(InputError, match=r"follower\.arm swing"):
        ArmFaceCam(lift, 0.02, 1.0, 0.0).least_base_radius()
    with pytest.raises(InputError, match=r"follower\.arm\.centre_distance = 0\.3"):
        ArmFaceCam(lift, LENGTH, 1.0, 0.0).least_base_radius(10.0, offset=0.3)


@pytest.mark.parametrize("kind", ["flat", pytest.param("curved", marks=pytest.mark.slow)])
def test_an_open_case_with_a_face_on_an_arm_is_completed(kind: str) -> None:
    """Radius, centre distance and face of the first case with a face; the preview agrees that the
    contact stays on it with its half-width, and on no narrower one.
    """
    opened = parse_open_case(face_text(kind), None, [PRIME, DISTANCE, FACE])
    assert opened.gaps == (PRIME, FACE, DISTANCE)
    sizing = sized(opened)
    assert sizing.verdict == "pass"
    case, record = sizing.case, sizing.shapes.record(sizing.shape)
    assert record["centre_distance_mm"] == pytest.approx(1e3 * case.follower.arm.centre_distance)
    assert sizing.values[PRIME] == case.cam.prime_radius
    (width,) = (each for each in sizing.checks if each.id == "face_width")
    assert width.utilisation is not None
    assert 0.99 < width.utilisation <= 1.0
    contour = case.contour(given_lift(case))
    assert sizing.shape.face_width > contour.face_width_min()
    assert [panel.quantity for panel in sizing.figure.panels]
