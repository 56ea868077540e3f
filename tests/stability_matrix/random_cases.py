"""The random search: all ranges at once. The number of a scene is its seed."""

import random

from case import Case
from scenes import MM_PER_HOUR, column, soil


class Draw:
    """Numbers from a seed, to four digits."""

    def __init__(self, seed):
        self._random = random.Random(seed)
        self.choice, self.whole = self._random.choice, self._random.randint

    def log_uniform(self, low, high):
        return float(f"{low * (high / low) ** self._random.random():.4g}")


def random_soil(draw, name):
    return soil(name, alpha=draw.log_uniform(1e-7, 1e-2), n=round(1 + draw.log_uniform(0.03, 11), 4),
                conductivity=draw.log_uniform(1e-13, 1e-1), porosity=draw.log_uniform(0.05, 0.9),
                residual=draw.choice((0.0, draw.log_uniform(1e-3, 0.9))))


def random_steps(draw):
    steps = []
    for _ in range(draw.whole(2, 6)):
        steps += [["rain", draw.choice((0.0, draw.log_uniform(0.1, 1000) * MM_PER_HOUR))],
                  ["step", draw.log_uniform(1e-3, 1e6), draw.whole(1, 4)]]
    return steps


def rigid_column(seed):
    draw = Draw(seed)
    height = draw.log_uniform(0.05, 20)
    layers = [{"soil": "upper"}, {"soil": "lower", "top": height / 2}]
    scene = column([random_soil(draw, "upper"), random_soil(draw, "lower")], layers, height=height, cells=2 * draw.whole(2, 20),
                   suction=draw.choice((0.0, draw.log_uniform(1, 1e6))), rain=draw.log_uniform(0.1, 1000) * MM_PER_HOUR,
                   base=draw.choice((None, 0.0, -draw.log_uniform(1, 1e5))), ponding=draw.choice((0.0, draw.log_uniform(1e-3, 1))))
    return scene, random_steps(draw)


def random_case(number):
    scene, steps = rigid_column(number)
    return Case(f"random/{number}", scene, steps, tightened=True)
