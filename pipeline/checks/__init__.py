"""One function a limit."""

from pipeline.checks.check import Check
from pipeline.checks.everything import all_checks, design_checks
from pipeline.checks.trial import TrialEvidence
from pipeline.checks.verdict import binding, in_order, verdict

__all__ = [
    "Check",
    "TrialEvidence",
    "all_checks",
    "binding",
    "design_checks",
    "in_order",
    "verdict",
]
