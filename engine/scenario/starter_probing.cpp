#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.h"
#include "chain/machine.h"
#include "models/sphere_probing/sphere_probing.h"
#include "scenario/starter_parts.h"

namespace gumshoe::scenario {

namespace {

using Side = std::vector<chain::AxisDescription>;

Side side_of(const std::string& names) {
  Side out;
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = std::min(names.find(',', at), names.size());
    out.push_back({names.substr(at, end - at)});
    at = end + 1;
  }
  return out;
}

chain::MachineDescription described(const std::string& text) {
  if (const auto* known = chain::find_machine(text)) return *known;
  const std::string remedy = "write the axes to the workpiece / the axes to the tool, such as --machine B,C/X,Y,Z";
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos)
    throw InputError(fmt::format("--machine: '{}' is neither two sides nor a known machine", text), "", remedy);
  chain::MachineDescription out{"", side_of(text.substr(0, slash)), side_of(text.substr(slash + 1))};
  if (const auto wrong = chain::problems(out); !wrong.empty())
    throw InputError(fmt::format("--machine: {}", wrong[0].what), wrong[0].why,
                     wrong[0].remedy.empty() ? remedy : wrong[0].remedy);
  if (const std::string why = models::probing::unreachable(out); !why.empty())
    throw InputError("--machine: " + why, "three slides bring the tip to the sphere", remedy);
  return out;
}

/// The rotary axes that columns name, on the workpiece side for want of better knowledge.
chain::MachineDescription guessed(const RecognisedData& data) {
  Side rotary;
  for (const char letter : {'A', 'B', 'C'})
    for (const RecognisedColumn& c : data.columns)
      if (c.number && is_named(c, std::string(1, letter))) {
        rotary.push_back({std::string(1, letter)});
        break;
      }
  if (rotary.empty())
    throw InputError(data.csv.file + ": no column has the name of a rotary axis (A, B or C)",
                     "a sphere at one angle shows no axis", "name the axes by --machine B,C/X,Y,Z");
  return {"", rotary, Side{{"X"}, {"Y"}, {"Z"}}};
}

std::string listed(const Side& side) {
  std::string out;
  for (const auto& axis : side) out += (out.empty() ? "" : ", ") + toml_string(axis.name);
  return "[" + out + "]";
}

std::string machine_text(const chain::MachineDescription& d, bool known) {
  std::string out = "[machine]\n";
  if (!d.name.empty()) {
    out += line("name", toml_string(d.name),
                "from the bed: " + listed(*d.workpiece_side) + " to the workpiece, " + listed(*d.tool_side) +
                    " to the tool");
    return out + "# Axes that do not meet at zero: points = { C = [\"0 mm\", \"0 mm\", \"-50 mm\"] }\n";
  }
  out += line("workpiece_side", known ? listed(*d.workpiece_side) : "[\"?\"]",
              known ? "from the bed outwards" : "axes that carry the workpiece, from the bed outwards: [\"B\", \"C\"]");
  out += line("tool_side     ", known ? listed(*d.tool_side) : "[\"?\"]",
              known ? "from the bed outwards" : "axes that carry the tool, likewise: [\"X\", \"Y\", \"Z\"]");
  return out + "# Axes that do not meet at zero: { axis = \"C\", point = [\"0 mm\", \"0 mm\", \"-50 mm\"] }\n";
}

std::string quantities_text(const chain::Machine& machine) {
  std::string out = "[quantities]\n"
                    "probe_z = { estimated = true, value = \"?\", u = \"5 um\", source = \"assumed: tool setter\" }\n";
  for (const char letter : {'x', 'y', 'z'})
    out += fmt::format("sphere_{} = {{ estimated = true, value = \"0 mm\" }}\n", letter);
  for (const chain::Axis& axis : machine.axes())
    for (int kind = chain::E_X0; axis.rotary && kind < chain::error_kinds; ++kind) {
      const bool angle = chain::is_angle(axis, kind);
      if (!chain::has_error(axis, kind) || kind == chain::E_A0 + axis.direction) continue; // the zero turns the sphere
      out += fmt::format("{} = {{ estimated = true, value = \"0 {}\", u = \"{}\", source = \"assumed: assembly\" }}\n",
                         chain::error_name(axis, kind), angle ? "deg" : "mm", angle ? "0.02 deg" : "0.1 mm");
    }
  return out;
}

} // namespace

std::string starter_probing(const StarterData& data, const std::string& machine) {
  const bool known = !machine.empty();
  const chain::MachineDescription d = known ? described(machine) : guessed(data.found);
  const std::string example =
      fmt::format(
          "# Question: which location errors has a machine that touched a sphere at the angles in {}, and what "
          "else is in the readings?\n"
          "# Written by gumshoe new. \"?\" stands for what only you know; slides are square until gumshoe trace "
          "finds otherwise.\n\n"
          "schema = 1\ntitle  = {}\n\n[model]\nname = \"sphere_probing\"\n\n",
          data.file, toml_string(data.file)) +
      machine_text(d, known) + '\n' + quantities_text(chain::Machine(d)) + "\n[run]\nsamples = 100_000\nseed    = 1\n";
  const models::MadeModel model = models::probing::make(d);
  return filled_in(*model->card, example, &data);
}

} // namespace gumshoe::scenario
