"""Vapour that spreads along a closed column from its moister half, at one temperature and gas pressure, the liquid at rest.

The partial pressure of the vapour, and with it a small difference of humidity h, diffuses:
    R dh/dt = D tau d2h/dy2,    tau = n^(1/3) (1 - S)^(7/3)    (Millington & Quirk 1961)
    R = 1 + (1 - x) rho_l (dS/drho_v) / (1 - S)
R is what condenses as it grows moister (Kelvin), over the vapour itself; x is the mole fraction of vapour: what evaporates flows off with the gas, as
air has nowhere to go (Stefan). Without liquid R is 1 and the difference may be of any size: as many moles of air come as of vapour go.
"""

import dataclasses

import numpy

TERMS = 400
GAS_CONSTANT = 8.314462618  # J/(mol K)


@dataclasses.dataclass
class Column:
    """The defaults: 20 degrees."""

    diffusivity: float  # m2/s, in air
    height: float = 0.1  # m
    porosity: float = 0.4
    alpha: float = 1e-3  # 1/Pa, van Genuchten
    exponent: float = 4  # N
    temperature: float = 293.15  # K
    saturated_pressure: float = 2339.0  # Pa
    liquid_density: float = 1000.0  # kg/m3
    water_molar: float = 0.018015  # kg/mol
    atmosphere: float = 101325.0  # Pa

    def suction(self, humidity):
        return -numpy.log(humidity) * self.liquid_density * GAS_CONSTANT * self.temperature / self.water_molar

    def saturation(self, humidity):
        return (1 + (self.alpha * self.suction(humidity)) ** self.exponent) ** (1 / self.exponent - 1)

    def retardation(self, humidity):
        """R."""
        step = 1e-5 * humidity
        density = self.saturated_pressure * self.water_molar / (GAS_CONSTANT * self.temperature)
        slope = (self.saturation(humidity + step) - self.saturation(humidity - step)) / (2 * step * density)
        mole_fraction = humidity * self.saturated_pressure / self.atmosphere
        return 1 + (1 - mole_fraction) * self.liquid_density * slope / (1 - self.saturation(humidity))

    def humidity(self, lower, upper, retardation, y, time):
        """At places y (array, m) above the base; the halves start at `lower` and `upper`."""
        mean = (lower + upper) / 2
        tortuosity = self.porosity ** (1 / 3) * (1 - self.saturation(mean)) ** (7 / 3)
        order = numpy.arange(1, TERMS)
        number = numpy.pi * order / self.height
        share = 2 * numpy.sin(numpy.pi * order / 2) / (numpy.pi * order)
        decay = numpy.exp(-self.diffusivity * tortuosity / retardation * number**2 * time)
        return mean + (lower - upper) * numpy.cos(numpy.outer(y, number)) @ (share * decay)
