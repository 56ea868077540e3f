"""Equilibrium of the slopes under the pressures of flow.py: own small-strain FEM, NumPy and SciPy.

Eight-node quads with four integration points (no locking in isochoric plastic flow), plane strain. Net stress: total sigma =
sigma_bar - max(p, 0) I, tension positive. Mohr-Coulomb on sigma_bar with c(s) = c + s S_e tan(phi), dilation 0, returned in
principal stresses (plane, edges, apex) with the consistent tangent. Loads follow the hourly pressures, linear in between.
Elements are TOP_LAYER high in the upper 6 m and LEAST wide at crest and toe, where layers below the ground are as thin too.
Usage: mechanics.py SCENE TOP_LAYER LEAST SUBSTEPS FLOW.npz OUT.npz
"""
import sys
import time
import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu
import soil
from scene import HOURS, Scene, midpoints

YOUNG, POISSON = 1e7, 0.3
COHESION, FRICTION = 12e3, np.radians(30.0)
DRY_DENSITY = 1800.0
SHEAR = YOUNG / (2 * (1 + POISSON))
LAME = YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
NORMAL = LAME + 2 * SHEAR * np.eye(3)  # normal stresses by normal strains, 3 x 3
ELASTIC = np.block([[NORMAL[:2, :2], np.zeros((2, 1))], [np.zeros((1, 2)), np.full((1, 1), SHEAR)]])  # by xx, yy, 2xy strains
SINE, COSINE = np.sin(FRICTION), np.cos(FRICTION)
TOLERANCE = 1e-6  # of the norm of the weight


def mechanisms(kind):
    """Yield normals n and stress directions a (De : flow direction) of the active planes, ordered s1 >= s2 >= s3."""
    pairs = {"plane": [(0, 2)], "right": [(0, 2), (1, 2)], "left": [(0, 2), (0, 1)]}[kind]
    normals, directions = np.zeros((len(pairs), 3)), np.zeros((len(pairs), 3))
    for row, (major, minor) in enumerate(pairs):
        normals[row, major], normals[row, minor] = 1 + SINE, -(1 - SINE)
        directions[row, major], directions[row, minor] = 2 * SHEAR, -2 * SHEAR
    return normals, directions


def return_ordered(trial, cohesion):
    """Returned principal stresses (points, 3), descending, and d(returned)/d(trial) (points, 3, 3)."""
    stress, tangent = trial.copy(), np.tile(np.eye(3), (trial.shape[0], 1, 1))
    strength = 2 * cohesion * COSINE
    outside = trial @ mechanisms("plane")[0][0] - strength > 0
    plane = trial.copy()
    half = 0.5 * (trial @ mechanisms("plane")[0][0] - strength)
    plane[:, 0] -= half
    plane[:, 2] += half
    masks = {"plane": outside & (plane[:, 0] >= trial[:, 1]) & (plane[:, 2] <= trial[:, 1]),
             "right": outside & (plane[:, 0] < trial[:, 1]),
             "left": outside & (plane[:, 0] >= trial[:, 1]) & (plane[:, 2] > trial[:, 1])}
    for kind, mask in masks.items():
        normals, directions = mechanisms(kind)
        gain = np.linalg.solve(normals @ directions.T, normals).T @ directions  # trial excess -> stress correction
        excess = trial[mask] @ normals.T - strength[mask, None]
        stress[mask] = trial[mask] - excess @ np.linalg.solve(normals @ directions.T, np.eye(len(normals))).T @ directions
        tangent[mask] = np.eye(3) - gain.T
    tip = cohesion * COSINE / SINE
    apex = outside & ((np.diff(stress, axis=1).max(axis=1) > 1e-6) | (stress[:, 0] > tip))
    stress[apex], tangent[apex] = tip[apex, None], 0.0
    return stress, tangent, outside


def return_mapping(trial, cohesion):
    """trial (points, 4): xx, yy, xy, zz. Gives the stress, the tangent (points, 3, 3) by (xx, yy, 2xy) strains, and who yields."""
    centre, radius_x = 0.5 * (trial[:, 0] + trial[:, 1]), 0.5 * (trial[:, 0] - trial[:, 1])
    radius = np.hypot(radius_x, trial[:, 2])
    cosine = np.where(radius > 0, radius_x / np.maximum(radius, 1e-300), 1.0)
    sine = np.where(radius > 0, trial[:, 2] / np.maximum(radius, 1e-300), 0.0)
    principal = np.stack([centre + radius, centre - radius, trial[:, 3]], axis=1)
    order = np.argsort(-principal, axis=1, kind="stable")
    back = np.argsort(order, axis=1, kind="stable")
    stress, tangent, yields = return_ordered(np.take_along_axis(principal, order, 1), cohesion)
    stress = np.take_along_axis(stress, back, 1)
    tangent = np.take_along_axis(np.take_along_axis(tangent, back[:, :, None], 1), back[:, None, :], 2) @ NORMAL
    mean, half = 0.5 * (stress[:, 0] + stress[:, 1]), 0.5 * (stress[:, 0] - stress[:, 1])
    result = np.stack([mean + half * cosine, mean - half * cosine, half * sine, stress[:, 2]], axis=1)
    spin = np.where(radius > 1e-6, half / np.maximum(radius, 1e-6), 1.0) * SHEAR
    local = np.zeros_like(tangent)
    local[:, :2, :2], local[:, 2, 2] = tangent[:, :2, :2], spin
    # strains to principal axes: cosine, sine are of twice the angle
    c2, s2, cs = 0.5 * (1 + cosine), 0.5 * (1 - cosine), 0.5 * sine
    turn = np.stack([np.stack([c2, s2, cs], 1), np.stack([s2, c2, -cs], 1), np.stack([-2 * cs, 2 * cs, cosine], 1)], axis=1)
    return result, np.einsum("pki,pkl,plj->pij", turn, local, turn), yields


def shape(xi, eta):
    """Serendipity shape functions and local gradients; corners counter-clockwise, then the sides' middles."""
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    n, dx, dy = np.zeros(8), np.zeros(8), np.zeros(8)
    for k, (a, b) in enumerate(corners):
        n[k] = 0.25 * (1 + a * xi) * (1 + b * eta) * (a * xi + b * eta - 1)
        dx[k] = 0.25 * a * (1 + b * eta) * (2 * a * xi + b * eta)
        dy[k] = 0.25 * b * (1 + a * xi) * (2 * b * eta + a * xi)
    for k, b in ((4, -1), (6, 1)):
        n[k], dx[k], dy[k] = 0.5 * (1 - xi ** 2) * (1 + b * eta), -xi * (1 + b * eta), 0.5 * b * (1 - xi ** 2)
    for k, a in ((5, 1), (7, -1)):
        n[k], dx[k], dy[k] = 0.5 * (1 - eta ** 2) * (1 + a * xi), 0.5 * a * (1 - eta ** 2), -eta * (1 + a * xi)
    return n, np.stack([dx, dy])


def bilinear(xi, eta):
    """As `shape`, for the four-node quad."""
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    along, across = 1 + corners[:, 0] * xi, 1 + corners[:, 1] * eta
    return 0.25 * along * across, 0.25 * np.stack([corners[:, 0] * across, corners[:, 1] * along])


class Mechanics:
    """Eight-node quads on the lines x and z; with linear=True four-node quads with the mean dilatation (B-bar)."""

    def __init__(self, scene, x, z, linear=False):
        self.scene, self.x, self.z, self.linear = scene, x, z, linear
        self.iterations = 0
        node_x, node_z = midpoints(x), midpoints(z)
        self.grid_x, self.grid_z = np.meshgrid(node_x, node_z, indexing="ij")
        number = np.arange(self.grid_x.size).reshape(self.grid_x.shape)
        i, j = (2 * a.ravel() for a in np.meshgrid(np.arange(x.size - 1), np.arange(z.size - 1), indexing="ij"))
        # z points down: the lower side of an element has the larger z
        self.elements = np.stack([number[i, j + 2], number[i + 2, j + 2], number[i + 2, j], number[i, j],
                                  number[i + 1, j + 2], number[i + 2, j + 1], number[i + 1, j], number[i, j + 1]], axis=1)
        self.centres = number[i + 1, j + 1]
        nodes = np.stack([self.grid_x.ravel(), scene.y(self.grid_x, self.grid_z).ravel()], axis=1)
        self.nodes = nodes
        gauss = 1 / np.sqrt(3)
        places = [(-gauss, -gauss), (gauss, -gauss), (gauss, gauss), (-gauss, gauss)]
        if linear:
            self.elements = self.elements[:, :4]
        values, gradients = zip(*((bilinear if linear else shape)(*place) for place in places))
        corners = nodes[self.elements]
        jacobian = np.einsum("gdk,ekc->egdc", np.array(gradients), corners)
        self.volume = np.linalg.det(jacobian)
        assert self.volume.min() > 0
        physical = np.einsum("egcd,gdk->egck", np.linalg.inv(jacobian), np.array(gradients))
        self.values = np.array(values)
        self.points = np.einsum("gk,ekc->egc", self.values, corners).reshape(-1, 2)
        count, freedoms = self.elements.shape[0], 2 * self.elements.shape[1]
        self.strain_matrix = np.zeros((count, 4, 3, freedoms))
        self.strain_matrix[:, :, 0, 0::2], self.strain_matrix[:, :, 1, 1::2] = physical[:, :, 0], physical[:, :, 1]
        self.strain_matrix[:, :, 2, 0::2], self.strain_matrix[:, :, 2, 1::2] = physical[:, :, 1], physical[:, :, 0]
        if linear:
            dilatation = self.strain_matrix[:, :, 0] + self.strain_matrix[:, :, 1]
            mean = np.einsum("egk,eg->ek", dilatation, self.volume) / self.volume.sum(axis=1)[:, None]
            self.strain_matrix[:, :, :2] += 0.5 * (mean[:, None] - dilatation)[:, :, None]
        self.freedoms = (2 * self.elements[:, :, None] + np.arange(2)).reshape(count, freedoms)
        self.size = nodes.size
        used = np.zeros(self.size, bool)
        used[self.freedoms.ravel()] = True
        used[0::2] &= ~((nodes[:, 0] < 1e-9) | (nodes[:, 0] > scene.right - 1e-9))
        used[0::2] &= nodes[:, 1] > 1e-9
        used[1::2] &= nodes[:, 1] > 1e-9
        self.free = np.flatnonzero(used)
        place = np.full(self.size, -1)
        place[self.free] = np.arange(self.free.size)
        rows, columns = np.repeat(place[self.freedoms], freedoms, 1).ravel(), np.tile(place[self.freedoms], (1, freedoms)).ravel()
        self.kept = (rows >= 0) & (columns >= 0)
        self.rows, self.columns = rows[self.kept], columns[self.kept]
        self.stress = np.zeros((4 * count, 4))
        self.displacement = np.zeros(self.size)

    def scatter(self, element_vectors):
        return np.bincount(self.freedoms.ravel(), element_vectors.ravel(), minlength=self.size)

    def forces(self, stress, pressure):
        """Internal minus external nodal forces; and the weight alone."""
        total = stress[:, :3].copy()
        total[:, :2] -= np.maximum(pressure, 0.0)[:, None]
        total = total.reshape(-1, 4, 3) * self.volume[:, :, None]
        density = DRY_DENSITY + soil.POROSITY * soil.saturation(pressure) * soil.WATER_DENSITY
        weight = np.zeros(self.freedoms.shape)
        weight[:, 1::2] = -soil.GRAVITY * (density.reshape(-1, 4) * self.volume) @ self.values
        return self.scatter(np.einsum("egik,egi->ek", self.strain_matrix, total)) - self.scatter(weight), self.scatter(weight)

    def strain(self, u):
        return np.einsum("egik,ek->egi", self.strain_matrix, u[self.freedoms]).reshape(-1, 3)

    def solve(self, tangent, right):
        weighted = tangent.reshape(-1, 4, 3, 3) * self.volume[:, :, None, None]
        stiffness = np.einsum("egik,egij,egjl->ekl", self.strain_matrix, weighted, self.strain_matrix, optimize=True)
        matrix = coo_matrix((stiffness.ravel()[self.kept], (self.rows, self.columns))).tocsc()
        change = np.zeros(self.size)
        change[self.free] = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.01,
                                 options={"SymmetricMode": True}).solve(right[self.free])
        return change

    def trial(self, increment):
        strain = self.strain(increment)
        volumetric = strain[:, 0] + strain[:, 1]
        trial = self.stress.copy()
        trial[:, :2] += LAME * volumetric[:, None] + 2 * SHEAR * strain[:, :2]
        trial[:, 2] += SHEAR * strain[:, 2]
        trial[:, 3] += LAME * volumetric
        return trial

    def gravity(self, pressure):
        """Elastic gravity, then Mohr-Coulomb equilibrium; displacement counts from there."""
        residual, _ = self.forces(self.stress, pressure)
        self.stress = self.trial(self.solve(np.tile(ELASTIC, (self.stress.shape[0], 1, 1)), -residual))
        if not self.step(pressure, pressure):
            raise RuntimeError("no initial equilibrium")
        self.displacement[:] = 0.0

    def step(self, old, new, depth=0):
        """Equilibrium at the pressures `new`; halves the step, then gives up: False (state of the last equilibrium kept)."""
        if self.equilibrium(new):
            return True
        if depth == 6:
            return False
        middle = 0.5 * (old + new)
        return self.step(old, middle, depth + 1) and self.step(middle, new, depth + 1)

    def equilibrium(self, pressure):
        """Newton, full steps first: points that switch between plane and edge raise the residual on the way, and a search
        by its norm can cycle. Where full steps cycle, with a search; last damped, with a little of the elastic tangent."""
        return self.iterate(pressure, 20) or self.iterate(pressure, 25, search=True) or self.iterate(pressure, 60, 0.5, 0.02)

    def iterate(self, pressure, largest, damping=1.0, elastic_part=0.0, search=False):
        suction = np.maximum(-pressure, 0.0)
        cohesion = COHESION + suction * soil.saturation(pressure) * np.tan(FRICTION)

        def state(increment):
            stress, tangent, yields = return_mapping(self.trial(increment), cohesion)
            residual, weight = self.forces(stress, pressure)
            return increment, stress, tangent, yields, residual, np.linalg.norm(residual[self.free]) / np.linalg.norm(weight)

        found = state(np.zeros(self.size))
        for _ in range(largest):
            increment, stress, tangent, yields, residual, norm = found
            if norm < TOLERANCE:
                self.stress, self.displacement, self.yields = stress, self.displacement + increment, yields
                return True
            if not norm < 1.0:
                return False
            self.iterations += 1
            try:
                change = self.solve((1 - elastic_part) * tangent + elastic_part * ELASTIC, -residual)
            except RuntimeError:  # an exactly singular tangent
                return False
            found = state(increment + damping * change)
            part = damping
            while search and part > 0.1 and found[-1] > (1 - 0.1 * part) * norm:
                part *= 0.5
                found = min(found, state(increment + part * change), key=lambda one: one[-1])
        return False

    def volumetric_strain(self):
        """Of the displacement, at the mesh's corner nodes: extrapolated from the integration points and averaged."""
        strain = self.strain(self.displacement)
        at_points = (strain[:, 0] + strain[:, 1]).reshape(-1, 4)
        root = np.sqrt(3)
        corner = np.array([[0.25 * (1 + root * a * c) * (1 + root * b * d) for c, d in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
                           for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
        values = np.bincount(self.elements[:, :4].ravel(), (at_points @ corner.T).ravel(), minlength=self.nodes.shape[0])
        counts = np.bincount(self.elements[:, :4].ravel(), minlength=self.nodes.shape[0])
        shape = self.grid_x.shape
        return (values / np.maximum(counts, 1)).reshape(shape)[::2, ::2]

    def displacements(self):
        """(2, i, j) on the tensor grid of nodes, the elements' centres from their shape functions."""
        u = self.displacement.reshape(-1, 2).copy()
        if self.linear:
            return np.moveaxis(u.reshape(*self.grid_x.shape, 2)[::2, ::2], -1, 0)
        u[self.centres] = np.einsum("k,ekc->ec", shape(0.0, 0.0)[0], u[self.elements])
        return np.moveaxis(u.reshape(*self.grid_x.shape, 2), -1, 0)


def main():
    name, top, least, substeps, source, out = sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4]), *sys.argv[5:7]
    scene, data, started = Scene(name), np.load(source), time.time()
    mechanics = Mechanics(scene, scene.columns(least, 4 * top, 1.15 if least == top else 1.25),
                          scene.layers(top, int(round(6 / top ** 0.5)), least))
    print(f"{name}: {mechanics.elements.shape[0]} elements, {mechanics.free.size} unknowns", flush=True)
    x, y = mechanics.points.T
    places = np.stack([x, scene.z(x, y)], axis=1)
    pressures = [RegularGridInterpolator((data["x"], data["z"]), p.astype(float))(places) for p in data["pressure"]]
    markers = [np.argmin(np.hypot(*(mechanics.nodes - place).T)) for place in scene.markers.values()]
    mechanics.gravity(pressures[0])
    strains, displacements = [mechanics.volumetric_strain()], [mechanics.displacements()]
    print(f"  start: {mechanics.yields.sum()} of {x.size} points yield", flush=True)
    for hour in range(1, len(pressures)):
        for part in range(substeps):
            mix = lambda f: (1 - f) * pressures[hour - 1] + f * pressures[hour]
            if not mechanics.step(mix(part / substeps), mix((part + 1) / substeps)):
                raise RuntimeError(f"no equilibrium found in hour {hour}")
        strains.append(mechanics.volumetric_strain())
        displacements.append(mechanics.displacements())
        u = 1e3 * mechanics.displacement.reshape(-1, 2)[markers]
        print(f"  {hour} h: mm at {', '.join(scene.markers)}: {np.array2string(u, precision=3).replace(chr(10), '')}; "
              f"{mechanics.yields.sum()} yield, {mechanics.iterations} iterations, {time.time() - started:.0f} s", flush=True)
    np.savez_compressed(out, x=mechanics.x, z=mechanics.z, volumetric_strain=np.array(strains),
                        node_x=midpoints(mechanics.x), node_z=midpoints(mechanics.z), displacement=np.array(displacements))


if __name__ == "__main__":
    main()
