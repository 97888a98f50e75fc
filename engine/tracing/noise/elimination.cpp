#include "tracing/noise/elimination.h"

#include <algorithm>
#include <cmath>

#include "base/kernel_choice.h"

GUMSHOE_DECLARE_KERNELS(gumshoe::tracing::EliminationKernels, elimination)

namespace gumshoe::tracing {

const EliminationKernels& elimination_kernels() { return *GUMSHOE_BEST_KERNELS(elimination); }

namespace {

/// a x + b y, without what is zero.
SparseRow combined(double a, const SparseRow& x, double b, const SparseRow& y) {
  SparseRow out;
  for (const auto& [column, value] : x) out.push_back({column, a * value});
  for (const auto& [column, value] : y) {
    const auto same = std::ranges::find_if(out, [&](const auto& e) { return e.first == column; });
    if (same == out.end())
      out.push_back({column, b * value});
    else
      same->second += b * value;
  }
  std::erase_if(out, [](const auto& e) { return e.second == 0; });
  std::ranges::sort(out);
  return out;
}

} // namespace

std::vector<SparseRow> decorrelated(const std::vector<SparseRow>& rows, const Serial& serial) {
  const double rho = serial.correlation, factor = 1 / std::sqrt(1 - rho * rho);
  if (rho == 0) return rows;
  std::vector<SparseRow> out;
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.push_back(i < serial.lag ? rows[i] : combined(factor, rows[i], -rho * factor, rows[i - serial.lag]));
  return out;
}

/// The triangular factor of the columns that are open while the rows pass, each in a slot.
class Elimination::Open {
public:
  Open(Elimination& to, std::size_t free, std::vector<std::size_t> last)
      : to_(to), free_columns_(free), last_(std::move(last)), slot_of_(last_.size(), none) {}

  void open(std::size_t column) {
    if (slot_of_[column] != none) return;
    if (free_.empty()) {
      free_.push_back(index(to_.slots_++));
      const Index size = index(to_.slots_);
      if (factor_.rows() < size) factor_.conservativeResizeLike(ByRow::Zero(2 * size, 2 * size));
      row_.resize(to_.slots_, 0);
    }
    const Index slot = free_.back();
    free_.pop_back();
    slot_of_[column] = slot;
    factor_.row(slot).setZero();
    factor_.col(slot).setZero();
    factor_(slot, slot) = column < free_columns_ ? 0 : 1;
    const auto order = [&](std::size_t j) { return std::pair(last_[j], j); };
    columns_.insert(std::ranges::upper_bound(columns_, order(column), {}, order), column);
    to_.opened_.push_back(static_cast<std::uint32_t>(slot));
  }

  void rotate(const SparseRow& row) {
    for (const auto& [column, value] : row) row_[index(slot_of_[column])] += value;
    slots_.clear();
    for (const std::size_t column : columns_) slots_.push_back(slot_of_[column]);
    for (std::size_t i = 0; i < slots_.size(); ++i) {
      const Index slot = slots_[i];
      double& own = row_[index(slot)];
      if (std::fabs(own) < to_.negligible_) own = 0; // rotated again and again by angles of rounding
      if (own == 0) continue;
      const double before = factor_(slot, slot), length = std::sqrt(before * before + own * own);
      const double c = before / length, s = own / length;
      factor_(slot, slot) = length;
      own = 0;
      double* const pivot = factor_.row(slot).data();
      for (std::size_t j = i + 1; j < slots_.size(); ++j) {
        const Index other = slots_[j];
        double &x = pivot[other], &y = row_[index(other)];
        const double z = x;
        x = c * z + s * y;
        y = c * y - s * z;
      }
      to_.slot_.push_back(static_cast<std::uint32_t>(slot));
      to_.cosine_.push_back(c);
      to_.sine_.push_back(s);
    }
  }

  /// Those that no later row moves; they come first.
  void close(std::size_t row) {
    std::size_t done = 0;
    for (; done < columns_.size() && last_[columns_[done]] == row; ++done) {
      const std::size_t column = columns_[done];
      const Index slot = slot_of_[column];
      Pivot pivot{index(column), factor_(slot, slot), {}};
      for (std::size_t j = done + 1; j < columns_.size(); ++j)
        if (const double x = factor_(slot, slot_of_[columns_[j]]); x != 0)
          pivot.right.push_back({index(columns_[j]), x});
      to_.pivots_.push_back(std::move(pivot));
      to_.closed_.push_back(static_cast<std::uint32_t>(slot));
      free_.push_back(slot);
    }
    columns_.erase(columns_.begin(), columns_.begin() + static_cast<std::ptrdiff_t>(done));
  }

private:
  static constexpr Index none = -1;
  Elimination& to_;
  std::size_t free_columns_;
  std::vector<std::size_t> last_; ///< by column: the last row that it moves
  std::vector<Index> slot_of_;    ///< by column
  std::vector<Index> free_;       ///< slots
  std::vector<std::size_t> columns_;
  std::vector<Index> slots_; ///< of these
  std::vector<double> row_;  ///< by slot
  ByRow factor_;             ///< [slot][slot]
};

Elimination::Elimination(const std::vector<SparseRow>& correlated, std::size_t columns, std::size_t free,
                         const Serial& serial, double negligible)
    : serial_(serial), negligible_(negligible), columns_(columns), log_pivot_(columns, 0) {
  const auto rows = decorrelated(correlated, serial);
  std::vector<std::size_t> last(columns, 0);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const auto& [column, value] : rows[i]) last[column] = i;
  Open open(*this, free, std::move(last));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const auto& [column, value] : rows[i]) open.open(column);
    open.rotate(rows[i]);
    open.close(i);
    opened_end_.push_back(static_cast<std::uint32_t>(opened_.size()));
    rotation_end_.push_back(static_cast<std::uint32_t>(slot_.size()));
    closed_end_.push_back(static_cast<std::uint32_t>(closed_.size()));
  }
  for (const Pivot& p : pivots_) log_pivot_[index(p.column)] = std::log(std::fabs(p.value));
}

std::vector<std::size_t> Elimination::explained(double length) const {
  std::vector<bool> own(columns_, false);
  for (const Pivot& p : pivots_) own[index(p.column)] = std::fabs(p.value) > length;
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < columns_; ++j)
    if (!own[j]) out.push_back(j);
  return out;
}

EliminationPlan Elimination::plan() const {
  return {opened_end_.size(), slots_,       serial_.lag,          serial_.correlation, opened_.data(),
          opened_end_.data(), slot_.data(), rotation_end_.data(), closed_.data(),      closed_end_.data(),
          cosine_.data(),     sine_.data()};
}

std::vector<double> Elimination::state() const {
  return std::vector<double>((slots_ + serial_.lag) * elimination_lanes);
}

template <class Body> void Elimination::by_blocks(const Matrix& x, const Body& body) const {
  for (Index first = 0; first < x.cols();) {
    const bool few = x.cols() - first <= index(few_elimination_lanes);
    const Index lanes = index(few ? few_elimination_lanes : elimination_lanes),
                count = std::min(lanes, x.cols() - first);
    Matrix block = Matrix::Zero(lanes, x.rows());
    block.topRows(count) = x.middleCols(first, count).transpose();
    body(first, count, block);
    first += count;
  }
}

Matrix Elimination::reduced(Matrix x) const {
  std::vector<double> state = this->state();
  by_blocks(x, [&](Index first, Index count, Matrix& block) {
    elimination_kernels().reduce(plan(), index(block.rows()), block.data(), state.data(), nullptr);
    x.middleCols(first, count) = block.topRows(count).transpose();
  });
  return x;
}

Vector Elimination::squares(const Matrix& x) const {
  Vector out(x.cols());
  std::vector<double> state = this->state();
  by_blocks(x, [&](Index first, Index count, Matrix& block) {
    elimination_kernels().reduce(plan(), index(block.rows()), block.data(), state.data(), nullptr);
    Vector sum = Vector::Zero(block.rows()); // row after row: the same in blocks of any width
    for (Index row = 0; row < block.cols(); ++row) sum.array() += block.col(row).array().square();
    out.segment(first, count) = sum.head(count);
  });
  return out;
}

Matrix Elimination::projected(Matrix x) const {
  std::vector<double> state = this->state();
  by_blocks(x, [&](Index first, Index count, Matrix& block) {
    elimination_kernels().reduce(plan(), index(block.rows()), block.data(), state.data(), nullptr);
    std::ranges::fill(state, 0);
    elimination_kernels().restore(plan(), index(block.rows()), block.data(), state.data());
    x.middleCols(first, count) = block.topRows(count).transpose();
  });
  return x;
}

Matrix Elimination::solved(const Matrix& x) const {
  ByRow out = ByRow::Zero(index(columns_), x.cols());
  std::vector<double> state = this->state(), kept(closed_.size() * elimination_lanes);
  by_blocks(x, [&](Index first, Index count, Matrix& block) {
    elimination_kernels().reduce(plan(), index(block.rows()), block.data(), state.data(), kept.data());
    for (std::size_t i = 0; i < pivots_.size(); ++i)
      for (Index j = 0; j < count; ++j) out(pivots_[i].column, first + j) = kept[i * index(block.rows()) + index(j)];
  });
  substitute(out);
  return out;
}

void Elimination::substitute(ByRow& x) const {
  for (auto p = pivots_.rbegin(); p != pivots_.rend(); ++p) {
    for (const auto& [column, value] : p->right) x.row(p->column) -= value * x.row(column);
    if (p->value == 0)
      x.row(p->column).setZero();
    else
      x.row(p->column) /= p->value;
  }
}

void Elimination::substitute_transposed(ByRow& x) const {
  for (const Pivot& p : pivots_) {
    if (p.value == 0)
      x.row(p.column).setZero();
    else
      x.row(p.column) /= p.value;
    for (const auto& [column, value] : p.right) x.row(column) -= value * x.row(p.column);
  }
}

Matrix Elimination::covariance(Index count) const {
  ByRow x = ByRow::Identity(index(columns_), count);
  substitute_transposed(x);
  substitute(x);
  const Matrix out = x.topRows(count);
  return (out + out.transpose()) / 2; // equal to the last bit
}

} // namespace gumshoe::tracing
