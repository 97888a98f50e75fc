#pragma once
/// The readings of one sample prepared for the procedures: heights with the effects removed, and trigger curves.
#include <list>
#include <vector>

#include "models/block.h"
#include "models/tool_length/curve_fit.h"
#include "models/tool_length/readout.h"

namespace gumshoe::models::tool_length {

/// One reading, effects removed.
struct Height {
  At<double> at; ///< tool_length is that of the reading
  Event<double> event;
  double height = 0; ///< of the spindle above the beam's axis at the trigger, m
};
using Heights = std::vector<Height>;

/// Fills in the heights of a sample. Refuses readings that differ in their inserts or are not finite.
void find_heights(const Together<Rows, double>& all, Heights& out, Outcome<double>& outcome);

/// Descent, m per rad.
double drop(const Height& r);
/// Position of the line on which a reading descends, m, up to a constant that all readings share.
double line_of(const Height& r);
/// Difference in length between the unworn tool and its longest flute, m.
double least_raise(const Height& r);

/// Trigger curves of the flutes. Equal ones are tabulated once, also from sample to sample.
class Curves {
public:
  /// Null if the flute never covers the beam.
  const TriggerCurve* at(const Insert<double>& insert, const Beam<double>& beam, double drop);
  /// Keeps the pointers of one sample alive.
  void next_sample() {
    if (known_.size() > 2 * chain::most_inserts) known_.clear();
  }

private:
  struct Known {
    Insert<double> insert;
    Beam<double> beam;
    double drop;
    TriggerCurve curve;
  };
  TriggerSolver solver_;
  std::list<Known> known_;
};

/// Collects the data of a fit. Returns false if a flute never covers the beam.
bool prepare(const Heights& all, Curves& curves, CurveReadings& data);

} // namespace gumshoe::models::tool_length
