#include "zwidth/mechanism.hpp"

#include <pybind11/eigen.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interruptible.hpp"
#include "parts.hpp"
#include "python_error.hpp"
#include "zwidth/error.hpp"

namespace zwidth::python {
namespace py = pybind11;
namespace {

using Numbers = std::map<std::string, double>;

py::object convert(const char* name) { return py::module_::import("zwidth._mechanism").attr(name); }

/// Calls the library without the interpreter's lock; what it refuses is raised with its places.
template <typename Work>
auto read_or_raised(const Work& work) {
  try {
    return without_lock(work);
  } catch (const Error& error) {
    raise_input_error(error, "mechanism");
  }
}

MechanismModel mechanism_of(const py::object& source, const std::string& tip, const py::object& encoders,
                            const py::object& pose, const py::object& transmissions) {
  MechanismFile file;
  const auto [path, text] = convert("source_of")(source).cast<std::pair<std::string, std::string>>();
  file.path = path;
  file.text = text;
  file.tip = tip;
  file.encoders = convert("names_of")(encoders).cast<std::vector<std::string>>();
  file.pose = convert("positions_of")(pose, py::tuple()).cast<Numbers>();
  for (const py::handle each : convert("transmissions_of")(transmissions)) {
    const auto given = each.cast<std::pair<std::string, Numbers>>();
    Transmission motor{.joint = given.first};
    for (const auto& [key, value] : given.second) {
      if (key == "ratio") motor.ratio = value;
      if (key == "inertia") motor.inertia = value;
      if (key == "motor_damping") motor.motor_damping = value;
      if (key == "stiffness") motor.stiffness = value;
      if (key == "damping") motor.damping = value;
    }
    file.transmissions.push_back(motor);
  }
  return read_or_raised([&] { return MechanismModel(file); });
}

MechanismModel mechanism_of_device(const Device& device) {
  const auto& direction = device.parameters().mechanism;
  if (!direction) raise_input_error("device", "is no mechanism", "a device with [mechanism]");
  return read_or_raised([&] { return MechanismModel(direction->mechanism); });
}

JointPositions positions_in(const MechanismModel& mechanism, const py::object& pose) {
  return convert("positions_of")(pose, mechanism.pose_joints()).cast<JointPositions>();
}

Eigen::MatrixXd weights_of(const auto& lengths, Eigen::Index coordinates) {
  Eigen::MatrixXd weights(static_cast<Eigen::Index>(lengths.size()), coordinates);
  Eigen::Index row = 0;
  for (const auto& each : lengths) {
    weights.row(row++) = Eigen::Map<const Eigen::RowVectorXd>(each.weights.data(), coordinates);
  }
  return weights;
}

Eigen::VectorXd numbers_of(const auto& lengths, auto member) {
  Eigen::VectorXd numbers(static_cast<Eigen::Index>(lengths.size()));
  Eigen::Index row = 0;
  for (const auto& each : lengths) numbers(row++) = each.*member;
  return numbers;
}

void bind_joint(py::module_& module) {
  py::class_<MechanismJoint> joint(module, "MechanismJoint", "A joint of a mechanism's file.");
  refuse_pickling(joint);
  joint.def_readonly("name", &MechanismJoint::name, "In the file; its number where it has none.")
      .def_property_readonly(
          "motion", [](const MechanismJoint& each) { return each.motion == Motion::linear ? "linear" : "rotary"; },
          "\"linear\" (a slide, m) or \"rotary\" (a hinge, rad).")
      .def_readonly("position", &MechanismJoint::position, "In the file's own pose, m or rad.")
      .def_property_readonly(
          "range",
          [](const MechanismJoint& each) -> py::object {
            return each.range ? py::make_tuple(each.range->least, each.range->greatest) : py::object(py::none());
          },
          "(least, greatest) that the file gives, m or rad; None where it gives none.")
      .def_readonly("is_driven", &MechanismJoint::is_driven, "Whether an actuator of the file turns it.")
      .def_readonly("is_of_pose", &MechanismJoint::is_of_pose, "Whether it is among those that give a pose.")
      .def("__repr__", [](const MechanismJoint& each) {
        return "<zwidth.MechanismJoint " + py::repr(py::str(each.name)).cast<std::string>() + ">";
      });
}

/// Matrices are read-only arrays over the object's own memory.
void bind_at_pose(py::module_& module) {
  py::class_<MechanismAtPose> bound(module, "MechanismAtPose",
                                    "A mechanism at a pose, linearised at rest with gravity compensated:\n\n"
                                    "    M q'' + (sum d w w') q' + (sum k w w') q = A_m' tau,   y = A_e q,   x = J q");
  refuse_pickling(bound);
  const auto matrix = [&](const char* name, Eigen::MatrixXd MechanismAtPose::*member, const char* text) {
    bound.def_property_readonly(
        name, [member](const MechanismAtPose& at) -> const Eigen::MatrixXd& { return at.*member; },
        py::return_value_policy::reference_internal, text);
  };
  matrix("mass", &MechanismAtPose::mass, "M, n x n.");
  matrix("jacobian", &MechanismAtPose::tip, "J of the tip, 3 x n, in the world's frame.");
  matrix("motors", &MechanismAtPose::motors, "A_m, a row a motor.");
  matrix("encoders", &MechanismAtPose::encoders, "A_e, a row an encoder.");
  matrix("cables", &MechanismAtPose::cables, "T, whose lengths T q the controller takes for constant.");
  bound
      .def_property_readonly(
          "joints", [](const MechanismAtPose& at) -> const Eigen::VectorXd& { return at.joints; },
          py::return_value_policy::reference_internal, "Where Mechanism.joints are, m or rad.")
      .def_property_readonly(
          "tip_position", [](const MechanismAtPose& at) -> const Eigen::Vector3d& { return at.tip_position; },
          py::return_value_policy::reference_internal, "m, in the world's frame.")
      .def_property_readonly(
          "element_weights", [](const MechanismAtPose& at) { return weights_of(at.elements, at.mass.rows()); },
          "w of springs and dampers of joints and cables, a row each.")
      .def_property_readonly(
          "element_stiffness",
          [](const MechanismAtPose& at) { return numbers_of(at.elements, &Coordinates::Element::stiffness); },
          "k of each of them.")
      .def_property_readonly(
          "element_damping",
          [](const MechanismAtPose& at) { return numbers_of(at.elements, &Coordinates::Element::damping); },
          "d of each of them.")
      .def_property_readonly(
          "friction_weights", [](const MechanismAtPose& at) { return weights_of(at.frictions, at.mass.rows()); },
          "w of what rubs, a row each; no limit depends on it.")
      .def_property_readonly(
          "friction_force",
          [](const MechanismAtPose& at) { return numbers_of(at.frictions, &Coordinates::Friction::force); },
          "Coulomb friction of each of them.");
}

}  // namespace

void bind_mechanism(py::module_& module) {
  bind_joint(module);
  bind_at_pose(module);
  py::class_<MechanismModel::Reached> reached(module, "ReachedPose", "A pose that brings the tip to a point, or near.");
  refuse_pickling(reached);
  reached.def_readonly("pose", &MechanismModel::Reached::pose, "Joints by name, m or rad.")
      .def_readonly("short_of", &MechanismModel::Reached::short_of, "From the tip to the point, m.")
      .def_readonly("reached", &MechanismModel::Reached::reached, "Whether the tip is there, to 1e-9 m.");
  py::class_<MechanismModel> bound(module, "Mechanism", "A mechanism's file, read once and looked at in many poses.");
  refuse_pickling(bound);
  bound
      .def(py::init(&mechanism_of), py::arg("source"), py::arg("tip"), py::kw_only(), py::arg("encoders") = py::tuple(),
           py::arg("pose") = py::dict(), py::arg("transmissions") = py::tuple(),
           "Reads MJCF or URDF: a file's path, or the text itself (more than one line). The others as the keys of "
           "[mechanism] and [[transmission]]: `pose` by joint, m or rad. Raises InputError with the line of the file.")
      .def_static("of", &mechanism_of_device, py::arg("device"), "That of a device with [mechanism], at its pose.")
      .def_property_readonly(
          "joints", [](const MechanismModel& mechanism) { return std::vector<MechanismJoint>(mechanism.joints()); },
          "All joints of the file, in its order.")
      .def_property_readonly("pose_joints", &MechanismModel::pose_joints,
                             "Names of those that give a pose; the others follow loops and cables.")
      .def(
          "at",
          [](const MechanismModel& mechanism, const py::object& pose) {
            const JointPositions positions = positions_in(mechanism, pose);
            return read_or_raised([&] { return mechanism.at(positions); });
          },
          py::arg("pose") = py::dict(),
          "The mechanism at a pose: positions by joint, or in the order of pose_joints; m or rad. Joints that are not "
          "given stay where the file's pose has them. Raises InputError where loops do not close.")
      .def(
          "reach",
          [](const MechanismModel& mechanism, const py::object& point) {
            const auto at = convert("point_of")(point).cast<Eigen::Vector3d>();
            return read_or_raised([&] { return mechanism.reach(at); });
          },
          py::arg("point"), "A pose with the tip at a point of the world's frame, m.")
      .def("__repr__", [](const MechanismModel& mechanism) {
        const MechanismFile& file = mechanism.file();
        const std::string name = file.path.empty() ? "of a text" : py::repr(py::str(file.path)).cast<std::string>();
        return "<zwidth.Mechanism " + name + ", tip " + py::repr(py::str(file.tip)).cast<std::string>() + ">";
      });
}

}  // namespace zwidth::python
