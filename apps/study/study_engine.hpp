#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "study/study_checkpoint.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth::study_engine {

/// Processes that do a study together. One process alone is a team too.
class Team {
 public:
  Team() = default;
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;
  virtual ~Team() = default;
  [[nodiscard]] virtual std::size_t rank() const { return 0; }
  [[nodiscard]] virtual std::size_t size() const { return 1; }
  /// Numbers from 0, each to one of the team alone.
  [[nodiscard]] virtual std::uint64_t next_number() { return next_++; }
  /// Until all of the team are here.
  virtual void wait_for_all() {}

 private:
  std::uint64_t next_ = 0;
};

/// The one that this process belongs to.
[[nodiscard]] Team& team();
void set_team(Team& team);

/// Chunks done of this process, of all that were missing.
using StudyProgress = std::function<void(std::uint64_t done, std::uint64_t of)>;

/// Computes every chunk that the output's checkpoints do not have, together with the rest of the team, writes the result
/// and removes the checkpoints. Nothing on ranks other than 0, which have nothing to say.
/// Throws CheckpointProblem and report::OutputFailed; what was computed is kept for StudyCheckpoint::Start::resumed.
[[nodiscard]] std::optional<Study> run_study(const StudyRun& run, const std::string& output,
                                             StudyCheckpoint::Start start, const StudyProgress& progress = {},
                                             const Progress& summing = {});

}  // namespace zwidth::study_engine
