#include "scenario/starter.h"

namespace gumshoe::scenario {

std::string starter_budget() {
  return R"(# Question: what is the uncertainty of a result that a formula computes from readings and stated quantities?
#
# Every number below is made up: replace it, its uncertainty and its source by yours. `gumshoe check` names what is wrong.

schema = 1
title  = "a length at 20 degC"

[model]
name = "expression"

[model.measurands]                      # the result; names below may be chosen freely
length = { formula = "reading * (1 - alpha * (temperature - reference)) + correction", unit = "mm" }

[indications.reading]                   # what was read; or a column of a file, see [data]
readings      = ["50.0021 mm", "50.0019 mm", "50.0022 mm", "50.0020 mm"]
resolution    = "0.1 um"
repeatability = "readings"              # from the scatter of these readings; or { s = "0.2 um" }

[quantities.correction]                 # a certificate: expanded uncertainty U with its k
value  = "0.3 um"
U      = "0.4 um"
k      = 2
source = "assumed: certificate"

[quantities.alpha]                      # limits: a rectangular distribution
value        = "11.5 um/m/K"
distribution = "rectangular"
half_width   = "1 um/m/K"
source       = "assumed: steel"

[quantities.temperature]                # a standard uncertainty
value  = "20.4 degC"
u      = "0.3 K"
source = "assumed: thermometer"

[quantities.reference]
value = "20 degC"

[run]
samples = 1_000_000
seed    = 1
)";
}

} // namespace gumshoe::scenario
