"""Bounds of the parts: the same for the text of a case file and for a value built in Python."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields, is_dataclass, replace
from functools import cache
from math import inf, isfinite, nan, nextafter
from pathlib import Path

import pytest
from pydantic import ValidationError

from camwright.geometry.errors import InputError
from camwright.pipeline.base import units
from camwright.pipeline.base.quantities import Count, In, Part, marks_of
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_file import read_case
from camwright.pipeline.case.error_text import refusal_of
from camwright.pipeline.case.lift_section import CamLiftPoint
from camwright.pipeline.case.section import section_of
from camwright.pipeline.case.toml_text import tables_of
from camwright.pipeline.contact.axial_shape import AxialCrown
from camwright.pipeline.contact.cam_body import (
    BalanceHole,
    CamConjugate,
    CamGroove,
    CamYoke,
    GrooveRoller,
)
from camwright.pipeline.engine.crankshaft import Crankshaft
from camwright.pipeline.engine.cylinder import CylinderEngine, ExhaustLiftPoint
from camwright.pipeline.engine.engine_torque import TorqueTable
from camwright.pipeline.engine.pickup_voltage import VoltageTable
from camwright.pipeline.engine.pressure_trace import PressureTable
from camwright.pipeline.engine.speed_file import SpeedTable
from camwright.pipeline.engine.speed_trace import Filter
from camwright.pipeline.engine.trigger_wheel import TriggerWheel
from camwright.pipeline.engine.wheel_calibration import WheelReference
from camwright.pipeline.follower.arm import FollowerArm
from camwright.pipeline.follower.camshaft_loads import Counterweight, ShaftSection
from camwright.pipeline.follower.flat_face import FollowerFace
from camwright.pipeline.follower.pivot import NeedleBearing, Pivot
from camwright.pipeline.follower.rocker import Rocker
from camwright.pipeline.follower.spring import Spring
from camwright.pipeline.follower.spring_kinds import (
    ExtensionSpring,
    GasSpring,
    PivotSpring,
    TorsionSpring,
)
from camwright.pipeline.follower.spring_link import (
    RockerSpring,
    SpringBehindRocker,
    SpringLink,
)
from camwright.pipeline.torque.harmonic_torque import Harmonic, HarmonicTorque
from camwright.pipeline.torque.machine_torque import Mark
from camwright.pipeline.torque.motor_line import MotorPoint
from camwright.pipeline.torque.press_torque import Press
from camwright.pipeline.torque.pressure_torque import PressureCylinder, PressureTorqueFile
from camwright.pipeline.torque.tabled_torque import TabledTorqueFile
from camwright.pipeline.torque.valved_cylinder import (
    CompressorCylinder,
    CompressorTorque,
    PumpCylinder,
    PumpTorque,
)

EVERY_PART = Path(__file__).parents[1] / "data" / "every_part.toml"
DRIVE = {
    "bore": 0.060,
    "crank_radius": 0.021,
    "rod_length": 0.073,
    "compression_ratio": 8.5,
    "piston_mass": 0.144,
    "rod_mass": 0.123,
}


@cache
def case() -> Case:
    return read_case(EVERY_PART)


def parts_in(value: object) -> Iterator[Part]:
    """The parts of a section or part, all the way down."""
    if isinstance(value, Part):
        yield value
    names = (
        [field.name for field in fields(value)]
        if is_dataclass(value)
        else list(getattr(type(value), "model_fields", ()))
    )
    for name in names:
        held = getattr(value, name)
        for each in held if isinstance(held, tuple) else (held,):
            yield from parts_in(each)


@cache
def every_part() -> dict[type[Part], Part]:
    """One of each kind of part; those that the made-up case leaves out are made here."""
    steel = case().materials["steel"]
    link = SpringLink(
        arm_radius=0.05, fixed_radius=0.06, fixed_angle=1.2, rate=5e4, preload=400.0
    )  # fmt: skip
    behind = RockerSpring(rate=5e4, preload=400.0)
    rest = (
        steel,
        *(link, PivotSpring(moment=1.0, angular_rate=20.0)),
        *(Rocker(ratio=1.5), behind, SpringBehindRocker(link=behind)),
        AxialCrown(kind="circular", radius=0.5),
        FollowerFace(width=0.02, depth=0.01, thickness=0.005, material=steel),
        Crankshaft(inertia=0.01),
        GasSpring(pressure=3e6, area=1e-4, volume=5e-6),
        TorsionSpring(moment=1.0, angular_rate=20.0, arm=0.04),
        FollowerArm(centre_distance=0.11, length=0.1, swing="with"),
        needles := NeedleBearing(diameter=0.016, length=0.016, friction=0.0025),
        Pivot(needle_bearing=needles),
        BalanceHole(),
        CamGroove(clearance=2e-5, depth=0.012, outer_radius=0.09),
        GrooveRoller(radius=0.021, spacing=0.0185, step_depth=0.0185, relief=5e-4),
        CamConjugate(roller_radius=0.015, distance=0.12, clearance=2e-5, spacing=0.02),
        CamYoke(clearance=5e-5),
        ExtensionSpring(
            force=300.0,
            initial_tension=60.0,
            wire_diameter=4e-3,
            mean_diameter=28e-3,
            coils=20.0,
            shear_modulus=79.5e9,
        ),
        Counterweight(unbalance=1e-4, angle=0.0, position=0.0),
        ShaftSection(
            name="groove", position=0.0, diameter=0.016, notch_bending=2.0, notch_torsion=1.5
        ),
        CylinderEngine(**DRIVE),
        PressureTable(file="pressure.csv", **DRIVE),
        TorqueTable(file="torque.csv"),
        SpeedTable(file="speed.csv"),
        VoltageTable(file="voltage.csv"),
        WheelReference(file="fast.csv", kind="second_speed"),
        CamLiftPoint(angle=0.0, lift=0.0),
        ExhaustLiftPoint(angle=0.0, lift=0.0),
        TriggerWheel(),
        Filter(),
        MotorPoint(speed=100.0, torque=1.0),
        *shaft_torques(),
    )
    return {type(part): part for part in (*parts_in(case()), *rest)}


def shaft_torques() -> tuple[Part, ...]:
    """A torque of each kind, and the tables within them."""
    drive = {"bore": 0.06, "crank_radius": 0.021, "rod_length": 0.1}
    pressures = {"suction_pressure": 1e5, "discharge_pressure": 3e5}
    wave = Harmonic(order=1.0, sine=1.0)
    gas, compressed, pumped = (
        PressureCylinder(**drive),
        CompressorCylinder(**drive, **pressures, clearance=0.05),
        PumpCylinder(**drive, **pressures),
    )
    return (
        TabledTorqueFile(file="torque.csv"),
        *(wave, HarmonicTorque(harmonics=(wave,))),
        *(gas, PressureTorqueFile(file="pressure.csv", cylinders=(gas,))),
        *(compressed, CompressorTorque(cylinders=(compressed,))),
        *(pumped, PumpTorque(cylinders=(pumped,))),
        Press(eccentric_radius=0.02, rod_length=0.1, file="force.csv"),
        Mark(angle=0.0, name="forming"),
    )


def kinds_of(base: type[Part]) -> Iterator[type[Part]]:
    """The kinds of part below a base, bases of several kinds left out."""
    for kind in base.__subclasses__():
        yield from kinds_of(kind) if kind.__subclasses__() else (kind,)


def marked() -> list[tuple[type[Part], str]]:
    return [(kind, name) for kind in every_part() for name in marks_of(kind)]


def si(mark: In, bound: float) -> float:
    return units.parse(f"{bound!r} {mark.unit}", mark.unit, "") if mark.unit else bound


def beyond(mark: In | Count) -> list[float]:
    """Values just out of the bounds, SI."""
    if isinstance(mark, Count):
        return [mark.at_least - 1, mark.at_most + 1]
    excluded = [si(mark, bound) for bound in (mark.above, mark.below) if isfinite(bound)]
    if isfinite(mark.at_least):
        excluded.append(nextafter(si(mark, mark.at_least), -inf))
    if isfinite(mark.at_most):
        excluded.append(nextafter(si(mark, mark.at_most), inf))
    return excluded


def within(mark: In | Count) -> list[float]:
    """The outermost values within the bounds, SI."""
    if isinstance(mark, Count):
        return [mark.at_least, mark.at_most]
    edges = [si(mark, bound) for bound in (mark.at_least, mark.at_most) if isfinite(bound)]
    if isfinite(mark.above):
        edges.append(nextafter(si(mark, mark.above), inf))
    if isfinite(mark.below):
        edges.append(nextafter(si(mark, mark.below), -inf))
    return edges


def written(mark: In | Count, value: float) -> float | str:
    """A value as a case file has it."""
    return units.format(value, mark.unit) if isinstance(mark, In) and mark.unit else value


def refused_in_python(part: Part, name: str, value: float) -> InputError:
    with pytest.raises(InputError) as refusal:
        replace(part, **{name: value})
    return refusal.value


def refused_as_text(part: Part, name: str, value: float | str) -> InputError:
    tables = tables_of(part) | {name: value}
    with pytest.raises(ValidationError) as refusal:
        section_of(type(part)).model_validate(tables, context={"materials": case().materials})
    return refusal_of(refusal.value)


def test_the_made_up_case_and_the_rest_are_all_parts_of_a_case() -> None:
    """Else a new kind of part would not be looked at below."""
    kinds = {each for each in kinds_of(Part) if each.__module__.startswith("camwright.")}
    of_cards = {
        each for each in kinds if each.__module__.startswith("camwright.pipeline.case.cards")
    }
    assert kinds - of_cards == set(every_part())


@pytest.mark.parametrize(("kind", "name"), marked(), ids=lambda each: getattr(each, "table", each))
def test_a_value_out_of_its_bounds_is_refused_in_python_as_in_text(
    kind: type[Part], name: str
) -> None:
    part, mark = every_part()[kind], marks_of(kind)[name]
    for value in beyond(mark):
        built = refused_in_python(part, name, value)
        assert built.field == f"{kind.table}.{name}"
        read = refused_as_text(part, name, written(mark, value))
        assert read.field == name
        if isinstance(mark, In):
            assert read.limit == built.limit == mark.limit
    for value in within(mark):
        mark.require(name, value)
        assert mark.read(written(mark, value)) == value


@pytest.mark.parametrize(("kind", "name"), marked(), ids=lambda each: getattr(each, "table", each))
def test_what_is_not_finite_is_refused(kind: type[Part], name: str) -> None:
    part = every_part()[kind]
    for value in (nan, inf, -inf):
        assert refused_in_python(part, name, value).field == f"{kind.table}.{name}"


def test_the_refusal_names_field_value_in_its_unit_and_bounds() -> None:
    with pytest.raises(InputError) as refusal:
        Spring(rate=-1, preload=1)
    message = "spring.rate = -0.001 kN/m, must be > 0 and <= 1e+06 kN/m"
    assert str(refusal.value) == message
    with pytest.raises(InputError) as refusal:
        Spring(rate=24e3, preload=nan)
    assert str(refusal.value) == "spring.preload = nan, must be >= -1e+09 and <= 1e+09 N"


def test_a_number_that_has_to_be_given_is_not_none() -> None:
    with pytest.raises(InputError, match=r"spring\.rate"):
        Spring(rate=None, preload=1.0)  # type: ignore[arg-type]
