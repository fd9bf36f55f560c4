// cleave export: the body graph or a matrix of a recorded problem as a file that other programs read.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/printable_text.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/experiment/problem_graph.h"
#include "harness/files/matrix_market.h"
#include "harness/files/problem_file.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

struct ExportOptions {
  std::string file, format, out;
  std::optional<std::string> matrix;
  bool force = false;
};

// METIS 5.1 manual, graph file: "n edges 001", then a line a body with "neighbour weight" pairs, bodies
// counted from 1. 001: edges have weights, constraint rows; a body weighs METIS's own 1.
std::string metis_text(const ProblemFile& file, const ExportOptions&) {
  const BodyGraph graph = body_graph_of(file.problem, file.step);
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

std::string matrix_market_text(const ProblemFile& file, const ExportOptions& options) {
  for (const MatrixOfProblem& matrix : matrices_of_problem())
    if (options.matrix == matrix.name) return matrix.text(file.problem);
  return {};
}

struct ExportFormat {
  const char* name;
  const char* help;
  std::string (*text)(const ProblemFile& file, const ExportOptions& options);
  bool has_matrix;  // takes --matrix
};

constexpr ExportFormat kFormats[] = {
    {"metis", "graph file of METIS, edges weighed in constraint rows", metis_text, false},
    {"mtx", "Matrix Market file of --matrix", matrix_market_text, true}};

// A matrix is asked for where one is written, and nowhere else.
void check_matrix(const ExportOptions& options, const ExportFormat& format) {
  const std::vector<std::string> names = names_of(matrices_of_problem());
  if (!format.has_matrix && options.matrix)
    throw std::invalid_argument("--matrix: --format " + std::string(format.name) + " has none; leave it out");
  if (format.has_matrix && !options.matrix)
    throw std::invalid_argument("--matrix: is required with --format " + std::string(format.name) +
                                "; choices: " + joined(names));
  if (format.has_matrix) check_name("--matrix", *options.matrix, names);
}

const ExportFormat& read_format(const ExportOptions& options) {
  if (options.format.empty())
    throw std::invalid_argument("--format: is required; choices: " + joined(names_of(std::span(kFormats))));
  check_name("--format", options.format, names_of(std::span(kFormats)));
  const ExportFormat& format = *std::ranges::find(kFormats, options.format, &ExportFormat::name);
  check_matrix(options, format);
  return format;
}

// A file of this name is whole.
int export_problem(const ExportOptions& options) {
  if (options.file.empty()) throw std::invalid_argument("FILE: a problem file is required");
  const ExportFormat& format = read_format(options);
  check_out_file(options.out, options.force);
  const ProblemFile file = read_problem_file_aloud(options.file);
  write_whole_file(options.out, format.text(file, options));
  const BodyGraph graph = body_graph_of(file.problem, file.step);
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
  std::vector<std::string> matrices;
  for (const MatrixOfProblem& matrix : matrices_of_problem())
    matrices.push_back(std::string(matrix.name) + ": " + matrix.help);
  app.add_option("--matrix", options->matrix, "matrix to write with --format mtx; " + joined(matrices, "; "))
      ->type_name("NAME");
  app.add_option("--out", options->out, "file to write")->type_name("PATH");
  app.add_flag("--force", options->force, "overwrite the file");
  return [options] { return export_problem(*options); };
}

}  // namespace cleave
