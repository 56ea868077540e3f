"""Mohr-Coulomb of docs/theory.md from a run's views alone: how far its stresses lie beyond the strength of its soils."""

import numpy

ATMOSPHERE = 101325.0  # Pa
LARGEST_FRICTION = 60.0  # degrees, of the exponential model
STATES = 1001  # of a soil that softens
LEAST = 1e-3  # Pa, in motion: rounding of stiff ground that bears nothing
FLOOR = 1e-3  # of the ground's greatest strength: what a point's excess is at least compared with

GAUSS = 1 / numpy.sqrt(3)
CORNERS = numpy.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
SHARES = {  # of a cell's nodes in its points, by its number of nodes
    2: numpy.array([[1 + GAUSS, 1 - GAUSS], [1 - GAUSS, 1 + GAUSS]]) / 2,
    3: numpy.array([[4, 1, 1], [1, 4, 1], [1, 1, 4]]) / 6,
    4: numpy.array([numpy.prod(1 + GAUSS * point * CORNERS, axis=1) for point in CORNERS]) / 4,
}


def effective_saturation(soil, suction):
    """Of van Genuchten's curve."""
    retention = soil["hydraulics"]["retention"]
    n = retention["n"]
    return (1 + (retention["alpha"] * suction) ** n) ** -(1 - 1 / n)


def strength_of(entries, suction, saturation):
    """Cohesion (Pa) and friction angle (degrees) at suctions and effective saturations."""
    cohesion, friction = entries["cohesion"] + 0 * suction, entries["frictionAngle"] + 0 * suction
    model = entries.get("model", "vanapalli")
    if model == "vanapalli":
        gain = entries.get("suctionGainAngle", entries["frictionAngle"])  # slip does not soften it
        cohesion = cohesion + suction * saturation * numpy.tan(numpy.radians(gain))
    elif model == "fredlund":
        cohesion = cohesion + suction * numpy.tan(numpy.radians(entries["suctionFrictionAngle"]))
    elif model == "exponential":
        gain, rate = entries.get("cohesionGain", 0.0), entries.get("cohesionRate", 0.0)
        cohesion = cohesion + gain * (1 - numpy.exp(-rate * suction / ATMOSPHERE))
        gained = friction + entries.get("frictionGain", 0.0) * suction / ATMOSPHERE
        friction = numpy.where(suction > 0, numpy.minimum(gained, LARGEST_FRICTION), friction)
    if "lostSine" in entries:  # to slip, whatever the suction
        friction = numpy.degrees(numpy.arcsin(numpy.sin(numpy.radians(friction)) - entries["lostSine"]))
    return cohesion, friction


def excess(stress, cohesion, friction, tensile):
    """Beyond the cone or the tensile strength at each point, and the strength there that it is to be compared with, Pa.

    Stress in rows of xx, yy, zz, xy, tension positive.
    """
    centre, radius = (stress[:, 0] + stress[:, 1]) / 2, numpy.hypot((stress[:, 0] - stress[:, 1]) / 2, stress[:, 3])
    largest, smallest = numpy.maximum(centre + radius, stress[:, 2]), numpy.minimum(centre - radius, stress[:, 2])
    sine, cosine = numpy.sin(numpy.radians(friction)), numpy.cos(numpy.radians(friction))
    shear = (1 + sine) * largest - (1 - sine) * smallest - 2 * cohesion * cosine
    scale = 2 * cohesion * cosine + (1 + sine) * abs(largest) + (1 - sine) * abs(smallest)
    return numpy.maximum(shear, largest - tensile), scale


def relative_excess(beyond, scale, least=1e-300):
    """The largest over the ground, 0 where none is beyond; a strength counts at least `least`, Pa."""
    floor = max(FLOOR * scale.max(), least)
    return float(numpy.max(numpy.maximum(beyond, 0) / numpy.maximum(scale, floor)))


def reached(solid):
    """Entries of the strength from that without slip to the residual one: a point may be in any state between them. Without slip, friction
    that grows with the rate of shear may be at its limit, too, where c cos(phi) is what it was."""
    rest, fast = solid.get("softening"), solid.get("inertialFriction")
    first = solid["strength"]
    if fast:
        cosines = [numpy.cos(numpy.radians(angle)) for angle in (first["frictionAngle"], fast["limitFrictionAngle"])]
        return [first, {**first, "cohesion": first["cohesion"] * cosines[0] / cosines[1], "frictionAngle": fast["limitFrictionAngle"]}]
    if not rest:
        return [first]
    sines = [numpy.sin(numpy.radians(angle)) for angle in (first["frictionAngle"], rest["residualFrictionAngle"])]
    return [{**first, "suctionGainAngle": first["frictionAngle"], "cohesion": (1 - lost) * first["cohesion"] + lost * rest["residualCohesion"],
             "lostSine": lost * (sines[0] - sines[1])}
            for lost in numpy.linspace(0, 1, STATES)]


class YieldCheck:
    """Of one run; `soils` is the number of each point's soil."""

    def __init__(self, engine, scene, soils):
        self.engine, self.scene, self.soils = engine, scene, soils
        self.is_wet = "suction" in engine.fields
        self.is_bishop = self.is_wet and scene.get("physics", {}).get("stress", "net") == "bishop"
        laws = [soil["solid"].get("model", "mohrCoulomb") for soil in scene["soils"]]
        self.plastic = [number for number, law in enumerate(laws) if law == "mohrCoulomb"]

    def __call__(self):
        stress = self._skeleton_stress()
        parts = [self._excess_of(number, stress) for number in self.plastic if (self.soils == number).any()]
        least = LEAST if "point_soil" in self.engine.fields else 1e-300
        return relative_excess(*map(numpy.concatenate, zip(*parts)), least) if parts else 0.0

    def _excess_of(self, number, stress):
        at = self.soils == number
        soil = self.scene["soils"][number]
        suction, saturation = numpy.zeros(at.sum()), numpy.ones(at.sum())
        if self.is_wet:
            suction, saturation = self.engine.read("suction")[at], self._effective(self.engine.read("saturation"), self.soils)[at]
        states = [excess(stress[at], *strength_of(entries, suction, saturation), soil["solid"].get("tensileStrength", numpy.inf))
                  for entries in reached(soil["solid"])]
        return numpy.min([beyond for beyond, _ in states], axis=0), states[0][1]

    def _skeleton_stress(self):
        """Net stress, or Bishop's, whose pore pressure the engine takes from the cells' nodes."""
        if not self.is_bishop:
            return self.engine.read("net_stress")
        stress = self.engine.read("total_stress").copy()
        stress[:, :3] += self._pore_stress()[:, None]
        return stress

    def _pore_stress(self):
        if "point_pressure" in self.engine.fields:  # ground in motion has no cells, and its points hold water, not pressure
            pressure = self.engine.read("point_pressure")
            share = self._effective(self.engine.read("saturation"), self.soils)
            if "gas_pressure" in self.engine.fields:
                return share * pressure + (1 - share) * self.engine.read("gas_pressure")
            return pressure * numpy.where(pressure < 0, share, 1)
        starts, nodes = (self.engine.read(name).astype(int) for name in ("cell_start", "cell_nodes"))
        pressure, soils = self.engine.read("pressure"), self.engine.read("cell_soil").astype(int)
        parts = []
        for first, last, number in zip(starts, starts[1:], soils):
            at = pressure[nodes[first:last]]
            weighted = at * numpy.where(at < 0, effective_saturation(self.scene["soils"][number], numpy.maximum(-at, 0)), 1)
            parts.append(SHARES[last - first] @ weighted)
        return numpy.concatenate(parts)

    def _effective(self, saturation, soils):
        retention = [soil["hydraulics"]["retention"] for soil in self.scene["soils"]]
        least = numpy.array([curve.get("residualSaturation", 0.0) for curve in retention])[soils]
        most = numpy.array([curve.get("maximumSaturation", 1.0) for curve in retention])[soils]
        return numpy.clip((saturation - least) / (most - least), 0, 1)
