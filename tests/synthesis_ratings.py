"""Ratings of a synthesis by keyword: fields of `Ratings`, and rows of the table of limits by id."""

from dataclasses import fields, replace

from camwright.pipeline.case.limits import LIMITS
from camwright.pipeline.smoothing.scenario import Ratings

FIELDS = {each.name for each in fields(Ratings)}


def rated(start=None, **values):
    """The ratings with these values; start: those to change."""
    plain = {name: value for name, value in values.items() if name in FIELDS}
    rows = {LIMITS[name]: value for name, value in values.items() if name not in FIELDS}
    if start is None:
        return Ratings(**plain, limits=rows)
    return replace(start, **plain, limits={**start.limits, **rows})
