"""Logs without positions, from the file to the causes: what readings depend on, and by how much.

usage: trace_log_test.py path/to/gumshoe [unittest options]
"""
import datetime
import math
import random
import re
import unittest

from program import gumshoe
from traced_log import TracedLog


def drifts():
    """A spindle that runs and rests, a column that follows slowly, the air of the hall: um, every two minutes."""
    draw, spindle, column = random.Random(5), 20.0, 20.0
    start = datetime.datetime(2026, 3, 4, 8)
    yield "timestamp,T_spindle_C,T_column_C,T_air_C,z_um,y_um"
    for i in range(360):
        spindle += ((38 if i // 90 % 2 == 0 else 20.5) - spindle) * 2 / 25
        column += (20 + 0.15 * (spindle - 20) - column) * 2 / 120
        air = 20 + 0.4 * math.sin(i / 60)
        z = -1.1 * (spindle - 20) + 2.3 * (column - 20) + draw.gauss(0, 0.25)
        y = 0.5 * (column - 20) + 0.8 * (air - 20) + draw.gauss(0, 0.2)
        seen = [f"{t + draw.gauss(0, 0.03):.2f}" for t in (spindle, column, air)]
        yield f"{(start + datetime.timedelta(minutes=2 * i)).isoformat(sep=' ')},{','.join(seen)},{z:.2f},{y:.2f}"


def probed_ring():
    """The centre of a ring, probed at four speeds, with coolant and without: mm, as a German control writes it."""
    draw, spindle = random.Random(8), 22.0
    start = datetime.datetime(2026, 5, 4, 6)
    yield "Nr;Datum;Drehzahl [1/min];Kuehlung;T Spindel [°C];X Mitte [mm];Y Mitte [mm]"
    for i in range(1, 145):
        speed, coolant = 4000 * (i // 18 % 4), i // 36 % 2
        spindle += (22 + 0.0012 * speed - 3 * coolant - spindle) * 0.25
        x = 100 + 0.004 * (spindle - 22) + 0.0015 * coolant + draw.gauss(0, 0.0006)
        y = 50 - 0.0011 * (spindle - 22) + draw.gauss(0, 0.0006)
        when = (start + datetime.timedelta(minutes=10 * i)).strftime("%d.%m.%Y %H:%M")
        seen = ";".join(t.replace(".", ",") for t in (f"{spindle + draw.gauss(0, 0.05):.1f}", f"{x:.4f}", f"{y:.4f}"))
        yield f"{i};{when};{speed};{('aus', 'ein')[coolant]};{seen}"


def first_loading():
    """A force transducer in six runs, of which the first shows 2e-3 more: it was not run in yet."""
    draw = random.Random(9)
    yield "run,direction,load_kN,d_mV/V"
    for run in range(1, 7):
        for way in (1, -1):
            for load in range(0, 60, 10)[::way]:
                yield f"{run},{way},{load},{0.04 * load * (1.002 if run == 1 else 1) + draw.gauss(0, 4e-4):.5f}"


def three_machines():
    """A load cell read on three machines in six runs; one machine shows 0.02 um/N more."""
    draw = random.Random(1)
    yield "run,machine,load_N,d_um"
    for run in range(1, 7):
        for machine in "ABC":
            for load in range(0, 120, 20):
                yield f"{run},{machine},{load},{5 + 0.3 * load + (0.02 * load if machine == 'C' else 0) + draw.gauss(0, 0.4):.3f}"


def cooled_hall():
    """A spindle that warms up in a hall whose air conditioning cycles every 17.3 min: um, each minute."""
    draw = random.Random(5)
    yield "time_min,dev_um"
    for t in range(360):
        y = 4 * (1 - math.exp(-t / 90)) + 0.8 * math.sin(2 * math.pi * t / 17.3 + 0.4) + draw.gauss(0, 0.3)
        yield f"{t},{y:.2f}"


def ball_screw():
    """An axis measured every 3 mm in both directions; the ball screw, of 20 mm lead, wobbles by 0.7 um."""
    draw = random.Random(6)
    yield "run,pos_mm,dir,dev_um"
    for run in range(1, 4):
        for sign in (1, -1):
            for i in range(201)[::sign]:
                y = 0.012 * i + 0.7 * math.cos(2 * math.pi * 3 * i / 20 + 1) + 0.75 * sign + draw.gauss(0, 0.3)
                yield f"{run},{3 * i},{'+' if sign > 0 else '-'},{y:.2f}"


def slipped():
    """An axis in six cycles, in both directions; between two readings of the third the reflector slips by 2.4 um."""
    draw, t = random.Random(17), 0
    yield "cycle,position_mm,direction,time_s,dev_um"
    for cycle in range(1, 7):
        for way in (1, -1):
            for place in range(0, 11)[::way]:
                slip = 2.4 if cycle > 3 or (cycle == 3 and way < 0 and place < 7) else 0
                yield f"{cycle},{50 * place},{way},{t},{0.004 * 50 * place + 0.6 * way + slip + draw.gauss(0, 0.6):.2f}"
                t += 12


def two_probes():
    """A straightedge in five passes by two probes, each with an error of its own along the slide: um."""
    draw = random.Random(7)
    error = {"P1": [draw.gauss(0, 2) for _ in range(13)], "P2": [2 + draw.gauss(0, 2) for _ in range(13)]}
    yield "pass,probe,x_mm,y_um"
    for turn in range(1, 6):
        for probe in ("P1", "P2"):
            for i in range(13):
                yield f"{turn},{probe},{40 * i},{error[probe][i] + draw.gauss(0, 0.3):.2f}"


def worn_tool():
    """Four tools on a setter, in eight sessions: the spindle grows, and one tool wears by 6 um/h."""
    draw, t = random.Random(2), 0
    lengths = {"T1": 120.1, "T2": 85.3, "T3": 101.77, "T4": 66.5}
    yield "session,tool,touch,time_s,length_mm"
    for session in range(1, 9):
        for tool, length in lengths.items():
            for touch in range(1, 4):
                y = 9 * (1 - math.exp(-t / 1200)) - (6 / 3600 * t if tool == "T3" else 0) + draw.gauss(0, 0.6)
                yield f"{session},{tool},{touch},{t},{length + 1e-3 * y:.4f}"
                t += 45


def warm_screw():
    """A screw that warms by 15 K and grows away from its bearing at 0: 3.45 um/(m K), in both directions, with a play."""
    draw, screw = random.Random(8), 20.0
    yield "minutes;X soll mm;richtung;T_screw degC;abw um"
    for k in range(60):
        screw += (35 - screw) * 5 / 60
        for place in (0, 150, 300, 450):
            for sign in (1, -1):
                y = 3.45e-3 * (screw - 20) * place + 0.8 * sign + draw.gauss(0, 0.3)
                yield f"{5 * k + place / 600:.1f};{place};{sign};{screw + draw.gauss(0, 0.1):.1f};{y:.2f}".replace(".", ",")


def rotary_table():
    """A table turned by 30 deg in both directions, with one wave and two waves per turn: arcsec."""
    draw = random.Random(9)
    yield "cycle,C_deg,dir,err_arcsec"
    for cycle in range(1, 6):
        for sense, sign in (("cw", 1), ("ccw", -1)):
            for i in range(13)[::sign]:
                t = math.radians(30 * i)
                yield f"{cycle},{30 * i},{sense},{4 * math.sin(t + 0.3) + 1.2 * math.sin(2 * t) + 1.5 * sign + draw.gauss(0, 0.3):.2f}"


class TraceLog(TracedLog):
    def trace(self, rows):
        self.log(rows)
        run = gumshoe("check", "log.toml", cwd=self.folder)
        self.assertEqual(run.returncode, 0, run.stderr)
        v = self.verdict("log.toml")
        self.assertLess(v["rms"]["holdout_after"], v["rms"]["holdout_noise_interval95"][1])
        return v

    def sizes(self, v):
        """Slopes and steps in um, with u: {described by: (size, u)}."""
        out = {}
        for f in v["findings"]:
            for remark in f["remarks"]:
                if said := re.search(r"(?:: |by )(\S+) um\S*, u = (\S+) um", remark):
                    out[f["described_by"]] = float(said[1]), float(said[2])
        return out

    def agree(self, found, true):
        """Within 3.5 u, and what the scatter of the recorded temperatures takes from a slope."""
        for name, size in true.items():
            self.assertIn(name, found)
            self.assertAlmostEqual(found[name][0], size, delta=3.5 * found[name][1] + 0.02 * abs(size), msg=name)

    def test_drifts_follow_the_temperatures_that_cause_them(self):
        """Not any curve in time, which describes as much and predicts nothing."""
        v = self.trace(drifts())
        self.agree(self.sizes(v), {"polynomial:t_spindle_c of z_um": -1.1, "polynomial:t_column_c of z_um": 2.3,
                                   "polynomial:t_column_c of y_um": 0.5, "polynomial:t_air_c of y_um": 0.8})
        self.assertFalse([f["described_by"] for f in v["findings"] if "time" in f["depends_on"]])

    def test_what_a_control_wrote_tells_growth_and_coolant(self):
        v = self.trace(probed_ring())
        self.agree(self.sizes(v), {"polynomial:t_spindel_c of x_mitte_mm": 4, "polynomial:t_spindel_c of y_mitte_mm": -1.1,
                                   "step:kuehlung ein of x_mitte_mm": 1.5})

    def test_one_machine_has_another_slope(self):
        v = self.trace(three_machines())
        self.assertEqual([f["described_by"] for f in v["findings"]], ["product:position*machine C"])
        said = re.search(r"machine C alone has a straight line against position: (\S+) um/N, u = (\S+) um/N", " ".join(v["findings"][0]["remarks"]))
        self.assertAlmostEqual(float(said[1]), 0.02, delta=3.5 * float(said[2]))
        # As it was written, it predicts what it was found in, and nothing is found again.
        again = self.verdict("log.traced.toml")
        self.assertEqual(again["findings"], [])
        self.assertAlmostEqual(again["rms"]["before"] / v["rms"]["after"], 1, delta=0.02)
        self.assertAlmostEqual(again["rms"]["holdout_before"] / v["rms"]["holdout_after"], 1, delta=0.02)

    def test_a_wave_of_unknown_period_is_told_with_its_period(self):
        for rows, along, period, amplitude in ((cooled_hall(), "time", 17.3, 0.8), (ball_screw(), "position", 20, 0.7)):
            v = self.trace(rows)
            wave = [f for f in v["findings"] if f["described_by"] == f"wave:{along}"]
            self.assertEqual(len(wave), 1, [f["described_by"] for f in v["findings"]])
            said = re.search(r"period (\S+) \S+, u = (\S+) \S+; amplitude (\S+) um, u = (\S+) um", " ".join(wave[0]["remarks"]))
            for true, value, u in ((period, said[1], said[2]), (amplitude, said[3], said[4])):
                self.assertAlmostEqual(float(value), true, delta=3.5 * float(u))

    def test_a_step_is_told_with_its_instant(self):
        v = self.trace(slipped())
        step = [f for f in v["findings"] if f["described_by"].startswith("step:time after reading ")]
        self.assertEqual(len(step), 1, [f["described_by"] for f in v["findings"]])
        # Readings 1 to 22 are one cycle; the last before the slip is the fourth on the way back of the third.
        self.assertAlmostEqual(int(step[0]["described_by"].split()[-1]), 2 * 22 + 11 + 4, delta=2)
        size, u = re.search(r"it differs by (\S+) um, u = (\S+) um", " ".join(step[0]["remarks"])).groups()
        self.assertAlmostEqual(float(size), 2.4, delta=3.5 * float(u))
        self.assertIn("Something changed after reading", " ".join(v["plain"]))

    def test_a_column_that_counts_the_readings_is_their_course(self):
        draw = random.Random(3)
        v = self.trace(["n,diameter_mm"] + [f"{i},{25.003 + 1e-3 * ((1.5 if i > 47 else 0) + draw.gauss(0, 0.4)):.5f}" for i in range(1, 81)])
        self.assertEqual([f["depends_on"] for f in v["findings"]], [["n"]])
        self.assertAlmostEqual(int(v["findings"][0]["described_by"].split()[-1]), 47, delta=2)
        again = self.verdict("log.traced.toml")
        self.assertEqual(again["findings"], [])
        self.assertAlmostEqual(again["rms"]["holdout_before"] / v["rms"]["holdout_after"], 1, delta=0.02)

    def test_the_first_run_may_have_another_slope(self):
        v = self.trace(first_loading())
        self.assertEqual([f["described_by"] for f in v["findings"]], ["product:position*run 1"])
        slope, u = re.search(r"run 1 alone has a straight line against position: (\S+) \S+, u = (\S+) ", " ".join(v["findings"][0]["remarks"])).groups()
        self.assertAlmostEqual(float(slope), 8e-5, delta=3.5 * float(u))

    def test_each_part_may_have_a_curve_of_its_own(self):
        v = self.trace(two_probes())
        self.assertEqual([f["described_by"] for f in v["findings"]], ["table:position*probe"])
        # A value of each cell from four readings leaves sqrt(1 + 1/4) of the noise.
        self.assertAlmostEqual(v["rms"]["holdout_after"], 0.3e-6 * math.sqrt(1.25), delta=3 * 0.3e-6 / math.sqrt(2 * 26))
        again = self.verdict("log.traced.toml")
        self.assertEqual(again["findings"], [])
        self.assertAlmostEqual(again["rms"]["holdout_before"] / v["rms"]["holdout_after"], 1, delta=0.02)

    def test_one_tool_wears(self):
        """Each tool has a length of its own, which `new` sees; the growth is of all of them, and the wear of one."""
        v = self.trace(worn_tool())
        self.assertIn("by.tool", (self.folder / "log.toml").read_text())
        self.assertEqual({f["described_by"] for f in v["findings"]}, {"drift:time", "product:time*tool T3"})
        wear = next(f for f in v["findings"] if "T3" in f["described_by"])
        slope, u = re.search(r"tool T3 alone has a straight line against time: (\S+) um/h, u = (\S+) um/h", " ".join(wear["remarks"])).groups()
        self.assertAlmostEqual(float(slope), -6, delta=3.5 * float(u))
        growth = next(f for f in v["findings"] if f["described_by"] == "drift:time")
        said = re.search(r"time constant (\S+) min, u = (\S+) min; until it levels off it changes by (\S+) um, u = (\S+) um", " ".join(growth["remarks"])).groups()
        for true, value, u in ((20, said[0], said[1]), (9, said[2], said[3])):
            self.assertAlmostEqual(float(value), true, delta=3.5 * float(u))
        self.assertIn("on tool T3 alone", " ".join(v["plain"]))

    def test_growth_with_a_temperature_is_one_shape(self):
        """Not a smooth surface of many sizes: readings that are far off without it are not outlying with it."""
        v = self.trace(warm_screw())
        self.assertEqual([f["described_by"] for f in v["findings"]], ["product:position*t_screw_degc"])
        self.assertIn("zero at the lowest position", " ".join(v["findings"][0]["remarks"]))

    def test_a_turn_shows_its_waves_and_has_no_gain(self):
        v = self.trace(rotary_table())
        self.assertNotIn("gain", (self.folder / "log.toml").read_text())
        self.assertEqual([f["depends_on"] for f in v["findings"]], [["position"]])
        said = dict((int(n), (float(a), float(u))) for n, a, u in
                    re.findall(r"(\d) waves? (\S+) arcsec, u = (\S+) arcsec", " ".join(v["findings"][0]["remarks"])))
        for waves, true in ((1, 4), (2, 1.2)):
            self.assertAlmostEqual(said[waves][0], true, delta=3.5 * said[waves][1])

    def test_a_table_by_position_shows_the_lead_of_the_screw(self):
        draw, rows = random.Random(3), ["run,dir,x_mm,error_um"]
        for run in range(1, 6):
            for way in (1, -1):
                rows += [f"{run},{way},{x},{0.8 * math.sin(2 * math.pi * x / 100) - 0.02 * x - 0.7 * way + draw.gauss(0, 0.3):.2f}"
                         for x in range(0, 501, 25)[::way]]
        v = self.trace(rows)
        self.assertEqual([f["described_by"] for f in v["findings"]], ["table:position"])
        period, size, share = re.search(r"a wave of period (\S+) mm and amplitude (\S+) um explains (\d+) % of it",
                                        " ".join(v["findings"][0]["remarks"])).groups()
        # Ten readings a level: u of the amplitude 0.3 sqrt(2 / 210); of the period 100 mm / 5 cycles of its u over pi.
        u = 0.3 * math.sqrt(2 / 210)
        self.assertAlmostEqual(float(size), 0.8, delta=3.5 * u)
        self.assertAlmostEqual(float(period), 100, delta=3.5 * 20 * math.sqrt(6) / math.pi * u / 0.8)
        self.assertGreaterEqual(int(share), 80)

    def test_a_slope_of_one_channel_goes_before_scatter_of_blocks(self):
        """A spindle and its room: three channels, of which one follows the room's slow temperature as well."""
        draw, spindle, rows = random.Random(3), 21.0, ["t_min,X_um,Y_um,Z_um,T_spindle,T_room,rpm"]
        for k in range(240):
            rpm = 6000 if k // 60 % 2 == 0 else 0
            spindle += ((34 if rpm else 21) - spindle) / 25
            room = 20.5 + 0.6 * math.sin(k / 240 * 2 * math.pi)
            y = (-0.3 * (spindle - 21), 0.9 * (spindle - 21), 2.1 * (spindle - 21) + 0.6 * (room - 20.5))
            rows.append(f"{k}," + ",".join(f"{v + draw.gauss(0, 0.35):.1f}" for v in y) + f",{spindle + draw.gauss(0, 0.05):.2f},{room + draw.gauss(0, 0.05):.2f},{rpm}")
        v = self.trace(rows)
        self.agree(self.sizes(v), {"polynomial:t_spindle of z_um": 2.1, "polynomial:t_spindle of y_um": 0.9,
                                   "polynomial:t_spindle of x_um": -0.3, "polynomial:t_room of z_um": 0.6})

    def test_an_operator_before_his_slope(self):
        """Operator B presses by 1.2 um everywhere: no slope or table of his, which describe four lengths as well."""
        for seed in (1, 2, 3):
            draw, rows = random.Random(seed), ["date,machine,operator,feature,nominal_mm,measured_mm,temp_c"]
            for day in range(2, 8):
                warm = 20 + draw.gauss(0, 0.6)
                for machine, operator in (("M1", "A"), ("M1", "B"), ("M2", "A"), ("M2", "B")):
                    for k, length in enumerate((25, 50, 75, 100)):
                        y = length + 0.0012 * (operator == "B") + draw.gauss(0, 0.0006)
                        rows.append(f"2026-02-{day:02},{machine},{operator},F{k + 1},{length},{y:.4f},{warm:.1f}")
            v = self.trace(rows)
            self.assertEqual([f["described_by"] for f in v["findings"]], ["step:operator B"])

    def test_a_slope_by_a_speed_has_a_unit(self):
        """um per 1/min; and channels whose noises differ tenfold."""
        draw, rows = random.Random(6), ["series;direction;n [1/min];dx [um];dy [um]"]
        for series in range(1, 4):
            for way in ("up", "down"):
                for n in (range(1000, 9000, 1000) if way == "up" else range(8000, 0, -1000)):
                    rows.append(f"{series};{way};{n};{draw.gauss(0, 1):.2f};{-0.6 * n / 8000 + draw.gauss(0, 0.1):.2f}")
        v = self.trace(rows)
        self.assertEqual([f["described_by"] for f in v["findings"]], ["polynomial:n_1_min of dy_um"])
        self.assertTrue(any("um/(1/min), u = " in remark for remark in v["findings"][0]["remarks"]))
        slope, u = re.search(r"(\S+) um/\(1/min\), u = (\S+) um", " ".join(v["findings"][0]["remarks"])).groups()
        self.assertAlmostEqual(float(slope), -0.6 / 8000, delta=3.5 * float(u))


if __name__ == "__main__":
    unittest.main()
