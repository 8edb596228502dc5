#include "mechanism/mujoco_file.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "linear_systems.hpp"
#include "mechanism/mechanism_text.hpp"
#include "mechanism/mujoco_parts.hpp"
#include "mechanism/trial_process.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/require_valid.hpp"

#ifdef ZWIDTH_MUJOCO
#include <mujoco/mujoco.h>

namespace zwidth::internal {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr int most_steps = 100;
constexpr double short_way = 0.1;          // m or rad, of a joint that is given: loops stay put together as they are
constexpr double most_of_a_way = 100.0;    // steps
constexpr double farthest_position = 1e6;  // m or rad: angles beyond keep too few digits
constexpr double settled = 1e-13;          // m or rad, of a step
constexpr double closed = 1e-9;            // m or rad, of a loop
constexpr int most_rows_of_loop = 6;       // of a weld
constexpr double dependent_loops_below = 1e-9;  // relative, of the loops' equations

// What is wrong with what is read, whichever key it came by.
struct RefusedSource {
  Problem problem;
};

[[noreturn]] void refuse_file(const char* why) {
  throw RefusedSource{{.code = ProblemCode::mechanism_file_refused, .subjects = {{"why", plain(why)}}}};
}

[[noreturn]] void refuse_part(const char* part) {
  throw RefusedSource{{.code = ProblemCode::mechanism_file_refused, .subjects = {{"part", part}}}};
}

// With its key.
template <typename Work>
auto reading(const MechanismFile& file, Work&& work) {
  try {
    return work();
  } catch (RefusedSource& refused) {
    refuse_key(source_key(file), std::move(refused.problem));
  }
}

// MuJoCo's fatal errors end the process; here they are errors of the file, as long as there is one of these.
class Handlers {
 public:
  Handlers() {
    const std::lock_guard lock(shared().mutex);
    if (shared().users++ > 0) return;
    shared().error = std::exchange(mju_user_error, refuse_file);
    shared().warning = std::exchange(mju_user_warning, [](const char*) {});
  }
  Handlers(const Handlers&) = delete;
  Handlers& operator=(const Handlers&) = delete;
  ~Handlers() {
    const std::lock_guard lock(shared().mutex);
    if (--shared().users > 0) return;
    mju_user_error = shared().error;
    mju_user_warning = shared().warning;
  }

 private:
  struct Shared {
    std::mutex mutex;
    int users = 0;
    void (*error)(const char*) = nullptr;
    void (*warning)(const char*) = nullptr;
  };
  static Shared& shared() {
    static Shared one;
    return one;
  }
};

// MuJoCo looks for files among these first, and they name no others.
class Texts {
 public:
  explicit Texts(const std::vector<MechanismText>& texts) {
    mj_defaultVFS(files_.get());
    for (const MechanismText& each : texts) {
      mj_makeEmptyFileVFS(files_.get(), each.name.c_str(), static_cast<int>(each.text.size()));
      const int at = mj_findFileVFS(files_.get(), each.name.c_str());
      if (at < 0) refuse_part("files");
      std::memcpy(files_->filedata[at], each.text.data(), each.text.size());
    }
  }
  [[nodiscard]] const mjVFS* get() const { return files_.get(); }

 private:
  struct Delete {
    void operator()(mjVFS* files) const {
      mj_deleteVFS(files);
      delete files;
    }
  };
  std::unique_ptr<mjVFS, Delete> files_{new mjVFS};
};

struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using Data = std::unique_ptr<mjData, DeleteData>;

// A state of a model, at a pose.
class Posed {
 public:
  Posed(const mjModel* model, mjData* data, const MechanismFile& file, const JointPositions& pose)
      : model_(model), data_(data), parts_(model), is_given_(static_cast<std::size_t>(model->njnt), false) {
    mj_resetData(model_, data_);
    std::vector<Way> ways;
    for (const auto& [joint, to] : pose) {
      const std::string key = fmt::format("mechanism.pose.{}", joint);
      const int of = parts_.index(key, mjOBJ_JOINT, joint);
      if (!std::isfinite(to)) refuse_key(key, {.code = ProblemCode::not_finite});
      const bool slides = model_->jnt_type[of] == mjJNT_SLIDE;
      check_unit(file.units_of_pose, joint, key, joint, slides);
      ways.push_back({.joint = of, .from = data_->qpos[of], .to = to});  // of hinges and slides, each has one
      is_given_[static_cast<std::size_t>(of)] = true;
    }
    go(ways);
  }

  // Motions that the loops leave free: q' = Z z'.
  [[nodiscard]] Eigen::MatrixXd free_motions() const {
    const Rows loops = Eigen::Map<const Rows>(data_->efc_J, data_->ne, model_->nv);
    if (loops.rows() == 0) return Eigen::MatrixXd::Identity(model_->nv, model_->nv);
    return orthonormal_complement(loops.transpose(), dependent_loops_below);
  }

  [[nodiscard]] MechanismAtPose whole(const MechanismFile& file) const {
    const int n = model_->nv;
    MechanismAtPose at;
    Rows mass(n, n);
    mj_fullM(model_, mass.data(), data_->qM);
    at.mass = mass;
    const bool is_mass_matrix = mass.allFinite() && Eigen::LLT<Eigen::MatrixXd>(at.mass).info() == Eigen::Success;
    if (!is_mass_matrix || !not_negative_numbers.contains(mass.diagonal().maxCoeff())) refuse_part("mass");
    add_tip(file.tip, at);
    at.joint_motions = Eigen::MatrixXd::Identity(n, n);
    at.joints = Eigen::Map<const Eigen::VectorXd>(data_->qpos, n);
    add_elements(at);
    at.motors = Eigen::Map<const Rows>(data_->actuator_moment, model_->nu, n);
    std::vector<int> read;
    for (const std::string& each : file.encoders) read.push_back(parts_.index("mechanism.encoders", mjOBJ_JOINT, each));
    for (int i = 0; file.encoders.empty() && i < model_->nu; ++i) {
      const int joint = model_->actuator_trnid[std::ptrdiff_t{2} * i];
      const bool is_new = std::ranges::find(read, joint) == read.end();
      if (model_->actuator_trntype[i] == mjTRN_JOINT && is_new) read.push_back(joint);
    }
    at.encoders = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(read.size()), n);
    for (std::size_t i = 0; i < read.size(); ++i) at.encoders(static_cast<Eigen::Index>(i), read[i]) = 1.0;
    for (const Eigen::MatrixXd* each : {&at.tip, &at.motors, &at.cables}) {
      if (!each->allFinite()) refuse_part("numbers");
    }
    return at;
  }

 private:
  void add_tip(const std::string& wanted, MechanismAtPose& at) const {
    Rows jacobian(3, model_->nv);
    const int body = mj_name2id(model_, mjOBJ_BODY, wanted.c_str());
    if (mj_name2id(model_, mjOBJ_SITE, wanted.c_str()) < 0 && body >= 0) {
      mj_jacBody(model_, data_, jacobian.data(), nullptr, body);
      at.tip_position = Eigen::Map<const Eigen::Vector3d>(data_->xpos + std::ptrdiff_t{3} * body);
    } else {
      const int site = parts_.index("mechanism.tip", mjOBJ_SITE, wanted);
      mj_jacSite(model_, data_, jacobian.data(), nullptr, site);
      at.tip_position = Eigen::Map<const Eigen::Vector3d>(data_->site_xpos + std::ptrdiff_t{3} * site);
    }
    at.tip = jacobian;
    if (!(at.tip_position.cwiseAbs().maxCoeff() <= farthest_position)) refuse_part("tip");
  }

  void check_number(mjtObj kind, int of, const char* what, double value) const {
    if (not_negative_numbers.contains(value)) return;
    refuse_number(kind, of, what, value);
  }

  [[noreturn]] void refuse_number(mjtObj kind, int of, const char* what, double value) const {
    throw RefusedSource{{.code = ProblemCode::mechanism_file_refused,
                         .evidence = {{"value", value}},
                         .subjects = {{"part", kind == mjOBJ_JOINT ? "joint's" : "tendon's"},
                                      {"of", plain(parts_.name(kind, of).c_str())},
                                      {"attribute", what}}}};
  }

  void add_elements(MechanismAtPose& at) const {
    const int n = model_->nv;
    // What does not move, as a tendon between points of the world, is neither stiff nor damped.
    const auto add = [&](mjtObj kind, int of, const Eigen::VectorXd& along, double stiffness, double damping,
                         double friction) {
      check_number(kind, of, "stiffness", stiffness);
      check_number(kind, of, "damping", damping);
      check_number(kind, of, "frictionloss", friction);
      if (along.isZero(0.0)) return;
      if (stiffness != 0.0 || damping != 0.0) at.elements.push_back({{along.begin(), along.end()}, stiffness, damping});
      if (friction != 0.0) at.frictions.push_back({{along.begin(), along.end()}, friction});
    };
    for (int joint = 0; joint < n; ++joint) {
      add(mjOBJ_JOINT, joint, Eigen::VectorXd::Unit(n, joint), model_->jnt_stiffness[joint], model_->dof_damping[joint],
          model_->dof_frictionloss[joint]);
    }
    const Rows lengths = Eigen::Map<const Rows>(data_->ten_J, model_->ntendon, n);
    std::vector<int> cables;  // the stiffest last
    for (int tendon = 0; tendon < model_->ntendon; ++tendon) {
      const double stiffness = model_->tendon_stiffness[tendon];
      add(mjOBJ_TENDON, tendon, lengths.row(tendon).transpose(), stiffness, model_->tendon_damping[tendon],
          model_->tendon_frictionloss[tendon]);
      if (stiffness != 0.0 && !lengths.row(tendon).isZero(0.0)) cables.push_back(tendon);
    }
    std::ranges::stable_sort(cables, {}, [this](int tendon) { return model_->tendon_stiffness[tendon]; });
    at.cables = lengths(cables, Eigen::all);
  }

  struct Way {
    int joint;
    double from, to;
  };

  // A loop closes in several ways: of them, the one that the file's leads to. Where it opens on the way, none is led to: what
  // closes beyond may be another one.
  void go(const std::vector<Way>& ways) {
    double farthest = 0.0;
    for (const Way& each : ways) farthest = std::max(farthest, std::abs(each.to - each.from));
    const bool at_once = model_->neq == 0 || !(farthest > short_way);
    const int steps = at_once ? 1 : static_cast<int>(std::min(std::ceil(farthest / short_way), most_of_a_way));
    bool has_closed = false;
    double open = 0.0;
    for (int step = 1; step <= steps && !(has_closed && open > closed); ++step) {
      for (const Way& each : ways) {
        data_->qpos[each.joint] = step == steps ? each.to : each.from + (each.to - each.from) * step / steps;
      }
      open = settle();
      has_closed = has_closed || open <= closed;
    }
    for (int joint = 0; joint < model_->njnt; ++joint) {
      const double at = data_->qpos[joint];
      const double from = model_->qpos0[joint];
      if (!(std::abs(at) <= farthest_position)) refuse_number(mjOBJ_JOINT, joint, "position", at);
      if (!(std::abs(from) <= farthest_position)) refuse_number(mjOBJ_JOINT, joint, "position", from);
    }
    if (!(open <= closed))
      refuse_key("mechanism.pose", {.code = ProblemCode::loop_does_not_close, .evidence = {{"open", open}}});
  }

  // Joints that are not given close the loops; those of them that motors drive follow their cables. How far loops stay open.
  double settle() {
    const int n = model_->nv;
    std::vector<bool> is_driven(static_cast<std::size_t>(n), false);
    for (int i = 0; i < model_->nu; ++i) {
      if (model_->actuator_trntype[i] == mjTRN_JOINT)
        is_driven[static_cast<std::size_t>(model_->actuator_trnid[std::ptrdiff_t{2} * i])] = true;
    }
    double open = 0.0;
    for (int step = 0; step < most_steps; ++step) {
      mj_fwdPosition(model_, data_);
      const int loops = data_->ne;
      const int equations = loops + model_->ntendon;
      if (equations == 0) return 0.0;
      Eigen::VectorXd off = Eigen::VectorXd::Zero(equations);
      Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(equations, n);
      off.head(loops) = Eigen::Map<const Eigen::VectorXd>(data_->efc_pos, loops);
      slopes.topRows(loops) = Eigen::Map<const Rows>(data_->efc_J, loops, n);
      for (int tendon = 0; tendon < model_->ntendon; ++tendon) {
        if (!(model_->tendon_stiffness[tendon] > 0.0)) continue;
        off(loops + tendon) = data_->ten_length[tendon] - model_->tendon_lengthspring[tendon];
        slopes.row(loops + tendon) = Eigen::Map<const Eigen::RowVectorXd>(data_->ten_J + std::ptrdiff_t{tendon} * n, n);
        for (int joint = 0; joint < n; ++joint) {
          if (!is_driven[static_cast<std::size_t>(joint)]) slopes(loops + tendon, joint) = 0.0;
        }
        if (is_unmoved(slopes.row(loops + tendon))) off(loops + tendon) = 0.0;
      }
      for (int joint = 0; joint < n; ++joint) {
        if (is_given_[static_cast<std::size_t>(joint)]) slopes.col(joint).setZero();
      }
      open = loops > 0 ? off.head(loops).cwiseAbs().maxCoeff() : 0.0;
      const Eigen::VectorXd move = shortest_solutions(slopes, off, smallest_pivot);
      if (!(move.cwiseAbs().maxCoeff() > settled)) break;
      Eigen::Map<Eigen::VectorXd>(data_->qpos, n) -= move;
    }
    mj_fwdPosition(model_, data_);
    if (data_->warning[mjWARN_CNSTRFULL].number > 0) refuse_part("loops");
    return open;
  }

  static bool is_unmoved(const Eigen::RowVectorXd& slope) { return slope.cwiseAbs().maxCoeff() == 0.0; }

  const mjModel* model_;
  mjData* data_;
  Parts parts_;
  std::vector<bool> is_given_;  // of the joints
};

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
using Model = std::unique_ptr<mjModel, DeleteModel>;

Model read_model(const std::vector<MechanismText>& texts) {
  const Texts given(texts);
  char why[1000] = "";
  Model model(mj_loadXML(texts.front().name.c_str(), given.get(), why, sizeof why));
  if (!model) refuse_file(why);
  if (model->njnt == 0) refuse_part("joint");
  for (int joint = 0; joint < model->njnt; ++joint) {
    if (model->jnt_type[joint] == mjJNT_HINGE || model->jnt_type[joint] == mjJNT_SLIDE) continue;
    throw RefusedSource{{.code = ProblemCode::joint_of_many_motions,
                         .subjects = {{"name", Parts(model.get()).name(mjOBJ_JOINT, joint)}}}};
  }
  if (model->opt.viscosity != 0.0) refuse_part("viscosity");
  model->opt.jacobian = mjJAC_DENSE;
  model->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_LIMIT | mjDSBL_FRICTIONLOSS | mjDSBL_GRAVITY;
  // A state has room for so many, which each pose clears: without contacts, and of the loops alone.
  model->nconmax = 0;
  model->njmax = std::min(model->njmax, most_rows_of_loop * model->neq);
  return model;
}

MujocoFile::At at_pose_of(const mjModel* model, mjData* data, const MechanismFile& file, const JointPositions& pose) {
  const Posed posed(model, data, file, pose);
  return {posed.whole(file), posed.free_motions()};
}

class OpenFile final : public MujocoFile {
 public:
  OpenFile(MechanismFile file, const std::vector<MechanismText>& texts)
      : file_(std::move(file)), text_(one_text(texts)), model_(read_model(texts)), numbers_(numbers_of(*model_)) {}

  // The same file with the numbers of this one in it.
  OpenFile(MechanismFile file, const OpenFile& same)
      : file_(std::move(file)),
        text_(same.text_),
        model_(mj_copyModel(nullptr, same.model_.get())),
        numbers_(same.numbers_) {
    replace_numbers(*model_, file_);
    // What the reader computes of armatures once: inertias of joints that do not depend on the pose.
    mj_setConst(model_.get(), Data(mj_makeData(model_.get())).get());
  }

  // Whether what is read of the same texts for this file is the same.
  [[nodiscard]] bool is_for(const MechanismFile& file) const {
    return file.path == file_.path && file.text.empty() == file_.text.empty() && file.tip == file_.tip &&
           file.encoders == file_.encoders && file.units_of_pose == file_.units_of_pose;
  }

  [[nodiscard]] std::string text() const override { return text_; }

  [[nodiscard]] std::vector<MechanismJoint> joints() const override {
    std::vector<MechanismJoint> joints;
    for (int i = 0; i < model_->njnt; ++i) {
      MechanismJoint& joint = joints.emplace_back();
      joint.name = Parts(model_.get()).name(mjOBJ_JOINT, i);
      joint.motion = model_->jnt_type[i] == mjJNT_SLIDE ? Motion::linear : Motion::rotary;
      joint.position = model_->qpos0[i];
      const mjtNum* range = model_->jnt_range + std::ptrdiff_t{2} * i;
      if (model_->jnt_limited[i] != 0) joint.range = JointRange{range[0], range[1]};
    }
    for (int i = 0; i < model_->nu; ++i) {
      if (model_->actuator_trntype[i] != mjTRN_JOINT) continue;
      joints[static_cast<std::size_t>(model_->actuator_trnid[std::ptrdiff_t{2} * i])].is_driven = true;
    }
    return joints;
  }

  [[nodiscard]] const std::map<std::string, MechanismNumber>& numbers() const override { return numbers_; }

  [[nodiscard]] int joint(const std::string& key, const std::string& name) const override {
    return Parts(model_.get()).index(key, mjOBJ_JOINT, name);
  }

  [[nodiscard]] At at(const JointPositions& pose) const override {
    const Handlers handlers;
    Data data = idle_data();
    At at = reading(file_, [&] { return at_pose_of(model_.get(), data.get(), file_, pose); });
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(data));
    return at;
  }

 private:
  [[nodiscard]] Data idle_data() const {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return Data(mj_makeData(model_.get()));
    Data data = std::move(idle_.back());
    idle_.pop_back();
    return data;
  }

  MechanismFile file_;
  std::string text_;
  Model model_;
  std::map<std::string, MechanismNumber> numbers_;  // of the file
  mutable std::mutex mutex_;
  mutable std::vector<Data> idle_;  // that no thread uses just now
};

// What MuJoCo does not expect may crash it: a text is read in another process first. One text at a time. Devices made from one
// another differ in pose, numbers and transmissions, and share what was read last.
std::shared_ptr<const OpenFile> opened_as_it_stands(const MechanismFile& file) {
  const std::vector<MechanismText> texts = mechanism_texts(file);
  static std::mutex one_at_a_time;
  static std::vector<MechanismText> read_before;
  static std::shared_ptr<const OpenFile> opened;
  const std::lock_guard lock(one_at_a_time);
  const bool is_known = texts == read_before;
  if (is_known && opened && opened->is_for(file)) return opened;
  const Handlers handlers;
  return reading(file, [&] {
    const bool ends = is_known || ends_in_trial([&] {
                        const Model model = read_model(texts);
                        const Data data(mj_makeData(model.get()));
                        static_cast<void>(at_pose_of(model.get(), data.get(), file, file.pose));
                      });
    if (!ends) refuse_part("reader");
    opened.reset();
    read_before = texts;
    opened = std::make_shared<const OpenFile>(file, texts);
    return opened;
  });
}

}  // namespace

std::shared_ptr<const MujocoFile> open_mujoco_file(const MechanismFile& file) {
  std::shared_ptr<const OpenFile> opened = opened_as_it_stands(file);
  if (file.numbers.empty()) return opened;
  const Handlers handlers;
  return reading(file, [&] { return std::make_shared<const OpenFile>(file, *opened); });
}

}  // namespace zwidth::internal
#else
namespace zwidth::internal {

std::shared_ptr<const MujocoFile> open_mujoco_file(const MechanismFile&) {
  refuse_key("mechanism.file", {.code = ProblemCode::built_without_mujoco});
}

}  // namespace zwidth::internal
#endif
