"""Pore water in the slopes, FEniCSx: second-order quads in p, k_r at quadrature points, mixed form, SDIRK2.

w = -(K k_r / rho g)(grad p + rho g e_y); the water mass n S (1 + p/K_l) is balanced exactly by each stage. The volumetric strain
of mechanics.py enters as the source -S d(eps_v)/dt when a strain file is given. Rain is a flux rain * n_y on the ground;
where p would exceed 0 there, water leaves through a film of 1e-6 m/s per Pa (so p stays below 4 Pa).
Usage: flow.py SCENE TOP_LAYER LEAST_COLUMN STEP_S OUT.npz [STRAIN.npz]
"""
import sys
import time
import numpy as np
import ufl
from mpi4py import MPI
from petsc4py import PETSc
from dolfinx import fem, mesh
from dolfinx.fem import petsc
import soil
from scene import HOURS, RAIN, SURFACE_PRESSURE, WATER_LEVEL, Scene, midpoints

WEIGHT = soil.WATER_DENSITY * soil.GRAVITY
GAMMA = 1 - 1 / np.sqrt(2)
FILM = 1e-6  # m/s per Pa
SMALL = 1e-7  # of the rain on a typical node: the norm where Newton stops


def saturation(p):
    suction = ufl.max_value(-p, 0.0)
    return (1 + (soil.ALPHA * suction) ** soil.EXPONENT_N) ** (-soil.EXPONENT_M)


def permeability(p):
    """soil.permeability in UFL."""
    suction = ufl.max_value(-p, 0.0)
    a = (soil.ALPHA * ufl.max_value(suction, soil.CHORD)) ** soil.EXPONENT_N
    mualem = (1 + a) ** (-0.5 * soil.EXPONENT_M) * (1 - (a / (1 + a)) ** soil.EXPONENT_M) ** 2
    rounded = ufl.conditional(ufl.lt(suction, soil.ROUNDING), 0.5 * suction ** 2 / soil.ROUNDING, suction - 0.5 * soil.ROUNDING)
    chord = 1 - (1 - soil.CHORD_VALUE) * rounded / (soil.CHORD - 0.5 * soil.ROUNDING)
    return ufl.conditional(ufl.lt(suction, soil.CHORD), chord, mualem)


def mass(p):
    return soil.POROSITY * saturation(p) * (1 + p / soil.WATER_STIFFNESS)


def quad_mesh(x, z, height_of):
    """Quads between the lines x and z; node (i, j) at index i * len(z) + j."""
    grid_x, grid_z = np.meshgrid(x, z, indexing="ij")
    points = np.stack([grid_x.ravel(), height_of(grid_x, grid_z).ravel()], axis=1)
    i, j = np.meshgrid(np.arange(x.size - 1), np.arange(z.size - 1), indexing="ij")
    corner = (i * z.size + j).ravel()
    cells = np.stack([corner + 1, corner + 1 + z.size, corner, corner + z.size], axis=1)
    element = ufl.Mesh(ufl.VectorElement("Lagrange", "quadrilateral", 1))
    return mesh.create_mesh(MPI.COMM_SELF, cells.astype(np.int64), points, element)


class Flow:
    """Unknown p on quads of the given degree; lumped=True puts the mass at the nodes (degree 1 only)."""

    def __init__(self, scene, x, z, degree=2, lumped=False, small=SMALL):
        self.scene, self.x, self.z, self.small = scene, x, z, small
        self.domain = quad_mesh(x, z, scene.y)
        self.space = fem.FunctionSpace(self.domain, ("Lagrange", degree))
        make = lambda: fem.Function(self.space)
        self.p, self.old, self.first, self.strain_rate = make(), make(), make(), make()
        scalar = lambda value: fem.Constant(self.domain, PETSc.ScalarType(value))
        self.rate_factor, self.first_weight = scalar(0.0), scalar(0.0)
        self.rain, self.film = scalar(0.0), scalar(0.0)
        self.forms(degree, lumped)
        self.node_order()
        self.solver = PETSc.KSP().create(MPI.COMM_SELF)
        self.solver.setType("preonly")
        self.solver.getPC().setType("lu")
        self.solver.getPC().setFactorSolverType("klu")
        self.iterations = 0

    def forms(self, degree, lumped):
        v = ufl.TestFunction(self.space)
        p, ground = self.p, self.ground_facets()
        tags = mesh.meshtags(self.domain, 1, ground, np.full(ground.size, 1, dtype=np.int32))
        ds = ufl.Measure("ds", domain=self.domain, subdomain_data=tags, metadata={"quadrature_degree": 2 * degree})(1)
        dx = ufl.Measure("dx", domain=self.domain, metadata={"quadrature_degree": 2 * degree})
        dx_mass = dx
        if lumped:
            dx_mass = ufl.Measure("dx", domain=self.domain, metadata={"quadrature_rule": "GLL", "quadrature_degree": 1})
        up = ufl.as_vector([0.0, 1.0])
        gained = mass(p) - mass(self.old) - self.first_weight * (mass(self.first) - mass(self.old))
        flux = soil.CONDUCTIVITY / WEIGHT * permeability(p) * (ufl.grad(p) + WEIGHT * up)
        inflow = self.rain * ufl.FacetNormal(self.domain)[1] - self.film * ufl.max_value(p, 0.0)
        residual = (self.rate_factor * gained + saturation(p) * self.strain_rate) * v * dx_mass \
            + ufl.inner(flux, ufl.grad(v)) * dx - inflow * v * ds
        self.residual = fem.form(residual)
        self.jacobian = fem.form(ufl.derivative(residual, p))
        self.frozen = fem.form(soil.CONDUCTIVITY / WEIGHT * permeability(p) * ufl.inner(ufl.grad(ufl.TrialFunction(self.space)), ufl.grad(v)) * dx)
        self.stored = fem.form(mass(p) * dx_mass)
        self.seepage = fem.form(self.film * ufl.max_value(p, 0.0) * ds)
        self.matrix = petsc.create_matrix(self.jacobian)

    def ground_facets(self):
        on_ground = lambda c: np.abs(c[1] - self.scene.height(c[0])) < 1e-9
        return np.sort(mesh.locate_entities_boundary(self.domain, 1, on_ground))

    def node_order(self):
        """grid[i, j]: degree of freedom of the tensor grid's node (x_i, z_j)."""
        coordinates = self.space.tabulate_dof_coordinates()[:, :2]
        degree = self.space.ufl_element().degree()
        self.node_x = midpoints(self.x) if degree == 2 else self.x
        self.node_z = midpoints(self.z) if degree == 2 else self.z
        column = np.argmin(np.abs(coordinates[:, 0, None] - self.node_x), axis=1)
        depth = self.scene.z(self.node_x[column], coordinates[:, 1])
        row = np.argmin(np.abs(depth[:, None] - self.node_z), axis=1)
        self.grid = np.full((self.node_x.size, self.node_z.size), -1)
        self.grid[column, row] = np.arange(coordinates.shape[0])
        assert self.grid.min() == 0
        sides = np.abs(coordinates[:, 0] * (coordinates[:, 0] - self.scene.right)) < 1e-9
        self.side_nodes = np.flatnonzero(sides & (coordinates[:, 1] <= WATER_LEVEL + 1e-9)).astype(np.int32)
        self.side_pressure = WEIGHT * (WATER_LEVEL - coordinates[self.side_nodes, 1])
        self.ground_nodes = self.grid[:, 0].astype(np.int32)

    def conditions(self, steady):
        held = fem.Function(self.space)
        held.x.array[self.side_nodes] = self.side_pressure
        nodes = self.side_nodes
        if steady:
            held.x.array[self.ground_nodes] = SURFACE_PRESSURE
            nodes = np.union1d(nodes, self.ground_nodes).astype(np.int32)
        self.held_nodes = nodes
        self.p.x.array[nodes] = held.x.array[nodes]
        self.bcs = [fem.dirichletbc(held, nodes)]

    def assemble_residual(self):
        value = petsc.assemble_vector(self.residual).array.copy()
        value[self.held_nodes] = 0.0
        return value

    def linear_solve(self, form, value):
        self.matrix.zeroEntries()
        petsc.assemble_matrix(self.matrix, form, bcs=self.bcs)
        self.matrix.assemble()
        self.solver.setOperators(self.matrix)
        right, change = self.matrix.createVecLeft(), self.matrix.createVecRight()
        right.array[:] = value
        self.solver.solve(right, change)
        self.iterations += 1
        return change.array.copy()

    def newton(self, scale, largest=15):
        """Damped Newton on self.p; True when the residual's norm is below self.small * scale."""
        value = self.assemble_residual()
        norm = np.linalg.norm(value)
        for _ in range(largest):
            if norm < self.small * scale:
                return True
            change = self.linear_solve(self.jacobian, value)
            start, damping = self.p.x.array.copy(), 1.0
            while True:
                self.p.x.array[:] = start - damping * change
                value = self.assemble_residual()
                new_norm = np.linalg.norm(value)
                if new_norm < (1 - 1e-3 * damping) * norm:
                    break
                damping *= 0.5
                if damping < 0.03:
                    return False
            norm = new_norm
        return False

    def steady(self):
        """Steady state with p held on the whole ground: damped Picard (k_r frozen), which never stalls, then Newton."""
        y = self.space.tabulate_dof_coordinates()[:, 1]
        self.p.x.array[:] = np.maximum(WEIGHT * (WATER_LEVEL - y), SURFACE_PRESSURE)
        self.conditions(True)
        self.rate_factor.value = 0.0
        change = np.inf
        while change > 200.0:
            update = self.linear_solve(self.frozen, self.assemble_residual())
            self.p.x.array[:] -= 0.5 * update
            change = np.abs(update).max()
        if not self.newton(1e-8):
            raise RuntimeError("no steady state")
        self.conditions(False)

    def advance(self, step, scale):
        """One SDIRK2 step from self.p; False (and p unchanged) when Newton fails."""
        self.old.x.array[:] = self.p.x.array
        self.rate_factor.value = 1 / (GAMMA * step)
        for weight in (0.0, (1 - GAMMA) / GAMMA):
            self.first_weight.value = weight
            self.first.x.array[:] = self.p.x.array if weight else self.old.x.array
            if not self.newton(scale):
                self.p.x.array[:] = self.old.x.array
                return False
        return True

    def storm(self, largest_step, strain=None, hours=HOURS, report=None):
        """Rain for `hours`; calls report(time) at the start and after every step that ends a report interval."""
        self.rain.value, self.film.value = RAIN, FILM
        scale = RAIN * self.scene.right / np.sqrt(self.x.size)
        time_now, step = 0.0, 1.0
        report(time_now)
        while time_now < hours * 3600 - 1e-6:
            hour = int((time_now + 1e-6) // 3600)
            if strain is not None:
                self.strain_rate.x.array[self.grid] = strain[hour]
            # whole fractions of the hour keep the strain rate's jumps on the steps
            left = (hour + 1) * 3600 - time_now
            trial = left / np.ceil(left / min(step, largest_step) - 1e-9)
            if self.advance(trial, scale):
                time_now += trial
                step = min(1.3 * max(step, trial), 1.3 * largest_step)
                report(time_now)
            else:
                step = 0.4 * trial
                if step < 1e-3:
                    raise RuntimeError(f"step collapsed at {time_now} s")


def strain_rates(file, flow):
    """Hourly rates of the volumetric strain at the flow's nodes, from mechanics.py."""
    from scipy.interpolate import RegularGridInterpolator
    data = np.load(file)
    points = np.stack(np.meshgrid(flow.node_x, flow.node_z, indexing="ij"), axis=-1)
    inside = RegularGridInterpolator((data["x"], data["z"]), np.moveaxis(data["volumetric_strain"], 0, -1),
                                     bounds_error=False, fill_value=None)(points)
    return np.moveaxis(np.diff(inside, axis=-1), -1, 0) / 3600.0


def main():
    name, top, least, step, out = sys.argv[1], *map(float, sys.argv[2:5]), sys.argv[5]
    scene = Scene(name)
    flow = Flow(scene, scene.columns(least, 6 * least), scene.layers(top, int(round(1.2 / top ** 0.85))))
    print(f"{name}: {flow.domain.topology.index_map(2).size_local} cells, {flow.grid.size} nodes", flush=True)
    flow.steady()
    strain = strain_rates(sys.argv[6], flow) if len(sys.argv) > 6 else None
    started, times, probes, fields, outflow = time.time(), [], [], [], [0.0]
    index = {key: (np.argmin(np.abs(flow.node_x - x)), np.argmin(np.abs(flow.node_z - scene.z(x, y))))
             for key, (x, y) in scene.probes.items()}

    def report(now):
        outflow[0] += fem.assemble_scalar(flow.seepage) * (now - times[-1] if times else 0.0)
        times.append(now)
        probes.append([flow.p.x.array[flow.grid[ij]] for ij in index.values()])
        if abs(now / 3600 - round(now / 3600)) < 1e-9:
            fields.append(flow.p.x.array[flow.grid].copy())
            print(f"{now / 3600:.0f} h: {' '.join(f'{p:.1f}' for p in probes[-1])} Pa, {len(times)} steps, {flow.iterations} "
                  f"iterations, seepage {outflow[0]:.3e} m2, stored {fem.assemble_scalar(flow.stored):.6f} m2, {time.time() - started:.0f} s", flush=True)

    flow.storm(step, strain, report=report)
    np.savez_compressed(out, x=flow.node_x, z=flow.node_z, pressure=np.array(fields, dtype=np.float32),
                        times=times, probes=probes, names=list(index))


if __name__ == "__main__":
    main()
