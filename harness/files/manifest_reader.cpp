#include "harness/files/manifest_reader.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/files/manifest.h"

namespace cleave {
namespace {

using nlohmann::json;

[[noreturn]] void reject(const std::filesystem::path& path, const std::string& text) {
  throw std::invalid_argument(path.string() + ": " + text);
}

json parse(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file || std::filesystem::is_directory(path)) reject(path, "cannot be read");
  try {
    return json::parse(file);
  } catch (const json::parse_error& error) {
    reject(path, "is not JSON from byte " + std::to_string(error.byte) + " on; is it damaged?");
  }
}

void require_text(const std::filesystem::path& path, const json& manifest, const char* member,
                  const std::string& allowed) {
  const auto found = manifest.find(member);
  if (found == manifest.end() || !found->is_string())
    reject(path, std::string(member) + " is missing, allowed: " + allowed);
  if (*found != allowed)
    reject(path, std::string(member) + " is '" + found->get<std::string>() + "', allowed: " + allowed);
}

// As the manifest's writer got it; nothing for a value of no such form.
std::optional<std::string> option_text(const json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_integer()) return value.dump();
  if (value.is_number_float()) return number_text(value.get<double>());
  if (!value.is_array()) return std::nullopt;
  std::vector<std::string> items;
  for (const json& item : value) {
    if (!item.is_string()) return std::nullopt;
    items.push_back(item.get<std::string>());
  }
  return joined(items, "\n");
}

}  // namespace

std::map<std::string, std::string> read_manifest_options(const std::filesystem::path& path,
                                                         const std::string& command) {
  const json manifest = parse(path);
  if (!manifest.is_object()) reject(path, "holds no JSON object; a manifest.json is wanted");
  require_text(path, manifest, "schema", kManifestSchema);
  require_text(path, manifest, "command", command);
  const auto options = manifest.find("options");
  if (options == manifest.end() || !options->is_object()) reject(path, "options are missing");
  std::map<std::string, std::string> texts;
  for (const auto& [name, value] : options->items()) {
    const std::optional<std::string> text = option_text(value);
    if (!text)
      reject(path, "option " + name + ": allowed are text, number, true, false, null, list of texts");
    if (!text->empty()) texts[name] = *text;
  }
  return texts;
}

}  // namespace cleave
