#include "zwidth/words/problem_text.hpp"

#include <algorithm>
#include <utility>

#include "words/phrase.hpp"
#include "words/problem_phrase.hpp"
#include "zwidth/error.hpp"
#include "zwidth/input_problem.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth {
namespace {

const internal::ProblemPhrase& problem_phrase_of(ProblemCode code) {
  for (const std::span<const internal::ProblemPhrase> list : internal::problem_phrases()) {
    const auto found = std::ranges::find(list, code, &internal::ProblemPhrase::code);
    if (found != list.end()) return *found;
  }
  throw Error(ErrorCode::invalid_argument, "a problem's code has no words");
}

// The phrase filled in, with the options that it names in `backquotes`. What it is filled in with names none.
OptionText option_text(Finding facts, const char* phrase) {
  std::string sentence = internal::filled_in(facts, phrase);
  for (Subject& each : facts.subjects) std::ranges::replace(each.text, '`', '\'');
  return {std::move(sentence), options_named_in(internal::filled_in(facts, phrase))};
}

std::string line_of(const Problem& problem) {
  const ProblemWords words = words_of(problem);
  return words.allowed.empty() ? words.what : words.what + "; " + words.allowed;
}

}  // namespace

std::string_view name_of(ProblemCode code) { return problem_phrase_of(code).name; }

ProblemWords words_of(const Problem& problem) {
  const internal::ProblemPhrase& phrase = problem_phrase_of(problem.code);
  const Finding facts{.evidence = problem.evidence, .subjects = problem.subjects};
  return {internal::filled_in(facts, phrase.what), internal::filled_in(facts, phrase.allowed)};
}

Error::Error(ErrorCode code, const Problem& problem) : std::runtime_error(line_of(problem)), code_(code) {}

OptionProblem option_problem(std::string member, Problem problem) {
  ProblemWords words = words_of(problem);
  return {std::move(member), std::move(words.what), std::move(words.allowed), std::move(problem)};
}

InputProblem input_problem(InputPlace place, Problem problem, std::optional<std::string> suggestion) {
  const internal::ProblemPhrase& phrase = problem_phrase_of(problem.code);
  const Finding facts{.evidence = problem.evidence, .subjects = problem.subjects};
  OptionText what = option_text(facts, phrase.what);
  InputProblem told{std::move(place), std::move(what.text), {}, std::move(suggestion), std::move(what.options)};
  told.allow(option_text(facts, phrase.allowed));
  told.problem = std::move(problem);
  return told;
}

DeviceProblem device_problem(std::string key, Problem problem) {
  ProblemWords words = words_of(problem);
  return {std::move(key), std::move(words.what), std::move(words.allowed), std::move(problem)};
}

}  // namespace zwidth
