"""Judge of changed cases: solution, checks and figures of a case with some values changed."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple, TypeVar

from camwright.geometry.contour import Contour
from camwright.geometry.errors import CamError, GeometryError
from camwright.geometry.lift import Lift
from camwright.pipeline.base.store import JSON, Store, key_of
from camwright.pipeline.base.worker_processes import crew
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
from camwright.pipeline.records.judgement_record import (
    ConflictJudgement,
    DraftJudgement,
    PreviewJudgement,
    RefusedJudgement,
)
from camwright.pipeline.results.trial import Trial
from camwright.pipeline.search.change import Applicable, Change
from camwright.pipeline.smoothing.required_lift import cam_lift
from camwright.pipeline.solver import certify_trial, checked, judged_at_corners, solve
from camwright.pipeline.torque.torque import Torque

STORED = "solved"
"""Folder of the stored judgements of a search."""
NOT_STORED: Store[Any] = Store(None, JSON)
NOT_RAISED: Mapping[str, float] = MappingProxyType({})
R = TypeVar("R", DraftJudgement, PreviewJudgement, ConflictJudgement)
_DECIDING = tuple(each for each in CHECKS if each.must_have and not each.evidence)


class Depth(NamedTuple):
    """Depth of the judgement of a drawn cam: tier, tolerance corners, bounds of the friction.

    Parameters
    ----------
    tier : Tier            of the solution
    corners : collection   names of the tolerance corners, besides the nominal, at which every
                           check is judged; None: every corner of the case
    worst : collection     names of those at which one check alone is judged
    undercut : bool        judge an undercut contour as well
    bounds : bool          solve the bounds of the friction, too
    """

    tier: Tier = Tier.PREVIEW
    corners: Collection[str] | None = ()
    worst: Collection[str] = ()
    undercut: bool = False
    bounds: bool = True


@dataclass(frozen=True, eq=False)
class Judgement:
    """Changed case with its solution; its checks are made on demand.

    Parameters
    ----------
    solved : Solution   of the changed case
    governing : tuple   tolerance corners, besides the nominal, at which every check is judged
    worst : tuple       those at which one check alone is judged
    whole : bool        every check is judged at every corner of the case
    drawn : Trial       of a synthesis, nominal; None: the cam is of none
    """

    solved: Solution
    governing: tuple[Corner, ...] = ()
    worst: tuple[Corner, ...] = ()
    whole: bool = False
    drawn: Trial | None = None
    _outcomes: dict[str, dict[Corner, Outcome]] = field(default_factory=dict, init=False)

    def check(self, name: str, *, everywhere: bool = False) -> Check | None:
        """One check of the changed case, with its worst demand over tolerance corners; None where
        it does not apply.

        Parameters
        ----------
        name : str          id of the check
        everywhere : bool   over all corners of the case; else over those in `worst`
        """
        declared = DECLARED[name]
        corners = corners_of(self.solved.case) if everywhere else self.worst
        made = checks_of(self.solved, [declared])
        if made and declared in TOLERANCED and corners:
            made = governed(made, self._outcomes_at(declared, (NOMINAL, *corners)))
        return made[0] if made else None

    def _outcomes_at(self, declared: Declaration, corners: Sequence[Corner]) -> tuple[Outcome, ...]:
        """Outcomes of one check at given tolerance corners, in their order; a corner already solved
        for the check is not solved again.
        """
        known = self._outcomes.setdefault(declared.id, {})
        left = [corner for corner in corners if corner not in known]
        if left:
            solved = self.solved
            made = outcomes(solved.case, solved.machines, solved.contour, left, [declared])
            known |= {outcome.corner: outcome for outcome in made}
        return tuple(known[corner] for corner in corners)

    @cached_property
    def checks(self) -> Mapping[str, Check]:
        """Every required check of the design by id, each with its worst demand over the governing
        corners.
        """
        solved = self.solved
        made = checks_of(solved, _DECIDING)
        if self.governing:
            toleranced = [one for one in _DECIDING if one in TOLERANCED]
            corners = NOMINAL, *self.governing
            tried = outcomes(solved.case, solved.machines, solved.contour, corners, toleranced)
            made = governed(made, tried)
        return {one.id: one for one in made}

    @cached_property
    def nominal(self) -> Trial:
        """The solution with all its checks, of evidence and of what may be left out, too."""
        return checked(self.solved) if self.drawn is None else self.drawn

    @cached_property
    def trial(self) -> Trial:
        """As `nominal`, with the checks at the corners of the judgement."""
        return judged_at_corners(self.nominal) if self.whole else self.nominal

    @property
    def every(self) -> tuple[Check, ...]:
        """All checks at the corners of the judgement, in the order of `in_order`."""
        return self.trial.checks

    @property
    def tried(self) -> tuple[Outcome, ...]:
        """Outcomes at every corner; empty where they are not tried."""
        return self.trial.corners

    def failing(
        self, ones: Collection[Declaration], raised: Mapping[str, float] = NOT_RAISED
    ) -> tuple[Check, ...]:
        """Checks of some declarations that fail; see `failing`."""
        return failing(self.every, ones, raised)

    @cached_property
    def record(self) -> PreviewJudgement:
        """Figures of a case with an engine; see `preview_figures`.

        Raises
        ------
        InputError
            If the case has no engine.
        """
        from camwright.pipeline.search.figures import preview_figures

        return preview_figures(self)


@dataclass(frozen=True, eq=False)
class Judge:
    """Judge of the changes of one case: torques, lift, cards and corners common to all.

    Parameters
    ----------
    base : Case
    torques : mapping   engine torque by load case; no change moves it
    folder : Path       of the user's cards; None: shipped cards only
    lift : Lift         held by every changed case; None: drawn from each
    corners : mapping   check -> names of its worst tolerance corners, the governing one first
    store : Store       of the records of judgements
    version : str       hash of the source, of which stored records are
    """

    base: Case
    torques: Mapping[str, Torque]
    folder: Path | None = None
    lift: Lift | None = None
    corners: Mapping[str, Sequence[str]] = field(default_factory=dict)
    store: Store[Any] = NOT_STORED
    version: str = ""

    def case(self, change: Applicable, *, quick: bool = False) -> Case:
        """The changed case.

        Parameters
        ----------
        quick : bool   put numbers in place, without reading the case anew; see `Change.replaced`

        Raises
        ------
        InputError
            If the values do not fit into the case.
        """
        if quick and isinstance(change, Change) and change.is_numbers_of(self.base):
            return change.replaced(self.base)
        return change.applied(self.base, self.folder)

    def used(self, change: Change, names: Collection[str]) -> dict[str, float]:
        """Utilisation of some checks in the changed case, by id, each at the tolerance corner that
        governs it in the base case, by coarse closed forms.

        At the nominal where no corner governs; infinite where a check cannot be evaluated.

        Parameters
        ----------
        change : Change      of the base case
        names : collection   ids of the checks

        Raises
        ------
        CamError
            If there is no such case or cam, or a corner has no solution.
        """
        case = self.case(change, quick=True)
        contour, declared = self._contour(case), [DECLARED[name] for name in names]
        known = {corner.name: corner for corner in corners_of(case)}
        governing = {
            name: known.get(next(iter(self.corners.get(name, ())), ""), NOMINAL) for name in names
        }
        corners = tuple(dict.fromkeys(governing.values()))
        made = checks_at(case, machines(case, self.torques), contour, corners, declared)
        by_corner = {
            corner: {one.id: one for one in checks}
            for corner, checks in zip(corners, made, strict=True)
        }
        return {name: used(by_corner[corner].get(name)) for name, corner in governing.items()}

    def judged(self, change: Applicable, depth: Depth, *, quick: bool = False) -> Judgement:
        """Judgement of the case with a change: its cam solved and checked to a depth.

        The lift is that of the judge or, if it has none, is calculated by the smoother of the
        changed case. The tolerance corners are those that `depth` names; all of them where it has
        None.

        Parameters
        ----------
        quick : bool   as that of `case`

        Raises
        ------
        CamError
            If there is no such case or cam, or it cannot be solved.
        """
        case = self.case(change, quick=quick)
        contour = self._contour(case, undercut=depth.undercut)
        solved = solution(case, contour, depth.tier, torques=self.torques, bounds=depth.bounds)
        governing, worst = (_named(case, names or ()) for names in (depth.corners, depth.worst))
        return Judgement(solved, governing, worst, whole=depth.corners is None)

    def synthesised(self, change: Applicable) -> Judgement:
        """Judgement of the changed case with the cam of its synthesis, at every corner.

        As in a preview: of the smoother, where the case has no constrained synthesis.

        Raises
        ------
        CamError
            As by `judged`.
        """
        return self._synthesised(self.case(change), corners=True)

    def run(self, change: Applicable, tier: Tier, *, corners: bool) -> Judgement:
        """Judgement of the changed case as a run solves it: with the cam of the lift of the judge
        or, if it has none, of the synthesis or smoothing feedback of the case.

        Nothing is read from the disk cache. Without a lift, finite elements are judged at the
        tolerance corners whatever `corners`.

        Parameters
        ----------
        change : Applicable   of the base case
        tier : Tier           depth of the solution
        corners : bool        whether the checks are judged at the tolerance corners

        Raises
        ------
        CamError
            As by `judged`.
        """
        from camwright.pipeline.iteration import trials_of
        from camwright.pipeline.preview import preview_case

        case = self.case(change)
        if self.lift is not None:
            contour = case.contour(self.lift)
            drawn = solve(case, contour, tier=tier, torques=self.torques, corners=corners)
        elif tier <= Tier.PREVIEW:
            drawn = preview_case(case, corners=corners, torques=self.torques)
        else:
            drawn = trials_of(case, self.torques, tier=tier).final
            if tier is Tier.CERTIFIED:
                with crew(1) as workers:
                    drawn = certify_trial(drawn, workers)
        return Judgement(drawn.solution, drawn=drawn)

    def _synthesised(self, case: Case, *, corners: bool) -> Judgement:
        from camwright.pipeline.preview import preview_case

        drawn = preview_case(case, corners=False, kept=True, torques=self.torques)
        return Judgement(drawn.solution, whole=corners, drawn=drawn)

    def previewed(
        self, change: Applicable, *, corners: bool = True
    ) -> PreviewJudgement | RefusedJudgement:
        """Record of the judgement with the cam of the synthesis, from the store or judged.

        Parameters
        ----------
        corners : bool   judge each check at its worst tolerance corner
        """

        def record(case: Case) -> PreviewJudgement:
            return self._synthesised(case, corners=corners).record

        return self.stored(change, "preview" if corners else "nominal", record)

    def drafted(
        self, change: Applicable, *, fine: bool = False
    ) -> DraftJudgement | RefusedJudgement:
        """Record of the synthesis of the changed case alone, from the store or solved.

        Parameters
        ----------
        fine : bool   as that of `draft_figures`
        """

        def record(case: Case) -> DraftJudgement:
            from camwright.pipeline.search.figures import draft_figures

            return draft_figures(case, self.torques, fine=fine)

        return self.stored(change, "synthesis" if fine else "draft", record)

    def stored(
        self, change: Applicable, kind: str, record: Callable[[Case], R]
    ) -> R | RefusedJudgement:
        """Record of a changed case, from the store or made; a refusal is a record, too.

        A stored one is of the same kind, source, libraries, cases and included files.

        Parameters
        ----------
        kind : str          of the record; it says how deep the judgement is
        record : function   changed case -> record
        """
        try:
            case = self.case(change)
        except CamError as error:
            return refusal(error)

        def judged() -> R | RefusedJudgement:
            try:
                return record(case)
            except CamError as error:
                return refusal(error)

        key = key_of(kind, (self.version, self._base_sha256, case.sha256))
        stored: R | RefusedJudgement = self.store.kept(key, judged, _is_judgement)
        return stored

    @cached_property
    def _base_sha256(self) -> str:
        """Hash of the case of which the torques are."""
        return self.base.sha256

    def _contour(self, case: Case, *, undercut: bool = False) -> Contour:
        """Contour of a case with the lift of the judge or, if it has none, of the smoother of the
        case.

        Parameters
        ----------
        undercut : bool   whether an undercut contour is accepted

        Raises
        ------
        GeometryError
            If the contour is undercut and may not be.
        """
        contour = case.contour(cam_lift(case, self.torques) if self.lift is None else self.lift)
        if not (undercut or is_body(contour)):
            raise GeometryError("the contour is undercut")
        return contour


def judgements(folder: Path) -> Store[Any]:
    """Stored judgements of a folder."""
    return Store(folder / STORED, JSON)


def refusal(error: CamError) -> RefusedJudgement:
    """Judgement of a case that is refused, or has no cam."""
    return {"feasible": False, "why": str(error)}


def _is_judgement(record: Mapping[str, object]) -> bool:
    return "feasible" in record


def _named(case: Case, names: Collection[str]) -> tuple[Corner, ...]:
    """Corners of a case by their names."""
    return tuple(corner for corner in corners_of(case) if corner.name in names) if names else ()


def used(check: Check | None) -> float:
    """Utilisation of a check, of one that is not proven with its error bar added; infinite where
    unknown.
    """
    if check is None or check.utilisation is None:
        return math.inf
    bar = 1.0 + (check.error_share or 0.0) if check.not_proven else 1.0
    return check.utilisation * bar


def failing(
    checks: Iterable[Check],
    ones: Collection[Declaration],
    raised: Mapping[str, float] = NOT_RAISED,
) -> tuple[Check, ...]:
    """Must-have checks that fail, or would at a utilisation raised by a factor.

    Parameters
    ----------
    ones : collection   declarations of the checks
    raised : mapping    factor by id of the check
    """

    def fails(check: Check) -> bool:
        factor = raised.get(check.id, 1.0) if check.status == "pass" else 1.0
        return check.status == "fail" or (
            factor > 1.0 and (check.utilisation or 0.0) * factor > 1.0
        )

    required = (each for each in checks if each.declaration in ones and each.must_have)
    return tuple(each for each in required if fails(each))
