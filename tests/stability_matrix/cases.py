"""The cases of the matrix, by topic. The first case of a sweep is its benign one."""

import auto_cases
import dynamic_cases
import flow_cases
import found_cases
import ground_cases
import solid_cases
import time_cases

QUICK = ("n_alpha/2_0.1", "n_alpha/1.03_0.0001", "fill/beyond", "rain/on_off_on", "time/tiny_steps", "time/zero_step",
         "limit_heave/net_0.98", "limit_heave/net_1.02")

SWEEPS = flow_cases.SWEEPS + solid_cases.SWEEPS + dynamic_cases.SWEEPS + auto_cases.SWEEPS


def matrix():
    for topic in (flow_cases, time_cases, solid_cases, ground_cases, dynamic_cases, auto_cases, found_cases):
        yield from topic.cases()
