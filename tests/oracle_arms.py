"""Cams under an arm in closed form, as CasADi expressions, for the oracle of the synthesis.

Written from the geometry of the linkage and the moments about its pivot, apart from the product: of
a case plain numbers are read. Vectors are those of the machine, as its cam turns clockwise: the cam
axis at the origin, the pivot at (c, 0), the arm at the angle psi from the line to the cam axis.

References
----------
Norton, Cam Design and Manufacturing Handbook (2009), ch. 7. Envelope of a line by its support
function h: contact h' beside the normal, radius of curvature h + h'', by the angle of the normal.
Hertz: Johnson, Contact Mechanics (1985), sec. 4.2(c). Friction circle of a pivot: radius mu r.
"""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import casadi as ca
import oracle_limits as limits
from oracle_states import OracleLimit, lift_of

_LEAST_HERTZ = 1e-9  # N, of a half-width
_GRAVITY = 9.80665  # m/s2, standard


def _unit(angle):
    return ca.vertcat(ca.cos(angle), ca.sin(angle))


def _turned(vector):
    """A vector a quarter of a turn counter-clockwise."""
    return ca.vertcat(-vector[1], vector[0])


def _cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def _along(function, variable, rates):
    """A vector of a variable and its derivatives by time (3), from those of the variable (3)."""
    first, second, third = rates
    by = [function]
    for _ in range(3):
        by.append(ca.jacobian(by[-1], variable))
    return [
        by[1] * first,
        by[2] * first**2 + by[1] * second,
        by[3] * first**3 + 3 * by[2] * first * second + by[1] * third,
    ]


@dataclass(frozen=True)
class OracleArm:
    """Arm with roller, flat or curved face, its pivot and its spring, as plain numbers, SI.

    link: ends of the spring about the pivot, rate, N/m, and preload, N; None: at the end of the
    arm, or where it `winds` about the pivot, of a moment alone. offset: of a flat face, radius: of
    a curved one, both with friction and face_width; None: a roller. pin: radius of the pin; mass,
    at `mass_distance` and `mass_angle`: of all that swings, reduced: that at the end of the arm;
    upward: from the vertical to the line from the cam axis to the pivot, None: without weight;
    bounds: limits by the key of the constraint.
    """

    centre: float
    length: float
    sense: float
    pin: float
    mass: float
    reduced: float
    mass_distance: float
    mass_angle: float
    bounds: dict
    bush_area: float | None = None
    offset: float | None = None
    radius: float | None = None
    friction: float = 0.0
    face_width: float | None = None
    link: dict | None = None
    winds: bool = False
    upward: float | None = None

    @classmethod
    def of(cls, case, problem):
        arm, pivot, face = case.follower.arm, case.follower.pivot, case.follower.face
        assert pivot.load_moment == 0.0
        # of both together the arc has no closed form
        assert pivot.gravity_angle is None or case.spring.link is None
        bush, link = pivot.bush, case.spring.link
        ends = ("arm_radius", "arm_angle", "fixed_radius", "fixed_angle", "rate", "preload")
        return cls(
            arm.centre_distance, arm.length, {"with": 1.0, "against": -1.0}[arm.swing],
            0.5 * pivot.bearing.diameter, pivot.swinging_mass, case.follower.mass,
            pivot.mass_distance, pivot.mass_angle, dict(problem.ratings.bounds),
            bush_area=None if bush is None else bush.length * bush.diameter,
            offset=None if face is None else face.offset,
            radius=None if face is None else face.radius,
            friction=0.0 if face is None else face.friction,
            face_width=None if face is None else face.width,
            link=None if link is None else {name: getattr(link, name) for name in ends},
            winds=case.spring.kind == "torsion_pivot", upward=pivot.gravity_angle,
        )  # fmt: skip

    # the spring -----------------------------------------------------------------------------

    def lift_of(self, energy, rate, preload, prime):
        """Arc at which the spring has stored an energy: by the distance of its ends; the weight
        stores as much as its moment at the start would.
        """
        if self.link is None:
            return lift_of(energy, rate, preload + self._weight(self._start(prime), self.mass)[1])
        on, fixed = self.link["arm_radius"], self.link["fixed_radius"]
        angle = self.link["fixed_angle"] - self.link["arm_angle"]
        travel = lift_of(energy, self.link["rate"], self.link["preload"])
        free = ca.sqrt(on**2 + fixed**2 - 2 * on * fixed * ca.cos(angle))
        cosine = (on**2 + fixed**2 - (free - travel) ** 2) / (2 * on * fixed)
        return self.length * (angle - ca.acos(cosine))

    def _point(self, radius, angle):
        """Point about the pivot at an angle like psi."""
        return ca.vertcat(self.centre - radius * ca.cos(angle), self.sense * radius * ca.sin(angle))

    def _start(self, prime):
        """Angle of the arm at zero lift."""
        if self.offset is not None:
            return ca.asin((prime + self.offset) / self.centre)
        square = self.centre**2 + self.length**2 - prime**2
        return ca.acos(square / (2 * self.centre * self.length))

    def _weight(self, psi, mass):
        """Weight of a mass, N, and its force on the arc, positive towards the cam."""
        if self.upward is None:
            return ca.DM.zeros(2), 0
        # the line to the pivot, along x, is turned clockwise from the vertical by that angle
        force = -mass * _GRAVITY * _unit(self.upward)
        at = self._point(self.mass_distance, psi + self.mass_angle) - ca.vertcat(self.centre, 0.0)
        return force, self.sense * _cross(at, force) / self.length

    def _spring(self, cam, psi, rate, preload):
        """Force of the spring on the arm, N, and on the arc, positive towards the cam."""
        out = ca.vertcat(ca.sin(psi), self.sense * ca.cos(psi))
        if self.link is None:
            force = preload + rate * cam.lift
            return -force * out * (not self.winds), force
        on = self._point(self.link["arm_radius"], psi + self.link["arm_angle"])
        end = self._point(self.link["fixed_radius"], cam.start + self.link["fixed_angle"])
        angle = self.link["fixed_angle"] - self.link["arm_angle"]
        radii = self.link["arm_radius"], self.link["fixed_radius"]
        free = ca.sqrt(radii[0] ** 2 + radii[1] ** 2 - 2 * radii[0] * radii[1] * ca.cos(angle))
        distance = ca.norm_2(on - end)
        push = self.link["preload"] + self.link["rate"] * (free - distance)
        force = push * (on - end) / distance
        lever = on - ca.vertcat(self.centre, 0.0)
        # outwards the arm turns clockwise where it swings with the cam
        return force, self.sense * _cross(lever, force) / self.length

    # the cam --------------------------------------------------------------------------------

    def shape_at(self, energy, free, p):
        """Unloaded cam at an angle; see `oracle_states.shape_at`."""
        rate, preload, prime = (free[k] for k in range(3))
        level = ca.SX.sym("level")
        by_energy = [self.lift_of(level, rate, preload, prime)]
        for _ in range(3):
            by_energy.append(ca.gradient(by_energy[-1], level))
        f0, f1, f2, f3 = ca.substitute(by_energy, [level], [energy[0]])
        e1, e2, e3 = energy[1], energy[2], energy[3]
        lift, slope, lift_d2 = f0, f1 * e1, f2 * e1**2 + f1 * e2
        jerk = f3 * e1**3 + 3 * f2 * e1 * e2 + f1 * e3
        rates = [each / self.length for each in (slope, lift_d2, jerk)]
        start = self._start(prime)
        if self.radius is not None:
            p = SimpleNamespace(**vars(p) | {"roller_radius": self.radius})
        cam = SimpleNamespace(
            p=p, lift=lift, slope=slope, lift_d2=lift_d2, jerk=jerk, rate=rate, preload=preload,
            prime_radius=prime, start=start, rates=rates, psi=start + lift / self.length,
        )  # fmt: skip
        known = self._roller(cam, p) if self.offset is None else self._face(cam)
        if self.radius is not None:
            known |= self._slid(cam, known)
        return SimpleNamespace(**vars(cam), **known)

    def _roller(self, cam, p):
        """Path of the roller centre in the cam, which turns by -theta: z' there is v + i z."""
        psi = ca.SX.sym("psi")
        centre = self._point(self.length, psi)
        motion = [centre, *_along(centre, psi, cam.rates)]
        z = [ca.substitute(each, psi, cam.psi) for each in motion]
        velocity = z[1] + _turned(z[0])
        pull = z[2] + 2 * _turned(z[1]) - z[0]
        change = z[3] + 3 * _turned(z[2]) - 3 * z[1] - _turned(z[0])
        stretch = ca.norm_2(velocity)
        bend = _cross(velocity, pull)
        curvature = bend / stretch**3
        slope = _cross(velocity, change) / stretch**3
        slope = slope - 3 * bend * ca.dot(velocity, pull) / stretch**5
        normal = -_turned(velocity) / stretch
        out = ca.vertcat(ca.sin(cam.psi), self.sense * ca.cos(cam.psi))
        across = ca.vertcat(out[1], -out[0])
        return {
            "centre": z[0], "curvature": curvature, "curvature_slope": slope,
            "stretch": stretch, "push": normal,
            "cosine": ca.dot(normal, out), "tangent": ca.dot(normal, across) / ca.dot(normal, out),
            "sharpness": p.roller_radius * curvature, "lever": self.length * ca.dot(normal, out),
            "contour_radius": ca.norm_2(z[0] - p.roller_radius * normal), "rubbed": 0,
            "turning": 1 - self.sense * cam.rates[0], "sliding": 0, "place": None,
        }  # fmt: skip

    def _slid(self, cam, rolled):
        """Contact of a round face at the end of the arm, which the surface of the cam, clockwise,
        drags with it where it is the faster.
        """
        normal, pivot = rolled["push"], ca.vertcat(self.centre, 0.0)
        contact, along = rolled["centre"] - self.radius * normal, -_turned(normal)
        slip = ca.dot(
            self.sense * cam.rates[0] * _turned(contact - pivot) - _turned(contact), along
        )
        push = normal + self.friction * ca.sign(slip) * along
        arm = ca.vertcat(-ca.cos(cam.psi), self.sense * ca.sin(cam.psi))
        return {
            "push": push, "lever": -self.sense * _cross(contact - pivot, push),
            "sliding": ca.fabs(slip), "work": -_cross(contact, push), "height": self.radius,
            "place": ca.dot(contact - pivot, arm),
            "radius": self.radius * (1 - rolled["sharpness"]),
        }  # fmt: skip

    def _face(self, cam):
        """Envelope of the line of the face by its support function."""
        psi = ca.SX.sym("psi")
        height = self.centre * ca.sin(psi) - self.offset
        first, second, _ = (ca.substitute(each, psi, cam.psi)
                            for each in _along(height, psi, cam.rates))  # fmt: skip
        height = ca.substitute(height, psi, cam.psi)
        turn, turn_d1 = 1 - self.sense * cam.rates[0], -self.sense * cam.rates[1]
        beside = first / turn
        radius = height + (second / turn - first * turn_d1 / turn**2) / turn
        out = ca.vertcat(ca.sin(cam.psi), self.sense * ca.cos(cam.psi))
        tangent = _turned(out)
        contact = height * out + beside * tangent
        place = contact - ca.vertcat(self.centre, 0.0)
        arm = ca.vertcat(-ca.cos(cam.psi), self.sense * ca.sin(cam.psi))
        push = out - self.friction * tangent
        return {
            "radius": radius, "height": height, "push": push, "place": ca.dot(place, arm),
            "contour_radius": ca.norm_2(contact), "sharpness": 1 - radius / height,
            # moment of normal and friction outwards, which is clockwise where it swings with
            "lever": -self.sense * _cross(place, push),
            "rubbed": self.friction * (height + self.sense * self.offset * cam.rates[0]),
            "sliding": height + self.sense * self.offset * cam.rates[0],
            "work": beside + self.friction * height,
        }  # fmt: skip

    # the loads ------------------------------------------------------------------------------

    def loads_at(self, cam, highest, scenario, fix):
        """Loaded cam at an angle; see `oracle_states.loads_at`.

        With the lever b of the contact, the moment M of spring and inertia, the sum Q of their
        forces and rho = mu r, N b - M = sign(s') rho |N n + Q|, squared.
        """
        p, speed = cam.p, scenario.cam_speed
        mass = scenario.mass * p.mass_factor
        rate, preload = cam.rate * scenario.rate_factor, cam.preload * scenario.preload_factor
        pulled, spring = self._spring(cam, cam.psi, rate, preload)
        swinging = self.mass * mass / self.reduced  # both in the tolerance of the mass
        weight, closing = self._weight(cam.psi, swinging)
        pulled, spring = pulled + weight, spring + closing
        angle = ca.SX.sym("angle")
        there = self._point(self.mass_distance, angle + self.mass_angle)
        acceleration = ca.substitute(_along(there, angle, cam.rates)[1], angle, cam.psi)
        total = pulled - swinging * speed**2 * acceleration
        inertia = mass * speed**2 * cam.lift_d2
        unrubbed = spring + inertia + scenario.viscous_damping * speed * cam.slope
        moment, circle = self.length * unrubbed, scenario.friction_a * p.friction_factor * self.pin
        push, lever = cam.push, cam.lever
        square = lever**2 - circle**2 * ca.dot(push, push)
        middle = lever * moment + circle**2 * ca.dot(push, total)
        rest = moment**2 - circle**2 * ca.dot(total, total)
        normal = middle + ca.sign(cam.slope) * ca.sqrt(ca.fmax(middle**2 - square * rest, 0))
        normal = normal / square
        load = ca.norm_2(normal * push + total)
        if self.offset is None:
            axial = normal * cam.cosine
            torque = axial * cam.slope if self.radius is None else normal * cam.work
        else:  # reduced to the end of the arm, of the normal force alone
            axial = normal * cam.place / self.length
            torque = normal * cam.work
        least = preload if self.link is None else cam.preload
        jam = ca.if_else(cam.slope > 0, circle * load / (self.length * ca.fmax(axial, 1)), 0)
        return SimpleNamespace(
            **vars(cam), scenario=scenario, fix=fix, spring=spring, inertia=inertia,
            unrubbed=unrubbed, axial=axial, normal=normal, mass=mass, least_spring=least,
            highest=highest, pivot_load=load, jam=jam, torque=torque,
            surged=ca.fmax(normal, 0), velocity=speed * cam.slope,
            spin=0 if self.offset is not None or self.radius is not None
            else speed * (cam.stretch / p.roller_radius - cam.turning),
        )  # fmt: skip

    # the limits -----------------------------------------------------------------------------

    @property
    def limits(self):
        """Limits of the cam, its follower and the pivot."""
        shared = {each.check: each for each in limits.LIMITS}
        names = [
            "spring_travel", "cam_radius", "contact_force_margin", "contact_at_overspeed", "jump",
            "jump_speed",
        ]  # fmt: skip
        if self.offset is None:
            names += ["pressure_angle", "curvature_ratio", "undercut", "concave_radius",
                      "curvature_rate", "contact_pressure"]  # fmt: skip
            names += [] if self.radius else ["roller_static", "roller_speed", "roller_life"]
        pivot = {
            "pivot_jam_index": ("loads", lambda at: at.jam / self.bounds["jam_index"]),
            "pivot_static": ("loads", lambda at: at.pivot_load / self.bounds["pivot_static"]),
            "pivot_pressure": ("loads", lambda at: at.pivot_load / self.bush_area
                               / self.bounds["pivot_pressure"]),
            "pivot_pv": ("mean", lambda at: at.pivot_load * ca.fabs(at.velocity) * self.pin
                         / self.length / self.bush_area / self.bounds["pivot_pv"]),
        }  # fmt: skip
        face = {
            "undercut": ("shape", lambda at: at.sharpness / (1 - at.p.undercut_factor)),
            "bore_pressure": ("loads", lambda at: at.normal * at.fix.force_weight
                              / at.p.normal_force),
            "contact_pressure": ("loads", lambda at: self._pressed(
                at, at.p.pressure / at.fix.pressure_weight)),
            "face_pv": ("loads", lambda at: self._pressed(
                at, self.bounds["face_pv"] / (ca.pi / 4 * at.scenario.cam_speed * at.sliding))),
            "face_width": ("loads", self._width),
        }  # fmt: skip
        if self.radius is not None:
            face = {name: face[name] for name in ("bore_pressure", "face_pv", "face_width")}
        own = pivot if self.offset is None and self.radius is None else face | pivot
        bound = {"pivot_jam_index": "jam_index"}
        there = {
            name: each for name, each in own.items()
            if name not in pivot or bound.get(name, name) in self.bounds
        }  # fmt: skip
        stated = [
            OracleLimit(name, of, "", use, "moments about the pivot; Johnson (1985), sec. 4.2(c)")
            for name, (of, use) in there.items()
        ]
        return [shared[name] for name in names] + stated

    def _pressed(self, at, allowed):
        """1 less the radius over the height, and the least radius of the pressure over it."""
        needed = at.normal / at.p.contact_width * at.p.contact_modulus / (ca.pi * allowed**2)
        return at.sharpness + needed / at.height

    def _width(self, at):
        line = ca.fmax(at.normal * at.radius, _LEAST_HERTZ) / at.p.contact_width
        half = ca.sqrt(4 * line / (ca.pi * at.p.contact_modulus))
        beside = at.place - self.length
        return tuple(2 * (side * beside + half) / self.face_width for side in (1, -1))
