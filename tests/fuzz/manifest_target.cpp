// manifest.json as --config reads it.
#include <array>
#include <optional>

#include "harness/files/manifest_reader.h"
#include "tests/fuzz/options_roundtrip.h"
#include "tests/fuzz/scratch_file.h"
#include "tests/fuzz/target.h"

namespace cleave::fuzz {
namespace {

struct NamedCommand {
  const char* name;
  bool CommandSet::*member;
};
constexpr std::array<NamedCommand, 3> kCommands = {
    {{"run", &CommandSet::run}, {"record", &CommandSet::record}, {"replay", &CommandSet::replay}}};

}  // namespace

void read_manifest_bytes(std::string_view bytes) {
  const ScratchFile file(bytes);
  for (const NamedCommand& command : kCommands) {
    std::map<std::string, std::string> stored;
    if (refuses([&] { stored = read_manifest_options(file.path(), command.name); })) continue;
    for (const auto& [option, text] : stored) {
      require(!text.empty(), "what was not given is an option");
      if (text.find('/') != std::string::npos) return;  // names of files that may exist
    }
    check_options(command.member, stored, {{"out", "o"}});
  }
}

}  // namespace cleave::fuzz
