#include "store/earlier_output.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/shared_inputs.h"
#include "analysis/validation.h"
#include "store/earlier_result.h"
#include "store/stored_results.h"
#include "store/stored_samples.h"

namespace gumshoe::store {
namespace {

constexpr std::uint64_t most_samples = std::uint64_t{1} << 20; // show a shape to a thousandth of its u

void require_result(const Stored& stored, const std::string& file) {
  if (!stored.identity.shard.empty())
    throw InputError(fmt::format("{}: it is shard {} of a run", file, stored.identity.shard), "",
                     "join the shards by gumshoe merge");
  require_complete(stored, file);
  if (!stored.identity.has_outputs())
    throw InputError(file + ": holds no outputs", fmt::format("gumshoe {} wrote it", stored.identity.command),
                     "name a result of gumshoe run");
}

const analysis::Summary& find(const analysis::Results& results, const std::string& output, const std::string& file) {
  std::vector<std::string> names;
  const analysis::Summary* of_measurand = nullptr;
  std::size_t rows = 0;
  for (const analysis::Summary& s : results.summaries) {
    if (s.output.name == output) return s;
    names.push_back(s.output.name);
    if (s.output.measurand != output) continue;
    of_measurand = &s;
    ++rows;
  }
  if (rows == 1) return *of_measurand;
  const std::string near = nearest(output, names);
  throw InputError(
      fmt::format("{} has {} '{}'", file, rows > 1 ? fmt::format("{} outputs", rows) : "no output", output),
      fmt::format("it has {}", fmt::join(names, ", ")),
      rows > 1       ? fmt::format("name one, such as '{}'", of_measurand->output.name)
      : near.empty() ? ""
                     : "did you mean '" + near + "'?");
}

} // namespace

scenario::EarlierOutput read_output(const std::string& file, const std::string& output) {
  const Stored stored = open_result(file);
  require_result(stored, file);
  const analysis::Results results = read_results(file);
  const analysis::Summary& s = find(results, output, file);
  scenario::EarlierOutput out{s.output.name,
                              s.output.unit,
                              s.output.si_unit,
                              s.estimate,
                              s.standard_uncertainty,
                              std::numeric_limits<double>::infinity(),
                              {},
                              {},
                              stored.identity.samples};
  if (const analysis::Budget* budget = analysis::budget_of(results, s.output.name)) {
    if (budget->applicable && std::isfinite(budget->effective_degrees_of_freedom)) {
      out.degrees_of_freedom = budget->effective_degrees_of_freedom;
      out.standard_uncertainty = budget->combined_standard_uncertainty;
    }
    for (const analysis::Contribution& c : budget->contributions)
      out.shares.push_back(
          {c.name, c.quantity, analysis::signed_contribution(c), c.standard_uncertainty, c.evaluation, c.distribution,
           std::sqrt(analysis::variance_over_scale(c))});
  }
  if (!stored.identity.store_samples) return out;
  require_sound_samples(file);
  // As in a file's record: outputs in the order of their summaries, of one measurand in the order of its readings.
  std::uint64_t reading = 0;
  for (const analysis::Summary* row = results.summaries.data(); row != &s; ++row)
    reading += row->output.measurand == s.output.measurand ? 1 : 0;
  propagation::Output row = s.output;
  row.reading = reading;
  const StoredSamples samples(file, {row});
  out.samples = samples.read(0, 0, std::min(most_samples, stored.identity.samples));
  return out;
}

} // namespace gumshoe::store
