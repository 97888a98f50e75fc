#pragma once
/// A finished result that an unfinished run replaces stays until that run is complete: an interruption loses nothing.
#include <string>

#include "store/result_file.h"

namespace gumshoe::store {

/// What there is of the finished result that stood at a path: "; the finished result before it is kept as 'A.h5...'".
/// Empty: none.
std::string said_of_earlier(const std::string& path);

/// Throws InputError if the run is not finished.
void require_complete(const Stored& stored, const std::string& path);

/// Gives the finished result at a path, if there is one, a second name, under which it stays when the file at the path
/// is replaced. Where the file system has no second names nothing is kept.
class EarlierResult {
public:
  explicit EarlierResult(const std::string& path);
  /// Takes the second name away, unless settle() was called: the file at the path was not replaced.
  ~EarlierResult();
  EarlierResult(const EarlierResult&) = delete;
  EarlierResult& operator=(const EarlierResult&) = delete;
  void settle() { made_ = false; }
  /// The run is complete.
  static void remove(const std::string& path);

private:
  std::string name_;
  bool made_ = false;
};

} // namespace gumshoe::store
