#pragma once
/// Messages between ranks. The module gumshoe_mpi.so implements them and alone is linked with MPI, which a plain run
/// need not load.
#include <optional>
#include <string>

namespace gumshoe::propagation {

/// Several threads may call it at once. An error of MPI ends all ranks.
class Transport {
public:
  /// Returns once all ranks have left.
  virtual ~Transport() = default;
  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// This rank's share of the processors that it may use, at least 1.
  virtual int processors() const = 0;
  virtual void send(int to, int tag, const std::string& bytes) = 0;
  /// The oldest message of this rank and tag, if one has come.
  virtual std::optional<std::string> poll(int from, int tag) = 0;
};

/// What the module exports. Every rank calls it once.
extern "C" Transport* gumshoe_open_transport();

} // namespace gumshoe::propagation
