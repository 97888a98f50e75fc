#pragma once
/// A model at chosen points, whatever its quantities are: through its block kernels and through its point calls.
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "propagation/forward_model.h"

namespace gumshoe::contracts {

struct Draw {
  std::mt19937_64 engine;
  explicit Draw(std::uint64_t seed) : engine(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  }
};

/// All that a model reads at one reading, SI.
struct Point {
  std::vector<double> x; ///< the model's quantities, those of the freed effects, the indications
  std::vector<double> conditions;
};

/// Outputs at one point.
struct Outcome {
  std::vector<double> values; ///< evaluated: measurands; simulated: indications, then true measurands
  std::uint8_t status = 0;
  bool kink = false;
  bool operator==(const Outcome& other) const;                       ///< to the bit; NaN equals NaN
  bool ok() const { return status == 0; }
};

/// Outputs at one point and their derivatives by every element of Point::x, of which indications have none where they
/// are simulated: derivatives[output][variable].
struct Derived : Outcome {
  std::span<const VariableCard> cards; ///< of the outputs
  std::vector<std::vector<double>> derivatives;
};

class Subject {
public:
  /// `freed`: effects that act, in the order of the catalogue.
  explicit Subject(const models::Model& model, const std::vector<const EffectCard*>& freed = {});

  const models::Model& model() const { return model_; }
  std::size_t first_effect() const { return model_.card->quantities.size(); }
  std::size_t first_indication() const { return cards_.size(); }
  std::size_t size() const { return first_indication() + model_.card->indications.size(); }
  /// Card of the quantity x[i], i below first_indication().
  const QuantityCard& card(std::size_t i) const { return *cards_[i]; }
  std::string name(std::size_t i) const;
  bool simulates() const { return model_.kernels()->simulate != nullptr; }

  /// The point with the freed effects at their null, and indications as given or 0.
  Point at_null(const Point& plain) const;
  /// Quantities within their limits, and nothing to object to for the model.
  bool possible(const Point& p) const;
  /// Variation of x[i] that a test makes: a fiftieth of the value or, at 0, what is small for the unit; the typical size
  /// of an effect.
  double spread(std::size_t i, const Point& p) const;
  /// A possible point near `around`: quantities within their spread, conditions anything that the model takes; effects
  /// between null and typical size if `with_effects`.
  Point random(const Point& around, Draw& draw, bool with_effects = false) const;
  /// `p` with the indications that simulation gives; nothing where it fails.
  std::optional<Point> read(const Point& p) const;

  /// Through the kernels, all points in one block.
  std::vector<Outcome> simulate(const std::vector<Point>& points) const;
  std::vector<Outcome> evaluate(const std::vector<Point>& points) const;

  /// Through the point calls; not for models without derivatives.
  Derived simulate_gradient(const Point& p) const;
  Derived evaluate_gradient(const Point& p) const;
  /// Second derivatives of the measurands by eight variables: [output][8 * a + b].
  std::vector<std::vector<double>> curvature(const Point& p, const std::vector<std::size_t>& by) const;

  /// What rounding does to each output: 64 roundings of its value and of every contribution c_i x_i. An output that is
  /// small because large ones cancel rounds as those do: the largest of all outputs of its unit counts.
  std::vector<double> rounding(const Derived& outputs, const Point& p) const;

private:
  std::vector<Outcome> run(const std::vector<Point>& points, bool simulating) const;
  /// The model under the conditions of a point.
  propagation::ForwardModel at(const Point& p) const { return propagation::ForwardModel(model_, freed_, 0, {p.conditions}); }
  const models::Model& model_;
  std::vector<const EffectCard*> freed_;
  std::vector<const QuantityCard*> cards_;
  std::vector<std::string> names_;
};

/// A unit that people are shown converts to one in which SI counts: "mm" to "m", but not "m" to "mm" or "N".
bool is_unit_of_si(std::string_view unit, std::string_view si_unit);

/// A size that machines have, SI, from the card of an effect's quantity.
double typical(const QuantityCard& card);

} // namespace gumshoe::contracts
