#pragma once
/// Ranks: the processes that a launcher of MPI (mpirun) starts for one run. Rank 0 runs the scenario as ever; the
/// others compute blocks of samples and units of studies for it.
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "propagation/propagate.h"
#include "propagation/transport.h"
#include "propagation/work.h"

namespace gumshoe::propagation {

/// What the launcher says of this process.
struct Launch {
  int rank = 0;
  int size = 0; ///< 0: it does not say how many there are
};

/// From the environment. None: a process of its own, or the only one.
std::optional<Launch> launched();

/// What other ranks do for the first, a piece of it at a time for each of these.
struct Help {
  std::vector<MakeBlock> blocks;
  std::vector<DoUnits> units;
};

/// How a rank does it. Thread-safe.
struct Service {
  MakeBlock block;                                   ///< of samples
  std::function<Work(const std::string& name)> work; ///< of a study
};

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

  /// Rank 0: what other ranks do. `run` says which run this is. Throws InputError with what any rank reports;
  /// Interrupted.
  Help begin(const std::string& run);

  /// Other ranks: waits for rank 0 to begin. Returns its run; none: rank 0 had an error and needs no help.
  std::optional<std::string> awaited();
  /// Serves rank 0 on so many threads, until it has all.
  void serve(const Service& service, int threads);
  /// Tells rank 0 why this rank cannot serve.
  void report(const std::exception& failure);

private:
  struct Place {
    int rank = 0, tag = 0; ///< of one thread of another rank
  };

  explicit Ranks(std::unique_ptr<Transport> transport) : transport_(std::move(transport)) {}
  std::string receive(int from, int tag);
  /// The reply of a thread of another rank to "do units [first, last) of this work", or make a block of samples if it
  /// has no name.
  std::string ask(const Place& place, std::uint64_t first, std::uint64_t last, const std::string& work);
  void answer(const Service& service, int tag);

  std::unique_ptr<Transport> transport_;
  std::vector<Place> places_;
  bool begun_ = false;
};

} // namespace gumshoe::propagation
