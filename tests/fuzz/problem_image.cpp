#include "tests/fuzz/problem_image.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "harness/files/hdf5_handle.h"
#include "tests/fuzz/problem_edits.h"
#include "tests/fuzz/recipe.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/harness/problem_file_sample.h"

namespace cleave::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSignature = "\211HDF\r\n\032\n";
constexpr int kBodies = 3;
constexpr std::size_t kBlock = 1 << 14;  // by which an image in memory grows

template <class Write>
std::string image_written_by(Write write) {
  const ScratchFolder folder;
  const fs::path path = folder.path() / "sound.h5";
  write(path);
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

ProblemFile file_with_sets() {
  ProblemFile file = sample_file(kBodies);
  give_sample_sets(file.problem);
  return file;
}

// As cleave writes them, and as others do, which vouch for nothing; then both with contacts that have no box.
// A recipe names an image by its place here, so that new ones come at the end.
const std::array<std::string, 4>& sound_images() {
  static const std::array<std::string, 4> images = {
      image_written_by([](const fs::path& path) { write_problem_file(path, sample_file(kBodies)); }),
      image_written_by([](const fs::path& path) { write_unchecked(path, sample_file(kBodies)); }),
      image_written_by([](const fs::path& path) { write_problem_file(path, file_with_sets()); }),
      image_written_by([](const fs::path& path) { write_unchecked(path, file_with_sets()); })};
  return images;
}

Hdf5Handle open_image(const std::string& image) {
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.id(), kBlock, false);
  H5Pset_file_image(access.id(), const_cast<char*>(image.data()), image.size());
  return {H5Fopen("image", H5F_ACC_RDWR, access.id()), H5Fclose};
}

std::string image_of(const Hdf5Handle& file) {
  H5Fflush(file.id(), H5F_SCOPE_GLOBAL);
  const ssize_t size = H5Fget_file_image(file.id(), nullptr, 0);
  std::string image(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  H5Fget_file_image(file.id(), image.data(), image.size());
  return image;
}

// Flips bits anywhere, or cuts the end off.
void edit_bytes(Recipe& recipe, std::string& image) {
  while (!recipe.is_over() && !image.empty()) {
    const std::uint32_t place = recipe.number(3), change = recipe.number();
    if (change == 0) {
      image.resize(place % image.size());
    } else {
      image[place % image.size()] ^= static_cast<char>(change);
    }
  }
}

}  // namespace

std::string problem_image(std::string_view bytes) {
  if (bytes.starts_with(kSignature)) return std::string(bytes);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  Recipe recipe(bytes);
  std::string image = sound_images()[recipe.choice(sound_images().size())];
  const Hdf5Handle file = open_image(image);
  if (!file.valid()) throw std::logic_error("a sound image cannot be opened");
  edit_problem(recipe, file.id());
  image = image_of(file);
  edit_bytes(recipe, image);
  return image;
}

}  // namespace cleave::fuzz
