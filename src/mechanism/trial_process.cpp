#include "mechanism/trial_process.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace zwidth::internal {
namespace {

constexpr rlim_t most_work = 10;   // s of a processor
constexpr unsigned longest = 120;  // s, where it waits for one

}  // namespace

bool ends_in_trial(const std::function<void()>& work) {
  const pid_t child = fork();
  if (child < 0) return false;
  if (child == 0) {
    for (const int each : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGALRM, SIGXCPU}) std::signal(each, SIG_DFL);
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    const rlimit work_limit{most_work, most_work};
    setrlimit(RLIMIT_CPU, &work_limit);
    alarm(longest);
    try {
      work();
    } catch (...) {  // what it throws, it throws here too
    }
    _exit(0);
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return false;
  }
  return WIFEXITED(status);
}

}  // namespace zwidth::internal
