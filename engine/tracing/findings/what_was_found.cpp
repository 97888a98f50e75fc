#include "tracing/findings/what_was_found.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "analysis/rounding.h"
#include "base/units.h"
#include "tracing/findings/findings.h"
#include "tracing/findings/sizes.h"
#include "tracing/findings/verdict_json.h"

namespace gumshoe::tracing {
namespace {

constexpr std::string_view declared = "declared:";
bool declares(const Finding& f) { return f.name.starts_with(declared); }

/// Sizes of one kind with the first, as those of a vector: the best known of many, in their order.
std::vector<const SizedQuantity*> sizes_told(const Finding& f) {
  constexpr std::size_t most = 3;
  std::vector<const SizedQuantity*> out;
  for (const SizedQuantity& q : f.quantities)
    if (q.si_unit == f.quantities[0].si_unit) out.push_back(&q);
  const auto times_u = [](const SizedQuantity* q) { return q->u > 0 ? std::fabs(q->value) / q->u : 0; };
  while (out.size() > most) out.erase(std::ranges::min_element(out, std::ranges::less{}, times_u));
  return out;
}

/// " (amplitude 1.5 um)", " (tilt_x 0.1 mrad, tilt_y -0.3 mrad)"; empty without a size
std::string size_of(const Finding& f) {
  if (f.quantities.empty()) return "";
  const SizedQuantity& q = f.quantities[0];
  if (!declares(f)) {
    std::vector<std::string> all;
    for (const SizedQuantity* one : sizes_told(f))
      all.push_back(fmt::format("{} {}", one->name, shown_size(one->value, one->unit, one->si_unit)));
    return fmt::format(" ({})", fmt::join(all, ", "));
  }
  const ShownSize s = shown(q); // to the digits that u leaves: it may differ little from what was declared
  return fmt::format(" ({} {}{})", q.name, analysis::fixed(s.value, analysis::decimals_for(s.u)),
                     units::suffix(s.unit));
}

/// "reading 27" of "step:time after reading 27", asked for as "step:" and " after "; empty of any other shape.
std::string reading_of(const std::string& shape, const std::string& kind, const std::string& where) {
  const auto at = shape.find(where);
  return shape.starts_with(kind) && at != std::string::npos ? shape.substr(at + where.size()) : "";
}
/// The reading after which the readings differ by a constant.
std::string instant_of(const std::string& shape) { return reading_of(shape, "step:", " after "); }
/// "tool T3" of "step:time with tool T3 after reading 27", which alone differs from then on; empty of any other shape.
std::string part_of_step(const std::string& shape) {
  const auto with = shape.find(" with "), after = shape.find(" after ");
  if (!shape.starts_with("step:") || with == std::string::npos || after == std::string::npos || after < with) return "";
  return shape.substr(with + 6, after - with - 6);
}
/// " with tool T3" and "from reading 13 to reading 30" of "while:time with tool T3 from reading 13 to reading 30";
/// empty of any other shape.
struct While {
  std::string with, readings;
};
While while_of(const std::string& shape) {
  const auto from = shape.find(" from reading ");
  if (!shape.starts_with("while:") || from == std::string::npos) return {};
  const auto with = std::min(from, shape.find(" with "));
  return {shape.substr(with, from - with), shape.substr(from + 1)};
}
/// " with tool T3" and "reading 27" of "bend:time with tool T3 after reading 27"; empty of any other shape.
struct Bend {
  std::string with, reading;
};
Bend bend_of(const std::string& shape) {
  const std::string reading = reading_of(shape, "bend:", " after ");
  const auto after = shape.find(" after "), with = std::min(after, shape.find(" with "));
  return reading.empty() ? Bend() : Bend{shape.substr(with, after - with), reading};
}
/// The reading about which something came and went.
std::string pulse_of(const std::string& shape) { return reading_of(shape, "pulse:", " about "); }
/// The reading about which they went over to other values.
std::string shift_of(const std::string& shape) { return reading_of(shape, "shift:", " about "); }

/// "tool T3", which alone changes with the first condition; empty of any other shape.
std::string part_alone(const Finding& f) {
  if (f.depends_on.size() != 2) return {};
  const std::string product = fmt::format("product:{}*{} ", f.depends_on[0], f.depends_on[1]);
  if (!f.described_by.starts_with(product)) return {};
  return f.depends_on[1] + " " + f.described_by.substr(product.size());
}

/// What may be there in place of scatter: the other members of its finding, if it has any. In place of that of single
/// readings these are sizes with which readings jump.
std::string in_its_place(const Finding& f) {
  if (f.members.size() < 2) return {};
  if (f.members[0] == "scatter:reading")
    return fmt::format("they jump with {}", fmt::join(f.members.begin() + 1, f.members.end(), " or "));
  const std::string &shape = f.members[1], on = shape.substr(shape.find(':') + 1);
  if (const std::string reading = instant_of(shape); !reading.empty()) return "something changed after " + reading;
  if (shape.starts_with("step:")) return on + " differs from the others, which agree";
  if (const auto [with, readings] = while_of(shape); !readings.empty())
    return fmt::format("something was different{} {}", with, readings);
  if (const auto [with, reading] = bend_of(shape); !reading.empty())
    return fmt::format("something changes steadily{} from {} on", with, reading);
  if (const std::string reading = pulse_of(shape); !reading.empty()) return "something came and went about " + reading;
  if (const std::string reading = shift_of(shape); !reading.empty()) return "something changed about " + reading;
  return shape == on ? on + " is there" : "the readings follow " + on;
}

/// "the declared value of reference_drift"; an effect by its name.
std::string told(const std::string& member) {
  return member.starts_with(declared) ? fmt::format("the declared value of {}", member.substr(declared.size()))
                                      : member;
}
std::string told(const std::vector<std::string>& members) {
  std::vector<std::string> all;
  for (const std::string& one : members) all.push_back(told(one));
  return fmt::format("{}", fmt::join(all, ", "));
}

/// The condition that acts late, in "lag:temp_degc"; empty of any other shape.
std::string late(const std::string& shape) {
  const std::string kind = "lag:";
  return shape.starts_with(kind) ? shape.substr(kind.size(), shape.find(' ') - kind.size()) : "";
}

/// Others that describe the readings as well as a shape does: what always went with it, and what did not.
struct Rivals {
  std::vector<std::string> never_apart; ///< "machine M2", "temp_degc": of the same sort as the shape
  std::vector<std::string> others;      ///< "a constant difference of machine M2", "an effect of time"
};

/// What a shape is of, "machine M2" or "time", and the same with what it does.
struct InWords {
  std::string on, told;
  bool group = false, of_one = true; ///< of a group of a label; of one condition or label alone
};
InWords in_words(const std::string& shape) {
  const std::string kind = shape.substr(0, shape.find(':')), rest = shape.substr(shape.find(':') + 1);
  if (kind == "step") {
    const std::string reading = instant_of(shape), part = part_of_step(shape);
    if (!part.empty()) return {part, fmt::format("a step of {} after {}", part, reading), false, false};
    if (!reading.empty()) return {reading, "a step after " + reading};
    return {rest, "a constant difference of " + rest, true};
  }
  if (const auto [with, readings] = while_of(shape); !readings.empty())
    return {readings, fmt::format("a difference{} {}", with, readings), false, with.empty()};
  if (const auto [with, reading] = bend_of(shape); !reading.empty())
    return {reading, fmt::format("a steady change{} from {} on", with, reading), false, with.empty()};
  if (const std::string condition = late(shape); !condition.empty())
    return {condition, "a delayed effect of " + condition, false, false};
  std::string on = rest.substr(0, rest.find_first_of("^ "));
  if (on.starts_with("1/")) on.erase(0, 2);
  return {on, "an effect of " + on, false, on.find('*') == std::string::npos};
}

/// Whether one shape is of the other's group alone, or of a part of it: "operator Ann, machine M1" and "machine M1".
bool overlap(const InWords& a, const InWords& b) {
  return a.group && b.group && (a.on.find(b.on) != std::string::npos || b.on.find(a.on) != std::string::npos);
}

Rivals rivals_in_words(const Finding& f) {
  Rivals out;
  const InWords own = in_words(f.described_by);
  const auto add = [](std::vector<std::string>& to, const std::string& one) {
    if (std::ranges::find(to, one) == to.end()) to.push_back(one);
  };
  std::vector<std::string> further;
  for (const RivalShape& rival : f.rivals) {
    const InWords one = in_words(rival.shape);
    if (overlap(one, own)) continue;
    if (rival.never_apart && one.of_one && one.group == own.group)
      add(out.never_apart, one.on);
    else
      add(one.of_one ? out.others : further, one.told);
  }
  if (out.others.empty()) out.others = std::move(further); // of parts for a while, say: only where nothing simpler is
  return out;
}

/// "operator Bob", or "operator Bob or machine M2, which are never apart in these data,". @param end after the names
std::string with_those_never_apart(const std::string& name, const Finding& f, const char* end) {
  const Rivals rivals = rivals_in_words(f);
  if (rivals.never_apart.empty()) return name;
  return fmt::format("{} or {}, which are never apart in these data{}", name, fmt::join(rivals.never_apart, " or "),
                     end);
}

/// A hysteresis without a condition that is the direction depends on one condition, and on from where it was reached.
std::string reversed_condition(const Finding& f) {
  const bool one = f.described_by.starts_with("hysteresis:") && f.depends_on.size() == 1;
  return one ? f.depends_on[0] : "";
}

} // namespace

std::string indication_of(const Trace& t, const Finding& f) {
  for (const IndicationError& e : t.of_indications)
    if (f.described_by.ends_with(" of " + e.name)) return e.name;
  return {};
}

namespace {

std::string found_alone(const Finding& f, const std::string& of) {
  const std::string readings = of.empty() ? "the readings" : "the readings of " + of;
  const std::string size = size_of(f);
  const auto depends_on = fmt::format("{}", fmt::join(f.depends_on, " and "));
  switch (f.kind) {
  case Kind::named:
    if (declares(f))
      return fmt::format("The readings contradict a value that {}: {}{}.",
                         f.by_default ? "the model takes where the scenario states none" : "the scenario declares",
                         f.name.substr(declared.size()), size);
    if (!f.implausible.empty())
      return fmt::format("A part of the error looks like {}{}, but this size is {}: likely an alias of another effect.",
                         f.name, size, f.implausible);
    return fmt::format("The model lacks an effect of the machine: {}{}{}.", f.name, size,
                       f.fits_better.empty() ? "" : ", or " + f.fits_better + ", which fits better");
  case Kind::equivalence_class:
    return fmt::format("The model lacks an effect of the machine. It is one of: {}. These data cannot "
                       "distinguish them.",
                       told(f.members));
  case Kind::scatter:
    return fmt::format("The readings scatter {}{}{}.",
                       f.depends_on == std::vector<std::string>{"reading"}
                           ? "more than declared"
                           : fmt::format("from one {} to the next more than within one", depends_on),
                       size,
                       f.members.size() < 2 ? "" : ", or " + in_its_place(f) + ": these data cannot distinguish them");
  case Kind::not_in_catalogue:
    if (f.described_by.starts_with("table:"))
      return fmt::format("A part of the error repeats that no effect of the catalogue explains; it depends on {}.",
                         depends_on);
    if (const std::string condition = reversed_condition(f); !condition.empty())
      return fmt::format(
          "The readings differ between rising and falling {}, and no effect of the catalogue explains it.", condition);
    if (const std::string part = part_of_step(f.described_by); !part.empty())
      return fmt::format("Something changed with {} after {}: from then on {} with it differ by a constant.", part,
                         instant_of(f.described_by), readings);
    if (const std::string reading = instant_of(f.described_by); !reading.empty())
      return fmt::format("Something changed after {}: from then on {} differ by a constant.", reading, readings);
    if (const auto [with, meanwhile] = while_of(f.described_by); !meanwhile.empty())
      return fmt::format("Something was different{} {}: meanwhile {}{} differ by a constant.", with, meanwhile,
                         readings, with.empty() ? "" : " with it");
    if (const auto [with, reading] = bend_of(f.described_by); !reading.empty())
      return fmt::format("Something changes steadily{} from {} on: after it {}{} follow a straight line against {}.",
                         with, reading, readings, with.empty() ? "" : " with it", f.depends_on[0]);
    if (const std::string pulse = pulse_of(f.described_by); !pulse.empty())
      return fmt::format("Something came and went about {}: for a while {} differ.", pulse, readings);
    if (const std::string reading = shift_of(f.described_by); !reading.empty())
      return fmt::format("Something changed about {}, not at once: after that {} differ by a constant.", reading,
                         readings);
    if (const std::string condition = late(f.described_by); !condition.empty())
      return fmt::format("An unknown effect makes {} follow {} with a delay.", readings, condition);
    if (const std::string part = part_alone(f); !part.empty())
      return fmt::format("An unknown effect changes the readings of {} alone with {}.", part, f.depends_on[0]);
    if (const std::string step = "step:";
        f.described_by.starts_with(step) && f.described_by.find(f.depends_on[0] + " ") != std::string::npos)
      return fmt::format("{} differs from the others by a constant.",
                         with_those_never_apart(f.described_by.substr(step.size()), f, ","));
    return fmt::format("An unknown effect changes {} {}with {}.", readings,
                       f.described_by.starts_with("wave:") ? "periodically " : "",
                       with_those_never_apart(depends_on, f, ""));
  }
  return {};
}

} // namespace

std::string what_was_found(const Finding& f, const std::string& of) {
  std::string out = found_alone(f, of);
  const Rivals rivals = rivals_in_words(f);
  if (!rivals.never_apart.empty() || rivals.others.empty()) return out;
  out.pop_back(); // the full stop
  return fmt::format("{}; these data cannot distinguish it from {}.", out, fmt::join(rivals.others, " or "));
}

namespace {

std::string briefly_alone(const Finding& f) {
  const auto depends_on = fmt::format("{}", fmt::join(f.depends_on, " and "));
  switch (f.kind) {
  case Kind::named:
    return told(f.name) + size_of(f);
  case Kind::equivalence_class:
    return fmt::format("one of {}", told(f.members));
  case Kind::scatter:
    return fmt::format("scatter from one {} to the next{}{}", depends_on, size_of(f),
                       f.members.size() < 2 ? "" : ", or " + in_its_place(f));
  case Kind::not_in_catalogue:
    if (const std::string condition = reversed_condition(f); !condition.empty())
      return "a difference between rising and falling " + condition;
    if (const std::string reading = instant_of(f.described_by); !reading.empty()) {
      const std::string part = part_of_step(f.described_by);
      return fmt::format("a step{} after {}", part.empty() ? "" : " of " + part, reading);
    }
    if (const auto [with, readings] = while_of(f.described_by); !readings.empty())
      return fmt::format("a difference{} {}", with, readings);
    if (const auto [with, reading] = bend_of(f.described_by); !reading.empty())
      return fmt::format("a steady change{} from {} on", with, reading);
    if (const std::string reading = pulse_of(f.described_by); !reading.empty()) return "a pulse about " + reading;
    if (const std::string reading = shift_of(f.described_by); !reading.empty())
      return "a gradual step about " + reading;
    if (const std::string condition = late(f.described_by); !condition.empty())
      return "a delayed effect of " + condition;
    if (const std::string part = part_alone(f); !part.empty())
      return fmt::format("an unknown effect of {} on {} alone", f.depends_on[0], part);
    return "an unknown effect of " + depends_on;
  }
  return {};
}

} // namespace

std::string briefly(const Finding& f) {
  const Rivals rivals = rivals_in_words(f);
  const auto& either = rivals.never_apart.empty() ? rivals.others : rivals.never_apart;
  return either.empty() ? briefly_alone(f) : fmt::format("{} (or {})", briefly_alone(f), fmt::join(either, " or "));
}

} // namespace gumshoe::tracing
