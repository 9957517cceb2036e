"""One function a limit."""

from camwright.pipeline.checks.check import Check
from camwright.pipeline.checks.extremes import TrialEvidence
from camwright.pipeline.checks.registry import all_checks, design_checks
from camwright.pipeline.checks.verdict import binding, in_order, verdict

__all__ = [
    "Check",
    "TrialEvidence",
    "all_checks",
    "binding",
    "design_checks",
    "in_order",
    "verdict",
]
