/// The second step of the single socket method on a machine that a scenario describes.
#include <fmt/format.h>

#include "chain/machine.h"
#include "models/made_card.h"
#include "models/single_socket_rotation/single_socket_rotation.h"

namespace gumshoe::models::single_socket_rotation {

extern const Model model;

namespace {

struct OnMachine : chain::TwoRotaryAxes {
  std::unique_ptr<RenamedCard> card;
  Model row{};
};

} // namespace

MadeModel SingleSocketRotation::on_machine(const chain::MachineDescription& description, std::string& why) {
  const chain::Machine machine(description);
  const auto axes = machine.axes();
  std::vector<chain::RotaryPlace> rotary;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].rotary) rotary.push_back({axes[i].direction, 1, i < machine.on_workpiece_side(), axes[i].point});
  if (rotary.size() != 2 || rotary[0].carries_workpiece != rotary[1].carries_workpiece ||
      rotary[0].direction == rotary[1].direction) {
    why = "single_socket_rotation has two rotary axes, both in the table or both in the head, about two directions";
    return nullptr;
  }
  if (!description.errors.empty()) {
    why = fmt::format("{} is no quantity of single_socket_rotation", description.errors.front().first);
    return nullptr;
  }
  auto made = std::make_shared<OnMachine>();
  made->first = rotary[0], made->second = rotary[1];
  made->card = std::make_unique<RenamedCard>(card, std::vector<Renamed>{}, cards_of_axes(machine));
  made->row = model;
  made->row.card = &made->card->card();
  made->row.context = static_cast<const chain::TwoRotaryAxes*>(made.get());
  return {made, &made->row};
}

} // namespace gumshoe::models::single_socket_rotation
