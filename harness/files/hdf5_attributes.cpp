// Attributes of what Hdf5Reader reads.
#include <algorithm>

#include "harness/files/hdf5_reader.h"

namespace cleave {
namespace {

constexpr std::size_t kMostTextBytes = 1 << 16;  // a message of an object header holds no more

Hdf5Handle type_of_attribute(const Hdf5Handle& attribute) { return {H5Aget_type(attribute.id()), H5Tclose}; }

herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

}  // namespace

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
