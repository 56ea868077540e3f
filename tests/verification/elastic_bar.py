"""Longitudinal vibration of an elastic bar, fixed at x = 0 and free at x = L: one mode, undamped, small strain.

u'' c^2 = d2u/dt2 with c^2 = modulus / density; mode n has the wave number (2 n - 1) pi / (2 L). The bar starts straight, with the
velocity of the mode. The modulus is that of uniaxial strain where the sides are on rollers, or of plane strain with free sides
where they are free; the latter is exact for a thin bar only, and lateral inertia (Love 1927, art. 278, here in plane strain)
lowers its frequency by `slowing`.
"""

import dataclasses

import numpy


def uniaxial_strain_modulus(young, poisson):
    """Pa: sides on rollers, out of plane held."""
    return young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))


def free_sides_modulus(young, poisson):
    """Pa: sides free, out of plane held."""
    return young / (1 - poisson**2)


@dataclasses.dataclass
class Bar:
    modulus: float  # Pa
    density: float  # kg/m3
    length: float  # m
    speed: float  # m/s: of the free end at the start
    mode: int = 1

    @property
    def wave_number(self):
        """1/m."""
        return (2 * self.mode - 1) * numpy.pi / (2 * self.length)

    @property
    def wave_speed(self):
        """m/s."""
        return numpy.sqrt(self.modulus / self.density)

    @property
    def frequency(self):
        """rad/s."""
        return self.wave_speed * self.wave_number

    @property
    def period(self):
        """s."""
        return 2 * numpy.pi / self.frequency

    def displacement(self, x, time):
        """m, at places x of the undeformed bar."""
        return self.speed / self.frequency * self._shape(x) * numpy.sin(self.frequency * time)

    def velocity(self, x, time):
        """m/s."""
        return self.speed * self._shape(x) * numpy.cos(self.frequency * time)

    def stress(self, x, time):
        """Pa, tension positive, along the bar."""
        strain = self.speed / self.wave_speed * numpy.cos(self.wave_number * numpy.asarray(x)) * numpy.sin(self.frequency * time)
        return self.modulus * strain * self._sign()

    def kinetic_energy(self, time):
        """J per m2 of cross-section."""
        return self.energy() * numpy.cos(self.frequency * time) ** 2

    def strain_energy(self, time):
        """J per m2 of cross-section."""
        return self.energy() * numpy.sin(self.frequency * time) ** 2

    def energy(self):
        """J per m2 of cross-section, for all times."""
        return 0.25 * self.density * self.speed**2 * self.length

    def _shape(self, x):
        return numpy.sin(self.wave_number * numpy.asarray(x)) * self._sign()

    def _sign(self):
        """So that the free end moves outwards first in every mode."""
        return 1 if self.mode % 2 else -1


def slowing(wave_number, thickness, poisson):
    """By which factor lateral inertia multiplies the frequency of a bar with free sides, plane strain; to order 4 of their product."""
    lateral = poisson / (1 - poisson)  # strain across for a unit strain along
    return 1 / numpy.sqrt(1 + (lateral * wave_number * thickness) ** 2 / 12)
