#include "quantities/deviate_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <mutex>
#include <numbers>

#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/gamma.hpp>

namespace gumshoe::quantities {
namespace {

using Function = std::function<double(double)>;
constexpr int nodes = table_degree + 1;

/// Values at the Chebyshev nodes of [-1, 1] to coefficients of powers.
struct Interpolation {
  std::array<double, nodes> x;
  std::array<std::array<double, nodes>, nodes> from_values{}; ///< [power][node]

  Interpolation() {
    double chebyshev[nodes][nodes] = {}; // [k][power] of T_k
    chebyshev[0][0] = chebyshev[1][1] = 1;
    for (int k = 2; k < nodes; ++k)
      for (int i = 0; i < nodes; ++i) chebyshev[k][i] = (i > 0 ? 2 * chebyshev[k - 1][i - 1] : 0) - chebyshev[k - 2][i];
    for (int j = 0; j < nodes; ++j) {
      const double angle = std::numbers::pi * (j + 0.5) / nodes;
      x[j] = std::cos(angle);
      for (int k = 0; k < nodes; ++k)
        for (int i = 0; i < nodes; ++i)
          from_values[i][j] += (k == 0 ? 1.0 : 2.0) / nodes * std::cos(k * angle) * chebyshev[k][i];
    }
  }
};

double piece_middle(int piece, int log2_pieces, double& half) {
  const int per_octave = 1 << log2_pieces;
  const double low = std::ldexp(1.0, piece / per_octave - table_octaves - 1);
  half = 0.5 * low / per_octave;
  return low + (2 * (piece % per_octave) + 1) * half;
}

std::vector<double> tabulate(const Function& f, int log2_pieces) {
  static const Interpolation interpolation;
  const int pieces = table_octaves << log2_pieces;
  std::vector<double> table(static_cast<std::size_t>(pieces) * nodes);
  for (int piece = 0; piece < pieces; ++piece) {
    double half, values[nodes];
    const double middle = piece_middle(piece, log2_pieces, half);
    for (int j = 0; j < nodes; ++j) values[j] = f(middle + half * interpolation.x[j]);
    for (int i = 0; i < nodes; ++i) {
      double sum = 0;
      for (int j = 0; j < nodes; ++j) sum += interpolation.from_values[i][j] * values[j];
      table[static_cast<std::size_t>(piece) * nodes + i] = sum;
    }
  }
  return table;
}

/// Whether the last coefficients have died away in every piece.
bool converged(const std::vector<double>& table) {
  for (std::size_t i = 0; i < table.size(); i += nodes) {
    const double last = std::abs(table[i + nodes - 1]), before = std::abs(table[i + nodes - 2]);
    const double size = std::abs(table[i]);
    // The neglected term is about last * last / before; powers are 2^(k-1) times Chebyshev terms.
    const double neglected = before > 0 ? last * std::min(1.0, last / before) : last;
    if (size > 1e-290 && neglected > 1e-11 * size) return false;
  }
  return true;
}

void tabulate(DeviateTable& table, const Function& lower, const Function& upper) {
  for (table.log2_pieces = 3; table.log2_pieces <= 7; ++table.log2_pieces) {
    table.lower = tabulate(lower, table.log2_pieces);
    if (upper) table.upper = tabulate(upper, table.log2_pieces);
    if (table.log2_pieces == 7 || (converged(table.lower) && (!upper || converged(table.upper)))) return;
  }
}

/// Tables are shared by all distributions of the same shape; a bounded number is kept.
std::shared_ptr<const DeviateTable> cached(char family, double shape, const std::function<void(DeviateTable&)>& build) {
  using Key = std::pair<char, double>;
  static std::mutex mutex;
  static std::map<Key, std::shared_ptr<const DeviateTable>> tables;
  const std::lock_guard lock(mutex);
  if (const auto found = tables.find({family, shape}); found != tables.end()) return found->second;
  auto table = std::make_shared<DeviateTable>();
  build(*table);
  if (tables.size() >= 256) tables.clear();
  return tables[{family, shape}] = table;
}

} // namespace

// Without promotion to long double, which takes thirteen times as long: relative errors stay below 3e-15.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

std::shared_ptr<const DeviateTable> t_table(double degrees_of_freedom) {
  return cached('t', degrees_of_freedom, [&](DeviateTable& table) {
    const boost::math::students_t_distribution<double> wide(degrees_of_freedom);
    const boost::math::students_t_distribution<double, InDouble> narrow(degrees_of_freedom);
    const auto deviate = [&](double p) {
      return p > 0.25 ? quantile(wide, p) : quantile(narrow, p); // towards its zero at 1/2, double loses digits
    };
    tabulate(table, [&](double p) { return deviate(p) / (p - 0.5); }, {});
  });
}

std::shared_ptr<const DeviateTable> gamma_table(double shape) {
  return cached('g', shape, [&](DeviateTable& table) {
    tabulate(
        table, [&](double p) { return boost::math::gamma_p_inv(shape, p, InDouble()); },
        [&](double q) { return boost::math::gamma_q_inv(shape, q, InDouble()); });
  });
}

} // namespace gumshoe::quantities
