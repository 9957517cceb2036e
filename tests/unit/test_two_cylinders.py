"""Two cylinders: input, limits, what is stated beside the figures."""

import json

import numpy as np
import pytest
from command_lines import ran

from camwright.geometry.errors import ContactError, InputError
from camwright.pipeline.base import disk_cache
from camwright.pipeline.contact.contact_patch import contact_patch
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.elasticity.halfplane import point_force_displacement
from camwright.pipeline.studies import two_cylinders
from camwright.pipeline.studies.two_cylinders import TwoCylinders
from camwright.pipeline.studies.two_cylinders_document import ContactOptions, solved

STEEL = Elastic(210e9, 0.3)
BASE = {"r1": "10", "r2": "inf", "e1": "210000", "nu1": "0.3", "line_load": "100"}


def options(**changes):
    given = BASE | changes
    words = ["contact", "cylinders"]
    for name, value in given.items():
        if value is not None:
            words += [f"--{name.replace('_', '-')}", value]
    return words


def run(*more, **changes):
    return ran([*options(**changes), *more])


def figures(**changes):
    found = run("--json", **changes)
    assert found.exception is None, found.exception
    return json.loads(found.stdout)


def test_json_has_the_promised_keys():
    document = figures()
    keys = {
        "p0_MPa", "half_width_mm", "tau_max_MPa", "tau_depth_mm", "von_mises_MPa",
        "von_mises_depth_mm",
    }  # fmt: skip
    assert keys == set(document["hertz"])
    assert keys | {"dofs", "error_bar_percent", "residual"} == set(document["fe"])
    assert document["seconds"] > 0
    assert document["fe"]["dofs"] > 10_000
    assert document["fe"]["residual"] < 1e-9


def test_units_are_read_and_bare_numbers_are_mm_mpa_newton():
    bare = figures(r2="20")["hertz"]
    worded = figures(
        r1="1 cm", r2="0.02 m", e1="210 GPa", line_load=None, load="500 N", width="5 mm"
    )["hertz"]
    assert worded == pytest.approx(bare, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "readings"),
    [("210", '"210 MPa" or "210 GPa"'), ("1e6", '"1e6 MPa" or "1e6 Pa"'),
     ("2.1e11", '"2.1e11 Pa"'), ("0.01", '"0.01 GPa"')],
)  # fmt: skip
@pytest.mark.parametrize("option", ["e1", "e2"])
def test_a_modulus_that_may_be_in_another_unit_is_refused(option, text, readings):
    refused = run(**{option: text})
    assert (
        str(refused.exception) == f"--{option} = {text}, must be stated with its unit, {readings}"
    )
    with_unit = ContactOptions("10", "inf", f"{text} MPa", 0.3, line_load="100").pair()
    assert with_unit.body_1.modulus == pytest.approx(1e6 * float(text), rel=1e-15)


@pytest.mark.parametrize("text", ["1300", "70000", "210000", "999999"])
def test_a_modulus_of_one_reading_is_in_mpa(text):
    assert (
        ContactOptions("10", "inf", text, 0.3, line_load="100").pair()
        == ContactOptions("10", "inf", f"{text} MPa", 0.3, line_load="100").pair()
    )


def test_the_second_body_is_like_the_first_unless_told():
    assert figures()["hertz"] == figures(e2="210000", nu2="0.3")["hertz"]
    assert figures(e2="70000")["hertz"]["p0_MPa"] < figures()["hertz"]["p0_MPa"]


def test_for_people_it_prints_both_columns():
    text = run().stdout
    assert "Hertz" in text and "finite elements" in text
    assert "606.037" in text and "606.06" in text
    assert "error bar" in text
    assert "as a finite disc" in text


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        ({"r1": "0"}, "--r1"),
        ({"r1": "nan"}, "--r1"),
        ({"r1": "10 s"}, "--r1"),
        ({"r2": "-10"}, "--r2"),
        ({"r1": "inf"}, "--r2"),
        ({"e1": "0"}, "--e1"),
        ({"e1": "inf"}, "--e1"),
        ({"nu1": "0.5"}, "--nu1"),
        ({"nu2": "-0.1"}, "--nu2"),
        ({"line_load": "-1"}, "--line-load"),
        ({"line_load": "nan"}, "--line-load"),
        ({"line_load": None}, "--line-load"),
        ({"load": "5"}, "--load"),
        ({"line_load": None, "load": "5", "width": "0"}, "--width"),
        ({"friction": "-0.1"}, "--friction"),
    ],
)
def test_bad_input_is_named(changes, field):
    error = run(**changes).exception
    assert isinstance(error, InputError)
    assert error.field == field


def test_no_load_gives_no_pressure(recwarn):
    document = figures(line_load="0")
    assert set(document["hertz"].values()) == {0.0}
    assert document["fe"]["p0_MPa"] == document["fe"]["von_mises_MPa"] == 0
    assert not [w for w in recwarn if issubclass(w.category, RuntimeWarning)]


def test_beyond_fifteen_degrees_it_says_so_and_gives_the_conforming_solution():
    document = figures(r2="-10.1", line_load="1000")
    assert document["fe"] is None
    assert "no Hertz contact" in document["conforming"]["why"]
    persson, numerical = document["conforming"]["persson"], document["conforming"]["numerical"]
    assert persson["half_angle_deg"] > 15
    assert numerical["p0_MPa"] == pytest.approx(persson["p0_MPa"], rel=5e-3)
    assert numerical["half_angle_deg"] == pytest.approx(persson["half_angle_deg"], abs=0.2)
    assert "no Hertz contact" in run(r2="-10.1", line_load="1000").stdout


@pytest.mark.parametrize(
    ("changes", "beta"),
    [
        # (1 - 2 nu)/(2 (1 - nu)) of the softer body on one of a billion times its modulus.
        ({"e2": "210000e9"}, 0.4 / 1.4),
        ({"e2": "210000e-9"}, -0.4 / 1.4),
        ({"e2": "210000e9", "r2": "-10.1", "line_load": "1000"}, 0.4 / 1.4),
    ],
)
def test_unlike_materials_have_the_pressure_of_a_frictionless_contact(changes, beta):
    if changes["e2"].endswith("e-9"):
        changes = changes | {"line_load": "1e-8"}
    assert figures(**changes)["dundurs_beta"] == pytest.approx(beta, rel=1e-6)
    line = f"unlike materials, Dundurs' beta {beta:.4g}: pressure of a frictionless contact"
    assert line in run(**changes).stdout.splitlines()


def test_like_materials_have_no_line_on_friction():
    for changes in ({}, {"e2": "210 GPa"}):
        assert abs(figures(**changes)["dundurs_beta"]) < 1e-12
        assert "Dundurs" not in run(**changes).stdout


def test_unlike_bodies_have_no_persson():
    document = figures(r2="-10.1", line_load="1000", e2="100000")
    assert document["conforming"]["persson"] is None
    assert document["conforming"]["numerical"]["p0_MPa"] > 0


def test_convex_bodies_pressed_flat_are_refused():
    error = run(line_load="1e6").exception
    assert isinstance(error, ContactError)
    assert "15 deg" in str(error)


def test_the_limit_is_fifteen_degrees():
    """Half-width over radius just under and over sin 15 deg."""
    modulus = 210e9 / (1 - 0.09) / 2
    edge = np.pi * modulus * (np.sin(np.radians(15)) * 0.01) ** 2 / (4 * 0.01)
    assert not two_cylinders.is_conforming(TwoCylinders(0.01, np.inf, STEEL, STEEL, 0.99 * edge))
    assert two_cylinders.is_conforming(TwoCylinders(0.01, np.inf, STEEL, STEEL, 1.01 * edge))


def test_the_field_is_that_of_the_figures(tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "out.vtu"
    document = figures(r2="30", field=str(path))
    grid = meshio.read(path)
    half_width = document["hertz"]["half_width_mm"]
    assert grid.cells[0].type == "triangle6"
    below, above = (grid.point_data["body"] == number for number in (0, 1))
    assert grid.points[below, 1].max() == pytest.approx(0, abs=1e-12)
    assert grid.points[above, 1].min() == pytest.approx(0, abs=1e-12)
    assert np.abs(grid.points).max() > 1.6 * half_width
    corners = grid.points[grid.cells[0].data[:, :3]]
    edge, other = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    assert (edge[:, 0] * other[:, 1] > edge[:, 1] * other[:, 0]).all(), "triangles turned over"
    highest = int(np.where(below, grid.point_data["von_mises_MPa"], 0).argmax())
    assert grid.point_data["von_mises_MPa"][highest] == pytest.approx(
        document["fe"]["von_mises_MPa"], rel=2e-3
    )
    assert -grid.points[highest, 1] == pytest.approx(
        document["fe"]["von_mises_depth_mm"], abs=0.05 * half_width
    )
    # Under the middle of the contact the pressure is what presses downward.
    middle = int(np.hypot(*grid.points[:, :2].T).argmin())
    assert grid.point_data["stress_yy_MPa"][middle] == pytest.approx(
        -document["fe"]["p0_MPa"], rel=0.02
    )
    # Traction-free outside: right of the contact the shear below has the sign of the load's flow.
    right = grid.point_data["stress_xy_MPa"][below & (grid.points[:, 0] > 0.2 * half_width)]
    left = grid.point_data["stress_xy_MPa"][below & (grid.points[:, 0] < -0.2 * half_width)]
    assert right.mean() > 0 > left.mean()


def test_the_field_of_both_bodies_alike_is_one_turned_by_half_a_turn(tmp_path):
    meshio = pytest.importorskip("meshio")
    path = tmp_path / "out.vtu"
    figures(r2="30", friction="0.2", field=str(path))
    grid = meshio.read(path)
    below, above = (np.flatnonzero(grid.point_data["body"] == number) for number in (0, 1))
    # The mesh is not quite its own mirror image: compare with the nearest node.
    apart = np.hypot(*(grid.points[below, None, :2] + grid.points[None, above, :2]).T)
    nearest, close = above[apart.argmin(axis=0)], apart.min(axis=0) < 1e-6
    assert close.sum() > 20
    for name in ("stress_xx_MPa", "stress_xy_MPa", "von_mises_MPa"):
        one, two = grid.point_data[name][below][close], grid.point_data[name][nearest][close]
        np.testing.assert_allclose(two, one, atol=0.02 * np.abs(one).max())


def test_the_field_of_the_second_body_is_that_of_the_first_when_they_change_places():
    hard, soft = Elastic(210e9, 0.3), Elastic(3e9, 0.4)
    one = two_cylinders.finite_elements(TwoCylinders(0.01, 0.03, hard, soft, 1e4))
    two = two_cylinders.finite_elements(TwoCylinders(0.03, 0.01, soft, hard, 1e4))
    for k in (0, 1):
        largest = np.abs(one.stresses[k]).max()
        np.testing.assert_allclose(two.stresses[1 - k], one.stresses[k], atol=1e-6 * largest)


def test_the_field_of_a_conforming_contact_is_refused(tmp_path):
    error = run(r2="-10.1", line_load="1000", field=str(tmp_path / "x.vtu")).exception
    assert isinstance(error, InputError)
    assert not list(tmp_path.iterdir())


def test_approach_of_two_discs():
    """Johnson (1985), eq. 5.57: each half disc gives P (1 - nu^2)/(pi E) (2 ln(4R/a) - 1)."""
    found = figures(r2="10")["hertz"]
    a = found["half_width_mm"]
    unit = 100 * 0.91 / (np.pi * 210000)
    document = json.loads(run("--json", "--approach", r2="10").stdout)
    assert document["approach_mm"] == pytest.approx(2 * unit * (2 * np.log(40 / a) - 1), rel=1e-12)


def test_approach_of_a_depth_is_that_of_the_half_plane():
    """A Hertz pressure of point forces: the surface against a point far below."""
    found = figures(r1="10", r2="inf")["hertz"]
    a, depth = found["half_width_mm"], 40.0
    angle = (np.arange(4000) + 0.5) * np.pi / 4000
    x, share = a * np.cos(angle), np.sin(angle) ** 2 * 2 / 4000
    down = [
        float(share @ point_force_displacement(x, np.full_like(x, z), 0.3)[1])
        for z in (1e-9, depth)
    ]
    half_plane = (down[0] - down[1]) * 100 * 0.91 / 210000
    document = json.loads(run("--json", "--approach", depth2="40").stdout)
    disc = 100 * 0.91 / (np.pi * 210000) * (2 * np.log(40 / a) - 1)
    assert document["approach_mm"] - disc == pytest.approx(half_plane, rel=1e-3)


def test_approach_of_a_flat_needs_a_depth():
    error = run("--approach").exception
    assert isinstance(error, InputError)
    assert (error.field, error.value) == ("--depth2", "missing")


def test_other_planes_are_told_where_they_shear_more():
    assert "tau_max_all_planes_MPa" not in figures()["fe"]
    low = figures(nu1="0.1")
    # On the axis, between the load's direction and the cylinders': (nu (sx + sz) - sz) / 2.
    z = np.linspace(0, 1, 1001)
    root = np.sqrt(1 + z**2)
    sx, sz = 2 * z - (1 + 2 * z**2) / root, -1 / root
    assert low["hertz"]["tau_max_all_planes_MPa"] == pytest.approx(
        ((0.1 * (sx + sz) - sz) / 2).max() * low["hertz"]["p0_MPa"], rel=1e-5
    )
    assert low["fe"]["tau_max_all_planes_MPa"] == pytest.approx(
        low["hertz"]["tau_max_all_planes_MPa"], rel=5e-3
    )


def test_asked_without_command_line():
    options = ContactOptions("10", "20", "210 GPa", 0.3, "70 GPa", 0.33, line_load="0.1 kN/mm")
    assert solved(options)["hertz"]["p0_MPa"] == pytest.approx(
        1e-6 * two_cylinders.closed_form(options.pair()).p0
    )


@pytest.fixture
def fresh(tmp_path, monkeypatch):
    """A cache folder of its own, and no template in memory."""
    monkeypatch.setenv(disk_cache.OFF, "")
    monkeypatch.setenv(disk_cache.FOLDER, str(tmp_path / "kept"))
    contact_patch.cache_clear()
    yield tmp_path / "kept"
    contact_patch.cache_clear()


def test_the_template_is_kept_and_gives_the_same_figures(fresh):
    first = figures()
    entries = {path: path.read_bytes() for path in fresh.iterdir()}
    assert len(entries) == 2, "one template of each resolution"
    contact_patch.cache_clear()
    again = figures()
    assert {k: v for k, v in again.items() if k != "seconds"} == {
        k: v for k, v in first.items() if k != "seconds"
    }
    assert {path: path.read_bytes() for path in fresh.iterdir()} == entries


def test_no_cache_leaves_no_trace(fresh):
    assert run("--json", "--no-cache").exception is None
    assert not fresh.exists()
