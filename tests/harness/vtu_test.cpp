// cleave export --format vtu: surfaces are closed and enclose the volume of their bodies, and every cell says
// what the file knows of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <regex>
#include <sstream>

#include "harness/files/polygon_mesh.h"
#include "harness/files/vtu_file.h"
#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;
using Corners = std::vector<std::array<double, 3>>;

ProblemShapes one_shape(GeomType type, std::array<double, 3> size, const Corners& corners = {}) {
  ProblemShapes shapes;
  shapes.geom_body = {0};
  shapes.geom_type = {static_cast<std::uint8_t>(type)};
  shapes.geom_size.assign(size.begin(), size.end());
  shapes.geom_position = {1, -2, 3};
  shapes.geom_orientation = {0.5, 0.5, -0.5, 0.5};
  for (const auto& corner : corners)
    shapes.convex_points.insert(shapes.convex_points.end(), corner.begin(), corner.end());
  shapes.convex_first = {0, static_cast<int>(corners.size())};
  return shapes;
}

// By Gauss, of triangles from the first corner of every polygon. Every edge has to be met once in each
// direction.
double enclosed_volume(const PolygonMesh& mesh) {
  double volume = 0;
  std::map<std::pair<int, int>, int> edges;
  std::size_t first = 0;
  const auto point = [&mesh](int k) { return mesh.point.data() + 3 * std::size_t(k); };
  for (const std::size_t end : mesh.end) {
    for (std::size_t k = first; k < end; ++k)
      ++edges[{mesh.corner[k], mesh.corner[k + 1 < end ? k + 1 : first]}];
    for (std::size_t k = first + 1; k + 1 < end; ++k) {
      const double *a = point(mesh.corner[first]), *b = point(mesh.corner[k]), *c = point(mesh.corner[k + 1]);
      volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                 a[2] * (b[0] * c[1] - b[1] * c[0])) /
                6;
    }
    first = end;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  return volume;
}

// Of the polygon with 24 corners in place of a circle.
const double kFlatCircle = 12 * std::sin(std::numbers::pi / 12);

TEST(PolygonMesh, EnclosesTheVolumeOfBoxesAndCylinders) {
  const PolygonMesh box = mesh_of_shapes(one_shape(GeomType::box, {2, 3, 4}));
  EXPECT_EQ(box.polygon_count(), 6u);
  EXPECT_EQ(box.corner.size(), 24u);
  EXPECT_NEAR(enclosed_volume(box), 24, 1e-12);
  EXPECT_NEAR(enclosed_volume(mesh_of_shapes(one_shape(GeomType::cylinder, {0.5, 3, 0}))),
              kFlatCircle * 0.25 * 3, 1e-12);
}

TEST(PolygonMesh, IsInsideRoundBodiesAndNearlyFillsThem) {
  const double ball = 4 * std::numbers::pi / 3;
  const double sphere = enclosed_volume(mesh_of_shapes(one_shape(GeomType::sphere, {1, 0, 0})));
  EXPECT_LT(sphere, ball);
  EXPECT_GT(sphere, 0.97 * ball);
  EXPECT_NEAR(enclosed_volume(mesh_of_shapes(one_shape(GeomType::capsule, {1, 5, 0}))),
              sphere + 5 * kFlatCircle, 1e-12);
}

// Corners of a cube with points that are none: in a face, on an edge, inside, and one corner twice.
TEST(PolygonMesh, HasTheFacesOfAConvexBody) {
  Corners cube;
  for (int k = 0; k < 8; ++k) cube.push_back({k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0});
  cube.push_back({1, 0.2, 0.3});
  cube.push_back({1, 1, 0.5});
  cube.push_back({0.1, 0.2, 0.3});
  const PolygonMesh mesh = mesh_of_shapes(one_shape(GeomType::convex, {}, cube));
  EXPECT_EQ(mesh.polygon_count(), 6u);
  EXPECT_EQ(mesh.corner.size(), 24u);
  EXPECT_NEAR(enclosed_volume(mesh), 8, 1e-12);
  SampleRandom random(3);
  Corners cloud;
  for (int k = 0; k < 30; ++k)
    cloud.push_back({random.around_zero(), random.around_zero(), random.around_zero()});
  const double volume = enclosed_volume(mesh_of_shapes(one_shape(GeomType::convex, {}, cloud)));
  EXPECT_GT(volume, 1);
  EXPECT_LT(volume, 8);
  EXPECT_EQ(mesh_of_shapes(one_shape(GeomType::plane, {})).polygon_count(), 0u);
}

// The numbers of an array of a picture.
std::vector<double> array_of(const std::string& text, const std::string& name) {
  const std::size_t head = text.find("Name=\"" + name + "\"");
  EXPECT_NE(head, std::string::npos) << name;
  if (head == std::string::npos) return {};
  const std::size_t begin = text.find('\n', head), end = text.find("</DataArray>", head);
  std::istringstream numbers(text.substr(begin, end - begin));
  std::vector<double> values;
  for (double value = 0; numbers >> value;) values.push_back(value);
  return values;
}

class Vtu : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_cleave({"record", "--scene", "rock_pile", "--bodies", "12", "--at", "70,80", "--out",
                          directory_ / "recorded"})
                  .exit_code,
              0);
    ASSERT_EQ(run_cleave({"replay", directory_ / "recorded" / kSecond, "--partitioner", "mindp", "--refiner",
                          "none", "--max-bodies", "5", "--write-solutions", "--out", directory_ / "solved"})
                  .exit_code,
              0);
  }
  static constexpr const char* kSecond = "rock_pile_step000080.h5";
  TemporaryDirectory directory_;
};

TEST_F(Vtu, CellsSayWhatTheFileKnows) {
  const ProblemFile file = read_problem_file(directory_ / "solved" / kSecond);
  const std::string text = vtu_text(file), label = "mindp+none+schur";
  const std::vector<double> body = array_of(text, "body"), row = array_of(text, "contact_row"),
                            end = array_of(text, "offsets"), type = array_of(text, "types"),
                            corner = array_of(text, "connectivity"), point = array_of(text, "Points"),
                            part = array_of(text, "part " + label),
                            impulse = array_of(text, "impulse_Ns " + label),
                            velocity = array_of(text, "velocity_m_per_s " + label);
  const auto contacts = std::ranges::count(file.problem.row_kind, RowKind::normal);
  ASSERT_GT(contacts, 5);
  ASSERT_EQ(std::ranges::count(type, 1.0), contacts);
  EXPECT_EQ(std::ranges::count(type, 7.0), 12 * 6);
  EXPECT_EQ(body.size(), type.size());
  EXPECT_EQ(end.back(), static_cast<double>(corner.size()));
  const StoredSolution& solution = file.solutions.at(label);
  for (std::size_t cell = 0; cell < body.size(); ++cell) {
    const int i = static_cast<int>(body[cell]), r = static_cast<int>(row[cell]);
    EXPECT_EQ(part[cell], i < 0 ? -1 : file.partitions.at(label).part_of_body[i]);
    for (int k = 0; k < 3 && i >= 0; ++k) EXPECT_EQ(velocity[3 * cell + k], solution.velocity[6 * i + k]);
    EXPECT_EQ(impulse[cell], r < 0 ? 0 : solution.impulse[r]);
    if (r < 0) continue;
    EXPECT_EQ(i, file.problem.row_body[2 * r]);
    const std::size_t there = static_cast<std::size_t>(corner[static_cast<std::size_t>(end[cell]) - 1]);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(point[3 * there + k], file.problem.contact_point[3 * r + k]);
  }
}

TEST_F(Vtu, SeveralFilesAreASeries) {
  const fs::path first = directory_ / "recorded" / "rock_pile_step000070.h5",
                 second = directory_ / "recorded" / kSecond;
  ASSERT_EQ(run_cleave({"export", first, second, "--format", "vtu", "--out", directory_ / "a.pvd"}).exit_code,
            0);
  EXPECT_EQ(read_text(directory_ / "a_1.vtu"), vtu_text(read_problem_file(second)));
  const std::string list = read_text(directory_ / "a.pvd");
  const double h_s = read_problem_file(first).problem.h_s;
  const std::regex entry("timestep=\"([^\"]*)\" part=\"0\" file=\"([^\"]*)\"");
  std::vector<std::pair<double, std::string>> found;
  for (std::sregex_iterator it(list.begin(), list.end(), entry), none; it != none; ++it)
    found.emplace_back(std::stod((*it)[1]), (*it)[2]);
  EXPECT_EQ(found,
            (std::vector<std::pair<double, std::string>>{{70 * h_s, "a_0.vtu"}, {80 * h_s, "a_1.vtu"}}));

  EXPECT_FALSE(fs::exists(directory_ / "a_0.vtu.part"));
  // A shorter one in its place leaves no picture that is not in its list.
  EXPECT_EQ(
      run_cleave({"export", second, "--format", "vtu", "--out", directory_ / "a.pvd", "--force"}).exit_code,
      0);
  EXPECT_FALSE(fs::exists(directory_ / "a_1.vtu"));

  const auto refusal = [](std::vector<std::string> words) {
    const ProgramResult result = run_cleave(words);
    EXPECT_EQ(result.exit_code, 1);
    return result.err;
  };
  EXPECT_NE(refusal({"export", first, second, "--format", "vtu", "--out", directory_ / "b.vtu"})
                .find("b.vtu' is one file; of several --format vtu writes NAME.pvd"),
            std::string::npos);
  EXPECT_NE(refusal({"export", first, second, "--format", "metis", "--out", directory_ / "b"})
                .find("FILE: --format metis takes one, not 2"),
            std::string::npos);
  EXPECT_NE(refusal({"export", second, first, "--format", "vtu", "--out", directory_ / "c.pvd"})
                .find(first.string() + " is no later step of the simulation of " + second.string()),
            std::string::npos);
  EXPECT_FALSE(fs::exists(directory_ / "c_0.vtu") || fs::exists(directory_ / "c_0.vtu.part"));
  EXPECT_NE(
      refusal({"export", first, second, "--format", "vtu", "--out", directory_ / "a.pvd"}).find("exists"),
      std::string::npos);
}

TEST(VtuFile, WithoutShapesIsRefused) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file(4, 3);
  file.shapes.reset();
  write_problem_file(directory / "a.h5", file);
  const ProgramResult result =
      run_cleave({"export", directory / "a.h5", "--format", "vtu", "--out", directory / "a.vtu"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("a.h5: has no shapes"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(directory / "a.vtu"));
}

}  // namespace
}  // namespace cleave
