#pragma once

#include <string>
#include <vector>

#include "zwidth/finding.hpp"

namespace zwidth {

/// How far a number that states a limit may be relied on. Decided by the library, repeated by everything downstream.
struct Trust {
  /// From good to bad.
  enum class Verdict {
    sound,     ///< the data and the model carry the number
    doubtful,  ///< the number stands, but something does not carry it (extrapolation, misfit, a model outside its
               ///< domain)
    refused,   ///< no number is given
  };
  Verdict verdict = Verdict::sound;       ///< of this answer
  std::vector<std::string> reasons = {};  ///< why, each with its remedy; empty only when sound
  std::vector<Finding> findings = {};     ///< what the reasons are the sentences of, where the library found them

  /// Nothing speaks against the number.
  [[nodiscard]] bool sound() const { return verdict == Verdict::sound; }
  /// There is no number.
  [[nodiscard]] bool refused() const { return verdict == Verdict::refused; }

  /// At least doubtful, for this finding.
  void doubt(Finding finding);
  /// Refused, for this finding.
  void refuse(Finding finding);
  /// What is computed from `source` is trusted no more than it: the worse verdict of both, the reasons of both, each
  /// once.
  void inherit(const Trust& source);

  /// The verdict, its reasons and findings.
  [[nodiscard]] bool operator==(const Trust&) const = default;
};

}  // namespace zwidth
