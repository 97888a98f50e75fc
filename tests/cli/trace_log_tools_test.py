"""What `gumshoe new` and `gumshoe trace` make of logs with groups: tools of a tool setter, twice a day, and long blocks.

usage: trace_log_tools_test.py path/to/gumshoe [unittest options]
"""
import random
import unittest

from traced_log import TracedLog

TOOLS, DAYS, PASSES = 6, 8, 2


class Tools(TracedLog):
    def tools(self, seed, of_day, scatter=0.0):
        """The verdict on a log of tools whose offsets nobody declared. `of_day(tool, day)` is added; um."""
        noise = random.Random(seed)
        offset = [noise.gauss(0, 5) for _ in range(TOOLS)]
        rows = ["day,tool,time (min),dz (um)"]
        for day in range(DAYS):
            of_tool = [noise.gauss(0, scatter) for _ in range(TOOLS)]
            for again in range(PASSES):
                start = 1440 * day + 180 * again + noise.uniform(0, 60)
                for tool in range(TOOLS):
                    if noise.random() < 0.1:
                        continue
                    value = offset[tool] + of_tool[tool] + of_day(tool, day) + noise.gauss(0, 1)
                    rows.append(f"day {day + 1},T{tool + 1},{start + 4 * tool:.1f},{value:.1f}")
        self.log(rows)
        return self.verdict("log.toml")

    def test_two_tools_that_were_hit(self):
        """Tools 2 and 5 are 15 um shorter from day 5 on: with a step of either alone the other still looks like scatter
        by day and tool. Held-out days must be predicted to the noise of 1 um."""
        found = 0
        for seed in range(8):
            verdict = self.tools(seed, lambda tool, day: -15.0 if tool in (1, 4) and day >= 4 else 0.0)
            steps = {w for f in verdict["findings"] for w in ("tool T2 after", "tool T5 after") if w in f.get("described_by", "")}
            if steps != {"tool T2 after", "tool T5 after"}:
                continue
            found += 1
            self.assertNotIn("scatter", [f["kind"] for f in verdict["findings"]])
            self.assertLess(verdict["rms"]["holdout_after"], 1.6)
        self.assertGreaterEqual(found, 6)

    def test_a_tool_changed_and_changed_back(self):
        """Tool 2 is 12 um longer on the days 3 and 4: alone it looks like scatter by day and tool, too."""
        found = 0
        for seed in range(8):
            verdict = self.tools(50 + seed, lambda tool, day: 12.0 if tool == 1 and day in (2, 3) else 0.0)
            told = [f.get("described_by", "") for f in verdict["findings"] if f["depends_on"] != ["tool"]]  # nobody declared offsets
            found += len(told) == 1 and told[0].startswith("while:time with tool T2 from reading ")
        self.assertGreaterEqual(found, 6)

    def test_clampings_that_scatter_do(self):
        """Each tool is clamped anew each day, by 3 um: no few steps stand for that."""
        for seed in range(6):
            verdict = self.tools(100 + seed, lambda tool, day: 0.0, scatter=3)
            self.assertIn(["day", "tool"], [f["depends_on"] for f in verdict["findings"] if f["kind"] == "scatter"])
            self.assertFalse([f for f in verdict["findings"] if "step:time" in f.get("described_by", "")])


class LongBlocks(TracedLog):
    def test_blocks_of_many_readings_scatter(self):
        """Twenty blocks of ninety readings, each off by its own 3 um: noise that resembles the reading before it, as
        strongly as is tried, explains much of that, and no draw of such noise has a block's scatter."""
        noise = random.Random(5)
        rows = ["block,direction,x (mm),time (min),e (um)"]
        for block in range(20):
            off = noise.gauss(0, 3)
            for way, places in (("up", range(45)), ("down", range(44, -1, -1))):
                for k, place in enumerate(places):
                    time = 120 * block + 40 * (way == "down") + 0.8 * k
                    rows.append(f"{block + 1},{way},{10 * place},{time:.1f},{off + noise.gauss(0, 1):.2f}")
        self.log(rows)
        verdict = self.verdict("log.toml")
        scatter, = (f for f in verdict["findings"] if f["kind"] == "scatter")
        self.assertEqual(scatter["depends_on"], ["block"])


class DaysThatScatter(TracedLog):
    def found(self, seed, drift):
        """Eighteen days of eight readings, zeroed anew every morning by 1.5 um; noise of 0.5 um."""
        noise = random.Random(seed)
        rows = ["date,time (min),gauge (um)"]
        for day in range(18):
            off = noise.gauss(0, 1.5) + drift * day
            rows += [f"2026-03-{day + 1:02d},{1440 * day + 60 * k + noise.uniform(0, 20):.1f},{off + noise.gauss(0, 0.5):.2f}" for k in range(8)]
        self.log(rows)
        return {f.get("described_by") or f["name"] for f in self.verdict("log.toml")["findings"]}

    def test_a_drift_of_days_that_scatter(self):
        """0.6 um a day over the fourteen days that are fitted is 6 of its standard uncertainties. The days explain it, too, and what a
        reading has of it is little: it had been refused as one of a few readings."""
        both = [self.found(seed, 0.6) for seed in range(8)]
        self.assertGreaterEqual(sum("polynomial:time" in f and "scatter:date" in f for f in both), 4, both)

    def test_days_that_scatter_alone(self):
        alone = [self.found(100 + seed, 0) for seed in range(12)]
        self.assertLessEqual(sum("polynomial:time" in f for f in alone), 2, alone)  # of 5 %
        self.assertGreaterEqual(sum(f == {"scatter:date"} for f in alone), 9, alone)


SETTER = """schema = 1
[model]
name = "expression"
[model.indications]
d = "length"
[quantities]
length = { estimated = true, value = "0 um" }
[indications.d]
readings = { file = "log.csv", column = "d", unit = "um", labels = { day = "day", tool = "tool" }%s }
[trace]
blocks = "day"
draws = 199
"""


class RepeatsTogether(TracedLog):
    def traced(self, of_clamping, more=""):
        """Three repeats of each of five tools on twelve days; noise of 0.7 um."""
        noise = random.Random(3)
        rows = ["day,tool,d"]
        for day in range(12):
            for tool in range(5):
                off = noise.gauss(0, of_clamping)
                rows += [f"{day},T{tool},{off + noise.gauss(0, 0.7):.3f}" for _ in range(3)]
        (self.folder / "log.csv").write_text("\n".join(rows) + "\n")
        (self.folder / "log.toml").write_text(SETTER % more)
        return self.verdict("log.toml")

    def test_repeats_that_are_off_together(self):
        """Clampings scatter by 2 um: means say so, but not of what, and a reading has not the noise of three times their mean square."""
        said, = (s for s in self.traced(2)["statements"] if "repeats scatter" in s)
        self.assertRegex(said, r"^repeats scatter by only 0\.[67]\d* um about their means, which differ as if a reading had [234](\.\d+)? um")
        self.assertEqual([f["depends_on"] for f in self.traced(2, ', repeats = "apart"')["findings"]], [["day", "tool"]])

    def test_repeats_alone(self):
        self.assertFalse([s for s in self.traced(0)["statements"] if "repeats scatter" in s])


if __name__ == "__main__":
    unittest.main()
