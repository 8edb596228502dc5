#pragma once

#include <cmath>
#include <string>

#include "memory_file.hpp"
#include "zwidth/io/recording_file.hpp"

/// The recording has a channel for each column that was asked for, all of one size and finite; or there is a one-line
/// error. `listed`: whether the file's columns could be listed, without which nothing may be read.
inline void check_recording(const std::string& path, const zwidth::RecordingOptions& options, bool listed) {
  const auto recording = zwidth::read_recording(path, options);
  if (!recording) return require_one_line(recording.error());
  require(listed && recording->sampling_period > 0.0);
  require(recording->channels.size() == options.columns.size());
  for (const zwidth::Channel& channel : recording->channels) {
    require(!channel.samples.empty() && channel.samples.size() == recording->channels.front().samples.size());
    for (const double value : channel.samples) require(std::isfinite(value));
  }
}
