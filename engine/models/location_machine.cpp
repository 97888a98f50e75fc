#include "models/location_machine.h"

#include <fmt/format.h>

#include "chain/two_rotary_axes.h"
#include "models/made_card.h"

namespace gumshoe::models {

namespace {

constexpr char slide_letters[] = "XYZ", turn_letters[] = "ABC";

/// Data of a made model, to which Model::context points: the axes come first.
struct OnMachine : chain::TwoRotaryAxes {
  std::unique_ptr<RenamedCard> card;
  Model row{};
};

chain::RotaryPlace place_of(const chain::Axis& axis, bool carries_workpiece) {
  return {axis.direction, axis.sense, carries_workpiece, axis.point};
}

/// Two rotary axes from the bed, behind one slide along each of X, Y and Z; else the reason why not.
std::string fit(const chain::Machine& machine, std::string_view model, std::vector<std::size_t>& rotary) {
  std::array<int, 3> slides{};
  const auto axes = machine.axes();
  if (const std::string why = chain::oblique(machine); !why.empty())
    return fmt::format("{}, and those of {} are along and about X, Y and Z", why, model);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].rotary) {
      rotary.push_back(i);
      continue;
    }
    ++slides[static_cast<std::size_t>(axes[i].direction)];
    if (i > 0 && axes[i - 1].rotary && i != machine.on_workpiece_side())
      return fmt::format("the slide {} is carried by the rotary axis {}, and {} moves its slides on the bed", axes[i].name,
                         axes[i - 1].name, model);
  }
  for (std::size_t d = 0; d < 3; ++d)
    if (slides[d] != 1)
      return fmt::format("{} along {}, and {} moves one", slides[d] == 0 ? "no slide" : "two slides", slide_letters[d],
                         model);
  if (rotary.size() != 2) return fmt::format("the number of rotary axes is {}, and {} has two", rotary.size(), model);
  if (axes[rotary[0]].direction == axes[rotary[1]].direction)
    return fmt::format("the axes {} and {} are parallel, and {} needs two directions", axes[rotary[0]].name,
                       axes[rotary[1]].name, model);
  return {};
}

/// The card's rows by the names of these axes.
std::vector<Renamed> renamed(const chain::TwoRotaryAxes& axes, const std::string& first, const std::string& second) {
  const auto i = [](int direction) { return static_cast<std::size_t>(direction); };
  const char n = slide_letters[i(axes.across())], about_n = turn_letters[i(axes.across())];
  const char u = slide_letters[i(axes.first.direction)], v = slide_letters[i(axes.second.direction)];
  const auto position = [&](char along, const std::string& axis) {
    return Renamed{"", fmt::format("E_{}0{}", along, axis), fmt::format("position of the {} axis along {}", axis, along)};
  };
  std::vector<Renamed> rows{position(n, first), position(u, second), position(v, first)};
  rows[0].from = "E_X0B", rows[1].from = "E_Y0C", rows[2].from = "E_Z0B";
  for (int d = 0; d < 3; ++d) {
    const char about = turn_letters[i(d)];
    rows.push_back({fmt::format("E_{}0B", about), fmt::format("E_{}0{}", about, first),
                    d == axes.first.direction
                        ? fmt::format("zero position of the {} axis", first)
                        : fmt::format("orientation of the {} axis about {}", first, slide_letters[i(d)])});
  }
  const auto relative = [&](const char* from, char along, const std::string& what) {
    const std::string own = fmt::format("E_{}0{}", along, second);
    rows.push_back(axes.one_in_each() ? Renamed{from, own, fmt::format("{} {}", what, slide_letters[i(axes.across())])}
                                      : Renamed{from, fmt::format("{}_minus_E_{}0{}", own, along, first),
                                                fmt::format("{} {}, against the {} axis", what,
                                                            slide_letters[i(axes.across())], first)});
  };
  relative("E_X0C_minus_E_X0B", n, fmt::format("position of the {} axis along", second));
  relative("E_A0C_minus_E_A0B", about_n, fmt::format("orientation of the {} axis about", second));
  rows.push_back({"B", first});
  rows.push_back({"C", second});
  rows.push_back({"B_direction", first + "_direction"});
  return rows;
}

} // namespace

MadeModel on_located_axes(const Model& model, const chain::MachineDescription& description, std::string& why) {
  const chain::Machine machine(description);
  std::vector<std::size_t> rotary;
  why = fit(machine, model.card->name, rotary);
  if (!why.empty()) return nullptr;
  const auto axes = machine.axes();
  auto made = std::make_shared<OnMachine>();
  made->first = place_of(axes[rotary[0]], rotary[0] < machine.on_workpiece_side());
  made->second = place_of(axes[rotary[1]], rotary[1] < machine.on_workpiece_side());
  auto rows = renamed(*made, axes[rotary[0]].name, axes[rotary[1]].name);
  for (const auto& [name, value] : description.errors) {
    const auto row = std::ranges::find(rows, name, &Renamed::name);
    if (row == rows.end()) {
      why = fmt::format("{} is no quantity of {} on this machine", name, model.card->name);
      return nullptr;
    }
    row->default_value = value;
  }
  made->card = std::make_unique<RenamedCard>(*model.card, rows, cards_of_axes(machine));
  made->row = model;
  made->row.card = &made->card->card();
  made->row.context = static_cast<const chain::TwoRotaryAxes*>(made.get());
  return {made, &made->row};
}

} // namespace gumshoe::models
