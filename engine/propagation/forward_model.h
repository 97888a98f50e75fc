#pragma once
/// The only interface to a model: indications and measurands at given points, with derivatives.
///
/// A ForwardModel is a model, the effects that act on it, one of its evaluations, the conditions of every reading and
/// the stated effects. A simulation adds stated effects to the indications; an evaluation first subtracts them. One
/// that is stated on a quantity is added to it for both, so that the quantity depends on the reading. No model knows of
/// them. Values are SI throughout. Thread-safe.
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "models/model.h"
#include "propagation/layout.h"
#include "propagation/points.h"

namespace gumshoe::propagation {

/// A stated effect with a size: places in a row of its size and of what it is added to, an indication or a quantity of
/// the model. Sizes are the last quantities of a row; an effect on several indications has one size.
struct StatedSize {
  std::size_t quantity = 0, target = 0;
  std::vector<double> loading; ///< [reading]: change of the target by the size, SI
};

class ForwardModel {
public:
  ForwardModel() = default;
  /// `effects`: those that act, in the order of the catalogue. `conditions`: [reading][condition], one entry per
  /// reading. The model must outlive this.
  explicit ForwardModel(const models::Model& model, std::span<const EffectCard* const> effects = {},
                        std::size_t evaluation = 0, std::vector<std::vector<double>> conditions = {{}},
                        std::vector<StatedSize> stated = {});
  /// The same, with the readings distributed over so many threads (0: all processors). A model made from a scenario (a
  /// plugin, a command) may not be thread-safe and is called from one thread only.
  ForwardModel on_threads(int threads) const;
  /// The same of some readings only, with one condition set to a value at all of them.
  ForwardModel with_condition(std::span<const std::size_t> readings, std::size_t condition, double value) const;
  /// Sets the declared uncertainties by which a joint evaluation weights its readings.
  void declare(models::Declared declared);

  const models::Model& model() const { return *model_; }
  const Layout& layout() const { return layout_; }
  std::span<const effects::Active> active() const { return active_; }
  std::size_t evaluation() const { return evaluation_; }
  std::size_t readings() const { return conditions_.size(); }
  std::span<const double> conditions(std::size_t reading) const { return conditions_[reading]; }
  std::span<const StatedSize> stated() const { return stated_; }
  /// True if all readings together give one set of measurands.
  bool joint() const;
  /// Measurands of one reading; for a joint evaluation, those that are defined for these quantities of a reading.
  std::span<const VariableCard> measurands(const double* quantities) const;
  bool has_simulation() const;
  /// True if linearise gives exact derivatives.
  bool has_derivatives() const { return model_->simulate_gradient != nullptr; }

  /// Indications of all readings at the points, under each variation. Readings with equal quantities are placed next to
  /// each other, because a model may reuse the results of the previous reading.
  Responses indications(const Points& at, std::span<const Variation> variations) const;
  /// Indications of one reading, under each variation.
  Responses indications(std::size_t reading, const std::vector<double>& point,
                        std::span<const Variation> variations) const;
  /// Indications of all readings at the points.
  Responses indications(const Points& at) const;
  /// Measurands of all readings, evaluated from the points' indications.
  Responses measurands(const Points& at, std::span<const Variation> variations) const;
  /// Measurands of one reading of an evaluation that is not joint; its conditions are the reading's.
  Responses measurands(std::size_t reading, const std::vector<double>& point,
                       std::span<const Variation> variations) const;
  /// Indications and their derivatives: exact in chunks of eight quantities, or central differences over the partials'
  /// steps where the model has no derivatives. A quantity may be asked for twice.
  Linearisation linearise(const Points& at, std::span<const Partial> partials) const;

  /// Measurands of one reading in dual numbers; stated effects are subtracted. The model must have the derivatives.
  models::PointOutcome measurands(std::size_t reading, std::vector<models::Gradient> point,
                                  std::vector<models::Gradient>& out) const;
  models::PointOutcome measurands(std::size_t reading, std::vector<models::Curvature> point,
                                  std::vector<models::Curvature>& out) const;
  /// Indications of one reading in dual numbers, stated effects added.
  models::PointOutcome indications(std::size_t reading, const std::vector<models::Gradient>& point,
                                   std::vector<models::Gradient>& out) const;

  /// Adds a reading to a block: `row` holds its columns in the order of the layout. Conditions are the reading's,
  /// unless columns are given for them; this then outlives the block.
  void add(Block& block, std::size_t reading, std::span<const models::Column> row,
           std::span<const models::Column> conditions = {}) const;
  BlockValues simulate(const Block& block) const;
  BlockValues evaluate(const Block& block) const;
  /// The call of a block kernel, stated effects left to the caller. Rows of pointers as in models::BlockCall.
  models::BlockCall call(const Block& block, double* const* simulated, double* const* measurands,
                         std::uint8_t* status) const;

  /// Subtracts the stated effects from the indications of a reading's point, as an evaluation does first.
  template <class T> void subtract_stated(std::size_t reading, T* point) const {
    for (const StatedSize& s : stated_)
      if (layout_.indications.contains(s.target))
        point[s.target] = point[s.target] - point[s.quantity] * s.loading[reading];
  }
  /// Adds the effects that are stated on quantities of the model to those of a reading's point.
  template <class T> void move_quantities(std::size_t reading, T* point) const {
    for (const StatedSize& s : stated_)
      if (layout_.model.contains(s.target)) point[s.target] = point[s.target] + point[s.quantity] * s.loading[reading];
  }
  /// Message if a reading's point is impossible although each quantity is within its limits; empty otherwise.
  std::string check(std::size_t reading, std::vector<double> point) const;
  /// Message if all readings together are impossible; and remarks on them, such as directions that they do not
  /// determine.
  std::string check_together(const Points& at) const;
  std::vector<std::string> remarks(const Points& at) const;
  /// Every intermediate value of the evaluation of a reading, in the order of computation. Stated effects are
  /// subtracted from the indications already.
  std::vector<models::Intermediate> explain(std::size_t reading, const std::vector<double>& point) const;

private:
  template <class T> models::PointCall<T> point_call(std::size_t reading, const T* point) const;
  template <class T>
  models::PointOutcome evaluate_point(std::size_t reading, std::vector<T> point, std::vector<T>& out,
                                      models::PointOutcome (*evaluate)(const models::PointCall<T>&)) const;
  struct Together;
  Together together(const Points& at) const;
  using Kernel = BlockValues (ForwardModel::*)(const Block&) const;
  Responses respond(Kernel kernel, std::span<const std::size_t> readings, const Points& at,
                    std::span<const Variation> variations) const;
  std::vector<std::size_t> alike_together(const Points& at) const;
  void by_dual_numbers(const Points& at, std::span<const Partial> partials, Linearisation& out) const;
  void by_differences(const Points& at, std::span<const Partial> partials, Linearisation& out) const;

  const models::Model* model_ = nullptr;
  std::vector<effects::Active> active_;
  Layout layout_;
  std::size_t evaluation_ = 0;
  std::vector<std::vector<double>> conditions_;
  std::vector<StatedSize> stated_;
  std::shared_ptr<const models::Declared> declared_; ///< of a joint evaluation in a scenario
  int threads_ = 1;
};

} // namespace gumshoe::propagation
