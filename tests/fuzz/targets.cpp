#include "tests/fuzz/target.h"

namespace cleave::fuzz {

std::span<const Target> targets() {
  static const Target table[] = {
      {"csv", read_csv},     {"manifest", read_manifest_bytes}, {"options", read_options, mutate_options},
      {"scene", read_scene}, {"problem", read_problem},
  };
  return table;
}

}  // namespace cleave::fuzz
