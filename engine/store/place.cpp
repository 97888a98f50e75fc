#include "store/place.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace gumshoe::store {
namespace fs = std::filesystem;

std::string destination(const std::string& path) {
  const auto refuse = [&](const std::string& why, const std::string& remedy = {}) {
    throw OutputError("'" + path + "' cannot be written", why, remedy);
  };
  if (path.empty()) refuse("no name is given");
  std::error_code error;
  const fs::path target = fs::weakly_canonical(fs::absolute(path), error);
  if (error) refuse(error.message());
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) refuse("it is a directory", "give a file name");
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse("it is not a regular file");
  const fs::path folder = target.parent_path();
  if (fs::exists(folder, error) && !fs::is_directory(folder, error))
    refuse("'" + folder.string() + "' is a file and no folder", "choose another place");
  if (!fs::is_directory(folder, error)) refuse("folder '" + folder.string() + "' does not exist", "create it first");
  if (access(folder.c_str(), W_OK | X_OK) != 0) refuse("folder '" + folder.string() + "': " + std::strerror(errno));
  if (fs::exists(status) && access(target.c_str(), R_OK | W_OK) != 0) refuse(std::strerror(errno));
  if (target.filename().string().size() > 230) refuse("the name is too long");
  return target.string();
}

namespace {
std::string bytes_text(double size) {
  for (const char* unit : {"bytes", "kB", "MB", "GB", "TB"}) {
    if (size < 1000) return fmt::format("{:.3g} {}", size, unit);
    size /= 1000;
  }
  return fmt::format("{:.3g} PB", size);
}

[[noreturn]] void no_space(double bytes, int problem) {
  throw OutputError("cannot allocate " + bytes_text(bytes), std::strerror(problem),
                    "use fewer samples, another disk, or store_samples = false");
}
} // namespace

void require_space(const std::string& path, double bytes) {
  struct statvfs system {};
  const fs::path folder = fs::path(path).parent_path();
  if (statvfs(folder.c_str(), &system) == 0 &&
      static_cast<double>(system.f_bavail) * static_cast<double>(system.f_frsize) < bytes)
    no_space(bytes, ENOSPC);
}

void claim_space(const std::string& path, std::uint64_t reserve) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) throw OutputError("cannot open '" + path + "'", std::strerror(errno));
  struct stat status {};
  fstat(file, &status);
  const auto size = static_cast<std::uint64_t>(status.st_size) + reserve;
  // Not every file system can; then a full disk shows while writing.
  const bool claimed = fallocate(file, FALLOC_FL_KEEP_SIZE, 0, static_cast<off_t>(size)) == 0;
  const int problem = errno;
  close(file);
  if (!claimed && problem != EOPNOTSUPP && problem != ENOSYS && problem != EINTR)
    no_space(static_cast<double>(size), problem);
}

void survive_size_limit() {
  struct sigaction now {};
  if (sigaction(SIGXFSZ, nullptr, &now) == 0 && now.sa_handler == SIG_DFL) std::signal(SIGXFSZ, SIG_IGN);
}

} // namespace gumshoe::store
