"""`check --recompute`: a run follows from its case and lift; what was forged is named."""

from __future__ import annotations

import io
import json
import re
import resource
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from drawn_run import drawn_run
from PIL import Image
from test_run import small

from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import files_in, npz_bytes, sha256_of
from camwright.pipeline.base.verdict import binding, governing_id
from camwright.pipeline.case.case_file import read_case, with_values
from camwright.pipeline.commands import check_command
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.recomputation import MOST_ANGLES, Recomputation
from camwright.pipeline.results import check_records, run_reader, signoff
from camwright.pipeline.results.file_differences import Kind, Origin, classes_of
from camwright.pipeline.run import run_case
from camwright.reports.sections import PARTS, report

Command = Callable[..., tuple[int, str, str]]
TRIAL = "trial_1"
ROOT = Path(__file__).resolve().parents[2]


def signed_anew(run: Path) -> None:
    """Every hash of a forged folder written anew, as the product writes it."""
    file = run / "run.json"
    said = json.loads(file.read_text())
    said["files"] = {name: sha256_of(run / name) for name in said["files"] if (run / name).exists()}
    said["input_sha256"] = run_reader.input_sha256(run)
    file.write_text(json.dumps(said))
    signoff.write(run)


def column_scaled(name: str, header: str, factor: float) -> Callable[[Path], None]:
    """All values of a column of a table changed, the others to the byte as before."""

    def forge(run: Path) -> None:
        rows = (run / name).read_text().splitlines()
        k = rows[0].split(",").index(header)
        for number, row in enumerate(rows[1:], start=1):
            cells = row.split(",")
            cells[k] = repr(float(cells[k]) * factor) if cells[k] else ""
            rows[number] = ",".join(cells)
        (run / name).write_text("\n".join(rows) + "\n")

    return forge


def check_changed(
    which: Callable[[dict[str, Any]], bool], **changes: Any
) -> Callable[[Path], None]:
    def forge(run: Path) -> None:
        file = run / TRIAL / "6_checks.json"
        records = json.loads(file.read_text())
        one = next(record for record in records if which(record))
        one |= {key: value(one) if callable(value) else value for key, value in changes.items()}
        file.write_text(json.dumps(records))
        judged_anew(run, records)

    return forge


def judged_anew(run: Path, records: Any) -> None:
    file = run / "run.json"
    said = json.loads(file.read_text())
    judged = check_records.judgement(records, said["depth"])
    said |= {"verdict": judged["verdict"], "screen": judged["screen"]}
    said["binding"] = list(binding(check_records.of_records(records)))
    said["governing"] = governing_id(check_records.of_records(records))
    file.write_text(json.dumps(said))


def all_limits_raised(run: Path) -> None:
    """Every failed check turned into a pass: the ten-line script."""
    file = run / TRIAL / "6_checks.json"
    records = json.loads(file.read_text())
    for one in records:
        if one["status"] == "fail" and one["demand"] is not None:
            worst = one["demand"] if one["corner_demand"] is None else one["corner_demand"]
            far = 10.0 * abs(worst) + 1.0
            limit = worst - far if one["sense"] == "at_least" else worst + far
            one |= {"limit": limit, "status": "pass", "utilisation": 0.1, "not_proven": False}
    file.write_text(json.dumps(records))
    judged_anew(run, records)


def entry_changed(name: str, *path: str | int, value: Any) -> Callable[[Path], None]:
    def forge(run: Path) -> None:
        document = inside = json.loads((run / name).read_text())
        for key in path[:-1]:
            inside = inside[key]
        inside[path[-1]] = value
        (run / name).write_text(json.dumps(document))

    return forge


def array_scaled(name: str, key: str) -> Callable[[Path], None]:
    def forge(run: Path) -> None:
        with np.load(run / name) as stored:
            arrays = {each: stored[each] for each in stored.files}
        arrays[key] = 0.9 * arrays[key]
        (run / name).write_bytes(npz_bytes(arrays))

    return forge


def case_replaced(old: str, new: str) -> Callable[[Path], None]:
    """Another case under the old results."""

    def forge(run: Path) -> None:
        text = (run / "case.toml").read_text()
        assert text.count(old) >= 1, old
        (run / "case.toml").write_text(text.replace(old, new, 1))

    return forge


def page_edited(run: Path) -> None:
    page = run / "8_report.html"
    page.write_text(page.read_text().replace("FAIL", "PASS"))


def recomputed(run: Path, **options: Any) -> Recomputation:
    return check_command.recomputed(run, jobs=1, **({"angles": 0} | options))


# --- a screening: a second each


@pytest.fixture(scope="module")
def quick(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A screening of the shortest shipped case, with a limit that it exceeds."""
    out = tmp_path_factory.mktemp("quick") / "run"
    case = read_case(ROOT / "cases" / "papers" / "eccentric.toml").with_positions(36)
    case = with_values(case, {"limits.pressure_angle": "1 deg"})
    run_case(case, out, depth=Tier.SCREENING, jobs=1)
    return out


def test_a_screen_is_what_its_case_gives(quick: Path) -> None:
    made = recomputed(quick)
    assert made.differences == made.angles == ()
    assert made.judged["screen"] == json.loads((quick / "run.json").read_text())["screen"]


def test_forged_numbers_of_a_screen_are_named(
    quick: Path, tmp_path: Path, command: Command
) -> None:
    """Several forgeries at once, each found by its file."""
    run = Path(shutil.copytree(quick, tmp_path / "run"))
    all_limits_raised(run)
    column_scaled(f"{TRIAL}/5_cycle.csv", "normal_force_N", 0.99)(run)
    column_scaled(f"{TRIAL}/3_contour.csv", "contour_x_mm", 1.0001)(run)
    entry_changed("run.json", "headline", "lift_max_mm", value=1.0)(run)
    signed_anew(run)
    assert signoff.changes(run) == []  # hashes say nothing
    code, out, err = command("check", run, "--recompute", "--angles", "2", "--seed", "7")
    assert (code, out) == (4, "")
    assert "recomputation with --seed 7" in err
    for name in (
        f"{TRIAL}/6_checks.json: ", f"{TRIAL}/5_cycle.csv: normal_force_N at ",
        f"{TRIAL}/3_contour.csv: contour_x_mm at ",
        "run.json: headline.lift_max_mm = 1, recomputed ",
    ):  # fmt: skip
        assert f"camwright: {run}/{name}" in err


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"angles": -1}, "--angles = -1, must be >= 0 and <= 360"),
        ({"angles": MOST_ANGLES + 1}, "--angles = 361"),
        ({"seed": -1}, "--seed = -1, must be >= 0"),
    ],
)
def test_options_out_of_bounds_are_refused(
    quick: Path, options: dict[str, int], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        recomputed(quick, **options)


@pytest.mark.parametrize(
    ("key", "value", "message"),
    [
        ("number", 7, "trial.json: number = 7, recomputed 1"),
        ("smoothing_strength", 0.5, "smoothing_strength = 0.5, recomputed None"),
        ("closure_mm", 1.0, "trial.json: closure_mm = 1 mm, recomputed 0 mm"),
        ("table_step_deg", 2.0, "trial.json: table_step_deg = 2 deg, recomputed "),
        ("synthesis", {"feasible": True}, "trial.json|synthesis"),
    ],
)
def test_a_hostile_record_is_named(
    quick: Path, tmp_path: Path, command: Command, key: str, value: object, message: str
) -> None:
    run = Path(shutil.copytree(quick, tmp_path / "run"))
    entry_changed(f"{TRIAL}/trial.json", key, value=value)(run)
    signed_anew(run)
    code, _, err = command("check", run, "--recompute", "--angles", "0")
    assert code == 4
    assert re.search(message, err), err
    assert not list(tmp_path.rglob("escaped*"))


def test_options_without_recomputation_are_refused(quick: Path, command: Command) -> None:
    for arguments in (("--seed", "1"), ("--angles", "2")):
        code, _, err = command("check", quick, *arguments)
        assert code == 2 and "must be stated with --recompute" in err
    code, _, err = command("check", quick, quick, "--recompute")
    assert code == 2 and "stated with one run" in err


# --- a certified run, every attack


@pytest.fixture(scope="module")
def certified(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("certified")
    drawn_run(small(folder), folder / "run", jobs=1)
    return folder / "run"


@pytest.mark.slow
def test_a_certified_run_is_what_its_case_gives(certified: Path, command: Command) -> None:
    made = recomputed(certified, angles=3, seed=1)
    assert made.differences == ()
    assert len(made.angles) == 3
    for angle in made.angles:
        assert 0.0 < angle.difference < angle.allowed < 0.02
    assert made.versions == ()
    assert set(made.unseen) <= {
        f"{TRIAL}/trial.json: why", f"{TRIAL}/6_checks.json: remedy",
        *(f"run.json: {key}"
          for key in ("started", "statement", "timings_s", "trial_points", "trials")),
    }  # fmt: skip
    code, out, err = command("check", certified, "--recompute", "--angles", "3")
    assert code == command("check", certified)[0]
    assert f"recomputed: {made.judged['verdict_line']}" in err and "verdict: " in out
    drawn = re.findall(r"drawn angle: (.*)", err)
    assert len(drawn) == 3
    assert drawn != [angle.words for angle in made.angles]  # by another seed
    assert re.search(r"recomputation with --seed \d+", err)


def first_check_deleted(run: Path) -> None:
    file = run / TRIAL / "6_checks.json"
    records = json.loads(file.read_text())
    del records[-1]
    file.write_text(json.dumps(records))


def deleted(run: Path) -> None:
    (run / TRIAL / "5_guides.npz").unlink()


FORGED: tuple[tuple[Callable[[Path], None], str], ...] = (
    (all_limits_raised, r"6_checks\.json: [a-z_]+: limit = "),
    (check_changed(lambda c: c["id"] == "contact_pressure", demand=lambda c: 0.5 * c["demand"]),
     r"6_checks\.json: contact_pressure: demand = "),
    (first_check_deleted, r"6_checks\.json: [a-z_0-9]+ is missing"),
    (column_scaled(f"{TRIAL}/5_cycle.csv", "p0_fe_MPa", 1.03), r"5_cycle\.csv: p0_fe_MPa at "),
    (column_scaled("1_torque.csv", "total_Nm", 0.99), r"1_torque\.csv: total_Nm "),
    (column_scaled(f"{TRIAL}/5_speed_sweep.csv", "torque_max_Nm", 0.99),
     r"5_speed_sweep\.csv: torque_max_Nm in row"),
    (column_scaled(f"{TRIAL}/2_lift.csv", "lift_mm", 0.999), r"2_lift\.csv: lift_mm at "),
    (array_scaled(f"{TRIAL}/5_pressure.npz", "contact_pressure_MPa"),
     r"5_pressure\.npz: contact_pressure_MPa"),
    (entry_changed(f"{TRIAL}/trial.json", "certificate", 0, "gci_percent", value=0.0),
     r"trial\.json: certificate\[0\]\.gci_percent = 0, recomputed "),
    (entry_changed("run.json", "headline", "p0_max_MPa", value=1.0),
     r"run\.json: headline\.p0_max_MPa = 1, recomputed "),
    (page_edited, r"8_report\.html: '"),
    (deleted, r"5_guides\.npz: is missing"),
)  # fmt: skip


@pytest.mark.slow
def test_checking_a_run_takes_little_time(certified: Path) -> None:
    """At most 1.5 s of processor time, start of the program and imports included."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    result = subprocess.run([sys.executable, "-m", "camwright", "check", certified], check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert result.returncode in (0, 1, 3)
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime <= 1.5


@pytest.mark.slow
def test_forged_files_are_named_though_their_hashes_agree(
    certified: Path, tmp_path: Path, command: Command
) -> None:
    run = Path(shutil.copytree(certified, tmp_path / "run"))
    for forge, _ in FORGED:
        forge(run)
    signed_anew(run)
    code, _, err = command("check", run, "--recompute", "--angles", "2", "--seed", "3")
    assert code == 4
    for _, message in FORGED:
        assert re.search(message, err), f"{message}: {err}"
    for words in re.findall(r"drawn angle: .*", err):
        assert "p0 differs by 3" in words or "p0 differs by 2.9" in words
    assert len(re.findall(r"5_cycle\.csv: .* deg: p0 differs by", err)) == 2


# --- every file of a run


def forged(file: Path, kind: Kind) -> None:
    """One thing changed in a file, as little as a reader would see."""
    content = file.read_bytes()
    if kind is Kind.TABLE:
        header, *rows = file.read_text().splitlines()
        last = rows[-1].split(",")
        k = max(i for i, cell in enumerate(last) if re.fullmatch(r"-?\d+\.\d*[1-9]\d*", cell))
        last[k] = repr(2.0 * float(last[k]))
        file.write_text("\n".join([header, *rows[:-1], ",".join(last)]) + "\n")
    elif kind is Kind.RECORD:
        document = json.loads(content)
        (document[0] if isinstance(document, list) else document)["approved"] = "by A. N. Other"
        file.write_text(json.dumps(document))
    elif kind is Kind.ARRAYS:
        with np.load(file) as stored:
            arrays = {name: stored[name] for name in stored.files}
        name = next(n for n, values in arrays.items() if values.dtype.kind == "f" and values.any())
        file.write_bytes(npz_bytes(arrays | {name: 1.001 * arrays[name]}))
    elif kind is Kind.FIELD:
        with h5py.File(file, "r+") as root:
            values = root["VTKHDF/cam/PointData/von_mises_MPa"]
            values[0] = values[0] + 1.0
    elif kind in (Kind.GEOMETRY, Kind.SOLID):
        text, count = re.subn(
            r"(?<=[\n(])(\d\d\.\d{9,})",
            lambda m: repr(float(m[1]) + 1e-3),
            content.decode(),
            count=1,
        )
        assert count == 1
        file.write_text(text)
    elif kind is Kind.PAGE:
        end, mark = (b"</svg>", b"text") if file.suffix == ".svg" else (b"</body>", b"p")
        told = b"<%b>approved</%b>%b" % (mark, mark, end)
        file.write_bytes(told.join(content.rsplit(end, 1)))
    elif kind is Kind.BOOK:
        with zipfile.ZipFile(file) as old:
            members = {name: old.read(name) for name in old.namelist()}
        sheet = "xl/worksheets/sheet1.xml"
        members[sheet] = re.sub(rb"<v>\d+\.\d", rb"<v>77.7", members[sheet], count=1)
        with zipfile.ZipFile(file, "w") as new:
            for name, member in members.items():
                new.writestr(name, member)
    elif kind is Kind.PICTURE:
        with Image.open(io.BytesIO(content)) as picture:
            spot = picture.convert("RGB")
        spot.paste((0, 0, 0), (40, 40, 56, 56))
        spot.save(file)
    else:
        file.write_bytes(content + b"\n# approved\n")
    assert file.read_bytes() != content


@pytest.mark.slow
def test_every_file_of_a_run_has_one_class_and_a_forgery_of_it_is_named(
    certified: Path, tmp_path: Path, command: Command
) -> None:
    """All at once, whatever versions the run states; but the lift and the case, which are taken."""
    run = Path(shutil.copytree(certified, tmp_path / "run"))
    report(run, PARTS)
    classes = {}
    for name, _ in files_in(run):
        (classes[name],) = classes_of(name, 1)
    assert set(Kind) == {each.kind for each in classes.values()}
    taken = ("case.toml", f"{TRIAL}/2_spline.csv", signoff.NAME)
    names = [name for name in classes if name not in taken and not name.startswith("inputs/")]
    assert {classes[name].origin for name in names} == {Origin.SOLVED, Origin.DRAWN, Origin.RECORD}
    for name in names:
        forged(run / name, classes[name].kind)
    (run / "workshop" / "cam2.step").write_bytes((certified / "workshop/cam.step").read_bytes())
    (run / "exports").mkdir()
    (run / "exports" / "loads_090.000.inp").write_text("*HEADING\n")
    entry_changed("run.json", "versions", "numpy", value="9.9.9")(run)
    entry_changed("run.json", "statement", value="approved by A. N. Other")(run)
    signed_anew(run)
    code, _, err = command("check", run, "--recompute", "--angles", "0")
    assert code == 4
    others = ("workshop/cam2.step", "exports/loads_090.000.inp")
    assert [name for name in (*names, *others) if f"{run / name}: " not in err] == []
    assert "the run was solved by numpy 9.9.9, here " in err
    (unseen,) = re.findall(r"not compared: (.*)", err)
    assert "run.json: statement" in unseen and "run.json: versions" in unseen


@pytest.mark.slow
@pytest.mark.parametrize(
    ("forge", "message"),
    [
        (column_scaled(f"{TRIAL}/2_spline.csv", "spline_c0_m", 0.99), r"2_spline\.csv: "),
        (case_replaced('overspeed = "2400 rpm"', 'overspeed = "1900 rpm"'), "6_checks"),
    ],
)
def test_another_cam_or_case_under_the_old_results_is_named(
    certified: Path,
    tmp_path: Path,
    command: Command,
    forge: Callable[[Path], None],
    message: str,
) -> None:
    run = Path(shutil.copytree(certified, tmp_path / "run"))
    forge(run)
    signed_anew(run)
    code, _, err = command("check", run, "--recompute", "--angles", "0")
    assert code == 4
    assert re.search(message, err), err
