#pragma once
/// A scenario's model, linearised at its readings and at those that are allowed: information by column.
#include <string>
#include <vector>

#include "tracing/candidates/candidates.h"
#include "tracing/fit/joint_fit.h"
#include "tracing/planning/exchange.h"

namespace gumshoe::tracing {

/// An effect of a goal, with the columns of its amplitudes.
struct EffectColumns {
  Candidate candidate;
  std::vector<Index> columns;
  /// By the name of the effect or of its quantity: "thermal_growth", "thermal_growth.rate".
  bool is(const std::string& name) const {
    return candidate.name == name || candidate.amplitudes[0].scenario_name == name;
  }
};

/// A quantity, or one of its entries, as a sum of columns.
struct QuantityColumns {
  std::string name, unit, si_unit;
  std::vector<Index> columns;
  Vector weight;
};

/// Columns are the free unknowns, the declared draws that readings share (each of unit variance), and the amplitudes of
/// the effects of the goals; each divided by its length over all readings, so that one limit of rounding serves all.
struct LinearModel {
  Matrix base;                                 ///< information of the readings there are, and of the declared draws
  std::vector<Matrix> rows;                    ///< by usable allowed reading, as PlanTask
  std::vector<double> cost;                    ///< likewise
  std::vector<std::vector<std::size_t>> opens; ///< likewise
  std::vector<std::size_t> allowed;            ///< likewise: position in scenario::Plan::readings
  std::vector<std::string> settings;           ///< likewise: what tells it from others, "feed 8 mm/min, setup 4"
  std::vector<std::string> setups;             ///< new values of labels: "setup 4"
  std::vector<double> opening;                 ///< their costs
  std::vector<double> unit;                    ///< by column: coefficient in SI = coefficient here times this
  std::vector<Index> free;                     ///< columns of the free unknowns
  std::vector<QuantityColumns> unknowns;       ///< these, by name
  std::vector<QuantityColumns> declared;       ///< quantities with declared draws that readings share
  std::vector<EffectColumns> effects;
  bool noise_declared = true, noise_known = true;
  int values = 0; ///< indications of the readings there are
  std::size_t indications = 1;
  std::vector<std::string> notes;
  /// By column: the quantity of the scenario whose change it is.
  std::vector<std::size_t> quantity;

  JointFit fit;           ///< at which the model is linearised; readings as with_readings gives them, twice each
  Points at;              ///< its point with every declared draw at null
  double noise = 1;       ///< factor of the design's noise: 1 where it is declared
  scenario::Scenario all; ///< these readings, with every effect at null

  /// Columns of unknowns and draws that a model with these effects has: those of other quantities.
  std::vector<Index> nuisances(const std::vector<const EffectColumns*>& effects) const;
  /// Columns by name: "laser_z", "rod_length" (all entries), "rod_length[rod 1]"; empty: there are none.
  std::vector<QuantityColumns> quantities_named(const std::string& name) const;
  /// Size that the scenario states of an effect, SI; 0: none.
  double stated_size(const Amplitude& amplitude) const;
  /// Number of unknowns and amplitudes that readings of this information determine in the model of a goal.
  int fitted(const PlanGoal& goal, const Matrix& information) const;
  /// Smallest share of a goal's columns that its other columns leave.
  double share_left(const PlanGoal& goal, const Matrix& information) const;
  /// Standard uncertainty beyond which nothing but rounding determines a goal.
  double undetermined(const PlanGoal& goal) const;
};

/// Linearised at the fit of the readings, or without any at the scenario's estimates.
LinearModel linear_model(const scenario::Scenario& scenario, int threads);

} // namespace gumshoe::tracing
