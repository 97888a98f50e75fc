#pragma once
/// Gauss-Legendre nodes on [-1, 1], from Boost.Math's tables.
#include <array>

#include <boost/math/quadrature/gauss.hpp>

namespace gumshoe::math {

/// The N-point rule: sum of weight[i] f(node[i]) is the integral of f over [-1, 1], exact for polynomials up to degree
/// 2 N - 1. Nodes stand in pairs of opposite sign, from the middle outwards.
template <int N> struct GaussLegendre {
  std::array<double, N> node{}, weight{};
  GaussLegendre() {
    const auto& x = boost::math::quadrature::gauss<double, N>::abscissa();
    const auto& w = boost::math::quadrature::gauss<double, N>::weights();
    int n = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      node[n] = x[i], weight[n++] = w[i];
      if (x[i] != 0) node[n] = -x[i], weight[n++] = w[i];
    }
  }
  /// The rule, computed once per N; safe to call from several threads.
  static const GaussLegendre& rule() {
    static const GaussLegendre r;
    return r;
  }
};

} // namespace gumshoe::math
