"""Page of the gallery: machines side by side with torque, cam and speed."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from camwright.reports.page import environment
from camwright.reports.report_tables import Record, ReportTable, number
from validation.pages.paper_chart import Chart

TEMPLATES = Path(__file__).parent / "templates"
LEAD = (
    "Each cam is that of a preview: contact by Hertz theory, every limit but those of the finite "
    "elements judged. Its case file has all numbers with their sources; camwright run CASE solves "
    "it by finite elements."
)
SCREENS = {"open": "no limit exceeded", "fail": "limits exceeded"}
ROWS = {
    "speed_rpm": ("speed", "rpm"),
    "torque_std_without_cam_Nm": ("torque ripple without the cam, std", "N m"),
    "torque_std_with_cam_Nm": ("torque ripple with the cam, std", "N m"),
    "lift_mm": ("lift", "mm"),
    "pressure_max_MPa": ("maximum contact pressure, Hertz", "MPa"),
}


@dataclass(frozen=True, eq=False)
class GalleryEntry:
    """One machine: figure, words under it, table of its key values."""

    chart: Chart
    case: str
    words: str
    table: ReportTable


def page(document: Record) -> str:
    """HTML text of the page from the contents of ``gallery.json``."""
    text: str = environment(TEMPLATES).get_template("gallery.html").render(
        title="Machines and their cams", lead=LEAD,
        machines=[_entry(one) for one in document["machines"]],
    )  # fmt: skip
    return text


def _entry(machine: Record) -> GalleryEntry:
    lobes = machine["cycles_per_cam_turn"]
    words = SCREENS[str(machine["screen"])]
    if machine["governing"]:
        words += f"; nearest to its limit: {machine['governing']}"
    turns = "one cycle" if lobes == 1 else f"{lobes} cycles"
    rows = [[*ROWS[name], number(float(value))] for name, value in machine["values"].items()]
    return GalleryEntry(
        Chart(machine["figure"]),
        machine["case"],
        f"{turns} of the machine in a cam turn; {words}.",
        ReportTable(f"Values of {machine['name']}", ("quantity", "unit", "value"), rows, 2),
    )
