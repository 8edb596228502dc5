// zwidth-study: `zwidth study` in several processes, mpirun -n R zwidth-study FILE --study STUDY.toml --output OUT.h5 ...
#define OMPI_SKIP_MPICXX  // the C interface alone
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "cli/program.hpp"
#include "study/study_engine.hpp"

namespace {

/// The processes that mpirun started. Who comes first takes the next number: it lies in the memory of rank 0, which is
/// like the others besides, and is read and raised in one step.
class MpiTeam : public zwidth::study_engine::Team {
 public:
  MpiTeam() {
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    const MPI_Aint bytes = rank_ == 0 ? sizeof(unsigned long long) : 0;
    MPI_Win_allocate(bytes, sizeof(unsigned long long), MPI_INFO_NULL, MPI_COMM_WORLD, &counter_, &window_);
    if (rank_ == 0) *counter_ = 0;
    MPI_Barrier(MPI_COMM_WORLD);
    MPI_Win_lock_all(0, window_);
  }
  ~MpiTeam() override {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
  }
  MpiTeam(const MpiTeam&) = delete;
  MpiTeam& operator=(const MpiTeam&) = delete;

  [[nodiscard]] std::size_t rank() const override { return static_cast<std::size_t>(rank_); }
  [[nodiscard]] std::size_t size() const override { return static_cast<std::size_t>(size_); }
  [[nodiscard]] std::uint64_t next_number() override {
    const unsigned long long one = 1;
    unsigned long long number = 0;
    MPI_Fetch_and_op(&one, &number, MPI_UNSIGNED_LONG_LONG, 0, 0, MPI_SUM, window_);
    MPI_Win_flush(0, window_);
    return number;
  }
  /// Asleep: in MPI_Barrier a process keeps its core busy until the last one comes, all of the summing long.
  void wait_for_all() override {
    using std::chrono::microseconds;
    constexpr microseconds longest{10'000};
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    microseconds pause{100};
    for (int all_are_here = 0;;) {
      MPI_Test(&request, &all_are_here, MPI_STATUS_IGNORE);
      if (all_are_here != 0) return;
      std::this_thread::sleep_for(pause);
      pause = std::min(2 * pause, longest);
    }
  }

 private:
  int rank_ = 0;
  int size_ = 1;
  unsigned long long* counter_ = nullptr;
  MPI_Win window_ = MPI_WIN_NULL;
};

}  // namespace

int main(int argument_count, char** arguments) {
  int threads = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argument_count, &arguments, MPI_THREAD_SERIALIZED, &threads);
  if (threads < MPI_THREAD_SERIALIZED) {
    (void)std::fputs("zwidth-study: this MPI takes no calls from several threads; build it with thread support\n",
                     stderr);
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  int status = 1;
  {
    MpiTeam team;
    zwidth::study_engine::set_team(team);
    std::string name = arguments[0];
    std::string command = "study";
    std::vector<char*> all{name.data()};
    // The version is the program's, not the command's.
    if (argument_count != 2 || std::string_view(arguments[1]) != "--version") all.push_back(command.data());
    all.insert(all.end(), arguments + 1, arguments + argument_count);
    status = zwidth::cli::run_program(static_cast<int>(all.size()), all.data());
    // Others may be waiting for this one: all end, and what they have computed is kept.
    if (status != 0) MPI_Abort(MPI_COMM_WORLD, status);
  }
  MPI_Finalize();
  return status;
}
