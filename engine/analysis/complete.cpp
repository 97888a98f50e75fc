#include "analysis/complete.h"

#include <algorithm>

#include "analysis/leaves.h"

namespace gumshoe::analysis {

template <class Body> void Complete::each(std::size_t leaf, std::vector<double>& room, const Body& body) const {
  const std::size_t first = leaf * leaf_values, count = std::min(leaf_values, all_ - first);
  room.resize(columns_.size() * leaf_values);
  for (std::size_t a = 0; a < columns_.size(); ++a)
    columns_[a].copy(first, std::span(room).subspan(a * leaf_values, count));
  for (std::size_t i = 0; i < count; ++i) {
    bool complete = true;
    for (std::size_t a = 0; a < columns_.size(); ++a) complete = complete && holds_(room[a * leaf_values + i]);
    if (complete) body(i);
  }
}

Complete::Complete(std::vector<Column> columns, bool (*holds)(double), int threads)
    : columns_(std::move(columns)), holds_(holds), all_(columns_.front().size()), before_(parts(all_) + 1),
      leaves_((all_ + leaf_values - 1) / leaf_values) {
  for_ranges(all_, threads, [&](std::size_t part, std::size_t first, std::size_t count) {
    std::vector<double> room;
    for (std::size_t at = 0; at < count; at += leaf_values) {
      std::size_t complete = 0;
      each((first + at) / leaf_values, room, [&](std::size_t) { ++complete; });
      leaves_[(first + at) / leaf_values] = static_cast<std::uint16_t>(complete);
      before_[part + 1] += complete;
    }
  });
  for (std::size_t part = 0; part + 1 < before_.size(); ++part) before_[part + 1] += before_[part];
  size_ = before_.back();
}

Column Complete::column(std::size_t a) const {
  if (size_ == all_) return columns_[a];
  return {size_, [this, a](std::size_t first, std::span<double> out) { read(a, first, out); }};
}

void Complete::read(std::size_t a, std::size_t first, std::span<double> out) const {
  if (out.empty()) return;
  const auto part = static_cast<std::size_t>(std::ranges::upper_bound(before_, first) - before_.begin()) - 1;
  std::size_t leaf = part * (part_values / leaf_values), skip = first - before_[part];
  for (; skip >= leaves_[leaf]; ++leaf) skip -= leaves_[leaf];
  std::vector<double> room;
  for (std::size_t done = 0; done < out.size(); ++leaf)
    each(leaf, room, [&](std::size_t i) {
      if (skip > 0)
        --skip;
      else if (done < out.size())
        out[done++] = room[a * leaf_values + i];
    });
}

} // namespace gumshoe::analysis
