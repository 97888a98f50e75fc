#include "models/serial_chain/serial_chain.h"

#include <cmath>

#include <fmt/format.h>

#include "base/kernel_choice.h"
#include "models/cards.h"
#include "models/intermediates.h"
#include "models/machine_rows.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::models::Kernels, serial_chain)

namespace gumshoe::models::serial_chain {

namespace {

using si::mm;

const SerialChain& of(const void* context) { return *static_cast<const SerialChain*>(context); }

template <class T> Moving<T> moving(const PointCall<T>& call) {
  const SerialChain& p = of(call.context);
  Moving<T> chain(p);
  for (std::size_t j = 0; j < p.card->card().quantities.size(); ++j) chain.set(j, call.quantities[j]);
  for (std::size_t a = 0; a < chain.commands.size(); ++a) {
    chain.commands[a] = T(call.conditions[a]);
    chain.move(a);
  }
  chain.payload = T(call.conditions[p.payload()]);
  return chain;
}

template <class T> PointOutcome evaluate_point(const PointCall<T>& call) {
  auto chain = moving(call);
  measure(of(call.context), chain, chain.target(true), call.indications, call.measurands);
  return {};
}

template <class T> PointOutcome simulate_point(const PointCall<T>& call) {
  auto chain = moving(call);
  indicate(of(call.context), chain.in_instrument(chain.target(true)), call.simulated);
  return {};
}

std::vector<Intermediate> explain(const PointCall<double>& call) {
  const SerialChain& p = of(call.context);
  auto chain = moving(call);
  const auto target = chain.target(true);
  std::vector<Intermediate> out;
  Pose<double> pose;
  for (std::size_t i = 0; i < chain.commands.size(); ++i) {
    const chain::Axis& axis = p.machine.axes()[i];
    if (i == p.machine.on_workpiece_side()) pose = {};
    const auto line = chain::actual_line(axis, chain.errors.data() + i * chain::error_kinds);
    add(out, "direction of " + axis.name + " from the bed", pose.turn * line.direction, "1", 1);
    out.push_back({"deflection of " + axis.name + " by gravity", axis.rotary ? "deg" : "mm",
                   chain.deflected()[i] / (axis.rotary ? si::deg : mm)});
    pose = pose * chain.poses()[i];
    add(out, "frame of " + axis.name + " from the bed", pose.shift);
  }
  add(out, "target from the machine", target);
  add(out, "target from the instrument", chain.in_instrument(target));
  double measurands[6];
  measure(p, chain, target, call.indications, measurands);
  for (std::size_t k = 3; k < p.measurands(); ++k)
    out.push_back({std::string(p.card->card().measurands[k].name), "mm", measurands[k] / mm});
  return out;
}

std::string check(const PointCall<double>& call) {
  const SerialChain& p = of(call.context);
  for (std::size_t i = 0; i < p.card->card().conditions.size(); ++i)
    if (!std::isfinite(call.conditions[i])) return "a condition is not finite";
  if (call.conditions[p.payload()] < 0) return "the payload is negative";
  return {};
}

bool solve_reads(std::size_t) { return true; }

const Kernels* kernels() { return GUMSHOE_BEST_KERNELS(serial_chain); }

Symbol drive_row(const chain::Axis& axis, int value) {
  const auto of_axis = [&](const char* name) { return fmt::format("{}_{}", name, axis.name); };
  constexpr Limits mass{0, 1e6};
  switch (value) {
  case chain::drive_scale:
    return {of_axis("scale"), "um/m", "1", fmt::format("share by which {} moves farther than commanded", axis.name), 0,
            {-0.1, 0.1}};
  case chain::drive_cosine:
    return {of_axis("cosine"),
            "deg",
            "rad",
            fmt::format("error of {} times the cosine of its command: eccentric encoder", axis.name),
            0,
            any};
  case chain::drive_sine:
    return {of_axis("sine"),
            "deg",
            "rad",
            fmt::format("error of {} times the sine of its command: eccentric encoder", axis.name),
            0,
            any};
  case chain::drive_compliance:
    if (axis.rotary)
      return {of_axis("compliance"),
              "urad/N/m",
              "rad/N/m",
              fmt::format("twist of {} per torque of gravity about it", axis.name),
              0,
              {0, 1}};
    return {of_axis("compliance"), "um/N", "m/N", fmt::format("shift of {} per weight along it", axis.name), 0, {0, 1}};
  case chain::drive_mass:
    return {of_axis("mass"), "kg", "kg", fmt::format("mass of what {} moves, up to the next axis", axis.name), 0, mass};
  default:
    const int d = value - chain::drive_centre_x;
    return {fmt::format("centre_{}_{}", "xyz"[d], axis.name),
            "mm",
            "m",
            fmt::format("centre of that mass in the frame of {}, {}", axis.name, "XYZ"[d]),
            0,
            any};
  }
}

CardTexts texts_of(SerialChain& p, const chain::MachineDescription& d) {
  CardTexts t;
  t.name = "serial_chain";
  t.title = "Target on a machine or a robot";
  t.summary = fmt::format("An instrument measures {} of a target that {} moves to commanded positions.",
                          p.measured == Measured::position ? "three coordinates" : "the distance",
                          d.name.empty() ? "a machine" : "the machine " + d.name);
  t.source = "exact kinematic chain, errors by ISO 230-1 and ISO 230-7 or of Denavit-Hartenberg parameters";
  const auto triple = [&](auto& out, const std::string& name, const std::string& what, const char* letters = "xyz") {
    for (int i = 0; i < 3; ++i)
      out.push_back({name + letters[i], "mm", "m", fmt::format("{}, {}", what, "XYZ"[i]), 0, any});
  };
  triple(t.quantities, "base_", "place of the machine's frame in the frame of the instrument");
  for (int i = 0; i < 3; ++i)
    t.quantities.push_back(
        {fmt::format("base_{}", "abc"[i]), "deg", "rad",
         fmt::format("orientation of the machine's frame in that of the instrument, about {}: Rx Ry Rz", "XYZ"[i]), 0,
         any});
  triple(t.quantities, "target_", "place of the target in the frame of the last component");
  for (int i = 0; i < 3; ++i)
    t.quantities.push_back({fmt::format("gravity_{}", "xyz"[i]), "m/s2", "m/s2",
                            fmt::format("acceleration of gravity in the frame of the bed, {}", "XYZ"[i]),
                            i == 2 ? -9.80665 : 0, any});
  const auto axes = p.machine.axes();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    for (int k = 0; k < chain::error_kinds; ++k)
      if (has_error(axes[i], k)) {
        p.place_of.push_back({i, k});
        t.quantities.push_back(error_row(axes[i], k, p.machine.errors()[chain::ErrorPlace{i, k}.index()]));
      }
    for (int v = 0; v < chain::drive_values; ++v)
      if (chain::has_drive(axes[i], v)) {
        p.place_of.push_back({i, chain::error_kinds + v});
        t.quantities.push_back(drive_row(axes[i], v));
      }
    t.conditions.push_back(command_row(axes[i]));
  }
  t.conditions.push_back({"payload", "kg", "kg", "mass at the target that the last component carries", 0});
  triple(t.measurands, "position_", "place of the target by the commands, in the frame of the machine");
  if (p.measured == Measured::position) {
    for (int i = 0; i < 3; ++i)
      t.indications.push_back({std::string(1, "xyz"[i]), "mm", "m",
                               fmt::format("place of the target in the frame of the instrument, {}", "XYZ"[i]), 0});
    triple(t.measurands, "deviation_",
           "place of the target by the instrument minus that by the commands, in the frame of the machine");
  } else {
    t.indications.push_back({"distance", "mm", "m", "of the target from the origin of the instrument's frame", 0});
    t.measurands.push_back({"deviation", "mm", "m", "distance by the instrument minus that by the commands", 0});
  }
  t.axes = cards_of_axes(p.machine);
  t.equations = {
      {"position = W * target", "W: pose of the last component by the axes of the machine, their errors and loads"}};
  t.equations.push_back(p.measured == Measured::position
                            ? std::pair<std::string, std::string>{"deviation = B * read - position",
                                                                  "B: from the instrument's frame to the machine's"}
                            : std::pair<std::string, std::string>{"deviation = distance - norm(place)",
                                                                  "place: the position in the instrument's frame"});
  return t;
}

} // namespace

MadeModel make(const chain::MachineDescription& description, Measured measured) {
  auto p = std::make_shared<SerialChain>(description, measured);
  p->card = std::make_unique<MadeCard>(texts_of(*p, description));
  p->model.card = &p->card->card();
  p->model.kernels = &kernels;
  p->model.evaluate_gradient = &evaluate_point<Gradient>;
  p->model.evaluate_curvature = &evaluate_point<Curvature>;
  p->model.simulate_gradient = &simulate_point<Gradient>;
  p->model.explain = &explain;
  p->model.check = &check;
  p->model.solve_reads = &solve_reads;
  p->model.context = p.get();
  return {p, &p->model};
}

} // namespace gumshoe::models::serial_chain
