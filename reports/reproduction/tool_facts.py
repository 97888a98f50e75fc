"""What the curves say about one reading, start angles, hidden teeth, phase and time: the second half of tools.md."""

import math

import numpy as np

import mills
import tool_figures
from mills import EXAMPLE_1, EXAMPLE_3, EXPERIMENT

ERRATA = "../errata.md#"


def lowest_radius(tool):
    """Distance of an insert's lowest point from the tool's axis."""
    angle = math.radians(tool["insert_radial_angle (deg)"])
    r, big = tool["tool_radius (mm)"], tool["insert_radius (mm)"]
    return math.hypot(r - big * math.cos(angle), big * math.sin(angle))


def distribution(tool, points=240):
    """Range and standard deviation of a reading over a uniform start angle, in f_z: midpoints of one tooth's turn."""
    n = tool["inserts (1)"]
    z = mills.curve(tool, (np.arange(points) + 0.5) * 360 / n / points) / (mills.per_turn(tool) / n)
    return np.ptp(z), np.std(z), np.mean(z) - np.max(z)


def one_readout(lines, table, um):
    tools = [EXAMPLE_1, EXAMPLE_3, EXPERIMENT,
             {**EXAMPLE_1, "tool_radius (mm)": 16, "insert_radius (mm)": 4, "insert_radial_angle (deg)": -3,
              "insert_axial_angle (deg)": 5, "insert_thickness (mm)": 3}]
    equal = {f"wear_{k} (mm)": 0 for k in (1, 2, 3)}
    turns = [(3000, 3), (3000, 30), (1000, 30), (1000, 60), (500, 60)]
    rows, dots = [], []
    for n in (1, 2, 3, 4, 6):
        row = [n]
        for speed, feed in turns:
            found = []
            for tool in tools:
                for share in (0.92, 0.96, 1.0, 1.02):
                    found.append(distribution({**tool, **equal, "inserts (1)": n, "start_height (mm)": 0.5,
                                               "offset (mm)": share * lowest_radius(tool), "feed (mm/min)": feed,
                                               "spindle_speed (rpm)": speed}))
            dots += [(n, w, s) for w, s, _ in found]
            w, s = [f[0] for f in found], [f[1] for f in found]
            row.append(f"{min(w):.2f} to {max(w):.2f}; {min(s):.2f} to {max(s):.2f}")
        rows.append(row)
    for n, w, s in dots:  # w is read off 240 points, each step of which may hide 1/240 of the range
        assert w <= 1 + 1e-9 and s <= 1 / math.sqrt(12) + 1e-3 and s >= (w**1.5 / math.sqrt(12)) - 0.005, (n, w, s)
    lines += ["## One reading at a random start angle", "",
              "Starting s degrees further on is the same descent, started higher by s v / (360 N_s). The line that comes",
              "down lies that much higher, so it meets the inserts later: along the curve Z_t **rises at most by",
              "v / (360 N_s) per degree, and jumps only down**. Equal teeth repeat every 360 / n deg. From these two follows",
              "what holds for every geometry: a reading lies at most f_z below the peak; and with the range w f_z, w <= 1,",
              "every height between is met with a density of at least 1 / f_z, so that the standard deviation over a random",
              "angle lies between f_z w^1.5 / sqrt(12) and f_z sqrt(w^2 / 4 - w^3 / 6), never above f_z / sqrt(12) = 0.29 f_z.",
              "",
              "How far it stays below is geometry: a tooth that sinks deep below the last pass triggers on the rising side of",
              "its hump, before it has sunk on, and a second hump catches what the first has just missed. Range and standard",
              "deviation in f_z of four tools (examples 1 and 3, the experiment's, and one of r = 16, R = 4 mm), each with",
              "1 to 6 equal teeth and offsets of 0.92, 0.96, 1 and 1.02 times the radius of the insert's lowest point:", ""]
    header = ["n"] + [f"{f} mm/min, {s} rpm ({1e3 * f / s:.0f} um a turn)" for s, f in turns]
    lines += table(header, rows)
    own = [(label, distribution({**tool, **equal}), 1e3 * mills.per_turn(tool) / tool["inserts (1)"])
           for label, tool in (("example 1", EXAMPLE_1), ("example 3, no wear", EXAMPLE_3),
                               ("experiment, no wear", EXPERIMENT))]
    lines += table(["tool", "f_z, um", "farthest below the peak", "mean below the peak", "standard deviation"],
                   [[label, f"{fz:.1f}", f"{w:.3f} f_z = {w * fz:.2f} um", f"{-m:.3f} f_z = {-m * fz:.2f} um",
                     f"{s:.3f} f_z = {s * fz:.2f} um"] for label, (w, s, m), fz in own])
    usual = [(w, s) for n, w, s in dots if n <= 3]
    w, s = sorted(u[0] for u in usual), sorted(u[1] for u in usual)
    tenth = len(usual) // 10
    lines += [f"Of all {len(usual)} cases with one to three teeth the middle 80 % have a range of {w[tenth]:.2f} to "
              f"{w[-tenth - 1]:.2f} f_z and a standard deviation of {s[tenth]:.2f} to {s[-tenth - 1]:.2f} f_z; many teeth with "
              "a coarse feed spread less.",
              "One reading makes these three tools short by about a third of f_z on average, and never long. At 3 mm/min and 3000 rpm (f_z = 0.5 um with two teeth) both are negligible, and paid for in time.",
              "", "![spread of one reading](../figures/tool_spread.svg)", ""]
    tool_figures.spread(dots)


def tops(tool):
    """The peak of each flute."""
    peaks = mills.extremes(tool)[0]
    return {k: max(h for _, h, flute in peaks if flute == k) for k in range(1, int(tool["inserts (1)"]) + 1)}


def shortfalls(tool, top, m, phases=160):
    """Shortfall of each flute's highest reading against its peak, over the phase of m equally spaced angles; infinite
    where the flute does not show."""
    phase = np.arange(phases) / phases
    angles = (phase[:, None] + np.arange(m)) * 360 / m
    z, which = (x.reshape(phases, m) for x in mills.flutes(tool, angles.ravel()))
    return phase, {k: top[k] - np.max(np.where(which == k, z, -np.inf), axis=1) for k in top}


def start_angles(lines, table, um):
    rows, series = [], []
    top, top_cut = tops(EXAMPLE_1), tops(EXPERIMENT)
    for m in (4, 5, 6, 7, 11, 12, 13, 24, 25):
        phase, by_flute = shortfalls(EXAMPLE_1, top, m)
        short = np.min(list(by_flute.values()), axis=0)
        _, cut = shortfalls(EXPERIMENT, top_cut, m)
        n = EXAMPLE_1["inserts (1)"]
        turn, distinct = mills.per_turn(EXAMPLE_1), m // math.gcd(m, n)
        bound = turn / (n * distinct)
        assert short.max() <= bound * (1 + 1e-9), (m, short.max(), bound)
        rows.append([m, um(turn / m, 2), distinct, um(bound, 2), um(short.max(), 2), um(short.mean(), 2),
                     um(cut[1].max(), 2), um(cut[2].max(), 2) if np.all(np.isfinite(cut[2])) else "not shown", um(cut[2].mean(), 2)])
        if m in (4, 6, 11, 12, 24):
            series.append((f"m = {m}", phase, short))
    lines += ["## m equally spaced start angles", "",
              "They sample the heights on a grid of v / (N_s m): with twelve angles at 1000 rpm and 30 mm/min, of 2.5 um. Of",
              "equal teeth m angles have m / gcd(m, n) distinct phases, so an m coprime to n tells more. Since the curve rises",
              "at most by v / N_s per turn, the highest reading falls short of the peak by less than f_z gcd(m, n) / m. How",
              "much less, worst and mean over the phase, which nobody knows (next but one section), is geometry; in um:", ""]
    lines += table(["m", "grid v / (N_s m)", "distinct phases, n = 2", "bound f_z gcd(m, n) / m", "example 1: worst",
                    "example 1: mean", "experiment, flute 1: worst", "flute 2 (worn 2 um): worst", "flute 2: mean"], rows)
    lines += ["Connecting dots can only underestimate; a fit of the curve itself has no such floor. Teeth that differ have",
              "no common period, and the flutes' columns show what is then left of the advantage of a coprime m.", "",
              "![shortfall over the phase](../figures/tool_grid.svg)", ""]
    tool_figures.grid(series)


def hidden(lines, table, um):
    rows = []
    angles = np.arange(0, 360, 0.5)
    for wear in (0, 0.002, 0.005, 0.010, 0.0125, 0.0135, 0.0145, 0.0149, 0.0151, 0.020):
        tool = {**EXAMPLE_1, "wear_2 (mm)": wear}
        z, which = mills.flutes(tool, angles)
        shown = z[which == 2]
        top = np.max(z)
        rows.append([um(wear, 1), f"{wear / 0.015:.3f}", f"{np.mean(which == 2):.3f}",
                     f"{max(0.0, 1 - wear / 0.015) / 2:.3f}",
                     um(top - np.max(shown), 2) if len(shown) else "-"])
    third = {**EXAMPLE_3, "wear_2 (mm)": 0.025, "wear_3 (mm)": 0.010}
    which = mills.flutes(third, angles)[1]
    lines += ["## A worn tooth hides", "",
              "Example 1 (two teeth, f_z = 15 um) with tooth 2 worn by W. The share is that of the start angles at which",
              "tooth 2 triggers; the last column is how far its highest reading lies below that of tooth 1, which a reader",
              "of the curve takes for W:", ""]
    lines += table(["W, um", "W / f_z", "share of start angles", "(1 - W / f_z) / 2", "highest of tooth 1 - highest of tooth 2, um"], rows)
    lines += ["The line that comes down passes the teeth in turn, f_z lower each time, and a worn tooth needs it W lower: pass j",
              "catches the phases below a_j = j f_z - W_j that no earlier pass has caught. **A tooth shows at the share of start",
              "angles by which its a_j exceeds all earlier ones**, divided by n f_z, whatever its shape; with two teeth",
              "(1 - W / f_z) / 2, and never beyond f_z. Somewhat before, its first hump is covered already by the second hump",
              "of the other and only its own second one shows: the difference then reads more than W. With three or more teeth",
              "the limit is f_z per pitch of lead: tooth 2 of example 3 (f_z = 20 um), worn by 25 um behind a tooth 3 worn by",
              f"10 um, triggers at {np.mean(which == 2):.3f} of the start angles (law: {0.25 / 3:.3f}), although it is worn by more than one feed per",
              "tooth ([errata](" + ERRATA + "fang-3-peaks)).", ""]


def phase(lines, table, um, below):
    rows = []
    angles = np.arange(0, 360, 1.0)
    for label, tool in (("example 1", EXAMPLE_1), ("example 3", EXAMPLE_3), ("experiment", EXPERIMENT)):
        base = mills.curve(tool, angles)
        turn = 0.36 / mills.per_turn(tool)
        raised = {"start_height": tool["start_height (mm)"] + 0.001}
        rows.append([label, f"{turn:.1f}", below(np.max(np.abs(mills.curve(tool, angles - turn, **raised) - base))),
                     um(np.max(np.abs(mills.curve(tool, angles, **raised) - base)), 2)])
    lines += ["## One micrometre of start height", "",
              "turns the curve by 360 N_s (1 um) / v, towards smaller start angles. Turned back, the curves are the same; not",
              "turned back they differ by up to:", ""]
    lines += table(["tool", "turn, deg", "left over when turned back, below", "largest difference not turned back, um"], rows)
    lines += ["The start height is known only through the length that is being measured, never to a micrometre. The phase of",
              "the curve must be free in any fit, and agreement of a phase proves nothing.", ""]


def time(lines, table, um):
    rows = []
    for label, m, height, feed, speed, printed in (
            ("conventional, from 0.5 mm", 1, 0.5, 3, 3000, ""), ("conventional, from 5 mm", 1, 5, 3, 3000, "120 to 180"),
            ("twelve angles, from 10 mm", 12, 10, 30, 1000, "80"), ("twelve angles, from 5 mm", 12, 5, 30, 1000, ""),
            ("twelve angles, from 1 mm", 12, 1, 30, 1000, ""), ("twelve angles, from 0.5 mm", 12, 0.5, 30, 1000, "")):
        tool = {**EXPERIMENT, "start_height (mm)": height, "feed (mm/min)": feed, "spindle_speed (rpm)": speed}
        z = mills.curve(tool, np.arange(m) * 360 / m)
        feeding = float(np.sum(height - z)) / feed * 60
        rows.append([label, m, height, f"{feed} / {speed}", f"{feeding:.1f}", printed or "-"])
    lines += ["## Time", "",
              "A reading feeds for (h - Z_t) / v; orientation, spin-up and retraction come on top. Sums over the readings, with",
              "the engine's Z_t of the experiment's tool:", ""]
    lines += table(["procedure", "readouts", "start height, mm", "feed / speed, mm/min / rpm", "feeding, s", "printed total, s"],
                   rows)
    lines += ["The thesis' 1 min 20 s for twelve readings from about 10 mm at 30 mm/min is impossible: feeding alone takes",
              "three times that ([errata](" + ERRATA + "fang-3-experiment)). Start low rather than slow: the height costs time and tells",
              "nothing, the feed costs spread.", ""]


def write(lines, table, um, below):
    for section in (one_readout, start_angles, hidden):
        section(lines, table, um)
    phase(lines, table, um, below)
    time(lines, table, um)
