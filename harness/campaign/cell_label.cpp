#include "harness/campaign/cell_label.h"

#include <vector>

#include "harness/base/names.h"
#include "harness/base/printable_text.h"

namespace cleave {

CellLabel::CellLabel(const toml::table& table, const std::string& file, const CellLabel* outer)
    : file_(file) {
  const toml::node* node = table.get(kLabelKey);
  if (node != nullptr) {
    text_ = scene_file::Value(*node, kLabelKey, file).text("a text");
    source_ = node->source();
    if (text_.empty() || !is_printable_utf8(text_))
      reject("is empty, or has characters that cannot be printed");
  } else if (outer != nullptr) {
    *this = *outer;
  }
}

std::string CellLabel::of(const std::map<std::string, std::string>& values) const {
  std::string filled;
  std::size_t from = 0;
  for (std::size_t open; (open = text_.find('{', from)) != std::string::npos;) {
    const std::size_t close = text_.find('}', open);
    if (close == std::string::npos) reject("has a { without }");
    const std::string key = text_.substr(open + 1, close - open - 1);
    const auto value = values.find(key);
    if (value == values.end()) {
      std::vector<std::string> keys;
      for (const auto& [name, text] : values) keys.push_back(name);
      reject("'" + key + "' is no key of the cell" + nearest_question(key, keys));
    }
    filled += text_.substr(from, open - from) + value->second;
    from = close + 1;
  }
  return filled + text_.substr(from);
}

void CellLabel::reject(const std::string& text) const {
  scene_file::reject_at(file_, source_, kLabelKey, text);
}

}  // namespace cleave
