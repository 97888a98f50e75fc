#include "choice/search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "choice/candidates.h"
#include "choice/setup.h"

namespace gumshoe::choice {

namespace {

using scenario::Knob;
constexpr std::size_t most_centres = 8, most_moves = 16;

} // namespace

Search::Search(const scenario::Scenario& s, const Settings& settings)
    : scenario_(s), choose_(*s.choose), grid_(*s.choose), settings_(settings) {}

std::vector<scenario::Setting> Search::settings_of(const std::vector<double>& values) const {
  std::vector<scenario::Setting> out;
  for (std::size_t v = 0; v < values.size(); ++v) out.push_back({choose_.variables[v].knob, values[v]});
  return out;
}

std::vector<double> Search::resolution() const {
  std::vector<double> out;
  for (std::size_t v = 0; v < choose_.variables.size(); ++v)
    out.push_back(choose_.variables[v].range ? 1.0 / grid_.parts(v) : 0);
  return out;
}

Candidate Search::judged(Candidate c, std::vector<Figures> figures) const {
  c.average = figures[0];
  c.cases.assign(figures.begin() + 1, figures.end());
  c.worst = 0; // NaN, no value at all, is the worst
  for (std::size_t k = 1; k < c.cases.size(); ++k)
    if (!(c.cases[k].expanded <= c.cases[c.worst].expanded)) c.worst = k;
  c.meets = within(c, choose_.target);
  return c;
}

bool Search::within(const Candidate& c, double target) const {
  bool out = usable(c) && asked(c).expanded <= target;
  if (choose_.bias) {
    out = out && std::fabs(c.average.mean) <= *choose_.bias;
    for (const Figures& f : c.cases)
      if (choose_.worst_case) out = out && std::fabs(f.left) <= *choose_.bias;
  }
  return out;
}

bool Search::usable(const Candidate& c) const {
  const auto good = [&](const Figures& f) {
    return f.valid > 3 &&
           static_cast<double>(f.failed) <= scenario_.run.max_failed_share * static_cast<double>(f.valid + f.failed);
  };
  return good(c.average) && (!choose_.worst_case || std::ranges::all_of(c.cases, good));
}

std::vector<double> Search::values_at(const Place& place) const {
  std::vector<double> values;
  for (std::size_t v = 0; v < place.size(); ++v) values.push_back(grid_.value(v, place[v]));
  return values;
}

/// Says why a place cannot be.
void Search::skip(const Place& place) {
  ++skipped_;
  try {
    Setup(scenario_, settings_at(choose_, place));
  } catch (const InputError& error) {
    const Problem& p = error.problems().front();
    const std::string why = p.what + (p.why.empty() ? "" : " (" + p.why + ")");
    if (std::ranges::find(skipped_why_, why) == skipped_why_.end()) skipped_why_.push_back(why);
  }
}

void Search::attempt(const std::vector<Place>& places) {
  std::vector<Place> fresh;
  for (const Place& place : places)
    if (known_.try_emplace(values_at(place)).second) fresh.push_back(place);
  if (fresh.empty()) return;
  if (settings_.progress) settings_.progress(fmt::format("round {}", round_));
  // Few candidates keep all threads busy only if these share each of them.
  propagation::Workers workers = settings_.workers;
  const bool few = fresh.size() < 2 * workers.size() && workers.elsewhere.empty();
  const int inside = std::exchange(workers.threads, few ? 1 : workers.threads);
  workers.run(assessment_work(scenario_, fresh, few ? inside : 1),
              [&](std::uint64_t first, std::uint64_t last, const double* values) {
                for (std::uint64_t i = first; i < last; ++i) {
                  Assessment a = assessment(scenario_, values + (i - first) * assessment_values(scenario_));
                  if (!a.possible) {
                    skip(fresh[i]);
                    continue;
                  }
                  Candidate c;
                  c.values = values_at(fresh[i]);
                  c.time = a.time;
                  c.readings = a.readings;
                  c.round = round_;
                  known_[c.values] = candidates_.size();
                  candidates_.push_back(judged(std::move(c), std::move(a.figures)));
                  places_.push_back(fresh[i]);
                }
              });
}

std::vector<std::size_t> Search::meeting(double target) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    if (within(candidates_[i], target)) out.push_back(i);
  std::ranges::stable_sort(out, [&](std::size_t a, std::size_t b) {
    const Candidate &x = candidates_[a], &y = candidates_[b];
    return x.time != y.time ? x.time < y.time : asked(x).expanded < asked(y).expanded;
  });
  return out;
}

std::optional<std::size_t> Search::least() const {
  constexpr double rounding = 1e-12; // of equal U the fastest
  std::optional<std::size_t> best;
  const auto better = [&](const Candidate& a, const Candidate& b) {
    const double u = asked(a).expanded, known = asked(b).expanded;
    return std::fabs(u - known) <= rounding * known ? a.time < b.time : u < known;
  };
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    if (usable(candidates_[i]) && (!best || better(candidates_[i], candidates_[*best]))) best = i;
  return best;
}

Place Search::combination(std::size_t candidate) const {
  Place out = places_[candidate];
  for (std::size_t v = 0; v < out.size(); ++v)
    if (choose_.variables[v].range) out[v] = 0;
  return out;
}

std::vector<std::size_t> Search::hopeful(double faster_than) const {
  std::map<Place, std::size_t> best;
  const auto u = [&](std::size_t i) { return asked(candidates_[i]).expanded; };
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Figures& f = asked(candidates_[i]);
    if (candidates_[i].time >= faster_than || !within(candidates_[i], choose_.target + 2 * f.expanded_se)) continue;
    const auto [it, fresh] = best.try_emplace(combination(i), i);
    if (!fresh && u(i) < u(it->second)) it->second = i;
  }
  std::vector<std::size_t> out;
  for (const auto& [lists, i] : best) out.push_back(i);
  std::ranges::stable_sort(out, {}, u);
  return out;
}

std::vector<Place> Search::centres(double target) const {
  std::map<Place, std::size_t> best; // by the lists' places
  const auto better = [&](const Candidate& a, const Candidate& b) {
    const bool meets = within(a, target);
    if (meets != within(b, target)) return meets;
    if (meets && a.time != b.time) return a.time < b.time;
    return asked(a).expanded < asked(b).expanded;
  };
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    if (!usable(candidates_[i])) continue;
    const auto [it, fresh] = best.try_emplace(combination(i), i);
    if (!fresh && better(candidates_[i], candidates_[it->second])) it->second = i;
  }
  std::vector<std::size_t> order;
  for (const auto& [lists, i] : best) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return better(candidates_[a], candidates_[b]); });
  std::vector<Place> out;
  for (std::size_t k = 0; k < std::min(order.size(), most_centres); ++k) out.push_back(places_[order[k]]);
  return out;
}

void Search::run(double target) {
  round_ = 0;
  attempt(coarse_places(scenario_));
  if (candidates_.empty())
    throw InputError("choose: no combination of the variables is possible",
                     skipped_why_.empty() ? "" : skipped_why_[0]);
  const bool ranges = std::ranges::any_of(choose_.variables, &scenario::Variable::range);
  for (round_ = 1; ranges && round_ <= choose_.refinements; ++round_) {
    std::vector<Place> at;
    for (std::size_t move = 0; move < most_moves; ++move) {
      const auto next = centres(target);
      if (next == at) break;
      at = next;
      std::vector<Place> places;
      for (const Place& centre : at)
        for (Place& place : grid_.around(centre, 1 << (choose_.refinements - round_)))
          places.push_back(std::move(place));
      attempt(places);
    }
  }
}

std::vector<Neighbour> Search::neighbours(std::size_t candidate) {
  round_ = choose_.refinements + 1;
  const Place from = places_[candidate];
  std::vector<std::pair<std::size_t, Place>> moves;
  for (std::size_t v = 0; v < from.size(); ++v) {
    const auto& variable = choose_.variables[v];
    std::vector<int> to;
    if (variable.knob.kind == Knob::Kind::evaluation) {
      for (int i = 0; i <= grid_.parts(v); ++i)
        if (i != from[v]) to.push_back(i);
    } else if (variable.range) {
      // Readings are whole: several places may be one value.
      const int step = 1 << std::max(0, choose_.refinements - 2);
      for (const int direction : {-step, step}) {
        int place = from[v] + direction;
        while (place >= 0 && place <= grid_.parts(v) && grid_.value(v, place) == grid_.value(v, from[v]))
          place += direction;
        if (place >= 0 && place <= grid_.parts(v)) to.push_back(place);
      }
    } else {
      // By value: a list need not be in order.
      std::optional<int> below, above;
      for (int i = 0; i <= grid_.parts(v); ++i) {
        const double x = grid_.value(v, i), here = grid_.value(v, from[v]);
        if (x < here && (!below || x > grid_.value(v, *below))) below = i;
        if (x > here && (!above || x < grid_.value(v, *above))) above = i;
      }
      for (const auto& next : {below, above})
        if (next) to.push_back(*next);
    }
    for (const int place : to) {
      moves.emplace_back(v, from);
      moves.back().second[v] = place;
    }
  }
  std::vector<Place> places;
  for (const auto& [v, place] : moves) places.push_back(place);
  attempt(places);
  std::vector<Neighbour> out;
  for (const auto& [v, place] : moves) {
    std::vector<double> values;
    for (std::size_t i = 0; i < place.size(); ++i) values.push_back(grid_.value(i, place[i]));
    const auto found = known_.at(values);
    if (!found) continue; // cannot be
    const Candidate &here = candidates_[candidate], &there = candidates_[*found];
    Neighbour n{v, *found, there.time / here.time, asked(there).expanded / asked(here).expanded};
    n.near = n.time_ratio <= 1 + choose_.near && n.expanded_ratio <= 1 + choose_.near;
    out.push_back(n);
  }
  return out;
}

void Search::mark_pareto() {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < candidates_.size(); ++i)
    if (usable(candidates_[i])) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    const Candidate &x = candidates_[a], &y = candidates_[b];
    return x.time != y.time ? x.time < y.time : asked(x).expanded < asked(y).expanded;
  });
  double least = INFINITY;
  for (const std::size_t i : order) {
    candidates_[i].pareto = asked(candidates_[i]).expanded < least;
    if (candidates_[i].pareto) least = asked(candidates_[i]).expanded;
  }
}

} // namespace gumshoe::choice
