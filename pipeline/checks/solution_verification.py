"""Checks of the solution: validity of plane strain, residuals, meshes, certificate, benchmarks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import radians
from typing import Literal

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.extrema import first_greatest
from camwright.meshes.mesh_quality import (
    LEAST_ANGLE_DEG,
    LEAST_SCALED_JACOBIAN,
    Quality,
)
from camwright.pipeline.base.source import Source
from camwright.pipeline.base.units import shown
from camwright.pipeline.case.limits import (
    BORE_SAFETY,
    COMPLEMENTARITY,
    EQUILIBRIUM,
    MESH_UNCERTAINTY,
    Limit,
)
from camwright.pipeline.checks import value_groups as given
from camwright.pipeline.checks.check import NONE, STATED, Declaration, Demand, check
from camwright.pipeline.checks.contact_strength import plane_pressure, with_its_track
from camwright.pipeline.checks.extremes import (
    Extreme,
    greatest,
    least,
    on_both_tracks,
    tracks_of,
)
from camwright.pipeline.contact.bore_stress import BoreStress
from camwright.pipeline.contact.contact_history import QUANTITIES, CertificatePoint
from camwright.pipeline.contact.elasticity.mesh_convergence import Convergence, converged
from camwright.pipeline.contact.tiers import Tier
from camwright.pipeline.cycle.cycle import Cycle
from camwright.pipeline.cycle.solution import ContactMesh, Solution
from camwright.pipeline.follower.guide_reactions import KNOTS, guide_reactions

VERIFICATION = Source("ASME V&V 10-2019, solution verification", confirmed=True)
CERTIFIED = Source(f"{VERIFICATION}; ASME V&V 20-2009 (GCI)", confirmed=True)
# Limits that no case can change.
HELD_DISTANCE = 10.0  # half-widths, beyond which the supports do not affect the contact
EXCLUDED_SHARE = 0.5  # of the keyway depth
ZONE = 1.5  # element lengths, radius of an excluded zone
SUBSURFACE = 0.3  # half-widths: a shallower maximum is a singularity or an element error
CONTACT_EQUILIBRIUM = 1e-6  # of the load
HERTZ_DIFFERENCE = 0.03  # of p0: 2 to 3 % usual
SPREAD = 0.01  # of p0
SPACINGS_PER_EDGE = 2.0  # a quadratic edge has a middle node
LEAST_SPACINGS = 10.0  # the maximum shear is then within 1.3 %: 0.5 % at 16, of second order
BENCHMARK = 0.03  # of the reference: 2 to 3 % usual
KNOTS_TRIED = (7, 13, 25)  # twice as many each time, the ends counted once
SYNTHESIS_GAIN = 1e-5  # of the engine's ripple; a converged search foresees at most a fifth
NO_CERTIFICATE = "this trial has no certificate"
_INDEX = "max F_s D/(|f1| (r^p - 1)) + g <= c"
_TERMS = (
    "D: |f1 - f2|, p: observed order, from 0.5 to 3, F_s: 1.25, 3 at p < 1; of values that scatter"
    " D: their range, r^p: 2, F_s: 3; g: of two meshes the greatest index of three, else 0, c:"
    " limits.mesh_uncertainty"
)
"""Grid convergence index in a formula, and its symbols."""


def _terms_of(unit: str) -> dict[str, str]:
    """Symbols of the grid convergence index of a quantity in a unit."""
    return {
        **dict.fromkeys(("f1", "D"), f"{STATED} [{unit}]"),
        **dict.fromkeys(("F_s", "r", "p"), STATED),
        "g": f"{STATED} [%]",
    }


@check(
    title="Distance of the contact from fixed boundaries / half-width",
    formula="min(w, t)/max a >= 10; w: least wall from contour to bore or keyway, t: thickness of"
    " the outer ring, or of the roller to its hub, at most w, a: half-width of the contact",
    symbols={**dict.fromkeys("wt", f"{STATED} [mm]"), "a": "half_width_fe [mm]"},
    reason="Nearer supports change the contact itself, and with it every pressure.",
    unit="-",
    sense="at_least",
    source=Source(
        "Saint-Venant: the stress at a fixed boundary is that of the model, not of the part",
        confirmed=True,
    ),
    method="least wall of the cam to bore or keyway, and thickness of the outer ring or of the"
    " roller to its hub, over the greatest half-width",
    evidence=True,
    tier=Tier.CYCLE,
    error="contact",
    rests_on="loads",
    certified_by="half_width",
)
def held_distance(solution: Solution) -> Demand:
    """Distance of the contact from the nearest fixed boundary of a body over the greatest
    half-width.
    """
    machine = solution.machine
    wall = solution.least_radius - machine.cam.held_radius
    depth = machine.follower.held_depth
    stated = {"w": float(wall), "t": float(wall if depth is None else min(wall, depth))}
    wall = stated["t"]
    worst = greatest(solution.cycles, lambda cycle: on_both_tracks(cycle, _half_width))
    loaded = worst.value > 0 or np.isnan(worst.value)
    share = float(wall / worst.value) if loaded else None
    judged = Demand(share, HELD_DISTANCE, worst, stated=stated)
    return with_its_track(judged, solution, _half_width, {"a": _half_width})


def _half_width(cycle: Cycle) -> Array:
    """Half-width of the contact (n,), m."""
    return cycle.contact.half_width


@check(
    title="Radius of the excluded zone at keyway edges",
    formula="1.5 h <= t/2; h: greatest element length at the keyway, t: depth of the keyway",
    symbols={"h": f"{STATED} [mm]", "t": "cam.keyway.depth"},
    reason="A larger zone would hide the stress of the keyway.",
    unit="mm",
    source=Source(
        "singular stress at an edge: at most half of the keyway depth is excluded",
        confirmed=True,
    ),
    method="1.5 element lengths at the keyway; the stress within is stated separately",
    evidence=True,
    tier=Tier.CYCLE,
    load_cases=NONE,
)
def excluded_zone(solution: Solution) -> Demand | None:
    """Greatest radius of the zones at the keyway edges, m, whose stresses are not judged; None
    without a keyway.
    """
    key, bores = solution.machine.cam.keyway, _bores(solution)
    if key is None or not bores:
        return None
    radius = max(bore.excluded for bore in bores)
    limit = EXCLUDED_SHARE * key.depth
    return Demand(radius if radius > 0 else None, limit, stated={"h": radius / ZONE})


@check(
    BORE_SAFETY,
    id="bore_stress",
    title="Von Mises stress at bore and keyway vs. yield strength",
    formula="max sigma <= Y / S; sigma: von Mises stress on bore and keyway outside the excluded"
    " zones, Y: yield strength of the core, S: limits.bore_safety",
    symbols={"sigma": "bore_stress_off_edges [MPa]", "Y": f"{STATED} [MPa]"},
    reason="Does not decide: the shaft is taken as rigid and bonded, which overestimates the"
    " stress beside the keyway and omits the fit.",
    unit="MPa",
    method="finite elements on a rigid shaft, keyway edges excluded, see excluded_zone",
    must_have=False,
    lift_can_help=True,
    tier=Tier.CYCLE,
    within=("bore",),
    error="bore",
    values=(
        *given.CONTACT,
        "cam.material.yield_strength",
        "cam.material.core_yield_strength",
    ),
    page="Cam",
)
def bore_stress(solution: Solution) -> Demand | None:
    """Maximum von Mises stress at bore and keyway outside the excluded zones, Pa."""
    bores = _bores(solution)
    if not bores:
        return None
    card = solution.machine.cam.material
    worst = greatest(solution.cycles, lambda cycle: on_both_tracks(cycle, _away_from_edges))
    at_edges = max(float(np.max(bore.von_mises)) for bore in bores)
    core = card.core_yield
    radius = max(bore.excluded for bore in bores)
    within = f"{shown(at_edges, 'MPa')} within {shown(radius, 'mm', 2)} of the keyway edges"
    judged = Demand(
        worst.value,
        core / solution.machine.limits[BORE_SAFETY],
        worst,
        note=f"{within}, where it diverges with refinement" if radius > 0 else "",
        figures=(f"{card.name}: {card.source}",),
        stated={"Y": core},
    )
    return with_its_track(judged, solution, _away_from_edges, {"sigma": _away_from_edges})


@check(
    title="Depth of maximum von Mises stress / half-width",
    formula="min z/a >= 0.3; z: depth of the maximum von Mises stress, a: half-width",
    symbols={
        "z": "von_mises_depth [mm]",
        "a": "half_width_fe [mm]",
    },
    reason="A maximum at the surface is that of an element, not of the contact.",
    unit="-",
    sense="at_least",
    source=Source(
        "0.70 half-widths under a frictionless line contact, Johnson (1985) sec. 4.2(c)",
        confirmed=True,
    ),
    method="least depth over the turn; a maximum at the surface is a singularity or element error",
    evidence=True,
    tier=Tier.CYCLE,
)
def subsurface_depth(solution: Solution) -> Demand:
    """Least depth of the maximum von Mises stress over the half-width."""

    def shallowness(cycle: Cycle) -> Array:
        """Depth of the maximum over the half-width (n,) with its sign changed; -infinite without
        contact.
        """
        half = cycle.contact.half_width
        loaded = half > 0
        depth = cycle.contact.von_mises_depth / np.where(loaded, half, 1.0)
        return -np.where(loaded, depth, np.where(np.isnan(half), np.nan, np.inf))

    worst = least(solution.cycles, lambda cycle: -on_both_tracks(cycle, shallowness))
    symbols = {"z": lambda one: one.contact.von_mises_depth, "a": _half_width}
    return with_its_track(Demand(worst.value, SUBSURFACE, worst), solution, shallowness, symbols)


def _residual(
    name: str,
    measure: Callable[[Cycle], Array],
    row: Limit | None = None,
    *,
    title: str,
    method: str,
    formula: str,
    needs: Literal["", "stem"] = "",
) -> Declaration:
    """Check of a relative residual. It has no cam angle while it is within its limit: which angle
    has the greatest is then a matter of round-off.

    Without a row of the table its limit is `CONTACT_EQUILIBRIUM`.
    """

    @check(
        row,
        id=name,
        title=title,
        unit="-",
        source=Source(f"equilibrium and contact conditions, {VERIFICATION}", confirmed=True),
        method=method,
        formula=formula,
        symbols={"d": STATED},
        reason="Forces that are not in equilibrium are no solution.",
        evidence=True,
        tier=Tier.CYCLE,
        needs=needs,
    )
    def residual(solution: Solution) -> Demand:
        """Greatest residual over the load cases and cam angles."""
        worst = greatest(solution.cycles, measure)
        limit = CONTACT_EQUILIBRIUM if row is None else solution.machine.limits[row]
        at = Extreme(worst.value) if worst.value <= limit else worst
        pins = row is not EQUILIBRIUM and any(each.pivot is not None for each in solution.cycles)
        note = "of the pin in the bush of the pivot, too" if pins else ""
        return Demand(worst.value, limit, at, note=note, stated={"d": worst.value})

    return residual


def _with_pivot(cycle: Cycle, name: Literal["equilibrium", "complementarity"]) -> Array:
    """Residual (n,) of the contact, of preloaded discs the greater of both, at least that of the
    pin in the bush of a pivot.
    """
    of_pin = 0.0 if cycle.pivot is None else float(getattr(cycle.pivot, name))
    residual = on_both_tracks(cycle, lambda one: np.abs(getattr(one.contact, f"residual_{name}")))
    return np.maximum(residual, of_pin)


guide_equilibrium_force = _residual(
    "guide_equilibrium_force",
    lambda cycle: np.maximum(np.abs(cycle.guides.force_residual), cycle.turn.friction_residual),
    EQUILIBRIUM,
    title="Force equilibrium residual of the guides",
    formula="d <= c; d: greatest |sum F| / sum |F| of the solved angles, F: guide and side forces"
    " across the stem, c: limits.equilibrium; likewise the forces along the stem over the axial"
    " force",
    method="greatest sum of guide and side forces over the sum of their magnitudes, beam on elastic"
    " supports; or of cam, spring, inertia and friction forces over the cam force",
    needs="stem",
)
guide_equilibrium_moment = _residual(
    "guide_equilibrium_moment",
    lambda cycle: np.abs(cycle.guides.moment_residual),
    EQUILIBRIUM,
    title="Moment equilibrium residual of the guides",
    formula="d <= c; d: greatest |sum M| / sum |M| of the solved angles, M: moments on the stem"
    " about the roller, c: limits.equilibrium",
    method="greatest sum of moments over the sum of their magnitudes, beam on elastic supports",
    needs="stem",
)
contact_equilibrium = _residual(
    "contact_equilibrium",
    lambda cycle: _with_pivot(cycle, "equilibrium"),
    title="Force equilibrium residual of the contact",
    formula="d <= 1e-6; d: greatest |integral of p - P| / P of the solved angles, p: contact"
    " pressure, P: line load",
    method="greatest relative difference of the integrated pressure from the load",
)
contact_complementarity = _residual(
    "contact_complementarity",
    lambda cycle: _with_pivot(cycle, "complementarity"),
    COMPLEMENTARITY,
    title="Complementarity residual of the contact",
    formula="d <= c; d: greatest of -p/p0, -g/h and p g/(p0 h) of the solved angles, p: pressure,"
    " g: gap, p0, h: peak pressure and approach, c: limits.complementarity",
    method="greatest relative tension, penetration or gap under pressure",
)

RESIDUALS = tuple(
    each.id
    for each in (
        guide_equilibrium_force,
        guide_equilibrium_moment,
        contact_equilibrium,
        contact_complementarity,
    )
)
"""Checks whose demand is a rounding error."""


@check(
    title="Peak pressure, finite elements vs. Hertz",
    formula="max |p_FE/p_H - 1| <= 0.03; p_FE, p_H: peak pressure by finite elements and by Hertz",
    symbols={
        "p_FE": "p0_fe [MPa]",
        "p_H": "p0_hertz [MPa]",
    },
    reason="Does not decide: the bending of real bodies is a true difference; benchmarks and"
    " certificate decide.",
    unit="%",
    source=Source("Johnson (1985) sec. 4.2(c); 2 to 3 % usual", confirmed=True),
    method="greatest |p0 by finite elements / p0 by Hertz - 1| over the turn",
    must_have=False,
    evidence=True,
    tier=Tier.CYCLE,
)
def hertz_difference(solution: Solution) -> Demand:
    """Greatest relative difference of the contact pressure from Hertz."""

    def difference(cycle: Cycle) -> Array:
        return np.abs(cycle.contact.p0_difference)

    worst = greatest(solution.cycles, lambda cycle: on_both_tracks(cycle, difference))
    symbols = {"p_FE": plane_pressure, "p_H": lambda one: one.contact.p0_hertz}
    return with_its_track(
        Demand(worst.value, HERTZ_DIFFERENCE, worst), solution, difference, symbols
    )


@check(
    title="Convergence of the constrained synthesis",
    formula="d <= 1e-5; d: ripple and costs that another step of the synthesis foresees to gain,"
    " over the ripple of the engine",
    symbols={"d": STATED},
    reason="An unconverged search gives a cam with more ripple than the limits require.",
    unit="-",
    source=VERIFICATION,
    method="gain by the convex program of another step, with second derivatives",
    evidence=True,
    tier=Tier.PREVIEW,
)
def synthesis_converged(solution: Solution) -> Demand | None:
    """Decrease of the objective that another step foresees, over the engine's ripple."""
    gain = solution.synthesis_gain
    return None if gain is None else Demand(gain, SYNTHESIS_GAIN, stated={"d": gain})


def _certified(
    solution: Solution,
    share: Callable[[CertificatePoint], float],
    allowed: float,
    method: Callable[[CertificatePoint], str],
    stated: Callable[[CertificatePoint], dict[str, float]],
) -> Demand:
    """Demand of the certificate: greatest `share`, a relative error, over the certified cam angles;
    `method` and `stated` give words and numbers of that angle.
    """
    points = solution.certificate
    if not points:
        return Demand(None, allowed, note=NO_CERTIFICATE)
    values = np.array([share(point) for point in points])
    k = first_greatest(values)
    worst = points[k]
    at = Extreme(values[k], "", worst.theta)
    return Demand(float(values[k]), allowed, at, method=method(worst), stated=stated(worst))


@check(
    title="Greatest deviation of the cycle from the certificate",
    formula="max |f_c/f - 1| <= 0.01 over p0, half-width, von Mises and maximum shear stress;"
    " f_c: of the cycle, f: of both bodies by finite elements, extrapolated to zero"
    " element size, in SI",
    symbols=dict.fromkeys(("f_c", "f"), STATED),
    reason="The pressures of the cycle rest on a two-scale model.",
    unit="%",
    source=CERTIFIED,
    method="greatest of p0, half-width, von Mises and maximum shear stress: cycle against the"
    " finite-element solution of both bodies at certified angles",
    evidence=True,
    tier=Tier.CERTIFIED,
)
def certificate_spread(solution: Solution) -> Demand:
    """Greatest relative difference of the contact between cycle and certificate."""

    def method(point: CertificatePoint) -> str:
        return (
            f"{QUANTITIES[point.spread_of]}, the greatest of the certified quantities: cycle"
            " against the finite-element solution of both bodies"
        )

    def stated(point: CertificatePoint) -> dict[str, float]:
        figure, of_cycle = point.figures[point.spread_of]
        return {"f_c": of_cycle, "f": figure.extrapolated}

    return _certified(solution, lambda point: point.spread, SPREAD, method, stated)


@check(
    MESH_UNCERTAINTY,
    id="certificate_gci",
    title="Greatest grid convergence index of the certificate",
    formula=f"{_INDEX}; f1, f2: fine and middle mesh, in SI, r: their ratio of size, {_TERMS}",
    symbols=_terms_of(""),
    reason="A solution that depends on its mesh proves nothing.",
    unit="%",
    method="greatest of p0, half-width, von Mises and maximum shear stress: at the two worst angles"
    " on three meshes, observed order, safety factor 1.25, at an order below 1 factor 3; at the"
    " others on two, order of the worst, factor 3",
    evidence=True,
    tier=Tier.CERTIFIED,
)
def certificate_gci(solution: Solution) -> Demand:
    """Greatest relative grid convergence index of the certificate."""
    allowed = solution.machine.limits[MESH_UNCERTAINTY]

    def method(point: CertificatePoint) -> str:
        figure = point.figures[point.gci_of][0]
        return (
            f"{QUANTITIES[point.gci_of]}, the greatest of the certified quantities, on"
            f" {len(figure.values)} meshes; {_order(figure)}"
        )

    def stated(point: CertificatePoint) -> dict[str, float]:
        return _stated_terms(point.figures[point.gci_of][0])

    return _certified(solution, lambda point: point.gci, allowed, method, stated)


def _mesh(
    name: str,
    figure: Callable[[Quality], float],
    allowed: float,
    *,
    symbols: Mapping[str, str],
    stated: Callable[[ContactMesh], dict[str, float]],
    title: str,
    formula: str,
    unit: str = "-",
    method: str = "worst over all elements of cam and follower",
    source: Source = VERIFICATION,
) -> Declaration:
    """Check of a figure of the mesh quality, at least `allowed`.

    Parameters
    ----------
    name : str          id of the check
    figure : callable   quality of the mesh -> figure, SI
    stated : callable   mesh -> numbers of the formula by their symbols, SI
    """

    @check(
        id=name,
        title=title,
        unit=unit,
        sense="at_least",
        source=source,
        method=method,
        formula=formula,
        symbols=symbols,
        reason="Poor elements give stresses of no known error.",
        evidence=True,
        tier=Tier.CYCLE,
    )
    def quality(solution: Solution) -> Demand:
        """Figure of the quality of the mesh of both bodies; not evaluated without a mesh."""
        if solution.mesh is None:
            note = "this trial has no mesh"
            return Demand(None, allowed, note=note, must_have=solution.tier is Tier.CERTIFIED)
        return Demand(figure(solution.mesh.quality), allowed, stated=stated(solution.mesh))

    return quality


mesh_angle = _mesh(
    "mesh_angle",
    lambda mesh: radians(mesh.min_angle_deg),
    radians(LEAST_ANGLE_DEG),
    symbols={"phi": f"{STATED} [deg]"},
    stated=lambda mesh: {"phi": radians(mesh.quality.min_angle_deg)},
    title="Minimum element angle",
    formula="min phi >= 20 deg; phi: corner of a curved triangle",
    unit="deg",
)
mesh_jacobian = _mesh(
    "mesh_jacobian",
    lambda mesh: mesh.min_scaled_jacobian,
    LEAST_SCALED_JACOBIAN,
    symbols={"J": STATED},
    stated=lambda mesh: {"J": mesh.quality.min_scaled_jacobian},
    title="Minimum scaled Jacobian",
    formula="min J >= 0.3; J: Jacobian over the two longer edges at a node, 1 if equilateral",
)
mesh_edges = _mesh(
    "mesh_edges",
    lambda mesh: SPACINGS_PER_EDGE * mesh.edges_across_half_width,
    LEAST_SPACINGS,
    symbols=dict.fromkeys("ah", f"{STATED} [mm]"),
    stated=lambda mesh: {"a": mesh.half_width, "h": mesh.longest_edge},
    title="Node spacings across the contact half-width",
    formula="2 a/h >= 10; a: half-width of the contact, h: longest edge in it",
    method="two spacings a quadratic edge, of the longest edge in the contact of cam and follower",
    source=Source(
        "10 to 20 linear edges across the half-width, usual for line contact",
        confirmed=False,
    ),
)


def _uncertainty(
    name: str, figure: Callable[[CertificatePoint], Convergence], unit: str = "MPa"
) -> Declaration:
    """Check of the discretisation uncertainty of the certified quantity `name`."""
    words = QUANTITIES[name]
    meshes = "three meshes of both bodies at the two worst certified angles, two at the others"

    @check(
        MESH_UNCERTAINTY,
        id=f"mesh_{name}",
        title=f"Discretisation uncertainty of the {words}",
        unit="%",
        method=meshes,
        formula=f"{_INDEX} over the certified angles; f1, f2: {words} of fine and middle mesh,"
        f" r: their ratio of size, 2, {_TERMS}",
        symbols=_terms_of(unit),
        reason="It is the error bar of every demand on this quantity.",
        evidence=True,
        tier=Tier.CERTIFIED,
    )
    def uncertainty(solution: Solution) -> Demand:
        """Greatest grid convergence index of the quantity over the certified angles, relative."""
        points, allowed = solution.certificate, solution.machine.limits[MESH_UNCERTAINTY]
        if not points:
            return Demand(None, allowed, note=NO_CERTIFICATE)
        worst = points[first_greatest([_gci(figure(point)) for point in points])]
        gci = figure(worst).gci
        method = f"{meshes}; {_order(figure(worst))}"
        at, stated = Extreme(gci, "", worst.theta), _stated_terms(figure(worst))
        return Demand(gci, allowed, at, method=method, stated=stated)

    return uncertainty


mesh_p0 = _uncertainty("p0", lambda point: point.p0)
mesh_half_width = _uncertainty("half_width", lambda point: point.half_width, "mm")
mesh_von_mises = _uncertainty("von_mises", lambda point: point.von_mises)
mesh_tau_max = _uncertainty("tau_max", lambda point: point.tau_max)


@check(
    MESH_UNCERTAINTY,
    id="mesh_reaction",
    title="Discretisation uncertainty of the reaction in guide A",
    formula=f"{_INDEX}; f1, f2: greatest reaction by 25 and 13 knots, r: their ratio, 2, {_TERMS}",
    symbols=_terms_of("N"),
    reason="Every demand on a guide has this error.",
    unit="%",
    method=f"beam in guides of {', '.join(map(str, KNOTS_TRIED))} knots",
    evidence=True,
    tier=Tier.CYCLE,
    needs="stem",
)
def mesh_reaction(solution: Solution) -> Demand:
    """Relative discretisation uncertainty of the reaction of guide A at its greatest, from beams of
    several numbers of knots.
    """
    reactions = [np.abs(cycle.guides.reaction_a) for cycle in solution.cycles]
    worst = first_greatest([each.max() for each in reactions])
    cycle, k = solution.cycles[worst], first_greatest(reactions[worst])
    loads, machine = cycle.loads, cycle.machine
    at = loads.tangential_force[[k]], loads.overhang[[k]]
    couple = loads.end_moment[[k]]
    values = [
        float(guide_reactions(*at, machine.stem, machine.guides, couple, knots=n).reaction_a[0])
        for n in KNOTS_TRIED
    ]
    figure = converged(values, 2.0)
    knots = ", ".join(map(str, KNOTS_TRIED))
    return Demand(
        figure.gci,
        machine.limits[MESH_UNCERTAINTY],
        Extreme(figure.gci, cycle.load_case, float(cycle.theta[k])),
        method=f"beam in guides of {knots} knots; {_order(figure)}; the turn has {KNOTS}",
        stated=_stated_terms(figure),
    )


def _benchmark(name: str, *, title: str, source: str) -> Declaration:
    """Check of a known contact against its reference solution, solved by the libraries of this
    run.
    """

    @check(
        id=f"benchmark_{name}",
        title=title,
        unit="%",
        source=Source(f"{source}; 2 to 3 % usual", confirmed=True),
        formula="max(|d_p|, |d_a|) <= 0.03; d_p: p0/p_r - 1, d_a: a/a_r - 1, p0, a: peak pressure"
        " and half-width by finite elements, p_r, a_r: of the reference",
        symbols=dict.fromkeys(("d_p", "d_a"), f"{STATED} [%]"),
        reason="The libraries of this run must solve a known contact.",
        method="greater difference of p0 and half-width from the reference, by the libraries"
        " of this run",
        evidence=True,
        tier=Tier.CERTIFIED,
    )
    def benchmark(solution: Solution) -> Demand:
        """Greatest relative difference of peak pressure and half-width from the reference."""
        differences = solution.benchmarks
        if differences is None:
            note = "no benchmark was solved with this trial"
            return Demand(None, BENCHMARK, note=note)
        values = [differences[f"{name}_p0"], differences[f"{name}_half_width"]]
        stated = dict(zip(("d_p", "d_a"), values, strict=True))
        return Demand(float(np.max(np.abs(values))), BENCHMARK, stated=stated)

    return benchmark


benchmark_nafems = _benchmark(
    "nafems",
    title="Benchmark NAFEMS R0094 case 1, cylinder on block",
    source="NAFEMS R0094 (Konter 2006)",
)
benchmark_hertz = _benchmark(
    "hertz",
    title="Benchmark Hertz, roller of the case on a block",
    source="Johnson (1985) sec. 4.2(c)",
)


def _stated_terms(figure: Convergence) -> dict[str, float]:
    """Numbers of the grid convergence index by their symbols in the formula of the check; empty
    without one.
    """
    if (terms := figure.terms) is None:
        return {}
    stated = {"f1": figure.values[-1] or 1.0, "D": terms.difference, "F_s": terms.safety}
    return stated | {"r": terms.ratio, "p": terms.order, "g": terms.added}


def _gci(figure: Convergence) -> float:
    """Grid convergence index; NaN counts as infinite."""
    return np.inf if np.isnan(figure.gci) else figure.gci


def _order(figure: Convergence) -> str:
    """Order of convergence in words: observed on three meshes, assumed on two, or none in
    scatter.
    """
    assumed = len(figure.values) == 2
    if figure.order is None:
        return f"scatter, no order observed{' at the worst angles' if assumed else ''}"
    factor = ", safety factor 3" if assumed or figure.order < 1.0 else ""
    return f"{'assumed' if assumed else 'observed'} order {figure.order:.2f}{factor}"


def _bores(solution: Solution) -> list[BoreStress]:
    every = [track.rolling.bore for track in tracks_of(solution.cycles)]
    return [bore for bore in every if bore is not None]


def _away_from_edges(cycle: Cycle) -> Array:
    """Greatest von Mises stress at the bore away from the keyway edges at each cam angle (n,), Pa;
    NaN where it is not known.
    """
    bore = cycle.rolling.bore
    return np.full(cycle.theta.size, np.nan) if bore is None else bore.away_from_edges
