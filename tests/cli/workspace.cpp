#include "cli/workspace.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace zwidth::cli {

namespace fs = std::filesystem;

Workspace::Workspace() {
  std::string pattern = (fs::temp_directory_path() / "zwidth_cli_XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot create " + pattern);
  directory_ = pattern;
  fs::permissions(directory_, fs::perms::others_read | fs::perms::others_exec, fs::perm_options::add);
  fs::copy(fs::path(ZWIDTH_SOURCE_DIR) / "devices", directory_ / "devices", fs::copy_options::recursive);
  fs::copy(fs::path(ZWIDTH_SOURCE_DIR) / "recordings", directory_ / "recordings", fs::copy_options::recursive);
}

Workspace::~Workspace() {
  std::error_code ignored;
  fs::remove_all(directory_, ignored);
}

Outcome Workspace::run(const std::string& command_line) const {
  // The command line stands in a file of its own, so that it needs no quoting here.
  // Its locale and the width of its lines do not depend on who runs the tests.
  write(".command", fmt::format("export PATH='{}':$PATH LC_ALL=C.UTF-8 XDG_STATE_HOME=$PWD/.state\nunset COLUMNS\n{}\n",
                                ZWIDTH_PROGRAM_DIR, command_line));
  const std::string wrapped =
      fmt::format("cd '{0}' && bash .command > .output 2> .errors < /dev/null", directory_.string());
  const int raw = std::system(wrapped.c_str());
  const int status = WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
  return {status, contents(".output"), contents(".errors")};
}

void Workspace::expect_refusal(const std::string& command_line, const std::string& message) const {
  const Outcome outcome = run(command_line);
  EXPECT_EQ(outcome.status, 2) << command_line << "\n" << outcome.output;
  EXPECT_THAT(outcome.output, ::testing::IsEmpty()) << command_line;
  EXPECT_THAT(outcome.errors, ::testing::HasSubstr(message)) << command_line;
  std::istringstream lines(outcome.errors);
  for (std::string line; std::getline(lines, line);)
    EXPECT_THAT(line, ::testing::StartsWith("zwidth: ")) << command_line;
}

std::string Workspace::contents(const std::string& name) const {
  std::ifstream file(directory_ / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void Workspace::write(const std::string& name, std::string_view contents) const {
  std::ofstream(directory_ / name, std::ios::binary) << contents;
}

}  // namespace zwidth::cli
