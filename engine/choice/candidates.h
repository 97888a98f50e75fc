#pragma once
/// The work of a search: which places can be, and the figures of their errors, in units that any process can do.
#include <string>
#include <vector>

#include "choice/places.h"
#include "choice/results.h"
#include "propagation/work.h"
#include "scenario/scenario.h"

namespace gumshoe::choice {

/// The settings of a place.
std::vector<scenario::Setting> settings_at(const scenario::Choose& choose, const Place& place);

/// Figures of the average and of each case from errors, [0: all drawn, 1 + k: case k][sample].
std::vector<Figures> figures_of(const scenario::Scenario& scenario, const std::vector<std::vector<double>>& errors);

/// What a unit gives.
struct Assessment {
  bool possible = false;
  double time = 0; ///< s
  std::size_t readings = 0;
  std::vector<Figures> figures; ///< as figures_of()
};

/// Places of one value each: those of the coarse grid, the first of equal ones.
std::vector<Place> coarse_places(const scenario::Scenario& scenario);
/// What the units of the coarse grid are: its variables, the values of its candidates, their samples and the numbers of a
/// unit, hashed.
std::string coarse_grid_hash(const scenario::Scenario& scenario);

/// Assesses places with common random numbers, one in a unit, on so many threads each. Its name says which places they
/// are: "grid" of the coarse ones, or a list.
propagation::Work assessment_work(const scenario::Scenario& scenario, std::vector<Place> places, int threads = 1);
/// The work of a name, for a process that was only told this.
propagation::Work assessment_work(const scenario::Scenario& scenario, const std::string& name);
/// Names of the numbers of a unit: "time", "case_1_mean".
std::vector<std::string> assessment_names(const scenario::Scenario& scenario);
/// How many there are, and what they say.
std::size_t assessment_values(const scenario::Scenario& scenario);
Assessment assessment(const scenario::Scenario& scenario, const double* values);

} // namespace gumshoe::choice
