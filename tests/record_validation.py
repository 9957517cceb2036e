"""Violations of the JSON Schemas by an independent validator."""

from functools import cache

from jsonschema import Draft202012Validator

from camwright.pipeline.results.record_schemas import record_schema


@cache
def validator(name: str) -> Draft202012Validator:
    return Draft202012Validator(record_schema(name))


def schema_errors(name: str, document: object) -> list[str]:
    """Place and message of each violation."""
    errors = validator(name).iter_errors(document)
    return [f"{error.json_path}: {error.message}" for error in errors]


def part_errors(name: str, form: str, record: object) -> list[str]:
    """Violations of the form of a part of a record, by the name of its class."""
    whole = record_schema(name)
    part = Draft202012Validator({"$defs": whole["$defs"], "$ref": f"#/$defs/{form}"})
    return [f"{error.json_path}: {error.message}" for error in part.iter_errors(record)]


def keeps_schema(name: str, document: object) -> bool:
    """Whether there is no violation; the search ends at the first one."""
    return validator(name).is_valid(document)
