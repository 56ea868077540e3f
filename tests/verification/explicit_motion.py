"""Explicit motion of ground that holds water, against closed solutions and independent ones."""

import json
import os
import pathlib
import subprocess

import gas_diffusion as gas
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


def three_phase_wave_rows():
    """Standing waves of half a wave length in a closed column of soil, water and air (net stress; van Genuchten's n = 2)."""
    number, alpha, wet = numpy.pi, 5e-6, 0.8
    capacity = alpha * numpy.sqrt(wet**-2 - 1) * wet**3  # -dS/ds of S = (1 + (alpha s)^2)^-1/2
    liquid_share = numpy.sqrt(wet) * (1 - numpy.sqrt(1 - wet**2)) ** 2  # k_rl, Mualem
    gas_share = numpy.sqrt(1 - wet) * (1 - wet**2)  # k_rg, Parker, Lenhard & Kuppusamy
    for name, liquid, air in (("little drag", 1e-2, 1e-2), ("sand", 1e-9, 5e-8)):
        ground = waves.Unsaturated(bishop=0.0, saturation=wet, capacity=capacity, liquid_mobility=liquid * liquid_share,
                                   gas_mobility=air * gas_share)
        inverse = numpy.diag(1 / ground.partial_density())
        system = numpy.block([[numpy.zeros((3, 3)), numpy.eye(3)], [-(number**2) * inverse @ ground.stiffness(), -inverse @ ground.drag()]])
        rates, modes = numpy.linalg.eig(system)
        oscillating = sorted((k for k in range(6) if rates[k].imag > 0.1 * abs(rates[k])), key=lambda k: -rates[k].imag)
        for k, order in zip(oscillating, ("first", "second", "third")):
            exact, velocity = 1j * numpy.conj(rates[k]), modes[3:, k]
            phase = numpy.argmax(abs(velocity))
            velocity = velocity / velocity[phase]
            with Clock() as clock:
                found = histories("gas_wave", 50, *velocity.real, alpha, liquid, air, 6 * 2 * numpy.pi / exact.real)
            omega = frequency_of(found[("solid", "liquid", "gas")[phase]], found["step"], exact)
            what = f"{order} wave of three phases, {name}"
            yield row("wave_speeds", what, "rel", abs(omega.real / exact.real - 1), 0.02, "1", "plane waves of three phases", clock)
            yield row("wave_speeds", f"decay of the {what}", "abs", abs(omega.imag - exact.imag) / exact.real, 0.02, "1",
                      "plane waves of three phases", clock)


def wave_rows():
    yield from standing_wave_rows()
    yield from three_phase_wave_rows()


def diffusion_rows():
    """Air into dry ground: a small step against the series, a large one against the solution of the nonlinear equation."""
    soil = gas.Soil()
    times = [0.2, 1.0, 3.0]
    for step, exact, source in ((10.0, None, "series, Carslaw & Jaeger 1959"), (50e3, gas.Nonlinear(soil, 1.0, 50e3, times), "P^2 diffusion, Chebyshev collocation")):
        with Clock() as clock:
            profiles = histories("gas_diffusion", 50, step, soil.permeability / soil.viscosity, *times)
        for k, profile in enumerate(profiles):
            height = numpy.array(profile["height"])
            pressure = exact.pressure(height, k) if exact else gas.linear(soil, 1.0, step, height, times[k])
            yield row("gas_diffusion", f"step of {step:g} Pa, pressure at {times[k]:g} s", "max",
                      abs(profile["pressure"] - pressure).max() / step, 0.01, "1", source, clock)
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


def three_phase_column_rows():
    """The paper's column where air can leave through the wet surface alone, on 100 cells."""
    reference = read_csv("column_three_phase.csv")
    source = "column_three_phase.csv, independent finite volumes on 1600 cells"
    scales = {"pressure": ("water_pressure_Pa", 37975.0), "gas_pressure": ("gas_pressure_Pa", reference["gas_pressure_Pa"].max()),
              "saturation": ("saturation", 1.0)}
    with Clock() as clock:
        profiles = histories("column_three_phase", 100)
    for profile in profiles:
        time = int(profile["time"])
        at = reference["time_s"] == time
        height = numpy.array(profile["height"])
        for name, (column, scale) in scales.items():
            exact = numpy.interp(height, reference["y_m"][at], reference[column][at])
            yield row("column_three_phase", f"{name} at {time} s", "max", abs(profile[name] - exact).max() / scale, 0.01, "1", source,
                      clock)
        for name, column in (("infiltrated", "infiltrated_m"), ("escaped", "air_escaped_m")):
            yield row("column_three_phase", f"{name} until {time} s", "rel", abs(profile[name] / reference[column][at][0] - 1), 0.01, "1",
                      source, clock)
    for name in ("water_missed", "air_missed"):
        yield row("column_three_phase", name.replace("_", " "), "rel", max(abs(profile[name]) for profile in profiles), 1e-8, "1",
                  "mass balance", clock)
