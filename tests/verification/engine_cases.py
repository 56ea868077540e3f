"""Cases that no scene can express: rows of the program that engine_cases.cpp is built to, beside the library under test."""

import json
import os
import pathlib
import subprocess


def rows(case):
    program = pathlib.Path(os.environ["TALUS_LIBRARY"]).resolve().parent.parent / "bin" / "engine_cases"
    yield from json.loads(subprocess.run([program, case], check=True, capture_output=True, text=True).stdout)
