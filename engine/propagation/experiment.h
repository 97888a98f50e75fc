#pragma once
/// A scenario prepared for a run: its forward model, its plan of variates and columns, and the links between them.
#include <memory>

#include "models/kept.h"
#include "propagation/forward_model.h"
#include "propagation/run.h"
#include "quantities/sample_plan.h"
#include "scenario/scenario.h"

namespace gumshoe::propagation {

/// Buffers of one thread, reused from block to block.
struct Workspace {
  std::vector<double> columns, truth;
  std::vector<double> indications;        ///< [reading][indication][sample] as the last block's evaluation read them
  std::vector<double> single;             ///< outputs of the single readings, where their mean is wanted
  std::vector<models::Column> drawn, row; ///< one per column of the plan; one per value of a reading
  /// Of a run of changed columns: those columns, by place in `changed`.
  std::vector<double> changed;
  models::Kept kept; ///< of the last run that kept its values
  enum class Keeping { nothing, keep, go_on } keeping = Keeping::nothing;
  Block block;
  std::vector<double*> simulated, measurands, true_measurands;
  std::uint64_t first_sample = models::unnumbered; ///< number in the run, for messages
};

/// Whether a scenario is tried on its model: a program that a user wrote runs for it.
enum class Trial { now, made_elsewhere };

class Experiment {
public:
  /// Throws InputError: an unknown model, labels that do not match, values that exclude each other.
  explicit Experiment(const scenario::Scenario& scenario, Trial trial = Trial::now);

  const scenario::Scenario& scenario() const { return scenario_; }
  const models::Model& model() const { return forward_.model(); }
  /// The scenario's model at points given by the caller; its points hold values in the order of the scenario's
  /// quantities.
  const ForwardModel& forward() const { return forward_; }
  /// Places of the scenario's quantities.
  const Layout& layout() const { return forward_.layout(); }
  const quantities::SamplePlan& plan() const { return plan_; }
  const std::vector<Output>& outputs() const { return outputs_; }
  /// All readings together give one set of outputs, which have no reading of their own: a joint evaluation, or the mean
  /// over the readings (Scenario::mean_of_readings).
  bool joint() const { return joint_; }
  /// Measurands of one reading, or of the joint evaluation; of a prediction its indications. Output o is measurand
  /// o % measurands().size().
  std::span<const VariableCard> measurands() const { return measurands_; }
  /// Unique names of the readings: labels, then the conditions in which readings of equal labels differ, then the
  /// position. Empty for a single reading without labels.
  const std::vector<std::string>& reading_names() const { return reading_names_; }
  /// "reading 3 (rod 2)", for messages.
  std::string reading_text(std::size_t reading) const;
  /// Their names, or "all readings"; indexed by Output::reading.
  std::vector<std::string> place_names() const;
  /// Columns of the plan that the outputs of `reading` depend on: one per scenario quantity, or all columns for a joint
  /// evaluation.
  const std::vector<std::size_t>& columns_at(std::size_t reading) const {
    return joint_ ? every_column_ : plan_.gather[reading];
  }
  /// Remarks of the model on all readings of a joint evaluation together.
  const std::vector<std::string>& remarks() const { return remarks_; }

  /// Outputs for given variates (variates[v] points to n values, n a multiple of 8):
  /// outputs[row * n + i], SI, NaN where status[i] is not ok. Virtual experiment: errors, evaluated minus true;
  /// prediction: readings.
  void run(std::span<const double* const> variates, std::size_t n, Workspace& w, double* outputs,
           std::uint8_t* status) const;
  /// The same, and keeps in the workspace what the model can go on from.
  void run_and_keep(std::span<const double* const> variates, std::size_t n, Workspace& w, double* outputs,
                    std::uint8_t* status) const;
  /// The same for variates that differ from those of the last run_and_keep with this workspace and this n in columns
  /// `changed` of the plan alone: what depends on no other is not computed again. The same bits.
  void run_changed(std::span<const double* const> variates, const std::vector<std::size_t>& changed, std::size_t n,
                   Workspace& w, double* outputs, std::uint8_t* status) const;

  /// The same for given values of the plan's columns: columns[c] points to n values, null for the estimate. Values that
  /// differ from the estimates are true values in a virtual experiment and inputs in a propagation.
  void run_columns(std::span<const double* const> columns, std::size_t n, Workspace& w, double* outputs,
                   std::uint8_t* status) const;

  /// Estimates of the plan's columns.
  const std::vector<double>& column_estimates() const { return column_estimates_; }

  /// Outputs at `reading` (Output::reading), at a point as point() gives it, under each variation of its values; the
  /// readings of a Change are ignored. Rows are the outputs of that reading.
  Responses outputs_at(std::size_t reading, const std::vector<double>& point,
                       std::span<const Variation> variations) const;

  /// True if outputs_at has exact first, or first and second derivatives.
  bool has_gradient() const;
  bool has_curvature() const;
  /// Outputs at a reading in dual numbers, at a point as point() gives it, of what has them.
  models::PointOutcome outputs_at(std::size_t reading, const std::vector<models::Gradient>& point,
                                  std::vector<models::Gradient>& out) const;
  models::PointOutcome outputs_at(std::size_t reading, const std::vector<models::Curvature>& point,
                                  std::vector<models::Curvature>& out) const;

  /// Values of all quantities at a reading in the order of the layout, indications as read, or of a prediction their
  /// noise alone: the estimates, or one sample's when `variates` holds one value per variate.
  std::vector<double> reading_point(std::size_t reading, const double* variates = nullptr) const;
  /// The estimates of all readings.
  Points estimates() const;
  /// Values on which the outputs at a reading depend, in the order of columns_at: reading_point, or for a joint
  /// evaluation the values of the plan's columns, with indications as deviations from the readings.
  std::vector<double> point(std::size_t reading, const double* variates = nullptr) const;

private:
  void add_outputs(std::size_t reading);
  void check_reading(std::size_t reading) const;
  models::Declared declared() const;
  void check_together();
  void find_twins();
  void wire(Workspace& w, std::size_t n, bool estimates) const;
  void evaluate(Workspace& w, std::uint8_t* status) const;
  void run_drawn(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const;
  void run_model(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const;
  void predict(std::size_t n, Workspace& w, double* outputs, std::uint8_t* status) const;
  void linearise_prediction();
  void predict_linear(std::size_t n, Workspace& w) const;
  void simulate(std::size_t rows, std::size_t n, Workspace& w, std::uint8_t* status) const;
  void add_noise(std::size_t n, Workspace& w) const;

  const scenario::Scenario& scenario_;
  models::MadeModel made_; ///< owns the model if it was made from the scenario
  ForwardModel forward_;
  quantities::SamplePlan plan_;
  std::vector<Output> outputs_;
  std::span<const VariableCard> measurands_;
  bool virtual_ = false;    ///< a virtual experiment
  bool prediction_ = false; ///< its outputs are the indications
  bool joint_ = false;
  bool mean_ = false; ///< the outputs are the model's measurands averaged over the readings
  /// Of a prediction from what these readings say of declared values ([trace] priors): its covariance holds for the
  /// model linearised at the estimates. Empty: the prediction is of the whole model.
  Linearisation linear_;
  std::vector<Partial> partials_; ///< of the quantities that are drawn
  const models::KeepingKernels* keeping_ = nullptr;
  std::vector<std::size_t> solved_as_, every_column_;
  std::vector<double> column_estimates_;
  std::vector<std::string> remarks_, reading_names_;
};

/// 16 hex digits over everything that fixes the samples and their meaning: variates, copulas, columns, design, seed
/// (and total, where points depend on it), readings, model, method and evaluation. Equal: the same samples. A model
/// described by the scenario counts by its name only.
std::string design_hash(const Experiment& experiment);

/// The first line of the scenario's text that begins with `start`, for messages.
Location find_line(const scenario::Scenario& scenario, const std::string& start);

} // namespace gumshoe::propagation
