#include "harness/files/manifest_reader.h"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "harness/base/file_text.h"
#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "harness/files/manifest.h"

namespace cleave {
namespace {

using json = nlohmann::ordered_json;  // run ids are fingerprints of the options in their order

[[noreturn]] void reject(const std::filesystem::path& path, const std::string& text) {
  throw std::invalid_argument(path.string() + ": " + text);
}

json parse(const std::filesystem::path& path) {
  const std::optional<std::string> text = file_text(path);
  if (!text) reject(path, "cannot be read");
  try {
    return json::parse(*text);
  } catch (const json::parse_error& error) {
    reject(path, "is not JSON from byte " + std::to_string(error.byte) + " on; is it damaged?");
  } catch (const json::out_of_range&) {
    reject(path, "holds a number beyond the range of 64-bit floats; is it damaged?");
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

OptionKind kind_of(const json& value) {
  if (value.is_boolean()) return OptionKind::flag;
  if (value.is_number()) return OptionKind::number;
  return value.is_array() ? OptionKind::lines : OptionKind::text;
}

std::vector<OptionValue> read_options(const std::filesystem::path& path, const json& manifest) {
  const auto options = manifest.find("options");
  if (options == manifest.end() || !options->is_object()) reject(path, "options are missing");
  std::vector<OptionValue> values;
  for (const auto& [name, value] : options->items()) {
    const std::optional<std::string> text = option_text(value);
    if (!text)
      reject(path, "option " + name + ": allowed are text, number, true, false, null, list of texts");
    values.push_back({name, kind_of(value), *text});
  }
  return values;
}

NamedAlgorithm read_algorithm(const json& value) {
  return {value.at("kind"),
          value.at("text"),
          value.at("name"),
          value.at("parameters").get<std::map<std::string, std::string>>(),
          {}};
}

json read_object(const std::filesystem::path& path) {
  json manifest = parse(path);
  if (!manifest.is_object()) reject(path, "holds no JSON object; a manifest.json is wanted");
  require_text(path, manifest, "schema", kManifestSchema);
  return manifest;
}

}  // namespace

std::map<std::string, std::string> read_manifest_options(const std::filesystem::path& path,
                                                         const std::string& command) {
  const json manifest = read_object(path);
  require_text(path, manifest, "command", command);
  std::map<std::string, std::string> texts;
  for (const OptionValue& value : read_options(path, manifest))
    if (!value.text.empty()) texts[value.name] = value.text;
  return texts;
}

std::string StoredManifest::option(const std::string& name) const {
  const auto found = std::ranges::find(options, name, &OptionValue::name);
  return found == options.end() ? "" : found->text;
}

StoredManifest read_manifest(const std::filesystem::path& path) {
  const json manifest = read_object(path);
  StoredManifest stored;
  stored.options = read_options(path, manifest);
  try {
    stored.state = manifest.at("state");
    stored.command = manifest.at("command");
    stored.run_id = manifest.at("run_id");
    stored.steps_schema = manifest.value("steps_schema", "");
    const json nothing = json::object();
    stored.utc_start = manifest.value("utc_start", "");
    const json build = manifest.value("build", nothing);
    stored.git_hash = build.value("git_hash", "");
    stored.build = {build.value("version", ""),  stored.git_hash,          build.value("git_dirty", ""),
                    build.value("compiler", ""), build.value("flags", ""), build.value("build_type", ""),
                    build.value("build_id", "")};
    stored.cpu_model = manifest.value("machine", nothing).value("cpu_model", "");
    const json algorithms = manifest.value("algorithms", nothing), result = manifest.value("result", nothing);
    for (const json& algorithm : algorithms) stored.algorithms.push_back(read_algorithm(algorithm));
    for (const auto& [name, value] : result.items())
      stored.result[name] = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
    for (const json& column : manifest.at("columns")) stored.columns.push_back(column.at("name"));
    stored.files = manifest.value("files", std::vector<std::string>{});
  } catch (const json::exception&) {
    reject(path, "a member is missing or of another form than that of " + std::string(kManifestSchema));
  }
  return stored;
}

}  // namespace cleave
