"""Smallest cams of given limits, against closed forms and derivations by hand."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from camwright.geometry.cam_size import EccentricCam, FaceCam, GivenLiftCam, PitchLimits
from camwright.geometry.eccentric import Eccentric
from camwright.geometry.errors import InputError
from camwright.geometry.flat_face_contour import FacePath, FlatFaceContour
from camwright.geometry.lift import Lift
from camwright.geometry.lift_parts import LiftParts
from camwright.geometry.motion_laws import LAWS, Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve

DEG = math.pi / 180.0
THIRTY = PitchLimits(30 * DEG, 30 * DEG)
ROLLER = 1.0
EXACT = 1e-6
"""Of the published digits."""
ROUND_OFF = 1e-9
"""Root finding to 1e-12 of the lengths, and the square of the refined places."""


def double_rise(law: str) -> LiftParts:
    """Rise 3, dwell, return 3, dwell, rise 2, dwell, return 2, dwell."""
    segments = []
    for stroke, angle in ((3, 90), (-3, 90), (2, 60), (-2, 60)):
        segments += [Segment(law, angle * DEG, float(stroke)), Segment("dwell", 15 * DEG)]
    return LiftParts.of_motion(SegmentMotion(tuple(segments)))


def cycloid(stroke: float, angle: float, x: float) -> tuple[float, float, float, float]:
    """Lift of a cycloidal rise and its derivatives to the third, by hand."""
    w = 2.0 * math.pi
    return (
        stroke * (x - math.sin(w * x) / w),
        stroke / angle * (1.0 - math.cos(w * x)),
        stroke / angle**2 * w * math.sin(w * x),
        stroke / angle**3 * w * w * math.cos(w * x),
    )


STROKES = ((3.0, 90 * DEG), (2.0, 60 * DEG))


def prime_radius_of_cycloid() -> float:
    """Greatest s'/tan(30 deg) - s: stationary where s'' = s' tan(30 deg)."""
    tangent = math.tan(30 * DEG)

    def stationary(x: float, stroke: float, angle: float) -> float:
        _, s1, s2, _ = cycloid(stroke, angle, x)
        return s2 - s1 * tangent

    heights = []
    for stroke, angle in STROKES:
        x = brentq(stationary, 0.25, 0.5, args=(stroke, angle), xtol=1e-15)
        s, s1, *_ = cycloid(stroke, angle, x)
        heights.append(s1 / tangent - s)
    return max(heights)


def test_cycloidal_roller_cam() -> None:
    prime = GivenLiftCam(double_rise("cycloidal")).least_prime_radius(THIRTY)
    assert prime == pytest.approx(prime_radius_of_cycloid(), abs=ROUND_OFF)
    assert prime - ROLLER == pytest.approx(4.677017, abs=EXACT)


def test_least_pitch_radius_of_the_cycloid() -> None:
    prime = prime_radius_of_cycloid()

    def curvature_slope(x: float, stroke: float, angle: float) -> float:
        s, s1, s2, s3 = cycloid(stroke, angle, x)
        r = prime + s
        square, turning = r * r + s1 * s1, r * r + 2 * s1 * s1 - r * s2
        change = 2 * r * s1 + 4 * s1 * s2 - s1 * s2 - r * s3
        return change * square - 3.0 * turning * (r * s1 + s1 * s2)

    radii = []
    for stroke, angle in STROKES:
        x = brentq(curvature_slope, 0.55, 0.95, args=(stroke, angle), xtol=1e-15)
        s, s1, s2, _ = cycloid(stroke, angle, x)
        r = prime + s
        radii.append((r * r + s1 * s1) ** 1.5 / (r * r + 2 * s1 * s1 - r * s2))
    least = GivenLiftCam(double_rise("cycloidal")).extremes(prime).convex_radius.value
    assert least == pytest.approx(min(radii), abs=ROUND_OFF)
    assert least == pytest.approx(3.096907, abs=EXACT)


def test_harmonic_roller_cam() -> None:
    # s'/t - s = (pi h/(2 b t)) sin u + (h/2) cos u - h/2, of which the greatest is a hypotenuse
    def greatest(stroke: float, angle: float) -> float:
        swing = math.pi * stroke / (2.0 * angle * math.tan(30 * DEG))
        return math.hypot(swing, 0.5 * stroke) - 0.5 * stroke

    cam = GivenLiftCam(double_rise("harmonic"))
    prime = cam.least_prime_radius(THIRTY)
    assert prime == pytest.approx(max(greatest(*each) for each in STROKES), abs=ROUND_OFF)
    assert prime - ROLLER == pytest.approx(3.291503, abs=EXACT)
    # at the end of the short rise: s' = 0, s'' = -(h/2)(pi/b)^2 = -9
    least = cam.extremes(prime).convex_radius.value
    assert least == pytest.approx((prime + 2.0) ** 2 / (prime + 2.0 + 9.0), abs=ROUND_OFF)
    assert least == pytest.approx(2.588562, abs=EXACT)


def test_flat_face_cams() -> None:
    harmonic, cycloidal = FaceCam(double_rise("harmonic")), FaceCam(double_rise("cycloidal"))
    # harmonic: s + s'' = 2 - 9; s' at most pi h/(2 b) = 3
    assert harmonic.least_base_radius(0.25) == pytest.approx(0.25 + 7.0, abs=ROUND_OFF)
    assert harmonic.face_width() == pytest.approx(6.0, abs=ROUND_OFF)
    # cycloidal: s + s'' is least where s' + s''' = 0; s' at most 2 h/b

    def stationary(x: float, stroke: float, angle: float) -> float:
        _, s1, _, s3 = cycloid(stroke, angle, x)
        return s1 + s3

    sums = []
    for stroke, angle in STROKES:
        x = brentq(stationary, 0.6, 0.9, args=(stroke, angle), xtol=1e-15)
        s, _, s2, _ = cycloid(stroke, angle, x)
        sums.append(s + s2)
    base = cycloidal.least_base_radius(0.25)
    assert base == pytest.approx(0.25 - min(sums), abs=ROUND_OFF)
    assert base == pytest.approx(9.895394, abs=EXACT)
    assert cycloidal.least_radius(base).value == pytest.approx(0.25, abs=ROUND_OFF)
    assert cycloidal.face_width() == pytest.approx(4.0 * 3.0 / (90 * DEG), abs=ROUND_OFF)
    assert cycloidal.face_width() == pytest.approx(7.639437, abs=EXACT)


def test_harmonic_cam_that_is_an_eccentric() -> None:
    half = SegmentMotion((Segment("harmonic", math.pi, 2.0), Segment("harmonic", math.pi, -2.0)))
    angles = GivenLiftCam(LiftParts.of_motion(half)).extremes(2.0)
    # tan = sin/(3 - cos), greatest where cos = 1/3
    assert math.sin(angles.rise.value) == pytest.approx(1 / 3, abs=ROUND_OFF)
    assert math.sin(angles.back.value) == pytest.approx(1 / 3, abs=ROUND_OFF)


@pytest.mark.parametrize("offset", [-0.5, 0.0, 0.7])
@pytest.mark.parametrize("law", [name for name in LAWS if name not in ("parabolic", "harmonic")])
def test_size_keeps_its_limits_on_the_pitch_curve(law: str, offset: float) -> None:
    """The spline of the lift at 60000 cam angles: another lift, and no root finding."""
    segments = (Segment(law, 100 * DEG, 3.0), Segment("dwell", 20 * DEG),
                Segment(law, 150 * DEG, -3.0), Segment("dwell", 90 * DEG))  # fmt: skip
    motion = SegmentMotion(segments)
    limits = PitchLimits(28 * DEG, 28 * DEG, convex_radius=3.5, concave_radius=9.0)
    prime = GivenLiftCam(LiftParts.of_motion(motion)).least_prime_radius(limits, offset)
    theta = np.linspace(0.0, 2.0 * math.pi, 60001)
    lift = motion.lift()

    def worst(radius: float) -> float:
        pitch = PitchCurve(lift, radius, offset)
        kappa = pitch.curvature(theta)
        angle = np.abs(pitch.pressure_angle(theta)).max() / (28 * DEG)
        return max(angle, 3.5 * kappa.max(), -9.0 * kappa.min())

    # the curvature of the spline is within 1e-5 of the law's
    assert worst(prime) == pytest.approx(1.0, abs=1e-5)
    assert worst(1.001 * prime) < 1.0 < worst(0.999 * prime)


def test_larger_cams_keep_the_curvature_too() -> None:
    """1/d - s''/d^2 has its greatest value at d = 2 s'', between two radii that keep the limit."""
    up = (Segment("cycloidal", 60 * DEG, 6.0), Segment("cycloidal", 300 * DEG, -6.0))
    cam = GivenLiftCam(LiftParts.of_motion(SegmentMotion(up)))
    for radius in (0.2, 1.0, 5.0):
        limits = PitchLimits(80 * DEG, 80 * DEG, convex_radius=radius)
        prime = cam.least_prime_radius(limits)
        for larger in (1.0 + 1e-9, 1.05, 1.5, 3.0, 10.0):
            assert cam.extremes(larger * prime).convex_radius.value >= radius


def test_best_offset_balances_rise_and_return() -> None:
    segments = (Segment("cycloidal", 80 * DEG, 3.0), Segment("dwell", 20 * DEG),
                Segment("harmonic", 170 * DEG, -3.0), Segment("dwell", 90 * DEG))  # fmt: skip
    cam = GivenLiftCam(LiftParts.of_motion(SegmentMotion(segments)))
    for limits in (THIRTY, PitchLimits(30 * DEG, 45 * DEG)):
        size = cam.smallest(limits)
        angles = cam.extremes(*size)
        assert angles.rise.value == pytest.approx(limits.rise, abs=1e-8)
        assert angles.back.value <= limits.back + 1e-8
        assert cam.best_offset(size.prime_radius, limits) == pytest.approx(size.offset, abs=1e-7)
        trials = np.linspace(-0.9, 0.9, 13) * size.prime_radius
        assert all(
            cam.least_prime_radius(limits, float(e)) >= size.prime_radius - ROUND_OFF
            for e in trials
        )
    size = cam.smallest(THIRTY)
    assert cam.extremes(*size).back.value == pytest.approx(30 * DEG, abs=1e-8)
    assert size.offset > 0.3  # the rise is steeper
    assert cam.smallest(THIRTY).prime_radius < 0.93 * cam.least_prime_radius(THIRTY)


@pytest.mark.parametrize("prime", [8.0, 9.0, 12.0])
def test_best_offset_keeps_the_curvature(prime: float) -> None:
    """A scan of offsets finds no smaller angle within the curvature, which moves the best one."""
    segments = (Segment("cycloidal", 80 * DEG, 3.0), Segment("dwell", 20 * DEG),
                Segment("harmonic", 170 * DEG, -3.0), Segment("dwell", 90 * DEG))  # fmt: skip
    cam = GivenLiftCam(LiftParts.of_motion(SegmentMotion(segments)))
    free = cam.best_offset(prime, THIRTY)
    least = 1.002 * cam.extremes(prime, free).convex_radius.value
    limits = PitchLimits(30 * DEG, 30 * DEG, convex_radius=least)
    offset = cam.best_offset(prime, limits)
    assert abs(offset - free) > 1e-3
    best = cam.extremes(prime, offset)
    assert best.convex_radius.value >= least
    for each in np.linspace(-0.9, 0.9, 181) * prime:
        pitch = cam.extremes(prime, float(each))
        # A thousandth of the radius is left for a rounded offset.
        if pitch.convex_radius.value >= 1.001 * least:
            assert pitch.pressure_angle.value >= best.pressure_angle.value - ROUND_OFF


def test_a_symmetric_lift_needs_no_offset() -> None:
    assert GivenLiftCam(double_rise("harmonic")).smallest(THIRTY).offset == 0.0


@pytest.mark.parametrize("offset", [-0.004, 0.0, 0.003, 0.012])
def test_eccentric_under_a_roller(offset: float) -> None:
    cam, limits = EccentricCam(0.01), PitchLimits(30 * DEG, 40 * DEG)
    prime = cam.least_prime_radius(limits, offset)
    lift = Eccentric(0.01, prime + 0.01, offset).lift(2880)
    alpha = PitchCurve(lift, prime, offset).pressure_angle(lift.theta)
    slope = lift(lift.theta, 1)
    use = np.abs(alpha) / np.where(slope > 0.0, limits.rise, limits.back)
    assert use.max() == pytest.approx(1.0, abs=1e-5)  # sampled each eighth of a degree


def test_best_offset_of_an_eccentric() -> None:
    cam, limits = EccentricCam(0.01), PitchLimits(30 * DEG, 40 * DEG)
    prime, offset = cam.smallest(limits)
    rod = 2.0 * 0.01 / (math.sin(limits.rise) + math.sin(limits.back))
    assert prime == pytest.approx(rod - 0.01, abs=1e-15)
    angles = cam.extremes(prime, offset)
    assert (angles.rise.value, angles.back.value) == pytest.approx((30 * DEG, 40 * DEG), abs=1e-12)
    assert angles.convex_radius.value == pytest.approx(rod, rel=1e-9)
    assert cam.smallest(THIRTY).offset == 0.0


def test_face_of_a_given_lift() -> None:
    theta = np.linspace(0.0, 2.0 * math.pi, 720, endpoint=False)
    lift = Lift(theta, 4e-3 * (1.0 - np.cos(theta)) ** 2)
    face = FaceCam(LiftParts.of_lift(lift))
    base = face.least_base_radius(undercut_factor=0.3)
    contour = FlatFaceContour(FacePath(lift, base, face.best_offset()))
    assert contour.undercut().factor == pytest.approx(0.3, abs=1e-9)
    assert face.face_width(face.best_offset()) == pytest.approx(contour.face_width_min(), rel=1e-9)
    assert face.face_width(0.0) >= face.face_width(face.best_offset())


@pytest.mark.parametrize("angle", [0.0, -1.0, math.nan, 0.5 * math.pi])
def test_angles_out_of_bounds(angle: float) -> None:
    with pytest.raises(InputError, match="pressure angle, rise"):
        PitchLimits(angle, 30 * DEG)


def test_offset_beyond_the_prime_radius() -> None:
    with pytest.raises(InputError, match=r"cam\.offset"):
        EccentricCam(0.01).extremes(0.02, 0.02)
