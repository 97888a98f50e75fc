#pragma once
/// Samples looked at ahead of the block loops, so that a model may prepare several readings together.
///
/// A model M whose blocks run on doubles may have
///   struct Prepared                                              what simulate and evaluate then take for the memory
///   static void prepare(readings, indications, memory, prepared) for readings that are not impossible; `indications`
///                                                                is empty while simulating
/// with std::span<const Reading<Rows, double>* const> readings, std::span<const Rows::Indications<double>> indications
/// and Prepared* prepared. Each reading's Prepared depends on that reading alone.
#include "models/adapter.h"

namespace gumshoe::models {

template <class M>
concept Prepares = M::scalar && requires {
  typename M::Prepared;
};

namespace detail {

/// The readings of the samples at hand, as they come.
template <class M, class T> class Present {
  using Rows = typename M::Rows;

public:
  Present(const BlockCall& call, bool simulating) : group_(call, simulating), refusals_(call, group_.quantities()) {}
  template <class Memory> void turn(std::size_t i, Memory&) {
    refusals_.pass(i);
    group_.together(i, all_);
  }
  const Together<Rows, T>& readings() const { return all_; }
  /// Refuses what is impossible about reading r.
  void check(std::size_t r, Outcome<T>& outcome) const { refusals_.check(r, all_.at[r], outcome); }

private:
  Group<M, T> group_;
  Refusals<M, T> refusals_;
  Together<Rows, T> all_;
};

/// The same, prepared with those of the samples that follow.
template <class M> class Ahead {
  using Rows = typename M::Rows;

public:
  Ahead(const BlockCall& call, bool simulating)
      : readings_(call.readings), simulating_(simulating), group_(call, simulating),
        refusals_(call, group_.quantities()), ahead_(samples), outcomes_(samples * readings_),
        prepared_(samples * readings_), places_(samples * readings_) {}

  /// Turns to sample i, for every i in turn.
  template <class Memory> void turn(std::size_t i, Memory& memory) {
    at_ = i % samples;
    if (at_ == 0) look(i, memory);
  }
  const Together<Rows, double>& readings() const { return ahead_[at_]; }
  const Outcome<double>& outcome(std::size_t r) const { return outcomes_[at_ * readings_ + r]; }
  void check(std::size_t r, Outcome<double>& outcome) const { outcome.fail(this->outcome(r).status[0]); }
  /// What was prepared for reading r, if that is not impossible.
  typename M::Prepared& prepared(std::size_t r) { return prepared_[places_[at_ * readings_ + r]]; }

private:
  static constexpr std::size_t samples = 8; ///< a block is a multiple of it

  template <class Memory> void look(std::size_t i, Memory& memory) {
    refusals_.pass(i);
    possible_.clear();
    read_.clear();
    for (std::size_t k = 0; k < samples; ++k) {
      group_.together(i + k, ahead_[k]);
      for (std::size_t r = 0; r < readings_; ++r) {
        const std::size_t here = k * readings_ + r;
        outcomes_[here] = {};
        refusals_.check(r, ahead_[k].at[r], outcomes_[here]);
        places_[here] = possible_.size();
        if (outcomes_[here].failed) continue;
        possible_.push_back(&ahead_[k].at[r]);
        if (!simulating_) read_.push_back(ahead_[k].read[r]);
      }
    }
    M::prepare(possible_, read_, memory, prepared_.data());
  }

  std::size_t readings_;
  bool simulating_;
  Group<M, double> group_;
  Refusals<M, double> refusals_;
  std::vector<Together<Rows, double>> ahead_;
  std::vector<Outcome<double>> outcomes_;
  std::vector<typename M::Prepared> prepared_;
  std::vector<std::size_t> places_; ///< in what is prepared
  std::vector<const Reading<Rows, double>*> possible_;
  std::vector<typename Rows::template Indications<double>> read_;
  std::size_t at_ = 0;
};

} // namespace detail
} // namespace gumshoe::models
