#pragma once
/// Ranks: the processes that a launcher of MPI (mpirun) starts for one run. Rank 0 runs the scenario as ever; the
/// others compute blocks of samples for it.
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "propagation/propagate.h"
#include "propagation/transport.h"

namespace gumshoe::propagation {

/// What the launcher says of this process.
struct Launch {
  int rank = 0;
  int size = 0; ///< 0: it does not say how many there are
};

/// From the environment. None: a process of its own, or the only one.
std::optional<Launch> launched();

class Ranks {
public:
  /// Joins the other ranks through the module that knows MPI. Null: a process of its own. Programs that this process
  /// starts are no ranks. Throws InputError: no such module, a launcher of another MPI.
  static std::unique_ptr<Ranks> join();
  /// Rank 0 sends the others home. After a signal it does not: a rank that died would never leave.
  ~Ranks();
  bool first() const { return transport_->rank() == 0; }
  /// Number of threads of this rank; 0 asks for its share of the processors.
  int threads(int asked) const { return asked > 0 ? asked : transport_->processors(); }

  /// Rank 0: the blocks that other ranks make, one at a time by each of these. `run` says which run this is. Throws
  /// InputError with what any rank reports; Interrupted.
  std::vector<MakeBlock> begin(const std::string& run);

  /// Other ranks: waits for rank 0 to begin. Returns its run; none: rank 0 had an error and needs no help.
  std::optional<std::string> awaited();
  /// Makes blocks for rank 0 on so many threads, until it has all.
  void serve(const Experiment& experiment, int threads);
  /// Tells rank 0 why this rank cannot serve.
  void report(const std::exception& failure);

private:
  struct Place {
    int rank = 0, tag = 0; ///< of one thread of another rank
  };

  explicit Ranks(std::unique_ptr<Transport> transport) : transport_(std::move(transport)) {}
  std::string receive(int from, int tag);
  ResultBlock fetch(const Place& place, std::uint64_t first, std::uint64_t last);
  void make_blocks(const MakeBlock& make, int tag);

  std::unique_ptr<Transport> transport_;
  std::vector<Place> places_;
  bool begun_ = false;
};

} // namespace gumshoe::propagation
