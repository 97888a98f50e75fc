// Answers of a model at points under variations, readings in parts and in parallel.
#include <algorithm>
#include <map>
#include <numeric>

#include "propagation/forward_model.h"
#include "propagation/parallel.h"

namespace gumshoe::propagation {
namespace {

struct Varied {
  std::size_t variation;
  const Change* change;
};
/// By quantity. What no variation changes is one number for all of them.
using VariedBy = std::map<std::size_t, std::vector<Varied>>;

VariedBy varied_by(std::span<const Variation> variations) {
  VariedBy out;
  for (std::size_t v = 0; v < variations.size(); ++v)
    for (const Change& c : variations[v].changes) out[c.quantity].push_back({v, &c});
  return out;
}

bool concerns(const Change& change, std::size_t reading) {
  return change.readings.empty() || std::ranges::binary_search(change.readings, reading);
}

/// Columns of a reading: its point, with a value per variation where some variation changes it. `values` has room.
void wire(const std::vector<double>& point, std::size_t reading, const VariedBy& varied, std::size_t samples,
          std::vector<double>& values, std::vector<models::Column>& row) {
  row.clear();
  for (const double& x : point) row.push_back({&x, 0});
  for (const auto& [quantity, changes] : varied) {
    const auto here = [&](const Varied& v) { return concerns(*v.change, reading); };
    if (std::ranges::none_of(changes, here)) continue;
    const double x = point[quantity];
    const std::size_t start = values.size();
    values.resize(start + samples, x);
    for (const Varied& v : changes)
      if (here(v)) values[start + v.variation] = v.change->absolute ? v.change->value : x + v.change->value;
    row[quantity] = {&values[start], 1};
  }
}

} // namespace

std::vector<std::size_t> ForwardModel::alike_together(const Points& at) const {
  std::vector<std::size_t> out(at.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  const auto end = static_cast<std::ptrdiff_t>(layout_.model.end);
  std::ranges::stable_sort(out, [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(at[a].begin(), at[a].begin() + end, at[b].begin(), at[b].begin() + end);
  });
  return out;
}

Responses ForwardModel::respond(Kernel kernel, std::span<const std::size_t> readings, const Points& at,
                                std::span<const Variation> variations) const {
  // A joint evaluation takes all readings, in their order.
  const bool evaluates = kernel == &ForwardModel::evaluate, whole = evaluates && joint();
  const std::size_t count = variations.size(), samples = padded(count), places = readings.size();
  std::vector<std::size_t> order(places);
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (!whole) order = alike_together(at);
  // Readings in parts, so that threads share the work and buffers stay small.
  const std::size_t part = whole ? places : 32, parts = (places + part - 1) / part;
  const std::size_t per_place = evaluates ? model_->card->measurands.size() : layout_.indications.size();
  const VariedBy varied = varied_by(variations);
  Responses out;
  out.rows = whole ? measurands(at[0].data()).size() : places * per_place;
  out.values.resize(count * out.rows);
  if (count == 0) return out;
  std::vector<std::vector<std::uint8_t>> status(parts);
  const auto one = [&](std::size_t p) {
    const std::size_t first = p * part, last = std::min(places, first + part);
    Block block;
    block.clear(samples);
    std::vector<double> values;
    values.reserve((last - first) * varied.size() * samples);
    std::vector<models::Column> row;
    for (std::size_t k = first; k < last; ++k) {
      wire(at[order[k]], readings[order[k]], varied, samples, values, row);
      add(block, readings[order[k]], row);
    }
    BlockValues found = (this->*kernel)(block);
    const auto& rows = evaluates ? found.measurands : found.indications;
    for (std::size_t i = 0; i < rows.size() / samples; ++i) {
      const std::size_t to = whole ? i : order[first + i / per_place] * per_place + i % per_place;
      for (std::size_t v = 0; v < count; ++v) out.values[v * out.rows + to] = rows[i * samples + v];
    }
    status[p] = std::move(found.status);
  };
  // What a user wrote may not be safe to call from several threads.
  if (parts == 1 || threads_ == 1 || model_->context)
    for (std::size_t p = 0; p < parts; ++p) one(p);
  else
    parallel_for(parts, threads_, one);
  out.status.assign(count, Status::ok);
  for (const auto& s : status)
    for (std::size_t v = 0; v < count; ++v)
      if (out.status[v] == Status::ok) out.status[v] = static_cast<Status>(s[v]);
  return out;
}

namespace {

std::vector<std::size_t> all_of(const Points& at) {
  std::vector<std::size_t> out(at.size());
  std::iota(out.begin(), out.end(), std::size_t{0});
  return out;
}

} // namespace

Responses ForwardModel::indications(const Points& at, std::span<const Variation> variations) const {
  return respond(&ForwardModel::simulate, all_of(at), at, variations);
}

Responses ForwardModel::indications(std::size_t reading, const std::vector<double>& point,
                                    std::span<const Variation> variations) const {
  return respond(&ForwardModel::simulate, {&reading, 1}, {point}, variations);
}

Responses ForwardModel::indications(const Points& at) const {
  const Variation none;
  return indications(at, {&none, 1});
}

Responses ForwardModel::measurands(const Points& at, std::span<const Variation> variations) const {
  return respond(&ForwardModel::evaluate, all_of(at), at, variations);
}

Responses ForwardModel::measurands(std::size_t reading, const std::vector<double>& point,
                                   std::span<const Variation> variations) const {
  return respond(&ForwardModel::evaluate, {&reading, 1}, {point}, variations);
}

} // namespace gumshoe::propagation
