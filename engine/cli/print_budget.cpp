#include "cli/print_budget.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "analysis/fields_json.h"
#include "analysis/gum.h"
#include "analysis/result_fields.h"
#include "analysis/rounding.h"
#include "analysis/validation.h"
#include "base/units.h"

namespace gumshoe::cli {
using namespace analysis;

namespace {

/// All components of one quantity.
struct Part {
  std::string name, quantity;
  double variance = 0, share = 0;
  std::size_t components = 0;
};

/// By quantity, the largest share of the law of propagation first; shares that are not known are left out.
std::vector<Part> parts(const Budget& b) {
  std::vector<Part> all;
  for (const Contribution& c : b.contributions) {
    if (!std::isfinite(c.share) || c.share == 0) continue;
    const auto known = std::ranges::find(all, c.quantity, &Part::quantity);
    Part& part = known != all.end() ? *known : all.emplace_back(Part{c.name, c.quantity});
    if (++part.components > 1) part.name = c.quantity;
    part.variance += c.contribution * c.contribution;
    part.share += c.share;
  }
  std::ranges::stable_sort(all, [](const Part& x, const Part& y) { return x.share > y.share; });
  return all;
}

/// The same of Sobol' indices, which may be those of components or of whole quantities.
std::vector<Part> parts(const Budget& b, const std::vector<SobolIndex>& indices) {
  std::vector<Part> all;
  for (const SobolIndex& index : indices) {
    if (!std::isfinite(index.first) || index.first == 0) continue;
    const auto c = std::ranges::find(b.contributions, index.input, &Contribution::name);
    const std::string quantity = c == b.contributions.end() ? index.input : c->quantity;
    const auto known = std::ranges::find(all, quantity, &Part::quantity);
    Part& part = known != all.end() ? *known : all.emplace_back(Part{index.input, quantity});
    if (++part.components > 1) part.name = quantity;
    part.share += index.first;
  }
  std::ranges::stable_sort(all, [](const Part& x, const Part& y) { return x.share > y.share; });
  return all;
}

std::string percent(double share) {
  constexpr double rounding = 1e-9;
  if (share == 0) return "0 %";
  if (std::fabs(share - 1) < rounding) return "100 %"; // there is no other
  if (std::fabs(share) >= 0.005) return analysis::share_text(share);
  return std::fabs(share) < 5e-5 ? "< 0.01 %" : fmt::format("{:.1g} %", 100 * share);
}

/// Rows of cells as columns of equal width; the first cell of a row is flush left.
void print_columns(const std::vector<std::vector<std::string>>& rows, std::ostream& out) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (widths.size() <= i) widths.push_back(0);
      widths[i] = std::max(widths[i], row[i].size());
    }
  for (const auto& row : rows) {
    std::string line = "  ";
    for (std::size_t i = 0; i < row.size(); ++i)
      line += i == 0 ? fmt::format("{:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    out << line << '\n';
  }
}

std::string width_text(double x, const propagation::Output& o) { return with_suitable_unit(x, o.unit, o.si_unit); }

std::string number_text(double x) { return std::isfinite(x) ? fmt::format("{:.4g}", x) : "-"; }

/// An estimate by as many digits as its standard uncertainty leaves, eight at least.
std::string estimate_text(double x, double u) {
  constexpr int least = 8, most = 17;
  const bool told = u > 0 && std::isfinite(u) && x != 0;
  const int digits = told ? static_cast<int>(std::ceil(std::log10(std::fabs(x) / u))) + 2 : least;
  return fmt::format("{:.{}g}", x, std::clamp(digits, least, most));
}

/// `shares`: whether contributions are shares of the variance.
std::vector<std::string> cells(const Contribution& c, const propagation::Output& output, bool shares) {
  const RowUnit row{c.unit, c.si_unit}, out{output.unit, output.si_unit};
  return {c.name,
          estimate_text(converted(c.estimate, In::point, row), converted(c.standard_uncertainty, In::difference, row)) +
              units::suffix(c.unit),
          std::isfinite(c.standard_uncertainty) ? with_suitable_unit(c.standard_uncertainty, c.unit, c.si_unit) : "-",
          std::string(1, c.evaluation),
          c.distribution,
          std::isfinite(c.degrees_of_freedom) ? fmt::format("{:.4g}", c.degrees_of_freedom) : "inf",
          number_text(converted(c.sensitivity, In::coefficient, row, out)) + units::suffix(coefficient_unit(row, out)),
          std::isfinite(c.contribution) ? with_suitable_unit(c.contribution, output.unit, output.si_unit) : "-",
          !shares                              ? "-"
          : std::isfinite(c.share)             ? percent(c.share)
          : std::isfinite(c.monte_carlo_share) ? percent(c.monte_carlo_share)
                                               : "-"};
}

} // namespace

std::string largest_contributions(const Budget& b, const Summary& s, const Validation& v,
                                  const std::vector<SobolIndex>& indices) {
  constexpr std::size_t most = 3;
  const bool law = b.applicable && (v.verdict == "validated" || accounts_for_variance(b, s));
  const bool monte_carlo = !law && (!b.applicable || !indices.empty());
  std::vector<Part> all = monte_carlo ? parts(b, indices) : parts(b);
  const std::size_t total = all.size();
  // What is shown as less than 0.01 % is none of the largest.
  const bool some = std::ranges::any_of(all, [](const Part& p) { return p.share >= 1e-4; });
  if (some) std::erase_if(all, [](const Part& p) { return p.share < 1e-4; });
  if (all.empty() && !monte_carlo && any_uncertain(b))
    return "largest contributions: none to first order, because every sensitivity coefficient is zero at the estimates";
  if (all.empty())
    return b.contributions.empty() || !monte_carlo
               ? "no input is uncertain"
               : "largest contributions: the GUM framework gives none here; set sensitivity = { "
                 "sobol = 65536 } in [analysis], or { shapley = 4096 } for correlated inputs";
  const bool cancel = !monte_carlo && contributions_cancel(b);
  std::string text = "largest contributions";
  if (monte_carlo) text += " (first-order Sobol' indices)";
  if (!law && !monte_carlo)
    text += fmt::format(" to first order only (u_c = {}; Monte Carlo gives u = {})",
                        width_text(b.combined_standard_uncertainty, b.output),
                        width_text(s.standard_uncertainty, b.output));
  text += ": ";
  for (std::size_t i = 0; i < std::min(most, all.size()); ++i)
    text +=
        (i == 0 ? "" : ", ") + all[i].name + ' ' +
        (monte_carlo ? percent(all[i].share)
         : cancel    ? width_text(std::sqrt(all[i].variance), b.output)
                     : fmt::format("{} ({})", width_text(std::sqrt(all[i].variance), b.output), percent(all[i].share)));
  if (!monte_carlo && !cancel && std::fabs(b.correlation_share) >= 0.005)
    text += fmt::format(", correlations {}", percent(b.correlation_share));
  const std::size_t shown = std::min(most, all.size());
  if (total > shown) text += fmt::format("; {} more", total - shown);
  if (cancel)
    text += fmt::format("; the inputs are correlated, and their contributions of {} cancel to u_c = {}, so that they "
                        "are no shares of the variance",
                        width_text(uncorrelated_uncertainty(b), b.output),
                        width_text(b.combined_standard_uncertainty, b.output));
  if (!law && !monte_carlo)
    text += fmt::format("; set sensitivity = {{ {} }} in [analysis] for shares of the variance",
                        b.correlation_share == 0 ? "sobol = 65536" : "shapley = 4096");
  return text;
}

void print_budget(const Budget& b, std::ostream& out) {
  const auto width = [&](double x) { return width_text(x, b.output); };
  out << "  uncertainty budget of " << b.output.name
      << (b.applicable ? "" : " (GUM framework not applicable: " + b.reason + ")") << '\n';
  std::vector<std::vector<std::string>> rows{
      {"component", "estimate", "u", "type", "distribution", "nu", "c", "|c| u", b.applicable ? "share" : "Sobol'"}};
  const bool cancel = contributions_cancel(b);
  for (const Contribution& c : b.contributions) rows.push_back(cells(c, b.output, !cancel));
  const auto closing = [&](const std::string& name, const std::string& value, const std::string& share) {
    rows.push_back({name, "", "", "", "", "", "", value, share});
  };
  if (b.applicable) {
    if (cancel) closing("without correlations", width(uncorrelated_uncertainty(b)), "");
    if (b.correlation_share != 0 && !cancel) closing("correlations", "", percent(b.correlation_share));
    closing("combined standard uncertainty", width(b.combined_standard_uncertainty), "");
    closing("effective degrees of freedom",
            std::isfinite(b.effective_degrees_of_freedom) ? fmt::format("{:.0f}", b.effective_degrees_of_freedom)
            : std::isnan(b.effective_degrees_of_freedom)  ? "-"
                                                          : "inf",
            "");
    closing("coverage factor", fmt::format("{:.2f}", b.coverage_factor), "");
    closing("expanded uncertainty", width(b.expanded_uncertainty), "");
  }
  print_columns(rows, out);
  if (cancel) out << "  no shares: the inputs are correlated, and their contributions cancel\n";
  if (!b.remark.empty()) out << "  " << b.remark << '\n';
}

} // namespace gumshoe::cli
