#include "harness/base/printable_text.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace cleave {
namespace {

constexpr std::uint32_t kNoCharacter = 0xffffffff;

// Takes one character off the front of the text; kNoCharacter where it is no UTF-8.
std::uint32_t take_character(std::string_view& text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
  if (length == 0 || first > 0xf4 || text.size() < length) return kNoCharacter;
  std::uint32_t character = length == 1 ? first : first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return kNoCharacter;
    character = character << 6 | (byte(i) & 0x3f);
  }
  text.remove_prefix(length);
  const bool is_longer_than_needed =
      (length == 3 && character < 0x800) || (length == 4 && character < 0x10000);
  const bool is_surrogate = character >= 0xd800 && character < 0xe000;
  return is_longer_than_needed || is_surrogate || character > 0x10ffff ? kNoCharacter : character;
}

bool begins_character(char byte) { return (static_cast<unsigned char>(byte) & 0xc0) != 0x80; }

bool is_control(std::uint32_t character) {
  const bool is_line_end = character == 0x2028 || character == 0x2029;
  return character < 0x20 || (character >= 0x7f && character < 0xa0) || is_line_end;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty())
    if (take_character(text) == kNoCharacter) return false;
  return true;
}

bool is_printable_utf8(std::string_view text) {
  while (!text.empty())
    if (const std::uint32_t character = take_character(text);
        character == kNoCharacter || is_control(character))
      return false;
  return true;
}

std::string printable(std::string_view text) {
  if (is_printable_utf8(text)) return std::string(text);
  std::string shown;
  for (const unsigned char byte : text) {
    char escaped[5];
    std::snprintf(escaped, sizeof escaped, byte >= 0x20 && byte < 0x7f ? "%c" : "\\x%02x", byte);
    shown += escaped;
  }
  return shown;
}

std::size_t count_characters(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, begins_character));
}

std::string_view first_characters(std::string_view text, std::size_t most) {
  std::size_t end = 0;
  for (std::size_t count = 0; end < text.size(); ++end)
    if (begins_character(text[end]) && count++ == most) break;
  return text.substr(0, end);
}

void say(std::string_view text) { std::fprintf(stderr, "%s\n", printable(text).c_str()); }

}  // namespace cleave
