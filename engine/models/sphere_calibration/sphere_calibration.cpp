#include "models/sphere_calibration/sphere_calibration.h"

#include "models/intermediates.h"

namespace gumshoe::models::sphere_calibration {

std::vector<Intermediate> SphereCalibration::explain(const At<double>& reading, const Rows::Indications<double>& read) {
  const auto& [q, c] = std::tie(reading.q, reading.c);
  const auto links = sphere_calibration::links(q);
  const auto at = sphere_calibration::contact(reading);
  std::vector<Intermediate> out{
      {"actual B axis from the origin, D_rbx", "mm", links.length[length_B_x] / mm},
      {"actual B axis from the origin, D_rbz", "mm", links.length[length_B_z] / mm},
      {"actual C axis from the origin, D_rcx", "mm", links.length[length_C_x] / mm},
      {"actual C axis from the origin, D_rcy", "mm", links.length[length_C_y] / mm},
  };
  add(out, "direction of the B axis", links.lines.b, "1", 1);
  add(out, "direction of the C axis", links.lines.c, "1", 1);
  out.push_back({"actual A", "deg", (c.A + q.E_AA) / deg});
  out.push_back({"actual B", "deg", (c.B + q.E_BB) / deg});
  out.push_back({"actual C", "deg", (c.C + q.E_CC) / deg});
  add(out, "tip above the sphere", at.tip);
  add(out, "probe from the commanded origin", at.probe);
  add(out, "nominal command", at.nominal);
  add(out, "linear axes add to the command", at.added, "um", 1 / um);
  if (at.touch) {
    const auto& [event, rotary] = *at.touch;
    out.insert(out.end(), {{"effects turn B", "arcsec", rotary.B.error[chain::E_B] / deg * 3600},
                           {"effects turn C", "arcsec", rotary.C.error[chain::E_C] / deg * 3600},
                           {"pretravel", "um", event.pretravel / um},
                           {"latch delay", "s", event.latch_delay}});
    add(out, "approach in the probe's frame", event.approach_in_probe, "1", 1);
    add(out, "effects add to the command", at.touch->reading_of(at.tip - at.probe) - (at.tip - at.probe), "um", 1 / um);
  }
  add(out, "command at the sphere's top", sphere_calibration::simulate(at));
  const auto tip = sphere_calibration::evaluate({read.X, read.Y, read.Z}, at);
  out.insert(out.end(), {{"tip_x", "mm", tip.x / mm}, {"tip_y", "mm", tip.y / mm}, {"tip_z", "mm", tip.z / mm}});
  return out;
}

} // namespace gumshoe::models::sphere_calibration
