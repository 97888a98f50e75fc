#include "scenario/choose_time.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "formula/interpreter.h"
#include "formula/operation.h"
#include "scenario/quantity.h"

namespace gumshoe::scenario {

double TimeModel::value(std::size_t formula, const std::vector<double>& quantities, const quantities::Reading& reading,
                        std::size_t readings) const {
  std::vector<double> q;
  for (const std::size_t i : quantities_) q.push_back(quantities[i]);
  q.insert(q.end(), constants_.begin(), constants_.end());
  q.push_back(static_cast<double>(readings));
  const formula::Program& program = formulas_.evaluate;
  const auto values = formula::interpret<double>(program, {q.data(), reading.conditions.data(), nullptr});
  return values.steps[program.outputs[formula]];
}

double TimeModel::seconds(const std::vector<quantities::Reading>& readings,
                          const std::vector<std::vector<double>>& quantities) const {
  const std::size_t n = readings.size();
  double sum = once_ < 0 ? 0 : value(static_cast<std::size_t>(once_), quantities[0], readings[0], n);
  for (std::size_t r = 0; per_reading_ >= 0 && r < n; ++r)
    sum += readings[r].repeats * value(static_cast<std::size_t>(per_reading_), quantities[r], readings[r], n);
  return sum;
}

class TimeReader {
public:
  TimeReader(std::optional<Table> table, const Node& choose, const ModelCard& model, Context& context)
      : table_(std::move(table)), choose_(choose), model_(model), problems_(context.problems) {
    if (!table_) return;
    per_reading_ = written("per_reading");
    once_ = written("once");
  }

  std::vector<std::shared_ptr<const TimeModel>> read(const std::vector<bool>& asked) {
    const std::size_t before = problems_.size();
    names();
    std::vector<std::shared_ptr<const TimeModel>> out(model_.evaluations.size());
    for (std::size_t e = 0; e < out.size(); ++e)
      if (asked[e] && problems_.size() == before) out[e] = of_evaluation(model_.evaluations[e]);
    if (problems_.size() == before) refuse_unused();
    return out;
  }

private:
  /// Refuses constants that no formula uses: they are misspelled.
  void refuse_unused() {
    if (!table_) return;
    for (const Member& m : table_->members())
      if (m.key != "per_reading" && m.key != "once" && !used_.contains(m.key))
        problems_.add(m, fmt::format("choose.time.{}: no formula of the time uses it", m.key), "",
                      did_you_mean(m.key, names_of(model_.timing)));
  }

  /// A formula as text, and where it stands; from the card: nowhere.
  struct Written {
    std::string text;
    Location where;
  };
  Written written(const char* key) {
    const Node* node = table_->find(key);
    const auto text = node ? table_->text(key) : std::nullopt;
    if (!text) return {};
    return {*text, {problems_.file(), node->line, node->column + 1}}; // of the first character, after the quote
  }

  void names() {
    for (std::size_t i = 0; i < model_.quantities.size(); ++i) {
      const QuantityCard& q = model_.quantities[i];
      if (!formula::is_name(q.name)) continue;
      named_.push_back(i);
      symbols_.push_back({std::string(q.name), std::string(q.unit), std::string(q.si_unit), ""});
    }
    for (const QuantityCard& t : model_.timing) {
      constants_.push_back(t.default_value);
      if (table_ && table_->has(std::string(t.name)))
        if (const auto v = table_->measure(std::string(t.name), {std::string(t.si_unit), units::Kind::point})) {
          constants_.back() = *v;
          check_limits(*v, t, *table_->find(std::string(t.name)), fmt::format("choose.time.{}", t.name), problems_);
        }
      symbols_.push_back({std::string(t.name), std::string(t.unit), std::string(t.si_unit), ""});
    }
    if (table_)
      for (const Member& m : table_->members()) constant(m);
    symbols_.push_back({"readings", "1", "1", ""});
  }

  /// A constant of the scenario's own: its unit says what it is.
  void constant(const Member& m) {
    const auto is_it = [&](const auto& card) { return card.name == m.key; };
    if (m.key == "per_reading" || m.key == "once" || std::ranges::any_of(model_.timing, is_it)) return;
    const std::string path = "choose.time." + m.key;
    if (m.key == "readings" || std::ranges::any_of(model_.conditions, is_it) ||
        std::ranges::any_of(model_.quantities, is_it) || !formula::reserved_as(m.key).empty() ||
        !formula::is_name(m.key)) {
      problems_.add(m, fmt::format("{}: {}", path,
                                   formula::is_name(m.key) ? "the name already has a meaning"
                                                           : "a formula cannot use this name"));
      return;
    }
    std::string unit = "1";
    if (m.value.kind == Node::Kind::text) {
      try {
        unit = units::parse(m.value.text).unit;
        const std::string si_unit = units::si_unit_of(unit);
        if (const auto v = read_measure(m.value, path, {si_unit}, problems_)) {
          constants_.push_back(*v);
          symbols_.push_back({m.key, unit, si_unit, ""});
        }
      } catch (const InputError& error) {
        problems_.add(m.value, path, error);
      }
    } else if (const auto v = read_number(m.value, path, problems_)) {
      constants_.push_back(*v);
      symbols_.push_back({m.key, "1", "1", ""});
    }
  }

  std::shared_ptr<const TimeModel> of_evaluation(const EvaluationCard& card) {
    auto out = std::make_shared<TimeModel>();
    formula::Statement statement;
    const auto add = [&](const char* name, Written formula, std::string_view from_card) {
      if (formula.text.empty()) formula.text = from_card;
      if (formula.text.empty()) return -1;
      formula::Stated stated;
      stated.formula.name = std::string("choose.time.") + name;
      stated.formula.text = formula.text;
      stated.formula.where = formula.where;
      out->text_ += fmt::format("{}{} = {}", out->text_.empty() ? "" : ", ", name, formula.text);
      statement.measurands.push_back(std::move(stated));
      return static_cast<int>(statement.measurands.size()) - 1;
    };
    out->per_reading_ = add("per_reading", per_reading_, card.time_per_reading);
    out->once_ = add("once", once_, card.time_once);
    if (statement.measurands.empty()) {
      problems_.add(choose_, fmt::format("choose: the time that '{}' takes is not given", card.name),
                    "choose minimises the time", "[choose.time] per_reading = \"...\"");
      return nullptr;
    }
    statement.quantities = symbols_;
    for (const VariableCard& c : model_.conditions)
      statement.conditions.push_back({std::string(c.name), std::string(c.unit), std::string(c.si_unit), ""});
    try {
      std::vector<std::string> ignored; // what no formula uses
      out->formulas_ = formula::compile(std::move(statement), ignored);
      require_times(out->formulas_);
      for (const formula::Formula& f : out->formulas_.formulas)
        for (const formula::Node& node : f.nodes)
          if (node.operation == formula::Operation::name) used_.insert(node.name);
    } catch (const InputError& error) {
      for (Problem p : error.problems()) {
        if (p.where.file.empty()) p.where = {problems_.file(), choose_.line, choose_.column};
        if (p.remedy.starts_with("[quantities.")) p.remedy = "define it as a constant in [choose.time]";
        problems_.add(std::move(p));
      }
      return nullptr;
    }
    out->quantities_ = named_;
    out->constants_ = constants_;
    for (std::size_t i = 0; i < constants_.size(); ++i) {
      const Symbol& s = symbols_[named_.size() + i];
      if (used_.contains(s.name))
        out->text_ += fmt::format("; {} {:.12g}{}", s.name, constants_[i], units::suffix(s.si_unit));
    }
    return out;
  }

  static void require_times(const formula::Compiled& e) {
    for (std::size_t i = 0; i < e.explained.size(); ++i)
      if (!units::convertible(e.explained[i].unit, "s"))
        throw InputError({e.formulas[i].problem(
            0, fmt::format("{}: the formula gives {}", e.formulas[i].name, units::kind_name(e.explained[i].si_unit)),
            "a time is needed", "")});
  }

  std::optional<Table> table_;
  const Node& choose_;
  const ModelCard& model_;
  Problems& problems_;
  Written per_reading_, once_;
  std::vector<Symbol> symbols_;
  std::vector<std::size_t> named_;
  std::vector<double> constants_;
  std::set<std::string> used_; ///< names in the formulas of all evaluations
};

Shape time_shape() {
  const Shape formula = shape::reference("formula");
  return shape::table({{"per_reading", formula, "time per reading"},
                       {"once", formula, "time before the first reading"}},
                      "", shape::reference("measure"));
}

std::vector<std::shared_ptr<const TimeModel>> read_time(std::optional<Table> table, const Node& choose,
                                                        const ModelCard& model, const std::vector<bool>& asked,
                                                        Context& context) {
  return TimeReader(std::move(table), choose, model, context).read(asked);
}

} // namespace gumshoe::scenario
