// Names of a table, and error texts for those that are in none.
#pragma once

#include "harness/nearest_name.h"
