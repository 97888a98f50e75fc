#pragma once
/// Makes candidates: the steps common to all families, and one function per family.
#include "tracing/candidates/candidates.h"
#include "tracing/candidates/signatures.h"

namespace gumshoe::tracing {

/// Columns by reading in the order of measurement, zero where they do not act.
/// @param mask  readings of the scenario at which they act; null: all
Matrix masked(const Observations& observations, Matrix columns, const std::vector<bool>* mask);

/// Makes candidates at a point; `step` and `skip` as in physical_candidates.
class CandidateMaker {
public:
  CandidateMaker(const propagation::Experiment& experiment, const Simulator& simulator, const Points& at,
                 const Observations& observations, double step, const std::function<bool(const Candidate&)>& skip,
                 const BestStart& choose);
  /// For jumping_candidates() alone, which needs no signatures.
  CandidateMaker(const propagation::Experiment& experiment, const Simulator& simulator, const Points& at,
                 const Observations& observations, double step, const BestStart& choose);

  /// Adds a candidate to its family unless it is skipped, has no effect, or equals one with its name.
  void add(Candidate a, std::vector<Candidate>& family) const;
  /// Adds a candidate of a single amplitude: its tangent, then finite steps that differ from the tangent.
  /// @param mask  readings at which it acts; null: all
  void add_single(Candidate a, std::size_t quantity, const std::vector<bool>* mask,
                  std::vector<Candidate>& family) const;
  Amplitude amplitude(std::size_t quantity, const QuantityCard& card) const;

  const propagation::Experiment& experiment;
  const Simulator& simulator;
  const Points& at;
  const Observations& observations;
  const Signatures moved;
  const double step;      ///< change of the indications by a finite step, SI
  const BestStart choose; ///< empty: jumps are not crossed

private:
  /// On what its signature depends, by its course; of an effect or a quantity no more than what it can change with.
  std::vector<std::string> dependence_of(const Candidate& a) const;
  std::function<bool(const Candidate&)> skip_;
};

/// Effects of the catalogue, at every value of the grids of their shape quantities.
std::vector<Candidate> effect_candidates(const CandidateMaker& make);
/// Shifts of declared quantities, at all readings or at those that their entries and scopes distinguish.
std::vector<Candidate> declared_candidates(const CandidateMaker& make);
/// Effects stated as formulas.
std::vector<Candidate> stated_candidates(const CandidateMaker& make);
/// The candidates with whose sizes the readings jump, over sizes of both signs or in all directions of a pair.
std::vector<Candidate> jumping_candidates(const CandidateMaker& make, const std::vector<Candidate>& candidates);

} // namespace gumshoe::tracing
