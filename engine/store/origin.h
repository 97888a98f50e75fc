#pragma once
/// What may be replaced unasked: a file that the same command wrote for the same scenario.
#include <string>

#include "scenario/scenario.h"
#include "store/draft.h"

namespace gumshoe::store {

/// Who writes a file.
struct Origin {
  std::string command; ///< "run"
  std::string scenario_file, scenario_hash;
  std::string place;  ///< hash of the scenario's absolute path
  bool force = false; ///< replaces whatever file is there
  std::string shard = {}; ///< "3/16": a part of a run
};

Origin origin_of(const scenario::Scenario& scenario, const std::string& command, bool force = false);

/// Hash of a file's absolute path, links followed: 16 hex digits.
std::string place_of(const std::string& file);

/// The right to write a result (HDF5) or a text. Throws OutputError where something else stands.
Claim claim_result(const std::string& path, const Origin& origin);
Claim claim_text(const std::string& path, const Origin& origin);

/// What a text of ours contains, in a comment or a string: "gumshoe trace 0123456789abcdef".
std::string signature(const Origin& origin);
/// A scenario of ours: the text and, as a comment, its signature and a digest, by which an edited file is known.
std::string signed_scenario(const std::string& text, const Origin& origin);

} // namespace gumshoe::store
