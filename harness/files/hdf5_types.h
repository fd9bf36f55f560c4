// How the numbers of our arrays lie in memory and in a file. In files everything is little endian.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "solver/step_problem.h"

namespace cleave {

using Hdf5Shape = std::vector<std::size_t>;

// An element type. HDF5's type ids are known only at run time, hence functions.
struct Hdf5Element {
  hid_t (*memory)();
  hid_t (*file)();
  H5T_class_t type_class;
  std::size_t size;
  bool is_signed;
  const char* name;
};

inline constexpr Hdf5Element kHdf5Double = {
    [] { return H5T_NATIVE_DOUBLE; }, [] { return H5T_IEEE_F64LE; }, H5T_FLOAT, 8, true, "64-bit float"};
inline constexpr Hdf5Element kHdf5Float = {
    [] { return H5T_NATIVE_FLOAT; }, [] { return H5T_IEEE_F32LE; }, H5T_FLOAT, 4, true, "32-bit float"};
inline constexpr Hdf5Element kHdf5Int = {
    [] { return H5T_NATIVE_INT; }, [] { return H5T_STD_I32LE; }, H5T_INTEGER, 4, true,
    "32-bit signed integer"};
inline constexpr Hdf5Element kHdf5Short = {
    [] { return H5T_NATIVE_USHORT; }, [] { return H5T_STD_U16LE; }, H5T_INTEGER, 2, false,
    "16-bit unsigned integer"};
inline constexpr Hdf5Element kHdf5Byte = {
    [] { return H5T_NATIVE_UCHAR; }, [] { return H5T_STD_U8LE; }, H5T_INTEGER, 1, false,
    "8-bit unsigned integer"};

constexpr const Hdf5Element& hdf5_element(double) { return kHdf5Double; }
constexpr const Hdf5Element& hdf5_element(float) { return kHdf5Float; }
constexpr const Hdf5Element& hdf5_element(std::uint16_t) { return kHdf5Short; }
constexpr const Hdf5Element& hdf5_element(int) { return kHdf5Int; }
constexpr const Hdf5Element& hdf5_element(std::uint8_t) { return kHdf5Byte; }
constexpr const Hdf5Element& hdf5_element(RowKind) { return kHdf5Byte; }
constexpr const Hdf5Element& hdf5_element(ContactSet) { return kHdf5Byte; }

// Types of a file. Ordinary are numbers whose every bit stands where the processor's have it, in either order
// of bytes, and texts with an end and characters that there are.
bool is_ordinary(hid_t type);
std::string type_text(hid_t type);  // "32-bit unsigned integer"
bool matches(hid_t type, const Hdf5Element& element);
// Holds every value that the element asked for can have, or more; see the head of hdf5_reader.h.
bool converts(hid_t type, const Hdf5Element& element);
std::string allowed_types(const Hdf5Element& element);

// Keeps the library from printing, errors are ours to tell, and from an exit handler, which would write once
// more what could not be written and end in a crash. Call it before any other function of the library, even
// its version.
inline void silence_hdf5() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

// What there has to be before a file is made: several times what the library takes, which crashes where it
// finds less.
inline constexpr std::size_t kRoomToOpenHdf5 = std::size_t{4} << 20;

// "(10, 12)"
inline std::string hdf5_shape_text(std::span<const std::size_t> shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) text += (i == 0 ? "" : ", ") + std::to_string(shape[i]);
  return text + ")";
}

}  // namespace cleave
