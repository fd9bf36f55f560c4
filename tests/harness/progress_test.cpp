#include "harness/base/progress.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <stdexcept>
#include <string>

namespace cleave {
namespace {

TEST(ExpectedSeconds, AreThoseOfTheLastLine) {
  EXPECT_EQ(expected_seconds("rock_pile: step 34 of 500, 10 s, about 137 s to go\n"), 147);
  EXPECT_EQ(
      expected_seconds("a remark\nrock_pile: step 34 of 500, 10 s, about 137 s to go\n"
                       "rock_pile: step 70 of 500, 20 s, about 123 s to go\nthe world stopped at step 80\n"),
      143);
}

TEST(ExpectedSeconds, AreUnknownWithoutALine) {
  for (const char* printed : {"", "nothing of the kind\n", "rock_pile: step 34 of 500, 10", "step by step\n"})
    EXPECT_FALSE(expected_seconds(printed)) << printed;
}

constexpr int kPatience_ms = 10000;

// Standard error as a terminal of so many columns; what came to it.
class Terminal {
 public:
  explicit Terminal(unsigned short columns) : stderr_(::dup(STDERR_FILENO)) {
    winsize size{24, columns, 0, 0};
    if (::openpty(&master_, &slave_, nullptr, nullptr, &size) != 0) throw std::runtime_error("no terminal");
    ::dup2(slave_, STDERR_FILENO);
  }
  ~Terminal() {
    ::dup2(stderr_, STDERR_FILENO);
    for (const int descriptor : {stderr_, slave_, master_}) ::close(descriptor);
  }
  // Until so many bytes have come: the system may hand them on in pieces. What came by then, where no more
  // do.
  std::string read(std::size_t size) const {
    std::string all;
    char bytes[1000];
    pollfd waits{.fd = master_, .events = POLLIN, .revents = 0};
    while (all.size() < size && ::poll(&waits, 1, kPatience_ms) > 0) {
      const ssize_t came = ::read(master_, bytes, sizeof bytes);
      if (came <= 0) break;
      all.append(bytes, static_cast<std::size_t>(came));
    }
    return all;
  }

 private:
  int stderr_, master_ = -1, slave_ = -1;
};

void expect(const std::string& text, const Terminal& terminal) {
  EXPECT_EQ(terminal.read(text.size()), text);
}

TEST(ProgressLine, IsCutToTheTerminal) {
  const Terminal terminal(12);
  ProgressLine line("sweep");
  line.show("of \u00e4\u00f6\u00fc and more");
  expect("\rsweep: of \u00e4", terminal);
  line.show("end");
  expect("\rsweep: end ", terminal);
}

TEST(ProgressLine, IsWholeWhereTheTerminalSaysNoWidth) {
  const Terminal terminal(0);
  ProgressLine("sweep").show("a line that goes on and on and on");
  expect("\rsweep: a line that goes on and on and on\r\n", terminal);
}

}  // namespace
}  // namespace cleave
