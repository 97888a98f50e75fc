#include "base/hash.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace gumshoe {

std::uint64_t mix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

std::uint64_t hash64(std::string_view text, std::uint64_t seed) {
  // The seed is mixed first, or seeds 0, 1, 2 would start from nearly the same state.
  std::uint64_t h = 0xcbf29ce484222325u ^ (seed == 0 ? 0 : mix64(seed));
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return mix64(h);
}

namespace {
// The multiplier is odd and without structure: positions differ in all bits.
std::uint64_t element(std::uint64_t word, std::uint64_t position) {
  return mix64(word + position * 0xd6e8feb86659fd93u);
}
} // namespace

std::uint64_t digest64(const double* values, std::size_t count, std::uint64_t first) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += element(std::bit_cast<std::uint64_t>(values[i]), first + i);
  return sum;
}

std::uint64_t digest64(std::string_view bytes, std::uint64_t first) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
    sum += element(word, first + i / 8);
  }
  return sum;
}

} // namespace gumshoe
