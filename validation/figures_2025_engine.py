"""Figures of Cardoso et al. (2025) up to the cam: engine, pick-up, ten runs of three states."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from camwright.geometry.arrays import Array
from camwright.pipeline.cycle.crank_speed import speed_study
from camwright.pipeline.engine.crankshaft import (
    Inertia,
    SpeedStatistics,
    crank_motion,
    torque_of_motion,
)
from validation import speed_reconstruction
from validation.balancing_cam import (
    FOLLOWER_2025,
    POSITIONS,
    RATIO,
    balanced,
)
from validation.cardoso_2025 import MOUNTED
from validation.modelled_runs import (
    CYCLES,
    RIG_SPEED,
    RUNS,
    TenRuns,
    pitch_errors,
    scattered,
    ten_runs,
)
from validation.paper_engines import (
    EFFECTIVE_INERTIA,
    GX120,
    IDLE_SPEED,
    balanced_torque,
    with_peak_torque,
)
from validation.paper_figure import (
    CRANK,
    MUTED,
    PUBLISHED,
    SPEED,
    TORQUE,
    Beside,
    Look,
    PaperCurve,
    PaperFigure,
    PaperPanel,
    beside,
    closed,
    closed_angle,
)
from validation.published_figures import Basis, Target

CYCLE = closed_angle(POSITIONS, 720.0)
STOCK_POINTS = ((0.0, 153.0), (180.0, 147.0), (355.0, 145.0), (450.0, 155.0), (585.0, 153.0))
"""Crank angle, deg, and speed, rad/s, that the text prints of the stock engine."""
VOLTAGE_PEAK = 3.0  # V, printed
VOLTAGE_WINDOW = (0.032, 0.052)  # s, of the first run, about the end of the compression
MEASURED = "reconstructed"
NO_DATA = (
    "The paper prints no data of its runs: speed reconstructed from the printed statistics, "
    "5 % scatter of the expansion torque (assumed), pick-up voltage with the printed sampling and "
    "the wheel error behind the printed scatter at constant speed, read as a measurement is."
)


def figures(targets: Mapping[str, Target]) -> tuple[PaperFigure, ...]:
    """Figures 1 to 9, 20 to 23, 26 and 27 of the paper."""
    rebuilt = speed_reconstruction.load()
    states = _states(rebuilt.torque_at(POSITIONS), rebuilt.inertia)
    rig = ten_runs([np.full(POSITIONS, RIG_SPEED)] * RUNS)
    return (
        _engine(targets, rebuilt),
        _voltage(rig),
        _rig(targets, rig),
        *(_runs(targets, state, rig) for state in states),
    )


def on_cycle(label: str, values: Array, series: int = 0, look: Look = "line") -> PaperCurve:
    """A curve over the closed cycle of the engine."""
    return PaperCurve(label, CYCLE, closed(values), series, look)


def points(pairs: Sequence[tuple[float, float]], label: str = "printed in the paper") -> PaperCurve:
    """Published points."""
    x, y = np.array(pairs, dtype=float).T
    return PaperCurve(label, x, y, PUBLISHED, "points")


def _engine(
    targets: Mapping[str, Target], rebuilt: speed_reconstruction.Reconstruction
) -> PaperFigure:
    constant, mean = Inertia.constant_only(EFFECTIVE_INERTIA), speed_reconstruction.SPEED_MEAN
    tuned = balanced_torque(GX120, IDLE_SPEED)
    fast = balanced_torque(with_peak_torque(targets["C25-02"].value), IDLE_SPEED)
    slow_motion, fast_motion = (crank_motion(t.total, constant, mean) for t in (tuned, fast))
    torque, speed = rebuilt.torque_at(POSITIONS), rebuilt.speed_at(POSITIONS)
    slow, quick = slow_motion.statistics, fast_motion.statistics
    settled = float(slow_motion.speed[int(450 / 720 * POSITIONS) :].mean())
    peaks = [
        (float(CYCLE[values.argmax()]), float(targets[row].value))
        for values, row in ((torque, "C25-03"), (fast.total, "C25-02"))
    ]
    names = (MEASURED, "model, tuned to the idle", "model, peak of 45 N m")
    return PaperFigure(
        "c25-engine", "C25", "1, 8 and 9", "Torque and speed of the stock engine at 1500 rpm",
        "Cylinder model beside the measured engine. The measured curves are the smoothest ones "
        "with the printed statistics. One model is tuned to the measured idle, the other has the "
        "peak torque of the paper's own simulation, both with the effective inertia of "
        f"{EFFECTIVE_INERTIA:g} kg m\u00b2; the printed 0.0026 kg m\u00b2 contradicts the printed "
        "speeds.",
        (
            PaperPanel(CRANK, TORQUE, (
                *(on_cycle(name, values, k) for k, (name, values) in
                  enumerate(zip(names, (torque, tuned.total, fast.total), strict=True))),
                points(peaks),
            )),
            PaperPanel(CRANK, SPEED, (
                *(on_cycle(name, values, k) for k, (name, values) in enumerate(
                    zip(names, (speed, slow_motion.speed, fast_motion.speed), strict=True))),
                points(STOCK_POINTS),
            )),
        ),
        (
            beside(targets, "C25-01", fast.peak_to_peak),
            beside(targets, "C25-02", fast.peak),
            beside(targets, "C25-04", quick.minimum, ratio_scale=False),
            beside(targets, "C25-05", quick.maximum, ratio_scale=False),
            beside(targets, "C25-03", tuned.peak),
            beside(targets, "C25-11", tuned.std),
            beside(targets, "C25-12", tuned.peak_to_peak),
            *_stock_speeds(targets, slow, "tuned"),
            beside(targets, "C25-31", float(slow_motion.speed[POSITIONS // 4]), ratio_scale=False),
            beside(targets, "C25-32", settled, ratio_scale=False),
        ),
    )  # fmt: skip


def _stock_speeds(
    targets: Mapping[str, Target], ripple: SpeedStatistics, basis: Basis
) -> list[Beside]:
    """Extremes of the speed of the stock engine with their angles, and its std."""
    angle = np.degrees(ripple.maximum_angle)
    return [
        beside(targets, "C25-06", ripple.minimum, ratio_scale=False, basis=basis),
        beside(targets, "C25-07", ripple.maximum, ratio_scale=False, basis=basis),
        Beside("crank angle of the maximum speed, stock", 450.0, float(angle), "deg",
               basis,
               ratio_scale=False),
        beside(targets, "C25-08", ripple.std, basis=basis),
    ]  # fmt: skip


def _voltage(rig: TenRuns) -> PaperFigure:
    panel, peak = _voltage_panel(rig), float(np.abs(rig.voltage).max())
    return PaperFigure(
        "c25-voltage", "C25", "5", "Voltage of the pick-up at constant speed, with its edges",
        "36-tooth wheel on the motor rig at 1500 rpm: sampled every 20 µs and rounded to 8 bit of "
        "16 V, as the printed settings of the oscilloscope give. The voltage falls through zero "
        "over the middle of a tooth and rises through zero between teeth; both edges are read.",
        (panel,),
        (Beside("peak of the voltage", VOLTAGE_PEAK, peak, "V", "imposed"),),
    )  # fmt: skip


def _voltage_panel(runs: TenRuns) -> PaperPanel:
    low, high = VOLTAGE_WINDOW
    inside = (runs.time >= low) & (runs.time <= high)
    edges: list[PaperCurve] = []
    for label, edge in zip(("middle of a tooth", "between teeth"), runs.edges, strict=True):
        times = edge.times[(edge.times >= low) & (edge.times <= high)]
        edges.append(PaperCurve(label, 1e3 * times, np.zeros(times.size), 1 + len(edges), "points"))
    signal = PaperCurve("voltage", 1e3 * runs.time[inside], runs.voltage[inside])
    return PaperPanel("time, ms", "voltage, V", (signal, *edges))


def _rig(targets: Mapping[str, Target], rig: TenRuns) -> PaperFigure:
    mean = rig.tooth_mean
    thin = [
        PaperCurve(
            f"{RUNS * CYCLES} cycles of {RUNS} runs" if k == 0 else "",
            rig.tooth_angle,
            cycle,
            MUTED,
            "thin",
        )
        for k, cycle in enumerate(rig.teeth)
    ]
    reference = PaperCurve(
        "speed of the motor", rig.tooth_angle, np.full(mean.size, RIG_SPEED), PUBLISHED, "dashed"
    )
    return PaperFigure(
        "c25-rig", "C25", "3 and 4", "Noise floor: ten runs at constant speed on the motor rig",
        "Speed from tooth to tooth of ten runs, and their mean. What is left in the mean repeats "
        "every turn: errors of the wheel. Their size is imposed by the printed standard deviation "
        f"({np.degrees(pitch_errors().std()):.3f} deg of each tooth); the amplitude follows.",
        (
            PaperPanel(
                CRANK, SPEED, (*thin, PaperCurve("mean", rig.tooth_angle, mean, 1), reference)
            ),
        ),
        (
            *(
                beside(targets, "C25-28", value, place=k, note=name, basis="imposed")
                for k, (name, value) in enumerate(
                    (("standard deviation", float(mean.std())), ("amplitude", float(np.ptp(mean))))
                )
            ),
        ),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Runs:
    """A group of ten runs: modelled speeds of the runs, and the speed of the cylinder model."""

    name: str
    numbers: str
    title: str
    caption: str
    inertia: float
    speeds: Sequence[Array]
    model: Array
    rows: tuple[str, ...]
    basis: Basis


def _states(torque: Array, inertia: float) -> tuple[_Runs, ...]:
    """The engine alone, with the mechanism disengaged, and with it engaged at 242 N."""
    mean = speed_reconstruction.SPEED_MEAN
    idle = balanced_torque(GX120, IDLE_SPEED).total
    cams = {
        "runs": balanced(torque, inertia, mean, multiplier=1.0, added=MOUNTED * inertia),
        "model": balanced(
            idle, EFFECTIVE_INERTIA, mean, multiplier=1.0, added=MOUNTED * EFFECTIVE_INERTIA
        ),
    }

    def free(added: float) -> Callable[[Array, float], Array]:
        def speed(driving: Array, own: float) -> Array:
            return crank_motion(driving, Inertia.constant_only(own * added), mean).speed

        return speed

    def engaged(driving: Array, own: float) -> Array:
        cam = cams["runs" if own == inertia else "model"]
        study = speed_study(
            driving - driving.mean(), Inertia.constant_only(own), mean, cam.pitch, FOLLOWER_2025,
            gear_ratio=RATIO, mechanism_inertia=MOUNTED * own,
        )  # fmt: skip
        return study.after.speed

    def state(
        name: str, numbers: str, title: str, caption: str, rows: tuple[str, ...],
        speed: Callable[[Array, float], Array], total: float, basis: Basis,
    ) -> _Runs:  # fmt: skip
        runs = [speed(driving - driving.mean(), inertia) for driving in scattered(torque)]
        return _Runs(
            name, numbers, title, caption, total * inertia, runs, speed(idle, EFFECTIVE_INERTIA),
            rows, basis,
        )  # fmt: skip

    heavier = 1.0 + MOUNTED
    return (
        state("stock", "6 to 9", "the stock engine", "", ("C25-03", "C25-11", "C25-12"),
            free(1.0), 1.0, "imposed",
       ),
        state(
            "disengaged", "20 and 21", "mechanism mounted, follower disengaged",
            f"The mechanism adds {100 * MOUNTED:.1f} % of inertia, by the ratio of the printed "
            "standard deviations.",
            ("C25-09", "C25-10"), free(heavier), heavier, "fitted",
        ),
        state(
            "engaged", "22, 23, 26 and 27", "mechanism engaged, preload of 242 N",
            "The cam is that of the printed equations, which deliver half of the engine torque: "
            "with a ratio of 2 the cam torque would have to be twice the crank torque.",
            ("C25-18", "C25-19", "C25-14", "C25-15"), engaged, heavier, "independent",
        ),
    )  # fmt: skip


def _runs(targets: Mapping[str, Target], state: _Runs, rig: TenRuns) -> PaperFigure:
    runs = ten_runs(state.speeds)
    trace = runs.trace
    mean, scatter, ripple = trace.mean, trace.scatter, trace.statistics
    floor = float(rig.tooth_mean.std())
    thin = [
        PaperCurve(
            f"{trace.count} cycles of {RUNS} runs" if k == 0 else "",
            CYCLE[::2],
            closed(cycle)[::2],
            MUTED,
            "thin",
        )
        for k, cycle in enumerate(trace.speeds)
    ]
    low, high = closed(mean - scatter), closed(mean + scatter)
    band = PaperCurve("one standard deviation of the runs", CYCLE, low, 1, "band", high)
    stock = state.name == "stock"
    read = trace.torque(state.inertia)
    bar = trace.error_bar(state.inertia)
    put_in = np.mean([torque_of_motion(speed, state.inertia) for speed in state.speeds], axis=0)
    obtained = {
        "speed std": ripple.std, "speed amplitude": ripple.peak_to_peak, "torque peak": read.peak,
        "torque std": read.std, "torque amplitude": read.peak_to_peak,
    }  # fmt: skip
    values = _stock_speeds(targets, ripple, state.basis) if stock else []
    values += [
        beside(targets, row, obtained[targets[row].quantity], basis=state.basis)
        for row in state.rows
    ]
    return PaperFigure(
        f"c25-runs-{state.name}", "C25", state.numbers, f"Ten runs: {state.title}",
        " ".join(filter(None, (
            "From above: voltage of the first run with its edges; band-limited speed of all runs "
            "and their mean; mean and scatter, the cylinder model over them; torque of the mean "
            "speed beside the one that was put in. The 95 % error bar is that of noise and scatter "
            "of the runs; errors of the wheel repeat and are not in it.",
            state.caption, NO_DATA,
        ))),
        (
            _voltage_panel(runs),
            PaperPanel(CRANK, SPEED, (*thin, on_cycle("mean", mean, 1))),
            PaperPanel(
                CRANK, SPEED,
                (band, on_cycle("mean of the runs", mean, 1),
                 on_cycle("cylinder model", state.model, 2, "dashed"),
                 *((points(STOCK_POINTS),) if stock else ())),
                note=f"noise floor {floor:.2f} rad/s, in the torque "
                f"{trace.noise_amplification(state.inertia) * floor:.1f} N m; bandwidth "
                f"{trace.bandwidth:.0f} Hz, {trace.filter.harmonics} harmonics of the cycle",
            ),
            PaperPanel(CRANK, TORQUE, (
                PaperCurve("95 % error bar", CYCLE, closed(read.total - bar), 1, "band",
                      closed(read.total + bar)),
                on_cycle("of the mean speed", read.total, 1),
                on_cycle("put in", put_in, 0, "dashed"),
            )),
        ),
        tuple(values),
    )  # fmt: skip
