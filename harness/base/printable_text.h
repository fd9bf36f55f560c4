// Texts that come from files: whether they may stand in a line of output, and how to show those that may not.
#pragma once

#include <string>
#include <string_view>

namespace cleave {

bool is_utf8(std::string_view text);

// Well-formed UTF-8 without control characters and line ends of any kind.
bool is_printable_utf8(std::string_view text);

// The text with every byte outside ASCII's printable ones as \x0a, where it is not printable; else the text
// itself.
std::string printable(std::string_view text);

// Characters of a text in UTF-8: their number, and the text of the first ones.
std::size_t count_characters(std::string_view text);
std::string_view first_characters(std::string_view text, std::size_t most);

// One line on standard error, whatever the text holds: arguments and names of files come from anywhere.
void say(std::string_view text);

}  // namespace cleave
