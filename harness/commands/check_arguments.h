// What the parser would take without a word, refused.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace cleave {

// arguments: those after the command's name. Throws std::invalid_argument with one line for an option that is
// given twice, a flag with a value (--cold=2), an option without one (--mu=, or --out before another option)
// and an empty argument where no option takes it. What the command does not know is left to the parser.
void check_arguments(const CLI::App& command, std::span<const std::string> arguments);

// --out of a command that writes one file: throws where it is empty, where there is no such directory, and
// where a file of that name exists and --force is not given, or anything else that is no regular file.
void check_out_file(const std::string& out, bool force);

// Throws where the file to write, which may be overwritten, is one of those that are read.
void check_not_read(const std::string& out, std::span<const std::filesystem::path> read);

// --out of a command that writes the directory of a run: as check_output_directory, and no campaign may be
// there.
void check_run_directory(const std::string& out, bool force, const std::vector<std::string>& files);

// After parsing: throws for what `app` could not place, naming the nearest option.
void reject_extras(const CLI::App& app);

}  // namespace cleave
