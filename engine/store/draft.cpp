#include "store/draft.h"

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/inputs.h"

namespace gumshoe::store {
namespace fs = std::filesystem;

namespace {

constexpr const char *lock_ending = ".gumshoe-lock", *draft_ending = ".gumshoe-new";

/// Whether the file still has its name: another process may have removed it before it was locked.
bool named(int file, const std::string& name) {
  struct stat held {}, there {};
  return fstat(file, &held) == 0 && lstat(name.c_str(), &there) == 0 && held.st_ino == there.st_ino &&
         held.st_dev == there.st_dev;
}

/// Removes locks and drafts whose processes are gone: those that nobody holds.
void remove_leftovers(const fs::path& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().string();
    if (!name.ends_with(lock_ending) && !name.ends_with(draft_ending)) continue;
    const int file = open(name.c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) continue;
    if (flock(file, LOCK_EX | LOCK_NB) == 0 && named(file, name)) unlink(name.c_str());
    close(file);
  }
}

/// Gives a file a second name, under which it can be put back; only that one where the file system has no hard links.
bool keep(const std::string& target, const std::string& kept) {
  return link(target.c_str(), kept.c_str()) == 0 || (errno != ENOENT && std::rename(target.c_str(), kept.c_str()) == 0);
}

/// Whether another program has the file open, as HDF5 locks the files that it opens.
bool open_elsewhere(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return false;
  const bool held = flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(file);
  return held;
}

void require_not_read(const std::string& path, const std::string& target) {
  const std::string input = inputs::same_file(target);
  if (input.empty()) return;
  const bool linked = fs::path(input).lexically_normal() != fs::absolute(path).lexically_normal();
  throw OutputError(path + ": this is the file that is read",
                    linked ? "it is " + input + ", which would be overwritten" : "it would be overwritten",
                    "choose another name for the output");
}

OutputError cannot_be_moved(const std::string& target, int reason) {
  return OutputError("'" + target + "': cannot be moved into place", std::strerror(reason));
}

} // namespace

LockedFile::LockedFile(const std::string& name, bool fresh) {
  const int flags = O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC | (fresh ? O_EXCL : 0);
  for (int attempt = 0; attempt < 20; ++attempt) {
    number_ = open(name.c_str(), flags, 0666);
    if (number_ < 0) throw OutputError("cannot create '" + name + "'", std::strerror(errno));
    // A file system that cannot lock is used without: then nothing keeps two processes apart.
    const bool locked = flock(number_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
    if (locked && named(number_, name)) return;
    close(number_);
    number_ = -1;
    if (!locked) std::this_thread::sleep_for(std::chrono::milliseconds(10)); // perhaps only looked at by another process
  }
}

LockedFile& LockedFile::operator=(LockedFile&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

LockedFile::~LockedFile() {
  if (number_ >= 0) close(number_);
}

Claim::Claim(const std::string& path) : path_(path) {
  naming(path, [&] {
    target_ = destination(path);
    require_not_read(path, target_);
    remove_leftovers(fs::path(target_).parent_path());
    const std::string name = target_ + lock_ending;
    lock_ = LockedFile(name, false);
    const char* wait = "wait until it has finished, or choose another name";
    const std::string self = "process " + std::to_string(getpid());
    if (!lock_) {
      std::string holder;
      std::getline(std::ifstream(name), holder);
      if (holder == self)
        throw OutputError("two outputs of this command would be written to it", "", "choose two names");
      throw OutputError("another process is writing this file", holder, wait);
    }
    const std::string line = self + '\n';
    if (ftruncate(lock_.number(), 0) != 0 || pwrite(lock_.number(), line.data(), line.size(), 0) < 0) {
    } // a full disk: the lock holds without the name
    if (open_elsewhere(target_)) {
      unlink(name.c_str());
      throw OutputError("not overwritten", "another program has it open", "wait until it is closed");
    }
  });
}

Claim::~Claim() {
  if (lock_) unlink((target_ + lock_ending).c_str());
}

Draft::~Draft() {
  for (const File& file : files_) unlink(file.name.c_str());
}

std::string Draft::add(const Claim& claim) {
  std::string name = claim.target() + '.' + std::to_string(getpid()) + draft_ending;
  files_.push_back({name, claim.target(), LockedFile(name, true)});
  return name;
}

std::string Draft::add(const Claim& claim, const std::string& text) {
  return naming(claim.path(), [&] {
    std::string name = add(claim);
    std::FILE* file = std::fopen(name.c_str(), "wb");
    const bool wrote = file && std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const bool closed = file && std::fclose(file) == 0;
    if (!wrote || !closed) throw OutputError("cannot be written", std::strerror(errno));
    return name;
  });
}

void Draft::move_into_place() {
  std::vector<std::string> kept(files_.size()); // names of the files that were replaced; empty: there was none
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const std::string old = files_[i].target + '.' + std::to_string(getpid()) + "-old" + draft_ending;
    if (i + 1 < files_.size() && keep(files_[i].target, old)) kept[i] = old; // the last is replaced or stays
    if (std::rename(files_[i].name.c_str(), files_[i].target.c_str()) == 0) continue;
    const OutputError error = cannot_be_moved(files_[i].target, errno);
    for (std::size_t j = i + 1; j-- > 0;) {
      if (!kept[j].empty()) {
        std::rename(kept[j].c_str(), files_[j].target.c_str());
        unlink(kept[j].c_str()); // two names of one file: renaming does nothing
      } else if (j < i) {
        std::rename(files_[j].target.c_str(), files_[j].name.c_str());
      }
    }
    throw error;
  }
  for (const std::string& name : kept)
    if (!name.empty()) unlink(name.c_str());
}

void Draft::publish(bool durable) {
  std::set<fs::path> folders;
  for (const File& file : files_) {
    if (durable && fsync(file.lock.number()) != 0 && errno != EINVAL)
      throw OutputError("'" + file.target + "': cannot be written", std::strerror(errno));
    if (std::error_code none; fs::is_directory(file.target, none)) throw cannot_be_moved(file.target, EISDIR);
    folders.insert(fs::path(file.target).parent_path());
  }
  move_into_place();
  for (const std::string& path : removed_) unlink(path.c_str());
  files_.clear();
  if (!durable) return;
  for (const fs::path& folder : folders) {
    const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file < 0) continue;
    fsync(file);
    close(file);
  }
}

} // namespace gumshoe::store
