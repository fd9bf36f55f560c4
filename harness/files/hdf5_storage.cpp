#include "harness/files/hdf5_storage.h"

#include <algorithm>
#include <iterator>

namespace cleave {
namespace {

constexpr std::uintmax_t kMostDeflation = 1032;  // no compressed byte stands for more
constexpr H5Z_filter_t kFilters[] = {H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE, H5Z_FILTER_FLETCHER32};

std::string find_filter_error(const Hdf5Handle& properties, const std::string& name) {
  const int filters = H5Pget_nfilters(properties.id());
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(properties.id(), static_cast<unsigned>(i), &flags, &values,
                                               nullptr, 0, nullptr, nullptr);
    if (std::ranges::find(kFilters, filter) == std::end(kFilters))
      return "filter of " + name + " = number " + std::to_string(filter) +
             ", allowed: gzip, shuffle, fletcher32";
  }
  return {};
}

std::string find_size_error(const Hdf5Handle& dataset, const std::string& name, std::uintmax_t file_bytes,
                            bool is_filtered) {
  const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose);
  const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
  const hssize_t count = H5Sget_simple_extent_npoints(space.id());
  const std::size_t each = H5Tget_size(type.id());
  if (count < 0 || each == 0) return "shape of " + name + " cannot be read: the file is damaged";
  const std::uintmax_t most = is_filtered ? kMostDeflation * file_bytes : file_bytes;
  if (static_cast<std::uintmax_t>(count) <= most / each) return {};
  return "size of " + name + " = " + std::to_string(count) + " entries of " + std::to_string(each) +
         " bytes, allowed: what a file of " + std::to_string(file_bytes) + " bytes can hold";
}

}  // namespace

std::string find_storage_error(const Hdf5Handle& dataset, const std::string& name,
                               std::uintmax_t file_bytes) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset.id()), H5Pclose);
  if (!properties.valid()) return name + " cannot be opened: the file is damaged";
  if (H5Pget_layout(properties.id()) == H5D_VIRTUAL || H5Pget_external_count(properties.id()) != 0)
    return "storage of " + name + " = another file, allowed: this file";
  if (std::string error = find_filter_error(properties, name); !error.empty()) return error;
  return find_size_error(dataset, name, file_bytes, H5Pget_nfilters(properties.id()) > 0);
}

}  // namespace cleave
