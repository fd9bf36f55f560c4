#include "harness/files/vtu_file.h"

#include <functional>
#include <stdexcept>

#include "harness/base/numbers.h"
#include "harness/files/polygon_mesh.h"

namespace cleave {
namespace {

constexpr int kVertex = 1, kPolygon = 7;  // cell types of VTK

// A label as an attribute of XML.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text)
    result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
  return result + "\"";
}

// Numbers with spaces between them, ten a line.
class Numbers {
 public:
  void add(const std::string& number) { text_ += number + (++count_ % 10 == 0 ? "\n" : " "); }
  void add(double number) { add(number_text(number)); }
  void add(int number) { add(std::to_string(number)); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  long count_ = 0;
};

std::string array(const char* type, const std::string& name, int components, const Numbers& numbers) {
  return std::string("<DataArray type=\"") + type + "\" Name=" + quoted(name) + " NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"ascii\">\n" + numbers.text() + "\n</DataArray>\n";
}

struct PictureCell {
  int body, row;
};

class Picture {
 public:
  explicit Picture(const ProblemFile& file) : file_(file), mesh_(mesh_of_shapes(*file.shapes)) {
    for (const int geom : mesh_.geom) cells_.push_back({file.shapes->geom_body[geom], -1});
    const StepProblem& problem = file.problem;
    for (int r = 0; r < problem.row_count(); ++r)
      if (problem.row_kind[r] == RowKind::normal) cells_.push_back({problem.row_body[2 * std::size_t(r)], r});
  }

  std::string text() const {
    const std::size_t contacts = cells_.size() - mesh_.polygon_count();
    return "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
           "byte_order=\"LittleEndian\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" +
           std::to_string(mesh_.point.size() / 3 + contacts) + "\" NumberOfCells=\"" +
           std::to_string(cells_.size()) + "\">\n<Points>\n" + points() + "</Points>\n<Cells>\n" + corners() +
           "</Cells>\n<CellData>\n" + data() + "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
  }

 private:
  std::string points() const {
    Numbers numbers;
    for (const double x : mesh_.point) numbers.add(x);
    for (const PictureCell& cell : cells_)
      for (int k = 0; k < 3 && cell.row >= 0; ++k)
        numbers.add(file_.problem.contact_point[3 * std::size_t(cell.row) + k]);
    return array("Float64", "Points", 3, numbers);
  }

  std::string corners() const {
    Numbers corners, ends, types;
    for (const int corner : mesh_.corner) corners.add(corner);
    for (const std::size_t end : mesh_.end) ends.add(static_cast<int>(end)), types.add(kPolygon);
    const int contacts = static_cast<int>(cells_.size() - mesh_.polygon_count());
    for (int c = 0; c < contacts; ++c) {
      corners.add(static_cast<int>(mesh_.point.size() / 3) + c);
      ends.add(static_cast<int>(mesh_.corner.size()) + c + 1);
      types.add(kVertex);
    }
    return array("Int32", "connectivity", 1, corners) + array("Int32", "offsets", 1, ends) +
           array("UInt8", "types", 1, types);
  }

  std::string integers(const std::string& name, const std::function<int(const PictureCell&)>& value) const {
    Numbers numbers;
    for (const PictureCell& cell : cells_) numbers.add(value(cell));
    return array("Int32", name, 1, numbers);
  }

  // Of the bodies' centres; velocity: (n, 6).
  std::string velocities(const std::string& name, const std::vector<double>& velocity) const {
    Numbers numbers;
    for (const PictureCell& cell : cells_)
      for (int k = 0; k < 3; ++k) numbers.add(cell.body < 0 ? 0.0 : velocity[6 * std::size_t(cell.body) + k]);
    return array("Float64", name, 3, numbers);
  }

  std::string impulses(const std::string& name, const std::vector<double>& impulse) const {
    Numbers numbers;
    for (const PictureCell& cell : cells_) numbers.add(cell.row < 0 ? 0.0 : impulse[cell.row]);
    return array("Float64", name, 1, numbers);
  }

  std::string data() const {
    const auto of_body = [](const std::vector<int>& values) {
      return [&values](const PictureCell& cell) { return cell.body < 0 ? -1 : values[cell.body]; };
    };
    std::string text = integers("body", [](const PictureCell& cell) { return cell.body; }) +
                       integers("contact_row", [](const PictureCell& cell) { return cell.row; });
    const std::vector<int> groups = known_groups(file_);
    if (!groups.empty()) text += integers("group", of_body(groups));
    text += velocities("free_velocity_m_per_s", file_.problem.free_velocity);
    for (const auto& [label, solution] : file_.solutions)
      text += velocities("velocity_m_per_s " + label, solution.velocity) +
              impulses("impulse_Ns " + label, solution.impulse);
    for (const auto& [label, partition] : file_.partitions)
      text += integers("part " + label, of_body(partition.part_of_body));
    return text;
  }

  const ProblemFile& file_;
  PolygonMesh mesh_;
  std::vector<PictureCell> cells_;
};

}  // namespace

std::string vtu_text(const ProblemFile& file) {
  if (!file.shapes) throw std::invalid_argument("has no shapes, which say what its bodies look like");
  return Picture(file).text();
}

std::string pvd_text(const std::vector<VtuAtTime>& files) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  for (const VtuAtTime& file : files)
    text += "<DataSet timestep=\"" + number_text(file.time_s) + "\" part=\"0\" file=" + quoted(file.name) +
            "/>\n";
  return text + "</Collection>\n</VTKFile>\n";
}

}  // namespace cleave
