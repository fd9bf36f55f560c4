// ODE as one library of the process: what is global in it.
#pragma once

#include <string>

namespace cleave {

// Once per process; later calls do nothing. From then on ODE prints nothing and never ends the process:
// messages are counted, and what it calls errors is thrown as std::runtime_error. Throws that too where ODE
// does not start.
void initialise_ode();

// Number of messages since the last call; the first one's text goes to first_text, if asked for and if there
// was one.
int take_ode_messages(std::string* first_text);

// Version and configuration of the library, as it reports them.
std::string ode_version();

}  // namespace cleave
