#pragma once

#include <string>

#include "zwidth/study/study_run.hpp"

namespace zwidth::study_engine {

/// Ahead of the work: throws where this program cannot write_result(), since a part of it is not there.
void require_writer();

/// Writes the study as HDF5: /parameters/KEY, /critical_stiffness, /status, /frequency_rad_s, /mode, /verdict, /any_user,
/// /failures; chunked and compressed, the same bytes for the same study; attributes with the device, the study, its
/// options, the version and the summary as JSON (docs/study.md). Written beside and renamed, whole or not at all.
/// Throws report::OutputFailed.
void write_result(const std::string& path, const StudyRun& run, const ChunkSource& chunks, const Study& study);

}  // namespace zwidth::study_engine
