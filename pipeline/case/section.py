"""Base class of case-file sections; fields for names, materials and parts."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from types import UnionType
from typing import (
    Annotated,
    Any,
    ClassVar,
    Self,
    TypeVar,
    Union,
    get_args,
    get_origin,
)

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    ModelWrapValidatorHandler,
    ValidationError,
    ValidationInfo,
    ValidatorFunctionWrapHandler,
    create_model,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, InitErrorDetails, PydanticCustomError, core_schema

from camwright.geometry.errors import InputError
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import (
    Characters,
    Count,
    In,
    Part,
    Resolved,
    TableSource,
    describes,
    hints_of,
)
from camwright.pipeline.base.source import FORM, Source, source_in

SAFE_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9_.-]{0,38}[A-Za-z0-9_-])?")

PartType = TypeVar("PartType", bound=Part)


def refusal(limit: str, **context: str) -> PydanticCustomError:
    """Validation error that states the limit."""
    return PydanticCustomError("limit", "must be {limit}", {"limit": limit, **context})


def _safe_name(name: str) -> str:
    if not SAFE_NAME.fullmatch(name):
        raise refusal("1 to 40 letters, digits, '_', '-' or '.', starting with a letter or digit")
    return name


Name = Annotated[str, AfterValidator(_safe_name)]
Text = Annotated[str, Characters(0, 10_000)]


@dataclass(frozen=True)
class FromText:
    """Mark of a `Source` field, written as text or as a table of text and confirmation."""

    def __get_pydantic_core_schema__(
        self, source: type[Source], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validation of a field as text or as a table of text and confirmation, into a `Source`;
        for the JSON Schema it is text.
        """

        def made(entry: object, text: ValidatorFunctionWrapHandler) -> Source:
            """Source of an entry; its text is checked by the validator `text`."""
            read = entry if isinstance(entry, Source) else source_in(entry)
            if isinstance(entry, dict) and not read:
                raise refusal(FORM)
            text(entry if isinstance(entry, str) or not read else read.text)
            return read

        return core_schema.no_info_wrap_validator_function(made, handler.generate_schema(Text))


StatedSource = Annotated[Source, FromText()]
"""A field with a source."""
SourceOfTable = Annotated[TableSource, FromText()]
"""A field with the source of the values of its table."""


class Section(BaseModel):
    """Base class of sections: frozen, unknown keys refused.

    `defaults` has, in words, what a field without a value means, `resolved` the keys that the
    reader replaces by what they name.
    """

    resolved: ClassVar[Mapping[str, Resolved]] = {}
    defaults: ClassVar[Mapping[str, str]] = {}

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, defer_build=True)

    @property
    def lacking(self) -> tuple[str, ...]:
        """Names of the fields without a value, unless `defaults` has their meaning."""
        return tuple(
            name
            for name in type(self).model_fields
            if getattr(self, name) is None and name not in self.defaults
        )

    @model_validator(mode="wrap")
    @classmethod
    def _know_every_key(cls, table: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Refuse unknown keys, together with wrong values of the known ones. Missing keys are
        reported only once all are known: a misspelt key is both unknown and missing.
        """
        known = [field.alias or name for name, field in cls.model_fields.items()]
        unknown: list[InitErrorDetails] = [
            {
                "type": refusal(f"a known key{suggestion(key, known)}", unknown_key=str(key)),
                "input": table,
            }
            for key in (table if isinstance(table, dict) else ())
            if key not in known
        ]
        if not unknown:
            return handler(table)
        try:
            handler({key: value for key, value in table.items() if key in known})
        except ValidationError as error:
            unknown += [
                {
                    "type": PydanticCustomError(each["type"], each["msg"], each.get("ctx")),
                    "loc": each["loc"],
                    "input": each["input"],
                }
                for each in error.errors(include_url=False)
                if each["type"] != "missing"
            ]
        except InputError as error:  # by a rule of a table below, which reads its own keys alone
            limit = refusal(error.limit, field=error.field, value=str(error.value))
            unknown.append({"type": limit, "input": table})
        raise ValidationError.from_exception_data(cls.__name__, unknown)


_TOLD = 6
"""Known words that a message tells: a file may have many slips."""


def suggestion(word: str, known: Iterable[str]) -> str:
    """End of a message on an unknown word: the closest known word, else the first of the known
    ones.

    Parameters
    ----------
    word : str         the unknown word
    known : iterable   words that are accepted
    """
    words = list(known)
    if close := difflib.get_close_matches(word, words, n=1):
        return f"; did you mean {close[0]}?"
    more = f" and {len(words) - _TOLD} more" if len(words) > _TOLD + 1 else ""
    return f": {', '.join(words[:_TOLD] if more else words)}{more}"


@dataclass(frozen=True)
class FromTable:
    """Mark of a field whose table is read as a `Part`, with its units and bounds."""

    def __get_pydantic_core_schema__(
        self, source: type[Part], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validation of a table by the section of a part, then into the part; errors keep field,
        value and limit.
        """

        def made(section: Section) -> Part:
            try:
                return part_of(source, section)
            except InputError as error:
                raise refusal(error.limit, field=error.field, value=str(error.value)) from None

        schema = handler.generate_schema(section_of(source))
        return core_schema.no_info_after_validator_function(made, schema)


Table = Annotated[PartType, FromTable()]
"""A field with a `Part`, written as a table."""


def part_of(part: type[PartType], section: Section) -> PartType:
    """Part of a machine made of the values of the section that describes it.

    Parameters
    ----------
    part : type         class of the part
    section : Section   validated

    Raises
    ------
    InputError
        If its values contradict one another, by the name of a field within the table.
    """
    values = {name: getattr(section, name) for name in type(section).model_fields}
    try:
        return part(**values)
    except InputError as error:
        field = error.field.removeprefix(f"{part.table}.")
        raise InputError(field, error.value, error.limit) from None


_SECTIONS: dict[type[Part], type[Section]] = {}  # each made once
_PARTS: dict[type[Section], type[Part]] = {}


def section_of(part: type[Part]) -> type[Section]:
    """Section class with the fields of a part in order, made at the first call."""
    if part not in _SECTIONS:
        made = _section_made_of(part)
        _SECTIONS[part], _PARTS[made] = made, part
    return _SECTIONS[part]


def written_as(section: type[Section]) -> type[Section | Part]:
    """Class whose source has the fields of a section: its part class, else itself."""
    return _PARTS.get(section, section)


def _section_made_of(part: type[Part]) -> type[Section]:
    """Section class with the fields of a part but for its labels, their defaults and docstrings."""
    hints = hints_of(part)
    described: dict[str, Any] = {}
    for field in fields(part):  # type: ignore[arg-type]
        if field.name in part.labels:
            continue
        default = ... if field.default is MISSING else field.default
        described[field.name] = (_in_section(hints[field.name]), default)
    made = create_model(part.__name__, __base__=Section, __doc__=part.__doc__, **described)
    made.resolved, made.defaults = part.resolved, part.defaults
    return made


def _marks_in(field: FieldInfo) -> Iterator[object]:
    """Marks of a field: of its annotation, of the kinds in a union, of the entries of a list."""
    yield from field.metadata
    yield from _marks(field.annotation)


def _marks(hint: object) -> Iterator[object]:
    """All marks of `Annotated` in a type hint, the outer ones first."""
    yield from getattr(hint, "__metadata__", ())
    for each in get_args(hint):
        yield from _marks(each)


def words_at(section: type[Section], name: str) -> Iterator[object]:
    """Marks of a field, describing ones included, which a section of a part lacks."""
    if section in _PARTS:
        return _marks(hints_of(_PARTS[section])[name])
    return _marks_in(section.model_fields[name])


def number_in(field: FieldInfo) -> In | Count | None:
    """Unit and bounds of the number or numbers in a field; None for other fields."""
    return next((mark for mark in _marks_in(field) if isinstance(mark, (In, Count))), None)


def _in_section(hint: Any) -> Any:
    """Type hint of a part's field as its section needs it for reading: names of materials, tables
    of parts, bounds without descriptions.
    """
    if hint is str:
        return Text
    if hint is Source:
        return StatedSource
    if hint is Material:
        return Annotated[Material, MaterialName()]
    if isinstance(hint, type) and issubclass(hint, Part):
        return Annotated[hint, FromTable()]
    if get_origin(hint) is Annotated:
        inner, *marks = get_args(hint)
        rules = [mark for mark in marks if not describes(mark)]
        return Annotated.__class_getitem__((inner, *rules)) if rules else _in_section(inner)
    if get_origin(hint) in (Union, UnionType):
        return Union[tuple(_in_section(each) for each in get_args(hint))]  # noqa: UP007
    if get_origin(hint) is tuple:
        entries: Any = tuple.__class_getitem__((_in_section(get_args(hint)[0]), ...))
        return Annotated[entries, Field(strict=False)]
    return hint


@dataclass(frozen=True)
class MaterialName:
    """Mark of a `Material` field, written in the case as a name."""

    def __get_pydantic_core_schema__(
        self, source: type[Material], handler: GetCoreSchemaHandler
    ) -> CoreSchema:
        """Validation of a name, into the material card of this name in the context."""

        def card(name: str, info: ValidationInfo) -> Material:
            """Material card of a name; refused if the case has none of it."""
            known: Mapping[str, Material] = (info.context or {}).get("materials", {})
            if name not in known:
                raise refusal(f"one of the materials: {', '.join(sorted(known))}")
            return known[name]

        return core_schema.with_info_after_validator_function(
            card, handler.generate_schema(Annotated[str, AfterValidator(_safe_name)])
        )


def named(cards: dict[str, Material]) -> dict[str, Material]:
    """Materials with their table names entered."""
    return {name: replace(card, name=name) for name, card in cards.items()}
