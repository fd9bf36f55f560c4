// What `cleave verify` finds out about steps.csv.
#pragma once

#include <filesystem>

#include "harness/commands/check_list.h"
#include "harness/files/manifest_reader.h"

namespace cleave {

// It has the columns and the rows that the manifest promises, with its options in them; its cells agree with
// each other and with the counts of the manifest; every row that says ok lies within the judge's limit by its
// own numbers. Rows of record and replay agree with what is computed anew from their problem file
// (verify_file_rows.h). results/README.md names the columns.
void check_steps_table(const std::filesystem::path& directory, const StoredManifest& manifest,
                       CheckList& list);

}  // namespace cleave
