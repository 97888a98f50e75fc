/// The scanner on a machine that a scenario describes.
#include "models/laser_scan/laser_scan.h"
#include "models/location_machine.h"

namespace gumshoe::models::laser_scan {

extern const Model model;

MadeModel LaserScan::on_machine(const chain::MachineDescription& machine, std::string& why) {
  return on_located_axes(model, machine, why);
}

} // namespace gumshoe::models::laser_scan
