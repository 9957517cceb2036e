"""Parts around a cam, sized by roller and torque: stem, guides, fork, shaft, key, gear.

Proportions of drawn machines, rounded to sizes of standards; the checks judge them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, pi

from camwright.pipeline.case.cards.bearing_cards import BearingCard
from camwright.pipeline.case.cards.shaft_seats import Seat

STEMS = (8, 10, 12, 14, 16, 20, 25, 30, 35, 40)  # mm, of wrapped bushes of ISO 3547
MODULES = (1.0, 1.25, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)  # mm, ISO 54, row I
STEEL = 7850.0  # kg/m3
MEAN_BUSH = 1.5  # length over diameter
_CLEARANCES = (0.0101, 30e-6), (0.0181, 35e-6), (0.0301, 40e-6), (0.0501, 50e-6)
"""Diameter of the stem, m, below which a mean clearance of H7/f7 holds, m."""
_KEY_STRESS = 0.45 * 370e6 * 0.6  # Pa: 0.9 R_e of C45, halved by reversals, 60 % used
_SHAFT_STRESS = 40e6  # Pa: bending of C45 at a press fit, with safety 1.5 and scatter
INTERFERENCE = 1.0 / 2500.0, 1.0 / 1400.0
"""Least and greatest interference over the diameter of a shaft that is ground to its bore."""
_SHRINK = 33e6 * 0.12  # Pa: pressure of the least interference times friction, hub of 1.8 bores
_TOOTH = 12e6  # Pa: T / (m^3 z b/m) of case-hardened teeth at half of their strength
_PINION, _TEETH_MOST = 20, 1000
ROLLER_CHAMFER, AXIAL_OFFSET = 6e-4, 3e-4  # m
_OVERHANG = 2e-4  # m, of the roller beyond both ends of the cam at its offset


@dataclass(frozen=True)
class MachineFrame:
    """Parts sized by roller and cam torque; lengths in m.

    Parameters
    ----------
    roller : str        name of its card
    card : BearingCard
    seat : Seat         of the cam on its shaft
    module : float      of the gear
    teeth : tuple       of gear and pinion
    stem_chosen : float   diameter of the stem; None: by the roller
    """

    roller: str
    card: BearingCard
    seat: Seat
    module: float
    teeth: tuple[int, int]
    stem_chosen: float | None = None

    @property
    def radius(self) -> float:
        return 0.5 * self.card.outer_diameter

    @property
    def stem(self) -> float:
        return stem_of(self.card) if self.stem_chosen is None else self.stem_chosen

    @property
    def bush_length(self) -> float:
        return 5e-3 * ceil(MEAN_BUSH * self.stem / 5e-3 - 1e-9)

    @property
    def bush_wall(self) -> float:
        """Wall of a wrapped bush, ISO 3547."""
        return 1e-3 if self.stem < 0.019 else 1.5e-3 if self.stem < 0.029 else 2e-3

    @property
    def bush_clearance(self) -> float:
        """Mean clearance of a stem f7 in a bore H7 of ISO 286, to 5 um."""
        return next(gap for most, gap in _CLEARANCES if self.stem < most)

    @property
    def cheek_width(self) -> float:
        return 1e-3 * max(2, round(300.0 * self.card.bore))

    @property
    def bridge(self) -> float:
        return 1e-3 * max(2, round(1e3 * 0.085 * self.card.outer_diameter))

    @property
    def cheek_length(self) -> float:
        return 1e-3 * ceil(1e3 * self.radius + 2.0)

    @property
    def cheek_height(self) -> float:
        return 1e-3 * ceil(1.3e3 * self.card.bore)

    @property
    def pin_span(self) -> float:
        return self.card.width + self.cheek_width + 5e-4

    @property
    def overhang(self) -> float:
        """From the middle of guide A to the roller's centre at maximum lift."""
        room = self.cheek_length - self.radius + self.bridge + 2e-3
        return 1e-3 * ceil(1e3 * (self.radius + room + 0.5 * self.bush_length))

    def spacing(self, lift: float) -> float:
        """Distance of the guides: guided length 2.3 times the greatest overhang."""
        least = 2.3 * (self.overhang + lift) - self.bush_length
        return 1e-3 * ceil(1e3 * max(least, 2.0 * self.bush_length))

    @property
    def seat_thickness(self) -> float:
        """Moving seat of the spring: a quarter of the stem diameter."""
        return 1e-3 * ceil(250.0 * self.stem)

    def stem_length(self, lift: float) -> float:
        """From the roller's centre through guide B, and the seat of the spring, at zero lift."""
        reach = self.overhang + lift + self.spacing(lift) + 0.5 * self.bush_length
        return 1e-3 * ceil(1e3 * (reach + self.seat_thickness) + 3.0)

    def mass(self, lift: float, spring: float) -> float:
        """Mass that moves with the follower, kg: roller, pin, fork, stem and a third of the spring.

        Parameters
        ----------
        lift : float     maximum lift, m, which sets the length of the stem
        spring : float   mass of the spring, kg
        """
        solid = 0.25 * pi * STEEL
        disc = solid * (self.card.outer_diameter**2 - self.card.bore**2) * self.card.width
        pin = solid * self.card.bore**2 * (self.pin_span + self.cheek_width)
        cheeks = 2.0 * STEEL * self.cheek_width * self.cheek_height * self.cheek_length
        bridge = STEEL * self.bridge * self.cheek_height * (self.pin_span + self.cheek_width)
        stem = solid * self.stem**2 * self.stem_length(lift)
        return disc + pin + cheeks + bridge + stem + spring / 3.0

    @property
    def bearing_spacing(self) -> float:
        return 1e-3 * ceil(1e3 * (2.0 * self.card.width + 1.2 * self.seat.bore))

    @property
    def gear_width(self) -> float:
        return 10.0 * self.module

    @property
    def gear_radius(self) -> float:
        return 0.5 * self.module * self.teeth[0]

    @property
    def gear_position(self) -> float:
        return -1e-3 * ceil(1e3 * (0.5 * self.gear_width + 0.5 * self.seat.bore))

    @property
    def housing_width(self) -> float:
        """Distance from the gear's outer face to that of the further bearing, m."""
        gear = 0.5 * self.gear_width - self.gear_position
        return gear + self.bearing_spacing + 0.5 * self.seat.width

    @property
    def cam_width(self) -> float:
        """Cam width within the roller's flat at its axial offset, m."""
        return cam_width_under(self.card)

    @property
    def key_length(self) -> float:
        return 1e-3 * int(1e3 * self.cam_width - 0.4)

    @property
    def interferences(self) -> tuple[float, float]:
        """Least and greatest interference of the shrunk seat of the cam, m."""
        least, greatest = (share * self.seat.bore for share in INTERFERENCE)
        return least, greatest

    @property
    def least_radius(self) -> float:
        """Least prime radius with a hub of 1.75 times bore and keyway."""
        return self.radius + 1.8 * (0.5 * self.seat.bore + self.seat.hub_depth)

    def rotor_mass(self, cam_radius: float) -> float:
        """Mass of the camshaft, kg: cam and gear as solid discs, and a shaft 1.6 times as long as
        the distance of its bearings.

        Parameters
        ----------
        cam_radius : float   greatest radius of the cam, m
        """
        solid = pi * STEEL
        cam = solid * cam_radius**2 * self.cam_width
        gear = solid * self.gear_radius**2 * self.gear_width
        shaft = 0.25 * solid * self.seat.bore**2 * 1.6 * self.bearing_spacing
        return cam + gear + shaft


def stem_of(card: BearingCard) -> float:
    """Standard stem diameter nearest to 0.42 roller diameters, m."""
    wanted = 1e3 * 0.42 * card.outer_diameter
    return 1e-3 * min(STEMS, key=lambda size: abs(size - wanted))


def cam_width_under(card: BearingCard) -> float:
    """Cam width whose ends lie on a roller's flat at its axial offset, m."""
    return card.width - 2.0 * (ROLLER_CHAMFER + AXIAL_OFFSET) - _OVERHANG


def frame_of(
    name: str, card: BearingCard, torque: float, force: float, ratio: float, sizes: Sequence[Seat]
) -> MachineFrame | None:
    """Parts around a cam, sized for a roller: on the smallest shaft seat whose key, shrink fit,
    bearings and shaft bear the loads, with the smallest standard module whose gear does; None where
    no seat does.

    Parameters
    ----------
    name : str           of the roller card
    card : BearingCard   the roller
    torque : float       greatest of the cam, N m
    force : float        greatest normal force, N
    ratio : float        shaft turns per cam turn
    sizes : sequence     shaft seats by increasing size
    """
    cam_width = cam_width_under(card)
    width = cam_width - 4e-4
    for seat in sizes:
        key = _KEY_STRESS * seat.hub_depth * width * 0.5 * seat.bore
        moment = 0.25 * force * (2.0 * card.width + 1.2 * seat.bore)
        bend = _SHAFT_STRESS * pi * seat.bore**3 / 32.0
        slip = 0.5 * _SHRINK * pi * seat.bore**2 * cam_width
        static = seat.C0 / 1.5
        enough = (key, 0.5 * slip, static, bend), (torque, torque, 0.6 * force, moment)
        if seat.bore >= 0.5 * card.bore and all(a >= b for a, b in zip(*enough, strict=True)):
            break
    else:
        return None
    gear, pinion = _teeth(ratio)
    # T on the gear; the pinion carries the same tooth force
    module = next((m for m in MODULES if _TOOTH * 1e-9 * m**3 * gear * 10 >= torque), MODULES[-1])
    least = next((m for m in MODULES if 0.5e-3 * m * gear > 0.8 * seat.bore), MODULES[-1])
    return MachineFrame(name, card, seat, 1e-3 * max(module, least), (gear, pinion))


def _teeth(ratio: float) -> tuple[int, int]:
    """Numbers of teeth of the gear on the camshaft and of its pinion, for a ratio of shaft turns
    per cam turn; the nearest ratio where no exact one has few enough teeth.
    """
    for pinion in range(_PINION, _TEETH_MOST + 1):
        gear = pinion * ratio
        if abs(gear - round(gear)) < 1e-6 and round(gear) >= _PINION:
            return round(gear), pinion
    return max(_PINION, round(_PINION * ratio)), _PINION
