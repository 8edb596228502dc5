#pragma once

#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "zwidth/study/study_run.hpp"

namespace zwidth::study_engine {

/// A checkpoint that does not belong to this study, or cannot be used as asked: what() names the file and the remedy.
struct CheckpointProblem : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What decides the answers of a study, as lines "name: value": the program's version, the device, the distributions, the
/// sampling. Studies of equal descriptions have equal answers, bit for bit.
[[nodiscard]] std::string description(const StudyRun& run);

/// The answers that are kept while a study runs, in files beside its result: OUT.partial.0, .1, ... one per rank.
///
/// A file is the description, and then one record per chunk: its number, its size, the answers, a CRC-32 of all that. A
/// record that is cut off or damaged ends the file: a process that is killed at any instant loses what it was writing.
class StudyCheckpoint {
 public:
  enum class Start { fresh, resumed };

  /// Opens this rank's file for appending, alone; and of a resumed study finds the chunks in all ranks' files.
  /// Throws CheckpointProblem for files of another study or version, for files that are there though the study is not
  /// resumed, and where another process writes; report::OutputFailed where the disk fails.
  StudyCheckpoint(const StudyRun& run, std::string output, std::size_t rank, Start start);
  ~StudyCheckpoint();
  StudyCheckpoint(const StudyCheckpoint&) = delete;
  StudyCheckpoint& operator=(const StudyCheckpoint&) = delete;

  /// Throws CheckpointProblem where the output has checkpoints: before any rank begins a study afresh.
  static void require_none(const std::string& output);

  [[nodiscard]] bool has(std::uint64_t chunk) const { return places_.contains(chunk); }
  void append(std::uint64_t chunk, const BatchStiffness& answers);
  /// On the disk, not in the system's memory alone.
  void flush();

  /// Finds what other ranks have appended since.
  void find_all();
  /// Valid until the next call. Throws CheckpointProblem where the chunk is missing or its record damaged.
  [[nodiscard]] const BatchStiffness& read(std::uint64_t chunk);

  /// Removes the files of all ranks: their answers are in the result.
  void remove();

 private:
  struct Place {
    std::size_t file = 0;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
  };
  [[nodiscard]] std::uint64_t scan(std::size_t file);

  const StudyRun& run_;
  std::string output_;
  std::string own_path_;
  int own_ = -1;
  std::uint64_t end_ = 0;
  std::vector<std::string> paths_;  // of all ranks
  std::vector<int> files_;
  std::map<std::uint64_t, Place> places_;
  std::vector<char> bytes_;
  BatchStiffness answers_;
};

}  // namespace zwidth::study_engine
