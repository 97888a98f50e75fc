#include "base/inputs.h"

#include <filesystem>
#include <mutex>
#include <set>

#include <sys/stat.h>

namespace gumshoe::inputs {
namespace {

struct Noted {
  std::mutex mutex;
  std::set<std::string> paths; ///< absolute, as they were given
};

Noted& noted() {
  static Noted all;
  return all;
}

} // namespace

void note(const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::absolute(path, error);
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  all.paths.insert(error ? path : whole.string());
}

std::string same_file(const std::string& path) {
  struct stat out {
  }, in{};
  if (stat(path.c_str(), &out) != 0) return {}; // nothing is there to be replaced
  Noted& all = noted();
  const std::lock_guard lock(all.mutex);
  for (const std::string& one : all.paths)
    if (stat(one.c_str(), &in) == 0 && in.st_ino == out.st_ino && in.st_dev == out.st_dev) return one;
  return {};
}

} // namespace gumshoe::inputs
