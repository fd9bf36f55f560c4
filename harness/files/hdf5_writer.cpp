#include "harness/files/hdf5_writer.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "harness/base/room.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

constexpr std::size_t kMemoryStep = std::size_t{1} << 20;  // by which the file grows in memory

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& path) : file_(path.string()) {
  silence_hdf5();
  require_room(kRoomToOpenHdf5);
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const bool on_disk = false;
  errno = 0;
  if (H5Pset_fapl_core(access.id(), kMemoryStep, on_disk) >= 0)
    handle_ = Hdf5Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
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

// A text of fixed length lies where the attribute does; one of variable length would lie in a heap of the
// file, in which the library follows damaged pointers.
void Hdf5Writer::attribute(const std::string& name, const std::string& value) const {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(value.size(), 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  write_attribute(name, type.id(), type.id(), value.c_str());
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

std::string Hdf5Writer::image() const {
  errno = 0;
  if (H5Fflush(handle_.id(), H5F_SCOPE_LOCAL) < 0) fail("");
  const ssize_t size = H5Fget_file_image(handle_.id(), nullptr, 0);
  if (size < 0) fail("");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(handle_.id(), bytes.data(), bytes.size()) != size) fail("");
  return bytes;
}

void Hdf5Writer::close() {
  const std::string bytes = image();
  if (!handle_.close()) fail("");
  write_whole_file(file_, bytes);
}

}  // namespace cleave
