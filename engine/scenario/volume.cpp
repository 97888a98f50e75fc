#include "scenario/volume.h"

#include <algorithm>

#include <fmt/format.h>

#include "models/serial_chain/serial_chain.h"
#include "scenario/machine.h"

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t most_points = 200, most_draws = 10'000'000;

std::vector<Key> range_keys() {
  return {{"from", shape::reference("measure"), "first command", true},
          {"to", shape::reference("measure"), "last command", true},
          {"points", shape::whole(2, most_points), "evenly spaced, both ends included", true}};
}

std::vector<Key> volume_keys() {
  return {
      {"tool", shape::list(shape::reference("measure"), R"("minItems": 3, "maxItems": 3)"),
       "point of the tool from the frame of the last component; default: the probe's tip or the target of the model"},
      {"payload", shape::reference("measure"), "mass at the tool; default 0 kg"},
      {"samples", shape::whole(100, most_draws), "draws of the input quantities", false, "10000"}};
}

class VolumeReader {
public:
  VolumeReader(Table table, Problems& problems) : table_(std::move(table)), problems_(problems) {}

  Volume read(Table& top) {
    table_.declare({});
    if (!top.has("machine")) {
      table_.refuse("the scenario has no [machine]", "its axes span the volume", "[machine] name = \"TTTRR\"");
      return out_;
    }
    const auto machine = read_machine(top, problems_);
    if (!machine) return out_;
    out_.chain = models::serial_chain::make(*machine, models::serial_chain::Measured::position);
    const auto conditions = out_.chain->card->conditions;
    for (std::size_t i = 0; i < conditions.size(); ++i) command(conditions[i], i);
    if (const auto n = table_.integer("samples", 100, most_draws)) out_.samples = static_cast<std::uint64_t>(*n);
    if (const auto* point = table_.array("tool")) tool(*point);
    if (out_.ranges.empty() || out_.ranges.size() > 3)
      table_.refuse(fmt::format("{} axes have a range", out_.ranges.empty() ? "no" : "more than three"),
                    "one to three axes span a volume", "X = { from = \"0 mm\", to = \"500 mm\", points = 6 }");
    std::vector<std::string> names;
    for (const VariableCard& c : conditions) names.emplace_back(c.name);
    for (const Member& m : table_.members())
      if (m.key != "samples" && m.key != "tool" && std::ranges::find(names, m.key) == names.end())
        table_.refuse_key(m.key, fmt::format("the machine has no axis '{}'", m.key), "", did_you_mean(m.key, names));
    return std::move(out_);
  }

private:
  void command(const VariableCard& card, std::size_t i) {
    const std::string key(card.name), unit(card.si_unit);
    out_.commands.push_back(0);
    const Node* node = table_.find(key);
    if (!node) return;
    if (node->kind != Node::Kind::table || card.unit == "kg") {
      out_.commands[i] = table_.measure(key, {unit}).value_or(0);
      return;
    }
    Table range(*node, table_.path(key), problems_);
    range.declare(range_keys());
    VolumeRange r{i};
    const bool stated = range.require("from", "from = \"0 mm\"") && range.require("to", "to = \"500 mm\"") &&
                        range.require("points", "points = 6");
    r.from = range.measure("from", {unit}).value_or(0);
    r.to = range.measure("to", {unit}).value_or(1);
    r.points = static_cast<std::size_t>(range.integer("points", 2, most_points).value_or(2));
    if (stated && r.from == r.to) range.refuse("the range has no length", "", key + " = \"0 mm\" is one command");
    range.refuse_unknown();
    out_.ranges.push_back(r);
  }

  void tool(const std::vector<Node>& point) {
    if (point.size() != 3)
      return table_.refuse_key("tool", "X, Y and Z are needed", "", "tool = [\"0 mm\", \"0 mm\", \"-150 mm\"]");
    out_.tool.emplace();
    for (std::size_t i = 0; i < 3; ++i)
      (*out_.tool)[i] = read_measure(point[i], table_.path("tool"), {"m"}, problems_).value_or(0);
  }

  Table table_;
  Problems& problems_;
  Volume out_;
};

} // namespace

std::size_t Volume::points() const {
  std::size_t n = 1;
  for (const VolumeRange& r : ranges) n *= r.points;
  return n;
}

std::vector<double> Volume::commands_at(std::size_t point) const {
  std::vector<double> out = commands;
  for (auto r = ranges.rbegin(); r != ranges.rend(); ++r) {
    out[r->axis] = r->at(point % r->points);
    point /= r->points;
  }
  return out;
}

Shape volume_shape() {
  return shape::table(volume_keys(), R"("patternProperties": {"^[XYZUVWABCJ][0-9]*$": {)" +
                                         shape::any_of({shape::reference("measure"), shape::table(range_keys())}) +
                                         "}}");
}

Volume read_volume(Table table, Table& top, Problems& problems) {
  return VolumeReader(std::move(table), problems).read(top);
}

std::optional<Volume> stated_volume(const Scenario& scenario) {
  const Node document = parse_document(scenario.text, scenario.file);
  Problems problems(scenario.file);
  Table top(document, "", problems);
  auto table = top.table("volume");
  if (!table) return std::nullopt;
  Volume out = read_volume(*table, top, problems);
  problems.raise();
  return out;
}

Volume volume_of(const Scenario& scenario) {
  if (auto stated = stated_volume(scenario)) return std::move(*stated);
  throw InputError({{{scenario.file},
                     "[volume] is missing",
                     "it says over which commands the errors are mapped",
                     "[volume] X = { from = \"0 mm\", to = \"500 mm\", points = 6 }"}});
}

} // namespace gumshoe::scenario
