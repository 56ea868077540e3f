"""What a run shows while it goes on: values out of their bounds, peaks where none may be, the water balance."""

import numpy
from scenes import WATER_WEIGHT
from strength import YieldCheck


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

    The water moved counts at least a millionth of that stored: less is rounding.
    """
    stored = max(reports[-1]["water_initial"], *(report["water_stored"] for report in reports))
    shares = [missed(report) / max(moved(report), 1e-6 * stored, 1e-300) for report in reports]
    return {"balance": float(numpy.max(shares)),  # NaN stays, which max() would lose
            "balance_stored": float(numpy.max([missed(report) for report in reports]) / max(stored, 1e-300))}


def soil_of_points(engine):
    """Number of the soil of each material point: a cell has as many points as nodes."""
    return numpy.repeat(engine.read("cell_soil").astype(int), numpy.diff(engine.read("cell_start").astype(int)))


def has_lost_equilibrium(engine):
    return any(event["kind"] == "loss_of_equilibrium" for event in engine.events())


class Watch:
    """Collects over the steps of a run."""

    def __init__(self, engine, scene):
        self.engine, self.fields = engine, engine.fields
        self.is_wet = "saturation" in self.fields
        self.is_column = engine.describe()["dimension"] == 1
        self.seen = {"not_finite": [], "out_of_range": 0.0, "overshoot_saturation": 0.0, "overshoot_pressure": 0.0,
                     "yield_exceeded": 0.0}
        self.yield_check = YieldCheck(engine, scene, soil_of_points(engine)) if "net_stress" in self.fields else None
        if not self.is_wet:
            return
        retention = [soil["hydraulics"]["retention"] for soil in scene["soils"]]
        soils = soil_of_points(engine)
        self.least = numpy.array([curve.get("residualSaturation", 0.0) for curve in retention])[soils]
        self.most = numpy.array([curve.get("maximumSaturation", 1.0) for curve in retention])[soils]
        self.weight = WATER_WEIGHT * (engine.read("node_position").max() - engine.read("node_position").min())

    def _raise(self, name, value):
        self.seen[name] = float(numpy.maximum(self.seen[name], value))  # NaN stays

    def look(self):
        for name in self.fields:
            if not numpy.isfinite(self.engine.read(name)).all() and name not in self.seen["not_finite"]:
                self.seen["not_finite"].append(name)
        if self.is_wet:
            self.look_at_water()
        if self.yield_check and not has_lost_equilibrium(self.engine):  # beyond it the stress stands and the suction goes on
            self._raise("yield_exceeded", self.yield_check())

    def look_at_water(self):
        pressure, saturation = self.engine.read("pressure"), self.engine.read("saturation")
        self._raise("out_of_range", numpy.maximum(self.least - saturation, saturation - self.most).max())
        if self.is_column:
            self._raise("overshoot_saturation", peak(saturation) / (self.most - self.least).max())
            self._raise("overshoot_pressure", peak(pressure) / max(numpy.ptp(pressure), self.weight))

    def effective_saturation(self):
        """In the middle of what its soil can hold, or None of dry ground."""
        return self.engine.read("saturation") / (self.most - self.least) if self.is_wet else None
