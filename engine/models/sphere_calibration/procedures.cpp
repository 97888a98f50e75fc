#include "models/sphere_calibration/procedures.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "math/direction_words.h"

namespace gumshoe::models::sphere_calibration {
namespace {

constexpr double deg = 3.14159265358979323846 / 180;

std::vector<const double*> conditions_of(const BlockCall& call, std::vector<double>& values) {
  values.clear();
  for (std::size_t i = 0; i < call.readings * conditions; ++i) values.push_back(*call.conditions[i].data);
  std::vector<const double*> out;
  for (std::size_t r = 0; r < call.readings; ++r) out.push_back(&values[r * conditions]);
  return out;
}

/// The first reading whose clamped axis stands elsewhere than that of the first of `which`, or which.size().
std::size_t unlike(const std::vector<std::size_t>& which, const std::vector<const double*>& condition, int clamped) {
  for (std::size_t i = 1; i < which.size(); ++i)
    if (std::fabs(condition[which[i]][clamped] - condition[which[0]][clamped]) > 1e-12) return i;
  return which.size();
}

std::string plane_problem(const std::vector<std::size_t>& which, const std::vector<const double*>& condition,
                          int clamped) {
  const std::size_t i = unlike(which, condition, clamped);
  if (i == which.size()) return "";
  return fmt::format(
      "{} of reading {} is {:g} deg, of reading {} {:g} deg: poses of pattern {} lie in a plane at one {} "
      "only (joint needs no planes)",
      clamped == B ? 'B' : 'C', which[0] + 1, condition[which[0]][clamped] / deg, which[i] + 1,
      condition[which[i]][clamped] / deg, clamped == B ? 1 : 2, clamped == B ? 'B' : 'C');
}

void split(const std::vector<const double*>& condition, Patterns& out) {
  for (std::size_t r = 0; r < condition.size(); ++r) (is_pattern_II(condition[r]) ? out.II : out.I).push_back(r);
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
std::string unit_problem(const BlockCall& call, const std::vector<const double*>& condition) {
  Spread spread[indications];
  bool recorded = false;
  for (std::size_t r = 0; r < call.readings; ++r) {
    double q[count];
    for (std::size_t j = 0; j < count; ++j) q[j] = *call.quantities[r * count + j].data;
    const auto x = simulate(contact(exact, q, links(q), condition[r], false));
    const double machine[] = {x.x, x.y, x.z};
    for (std::size_t k = 0; k < indications; ++k) {
      const double read = *call.indications[r * indications + k].data;
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
      return fmt::format("{} spreads over {:.4g} mm, by the declared machine over {:.4g} mm: a wrong unit?", "XYZ"[k],
                         spread[k].recorded_size() * 1e3, spread[k].declared_size() * 1e3);
  }
  return "";
}

} // namespace

Patterns patterns(const std::vector<const double*>& condition) {
  Patterns out;
  split(condition, out);
  if (unlike(out.I, condition, B) < out.I.size()) out.I.clear();
  if (unlike(out.II, condition, C) < out.II.size()) out.II.clear();
  return out;
}

std::string check_readings(const BlockCall& call) {
  if (!is_joint(call.evaluation)) return "";
  if (call.readings < 2) return "one pose says nothing of the axes: commands at several angles of B and C are needed";
  std::vector<double> values;
  const auto condition = conditions_of(call, values);
  if (const std::string problem = unit_problem(call, condition); !problem.empty()) return problem;
  if (call.evaluation == sequential) {
    Patterns all;
    split(condition, all);
    for (const auto& problem : {plane_problem(all.I, condition, B), plane_problem(all.II, condition, C)})
      if (!problem.empty()) return problem;
    if (!all.I.empty() && std::fabs(condition[all.I[0]][B]) > 1e-12)
      return fmt::format(
          "B is {:g} deg in pattern 1: probe and C axis follow from poses at B = 0 alone (joint needs none)",
          condition[all.I[0]][B] / deg);
  }
  if (call.evaluation != joint_weighted) return "";
  if (!call.declared) return "weights follow from what a scenario declares; a table declares nothing: joint?";
  std::string problem;
  whitening(call, problem);
  return problem;
}

/// Directions that all commands together cannot see, among the unknowns and what is uncertain of links and artefact for
/// all readings alike.
std::vector<std::string> remarks(const BlockCall& call) {
  if (!is_joint(call.evaluation)) return {};
  std::vector<std::size_t> quantities;
  for (std::size_t j = 0; j < unknowns; ++j) quantities.push_back(j);
  const std::size_t declared = call.declared ? call.declared->draws.size() : 0; // a table declares nothing
  for (std::size_t i = 0; i < declared; ++i)
    if (const auto& draw = call.declared->draws[i];
        draw.moves.size() == call.readings && draw.moves[0].column >= link_B_x && draw.moves[0].column < E_AA)
      quantities.push_back(draw.moves[0].column);
  const std::size_t p = quantities.size(), n = 3 * call.readings;
  std::vector<double> jacobian(n * p), magnitude(p, 1e-3);
  const auto unseen_among = [&](std::size_t first) {
    std::vector<double> part;
    for (std::size_t i = 0; i < n; ++i) part.insert(part.end(), &jacobian[i * p], &jacobian[i * p] + first);
    return least_squares::parameter_covariance(
        part, n, first, {magnitude.begin(), magnitude.begin() + static_cast<std::ptrdiff_t>(first)}, unseen_below);
  };
  for (std::size_t r = 0; r < call.readings; ++r)
    for (std::size_t j = 0; j < p; ++j) {
      const auto d = derivative(call, r, quantities[j]);
      jacobian[3 * r * p + j] = d.x, jacobian[(3 * r + 1) * p + j] = d.y, jacobian[(3 * r + 2) * p + j] = d.z;
    }
  std::vector<least_squares::Parameter> names;
  for (const std::size_t q : quantities) {
    const QuantityCard& card = find("sphere_calibration")->card->quantities[q];
    names.push_back({std::string(card.name), std::string(card.unit), std::string(card.si_unit)});
  }
  std::vector<std::string> out;
  const auto machine = unseen_among(unknowns), all = unseen_among(p);
  if (machine.rank < unknowns)
    out.push_back(
        fmt::format("the poses see {} of 11 directions; along the others the unknowns stay as declared", machine.rank));
  for (const auto& direction : all.unseen) out.push_back(in_words(direction, names));
  return out;
}

} // namespace gumshoe::models::sphere
