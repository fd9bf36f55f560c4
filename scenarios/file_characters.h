#pragma once

#include <string>

namespace cleave::scene_file {

// What TOML says of characters beyond ASCII, before its parser sees them: they stand in comments and in
// strings. Of many that stand elsewhere the library's parser has no defined answer to whether they are
// spaces. Throws std::invalid_argument "pile.toml:7: not TOML: ...".
void check_characters(const std::string& text, const std::string& name);

}  // namespace cleave::scene_file
