#include "store/earlier_result.h"

#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "store/record.h"

namespace gumshoe::store {
namespace {

std::string second_name(const std::string& path) {
  std::error_code none;
  const bool elsewhere = std::filesystem::is_symlink(path, none);
  return (elsewhere ? std::filesystem::weakly_canonical(path, none).string() : path) + ".gumshoe-earlier";
}

bool is_complete(const std::string& path) {
  try {
    return std::filesystem::exists(path) && read_record(path).complete;
  } catch (const InputError&) { // nothing that anyone could read
    return false;
  }
}

} // namespace

std::string said_of_earlier(const std::string& path) {
  std::error_code none;
  const std::string kept = second_name(path);
  return std::filesystem::exists(kept, none) ? fmt::format("; the finished result before it is kept as '{}'", kept) : "";
}

void require_complete(const Stored& stored, const std::string& path) {
  if (!stored.complete)
    throw InputError(path + ": the run is not finished", "it was interrupted" + said_of_earlier(path),
                     "run the same command again to resume it");
}

EarlierResult::EarlierResult(const std::string& path) : name_(second_name(path)) {
  made_ = is_complete(path) && link(path.c_str(), name_.c_str()) == 0; // one that is kept already is the finished one
}

EarlierResult::~EarlierResult() {
  if (made_) unlink(name_.c_str());
}

void EarlierResult::remove(const std::string& path) { unlink(second_name(path).c_str()); }

} // namespace gumshoe::store
