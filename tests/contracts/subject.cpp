#include "contracts/subject.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/units.h"

namespace gumshoe::contracts {

using models::Curvature, models::Gradient;

namespace {

constexpr double roundings = 64 * std::numeric_limits<double>::epsilon();

bool same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (std::isnan(a) && std::isnan(b));
}

/// What is small for a quantity of this unit whose value is 0.
double small(std::string_view si_unit) { return si_unit == "m" ? 1e-4 : si_unit == "rad" ? 5e-3 : 1e-3; }

/// A number of things: 1 to 12.
bool counts(const QuantityCard& q) {
  const auto whole = [](double x) { return x == std::floor(x); };
  return q.si_unit == "1" && q.limits.high - q.limits.low > 1 && q.limits.high - q.limits.low <= 1000 &&
         whole(q.limits.low) && whole(q.limits.high) && whole(q.default_value);
}

/// Derivatives by eight variables a pass.
template <class Solve> Derived derive(std::size_t variables, std::span<const VariableCard> cards, const Point& p, const Solve& solve) {
  const std::size_t outputs = cards.size();
  Derived out;
  out.cards = cards;
  out.derivatives.assign(outputs, std::vector<double>(variables));
  for (std::size_t first = 0; first < std::max<std::size_t>(variables, 1); first += 8) {
    std::vector<Gradient> x(p.x.begin(), p.x.end()), y(outputs);
    const std::size_t n = std::min<std::size_t>(8, variables - std::min(first, variables));
    for (std::size_t j = 0; j < n; ++j) x[first + j] = Gradient::variable(p.x[first + j], static_cast<int>(j));
    const models::PointOutcome outcome = solve(x, y);
    out.status = outcome.status, out.kink |= outcome.kink;
    out.values.clear();
    for (const Gradient& v : y) out.values.push_back(v.v);
    for (std::size_t o = 0; o < outputs; ++o)
      for (std::size_t j = 0; j < n; ++j) out.derivatives[o][first + j] = y[o].d[j];
  }
  return out;
}

} // namespace

double typical(const QuantityCard& card) { return card.typical.high > 0 ? card.typical.high : card.default_value; }

bool is_unit_of_si(std::string_view unit, std::string_view si_unit) {
  const std::string si(si_unit);
  return units::convertible(std::string(unit), si) && units::to_si(1, si, units::si_unit_of(si)) == 1;
}

bool Outcome::operator==(const Outcome& other) const {
  return status == other.status && (status != 0 || std::ranges::equal(values, other.values, same));
}

Subject::Subject(const models::Model& model, const std::vector<const EffectCard*>& freed)
    : model_(model), freed_(freed) {
  const auto add = [&](const std::string& prefix, const QuantityCard& q) {
    cards_.push_back(&q);
    names_.push_back(prefix + std::string(q.name));
  };
  for (const QuantityCard& q : model.card->quantities) add("", q);
  for (const EffectCard* effect : freed)
    for (const QuantityCard& q : effect->quantities) add(std::string(effect->name) + '.', q);
}

std::string Subject::name(std::size_t i) const {
  return i < names_.size() ? names_[i] : std::string(model_.card->indications[i - names_.size()].name);
}

Point Subject::at_null(const Point& plain) const {
  Point p{{plain.x.begin(), plain.x.begin() + static_cast<std::ptrdiff_t>(first_effect())}, plain.conditions};
  for (std::size_t i = first_effect(); i < first_indication(); ++i) p.x.push_back(cards_[i]->default_value);
  const std::size_t n = model_.card->indications.size();
  for (std::size_t k = 0; k < n; ++k)
    p.x.push_back(plain.x.size() >= first_effect() + n ? plain.x[plain.x.size() - n + k] : 0.0);
  return p;
}

bool Subject::possible(const Point& p) const {
  for (std::size_t i = 0; i < first_indication(); ++i)
    if (!cards_[i]->limits.contain(p.x[i])) return false;
  return at(p).check(0, p.x).empty();
}

double Subject::spread(std::size_t i, const Point& p) const {
  if (i >= first_effect() && i < first_indication()) return typical(*cards_[i]);
  const auto& k = model_.card->indications;
  const std::string_view unit = i < first_indication() ? cards_[i]->si_unit : k[i - first_indication()].si_unit;
  return p.x[i] != 0 ? 0.02 * std::fabs(p.x[i]) : small(unit);
}

Point Subject::random(const Point& around, Draw& draw, bool with_effects) const {
  Point p = at_null(around);
  const auto propose = [&](double& value, double proposed) {
    const double before = std::exchange(value, proposed);
    if (!possible(p)) value = before;
  };
  for (std::size_t c = 0; c < p.conditions.size(); ++c) {
    const std::string_view unit = model_.card->conditions[c].si_unit;
    const double at = p.conditions[c];
    const double proposed = unit == "rad"                           ? at + draw(-0.4, 0.4)
                            : unit == "s"                           ? draw(0, 7200)
                            : unit == "1" && std::fabs(at) <= 1     ? std::floor(draw(-1, 2))
                            : at != 0                               ? at * draw(0.7, 1.3)
                                                                    : draw(-0.1, 0.1);
    propose(p.conditions[c], proposed);
  }
  for (std::size_t i = 0; i < first_effect(); ++i)
    propose(p.x[i], counts(*cards_[i]) ? std::floor(draw(cards_[i]->limits.low, cards_[i]->limits.high + 1))
                                       : p.x[i] + draw(-1, 1) * spread(i, p));
  for (std::size_t i = first_effect(); with_effects && i < first_indication(); ++i) {
    const QuantityCard& q = *cards_[i];
    const double to = typical(q), share = draw(0.3, 1);
    if (q.role == Role::shape) continue;
    propose(p.x[i], to); // whole numbers, where nothing else is possible
    propose(p.x[i], (q.limits.low < 0 && draw(0, 1) < 0.5 ? -1 : 1) * share * to);
  }
  return p;
}

std::optional<Point> Subject::read(const Point& p) const {
  const std::size_t n = model_.card->indications.size();
  if (n == 0) return p;
  if (!simulates()) return std::nullopt;
  const Outcome s = simulate({p})[0];
  if (!s.ok()) return std::nullopt;
  Point out = p;
  std::copy_n(s.values.begin(), n, out.x.begin() + static_cast<std::ptrdiff_t>(first_indication()));
  return out;
}

std::vector<Outcome> Subject::simulate(const std::vector<Point>& points) const { return run(points, true); }
std::vector<Outcome> Subject::evaluate(const std::vector<Point>& points) const { return run(points, false); }

std::vector<Outcome> Subject::run(const std::vector<Point>& points, bool simulating) const {
  const std::size_t n = propagation::padded(points.size()), conditions = points[0].conditions.size();
  std::vector<double> in((size() + conditions) * n);
  for (std::size_t i = 0; i < n; ++i) {
    const Point& p = points[std::min(i, points.size() - 1)];
    for (std::size_t j = 0; j < size(); ++j) in[j * n + i] = p.x[j];
    for (std::size_t j = 0; j < conditions; ++j) in[(size() + j) * n + i] = p.conditions[j];
  }
  std::vector<models::Column> columns;
  for (std::size_t j = 0; j < size() + conditions; ++j) columns.push_back({&in[j * n], 1});
  const propagation::ForwardModel forward = at(points[0]);
  propagation::Block block;
  block.clear(n);
  const std::span all(columns);
  forward.add(block, 0, all.first(size()), all.subspan(size()));
  const propagation::BlockValues out = simulating ? forward.simulate(block) : forward.evaluate(block);
  std::vector<Outcome> outcomes(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    outcomes[i].status = out.status[i];
    for (const auto* rows : {&out.indications, &out.measurands})
      for (std::size_t at = i; at < rows->size() && (simulating || rows == &out.measurands); at += n)
        outcomes[i].values.push_back((*rows)[at]);
  }
  return outcomes;
}

Derived Subject::simulate_gradient(const Point& p) const {
  return derive(first_indication(), model_.card->indications, p,
                [&](const auto& x, auto& y) { return at(p).indications(0, x, y); });
}

Derived Subject::evaluate_gradient(const Point& p) const {
  return derive(size(), model_.card->measurands, p,
                [&](const auto& x, auto& y) { return at(p).measurands(0, x, y); });
}

std::vector<std::vector<double>> Subject::curvature(const Point& p, const std::vector<std::size_t>& by) const {
  std::vector<Curvature> x(p.x.begin(), p.x.end()), y(model_.card->measurands.size());
  for (std::size_t a = 0; a < by.size(); ++a) {
    x[by[a]].v = Gradient::variable(p.x[by[a]], static_cast<int>(a));
    x[by[a]].d[a] = Gradient(1.0);
  }
  at(p).measurands(0, x, y);
  std::vector<std::vector<double>> out;
  for (const Curvature& v : y) {
    out.emplace_back();
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < 8; ++b) out.back().push_back(v.d[a].d[b]);
  }
  return out;
}

std::vector<double> Subject::rounding(const Derived& outputs, const Point& p) const {
  std::vector<double> out;
  for (std::size_t o = 0; o < outputs.values.size(); ++o) {
    double sum = std::fabs(outputs.values[o]);
    for (std::size_t i = 0; i < outputs.derivatives[o].size(); ++i)
      sum += std::fabs(outputs.derivatives[o][i] * p.x[i]);
    out.push_back(roundings * sum);
  }
  std::vector<double> largest = out;
  for (std::size_t a = 0; a < out.size(); ++a)
    for (std::size_t b = 0; b < out.size(); ++b)
      if (outputs.cards[a].si_unit == outputs.cards[b].si_unit) largest[a] = std::max(largest[a], out[b]);
  return largest;
}

} // namespace gumshoe::contracts
