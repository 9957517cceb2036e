"""The cam on its shaft by finite elements: Lame, rotation, equilibrium, finer meshes, the bound."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from small_machine import small_machine
from test_camshaft_audit import solved, with_case

from camwright.geometry.arrays import uniform_turn
from camwright.geometry.contour import RollerContour
from camwright.geometry.errors import ContactError
from camwright.geometry.lift import Lift
from camwright.geometry.pitch_curve import PitchCurve
from camwright.pipeline.case.cards.card_filling import known_cards
from camwright.pipeline.case.case_file import parse_case
from camwright.pipeline.checks import key_strength
from camwright.pipeline.contact.elasticity.elastic_body import Elastic
from camwright.pipeline.contact.hub_elements import HubLoads, RotatingBody, SeatedCam, Slot
from camwright.pipeline.contact.shrink_fit import SeatFit
from camwright.pipeline.cycle.notch_fatigue import fitted_root, notch_strength

E, NU, DENSITY = 210e9, 0.3, 7850.0
STEEL = RotatingBody(Elastic(E, NU), DENSITY)
SOFT = RotatingBody(Elastic(100e9, 0.25), 7100.0)
DATA = Path(__file__).parents[1] / "data"
BORE, OUTER, KEYED = 15e-3, 32.5e-3, Slot(8e-3, 3.3e-3, np.pi, 0.25e-3)


def material(name):
    """A shipped card."""
    text = small_machine("cards")
    return parse_case(f'{text}\n[materials.extra]\ncard = "{name}"\n', DATA).materials["extra"]


def ring(outer, stroke=0.0):
    """A cam of a roller of 8 mm whose contour lies at `outer`, m, and beyond by a stroke, m."""
    theta = uniform_turn(360)
    lift = Lift(theta, 0.5 * stroke * (1.0 - np.cos(theta)))
    return RollerContour(PitchCurve(lift, outer + 8e-3), 8e-3)


def seated(
    slot=None, outer=OUTER, *, bore=BORE, high=2.6e-3, cam=STEEL, refinement=1.0, stroke=0.0
):
    return SeatedCam(ring(outer, stroke), bore, slot, high, cam, STEEL, refinement)


def loads(interference, force=0.0, couple=0.0, speed=0.0, count=36):
    one = np.ones(count)
    return HubLoads(uniform_turn(count), force * one, couple * one, speed, interference)


def lame(interference, cam=STEEL, share=(BORE / OUTER) ** 2):
    """Pressure of a ring on a solid shaft of steel, from the displacements of both at the seat."""
    of_ring = ((1 + share) / (1 - share) + cam.elastic.poisson) / cam.elastic.modulus
    return interference / BORE / (of_ring + (1 - NU) / E)


@pytest.mark.parametrize("cam", [STEEL, SOFT])
def test_shrunk_ring_by_lame(cam, measured):
    """Mean pressure and hoop stress of a ring without keyway to 0.1 %."""
    pressed = seated(cam=cam).units
    state, exact = pressed.state(loads(10e-6, count=1)), lame(10e-6, cam)
    name, mega = "Shrunk ring, Lame", 1e-6
    pressure = mega * pressed.unloaded(10e-6)
    measured(f"{name}: mean pressure", pressure, mega * exact, rtol=1e-3, unit="MPa")
    share = (BORE / OUTER) ** 2
    hoop, stress = mega * exact * (1 + share) / (1 - share), mega * state.stress.mean()
    measured(f"{name}: hoop stress", stress, hoop, rtol=1e-3, unit="MPa")
    assert not state.opened.any()


def test_rotation_loosens_the_ring():
    """Growth of a turning ring less that of the shaft, Timoshenko; the stress at its bore."""
    speed, a, b = 1500.0, BORE, OUTER
    grown = DENSITY * speed**2 * a / (4 * E) * ((3 + NU) * b**2 + (1 - NU) * a**2)
    grown -= DENSITY * speed**2 * a**3 * (1 - NU) / (4 * E)
    state = seated().units.state(loads(10e-6, speed=speed, count=1))
    assert state.pressure.mean() == pytest.approx(lame(10e-6 - grown), rel=2e-3)


def test_wall_of_a_fit_by_elements():
    """Hoop stress and pressure at the bore in the von Mises stress, as the closed form, 0.2 %."""
    case = solved().case
    fit = SeatFit(least_interference=20e-6, greatest_interference=30e-6, source="made up")
    cam = replace(case.cam, fit=fit)
    outer = cam.prime_radius - case.roller.radius
    units = seated(outer=outer, bore=cam.bore_radius).units
    pressure, along = units.unloaded(15e-6), units.state(loads(15e-6, count=1)).stress.mean()
    of_elements = np.sqrt(along**2 + along * pressure + pressure**2)
    judged = key_strength.fit_yield(with_case(case.model_copy(update={"cam": cam})))
    assert judged.demand == pytest.approx(of_elements, rel=2e-3)


@pytest.mark.parametrize("interference", [-10e-6, 0.0, 5e-6, 20e-6])
def test_seat_is_in_equilibrium_and_does_not_pull(interference):
    """The pressure carries contact and key force, 1 %; no node pulls; a wide fit stays closed."""
    body = seated(KEYED, stroke=6e-3)
    units, force, couple = body.units, 1.7e5, 1500.0
    state = units.state(loads(interference, force, couple))
    assert state.pressure.min() >= 0.0
    assert state.opened.all() if interference <= 0 else True
    assert not state.opened.any() if interference > 15e-6 else True
    normal = body.contour.normal(uniform_turn(36))
    arm = BORE + 0.5 * 2.6e-3
    # at pi the key pushes ahead along -y
    applied = -force * normal + np.array([[0.0], [-couple / arm]])
    share = units._arrays["share"]
    carried = np.einsum("nk,ck,k->cn", state.pressure, units.normals, share)
    assert carried == pytest.approx(-applied, abs=0.01 * force)


def test_a_wide_fit_is_superposed_exactly():
    """A seat that stays closed: increments by the loads do not depend on the interference."""
    units = seated(KEYED).units
    steps = [
        units.state(loads(fit, 1e5, 800.0)).stress - units.state(loads(fit)).stress
        for fit in (20e-6, 40e-6)
    ]
    assert steps[0] == pytest.approx(steps[1], rel=1e-9, abs=1.0)


def test_the_search_finds_the_least_energy():
    """Of a seat that opens: as non-negative least squares, of another first set of nodes."""
    units = seated(KEYED).units
    count = units.normals.shape[1]
    right = np.append(np.full(count, 1e-7), [1.2e5, 5e4])
    found, closed = units._touching(right, np.ones(count, dtype=bool))
    other, same = units._touching(right, units._nodes_of_least_energy(right))
    assert (closed == same).all()
    assert found == pytest.approx(other, rel=1e-9, abs=1e-3)
    assert 3 < closed.sum() < count


def test_a_cam_without_force_on_a_clearance_is_refused():
    with pytest.raises(ContactError, match="contact of the seat"):
        seated(KEYED).units.state(loads(-5e-6))


def test_the_key_balances_the_contact():
    """The couple of the contact on the cam is the cam torque: the key has the opposite one."""
    cycle, contour = solved().cycles[0], solved().contour
    (x, y), (across, along) = contour.points(cycle.theta), contour.normal(cycle.theta)
    couple = -(x * along - y * across) * cycle.loads.normal_force
    assert couple == pytest.approx(
        cycle.loads.cam_torque, abs=0.02 * np.abs(cycle.loads.cam_torque).max()
    )


@pytest.mark.slow
@pytest.mark.parametrize("interference", [0.0, 5e-6, 11.5e-6])
@pytest.mark.parametrize("fillet", [0.16e-3, 0.25e-3, 0.4e-3])
def test_root_within_a_finer_mesh(interference, fillet):
    """Least and greatest stress of the root under fit, key and contact: 5 % of half the size."""
    ranges = []
    for refinement in (1.0, 2.0):
        slot = KEYED._replace(fillet=fillet)
        units = seated(slot, refinement=refinement, stroke=8e-3).units
        theta = uniform_turn(72)
        key = 2400.0 * np.cos(6 * theta)
        stress = units.state(HubLoads(theta, np.full(72, 1.75e5), key, 200.0, interference)).stress
        high, low = stress.max(axis=0), stress.min(axis=0)
        place = int(np.argmax(0.5 * (high - low) / 440e6 + 0.5 * (high + low) / 1000e6))
        ranges.append((high.max(), (high - low)[place]))
    assert ranges[0] == pytest.approx(ranges[1], rel=0.05)


MEMBERS = [
    (8.5e-3, 5e-3, 2.3e-3, 0.16e-3, 1.6e-3),
    pytest.param(6e-3, 4e-3, 1.8e-3, 0.16e-3, 1.25e-3, marks=pytest.mark.slow),
    pytest.param(15e-3, 8e-3, 3.3e-3, 0.16e-3, 2.6e-3, marks=pytest.mark.slow),
    pytest.param(25e-3, 14e-3, 3.8e-3, 0.25e-3, 3.0e-3, marks=pytest.mark.slow),
]


@pytest.mark.parametrize(("bore", "wide", "deep", "least", "high"), MEMBERS)
@pytest.mark.parametrize("ratio", [1.75, pytest.param(4.0, marks=pytest.mark.slow)])
@pytest.mark.parametrize("times", [1.0, pytest.param(3.0, marks=pytest.mark.slow)])
def test_closed_form_bounds_the_elements(bore, wide, deep, least, high, ratio, times):
    """Amplitude and greatest stress of the root are not below those of elements, at any fit.

    The bound of the fit alone is within a third of the elements.
    """
    fillet, outer = least * times, ratio * (bore + deep)
    high = min(high, deep - fillet)
    body = seated(Slot(wide, deep, 0.0, fillet), outer, bore=bore, high=high)
    units, share = body.units, (bore / outer) ** 2
    force, couple, count = 1e5, 400.0 * (bore / 8.5e-3) ** 2, 45
    fit = 1e-3 * bore
    pressure = E * fit / (2 * bore) * (1 - share)
    hoop = pressure * share / (1 - share) * (1 + (outer / (bore + deep)) ** 2)
    bound = fitted_root(hoop, deep, fillet)
    alone = units.state(loads(fit, count=1)).stress.max()
    assert 0.75 * bound.fit < alone < bound.fit
    contact, key = force / (2 * deep), couple / (bore + 0.5 * high) / high
    theta = uniform_turn(count)
    turned = couple * np.cos(3 * theta)
    for part in (0.0, 0.1, 0.3, 1.0):
        state = units.state(HubLoads(theta, np.full(count, force), turned, 0.0, part * fit))
        top, low = state.stress.max(axis=0), state.stress.min(axis=0)
        pull = bound.contact[0] * contact + bound.key[0] * key
        push = bound.contact[1] * contact + bound.key[1] * key
        assert top.max() < part * bound.fit + pull
        assert (0.5 * (top - low)).max() < 0.5 * (pull + push)


def test_the_bound_holds_for_both_methods():
    """Use by amplitude and mean at the weights of the bound: not below Goodman and FKM."""
    for name in known_cards(None)["materials"]:
        card = material(name)
        strength = notch_strength(card, 0.25e-3, 0.99)
        if strength is None:
            continue
        amplitude = np.linspace(1e6, 4e8, 30)[:, None]
        mean = np.linspace(0.0, 8e8, 30)
        used = amplitude * strength.bound[0] + mean * strength.bound[1]
        assert (used >= strength.goodman(amplitude, mean) * (1 - 1e-12)).all()
        assert (used >= strength.fkm(amplitude, mean) * (1 - 1e-12)).all()


def test_fkm_by_hand():
    """Case-hardened, R_m = 740 MPa, r = 0.25 mm: n = 1 + 8^(1/4) 10^-(0.5 + 740/2700).

    K_R = 1 - 0.22 log 16 log 3.7; M = 0.159; R = -1, 0 and 0.5.
    """
    strength = notch_strength(material("case_hardened"), 0.25e-3, 0.99)
    support = 1 + 8**0.25 * 10 ** -(0.5 + 740 / 2700)
    local = 0.296e9 * support * (1 - 0.22 * np.log10(16) * np.log10(3.7))
    assert strength.fkm(local, 0.0) == pytest.approx(1.0)
    assert strength.fkm(local / 1.159, local / 1.159) == pytest.approx(1.0)
    static = local * (3 + 0.159) / (3 * 1.159**2)
    assert strength.fkm(static, 3 * static) == pytest.approx(1.0)
    assert strength.fkm(static, 9 * static) == pytest.approx(1.0)
    assert strength.goodman(0.0, 3.7e8) == pytest.approx(0.5)
