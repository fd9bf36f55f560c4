// The program cleave.
#include "harness/program.h"

int main(int argc, char** argv) { return cleave::run_program("cleave", {}, argc, argv); }
