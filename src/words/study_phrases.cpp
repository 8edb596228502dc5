#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> study_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{
          units_without_answer, "units_without_answer", doubt,
          "{failed:n} of {samples:n} units have no answer ({reason}): they count as units that miss the specification",
          "", "keep the distributions away from such devices"},
      Phrase{unit_limits_doubtful, "unit_limits_doubtful", doubt,
             "the limits of {doubtful:n} of {samples:n} units are doubtful", "", "see analyze of the worst device"},
      Phrase{nothing_specified, "nothing_specified", note, "nothing is specified", "there is no yield to state",
             "give [specification] critical_stiffness"},
      Phrase{samples_spread_evenly, "samples_spread_evenly", note,
             "the samples are spread evenly, not drawn independently",
             "the intervals of yield and quantiles are those of independent ones: wider than need be as a rule, not by "
             "proof",
             "sampling = \"random\" makes them hold"},
      Phrase{few_samples_for_tails, "few_samples_for_tails", warning, "{samples:n} samples say little about the tails",
             "no bound of 95 % of the units can be stated with 95 % confidence", "take {needed:n} or more"},
      Phrase{rare_share_contradicts, "rare_share_contradicts", doubt,
             "the samples themselves say {least:.3g} to {most:.3g}: the search did not find every way to fail", "",
             "take more rare samples, or rely on the yield"},
      Phrase{no_indices_correlated, "no_indices_correlated", note,
             "no Sobol indices: the parameters are correlated, and the variance cannot be shared out among them", "",
             "leave [correlation] out to have them"},
      Phrase{no_indices_too_many_parameters, "no_indices_too_many_parameters", note,
             "no Sobol indices: there are more than {most:n} parameters"},
      Phrase{no_indices_unbounded, "no_indices_unbounded", note, "no Sobol indices: some units have no finite limit"},
      Phrase{index_limits_doubtful, "index_limits_doubtful", warning,
             "the limits of {doubtful:n} of the units of the Sobol indices are doubtful",
             "the Sobol indices are not to be relied on that far", "keep the distributions away from such devices"},
      Phrase{index_not_known, "index_not_known", warning, "a Sobol index is known to {error:.2g} only",
             "the Sobol indices are not to be relied on that far", "take more index samples than {index_samples:n}"},
      Phrase{parameter_without_effect, "parameter_without_effect", note, "{key} changes no unit's critical stiffness",
             "its tolerance can neither gain nor cost yield in that",
             "leave it out, unless the limit for any user depends on it"},
      Phrase{worse_may_have_no_answer, "worse_may_have_no_answer", doubt,
             "{failed:n} units have no answer: one of them may be worse"},
      Phrase{one_descent_alone, "one_descent_alone", doubt,
             "one of {descents:n} descents alone ended at this unit: there may be a lower one", "",
             "take more samples"},
      Phrase{study_with_user, "study_with_user", warning,
             "all limits are with the file's user; with nobody holding the device of the file has {nobody_limit}",
             "a person lets go, and units that reach the specification may shake then",
             "leave [operator] out of the file to study the device that nobody holds"},
      Phrase{walls_without_answer, "walls_without_answer", doubt,
             "{without:n} of {asked:n} units and dampings have no answer ({reason}): they count as unstable", "",
             "keep the distributions away from such devices"},
      Phrase{wall_limits_doubtful, "wall_limits_doubtful", doubt,
             "the limits of {doubtful:n} of {asked:n} units and dampings are doubtful", "",
             "see analyze of the device with such a wall.damping"},
      Phrase{no_scale_of_dampings, "no_scale_of_dampings", refusal,
             "the device on paper has no region of stable walls that gives the scale of the dampings", "",
             "see region of the device"},
      Phrase{contours_go_on, "contours_go_on", doubt,
             "walls of every damping up to {damping:.3g} are stable: the contours go on beyond"},
      Phrase{
          no_failure_found, "no_failure_found", doubt,
          "no failure to sample around was found within {farthest:g} standard deviations: only the interval is known"},
      Phrase{
          few_effective_units, "few_effective_units", doubt,
          "the share of failures rests on {effective:n} effective units, of which one weighs {heaviest:%} %: failures "
          "elsewhere may have been missed",
          "", "take more samples"},
      Phrase{drawn_units_without_answer, "drawn_units_without_answer", doubt,
             "{without:n} of the {drawn:n} units drawn have no answer and count as failures", "",
             "keep the distributions away from such devices"},
      Phrase{drawn_limits_doubtful, "drawn_limits_doubtful", doubt,
             "the limits of {doubtful:n} of the {drawn:n} units drawn are doubtful"}};
  return phrases;
}

}  // namespace zwidth::internal
