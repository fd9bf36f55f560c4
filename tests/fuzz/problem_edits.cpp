#include "tests/fuzz/problem_edits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/fuzz/hdf5_array.h"

namespace cleave::fuzz {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNumbers[] = {
    0,      -0.0,  1,   -1,  2,  3,  1e-320, 1e308, -1e308,     kInfinity,     -kInfinity,   NAN,
    0.5,    1e-9,  255, 256, -2, 5,  6,      1e16,  2147483647, -2147483648.0, 4294967296.0, 9.3e18,
    1e-160, 1e160, 7,   8,   4,  0.1};
constexpr hsize_t kExtents[] = {0,        1,         2,         3,          4,          6,
                                9,        12,        18,        36,         7,          100,
                                59652323, 178956970, 178956971, 2147483648, 1ull << 40, 1ull << 62};

// What there is to edit: datasets and groups, and the attributes of some object.
herr_t collect_link(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}
herr_t collect_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->push_back(name);
  return 0;
}

std::string draw_link(Recipe& recipe, hid_t file) {
  std::vector<std::string> names;
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, collect_link, &names);
  return names.empty() ? "none" : recipe.one_of(std::span<const std::string>(names));
}

struct AttributePlace {
  std::string object, name;
};

// Of the file itself in every other draw: most are there.
AttributePlace draw_attribute(Recipe& recipe, hid_t file) {
  AttributePlace place{recipe.choice(2) == 0 ? "/" : draw_link(recipe, file), "none"};
  std::vector<std::string> names;
  const Hdf5Handle object(H5Oopen(file, place.object.c_str(), H5P_DEFAULT), H5Oclose);
  if (object.valid())
    H5Aiterate2(object.id(), H5_INDEX_NAME, H5_ITER_INC, nullptr, collect_attribute, &names);
  if (!names.empty()) place.name = recipe.one_of(std::span<const std::string>(names));
  return place;
}

void write_attribute(hid_t file, const AttributePlace& place, hid_t type, hid_t space, const void* value) {
  H5Adelete_by_name(file, place.object.c_str(), place.name.c_str(), H5P_DEFAULT);
  const Hdf5Handle attribute(H5Acreate_by_name(file, place.object.c_str(), place.name.c_str(), type, space,
                                               H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  if (attribute.valid() && value != nullptr) H5Awrite(attribute.id(), type, value);
}

void remove_link(Recipe& recipe, hid_t file) {
  H5Ldelete(file, draw_link(recipe, file).c_str(), H5P_DEFAULT);
}

void remove_attribute(Recipe& recipe, hid_t file) {
  const AttributePlace place = draw_attribute(recipe, file);
  H5Adelete_by_name(file, place.object.c_str(), place.name.c_str(), H5P_DEFAULT);
}

// Some entries of an array.
void change_values(Recipe& recipe, hid_t file) {
  const std::string name = draw_link(recipe, file);
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset.valid()) return;
  Array array = read_array(file, name);
  for (std::size_t edits = 1 + recipe.choice(4); edits > 0 && !array.values.empty(); --edits) {
    const std::size_t place = recipe.choice(array.values.size());
    array.values[place] = recipe.one_of(std::span<const double>(kNumbers));
  }
  H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data());
}

// The same numbers as another type, or stored in another way.
void change_type(Recipe& recipe, hid_t file) {
  const std::string name = draw_link(recipe, file);
  const Array array = read_array(file, name);
  const Hdf5Handle type = draw_type(recipe), storage = draw_storage(recipe, array.extents);
  replace_array(file, name, array, type.id(), storage.id());
}

void change_shape(Recipe& recipe, hid_t file) {
  const std::string name = draw_link(recipe, file);
  Array array = read_array(file, name);
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (!type.valid()) return;
  const std::size_t axis = recipe.choice(array.extents.size() + 2);
  if (axis < array.extents.size()) {
    array.extents[axis] = recipe.one_of(std::span<const hsize_t>(kExtents));
  } else if (axis == array.extents.size()) {
    array.extents.push_back(recipe.one_of(std::span<const hsize_t>(kExtents)));
  } else if (!array.extents.empty()) {
    array.extents.pop_back();
  }
  const Hdf5Handle storage = draw_storage(recipe, array.extents);
  replace_array(file, name, array, type.id(), storage.id());
}

void change_attribute_number(Recipe& recipe, hid_t file) {
  const AttributePlace place = draw_attribute(recipe, file);
  const double value = recipe.one_of(std::span<const double>(kNumbers));
  const Hdf5Handle type = draw_type(recipe), scalar(H5Screate(H5S_SCALAR), H5Sclose);
  std::array<char, 64> bytes{};
  const H5T_class_t kind = H5Tget_class(type.id());
  const bool is_number = kind == H5T_FLOAT || kind == H5T_INTEGER;
  if (is_number) std::copy_n(reinterpret_cast<const char*>(&value), sizeof value, bytes.data());
  if (is_number) H5Tconvert(H5T_NATIVE_DOUBLE, type.id(), 1, bytes.data(), nullptr, H5P_DEFAULT);
  write_attribute(file, place, type.id(), scalar.id(), is_number ? bytes.data() : nullptr);
}

void change_attribute_text(Recipe& recipe, hid_t file) {
  const AttributePlace place = draw_attribute(recipe, file);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), scalar(H5Screate(H5S_SCALAR), H5Sclose);
  const std::size_t form = recipe.choice(4);
  std::string text = recipe.text();
  if (form == 0) {
    H5Tset_size(type.id(), H5T_VARIABLE);
    const char* pointer = text.c_str();
    return write_attribute(file, place, type.id(), scalar.id(), &pointer);
  }
  text.resize(std::max<std::size_t>(1, text.size()));
  H5Tset_size(type.id(), text.size());
  H5Tset_strpad(type.id(), form == 1 ? H5T_STR_NULLTERM : form == 2 ? H5T_STR_NULLPAD : H5T_STR_SPACEPAD);
  write_attribute(file, place, type.id(), scalar.id(), text.data());
}

void change_attribute_shape(Recipe& recipe, hid_t file) {
  const AttributePlace place = draw_attribute(recipe, file);
  const hsize_t extent = recipe.one_of(std::span<const hsize_t>(kExtents));
  const Hdf5Handle none(H5Screate(H5S_NULL), H5Sclose), some(H5Screate_simple(1, &extent, nullptr), H5Sclose);
  const bool is_empty = recipe.choice(2) == 0;
  write_attribute(file, place, H5T_IEEE_F64LE, is_empty ? none.id() : some.id(), nullptr);
}

// In place of what stands there, or beside it.
void make_link(Recipe& recipe, hid_t file) {
  const std::string name = draw_link(recipe, file), other = draw_link(recipe, file);
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  switch (recipe.choice(5)) {
    case 0:
      H5Lcreate_soft(other.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 1:
      H5Lcreate_external("/dev/null/no such file", other.c_str(), file, name.c_str(), H5P_DEFAULT,
                         H5P_DEFAULT);
      break;
    case 2:
      H5Lcreate_hard(file, other.c_str(), file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 3:
      H5Lcreate_hard(file, "/", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    default:
      Hdf5Handle(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  }
}

// Under a name of any bytes: a label of its own, where it is a solution or a partition.
void copy_object(Recipe& recipe, hid_t file) {
  const std::string name = draw_link(recipe, file), text = recipe.text();
  const std::string folder = name.substr(0, name.find_last_of('/') + 1);
  H5Ocopy(file, name.c_str(), file, (folder + text).c_str(), H5P_DEFAULT, H5P_DEFAULT);
}

// Every row of an array as its first one: constraints, parts, ids that come again.
void repeat_values(Recipe& recipe, hid_t file) {
  const std::string name = draw_link(recipe, file);
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  Array array = read_array(file, name);
  if (!dataset.valid() || array.values.empty() || array.extents.empty()) return;
  const std::size_t width = array.values.size() / array.extents.front();
  for (std::size_t i = width; i < array.values.size(); ++i) array.values[i] = array.values[i % width];
  H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data());
}

// A recipe names an edit by its place here, so that new ones come at the end.
constexpr void (*kEdits[])(Recipe&, hid_t) = {
    remove_link,           remove_attribute,       change_values,
    change_type,           change_shape,           change_attribute_number,
    change_attribute_text, change_attribute_shape, make_link,
    copy_object,           repeat_values};

}  // namespace

void edit_problem(Recipe& recipe, hid_t file) {
  for (std::size_t edits = recipe.choice(16); edits > 0 && !recipe.is_over(); --edits)
    recipe.one_of(std::span<void (*const)(Recipe&, hid_t)>(kEdits))(recipe, file);
}

}  // namespace cleave::fuzz
