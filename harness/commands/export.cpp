// cleave export: a recorded problem, or parts of it, as files that other programs read.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "harness/base/names.h"
#include "harness/base/printable_text.h"
#include "harness/base/refusals.h"
#include "harness/commands/check_arguments.h"
#include "harness/commands/command.h"
#include "harness/commands/turned_problem.h"
#include "harness/commands/vtu_series.h"
#include "harness/experiment/friction.h"
#include "harness/experiment/problem_graph.h"
#include "harness/files/fclib_file.h"
#include "harness/files/fclib_problem.h"
#include "harness/files/matrix_market.h"
#include "harness/files/problem_file.h"
#include "harness/files/vtu_file.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

struct ExportOptions {
  std::vector<std::string> files;
  std::string format, out;
  std::optional<std::string> matrix, friction, partition;
  bool force = false;
};

// The partition that --partition names; none where it is not given.
const StoredPartition* asked_partition(const ProblemFile& file, const ExportOptions& options) {
  if (!options.partition) return nullptr;
  std::vector<std::string> labels;
  for (const auto& [label, partition] : file.partitions) labels.push_back(label);
  if (labels.empty())
    throw std::invalid_argument("--partition: " + options.files.front() +
                                " stores no partition; `cleave replay --write-solutions` stores one");
  check_name("--partition", *options.partition, labels);
  return &file.partitions.at(*options.partition);
}

// METIS 5.1 manual, graph file: "n edges 001", then a line a body with "neighbour weight" pairs, bodies
// counted from 1. 001: edges have weights, constraint rows; a body weighs METIS's own 1.
std::string metis_graph(const ProblemFile& file) {
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

// Its partition file: a line a body, the number of its part.
std::string metis_parts(const StoredPartition& partition) {
  std::string text;
  for (const int part : partition.part_of_body) text += std::to_string(part) + "\n";
  return text;
}

void write_metis(const ProblemFile& file, const ExportOptions& options) {
  const StoredPartition* partition = asked_partition(file, options);
  write_whole_file(options.out, partition != nullptr ? metis_parts(*partition) : metis_graph(file));
}

void write_matrix_market(const ProblemFile& file, const ExportOptions& options) {
  const auto matrix = std::ranges::find(matrices_of_problem(), *options.matrix, &MatrixOfProblem::name);
  write_whole_file(options.out, matrix->text(file.problem, asked_partition(file, options)));
}

void write_vtu(const ProblemFile& file, const ExportOptions& options) {
  write_whole_file(options.out, in_context(options.files.front(), [&] { return vtu_text(file); }));
}

// Boxes and cones are other problems than FCLIB's: they become Coulomb's law where that is asked for.
void write_fclib(const ProblemFile& file, const ExportOptions& options) {
  ProblemFile turned = file;
  turn_friction(options.files.front(), options.friction.value_or(""), turned);
  in_context(options.files.front() + ": cannot be an FCLIB problem",
             [&] { write_fclib_file(options.out, fclib_of_problem(turned.problem)); });
}

struct ExportFormat {
  const char* name;
  const char* help;
  void (*write)(const ProblemFile& file, const ExportOptions& options);
  bool has_matrix = false, has_friction = false,
       has_partition = false;  // takes --matrix, --friction, --partition
};

constexpr ExportFormat kFormats[] = {
    {"metis", "graph file of METIS, edges weighed in constraint rows; with --partition its partition file",
     write_metis, false, false, true},
    {"mtx", "Matrix Market file of --matrix", write_matrix_market, true, false, true},
    {"fclib", "FCLIB 3.1, HDF5, the global form", write_fclib, false, true, false},
    {"vtu", "bodies and contacts for ParaView; of several files a series, --out NAME.pvd", write_vtu, false,
     false, false}};

// A matrix is asked for where one is written, and nowhere else; a partition where it is of one.
void check_matrix(const ExportOptions& options, const ExportFormat& format) {
  const std::vector<std::string> names = names_of(matrices_of_problem());
  if (options.matrix.has_value() != format.has_matrix)
    throw std::invalid_argument(
        "--matrix: " + (format.has_matrix
                            ? "is required with --format mtx; choices: " + joined(names)
                            : "--format " + std::string(format.name) + " writes none; leave it out"));
  if (!format.has_matrix) return;
  check_name("--matrix", *options.matrix, names);
  const auto matrix = std::ranges::find(matrices_of_problem(), *options.matrix, &MatrixOfProblem::name);
  if (matrix->is_of_partition != options.partition.has_value())
    throw std::invalid_argument("--partition: --matrix " + *options.matrix +
                                (matrix->is_of_partition ? " is of one; name a label that the file stores"
                                                         : " is of none; leave it out"));
}

void check_partition(const ExportOptions& options, const ExportFormat& format) {
  if (options.partition && options.partition->empty())
    throw std::invalid_argument("--partition: '' is no label; name one that the file stores");
  if (options.partition && !format.has_partition)
    throw std::invalid_argument("--partition: --format " + std::string(format.name) +
                                " takes none; leave it out");
}

void check_friction(const ExportOptions& options, const ExportFormat& format) {
  if (!options.friction) return;
  if (!format.has_friction)
    throw std::invalid_argument("--friction: --format " + std::string(format.name) +
                                " has none; leave it out");
  check_name("--friction", *options.friction, recorded_friction_models());
}

const ExportFormat& read_format(const ExportOptions& options) {
  if (options.format.empty())
    throw std::invalid_argument("--format: is required; choices: " + joined(names_of(std::span(kFormats))));
  check_name("--format", options.format, names_of(std::span(kFormats)));
  const ExportFormat& format = *std::ranges::find(kFormats, options.format, &ExportFormat::name);
  check_partition(options, format);
  check_matrix(options, format);
  check_friction(options, format);
  return format;
}

// Whether it is a series that is asked for.
bool check_series(const ExportOptions& options, const ExportFormat& format) {
  const bool ends = options.out.ends_with(".pvd");
  if (format.write != write_vtu && options.files.size() > 1)
    throw std::invalid_argument("FILE: --format " + std::string(format.name) + " takes one, not " +
                                std::to_string(options.files.size()));
  if (options.files.size() > 1 && !ends)
    throw std::invalid_argument("--out: '" + options.out +
                                "' is one file; of several --format vtu writes NAME.pvd");
  return format.write == write_vtu && ends;
}

// A file of this name is whole.
int export_problem(const ExportOptions& options) {
  if (options.files.empty()) throw std::invalid_argument("FILE: a problem file is required");
  const ExportFormat& format = read_format(options);
  check_out_file(options.out, options.force);
  check_not_read(options.out, std::vector<fs::path>(options.files.begin(), options.files.end()));
  if (check_series(options, format)) return write_vtu_series(options.files, options.out, options.force);
  const ProblemFile file = read_problem_file_aloud(options.files.front());
  format.write(file, options);
  say(options.out + ": of " + std::to_string(file.problem.body_count()) + " bodies and " +
      std::to_string(file.problem.row_count()) + " constraint rows");
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
  app.add_option("files", options->files, "problem file; several with --format vtu")->type_name("FILE ...");
  app.add_option("--format", options->format, formats_help())->type_name("NAME");
  std::vector<std::string> matrices;
  for (const MatrixOfProblem& matrix : matrices_of_problem())
    matrices.push_back(std::string(matrix.name) + ": " + matrix.help);
  app.add_option("--matrix", options->matrix, "matrix to write with --format mtx; " + joined(matrices, "; "))
      ->type_name("NAME");
  app.add_option(
         "--friction", options->friction,
         "friction model to write with --format fclib, which knows coulomb; as recorded where not given")
      ->type_name("MODEL");
  app.add_option("--partition", options->partition,
                 "label of a partition that the file stores: of --matrix S, or what --format metis writes")
      ->type_name("LABEL");
  app.add_option("--out", options->out, "file to write")->type_name("PATH");
  app.add_flag("--force", options->force, "overwrite the file");
  return [options] { return export_problem(*options); };
}

}  // namespace cleave
