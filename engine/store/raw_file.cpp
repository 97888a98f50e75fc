#include "store/raw_file.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.h"

namespace gumshoe::store {

RawFile::RawFile(const std::string& path, int flags) : number_(open(path.c_str(), flags | O_CLOEXEC)) {
  if (number_ < 0) throw OutputError("cannot open the file", std::strerror(errno));
}

RawFile& RawFile::operator=(RawFile&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

RawFile::~RawFile() {
  if (number_ >= 0) close(number_);
}

std::uint64_t RawFile::size() const {
  struct stat status {};
  if (fstat(number_, &status) != 0) throw OutputError("cannot read the file", std::strerror(errno));
  return static_cast<std::uint64_t>(status.st_size);
}

void RawFile::read(void* data, std::size_t bytes, std::uint64_t at) const {
  for (char* to = static_cast<char*>(data); bytes > 0;) {
    const ssize_t n = pread(number_, to, bytes, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw OutputError("cannot read the file", n < 0 ? std::strerror(errno) : "it is too short");
    to += n, at += static_cast<std::uint64_t>(n), bytes -= static_cast<std::size_t>(n);
  }
}

void RawFile::write(const void* data, std::size_t bytes, std::uint64_t at) const {
  for (const char* from = static_cast<const char*>(data); bytes > 0;) {
    const ssize_t n = pwrite(number_, from, bytes, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw OutputError("cannot write the file", std::strerror(n < 0 ? errno : ENOSPC));
    from += n, at += static_cast<std::uint64_t>(n), bytes -= static_cast<std::size_t>(n);
  }
}

void RawFile::sync() const {
  if (fdatasync(number_) != 0 && errno != EINVAL) throw OutputError("cannot write the file", std::strerror(errno));
}

} // namespace gumshoe::store
