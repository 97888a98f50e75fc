/// The second step of the single socket method on a machine that a scenario describes.
#include "models/single_socket_rotation/single_socket_rotation.h"
#include "models/turned_ball_machine.h"

namespace gumshoe::models::single_socket_rotation {

extern const Model model;

MadeModel SingleSocketRotation::on_machine(const chain::MachineDescription& machine, std::string& why) {
  return turned_ball::on_machine(model, machine, {}, why);
}

} // namespace gumshoe::models::single_socket_rotation
