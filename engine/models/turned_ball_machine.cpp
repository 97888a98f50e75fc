#include "models/turned_ball_machine.h"

#include <fmt/format.h>

#include "chain/two_rotary_axes.h"
#include "models/made_card.h"

namespace gumshoe::models::turned_ball {

namespace {

/// Data of a made model, to which Model::context points: the axes come first.
struct OnMachine : chain::TwoRotaryAxes {
  std::unique_ptr<RenamedCard> card;
  Model row{};
};

Renamed error_of(std::string_view from, const chain::RotaryPlace& axis, const std::string& name) {
  static constexpr const char *letters[] = {"alpha", "beta", "gamma"}, *directions = "XYZ";
  return {std::string(from), fmt::format("d_{}", letters[axis.direction]),
          fmt::format("orientation error of the {} axis, about {}", name, directions[axis.direction])};
}

} // namespace

MadeModel on_machine(const Model& model, const chain::MachineDescription& description, const ErrorsOfAxes& named,
                     std::string& why) {
  const chain::Machine machine(description);
  const auto axes = machine.axes();
  if (const std::string oblique = chain::oblique(machine); !oblique.empty()) {
    why = fmt::format("{}, and those of {} are about X, Y or Z", oblique, model.card->name);
    return nullptr;
  }
  std::vector<chain::RotaryPlace> rotary;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < axes.size(); ++i)
    if (axes[i].rotary) {
      rotary.push_back({axes[i].direction, 1, i < machine.on_workpiece_side(), axes[i].point});
      names.push_back(axes[i].name);
    }
  if (rotary.size() != 2 || rotary[0].carries_workpiece != rotary[1].carries_workpiece ||
      rotary[0].direction == rotary[1].direction) {
    why = fmt::format("{} has two rotary axes, both in the table or both in the head, about two directions",
                      model.card->name);
    return nullptr;
  }
  if (!description.errors.empty()) {
    why = fmt::format("{} is no quantity of {}", description.errors.front().first, model.card->name);
    return nullptr;
  }
  auto made = std::make_shared<OnMachine>();
  made->first = rotary[0], made->second = rotary[1];
  std::vector<Renamed> errors;
  if (!named.first.empty())
    errors = {error_of(named.first, rotary[0], names[0]), error_of(named.second, rotary[1], names[1])};
  made->card = std::make_unique<RenamedCard>(*model.card, errors, cards_of_axes(machine));
  made->row = model;
  made->row.card = &made->card->card();
  made->row.context = static_cast<const chain::TwoRotaryAxes*>(made.get());
  return {made, &made->row};
}

} // namespace gumshoe::models::turned_ball
