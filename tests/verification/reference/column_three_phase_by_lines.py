"""Second opinion on column_three_phase.py: the method of lines in p_l and p_g, cell-centred, by LSODA.

The rates of both pressures come from the two balances of a cell; k_r is the arithmetic mean of neighbours without any chord. At the
surface water enters at the lesser of the rain and what p_l = 0 there draws in; once it is the latter the surface's suction is 0.
It has no saturated zones: valid as long as air is left in every cell. Masses are kept within the tolerance only.
Usage: column_three_phase_by_lines.py ; prints the largest differences from column_three_phase.csv, exits 1 when above 15 Pa
on 400 cells.
"""
import pathlib
import sys
import numpy as np
from scipy.integrate import solve_ivp

POROSITY, CONDUCTIVITY, RAIN, START = 0.4, 1e-4, 1e-4, -37975.0
ALPHA, N, L = 4e-5, 1.2, 0.5
M = 1 - 1 / N
WEIGHT, STIFFNESS, ATMOSPHERE = 9810.0, 2e9, 101325.0
AIR_WEIGHT = 1.2040 * 9.81
WATER = CONDUCTIVITY / WEIGHT  # m2/(Pa s)
AIR = WATER * 1e-3 / 1.8e-5
GAUSS, SHARE = np.polynomial.legendre.leggauss(16)
GAUSS, SHARE = 0.5 * (GAUSS + 1), 0.5 * SHARE


def saturation(suction):
    return (1 + (ALPHA * suction) ** N) ** -M


def capacity(suction):
    """dS/ds."""
    return -M * N * ALPHA * (ALPHA * suction) ** (N - 1) * (1 + (ALPHA * suction) ** N) ** (-M - 1)


def water_mobility(suction):
    s = saturation(suction)
    return WATER * s ** L * (1 - (1 - s ** (1 / M)) ** M) ** 2


def air_mobility(suction):
    s = saturation(suction)
    return AIR * np.sqrt(1 - s) * (1 - s ** (1 / M)) ** (2 * M)


def mean_from_saturation(mobility, suction):
    """Between 0 and a suction; the substitution takes the infinite slope away."""
    return SHARE @ (4 * GAUSS ** 3 * mobility(suction * GAUSS ** 4))


def surface(p_water, p_gas, suction, half):
    """Inflow of water and of gas (at P_atm) through half a cell to p_g = 0, m/s."""
    draw = mean_from_saturation(water_mobility, suction[-1]) * (WEIGHT - p_water[-1] / half)
    above = max(1.5 * suction[-1] - 0.5 * suction[-2], 0.0)
    mobility = 0.5 * (air_mobility(suction[-1]) + air_mobility(above))
    if draw < RAIN:
        mobility = mean_from_saturation(air_mobility, suction[-1])
    density = 1 + 0.5 * p_gas[-1] / ATMOSPHERE
    return min(draw, RAIN), density * mobility * (AIR_WEIGHT * density - p_gas[-1] / half)


def rate(pressures, spacing):
    p_water, p_gas = pressures[0::2], pressures[1::2]
    suction = np.maximum(p_gas - p_water, 1e-3)
    water, air = water_mobility(suction), air_mobility(suction)
    dense = 1 + p_gas / ATMOSPHERE
    between = 0.5 * (dense[1:] + dense[:-1])
    down = 0.5 * (water[1:] + water[:-1]) * (np.diff(p_water) / spacing + WEIGHT)
    gas_down = between * 0.5 * (air[1:] + air[:-1]) * (np.diff(p_gas) / spacing + AIR_WEIGHT * between)
    inflow, gas_inflow = surface(p_water, p_gas, suction, 0.5 * spacing)
    gain = np.diff(np.concatenate([[0.0], down, [inflow]])) / (POROSITY * spacing)
    gas_gain = np.diff(np.concatenate([[0.0], gas_down, [gas_inflow]])) / (POROSITY * spacing)
    return pressure_rates(suction, 1 + p_water / STIFFNESS, dense, gain, gas_gain)


def pressure_rates(suction, water_dense, dense, gain, gas_gain):
    """From the rates of S (1 + p_l/K_l) and (1 - S) (1 + p_g/P_atm): two by two in each cell."""
    wet, slope = saturation(suction), capacity(suction)
    a, b = wet / STIFFNESS - slope * water_dense, slope * water_dense
    c, d = slope * dense, (1 - wet) / ATMOSPHERE - slope * dense
    determinant = a * d - b * c
    rates = np.empty(2 * len(wet))
    rates[0::2] = (d * gain - b * gas_gain) / determinant
    rates[1::2] = (a * gas_gain - c * gain) / determinant
    return rates


def simulate(cells, times):
    """(heights of centres, states [p_l, p_g] at times)."""
    spacing = 1.0 / cells
    start = np.tile([START, 0.0], cells)
    run = solve_ivp(lambda time, x: rate(x, spacing), (0, times[-1]), start, "LSODA", times, lband=3, uband=3, rtol=1e-7, atol=1e-3)
    if not run.success:
        raise RuntimeError(run.message)
    return (np.arange(cells) + 0.5) * spacing, [x.reshape(-1, 2) for x in run.y.T]


def main():
    table = np.loadtxt(pathlib.Path(__file__).parent / "column_three_phase.csv", delimiter=",", skiprows=1)
    times = np.unique(table[:, 0])
    for cells in (100, 200, 400):
        y, states = simulate(cells, times)
        worst = 0.0
        for time, x in zip(times, states):
            now = table[table[:, 0] == time]
            change = [np.max(np.abs(x[:, fluid] - np.interp(y, now[:, 1], now[:, 2 + fluid]))) for fluid in (0, 1)]
            worst = max(worst, *change)
            print(f"  {cells} cells, t={time:.0f}: p_l differs by {change[0]:.2f}, p_g by {change[1]:.2f} Pa at most")
    sys.exit(0 if worst < 15.0 else 1)


if __name__ == "__main__":
    main()
