"""A plausible, synthetic run folder, so that the report can be tested without solving anything.

The numbers resemble a small engine's balancing cam (lift 33 mm, p0 500 to 1050 MPa) but come from
closed forms; the stress field is the half-plane Hertz field on two bodies.
"""

from __future__ import annotations

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import Delaunay

from camwright.geometry.periodic_spline import periodic_quintic
from camwright.pipeline.base.verdict import binding, verdict
from camwright.pipeline.case.scope_section import Scope
from camwright.pipeline.records.run_summary import SCHEMA
from camwright.pipeline.results import signoff
from camwright.pipeline.results.check_records import of_records
from camwright.pipeline.results.field_file import MeshBlock, field_file
from camwright.pipeline.results.run_reader import input_sha256
from camwright.pipeline.results.run_records import SPLINE

RATE, PRELOAD, PRIME_RADIUS, ROLLER, WIDTH = 24.2e3, 242.0, 0.050, 0.008, 0.0044
MODULUS, MASS, SPEED = 113.2e9, 0.175, 78.54
BORE, HUB = 0.010, 0.0025

TRIAL_POINTS = [
    {"trial": 1, "ripple_Nm": 3.4, "limit": "pressure_angle", "utilisation": 1.2, "passes": False},
    {"trial": 2, "ripple_Nm": 3.1, "limit": "jump", "utilisation": 0.97, "passes": True},
]
RIPPLE_MAP = {
    "load_case": "idle", "engine": "Working cycle solved at three speeds.",
    "crank_speed_rpm": [1500.0, 2500.0, 3600.0], "intake_pressure_kPa": [30.5, 101.3],
    "ratio": [[0.4, 0.5, 0.7], [0.8, 0.85, 0.9]],
    "ripple_before_Nm": [[6.0, 5.8, 5.7], [30.0, 29.0, 28.0]],
    "ripple_after_Nm": [[2.4, 2.9, 3.99], [24.0, 24.65, 25.2]],
}  # fmt: skip

CASE = """\
schema_version = 1
name = "gx120"
title = {title}
notes = {notes}

[mechanism]
gear_ratio = 2

[engine]
kind = "cylinder"
bore = "60 mm"
stroke = "42 mm"
rod_length = "80 mm"
source = "Cardoso et al. 2025, table 1"

[spring]
rate = "24.2 kN/m"
preload = "242 N"
travel_max = "45 mm"

[cam]
prime_radius = "50 mm"
offset = "0 mm"
width = "5 mm"
end = {{ kind = "sharp" }}
bore_radius = "10 mm"
material = "S355"

[roller]
radius = "8 mm"
width = "5 mm"
end = {{ kind = "chamfer", size = "0.3 mm" }}
hub_radius = "2.5 mm"
material = "100Cr6"

[roller.bearing]
name = "625-2RS"
C = "1.14 kN"
C0 = "0.38 kN"
source = "maker's catalogue, 2023"

[follower]
mass = "175 g"
stem_diameter = "10 mm"
overhang_at_max_lift = "30 mm"

[guides]
spacing = "80 mm"

[guides.a]
length = "20 mm"
diameter = "10 mm"
friction = 0.04
material = "nylon"
source = "Cardoso et al. 2025"

[guides.b]
length = "20 mm"
diameter = "10 mm"
friction = 0.20
material = "nylon"
source = "Cardoso et al. 2025"

[materials.S355]
E = "210 GPa"
nu = 0.3
yield_strength = "355 MPa"
density = "7850 kg/m^3"
condition = "as laser cut"
source = "EN 10025-2:2019, table 6"

[materials.100Cr6]
E = "206 GPa"
nu = 0.3
yield_strength = "1700 MPa"
density = "7810 kg/m^3"
condition = "through hardened"
source = "ISO 683-17"

[limits]
pressure_angle = "30 deg"
curvature_ratio = 1.5
torque_reduction = 0.4

[limits.sources]
pressure_angle = "Rothbart, Cam Design Handbook (2004), ch. 6"
curvature_ratio = "Norton, Cam Design and Manufacturing Handbook (2009)"

[solver]
positions = {positions}
max_trials = 6

[[load_case]]
name = {load_case}
speed = "1500 rpm"
"""


def turn(positions: int) -> dict[str, np.ndarray]:
    """Crank torque and the lift that stores its energy, by quadrature on a uniform turn."""
    crank = np.arange(positions) * 720.0 / positions
    phi = np.radians(crank)

    def bell(centre: float, width: float) -> np.ndarray:
        distance = (crank - centre + 360.0) % 720.0 - 360.0
        return np.exp(-((distance / width) ** 2))

    gas = 20.0 * bell(392, 40) - 9.0 * bell(322, 34) + 1.2 * bell(60, 60) - 1.6 * bell(640, 60)
    inertia = -2.6 * np.sin(2 * phi) + 0.5 * np.sin(phi)
    valves = 0.12 * np.sin(2.5 * phi) * np.sin(0.25 * phi) ** 2
    friction = np.full_like(phi, -1.4)
    total = gas + inertia + valves + friction
    theta = phi / 2
    step = 2 * np.pi / positions
    waves = np.fft.rfft(2 * (total - total.mean()))
    order = np.arange(waves.size)
    waves[1:] /= 1j * order[1:]
    waves[order > 9] = 0
    energy = np.fft.irfft(waves, positions)
    energy -= energy.min()
    peak = PRELOAD * 0.033 + RATE * 0.033**2 / 2
    energy *= peak / energy.max()
    lift = (np.sqrt(PRELOAD**2 + 2 * RATE * energy) - PRELOAD) / RATE

    def slope(values: np.ndarray) -> np.ndarray:
        return (
            8 * (np.roll(values, -1) - np.roll(values, 1))
            - np.roll(values, -2)
            + np.roll(values, 2)
        ) / (12 * step)

    d1 = slope(lift)
    d2 = slope(d1)
    return {
        "crank": crank, "theta": theta, "total": total, "gas": gas, "inertia": inertia,
        "valve_train": valves, "friction": friction,
        "lift": lift, "d1": d1, "d2": d2, "d3": slope(d2),
    }  # fmt: skip


def shape(t: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Pitch curve, contour and curvature of the synthetic lift."""
    rho, d1, d2, theta = PRIME_RADIUS + t["lift"], t["d1"], t["d2"], t["theta"]
    speed = np.hypot(rho, d1)
    kappa = (rho**2 + 2 * d1**2 - rho * d2) / speed**3
    alpha = np.arctan2(d1, rho)
    normal = np.array([np.cos(theta - alpha), np.sin(theta - alpha)])
    pitch = rho * np.array([np.cos(theta), np.sin(theta)])
    return {
        "pitch": pitch, "contour": pitch - ROLLER * normal, "normal": normal, "alpha": alpha,
        "kappa": kappa, "contour_radius": 1 / kappa - ROLLER, "factor": 1 - ROLLER * kappa,
    }  # fmt: skip


def cycle_columns(t: dict[str, np.ndarray], g: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The columns of 5_cycle.csv."""
    omega = SPEED
    spring = PRELOAD + RATE * t["lift"]
    inertia = MASS * omega**2 * t["d2"]
    axial = spring + inertia
    side = axial * np.tan(g["alpha"])
    normal = axial / np.cos(g["alpha"])
    overhang = 0.03 + t["lift"].max() - t["lift"]
    a, b = side * (overhang + 0.08) / 0.08, side * overhang / 0.08
    sign = np.sign(t["d1"])
    friction_a, friction_b = 0.04 * np.abs(a) * sign, 0.20 * np.abs(b) * sign
    radius = ROLLER * g["factor"]
    load = normal / WIDTH
    p0 = np.sqrt(load * MODULUS / (np.pi * radius))
    half = np.sqrt(4 * load * radius / (np.pi * MODULUS))
    off = 0.05 + 0.12 * np.cos(t["theta"] * 3) ** 2
    p0_fe = p0 * (1 + off / 100)
    after = (t["total"] - t["total"].mean()) - (axial + friction_a + friction_b) * t["d1"] / 2
    noise = 1e-12 * (1 + np.cos(7 * t["theta"]) ** 2)
    return {
        "cam_angle_deg": t["crank"] / 2, "crank_angle_deg": t["crank"],
        "lift_mm": t["lift"] * 1e3, "pressure_angle_deg": np.degrees(g["alpha"]),
        "pitch_radius_of_curvature_mm": 1e3 / g["kappa"],
        "contour_radius_of_curvature_mm": g["contour_radius"] * 1e3,
        "normal_force_N": normal, "line_load_N_per_mm": load / 1e3,
        "p0_hertz_MPa": p0 / 1e6, "p0_fe_MPa": p0_fe / 1e6, "p0_difference_percent": off,
        "half_width_hertz_mm": half * 1e3, "half_width_fe_mm": half * 1e3 * 0.999,
        "tau_max_MPa": 0.3026 * p0 / 1e6, "tau_depth_mm": 0.786 * half * 1e3,
        "von_mises_MPa": 0.5605 * p0 / 1e6, "von_mises_depth_mm": 0.7042 * half * 1e3,
        "guide_reaction_A_N": a * 0.985, "guide_reaction_B_N": b * 0.97,
        "guide_reaction_A_statics_N": a, "guide_reaction_B_statics_N": b,
        "spring_force_N": spring, "inertia_force_N": inertia, "axial_force_N": axial,
        "side_force_N": side, "guide_friction_A_N": friction_a, "guide_friction_B_N": friction_b,
        "jam_index": 0.13 * np.abs(np.tan(g["alpha"])),
        "follower_velocity_m_per_s": omega * t["d1"], "cam_torque_Nm": axial * t["d1"],
        "torque_before_Nm": t["total"] - t["total"].mean(), "torque_after_Nm": after,
        "residual_equilibrium": noise, "residual_complementarity": noise / 3,
        "residual_guide_force": noise / 5, "residual_guide_moment": noise / 2,
        "guide_edge_pressure_A_MPa": np.abs(a) / 20, "guide_edge_pressure_B_MPa": np.abs(b) / 10,
        "guide_normal_load_A_N": np.abs(a), "guide_normal_load_B_N": np.abs(b),
        "guide_friction_power_A_W": np.abs(friction_a * omega * t["d1"]),
        "guide_friction_power_B_W": np.abs(friction_b * omega * t["d1"]),
        "normal_force_friction_min_N": 0.97 * normal, "normal_force_friction_max_N": 1.03 * normal,
        "contact_force_elastic_stem_N": 1.001 * normal, "stem_shortening_um": normal / 150.0,
        "normal_force_statics_N": 0.995 * normal, "normal_force_by_length_N": 0.02 * normal,
        "normal_force_by_clearance_N": -0.015 * normal,
        "guide_reaction_by_length_N": -0.1 * b, "guide_reaction_by_clearance_N": 0.07 * b,
        "jam_index_statics": 0.12 * np.abs(np.tan(g["alpha"])),
        "jam_index_friction_max": 0.2 * np.abs(np.tan(g["alpha"])),
        "cam_speed_rad_per_s": omega * (1 + 0.01 * np.cos(t["crank"] * np.pi / 360)),
        "viscous_force_N": np.zeros_like(normal), "spring_surge_force_N": 0.01 * spring,
        "residual_friction": noise / 4,
        "key_pressure_MPa": axial * t["d1"] * 6.0, "shaft_bearing_load_1_N": 0.7 * normal,
        "shaft_bearing_load_2_N": 0.5 * normal, "spring_stress_MPa": 0.8 * spring,
        "ring_stress_amplitude_MPa": 0.7 * normal, "bore_pressure_MPa": normal / 85.0,
        "roller_speed_rpm": 5500.0 + 900.0 * np.cos(g["alpha"]),
        "roller_acceleration_rad_per_s2": 2e4 * np.sin(g["alpha"]),
        "traction_demand": 1e-3 * np.abs(np.tan(g["alpha"])), "creepage": 1e-4 * normal / 500.0,
        "film_thickness_um": 0.2 + 1e-4 * normal, "film_thickness_ratio": 0.5 + 1e-4 * normal,
    }  # fmt: skip


def check(**record: Any) -> dict[str, Any]:
    """One record of 6_checks.json, with defaults."""
    base = {
        "unit": "", "load_case": "idle", "cam_angle_deg": 192.0, "sense": "at_most", "note": "",
        "source": "Norton, Cam Design and Manufacturing Handbook (2009)", "must_have": True,
        "method": "closed form, refined between samples", "waiver": None, "status": "pass",
        "error": None, "corner": "", "corner_demand": None, "evidence": False, "judged_at": "",
        "waived_up_to": None, "not_proven": False,
    }  # fmt: skip
    return base | record


def checks() -> list[dict[str, Any]]:
    """Records covering every status."""
    return [
        check(id="closure", title="Closure of the lift", demand=2e-13, limit=1e-9, unit="m",
              utilisation=2e-4, cam_angle_deg=None),
        check(id="pressure_angle", title="Pressure angle", demand=44.9, limit=30.0, unit="deg",
              utilisation=1.497, status="fail", source="Rothbart, Cam Design Handbook (2004)"),
        check(id="curvature_ratio", title="Pitch radius of curvature over roller radius",
              demand=2.31, limit=1.5, unit="", utilisation=0.649, sense="at_least"),
        check(id="contact_pressure", title="Contact pressure, endurance", demand=None, limit=None,
              unit="MPa", utilisation=None, status="not_evaluated", must_have=False,
              note="no endurance data for S355", cam_angle_deg=None),
        check(id="shakedown", title="Elastic shakedown of the cam", demand=1046.0, limit=820.0,
              unit="MPa", utilisation=1.2756, status="fail", source="Johnson (1985), sec. 9.2"),
        check(id="roller_static", title="Static safety of the roller bearing", demand=0.3686,
              limit=1.0, unit="-", utilisation=2.713, status="fail", sense="at_least",
              source="s0 = C0/P0, ISO 76"),
        check(id="contact_force_margin", title="Least contact force", demand=-0.1, limit=0.2,
              unit="-", utilisation=None, status="fail", sense="at_least", must_have=False),
        check(id="guide_pv_B", title="PV value in guide B", demand=1.9, limit=0.1,
              unit="MPa m/s", utilisation=19.0, status="waived",
              waiver="J. Silva, 2026-01-15: prototype", waived_up_to=2.0),
        check(id="torque_reduction", title="Torque ripple removed", demand=0.53, limit=0.4,
              unit="", utilisation=0.755, sense="at_least", cam_angle_deg=None),
        check(id="jam_index", title="Jamming", demand=0.13, limit=0.5, unit="", utilisation=0.26),
    ]  # fmt: skip


def certificate(p0: float) -> list[dict[str, Any]]:
    """Certificate points in the shape of trial.json."""

    def figure(value: float, *errors: float) -> dict[str, Any]:
        return {
            "cycle": value * 1.0006, "meshes": [value * (1 + error) for error in errors],
            "extrapolated": value, "order": 1.93, "gci_percent": 0.0071,
        }  # fmt: skip

    points = []
    for number, angle in enumerate((0, 45, 96, 130, 181, 192, 250, 310)):
        level = p0 * (0.6 + 0.05 * number)
        points.append({
            "cam_angle_deg": float(angle), "p0_MPa": figure(level, 8e-4, 2.1e-4, 5.5e-5),
            "half_width_mm": figure(0.15, 2e-3, 6e-4, 2e-4),
            "tau_max_MPa": figure(0.3 * level, 8e-4, 2e-4, 5e-5),
            "von_mises_MPa": figure(0.56 * level, 8e-4, 2e-4, 5e-5),
            "p0_hertz_MPa": level * 0.999, "edges_across_half_width": [6.1, 9.2, 13.8],
            "dofs": [18233, 43120, 120411], "spread_percent": 0.06, "spread_of": "p0",
            "gci_percent": 0.0071, "gci_of": "p0",
            "residual_equilibrium": 3e-13, "residual_complementarity": 1e-13,
        })  # fmt: skip
    return points


def hertz_stress(x: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Von Mises stress over p0 under a Hertz line contact (lengths over the half-width).

    McEwen's formulas, Johnson, Contact Mechanics (1985), sec. 4.2(c); plane strain, nu = 0.3.
    """
    z = np.maximum(depth, 1e-9)
    part = 1 - x**2 + z**2
    root = np.sqrt(part**2 + 4 * x**2 * z**2)
    m = np.sqrt((root + part) / 2)
    n = np.sign(x) * np.sqrt(np.maximum((root - part) / 2, 0))
    common = (z**2 + n**2) / (m**2 + n**2)
    sx = -(m * (1 + common) - 2 * z)
    sz = -m * (1 - common)
    txz = n * (m**2 - z**2) / (m**2 + n**2)
    sy = 0.3 * (sx + sz)
    return np.sqrt(((sx - sz) ** 2 + (sz - sy) ** 2 + (sy - sx) ** 2) / 2 + 3 * txz**2)


def body_points(outline: np.ndarray, hole: np.ndarray, contact: np.ndarray, a: float) -> np.ndarray:
    """Points graded from the contact, inside `outline` and outside `hole` (all (2, n), m)."""
    from matplotlib.path import Path as Outline

    radii = a * np.concatenate([np.arange(0.12, 5.2, 0.12), 5.2 * 1.14 ** np.arange(1, 50)])
    counts = np.clip(6 * radii / (0.12 * a), 8, 64).astype(int)
    rings = [
        contact[:, None]
        + r * np.array([np.cos(t), np.sin(t)])
        for r, c in zip(radii, counts, strict=True)
        for t in [np.arange(c) * 2 * np.pi / c + 0.37 * r / a]
    ]  # fmt: skip
    cloud = np.concatenate([contact[:, None], *rings], axis=1)
    inside = Outline(outline.T).contains_points(cloud.T, radius=0.0)
    inside &= ~Outline(hole.T).contains_points(cloud.T)
    edge = np.min(np.hypot(*(cloud[:, :, None] - outline[:, None, ::4])), axis=1)
    near = np.hypot(*(cloud - contact[:, None]))
    inside &= edge > np.minimum(0.03 * near + 0.02 * a, 5e-4)
    return np.concatenate([cloud[:, inside], outline, hole], axis=1)


def arc(outline: np.ndarray, contact: np.ndarray, a: float) -> np.ndarray:
    """Points of a closed outline (2, n), refined near the contact by linear interpolation."""
    start = int(np.argmin(np.hypot(*(outline - contact[:, None]))))
    rolled = np.roll(outline, -start, axis=1)
    loop = np.concatenate([rolled, rolled[:, :1]], axis=1)
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(loop)))])
    fine = a * np.concatenate(
        [
            np.arange(0.12, 5.2, 0.12),
            5.2 * 1.14 ** np.arange(1, 25),
            np.arange(0.018, 0.4, 0.002) / a,
        ]
    )
    fine = fine[fine < length[-1] / 2]
    where = np.concatenate([[0.0], fine, length[-1] - fine[::-1]])
    return np.array([np.interp(where, length, row) for row in loop])


def write_field(
    path: Path, g: dict[str, np.ndarray], worst: int, cycle: dict[str, np.ndarray]
) -> None:
    """stress.vtkhdf: cam and roller at the worst angle, under the Hertz pressure."""
    p0, a = cycle["p0_hertz_MPa"][worst], cycle["half_width_hertz_mm"][worst] / 1e3
    normal, contact = g["normal"][:, worst], g["contour"][:, worst]
    centre = contact + ROLLER * normal
    angles = np.linspace(0, 2 * np.pi, 4000, endpoint=False) + np.arctan2(*-normal[::-1])
    ring = np.array([np.cos(angles), np.sin(angles)])
    bodies = {
        "cam": (arc(np.ascontiguousarray(g["contour"]), contact, a), BORE * ring[:, ::60], -normal),
        "roller": (arc(centre[:, None] + ROLLER * ring, contact, a),
                   centre[:, None] + HUB * ring[:, ::80], normal),
    }  # fmt: skip
    from matplotlib.path import Path as Outline

    blocks, stress = {}, {}
    for name, (outline, hole, inward) in bodies.items():
        cloud = body_points(outline, hole, contact, a)
        corners = Delaunay(cloud.T).simplices
        mid = cloud[:, corners].mean(axis=2)
        keep = Outline(outline.T).contains_points(mid.T)
        keep &= ~Outline(hole.T).contains_points(mid.T)
        away = cloud - contact[:, None]
        across = np.array([-inward[1], inward[0]])
        blocks[name] = MeshBlock(corners[keep].T.astype(np.int64), cloud.shape[1], cloud * 1e3)
        stress[name] = p0 * hertz_stress(across @ away / a, inward @ away / a)
    notes = {
        "cam_angle_deg": [cycle["cam_angle_deg"][worst]],
        "half_width_mm": [a * 1e3], "half_width_hertz_mm": [a * 1e3], "p0_hertz_MPa": [p0],
        "contact_x_mm": [contact[0] * 1e3], "contact_y_mm": [contact[1] * 1e3],
        "normal_x": [normal[0]], "normal_y": [normal[1]],
    }  # fmt: skip
    fields = {"displacement_mm": 3, "von_mises_MPa": 1}
    with field_file(path, [cycle["cam_angle_deg"][worst]], blocks, fields, notes) as file:
        for name, block in blocks.items():
            data = {
                "displacement_mm": np.zeros((1, block.nodes, 3)),
                "von_mises_MPa": stress[name][None],
            }
            file.write(name, 0, data, np.zeros((1, block.triangles.shape[1]), dtype=bool))


def quoted(text: str) -> str:
    """A TOML string."""
    return json.dumps(text, ensure_ascii=False)


def write_columns(
    path: Path, columns: dict[str, np.ndarray], load_cases: tuple[str, ...] = ()
) -> None:
    """A CSV of the columns, repeated per load case when there are any."""
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["load_case", *columns] if load_cases else list(columns))
        rows = list(zip(*(v.tolist() for v in columns.values()), strict=True))
        for load_case in load_cases or ("",):
            writer.writerows([load_case, *row] if load_cases else row for row in rows)


def write_run(
    folder: Path,
    positions: int = 720,
    title: str = "Honda GX120 balancing cam",
    notes: str = "As published.",
    load_case: str = "idle",
    records: list[dict[str, Any]] | None = None,
    field: bool = True,
    scope: dict[str, Any] | None = None,
) -> Path:
    """Write the whole run folder and return it."""
    t = turn(positions)
    g = shape(t)
    cycle = cycle_columns(t, g)
    records = checks() if records is None else records
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "fields").mkdir(exist_ok=True)
    text = CASE.format(
        title=quoted(title), notes=quoted(notes), positions=positions,
        load_case=quoted(load_case),
    )  # fmt: skip
    left_out = Scope.model_validate(scope or {})
    if scope:
        parts = quoted(scope["not_covered"])
        text += f"\n[scope]\nnot_covered = {parts}\nreason = {quoted(scope['reason'])}\n"
    (folder / "case.toml").write_text(text, encoding="utf-8")
    write_columns(folder / "1_torque.csv", {
        "crank_angle_deg": t["crank"], "total_Nm": t["total"], "gas_Nm": t["gas"],
        "inertia_Nm": t["inertia"], "valve_train_Nm": t["valve_train"],
        "friction_Nm": t["friction"],
    })  # fmt: skip
    wave = np.sin(np.radians(t["crank"]) / 2.0)
    write_columns(folder / "1_speed.csv", {
        "crank_angle_deg": t["crank"], "speed_before_rad_per_s": 157.0 - 4.0 * wave,
        "speed_inertia_alone_rad_per_s": 157.0 - 3.8 * wave,
        "speed_after_rad_per_s": 157.0 - 0.4 * wave,
    })  # fmt: skip
    worst = int(np.argmax(cycle["p0_fe_MPa"]))
    for number in (1, 2):
        trial = folder / f"trial_{number}"
        trial.mkdir(exist_ok=True)
        spline = periodic_quintic(t["lift"]).coefficients
        write_columns(trial / "2_spline.csv", {
            "cam_angle_deg": cycle["cam_angle_deg"],
            **dict(zip((column.header for column in SPLINE), spline, strict=True)),
        })  # fmt: skip
        write_columns(trial / "2_lift.csv", {
            "cam_angle_deg": cycle["cam_angle_deg"], "crank_angle_deg": t["crank"],
            "lift_mm": t["lift"] * 1e3, "lift_d1_mm_per_rad": t["d1"] * 1e3,
            "lift_d2_mm_per_rad2": t["d2"] * 1e3, "lift_d3_mm_per_rad3": t["d3"] * 1e3,
        })  # fmt: skip
        write_columns(trial / "3_contour.csv", {
            "cam_angle_deg": cycle["cam_angle_deg"],
            "pitch_x_mm": g["pitch"][0] * 1e3, "pitch_y_mm": g["pitch"][1] * 1e3,
            "contour_x_mm": g["contour"][0] * 1e3, "contour_y_mm": g["contour"][1] * 1e3,
            "normal_x": g["normal"][0], "normal_y": g["normal"][1],
            "pressure_angle_deg": cycle["pressure_angle_deg"],
            "pitch_radius_of_curvature_mm": cycle["pitch_radius_of_curvature_mm"],
            "contour_radius_of_curvature_mm": cycle["contour_radius_of_curvature_mm"],
        })  # fmt: skip
        write_columns(trial / "5_cycle.csv", cycle, (load_case,))
        (trial / "6_checks.json").write_text(json.dumps(records), encoding="utf-8")
        (trial / "trial.json").write_text(json.dumps({
            "number": number,
            "smoothing_kind": "moving_average", "smoothing_strength": float(number),
            "smoothing_description": f"moving average of {12 * number} values 5 deg apart",
            "smoothing_width_deg": 60.0 * number, "closure_mm": 2e-10,
            "table_step_deg": 0.0, "synthesis": None,
            "prices": None,
            "depth": "certified" if number == 2 else "cycle",
            "contact_method": "finite elements joined to the half-plane",
            "hertz_difference": {
                "p0": [0.05, 0.17], "cam": [0.01, 0.02], "ring of the roller": [0.02, 0.14],
                "rest": [0.01, 0.03],
            },
            "balance": {
                "mass_g": 280.0, "unbalance_g_mm": 900.0, "unbalance_angle_deg": 40.0,
                "residual_unbalance_g_mm": 1e-9, "hole_diameter_mm": 14.0, "hole_x_mm": 26.0,
                "hole_y_mm": 21.8, "hole_drilled": number == 2, "hole_note": "",
            },
            "why": "the smoothing the case asks for" if number == 1 else "pressure_angle fails",
            "mesh": {"cam_angle_deg": 263.0, "half_width_mm": 0.135,
                     "sha256": {"cam": "ab" * 32, "roller": "cd" * 32},
                     "min_angle_deg": 27.3, "min_scaled_jacobian": 0.61,
                     "edges_across_half_width": 10.2, "elements": 21033, "nodes": 42531},
            "certificate": certificate(float(cycle["p0_fe_MPa"].max())) if number == 2 else [],
        }))  # fmt: skip
    before, after = cycle["torque_before_Nm"], cycle["torque_after_Nm"]
    (folder / "run.json").write_text(json.dumps({
        "schema": SCHEMA, "case": "gx120", "input_sha256": input_sha256(folder),
        "versions": {"camwright": "0.1.0", "python": "3.11.9", "numpy": np.__version__},
        "timings_s": {"torque": 0.4, "lift": 0.1, "contour": 0.6, "mesh": 12.0, "cycle": 231.0,
                      "checks": 0.1, "report": 11.0, "total": 288.0},
        "statement": "no smoothing that keeps the torque reduction lets roller_static pass",
        "platform": "Linux x86_64", "prices": None, "machine_prices": None, "benchmarks": None,
        "speed": None, "consistency": [], "files": {},
        "trials": 2, "final_trial": 2, "trial_points": TRIAL_POINTS, "ripple_map": RIPPLE_MAP,
        "depth": "certified", "verdict": verdict(of_records(records)), "screen": None,
        "binding": list(binding(of_records(records))),
        "scope": left_out.as_record(),
        "headline": {
            "torque_std_before_Nm": float(before.std()), "torque_std_after_Nm": float(after.std()),
            "torque_p2p_before_Nm": float(np.ptp(before)),
            "torque_p2p_after_Nm": float(np.ptp(after)),
            "lift_max_mm": float(cycle["lift_mm"].max()),
            "pressure_angle_max_deg": float(np.abs(cycle["pressure_angle_deg"]).max()),
            "pitch_radius_of_curvature_min_mm": 18.5,
            "normal_force_min_N": float(cycle["normal_force_N"].min()),
            "normal_force_max_N": float(cycle["normal_force_N"].max()),
            "p0_max_MPa": float(cycle["p0_fe_MPa"].max()),
            "p0_hertz_max_MPa": float(cycle["p0_hertz_MPa"].max()),
            "half_width_max_mm": float(cycle["half_width_fe_mm"].max()),
            "von_mises_max_MPa": float(cycle["von_mises_MPa"].max()),
            "von_mises_depth_mm": 0.12, "follower_von_mises_max_MPa": 601.0,
            "follower_von_mises_depth_mm": 0.11, "ring_stress_max_MPa": 321.0,
            "guide_reaction_A_max_N": float(np.abs(cycle["guide_reaction_A_N"]).max()),
            "guide_reaction_B_max_N": float(np.abs(cycle["guide_reaction_B_N"]).max()),
            "friction_loss_J_per_cam_turn": 3.1, "p0_difference_max_percent": 0.17,
            "residual_equilibrium_max": 2e-12,
        },
    }))  # fmt: skip
    if field:
        write_field(folder / "fields" / "stress.vtkhdf", g, worst, cycle)
    signoff.write(folder)
    return folder


def page_of(folder: Path) -> Path:
    """The page of a run folder, drawn with everything else that a report has."""
    from camwright.reports import sections

    return sections.report(folder)["page"][0]
