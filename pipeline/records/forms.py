"""Forms of JSON records: bounds of their values, conditions between them, what each key means.

A form is a `TypedDict`: the type of the code that builds and reads a record and, by the docstrings
of its keys, the JSON Schema that `results.record_schemas` makes of it. Reading needs no schema.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, TypeAlias, TypeVar, get_args

from typing_extensions import get_original_bases

from camwright.pipeline.base.field_texts import texts_below

Schema: TypeAlias = dict[str, Any]
Kind = TypeVar("Kind", bound=type)


class JsonBound:
    """Keywords of JSON Schema on a value, such as ``minimum=0``."""

    def __init__(self, **keywords: float | str | bool | list[str]) -> None:
        self.keywords = keywords

    def __get_pydantic_json_schema__(
        self, core: object, handler: Callable[[Any], Schema]
    ) -> Schema:
        return handler(core) | self.keywords


Depth = Literal["screening", "preview", "cycle", "certified"]
DEPTHS: tuple[Depth, ...] = get_args(Depth)
"""Words of `contact.tiers.Tier`, in its order."""
Count: TypeAlias = Annotated[int, JsonBound(minimum=1)]
Least0Count: TypeAlias = Annotated[int, JsonBound(minimum=0)]
Least0: TypeAlias = Annotated[float, JsonBound(minimum=0)]
Least0OrNull: TypeAlias = Annotated[float | None, JsonBound(minimum=0)]
Identifier: TypeAlias = Annotated[str, JsonBound(pattern="^[A-Za-z][A-Za-z0-9_]*$")]
Sha256: TypeAlias = Annotated[str, JsonBound(pattern="^[0-9a-f]{64}$")]
"""SHA-256 of a file or input, hexadecimal."""
Unit: TypeAlias = Annotated[str, JsonBound(minLength=1)]
Versions: TypeAlias = Annotated[
    dict[str, str], JsonBound(required=["camwright", "source", "python"])
]
Time: TypeAlias = Annotated[
    str, JsonBound(pattern="^[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}Z$")
]
"""UTC."""
Names: TypeAlias = Annotated[list[str], JsonBound(uniqueItems=True)]


@dataclass(frozen=True)
class Condition:
    """Condition between the values of a record.

    Parameters
    ----------
    key, words : str, tuple   it holds where the value of the key is one of the words
    then, other : mapping     type of values by key where it holds, and where it does not
    """

    key: str
    words: tuple[str, ...]
    then: Mapping[str, str]
    other: Mapping[str, str] | None = None

    @property
    def schema(self) -> Schema:
        """JSON Schema of the condition: where `key` holds one of `words`, other keys have the types
        `then`, else those of `other`.
        """

        def of_types(types: Mapping[str, str]) -> Schema:
            return {"properties": {key: {"type": kind} for key, kind in types.items()}}

        made = {
            "if": {"properties": {self.key: {"enum": list(self.words)}}},
            "then": of_types(self.then),
        }
        return made if self.other is None else made | {"else": of_types(self.other)}


_FORMS: dict[type, tuple[Sequence[str], Sequence[Condition]]] = {}


def form(
    *, written: Sequence[str] = (), conditions: Sequence[Condition] = ()
) -> Callable[[Kind], Kind]:
    """Class decorator that declares a `TypedDict` as the form of a record: without other keys, each
    key described by the docstring below it in the JSON Schema.

    Parameters
    ----------
    written : sequence      keys that are always written, and that records of earlier versions lack
    conditions : sequence   between its values
    """

    def declared(kind: Kind) -> Kind:
        def complete(schema: Schema) -> None:
            bases: list[type] = [kind, *(each for each in _bases(kind) if each in _FORMS)]
            for each in bases:
                for key, text in texts_below(each).items():
                    schema["properties"][key]["description"] = text
            named = [key for each in bases for key in _FORMS[each][0]]
            schema["required"] = [*schema.get("required", ()), *named]
            if made := [one.schema for each in bases for one in _FORMS[each][1]]:
                schema["allOf"] = made

        _FORMS[kind] = written, conditions
        config = {"extra": "forbid", "json_schema_extra": complete}
        setattr(kind, "__pydantic_config__", config)  # noqa: B010 - no key of the dictionary
        return kind

    return declared


def _bases(kind: type) -> list[type]:
    """Forms of which a form has the keys; at run time a `TypedDict` is a plain dictionary."""
    direct = [each for each in get_original_bases(kind) if isinstance(each, type)]
    return [base for each in direct if each in _FORMS for base in (each, *_bases(each))]
