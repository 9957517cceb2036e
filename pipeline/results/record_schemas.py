"""JSON Schemas, draft 2020-12, of the records, generated from their forms on demand."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from camwright.geometry.errors import InputError
from camwright.pipeline.records.check_document import CheckDocument, SeveralTargets
from camwright.pipeline.records.check_record import CheckRecord
from camwright.pipeline.records.corners_document import CornersDocument
from camwright.pipeline.records.crown_document import CrownDocument
from camwright.pipeline.records.design_document import DesignDocument
from camwright.pipeline.records.forms import Schema
from camwright.pipeline.records.inspection_document import InspectionDocument
from camwright.pipeline.records.live_document import LiveDocument
from camwright.pipeline.records.redesign_document import RedesignDocument
from camwright.pipeline.records.run_summary import Summary
from camwright.pipeline.records.signoff_record import SignoffRecord
from camwright.pipeline.records.size_document import SizeDocument
from camwright.pipeline.records.study_document import StudyDocument
from camwright.pipeline.records.trial_contents import TrialContents

NAMES = {
    "run": "run.json",
    "trial": "trial.json",
    "checks": "6_checks.json",
    "check": "output of camwright check --json",
    "signoff": "signoff.json",
    "corners": "corners.json",
    "crown": "crown.json, output of camwright design crown --json",
    "size": "output of camwright design sizes --json",
    "redesign": "redesign.json, output of camwright design parts --json",
    "design": "design.json, output of camwright design machine --json",
    "inspect": "inspection.json, output of camwright inspect --json",
    "study": "study.json",
    "live": "8_live.json",
}
"""Names of the schemas and the documents that they describe."""
_FORMS: Mapping[str, Any] = {
    "run": Summary,
    "trial": TrialContents,
    "checks": list[CheckRecord],
    "check": CheckDocument | SeveralTargets,
    "signoff": SignoffRecord,
    "corners": CornersDocument,
    "crown": CrownDocument,
    "size": SizeDocument,
    "redesign": RedesignDocument,
    "design": DesignDocument,
    "inspect": InspectionDocument,
    "study": StudyDocument,
    "live": LiveDocument,
}


def record_schema(name: str) -> Schema:
    """JSON Schema of a record, self-contained.

    Raises
    ------
    InputError
        If the name is none of `NAMES`.
    """
    from pydantic import TypeAdapter
    from pydantic.json_schema import GenerateJsonSchema

    class Untitled(GenerateJsonSchema):
        """Schemas without a title of each key, which is the key once more."""

        def field_title_should_be_set(self, schema: object) -> bool:  # noqa: ARG002 - of all
            return False

    if name not in NAMES:
        raise InputError("schema", name, f"one of: {', '.join(NAMES)}")
    adapter: TypeAdapter[object] = TypeAdapter(_FORMS[name])
    made = adapter.json_schema(schema_generator=Untitled)
    head = {"$schema": GenerateJsonSchema.schema_dialect, "$id": f"urn:camwright:schema:{name}"}
    return head | made | {"title": NAMES[name]}
