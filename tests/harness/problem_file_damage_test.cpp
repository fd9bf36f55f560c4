// Every kind of damage to a problem file is one line that names the file and the thing, and exit code 1.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <stdexcept>

#include "tests/harness/problem_file_sample.h"
#include "tests/harness/run_program.h"

namespace cleave {
namespace {

namespace fs = std::filesystem;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Damage {
  std::string name;
  std::vector<std::string> message;  // what the line must contain
  std::function<void(ProblemFile&)> change = [](ProblemFile&) {};
  Instead instead = [](const Hdf5Writer&, const std::string&) { return false; };
};

void PrintTo(const Damage& damage, std::ostream* out) { *out << damage.name; }

Instead leave_out(const std::string& what) {
  return [what](const Hdf5Writer&, const std::string& name) { return name == what; };
}

template <class Values>
Instead replace(const std::string& what, const Hdf5Shape& shape, const Values& values) {
  return [=](const Hdf5Writer& writer, const std::string& name) {
    if (name == what) writer.array(what, shape, values);
    return name == what;
  };
}

template <class Value>
Instead replace_attribute(const std::string& what, const Value& value) {
  return [=](const Hdf5Writer& writer, const std::string& name) {
    if (name == what) writer.attribute(what, value);
    return name == what;
  };
}

const auto kNothing = [](ProblemFile&) {};
const auto kSets = [](ProblemFile& file) { give_sample_sets(file.problem); };

// The sample has 5 bodies and 14 rows: 4 joint rows, then normal and friction row of 5 contacts in turn.
std::vector<Damage> damaged_values() {
  const auto p = [](auto change) { return [change](ProblemFile& file) { change(file.problem); }; };
  return {
      {"nan_rhs", {"rhs[3] = nan", "finite"}, p([](auto& q) { q.rhs[3] = std::nan(""); })},
      {"nan_jacobian", {"jacobian[25] = nan"}, p([](auto& q) { q.jacobian[25] = std::nan(""); })},
      {"nan_lower", {"lower[2] = nan"}, p([](auto& q) { q.lower[2] = std::nan(""); })},
      {"infinite_velocity", {"free_velocity[7] = inf"}, p([](auto& q) { q.free_velocity[7] = kInfinity; })},
      {"infinite_warm_impulse", {"warm_impulse[0] = -inf"}, p([](auto& q) {
         q.warm_impulse[0] = -kInfinity;
       })},
      {"negative_compliance", {"compliance[1] = -1e-05", ">= 0"}, p([](auto& q) {
         q.compliance[1] = -1e-5;
       })},
      {"lower_above_upper", {"lower[5] = 3", "<= upper, which is 0.25"}, p([](auto& q) { q.lower[5] = 3; })},
      {"body_too_large", {"row_body[4] = 5", "0 to 4"}, p([](auto& q) { q.row_body[4] = 5; })},
      {"second_body_too_large", {"row_body[1] = 99", "-1 (static) to 4"}, p([](auto& q) {
         q.row_body[1] = 99;
       })},
      {"body_negative", {"row_body[2] = -2"}, p([](auto& q) { q.row_body[2] = -2; })},
      {"unknown_kind", {"row_kind[4] = 9"}, p([](auto& q) { q.row_kind[4] = static_cast<RowKind>(9); })},
      {"friction_of_no_normal", {"friction_row[5] = 0"}, p([](auto& q) { q.friction_row[5] = 0; })},
      {"friction_of_other_bodies", {"friction_row[7] = 4", "between the same bodies"}, p([](auto& q) {
         q.friction_row[7] = 4;
       })},
      {"friction_before_its_normal", {"friction_row[5] = 6", "a normal row before it"}, p([](auto& q) {
         q.friction_row[5] = 6;
       })},
      {"friction_named_by_no_friction", {"friction_row[0] = 4", "-1"}, p([](auto& q) {
         q.friction_row[0] = 4;
       })},
      {"coefficient_of_a_normal_row",
       {"friction_coefficient[4] = 0.5", "0 for a row that is not friction"},
       p([](auto& q) { q.friction_coefficient[4] = 0.5; })},
      {"constraint_of_other_bodies", {"row_constraint[1] = 0", "which joins other bodies"}, p([](auto& q) {
         q.row_constraint[1] = 0;
       })},
      {"friction_outside", {"friction_row[5] = 14"}, p([](auto& q) { q.friction_row[5] = 14; })},
      {"mass_not_positive", {"mass[36] = -1", "positive definite"}, p([](auto& q) { q.mass[36] = -1; })},
      {"unknown_set", {"contact_set[4] = 3", "0 (box), 1 (cone), 2 (coulomb)"}, p([](auto& q) {
         give_sample_sets(q);
         q.contact_set[4] = static_cast<ContactSet>(3);
       })},
      {"set_of_a_joint", {"contact_set[0] = 2", "on a normal row"}, p([](auto& q) {
         give_sample_sets(q);
         q.contact_set[0] = ContactSet::coulomb;
       })},
      {"set_with_bounds", {"upper[7] = 0.25", "inf where contact_set is no box"}, p([](auto& q) {
         give_sample_sets(q);
         q.upper[7] = 0.25;
       })},
      {"set_without_coefficient", {"friction_coefficient[9] = 0", "> 0"}, p([](auto& q) {
         give_sample_sets(q);
         q.friction_coefficient[9] = 0;
       })},
      {"no_step_length", {"h_s = 0", "> 0"}, p([](auto& q) { q.h_s = 0; })},
      {"nan_position", {"position[4] = nan", "finite"}, [](ProblemFile& f) { f.position[4] = std::nan(""); }},
      {"infinite_orientation",
       {"orientation[0] = inf"},
       [](ProblemFile& f) { f.orientation[0] = kInfinity; }},
      {"negative_step", {"step = -1", ">= 0"}, [](ProblemFile& f) { f.step = -1; }},
      {"nan_erp", {"erp = nan"}, [](ProblemFile& f) { f.erp = std::nan(""); }},
      {"negative_cfm", {"cfm = -1"}, [](ProblemFile& f) { f.cfm = -1; }},
      {"shape_of_no_body",
       {"shape/geom_body[2] = 5", "-1 (static) to 4"},
       [](ProblemFile& f) { f.shapes->geom_body[2] = 5; }},
      {"unknown_shape",
       {"shape/geom_type[1] = 6", "5 (plane)"},
       [](ProblemFile& f) { f.shapes->geom_type[1] = 6; }},
      {"negative_size", {"shape/geom_size[0] = -1"}, [](ProblemFile& f) { f.shapes->geom_size[0] = -1; }},
      {"corners_descend",
       {"shape/convex_first[1] = 99"},
       [](ProblemFile& f) { f.shapes->convex_first[1] = 99; }},
      {"corners_left_over",
       {"shape/convex_first[6] = 7"},
       [](ProblemFile& f) { f.shapes->convex_first[6] = 7; }},
  };
}

std::vector<Damage> damaged_structure() {
  const std::vector<double> twelve(12);
  std::vector<Damage> list = {
      {"old_schema",
       {"schema = \"cleave-problem-0\"", "cleave-problem-1"},
       kNothing,
       replace_attribute("schema", std::string("cleave-problem-0"))},
      {"sets_in_the_first_schema",
       {"schema = \"cleave-problem-1\"", "\"cleave-problem-2\" where there is a contact_set"},
       kSets,
       replace_attribute("schema", std::string("cleave-problem-1"))},
      {"no_sets_in_the_second_schema",
       {"schema = \"cleave-problem-2\"", "\"cleave-problem-1\" where there is none"},
       kNothing,
       replace_attribute("schema", std::string("cleave-problem-2"))},
      {"sets_left_out", {"schema = \"cleave-problem-2\""}, kSets, leave_out("contact_set")},
      {"sets_of_other_rows",
       {"shape of contact_set = (12)", "(14)"},
       kSets,
       replace("contact_set", {12}, std::vector<std::uint8_t>(12))},
      {"sets_too_large",
       {"contact_set[4] = 256", "0 to 255"},
       kSets,
       replace("contact_set", {14}, std::vector<int>{0, 0, 0, 0, 256, 0, 0, 0, 0, 0, 0, 0, 0, 0})},
      {"sets_are_floats",
       {"type of contact_set = 64-bit float"},
       kSets,
       replace("contact_set", {14}, std::vector<double>(14))},
      {"schema_is_a_number", {"type of attribute schema", "text"}, kNothing, replace_attribute("schema", 1)},
      {"step_is_a_fraction", {"type of attribute step", "integer"}, kNothing, replace_attribute("step", 1.5)},
      {"step_too_large",
       {"attribute step = 4294967296"},
       kNothing,
       replace_attribute("step", std::uint64_t{1} << 32)},
      {"seed_negative", {"attribute seed = -1", ">= 0"}, kNothing, replace_attribute("seed", -1)},
      {"h_is_a_text",
       {"type of attribute h_s = text"},
       kNothing,
       replace_attribute("h_s", std::string("1/60"))},
      {"too_few_rows_in_one_array",
       {"shape of upper = (12)", "(14)"},
       kNothing,
       replace("upper", {12}, twelve)},
      {"jacobian_is_flat",
       {"shape of jacobian = (168)", "(14, 12)"},
       kNothing,
       replace("jacobian", {168}, std::vector<double>(168))},
      {"jacobian_is_narrow",
       {"shape of jacobian = (14, 11)"},
       kNothing,
       replace("jacobian", {14, 11}, std::vector<double>(154))},
      {"mass_is_diagonal",
       {"shape of mass = (5, 6)", "(5, 6, 6)"},
       kNothing,
       replace("mass", {5, 6}, std::vector<double>(30))},
      {"velocity_is_narrow",
       {"shape of free_velocity = (5, 3)"},
       kNothing,
       replace("free_velocity", {5, 3}, std::vector<double>(15))},
      {"position_of_other_bodies",
       {"shape of position = (4, 3)", "(5, 3)"},
       kNothing,
       replace("position", {4, 3}, twelve)},
      {"scalar_rhs", {"shape of rhs = ()"}, kNothing, replace("rhs", {}, std::vector<double>(1))},
      {"bodies_are_floats",
       {"type of row_body = 64-bit float", "32-bit signed integer"},
       kNothing,
       replace("row_body", {14, 2}, std::vector<double>(28))},
      {"kinds_too_large",
       {"row_kind[2] = 256", "0 to 255"},
       kNothing,
       replace("row_kind", {14}, std::vector<int>{0, 0, 256, 0, 1, 2, 1, 2, 1, 2, 1, 2, 1, 2})},
      {"kinds_are_unsigned_short",
       {"type of row_kind = 16-bit unsigned integer", "8-bit unsigned integer", "64-bit signed integer"},
       kNothing,
       replace("row_kind", {14}, std::vector<std::uint16_t>(14))},
      {"rhs_is_whole",
       {"type of rhs = 32-bit signed integer", "64-bit float"},
       kNothing,
       replace("rhs", {14}, std::vector<int>(14))},
      {"rhs_is_a_group",
       {"rhs cannot be opened as a dataset"},
       kNothing,
       [](const Hdf5Writer& writer, const std::string& name) {
         if (name == "rhs") writer.group(name);
         return name == "rhs";
       }},
      {"groups_of_other_bodies",
       {"shape of body_group = (4)", "(5)"},
       kNothing,
       [](const Hdf5Writer& writer, const std::string& name) {
         if (name.empty()) writer.array("body_group", {4}, std::vector<int>(4));
         return name.empty();
       }},
      {"solution_without_velocity",
       {"dataset solution/a/velocity is missing"},
       kNothing,
       [](const Hdf5Writer& writer, const std::string& name) {
         if (!name.empty()) return false;
         const Hdf5Writer group = writer.group("solution").group("a");
         for (const char* text : {"solver", "strategy", "kernel", "partitioner", "refiner"})
           group.attribute(text, std::string("x"));
         group.attribute("residual_m_per_s", 0.0);
         group.array("impulse", {14}, std::vector<double>(14));
         return true;
       }},
      {"solution_without_attributes",
       {"attribute solution/a/solver is missing"},
       kNothing,
       [](const Hdf5Writer& writer, const std::string& name) {
         if (name.empty()) writer.group("solution").group("a");
         return name.empty();
       }},
  };
  // Every single thing that may be missing.
  const auto add_missing = [&list](const std::string& kind, const std::string& name) {
    list.push_back({"no_" + name, {kind + " " + name + " is missing"}, kNothing, leave_out(name)});
  };
  add_missing("attribute", "schema");
  ProblemFile sample = sample_file();
  visit_attributes(sample, [&](const char* name, const auto&, Presence presence) {
    if (presence == Presence::required) add_missing("attribute", name);
  });
  visit_arrays(sample, 5, 14, [&](const char* name, const auto&, const Hdf5Shape&, Presence presence) {
    if (presence == Presence::required) add_missing("dataset", name);
  });
  // The sample has friction rows.
  for (const char* name : {"friction_row", "friction_coefficient"}) add_missing("dataset", name);
  return list;
}

class DamagedProblemFile : public ::testing::TestWithParam<Damage> {};

TEST_P(DamagedProblemFile, IsRefusedByName) {
  const Damage& damage = GetParam();
  const TemporaryDirectory directory;
  const fs::path path = directory / "damaged.h5";
  ProblemFile file = sample_file();
  damage.change(file);
  write_unchecked(path, file, damage.instead);
  const std::string error = error_of(path);
  EXPECT_TRUE(error.starts_with(path.string() + ": ")) << error;
  EXPECT_EQ(count_lines(error), 0) << error;
  for (const std::string& part : damage.message) EXPECT_NE(error.find(part), std::string::npos) << error;
}

const auto kNameOf = [](const auto& info) { return info.param.name; };
INSTANTIATE_TEST_SUITE_P(Values, DamagedProblemFile, ::testing::ValuesIn(damaged_values()), kNameOf);
INSTANTIATE_TEST_SUITE_P(Structure, DamagedProblemFile, ::testing::ValuesIn(damaged_structure()), kNameOf);

// The writer of this test writes good files, too: no damage above is its doing.
TEST(ProblemFileDamage, UndamagedSampleIsRead) {
  const TemporaryDirectory directory;
  ProblemFile file = sample_file();
  write_unchecked(directory / "good.h5", file);
  EXPECT_EQ(error_of(directory / "good.h5"), "");
  kSets(file);
  write_unchecked(directory / "good.h5", file);
  EXPECT_EQ(error_of(directory / "good.h5"), "");
}

TEST(ProblemFileDamage, TruncatedAnywhere) {
  const TemporaryDirectory directory;
  write_problem_file(directory / "whole.h5", sample_file());
  const auto size = fs::file_size(directory / "whole.h5");
  for (std::uintmax_t kept = 0; kept < size; kept += size / 40) {
    const fs::path path = directory / "part.h5";
    fs::copy_file(directory / "whole.h5", path, fs::copy_options::overwrite_existing);
    fs::resize_file(path, kept);
    const std::string error = error_of(path);
    EXPECT_TRUE(error.starts_with(path.string() + ": ")) << kept << " of " << size << " bytes: " << error;
  }
}

TEST(ProblemFileDamage, ThingsThatAreNoHdf5File) {
  const TemporaryDirectory directory;
  std::ofstream(directory / "text.h5") << "step,rows\n1,2\n";
  EXPECT_NE(error_of(directory / "text.h5").find("is not a readable HDF5 file"), std::string::npos);
  EXPECT_NE(error_of(directory / "none.h5").find("no such file"), std::string::npos);
  EXPECT_NE(error_of(directory.path()).find("is no file"), std::string::npos);
}

// One line on stderr, exit code 1, nothing from the HDF5 library, nothing created.
TEST(ProblemFileDamage, ProgramSaysItInOneLine) {
  const TemporaryDirectory directory;
  const std::string path = directory / "damaged.h5";
  const std::set<std::string> chosen = {
      "nan_rhs",          "body_too_large",     "lower_above_upper", "negative_compliance",
      "jacobian_is_flat", "jacobian_is_narrow", "old_schema",        "no_rhs"};
  std::vector<Damage> damages = damaged_values();
  for (const Damage& damage : damaged_structure()) damages.push_back(damage);
  std::erase_if(damages, [&](const Damage& damage) { return !chosen.contains(damage.name); });
  ASSERT_EQ(damages.size(), chosen.size());
  for (const Damage& damage : damages) {
    SCOPED_TRACE(damage.name);
    ProblemFile file = sample_file();
    damage.change(file);
    write_unchecked(path, file, damage.instead);
    const ProgramResult replayed = run_cleave({"replay", path, "--out", directory / "out"});
    const ProgramResult verified = run_cleave({"verify", path});
    EXPECT_EQ(replayed.exit_code, 1);
    EXPECT_EQ(verified.exit_code, 1);
    EXPECT_EQ(replayed.err, "cleave replay: " + error_of(path) + "\n");
    EXPECT_EQ(verified.err, "cleave verify: " + error_of(path) + "\n");
    EXPECT_FALSE(fs::exists(directory / "out"));
  }
}

}  // namespace
}  // namespace cleave
