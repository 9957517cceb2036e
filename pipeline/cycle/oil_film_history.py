"""Oil film between cam and follower over the turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array, freeze
from camwright.pipeline.base.tables import Column
from camwright.pipeline.case.machine import Machine
from camwright.pipeline.contact.contact_history import ContactHistory
from camwright.pipeline.contact.oil_film import (
    LineFilm,
    MixedFilm,
    lambda_ratio,
    minimum_film,
    mixed_film,
)
from camwright.pipeline.records.trial_contents import MixedFilmRecord

VICKERS = 9.80665e6  # Pa
_UM = 1e6


@dataclass(frozen=True, eq=False)
class FilmHistory:
    """Minimum film thickness (n,), m, of smooth surfaces over a turn, and a mixed film.

    ratio (n,) is film thickness over combined roughness; None if a roughness is unknown. mixed is
    the film of rough surfaces by a regression of unverified source, NaN outside its range; None if
    the case states the smooth film. refusal is the reason at the first such position.
    """

    thickness: Array
    ratio: Array | None = None
    mixed: MixedFilm | None = None
    refusal: str = ""

    def __post_init__(self) -> None:
        freeze(self, thickness=self.thickness)

    def columns(self) -> dict[Column, Array]:
        """Columns (n,) of ``5_cycle.csv``: smooth film, ratio to the roughness, mixed film, as far
        as they are known.
        """
        smooth = Column(
            "film_thickness", "um", "Minimum film thickness of smooth surfaces", unknown=True
        )
        columns = {smooth: self.thickness}
        if self.ratio is not None:
            ratio = Column(
                "film_thickness_ratio", "", "Film thickness over combined roughness", unknown=True
            )
            columns[ratio] = self.ratio
        if (mixed := self.mixed) is not None:
            columns |= {
                Column(
                    "film_thickness_mixed",
                    "um",
                    "Minimum film thickness of rough surfaces",
                    unknown=True,
                ): mixed.minimum,
                Column(
                    "film_thickness_mixed_central",
                    "um",
                    "Central film thickness of rough surfaces",
                    unknown=True,
                ): mixed.central,
                Column(
                    "asperity_load_share", "", "Share of the load on asperities", unknown=True
                ): mixed.asperity_share,
            }
        return columns

    def record(self) -> MixedFilmRecord | None:
        """Record of the mixed film in ``trial.json``; None without one."""
        if self.mixed is None:
            return None
        finite = np.isfinite(self.mixed.minimum)
        minimum = _UM * float(self.mixed.minimum[finite].min()) if finite.any() else None
        return {
            "minimum_um": minimum,
            "positions_refused": int((~finite & np.isfinite(self.thickness)).sum()),
            "refusal": self.refusal,
            "source": str(self.mixed.source),
        }


def film_history(
    machine: Machine, contact: ContactHistory, entrainment: Array, rise: float = 0.0
) -> FilmHistory | None:
    """Oil film at entrainment speeds (n,), m/s; None without a lubricant.

    Parameters
    ----------
    rise : float   of the bodies over the oil, K: at the inlet the oil is as warm as they

    References
    ----------
    ISO/TS 6336-22 takes the film at the bulk temperature, recalled: verify.
    """
    oil, modulus = machine.lubricant, machine.contact_modulus
    if oil is None:
        return None
    groups = LineFilm.of(
        contact.line_load,
        contact.relative_radius,
        modulus,
        entrainment,
        oil.warmer(rise),
    )
    thickness = minimum_film(groups)
    cam, other = machine.cam.roughness, machine.follower.roughness
    if cam is None or other is None:
        return FilmHistory(thickness)
    ratio = lambda_ratio(thickness, cam, other)
    if oil.film == "smooth":
        return FilmHistory(thickness, ratio)
    mixed, refusal = mixed_film(
        groups, float(np.hypot(cam, other)), VICKERS * _softer(machine), modulus
    )
    return FilmHistory(thickness, ratio, mixed, refusal)


def _softer(machine: Machine) -> float:
    """Vickers hardness of the softer surface; a mixed film requires both."""
    numbers = [card.hardness_vickers for card in machine.bodies.values()]
    return min(number for number in numbers if number is not None)
