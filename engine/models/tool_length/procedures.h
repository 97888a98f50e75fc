#pragma once
/// Procedures that measure a mill's length: joint evaluations, which use all readings of a tool together.
#include <array>
#include <string>
#include <vector>

#include "models/block.h"
#include "models/tool_length/curves.h"

namespace gumshoe::models::tool_length {

using Readings = Together<Rows, double>;

/// Result of simulate for a reading, with the true values for the procedures.
struct Shown : Simulated<Rows, double> {
  Event<double> event;
  int insert = 0; ///< insert that triggers
};

/// Rows of the measurands of single, slow, characteristic_curve and peaks.
struct FluteRows {
  double flute_length, wear_difference, seen;
};
struct LengthRows {
  double tool_length, effective_length;
};
struct CurveRows : LengthRows {
  double phase, seen_flutes, residual_rms, degrees_of_freedom;
  std::array<FluteRows, chain::most_inserts> flute;
};
struct PeakRows : LengthRows {
  double peaks;
  std::array<FluteRows, chain::most_inserts> flute;
};
static_assert(sizeof(CurveRows) == std::size(curve_cards) * sizeof(double));
static_assert(sizeof(PeakRows) == std::size(peak_cards) * sizeof(double));

/// single and slow: the measurement is one reading.
struct Single {
  template <class> using Measurands = LengthRows;
  struct Workspace {
    explicit Workspace(const Readings&) {}
    Heights heights;
  };
  template <class> using Memory = Workspace;
  static LengthRows evaluate(const Readings& all, Workspace& work, Outcome<double>& outcome);
  static LengthRows truth(const Readings& all, const std::vector<Shown>& shown, Outcome<double>& outcome);
  static std::string check(const Readings& all);
};

/// characteristic_curve: fits the model's curve and its phase.
struct Curve {
  template <class> using Measurands = CurveRows;
  struct Workspace {
    explicit Workspace(const Readings&) {}
    Heights heights;
    Curves curves;
    CurveReadings data;
  };
  template <class> using Memory = Workspace;
  static CurveRows evaluate(const Readings& all, Workspace& work, Outcome<double>& outcome);
  static CurveRows truth(const Readings& all, const std::vector<Shown>& shown, Outcome<double>& outcome);
  static std::string check(const Readings& all);
  /// Number of defined measurands: those of the existing flutes.
  static std::size_t in_use(const Quantities<double>& q);
};

/// peaks: readings connected by lines; the highest peaks are the flutes.
struct Peaks {
  template <class> using Measurands = PeakRows;
  template <class> using Memory = Single::Workspace;
  static PeakRows evaluate(const Readings& all, Single::Workspace& work, Outcome<double>& outcome);
  static PeakRows truth(const Readings& all, const std::vector<Shown>& shown, Outcome<double>& outcome);
  static std::string check(const Readings& all);
  static std::size_t in_use(const Quantities<double>& q);
};

} // namespace gumshoe::models::tool_length
