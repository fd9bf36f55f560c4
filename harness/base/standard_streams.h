// The process's own three files and the signals that writing raises.
#pragma once

namespace cleave {

// To be called before anything else is opened. Opens those of the descriptors 0, 1 and 2 that are closed on
// /dev/null: the next file would get their number, and lines for people would land in it. A reader that goes
// away and a file that grows too large are errors of the write, not signals that end the program.
void open_standard_streams();

enum class OutputState { whole, reader_gone };

// Flushes standard output. Throws std::runtime_error with one line where it does not hold all that was
// printed; a reader that had enough is no error.
OutputState finish_standard_output();

}  // namespace cleave
