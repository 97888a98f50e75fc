#pragma once
/// HDF5 handles that close themselves, and the few kinds of object our files are made of. Private to
/// this folder, which is the only door to HDF5.
///
/// Every failure is an OutputError whose reason is HDF5's innermost message ("No space left on
/// device"). The library is not thread-safe: callers hold `library()` while they use it.
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <hdf5.h>

namespace gumshoe::store::hdf5 {

/// One lock for the whole library; the first call also silences its error printing.
std::recursive_mutex& library();

/// What the library last complained about, innermost message first; the system's words if it has them.
std::string last_error();

/// Owns an identifier. Closing never throws; close() tells whether it worked.
class Handle {
public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close closer) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept;
  ~Handle() { close(); }
  operator hid_t() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }
  bool close() noexcept;

private:
  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Throws OutputError("cannot <action>") with the library's reason if `result` is negative.
void require(herr_t result, const char* action);
Handle own(hid_t id, Handle::Close close, const char* action);

Handle open_group(hid_t parent, const std::string& name);
Handle create_group(hid_t parent, const std::string& name);
/// A name in `parent` for what stands at the absolute path `target`.
void link(hid_t parent, const std::string& name, const std::string& target);
bool has(hid_t parent, const std::string& name);

/// HDF5's native type of a C++ number, and the portable little-endian one it is stored as.
template <class T> hid_t memory_type();
template <class T> hid_t file_type();
/// UTF-8 text of variable length.
Handle text_type();

void write_attribute(hid_t object, const std::string& name, const std::string& text);
void write_attribute(hid_t object, const std::string& name, double value);
void write_attribute(hid_t object, const std::string& name, std::uint64_t value);
void write_attribute(hid_t object, const std::string& name, int value);
void write_attribute(hid_t object, const std::string& name, const std::vector<std::uint8_t>& values);

/// Only for files whose record is sound: attributes are as we wrote them. Throw OutputError if one is missing.
std::string read_text(hid_t object, const std::string& name);
std::uint64_t read_integer(hid_t object, const std::string& name);
double read_number(hid_t object, const std::string& name);
/// A dataset's values, and those of one of texts.
std::vector<double> read_numbers(hid_t group, const std::string& name);
std::vector<std::string> read_texts(hid_t group, const std::string& name);

/// The unit of a dataset's numbers, or, where they have none in common, a note that says which they have. Programs
/// parse the attribute `units`, so a note stands in `units_note`.
struct Units {
  std::string text;
  bool note = false;
  Units(std::string unit) : text(std::move(unit)) {}
  Units(const char* unit) : text(unit) {}
  Units(std::string_view text_, bool is_note) : text(text_), note(is_note) {}
};

/// A contiguous dataset, allocated at once, with `units` or `units_note`, and `long_name`. Nothing is written to it,
/// not even a fill value, unless `fill_nan`.
Handle create_dataset(hid_t parent, const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                      const Units& units, const std::string& long_name, bool fill_nan = false);
void write_texts(hid_t dataset, const std::vector<std::string>& texts);

/// Turns a dataset into the scale of the dimension it is named after.
void make_scale(hid_t dataset, const std::string& name);

/// The scale of a dimension, and what is attached to it: recorded in it all at once when this ends, where HDF5's own
/// function would read and write the record anew for each. Its end throws OutputError if that fails.
class Scale {
public:
  Scale() = default;
  Scale(Handle scale, std::string name);
  Scale(Scale&&) = default;
  Scale& operator=(Scale&&) = default;
  ~Scale() noexcept(false);
  operator hid_t() const { return handle_; }

private:
  friend void attach(hid_t dataset, const std::vector<const Scale*>& axes);
  struct Reference { // as the dimension scales' specification has it
    hobj_ref_t dataset = 0;
    int axis = 0;
    int padding = 0; // written, too
  };
  Handle handle_;
  std::string name_;
  hobj_ref_t self_ = 0;
  int exceptions_ = 0; ///< under way when this began: it may be written while one is
  mutable std::vector<Reference> attached_;
};

/// A named dimension without values of its own, as netCDF-4 writes it.
Scale create_dimension(hid_t parent, const std::string& name, hsize_t length);
/// Names the axes of a dataset and attaches the scales to them, one for each. The scales outlive the dataset's handle.
void attach(hid_t dataset, const std::vector<const Scale*>& axes);

} // namespace gumshoe::store::hdf5
