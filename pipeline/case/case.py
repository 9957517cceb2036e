"""`Case`: a case file read and resolved, every default included, in SI."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal

import numpy as np
from pydantic import AfterValidator, Field, PrivateAttr, ValidationError

from camwright.geometry.arrays import FULL_TURN
from camwright.geometry.contour import Contour
from camwright.geometry.display import Displayed
from camwright.geometry.errors import InputError
from camwright.geometry.figures import SERIES, Curve, DrawnAxes, Panel, closed, over, plotted
from camwright.geometry.lift import Lift
from camwright.geometry.rocker_lift import RockerLinkage
from camwright.pipeline.base.columns import data_frame
from camwright.pipeline.base.cooling import Cooling
from camwright.pipeline.base.files import hash_inputs
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import Known, Resolved, Used
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.case_writer import to_toml
from camwright.pipeline.case.engine_section import Engine, engine_files
from camwright.pipeline.case.error_text import Written, refusal_of
from camwright.pipeline.case.given_lift import given_lift
from camwright.pipeline.case.lift_section import GivenLift, LiftTable
from camwright.pipeline.case.limits import TOOL_RADIUS, Limits
from camwright.pipeline.case.parts_section import Follower, ValveTrain
from camwright.pipeline.case.requirements_section import (
    Confirmation,
    LoadCase,
    Mechanism,
    Smoothing,
    Solver,
    Tolerances,
    Waiver,
)
from camwright.pipeline.case.scope_section import Scope
from camwright.pipeline.case.section import Name, Section, StatedSource, Table, Text, named
from camwright.pipeline.case.toml_text import Tables, tables_of
from camwright.pipeline.case.torque_section import ShaftTorque, torque_files
from camwright.pipeline.case.workshop_section import Document, Workshop, WorkshopOrder
from camwright.pipeline.contact.cam_body import SECOND_BEARING, CamBody
from camwright.pipeline.contact.oil_film import Lubricant
from camwright.pipeline.contact.rolling_bearing import Bearing
from camwright.pipeline.engine.crankshaft import Crankshaft
from camwright.pipeline.follower.camshaft_loads import Camshaft
from camwright.pipeline.follower.follower_kind import FollowerKind
from camwright.pipeline.follower.guide_reactions import Guide, GuidePair
from camwright.pipeline.follower.rocker import Rocker, RockerOutput
from camwright.pipeline.follower.roller import Roller, on_second_track
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.records.run_summary import ScopeRecord
from camwright.pipeline.torque.period import FOUR_STROKE, Period

if TYPE_CHECKING:
    import pandas as pd

INPUTS = "inputs"
Materials = Annotated[
    dict[Name, Table[Material]], Field(min_length=1, max_length=64), AfterValidator(named)
]


class Case(Displayed, Section):
    """A design and its load cases as a case file has them, resolved, SI; frozen.

    Made by `read_case`. Each field is a section of the case file; one that the case leaves out has
    its defaults or is None. `docs/case-file.md` lists every key with unit, bounds and default.
    """

    resolved: ClassVar[Mapping[str, Resolved]] = {
        "added": Resolved(
            "list of tables",
            "further tables, each added to the one of its name: what `check --missing` prints, at"
            " the end of the file",
            Known("camwright check CASE --missing", ({"cam": {"roughness": "0.3 um"}},)),
        )
    }

    schema_version: Annotated[Literal[1], Known("this program", 1)]
    """version of the case file format"""
    name: Annotated[Name, Known("own choice", "gx120")]
    """short name: of files and sheets"""
    title: Annotated[Text, Known("own choice", "Balancing cam of a Honda GX120")] = ""
    """title of the report"""
    notes: Annotated[Text, Known("own choice", "Torque measured on the test bench.")] = ""
    """remarks, printed in the report"""
    document: Annotated[Document, Used("sign-off sheet, drawing")] = Document()
    """title block of sign-off sheet and drawing; what is left out is a field to fill by hand"""
    engine: Annotated[Engine | None, Used("torque")] = None
    """engine whose torque the cam balances: a model, or measured data"""
    torque: Annotated[ShaftTorque | None, Used("torque")] = None
    """machine whose torque the cam balances, by its torque on the shaft; positive drives the
    shaft"""
    crankshaft: Annotated[Table[Crankshaft] | None, Used("torque")] = None
    """rotating parts of the engine and its load, for the crank speed"""
    lift: Annotated[GivenLift | None, Used("lift")] = None
    """stated lift, in place of that computed from an engine"""
    mechanism: Annotated[Mechanism, Used("torque, lift")] = Mechanism()
    """drive between crank and cam"""
    spring: Annotated[Table[Spring], Used("lift, cycle, checks")]
    """spring that holds the follower on the cam"""
    cam: Annotated[Table[CamBody], Used("contour, contact, part loads")]
    """the cam disc"""
    camshaft: Annotated[Table[Camshaft] | None, Used("part loads, checks of the camshaft")] = None
    """camshaft on two bearings, with its gear"""
    valve_train: Annotated[ValveTrain | None, Used("valve train comparison")] = None
    """machine motion of a valve cam"""
    roller_given: Annotated[
        Table[Roller] | None, Field(alias="roller"), Used("contour, contact, checks")
    ] = None
    """roller of the follower"""
    follower: Annotated[Follower, Used("lift, cycle, checks")]
    """follower, with its stem or its arm"""
    rocker: Annotated[Table[Rocker] | None, Used("lift")] = None
    """second arm that moves a valve or another output, with lash"""
    guides: Annotated[Table[GuidePair], Used("cycle, checks of the guides")]
    """two guides of the stem: A next to the cam, B beyond"""
    lubricant: Annotated[Table[Lubricant] | None, Used("oil film")] = None
    """oil between cam and follower"""
    cooling: Annotated[Table[Cooling], Used("temperature of the mechanism")] = Cooling()
    """heat that the mechanism gives to its surroundings; without a conductance that of the box
    around it in still air"""
    materials: Annotated[Materials, Used("contact, part loads, checks")]
    """material card of this name"""
    scope: Annotated[Scope, Used("checks, sign-off")] = Scope()
    """parts that the sign-off does not cover"""
    smoothing: Annotated[Smoothing, Used("smoothing, lift")] = Smoothing()
    """smoothing of the torque, or synthesis of the lift within the limits; keys of other filters
    alone are refused"""
    limits: Annotated[Limits, Used("checks, synthesis")] = Limits()
    """limits of the checks"""
    solver: Annotated[Solver, Used("cycle, certificate")] = Solver()
    """resolution and number of trials"""
    tolerances: Annotated[Tolerances, Used("tolerance corners")] = Tolerances()
    """tolerances, solved at both ends"""
    workshop: Annotated[Workshop, Used("workshop files, checks of manufacture")] = Workshop()
    """workshop files"""
    waivers: Annotated[tuple[Waiver, ...], Field(strict=False, max_length=64), Used("verdict")] = ()
    """accepted failure of a check, up to a value"""
    sources: Annotated[
        dict[str, StatedSource],
        Field(default_factory=dict, max_length=1024),
        Known("data sheet, standard, drawing or test report", {"cam.width": "drawing 4711"}),
    ]
    """source of single values by their dotted key"""
    confirmed: Annotated[
        tuple[Confirmation, ...],
        Field(strict=False, max_length=1024),
        Used("values to be confirmed"),
    ] = ()
    """confirmation of a value whose source is not confirmed"""
    load_cases: Annotated[
        tuple[LoadCase, ...],
        Field(alias="load_case", strict=False, min_length=1, max_length=64),
        Used("cycle, checks, synthesis"),
    ]
    """load case; the first is the design load case"""

    _included: Mapping[str, bytes] = PrivateAttr(default_factory=dict)
    _folder: Path | None = PrivateAttr(default=None)
    _written: Written = PrivateAttr(default_factory=Written)

    @property
    def facts(self) -> Mapping[str, object]:
        """Name, source of the lift, follower, size of the cam, positions and load cases."""
        return {
            "name": self.name,
            "title": self.title,
            "lift": "balances the torque" if self.balances else "stated",
            "follower": self.follower.kind,
            "prime_radius": shown(self.cam.prime_radius, "mm"),
            "positions": self.solver.positions,
            "load_cases": ", ".join(each.name for each in self.load_cases),
        }

    def __str__(self) -> str:
        return repr(self)

    def to_pandas(self) -> pd.DataFrame:
        """Data frame of the resolved case: a row per key, values as in `to_toml`.

        Raises
        ------
        ResultError
            If pandas is not installed.
        """
        values = dict(_keyed("", self.tables()))
        return data_frame({"key": list(values), "value": list(values.values())})

    def plot(self) -> DrawnAxes:
        """Torque that the cam balances, a curve a load case, over the shaft angle of a cam turn;
        of a case that states its lift the lift, see `Lift.plot`.

        Raises
        ------
        InputError
            If a file cannot be read or has wrong contents.
        """
        # The engine models, which reading a case does without.
        from camwright.pipeline.case.load_case_torque import engine_torques

        if not self.balances:
            return given_lift(self).plot()
        curves = [
            Curve(
                np.degrees(np.append(torque.theta, torque.span)), closed(torque.total), name, colour
            )
            for (name, torque), colour in zip(
                engine_torques(self).items(), cycle(SERIES), strict=False
            )
        ]
        panels = [Panel("torque", "N m", tuple(curves))]
        return plotted(over("torque", "Torque", "", "shaft angle", "deg", panels))

    def to_toml(self) -> str:
        """The case with every default written out; reads back bit for bit.

        Included files have the names of their copies in a run folder, ``inputs/NAME``.
        """
        return to_toml(self, self._kept)

    def tables(self) -> Tables:
        """The resolved case as the tables of a case file, included files as in `to_toml`."""
        return tables_of(self, self._kept)

    @property
    def _kept(self) -> dict[str, str]:
        return {name: kept_as(name) for _, name in includes(self)}

    @property
    def included(self) -> Mapping[str, bytes]:
        """Contents of the included files, by their names in a run folder."""
        return self._included

    @property
    def written(self) -> Written:
        """Tables of the case file as written, for messages."""
        return self._written

    @property
    def sha256(self) -> str:
        """Hash of the resolved case and the included files, which determine the result."""
        return hash_inputs(self.to_toml(), self._included)

    def with_positions(self, positions: int) -> Case:
        """Case with another number of positions per cam turn."""
        values = self.solver.model_dump() | {"positions": positions}
        try:
            solver = Solver.model_validate(values)
        except ValidationError as error:
            raise refusal_of(error, "solver") from None
        return self.model_copy(update={"solver": solver})

    @property
    def folder(self) -> Path | None:
        """Folder of the case file; None: the case was not read from a file."""
        return self._folder

    def path(self, name: str) -> Path:
        """Path of an included file; `name` as in the case file."""
        if self._folder is None:
            raise InputError("case", name, "read from a file to include others")
        return self._folder / name

    @property
    def roller(self) -> Roller:
        """Roller of the follower; refused for a face.

        Raises
        ------
        InputError
            If it has none.
        """
        if self.roller_given is None:
            if self.follower.face is not None:
                limit = "left out for a value of the roller"
                raise InputError("follower.face", "a table", limit)
            raise InputError("roller", "missing", 'given with follower.kind = "roller"')
        return self.roller_given

    @property
    def bodies(self) -> dict[str, Material]:
        """Materials of the two bodies in contact: the cam, and the roller or face."""
        return {"cam": self.cam.material, self.facing.word: self.facing.material}

    @property
    def period(self) -> Period:
        """Cycle of the machine and the drive of its cam; a lift is a cycle by itself.

        The cycle of an engine and a torque on one shaft is the longer of theirs.

        Raises
        ------
        InputError
            If the cam turn does not hold a whole number of cycles.
        """
        ratio = self.mechanism.gear_ratio
        cycles = [FOUR_STROKE.angle] * (self.engine is not None)
        cycles += [] if self.torque is None else [self.torque.cycle]
        return Period(max(cycles, default=FULL_TURN * ratio), ratio)

    @property
    def balances(self) -> bool:
        """Whether the lift follows from a torque to balance; else the case states the lift."""
        return self.lift is None

    def with_spring_on_arm(self) -> Case:
        """Case whose spring is reduced to the arc of its arm.

        Raises
        ------
        InputError
            If the spring is that of another kind of follower.
        """
        arm = self.follower.arm
        spring = self.spring.on_arm(None if arm is None else arm.length, self.rocker)
        return self if spring is self.spring else self.model_copy(update={"spring": spring})

    @property
    def scope_record(self) -> ScopeRecord:
        """Scope of the sign-off, which never covers the frame of a yoke."""
        return self.scope.as_record("" if self.cam.yoke is None else "frame of the yoke")

    @property
    def spring_mass(self) -> float:
        """Part of the spring's mass that moves with the follower, kg, reduced to it; 0 without a
        wound spring.
        """
        design = self.spring.design
        if design is None:
            return 0.0
        return self.follower.spring_share * design.mass * self.spring.lever_at_rest**2

    @property
    def rocker_linkage(self) -> RockerLinkage | None:
        """Arms of the rocker with its lash; None without one."""
        arm = self.follower.arm
        if self.rocker is None:
            return None
        return self.rocker.linkage(None if arm is None else arm.length)

    @property
    def output(self) -> RockerOutput | None:
        """Mass and force that a rocker moves; None without a rocker or where it has neither."""
        arm, rocker = self.follower.arm, self.rocker
        if rocker is None or not (rocker.output_mass or rocker.output_force):
            return None
        return RockerOutput(rocker, None if arm is None else arm.length)

    @property
    def facing(self) -> FollowerKind:
        """Roller or face that touches the cam."""
        return self.roller if self.follower.face is None else self.follower.face

    def contour(self, lift: Lift) -> Contour:
        """Cam contour of a lift."""
        return self.facing.contour(lift, self.cam, self.follower.arm)

    @property
    def bushes(self) -> Mapping[str, Guide]:
        """Bushes by the dotted name of their table: those of the guides of a stem, or that of the
        pivot of an arm; none with needles in the pivot or without a description of it.
        """
        pivot = self.follower.pivot
        if self.follower.arm is None:
            return {f"guides.{side.lower()}": guide for side, guide in self.guides.both}
        return {} if pivot is None or pivot.bush is None else {"follower.pivot.bush": pivot.bush}

    @property
    def bearings(self) -> Mapping[str, Bearing]:
        """Described bearings of rollers by the dotted name of their table; none of a face."""
        if self.roller_given is None:
            return {}
        described, second = {Bearing.table: self.roller.bearing}, self.cam.on_pin
        if second is not None and second.bearing is not None:
            described[SECOND_BEARING] = on_second_track(self.roller, self.cam).bearing
        return described

    @property
    def base_circle(self) -> float:
        """Radius of the base circle, m: of the cam surface at zero lift."""
        return self.cam.prime_radius - (self.facing.contact_radius or 0.0)

    @property
    def contact_radius(self) -> float:
        """Radius of the follower's surface, m; under a flat face the base radius."""
        return self.facing.contact_radius or self.base_circle

    @property
    def largest_tool(self) -> float | None:
        """Tool radius for concave flanks, m: from the limits, else from the workshop."""
        limit = self.limits[TOOL_RADIUS]
        return self.workshop.tool_radius if limit is None else limit

    @property
    def workshop_order(self) -> WorkshopOrder:
        """Tables, tool, tolerance band and error of the arcs of the workshop files."""
        shop = self.workshop
        tool = self.largest_tool if shop.tool_radius is None else shop.tool_radius
        return WorkshopOrder(shop.table_step, tool, self.cam.profile_tolerance, shop.arc_error)


def _keyed(key: str, value: object) -> Iterator[tuple[str, object]]:
    """Dotted key and value of every entry of nested tables.

    Parameters
    ----------
    key : str        dotted name of `value`; "": the whole
    value : object   table, list of tables, or value
    """
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _keyed(f"{key}.{name}" if key else str(name), inner)
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        for k, inner in enumerate(value):
            yield from _keyed(f"{key}[{k}]", inner)
    else:
        yield key, value


def includes(case: Case) -> Iterator[tuple[str, str]]:
    """Key and file name of every file to which a case refers."""
    yield from engine_files(case.engine)
    yield from torque_files(case.torque)
    if isinstance(case.lift, LiftTable):
        yield "lift.file", case.lift.file
    if case.follower.external_force_file is not None:
        yield "follower.external_force_file", case.follower.external_force_file
    for part in (case.cam, case.facing):
        if part.crown is not None and part.crown.file is not None:
            yield f"{part.table}.crown.file", part.crown.file
    for k, load_case in enumerate(case.load_cases):
        if load_case.torque is not None:
            yield f"load_case[{k}].torque", load_case.torque


def kept_as(name: str) -> str:
    """Path in a run folder of the copy of an included file."""
    return f"{INPUTS}/{Path(name).name}"
