/* A wall on a microcontroller: the file that zwidth wrote, in the sampling interrupt.
 *
 *   zwidth export devices/lhifam.toml --format c --safety-factor 0.5 --output wall.c
 *   cc -std=c99 -I . main.c -lm      with wall.c in the include path
 *
 * Here main() stands in for the interrupt: it pushes 1 mm into the wall and 1 mm out of it. */
#include <math.h>
#include <stdio.h>

#include "wall.c"

static double encoder_position(int sample) { return sample < 10 ? 1e-3 : -1e-3; }

static double commanded;
static void command_force(double newtons) { commanded = newtons; }

int main(void) {
  lhifam_translational_wall_t wall;
  lhifam_translational_wall_reset(&wall);
  for (int sample = 0; sample < 20; ++sample) {
    command_force(lhifam_translational_wall_force(&wall, encoder_position(sample)));
    if (sample == 9) printf("1 mm inside: %.6f N\n", commanded);
  }
  return isfinite(commanded) ? 0 : 1;
}
