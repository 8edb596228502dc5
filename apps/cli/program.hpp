#pragma once

namespace zwidth::cli {

/// The whole program: returns its exit status, 0 done, 1 the work failed, 2 wrong usage or bad input.
[[nodiscard]] int run_program(int argument_count, char** arguments);

}  // namespace zwidth::cli
