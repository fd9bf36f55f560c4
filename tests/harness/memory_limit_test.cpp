// --memory-limit: a factorisation that will not fit is a row that says so, and the limit that held is written
// down.
#include "harness/experiment/memory_limit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "solver/memory_count.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& text) {
  fs::create_directories(path.parent_path());
  std::ofstream(path) << text;
}

TEST(MemoryLimit, IsTheLeastThatIsLeft) {
  const TemporaryDirectory directory;
  const fs::path root = directory / "";
  EXPECT_EQ(available_memory_bytes(root), kNoMemoryLimit);
  write(root / "proc/meminfo", "MemTotal:  9000 kB\nMemFree: 1 kB\nMemAvailable:   4000 kB\nBuffers: 7 kB\n");
  EXPECT_EQ(available_memory_bytes(root), 4'096'000u);
  write(root / "proc/self/cgroup", "1:name=systemd:/other\n0::/outer/inner\n");
  write(root / "sys/fs/cgroup/outer/inner/memory.max", "max\n");
  EXPECT_EQ(available_memory_bytes(root), 4'096'000u);
  write(root / "sys/fs/cgroup/outer/memory.max", "3000000\n");
  write(root / "sys/fs/cgroup/outer/memory.current", "1200000\n");
  EXPECT_EQ(available_memory_bytes(root), 1'800'000u);
  write(root / "sys/fs/cgroup/outer/memory.stat", "anon 5\ninactive_file 200000\nfile 9\n");
  EXPECT_EQ(available_memory_bytes(root), 2'000'000u);
  write(root / "sys/fs/cgroup/outer/inner/memory.max", "1000\n");
  write(root / "sys/fs/cgroup/outer/inner/memory.current", "2000\n");
  EXPECT_EQ(available_memory_bytes(root), 0u);
}

TEST(MemoryLimit, GivenInBillionsOfBytes) {
  EXPECT_EQ(memory_limit_bytes(0.7), 700'000'000u);
  EXPECT_EQ(memory_limit_bytes(1e30), kNoMemoryLimit);
  const std::uint64_t found = memory_limit_bytes(std::numeric_limits<double>::quiet_NaN());
  EXPECT_GT(found, 1'000'000u);
  EXPECT_LT(found, kNoMemoryLimit);
}

struct Refusal {
  ProgramResult result;
  CsvTable table;
  std::string manifest;
};

Refusal run(const std::string& before, const std::string& options) {
  const TemporaryDirectory directory;
  const std::string out = directory / "out";
  const std::string command = before + "OPENBLAS_NUM_THREADS=1 exec " + CLEAVE_PROGRAM +
                              " run --scene rock_pile --steps 1 --advance pgs --repeats 1 " + options +
                              " --out " + out;
  Refusal refusal;
  refusal.result = run_program("/bin/bash", {"-c", command});
  refusal.table = read_csv(directory / "out/steps.csv");
  refusal.manifest = read_text(directory / "out/manifest.json");
  return refusal;
}

double predicted_mb(const CsvTable& table, std::size_t row) {
  return std::strtod(table.at(row, "factor_predicted_mb").c_str(), nullptr);
}

TEST(MemoryLimit, DecidesRowByRow) {
  const std::string options = "--bodies 120 --partitioner mindp --refiner fm --solver schur,exact,dense,pgs";
  const Refusal free = run("", options + " --memory-limit 50");
  ASSERT_EQ(free.table.rows.size(), 4u) << free.result.err;
  for (const std::size_t row : {0u, 1u, 2u}) {
    EXPECT_EQ(free.table.at(row, "status"), "ok");
    EXPECT_GT(predicted_mb(free.table, row), 0.1);
  }
  EXPECT_EQ(free.table.at(3, "factor_predicted_mb"), "nan");
  EXPECT_NE(free.manifest.find("\"memory_limit_gb\": 50"), std::string::npos) << free.manifest;

  const double exact_mb = predicted_mb(free.table, 1), dense_mb = predicted_mb(free.table, 2);
  ASSERT_LT(exact_mb, dense_mb);
  const Refusal tight =
      run("", options + " --memory-limit " + std::to_string(0.5e-3 * (exact_mb + dense_mb)));
  EXPECT_EQ(tight.result.exit_code, 2);
  ASSERT_EQ(tight.table.rows.size(), 4u) << tight.result.err;
  EXPECT_EQ(tight.table.at(1, "status"), "ok");
  EXPECT_EQ(tight.table.at(1, "solution_hash"), free.table.at(1, "solution_hash"));
  EXPECT_EQ(tight.table.at(1, "run_id"), free.table.at(1, "run_id"));
  EXPECT_EQ(tight.table.at(2, "status"), "out_of_memory");
  EXPECT_EQ(tight.table.at(2, "t_s_ms"), "nan");
  EXPECT_EQ(tight.table.at(2, "factor_predicted_mb"), free.table.at(2, "factor_predicted_mb"));
  const std::string& reason = tight.table.at(2, "status_reason");
  EXPECT_TRUE(reason.starts_with("the factorisation needs ")) << reason;
  EXPECT_NE(reason.find(" MB, the limit is "), std::string::npos) << reason;
}

TEST(MemoryLimit, IsFoundUnderALimitOfAddressSpace) {
  const Refusal found = run("ulimit -v 800000; ", "--bodies 2000 --solver dense");
  ASSERT_EQ(found.table.rows.size(), 1u) << found.result.err;
  EXPECT_EQ(found.table.at(0, "status"), "out_of_memory");
  EXPECT_NE(found.table.at(0, "status_reason").find(" GB, the limit is "), std::string::npos)
      << found.table.at(0, "status_reason");
  EXPECT_NE(found.manifest.find("\"memory-limit\": null"), std::string::npos);
  EXPECT_NE(found.manifest.find("\"memory_limit_gb\": 0."), std::string::npos) << found.manifest;
}

}  // namespace
}  // namespace cleave
