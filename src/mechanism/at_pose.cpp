#include "mechanism/mechanism_text.hpp"
#include "mechanism/mujoco_file.hpp"
#include "zwidth/mechanism.hpp"

namespace zwidth {

MechanismAtPose at_pose(const MechanismFile& file) {
  return internal::mujoco_at_pose(file, internal::mechanism_texts(file));
}

}  // namespace zwidth
