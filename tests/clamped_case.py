"""A shipped case whose cam is clamped on its shaft: its synthesis keeps the keyway's root, too."""

from dataclasses import replace
from pathlib import Path

from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.contact.shrink_fit import SeatFit

SLIP = {"gx120-redesign": 115.0, "gx120-arm": 115.0, "gx120-flat-face": 130.0}  # N m


def read_clamped(path: Path) -> Case:
    """The case with a clearance and a slip torque in place of its press fit, if it has one."""
    case = read_case(path)
    fit = case.cam.fit
    if fit is None or fit.greatest_interference <= 0.0:
        return case
    loose = SeatFit(least_interference=-10e-6, greatest_interference=0.0, source="made up")
    cam, camshaft = (
        replace(case.cam, fit=loose),
        replace(case.camshaft, slip_torque=SLIP[case.name]),
    )
    return case.model_copy(update={"cam": cam, "camshaft": camshaft})
