#include "tracing/noise/pure_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include "math/variance_ratio.h"
#include "propagation/parallel.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr double negligible_share = 1e-9;

/// @param rows  of the readings whose cell has others: nothing is left of one that is alone
double scale_in_cells(const Vector& residual, const std::vector<Index>& rows, double freedom, double least) {
  std::vector<double> sizes;
  for (const Index i : rows) sizes.push_back(std::fabs(residual[i]));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  const double lost = freedom / static_cast<double>(sizes.size());
  const double robust = std::max(least, *middle / 0.6744897501960817 / std::sqrt(lost));
  const double rms = residual.norm() / std::sqrt(freedom);
  return robust > negligible_share * rms ? robust : rms;
}

} // namespace

double PureError::least_freedom() { return criteria.least_pure_freedom; }

Matrix PureError::whitened(const Matrix& residuals) const {
  Matrix out = residuals;
  const auto k = index(design_.indications);
  for (Index i = 0; i < out.rows(); i += k)
    design_.local[index(rows_[index(i)] / k)].triangularView<Eigen::Lower>().solveInPlace(out.middleRows(i, k));
  return out;
}

Projection PureError::without(const SparseColumns& columns) const { return {columns.rows(), columns.count(), orders_}; }

PureError::PureError(const Design& d, const std::vector<Index>& rows, const Replicates& replicates, int threads,
                     const CovarianceModel& model)
    : design_(d), rows_(rows), replicates_(replicates), threads_(threads), orders_(2), nuisance_(d, rows_) {
  const auto cell_of = [&](Index i) { return replicates.cell[index(rows_[index(i)]) / d.indications]; };
  for (auto& order : orders_) order.resize(rows.size()), std::iota(order.begin(), order.end(), Index{0});
  std::ranges::stable_sort(orders_[1], {}, cell_of);
  for (Index i = 0; i < index(rows.size()); ++i)
    if (cell_mates(i).size() > d.indications) together_.push_back(i);
  nuisance_.add(d.fixed);
  nuisance_.add(d.random);
  SparseColumns drifts = nuisance_;
  if (replicates.passes_are_blocks) nuisance_.add_constants(replicates.pass);
  drifts.add_constants(replicates.pass);
  drifts.add_lines(replicates.pass, 0);
  if (model.scatter >= 0) {
    const Grouping& g = d.scatter[index(model.scatter)];
    std::vector<std::size_t> group;
    for (std::size_t i = 0; i < d.reading.size(); i += d.indications) group.push_back(g.group[d.reading[i]]);
    drifts.add_constants(group);
  }
  drifts.add_constants(replicates.cell);
  SparseColumns lines = drifts;
  lines.add_lines(replicates.cell, criteria.repeats_for_line);
  pure_ = without(lines);
  if (freedom() < least_freedom()) pure_ = without(drifts);
  without_ = with_ = without(nuisance_);
  if (!known()) return;
  SparseColumns cells = nuisance_;
  cells.add_constants(replicates.cell);
  with_ = without(cells);
  std::set<std::size_t> met;
  for (Index i = 0; i < index(rows.size()); ++i) met.insert(cell_of(i));
  cells_ = met.size();
}

void PureError::by_sets(Index sets, const std::function<void(Index, Index)>& body) const {
  constexpr Index together = 2 * static_cast<Index>(elimination_lanes);
  propagation::parallel_for(index((sets + together - 1) / together), threads_, [&](std::size_t i) {
    const Index first = index(i) * together;
    body(first, std::min(together, sets - first));
  });
}

Vector PureError::squares(const Projection& projection, const Matrix& data) const {
  Vector out(data.cols());
  by_sets(data.cols(), [&](Index first, Index count) {
    out.segment(first, count) = projection.squares(data.middleCols(first, count));
  });
  return out;
}

Matrix PureError::about_cells(const Matrix& residuals) const {
  Matrix out = whitened(residuals);
  by_sets(out.cols(),
          [&](Index first, Index count) { out.middleCols(first, count) = with_(out.middleCols(first, count)); });
  return out;
}

PureError::Cleaned PureError::cleaned(const Matrix& residuals) const {
  Cleaned out{whitened(residuals), Vector(residuals.cols()), Vector(residuals.cols())};
  by_sets(residuals.cols(), [&](Index first, Index count) {
    Matrix data = out.data.middleCols(first, count);
    Vector squares, freedom;
    clean(data, squares, freedom);
    out.data.middleCols(first, count) = data;
    out.squares.segment(first, count) = squares;
    out.freedom.segment(first, count) = freedom;
  });
  return out;
}

std::vector<Index> PureError::outlying(const Vector& residual) const {
  const Matrix before = whitened(residual), after = cleaned(residual).data;
  std::vector<Index> out;
  for (Index i = 0; i < before.rows(); ++i)
    if (after(i, 0) != before(i, 0)) out.push_back(i);
  return out;
}

namespace {

/// What a projection leaves of unit vectors. They are kept as long as there is room.
class UnitVectors {
public:
  UnitVectors(const Projection& projection, Index rows) : projection_(projection), rows_(rows), share_(rows) {
    share_.setConstant(-1);
  }

  /// Which of these residuals is the most unlikely: what is left of a reading varies by its own share.
  Index most_unlikely(const Eigen::Ref<const Vector>& left, const std::vector<Index>& rows) {
    std::vector<Index> unknown;
    std::ranges::copy_if(rows, std::back_inserter(unknown), [&](Index i) { return share_[i] < 0; });
    each(unknown, [&](Index i, const Vector& response) { share_[i] = std::max(negligible_share, response[i]); });
    return *std::ranges::max_element(rows, {}, [&](Index i) { return left[i] * left[i] / share_[i]; });
  }

  /// Share of its own variance that is left of a row that was found most unlikely.
  double share(Index row) const { return share_[row]; }

  /// Calls body(i, left) for each of these rows i, in their order.
  template <class Body> void each(const std::vector<Index>& wanted, const Body& body) {
    for (std::size_t first = 0; first < wanted.size(); first += elimination_lanes) {
      const auto some = std::span(wanted).subspan(first, std::min(elimination_lanes, wanted.size() - first));
      if (index(known_.size() + some.size()) * rows_ > room) known_.clear();
      find(some);
      for (const Index i : some) body(i, known_.at(i));
    }
  }

private:
  void find(std::span<const Index> some) {
    std::vector<Index> missing;
    for (const Index i : some)
      if (!known_.contains(i)) missing.push_back(i);
    Matrix unit = Matrix::Zero(rows_, index(missing.size()));
    for (std::size_t j = 0; j < missing.size(); ++j) unit(missing[j], index(j)) = 1;
    const Matrix left = projection_(unit);
    for (std::size_t j = 0; j < missing.size(); ++j) known_.emplace(missing[j], left.col(index(j)));
  }

  static constexpr Index room = Index{1} << 22; ///< numbers: 32 MiB
  const Projection& projection_;
  Index rows_;
  Vector share_; ///< of its own variance, that is left of each; below 0: not known yet
  std::map<Index, Vector> known_;
};

} // namespace

std::vector<Index> PureError::cell_mates(Index row) const {
  const auto cell_of = [&](Index i) { return replicates_.cell[index(rows_[index(i)]) / design_.indications]; };
  const auto mates = std::ranges::equal_range(orders_[1], cell_of(row), {}, cell_of); // cell by cell
  return {mates.begin(), mates.end()};
}

/// A replaced reading changes what is left by what is left of its unit vector, so that the data are projected once.
void PureError::clean(Matrix& data, Vector& squares, Vector& freedom) const {
  Matrix left = pure_(data);
  const double least = least_scale(design_, rows_);
  UnitVectors unit(pure_, data.rows());
  freedom = Vector::Constant(data.cols(), this->freedom());
  std::vector<Index> open(index(data.cols()));
  std::iota(open.begin(), open.end(), Index{0});
  std::vector<std::vector<Index>> missing(open.size());
  std::vector<bool> fresh(open.size()); // whether the last reading was left out just now
  constexpr int most = 1000;            // what replaces several readings converges by their share each time
  constexpr double settled = 1e-2;      // of the scale: far below what counts
  for (int pass = 0; pass < most && !open.empty(); ++pass) {
    std::vector<Index> more;
    std::map<Index, std::vector<std::pair<Index, double>>> moved; // by row: data sets, and by how much
    for (const Index j : open) {
      auto& gone = missing[index(j)];
      double change = 0;
      for (const Index i : gone) {
        // The others stand: what replaces a new one is known at once.
        const double by = fresh[index(j)] && i == gone.back() ? left(i, j) / unit.share(i) : left(i, j);
        change = std::max(change, std::fabs(by));
        data(i, j) -= by;
        moved[i].push_back({j, by});
      }
      fresh[index(j)] = false;
      const double scale = scale_in_cells(left.col(j), together_, freedom[j], least);
      bool again = change > settled * scale;
      // One at a time: the others of its cell may only look outlying beside it.
      Index worst = 0;
      if (const double size = left.col(j).cwiseAbs().maxCoeff(&worst);
          !again && size > criteria.winsor_limit * scale && freedom[j] > least_freedom()) {
        // The largest residual need not be that of the bad reading: where a straight line is fitted to four readings,
        // an error of the first leaves 0.3 of itself there, and -0.4 at the second.
        std::vector<Index> mates = cell_mates(worst);
        std::erase_if(mates, [&](Index i) { return std::ranges::find(gone, i) != gone.end(); });
        gone.push_back(unit.most_unlikely(left.col(j), mates));
        freedom[j] -= 1;
        fresh[index(j)] = again = true;
      }
      if (again) more.push_back(j);
    }
    std::vector<Index> rows;
    for (const auto& [row, sets] : moved) rows.push_back(row);
    unit.each(rows, [&](Index i, const Vector& response) {
      for (const auto& [j, by] : moved.at(i)) left.col(j) -= by * response;
    });
    open = std::move(more);
  }
  squares = Vector::Zero(data.cols());
  for (Index i = 0; i < left.rows(); ++i) squares += left.row(i).cwiseAbs2().transpose();
}

Vector PureError::scale(const Matrix& residuals) const {
  const Cleaned clean = cleaned(residuals);
  return (clean.squares.array() / clean.freedom.array()).sqrt();
}

Vector PureError::scale_by_indication(const Vector& residual) const {
  const Cleaned clean = cleaned(residual);
  const Matrix left = pure_(clean.data);
  const auto indications = index(design_.indications);
  Vector out = Vector::Zero(indications);
  for (Index i = 0; i < left.rows(); ++i) out[rows_[index(i)] % indications] += left(i, 0) * left(i, 0);
  return (out * static_cast<double>(indications) / clean.freedom[0]).cwiseSqrt();
}

Vector PureError::lack_of_fit(const Matrix& residuals) const {
  if (with_.rank() == without_.rank()) return Vector::Zero(residuals.cols()); // a table holds the cells' constants
  const Matrix clean = cleaned(residuals).data;
  const Vector before = squares(without_, clean), after = squares(with_, clean);
  Vector out(before.size());
  const double hidden = hidden_squares(design_, rows_);
  for (Index j = 0; j < out.size(); ++j)
    out[j] = after[j] + hidden > 0
                 ? freedom(without_) * std::max(0.0, std::log((before[j] + hidden) / (after[j] + hidden)))
                 : 0;
  return out;
}

double PureError::repeats(const Vector& residual) const {
  if (with_.rank() == without_.rank()) return 0;
  const Cleaned clean = cleaned(residual);
  const double variance = clean.squares[0] / clean.freedom[0];
  const double square =
      without_.squares(clean.data)[0] - with_.squares(clean.data)[0] - (freedom(without_) - freedom(with_)) * variance;
  return std::sqrt(std::max(0.0, square) / static_cast<double>(rows_.size()));
}

std::vector<std::string> PureError::depends_on(const Vector& residual) const {
  const Cleaned clean = cleaned(residual);
  const double variance = clean.squares[0] / clean.freedom[0], least = with_.squares(clean.data)[0];
  std::vector<std::string> out, all;
  for (std::size_t f = 0; f < replicates_.factors.size(); ++f) {
    SparseColumns merged_cells = nuisance_;
    merged_cells.add_constants(replicates_.cells(f));
    const Projection merged = without(merged_cells);
    const double lost = freedom(merged) - freedom(with_);
    const double excess = (merged.squares(clean.data)[0] - least) / variance - lost;
    all.push_back(replicates_.factors[f].name);
    if (lost > 0 && excess > criteria.factor_counts * std::sqrt(2 * lost)) out.push_back(all.back());
  }
  return out.empty() ? all : out;
}

Replicates PureError::without_idle_factors(const Vector& residual) const {
  const Matrix data = whitened(residual);
  struct Left {
    double squares, freedom;
  };
  const auto about = [&](const Replicates& replicates) {
    SparseColumns columns = nuisance_;
    columns.add_constants(replicates.cell);
    const Projection projection = without(columns);
    return Left{projection.squares(data)[0], freedom(projection)};
  };
  Replicates out = replicates_;
  for (Left fine = about(out);;) {
    double idle = criteria.idle_factor;
    Replicates best;
    Left of_best{};
    for (std::size_t f = 0; f < out.factors.size(); ++f) {
      Replicates coarse = out.without(f);
      const Left left = about(coarse);
      const double more = left.freedom - fine.freedom;
      const bool told = more > 0 && fine.freedom > 0 && fine.squares > 0;
      const double ratio = told ? (left.squares - fine.squares) / more / (fine.squares / fine.freedom) : 0;
      if (const double p = told ? p_of_variance_ratio(ratio, more, fine.freedom) : 1; p > idle)
        idle = p, best = std::move(coarse), of_best = left;
    }
    if (best.cell.empty()) return out;
    out = std::move(best), fine = of_best;
  }
}

} // namespace gumshoe::tracing
