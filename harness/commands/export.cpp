// cleave export: the body graph of a recorded problem as a file that other programs read.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/printable_text.h"
#include "harness/commands/command.h"
#include "harness/experiment/problem_graph.h"
#include "harness/files/problem_file.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::string file, format, out;
  bool force = false;
};

// METIS 5.1 manual, graph file: "n edges 001", then a line a body with "neighbour weight" pairs, bodies
// counted from 1. 001: edges have weights, constraint rows; a body weighs METIS's own 1.
std::string metis_text(const BodyGraph& graph) {
  std::ostringstream text;
  text << graph.body_count() << " " << graph.edge_count() << " 001\n";
  for (int body = 0; body < graph.body_count(); ++body) {
    const char* space = "";
    for (int edge = graph.first(body); edge < graph.last(body); ++edge, space = " ")
      text << space << graph.neighbour(edge) + 1 << " " << graph.weight(edge, EdgeWeight::rows);
    text << "\n";
  }
  return text.str();
}

struct ExportFormat {
  const char* name;
  const char* help;
  std::string (*text)(const BodyGraph& graph);
};

constexpr ExportFormat kFormats[] = {
    {"metis", "graph file of METIS, edges weighed in constraint rows", metis_text}};

// A file of this name is whole.
int export_graph(const ExportOptions& options) {
  if (options.file.empty()) throw std::invalid_argument("FILE: a problem file is required");
  if (options.format.empty())
    throw std::invalid_argument("--format: is required; choices: " + joined(names_of(std::span(kFormats))));
  check_name("--format", options.format, names_of(std::span(kFormats)));
  if (options.out.empty()) throw std::invalid_argument("--out: is required: the file to write");
  if (fs::exists(options.out) && !options.force)
    throw std::invalid_argument("--out: " + options.out + " exists; name another file or give --force");
  const ProblemFile file = read_problem_file_aloud(options.file);
  const BodyGraph graph = body_graph_of(file.problem, file.step);
  for (const ExportFormat& format : kFormats)
    if (options.format == format.name) write_whole_file(options.out, format.text(graph));
  say(options.out + ": " + std::to_string(graph.body_count()) + " bodies, " +
      std::to_string(graph.edge_count()) + " edges");
  return kExitOk;
}

std::string formats_help() {
  std::vector<std::string> lines;
  for (const ExportFormat& format : kFormats) lines.push_back(std::string(format.name) + ": " + format.help);
  return joined(lines, "; ");
}

}  // namespace

std::function<int()> declare_export(CLI::App& app, const std::vector<std::string>&) {
  const auto options = std::make_shared<ExportOptions>();
  app.add_option("file", options->file, "problem file")->type_name("FILE");
  app.add_option("--format", options->format, formats_help())->type_name("NAME");
  app.add_option("--out", options->out, "file to write")->type_name("PATH");
  app.add_flag("--force", options->force, "overwrite the file");
  return [options] { return export_graph(*options); };
}

}  // namespace cleave
