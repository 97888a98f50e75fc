#include "base/hash.h"

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

} // namespace gumshoe
