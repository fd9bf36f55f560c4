// Ranges of numbers, and numbers as text.
#pragma once

#include "harness/options_text.h"
