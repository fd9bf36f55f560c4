// What a sanitiser says in a child process, whose stderr nobody sees.
#pragma once

#include <string>

namespace cleave::fuzz {

// All that children forked since the last call have said; always empty where no sanitiser is built in.
std::string take_child_report();

// Whether the report blames this program and not a library: the innermost three frames are its own (up to two
// of them may be the sanitiser's), or memory that was overrun is.
bool is_own_fault(const std::string& report);

}  // namespace cleave::fuzz
