#pragma once
/// Candidates and where to look for them: a coarse grid, refined about the best.
#include <functional>
#include <map>
#include <optional>

#include "choice/places.h"
#include "choice/results.h"
#include "propagation/work.h"
#include "scenario/scenario.h"

namespace gumshoe::choice {

struct Settings {
  propagation::Workers workers = 0;
  std::function<void(const std::string& stage)> progress;
};

/// All candidates tried so far, each once, with common random numbers: their differences are due to the settings.
class Search {
public:
  Search(const scenario::Scenario& scenario, const Settings& settings);

  /// Every combination of lists and coarse grids; then `refinements` rounds, each halving the ranges' steps: about the
  /// best candidate of each combination of the lists' values (the fastest that meets the target, else the one of least
  /// U; the eight most promising) all neighbours are tried, until the best stay where they are.
  /// @param target  the one that is asked for, or one by which these samples' errors are allowed for
  void run(double target);
  /// One step away from a candidate, in one variable: of a range a quarter of a step of the coarse grid, of a list the
  /// next value either way, of the evaluation every other. Tried if not known.
  std::vector<Neighbour> neighbours(std::size_t candidate);

  const std::vector<Candidate>& candidates() const { return candidates_; }
  /// Those that meet a target, the fastest first; of equal times the one of less U.
  std::vector<std::size_t> meeting(double target) const;
  /// The candidate of least U for each combination of the lists' values, among those that take fewer seconds than this,
  /// if its U is within two standard errors of the target; the least U first.
  std::vector<std::size_t> hopeful(double faster_than) const;
  /// The one of least U; empty if all failed.
  std::optional<std::size_t> least() const;
  /// Those that nothing beats in both time and U; marks them.
  void mark_pareto();

  std::uint64_t skipped() const { return skipped_; }
  const std::vector<std::string>& skipped_why() const { return skipped_why_; }
  std::vector<double> resolution() const;
  std::vector<scenario::Setting> settings_of(const std::vector<double>& values) const;
  /// A candidate with these figures (figures_of).
  Candidate judged(Candidate candidate, std::vector<Figures> figures) const;

private:
  void attempt(const std::vector<Place>& places);
  void skip(const Place& place);
  std::vector<double> values_at(const Place& place) const;
  std::vector<Place> centres(double target) const;
  /// Values of the lists alone.
  Place combination(std::size_t candidate) const;
  bool usable(const Candidate& c) const;
  /// Whether it is usable, and U and the bias are small enough.
  bool within(const Candidate& c, double target) const;
  const Figures& asked(const Candidate& c) const { return choice::asked(c, choose_.worst_case); }

  const scenario::Scenario& scenario_;
  const scenario::Choose& choose_;
  const Places grid_;
  const Settings& settings_;
  int round_ = 0;
  std::vector<Candidate> candidates_;
  std::vector<Place> places_;                                       ///< by candidate
  std::map<std::vector<double>, std::optional<std::size_t>> known_; ///< by values; none: cannot be
  std::uint64_t skipped_ = 0;
  std::vector<std::string> skipped_why_;
};

} // namespace gumshoe::choice
