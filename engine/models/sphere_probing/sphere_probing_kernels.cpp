/// Block loops of sphere probing, compiled once per instruction set. An axis whose command and errors are the same for
/// all samples moves once per reading.
#include <algorithm>

#include "models/columns.h"
#include "models/sphere_probing/sphere_probing.h"

namespace gumshoe::models::probing {
namespace {

constexpr std::size_t width = Lanes::size;

Lanes load(const Column& c, std::size_t i) { return detail::load<Lanes>(c, i); }
void store(const Vector3<Lanes>& v, double* const* rows, std::size_t i) {
  v.x.store_unaligned(rows[0] + i);
  v.y.store_unaligned(rows[1] + i);
  v.z.store_unaligned(rows[2] + i);
}

/// The axes at one reading.
class Axes {
public:
  Axes(const SphereProbing& p, const BlockCall& call, std::size_t reading, bool recorded)
      : p_(p), moved_(p.slide_of.size()), errors_(moved_.size() * chain::error_kinds, Lanes(0.0)),
        commands_(moved_.size(), Column{&zero, 0}), columns_(errors_.size(), Column{&zero, 0}) {
    const ModelCard& card = p.card->card();
    quantities_ = call.quantities + reading * card.quantities.size();
    for (std::size_t j = 0; j < p.error_of.size(); ++j) columns_[p.error_of[j]] = quantities_[first_error + j];
    for (std::size_t a = 0; a < moved_.size(); ++a) {
      const int s = p.slide_of[a];
      if (s < 0)
        commands_[a] = call.conditions[reading * card.conditions.size() + p.condition_of[a]];
      else if (recorded)
        commands_[a] = call.indications[reading * 3 + static_cast<std::size_t>(s)];
      const auto first = columns_.begin() + static_cast<std::ptrdiff_t>(a * chain::error_kinds);
      const auto uniform = [](const Column& c) { return c.stride == 0; };
      if (!uniform(commands_[a]) || !std::all_of(first, first + chain::error_kinds, uniform))
        varying_.push_back(a);
      else
        move(a, 0);
    }
  }

  Contact<Lanes> at(std::size_t i) {
    for (const std::size_t a : varying_) move(a, i);
    Lanes q[first_error];
    for (std::size_t j = 0; j < first_error; ++j) q[j] = load(quantities_[j], i);
    return contact(moved_.data(), p_.slide_of, p_.machine.on_workpiece_side(), points(q));
  }

private:
  void move(std::size_t a, std::size_t i) {
    Lanes* e = errors_.data() + a * chain::error_kinds;
    for (std::size_t k = 0; k < chain::error_kinds; ++k) e[k] = load(columns_[a * chain::error_kinds + k], i);
    moved_[a] = moved(p_.machine.axes()[a], p_.slide_of[a] >= 0, load(commands_[a], i), e);
  }

  static constexpr double zero = 0;
  const SphereProbing& p_;
  const Column* quantities_;
  std::vector<Moved<Lanes>> moved_;
  std::vector<Lanes> errors_;
  std::vector<Column> commands_, columns_;
  std::vector<std::size_t> varying_;
};

void simulate(const BlockCall& call) {
  const auto& p = *static_cast<const SphereProbing*>(call.context);
  for (std::size_t r = 0; r < call.readings; ++r) {
    Axes axes(p, call, r, false);
    for (std::size_t i = 0; i < call.samples; i += width) {
      const auto c = axes.at(i);
      store(closing(c), call.simulated + r * 3, i);
      store({Lanes(0.0), Lanes(0.0), Lanes(0.0)}, call.measurands + r * measurands, i); // the true deviation
      const auto spans = num::abs(span_of(c.slides)) >= Lanes(least_span);
      for (std::size_t l = 0; l < width; ++l)
        if (!spans.get(l)) call.status[i + l] = code(Status::out_of_domain);
    }
  }
}

void evaluate(const BlockCall& call) {
  const auto& p = *static_cast<const SphereProbing*>(call.context);
  for (std::size_t r = 0; r < call.readings; ++r) {
    Axes axes(p, call, r, true);
    for (std::size_t i = 0; i < call.samples; i += width)
      store(deviation(axes.at(i)), call.measurands + r * measurands, i);
  }
}

} // namespace
} // namespace gumshoe::models::probing

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_sphere_probing_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_sphere_probing_){&gumshoe::models::probing::simulate,
                                                                       &gumshoe::models::probing::evaluate};
}
