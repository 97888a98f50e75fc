#pragma once
/// The readings prepared for the search: in the order of measurement, in blocks, with their covariates.
#include <string>
#include <vector>

#include "tracing/simulator.h"

namespace gumshoe::tracing {

/// A covariate on which residuals may depend: a condition, a column of the data or the order of measurement. It varies.
struct Covariate {
  std::string name, unit, si_unit;
  std::vector<double> value;  ///< by reading of the scenario, SI
  std::vector<double> levels; ///< distinct values, ascending
  bool angle = false;
  bool commanded = false; ///< a condition of the model, and no column that was only recorded
  bool course = false;    ///< time, or the order of measurement
  /// A course that begins anew, such as the time since the start of each day: its values come back, as those of a
  /// condition do, and it does not tell one reading from all before.
  bool comes_back = false;
};

/// Whether a covariate is the number of the reading, and no other course that has no unit, such as decimal years.
bool counts_readings(const Covariate& covariate);

/// Number of the group of each reading, if the levels are cut into at most so many groups of neighbours.
std::vector<std::size_t> neighbours(const Covariate& covariate, std::size_t most);

/// A label, or a set of labels, with the group of each reading.
struct Grouping {
  std::string name; ///< "setup", "rod,setup"
  std::vector<std::string> labels;
  std::vector<std::size_t> group;                    ///< by reading
  std::vector<std::string> groups;                   ///< names: "setup 3"
  std::vector<std::vector<std::string>> values = {}; ///< by group: of each label, as the readings have them
};

/// How the readouts of one reading scatter about their mean, pooled over readings.
struct ReadoutScatter {
  std::vector<double> s; ///< by indication: standard deviation of one readout, SI
  double freedom = 0;    ///< degrees of freedom of each; 0: no reading has several
};

struct Observations {
  std::size_t readings = 0, indications = 0;
  /// Readings in the order of measurement, the same for shuffled rows where an order is stated.
  std::vector<std::size_t> sequence;
  std::vector<double> order; ///< by reading: as stated, or its number
  bool order_known = true;   ///< else one reading says nothing of the next
  std::vector<Covariate> covariates;
  std::vector<Grouping> labels; ///< each label with two values or more
  /// Two labels that are crossed and come back together from block to block: what differs by both is a table, and no
  /// scatter. None of them is stated to be done anew.
  std::vector<Grouping> label_pairs;
  std::vector<Grouping>
      replicate_groups;       ///< `[trace] redone`: set-up steps that were repeated, each of which may scatter
  Grouping blocks;            ///< no groups: none stated
  std::vector<bool> held_out; ///< by reading
  std::vector<std::string> holdout_blocks;
  std::vector<double> measured;        ///< [reading][indication], SI
  std::vector<double> step;            ///< by indication: in which readouts were recorded, SI (step.h)
  std::vector<int> readouts;           ///< by reading, the number of which it is the mean
  ReadoutScatter of_readouts;
  std::vector<std::string> statements; ///< what the design of the data leaves undetermined
  std::vector<std::string> names;      ///< names of the indications
  bool one_kind = true;                ///< their SI units are one: not um and arcsec
};

/// Rows of the scenario, [reading][indication], in the order of measurement.
Matrix in_sequence(const Observations& observations, const Matrix& rows);

/// Throws InputError if there are no readings, or a stated block does not exist.
Observations observe(const propagation::Experiment& experiment);

} // namespace gumshoe::tracing
