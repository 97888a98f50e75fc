/// What stands in a result, a trace or a history, where it is not what this program would have written: data sets that
/// are missing, of another type or of another length. A file of arbitrary bytes does not come so far: its digest
/// refuses it before HDF5 looks at it. So the input is a list of changes to a sound file, which is then sealed again:
///
///     result | trace | history         the file that is changed
///     delete PATH                      a data set or group
///     numbers PATH 1 2.5 nan           replaces it by numbers
///     texts PATH a b c                 replaces it by texts
///     group PATH                       replaces it by an empty group
///     drop OBJECT NAME                 an attribute
///     number OBJECT NAME 1             an attribute
///     text OBJECT NAME a               an attribute
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "base/error.h"
#include "fuzz/harness.h"
#include "made/full_results.h"
#include "made/traces.h"
#include "store/draft.h"
#include "store/hdf5.h"
#include "store/history_file.h"
#include "store/identity.h"
#include "store/record.h"
#include "store/stored_results.h"
#include "store/stored_samples.h"

namespace gumshoe::fuzz {
namespace {

namespace hdf5 = store::hdf5;
using Words = std::vector<std::string>;

std::string made_result() {
  const std::string path = folder() + "/made_result.h5";
  made::write_full_result(path);
  return path;
}

std::string made_trace() {
  const std::string path = folder() + "/made_trace.h5";
  made::write_trace("two_findings", path);
  return path;
}

std::string made_history() {
  const std::string path = folder() + "/made_history.h5";
  tracing::Score one{"scale", 0, {{"scale.size", "um/m", "1"}}, tracing::Vector::Ones(1), tracing::Matrix::Ones(1, 1)};
  tracing::Score two{"rod_runout",
                     1,
                     {{"rod_runout.x", "um", "m"}, {"rod_runout.y", "um", "m"}},
                     tracing::Vector::Ones(2),
                     tracing::Matrix::Identity(2, 2)};
  const tracing::Campaign campaign{"0123", "a title", "2026-02-03", 12, 10.5, 9, {one, two}};
  const store::Claim claim(path);
  store::Draft draft;
  store::write_history(draft, claim, {campaign, campaign}, {});
  draft.publish();
  return path;
}

void remove(hid_t file, const std::string& path) {
  if (hdf5::has(file, path)) H5Ldelete(file, path.c_str(), H5P_DEFAULT);
}

void write_numbers(hid_t file, const std::string& path, const Words& words) {
  std::vector<double> values;
  for (std::size_t i = 2; i < words.size(); ++i) values.push_back(std::strtod(words[i].c_str(), nullptr));
  remove(file, path);
  const auto data = hdf5::create_dataset(file, path, hdf5::file_type<double>(), {values.size()}, "1", "");
  if (!values.empty()) H5Dwrite(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void write_texts(hid_t file, const std::string& path, const Words& words) {
  remove(file, path);
  const auto type = hdf5::text_type();
  const auto data = hdf5::create_dataset(file, path, type, {words.size() - 2}, "1", "");
  hdf5::write_texts(data, {words.begin() + 2, words.end()});
}

/// One line of the input.
void change(hid_t file, const Words& words) try {
  if (words.size() < 2) return;
  const std::string &verb = words[0], &path = words[1];
  if (verb == "delete") return remove(file, path);
  if (verb == "numbers") return write_numbers(file, path, words);
  if (verb == "texts") return write_texts(file, path, words);
  if (verb == "group") {
    remove(file, path);
    hdf5::create_group(file, path);
    return;
  }
  if (words.size() < 3) return;
  const auto object = hdf5::own(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "open");
  if (verb == "drop") H5Adelete(object, words[2].c_str());
  if (words.size() < 4) return;
  if (verb == "number") hdf5::write_attribute(object, words[2], std::strtod(words[3].c_str(), nullptr));
  if (verb == "text") hdf5::write_attribute(object, words[2], words[3]);
} catch (const OutputError&) { // no such change can be made
}

void change_all(const std::string& path, std::istream& lines) {
  const std::lock_guard lock(hdf5::library());
  const store::Record record = store::read_record(path);
  hdf5::Handle file = store::open_file(path, H5F_ACC_RDWR);
  for (std::string line; std::getline(lines, line);) {
    if (line.find('\0') != std::string::npos) continue; // ends a name for HDF5, but not for us
    std::istringstream in(line);
    Words words;
    for (std::string word; in >> word;) words.push_back(word);
    change(file, words);
  }
  store::close_file(file);
  store::seal(path, record);
}

/// A refusal of one part says nothing of the next.
template <class Read> void attempt(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

} // namespace

void result_contents(std::string_view input) {
  static const std::string sound_result = made_result(), sound_trace = made_trace(), sound_history = made_history();
  std::istringstream lines{std::string(input)};
  std::string kind;
  std::getline(lines, kind);
  const std::string path = folder() + "/changed.h5";
  const std::string& sound = kind == "trace" ? sound_trace : kind == "history" ? sound_history : sound_result;
  std::filesystem::copy_file(sound, path, std::filesystem::copy_options::overwrite_existing);
  change_all(path, lines);
  attempt([&] { store::read_identity(path); });
  attempt([&] { store::require_sound_samples(path); });
  attempt([&] { store::read_results(path); });
  attempt([&] { store::read_trace(path); });
  attempt([&] { store::StoredSamples(path, made::outputs()).read_stopping(); });
  attempt([&] { store::read_history(path); });
}

} // namespace gumshoe::fuzz
