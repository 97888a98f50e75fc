#include "models/laser_scan/laser_scan.h"

#include "models/intermediates.h"

namespace gumshoe::models::laser_scan {

std::vector<Intermediate> LaserScan::explain(const At<double>& at, const Rows::Indications<double>& read) {
  std::vector<Intermediate> out;
  Outcome<double> outcome;
  const auto to = command(at, 0.0);
  const auto together = set_up(at);
  const auto from = beam(at, together, squared(at.q, to.slides, to.slides), to.turns.first, to.turns.second);
  add(out, "commanded spot on the table", to.spot);
  add(out, "commanded slides", to.slides);
  add(out, "where the spot is on the part", from.from);
  add(out, "beam on the part", from.along, "1", 1);
  const auto found = spot(at, together, outcome);
  out.insert(out.end(), {{"displacement by machine and set-up", "mm", found.displacement / mm},
                         {"effects add to the form", "um", found.form / um},
                         {"effects add to the indication", "um", found.error / um},
                         {"form_deviation", "um", form_deviation(at, found, read.displacement) / um}});
  return out;
}

} // namespace gumshoe::models::laser_scan
