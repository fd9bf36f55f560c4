// The cells of a campaign: every output directory at or below a directory, with the rows it measured.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "harness/files/manifest_reader.h"

namespace cleave {

struct MeasuredCell {
  std::string name;  // its path, beginning with the directory that was asked for
  std::filesystem::path directory;
};

// What tells an output directory: a manifest.json beside a steps.csv. By directory asked for, then by name;
// links to directories are not followed. Throws std::invalid_argument with one line naming what is wrong: a
// directory that is none or holds no cell, one that is asked for twice.
std::vector<MeasuredCell> find_measured_cells(std::span<const std::string> directories);

// Calls visit for each, in their order, with its manifest. Manifests are long: they are read on all cores, a
// few at a time, so that ten thousand take seconds and little memory. Throws what read_manifest does, when
// the cell's turn comes.
void visit_cells(std::span<const MeasuredCell> cells,
                 const std::function<void(const MeasuredCell& cell, const StoredManifest& manifest)>& visit);

struct MeasuredRow {
  std::string line;                // without its end
  std::vector<std::string> cells;  // one a column of columns()
  std::string place;               // "FILE: line 7"
};

// Calls visit for every row of the cell's steps.csv. Whatever the run did not come to write whole is left
// out: returns false then. A table of the same schema that lacks the last columns gets them, as nobody
// measured them. Throws std::invalid_argument naming the file where its columns are those of another schema,
// or its bytes not those of the checksums beside it, and the line where it has another number of cells.
bool visit_rows(const MeasuredCell& cell, const std::function<void(const MeasuredRow& row)>& visit);

}  // namespace cleave
