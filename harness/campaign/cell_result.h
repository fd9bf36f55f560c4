// What became of a cell, as its output directory or its process says.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "harness/campaign/campaign_index.h"
#include "harness/campaign/cell_process.h"
#include "harness/campaign/spec.h"
#include "harness/files/manifest_reader.h"

namespace cleave {

// What the spec says of the cell; nothing has become of it yet.
IndexRow pending_row(const CampaignCell& cell, int number);

// What the manifest in the directory of a cell that has ended says of it, into the row; the status only where
// the run came to its end. Throws std::invalid_argument or std::runtime_error for files that cannot be read.
void take_result(const std::filesystem::path& directory, const StoredManifest& manifest, IndexRow& row);

// The same, and the manifest, where a complete run of that run id is there, whichever build made it; else the
// row is of no use.
std::optional<StoredManifest> take_if_complete(const std::filesystem::path& out, IndexRow& row);

// Of its process, or of the run where that is not known.
double seconds_of(const IndexRow& row);

// The row of a cell whose run is complete, with these options and this build; nothing where it is another
// one's, half done or not there. round and number are not its own to say.
std::optional<IndexRow> complete_row(const std::filesystem::path& out, const CampaignCell& cell, int number,
                                     const std::string& build);

// Where the log of a cell that failed lies.
std::filesystem::path log_path(const std::filesystem::path& out, const IndexRow& row);

// Of a row's two files that stand for its cell, checksums and log, the first that is not as the row says;
// nothing where both are.
std::optional<std::filesystem::path> changed_file(const std::filesystem::path& out, const IndexRow& row);

// Whether an index may be believed about a cell that has ended: the checksums in its directory, which vouch
// for all else there, and its log are those of the row.
bool still_stands(const std::filesystem::path& out, const IndexRow& row);

// Status and reason of a cell that did not come to its end: timeout where limit_s says that it was ended for
// that, out_of_memory, refused where it had not even begun, else crashed. The row has what its manifest says.
void take_failure(const CellEnd& end, std::optional<double> limit_s, IndexRow& row);

}  // namespace cleave
