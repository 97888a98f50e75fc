/// Candidates over sizes at which readings jump, as a mill's do when another tooth triggers first: no derivative leads
/// there.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "base/units.h"
#include "tracing/candidates/candidate_families.h"
#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

using Sizes = std::vector<double>; ///< by amplitude

/// Changes of the readings by sizes of a candidate's amplitudes.
class Moved {
public:
  explicit Moved(const CandidateMaker& make) : make_(make) {}

  void add(const Candidate& a, const Sizes& sizes) {
    Variation v;
    for (std::size_t j = 0; j < sizes.size(); ++j)
      if (sizes[j] != 0) v.changes.push_back({a.amplitudes[j].quantity, sizes[j], false});
    variations_.push_back(std::move(v));
  }
  void simulate() {
    variations_.push_back({});
    Matrix f;
    make_.simulator.vary(make_.at, variations_, f, valid_);
    changes_ = in_sequence(make_.observations, Matrix(f.colwise() - f.col(f.cols() - 1).eval()));
  }
  bool valid(std::size_t i) const { return valid_[i]; }
  Vector by(std::size_t i) const { return changes_.col(index(i)); }

private:
  const CandidateMaker& make_;
  std::vector<Variation> variations_;
  std::vector<bool> valid_;
  Matrix changes_;
};

/// Root mean square of what the model leaves of the readings.
double left(const CandidateMaker& make) { return make.step / criteria.secant_step; }

/// Size that moves the readings by what is left of them, by the derivative; no more than is plausible.
double unit_by_derivative(const CandidateMaker& make, const Candidate& a) {
  const double slope = a.columns.norm() / std::sqrt(static_cast<double>(a.columns.size())),
               most = criteria.implausible_size * a.amplitudes[0].typical;
  return most > 0 ? std::min(left(make) / slope, most) : left(make) / slope;
}

/// Directions, of length one, in which sizes are tried.
std::vector<Sizes> directions(const Candidate& a, int of_pair) {
  if (a.amplitudes.size() == 1) return {{1}, {-1}};
  std::vector<Sizes> out;
  for (int i = 0; i < of_pair; ++i) {
    const double angle = 2 * std::numbers::pi * i / of_pair;
    out.push_back({std::cos(angle), std::sin(angle)});
  }
  return out;
}

Sizes times(const Sizes& direction, double size) {
  Sizes out;
  for (const double x : direction) out.push_back(size * x);
  return out;
}

bool allowed(const Candidate& a, const Sizes& sizes) {
  for (std::size_t j = 0; j < sizes.size(); ++j)
    if (const Amplitude& s = a.amplitudes[j]; sizes[j] < s.low || sizes[j] > s.high) return false;
  return true;
}

double cosine(const Vector& a, const Vector& b) {
  const double lengths = a.norm() * b.norm();
  return lengths > 0 ? a.dot(b) / lengths : 0;
}

bool by_derivative(const Candidate& a) {
  return (a.family == Family::effect || a.family == Family::declared) && a.finite == 0 && a.held.empty() &&
         a.amplitudes[0].labels.empty() && a.amplitudes.size() <= 2;
}

constexpr int tested = 4; ///< directions of a pair in which jumps are looked for

/// Whether readings jump, and in jumps that follow the size. @param first  of changes by whole steps and by less
bool jumps(const Candidate& a, const Moved& moved, std::size_t first) {
  double whole = 0, less = 0, follows = -1;
  for (std::size_t d = 0; d < directions(a, tested).size(); ++d, first += 2) {
    if (!moved.valid(first) || !moved.valid(first + 1)) continue;
    whole += moved.by(first).norm();
    less += moved.by(first + 1).norm();
    follows = std::max(follows, cosine(moved.by(first), moved.by(first + 1)));
  }
  return less > criteria.curved * whole && follows > criteria.follows;
}

std::string text_of(const Candidate& a, const Sizes& sizes) {
  std::string out = "over ";
  for (std::size_t j = 0; j < sizes.size(); ++j)
    out +=
        fmt::format("{}{:+.3g}", j > 0 ? ", " : "",
                    units::from_si(sizes[j], a.amplitudes[j].unit, a.amplitudes[j].si_unit, units::Kind::difference));
  return out + units::suffix(a.amplitudes[0].unit);
}

int steps_of(const Candidate& a) { return a.amplitudes.size() > 1 ? criteria.steps_of_pair : criteria.steps_of_size; }
double step_of(const Candidate& a, double unit) { return criteria.most_start * unit / steps_of(a); }

/// Sizes of both signs, the most negative first, or of a pair in all directions, up to those that move readings several
/// times as far as what is left of them; by column.
Matrix sizes_tried(const Candidate& a, double unit) {
  std::vector<Sizes> sizes;
  const bool pair = a.amplitudes.size() > 1;
  const int steps = steps_of(a);
  const double step = step_of(a, unit);
  const auto add = [&](const Sizes& one) {
    if (allowed(a, one)) sizes.push_back(one);
  };
  for (int k = pair ? 1 : -steps; k <= steps; ++k)
    if (pair)
      for (const Sizes& d : directions(a, criteria.start_directions)) add(times(d, k * step));
    else if (k != 0)
      add({k * step});
  Matrix out(index(a.amplitudes.size()), index(sizes.size()));
  for (Index k = 0; k < out.cols(); ++k)
    for (Index j = 0; j < out.rows(); ++j) out(j, k) = sizes[index(k)][index(j)];
  return out;
}

/// The best of these sizes, as a candidate that counts as often as different sizes were tried.
void add_best(const CandidateMaker& make, const Candidate& a, double unit, std::vector<Candidate>& out) {
  const Matrix sizes = sizes_tried(a, unit);
  if (sizes.cols() == 0) return;
  const std::optional<Start> best = make.choose(a, sizes, step_of(a, unit));
  if (!best) return;
  Candidate one = a;
  const Vector& size = best->sizes;
  one.start.assign(size.begin(), size.end());
  one.tried = sizes;
  one.exact_ratio = best->ratio;
  one.searched = best->tries;
  Moved moved(make);
  moved.add(a, one.start);
  moved.simulate();
  one.finite = size.size() == 1 ? size[0] : size.norm();
  one.columns = moved.by(0) / size.norm();
  one.shape = text_of(a, one.start);
  if (moved.valid(0) && one.columns.norm() > 0) out.push_back(std::move(one));
}

/// A candidate whose size moves readings further than its derivative says, and the size that moves them by what is
/// left.
struct Jumping {
  const Candidate* of;
  double unit;
  int halvings = 0; ///< from the size by the derivative
};

/// Adds the changes of one candidate by the same size, and by parts of it, in every direction tested.
std::size_t add_tests(const Candidate& a, double size, std::span<const double> parts, Moved& moved) {
  std::size_t added = 0;
  for (const Sizes& d : directions(a, tested))
    for (const double part : parts) {
      const Sizes sizes = times(d, part * size);
      moved.add(a, allowed(a, sizes) ? sizes : Sizes{}); // one that is not allowed stays at null and tells nothing
      ++added;
    }
  return added;
}

/// A derivative may vanish within a tooth: the unit is halved until the readings move by as much as is left of them.
std::vector<Jumping> further_than_derivative(const CandidateMaker& make, const std::vector<Candidate>& candidates) {
  static constexpr std::array<double, 1> whole{1.0};
  std::vector<Jumping> out;
  for (const Candidate& a : candidates)
    if (by_derivative(a)) out.push_back({&a, unit_by_derivative(make, a)});
  std::vector<bool> settled(out.size(), false);
  for (int halvings = 0; halvings < criteria.most_halvings; ++halvings) {
    Moved moved(make);
    std::vector<std::size_t> count;
    for (std::size_t i = 0; i < out.size(); ++i)
      count.push_back(settled[i] ? 0 : add_tests(*out[i].of, out[i].unit, whole, moved));
    moved.simulate();
    std::size_t next = 0;
    for (std::size_t i = 0; i < out.size(); ++i) {
      double most = 0;
      for (std::size_t k = 0; k < count[i]; ++k, ++next)
        if (moved.valid(next)) most = std::max(most, moved.by(next).norm());
      if (settled[i]) continue;
      settled[i] = most < 2 * left(make) * std::sqrt(static_cast<double>(out[i].of->columns.rows()));
      if (!settled[i]) out[i].unit /= 2, ++out[i].halvings;
    }
    if (std::ranges::find(settled, false) == settled.end()) break;
  }
  return out;
}

} // namespace

std::vector<Candidate> jumping_candidates(const CandidateMaker& make, const std::vector<Candidate>& candidates) {
  if (!make.choose) return {};
  static constexpr std::array<double, 2> parts{1.0, criteria.less};
  const std::vector<Jumping> tried = further_than_derivative(make, candidates);
  Moved moved(make);
  std::vector<std::size_t> first{0};
  for (const Jumping& one : tried) first.push_back(first.back() + add_tests(*one.of, one.unit, parts, moved));
  moved.simulate();
  std::vector<Candidate> out;
  for (std::size_t i = 0; i < tried.size(); ++i)
    if (tried[i].halvings > 0 && jumps(*tried[i].of, moved, first[i])) add_best(make, *tried[i].of, tried[i].unit, out);
  return out;
}

} // namespace gumshoe::tracing
