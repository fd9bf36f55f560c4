#include "partition/calibration.h"

#include <algorithm>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "harness/base/file_text.h"
#include "harness/base/hash.h"
#include "harness/base/names.h"
#include "harness/base/numbers.h"
#include "partition/parameters.h"
#include "partition/refuse.h"

namespace cleave {

extern const char* const kShippedCalibration;  // calibration.toml

namespace {

constexpr const char* kSchema = "cleave-calibration-4";
constexpr const char* kThreads = ".threads-";
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Range kAtLeastZero{0, kInfinity}, kAnyNumber{-kInfinity, kInfinity};

// Every number of a section, in the order of the lines.
template <class Cost, class Visitor>
void visit_numbers(Cost& cost, Visitor&& visit) {
  visit("factorizations_constant", cost.factorizations.constant, kAnyNumber);
  visit("factorizations_per_log_body", cost.factorizations.per_log_body, kAnyNumber);
  visit("factorizations_per_degree", cost.factorizations.per_degree, kAnyNumber);
  visit("factorizations_per_mass_spread", cost.factorizations.per_mass_spread, kAnyNumber);
  visit("factorizations_per_fixed_row", cost.factorizations.per_fixed_row, kAnyNumber);
  visit("factorizations_most", cost.factorizations.most, Range{1, kInfinity});
  visit("active_share_constant", cost.active_share.constant, kAnyNumber);
  visit("active_share_per_log_degree", cost.active_share.per_log_degree, kAnyNumber);
  visit("active_share_per_constraint", cost.active_share.per_constraint, kAnyNumber);
  for (int t = 0; t < kCostTerms; ++t) visit(cost_terms()[t].name, cost.cost[t], kAtLeastZero);
}

// A string of TOML.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '"' || c == '\\') safe += '\\';
    safe += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return '"' + safe + '"';
}

std::string section_of(const KernelCost& cost) {
  return cost_kernel_names()[static_cast<int>(cost.kernel)] + (kThreads + std::to_string(cost.threads));
}

class Reader {
 public:
  Reader(const std::string& source, const std::string& text) : source_(source), lines_(text) {}

  std::vector<KernelCost> run() {
    std::string line;
    while (std::getline(lines_, line)) {
      ++number_;
      if (line.empty() || line.front() == '#') continue;
      if (line.front() == '[') {
        end_section();
        begin_section(line);
      } else {
        read_assignment(line);
      }
    }
    end_section();
    if (!has_schema_) fail("is no calibration: schema = \"" + std::string(kSchema) + "\" is missing");
    if (kernels_.empty()) fail("has no kernel");
    return std::move(kernels_);
  }

 private:
  [[noreturn]] void fail(const std::string& text) const { throw std::invalid_argument(source_ + " " + text); }
  [[noreturn]] void fail_line(const std::string& text) const {
    throw std::invalid_argument(source_ + ": line " + std::to_string(number_) + ": " + text);
  }

  void begin_section(const std::string& line) {
    const std::size_t dot = line.find(kThreads);
    if (dot == std::string::npos || line.back() != ']')
      fail_line("'" + line + "', allowed: [KERNEL" + kThreads + "N]");
    const std::string place = source_ + ": line " + std::to_string(number_);
    const std::string kernel = line.substr(1, dot - 1);
    const std::vector<std::string> names(cost_kernel_names().begin(), cost_kernel_names().end());
    check_name(place, kernel, names);
    const std::size_t from = dot + std::string(kThreads).size();
    KernelCost cost;
    cost.kernel = static_cast<CostKernel>(std::ranges::find(names, kernel) - names.begin());
    cost.threads = parse_integer(place, line.substr(from, line.size() - 1 - from), {1, 1 << 16});
    for (const KernelCost& other : kernels_)
      if (section_of(other) == section_of(cost)) fail_line(line + " stands twice");
    kernels_.push_back(cost);
    given_.clear();
  }

  void read_assignment(const std::string& line) {
    const std::size_t equals = line.find(" = ");
    if (equals == std::string::npos) fail_line("'" + line + "', allowed: name = value");
    const std::string name = line.substr(0, equals), value = line.substr(equals + 3);
    if (kernels_.empty()) {
      if (name == "schema" && value != '"' + std::string(kSchema) + '"')
        fail_line("schema is " + value + ", allowed: \"" + kSchema + "\"");
      has_schema_ |= name == "schema";
      return;
    }
    const std::string place = source_ + ": line " + std::to_string(number_) + ": " + name;
    std::vector<std::string> names;
    bool found = false;
    visit_numbers(kernels_.back(), [&](const char* field, double& number, const Range& range) {
      names.push_back(field);
      if (name != field) return;
      number = parse_number(place, value, range);
      found = true;
    });
    if (!found) check_name(source_ + ": line " + std::to_string(number_), name, names);
    if (!given_.emplace(name, value).second) fail_line(name + " stands twice");
  }

  void end_section() {
    if (kernels_.empty()) return;
    visit_numbers(kernels_.back(), [&](const char* field, double&, const Range&) {
      if (!given_.contains(field))
        fail("lacks " + std::string(field) + " of [" + section_of(kernels_.back()) + "]");
    });
  }

  const std::string& source_;
  std::istringstream lines_;
  int number_ = 0;
  bool has_schema_ = false;
  std::map<std::string, std::string> given_;  // of the section at hand
  std::vector<KernelCost> kernels_;
};

std::string whole_text(const std::string& option, const std::string& path) {
  std::optional<std::string> text = file_text(path);
  if (!text)
    throw std::invalid_argument(option + ": '" + path +
                                "' cannot be read; allowed: shipped, or a file of cleave calibrate");
  return *std::move(text);
}

bool is_fingerprint(const std::string& text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

struct Known {
  std::mutex mutex;
  std::map<std::string, Calibration> calibrations;  // never taken out

  const Calibration& add(Calibration calibration) {
    const std::scoped_lock lock(mutex);
    return calibrations.emplace(calibration.fingerprint, std::move(calibration)).first->second;
  }
};

Known& known() {
  static Known all;
  return all;
}

const Calibration& shipped() {
  static const Calibration& calibration =
      known().add(parse_calibration("the shipped calibration", kShippedCalibration));
  return calibration;
}

}  // namespace

KernelCost Calibration::of(CostKernel kernel, int threads) const {
  const KernelCost* best = nullptr;
  for (const KernelCost& cost : kernels)
    if (cost.kernel == kernel && cost.threads <= threads && (!best || cost.threads > best->threads))
      best = &cost;
  if (best == nullptr)
    throw std::invalid_argument("calibration " + fingerprint + " has no " +
                                cost_kernel_names()[static_cast<int>(kernel)] + " on " +
                                std::to_string(threads) + " threads");
  KernelCost cost = *best;
  cost.threads = threads;
  return cost;
}

std::string calibration_text(const std::vector<std::pair<std::string, std::string>>& about,
                             const std::vector<KernelCost>& kernels) {
  std::string text = "schema = \"" + std::string(kSchema) + "\"\n";
  for (const auto& [name, value] : about) text += name + " = " + quoted(value) + "\n";
  for (const KernelCost& cost : kernels) {
    text += "\n[" + section_of(cost) + "]\n";
    visit_numbers(cost, [&](const char* name, double number, const Range&) {
      text += std::string(name) + " = " + number_text(number) + "\n";
    });
  }
  return text;
}

Calibration parse_calibration(const std::string& source, const std::string& text) {
  Fnv1a64 hash;
  hash.add(text);
  return {hex(hash.value()), Reader(source, text).run()};
}

std::string read_calibration(const std::string& option, const std::string& text) {
  if (text == "shipped") return shipped().fingerprint;
  if (is_fingerprint(text)) return text;
  return known().add(parse_calibration(option + ": " + text, whole_text(option, text))).fingerprint;
}

bool is_known_calibration(const std::string& fingerprint) {
  shipped();  // which is known from then on
  const std::scoped_lock lock(known().mutex);
  return known().calibrations.contains(fingerprint);
}

const Calibration& known_calibration(const std::string& fingerprint) {
  if (!is_known_calibration(fingerprint))
    throw std::invalid_argument("calibration: " + fingerprint + " is not the shipped one, " +
                                shipped().fingerprint + "; name its file: --calibration FILE");
  const std::scoped_lock lock(known().mutex);
  return known().calibrations.at(fingerprint);
}

std::vector<KernelCost> kernel_costs(const Settings& settings) {
  const Calibration& calibration = known_calibration(settings.text("calibration"));
  const std::string& kernel = settings.text(parameters::cost_kernel().name);
  std::vector<KernelCost> costs;
  for (std::size_t k = 0; k < cost_kernel_names().size(); ++k)
    if (kernel == parameters::kAnyKernel || kernel == cost_kernel_names()[k])
      costs.push_back(calibration.of(static_cast<CostKernel>(k), settings.integer("cost-threads")));
  return costs;
}

KernelCost kernel_cost(const Settings& settings) {
  const std::string& kernel = settings.text(parameters::cost_kernel().name);
  if (kernel == parameters::kAnyKernel)
    refuse("--cost-kernel", kernel, "one kernel; only auto chooses among all");
  return kernel_costs(settings).front();
}

}  // namespace cleave
