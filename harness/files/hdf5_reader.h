// Reads arrays, attributes and groups of an HDF5 file, and checks them against what they should be.
//
// Every error is a std::invalid_argument of one line that begins with the file:
//     rocks.h5: dataset rhs is missing
//     rocks.h5: shape of jacobian = (10, 11), allowed: (10, 12)
//     rocks.h5: solution/a/impulse cannot be read: the file is damaged
// An array must have the element type asked for, in either byte order, or one that converts without loss:
// 32-bit floats where 64-bit ones are asked for, and signed integers of 32 and 64 bits for any integers, each
// of which must fit. Nothing else is converted. Links and data that lead out of the file are refused, and so
// are arrays larger than the file can hold, before room is made for them. All the same a damaged file can
// crash the library (isolated_read.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "harness/base/parameter.h"
#include "harness/files/hdf5_handle.h"
#include "harness/files/hdf5_types.h"

namespace cleave {

// An open file or one of its groups.
class Hdf5Reader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path);

  bool has(const std::string& name) const;
  bool has_attribute(const std::string& name) const;
  Hdf5Reader group(const std::string& name) const;
  std::vector<std::string> names() const;  // of all groups and datasets in here, ascending

  // Number of entries along the first axis of a dataset.
  std::size_t length(const std::string& dataset) const;

  template <class Number>
  void array(const std::string& dataset, const Hdf5Shape& shape, std::vector<Number>& values) const {
    const Hdf5Handle open = open_array(dataset, hdf5_element(Number{}), shape);
    std::size_t count = 1;
    for (const std::size_t extent : shape) count *= extent;
    values.resize(count);
    if (count > 0) read_array(open, dataset, hdf5_element(Number{}), values.data(), count);
  }

  // Attributes are one number or one text each. Any integer or float type does, where the value fits.
  void attribute(const std::string& name, std::string& value) const;
  void attribute(const std::string& name, double& value) const;
  void attribute(const std::string& name, int& value) const;
  void attribute(const std::string& name, std::uint64_t& value) const;
  void attribute(const std::string& name, bool& value) const;  // an integer, 0 or 1

  // Attributes whose names are not known beforehand: all of them, ascending; what kind of value one has (an
  // unsigned 8-bit integer is a truth value), and the value as text ("true", "0.5").
  std::vector<std::string> attribute_names() const;
  Parameter::Kind attribute_kind(const std::string& name) const;
  std::string attribute_text(const std::string& name) const;

  // Throws the one line; `full` puts the groups before a name.
  [[noreturn]] void fail(const std::string& text) const;
  std::string full(const std::string& name) const { return prefix_ + name; }

 private:
  Hdf5Reader(std::string file, std::string prefix, Hdf5Handle handle, std::uintmax_t size)
      : file_(std::move(file)), prefix_(std::move(prefix)), handle_(std::move(handle)), size_(size) {}

  void check_names(const std::vector<std::string>& names) const;

  Hdf5Handle open_dataset(const std::string& name) const;
  Hdf5Shape shape_of(const Hdf5Handle& dataset, const std::string& name) const;
  Hdf5Handle open_array(const std::string& name, const Hdf5Element& element, const Hdf5Shape& shape) const;
  void read_array(const Hdf5Handle& dataset, const std::string& name, const Hdf5Element& element,
                  void* values, std::size_t count) const;
  void read_integers(const Hdf5Handle& dataset, const std::string& name, const Hdf5Element& element,
                     void* values, std::size_t count) const;
  Hdf5Handle open_attribute(const std::string& name) const;
  void read_attribute(const Hdf5Handle& attribute, const std::string& name, hid_t memory_type,
                      void* value) const;
  long long integer(const std::string& name) const;

  std::string file_;
  std::string prefix_;  // "" or "solution/a/"
  Hdf5Handle handle_;
  std::uintmax_t size_ = 0;  // bytes of the file
};

}  // namespace cleave
