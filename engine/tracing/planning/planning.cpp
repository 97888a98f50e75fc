#include "tracing/planning/planning.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include <boost/math/distributions/binomial.hpp>
#include <fmt/format.h>

#include "base/error.h"
#include "base/special_values.h"
#include "base/units.h"
#include "calibration/data.h"
#include "quantities/cells.h"
#include "tracing/criteria.h"
#include "tracing/planning/linear_model.h"
#include "tracing/planning/power.h"
#include "tracing/planning/verification.h"

namespace gumshoe::tracing {
namespace {

using scenario::Scenario;

/// Repeats of every allowed reading that stand for "as many as one likes".
constexpr int plenty = 1000;

/// A goal with what is needed to say how far it is reached.
struct Asked {
  PlanGoal goal;
  PlanGoal alone; ///< of an effect: the same without the other effect
  GoalReached said;
  int parameters = 1;
};

class Planner {
public:
  Planner(const Scenario& s, const PlanSettings& settings)
      : s_(s), asked_(*s.plan), model_(linear_model(s, settings.threads)) {}

  Planned plan(const PlanSettings& settings) {
    Planned out;
    out.notes = model_.notes;
    out.allowed = model_.allowed.size();
    out.noise = model_.noise_declared ? Planned::Noise::declared
                : model_.noise_known  ? Planned::Noise::estimated
                                      : Planned::Noise::unknown;
    out.d_optimal = asked_.d_optimal();
    if (!model_.noise_known && !out.d_optimal)
      calibration::refuse(s_.file, "[plan]: the noise of a reading is not known",
                          "neither is it declared, nor are there readings that show it",
                          "declare it for the indication: repeatability = { s = \"1 um\" }");
    effects();
    uncertainties();
    task_ = {model_.base,  model_.rows,    model_.cost,
             model_.opens, model_.opening, {},
             model_.free,  asked_.most,    asked_.budget.value_or(infinity)};
    judge_possible();
    find(out);
    describe(out);
    for (const Asked& a : goals_) out.goals.push_back(a.said);
    unknowns(out);
    if (settings.verify > 0) out.verified = verify(s_, model_, count_, out.goals, settings);
    state_what_power_means(out);
    return out;
  }

private:
  double size_of(const std::string& name, const Candidate& a) const {
    for (const auto& [effect, size] : asked_.sizes)
      if (effect == name) return std::fabs(size);
    const Amplitude& one = a.amplitudes[0];
    if (const double stated = std::fabs(model_.stated_size(one)); stated > 0) return stated;
    const double typical = one.least_typical > 0 ? one.least_typical : one.typical;
    return typical > 0 ? typical : one.declared;
  }

  const EffectColumns& effect(const std::string& name) const {
    std::vector<std::string> same;
    const EffectColumns* found = nullptr;
    for (const EffectColumns& e : model_.effects) {
      if (!e.is(name)) continue;
      if (!found || e.candidate.amplitudes[0].scenario_name != found->candidate.amplitudes[0].scenario_name)
        same.push_back(e.candidate.amplitudes[0].scenario_name);
      if (!found) found = &e;
    }
    if (!found)
      calibration::refuse(s_.file, fmt::format("[plan]: {} moves no reading, nor any that is allowed", name), "",
                          "allow readings under other conditions, or leave it out");
    if (same.size() > 1)
      calibration::refuse(s_.file, fmt::format("[plan]: {} has several sizes", name), "each is a goal of its own",
                          fmt::format("name one of {}", fmt::join(same, ", ")));
    return *found;
  }

  /// The test of an effect, given others.
  void add(GoalReached::Kind kind, const std::string& name, const std::string& against,
           const std::vector<const EffectColumns*>& others) {
    const EffectColumns& own = effect(name);
    const Amplitude& a = own.candidate.amplitudes[0];
    Asked out;
    out.said = {kind, name, against, a.unit, a.si_unit, size_of(name, own.candidate), asked_.power};
    if (!(out.said.size > 0))
      calibration::refuse(s_.file, fmt::format("[plan]: no typical size of {} is known", name),
                          "a goal needs a size that is to be seen",
                          fmt::format("state it: sizes = {{ \"{}\" = \"...\" }}", name));
    out.parameters = static_cast<int>(own.columns.size());
    out.goal.kind = PlanGoal::Kind::size;
    out.goal.of = own.columns;
    std::vector<const EffectColumns*> all = others;
    all.push_back(&own);
    out.goal.weight.resize(index(own.columns.size()));
    for (std::size_t j = 0; j < own.columns.size(); ++j)
      out.goal.weight[index(j)] = out.said.size / model_.unit[index(own.columns[j])];
    out.goal.others = model_.nuisances(all);
    out.alone = out.goal;
    for (const EffectColumns* e : others)
      out.goal.others.insert(out.goal.others.end(), e->columns.begin(), e->columns.end());
    goals_.push_back(std::move(out));
  }

  void effects() {
    for (const std::string& name : asked_.detect) add(GoalReached::Kind::detect, name, "", {});
    for (const std::string& one : asked_.split)
      for (const std::string& other : asked_.split) {
        if (one == other) continue;
        // Whatever shape the other one has: the goal is the worst of them.
        effect(other);
        for (const EffectColumns& e : model_.effects)
          if (e.is(other)) add(GoalReached::Kind::split, one, other, {&e});
      }
  }

  void uncertainties() {
    for (const auto& [name, u] : asked_.uncertainties) {
      const auto found = model_.quantities_named(name);
      if (found.empty())
        calibration::refuse(s_.file, fmt::format("[plan]: no reading tells anything of {}", name),
                            "it is neither estimated nor a declared value that readings share",
                            "name a quantity that is marked estimated");
      for (const QuantityColumns& q : found) goals_.push_back(asked_of(q, GoalReached::Kind::uncertainty, u));
    }
  }

  Asked asked_of(const QuantityColumns& q, GoalReached::Kind kind, double u) const {
    Asked out;
    out.said.kind = kind;
    out.said.of = q.name;
    out.said.unit = q.unit;
    out.said.si_unit = q.si_unit;
    out.said.wanted = u;
    out.goal.kind = PlanGoal::Kind::uncertainty;
    out.goal.of = q.columns;
    for (const Index j : model_.nuisances({}))
      if (std::ranges::find(q.columns, j) == q.columns.end()) out.goal.others.push_back(j);
    out.goal.weight = q.weight;
    out.goal.required = u > 0 ? 1 / (u * u) : 1;
    return out;
  }

  /// Degrees of freedom of the noise in the test of a goal: those that the fit with its amplitudes, and with the effect
  /// that must not explain them, leaves.
  /// @param information  says which unknowns the readings determine
  double freedom(const Asked& a, const Matrix& information, int further) const {
    if (model_.noise_declared) return infinity;
    const int values = model_.values + further * static_cast<int>(model_.indications);
    return values - model_.fitted(a.goal, information);
  }

  /// Power of a test, or standard uncertainty, at an information matrix.
  double figure(const Asked& a, const Matrix& information, int further) const {
    const double value = reached(a.goal, information) * a.goal.required;
    if (a.goal.kind == PlanGoal::Kind::uncertainty) {
      const double u = 1 / std::sqrt(value);
      return u > model_.undetermined(a.goal) ? infinity : u;
    }
    return power(value, a.parameters, freedom(a, information, further), asked_.alpha);
  }

  /// Whether any number of allowed readings reaches a goal; one that none does is not sought.
  void judge_possible() {
    const Matrix all = information(task_, std::vector<int>(task_.rows.size(), plenty));
    set_required(all, plenty);
    for (Asked& a : goals_) {
      a.said.possible = reached(a.goal, all) >= enough;
      if (!a.said.possible) a.said.remark = why_not(a, all);
    }
  }

  /// Why no number of allowed readings, of which `all` is the information, reaches a goal.
  std::string why_not(const Asked& a, const Matrix& all) const {
    const auto hidden = [&](const PlanGoal& goal) { return model_.share_left(goal, all) <= criteria.absorbed_share; };
    if (a.goal.kind == PlanGoal::Kind::uncertainty) {
      const double least = figure(a, all, plenty);
      if (std::isinf(least)) return fmt::format("no allowed reading determines {}", a.said.of);
      const std::string u =
          fmt::format("{:.3g}{}", units::from_si(least, a.said.unit, a.said.si_unit, units::Kind::difference),
                      units::suffix(a.said.unit));
      constexpr double falling = 1.05; // of a quarter of the readings, what falls with their root is twice as large
      const Matrix fewer = information(task_, std::vector<int>(task_.rows.size(), plenty / 4));
      if (figure(a, fewer, plenty / 4) > falling * least)
        return fmt::format("{} of each allowed reading bring u of {} to {}, which is not enough", plenty, a.said.of, u);
      return fmt::format("no number of allowed readings brings u of {} below {}", a.said.of, u);
    }
    if (hidden(a.alone))
      return fmt::format("no allowed reading shows {}: what is estimated explains all of it", a.said.of);
    if (hidden(a.goal))
      return fmt::format("no allowed reading separates {} from {}: given what is estimated, they are equal at every "
                         "allowed condition",
                         a.said.of, a.said.against);
    return fmt::format("no number of allowed readings suffices for {}: declared uncertainties hide it", a.said.of);
  }

  void set_required(const Matrix& information, int further) {
    for (Asked& a : goals_)
      if (a.goal.kind == PlanGoal::Kind::size)
        a.goal.required = noncentrality_for(asked_.power, a.parameters, freedom(a, information, further), asked_.alpha);
  }

  int taken() const { return std::accumulate(count_.begin(), count_.end(), 0); }

  /// The plan of tests with the noise that so many further readings show. @return whether it meets the goals
  bool find_for(const Matrix& fitted, int further, Planned& out) {
    set_required(fitted, further);
    task_.goals.clear();
    for (const Asked& a : goals_)
      if (a.said.possible) task_.goals.push_back(a.goal);
    const PlanFound found = find_plan(task_);
    count_ = found.count;
    out.cost = found.cost;
    out.met = found.met;
    return found.met;
  }

  /// Whether the plan meets the goals by the noise that it shows itself.
  bool holds() {
    const Matrix after = information(task_, count_);
    set_required(after, taken());
    return std::ranges::all_of(goals_,
                               [&](const Asked& a) { return !a.said.possible || reached(a.goal, after) >= enough; });
  }

  /// An estimated noise is known better the more readings there are, and with fewer the test asks for more: the least
  /// number that is no smaller than that of the readings which its test needs.
  void find_consistent(const Matrix& fitted, Planned& out) {
    int low = -1, high = asked_.most;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      (find_for(fitted, middle, out) && taken() <= middle ? high : low) = middle;
    }
    find_for(fitted, high, out);
    if (out.met) fill_up(high, out);
  }

  /// Adds the cheapest readings, for their degrees of freedom.
  void fill_up(int wanted, Planned& out) {
    std::set<std::size_t> open;
    for (std::size_t i = 0; i < count_.size(); ++i)
      if (count_[i] > 0) open.insert(task_.opens[i].begin(), task_.opens[i].end());
    for (int n = taken(); n < wanted; ++n) {
      std::vector<double> cost = task_.cost; // with the set-ups that it opens
      for (std::size_t i = 0; i < cost.size(); ++i)
        for (const std::size_t setup : task_.opens[i])
          if (!open.contains(setup)) cost[i] += task_.opening[setup];
      const auto best = static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin());
      if (out.cost + cost[best] > task_.budget) return;
      ++count_[best];
      out.cost += cost[best];
      open.insert(task_.opens[best].begin(), task_.opens[best].end());
    }
  }

  void find(Planned& out) {
    count_.assign(task_.rows.size(), 0);
    const bool any = std::ranges::any_of(goals_, [](const Asked& a) { return a.said.possible; });
    if (!goals_.empty() && !any) return;
    const Matrix all = information(task_, std::vector<int>(task_.rows.size(), plenty));
    if (!find_for(all, asked_.most, out) || model_.noise_declared || out.d_optimal || holds()) return;
    find_consistent(information(task_, count_), out);
    if (out.met && !holds()) find_consistent(all, out); // it has opened further set-ups, each with its unknowns
  }

  void describe(Planned& out) {
    const Matrix before = task_.base, after = information(task_, count_);
    out.count = taken();
    set_required(after, out.count);
    if (!goals_.empty()) out.met = true;
    for (Asked& a : goals_) {
      a.said.before = figure(a, before, 0);
      a.said.after = figure(a, after, out.count);
      a.said.met = a.said.possible && reached(a.goal, after) >= enough;
      out.met = out.met && a.said.met;
    }
    keep_worst_shapes();
    if (out.d_optimal) out.gain = log_determinant(task_, after) - log_determinant(task_, before);
    std::set<std::size_t> open;
    for (std::size_t i = 0; i < count_.size(); ++i) {
      if (count_[i] == 0) continue;
      out.readings.push_back({model_.allowed[i], count_[i], count_[i] * task_.cost[i], model_.settings[i]});
      open.insert(task_.opens[i].begin(), task_.opens[i].end());
    }
    out.repeats = model_.noise_declared && repeats(out);
    if (out.repeats)
      out.notes.push_back("readings of equal labels and conditions count as one, with its noise as declared: the "
                          "column 'repeat' of the "
                          "table tells them apart, with labels = { repeat = \"repeat\" } in [data], and 0 for the "
                          "readings that are there");
    for (const std::size_t setup : open) out.opened.push_back(model_.setups[setup]);
  }

  /// The power is that of a test of the one effect; a trace looks for all, and keeps readings apart.
  void state_what_power_means(Planned& out) const {
    const bool power = std::ranges::any_of(out.goals, [](const GoalReached& g) {
      return (g.kind == GoalReached::Kind::detect || g.kind == GoalReached::Kind::split) && g.met;
    });
    if (power && out.verified.empty())
      out.notes.push_back(
          "the power is that of one test of the one effect. gumshoe trace looks for others, too, and "
          "keeps readings apart to confirm, so that it finds the effect less often: --verify 200 counts");
    constexpr double chance = 0.01;
    for (const Verified& v : out.verified)
      if (const boost::math::binomial found(v.sets, asked_.power); v.found < v.sets && cdf(found, v.found) < chance)
        out.notes.push_back(
            fmt::format("gumshoe trace finds {} less often than in {:.0f} % of the sets, the power of one test, "
                        "because it looks for other "
                        "effects, too, and keeps readings apart to confirm: ask for more power, or for more readings",
                        v.of, 100 * asked_.power));
  }

  /// Whether the plan has equal readings, or some that there are already.
  bool repeats(const Planned& plan) const {
    return std::ranges::any_of(plan.readings, [&](const PlannedReading& p) {
      const auto& one = asked_.readings[p.allowed];
      return p.count > 1 || std::ranges::any_of(s_.readings, [&](const auto& r) {
               return r.labels == one.labels && r.conditions == one.conditions;
             });
    });
  }

  /// The shape of the other effect that is hardest to exclude after the plan.
  void keep_worst_shapes() {
    std::vector<Asked> kept;
    for (Asked& a : goals_) {
      const auto same = std::ranges::find_if(kept, [&](const Asked& b) {
        return b.said.kind == GoalReached::Kind::split && b.said.of == a.said.of && b.said.against == a.said.against;
      });
      if (a.said.kind != GoalReached::Kind::split || same == kept.end())
        kept.push_back(a);
      else if (a.said.after < same->said.after)
        *same = a;
    }
    goals_ = std::move(kept);
  }

  /// What is known of each free unknown, which a goal may not have asked for.
  void unknowns(Planned& out) const {
    const Matrix before = task_.base, after = information(task_, count_);
    if (!out.d_optimal) return;
    for (const QuantityColumns& q : model_.unknowns) {
      Asked a = asked_of(q, GoalReached::Kind::unknown, 0);
      a.said.before = figure(a, before, 0);
      a.said.after = figure(a, after, 0);
      a.said.met = true;
      out.goals.push_back(a.said);
    }
  }

  const Scenario& s_;
  const scenario::Plan& asked_;
  const LinearModel model_;
  PlanTask task_;
  std::vector<Asked> goals_;
  std::vector<int> count_;
};

} // namespace

const char* name(GoalReached::Kind kind) {
  static constexpr const char* names[] = {"split", "detect", "uncertainty", "unknown"};
  return names[static_cast<int>(kind)];
}

const char* name(Planned::Noise noise) {
  static constexpr const char* names[] = {"unknown", "estimated", "declared"};
  return names[static_cast<int>(noise)];
}

Planned plan(const Scenario& s, const PlanSettings& settings) { return Planner(s, settings).plan(settings); }

} // namespace gumshoe::tracing
