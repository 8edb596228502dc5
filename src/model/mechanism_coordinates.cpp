#include "model/mechanism_coordinates.hpp"

namespace zwidth::internal {
namespace {

PutToPose& registered() noexcept {
  static PutToPose put = nullptr;
  return put;
}

}  // namespace

PutToPose put_to_pose() noexcept { return registered(); }

PutToPoseRegistration::PutToPoseRegistration(PutToPose put) noexcept { registered() = put; }

}  // namespace zwidth::internal
