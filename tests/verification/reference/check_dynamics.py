"""Checks of the references of the dynamic cases against second solutions that share nothing with them; exits 1 when one fails.

Usage: check_dynamics.py
"""

import dataclasses
import pathlib
import sys

import numpy
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq, fsolve

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import column_collapse  # noqa: E402
import elastic_bar  # noqa: E402
import exchange_box  # noqa: E402
import gas_diffusion  # noqa: E402
import saturated_wave  # noqa: E402
import vapour_diffusion  # noqa: E402
import wave_by_leapfrog  # noqa: E402
import wave_speeds  # noqa: E402


def bar_periods(bar, elements):
    """Of the first three modes, by linear finite elements."""
    size = bar.length / elements
    stiffness = bar.modulus / size * (2 * numpy.eye(elements) - numpy.eye(elements, k=1) - numpy.eye(elements, k=-1))
    mass = bar.density * size / 6 * (4 * numpy.eye(elements) + numpy.eye(elements, k=1) + numpy.eye(elements, k=-1))
    stiffness[-1, -1] *= 0.5
    mass[-1, -1] *= 0.5
    return 2 * numpy.pi / numpy.sqrt(eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 2]))


def check_bar():
    bar = elastic_bar.Bar(elastic_bar.uniaxial_strain_modulus(10e6, 0.3), 1800.0, 1.0, 0.1)
    exact = [dataclasses.replace(bar, mode=mode).period for mode in (1, 2, 3)]
    coarse, fine = bar_periods(bar, 100), bar_periods(bar, 200)
    yield "bar: period, to finite elements extrapolated", max(abs((4 * fine - coarse) / 3 / exact - 1)), 1e-6
    bar = dataclasses.replace(bar, mode=2)
    x, weight = numpy.polynomial.legendre.leggauss(30)
    x, weight, time, small = 0.5 * bar.length * (x + 1), 0.5 * bar.length * weight, 0.3 * bar.period, 1e-6
    kinetic = weight @ (0.5 * bar.density * bar.velocity(x, time) ** 2)
    elastic = weight @ (0.5 * bar.stress(x, time) ** 2 / bar.modulus)
    yield "bar: kinetic energy", abs(kinetic / bar.kinetic_energy(time) - 1), 1e-12
    yield "bar: strain energy", abs(elastic / bar.strain_energy(time) - 1), 1e-12
    strain = (bar.displacement(x + small, time) - bar.displacement(x - small, time)) / (2 * small)
    yield "bar: stress is modulus times strain", max(abs(bar.modulus * strain - bar.stress(x, time))) / max(abs(bar.stress(x, time))), 1e-8
    rate = (bar.displacement(x, time + small) - bar.displacement(x, time - small)) / (2 * small)
    yield "bar: velocity is the displacement's rate", max(abs(rate - bar.velocity(x, time))) / bar.speed, 1e-6
    yield "bar: slowing by lateral inertia, to Rayleigh-Lamb", lamb_difference(0.1), 2e-6


def lamb_difference(product, poisson=0.3):
    """Relative error of `slowing` for wave number times thickness, to the plate's first symmetric mode; density and young 1."""
    shear = 1 / (2 * (1 + poisson))
    fast = numpy.sqrt(elastic_bar.uniaxial_strain_modulus(1, poisson))

    def lamb(frequency):
        p, q = numpy.sqrt(1 - (frequency / fast) ** 2), numpy.sqrt(frequency**2 / shear - 1)
        half = 0.5 * product
        return (q**2 - 1) ** 2 * numpy.cosh(p * half) * numpy.sin(q * half) / q - 4 * p * numpy.sinh(p * half) * numpy.cos(q * half)

    thin = numpy.sqrt(elastic_bar.free_sides_modulus(1, poisson))
    exact = brentq(lamb, 0.95 * thin, 1.02 * thin, xtol=1e-15)
    return abs(elastic_bar.slowing(1.0, product, poisson) * thin / exact - 1)


def check_wave():
    loads = {"step": saturated_wave.step(3000.0), "1 - cos 75 t": saturated_wave.one_minus_cosine(3000.0, 75.0)}
    for conductivity, bound in ((1e-2, 1e-5), (1e-4, 1e-3)):
        ground = saturated_wave.Ground(conductivity=conductivity)
        for name, load in loads.items():
            difference = wave_difference(ground, load, 10.0, 4000)
            yield f"wave: {name}, k = {conductivity:g} m/s, to leapfrog", difference, bound
    ground, load = saturated_wave.Ground(), loads["1 - cos 75 t"]
    coarse, fine = (saturated_wave.Column(ground, load, 10.0, panels=panels) for panels in (60, 120))
    yield "wave: quadrature", abs(coarse.displacement(1.0, 0.2) / fine.displacement(1.0, 0.2) - 1), 1e-12
    near, far = saturated_wave.Column(ground, load), saturated_wave.Column(ground, load, 10.0)
    yield "wave: no base felt before the echo", abs(near.pressure(1.0, 0.2) / far.pressure(1.0, 0.2) - 1), 1e-12


def wave_difference(ground, load, height, cells):
    """Largest of u, stress and pressure over their own largest, after 2.55 passages: the wave has come back from the base."""
    when, depth, displacement, middle, stress, before, pressure = wave_by_leapfrog.simulate(ground, load, height, cells, int(2.55 * cells))
    column = saturated_wave.Column(ground, load, height)
    at = numpy.linspace(0, cells - 1, 7).astype(int)
    pairs = ((displacement, [column.displacement(x, when) for x in depth[at]]),
             (stress, [column.effective_stress(x, when)[0] for x in middle[at]]),
             (pressure, [column.pressure(x, before) for x in depth[at]]))
    return max(max(abs(numbers[at] - exact)) / max(abs(numbers)) for numbers, exact in pairs)


def momentum_residual(ground, frequency, wave_number, motion):
    """Of the equations as docs/theory.md has them, over the largest term; accelerations, Darcy drag and masses one by one."""
    rate, gradient = -1j * frequency, 1j * wave_number
    n = ground.porosity
    wet = getattr(ground, "saturation", 1.0)
    u_solid, u_liquid = motion[:2]
    v_solid, v_liquid = rate * u_solid, rate * u_liquid
    flow = n * wet * gradient * (v_liquid - v_solid)
    if len(motion) == 2:
        p_liquid = -(gradient * v_solid + flow) * ground.liquid_bulk / n / rate
        p_gas, gas_inertia, pore, resistance, gas = 0.0, 0.0, p_liquid, n / ground.mobility, []
    else:
        v_gas = rate * motion[2]
        gas_flow = n * (1 - wet) * gradient * (v_gas - v_solid)
        storage = rate * n * numpy.array([[wet / ground.liquid_bulk + ground.capacity, -ground.capacity],
                                          [-ground.capacity, (1 - wet) / ground.gas_bulk + ground.capacity]])
        squeeze = [wet * gradient * v_solid + flow, (1 - wet) * gradient * v_solid + gas_flow]
        p_liquid, p_gas = -numpy.linalg.solve(storage, squeeze)
        gas_inertia = n * (1 - wet) * ground.gas_density * rate * v_gas
        pore, resistance = ground.bishop * p_liquid + (1 - ground.bishop) * p_gas, n * wet / ground.liquid_mobility
        gas = [ground.gas_density * rate * v_gas, gradient * p_gas, n * (1 - wet) / ground.gas_mobility * (v_gas - v_solid)]
    liquid = [ground.liquid_density * rate * v_liquid, gradient * p_liquid, resistance * (v_liquid - v_solid)]
    mixture = [(1 - n) * ground.solid_density * rate * v_solid, n * wet * ground.liquid_density * rate * v_liquid, gas_inertia,
               -ground.modulus * gradient**2 * u_solid, gradient * pore]
    return max(abs(sum(terms)) / max(map(abs, terms)) for terms in (liquid, mixture, gas) if terms)


def with_mobility(ground, value):
    names = [field.name for field in dataclasses.fields(ground) if field.name.endswith("mobility")]
    return dataclasses.replace(ground, **{name: value for name in names})


def check_speeds():
    two, three = wave_speeds.Saturated(), wave_speeds.Unsaturated()
    net = dataclasses.replace(three, bishop=0.0)
    for name, ground in (("two phases", two), ("three phases", three), ("three phases, net stress", net)):
        worst = 0.0
        for frequency in (1e2, 1e3, 1e4, 1e5, 1e6):
            for wave in wave_speeds.compressional(ground, frequency):
                number = frequency / wave.speed + 1j * wave.attenuation
                worst = max(worst, momentum_residual(ground, frequency, number, wave.motion))
        yield f"speeds: {name}, momentum of each phase", worst, 1e-6
        bound, free = with_mobility(ground, 1e-14), with_mobility(ground, 1e18)
        fast = max(wave.speed for wave in wave_speeds.compressional(bound, 100.0) if wave.attenuation < 1e-3)
        yield f"speeds: {name}, undrained", abs(fast / ground.undrained_speed() - 1), 1e-8
        speeds = numpy.array([wave.speed for wave in wave_speeds.compressional(free, 100.0)])
        yield f"speeds: {name}, no drag", max(abs(speeds / ground.undragged_speeds() - 1)), 1e-8
    slow = wave_speeds.compressional(two, 1.0)[1]
    yield "speeds: slow wave is consolidation", abs(1.0 / (2 * slow.attenuation**2) / two.slow_diffusivity() - 1), 1e-4
    low, high = wave_speeds.shear(two, 1e-2).speed, wave_speeds.shear(two, 1e9).speed
    yield "speeds: shear, all the mass", abs(low / numpy.sqrt(two.shear / two.density) - 1), 1e-8
    yield "speeds: shear, the grains alone", abs(high / numpy.sqrt(two.shear / two.partial_density()[0]) - 1), 1e-8
    yield "speeds: standing waves", standing_difference(two, 3.0), 1e-6


def standing_difference(ground, wave_number):
    """That `frequencies` are the modes: the start of one decays as it says, in time by Radau. Relative."""
    omega = max(wave_speeds.frequencies(ground, wave_number), key=lambda value: value.real)
    density, size = ground.partial_density(), len(ground.partial_density())
    inertia = omega**2 * numpy.diag(density) + 1j * omega * ground.drag()
    motion = numpy.linalg.svd(wave_number**2 * ground.stiffness() - inertia)[2][-1].conj()
    start = numpy.concatenate([motion, -1j * omega * motion])

    def rate(time, state):
        force = -(wave_number**2) * ground.stiffness() @ state[:size] - ground.drag() @ state[size:]
        return numpy.concatenate([state[size:], force / density])

    end = 4 * numpy.pi / omega.real
    run = solve_ivp(rate, (0, end), start.real, "Radau", rtol=1e-10, atol=1e-12 * abs(start).max())
    return max(abs(run.y[:, -1] - (start * numpy.exp(-1j * omega * end)).real)) / max(abs(start))


def gas_by_volumes(soil, height, step, time, cells):
    """Gauge pressure in the cells, from the closed end; P^2 between centres, half a cell to the held end."""
    spacing, end = height / cells, (soil.atmosphere + step) ** 2
    factor = soil.permeability / (2 * soil.porosity * soil.viscosity * spacing**2)

    def rate(now, pressure):
        square = pressure**2
        flux = numpy.concatenate([[0.0], numpy.diff(square), [2 * (end - square[-1])]])
        return factor * numpy.diff(flux)

    start = numpy.full(cells, soil.atmosphere)
    run = solve_ivp(rate, (0, time), start, "LSODA", lband=1, uband=1, rtol=1e-10, atol=1e-6)
    return run.y[:, -1] - soil.atmosphere


def check_gas():
    soil, height, step = gas_diffusion.Soil(), 1.0, 50e3
    times = height**2 / soil.diffusivity * numpy.array([0.01, 0.1, 1.0])
    y = (numpy.arange(100) + 0.5) * height / 100
    up, down = (gas_diffusion.Nonlinear(soil, height, sign * 10.0, times, tolerance=1e-12) for sign in (1, -1))
    for index, time in enumerate(times):
        even = 0.5 * (up.pressure(y, index) - down.pressure(y, index))
        yield f"gas: series, T = {time * soil.diffusivity:g}", max(abs(even - gas_diffusion.linear(soil, height, 10.0, y, time))) / 10.0, 1e-6
    large = gas_diffusion.Nonlinear(soil, height, step, times)
    coarse, fine = (gas_by_volumes(soil, height, step, times[1], cells) for cells in (300, 900))
    extrapolated = (9 * fine[1::3] - coarse) / 8
    at = (numpy.arange(300) + 0.5) * height / 300
    yield "gas: nonlinear, to finite volumes extrapolated", max(abs(large.pressure(at, 1) - extrapolated)) / step, 1e-6
    finer = gas_diffusion.Nonlinear(soil, height, step, times, degree=144, tolerance=1e-12)
    yield "gas: nonlinear, degree", max(max(abs(large.pressure(y, i) - finer.pressure(y, i))) for i in range(3)) / step, 1e-8


def box_masses(box, state):
    """Water and air, kg per m3 of ground, component by component: liquid, gas."""
    liquid = box.liquid_density * numpy.exp((state.gas_pressure - box.suction(state.saturation)) / box.liquid_bulk)
    fraction = state.dissolved / liquid
    volume = box.porosity * numpy.array([state.saturation, 1 - state.saturation])
    moles = (box.atmosphere + state.gas_pressure) / box.thermal - state.vapour / box.water_molar
    return numpy.array([volume @ [liquid * (1 - fraction), state.vapour], volume @ [liquid * fraction, moles * box.air_molar]])


def check_box():
    box, start = exchange_box.example()
    rest = exchange_box.equilibrium(box, start)
    before, after = numpy.array(exchange_box.masses(box, start)), numpy.array(exchange_box.masses(box, rest))
    yield "box: masses", max(abs(after / before - 1)), 1e-13
    suction, liquid = box.suction(rest.saturation), box.density(exchange_box.liquid_pressure(box, rest))
    humidity = rest.vapour / box.saturated_vapour
    potential = box.thermal / box.water_molar * numpy.log(humidity) * liquid + suction
    yield "box: Kelvin, Pa of suction over Pa", abs(potential / suction), 1e-9
    air_pressure = exchange_box.air_density(box, rest) * box.thermal / box.air_molar
    yield "box: Henry", abs(rest.dissolved / (box.air_molar * box.henry * air_pressure) - 1), 1e-12
    dalton = air_pressure + rest.vapour * box.thermal / box.water_molar - box.atmosphere - rest.gas_pressure
    yield "box: Dalton", abs(dalton) / box.atmosphere, 1e-12

    def unbalance(unknown):
        state = exchange_box.State(0.85 + 1e-3 * unknown[0], 1e4 * unknown[1], unknown[2], unknown[3])
        other = exchange_box.at_equilibrium(box, state.saturation, state.gas_pressure)
        change = box_masses(box, state) / box_masses(box, start) - 1
        return [*(1e3 * change), state.vapour - other.vapour, state.dissolved - other.dissolved]

    found = fsolve(unbalance, [0.0, 0.0, 0.01, 0.01], xtol=1e-14)
    all_at_once = numpy.array([0.85 + 1e-3 * found[0], 1e4 * found[1], found[2], found[3]])
    yield "box: four equations at once", max(abs(all_at_once / numpy.array(dataclasses.astuple(rest)) - 1)), 1e-9


def vapour_by_volumes(column, lower, upper, time, cells):
    """Humidity in the cells, by the moles of vapour and air: what diffuses, and the flow N of all gas that keeps its pressure even.

    d(water)/dt = -d/dy (J + x N),    d(water + air)/dt = -dN/dy,    J = -c (1 - S) D tau dx/dy
    """
    spacing = column.height / cells
    gas = column.atmosphere / (vapour_diffusion.GAS_CONSTANT * column.temperature)  # mol/m3
    per_humidity = column.saturated_pressure / column.atmosphere

    def contents(humidity):
        wet = column.saturation(humidity)
        vapour = gas * (1 - wet) * humidity * per_humidity
        return column.liquid_density / column.water_molar * wet + vapour, gas * (1 - wet) - vapour

    def rate(now, humidity):
        step = 1e-6 * humidity
        water, air = (numpy.subtract(more, less) / (2 * step) for more, less in zip(contents(humidity + step), contents(humidity - step)))
        dry = 1 - column.saturation(humidity)
        spread = gas * column.diffusivity * column.porosity ** (1 / 3) * dry ** (10 / 3)
        diffused = -(spread[1:] + spread[:-1]) / 2 * numpy.diff(humidity) * per_humidity / spacing
        fraction = (humidity[1:] + humidity[:-1]) / 2 * per_humidity
        flow = -spacing * numpy.tril(numpy.ones((cells - 1, cells))) * (water + air)  # N between the cells, per rate of each
        carried = numpy.vstack([numpy.zeros(cells), fraction[:, None] * flow, numpy.zeros(cells)])
        matrix = numpy.diag(water) + numpy.diff(carried, axis=0) / spacing
        return numpy.linalg.solve(matrix, -numpy.diff(numpy.concatenate([[0.0], diffused, [0.0]])) / spacing)

    start = numpy.where(numpy.arange(cells) < cells / 2, lower, upper)
    return solve_ivp(rate, (0, time), start, "BDF", rtol=1e-8, atol=1e-10).y[:, -1]


def check_vapour():
    cells = 60
    for name, lower, upper, numbers, time, bound in (("dry", 0.9, 0.1, {}, 0.5, 2e-3),
                                                     ("moist", 0.6001, 0.5999, {"alpha": 7e-4, "exponent": 2}, 3.0, 2e-3)):
        column = vapour_diffusion.Column(2.4e-3, **numbers)
        retardation = 1 if name == "dry" else column.retardation((lower + upper) / 2)
        y = (numpy.arange(cells) + 0.5) * column.height / cells
        exact = column.humidity(lower, upper, retardation, y, time)
        found = vapour_by_volumes(column, lower, upper, time, cells)
        yield f"vapour, {name}: series, to finite volumes", max(abs(found - exact)) / (lower - upper), bound


def check_collapse():
    yield "collapse: area under Bui's surface, to 0.2 x 0.1 m2", abs(column_collapse.bui_area() / 0.02 - 1), 0.02
    surface = column_collapse.bui_surface(column_collapse.BUI_FAILURE[:, 0])
    depth = column_collapse.BUI_FAILURE[:, 1] - surface
    yield "collapse: Bui's failure line below its surface", max(depth), column_collapse.BUI_READING
    jump = column_collapse.run_out([2.3 - 1e-9, 2.3 + 1e-9])
    yield "collapse: Lube's run-out, jump at its change", abs(jump[1] / jump[0] - 1), 0.25
    jump = column_collapse.final_height([1.15 - 1e-9, 1.15 + 1e-9])
    yield "collapse: Lube's height, jump at its change", abs(jump[1] / jump[0] - 1), 0.1


def main():
    failed = 0
    for group in (check_bar, check_wave, check_speeds, check_gas, check_box, check_vapour, check_collapse):
        for name, error, bound in group():
            met = error <= bound
            failed += not met
            print(f"{'met   ' if met else 'FAILED'} {name}: {error:.1e} (bound {bound:g})", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
