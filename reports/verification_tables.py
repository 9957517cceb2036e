"""Tables of evidence: certificate, benchmarks, tolerance corners, prices, consistency."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from camwright.pipeline.base.files import Json
from camwright.pipeline.results.check_report import sentence
from camwright.reports.machine_words import MachineWords
from camwright.reports.report_tables import (
    DASH,
    MINUS,
    Record,
    ReportTable,
    number,
    quantity,
    words,
    worst_corner,
)

PRICES_HEAD = (
    "Limit", "Value", "Ripple per unit of relaxation", "Ripple per 1 % of relaxation",
    "Active at cam angle",
)  # fmt: skip
MACHINE_PRICES_HEAD = ("Number", "Value", "Ripple per unit more", "Ripple per 1 % more")
CONSISTENCY_HEAD = ("Quantity", "Load case", "Derivation", "Input", "Implied", "Difference")
SPEED_HEAD = ("Load case", "State", "Standard deviation", "Peak to peak", "Fluctuation")
VALVE_HEAD = ("Quantity", "Load case", "Definition", "Value")
CORNERS_HEAD = ("Check", "Corner", "Nominal demand", "Demand at the corner")
CERTIFICATE_HEAD = (
    "Cam angle, deg", "Edges across a", "Unknowns", "p0 per mesh, MPa", "p0 extrapolated, MPa",
    "Order", "GCI, %", "p0 Hertz, MPa", "p0 of the cycle, MPa", "Deviation, %", "Equilibrium",
)  # fmt: skip
CERTIFIED_HEAD = (
    "Cam angle, deg", "Quantity", "Per mesh", "Extrapolated", "Order", "GCI, %", "Of the cycle",
    "Deviation, %",
)  # fmt: skip
ENDS_HEAD = (
    "Load case", "Cam angle, deg", "Force, N", "Moment, N mm", "Signed pressure", "Half-spaces",
    "Finite elements", "GCI, %", "Ratio", "Middle, finite elements",
)  # fmt: skip
STRESS_HEAD = (
    "Load case", "Cam angle, deg", "Body", "Below", "von Mises, MPa", "at depth, mm",
    "Shear, MPa", "at depth, mm",
)  # fmt: skip
_BELOW = {"centre": "middle", "end1": "end at y < 0", "end2": "end at y > 0"}
CERTIFIED = {
    "half_width_mm": "half-width a, mm",
    "tau_max_MPa": "maximum shear stress, MPa",
    "von_mises_MPa": "maximum von Mises stress, MPa",
}
BENCHMARKS = {
    "nafems_p0": "NAFEMS R0094 case 1, peak pressure",
    "nafems_half_width": "NAFEMS R0094 case 1, half-width",
    "hertz_p0": "roller on a block, peak pressure to Hertz",
    "hertz_half_width": "roller on a block, half-width to Hertz",
}
MEASUREMENT = {
    "runs": ("runs", ""),
    "cycles": ("cycles", ""),
    "wheel": ("trigger wheel", ""),
    "sampling_rate_Hz": ("sampling rate", "Hz"),
    "imep_mean_kPa": ("indicated mean effective pressure, mean", "kPa"),
    "imep_cov_percent": ("indicated mean effective pressure, coefficient of variation", "%"),
    "peak_mean_MPa": ("peak pressure, mean", "MPa"),
    "indicated_torque_Nm": ("indicated torque", "N m"),
    "indicated_torque_per_deg_Nm": ("its change with the dead centre 1 deg earlier", "N m"),
    "brake_torque_Nm": ("brake torque", "N m"),
    "friction_mep_kPa": ("friction mean effective pressure", "kPa"),
    "motored_lead_deg": ("motored peak before the dead centre", "deg"),
    "mean_rad_per_s": ("crank speed, mean", "rad/s"),
    "p2p_rad_per_s": ("crank speed, peak to peak", "rad/s"),
    "scatter_max_rad_per_s": ("crank speed, greatest scatter of the cycles", "rad/s"),
    "bandwidth_Hz": ("bandwidth", "Hz"),
    "torque_error_bar_max_Nm": ("torque, greatest 95 % error bar", "N m"),
    "torque_error_bar_percent": ("the same, of peak to peak", "%"),
    "torque_wheel_bar_max_Nm": ("its part due to the trigger wheel", "N m"),
    "pitch_tolerance_deg": ("pitch tolerance of the wheel", "deg"),
    "pitch_errors_rms_deg": ("pitch errors of the wheel, rms, corrected", "deg"),
    "pitch_errors_left_deg": ("pitch errors that remain, rms", "deg"),
    "half_orders_percent": ("half orders in the variance of the speed", "%"),
}
STATES = {
    "before": "{alone}",
    "inertia_alone": "added inertia, no cam force",
    "after": "with the cam",
}


def prices(records: Json) -> ReportTable:
    """Shadow prices of the active limits as recorded, highest first."""
    rows = [
        [
            words(str(record["limit"])), quantity(record["value"], _unit(record)),
            _change(record["ripple_per_unit_Nm"], f"per {_unit(record) or 'unit'}"),
            _change(record["ripple_per_percent_Nm"]), _ranges(record["binds_at_deg"]),
        ]
        for record in _records(records)
    ]  # fmt: skip
    return ReportTable("Shadow prices of the limits", PRICES_HEAD, rows)


def machine_prices(records: Json) -> ReportTable:
    """Prices of the numbers of the machine as recorded, greatest first."""
    rows = [
        [
            str(record["words"]), quantity(record["value"], _unit(record)),
            _change(record["ripple_per_unit_Nm"], f"per {_unit(record) or 'unit'}"),
            _change(record["ripple_per_percent_Nm"]),
        ]
        for record in _records(records)
    ]  # fmt: skip
    return ReportTable("Prices of the numbers of the machine", MACHINE_PRICES_HEAD, rows)


def consistency(records: Sequence[Record] | None) -> tuple[ReportTable, bool]:
    """Table of inputs beside their implied values, and whether any of them is flagged
    as different.
    """
    compared = records or ()
    rows = [
        [
            str(one["title"]), str(one["load_case"]), str(one.get("how", "")),
            quantity(one["given"], str(one["unit"])), quantity(one["implied"], str(one["unit"])),
            quantity(one["difference_percent"], "%", 2) + (" (differs)" if one["flagged"] else ""),
        ]
        for one in compared
    ]  # fmt: skip
    flagged = any(one["flagged"] for one in compared)
    return ReportTable("Consistency of the inputs", CONSISTENCY_HEAD, rows, 3), flagged


def crank_speed(record: Json, machine: MachineWords) -> ReportTable:
    """Shaft speed ripple with and without the cam, by load case."""
    rows = [
        [
            name, shown.format(alone=machine.alone),
            quantity(states[state]["std_rad_per_s"], "rad/s"),
            quantity(states[state]["p2p_rad_per_s"], "rad/s"),
            quantity(100.0 * states[state]["fluctuation"], "%", 3),
        ]
        for name, states in _records_by_name(record)
        for state, shown in STATES.items()
        if isinstance(states.get(state), Mapping)
    ]  # fmt: skip
    return ReportTable(f"{machine.title} speed", SPEED_HEAD, rows, 2)


def valve_train(record: Json) -> ReportTable:
    """Machine motion of a valve cam; reconstructed values are marked."""
    rows = [
        [
            str(one["name"]), str(one["load_case"]) or DASH, str(one["note"]),
            quantity(one["value"], "" if one["unit"] == "-" else str(one["unit"])),
        ]
        for one in _records(record.get("rows") if isinstance(record, Mapping) else None)
    ]  # fmt: skip
    return ReportTable("Machine motion of the valve cam", VALVE_HEAD, rows, 3)


def benchmarks(record: Json) -> list[tuple[str, str]]:
    """(benchmark, relative difference from its reference solution)."""
    known = record if isinstance(record, Mapping) else {}
    return [
        (title, quantity(100.0 * value, "%", 2))
        for name, title in BENCHMARKS.items()
        if isinstance(value := known.get(name), float)
    ]


def measurement(record: Json) -> list[tuple[str, str]]:
    """(name, value) of a measurement on the engine; empty for a model."""
    known = record if isinstance(record, Mapping) else {}
    return [
        (title, value if isinstance(value, str) else quantity(value, unit))
        for name, (title, unit) in MEASUREMENT.items()
        if isinstance(value := known.get(name), int | float | str)
    ]


def measurement_notes(record: Json) -> list[str]:
    """Sentences on wheel and cycle of a measured speed."""
    notes = record.get("notes") if isinstance(record, Mapping) else None
    listed = notes if isinstance(notes, list) else []
    return [sentence(note) for note in listed if isinstance(note, str)]


def certificate(points: Sequence[Record]) -> ReportTable:
    """Table of the peak pressure on each mesh, its extrapolation and grid convergence, by
    certificate point.
    """
    rows = []
    for point in points:
        pressure = _figure(point, "p0_MPa")
        rows.append([
            _angle(point), _several(point.get("edges_across_half_width"), 3),
            _several(point.get("dofs")), _several(pressure.get("meshes"), 5),
            number(pressure.get("extrapolated"), 5), _order(pressure),
            number(pressure.get("gci_percent"), 2), number(point.get("p0_hertz_MPa"), 5),
            number(pressure.get("cycle"), 5), _deviation(pressure),
            number(point.get("residual_equilibrium"), 2),
        ])  # fmt: skip
    return ReportTable("Certificate points", CERTIFICATE_HEAD, rows, wide=True)


def _angle(point: Record) -> str:
    """Cam angle of a certificate point, and the disc where it is not the one that bears more."""
    disc = ", disc that bears less" if point.get("bears_less") else ""
    return number(point.get("cam_angle_deg")) + disc


def certified(points: Sequence[Record]) -> ReportTable:
    """Half-width and stresses, by certificate point."""
    rows = [
        [
            _angle(point), title, _several(figure.get("meshes"), 5),
            number(figure.get("extrapolated"), 5), _order(figure),
            number(figure.get("gci_percent"), 2), number(figure.get("cycle"), 5),
            _deviation(figure),
        ]
        for point in points
        for name, title in CERTIFIED.items()
        if (figure := _figure(point, name))
    ]  # fmt: skip
    return ReportTable("Half-width and stresses at the certificate points", CERTIFIED_HEAD, rows, 2,
                 wide=True)  # fmt: skip


def ends(points: Sequence[Record]) -> ReportTable:
    """Table of the pressures at the ends of the contact as factors over the maximum pressure of
    plane strain, by half-spaces and by finite elements.
    """
    rows = []
    for point in points:
        blocks = _figure(point, "finite_elements")
        mean = f"mean of {number(blocks.get('mean_length_mm'))} mm at a corner"
        rows.append([
            str(point.get("load_case")), _angle(point),
            number(point.get("force_N")), number(point.get("moment_Nmm")),
            mean if point.get("is_mean_at_corner") else "greatest",
            number(point.get("cycle_factor")), number(point.get("signed_factor")),
            number(point.get("signed_gci_percent"), 2), number(point.get("ratio")),
            number(blocks.get("centre")),
        ])  # fmt: skip
    return ReportTable("Ends of the contact, over plane strain", ENDS_HEAD, rows, wide=True)


def stress_below(points: Sequence[Record]) -> ReportTable:
    """Table of the greatest stresses, MPa, and their depths, mm, below middle and ends of the
    contact at the first certified angle.

    Parameters
    ----------
    points : sequence   certified angles, stresses as factors over the pressure of plane strain
    """
    rows = []
    for point in points[:1]:
        p0 = float(point["plane_strain_p0_MPa"])
        for body, places in _records_by_name(_figure(point, "finite_elements").get("stress")):
            for place, peak in _records_by_name(places):
                rows.append([
                    str(point.get("load_case")), number(point.get("cam_angle_deg")), body,
                    _BELOW[place], number(p0 * float(peak["von_mises"])),
                    number(peak["von_mises_depth_mm"], 3), number(p0 * float(peak["shear"])),
                    number(peak["shear_depth_mm"], 3),
                ])  # fmt: skip
    return ReportTable("Stress below middle and ends of the contact", STRESS_HEAD, rows, wide=True)


def of_ends(trial: Record) -> list[tuple[ReportTable, str, str]]:
    """Tables of the finite-element ends of a trial, with titles and introductions."""
    points = _records(trial.get("length_certificate"))
    return [
        (
            ends(points), "Ends of the contact",
            "Bodies of finite length by half-spaces with mirrored ends and by finite elements on "
            "three meshes. The greatest ratio multiplies the factor of every check, with the "
            "greatest grid convergence index (GCI) as its error bar.",
        ),
        (
            stress_below(points), "Stress below the ends",
            "From the pressure of the finite elements, as patches on a half-space; at a corner of "
            "the mean over the length of its mean pressure, since the greatest one grows with the "
            "mesh.",
        ),
    ]  # fmt: skip


def ends_refused(trial: Record) -> str:
    """Reason why finite elements did not solve the ends; "" where they did."""
    refused = trial.get("length_refused")
    return f"The ends of the contact are solved by half-spaces alone: {refused}." if refused else ""


def hertz_difference(record: Json) -> str:
    """Sentence on the change of the maximum pressure of Hertz by finite elements, as ranges in
    percent by cause; "" without a record.
    """
    if not isinstance(record, Mapping):
        return ""
    ranges = {
        name: span
        for name, span in record.items()
        if isinstance(span, list) and all(isinstance(end, int | float) for end in span)
    }
    whole, rest = ranges.pop("p0"), ranges.pop("rest")
    bending = sorted(ranges, key=lambda name: -max(abs(end) for end in ranges[name]))
    shares = [f"bending of the {name} {_span(ranges[name])}" for name in bending]
    shares.append(f"mesh and change of curvature along the contact {_span(rest)}")
    return (
        "Over the loaded angles of the evaluated load cases finite elements change p0 of Hertz "
        f"theory by {_span(whole)}: {', '.join(shares)}."
    )


def _span(ends: Sequence[float]) -> str:
    """A range in percent to a hundredth; one value where both ends are the same."""
    low, high = (f"{end + 0.0:.2f}".replace("-0.00", "0.00").replace("-", MINUS) for end in ends)
    return f"{low}\N{NO-BREAK SPACE}%" if low == high else f"{low} to {high}\N{NO-BREAK SPACE}%"


def corners(checks: Sequence[Record]) -> ReportTable:
    """Checks whose demand at a tolerance corner exceeds the nominal one."""
    rows = [
        [str(check["title"]), at[0], quantity(check["demand"], str(check["unit"])), at[1]]
        for check in checks
        if (at := worst_corner(check)) is not None
    ]
    return ReportTable("Tolerance corners", CORNERS_HEAD, rows, 2)


def _figure(point: Record, name: str) -> Record:
    figure = point.get(name)
    return figure if isinstance(figure, Mapping) else {}


def _order(figure: Record) -> str:
    """Order of convergence of a quantity on its meshes."""
    order = figure.get("order")
    return "scatter" if figure and order is None else number(order, 3)


def _deviation(figure: Record) -> str:
    """Deviation of the value in the cycle from the extrapolated one of the same quantity, %, as
    text; a dash if either is not known or the latter is zero.

    Parameters
    ----------
    figure : mapping   values of one quantity at a certificate point
    """
    cycle, zero = figure.get("cycle"), figure.get("extrapolated")
    if not isinstance(cycle, int | float) or not isinstance(zero, int | float) or not zero:
        return DASH
    return number(100.0 * abs(cycle / zero - 1.0), 2)


def _several(values: Json, digits: int = 4) -> str:
    return ", ".join(number(v, digits) for v in values) if isinstance(values, list) else DASH


def _records(value: object) -> list[Record]:
    return [one for one in value if isinstance(one, Mapping)] if isinstance(value, list) else []


def _records_by_name(value: Json) -> list[tuple[str, Record]]:
    named = value.items() if isinstance(value, Mapping) else ()
    return [(name, one) for name, one in named if isinstance(one, Mapping)]


def _unit(record: Record) -> str:
    unit = str(record["unit"])
    return "" if unit == "-" else unit


def _change(price: Json, per: str = "") -> str:
    """A price as the change of the ripple: relaxing a limit reduces it."""
    if not isinstance(price, (int, float)):
        return DASH
    return f"{quantity(0.0 - float(price), 'N m', 3)} {per}".rstrip()


def _ranges(ranges: Json) -> str:
    """Cam angles from start to end, deg, of several ranges as text."""
    shown = [
        number(start) if start == stop else f"{number(start)}\N{EN DASH}{number(stop)}"
        for start, stop in (ranges if isinstance(ranges, list) else ())
    ]
    return f"{', '.join(shown)} deg" if shown else DASH
