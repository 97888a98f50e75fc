#pragma once
/// Outputs of earlier runs as input quantities: `from = "calibration.h5:laser_z"`.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quantities/input_quantity.h"

namespace gumshoe::scenario {

struct Context;
struct Node;
class Problems;
class Table;

/// An output of a finished run: its figures, its budget in brief, and its samples.
struct EarlierOutput {
  /// A component of its budget.
  struct Share {
    std::string component;   ///< "rod_length[rod 1]: seat"
    std::string quantity;    ///< "rod_length"
    double contribution = 0; ///< c_i u_i with its sign, SI; NaN if not differentiable
    double u = 0;            ///< u_i, SI
    char evaluation = 'B';
    std::string distribution;
    double spread = 1; ///< standard deviation of its draws over u_i: above 1 of a t
  };
  std::string name, unit, si_unit;
  double estimate = 0;
  double standard_uncertainty =
      0; ///< of the GUM framework where that has degrees of freedom, else of the samples; NaN: none
  double degrees_of_freedom = 0; ///< of it; infinite where none are stated
  std::vector<Share> shares;
  std::vector<double> samples; ///< SI, in the order of the run, the first 2^20 at most; NaN: failed. Empty: not stored
  std::uint64_t drawn = 0;     ///< samples that the run drew
};

/// Reads the output of that name, "laser_z" or "laser_z[rod 1]". Throws InputError.
using ReadOutput = std::function<EarlierOutput(const std::string& file, const std::string& output)>;

/// The results that a scenario reads, each output once.
class EarlierResults {
public:
  /// `folder`: of the scenario. No function: results cannot be read here.
  EarlierResults(std::string folder, ReadOutput read) : folder_(std::move(folder)), read_(std::move(read)) {}

  /// The output that the text "file:output" at the node names; null and a problem if it cannot be read.
  const EarlierOutput* open(const Node& text, const std::string& path, Problems& problems);
  /// The same as a name; nothing if the text has not this form.
  std::optional<quantities::Earlier> locate(const std::string& text) const;
  const EarlierOutput& output(const quantities::Earlier& earlier) const {
    return *outputs_.at({earlier.file, earlier.output});
  }

  /// States the unit of a quantity of the document that has none, by the result it is from; a problem if that cannot be
  /// read.
  void state_units(Node& document, Problems& problems);

  /// Continues `hash` over the numbers read.
  std::uint64_t hash(std::uint64_t hash) const;

private:
  std::string folder_;
  ReadOutput read_;
  std::map<std::pair<std::string, std::string>, std::unique_ptr<const EarlierOutput>> outputs_;
};

/// Dependence of the quantities that are `from` results on each other and on the scenario's own quantities, one
/// correlation for each set that is tied:
/// - outputs of one file: the correlation of their normal scores, and the samples themselves, which are drawn together
///   unless others are tied to them as well (where the file has no samples, the correlation of their budgets);
/// - of different files: by the components of `same` in both budgets, sum of c_i u_i c_j u_j over u_a u_b (JCGM 100,
/// F.1.2.3);
/// - with a quantity of this scenario that `same` names: its contribution over u.
/// Draws are tied by standard deviations, which of a t are larger than the u of the law of propagation; that has its
/// own coefficients: of outputs of one file those of their budgets, where one is known by its u_c and all budgets
/// account for u.
/// Problems: a name in `same` that nothing else has, one that stands here with another u.
std::vector<quantities::Correlation> tie_results(const std::vector<quantities::InputQuantity>& quantities,
                                                 const Node& document, Context& context);

} // namespace gumshoe::scenario
