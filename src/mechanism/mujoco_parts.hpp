#pragma once

// The parts of MuJoCo's model of a mechanism, and its numbers that have keys.

#ifdef ZWIDTH_MUJOCO
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/mechanism.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {

// On one line, whatever names the file gives.
inline std::string plain(const char* said) {
  std::string text(said);
  while (!text.empty() && static_cast<unsigned char>(text.back()) <= ' ') text.pop_back();
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

// The parts of a model by name.
class Parts {
 public:
  explicit Parts(const mjModel* model) : model_(model) {}

  [[nodiscard]] int index(const std::string& key, mjtObj kind, const std::string& wanted) const {
    const int found = mj_name2id(model_, kind, wanted.c_str());
    if (found >= 0) return found;
    std::string names;
    const bool is_joint = kind == mjOBJ_JOINT;
    const bool is_tendon = kind == mjOBJ_TENDON;
    for (int i = 0; i < (is_joint ? model_->njnt : is_tendon ? model_->ntendon : model_->nsite); ++i) {
      names += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", plain(name(kind, i).c_str()));
    }
    std::vector<Subject> subjects{{"kind", is_joint ? "joint" : is_tendon ? "tendon" : "tip"}, {"name", wanted}};
    if (!names.empty()) subjects.push_back({"names", names});
    refuse_key(key, {.code = ProblemCode::no_such_part, .subjects = std::move(subjects)});
  }

  [[nodiscard]] std::string name(mjtObj kind, int of) const {
    const char* found = mj_id2name(model_, kind, of);
    return found != nullptr ? found : std::to_string(of);
  }

 private:
  const mjModel* model_;
};

// Refuses a number whose unit is of the other motion than its joint has.
inline void check_unit(const std::map<std::string, Motion>& units, const std::string& of, const std::string& key,
                       const std::string& joint, bool slides) {
  const auto unit = units.find(of);
  if (unit == units.end() || slides == (unit->second == Motion::linear)) return;
  std::vector<Subject> subjects{{"name", joint}};
  if (slides) subjects.push_back({"slides", "slides"});
  if (!is_key_of_pose(key)) subjects.push_back({"number", "number"});
  refuse_key(key, {.code = ProblemCode::unit_of_other_joint, .subjects = std::move(subjects)});
}

// Calls visit(kind, name, attribute, value, slides) for every number that has a key.
template <typename Visitor>
void visit_numbers(mjModel& model, Visitor&& visit) {
  for (int i = 0; i < model.njnt; ++i) {
    const bool slides = model.jnt_type[i] == mjJNT_SLIDE;
    visit(mjOBJ_JOINT, i, "damping", model.dof_damping[i], slides);
    visit(mjOBJ_JOINT, i, "stiffness", model.jnt_stiffness[i], slides);
    visit(mjOBJ_JOINT, i, "armature", model.dof_armature[i], slides);
  }
  for (int i = 0; i < model.ntendon; ++i) {
    // Its length is in m, or in the unit of the joints that it adds.
    bool is_length = true;
    for (int part = model.tendon_adr[i]; part < model.tendon_adr[i] + model.tendon_num[i]; ++part) {
      const bool is_joint = model.wrap_type[part] == mjWRAP_JOINT;
      if (is_joint && model.jnt_type[model.wrap_objid[part]] != mjJNT_SLIDE) is_length = false;
    }
    visit(mjOBJ_TENDON, i, "stiffness", model.tendon_stiffness[i], is_length);
    visit(mjOBJ_TENDON, i, "damping", model.tendon_damping[i], is_length);
  }
}

// The number's key in MechanismFile::numbers; empty where joint or tendon have no name.
inline std::string key_of_number(const mjModel& model, mjtObj kind, int of, const char* attribute) {
  const char* name = mj_id2name(&model, kind, of);
  if (name == nullptr || *name == 0) return {};
  return fmt::format("{}.{}.{}", kind == mjOBJ_JOINT ? "joint" : "tendon", name, attribute);
}

// What the model has of them.
inline std::map<std::string, MechanismNumber> numbers_of(mjModel& model) {
  std::map<std::string, MechanismNumber> numbers;
  visit_numbers(model, [&](mjtObj kind, int of, const char* attribute, double value, bool slides) {
    const std::string key = key_of_number(model, kind, of, attribute);
    if (!key.empty()) numbers[key] = {value, slides ? Motion::linear : Motion::rotary};
  });
  return numbers;
}

// Puts those of the file into the model; refuses what is of no joint or tendon of it.
inline void replace_numbers(mjModel& model, const MechanismFile& file) {
  const Parts parts(&model);
  for (const auto& [key, value] : file.numbers) {
    const MechanismNumberName of(key);
    const mjtObj kind = of.kind == "joint" ? mjOBJ_JOINT : mjOBJ_TENDON;
    static_cast<void>(parts.index(fmt::format("mechanism.{}", key), kind, std::string(of.part)));
  }
  visit_numbers(model, [&](mjtObj kind, int of, const char* attribute, double& value, bool slides) {
    const std::string key = key_of_number(model, kind, of, attribute);
    const auto given = file.numbers.find(key);
    if (given == file.numbers.end()) return;
    if (kind == mjOBJ_JOINT) {
      check_unit(file.units_of_numbers, key, fmt::format("mechanism.{}", key), parts.name(kind, of), slides);
    }
    value = given->second;
  });
}

}  // namespace zwidth::internal
#endif
