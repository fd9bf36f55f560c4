// Tables of steps that earlier programs wrote. A schema gains columns at its end only, so that a table of the
// same schema has the first columns of this program.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace cleave {

// Whether these are columns of the present schema, perhaps without those that came later.
bool are_columns_of_schema(std::span<const std::string> header);

// What a row has in the columns behind the first `count`: what nobody measured.
std::vector<std::string> cells_of_later_columns(std::size_t count);

}  // namespace cleave
