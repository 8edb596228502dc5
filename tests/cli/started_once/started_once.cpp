// Preloaded into the program, it runs the many commands of a test for the start of one, which takes longer than most
// answers. The program is forked where it has been loaded and is about to enter main().
//
// Each line of standard input is a command: the files for its standard output and standard error, and its arguments,
// with a blank between any two. Each exit status is printed on a line; 128 + N when signal N ended it.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Main = int (*)(int, char**, char**);
using StartMain = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);

Main program = nullptr;

void send(int descriptor, const std::string& file) {
  const int opened = ::open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0666);
  if (opened < 0 || ::dup2(opened, descriptor) < 0) ::_exit(127);
  ::close(opened);
}

int run(char* name, std::istringstream words, char** environment) {
  std::string output;
  std::string errors;
  words >> output >> errors;
  std::vector<std::string> arguments;
  for (std::string word; words >> word;) arguments.push_back(word);
  std::vector<char*> pointers{name};
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  send(STDIN_FILENO, "/dev/null");
  send(STDOUT_FILENO, output);
  send(STDERR_FILENO, errors);
  pointers.push_back(nullptr);
  return program(static_cast<int>(pointers.size()) - 1, pointers.data(), environment);
}

int run_all(int, char** arguments, char** environment) {
  ::unsetenv("LD_PRELOAD");  // not for the programs that this one starts
  // All are read first: a child's end moves back in the file what it shares of an input read ahead.
  std::vector<std::string> lines;
  for (std::string line; std::getline(std::cin, line);) lines.push_back(line);
  for (const std::string& line : lines) {
    const pid_t child = ::fork();
    if (child == 0) return run(*arguments, std::istringstream(line), environment);
    int status = 0;
    if (child < 0 || ::waitpid(child, &status, 0) != child) return 1;
    std::cout << (WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status)) << std::endl;
  }
  return 0;
}

}  // namespace

/// The C library's: called by the program's first instructions with its main().
extern "C" int __libc_start_main(Main entry, int count, char** arguments, void (*init)(), void (*fini)(),
                                 void (*rtld_fini)(), void* stack_end) {
  program = entry;
  const auto real = reinterpret_cast<StartMain>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  return real(run_all, count, arguments, init, fini, rtld_fini, stack_end);
}
