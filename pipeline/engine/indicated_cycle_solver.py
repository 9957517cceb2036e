"""Single-zone working cycle of one cylinder, integrated to periodicity."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, degrees, radians, sqrt

import numpy as np

from camwright.geometry.arrays import Array
from camwright.geometry.errors import CamError, InputError
from camwright.pipeline.engine.combustion import burnt_fraction
from camwright.pipeline.engine.cylinder import CylinderEngine
from camwright.pipeline.engine.heat_loss import Charge, FilmCoefficient, film_coefficient, wall_area
from camwright.pipeline.engine.indicated_cycle import CycleBalance, CylinderCycle
from camwright.pipeline.engine.valves import NEARLY_EQUAL, exhaust_valve, intake_valve, nozzle_flow
from camwright.pipeline.engine.working_gas import AIR_AND_FUEL, Gas

STEPS_PER_CYCLE = 720
REPEATS_WITHIN = 1e-6
CYCLES_MAX = 200
SUB_STEPS_MIN = 2
_SUB_STEPS_MAX = 1000  # five times those of a small engine at 50 rpm
SPEED_RANGE = (10.0, 2000.0)  # rad/s


@dataclass(frozen=True)
class _Steps:
    """Steps of one cycle; lists of floats, which a scalar loop reads fastest.

    Node 2 i is the start of step i, node 2 i + 1 its middle.
    """

    start: int  # whole degree at which the cycle is cut: the first with the intake valve shut
    per_degree: list[int]
    length: list[float]  # rad
    burnt: list[float]  # fraction of the fuel burnt per rad, mean over the step
    theta: Array
    volume: Array
    volume_rate: list[float]
    wall: list[float]
    intake: list[float]
    exhaust: list[float]


def _steps(engine: CylinderEngine, crank_speed: float) -> _Steps:
    """Integration steps of the cycle, with burning rate, volume, wall and valve areas at their
    nodes.

    Finer where open valves level the pressure fast.

    Raises
    ------
    InputError
        If the valves level it too fast for `_SUB_STEPS_MAX` within a degree of the crank.
    """
    intake, exhaust = intake_valve(engine), exhaust_valve(engine)
    start = ceil(degrees(engine.intake_window[1]) - 1e-9)
    whole = np.radians(start + np.arange(STEPS_PER_CYCLE + 1.0))
    # With open valves the step must be below the time of pressure equalisation, which is shortest
    # near equal pressures, where the nozzle law is steepest.
    gas_speed = 1.3 * sqrt(AIR_AND_FUEL.constant * 900.0) * sqrt(2.0 / NEARLY_EQUAL)
    area = intake.flow_area(whole) + exhaust.flow_area(whole)
    levelling = gas_speed / crank_speed * area / engine.volume(whole)
    steepest = np.maximum(levelling[:-1], levelling[1:]) * radians(1.0)
    if not steepest.max() <= _SUB_STEPS_MAX:
        radius = f"{1e3 * engine.crank_radius:.4g} mm"
        limit = (
            f"longer for these valves, whose flow levels the pressure {steepest.max():.3g} times"
        )
        raise InputError("engine.crank_radius", radius, f"{limit} in a degree of the crank")
    per_degree = np.maximum(SUB_STEPS_MIN, np.ceil(steepest / 1.5)).astype(int)
    length = np.repeat(radians(1.0) / per_degree, per_degree)
    ends = radians(start) + np.concatenate([[0.0], np.cumsum(length)])
    theta = np.empty(2 * length.size + 1)
    theta[::2], theta[1::2] = ends, 0.5 * (ends[:-1] + ends[1:])
    return _Steps(
        start=start,
        per_degree=per_degree.tolist(),
        length=length.tolist(),
        burnt=(np.maximum(np.diff(burnt_fraction(engine, ends)), 0.0) / length).tolist(),
        theta=theta,
        volume=engine.volume(theta),
        volume_rate=engine.volume_rate(theta).tolist(),
        wall=wall_area(engine, theta).tolist(),
        intake=intake.flow_area(theta).tolist(),
        exhaust=exhaust.flow_area(theta).tolist(),
    )


@dataclass
class _Port:
    """Gas pushed back into the intake, drawn in again before fresh charge: kg, J, kg."""

    fresh_enthalpy: float  # J/kg
    mass: float = 0.0
    enthalpy: float = 0.0
    burnt: float = 0.0

    @property
    def offered(self) -> float:
        """Specific enthalpy of the gas that flows in next, J/kg."""
        return self.enthalpy / self.mass if self.mass > 0.0 else self.fresh_enthalpy

    def give(self, drawn: float) -> tuple[float, float]:
        """Take a mass `drawn`, kg, out of the intake into the cylinder: gas pushed back before
        first, then fresh charge.

        Returns
        -------
        burnt : float      burnt gas in it, kg
        enthalpy : float   its enthalpy less that of the same mass as offered, J: not zero if the
                           gas pushed back runs out and fresh charge follows
        """
        if self.mass == 0.0:
            return 0.0, 0.0
        beyond = max(drawn - self.mass, 0.0) * (self.fresh_enthalpy - self.offered)
        share = min(drawn / self.mass, 1.0)
        burnt = share * self.burnt
        self.mass -= share * self.mass
        self.enthalpy -= share * self.enthalpy
        self.burnt -= burnt
        return burnt, beyond

    def take(self, pushed: float, enthalpy: float, burnt: float) -> None:
        """Let a mass flow out of the cylinder, with its specific enthalpy and burnt fraction."""
        self.mass += pushed
        self.enthalpy += pushed * enthalpy
        self.burnt += pushed * burnt


@dataclass
class _Content:
    """The gas in the cylinder: kg, J, kg."""

    mass: float
    energy: float
    burnt: float

    def state(self, gas: Gas, volume: float) -> tuple[float, float]:
        """Pressure (Pa) and temperature (K)."""
        temperature = gas.temperature(self.energy / self.mass)
        return self.mass * gas.constant * temperature / volume, temperature


# per rad: intake and exhaust mass and their enthalpy into the cylinder, work and heat out of it
Flows = tuple[float, float, float, float, float]
Rates = Callable[[int, float, float, float], Flows]


def _rates_of(
    engine: CylinderEngine,
    crank_speed: float,
    gas: Gas,
    steps: _Steps,
    film: FilmCoefficient,
) -> Rates:
    """Function for the flows of mass and energy of the cylinder per rad of the crank.

    Its arguments are node number, mass, kg, and internal energy, J, of the gas and specific
    enthalpy of the gas that the intake offers, J/kg. It returns the mass through the intake and
    through the exhaust valve, positive into the cylinder, kg/rad, the enthalpy with both, the work
    of the gas and the heat lost, J/rad.

    Its inputs are bound to local names, since it is called some 1e4 times per cycle.

    Parameters
    ----------
    engine : CylinderEngine   temperatures of the walls, pressures and temperatures of the ports
    crank_speed : float       rad/s
    gas : Gas                 law of its energy
    steps : _Steps            volume and areas at the nodes
    film : FilmCoefficient    node, pressure, temperature -> W/(m2 K)
    """
    volume, volume_rate = steps.volume.tolist(), steps.volume_rate
    wall, intake_area, exhaust_area = steps.wall, steps.intake, steps.exhaust
    a, b, constant = gas.heat_capacity, gas.heat_capacity_rise, gas.constant
    wall_temperature = engine.wall_temperature
    intake_pressure, intake_temperature = engine.intake_pressure, engine.intake_temperature
    exhaust_pressure, exhaust_temperature = engine.exhaust_pressure, engine.exhaust_temperature
    exhaust_enthalpy = gas.enthalpy(exhaust_temperature)
    gamma_intake, gamma_exhaust = gas.gamma(intake_temperature), gas.gamma(exhaust_temperature)

    def rates(node: int, mass: float, energy: float, offered: float) -> Flows:
        specific = energy / (mass * constant)
        temperature = 2.0 * specific / (a + sqrt(a * a + 2.0 * b * specific))
        pressure = mass * constant * temperature / volume[node]
        lost = film(node, pressure, temperature) * wall[node]
        lost *= (temperature - wall_temperature) / crank_speed
        work = pressure * volume_rate[node]
        into, out_of = intake_area[node], exhaust_area[node]
        if not (into > 0.0 or out_of > 0.0):
            return 0.0, 0.0, 0.0, work, lost
        gamma = 1.0 + 1.0 / (a + b * temperature)
        leaving = energy / mass + constant * temperature
        intake = exhaust = 0.0
        if into > 0.0:
            if pressure <= intake_pressure:
                intake = nozzle_flow(
                    intake_pressure, intake_temperature, pressure, constant, gamma_intake
                )
            else:
                intake = -nozzle_flow(pressure, temperature, intake_pressure, constant, gamma)
            intake *= into / crank_speed
        if out_of > 0.0:
            if pressure < exhaust_pressure:
                exhaust = nozzle_flow(
                    exhaust_pressure, exhaust_temperature, pressure, constant, gamma_exhaust
                )
            else:
                exhaust = -nozzle_flow(pressure, temperature, exhaust_pressure, constant, gamma)
            exhaust *= out_of / crank_speed
        enthalpy = intake * (offered if intake > 0.0 else leaving)
        enthalpy += exhaust * (exhaust_enthalpy if exhaust > 0.0 else leaving)
        return intake, exhaust, enthalpy, work, lost

    return rates


def _step(
    rates: Rates,
    node: int,
    length: float,
    content: _Content,
    heat: float,
    offered: float,
) -> Flows:
    """Flows over one step of the classical Runge-Kutta method, the heat released at a constant
    rate: mass through intake and exhaust valve, kg, positive into the cylinder; enthalpy with both,
    work of the gas, heat lost, J.

    Written out: the loop over the steps takes the time of a cycle.

    Parameters
    ----------
    rates : Rates        flows per rad; see `_rates_of`
    node : int           of the start of the step; the next two are its middle and end
    length : float       rad
    content : _Content   gas at the start of the step
    heat : float         rate of heat release, J/rad
    offered : float      specific enthalpy of the gas that the intake offers, J/kg
    """
    mass, energy, half = content.mass, content.energy, 0.5 * length
    i1, x1, h1, w1, q1 = rates(node, mass, energy, offered)
    i2, x2, h2, w2, q2 = rates(
        node + 1, mass + half * (i1 + x1), energy + half * (heat + h1 - w1 - q1), offered
    )
    i3, x3, h3, w3, q3 = rates(
        node + 1, mass + half * (i2 + x2), energy + half * (heat + h2 - w2 - q2), offered
    )
    i4, x4, h4, w4, q4 = rates(
        node + 2, mass + length * (i3 + x3), energy + length * (heat + h3 - w3 - q3), offered
    )
    sixth = length / 6.0
    return (
        sixth * (i1 + 2.0 * (i2 + i3) + i4),
        sixth * (x1 + 2.0 * (x2 + x3) + x4),
        sixth * (h1 + 2.0 * (h2 + h3) + h4),
        sixth * (w1 + 2.0 * (w2 + w3) + w4),
        sixth * (q1 + 2.0 * (q2 + q3) + q4),
    )


def _exchange(content: _Content, port: _Port, intake: float, exhaust: float, gas: Gas) -> float:
    """Update the burnt gas in the cylinder, and the gas pushed back into the intake, after a step;
    returns the enthalpy, J, of the gas drawn in less that of the same mass as offered.

    Parameters
    ----------
    content : _Content        gas in the cylinder, before its mass and energy are updated
    port : _Port              gas pushed back into the intake
    intake, exhaust : float   mass through each valve into the cylinder, kg; negative: out of it
    gas : Gas                 law of its energy
    """
    own, over = content.burnt / content.mass, 0.0
    if intake > 0.0:
        burnt, over = port.give(intake)
    else:
        specific = content.energy / content.mass
        leaving = specific + gas.constant * gas.temperature(specific)
        port.take(-intake, leaving, own)
        burnt = intake * own
    content.burnt += burnt + exhaust * (1.0 if exhaust > 0.0 else own)
    return over


def fuel_mass(engine: CylinderEngine, fresh: float) -> float:
    """Fuel mass (kg) per fresh charge (kg), drawn in with it or injected into it.

    The injected mass, a few per cent, is not added to the gas.
    """
    parts = engine.air_fuel_ratio + (1.0 if engine.ignition == "spark" else 0.0)
    return fresh / parts


def _one_cycle(
    engine: CylinderEngine,
    crank_speed: float,
    gas: Gas,
    steps: _Steps,
    content: _Content,
    port: _Port,
) -> tuple[Array, CycleBalance]:
    """Integrate the working cycle once; `content` and `port` are changed to their state at its end.

    Mass and energy are the unknowns, so both are conserved to round-off whatever the step.

    Parameters
    ----------
    engine : CylinderEngine   the engine
    crank_speed : float       rad/s
    gas : Gas                 law of its energy
    steps : _Steps            steps of the cycle
    content : _Content        gas in the cylinder at its start
    port : _Port              gas pushed back into the intake

    Returns
    -------
    states : array (2, 720)   mass, kg, and energy, J, at the whole degrees, from `steps.start`
    balance : CycleBalance    sums of mass and energy over the cycle
    """
    pressure, temperature = content.state(gas, float(steps.volume[0]))
    charge = Charge(pressure, temperature, float(steps.volume[0]))
    film = film_coefficient(engine, crank_speed, steps.theta, steps.volume, charge)
    rates = _rates_of(engine, crank_speed, gas, steps, film)
    fuel = fuel_mass(engine, content.mass - content.burnt)
    released = fuel * engine.combustion_efficiency * engine.lower_heating_value
    first = content.mass, content.energy
    states, step = [], 0
    drawn = pushed = brought = worked = cooled = heat_released = 0.0
    for count in steps.per_degree:
        states.append((content.mass, content.energy))
        for _ in range(count):
            heat, length = released * steps.burnt[step], steps.length[step]
            intake, exhaust, enthalpy, work, lost = _step(
                rates, 2 * step, length, content, heat, port.offered
            )
            if steps.burnt[step] > 0.0:
                content.burnt = content.mass  # the flame consumes all fresh charge
            if intake != 0.0 or exhaust != 0.0:
                enthalpy += _exchange(content, port, intake, exhaust, gas)
            content.mass += intake + exhaust
            content.energy += heat * length + enthalpy - work - lost
            drawn, pushed, brought = drawn + intake, pushed + exhaust, brought + enthalpy
            worked, cooled = worked + work, cooled + lost
            heat_released += heat * length
            step += 1
    balance = CycleBalance(
        heat_released=heat_released,
        heat_lost=cooled,
        work=worked,
        enthalpy_in=brought,
        energy_change=content.energy - first[1],
        intake_mass=drawn,
        exhaust_mass=-pushed,
        mass_change=content.mass - first[0],
    )
    return np.array(states).T, balance


def working_cycle(
    engine: CylinderEngine, crank_speed: float, gas: Gas = AIR_AND_FUEL
) -> CylinderCycle:
    """The periodic working cycle of one cylinder at constant crank speed.

    A single zone of ideal gas: first law with Wiebe heat release, heat transfer to the walls and
    isentropic flow through both valves. Cycles are integrated until pressure, mass, energy and
    burnt gas at intake valve close repeat within 1e-6.

    Parameters
    ----------
    engine : CylinderEngine
    crank_speed : float    rad/s, from 10 to 2000
    gas : Gas

    Raises
    ------
    InputError
        If the speed is out of range.
    CamError
        If the cycle is not periodic within 200 cycles.

    References
    ----------
    Heywood, Internal Combustion Engine Fundamentals (1988), sec. 9.5 and 14.4.
    Cardoso et al., Designs 8, 47 (2024), eqs 1 to 6.
    """
    if not SPEED_RANGE[0] <= crank_speed <= SPEED_RANGE[1]:
        limit = f"from {SPEED_RANGE[0]:g} to {SPEED_RANGE[1]:g} rad/s"
        raise InputError("crank_speed", crank_speed, limit)
    steps = _steps(engine, crank_speed)
    volume = float(steps.volume[0])
    temperature = engine.intake_temperature + 60.0
    mass = engine.intake_pressure * volume / (gas.constant * temperature)
    content = _Content(mass, mass * gas.energy(temperature), 0.2 * mass)
    port = _Port(gas.enthalpy(engine.intake_temperature))
    for _ in range(CYCLES_MAX):
        before = _fingerprint(content, gas, volume)
        states, balance = _one_cycle(engine, crank_speed, gas, steps, content, port)
        change = np.abs(_fingerprint(content, gas, volume) / before - 1.0)
        if change.max() < REPEATS_WITHIN:
            break
    else:
        text = f"the working cycle did not become periodic within {CYCLES_MAX} cycles"
        raise CamError(f"{text}: the pressure still changes by {change[0]:.1e} of itself")
    mass_at, energy_at = np.roll(states, steps.start, axis=1)
    theta = np.radians(np.arange(float(STEPS_PER_CYCLE)))
    temperature_at = gas.temperature(energy_at / mass_at)
    return CylinderCycle(
        engine=engine,
        crank_speed=crank_speed,
        theta=theta,
        pressure=mass_at * gas.constant * temperature_at / engine.volume(theta),
        temperature=temperature_at,
        mass=mass_at,
        fuel_mass=fuel_mass(engine, before[1] * (1.0 - before[3])),
        residual_fraction=float(before[3]),
        balance=balance,
        closure=float(change[0]),
    )


def _fingerprint(content: _Content, gas: Gas, volume: float) -> Array:
    """Pressure, mass, energy and burnt fraction, which must repeat from cycle to cycle."""
    pressure, _ = content.state(gas, volume)
    return np.array([pressure, content.mass, content.energy, content.burnt / content.mass])
