#include "tracing/campaigns/evidence_over_time.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>

namespace gumshoe::tracing {
namespace {

/// ln of the integral over t from 0 of t^(n-1) exp(-a t^2/2 + b t).
double log_moment(double n, double a, double b) {
  const double beta = b / std::sqrt(a); // t in units of 1 / sqrt(a)
  const double peak = (beta + std::sqrt(beta * beta + 4 * (n - 1))) / 2;
  const double width = 1 / std::sqrt(1 + (n - 1) / (peak * peak));
  const auto log_density = [&](double t) { return (n - 1) * std::log(t) - t * t / 2 + beta * t; };
  const double top = log_density(peak);
  constexpr double far = 12; // the density is log-concave: nothing remains beyond
  const double area = boost::math::quadrature::gauss_kronrod<double, 61>::integrate(
      [&](double t) { return t > 0 ? std::exp(log_density(t) - top) : 0; }, std::max(0.0, peak - far * width),
      peak + far * width, 5, 1e-10);
  return top + std::log(area) - n / 2 * std::log(a);
}

/// What is believed of the sizes of an effect, in absolute units.
struct Belief {
  Vector mean;
  Matrix precision;
  double noise = 1; ///< scale of the last campaign's noise: the one expected of the next
  double log_e = 0;
  int campaigns = 0;
  struct One {
    Vector size;
    Matrix information; ///< in absolute units
  };
  std::vector<One> each; ///< what every campaign says alone
};

/// ln of the ratio of the densities, sizes being normal about `mean` in units of the noise's scale.
double log_ratio(const Score& s, const Campaign& c, const Vector& mean, const Matrix& covariance) {
  const Eigen::LLT<Matrix> factor(s.information);
  const Matrix root = factor.matrixU(); // information = root' root
  const Vector z = factor.matrixL().solve(s.score), expected = root * mean;
  const Matrix spread = Matrix::Identity(z.size(), z.size()) + root * covariance * root.transpose();
  const Eigen::LDLT<Matrix> inverse(spread);
  const Vector by_z = inverse.solve(z), by_expected = inverse.solve(expected);
  const double rest = std::max(0.0, c.squares - z.squaredNorm());
  return -inverse.vectorD().array().log().sum() / 2 - expected.dot(by_expected) / 2 +
         log_moment(c.freedom, z.dot(by_z) + rest, z.dot(by_expected)) - log_moment(c.freedom, c.squares, 0);
}

bool usable(const Score& s, const Campaign& c) {
  return c.squares > 0 && c.freedom > static_cast<double>(s.score.size()) + 1 && s.score.allFinite() &&
         Eigen::LLT<Matrix>(s.information).info() == Eigen::Success;
}

void add(Belief& belief, const Score& s, const Campaign& c) {
  const bool first = belief.campaigns == 0;
  const Vector size = s.information.llt().solve(s.score);
  const double rest = std::max(0.0, c.squares - size.dot(s.score));
  const double variance = rest / (c.freedom - static_cast<double>(size.size()));
  if (first) {
    belief.mean = Vector::Zero(size.size());
    belief.precision = s.information / c.freedom; // in units of a scale that the density leaves open
    belief.log_e = log_ratio(s, c, belief.mean, belief.precision.inverse());
    belief.precision /= variance;
  } else {
    const double scale = belief.noise;
    belief.log_e += log_ratio(s, c, belief.mean / scale, belief.precision.inverse() / (scale * scale));
  }
  const Matrix gained = s.information / variance, precision = belief.precision + gained;
  belief.mean = precision.ldlt().solve(belief.precision * belief.mean + gained * size);
  belief.precision = precision;
  belief.noise = std::sqrt(variance);
  ++belief.campaigns;
  belief.each.push_back({size, gained});
}

/// Cochran's test of one size in all campaigns.
double agreement(const std::vector<Belief::One>& each) {
  if (each.size() < 2) return 1;
  const Index n = each[0].size.size();
  Matrix information = Matrix::Zero(n, n);
  Vector sum = Vector::Zero(n);
  for (const auto& one : each) information += one.information, sum += one.information * one.size;
  const Vector mean = information.ldlt().solve(sum);
  double squares = 0;
  for (const auto& one : each) squares += (one.size - mean).dot(one.information * (one.size - mean));
  const double freedom = static_cast<double>(n) * static_cast<double>(each.size() - 1);
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedom), std::max(squares, 0.0)));
}

/// ln of the mean of exponentials.
double log_mean(const std::vector<double>& logs) {
  const double top = *std::ranges::max_element(logs);
  double sum = 0;
  for (const double x : logs) sum += std::exp(x - top);
  return top + std::log(sum / static_cast<double>(logs.size()));
}

} // namespace

EvidenceOverTime evidence_over_time(const std::vector<Campaign>& campaigns) {
  EvidenceOverTime out;
  out.campaigns = static_cast<int>(campaigns.size());
  if (campaigns.empty()) return out;
  // The effects looked for are those of the first campaign: their number must not follow from data.
  std::map<std::string, std::map<int, Belief>> beliefs;
  std::map<std::pair<std::string, int>, const Score*> meaning;
  for (const Score& s : campaigns.front().scores) {
    beliefs[s.candidate][s.variant];
    meaning[{s.candidate, s.variant}] = &s;
  }
  struct Peak {
    double log_e = -HUGE_VAL;
    int campaigns = 0;
  };
  std::map<std::string, Peak> peaks;
  const auto log_of = [](const std::map<int, Belief>& variants) {
    std::vector<double> logs;
    for (const auto& [variant, belief] : variants) logs.push_back(belief.log_e);
    return log_mean(logs);
  };
  for (std::size_t k = 0; k < campaigns.size(); ++k) {
    for (const Score& s : campaigns[k].scores) {
      const auto known = meaning.find({s.candidate, s.variant});
      if (known == meaning.end() || known->second->score.size() != s.score.size() || !usable(s, campaigns[k])) continue;
      add(beliefs[s.candidate][s.variant], s, campaigns[k]);
    }
    for (const auto& [name, variants] : beliefs)
      if (Peak& peak = peaks[name]; log_of(variants) > peak.log_e) peak = {log_of(variants), static_cast<int>(k) + 1};
  }
  std::vector<double> all;
  for (const auto& [name, variants] : beliefs) {
    all.push_back(log_of(variants));
    const auto best = std::ranges::max_element(
        variants, [](const auto& a, const auto& b) { return a.second.log_e < b.second.log_e; });
    const Belief& belief = best->second;
    EffectEvidence e;
    e.candidate = name, e.log_evidence = all.back(), e.campaigns = belief.campaigns;
    e.sizes = meaning[{name, best->first}]->sizes, e.size = belief.mean;
    e.log_peak = peaks[name].log_e, e.peak = peaks[name].campaigns;
    if (belief.campaigns > 0) {
      e.u = belief.precision.inverse().diagonal().cwiseSqrt();
      e.last = belief.each.back().size;
      e.last_u = belief.each.back().information.inverse().diagonal().cwiseSqrt();
      e.agreement = agreement(belief.each);
    }
    out.effects.push_back(std::move(e));
  }
  if (all.empty()) return out;
  out.log_overall = log_mean(all);
  const double search = std::log(static_cast<double>(all.size()));
  for (EffectEvidence& e : out.effects) e.log_evidence -= search, e.log_peak -= search;
  std::ranges::stable_sort(out.effects, std::greater{}, &EffectEvidence::log_evidence);
  return out;
}

} // namespace gumshoe::tracing
