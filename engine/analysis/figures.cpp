#include "analysis/figures.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "analysis/result_fields.h"
#include "base/error.h"

namespace gumshoe::analysis {

FigureName parse_figure(const std::string& text) {
  const auto open = text.find('[');
  if (open == std::string::npos || text.back() != ']') return {text, {}};
  FigureName name{text.substr(0, open), {""}};
  int depth = 0;
  for (const char c : text.substr(open + 1, text.size() - open - 2)) {
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (c == ',' && depth == 0)
      name.arguments.emplace_back();
    else if (c != ' ' || !name.arguments.back().empty())
      name.arguments.back() += c;
  }
  return name;
}

namespace {

/// The field of this figure's name, in one row.
template <class Row>
std::optional<Figure> find(const Fields<Row>& fields, const Row& row, const std::string& name,
                           const propagation::Output& output) {
  const auto field = std::ranges::find(fields.list, name, [](const Field<Row>& f) { return f.shown.gauge; });
  if (field == fields.list.end()) return std::nullopt;
  const RowUnit unit = shown_in(field->unit, unit_of(row), {output.unit, output.si_unit});
  Figure figure{0, 0, unit.shown, unit.si, field->unit.in != In::point, ""};
  std::visit(
      [&]<class T>(const T& value) {
        if constexpr (std::is_same_v<T, std::string>)
          figure.word = value;
        else if constexpr (std::is_same_v<T, bool>)
          figure.word = value ? "yes" : "no";
        else
          figure.value = static_cast<double>(value);
      },
      field->get(row));
  if (field->standard_error) figure.standard_error = std::get<double>(field->standard_error(row));
  return figure;
}

/// One of a run: a field of the summary, the budget or a study of one output, or what is computed from several.
class Finder {
public:
  Finder(const Results& r, std::size_t output, const std::string& name)
      : r_(r), o_(output), text_(name), name_(parse_figure(name)), out_(r.summaries.at(output).output) {}

  Figure find() {
    for (const auto part : {&Finder::summary, &Finder::budget, &Finder::sensitivity, &Finder::joint,
                            &Finder::conformity, &Finder::by_input})
      if (auto figure = (this->*part)()) {
        if (std::isnan(figure->value) && figure->word.empty()) figure->word = "none";
        return *figure;
      }
    throw InputError("'" + text_ + "' is not a figure of this result", "or the scenario does not request its study",
                     "scenarios/gauge/README.md lists them");
  }

private:
  Figure measure(double value, double se = 0) const { return {value, se, out_.unit, out_.si_unit, true, ""}; }
  Figure point(double value) const { return {value, 0, out_.unit, out_.si_unit, false, ""}; }
  static Figure plain(double value, double se = 0) { return {value, se, "1", "1", true, ""}; }
  static Figure word(const std::string& text) { return {0, 0, "1", "1", true, text}; }
  const std::string& argument(std::size_t i) const {
    static const std::string none;
    return i < name_.arguments.size() ? name_.arguments[i] : none;
  }
  template <class Row> std::optional<Figure> field(const Fields<Row>& fields, const Row& row) const {
    return analysis::find(fields, row, name_.word, out_);
  }
  /// In the row of the input, component or quantity that the argument names.
  template <class Row, class Name>
  std::optional<Figure> row_of(const Fields<Row>& fields, const std::vector<Row>& rows, Name name) const {
    const auto row = std::ranges::find(rows, argument(0), name);
    return row == rows.end() ? std::nullopt : field(fields, *row);
  }
  /// The study that is about our output; null if there is none.
  template <class Study> const Study* mine(const std::vector<Study>& studies) const {
    const auto study =
        std::ranges::find(studies, out_.name, [](const Study& s) -> const std::string& { return s.output.name; });
    return study == studies.end() ? nullptr : &*study;
  }

  std::optional<Figure> summary() {
    const Summary& s = r_.summaries[o_];
    const auto& [low, high, low_se, high_se, low_rank, high_rank] = s.symmetric;
    if (name_.word == "symmetric_length") return measure(high - low, std::hypot(low_se, high_se));
    if (name_.word == "shortest_length") return measure(s.shortest.high - s.shortest.low, s.shortest_length_se);
    if (name_.word == "trials") return plain(static_cast<double>(r_.samples));
    return field(summary_fields, s);
  }

  std::optional<Figure> budget() {
    const Budget& b = r_.budgets[o_];
    if (name_.word == "gum.low") return point(b.estimate - b.expanded_uncertainty);
    if (name_.word == "gum.high") return point(b.estimate + b.expanded_uncertainty);
    if (name_.word == "gum.degrees_of_freedom") {
      if (std::isnan(b.effective_degrees_of_freedom)) return word("refused");
      if (std::isinf(b.effective_degrees_of_freedom)) return word("infinite");
      return plain(b.effective_degrees_of_freedom);
    }
    if (const auto figure = field(budget_fields, b)) return figure;
    if (const auto figure = row_of(contribution_fields, b.contributions, &Contribution::name)) return figure;
    return field(validation_fields, r_.validations[o_]);
  }

  std::optional<Figure> sensitivity() {
    const Sensitivity* s = mine(r_.sensitivities);
    if (!s) return std::nullopt;
    if (const auto figure = row_of(sobol_fields, s->indices, &SobolIndex::input)) return figure;
    for (const SobolPair& p : s->pairs)
      if ((p.a == argument(0) && p.b == argument(1)) || (p.b == argument(0) && p.a == argument(1)))
        return field(pair_fields, p);
    return std::nullopt;
  }

  /// The studies with one row per input.
  std::optional<Figure> by_input() {
    std::optional<Figure> found;
    const auto look = [&](const auto* study, const auto& fields, auto rows, auto name) {
      if (!found && study) found = row_of(fields, (*study).*rows, name);
    };
    look(mine(r_.shapley), shapley_fields, &Shapley::effects, &Index::input);
    look(mine(r_.given_data), rank_fields, &GivenData::first, &Index::input);
    look(mine(r_.given_data), delta_fields, &GivenData::delta, &Index::input);
    look(mine(r_.dgsm), dgsm_fields, &Dgsm::rows, &DgsmRow::input);
    look(mine(r_.targets), target_fields, &TargetResult::rows, &TargetRow::quantity);
    return found;
  }

  std::optional<Figure> joint() {
    if (!name_.word.starts_with("joint.")) return std::nullopt;
    const auto is = [](const propagation::Output& o, const std::string& n) { return o.measurand == n || o.name == n; };
    for (const JointRegion& g : r_.joint) {
      const auto at = [&](const std::string& n) {
        return static_cast<std::size_t>(std::ranges::find_if(g.outputs, [&](const auto& o) { return is(o, n); }) -
                                        g.outputs.begin());
      };
      if (at(out_.name) == g.outputs.size()) continue;
      if (const auto figure = field(joint_fields, g)) return figure;
      const std::size_t n = g.outputs.size(), i = at(argument(0)), j = at(argument(1));
      if (i == n || j == n) continue;
      if (name_.word == "joint.correlation") { // its standard error is that of two normal quantities
        const double c = g.correlation[i * n + j];
        return plain(c, (1 - c * c) / std::sqrt(static_cast<double>(r_.samples)));
      }
      if (name_.word == "joint.gum_correlation" && !g.gum_covariance.empty())
        return plain(g.gum_covariance[i * n + j] /
                     std::sqrt(g.gum_covariance[i * n + i] * g.gum_covariance[j * n + j]));
    }
    return std::nullopt;
  }

  std::optional<Figure> conformity() {
    if (const CircularSummary* s = mine(r_.circular))
      if (const auto figure = field(circular_fields, *s)) return figure;
    const ConformityResult* s = mine(r_.conformity);
    if (!s) return std::nullopt;
    if (name_.word == "conformity.decision") return word(s->accepted ? "accepted" : "rejected");
    auto figure = field(conformity_fields, *s);
    if (figure && name_.word == "conformity.global_consumer_risk")
      figure->standard_error = s->global_consumer_risk_se;
    else if (figure && name_.word == "conformity.global_producer_risk")
      figure->standard_error = s->global_producer_risk_se;
    else if (figure && name_.word.ends_with("_risk")) // a share of the samples
      figure->standard_error = std::sqrt(figure->value * (1 - figure->value) / static_cast<double>(r_.samples));
    return figure;
  }

  const Results& r_;
  std::size_t o_;
  std::string text_;
  FigureName name_;
  const propagation::Output& out_;
};

} // namespace

Figure figure(const Results& results, std::size_t output, const std::string& name) {
  return Finder(results, output, name).find();
}

} // namespace gumshoe::analysis
