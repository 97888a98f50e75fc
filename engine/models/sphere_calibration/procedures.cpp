#include "models/sphere_calibration/procedures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "math/direction_words.h"

namespace gumshoe::models::sphere_calibration {
namespace {

/// B and C of the poses, and which one a pattern holds.
struct Angles {
  std::vector<double> B, C;
  std::vector<bool> is_II;
  explicit Angles(const Poses<double>& poses) {
    for (const auto& at : poses.at) B.push_back(at.c.B), C.push_back(at.c.C), is_II.push_back(is_pattern_II(at.c));
  }
};

/// The first of `which` whose held axis stands elsewhere than that of the first one, or which.size().
std::size_t unlike(const std::vector<std::size_t>& which, const std::vector<double>& held) {
  for (std::size_t i = 1; i < which.size(); ++i)
    if (std::fabs(held[which[i]] - held[which[0]]) > 1e-12) return i;
  return which.size();
}

std::string plane_problem(const std::vector<std::size_t>& which, const std::vector<double>& held, char axis) {
  const std::size_t i = unlike(which, held);
  if (i == which.size()) return "";
  return fmt::format(
      "{} of reading {} is {:g} deg, of reading {} {:g} deg: poses of pattern {} lie in a plane at one {} "
      "only (joint does not need planes)",
      axis, which[0] + 1, held[which[0]] / deg, which[i] + 1, held[which[i]] / deg, axis == 'B' ? 1 : 2, axis);
}

Patterns split(const Angles& angles) {
  Patterns out;
  for (std::size_t r = 0; r < angles.B.size(); ++r) (angles.is_II[r] ? out.II : out.I).push_back(r);
  return out;
}

/// Largest less smallest value of one axis' commands, as recorded and of the declared machine.
struct Spread {
  double recorded[2] = {1e300, -1e300}, declared[2] = {1e300, -1e300};
  static void add(double (&range)[2], double x) { range[0] = std::min(range[0], x), range[1] = std::max(range[1], x); }
  double recorded_size() const { return recorded[1] - recorded[0]; }
  double declared_size() const { return declared[1] - declared[0]; }
};

/// Lengths in a wrong unit fit as well as others where all are: the machine found is a thousand times as large. Only
/// the declared one tells.
std::string unit_problem(const Poses<double>& poses) {
  constexpr std::size_t indications = rows_of<Rows::Indications>;
  Spread spread[indications];
  bool recorded = false;
  for (std::size_t r = 0; r < poses.size(); ++r) {
    At<double> at = poses.at[r];
    at.freed = {};
    const auto x = simulate(contact(at, links(at.q), false));
    const double machine[] = {x.x, x.y, x.z};
    for (std::size_t k = 0; k < indications; ++k) {
      const double read = array_of(poses.read[r])[k];
      recorded |= read != 0;
      Spread::add(spread[k].recorded, read);
      Spread::add(spread[k].declared, machine[k]);
    }
  }
  double largest = 0;
  for (const Spread& s : spread) largest = std::max(largest, s.declared_size());
  for (std::size_t k = 0; recorded && k < indications; ++k) {
    const double ratio = spread[k].recorded_size() / spread[k].declared_size();
    if (spread[k].declared_size() > 0.1 * largest && (ratio > 30 || ratio < 1.0 / 30))
      return fmt::format("{} spreads over {:.4g} mm, but over {:.4g} mm for the declared machine; is a unit wrong?",
                         "XYZ"[k],
                         spread[k].recorded_size() * 1e3, spread[k].declared_size() * 1e3);
  }
  return "";
}

} // namespace

Patterns patterns(const Poses<double>& poses) {
  const Angles angles(poses);
  Patterns out = split(angles);
  if (unlike(out.I, angles.B) < out.I.size()) out.I.clear();
  if (unlike(out.II, angles.C) < out.II.size()) out.II.clear();
  return out;
}

Whitening weights(const Poses<double>& poses) {
  std::string problem;
  const bool weighted = poses.at[0].evaluation == joint_weighted && poses.declared;
  return weighted ? whitening(poses, problem) : Whitening{};
}

std::string Identify::check(const Poses<double>& poses) {
  if (poses.size() < 2) return "one pose cannot determine the axes; commands at several angles of B and C are needed";
  if (const std::string problem = unit_problem(poses); !problem.empty()) return problem;
  const int evaluation = poses.at[0].evaluation;
  if (evaluation == sequential) {
    const Angles angles(poses);
    const Patterns all = split(angles);
    for (const auto& problem : {plane_problem(all.I, angles.B, 'B'), plane_problem(all.II, angles.C, 'C')})
      if (!problem.empty()) return problem;
    if (!all.I.empty() && std::fabs(angles.B[all.I[0]]) > 1e-12)
      return fmt::format(
          "B is {:g} deg in pattern 1, but probe and C axis follow only from poses at B = 0 (joint does not need them)",
          angles.B[all.I[0]] / deg);
  }
  if (evaluation != joint_weighted) return "";
  if (!poses.declared) return "weights follow from what a scenario declares, and a table declares nothing; use joint";
  std::string problem;
  whitening(poses, problem);
  return problem;
}

std::vector<std::string> Identify::remarks(const Poses<double>& poses) {
  std::vector<std::size_t> quantities;
  for (std::size_t j = 0; j < unknowns; ++j) quantities.push_back(j);
  const std::size_t declared = poses.declared ? poses.declared->draws.size() : 0; // a table declares nothing
  for (std::size_t i = 0; i < declared; ++i)
    if (const auto& draw = poses.declared->draws[i];
        draw.moves.size() == poses.size() && draw.moves[0].column >= Q::link_B_x && draw.moves[0].column < Q::E_AA)
      quantities.push_back(draw.moves[0].column);
  const std::size_t p = quantities.size(), n = 3 * poses.size();
  std::vector<double> jacobian(n * p), magnitude(p, 1e-3);
  const auto unseen_among = [&](std::size_t first) {
    std::vector<double> part;
    for (std::size_t i = 0; i < n; ++i) part.insert(part.end(), &jacobian[i * p], &jacobian[i * p] + first);
    return least_squares::parameter_covariance(
        part, n, first, {magnitude.begin(), magnitude.begin() + static_cast<std::ptrdiff_t>(first)}, unseen_below);
  };
  for (std::size_t r = 0; r < poses.size(); ++r)
    for (std::size_t j = 0; j < p; ++j) {
      const auto d = derivative(poses, r, quantities[j]);
      jacobian[3 * r * p + j] = d.x, jacobian[(3 * r + 1) * p + j] = d.y, jacobian[(3 * r + 2) * p + j] = d.z;
    }
  std::vector<least_squares::Parameter> names;
  for (const std::size_t q : quantities) {
    const QuantityCard& card = quantity_cards[q];
    names.push_back({std::string(card.name), std::string(card.unit), std::string(card.si_unit)});
  }
  std::vector<std::string> out;
  const auto machine = unseen_among(unknowns), all = unseen_among(p);
  if (machine.rank < unknowns)
    out.push_back(
        fmt::format("the poses determine {} of 11 directions; along the others the unknowns keep their declared "
                    "values", machine.rank));
  for (const auto& direction : all.unseen) out.push_back(in_words(direction, names));
  return out;
}

} // namespace gumshoe::models::sphere_calibration
