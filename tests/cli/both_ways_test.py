"""Loads that go up and down without a column for their direction, from the log to a hysteresis and its correction.

usage: both_ways_test.py path/to/gumshoe [unittest options]
"""
import random
import unittest

from program import complaint, gumshoe
from traced_log import TracedLog

PATH = [0, 20, 40, 60, 80, 100, 80, 60, 40, 20, 0]


def torque(loop, reversal=0.0, seed=77):
    """A torque transducer in three mountings, twice each: 2 mV/V, and a loop that closes at both ends."""
    draw = random.Random(seed)
    yield "mounting,cycle,M_Nm,signal_mV/V"
    for mounting in ("0 deg", "120 deg", "240 deg"):
        for cycle in (1, 2):
            for i, load in enumerate(PATH):
                x, way = load / 100, 1 if i <= 5 else -1
                yield f"{mounting},{cycle},{load},{2 * x - way * (4 * loop * x * (1 - x) + reversal) + draw.gauss(0, 3e-5):.6f}"


class BothWays(TracedLog):
    def rounds(self):
        return self.verdict("log.toml", "--loop", "4")["rounds"]

    def test_new_takes_the_direction_from_the_path(self):
        self.assertIn('direction = { column = "M_Nm", sense = true }', self.log(torque(6e-4)))

    def test_a_reference_pressure_is_a_position_and_the_air_s_is_none(self):
        rows = ["series;p_ref_bar;air_hPa;p_ind_bar"]
        draw = random.Random(2)
        for series in range(1, 4):
            for load in PATH:
                rows.append(f"{series};{load};{1013 + series // 2};{load + draw.gauss(0, 0.01):.3f}")
        text = self.log(rows)
        self.assertIn('position = "p_ref_bar"', text)
        self.assertIn('direction = { column = "p_ref_bar", sense = true }', text)

    def test_passes_one_way_have_no_direction(self):
        one_way = ["cycle,pos_mm,err_um"] + [f"{c},{100 * i},{i + 0.1 * c}" for c in range(1, 6) for i in range(6)]
        self.assertNotIn("sense", self.log(one_way))
        shuffled = random.Random(1)
        any_order = ["cycle,pos_mm,err_um"] + [f"{c},{100 * i},{i + 0.1 * c}" for c in range(1, 9) for i in shuffled.sample(range(8), 8)]
        self.assertNotIn("sense", self.log(any_order))

    def test_a_loop_is_found_and_its_correction_holds_in_the_next_round(self):
        self.log(torque(6e-4))
        rounds = self.rounds()
        self.assertEqual(len(rounds[0]["added"]), 1, rounds)
        # 66 readings of noise 3e-5 mV/V; what is left is known to 1 / sqrt(2 * 40) = 11 %.
        self.assertAlmostEqual(rounds[0]["after"], 3e-8, delta=1e-8)
        self.assertEqual(rounds[1]["added"], [])
        for key in ("before", "after"):
            self.assertAlmostEqual(rounds[1][key] / rounds[0]["after"], 1, delta=0.02)

    def test_a_constant_reversal_is_fitted(self):
        self.log(torque(0, reversal=4e-4))
        self.assertEqual(self.rounds()[0]["added"], [])
        run = gumshoe("estimate", "log.toml", cwd=self.folder)
        # u = 3e-5 / sqrt(60) = 4e-6 mV/V
        self.assertRegex(run.stdout, r"reversal +-0\.000(39|40|41)")

    def test_a_sense_stands_alone(self):
        text = self.log(torque(6e-4))
        for wrong, said in (('sense = true, unit = "mm"', "given together with sense"), ("sense = false", "false says nothing")):
            (self.folder / "wrong.toml").write_text(text.replace("sense = true", wrong))
            run = gumshoe("check", "wrong.toml", cwd=self.folder)
            self.assertIsNone(complaint(run))
            self.assertIn(said, run.stderr)
        (self.folder / "wrong.toml").write_text(text.replace('position = "M_Nm"', 'position = { column = "M_Nm", sense = true }', 1).replace(
            '[model]\nname = "expression"', '[model]\nname = "linear_axis"', 1))
        run = gumshoe("check", "wrong.toml", cwd=self.folder)
        self.assertIn("a sense is not a length", run.stderr)


if __name__ == "__main__":
    unittest.main()
