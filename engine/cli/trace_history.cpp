#include "cli/trace_history.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "analysis/rounding.h"
#include "base/hash.h"
#include "base/units.h"
#include "cli/command.h"

namespace gumshoe::cli {
namespace {

constexpr std::size_t most_effects = 5; ///< effects that the text lists; the file has all

double shown(double si, const tracing::ScoredSize& s) {
  return units::from_si(si, s.unit, s.si_unit, units::Kind::difference);
}

using Rows = std::vector<std::vector<double>>;

/// What was read, and under which conditions.
Rows rows_of(const std::vector<quantities::Reading>& readings) {
  Rows rows;
  for (const auto& r : readings) {
    rows.push_back(r.indications);
    rows.back().insert(rows.back().end(), r.conditions.begin(), r.conditions.end());
  }
  return rows;
}

std::string id_of(const Rows& rows) {
  std::vector<double> values;
  for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
  return fmt::format("{:016x}", digest64(values.data(), values.size()));
}

/// The same readings in any order are the same readings.
std::string id_in_any_order(Rows rows) {
  std::ranges::sort(rows);
  return id_of(rows);
}

/// A digest of each reading that a double holds.
std::vector<double> digests(const Rows& rows) {
  std::vector<double> out;
  for (const auto& row : rows) out.push_back(static_cast<double>(digest64(row.data(), row.size()) >> 12));
  return out;
}

/// The most readings that follow each other alike in both, if they are ten different ones or more.
std::size_t common_run(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr std::size_t different = 10;
  std::vector<std::size_t> run(b.size() + 1, 0);
  std::size_t longest = 0, end = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = b.size(); j > 0; --j) { // backwards: run[j - 1] is of the reading before
      run[j] = a[i] == b[j - 1] ? run[j - 1] + 1 : 0;
      if (run[j] > longest) longest = run[j], end = i + 1;
    }
  const auto last = a.begin() + static_cast<std::ptrdiff_t>(end);
  return std::set(last - static_cast<std::ptrdiff_t>(longest), last).size() < different ? 0 : longest;
}

/// What a model that a scenario describes says of itself, one in a line: two such models may share a name.
std::string equations_of(const scenario::Scenario& s, const ModelCard& card) {
  if (!s.made) return {};
  std::string out = s.external.empty() ? "" : std::string(card.title) + '\n'; // a command's words, a plugin's title
  for (const EvaluationCard& e : card.evaluations)
    for (const EquationCard& equation : e.equations) {
      std::string text(equation.text);
      std::ranges::replace(text, '\n', ' ');
      out += text + '\n';
    }
  for (const AxisCard& axis : card.axes)
    out += fmt::format("axis {} of the {}: {} {}\n", axis.name, axis.carries_workpiece ? "workpiece" : "tool",
                       axis.rotary ? "turns about" : "moves along", "XYZ"[axis.direction]);
  return out;
}

/// The lines of a text, by what stands in them apart from spaces.
std::map<std::string, std::string> lines_of(const std::string& text) {
  std::map<std::string, std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    std::string bare = line;
    std::erase_if(bare, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    lines[bare] = line;
  }
  return lines;
}

/// The first line of `text` that is not in `other`; empty if there is none.
std::string first_missing(const std::string& text, const std::string& other) {
  const auto known = lines_of(other);
  for (const auto& [bare, line] : lines_of(text))
    if (!known.contains(bare)) return line;
  return {};
}

/// "430", "2.1e+05", "0.02"; "1e-300" or "1e+300" of what is smaller or larger.
std::string odds(double log_evidence) {
  constexpr double most = 300 * std::numbers::ln10;
  return (log_evidence < -most  ? "less than "
          : log_evidence > most ? "more than "
                                : "") +
         fmt::format("{:.2g}", std::exp(std::clamp(log_evidence, -most, most)));
}

std::string sizes_of(const tracing::EffectEvidence& e, const tracing::Vector& size,
                     const tracing::Vector& uncertainty) {
  std::string out;
  for (std::size_t i = 0; i < e.sizes.size() && uncertainty.size() > 0; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const double u = shown(uncertainty[k], e.sizes[i]);
    const int d = analysis::decimals_for(u);
    out += fmt::format("{}{} {}, u {}{}", i == 0 ? "" : "; ", e.sizes[i].name,
                       analysis::fixed(shown(size[k], e.sizes[i]), d), analysis::fixed(u, d),
                       units::suffix(e.sizes[i].unit));
  }
  return out;
}

constexpr double disagree = 1e-3; ///< probability below which campaigns are not of one size
constexpr double least_p = 1e-6;

/// "1.6e+49 to 1 for axis_reversal: shown; axis_reversal.backlash 1.97, u 0.04 um".
std::string line(const tracing::EffectEvidence& e, double alpha) {
  const double wanted = -std::log(alpha);
  const bool was_shown = e.log_peak >= wanted, is_shown = e.log_evidence >= wanted;
  std::string out = fmt::format("  {} to 1 for {}", odds(e.log_evidence), e.candidate);
  if (is_shown) out += ": shown";
  if (was_shown && !is_shown)
    out += fmt::format(": it was shown after campaign {} ({} to 1)", e.peak, odds(e.log_peak));
  if (was_shown && e.agreement < disagree)
    return out + fmt::format("; the campaigns disagree about its size (p {}{}), the last says {}\n",
                             e.agreement < least_p ? "" : "= ", analysis::probability_text(e.agreement, least_p),
                             sizes_of(e, e.last, e.last_u));
  return out + (e.log_evidence >= 0 ? "; " + sizes_of(e, e.size, e.u) : "") + '\n';
}

} // namespace

History::History(const std::string& path, const scenario::Scenario& s, const ModelCard& card)
    : path_(path), id_(id_in_any_order(rows_of(s.readings))), rows_(digests(rows_of(s.readings))), model_(s.model),
      model_title_(card.title), model_equations_(equations_of(s, card)) {
  if (path.empty()) return;
  claim_ = store::Claim(path);
  campaigns_ = store::read_history(claim_.target());
  require_same_model();
  const std::string in_order = id_of(rows_of(s.readings)); // as histories of earlier versions have it
  if (std::ranges::any_of(campaigns_, [&](const tracing::Campaign& c) { return c.id == id_ || c.id == in_order; }))
    throw InputError(path + ": it holds these readings already", "evidence that is counted twice is no evidence",
                     "append each campaign once");
  constexpr std::size_t by_chance = 30; // readings that follow each other alike in two campaigns, and no more
  for (std::size_t k = 0; k < campaigns_.size(); ++k)
    if (const std::size_t run = common_run(rows_, campaigns_[k].rows);
        run > by_chance || (run > 0 && run == std::min(rows_.size(), campaigns_[k].rows.size())))
      throw InputError(
          fmt::format("{}: it holds {} of these {} readings already, of campaign {}", path, run, rows_.size(), k + 1),
          "evidence that is counted twice is no evidence", "leave out the readings that it holds");
}

void History::require_same_model() const {
  const auto refuse = [&](const std::string& there, const std::string& here) {
    throw InputError(path_ + ": it is the history of another model", fmt::format("{}; here it is {}", there, here),
                     "append to a history of its own");
  };
  const auto in_words = [](const std::string& model, const std::string& what) {
    return fmt::format("{}, {}", model, what.empty() ? "without a counterpart" : "'" + what + "'");
  };
  for (const tracing::Campaign& c : campaigns_) {
    if (c.model.empty()) continue;
    if (c.model != model_) refuse(in_words(c.model, c.model_title), in_words(model_, model_title_));
    const std::string there = first_missing(c.model_equations, model_equations_),
                      here = first_missing(model_equations_, c.model_equations);
    if (!c.model_equations.empty() && !(there.empty() && here.empty()))
      refuse(in_words(c.model, there), in_words(model_, here));
  }
}

void History::append(const tracing::Trace& trace, store::Draft& draft) {
  if (trace.campaign.readings == 0) return;
  campaigns_.push_back(trace.campaign);
  campaigns_.back().id = id_;
  campaigns_.back().rows = rows_;
  campaigns_.back().model = model_;
  campaigns_.back().model_title = model_title_;
  campaigns_.back().model_equations = model_equations_;
  campaigns_.back().date = date_text(std::time(nullptr));
  evidence_ = tracing::evidence_over_time(campaigns_);
  store::write_history(draft, claim_, campaigns_, evidence_);
}

std::string History::text(double alpha) const {
  if (evidence_.campaigns == 0) return "nothing is appended, because these data cannot decide\n";
  if (evidence_.effects.empty())
    return fmt::format("{} has {} campaign{}, but no evidence: the first shows no effect of the catalogue, and none is "
                       "stated ([stated_effects])\n",
                       path_, evidence_.campaigns, evidence_.campaigns == 1 ? "" : "s");
  std::string out =
      fmt::format("evidence over {} campaign{} in {}, valid whenever one looks, the search for {} effect{} allowed for "
                  "(shown at {:.0f} to 1); sizes as if each effect were the only one:\n",
                  evidence_.campaigns, evidence_.campaigns == 1 ? "" : "s", path_, evidence_.effects.size(),
                  evidence_.effects.size() == 1 ? "" : "s", 1 / alpha);
  for (std::size_t i = 0; i < evidence_.effects.size(); ++i) // what was shown before is not left out
    if (i < most_effects || evidence_.effects[i].log_peak >= -std::log(alpha)) out += line(evidence_.effects[i], alpha);
  return out + fmt::format("  {} to 1 for any of them\n", odds(evidence_.log_overall));
}

nlohmann::ordered_json History::json() const {
  nlohmann::ordered_json effects = nlohmann::ordered_json::array();
  for (const auto& e : evidence_.effects) {
    nlohmann::ordered_json sizes = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < e.sizes.size() && e.u.size() > 0; ++i)
      sizes.push_back({{"name", e.sizes[i].name},
                       {"value", shown(e.size[static_cast<Eigen::Index>(i)], e.sizes[i])},
                       {"u", shown(e.u[static_cast<Eigen::Index>(i)], e.sizes[i])},
                       {"last", shown(e.last[static_cast<Eigen::Index>(i)], e.sizes[i])},
                       {"last_u", shown(e.last_u[static_cast<Eigen::Index>(i)], e.sizes[i])},
                       {"unit", e.sizes[i].unit}});
    effects.push_back({{"name", e.candidate},
                       {"log10_evidence", e.log_evidence / std::log(10)},
                       {"log10_peak", e.log_peak / std::log(10)},
                       {"peak", e.peak},
                       {"agreement", e.agreement},
                       {"campaigns", e.campaigns},
                       {"quantities", sizes}});
  }
  return {{"file", path_},
          {"campaigns", evidence_.campaigns},
          {"log10_overall", evidence_.log_overall / std::log(10)},
          {"effects", effects}};
}

} // namespace gumshoe::cli
