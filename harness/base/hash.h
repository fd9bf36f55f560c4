// Fingerprints of data.
#pragma once

#include "harness/hash.h"
