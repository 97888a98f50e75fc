#pragma once
/// A scenario's text as a tree: changed here and there, and written anew for another folder.
#include <string>
#include <vector>

#include "scenario/document.h"
#include "scenario/scenario.h"

namespace gumshoe::calibration {

scenario::Node text_node(std::string value);
scenario::Node number_node(double value);
scenario::Node list_node(std::vector<scenario::Node> items);
/// "5.2 mm", or a bare number without dimension. `difference`: of an uncertainty or a shift.
scenario::Node measure_node(double si, const std::string& unit, const std::string& si_unit, bool difference);
/// Made if there is none.
scenario::Node& member(scenario::Node& table, const std::string& key);
void erase_member(scenario::Node& table, const std::string& key);

class ScenarioText {
public:
  /// Paths of data files are made relative to `folder`, where the text will stand.
  ScenarioText(const scenario::Scenario& scenario, const std::string& folder);

  scenario::Node& document() { return document_; }
  /// Where "quantity", "effect.quantity" or "effect.size" of a stated effect stands; made if it is not there.
  scenario::Node& quantity(const std::string& name);
  /// Where its value for these labels stands. A value that holds for more readings is first written out for each of
  /// theirs, so that nothing changes for the others.
  scenario::Node& entry(const std::string& name, const quantities::Labels& labels);
  /// Ties draws by a Pearson correlation, row-major; what tied any of them before is left out,
  /// and Shapley effects take the place of Sobol' indices, which are for independent inputs.
  void tie(const std::vector<std::string>& names, const std::vector<double>& matrix, const std::string& kind,
           const std::string& source);
  /// The text, under the comments with which the scenario opens; `written` says where it comes from.
  std::string text(const std::string& written) const;

private:
  void split(scenario::Node& leaf, const std::string& name, const quantities::Labels& held, const std::string& label);

  const scenario::Scenario& scenario_;
  scenario::Node document_;
};

} // namespace gumshoe::calibration
