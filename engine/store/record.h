#pragma once
/// The record at the end of a result file or a history: text that says what the file is, where its samples lie, and by
/// a digest whether the rest is as it was written. It is read, and checked, before HDF5 looks at the file. Private to
/// this folder.
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "store/raw_file.h"
#include "store/result_file.h"

namespace gumshoe::store {

constexpr int format_version = 2;
/// Stands for the command in the record of a history, which is no result.
inline constexpr const char* history_command = "trace --append";

/// The texts of an identity, by their names in files.
inline constexpr std::pair<const char*, std::string Identity::*> identity_texts[] = {
    {"command", &Identity::command},
    {"version", &Identity::version},
    {"instruction_set", &Identity::instruction_set},
    {"model", &Identity::model},
    {"method", &Identity::method},
    {"evaluation", &Identity::evaluation},
    {"design", &Identity::design},
    {"adaptive", &Identity::adaptive},
    {"scenario_file", &Identity::scenario_file},
    {"scenario_place", &Identity::scenario_place},
    {"scenario_hash", &Identity::scenario_hash},
    {"design_hash", &Identity::design_hash},
    {"external", &Identity::external},
    {"scenario_text", &Identity::scenario_text}};

/// The same of a shard; other files do not have them.
inline constexpr std::pair<const char*, std::string Identity::*> shard_texts[] = {{"shard", &Identity::shard},
                                                                                  {"options", &Identity::options}};

/// Bytes of a file.
struct Span {
  std::uint64_t offset = 0, bytes = 0;
};

struct Record {
  Identity identity;
  bool complete = false;
  /// Datasets that are written in place, by path: samples, their digests and the progress marker. The record's digest
  /// leaves them out.
  std::map<std::string, Span> places;
  /// Measurand and reading of each row of samples, in the order of their digests.
  std::vector<std::pair<std::string, std::uint64_t>> rows;
};

/// Digest of the first `bytes` of a file without those places, which lie in it.
std::uint64_t digest_around(const RawFile& file, std::uint64_t bytes, const std::map<std::string, Span>& places);

/// Appends the record to a file that HDF5 has closed. Throws OutputError.
void seal(const std::string& path, const Record& record);

/// Readable, and no result of ours.
struct NoResult : OutputError {
  using OutputError::OutputError;
};

/// Throws OutputError: NoResult, or what is damaged.
Record read_record(const std::string& path);

} // namespace gumshoe::store
