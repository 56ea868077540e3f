"""Reference of the scenes `column` and `column_constant_k`: one dimension, rigid skeleton.

Vertex-centred finite volumes (linear elements with lumped mass) on a uniform mesh; k_r of an element is its mean over
the element's pressures (Kirchhoff), second order; SDIRK2 (L-stable, stiffly accurate) on the water mass, step chosen by
step doubling; damped Newton. The surface is a complementarity: inflow <= rain, p <= 0.
Usage: column.py [--error] ; --error repeats with half the cells and a ten times looser step and prints the differences.
"""
import sys
import numpy as np
from scipy.linalg import solve_banded
import soil

RAIN = 1e-4
TIMES = (20.0, 80.0, 160.0, 320.0, 600.0)
FILLED = 600.5  # s: the row of 600 s is the state once the last pore is filled, at 600.07 s (water is compressible)
INITIAL_SUCTION = 37975.0
WEIGHT = soil.WATER_DENSITY * soil.GRAVITY
GAMMA = 1 - 1 / np.sqrt(2)
SMALL = 3e-11  # m/s, of the flow balance: 3e-7 of the rain


class Column:
    """State and residual of a column of `cells` elements; y up, node 0 at the impermeable base."""

    def __init__(self, cells, potential, height=1.0, initial_pressure=-INITIAL_SUCTION, rain=RAIN):
        self.spacing = height / cells
        self.potential = potential
        self.rain = rain
        self.y = np.linspace(0, height, cells + 1)
        self.volume = np.full(cells + 1, self.spacing)
        self.volume[[0, -1]] *= 0.5
        self.pressure = np.full(cells + 1, initial_pressure)

    def mass(self, p):
        """Water in each nodal volume (m); compressibility as n S exp(p/K_l), linearised."""
        return self.volume * soil.POROSITY * soil.saturation(p) * (1 + p / soil.WATER_STIFFNESS)

    def mass_slope(self, p):
        return self.volume * soil.POROSITY * (soil.saturation_slope(p) * (1 + p / soil.WATER_STIFFNESS)
                                              + soil.saturation(p) / soil.WATER_STIFFNESS)

    def divergence(self, p):
        """Net inflow of each node without the rain, and its tridiagonal derivative (banded storage)."""
        mean, by_low, by_high = self.potential.mean(p[:-1], p[1:])
        gradient = (p[1:] - p[:-1]) / (WEIGHT * self.spacing) + 1
        down = soil.CONDUCTIVITY * mean * gradient
        d_low = soil.CONDUCTIVITY * (by_low * gradient - mean / (WEIGHT * self.spacing))
        d_high = soil.CONDUCTIVITY * (by_high * gradient + mean / (WEIGHT * self.spacing))
        net = np.zeros_like(p)
        net[:-1] += down
        net[1:] -= down
        band = np.zeros((3, p.size))
        band[1, :-1] += d_low
        band[1, 1:] -= d_high
        band[0, 1:] = d_high
        band[2, :-1] = -d_low
        return net, band

    def solve(self, start, old_mass, step):
        """p with mass(p) = old_mass + step * inflow(p); None when Newton fails."""
        p = start.copy()
        scale = 1.0 / (WEIGHT * self.spacing) * soil.CONDUCTIVITY

        def residual(p):
            net, band = self.divergence(p)
            value = (self.mass(p) - old_mass) / step - net
            refused = self.rain - value[-1]  # of the rain, had the surface node its balance
            dry = refused < -scale * p[-1]
            full = value.copy()
            full[-1] = -refused if dry else scale * p[-1]
            return full, band, dry

        value, band, dry = residual(p)
        norm = np.linalg.norm(value)
        for _ in range(60):
            jacobian = -band
            jacobian[1] += self.mass_slope(p) / step
            if not dry:
                jacobian[1, -1], jacobian[2, -2] = scale, 0.0
            change = solve_banded((1, 1), jacobian, -value)
            damping = 1.0
            while damping > 1e-3:
                trial = p + damping * change
                new_value, new_band, new_dry = residual(trial)
                new_norm = np.linalg.norm(new_value)
                if new_norm < (1 - 1e-4 * damping) * norm or new_norm < SMALL:
                    break
                damping *= 0.5
            if damping <= 1e-3:
                return None
            p, value, band, dry, norm = trial, new_value, new_band, new_dry, new_norm
            if norm < SMALL:
                return p
        return None

    def advance(self, p, step):
        """One SDIRK2 step."""
        mass = self.mass(p)
        first = self.solve(p, mass, GAMMA * step)
        if first is None:
            return None
        rate = (self.mass(first) - mass) / (GAMMA * step)
        return self.solve(first, mass + (1 - GAMMA) * step * rate, GAMMA * step)


def simulate(column, times, tolerance, first_step=1e-3, largest_step=5.0):
    """Pressures at `times`; local error of the saturation (rms) below `tolerance` a step."""
    p, time, step, answers, steps = column.pressure, 0.0, first_step, [], 0
    for target in times:
        while time < target - 1e-9:
            trial = min(step, target - time, largest_step)
            whole = column.advance(p, trial)
            half = column.advance(p, 0.5 * trial) if whole is not None else None
            fine = column.advance(half, 0.5 * trial) if half is not None else None
            if fine is None:
                step = 0.25 * trial
                if step < 1e-7:
                    raise RuntimeError(f"step collapsed at {time} s")
                continue
            error = np.sqrt(np.mean((soil.saturation(fine) - soil.saturation(whole)) ** 2)) / 3
            factor = 0.9 * (tolerance / max(error, 1e-15)) ** (1 / 3)
            if error > tolerance and trial > 1e-4:
                step = trial * max(factor, 0.2)
                continue
            p, time, steps = fine, time + trial, steps + 1
            step = max(step, trial) if trial < step else trial
            step *= min(max(factor, 0.3), 2.0)
        answers.append(p.copy())
    print(f"  {column.y.size - 1} cells, tolerance {tolerance}: {steps} steps", flush=True)
    return answers


def write(name, column, answers):
    y = np.arange(401) * 0.0025
    with open(name, "w") as file:
        file.write("time_s,y_m,pressure_Pa,saturation\n")
        for time, p in zip(TIMES, answers):
            values = np.interp(y, column.y, p)
            for row in zip(y, values, soil.saturation(values)):
                file.write(f"{time:.0f},{row[0]:.4f},{row[1]:.3f},{row[2]:.7f}\n")


def compare(label, coarse, fine):
    """Differences of two runs on the nodes of the coarser mesh."""
    (column_a, answers_a), (column_b, answers_b) = coarse, fine
    stride = (column_b.y.size - 1) // (column_a.y.size - 1)
    for time, a, b in zip(TIMES, answers_a, answers_b):
        b = b[::stride]
        ds = np.abs(soil.saturation(a) - soil.saturation(b))
        print(f"  {label} t={time:.0f}: S mean {ds.mean():.2e} max {ds.max():.2e}; p mean {np.abs(a - b).mean():.3f} Pa "
              f"max {np.abs(a - b).max():.3f} Pa at y={column_a.y[np.abs(a - b).argmax()]:.4f}")


def run(potential, cells, tolerance):
    column = Column(cells, potential)
    return column, simulate(column, (*TIMES[:-1], FILLED), tolerance)


def main():
    ones = soil.Potential(lambda p: np.ones_like(p))
    for name, potential in (("column", soil.Potential()), ("column_constant_k", ones)):
        print(name)
        fine = run(potential, 1600, 2e-6)
        write(name + ".csv", *fine)
        top = np.interp([0.995], fine[0].y, fine[1][0])[0]
        print(f"  p in the top one of 100 cells at 20 s: {top:.1f} Pa; when full, p(base) {fine[1][-1][0]:.2f} "
              f"(hydrostatic {WEIGHT:.2f}), least S {soil.saturation(fine[1][-1]).min():.8f}")
        if "--error" in sys.argv:
            compare("mesh", run(potential, 800, 2e-6), fine)
            compare("step", run(potential, 1600, 2e-5), fine)


if __name__ == "__main__":
    main()
