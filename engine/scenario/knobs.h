#pragma once
/// What of a scenario a setting can fix, by name, and the values it can take.
#include "scenario/choose.h"

namespace gumshoe::scenario {

class KnobReader {
public:
  KnobReader(const ChooseScope& scope, Problems& problems);
  /// "readings", "evaluation", a condition or a quantity ("effect.quantity"); nullopt and a problem if there is none of
  /// that name, or if it has no single value: listed, spread, stated per label.
  std::optional<Knob> find(const Member& key, const std::string& path, bool quantities_only);
  /// As Setting::value; nullopt and a problem if it is none, or lies outside a limit of the card.
  std::optional<double> value(const Node& node, const std::string& path, const Knob& knob);
  /// Names, by position in the model's card.
  const std::vector<std::string>& evaluations() const { return evaluations_; }

private:
  const QuantityCard* card_of(const Knob& knob) const;
  const ChooseScope& scope_;
  Problems& problems_;
  std::vector<std::string> evaluations_;
};

} // namespace gumshoe::scenario
