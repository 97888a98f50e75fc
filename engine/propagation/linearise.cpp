// Derivatives of the indications: by dual numbers, else by central differences.
#include <algorithm>

#include "propagation/forward_model.h"
#include "propagation/parallel.h"

namespace gumshoe::propagation {
namespace {

/// Place of the first partial that is the same: one may be asked for twice.
std::size_t first_like(std::span<const Partial> partials, std::size_t i) {
  std::size_t first = 0;
  while (partials[first].quantity != partials[i].quantity || partials[first].readings != partials[i].readings) ++first;
  return first;
}

/// By reading: the partials that its indications may depend on.
std::vector<std::vector<std::size_t>> partials_at(std::span<const Partial> partials, const Layout& layout,
                                                  std::size_t readings) {
  std::vector<std::vector<std::size_t>> out(readings);
  for (std::size_t i = 0; i < partials.size(); ++i) {
    if (layout.indications.contains(partials[i].quantity) || first_like(partials, i) != i) continue;
    if (partials[i].readings.empty())
      for (auto& at : out) at.push_back(i);
    else
      for (const std::size_t r : partials[i].readings) out[r].push_back(i);
  }
  return out;
}

} // namespace

Linearisation ForwardModel::linearise(const Points& at, std::span<const Partial> partials) const {
  Linearisation out;
  out.rows = at.size() * layout_.indications.size();
  out.derivatives.assign(partials.size() * out.rows, 0.0);
  out.by_partial.assign(partials.size(), Status::ok);
  if (has_derivatives())
    by_dual_numbers(at, partials, out);
  else
    by_differences(at, partials, out);
  return out;
}

void ForwardModel::by_dual_numbers(const Points& at, std::span<const Partial> partials, Linearisation& out) const {
  constexpr std::size_t lanes = 8, part = 16;
  const std::size_t readings = at.size(), indications_here = layout_.indications.size();
  const auto wanted = partials_at(partials, layout_, readings);
  out.values.assign(out.rows, 0.0);
  std::vector<models::PointOutcome> outcomes(readings);
  using Gradients = std::vector<models::Gradient>; // of a part of the readings: memory is not asked for at each of many
  const auto one = [&](std::size_t r, Gradients& point, Gradients& found) {
    point.assign(at[r].begin(), at[r].end());
    std::size_t from = 0;
    do {
      const std::size_t to = std::min(wanted[r].size(), from + lanes);
      for (std::size_t i = from; i < to; ++i) {
        const std::size_t q = partials[wanted[r][i]].quantity;
        point[q] = models::Gradient::variable(at[r][q], static_cast<int>(i - from));
      }
      const auto outcome = indications(r, point, found);
      outcomes[r].status = outcome.status;
      outcomes[r].kink |= outcome.kink;
      if (outcome.status != 0) return;
      for (std::size_t k = 0; k < indications_here; ++k) {
        const std::size_t row = r * indications_here + k;
        out.values[row] = found[k].v;
        for (std::size_t i = from; i < to; ++i) out.derivatives[wanted[r][i] * out.rows + row] = found[k].d[i - from];
      }
      for (std::size_t i = from; i < to; ++i) {
        const std::size_t q = partials[wanted[r][i]].quantity;
        point[q] = models::Gradient(at[r][q]);
      }
      from = to;
    } while (from < wanted[r].size());
  };
  const auto order = alike_together(at);
  const auto some = [&](std::size_t p) {
    Gradients point, found;
    for (std::size_t i = p * part; i < std::min(readings, (p + 1) * part); ++i) one(order[i], point, found);
  };
  const std::size_t parts = (readings + part - 1) / part;
  if (parts == 1 || threads_ == 1)
    for (std::size_t p = 0; p < parts; ++p) some(p);
  else
    parallel_for(parts, threads_, some);
  for (std::size_t r = readings; r-- > 0;) {
    out.kink |= outcomes[r].kink;
    if (outcomes[r].status == 0) continue;
    out.status = static_cast<Status>(outcomes[r].status);
    out.failed_reading = r;
  }
  for (std::size_t i = 0; i < partials.size(); ++i)
    if (const std::size_t first = first_like(partials, i); first < i)
      std::copy_n(&out.derivatives[first * out.rows], out.rows, &out.derivatives[i * out.rows]);
}

void ForwardModel::by_differences(const Points& at, std::span<const Partial> partials, Linearisation& out) const {
  std::vector<Variation> variations(1);
  for (const Partial& p : partials)
    for (const double to : {p.up, p.down}) variations.push_back({{{p.quantity, to, p.absolute, p.readings}}});
  const Responses f = indications(at, variations);
  out.values.assign(f.values.begin(), f.values.begin() + static_cast<std::ptrdiff_t>(out.rows));
  out.status = f.status[0];
  for (std::size_t i = 0; i < partials.size(); ++i) {
    const std::size_t up = 1 + 2 * i, down = up + 1;
    out.by_partial[i] = f.status[up] != Status::ok ? f.status[up] : f.status[down];
    if (out.by_partial[i] != Status::ok) continue;
    for (std::size_t row = 0; row < out.rows; ++row)
      out.derivatives[i * out.rows + row] = (f.at(up, row) - f.at(down, row)) / (partials[i].up - partials[i].down);
  }
}

} // namespace gumshoe::propagation
