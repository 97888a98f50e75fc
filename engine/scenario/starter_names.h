#pragma once
/// Names that first scenarios make up from those of columns (`gumshoe new`).
#include <initializer_list>
#include <set>
#include <string>
#include <string_view>

namespace gumshoe::scenario {

/// A name that formulas and TOML take without quotes: "Spindle-Z [mm]" is spindle_z_mm, "e" is column_e.
std::string plain_name(const std::string& text);
/// What formulas mean by the name that a text would have, such as "a constant of formulas"; empty: nothing.
std::string_view meaning_in_formulas(const std::string& text);

/// The names of one scenario: each is one that plain_name() gives, and no two are equal.
class Names {
public:
  Names() = default;
  /// @param fixed names that the scenario has whatever its columns are called
  Names(std::initializer_list<std::string_view> fixed) : taken_(fixed.begin(), fixed.end()) {}

  /// Keeps a name from columns.
  void reserve(std::string_view name) { taken_.emplace(name); }
  /// A name made of this text, with a number behind it where the name is taken: x_2.
  std::string add(const std::string& text);

private:
  std::set<std::string> taken_;
};

} // namespace gumshoe::scenario
