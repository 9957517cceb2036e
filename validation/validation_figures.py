"""Curves behind the rows of ``python -m validation values``, with the published values on them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from camwright.geometry.arrays import Array
from camwright.pipeline.engine.crankshaft import CrankMotion
from camwright.pipeline.torque.torque import Torque
from validation.balancing_cam import Balanced
from validation.mechanism_sizes import Workspace
from validation.paper_figure import (
    CRANK,
    PUBLISHED,
    SPEED,
    TORQUE,
    Look,
    PaperCurve,
    PaperFigure,
    PaperPanel,
    closed,
    closed_angle,
)
from validation.published_figures import Target
from validation.slider_crank_drive import Losses
from validation.speed_reconstruction import POINTS, Reconstruction

PRINTED = "printed"
SHOWN = 180
"""Points of a curve."""
Targets = Mapping[str, Target]


def _figure(
    targets: Targets, row: str, numbers: str, caption: str, *panels: PaperPanel, columns: int = 1
) -> PaperFigure:
    """Figure of the group of a row, beside the figures of the paper of these numbers."""
    target = targets[row]
    name = f"{target.paper} {target.group}".lower().replace(" ", "-")
    return PaperFigure(name, target.paper, numbers, target.group, caption, panels, columns=columns)


def _over(
    label: str, values: Array, series: int, look: Look = "line", turn: float = 720.0
) -> PaperCurve:
    """A curve over a closed cycle or turn, thinned."""
    thinned = values[:: max(values.size // SHOWN, 1)]
    return PaperCurve(label, closed_angle(thinned.size, turn), closed(thinned), series, look)


def _points(x: ArrayLike, y: ArrayLike) -> PaperCurve:
    """Published points."""
    return PaperCurve(PRINTED, x, y, PUBLISHED, "points")


def _speeds(targets: Targets, rows: Sequence[str], others: Mapping[float, float]) -> PaperCurve:
    """Published speeds at their crank angles, of rows and of further angles."""
    pairs = [(float(targets[row].tolerance.angle_deg or 0.0), targets[row].value) for row in rows]
    x, y = zip(*sorted([*pairs, *others.items()]), strict=True)
    return _points(x, y)


def _at_peak(target: Target, torque: Array) -> PaperCurve:
    """A published peak, at the angle of the peak of a curve."""
    return _points([720.0 * int(torque.argmax()) / torque.size], [target.value])


def engine_simulation(targets: Targets, torque: Torque, motion: CrankMotion) -> PaperFigure:
    """Torque and speed of the model with the printed peak torque."""
    return _figure(
        targets,
        "C25-01",
        "1",
        "Cylinder model with the printed peak torque and the effective inertia, beside the values "
        "that the paper prints of its own simulation. The swing of the speed is too large: the "
        "paper's torque is not that of an unloaded idle.",
        PaperPanel(CRANK, TORQUE, (_over("model", torque.total, 0),
                              _at_peak(targets["C25-02"], torque.total))),
        PaperPanel(CRANK, SPEED, (_over("model", motion.speed, 0),
                             _speeds(targets, ("C25-04", "C25-05"), {}))),
    )  # fmt: skip


def stock_engine(
    targets: Targets, rebuilt: Reconstruction, torque: Torque, motion: CrankMotion, heavier: Array
) -> PaperFigure:
    """Torque and speed of the stock engine: reconstructed, and of the tuned model.

    Parameters
    ----------
    heavier : array (n,)   speed with the mechanism mounted and disengaged, rad/s
    """
    count = motion.speed.size
    measured = rebuilt.torque_at(count)
    printed = {10.0 * tooth: value for tooth, value in POINTS.items()}
    settled = {585.0: float(targets["C25-32"].value)}
    return _figure(
        targets,
        "C25-03",
        "8 and 9",
        "The reconstruction is the smoothest speed with the printed statistics; its torque has "
        "them by the effective inertia. The cylinder model is tuned to the same idle: it has the "
        "swing, but its speed still rises at 450 deg, where the measured one has its maximum.",
        PaperPanel(CRANK, TORQUE, (
            _over("reconstruction", measured, 0),
            _over("cylinder model", torque.total, 1, "dashed"),
            _at_peak(targets["C25-03"], measured),
        )),
        PaperPanel(CRANK, SPEED, (
            _over("reconstruction", rebuilt.speed_at(count), 0),
            _over("cylinder model", motion.speed, 1, "dashed"),
            _over("with the mechanism mounted", heavier, 2, "dotted"),
            _speeds(targets, ("C25-06", "C25-07"), printed | settled),
        )),
    )  # fmt: skip


def engaged_mechanism(
    targets: Targets,
    torque: Array,
    cams: Mapping[str, Balanced],
    stds: Mapping[str, Mapping[float, float]],
    printed: Mapping[float, float],
) -> PaperFigure:
    """Residual torque at the design preload, and speed std over the preload, by cam.

    Parameters
    ----------
    torque : array (n,)   of the reconstructed engine, N m
    cams : mapping        cam at the design preload by the torque it is cut for
    stds : mapping        std of the speed (rad/s) by preload (N) and torque
    printed : mapping     std of the speed by preload, as measured
    """
    names = {"full": "cut for the full torque", "half": "for half of it"}
    residual = [
        _over(names[name], cam.residual, k, "dashed" if k == 2 else "line")
        for k, (name, cam) in enumerate(cams.items(), start=1)
    ]
    return _figure(
        targets,
        "C25-13",
        "15 and 24",
        "Above: engine torque and what each cam leaves of it at 242 N and constant speed. Below: "
        "ripple of the speed over the preload. The cam for the full torque has the printed order "
        "of the preloads, but a fraction of the measured ripple; the cam for half of it is 5 and "
        "15 % off at 121 and 242 N, but has another order. Neither reproduces the measurement.",
        PaperPanel(CRANK, TORQUE, (_over("engine", torque, 0, "thin"), *residual)),
        PaperPanel("preload, N", "speed std, rad/s", (
            *(PaperCurve(names[name], list(by), list(by.values()), k)
              for k, (name, by) in enumerate(stds.items(), start=1)),
            _points(list(printed), list(printed.values())),
        )),
    )  # fmt: skip


def engine_at_800(targets: Targets, torque: Torque, full: Array) -> PaperFigure:
    """Torques at idle by component, and at full load.

    Parameters
    ----------
    full : array (n,)   torque at full load, N m
    """
    parts = {"gas": "gas", "inertia": "inertia", "valve_train": "valve train"}
    ratio = float(targets["C24-01"].value)
    strokes = full.reshape(4, -1).mean(axis=1)
    others = float(np.abs(np.delete(strokes, 2)).mean())
    steps = np.repeat(strokes, full.size // 4)
    return _figure(
        targets,
        "C24-01",
        "4, 6, 8 and 15",
        "Above: torques at idle, 800 rpm, by component. Below: full load, with the mean of each "
        f"stroke; the point is the printed {ratio:g} times the mean magnitude of the other three.",
        PaperPanel(CRANK, TORQUE, tuple(
            _over(words, torque.components[name], k)
            for k, (name, words) in enumerate(parts.items()))),
        PaperPanel(CRANK, TORQUE, (
            _over("full load", full, 0), _over("mean of the stroke", steps, 1, "dashed"),
            _points([450.0], [ratio * others]),
        )),
    )  # fmt: skip


def cam_without_losses(targets: Targets, torque: Array, left: Array, radius: Array) -> PaperFigure:
    """Torque with and without the cam, and the radius of its pitch curve.

    Parameters
    ----------
    left : array (n,)     torque with the cam about its mean, N m
    radius : array (n,)   of the pitch curve over the crank angle, mm
    """
    return _figure(
        targets,
        "C24-03",
        "16 and 20",
        "Above: engine torque about its mean, and what the cam without losses leaves. Below: "
        "radius of the pitch curve. The printed wish of at most 50 mm is the radius from which it "
        "has to grow.",
        PaperPanel(CRANK, TORQUE, (_over("engine", torque, 0), _over("with the cam", left, 1))),
        PaperPanel(CRANK, "radius, mm", (
            _over("pitch curve", radius, 0), _over("printed maximum", np.full(
                radius.size, float(targets["C24-04"].value)), PUBLISHED, "dashed"),
        )),
    )  # fmt: skip


def yields(
    targets: Targets, indices: Mapping[str, Array], rows: Sequence[Mapping[str, Any]]
) -> PaperFigure:
    """Shape index over the rise of each set, and its mean beside the printed yield.

    Parameters
    ----------
    indices : mapping   eq. 6.18 amid equal parts of the rise, by set
    rows : sequence     means of each set
    """
    sets = np.arange(1, len(indices) + 1)
    columns = (("mean of eq. 6.18", "shape_index_mean"),
               ("mean of sin² of the pressure angle", "sin_squared_mean"))  # fmt: skip
    printed = [float(targets[f"P15-{number:02d}"].value) for number in sets]
    return _figure(
        targets,
        "P15-01",
        "6 to 17",
        "Above: eq. 6.18 over the rise; no mean of it reaches a printed yield. Below: its mean, "
        "the printed yields of the sets B1 to B4, and the mean of the squared sine of the pressure "
        "angle, which is near them.",
        PaperPanel("share of the rise", "eq. 6.18", tuple(
            PaperCurve(name, (np.arange(index.size) + 0.5) / index.size, index, k)
            for k, (name, index) in enumerate(indices.items()))),
        PaperPanel("set", "yield", (
            *(PaperCurve(label, sets, [row[name] for row in rows], k, "points")
              for k, (label, name) in enumerate(columns)),
            _points(sets, printed),
        )),
    )  # fmt: skip


PAIRS = {"shaft": "shaft", "guide": "guide", "pin_a": "pin A", "pin_b": "pin B"}


def energies(targets: Targets, losses: Mapping[str, Losses]) -> PaperFigure:
    """Friction energy of a turn by pair and mechanism, without slip.

    Parameters
    ----------
    losses : mapping   of slider-crank, cam with big and with small roller
    """
    places = np.arange(len(losses))
    ends = np.cumsum([[getattr(one, pair) for one in losses.values()] for pair in PAIRS], axis=0)
    starts = np.vstack([np.zeros(len(losses)), ends[:-1]])
    bars = tuple(
        PaperCurve(label, start, places, k, "bar", end)
        for k, (label, start, end) in enumerate(zip(PAIRS.values(), starts, ends, strict=True))
    )
    printed = [float(targets[f"E24-{number:02d}"].value) for number in (1, 2, 3)]
    return _figure(
        targets,
        "E24-01",
        "8",
        "Friction energy of a turn with the five fitted dimensions, rolling without slip, beside "
        "the printed energies to which they were fitted.",
        PaperPanel("friction energy of a turn, J", "", (*bars, _points(printed, list(places))),
              kind="bars", rows=tuple(losses)),
    )  # fmt: skip


def forces_and_inertia(
    targets: Targets, forces: Mapping[str, Array], rises: Mapping[str, Array]
) -> PaperFigure:
    """Normal force of the rollers, and rise of the reduced inertia, over the turn.

    Parameters
    ----------
    forces : mapping   normal force (n,) over the turn, N, of big and small roller
    rises : mapping    reduced inertia (n,) over the common part less one, %, of three mechanisms
    """
    middle = [90.0, 270.0]
    means = [float(targets[row].value) for row in ("E24-08", "E24-09")]
    at, printed = [90.0, 180.0, 270.0], [float(value) for value in targets["E24-13"].value]
    return _figure(
        targets,
        "E24-08",
        "7 and 14",
        "Above: normal force between roller and cam; the points are the printed means, of the big "
        "roller at 90 and the small one at 270 deg. Below: rise of the reduced inertia over its "
        "common part with assumed masses; the points are the printed means in the order of the "
        "legend.",
        PaperPanel(CRANK, "normal force, N", (
            *(_over(f"{name} roller", force, k, turn=360.0)
              for k, (name, force) in enumerate(forces.items())), _points(middle, means))),
        PaperPanel(CRANK, "rise of inertia, %", (
            *(_over(name, rise, k, turn=360.0) for k, (name, rise) in enumerate(rises.items())),
            _points(at, printed))),
    )  # fmt: skip


def sizes(targets: Targets, space: Workspace) -> PaperFigure:
    """Friction energy above that of the big roller over the crank length."""

    def above(name: str) -> tuple[PaperCurve, ...]:
        return tuple(
            PaperCurve(f"rod of {space.ratios[k]:g} cranks", 1e3 * space.cranks,
                  100.0 * space.above_best(name)[:, k], series)
            for series, k in enumerate((0, 3, 8))
        )  # fmt: skip

    return _figure(
        targets,
        "E24-14",
        "9 and 10",
        "Friction energy of a turn above that of the big roller without offset, which is the best "
        f"in {space.big_is_best} of {space.combinations} combinations. Left: slider-crank; right: "
        "small roller. The differences are largest at small cranks and short rods, as printed.",
        PaperPanel("crank, mm", "above the best, %", above("slider_crank"), title="Slider-crank"),
        PaperPanel("crank, mm", "above the best, %", above("small"), title="Small roller"),
        columns=2,
    )
