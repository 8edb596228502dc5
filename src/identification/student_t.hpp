#pragma once

#include "identification/crossover/student_t.hpp"
