#include "harness/files/manifest.h"

#include <sstream>

#include "harness/files/checksums.h"
#include "harness/files/json_writer.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

void add_option(JsonWriter& json, const OptionValue& option) {
  if (option.kind == OptionKind::text) {
    json.field(option.name, option.text);
  } else if (option.kind == OptionKind::lines) {
    json.begin_array(option.name);
    std::istringstream lines(option.text);
    for (std::string line; std::getline(lines, line);) json.value(line);
    json.end_array();
  } else {
    // Numbers and truth values already read as JSON; a number that was not given is null.
    json.field(option.name, JsonLiteral{option.text == "nan" || option.text.empty() ? "null" : option.text});
  }
}

void add_options(JsonWriter& json, const std::vector<OptionValue>& options) {
  json.begin_object("options");
  for (const OptionValue& option : options) add_option(json, option);
  json.end_object();
  json.begin_object("option_about");
  for (const OptionValue& option : options) json.field(option.name, to_string(option.about));
  json.end_object();
}

void add_values(JsonWriter& json, const char* name, const std::map<std::string, std::string>& values) {
  json.begin_object(name);
  for (const auto& [key, value] : values) json.field(key, value);
  json.end_object();
}

void add_algorithms(JsonWriter& json, const std::vector<NamedAlgorithm>& algorithms) {
  json.begin_array("algorithms");
  for (const NamedAlgorithm& algorithm : algorithms) {
    json.begin_object();
    json.field("kind", algorithm.kind);
    json.field("text", algorithm.text);
    json.field("name", algorithm.name);
    add_values(json, "parameters", algorithm.parameters);
    add_values(json, "defaults", algorithm.defaults);
    json.end_object();
  }
  json.end_array();
}

void add_build(JsonWriter& json, const std::vector<std::pair<std::string, std::string>>& more_libraries) {
  const BuildInfo build = build_info();
  json.begin_object("build");
  json.field("version", build.version);
  json.field("git_hash", build.git_hash);
  json.field("git_dirty", build.git_dirty);
  json.field("compiler", build.compiler);
  json.field("flags", build.flags);
  json.field("build_type", build.build_type);
  json.field("build_id", build.build_id);
  json.begin_object("libraries");
  for (const auto& [name, version] : more_libraries) json.field(name, version);
  for (const auto& [name, version] : library_versions()) json.field(name, version);
  json.end_object();
  json.end_object();
}

void add_load(JsonWriter& json, const char* name, const std::array<double, 3>& load_average) {
  json.begin_array(name);
  for (const double load : load_average) json.value(load);
  json.end_array();
}

// Charged by the columns t_s_model_p*_ms.
void add_dispatch(JsonWriter& json, const DispatchCost& dispatch) {
  json.begin_object("dispatch");
  json.field("timing_us", dispatch.timing_us);
  json.field("task_us", dispatch.task_us);
  json.field("graph_task_us", dispatch.graph_task_us);
  json.field("stage_us", dispatch.stage_us);
  json.end_object();
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
  add_dispatch(json, machine.dispatch);
  json.end_object();
}

void add_result(JsonWriter& json, const WorkResult& result) {
  json.begin_object("result");
  for (const auto& [name, value] : result.counts) json.field(name, value);
  json.end_object();
}

void add_columns(JsonWriter& json, const std::vector<Column>& columns) {
  json.begin_array("columns");
  for (const Column& column : columns) {
    json.begin_object();
    json.field("name", column.name);
    json.field("help", column.help);
    json.field("machine", JsonLiteral{column.machine ? "true" : "false"});
    json.field("about", to_string(column.about));
    json.end_object();
  }
  json.end_array();
}

}  // namespace

Manifest::Manifest(std::filesystem::path path, WorkDescription description)
    : path_(std::move(path)), description_(std::move(description)) {}

void Manifest::around(const std::function<WorkResult()>& work) {
  write_start();
  WorkResult result;
  try {
    result = work();
  } catch (const std::exception& error) {
    // What went wrong first is what the user has to know, also where the disk that is full takes no manifest
    // either.
    try {
      write_end("failed", result, error.what());
    } catch (const std::exception&) {
    }
    throw;
  }
  write_end(result.interrupted ? "interrupted" : "complete", result, "");
}

// A disk that takes no second file leaves room for another word in the first.
void Manifest::write_end(const std::string& state, const WorkResult& result, const std::string& message) {
  utc_end_ = utc_now();
  load_average_end_ = load_average();
  try {
    write(state, &result, message);
  } catch (const std::exception&) {
    replace_in_place(path_, R"("state": "running")", R"("state": "failed" )");
    throw;
  }
}

void Manifest::write_start() {
  utc_start_ = utc_now();
  machine_ = machine_info();
  write("running", nullptr, "");
}

void Manifest::write(const std::string& state, const WorkResult* result, const std::string& message) const {
  JsonWriter json;
  json.begin_object();
  json.field("schema", kManifestSchema);
  json.field("state", state);
  if (!message.empty()) json.field("message", message);
  json.field("command", description_.command);
  json.begin_array("argv");
  for (const std::string& argument : description_.argv) json.value(argument);
  json.end_array();
  json.field("run_id", description_.run_id);
  for (const OptionValue& option :
       description_.options)  // a replay has none: each of its files brings its own
    if (option.name == "seed") add_option(json, option);
  json.begin_array("files");
  for (const std::string& file : description_.files) json.value(file);
  json.value(kManifestFile);
  json.value(kChecksumsFile);
  json.end_array();
  json.field("utc_start", utc_start_);
  json.field("utc_end", utc_end_);
  add_options(json, description_.options);
  add_algorithms(json, description_.algorithms);
  if (result != nullptr) add_result(json, *result);
  add_build(json, description_.libraries);
  json.field("memory_limit_gb", description_.memory_limit_gb);
  add_machine(json, machine_, result != nullptr ? &load_average_end_ : nullptr);
  json.field("steps_schema", description_.steps_schema);
  add_columns(json, description_.columns);
  json.end_object();
  write_whole_file(path_, json.text());
}

}  // namespace cleave
