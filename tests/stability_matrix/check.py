"""What a run shows while it goes on: values out of their bounds, peaks where none may be, the water balance."""

import numpy
from scenes import WATER_WEIGHT
from strength import YieldCheck


DRAINED = 1e-6  # below the residual saturation: so much the last substep of a point in motion that drains may take


def peak(values):
    """How far a value inside stands above lower ones on both sides of it: 0 where the row falls, then rises."""
    if len(values) < 3:
        return 0.0
    left, right = numpy.minimum.accumulate(values), numpy.minimum.accumulate(values[::-1])[::-1]
    return float(numpy.max(values - numpy.maximum(left, right)))


def missed(report):
    """Water that the report's balances miss: the engine's own, the same from the report's waters, and the rain's."""
    gained = report["water_infiltrated"] + report["water_inflow"] - report["water_seepage"] - report["water_drained"]
    return numpy.max(numpy.abs([report["water_residual"], report["water_stored"] - report["water_initial"] - gained,
                                report["water_rain"] - report["water_infiltrated"] - report["water_run_off"]]))


def moved(report):
    return sum(abs(report[f"water_{name}"]) for name in ("rain", "inflow", "seepage", "drained"))


def balances(reports):
    """The most water missed at any time, relative to the water moved until then and to the most that was stored.

    The water moved counts at least a millionth of that stored, in motion a ten-thousandth: less is rounding, which adds up over substeps.
    """
    stored = max(reports[-1]["water_initial"], *(report["water_stored"] for report in reports))
    least = (1e-4 if reports[-1]["motion_substeps"] else 1e-6) * stored
    shares = [missed(report) / max(moved(report), least, 1e-300) for report in reports]
    return {"balance": float(numpy.max(shares)),  # NaN stays, which max() would lose
            "balance_stored": float(numpy.max([missed(report) for report in reports]) / max(stored, 1e-300))}


def energy_gained(reports):
    """The most that dry ground has gained in motion, of the largest kinetic and elastic energy; None where water or the hydraulic part counts."""
    last = reports[-1]
    if last["regime"] not in ("dynamic", "at_rest") or last["water_stored"] > 0:
        return None
    largest = max(report["kinetic_energy"] + report["elastic_energy"] for report in reports)
    return float(numpy.max([-report["dissipated_energy"] for report in reports]) / max(largest, 1e-300))


def soil_of_points(engine):
    """Number of the soil of each material point: a cell of a mesh has as many points as nodes."""
    if "point_soil" in engine.fields:
        return engine.read("point_soil").astype(int)
    return numpy.repeat(engine.read("cell_soil").astype(int), numpy.diff(engine.read("cell_start").astype(int)))


def has_lost_equilibrium(engine):
    return any(event["kind"] == "loss_of_equilibrium" for event in engine.events())


class Watch:
    """Collects over the steps of a run."""

    def __init__(self, engine, scene):
        self.engine, self.scene = engine, scene
        self.seen = {"not_finite": [], "out_of_range": 0.0, "overshoot_saturation": 0.0, "overshoot_pressure": 0.0,
                     "yield_exceeded": 0.0}
        self.learn()

    def learn(self):
        """What the ground is made of: of another mesh or of points where it has failed or settled."""
        engine, description = self.engine, self.engine.describe()
        self.made_of = description["points"], description["nodes"]
        self.fields = engine.fields
        self.is_wet = "saturation" in self.fields
        self.is_column = description["dimension"] == 1
        self.is_dynamic = "point_soil" in self.fields
        soils = soil_of_points(engine)
        self.yield_check = YieldCheck(engine, self.scene, soils) if "net_stress" in self.fields else None
        if not self.is_wet:
            return
        retention = [soil["hydraulics"]["retention"] for soil in self.scene["soils"]]
        self.least = numpy.array([curve.get("residualSaturation", 0.0) for curve in retention])[soils]
        self.most = numpy.array([curve.get("maximumSaturation", 1.0) for curve in retention])[soils]
        if self.is_column:
            self.weight = WATER_WEIGHT * numpy.ptp(engine.read("node_position"))
        self.start_pores = self.pores() if self.is_dynamic else None  # where they widen, water that does not move fills less of them

    def pores(self):
        return self.engine.read("porosity") * self.engine.read("point_volume")

    def _raise(self, name, value):
        self.seen[name] = float(numpy.maximum(self.seen[name], value))  # NaN stays

    def look(self):
        description = self.engine.describe()
        if (description["points"], description["nodes"]) != self.made_of:
            self.learn()
        for name in self.fields:
            if not numpy.isfinite(self.engine.read(name)).all() and name not in self.seen["not_finite"]:
                self.seen["not_finite"].append(name)
        if self.is_wet:
            self.look_at_water()
        if self.yield_check and self.strength_holds():
            self._raise("yield_exceeded", self.yield_check())

    def strength_holds(self):
        """Not where equilibrium is lost, and the stress stands while the suction goes on; nor before ground that need not stand moves."""
        has_lost = has_lost_equilibrium(self.engine) or self.engine.report()["regime"] == "equilibrium_lost"
        return not has_lost and not (self.is_dynamic and self.engine.time == 0)

    def look_at_water(self):
        saturation = self.engine.read("saturation")
        least = self.least if self.start_pores is None else self.least * numpy.minimum(self.start_pores / self.pores(), 1)
        beyond = numpy.maximum(least - saturation, saturation - self.most).max()
        self._raise("out_of_range", beyond - DRAINED if self.is_dynamic else beyond)
        if self.is_column:
            self._raise("overshoot_saturation", peak(saturation) / (self.most - self.least).max())
            pressure = self.engine.read("pressure")
            self._raise("overshoot_pressure", peak(pressure) / max(numpy.ptp(pressure), self.weight))

    def effective_saturation(self):
        """In the middle of what its soil can hold, or None of dry ground."""
        return self.engine.read("saturation") / (self.most - self.least) if self.is_wet else None
