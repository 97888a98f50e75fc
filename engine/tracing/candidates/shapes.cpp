#include "tracing/candidates/shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "math/senses.h"
#include "tracing/candidates/smooth_basis.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

/// Whether next to nothing of a column, by reading of the sequence, lies after the first readings: that is one of
/// outliers at the start.
bool of_the_start(const Vector& curve) {
  const Index n = curve.size(), first = criteria.few_readings;
  if (n <= 2 * first) return false;
  const Vector x = curve.array() - curve.tail(n - first).mean();
  return x.head(first).squaredNorm() > criteria.few_share * x.squaredNorm();
}

class Shapes {
public:
  Shapes(const Observations& o, std::size_t most_cells) : o_(o), most_cells_(most_cells) {}

  std::vector<Candidate> all() {
    for (const Covariate& c : o_.covariates) {
      c.angle ? harmonics(c) : polynomials(c);
      if (c.levels.size() > 2 && !c.course && o_.order_known) hysteresis(c);
    }
    for (std::size_t i = 0; i < o_.covariates.size(); ++i)
      for (std::size_t j = i + 1; j < o_.covariates.size(); ++j) harmonics(o_.covariates[i], o_.covariates[j]);
    for (const Grouping& g : o_.labels) steps(g);
    for (const Grouping& g : o_.label_pairs) steps(g);
    for (const Grouping* g : part_labels(o_))
      for (const Covariate& c : o_.covariates)
        if (c.commanded || c.course) in_groups(c, *g);
    // The first block may have another slope: what was at rest is not run in yet. Any may have another reversal.
    for (const Grouping& g : o_.labels)
      for (const Covariate& c : o_.covariates)
        if (g.group == o_.blocks.group && c.commanded && !c.course)
          is_direction(c) ? passes(c, g) : in_group(c, g, g.group[o_.sequence[0]]);
    for (std::size_t i = 0; i < o_.covariates.size(); ++i)
      for (std::size_t j = i + 1; j < o_.covariates.size(); ++j) product(o_.covariates[i], o_.covariates[j]);
    for (const Covariate& c : o_.covariates)
      if (c.levels.size() > 2 && !(numbers_groups(o_, c) && is_a_table(c))) {
        add(Family::omnibus, "omnibus:" + c.name, smooth_basis(o_, c, criteria.omnibus_columns), {c.name});
        // What rises and falls within a tenth of the range.
        if (c.levels.size() > criteria.levels_for_fine_omnibus)
          add(Family::omnibus, "omnibus:" + c.name, smooth_basis(o_, c, criteria.fine_omnibus_columns), {c.name},
              "fine");
      }
    tables();
    // What scatters by a label is a variance component; any pattern of few groups is a shape.
    const auto scatters = [&](const Grouping& g) {
      return std::ranges::any_of(o_.replicate_groups, [&](const Grouping& r) { return r.group == g.group; });
    };
    for (const Grouping& g : o_.labels)
      if (g.groups.size() > 2 && g.groups.size() <= criteria.most_omnibus_groups && !scatters(g))
        if (const Matrix m = about_their_mean(g); m.cols() > 1) add(Family::omnibus, "omnibus:" + g.name, m, {g.name});
    for (const Grouping& g : o_.label_pairs)
      if (g.groups.size() <= most_cells_ && g.groups.size() * criteria.least_repeats <= o_.readings)
        add(Family::omnibus, fmt::format("table:{}", fmt::join(g.labels, "*")), about_their_mean(g), g.labels);
    return std::move(out_);
  }

private:
  /// One candidate per indication.
  /// @param labels  of the readings that it moves alone
  void add(Family family, const std::string& name, const Matrix& by_reading, const std::vector<std::string>& depends_on,
           const std::string& shape = "", const std::vector<std::pair<std::string, std::string>>& labels = {},
           double searched = 1) {
    if (by_reading.cols() == 0 || (by_reading.cols() == 1 && of_the_start(by_reading))) return;
    const auto k = index(o_.indications);
    for (Index i = 0; i < k; ++i) {
      Candidate a;
      a.family = family;
      a.name = name + (k > 1 ? " of " + o_.names[index(i)] : "");
      a.shape = shape;
      a.columns = Matrix::Zero(by_reading.rows() * k, by_reading.cols());
      for (Index r = 0; r < by_reading.rows(); ++r) a.columns.row(r * k + i) = by_reading.row(r);
      for (Index j = 0; j < by_reading.cols(); ++j) {
        Amplitude size;
        size.quantity = Amplitude::npos;
        size.name = "size";
        size.labels = labels;
        a.amplitudes.push_back(size);
      }
      a.depends_on = depends_on;
      a.searched = searched;
      out_.push_back(std::move(a));
    }
  }

  /// Any value for each group of the training readings, about the mean of these: of a group that none of them has,
  /// such as a block that is held out, the mean is what they say.
  Matrix about_their_mean(const Grouping& g) const {
    std::vector<Index> column(g.groups.size(), -1);
    Index count = 0;
    for (const std::size_t r : o_.sequence)
      if ((o_.held_out.empty() || !o_.held_out[r]) && column[g.group[r]] < 0) column[g.group[r]] = count++;
    Matrix out = Matrix::Zero(index(o_.readings), std::max<Index>(count - 1, 0));
    for (std::size_t i = 0; i < o_.readings; ++i)
      if (const Index at = column[g.group[o_.sequence[i]]]; at == 0)
        out.row(index(i)).setConstant(-1);
      else if (at > 0)
        out(index(i), at - 1) = 1;
    return out;
  }

  /// Whether a smooth dependence has a column for each level but one.
  static bool is_a_table(const Covariate& c) {
    return static_cast<int>(c.levels.size()) <= criteria.omnibus_columns + 1;
  }

  /// Time, under whatever name: it never goes back.
  bool elapses(const Covariate& c) const {
    const Vector x = plain(o_, c);
    return (x.tail(x.size() - 1) - x.head(x.size() - 1)).minCoeff() > 0;
  }

  void polynomials(const Covariate& c) {
    const Vector x = scaled(o_, c), raw = plain(o_, c);
    add(Family::shape, "polynomial:" + c.name, x, {c.name});
    if (c.levels.size() < 3) return;
    const double size = std::max(std::fabs(c.levels.front()), std::fabs(c.levels.back()));
    const Vector y = raw / size;
    if (c.si_unit != "K") { // a power of an absolute temperature is a straight line once more
      add(Family::shape, "polynomial:" + c.name + "^2", y.array().square(), {c.name});
      add(Family::shape, "polynomial:" + c.name + "^3", y.array().cube(), {c.name});
    }
    if (c.levels.front() > 0 && c.si_unit != "K" && !elapses(c)) // the zero of time is an accident
      add(Family::shape, "polynomial:1/" + c.name, y.array().inverse() * (c.levels.front() / size), {c.name});
    if (c.levels.size() < 4) return;
    // What is left of a curve when a line is absorbed.
    add(Family::shape, "polynomial:" + c.name + "^2", x.array().square(), {c.name}, "zero in the middle");
  }

  void harmonics(const Covariate& c) {
    waves(plain(o_, c), c.levels.size(), c.name, {c.name});
    add(Family::shape, "polynomial:" + c.name, scaled(o_, c), {c.name});
    if (c.levels.size() > 2)
      add(Family::shape, "polynomial:" + c.name + "^2", scaled(o_, c).array().square(), {c.name});
  }

  /// The angle between two that were set apart: a part turned on its table has its own azimuth.
  void harmonics(const Covariate& a, const Covariate& b) {
    if (!a.angle || !b.angle || !a.commanded || !b.commanded) return;
    const Vector x = plain(o_, a) - plain(o_, b);
    const auto alone = [&](const Covariate& c) {
      const double shift = x[0] - plain(o_, c)[0];
      return (x - plain(o_, c)).isConstant(shift, 1e-9) || (x + plain(o_, c)).isConstant(x[0] + plain(o_, c)[0], 1e-9);
    };
    if (std::ranges::any_of(o_.covariates, [&](const Covariate& c) { return c.angle && alone(c); })) return;
    std::vector<std::pair<std::int64_t, std::int64_t>> turned;
    for (const double angle : x)
      turned.emplace_back(std::llround(1e6 * std::cos(angle - x[0])), std::llround(1e6 * std::sin(angle - x[0])));
    // Whichever of the two is taken from the other.
    const auto first = std::ranges::find_if(turned, [](const auto& one) { return one.second != 0; });
    if (first != turned.end() && first->second < 0)
      for (auto& one : turned) one.second = -one.second;
    const std::set<std::pair<std::int64_t, std::int64_t>> levels(turned.begin(), turned.end());
    if (!turned_.insert(std::move(turned)).second) return;
    waves(x, levels.size(), a.name + "-" + b.name, {a.name, b.name});
  }

  /// Harmonics of an angle, by reading, as far as its levels distinguish them.
  void waves(const Vector& x, std::size_t levels, const std::string& name, const std::vector<std::string>& depends_on) {
    const auto most = std::min(criteria.most_harmonics, (levels - 1) / 2);
    for (std::size_t h = 1; h <= most; ++h) {
      Matrix pair(x.size(), 2);
      pair << (x.array() * static_cast<double>(h)).cos(), (x.array() * static_cast<double>(h)).sin();
      add(Family::shape, fmt::format("harmonic:{}x{}", h, name), pair, depends_on);
    }
  }

  void hysteresis(const Covariate& c) {
    const Vector x = plain(o_, c);
    const auto way = senses(std::span(x.data(), static_cast<std::size_t>(x.size())));
    const Vector sign = Eigen::Map<const Vector>(way.data(), x.size());
    const auto up = (sign.array() > 0).count(), down = (sign.array() < 0).count();
    if (8 * std::min(up, down) < std::max(up, down) || std::min(up, down) < 3) return;
    if (!recorded(sign)) add(Family::shape, "hysteresis:" + c.name, sign, {c.name});
    if (c.levels.size() > 3 && c.levels.size() * criteria.least_repeats <= o_.readings && !c.angle)
      add(Family::shape, "hysteresis:" + c.name, sign.cwiseProduct(loop(c)), {c.name}, closing);
  }

  /// Whether a condition of two states says the same as this sign: what was recorded goes before what the order of the
  /// readings suggests.
  bool recorded(const Vector& sign) const {
    return std::ranges::any_of(o_.covariates, [&](const Covariate& c) {
      if (c.levels.size() != 2) return false;
      const auto same = ((plain(o_, c).array() > 0.5 * (c.levels[0] + c.levels[1])) == (sign.array() > 0)).count();
      return 10 * std::min<Index>(same, sign.size() - same) < sign.size();
    });
  }

  /// A parabola that is 1 in the middle of what was measured and 0 at its ends, where the way turns back: what either
  /// way has of hysteresis by Rayleigh's law, in a spring or a load cell.
  Vector loop(const Covariate& c) const { return 1 - scaled(o_, c).array().square(); }
  static constexpr const char* closing = "closing at both ends";

  void steps(const Grouping& g) {
    if (g.groups.size() > criteria.most_label_groups) return;
    for (std::size_t i = g.groups.size() == 2 ? 1 : 0; i < g.groups.size(); ++i) {
      Vector one(index(o_.readings));
      for (std::size_t r = 0; r < o_.readings; ++r) one[index(r)] = g.group[o_.sequence[r]] == i ? 1 : 0;
      add(Family::shape, "step:" + g.groups[i], one, g.labels);
    }
  }

  /// A condition that counts in one group alone: one machine has another slope.
  void in_groups(const Covariate& c, const Grouping& g) {
    for (std::size_t i = g.groups.size() == 2 ? 1 : 0; i < g.groups.size(); ++i) in_group(c, g, i);
  }

  void in_group(const Covariate& c, const Grouping& g, std::size_t i, double searched = 1) {
    // The zero of an absolute temperature is far away: about the middle of what was met.
    const Vector x = c.si_unit == "K"
                         ? scaled(o_, c)
                         : plain(o_, c) / std::max(std::fabs(c.levels.front()), std::fabs(c.levels.back()));
    in_group(x, c, g, i, "product:" + c.name + "*" + g.groups[i], searched);
  }

  /// @param x  what depends on the condition, by reading of the sequence
  void in_group(const Vector& x, const Covariate& c, const Grouping& g, std::size_t i, const std::string& name,
                double searched) {
    Vector one = Vector::Zero(x.size());
    std::set<double> levels;
    for (Index r = 0; r < x.size(); ++r)
      if (g.group[o_.sequence[index(r)]] == i) one[r] = x[r], levels.insert(x[r]);
    if (levels.size() < 2) return;
    add(Family::shape, name, one, {c.name, g.name}, "", {{g.name, g.values[i][0]}}, searched);
  }

  /// Something was hit or slipped on the way there, or on the way back: one pass of a block differs, or its reversal.
  /// A step in time says the same of the first and the last pass. Each counts as often as there are such shapes.
  void passes(const Covariate& direction, const Grouping& blocks) {
    if (blocks.groups.size() > criteria.most_label_groups) return;
    const Vector way = plain(o_, direction);
    const auto pass = [&](std::size_t r) { return std::pair(blocks.group[r], direction.value[r]); };
    const auto fitted = [&](std::size_t r) { return o_.held_out.empty() || !o_.held_out[r]; };
    const auto first = std::ranges::find_if(o_.sequence, fitted),
               last = std::find_if(o_.sequence.rbegin(), o_.sequence.rend(), fitted).base() - 1;
    const double searched = 3 * static_cast<double>(blocks.groups.size());
    for (std::size_t i = 0; i < blocks.groups.size(); ++i) {
      in_group(direction, blocks, i, searched);
      for (const double level : direction.levels)
        if (const std::pair one(i, level); one != pass(*first) && one != pass(*last))
          in_group((way.array() == level).cast<double>(), direction, blocks, i,
                   fmt::format("step:{} with {} {:g}", blocks.groups[i], direction.name, level), searched);
    }
  }

  /// Two states that are opposite.
  static bool is_direction(const Covariate& c) { return c.levels.size() == 2 && c.levels[0] == -c.levels[1]; }

  /// Any value at each level of what was set again and again: of one covariate, of two, and of all of them together.
  void tables() {
    std::vector<const Covariate*> repeated;
    for (const Covariate& c : o_.covariates)
      if ((!c.course || c.comes_back) && !numbers_groups(o_, c) &&
          c.levels.size() * criteria.least_repeats <= o_.readings)
        repeated.push_back(&c);
    for (std::size_t i = 0; i < repeated.size(); ++i) {
      if (!is_a_table(*repeated[i])) table({repeated[i]});
      for (std::size_t j = i + 1; j < repeated.size(); ++j) table({repeated[i], repeated[j]});
    }
    if (repeated.size() > 2) table(repeated);
    // Each part, such as a probe, may have a curve of its own.
    for (const Grouping* g : part_labels(o_))
      for (const Covariate* c : repeated)
        if (g->groups.size() <= criteria.most_omnibus_groups) table({c}, g);
  }

  void table(const std::vector<const Covariate*>& by, const Grouping* part = nullptr) {
    std::map<std::vector<double>, Index> cells;
    std::vector<Index> cell;
    std::vector<std::string> names;
    for (const Covariate* c : by) names.push_back(c->name);
    if (part) names.push_back(part->name);
    for (const std::size_t r : o_.sequence) {
      std::vector<double> level;
      for (const Covariate* c : by) level.push_back(c->value[r]);
      if (part) level.push_back(static_cast<double>(part->group[r]));
      cell.push_back(cells.insert({std::move(level), index(cells.size())}).first->second);
    }
    if (cells.size() > most_cells_ || cells.size() * criteria.least_repeats > o_.readings) return;
    // A condition that follows from the others divides no cell: the simpler name stays.
    if (!tabulated_.insert(cell).second) return;
    Matrix m = Matrix::Zero(index(o_.readings), index(cells.size()) - 1);
    for (std::size_t i = 0; i < cell.size(); ++i)
      if (cell[i] > 0) m(index(i), cell[i] - 1) = 1;
    add(Family::omnibus, fmt::format("table:{}", fmt::join(names, "*")), m, names);
  }

  void product(const Covariate& a, const Covariate& b) {
    const Vector x = scaled(o_, a), y = scaled(o_, b);
    const Vector cx = x.array() - x.mean(), cy = y.array() - y.mean();
    if (std::fabs(cx.dot(cy)) > criteria.confounded * cx.norm() * cy.norm()) return; // one and the same, confounded
    add(Family::shape, "product:" + a.name + "*" + b.name, cx.cwiseProduct(cy), {a.name, b.name});
    reversals(a, b);
    reversals(b, a);
    // A drift that grows along a slide starts at nothing and has a fixed end; so has what grows with a temperature.
    for (const auto& both : {std::pair{&a, &b}, std::pair{&b, &a}}) {
      const Covariate *const time = both.first, *const place = both.second;
      const bool warms = time->si_unit == "K" && !time->commanded;
      if (!(elapses(*time) || warms) || place->angle || place->si_unit == "K" ||
          place->levels.size() * criteria.least_repeats > o_.readings)
        continue;
      const Vector t = 0.5 * (scaled(o_, *time).array() + 1), along = plain(o_, *place);
      const auto grow = [&](double from, const std::string& name) {
        add(Family::shape, "product:" + a.name + "*" + b.name,
            t.array() * (along.array() - from) / (place->levels.back() - place->levels.front()), {a.name, b.name},
            (warms ? "" : "a drift, ") + ("zero at " + name));
      };
      grow(place->levels.front(), "the lowest " + place->name);
      grow(place->levels.back(), "the highest " + place->name);
      if (place->levels.front() != 0 && place->levels.back() != 0 && warms) grow(0, place->name + " = 0");
    }
    Matrix surface(x.size(), 0);
    // Two states, such as a direction, have one column: the other condition may then bend more.
    const auto most = [](const Covariate& other) { return other.levels.size() == 2 ? criteria.omnibus_columns : 2; };
    const Matrix first = smooth_basis(o_, a, most(b)), second = smooth_basis(o_, b, most(a));
    for (Index i = 0; i < first.cols(); ++i)
      for (Index j = 0; j < second.cols(); ++j) {
        surface.conservativeResize(Eigen::NoChange, surface.cols() + 1);
        surface.rightCols(1) = first.col(i).cwiseProduct(second.col(j));
      }
    if (surface.cols() > 1) add(Family::omnibus, "omnibus:" + a.name + "*" + b.name, surface, {a.name, b.name});
  }

  /// An error of the direction that grows along a slide: from an end of what was measured, or from the slide's zero; or
  /// that closes at both ends.
  void reversals(const Covariate& direction, const Covariate& place) {
    if (!is_direction(direction)) return;
    if (place.angle || place.levels.size() < 3 || elapses(place)) return;
    const double low = place.levels.front(), high = place.levels.back();
    const Vector sign = plain(o_, direction), along = plain(o_, place);
    const auto grow = [&](double from, const std::string& name) {
      add(Family::shape, "product:" + place.name + "*" + direction.name,
          sign.array() * (along.array() - from) / (high - low), {place.name, direction.name}, "zero at " + name);
    };
    grow(low, "the lowest " + place.name);
    grow(high, "the highest " + place.name);
    if (low != 0 && high != 0) grow(0, place.name + " = 0");
    if (place.levels.size() > 3)
      add(Family::shape, "product:" + place.name + "*" + direction.name, sign.cwiseProduct(loop(place)),
          {place.name, direction.name}, closing);
  }

  const Observations& o_;
  std::size_t most_cells_;
  std::vector<Candidate> out_;
  std::set<std::vector<Index>> tabulated_; ///< cells of the tables, by reading
  /// Angles between two since the first reading, by reading: cosine and sine, 1e-6.
  std::set<std::vector<std::pair<std::int64_t, std::int64_t>>> turned_;
};

} // namespace

std::vector<Candidate> shapes(const Observations& observations, std::size_t most_cells) {
  return Shapes(observations, most_cells).all();
}

} // namespace gumshoe::tracing
