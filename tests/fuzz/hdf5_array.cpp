#include "tests/fuzz/hdf5_array.h"

#include <algorithm>
#include <array>

namespace cleave::fuzz {
namespace {

hsize_t count_of(const std::vector<hsize_t>& extents) {
  hsize_t count = 1;
  for (const hsize_t extent : extents)
    count = extent == 0 ? 0 : std::min(count, ~hsize_t{0} / extent) * extent;
  return count;
}

Hdf5Handle space_of(const std::vector<hsize_t>& extents) {
  return {H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr), H5Sclose};
}

Hdf5Handle compound_type() {
  Hdf5Handle type(H5Tcreate(H5T_COMPOUND, 12), H5Tclose);
  H5Tinsert(type.id(), "value", 0, H5T_IEEE_F64LE);
  H5Tinsert(type.id(), "count", 8, H5T_STD_I32LE);
  return type;
}

Hdf5Handle enumeration() {
  Hdf5Handle type(H5Tenum_create(H5T_STD_I32LE), H5Tclose);
  const int one = 1;
  H5Tenum_insert(type.id(), "one", &one);
  return type;
}

Hdf5Handle text_type(std::size_t size) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), size);
  return type;
}

Hdf5Handle pair_type() {
  const hsize_t two = 2;
  return {H5Tarray_create2(H5T_IEEE_F64LE, 1, &two), H5Tclose};
}

}  // namespace

Array read_array(hid_t file, const std::string& name) {
  Array array;
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (!dataset.valid() || rank < 0) return array;
  array.extents.resize(static_cast<std::size_t>(rank));
  H5Sget_simple_extent_dims(space.id(), array.extents.data(), nullptr);
  if (count_of(array.extents) > kMostWritten) return array;
  array.values.resize(count_of(array.extents));
  H5Dread(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data());
  return array;
}

void replace_array(hid_t file, const std::string& name, const Array& array, hid_t type, hid_t properties) {
  H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  const Hdf5Handle space = space_of(array.extents);
  const Hdf5Handle dataset(
      H5Dcreate2(file, name.c_str(), type, space.id(), H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  const hsize_t count = count_of(array.extents);
  const H5T_class_t kind = H5Tget_class(type);
  if (!dataset.valid() || count > kMostWritten || (kind != H5T_FLOAT && kind != H5T_INTEGER)) return;
  std::vector<double> values = array.values;
  values.resize(count);
  H5Dwrite(dataset.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

Hdf5Handle draw_type(Recipe& recipe) {
  const std::array numbers = {H5T_IEEE_F64LE, H5T_IEEE_F64BE, H5T_IEEE_F32LE, H5T_STD_I32LE,  H5T_STD_I32BE,
                              H5T_STD_I64LE,  H5T_STD_U8LE,   H5T_STD_I8LE,   H5T_STD_I16LE,  H5T_STD_U32LE,
                              H5T_STD_U64BE,  H5T_IEEE_F32BE, H5T_STD_B32LE,  H5T_STD_REF_OBJ};
  const std::size_t choice = recipe.choice(numbers.size() + 6);
  if (choice < numbers.size()) return {H5Tcopy(numbers[choice]), H5Tclose};
  switch (choice - numbers.size()) {
    case 0:
      return compound_type();
    case 1:
      return enumeration();
    case 2:
      return text_type(H5T_VARIABLE);
    case 3:
      return {H5Tvlen_create(H5T_IEEE_F64LE), H5Tclose};
    case 4:
      return pair_type();
    default:
      return text_type(1 + recipe.number(3));
  }
}

Hdf5Handle draw_storage(Recipe& recipe, const std::vector<hsize_t>& extents) {
  Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const std::size_t choice = recipe.choice(7);
  if (choice >= 1 && choice <= 4 && !extents.empty()) {
    std::vector<hsize_t> chunk = extents;
    for (hsize_t& extent : chunk) extent = std::clamp<hsize_t>(extent, 1, 16);
    H5Pset_chunk(properties.id(), static_cast<int>(chunk.size()), chunk.data());
  }
  if (choice == 2) H5Pset_deflate(properties.id(), 1);
  if (choice == 3) H5Pset_shuffle(properties.id());
  if (choice == 3) H5Pset_fletcher32(properties.id());
  if (choice == 4) H5Pset_nbit(properties.id());
  if (choice == 5) H5Pset_layout(properties.id(), H5D_COMPACT);
  if (choice == 6) H5Pset_external(properties.id(), "no such file", 0, H5F_UNLIMITED);
  return properties;
}

}  // namespace cleave::fuzz
