"""A check of made-up figures, as no function of the product declares it."""

from typing import Any

from camwright.pipeline.base.verdict import Sense
from camwright.pipeline.checks.check import Check, check, made_from_others


def made_check(
    name: str,
    demand: float | None,
    limit: float | None,
    *,
    unit: str = "-",
    sense: Sense = "at_most",
    lift_can_help: bool = False,
    **values: Any,
) -> Check:
    """A check by its id; demand and limit in SI, `values` are further fields of `Check`."""
    declared = check(
        id=name,
        title=name,
        unit=unit,
        sense=sense,
        method="none: made up",
        lift_can_help=lift_can_help,
    )(made_from_others)
    words = {"title": name, "source": "made up", "method": "none: made up"}
    return Check(declared, demand, limit, **(words | values))
