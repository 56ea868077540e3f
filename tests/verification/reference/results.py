"""Writes SCENE.csv (hourly, at the monitoring points) and SCENE_field.csv (36 h, half-metre raster) from flow.py and mechanics.py.

Usage: results.py SCENE FLOW.npz MECHANICS.npz
"""
import sys
import numpy as np
from scipy.interpolate import RegularGridInterpolator
import soil
from scene import Scene, ground_displacement, raster


def histories(scene, flow, mechanics):
    """Header and hourly rows."""
    names, times = list(flow["names"]), flow["times"]
    hours = np.arange(flow["pressure"].shape[0])
    pressure = flow["probes"][[np.argmin(np.abs(times - 3600 * hour)) for hour in hours]]
    header, columns = ["time_s"], [3600.0 * hours]
    for name, values in zip(names, pressure.T):
        header += [f"pressure_{name}_Pa", f"saturation_{name}"]
        columns += [values, soil.saturation(values)]
    for name, (x, _) in scene.markers.items():
        header += [f"ux_{name}_m", f"uy_{name}_m"]
        columns += list(ground_displacement(mechanics, x).T)
    return header, np.stack(columns, axis=1)


def field(scene, flow, mechanics):
    x, y = raster(scene)
    places = np.stack([x, np.clip(scene.z(x, y), 0.0, flow["z"][-1])], axis=1)
    pressure = RegularGridInterpolator((flow["x"], flow["z"]), flow["pressure"][-1].astype(float))(places)
    grid = mechanics["node_x"], mechanics["node_z"]
    u = [RegularGridInterpolator(grid, component)(places) for component in mechanics["displacement"][-1]]
    return np.stack([x, y, pressure, soil.saturation(pressure), *u], axis=1)


def text(name, value):
    return f"{value:.2f}" if "Pa" in name else f"{value:.6f}" if "saturation" in name else f"{value:.8f}" if name[0] == "u" else f"{value:g}"


def write(path, header, rows):
    with open(path, "w") as file:
        file.write(",".join(header) + "\n")
        for row in rows:
            file.write(",".join(text(name, value) for name, value in zip(header, row)) + "\n")


def main():
    scene, flow, mechanics = Scene(sys.argv[1]), np.load(sys.argv[2]), np.load(sys.argv[3])
    write(scene.name + ".csv", *histories(scene, flow, mechanics))
    write(scene.name + "_field.csv", ["x_m", "y_m", "pressure_Pa", "saturation", "ux_m", "uy_m"], field(scene, flow, mechanics))


if __name__ == "__main__":
    main()
