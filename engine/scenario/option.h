#pragma once
/// Options of a section, described once: a table of rows (key, member of the section's struct, limits, meaning) from
/// which follow reading with located problems, `gumshoe check --explain` and the JSON Schema. Defaults are those of the
/// struct.
#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scenario/reader.h"
#include "scenario/shape.h"

namespace gumshoe::scenario {

template <class Section> struct Option : Key {
  /// Reads the key into the section where it is present; null for a key that its section reads by hand.
  std::function<void(Table&, Section&)> read = {};
  /// The value as `check --explain` prints it; null where a sentence of its own does.
  std::function<std::string(const Section&)> shown = {};
  std::string remedy = {}; ///< where a required key is missing

  Option needed(std::string what_to_do = {}) && {
    required = true;
    remedy = std::move(what_to_do);
    return std::move(*this);
  }
};

template <class Section> using Options = std::vector<Option<Section>>;

template <class Section> std::vector<Key> keys_of(const Options<Section>& options) {
  return {options.begin(), options.end()};
}

template <class Section> Shape table_shape(const Options<Section>& options, const std::string& more = {}) {
  return shape::table(keys_of(options), more);
}

/// Reads every option that has a reader, and reports required ones that are missing. The keys read by hand are asked
/// for by the caller, before Table::refuse_unknown().
template <class Section> void read_options(Table& table, const Options<Section>& options, Section& section) {
  table.declare(keys_of(options));
  for (const Option<Section>& o : options) {
    if (o.required) table.require(o.name, o.remedy);
    if (o.read) o.read(table, section);
  }
}

/// "samples 1000000, seed 1": every option that has a value to show.
template <class Section> std::string explained(const Options<Section>& options, const Section& section) {
  std::string out;
  for (const Option<Section>& o : options)
    if (o.shown) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", o.name, o.shown(section));
  return out;
}

/// "sobol 4096, second order": the options that are not at their default; "none" if all are.
template <class Section> std::string explained_changes(const Options<Section>& options, const Section& section) {
  std::string out;
  for (const Option<Section>& o : options) {
    if (!o.shown || o.shown(section) == o.shown(Section{})) continue;
    std::string words = o.name;
    std::ranges::replace(words, '_', ' ');
    out += (out.empty() ? "" : ", ") + (o.shown(section) == "true" ? words : o.name + ' ' + o.shown(section));
  }
  return out.empty() ? "none" : out;
}

namespace option {

/// The largest number of samples, and the largest seed, that a scenario may ask for.
inline constexpr std::int64_t largest_whole = std::int64_t{1} << 40;

/// A key that its section reads itself.
template <class Section> Option<Section> by_hand(Key key) { return {std::move(key)}; }
template <class Section> Option<Section> by_hand(std::string key, Shape shape, std::string meaning) {
  return {{std::move(key), std::move(shape), std::move(meaning)}};
}

template <class Section, class T>
Option<Section> whole(const std::string& key, T Section::*member, std::int64_t low, std::int64_t high,
                      std::string meaning) {
  return {{key, shape::whole(low, high), std::move(meaning), false, fmt::format("{}", Section{}.*member)},
          [=](Table& t, Section& s) {
            if (const auto n = t.integer(key, low, high)) s.*member = static_cast<T>(*n);
          },
          [=](const Section& s) { return fmt::format("{}", s.*member); }};
}

/// A number from 0 to 1; `open` excludes the ends.
template <class Section>
Option<Section> share(const std::string& key, double Section::*member, bool open, std::string meaning) {
  const std::string usual = fmt::format("{}", Section{}.*member);
  return {{key, shape::interval(0, 1, open), std::move(meaning), false, usual},
          [=](Table& t, Section& s) {
            const auto x = t.number(key);
            if (!x) return;
            s.*member = *x;
            if (open ? !(*x > 0 && *x < 1) : !(*x >= 0 && *x <= 1))
              t.refuse_key(key, fmt::format("{} must lie between 0 and 1", *x), "", fmt::format("{} = {}", key, usual));
          },
          [=](const Section& s) { return fmt::format("{}", s.*member); }};
}

/// An option without a default that a getter of the table reads.
template <class Section, class T, class Get>
Option<Section> got(const std::string& key, T Section::*member, Shape shape, std::string meaning, const Get& get) {
  return {{key, std::move(shape), std::move(meaning)}, [=](Table& t, Section& s) {
            if (const auto x = get(t)) s.*member = *x;
          }};
}

template <class Section> Option<Section> number(const std::string& key, double Section::*member, std::string meaning) {
  return got(key, member, shape::number(), std::move(meaning), [=](Table& t) { return t.number(key); });
}

template <class Section>
Option<Section> positive(const std::string& key, double Section::*member, std::string meaning) {
  return got(key, member, shape::reference("positive"), std::move(meaning), [=](Table& t) { return t.positive(key); });
}

/// A number with a unit; `T` is double or an optional of it.
template <class Section, class T>
Option<Section> measure(const std::string& key, T Section::*member, const Dimension& dimension, std::string meaning) {
  return got(key, member, shape::reference("measure"), std::move(meaning),
             [=](Table& t) { return t.measure(key, dimension); });
}

/// A number with a unit, above 0.
template <class Section, class T>
Option<Section> width(const std::string& key, T Section::*member, const std::string& si_unit, std::string meaning) {
  return got(key, member, shape::reference("width"), std::move(meaning),
             [=](Table& t) { return t.width(key, si_unit); });
}

template <class Section>
Option<Section> text(const std::string& key, std::string Section::*member, std::string meaning) {
  return got(key, member, shape::text(), std::move(meaning), [=](Table& t) { return t.text(key); });
}

template <class Section> Option<Section> flag(const std::string& key, bool Section::*member, std::string meaning) {
  return {{key, shape::flag(), std::move(meaning), false, fmt::format("{}", Section{}.*member)},
          [=](Table& t, Section& s) { s.*member = t.boolean(key).value_or(s.*member); },
          [=](const Section& s) { return fmt::format("{}", s.*member); }};
}

/// One of several words, each with the value it stands for.
template <class Section, class T>
Option<Section> word(const std::string& key, T Section::*member,
                     std::vector<std::pair<std::string, std::type_identity_t<T>>> meant, std::string meaning) {
  std::vector<std::string> words;
  for (const auto& [w, value] : meant) words.push_back(w);
  const auto shown = [=](const Section& s) {
    for (const auto& [w, value] : meant)
      if (value == s.*member) return w;
    return std::string();
  };
  const std::string usual = shown(Section{});
  return {{key, shape::words(words), std::move(meaning), false, usual.empty() ? usual : shape::json_string(usual)},
          [=](Table& t, Section& s) {
            if (const auto i = t.choice(key, words)) s.*member = meant[*i].second;
          },
          shown};
}

/// One of several values, each written as name() says.
template <class Section, class T>
Option<Section> word(const std::string& key, T Section::*member, const std::vector<T>& values, std::string meaning) {
  std::vector<std::pair<std::string, T>> meant;
  for (const T& value : values) meant.emplace_back(name(value), value);
  return word(key, member, std::move(meant), std::move(meaning));
}

/// A text or a list of texts.
template <class Section>
Option<Section> texts(const std::string& key, std::vector<std::string> Section::*member, const std::string& more,
                      std::string meaning) {
  return {{key, shape::texts(more), std::move(meaning)}, [=](Table& t, Section& s) { s.*member = t.texts(key); }};
}

/// Where a number comes from: a text or a table, kept as text.
template <class Section> Option<Section> source(std::string Section::*member) {
  return {{"source", shape::reference("source")}, [=](Table& t, Section& s) { s.*member = t.rendered("source"); }};
}

} // namespace option
} // namespace gumshoe::scenario
