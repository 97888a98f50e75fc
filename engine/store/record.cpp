#include "store/record.h"

#include <algorithm>
#include <cstdlib>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/hash.h"
#include "base/memory.h"

namespace gumshoe::store {

namespace {

using Json = nlohmann::json;

constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";
/// The last bytes of the file: length and digest of the record's text in hexadecimal digits.
constexpr std::string_view mark = "\ngumshoe record ";
constexpr std::size_t foot = mark.size() + 16 + 1 + 16 + 1;
constexpr std::uint64_t longest = std::uint64_t{1} << 30;

Json to_json(const Record& r) {
  Json j{{"format_version", format_version}, {"complete", r.complete}, {"seed", r.identity.seed},
         {"samples", r.identity.samples},    {"rows", r.rows},         {"store_samples", r.identity.store_samples}};
  for (const auto& [name, member] : identity_texts) j[name] = r.identity.*member;
  for (const auto& [name, member] : shard_texts)
    if (!(r.identity.*member).empty()) j[name] = r.identity.*member;
  if (r.identity.study_values > 0) j["study_values"] = r.identity.study_values;
  j["places"] = Json::object();
  for (const auto& [name, span] : r.places) j["places"][name] = {span.offset, span.bytes};
  return j;
}

/// A number that the library would convert is none of ours: -1.5 has no value among whole numbers.
std::uint64_t whole(const Json& j) {
  if (!j.is_number_unsigned()) throw OutputError("the record at its end is damaged");
  return j.get<std::uint64_t>();
}

Record from_json(const Json& j) {
  Record r;
  r.complete = j.at("complete").get<bool>();
  r.identity.seed = whole(j.at("seed"));
  r.identity.samples = whole(j.at("samples"));
  r.identity.store_samples = j.at("store_samples").get<bool>();
  for (const Json& row : j.at("rows")) r.rows.emplace_back(row.at(0).get<std::string>(), whole(row.at(1)));
  for (const auto& [name, member] : identity_texts) j.at(name).get_to(r.identity.*member);
  for (const auto& [name, member] : shard_texts) r.identity.*member = j.value(name, "");
  if (j.contains("study_values")) r.identity.study_values = whole(j.at("study_values"));
  for (const auto& [name, span] : j.at("places").items()) r.places[name] = {whole(span.at(0)), whole(span.at(1))};
  return r;
}

std::string foot_of(std::uint64_t bytes, std::uint64_t digest) {
  return fmt::format("{}{:016x} {:016x}\n", mark, bytes, digest);
}

/// The record's text; `begin`: where it stands.
std::string text_of(const RawFile& file, std::uint64_t& begin) {
  const std::uint64_t size = file.size();
  std::string end(std::min<std::uint64_t>(size, foot), '\0');
  file.read(end.data(), end.size(), size - end.size());
  if (!end.starts_with(mark)) {
    std::string head(std::min<std::uint64_t>(size, 1u << 20), '\0');
    file.read(head.data(), head.size(), 0);
    if (head.find("gumshoe") == std::string::npos) throw NoResult("another program wrote it, or it is cut off");
    throw OutputError("its end is missing: it is truncated, changed by another program, or of another format version");
  }
  const std::uint64_t bytes = std::strtoull(end.substr(mark.size(), 16).c_str(), nullptr, 16);
  if (bytes >= std::min(longest, size - foot)) throw OutputError("the record at its end is damaged");
  begin = size - foot - bytes;
  std::string text(bytes, '\0');
  file.read(text.data(), bytes, begin);
  if (foot_of(bytes, digest64(text)) != end) throw OutputError("the record at its end is damaged");
  return text;
}

} // namespace

std::uint64_t digest_around(const RawFile& file, std::uint64_t bytes, const std::map<std::string, Span>& places) {
  std::vector<Span> left_out;
  for (const auto& [name, span] : places) left_out.push_back(span);
  std::ranges::sort(left_out, {}, &Span::offset);
  left_out.push_back({bytes, 0});
  constexpr std::uint64_t part = 1u << 20;
  std::string text;
  std::uint64_t at = 0, position = 0, sum = 0;
  for (const Span& span : left_out) {
    for (std::uint64_t end = span.offset; at < end; at += text.size()) {
      text.resize(std::min(part, end - at));
      file.read(text.data(), text.size(), at);
      sum += digest64(text, position);
      position += (text.size() + 7) / 8;
    }
    at = std::max(at, span.offset + span.bytes);
  }
  return sum;
}

void seal(const std::string& path, const Record& record) {
  const RawFile file(path, O_RDWR);
  const std::uint64_t bytes = file.size();
  Json j = to_json(record);
  j["digest"] = digest_around(file, bytes, record.places);
  const std::string text = j.dump(-1, ' ', false, Json::error_handler_t::replace);
  const std::string all = text + foot_of(text.size(), digest64(text));
  file.write(all.data(), all.size(), bytes);
}

Record read_record(const std::string& path) {
  const RawFile file(path, O_RDONLY);
  std::string start(std::min<std::uint64_t>(file.size(), hdf5_signature.size()), '\0');
  file.read(start.data(), start.size(), 0);
  if (start != hdf5_signature) throw NoResult("it is not an HDF5 file");
  std::uint64_t begin = 0;
  const std::string text = text_of(file, begin);
  require_memory((std::size_t{1} << 20) +
                 16 * text.size()); // the parser's values end the process as they are destroyed
  try {
    const Json j = Json::parse(text);
    if (j.at("format_version") != format_version) throw NoResult("it has another format version");
    Record record = from_json(j);
    for (const auto& [name, span] : record.places)
      if (span.offset > begin || span.bytes > begin - span.offset)
        throw OutputError("the record at its end is damaged");
    if (digest_around(file, begin, record.places) != whole(j.at("digest")))
      throw OutputError("it is damaged: its contents are not those that were written");
    return record;
  } catch (const Json::exception&) {
    throw OutputError("the record at its end is damaged");
  }
}

} // namespace gumshoe::store
