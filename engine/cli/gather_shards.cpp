/// Which file holds which shard, and what is wrong with the others.
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "base/version.h"
#include "cli/command.h"
#include "cli/requested_choice.h"
#include "cli/shell.h"

namespace gumshoe::cli {

namespace {

/// What all shards of a run have in common, in words.
struct Common {
  const char* what;
  std::string (*of)(const store::Identity&);
};
constexpr Common common[] = {
    {"command", [](const store::Identity& i) { return i.command; }},
    {"scenario", [](const store::Identity& i) { return i.scenario_file + ", hash " + i.scenario_hash; }},
    {"version", [](const store::Identity& i) { return i.version; }},
    {"seed", [](const store::Identity& i) { return std::to_string(i.seed); }},
    {"number of shards", [](const store::Identity& i) { return i.shard.substr(i.shard.find('/') + 1); }},
    {"options", [](const store::Identity& i) { return i.options.empty() ? std::string("none") : i.options; }},
    {"external code", [](const store::Identity& i) { return i.external; }},
    {"design hash", [](const store::Identity& i) { return i.design_hash; }},
};

std::vector<std::string> common_of(const store::Identity& i) {
  std::vector<std::string> all;
  for (const Common& c : common) all.push_back(c.of(i));
  // The same scenario may lie elsewhere on another machine.
  all[1] = i.scenario_hash;
  return all;
}

struct Found {
  std::string file;
  store::Stored stored;
  std::uint64_t number = 0;
};

/// The command that makes a shard, or finishes it.
std::string command_of(const store::Identity& run, const std::string& shard, const std::string& out) {
  return fmt::format("gumshoe {} {}{}{} --shard {} --out {}\n", run.command.substr(0, run.command.find(' ')),
                     shell_file(run.scenario_file), run.options.empty() ? "" : " ", run.options, shard,
                     shell_file(out));
}

class Gathering {
public:
  explicit Gathering(const std::vector<std::string>& files);
  ShardSet set();

private:
  void look_at(const std::string& file);
  void refuse_others();
  void place(const Found& found);
  std::string why_useless(const Found& found) const;
  void ask_for_missing();

  std::vector<Found> found_;
  std::vector<Problem> problems_;
  std::vector<Problem> unreadable_; ///< files that are damaged; they do no harm where all shards are there without them
  store::Identity run_;
  std::uint64_t of_ = 0;
  struct Bad {
    std::string file, why;
  };
  std::map<std::uint64_t, std::string> good_; ///< files by number of the shard
  std::map<std::uint64_t, Bad> bad_;
};

Gathering::Gathering(const std::vector<std::string>& files) {
  for (const std::string& file : files) look_at(file);
  if (found_.empty()) return;
  refuse_others();
  for (const Found& found : found_) place(found);
}

void Gathering::look_at(const std::string& file) {
  try {
    store::Stored stored = store::open_result(file);
    if (stored.identity.shard.empty())
      problems_.push_back(
          {{}, file + ": the file is no shard", "gumshoe " + stored.command() + " made it", "leave it out"});
    else
      found_.push_back({file, stored, propagation::shard_of(stored.identity.shard, file).number});
  } catch (const store::NotAResult& error) {
    const char* remedy = std::filesystem::exists(file) ? "leave it out" : "check its name";
    problems_.push_back({{}, file + ": the file is no shard", error.problems().front().why, remedy});
  } catch (const InputError& error) {
    unreadable_.push_back(error.problems().front());
  }
}

/// Most of the shards say which run is meant; of equally many, the order of their texts.
void Gathering::refuse_others() {
  std::map<std::vector<std::string>, std::size_t> votes;
  for (const Found& found : found_) ++votes[common_of(found.stored.identity)];
  const auto most = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; })->first;
  const auto belongs = [&](const Found& found) { return common_of(found.stored.identity) == most; };
  run_ = std::ranges::find_if(found_, belongs)->stored.identity;
  of_ = propagation::shard_of(run_.shard, "").of;
  for (const Found& found : found_) {
    if (belongs(found)) continue;
    const auto own = common_of(found.stored.identity);
    std::size_t k = 0;
    while (own[k] == most[k]) ++k;
    problems_.push_back({{},
                         found.file + ": the shard belongs to another run",
                         fmt::format("its {} is {}, that of the others {}", common[k].what,
                                     common[k].of(found.stored.identity), common[k].of(run_)),
                         "leave it out, and make the shard again"});
  }
  std::erase_if(found_, [&](const Found& found) { return !belongs(found); });
}

std::string Gathering::why_useless(const Found& found) const {
  const store::Stored& there = found.stored;
  const store::Identity& shard = there.identity;
  if (there.samples_done < shard.samples)
    return fmt::format("it is not finished: {} of {} {}", there.samples_done, shard.samples,
                       shard.command == choice_shard_command ? "candidates" : "samples");
  if (there.study_values_done < shard.study_values)
    return fmt::format("it is not finished: {} of {} values of studies", there.study_values_done, shard.study_values);
  try {
    store::require_sound_samples(found.file);
    return "";
  } catch (const InputError& error) {
    return "it is damaged: " + error.problems().front().why;
  }
}

/// Several files may hold the same shard. One that can be used is enough, because their numbers are equal.
void Gathering::place(const Found& found) {
  if (good_.contains(found.number)) return;
  const std::string why = why_useless(found);
  if (why.empty())
    good_[found.number] = found.file;
  else
    bad_[found.number] = {found.file, why};
}

void Gathering::ask_for_missing() {
  const auto folder = std::filesystem::path(found_.front().file).parent_path();
  const std::string name = std::filesystem::path(run_.scenario_file).stem().string();
  std::vector<std::string> missing;
  for (std::uint64_t k = 1; k <= of_; ++k) {
    if (good_.contains(k)) continue;
    const std::string shard = propagation::Shard{k, of_}.text();
    std::string file = (folder / (name + ending_of(shard))).string();
    if (const auto there = bad_.find(k); there == bad_.end()) {
      missing.push_back(shard);
    } else {
      file = there->second.file;
      problems_.push_back({{},
                           fmt::format("{}: shard {} cannot be used", file, shard),
                           there->second.why,
                           "finish it with the command on standard output"});
    }
    std::cout << command_of(run_, shard, file);
  }
  std::cout.flush();
  if (missing.empty()) return;
  constexpr std::size_t most = 20;
  problems_.push_back(
      {{},
       fmt::format("{} of {} shards are missing", missing.size(), of_),
       fmt::format("{}{}",
                   fmt::join(missing.begin(),
                             missing.begin() + static_cast<std::ptrdiff_t>(std::min(most, missing.size())), ", "),
                   missing.size() > most ? ", ..." : ""),
       "make them with the commands on standard output"});
}

ShardSet Gathering::set() {
  const bool all_there = !found_.empty() && good_.size() == of_;
  for (Problem& p : unreadable_) {
    if (all_there)
      std::cerr << fmt::format("{}{}: it is left out, as all shards are there without it\n", p.what,
                               p.why.empty() ? "" : " (" + p.why + ")");
    else
      problems_.push_back({{}, p.what, p.why, "remove it, and make the shard again"});
  }
  if (found_.empty()) {
    problems_.push_back({{}, "no shard can be read", "", "make shards with gumshoe run --shard"});
  } else if (run_.version != version) {
    problems_.push_back({{},
                         fmt::format("the shards were made by Gumshoe {}", run_.version),
                         fmt::format("this is {}, and its numbers may differ", version),
                         "merge with that version, or make the shards again"});
  } else if (good_.size() < of_) {
    ask_for_missing();
  }
  if (!problems_.empty()) throw InputError(problems_);
  ShardSet set{run_, of_, {}};
  for (const auto& [number, file] : good_) set.files.push_back(file);
  return set;
}

} // namespace

ShardSet gather_shards(const std::vector<std::string>& files) { return Gathering(files).set(); }

} // namespace gumshoe::cli
