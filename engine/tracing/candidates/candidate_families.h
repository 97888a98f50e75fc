#pragma once
/// How candidates are made: what every family of them goes through, and one function a family.
#include "tracing/candidates/candidates.h"
#include "tracing/candidates/signatures.h"

namespace gumshoe::tracing {

/// Makes candidates at a point; `step` and `skip` as of physical_candidates.
class CandidateMaker {
public:
  CandidateMaker(const propagation::Experiment& experiment, const Simulator& simulator, const Points& at,
                 const Observations& observations, double step, const std::function<bool(const Alternative&)>& skip);

  /// Adds it to its family unless it is skipped, moves nothing, or is the same as one of its name already there.
  void add(Alternative a, std::vector<Alternative>& family) const;
  /// One of a single amplitude: by its tangent, then by what differs from it over finite steps. Of the readings of
  /// `mask`, or of all.
  void add_single(Alternative a, std::size_t quantity, const std::vector<bool>* mask,
                  std::vector<Alternative>& family) const;
  Amplitude amplitude(std::size_t quantity, const QuantityCard& card) const;

  const propagation::Experiment& experiment;
  const Simulator& simulator;
  const Points& at;
  const Observations& observations;
  const Signatures moved;

private:
  double step_;
  const std::function<bool(const Alternative&)>& skip_;
};

/// Effects of the catalogue, at every value of their shape quantities' grids.
std::vector<Alternative> effect_candidates(const CandidateMaker& make);
/// Declared quantities that are off, at all readings or where their entries and scopes tell readings apart.
std::vector<Alternative> declared_candidates(const CandidateMaker& make);
/// Formulas of the user's.
std::vector<Alternative> stated_candidates(const CandidateMaker& make);

} // namespace gumshoe::tracing
