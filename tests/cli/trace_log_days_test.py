"""What `gumshoe new` and `gumshoe trace` make of a log of days whose clock starts anew each day.

usage: trace_log_days_test.py path/to/gumshoe [unittest options]
"""
import random
import unittest

from traced_log import TracedLog

HEADER = "day,time (min),z (um)"


def days(noise, of_day, count=12, minutes=range(0, 240, 10)):
    """Rows of so many days; `of_day` is what each adds to the readings."""
    return [HEADER] + [f"{d},{t},{of_day(d) + noise.gauss(0, 0.4):.2f}" for d in range(1, count + 1) for t in minutes]


class Days(TracedLog):
    def slope(self, rows, *words):
        """The verdict, and the remark on the number of the day."""
        self.log(rows)
        verdict = self.verdict("log.toml", *words)
        remarks = [r for f in verdict["findings"] for r in f.get("remarks", []) if "day_number" in r]
        return verdict, remarks

    def test_a_time_that_starts_anew_is_no_order(self):
        """Sorted by it, all first readings of a day would come before all second ones."""
        text = self.log(days(random.Random(1), lambda d: 0))
        self.assertNotIn("\norder =", text)
        self.assertIn("it starts anew with each day: the readings are in the order of the rows", text)
        self.assertIn('day_number = "day"', text.split("[trace.columns]")[1])

    def test_a_time_that_goes_on_is_the_order(self):
        rows = [HEADER] + [f"{d},{1440 * d + t},0" for d in range(1, 7) for t in range(0, 240, 10)]
        text = self.log(rows)
        self.assertIn('\norder = "time"', text)
        self.assertNotIn("day_number", text)

    def test_times_of_rows_in_any_order_sort_them(self):
        rows = days(random.Random(2), lambda d: 0)
        lines = rows[1:]
        random.Random(3).shuffle(lines)
        self.assertIn('\norder = "time"', self.log([HEADER, *lines]))

    def test_runs_within_days(self):
        """Both change where the time goes back; only what never falls is a number of the rows' order."""
        rows = ["day,run,time (min),z (um)"]
        rows += [f"{d},{r},{t},0.{t % 7}" for d in range(1, 6) for r in (1, 2, 3) for t in range(0, 50, 5)]
        text = self.log(rows)
        self.assertIn("starts anew with each day or run", text)
        self.assertIn("day_number", text)
        self.assertNotIn("run_number", text)

    def test_a_trend_over_days_is_found(self):
        """And no scatter from day to day that nothing can be done about: 0.7 um a day, with and without a time."""
        rows = days(random.Random(4), lambda d: 0.7 * d)
        for log in (rows, [",".join((r.split(",")[0], r.split(",")[2])) for r in rows]):
            verdict, remarks = self.slope(log)
            self.assertEqual([f["depends_on"] for f in verdict["findings"]], [["day_number"]])
            self.assertRegex(remarks[-1], r"a straight line against day_number: 0\.(6[6-9]|7[0-3])\d* um, u = 0\.0[01]\d* um")
            self.assertLess(verdict["rms"]["holdout_after"], 0.25 * verdict["rms"]["holdout_before"])

    def test_days_that_scatter_do(self):
        """Seeds fixed by their numbers: a trend that chance gives may be found in one of twenty."""
        found = 0
        for seed in range(20):
            noise = random.Random(100 + seed)
            of = [noise.gauss(0, 1.5) for _ in range(13)]
            verdict, _ = self.slope(days(noise, lambda d: of[d]))
            found += any("day_number" in f["depends_on"] for f in verdict["findings"])
            self.assertTrue(verdict["findings"])
        self.assertLessEqual(found, 2)

    def test_noise_alone_is_quiet(self):
        loud = sum(bool(self.slope(days(random.Random(200 + seed), lambda d: 0))[0]["findings"]) for seed in range(20))
        self.assertLessEqual(loud, 3)


if __name__ == "__main__":
    unittest.main()
