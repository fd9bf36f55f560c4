#include "harness/commands/collected_tables.h"

#include <map>
#include <stdexcept>
#include <string>

#include "harness/base/refusals.h"
#include "harness/files/checksums.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& out, const std::string& ending) {
  return out.parent_path() / (out.stem().string() + ending);
}

}  // namespace

CollectedTables::CollectedTables(const fs::path& out)
    : rows(out),
      cells(beside(out, ".cells" + out.extension().string())),
      columns(beside(out, ".columns" + out.extension().string())),
      checksums(beside(out, ".checksums")) {}

void check_collected_tables(const fs::path& out, CheckList& list) {
  const CollectedTables files(out);
  std::map<std::string, std::string> sums;
  const std::string error = wrong_in([&]() -> std::string {
    sums = read_checksum_list(files.checksums);
    return sums.size() == files.tables().size() ? "" : "; it names other files than the three tables";
  });
  list.add(error.empty(), files.checksums.string(), "readable" + error);
  for (const fs::path& table : files.tables()) {
    std::error_code none;
    const std::string found = fs::is_regular_file(table, none) ? sha256_of(table) : "no such file";
    const std::string& said = sums[table.filename().string()];
    list.add(
        found == said, table.string(),
        "sha256 " + found + (found == said ? "" : "; checksums say " + (said.empty() ? "nothing" : said)));
  }
}

}  // namespace cleave
