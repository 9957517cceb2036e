"""The order of the packages: imports point down, and every module named as text is there."""

from __future__ import annotations

import ast
import importlib.util
import re
import sys
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

import pytest

ROOT = Path(__file__).parents[2]
FOLDERS = ("geometry", "meshes", "pipeline", "reports")
BESIDE = "validation"
"""Package of the checkout that is not installed, under its own import name."""
# Lowest first; a module imports only from its own package and from those above it in this list.
ORDER = (
    "geometry",
    "meshes",
    "pipeline.base",
    "pipeline.records",
    "pipeline.torque",
    "pipeline.engine",
    "pipeline.contact.elasticity",
    "pipeline.contact",
    "pipeline.contact.finite_length",
    "pipeline.follower",
    "pipeline.case",
    "pipeline.case.cards",
    "pipeline.cycle",
    "pipeline.checks",
    "pipeline.smoothing",
    "pipeline.results",
    "pipeline.hand_check",
    "pipeline",
    "pipeline.search",
    "pipeline.search.remedies",
    "pipeline.screening",
    "pipeline.search.sizes",
    "pipeline.search.crown",
    "pipeline.search.parts",
    "pipeline.search.machine",
    "pipeline.studies",
    "reports.drawing",
    "reports.painting",
    "reports",
    "reports.study",
    "reports.comparisons",
    "validation.pages",
    "validation",
    "pipeline.studies.batch",
    "pipeline.commands",
    "pipeline.cli",
)
# Packages of one floor: the case reads its cards, and a card is a table of a case; a run searches
# remedies, which are judged by previews, and fits its live preview to screened designs.
RANK = {name: place for place, name in enumerate(ORDER)} | {
    "pipeline.case.cards": ORDER.index("pipeline.case"),
    "pipeline.search": ORDER.index("pipeline"),
    "pipeline.search.remedies": ORDER.index("pipeline"),
    "pipeline.screening": ORDER.index("pipeline"),
}
NAMED_AS_TEXT = re.compile(
    r"(?:camwright\.)?(?:geometry|meshes|pipeline|reports|validation)(?:\.[a-z_0-9]+)+"
)


@cache
def modules() -> dict[str, Path]:
    """Files by dotted name, without the import name before it."""
    found = {}
    for folder in (*FOLDERS, BESIDE):
        for path in sorted((ROOT / folder).rglob("*.py")):
            parts = path.relative_to(ROOT).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def tree(path: Path) -> ast.Module:
    """Syntax tree of a file, parsed once for all tests of this one."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def nodes(path: Path) -> tuple[ast.AST, ...]:
    """Nodes of the syntax tree of a file, in the order of `ast.walk`."""
    return tuple(ast.walk(tree(path)))


def package(name: str) -> str:
    """The package of a module as `ORDER` has it."""
    known = [each for each in ORDER if name == each or name.startswith(f"{each}.")]
    return max(known, key=len)


@cache
def imports() -> frozenset[tuple[str, str, int]]:
    """Importer, imported and line; those in functions and type blocks included."""
    found = set()
    for name, path in modules().items():
        for node in nodes(path):
            for target in _targets(node):
                if target in modules() and target != name:
                    found.add((name, target, node.lineno))  # type: ignore[attr-defined]
    return frozenset(found)


def _targets(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Import):
        named = [alias.name for alias in node.names]
    elif isinstance(node, ast.ImportFrom):
        assert node.level == 0, "imports are absolute"
        whole = [f"{node.module}.{alias.name}" for alias in node.names]
        named = [each if _own(each) in modules() else str(node.module) for each in whole]
    else:
        return
    for each in named:
        assert each.split(".")[0] not in FOLDERS, f"{each}: the import name is camwright"
        yield _own(each)


def _own(name: str) -> str:
    return name.removeprefix("camwright.")


def test_no_import_points_upward() -> None:
    upward = [
        f"{name}, line {line}: {target}"
        for name, target, line in sorted(imports())
        if RANK[package(name)] < RANK[package(target)]
    ]
    assert upward == []


def test_reports_read_results_and_draw_nothing_else() -> None:
    below = ("geometry", "pipeline.base", "pipeline.records", "pipeline.results")
    below += ("pipeline.hand_check", "reports.drawing", "reports.painting", "reports")
    other = {(n, t) for n, t, _ in imports() if package(n) == "reports" and package(t) not in below}
    assert sorted(other) == []


def test_nothing_that_is_installed_imports_the_validation() -> None:
    """It lies beside the packages of the wheel and reads them, all but the commands."""
    inside = {(n, t) for n, t, _ in imports() if not _beside(n) and _beside(t)}
    assert sorted(inside) == []
    upward = {(n, t) for n, t, _ in imports() if _beside(n) and t.startswith("pipeline.commands")}
    assert sorted(upward) == []


def _beside(name: str) -> bool:
    return name.split(".")[0] == BESIDE


def test_no_circle_of_modules() -> None:
    left = {name: set() for name in modules()}
    for name, target, _ in imports():
        left[name].add(target)
    while free := [name for name, needs in left.items() if not needs]:
        for name in free:
            del left[name]
        for needs in left.values():
            needs.difference_update(free)
    assert sorted(left) == []


def test_every_module_is_in_a_known_package() -> None:
    for name, path in modules().items():
        assert package(name) == name or path.name != "__init__.py", f"{name} is not in ORDER"


def test_no_class_name_stands_twice() -> None:
    """Two classes of one name are one thing written twice, or two that need two names."""
    names = Counter(
        node.name
        for path in modules().values()
        for node in nodes(path)
        if isinstance(node, ast.ClassDef)
    )
    assert [name for name, count in names.items() if count > 1] == []


def test_the_table_of_a_package_names_its_modules() -> None:
    """Rows of the table in a package's docstring; the table of `pipeline` names packages too."""
    for name, path in modules().items():
        text = ast.get_docstring(tree(path)) or ""
        if path.name != "__init__.py" or "| module" not in text:
            continue
        inside = {p.stem for p in path.parent.glob("*.py")} - {"__init__"}
        inside |= {p.parent.name for p in path.parent.glob("*/__init__.py")}
        assert sorted(re.findall(r"^\| `(\w+)`", text, re.MULTILINE)) == sorted(inside), name


def test_the_table_of_the_pipeline_is_the_order_of_the_packages() -> None:
    text = ast.get_docstring(tree(modules()["pipeline"])) or ""
    flat = {p.stem for p in modules()["pipeline"].parent.glob("*.py")} - {"__init__", "cli"}
    rows = re.findall(r"^\| `([\w.]+)`", text, re.MULTILINE)
    assert flat < set(rows)
    listed = [name for name in ORDER if name != "pipeline" and not _beside(name)]
    packages = [name.removeprefix("pipeline.") for name in listed]
    assert [row for row in rows if row not in flat] == packages


def test_every_module_named_as_text_is_there() -> None:
    """A name in a string or a docstring that no longer resolves guards nothing."""
    wrong = []
    places = [ROOT / name for name in ("tests", "benchmarks", *FOLDERS, BESIDE)]
    for path in sorted(file for place in places for file in place.rglob("*.py")):
        for node in nodes(path):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                wrong += [
                    f"{path.relative_to(ROOT)}, line {node.lineno}: {text}"
                    for text in NAMED_AS_TEXT.findall(node.value)
                    if not _resolves(text)
                ]
    assert wrong == []


def _resolves(text: str) -> bool:
    """Whether a dotted name is a module, or a name in one."""
    name = _own(text)
    head, _, tail = name.rpartition(".")
    if name in modules():
        return True
    return head in modules() and bool(
        re.search(rf"^(?:class |def )?{tail}\b", modules()[head].read_text(), re.MULTILINE)
    )


def test_installing_puts_one_name_into_an_environment() -> None:
    assert importlib.util.find_spec("camwright") is not None
    elsewhere = [place for place in sys.path if Path(place or ".").resolve() != ROOT]
    for folder in FOLDERS:
        assert not any((Path(place) / folder / "__init__.py").is_file() for place in elsewhere)


def _written_past_the_fields(node: ast.AST) -> bool:
    """Whether `__dict__` is read, or ``vars(value)`` written."""
    if isinstance(node, ast.Attribute):
        return node.attr == "__dict__" or (
            _is_vars(node.value) and node.attr in ("update", "setdefault", "pop", "clear")
        )
    if isinstance(node, ast.Subscript):
        return _is_vars(node.value) and not isinstance(node.ctx, ast.Load)
    return False


def _is_vars(node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and getattr(node.func, "id", "") == "vars"


@pytest.mark.parametrize("text", [
    'part.__dict__["cams"] = chosen', "vars(self).update(known)", 'vars(cycle)["length"] = length',
])  # fmt: skip
def test_a_write_past_the_fields_is_seen(text: str) -> None:
    assert any(map(_written_past_the_fields, ast.walk(ast.parse(text))))


def test_no_value_is_written_past_its_fields() -> None:
    """A frozen value keeps what it computes in a field, see `pipeline.base.kept_results`."""
    wrong = [
        f"{name}, line {node.lineno}"  # type: ignore[attr-defined]
        for name, path in modules().items()
        for node in nodes(path)
        if _written_past_the_fields(node)
    ]
    assert wrong == []


INSIDE = (
    "geometry", "meshes", "pipeline.torque", "pipeline.engine", "pipeline.contact",
    "pipeline.follower", "pipeline.cycle", "pipeline.checks", "pipeline.smoothing", "pipeline",
)  # fmt: skip
UNIT_FACTORS = {1e3, 1e-3, 1e6, 1e-6}
TO_UNITS = {"degrees", "rad2deg"}
RIM = re.compile(r"record|columns|arrays|statement|words|(^|_)write_|^__str__$|^plot$|^figure$")
"""Functions that make records, columns, files, messages and figures."""


NO_UNIT = {
    "geometry.cad_drawing": "DXF arcs are drawn in degrees",
    "meshes.mesh_quality": "the quality gates of meshes are angles in degrees",
    "meshes.outline": "a share of a size",
    "pipeline.contact.elasticity.active_set": "a share of a settlement",
    "pipeline.torque.angle_trace": "whether the angles of a file are in degrees",
    "pipeline.engine.indicated_cycle_solver": "steps at whole degrees",
    "pipeline.follower.bearing_life": "formulas of ISO 281 and of a maker in mm2/s and mm",
    "pipeline.follower.elastic_follower": "a share of a speed",
    "pipeline.follower.guide_contact": "a regularisation",
    "pipeline.smoothing.allowables": "a million turns",
}


def _unit_factors(node: ast.AST) -> Iterator[int]:
    """Lines that convert a unit, but for messages and the functions of `RIM`."""
    if isinstance(node, ast.FunctionDef) and RIM.search(node.name):
        return
    if isinstance(node, ast.JoinedStr | ast.Raise):
        return
    if isinstance(node, ast.Call):
        name = getattr(node.func, "attr", getattr(node.func, "id", ""))
        if name in TO_UNITS:
            yield node.lineno
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
        for side in (node.left, node.right):
            if isinstance(side, ast.Constant) and side.value in UNIT_FACTORS:
                yield node.lineno
    for child in ast.iter_child_nodes(node):
        yield from _unit_factors(child)


def test_units_are_converted_at_the_rim() -> None:
    """Inside all values are SI; case reading, columns, records and messages convert."""
    found = [
        f"{name}, line {line}"
        for name, path in modules().items()
        if name not in NO_UNIT
        if package(name) in INSIDE or package(name).startswith("pipeline.contact")
        for line in _unit_factors(tree(path))
    ]
    assert found == []


_FREE, _COLUMN = "free variable of the synthesis", "column of the cycle"
_GROUP = "group of checks, by the id of the one that is its constraint"
_DRAWN = "limits in the figures of a run on disk, by the ids of its records"
NAME_CHECKS = {
    "geometry.cam_size": "limit of a pitch curve",
    "pipeline.base.missing_kinds": "kind of a motion",
    "pipeline.case.cards.substitution": _FREE,
    "pipeline.case.closure_tables": "key of a cam",
    "pipeline.case.limits": "row of the table of limits",
    "pipeline.case.value_sources": "key of a cam",
    "pipeline.case.requirements_section": _FREE,
    "pipeline.checks.demands": _GROUP,
    "pipeline.cycle.cycle": _COLUMN,
    "pipeline.contact.rolling_bearing": "key of a bearing",
    "pipeline.cycle.guide_pressure": "array of the guides",
    "pipeline.cycle.part_loads": _COLUMN,
    "pipeline.cycle.rolling_history": _COLUMN,
    "pipeline.cycle.valve_cam": "number of a valve train",
    "pipeline.follower.elastic_follower": "number of an elastic follower",
    "pipeline.follower.flat_face_motion": _COLUMN,
    "pipeline.iteration": "fact of a design in a notebook",
    "pipeline.recomputation": _FREE,
    "pipeline.records.trial_contents": "figure of the record of a trial",
    "pipeline.results.run_records": "figure of the record of a trial",
    "pipeline.search.figures": "figure of a judgement",
    "pipeline.smoothing.problem_setup": _FREE,
    "reports.analysis_sheet": _DRAWN,
    "reports.arrangement_data": _DRAWN,
    "reports.part_figures": _DRAWN,
    "reports.picture_list": _DRAWN,
    "reports.report_content": "figure of the record of a trial",
    "validation.figures_2015_valve": "word of a title",
    "validation.petrescu_2015": "figure of the record of a paper",
}
"""Modules in which the id of a check is a string besides its declaration, and what it names."""


@cache
def naming_checks() -> tuple[dict[str, str], dict[str, set[str]]]:
    """Module that declares each check, by its id; modules in which the id is a string."""
    from camwright.pipeline.checks import registry

    home = {each.id: _own(module.__name__) for module in (registry, *registry.MODULES)
            for each in registry.declared_in(module)}  # fmt: skip
    named: dict[str, set[str]] = {name: set() for name in home}
    for module, path in modules().items():
        for node in nodes(path):
            if isinstance(node, ast.Constant) and node.value in home:
                named[node.value].add(module)
    return home, named


def test_the_facts_of_a_check_stand_in_its_declaration() -> None:
    """No other module gains a table by the ids of checks; one that loses it leaves the list."""
    home, named = naming_checks()
    naming = {module for name, of in named.items() for module in of - {home[name]}}
    assert naming == set(NAME_CHECKS)


def test_the_id_of_a_check_is_a_string_in_one_module_and_one_that_draws_it() -> None:
    """Where the word names something else, it is no id."""
    home, named = naming_checks()
    of_ids = {module for module, what in NAME_CHECKS.items() if what in (_DRAWN, _GROUP)}
    reports = {module for module, what in NAME_CHECKS.items() if what == _DRAWN}
    several = {name: of & (of_ids | {home[name]}) for name, of in named.items()}
    assert {name: of for name, of in several.items() if len(of - reports) > 1} == {}
    assert {name: of for name, of in several.items() if len(of & reports) > 1} == {}


class Kinds(NamedTuple):
    """Kinds of a part: their classes, their words in a case, attributes that are None of others."""

    classes: frozenset[str]
    words: frozenset[str]
    attributes: frozenset[str]

    def branches(self, node: ast.AST) -> bool:
        """Whether a node of the syntax tree branches on the kind."""
        if isinstance(node, ast.Call) and _name(node.func) == "isinstance":
            return bool(self.classes & {_name(each) for each in ast.walk(node.args[1])})
        if isinstance(node, ast.MatchClass):
            return _name(node.cls) in self.classes
        if isinstance(node, ast.Compare):
            sides = [node.left, *node.comparators]
            values = {each.value for each in sides if isinstance(each, ast.Constant)}
            return bool(self.words & values) or (None in values and any(map(self._is_of, sides)))
        if isinstance(node, ast.BoolOp):
            return any(map(self._is_of, node.values))
        return isinstance(node, ast.If | ast.IfExp) and self._is_of(node.test)

    def _is_of(self, node: ast.AST) -> bool:
        return _name(node) in self.attributes


def _name(node: ast.AST) -> str:
    return str(getattr(node, "attr", getattr(node, "id", "")))


FOLLOWERS = Kinds(
    classes=frozenset({
        "Roller", "FollowerFace", "RollerMotion", "FaceMotion", "RollerContour", "FlatFaceContour",
        "PitchCurve", "FacePath", "ArmPath", "ArmContour", "ArmMotion", "RoundMotion",
        "ArmFacePath", "ArmFaceContour", "ArmFaceMotion", "CurvedFacePath", "CurvedFaceContour",
        "CurvedFaceMotion", "PlaneMotion", "Sliding",
        "RollerBody", "RingBody", "FaceBody", "RollerShapes", "FaceShapes",
    }),
    words=frozenset({"roller", "face", "flat", "oscillating"}),
    attributes=frozenset({"roller", "roller_given", "face"}),
)  # fmt: skip
SPRINGS = Kinds(
    classes=frozenset(
        {"HelicalSpring", "GasSpring", "TorsionSpring", "PivotSpring", "ExtensionSpring", "Coil"}
    ),
    words=frozenset({"coil", "gas", "torsion", "torsion_pivot", "extension"}),
    attributes=frozenset({"gas", "torsion", "torsion_pivot", "extension"}),
)
_READS, _DRAWS = "reads the tables of a case", "draws the parts of a run on disk"
ASK_FOR_A_KIND = {
    FOLLOWERS: {
        "geometry.second_track": "second roller of a stem, or of an arm",
        "pipeline.case.added_tables": _READS,
        "pipeline.case.case": _READS,
        "pipeline.case.case_file": "refuses a face too narrow for the lift of its case",
        "pipeline.case.consistency": _READS,
        "pipeline.case.given_lift": "lift of an eccentric, which the follower decides",
        "pipeline.case.machine": "narrows the follower to the kind that a check needs",
        "pipeline.case.parts_section": _READS,
        "pipeline.cycle.loaded_cam": "narrows the motion to the kind that a measure needs",
        "pipeline.screening.design_screening": "refuses designs with too narrow a face",
        "pipeline.search.sizes.open_case": _READS,
        "pipeline.search.sizes.shapes": "chooses the shapes of the kind",
        "pipeline.search.sizes.size_chart": "chooses the panels of the kind",
        "pipeline.search.sizes.sizing": "narrows the shapes to those with an open roller",
        "reports.arrangement_data": _DRAWS,
        "reports.drawing.arrangement": _DRAWS,
        "reports.scene_second": _DRAWS,
    },
    SPRINGS: {
        "pipeline.checks.gas_spring": "narrows the spring to the kind that a measure needs",
        "pipeline.checks.shaped_springs": "narrows the spring to the kind that a measure needs",
        "reports.drawing.arrangement": _DRAWS,
        "reports.part_figures": _DRAWS,
    },
}
"""Modules that branch on a kind of follower or spring outside its own modules, and why."""


@pytest.mark.parametrize("text", [
    "isinstance(part, Roller | None)", "x = part.face is None", 'case.kind == "flat"',
    "a if machine.roller else b", "machine.face or other", "match part:\n    case Roller(): pass",
])  # fmt: skip
def test_a_branch_on_a_kind_is_seen(text: str) -> None:
    assert any(map(FOLLOWERS.branches, ast.walk(ast.parse(text))))


@pytest.mark.parametrize("kinds", ASK_FOR_A_KIND, ids=["follower", "spring"])
def test_a_part_is_asked_for_its_members_and_not_for_its_kind(kinds: Kinds) -> None:
    """A new branch is a member of the kinds; a module that loses its last leaves the list."""
    asking = {
        name for name, path in modules().items() for node in nodes(path) if kinds.branches(node)
    }
    assert asking == set(ASK_FOR_A_KIND[kinds])
