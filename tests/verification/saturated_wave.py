"""Transient wave in a fluid-saturated porous column of incompressible constituents: de Boer, Ehlers & Liu (1993).

Archive of Applied Mechanics 63, 59-72. One dimension, depth x downwards, the surface drained (p = 0) and loaded by f(t), linear
elastic skeleton, no gravity. With n_s v_s + n_l v_l = 0 the momenta of docs/theory.md leave for the solid's displacement

    (lambda + 2 mu) u'' = rho* d2u/dt2 + (gamma_w / k) du/dt,    rho* = n_s rho_s + n_s^2 rho_l / n_l

The drag is S_v = n_l^2 gamma_w / k per volume of mixture, k the conductivity in m/s (de Boer's k^F), gamma_w = rho_l g: S_v / n_l^2 =
mu_l / kappa is all that enters, whatever the porosity. By Laplace transform, with c^2 = (lambda + 2 mu) / rho*, b = gamma_w / (k rho*):

    u = c / (lambda + 2 mu) * integral from x/c to t of f(t - s) exp(-b s / 2) I_0(b / 2 sqrt(s^2 - x^2 / c^2)) ds

A column on a fixed impermeable base is the sum of images of the half-space. The pressure follows from the fluid's momentum:

    p = r g + (1 - r) b * integral from 0 to t of exp(-b (t - s)) g(x, s) ds,    g = sigma' + f,  r = rho_l n_s / (n_l rho*)
"""

import dataclasses

import numpy
from scipy.special import ive

PANELS, NODES, WEIGHTS = 60, *numpy.polynomial.legendre.leggauss(8)


@dataclasses.dataclass
class Ground:
    """The defaults are the classical example (see reference/README.md for what of it was checked)."""

    first_lame: float = 5.5833e6  # Pa
    shear: float = 8.3750e6  # Pa; both: E = 20.1 MPa, nu = 0.2
    porosity: float = 0.33
    solid_density: float = 2000.0  # kg/m3, of the grains
    fluid_density: float = 1000.0  # kg/m3
    conductivity: float = 1e-2  # m/s
    gravity: float = 9.81  # m/s2, in gamma_w alone

    @property
    def modulus(self):
        """Pa, of uniaxial strain."""
        return self.first_lame + 2 * self.shear

    @property
    def inertia(self):
        """rho*, kg/m3."""
        solid = 1 - self.porosity
        return solid * self.solid_density + solid**2 * self.fluid_density / self.porosity

    @property
    def speed(self):
        """c, m/s."""
        return numpy.sqrt(self.modulus / self.inertia)

    @property
    def damping(self):
        """b, 1/s."""
        return self.fluid_density * self.gravity / (self.conductivity * self.inertia)

    @property
    def fluid_share(self):
        """r: pressure far below over the load, at once after a step."""
        return self.fluid_density * (1 - self.porosity) / (self.porosity * self.inertia)


def step(load):
    """f(t) of a load in Pa put on at time 0."""
    return lambda time: numpy.where(time >= 0, load, 0.0)


def one_minus_cosine(load, frequency):
    """f(t) = load (1 - cos(frequency t)); Pa, rad/s."""
    return lambda time: numpy.where(time >= 0, load * (1 - numpy.cos(frequency * time)), 0.0)


class Column:
    """`height` in m, of a column on a fixed impermeable base; none for the half-space. `load(time array)` in Pa, compression positive.

    The load must be smooth after time 0, and vary slowly over a sixtieth of the time asked for.
    """

    def __init__(self, ground, load, height=None, panels=PANELS):
        self.ground, self.load, self.height = ground, load, height
        edge = numpy.linspace(0, 1, panels + 1)
        self._unit, self._weight = _gauss(edge**4)
        self._unit_both, self._weight_both = _gauss(edge**4 / (edge**4 + (1 - edge) ** 4))

    def displacement(self, x, time):
        """Of the solid at depth x, m, downwards; numbers."""
        return sum(sign * self._half_space_displacement(depth, time) for sign, depth in self._images(x, time, -1))

    def effective_stress(self, x, time):
        """At depth x, Pa, tension positive; x a number, time a number or array."""
        time = numpy.atleast_1d(numpy.asarray(time, float))
        return sum(sign * self._half_space_stress(depth, time) for sign, depth in self._images(x, time.max(), 1))

    def pressure(self, x, time):
        """Of the pore water at depth x, Pa; numbers."""
        ground = self.ground
        arrival = min(x / ground.speed, time)
        early = arrival * self._unit_both
        before = _dot(arrival * self._weight_both, numpy.exp(-ground.damping * (time - early)) * self.load(early))
        rest = time - arrival
        late = arrival + rest * self._unit_both
        after = _dot(rest * self._weight_both, numpy.exp(-ground.damping * (time - late)) * self._carried_by_water(x, late))
        now = self._carried_by_water(x, numpy.array([time]))[0]
        return ground.fluid_share * now + (1 - ground.fluid_share) * ground.damping * (before + after)

    def _carried_by_water(self, x, time):
        return self.effective_stress(x, time) + self.load(time)

    def _images(self, x, time, sign):
        """(sign, depth) of the half-spaces that a wave has reached; `sign` is that of the one below the base."""
        if self.height is None:
            return [(1, x)]
        reflections = int(self.ground.speed * time / (2 * self.height)) + 1
        images = []
        for order in range(reflections + 1):
            images.append(((-1) ** order, 2 * order * self.height + x))
            images.append((sign * (-1) ** order, 2 * (order + 1) * self.height - x))
        return images

    def _half_space_displacement(self, x, time):
        ground = self.ground
        arrival = x / ground.speed
        if time <= arrival:
            return 0.0
        delay = arrival + (time - arrival) * self._unit
        kernel = _bessel(0, ground.damping, delay, arrival)
        return ground.speed / ground.modulus * (time - arrival) * _dot(self._weight, self.load(time - delay) * kernel)

    def _half_space_stress(self, x, time):
        ground = self.ground
        arrival = x / ground.speed
        rest = numpy.maximum(time - arrival, 0.0)[:, None]
        delay = arrival + rest * self._unit
        root = numpy.sqrt(numpy.maximum(delay**2 - arrival**2, 1e-300))
        kernel = 0.5 * ground.damping * arrival * _bessel(1, ground.damping, delay, arrival) / root
        front = self.load(time - arrival) * numpy.exp(-0.5 * ground.damping * arrival) * (time >= arrival)
        return -front - (rest * self._weight * self.load(time[:, None] - delay) * kernel).sum(axis=1)


def _bessel(order, damping, delay, arrival):
    """exp(-damping delay / 2) I_order(damping / 2 sqrt(delay^2 - arrival^2)), without overflow."""
    root = numpy.sqrt(numpy.maximum(delay**2 - arrival**2, 0.0))
    return ive(order, 0.5 * damping * root) * numpy.exp(0.5 * damping * (root - delay))


def _gauss(edges):
    """Places and weights of Gauss points in the panels between edges."""
    half = 0.5 * numpy.diff(edges)[:, None]
    return (edges[:-1, None] + half * (1 + NODES)).ravel(), (half * WEIGHTS).ravel()


def _dot(weight, value):
    return float(weight @ value)
