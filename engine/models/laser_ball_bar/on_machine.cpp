/// The ball bars on a machine that a scenario describes: their sockets stand on its table.
#include "models/laser_ball_bar/laser_ball_bar.h"
#include "models/location_machine.h"

namespace gumshoe::models::laser_ball_bar {

extern const Model model;

MadeModel LaserBallBar::on_machine(const chain::MachineDescription& machine, std::string& why) {
  return on_located_axes(model, machine, why);
}

} // namespace gumshoe::models::laser_ball_bar
