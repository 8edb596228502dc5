#include "cli/generate.hpp"

#include <string>
#include <vector>

#include "cli/command_description.hpp"
#include "cli/manual_page.hpp"
#include "cli/shell_completion.hpp"
#include "cli/standard_output.hpp"
#include "results/device_keys_json.hpp"

namespace zwidth::cli {
namespace {

const std::string page_of = "man-";  // and a command's name

std::string generated(const CLI::App& app, const std::string& kind) {
  const std::vector<CommandDescription> commands = describe(app);
  if (kind == "bash") return bash_completion(commands);
  if (kind == "zsh") return zsh_completion(commands);
  if (kind == "fish") return fish_completion(commands);
  if (kind == "keys") return results::device_keys_json().dump() + "\n";
  for (const CommandDescription& command : commands) {
    if (kind == page_of + command.name) return manual_page(commands, command);
  }
  return manual_page(commands, commands.front());
}

}  // namespace

void add_generate(CLI::App& app) {
  std::vector<std::string> kinds{"bash", "zsh", "fish", "man", "keys"};
  for (const CLI::App* command : app.get_subcommands({})) kinds.push_back(page_of + command->get_name());
  app.add_option_function<std::string>(
         "--generate",
         [&app](const std::string& kind) {
           write_standard_output(generated(app, kind));
           throw Generated();
         },
         "Print completion for a shell, the keys of the device file, or a manual page, and exit")
      ->type_name("KIND")
      ->check(CLI::IsMember(kinds));
}

}  // namespace zwidth::cli
