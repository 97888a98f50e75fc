#pragma once
/// A scenario made ready to run: model, plan of variates and columns, and the wiring between them.
#include <memory>

#include "models/model.h"
#include "propagation/run.h"
#include "quantities/sample_plan.h"
#include "scenario/scenario.h"

namespace gumshoe::propagation {

/// Buffers of one thread, reused from block to block.
struct Workspace {
  std::vector<double> columns, indications, truth;
  std::vector<double> single;        ///< outputs of the single readings, where their mean is wanted
  std::vector<models::Column> drawn; ///< by the plan's columns
  std::vector<models::Column> quantity_columns, effect_columns, condition_columns, indication_columns;
  std::vector<double*> simulated, measurands, true_measurands;
  std::uint64_t first_sample = models::unnumbered; ///< of the run, for messages
};

/// A stated effect that has a size: the quantity that is its size, and what it adds to.
struct StatedSize {
  std::size_t quantity, indication;
  const std::vector<double>* loading; ///< by reading, SI
};

class Experiment {
public:
  /// Throws InputError: an unknown model, labels that do not match, values that exclude each other.
  explicit Experiment(const scenario::Scenario& scenario);

  const scenario::Scenario& scenario() const { return scenario_; }
  const models::Model& model() const { return *model_; }
  const quantities::SamplePlan& plan() const { return plan_; }
  const std::vector<Output>& outputs() const { return outputs_; }
  /// All readings together give one set of outputs, which have no reading of their own: a joint evaluation, or the mean
  /// over the readings (Scenario::mean_of_readings).
  bool joint() const { return joint_; }
  /// Of one reading, or of the joint evaluation; output o is measurand o % measurands().size().
  std::span<const VariableCard> measurands() const { return measurands_; }
  /// By Output::reading: the readings' names, or "all readings".
  std::vector<std::string> place_names() const;
  /// By Output::reading: the plan's columns that an output hangs on. Of a reading: by quantity of the scenario; of a
  /// joint evaluation: every column.
  const std::vector<std::size_t>& columns_at(std::size_t reading) const {
    return joint_ ? every_column_ : plan_.gather[reading];
  }
  std::span<const effects::Active> active() const { return active_; }
  std::size_t model_quantities() const { return model_->card->quantities.size(); }
  std::size_t effect_quantities() const { return effect_quantities_; }
  std::size_t first_indication() const { return model_quantities() + effect_quantities_; }
  std::span<const StatedSize> stated() const { return stated_; }
  /// Takes the stated effects off the indications of a reading, as every evaluation does first. `point`: all
  /// quantities.
  template <class T> void take_off_stated(std::size_t reading, T* point) const {
    for (const StatedSize& s : stated_) {
      T& indication = point[first_indication() + s.indication];
      indication = indication - point[s.quantity] * (*s.loading)[reading];
    }
  }
  std::size_t evaluation() const { return evaluation_; }
  /// What the model says of all readings of a joint evaluation together.
  const std::vector<std::string>& remarks() const { return remarks_; }

  /// Outputs for given variates (variates[v] points to n values, n a multiple of 8):
  /// outputs[row * n + i], SI, NaN where status[i] is not ok. Virtual experiment: errors, evaluated minus true.
  /// `changed`: the only columns that differ from the last call with this workspace and this n; null: all.
  void run(std::span<const double* const> variates, std::size_t n, Workspace& w, double* outputs, std::uint8_t* status,
           const std::vector<std::size_t>* changed = nullptr) const;

  /// The same for given values of the plan's columns: columns[c] points to n values, null for the estimate. What
  /// differs from the estimates is the truth of a virtual experiment and the input of a propagation.
  void run_columns(std::span<const double* const> columns, std::size_t n, Workspace& w, double* outputs,
                   std::uint8_t* status) const;

  /// Estimates of the plan's columns.
  const std::vector<double>& column_estimates() const { return column_estimates_; }

  /// Values of all quantities at a reading (model, effects, indications as read, sizes, in this order): the estimates,
  /// or one sample's when `variates` holds one value per variate.
  std::vector<double> reading_point(std::size_t reading, const double* variates = nullptr) const;
  /// What the outputs at a reading hang on, in the order of columns_at: reading_point; of a joint evaluation the values
  /// of the plan's columns, indications as deviations from what was read.
  std::vector<double> point(std::size_t reading, const double* variates = nullptr) const;

private:
  void add_outputs(std::size_t reading);
  void check_reading(std::size_t reading) const;
  void declare();
  void check_all();
  void wire(Workspace& w, bool estimates) const;
  void run_drawn(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const;
  void run_model(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const;
  const scenario::Scenario& scenario_;
  const models::Model* model_;
  models::MadeModel made_; ///< keeps a model alive that was made from the scenario
  quantities::SamplePlan plan_;
  std::vector<Output> outputs_;
  std::vector<effects::Active> active_;
  std::vector<StatedSize> stated_;
  std::size_t effect_quantities_ = 0, indications_ = 0, evaluation_ = 0;
  std::span<const VariableCard> measurands_;
  bool joint_ = false;
  bool mean_ = false; ///< the outputs are means of the model's over the readings
  std::vector<std::size_t> solved_as_, every_column_;
  std::vector<double> column_estimates_, conditions_;
  models::Declared declared_; ///< of a joint evaluation
  std::vector<std::string> remarks_;
};

/// 16 hex digits over everything that fixes the samples and their meaning: variates, copulas, columns, design, seed
/// (and total, where points depend on it), readings, model, method and evaluation. Equal: the same samples. A model
/// described by the scenario counts by its name only.
std::string design_hash(const Experiment& experiment);

/// "rod 2, 1": the label values of a reading, or "" where it has none.
std::string reading_name(const quantities::Reading& reading);

} // namespace gumshoe::propagation
