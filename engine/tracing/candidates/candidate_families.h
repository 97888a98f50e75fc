#pragma once
/// How candidates are made: what every family of them goes through, and one function a family.
#include "tracing/candidates/candidates.h"
#include "tracing/candidates/signatures.h"

namespace gumshoe::tracing {

/// Makes candidates at a point; `step` and `skip` as of physical_candidates.
class CandidateMaker {
public:
  CandidateMaker(const propagation::Experiment& experiment, const Simulator& simulator, const Points& at,
                 const Observations& observations, double step, const std::function<bool(const Candidate&)>& skip);

  /// Adds a candidate to its family unless it is skipped, moves nothing, or equals one of its name already there.
  void add(Candidate a, std::vector<Candidate>& family) const;
  /// Adds a candidate of a single amplitude: by its tangent, then by finite steps where those differ from it.
  /// @param mask  readings at which it acts; null: all
  void add_single(Candidate a, std::size_t quantity, const std::vector<bool>* mask,
                  std::vector<Candidate>& family) const;
  Amplitude amplitude(std::size_t quantity, const QuantityCard& card) const;

  const propagation::Experiment& experiment;
  const Simulator& simulator;
  const Points& at;
  const Observations& observations;
  const Signatures moved;

private:
  double step_;
  const std::function<bool(const Candidate&)>& skip_;
};

/// Effects of the catalogue, at every value of their shape quantities' grids.
std::vector<Candidate> effect_candidates(const CandidateMaker& make);
/// Declared quantities that are off, at all readings or where their entries and scopes tell readings apart.
std::vector<Candidate> declared_candidates(const CandidateMaker& make);
/// Formulas that the user states.
std::vector<Candidate> stated_candidates(const CandidateMaker& make);

} // namespace gumshoe::tracing
