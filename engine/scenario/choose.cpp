#include "scenario/choose.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scenario/choose_time.h"
#include "scenario/choose_variables.h"
#include "scenario/knobs.h"
#include "scenario/option.h"

namespace gumshoe::scenario {
namespace {

constexpr std::int64_t most_samples = std::int64_t{1} << 32;
using Kind = Knob::Kind;

Options<ChooseCase> case_options() {
  return {
      option::text("name", &ChooseCase::name, "").needed(),
      option::source(&ChooseCase::source),
      option::by_hand<ChooseCase>("values", shape::map(shape::reference("measure"), R"("minProperties": 1)"),
                                  "true values of quantities, by name")
          .needed("values = { wear_1 = \"20 um\" }"),
  };
}

Options<ChooseCompare> compare_options() {
  return {
      option::text("name", &ChooseCompare::name, "").needed(),
      option::source(&ChooseCompare::source),
      option::by_hand<ChooseCompare>("settings", shape::map(setting_shape(), R"("minProperties": 1)"),
                                     "conditions, quantities, readings or evaluation, by name")
          .needed("settings = { feed = \"3 mm/min\" }"),
  };
}

Options<Choose> choose_options() {
  const auto by_hand = [](const char* key, const Shape& shape, const char* meaning) {
    return option::by_hand<Choose>(key, shape, meaning);
  };
  return {
      by_hand("measurand", shape::text(), "measurand that every evaluation yields; required if there are several"),
      by_hand("target", shape::reference("width"), "target expanded uncertainty").needed("target = \"3 um\""),
      option::word("target_of", &Choose::worst_case, {{"average", false}, {"worst_case", true}},
                   "which U must meet the target: that over all uncertain quantities, or that of the worst case"),
      by_hand("bias", shape::reference("width"), "limit of the magnitude of the mean error; default: none"),
      option::word("definition", &Choose::definition,
                   std::vector{Choose::Definition::corrected, Choose::Definition::uncorrected},
                   "corrected: the mean error is corrected for, U is half the interval about the corrected result; "
                   "uncorrected: U is the quantile of the error's magnitude"),
      option::whole("samples", &Choose::samples, 200, most_samples, "samples per candidate"),
      option::whole("confirm_samples", &Choose::confirm_samples, 200, most_samples,
                    "samples of the fresh run of the recommended setting"),
      option::share("confirm_probability", &Choose::confirm_probability, true,
                    "required probability of meeting the target in the fresh run; otherwise the next-fastest setting "
                    "is tried"),
      option::whole("refinements", &Choose::refinements, 0, 20, "number of refinements, each of which halves the "
                                                                "steps of the ranges"),
      option::share("near", &Choose::near, true,
                    "share of the time, or of U, within which settings count as near the optimum"),
      option::whole("sobol", &Choose::sobol, 0, most_samples,
                    "rows of the sensitivity design at the optimum; 0: none"),
      by_hand("variables", variables_shape(),
              "variables: conditions, quantities, readings or evaluation, each with its values or their range")
          .needed("[choose.variables] feed = [\"10 mm/min\", \"100 mm/min\"]"),
      by_hand("time", time_shape(),
              "formulas for the time, with conditions, quantities, readings and the constants given here; the default "
              "is "
              "that of the model"),
      by_hand("cases", shape::list(table_shape(case_options())), "cases of unknown true values; U is given for each"),
      by_hand("compare", shape::list(table_shape(compare_options())), "settings shown next to the recommended one"),
  };
}

class ChooseReader {
public:
  ChooseReader(Table table, const ChooseScope& scope, Context& context)
      : table_(std::move(table)), scope_(scope), context_(context), problems_(context.problems),
        knobs_(scope, context.problems) {}

  Choose read() {
    if (scope_.scenario.method != Method::virtual_experiment)
      table_.refuse("needs method = \"virtual_experiment\"",
                    "the error of a setting is the stated value minus the true value", "add it to [model]");
    read_options(table_, choose_options(), out_);
    if (auto variables = table_.table("variables")) out_.variables = read_variables(*variables, knobs_);
    for (Table& row : table_.tables("cases")) out_.cases.push_back(read_case(row));
    for (Table& row : table_.tables("compare")) out_.compare.push_back(read_compare(row));
    aim();
    out_.time = read_time(table_.table("time"), table_.node(), scope_.model, asked(), context_);
    table_.refuse_unknown();
    return std::move(out_);
  }

private:
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
    const ModelCard seen = evaluated_card(scope_.model, scope_.scenario.evaluation);
    const std::vector<std::string> names = names_of(seen.measurands);
    std::optional<std::size_t> index;
    if (names.size() > 1) table_.require("measurand");
    if (table_.has("measurand"))
      index = table_.choice("measurand", names);
    else if (names.size() == 1)
      index = 0;
    const Node* target = table_.find("target");
    table_.find("bias");
    if (index) { // else there is no dimension to judge the others by
      const VariableCard& card = seen.measurands[*index];
      const std::string si_unit(card.si_unit);
      out_.measurand = card.name;
      out_.target = table_.width("target", si_unit).value_or(1);
      out_.unit = target && target->kind == Node::Kind::text ? units_of(*target) : card.unit;
      out_.bias = table_.width("bias", si_unit);
      measured_by_all();
    }
    if (out_.worst_case && out_.cases.empty())
      table_.refuse_key("target_of", "there are no cases", "", "[[choose.cases]]");
  }

  static std::string units_of(const Node& measure) {
    try {
      return units::parse(measure.text).unit;
    } catch (const InputError&) { // said already
      return "1";
    }
  }

  /// Every evaluation that may be chosen must yield the measurand.
  void measured_by_all() {
    const auto by = asked();
    for (std::size_t e = 0; e < by.size(); ++e) {
      const ModelCard seen = evaluated_card(scope_.model, evaluations_[e]);
      if (by[e] && std::ranges::find(seen.measurands, out_.measurand, &VariableCard::name) == seen.measurands.end())
        table_.refuse(fmt::format("evaluation '{}' does not yield '{}'", evaluations_[e], out_.measurand));
    }
  }

  ChooseCase read_case(Table& table) {
    ChooseCase out;
    read_options(table, case_options(), out);
    if (auto values = table.table("values")) out.values = read_settings(*values, true);
    table.refuse_unknown();
    return out;
  }

  ChooseCompare read_compare(Table& table) {
    ChooseCompare out;
    read_options(table, compare_options(), out);
    if (auto settings = table.table("settings")) out.settings = read_settings(*settings, false);
    table.refuse_unknown();
    return out;
  }

  std::vector<Setting> read_settings(Table& table, bool quantities_only) {
    std::vector<Setting> out;
    if (table.members().empty()) table.refuse("empty");
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

Shape choose_shape() { return table_shape(choose_options()); }

Choose read_choose(Table table, const ChooseScope& scope, Context& context) {
  return ChooseReader(std::move(table), scope, context).read();
}

} // namespace gumshoe::scenario
