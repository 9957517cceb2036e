"""Record of a sizing, and its text."""

from __future__ import annotations

from collections.abc import Iterator

from camwright.pipeline.base.units import in_unit, shown
from camwright.pipeline.case.case_values import unit_at
from camwright.pipeline.case.limits import SPRING_SURGE
from camwright.pipeline.checks.check import Check
from camwright.pipeline.records.size_document import SizeDocument
from camwright.pipeline.search.sizes.open_case import GAPS, PRELOAD, RATE
from camwright.pipeline.search.sizes.size_chart import chart_record
from camwright.pipeline.search.sizes.sizing import Sizing
from camwright.pipeline.search.sizes.spring_choice import greatest_coil_mass

_MM, _DEG = "mm", "deg"


def size_record(sizing: Sizing) -> SizeDocument:
    """Record of a sizing."""
    case, spring, stroke = sizing.case, sizing.spring, sizing.shapes.parts(sizing.shape).stroke
    return {
        "case": case.name,
        "follower": case.follower.kind,
        "verdict": sizing.verdict,
        "sized": {
            key: {
                "value": in_unit(value, unit_at(key)),
                "unit": unit_at(key),
                "source": sizing.sources[key],
            }
            for key, value in sizing.values.items()
        },
        "smallest": sizing.shapes.record(sizing.exact),
        "drawn": sizing.shapes.record(sizing.shape),
        "spring": {
            "rate_N_per_mm": in_unit(spring.rate, "N/mm"),
            "preload_N": spring.preload,
            "force_at_full_lift_N": spring.size.force(stroke),
            "energy_at_full_lift_J": spring.size.energy(stroke),
            "active_mass_max_g": in_unit(greatest_coil_mass(case, spring.rate), "g"),
        },
        "checks": [each.as_record() for each in sizing.checks],
        "other_failures": list(sizing.others),
        "chart": chart_record(sizing.figure),
    }


def size_lines(sizing: Sizing) -> Iterator[str]:
    """Lines of text on a sizing: values of the open keys with reasons, the cam, the spring, and the
    checks that do not pass.
    """
    if not sizing.values:
        yield f"no key is open; size finds {', '.join(GAPS)}"
    for key, value in sizing.values.items():
        yield f"{key} = {shown(value, unit_at(key), 6)}; {sizing.sources[key]}"
    exact, drawn = sizing.exact, sizing.shape
    if exact.base_radius != drawn.base_radius:
        yield (
            f"base radius {shown(exact.base_radius, _MM, 7)} at the limit of the geometry,"
            f" {shown(drawn.base_radius, _MM, 6)} as drawn"
        )
    yield f"cam: {sizing.shapes.words(sizing.shape)}"
    if {RATE, PRELOAD} & set(sizing.opened.gaps):
        yield _spring_line(sizing)
    for each in sizing.checks:
        if each.status != "pass":
            yield _check_words(each)
    if sizing.no_size:
        yield f"no prime radius up to {shown(sizing.greatest_tried, _MM)} passes these"
    if sizing.others:
        yield f"fails by other keys: {', '.join(sizing.others)}"
    yield f"{sizing.verdict.upper()} in the preview: {len(sizing.checks)} checks of the open keys"


def _spring_line(sizing: Sizing) -> str:
    """Line on the spring: force at full lift and, without a wound spring, the mass that its coils
    may have.
    """
    spring, case = sizing.spring, sizing.case
    stroke = sizing.shapes.parts(sizing.shape).stroke
    words = f"spring: {shown(spring.size.force(stroke), 'N')} at full lift"
    if case.spring.design is not None:
        return words
    mass = greatest_coil_mass(case, spring.rate)
    share = case.limits[SPRING_SURGE]
    return (
        f"{words}; its active coils may weigh {shown(mass, 'g', 3)} for a surge frequency of"
        f" {share:g} times that of the cam"
    )


def _check_words(check: Check) -> str:
    """Check as text; of one that is not evaluated its title and the keys that the case lacks."""
    if check.status == "not_evaluated":
        lacks = f"; the case lacks {', '.join(check.missing)}" if check.missing else ""
        return f"not known: {check.title}{lacks}"
    return str(check)
