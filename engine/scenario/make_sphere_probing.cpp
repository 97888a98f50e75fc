#include <fmt/format.h>

#include "models/sphere_probing/sphere_probing.h"
#include "scenario/machine.h"
#include "scenario/made_models.h"

namespace gumshoe::scenario {

models::MadeModel make_sphere_probing(const MadeModelSource& source) {
  auto& [model, top, folder, context] = source;
  const auto machine = read_machine(top, context.problems);
  if (!machine) return nullptr;
  if (const std::string why = models::probing::unreachable(*machine); !why.empty()) {
    context.problems.add(*top.find("machine"), "machine: " + why, "three slides bring the tip to the sphere");
    return nullptr;
  }
  return models::probing::make(*machine);
}

} // namespace gumshoe::scenario
