#include "models/shown_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <fmt/format.h>

#include "base/units.h"

namespace gumshoe::models {
namespace {

template <class Card>
void show(const std::vector<Card>& cards, const Column* columns, std::size_t samples, std::vector<Column>& out,
          std::deque<std::vector<double>>& converted) {
  for (std::size_t i = 0; i < cards.size(); ++i) {
    if (cards[i].unit == cards[i].si_unit) {
      out.push_back(columns[i]);
      continue;
    }
    const Column& c = columns[i];
    auto& values = converted.emplace_back(c.data, c.data + (c.stride == 0 ? 1 : samples));
    units::from_si(values, std::string(cards[i].unit), std::string(cards[i].si_unit));
    out.push_back({values.data(), c.stride});
  }
}

template <class Card> std::vector<Card> list(std::span<const Card> cards) { return {cards.begin(), cards.end()}; }

} // namespace

ShownReading shown_reading(const ModelCard& card, const BlockCall& call, std::size_t r, bool indications) {
  ShownReading s;
  show(list(card.quantities), call.quantities + r * card.quantities.size(), call.samples, s.quantities, s.converted);
  show(list(card.conditions), call.conditions + r * card.conditions.size(), call.samples, s.conditions, s.converted);
  if (indications)
    show(list(card.indications), call.indications + r * card.indications.size(), call.samples, s.indications,
         s.converted);
  return s;
}

void take_shown(const VariableCard& variable, double* values, std::size_t n, std::uint8_t* status) {
  if (variable.unit != variable.si_unit)
    units::to_si({values, n}, std::string(variable.unit), std::string(variable.si_unit));
  for (std::size_t i = 0; i < n; ++i)
    if (!std::isfinite(values[i]) && status[i] == 0) status[i] = code(Status::model_failed);
}

namespace {

/// The same point `n` times in one call.
struct PointValues {
  std::vector<double> measurands; ///< [measurand][n], SI
  std::vector<std::uint8_t> status;
};

PointValues evaluate_at(const ModelCard& card, const PointCall<double>& point, void (*kernel)(const BlockCall&),
                        std::size_t n) {
  PointValues values{std::vector<double>(card.measurands.size() * n), std::vector<std::uint8_t>(n)};
  std::vector<Column> columns;
  const auto add = [&](const double* data, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) columns.push_back({data + i, 0});
  };
  add(point.quantities, card.quantities.size());
  add(point.conditions, card.conditions.size());
  add(point.indications, card.indications.size());
  std::vector<double*> measurands;
  for (std::size_t m = 0; m < card.measurands.size(); ++m) measurands.push_back(&values.measurands[m * n]);
  const std::size_t itself = 0;
  BlockCall call;
  call.samples = n;
  call.readings = 1;
  call.quantities = columns.data();
  call.conditions = columns.data() + card.quantities.size();
  call.indications = columns.data() + card.quantities.size() + card.conditions.size();
  call.measurands = measurands.data();
  call.solved_as = &itself;
  call.status = values.status.data();
  call.evaluation = point.evaluation;
  call.context = point.context;
  kernel(call);
  return values;
}

} // namespace

std::string differing_answers(const ModelCard& card, const PointCall<double>& point, void (*kernel)(const BlockCall&)) {
  const PointValues one = evaluate_at(card, point, kernel, 1), two = evaluate_at(card, point, kernel, 2);
  for (std::size_t m = 0; m < card.measurands.size(); ++m) {
    const VariableCard& y = card.measurands[m];
    for (const auto& [a, status_a, b, status_b] :
         {std::tuple{two.measurands[2 * m], two.status[0], two.measurands[2 * m + 1], two.status[1]},
          std::tuple{two.measurands[2 * m], two.status[0], one.measurands[m], one.status[0]}}) {
      if (status_a != status_b) return "it fails at one of two equal points";
      if (status_a != 0 || std::fabs(a - b) <= 1e-12 * std::max(std::fabs(a), std::fabs(b))) continue;
      const std::string unit(y.unit), si(y.si_unit);
      return fmt::format("{} is {:.12g} {}, then {:.12g} {}", y.name, units::from_si(a, unit, si), unit,
                         units::from_si(b, unit, si), unit);
    }
  }
  return {};
}

std::vector<Intermediate> explained(const ModelCard& card, const PointCall<double>& point,
                                    void (*kernel)(const BlockCall&)) {
  const PointValues values = evaluate_at(card, point, kernel, 1);
  std::vector<Intermediate> out;
  for (std::size_t m = 0; m < card.measurands.size(); ++m) {
    const std::string unit(card.measurands[m].unit);
    out.push_back({std::string(card.measurands[m].name), unit,
                   values.status[0] == 0
                       ? units::from_si(values.measurands[m], unit, std::string(card.measurands[m].si_unit))
                       : std::numeric_limits<double>::quiet_NaN()});
  }
  return out;
}

std::string span_text(std::uint64_t first, std::size_t offset, std::size_t n) {
  if (first == unnumbered) return n == 1 ? "a point outside the run" : fmt::format("{} points outside the run", n);
  return fmt::format("samples {} to {}", first + offset, first + offset + n - 1);
}

} // namespace gumshoe::models
