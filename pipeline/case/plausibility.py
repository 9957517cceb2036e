"""Plausibility of case values against the usual ranges of `usual_ranges.toml`.

Such a value is allowed; it is stated with the consistency of the inputs, and that of a single
key is to be confirmed.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from math import pi
from typing import Any

import numpy as np

from camwright.pipeline.base.hardness_rules import endurance_by_hardness
from camwright.pipeline.base.source import Source, source_in
from camwright.pipeline.base.units import celsius, in_unit, shown
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import text_of, value_of
from camwright.pipeline.case.external_load import closing_preload
from camwright.pipeline.case.given_lift import table_overshoot
from camwright.pipeline.case.load_case_torque import pressure, torque_key
from camwright.pipeline.engine.crankshaft import energy_swing
from camwright.pipeline.engine.pressure_trace import PressureTable
from camwright.pipeline.engine.torque_consistency import Implied
from camwright.pipeline.follower.spring import stored_lift
from camwright.pipeline.torque.motor_line import MotorLine
from camwright.pipeline.torque.torque import Torque

PLAUSIBILITY = "plausibility"
"""Id of a finding on a value beyond its usual range."""


@dataclass(frozen=True)
class Usual:
    """Usual range of a quantity in `unit`, with source and the keys it applies to."""

    unit: str
    low: float
    high: float
    source: Source
    keys: Sequence[str] = ()

    def finding(self, title: str, value: float, text: str) -> Implied | None:
        """Finding on a value more than 10 % outside the usual range; None otherwise.

        Parameters
        ----------
        title : str     of the finding, such as the key
        value : float   SI
        text : str      words that state the value
        """
        stated = in_unit(value, self.unit)
        nearest = min(max(stated, self.low), self.high)
        unit = f" {self.unit}".replace(" -", "")
        words = f"{text}, usually {self.low:g} to {self.high:g}{unit} ({self.source.text})"
        made = Implied(PLAUSIBILITY, title, stated, nearest, self.unit, words)
        return made if made.flagged else None


def implausible(case: Case, torques: Mapping[str, Torque]) -> tuple[Implied, ...]:
    """Findings on values of a case that are outside their usual ranges or contradict one another.

    Single keys; a lift table and the curve through it; the peak-to-peak torque; friction and dead
    centre of a measured cylinder pressure; the speed at which a motor carries the mean torque; oil,
    temperatures and bushes; and, where torque and spring are usual so far, the spring against the
    energy swing of the torque of the design load case.

    Parameters
    ----------
    torques : mapping   torque over the crank angle, N m, by the name of the load case
    """
    judged: list[Implied | None] = [*beyond_ranges(case), _lift_finding(case)]
    judged += _torque_findings(case, torques)
    judged += _pressure_findings(case)
    judged += _motor_findings(case, torques)
    judged.append(_oil_finding(case))
    judged += _temperature_findings(case)
    judged += _bush_findings(case)
    findings = [one for one in judged if one is not None]
    if not {one.title for one in findings} & {"spring.rate", "spring.preload", *_TORQUES}:
        findings += _spring_findings(case, torques)
    return tuple(findings)


def beyond_ranges(case: Case) -> tuple[Implied, ...]:
    """Findings on single keys: absolute range, by hardness, by balance grade.

    They are to be confirmed, whatever their source.
    """
    judged = [_balance_finding(case), *_endurance_findings(case)]
    for usual in _ranges():
        for key in _keys_in(case, usual.keys):
            value = value_of(case, key)
            absent = key.startswith("spring.") and case.spring.absent
            if isinstance(value, float) and not absent:
                size = abs(value) if key == case.spring.preload_key else value  # it may pull
                judged.append(usual.finding(key, size, f"{key} = {text_of(case, key)}"))
    return tuple(one for one in judged if one is not None)


_OF_RULE = 2.0
"""Endurance of a card over the greatest that its hardness lets expect: 1.9 is in Rothbart's table
9.3 for AISI 1020 of 130 to 150 HB against Buckingham's estimate."""


def _endurance_findings(case: Case) -> Iterator[Implied | None]:
    """Findings on endurance pressures of the materials against the rules for a steel of their
    hardness; None for one within them.
    """
    for name, card in case.materials.items():
        known = endurance_by_hardness(card)
        for field in ("endurance_pressure", "sliding_endurance_pressure"):
            key = f"materials.{name}.{field}"
            value = value_of(case, key)
            if value is None or not known:
                continue
            most = max(known, key=known.__getitem__)
            words = f"{key} = {text_of(case, key)}: {value / known[most]:.3g} times that by its"
            words += f" hardness, {shown(known[most], 'MPa')} by {most}, usually up to"
            words += f" {_OF_RULE:g} times"
            stated, kept = (
                in_unit(each, "MPa") for each in (value, min(value, _OF_RULE * known[most]))
            )
            made = Implied(PLAUSIBILITY, key, stated, kept, "MPa", words)
            yield made if made.flagged else None


_OVERSHOOT = 0.01
"""Share of the stroke by which a smooth lift leaves its points 4 deg apart at most: t^2 s''/8 of a
cycloidal rise in 60 deg is 0.4 %."""


def _lift_finding(case: Case) -> Implied | None:
    """The curve through a lift table beyond its points, as beside a step or a kink of the lift."""
    over = table_overshoot(case)
    if over is None or over[0] <= _OVERSHOOT:
        return None
    share, place = over
    words = f"lift.file: the curve through its points leaves them by {share:.2%} of the stroke at "
    words += f"{shown(place, 'deg')}; loads and flights there are those of the curve: set more "
    words += "points where the lift bends sharply, or state lift.noise of a measured table"
    return Implied(PLAUSIBILITY, "lift.file", share, 0.0, "-", words)


_TORQUES = ("engine", "engine.file", "torque", "torque.file")


def _torque_findings(case: Case, torques: Mapping[str, Torque]) -> Iterator[Implied | None]:
    """Findings on the peak-to-peak torque in the design load case, and in those with a file of
    their own; None where it is usual.
    """
    for k, state in enumerate(case.load_cases):
        torque = torques.get(state.name)
        if torque is None or (state.torque is None and k > 0):
            continue
        key = torque_key(case, state.name)
        swing = float(np.ptp(torque.total))
        level = "torque" if swing > 0.0 else "constant torque"
        text = f"{key}: {level}, peak to peak = {shown(swing, 'N m')}"
        yield _usual("torque").finding(key, swing, text)


def _pressure_findings(case: Case) -> Iterator[Implied | None]:
    """Findings on a measured cylinder pressure: friction that the brake torque leaves, and lead of
    the motored peak; None where they are usual.
    """
    if not isinstance(case.engine, PressureTable):
        return
    balance, _ = pressure(case, case.engine)
    friction, lead = balance.friction_pressure, balance.motored_lead
    if friction is not None:
        key = "engine.brake_torque" if case.engine.brake_power is None else "engine.brake_power"
        text = f"{key} = {text_of(case, key)}: indicated less brake torque is a friction mean "
        text += f"effective pressure of {shown(friction, 'kPa')}"
        yield _usual("friction").finding(key, friction, text)
        stated = case.engine.friction_pressure
        if stated is not None:
            key = "engine.friction_pressure"
            words = f"{key} = {text_of(case, key)}, but {text}"
            made = Implied(PLAUSIBILITY, key, 1e-3 * stated, 1e-3 * friction, "kPa", words)
            yield made if made.flagged else None
    if lead is not None:
        text = f"engine.motored_file: peak {shown(lead, 'deg')} before the dead centre"
        yield _usual("motored_lead").finding("engine.motored_file", lead, text)


def _motor_findings(case: Case, torques: Mapping[str, Torque]) -> Iterator[Implied | None]:
    """Findings on the speed of a load case against that at which the motor line carries the mean
    torque; None where both agree.
    """
    motor = None if case.crankshaft is None else case.crankshaft.load
    if not isinstance(motor, MotorLine):
        return
    for k, state in enumerate(case.load_cases):
        torque = torques.get(state.name)
        if torque is None or not state.speed > 0.0:
            continue
        key, speed = f"load_case[{k}].speed", motor.balance(-torque.mean)
        words = f"{key} = {shown(state.speed, 'rpm')}, but crankshaft.motor_line carries the mean"
        words += f" torque of {shown(-torque.mean, 'N m')} at {shown(speed, 'rpm')}"
        stated, carried = (in_unit(each, "rpm") for each in (state.speed, speed))
        made = Implied(PLAUSIBILITY, key, stated, carried, "rpm", words)
        yield made if made.flagged else None


_SURROUNDED = ("lubricant", "roller.bearing", "spring.design", "spring.gas")


def _temperature_findings(case: Case) -> Iterator[Implied | None]:
    """Findings on temperatures of parts in operation below that of their surroundings; None where
    the difference is small.
    """
    around = ("guides.ambient_temperature", "cooling.ambient_temperature")
    warm = {key: value for key in around if (value := value_of(case, key)) is not None}
    warmest = max(warm, key=warm.__getitem__)
    for part in _SURROUNDED:
        key = f"{part}.temperature"
        value = value_of(case, key)
        if value is None or value >= warm[warmest]:
            continue
        stated, least = (float(celsius(each)) for each in (value, warm[warmest]))
        words = f"{key} = {text_of(case, key)}, but {warmest} = {text_of(case, warmest)}: in"
        words += " operation no part is colder than its surroundings"
        made = Implied(PLAUSIBILITY, key, stated, least, "degC", words)
        yield made if made.flagged else None


def _bush_findings(case: Case) -> Iterator[Implied | None]:
    """Findings on bushes of another diameter than the stem that runs in them; None where the
    difference is small.
    """
    stem = "follower.stem_diameter"
    through = value_of(case, stem)
    for key in ("guides.a.diameter", "guides.b.diameter"):
        value = value_of(case, key)
        if value is None or through is None:
            continue
        stated, least = (in_unit(each, "mm") for each in (value, through))
        words = f"{key} = {text_of(case, key)}, but {stem} = {text_of(case, stem)}: the stem bends"
        words += " as one of a single diameter, and does not touch a wider bush"
        made = Implied(PLAUSIBILITY, key, stated, least, "mm", words)
        yield made if made.flagged else None


_BALANCED = 1e-6
"""Eccentricity that a balancing bench reaches, m: 0.5 to 1 g mm/kg, practice of their makers,
recalled."""


def _balance_finding(case: Case) -> Implied | None:
    """Finding on the unbalance that a balancing bench leaves on the camshaft, as a balance grade,
    residual over rotor mass times cam speed; None where it is usual, zero or not stated.

    Without a stated mass that of the cam up to its base circle and of the shaft between its
    bearings, which the rotor exceeds, so that its grade is finer still: a coarse one is no finding
    then. A fine grade of a slow cam whose eccentricity a bench can reach is usual.
    """
    key, other = "camshaft.counterweight.residual", "camshaft.rotor_mass"
    residual, mass = value_of(case, key), value_of(case, other)
    if residual is None:
        return None
    words, rotor = f"{other} = {text_of(case, other)}", mass
    if mass is None:
        rotor = _least_rotor_mass(case)
        words = f"{shown(rotor, 'g')} of cam and shaft alone"
    fastest = max(state.speed for state in case.load_cases) / case.mechanism.gear_ratio
    eccentricity = residual / rotor
    grade = eccentricity * fastest
    if not grade > 0.0:
        return None
    text = f"{key} = {text_of(case, key)}: at {words} and"
    text += f" {shown(fastest, 'rpm')} of the cam a grade of G {in_unit(grade, 'mm/s'):.2g}"
    usual = _usual("balance_grade")
    is_fine = in_unit(grade, usual.unit) < usual.low
    if eccentricity >= _BALANCED if is_fine else mass is None:
        return None
    return usual.finding(key, grade, text)


def _least_rotor_mass(case: Case) -> float:
    """Mass of the cam up to its base circle and of the shaft between its bearings, kg."""
    cam, shaft = case.cam, case.camshaft
    ring = max(case.base_circle, cam.bore_radius) ** 2 - cam.bore_radius**2
    mass = pi * cam.material.density * ring * cam.width
    if shaft is None or shaft.diameter is None:
        return mass
    card = cam.material if shaft.material is None else shaft.material
    return mass + 0.25 * pi * card.density * shaft.diameter**2 * shaft.bearing_spacing


_OIL_DENSITY = 870.0  # kg/m^3, of mineral oil, 850 to 900
_ONE_OIL = 2.0
"""Greatest ratio of two viscosities of one oil: 20 K of a mineral oil apart."""


def _oil_finding(case: Case) -> Implied | None:
    """Finding on the viscosity of the oil at the cam against that in the roller bearing; None where
    both can be of one oil, or one is not stated.
    """
    key, other = "lubricant.viscosity", "roller.bearing.viscosity"
    dynamic, bearing = value_of(case, key), value_of(case, other)
    oiled = value_of(case, "roller.bearing.lubrication") == "oil"
    if dynamic is None or bearing is None or not oiled:
        return None
    at_cam = dynamic / _OIL_DENSITY
    nearest = float(np.clip(at_cam, bearing / _ONE_OIL, bearing * _ONE_OIL))
    words = (
        f"{key} = {text_of(case, key)}, {shown(at_cam, 'mm^2/s', 3)} of a mineral oil, but {other}"
    )
    words += f" = {text_of(case, other)}: of one oil both are as at one temperature"
    stated, kept = (in_unit(each, "mm^2/s") for each in (at_cam, nearest))
    made = Implied(PLAUSIBILITY, key, stated, kept, "mm^2/s", words)
    return made if made.flagged else None


def _spring_findings(case: Case, torques: Mapping[str, Torque]) -> Iterator[Implied]:
    """Finding on the spring against the energy swing of the torque, by the share that its rate
    stores or by the lift; at most one, and none where the synthesis chooses the spring.
    """
    torque, smoothing, spring = torques.get(case.load_cases[0].name), case.smoothing, case.spring
    chosen = smoothing.kind == "constrained" and smoothing.of_spring
    if torque is None or chosen or (case.cam.pulls and closing_preload(case) <= 0.0):
        return
    swing = case.mechanism.compensation * float(np.ptp(energy_swing(torque.total, torque.span)))
    lift = float(stored_lift(swing, spring.rate, closing_preload(case), spring.shape))
    of_rate, of_radius = 0.5 * spring.rate * lift**2 / swing, lift / case.cam.prime_radius
    of_torque = f"of the energy swing of the torque, {shown(swing, 'J')}"
    rate = f"spring.rate = {text_of(case, 'spring.rate')}"
    stores = f"{rate}: it stores {of_rate:.2g} {of_torque}, the preload the rest"
    stiff = of_rate < 0.5 and lift < case.cam.prime_radius
    key = "spring.preload" if stiff else "spring.rate"
    deflects = (
        f"{key} = {text_of(case, key)}: storage {of_torque}, takes a lift of {shown(lift, 'mm')}, "
        f"{of_radius:.2g} of cam.prime_radius = {text_of(case, 'cam.prime_radius')}"
    )
    for one in (
        _usual("rate_share").finding("spring.rate", of_rate, stores),
        _usual("lift").finding(key, of_radius, deflects),
    ):
        if one is not None:
            yield one
            return


def _keys_in(case: Case, keys: Sequence[str]) -> Iterator[str]:
    """Dotted keys of a case for which patterns stand; ``materials.*`` stands for every material."""
    for key in keys:
        if key.startswith("materials.*"):
            yield from (key.replace("*", name) for name in case.materials)
        else:
            yield key


@cache
def _table() -> Mapping[str, Any]:
    text = files(__package__).joinpath("usual_ranges.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def _usual(name: str) -> Usual:
    return _range(_table()[name])


@cache
def _ranges() -> tuple[Usual, ...]:
    return tuple(map(_range, _table()["usual"]))


def _range(row: Mapping[str, Any]) -> Usual:
    return Usual(**{**row, "source": source_in(row["source"])})


def usual_sources() -> Iterator[tuple[str, Source]]:
    """Name, by its first key, and source of each usual range."""
    for row in _ranges():
        yield f"usual_ranges.{row.keys[0]}", row.source
    for name, row in _table().items():
        if name != "usual":
            yield f"usual_ranges.{name}", _range(row).source
