#include "store/hdf5.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>

#include <fmt/format.h>
#include <hdf5_hl.h>

#include "base/error.h"
#include "base/memory.h"

namespace gumshoe::store::hdf5 {

std::recursive_mutex& library() {
  static std::recursive_mutex mutex;
  // At exit the library would try again to flush a file on a full disk, and fail loudly: our handles
  // have closed everything by then.
  static const bool quiet = [] {
    // Without memory for its first tables the library would read through a null pointer.
    require_memory(std::size_t{4} << 20);
    H5dont_atexit();
    H5open();
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    return true;
  }();
  (void)quiet;
  thread_local const bool quiet_here = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0; // a setting of each thread
  (void)quiet_here;
  return mutex;
}

std::string last_error() {
  std::string reason;
  const auto take_first = [](unsigned, const H5E_error2_t* entry, void* out) -> herr_t {
    auto& text = *static_cast<std::string*>(out);
    if (text.empty() && entry->desc) text = entry->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &reason);
  // "file write failed: time = ..., errno = 28, error message = 'No space left on device', buf = ..."
  const std::string mark = "error message = '";
  if (const auto at = reason.find(mark); at != std::string::npos) {
    reason = reason.substr(at + mark.size());
    reason = reason.substr(0, reason.find('\''));
  }
  return reason;
}

bool Handle::close() noexcept {
  const hid_t id = std::exchange(id_, H5I_INVALID_HID);
  return id < 0 || close_(id) >= 0;
}

Handle& Handle::operator=(Handle&& other) noexcept {
  close();
  id_ = std::exchange(other.id_, H5I_INVALID_HID);
  close_ = other.close_;
  return *this;
}

void require(herr_t result, const char* action) {
  if (result < 0) throw OutputError(std::string("cannot ") + action, last_error());
}

Handle own(hid_t id, Handle::Close close, const char* action) {
  if (id < 0) throw OutputError(std::string("cannot ") + action, last_error());
  return {id, close};
}

Handle open_group(hid_t parent, const std::string& name) {
  return own(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "open a group");
}

bool has(hid_t parent, const std::string& name) { return H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0; }

Handle create_group(hid_t parent, const std::string& name) {
  return own(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "create a group");
}

void link(hid_t parent, const std::string& name, const std::string& target) {
  require(H5Lcreate_soft(target.c_str(), parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), "link a group");
}

template <> hid_t memory_type<double>() { return H5T_NATIVE_DOUBLE; }
template <> hid_t memory_type<std::uint64_t>() { return H5T_NATIVE_UINT64; }
template <> hid_t memory_type<int>() { return H5T_NATIVE_INT; }
template <> hid_t memory_type<std::uint8_t>() { return H5T_NATIVE_UINT8; }
template <> hid_t file_type<double>() { return H5T_IEEE_F64LE; }
template <> hid_t file_type<std::uint64_t>() { return H5T_STD_U64LE; }
template <> hid_t file_type<int>() { return H5T_STD_I32LE; }
template <> hid_t file_type<std::uint8_t>() { return H5T_STD_U8LE; }

Handle text_type() {
  Handle type = own(H5Tcopy(H5T_C_S1), H5Tclose, "describe text");
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

namespace {
void write_raw(hid_t object, const std::string& name, hid_t type, hid_t memory, const void* data, hsize_t count) {
  if (H5Aexists(object, name.c_str()) > 0) require(H5Adelete(object, name.c_str()), "replace an attribute");
  const Handle space =
      own(count == 0 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose, "describe an attribute");
  const Handle attribute =
      own(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "create an attribute");
  require(H5Awrite(attribute, memory, data), "write an attribute");
}

Handle open_attribute(hid_t object, const std::string& name) {
  return own(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "read an attribute");
}
} // namespace

void write_attribute(hid_t object, const std::string& name, const std::string& text) {
  const char* data = text.c_str();
  const Handle type = text_type();
  write_raw(object, name, type, type, &data, 0);
}
void write_attribute(hid_t object, const std::string& name, double value) {
  write_raw(object, name, file_type<double>(), memory_type<double>(), &value, 0);
}
void write_attribute(hid_t object, const std::string& name, std::uint64_t value) {
  write_raw(object, name, file_type<std::uint64_t>(), memory_type<std::uint64_t>(), &value, 0);
}
void write_attribute(hid_t object, const std::string& name, int value) {
  write_raw(object, name, file_type<int>(), memory_type<int>(), &value, 0);
}
void write_attribute(hid_t object, const std::string& name, const std::vector<std::uint8_t>& values) {
  write_raw(object, name, file_type<std::uint8_t>(), memory_type<std::uint8_t>(), values.data(), values.size());
}

std::string read_text(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type = text_type();
  char* data = nullptr;
  require(H5Aread(attribute, type, &data), "read an attribute");
  std::string text = data ? data : "";
  H5free_memory(data);
  return text;
}

std::uint64_t read_integer(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  std::uint64_t value = 0;
  require(H5Aread(attribute, memory_type<std::uint64_t>(), &value), "read an attribute");
  return value;
}

double read_number(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  double value = 0;
  require(H5Aread(attribute, H5T_NATIVE_DOUBLE, &value), "read an attribute");
  return value;
}

namespace {
/// Values of a dataset. Its shape alone would have any number of them read: they must be in the file.
std::size_t stored_values(hid_t data, hid_t space) {
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  if (n < 0 || static_cast<hsize_t>(n) > H5Dget_storage_size(data))
    throw OutputError("cannot read a dataset", "its values are not in the file");
  return static_cast<std::size_t>(n);
}
} // namespace

std::vector<double> read_numbers(hid_t group, const std::string& name) {
  const Handle data = own(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open a dataset");
  const Handle space = own(H5Dget_space(data), H5Sclose, "open a dataset");
  std::vector<double> out(stored_values(data, space));
  require(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()), "read a dataset");
  return out;
}

std::vector<std::string> read_texts(hid_t group, const std::string& name) {
  const Handle data = own(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open a dataset");
  const Handle space = own(H5Dget_space(data), H5Sclose, "open a dataset");
  const Handle type = text_type();
  std::vector<char*> texts(stored_values(data, space));
  require(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), "read a dataset");
  std::vector<std::string> out;
  for (const char* text : texts) out.emplace_back(text ? text : "");
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, texts.data());
  return out;
}

Handle create_dataset(hid_t parent, const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                      const Units& units, const std::string& long_name, bool fill_nan) {
  const Handle plist = own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "describe a dataset");
  H5Pset_layout(plist, H5D_CONTIGUOUS);
  H5Pset_alloc_time(plist, H5D_ALLOC_TIME_EARLY);
  H5Pset_obj_track_times(plist, false); // same run, same bytes
  if (fill_nan) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    H5Pset_fill_value(plist, H5T_NATIVE_DOUBLE, &nan);
    H5Pset_fill_time(plist, H5D_FILL_TIME_ALLOC);
  } else if (H5Tget_class(type) != H5T_STRING) { // text needs its empty fill, or HDF5 refuses
    H5Pset_fill_time(plist, H5D_FILL_TIME_NEVER);
  }
  const Handle space =
      own(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose, "describe a dataset");
  Handle dataset = own(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, plist, H5P_DEFAULT), H5Dclose,
                       "allocate a dataset");
  write_attribute(dataset, units.note ? "units_note" : "units", units.text);
  write_attribute(dataset, "long_name", long_name);
  return dataset;
}

void write_texts(hid_t dataset, const std::vector<std::string>& texts) {
  std::vector<const char*> data;
  for (const std::string& text : texts) data.push_back(text.c_str());
  if (data.empty()) return;
  // HDF5 converts texts in a buffer of a megabyte, cleared for every dataset: files of many small tables spent their
  // time there. No text takes more than this in it.
  constexpr std::size_t of_a_text = 64, usual = std::size_t{1} << 20;
  const Handle transfer = own(H5Pcreate(H5P_DATASET_XFER), H5Pclose, "write text");
  require(H5Pset_buffer(transfer, std::min(usual, of_a_text * data.size()), nullptr, nullptr), "write text");
  require(H5Dwrite(dataset, text_type(), H5S_ALL, H5S_ALL, transfer, data.data()), "write text");
}

Scale create_dimension(hid_t parent, const std::string& name, hsize_t length) {
  const Handle plist = own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "describe a dimension");
  H5Pset_obj_track_times(plist, false);
  const Handle space = own(H5Screate_simple(1, &length, nullptr), H5Sclose, "describe a dimension");
  // Allocated late and never written: takes no room however long it is.
  Handle scale = own(H5Dcreate2(parent, name.c_str(), H5T_IEEE_F32BE, space, H5P_DEFAULT, plist, H5P_DEFAULT), H5Dclose,
                     "create a dimension");
  const std::string mark = fmt::format("This is a netCDF dimension but not a netCDF variable.{:10d}", length);
  make_scale(scale, mark);
  write_attribute(scale, "units", std::string("1"));
  write_attribute(scale, "long_name", "dimension " + name + ", without values");
  return {std::move(scale), name};
}

void make_scale(hid_t dataset, const std::string& name) {
  require(H5DSset_scale(dataset, name.c_str()), "make a dimension scale");
}

namespace {
void create_attribute(hid_t object, const char* name, hid_t type, hsize_t count, const void* values) {
  const Handle space = own(H5Screate_simple(1, &count, nullptr), H5Sclose, "describe a dimension");
  const Handle attribute =
      own(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "label a dimension");
  require(H5Awrite(attribute, type, values), "label a dimension");
}

hobj_ref_t reference_to(hid_t object) {
  hobj_ref_t reference = 0;
  require(H5Rcreate(&reference, object, ".", H5R_OBJECT, -1), "attach a dimension scale");
  return reference;
}
} // namespace

Scale::Scale(Handle scale, std::string name)
    : handle_(std::move(scale)), name_(std::move(name)), self_(reference_to(handle_)),
      exceptions_(std::uncaught_exceptions()) {}

Scale::~Scale() noexcept(false) {
  if (attached_.empty() || std::uncaught_exceptions() > exceptions_) return;
  const Handle type = own(H5Tcreate(H5T_COMPOUND, sizeof(Reference)), H5Tclose, "describe a dimension");
  require(H5Tinsert(type, "dataset", offsetof(Reference, dataset), H5T_STD_REF_OBJ), "describe a dimension");
  require(H5Tinsert(type, "dimension", offsetof(Reference, axis), H5T_NATIVE_INT), "describe a dimension");
  create_attribute(handle_, "REFERENCE_LIST", type, attached_.size(), attached_.data());
}

void attach(hid_t dataset, const std::vector<const Scale*>& axes) {
  const hobj_ref_t self = reference_to(dataset);
  std::vector<hvl_t> scales;
  std::vector<const char*> labels;
  for (const Scale* axis : axes) {
    scales.push_back({1, const_cast<hobj_ref_t*>(&axis->self_)});
    labels.push_back(axis->name_.c_str());
    axis->attached_.push_back({self, static_cast<int>(labels.size()) - 1});
  }
  const Handle list = own(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose, "describe a dimension");
  create_attribute(dataset, "DIMENSION_LIST", list, axes.size(), scales.data());
  const Handle text = own(H5Tcopy(H5T_C_S1), H5Tclose, "describe text");
  H5Tset_size(text, H5T_VARIABLE);
  create_attribute(dataset, "DIMENSION_LABELS", text, axes.size(), labels.data());
}

} // namespace gumshoe::store::hdf5
