// Arrays that grow along their first axis, in a file that can be read while it is written and after its
// writer was killed.
//
// HDF5's single-writer / multiple-reader mode orders what goes to disk so that readers never meet half of it.
// Readers must open such a file in the matching mode (h5py: File(path, "r", swmr=True)); once it is closed
// any reader does. Series grow one after the other, so that after a kill they may differ in length: what the
// last one of a sync lacks is not complete.
//
// Errors are std::runtime_error of one line: "motion.h5: position cannot be written: No space left on
// device".
#pragma once

#include <cassert>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "harness/files/hdf5_handle.h"
#include "harness/files/hdf5_types.h"
#include "harness/files/hdf5_writer.h"

namespace cleave {

// One growing array. Entries wait in memory until sync() writes them.
class Hdf5Series {
 public:
  virtual ~Hdf5Series() = default;
  virtual void sync() = 0;
  virtual void close() = 0;  // before the file is closed
};

class Hdf5SeriesFile {
 public:
  explicit Hdf5SeriesFile(const std::filesystem::path& path);  // an existing file is replaced
  ~Hdf5SeriesFile();
  Hdf5SeriesFile(const Hdf5SeriesFile&) = delete;
  Hdf5SeriesFile& operator=(const Hdf5SeriesFile&) = delete;

  // The root group, for attributes, arrays of fixed size and groups. Must be gone before start().
  Hdf5Writer root() const;

  // Ends the definition of the file; only then may series be synced.
  void start();

  // Ends the file, whose series are closed. Only now has the library written all of it.
  void close();

  hid_t id() const { return handle_.id(); }
  [[noreturn]] void fail(const std::string& name) const;
  bool failed() const { return failed_; }

 private:
  std::string file_;
  Hdf5Handle handle_;
  // The library crashes in closing what it could not write, so that is left open.
  mutable bool failed_ = false;
};

// The part of a series that does not depend on its type of number.
class Hdf5SeriesDataset {
 public:
  Hdf5SeriesDataset(const Hdf5SeriesFile& file, std::string name, const Hdf5Shape& entry,
                    std::size_t chunk_entries, const Hdf5Element& element);
  ~Hdf5SeriesDataset();
  Hdf5SeriesDataset(const Hdf5SeriesDataset&) = delete;
  Hdf5SeriesDataset& operator=(const Hdf5SeriesDataset&) = delete;
  void append(const void* values, std::size_t entries);
  void close();

 private:
  const Hdf5SeriesFile& file_;
  std::string name_;
  const Hdf5Element& element_;
  std::vector<hsize_t> extents_;  // so far
  Hdf5Handle dataset_;
};

template <class Number>
class Hdf5SeriesOf : public Hdf5Series {
 public:
  // name: with its groups, which are made where missing. entry: shape of one entry, {} for a number. Stored
  // in compressed chunks of so many entries. file: must outlive the series.
  Hdf5SeriesOf(const Hdf5SeriesFile& file, std::string name, const Hdf5Shape& entry,
               std::size_t chunk_entries)
      : dataset_(file, std::move(name), entry, chunk_entries, hdf5_element(Number{})) {
    for (const std::size_t extent : entry) entry_size_ *= extent;
  }

  // Numbers in order; the entries must be whole by the next sync.
  void append(std::span<const Number> values) {
    waiting_.insert(waiting_.end(), values.begin(), values.end());
  }
  void append(const Number& value) { waiting_.push_back(value); }

  void sync() override {
    if (waiting_.empty()) return;
    assert(waiting_.size() % entry_size_ == 0);
    dataset_.append(waiting_.data(), waiting_.size() / entry_size_);
    waiting_.clear();
  }
  void close() override { dataset_.close(); }

 private:
  Hdf5SeriesDataset dataset_;
  std::size_t entry_size_ = 1;
  std::vector<Number> waiting_;
};

}  // namespace cleave
