#include "identification/initial_fit/quiet_solve.hpp"

#include <glog/logging.h>

#include <mutex>

namespace zwidth::internal {
namespace {

class QuietGlog {
 public:
  QuietGlog() {
    const std::lock_guard lock(mutex_);
    if (solves_++ == 0) {
      level_ = FLAGS_minloglevel;
      FLAGS_minloglevel = google::GLOG_FATAL;
    }
  }
  ~QuietGlog() {
    const std::lock_guard lock(mutex_);
    if (--solves_ == 0) FLAGS_minloglevel = level_;
  }
  QuietGlog(const QuietGlog&) = delete;
  QuietGlog& operator=(const QuietGlog&) = delete;

 private:
  inline static std::mutex mutex_;
  inline static int solves_ = 0;
  inline static int level_ = 0;
};

}  // namespace

ceres::Solver::Summary quiet_solve(ceres::Solver::Options options, ceres::Problem& problem) {
  const QuietGlog quiet;
  options.logging_type = ceres::SILENT;
  options.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

}  // namespace zwidth::internal
