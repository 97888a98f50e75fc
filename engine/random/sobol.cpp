#include "random/sobol.h"

#include <bit>
#include <vector>

#include <boost/random/sobol.hpp>

#include "base/hash.h"
#include "random/philox.h"

namespace gumshoe::random {
namespace {

using Directions = std::array<std::uint64_t, 64>;

/// Boost keeps its direction numbers to itself but its engine can jump: point g of its Gray-code
/// order is the sum over the bits of g ^ g/2, so point 2^j is direction j plus direction j - 1.
std::vector<Directions> extract_directions() {
  boost::random::sobol engine(sobol_dimensions);
  std::vector<Directions> directions(sobol_dimensions, Directions{});
  for (unsigned j = 0; j < 62; ++j) {         // more points than anybody draws
    engine.seed((std::uint64_t{1} << j) - 1); // the engine leaves out point 0, so its element k is point k + 1
    for (Directions& d : directions) d[j] = engine() ^ (j > 0 ? d[j - 1] : 0);
  }
  return directions;
}

const Directions& directions_of(std::uint32_t dimension) {
  static const std::vector<Directions> all = extract_directions();
  return all.at(dimension);
}

} // namespace

SobolDimension::SobolDimension(std::uint32_t dimension) : direction_(directions_of(dimension)) { tabulate(); }

SobolDimension::SobolDimension(std::uint32_t dimension, std::uint64_t scramble_key)
    : direction_(directions_of(dimension)) {
  // Row r of the scramble: ones on the diagonal, random bits for the more significant digits.
  std::array<std::uint64_t, 64> rows;
  for (unsigned r = 0; r < 64; ++r) {
    const std::uint64_t diagonal = std::uint64_t{1} << (63 - r);
    const std::uint64_t above = r == 0 ? 0 : ~std::uint64_t{0} << (64 - r);
    rows[r] = diagonal | (mix64(scramble_key + r * 0x9e3779b97f4a7c15u) & above);
  }
  for (std::uint64_t& v : direction_) {
    std::uint64_t scrambled = 0;
    for (unsigned r = 0; r < 64; ++r)
      scrambled |= static_cast<std::uint64_t>(std::popcount(rows[r] & v) & 1) << (63 - r);
    v = scrambled;
  }
  shift_ = mix64(~scramble_key);
  tabulate();
}

void SobolDimension::tabulate() {
  for (unsigned i = 0; i < 64; ++i) {
    low_[i] = 0;
    for (unsigned j = 0; j < 6; ++j)
      if (i >> j & 1) low_[i] ^= direction_[j];
  }
}

void SobolDimension::operator()(std::uint64_t first, std::size_t n, double* out) const {
  for (std::size_t i = 0; i < n; i += 64) {
    std::uint64_t base = shift_;
    for (std::uint64_t rest = (first + i) >> 6, j = 6; rest != 0; rest >>= 1, ++j)
      if (rest & 1) base ^= direction_[j];
    const std::size_t end = n - i < 64 ? n - i : 64;
    for (std::size_t k = 0; k < end; ++k) out[i + k] = unit_from_bits(base ^ low_[k]);
  }
}

} // namespace gumshoe::random
