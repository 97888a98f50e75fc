/// What fixes the samples, written out bit by bit, and hashed.
#include <cstring>

#include <fmt/format.h>

#include "base/hash.h"
#include "propagation/experiment.h"
#include "random/latin_hypercube.h"

namespace gumshoe::propagation {

namespace {

/// Texts with their lengths and numbers as bytes: no two designs are written alike.
class Record {
public:
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    bytes_ += text;
  }
  void add(std::uint64_t x) { append(&x, sizeof x); }
  void add(double x) { append(&x, sizeof x); }
  template <class T> void add(const std::vector<T>& values) {
    add(std::uint64_t{values.size()});
    for (const T& x : values) add(x);
  }
  std::string hash() const { return fmt::format("{:016x}", hash64(bytes_)); }

private:
  void append(const void* data, std::size_t size) { bytes_.append(static_cast<const char*>(data), size); }
  std::string bytes_;
};

void add(Record& record, const quantities::Distribution& d) {
  record.add(static_cast<std::uint64_t>(d.family));
  for (const double p : d.parameters) record.add(p);
  for (const auto& list : {d.values, d.probabilities}) record.add(list ? *list : std::vector<double>{});
}

} // namespace

std::string design_hash(const Experiment& e) {
  const auto& s = e.scenario();
  const auto& plan = e.plan();
  Record record;
  for (const std::string_view text : {std::string_view(s.model), std::string_view(scenario::name(s.method)),
                                      std::string_view(s.evaluation), std::string_view(scenario::name(s.run.design))})
    record.add(text);
  record.add(s.run.seed);
  const bool latin = s.run.design == scenario::Design::latin_hypercube;
  record.add(latin ? s.run.samples : 0);
  if (latin) record.add(random::latin_generation);
  record.add(std::uint64_t{plan.variates.size()});
  for (const auto& v : plan.variates) {
    record.add(v.key);
    add(record, v.distribution);
  }
  for (const auto& group : plan.copulas) {
    record.add(group.variates);
    record.add(group.matrix);
    if (group.multivariate_t()) record.add(group.key);
    for (const auto& ranks : group.together)
      for (const std::uint32_t rank : ranks) record.add(std::uint64_t{rank});
  }
  for (const auto& one : plan.estimates)
    if (one.jointly_t) record.add(one.variates), record.add(one.key);
  for (const auto& q : s.quantities) record.add(q.name);
  record.add(std::uint64_t{plan.columns.size()});
  for (const auto& c : plan.columns) {
    record.add(c.value);
    record.add(c.variates);
  }
  record.add(plan.gather);
  record.add(std::uint64_t{s.readings.size()});
  for (const auto& r : s.readings) {
    for (const auto& [label, value] : r.labels) record.add(label), record.add(value);
    record.add(r.conditions);
    record.add(r.indications);
  }
  for (const StatedSize& stated : e.forward().stated()) {
    record.add(std::uint64_t{stated.target - e.layout().indications.begin});
    record.add(stated.loading);
  }
  return record.hash();
}

} // namespace gumshoe::propagation
