#include "calibration/combined_scenario.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/units.h"
#include "base/version.h"
#include "calibration/scenario_text.h"
#include "scenario/write.h"

namespace gumshoe::calibration {
namespace {

using analysis::SharedPart;
using analysis::WeightedMean;
using scenario::Node;

Node whole_number_node(std::int64_t value) {
  Node out;
  out.kind = Node::Kind::integer;
  out.integer = value;
  return out;
}

class CombinedScenario {
public:
  CombinedScenario(const WeightedMean& mean, const std::vector<analysis::NamedResult>& results)
      : mean_(mean), results_(results), measurand_(symbol(mean.mean.output.name)) {
    for (std::size_t i = 0; i < mean.parts.size(); ++i)
      parts_.push_back(symbol(fmt::format("{}_{}", measurand_, i + 1)));
    for (const SharedPart& s : mean.shared) shared_.push_back(symbol(s.name));
    if (mean.weighing > 0) weighing_ = symbol("weights");
  }

  std::string text() const {
    Node document;
    member(document, "schema") = whole_number_node(1);
    member(document, "title") =
        text_node(fmt::format("{}, weighted mean of {} results", mean_.mean.output.name, parts_.size()));
    Node& model = member(document, "model");
    member(model, "name") = text_node("expression");
    Node& measurand = member(member(model, "measurands"), measurand_);
    member(measurand, "formula") = text_node(formula());
    member(measurand, "unit") = text_node(mean_.mean.output.unit);
    Node& quantities = member(document, "quantities");
    for (std::size_t i = 0; i < parts_.size(); ++i) describe_part(i, member(quantities, parts_[i]));
    for (std::size_t k = 0; k < shared_.size(); ++k) describe_shared(mean_.shared[k], member(quantities, shared_[k]));
    if (!weighing_.empty()) describe_weighing(member(quantities, weighing_));
    member(member(document, "run"), "samples") = whole_number_node(1'000'000);
    member(member(document, "analysis"), "coverage_probability") =
        number_node(results_[0].results.coverage_probability);
    return fmt::format("# Question: what is {}, from {} results that share {}?\n# Written by gumshoe {} combine.\n{}",
                       mean_.mean.output.name, parts_.size(),
                       shared_.empty() ? "nothing" : fmt::format("{}", fmt::join(shared_, ", ")), version,
                       scenario::to_toml(document));
  }

private:
  /// "laser_z[rod 1]" as a new name in formulas: "laser_z_rod_1".
  std::string symbol(const std::string& name) {
    std::string out;
    for (const char c : name) {
      const bool plain = std::isalnum(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) >= 0x80;
      if (plain)
        out += c;
      else if (!out.empty() && out.back() != '_')
        out += '_';
    }
    while (out.ends_with('_')) out.pop_back();
    if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0]))) out = "y_" + out;
    while (!used_.insert(out).second) out += "_shared";
    return out;
  }

  /// Contribution of the first result that has the component: the size in which the others are stated.
  static double size_of(const SharedPart& s) {
    return *std::ranges::find_if(s.contributions, [](double c) { return c != 0; });
  }

  static std::string signed_term(double factor, const std::string& term) {
    return fmt::format(" {} {}{}", factor < 0 ? '-' : '+',
                       std::fabs(factor) == 1 ? "" : fmt::format("{} * ", std::fabs(factor)), term);
  }

  /// "0.4 * (y_1 + reference) + 0.6 * (y_2 - 1.5 * reference)".
  std::string formula() const {
    std::string out;
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      std::string result = parts_[i];
      for (std::size_t k = 0; k < shared_.size(); ++k)
        if (const double c = mean_.shared[k].contributions[i]; c != 0)
          result += signed_term(c / size_of(mean_.shared[k]), shared_[k]);
      const double weight = mean_.parts[i].weight;
      out += i == 0 ? fmt::format("{} * ({})", weight, result)
                    : fmt::format(" {} {} * ({})", weight < 0 ? '-' : '+', std::fabs(weight), result);
    }
    return weighing_.empty() ? out : out + " + " + weighing_;
  }

  void describe_spread(Node& quantity, double u, double degrees_of_freedom) const {
    const auto& output = mean_.mean.output;
    if (!(u > 0)) return;
    member(quantity, "u") = measure_node(u, output.unit, output.si_unit, true);
    if (std::isfinite(degrees_of_freedom)) member(quantity, "degrees_of_freedom") = number_node(degrees_of_freedom);
  }

  void describe_part(std::size_t i, Node& quantity) const {
    const auto& part = mean_.parts[i];
    const auto& output = mean_.mean.output;
    member(quantity, "value") = measure_node(part.summary.estimate, output.unit, output.si_unit, false);
    describe_spread(quantity, part.own, part.own_degrees_of_freedom);
    member(quantity, "source") =
        text_node(fmt::format("{}{}", results_[part.result].name, shared_.empty() ? "" : ", without what it shares"));
  }

  /// An error is a difference: "0 degC" would be a point.
  void describe_error(Node& quantity) const {
    const auto& output = mean_.mean.output;
    member(quantity, "value") =
        measure_node(0, units::difference_unit(output.unit, output.si_unit), output.si_unit, true);
  }

  void describe_weighing(Node& quantity) const {
    describe_error(quantity);
    describe_spread(quantity, mean_.weighing, mean_.weighing_degrees_of_freedom);
    member(quantity, "source") = text_node("the weights come from estimated uncertainties (Meier 1953)");
  }

  void describe_shared(const SharedPart& s, Node& quantity) const {
    describe_error(quantity);
    describe_spread(quantity, std::fabs(size_of(s)), s.degrees_of_freedom);
    std::vector<std::string> files;
    for (std::size_t i = 0; i < parts_.size(); ++i)
      if (s.contributions[i] != 0) files.push_back(results_[mean_.parts[i].result].name);
    member(quantity, "source") = text_node(fmt::format("contribution of {} to {}", s.name, fmt::join(files, ", ")));
  }

  const WeightedMean& mean_;
  const std::vector<analysis::NamedResult>& results_;
  std::set<std::string> used_;
  std::string measurand_;
  std::vector<std::string> parts_, shared_;
  std::string weighing_; ///< empty: the weights are known
};

} // namespace

std::string combined_scenario(const WeightedMean& mean, const std::vector<analysis::NamedResult>& results) {
  return CombinedScenario(mean, results).text();
}

} // namespace gumshoe::calibration
