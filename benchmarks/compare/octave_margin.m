% The gain margin by GNU Octave's control package, device by device.
% Environment: ZWIDTH_INPUT, lines of 3 numerator and 5 denominator coefficients; ZWIDTH_OUTPUT, lines of
% gain margin, processor's seconds of c2d and margin, of margin alone; ZWIDTH_PERIOD.
pkg load control
warning ("off", "all");
devices = dlmread (getenv ("ZWIDTH_INPUT"), " ");
period = str2double (getenv ("ZWIDTH_PERIOD"));
repetitions = 5;
warm_up = margin (c2d (tf (devices(1,1:3), devices(1,4:8)), period, "zoh"));  % load the functions before the clock runs
output = fopen (getenv ("ZWIDTH_OUTPUT"), "w");
for i = 1:rows (devices)
  whole = zeros (1, repetitions);
  alone = zeros (1, repetitions);
  for k = 1:repetitions
    start = cputime ();
    sampled = c2d (tf (devices(i,1:3), devices(i,4:8)), period, "zoh");
    before_margin = cputime ();
    stiffness = margin (sampled);
    alone(k) = cputime () - before_margin;
    whole(k) = cputime () - start;
  end
  fprintf (output, "%.17g %.9g %.9g\n", stiffness, median (whole), median (alone));
end
fclose (output);
