#pragma once
/// What the kernels compiled once per instruction set offer, and the table that picks one copy.
#include <array>
#include <cstddef>
#include <cstdint>

#include "base/instruction_set.h"
#include "random/latin_hypercube.h"
#include "random/streams.h"

namespace gumshoe::quantities {

/// Closed forms of quantile functions. y is the distance from the nearer end of the support, p the
/// smaller of u and 1 - u; s, a, b, c are the constants of the form.
enum class Form : int {
  constant,    ///< c0
  linear,      ///< c0 + c1 u
  curvilinear, ///< centre c0, half-widths c1 where flat and c2 at the base; flank root of p c3; top p c4
  trapezoid,   ///< ends c0, c1; flank probability c2; flank c3 sqrt(p); top c4 + c5 p
  arcsine,     ///< ends c0, c1; width c2
  normal,      ///< c0 + c1 z
  exponential, ///< -c0 ln(1 - u)
  lognormal,   ///< exp(c0 + c1 z)
  truncated,   ///< c0 + c1 z between c2 and c3; P below c4, above c5, between c6
  odd_table,   ///< c0 + c1 T, T odd in u - 1/2 (t)
  table,       ///< c0 + c1 X, separate tables of the lower and upper half (gamma)
};

/// Piecewise polynomials in p = min(u, 1 - u): the octaves of p, each in `pieces` equal parts, so
/// that the piece is read off the bits of p. Piece i has its coefficients at [i * (degree + 1)].
struct TableView {
  const double* lower = nullptr;
  const double* upper = nullptr;
  int log2_pieces = 0;
};
inline constexpr int table_degree = 8;
inline constexpr int table_octaves = 52; ///< p from 2^-53 up to 1/2

struct QuantileSpec {
  Form form = Form::constant;
  std::array<double, 8> c{};
  TableView table;
};

/// One copy of the kernels. n is a multiple of 8; out may be the input.
struct Kernels {
  void (*uniforms)(const random::Stream* stream, std::uint64_t first, std::size_t n, double* out);
  void (*latin_hypercube)(const random::Stream* stream, const random::Permutation* strata, std::uint64_t first,
                          std::size_t n, double* out);
  void (*quantile)(const QuantileSpec* spec, const double* u, double* out, std::size_t n);
  /// Standard normal distribution function, kept inside (0, 1): between 2^-1022 and 1 - 2^-53.
  void (*normal_probability)(const double* z, double* out, std::size_t n);
};

const Kernels& kernels(InstructionSet set);
const Kernels& kernels(); ///< of the best instruction set
/// From now on kernels() are those of `set`, which must be available. For tests, between runs.
void select_kernels(InstructionSet set);

} // namespace gumshoe::quantities
