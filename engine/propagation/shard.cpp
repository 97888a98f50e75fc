#include "propagation/shard.h"

#include <algorithm>
#include <charconv>

#include "base/error.h"

namespace gumshoe::propagation {

namespace {

constexpr std::uint64_t unit_samples = 64, most = 1'000'000; // their product with 1e15 / 64 samples stays below 2^64

/// False unless all of the text is a whole number.
bool read(const std::string& text, std::uint64_t& number) {
  const char* end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  return error == std::errc{} && stopped == end;
}

} // namespace

std::string Shard::text() const { return std::to_string(number) + '/' + std::to_string(of); }

SampleRange Shard::samples(std::uint64_t total) const {
  const std::uint64_t units = (total + unit_samples - 1) / unit_samples;
  const auto start = [&](std::uint64_t parts) { return std::min(total, units * parts / of * unit_samples); };
  return {start(number - 1), start(number)};
}

std::vector<Portion> Shard::portions(const std::vector<Work>& works) const {
  std::uint64_t total = 0, before = 0;
  for (const Work& work : works) total += work.units * work.runs;
  const auto start = [&](std::uint64_t parts) { return total / of * parts + total % of * parts / of; };
  std::vector<Portion> out;
  for (std::size_t w = 0; w < works.size(); ++w) {
    const Work& work = works[w];
    const auto unit = [&](std::uint64_t run) { // the first that begins there or later
      return run <= before ? 0 : std::min(work.units, (run - before + work.runs - 1) / work.runs);
    };
    const Portion part{w, unit(start(number - 1)), unit(start(number))};
    if (part.first < part.last) out.push_back(part);
    before += work.units * work.runs;
  }
  return out;
}

std::uint64_t values_of(const std::vector<Portion>& portions, const std::vector<Work>& works) {
  std::uint64_t values = 0;
  for (const Portion& part : portions) values += (part.last - part.first) * works[part.work].values;
  return values;
}

Shard shard_of(const std::string& text, const std::string& option) {
  Shard shard;
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos || !read(text.substr(0, slash), shard.number) ||
      !read(text.substr(slash + 1), shard.of) || shard.number < 1 || shard.number > shard.of || shard.of > most)
    throw InputError(option + ": '" + text + "' is not a shard", "shards of a run count from 1, up to a million",
                     "write 3/16 for the third of sixteen");
  return shard;
}

} // namespace gumshoe::propagation
