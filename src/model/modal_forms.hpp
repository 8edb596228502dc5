#pragma once

#include <memory>

#include "model/device_lengths.hpp"
#include "model/drive_path.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"

namespace zwidth::internal {

struct FoundPoles;

// modal_form() of one device along several paths: their poles, most of the work, are found once.
class ModalForms {
 public:
  // A device with bodies or coordinates, which must outlive this.
  ModalForms(const Device& device, ActuatorLag parts);
  ModalForms(const ModalForms&) = delete;
  ModalForms& operator=(const ModalForms&) = delete;
  ~ModalForms();

  // Throws Error (no_such_body), and as modal_form() does.
  [[nodiscard]] ModalForm along(Path path);
  // Of a device with bodies, of one each.
  [[nodiscard]] ModalForm along(const WeightedPath& path);

 private:
  const Device& device_;
  DrivePath drive_;
  std::unique_ptr<FoundPoles> found_;
};

}  // namespace zwidth::internal
