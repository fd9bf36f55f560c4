// cleave export and import --format fclib. What is exported is read by the library of FCLIB's own and held
// against the problem in dense arrays; what that library writes is imported.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "harness/files/fclib_problem.h"
#include "solver/residual.h"
#include "tests/harness/fclib_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

// The row that every column of G, then of H is of; -1 for tangents that there are not.
std::vector<int> rows_of_columns(const StepProblem& p, int dimension) {
  std::vector<int> joints, contacts;
  for (int r = 0; r < p.row_count(); ++r) {
    if (p.row_kind[r] == RowKind::bilateral) joints.push_back(r);
    if (p.row_kind[r] != RowKind::normal) continue;
    for (int k = 0; k < dimension; ++k)
      contacts.push_back(k == 0 || (r + k < p.row_count() && p.friction_row[r + k] == r) ? r + k : -1);
  }
  joints.insert(joints.end(), contacts.begin(), contacts.end());
  return joints;
}

struct Dense {
  Eigen::MatrixXd mass, columns;  // N x N; N x (joints, then contacts)
  Eigen::VectorXd f, constants;
  int joints = 0;

  explicit Dense(const fclib_global& global)
      : mass(dense(*global.M)),
        f(dense(global.f, global.M->m)),
        joints(global.G == nullptr ? 0 : global.G->n) {
    columns.resize(mass.rows(), joints + global.H->n);
    constants.resize(columns.cols());
    if (joints > 0) columns.leftCols(joints) = dense(*global.G);
    if (joints > 0) constants.head(joints) = dense(global.b, joints);
    columns.rightCols(global.H->n) = dense(*global.H);
    constants.tail(global.H->n) = dense(global.w, global.H->n);
  }
  Eigen::MatrixXd w() const { return columns.transpose() * mass.llt().solve(columns); }
  Eigen::VectorXd q() const { return columns.transpose() * mass.llt().solve(f) + constants; }
};

void expect_same_system(const StepProblem& problem, const Dense& file, int dimension) {
  const std::vector<int> rows = rows_of_columns(problem, dimension);
  ASSERT_EQ(static_cast<std::size_t>(file.columns.cols()), rows.size());
  const Eigen::MatrixXd expected = dense_w(problem), w = file.w();
  const Eigen::VectorXd expected_q = dense_q(problem), q = file.q();
  const double size = expected.cwiseAbs().maxCoeff();
  for (std::size_t a = 0; a < rows.size(); ++a) {
    EXPECT_NEAR(q[a], rows[a] < 0 ? 0 : expected_q[rows[a]], 1e-12 * expected_q.cwiseAbs().maxCoeff());
    for (std::size_t b = 0; b < rows.size(); ++b)
      EXPECT_NEAR(w(a, b), rows[a] < 0 || rows[b] < 0 ? 0 : expected(rows[a], rows[b]), 1e-12 * size);
  }
}

class Fclib : public ::testing::Test {
 protected:
  std::filesystem::path file() const { return directory_ / "a.hdf5"; }
  ProgramResult import_file(std::vector<std::string> more = {}) const {
    more.insert(more.begin(),
                {"import", file(), "--format", "fclib", "--force", "--out", directory_ / "a.h5"});
    return run_cleave(more);
  }
  StepProblem imported() const { return read_problem_file(directory_ / "a.h5").problem; }

  TemporaryDirectory directory_;
};

TEST_F(Fclib, LibraryReadsTheSystemOfTheProblem) {
  for (const int tangents : {1, 2})
    for (const int bodies : {1, 2, 7}) {
      const StepProblem problem = fclib_sample(bodies, tangents, 10 * bodies + tangents);
      write_fclib_file(file(), fclib_of_problem(problem));
      const GlobalOfLibrary global = read_by_library(file());
      ASSERT_TRUE(global);
      EXPECT_EQ(global->spacedim, tangents + 1);
      expect_same_system(problem, Dense(*global), tangents + 1);
      const int stiff = static_cast<int>(std::ranges::count(problem.compliance, 0));
      EXPECT_EQ(global->M->m, 6 * bodies + problem.row_count() - stiff);
      int contact = 0;
      for (int r = 0; r < problem.row_count(); ++r)
        if (problem.row_kind[r] == RowKind::normal) {
          EXPECT_EQ(global->mu[contact++], problem.contact_set[r] == ContactSet::coulomb ? 0.5 : 0);
        }
    }
}

TEST_F(Fclib, ComesBackAsTheSameProblem) {
  for (const int tangents : {1, 2}) {
    const StepProblem problem = fclib_sample(9, tangents, 5);
    write_fclib_file(file(), fclib_of_problem(problem));
    ASSERT_EQ(import_file().exit_code, 0);
    const StepProblem back = imported();
    EXPECT_EQ(back.h_s, problem.h_s);
    EXPECT_EQ(back.mass, problem.mass);
    std::vector<int> kept;
    for (int r = 0; r < problem.row_count(); ++r)
      if (problem.lower[r] != 0 || problem.upper[r] != 0) kept.push_back(r);
    ASSERT_EQ(back.row_count(), static_cast<int>(kept.size()));
    EXPECT_LT(kept.size(), problem.rhs.size());
    for (int r = 0; r < back.row_count(); ++r) {
      const int o = kept[r];
      SCOPED_TRACE(o);
      for (const int side : {0, 1}) EXPECT_EQ(back.row_body[2 * r + side], problem.row_body[2 * o + side]);
      for (int k = 0; k < 12; ++k) EXPECT_EQ(back.jacobian[12 * r + k], problem.jacobian[12 * o + k]);
      EXPECT_EQ(back.rhs[r], problem.rhs[o]);
      EXPECT_NEAR(back.compliance[r], problem.compliance[o], 4e-16 * problem.compliance[o]);
      EXPECT_EQ(back.lower[r], problem.lower[o]);
      EXPECT_EQ(back.upper[r], problem.upper[o]);
      EXPECT_EQ(back.row_kind[r], problem.row_kind[o]);
      EXPECT_EQ(back.friction_coefficient[r], problem.friction_coefficient[o]);
      EXPECT_EQ(back.contact_set[r], problem.contact_set[o]);
      if (back.friction_row[r] >= 0) {
        EXPECT_EQ(kept[back.friction_row[r]], problem.friction_row[o]);
      }
    }
    for (std::size_t k = 0; k < problem.free_velocity.size(); ++k)
      EXPECT_NEAR(back.free_velocity[k], problem.free_velocity[k], 1e-13);
  }
}

// A pile that cleave recorded and solved: its impulses and velocities satisfy FCLIB's own equations, and the
// file that comes back has the same solution.
TEST_F(Fclib, SolutionsAreSolutionsOnBothSides) {
  const std::string recorded = directory_ / "recorded", problem = recorded + "/log_tower_step000004.h5";
  ASSERT_EQ(run_cleave({"record", "--scene", "log_tower", "--layers", "3", "--at", "4", "--out", recorded})
                .exit_code,
            0);
  ASSERT_EQ(run_cleave({"export", problem, "--format", "fclib", "--friction", "coulomb", "--out", file()})
                .exit_code,
            0);
  ASSERT_EQ(import_file().exit_code, 0);
  const auto solve = [&](const std::string& path, const std::string& name) {
    const ProgramResult result =
        run_cleave({"replay", path, "--friction", "coulomb", "--solver", "exact", "--cold", "--repeats", "1",
                    "--write-solutions", "--out", directory_ / name});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_problem_file(directory_ / name / std::filesystem::path(path).filename().string());
  };
  const ProblemFile ours = solve(problem, "ours"), back = solve(directory_ / "a.h5", "back");
  const std::vector<double>& v0 = ours.problem.free_velocity;
  EXPECT_EQ(run_cleave({"verify", directory_ / "back"}).exit_code, 0);
  const StoredSolution& solution = ours.solutions.begin()->second;
  const std::vector<double>& velocity = back.solutions.begin()->second.velocity;
  ASSERT_EQ(velocity.size(), v0.size());
  for (std::size_t k = 0; k < velocity.size(); ++k) EXPECT_NEAR(velocity[k], solution.velocity[k], 1e-6);

  const GlobalOfLibrary global = read_by_library(file());
  ASSERT_TRUE(global);
  const Dense system(*global);
  expect_same_system(ours.problem, system, 3);
  const std::vector<int> rows = rows_of_columns(ours.problem, 3);
  Eigen::VectorXd impulse(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) impulse[k] = solution.impulse[rows[k]];
  const Eigen::VectorXd v = system.mass.llt().solve(system.columns * impulse + system.f);
  for (std::size_t k = 0; k < v0.size(); ++k) EXPECT_NEAR(v[k], solution.velocity[k], 1e-9);
  const Eigen::VectorXd u = system.columns.transpose() * v + system.constants;
  EXPECT_GT(u.size(), 20);
  for (int c = 0; 3 * c + system.joints < u.size(); ++c) {
    const Eigen::Vector3d un = u.segment<3>(system.joints + 3 * c),
                          r = impulse.segment<3>(system.joints + 3 * c);
    const double mu = global->mu[c], slide = std::hypot(un[1], un[2]);
    EXPECT_GT(mu, 0);
    EXPECT_LE(std::hypot(r[1], r[2]), mu * r[0] + 1e-7);
    EXPECT_GE(un[0], -1e-8);
    EXPECT_NEAR((un[0] + mu * slide) * r[0] + un[1] * r[1] + un[2] * r[2], 0, 1e-6);
  }
}

// A file as another program writes it. entries: of M, H, G.
struct Foreign {
  int unknowns = 6, spacedim = 3;
  std::vector<MatrixEntry> M, H, G;
  std::vector<double> f, w, mu, b;

  // layout: nz of compressed matrices, or 0 for triplets (rows, columns), 1 for (columns, rows).
  void write(const std::filesystem::path& path, int layout) const {
    Matrix m(M, unknowns, unknowns, layout), h(H, unknowns, static_cast<int>(w.size()), layout),
        g(G, unknowns, static_cast<int>(b.size()), layout);
    std::vector<double> f_copy = f, w_copy = w, mu_copy = mu, b_copy = b;
    fclib_info info{nullptr, nullptr, nullptr};
    fclib_global global{&m.matrix,      &h.matrix,     b.empty() ? nullptr : &g.matrix,
                        mu_copy.data(), f_copy.data(), b_copy.data(),
                        w_copy.data(),  spacedim,      &info};
    std::filesystem::remove(path);
    ASSERT_EQ(fclib_write_global(&global, path.c_str()), 1);
  }

 private:
  struct Matrix {
    std::vector<int> p, i;
    std::vector<double> x;
    fclib_matrix matrix;
    Matrix(std::vector<MatrixEntry> entries, int rows, int columns, int layout) {
      const bool by_rows = layout == -2;
      const auto line = [&](const MatrixEntry& entry) { return by_rows ? entry.row : entry.column; };
      std::ranges::stable_sort(entries, {}, line);
      if (layout < 0) p.assign((by_rows ? rows : columns) + 1, 0);
      for (const MatrixEntry& entry : entries) {
        x.push_back(entry.value);
        if (layout < 0) ++p[line(entry) + 1];
        if (layout < 0) i.push_back(by_rows ? entry.column : entry.row);
        if (layout >= 0) p.push_back(layout == 0 ? entry.row : entry.column);
        if (layout >= 0) i.push_back(layout == 0 ? entry.column : entry.row);
      }
      if (layout < 0) std::partial_sum(p.begin(), p.end(), p.begin());
      const int count = static_cast<int>(x.size());
      matrix = {count, rows, columns, p.data(), i.data(), x.data(), layout < 0 ? layout : count, nullptr};
    }
  };
};

// Two balls of 2 kg, the upper on the lower and that on the ground, held together by a joint row.
Foreign two_balls() {
  Foreign problem;
  problem.unknowns = 12;
  for (int k = 0; k < 12; ++k) problem.M.push_back({k, k, k % 6 < 3 ? 2 : 0.2});
  for (int k = 0; k < 12; ++k) problem.f.push_back(0.25 * k);
  const int axis[] = {2, 0, 1};
  for (int c = 0; c < 2; ++c)
    for (int k = 0; k < 3; ++k) {
      problem.H.push_back({6 * c + axis[k], 3 * c + k, 1});
      if (c == 1) problem.H.push_back({axis[k], 3 + k, -1});
      if (k > 0) problem.H.push_back({6 * c + 5 - axis[k], 3 * c + k, 0.5});
    }
  problem.w = {-0.1, 0.2, 0.3, 0.4, 0.5, 0.6};
  problem.mu = {0.3, 0.7};
  problem.G = {{3, 0, 1}, {9, 0, -1}};
  problem.b = {0.01};
  return problem;
}

TEST_F(Fclib, TakesEveryLayoutOfMatrices) {
  std::vector<StepProblem> problems;
  for (const int layout : {-1, -2, 0, 1}) {
    SCOPED_TRACE(layout);
    two_balls().write(file(), layout);
    const ProgramResult result = import_file();
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.err.find("a.hdf5: says nothing of its step; h_s is 1"), std::string::npos) << result.err;
    problems.push_back(imported());
    const StepProblem& p = problems.back();
    EXPECT_EQ(p.row_body, (std::vector<int>{0, 1, 0, -1, 0, -1, 0, -1, 0, 1, 0, 1, 0, 1}));
    EXPECT_EQ(p.jacobian, problems.front().jacobian);
    EXPECT_EQ(p.rhs, (std::vector<double>{-0.01, 0.1, -0.2, -0.3, -0.4, -0.5, -0.6}));
    EXPECT_EQ(p.friction_coefficient, (std::vector<double>{0, 0, 0.3, 0.3, 0, 0.7, 0.7}));
    EXPECT_EQ(p.friction_row, (std::vector<int>{-1, -1, 1, 1, -1, 4, 4}));
    EXPECT_EQ(p.compliance, std::vector<double>(7, 0.0));
    EXPECT_EQ(p.h_s, 1);
    for (int k = 0; k < 12; ++k) EXPECT_NEAR(p.free_velocity[k], 0.25 * k / (k % 6 < 3 ? 2 : 0.2), 1e-14);
    const GlobalOfLibrary global = read_by_library(file());
    if (layout < 0) expect_same_system(p, Dense(*global), 3);
  }
}

// In the plane a body has x, y and an angle; a point in space has three coordinates.
TEST_F(Fclib, TakesBodiesOfThreeUnknowns) {
  for (const bool flat : {true, false}) {
    SCOPED_TRACE(flat);
    Foreign problem;
    problem.unknowns = 3;
    problem.spacedim = flat ? 2 : 3;
    problem.M = {{0, 0, 4}, {1, 1, 5}, {2, 2, 6}, {0, 2, 1}, {2, 0, 1}};
    problem.f = {1, 2, 3};
    problem.H = {{1, 0, 1}, {0, 1, 1}, {2, 1, 0.5}};
    if (!flat) problem.H.push_back({2, 2, 1});
    problem.w.assign(problem.spacedim, 0.5);
    problem.mu = {0.5};
    problem.write(file(), -1);
    ASSERT_EQ(import_file(flat ? std::vector<std::string>{} : std::vector<std::string>{"--mass-blocks", "3"})
                  .exit_code,
              0);
    const StepProblem p = imported();
    ASSERT_EQ(p.body_count(), 1);
    const int last = flat ? 5 : 2;
    const std::vector<double> masses =
        flat ? std::vector<double>{4, 5, 4, 6, 6, 6} : std::vector<double>{4, 5, 6, 6, 6, 6};
    for (int k = 0; k < 6; ++k) EXPECT_EQ(p.mass[7 * k], masses[k]) << k;
    EXPECT_EQ(p.mass[last], 1);
    EXPECT_EQ(p.mass[6 * last], 1);
    EXPECT_EQ(p.jacobian[1], 1);
    EXPECT_EQ(p.jacobian[12 + last], 0.5);
    const GlobalOfLibrary global = read_by_library(file());
    expect_same_system(p, Dense(*global), problem.spacedim);
    for (int k = 0; k < 6; ++k)
      if (k != 0 && k != 1 && k != last) {
        EXPECT_EQ(p.free_velocity[k], 0);
      }
  }
}

TEST_F(Fclib, ImportRefusesInOneLine) {
  const auto refusal = [&](const Foreign& problem, std::vector<std::string> more = {}) {
    problem.write(file(), -1);
    const ProgramResult result = import_file(more);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(count_lines(result.err), result.err.find("says nothing") == std::string::npos ? 1 : 2)
        << result.err;
    EXPECT_FALSE(std::filesystem::exists(directory_ / "a.h5"));
    return result.err;
  };
  const auto expect = [&](const std::string& text, auto change) {
    Foreign problem = two_balls();
    change(problem);
    const std::string said = refusal(problem);
    EXPECT_NE(said.find(file().string() + ": fclib_global/" + text + "\n"), std::string::npos) << said << "\n"
                                                                                               << text;
  };
  expect("M(7, 1) = 0.5, allowed: 0, as its bodies differ: blocks of 6", [](Foreign& p) {
    p.M.push_back({7, 1, 0.5});
  });
  expect("M = a block of body 1 that is not positive definite, allowed: positive definite blocks",
         [](Foreign& p) {
           p.M.push_back({7, 7, -3});
         });
  expect("bodies of H column 0 = none, allowed: one or two", [](Foreign& p) { p.H.erase(p.H.begin()); });
  expect("bodies of G column 0 = none, allowed: one or two", [](Foreign& p) { p.G.clear(); });
  expect("M/m = 11, allowed: a multiple of the 6 unknowns of a body", [](Foreign& p) {
    p.unknowns = 11;
    p.M.pop_back();
    p.H.pop_back();
    p.f.pop_back();
    std::erase_if(p.H, [](const MatrixEntry& entry) { return entry.row > 10; });
  });
  expect("bodies of H column 0 = 0, 1, 2, allowed: at most two", [](Foreign& p) {
    p.unknowns = 18;
    p.f.resize(18, 0.0);
    for (int k = 12; k < 18; ++k) p.M.push_back({k, k, 1});
    p.H.push_back({7, 0, 1});
    p.H.push_back({13, 0, 1});
  });
  expect("vectors/mu[1] = -0.5, allowed: 0 or more", [](Foreign& p) { p.mu[1] = -0.5; });
  expect("vectors/f[2] = nan, allowed: finite numbers", [](Foreign& p) { p.f[2] = std::nan(""); });
  expect("H/x[0] = inf, allowed: finite numbers", [](Foreign& p) { p.H[0].value = INFINITY; });
  EXPECT_NE(refusal(two_balls(), {"--mass-blocks", "4"}).find("--mass-blocks: '4' is unknown; choices: 3, 6"),
            std::string::npos);
  EXPECT_NE(refusal(two_balls(), {"--dt", "0"}).find("--dt: 0 is not in (0, inf)"), std::string::npos);
  EXPECT_NE(refusal(two_balls(), {"--format", "siconos"}).find("--format"), std::string::npos);
}

// What only a file that is not the library's can have.
TEST_F(Fclib, ImportRefusesLayoutsInOneLine) {
  const auto expect = [&](const std::string& text, auto write) {
    Hdf5Writer writer(file());
    write(writer);
    writer.close();
    const ProgramResult result = import_file();
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.err, "cleave import: " + file().string() + ": " + text + "\n");
  };
  expect("group fclib_global is missing", [](const Hdf5Writer&) {});
  expect(
      "fclib_local = the local form, in which W has taken the place of the bodies, allowed: the global form, "
      "a group fclib_global",
      [](const Hdf5Writer& writer) { writer.group("fclib_local"); });
  using Numbers = std::vector<int>;
  const auto matrix = [](const Hdf5Writer& group, int m, int n, int nz, const Numbers& p, const Numbers& i) {
    group.array("m", {1}, Numbers{m});
    group.array("n", {1}, Numbers{n});
    group.array("nz", {1}, Numbers{nz});
    group.array("nzmax", {1}, Numbers{static_cast<int>(i.size())});
    group.array("p", {p.size()}, p);
    group.array("i", {i.size()}, i);
    group.array("x", {i.size()}, std::vector<double>(i.size(), 1.0));
  };
  struct Case {
    std::string text;
    int spacedim, m, nz;  // of H, which has three columns
    Numbers p, i;
  };
  const std::vector<Case> cases = {
      {"fclib_global/spacedim = 4, allowed: 2, 3", 4, 6, -1, {0, 0, 0, 0}, {}},
      {"fclib_global/H/m = 7, allowed: 6", 3, 7, -1, {0, 0, 0, 0}, {}},
      {"fclib_global/H/n = 3, allowed: a multiple of spacedim = 2", 2, 6, -1, {0, 0, 0, 0}, {}},
      {"fclib_global/H/nz = -3, allowed: -2 or more", 3, 6, -3, {}, {}},
      {"fclib_global/H/p[2] = 0, allowed: 1 to 2", 3, 6, -1, {0, 1, 0, 2}, {0, 1}},
      {"fclib_global/H/p[3] = 3, allowed: 2 to 2", 3, 6, -1, {0, 1, 2, 3}, {0, 1}},
      {"fclib_global/H/i[1] = 6, allowed: 0 to 5", 3, 6, -1, {0, 1, 2, 2}, {0, 6}},
      {"fclib_global/H/p and i = indices beyond the matrix, allowed: rows below m and columns below n",
       3,
       6,
       2,
       {0, 4},
       {0, 4}},
      {"fclib_global/H/p and i = triplets that may be rows and columns as well as columns and rows, allowed: "
       "compressed "
       "columns, nz = -1, or compressed rows, nz = -2",
       3,
       6,
       2,
       {0, 1},
       {0, 1}}};
  for (const Case& each : cases)
    expect(each.text, [&](const Hdf5Writer& writer) {
      const Hdf5Writer global = writer.group("fclib_global");
      global.array("spacedim", {1}, Numbers{each.spacedim});
      matrix(global.group("M"), 6, 6, -1, {0, 1, 2, 3, 4, 5, 6}, {0, 1, 2, 3, 4, 5});
      matrix(global.group("H"), each.m, 3, each.nz, each.p, each.i);
      const Hdf5Writer vectors = global.group("vectors");
      vectors.array("f", {6}, std::vector<double>(6, 0.0));
      vectors.array("w", {3}, std::vector<double>(3, 0.0));
      vectors.array("mu", {1}, std::vector<double>{0.5});
    });
}

TEST_F(Fclib, SpringsBelongToOneColumnEach) {
  const FclibGlobal sound = fclib_of_problem(fclib_sample(3, 2, 1));
  const int first = 6 * 3;
  const auto refusal = [&](auto change) -> std::string {
    FclibGlobal global = sound;
    change(global);
    sum_entries(global.H.entries);
    try {
      problem_of_fclib(global, {});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal([](FclibGlobal&) {}), "none");
  EXPECT_EQ(
      refusal([&](FclibGlobal& global) {
        global.H.entries.push_back({first, 0, 1});
      }),
      "fclib_global/H column 0 = a spring that another column has too, allowed: springs of one column each");
  EXPECT_EQ(refusal([&](FclibGlobal& global) {
              std::erase_if(global.G.entries, [&](const MatrixEntry& entry) { return entry.row == first; });
            }),
            "fclib_global/unknown 18 = a spring that no column has, allowed: springs of one column each");
  EXPECT_EQ(refusal([&](FclibGlobal& global) {
              global.M.entries.push_back({first, 2, 0.5});
            }),
            "fclib_global/M(18, 2) = 0.5, allowed: one number > 0 on the diagonal, for a spring");
  EXPECT_EQ(refusal([](FclibGlobal& global) { global.bodies = 30; }),
            "fclib_global/cleave_bodies = 30, allowed: 0 to 4");
  // A load on a spring, which others may have, is part of the constant.
  FclibGlobal loaded = sound;
  loaded.f[first] = 3;
  const StepProblem plain = problem_of_fclib(sound, {}), shifted = problem_of_fclib(loaded, {});
  EXPECT_NEAR(shifted.rhs[0], plain.rhs[0] - 3 * plain.compliance[0], 1e-15);
}

TEST_F(Fclib, ExportRefusesInOneLine) {
  const auto refusal = [&](const StepProblem& problem, std::vector<std::string> more = {}) {
    ProblemFile sample = sample_file(problem.body_count());
    sample.problem = problem;
    sample.solutions.clear();
    sample.partitions.clear();
    sample.friction_model = "-";
    write_problem_file(directory_ / "p.h5", sample);
    more.insert(more.begin(), {"export", directory_ / "p.h5", "--format", "fclib", "--out", file()});
    const ProgramResult result = run_cleave(more);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_FALSE(std::filesystem::exists(file()));
    return result.err;
  };
  const std::string begin =
                        "cleave export: " + (directory_ / "p.h5").string() + ": cannot be an FCLIB problem: ",
                    hint = "; --friction coulomb gives it to contacts with a coefficient\n";
  const StepProblem sound = fclib_sample(4, 2, 3);
  StepProblem problem = sound;
  problem.contact_set[3] = ContactSet::cone;
  EXPECT_EQ(refusal(problem),
            begin + "contact_set[3] = 1, allowed: 2 (coulomb), the only law of FCLIB" + hint);
  EXPECT_EQ(refusal(sample_problem(3, 1)),
            begin + "contact_set[2] = 0, allowed: 2 (coulomb), the only law of FCLIB" + hint);
  EXPECT_EQ(refusal(sample_problem(3, 1), {"--friction", "cone"}),
            begin + "contact_set[2] = 1, allowed: 2 (coulomb), the only law of FCLIB" + hint);
  problem = sound;
  problem.upper[1] = 5;
  EXPECT_EQ(
      refusal(problem),
      begin + "lower and upper[1] = -inf and 5, allowed: -inf and inf of joints, 0 and inf of contacts\n");
  problem = sample_problem(3, 1);
  EXPECT_EQ(refusal(problem, {"--friction", "colomb"}),
            "cleave export: --friction: 'colomb' is unknown (did you mean 'coulomb'?); choices: box, cone, "
            "coulomb\n");
  const ProgramResult metis =
      run_cleave({"export", directory_ / "p.h5", "--format", "metis", "--friction", "box", "--out", file()});
  EXPECT_EQ(metis.err, "cleave export: --friction: --format metis has none; leave it out\n");
}

}  // namespace
}  // namespace cleave
