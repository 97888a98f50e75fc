#pragma once
/// What [trace] says of the data in which an undeclared effect is sought, and effects stated as formulas.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "quantities/input_quantity.h"

namespace gumshoe::scenario {

/// A quantity recorded with the readings, such as a temperature or an order. One value per reading, SI (the mean over
/// its repeats).
struct TraceColumn {
  std::string name, unit, si_unit;
  std::vector<double> values;
};

/// What a stated effect adds to: an indication, or a quantity of the model that depends on a condition.
struct StatedPart {
  std::size_t target = 0;      ///< indication, or quantity, by position in the model's card
  bool on_quantity = false;    ///< it adds to a quantity
  std::string formula;         ///< as written; "table of position" of a table
  std::vector<double> loading; ///< the formula's value at each reading, SI
  /// The formula at other conditions (by position in the model's card) and columns (as TraceOptions::columns), SI.
  std::function<double(const std::vector<double>& conditions, const std::vector<double>& columns)> loading_at;
};

/// An effect that a scenario states: its size times a formula of conditions and columns adds to an indication, to
/// several by a formula each, or to a quantity of the model (the error of a rotary axis, say). Without a size it stands
/// at its null value, zero, and is a candidate of tracing; with one it is an input quantity "NAME.size" like any other,
/// after the indications' noise among Scenario::quantities.
struct StatedEffect {
  std::string name, meaning, source;
  std::vector<StatedPart> parts;
  std::string unit, si_unit; ///< of the size
  bool freed = false;
  bool of_columns = false; ///< a formula reads columns
};

/// In place of a condition that gives the order of measurement.
inline constexpr const char* unknown_order = "unknown";

struct TraceOptions {
  bool stated = false;                   ///< the scenario has [trace]
  std::string blocks;                    ///< label whose values are blocks; empty: none
  std::vector<std::string> final_blocks; ///< kept apart until the end; empty: chosen by rule
  std::vector<double> order;             ///< of measurement, by reading; empty: as the readings stand
  std::string order_name;                ///< condition or column that gives it
  bool order_known = true; ///< else readings stand as they were sorted: nothing is told by what was before
  std::vector<TraceColumn> columns;
  /// Sets of labels that stand for one act done anew: { rod, setup } is a clamping. What it leaves behind may scatter.
  /// Not stated: every set of one or two labels with at least six combinations. Empty: no act was done anew.
  std::optional<std::vector<std::vector<std::string>>> redone;
  /// Quantities whose stated values come from these data: fitted anew without a prior, as if marked estimated.
  std::vector<std::string> free;
  /// Quantities as they were known before these data, of which the scenario states what is known with them: tracing
  /// these data starts from here.
  std::vector<quantities::InputQuantity> priors;
  /// Effects that an earlier trace added and its hold-out blocks could neither confirm nor reject.
  std::vector<std::string> unconfirmed;
  /// Sizes that an earlier trace found where readings jump, by quantity, and how large: of a pair the length of both,
  /// of a declared quantity its shift. No derivative leads to better ones.
  std::vector<std::pair<std::string, double>> jumping;
  double alpha = 0.05; ///< chance that anything is found where nothing is
  int draws = 999;     ///< of the parametric bootstrap
  std::uint64_t seed = 1;
};

} // namespace gumshoe::scenario
