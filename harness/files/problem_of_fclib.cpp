#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>

#include "harness/base/numbers.h"
#include "harness/files/fclib_problem.h"

namespace cleave {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using Block = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

[[noreturn]] void refuse(const std::string& what, const std::string& value, const std::string& allowed) {
  throw std::invalid_argument("fclib_global/" + what + " = " + value + ", allowed: " + allowed);
}

// Which of the six coordinates of a body its unknowns are.
struct BodyLayout {
  int unknowns;
  std::array<int, 6> place;
};
constexpr BodyLayout kWhole{6, {0, 1, 2, 3, 4, 5}}, kPlane{3, {0, 1, 5}}, kPoint{3, {0, 1, 2}};

BodyLayout layout_of(const FclibGlobal& global, std::optional<int> unknowns) {
  const bool is_flat = global.dimension == 2;
  if (unknowns.value_or(is_flat && !global.bodies ? 3 : 6) == 6) return kWhole;
  return is_flat ? kPlane : kPoint;
}

int count_bodies(const FclibGlobal& global, const BodyLayout& layout) {
  const int unknowns = global.M.rows, most = unknowns / layout.unknowns;
  if (global.bodies && (*global.bodies < 0 || *global.bodies > most))
    refuse("cleave_bodies", std::to_string(*global.bodies), "0 to " + std::to_string(most));
  if (!global.bodies && unknowns % layout.unknowns != 0)
    refuse("M/m", std::to_string(unknowns),
           "a multiple of the " + std::to_string(layout.unknowns) + " unknowns of a body");
  const int bodies = global.bodies.value_or(most);
  constexpr int kMost = std::numeric_limits<int>::max() / 36;
  if (bodies > kMost) refuse("bodies", std::to_string(bodies), "at most " + std::to_string(kMost));
  return bodies;
}

// Entries by columns, of a matrix whose entries are in that order.
class Columns {
 public:
  explicit Columns(const FclibMatrix& matrix) : matrix_(matrix), first_(matrix.columns + 1, 0) {
    for (const MatrixEntry& entry : matrix.entries) ++first_[entry.column + 1];
    for (int c = 0; c < matrix.columns; ++c) first_[c + 1] += first_[c];
  }
  std::span<const MatrixEntry> operator[](int column) const {
    return std::span(matrix_.entries).subspan(first_[column], first_[column + 1] - first_[column]);
  }

 private:
  const FclibMatrix& matrix_;
  std::vector<std::size_t> first_;
};

class Import {
 public:
  Import(const FclibGlobal& global, const BodyLayout& layout)
      : global_(global), layout_(layout), bodies_(count_bodies(global, layout)) {
    problem_.h_s = global.h_s.value_or(1);
    problem_.mass.assign(36 * std::size_t(bodies_), 0.0);
    spring_.assign(global.M.rows - first_spring(), 0.0);
    is_used_.assign(spring_.size(), false);
    read_mass();
    for (int i = 0; i < bodies_; ++i) complete(i);
    const Columns joints(global.G), contacts(global.H);
    for (int c = 0; c < global.G.columns; ++c) add_joint(c, joints);
    for (int c = 0; c < static_cast<int>(global.mu.size()); ++c) add_contact(c, contacts);
    check_springs();
    if (std::ranges::count(problem_.contact_set, ContactSet::coulomb) == 0) problem_.contact_set.clear();
  }
  StepProblem take() { return std::move(problem_); }

 private:
  struct Bodies {
    int first = -1, second = -1;
  };

  int first_spring() const { return layout_.unknowns * bodies_; }
  int body_of(int unknown) const { return unknown / layout_.unknowns; }
  int place_of(int unknown) const { return layout_.place[unknown % layout_.unknowns]; }

  void read_mass() {
    for (const auto& [row, column, value] : global_.M.entries) {
      const std::string place = "M(" + std::to_string(row) + ", " + std::to_string(column) + ")";
      if (row >= first_spring() || column >= first_spring()) {
        if (row != column || value < 0)
          refuse(place, number_text(value), "one number > 0 on the diagonal, for a spring");
        spring_[row - first_spring()] = value;
      } else if (body_of(row) != body_of(column)) {
        refuse(place, number_text(value),
               "0, as its bodies differ: blocks of " + std::to_string(layout_.unknowns));
      } else {
        problem_.mass[36 * std::size_t(body_of(row)) + 6 * place_of(row) + place_of(column)] = value;
      }
    }
  }

  // What a body lacks of six coordinates, and its velocity M^-1 f.
  void complete(int body) {
    Eigen::Map<Block> mass(problem_.mass.data() + 36 * std::size_t(body));
    const double linear = mass(0, 0),
                 angular = mass(layout_.place[layout_.unknowns - 1], layout_.place[layout_.unknowns - 1]);
    Vector6 momentum = Vector6::Zero();
    std::array<bool, 6> is_there{};
    for (int k = 0; k < layout_.unknowns; ++k) {
      momentum[layout_.place[k]] = global_.f[layout_.unknowns * std::size_t(body) + k];
      is_there[layout_.place[k]] = true;
    }
    for (int k = 0; k < 6; ++k)
      if (!is_there[k]) mass(k, k) = k < 3 ? linear : angular;
    const Eigen::LLT<Block> factor(mass);
    if (factor.info() != Eigen::Success)
      refuse("M", "a block of body " + std::to_string(body) + " that is not positive definite",
             "positive definite blocks");
    const Vector6 velocity = factor.solve(momentum);
    problem_.free_velocity.insert(problem_.free_velocity.end(), velocity.begin(), velocity.end());
  }

  // The bodies of some columns, which are one constraint; name: of the first.
  Bodies bodies_of(const std::string& name, std::span<const std::span<const MatrixEntry>> columns) const {
    std::vector<int> found;
    for (const auto& column : columns)
      for (const MatrixEntry& entry : column)
        if (entry.row < first_spring()) found.push_back(body_of(entry.row));
    std::ranges::sort(found);
    found.erase(std::ranges::unique(found).begin(), found.end());
    std::string list;
    for (const int body : found) list += (list.empty() ? "" : ", ") + std::to_string(body);
    if (found.size() > 2) refuse("bodies of " + name, list, "at most two");
    if (found.empty()) refuse("bodies of " + name, "none", "one or two");
    return {found.front(), found.size() == 2 ? found.back() : -1};
  }

  void use_springs(const std::string& name, std::span<const MatrixEntry> column) {
    for (const MatrixEntry& entry : column) {
      const int spring = entry.row - first_spring();
      if (spring < 0) continue;
      if (is_used_[spring])
        refuse(name, "a spring that another column has too", "springs of one column each");
      const std::string unknown = std::to_string(entry.row);
      if (!(spring_[spring] > 0))
        refuse("M(" + unknown + ", " + unknown + ")", number_text(spring_[spring]), "> 0, for a spring");
      is_used_[spring] = true;
    }
  }

  // The two blocks of a row, and what its springs add: compliance, and their own load to the constant.
  void add_row(const std::string& name, std::span<const MatrixEntry> column, const Bodies& bodies,
               double constant) {
    use_springs(name, column);
    std::array<double, 12> jacobian{};
    double compliance = 0, shift = 0;
    for (const MatrixEntry& entry : column) {
      if (entry.row < first_spring()) {
        jacobian[(body_of(entry.row) == bodies.first ? 0 : 6) + place_of(entry.row)] = entry.value;
        continue;
      }
      const double mass = spring_[entry.row - first_spring()];
      compliance += entry.value * entry.value / mass;
      shift += entry.value * global_.f[entry.row] / mass;
    }
    problem_.row_body.insert(problem_.row_body.end(), {bodies.first, bodies.second});
    problem_.jacobian.insert(problem_.jacobian.end(), jacobian.begin(), jacobian.end());
    problem_.compliance.push_back(compliance);
    problem_.rhs.push_back(-(constant + shift));
  }

  void add_law(RowKind kind, int normal, double lower, double upper, double mu, ContactSet set) {
    problem_.row_kind.push_back(kind);
    problem_.friction_row.push_back(normal);
    problem_.lower.push_back(lower);
    problem_.upper.push_back(upper);
    problem_.friction_coefficient.push_back(mu);
    problem_.contact_set.push_back(set);
  }

  void add_joint(int column, const Columns& columns) {
    const std::string name = "G column " + std::to_string(column);
    const std::array alone{columns[column]};
    add_row(name, alone.front(), bodies_of(name, alone), global_.b[column]);
    add_law(RowKind::bilateral, -1, -kInfinity, kInfinity, 0, ContactSet::box);
  }

  // Where there is no friction its tangents say nothing, and their springs go with them.
  void add_contact(int contact, const Columns& columns) {
    const double mu = global_.mu[contact];
    const int first = global_.dimension * contact, normal = problem_.row_count();
    std::vector<std::span<const MatrixEntry>> own;
    for (int k = 0; k < (mu > 0 ? global_.dimension : 1); ++k) own.push_back(columns[first + k]);
    const auto name = [first](int k) { return "H column " + std::to_string(first + k); };
    for (int k = static_cast<int>(own.size()); k < global_.dimension; ++k)
      use_springs(name(k), columns[first + k]);
    const Bodies bodies = bodies_of(name(0), own);
    for (int k = 0; k < static_cast<int>(own.size()); ++k) {
      bodies_of(name(k), std::span(own).subspan(k, 1));
      add_row(name(k), own[k], bodies, global_.w[first + k]);
      const bool is_normal = k == 0;
      add_law(is_normal ? RowKind::normal : RowKind::friction, is_normal ? -1 : normal,
              is_normal ? 0 : -kInfinity, kInfinity, is_normal ? 0 : mu,
              is_normal && mu > 0 ? ContactSet::coulomb : ContactSet::box);
    }
  }

  void check_springs() const {
    const auto unused = std::ranges::find(is_used_, false);
    if (unused == is_used_.end()) return;
    const auto unknown = first_spring() + (unused - is_used_.begin());
    refuse("unknown " + std::to_string(unknown), "a spring that no column has", "springs of one column each");
  }

  const FclibGlobal& global_;
  BodyLayout layout_;
  int bodies_;
  StepProblem problem_;
  std::vector<double> spring_;  // their masses
  std::vector<bool> is_used_;
};

}  // namespace

StepProblem problem_of_fclib(const FclibGlobal& global, std::optional<int> unknowns_of_body) {
  return Import(global, layout_of(global, unknowns_of_body)).take();
}

}  // namespace cleave
