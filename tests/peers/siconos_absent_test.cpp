// Stands in for the tests of Siconos in a build that does not have it.
#include <gtest/gtest.h>

namespace cleave {
namespace {

TEST(Siconos, IsTestedWhereItIsInstalled) {
  GTEST_SKIP() << "siconos is not in this build: install libsiconos-numerics-dev and build again";
}

}  // namespace
}  // namespace cleave
