#pragma once
/// The way in which a sequence of numbers goes.
#include <span>
#include <vector>

namespace gumshoe {

/// For each number 1 if the sequence rises to it, -1 if it falls. The first has the way to the next; of equal ones in a
/// row, where the sequence turns, the first half has the way to them and the rest the way on. Where two thirds of the
/// steps go to the next level, one over more than half of all levels, and over two, starts anew: a pass that goes up, and
/// up again, has one way. 0 where nothing moves.
std::vector<double> senses(std::span<const double> x);

} // namespace gumshoe
