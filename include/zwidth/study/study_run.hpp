#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "zwidth/batch/batch_stiffness.hpp"
#include "zwidth/study/study.hpp"

namespace zwidth {

/// Units are computed and kept in chunks of so many.
inline constexpr std::uint64_t study_chunk_size = 4096;

/// A study whose chunks are computed by whoever has time, in any order and on any machine: study() in parts.
class StudyRun {
 public:
  /// Throws Error (invalid_argument) as study() does.
  StudyRun(Device device, const StudyDistributions& distributions, StudyOptions options);

  [[nodiscard]] const Device& device() const { return device_; }                            ///< as it is on paper
  [[nodiscard]] const StudyDistributions& distributions() const { return distributions_; }  ///< what varies
  [[nodiscard]] const StudyInputs& inputs() const { return inputs_; }     ///< where the units' numbers come from
  [[nodiscard]] const StudyOptions& options() const { return options_; }  ///< as asked

  [[nodiscard]] std::uint64_t chunk_count() const;  ///< that the units are computed in
  /// Samples of the chunk: study_chunk_size, less in the last one.
  [[nodiscard]] std::size_t size_of(std::uint64_t chunk) const;

  /// The values of the parameters of one sample; `values` has one place each.
  void values(std::uint64_t sample, std::span<double> values) const;
  /// The independent standard normal numbers that it is made of.
  [[nodiscard]] std::vector<double> independent_scores(std::uint64_t sample) const;
  /// The normal scores of the values.
  void scores(std::uint64_t sample, std::span<double> scores) const;
  /// Columns of values, one per parameter: of `count` samples from the first of them on, or of a chunk.
  [[nodiscard]] std::vector<ParameterValues> columns(std::uint64_t first, std::size_t count) const;
  [[nodiscard]] std::vector<ParameterValues> columns(std::uint64_t chunk) const;  ///< of all its samples

  /// The answers of a chunk, on one thread.
  [[nodiscard]] BatchStiffness answers(std::uint64_t chunk, const Progress& progress = {}) const;
  /// The answers for any values of the parameters, on the study's threads. `progress` is called from any of them, one
  /// at a time.
  [[nodiscard]] BatchStiffness answers(const std::vector<ParameterValues>& columns, bool any_user,
                                       const Progress& progress = {}) const;

  /// Whether a unit with these answers meets the specification; without an answer it does not.
  [[nodiscard]] bool meets(const BatchStiffness& answers, std::size_t i) const;

 private:
  Device device_;
  StudyDistributions distributions_;
  StudyOptions options_;
  StudyInputs inputs_;
  SamplingPlan plan_;
};

/// Hands over the answers of a chunk; what it returns is used until the next call.
using ChunkSource = std::function<const BatchStiffness&(std::uint64_t chunk)>;

/// Computes chunks on the study's threads, and consumes them one after the other in the order in which `next` named
/// them; it names none when there are no more. Neither is called from two threads at once. A few chunks at a time are
/// in memory. `within` is told of the work inside of a chunk, from several threads at once. What they throw ends the
/// work and passes through.
void compute_chunks(const StudyRun& run, const std::function<std::optional<std::uint64_t>()>& next,
                    const std::function<void(std::uint64_t chunk, BatchStiffness answers)>& consume,
                    const Progress& within = {});

/// The study from the answers of all its chunks, asked for several times in rising order.
[[nodiscard]] Study summary(const StudyRun& run, const ChunkSource& chunks, const Progress& progress = {});

}  // namespace zwidth
