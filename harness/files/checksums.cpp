#include "harness/files/checksums.h"

#include <openssl/evp.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "harness/base/file_text.h"
#include "harness/files/whole_file.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 64;

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    check(context_ != nullptr && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(const void* bytes, std::size_t size) { check(EVP_DigestUpdate(context_.get(), bytes, size) == 1); }
  std::string digits() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> bytes;
    unsigned size = 0;
    check(EVP_DigestFinal_ex(context_.get(), bytes.data(), &size) == 1);
    std::string text;
    for (unsigned i = 0; i < size; ++i) {
      char pair[3];
      text.append(pair, std::snprintf(pair, sizeof pair, "%02x", bytes[i]));
    }
    return text;
  }

 private:
  static void check(bool done) {
    if (!done) throw std::runtime_error("libcrypto gives no SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

bool is_digits(const std::string& text) {
  return text.size() == kDigits && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

std::string sha256_of(const fs::path& path) {
  const std::unique_ptr<std::FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw std::runtime_error(path.string() + ": cannot be read: " + std::strerror(errno));
  Sha256 sum;
  std::array<char, 65536> bytes;
  while (const std::size_t size = std::fread(bytes.data(), 1, bytes.size(), file.get()))
    sum.add(bytes.data(), size);
  if (std::ferror(file.get()))
    throw std::runtime_error(path.string() + ": cannot be read: " + std::strerror(errno));
  return sum.digits();
}

std::string sha256_of_bytes(std::string_view bytes) {
  Sha256 sum;
  sum.add(bytes.data(), bytes.size());
  return sum.digits();
}

std::string checksum_line(const std::string& digits, const std::string& name) {
  return digits + "  " + name + "\n";
}

void write_checksums(const fs::path& directory, const std::vector<std::string>& names) {
  std::string lines;
  for (const std::string& name : names) {
    if (name == kChecksumsFile || !fs::exists(directory / name)) continue;
    sync_file(directory / name);  // or a directory that looks finished may not be, after the power fails
    lines += checksum_line(sha256_of(directory / name), name);
  }
  write_whole_file(directory / kChecksumsFile, lines);
}

std::map<std::string, std::string> read_checksums(const fs::path& directory) {
  return read_checksum_list(directory / kChecksumsFile);
}

std::map<std::string, std::string> read_checksum_list(const fs::path& path) {
  const std::optional<std::string> all = file_text(path);
  if (!all || all->empty()) throw std::invalid_argument(path.string() + ": cannot be read or is empty");
  std::map<std::string, std::string> sums;
  std::istringstream lines(*all);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto reject = [&](const char* reason) {
      throw std::invalid_argument(path.string() + ": line " + std::to_string(number) + " " + reason);
    };
    ++number;
    const std::string digits = line.substr(0, kDigits);
    if (lines.eof() || !is_digits(digits) || line.substr(kDigits, 2) != "  ")
      reject("is not 64 hexadecimal digits, two spaces, a name and a line end");
    const fs::path name = line.substr(kDigits + 2);
    if (name.empty() || name != name.filename() || name == "." || name == "..")
      reject("names no file of the directory");
    if (!sums.emplace(name.string(), digits).second) reject("names its file for the second time");
  }
  return sums;
}

bool is_as_listed(const fs::path& directory, const std::map<std::string, std::string>& sums,
                  const std::string& name) {
  const auto sum = sums.find(name);
  return sum != sums.end() && sum->second == sha256_of(directory / name);
}

}  // namespace cleave
