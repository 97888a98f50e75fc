#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <stdexcept>

#include "base/error.h"
#include "base/hash.h"
#include "quantities/cells.h"
#include "quantities/quantile_kernels.h"
#include "quantities/sample_plan.h"
#include "random/latin_hypercube.h"
#include "random/sobol.h"

namespace gumshoe::quantities {
namespace {

constexpr std::size_t strip = 512; // stays in the first-level cache between the steps
constexpr std::uint32_t purposes = 5;
/// Each purpose has its own dimensions, so that the two matrices of a pick-freeze design are independent.
constexpr std::uint32_t dimensions_per_purpose = random::sobol_dimensions / purposes;

/// A free Sobol' dimension by hash of the variate's key. Where two variates hash to the same one the
/// later in the plan moves on, so adding a variate rarely, and only by such an accident, moves another.
std::optional<std::uint32_t> take_dimension(std::uint64_t key, std::set<std::uint32_t>& taken) {
  for (std::uint64_t attempt = 0; attempt < 64; ++attempt) {
    const auto dimension = static_cast<std::uint32_t>(mix64(key + attempt) % dimensions_per_purpose);
    if (taken.insert(dimension).second) return dimension;
  }
  return std::nullopt; // hundreds of variates: the rest are plain Monte Carlo
}

} // namespace

struct Sampler::Impl {
  struct Source {
    random::Stream stream;
    QuantileFunction quantile;
    bool normal; ///< takes z directly in a copula
    double mean, u;
    std::optional<std::uint32_t> dimension;
    std::vector<random::SobolDimension> sobol; ///< by purpose
    std::span<const double> values;            ///< of an empirical distribution, sorted
  };

  PointSet design;
  std::uint64_t total;
  std::vector<Source> sources;
  std::vector<CopulaGroup> copulas;
  std::vector<std::optional<Source>> shared_scales; ///< by group: the W of a multivariate t
  struct Joint {                                    ///< draws of a common estimate
    std::vector<std::size_t> variates;
    Source scale; ///< their W
  };
  std::vector<Joint> joint;
  std::vector<bool> tied; ///< not drawn by itself

  Impl(const SamplePlan& plan, PointSet point_set, std::uint64_t samples)
      : design(point_set), total(samples), copulas(plan.copulas), tied(plan.variates.size(), false) {
    std::set<std::uint32_t> taken;
    for (const CommonEstimate& one : plan.estimates)
      for (const std::size_t v : one.variates) tied[v] = one.jointly_t;
    for (std::size_t v = 0; v < plan.variates.size(); ++v)
      sources.push_back(source_of(plan.variates[v], tied[v], taken));
    for (const CopulaGroup& group : copulas)
      shared_scales.push_back(group.multivariate_t()
                                  ? std::optional(source(group.key, sources[group.variates[0]].stream.reading,
                                                         group.shared_scale(), taken))
                                  : std::nullopt);
    for (const CommonEstimate& one : plan.estimates)
      if (one.jointly_t)
        joint.push_back({one.variates, source(one.key, 0, chi_squared_over(one.degrees_of_freedom), taken)});
    for (const CopulaGroup& group : copulas)
      for (const std::size_t v : group.variates) tied[v] = true;
  }

  /// @param jointly_t  its normal score is drawn
  Source source_of(const Variate& variate, bool jointly_t, std::set<std::uint32_t>& taken) const try {
    const auto& own = variate.distribution;
    const Distribution score{Family::normal, {own.parameters[0], own.parameters[1]}, nullptr, nullptr};
    return source(variate.key, reading_of(variate.cell), jointly_t ? score : own, taken);
  } catch (const std::runtime_error&) { // of Boost.Math, which names neither the quantity nor the parameter
    throw InputError(variate.name + ": the quantiles of its distribution cannot be computed",
                     "its parameters are too large or too small", "state usual ones, or another distribution");
  }

  Source source(std::uint64_t key, std::uint32_t reading, const Distribution& d, std::set<std::uint32_t>& taken) const {
    Source out{{key, reading, 0, 0},
               QuantileFunction(d),
               d.family == Family::normal,
               d.parameters[0],
               d.parameters[1],
               {},
               {},
               {}};
    if (d.values) out.values = *d.values;
    // Draws per reading are many and matter little each: they stay plain Monte Carlo.
    if (design != PointSet::sobol || reading != 0) return out;
    out.dimension = take_dimension(key, taken);
    for (std::uint32_t purpose = 0; out.dimension && purpose < purposes; ++purpose) {
      random::Stream stream = out.stream;
      stream.purpose = static_cast<std::uint16_t>(purpose);
      out.sobol.emplace_back(purpose * dimensions_per_purpose + *out.dimension,
                             random::derived_key(stream, 0x736f'626f'6c00)); // "sobol"
    }
    return out;
  }

  void uniforms(const Source& source, std::uint64_t first, std::size_t n, Purpose purpose, double* out) const {
    random::Stream stream = source.stream;
    stream.purpose = static_cast<std::uint16_t>(purpose);
    if (design == PointSet::latin_hypercube) {
      const random::Permutation strata = random::strata(stream, total);
      kernels().latin_hypercube(&stream, &strata, first, n, out);
    } else if (!source.sobol.empty()) {
      source.sobol[static_cast<std::size_t>(purpose)](first, n, out);
    } else {
      kernels().uniforms(&stream, first, n, out);
    }
  }

  /// One sample of an earlier run for all variates of the group, by the first one's uniform number.
  void draw_together(const CopulaGroup& group, std::uint64_t first, std::size_t n, Purpose purpose, double* out,
                     std::size_t stride) const {
    std::array<double, strip> chosen;
    uniforms(sources[group.variates[0]], first, n, purpose, chosen.data());
    const auto samples = static_cast<double>(group.together[0].size());
    for (double& u : std::span(chosen.data(), n)) u = std::min(std::floor(u * samples), samples - 1);
    for (std::size_t i = 0; i < group.variates.size(); ++i) {
      double* row = out + group.variates[i] * stride;
      const Source& source = sources[group.variates[i]];
      for (std::size_t k = 0; k < n; ++k)
        row[k] = source.values[group.together[i][static_cast<std::size_t>(chosen[k])]];
    }
  }

  /// 1 / sqrt(W) of some samples.
  void widenings(const Source& scale, std::uint64_t first, std::size_t n, Purpose purpose, double* out) const {
    uniforms(scale, first, n, purpose, out);
    scale.quantile(out, out, n);
    for (std::size_t k = 0; k < n; ++k) out[k] = 1 / std::sqrt(out[k]);
  }

  void draw_jointly(const Joint& one, std::uint64_t first, std::size_t n, Purpose purpose, double* out,
                    std::size_t stride) const {
    std::array<double, strip> widening;
    widenings(one.scale, first, n, purpose, widening.data());
    for (const std::size_t v : one.variates) {
      double* z = out + v * stride;
      const Source& source = sources[v];
      uniforms(source, first, n, purpose, z);
      source.quantile(z, z, n); // a normal deviation
      for (std::size_t k = 0; k < n; ++k) z[k] = source.mean + (z[k] - source.mean) * widening[k];
    }
  }

  /// Normal scores z, tied by L z in place, then back to deviates: by their distributions, or divided by sqrt(W).
  void draw_group(std::size_t g, std::uint64_t first, std::size_t n, Purpose purpose, double* out,
                  std::size_t stride) const {
    const CopulaGroup& group = copulas[g];
    if (!group.together.empty()) return draw_together(group, first, n, purpose, out, stride);
    const std::size_t size = group.variates.size();
    std::array<double, strip> widening; // 1 / sqrt(W)
    if (shared_scales[g]) widenings(*shared_scales[g], first, n, purpose, widening.data());
    static const QuantileFunction score(Distribution{Family::normal, {0, 1}, {}, {}});
    const auto row = [&](std::size_t i) { return out + group.variates[i] * stride; };
    for (std::size_t i = 0; i < size; ++i) {
      uniforms(sources[group.variates[i]], first, n, purpose, row(i));
      score(row(i), row(i), n);
    }
    for (std::size_t i = size; i-- > 0;) { // from the last, which alone needs all the others
      const double* factor = group.cholesky.data() + i * size;
      double* z = row(i);
      for (std::size_t k = 0; k < n; ++k) z[k] *= factor[i];
      for (std::size_t j = 0; j < i; ++j) {
        const double* other = row(j);
        for (std::size_t k = 0; k < n; ++k) z[k] += factor[j] * other[k];
      }
      const Source& source = sources[group.variates[i]];
      if (shared_scales[g]) {
        for (std::size_t k = 0; k < n; ++k) z[k] = source.mean + source.u * (z[k] * widening[k]);
      } else if (source.normal) {
        for (std::size_t k = 0; k < n; ++k) z[k] = source.mean + source.u * z[k];
      } else {
        kernels().normal_probability(z, z, n);
        source.quantile(z, z, n);
      }
    }
  }
};

Sampler::Sampler(const SamplePlan& plan, PointSet design, std::uint64_t total)
    : impl_(std::make_unique<const Impl>(plan, design, total)) {}

Sampler::~Sampler() = default;

void Sampler::draw(std::uint64_t first, std::size_t n, Purpose purpose, double* out, std::size_t stride) const {
  for (std::size_t start = 0; start < n; start += strip) {
    const std::size_t count = std::min(strip, n - start);
    for (std::size_t v = 0; v < impl_->sources.size(); ++v) {
      if (impl_->tied[v]) continue;
      double* row = out + v * stride + start;
      impl_->uniforms(impl_->sources[v], first + start, count, purpose, row);
      impl_->sources[v].quantile(row, row, count);
    }
    for (const Impl::Joint& one : impl_->joint)
      impl_->draw_jointly(one, first + start, count, purpose, out + start, stride);
    for (std::size_t g = 0; g < impl_->copulas.size(); ++g)
      impl_->draw_group(g, first + start, count, purpose, out + start, stride);
  }
}

} // namespace gumshoe::quantities
