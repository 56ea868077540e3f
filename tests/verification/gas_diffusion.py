"""Air pressure diffusing into dry soil: ideal gas, isothermal, Darcy's law, rigid skeleton, no gravity, no inertia of the air.

    n dP/dt = d/dy (P kappa/mu dP/dy),    P absolute

Column closed at y = 0, held at y = height from time 0, P = atmosphere before. `linear` is the series for a small step (n dP/dt =
kappa P_atm / mu P''; Carslaw & Jaeger 1959, art. 3.4), in error by about step / P_atm; `Nonlinear` solves the whole by Chebyshev
collocation over the column and its mirror image, in time by Radau.
"""

import dataclasses

import numpy
from scipy.integrate import solve_ivp

TERMS = 400


@dataclasses.dataclass
class Soil:
    """The defaults: conductivity to water 1e-4 m/s, air at 20 degrees."""

    porosity: float = 0.4
    permeability: float = 1e-4 * 1e-3 / 9810  # m2, kappa k_rg
    viscosity: float = 1.8e-5  # Pa s
    atmosphere: float = 101325.0  # Pa, absolute

    @property
    def diffusivity(self):
        """m2/s, of a small disturbance."""
        return self.permeability * self.atmosphere / (self.porosity * self.viscosity)


def linear(soil, height, step, y, time):
    """Gauge pressure, Pa, at places y (array) above the closed end (m); time > 0 in s."""
    root = (numpy.arange(TERMS) + 0.5) * numpy.pi
    modes = numpy.cos(numpy.outer(numpy.asarray(y) / height, root))
    decay = numpy.exp(-(root**2) * soil.diffusivity * time / height**2)
    return step * (1 - modes @ (2 * numpy.where(numpy.arange(TERMS) % 2, -1, 1) / root * decay))


class Nonlinear:
    """P^2 diffusion after a step of any size; all times (s, ascending, > 0) in one run."""

    def __init__(self, soil, height, step, times, degree=96, tolerance=1e-10):
        self.soil, self.height, self.step = soil, height, step
        self.place, derivative = _chebyshev(degree)
        self._second = (derivative @ derivative)[1:-1]
        self._end = 1 + step / soil.atmosphere  # pressures over the atmosphere, times in height^2 / diffusivity
        scaled = soil.diffusivity / height**2 * numpy.asarray(times)
        start = numpy.ones(degree - 1)
        run = solve_ivp(self._rate, (0, scaled[-1]), start, "Radau", scaled, rtol=tolerance, atol=tolerance, jac=self._slope)
        self._pressure = [self._with_ends(values) for values in run.y.T]

    def pressure(self, y, index):
        """Gauge pressure, Pa, at places y (array) above the closed end (m), at times[index]."""
        relative = _interpolate(self.place, self._pressure[index], numpy.asarray(y) / self.height)
        return self.soil.atmosphere * (relative - 1)

    def mass(self, index):
        """Gas in the column at times[index], over that at P_atm."""
        nodes, weights = numpy.polynomial.legendre.leggauss(len(self.place))
        return 0.5 * weights @ _interpolate(self.place, self._pressure[index], nodes)

    def _with_ends(self, inner):
        return numpy.concatenate([[self._end], inner, [self._end]])

    def _rate(self, time, inner):
        return 0.5 * self._second @ self._with_ends(inner) ** 2

    def _slope(self, time, inner):
        return self._second[:, 1:-1] * inner


def _chebyshev(degree):
    """Places from 1 to -1 and the matrix that differentiates (Trefethen 2000, ch. 6)."""
    place = numpy.cos(numpy.pi * numpy.arange(degree + 1) / degree)
    weight = numpy.where(numpy.arange(degree + 1) % 2, -1.0, 1.0)
    weight[[0, -1]] *= 2
    distance = place[:, None] - place + numpy.eye(degree + 1)
    matrix = numpy.outer(weight, 1 / weight) / distance
    return place, matrix - numpy.diag(matrix.sum(axis=1))


def _interpolate(place, value, at):
    """Barycentric, at places between -1 and 1."""
    weight = numpy.where(numpy.arange(len(place)) % 2, -1.0, 1.0)
    weight[[0, -1]] *= 0.5
    distance = numpy.asarray(at, float)[:, None] - place
    hit = numpy.abs(distance) < 1e-15
    ratio = weight / numpy.where(hit, 1.0, distance)
    smooth = (ratio @ value) / ratio.sum(axis=1)
    return numpy.where(hit.any(axis=1), hit @ value, smooth)
