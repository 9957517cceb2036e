"""Comparison of mechanisms: slider-crank and eccentric cams of one case."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, ValidationError

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.eccentric import Eccentric
from camwright.geometry.errors import InputError
from camwright.pipeline.base.files import read_toml
from camwright.pipeline.base.quantities import FileName, Force, In, Length, Mass
from camwright.pipeline.case.case_file import CASE_BYTES
from camwright.pipeline.case.error_text import refusal_of
from camwright.pipeline.case.section import Name, Section, Text
from validation.friction_identification import (
    Pendulum,
    from_pendulum,
    from_run_down,
    read_decay,
)
from validation.mechanism_sizes import OFFSET_SHARE, Workspace, workspace
from validation.slider_crank_drive import (
    POSITIONS,
    DryFriction,
    EccentricDrive,
    HoldingSpring,
    Losses,
    Masses,
    PairFriction,
    SliderCrankDrive,
    dry_losses,
    stroke_efficiency,
)

Document = dict[str, Any]

Viscous = Annotated[float, In("N m s/rad", at_least=0, at_most=1e6)]
Inertia = Annotated[float, In("kg m^2", at_least=0, at_most=1e6)]
OptionalMass = Annotated[float, In("kg", at_least=0, at_most=1e6)]
Ratio = Annotated[float, In(at_least=0, at_most=10)]


class Linkage(Section):
    """Crank or eccentricity, rod or pitch radius, offset of the slider, shaft speed."""

    crank: Length
    rod: Length
    offset: Annotated[float, In("mm", above=-10_000, below=10_000)] = 0.0
    speed: Annotated[float, In("rad/s", above=0, at_most=1e5)]


class Frictions(Section):
    """Viscous friction of shaft, pins and guide."""

    shaft: Viscous
    pin_a: Viscous
    pin_b: Viscous
    guide: Annotated[float, In("N s/m", at_least=0, at_most=1e9)]
    source: Text = ""


class Dry(Section):
    """Dry friction coefficients of guide, shaft and pins, with radii."""

    guide: Ratio = 0.0
    shaft: Ratio = 0.0
    pins: Ratio = 0.0
    shaft_radius: Length = 0.01
    pin_radius: Length = 0.005
    source: Text = ""

    def build(self) -> DryFriction:
        """Friction coefficient of the guide, friction radii of shaft and pins, m."""
        pin = self.pins * self.pin_radius
        return DryFriction(self.guide, self.shaft * self.shaft_radius, pin, pin)


class Moving(Section):
    """Masses of both mechanisms; common_inertia: of the shared parts."""

    slider: OptionalMass
    rod: OptionalMass = 0.0
    rod_inertia: Inertia = 0.0
    common_inertia: Inertia = 0.0
    source: Text = ""


class Holding(Section):
    """Spring that keeps the roller on the cam."""

    preload: Force
    rate: Annotated[float, In("N/m", at_least=0, at_most=1e9)]
    source: Text = ""


class ComparedRoller(Section):
    """Roller of an eccentric cam, the disc for it, traction coefficient and slide-roll ratio."""

    name: Name
    radius: Length
    mass: OptionalMass = 0.0
    disc_mass: OptionalMass = 0.0
    disc_inertia: Inertia = 0.0
    traction: Ratio = 0.0
    slide_ratio: Ratio = 0.0
    source: Text = ""


class Decay(Section):
    """Measured decay for the identification of friction: pendulum angle or shaft speed."""

    name: Name
    kind: Literal["pendulum", "run_down"]
    file: FileName
    mass: Mass | None = None
    length: Length | None = None
    inertia: Annotated[float, In("kg m^2", above=0, at_most=1e6)]


class ComparisonCase(Section):
    """Comparison case: slider-crank, eccentric cams, friction, decays."""

    schema_version: Literal[1]
    name: Name
    title: Text = ""
    notes: Text = ""
    mechanism: Linkage
    friction: Frictions
    dry_friction: Dry | None = None
    masses: Moving
    spring: Holding
    rollers: Annotated[
        tuple[ComparedRoller, ...], Field(alias="roller", strict=False, min_length=1, max_length=8)
    ]
    slip_friction: Annotated[tuple[Ratio, ...], Field(strict=False, max_length=8)] = (0.05, 0.2)
    decays: Annotated[tuple[Decay, ...], Field(alias="decay", strict=False, max_length=8)] = ()

    @property
    def linkage(self) -> Eccentric:
        return Eccentric(self.mechanism.crank, self.mechanism.rod, self.mechanism.offset)

    @property
    def pair_friction(self) -> PairFriction:
        return PairFriction(**self.friction.model_dump(exclude={"source"}))

    @property
    def holding(self) -> HoldingSpring:
        return HoldingSpring(self.spring.preload, self.spring.rate)

    def slider_crank(self) -> SliderCrankDrive:
        moving = self.masses
        masses = Masses(
            slider=moving.slider,
            rod=moving.rod,
            rod_inertia=moving.rod_inertia,
            common=moving.common_inertia,
        )
        return SliderCrankDrive(self.linkage, self.pair_friction, masses, self.holding)

    def cam(self, roller: ComparedRoller) -> EccentricDrive:
        """Eccentric cam with a roller, a solid cylinder."""
        masses = Masses(
            slider=self.masses.slider,
            roller=roller.mass,
            roller_inertia=0.5 * roller.mass * roller.radius**2,
            disc=roller.disc_mass,
            disc_inertia=roller.disc_inertia,
            common=self.masses.common_inertia,
        )
        return EccentricDrive(self.linkage, roller.radius, self.pair_friction, masses, self.holding)


def load_comparison(path: Path) -> ComparisonCase:
    """Read and check the case of a comparison.

    Raises
    ------
    InputError
        Naming the first invalid field.
    """
    data = read_toml(path, f"case {path}", CASE_BYTES)
    try:
        return ComparisonCase.model_validate(data)
    except ValidationError as error:
        raise refusal_of(error) from None


def compared(path: Path) -> Document:
    """Document of the comparison: energies, forces, inertia, workspaces."""
    case = load_comparison(path)
    speed, phi = case.mechanism.speed, uniform_turn(POSITIONS)
    rod = case.slider_crank()
    dry = None if case.dry_friction is None else case.dry_friction.build()
    mechanisms: list[Document] = [_mechanism("slider-crank", rod, speed, dry)]
    for roller in case.rollers:
        drive = case.cam(roller)
        reactions = drive.reactions(phi, speed)
        need = np.abs(reactions.traction) / np.maximum(reactions.normal, 1e-300)
        mechanisms.append(
            _mechanism(f"cam, roller {roller.name}", drive, speed, dry)
            | {
                "normal_force_mean_N": float(reactions.normal.mean()),
                "normal_force_min_N": float(reactions.normal.min()),
                "normal_force_max_N": float(reactions.normal.max()),
                "traction_needed_mean": float(need.mean()),
                "traction_needed_max": float(need.max()),
                "sliding_loss_J": drive.sliding_loss(speed, roller.traction, roller.slide_ratio),
                "slipping": {
                    f"{mu:g}": _losses(drive.slipping_losses(speed, mu))
                    for mu in case.slip_friction
                },
            }
        )
    space = workspace(case.pair_friction, speed)
    return {
        "case": case.name,
        "title": case.title,
        "speed_rad_per_s": speed,
        "phi_deg": np.degrees(phi).tolist(),
        "mechanisms": mechanisms,
        "workspace": {
            "combinations": space.combinations,
            "big_roller_best": space.big_is_best,
            "crank_mm": (1e3 * space.cranks).tolist(),
            "rod_over_crank": space.ratios.tolist(),
            "offset_over_crank": OFFSET_SHARE,
            **{f"{name}_above_best_percent": _percent(space, of) for name, of in _RIVALS.items()},
            "energy_big_roller_J": space.big.tolist(),
        },
        "identified": [_identified(decay, path.parent) for decay in case.decays],
    }


def _mechanism(
    name: str, drive: SliderCrankDrive | EccentricDrive, speed: float, dry: DryFriction | None
) -> Document:
    phi = uniform_turn(POSITIONS)
    reactions = drive.reactions(phi, speed)
    return {
        "name": name,
        "losses_J": _losses(drive.losses(speed)),
        "dry_losses_J": None if dry is None else _losses(dry_losses(drive, speed, dry)),
        "efficiency_out_stroke": stroke_efficiency(drive, speed),
        "reduced_inertia_mean_kg_m2": float(drive.reduced_inertia(phi).mean()),
        "pin_reaction_mean_N": float(np.hypot(*reactions.b).mean()),
        "motor_torque_Nm": reactions.motor.tolist(),
        "reduced_inertia_kg_m2": drive.reduced_inertia(phi).tolist(),
    }


def _losses(losses: Losses) -> dict[str, float]:
    names = ("shaft", "guide", "pin_a", "pin_b", "sliding", "total")
    return {name: float(getattr(losses, name)) for name in names}


def _identified(decay: Decay, folder: Path) -> Document:
    name = Path(decay.file)
    if name.is_absolute() or ".." in name.parts:
        raise InputError("decay.file", decay.file, "a relative path in the case file's folder")
    time, signal = read_decay(folder / name)
    if decay.kind == "run_down":
        friction = from_run_down(time, signal, decay.inertia)
    else:
        if decay.mass is None or decay.length is None:
            raise InputError("decay.mass, decay.length", "missing", "specified for a pendulum")
        friction = from_pendulum(time, signal, Pendulum(decay.mass, decay.length, decay.inertia))
    return {
        "name": decay.name,
        "viscous_Nms_per_rad": friction.viscous,
        "viscous_interval": list(friction.viscous_interval),
        "coulomb_Nm": friction.coulomb,
        "coulomb_interval": list(friction.coulomb_interval),
        "confidence": friction.confidence,
        "residual_rms": friction.residual_rms,
    }


def lines(document: Document) -> Iterator[str]:
    """The document as lines of text."""
    yield f"{document['case']} at {document['speed_rad_per_s']:.6g} rad/s, energy of a turn in J"
    heads = ("shaft", "guide", "pin_a", "pin_b", "sliding", "total")
    yield f"{'':34}" + "".join(f"{head:>9}" for head in heads)
    for entry in document["mechanisms"]:
        yield _row(entry["name"], entry["losses_J"])
        if entry["dry_losses_J"] is not None:
            yield _row("  dry friction, additional", entry["dry_losses_J"])
        for friction, losses in entry.get("slipping", {}).items():
            yield _row(f"  slipping at mu {friction}", losses)
    for entry in document["mechanisms"]:
        yield (
            f"{entry['name']}: out-stroke efficiency {entry['efficiency_out_stroke']:.4f}, reduced "
            f"inertia {entry['reduced_inertia_mean_kg_m2']:.5g} kg m2, mean pin reaction "
            f"{entry['pin_reaction_mean_N']:.4g} N"
        )
        if "traction_needed_max" in entry:
            rolls = (
                ""
                if entry["traction_needed_max"] < 0.1
                else ": rolling without slip is implausible"
            )
            yield (
                f"  mean normal force {entry['normal_force_mean_N']:.4g} N; rolling needs a "
                f"traction coefficient {entry['traction_needed_mean']:.3g} on average, "
                f"{entry['traction_needed_max']:.3g} at most{rolls}; "
                f"creep loss {entry['sliding_loss_J']:.3g} J"
            )
    space = document["workspace"]
    yield (
        f"sizes: the big roller without offset is best in {space['big_roller_best']} of "
        f"{space['combinations']} combinations; the slider-crank lies "
        f"{_range_of(space, 'slider_crank')} % above it, the small roller "
        f"{_range_of(space, 'small_roller')} %"
    )
    yield (
        f"with an offset of {space['offset_over_crank']:g} cranks, where the sizes allow it, above "
        f"it: slider-crank {_range_of(space, 'slider_crank_offset')} %, "
        f"big roller {_range_of(space, 'big_roller_offset')} %, "
        f"small {_range_of(space, 'small_roller_offset')} %"
    )
    for entry in document["identified"]:
        low, high = entry["viscous_interval"]
        dry_low, dry_high = entry["coulomb_interval"]
        yield (
            f"{entry['name']}: viscous {entry['viscous_Nms_per_rad']:.4g} N m s/rad "
            f"({low:.4g} to {high:.4g}), dry {entry['coulomb_Nm']:.3g} N m ({dry_low:.3g} to "
            f"{dry_high:.3g}), {100 * entry['confidence']:.0f} % confidence"
        )


def _row(name: str, losses: Mapping[str, float]) -> str:
    return f"{name:34}" + "".join(f"{value:9.2f}" for value in losses.values())


_RIVALS = {
    "slider_crank": "slider_crank",
    "slider_crank_offset": "slider_crank_offset",
    "small_roller": "small",
    "big_roller_offset": "big_offset",
    "small_roller_offset": "small_offset",
}


def _percent(space: Workspace, name: str) -> list[list[float | None]]:
    """Energy over that of the big roller, less one, in percent; None for invalid sizes."""
    rows = 100.0 * space.above_best(name)
    return [[float(v) if np.isfinite(v) else None for v in row] for row in rows]


def _range_of(space: Document, name: str) -> str:
    values = np.array(space[f"{name}_above_best_percent"], dtype=float)
    return f"{np.nanmin(values):.1f} to {np.nanmax(values):.1f}"
