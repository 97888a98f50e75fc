#include "scenario/choose.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenario/choose_time.h"
#include "scenario/knobs.h"

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t most_samples = std::int64_t{1} << 32, most_steps = 1000;
using Kind = Knob::Kind;

class ChooseReader {
public:
  ChooseReader(Table table, const ChooseScope& scope, Context& context)
      : table_(std::move(table)), scope_(scope), context_(context), problems_(context.problems),
        knobs_(scope, context.problems) {}

  Choose read() {
    if (scope_.scenario.method != Method::virtual_experiment)
      table_.add("choose: needs method = \"virtual_experiment\"",
                 "the error of a setting is what is stated less the truth", "add it to [model]");
    if (table_.require("variables", "[choose.variables] feed = [\"10 mm/min\", \"100 mm/min\"]"))
      if (auto variables = table_.table("variables")) read_variables(*variables);
    list("cases", [&](Table& t) { out_.cases.push_back(read_case(t)); });
    list("compare", [&](Table& t) { out_.compare.push_back(read_compare(t)); });
    aim();
    counts();
    out_.time = read_time(table_.table("time"), table_.node(), scope_.model, asked(), context_);
    table_.refuse_unknown();
    return std::move(out_);
  }

private:
  template <class Read> void list(const char* key, const Read& read) {
    const auto* items = table_.array(key);
    for (std::size_t i = 0; items && i < items->size(); ++i)
      if (auto one = as_table((*items)[i], fmt::format("choose.{}[{}]", key, i + 1), problems_)) {
        read(*one);
        one->refuse_unknown();
      }
  }

  /// By evaluation: whether a candidate may use it.
  std::vector<bool> asked() const {
    std::vector<bool> out(evaluations_.size(), false);
    bool turned = false;
    for (const Variable& v : out_.variables)
      if (v.knob.kind == Kind::evaluation) {
        turned = true;
        for (const double e : v.values) out[static_cast<std::size_t>(e)] = true;
      }
    for (std::size_t e = 0; e < out.size(); ++e)
      if (evaluations_[e] == scope_.scenario.evaluation && !turned) out[e] = true;
    for (const ChooseCompare& c : out_.compare)
      for (const Setting& s : c.settings)
        if (s.knob.kind == Kind::evaluation) out[static_cast<std::size_t>(s.value)] = true;
    return out;
  }

  void aim() {
    std::vector<std::string> names;
    const ModelCard seen = evaluated_card(scope_.model, scope_.scenario.evaluation);
    for (const VariableCard& m : seen.measurands) names.emplace_back(m.name);
    std::size_t index = 0;
    bool known = names.size() == 1;
    if (const Node* node = known ? table_.find("measurand") : table_.require("measurand"); node) {
      const auto chosen = table_.choice("measurand", names);
      known = chosen.has_value();
      index = chosen.value_or(0);
    }
    table_.require("target", "target = \"3 um\"");
    if (!known) { // no dimension to judge the others by
      table_.find("target"), table_.find("bias");
    } else {
      const VariableCard& card = seen.measurands[index];
      out_.measurand = card.name;
      const Dimension width{std::string(card.si_unit), units::Kind::difference};
      out_.target = above_zero("target", width).value_or(1);
      const Node* target = table_.find("target");
      out_.unit = target && target->kind == Node::Kind::text ? units_of(*target) : card.unit;
      out_.bias = above_zero("bias", width);
      measured_by_all();
    }
    if (const auto of = table_.choice("target_of", {"average", "worst_case"})) out_.worst_case = *of == 1;
    if (out_.worst_case && out_.cases.empty())
      problems_.add(*table_.find("target_of"), "choose.target_of: there are no cases", "", "[[choose.cases]]");
    if (const auto d = table_.choice("definition", {"corrected", "uncorrected"}))
      out_.definition = static_cast<Choose::Definition>(*d);
  }

  static std::string units_of(const Node& measure) {
    try {
      return units::parse(measure.text).unit;
    } catch (const InputError&) { // said already
      return "1";
    }
  }

  std::optional<double> above_zero(const std::string& key, const Dimension& dimension) {
    const auto x = table_.measure(key, dimension);
    if (!x || *x > 0) return x;
    problems_.add(*table_.find(key), table_.path(key) + ": must be above 0");
    return std::nullopt;
  }

  /// Every evaluation that may be chosen must yield the measurand.
  void measured_by_all() {
    const auto by = asked();
    for (std::size_t e = 0; e < by.size(); ++e) {
      const ModelCard seen = evaluated_card(scope_.model, evaluations_[e]);
      if (by[e] && std::ranges::find(seen.measurands, out_.measurand, &VariableCard::name) == seen.measurands.end())
        table_.add(fmt::format("choose: evaluation '{}' does not yield '{}'", evaluations_[e], out_.measurand));
    }
  }

  void counts() {
    const auto count = [&](const char* key, std::int64_t least, std::int64_t most, auto& value) {
      if (const auto n = table_.integer(key, least, most)) value = static_cast<std::decay_t<decltype(value)>>(*n);
    };
    count("samples", 200, most_samples, out_.samples);
    count("confirm_samples", 200, most_samples, out_.confirm_samples);
    count("refinements", 0, 20, out_.refinements);
    count("sobol", 0, most_samples, out_.sobol);
    const auto share = [&](const char* key, double& value) {
      const auto x = table_.number(key);
      if (x && *x > 0 && *x < 1)
        value = *x;
      else if (x)
        problems_.add(*table_.find(key), table_.path(key) + ": must lie between 0 and 1");
    };
    share("confirm_probability", out_.confirm_probability);
    share("near", out_.near);
  }

  void read_variables(Table& table) {
    for (const Member& m : table.members()) {
      const auto knob = knobs_.find(m, table.path(), false);
      if (!knob) continue;
      Variable v{*knob, {}};
      if (m.value.kind == Node::Kind::table)
        range(Table(m.value, table.path(m.key), problems_), v);
      else if (const auto* items = table.array(m.key))
        values(*items, m, table.path(m.key), v);
      if (!v.values.empty()) out_.variables.push_back(std::move(v));
    }
    if (table.members().empty()) table.add("choose.variables: empty", "nothing to choose from");
  }

  void values(const std::vector<Node>& items, const Member& m, const std::string& path, Variable& v) {
    if (items.empty()) problems_.add(m.value, path + ": empty", "nothing to choose from");
    for (const Node& item : items) {
      const auto x = knobs_.value(item, path, v.knob);
      if (x && std::ranges::find(v.values, *x) != v.values.end())
        problems_.add(item, path + ": the value stands twice");
      else if (x)
        v.values.push_back(*x);
    }
  }

  /// { low, high, steps, scale }
  void range(Table table, Variable& v) {
    if (v.knob.kind == Kind::evaluation) {
      table.add(table.path() + ": evaluations are listed", "", "evaluation = [\"...\"]");
      table.members();
      return;
    }
    const Node *low = table.require("low"), *high = table.require("high");
    const auto a = low ? knobs_.value(*low, table.path("low"), v.knob) : std::nullopt;
    const auto b = high ? knobs_.value(*high, table.path("high"), v.knob) : std::nullopt;
    const auto steps = table.integer("steps", 2, most_steps).value_or(5);
    if (const auto scale = table.choice("scale", {"linear", "log"})) v.logarithmic = *scale == 1;
    table.refuse_unknown();
    if (!a || !b) return;
    if (!(*a < *b)) {
      table.add(table.path() + ": low is not below high");
    } else if (v.logarithmic && *a <= 0) {
      problems_.add(*low, table.path("low") + ": not above 0", "a logarithmic scale has no zero",
                    "scale = \"linear\"");
    } else {
      v.range = true;
      v.steps = static_cast<int>(steps);
      v.values = {*a, *b};
      std::vector<double> grid;
      for (int i = 0; i < v.steps; ++i) {
        const double x = v.at(i, v.steps - 1);
        if (grid.empty() || x > grid.back()) grid.push_back(x);
      }
      v.values = std::move(grid);
    }
  }

  ChooseCase read_case(Table& table) {
    ChooseCase out;
    if (table.require("name")) out.name = table.text("name").value_or("");
    out.source = table.rendered("source");
    if (table.require("values", "values = { wear_1 = \"20 um\" }"))
      if (auto values = table.table("values")) out.values = read_settings(*values, true);
    return out;
  }

  ChooseCompare read_compare(Table& table) {
    ChooseCompare out;
    if (table.require("name")) out.name = table.text("name").value_or("");
    out.source = table.rendered("source");
    if (table.require("settings", "settings = { feed = \"3 mm/min\" }"))
      if (auto settings = table.table("settings")) out.settings = read_settings(*settings, false);
    return out;
  }

  std::vector<Setting> read_settings(Table& table, bool quantities_only) {
    std::vector<Setting> out;
    if (table.members().empty()) table.add(table.path() + ": empty");
    for (const Member& m : table.members())
      if (const auto knob = knobs_.find(m, table.path(), quantities_only))
        if (const auto x = knobs_.value(m.value, table.path(m.key), *knob)) out.push_back({*knob, *x});
    return out;
  }

  Table table_;
  const ChooseScope& scope_;
  Context& context_;
  Problems& problems_;
  KnobReader knobs_;
  const std::vector<std::string>& evaluations_ = knobs_.evaluations();
  Choose out_;
};

} // namespace

Choose read_choose(Table table, const ChooseScope& scope, Context& context) {
  return ChooseReader(std::move(table), scope, context).read();
}

} // namespace gumshoe::scenario
