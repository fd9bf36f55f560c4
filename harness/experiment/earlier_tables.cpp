#include "harness/experiment/earlier_tables.h"

#include <algorithm>

#include "harness/base/csv_text.h"
#include "harness/experiment/step_record.h"

namespace cleave {

bool are_columns_of_schema(std::span<const std::string> header) {
  static const std::vector<Column> all = columns();
  return header.size() <= all.size() && std::ranges::count(header, "schema_version") == 1 &&
         std::ranges::equal(header, std::span(all).first(header.size()), {}, {}, &Column::name);
}

std::vector<std::string> cells_of_later_columns(std::size_t count) {
  std::string line = csv_line(StepRecord{});
  line.pop_back();
  const std::vector<std::string> cells = split_csv_line(line);
  return {cells.begin() + static_cast<std::ptrdiff_t>(count), cells.end()};
}

}  // namespace cleave
