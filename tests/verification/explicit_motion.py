"""Explicit motion of ground that holds water, against closed solutions and independent ones."""

import json
import os
import pathlib
import subprocess

import numpy
import saturated_wave as closed_wave
import wave_speeds as waves
from scipy.optimize import curve_fit
from rows import Clock, read_csv, row


def histories(*arguments):
    """What the program explicit_histories prints, beside the library under test."""
    program = pathlib.Path(os.environ["TALUS_LIBRARY"]).resolve().parent.parent / "bin" / "explicit_histories"
    command = [program, *(str(argument) for argument in arguments)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def saturated_wave_rows():
    """de Boer, Ehlers & Liu (1993); the water nearly incompressible (2e11 Pa), as theirs is."""
    column = closed_wave.Column(closed_wave.Ground(), closed_wave.one_minus_cosine(3000.0, 75.0), height=10.0)
    source = "de Boer, Ehlers & Liu 1993, closed solution"
    with Clock() as clock:
        found = histories("saturated_wave", 100)
    times, depth = numpy.array(found["time"]), numpy.reshape(found["depth"], (-1, 3))
    displacement, pressure = (numpy.reshape(found[name], (-1, 3)) for name in ("displacement", "pressure"))
    for k, name in enumerate(("at the surface", "1 m deep", "5 m deep")):
        exact = numpy.array([column.displacement(x, t) for x, t in zip(depth[:, k], times)])
        scale = max(abs(column.displacement(depth[0, 0], t)) for t in times)
        yield row("saturated_wave", f"displacement {name}", "max", abs(displacement[:, k] - exact).max() / scale, 0.02, "1",
                  source, clock)
    for k, name in ((1, "1 m deep"), (2, "5 m deep")):
        exact = numpy.array([column.pressure(x, t) for x, t in zip(depth[:, k], times)])
        yield row("saturated_wave", f"pressure {name}", "max", abs(pressure[:, k] - exact).max() / 6000.0, 0.02, "1", source,
                  clock)


def frequency_of(amplitude, step, guess):
    """Complex omega (rad/s) of the decaying oscillation that fits an amplitude best."""
    time = step * (1 + numpy.arange(len(amplitude)))

    def motion(time, frequency, decay, cosine, sine):
        return numpy.exp(-decay * time) * (cosine * numpy.cos(frequency * time) + sine * numpy.sin(frequency * time))

    start = (guess.real, -guess.imag, amplitude[0], 0.0)
    (frequency, decay, _, _), _ = curve_fit(motion, time, amplitude, p0=start)
    return complex(frequency, -decay)


def standing_wave_rows():
    """Standing waves of a quarter wave length, fast and slow, with little drag and with that of a gravel of 0.1 m/s (Biot 1956)."""
    number = numpy.pi / 2
    for name, mobility in (("little drag", 1e-2), ("gravel", 1e-5)):
        ground = waves.Saturated(mobility=mobility)
        size = len(ground.partial_density())
        inverse = numpy.diag(1 / ground.partial_density())
        system = numpy.block([[numpy.zeros((size, size)), numpy.eye(size)],
                              [-(number**2) * inverse @ ground.stiffness(), -inverse @ ground.drag()]])
        rates, modes = numpy.linalg.eig(system)
        oscillating = sorted((k for k in range(len(rates)) if rates[k].imag > 1e-3 * abs(rates[k])),
                             key=lambda k: -rates[k].imag)
        for k, speed in zip(oscillating, ("fast", "slow")):
            exact = 1j * numpy.conj(rates[k])
            velocity = modes[size:, k] / modes[size, k]
            with Clock() as clock:
                found = histories("standing_wave", 50, 1.0, velocity[1].real, mobility, 6 * 2 * numpy.pi / exact.real)
            omega = frequency_of(found["amplitude"], found["step"], exact)
            yield row("wave_speeds", f"{speed} wave, {name}", "rel", abs(omega.real / exact.real - 1), 0.02, "1",
                      "Biot 1956, plane waves", clock)
            yield row("wave_speeds", f"decay of the {speed} wave over the frequency, {name}", "abs",
                      abs(omega.imag - exact.imag) / exact.real, 0.02, "1", "Biot 1956, plane waves", clock)


def column_run(cells):
    """Profiles of the paper's column by the explicit method, at its five times, and the clock."""
    with Clock() as clock:
        profiles = histories("column_explicit", cells)
    return profiles, clock


def column_rows():
    """The paper's column by the explicit method: within the paper's distance between two methods."""
    reference = read_csv("column.csv")
    profiles, clock = column_run(25)
    for profile in profiles:
        at = reference["time_s"] == int(profile["time"])  # the last of them, of the column just filled, is at 600.5 s
        height = numpy.array(profile["height"])
        for name, bound, unit in (("pressure", 3517.0, "Pa"), ("saturation", 0.021, "1")):
            exact = numpy.interp(height, reference["y_m"][at], reference["pressure_Pa" if unit == "Pa" else "saturation"][at])
            yield row("column_explicit", f"{name} at {int(profile['time'])} s", "max", abs(profile[name] - exact).max(), bound, unit,
                      "column.csv, independent finite volumes on 1600 cells", clock)
    missed = max(abs(profile["missed"]) for profile in profiles)
    yield row("column_explicit", "water balance", "rel", missed, 1e-8, "1", "mass balance", clock)
