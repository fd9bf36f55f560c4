#include "harness/files/hdf5_series.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "harness/base/room.h"

namespace cleave {
namespace {

// What is added at the end is never looked at again. Left to itself the library keeps up to a megabyte of
// written chunks for every array. (It forgets what one array was told when the file changes its mode.)
void write_chunks_at_once(const Hdf5Handle& access) {
  constexpr std::size_t kSlots = 1, kBytes = 0;
  constexpr double kDropWrittenFirst = 1;
  H5Pset_cache(access.id(), 0, kSlots, kBytes, kDropWrittenFirst);
}

}  // namespace

Hdf5SeriesFile::Hdf5SeriesFile(const std::filesystem::path& path) : file_(path.string()) {
  silence_hdf5();
  require_room(kRoomToOpenHdf5);
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // The mode needs the format of HDF5 1.10; a later one would shut out its readers.
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  write_chunks_at_once(access);
  errno = 0;
  handle_ = Hdf5Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose);
  if (!handle_.valid()) fail("");
}

Hdf5Writer Hdf5SeriesFile::root() const {
  return {file_, "", Hdf5Handle(H5Gopen2(handle_.id(), "/", H5P_DEFAULT), H5Gclose)};
}

void Hdf5SeriesFile::start() {
  errno = 0;
  if (H5Fstart_swmr_write(handle_.id()) < 0) fail("");
}

Hdf5SeriesFile::~Hdf5SeriesFile() {
  if (failed_) handle_.abandon();
}

// errno is that of the last system call inside the library, where there was one.
void Hdf5SeriesFile::fail(const std::string& name) const {
  failed_ = true;
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : "";
  throw std::runtime_error(file_ + ": " + (name.empty() ? "" : name + " ") + "cannot be written" + reason);
}

void Hdf5SeriesFile::close() {
  errno = 0;
  if (!handle_.close()) fail("");
}

Hdf5SeriesDataset::Hdf5SeriesDataset(const Hdf5SeriesFile& file, std::string name, const Hdf5Shape& entry,
                                     std::size_t chunk_entries, const Hdf5Element& element)
    : file_(file), name_(std::move(name)), element_(element), extents_{0} {
  extents_.insert(extents_.end(), entry.begin(), entry.end());
  std::vector<hsize_t> chunk = extents_, limit = extents_;
  chunk.front() = chunk_entries;
  limit.front() = H5S_UNLIMITED;

  const int rank = static_cast<int>(extents_.size());
  const Hdf5Handle space(H5Screate_simple(rank, extents_.data(), limit.data()), H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(properties.id(), rank, chunk.data());
  H5Pset_shuffle(properties.id());  // bytes of equal weight side by side: signs and exponents hardly change
  H5Pset_deflate(properties.id(), 6);
  H5Pset_obj_track_times(properties.id(), false);
  const Hdf5Handle link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(link.id(), 1);
  errno = 0;
  dataset_ = Hdf5Handle(H5Dcreate2(file.id(), name_.c_str(), element.file(), space.id(), link.id(),
                                   properties.id(), H5P_DEFAULT),
                        H5Dclose);
  if (!dataset_.valid()) file_.fail(name_);
}

Hdf5SeriesDataset::~Hdf5SeriesDataset() {
  if (file_.failed()) dataset_.abandon();
}

void Hdf5SeriesDataset::close() {
  errno = 0;
  if (!dataset_.close()) file_.fail(name_);
}

void Hdf5SeriesDataset::append(const void* values, std::size_t entries) {
  std::vector<hsize_t> start(extents_.size(), 0), count = extents_;
  start.front() = extents_.front();
  count.front() = entries;
  extents_.front() += entries;
  errno = 0;
  if (H5Dset_extent(dataset_.id(), extents_.data()) < 0) file_.fail(name_);
  const int rank = static_cast<int>(extents_.size());
  const Hdf5Handle memory(H5Screate_simple(rank, count.data(), nullptr), H5Sclose);
  const Hdf5Handle target(H5Dget_space(dataset_.id()), H5Sclose);
  H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  if (H5Dwrite(dataset_.id(), element_.memory(), memory.id(), target.id(), H5P_DEFAULT, values) < 0 ||
      H5Dflush(dataset_.id()) < 0)
    file_.fail(name_);
}

}  // namespace cleave
