"""Factor of safety of the slope by limit analysis: lower and upper bounds of its collapse under given pore pressures.

Plane strain, Mohr-Coulomb with an associated flow rule on the net stress: total sigma = sigma_bar - max(p, 0) I, tension
positive, cohesion c + s S_e tan(phi), weight dry density + n S water density, all linear between the mesh's nodes but the weight,
constant in a triangle. The factor F divides cohesion and tan(phi) until the ground is at its limit.

The finite-element bounds are second-order cone programs of one kind, solved by a primal-dual interior-point method
(Nesterov-Todd scaling, predictor and corrector, sparse LU):
    min m  such that  A z + a m = b, z in K        and its dual        max b.y  such that  a.y = 1, -A^T y in K,
K a product of cones z0 >= |(z1, z2)|, m the multiplier of the cohesion; F is the root of m(F) = 1.
- Lower bound: stresses linear in triangles, discontinuous across edges (Lyamin & Sloan 2002, Makrodimopoulos & Martin 2006):
  equilibrium in each triangle, equal tractions on the two sides of an edge, none on the ground, no shear at the sides, any at the
  base; the yield condition at the three corners.
- Upper bound: quadratic continuous velocities in straight triangles (Makrodimopoulos & Martin 2007): the flow rule at the three
  corners holds everywhere, as strain rates are linear; the dissipation c cot(phi) div(v) is integrated exactly. Fixed base, sides
  on rollers.
- Spiral: the upper bound by a rigid rotation on a log spiral from the crest to the ground, the worst of all spirals.
With dilation 0 the soil is weaker than its bounds: Davis' reduced strength, eta c and eta tan(phi) with eta = cos(phi), gives the
usual estimate eta F. It is no bound; where it is above 1 collapse is not to be expected.

Usage: limit_analysis.py known [SIZE]                            stability numbers of slopes with known answers
       limit_analysis.py pressures SCENE.json HOURS OUT.npz      Talus's pressures with a rigid skeleton, rain for HOURS
       limit_analysis.py slope FLOW.npz OUT.csv [SIZE [CASES]]   bounds; FLOW.npz as above or of `flow.py slope`; triangles
                                                                 of SIZE m along the face; CASES HOUR:KPA,... for others
       limit_analysis.py infinite FLOW.npz HOUR KPA              factor of the infinite slope with depth at mid-face
"""
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path
import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.optimize import minimize
from scipy.sparse import coo_matrix, csr_matrix, diags
from scipy.sparse.linalg import splu
import soil
from mechanics import DRY_DENSITY, FRICTION as FRICTION_ANGLE
from scene import Scene

FRICTION, BASE = np.tan(FRICTION_ANGLE), 0.0
ROOT = Path(__file__).resolve().parents[3]
GROUND = [(0.0, 30.0), (20.0, 30.0), (40.0, 10.0), (60.0, 10.0)]
UNIT = 1e5  # Pa: stresses of order one inside the solver
CASES = {0: (12, 8, 4, 1, 0), 12: (12, 8, 4), 24: (12, 8, 4), 30: (12, 8, 4, 1), 36: (12, 8, 6, 4, 2, 1, 0), 42: (8, 4),
         48: (12, 8, 6, 4, 2), 60: (12, 8, 4), 72: (12, 8, 4), 96: (12, 8)}  # kPa by hour


# The cone program -----------------------------------------------------------------------------------------------------------

def determinant(u):
    radius = np.hypot(u[:, 1], u[:, 2])
    return (u[:, 0] - radius) * (u[:, 0] + radius)


def product(u, v):
    return np.column_stack([(u * v).sum(1), u[:, :1] * v[:, 1:] + v[:, :1] * u[:, 1:]])


def quotient(u, r):
    """v with product(u, v) = r."""
    first = (u[:, 0] * r[:, 0] - u[:, 1] * r[:, 1] - u[:, 2] * r[:, 2]) / determinant(u)
    return np.column_stack([first, (r[:, 1:] - first[:, None] * u[:, 1:]) / u[:, :1]])


def longest_step(u, d):
    """Largest t <= 1 such that every cone of u + t d is kept."""
    a, b, c = determinant(d), u[:, 0] * d[:, 0] - u[:, 1] * d[:, 1] - u[:, 2] * d[:, 2], determinant(u)
    root = np.sqrt(np.maximum(b * b - a * c, 0))
    with np.errstate(all="ignore"):
        far = np.where(b < 0, c / (-b + root), np.where(a < 0, (-b - root) / a, np.inf))  # first root of a t^2 + 2 b t + c
        far = np.where((b * b < a * c), np.inf, far)
        apex = np.where(d[:, 0] < 0, -u[:, 0] / d[:, 0], np.inf)
    return min(1.0, np.minimum(far, apex).min())


class Scaling:
    """Nesterov-Todd scaling: the symmetric W with W s = W^-1 z."""

    def __init__(self, z, s):
        dz, ds = np.sqrt(determinant(z)), np.sqrt(determinant(s))
        self.eta = np.sqrt(dz / ds)
        zbar, sbar = z / dz[:, None], s / ds[:, None]
        half = np.sqrt(0.5 * (1 + (zbar * sbar).sum(1)))
        self.w = (zbar + sbar * [1, -1, -1]) / (2 * half[:, None])

    def _apply(self, u, sign):
        w0, w1 = self.w[:, :1], sign * self.w[:, 1:]
        inner = (w1 * u[:, 1:]).sum(1, keepdims=True)
        return np.column_stack([w0 * u[:, :1] + inner, w1 * u[:, :1] + u[:, 1:] + w1 * inner / (1 + w0)])

    def __call__(self, u):
        return self.eta[:, None] * self._apply(u, 1)

    def inverse(self, u):
        return self._apply(u, -1) / self.eta[:, None]

    def square(self):
        count = len(self.w)
        blocks = (2 * self.w[:, :, None] * self.w[:, None, :] - np.diag([1.0, -1, -1])) * (self.eta ** 2)[:, None, None]
        index = np.arange(3 * count).reshape(count, 3)
        rows, columns = np.repeat(index, 3, axis=1).ravel(), np.tile(index, (1, 3)).ravel()
        return csr_matrix((blocks.ravel(), (rows, columns)), shape=(3 * count, 3 * count))


def solve_cone_program(matrix, multiplier, right, tolerance=1e-6):
    """m of the pair of programs above, by either of them, and the largest relative residual."""
    matrix = csr_matrix(matrix)
    scale = 1 / np.sqrt(np.maximum(np.asarray(matrix.multiply(matrix).sum(1)).ravel(), 1e-300))
    matrix, multiplier, right = diags(scale) @ matrix, scale * multiplier, scale * right
    transposed = matrix.T.tocsr()
    rows, count = matrix.shape[0], matrix.shape[1] // 3
    unit = np.tile([1.0, 0, 0], (count, 1))
    z, s, y, m = unit.copy(), unit.copy(), np.zeros(rows), 1.0
    flat = lambda u: u.ravel()
    cone = lambda v: v.reshape(count, 3)
    best = None
    for _ in range(100):
        primal = right - matrix @ flat(z) - multiplier * m
        dual = cone(-(transposed @ y) - flat(s))
        normal = 1 - multiplier @ y
        gap = (z * s).sum()
        errors = (np.abs(primal).max() / (1 + np.abs(right).max()), np.abs(dual).max() / (1 + np.abs(s).max()), abs(normal),
                  abs(m - right @ y) / (1 + abs(m)))
        if best is None or max(errors) < best[0]:
            best = (max(errors), m, right @ y)
        at_end = min(determinant(z).min(), determinant(s).min()) <= 0  # of the digits
        if max(errors) < tolerance or at_end or (max(errors) > 1e3 * best[0] and best[0] < 1e-5):
            break
        scaling = Scaling(z, s)
        square = scaling.square()
        normal_matrix = (matrix @ square @ transposed).tocsc()
        diagonal = normal_matrix.diagonal()
        factor = splu(normal_matrix + diags(1e-13 * diagonal + 1e-15 * diagonal.max()), permc_spec="COLAMD",
                      diag_pivot_thresh=0.0, options={"SymmetricMode": True})

        def solve(v):
            x = factor.solve(v)
            for _ in range(2):
                x = x + factor.solve(v - normal_matrix @ x)
            return x

        column = solve(multiplier)
        point = scaling.inverse(z)

        def direction(complementarity, share):
            q = quotient(point, complementarity)
            rest = share * primal - matrix @ flat(scaling(q)) + share * (matrix @ (square @ flat(dual)))
            y0 = solve(rest)
            dm = (multiplier @ y0 - share * normal) / (multiplier @ column)
            dy = y0 - dm * column
            ds = share * dual - cone(transposed @ dy)
            dz = scaling(q) - cone(square @ flat(ds))
            return dz, ds, dy, dm

        dz, ds, dy, dm = direction(-product(point, point), 1.0)
        step = min(longest_step(z, dz), longest_step(s, ds))
        after = ((z + step * dz) * (s + step * ds)).sum()
        centring = min(max(after / gap, 0.0), 1.0) ** 3
        target = centring * gap / count * unit - product(point, point) - product(scaling(ds), scaling.inverse(dz))
        dz, ds, dy, dm = direction(target, 1 - centring)
        step = min(1.0, 0.98 * min(longest_step(z, dz), longest_step(s, ds)))
        z, s, y, m = z + step * dz, s + step * ds, y + step * dy, m + step * dm
    error, m, dual_value = best
    return m, dual_value, error


# The mesh -------------------------------------------------------------------------------------------------------------------

class Mesh:
    """Triangles of gmsh between the ground, a polyline from left to right, and the level base."""

    def __init__(self, ground, base, size, far, face, depth):
        """`size` within `depth` of the ground between the indices `face`, growing to `far`."""
        corners = [(ground[0][0], base), *ground, (ground[-1][0], base)][::-1]
        count, lines = len(corners), []
        for k, (x, y) in enumerate(corners, 1):
            lines.append(f"Point({k}) = {{{x}, {y}, 0, {far}}};")
        for k in range(1, count + 1):
            lines.append(f"Line({k}) = {{{k}, {k % count + 1}}};")
        lines += [f"Line Loop(1) = {{{', '.join(str(k) for k in range(1, count + 1))}}};", "Plane Surface(1) = {1};"]
        (xa, ya), (xb, yb) = ground[face[0]], ground[face[1]]
        steps = 200
        for k in range(steps + 1):
            lines.append(f"Point({100 + k}) = {{{xa + (xb - xa) * k / steps}, {ya + (yb - ya) * k / steps}, 0, {far}}};")
        lines += ["Field[1] = Distance;", f"Field[1].NodesList = {{{', '.join(str(100 + k) for k in range(steps + 1))}}};",
                  "Field[2] = Threshold;", "Field[2].IField = 1;", f"Field[2].LcMin = {size};", f"Field[2].LcMax = {far};",
                  f"Field[2].DistMin = {depth};", f"Field[2].DistMax = {depth + 6 * (far - size)};", "Background Field = 2;",
                  "Mesh.CharacteristicLengthExtendFromBoundary = 0;", "Mesh.CharacteristicLengthFromPoints = 0;"]
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "slope.geo").write_text("\n".join(lines))
            subprocess.run(["gmsh", "-2", "-format", "msh22", "-o", f"{folder}/slope.msh", f"{folder}/slope.geo"], check=True,
                           stdout=subprocess.DEVNULL)
            text = Path(folder, "slope.msh").read_text().splitlines()
        start = text.index("$Nodes") + 2
        rows = [line.split() for line in text[start:text.index("$EndNodes")]]
        place = {int(r[0]): (float(r[1]), float(r[2])) for r in rows}
        start = text.index("$Elements") + 2
        elements = [list(map(int, line.split())) for line in text[start:text.index("$EndElements")]]
        triangles = np.array([e[-3:] for e in elements if e[1] == 2])
        used = np.unique(triangles)
        self.nodes = np.array([place[k] for k in used])
        self.triangles = np.searchsorted(used, triangles)
        corner = self.nodes[self.triangles]
        area = 0.5 * np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        self.triangles[area < 0] = self.triangles[area < 0][:, ::-1]
        corner = self.nodes[self.triangles]
        self.area = np.abs(area)
        opposite = corner[:, [2, 0, 1]] - corner[:, [1, 2, 0]]
        turned = np.stack([-opposite[:, :, 1], opposite[:, :, 0]], 2)
        self.gradient = turned / (2 * self.area)[:, None, None]  # of the corners' functions
        pairs = self.triangles[:, [[0, 1], [1, 2], [2, 0]]]
        ordered = np.sort(pairs.reshape(-1, 2), axis=1)
        self.edges, inverse, number = np.unique(ordered, axis=0, return_inverse=True, return_counts=True)
        self.edge_of = inverse.reshape(-1, 3)
        self.boundary = number == 1
        left, right = self.nodes[:, 0].min(), self.nodes[:, 0].max()
        ends = self.nodes[self.edges]
        at = lambda x: (np.abs(ends[:, :, 0] - x) < 1e-6).all(1)
        self.at_side = self.boundary & (at(left) | at(right))
        self.at_base = self.boundary & (np.abs(ends[:, :, 1] - base) < 1e-6).all(1)
        self.at_ground = self.boundary & ~self.at_side & ~self.at_base


# The two bounds -------------------------------------------------------------------------------------------------------------

class Bound:
    """m(F) of one mesh; `cohesion` (Pa) and `pressure` at the nodes, `weight` (N/m3) of the triangles."""

    def __init__(self, mesh, cohesion, friction, weight, pressure):
        self.mesh, self.cohesion, self.friction = mesh, cohesion[mesh.triangles] / UNIT, friction
        positive = np.maximum(pressure, 0)[mesh.triangles]
        push = np.einsum("ek,ekd->ed", positive, mesh.gradient)  # gradient of max(p, 0)
        self.force = (np.stack([np.zeros(len(weight)), -weight], 1) - push) / UNIT  # on sigma_bar
        self.water = np.maximum(pressure, 0) / UNIT

    def factor(self, guess=1.2, tolerance=2e-3):
        """F with m(F) = 1, by secants in log F; the last is not checked (second order in the tolerance)."""
        x, values = [np.log(guess)], []
        for _ in range(12):
            values.append(np.log(max(self.multiplier(np.exp(x[-1])), 1e-3)))
            slope = (values[-1] - values[-2]) / (x[-1] - x[-2]) if len(x) > 1 else 1.8
            x.append(x[-1] - values[-1] / slope)
            if len(values) > 1 and abs(values[-1]) < tolerance:
                return float(np.exp(x[-1]))
        raise RuntimeError(f"no factor found: {np.exp(x)} {values}")

    def _finish(self, matrix, multiplier, right):
        m, dual, error = solve_cone_program(matrix, multiplier, right)
        if error > 1e-4:
            raise RuntimeError(f"the cone program ended with residual {error:.1e}")
        return self.value(m, dual)


class LowerBound(Bound):
    value = staticmethod(lambda m, dual: m)

    def multiplier(self, factor):
        mesh, count = self.mesh, len(self.mesh.triangles)
        angle = np.arctan(self.friction / factor)
        # stresses at a corner by the cone's variables and m: P = (m c cos - z0) / sin, xx = P + z1, yy = P - z1, xy = z2
        pressure_part = self.cohesion / factor * np.cos(angle) / np.sin(angle)
        cells = np.arange(count)
        rows, columns, values, known, right = [], [], [], [], []
        total = 0

        def normal_terms(row, triangle, corner, nx, ny):
            """sigma . n at a corner into rows row (x) and row + 1 (y)."""
            base = 3 * (3 * triangle + corner)
            for offset, (a0, a1, a2) in enumerate([(-nx / np.sin(angle), nx, ny), (-ny / np.sin(angle), -ny, nx)]):
                for k, a in enumerate((a0, a1, a2)):
                    rows.append(row + offset), columns.append(base + k), values.append(a)
            cohesive = pressure_part[triangle, corner]
            known.extend([(row, nx * cohesive), (row + 1, ny * cohesive)])

        for corner in range(3):  # equilibrium
            g = mesh.gradient[:, corner] * np.sqrt(mesh.area)[:, None]
            normal_terms(2 * cells, cells, np.full(count, corner), g[:, 0], g[:, 1])
        right.append((np.arange(2 * count), (-self.force * np.sqrt(mesh.area)[:, None]).ravel()))
        total = 2 * count
        # tractions at both ends of each edge: local edge k of a triangle runs from corner k to corner k + 1
        triangle, local = np.repeat(cells, 3), np.tile(np.arange(3), count)
        edge = mesh.edge_of.ravel()
        start = mesh.triangles[triangle, local]
        along = mesh.nodes[mesh.edges[:, 1]] - mesh.nodes[mesh.edges[:, 0]]
        normal = np.stack([along[:, 1], -along[:, 0]], 1) / np.linalg.norm(along, axis=1)[:, None]
        sign = np.where(start == mesh.edges[edge, 0], 1.0, -1.0)
        used = ~(mesh.at_base | mesh.at_side)
        first = np.full(len(mesh.edges), -1)
        first[used] = total + 4 * np.arange(used.sum())
        total += 4 * used.sum()
        side_first = np.full(len(mesh.edges), -1)
        side_first[mesh.at_side] = total + 2 * np.arange(mesh.at_side.sum())
        total += 2 * mesh.at_side.sum()
        for end in range(2):
            node = mesh.edges[edge, end]
            corner = np.where(start == node, local, (local + 1) % 3)
            keep = used[edge]
            n = normal[edge] * sign[:, None]
            normal_terms((first[edge] + 2 * end)[keep], triangle[keep], corner[keep], n[keep, 0], n[keep, 1])
            ground = np.where(mesh.at_ground)[0]
            water = self.water[mesh.edges[ground, end]]  # total traction 0: sigma_bar . n = max(p, 0) n
            outward = np.zeros((len(mesh.edges), 2))
            outward[edge] = n
            for axis in range(2):
                right.append((first[ground] + 2 * end + axis, water * outward[ground, axis]))
            keep = mesh.at_side[edge]  # shear alone
            rows.append((side_first[edge] + end)[keep]), columns.append((3 * (3 * triangle + corner) + 2)[keep])
            values.append(np.ones(keep.sum()))
        matrix = coo_matrix((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=(total, 9 * count))
        multiplier, load = np.zeros(total), np.zeros(total)
        for row, value in known:
            np.add.at(multiplier, row, value)
        for row, value in right:
            np.add.at(load, row, value)
        return self._finish(matrix, multiplier, load)


class UpperBound(Bound):
    value = staticmethod(lambda m, dual: dual)

    def multiplier(self, factor):
        mesh, count = self.mesh, len(self.mesh.triangles)
        angle = np.arctan(self.friction / factor)
        cohesion, sine = self.cohesion / factor, np.sin(angle)
        nodes = len(mesh.nodes)
        number = np.column_stack([mesh.triangles, nodes + mesh.edge_of])  # corners, then middles of edges 01, 12, 20
        unknowns = 2 * (nodes + len(mesh.edges))
        rows, columns, values = [], [], []
        multiplier, load = np.zeros(unknowns), np.zeros(unknowns)
        g = mesh.gradient
        for corner in range(3):  # gradients of the six functions at this corner
            at = np.zeros((count, 6, 2))
            bary = np.eye(3)[corner]
            for k in range(3):
                at[:, k] = (4 * bary[k] - 1) * g[:, k]
                j = (k + 1) % 3
                at[:, 3 + k] = 4 * (bary[k] * g[:, j] + bary[j] * g[:, k])
            cone = 3 * (3 * np.arange(count) + corner)
            # share of this corner in the integral of cohesion x divergence, both linear
            share = (cohesion.sum(1) + cohesion[:, corner]) * mesh.area / 12 * np.cos(angle) / sine
            for k in range(6):
                for axis in range(2):
                    unknown = 2 * number[:, k] + axis
                    d = at[:, k, axis]
                    parts = (d / sine, d if axis == 0 else -d, at[:, k, 1 - axis])  # div / sin, xx - yy, 2 xy
                    for row, part in enumerate(parts):
                        rows.append(unknown), columns.append(cone + row), values.append(-part)
                    np.add.at(multiplier, unknown, share * d)
        for k in range(3, 6):  # a quadratic function's integral is all at the middles: force is constant in a triangle
            for axis in range(2):
                np.add.at(load, 2 * number[:, k] + axis, self.force[:, axis] * mesh.area / 3)
        # sigma_bar carries the traction max(p, 0) n on the ground
        ground = np.where(mesh.at_ground)[0]
        if (self.water[mesh.edges[ground]] > 0).any():
            raise NotImplementedError("water above the ground in the upper bound")
        free = np.ones(unknowns, bool)
        for edges, axes in ((mesh.at_base, (0, 1)), (mesh.at_side, (0,))):
            these = np.concatenate([mesh.edges[edges].ravel(), nodes + np.where(edges)[0]])
            for axis in axes:
                free[2 * these + axis] = False
        places = (np.concatenate(rows), np.concatenate(columns))
        matrix = coo_matrix((np.concatenate(values), places), shape=(unknowns, 9 * count)).tocsr()
        return self._finish(matrix[free], multiplier[free], load[free])


class Spiral(Bound):
    """Upper bound by a rigid rotation about the pole of a log spiral that ends on the ground."""

    def __init__(self, strength, weight_above, ground, friction):
        """`strength(x, y)`: cohesion, max(p, 0); `weight_above(x, y)`: N/m2 of the soil above a point."""
        self.strength, self.weight_above, self.friction = strength, weight_above, friction
        self.ground_x, self.ground_y = np.array(ground).T

    def path(self, shape, tangent, points=241):
        """Places along the spiral, its radii and angles, its pole; shape: x of both ends and the angle between."""
        first, last, angle = shape
        a = np.array([first, np.interp(first, self.ground_x, self.ground_y)])
        b = np.array([last, np.interp(last, self.ground_x, self.ground_y)])
        if last - first < 0.5 or not 0.02 < angle < 2.5:
            return None
        ratio = np.exp(angle * tangent)
        radius = np.linalg.norm(b - a) / np.sqrt(1 + ratio ** 2 - 2 * ratio * np.cos(angle))
        turn = np.linspace(0, angle, points)  # anticlockwise from a to b: the pole is above and to the right
        radii = radius * np.exp(turn * tangent)
        local = np.stack([radii * np.cos(turn), radii * np.sin(turn)], 1)
        chord, wanted = local[-1] - local[0], b - a
        rotation = np.arctan2(wanted[1], wanted[0]) - np.arctan2(chord[1], chord[0])
        matrix = np.array([[np.cos(rotation), -np.sin(rotation)], [np.sin(rotation), np.cos(rotation)]])
        local = local @ matrix.T
        pole = a - local[0]
        return pole + local, radii, turn, pole

    def value_of(self, shape, factor):
        """-m of one spiral: driving over resisting moment."""
        tangent = self.friction / factor
        found = self.path(shape, tangent)
        if found is None:
            return 0.0
        places, radii, turn, pole = found
        depth = np.interp(places[:, 0], self.ground_x, self.ground_y) - places[:, 1]
        if depth.min() < -1e-6 or places[:, 1].min() < BASE:
            return 0.0
        cohesion, water = self.strength(places[:, 0], places[:, 1])
        integral = lambda f, t: (0.5 * (f[1:] + f[:-1]) * np.diff(t)).sum()
        driving = integral(self.weight_above(places[:, 0], places[:, 1]) * (pole[0] - places[:, 0]), places[:, 0])
        driving += integral(water * tangent * radii ** 2, turn)
        return -driving / integral(cohesion / factor * radii ** 2, turn)

    def multiplier(self, factor):
        crest, toe = self.ground_x[1], self.ground_x[2]
        starts = [(first, last, angle) for first in (crest - 2, crest - 6) for last in (toe, 0.5 * (crest + toe))
                  for angle in (0.3, 0.8)]
        if getattr(self, "shape", None) is not None:
            starts = [self.shape, *starts[:2]]
        options = {"xatol": 1e-3, "fatol": 1e-6, "maxiter": 600}
        results = [minimize(self.value_of, start, (factor,), "Nelder-Mead", options=options) for start in starts]
        best = min(results, key=lambda r: r.fun)
        self.shape = best.x
        return max(-best.fun, 1e-3)

    def mechanism(self, factor):
        """x of both ends and the largest depth, vertical and normal to the face."""
        places = self.path(self.shape, self.friction / factor)[0]
        depth = np.interp(places[:, 0], self.ground_x, self.ground_y) - places[:, 1]
        (xa, ya), (xb, yb) = zip(self.ground_x[1:3], self.ground_y[1:3])
        normal = ((yb - ya) * (places[:, 0] - xa) - (xb - xa) * (places[:, 1] - ya)) / np.hypot(xb - xa, yb - ya)
        return places[0, 0], places[-1, 0], depth.max(), normal.max()


# The scene ------------------------------------------------------------------------------------------------------------------

def unit_weight(pressure):
    """N/m3."""
    return soil.GRAVITY * (DRY_DENSITY + soil.POROSITY * soil.WATER_DENSITY * soil.saturation(pressure))


class Ground:
    """Pressure, strength and weight of the slope at an hour of a file of flow.py or of `pressures`."""

    def __init__(self, path, hour):
        flow = np.load(path)
        self.scene = Scene("slope")
        self.last = flow["z"][-1]
        grid = flow["pressure"][hour].astype(float)
        self._pressure = RegularGridInterpolator((flow["x"], flow["z"]), grid)
        x, z = np.meshgrid(flow["x"], flow["z"], indexing="ij")
        y, weight = self.scene.y(x, z), unit_weight(grid)
        above = np.cumsum(0.5 * (weight[:, 1:] + weight[:, :-1]) * -np.diff(y, axis=1), axis=1)
        self._above = RegularGridInterpolator((flow["x"], flow["z"]), np.column_stack([np.zeros(len(x)), above]))

    def _places(self, x, y):
        return np.stack([x, np.clip(self.scene.z(x, y), 0, self.last)], -1)

    def pressure(self, x, y):
        return self._pressure(self._places(x, y))

    def weight_above(self, x, y):
        return self._above(self._places(x, y))

    def suction_strength(self, pressure):
        return np.maximum(-pressure, 0) * soil.saturation(pressure) * FRICTION  # S_r = 0, S_max = 1: S_e = S


def slope_case(ground, mesh, cohesion, guess):
    pressure = ground.pressure(*mesh.nodes.T)
    strength = cohesion + ground.suction_strength(pressure)
    weight = unit_weight(pressure)[mesh.triangles].mean(1)
    lower = LowerBound(mesh, strength, FRICTION, weight, pressure).factor(guess)
    upper = UpperBound(mesh, strength, FRICTION, weight, pressure).factor(1.03 * lower)

    def at(x, y):
        p = ground.pressure(x, y)
        return cohesion + ground.suction_strength(p), np.maximum(p, 0)

    spiral = Spiral(at, ground.weight_above, GROUND, FRICTION)
    turning = spiral.factor(upper, 1e-4)
    return lower, upper, turning, *spiral.mechanism(turning)


def slope(path, out, size, cases):
    mesh = Mesh(GROUND, BASE, size, 2.5, (1, 2), 4.5)
    print(f"{len(mesh.triangles)} triangles", flush=True)
    davis = np.cos(np.arctan(FRICTION))
    guesses = {}
    with open(out, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["hour", "cohesion_Pa", "lower", "upper", "spiral", "davis_lower", "davis_upper", "spiral_from_x_m",
                         "spiral_to_x_m", "depth_vertical_m", "depth_normal_m", "triangles"])
        for hour, cohesion in cases:
            lower, upper, spiral, *mechanism = slope_case(Ground(path, hour), mesh, 1e3 * cohesion, guesses.get(hour, 1.2))
            guesses[hour] = lower - 0.05
            least = min(upper, spiral)
            row = [hour, round(1000 * cohesion), *(f"{v:.4f}" for v in (lower, upper, spiral, davis * lower, davis * least)),
                   *(f"{v:.2f}" for v in mechanism), len(mesh.triangles)]
            writer.writerow(row)
            file.flush()
            print(*row, flush=True)


def infinite(path, hour, cohesion):
    ground = Ground(path, hour)
    print("depth_m pressure_Pa cohesion_Pa factor")
    for depth in (0.25, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8):
        x, y = np.array([30.0]), np.array([20.0 - depth])
        p = ground.pressure(x, y)
        strength = 1e3 * cohesion + ground.suction_strength(p)
        stress = 0.5 * ground.weight_above(x, y)  # normal, and shear, on a plane at 45 degrees
        factor = (strength + (stress - np.maximum(p, 0)) * FRICTION) / stress
        print(f"{depth} {p[0]:.0f} {strength[0]:.0f} {factor[0]:.3f}")


def pressures(scene_path, hours, out):
    sys.path[:0] = [str(ROOT / "bindings" / "python"), str(ROOT / "tests" / "precision")]
    import talus  # of all commands this one alone needs the engine
    from variants import rigid
    scene = rigid(json.loads(Path(scene_path).read_text()))
    scene["surface"]["zones"][0]["rainEnd"] = scene["schedule"]["duration"] = 3600 * hours
    scene["schedule"]["outputs"] = [0, 3600 * hours]
    geometry = Scene("slope")
    x, z = np.linspace(0, geometry.right, 241), np.concatenate([np.arange(0, 6, 0.05), 6 + np.linspace(0, 1, 81)])
    places = np.stack([np.repeat(x, len(z)), geometry.y(*np.meshgrid(x, z, indexing="ij")).ravel()], 1)
    places[:, 1] = np.maximum(places[:, 1], 1e-6)
    engine, fields = talus.Engine(talus.Scene.from_json(scene)), []
    for hour in range(hours + 1):
        if hour:
            engine.advance_to(3600.0 * hour)
        fields.append(engine.sample("pressure", places).reshape(len(x), len(z)).astype(np.float32))
    np.savez_compressed(out, x=x, z=z, pressure=np.array(fields))


def known(size=0.3):
    """Stability numbers, weight x height / cohesion, of homogeneous dry slopes; the expected ones are from memory (Chen 1975)."""
    cohesion, height = 1e4, 10.0
    for angle, friction, expected in ((45, 30, 35.54), (45, 20, 16.16), (90, 20, 5.51)):
        run = height / np.tan(np.radians(angle)) if angle < 90 else 0.0
        ground = [(0, 15), (12, 15), (12 + run, 5), (26 + run, 5)]
        mesh = Mesh(ground, 0, size, 4 * size, (1, 2), 3.0)
        weight = expected * cohesion / height
        count, tangent = len(mesh.nodes), np.tan(np.radians(friction))
        given = (mesh, np.full(count, cohesion), tangent, np.full(len(mesh.triangles), weight), np.zeros(count))
        numbers = [expected / bound(*given).multiplier(1.0) for bound in (LowerBound, UpperBound)]
        if angle < 90:
            x, y = np.array(ground, float).T
            strength = lambda u, v: (np.full(len(u), cohesion), 0.0 * u)
            spiral = Spiral(strength, lambda u, v: weight * (np.interp(u, x, y) - v), ground, tangent)
            numbers.append(expected / spiral.multiplier(1.0))
        print(f"{angle} deg, phi {friction} deg: expected {expected}; lower, upper, spiral", *(f"{v:.2f}" for v in numbers))


def main():
    command, *rest = sys.argv[1:]
    if command == "known":
        known(*map(float, rest))
    elif command == "pressures":
        pressures(rest[0], int(rest[1]), rest[2])
    elif command == "infinite":
        infinite(rest[0], int(rest[1]), float(rest[2]))
    else:
        size = float(rest[2]) if len(rest) > 2 else 0.6
        cases = [(hour, cohesion) for hour in CASES for cohesion in CASES[hour]]
        if len(rest) > 3:
            cases = [(int(case.split(":")[0]), float(case.split(":")[1])) for case in rest[3].split(",")]
        slope(rest[0], rest[1], size, cases)


if __name__ == "__main__":
    main()
