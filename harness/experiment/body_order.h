// By which numbers bodies are split (--body-order). Partitioners break ties by the number of a body, and some
// begin with the lowest: what they find hangs on the order in which a scene happens to create its bodies.
//
// A graph is renumbered before it is split, and the parts found are those of the bodies again afterwards:
// problem, solve and motion know nothing of it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "partition/part_file.h"

namespace cleave {

struct BodyOrder {
  enum class Kind { scene, random, file };

  Kind kind = Kind::scene;
  std::uint64_t seed = 1;                       // of random
  std::shared_ptr<const PartFiles> files = {};  // of file: the number of a body on its line
  std::string text = "scene";                   // "random@seed=1", "file@1f2e3d4c5b6a7988"

  // (n) the number of each body. step: of the run, by which there may be files. Throws CannotSplit where
  // there is no file of the step or it is of another number of bodies.
  std::vector<int> numbers(int bodies, std::optional<int> step) const;
};

// "scene", "random", "random@seed=N" or "file@PATH" with a path as PartFiles takes it. Throws
// std::invalid_argument naming the option for anything else, a file that cannot be read and one that does not
// give every number once.
BodyOrder read_body_order(const std::string& option, const std::string& text);

}  // namespace cleave
