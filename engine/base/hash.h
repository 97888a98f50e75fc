#pragma once
/// A small, fixed 64-bit hash: keys of random streams and identifiers in files. Not cryptographic.
#include <cstdint>
#include <string_view>

namespace gumshoe {

/// The finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection whose every output bit
/// depends on every input bit.
std::uint64_t mix64(std::uint64_t x);

/// FNV-1a over the bytes, started from `seed`, finished by mix64. The same on every machine, and
/// part of the reproducibility promise: changing it changes every random number.
std::uint64_t hash64(std::string_view text, std::uint64_t seed = 0);

} // namespace gumshoe
