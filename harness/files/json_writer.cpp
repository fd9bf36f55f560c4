#include "harness/files/json_writer.h"

#include <cmath>
#include <cstdio>

#include "harness/base/numbers.h"

namespace cleave {
namespace {

std::string quoted(std::string_view text) {
  std::string json = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      json += '\\';
      json += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", c);
      json += escape;
    } else {
      json += c;
    }
  }
  return json + '"';
}

}  // namespace

void JsonWriter::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (depth_ == 0) return;
  if (!first_) text_ += ',';
  text_ += '\n' + std::string(2 * depth_, ' ');
  first_ = false;
}

void JsonWriter::name(std::string_view key) {
  separate();
  text_ += quoted(key) + ": ";
  after_key_ = true;
}

void JsonWriter::value(const JsonLiteral& literal) {
  separate();
  text_ += literal.json;
}

void JsonWriter::value(std::string_view text) { value(JsonLiteral{quoted(text)}); }
void JsonWriter::value(double number) {
  value(JsonLiteral{std::isfinite(number) ? number_text(number) : "null"});
}

void JsonWriter::open(char bracket) {
  separate();
  text_ += bracket;
  ++depth_;
  first_ = true;
}

void JsonWriter::close(char bracket) {
  --depth_;
  if (!first_) text_ += '\n' + std::string(2 * depth_, ' ');
  text_ += bracket;
  first_ = false;
  if (depth_ == 0) text_ += '\n';
}

}  // namespace cleave
