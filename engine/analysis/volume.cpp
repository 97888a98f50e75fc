#include "analysis/volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "analysis/leaves.h"
#include "analysis/rounding.h"
#include "base/error.h"
#include "base/units.h"
#include "models/serial_chain/serial_chain.h"
#include "propagation/parallel.h"
#include "propagation/propagate.h"
#include "quantities/correlations.h"

namespace gumshoe::analysis {
namespace {

using propagation::Block;
using propagation::padded;
namespace chain = models::serial_chain;

constexpr std::size_t samples_at_once = 1024, points_at_once = 32;
constexpr double most = 2e9; ///< points times samples: minutes

/// Where a quantity of the chain has its values from.
struct Source {
  std::size_t quantity; ///< of the chain
  std::size_t column;   ///< of the plan
  bool machine;         ///< an error: without errors it is null
};

/// Sums over samples of what differs from the error at the estimates.
struct SumsAtPoint {
  double count = 0, d[3] = {}, square[3] = {}, length = 0, length_square = 0;
};

class Mapper {
public:
  Mapper(const propagation::Experiment& experiment, const scenario::Volume& volume)
      : experiment_(experiment), plan_(experiment.plan()), volume_(volume), card_(*volume.chain->card),
        sampler_(plan_, propagation::point_set(experiment.scenario().run.design), volume.samples),
        model_(*volume.chain, {}, 0, conditions()) {
    if (static_cast<double>(volume.points()) * static_cast<double>(volume.samples) > most)
      throw InputError(fmt::format("volume: {} points and {} samples take too long", volume.points(), volume.samples),
                       "their product exceeds 2e9", "ask for fewer of either");
    connect();
  }

  VolumeMap map(int threads) {
    VolumeMap out;
    out.samples = volume_.samples, out.seed = experiment_.scenario().run.seed;
    for (const scenario::VolumeRange& r : volume_.ranges) {
      const VariableCard& c = card_.conditions[r.axis];
      out.axes.push_back({std::string(c.name), std::string(c.unit), std::string(c.si_unit), r.from, r.to, r.points});
    }
    at_estimates(out);
    moments(out, threads);
    const auto by = [&](double VolumePoint::*member) {
      return static_cast<std::uint64_t>(std::ranges::max_element(out.points, {}, member) - out.points.begin());
    };
    out.largest = by(&VolumePoint::length), out.largest_u = by(&VolumePoint::u_length);
    causes(out);
    state(out);
    return out;
  }

private:
  std::vector<std::vector<double>> conditions() const {
    std::vector<std::vector<double>> out;
    for (std::size_t k = 0; k < volume_.points(); ++k) out.push_back(volume_.commands_at(k));
    return out;
  }

  /// Quantities by their names; the tip of a probe is the target. The instrument's place is no property of the machine.
  void connect() {
    const auto& all = experiment_.scenario().quantities;
    for (std::size_t j = 0; j < card_.quantities.size(); ++j) {
      const QuantityCard& q = card_.quantities[j];
      values_.push_back(q.default_value);
      if (j < chain::target_x) continue;
      const bool target = j < chain::gravity_x;
      if (target && volume_.tool) {
        values_[j] = (*volume_.tool)[j - chain::target_x];
        continue;
      }
      auto own = std::ranges::find(all, q.name, &quantities::InputQuantity::name);
      if (own == all.end() && target)
        own = std::ranges::find(all, "probe_" + std::string(q.name.substr(7)), &quantities::InputQuantity::name);
      if (own == all.end()) continue;
      const std::size_t column = column_of(static_cast<std::size_t>(own - all.begin()));
      values_[j] = plan_.estimate(column);
      sources_.push_back({j, column, j >= chain::first_of_axes});
    }
    for (const Source& s : sources_) tool_varies_ |= !s.machine && varies(s);
  }

  std::size_t column_of(std::size_t quantity) const {
    const std::size_t column = plan_.gather[0][quantity];
    for (const auto& reading : plan_.gather)
      if (plan_.columns[reading[quantity]].value != plan_.columns[column].value)
        throw InputError(
            fmt::format("volume: {} has several values, by label", experiment_.scenario().quantities[quantity].name),
            "a point of the volume has no labels", "state one value");
    return column;
  }

  bool varies(const Source& s) const { return !plan_.columns[s.column].variates.empty(); }

  /// Values of a row of the chain; `errors`: with the errors of the machine.
  std::vector<double> row(bool errors) const {
    std::vector<double> out = values_;
    for (std::size_t j = chain::first_of_axes; !errors && j < out.size(); ++j) out[j] = 0;
    out.resize(model_.layout().size(), 0.0);
    return out;
  }

  void at_estimates(VolumeMap& out) const {
    const std::size_t n = model_.readings();
    const auto actual = model_.indications(propagation::Points(n, row(true))),
               without = model_.indications(propagation::Points(n, row(false)));
    for (std::size_t k = 0; k < n; ++k) {
      const auto at = [&](std::size_t i) { return without.at(0, 3 * k + i); };
      const auto off = [&](std::size_t i) { return actual.at(0, 3 * k + i) - at(i); };
      out.points.push_back({at(0), at(1), at(2), off(0), off(1), off(2)});
    }
  }

  /// The drawn columns of the sources, one after another.
  std::vector<double> drawn(std::size_t first, std::size_t n) const {
    std::vector<double> variates(plan_.variates.size() * n), out(sources_.size() * n);
    sampler_.draw(first, n, quantities::Purpose::sampling, variates.data(), n);
    std::vector<const double*> rows;
    for (std::size_t v = 0; v < plan_.variates.size(); ++v) rows.push_back(variates.data() + v * n);
    for (std::size_t s = 0; s < sources_.size(); ++s)
      if (varies(sources_[s])) plan_.assemble_column(sources_[s].column, rows, n, out.data() + s * n);
    return out;
  }

  /// Sums of the samples [first, first + count) at every point; how many of them have no value at some point.
  std::uint64_t add(const VolumeMap& map, std::size_t first, std::size_t count, SumsAtPoint* sums) const {
    const std::size_t n = padded(count);
    const std::vector<double> columns = drawn(first, n), fixed = row(true), null = row(false);
    std::vector<models::Column> actual, without;
    for (std::size_t j = 0; j < fixed.size(); ++j) actual.push_back({&fixed[j], 0}), without.push_back({&null[j], 0});
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      if (!varies(sources_[s])) continue;
      actual[sources_[s].quantity] = {&columns[s * n], 1};
      if (!sources_[s].machine) without[sources_[s].quantity] = {&columns[s * n], 1};
    }
    const std::size_t of_nominal = tool_varies_ ? n : 8;
    std::vector<bool> missing(count, false);
    Block block, nominal;
    for (std::size_t from = 0; from < map.points.size(); from += points_at_once) {
      const std::size_t to = std::min(map.points.size(), from + points_at_once);
      block.clear(n), nominal.clear(of_nominal);
      for (std::size_t k = from; k < to; ++k) model_.add(block, k, actual), model_.add(nominal, k, without);
      const auto here = model_.simulate(block), there = model_.simulate(nominal);
      for (std::size_t k = from; k < to; ++k) {
        const VolumePoint& p = map.points[k];
        const double mean[] = {p.error_x, p.error_y, p.error_z}, length = std::hypot(mean[0], mean[1], mean[2]);
        SumsAtPoint& sum = sums[k];
        for (std::size_t i = 0; i < count; ++i) {
          if (here.status[i] != 0) {
            missing[i] = true;
            continue;
          }
          double e[3];
          for (std::size_t a = 0; a < 3; ++a) {
            const std::size_t line = 3 * (k - from) + a;
            e[a] = here.indications[line * n + i] - there.indications[line * of_nominal + (tool_varies_ ? i : 0)];
            const double d = e[a] - mean[a];
            sum.d[a] += d, sum.square[a] += d * d;
          }
          const double d = std::hypot(e[0], e[1], e[2]) - length;
          sum.length += d, sum.length_square += d * d, ++sum.count;
        }
      }
    }
    return static_cast<std::uint64_t>(std::ranges::count(missing, true));
  }

  void moments(VolumeMap& out, int threads) const {
    const std::size_t n = out.points.size(), samples = volume_.samples,
                      blocks = (samples + samples_at_once - 1) / samples_at_once;
    std::vector<SumsAtPoint> sums(blocks * n);
    std::vector<std::uint64_t> failed(blocks);
    propagation::parallel_for(blocks, threads, [&](std::size_t b) {
      const std::size_t first = b * samples_at_once;
      failed[b] = add(out, first, std::min(samples_at_once, samples - first), &sums[b * n]);
    });
    out.failed = std::accumulate(failed.begin(), failed.end(), std::uint64_t{0});
    for (std::size_t k = 0; k < n; ++k) {
      const auto total = [&](auto member) {
        return sum_of(blocks, [&](std::size_t b) { return member(sums[b * n + k]); });
      };
      const double count = total([](const SumsAtPoint& s) { return s.count; });
      const auto moment = [&](double sum, double square, double& mean, double& u) {
        mean += sum / count;
        u = std::sqrt(std::max(0.0, (square - sum * sum / count) / (count - 1)));
      };
      VolumePoint& p = out.points[k];
      double* const mean[] = {&p.error_x, &p.error_y, &p.error_z};
      double* const u[] = {&p.u_x, &p.u_y, &p.u_z};
      p.length = std::hypot(p.error_x, p.error_y, p.error_z);
      for (std::size_t a = 0; a < 3; ++a)
        moment(total([=](const SumsAtPoint& s) { return s.d[a]; }),
               total([=](const SumsAtPoint& s) { return s.square[a]; }), *mean[a], *u[a]);
      moment(total([](const SumsAtPoint& s) { return s.length; }),
             total([](const SumsAtPoint& s) { return s.length_square; }), p.length, p.u_length);
    }
  }

  /// Direction of the mean error; of an error without a mean, the axis of the largest u.
  static std::array<double, 3> direction(const VolumePoint& p) {
    const double length = std::hypot(p.error_x, p.error_y, p.error_z);
    if (length > 0) return {p.error_x / length, p.error_y / length, p.error_z / length};
    const double u[] = {p.u_x, p.u_y, p.u_z};
    std::array<double, 3> out{};
    out[static_cast<std::size_t>(std::ranges::max_element(u) - u)] = 1;
    return out;
  }

  /// Derivatives of the error along `along` at a point, by source.
  std::vector<double> sensitivities(std::size_t point, const std::array<double, 3>& along) const {
    const propagation::ForwardModel here(*volume_.chain, {}, 0, {volume_.commands_at(point)});
    std::vector<propagation::Partial> partials;
    for (const Source& s : sources_) partials.push_back({s.quantity});
    const auto actual = here.linearise({row(true)}, partials), without = here.linearise({row(false)}, partials);
    std::vector<double> out;
    for (std::size_t s = 0; s < sources_.size(); ++s) {
      double c = 0;
      for (std::size_t a = 0; a < 3; ++a)
        c += along[a] * (actual.derivatives[s * actual.rows + a] -
                         (sources_[s].machine ? 0 : without.derivatives[s * without.rows + a]));
      out.push_back(c);
    }
    return out;
  }

  void causes(VolumeMap& out) const {
    const std::vector<double> c = sensitivities(out.largest, direction(out.points[out.largest]));
    // Covariances of what is declared with the linear error: a draw may move several quantities.
    const std::size_t n = sources_.size();
    std::vector<double> of_draw(plan_.variates.size(), 0.0);
    for (std::size_t s = 0; s < n; ++s)
      for (const std::size_t v : plan_.columns[sources_[s].column].variates) of_draw[v] += c[s];
    quantities::Correlations correlations(plan_);
    std::vector<double> variance(n), with(n);
    double of_error = 0;
    for (std::size_t s = 0; s < n; ++s) {
      const auto& own = plan_.columns[sources_[s].column].variates;
      for (const std::size_t v : own) {
        for (const std::size_t w : own) variance[s] += correlations.covariance(v, w);
        for (std::size_t w = 0; w < of_draw.size(); ++w)
          if (of_draw[w] != 0) with[s] += of_draw[w] * correlations.covariance(v, w);
      }
      of_error += c[s] * with[s];
    }
    of_error = std::max(0.0, of_error);
    out.linear_u = std::sqrt(of_error);
    for (std::size_t s = 0; s < n; ++s) {
      const double value = values_[sources_[s].quantity];
      const QuantityCard& q = card_.quantities[sources_[s].quantity];
      VolumeShare one{experiment_.scenario().quantities[plan_.columns[sources_[s].column].quantity].name,
                      std::string(q.unit),
                      std::string(q.si_unit),
                      value,
                      std::sqrt(std::max(0.0, variance[s])),
                      c[s],
                      sources_[s].machine ? c[s] * value : 0,
                      of_error > 0 ? c[s] * with[s] / of_error : 0};
      if (c[s] != 0 && (one.error != 0 || variance[s] > 0)) out.shares.push_back(std::move(one));
    }
    std::ranges::stable_sort(out.shares, std::greater{},
                             [](const VolumeShare& s) { return std::pair(std::fabs(s.error), std::fabs(s.share)); });
  }

  std::string place(std::size_t point) const {
    std::string out;
    const std::vector<double> commands = volume_.commands_at(point);
    for (const scenario::VolumeRange& r : volume_.ranges) {
      const VariableCard& c = card_.conditions[r.axis];
      out += fmt::format("{}{} {:.6g} {}", out.empty() ? "" : ", ", c.name,
                         units::from_si(commands[r.axis], std::string(c.unit), std::string(c.si_unit)), c.unit);
    }
    return out;
  }

  void state(VolumeMap& out) const {
    const VolumePoint& worst = out.points[out.largest];
    const auto text = [](double x) { return with_suitable_unit(x, "mm", "m"); };
    if (worst.length == 0 && worst.u_length == 0) {
      out.statement = "There is no error: the scenario states none of an axis, and no uncertain one.";
      return;
    }
    const double least = std::ranges::min_element(out.points, {}, &VolumePoint::length)->length;
    const double by_chance = 4 * worst.u_length / std::sqrt(static_cast<double>(out.samples));
    const bool alike = out.points.size() > 1 && by_chance > 0 && worst.length - least <= by_chance;
    out.statement =
        fmt::format("The {} {} (u = {}), at {}.",
                    alike ? fmt::format("error is as large at all {} points:", out.points.size()) : "largest error is",
                    text(worst.length), text(worst.u_length), place(out.largest));
    const double mean = std::hypot(worst.error_x, worst.error_y, worst.error_z);
    if (mean < worst.length / 2)
      out.statement += fmt::format(" This is the mean length of an uncertain error, whose mean is {}.", text(mean));
    if (!out.shares.empty() && out.shares[0].error != 0)
      out.statement +=
          fmt::format(" {} causes the largest part of it, {}.", out.shares[0].name, text(out.shares[0].error));
    const auto most_uncertain = std::ranges::max_element(out.shares, {}, &VolumeShare::share);
    if (most_uncertain != out.shares.end() && most_uncertain->share > 0)
      out.statement += fmt::format(" Along that error, {} contributes most to the variance ({}).", most_uncertain->name,
                                   share_text(most_uncertain->share));
    const double apart = 0.05 + 3 / std::sqrt(2 * static_cast<double>(out.samples));
    if (std::fabs(worst.u_length - out.linear_u) > apart * worst.u_length)
      out.notes.push_back(
          fmt::format("the shares are those of the error along its mean, whose u is {}; the length has u = {}, "
                      "because what is uncertain across that direction, or not linear, counts as well",
                      text(out.linear_u), text(worst.u_length)));
    if (!experiment_.scenario().stated_effects.empty() || experiment_.layout().effects.size() > 0)
      out.notes.emplace_back("effects on the readings are no errors of the machine's axes, and are not in the map");
  }

  const propagation::Experiment& experiment_;
  const quantities::SamplePlan& plan_;
  const scenario::Volume& volume_;
  const ModelCard& card_;
  quantities::Sampler sampler_;
  propagation::ForwardModel model_;
  std::vector<double> values_; ///< of the chain's quantities at the estimates
  std::vector<Source> sources_;
  bool tool_varies_ = false;
};

} // namespace

VolumeMap volume(const propagation::Experiment& experiment, const scenario::Volume& over, int threads) {
  return Mapper(experiment, over).map(threads);
}

} // namespace gumshoe::analysis
