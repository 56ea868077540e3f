"""Where something was measured: what pages with seconds on them say of it."""

import os
import pathlib
import platform

import talus


def circumstances():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines()
    processor = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())
    return {"processor": processor, "cores": os.cpu_count(), "load": round(os.getloadavg()[1], 1), "build": talus.build_info()}


def text(found):
    """The machine and how busy it was."""
    return f"{found['processor']}, {found['cores']} cores, mean load {found['load']:g}."


def text_with_build(found):
    return f"Talus {found['build']['version']}, {found['build']['build']} build; {text(found)}"
