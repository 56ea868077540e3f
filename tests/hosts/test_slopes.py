"""The slopes' pressures, saturations, displacements and water balance within the bounds of tests/verify, but for those that
docs/verification.md says are not met, and without its clock: a test must not depend on what else the machine does."""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path[:0] = [str(ROOT / "tests" / "verification"), str(ROOT / "bindings" / "python")]

import slopes  # noqa: E402  (needs the paths above)
from rows import engine_of  # noqa: E402


class Slopes(unittest.TestCase):
    def check(self, case):
        engine, _ = slopes.simulate(lambda: engine_of(case))
        errors = slopes.history_errors(case, engine)
        for probe in "ABC":
            self.assertLessEqual(errors[f"pressure_{probe}_Pa"], slopes.PRESSURE_BOUND)
            self.assertLessEqual(errors[f"saturation_{probe}"], slopes.SATURATION_BOUND)
        self.assertLessEqual(slopes.balance_error(engine), slopes.BALANCE_BOUND)
        self.assertEqual(slopes.losses(engine), [])
        return errors

    def test_gentle(self):
        errors = self.check("slope_gentle")
        for probe in ("crest", "face"):
            self.assertLessEqual(errors[f"displacement_{probe}_m"], slopes.DISPLACEMENT_BOUNDS[probe])

    def test_steep(self):
        self.check("slope")


if __name__ == "__main__":
    unittest.main()
