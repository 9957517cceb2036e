"""`camwright design parts`: a front of cases that are what it says of them, kept and used again."""

import json
import tomllib
from concurrent.futures import Future
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from record_validation import schema_errors

from camwright.geometry.errors import InputError, ResultError
from camwright.pipeline.base import worker_processes
from camwright.pipeline.base.progress import Silent
from camwright.pipeline.case.cards import substitution
from camwright.pipeline.case.cards.catalogue import Catalogue, catalogue_of
from camwright.pipeline.case.cards.substitution import Choice
from camwright.pipeline.case.case_file import case_of, parse_case, read_case
from camwright.pipeline.case.case_writer import to_toml
from camwright.pipeline.commands.parts_command import parts
from camwright.pipeline.preview import preview_case
from camwright.pipeline.search.parts import part_search, redesign_study
from camwright.reports.comparisons import redesign_page as page

CASES = Path(__file__).parents[2] / "cases"
DATA = Path(__file__).parents[1] / "data"
ROLLER = "track_roller_35x16"


# A search of the roller alone: the soft spring surges, and its bushes do not bear.
SCOPED = (
    ('roller_life = "1000 h"', 'roller_life = "10 h"'),
    ('target_life = "1000 h"', 'target_life = "10 h"'),
    ('overspeed = "3960 rpm" ', 'unbalance = "9999 mm/s"\nwaviness = 1.0 '),
    (
        "\n[spring]\n",
        '\n[scope]\nnot_covered = ["spring", "guides", "fork", "camshaft", "camshaft_bearings",'
        ' "key", "gear"]\nreason = "a search of the roller alone"\n\n[spring]\n',
    ),
)


PUBLISHED = (
    ('not_covered = ["pin",', 'not_covered = ["spring", "guides", "pin",'),
    ('overspeed = "3960 rpm" ', 'unbalance = "9999 mm/s"\nwaviness = 1.0\nfriction_power = 1.0 '),
    ('overspeed = { text = "manufacturer', 'unbalance = { text = "manufacturer'),
    ('material = "s355"', 'profile_tolerance = "8 um"\nmaterial = "hardened"'),
)
HARDENED = '\n[materials.hardened]\ncard = "case_hardened"\n'


class Inline:
    """Stands for the processes: each piece of work is done as it is handed in."""

    def submit(self, function, *values):
        future = Future()
        future.set_result(function(*values))
        return future


# Stands before the tests of `small`, which cuts the catalogue of the whole module.
@pytest.mark.slow
def test_whole_catalogue_for_the_published_engine(tmp_path):
    """Ground and hardened, at idle, but for guides, spring and friction: with them none passes."""
    text = (CASES / "gx120.toml").read_text(encoding="utf-8")
    for old, new in PUBLISHED:
        assert text.count(old) == 1
        text = text.replace(old, new)
    (tmp_path / "case.toml").write_text(text + HARDENED, encoding="utf-8")
    document = redesign_study.redesign(
        tmp_path / "case.toml", tmp_path / "out", "size", 2, Silent()
    )
    assert document["given"]["failing"]
    points = document["points"]
    assert len(points) >= 3
    for point in points:
        assert point["torque_reduction"] >= 0.4
        assert read_case(tmp_path / "out" / point["file"]).roller.radius > 0.008


@pytest.fixture(scope="module")
def small():
    """Two rollers, one spring, one bush and two rooms, worked through in this process."""
    whole = catalogue_of(None)
    few = Catalogue(
        {ROLLER: whole.rollers[ROLLER], "weak": replace(whole.rollers["maker_2_625"], C0=100.0)},
        {"60 x 42": whole.springs["60 x 42"]},
        {"bronze": whole.bushes["bronze"]},
    )
    with pytest.MonkeyPatch.context() as patch:
        for module in (redesign_study, substitution):
            patch.setattr(module, "catalogue_of", lambda folder: few)
        patch.setattr(redesign_study, "pool", lambda workers: nullcontext(Inline()))
        patch.setattr(redesign_study, "versions", lambda: {"source": "of the test"})
        patch.setattr(part_search, "RUNGS", 2)
        yield


@pytest.fixture(scope="module")
def case_file(tmp_path_factory):
    """The parts of the soft spring under a moving average, at idle, on a coarser turn."""
    text = (DATA / "soft_spring.toml").read_text(encoding="utf-8")
    text = text[: text.index('[[load_case]]\nname = "overspeed"')]
    text = text.replace('kind = "constrained"', 'kind = "moving_average"\ncoefficients = 36')
    for old, new in SCOPED:
        assert text.count(old) == 1
        text = text.replace(old, new)
    path = tmp_path_factory.mktemp("case") / "small.toml"
    path.write_text(text.replace("positions = 720", "positions = 90"), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def done(small, case_file, tmp_path_factory):
    out = tmp_path_factory.mktemp("redesign") / "out"
    return out, redesign_study.redesign(case_file, out, "size", 2, Silent())


def test_points_are_a_front_of_feasible_cases(done):
    _, document = done
    points = document["points"]
    assert points
    sizes = [point["cam_radius_mm"] for point in points]
    ripples = [point["ripple_left_Nm"] for point in points]
    assert sizes == sorted(sizes)
    assert ripples == sorted(ripples, reverse=True)
    assert all(point["feasible"] and not point["failing"] for point in points)
    assert {point["roller"] for point in points} == {ROLLER}
    why = {one["part"]: one["why"] for one in document["pruned"]}
    assert "67 N" in why["weak"]  # 100 N over a safety of 1.5


def test_a_point_is_what_its_case_file_gives(done):
    out, document = done
    point = document["points"][-1]
    case = read_case(out / point["file"])
    checks = {check.id: check for check in preview_case(case).checks}
    # the same case by the same functions: nothing may differ
    assert checks["torque_reduction"].demand == pytest.approx(point["torque_reduction"], rel=1e-9)
    assert 1e3 * checks["cam_radius"].demand == pytest.approx(point["cam_radius_mm"], rel=1e-9)
    failing = {c.id for c in checks.values() if c.must_have and c.status == "fail"}
    assert not failing
    assert case.roller.radius == 0.0175


@pytest.mark.slow
def test_the_parts_of_an_arm_are_searched(small, monkeypatch, tmp_path):
    """Its own bush and another with a spring that stores enough: the cam of the best is previewed.

    The spring is the nearest of the catalogue in rate, and softer: it fails by itself.
    """
    whole = catalogue_of(None)
    few = Catalogue(
        {"track_roller_47x18": whole.rollers["track_roller_47x18"]},
        {"80 x 50": whole.springs["80 x 50"]},
        {"ptfe_lined": whole.bushes["ptfe_lined"]},
    )
    for module in (redesign_study, substitution):
        monkeypatch.setattr(module, "catalogue_of", lambda folder: few)
    text = (CASES / "gx120-arm.toml").read_text(encoding="utf-8")
    text = text[: text.index('[[load_case]]\nname = "governed"')]
    for old, new in (("torque_reduction = 0.5", "torque_reduction = 0.4"),
                     ("positions = 720", "positions = 90")):  # fmt: skip
        assert text.count(old) == 1
        text = text.replace(old, new)
    (tmp_path / "arm.toml").write_text(text, encoding="utf-8")
    document = redesign_study.redesign(tmp_path / "arm.toml", tmp_path / "out", "size", 1, Silent())
    assert document["as_given"] == [] and document["given"]["verdict"] == "pass"
    good = [each for each in document["tried"] if each.get("feasible")]
    assert {each["bush"] for each in good} == {"as given", "ptfe_lined"}
    assert all(each["ripple_left_share"] < 0.6 for each in good)
    whys = [each["why"] for each in document["refused"]]
    assert whys and all("spring_fatigue" in why and "pivot" not in why for why in whys)


@pytest.mark.slow
def test_without_a_result_limit_and_way_are_named_and_no_file_is(
    small, case_file, tmp_path, capsys
):
    """In a room of 48 mm every cam leaves too much of the ripple; more room is one of the ways."""
    text = case_file.read_text(encoding="utf-8")
    assert text.count('cam_radius = "90 mm"') == 1
    path = tmp_path / "tight.toml"
    path.write_text(text.replace('cam_radius = "90 mm"', 'cam_radius = "48 mm"'), encoding="utf-8")
    code = parts(path, out=tmp_path / "out", jobs=1)
    shown = capsys.readouterr().out
    assert code == 1
    assert "no choice of the catalogues keeps all limits" in shown
    assert "excluded most by torque_reduction (torque ripple reduction): 3 of 3" in shown
    ways = shown.split("changes that make it feasible: ")[1]
    assert "cam radius: " in ways and " mm instead of 48 mm" in ways
    assert "its limits in conflict: cam_radius, torque_reduction" in shown
    assert "point_01" not in shown
    document = json.loads((tmp_path / "out" / "redesign.json").read_text(encoding="utf-8"))
    assert schema_errors("redesign", document) == []
    assert document["points"] == []
    page_text = (tmp_path / "out" / "redesign.html").read_text(encoding="utf-8")
    assert "changes that make it feasible: " in page_text


def test_what_is_solved_is_used_again(done, case_file):
    out, document = done
    kept = {path: path.stat().st_mtime_ns for path in (out / "solved").iterdir()}
    lost = next(path for path in sorted(kept) if path.name.startswith("synthesis"))
    lost.unlink()  # as if the search had been killed before it
    assert redesign_study.redesign(case_file, out, "size", 1, Silent()) == document
    assert lost.is_file()
    assert all(path.stat().st_mtime_ns == kept[path] for path in kept if path != lost)


def test_a_judgement_of_a_worker_is_that_of_this_process(done, case_file, tmp_path):
    task = redesign_study.RedesignTask(read_case(case_file), case_file.parent, tmp_path, "v")
    with worker_processes.pool(1) as workers:
        there = workers.submit(task.whole, None).result()
    assert there == done[1]["given"]
    assert list((tmp_path / "solved").iterdir())


def test_the_next_command_names_case_and_run_folder(done, case_file, capsys):
    out, document = done
    parts(case_file, out=out, jobs=1)
    shown = " ".join(capsys.readouterr().out.split())
    first = document["points"][0]["file"]
    command = f"next: camwright run {out / first} --out runs/{Path(first).stem}"
    assert command in shown


def test_page_and_record(done):
    out, document = done
    assert json.loads((out / "redesign.json").read_text(encoding="utf-8")) == document
    assert schema_errors("redesign", document) == []
    made = page.write(out, document | {"case": "<b>"})
    text = made.read_text(encoding="utf-8")
    assert "&lt;b&gt;" in text and "<b>" not in text
    assert ROLLER in text and "too low for the required torque reduction" in text
    assert (out / "redesign.png").read_bytes().startswith(b"\x89PNG")


def test_leaves_other_folders_alone(small, case_file, tmp_path):
    (tmp_path / "letter.txt").write_text("mine")
    with pytest.raises(ResultError, match=r"holds letter\.txt, which is not of a redesign"):
        redesign_study.redesign(case_file, tmp_path, "size", 1, Silent())
    assert [path.name for path in tmp_path.iterdir()] == ["letter.txt"]
    (tmp_path / "letter.txt").rename(tmp_path / "redesign.json")
    (tmp_path / "redesign.json").write_text('{"case": "another"}')
    with pytest.raises(ResultError, match="another case"):
        redesign_study.redesign(case_file, tmp_path, "size", 1, Silent())
    (tmp_path / "redesign.json").write_text("[]")
    with pytest.raises(ResultError, match="another case"):
        redesign_study.redesign(case_file, tmp_path, "size", 1, Silent())


def test_a_killed_search_blocks_nothing_and_a_running_one_blocks_others(
    small, case_file, tmp_path, monkeypatch
):
    """Nothing is written through a link either."""
    out = tmp_path / "out"
    (out / "solved").mkdir(parents=True)
    for name in (".k3_x9.tmp", "solved/.a1.tmp", ".lock"):
        (out / name).write_text("")

    def stopped(*_):
        assert [each.name for each in sorted(out.rglob("*"))] == [".lock", "solved"]
        with pytest.raises(ResultError, match="another redesign is writing to it"):
            redesign_study.redesign(case_file, out, "size", 1, Silent())
        raise KeyboardInterrupt

    monkeypatch.setattr(redesign_study, "_searched", stopped)
    with pytest.raises(KeyboardInterrupt):
        redesign_study.redesign(case_file, out, "size", 1, Silent())
    assert [each.name for each in out.iterdir()] == ["solved"]
    (out / "solved" / "preview-a.json").symlink_to(case_file)
    with pytest.raises(ResultError, match=r"preview-a\.json: is a link"):
        redesign_study.redesign(case_file, out, "size", 1, Silent())


def test_files_a_case_includes_go_with_its_points(tmp_path):
    """The engine's torque from a table: a point stands by itself in its folder."""
    angle = np.arange(0.0, 720.0, 5.0)
    rows = "".join(f"{a},{8 * np.sin(np.radians(a))}\n" for a in angle)
    (tmp_path / "torque.csv").write_text("crank_angle_deg,torque_Nm\n" + rows, encoding="utf-8")
    given = tomllib.loads(read_case(CASES / "gx120.toml").to_toml())
    given["engine"] = {"kind": "table", "file": "torque.csv"}
    case = case_of(given, tmp_path)
    path = tmp_path / "own.toml"
    path.write_text(to_toml(case, {"torque.csv": "torque.csv"}), encoding="utf-8")
    out = tmp_path / "out"
    asked = redesign_study.RedesignTask(read_case(path), tmp_path, out, "v")
    redesign_study._begin(asked)
    text = asked.text(Choice(ROLLER, "60 x 42", "bronze"))
    point = parse_case(text, out)
    assert point.included["inputs/torque.csv"] == (tmp_path / "torque.csv").read_bytes()


def test_refuses_what_cannot_be_redesigned(case_file, tmp_path):
    with pytest.raises(InputError, match="--against"):
        redesign_study.redesign(case_file, tmp_path / "out", "price", 1, Silent())
    with pytest.raises(InputError, match="engine"):
        given = CASES / "papers" / "eccentric.toml"
        redesign_study.redesign(given, tmp_path / "out", "size", 1, Silent())
    assert not (tmp_path / "out").exists()


def test_an_error_is_one_line(tmp_path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    code, _, errors = command("design", "parts", CASES / "gx120.toml", "--jobs", 0)
    assert code == 2
    assert errors.startswith("camwright: --jobs = 0") and errors.count("\n") == 1
    assert not list(tmp_path.iterdir())
