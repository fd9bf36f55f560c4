#include "harness/files/hdf5_reader.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "harness/base/printable_text.h"
#include "harness/files/hdf5_storage.h"

namespace cleave {
namespace {

constexpr std::size_t kMostTextBytes = 1 << 16;  // a message of an object header holds no more

Hdf5Handle type_of_attribute(const Hdf5Handle& attribute) { return {H5Aget_type(attribute.id()), H5Tclose}; }

// Numbers whose every bit stands where the processor's have it, in either order of bytes; texts with an end and
// characters that there are.
bool is_ordinary(hid_t type) {
  if (H5Tget_class(type) == H5T_FLOAT)
    return H5Tequal(type, H5T_IEEE_F64LE) > 0 || H5Tequal(type, H5T_IEEE_F32LE) > 0 ||
           H5Tequal(type, H5T_IEEE_F64BE) > 0 || H5Tequal(type, H5T_IEEE_F32BE) > 0;
  if (H5Tget_class(type) == H5T_INTEGER)
    return H5Tget_precision(type) == 8 * H5Tget_size(type) && H5Tget_offset(type) == 0;
  if (H5Tget_class(type) == H5T_STRING) {
    const H5T_str_t padding = H5Tget_strpad(type);
    const H5T_cset_t characters = H5Tget_cset(type);
    return (padding == H5T_STR_NULLTERM || padding == H5T_STR_NULLPAD || padding == H5T_STR_SPACEPAD) &&
           (characters == H5T_CSET_ASCII || characters == H5T_CSET_UTF8);
  }
  return true;
}

std::string type_text(hid_t type) {
  const std::string bits =
      std::to_string(8 * H5Tget_size(type)) + (is_ordinary(type) ? "-bit " : "-bit unusual ");
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return bits + "float";
    case H5T_INTEGER:
      return bits + (H5Tget_sign(type) == H5T_SGN_NONE ? "unsigned integer" : "signed integer");
    case H5T_STRING:
      return is_ordinary(type) ? "text" : "unusual text";
    case H5T_REFERENCE:
      return "object reference";
    default:
      return "neither number nor text";
  }
}

bool matches(hid_t type, const Hdf5Element& element) {
  if (H5Tget_class(type) != element.type_class || H5Tget_size(type) != element.size) return false;
  if (!is_ordinary(type)) return false;
  return element.type_class != H5T_INTEGER || (H5Tget_sign(type) != H5T_SGN_NONE) == element.is_signed;
}

// Types that hold every value that the element asked for can have, or more; see the head of the header.
bool converts(hid_t type, const Hdf5Element& element) {
  const std::size_t size = H5Tget_size(type);
  if (H5Tget_class(type) != element.type_class || !is_ordinary(type)) return false;
  if (element.type_class == H5T_FLOAT) return size == 4 && element.size == 8;
  return H5Tget_sign(type) != H5T_SGN_NONE && (size == 4 || size == 8);
}

std::string allowed_types(const Hdf5Element& element) {
  std::string text = element.name;
  if (element.type_class == H5T_INTEGER)
    return text + (element.size == 4 ? "" : ", 32-bit signed integer") + ", 64-bit signed integer";
  return text + (element.size == 8 ? ", 32-bit float" : "");
}

herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : file_(path.string()) {
  silence_hdf5();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) fail("no such file");
  if (!std::filesystem::is_regular_file(path, error)) fail("is no file");
  size_ = std::filesystem::file_size(path, error);
  const htri_t is_hdf5 = H5Fis_hdf5(path.c_str());
  handle_ = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (handle_.valid()) return;
  fail(is_hdf5 > 0 ? "cannot be opened: the file is truncated or damaged" : "is not a readable HDF5 file");
}

void Hdf5Reader::fail(const std::string& text) const { throw std::invalid_argument(file_ + ": " + text); }

// What a link leads to may lie in another file, or nowhere.
bool Hdf5Reader::has(const std::string& name) const {
  if (H5Lexists(handle_.id(), name.c_str(), H5P_DEFAULT) <= 0) return false;
  H5L_info_t link;
  if (H5Lget_info(handle_.id(), name.c_str(), &link, H5P_DEFAULT) < 0)
    fail(full(name) + " cannot be opened: the file is damaged");
  if (link.type != H5L_TYPE_HARD)
    fail(full(name) + " = " + (link.type == H5L_TYPE_SOFT ? "soft link" : "external link") +
         ", allowed: a dataset or group in its place");
  return true;
}

bool Hdf5Reader::has_attribute(const std::string& name) const {
  return H5Aexists(handle_.id(), name.c_str()) > 0;
}

Hdf5Reader Hdf5Reader::group(const std::string& name) const {
  if (!has(name)) fail("group " + full(name) + " is missing");
  Hdf5Handle group(H5Gopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail(full(name) + " cannot be opened as a group");
  return {file_, full(name) + "/", std::move(group), size_};
}

std::vector<std::string> Hdf5Reader::names() const {
  std::vector<std::string> names;
  if (H5Literate(handle_.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_name, &names) < 0)
    fail((prefix_.empty() ? "contents" : prefix_) + " cannot be listed: the file is damaged");
  check_names(names);
  return names;
}

// They stand in lines of output.
void Hdf5Reader::check_names(const std::vector<std::string>& names) const {
  for (const std::string& name : names)
    if (!is_printable_utf8(name))
      fail("name in " + prefix_ + " = \"" + printable(name) +
           "\", allowed: printable UTF-8 text without control characters");
}

Hdf5Handle Hdf5Reader::open_dataset(const std::string& name) const {
  if (!has(name)) fail("dataset " + full(name) + " is missing");
  Hdf5Handle dataset(H5Dopen2(handle_.id(), name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) fail(full(name) + " cannot be opened as a dataset");
  const std::string error = find_storage_error(dataset, full(name), size_);
  if (!error.empty()) fail(error);
  return dataset;
}

Hdf5Shape Hdf5Reader::shape_of(const Hdf5Handle& dataset, const std::string& name) const {
  const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const int rank = space.valid() ? H5Sget_simple_extent_ndims(space.id()) : -1;
  if (rank < 0) fail("shape of " + full(name) + " cannot be read: the file is damaged");
  std::vector<hsize_t> extents(rank);
  H5Sget_simple_extent_dims(space.id(), extents.data(), nullptr);
  return Hdf5Shape(extents.begin(), extents.end());
}

std::size_t Hdf5Reader::length(const std::string& dataset) const {
  const Hdf5Shape shape = shape_of(open_dataset(dataset), dataset);
  if (shape.empty()) fail("shape of " + full(dataset) + " = (), allowed: an array");
  return shape.front();
}

Hdf5Handle Hdf5Reader::open_array(const std::string& name, const Hdf5Element& element,
                                  const Hdf5Shape& shape) const {
  Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (!matches(type.id(), element) && !converts(type.id(), element))
    fail("type of " + full(name) + " = " + type_text(type.id()) + ", allowed: " + allowed_types(element));
  const Hdf5Shape found = shape_of(dataset, name);
  if (found != shape)
    fail("shape of " + full(name) + " = " + hdf5_shape_text(found) + ", allowed: " + hdf5_shape_text(shape));
  return dataset;
}

void Hdf5Reader::read_array(const Hdf5Handle& dataset, const std::string& name, const Hdf5Element& element,
                            void* values, std::size_t count) const {
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (element.type_class == H5T_INTEGER && !matches(type.id(), element))
    return read_integers(dataset, name, element, values, count);
  if (H5Dread(dataset.id(), element.memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0)
    fail(full(name) + " cannot be read: the file is damaged");
}

// The library itself would cut off what does not fit.
void Hdf5Reader::read_integers(const Hdf5Handle& dataset, const std::string& name, const Hdf5Element& element,
                               void* values, std::size_t count) const {
  std::vector<long long> wide(count);
  if (H5Dread(dataset.id(), H5T_NATIVE_LLONG, H5S_ALL, H5S_ALL, H5P_DEFAULT, wide.data()) < 0)
    fail(full(name) + " cannot be read: the file is damaged");
  const int bits = static_cast<int>(8 * element.size) - (element.is_signed ? 1 : 0);
  const long long most = (1LL << bits) - 1, least = element.is_signed ? -most - 1 : 0;
  for (std::size_t i = 0; i < count; ++i)
    if (wide[i] < least || wide[i] > most)
      fail(full(name) + "[" + std::to_string(i) + "] = " + std::to_string(wide[i]) +
           ", allowed: " + std::to_string(least) + " to " + std::to_string(most));
  H5Tconvert(H5T_NATIVE_LLONG, element.memory(), count, wide.data(), nullptr, H5P_DEFAULT);
  std::memcpy(values, wide.data(), count * element.size);
}

Hdf5Handle Hdf5Reader::open_attribute(const std::string& name) const {
  if (!has_attribute(name)) fail("attribute " + full(name) + " is missing");
  Hdf5Handle attribute(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail("attribute " + full(name) + " cannot be opened: the file is damaged");
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (H5Sget_simple_extent_npoints(space.id()) != 1)
    fail("attribute " + full(name) + " is not a single value");
  return attribute;
}

void Hdf5Reader::read_attribute(const Hdf5Handle& attribute, const std::string& name, hid_t memory_type,
                                void* value) const {
  if (H5Aread(attribute.id(), memory_type, value) < 0)
    fail("attribute " + full(name) + " cannot be read: the file is damaged");
}

void Hdf5Reader::attribute(const std::string& name, std::string& value) const {
  const Hdf5Handle attribute = open_attribute(name);
  const Hdf5Handle type = type_of_attribute(attribute);
  if (H5Tget_class(type.id()) != H5T_STRING || !is_ordinary(type.id()))
    fail("type of attribute " + full(name) + " = " + type_text(type.id()) + ", allowed: text");
  if (H5Tis_variable_str(type.id()) > 0) {
    char* text = nullptr;
    read_attribute(attribute, name, type.id(), &text);
    value = text == nullptr ? "" : text;
    H5free_memory(text);
    return;
  }
  const std::size_t size = H5Tget_size(type.id());
  if (size > kMostTextBytes)
    fail("size of attribute " + full(name) + " = " + std::to_string(size) + ", allowed: 1 to " +
         std::to_string(kMostTextBytes));
  std::string text(size, '\0');
  read_attribute(attribute, name, type.id(), text.data());
  const H5T_str_t padding = H5Tget_strpad(type.id());
  if (padding == H5T_STR_NULLTERM) text.resize(std::min(text.find('\0'), size));
  text.erase(text.find_last_not_of(padding == H5T_STR_SPACEPAD ? ' ' : '\0') + 1);
  value = text;
}

void Hdf5Reader::attribute(const std::string& name, double& value) const {
  const Hdf5Handle attribute = open_attribute(name);
  const Hdf5Handle type = type_of_attribute(attribute);
  const H5T_class_t type_class = H5Tget_class(type.id());
  if ((type_class != H5T_FLOAT && type_class != H5T_INTEGER) || !is_ordinary(type.id()))
    fail("type of attribute " + full(name) + " = " + type_text(type.id()) + ", allowed: a number");
  read_attribute(attribute, name, H5T_NATIVE_DOUBLE, &value);
}

long long Hdf5Reader::integer(const std::string& name) const {
  const Hdf5Handle attribute = open_attribute(name);
  const Hdf5Handle type = type_of_attribute(attribute);
  if (H5Tget_class(type.id()) != H5T_INTEGER || !is_ordinary(type.id()))
    fail("type of attribute " + full(name) + " = " + type_text(type.id()) + ", allowed: an integer");
  long long value = 0;
  read_attribute(attribute, name, H5T_NATIVE_LLONG, &value);
  return value;
}

void Hdf5Reader::attribute(const std::string& name, int& value) const {
  const long long wide = integer(name);
  value = static_cast<int>(wide);
  if (value != wide)
    fail("attribute " + full(name) + " = " + std::to_string(wide) + ", allowed: 32-bit signed integers");
}

void Hdf5Reader::attribute(const std::string& name, bool& value) const {
  const long long wide = integer(name);
  if (wide != 0 && wide != 1)
    fail("attribute " + full(name) + " = " + std::to_string(wide) + ", allowed: 0 and 1");
  value = wide == 1;
}

void Hdf5Reader::attribute(const std::string& name, std::uint64_t& value) const {
  const long long low = integer(name);  // the upper half of the range reads as the largest signed number
  if (low < 0) fail("attribute " + full(name) + " = " + std::to_string(low) + ", allowed: >= 0");
  unsigned long long wide = 0;
  read_attribute(open_attribute(name), name, H5T_NATIVE_ULLONG, &wide);
  value = wide;
}

std::vector<std::string> Hdf5Reader::attribute_names() const {
  std::vector<std::string> names;
  if (H5Aiterate2(handle_.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_attribute, &names) < 0)
    fail("attributes of " + prefix_ + " cannot be listed: the file is damaged");
  check_names(names);
  return names;
}

Parameter::Kind Hdf5Reader::attribute_kind(const std::string& name) const {
  const Hdf5Handle type = type_of_attribute(open_attribute(name));
  switch (H5Tget_class(type.id())) {
    case H5T_FLOAT:
      return Parameter::Kind::number;
    case H5T_INTEGER:
      return H5Tget_size(type.id()) == 1 ? Parameter::Kind::flag : Parameter::Kind::integer;
    case H5T_STRING:
      return Parameter::Kind::word;
    default:
      fail("type of attribute " + full(name) + " = " + type_text(type.id()) + ", allowed: a number or text");
  }
}

std::string Hdf5Reader::attribute_text(const std::string& name) const {
  switch (attribute_kind(name)) {
    case Parameter::Kind::number: {
      double value = 0;
      attribute(name, value);
      return number_text(value);
    }
    case Parameter::Kind::flag: {
      bool value = false;
      attribute(name, value);
      return value ? "true" : "false";
    }
    case Parameter::Kind::integer:
      return std::to_string(integer(name));
    default: {
      std::string value;
      attribute(name, value);
      return value;
    }
  }
}

}  // namespace cleave
