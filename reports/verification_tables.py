"""Evidence, prices and findings of a run as rows of tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from camwright.reports.report_tables import DASH, Table, number, quantity, words, worst_corner

PRICES_HEAD = (
    "limit", "stands at", "ripple for one unit more", "ripple where it gives way by 1 %",
    "binds at cam angle",
)  # fmt: skip
CONSISTENCY_HEAD = ("quantity", "load case", "how", "given", "implied", "difference")
SPEED_HEAD = ("load case", "crank", "standard deviation", "peak to peak", "fluctuation")
VALVE_HEAD = ("figure", "load case", "what it is", "value")
CORNERS_HEAD = ("check", "corner", "nominal", "there")
CERTIFICATE_HEAD = (
    "cam angle, deg", "edges over a", "unknowns", "p0 per mesh, MPa", "p0 extrapolated, MPa",
    "order", "GCI, %", "p0 Hertz, MPa", "p0 in the cycle, MPa", "spread, %", "equilibrium",
)  # fmt: skip
CERTIFIED_HEAD = (
    "cam angle, deg", "quantity", "per mesh", "extrapolated", "order", "GCI, %", "in the cycle",
)  # fmt: skip
CERTIFIED = {
    "half_width_mm": "half-width a, mm",
    "tau_max_MPa": "greatest shear stress, MPa",
    "von_mises_MPa": "greatest von Mises stress, MPa",
}


BENCHMARKS = {
    "nafems_p0": "NAFEMS R0094 case 1, peak pressure",
    "nafems_half_width": "NAFEMS R0094 case 1, half-width",
    "hertz_p0": "roller on a block, peak pressure against Hertz",
    "hertz_half_width": "roller on a block, half-width against Hertz",
}
STATES = {
    "before": "engine alone",
    "inertia_alone": "with the added inertia alone",
    "after": "with the cam",
}


def prices(records: Any) -> Table:
    """What each limit in use costs, the dearest first; no rows where nothing was priced."""
    rows = [
        [
            words(str(record["limit"])), quantity(record["value"], _unit(record)),
            _change(record["ripple_per_unit_Nm"], f"per {_unit(record) or 'unit'}"),
            _change(record["ripple_per_percent_Nm"]), _ranges(record["binds_at_deg"]),
        ]
        for record in _records(records)
    ]  # fmt: skip
    return Table("Prices of the limits", PRICES_HEAD, rows)


def consistency(records: Any) -> tuple[Table, bool]:
    """What the inputs say of one another, and whether any of it does not agree."""
    found = _records(records)
    rows = [
        [
            str(one["title"]), str(one["load_case"]), str(one.get("how", "")),
            quantity(one["given"], str(one["unit"])), quantity(one["implied"], str(one["unit"])),
            quantity(one["difference_percent"], "%", 2) + (" (differs)" if one["flagged"] else ""),
        ]
        for one in found
    ]  # fmt: skip
    flagged = any(one["flagged"] for one in found)
    return Table("Whether the inputs agree", CONSISTENCY_HEAD, rows, 3), flagged


def crank_speed(record: Any) -> Table:
    """Ripple of the crank's speed, without and with the cam, by load case."""
    rows = [
        [
            name, shown, quantity(states[state]["std_rad_per_s"], "rad/s"),
            quantity(states[state]["p2p_rad_per_s"], "rad/s"),
            quantity(100.0 * states[state]["fluctuation"], "%", 3),
        ]
        for name, states in (record.items() if isinstance(record, Mapping) else ())
        for state, shown in STATES.items()
        if isinstance(states.get(state), Mapping)
    ]  # fmt: skip
    return Table("Crank speed", SPEED_HEAD, rows, 2)


def valve_train(record: Any) -> Table:
    """The machine motion of a valve cam, with what of it is reconstructed."""
    rows = [
        [
            str(one["name"]), str(one["load_case"]) or DASH, str(one["note"]),
            quantity(one["value"], "" if one["unit"] == "-" else str(one["unit"])),
        ]
        for one in _records(record.get("rows") if isinstance(record, Mapping) else None)
    ]  # fmt: skip
    return Table("Machine motion of the valve cam", VALVE_HEAD, rows, 3)


def benchmarks(record: Any) -> list[tuple[str, str]]:
    """(words, relative difference) of the benchmarks solved in the environment of the run."""
    known = record if isinstance(record, Mapping) else {}
    return [
        (title, quantity(100.0 * known[name], "%", 2))
        for name, title in BENCHMARKS.items()
        if isinstance(known.get(name), float)
    ]


def certificate(points: Sequence[Mapping[str, Any]]) -> Table:
    """One row per certificate point: the pressure on each mesh and what follows from it."""
    rows = []
    for point in points:
        pressure = _figure(point, "p0_MPa")
        rows.append([
            number(point.get("cam_angle_deg")), _several(point.get("edges_across_half_width"), 3),
            _several(point.get("dofs")), _several(pressure.get("meshes"), 5),
            number(pressure.get("extrapolated"), 5), number(pressure.get("order"), 3),
            number(pressure.get("gci_percent"), 2), number(point.get("p0_hertz_MPa"), 5),
            number(pressure.get("cycle"), 5), number(point.get("spread_percent"), 2),
            number(point.get("residual_equilibrium"), 2),
        ])  # fmt: skip
    return Table("Certificate points", CERTIFICATE_HEAD, rows, wide=True)


def certified(points: Sequence[Mapping[str, Any]]) -> Table:
    """A row per certificate point and quantity other than the pressure."""
    rows = [
        [
            number(point.get("cam_angle_deg")), title, _several(figure.get("meshes"), 5),
            number(figure.get("extrapolated"), 5), number(figure.get("order"), 3),
            number(figure.get("gci_percent"), 2), number(figure.get("cycle"), 5),
        ]
        for point in points
        for name, title in CERTIFIED.items()
        if (figure := _figure(point, name))
    ]  # fmt: skip
    return Table("Other certified quantities", CERTIFIED_HEAD, rows, 2, wide=True)


def _figure(point: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    figure = point.get(name)
    return figure if isinstance(figure, Mapping) else {}


def _several(values: Any, digits: int = 4) -> str:
    return ", ".join(number(v, digits) for v in values) if isinstance(values, list) else DASH


def corners(checks: Sequence[Mapping[str, Any]]) -> Table:
    """Checks that a corner of the tolerances asks more of than the nominal case."""
    found = ((check, worst_corner(check)) for check in checks)
    rows = [
        [str(check["title"]), at[0], quantity(check["demand"], str(check["unit"])), at[1]]
        for check, at in found
        if at is not None
    ]
    return Table("Tolerance corners", CORNERS_HEAD, rows, 2)


def _records(value: Any) -> list[Mapping[str, Any]]:
    return [one for one in value if isinstance(one, Mapping)] if isinstance(value, list) else []


def _unit(record: Mapping[str, Any]) -> str:
    unit = str(record["unit"])
    return "" if unit == "-" else unit


def _change(price: Any, per: str = "") -> str:
    """A price as the change of the ripple: a limit that gives way takes ripple off."""
    if not isinstance(price, (int, float)):
        return DASH
    return f"{quantity(-float(price), 'N m', 3)} {per}".rstrip()


def _ranges(ranges: Any) -> str:
    shown = [
        number(start) if start == stop else f"{number(start)}\N{EN DASH}{number(stop)}"
        for start, stop in (ranges if isinstance(ranges, list) else ())
    ]
    return f"{', '.join(shown)} deg" if shown else DASH
