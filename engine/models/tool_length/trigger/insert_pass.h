#pragma once
/// A rigorous search in the windows of one insert (insert_windows.h) for its first trigger, with all that is tried
/// where the plain proof does not hold: tangents, halves of stretches, bounds on what the flank may add.
#include <optional>

#include "models/tool_length/trigger/insert_lines.h"
#include "models/tool_length/trigger/insert_sharpen.h"

namespace gumshoe::models::tool_length {

class InsertPass : public InsertWindows<double> {
public:
  using Window = WindowOf<double>;
  using Crest = CrestOf<double>;
  using Crossing = CrossingOf<double>;

  InsertPass(const InsertBody<double>& body, const DiscShare& disc) : InsertWindows(body, disc), lines_(body, disc) {}
  int size() const { return window(0).exists + window(1).exists; }
  /// Lowers the windows' own `highest` to about `margin` above their crests where that can be proved.
  void lower(double margin);
  /// Lowers windows whose crests lie further than `far` below `highest()` to near their crests where that is proved:
  /// once for a geometry, whatever the windows.
  void lower_far(double far);
  /// Both, so that turns of a descent by `whole` that no insert reaches are passed at once.
  bool sharpen(double far, double whole) {
    lower_far(far);
    if (slack() > whole) lower(0.1 * whole);
    return true;
  }

  /// The first angle turned from `first` to `last` with k(angle) >= level - fall turned in a window, where the angle is
  /// turned - shift.
  Crossing first_crossing(bool wanted, const Window& w, double level, double fall, double shift, double first,
                          double last) const;

  const InsertLines& lines() const { return lines_; }
  /// True only if k(angle) + fall (angle - from) < limit at all angles from `from` to `to`: by tangents, or by Phi.
  bool below(double from, double to, double fall, double limit) const;

private:
  Crossing search(const Crest& crest, double level, double fall, double shift, double first, double last,
                  double more = 0) const;
  bool cleared(const Window& w, double from, double to, double facing, double fall, double limit) const;
  InsertLines lines_;
  std::array<std::optional<TopOf<double>>, 2> top_; ///< of the geometry alone
};

} // namespace gumshoe::models::tool_length
