#pragma once
/// Output files: each is written by one process at a time, appears whole or not at all, and files that belong together
/// appear together.
#include <cstdint>
#include <string>
#include <vector>

#include "store/place.h"

namespace gumshoe::store {

/// A file that this process alone has open for writing: locked until it is closed, also if the process dies.
class LockedFile {
public:
  LockedFile() = default;
  /// `fresh`: it must not exist. No link is followed, and no program that is started inherits it. Throws OutputError if
  /// it cannot be made; holds nothing if another process holds it.
  LockedFile(const std::string& name, bool fresh);
  LockedFile(LockedFile&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  LockedFile& operator=(LockedFile&& other) noexcept;
  ~LockedFile();
  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }

private:
  int number_ = -1;
};

/// The right to write one file, for as long as it lives.
class Claim {
public:
  Claim() = default;
  /// Removes what killed processes left in the folder. Throws OutputError: no place for a file, this process reads
  /// it (base/inputs.h), or another process is writing it or has it open.
  explicit Claim(const std::string& path);
  Claim(Claim&&) = default;
  Claim& operator=(Claim&&) = default;
  ~Claim();
  /// The file itself, links followed.
  const std::string& target() const { return target_; }
  /// The name that the user gave.
  const std::string& path() const { return path_; }
  /// Said of a damaged result that will be replaced; empty: no such thing.
  std::string remark;

private:
  std::string path_, target_;
  LockedFile lock_;
};

/// Files under construction, next to their places; removed unless they are published.
class Draft {
public:
  Draft() = default;
  Draft(Draft&&) = default;
  Draft& operator=(Draft&&) = default;
  ~Draft();
  /// Name of a new, empty file that will take the place of `claim`. The claim must outlive the draft.
  std::string add(const Claim& claim);
  /// Adds a file with this text; returns its name until then.
  std::string add(const Claim& claim, const std::string& text);
  /// Has an older file removed when the others appear.
  void remove(const Claim& claim) { removed_.push_back(claim.target()); }
  /// Puts all of them into their places, on the disk if `durable`. Throws OutputError where one cannot be written or
  /// moved; then all places are as they were.
  void publish(bool durable = true);

private:
  struct File {
    std::string name, target;
    LockedFile lock;
  };
  void move_into_place();
  std::vector<File> files_;
  std::vector<std::string> removed_;
};

} // namespace gumshoe::store
