#include "harness/files/hdf5_types.h"

namespace cleave {

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

}  // namespace cleave
