// Owner of one open object of the HDF5 library (file, group, dataset, dataspace, type, attribute).
#pragma once

#include <hdf5.h>

#include <utility>

namespace cleave {

class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() { close(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }

  // Whether the library returned an object and not an error.
  bool valid() const { return id_ >= 0; }
  hid_t id() const { return id_; }

  // Leaves the object open for good.
  void abandon() { id_ = -1; }

  // Whether closing went well: the last data of a file reach the disk only then.
  bool close() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || close_(id) >= 0;
  }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

}  // namespace cleave
