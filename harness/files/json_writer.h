// Writes one JSON document, indented, in the order in which things are said.
//
//     JsonWriter json;
//     json.begin_object();
//     json.field("seed", 1);
//     json.begin_array("columns");  json.value("run_id");  json.end_array();
//     json.end_object();
//     json.text();
#pragma once

#include <string>
#include <string_view>

namespace cleave {

// A value that already is JSON, such as a whole number beyond the range of a double.
struct JsonLiteral {
  std::string json;
};

class JsonWriter {
 public:
  void begin_object() { open('{'); }
  void begin_object(std::string_view key) { name(key), open('{'); }
  void end_object() { close('}'); }
  void begin_array(std::string_view key) { name(key), open('['); }
  void end_array() { close(']'); }

  void value(std::string_view text);
  void value(const char* text) { value(std::string_view(text)); }
  void value(double number);  // null for NaN and infinities, which JSON does not have
  void value(int number) { value(JsonLiteral{std::to_string(number)}); }
  void value(const JsonLiteral& literal);

  template <class Value>
  void field(std::string_view key, const Value& content) {
    name(key);
    value(content);
  }

  const std::string& text() const { return text_; }

 private:
  void name(std::string_view key);
  void open(char bracket);
  void close(char bracket);
  void separate();

  std::string text_;
  int depth_ = 0;
  bool first_ = true;       // nothing was written at this depth
  bool after_key_ = false;  // a value follows on the same line
};

}  // namespace cleave
