#include "cli/refused_answer.hpp"

#include <fmt/format.h>

#include <string>

#include "cli/subcommand.hpp"
#include "report/text/text_medium.hpp"
#include "report/text/trust_text.hpp"

namespace zwidth::cli {

void print_refused(const Outputs& outputs, const Trust& trust, const std::string& device_name,
                   const std::string& document, std::initializer_list<std::string> files) {
  const std::string verdict = report::verdict_text(trust);
  outputs.print(document.empty() ? report::for_medium(fmt::format("{}\n  trust  {}\n", device_name, verdict))
                                 : document);
  for (const std::string& file : files) {
    if (!file.empty()) throw WorkFailed(fmt::format("{}: is not written: {}", file, verdict));
  }
}

}  // namespace zwidth::cli
