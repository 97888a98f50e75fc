#include "made/traced_rods.h"

#include <cmath>
#include <iterator>
#include <map>
#include <string>

#include <boost/math/distributions/normal.hpp>
#include <fmt/format.h>

namespace gumshoe::made {
using namespace tracing;

namespace {

/// Rows in the order of time; the mean of each set-up, its offset, is subtracted.
void add_rows(Traced& t, const Effect& there, const Effect& found) {
  const scenario::Scenario& s = t.scenario;
  std::map<std::string, std::pair<double, double>> sums;
  for (std::size_t i = 0; i < s.readings.size(); ++i) {
    Row row;
    row.reading = i;
    row.order = s.trace.order[i];
    row.block = s.readings[i].labels[1].second;
    row.held_out = std::stoi(row.block) >= first_final;
    row.before = there(s, i) + noise_u * normal(i);
    row.after = row.before - found(s, i);
    row.measured = s.readings[i].indications[0] + row.before;
    row.noise_u = noise_u;
    sums[row.block].first += row.before;
    sums[row.block].second += row.after;
    t.trace.rows.push_back(row);
  }
  const double n = 2.0 * 3 * std::size(feeds);
  for (Row& row : t.trace.rows) {
    row.before -= sums[row.block].first / n;
    row.after -= sums[row.block].second / n;
  }
}

double root_mean_square(const std::vector<Row>& rows, double Row::*member, const std::function<bool(const Row&)>& in) {
  double sum = 0, n = 0;
  for (const Row& row : rows)
    if (in(row)) sum += row.*member * row.*member, n += 1;
  return std::sqrt(sum / n);
}

void add_rms(Trace& t) {
  Rms& r = t.rms;
  r.unit = "mm";
  r.si_unit = "m";
  const auto training = [](const Row& row) { return !row.held_out; };
  const auto final = [](const Row& row) { return row.held_out; };
  r.before = root_mean_square(t.rows, &Row::before, training);
  r.after = root_mean_square(t.rows, &Row::after, training);
  r.holdout_before = root_mean_square(t.rows, &Row::before, final);
  r.holdout_after = root_mean_square(t.rows, &Row::after, final);
  r.noise = noise_u * std::sqrt(23.0 / 24);
  r.noise_low = 0.88 * r.noise, r.noise_high = 1.12 * r.noise;
  r.holdout_noise = r.noise;
  r.holdout_noise_low = 0.8 * r.noise, r.holdout_noise_high = 1.2 * r.noise;
  r.holdout = "setup 7, 8";
  for (const char* block : {"7", "8"}) {
    const auto in = [&](const Row& row) { return row.block == block; };
    if (const double after = root_mean_square(t.rows, &Row::after, in); !(after <= r.worst_block_after)) {
      r.worst_block = fmt::format("setup {}", block);
      r.worst_block_after = after;
      r.worst_block_before = root_mean_square(t.rows, &Row::before, in);
    }
  }
  for (const Row& row : t.rows)
    if (row.held_out && !(std::fabs(row.after) <= r.worst_point_after)) {
      r.worst_point = fmt::format("reading {}, setup {}", row.reading + 1, row.block);
      r.worst_point_before = std::fabs(row.before);
      r.worst_point_after = std::fabs(row.after);
    }
  const auto square = [](double x) { return x * x; };
  r.share_removed =
      (square(r.holdout_before) - square(r.holdout_after)) / (square(r.holdout_before) - square(r.holdout_noise));
}

} // namespace

double feed_at(const scenario::Scenario& s, std::size_t reading) { return s.readings[reading].conditions[0]; }
double time_at(const scenario::Scenario& s, std::size_t reading) { return s.readings[reading].conditions[1]; }

double normal(std::size_t i) {
  const double p = (static_cast<double>((i * 73 + 11) % 192) + 0.5) / 192;
  return boost::math::quantile(boost::math::normal(), p);
}

scenario::Scenario rods() {
  scenario::Scenario s;
  s.file = "made_up.toml";
  s.text = "# Question: what do two rods at four feeds show that the model lacks?\nschema = 1\n";
  s.hash = "0123456789abcdef";
  s.title = "two rods, eight set-ups, four feeds";
  s.model = "rod_gauging";
  s.evaluation = "full";
  s.trace.stated = true;
  s.trace.blocks = "setup";
  s.trace.final_blocks = {"7", "8"};
  s.trace.order_name = "time";
  scenario::TraceColumn temperature{"temperature", "degC", "K", {}};
  for (int setup = 1; setup <= setups; ++setup)
    for (const char* rod : {"rod 1", "rod 2"})
      for (int repeat = 0; repeat < 3; ++repeat)
        for (const double feed : feeds) {
          const double time = 45.0 * static_cast<double>(s.readings.size());
          s.readings.push_back(
              {{{"rod", rod}, {"setup", std::to_string(setup)}}, {feed / 60 * mm, time, -1}, {-329.9 * mm}, 1, {}});
          s.trace.order.push_back(time);
          temperature.values.push_back(293.15 + 3 * (1 - std::exp(-time / 3600)));
        }
  s.trace.columns.push_back(temperature);
  return s;
}

Traced traced_rods(const Effect& there, const Effect& found) {
  Traced t{rods(), {}, {}};
  add_rows(t, there, found);
  add_rms(t.trace);
  return t;
}

} // namespace gumshoe::made
