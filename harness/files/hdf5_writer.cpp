#include "harness/files/hdf5_writer.h"

#include <cassert>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace cleave {

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path) : file_(path.string()) {
  silence_hdf5();
  errno = 0;
  handle_ = Hdf5Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  if (!handle_.valid()) fail("");
}

// errno is that of the last system call inside the library, where there was one.
void Hdf5Writer::fail(const std::string& name) const {
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  const std::string what = prefix_ + name;
  throw std::runtime_error(file_ + ": " + (what.empty() ? "" : what + " ") + "cannot be written" + reason);
}

Hdf5Writer Hdf5Writer::group(const std::string& name) const {
  errno = 0;
  Hdf5Handle group(H5Gcreate2(handle_.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!group.valid()) fail(name);
  return {file_, prefix_ + name + "/", std::move(group)};
}

void Hdf5Writer::write_array(const std::string& name, const Hdf5Shape& shape, const Hdf5Element& element,
                             const void* values, std::size_t count) const {
  std::size_t expected = 1;
  for (const std::size_t extent : shape) expected *= extent;
  assert(count == expected);
  errno = 0;
  const std::vector<hsize_t> extents(shape.begin(), shape.end());
  const Hdf5Handle space(H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr),
                         H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  const Hdf5Handle dataset(H5Dcreate2(handle_.id(), name.c_str(), element.file(), space.id(), H5P_DEFAULT,
                                      properties.id(), H5P_DEFAULT),
                           H5Dclose);
  if (!dataset.valid()) fail(name);
  if (count == 0) return;  // an empty vector has no address to write from
  if (H5Dwrite(dataset.id(), element.memory(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) fail(name);
}

void Hdf5Writer::write_attribute(const std::string& name, hid_t file_type, hid_t memory_type,
                                 const void* value) const {
  errno = 0;
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(handle_.id(), name.c_str(), file_type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.id(), memory_type, value) < 0) fail(name);
}

void Hdf5Writer::attribute(const std::string& name, const std::string& value) const {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  const char* text = value.c_str();
  write_attribute(name, type.id(), type.id(), &text);
}

void Hdf5Writer::attribute(const std::string& name, double value) const {
  write_attribute(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5Writer::attribute(const std::string& name, int value) const {
  write_attribute(name, H5T_STD_I32LE, H5T_NATIVE_INT, &value);
}

void Hdf5Writer::attribute(const std::string& name, std::uint64_t value) const {
  write_attribute(name, H5T_STD_U64LE, H5T_NATIVE_UINT64, &value);
}

void Hdf5Writer::attribute(const std::string& name, bool value) const {
  const std::uint8_t byte = value ? 1 : 0;
  write_attribute(name, H5T_STD_U8LE, H5T_NATIVE_UINT8, &byte);
}

void Hdf5Writer::close() {
  errno = 0;
  if (!handle_.close()) fail("");
}

}  // namespace cleave
