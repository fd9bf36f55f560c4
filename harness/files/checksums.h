// The file `checksums` of an output directory: SHA-256 of every other file, a line each, as sha256sum writes
// it, so that `sha256sum -c checksums` checks them too. Written last: a directory without it was not
// finished.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace cleave {

inline constexpr const char* kChecksumsFile = "checksums";

// 64 hexadecimal digits. Throws std::runtime_error naming the file and the reason when it cannot be read.
std::string sha256_of(const std::filesystem::path& path);
std::string sha256_of_bytes(std::string_view bytes);

// A line of such a file.
std::string checksum_line(const std::string& digits, const std::string& name);

// Of those of the names that are there. The same errors, and those of whole_file.h.
void write_checksums(const std::filesystem::path& directory, const std::vector<std::string>& names);

// Digits by name. Throws std::invalid_argument naming the file and the line that has another form, names a
// file outside the directory, or names one for the second time.
std::map<std::string, std::string> read_checksums(const std::filesystem::path& directory);

// The same of a list under another name, of files beside it.
std::map<std::string, std::string> read_checksum_list(const std::filesystem::path& list);

// Whether the file of that name is in these digits by name, and has them.
bool is_as_listed(const std::filesystem::path& directory, const std::map<std::string, std::string>& sums,
                  const std::string& name);

}  // namespace cleave
