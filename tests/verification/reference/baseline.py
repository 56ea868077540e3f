"""The paper's FEM baseline: 1222 linear quads, roughly uniform, as a user of FEM would set it up; its error and its run time.

Flow in FEniCSx (Galerkin, k_r at 2 x 2 points, lumped or consistent mass, SDIRK2, steps grown to LARGEST_STEP and cut when Newton
fails), equilibrium hourly by mechanics.py on the same quads (linear, B-bar); the strain rate of the last hour enters the flow.
Only the solve is timed (start state included): no imports, no compilation of forms, no mesh.
Usage: baseline.py SCENE [LARGEST_STEP_S [consistent|lumped]] ; prints and writes baseline_SCENE.json in the folder it is run in
"""
import json
import pathlib
import sys
import time
import numpy as np
from scipy.interpolate import RegularGridInterpolator
import soil
from flow import Flow
from mechanics import Mechanics
from scene import Scene


HERE = pathlib.Path(__file__).resolve().parent


class UniformScene(Scene):
    """The scene on columns of equally high quads: z is the depth over the height of the ground."""

    def y(self, x, z):
        return self.height(x) * (1 - z)

    def z(self, x, y):
        return 1 - y / self.height(x)


def lines(scene):
    """47 columns, kinks on lines, and 26 layers: 1222 quads of about 1.2 m in the crest and less at the toe."""
    face = {"slope": 15, "slope_gentle": 19}[scene.name]
    side = (47 - face) // 2
    x = np.concatenate([np.linspace(0, 20, side + 1), np.linspace(20, scene.toe, face + 1)[1:],
                        np.linspace(scene.toe, scene.right, side + 1)[1:]])
    return x, np.linspace(0, 1, 27)


def interpolate(scene, grid, values, places):
    x, y = np.asarray(places, float).T
    z = np.clip(scene.z(x, y), 0, 1)
    return RegularGridInterpolator(grid, values)(np.stack([x, z], axis=1))


def compute(flow, mechanics, largest_step):
    """Hourly nodal pressures and displacements."""
    pressures, displacements = [], []
    flow.steady()

    def at_points(p):
        return (p.ravel()[corner] @ mechanics.values.T).ravel()

    # corner nodes of the elements among the flow's nodes
    i, j = (a.ravel() for a in np.meshgrid(np.arange(flow.x.size - 1), np.arange(flow.z.size - 1), indexing="ij"))
    number = lambda i, j: i * flow.z.size + j
    corner = np.stack([number(i, j + 1), number(i + 1, j + 1), number(i + 1, j), number(i, j)], axis=1)
    last = [None, mechanics.volumetric_strain()]

    def report(now):
        if abs(now / 3600 - round(now / 3600)) > 1e-9:
            return
        p = flow.p.x.array[flow.grid]
        if now == 0:
            mechanics.gravity(at_points(p))
        else:
            if not mechanics.step(at_points(last[0]), at_points(p)):
                raise RuntimeError(f"no equilibrium found at {now / 3600} h")
            strain = mechanics.volumetric_strain()
            flow.strain_rate.x.array[flow.grid] = (strain - last[1]) / 3600
            last[1] = strain
        last[0] = p.copy()
        pressures.append(p.copy())
        displacements.append(mechanics.displacements().copy())

    flow.storm(largest_step, report=report)
    return np.array(pressures), np.array(displacements)


def errors(scene, grid, pressures, displacements):
    result = {}
    reference = np.genfromtxt(HERE / f"{scene.name}.csv", delimiter=",", names=True)
    for name in "ABC":
        p = np.array([interpolate(scene, grid, values, [scene.probes[name]])[0] for values in pressures])
        result[f"pressure_{name}_Pa"] = np.abs(p - reference[f"pressure_{name}_Pa"]).max()
        result[f"saturation_{name}"] = np.abs(soil.saturation(p) - reference[f"saturation_{name}"]).max()
    for name, place in scene.markers.items():
        u = np.array([[interpolate(scene, grid, values, [place])[0] for values in both] for both in displacements])
        exact = np.stack([reference[f"ux_{name}_m"], reference[f"uy_{name}_m"]], axis=1)
        result[f"displacement_{name}_m"] = np.hypot(*(u - exact).T).max()
    field = np.genfromtxt(HERE / f"{scene.name}_field.csv", delimiter=",", names=True)
    places = np.stack([field["x_m"], field["y_m"]], axis=1)
    p = interpolate(scene, grid, pressures[-1], places)
    result["rms_pressure_Pa"] = np.sqrt(np.mean((p - field["pressure_Pa"]) ** 2))
    u = [interpolate(scene, grid, values, places) for values in displacements[-1]]
    result["rms_displacement_m"] = np.sqrt(np.mean((u[0] - field["ux_m"]) ** 2 + (u[1] - field["uy_m"]) ** 2))
    return {key: float(value) for key, value in result.items()}


def main():
    name = sys.argv[1]
    largest_step = float(sys.argv[2]) if len(sys.argv) > 2 else 3600.0
    lumped = sys.argv[3] == "lumped" if len(sys.argv) > 3 else True
    scene = UniformScene(name)
    x, z = lines(scene)
    flow = Flow(scene, x, z, degree=1, lumped=lumped, small=1e-4)
    mechanics = Mechanics(scene, x, z, linear=True)
    wall, cpu = time.perf_counter(), time.process_time()
    pressures, displacements = compute(flow, mechanics, largest_step)
    wall, cpu = time.perf_counter() - wall, time.process_time() - cpu
    report = {"scene": name, "nodes": int(flow.grid.size), "cells": int(mechanics.elements.shape[0]), "largest_step_s": largest_step,
              "mass": "lumped" if lumped else "consistent", "wall_s": wall, "cpu_s": cpu, "flow_iterations": flow.iterations,
              "mechanics_iterations": mechanics.iterations, "rms_at_s": 129600.0, "errors": errors(scene, (x, z), pressures, displacements)}
    with open(f"baseline_{name}.json", "w") as file:
        json.dump(report, file, indent=2)
    print(json.dumps(report, indent=2))


if __name__ == "__main__":
    main()
