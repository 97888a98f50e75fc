"""The battery's families as data: a measuring system, what its model lacks at which strength, the noise, and traits of real data."""
from dataclasses import dataclass

# Traits of a plan, as options of the system's `design`.
TRAITS = {
    "undeclared": dict(declared=False),     # the scenario says nothing of the noise
    "unstated": dict(stated=False),         # no candidate is stated: what is found is in no catalogue
    "short": dict(blocks=3),
    "long": dict(blocks=20),
    "thousand": dict(blocks=40, positions=13),
    "thousands": dict(blocks=56, positions=45),
    "offsets": dict(offsets=True),          # each block has an offset of its own
    "fading": dict(first=6.0),              # um: the first minutes differ, and the scenario says so
    "24": dict(setups=8, clampings=1),      # readings of a mill
    "60": dict(setups=10, clampings=2),
    "quiet": dict(noise=0.1),               # um: a tooth's step is five times as much
    "wide": dict(wide=True),                # 5 mm and 0.5 deg on the machine's parameters
}

# system, what is missing (name@strength, joined by +; "-": nothing), noise, traits
TABLE = """
positioning         -                                                         white
positioning         -                                                         white      undeclared
positioning         -                                                         white      short
positioning         -                                                         white      long
positioning         -                                                         white      offsets
positioning         -                                                         white      fading
positioning         -                                                         one_bad
positioning         -                                                         one_bad    undeclared
positioning         -                                                         coarse
positioning         -                                                         unequal
positioning         -                                                         unequal    undeclared
positioning         -                                                         ar06
positioning         -                                                         t3
positioning         -                                                         outliers
positioning         -                                                         clamp_declared
positioning         -                                                         clamp_undeclared
proving_ring        -                                                         white
proving_ring        -                                                         white      undeclared
proving_ring        -                                                         one_bad
proving_ring        -                                                         t3
proving_ring        -                                                         white      fading
lever               -                                                         white
lever               -                                                         white      undeclared
lever               -                                                         one_bad
lever               -                                                         clamp_declared

positioning         stated:lost_motion@8                                      white
positioning         stated:lost_motion@8                                      one_bad
positioning         stated:lost_motion@8                                      white      undeclared short
positioning         stated:expansion@8                                        white
positioning         stated:expansion@15                                       ar06
positioning         stated:drift@8                                            white
positioning         stated:lead@8                                             coarse
positioning         stated:lead@8                                             t3         undeclared
positioning         declared:sag@8                                            white
positioning         stated:lost_motion@8                                      white      thousand
positioning         stated:lost_motion@10+stated:drift@8                      white
positioning         stated:lost_motion@12+stated:expansion@10+stated:lead@8   white
positioning         stated:lost_motion@10+table@30                            white
positioning         drift_by_position@15+stated:lead@8                        white
proving_ring        stated:friction@8                                         white
proving_ring        stated:softening@8                                        unequal
proving_ring        stated:eccentric@8                                        t3
proving_ring        stated:creep@8                                            white
proving_ring        declared:bend@8                                           white
proving_ring        stated:friction@10+stated:eccentric@8                     one_bad
proving_ring        stated:friction@12+stated:softening@10                    white      undeclared
lever               stated:play@8                                             white
lever               stated:oval@8                                             white
lever               stated:growth@15                                          white      undeclared
lever               stated:play@10+stated:drift@8                             white

positioning         reversal@15                                               white      unstated
positioning         alternating@100                                           white
positioning         alternating@100                                           white      undeclared
positioning         alternating@100                                           ar06
positioning         alternating@50                                            ar08       undeclared
positioning         growing_reversal@15                                       white
positioning         table@30                                                  white
positioning         table@30                                                  one_bad    undeclared
positioning         table@30                                                  white      offsets
positioning         table_both@30                                             white      unstated
positioning         table@50+reversal@15                                      white      unstated
positioning         table@50+reversal@15                                      white      unstated undeclared
positioning         drift_by_position@15                                      white
positioning         drift_by_position@15                                      white      undeclared
positioning         first_cycle@12                                            white
positioning         first_cycle@12                                            white      undeclared
positioning         cycle_1@12                                                white
positioning         periodic@15                                               white
positioning         periodic@15                                               coarse
positioning         temperature@12                                            white
positioning         jump@15                                                   white
positioning         bump@12                                                   white
proving_ring        hysteresis@12                                             white
proving_ring        hysteresis@20                                             white      undeclared
proving_ring        table@30                                                  white
proving_ring        cubic@12                                                  unequal
proving_ring        first_run@12                                              white
proving_ring        temperature@12                                            white
proving_ring        jump@15                                                   white
lever               table@30                                                  white
lever               third@12                                                  white
lever               jump@12                                                   white

rod_gauging         -                                                         white
rod_gauging         -                                                         t3
rod_gauging         -                                                         one_bad
rod_gauging         -                                                         clamp_declared
rod_gauging         trigger_latency@8                                         white
rod_gauging         z_reversal@8                                              unequal
rod_gauging         thermal_growth@15                                         one_bad
rod_gauging         declared:rod_length[rod_3]@8                              white
rod_gauging         z_reversal[rod_3]@8                                       white
rod_gauging         trigger_latency@12+z_reversal@8                           white
rod_gauging         cubic@12                                                  white
tool_length         -                                                         white
tool_length         -                                                         white      quiet 24
tool_length         -                                                         white      quiet
tool_length         trigger_latency@8                                         white
tool_length         revolution_confirm@8                                      white
tool_length         spindle_axial_shift@8                                     white
tool_length         thermal_growth@15                                         white      undeclared
tool_length         tool_runout@8                                             white      60
tool_length         tool_runout@15                                            white      quiet 24
tool_length         tool_runout@15                                            white      quiet 60 undeclared
tool_length         tool_runout@30                                            white      quiet
tool_length         declared:wear_2@8                                         white      60
tool_length         declared:wear_3@15                                        white      quiet 24
tool_length         declared:wear_2@15                                        white      quiet 60 undeclared
tool_length         declared:wear_3@30                                        white      quiet
tool_length         tool_runout@15+declared:wear_2@15                         white      quiet
sphere_calibration  -                                                         white
sphere_calibration  -                                                         white      wide
sphere_calibration  c_axis_reversal@8                                         white
sphere_calibration  c_encoder_ovality@15                                      white      wide
sphere_calibration  thermal_drift@8                                           t3
single_socket       -                                                         white
single_socket       x_reversal@8                                              white
single_socket       bar_drift@15                                              one_bad
laser_scan          -                                                         white
laser_scan          the_part_has_three_lobes@15                               white
laser_scan          the_spindle_grows@15                                      white
laser_ball_bar      -                                                         white
laser_ball_bar      unequal_gains@15                                          white
laser_ball_bar      Y_has_play@15                                             white

positioning         -                                                         white      thousands
positioning         table@30                                                  white      thousands
"""
EXPRESSIONS = ("positioning", "proving_ring", "lever")
PLENTY = 5  # times as many sets of nulls whose tracing takes a fraction of a second
FEW = {"thousands": 2}  # sets at most


@dataclass(frozen=True)
class Family:
    system: str
    missing: tuple  # (name, strength)
    noise: str
    traits: tuple

    @property
    def name(self):
        what = "+".join(f"{n}@{s:g}" for n, s in self.missing) or "-"
        return " ".join((self.system, what, self.noise, *self.traits))

    @property
    def null(self):
        return not self.missing

    @property
    def clean(self):
        return self.noise == "white"

    @property
    def options(self):
        return {k: v for t in self.traits for k, v in TRAITS[t].items()}

    def foretells(self, seed):
        """Whether its predictions are asked for: they take longer than tracing nothing."""
        return not self.large and (not self.null or self.system not in EXPRESSIONS or seed % PLENTY == 0)

    @property
    def large(self):
        return bool(set(self.traits) & set(FEW))

    def sets(self, seeds):
        """How many of them are asked for."""
        few = min([FEW[t] for t in self.traits if t in FEW], default=seeds)
        return min(few, seeds) if few < seeds or not self.null or self.system not in EXPRESSIONS else PLENTY * seeds


def family(line):
    system, what, noise, *traits = line.split()
    parts = [] if what == "-" else [part.split("@") for part in what.split("+")]
    return Family(system, tuple((n.replace("_3]", " 3]"), float(s)) for n, s in parts), noise, tuple(traits))


FAMILIES = [family(line) for line in TABLE.splitlines() if line]
