"""Plane waves in saturated and unsaturated ground: speeds and attenuation from the momentum and mass balances of docs/theory.md.

Small displacements u_s, u_l, u_g (partial momenta: each fluid's equation times its share n S; no added mass, no gravity):

    n_l rho_l u_l'' = -n_l grad p_l - b_l (u_l - u_s)'        b_l = n_l^2 mu_l / kappa_l,  n_l = n S_l; the gas alike
    n_s rho_s u_s'' = div sigma' - grad p - (the fluids' -n_l grad p_l - n_g grad p_g) + drag,  total stress sigma' - p
    n S_l/K_l p_l' + n S_l' = -e_l',   n S_g/K_g p_g' - n S_l' = -e_g',   e_l = S_l div(n_s u_s + n u_l)

(' by time) with incompressible grains. p is p_l where saturated, chi p_l + (1 - chi) p_g else; S_l' = C (p_l - p_g)', C = -dS/ds. A
wave exp(i (k x - omega t)) then solves k^2 K u = (omega^2 R + i omega B) u with R the partial densities, B the drag, K the
stiffness: a quadratic in k^2 for two phases (Biot 1956), a cubic for three (as Brutsaert 1964; Lo, Sposito & Majer 2005).
"""

import dataclasses

import numpy
from scipy.linalg import eig


@dataclasses.dataclass
class Wave:
    speed: float  # m/s: omega / Re k
    attenuation: float  # 1/m: Im k, the amplitude falls by exp(-attenuation x)
    motion: numpy.ndarray  # displacements of solid, liquid (and gas), largest 1


@dataclasses.dataclass
class Saturated:
    """Two phases; the defaults are a sand."""

    young: float = 20e6  # Pa, of the drained skeleton
    poisson: float = 0.3
    porosity: float = 0.4
    solid_density: float = 2650.0  # kg/m3, of the grains
    liquid_density: float = 1000.0  # kg/m3
    liquid_bulk: float = 2e9  # Pa, K_l
    mobility: float = 1e-4 / 9810  # m2/(Pa s): kappa / mu_l = conductivity / gamma_w; infinite for no drag

    @property
    def modulus(self):
        """Pa, of uniaxial strain."""
        return self.young * (1 - self.poisson) / ((1 + self.poisson) * (1 - 2 * self.poisson))

    @property
    def shear(self):
        return self.young / (2 * (1 + self.poisson))

    @property
    def density(self):
        return self.partial_density().sum()

    def partial_density(self):
        return numpy.array([(1 - self.porosity) * self.solid_density, self.porosity * self.liquid_density])

    def stiffness(self):
        """K: skeleton, and both phases' squeeze of the water. Pa."""
        share = numpy.array([1 - self.porosity, self.porosity])
        stiffness = self.liquid_bulk / self.porosity * numpy.outer(share, share)
        stiffness[0, 0] += self.modulus
        return stiffness

    def drag(self):
        """B, Pa s/m2."""
        return self.porosity**2 / self.mobility * numpy.array([[1.0, -1.0], [-1.0, 1.0]])

    def undrained_speed(self):
        """m/s: fast wave where the drag lets nothing slip (low frequency)."""
        return numpy.sqrt((self.modulus + self.liquid_bulk / self.porosity) / self.density)

    def undragged_speeds(self):
        """m/s, fast and slow without drag (high frequency)."""
        return _speeds(self.stiffness(), self.partial_density())

    def slow_diffusivity(self):
        """m2/s, of the pressure: what the slow wave is at low frequency; consolidation with compressible water."""
        water = self.liquid_bulk / self.porosity
        return self.mobility * water * self.modulus / (water + self.modulus)


@dataclasses.dataclass
class Unsaturated:
    """Three phases; the defaults are the same sand with 0.8 of its pores wet."""

    young: float = 20e6
    poisson: float = 0.3
    porosity: float = 0.4
    solid_density: float = 2650.0
    liquid_density: float = 1000.0
    gas_density: float = 1.2
    liquid_bulk: float = 2e9
    gas_bulk: float = 101325.0  # Pa, absolute gas pressure: isothermal ideal gas
    saturation: float = 0.8
    capacity: float = 2e-6  # 1/Pa, C = -dS/ds
    bishop: float = 0.8  # chi; 0 is net stress
    liquid_mobility: float = 1e-5 / 9810  # m2/(Pa s): kappa k_rl / mu_l
    gas_mobility: float = 1e-5 / 9810  # m2/(Pa s): kappa k_rg / mu_g

    modulus, shear, density = Saturated.modulus, Saturated.shear, Saturated.density

    def fluid_share(self):
        """n_l and n_g."""
        return self.porosity * numpy.array([self.saturation, 1 - self.saturation])

    def partial_density(self):
        liquid, gas = self.fluid_share()
        return numpy.array([(1 - self.porosity) * self.solid_density, liquid * self.liquid_density, gas * self.gas_density])

    def squeeze(self):
        """e_l and e_g of unit strains of solid, liquid, gas: (fluid, phase)."""
        wet = numpy.array([self.saturation, 1 - self.saturation])
        return numpy.column_stack([(1 - self.porosity) * wet, numpy.diag(self.fluid_share())])

    def pressure(self):
        """p_l and p_g of unit strains of the phases, Pa: (fluid, phase)."""
        exchange = self.porosity * self.capacity * numpy.array([[1.0, -1.0], [-1.0, 1.0]])
        storage = numpy.diag(self.fluid_share() / numpy.array([self.liquid_bulk, self.gas_bulk])) + exchange
        return -numpy.linalg.solve(storage, self.squeeze())

    def stiffness(self):
        pressure = self.pressure()
        on_fluids = self.fluid_share()
        on_solid = numpy.array([self.bishop, 1 - self.bishop]) - on_fluids
        stiffness = -numpy.vstack([on_solid @ pressure, on_fluids[:, None] * pressure])
        stiffness[0, 0] += self.modulus
        return stiffness

    def drag(self):
        liquid, gas = self.fluid_share() ** 2 / numpy.array([self.liquid_mobility, self.gas_mobility])
        return numpy.array([[liquid + gas, -liquid, -gas], [-liquid, liquid, 0.0], [-gas, 0.0, gas]])

    def undrained_speed(self):
        """m/s: where nothing slips."""
        return numpy.sqrt(self.stiffness().sum() / self.density)

    def undragged_speeds(self):
        """m/s, from fast to slow, without drag."""
        return _speeds(self.stiffness(), self.partial_density())


def compressional(ground, frequency):
    """Waves at a real angular frequency (rad/s), fastest first."""
    inertia = frequency**2 * numpy.diag(ground.partial_density()) + 1j * frequency * ground.drag()
    squares, motions = eig(inertia, ground.stiffness())
    waves = [_wave(square, motion, frequency) for square, motion in zip(squares, motions.T)]
    return sorted(waves, key=lambda wave: -wave.speed)


def shear(ground, frequency):
    """The one shear wave: the skeleton's stiffness, fluids taken along by drag."""
    inertia = frequency**2 * numpy.diag(ground.partial_density()) + 1j * frequency * ground.drag()
    fluids = numpy.linalg.solve(inertia[1:, 1:], -inertia[1:, 0])
    square = (inertia[0, 0] + inertia[0, 1:] @ fluids) / ground.shear
    return _wave(square, numpy.concatenate([[1.0], fluids]), frequency)


def frequencies(ground, wave_number):
    """Complex omega (rad/s) of standing waves with a real wave number (1/m), decaying as exp(Im omega t); slowest decay first."""
    size = len(ground.partial_density())
    inverse = numpy.diag(1 / ground.partial_density())
    motion = numpy.block([[numpy.zeros((size, size)), numpy.eye(size)],
                          [-(wave_number**2) * inverse @ ground.stiffness(), -inverse @ ground.drag()]])
    return sorted(1j * numpy.linalg.eigvals(motion), key=lambda omega: (-round(omega.imag, 6), -omega.real))


def _wave(square, motion, frequency):
    wave_number = numpy.sqrt(complex(square))  # the root with Re k > 0: Im k > 0 too, since drag takes energy
    return Wave(frequency / wave_number.real, wave_number.imag, motion / motion[numpy.argmax(abs(motion))])


def _speeds(stiffness, density):
    squares = numpy.linalg.eigvals(stiffness / density[:, None])
    return numpy.sort(numpy.sqrt(squares.real))[::-1]
