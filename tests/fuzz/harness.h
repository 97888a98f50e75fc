#pragma once
/// Harnesses: each gives the bytes of one input to one reader of the engine. The reader may accept or refuse them; it
/// may not crash, hang, take memory without bound, or throw anything but an InputError.
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gumshoe::fuzz {

/// Throws InputError where the reader refuses the input, which is fine; everything else that leaves it is a fault.
using Harness = void (*)(std::string_view input);

void csv(std::string_view input);
void formula(std::string_view input);
void log_form(std::string_view input);
void unit(std::string_view input);
void scenario(std::string_view input);
void result_record(std::string_view input);
void result_contents(std::string_view input);

struct Row {
  const char* name; ///< also that of its corpus
  Harness harness;
};
inline constexpr Row harnesses[] = {{"csv", csv},
                                    {"formula", formula},
                                    {"log_form", log_form},
                                    {"unit", unit},
                                    {"scenario", scenario},
                                    {"result_record", result_record},
                                    {"result_contents", result_contents}};

/// Gives one input to a harness. Swallows an InputError whose problems all say what is wrong; throws std::logic_error
/// for one that does not, and lets everything else pass.
void feed(Harness harness, std::string_view input);

/// Throws std::logic_error: a promise of the reader is broken.
void require(bool holds, const char* promise);

/// The parts of an input that stands for several files. Each part after the first follows a line `==== NAME`; the first
/// one has no name.
std::vector<std::pair<std::string, std::string>> parts(std::string_view input);

/// A folder of this process for files of inputs, below TMPDIR; removed at exit.
const std::string& folder();
/// Writes a file there; returns its path.
std::string write(const std::string& name, std::string_view bytes);

} // namespace gumshoe::fuzz
