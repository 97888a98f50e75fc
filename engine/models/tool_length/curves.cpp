#include "models/tool_length/curves.h"

namespace gumshoe::models::tool_length {

void find_heights(const Together<Rows, double>& all, Heights& out, Outcome<double>& outcome) {
  out.resize(all.size());
  for (std::size_t r = 0; r < all.size(); ++r) {
    Height& x = out[r];
    const double z = all.read[r].spindle_z;
    x.at = all.at[r];
    x.at.q.tool_length = z - x.at.q.laser_z; // what grows with the length does so by that of the reading
    x.event = event_without_trigger(x.at);
    x.height = chain::actual_of(z, x.event) - x.at.q.laser_z - x.event.tool_growth;
    outcome.refuse(x.at.q.inserts != all.at[0].q.inserts, "inserts differ between readings");
    outcome.refuse(!std::isfinite(x.height), "a reading is not finite");
  }
}

double drop(const Height& r) { return motion(r.at, r.event).drop; }
double line_of(const Height& r) {
  const auto m = motion(r.at, r.event);
  return m.height + m.drop * m.angle;
}
double least_raise(const Height& r) { return least_raise(r.at.q, r.event); }

const TriggerCurve* Curves::at(const Insert<double>& insert, const Beam<double>& beam, double drop) {
  const InsertHeight& heights = solver_.heights(insert, beam);
  for (const Known& k : known_)
    if (k.drop == drop && k.insert == insert && k.beam == beam) return &k.curve;
  if (!heights.ever_covered()) return nullptr;
  known_.push_front({insert, beam, drop, TriggerCurve(heights, drop)});
  return &known_.front().curve;
}

bool prepare(const Heights& all, Curves& curves, CurveReadings& data) {
  const int n = flutes(all[0].at.q);
  data.readings = all.size();
  data.flutes = static_cast<std::size_t>(n);
  data.drop = drop(all[0]);
  data.curves.clear();
  data.lines.clear();
  data.heights.clear();
  data.alike = true;
  const double reference = line_of(all[0]); // what all readings share leaves no trace in the fit
  for (const Height& r : all) {
    const auto m = motion(r.at, r.event);
    const double line = line_of(r) - reference;
    data.heights.push_back(r.height);
    for (int k = 0; k < n; ++k) {
      const auto f = flute(r.at.q, r.event, k);
      data.curves.push_back(curves.at(f.insert, laser_setter::beam(r.at.q), m.drop));
      if (!data.curves.back()) return false;
      data.lines.push_back(line + m.drop * f.azimuth);
      data.alike &= data.curves.back() == data.curves[data.curves.size() - 1 - static_cast<std::size_t>(k)] &&
                    std::fabs(f.azimuth - 2 * pi * k / n) < 1e-12;
    }
  }
  return true;
}

} // namespace gumshoe::models::tool_length
