#pragma once
/// Steps in the order of measurement, of all readings or of one part of a label, whiles between two of them, and bends.
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tracing/candidates/forms.h"

namespace gumshoe::tracing {

/// All readings, or those of one part.
struct Members {
  const Grouping* label = nullptr; ///< null: all readings
  std::size_t group = 0;
  bool holds(std::size_t reading) const { return !label || label->group[reading] == group; }
};

/// From this place in the sequence on, of all readings or those of one part; or up to another place, which it is
/// without.
struct Stretch {
  Index from = 0;
  Members part = {};
  Index until = std::numeric_limits<Index>::max();
};

/// The columns of stretches, of one indication: zero elsewhere, and one within; or, of bends, a straight line in time
/// from zero at the last reading before on.
class Steps {
public:
  Steps(const Observations& observations, std::size_t indication);
  /// Bends. @param time  by place in the sequence
  Steps(const Observations& observations, std::size_t indication, Vector time);
  Matrix columns(std::span<const Stretch> stretches) const;
  /// The one of some that explains most.
  Stretch best(const std::vector<Stretch>& some, const Gain& gain) const;

private:
  const Observations& o_;
  Index indication_;
  Vector time_; ///< empty: of steps
};

/// Places in the sequence where a step may begin, with a few fitted readings before and after; of a part, whose
/// readings seldom follow one another, with two of its own.
/// @param rows  of the readings that are fitted, in the order of measurement
std::vector<Stretch> steps(const Observations& observations, const std::vector<Index>& rows, const Members& part = {});
/// The same for every part in turn: one tool was hit, one artefact slipped.
std::vector<Stretch> steps_of_parts(const Observations& observations, const std::vector<Index>& rows,
                                    const Grouping& label);
/// Those at which a block begins.
std::vector<Stretch> at_beginnings_of_blocks(const Observations& observations, const std::vector<Stretch>& steps);

/// What readings may have had for a while: something, or one part, was changed or moved, and put back. Stretches of at
/// least two fitted readings, with one before and one after; where there are blocks they begin and end between blocks,
/// and those of all readings are longer than one.
class Whiles {
public:
  /// @param label  the while of one of its parts, each in turn; null: of all readings
  Whiles(const Observations& observations, const std::vector<Index>& rows, const Grouping* label);
  /// All there are, of which the best counts as the best of so many.
  std::size_t number() const;
  /// The one that explains most: of a grid of ends, then of all near its ends, one end after the other. Without a
  /// value: there is none.
  std::optional<Stretch> best(const Steps& steps, const Gain& gain) const;

private:
  struct End {
    std::size_t before; ///< fitted readings before it
    Index place;
  };
  /// Those of all readings, or of one part.
  struct Ends {
    Members part;
    std::size_t least = 1; ///< ends from the first to the last
    std::vector<End> at;

    std::size_t stride() const;
    bool is_one(std::size_t i, std::size_t j) const;
    Stretch between(std::size_t i, std::size_t j) const { return {at[i].place, part, at[j].place}; }
    /// Those whose ends lie so near to this one's, itself among them.
    std::vector<Stretch> near(const Stretch& one, std::size_t from, std::size_t until) const;
  };

  std::vector<Ends> ends_;
};

/// The place of the last reading of a part before a place.
Index place_before(const Observations& observations, Index place, const Members& part);
/// That reading, counted from 1.
std::size_t last_before(const Observations& observations, Index place, const Members& part);

} // namespace gumshoe::tracing
