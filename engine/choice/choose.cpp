#include "choice/choose.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "analysis/rounding.h"
#include "analysis/shapley.h"
#include "analysis/sobol.h"
#include "base/units.h"
#include "choice/candidates.h"
#include "choice/figures.h"
#include "choice/setup.h"

namespace gumshoe::choice {

namespace {

using scenario::Knob;
using scenario::Setting;
constexpr std::size_t most_tried = 20;

class Chooser {
public:
  Chooser(const scenario::Scenario& s, const Settings& settings)
      : s_(s), choose_(*s.choose), settings_(settings), search_(s, settings) {}

  Result run() {
    search_.run(choose_.target);
    const auto meeting = search_.meeting(choose_.target);
    const auto least = search_.least();
    r_.reached = !meeting.empty();
    if (meeting.empty() && !least)
      throw InputError("choose: every candidate fails",
                       fmt::format("more than max_failed_share = {} of its samples{}", s_.run.max_failed_share,
                                   choose_.worst_case ? ", or of those of a case" : ""),
                       "gumshoe run of the scenario, with the values of one candidate, says of each sample why");
    if (r_.reached) {
      confirm(meeting);
    } else { // fresh numbers may know better than the few of the search
      take(*least, afresh(*least));
      r_.reached = r_.confirmed = r_.probability >= choose_.confirm_probability;
    }
    if (r_.confirmed) seek_faster();
    r_.neighbours = search_.neighbours(r_.best);
    search_.mark_pareto();
    near();
    describe();
    budget();
    compare();
    state();
    return std::move(r_);
  }

private:
  const Figures& asked(const Candidate& c) const { return choice::asked(c, choose_.worst_case); }

  void report(const char* what) const {
    if (settings_.progress) settings_.progress(what);
  }

  Candidate afresh(const Setup& setup, Candidate c) {
    report("fresh run");
    c.time = setup.seconds();
    c.readings = setup.experiment().scenario().readings.size();
    const Errors e = errors({&setup}, choose_.confirm_samples, quantities::Purpose::fresh, settings_.workers.threads);
    return search_.judged(std::move(c), figures_of(s_, e[0]));
  }
  Candidate afresh(std::size_t candidate) {
    ++r_.tried;
    const Candidate& c = search_.candidates()[candidate];
    return afresh(Setup(s_, search_.settings_of(c.values)), c);
  }

  /// That U, and the bias, truly lie within what is asked for.
  double probability(const Candidate& c) const {
    double p = probability_below(asked(c).expanded, asked(c).expanded_se, choose_.target);
    const auto within = [&](double bias, double se) {
      p = std::min(p, probability_below(std::fabs(bias), se, *choose_.bias));
    };
    if (choose_.bias) within(c.average.mean, c.average.mean_se);
    for (const Figures& f : c.cases)
      if (choose_.bias && choose_.worst_case) within(f.left, f.mean_se);
    return p;
  }

  void take(std::size_t candidate, Candidate fresh) {
    r_.best = candidate;
    r_.fresh = std::move(fresh);
    r_.probability = probability(r_.fresh);
  }

  /// The numbers that chose a candidate flatter it: fresh ones decide.
  void confirm(const std::vector<std::size_t>& meeting) {
    for (const std::size_t i : meeting) {
      if (is_refuted(i)) continue;
      Candidate fresh = afresh(i);
      const double p = probability(fresh);
      r_.confirmed = p >= choose_.confirm_probability;
      if (probability_below(asked(fresh).expanded, asked(fresh).expanded_se, choose_.target) <
          choose_.confirm_probability)
        failed_ = asked(search_.candidates()[i]).expanded; // and not the bias alone
      if (!r_.confirmed) refuted_.insert(i);
      if (r_.tried == 1 || p > r_.probability) take(i, std::move(fresh));
      if (r_.confirmed || r_.tried == most_tried) return;
    }
  }

  /// The search may have dismissed a faster one by chance. Candidates of one combination of the lists have their
  /// numbers in common: what fresh ones tell of one, by how much the search is off, holds for all of these.
  void seek_faster() {
    constexpr int rounds = 3;
    for (int round = 0; round < rounds; ++round) {
      const Figures &rough = asked(search_.candidates()[r_.best]), &fine = asked(r_.fresh);
      if (!(rough.expanded > 0) || !(fine.expanded > 0)) return;
      const double sure = 1 - 2 * fine.expanded_se / fine.expanded;
      const double target = choose_.target * rough.expanded / fine.expanded * sure;
      search_.run(target);
      try_faster(search_.meeting(target));
      if (!try_faster(search_.hopeful(r_.fresh.time))) return;
    }
  }

  /// The first few that take less time and were not tried. @return whether one is taken
  bool try_faster(const std::vector<std::size_t>& candidates) {
    constexpr int most = 3;
    int tried = 0;
    for (const std::size_t i : candidates) {
      if (tried == most) return false;
      if (search_.candidates()[i].time >= r_.fresh.time || refuted_.contains(i) || !faster_tried_.insert(i).second)
        continue;
      ++tried;
      Candidate fresh = afresh(i);
      if (probability(fresh) >= choose_.confirm_probability) {
        take(i, std::move(fresh));
        return true;
      }
      if (search_.candidates()[i].meets) refuted_.insert(i);
    }
    return false;
  }

  /// Whether a candidate failed with fresh numbers, or would: with common numbers one of a U as large as one that
  /// failed.
  bool is_refuted(std::size_t candidate) const {
    const Candidate& c = search_.candidates()[candidate];
    return refuted_.contains(candidate) || (c.meets && asked(c).expanded >= failed_);
  }

  void near() {
    const auto& all = search_.candidates();
    r_.near.resize(choose_.variables.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      const Candidate& c = all[i];
      if (i != r_.best && (!c.meets || is_refuted(i) || c.time > (1 + choose_.near) * all[r_.best].time)) continue;
      for (std::size_t v = 0; v < r_.near.size(); ++v) {
        Span& span = r_.near[v];
        span.low = r_.near_count == 0 ? c.values[v] : std::min(span.low, c.values[v]);
        span.high = r_.near_count == 0 ? c.values[v] : std::max(span.high, c.values[v]);
      }
      ++r_.near_count;
    }
  }

  void describe() {
    r_.asked = choose_;
    r_.title = s_.title;
    r_.scenario_file = s_.file;
    r_.scenario_hash = s_.hash;
    r_.coverage_probability = s_.analysis.coverage_probability;
    r_.seed = s_.run.seed;
    r_.candidates = search_.candidates();
    for (std::size_t i = 0; i < r_.candidates.size(); ++i) r_.candidates[i].refuted = is_refuted(i);
    r_.skipped = search_.skipped();
    r_.skipped_why = search_.skipped_why();
    r_.resolution = search_.resolution();
    r_.notes = scenario::notes_of_a_run(s_);
    if (s_.run.design != scenario::Design::monte_carlo)
      r_.notes.push_back(fmt::format("design {} is not used here, because standard errors need independent samples",
                                     name(s_.run.design)));
  }

  void budget() {
    scenario::Scenario s = s_;
    s.analysis.sensitivity.second_order = false;
    const Setup setup(s, search_.settings_of(r_.candidates[r_.best].values));
    const propagation::Experiment& e = setup.experiment();
    const auto& output = e.outputs()[setup.output()];
    r_.unit = choose_.unit;
    r_.si_unit = output.si_unit;
    for (const EvaluationCard& card : e.model().card->evaluations) r_.evaluations.emplace_back(card.name);
    if (choose_.sobol == 0 || e.plan().variates.empty()) return;
    report("budget at the optimum");
    if (e.plan().copulas.empty())
      r_.sensitivity = analysis::sobol_indices(e, choose_.sobol, settings_.workers.threads).at(setup.output());
    else
      r_.shapley = analysis::shapley_effects(e, choose_.sobol, settings_.workers.threads).at(setup.output());
  }

  void compare() {
    for (const scenario::ChooseCompare& c : choose_.compare) {
      try {
        const Setup setup(s_, c.settings);
        Compared one{c.name, c.source, in_words(c.settings, r_.evaluations), afresh(setup, {}), 0};
        one.probability = probability(one.candidate);
        r_.compared.push_back(std::move(one));
      } catch (const InputError& error) {
        auto problems = error.problems();
        for (Problem& p : problems) p.what = fmt::format("choose.compare '{}': {}", c.name, p.what);
        throw InputError(problems);
      }
    }
  }

  void state() {
    const auto shown = [&](double x) { return units::from_si(x, r_.unit, r_.si_unit, units::Kind::difference); };
    const std::string unit = units::suffix(r_.unit);
    const Figures& f = asked(r_.fresh);
    const int d = analysis::decimals_for(shown(f.expanded));
    const auto width = [&](double x) { return analysis::fixed(shown(x), d) + unit; };
    const std::string bias =
        choose_.bias ? fmt::format(" with a bias of at most {:.6g}{}", shown(*choose_.bias), unit) : "";
    std::string text;
    if (!r_.reached) {
      text = fmt::format("No candidate meets the target U = {:.6g}{}{}. The smallest U reached is {} in {}, with {}",
                         shown(choose_.target), unit, bias, width(f.expanded), duration(r_.fresh.time),
                         in_words(search_.settings_of(r_.fresh.values), r_.evaluations));
    } else if (!r_.confirmed) {
      text =
          fmt::format("No setting is confirmed to meet the target U = {:.6g}{}{}. The one that fresh samples speak for "
                      "most is {}. It takes {} and reaches U = {}",
                      shown(choose_.target), unit, bias, in_words(search_.settings_of(r_.fresh.values), r_.evaluations),
                      duration(r_.fresh.time), width(f.expanded));
    } else {
      text =
          fmt::format("The fastest setting that meets the target U = {:.6g}{}{}: {}. It takes {} and reaches U = {}",
                      shown(choose_.target), unit, bias, in_words(search_.settings_of(r_.fresh.values), r_.evaluations),
                      duration(r_.fresh.time), width(f.expanded));
    }
    if (choose_.worst_case) text += fmt::format(" in the worst case, {}", choose_.cases[r_.fresh.worst].name);
    if (choose_.definition == scenario::Choose::Definition::corrected)
      text += fmt::format(" after a correction of {}", width(-r_.fresh.average.mean));
    text += fmt::format("; by {} fresh samples it meets the target with a probability of {}.", choose_.confirm_samples,
                        r_.probability > 0.9995   ? "more than 0.999"
                        : r_.probability < 0.0005 ? "less than 0.001"
                                                  : fmt::format("{:.3g}", r_.probability));
    if (const auto refuted = std::ranges::count_if(r_.candidates, &Candidate::refuted); r_.confirmed && refuted > 0)
      text += fmt::format(" {} setting{} met it in the search and {} not confirmed by fresh samples.", refuted,
                          refuted == 1 ? "" : "s", refuted == 1 ? "was" : "were");
    if (r_.reached && !r_.confirmed)
      text += fmt::format(" No faster or slower setting that was tried meets it with the required probability of "
                          "{:.3g}. Use more samples "
                          "or a finer search.",
                          choose_.confirm_probability);
    r_.statement = text;
  }

  const scenario::Scenario& s_;
  const scenario::Choose& choose_;
  const Settings& settings_;
  Search search_;
  Result r_;
  double failed_ = INFINITY;      ///< least U in the search of a candidate that failed by its U
  std::set<std::size_t> refuted_; ///< candidates that failed
  std::set<std::size_t> faster_tried_; ///< afresh, because they take less time
};

/// Four significant digits, and 12000 rather than 1.2e+04.
std::string four_digits(double x) {
  return std::fabs(x) >= 1e4 && std::fabs(x) < 1e9 ? fmt::format("{:.0f}", x) : fmt::format("{:.4g}", x);
}

} // namespace

std::string in_words(const std::vector<Setting>& settings, const std::vector<std::string>& evaluations) {
  std::string text;
  for (const auto& [knob, value] : settings) {
    text += text.empty() ? "" : ", ";
    if (knob.kind == Knob::Kind::evaluation)
      text += fmt::format("evaluation {}", evaluations[static_cast<std::size_t>(value)]);
    else
      text += fmt::format("{} {}{}", knob.name, four_digits(units::from_si(value, knob.unit, knob.si_unit)),
                          units::suffix(knob.unit));
  }
  return text;
}

std::string duration(double seconds) {
  if (seconds < 1) return fmt::format("{:.3g} s", seconds);
  if (seconds < 100) return fmt::format("{:.1f} s", seconds);
  const auto whole = static_cast<long>(std::lround(seconds));
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

Result choose(const scenario::Scenario& scenario, const Settings& settings) {
  return Chooser(scenario, settings).run();
}

} // namespace gumshoe::choice
