#pragma once

#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/model/two_mass.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"
