#include "study/study_engine.hpp"

#include <chrono>
#include <utility>
#include <vector>

#include "study/study_result_file.hpp"

namespace zwidth::study_engine {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds between_flushes{2};

Team* current_team = nullptr;

}  // namespace

Team& team() {
  static Team alone;
  return current_team != nullptr ? *current_team : alone;
}

void set_team(Team& team) { current_team = &team; }

std::optional<Study> run_study(const StudyRun& run, const std::string& output, StudyCheckpoint::Start start,
                               const StudyProgress& progress, const Progress& summing) {
  Team& ranks = team();
  if (start == StudyCheckpoint::Start::fresh) StudyCheckpoint::require_none(output);
  ranks.wait_for_all();  // before the first of them makes one
  StudyCheckpoint checkpoint(run, output, ranks.rank(), start);
  std::vector<std::uint64_t> missing;
  for (std::uint64_t chunk = 0; chunk < run.chunk_count(); ++chunk) {
    if (!checkpoint.has(chunk)) missing.push_back(chunk);
  }
  ranks.wait_for_all();  // all have the same list: nobody has added to a checkpoint yet
  std::uint64_t done = 0;
  Clock::time_point flushed = Clock::now();
  compute_chunks(
      run,
      [&]() -> std::optional<std::uint64_t> {
        const std::uint64_t number = ranks.next_number();
        return number < missing.size() ? std::optional(missing[static_cast<std::size_t>(number)]) : std::nullopt;
      },
      [&](std::uint64_t chunk, const BatchStiffness& answers) {
        checkpoint.append(chunk, answers);
        if (Clock::now() - flushed > between_flushes) {
          checkpoint.flush();
          flushed = Clock::now();
        }
        if (progress) progress(++done, missing.size());
      });
  checkpoint.flush();
  ranks.wait_for_all();
  std::optional<Study> study;
  if (ranks.rank() == 0) {
    checkpoint.find_all();
    const ChunkSource chunks = [&](std::uint64_t chunk) -> const BatchStiffness& { return checkpoint.read(chunk); };
    study = summary(run, chunks, summing);
    write_result(output, run, chunks, *study);
    checkpoint.remove();
  }
  ranks.wait_for_all();
  return study;
}

}  // namespace zwidth::study_engine
