#pragma once

namespace zwidth::cli {

/// What the program was built from, as `git describe` names it; "unknown" outside of a clone.
extern const char* const commit;

}  // namespace zwidth::cli
