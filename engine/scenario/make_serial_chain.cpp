#include "models/serial_chain/serial_chain.h"
#include "scenario/machine.h"
#include "scenario/made_models.h"

namespace gumshoe::scenario {

models::MadeModel make_serial_chain(const MadeModelSource& source) {
  auto& [model, top, folder, context] = source;
  const auto measured = model.choice("measured", {"position", "distance"});
  const auto machine = read_machine(top, context.problems);
  if (!machine) return nullptr;
  return models::serial_chain::make(*machine, static_cast<models::serial_chain::Measured>(measured.value_or(0)));
}

} // namespace gumshoe::scenario
