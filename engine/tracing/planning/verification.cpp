#include "tracing/planning/verification.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tracing/noise/whitened.h"
#include "tracing/planning/further_readings.h"
#include "tracing/trace.h"

namespace gumshoe::tracing {
namespace {

using scenario::Scenario;

/// Draws of the bootstrap of each trace: enough for a false-alarm rate of 5 %, which it asks more for where in doubt.
constexpr int least_draws = 199;
constexpr std::uint16_t shared_purpose = 71, own_purpose = 72; ///< streams of random numbers that nothing else has

class Simulation {
public:
  Simulation(const Scenario& s, const LinearModel& model, const std::vector<int>& count, int threads) : model_(model) {
    std::vector<int> planned(s.plan->readings.size(), 0);
    const std::size_t existing = has_readings(s) ? s.readings.size() : 0;
    for (std::size_t r = 0; r < existing; ++r) like_.push_back(r);
    for (std::size_t i = 0; i < count.size(); ++i) {
      planned[model.allowed[i]] = count[i];
      like_.insert(like_.end(), static_cast<std::size_t>(count[i]), existing + 2 * i);
    }
    readings_ = with_readings(s, planned);
    readings_.trace.blocks.clear();
    readings_.trace.final_blocks.clear();
    readings_.trace.draws = std::min(readings_.trace.draws, least_draws);
    const propagation::Experiment experiment(model.all);
    Simulator(experiment, threads).simulate(model.at, exact_);
    const Design& d = model.fit.design;
    place_.resize(model.all.readings.size());
    for (std::size_t p = 0; p < d.local.size(); ++p) place_[d.reading[p * d.indications]] = p;
  }

  /// Readings with an effect: of an amplitude of several the first.
  Scenario operator()(const EffectColumns& effect, double size, std::uint64_t seed) const {
    const Design& d = model_.fit.design;
    const auto k = index(d.indications);
    const Vector shared = normals(index(d.random.cols()), 1, seed, shared_purpose);
    const Matrix own = normals(like_.size(), d.indications, seed, own_purpose);
    Scenario out = readings_;
    for (std::size_t r = 0; r < like_.size(); ++r) {
      const std::size_t p = place_[like_[r]];
      const auto rows = Eigen::seqN(index(p) * k, k);
      Vector y = exact_.segment(index(like_[r]) * k, k);
      y += effect.candidate.columns(rows, 0) * size;
      if (d.random.cols() > 0) y += d.random(rows, Eigen::all) * shared;
      y += model_.noise * (d.local[p] * own.row(index(r)).transpose());
      out.readings[r].indications.assign(y.begin(), y.end());
    }
    return out;
  }

private:
  const LinearModel& model_;
  std::vector<std::size_t> like_;  ///< by reading: the one of the linear model that it equals
  std::vector<std::size_t> place_; ///< by reading of that: its place in the sequence
  Scenario readings_;
  Vector exact_;
};

bool named(const Trace& trace, const std::string& effect) {
  return std::ranges::any_of(trace.findings,
                             [&](const Finding& f) { return std::ranges::find(f.members, effect) != f.members.end(); });
}

} // namespace

std::vector<Verified> verify(const Scenario& s, const LinearModel& model, const std::vector<int>& count,
                             const std::vector<GoalReached>& goals, const PlanSettings& settings) {
  const Simulation simulation(s, model, count, settings.threads);
  const auto effect = [&](const std::string& name) -> const EffectColumns& {
    return *std::ranges::find_if(model.effects, [&](const EffectColumns& e) { return e.is(name); });
  };
  std::vector<Verified> out;
  std::vector<std::string> done;
  for (const GoalReached& goal : goals) {
    if (goal.kind != GoalReached::Kind::split && goal.kind != GoalReached::Kind::detect) continue;
    if (std::ranges::find(done, goal.of) != done.end()) continue;
    done.push_back(goal.of);
    const std::size_t first = out.size();
    std::vector<std::string> against;
    for (const GoalReached& g : goals)
      if (g.of == goal.of && (g.kind == GoalReached::Kind::split || g.kind == GoalReached::Kind::detect)) {
        out.push_back({g.of, g.against, settings.verify, 0});
        against.push_back(g.against.empty() ? "" : effect(g.against).candidate.name);
      }
    for (int i = 0; i < settings.verify; ++i) {
      if (settings.progress) settings.progress(fmt::format("{}: data set {} of {}", goal.of, i + 1, settings.verify));
      const std::uint64_t seed = s.trace.seed * 1'000'003 + static_cast<std::uint64_t>(i) + (done.size() << 40);
      const Trace found = trace(simulation(effect(goal.of), goal.size, seed), {settings.threads});
      const bool itself = named(found, effect(goal.of).candidate.name);
      for (std::size_t g = first; g < out.size(); ++g)
        if (itself && (against[g - first].empty() || !named(found, against[g - first]))) ++out[g].found;
    }
  }
  return out;
}

} // namespace gumshoe::tracing
