#pragma once

#include <string>

#include "results/json.hpp"
#include "results/stability_json.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth::results {

NLOHMANN_JSON_SERIALIZE_ENUM(SamplingScheme, {{SamplingScheme::random, "random"},
                                              {SamplingScheme::latin_hypercube, "latin-hypercube"},
                                              {SamplingScheme::sobol, "sobol"}})

/// The answer of `study --json`, schema zwidth.study/1 (docs/study.md).
[[nodiscard]] Json study_json(const StudyRun& run, const Study& study);

/// What `study --csv` writes: a row for each of Study::points, at most 2000 units evenly apart.
[[nodiscard]] std::string study_csv(const Study& study);

}  // namespace zwidth::results
