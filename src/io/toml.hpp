#pragma once

// The one way toml++ is included: header only (no run-time library), errors as values, shallow nesting (a device file
// needs three levels, and the destructor of a deep document recurses).
#define TOML_EXCEPTIONS 0
#define TOML_MAX_NESTED_VALUES 8
#include <toml++/toml.h>
