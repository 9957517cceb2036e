"""Figures of docs/steps.md: one shipped case through the whole calculation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from html import escape

import numpy as np
from site_pictures import TurningCam, chart, closed_line, over_cam, path_of

from camwright.geometry.arrays import Array, uniform_turn
from camwright.geometry.figures import SERIES, Curve, LimitLine, Panel, over
from camwright.pipeline.base.verdict import within_depth
from camwright.pipeline.contact.elasticity.plane_stress_measures import shear_in_plane, von_mises
from camwright.pipeline.contact.hertz import subsurface_stress
from camwright.pipeline.results.check_records import CheckList
from camwright.pipeline.results.trial import Trial

CASE = "cases/gx120-redesign.toml"
_BARS = 12
_POISSON = 0.3
Picture = tuple[str, str]
"""A picture as SVG, and its caption."""


class Figures:
    """Figures of a trial by name."""

    def __init__(self, trial: Trial) -> None:
        self.trial = trial
        self.cycle = trial.cycles[0]
        self.columns = self.cycle.table

    @property
    def drawn(self) -> Mapping[str, Callable[[], Picture]]:
        """Functions that draw the figures, by name."""
        return {
            "torque": self.torque,
            "energy": self.energy,
            "lift": self.lift,
            "contour": self.contour,
            "pressure_angle": self.pressure_angle,
            "force": self.force,
            "pressure": self.pressure,
            "stress": self.stress,
            "utilisation": self.utilisation,
        }

    def html(self, name: str) -> str:
        """A figure with its caption."""
        picture, caption = self.drawn[name]()
        return f'<figure class="drawn">{picture}<figcaption>{escape(caption)}</figcaption></figure>'

    def _over_turn(self, title: str, words: str, *curves: tuple[str, Array]) -> str:
        quantity, _, unit = words.rpartition(", ")
        name = title.lower().replace(" ", "-")
        return chart(over_cam(name, title, quantity, unit, curves))

    def torque(self) -> Picture:
        """Torque about its mean, without and with the cam."""
        turn = self.cycle.turn
        curves = [("without the cam", turn.torque_before), ("with the cam", turn.torque_after)]
        known = [(name, values) for name, values in curves if values is not None]
        before, after = (values.std() for _, values in known)
        return (
            self._over_turn("Crank torque about its mean", "torque about its mean, N m", *known),
            f"Crank torque at {self.cycle.load_case}: its standard deviation is {before:.1f} N m "
            f"without the cam and {after:.1f} N m with it.",
        )

    def energy(self) -> Picture:
        """Energy in the spring."""
        spring, lift = self.cycle.machine.spring, 1e-3 * self.columns["lift_mm"]
        stored = spring.preload * lift + 0.5 * spring.rate * lift**2
        return (
            self._over_turn("Energy in the spring", "energy, J", ("", stored)),
            f"Energy that the spring stores beyond its preload: up to {stored.max():.1f} J.",
        )

    def lift(self) -> Picture:
        """Lift of the follower."""
        lift = self.columns["lift_mm"]
        return (
            self._over_turn("Lift", "lift, mm", ("", lift)),
            f"Lift of the follower, up to {lift.max():.2f} mm.",
        )

    def contour(self) -> Picture:
        """Contour, pitch curve and roller."""
        contour, theta = self.trial.contour, uniform_turn(720)
        cam = TurningCam.of(contour, self.trial.case.cam.bore_radius or 0.0)
        pitch = 1e3 * contour.points(theta) + cam.roller * contour.normal(theta)
        radius = np.hypot(*pitch)
        reach = 1.03 * float(radius.max() + cam.roller)
        rollers = "".join(
            f'<circle class="roller" cx="{x:.4g}" cy="{-y:.4g}" r="{cam.roller:.4g}"/>'
            for x, y in pitch[:, ::120].T
        )
        picture = (
            f'<svg class="turning-cam still" viewBox="{-reach:.4g} {-reach:.4g} {2 * reach:.4g} '
            f'{2 * reach:.4g}" role="img" aria-label="Contour, pitch curve, prime circle and '
            f'rollers in the frame of the cam">{rollers}<path class="cam-body" d="{path_of(cam)}"/>'
            f'<path class="axis" d="{closed_line(pitch)}"/>'
            f'<circle class="circle" r="{radius.min():.4g}"/><circle class="hub" r="1.2"/></svg>'
        )
        return picture, (
            "The cam, the pitch curve of the roller centre (dash-dotted) about the prime circle "
            "(dashed), and the roller at six angles."
        )

    def pressure_angle(self) -> Picture:
        """Pressure angle with its limit."""
        values = self.columns["pressure_angle_deg"]
        most = float(np.degrees(self.trial.case.limits.pressure_angle))
        limits = LimitLine(most, "limit"), LimitLine(-most, "limit")
        figure = over_cam(
            "pressure-angle", "Pressure angle", "pressure angle", "deg", [("", values)], limits
        )
        return (
            chart(figure),
            f"Pressure angle; this case allows {most:g} degrees, since its stem slides fast.",
        )

    def force(self) -> Picture:
        """Contact force in up to three load cases."""
        cycles = sorted(self.trial.cycles, key=lambda each: each.machine.speed)[-3:]
        curves = [(each.load_case, each.table["normal_force_N"]) for each in cycles]
        return (
            self._over_turn("Contact force in each load case", "contact force, N", *curves),
            "Contact force: the faster the cam turns, the more the mass of the follower adds and "
            "takes away.",
        )

    def pressure(self) -> Picture:
        """Greatest contact pressure."""
        p0 = self.columns["p0_hertz_MPa"]
        return (
            self._over_turn("Greatest contact pressure", "contact pressure, MPa", ("", p0)),
            f"Greatest pressure of the contact at each cam angle, up to {np.nanmax(p0):.0f} MPa.",
        )

    def stress(self) -> Picture:
        """Stress on the axis below a line contact; Johnson, Contact Mechanics (1985), sec. 4.2."""
        z = np.linspace(0.0, 3.0, 301)  # half-widths
        field = subsurface_stress(0.0, z)
        shear, mises = shear_in_plane(field), von_mises(field, _POISSON)
        curves = Curve(z, mises, "von Mises"), Curve(z, shear, "greatest shear", SERIES[1])
        panel = Panel("stress over p0", "", curves)
        return (
            chart(over("stress", "Stress", "", "depth over half-width", "", [panel], dots=False)),
            f"Below the middle of the strip the von Mises stress is greatest "
            f"{z[np.argmax(mises)]:.2f} half-widths deep, {mises.max():.2f} of the pressure, and "
            f"the shear stress {z[np.argmax(shear)]:.2f} half-widths deep, {shear.max():.2f} of it "
            f"(plane strain, Poisson ratio {_POISSON}).",
        )

    def utilisation(self) -> Picture:
        """Required checks of the greatest utilisation as bars."""
        required = [
            each for each in within_depth(self.trial.checks) if each.must_have and not each.evidence
        ]
        figure = CheckList(required).figure(_BARS)
        return chart(figure), (
            f"The {_BARS} required checks of the greatest utilisation in the preview at "
            "nominal sizes; the dashed line is the limit, 1."
        )
