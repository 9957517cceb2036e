"""A measured cam: known errors come back, and the real part runs as theory says."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from record_validation import schema_errors

sys.path.insert(0, str(Path(__file__).parents[1] / "unit"))
import small_run
from small_machine import small_machine

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.errors import InputError, ResultError
from camwright.geometry.lift import Lift
from camwright.geometry.measured_contour import inspected, real_contour
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.base.tables import read_table
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import parse_case, read_case
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.machine import machines
from camwright.pipeline.contact.closed_form import closed_form_history
from camwright.pipeline.cycle.contact_setup import contact_pair
from camwright.pipeline.cycle.solution import turns_of
from camwright.pipeline.results import run_reader
from camwright.pipeline.results.drawn_cam import drawn_cam
from camwright.pipeline.results.run_folder import RunFolder
from camwright.pipeline.results.run_records import contour_columns, lift_columns, spline_columns
from camwright.pipeline.results.workshop_files import contour_table, inspection_sheet
from camwright.pipeline.studies.cam_inspection import FOLDER, lines, read_measured

FLAT_CASE = Path(__file__).parents[2] / "cases" / "papers" / "petrescu_c.toml"
THETA = uniform_turn(360)
RIPPLE, WAVES, PHASE = 20e-6, 12, np.radians(3.0)
POINTS = np.sort(np.random.default_rng(7).uniform(0, 2 * np.pi, 720))


def contour() -> Contour:
    lift = Lift(THETA, 0.005 * (1 - np.cos(2 * THETA - 0.3)) + 0.001 * (1 + np.sin(3 * THETA)))
    return RollerContour(PitchCurve(lift, 0.050), 0.008)


def turned(points: np.ndarray, angle: float) -> np.ndarray:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([[cos, -sin], [sin, cos]]) @ points


def measured(
    nominal: Contour, ripple: float = RIPPLE, phase: float = PHASE, size: float = 0.0
) -> np.ndarray:
    """Surface points of a part with a known wave, phase and size."""
    error = size + ripple * np.cos(WAVES * POINTS + 0.4)
    return turned(nominal.points(POINTS) + error * nominal.normal(POINTS), phase)


def test_ripple_and_phase_are_recovered() -> None:
    found = inspected(contour(), measured(contour()))
    assert found.wave(WAVES) == pytest.approx(RIPPLE, rel=1e-5)
    assert found.phase == pytest.approx(PHASE, rel=3e-3)
    others = [found.wave(k) for k in range(1, len(found.cosine)) if k != WAVES]
    # the wave and the few lobes of this lift see a little of each other
    assert max(others) < 0.05 * RIPPLE


@pytest.mark.parametrize("phase", [-2.5, -0.01, 0.7, 3.1])
def test_any_phase_and_size_is_recovered_to_a_tenth_of_a_micrometre(phase: float) -> None:
    found = inspected(contour(), measured(contour(), 0.0, phase, 50e-6))
    assert found.phase == pytest.approx(phase, abs=1e-6)
    assert found.size == pytest.approx(50e-6, abs=1e-7)
    # a part the same amount too large everywhere
    np.testing.assert_allclose(found.deviation, 50e-6, atol=1e-7)


def test_noise_of_the_probe_is_scatter_and_not_form() -> None:
    noise = np.random.default_rng(3).normal(0.0, 1e-6, (2, POINTS.size))
    found = inspected(contour(), measured(contour()) + noise)
    # each harmonic takes a cosine and a sine off the noise; 3 % is the standard error of the rest
    left = 1.0 - 2 * len(found.cosine) / POINTS.size
    assert found.scatter == pytest.approx(1e-6 * np.sqrt(left), rel=0.03)
    # three standard errors of an amplitude, sqrt(2 / 720) of the noise
    assert found.wave(WAVES) == pytest.approx(RIPPLE, rel=8e-3)


def test_nominal_part_runs_like_the_drawing() -> None:
    nominal = contour()
    real = real_contour(nominal, inspected(nominal, measured(nominal, 0.0)))
    theta = uniform_turn(720)
    np.testing.assert_allclose(
        np.hypot(*real.pitch.points(theta)), np.hypot(*nominal.pitch.points(theta)), atol=1e-8
    )
    # by way of two derivatives: a tenth of a per cent of the lift's own
    second = nominal.pitch.lift(theta, 2)
    np.testing.assert_allclose(real.pitch.lift(theta, 2), second, atol=2e-3 * np.abs(second).max())


def test_kept_phase_turns_the_lift() -> None:
    nominal = contour()
    found = inspected(nominal, measured(nominal, 0.0))
    real = real_contour(nominal, found, keep_phase=True)
    np.testing.assert_allclose(
        np.hypot(*real.pitch.points(THETA + PHASE)),
        np.hypot(*nominal.pitch.points(THETA)),
        atol=1e-8,
    )


def small_case(positions: int = 180) -> Case:
    text = small_machine("part").replace("certificate_positions = 8", "certificate_positions = 1")
    return parse_case(text).with_positions(positions)


def test_rise_of_force_and_pressure_is_that_of_theory() -> None:
    """A round cam with a ripple: F = P + k e + m w^2 e'', and Hertz with the wave's curvature."""
    case, theta = small_case(), uniform_turn(720)
    base, roller = case.cam.prime_radius, case.roller.radius
    flat = RollerContour(PitchCurve(Lift(theta, np.zeros(720)), base), roller)
    error = RIPPLE * np.cos(WAVES * POINTS)
    points = flat.points(POINTS) + error * flat.normal(POINTS)
    # a circle has no phase of its own: the part is compared as it lies
    mark = 1e-3 * np.exp(-(((THETA - np.pi) / 0.15) ** 2))
    nominal = RollerContour(PitchCurve(Lift(THETA, mark), base), roller)
    points = nominal.points(POINTS) + error * nominal.normal(POINTS)
    real = real_contour(nominal, inspected(nominal, points))
    speed = case.load_cases[0].speed / case.mechanism.gear_ratio
    states = machines(case)
    drawn, run = (turns_of(states, made, 720)[0] for made in (nominal, real))
    away = np.cos(theta) > 0.2  # far from the mark the cam is round
    # the roller's centre sees the wave of the surface a little finer than the surface itself
    surface = base - roller
    seen = RIPPLE * np.cos(WAVES * theta)
    rise = case.spring.rate * (seen - seen.min()) - case.follower.mass * speed**2 * WAVES**2 * seen
    got = (run.loads.axial_force - drawn.loads.axial_force)[away]
    swing = case.follower.mass * speed**2 * WAVES**2 * RIPPLE
    assert swing > 1.0  # N, or there is nothing to see
    assert np.ptp(got) == pytest.approx(np.ptp(rise[away]), rel=2e-3)
    assert np.abs(got - rise[away]).max() < 0.1 * np.ptp(rise)
    # pressure: Hertz on the curvature of a circle with a wave, crest and hollow
    pair = contact_pair(run.machine, real)
    contact = closed_form_history(pair, theta, run.loads.normal_force)
    crest = 1 / surface + RIPPLE * (WAVES**2 - 1) / surface**2 * np.cos(WAVES * theta)
    load = run.loads.normal_force / pair.width
    p0 = np.sqrt(load * pair.contact_modulus * (crest + 1 / roller) / np.pi)
    np.testing.assert_allclose(contact.p0[away], p0[away], rtol=5e-3)


def write_run(folder: Path, case: Case, lift: Lift, **record: object) -> Contour:
    """A run folder whose tables are those of a given lift, at little cost; its contour."""
    made = case.contour(lift)
    with RunFolder(folder, case) as out:
        out.write("2_spline.csv", spline_columns(lift), 1)
        out.write("2_lift.csv", lift_columns(case, lift), 1)
        out.write("3_contour.csv", contour_columns(case, made), 1)
        cycle = {k: np.abs(v) if v.dtype.kind == "f" else v
                 for k, v in small_run.values(small_run.CYCLE).items()}  # fmt: skip
        out.write("5_cycle.csv", cycle, 1)
        out.write("6_checks.json", [small_run.check()], 1)
        out.write("trial.json", {**small_run.TRIAL, **record}, 1)
        out.finish({**small_run.summary(), "scope": case.scope.as_record()})
    return made


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Case, Contour]:
    folder, case = tmp_path_factory.mktemp("inspect") / "run", small_case(72)
    return folder, case, write_run(folder, case, Lift(THETA, 0.005 * (1 - np.cos(THETA))))


def rolled(positions: int) -> tuple[Case, Lift]:
    """A roller cam with a dwell and a double harmonic rise within 90 degrees."""
    s = np.clip(THETA / (np.pi / 2), 0.0, 1.0) * np.clip((2 * np.pi - THETA) / np.pi, 0.0, 1.0)
    return small_case(positions), Lift(THETA, 0.010 * s**3 * (10 - 15 * s + 6 * s**2))


def slid(positions: int) -> tuple[Case, Lift]:
    case = read_case(FLAT_CASE).with_positions(positions)
    return case, given_lift(case)


@pytest.mark.parametrize("kind", [rolled, slid])
@pytest.mark.parametrize("positions", [36, 72, 360, 720])
def test_part_of_its_own_contour_table_has_no_deviation(
    kind: Callable[[int], tuple[Case, Lift]], positions: int, tmp_path: Path
) -> None:
    """The nominal contour does not depend on the number of positions of the cycle.

    0.1 um is a thousandth of a profile tolerance and over a thousand times the last digit of the
    table.
    """
    case, lift = kind(positions)
    made = write_run(tmp_path / "run", case, lift)
    table = tmp_path / "contour.csv"
    table.write_text(contour_table(made, case.workshop_order.theta), encoding="utf-8")
    points = read_measured(table, made)
    drawn = drawn_cam(tmp_path / "run")[1]
    assert np.abs(inspected(drawn, points).deviation).max() <= 1e-7
    noise = np.random.default_rng(positions).normal(0.0, 3e-6, points.shape[1])
    found = inspected(drawn, points + noise * made.normal(case.workshop_order.theta))
    # the fitted phase takes a part of the noise: an angle of a few of its standard errors
    np.testing.assert_allclose(found.deviation, noise, atol=1.5e-6)
    assert found.deviation.std() == pytest.approx(noise.std(), rel=5e-3)


def test_drawn_cam_has_the_spring_and_the_radius_of_its_synthesis(tmp_path: Path) -> None:
    case, lift = rolled(72)
    free = ("prime_radius", "spring_rate", "preload")
    ranges = {f"{name}_range": (0.5 * value, 2.0 * value) for name, value in (
        ("prime_radius", case.cam.prime_radius), ("spring_rate", case.spring.rate),
        ("preload", case.spring.preload),
    )}  # fmt: skip
    smoothing = case.smoothing.model_copy(update={"free": free, **ranges})
    freed = case.model_copy(update={"smoothing": smoothing})
    design = {"spring_rate_N_per_mm": 21.5, "preload_N": 310.0, "prime_radius_mm": 51.25}
    write_run(tmp_path / "run", freed, lift, synthesis=design)
    drawn, contour = drawn_cam(tmp_path / "run")
    assert drawn.spring.rate == pytest.approx(21.5e3, rel=1e-15)
    assert drawn.spring.preload == 310.0
    assert contour.pitch.radius_base == pytest.approx(51.25e-3, rel=1e-15)
    np.testing.assert_array_equal(contour.lift.values, lift.values)


def test_spline_with_a_changed_coefficient_is_refused(tmp_path: Path) -> None:
    write_run(tmp_path / "run", *rolled(72))
    file = tmp_path / "run" / "trial_1" / "2_spline.csv"
    rows = file.read_text(encoding="utf-8").splitlines()
    cells = rows[20].split(",")
    cells[3] = repr(float(cells[3]) + 1e-6)
    file.write_text("\n".join([*rows[:20], ",".join(cells), *rows[21:]]) + "\n", encoding="utf-8")
    with pytest.raises(ResultError, match="not those of a C4 spline"):
        drawn_cam(tmp_path / "run")


@pytest.mark.parametrize("kind", [rolled, slid])
def test_a_part_measured_by_its_lift_is_the_part_measured_on_its_surface(
    kind: Callable[[int], tuple[Case, Lift]], tmp_path: Path
) -> None:
    """The lift of a turned and waved part gives its phase and deviation back.

    The points lie elsewhere and weigh the wave against the phase otherwise: 0.005 deg, 0.4 um.
    """
    case, lift = kind(72)
    drawn = case.contour(lift)
    error = 5e-6 * np.cos(5 * POINTS + 0.4)
    points = turned(drawn.points(POINTS) + error * drawn.normal(POINTS), np.radians(0.2))
    by_surface = inspected(drawn, points)
    real = real_contour(drawn, by_surface, keep_phase=True)
    heights = real.pitch.height_base - drawn.pitch.height_base + real.lift(THETA)
    table = tmp_path / "lift.csv"
    rows = zip(np.degrees(THETA).tolist(), (1e3 * heights).tolist(), strict=True)
    table.write_text("cam_angle_deg,lift_mm\n" + "".join(f"{a!r},{s!r}\n" for a, s in rows))
    by_lift = inspected(drawn, read_measured(table, drawn))
    assert by_lift.phase == pytest.approx(by_surface.phase, abs=1e-4)
    np.testing.assert_allclose(by_lift.form(THETA), by_surface.form(THETA), atol=4e-7)


def test_command_judges_the_real_part(run, tmp_path: Path, capsys) -> None:
    from camwright.pipeline.cli import run_line
    from camwright.pipeline.commands.terminal import EXIT_CODE

    folder, _, made = run
    x, y = measured(made) * 1e3
    table = tmp_path / "measured.csv"
    rows = "".join(f"{a!r},{b!r}\n" for a, b in zip(x.tolist(), y.tolist(), strict=True))
    table.write_text("x_mm,y_mm\n" + rows, encoding="utf-8")
    arguments = ["inspect", str(folder), str(table), "--jobs", "1", "--tolerance", "20 um"]
    code = run_line(arguments)
    record = json.loads((folder / FOLDER / "inspection.json").read_text(encoding="utf-8"))
    assert schema_errors("inspect", record) == []
    assert code == EXIT_CODE[record["verdict"]]
    assert record["phase_deg"] == pytest.approx(3.0, rel=0.015)
    assert record["waves_um"]["12"] == pytest.approx(20.0, rel=1e-5)
    assert not record["within_tolerance"]
    assert (folder / FOLDER / "deviation.png").read_bytes()[:4] == b"\x89PNG"
    cycle = read_table(folder / FOLDER / "cycle.csv").of_load_case("idle")
    # twelve crests a turn press harder than the drawing: Hertz and the finite elements agree on it
    np.testing.assert_allclose(cycle["p0_fe_MPa"], cycle["p0_hertz_MPa"], rtol=0.02)
    theta = np.radians(cycle["cam_angle_deg"])
    case = small_case(72)
    drawn = turns_of(machines(case), made, 72)[0].loads.normal_force
    rise = np.fft.rfft(cycle["normal_force_N"] - drawn) / (theta.size / 2)
    speed = case.load_cases[0].speed / case.mechanism.gear_ratio
    swing = RIPPLE * (case.spring.rate - case.follower.mass * (speed * WAVES) ** 2)
    assert abs(rise[WAVES]) == pytest.approx(abs(swing), rel=0.01)
    assert record["tolerance_um"] == pytest.approx(20.0)  # of the inspection sheet
    checks = json.loads((folder / FOLDER / "checks.json").read_text(encoding="utf-8"))
    assert "certificate" in " ".join(check["id"] + check["method"] for check in checks)
    words = record["verdict"].upper()
    assert any(line.startswith(f"verdict on the measured cam: {words}") for line in lines(record))
    assert record["scope"]["statement"] == ""
    assert run_reader.read_run(folder).verdict == "pass"  # the run itself is left as it was


def test_filled_sheet_reads_back(tmp_path: Path) -> None:
    sheet = inspection_sheet(contour(), THETA, 20e-6).splitlines()
    filled = [sheet[0]]
    for row in sheet[1:-5]:  # five points were not measured
        cells = row.split(",")
        filled.append(",".join([*cells[:9], cells[3], cells[4], ""]))
    path = tmp_path / "sheet.csv"
    path.write_text("\n".join([*filled, *sheet[-5:]]) + "\n", encoding="utf-8")
    np.testing.assert_allclose(
        read_measured(path, contour()), contour().points(THETA[:-5]), rtol=0, atol=1e-15
    )


def test_a_sheet_saved_by_an_office_program_of_another_language_reads_back(tmp_path: Path) -> None:
    path = tmp_path / "sheet.csv"
    rows = [f"{x:.6f};{y:.6f}".replace(".", ",") for x, y in 1e3 * contour().points(THETA).T]
    path.write_text("\ufeffx_mm;y_mm\n" + "\r\n".join(rows), encoding="utf-8")
    np.testing.assert_allclose(read_measured(path, contour()), contour().points(THETA), atol=1e-9)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("", "an empty file"),
        ('"' + "x" * 200_000 + "\n1,2\n", "header"),
        ("a,b\n1,2\n", "x_mm"),
        ("x_mm,y_mm\n1,nan\n", "line 2"),
        ("x_mm,y_mm\n1,inf\n", "line 2"),
        ("x_mm,y_mm\n1,two\n", "line 2"),
    ],
)
def test_bad_tables_are_refused(text: str, named: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=named):
        read_measured(path, contour())


def test_few_points_a_gap_and_a_missing_file_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="n >= 48"):
        inspected(contour(), contour().polygon(47))
    with pytest.raises(InputError, match="gap"):
        inspected(contour(), contour().polygon(720)[:, 80:])
    with pytest.raises(InputError, match="no such file"):
        read_measured(tmp_path / "none.csv", contour())
