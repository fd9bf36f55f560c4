// Ends the program in one line where there is no memory left in a place from which no exception gets out:
// before main, where a destructor needs some, or for the exception itself. Set before the initialisations of
// what is linked statically.
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>

namespace {

constexpr std::size_t kLittleBytes = 1 << 16;

// Of the exception that nobody catches; where there is none, it may be that none could be made.
bool is_out_of_memory() {
  if (std::current_exception() != nullptr) {
    try {
      throw;
    } catch (const std::bad_alloc&) {
      return true;
    } catch (...) {
      return false;
    }
  }
  void* const little = std::malloc(kLittleBytes);
  std::free(little);
  return little == nullptr;
}

std::terminate_handler end_of_others = nullptr;

[[noreturn]] void end() {
  if (!is_out_of_memory()) end_of_others();
  const char* text = "cleave: out of memory\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, std::strlen(text));
  ::_exit(1);
}

[[gnu::constructor(102)]] void end_without_memory() { end_of_others = std::set_terminate(end); }

}  // namespace
