#pragma once
/// Columns of a block call, sample by sample as numbers or as lanes.
#include <cstring>
#include <type_traits>
#include <vector>

#include "math/scalar.h"
#include "models/model.h"

namespace gumshoe::models::detail {

template <class T> T load(const Column& c, std::size_t i) {
  if constexpr (std::is_same_v<T, Lanes>)
    return c.stride == 0 ? Lanes(c.data[0]) : Lanes::load_unaligned(c.data + i);
  else
    return c.data[c.stride * i];
}
inline void store_at(const Lanes& value, double* to) { value.store_unaligned(to); }
inline void store_at(double value, double* to) { *to = value; }

/// Rows of columns, one per reading. Most readings share most columns: of each row, the columns unlike the row before.
class Columns {
public:
  struct Changed {
    std::size_t at; ///< in the row
    Column column;
  };
  Columns(const Column* columns, std::size_t readings, std::size_t row) : changed_(readings) {
    for (std::size_t r = 0; r < readings; ++r)
      for (std::size_t j = 0; j < row; ++j)
        if (const Column& c = columns[r * row + j]; r == 0 || !alike(c, columns[(r - 1) * row + j]))
          changed_[r].push_back({j, c});
  }
  const std::vector<Changed>& changed(std::size_t r) const { return changed_[r]; }
  /// Turns the values of the row before into those of row r, from sample i on.
  template <class T> void load(std::size_t r, std::size_t i, T* values) const {
    for (const auto& [at, column] : changed_[r]) values[at] = detail::load<T>(column, i);
  }

private:
  static bool alike(const Column& a, const Column& b) {
    if (a.stride != b.stride) return false;
    return a.data == b.data || (a.stride == 0 && std::memcmp(a.data, b.data, sizeof(double)) == 0);
  }
  std::vector<std::vector<Changed>> changed_; ///< by reading
};

} // namespace gumshoe::models::detail
