#include "harness/manifest.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "harness/json_writer.h"
#include "harness/step_record.h"

namespace cleave {
namespace {

constexpr const char* kSchema = "cleave-run-1";

void add_option(JsonWriter& json, const OptionValue& option) {
  if (option.kind == OptionSpec::Kind::text) {
    json.field(option.name, option.text);
  } else {
    // Numbers and truth values already read as JSON; a number that was not given is null.
    json.field(option.name, JsonLiteral{option.text == "nan" ? "null" : option.text});
  }
}

void add_options(JsonWriter& json, const std::vector<OptionValue>& options) {
  json.begin_object("options");
  for (const OptionValue& option : options) add_option(json, option);
  json.end_object();
}

void add_build(JsonWriter& json) {
  const BuildInfo build = build_info();
  json.begin_object("build");
  json.field("version", build.version);
  json.field("git_hash", build.git_hash);
  json.field("git_dirty", build.git_dirty);
  json.field("compiler", build.compiler);
  json.field("flags", build.flags);
  json.field("build_type", build.build_type);
  json.begin_object("libraries");
  for (const auto& [name, version] : library_versions()) json.field(name, version);
  json.end_object();
  json.end_object();
}

void add_load(JsonWriter& json, const char* name, const std::array<double, 3>& load_average) {
  json.begin_array(name);
  for (const double load : load_average) json.value(load);
  json.end_array();
}

void add_machine(JsonWriter& json, const MachineInfo& machine, const std::array<double, 3>* load_at_end) {
  json.begin_object("machine");
  json.field("host", machine.host);
  json.field("cpu_model", machine.cpu_model);
  json.field("cores", machine.cores);
  json.field("governor", machine.governor);
  add_load(json, "load_average", machine.load_average);
  if (load_at_end != nullptr) add_load(json, "load_average_end", *load_at_end);
  json.field("omp_threads", machine.omp_threads);
  json.begin_object("omp_environment");
  for (const auto& [name, value] : machine.omp_environment) json.field(name, value);
  json.end_object();
  json.field("dense_kernel", machine.dense_kernel);
  json.field("dense_gflop_per_s", machine.dense_gflop_per_s);
  json.end_object();
}

void add_result(JsonWriter& json, const RunSummary& summary) {
  json.begin_object("result");
  json.field("steps", summary.steps);
  json.field("measured_steps", summary.measured_steps);
  json.field("measured_with_contacts", summary.measured_with_contacts);
  json.field("rows", summary.rows);
  json.field("rows_ok", summary.rows_ok);
  json.field("inexact_advances", summary.inexact_advances);
  json.field("stopped_worlds", summary.stopped_worlds);
  json.field("unconverged_bounds", summary.unconverged_bounds);
  json.field("worst_residual_m_per_s", summary.worst_residual_m_per_s);
  json.field("worst_velocity_spread_m_per_s", summary.worst_velocity_spread_m_per_s);
  json.field("t_s_total_ms", summary.t_s_total_ms);
  json.field("t_s_waiting_total_ms", summary.t_s_waiting_total_ms);
  json.field("wall_s", summary.wall_s);
  json.end_object();
}

void add_columns(JsonWriter& json) {
  json.begin_array("columns");
  for (const Column& column : columns()) {
    json.begin_object();
    json.field("name", column.name);
    json.field("help", column.help);
    json.field("machine", JsonLiteral{column.machine ? "true" : "false"});
    json.end_object();
  }
  json.end_array();
}

void write_atomically(const std::filesystem::path& path, const std::string& text) {
  const std::filesystem::path temporary = path.string() + ".part";
  errno = 0;
  std::ofstream file(temporary, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(temporary.string() + ": cannot be written: " + std::strerror(errno));
  std::filesystem::rename(temporary, path);
}

}  // namespace

Manifest::Manifest(std::filesystem::path path, std::string command, std::vector<std::string> argv,
                   std::vector<OptionValue> options)
    : path_(std::move(path)),
      command_(std::move(command)),
      argv_(std::move(argv)),
      options_(std::move(options)) {}

RunSummary Manifest::around(const std::function<RunSummary()>& work) {
  write_start();
  RunSummary summary;
  try {
    summary = work();
  } catch (const std::exception& error) {
    write_end("failed", summary, error.what());
    throw;
  }
  write_end(summary.interrupted ? "interrupted" : "complete", summary, "");
  return summary;
}

void Manifest::write_start() {
  utc_start_ = utc_now();
  machine_ = machine_info();
  write("running", nullptr, "");
}

void Manifest::write_end(const std::string& state, const RunSummary& summary, const std::string& message) {
  utc_end_ = utc_now();
  load_average_end_ = load_average();
  write(state, &summary, message);
}

void Manifest::write(const std::string& state, const RunSummary* summary, const std::string& message) const {
  JsonWriter json;
  json.begin_object();
  json.field("schema", kSchema);
  json.field("state", state);
  if (!message.empty()) json.field("message", message);
  json.field("command", command_);
  json.begin_array("argv");
  for (const std::string& argument : argv_) json.value(argument);
  json.end_array();
  json.field("run_id", run_id(options_));
  for (const OptionValue& option : options_)  // a replay has none: each of its files brings its own
    if (option.name == "seed") add_option(json, option);
  json.field("utc_start", utc_start_);
  json.field("utc_end", utc_end_);
  add_options(json, options_);
  if (summary != nullptr) add_result(json, *summary);
  add_build(json);
  add_machine(json, machine_, summary != nullptr ? &load_average_end_ : nullptr);
  add_columns(json);
  json.end_object();
  write_atomically(path_, json.text());
}

}  // namespace cleave
