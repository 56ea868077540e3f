"""Explicit motion of ground whose water and gas exchange vapour and dissolved air, against closed solutions."""

import exchange_box
import numpy
import vapour_diffusion
from explicit_motion import histories
from rows import Clock, row

ALPHA, EXPONENT = 1e-6, 1.5  # of a clay: its suction lowers the humidity by 0.6 %


def box_rows():
    """Dry gas over water without air, wetter and under 20 kPa in one half of a closed box: at rest as Kelvin and Henry say."""
    box = exchange_box.Box(alpha=ALPHA, exponent=EXPONENT)
    halves = [exchange_box.State(saturation, pressure, 0.0, 0.0) for saturation, pressure in ((0.9, 20e3), (0.8, 0.0))]
    exact = exchange_box.equilibrium(box, *halves)
    with Clock() as clock:
        found = histories("exchange_box", 10, 0.9, 0.8, 20e3, ALPHA, 0.5)
    source = "Kelvin, Henry, retention and masses, by bisection"
    absolute = numpy.array(found["gas_pressure"]) + box.atmosphere
    for name, values, expected in (("saturation", found["saturation"], exact.saturation),
                                   ("gas pressure, absolute", absolute, exact.gas_pressure + box.atmosphere),
                                   ("vapour density", found["vapour"], exact.vapour),
                                   ("dissolved air", found["dissolved"], exact.dissolved)):
        yield row("exchange_box", name, "max rel", abs(numpy.array(values) / expected - 1).max(), 1e-3, "1", source, clock)
    for name in ("water", "air"):
        yield row("exchange_box", f"mass of {name}", "rel", abs(found[f"{name}_missed"]), 1e-12, "1", "mass balance", clock)


def vapour_rows():
    """A hundred times the diffusivity of vapour in air: only the clock's rate depends on it."""
    for name, cells, lower, upper, alpha, exponent, times in (("dry", 40, 0.9, 0.1, 1e-3, 4, (0.1, 0.3, 1.0)),
                                                              ("moist", 25, 0.603, 0.597, 7e-4, 2, (1.0, 2.0, 4.0))):
        column = vapour_diffusion.Column(2.4e-3, alpha=alpha, exponent=exponent)
        retardation = 1 if name == "dry" else column.retardation((lower + upper) / 2)
        with Clock() as clock:
            profiles = histories("vapour_diffusion", cells, lower, upper, alpha, exponent, column.diffusivity, *times)
        for profile, time in zip(profiles, times):
            exact = column.humidity(lower, upper, retardation, numpy.array(profile["height"]), time)
            error = abs(profile["humidity"] - exact).max() / (lower - upper)
            yield row("vapour_diffusion", f"humidity of {name} ground at {time:g} s", "max", error, 0.01, "1",
                      "Fick and Kelvin, series", clock)
