#include "analysis/figures.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

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

/// A confidence interval of 95 % as a standard error.
double half_width(double low, double high) { return (high - low) / (2 * 1.959963984540054); }

class Finder {
public:
  Finder(const Results& r, std::size_t output, const std::string& name)
      : r_(r), o_(output), text_(name), name_(parse_figure(name)), out_(r.summaries.at(output).output) {}

  Figure find() {
    for (const auto part : {&Finder::summary, &Finder::gum, &Finder::validation, &Finder::sensitivity, &Finder::joint,
                            &Finder::circular, &Finder::conformity, &Finder::target})
      if (auto figure = (this->*part)()) {
        if (std::isnan(figure->value) && figure->word.empty()) figure->word = "none";
        return *figure;
      }
    throw InputError("'" + text_ + "' is no figure of this result", "or the scenario does not ask for its study",
                     "engine/analysis/figures.h lists them");
  }

private:
  Figure measure(double value, double se = 0) const { return {value, se, out_.unit, out_.si_unit, true, ""}; }
  Figure point(double value, double se = 0) const { return {value, se, out_.unit, out_.si_unit, false, ""}; }
  static Figure plain(double value, double se = 0) { return {value, se, "1", "1", true, ""}; }
  static Figure word(const std::string& text) { return {0, 0, "1", "1", true, text}; }
  const std::string& argument(std::size_t i) const {
    static const std::string none;
    return i < name_.arguments.size() ? name_.arguments[i] : none;
  }
  /// The row of a study that is about our output.
  template <class Rows> auto mine(const Rows& rows) const {
    return std::ranges::find_if(rows, [&](const auto& row) { return row.output.name == out_.name; });
  }

  std::optional<Figure> summary() {
    const Summary& s = r_.summaries[o_];
    const auto& [low, high, low_se, high_se, low_rank, high_rank] = s.symmetric;
    const std::string& w = name_.word;
    if (w == "estimate") return point(s.estimate, s.estimate_se);
    if (w == "standard_uncertainty") return measure(s.standard_uncertainty, s.standard_uncertainty_se);
    if (w == "symmetric_low") return point(low, low_se);
    if (w == "symmetric_high") return point(high, high_se);
    if (w == "symmetric_length") return measure(high - low, std::hypot(low_se, high_se));
    if (w == "shortest_low") return point(s.shortest.low, s.shortest.low_se);
    if (w == "shortest_high") return point(s.shortest.high, s.shortest.high_se);
    if (w == "shortest_length") return measure(s.shortest.high - s.shortest.low, s.shortest_length_se);
    if (w == "skewness") return plain(s.skewness);
    if (w == "kurtosis") return plain(s.kurtosis);
    if (w == "failed") return plain(static_cast<double>(s.failed));
    if (w == "trials") return plain(static_cast<double>(r_.samples));
    return std::nullopt;
  }

  std::optional<Figure> gum() {
    if (!name_.word.starts_with("gum.")) return std::nullopt;
    const Budget& b = r_.budgets[o_];
    const std::string w = name_.word.substr(4);
    if (w == "applicable") return word(b.applicable ? "yes" : "no");
    if (w == "estimate") return point(b.estimate);
    if (w == "standard_uncertainty") return measure(b.combined_standard_uncertainty);
    if (w == "expanded_uncertainty") return measure(b.expanded_uncertainty);
    if (w == "low") return point(b.estimate - b.expanded_uncertainty);
    if (w == "high") return point(b.estimate + b.expanded_uncertainty);
    if (w == "coverage_factor") return plain(b.coverage_factor);
    if (w == "second_order_uncertainty") return measure(b.second_order_uncertainty);
    if (w == "second_order_bias") return measure(b.second_order_bias);
    if (w == "degrees_of_freedom") {
      if (std::isnan(b.effective_degrees_of_freedom)) return word("refused");
      if (b.effective_degrees_of_freedom == 0) return word("infinite");
      return plain(b.effective_degrees_of_freedom);
    }
    for (const Contribution& c : b.contributions) {
      if (c.name != argument(0)) continue;
      if (w == "contribution") return measure(c.contribution);
      if (w == "sensitivity") return plain(c.sensitivity);
    }
    return std::nullopt;
  }

  std::optional<Figure> validation() {
    const Validation& v = r_.validations[o_];
    if (name_.word == "validation.verdict") return word(v.verdict);
    const double se = 0.5 * v.monte_carlo_tolerance; // it is two standard errors of the worse end
    if (name_.word == "validation.d_low") return measure(v.d_low, se);
    if (name_.word == "validation.d_high") return measure(v.d_high, se);
    if (name_.word == "validation.delta") return measure(v.delta);
    return std::nullopt;
  }

  std::optional<Figure> index(const std::vector<Index>& rows) const {
    for (const Index& i : rows)
      if (i.input == argument(0)) return plain(i.value, half_width(i.low, i.high));
    return std::nullopt;
  }

  std::optional<Figure> sensitivity() {
    if (const auto s = mine(r_.sensitivities); s != r_.sensitivities.end()) {
      for (const SobolIndex& i : s->indices) {
        if (i.input != argument(0)) continue;
        if (name_.word == "first") return plain(i.first, half_width(i.first_low, i.first_high));
        if (name_.word == "total") return plain(i.total, half_width(i.total_low, i.total_high));
      }
      for (const SobolPair& p : s->pairs)
        if (name_.word == "second" &&
            ((p.a == argument(0) && p.b == argument(1)) || (p.b == argument(0) && p.a == argument(1))))
          return plain(p.second, half_width(p.low, p.high));
    }
    if (const auto s = mine(r_.shapley); s != r_.shapley.end() && name_.word == "shapley") return index(s->effects);
    if (const auto s = mine(r_.given_data); s != r_.given_data.end()) {
      if (name_.word == "rank_first") return index(s->first);
      if (name_.word == "delta") return index(s->delta);
    }
    if (const auto s = mine(r_.dgsm); s != r_.dgsm.end() && name_.word == "dgsm_bound")
      for (const DgsmRow& row : s->rows)
        if (row.input == argument(0)) return plain(row.bound, half_width(row.bound_low, row.bound_high));
    return std::nullopt;
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
      if (name_.word == "joint.k_p") return plain(g.k_p, g.k_p_se);
      if (name_.word == "joint.k_q") return plain(g.k_q, g.k_q_se);
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

  std::optional<Figure> circular() {
    const auto s = mine(r_.circular);
    if (s == r_.circular.end()) return std::nullopt;
    if (name_.word == "circular.mean_direction") return measure(s->mean_direction, s->mean_direction_se);
    if (name_.word == "circular.standard_deviation") return measure(s->standard_deviation, s->standard_deviation_se);
    if (name_.word == "circular.resultant_length") return plain(s->resultant_length, s->resultant_length_se);
    return std::nullopt;
  }

  std::optional<Figure> conformity() {
    const auto s = mine(r_.conformity);
    if (s == r_.conformity.end()) return std::nullopt;
    const double se = s->conformance_probability_se;
    if (name_.word == "conformity.probability") return plain(s->conformance_probability, se);
    if (name_.word == "conformity.decision") return word(s->accepted ? "accepted" : "rejected");
    const std::pair<const char*, double ConformityResult::*> risks[] = {
        {"conformity.specific_consumer_risk", &ConformityResult::specific_consumer_risk},
        {"conformity.specific_producer_risk", &ConformityResult::specific_producer_risk},
        {"conformity.global_consumer_risk", &ConformityResult::global_consumer_risk},
        {"conformity.global_producer_risk", &ConformityResult::global_producer_risk}};
    for (const auto& [risk, member] : risks) {
      const double p = (*s).*member;
      if (name_.word == risk) return plain(p, std::sqrt(p * (1 - p) / static_cast<double>(r_.samples)));
    }
    return std::nullopt;
  }

  std::optional<Figure> target() {
    const auto s = mine(r_.targets);
    if (s == r_.targets.end()) return std::nullopt;
    for (const TargetRow& row : s->rows) {
      if (row.quantity != argument(0)) continue;
      const Figure of_quantity{0, 0, row.unit, row.si_unit, true, ""};
      const std::pair<const char*, double TargetRow::*> members[] = {{"target.allowed", &TargetRow::allowed},
                                                                     {"target.allowed_gum", &TargetRow::allowed_gum},
                                                                     {"target.cheapest", &TargetRow::cheapest}};
      for (const auto& [name, member] : members)
        if (name_.word == name) {
          Figure f = of_quantity;
          f.value = row.*member;
          return f;
        }
    }
    return std::nullopt;
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
