"""Checks of a changed case, at its governing corners or as a preview; side effects of a change."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from camwright.geometry.contour import Contour
from camwright.geometry.errors import GeometryError
from camwright.geometry.lift import Lift
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.machine import Corner, machines
from camwright.pipeline.checks.check import Check, Declaration
from camwright.pipeline.checks.registry import CHECKS, DECLARED, TOLERANCED, checks_of
from camwright.pipeline.checks.tolerance_corners import (
    NOMINAL,
    Outcome,
    checks_at,
    corners_of,
    governed,
    outcomes,
)
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.solution import Solution, is_body, solution
from camwright.pipeline.follower.camshaft_loads import unbalance
from camwright.pipeline.search.remedies.lever_steps import without_exponent
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.torque.torque import Torque

_DECIDING = tuple(each for each in CHECKS if each.must_have and not each.evidence)
_SLIGHT = 0.01  # relative change of a figure up to which the remedy leaves it out


@dataclass(frozen=True)
class Headline:
    """Figures of a design: std of the crank torque, N m, None without an engine or where the
    follower leaves the cam or locks; peak pressure, Pa; mass of cam and follower, kg; greatest cam
    radius, m.
    """

    ripple: float | None
    pressure: float
    mass: float
    radius: float


@dataclass(frozen=True, eq=False)
class Preview:
    """Solved preview of a case; its checks are made when they are read.

    Parameters
    ----------
    solved : Solution
    governing : tuple   tolerance corners, besides the nominal, at which every check is judged
    worst : tuple       those at which the check of the remedy is judged
    """

    solved: Solution
    governing: tuple[Corner, ...]
    worst: tuple[Corner, ...]
    _outcomes: dict[str, dict[Corner, Outcome]] = field(default_factory=dict, init=False)

    def check(self, name: str, *, everywhere: bool = False) -> Check | None:
        """One check at its worst corner, or at every corner; None where it does not apply."""
        declared = DECLARED[name]
        corners = corners_of(self.solved.case) if everywhere else self.worst
        made = checks_of(self.solved, [declared])
        if made and declared in TOLERANCED and corners:
            made = governed(made, self._tried(declared, (NOMINAL, *corners)))
        return made[0] if made else None

    def _tried(self, declared: Declaration, corners: Sequence[Corner]) -> tuple[Outcome, ...]:
        """Outcomes of one check; a corner that is already solved is not solved again."""
        known = self._outcomes.setdefault(declared.id, {})
        left = [corner for corner in corners if corner not in known]
        if left:
            solved = self.solved
            made = outcomes(solved.case, solved.machines, solved.contour, left, [declared])
            known |= {outcome.corner: outcome for outcome in made}
        return tuple(known[corner] for corner in corners)

    @cached_property
    def checks(self) -> Mapping[str, Check]:
        """Every must-have check of the design at its worst corner, by id."""
        solved = self.solved
        made = checks_of(solved, _DECIDING)
        if self.governing:
            toleranced = [one for one in _DECIDING if one in TOLERANCED]
            corners = NOMINAL, *self.governing
            tried = outcomes(solved.case, solved.machines, solved.contour, corners, toleranced)
            made = governed(made, tried)
        return {one.id: one for one in made}

    @cached_property
    def headline(self) -> Headline:
        """Figures of the design."""
        solved, contour = self.solved, self.solved.contour
        cam, first = solved.case.cam, solved.cycles[0]
        # as in the headline of a run: after the follower has left the cam the loads are not its own
        sound = [cycle for cycle in solved.cycles if cycle.end is None]
        after = first.turn.torque_after if first in sound else None
        pressures = [float(np.max(cycle.contact.p0)) for cycle in sound]
        disc = unbalance(contour, cam.bore_radius, cam.keyway, cam.width, cam.material.density)
        return Headline(
            None if after is None else float(np.std(after)),
            max(pressures, default=math.nan),
            float(disc.mass) + solved.case.follower.mass,
            float(contour.radius_max().value),
        )


@dataclass(frozen=True, eq=False)
class Judge:
    """Checks of changed cases.

    Parameters
    ----------
    torques : mapping   engine torque by load case; no lever changes it
    lift : Lift         held by every case, that of a constrained synthesis; None: by the case
    corners : mapping   check -> names of its worst tolerance corners, the governing one first
    """

    torques: Mapping[str, Torque]
    lift: Lift | None
    corners: Mapping[str, Sequence[str]]

    def utilisations(self, case: Case, wanted: Collection[str]) -> dict[str, float]:
        """Utilisation of each check at its own governing corner by the coarse closed forms.

        At the nominal where no corner governs; infinite where it is not known.

        Raises
        ------
        CamError
            If the case has no such cam, or a corner no solution.
        """
        contour, declared = self._contour(case), [DECLARED[name] for name in wanted]
        known = {corner.name: corner for corner in corners_of(case)}
        governing = {
            name: known.get(next(iter(self.corners.get(name, ())), ""), NOMINAL) for name in wanted
        }
        corners = tuple(dict.fromkeys(governing.values()))
        made = checks_at(case, machines(case, self.torques), contour, corners, declared)
        by_corner = {
            corner: {one.id: one for one in checks}
            for corner, checks in zip(corners, made, strict=True)
        }
        return {name: used(by_corner[corner].get(name)) for name, corner in governing.items()}

    def preview(self, case: Case, wanted: Iterable[str], *, undercut: bool = False) -> Preview:
        """Preview of a case, judged at the corners that govern `wanted` and at their worst ones.

        Parameters
        ----------
        undercut : bool   judge an undercut contour as well

        Raises
        ------
        CamError
            If the case has no such cam, or it cannot be solved.
        """
        contour = self._contour(case, undercut=undercut)
        solved = solution(case, contour, Tier.PREVIEW, torques=self.torques, bounds=False)
        of_wanted = [self.corners.get(name, ()) for name in wanted]
        of_any = {names[0] for names in self.corners.values() if names}
        return Preview(
            solved,
            governing=tuple(self._named(case, {name for names in of_wanted for name in names[:1]})),
            worst=tuple(self._named(case, of_any.union(*of_wanted))),
        )

    def _contour(self, case: Case, *, undercut: bool = False) -> Contour:
        contour = case.contour(cam_lift(case, self.torques) if self.lift is None else self.lift)
        if not (undercut or is_body(contour)):
            raise GeometryError("the contour is undercut")
        return contour

    @staticmethod
    def _named(case: Case, names: Collection[str]) -> list[Corner]:
        """Corners of a case by their names."""
        return [corner for corner in corners_of(case) if corner.name in names]


def used(check: Check | None) -> float:
    """Utilisation of a check, its error bar included; infinite where it is not known."""
    if check is None or check.utilisation is None:
        return math.inf
    bar = 1.0 + (check.error_share or 0.0) if check.not_proven else 1.0
    return check.utilisation * bar


def effects(name: str, before: Preview, after: Preview) -> tuple[str, ...]:
    """Side effects of a change, the gravest first: checks that fail now, figures, checks cured.

    Parameters
    ----------
    name : str   check that the change cures
    """
    failing = newly_failing(before, after)
    cured = [
        each
        for each in _failing(before)
        if each != name and each in after.checks and after.checks[each].status == "pass"
    ]
    words = [f"fails {', '.join(failing)}"] if failing else []
    words += _figures(before.headline, after.headline)
    if cured:
        words.append(f"also cures {cured[0] if len(cured) == 1 else f'{len(cured)} others'}")
    return tuple(words)


def newly_failing(before: Preview, after: Preview) -> list[str]:
    """Ids of the must-have checks that fail after a change alone."""
    known = _failing(before)
    return [each for each in _failing(after) if each not in known]


def _failing(preview: Preview) -> list[str]:
    return [one.id for one in preview.checks.values() if one.must_have and one.status == "fail"]


def _figures(before: Headline, after: Headline) -> list[str]:
    """Figures of the headline that change."""
    words = []
    for label, unit, old, new in (
        ("ripple", "N m", before.ripple, after.ripple),
        ("p0", "MPa", before.pressure, after.pressure),
        ("cam radius", "mm", before.radius, after.radius),
    ):
        if old is not None and new is not None and abs(new - old) > _SLIGHT * abs(old):
            digits = 4 if unit == "MPa" else 3
            number = without_exponent(old, unit, digits).removesuffix(f" {unit}")
            words.append(f"{label} {number} -> {without_exponent(new, unit, digits)}")
    heavier = after.mass - before.mass
    if abs(heavier) > _SLIGHT * before.mass:
        words.append(
            f"{'adds' if heavier > 0 else 'saves'} {without_exponent(abs(heavier), 'g', 3)}"
        )
    return words
