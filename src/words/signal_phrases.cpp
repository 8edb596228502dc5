#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> signal_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{signal_short, "signal_short", warning, "{channel} has only {samples:n} samples, {duration:.4g} s",
             "{!spacing|there is nothing to identify}{?spacing|the response has few lines, {spacing:.4g} Hz apart or "
             "more, and little is averaged: narrow resonances are missed and intervals are wide}"},
      Phrase{signal_constant, "signal_constant", warning, "{channel} is constant at {value:.6g}",
             "{?role=force|nothing excites the device: there is no response to find}{?role=motion|the device did not "
             "move or its sensor was not read: there is no response}"},
      Phrase{signal_quantised, "signal_quantised", warning,
             "{channel} is coarsely quantised: it takes {levels:n} different values",
             "rounding errs by up to {error:percent} of its whole range: what moves less than that, mostly at high "
             "frequency, is not seen; excite more strongly or use a finer sensor"},
      Phrase{signal_clipped, "signal_clipped", warning,
             "{channel} is clipped at {level:.6g}: {share:percent} of its samples, first at {first:.4g} s",
             "{?role=force|if it was clipped after it was recorded or the actuator saturated, the response is not that "
             "of a linear device}{?role=motion|the motion beyond is lost (the sensor's range, or an end stop): the "
             "response is too small there and distorted}; reduce the amplitude"},
      Phrase{signal_idle, "signal_idle", warning,
             "{channel} stays at {value:.6g} from {begin:.6g} s to {end:.6g} s ({samples:n} samples){!dropouts=1|, the "
             "longest of {dropouts:n} such stretches}",
             "harmless where the force rests between bursts; where the signal was lost, the response is wrong: cut the "
             "record there"},
      Phrase{signal_lost, "signal_lost", warning,
             "{channel} stays at {value:.6g} from {begin:.6g} s to {end:.6g} s ({samples:n} samples){!dropouts=1|, the "
             "longest of {dropouts:n} such stretches}",
             "the signal seems to have been lost there: the response and its coherence suffer; cut the record there"}};
  return phrases;
}

}  // namespace zwidth::internal
