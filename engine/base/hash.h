#pragma once
/// A small, fixed 64-bit hash: keys of random streams and identifiers in files. Not cryptographic.
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace gumshoe {

/// The finaliser of splitmix64 (Steele, Lea, Flood 2014): a bijection whose every output bit
/// depends on every input bit.
std::uint64_t mix64(std::uint64_t x);

/// FNV-1a over the bytes, started from `seed`, finished by mix64. The same on every machine, and
/// part of the reproducibility promise: changing it changes every random number.
std::uint64_t hash64(std::string_view text, std::uint64_t seed = 0);

/// Digests find damage in data that were written. The digest of a sequence is the sum, modulo 2^64, of splitmix64's
/// finaliser over its elements, each offset by its position; so parts are digested in any order, and their digests add up.
/// A single changed element changes it; other damage is missed with a probability of 2^-64. `first`: position of the
/// first element.
std::uint64_t digest64(const double* values, std::size_t count, std::uint64_t first = 0);
/// Digest of bytes: eight to an element, the last one filled with zeros.
std::uint64_t digest64(std::string_view bytes, std::uint64_t first = 0);

} // namespace gumshoe
