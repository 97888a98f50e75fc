#include "scenario/plan.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenario/option.h"
#include "scenario/plan_readings.h"
#include "scenario/plan_table.h"

namespace gumshoe::scenario {
namespace {

Options<Plan> plan_options() {
  return {
      option::by_hand<Plan>(
          "readings", allowed_readings_shape(),
          "further readings that are allowed: every combination of these values of conditions, labels "
          "and recorded columns. What is left out has the value that all readings share"),
      option::by_hand<Plan>("points", shape::text(),
                            "CSV file of the readings that are allowed, a row each: columns are conditions, as `name "
                            "(unit)`, labels, and perhaps `cost`"),
      option::whole("most", &Plan::most, 1, 1000, "largest number of further readings"),
      option::got("budget", &Plan::budget, shape::reference("positive"), "largest cost of all further readings",
                  [](Table& t) { return t.positive("budget"); }),
      option::positive("cost", &Plan::cost, "cost of a reading; default: 1"),
      option::by_hand<Plan>("setup_costs", shape::map(shape::reference("positive")),
                            "by label: cost of each of its values that no reading has yet, such as a new set-up"),
      option::texts("split", &Plan::split, R"("minItems": 2)", "effects that must be distinguished from one another"),
      option::texts("detect", &Plan::detect, "", "effects that must be detected"),
      option::by_hand<Plan>("sizes", shape::map(shape::reference("measure")),
                            "by effect: size assumed; default: the scenario's value, else the smallest typical one"),
      option::by_hand<Plan>("uncertainties", shape::map(shape::reference("width")),
                            "by quantity: target standard uncertainty"),
      option::share("power", &Plan::power, true, "probability with which effects must be distinguished or detected"),
      option::share("alpha", &Plan::alpha, true,
                    "false-alarm rate of one test; 0.001 is that of one of 50 candidates in a search at 5 %"),
  };
}

class PlanReader {
public:
  PlanReader(Table table, const PlanScope& scope, Context& context)
      : table_(std::move(table)), scope_(scope), context_(context) {}

  Plan read() {
    read_options(table_, plan_options(), out_);
    if (table_.has("split") && out_.split.size() < 2)
      table_.refuse_key("split", "needs two effects or more", "each is distinguished from every other");
    for (const char* key : {"split", "detect"}) check_effects(key);
    sizes();
    uncertainties();
    setup_costs();
    out_.readings = read_allowed_readings(table_, {scope_.model, scope_.scenario, out_.cost}, context_);
    if (out_.d_optimal() && !table_.has("most") && !table_.has("budget"))
      table_.refuse("needs a goal or a limit", "every further reading reduces the uncertainties",
                    "give split, detect or uncertainties; or most or budget, for a D-optimal plan");
    out_.columns = plan_columns(scope_, out_.readings, context_);
    table_.refuse_unknown();
    return std::move(out_);
  }

private:
  struct Unit {
    std::string si_unit;
  };

  /// "z_scale", "thermal_growth.rate", "z_reversal[rod 3]", "declared:rod_length[rod 2]" or a stated effect.
  std::optional<Unit> effect(const std::string& name, std::vector<std::string>& known) const {
    const std::string plain = name.substr(0, name.find('['));
    for (const auto& q : scope_.scenario.quantities) {
      known.push_back("declared:" + q.name);
      if (plain == known.back()) return Unit{q.si_unit};
    }
    for (const StatedEffect& e : scope_.scenario.stated_effects) {
      known.push_back(e.name);
      if (plain == e.name) return Unit{e.si_unit};
    }
    for (const EffectCard* card : scope_.catalogue.effects) {
      if (scope_.catalogue.applies && !scope_.catalogue.applies(scope_.model, *card)) continue;
      known.emplace_back(card->name);
      for (const QuantityCard& q : card->quantities) {
        if (q.role == Role::shape) continue;
        if (plain == known.back() || plain == fmt::format("{}.{}", card->name, q.name))
          return Unit{std::string(q.si_unit)};
      }
    }
    return std::nullopt;
  }

  std::optional<Unit> effect_at(const Node& node, const std::string& path, const std::string& name) {
    std::vector<std::string> known;
    auto out = effect(name, known);
    if (!out)
      table_.problems().add(node, fmt::format("{}: '{}' is no effect of {}", path, name, scope_.model.name), "",
                            did_you_mean(name, known));
    return out;
  }

  void check_effects(const std::string& key) {
    const Node* node = table_.find(key);
    if (!node) return;
    const std::vector<Node> one{*node};
    for (const Node& item : node->kind == Node::Kind::array ? node->items : one)
      if (item.kind == Node::Kind::text) effect_at(item, table_.path(key), item.text);
  }

  void sizes() {
    auto table = table_.table("sizes");
    if (!table) return;
    for (const Member& m : table->members())
      if (const auto unit = effect_at(m.value, table->path(), m.key))
        if (const auto x = table->measure(m.key, {unit->si_unit, units::Kind::difference})) {
          if (*x == 0) table->refuse_key(m.key, "the size is zero", "nothing is to be seen of it");
          out_.sizes.emplace_back(m.key, *x);
        }
  }

  void uncertainties() {
    auto table = table_.table("uncertainties");
    if (!table) return;
    for (const Member& m : table->members()) {
      const std::string plain = m.key.substr(0, m.key.find('['));
      const auto& all = scope_.scenario.quantities;
      const auto q = std::ranges::find(all, plain, &quantities::InputQuantity::name);
      if (q == all.end())
        table_.problems().add(m.value, fmt::format("{}: '{}' is not a quantity here", table->path(), m.key), "",
                              did_you_mean(plain, names_of(all)));
      else if (const auto u = table->width(m.key, q->si_unit))
        out_.uncertainties.emplace_back(m.key, *u);
    }
  }

  void setup_costs() {
    auto table = table_.table("setup_costs");
    if (!table) return;
    for (const Member& m : table->members())
      if (const auto cost = table->positive(m.key); cost && context_.is_label(m.value, table->path(), m.key))
        out_.setup_costs.emplace_back(m.key, *cost);
  }

  Table table_;
  const PlanScope& scope_;
  Context& context_;
  Plan out_;
};

} // namespace

Shape plan_shape() {
  return table_shape(plan_options(), R"("oneOf": [{"required": ["readings"]}, {"required": ["points"]}])");
}

Plan read_plan(Table table, const PlanScope& scope, Context& context) {
  return PlanReader(std::move(table), scope, context).read();
}

} // namespace gumshoe::scenario
