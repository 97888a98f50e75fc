/// Compiled once per instruction set: rows in blocks that stay in the cache, and in each block tiles of the product
/// that stay in the registers. A number of the product is the sum over blocks, in order, of the sums over their rows,
/// in order.
#include <algorithm>
#include <vector>

#include "math/lanes.h"
#include "math/products_kernels.h"

namespace gumshoe {
namespace {

constexpr std::size_t block = 256, vectors = 2, high = vectors * Lanes::size, wide = 6;

/// Columns side by side, by row, padded with zeros to `count`.
void pack(const double* from, std::size_t stride, std::size_t rows, std::size_t columns, std::size_t count,
          double* to) {
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t r = 0; r < rows; ++r) to[r * count + j] = j < columns ? from[j * stride + r] : 0;
}

/// c += a'b of one tile; c has columns of length `stride`, of which `m` x `n` numbers count.
void tile(std::size_t rows, const double* a, const double* b, double* c, std::size_t stride, std::size_t m,
          std::size_t n) {
  Lanes sum[wide][vectors];
#pragma GCC unroll 6
  for (auto& column : sum)
#pragma GCC unroll 2
    for (auto& s : column) s = Lanes(0.0);
  for (std::size_t r = 0; r < rows; ++r, a += high, b += wide) {
    const Lanes first = Lanes::load_unaligned(a), second = Lanes::load_unaligned(a + Lanes::size);
#pragma GCC unroll 6
    for (std::size_t j = 0; j < wide; ++j) {
      const Lanes factor(b[j]);
      sum[j][0] += first * factor;
      sum[j][1] += second * factor;
    }
  }
  double out[wide][high];
#pragma GCC unroll 6
  for (std::size_t j = 0; j < wide; ++j)
#pragma GCC unroll 2
    for (std::size_t v = 0; v < vectors; ++v) sum[j][v].store_unaligned(out[j] + v * Lanes::size);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < m; ++i) c[j * stride + i] += out[j][i];
}

void transposed(std::size_t rows, std::size_t m, std::size_t n, const double* a, const double* b, double* c) {
  const std::size_t panels = (m + high - 1) / high;
  // All columns of `a` for some rows: some hundred of them fit into the second cache.
  std::vector<double> packed_a(panels * high * block), packed_b(wide * block);
  for (std::size_t row = 0; row < rows; row += block) {
    const std::size_t length = std::min(block, rows - row);
    for (std::size_t p = 0; p < panels; ++p)
      pack(a + p * high * rows + row, rows, length, std::min(high, m - p * high), high,
           packed_a.data() + p * high * block);
    for (std::size_t j = 0; j < n; j += wide) {
      const std::size_t across = std::min(wide, n - j);
      pack(b + j * rows + row, rows, length, across, wide, packed_b.data());
      for (std::size_t p = 0; p < panels; ++p)
        tile(length, packed_a.data() + p * high * block, packed_b.data(), c + j * m + p * high, m,
             std::min(high, m - p * high), across);
    }
  }
}

} // namespace
} // namespace gumshoe

extern "C" const gumshoe::ProductKernels GUMSHOE_KERNEL(gumshoe_products_);
const gumshoe::ProductKernels GUMSHOE_KERNEL(gumshoe_products_) = {gumshoe::transposed};
