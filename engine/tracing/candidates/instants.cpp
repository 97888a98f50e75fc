#include "tracing/candidates/instants.h"

#include <algorithm>

#include <fmt/format.h>

#include "tracing/criteria.h"

namespace gumshoe::tracing {
namespace {

constexpr Index at_once = 64;

/// The step between two successive readings of one indication.
class Steps {
public:
  Steps(const Observations& o, std::size_t indication) : o_(o), indication_(index(indication)) {}

  /// From each of these places in the sequence on.
  Matrix columns(const std::vector<Index>& from) const {
    const Index n = index(o_.readings), k = index(o_.indications);
    Matrix out = Matrix::Zero(n * k, index(from.size()));
    for (Index j = 0; j < out.cols(); ++j)
      for (Index r = from[static_cast<std::size_t>(j)]; r < n; ++r) out(r * k + indication_, j) = 1;
    return out;
  }

  /// The one that explains most.
  Index best(const std::vector<Index>& places, const Gain& gain) const {
    Index found = places.front();
    double height = -1;
    for (std::size_t i = 0; i < places.size(); i += at_once) {
      const std::vector<Index> some(places.begin() + index(i),
                                    places.begin() + index(std::min(places.size(), i + at_once)));
      Index highest = 0;
      const double here = gain(columns(some), 1, criteria.absorbed_share).maxCoeff(&highest);
      if (here > height) height = here, found = some[static_cast<std::size_t>(highest)];
    }
    return found;
  }

private:
  const Observations& o_;
  Index indication_;
};

/// Places in the sequence where a step may begin, with a few fitted readings before and after.
std::vector<Index> instants(const Observations& o, const std::vector<Index>& rows) {
  std::vector<Index> fitted;
  for (const Index row : rows)
    if (const Index reading = row / index(o.indications); fitted.empty() || fitted.back() != reading)
      fitted.push_back(reading);
  const std::size_t few = static_cast<std::size_t>(criteria.few_readings) + 1;
  if (fitted.size() < 2 * few) return {};
  return {fitted.begin() + index(few), fitted.end() - index(few) + 1};
}

} // namespace

std::vector<Candidate> steps_at_instants(const Observations& o, const std::vector<Index>& rows, const Gain& gain) {
  std::vector<Candidate> out;
  const std::vector<Index> places = instants(o, rows);
  if (places.empty()) return out;
  for (const Covariate& c : o.covariates)
    for (std::size_t i = 0; c.course && i < o.indications; ++i) {
      const Steps steps(o, i);
      const Index from = steps.best(places, gain);
      Candidate a;
      a.family = Family::shape;
      a.name = fmt::format("step:{} after reading {}{}", c.name, o.sequence[static_cast<std::size_t>(from - 1)] + 1,
                           o.indications > 1 ? " of " + o.names[i] : "");
      a.columns = steps.columns({from});
      a.amplitudes.resize(1);
      a.amplitudes[0].quantity = Amplitude::npos;
      a.amplitudes[0].name = "size";
      a.depends_on = {c.name};
      a.searched = static_cast<double>(places.size());
      out.push_back(std::move(a));
    }
  return out;
}

} // namespace gumshoe::tracing
