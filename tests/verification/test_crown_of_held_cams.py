"""Crown of roller, face or disc of cams that pull, on both tracks: elliptic contact, elements."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import camwright as cw
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.case.limits import END_MEAN_LENGTH
from camwright.pipeline.contact.finite_length.length_tiers import both_tiers
from camwright.pipeline.cycle.length_history import signed_factor
from camwright.pipeline.preview import preview_case
from camwright.pipeline.search.crown.solved_lines import SolvedLines, signed_range

MOTIONS = Path(__file__).parents[2] / "cases" / "motions"
RADIUS = 0.5
CROWN = 'crown = {{ kind = "circular", radius = "{}", source = "chosen" }}'


def elliptic_pressure(force, across, along, modulus):
    """p0 of the elliptic contact of Hertz, Pa: Johnson, Contact Mechanics (1985), eqs 4.26, 4.27.

    force, N; across, along: relative radii, m, of the short and of the long way; modulus E*, Pa
    """

    def curved(ratio):
        square = 1.0 - ratio**2
        K, E = ellipk(square), ellipe(square)
        return (E / ratio**2 - K) / (K - E) - along / across

    b_over_a = brentq(curved, 1e-4, 1.0 - 1e-9)
    E, curvature = ellipe(1.0 - b_over_a**2), 0.5 / across + 0.5 / along
    a = np.cbrt(1.5 * force * E / (np.pi * modulus * b_over_a**2 * curvature))
    return 1.5 * force / (np.pi * a**2 * b_over_a)


def crowned(name, on):
    """A shipped case with a crown of 500 mm on one body."""
    text = (MOTIONS / f"{name}.toml").read_text(encoding="utf-8")
    at = text.index("roughness", text.index(f"\n[{on}]\n"))
    return parse_case(text[:at] + CROWN.format("500 mm") + "\n" + text[at:])


@pytest.mark.parametrize(
    ("name", "on"),
    [
        ("feeder-groove", "roller"),
        pytest.param("placer-preloaded", "cam", marks=pytest.mark.slow),
        pytest.param("pump-yoke", "follower.face", marks=pytest.mark.slow),
    ],
)
def test_a_crowned_line_is_an_elliptic_contact_on_either_track(name, on):
    """Where each track bears most, untilted: in the concave outer wall of a groove, on both discs
    that press at once, under both faces. 0.5 %, of the table of a crowned line.
    """
    cycle = preview_case(crowned(name, on), corners=False).cycles[0]
    modulus, tracks = cycle.machine.contact_modulus, [cycle, cycle.on_other_track]
    for side in (1.0, -1.0):
        for each in (one for one in tracks if one is not None):
            force = np.where(cycle.loads.wall == side, each.loads.normal_force, 0.0)
            k = int(force.argmax())
            radius = float(each.contact.relative_radius[k])
            pressure = each.length.level[k] * each.contact.p0[k]
            hertz = elliptic_pressure(force[k], radius, RADIUS, modulus)
            assert pressure == pytest.approx(hertz, rel=5e-3), (side, radius)
    if name == "feeder-groove":
        roller, radii = cycle.machine.follower.contact_radius, cycle.contact.relative_radius
        assert (radii[cycle.loads.wall < 0.0] > roller).any()


@pytest.mark.slow
def test_the_crown_of_both_faces_of_a_yoke():
    """Half of the least design load exceeds the ratio, the crown keeps it."""
    design = cw.crown(cw.read_case(MOTIONS / "pump-yoke.toml"), 1.15, kind="circular")
    chosen = design.chosen
    assert chosen.ratio <= 1.15 < chosen.straight.max()
    lighter = chosen.family.crown(0.5 * chosen.lightest)
    assert chosen.problem.ratios(lighter).max() > 1.15


@pytest.mark.slow
def test_the_crown_of_a_roller_in_a_groove_by_finite_elements():
    """`design crown` over both walls: where the pressure of each is greatest over plane strain,
    finite elements of both bodies agree within the 2 % that the half-spaces state.
    """
    case = cw.read_case(MOTIONS / "feeder-groove.toml")
    design = cw.crown(case, 1.4, kind="circular")
    chosen, states = design.chosen, design.chosen.problem.states
    assert chosen.ratio <= 1.4 < chosen.straight.max()
    outer = 1.0 / states.curvature > design.machine.follower.contact_radius
    assert outer.any() and not outer.all()
    for wall in (outer, ~outer):
        row = int(np.where(wall, chosen.ratios, 0.0).argmax())
        loads = states.loads(np.array([row]), chosen.problem.compliance)
        mean, force = design.machine.limits[END_MEAN_LENGTH], states.force[[row]]
        tried = []
        for pair in chosen.problem.pairs(chosen.crown):
            here = replace(pair, curvature=float(states.curvature[row]))
            lines = SolvedLines(here, mean)
            most = signed_range(lines, loads).moment
            for moment in (0.0 * most, most, -most):
                factor = signed_factor(lines, states.curvature[[row]], force, moment).value
                tried.append((float(factor[0]), float(moment[0]), here))
        factor, moment, here = max(tried, key=lambda each: each[0])
        assert factor * states.share[row] == pytest.approx(chosen.ratios[row], rel=1e-6)
        _, blocks = both_tiers(here, float(force[0]), moment=moment)
        assert float(blocks.factors.greatest[0]) == pytest.approx(factor, rel=0.02)
