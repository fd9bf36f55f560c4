// Writes arrays, attributes and groups into a new HDF5 file. Equal contents give equal bytes: no time is
// kept. The file grows in memory and goes to disk as a whole (whole_file.h): the library, which does not get
// over a failed write, never meets a full disk.
//
// Errors are std::runtime_error of one line: "rocks.h5: jacobian cannot be written: No space left on device".
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/files/hdf5_handle.h"
#include "harness/files/hdf5_types.h"

namespace cleave {

// A new file or one of its groups.
class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& path);  // an existing file is replaced

  // A group that is open: names in errors are "<file>: <prefix><name>".
  Hdf5Writer(std::string file, std::string prefix, Hdf5Handle handle)
      : file_(std::move(file)), prefix_(std::move(prefix)), handle_(std::move(handle)) {}

  Hdf5Writer group(const std::string& name) const;

  // values: as many as the shape says.
  template <class Number>
  void array(const std::string& name, const Hdf5Shape& shape, const std::vector<Number>& values) const {
    write_array(name, shape, hdf5_element(Number{}), values.data(), values.size());
  }

  void attribute(const std::string& name, const std::string& value) const;  // UTF-8, fixed length
  void attribute(const std::string& name, double value) const;
  void attribute(const std::string& name, int value) const;
  void attribute(const std::string& name, std::uint64_t value) const;
  void attribute(const std::string& name, bool value) const;  // 8-bit 0 or 1

  // Ends the file and writes it. Its groups must be gone.
  void close();

 private:
  [[noreturn]] void fail(const std::string& name) const;
  std::string image() const;  // the bytes of the file
  void write_array(const std::string& name, const Hdf5Shape& shape, const Hdf5Element& element,
                   const void* values, std::size_t count) const;
  void write_attribute(const std::string& name, hid_t file_type, hid_t memory_type, const void* value) const;

  std::string file_;
  std::string prefix_;
  Hdf5Handle handle_;
};

}  // namespace cleave
