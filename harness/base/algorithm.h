// A row of a registry, and an algorithm as a user names it: name@parameter=value@parameter=value.
//
// Several settings of one algorithm can stand side by side on the same problems:
//     --partitioner mindp@max-bodies=25,mindp@max-bodies=50
// Tables and figures show the text as it was given.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/base/parameter.h"

namespace cleave {

// What every registry row begins with.
struct AlgorithmEntry {
  const char* name;
  const char* help;       // one line
  const char* reference;  // where it is described
  std::vector<Parameter> parameters = {};
  // Of an algorithm that reads files, null for all others: reads and checks what its parameters name and
  // returns a fingerprint of the content, which stands in texts and run ids where a path would. Throws
  // std::invalid_argument with one line that begins with the file.
  std::string (*content)(const Settings& settings) = nullptr;
  // Of an algorithm of a library that was not there when this was built: what to do about it, "install
  // libscotch-dev and build again". Such a row is listed and cannot be made.
  std::string unavailable = {};
};

// The row of that name, or nullptr.
template <class Row>
const Row* find_row(std::span<const Row> table, std::string_view name) {
  const auto found =
      std::ranges::find(table, name, [](const Row& row) { return std::string_view(row.name); });
  return found == table.end() ? nullptr : &*found;
}

bool has_parameter(const AlgorithmEntry& entry, const std::string& name);

// "is not in this build: install libscotch-dev and build again"; empty for a row that is available.
std::string unavailable_text(const AlgorithmEntry& entry);

// Throws std::invalid_argument with one line for a row that is unavailable. option: what it begins with.
void check_available(const std::string& option, const AlgorithmEntry& entry);

// An algorithm with a value for each of its parameters.
struct Algorithm {
  std::string text;  // what tables show: the text as given, or with a fingerprint in place of a file's name
  std::string name;  // of its row
  Settings settings;
};

// Who has a parameter, in words ("partitioner mr"), for errors; empty: nobody.
using ParameterOwners = std::function<std::string(const std::string& parameter)>;

// Why a list's `all` leaves a row out, in words ("needs path"); empty: it does not. An algorithm of a library
// that this build lacks, or one with a parameter without default that nobody gave; a file is that of one
// algorithm and given for no other.
std::string reason_to_leave_out(const AlgorithmEntry& entry,
                                const std::map<std::string, std::string>& common);

// The part before the first @.
std::string algorithm_name(const std::string& text);

// Whether the text says a value of this parameter itself, as mindp@max-bodies=10 does.
bool names_parameter(const std::string& text, const std::string& name);

// Reads the text against the parameters of its algorithm; what it does not give comes from `common` and then
// from the defaults. In the text that is kept a file of kind content is its fingerprint. option: what errors
// begin with ("--partitioner"). Throws std::invalid_argument with one line for a text of another form, a
// parameter that the algorithm does not have (naming who has it), a value that is not allowed, and a
// parameter without default that is given nowhere.
Algorithm read_algorithm(const std::string& option, const std::string& text,
                         std::span<const Parameter> parameters,
                         const std::map<std::string, std::string>& common, const ParameterOwners& owners);

// "file@path=a/b.txt@x=1" as "file@1f2e3d4c5b6a7988@x=1": equal contents are one algorithm, wherever they
// lie.
std::string text_with_content(const std::string& text, std::span<const Parameter> parameters,
                              const std::string& fingerprint);

// The fingerprint of such a text; empty where it has none.
std::string fingerprint_of(const std::string& text);

// The defaults of all parameters that have one.
Settings defaults_of(const AlgorithmEntry& entry);

}  // namespace cleave
