#pragma once
/// The model runs of studies, divided into units that any process can do: threads, shards and ranks of MPI alike.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace gumshoe::propagation {

/// One study's model runs. What a unit gives is a function of its number alone, whoever does it, and in whichever
/// company.
struct Work {
  std::string name;           ///< no other of the run has it; other processes know the work by it
  std::uint64_t units = 0;    ///< cells and blocks of the study, in one row
  std::size_t values = 0;     ///< numbers that a unit gives
  std::uint64_t runs = 1;     ///< of the model in a unit, about: shares are equal by these
  std::uint64_t together = 1; ///< units that are best done in one call
  /// Does units [first, last): out[(unit - first) * values + k]. Thread-safe.
  std::function<void(std::uint64_t first, std::uint64_t last, double* out)> compute;
};

/// Takes what units [first, last) gave.
using TakeUnits = std::function<void(std::uint64_t first, std::uint64_t last, const double* values)>;
/// Does units in another process.
using DoUnits = std::function<std::vector<double>(const Work& work, std::uint64_t first, std::uint64_t last)>;

/// Who does the work of studies.
struct Workers {
  Workers(int threads_wanted) : threads(threads_wanted) {} ///< 0: all processors. They alone do it.
  int threads;
  std::vector<DoUnits> elsewhere; ///< other processes, each of which does a few units at a time besides the threads
  /// Hands over what is known already. False: nothing of this work is.
  std::function<bool(const Work& work, const TakeUnits& take)> known;

  std::size_t size() const; ///< threads and other processes
  /// Calls take for units [first, last) of the work: in order, from one thread at a time, a few units per call. Throws
  /// Interrupted after a signal, and what the model throws.
  void run(const Work& work, std::uint64_t first, std::uint64_t last, const TakeUnits& take) const;
  void run(const Work& work, const TakeUnits& take) const { run(work, 0, work.units, take); }
  /// All values, by unit.
  std::vector<double> values(const Work& work) const;
};

/// Units [first, last) of works[work].
struct Portion {
  std::size_t work = 0;
  std::uint64_t first = 0, last = 0;
};

} // namespace gumshoe::propagation
