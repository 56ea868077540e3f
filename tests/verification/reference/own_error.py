"""Differences of two runs of the slopes: the references' own error. Prints rows for SCENE_error.csv.

Usage: own_error.py SCENE LABEL FLOW_A.npz FLOW_B.npz   or   own_error.py SCENE LABEL MECHANICS_A.npz MECHANICS_B.npz
"""
import sys
import numpy as np
import soil
from scene import Scene, ground_displacement


def hourly_probes(flow):
    hours = np.arange(flow["pressure"].shape[0])
    return flow["probes"][[np.argmin(np.abs(flow["times"] - 3600 * hour)) for hour in hours]]


def main():
    scene, label, first, second = Scene(sys.argv[1]), sys.argv[2], np.load(sys.argv[3]), np.load(sys.argv[4])
    rows = []
    if "probes" in first:
        a, b = hourly_probes(first), hourly_probes(second)
        for k, name in enumerate(first["names"]):
            rows.append(("pressure", name, "Pa", np.abs(a - b)[:, k].max()))
            rows.append(("saturation", name, "1", np.abs(soil.saturation(a) - soil.saturation(b))[:, k].max()))
    else:
        for name, (x, _) in scene.markers.items():
            difference = 1e3 * (ground_displacement(first, x) - ground_displacement(second, x))
            rows += [(f"u{axis}", name, "mm", np.abs(difference)[:, k].max()) for k, axis in enumerate("xy")]
    for row in rows:
        print(f"{scene.name},{label},{row[0]},{row[1]},{row[2]},{row[3]:.3g}")


if __name__ == "__main__":
    main()
