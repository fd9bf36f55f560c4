#include "harness/files/hdf5_reader.h"

#include <cstring>
#include <stdexcept>

#include "harness/base/printable_text.h"
#include "harness/files/hdf5_storage.h"

namespace cleave {
namespace {

herr_t collect_name(hid_t, const char* name, const H5L_info_t*, void* names) {
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

}  // namespace cleave
