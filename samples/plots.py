#!/usr/bin/python3
"""Draws a run like the figures of the paper: profiles of a column, contours of a slope, histories, the water balance.

Usage: samples/plots.py FOLDER, where FOLDER is that of `talus run --out FOLDER`. The plots go there.
"""
import functools
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy
from matplotlib.animation import FuncAnimation, PillowWriter
from matplotlib.tri import Triangulation

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bindings/python"))
from talus.results import Results

HOUR = 3600
plt.rcParams.update({"figure.dpi": 130, "font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False,
                     "figure.constrained_layout.use": True})


def time_text(seconds):
    return f"{seconds:g} s" if seconds < 2 * HOUR else f"{seconds / HOUR:g} h"


def time_axis(axes, longest):
    """The unit of time for an axis, and its label."""
    unit, name = (1, "s") if longest < 2 * HOUR else (HOUR, "h")
    axes.set_xlabel(f"time, {name}")
    return unit


# --- a column: profiles ---

def draw_profiles(run, figure):
    pressure_axes, saturation_axes = figure.subplots(1, 2, sharey=True)
    colours = plt.cm.viridis(numpy.linspace(0, 0.9, len(run.times)))
    for time, colour in zip(run.times, colours):
        fields = run.fields(time)
        height = fields.nodes["position"][:, 1]
        pressure_axes.plot(fields.nodes["pressure"] / 1e3, height, color=colour, label=time_text(time))
        saturation_axes.plot(fields.points["saturation"], fields.points["position"][:, 1], color=colour)
    pressure_axes.set(xlabel="pore pressure, kPa", ylabel="height, m")
    pressure_axes.legend()
    saturation_axes.set(xlabel="saturation")


# --- a slope: contours ---

def triangles(fields):
    """The mesh as triangles, a quad as two."""
    found = []
    start = 0
    for end in fields.ends:
        corners = fields.corners[start:end]
        found += [[corners[0], corners[i], corners[i + 1]] for i in range(1, len(corners) - 1)]
        start = end
    return found


def draw_contours(run, figure):
    fields = run.fields(run.mesh_times[-1])
    position = fields.nodes["position"]
    mesh = Triangulation(position[:, 0], position[:, 1], triangles(fields))
    wanted = []
    if "pressure" in fields.nodes:
        pressure = fields.nodes["pressure"] / 1e3
        wanted.append(("pore pressure, kPa", pressure, "viridis"))
        wanted.append(("saturation", fields.at_nodes("saturation"), "Blues"))
    if "displacement" in fields.nodes:
        displacement = 1e3 * numpy.linalg.norm(fields.nodes["displacement"], axis=1)
        wanted.append(("displacement, mm", displacement, "magma_r"))
    rows = figure.subplots(len(wanted), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (title, values, colours) in zip(rows, wanted):
        drawn = axes.tricontourf(mesh, values, levels=24, cmap=colours, extend="both")  # a value on the last level is drawn too
        figure.colorbar(drawn, ax=axes)
        if title.startswith("pore") and pressure.min() < 0 < pressure.max():
            axes.tricontour(mesh, values, levels=[0], colors="white", linewidths=1)
        for probe in run.report["engine"]["probes"]:
            axes.plot(probe["x"], probe["y"], "k.", markersize=4)
            axes.annotate(probe["name"], (probe["x"], probe["y"]), xytext=(3, 3), textcoords="offset points", fontsize=7)
        axes.set(title=f"{title}, {time_text(fields.time)}", ylabel="y, m", aspect="equal")
        axes.grid(False)
    rows[-1].set_xlabel("x, m")


# --- a dynamic ground: frames of its points ---

def spread(numbers, most):
    """At most so many of them, evenly, the first and the last among them."""
    return [numbers[i] for i in sorted({round(i) for i in numpy.linspace(0, len(numbers) - 1, min(most, len(numbers)))})]


def displaced(points):
    return numpy.linalg.norm(points["displacement"], axis=1)


def draw_points(axes, points, extent, inches, **options):
    """Each as a square, in the colour of how far it has come."""
    spacing = numpy.sqrt(points["point_volume"].mean())
    size = max((spacing / extent * inches * 72) ** 2, 0.2)  # in points of a seventy-second of an inch
    x, y = points["position"][:, 0], points["position"][:, 1]
    return axes.scatter(x, y, c=displaced(points), s=size, cmap="viridis", marker="s", linewidths=0, **options)


def motion_starts(run):
    """Of ground that stood at first; ground that moves from the start has none."""
    return [event["time"] for event in run.report["events"] if event["kind"] == "motion_started"]


@functools.cache
def main_motion(run):
    """The times of the fields within the motion that brought the ground farthest: ground that settles may fail again."""
    starts = motion_starts(run)
    if not starts:
        return run.moving_times
    motions = [[time for time in run.moving_times if start <= time < end] for start, end in zip(starts, starts[1:] + [numpy.inf])]

    def come(times):
        return displaced(run.fields(times[-1]).points).max() - displaced(run.fields(times[0]).points).max()
    return max(filter(None, motions), key=come)


def motion_time_text(run, time):
    """Since the motion began, of ground that stood at first."""
    began = max((start for start in motion_starts(run) if start <= time), default=None)
    return time_text(time) if began is None else f"{began / HOUR:.2f} h and {time - began:.1f} s"


def draw_frames(run, figure):
    """One below the other, or side by side where the ground is higher than wide."""
    times = spread(main_motion(run), 8)
    width, height = numpy.ptp(run.fields(times[-1]).points["position"][:, :2], axis=0)
    upright = height > 2 * width
    count = len(times)
    figure.set_size_inches(*((2 * count, 7) if upright else (7, 2 * count)))
    frames = figure.subplots(*((1, count) if upright else (count, 1)), sharex=True, sharey=True, squeeze=False).ravel()
    for axes, time in zip(frames, times):
        drawn = draw_points(axes, run.fields(time).points, height if upright else width, 5)
        figure.colorbar(drawn, ax=axes, label="displaced, m")
        axes.set(title=motion_time_text(run, time), aspect="equal")
        axes.label_outer()
    for axes in frames if upright else frames[-1:]:
        axes.set_xlabel("x, m")
        axes.locator_params(axis="x", nbins=2 if upright else "auto")
    for axes in frames[:1] if upright else frames:
        axes.set_ylabel("y, m")


def draw_animation(run, path):
    """The motion, as an animated picture."""
    times = spread(main_motion(run), 100)
    frames = [run.fields(time).points for time in times]
    low = numpy.min([points["position"][:, :2].min(axis=0) for points in frames], axis=0)
    high = numpy.max([points["position"][:, :2].max(axis=0) for points in frames], axis=0)
    width, height = high - low
    figure, axes = plt.subplots(figsize=(8, 1.2 + 6.5 * min(height / width, 1)), dpi=100)
    farthest = max(displaced(points).max() for points in frames)
    drawn = draw_points(axes, frames[0], max(width, height), 6.5, vmin=0, vmax=farthest)
    figure.colorbar(drawn, ax=axes, label="displaced, m")
    margin = 0.02 * max(width, height)
    axes.set(xlabel="x, m", ylabel="y, m", aspect="equal", xlim=(low[0] - margin, high[0] + margin),
             ylim=(low[1] - margin, high[1] + margin))

    def show(k):
        drawn.set_offsets(frames[k]["position"][:, :2])
        drawn.set_array(displaced(frames[k]))
        axes.set_title(motion_time_text(run, times[k]))

    FuncAnimation(figure, show, len(frames)).save(path, PillowWriter(fps=8))
    plt.close(figure)


def draw_energy(run, figure):
    energies, run_out = figure.subplots(2, 1, sharex=True)
    times, starts = main_motion(run), motion_starts(run)
    start = times[0] if starts else 0
    moves = numpy.array([step["regime"] in ("dynamic", "at_rest") for step in run.report["steps"]])
    shown = moves & (run.steps("time") >= start) & (run.steps("time") <= times[-1] if starts else True)
    time = run.steps("time")[shown] - start
    for name in ("kinetic", "elastic", "potential", "dissipated"):
        energy = run.steps(f"{name}_energy")[shown]
        energies.plot(time, energy - energy[0] if name == "potential" else energy, label=name)
    energies.set_ylabel("energy, potential since then, J/m")
    energies.legend()
    run_out.plot(time, run.steps("run_out")[shown])
    run_out.set(xlabel=f"time since {start / HOUR:.2f} h, s" if starts else "time, s", ylabel="run-out, m")


# --- histories and water ---

def displacement_size(run, probe):
    parts = [run.probes[name] for name in (f"{probe}.displacement.x", f"{probe}.displacement.y") if name in run.probes]
    return numpy.linalg.norm(parts, axis=0)


def draw_histories(run, figure):
    probes = [probe["name"] for probe in run.report["engine"]["probes"]]
    has = {quantity: f"{probes[0]}.{quantity}" in run.probes for quantity in ("pressure", "saturation", "displacement.y")}
    panels = [("pore pressure, kPa", lambda probe: run.probes[f"{probe}.pressure"] / 1e3)] * has["pressure"]
    panels += [("saturation", lambda probe: run.probes[f"{probe}.saturation"])] * has["saturation"]
    panels += [("displacement, mm", lambda probe: 1e3 * displacement_size(run, probe))] * has["displacement.y"]
    rows = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    unit = time_axis(rows[-1], run.probes["time"][-1])
    for axes, (title, values) in zip(rows, panels):
        for probe in probes:
            axes.plot(run.probes["time"] / unit, values(probe), label=probe)
        axes.set_ylabel(title)
    rows[0].legend(ncols=4)


def draw_water(run, figure):
    amounts, balance = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    time = run.steps("time")
    unit = time_axis(balance, time[-1])
    for name in ("rain", "infiltrated", "run_off", "seepage", "inflow", "drained"):
        values = run.steps(f"water_{name}")
        if values.any():
            amounts.plot(time / unit, values, label=name.replace("_", "-"))
    amounts.plot(time / unit, run.steps("water_stored") - run.steps("water_initial"), "k--", label="stored more")
    amounts.set_ylabel("water, m³/m²" if run.report["engine"]["dimension"] == 1 else "water, m³/m")
    amounts.legend()
    rain = run.steps("water_rain").max() or 1
    missed = numpy.abs(run.steps("water_residual")) / rain
    balance.semilogy(time / unit, numpy.maximum(missed, 1e-17))
    balance.set_ylabel("missed / rain")


def draw(run, name, function, size):
    figure = plt.figure(figsize=size)
    function(run, figure)
    figure.suptitle(run.report["engine"]["title"] if name != "water" else f"{run.report['engine']['name']}: water balance")
    figure.savefig(run.folder / f"{name}.png")
    plt.close(figure)


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    run = Results(sys.argv[1])
    has_water = run.report["engine"]["physics"]["water"]
    if run.times and run.report["engine"]["dimension"] == 1 and has_water:
        draw(run, "profiles", draw_profiles, (7, 4.5))
    if run.moving_times:
        draw(run, "frames", draw_frames, None)  # its size depends on the ground
        draw(run, "energy", draw_energy, (7, 5))
        draw_animation(run, run.folder / "motion.gif")
    if run.mesh_times and run.report["engine"]["dimension"] == 2:
        draw(run, "contours", draw_contours, (7, 9))
    if run.probes:
        draw(run, "histories", draw_histories, (7, 7))
    if has_water and run.report["steps"]:
        draw(run, "water", draw_water, (7, 5))
    return 0


if __name__ == "__main__":
    sys.exit(main())
