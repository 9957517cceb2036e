"""Steps of a lever: changed values as text, and the case with them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

from camwright.pipeline.base import units
from camwright.pipeline.base.levers import (
    BEARING,
    CAM_MATERIAL,
    Catalogued,
    Crowned,
    Drilled,
    Lever,
    Scaled,
)
from camwright.pipeline.base.material import Material
from camwright.pipeline.base.quantities import marks_of
from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.cards.catalogue import Catalogue, catalogue_of
from camwright.pipeline.case.case import Case
from camwright.pipeline.case.case_values import unit_at, value_of
from camwright.pipeline.contact.cam_body import BalanceHole
from camwright.pipeline.contact.rolling_bearing import Bearing
from camwright.pipeline.follower.guide_reactions import Guide
from camwright.pipeline.search.change import Change, number_of

_DESIGN_DIGITS = 3  # of a value that a designer writes
_OF_RATING = 0.05  # share of the rating in the change of a bearing; the rest is its dimensions
_CROWNS = (0.5, 1.0)  # line loads of the first crown over the greatest one
_HEAVIER = 2.0  # ratio of the drops of a crown and of the next heavier or lighter one
_SLIGHT = Decimal("1e-9")  # relative: a value is rounded up unless it is one of these digits


class Step(NamedTuple):
    """Step of a lever: changed values as text, and size of the change.

    Parameters
    ----------
    change : Change   texts as in a case file, or the name of a card
    size : float      |ln| of the ratio of the new value to that of the case
    figure : str      rating of a card in words; "": none
    """

    change: Change
    size: float
    figure: str = ""


@dataclass(frozen=True, eq=False)
class Workbench:
    """Case with the user's cards, in which levers are applied.

    Parameters
    ----------
    folder : Path       None: shipped cards only
    line_load : float   greatest line load of the case, N/m, for which a crown is drawn; None: none
    """

    case: Case
    folder: Path | None
    line_load: float | None = None

    @cached_property
    def parts(self) -> Catalogue:
        """Rollers, springs and bushes of the catalogue."""
        return catalogue_of(self.folder)

    def acts(self, lever: Lever) -> bool:
        """Whether the case has what a lever changes, so that the lever can be applied."""
        case = self.case
        if isinstance(lever, Drilled):
            return case.cam.counter_hole is None
        if isinstance(lever, Crowned):
            return bool(self.crowns(lever))
        if isinstance(lever, Catalogued):
            if lever.key == BEARING:
                return "roller_bearing" in case.facing.parts and case.scope.covers("roller_bearing")
            return lever.key == CAM_MATERIAL or lever.key in case.bushes
        drawn = case.balances and case.smoothing.kind in lever.smoothers
        if lever.smoothers and not drawn:
            return False
        first = self._numbers(lever.keys)
        return bool(first) and next(iter(first.values())) > 0.0

    def scaled(self, lever: Scaled, size: float) -> Step:
        """Step of a lever that multiplies values of the case by exp(size) or exp(-size), by its
        direction; rounded to few digits, away from the values of the case.

        Keys in `along` of the lever change by the same difference as its first key.

        Parameters
        ----------
        lever : Scaled   keys and direction
        size : float     logarithm of the factor, > 0
        """
        factor = math.exp(lever.direction * size)
        before = self._numbers(lever.keys)
        texts: dict[str, str] = {}
        first, *_ = before
        for key, value in before.items():
            texts[key] = _rounded(key, value * factor, lever.direction)
        new = number_of(first, texts[first])
        for key, value in self._numbers(lever.along).items():
            texts[key] = _text(key, value + new - before[first])
        return Step(Change.of(texts), abs(math.log(new / before[first])))

    def cards(self, lever: Catalogued) -> list[Step]:
        """Steps of a lever to each card of the catalogue with a better rating than the part of the
        case, the smallest change first.

        The size of a step is the logarithm of the ratio of both ratings; for a bearing its share
        `_OF_RATING`, with the change of the dimensions.
        """
        here, unit = self.rating_here(lever), self.unit(lever)
        steps: list[tuple[float, float, Step]] = []
        for name, rating in self._ratings(lever).items():
            ratio = 0.0 if here is None else math.log(rating / here)
            if here is not None and not (ratio < 0.0 if lever.less else ratio > 0.0):
                continue
            size = abs(ratio)
            if lever.key == BEARING:
                size = self._resized(name) + _OF_RATING * size
            words = f"{lever.rating.replace('_', ' ')} {without_exponent(rating, unit)}"
            steps.append((size, rating, Step(Change(((lever.key, name),)), size, words)))
        return [step for *_, step in sorted(steps, key=lambda each: each[:2])]

    def _resized(self, name: str) -> float:
        """Size of the change of the diameter and width of the roller to those of a bearing."""
        card, roller = self.parts.rollers[name], self.case.roller
        ratios = 0.5 * card.outer_diameter / roller.radius, card.width / roller.width
        return sum(abs(math.log(ratio)) for ratio in ratios)

    def rating(self, lever: Catalogued, card: str) -> float:
        """Rating of a card, SI."""
        return self._ratings(lever)[card]

    @staticmethod
    def unit(lever: Catalogued) -> str:
        """Unit of the rating of a lever."""
        part = {BEARING: BearingCard, CAM_MATERIAL: Material}.get(lever.key, Guide)
        return marks_of(part)[lever.rating].unit

    def drilled(self, lever: Drilled) -> Step:
        """Step that adds a counter-hole, counted as the smallest change."""
        return Step(Change(((lever.key, units.format(BalanceHole().wall, "mm")),)), 0.0)

    def crowns(self, lever: Crowned) -> list[Step]:
        """Steps that add a crown to the follower or change its radius or design load; they rank
        before all other changes or by the ratio of the values.

        Empty without the ends of both bodies, where a table or a standard states the crown, and
        where a crown would be added without a known line load.
        """
        facing = self.case.facing
        key, crown = f"{facing.table}.crown", facing.crown
        if self.case.cam.end is None or facing.end is None:
            return []
        if crown is None:
            if self.line_load is None or not lever.first:
                return []
            at = f"{key}.line_load"
            texts = [_rounded(at, share * self.line_load, 1) for share in _CROWNS]
            kind = f"{key}.kind", "johns_gohar"
            return [Step(Change((kind, (at, text))), 0.0) for text in texts]
        for name, value in (("radius", crown.radius), ("line_load", crown.line_load)):
            if value is not None:
                at = f"{key}.{name}"
                ratios = ((1.0 / _HEAVIER, -1), (_HEAVIER, 1))
                return [
                    Step(Change(((at, _rounded(at, value * ratio, side)),)), math.log(_HEAVIER))
                    for ratio, side in ratios
                ]
        return []

    def _numbers(self, keys: tuple[str, ...]) -> dict[str, float]:
        """Numbers of the case, SI, at those of the keys that it has, by key.

        Parameters
        ----------
        keys : tuple of str   dotted; `[*]` stands for every load case, `{cam}` for the material of
                              the cam
        """
        numbers: dict[str, float] = {}
        for pattern in keys:
            name = pattern.replace("{cam}", self.case.cam.material.name)
            count = len(self.case.load_cases) if "[*]" in name else 1
            for key in (name.replace("*", str(k)) for k in range(count)):
                value = value_of(self.case, key)
                if isinstance(value, float):
                    numbers[key] = value
        return numbers

    def _ratings(self, lever: Catalogued) -> dict[str, float]:
        """Rating of each card of the catalogue by its name, SI, as the lever compares it; cards
        without a rating are left out.
        """
        if lever.key == BEARING:
            known = {name: getattr(card, lever.rating) for name, card in self.parts.rollers.items()}
            return {name: value for name, value in known.items() if value is not None}
        material = lever.key == CAM_MATERIAL
        mark = marks_of(Material if material else Guide)[lever.rating]
        cards = known_cards(self.folder)["materials" if material else "bushes"]
        known = {
            name: card.get(lever.rating, card.get("friction") if lever.less else None)
            for name, card in cards.items()
        }
        return {name: mark.read(value) for name, value in known.items() if value is not None}

    def rating_here(self, lever: Catalogued) -> float | None:
        """Rating of the case's own part, SI; None where it states none."""
        case = self.case
        if lever.key == CAM_MATERIAL:
            card = case.cam.material
            if lever.rating == "endurance_pressure":
                return card.endurance(sliding=case.facing.slides).pressure
            return float(getattr(card, lever.rating))
        if lever.key == BEARING:
            part: Bearing | Guide = case.roller.bearing
        else:
            part = case.bushes[lever.key]
        value: float | None = getattr(part, lever.rating)
        if value is None and isinstance(part, Guide) and lever.less:
            return part.friction
        return value


def without_exponent(value: float, unit: str, digits: int = 4) -> str:
    """A value (SI) as text in a unit without an exponent, such as ``27710 rpm``."""
    number = f"{float(f'{units.in_unit(value, unit) if unit else value:.{digits}g}'):.10g}"
    return f"{number} {unit}" if unit else number


def _rounded(key: str, value: float, direction: int) -> str:
    """Value as text in the unit of its key, rounded to a few digits.

    Parameters
    ----------
    key : str         dotted, of the case file
    value : float     SI
    direction : int   > 0: rounded up; else down
    """
    unit = unit_at(key)
    exact = Decimal(units.in_unit(value, unit) if unit else value)
    digit = Decimal(1).scaleb(exact.adjusted() - _DESIGN_DIGITS + 1)
    slack = abs(exact) * _SLIGHT
    away = ROUND_CEILING if direction > 0 else ROUND_FLOOR
    number = f"{((exact - direction * slack) / digit).to_integral_value(away) * digit:f}"
    number = number.rstrip("0").rstrip(".") if "." in number else number
    return f"{number} {unit}" if unit else number


def _text(key: str, value: float) -> str:
    """Text of a value (SI), to six digits."""
    return units.shown(value, unit_at(key), 6)
