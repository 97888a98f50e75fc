#include "quantities/tying.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "base/error.h"
#include "base/hash.h"
#include "quantities/cells.h"
#include "quantities/copula.h"

namespace gumshoe::quantities {
namespace {

/// Ties the variates of one correlation, cell by cell.
class Tying {
public:
  Tying(std::span<const InputQuantity> quantities, const Correlation& correlation, SamplePlan& plan)
      : quantities_(quantities), correlation_(correlation), plan_(plan), n_(correlation.quantities.size()),
        group_(fmt::format("{}", fmt::join(correlation.quantities, ", "))) {}

  void tie() {
    check_matrix();
    if (std::any_of(correlation_.quantities.begin(), correlation_.quantities.end(),
                    [&](const std::string& name) { return celled(name) != none; }))
      return tie_named();
    // Cell to the variates of the members; a member left out has the index none.
    std::map<Labels, std::vector<std::size_t>> cells;
    for (std::size_t i = 0; i < n_; ++i)
      for (const std::size_t v : members(correlation_.quantities[i])) {
        auto& row = cells.try_emplace(plan_.variates[v].cell, n_, none).first->second;
        row[i] = v;
      }
    for (const auto& [cell, variates] : cells) {
      for (std::size_t i = 0; i < n_; ++i)
        if (variates[i] == none)
          fail(fmt::format("{} has no draw{}", correlation_.quantities[i], cell.empty() ? "" : " for " + text_of(cell)),
               "correlated quantities need matching draws", "give all of them the same labels and the same scope ('per')");
      tie_cell(variates);
    }
  }

private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// The variate named with its cell, "rod_length[rod 1]", "rod_length[rod 1]: seat" of several components; none if the
  /// name has no cell.
  std::size_t celled(const std::string& name) const {
    if (name.find('[') == std::string::npos) return none;
    for (std::size_t v = 0; v < plan_.variates.size(); ++v)
      if (plan_.variates[v].name == name) return v;
    return none;
  }

  /// One of the names says its cell: then each means one draw, and these are tied across cells.
  void tie_named() {
    std::vector<std::size_t> variates;
    for (const std::string& name : correlation_.quantities) {
      const std::size_t named = celled(name);
      const auto all = named == none ? members(name) : std::vector<std::size_t>{named};
      if (all.size() > 1)
        fail(fmt::format("{} has several draws", name), "next to a name with a label, each quantity must have a single draw",
             fmt::format("did you mean '{}'?", plan_.variates[all.front()].name));
      variates.push_back(all.front());
    }
    tie_cell(variates);
  }

  [[noreturn]] void fail(const std::string& what, const std::string& why = {}, const std::string& remedy = {}) const {
    throw InputError(fmt::format("correlation of {}: {}", group_, what), why, remedy);
  }

  void check_matrix() const {
    const auto& m = correlation_.matrix;
    if (n_ < 2) fail("at least two quantities are needed");
    if (m.size() != n_ * n_) fail(fmt::format("the matrix needs {} x {} numbers, not {}", n_, n_, m.size()));
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) {
        const double r = m[i * n_ + j];
        if (!(std::abs(r) <= 1)) fail(fmt::format("the coefficient {} is not between -1 and 1", r));
        if (i == j && r != 1) fail("the matrix has a diagonal element that is not 1");
        if (r != m[j * n_ + i]) fail("the matrix is not symmetric");
      }
  }

  /// Variates of "quantity" (with one component) or "quantity.component".
  std::vector<std::size_t> members(const std::string& name) const {
    std::string quantity = name, component;
    auto found = find(quantity);
    if (found == quantities_.size() && name.rfind('.') != std::string::npos) {
      quantity = name.substr(0, name.rfind('.'));
      component = name.substr(name.rfind('.') + 1);
      found = find(quantity);
    }
    if (found == quantities_.size()) {
      std::vector<std::string> known;
      for (const InputQuantity& q : quantities_) known.push_back(q.name);
      const std::string near = nearest(name, known);
      fail(fmt::format("'{}' is not a quantity", name), "", near.empty() ? "" : "did you mean '" + near + "'?");
    }
    std::vector<std::size_t> result;
    for (std::size_t v = 0; v < plan_.variates.size(); ++v) {
      const Variate& variate = plan_.variates[v];
      if (variate.quantity != found) continue;
      const auto& components = quantities_[found].entries[variate.entry].components;
      if (component.empty() && components.size() > 1)
        fail(fmt::format("{} has several components", quantity), "the name must select one of them",
             fmt::format("did you mean '{}.{}'?", quantity, components.front().name));
      if (component.empty() || components[variate.component].name == component) result.push_back(v);
    }
    if (result.empty()) fail(fmt::format("'{}' is not drawn", name), "it has no such component, or it is a constant");
    return result;
  }

  std::size_t find(const std::string& name) const {
    std::size_t q = 0;
    while (q < quantities_.size() && quantities_[q].name != name) ++q;
    return q;
  }

  void tie_cell(const std::vector<std::size_t>& variates) {
    for (std::size_t i = 0; i < n_; ++i) {
      if (std::count(variates.begin(), variates.end(), variates[i]) > 1)
        fail(fmt::format("{} is named twice", correlation_.quantities[i]));
      for (const CopulaGroup& other : plan_.copulas)
        if (std::count(other.variates.begin(), other.variates.end(), variates[i]) > 0)
          fail(fmt::format("{} is already part of another correlation", correlation_.quantities[i]), "",
               "use one matrix for all of them");
    }
    CopulaGroup group;
    group.variates = variates;
    group.matrix = correlation_.matrix;
    if (correlation_.kind == Correlation::Kind::multivariate_t) share_degrees_of_freedom(group);
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Variate &a = plan_.variates[variates[i]], &b = plan_.variates[variates[j]];
        group.matrix[i * n_ + j] = group.matrix[j * n_ + i] =
            copula_coefficient(correlation_.kind, correlation_.matrix[i * n_ + j], a.distribution, b.distribution,
                               b.name + " and " + a.name);
      }
    const CorrelationFactor factor = correlation_factor(group.matrix, correlation_.matrix, n_, group_);
    const CopulaGroup as_named = group;
    for (std::size_t i = 0; i < n_; ++i) {
      group.variates[i] = as_named.variates[factor.order[i]];
      for (std::size_t j = 0; j < n_; ++j)
        group.matrix[i * n_ + j] = as_named.matrix[factor.order[i] * n_ + factor.order[j]];
    }
    group.cholesky = factor.lower;
    for (std::size_t i = 0; i < n_ && !correlation_.together.empty(); ++i)
      group.together.push_back(correlation_.together[factor.order[i]]);
    for (std::size_t i = 0; i < n_ * n_ && !correlation_.law.empty(); ++i)
      group.pearson.push_back(correlation_.law[factor.order[i / n_] * n_ + factor.order[i % n_]]);
    plan_.copulas.push_back(std::move(group));
  }

  /// A multivariate t distribution has one number of degrees of freedom, that of the standard deviation its estimates
  /// share.
  void share_degrees_of_freedom(CopulaGroup& group) const {
    for (const std::size_t v : group.variates) {
      const Variate& variate = plan_.variates[v];
      const double nu = variate.distribution.family == Family::t ? variate.distribution.parameters[2] : 0;
      if (group.degrees_of_freedom == 0) group.degrees_of_freedom = nu;
      if (nu == 0 || std::abs(nu - group.degrees_of_freedom) > 1e-9 * nu)
        fail(fmt::format("{} has {}", variate.name,
                         nu == 0 ? "no degrees of freedom" : fmt::format("{:.6g} degrees of freedom", nu)),
             "estimates of a multivariate t distribution share the degrees of freedom of one standard deviation",
             "give all of them u with the same degrees_of_freedom, or use the kind copula");
      if (nu > 2 * largest_gamma_shape)
        fail(fmt::format("{} has {:.6g} degrees of freedom, and a multivariate t at most {:.6g}", variate.name, nu,
                         2 * largest_gamma_shape),
             "with as many it is normal", "leave degrees_of_freedom out, and use the kind copula");
      group.key += variate.key; // whatever the order of the members
    }
    group.key = hash64("multivariate t", group.key);
  }

  std::span<const InputQuantity> quantities_;
  const Correlation& correlation_;
  SamplePlan& plan_;
  std::size_t n_;
  std::string group_;
};

} // namespace

void tie(std::span<const InputQuantity> quantities, const Correlation& correlation, SamplePlan& plan) {
  Tying(quantities, correlation, plan).tie();
}

} // namespace gumshoe::quantities
