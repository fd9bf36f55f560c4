#include "scenarios/file_characters.h"

#include <algorithm>
#include <stdexcept>
#include <string_view>

namespace cleave::scene_file {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBeforeStrings = " \t\r\n=,.[{";  // or the start of the file
constexpr std::size_t kMostQuotesInside = 2;                 // before the three that end a string: """a"""""

std::size_t string_length(std::string_view rest, std::string_view quote) {
  const bool is_long = quote.size() > 1, has_escapes = quote.front() == '"';
  std::size_t end = quote.size();
  while (end < rest.size() && !rest.substr(end).starts_with(quote) && (is_long || rest[end] != '\n'))
    end += has_escapes && rest[end] == '\\' ? 2 : 1;
  end = std::min(end + quote.size(), rest.size());
  for (std::size_t more = 0;
       is_long && more < kMostQuotesInside && rest.substr(end).starts_with(quote.front()); ++more)
    ++end;
  return end;
}

// Of the comment or string that begins here; 0: none does. A quote within a word begins none: the parser
// takes it for a part of the word.
std::size_t free_length(std::string_view text, std::size_t at) {
  const std::string_view rest = text.substr(at);
  if (rest.starts_with('#')) return std::min(rest.find('\n'), rest.size());
  if (at > 0 && kBeforeStrings.find(text[at - 1]) == std::string_view::npos) return 0;
  for (const std::string_view quote : {"\"\"\"", "'''", "\"", "'"})
    if (rest.starts_with(quote)) return string_length(rest, quote);
  return 0;
}

}  // namespace

void check_characters(const std::string& with_mark, const std::string& name) {
  std::string_view text = with_mark;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = free_length(text, i);
    if (length == 0 && static_cast<unsigned char>(text[i]) >= 0x80)
      throw std::invalid_argument(
          name + ":" +
          std::to_string(1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n')) +
          ": not TOML: a character beyond ASCII that is in no comment and no string");
    i += std::max<std::size_t>(length, 1);
  }
}

}  // namespace cleave::scene_file
