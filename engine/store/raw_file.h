#pragma once
/// Reading and writing bytes at places of a file. Private to this folder.
#include <cstddef>
#include <cstdint>
#include <string>

namespace gumshoe::store {

/// Closed at its end; not inherited by programs that are started. Every failure is an OutputError with the system's
/// reason.
class RawFile {
public:
  RawFile() = default;
  RawFile(const std::string& path, int flags);
  RawFile(RawFile&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  RawFile& operator=(RawFile&& other) noexcept;
  ~RawFile();
  explicit operator bool() const { return number_ >= 0; }
  int number() const { return number_; }
  std::uint64_t size() const;
  void read(void* data, std::size_t bytes, std::uint64_t at) const;
  void write(const void* data, std::size_t bytes, std::uint64_t at) const;
  /// Returns once the data are on the disk.
  void sync() const;

private:
  int number_ = -1;
};

} // namespace gumshoe::store
