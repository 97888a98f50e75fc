#pragma once
/// Descents of a characteristic curve's sum of squares (curve_fit.h) to its minima between and across the jumps.
/// Several go side by side, so that all their readings are looked up in the curves together, in full lanes.
#include <array>
#include <cmath>
#include <vector>

#include "models/tool_length/curve_fit.h"

namespace gumshoe::models::tool_length {

/// Error of the tabulated curves, squared.
inline constexpr double curve_rounding = 2.5e-21;
/// Minima nearer than this are one, m.
inline constexpr double one_minimum = 1e-9;

using Flutes = std::array<bool, chain::most_inserts>;

class CurveDescents {
public:
  /// Phase u, then for each flute a_k = u - H_k: u shifts all indications alike, and a flute's curve jumps at values of
  /// its own a_k, whatever the rest.
  using Unknowns = std::array<double, chain::most_inserts + 1>;
  struct Candidate {
    Unknowns x{};
    double squares = 1e300;
  };

  /// `readings` must outlive it.
  explicit CurveDescents(const CurveReadings& readings);
  Flutes active{}; ///< the others do not exist

  /// At each phase, every flute as long as the readings allow: none may trigger more than `margin` before its reading.
  std::vector<Candidate> longest(const std::vector<double>& phases, double margin) const;
  /// The residuals at x, by reading.
  std::vector<double> residuals(const Unknowns& x);
  /// Heights at which an unworn flute in this seat triggers when its lines are shifted by `begin`, by reading.
  void triggers(std::size_t flute, double begin, std::vector<double>& out);
  /// Each down to the minimum between the jumps around it.
  void settle(std::vector<Candidate>& candidates);
  /// The same, then across the jumps nearby as long as that helps, or until it comes to where an earlier descent began
  /// a round: that one has gone on from there. False if the steps do not end.
  bool descend(Candidate& c);

private:
  /// Between which values of a_k no indication jumps.
  struct Box {
    std::array<double, chain::most_inserts> low, high;
  };
  struct Residual {
    double value, slope;
    std::size_t flute; ///< that makes the reading
  };
  struct Look {
    std::vector<Residual> residuals;
    Box box;
  };
  /// One descent between jumps, by Gauss-Newton steps.
  struct Descent {
    Candidate c, start, next; ///< where it is, where the step began, and where it looks
    Look now, trial;          ///< at c and at next
    Unknowns step;
    double before = 0, promised = 0,
           share = 1; ///< of a step: squares before it, the gain that it promises, the part taken
    int steps = 0;
    bool done = false, settled = false;
  };

  Descent& descent(std::size_t i, const Candidate& from);
  void run(std::size_t descents, double limit);
  void begin_step(Descent& d, double limit) const;
  void go_on(Descent& d, double limit) const;
  void look(const std::vector<Descent*>& descents);
  void make_room(std::size_t places);
  void look_up(std::size_t first, std::size_t last);
  double judge(const Unknowns& x, std::size_t first, Look& out) const;
  double best_step(const Candidate& c, const Look& at, Unknowns& step) const;
  bool known(const Candidate& c) const;

  const CurveReadings& d_;
  std::vector<double> lines_;             ///< [flute][reading]
  std::vector<const CurveTable*> tables_; ///< likewise
  bool one_curve_ = true;
  std::vector<Descent> descents_;
  std::vector<Descent*> looking_;
  std::vector<std::pair<Flutes, Candidate>> known_; ///< where rounds began
  std::vector<double> places_, rows_;               ///< [descent][flute][reading]; five such rows
  CurvePoints points_{};                            ///< those rows
};

} // namespace gumshoe::models::tool_length
