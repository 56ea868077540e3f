"""Closed isothermal box of rigid soil with water, vapour, air and dissolved air: where it comes to rest.

Masses as in docs/theory.md: water n (S_l rho_l omega_w + S_g rho_v), air n (S_g rho_a + S_l rho_d), with
  rho_l = rho_0 exp(p_l / K_l) of the whole liquid, omega_w = 1 - rho_d / rho_l
  Kelvin: rho_v = rho_sat exp(-s M_w / (rho_l R T)), s = p_g - p_l of the retention curve
  Henry:  rho_d = M_a H p_a, p_a the air's partial pressure, H in mol/(m3 Pa)
  ideal gases: p_atm + p_g = R T (rho_v / M_w + rho_a / M_a)
Vapour and dissolved air may start at any densities; equilibrium conserves both masses.
"""

import dataclasses

import numpy
from scipy.optimize import brentq

GAS_CONSTANT = 8.314462618  # J/(mol K)


@dataclasses.dataclass
class Box:
    """Material; the defaults are air and water at 20 degrees and the paper's soil."""

    porosity: float = 0.4
    alpha: float = 4e-5  # 1/Pa, van Genuchten
    exponent: float = 1.2  # N
    temperature: float = 293.15  # K
    liquid_density: float = 1000.0  # kg/m3, rho_0
    liquid_bulk: float = 2e9  # Pa
    saturated_vapour: float = 0.01729  # kg/m3, rho_sat: 2339 Pa at 20 degrees
    henry: float = 7.8e-6  # mol/(m3 Pa)
    water_molar: float = 0.018015  # kg/mol
    air_molar: float = 0.02896  # kg/mol
    atmosphere: float = 101325.0  # Pa, absolute

    @property
    def thermal(self):
        """R T, J/mol."""
        return GAS_CONSTANT * self.temperature

    def suction(self, saturation):
        """Pa, S_r = 0."""
        m = 1 - 1 / self.exponent
        return numpy.expm1(-numpy.log(saturation) / m) ** (1 / self.exponent) / self.alpha

    def density(self, liquid_pressure):
        """Of the liquid, kg/m3; gauge Pa."""
        return self.liquid_density * numpy.exp(liquid_pressure / self.liquid_bulk)


@dataclasses.dataclass
class State:
    saturation: float
    gas_pressure: float  # Pa, gauge
    vapour: float  # kg per m3 of gas
    dissolved: float  # kg of air per m3 of liquid


def liquid_pressure(box, state):
    """Pa, gauge."""
    return state.gas_pressure - box.suction(state.saturation)


def air_density(box, state):
    """kg per m3 of gas."""
    return box.air_molar * ((box.atmosphere + state.gas_pressure) / box.thermal - state.vapour / box.water_molar)


def masses(box, state):
    """Water and air, kg per m3 of ground."""
    liquid = box.density(liquid_pressure(box, state))
    wet, dry = box.porosity * state.saturation, box.porosity * (1 - state.saturation)
    return wet * (liquid - state.dissolved) + dry * state.vapour, wet * state.dissolved + dry * air_density(box, state)


def at_equilibrium(box, saturation, gas_pressure):
    """The state of Kelvin and Henry at a saturation and a gas pressure (gauge, Pa)."""
    suction = box.suction(saturation)
    liquid = box.density(gas_pressure - suction)
    vapour = box.saturated_vapour * numpy.exp(-suction * box.water_molar / (liquid * box.thermal))
    air_pressure = box.atmosphere + gas_pressure - vapour * box.thermal / box.water_molar
    return State(saturation, gas_pressure, vapour, box.air_molar * box.henry * air_pressure)


def equilibrium(box, *parts):
    """Where a box of equal parts comes to rest; masses kept to 1e-13 of each."""
    water, air = numpy.mean([masses(box, part) for part in parts], axis=0)
    start = numpy.mean([part.saturation for part in parts])

    def pressure(saturation):
        return brentq(lambda p: masses(box, at_equilibrium(box, saturation, p))[1] - air, -box.atmosphere, 1e8, xtol=1e-10, rtol=1e-15)

    def surplus(saturation):
        return masses(box, at_equilibrium(box, saturation, pressure(saturation)))[0] - water

    low, high = start * 0.9, min(start * 1.1, 1 - 1e-9)
    saturation = brentq(surplus, low, high, xtol=1e-16, rtol=1e-15)
    return at_equilibrium(box, saturation, pressure(saturation))


def example():
    """Dry gas at the atmosphere's pressure over water without air, in the paper's initial state."""
    return Box(), State(saturation=0.85, gas_pressure=0.0, vapour=0.0, dissolved=0.0)
