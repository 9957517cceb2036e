"""The STEP file of the cam, read back by other CAD kernels and from its text.

Camwright writes the entities itself; gmsh and FreeCAD read them with OpenCASCADE.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from cam_parts import Keyway

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.cad_drawing import Outline
from camwright.geometry.contour import Contour, RollerContour
from camwright.geometry.errors import GeometryError, InputError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.meshes.gmsh_mesher import session
from camwright.meshes.step_solid import write_step
from camwright.meshes.step_text import PartTitle, quoted, real, stamped

THETA = uniform_turn(360)
BORE, WIDTH, KEYWAY = 0.010, 0.015, Keyway(0.005, 0.0023, 0.4)
MM = 1e-3
TITLE = PartTitle(
    "ejector-cam", "4711", "B", "press", "Ana Müller", "16MnCr5", "2026-01-31"
)  # an umlaut is beyond ASCII
FREECAD = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")


@dataclass(frozen=True)
class Hole:
    centre: np.ndarray
    radius: float


def wavy(offset: float = 0.002) -> Contour:
    """Convex and hollow flanks, an offset follower."""
    lift = Lift(THETA, 0.005 * (1 - np.cos(THETA - 0.4)) + 0.010 * np.sin(2 * THETA) ** 2)
    return RollerContour(PitchCurve(lift, 0.050, offset), 0.008)


def circle() -> Contour:
    return RollerContour(PitchCurve(Lift(THETA, np.zeros(360)), 0.050), 0.008)


def steep() -> Contour:
    """A rise within a tenth of the turn: curvature changes quickly."""
    lift = Lift(THETA, 0.012 * np.exp(8.0 * (np.cos(THETA - 2.0) - 1.0)))
    return RollerContour(PitchCurve(lift, 0.050), 0.008)


OUTLINES = {
    "wavy": Outline(wavy(), BORE, KEYWAY),
    "circle": Outline(circle(), BORE),
    "steep": Outline(steep(), BORE, KEYWAY, Hole(np.array([0.012, -0.019]), 0.004)),
}


def hole_area(outline: Outline) -> float:
    """Area of bore, keyway and counter-hole, m^2, by elementary geometry."""
    area = np.pi * BORE**2
    if outline.keyway is not None:
        half, turn = 0.5 * KEYWAY.width, np.arcsin(0.5 * KEYWAY.width / BORE)
        mouth = BORE * np.cos(turn)
        area += 2 * half * (BORE + KEYWAY.depth - mouth)
        area -= BORE**2 * turn - half * mouth  # the cap of the bore that the slot takes in
    if outline.counter_hole is not None:
        area += np.pi * outline.counter_hole.radius**2
    return float(area)


@pytest.fixture(scope="module", params=OUTLINES)
def solid(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    """An outline and its STEP file."""
    outline = OUTLINES[request.param]
    path = tmp_path_factory.mktemp("step") / "cam.step"
    write_step(path, outline, WIDTH, TITLE)
    return outline, path


def test_another_kernel_reads_one_solid_of_the_contour(solid) -> None:
    outline, path = solid
    with session() as gmsh:
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        ((_, tag),) = gmsh.model.getEntities(3)
        assert gmsh.model.getEntityName(3, tag) == "Shapes/ejector-cam"
        for low in range(3):  # no free vertex, edge or face
            above = [
                gmsh.model.getAdjacencies(low, each)[0] for _, each in gmsh.model.getEntities(low)
            ]
            assert all(len(each) for each in above)
        volume = gmsh.model.occ.getMass(3, tag) * MM**3
        box = np.array(gmsh.model.occ.getBoundingBox(3, tag)) * MM
        kinds = Counter(gmsh.model.getType(2, each) for _, each in gmsh.model.getEntities(2))
        length = sum(
            gmsh.model.occ.getMass(1, each) * MM
            for _, each in gmsh.model.getEntities(1)
            if gmsh.model.getType(1, each) == "BSpline"
        )
    assert volume == pytest.approx(WIDTH * (outline.contour.area() - hole_area(outline)), rel=1e-6)
    assert length == pytest.approx(2 * outline.contour.perimeter(), rel=1e-6)  # top and bottom
    x, y = outline.contour.points(uniform_turn(20_000))
    wanted = [x.min(), y.min(), 0.0, x.max(), y.max(), WIDTH]
    np.testing.assert_allclose(box, wanted, atol=5e-5)  # the box of control points
    holes = 1 + (outline.counter_hole is not None)
    sides = 0 if outline.keyway is None else 3
    assert kinds == {"BSpline surface": 1, "Plane": 2 + sides, "Cylinder": holes}


def entities(path: Path) -> dict[str, str]:
    """Text of each entity by its reference."""
    return dict(re.findall(r"^(#\d+)=(.*);$", path.read_text(encoding="ascii"), re.MULTILINE))


def test_the_shell_is_closed_and_oriented(solid) -> None:
    """Each edge bounds two faces, once along its curve and once against it; Euler's formula."""
    outline, path = solid
    known = entities(path)
    kinds = Counter(re.match(r"\(?(\w+)", text)[1] for text in known.values())
    assert kinds["MANIFOLD_SOLID_BREP"] == kinds["CLOSED_SHELL"] == kinds["PRODUCT"] == 1
    assert not {
        "GEOMETRIC_SET",
        "SHELL_BASED_SURFACE_MODEL",
        "NEXT_ASSEMBLY_USAGE_OCCURRENCE",
    } & set(kinds)
    turned = [text for text in known.values() if text.startswith("ORIENTED_EDGE")]
    uses = Counter(re.search(r"(#\d+),\.([TF])\.", text).groups() for text in turned)
    edges = [key for key, text in known.items() if text.startswith("EDGE_CURVE")]
    assert uses == {(edge, sense): 1 for edge in edges for sense in "TF"}
    holes = 1 + (outline.counter_hole is not None)
    loops_within_faces = kinds["FACE_BOUND"]
    # V - E + F - (L - F) = 2 (S - G), a hole through the body is a handle
    euler = kinds["VERTEX_POINT"] - len(edges) + kinds["ADVANCED_FACE"] - loops_within_faces
    assert euler == 2 - 2 * holes
    assert loops_within_faces == 2 * holes


def test_the_contour_is_one_face_with_its_seam_at_angle_zero(solid) -> None:
    outline, path = solid
    known = entities(path)
    (face,) = [text for text in known.values() if text.startswith("ADVANCED_FACE('contour'")]
    (bound,) = re.search(r"\((#\d+)\)", face).groups()
    loop = known[re.search(r"#\d+", known[bound])[0]]
    turned = [known[each] for each in re.findall(r"#\d+", loop)]
    edges = Counter(re.search(r"#\d+", each)[0] for each in turned)
    (seam,) = [edge for edge, uses in edges.items() if uses == 2]
    ends = re.findall(r"#\d+", known[seam])[:2]
    places = [known[re.search(r"#\d+", known[end])[0]] for end in ends]
    points = np.array(
        [[float(v) for v in re.search(r"\(([^()]+)\)\)", p)[1].split(",")] for p in places]
    )
    np.testing.assert_allclose(points[:, 1], 0.0, atol=1e-9)
    np.testing.assert_allclose(points[:, 2], [0.0, WIDTH / MM])
    # the follower's contour point on +x, by a fine polygon of the contour
    x, y = outline.contour.points(uniform_turn(100_000))
    k = np.argmin(np.where(x > 0, np.abs(y), np.inf))
    assert points[0, 0] == pytest.approx(x[k] / MM, abs=5e-3)


def test_header_names_part_author_material_and_hashes(tmp_path: Path) -> None:
    path = tmp_path / "cam.step"
    write_step(path, OUTLINES["circle"], WIDTH, TITLE)
    text = path.read_text(encoding="ascii")
    head, _, data = text.partition("ENDSEC;")
    assert "'material 16MnCr5'" in head
    assert "'angle zero: the seam of the face contour, on the axis +x" in head
    assert "FILE_NAME('ejector-cam','2026-01-31T00:00:00',('Ana M\\X4\\000000FC\\X0\\ller')" in head
    assert "PRODUCT('4711','ejector-cam','press',(" in data
    assert "PRODUCT_DEFINITION_FORMATION('B'," in data
    whole = stamped(stamped(text, "0" * 64, "1" * 64), "a" * 64, "b" * 64)
    assert f"'case SHA-256 {'a' * 64}','results SHA-256 {'b' * 64}'" in whole
    assert whole.partition("ENDSEC;")[2] == data
    write_step(path, OUTLINES["circle"], WIDTH, PartTitle("case SHA-256 x"))
    untitled = stamped(path.read_text(encoding="ascii"), "a" * 64, "b" * 64)
    assert "'1970-01-01T00:00:00',('')" in untitled
    assert "PRODUCT('case SHA-256 x','case SHA-256 x'" in untitled


def test_same_cam_same_bytes(tmp_path: Path) -> None:
    for name in ("one.step", "two.step"):
        write_step(tmp_path / name, OUTLINES["steep"], WIDTH, TITLE)
    assert (tmp_path / "one.step").read_bytes() == (tmp_path / "two.step").read_bytes()


@pytest.mark.parametrize("value", [0.1, -0.0, 1e-300, 12.0, -2.5e17, 1 / 3])
def test_reals_read_back_and_have_a_point(value: float) -> None:
    assert re.fullmatch(r"-?\d+\.\d*(E[+-]?\d+)?", real(value))
    assert float(real(value)) == value
    assert real(-0.0) == "0.0"


def test_strings_hold_no_quote_control_or_letter_that_would_break_the_file() -> None:
    assert quoted("it's a \\ cam") == "'it''s a \\\\ cam'"
    assert quoted("ø\n#1=X;") == "'\\X4\\000000F8\\X0\\\\X4\\0000000A\\X0\\#1=X;'"


def test_what_bounds_no_body_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "cam.step"
    with pytest.raises(GeometryError, match="wall around the bore"):
        write_step(path, Outline(circle(), 0.041, Keyway(0.005, 0.002)), WIDTH, TITLE)
    with pytest.raises(InputError, match="width"):
        write_step(path, OUTLINES["circle"], float("nan"), TITLE)
    undercut = RollerContour(PitchCurve(wavy().lift, 0.050), 0.040)
    with pytest.raises(GeometryError, match="undercut"):
        write_step(path, Outline(undercut, 0.001), WIDTH, TITLE)
    assert not path.exists()


FREECAD_SCRIPT = """
import json, os, FreeCAD, Import
document = FreeCAD.newDocument()
Import.insert(os.environ["CAM_STEP"], document.Name)
print()
print("READ", json.dumps([
    [each.Label, shape.ShapeType, shape.isValid(), shape.Volume, len(shape.Solids)]
    for each in document.Objects if (shape := getattr(each, "Shape", None))
]))
"""


@pytest.mark.slow
@pytest.mark.skipif(FREECAD is None, reason="FreeCAD is not installed")
def test_freecad_imports_one_solid(solid, tmp_path: Path) -> None:
    outline, path = solid
    script = tmp_path / "read_step.py"
    script.write_text(FREECAD_SCRIPT)
    # its own Python takes nothing from ours
    known = {key: text for key, text in os.environ.items() if not key.startswith("PYTHON")}
    told = subprocess.run(
        [FREECAD, str(script)], env={**known, "CAM_STEP": str(path)}, stdin=subprocess.DEVNULL,
        capture_output=True, text=True, timeout=300, check=True,
    )  # fmt: skip
    (line,) = [line for line in told.stdout.splitlines() if line.startswith("READ ")]
    ((label, kind, valid, volume, solids),) = json.loads(line.removeprefix("READ "))
    assert (label, kind, valid, solids) == ("ejector-cam", "Solid", True, 1)
    body = WIDTH * (outline.contour.area() - hole_area(outline))
    assert volume * MM**3 == pytest.approx(body, rel=1e-6)
