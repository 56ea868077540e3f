"""What a case is, and a sweep of them; times in seconds."""

from dataclasses import dataclass

HOUR = 3600.0
DAY = 24 * HOUR
YEAR = 365.25 * DAY


@dataclass(frozen=True)
class Case:
    name: str  # sweep/values
    scene: dict
    steps: list  # ["step", s, times], ["refused_step", s, times], ["rain", m/s], ["flow", boundary, value]
    monotone: bool = False  # no peak inside the column, of saturation or pressure
    refusal: str = ""  # text of the only refusal that is right; the case must be refused so
    may_be_refused: str = ""  # text of a refusal that is as right as an end
    why: str = ""  # why that refusal is right
    settles: bool = False  # increments of displacement and pressure must not grow from step to step
    loses: bool | None = None  # whether equilibrium must be lost, where that is known
    place: tuple = ()  # its two parameters on the map of the sweep
    bound: float = 20.0  # s of wall time
    tightened: bool = False  # run again with a tenth of the tolerance

    @property
    def sweep(self):
        return self.name.split("/")[0]


@dataclass(frozen=True)
class Sweep:
    """Two parameters, their benign values first; `scene_of` takes one of each."""
    name: str
    labels: tuple
    values: tuple
    scene_of: object
    steps: object  # a case's, or a function that takes one of each
    monotone: bool = True
    settles: bool = False

    def cases(self):
        for first in self.values[0]:
            for second in self.values[1]:
                steps = self.steps(first, second) if callable(self.steps) else self.steps
                yield Case(f"{self.name}/{first:g}_{second:g}", self.scene_of(first, second), steps, self.monotone,
                           settles=self.settles, place=(first, second))
