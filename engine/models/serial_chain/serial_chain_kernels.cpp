/// Block loops of the serial chain, compiled once per instruction set. An axis whose command, errors and drive are the
/// same for all samples moves once per reading.
#include <algorithm>

#include "models/columns.h"
#include "models/serial_chain/serial_chain.h"

namespace gumshoe::models::serial_chain {
namespace {

constexpr std::size_t width = Lanes::size;

/// The chain at one reading, sample by sample.
class Samples {
public:
  Samples(const SerialChain& p, const BlockCall& call, std::size_t reading) : chain_(p) {
    const ModelCard& card = p.card->card();
    const Column* quantities = call.quantities + reading * card.quantities.size();
    const Column* conditions = call.conditions + reading * card.conditions.size();
    const std::size_t axes = p.machine.axes().size();
    std::vector<bool> varies(axes, false);
    for (std::size_t a = 0; a < axes; ++a) {
      chain_.commands[a] = detail::load<Lanes>(conditions[a], 0);
      if (conditions[a].stride == 0) continue;
      varying_commands_.emplace_back(a, conditions[a]);
      varies[a] = true;
    }
    payload_ = conditions[p.payload()];
    for (std::size_t j = 0; j < card.quantities.size(); ++j) {
      const Column& column = quantities[j];
      chain_.set(j, detail::load<Lanes>(column, 0));
      if (column.stride != 0) varying_.emplace_back(j, column);
      if (j < first_of_axes) continue;
      const auto& [axis, kind] = p.place_of[j - first_of_axes];
      if (column.stride != 0) varies[axis] = true;
      if (kind - chain::error_kinds == static_cast<int>(chain::drive_compliance))
        loaded_ = loaded_ || column.stride != 0 || column.data[0] != 0;
    }
    for (std::size_t a = 0; a < axes; ++a) {
      chain_.move(a);
      if (varies[a]) moving_.push_back(a);
    }
  }

  Vector3<Lanes> target(std::size_t i) {
    for (const auto& [j, column] : varying_) chain_.set(j, detail::load<Lanes>(column, i));
    for (const auto& [a, column] : varying_commands_) chain_.commands[a] = detail::load<Lanes>(column, i);
    chain_.payload = detail::load<Lanes>(payload_, i);
    for (const std::size_t a : moving_) chain_.move(a);
    return chain_.target(loaded_);
  }
  const Moving<Lanes>& chain() const { return chain_; }

private:
  using Varying = std::vector<std::pair<std::size_t, Column>>;
  Moving<Lanes> chain_;
  Varying varying_, varying_commands_;
  Column payload_;
  std::vector<std::size_t> moving_;
  bool loaded_ = false;
};

void store(const Lanes* values, std::size_t n, double* const* rows, std::size_t i) {
  for (std::size_t k = 0; k < n; ++k) values[k].store_unaligned(rows[k] + i);
}

void simulate(const BlockCall& call) {
  const auto& p = *static_cast<const SerialChain*>(call.context);
  for (std::size_t r = 0; r < call.readings; ++r) {
    Samples samples(p, call, r);
    for (std::size_t i = 0; i < call.samples; i += width) {
      const Vector3<Lanes> target = samples.target(i);
      Lanes read[3];
      indicate(p, samples.chain().in_instrument(target), read);
      store(read, p.indications(), call.simulated + r * p.indications(), i);
      const Lanes zero(0.0), truth[6] = {target.x, target.y, target.z, zero, zero, zero};
      store(truth, p.measurands(), call.measurands + r * p.measurands(), i);
    }
  }
}

void evaluate(const BlockCall& call) {
  const auto& p = *static_cast<const SerialChain*>(call.context);
  for (std::size_t r = 0; r < call.readings; ++r) {
    Samples samples(p, call, r);
    const Column* indications = call.indications + r * p.indications();
    for (std::size_t i = 0; i < call.samples; i += width) {
      const Vector3<Lanes> target = samples.target(i);
      Lanes read[3], out[6];
      for (std::size_t k = 0; k < p.indications(); ++k) read[k] = detail::load<Lanes>(indications[k], i);
      measure(p, samples.chain(), target, read, out);
      store(out, p.measurands(), call.measurands + r * p.measurands(), i);
    }
  }
}

} // namespace
} // namespace gumshoe::models::serial_chain

extern "C" {
extern const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_serial_chain_);
const gumshoe::models::Kernels GUMSHOE_KERNEL(gumshoe_serial_chain_){&gumshoe::models::serial_chain::simulate,
                                                                     &gumshoe::models::serial_chain::evaluate};
}
