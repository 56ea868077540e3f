"""Reference of the scene `column_three_phase`: rain on a rigid column whose air can only leave through the wet surface.

One dimension, water and ideal gas, immiscible and isothermal; unknowns p_l and p_g (gauge, Pa) at the nodes of a uniform mesh.
  water  d/dt [n S (1 + p_l/K_l)]        = d/dy [(kappa k_rl/mu_l) (dp_l/dy + rho_l g)]
  gas    d/dt [n (1 - S) (1 + p_g/p_atm)] = d/dy [(1 + p_g/p_atm) (kappa k_rg/mu_g) (dp_g/dy + rho_g g)]
S of the suction p_g - p_l (van Genuchten), k_rl Mualem, k_rg = (1-S)^(1/2) (1-S^(1/m))^(2m) (Parker, Lenhard & Kuppusamy 1987).
Base closed to both. Top: p_g = 0; inflow of water <= rain, p_l <= 0, one of them as an equality; what is refused runs off.
Vertex-centred finite volumes; k_r of an element is its mean over the element's suctions; SDIRK2, step doubling, damped Newton.
Usage: column_three_phase.py [--error | --check | --long]
  --error  the same on coarser meshes and with a looser step, and the differences
  --check  with air a million times thinner and without weight p_l is that of `column.csv`; exits 1 when it is not
  --long   up to two hours: does the column fill?
"""
import pathlib
import sys
import numpy as np
from scipy.linalg import solve_banded
import soil

RAIN = 1e-4  # m/s
CELLS = 1600
TIMES = (20.0, 80.0, 160.0, 320.0, 600.0)
INITIAL_SUCTION = 37975.0  # Pa: S = 0.85
WEIGHT = soil.WATER_DENSITY * soil.GRAVITY  # Pa/m
WATER_VISCOSITY, AIR_VISCOSITY = 1e-3, 1.8e-5  # Pa s
ATMOSPHERE = 101325.0  # Pa, absolute
AIR_WEIGHT = ATMOSPHERE * 0.02896 / (8.314 * 293.15) * soil.GRAVITY  # Pa/m at p_g = 0 and 20 degrees
INTRINSIC = soil.CONDUCTIVITY * WATER_VISCOSITY / WEIGHT  # m2
LEAST_GAS = 1e-9  # of k_rg: gives p_g an equation where no gas is left; 4e-12 m of air in 600 s at 1 kPa/m
GAMMA = 1 - 1 / np.sqrt(2)
SMALL = 3e-11  # m/s, of both balances: 3e-7 of the rain


def gas_permeability(pressure):
    """k_rg at p_l - p_g = pressure, without cancellation near saturation."""
    a = (soil.ALPHA * np.maximum(-pressure, 0.0)) ** soil.EXPONENT_N
    gas = -np.expm1(-soil.EXPONENT_M * np.log1p(a))  # 1 - S
    return LEAST_GAS + np.sqrt(gas) * (a / (1 + a)) ** (2 * soil.EXPONENT_M)


class GasPotential(soil.Potential):
    """Integral of k_rg: above saturation the least k_rg goes on."""

    def __init__(self):
        super().__init__(gas_permeability)

    def __call__(self, pressure):
        return np.where(pressure >= 0, LEAST_GAS * pressure, super().__call__(np.minimum(pressure, -1e-300)))


class Column:
    """Masses and fluxes of both fluids; y up, node 0 at the base; a state is an array (node, [p_l, p_g])."""

    def __init__(self, cells, air_viscosity=AIR_VISCOSITY, air_weight=AIR_WEIGHT, rain=RAIN, height=1.0):
        self.spacing = height / cells
        self.rain, self.air_weight = rain, air_weight
        self.y = np.linspace(0, height, cells + 1)
        self.volume = np.full(cells + 1, self.spacing)
        self.volume[[0, -1]] *= 0.5
        self.water, self.gas = soil.Potential(), GasPotential()
        self.mobility = np.array([INTRINSIC / WATER_VISCOSITY, INTRINSIC / air_viscosity])
        self.start = np.tile([-INITIAL_SUCTION, 0.0], (cells + 1, 1))

    def saturation(self, x):
        return soil.saturation(x[:, 0] - x[:, 1])

    def mass(self, x):
        """Water over rho_l0 and gas over rho_g(p_atm), both in m, of each node."""
        s = self.saturation(x)
        pore = soil.POROSITY * self.volume
        return np.stack([pore * s * (1 + x[:, 0] / soil.WATER_STIFFNESS), pore * (1 - s) * (1 + x[:, 1] / ATMOSPHERE)], axis=1)

    def mass_slope(self, x):
        """d mass[i, a] / d x[i, b]."""
        s, slope = self.saturation(x), soil.saturation_slope(x[:, 0] - x[:, 1])
        pore = soil.POROSITY * self.volume
        water, gas = 1 + x[:, 0] / soil.WATER_STIFFNESS, 1 + x[:, 1] / ATMOSPHERE
        block = np.empty((len(s), 2, 2))
        block[:, 0, 0] = pore * (slope * water + s / soil.WATER_STIFFNESS)
        block[:, 0, 1] = -pore * slope * water
        block[:, 1, 0] = -pore * slope * gas
        block[:, 1, 1] = pore * (slope * gas + (1 - s) / ATMOSPHERE)
        return block

    def water_flux(self, x):
        """Downwards through each element, m/s, and its slopes (element, [low, high], [p_l, p_g])."""
        capillary = x[:, 0] - x[:, 1]
        mean, by_low, by_high = self.water.mean(capillary[:-1], capillary[1:])
        gradient = np.diff(x[:, 0]) / self.spacing + WEIGHT
        slope = np.empty((len(mean), 2, 2))
        slope[:, 0, 0] = by_low * gradient - mean / self.spacing
        slope[:, 1, 0] = by_high * gradient + mean / self.spacing
        slope[:, 0, 1] = -by_low * gradient
        slope[:, 1, 1] = -by_high * gradient
        return self.mobility[0] * mean * gradient, self.mobility[0] * slope

    def gas_flux(self, x):
        """The same of the gas, as a volume at p_atm."""
        capillary = x[:, 0] - x[:, 1]
        mean, by_low, by_high = self.gas.mean(capillary[:-1], capillary[1:])
        density = 1 + 0.5 * (x[:-1, 1] + x[1:, 1]) / ATMOSPHERE
        gradient = np.diff(x[:, 1]) / self.spacing + self.air_weight * density
        drive = density * gradient
        by_both = (0.5 / ATMOSPHERE) * (gradient + self.air_weight * density)
        slope = np.empty((len(mean), 2, 2))
        slope[:, 0, 0] = by_low * drive
        slope[:, 1, 0] = by_high * drive
        slope[:, 0, 1] = -by_low * drive + mean * (by_both - density / self.spacing)
        slope[:, 1, 1] = -by_high * drive + mean * (by_both + density / self.spacing)
        return self.mobility[1] * mean * drive, self.mobility[1] * slope

    def inflow(self, x):
        """Net inflow (node, fluid) without the rain; blocks of its derivative below, on and above the diagonal."""
        net = np.zeros_like(x)
        diagonal = np.zeros((len(x), 2, 2))
        lower, upper = np.zeros((len(x) - 1, 2, 2)), np.zeros((len(x) - 1, 2, 2))
        for fluid, flux in enumerate((self.water_flux, self.gas_flux)):
            down, slope = flux(x)
            net[:-1, fluid] += down
            net[1:, fluid] -= down
            diagonal[:-1, fluid] += slope[:, 0]
            diagonal[1:, fluid] -= slope[:, 1]
            upper[:, fluid] = slope[:, 1]
            lower[:, fluid] = -slope[:, 0]
        return net, lower, diagonal, upper

    def residual(self, x, old_mass, step):
        """Of both balances with the surface's conditions in the top node, and the blocks of its derivative."""
        net, lower, diagonal, upper = self.inflow(x)
        value = (self.mass(x) - old_mass) / step - net
        diagonal = self.mass_slope(x) / step - diagonal
        lower, upper = -lower, -upper
        scale = self.mobility[0] / self.spacing
        refused = self.rain - value[-1, 0]
        value[-1, 0] = -refused
        if refused > -scale * x[-1, 0]:
            value[-1, 0] = scale * x[-1, 0]
            diagonal[-1, 0], lower[-1, 0] = (scale, 0.0), 0.0
        value[-1, 1] = scale * x[-1, 1]
        diagonal[-1, 1], lower[-1, 1] = (0.0, scale), 0.0
        return value, lower, diagonal, upper

    def solve(self, start, old_mass, step):
        """x with mass(x) = old_mass + step * inflow(x); None when Newton fails."""
        x = start.copy()
        value, *blocks = self.residual(x, old_mass, step)
        norm = np.linalg.norm(value)
        for _ in range(40):
            change = solve_banded((3, 3), banded(*blocks), -value.ravel()).reshape(x.shape)
            damping = 1.0
            while damping > 1e-3:
                trial = x + damping * change
                value, *blocks = self.residual(trial, old_mass, step)
                new_norm = np.linalg.norm(value)
                if new_norm < (1 - 1e-4 * damping) * norm or new_norm < SMALL:
                    break
                damping *= 0.5
            if damping <= 1e-3:
                return None
            x, norm = trial, new_norm
            if norm < SMALL:
                return x
        return None

    def advance(self, x, step):
        """One SDIRK2 step; None when a stage fails."""
        mass = self.mass(x)
        first = self.solve(x, mass, GAMMA * step)
        if first is None:
            return None
        rate = (self.mass(first) - mass) / (GAMMA * step)
        return self.solve(first, mass + (1 - GAMMA) * step * rate, GAMMA * step)


def banded(lower, diagonal, upper):
    """Banded storage, three diagonals either side, of a block tridiagonal matrix with blocks of two."""
    band = np.zeros((7, 2 * len(diagonal)))
    for row in range(2):
        for column in range(2):
            band[3 + row - column, column::2] = diagonal[:, row, column]
            band[5 + row - column, column:-2:2] = lower[:, row, column]
            band[1 + row - column, 2 + column::2] = upper[:, row, column]
    return band


def step_error(column, fine, whole):
    """Of a step: rms of S, and of p_g over a tenth of the atmosphere where there is gas."""
    saturation = column.saturation(fine) - column.saturation(whole)
    gas = (fine[:, 1] - whole[:, 1]) * (column.saturation(fine) < 1 - 1e-6) / (0.1 * ATMOSPHERE)
    return np.sqrt(np.mean(saturation ** 2 + gas ** 2)) / 3


def simulate(column, times, tolerance, first_step=1e-4, largest_step=5.0):
    """States at `times`; local error below `tolerance` a step."""
    x, time, step, answers, steps, rejected = column.start, 0.0, first_step, [], 0, 0
    for target in times:
        while time < target - 1e-9:
            trial = min(step, target - time, largest_step)
            whole = column.advance(x, trial)
            half = column.advance(x, 0.5 * trial) if whole is not None else None
            fine = column.advance(half, 0.5 * trial) if half is not None else None
            if fine is None:
                step, rejected = 0.25 * trial, rejected + 1
                if step < 1e-8:
                    raise RuntimeError(f"step collapsed at {time} s")
                continue
            error = step_error(column, fine, whole)
            factor = 0.9 * (tolerance / max(error, 1e-15)) ** (1 / 3)
            if error > tolerance and trial > 1e-6:
                step, rejected = trial * max(factor, 0.2), rejected + 1
                continue
            x, time, steps = fine, time + trial, steps + 1
            step = trial * min(max(factor, 0.3), 2.0) if trial >= step else step
        answers.append(x.copy())
    print(f"  {column.y.size - 1} cells, tolerance {tolerance}: {steps} steps, {rejected} rejected", flush=True)
    return answers


def balance(column, x):
    """Infiltrated water and escaped air since the start, mm; the air as a volume at p_atm."""
    change = column.mass(x).sum(axis=0) - column.mass(column.start).sum(axis=0)
    return 1e3 * change[0], -1e3 * change[1]


def write(name, column, answers):
    y = np.concatenate([np.arange(392) * 0.0025, 0.98 + np.arange(33) * 0.000625])  # finer where p_g goes with the root of depth
    with open(name, "w") as file:
        file.write("time_s,y_m,water_pressure_Pa,gas_pressure_Pa,saturation,infiltrated_m,air_escaped_m\n")
        for time, x in zip(TIMES, answers):
            water, gas = (np.interp(y, column.y, x[:, fluid]) for fluid in (0, 1))
            infiltrated, escaped = 1e-3 * np.array(balance(column, x))
            for row in zip(y, water, gas, soil.saturation(water - gas)):
                file.write(f"{time:.0f},{row[0]:.6f},{row[1]:.3f},{row[2]:.3f},{row[3]:.7f},{infiltrated:.8f},{escaped:.8f}\n")


def differences(coarse, fine):
    """(time, largest and mean |difference| of p_l, p_g, S) on the nodes of the coarser mesh."""
    (column_a, answers_a), (column_b, answers_b) = coarse, fine
    stride = (column_b.y.size - 1) // (column_a.y.size - 1)
    for time, a, b in zip(TIMES, answers_a, answers_b):
        b = b[::stride]
        change = np.abs(np.column_stack([a - b, column_a.saturation(a) - column_b.saturation(b)]))
        yield time, change.max(axis=0), change.mean(axis=0)


def compare(label, coarse, fine):
    for time, most, mean in differences(coarse, fine):
        print(f"  {label} t={time:.0f}: p_l max {most[0]:.2f} mean {mean[0]:.3f} Pa; p_g max {most[1]:.3f} mean {mean[1]:.3f} Pa; "
              f"S max {most[2]:.1e} mean {mean[2]:.1e}")


def run(cells, tolerance):
    column = Column(cells)
    return column, simulate(column, TIMES, tolerance)


def check():
    """Whether thin, weightless air gives the reference with passive gas at 20 and 80 s, before the surface is wet through."""
    column = Column(400, air_viscosity=1e-6 * AIR_VISCOSITY, air_weight=0.0)
    table = np.loadtxt(pathlib.Path(__file__).parent / "column.csv", delimiter=",", skiprows=1)
    worst = 0.0
    for time, x in zip(TIMES[:2], simulate(column, TIMES[:2], 2e-6)):
        worst = max(worst, np.max(np.abs(x[:, 0] - table[table[:, 0] == time, 2])))
    print(f"  passive limit: p_l differs by {worst:.2f} Pa at most")
    return worst < 20.0


def long():
    column = Column(100)
    times = (600.0, 900.0, 1200.0, 1300.0, 1400.0, 1500.0, 1600.0, 1800.0, 7200.0)
    for time, x in zip(times, simulate(column, times, 1e-5, largest_step=60.0)):
        infiltrated, escaped = balance(column, x)
        print(f"  t={time:.0f}: infiltrated {infiltrated:.3f} of 60 mm, air escaped {escaped:.3f} mm, "
              f"least S {column.saturation(x).min():.5f}, at the base p_g {x[0, 1]:.0f} Pa, p_l {x[0, 0]:.0f} Pa")


def main():
    if "--check" in sys.argv:
        sys.exit(0 if check() else 1)
    if "--long" in sys.argv:
        return long()
    fine = run(CELLS, 2e-6)
    write("column_three_phase.csv", *fine)
    for time, x in zip(TIMES, fine[1]):
        infiltrated, escaped = balance(fine[0], x)
        print(f"  t={time:.0f}: infiltrated {infiltrated:.4f} of {1e3 * RAIN * time:.0f} mm, air escaped {escaped:.4f} mm")
    if "--error" in sys.argv:
        for cells in (100, 200, 400, 800):
            compare(f"mesh {cells} to {CELLS}", run(cells, 2e-6), fine)
        compare("step", run(CELLS, 2e-5), fine)


if __name__ == "__main__":
    main()
