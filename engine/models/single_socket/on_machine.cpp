/// The single socket method on a machine that a scenario describes.
#include "models/single_socket/single_socket.h"
#include "models/turned_ball_machine.h"

namespace gumshoe::models::single_socket {

extern const Model model;

MadeModel SingleSocket::on_machine(const chain::MachineDescription& machine, std::string& why) {
  return turned_ball::on_machine(model, machine, {first_error, second_error}, why);
}

} // namespace gumshoe::models::single_socket
