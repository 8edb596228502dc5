#include <array>

#include "words/problem_phrase.hpp"

namespace zwidth::internal {

std::span<const ProblemPhrase> study_file_problem_phrases() {
  using enum ProblemCode;
  static constexpr std::array phrases{
      ProblemPhrase{not_told_by_uncertainty, "not_told_by_uncertainty",
                    "the device's [uncertainty] does not tell {name}",
                    "must be another distribution, or a device that identify wrote"},
      ProblemPhrase{no_relative_width, "no_relative_width", "is {value:exact}, of {of:exact}",
                    "must be finite and > 0, of a number that is not 0"},
      ProblemPhrase{weights_all_zero, "weights_all_zero", "are all 0", "must be > 0 for one value at least"},
      ProblemPhrase{no_file_beside_study, "no_file_beside_study", "names a file, and there is none beside this study",
                    "must be \"discrete\" with the values and weights themselves"},
      ProblemPhrase{not_a_parameter_of_study, "not_a_parameter_of_study", "\"{name}\" has no [[parameter]]",
                    "must be one of those"},
      ProblemPhrase{
          no_samples_in_file, "no_samples_in_file", "{?text|\"{text}\" is no sample}{!text|has no samples}",
          "must have a number per line, or a number, a blank and how often it was seen; decimals have a point"}};
  return phrases;
}

}  // namespace zwidth::internal
