"""STEP file (ISO 10303-21) of one part: header, product, and the entities of its solid.

The application protocol is AP214, `automotive_design`, which every CAD program reads; lengths are
in millimetres. The text has no date of its writing and no random identifier.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from camwright.geometry.arrays import Array

NO_DATE = "1970-01-01"
"""Date of a file without a stated one, the same for the same cam."""

_UNCERTAINTY = "1.E-06"  # mm
_PLAIN = re.compile(r"[\x20-\x7e]*")
_STAMP = re.compile(r"'(case|results) SHA-256 [^']*'")


@dataclass(frozen=True)
class PartTitle:
    """Product and header of a STEP file.

    Parameters
    ----------
    name : str       of the product
    number : str     part number; "": the name
    revision, project, author : str
    material : str
    date : str       such as 2026-01-31; "": none
    """

    name: str
    number: str = ""
    revision: str = ""
    project: str = ""
    author: str = ""
    material: str = ""
    date: str = ""


class Entities:
    """Data section of a STEP file: entities in order, each written once."""

    def __init__(self) -> None:
        self._numbers: dict[str, str] = {}

    def add(self, kind: str, *values: object) -> str:
        """Add an entity; its reference, such as ``#12``."""
        return self.add_text(f"{kind}({','.join(str(value) for value in values)})")

    def add_text(self, text: str) -> str:
        """Add an entity by its text; its reference."""
        return self._numbers.setdefault(text, f"#{len(self._numbers) + 1}")

    def point(self, at: Sequence[float] | Array) -> str:
        """CARTESIAN_POINT, mm."""
        return self.add("CARTESIAN_POINT", "''", listed(real(value) for value in at))

    def direction(self, along: Sequence[float] | Array) -> str:
        """DIRECTION."""
        return self.add("DIRECTION", "''", listed(real(value) for value in along))

    def frame(
        self, at: Sequence[float] | Array, axis: Sequence[float], first: Sequence[float] | Array
    ) -> str:
        """AXIS2_PLACEMENT_3D: origin, mm, axis z and direction of x."""
        places = self.point(at), self.direction(axis), self.direction(first)
        return self.add("AXIS2_PLACEMENT_3D", "''", *places)

    def __str__(self) -> str:
        return "".join(f"{number}={text};\n" for text, number in self._numbers.items())


def real(value: float) -> str:
    """Text of a float as a real of ISO 10303-21, exact to the last bit."""
    mantissa, _, exponent = repr(float(value) + 0.0).partition("e")
    mantissa = mantissa if "." in mantissa else f"{mantissa}."
    return f"{mantissa}E{exponent}" if exponent else mantissa


def quoted(text: str) -> str:
    """Text as a string of ISO 10303-21; letters beyond ASCII by their code points."""
    plain = text.replace("\\", "\\\\").replace("'", "''")
    if _PLAIN.fullmatch(plain):
        return f"'{plain}'"
    letters = (each if _PLAIN.fullmatch(each) else f"\\X4\\{ord(each):08X}\\X0\\" for each in plain)
    return f"'{''.join(letters)}'"


def listed(values: Iterable[object]) -> str:
    """Text of an aggregate of ISO 10303-21."""
    return f"({','.join(str(value) for value in values)})"


def step_text(title: PartTitle, remarks: Sequence[str], entities: Entities, solid: str) -> str:
    """Text of a STEP file of one product with one solid.

    Parameters
    ----------
    title : PartTitle
    remarks : sequence    further lines of the header's description
    entities : Entities   of the solid; receives those of the product
    solid : str           reference of the solid
    """
    _add_product(title, entities, solid)
    lines = (
        title.name,
        *remarks,
        f"material {title.material or 'not stated'}",
        "case SHA-256 not stated",
        "results SHA-256 not stated",
    )
    return (
        "ISO-10303-21;\nHEADER;\n"
        f"FILE_DESCRIPTION({listed(quoted(line) for line in lines)},'2;1');\n"
        f"FILE_NAME({quoted(title.name)},'{title.date or NO_DATE}T00:00:00',"
        f"({quoted(title.author)}),(''),'Camwright','Camwright','');\n"
        "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\n"
        f"DATA;\n{entities}ENDSEC;\nEND-ISO-10303-21;\n"
    )


def stamped(text: str, case: str, results: str) -> str:
    """STEP text with the hashes of case and results in its header."""
    hashes = {"case": case, "results": results}
    head, end, data = text.partition("ENDSEC;")
    return _STAMP.sub(lambda match: f"'{match[1]} SHA-256 {hashes[match[1]]}'", head) + end + data


def _add_product(title: PartTitle, entities: Entities, solid: str) -> None:
    """Product with its definition, and the solid as its shape in millimetres and radians."""
    add, text = entities.add, entities.add_text
    context = add("APPLICATION_CONTEXT", "'core data for automotive mechanical design processes'")
    add(
        "APPLICATION_PROTOCOL_DEFINITION",
        "'international standard','automotive_design'",
        2000,
        context,
    )
    discipline = add("PRODUCT_CONTEXT", "''", context, "'mechanical'")
    name, number = quoted(title.name), quoted(title.number or title.name)
    product = add("PRODUCT", number, name, quoted(title.project), listed([discipline]))
    add("PRODUCT_RELATED_PRODUCT_CATEGORY", "'part'", "$", listed([product]))
    version = add("PRODUCT_DEFINITION_FORMATION", quoted(title.revision), "''", product)
    stage = add("PRODUCT_DEFINITION_CONTEXT", "'part definition'", context, "'design'")
    definition = add("PRODUCT_DEFINITION", "'design'", "''", version, stage)
    shape = add("PRODUCT_DEFINITION_SHAPE", "''", "''", definition)
    length = text("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
    angle = text("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
    solid_angle = text("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
    accuracy = add(
        "UNCERTAINTY_MEASURE_WITH_UNIT",
        f"LENGTH_MEASURE({_UNCERTAINTY})",
        length,
        "'distance_accuracy_value','confusion accuracy'",
    )
    units = text(
        "(GEOMETRIC_REPRESENTATION_CONTEXT(3)"
        f"GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({accuracy}))"
        f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid_angle}))"
        "REPRESENTATION_CONTEXT('',''))"
    )
    axes = entities.frame((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    form = add("ADVANCED_BREP_SHAPE_REPRESENTATION", name, listed([axes, solid]), units)
    add("SHAPE_DEFINITION_REPRESENTATION", shape, form)
