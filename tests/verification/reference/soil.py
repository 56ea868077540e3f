"""The soil of both scenes: van Genuchten retention and Mualem permeability (SI units, suction s = -p)."""
import numpy as np

GRAVITY = 9.81
WATER_DENSITY = 1000.0
WATER_STIFFNESS = 2.0e9
POROSITY = 0.4
CONDUCTIVITY = 1e-4
ALPHA = 4e-5
EXPONENT_N = 1.2
EXPONENT_M = 1.0 - 1.0 / EXPONENT_N
CHORD = 10.0  # Pa: below this suction k_r, whose slope is infinite at saturation, is replaced by its chord,
ROUNDING = 1.0  # Pa: and the chord's kink at saturation is rounded by a parabola below this suction


def mualem(suction):
    """Mualem k_r without the chord, written so that nothing cancels near saturation."""
    a = (ALPHA * suction) ** EXPONENT_N
    return (1 + a) ** (-0.5 * EXPONENT_M) * (1 - (a / (1 + a)) ** EXPONENT_M) ** 2


CHORD_VALUE = float(mualem(CHORD))


def saturation(pressure):
    suction = np.maximum(-pressure, 0.0)
    return (1 + (ALPHA * suction) ** EXPONENT_N) ** -EXPONENT_M


def saturation_slope(pressure):
    """dS/dp, 0 where saturated."""
    suction = np.maximum(-pressure, 0.0)
    a = (ALPHA * suction) ** EXPONENT_N
    return EXPONENT_M * EXPONENT_N * ALPHA * (ALPHA * suction) ** (EXPONENT_N - 1) * (1 + a) ** (-EXPONENT_M - 1)


def permeability(pressure):
    suction = np.maximum(-pressure, 0.0)
    rounded = np.where(suction < ROUNDING, 0.5 * suction ** 2 / ROUNDING, suction - 0.5 * ROUNDING)
    chord = 1 - (1 - CHORD_VALUE) * rounded / (CHORD - 0.5 * ROUNDING)
    return np.where(suction < CHORD, chord, mualem(np.maximum(suction, CHORD)))


class Potential:
    """Kirchhoff potential Phi(p) = integral of k_r dp from 0, and the mean of k_r between two pressures.

    Tabulated in tau, s = tau^3, with cubic Hermite interpolation (its slope is the exact k_r): error below 1e-9 of Phi.
    """

    def __init__(self, permeability=permeability, largest_suction=1e6, intervals=40000):
        self.permeability = permeability
        self.tau = np.linspace(0.0, largest_suction ** (1 / 3), intervals + 1)
        nodes, weights = np.polynomial.legendre.leggauss(6)
        width = self.tau[1]
        points = self.tau[:-1, None] + 0.5 * width * (1 + nodes)
        values = permeability(-points ** 3) * 3 * points ** 2
        self.table = np.concatenate([[0.0], -np.cumsum(0.5 * width * values @ weights)])
        self.slope = -permeability(-self.tau ** 3) * 3 * self.tau ** 2

    def __call__(self, pressure):
        tau = np.cbrt(np.maximum(-pressure, 0.0))
        width = self.tau[1]
        i = np.minimum((tau / width).astype(int), self.tau.size - 2)
        x = tau / width - i
        value = ((1 + 2 * x) * (1 - x) ** 2 * self.table[i] + x * (1 - x) ** 2 * width * self.slope[i]
                 + x ** 2 * (3 - 2 * x) * self.table[i + 1] + x ** 2 * (x - 1) * width * self.slope[i + 1])
        return np.where(pressure >= 0, pressure, value)

    def inverse(self, potential):
        """p of a potential, by Newton from the table's linear interpolation; no suction beyond the table's."""
        dry = np.clip(potential, self.table[-1], 0.0)
        p = -np.interp(-dry, -self.table, self.tau) ** 3
        for _ in range(3):
            p = np.clip(p - (self(p) - dry) / self.permeability(p), -self.tau[-1] ** 3, 0.0)
        return np.where(potential > 0, potential, p)

    def mean(self, low, high):
        """Mean of k_r over [low, high] and its derivatives with respect to both pressures."""
        difference = high - low
        near = np.abs(difference) < 1e-2 + 1e-6 * np.abs(low)
        safe = np.where(near, 1.0, difference)
        middle = self.permeability(0.5 * (low + high))
        mean = np.where(near, middle, (self(high) - self(low)) / safe)
        k_low, k_high = self.permeability(low), self.permeability(high)
        slope_low = np.where(near, 0.0, (mean - k_low) / safe)
        slope_high = np.where(near, 0.0, (k_high - mean) / safe)
        return mean, slope_low, slope_high
