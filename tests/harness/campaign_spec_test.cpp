// What a campaign's TOML file expands to, written out by hand, and the errors of files that are wrong.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "harness/campaign/spec.h"
#include "harness/experiment/option_values.h"
#include "harness/experiment/options.h"

namespace cleave {
namespace {

using Words = std::vector<std::string>;

std::vector<CampaignCell> cells_of(const std::string& text) { return parse_campaign(text, "c.toml"); }

// The value of one option in every cell, "-" where it is not given.
Words column(const std::vector<CampaignCell>& cells, const std::string& option) {
  Words values;
  for (const CampaignCell& cell : cells)
    values.push_back(cell.options.contains(option) ? cell.options.at(option) : "-");
  return values;
}

std::string error_of(const std::string& text) {
  try {
    cells_of(text);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "no error";
}

const std::string kRocks = "scene = 'rock_pile'\n";

TEST(CampaignSpec, AListIsADimensionAndTheLastKeyVariesFastest) {
  const auto cells = cells_of("solver = ['schur', 'exact']\n" + kRocks + "bodies = [50, 100, 8]\n");
  EXPECT_EQ(column(cells, "solver"), Words({"schur", "schur", "schur", "exact", "exact", "exact"}));
  EXPECT_EQ(column(cells, "bodies"), Words({"50", "100", "8", "50", "100", "8"}));
  EXPECT_EQ(cells[4].arguments(), Words({"--bodies=100", "--scene=rock_pile", "--solver=exact"}));
}

TEST(CampaignSpec, ATextWithCommasIsOneValue) {
  const auto cells = cells_of(kRocks + "partitioner = ['mindp,mix', 'bfs']\nrefiner = 'none,fm'\n");
  EXPECT_EQ(column(cells, "partitioner"), Words({"mindp,mix", "bfs"}));
  EXPECT_EQ(column(cells, "refiner"), Words({"none,fm", "none,fm"}));
}

Words labels(const std::vector<CampaignCell>& cells) {
  Words found;
  for (const CampaignCell& cell : cells) found.push_back(cell.label);
  return found;
}

TEST(CampaignSpec, ALabelHoldsTheValuesOfItsCell) {
  EXPECT_EQ(labels(cells_of(kRocks + "bodies = [5, 6]\nrounds = 2\nlabel = 'rocks_{bodies}/{scene}!'\n")),
            Words({"rocks_5/rock_pile!", "rocks_6/rock_pile!", "rocks_5/rock_pile!", "rocks_6/rock_pile!"}));
  EXPECT_EQ(labels(cells_of(kRocks)), Words({""}));
}

TEST(CampaignSpec, AnIncludeHasALabelOfItsOwnOrThatOfTheFile) {
  const std::string text = kRocks + "label = 'rocks_{bodies}'\nbodies = 5\n[[include]]\nbodies = 6\n";
  EXPECT_EQ(labels(cells_of(text)), Words({"rocks_5", "rocks_6"}));
  EXPECT_EQ(labels(cells_of(text + "label = 'many'\n")), Words({"rocks_5", "many"}));
}

TEST(CampaignSpec, ACellThatIsThereAlreadyKeepsItsLabel) {
  EXPECT_EQ(
      labels(cells_of(
          kRocks + "label = 'first'\nbodies = 5\n[[include]]\nlabel = 'again_{bodies}'\nbodies = [5, 6]\n")),
      Words({"first", "again_6"}));
}

TEST(CampaignSpec, ABadLabelIsNamedWithItsLine) {
  EXPECT_EQ(error_of(kRocks + "bodies = [5, 6]\nlabel = 'rocks'\n"),
            "c.toml:3: label: two cells are called 'rocks'");
  EXPECT_EQ(error_of(kRocks + "bodies = 5\nlabel = 'rocks_{bodys}'\n"),
            "c.toml:3: label: 'bodys' is no key of the cell (did you mean 'bodies'?)");
  EXPECT_EQ(error_of(kRocks + "label = 'rocks_{scene'\n"), "c.toml:2: label: has a { without }");
  EXPECT_EQ(error_of(kRocks + "label = ''\n"),
            "c.toml:2: label: is empty, or has characters that cannot be printed");
  EXPECT_EQ(error_of(kRocks + "label = ['a']\n"), "c.toml:2: label: a list is not a text");
}

TEST(CampaignSpec, RangesHaveBothEndsAndNoRoundingErrors) {
  EXPECT_EQ(column(cells_of(kRocks + "mu = { from = 0, to = 0.5, step = 0.1 }\n"), "mu"),
            Words({"0", "0.1", "0.2", "0.3", "0.4", "0.5"}));
  EXPECT_EQ(column(cells_of(kRocks + "mu = { from = 0, to = 0.3, step = 0.1 }\n"), "mu"),
            Words({"0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(column(cells_of(kRocks + "mu = { from = 0, to = 0.29, step = 0.1 }\n"), "mu"),
            Words({"0", "0.1", "0.2"}));
  EXPECT_EQ(column(cells_of(kRocks + "cfm = { from = 1e-9, to = 1e-5, factor = 10 }\n"), "cfm"),
            Words({"1e-09", "1e-08", "1e-07", "1e-06", "1e-05"}));
  EXPECT_EQ(column(cells_of(kRocks + "bodies = { from = 50, to = 849, factor = 2 }\n"), "bodies"),
            Words({"50", "100", "200", "400", "800"}));
  EXPECT_EQ(column(cells_of(kRocks + "seed = { from = 7, to = 7, step = 3 }\n"), "seed"), Words({"7"}));
  EXPECT_EQ(column(cells_of(kRocks + "bodies = { from = 100000, to = 200000, step = 100000 }\n"), "bodies"),
            Words({"100000", "200000"}));
}

TEST(CampaignSpec, FlagsAreGivenOrNot) {
  const auto cells = cells_of(kRocks + "skip-small-islands = [true, false]\n");
  EXPECT_EQ(cells[0].arguments(), Words({"--scene=rock_pile", "--skip-small-islands"}));
  EXPECT_EQ(cells[1].arguments(), Words({"--scene=rock_pile"}));
}

TEST(CampaignSpec, ExclusionNeedsAllKeysOfARuleAndOneValueOfEach) {
  const auto cells =
      cells_of(kRocks +
               "bodies = [10, 20, 30]\nseed = [1, 2]\n"
               "[[exclude]]\nbodies = [10, 30]\nseed = 1\n[[exclude]]\nbodies = 20\nseed = 2\n");
  EXPECT_EQ(column(cells, "bodies"), Words({"10", "20", "30"}));
  EXPECT_EQ(column(cells, "seed"), Words({"2", "1", "2"}));
}

TEST(CampaignSpec, InclusionAddsAGridAndTakesOverKeysOfOneValue) {
  const auto cells = cells_of(kRocks +
                              "mu = 0.3\nbodies = [10, 20]\n[[exclude]]\nbodies = 20\n"
                              "[[include]]\nbodies = [20, 40]\nseed = 5\n[[include]]\nmu = 0.4\n");
  EXPECT_EQ(column(cells, "bodies"), Words({"10", "20", "40", "-"}));
  EXPECT_EQ(column(cells, "seed"), Words({"-", "5", "5", "-"}));
  EXPECT_EQ(column(cells, "mu"), Words({"0.3", "0.3", "0.3", "0.4"}));
}

TEST(CampaignSpec, ACellOfTwoSeriesRunsOnce) {
  const auto cells = cells_of(
      "[[include]]\nscene = 'rock_pile'\nbodies = [4, 5]\n"
      "[[include]]\nscene = 'rock_pile'\nmu = 0.5\nbodies = [5, 6]\n");
  EXPECT_EQ(column(cells, "bodies"), Words({"4", "5", "6"}));
}

TEST(CampaignSpec, WithoutASceneTheKeysAreForWhatIsIncluded) {
  const auto cells = cells_of(
      "seed = [1, 2]\nmu = 0.3\n[[include]]\nscene = 'rock_pile'\nbodies = [4, 5]\n"
      "[[include]]\nscene = 'log_tower'\nseed = 7\n");
  EXPECT_EQ(column(cells, "bodies"), Words({"4", "4", "5", "5", "-"}));
  EXPECT_EQ(column(cells, "seed"), Words({"1", "2", "1", "2", "7"}));
  EXPECT_EQ(column(cells, "mu"), Words(5, "0.3"));
}

TEST(CampaignSpec, WithoutASceneExclusionsAreOfWhatIsIncluded) {
  const std::string two = "[[include]]\nscene = 'rock_pile'\n[[include]]\nscene = 'log_tower'\nseed = 7\n";
  const auto cells = cells_of("seed = [1, 2]\nmu = [0.3, 0.4]\n[[exclude]]\nseed = [2, 7]\nmu = 0.4\n" + two);
  EXPECT_EQ(column(cells, "seed"), Words({"1", "1", "2", "7"}));
  EXPECT_EQ(column(cells, "mu"), Words({"0.3", "0.4", "0.3", "0.3"}));
  try {
    cells_of("seed = [1, 2]\n[[exclude]]\nseed = 3\n" + two);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("exclude: removes no cell"), std::string::npos) << error.what();
  }
}

TEST(CampaignSpec, RoundsAreInterleaved) {
  const auto cells = cells_of("rounds = 2\n" + kRocks + "bodies = [10, 20]\n");
  EXPECT_EQ(column(cells, "bodies"), Words({"10", "20", "10", "20"}));
  ASSERT_EQ(cells.size(), 4u);
  EXPECT_EQ(cells[2].round, 2);
  EXPECT_EQ(cells[0].run_id, cells[2].run_id);
  EXPECT_NE(cells[0].name(), cells[2].name());
}

TEST(CampaignSpec, NamesCellsByRunIdThreadsAndRound) {
  const auto cells = cells_of(kRocks + "threads = [1, 2]\nsteps = 10\n");
  const RunOptions options = parse_run_options({{"scene", "rock_pile"}, {"steps", "10"}, {"out", "x"}});
  EXPECT_EQ(cells[0].run_id, run_id(options));
  EXPECT_EQ(cells[0].name(), run_id(options) + "_t1_r1");
  EXPECT_EQ(cells[1].name(), run_id(options) + "_t2_r1");
}

TEST(CampaignSpec, ErrorsNameFileLineKeyAndTheNearestKey) {
  const std::pair<std::string, std::string> wrong[] = {
      {kRocks + "bodeis = 5\n",
       "c.toml:2: bodeis: is no option of cleave run that a cell may have (did you mean 'bodies'?)"},
      {kRocks + "out = 'x'\n", "c.toml:2: out: is no option of cleave run that a cell may have"},
      {kRocks + "[[include]]\nbodys = 5\n",
       "c.toml:3: bodys: is no option of cleave run that a cell may have (did you mean 'bodies'?)"},
      {kRocks + "[[exlude]]\nbodies = 5\n",
       "c.toml:2: exlude: is no option of cleave run that a cell may have (did you mean 'exclude'?)"},
      {kRocks + "\nmu = [0.5, -1]\n", "c.toml:3: mu: -1 is not in [0, inf)"},
      {kRocks + "solver = 'densse'\n", "c.toml:2: solver: 'densse' is unknown (did you mean 'dense'?)"},
      {kRocks + "layers = 4\n", "c.toml:2: layers: "},
      {"bodies = 4\n", "c.toml: has no cell; the key scene is required"},
      {kRocks + "bodies = []\n", "c.toml:2: bodies: an empty list makes no cell"},
      {kRocks + "bodies = ''\n", "c.toml:2: bodies: is not a text, a number"},
      {kRocks + "bodies = [[4]]\n", "c.toml:2: bodies: is not a text, a number"},
      {kRocks + "bodies = 2024-01-31\n", "c.toml:2: bodies: is not a text, a number"},
      {kRocks + "bodies = { from = 4, to = 8 }\n", "c.toml:2: bodies: needs either step or factor"},
      {kRocks + "bodies = { from = 4, to = 8, step = 1, factor = 2 }\n", "needs either step or factor"},
      {kRocks + "bodies = { from = 4, to = 8, stop = 1 }\n", "c.toml:2: bodies.stop: "},
      {kRocks + "bodies = { from = 4, step = 1 }\n", "c.toml:2: bodies.to: "},
      {kRocks + "bodies = { from = 4, to = 8, step = 0 }\n", "c.toml:2: bodies.step: 0 is not in (0, inf)"},
      {kRocks + "bodies = { from = 4, to = 8, factor = 1 }\n",
       "c.toml:2: bodies.factor: 1 is not in (1, inf)"},
      {kRocks + "bodies = { from = 8, to = 4, step = 1 }\n", "c.toml:2: bodies: to is below from"},
      {kRocks + "mu = { from = 0, to = 4, factor = 2 }\n", "c.toml:2: mu: from and to must be above 0"},
      {kRocks + "seed = { from = 0, to = 1e9, step = 1 }\n", "c.toml:2: seed: makes more than 100000 values"},
      {kRocks + "seed = { from = 1, to = 9e4, step = 1 }\nmu = [1, 2]\n",
       "c.toml:3: mu: makes more than 100000 cells"},
      {kRocks + "[[exclude]]\nbodies = 5\n", "c.toml:3: bodies: is no key of the cells"},
      {kRocks + "bodies = 4\n[[exclude]]\nbodies = 5\n",
       "c.toml:3: exclude: removes no cell: bodies: '5' is unknown"},
      {kRocks + "refiner = ['none', 'fm']\n[[exclude]]\nrefiner = 'fn'\n", "did you mean 'fm'?"},
      {kRocks + "bodies = 4\n[[exclude]]\n", "c.toml:3: exclude: has no key and would remove every cell"},
      {kRocks + "bodies = 4\n[[exclude]]\nbodies = 4\n", "c.toml: has no cell"},
      {kRocks + "[[include]]\n", "c.toml:2: include: has no key"},
      {kRocks + "[include]\nbodies = 4\n", "c.toml:2: include: is not a list of tables: [[include]]"},
      {kRocks + "bodies = [4, 4]\n", "cell 2: is there already"},
      {kRocks + "[[include]]\nbodies = 200\n", "c.toml:2: include: adds no cell that is not there already"},
      {kRocks + "[[include]]\nmemory-limit = 2\n", "c.toml:2: cell 2: is there already"},
      {kRocks + "rounds = 0\n", "c.toml:2: rounds: 0 is not in [1, 1000]"},
      {kRocks + "rounds = 'x'\n", "c.toml:2: rounds: "},
      {"", "c.toml: has no cell"},
      {kRocks + "bodies = \n", "c.toml:2: not TOML: "},
      {kRocks + "bodies = 4\nbodies = 5\n", "c.toml:3: not TOML: "},
      {kRocks + "steps = 4\nmeasure-every = 5\n", "c.toml:3: measure-every: 5 measures none of --steps 4"},
  };
  for (const auto& [text, error] : wrong)
    EXPECT_NE(error_of(text).find(error), std::string::npos) << text << "\nsays: " << error_of(text);
}

TEST(CampaignSpec, NoErrorIsLongerThanALine) {
  for (const char* text : {"bodies = \n", "x = 1", "scene = 'x\x01'", "= 3", "[[", "scene = 'none'"})
    EXPECT_EQ(error_of(text).find('\n'), std::string::npos) << error_of(text);
  EXPECT_THROW(read_spec("/nonexistent/spec.toml"), std::invalid_argument);
  EXPECT_THROW(read_spec("/"), std::invalid_argument);
}

// Damaged files are expanded or refused, and nothing else.
TEST(CampaignSpec, DamagedFilesAreExpandedOrRefused) {
  const std::string good =
      "rounds = 2\n" + kRocks +
      "bodies = [4, 5]\nmu = { from = 1, to = 3, step = 1 }\nskip-small-islands = true\n" +
      "partitioner = 'mindp,mix@tau-mix=0.5'\n[[exclude]]\nbodies = 4\nmu = [1, 2]\n[[include]]\nbodies = "
      "7\n";
  std::mt19937 random(3);
  int expanded = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::string text = good;
    for (unsigned edits = 1 + random() % 2; edits > 0; --edits) {
      const std::size_t place = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[place] = "=[]{}'\"\n,.#-5ax\0\xff"[random() % 17];
          break;
        case 1:
          text.erase(place, 1 + random() % 8);
          break;
        default:
          text.insert(place, text.substr(random() % text.size(), 1 + random() % 8));
      }
      if (text.empty()) text = " ";
    }
    const std::string error = error_of(text);
    expanded += error == "no error";
    EXPECT_TRUE(error == "no error" || error.starts_with("c.toml:")) << text << error;
  }
  EXPECT_GT(expanded, 20);
}

TEST(CampaignSpec, AThousandCellsHaveAsManyNames) {
  std::set<std::string> names;
  for (const CampaignCell& cell : cells_of(
           kRocks + "seed = { from = 1, to = 100, step = 1 }\nthreads = { from = 1, to = 10, step = 1 }\n"))
    names.insert(cell.name());
  EXPECT_EQ(names.size(), 1000u);
}

}  // namespace
}  // namespace cleave
