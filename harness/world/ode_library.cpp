#include "harness/world/ode_library.h"

#include <ode/ode.h>

#include <cstdarg>
#include <cstdio>
#include <stdexcept>

namespace cleave {
namespace {

// ODE's handlers take no user data, so what they collect is global.
int message_count = 0;
std::string first_message;

std::string format(const char* text, std::va_list arguments) {
  char line[512];
  std::vsnprintf(line, sizeof line, text, arguments);
  return line;
}

void count_message(int, const char* text, std::va_list arguments) {
  if (message_count++ == 0) first_message = format(text, arguments);
}

// ODE ends the process when this returns.
[[noreturn]] void throw_error(int, const char* text, std::va_list arguments) {
  throw std::runtime_error("ODE: " + format(text, arguments));
}

}  // namespace

void initialise_ode() {
  static const bool done = [] {
    dSetMessageHandler(count_message);
    dSetErrorHandler(throw_error);
    dSetDebugHandler(throw_error);
    return dInitODE2(0) != 0 && dAllocateODEDataForThread(dAllocateMaskAll) != 0;
  }();
  if (!done) throw std::runtime_error("ODE could not be initialised");
}

int take_ode_messages(std::string* first_text) {
  const int count = message_count;
  if (count > 0 && first_text != nullptr) *first_text = first_message;
  message_count = 0;
  return count;
}

std::string ode_version() { return std::string(dODE_VERSION) + " " + dGetConfiguration(); }

}  // namespace cleave
