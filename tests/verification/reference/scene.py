"""The two slopes: geometry, monitoring points, and the tensor-product grid that flow.py and mechanics.py share.

Every mesh here is made of vertical columns of quads. A point has the coordinates x and z: its vertical depth d below the
ground surface while d <= TOP, and TOP + (d - TOP) / (H - TOP) below, H the height of the ground above the base. In (x, z)
every mesh, and every set of second-order nodes on it, is a tensor grid.
"""
import numpy as np

TOP = 6.0
RAIN = 0.012 / 3600
HOURS = 36
SURFACE_PRESSURE = -1e5
WATER_LEVEL = 8.0


class Scene:
    def __init__(self, name):
        self.name = name
        self.toe = {"slope": 40.0, "slope_gentle": 50.0}[name]
        self.right = self.toe + 20.0
        middle = 0.5 * (20.0 + self.toe)
        self.probes = {"A": (18.0, 28.0), "B": (middle, 18.0), "C": (self.toe + 2.0, 8.5), "below_crest": (20.0, 29.5)}
        self.markers = {"crest": (20.0, 30.0), "face": (middle, 20.0), "toe": (self.toe, 10.0), "beside_toe": (self.toe + 1.0, 10.0)}

    def height(self, x):
        return np.interp(x, [20.0, self.toe], [30.0, 10.0])

    def y(self, x, z):
        height = self.height(x)
        return height - np.where(z <= TOP, z, TOP + (z - TOP) * (height - TOP))

    def z(self, x, y):
        depth = self.height(x) - y
        return np.where(depth <= TOP, depth, TOP + (depth - TOP) / (self.height(x) - TOP))

    def columns(self, least, largest, growth=1.15):
        """Lines x of the mesh: `least` wide at crest and toe, growing to `largest`; every probe is on a line."""
        lines = {0.0, self.right}
        fixed = sorted({0.0, self.right, 20.0, self.toe, *(x for x, _ in self.probes.values())})
        distance = lambda x: np.min(np.abs(x - np.array([20.0, self.toe])))
        for a, b in zip(fixed[:-1], fixed[1:]):
            fine = np.linspace(a, b, 400)
            size = np.array([min(largest, least + (growth - 1) * distance(x)) for x in fine])
            count = np.concatenate([[0], np.cumsum(0.5 * (1 / size[1:] + 1 / size[:-1]) * np.diff(fine))])
            cells = max(1, int(np.ceil(count[-1] - 1e-9)))
            lines.update(np.interp(np.linspace(0, count[-1], cells + 1), count, fine).tolist())
        return np.array(sorted(lines))

    def layers(self, top, below, first=None):
        """Lines z: `top` high down to TOP (halved towards the ground until below `first`), then growing; y = 8 m is on a line at both sides."""
        upper = np.linspace(0, TOP, int(round(TOP / top)) + 1)
        while first and upper[1] > 1.01 * first:
            upper = np.insert(upper, 1, 0.5 * upper[1])
        left = TOP + 2 / 3  # y = 8 m at x = 0
        ratio = np.linspace(0, 1, below + 1)
        first = TOP + (left - TOP) * ratio ** 1.7
        second = np.linspace(left, TOP + 1, max(1, below // 3) + 1)
        return np.concatenate([upper, first[1:], second[1:]])


def ground_displacement(mechanics, x):
    """(hours, 2) of the ground at x, from the output of mechanics.py."""
    ground = mechanics["displacement"][:, :, :, 0]
    return np.stack([[np.interp(x, mechanics["node_x"], row) for row in hour] for hour in ground])


def raster(scene, spacing=0.5):
    """Raster points inside the closed domain."""
    x, y = np.meshgrid(np.arange(0, scene.right + 1e-9, spacing), np.arange(0, 30 + 1e-9, spacing), indexing="ij")
    inside = y <= scene.height(x) + 1e-9
    return x[inside], y[inside]


def midpoints(lines):
    """Lines of the second-order nodes: the mesh's lines and the middles between them."""
    return np.sort(np.concatenate([lines, 0.5 * (lines[1:] + lines[:-1])]))
