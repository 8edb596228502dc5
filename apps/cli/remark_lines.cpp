#include "cli/remark_lines.hpp"

#include <string>

#include "cli/standard_output.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::cli {

void write_warnings(std::span<const Remark> remarks) {
  for (const Remark& remark : remarks) {
    if (remark.severity != Remark::Severity::warning) continue;
    write_standard_error("zwidth: " + remark_line(remark) + "\n");
  }
}

}  // namespace zwidth::cli
