"""Case file to `Case`: everything a run needs, resolved, in SI units."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal, Self

from pydantic import Field, PrivateAttr, ValidationError, model_validator

from geometry.errors import InputError
from pipeline.cards.fill import filled
from pipeline.case_checks import check_sections
from pipeline.case_fields import Name, Section, Text
from pipeline.case_folder import inside
from pipeline.case_text import to_toml
from pipeline.design_fields import (
    Limits,
    LoadCase,
    Mechanism,
    Smoothing,
    Solver,
    Tolerances,
    Waiver,
)
from pipeline.engine_fields import (
    KINDS,
    Crankshaft,
    Engine,
    engine_files,
)
from pipeline.given_lift import contour_of, given_lift
from pipeline.lift_fields import LIFT_KINDS, GivenLift, LiftTable
from pipeline.part_fields import (
    Cam,
    Camshaft,
    Face,
    Follower,
    Guides,
    Material,
    Oil,
    Roller,
    Spring,
    ValveTrain,
)
from pipeline.results import hash_inputs
from pipeline.shop_fields import Shop

CASE_BYTES = 256 * 1024
INCLUDE_BYTES = 16 * 1024 * 1024
INPUTS = "inputs"
SCHEMA_VERSION = 1


class Case(Section):
    """One design and the states it has to bear."""

    schema_version: Literal[1]
    name: Name
    title: Text = ""
    notes: Text = ""
    engine: Engine | None = None
    crankshaft: Crankshaft | None = None
    lift: GivenLift | None = None
    mechanism: Mechanism = Mechanism()
    spring: Spring
    cam: Cam
    camshaft: Camshaft | None = None
    valve_train: ValveTrain | None = None
    roller_given: Annotated[Roller | None, Field(alias="roller")] = None
    follower: Follower
    guides: Guides
    lubricant: Oil | None = None
    materials: Annotated[dict[Name, Material], Field(min_length=1, max_length=64)]
    smoothing: Smoothing = Smoothing()
    limits: Limits = Limits()
    solver: Solver = Solver()
    tolerances: Tolerances = Tolerances()
    shop: Shop = Shop()
    waivers: Annotated[tuple[Waiver, ...], Field(strict=False, max_length=64)] = ()
    load_cases: Annotated[
        tuple[LoadCase, ...], Field(alias="load_case", strict=False, min_length=1, max_length=64)
    ]

    _included: Mapping[str, bytes] = PrivateAttr(default_factory=dict)
    _folder: Path | None = PrivateAttr(default=None)

    @model_validator(mode="after")
    def _fits_together(self) -> Self:
        check_sections(self)
        return self

    def to_toml(self) -> str:
        """The case with every default written out; reads back bit for bit.

        Included files are named as they are kept in a run folder, ``inputs/NAME``.
        """
        return to_toml(self, {name: kept_as(name) for _, name in includes(self)})

    @property
    def included(self) -> Mapping[str, bytes]:
        """Bytes of each included file, by its name in a run folder."""
        return self._included

    @property
    def sha256(self) -> str:
        """Hash of all that decides the result: the resolved case and the included files."""
        return hash_inputs(self.to_toml(), self._included)

    def with_positions(self, positions: int) -> Case:
        """The same case at another number of positions per cam turn."""
        given = self.solver.model_dump() | {"positions": positions}
        try:
            solver = Solver.model_validate(given)
        except ValidationError as error:
            raise _first_error(error, "solver") from None
        return self.model_copy(update={"solver": solver})

    def at(self, load_case: str) -> Case:
        """The case as one of its load cases has it: with the preload of that state."""
        own = next(state.preload for state in self.load_cases if state.name == load_case)
        if own is None:
            return self
        return self.model_copy(update={"spring": self.spring.model_copy(update={"preload": own})})

    def path(self, name: str) -> Path:
        """Where an included file lies; `name` as the case file has it."""
        if self._folder is None:
            raise InputError("case", name, "read from a file to include others")
        return self._folder / name

    @property
    def roller(self) -> Roller:
        """The roller of a case whose follower has one.

        Raises
        ------
        InputError
            If it has none.
        """
        if self.roller_given is None:
            if self.follower.kind == "flat":
                raise InputError("follower.kind", "flat", '"roller" for what only a roller has')
            raise InputError("roller", "missing", 'given with follower.kind = "roller"')
        return self.roller_given

    @property
    def facing(self) -> Roller | Face:
        """The part of the follower that touches the cam."""
        return self.roller if self.follower.face is None else self.follower.face

    @property
    def facing_field(self) -> str:
        """Dotted name of that part's table."""
        return "roller" if self.follower.face is None else "follower.face"

    @property
    def base_circle(self) -> float:
        """Radius of the cam's surface where the lift is zero, m."""
        inset = 0.0 if self.roller_given is None else self.roller_given.radius
        return self.cam.pitch_base_radius - inset

    @property
    def contact_radius(self) -> float:
        """Radius that stands for the contact, m: the roller's, under a face the base circle's."""
        return self.base_circle if self.roller_given is None else self.roller_given.radius

    def material(self, name: str) -> Material:
        """The card of a material that the case names."""
        return self.materials[name]


def load_case_file(path: str | Path) -> Case:
    """Read and check a case file.

    Raises
    ------
    InputError
        For the first thing that is wrong, by its dotted name.
    """
    path = Path(path)
    return parse_case(_read(path, "case", CASE_BYTES), path.resolve().parent)


def parse_case(content: str | bytes, folder: Path | None = None) -> Case:
    """A case from its text; included files are looked for in `folder`."""
    data = _parse_toml(content)
    version = data.get("schema_version")
    if version is not None and version != SCHEMA_VERSION:
        raise InputError("schema_version", version, f"{SCHEMA_VERSION}, the one known here")
    case = case_of(data, folder)
    case._folder = folder
    case._included = MappingProxyType(_read_includes(case, folder))
    if case.lift is not None and case.follower.face is not None:
        contour_of(case, given_lift(case))  # refuses a face that the contact runs off
    return case


def case_of(data: Mapping[str, Any], folder: Path | None = None) -> Case:
    """A case from its tables, cards of `folder` filled in; files it includes are not read."""
    try:
        return Case.model_validate(filled(data, folder))
    except ValidationError as error:
        raise _first_error(error) from None


def includes(case: Case) -> Iterator[tuple[str, str]]:
    """Dotted field and file name of every file a case draws in."""
    yield from engine_files(case.engine)
    if isinstance(case.lift, LiftTable):
        yield "lift.file", case.lift.file
    for k, load_case in enumerate(case.load_cases):
        if load_case.torque is not None:
            yield f"load_case[{k}].torque", load_case.torque


def kept_as(name: str) -> str:
    """Where a run folder keeps an included file."""
    return f"{INPUTS}/{Path(name).name}"


def _parse_toml(content: str | bytes) -> dict[str, Any]:
    try:
        text = content if isinstance(content, str) else content.decode("utf-8-sig")
        return tomllib.loads(text)
    except RecursionError:
        raise InputError("case", "nested too deeply", "at most a few tables deep") from None
    except ValueError as error:  # UnicodeDecodeError and TOMLDecodeError alike
        raise InputError("case", " ".join(str(error).split()), "UTF-8 text in TOML") from None


def _read(path: Path, field: str, limit: int) -> bytes:
    try:
        if not path.is_file():
            raise InputError(field, str(path), "an existing file")
        with path.open("rb") as file:
            content = file.read(limit + 1)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else error
        raise InputError(field, f"{path} ({reason})", "a readable file") from None
    if len(content) > limit:
        raise InputError(field, f"{path} is larger", f"at most {limit // 1024} KiB")
    return content


def _read_includes(case: Case, folder: Path | None) -> dict[str, bytes]:
    read: dict[str, bytes] = {}
    origin: dict[str, str] = {}
    for field, name in includes(case):
        if folder is None:
            raise InputError(field, name, "left out where a case has no folder")
        content = _read(inside(folder, name, field), field, INCLUDE_BYTES)
        kept = kept_as(name)
        if origin.setdefault(kept, name) != name:
            raise InputError(field, name, f"another file name than that of {origin[kept]}")
        read[kept] = content
    return read


_WORDS = {
    "missing": "given",
    "string_type": "text in quotes",
    "int_type": "a whole number",
    "bool_type": "true or false",
    "model_type": "a table",
    "dict_type": "a table",
    "model_attributes_type": "a table",
    "tuple_type": "an array of tables",
    "date_type": "a date such as 2025-06-30",
    "union_tag_not_found": "a table with kind = " + " or ".join(f'"{kind}"' for kind in KINDS),
    "too_short": "at least {min_length} long",
    "too_long": "at most {max_length} long",
    "string_too_short": "at least {min_length} characters",
    "string_too_long": "at most {max_length} characters",
    "greater_than_equal": ">= {ge}",
    "less_than_equal": "<= {le}",
    "literal_error": "{expected}",
    "union_tag_invalid": "{expected_tags}",
    "limit": "{limit}",
}


def _first_error(error: ValidationError, section: str = "") -> InputError:
    """The first refusal as one line; unknown keys go before what is missing for them."""
    found = error.errors(include_url=False)
    found.sort(key=lambda entry: "unknown_key" not in entry.get("ctx", {}))
    first, others = found[0], len(found) - 1
    context = dict(first.get("ctx", {}))
    field, value = f"{section}.{_dotted(first['loc'])}".strip("."), first["input"]
    if "unknown_key" in context:
        field = f"{field}.{context['unknown_key']}".lstrip(".")
        value = "unknown key"
    elif first["type"] == "missing":
        value = "missing"
    elif first["type"] == "union_tag_invalid":
        field, value = f"{field}.kind", context["tag"]
    elif isinstance(value, (dict, list)):
        value = "a table" if isinstance(value, dict) else "an array"
    limit = _WORDS.get(first["type"], first["msg"]).format_map(context)
    more = f" (and {others} more)" if others else ""
    return InputError(field or "case", value, f"{limit}{more}")


def _dotted(location: tuple[int | str, ...]) -> str:
    """``("load_case", 0, "speed")`` as ``load_case[0].speed``; the tag of a union is left out."""
    text = ""
    for position, part in enumerate(location):
        if position == 1 and part in {"engine": KINDS, "lift": LIFT_KINDS}.get(
            str(location[0]), ()
        ):
            continue
        text += f"[{part}]" if isinstance(part, int) else f".{part}"
    return text.lstrip(".")
