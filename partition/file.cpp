// file: reads the parts that another program made (part_file.h) in place of making them.
#include <memory>

#include "harness/base/parameter.h"
#include "partition/part_file.h"
#include "partition/partitioner.h"

namespace cleave {
namespace {

class File final : public Partitioner {
 public:
  explicit File(const std::string& pattern) : files_(pattern) {}

 private:
  Partition do_run(const BodyGraph& graph) const override {
    const PartFile* file = files_.find(graph.step());
    if (file == nullptr)
      throw CannotSplit(graph.step() ? files_.pattern() + ": no file of step " + std::to_string(*graph.step())
                                     : files_.pattern() + ": the graph is of no step");
    const int lines = static_cast<int>(file->partition.part_of_body.size());
    if (lines != graph.body_count())
      throw CannotSplit(file->path + ": " + std::to_string(lines) +
                        " lines, allowed: " + std::to_string(graph.body_count()) + ", one a body");
    return file->partition;
  }

  PartFiles files_;
};

}  // namespace

std::unique_ptr<Partitioner> make_file(const Settings& settings) {
  return std::make_unique<File>(settings.text("path"));
}

std::string file_content(const Settings& settings) { return PartFiles(settings.text("path")).fingerprint(); }

}  // namespace cleave
