"""Petrescu and Petrescu (2015): roller-follower cams of module B and the classical module C.

The printed yields of 0.39 to 0.60 do not follow from eq. 6.18 of the paper, whose maximum is about
0.30 for every set: the equations are tested.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from camwright.geometry.contour import RollerContour
from camwright.geometry.motion_laws import Segment, SegmentMotion
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.cycle.valve_cam import (
    ElasticValve,
    ValveCam,
    rise_efficiency,
    shaft_speed,
)
from camwright.pipeline.follower.follower_forces import FollowerSystem, follower_loads
from camwright.pipeline.follower.spring import Spring
from validation.paper_figure import records
from validation.published_figures import PaperResult, Target, judged
from validation.validation_figures import SHOWN, yields

ROLLER = 0.002
GUIDE_FRICTION = 0.05  # assumed, for the true efficiency
GUIDE_SPACING, OVERHANG, TAPPET = 0.06, 0.02, 0.1  # m, m, kg; assumed


@dataclass(frozen=True)
class CamSet:
    """A published cam: base radius and stroke (m), rise angle (deg), spring (N/m, m)."""

    base_radius: float
    stroke: float
    rise: float
    rate: float
    compression: float

    @property
    def motion(self) -> SegmentMotion:
        """Harmonic rise and return, then dwell."""
        angle = float(np.radians(self.rise))
        return SegmentMotion(
            (
                Segment("harmonic", angle, self.stroke),
                Segment("harmonic", angle, -self.stroke),
                Segment("dwell", 2.0 * np.pi - 2.0 * angle),
            )
        )

    @property
    def cam(self) -> ValveCam:
        """Valve cam with the roller of the paper."""
        return ValveCam(self.motion, self.base_radius, ROLLER)


SETS = {
    "B1": CamSet(0.013, 0.020, 60.0, 5e5, 0.09),
    "B2": CamSet(0.015, 0.010, 30.0, 1.5e6, 0.2),
    "B3": CamSet(0.013, 0.009, 22.5, 1.6e6, 0.3),
    "B4": CamSet(0.013, 0.012, 22.5, 1.5e6, 0.09),
}
CLASSICAL = CamSet(0.013, 0.006, 90.0, 150e3, 0.03)
STIFFNESS = (5e6, 1e7, 5e7)  # K of the valve train, N/m; not printed
CRANK_RPM = 5000.0


def study(targets: Mapping[str, Target]) -> PaperResult:
    """Outcome of each value of the paper that can be computed, and the studies."""
    rows = [_figures(name, cam_set) for name, cam_set in SETS.items()]
    outcomes = {}
    for number, row in enumerate(rows, start=1):
        target = targets[f"P15-{number:02d}"]
        outcomes[target.id] = judged(
            target, row["shape_index_mean"],
            f"mean of eq. 6.18 over the rise; it never passes {row['shape_index_max']:.4f}, and "
            f"the mean of sin^2 of the pressure angle is {row['sin_squared_mean']:.4f}",
        )  # fmt: skip
    classical = ValveCam(CLASSICAL.motion, CLASSICAL.base_radius, module="C")
    phi = classical.rise()
    slope = classical.motion(phi, 1)
    flat = float(np.mean(slope**2 / classical.contour_radius_square(phi)))
    outcomes["P15-05"] = judged(
        targets["P15-05"], flat, "mean of (s'/r_A)^2 of the flat follower over the rise"
    )
    order = " < ".join(
        sorted(SETS, key=lambda name: rows[list(SETS).index(name)]["shape_index_mean"])
    )
    outcomes["P15-06"] = judged(
        targets["P15-06"],
        order,
        "order of the means of eq. 6.18; that of sin^2 is the printed one",
        published=" < ".join(SETS),
    )
    indices = {name: one.cam.shape_index(one.cam.rise(SHOWN)) for name, one in SETS.items()}
    drawn = (yields(targets, indices, rows),)
    return PaperResult(outcomes, _studies(rows), records(drawn))


def _figures(name: str, cam_set: CamSet) -> dict[str, Any]:
    cam, phi = cam_set.cam, cam_set.cam.rise()
    index, delta = cam.shape_index(phi), cam.pressure_angle(phi)
    pitch = PitchCurve(cam_set.motion.lift(), cam_set.base_radius + ROLLER)
    contour = RollerContour(pitch, ROLLER)
    theta = np.arange(2880) * (2.0 * np.pi / 2880)
    spring = Spring(rate=cam_set.rate, preload=cam_set.rate * cam_set.compression)
    system = FollowerSystem(TAPPET, spring, GUIDE_SPACING, OVERHANG, GUIDE_FRICTION, GUIDE_FRICTION)
    return {
        "set": name,
        "shape_index_mean": round(float(index.mean()), 4),
        "shape_index_max": round(float(index.max()), 4),
        "sin_squared_mean": round(float(np.mean(np.sin(delta) ** 2)), 4),
        "pressure_angle_max_deg": round(float(np.degrees(delta.max())), 1),
        "least_pitch_radius_mm": round(1e3 * contour.least_convex_pitch_radius().value, 2),
        "undercut": contour.undercut().present,
        "true_efficiency_of_rise": round(
            rise_efficiency(follower_loads(pitch, system, 0.0, theta)), 4
        ),
        "preload_N": spring.preload,
    }


def _studies(rows: list[dict[str, Any]]) -> dict[str, Any]:
    valve = CLASSICAL.motion
    speed = shaft_speed(CRANK_RPM)
    cams = {
        "C": ValveCam(valve, CLASSICAL.base_radius, module="C"),
        "B": ValveCam(valve, CLASSICAL.base_radius, ROLLER),
    }
    theta = np.linspace(0.0, 2.0 * np.pi, 1441)
    shaft = [
        {
            "module": name,
            "J_mean_kg_m2": cam.mean_reduced_inertia(),
            "speed_min_rad_per_s": float(cam.speed(theta, speed).min()),
            "speed_max_rad_per_s": float(cam.speed(theta, speed).max()),
            "angular_acceleration_max_rad_per_s2": float(
                np.abs(cam.angular_acceleration(theta, speed)).max()
            ),
        }
        for name, cam in cams.items()
    ]
    top, lifts = CLASSICAL.stroke, []
    for stiffness in STIFFNESS:
        train = ElasticValve(TAPPET, stiffness, CLASSICAL.rate, CLASSICAL.compression)
        lifts.append(
            {
                "K_N_per_m": stiffness,
                "deflection_printed_um": 1e6
                * (top - float(train.dynamic_lift(top, 0.0, speed, exact=False))),
                "deflection_quadratic_um": 1e6 * (top - float(train.dynamic_lift(top, 0.0, speed))),
                "deflection_quasi_static_um": 1e6 * (top - float(train.quasi_static(top))),
            }
        )
    return {
        "shape index (the paper's yield) beside the true efficiency; guides 0.05, assumed": rows,
        "speed over the turn by the reduced inertia (reconstructed), classical cam": shaft,
        "deflection at full lift (eq. 14 reconstructed; K is not printed)": lifts,
    }
