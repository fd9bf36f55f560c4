#include "harness/experiment/body_order.h"

#include <numeric>
#include <stdexcept>

#include "harness/base/dice.h"
#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/base/refusals.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

constexpr const char* kSeed = "seed=";

// In the order of BodyOrder::Kind.
const std::vector<std::string> kWords = {"scene", "random", "file"};

[[noreturn]] void reject(const std::string& option, const std::string& text) {
  throw std::invalid_argument(option + ": '" + text +
                              "' is none of scene, random, random@seed=N with N in [0, 2^64), file@PATH");
}

// Numbers are part ids that have one body each.
void check_each_once(const std::string& option, const PartFile& file) {
  const int bodies = static_cast<int>(file.partition.part_of_body.size());
  if (file.partition.part_count == bodies) return;
  throw std::invalid_argument(option + ": " + file.path + ": " + std::to_string(file.partition.part_count) +
                              " different numbers on " + std::to_string(bodies) +
                              " lines, allowed: each of 0 to " + std::to_string(bodies - 1) + " once");
}

void read_files(const std::string& option, const std::string& path, BodyOrder& order) {
  order.files = in_context(option, [&] { return std::make_shared<const PartFiles>(path); });
  order.files->visit([&](const PartFile& file) { check_each_once(option, file); });
  order.text = "file@" + order.files->fingerprint();
}

}  // namespace

BodyOrder read_body_order(const std::string& option, const std::string& text) {
  const std::size_t at = text.find('@');
  const std::string word = text.substr(0, at);
  check_name(option, word, kWords);
  const bool has_more = at != std::string::npos;
  const std::string more = has_more ? text.substr(at + 1) : "";
  BodyOrder order;
  if (word == "scene") {
    if (has_more) reject(option, text);
  } else if (word == "random") {
    order.kind = BodyOrder::Kind::random;
    if (has_more && !more.starts_with(kSeed)) reject(option, text);
    if (has_more)
      order.seed = parse_seed(option + ": seed of random", more.substr(std::string(kSeed).size()));
    order.text = "random@seed=" + std::to_string(order.seed);
  } else {
    if (more.empty()) reject(option, text);
    order.kind = BodyOrder::Kind::file;
    read_files(option, more, order);
  }
  return order;
}

std::vector<int> BodyOrder::numbers(int bodies, std::optional<int> step) const {
  if (kind == Kind::random) return shuffled(bodies, Dice(seed));
  if (kind == Kind::file) {
    const PartFile* file = files->find(step);
    if (file == nullptr)
      throw CannotSplit("body order " + files->pattern() + ": no file of " +
                        (step ? "step " + std::to_string(*step) : "a graph of no step"));
    const std::size_t lines = file->partition.part_of_body.size();
    if (lines != static_cast<std::size_t>(bodies))
      throw CannotSplit("body order " + file->path + ": " + std::to_string(lines) +
                        " lines, allowed: " + std::to_string(bodies) + ", one a body");
    return file->partition.part_of_body;
  }
  std::vector<int> same(bodies);
  std::iota(same.begin(), same.end(), 0);
  return same;
}

}  // namespace cleave
